/* facets.c - D, P22, sigma, masking, normals and densities: asperity.h sections 5, 8 and 9
 *
 * Read three times: this head, then the body in each precision. Single calls and loops share every
 * formula; a loop is cut in stages so that the distribution's own loop can stand in the middle. */
#ifndef ASP_PRECISION
#include "asperity.h"
#include "asperity_ndf.h"

#define ASP_PRECISION 64
#include "facets.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "facets.c"
#undef ASP_PRECISION

#else
#include "core/blocks.h"

#ifndef ASPI_FACETS_NAMES
#define ASPI_FACETS_NAMES
#define visible_density ASP_NAME(visible_density)
#define block_density ASP_NAME(block_density)
#define block_sigma ASP_NAME(block_sigma)
#define block_visible ASP_NAME(block_visible)
#define block_lambda ASP_NAME(block_lambda)
#define block_normal ASP_NAME(block_normal)
#define visible_of ASP_NAME(visible_of)
#define normal_of ASP_NAME(normal_of)
#define masking ASP_NAME(masking)
#define lambda_of ASP_NAME(lambda_of)
#define joint_masking ASP_NAME(joint_masking)
#define loop_masking ASP_NAME(loop_masking)
#define loop_hidden ASP_NAME(loop_hidden)
#define loop_joint ASP_NAME(loop_joint)
#define loop_times ASP_NAME(loop_times)
#define loop_visible_density ASP_NAME(loop_visible_density)
#define loop_slopes ASP_NAME(loop_slopes)
#define loop_slope_density ASP_NAME(loop_slope_density)
#endif

#define IN const asp_real *ASP_RESTRICT
#define OUT asp_real *ASP_RESTRICT

/* ---- formulas around the standard surface's */

/* max(0, w.m) D(m) / sigma(w). */
ASP_FN asp_real visible_density(asp_real cosine, asp_real density, asp_real sigma)
{
    asp_real p = cosine * density / (sigma < ASP_SMALLEST ? ASP_SMALLEST : sigma);
    return cosine <= R(0.0) ? R(0.0) : aspi_finite(p);
}

ASP_FN asp_real masking(const asp_shape *k, asp_v3 w, asp_real sigma, int mask)
{
    asp_real area = aspi_masked(k, w, sigma, mask);
    asp_real g = w.z / (area > R(0.0) ? area : R(1.0));
    g = g > R(1.0) ? R(1.0) : g; /* by rounding, where nothing is hidden */
    g = (mask & 15) == ASP_MASK_V_CAVITY ? R(1.0) : g;
    g = area == area ? g : area;
    return w.z <= R(0.0) ? R(0.0) : g;
}

ASP_FN asp_real lambda_of(const asp_shape *k, asp_v3 w, asp_real sigma_below, int mask)
{
    asp_real hidden = aspi_hidden(k, w, sigma_below, mask);
    asp_real l = hidden / (w.z > R(0.0) ? w.z : R(1.0));
    l = (mask & 15) == ASP_MASK_V_CAVITY ? R(0.0) : aspi_finite(l);
    l = hidden + w.z == hidden + w.z ? l : hidden + w.z;
    return w.z <= R(0.0) ? (asp_real)INFINITY : l;
}

ASP_FN asp_real joint_masking(const asp_shape *k, asp_v3 wi, asp_v3 wo, asp_v3 m, asp_real sigma_i,
                              asp_real sigma_o, int mask)
{
    asp_real si = aspi_masked(k, wi, sigma_i, mask), so = aspi_masked(k, wo, sigma_o, mask);
    asp_real c_i = aspi_dot(wi, m), c_o = aspi_dot(wo, m);
    asp_real g = wi.z * wo.z * aspi_joint(wi.z, wo.z, si, so, m.z, c_i, c_o, mask);
    asp_real dark = aspi_min(aspi_min(wi.z, wo.z), aspi_min(aspi_min(c_i, c_o), m.z));
    /* the V-cavity's selections would lose a NaN */
    asp_real sum = c_i + c_o;
    g = sum == sum ? g : sum;
    return dark <= R(0.0) ? R(0.0) : g;
}

