/* fresnel.h - reflectance of a facet, in both precisions. c is clamped to [0, 1]. */

#include "asperity/elementary.h"

#ifndef ASP_FRESNEL_NAMES
#define ASP_FRESNEL_NAMES
#define aspi_unit_cosine ASP_NAME(aspi_unit_cosine)
#define aspi_fresnel_dielectric ASP_NAME(aspi_fresnel_dielectric)
#define aspi_other_side2 ASP_NAME(aspi_other_side2)
#define aspi_sheet ASP_NAME(aspi_sheet)
#define aspi_fresnel_conductor ASP_NAME(aspi_fresnel_conductor)
#define aspi_conductor_ratio ASP_NAME(aspi_conductor_ratio)
#define aspi_fresnel_conductor_at ASP_NAME(aspi_fresnel_conductor_at)
#define aspi_fresnel_schlick ASP_NAME(aspi_fresnel_schlick)
#define aspi_fresnel_f82 ASP_NAME(aspi_fresnel_f82)
#endif

#if (ASP_PRECISION == 64 && !defined(ASP_FRESNEL_64)) || \
    (ASP_PRECISION == 32 && !defined(ASP_FRESNEL_32))
#if ASP_PRECISION == 64
#define ASP_FRESNEL_64
#else
#define ASP_FRESNEL_32
#endif

ASP_FN asp_real aspi_unit_cosine(asp_real c)
{
    asp_real low = c < R(0.0) ? R(0.0) : c;
    return low > R(1.0) ? R(1.0) : low;
}

/* The square of g, eta times the cosine on the other side; below 0 is total internal reflection. */
ASP_FN asp_real aspi_other_side2(asp_real c, asp_real eta)
{
    /* each form keeps its digits where the other cancels: eta near 1, and eta near 0 */
    asp_real near = (eta - R(1.0)) * (eta + R(1.0)) + c * c;
    asp_real small = eta * eta - (R(1.0) - c) * (R(1.0) + c);
    return eta < R(0.5) ? small : near;
}

/* Walter et al. 2007, eq. 22, over one denominator. */
ASP_FN asp_real aspi_fresnel_dielectric(asp_real cosine, asp_real eta)
{
    asp_real c = aspi_unit_cosine(cosine), g2 = aspi_other_side2(c, eta);
    asp_real g = aspi_sqrt(g2 < R(0.0) ? R(0.0) : g2), difference = g - c, sum = g + c;
    asp_real p = c * sum - R(1.0), q = c * difference + R(1.0);
    asp_real over = sum * sum * (q * q);
    asp_real f = R(0.5) * (difference * difference) * (q * q + p * p) / (over < R(1e-30) ? R(1e-30) : over);
    return g2 < R(0.0) ? R(1.0) : f;
}

/* F with the reflections inside a sheet summed up. */
ASP_FN asp_real aspi_sheet(asp_real F) { return R(2.0) * F / (R(1.0) + F); }

/* Unpolarised reflectance of eta + i k at the squared cosine c2: Rs = (t1 - t2)/(t1 + t2),
 * Rp = Rs (t3 - t4)/(t3 + t4), and their mean .x/.y. */
ASP_FN asp_v2 aspi_conductor_ratio(asp_real c2, asp_real eta, asp_real k)
{
    asp_real s2 = R(1.0) - c2;
    asp_real eta2 = eta * eta, k2 = k * k;
    asp_real t0 = eta2 - k2 - s2;
    asp_real m = aspi_sqrt(t0 * t0 + R(4.0) * eta2 * k2);
    asp_real twice = (m + t0) * (c2 + c2);
    asp_real t1 = m + c2, t2 = aspi_sqrt(twice < R(0.0) ? R(0.0) : twice);
    asp_real t3 = c2 * m + s2 * s2, t4 = t2 * s2;
    asp_v2 out;
    out.x = (t1 - t2) * t3;
    out.y = (t1 + t2) * (t3 + t4);
    return out;
}

/* `_at`: c2 is in [0, 1] already. */
ASP_FN asp_real aspi_fresnel_conductor_at(asp_real c2, asp_real eta, asp_real k)
{
    asp_v2 r = aspi_conductor_ratio(c2, eta, k);
    return r.x / (r.y < R(1e-30) ? R(1e-30) : r.y);
}

ASP_FN asp_real aspi_fresnel_conductor(asp_real cosine, asp_real eta, asp_real k)
{
    asp_real c = aspi_unit_cosine(cosine);
    return aspi_fresnel_conductor_at(c * c, eta, k);
}

/* Schlick 1994. */
ASP_FN asp_real aspi_fresnel_schlick(asp_real cosine, asp_real f0)
{
    asp_real x = R(1.0) - aspi_unit_cosine(cosine);
    asp_real x2 = x * x;
    return f0 + (R(1.0) - f0) * (x2 * x2 * x);
}

/* Schlick minus a c (1 - c)^6, a such that the value at c = 1/7 is tinted; 1/7 is where the added
 * term is largest (Kutz, Hasan, Edmondson 2021). 1/(c82 (1 - c82)^6) = 7^7/6^6. */
ASP_FN asp_real aspi_fresnel_f82(asp_real cosine, asp_real f0, asp_real tint)
{
    asp_real c = aspi_unit_cosine(cosine);
    asp_real x = R(1.0) - c, x2 = x * x, x5 = x2 * x2 * x;
    asp_real f82 = f0 + (R(1.0) - f0) * R(7776.0 / 16807.0);
    asp_real a = f82 * (R(1.0) - tint) * R(823543.0 / 46656.0);
    asp_real f = f0 + (R(1.0) - f0) * x5 - a * c * (x5 * x);
    f = f < R(0.0) ? R(0.0) : f;
    return f > R(1.0) ? R(1.0) : f;
}
#endif
