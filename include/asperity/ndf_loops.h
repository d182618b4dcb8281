/* ndf_loops.h - the four formulas of a distribution through the slope map, single and in loops
 *
 * Read once per precision, after the formulas. Nothing here knows which distribution it serves. */

#include "asperity/facet.h"

/* ---- the formulas at vectors of the standard frame */

#ifdef ASP_NDF_PLANAR
ASP_FN asp_real ndf_density_at(const asp_shape *k, asp_v3 m) { return ndf_density(k, m); }

ASP_FN asp_real ndf_sigma_at(const asp_shape *k, asp_v3 v) { return ndf_sigma(k, v); }
#else
ASP_FN asp_real ndf_density_at(const asp_shape *k, asp_v3 m)
{
    return ndf_density(k, aspi_length2(m), m.z * m.z);
}

ASP_FN asp_real ndf_sigma_at(const asp_shape *k, asp_v3 v)
{
    return ndf_sigma(k, v.z, aspi_length2(v));
}
#endif

/* ---- seen through the map */

ASP_FN asp_real ndf_world_density(const asp_shape *k, asp_v3 m)
{
    return aspi_density_result(k, ndf_density_at(k, aspi_density_facet(k, m)), m.z);
}

ASP_FN asp_v3 ndf_world_visible(const asp_shape *k, asp_v3 w, asp_real u1, asp_real u2)
{
    return aspi_normalize(aspi_facet_back(k, ndf_visible(k, aspi_view(k, w), u1, u2)));
}

ASP_FN asp_v3 ndf_world_normal(const asp_shape *k, asp_real u1, asp_real u2)
{
    return aspi_normalize(aspi_facet_back(k, ndf_normal(k, u1, u2)));
}

/* ---- single calls */

static asp_real ndf_density_1(const asp_shape *k, asp_real mx, asp_real my, asp_real mz)
{
    return ndf_world_density(k, aspi_vector(mx, my, mz));
}

static asp_real ndf_sigma_1(const asp_shape *k, asp_real wx, asp_real wy, asp_real wz)
{
    return ndf_sigma_at(k, aspi_view(k, aspi_vector(wx, wy, wz)));
}

static void ndf_visible_1(const asp_shape *k, asp_real wx, asp_real wy, asp_real wz, asp_real u1,
                          asp_real u2, asp_real out[3])
{
    asp_v3 m = ndf_world_visible(k, aspi_vector(wx, wy, wz), u1, u2);
    out[0] = m.x;
    out[1] = m.y;
    out[2] = m.z;
}

static void ndf_normal_1(const asp_shape *k, asp_real u1, asp_real u2, asp_real out[3])
{
    asp_v3 m = ndf_world_normal(k, u1, u2);
    out[0] = m.x;
    out[1] = m.y;
    out[2] = m.z;
}

/* One call for a whole reflection: what calls in turn would pass through memory stays in registers. */
static void ndf_reflect_1(const asp_shape *k, asp_real wx, asp_real wy, asp_real wz, asp_real u1,
                          asp_real u2, asp_mirrored *out)
{
    asp_v3 wi = aspi_vector(wx, wy, wz), wo, v, m;
    v = aspi_view(k, wi);
    out->sigma_i = ndf_sigma_at(k, v);
    m = aspi_normalize(aspi_facet_back(k, ndf_visible(k, v, u1, u2)));
    out->density = ndf_world_density(k, m);
    wo = aspi_reflect(wi, m);
    out->sigma_o = ndf_sigma_at(k, aspi_view(k, wo));
    out->wo_x = wo.x;
    out->wo_y = wo.y;
    out->wo_z = wo.z;
    out->m_z = m.z;
    out->cosine = aspi_dot(wi, m);
}

/* ---- loops */

ASP_CLONES static void ndf_density_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT mx,
                                     const asp_real *ASP_RESTRICT my,
                                     const asp_real *ASP_RESTRICT mz, asp_real *ASP_RESTRICT out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = ndf_world_density(k, aspi_vector(mx[i], my[i], mz[i]));
}

/* A distribution whose formula is long may bring this loop or the visible normals' itself, in stages: it
 * defines ASP_OWN_SIGMA_N or ASP_OWN_VISIBLE_N. */
#ifndef ASP_OWN_SIGMA_N
ASP_CLONES static void ndf_sigma_n(const asp_shape *k, size_t n, asp_real sign,
                                   const asp_real *ASP_RESTRICT wx, const asp_real *ASP_RESTRICT wy,
                                   const asp_real *ASP_RESTRICT wz, asp_real *ASP_RESTRICT out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = ndf_sigma_at(k, aspi_view(k, aspi_vector(sign * wx[i], sign * wy[i],
                                                          sign * wz[i])));
}
#endif

#ifndef ASP_OWN_VISIBLE_N
ASP_CLONES static void ndf_visible_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT wx,
                                     const asp_real *ASP_RESTRICT wy,
                                     const asp_real *ASP_RESTRICT wz,
                                     const asp_real *ASP_RESTRICT u1,
                                     const asp_real *ASP_RESTRICT u2, asp_real *ASP_RESTRICT mx,
                                     asp_real *ASP_RESTRICT my, asp_real *ASP_RESTRICT mz)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v3 m = ndf_world_visible(k, aspi_vector(wx[i], wy[i], wz[i]), u1[i], u2[i]);
        mx[i] = m.x;
        my[i] = m.y;
        mz[i] = m.z;
    }
}
#endif

ASP_CLONES static void ndf_normal_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT u1,
                                    const asp_real *ASP_RESTRICT u2, asp_real *ASP_RESTRICT mx,
                                    asp_real *ASP_RESTRICT my, asp_real *ASP_RESTRICT mz)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v3 m = ndf_world_normal(k, u1[i], u2[i]);
        mx[i] = m.x;
        my[i] = m.y;
        mz[i] = m.z;
    }
}
#undef ASP_OWN_SIGMA_N
#undef ASP_OWN_VISIBLE_N
