/* ndf_loops.h - the four formulas of a distribution through the slope map, single and in loops
 *
 * Read once per precision, after the formulas. Nothing here knows which distribution it serves. */

#include "asperity/facet.h"
#include "asperity/split.h"

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

ASP_FN asp_v3 ndf_world_normal(const asp_shape *k, asp_real u1, asp_real u2)
{
    return aspi_normalize(aspi_facet_back(k, ndf_normal(k, u1, u2)));
}

/* Where ASP_NDF_UP says so the visible normals come in two steps, the first of them, ndf_aim, without random
 * numbers, and for directions above the mean plane, v.z >= 0, there are simpler forms with the same bits,
 * ndf_aim_up and ndf_sigma_up; ndf_aim_below mends a block in which a direction lies below. */
#ifdef ASP_NDF_UP
#define NDF_ANY_BELOW(bits) ((bits) >> (8 * sizeof(bits) - 1))
#define NDF_NOTE(bits, more) ((bits) |= (more))
ASP_FN asp_v3 ndf_visible(const asp_shape *k, asp_v3 v, asp_real u1, asp_real u2)
{
    return ndf_aimed(k, ndf_aim(k, v), u1, u2);
}

ASP_FN asp_real ndf_sigma_up_at(const asp_shape *k, asp_v3 v)
{
    return ndf_sigma_up(k, v.z, aspi_length2(v));
}
#else
#define NDF_ANY_BELOW(bits) ((void)(bits), 0)
#define NDF_NOTE(bits, more) ((void)(more))
ASP_FN aspi_aimed ndf_aim_up(const asp_shape *k, asp_v3 v)
{
    aspi_aimed a;
    (void)k;
    a.x = v.x;
    a.y = v.y;
    a.z = v.z;
    a.w = R(0.0);
    return a;
}

ASP_FN asp_v3 ndf_aimed(const asp_shape *k, aspi_aimed a, asp_real u1, asp_real u2)
{
    return ndf_visible(k, aspi_vector(a.x, a.y, a.z), u1, u2);
}

ASP_FN void ndf_aim_below(const asp_shape *k, size_t n, const asp_real *wx, const asp_real *wy, const asp_real *wz,
                      asp_real *sigma, asp_real *z)
{
    (void)k, (void)n, (void)wx, (void)wy, (void)wz, (void)sigma, (void)z;
}

ASP_FN asp_real ndf_sigma_up_at(const asp_shape *k, asp_v3 v) { return ndf_sigma_at(k, v); }
#endif

ASP_FN asp_v3 ndf_world_visible(const asp_shape *k, asp_v3 w, asp_real u1, asp_real u2)
{
    return aspi_normalize(aspi_facet_back(k, ndf_visible(k, aspi_view(k, w), u1, u2)));
}

/* A reflection in steps, which loops take one by one: short loops let the processor overlap several
 * elements. The facet drawn is m of the standard surface, as long as ndf_visible made it; `back` in the world,
 * of squared length 1/q. Nothing is made a unit vector: D is homogeneous, and the rest needs squares only.
 * Where the visible normals come from stages of their own both are the unit normal of the world, q is 1. */
/* The density of the mirrored direction. One that is a quotient, 1/ndf_density_over, saves a division. */
ASP_FN asp_real ndf_lobe(const asp_shape *k, asp_real ci, asp_v3 m, asp_real q, asp_real sigma_i)
{
#ifdef ASP_OWN_VISIBLE_N
    (void)q;
    return aspi_lobe_density(ci, ndf_world_density(k, m), sigma_i);
#else
    asp_real steep = m.z * m.z * q - ASP_FLAT * ASP_FLAT;
#if defined(ASP_NDF_DENSITY_OVER)
    asp_real over = ndf_density_over(k, aspi_length2(m) * q, m.z * m.z * q) * sigma_i;
    /* at most 1e16 over 1e-19: nothing to cut */
    asp_real p = R(0.25) * k->inv_det / (over + ASP_SMALLEST);
    return aspi_min(ci, steep) <= R(0.0) ? R(0.0) : p;
#elif defined(ASP_NDF_PLANAR)
    asp_real scale = aspi_sqrt(q);
    asp_v3 unit = aspi_vector(m.x * scale, m.y * scale, m.z * scale);
    return aspi_lobe_density(aspi_min(ci, steep), aspi_finite(ndf_density(k, unit) * k->inv_det), sigma_i);
#else
    asp_real D = ndf_density(k, aspi_length2(m) * q, m.z * m.z * q);
    return aspi_lobe_density(aspi_min(ci, steep), aspi_finite(D * k->inv_det), sigma_i);
#endif
#endif
}

