/* test_laws_catch.c - the laws see what is wrong, and serve a model that the library does not know
 *
 * Each row spoils one function of GGX's record in one way and names a law that must break. Laws that
 * pass everything would fail here. */
#include "asperity_data.h"
#include "asperity_ndf.h"
#define ASP_PRECISION 64
#include "asperity/facet.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static asp_model ggx;   /* the sound record */

/* ------------------------------------------------------------------ ways to be wrong */

static double density_more(const asp_ndf *k, double mx, double my, double mz)
{
    return 1.00000001 * ggx.f64.density(k, mx, my, mz);
}

/* A wrong power in the tail only: what a general test at moderate angles would pass. */
static double density_tail(const asp_ndf *k, double mx, double my, double mz)
{
    double d = ggx.f64.density(k, mx, my, mz);
    asp_vec3 v = aspi_facet_64(k, aspi_vector_64(mx, my, mz));
    double r2 = v.x * v.x + v.y * v.y, z2 = v.z * v.z;
    return r2 > 400 * z2 ? d * sqrt(400 * z2 / r2) : d;
}

/* Singular at the mean slope, as a patched epsilon would make it. */
static double density_nan_lost(const asp_ndf *k, double mx, double my, double mz)
{
    double d = ggx.f64.density(k, mx, my, mz);
    return d == d ? d : 0;
}

static double sigma_more(const asp_ndf *k, double wx, double wy, double wz)
{
    asp_vec3 v = aspi_view_64(k, aspi_vector_64(wx, wy, wz));
    return ggx.f64.sigma(k, wx, wy, wz) * (v.z > 0 ? 1 + 1e-9 * (v.x * v.x + v.y * v.y) : 1);
}

/* Right above the mean plane, cancelling below it. */
static double sigma_cancels(const asp_ndf *k, double wx, double wy, double wz)
{
    asp_vec3 v = aspi_view_64(k, aspi_vector_64(wx, wy, wz));
    return 0.5 * (sqrt(v.z * v.z + (v.x * v.x + v.y * v.y)) + v.z);
}

static double sigma_negative(const asp_ndf *k, double wx, double wy, double wz)
{
    return ggx.f64.sigma(k, wx, wy, wz) - (aspi_view_64(k, aspi_vector_64(wx, wy, wz)).z < 0 ? 1e-9 : 0);
}

static void visible_as_normal(const asp_ndf *k, double vx, double vy, double vz, double u1,
                              double u2, double m[3])
{
    (void)vx;
    (void)vy;
    (void)vz;
    ggx.f64.normal(k, u1, u2, m);
}

/* The sampler is fed a direction that is not quite the view: two degrees off. */
static void visible_turned(const asp_ndf *k, double vx, double vy, double vz, double u1, double u2,
                           double m[3])
{
    ggx.f64.visible(k, vx + 0.035 * vz, vy, vz - 0.035 * vx, u1, u2, m);
}

static void visible_jumps(const asp_ndf *k, double vx, double vy, double vz, double u1, double u2,
                          double m[3])
{
    double shifted = u1 + 0.37;
    ggx.f64.visible(k, vx, vy, vz, shifted < 1 ? shifted : shifted - 1, u2, m);
}

static void normal_half(const asp_ndf *k, double u1, double u2, double m[3])
{
    ggx.f64.normal(k, u1, 0.5 * u2, m);
}

static void normal_end(const asp_ndf *k, double u1, double u2, double m[3])
{
    ggx.f64.normal(k, u1, u2, m);
    m[0] /= u1 > 0.9999999 ? 0 : 1;
}

static void density_n_other(const asp_ndf *k, size_t n, const double *mx, const double *my,
                            const double *mz, double *out)
{
    ggx.f64.density_n(k, n, mx, my, mz, out);
    out[n - 1] *= 1 + 2e-16;
}

static double sigma_tenth(const asp_ndf *k, double wx, double wy, double wz)
{
    return 1.0001 * ggx.f64.sigma(k, wx, wy, wz);
}

/* Not functions: every second call differs. */
static double density_drifts(const asp_ndf *k, double mx, double my, double mz)
{
    static unsigned calls;
    return (calls++ & 1 ? 1.0000001 : 1) * ggx.f64.density(k, mx, my, mz);
}

