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

/* A formula of the visible normals may come in two steps too, the first of them without random numbers:
 * ASP_NDF_VISIBLE_STEPS says so. */
#ifdef ASP_NDF_VISIBLE_STEPS
ASP_FN asp_v3 ndf_visible(const asp_shape *k, asp_v3 v, asp_real u1, asp_real u2)
{
    return ndf_visible_end(k, ndf_visible_begin(k, v), u1, u2);
}
#else
ASP_FN asp_v3 ndf_visible_begin(const asp_shape *k, asp_v3 v)
{
    (void)k;
    return v;
}

ASP_FN asp_v3 ndf_visible_end(const asp_shape *k, asp_v3 v, asp_real u1, asp_real u2)
{
    return ndf_visible(k, v, u1, u2);
}
#endif

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
#define NDF_NOTE(bits, more) ((bits) |= (more))
ASP_FN asp_real ndf_sigma_up_at(const asp_shape *k, asp_v3 v)
{
    return ndf_sigma_up(k, v.z, aspi_length2(v));
}
#else
#define NDF_ANY_BELOW(bits) ((void)(bits), 0)
#define NDF_NOTE(bits, more) ((void)(more))
ASP_FN asp_real ndf_sigma_up_at(const asp_shape *k, asp_v3 v) { return ndf_sigma_at(k, v); }
#endif

/* A reflection in steps, which loops take one by one: short loops let the processor overlap several
 * elements. What stands between the steps is the facet drawn, m: the standard surface's as ndf_visible gave
 * it, of which D is simpler, made as long as its world's unit normal `back`; or where the visible normals
 * come from stages of their own the unit normal that they give, twice. */
ASP_FN void ndf_unit(const asp_shape *k, asp_v3 *m, asp_v3 *back)
{
#ifdef ASP_OWN_VISIBLE_N
    (void)k;
    *back = *m;
#else
    asp_real scale;
    *back = aspi_facet_back(k, *m);
    scale = R(1.0) / aspi_sqrt(aspi_max(aspi_dot(*back, *back), ASP_TINY));
    back->x = back->x * scale;
    back->y = back->y * scale;
    back->z = back->z * scale;
    m->x = m->x * scale;
    m->y = m->y * scale;
    m->z = back->z;
#endif
}

