/* ndf_loops.h - the four formulas of a distribution as functions and as loops over blocks
 *
 * Read once per precision, after the formulas. Nothing here knows which distribution it serves. */

#include "asperity/facet.h"

static void ndf_visible_1(const asp_shape *k, asp_real vx, asp_real vy, asp_real vz, asp_real u1,
                          asp_real u2, asp_real out[3])
{
    asp_v3 v, m;
    v.x = vx;
    v.y = vy;
    v.z = vz;
    m = ndf_visible(k, v, u1, u2);
    out[0] = m.x;
    out[1] = m.y;
    out[2] = m.z;
}

static void ndf_normal_1(const asp_shape *k, asp_real u1, asp_real u2, asp_real out[3])
{
    asp_v3 m = ndf_normal(k, u1, u2);
    out[0] = m.x;
    out[1] = m.y;
    out[2] = m.z;
}

/* One call for a whole reflection: what calls in turn would pass through memory stays in registers. */
static void ndf_reflect_1(const asp_shape *k, asp_real wx, asp_real wy, asp_real wz, asp_real u1,
                          asp_real u2, asp_mirrored *out)
{
    asp_v3 wi, wo, v, m;
    asp_v2 a;
    wi.x = wx;
    wi.y = wy;
    wi.z = wz;
    v = aspi_view(k, wi);
    out->sigma_i = ndf_sigma(k, v.z, aspi_length2(v));
    m = aspi_normalize(aspi_facet_back(k, ndf_visible(k, v, u1, u2)));
    a = aspi_density_arguments(k, m);
    out->density = aspi_density_result(k, ndf_density(k, a.x, a.y), m.z);
    wo = aspi_reflect(wi, m);
    v = aspi_view(k, wo);
    out->sigma_o = ndf_sigma(k, v.z, aspi_length2(v));
    out->wo_x = wo.x;
    out->wo_y = wo.y;
    out->wo_z = wo.z;
    out->m_z = m.z;
    out->cosine = aspi_dot(wi, m);
}

ASP_CLONES static void ndf_density_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT r2,
                                     const asp_real *ASP_RESTRICT z2, asp_real *ASP_RESTRICT out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = ndf_density(k, r2[i], z2[i]);
}

ASP_CLONES static void ndf_sigma_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT w,
                                   const asp_real *ASP_RESTRICT s2, asp_real *ASP_RESTRICT out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = ndf_sigma(k, w[i], s2[i]);
}

/* A distribution whose formula is long may bring this loop itself, in stages: it defines
 * ASP_OWN_VISIBLE_N. */
#ifndef ASP_OWN_VISIBLE_N
ASP_CLONES static void ndf_visible_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT vx,
                                     const asp_real *ASP_RESTRICT vy,
                                     const asp_real *ASP_RESTRICT vz,
                                     const asp_real *ASP_RESTRICT u1,
                                     const asp_real *ASP_RESTRICT u2, asp_real *ASP_RESTRICT mx,
                                     asp_real *ASP_RESTRICT my, asp_real *ASP_RESTRICT mz)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v3 v, m;
        v = aspi_at(vx, vy, vz, i);
        m = ndf_visible(k, v, u1[i], u2[i]);
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
        asp_v3 m = ndf_normal(k, u1[i], u2[i]);
        mx[i] = m.x;
        my[i] = m.y;
        mz[i] = m.z;
    }
}
#undef ASP_OWN_VISIBLE_N
