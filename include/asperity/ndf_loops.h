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
    return aspi_density_result(k, ndf_density_at(k, aspi_facet(k, m)), m.z);
}

ASP_FN asp_v3 ndf_world_visible(const asp_shape *k, asp_v3 w, asp_real u1, asp_real u2)
{
    return aspi_normalize(aspi_facet_back(k, ndf_visible(k, aspi_view(k, w), u1, u2)));
}

ASP_FN asp_v3 ndf_world_normal(const asp_shape *k, asp_real u1, asp_real u2)
{
    return aspi_normalize(aspi_facet_back(k, ndf_normal(k, u1, u2)));
}

/* For directions above the mean plane, v.z >= 0, sigma may be simpler: a formula that then has ndf_sigma's
 * bits is ndf_sigma_up, and ASP_NDF_SIGMA_UP says that there is one. */
#ifdef ASP_NDF_SIGMA_UP
#define NDF_ANY_BELOW(bits) ((bits) >> (8 * sizeof(bits) - 1))
ASP_FN asp_real ndf_sigma_up_at(const asp_shape *k, asp_v3 v)
{
    return ndf_sigma_up(k, v.z, aspi_length2(v));
}
#else
#define NDF_ANY_BELOW(bits) ((void)(bits), 0)
ASP_FN asp_real ndf_sigma_up_at(const asp_shape *k, asp_v3 v) { return ndf_sigma_at(k, v); }
#endif

/* What is known of a reflection once the facet is drawn; not yet sigma. m is the standard surface's as
 * ndf_visible drew it, of which D is simpler; or where the visible normals come from stages of their own
 * the unit normal that they give. */
#ifdef ASP_OWN_VISIBLE_N
#define NDF_DRAW(k, wi, v, u1, u2) ndf_world_visible(k, wi, u1, u2)
#else
#define NDF_DRAW(k, wi, v, u1, u2) ndf_visible(k, v, u1, u2)
#endif

ASP_FN void ndf_reflect(const asp_shape *k, asp_v3 wi, asp_v3 m, asp_mirrored *out)
{
#ifdef ASP_OWN_VISIBLE_N
    asp_v3 back = m, wo;
    out->density = ndf_world_density(k, m);
#else
    asp_v3 back = aspi_facet_back(k, m), wo;
    asp_real scale = R(1.0) / aspi_sqrt(aspi_max(aspi_dot(back, back), ASP_TINY));
    back.x = back.x * scale;
    back.y = back.y * scale;
    back.z = back.z * scale;
    m.x = m.x * scale;
    m.y = m.y * scale;
    m.z = back.z;
    out->density = aspi_density_result(k, ndf_density_at(k, m), m.z);
#endif
    wo = aspi_reflect(wi, back);
    out->wo_x = wo.x;
    out->wo_y = wo.y;
    out->wo_z = wo.z;
    out->m_z = back.z;
    out->cosine = aspi_dot(wi, back);
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

/* What calls in turn would pass through memory stays in registers. */
static void ndf_reflect_1(const asp_shape *k, asp_real wx, asp_real wy, asp_real wz, asp_real u1,
                          asp_real u2, asp_mirrored *out)
{
    asp_v3 wi = aspi_vector(wx, wy, wz), v = aspi_view(k, wi);
    out->sigma_i = ndf_sigma_at(k, v);
    ndf_reflect(k, wi, NDF_DRAW(k, wi, v, u1, u2), out);
    out->sigma_o = ndf_sigma_at(k, aspi_view(k, aspi_vector(out->wo_x, out->wo_y, out->wo_z)));
}

/* ---- loops */

/* A distribution whose formula is long may bring this loop, sigma's or the visible normals' itself, in stages: it
 * defines ASP_OWN_DENSITY_N, ASP_OWN_SIGMA_N or ASP_OWN_VISIBLE_N. */
#ifndef ASP_OWN_DENSITY_N
ASP_CLONES static void ndf_density_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT mx,
                                     const asp_real *ASP_RESTRICT my,
                                     const asp_real *ASP_RESTRICT mz, asp_real *ASP_RESTRICT out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = ndf_world_density(k, aspi_vector(mx[i], my[i], mz[i]));
}
#endif

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

/* In stages, short enough for the processor to overlap several elements. The sign bits tell whether any
 * direction that matters lies below the mean plane: a wo that points down carries no weight. */
ASP_CLONES static void ndf_reflect_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT wx,
                                     const asp_real *ASP_RESTRICT wy,
                                     const asp_real *ASP_RESTRICT wz,
                                     const asp_real *ASP_RESTRICT u1,
                                     const asp_real *ASP_RESTRICT u2, const asp_mirrored_s *out)
{
    asp_real *ASP_RESTRICT ox = out->wo_x, *ASP_RESTRICT oy = out->wo_y, *ASP_RESTRICT oz = out->wo_z;
    asp_real *ASP_RESTRICT mz = out->m_z, *ASP_RESTRICT c = out->cosine, *ASP_RESTRICT D = out->density;
    asp_real *ASP_RESTRICT si = out->sigma_i, *ASP_RESTRICT so = out->sigma_o;
    asp_real x[ASP_BLOCK], y[ASP_BLOCK], z[ASP_BLOCK];
    asp_bits below = 0;
    size_t i;
#ifndef ASP_OWN_VISIBLE_N
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_v3 v = aspi_view(k, aspi_vector(wx[i], wy[i], wz[i]));
        asp_v3 m = ndf_visible(k, v, u1[i], u2[i]);
        si[i] = ndf_sigma_up_at(k, v);
        below |= aspi_to_bits(v.z);
        x[i] = m.x;
        y[i] = m.y;
        z[i] = m.z;
    }
    if (NDF_ANY_BELOW(below))
        ndf_sigma_n(k, n, R(1.0), wx, wy, wz, si);
#else
    (void)below;
    ndf_visible_n(k, n, wx, wy, wz, u1, u2, x, y, z);
    ndf_sigma_n(k, n, R(1.0), wx, wy, wz, si);
#endif
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_mirrored r;
        ndf_reflect(k, aspi_vector(wx[i], wy[i], wz[i]), aspi_vector(x[i], y[i], z[i]), &r);
        ox[i] = r.wo_x;
        oy[i] = r.wo_y;
        oz[i] = r.wo_z;
        mz[i] = r.m_z;
        c[i] = r.cosine;
        D[i] = r.density;
    }
#ifndef ASP_OWN_SIGMA_N
    below = 0;
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_v3 v = aspi_view(k, aspi_vector(ox[i], oy[i], oz[i]));
        so[i] = ndf_sigma_up_at(k, v);
        below |= aspi_to_bits(v.z) & (asp_bits)~aspi_to_bits(oz[i]);
    }
    if (NDF_ANY_BELOW(below))
        ndf_sigma_n(k, n, R(1.0), ox, oy, oz, so);
#else
    ndf_sigma_n(k, n, R(1.0), ox, oy, oz, so);
#endif
}
#undef NDF_DRAW
#undef NDF_ANY_BELOW
#undef ASP_OWN_DENSITY_N
#undef ASP_OWN_SIGMA_N
#undef ASP_OWN_VISIBLE_N
