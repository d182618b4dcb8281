/* bounded.c - visible normals of GGX without the directions that cannot be, asperity.h section 7
 *
 * Eto, Tokuyoshi 2023: mirrored in the standard surface's visible normals, the view gives directions that
 * are uniform on a spherical cap; those of its lower end map to wo below the horizon. A higher bound of
 * the cap, b = k cos, leaves most of them out, and the density grows accordingly:
 *     pdf = D / (2 (k w + |v|)),   k = (1 - a^2) s^2 / (s^2 + a^2 w^2),  s = 1 + |wi_xy|,
 * v the view in the standard frame, w its height, a the smaller roughness, at most 1. Derived for
 * surfaces without mean slope; others, and other distributions, are sampled as asp_sample does. */
#ifndef ASP_PRECISION
#include "bsdf/bsdf.h"

#define ASP_PRECISION 64
#include "bounded.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "bounded.c"
#undef ASP_PRECISION

#else
#include "core/blocks.h"
#include "bsdf/bsdf_number.h"
#include "bsdf/reflection.h"

#ifndef ASPI_BOUNDED_NAMES
#define ASPI_BOUNDED_NAMES
#define bounded ASP_NAME(bounded)
#define cap_bound ASP_NAME(cap_bound)
#define above_cap ASP_NAME(above_cap)
extern const asp_model asp_model_ggx, asp_model_ellipsoid;
#endif

/* Is the bound known for this material? */
ASP_FN int bounded(const asp_mat *mat, asp_v3 wi)
{
    const asp_shape *k = &mat->ndf;
    return (k->model == &asp_model_ggx || k->model == &asp_model_ellipsoid) && k->map.tx == R(0.0)
        && k->map.ty == R(0.0) && mat->model->facets == ASPI_FACETS_REFLECT && wi.z > R(0.0);
}

/* k of the head of this file. The smaller roughness is the smaller singular value of M. */
ASP_FN asp_real cap_bound(const asp_shape *k, asp_v3 wi)
{
    asp_real p = k->map.m00 * k->map.m00 + k->map.m01 * k->map.m01;
    asp_real q = k->map.m10 * k->map.m10 + k->map.m11 * k->map.m11;
    asp_real r = k->map.m00 * k->map.m10 + k->map.m01 * k->map.m11;
    asp_real half = R(0.5) * (p + q), apart = R(0.5) * (p - q);
    asp_real root = aspi_sqrt(apart * apart + r * r), det = p * q - r * r;
    asp_real a2 = aspi_min(aspi_max(det, R(0.0)) / (half + root), R(1.0));
    asp_real s = R(1.0) + aspi_sqrt(aspi_length2(wi)), s2 = s * s;
    return (R(1.0) - a2) * s2 / (s2 + a2 * wi.z * wi.z);
}

/* How far the mirror image of v in the facet of the standard surface lies above the end of the cap. Directions above
 * the horizon are all in it. */
ASP_FN asp_real above_cap(const asp_shape *k, asp_v3 v, asp_v3 m, asp_real bound)
{
    asp_v3 n = aspi_normalize(aspi_facet(k, m));
    return R(2.0) * aspi_dot(v, n) * n.z - v.z + bound * v.z;
}

asp_real ASPI_CALL(asp_pdf_bounded)(const asp_mat *mat, asp_v3 wi, asp_v3 wo)
{
    asp_v3 v, m;
    asp_real length, D, bound;
    if (!bounded(mat, wi))
        return ASPI_CALL(asp_pdf)(mat, wi, wo);
    m = aspi_half_vector(wi, wo);
    v = aspi_view(&mat->ndf, wi);
    length = aspi_sqrt(aspi_length2(v) + v.z * v.z);
    D = ASPI_CALL(asp_D)(&mat->ndf, m);
    bound = cap_bound(&mat->ndf, wi);
    if (wo.z <= R(0.0) && above_cap(&mat->ndf, v, m, bound) < R(0.0))
        return R(0.0);
    return aspi_finite(D / (R(2.0) * (bound * v.z + length)));
}

asp_sampled ASPI_CALL(asp_sample_bounded)(const asp_mat *mat, asp_v3 wi, asp_real u1, asp_real u2)
{
    const asp_shape *k = &mat->ndf;
    asp_sampled out;
    asp_v3 v, m;
    asp_v2 turn = aspi_sincos2pi(u2);
    asp_real length, low, z, r;
    if (!bounded(mat, wi))
        return ASPI_CALL(asp_sample)(mat, wi, u1, u2);
    v = aspi_view(k, wi);
    length = aspi_sqrt(aspi_length2(v) + v.z * v.z);
    v.x = v.x / length;
    v.y = v.y / length;
    v.z = v.z / length;
    low = cap_bound(k, wi) * v.z;
    z = R(1.0) - u1 * (R(1.0) + low);
    r = aspi_sqrt(aspi_max(u1 * (R(1.0) + low) * (R(1.0) + z), R(0.0)));
    m.x = v.x + r * turn.x;
    m.y = v.y + r * turn.y;
    m.z = v.z + z;
    m = aspi_normalize(aspi_facet_back(k, m));
    out.wo = aspi_reflect(wi, m);
    out.pdf = ASPI_CALL(asp_pdf_bounded)(mat, wi, out.wo);
    out.weight = ASPI_CALL(asp_eval_cos)(mat, wi, out.wo);
    r = out.pdf > R(0.0) ? R(1.0) / out.pdf : R(0.0);
    out.weight.r *= r;
    out.weight.g *= r;
    out.weight.b *= r;
    return out;
}
#endif