/* 2 wi.m m - wi, and the squares of m's height and cosine. */
ASP_FN asp_v3 ndf_mirror(asp_v3 wi, asp_v3 back, asp_real q, asp_real *m_z2, asp_real *cosine2)
{
    asp_real d = aspi_dot(wi, back), by = R(2.0) * d * q;
    *m_z2 = back.z * back.z * q;
    *cosine2 = d * aspi_abs(d) * q;
    back.x = by * back.x - wi.x;
    back.y = by * back.y - wi.y;
    back.z = by * back.z - wi.z;
    return back;
}

/* The squared length of a facet drawn. */
#ifdef ASP_OWN_VISIBLE_N
#define NDF_LENGTH2(m) R(1.0)
#else
#define NDF_LENGTH2(m) aspi_dot(m, m)
#endif

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

typedef struct ndf_drawn { asp_v3 m, back; asp_real q; } ndf_drawn;

ASP_FN ndf_drawn ndf_draw(const asp_shape *k, asp_v3 wi, asp_v3 v, asp_real u1, asp_real u2)
{
    ndf_drawn d;
#ifdef ASP_OWN_VISIBLE_N
    (void)v;
    d.m = d.back = ndf_world_visible(k, wi, u1, u2);
    d.q = R(1.0);
#else
    (void)wi;
    d.m = ndf_visible(k, v, u1, u2);
    d.back = aspi_facet_back(k, d.m);
    d.q = R(1.0) / aspi_max(aspi_dot(d.back, d.back), ASP_TINY);
#endif
    return d;
}

/* What calls in turn would pass through memory stays in registers. */
ASP_CLONES_SINGLE static void ndf_reflect_1(const asp_shape *k, asp_real wx, asp_real wy, asp_real wz,
                                            asp_real u1, asp_real u2, asp_mirrored *out)
{
    asp_v3 wi = aspi_vector(wx, wy, wz), v = aspi_view(k, wi), wo;
    ndf_drawn d = ndf_draw(k, wi, v, u1, u2);
    wo = ndf_mirror(wi, d.back, d.q, &out->m_z2, &out->cosine2);
    out->wo_x = wo.x;
    out->wo_y = wo.y;
    out->wo_z = wo.z;
    out->sigma_i = ndf_sigma_at(k, v);
    out->pdf = ndf_lobe(k, wi.z, d.m, d.q, out->sigma_i);
    out->sigma_o = ndf_sigma_at(k, aspi_view(k, wo));
}

/* A branch that the processor may guess: F comes late. */
ASP_CLONES_SINGLE static void ndf_refract_1(const asp_shape *k, asp_real wx, asp_real wy, asp_real wz,
                                            asp_real u1, asp_real u2, asp_real u3, asp_real eta,
                                            asp_real inverse, asp_split_ray *out)
{
    asp_v3 wi = aspi_vector(wx, wy, wz), v = aspi_view(k, wi), wo;
    ndf_drawn d = ndf_draw(k, wi, v, u1, u2);
    aspi_split s = aspi_split_at(wi, d.back, NDF_LENGTH2(d.back), eta);
    asp_real sigma_i = ndf_sigma_at(k, v), lobe = ndf_lobe(k, wi.z, d.m, d.q, sigma_i), pdf, sigma_o;
    if (u3 >= s.F) {
        wo = aspi_split_way(&s, wi, d.back, d.q, inverse, 1);
        pdf = aspi_split_density(&s, lobe, d.q, eta, 1);
        sigma_o = ndf_sigma_at(k, aspi_view(k, aspi_vector(-wo.x, -wo.y, -wo.z)));
    } else {
        wo = aspi_split_way(&s, wi, d.back, d.q, inverse, 0);
        pdf = aspi_split_density(&s, lobe, d.q, eta, 0);
        sigma_o = ndf_sigma_at(k, aspi_view(k, wo));
    }
    out->F = s.F;
    out->pdf = pdf;
    out->sigma_i = sigma_i;
    out->sigma_o = sigma_o;
    out->q = d.q;
    out->m_z = d.back.z;
    out->wi_m = s.d;
    out->wo_m = s.e;
    out->wo_x = wo.x;
    out->wo_y = wo.y;
    out->wo_z = wo.z;
}

