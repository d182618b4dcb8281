/* rough_diffuse.c - Lambertian facets under any distribution
 *
 * f = albedo/pi G2/(cos_i cos_o) int max(0, wi.m) max(0, wo.m) D(m) dm, with the visible facets of either
 * side as nodes: over the visible normals of wi the integral is sigma(wi) times the mean of max(0, wo.m).
 * Exact but for the rule, a lattice of ROUGH_NODES points of (u1, u2) (Fibonacci's, made periodic in u2
 * by itself and in u1 by reflection); both sides are averaged, so that f is reciprocal to rounding. One facet
 * drawn by random numbers instead is an unbiased estimate: asp_eval_stochastic.
 *
 * Approximations by name, which take their one number from the slopes' spread along x and y (tan^2 of
 * sigma = (alpha_x^2 + alpha_y^2)/4, of the Gaussian facets of the same mean |slope|, which every distribution
 * has): `oren_nayar` (Oren, Nayar
 * 1994, the qualitative model) and `fujii` (Fujii 2012, without its dark ring at grazing angles). `eon`
 * (Portsmouth, Kutz, Hill 2025) gives back what fujii's loses, albedo 1 - E(w), so that facets of albedo 1
 * return all light: with Em the mean of E
 *
 *     f = fujii + (1 - E(wi))(1 - E(wo)) / (pi (1 - Em))  a^2 Em / (1 - a (1 - Em)) */
#ifndef ASP_PRECISION
#include "bsdf/bsdf.h"

#define ROUGH_NODES 233
#define ROUGH_STEP 144

extern const asp_bsdf asp_bsdf_rough_diffuse;

#define ASP_NDF rough_diffuse
#define ASP_PRECISION 64
#include "rough_diffuse.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "rough_diffuse.c"
#undef ASP_PRECISION
#undef ASP_NDF

static double given_back(double a, double mean)
{
    return a * a * mean / (1.0 - a * (1.0 - mean)) / aspi_max_64(1.0 - mean, 1e-12);
}

/* 2 sigma(w), w horizontal, is the mean of |slope| along w without the mean slope; Gaussian facets have
 * alpha/sqrt(pi). */
static double alpha_along(const asp_ndf *level, double x, double y)
{
    asp_vec3 w, back;
    w.x = x;
    w.y = y;
    w.z = 0.0;
    back.x = -x;
    back.y = -y;
    back.z = 0.0;
    return aspi_sqrt_64(ASP_PI) * (asp_sigma(level, w) + asp_sigma(level, back));
}

/* b.g is the approximations' one number. */
static asp_status rough_diffuse_prepare(asp_material *out, asp_error *err)
{
    asp_ndf level;
    double x, y, angle, mean;
    (void)err;
    if (out->b.r == ROUGH_EXACT)
        return ASP_OK;
    level = out->ndf;
    level.map.tx = level.map.ty = 0.0;
    x = alpha_along(&level, 1.0, 0.0);
    y = alpha_along(&level, 0.0, 1.0);
    out->b.g = aspi_atan_64(0.5 * aspi_sqrt_64(x * x + y * y), 1.0);
    if (out->b.r != ROUGH_EON)
        return ASP_OK;
    angle = rough_diffuse_fujii_angle_64(out);
    /* the mean of E(w) against 2 cos dcos */
    mean = (1.0 + (2.0 / 3.0 - 28.0 / (15.0 * ASP_PI)) * angle) / (1.0 + (0.5 - 2.0 / (3.0 * ASP_PI)) * angle);
    out->c.r = given_back(out->a.r, mean);
    out->c.g = given_back(out->a.g, mean);
    out->c.b = given_back(out->a.b, mean);
    return ASP_OK;
}

static asp_status rough_diffuse_parse(aspi_spec *spec, asp_material *out, asp_error *err)
{
    static const char *const forms[] = { "exact", "oren_nayar", "fujii", "eon" };
    aspi_item *item;
    asp_status s;
    size_t i = 0;
    out->a.r = out->a.g = out->a.b = 0.8;
    out->b.r = ROUGH_EXACT;
    s = aspi_spec_colour(spec, "albedo", 0.0, 0, 1.0, &out->a, NULL, err);
    if (s || (item = aspi_spec_find(spec, "form")) == NULL)
        return s;
    while (i < ROUGH_FORMS && (strlen(forms[i]) != item->value_size
                     || memcmp(forms[i], item->value, item->value_size)))
        i++;
    if (i == ROUGH_FORMS)
        return aspi_spec_fail(spec, item->value, ASP_EUNKNOWN, "form", 4,
                              "expected exact, oren_nayar, fujii or eon", err);
    out->b.r = (double)i;
    return ASP_OK;
}

