/* two_scale.c - two GGX roughnesses at once: a share of the facets is `ratio` times as rough
 *
 * A distribution that the library does not have, written as docs/new-distribution.md says. A mixture
 * of standard surfaces is a standard surface: densities and projected areas add up. */
#ifndef ASP_PRECISION
#include "asperity_ndf.h"

#define ASP_NDF two_scale
static const asp_param two_scale_params[] = {
    { "share", 0.0, 0, 1.0, 0.25, "share of the rougher facets" },
    { "ratio", 1.0, 0, 16.0, 4.0, "their roughness over the others'" },
};

#define ASP_PRECISION 64
#include "two_scale.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "two_scale.c"
#undef ASP_PRECISION

ASP_RECORD asp_model asp_model_two_scale = {
    "two_scale", NULL, "Two GGX roughnesses", "a mixture of Walter et al. 2007, eq. 33",
    ASP_KEYS_SLOPE, 0.2, two_scale_params, 2, NULL, ASP_NDF_OPS(two_scale)
};
#undef ASP_NDF

#else
#include "asperity/elementary.h"

/* names of our own carry the distribution's name and the precision */
#define ggx_area ASP_NDF_NAME(_area)
#define ggx_normal ASP_NDF_NAME(_facet)
#define scale ASP_NDF_NAME(_scale)
#define choose ASP_NDF_NAME(_choose)

/* GGX of roughness a: half of |stretched w| + w, rewritten where that would cancel. */
ASP_FN asp_real ggx_area(asp_real a, asp_real w, asp_real s2)
{
    asp_real t2 = a * a * s2;
    asp_real h = aspi_sqrt(w * w + t2);
    asp_real up = R(0.5) * (h + aspi_abs(w));
    asp_real down = R(0.25) * t2 / aspi_max(up, R(1e-37));
    return w < R(0.0) ? down : up;
}

/* A normal of the upper hemisphere, its slope stretched by a. */
ASP_FN asp_v3 ggx_normal(asp_real a, asp_real r, asp_real u2, asp_real x, asp_real y, asp_real z)
{
    asp_v2 t = aspi_sincos2pi(u2);
    asp_v3 m;
    m.x = a * (r * t.x + x);
    m.y = a * (r * t.y + y);
    m.z = z;
    return m;
}

/* P22 = sum of share_i a_i^2 / (pi (a_i^2 + r^2)^2), homogeneous in (r^2, z^2). */
ASP_FN asp_real ndf_density(const asp_shape *k, asp_real r2, asp_real z2)
{
    asp_real share = k->shape[0], a2 = k->shape[1] * k->shape[1];
    asp_real fine = r2 + z2, rough = r2 + a2 * z2;
    return R(1.0 / ASP_PI) * ((R(1.0) - share) / (fine * fine) + share * a2 / (rough * rough));
}

ASP_FN asp_real ndf_sigma(const asp_shape *k, asp_real w, asp_real s2)
{
    asp_real share = k->shape[0];
    return (R(1.0) - share) * ggx_area(R(1.0), w, s2) + share * ggx_area(k->shape[1], w, s2);
}

/* Which scale, and what is left of u1 for it: u and v = 1 - u. The fine one takes u1 in [0, p) upwards,
 * the rough one [p, 1) downwards, so that they meet at u = 1. There every GGX sampler reaches the
 * horizon, at an azimuth that does not depend on the roughness: the sampler stays continuous. p is a
 * double in both precisions: near the horizon v keeps only what p and u1 do not share. */
typedef struct scale { asp_real a, u, v; } scale;

ASP_FN scale choose(const asp_shape *k, double p, asp_real u1)
{
    double low = p > 1e-30 ? p : 1e-30, high = 1.0 - p > 1e-30 ? 1.0 - p : 1e-30;
    scale out;
    out.a = u1 < p ? R(1.0) : k->shape[1];
    out.u = u1 < p ? (asp_real)(u1 / low) : (asp_real)((1.0 - u1) / high);
    out.v = u1 < p ? (asp_real)((p - u1) / low) : (asp_real)((u1 - p) / high);
    return out;
}

/* By what each shows to v; then the spherical cap (Dupuy, Benyoub 2023). */
ASP_FN asp_v3 ndf_visible(const asp_shape *k, asp_v3 v, asp_real u1, asp_real u2)
{
    double share = k->shape[0], d2 = (double)v.x * v.x + (double)v.y * v.y;
    double fine = (1.0 - share) * two_scale_area_64(1.0, v.z, d2);
    double rough = share * two_scale_area_64(k->shape[1], v.z, d2);
    double sum = fine + rough;
    scale c = choose(k, fine / (sum > 1e-300 ? sum : 1e-300), u1);
    asp_real s2 = v.x * v.x + v.y * v.y;
    asp_real t2 = c.a * c.a * s2;
    asp_real inv = R(1.0) / aspi_sqrt(t2 + v.z * v.z);
    asp_real up = R(1.0) + aspi_abs(v.z) * inv;
    asp_real low = t2 * inv * inv / up;                     /* 2 - up */
    asp_real cap = v.z < R(0.0) ? low : up;
    asp_real rest = (v.z < R(0.0) ? up : low) + c.v * cap;  /* 2 - u cap */
    return ggx_normal(c.a, aspi_sqrt(c.u * cap * rest), u2, c.a * v.x * inv, c.a * v.y * inv,
                      c.v * cap);
}

/* tan^2 = a^2 u / (1 - u) */
ASP_FN asp_v3 ndf_normal(const asp_shape *k, asp_real u1, asp_real u2)
{
    scale c = choose(k, 1.0 - k->shape[0], u1);
    return ggx_normal(c.a, aspi_sqrt(c.u), u2, R(0.0), R(0.0), aspi_sqrt(c.v));
}

#include "asperity/ndf_loops.h"
#endif