/* ---- loops */

/* A distribution whose formula is long may bring this loop, sigma's or the normals' itself, in stages: it
 * defines ASP_OWN_DENSITY_N, ASP_OWN_SIGMA_N, ASP_OWN_VISIBLE_N or ASP_OWN_NORMAL_N. Where ASP_NDF_UP says that
 * sigma is short, other loops keep it among their own steps. */
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

#ifndef ASP_OWN_NORMAL_N
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
#endif

/* Facets of the standard surface (x, y, z) and in the world (bx, by, z), the inverses of the squares of their
 * lengths there; or unit normals of the world and their density. */
typedef struct ndf_facets {
    asp_real bx[ASP_BLOCK], by[ASP_BLOCK], z[ASP_BLOCK];
#ifdef ASP_OWN_VISIBLE_N
    asp_real D[ASP_BLOCK];
#else
    asp_real x[ASP_BLOCK], y[ASP_BLOCK], q[ASP_BLOCK];
#endif
} ndf_facets;

ASP_FN void ndf_draw_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT wx, const asp_real *ASP_RESTRICT wy,
                       const asp_real *ASP_RESTRICT wz, const asp_real *ASP_RESTRICT u1,
                       const asp_real *ASP_RESTRICT u2, ndf_facets *ASP_RESTRICT f, asp_real *ASP_RESTRICT si)
{
#ifndef ASP_OWN_VISIBLE_N
    asp_bits below = 0;
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v3 v = aspi_view(k, aspi_vector(wx[i], wy[i], wz[i]));
        aspi_aimed a = ndf_aim_up(k, v);
        si[i] = ndf_sigma_up_at(k, v);
        NDF_NOTE(below, aspi_to_bits(v.z));
        f->x[i] = a.x;
        f->y[i] = a.y;
        f->z[i] = a.z;
        f->q[i] = a.w;
    }
    if (NDF_ANY_BELOW(below))
        ndf_aim_below(k, n, wx, wy, wz, si, f->z);
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        aspi_aimed a;
        asp_v3 m;
        a.x = f->x[i];
        a.y = f->y[i];
        a.z = f->z[i];
        a.w = f->q[i];
        m = ndf_aimed(k, a, u1[i], u2[i]);
        f->x[i] = m.x;
        f->y[i] = m.y;
        f->z[i] = m.z;
    }
    for (i = 0; i < n; i++) {
        asp_v3 back = aspi_facet_back(k, aspi_vector(f->x[i], f->y[i], f->z[i]));
        f->bx[i] = back.x;
        f->by[i] = back.y;
        f->q[i] = R(1.0) / aspi_max(aspi_dot(back, back), ASP_TINY);
    }
#define NDF_Q(f, i) (f).q[i]
#define NDF_LOBE(k, f, i, ci, si) ndf_lobe(k, ci, aspi_vector((f).x[i], (f).y[i], (f).z[i]), (f).q[i], si)
#else
    ndf_visible_n(k, n, wx, wy, wz, u1, u2, f->bx, f->by, f->z);
    ndf_sigma_n(k, n, R(1.0), wx, wy, wz, si);
    ndf_density_n(k, n, f->bx, f->by, f->z, f->D);
#define NDF_Q(f, i) R(1.0)
#define NDF_LOBE(k, f, i, ci, si) aspi_lobe_density(ci, (f).D[i], si)
#endif
}

/* The sign bits tell whether any direction that matters lies below the mean plane: a wo that points down
 * carries no weight. */
