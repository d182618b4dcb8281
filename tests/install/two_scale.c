/* two_scale.c - two GGX roughnesses at once: a share of the facets is `ratio` times as rough
 *
 * A distribution that the library does not have, written as docs/new-distribution.md says. A mixture
 * of standard surfaces is a standard surface: densities and projected areas add up. */
#ifndef ASP_PRECISION
#include "asperity_ndf.h"

#define ASP_NDF two_scale
static const asp_param two_scale_params[] = {
    { "share", 0.0, 0, 1.0, 0.3, "share of the rougher facets" },
    { "ratio", 1.0, 0, 100.0, 4.0, "their roughness over the others'" },
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

/* The scale is chosen with u1 by what each shows to v; what is left of u1, stretched to [0, 1), is
 * uniform and goes to the spherical cap (Dupuy, Benyoub 2023). */
ASP_FN asp_v3 ndf_visible(const asp_shape *k, asp_v3 v, asp_real u1, asp_real u2)
{
    asp_real share = k->shape[0], s2 = v.x * v.x + v.y * v.y;
    asp_real fine = (R(1.0) - share) * ggx_area(R(1.0), v.z, s2);
    asp_real rough = share * ggx_area(k->shape[1], v.z, s2);
    asp_real p = fine / (fine + rough);
    asp_real left = u1 < p ? u1 / p : (u1 - p) / aspi_max(R(1.0) - p, R(1e-30));
    asp_real a = u1 < p ? R(1.0) : k->shape[1];
    asp_real t2 = a * a * s2;
    asp_real scale = R(1.0) / aspi_sqrt(t2 + v.z * v.z);
    asp_real up = R(1.0) + aspi_abs(v.z) * scale;
    asp_real cap = v.z < R(0.0) ? t2 * scale * scale / up : up;
    asp_real u = left < R(1.0) ? left : R(0.99999994);
    asp_real d = u * cap;
    asp_real r = aspi_sqrt(d * aspi_max(R(2.0) - d, R(0.0)));
    return ggx_normal(a, r, u2, a * v.x * scale, a * v.y * scale, (R(1.0) - u) * cap);
}

/* tan^2 = a^2 u / (1 - u) */
ASP_FN asp_v3 ndf_normal(const asp_shape *k, asp_real u1, asp_real u2)
{
    asp_real p = R(1.0) - k->shape[0];
    asp_real left = u1 < p ? u1 / p : (u1 - p) / aspi_max(R(1.0) - p, R(1e-30));
    asp_real a = u1 < p ? R(1.0) : k->shape[1];
    asp_real u = left < R(1.0) ? left : R(0.99999994);
    return ggx_normal(a, aspi_sqrt(u), u2, R(0.0), R(0.0), aspi_sqrt(R(1.0) - u));
}

#include "asperity/ndf_loops.h"
#endif