/* ---- single calls */

/* The distribution's single samplers, mapped back. */
ASP_FN asp_v3 visible_of(const asp_shape *k, asp_v3 v, asp_real u1, asp_real u2)
{
    asp_real m[3];
    asp_v3 out;
    ASPI_OPS(k).visible(k, v.x, v.y, v.z, u1, u2, m);
    out.x = m[0];
    out.y = m[1];
    out.z = m[2];
    return aspi_normalize(aspi_facet_back(k, out));
}

ASP_FN asp_v3 normal_of(const asp_shape *k, asp_real u1, asp_real u2)
{
    asp_real m[3];
    asp_v3 out;
    ASPI_OPS(k).normal(k, u1, u2, m);
    out.x = m[0];
    out.y = m[1];
    out.z = m[2];
    return aspi_normalize(aspi_facet_back(k, out));
}

asp_real ASPI_CALL(asp_D)(const asp_shape *k, asp_v3 m)
{
    asp_v2 a = aspi_density_arguments(k, m);
    return aspi_density_result(k, ASPI_OPS(k).density(k, a.x, a.y), m.z);
}

asp_real ASPI_CALL(asp_P22)(const asp_shape *k, asp_real p_x, asp_real p_y)
{
    asp_v3 m, v;
    asp_real r2, d;
    m.x = -p_x;
    m.y = -p_y;
    m.z = R(1.0);
    v = aspi_facet(k, m);
    r2 = aspi_length2(v);
    d = ASPI_OPS(k).density(k, aspi_min(r2, ASP_STEEPEST), R(1.0)) * k->inv_det;
    return r2 > ASP_STEEPEST ? R(0.0) : d;
}

asp_real ASPI_CALL(asp_sigma)(const asp_shape *k, asp_v3 w)
{
    asp_v3 v = aspi_view(k, w);
    return ASPI_OPS(k).sigma(k, v.z, aspi_length2(v));
}

asp_real ASPI_CALL(asp_G1)(const asp_shape *k, asp_v3 w, int mask)
{
    return masking(k, w, ASPI_CALL(asp_sigma)(k, w), mask);
}

asp_real ASPI_CALL(asp_lambda)(const asp_shape *k, asp_v3 w, int mask)
{
    asp_v3 v = aspi_view(k, w);
    return lambda_of(k, w, ASPI_OPS(k).sigma(k, -v.z, aspi_length2(v)), mask);
}

asp_real ASPI_CALL(asp_G2)(const asp_shape *k, asp_v3 wi, asp_v3 wo, asp_v3 m, int mask)
{
    return joint_masking(k, wi, wo, m, ASPI_CALL(asp_sigma)(k, wi), ASPI_CALL(asp_sigma)(k, wo),
                         mask);
}

asp_v3 ASPI_CALL(asp_sample_normal)(const asp_shape *k, asp_real u1, asp_real u2)
{
    return normal_of(k, u1, u2);
}

asp_v3 ASPI_CALL(asp_sample_visible)(const asp_shape *k, asp_v3 wi, asp_real u1, asp_real u2)
{
    return visible_of(k, aspi_view(k, wi), u1, u2);
}

asp_real ASPI_CALL(asp_pdf_normal)(const asp_shape *k, asp_v3 m)
{
    return ASPI_CALL(asp_D)(k, m) * m.z;
}

asp_real ASPI_CALL(asp_pdf_visible)(const asp_shape *k, asp_v3 wi, asp_v3 m)
{
    return visible_density(aspi_dot(wi, m), ASPI_CALL(asp_D)(k, m), ASPI_CALL(asp_sigma)(k, wi));
}

asp_v2 ASPI_CALL(asp_mean_slope)(const asp_shape *k)
{
    asp_v2 t;
    t.x = k->map.tx;
    t.y = k->map.ty;
    return t;
}

asp_v3 ASPI_CALL(asp_mean_normal)(const asp_shape *k)
{
    asp_v3 m;
    m.x = -k->map.tx;
    m.y = -k->map.ty;
    m.z = R(1.0);
    return aspi_normalize(m);
}

