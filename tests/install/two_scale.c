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
    ASP_KEYS_SLOPE, 0.2, 0, 0, two_scale_params, 2, NULL, ASP_NDF_OPS(two_scale)
};
#undef ASP_NDF

#else
#include "asperity/elementary.h"

/* names of our own carry the distribution's name and the precision */
#define ggx_area ASP_NDF_NAME(_area)

/* GGX of roughness a: half of |stretched w| + w, rewritten where that would cancel. */
ASP_FN asp_real ggx_area(asp_real a, asp_real w, asp_real s2)
{
    asp_real t2 = a * a * s2;
    asp_real h = aspi_sqrt(w * w + t2);
    asp_real up = R(0.5) * (h + aspi_abs(w));
    asp_real down = R(0.25) * t2 / aspi_max(up, R(1e-37));
    return w < R(0.0) ? down : up;
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

#if ASP_PRECISION == 64
/* Which scale, and what is left of u1 for it: u and v = 1 - u. The fine one takes u1 in [0, p) upwards,
 * the rough one [p, 1) downwards, so that they meet at u = 1. There every GGX sampler reaches the
 * horizon, at an azimuth that does not depend on the roughness: the sampler stays continuous. Where
 * they meet, v keeps only what p and u1 do not share: float32 samples in float64 too. */
typedef struct scale { double a, u, v; } scale;

ASP_FN scale choose(double ratio, double p, double u1)
{
    double low = aspi_max(p, 1e-30), high = aspi_max(1.0 - p, 1e-30);
    scale out;
    out.a = u1 < p ? 1.0 : ratio;
    out.u = u1 < p ? u1 / low : (1.0 - u1) / high;
    out.v = u1 < p ? (p - u1) / low : (u1 - p) / high;
    return out;
}

/* By what each shows to v; then the spherical cap (Dupuy, Benyoub 2023), its point stretched. */
ASP_FN asp_vec3 visible(double share, double ratio, asp_vec3 v, double u1, double u2)
{
    double s2 = v.x * v.x + v.y * v.y;
    double fine = (1.0 - share) * ggx_area(1.0, v.z, s2), rough = share * ggx_area(ratio, v.z, s2);
    scale c = choose(ratio, fine / aspi_max(fine + rough, 1e-300), u1);
    double t2 = c.a * c.a * s2, inv = 1.0 / aspi_sqrt(t2 + v.z * v.z);
    double up = 1.0 + aspi_abs(v.z) * inv, low = t2 * inv * inv / up;     /* low = 2 - up */
    double cap = v.z < 0.0 ? low : up;
    double r = aspi_sqrt(c.u * cap * ((v.z < 0.0 ? up : low) + c.v * cap));
    asp_vec2 t = aspi_sincos2pi(u2);
    asp_vec3 m;
    m.x = c.a * (r * t.x + c.a * v.x * inv);
    m.y = c.a * (r * t.y + c.a * v.y * inv);
    m.z = c.v * cap;
    return m;
}

/* tan^2 = a^2 u / (1 - u) */
ASP_FN asp_vec3 normal(double share, double ratio, double u1, double u2)
{
    scale c = choose(ratio, 1.0 - share, u1);
    double r = c.a * aspi_sqrt(c.u);
    asp_vec2 t = aspi_sincos2pi(u2);
    asp_vec3 m;
    m.x = r * t.x;
    m.y = r * t.y;
    m.z = aspi_sqrt(c.v);
    return m;
}
#endif

ASP_FN asp_v3 ndf_visible(const asp_shape *k, asp_v3 v, asp_real u1, asp_real u2)
{
    asp_vec3 wide, m;
    asp_v3 out;
    wide.x = v.x;
    wide.y = v.y;
    wide.z = v.z;
    m = visible(k->shape[0], k->shape[1], wide, u1, u2);
    out.x = (asp_real)m.x;
    out.y = (asp_real)m.y;
    out.z = (asp_real)m.z;
    return out;
}

ASP_FN asp_v3 ndf_normal(const asp_shape *k, asp_real u1, asp_real u2)
{
    asp_vec3 m = normal(k->shape[0], k->shape[1], u1, u2);
    asp_v3 out;
    out.x = (asp_real)m.x;
    out.y = (asp_real)m.y;
    out.z = (asp_real)m.z;
    return out;
}

#include "asperity/ndf_loops.h"
#endif
