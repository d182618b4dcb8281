/* convert.c - roughness as other systems count it
 *
 * A convention is a row: its numbers, alpha from them, and them from alpha. Clamps of a system that
 * only keep it from dividing by zero (alpha at least 1e-6, say) are left out where a slope map
 * refuses such values anyway; those that change what a user sees are in. */
#define ASP_PRECISION 64
#include "asperity_convert.h"
#include "asperity/elementary.h"
#include "bsdf/spec.h"

#define ANGLE { "rotation", -1e4, 0, 1e4, 0, "turns the tangent, radians" }
#define ROUGHNESS { "roughness", 0, 1, 1, 0.5, "perceptual roughness" }

static double convert_square(double x) { return x * x; }

static void convert_put(asp_roughness *out, double alpha_x, double alpha_y, double rotation)
{
    out->alpha_x = alpha_x;
    out->alpha_y = alpha_y;
    out->rotation = rotation;
    out->mean_x = out->mean_y = 0.0;
}

/* ---- alpha itself: Mitsuba 3, dj_brdf, the RGL files */

static const asp_param alpha_params[] = {
    { "alpha_x", 1e-5, 0, 100, 0.3, "slope scale along the tangent" },
    { "alpha_y", 1e-5, 0, 100, 0.3, "across it" },
    ANGLE
};
static void alpha_to(const double *v, asp_roughness *out) { convert_put(out, v[0], v[1], v[2]); }
static void alpha_from(const asp_roughness *in, double *v)
{
    v[0] = in->alpha_x;
    v[1] = in->alpha_y;
    v[2] = in->rotation;
}

/* ---- pbrt-v4: alpha = sqrt(roughness) */

static const asp_param pbrt_params[] = {
    { "uroughness", 0, 1, 1e4, 0.25, "roughness along the tangent" },
    { "vroughness", 0, 1, 1e4, 0.25, "across it" },
    ANGLE
};
static void pbrt_to(const double *v, asp_roughness *out)
{
    convert_put(out, aspi_sqrt(v[0]), aspi_sqrt(v[1]), v[2]);
}
static void pbrt_from(const asp_roughness *in, double *v)
{
    v[0] = convert_square(in->alpha_x);
    v[1] = convert_square(in->alpha_y);
    v[2] = in->rotation;
}

/* ---- pbrt-v3: a polynomial of log(roughness), which rises everywhere; inverted by bisection */

static const asp_param pbrt3_params[] = {
    { "uroughness", 1e-3, 0, 10, 0.25, "roughness along the tangent" },
    { "vroughness", 1e-3, 0, 10, 0.25, "across it" },
    ANGLE
};
static double pbrt3_alpha(double log_roughness)
{
    double x = log_roughness;
    return 1.62142 + x * (0.819955 + x * (0.1734 + x * (0.0171201 + x * 0.000640711)));
}
static void pbrt3_to(const double *v, asp_roughness *out)
{
    convert_put(out, pbrt3_alpha(aspi_log(v[0])), pbrt3_alpha(aspi_log(v[1])), v[2]);
}
static double pbrt3_roughness(double alpha)
{
    double low = aspi_log(1e-3), high = aspi_log(10.0);
    int i;
    for (i = 0; i < 60; i++) {
        double middle = 0.5 * (low + high);
        if (pbrt3_alpha(middle) < alpha)
            low = middle;
        else
            high = middle;
    }
    return aspi_exp(0.5 * (low + high));
}
static void pbrt3_from(const asp_roughness *in, double *v)
{
    v[0] = aspi_max(pbrt3_roughness(in->alpha_x), 1e-3);
    v[1] = aspi_max(pbrt3_roughness(in->alpha_y), 1e-3);
    v[2] = in->rotation;
}

/* ---- Disney: alpha = roughness^2, aspect = sqrt(1 - 0.9 anisotropic), each at least 0.001 */

static const asp_param disney_params[] = {
    ROUGHNESS, { "anisotropic", 0, 0, 1, 0, "0 isotropic, 1 a ratio of 10" }, ANGLE
};
static void disney_to(const double *v, asp_roughness *out)
{
    double alpha = v[0] * v[0], aspect = aspi_sqrt(1.0 - 0.9 * v[1]);
    convert_put(out, aspi_max(alpha / aspect, 1e-3), aspi_max(alpha * aspect, 1e-3), v[2]);
}
static void disney_from(const asp_roughness *in, double *v)
{
    v[0] = aspi_sqrt(aspi_sqrt(in->alpha_x * in->alpha_y));
    v[1] = (1.0 - in->alpha_y / in->alpha_x) / 0.9;
    v[2] = in->rotation;
}