/* ---- loops */

/* The outputs of these may be one of the inputs: an element is read before it is written. */
ASP_CLONES static void loop_masking(const asp_shape *k, size_t n, int mask, asp_cv3s w,
                                    const asp_real *sigma, asp_real *out)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_v3 v = aspi_at(w.x, w.y, w.z, i);
        out[i] = masking(k, v, sigma[i], mask);
    }
}

ASP_FN void loop_hidden(const asp_shape *k, size_t n, int mask, asp_cv3s w,
                                   const asp_real *below, asp_real *out)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_v3 v = aspi_at(w.x, w.y, w.z, i);
        out[i] = lambda_of(k, v, below[i], mask);
    }
}

ASP_CLONES static void loop_joint(const asp_shape *k, size_t n, int mask, asp_cv3s wi, asp_cv3s wo,
                                  asp_cv3s m, const asp_real *sigma_i, const asp_real *sigma_o,
                                  asp_real *out)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_v3 a, b, c;
        a = aspi_at(wi.x, wi.y, wi.z, i);
        b = aspi_at(wo.x, wo.y, wo.z, i);
        c = aspi_at(m.x, m.y, m.z, i);
        out[i] = joint_masking(k, a, b, c, sigma_i[i], sigma_o[i], mask);
    }
}

ASP_CLONES static void loop_visible_density(size_t n, asp_cv3s wi, asp_cv3s m, const asp_real *d,
                                            const asp_real *sigma, asp_real *out)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_v3 a, b;
        a = aspi_at(wi.x, wi.y, wi.z, i);
        b = aspi_at(m.x, m.y, m.z, i);
        out[i] = visible_density(aspi_dot(a, b), d[i], sigma[i]);
    }
}

ASP_CLONES static void loop_times(size_t n, const asp_real *a, const asp_real *b, asp_real *out)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++)
        out[i] = a[i] * b[i];
}

ASP_CLONES static void loop_slopes(const asp_shape *k, size_t n, IN p_x, IN p_y, OUT all, OUT r2,
                                   OUT z2)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v3 m;
        m.x = -p_x[i];
        m.y = -p_y[i];
        m.z = R(1.0);
        all[i] = aspi_length2(aspi_facet(k, m));
        r2[i] = aspi_min(all[i], ASP_STEEPEST);
        z2[i] = R(1.0);
    }
}

ASP_CLONES static void loop_slope_density(size_t n, asp_real by, IN all, IN standard, OUT out)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_real d = standard[i] * by;
        out[i] = all[i] > ASP_STEEPEST ? R(0.0) : d;
    }
}

/* ---- blocks, one per instruction set */

ASP_CLONES static void block_density(const asp_shape *k, size_t n, asp_cv3s m, asp_real *out)
{
    aspi_block_density(k, n, m, out);
}

ASP_CLONES static void block_sigma(const asp_shape *k, size_t n, asp_cv3s w, asp_real *out)
{
    aspi_block_sigma(k, n, w, out);
}

ASP_CLONES static void block_visible(const asp_shape *k, size_t n, asp_cv3s wi, const asp_real *u1,
                                     const asp_real *u2, asp_v3s m)
{
    aspi_block_visible(k, n, wi, u1, u2, m);
}

ASP_CLONES static void block_lambda(const asp_shape *k, size_t n, asp_cv3s w, int mask,
                                    asp_real *out)
{
    asp_real h[ASPI_BLOCK], s2[ASPI_BLOCK], below[ASPI_BLOCK];
    if (!n)
        return;
    aspi_loop_view(k, n, R(-1.0), w.x, w.y, w.z, h, s2);
    ASPI_OPS(k).sigma_n(k, n, h, s2, below);
    loop_hidden(k, n, mask, w, below, out);
}

ASP_CLONES static void block_normal(const asp_shape *k, size_t n, const asp_real *u1,
                                    const asp_real *u2, asp_v3s m)
{
    asp_real x[ASPI_BLOCK], y[ASPI_BLOCK], z[ASPI_BLOCK];
    if (!n)
        return;
    ASPI_OPS(k).normal_n(k, n, u1, u2, x, y, z);
    aspi_loop_back(k, n, x, y, z, m.x, m.y, m.z);
}