static void visible_drifts(const asp_ndf *k, double vx, double vy, double vz, double u1, double u2,
                           double m[3])
{
    static unsigned calls;
    ggx.f64.visible(k, vx, vy, vz, u1, u2, m);
    if (calls++ & 1) {
        double z = 1e-3 * m[2], size = sqrt(m[0] * m[0] + m[1] * m[1] + z * z);
        m[0] /= size; m[1] /= size; m[2] = z / size;
    }
}

static float sigma_coarse(const asp_ndff *k, float wx, float wy, float wz)
{
    return ggx.f32.sigma(k, wx, wy, wz) * 1.000003f;
}

static float density_coarse(const asp_ndff *k, float mx, float my, float mz)
{
    return ggx.f32.density(k, mx * 1.0000015f, my * 1.0000015f, mz);
}

/* ------------------------------------------------------------------ the table */

typedef struct mistake {
    const char *what, *law, *spec;
    void (*spoil)(asp_model *m);
} mistake;

#define SPOIL(name, member, function) \
    static void name(asp_model *m) { m->member = function; }
SPOIL(spoil_density_more, f64.density, density_more)
SPOIL(spoil_density_tail, f64.density, density_tail)
SPOIL(spoil_density_nan, f64.density, density_nan_lost)
SPOIL(spoil_sigma_more, f64.sigma, sigma_more)
SPOIL(spoil_sigma_cancels, f64.sigma, sigma_cancels)
SPOIL(spoil_sigma_negative, f64.sigma, sigma_negative)
SPOIL(spoil_sigma_tenth, f64.sigma, sigma_tenth)
SPOIL(spoil_density_drifts, f64.density, density_drifts)
SPOIL(spoil_visible_drifts, f64.visible, visible_drifts)
SPOIL(spoil_visible_normal, f64.visible, visible_as_normal)
SPOIL(spoil_visible_jumps, f64.visible, visible_jumps)
SPOIL(spoil_normal_end, f64.normal, normal_end)
SPOIL(spoil_density_n, f64.density_n, density_n_other)
SPOIL(spoil_sigma_coarse, f32.sigma, sigma_coarse)
SPOIL(spoil_density_coarse, f32.density, density_coarse)

/* The chi-square laws draw in batches: the loops must be wrong in the same way. */
static void visible_turned_n(const asp_ndf *k, size_t n, const double *vx, const double *vy,
                             const double *vz, const double *u1, const double *u2, double *mx,
                             double *my, double *mz)
{
    size_t i;
    for (i = 0; i < n; i++) {
        double m[3];
        visible_turned(k, vx[i], vy[i], vz[i], u1[i], u2[i], m);
        mx[i] = m[0]; my[i] = m[1]; mz[i] = m[2];
    }
}

static void normal_half_n(const asp_ndf *k, size_t n, const double *u1, const double *u2, double *mx,
                          double *my, double *mz)
{
    size_t i;
    for (i = 0; i < n; i++) {
        double m[3];
        normal_half(k, u1[i], u2[i], m);
        mx[i] = m[0]; my[i] = m[1]; mz[i] = m[2];
    }
}

static void spoil_visible_turned(asp_model *m)
{
    m->f64.visible = visible_turned;
    m->f64.visible_n = visible_turned_n;
}

static void spoil_normal_half(asp_model *m)
{
    m->f64.normal = normal_half;
    m->f64.normal_n = normal_half_n;
}

/* eval and pdf take the density, the sampler knows nothing of it: sample and pdf disagree, and so
 * do weights and eval. */
static double density_sharper(const asp_ndf *k, double mx, double my, double mz)
{
    return 1.44 * ggx.f64.density(k, 1.2 * mx, 1.2 * my, mz);
}
static void density_sharper_n(const asp_ndf *k, size_t n, const double *mx, const double *my,
                              const double *mz, double *out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = density_sharper(k, mx[i], my[i], mz[i]);
}
static void spoil_density_sharper(asp_model *m)
{
    m->f64.density = density_sharper;
    m->f64.density_n = density_sharper_n;
}

/* Facets face their own way, seen or not: light meets some from behind. */
static void spoil_visible_any(asp_model *m) { m->f64.visible = visible_as_normal; }