/* ---- glTF: alpha = roughness^2 across, mix(alpha, 1, strength^2) along */

static const asp_param gltf_params[] = {
    ROUGHNESS, { "anisotropyStrength", 0, 0, 1, 0, "0 isotropic, 1 alpha = 1 along the tangent" },
    { "anisotropyRotation", -1e4, 0, 1e4, 0, "turns the tangent, radians" }
};
static void gltf_to(const double *v, asp_roughness *out)
{
    double alpha = v[0] * v[0], mix = v[1] * v[1];
    convert_put(out, alpha * (1.0 - mix) + mix, alpha, v[2]);
}
static void gltf_from(const asp_roughness *in, double *v)
{
    double more = in->alpha_x - in->alpha_y;
    v[0] = aspi_sqrt(in->alpha_y);
    v[1] = more > 0.0 ? aspi_sqrt(more / (1.0 - in->alpha_y)) : 0.0;
    v[2] = in->rotation;
}

/* ---- MaterialX, node roughness_anisotropy */

static const asp_param materialx_params[] = {
    ROUGHNESS, { "anisotropy", 0, 0, 1, 0, "0 isotropic; beyond 0.98 nothing changes" }, ANGLE
};
static void materialx_to(const double *v, asp_roughness *out)
{
    double alpha = v[0] * v[0], aspect = aspi_sqrt(1.0 - aspi_min(v[1], 0.98));
    convert_put(out, aspi_min(alpha / aspect, 1.0), alpha * aspect, v[2]);
}
static void materialx_from(const asp_roughness *in, double *v)
{
    v[0] = aspi_sqrt(aspi_sqrt(in->alpha_x * in->alpha_y));
    v[1] = 1.0 - in->alpha_y / in->alpha_x;
    v[2] = in->rotation;
}

/* ---- OpenPBR: the mean of alpha_x^2 and alpha_y^2 is kept */

static const asp_param openpbr_params[] = {
    ROUGHNESS, { "anisotropy", 0, 0, 1, 0, "1 - alpha_y/alpha_x" }, ANGLE
};
static void openpbr_to(const double *v, asp_roughness *out)
{
    double ratio = 1.0 - v[1], along = v[0] * v[0] * aspi_sqrt(2.0 / (1.0 + ratio * ratio));
    convert_put(out, along, ratio * along, v[2]);
}
static void openpbr_from(const asp_roughness *in, double *v)
{
    v[0] = aspi_sqrt(aspi_sqrt(0.5 * (convert_square(in->alpha_x) + convert_square(in->alpha_y))));
    v[1] = 1.0 - in->alpha_y / in->alpha_x;
    v[2] = in->rotation;
}

/* ---- Kulla, Conty 2017; Filament: alpha (1 + a), alpha (1 - a) */

static const asp_param filament_params[] = {
    ROUGHNESS, { "anisotropy", -1, 1, 1, 0, "negative: rougher across the tangent" }, ANGLE
};
static void filament_to(const double *v, asp_roughness *out)
{
    double alpha = v[0] * v[0];
    convert_put(out, alpha * (1.0 + v[1]), alpha * (1.0 - v[1]), v[2]);
}
static void filament_from(const asp_roughness *in, double *v)
{
    v[0] = aspi_sqrt(0.5 * (in->alpha_x + in->alpha_y));
    v[1] = (in->alpha_x - in->alpha_y) / (in->alpha_x + in->alpha_y);
    v[2] = in->rotation;
}

/* ---- smoothness: alpha = (1 - smoothness)^2 */

static const asp_param smoothness_params[] = {
    { "smoothness", 0, 0, 1, 0.5, "1 - perceptual roughness" }
};
static void smoothness_to(const double *v, asp_roughness *out)
{
    double alpha = convert_square(1.0 - v[0]);
    convert_put(out, alpha, alpha, 0.0);
}
static void smoothness_from(const asp_roughness *in, double *v) { v[0] = 1.0 - aspi_sqrt(in->alpha_x); }