static const aspi_bsdf_key rough_diffuse_keys[] = {
    { "albedo", "of a facet, 0 to 1, default 0.8" },
    { "form", "exact (default), oren_nayar, fujii or eon" },
    { NULL, NULL }
};

ASP_RECORD asp_bsdf asp_bsdf_rough_diffuse = {
    "rough_diffuse", "Lambertian facets", "Heitz et al. 2016, sec. 5.3; Oren, Nayar 1994",
    rough_diffuse_keys, 0, ASPI_FACETS_DIFFUSE, rough_diffuse_parse, rough_diffuse_prepare,
    ASPI_BSDF_OWN(rough_diffuse)
};

#else
#include "asperity/elementary.h"
#include "bsdf/bsdf_number.h"
#include "bsdf/reflection.h"

#ifndef ROUGH_DIFFUSE_NAMES
#define ROUGH_DIFFUSE_NAMES
#define half_at ASP_NDF_NAME(_half_at)
#define half_mean ASP_NDF_NAME(_half_mean)
#define masked_part ASP_NDF_NAME(_masked_part)
#define exact_part ASP_NDF_NAME(_exact_part)
#define named_part ASP_NDF_NAME(_named_part)
#define fujii_angle ASP_NDF_NAME(_fujii_angle)
#define fujii_lost ASP_NDF_NAME(_fujii_lost)
#endif

/* max(0, b.m) of a facet visible from a. */
static asp_real half_at(const asp_shape *k, const asp_v3 *a, const asp_v3 *b, asp_real u1, asp_real u2)
{
    return aspi_above(aspi_dot(*b, ASPI_CALL(asp_sample_visible)(k, *a, u1, u2)));
}

/* Its mean over those facets. */
static asp_real half_mean(const asp_shape *k, const asp_v3 *a, const asp_v3 *b)
{
    asp_real sum = R(0.0);
    int i;
    for (i = 0; i < ROUGH_NODES; i++) {
        asp_real x = (R(i) + R(0.5)) * R(1.0 / ROUGH_NODES);
        asp_real y = R(i * ROUGH_STEP % ROUGH_NODES) * R(1.0 / ROUGH_NODES);
        sum = sum + half_at(k, a, b, x, y);
    }
    return sum * R(1.0 / ROUGH_NODES);
}

/* What masking leaves of the integral. */
static asp_real masked_part(const asp_mat *mat, const asp_v3 *wi, const asp_v3 *wo, asp_real si, asp_real so,
                            asp_real integral)
{
    const asp_shape *k = &mat->ndf;
    asp_real mi = aspi_masked(k, *wi, si, mat->mask), mo = aspi_masked(k, *wo, so, mat->mask);
    return integral * aspi_joint(wi->z, wo->z, mi, mo, R(1.0), R(1.0), R(1.0),
                                 mat->mask & 15 ? ASP_MASK_UNCORRELATED : ASP_MASK_CORRELATED);
}

/* pi f / albedo. */
static asp_real exact_part(const asp_mat *mat, const asp_v3 *wi, const asp_v3 *wo)
{
    const asp_shape *k = &mat->ndf;
    asp_real si = ASPI_CALL(asp_sigma)(k, *wi), so = ASPI_CALL(asp_sigma)(k, *wo);
    return masked_part(mat, wi, wo, si, so, R(0.5) * (si * half_mean(k, wi, wo) + so * half_mean(k, wo, wi)));
}

asp_c3 ASPI_CALL(asp_eval_stochastic)(const asp_mat *mat, asp_v3 wi, asp_v3 wo, asp_real u1, asp_real u2)
{
    asp_real f = (wi.x + wi.y + wi.z + wo.x + wo.y + wo.z) * R(0.0), si, so;
    asp_c3 out;
    if (mat->model != &asp_bsdf_rough_diffuse || mat->b.r != R(ROUGH_EXACT))
        return ASPI_CALL(asp_eval)(mat, wi, wo);
    if (wi.z > R(0.0) && wo.z > R(0.0) && f == R(0.0)) {
        si = ASPI_CALL(asp_sigma)(&mat->ndf, wi);
        so = ASPI_CALL(asp_sigma)(&mat->ndf, wo);
        f = R(1.0 / ASP_PI) * masked_part(mat, &wi, &wo, si, so, si * half_at(&mat->ndf, &wi, &wo, u1, u2));
    }
    out.r = mat->a.r * f;
    out.g = mat->a.g * f;
    out.b = mat->a.b * f;
    return out;
}