/* A tenth more facets than there are: D alone, of which neither masking nor samplers know. */
static double density_tenth(const asp_ndf *k, double mx, double my, double mz)
{
    return 1.1 * ggx.f64.density(k, mx, my, mz);
}
static void density_tenth_n(const asp_ndf *k, size_t n, const double *mx, const double *my, const double *mz,
                            double *out)
{
    for (size_t i = 0; i < n; i++)
        out[i] = density_tenth(k, mx[i], my[i], mz[i]);
}
static void spoil_density_tenth(asp_model *m)
{
    m->f64.density = density_tenth;
    m->f64.density_n = density_tenth_n;
}

/* No facet hides another. */
static double sigma_open(const asp_ndf *k, double wx, double wy, double wz)
{
    (void)k;
    (void)wx;
    (void)wy;
    return wz > 0 ? wz : 0;
}
static void sigma_open_n(const asp_ndf *k, size_t n, double sign, const double *wx, const double *wy, const double *wz,
                         double *out)
{
    for (size_t i = 0; i < n; i++)
        out[i] = sigma_open(k, sign * wx[i], sign * wy[i], sign * wz[i]);
}
static void spoil_sigma_open(asp_model *m)
{
    m->f64.sigma = sigma_open;
    m->f64.sigma_n = sigma_open_n;
}

/* One reflection's density 1e-9 off, and one refraction's: what samples say of themselves. */
static void reflect_off(const asp_ndf *k, double wx, double wy, double wz, double u1, double u2, asp_reflection *out)
{
    ggx.f64.reflect(k, wx, wy, wz, u1, u2, out);
    out->pdf *= 1 + 1e-9;
}
SPOIL(spoil_reflect_off, f64.reflect, reflect_off)

static void refract_off(const asp_ndf *k, double wx, double wy, double wz, double u1, double u2, double u3, double eta,
                        double inverse, asp_refraction *out)
{
    ggx.f64.refract(k, wx, wy, wz, u1, u2, u3, eta, inverse, out);
    out->pdf *= 1 + 1e-9;
}
SPOIL(spoil_refract_off, f64.refract, refract_off)

/* A density that is not that of slopes. */
static double density_lower(const asp_ndf *k, double mx, double my, double mz)
{
    return ggx.f64.density(k, mx, my, mz) * (mz < 0.9 ? 1 + 1e-9 : 1);
}
SPOIL(spoil_density_lower, f64.density, density_lower)

static const mistake mistakes[] = {
    { "facets seen from behind", "no_boundary", "toy:alpha=0.3", spoil_visible_any },
    { "a tenth more facets", "walk", "toy:alpha=0.3", spoil_density_tenth },
    { "D and sampler of different roughness", "walk", "toy:alpha=0.3", spoil_density_sharper },
    { "visible normals that are all normals", "walk", "toy:alpha=0.3", spoil_visible_any },
    { "a tenth more facets", "furnace", "toy:alpha=0.1", spoil_density_tenth },
    { "nothing hides anything", "furnace", "toy:alpha=0.3", spoil_sigma_open },
    { "the density of a reflection 1e-9 off", "weight", "toy:alpha=0.3", spoil_reflect_off },
    { "D and sampler of different roughness", "weight", "toy:alpha=0.3", spoil_density_sharper },
    { "the density of a refraction 1e-9 off", "refraction", "toy:alpha=0.3", spoil_refract_off },
    { "D and sampler of different roughness", "refraction", "toy:alpha=0.3", spoil_density_sharper },
    { "D off where facets are steep", "pdf_normal", "toy:alpha=0.3", spoil_density_lower },
    { "a density 1e-8 too large", "pdf_normal", "toy:alpha=0.3", spoil_density_more },
    { "a density 1e-8 too large", "normalisation", "toy:alpha=0.3", spoil_density_more },
    { "a tail that falls too fast", "normalisation", "toy:alpha=0.3", spoil_density_tail },
    { "a tail that falls too fast", "sigma", "toy:alpha=0.3", spoil_density_tail },
    { "a NaN swallowed", "nan", "toy:alpha=0.3", spoil_density_nan },
    { "sigma 1e-9 off at grazing", "sigma", "toy:alpha=1", spoil_sigma_more },
    { "sigma that is not 0 turned over", "sigma_flip", "toy:alpha=0.3", spoil_sigma_negative },
    { "sigma that cancels below the horizon", "sigma", "toy:alpha=0.001", spoil_sigma_cancels },
    { "visible normals that are all normals", "batch", "toy:alpha=0.3", spoil_visible_normal },
    { "a view two degrees off", "sample_visible", "toy:alpha=0.3", spoil_visible_turned },
    { "a view two degrees off", "sample_bsdf", "toy:alpha=0.3", spoil_visible_turned },
    { "a view two degrees off", "sample_materials", "toy:alpha=0.3", spoil_visible_turned },
    { "sigma 1e-4 too large", "weak_furnace", "toy:alpha=0.3", spoil_sigma_tenth },
    { "a density that is no function", "adjoint", "toy:alpha=0.3", spoil_density_drifts },
    { "a density that is no function", "reciprocity", "toy:alpha=0.3", spoil_density_drifts },
    { "a sampler that is no function", "limits", "toy:alpha=0.3", spoil_visible_drifts },
    { "half of the normals", "sample_normal", "toy:alpha=0.3", spoil_normal_half },
    { "D and sampler of different roughness", "sample_visible", "toy:alpha=0.3",
      spoil_density_sharper },
    { "D and sampler of different roughness", "weight_histogram", "toy:alpha=0.3",
      spoil_density_sharper },
    { "D and masking of different roughness", "sigma", "toy:alpha=0.3", spoil_density_sharper },
    { "a sampler that jumps", "continuity", "toy:alpha=0.3", spoil_visible_jumps },
    { "infinite as u goes to 1", "finite", "toy:alpha=0.3", spoil_normal_end },
    { "one element of a batch an ulp off", "batch", "toy:alpha=0.3", spoil_density_n },
    { "float32 masking 3e-6 off", "float32", "toy:alpha=0.3", spoil_sigma_coarse },
    { "float32 slopes squared 3e-6 off", "float32", "toy:alpha=0.003", spoil_density_coarse },
};