/* ---- the exponent of cos^n: Walter et al. 2007, sec. 5.2, there an approximation for Beckmann. It
 * is exact for Phong's distribution as a member of Student's t, whose alpha is sqrt(2/(n + 2)). */

static const asp_param exponent_params[] = {
    { "exponent", -2, 1, 2e10, 20, "n of cos^n; 0 is the uniform distribution" }
};
static void exponent_to(const double *v, asp_roughness *out)
{
    double alpha = aspi_sqrt(2.0 / (v[0] + 2.0));
    convert_put(out, alpha, alpha, 0.0);
}
static void exponent_from(const asp_roughness *in, double *v)
{
    v[0] = 2.0 / convert_square(in->alpha_x) - 2.0;
}

/* ---- the table */

#define COUNT_OF(a) (sizeof (a) / sizeof (a)[0])
#define CONVENTION(name) name##_params, COUNT_OF(name##_params), name##_to, name##_from

static const asp_convention conventions[] = {
    { "alpha", "mitsuba", "alpha itself: Mitsuba 3, dj_brdf, RGL, Asperity",
      "alpha_x, alpha_y", "the same", "Walter, Marschner, Li, Torrance 2007", CONVENTION(alpha) },
    { "disney", NULL, "Disney's principled BRDF",
      "r^2/aspect, r^2 aspect, at least 0.001 each; aspect = sqrt(1 - 0.9 anisotropic)",
      "r = (ax ay)^(1/4), anisotropic = (1 - ay/ax)/0.9", "Burley 2012, sec. 5.4",
      CONVENTION(disney) },
    { "gltf", NULL, "glTF 2.0; most engines where isotropic",
      "mix(r^2, 1, strength^2), r^2", "r = sqrt(ay), strength = sqrt((ax - ay)/(1 - ay))",
      "glTF 2.0 appendix B; KHR_materials_anisotropy", CONVENTION(gltf) },
    { "materialx", NULL, "MaterialX, node roughness_anisotropy",
      "min(r^2/aspect, 1), r^2 aspect; aspect = sqrt(1 - min(anisotropy, 0.98))",
      "r = (ax ay)^(1/4), anisotropy = 1 - ay/ax", "MaterialX PBR library, roughness_anisotropy",
      CONVENTION(materialx) },
    { "openpbr", NULL, "OpenPBR surface",
      "r^2 sqrt(2/(1 + (1 - a)^2)), times 1 - a across", "r^4 = (ax^2 + ay^2)/2, a = 1 - ay/ax",
      "MaterialX library, open_pbr_anisotropy", CONVENTION(openpbr) },
    { "filament", "imageworks", "Filament; Imageworks",
      "r^2 (1 + a), r^2 (1 - a)", "r^2 = (ax + ay)/2, a = (ax - ay)/(ax + ay)",
      "Kulla, Conty 2017; Filament, anisotropic model", CONVENTION(filament) },
    { "pbrt", "pbrt4", "pbrt-v4 with remaproughness",
      "sqrt(roughness)", "roughness = alpha^2", "pbrt-v4, RoughnessToAlpha", CONVENTION(pbrt) },
    { "pbrt3", NULL, "pbrt-v3 with remaproughness",
      "1.62142 + 0.819955 x + 0.1734 x^2 + 0.0171201 x^3 + 0.000640711 x^4, x = ln(roughness)",
      "by bisection", "pbrt-v3, RoughnessToAlpha", CONVENTION(pbrt3) },
    { "smoothness", NULL, "engines that turn roughness round",
      "(1 - smoothness)^2", "smoothness = 1 - sqrt(alpha)", "Lagarde, de Rousiers 2014, sec. 3.2",
      CONVENTION(smoothness) },
    { "exponent", "blinn_phong", "the exponent of Phong and Blinn",
      "sqrt(2/(n + 2))", "n = 2/alpha^2 - 2", "Walter, Marschner, Li, Torrance 2007, sec. 5.2",
      CONVENTION(exponent) },
};

static const asp_convention *const convention_table[] = {
    &conventions[0], &conventions[1], &conventions[2], &conventions[3], &conventions[4],
    &conventions[5], &conventions[6], &conventions[7], &conventions[8], &conventions[9], NULL
};

const asp_convention *const *asp_conventions(void) { return convention_table; }

