/* walter.c - the sampler of the Ellipsoid NDF's own paper
 *
 * Walter, Dong, Marschner, Greenberg 2014, section 4.1, eqs. 34-46. */
#include "asperity_study.h"

#define ASP_PRECISION 64
#include "asperity/facet.h"

static asp_vec3 walter_cross(asp_vec3 a, asp_vec3 b)
{
    return aspi_vector_64(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}

/* The square to the disk (Shirley, Chiu 1997), eqs. 34-37. */
static asp_vec2 walter_disk(double u1, double u2)
{
    double a = 2 * u1 - 1, b = 2 * u2 - 1;
    int wide = aspi_abs_64(a) > aspi_abs_64(b);
    double r = wide ? a : b, other = wide ? b : a;
    asp_vec2 t = aspi_sincos2pi_64(r != 0 ? 0.125 * other / r : 0), out;
    out.x = r * (wide ? t.x : t.y);
    out.y = r * (wide ? t.y : t.x);
    return out;
}

/* A unit vector across e, which is a unit vector (Frisvad 2012): for views along the normal. */
static asp_vec3 walter_across(asp_vec3 e)
{
    double a = 1 / (1 + aspi_abs_64(e.z)), sign = e.z < 0 ? -1 : 1;
    return aspi_vector_64(1 - e.x * e.x * a, -e.x * e.y * a, -sign * e.x);
}

asp_vec3 asp_sample_visible_walter(const double A[9], asp_vec3 wi, double u1, double u2)
{
    asp_vec3 a = aspi_vector_64(A[0] * wi.x + A[1] * wi.y + A[2] * wi.z,
                                A[3] * wi.x + A[4] * wi.y + A[5] * wi.z,
                                A[6] * wi.x + A[7] * wi.y + A[8] * wi.z);
    asp_vec3 up = aspi_normalize_64(aspi_vector_64(A[2], A[5], A[8]));
    asp_vec3 e3 = aspi_normalize_64(a), e2 = walter_cross(e3, up), e1, p, m;
    asp_vec2 d = walter_disk(u1, u2);
    double l2 = aspi_dot_64(e2, e2), c = aspi_dot_64(e3, up), width = sqrt(aspi_max_64(1 - d.y * d.y, 0));
    /* (b), eqs. 38-41; below the mean plane 1 + cos would cancel: sin^2/(1 - cos) */
    double s = 0.5 * (c < 0 ? l2 / (1 - c) : 1 + c), x = s * d.x + (1 - s) * width;
    /* eq. 41 as (width - x) (width + x), which does not cancel at the crescent's outer edge */
    double gap = s * (width - d.x), z = sqrt(aspi_max_64(gap * (2 * width - gap), 0));
    /* (c), eqs. 42-44, by the first form of eq. 43, which is right for det A < 0 as well */
    e2 = l2 > 1e-30 ? aspi_normalize_64(e2) : walter_across(e3);
    e1 = walter_cross(e2, e3);
    /* (d), eqs. 45-46 */
    p = aspi_vector_64(x * e1.x + d.y * e2.x + z * e3.x, x * e1.y + d.y * e2.y + z * e3.y,
                       x * e1.z + d.y * e2.z + z * e3.z);
    m = aspi_vector_64(A[0] * p.x + A[3] * p.y + A[6] * p.z, A[1] * p.x + A[4] * p.y + A[7] * p.z,
                       A[2] * p.x + A[5] * p.y + A[8] * p.z);
    m.z = aspi_max_64(m.z, 0);               /* p.(A n) >= 0 but for rounding */
    return aspi_normalize_64(m);
}

#undef ASP_PRECISION
