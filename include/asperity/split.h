/* split.h - what a facet of a dielectric does with light, in both precisions
 *
 * Walter et al. 2007, section 5, written for a facet m of any length: its squared length l2 and its inverse q are
 * all that is needed of it, and two roots. eta is the index of the other side over that of the side of wi. */

#include "asperity/facet.h"
#include "asperity/fresnel.h"

#ifndef ASP_SPLIT_NAMES
#define ASP_SPLIT_NAMES
#define aspi_split ASP_NAME(aspi_split)
#define aspi_split_at ASP_NAME(aspi_split_at)
#define aspi_split_way ASP_NAME(aspi_split_way)
#define aspi_split_density ASP_NAME(aspi_split_density)
#endif

#if (ASP_PRECISION == 64 && !defined(ASP_SPLIT_64)) || \
    (ASP_PRECISION == 32 && !defined(ASP_SPLIT_32))
#if ASP_PRECISION == 64
#define ASP_SPLIT_64
#else
#define ASP_SPLIT_32
#endif

/* wi.m and g |m|, where g is eta times the cosine on the other side, and F. */
typedef struct aspi_split { asp_real d, e, F; } aspi_split;

/* Walter et al. 2007, eq. 22: F = r^2 (1 + t^2)/2 is of degree 0 in m. */
ASP_FN aspi_split aspi_split_at(asp_v3 wi, asp_v3 m, asp_real l2, asp_real eta)
{
    aspi_split s;
    asp_real d = aspi_dot(wi, m), d2 = d * d;
    /* each form keeps its digits where the other cancels: eta near 1, and eta near 0 */
    asp_real near = (eta - R(1.0)) * (eta + R(1.0)) * l2 + d2, small = eta * eta * l2 - (l2 - d2);
    asp_real e2 = eta < R(0.5) ? small : near, e = aspi_sqrt(aspi_max(e2, R(0.0)));
    asp_real sum = e + d, difference = e - d;
    asp_real r = difference / sum, t = (d * sum - l2) / (d * difference + l2), F = R(0.5) * (r * r) * (R(1.0) + t * t);
    s.d = d;
    s.e = e;
    s.F = aspi_min(d, e2) <= R(0.0) ? R(1.0) : F; /* e2 < 0 is total reflection */
    return s;
}

/* Where the light goes, a unit vector to rounding: mirrored, or refracted (eqs. 39-40); q is 1/l2 and inverse
 * 1/eta. */
ASP_FN asp_v3 aspi_split_way(const aspi_split *s, asp_v3 wi, asp_v3 m, asp_real q, asp_real inverse, int crosses)
{
    asp_real into = inverse * (s->d - s->e), twice = R(2.0) * s->d;
    asp_real by = q * (crosses ? into : twice), of = crosses ? inverse : R(1.0);
    m.x = by * m.x - of * wi.x;
    m.y = by * m.y - of * wi.y;
    m.z = by * m.z - of * wi.z;
    return m;
}

/* Its density, from `lobe` of a mirror, D/(4 sigma_i): per solid angle of what crosses there is
 * eta g / (c - g)^2 of facets (eq. 17), where (g - c)(g + c) = eta^2 - 1. */
ASP_FN asp_real aspi_split_density(const aspi_split *s, asp_real lobe, asp_real q, asp_real eta, int crosses)
{
    asp_real x = (s->e + s->d) * q * (R(1.0) / ((eta - R(1.0)) * (eta + R(1.0))));
    asp_real p = aspi_finite((R(1.0) - s->F) * lobe * ((s->d * x) * (s->e * x) * (R(4.0) * eta)));
    asp_real stays = s->F * lobe;
    return crosses ? p : stays;
}
#endif
