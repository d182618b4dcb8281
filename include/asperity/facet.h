/* facet.h - directions, normals and masking through the slope map, in both precisions
 *
 * The standard surface sees everything through p = M q + t (see asperity.h section 3). */

#include "asperity/elementary.h"

#ifndef ASP_FACET_NAMES
#define ASP_FACET_NAMES
#define aspi_view ASP_NAME(aspi_view)
#define aspi_facet ASP_NAME(aspi_facet)
#define aspi_facet_back ASP_NAME(aspi_facet_back)
#define aspi_vector ASP_NAME(aspi_vector)
#define aspi_aimed ASP_NAME(aspi_aimed)
#define aspi_at ASP_NAME(aspi_at)
#define aspi_dot ASP_NAME(aspi_dot)
#define aspi_length2 ASP_NAME(aspi_length2)
#define aspi_unit_scale ASP_NAME(aspi_unit_scale)
#define aspi_normalize ASP_NAME(aspi_normalize)
#define aspi_density_result ASP_NAME(aspi_density_result)
#define aspi_reflect ASP_NAME(aspi_reflect)
#define aspi_masked ASP_NAME(aspi_masked)
#define aspi_hidden ASP_NAME(aspi_hidden)
#define aspi_joint ASP_NAME(aspi_joint)
#define aspi_joint_ratio ASP_NAME(aspi_joint_ratio)
#define aspi_lobe_density ASP_NAME(aspi_lobe_density)
#define aspi_finite ASP_NAME(aspi_finite)

/* Facets closer to the vertical than this have density 0; z^4 must not underflow. */
#define ASP_FLAT (ASP_PRECISION == 64 ? R(1e-70) : R(1e-9))
/* What a density is cut at instead of overflowing, and what a denominator is kept above: at most
 * 1e10 of D, 1e20 of 1/sigma and 1e5 of the rest are ever multiplied. */
#define ASP_LARGEST (ASP_PRECISION == 64 ? R(1e300) : R(3e38))
/* Squared lengths are kept above this where they divide; ASP_SMALLEST is added to what divides and may be 0,
 * far below its last digit otherwise. */
#define ASP_TINY (ASP_PRECISION == 64 ? R(1e-300) : R(1e-37))
#define ASP_SMALLEST (ASP_PRECISION == 64 ? R(1e-150) : R(1e-19))
#endif

#if (ASP_PRECISION == 64 && !defined(ASP_FACET_64)) || \
    (ASP_PRECISION == 32 && !defined(ASP_FACET_32))
#if ASP_PRECISION == 64
#define ASP_FACET_64
#else
#define ASP_FACET_32
#endif

/* A view and what else a formula of visible normals knows before its random numbers come. */
typedef struct aspi_aimed { asp_real x, y, z, w; } aspi_aimed;

ASP_FN asp_v3 aspi_vector(asp_real x, asp_real y, asp_real z)
{
    asp_v3 v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
}

/* Element i of a structure of arrays. */
ASP_FN asp_v3 aspi_at(const asp_real *x, const asp_real *y, const asp_real *z, size_t i)
{
    return aspi_vector(x[i], y[i], z[i]);
}