const asp_convention *asp_find_convention(const char *name)
{
    size_t i;
    for (i = 0; i < COUNT_OF(conventions); i++)
        if (!strcmp(conventions[i].name, name)
            || (conventions[i].alias && !strcmp(conventions[i].alias, name)))
            return &conventions[i];
    return NULL;
}

/* ---- the public calls */

static asp_status convention_check(const asp_convention *c, const double *numbers, asp_error *err)
{
    size_t i;
    for (i = 0; i < c->param_count; i++) {
        const asp_param *p = &c->params[i];
        if (!(numbers[i] <= p->high && (p->low_open ? numbers[i] > p->low : numbers[i] >= p->low)))
            return asp_fail_range(err, p->name, numbers[i], p->low, p->low_open, p->high);
    }
    return ASP_OK;
}

asp_status asp_convention_to_alpha(const asp_convention *c, const double *numbers,
                                   asp_roughness *out, asp_error *err)
{
    asp_roughness r;
    asp_map map;
    asp_status s = convention_check(c, numbers, err);
    if (s)
        return s;
    c->to_alpha(numbers, &r);
    s = asp_map_from_roughness(r.alpha_x, r.alpha_y, r.rotation, 0.0, 0.0, &map, err);
    if (!s)
        *out = r;
    return s;
}

static int convert_near(double a, double b, double scale) { return aspi_abs(a - b) <= 1e-12 * scale; }

asp_status asp_convention_from_alpha(const asp_convention *c, const asp_roughness *in,
                                     double *numbers, asp_error *err)
{
    double v[ASP_CONVENTION_NUMBERS] = { 0 };
    asp_roughness r = *in, back;
    asp_status s;
    size_t i;
    if (in->mean_x != 0.0 || in->mean_y != 0.0)
        return asp_fail(err, ASP_EINVAL, c->name, "has no number for a mean slope");
    if (r.alpha_x < r.alpha_y) { /* the rougher axis is the tangent */
        r.alpha_x = in->alpha_y;
        r.alpha_y = in->alpha_x;
        r.rotation += r.rotation > 0.0 ? -0.5 * ASP_PI : 0.5 * ASP_PI;
    }
    if (convert_near(r.alpha_x, r.alpha_y, r.alpha_x))
        r.alpha_y = r.alpha_x;
    if (c->param_count < 2 && r.alpha_x != r.alpha_y)
        return asp_fail(err, ASP_EINVAL, c->name, "has no number for anisotropy");
    if (r.alpha_x == r.alpha_y)
        r.rotation = 0.0;
    c->from_alpha(&r, v);
    s = convention_check(c, v, err);
    if (s)
        return s;
    c->to_alpha(v, &back);
    if (!convert_near(back.alpha_x, r.alpha_x, r.alpha_x)
        || !convert_near(back.alpha_y, r.alpha_y, r.alpha_x))
        return asp_fail(err, ASP_EINVAL, c->name, "has no numbers for so rough or smooth a surface");
    for (i = 0; i < c->param_count; i++)
        numbers[i] = v[i];
    return ASP_OK;
}

asp_status asp_convention_parse(const char *text, const asp_convention **which, asp_roughness *out,
                                asp_error *err)
{
    double v[ASP_CONVENTION_NUMBERS];
    const asp_convention *c;
    aspi_spec spec;
    char name[64];
    size_t i;
    asp_status s = aspi_spec_cut(text, strlen(text), &spec, err);
    if (s)
        return s;
    i = spec.name_size < sizeof name ? spec.name_size : sizeof name - 1;
    memcpy(name, spec.name, i);
    name[i] = '\0';
    c = asp_find_convention(name);
    if (!c)
        return aspi_spec_fail(&spec, text, ASP_EUNKNOWN, name, i, "no such convention", err);
    for (i = 0; i < c->param_count; i++) {
        v[i] = c->params[i].initial;
        s = aspi_spec_number(&spec, c->params[i].name, &v[i], NULL, err);
        if (s)
            return s;
    }
    s = aspi_spec_rest(&spec, "unknown key; see asperity convert-ndf --conventions", err);
    if (s)
        return s;
    s = asp_convention_to_alpha(c, v, out, err);
    if (s)
        return aspi_spec_blame(&spec, err ? err->name : "", s, err);
    *which = c;
    return ASP_OK;
}
