/* reflection.h - the formulas of reflection by facets, shared by single calls and loops
 *
 * The half vector m of wi and wo gives D(m), the two views give sigma, and the scattering model makes
 * f of them:
 *     f = value(F(wi.m), D J / 4),  J = G2 / (cos_i cos_o)
 *     pdf = p D / (4 sigma_i) + (1 - p) cos_o / pi,  p = 1 unless the model is mixed. */

#include "asperity/facet.h"
#include "asperity/fresnel.h"

#ifndef ASPI_REFLECTION_NAMES
#define ASPI_REFLECTION_NAMES
#define aspi_above ASP_NAME(aspi_above)
#define aspi_half_vector ASP_NAME(aspi_half_vector)
#define aspi_cosine_lobe ASP_NAME(aspi_cosine_lobe)
#define aspi_lobe_around ASP_NAME(aspi_lobe_around)
#define aspi_reflected ASP_NAME(aspi_reflected)
#define aspi_facet_part ASP_NAME(aspi_facet_part)
#define aspi_mixed_density ASP_NAME(aspi_mixed_density)
#endif

#if (ASP_PRECISION == 64 && !defined(ASPI_REFLECTION_64)) || \
    (ASP_PRECISION == 32 && !defined(ASPI_REFLECTION_32))
#if ASP_PRECISION == 64
#define ASPI_REFLECTION_64
#else
#define ASPI_REFLECTION_32
#endif

/* A cosine, 0 below the horizon. */
ASP_FN asp_real aspi_above(asp_real z) { return z < R(0.0) ? R(0.0) : z; }

/* The half vector; zero, which has density 0, where wi and wo cancel. */
ASP_FN asp_v3 aspi_half_vector(asp_v3 wi, asp_v3 wo)
{
    asp_real l2, scale;
    wi.x = wi.x + wo.x;
    wi.y = wi.y + wo.y;
    wi.z = wi.z + wo.z;
    l2 = wi.x * wi.x + wi.y * wi.y + wi.z * wi.z;
    scale = R(1.0) / aspi_sqrt(l2 > R(0.0) ? l2 : R(1.0));
    wi.x = wi.x * scale;
    wi.y = wi.y * scale;
    wi.z = wi.z * scale;
    return wi;
}

/* The direction with sin^2 and cos^2 as given, turned by u2. It does not depend on wi, but a NaN there must
 * come out. */
ASP_FN asp_v3 aspi_lobe_around(asp_v3 wi, asp_real s2, asp_real c2, asp_real u2)
{
    asp_v2 t = aspi_sincos2pi(u2);
    asp_real r = aspi_sqrt(s2), nothing = (wi.x + wi.y + wi.z) * R(0.0);
    asp_v3 w;
    w.x = r * t.x + nothing;
    w.y = r * t.y + nothing;
    w.z = aspi_sqrt(c2) + nothing;
    return w;
}

/* Density cos / pi. */
ASP_FN asp_v3 aspi_cosine_lobe(asp_v3 wi, asp_real u1, asp_real u2)
{
    return aspi_lobe_around(wi, u1, R(1.0) - u1, u2);
}

/* `by` J of a reflection as .x/.y; 0 where a direction is below the horizon. The facet is given by the squares
 * of its cosines to the normal and to wi, with their signs. */
ASP_FN asp_v2 aspi_reflected(const asp_shape *k, asp_v3 wi, asp_v3 wo, asp_real mz2, asp_real c2,
                             asp_real sigma_i, asp_real sigma_o, asp_real by, int mask)
{
    asp_real si = aspi_masked(k, wi, sigma_i, mask), so = aspi_masked(k, wo, sigma_o, mask);
    asp_real c = aspi_sqrt(aspi_above(c2));
    asp_real dark = aspi_min(aspi_min(wi.z, wo.z), aspi_min(c2, mz2));
    asp_v2 out = aspi_joint_ratio(wi.z, wo.z, si, so, aspi_sqrt(aspi_above(mz2)), c, c, mask);
    out.x = dark <= R(0.0) ? R(0.0) : by * out.x;
    return out;
}

/* The same for the facet m, as a number; `by` is D/4 for f. */
ASP_FN asp_real aspi_facet_part(const asp_shape *k, asp_v3 wi, asp_v3 wo, asp_real mz, asp_real c,
                                asp_real sigma_i, asp_real sigma_o, asp_real by, int mask)
{
    asp_v2 J = aspi_reflected(k, wi, wo, mz * aspi_abs(mz), c * aspi_abs(c), sigma_i, sigma_o, by, mask);
    return aspi_finite(J.x / J.y);
}

ASP_FN asp_real aspi_mixed_density(asp_real ci, asp_real co, asp_real lobe, asp_real share)
{
    asp_real p = share * lobe + (R(1.0) - share) * (aspi_above(co) * R(1.0 / ASP_PI));
    return ci <= R(0.0) ? R(0.0) : p;
}
#endif