static void note(void *context, const asp_law_result *r)
{
    asp_law_result *out = (asp_law_result *)context;
    *out = *r;
}

static int stop(void *context, double done)
{
    (void)done;
    return ++*(int *)context > 2;
}

int main(void)
{
    const asp_model *table[2] = { NULL, NULL };
    size_t i, passed = 0, failed = 0, broken = 0;
    asp_laws_options o = asp_laws_options_default();
    asp_law_result r;
    asp_model toy;
    asp_ndf ndf;
    asp_error err;
    int calls = 0, ok;
    ggx = *asp_find_model(NULL, "ggx");
    table[0] = &toy;
    o.samples = 100000;
    for (i = 0; i < sizeof mistakes / sizeof mistakes[0]; i++) {
        const mistake *m = &mistakes[i];
        toy = ggx;
        toy.name = "toy";
        toy.alias = NULL;
        o.only = m->law;
        memset(&r, 0, sizeof r);
        ok = asp_ndf_parse(table, m->spec, &ndf, &err) == ASP_OK
          && asp_laws_check(&ndf, &o, note, &r, &broken, &err) == ASP_OK && broken == 0 && r.passed;
        if (!ok)
            printf("  FAILED: the sound model breaks %s: %s\n", m->law, r.where);
        m->spoil(&toy);
        ok = ok && asp_ndf_parse(table, m->spec, &ndf, &err) == ASP_OK
          && asp_laws_check(&ndf, &o, note, &r, &broken, &err) == ASP_OK && broken == 1 && !r.passed;
        printf("  %-40s %-17s %s %.3g, allowed %.3g\n", m->what, m->law,
               ok ? "caught" : "FAILED: not caught", r.worst, r.allowed);
        passed += ok != 0;
        failed += ok == 0;
    }
    /* the errors of asp_laws_check itself */
    toy = ggx;
    asp_ndf_parse(table, "ggx:alpha=0.3", &ndf, NULL);
    o.only = "no_such_law";
    ok = asp_laws_check(&ndf, &o, NULL, NULL, NULL, &err) == ASP_EUNKNOWN;
    o.only = NULL;
    o.samples = 10;
    ok = ok && asp_laws_check(&ndf, &o, NULL, NULL, NULL, &err) == ASP_EINVAL
      && strcmp(err.name, "samples") == 0;
    o.samples = 1000;
    o.progress = stop;
    o.context = &calls;
    ok = ok && asp_laws_check(&ndf, &o, NULL, NULL, NULL, &err) == ASP_ECANCELLED;
    printf("  unknown law, too few samples, cancelled: %s\n", ok ? "refused" : "FAILED");
    passed += ok != 0;
    failed += ok == 0;
    printf("%zu passed, %zu failed\n", passed, failed);
    return failed != 0;
}