/* ---- batches: block by block; a block's inputs are read before its outputs are written */

void ASPI_CALL(asp_D_n)(const asp_shape *k, size_t n, asp_cv3s m, asp_real *out)
{
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n)
        block_density(k, size, ASPI_FROM(m, i), out + i);
}

void ASPI_CALL(asp_P22_n)(const asp_shape *k, size_t n, const asp_real *p_x, const asp_real *p_y,
                          asp_real *out)
{
    asp_real all[ASPI_BLOCK], r2[ASPI_BLOCK], z2[ASPI_BLOCK], d[ASPI_BLOCK];
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n) {
        loop_slopes(k, size, p_x + i, p_y + i, all, r2, z2);
        ASPI_OPS(k).density_n(k, size, r2, z2, d);
        loop_slope_density(size, k->inv_det, all, d, out + i);
    }
}

void ASPI_CALL(asp_sigma_n)(const asp_shape *k, size_t n, asp_cv3s w, asp_real *out)
{
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n)
        block_sigma(k, size, ASPI_FROM(w, i), out + i);
}

void ASPI_CALL(asp_G1_n)(const asp_shape *k, size_t n, asp_cv3s w, int mask, asp_real *out)
{
    asp_real sigma[ASPI_BLOCK];
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n) {
        block_sigma(k, size, ASPI_FROM(w, i), sigma);
        loop_masking(k, size, mask, ASPI_FROM(w, i), sigma, out + i);
    }
}

void ASPI_CALL(asp_lambda_n)(const asp_shape *k, size_t n, asp_cv3s w, int mask, asp_real *out)
{
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n)
        block_lambda(k, size, ASPI_FROM(w, i), mask, out + i);
}

void ASPI_CALL(asp_G2_n)(const asp_shape *k, size_t n, asp_cv3s wi, asp_cv3s wo, asp_cv3s m,
                         int mask, asp_real *out)
{
    asp_real sigma_i[ASPI_BLOCK], sigma_o[ASPI_BLOCK];
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n) {
        block_sigma(k, size, ASPI_FROM(wi, i), sigma_i);
        block_sigma(k, size, ASPI_FROM(wo, i), sigma_o);
        loop_joint(k, size, mask, ASPI_FROM(wi, i), ASPI_FROM(wo, i), ASPI_FROM(m, i), sigma_i, sigma_o,
                   out + i);
    }
}

void ASPI_CALL(asp_sample_normal_n)(const asp_shape *k, size_t n, const asp_real *u1,
                                    const asp_real *u2, asp_v3s m)
{
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n)
        block_normal(k, size, u1 + i, u2 + i, ASPI_TO(m, i));
}

void ASPI_CALL(asp_sample_visible_n)(const asp_shape *k, size_t n, asp_cv3s wi, const asp_real *u1,
                                     const asp_real *u2, asp_v3s m)
{
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n)
        block_visible(k, size, ASPI_FROM(wi, i), u1 + i, u2 + i, ASPI_TO(m, i));
}

void ASPI_CALL(asp_pdf_normal_n)(const asp_shape *k, size_t n, asp_cv3s m, asp_real *out)
{
    asp_real d[ASPI_BLOCK];
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n) {
        block_density(k, size, ASPI_FROM(m, i), d);
        loop_times(size, d, m.z + i, out + i);
    }
}

void ASPI_CALL(asp_pdf_visible_n)(const asp_shape *k, size_t n, asp_cv3s wi, asp_cv3s m,
                                  asp_real *out)
{
    asp_real d[ASPI_BLOCK], sigma[ASPI_BLOCK];
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n) {
        block_density(k, size, ASPI_FROM(m, i), d);
        block_sigma(k, size, ASPI_FROM(wi, i), sigma);
        loop_visible_density(size, ASPI_FROM(wi, i), ASPI_FROM(m, i), d, sigma, out + i);
    }
}

#undef IN
#undef OUT
#endif