ASP_FN asp_real aspi_dot(asp_v3 a, asp_v3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

ASP_FN asp_real aspi_length2(asp_v3 a) { return a.x * a.x + a.y * a.y; }

ASP_FN asp_real aspi_finite(asp_real x) { return aspi_min(x, ASP_LARGEST); }

/* Slopes whose square is beyond this have density 0; the formulas' powers must not overflow. */
#define ASP_STEEPEST (ASP_PRECISION == 64 ? R(1e150) : R(1e18))

/* The mirror image of wi in a facet. */
ASP_FN asp_v3 aspi_reflect(asp_v3 wi, asp_v3 m)
{
    asp_real d = R(2.0) * aspi_dot(wi, m);
    m.x = d * m.x - wi.x;
    m.y = d * m.y - wi.y;
    m.z = d * m.z - wi.z;
    return m;
}

/* What makes a vector of squared length l2 a unit vector; 1 for the zero vector. */
ASP_FN asp_real aspi_unit_scale(asp_real l2)
{
    return R(1.0) / aspi_sqrt(l2 > R(0.0) ? l2 : R(1.0));
}

/* Unit vector of a; the zero vector gives the normal of the flat surface. */
ASP_FN asp_v3 aspi_normalize(asp_v3 a)
{
    asp_real l2 = a.x * a.x + a.y * a.y + a.z * a.z;
    asp_real scale = aspi_unit_scale(l2);
    asp_v3 out;
    out.x = a.x * scale;
    out.y = a.y * scale;
    out.z = l2 > R(0.0) ? a.z * scale : (l2 == l2 ? R(1.0) : l2);
    return out;
}

/* A direction as the standard surface sees it: (M^T w_xy, w.z - t.w_xy). */
ASP_FN asp_v3 aspi_view(const asp_shape *k, asp_v3 w)
{
    asp_v3 v;
    v.x = k->map.m00 * w.x + k->map.m10 * w.y;
    v.y = k->map.m01 * w.x + k->map.m11 * w.y;
    v.z = w.z - (k->map.tx * w.x + k->map.ty * w.y);
    return v;
}

/* A normal as the standard surface has it, times a positive number: (M^-1 (m_xy + t m.z), m.z). */
ASP_FN asp_v3 aspi_facet(const asp_shape *k, asp_v3 m)
{
    asp_real x = m.x + k->map.tx * m.z, y = m.y + k->map.ty * m.z;
    asp_v3 v;
    v.x = k->i00 * x + k->i01 * y;
    v.y = k->i10 * x + k->i11 * y;
    v.z = m.z;
    return v;
}

/* The way back, times a positive number: (M m_xy - t m.z, m.z). */
ASP_FN asp_v3 aspi_facet_back(const asp_shape *k, asp_v3 m)
{
    asp_v3 v;
    v.x = (k->map.m00 * m.x + k->map.m01 * m.y) - k->map.tx * m.z;
    v.y = (k->map.m10 * m.x + k->map.m11 * m.y) - k->map.ty * m.z;
    v.z = m.z;
    return v;
}

/* D(m) = D_std(m') / |det M|; 0 for facets that are vertical or turned down, whatever the formula made
 * of them. */
ASP_FN asp_real aspi_density_result(const asp_shape *k, asp_real standard, asp_real mz)
{
    return aspi_select(mz <= ASP_FLAT, R(0.0), aspi_finite(standard * k->inv_det));
}

/* Visible normals through reflection: D / (4 sigma_i). */
ASP_FN asp_real aspi_lobe_density(asp_real ci, asp_real D, asp_real sigma_i)
{
    asp_real p = aspi_finite(R(0.25) * D / (sigma_i + ASP_SMALLEST));
    return ci <= R(0.0) ? R(0.0) : p;
}

/* The projected area that masking divides by, w.z / G1: never less than w.z. `min`: Walter et al.
 * 2014, eq. 6. `wall`: the surface of mean slope t is closed by vertical walls of area |t| that face
 * +t; they are seen from the side of +t. */
ASP_FN asp_real aspi_masked(const asp_shape *k, asp_v3 w, asp_real sigma, int mask)
{
    asp_real facing = k->map.tx * w.x + k->map.ty * w.y;
    asp_real wall = sigma + (facing > R(0.0) ? facing : R(0.0));
    asp_real area = mask & ASP_MASK_WALL ? wall : sigma;
    return area < w.z ? w.z : area; /* with walls it is not less, but for rounding */
}

/* w.z Lambda, from the area seen from below, sigma(-w) = sigma(w) - (w.z - t.w_xy): nothing cancels
 * on an unskewed surface, nor with walls. */
ASP_FN asp_real aspi_hidden(const asp_shape *k, asp_v3 w, asp_real sigma_below, int mask)
{
    asp_real facing = k->map.tx * w.x + k->map.ty * w.y;
    asp_real wall = sigma_below + (facing < R(0.0) ? -facing : R(0.0));
    asp_real bound = sigma_below - facing;
    bound = bound < R(0.0) ? R(0.0) : bound;
    return mask & ASP_MASK_WALL ? wall : bound;
}

/* G2 / (cos_i cos_o) of two directions above the horizon as .x/.y; si, so are masked areas, mz and c the
 * cosines of m to the normal and to wi (= to wo in reflection).
 *   correlated    1/(si co + so ci - ci co)
 *   uncorrelated  1/(si so)
 *   V-cavity      min(1, 2 mz ci/c, 2 mz co/c) / (ci co)      (Torrance, Sparrow 1967) */
ASP_FN asp_v2 aspi_joint_ratio(asp_real ci, asp_real co, asp_real si, asp_real so, asp_real mz,
                               asp_real c_i, asp_real c_o, int mask)
{
    asp_real both = ci * co;
    asp_real correlated = si * co + (so - co) * ci;
    asp_real uncorrelated = si * so;
    asp_real groove_i = c_i * co, groove_o = c_o * ci;
    asp_real groove = groove_i > groove_o ? groove_i : groove_o;
    asp_real open = R(2.0) * mz;
    int closed = groove > open * both;
    int cavity = (mask & 15) == ASP_MASK_V_CAVITY;
    asp_real smith = (mask & 15) == ASP_MASK_UNCORRELATED ? uncorrelated : correlated;
    asp_real over = cavity ? (closed ? groove : both) : smith;
    asp_v2 out;
    out.x = cavity && closed ? open : R(1.0);
    out.y = aspi_abs(over) + ASP_SMALLEST;
    return out;
}

ASP_FN asp_real aspi_joint(asp_real ci, asp_real co, asp_real si, asp_real so, asp_real mz,
                           asp_real c_i, asp_real c_o, int mask)
{
    asp_v2 J = aspi_joint_ratio(ci, co, si, so, mz, c_i, c_o, mask);
    return J.x / J.y;
}
#endif