/* The density of the mirrored direction. One that is a quotient, 1/ndf_density_over, saves a division. */
ASP_FN asp_real ndf_lobe(const asp_shape *k, asp_real ci, asp_v3 m, asp_real sigma_i)
{
#ifdef ASP_OWN_VISIBLE_N
    return aspi_lobe_density(ci, ndf_world_density(k, m), sigma_i);
#elif defined(ASP_NDF_DENSITY_OVER)
    asp_real over = ndf_density_over(k, aspi_length2(m), m.z * m.z) * sigma_i;
    return aspi_lobe_density(m.z <= ASP_FLAT ? R(0.0) : ci, k->inv_det, over);
#else
    return aspi_lobe_density(ci, aspi_density_result(k, ndf_density_at(k, m), m.z), sigma_i);
#endif
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
ASP_CLONES_SINGLE static void ndf_reflect_1(const asp_shape *k, asp_real wx, asp_real wy, asp_real wz,
                                            asp_real u1, asp_real u2, asp_mirrored *out)
{
    asp_v3 wi = aspi_vector(wx, wy, wz), v = aspi_view(k, wi), m, back, wo;
#ifdef ASP_OWN_VISIBLE_N
    m = ndf_world_visible(k, wi, u1, u2);
#else
    m = ndf_visible(k, v, u1, u2);
#endif
    ndf_unit(k, &m, &back);
    wo = aspi_reflect(wi, back);
    out->wo_x = wo.x;
    out->wo_y = wo.y;
    out->wo_z = wo.z;
    out->m_z = back.z;
    out->cosine = aspi_dot(wi, back);
    out->sigma_i = ndf_sigma_at(k, v);
    out->pdf = ndf_lobe(k, wi.z, m, out->sigma_i);
    out->sigma_o = ndf_sigma_at(k, aspi_view(k, wo));
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

#ifdef ASP_OWN_VISIBLE_N
#define NDF_LOBE(i) aspi_lobe_density(wz[i], p[i], si[i])
#else
#define NDF_LOBE(i) ndf_lobe(k, wz[i], aspi_vector(x[i], y[i], z[i]), si[i])
#endif

/* The sign bits tell whether any direction that matters lies below the mean plane: a wo that points down
 * carries no weight. */
ASP_CLONES static void ndf_reflect_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT wx,
                                     const asp_real *ASP_RESTRICT wy,
                                     const asp_real *ASP_RESTRICT wz,
                                     const asp_real *ASP_RESTRICT u1,
                                     const asp_real *ASP_RESTRICT u2, const asp_mirrored_s *out)
{
    asp_real *ASP_RESTRICT ox = out->wo_x, *ASP_RESTRICT oy = out->wo_y, *ASP_RESTRICT oz = out->wo_z;
    asp_real *ASP_RESTRICT mz = out->m_z, *ASP_RESTRICT c = out->cosine, *ASP_RESTRICT p = out->pdf;
    asp_real *ASP_RESTRICT si = out->sigma_i, *ASP_RESTRICT so = out->sigma_o;
    asp_real bx[ASP_BLOCK], by[ASP_BLOCK];
    asp_bits below = 0;
    size_t i;
#ifndef ASP_OWN_VISIBLE_N
    asp_real x[ASP_BLOCK], y[ASP_BLOCK], z[ASP_BLOCK];
    for (i = 0; i < n; i++) {
        asp_v3 v = aspi_view(k, aspi_vector(wx[i], wy[i], wz[i]));
        asp_v3 m = ndf_visible_begin(k, v);
        si[i] = ndf_sigma_up_at(k, v);
        NDF_NOTE(below, aspi_to_bits(v.z));
        x[i] = m.x;
        y[i] = m.y;
        z[i] = m.z;
    }
    if (NDF_ANY_BELOW(below))
        ndf_sigma_n(k, n, R(1.0), wx, wy, wz, si);
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_v3 m = ndf_visible_end(k, aspi_vector(x[i], y[i], z[i]), u1[i], u2[i]);
        x[i] = m.x;
        y[i] = m.y;
        z[i] = m.z;
    }
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_v3 m = aspi_vector(x[i], y[i], z[i]), back;
        ndf_unit(k, &m, &back);
        x[i] = m.x;
        y[i] = m.y;
        z[i] = m.z;
        bx[i] = back.x;
        by[i] = back.y;
        mz[i] = back.z;
    }
#endif
#ifdef ASP_OWN_VISIBLE_N
    ndf_visible_n(k, n, wx, wy, wz, u1, u2, bx, by, mz);
    ndf_sigma_n(k, n, R(1.0), wx, wy, wz, si);
    ndf_density_n(k, n, bx, by, mz, p);
#endif
    ASP_IN_PLACE
    for (i = 0; i < n; i++)
        p[i] = NDF_LOBE(i);
    below = 0;
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_v3 wi = aspi_vector(wx[i], wy[i], wz[i]), back = aspi_vector(bx[i], by[i], mz[i]), v;
        asp_v3 wo = aspi_reflect(wi, back);
        c[i] = aspi_dot(wi, back);
        ox[i] = wo.x;
        oy[i] = wo.y;
        oz[i] = wo.z;
        v = aspi_view(k, wo);
#ifndef ASP_OWN_SIGMA_N
        so[i] = ndf_sigma_up_at(k, v);
#endif
        NDF_NOTE(below, aspi_to_bits(v.z) & (asp_bits)~aspi_to_bits(wo.z));
    }
#ifndef ASP_OWN_SIGMA_N
    if (NDF_ANY_BELOW(below))
        ndf_sigma_n(k, n, R(1.0), ox, oy, oz, so);
#else
    (void)below;
    ndf_sigma_n(k, n, R(1.0), ox, oy, oz, so);
#endif
}
#undef NDF_ANY_BELOW
#undef ASP_OWN_DENSITY_N
#undef NDF_NOTE
#undef NDF_LOBE
#undef ASP_OWN_SIGMA_N
#undef ASP_OWN_VISIBLE_N