/* Fujii's number reaches up to 1, where f is 0 at last. */
static asp_real fujii_angle(const asp_mat *mat) { return mat->b.g < R(1.0) ? mat->b.g : R(1.0); }

/* 1 - E(w) of fujii's form with albedo 1: with s, c the sine and cosine of the angle t, E =
 * (1 + angle/pi (s (t - s c) + 2/3 (s (1 - s^3)/c - s))) over what divides f. Along the horizon it is 0. */
static asp_real fujii_lost(const asp_mat *mat, const asp_v3 *w)
{
    asp_real angle = fujii_angle(mat), s2 = w->x * w->x + w->y * w->y, s = aspi_sqrt(s2), c = w->z;
    asp_real G = s * (aspi_atan(s, c) - s * c)
               + R(2.0 / 3.0) * s * (c * (R(1.0) + s + s2) / (R(1.0) + s) - R(1.0));
    asp_real lost = angle * (R(0.5 - 2.0 / (3.0 * ASP_PI)) - R(1.0 / ASP_PI) * G)
                  / (R(1.0) + R(0.5 - 2.0 / (3.0 * ASP_PI)) * angle);
    return lost > R(0.0) ? lost : R(0.0);
}

/* pi f / albedo of the approximations: A + B s/t with s = wi.wo - cos cos (Oren, Nayar 1994, eq. 30 in
 * Cartesian form); t = max(cos_i, cos_o) where s > 0. */
static asp_real named_part(const asp_mat *mat, const asp_v3 *wi, const asp_v3 *wo)
{
    asp_real angle = mat->b.g, s2 = angle * angle;
    asp_real s = wi->x * wo->x + wi->y * wo->y, t;
    if (mat->b.r == R(ROUGH_OREN_NAYAR)) {
        t = s > R(0.0) ? aspi_max(aspi_max(wi->z, wo->z), ASP_SMALLEST) : R(1.0);
        s = s > R(0.0) ? s : R(0.0);
        return R(1.0) - R(0.5) * s2 / (s2 + R(0.33)) + R(0.45) * s2 / (s2 + R(0.09)) * s / t;
    }
    angle = fujii_angle(mat);
    t = s > R(0.0) ? aspi_max(aspi_max(wi->z, wo->z), ASP_SMALLEST) : R(1.0);
    return (R(1.0) + angle * s / t) / (R(1.0) + R(0.5 - 2.0 / (3.0 * ASP_PI)) * angle);
}

static void bsdf_eval(const asp_mat *mat, const asp_v3 *wi, const asp_v3 *wo, int cosine, asp_c3 *out)
{
    asp_real f = (wi->x + wi->y + wi->z + wo->x + wo->y + wo->z) * R(0.0), rest = f;
    if (wi->z > R(0.0) && wo->z > R(0.0) && f == R(0.0)) {
        asp_real by = R(1.0 / ASP_PI) * (cosine ? wo->z : R(1.0));
        f = by * (mat->b.r == R(ROUGH_EXACT) ? exact_part(mat, wi, wo) : named_part(mat, wi, wo));
        if (mat->b.r == R(ROUGH_EON))
            rest = by * (fujii_lost(mat, wi) * fujii_lost(mat, wo));
    }
    out->r = mat->a.r * f + mat->c.r * rest;
    out->g = mat->a.g * f + mat->c.g * rest;
    out->b = mat->a.b * f + mat->c.b * rest;
}

static asp_real bsdf_pdf(const asp_mat *mat, const asp_v3 *wi, const asp_v3 *wo)
{
    asp_real p = aspi_above(wo->z) * R(1.0 / ASP_PI);
    asp_real nothing = (wi->x + wi->y + wi->z + wo->x + wo->y) * R(0.0);
    (void)mat;
    return wi->z <= R(0.0) ? nothing : p + nothing;
}

static asp_sampled bsdf_sample(const asp_mat *mat, asp_v3 wi, asp_real u1, asp_real u2, asp_real u3)
{
    asp_sampled out;
    (void)u3;
    out.wo = aspi_cosine_lobe(wi, u1, u2);
    out.pdf = bsdf_pdf(mat, &wi, &out.wo);
    bsdf_eval(mat, &wi, &out.wo, 0, &out.weight);
    out.weight.r = out.weight.r * R(ASP_PI);
    out.weight.g = out.weight.g * R(ASP_PI);
    out.weight.b = out.weight.b * R(ASP_PI);
    return out;
}
#endif