ASP_CLONES static void ndf_reflect_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT wx,
                                     const asp_real *ASP_RESTRICT wy,
                                     const asp_real *ASP_RESTRICT wz,
                                     const asp_real *ASP_RESTRICT u1,
                                     const asp_real *ASP_RESTRICT u2, const asp_mirrored_s *out)
{
    asp_real *ASP_RESTRICT ox = out->wo_x, *ASP_RESTRICT oy = out->wo_y, *ASP_RESTRICT oz = out->wo_z;
    asp_real *ASP_RESTRICT mz2 = out->m_z2, *ASP_RESTRICT c2 = out->cosine2, *ASP_RESTRICT p = out->pdf;
    asp_real *ASP_RESTRICT si = out->sigma_i, *ASP_RESTRICT so = out->sigma_o;
    ndf_facets f;
    asp_bits below = 0;
    size_t i;
    ndf_draw_n(k, n, wx, wy, wz, u1, u2, &f, si);
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_v3 wo = ndf_mirror(aspi_vector(wx[i], wy[i], wz[i]), aspi_at(f.bx, f.by, f.z, i), NDF_Q(f, i),
                               &mz2[i], &c2[i]), v;
        p[i] = NDF_LOBE(k, f, i, wz[i], si[i]);
        ox[i] = wo.x;
        oy[i] = wo.y;
        oz[i] = wo.z;
        v = aspi_view(k, wo);
#if !defined(ASP_OWN_SIGMA_N) || defined(ASP_NDF_UP)
        so[i] = ndf_sigma_up_at(k, v);
#endif
        NDF_NOTE(below, aspi_to_bits(v.z) & (asp_bits)~aspi_to_bits(wo.z));
    }
#if !defined(ASP_OWN_SIGMA_N) || defined(ASP_NDF_UP)
    if (NDF_ANY_BELOW(below))
        ndf_sigma_n(k, n, R(1.0), ox, oy, oz, so);
#else
    (void)below;
    ndf_sigma_n(k, n, R(1.0), ox, oy, oz, so);
#endif
}

ASP_CLONES static void ndf_refract_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT wx,
                                     const asp_real *ASP_RESTRICT wy, const asp_real *ASP_RESTRICT wz,
                                     const asp_real *ASP_RESTRICT u1, const asp_real *ASP_RESTRICT u2,
                                     const asp_real *ASP_RESTRICT u3, const asp_real *ASP_RESTRICT eta,
                                     const asp_real *ASP_RESTRICT inverse, const asp_split_rays *out)
{
    asp_real *ASP_RESTRICT ox = out->wo_x, *ASP_RESTRICT oy = out->wo_y, *ASP_RESTRICT oz = out->wo_z;
    asp_real *ASP_RESTRICT F = out->F, *ASP_RESTRICT p = out->pdf, *ASP_RESTRICT si = out->sigma_i;
    ndf_facets f;
    size_t i;
    ndf_draw_n(k, n, wx, wy, wz, u1, u2, &f, si);
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_v3 wi = aspi_vector(wx[i], wy[i], wz[i]), m = aspi_at(f.bx, f.by, f.z, i), wo;
        aspi_split s = aspi_split_at(wi, m, NDF_LENGTH2(m), eta[i]);
        int crosses = u3[i] >= s.F;
        asp_real sign = crosses ? R(-1.0) : R(1.0);
        F[i] = s.F;
        p[i] = aspi_split_density(&s, NDF_LOBE(k, f, i, wz[i], si[i]), NDF_Q(f, i), eta[i], crosses);
        wo = aspi_split_way(&s, wi, m, NDF_Q(f, i), inverse[i], crosses);
        ox[i] = wo.x;
        oy[i] = wo.y;
        oz[i] = wo.z;
        f.bx[i] = sign * wo.x;
        f.by[i] = sign * wo.y;
        f.z[i] = sign * wo.z;
    }
    ndf_sigma_n(k, n, R(1.0), f.bx, f.by, f.z, out->sigma_o);
}
#undef NDF_LENGTH2
#undef NDF_Q
#include "asperity/meeting.h"
#undef NDF_LOBE
#undef NDF_ANY_BELOW
#undef NDF_NOTE
#undef ASP_OWN_DENSITY_N
#undef ASP_OWN_SIGMA_N
#undef ASP_OWN_VISIBLE_N
#undef ASP_OWN_NORMAL_N
