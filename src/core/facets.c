/* facets.c - D, P22, sigma, masking, normals and densities: asperity.h sections 5, 8 and 9
 *
 * Read three times: this head, then the body in each precision. Single calls and loops share every
 * formula; a block is cut in stages so that the distribution's own loop can stand in the middle. */
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
#define slope_facet ASP_NAME(slope_facet)
#define masking ASP_NAME(masking)
#define lambda_of ASP_NAME(lambda_of)
#define joint_masking ASP_NAME(joint_masking)
#define loop_masking ASP_NAME(loop_masking)
#define loop_hidden ASP_NAME(loop_hidden)
#define loop_joint ASP_NAME(loop_joint)
#define loop_times ASP_NAME(loop_times)
#define loop_visible_density ASP_NAME(loop_visible_density)
#define loop_slopes ASP_NAME(loop_slopes)
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

asp_real ASPI_CALL(asp_D)(const asp_shape *k, asp_v3 m)
{
    return ASPI_OPS(k).density(k, m.x, m.y, m.z);
}

/* The vector (-p, 1), whose D is P22; the flat one where the standard surface's slope is too steep. */
ASP_FN asp_v3 slope_facet(const asp_shape *k, asp_real p_x, asp_real p_y)
{
    asp_v3 m = aspi_vector(-p_x, -p_y, R(1.0));
    int steep = aspi_length2(aspi_facet(k, m)) > ASP_STEEPEST;
    m.x = steep ? R(0.0) : m.x;
    m.y = steep ? R(0.0) : m.y;
    m.z = steep ? R(0.0) : m.z;
    return m;
}

asp_real ASPI_CALL(asp_P22)(const asp_shape *k, asp_real p_x, asp_real p_y)
{
    return ASPI_CALL(asp_D)(k, slope_facet(k, p_x, p_y));
}

asp_real ASPI_CALL(asp_sigma)(const asp_shape *k, asp_v3 w)
{
    return ASPI_OPS(k).sigma(k, w.x, w.y, w.z);
}

asp_real ASPI_CALL(asp_G1)(const asp_shape *k, asp_v3 w, int mask)
{
    return masking(k, w, ASPI_CALL(asp_sigma)(k, w), mask);
}

asp_real ASPI_CALL(asp_lambda)(const asp_shape *k, asp_v3 w, int mask)
{
    return lambda_of(k, w, ASPI_OPS(k).sigma(k, -w.x, -w.y, -w.z), mask);
}

asp_real ASPI_CALL(asp_G2)(const asp_shape *k, asp_v3 wi, asp_v3 wo, asp_v3 m, int mask)
{
    return joint_masking(k, wi, wo, m, ASPI_CALL(asp_sigma)(k, wi), ASPI_CALL(asp_sigma)(k, wo),
                         mask);
}

asp_v3 ASPI_CALL(asp_sample_normal)(const asp_shape *k, asp_real u1, asp_real u2)
{
    asp_real m[3];
    ASPI_OPS(k).normal(k, u1, u2, m);
    return aspi_vector(m[0], m[1], m[2]);
}

asp_v3 ASPI_CALL(asp_sample_visible)(const asp_shape *k, asp_v3 wi, asp_real u1, asp_real u2)
{
    asp_real m[3];
    ASPI_OPS(k).visible(k, wi.x, wi.y, wi.z, u1, u2, m);
    return aspi_vector(m[0], m[1], m[2]);
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

ASP_CLONES static void loop_hidden(const asp_shape *k, size_t n, int mask, asp_cv3s w,
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

ASP_CLONES static void loop_slopes(const asp_shape *k, size_t n, IN p_x, IN p_y, OUT mx, OUT my,
                                   OUT mz)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v3 m = slope_facet(k, p_x[i], p_y[i]);
        mx[i] = m.x;
        my[i] = m.y;
        mz[i] = m.z;
    }
}

/* ---- batches: block by block; a block's inputs are read before its outputs are written */

void ASPI_CALL(asp_D_n)(const asp_shape *k, size_t n, asp_cv3s m, asp_real *out)
{
    asp_real d[ASP_BLOCK];
    int in_place = aspi_among(out, m);
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n) {
        ASPI_OPS(k).density_n(k, size, m.x + i, m.y + i, m.z + i, in_place ? d : out + i);
        if (in_place)
            memcpy(out + i, d, size * sizeof *d);
    }
}

void ASPI_CALL(asp_P22_n)(const asp_shape *k, size_t n, const asp_real *p_x, const asp_real *p_y,
                          asp_real *out)
{
    asp_real x[ASP_BLOCK], y[ASP_BLOCK], z[ASP_BLOCK];
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n) {
        loop_slopes(k, size, p_x + i, p_y + i, x, y, z);
        ASPI_OPS(k).density_n(k, size, x, y, z, out + i);
    }
}

void ASPI_CALL(asp_sigma_n)(const asp_shape *k, size_t n, asp_cv3s w, asp_real *out)
{
    asp_real sigma[ASP_BLOCK];
    int in_place = aspi_among(out, w);
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n) {
        ASPI_OPS(k).sigma_n(k, size, R(1.0), w.x + i, w.y + i, w.z + i, in_place ? sigma : out + i);
        if (in_place)
            memcpy(out + i, sigma, size * sizeof *sigma);
    }
}

void ASPI_CALL(asp_G1_n)(const asp_shape *k, size_t n, asp_cv3s w, int mask, asp_real *out)
{
    asp_real sigma[ASP_BLOCK];
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n) {
        ASPI_OPS(k).sigma_n(k, size, R(1.0), w.x + i, w.y + i, w.z + i, sigma);
        loop_masking(k, size, mask, ASPI_FROM(w, i), sigma, out + i);
    }
}

void ASPI_CALL(asp_lambda_n)(const asp_shape *k, size_t n, asp_cv3s w, int mask, asp_real *out)
{
    asp_real below[ASP_BLOCK];
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n) {
        ASPI_OPS(k).sigma_n(k, size, R(-1.0), w.x + i, w.y + i, w.z + i, below);
        loop_hidden(k, size, mask, ASPI_FROM(w, i), below, out + i);
    }
}

void ASPI_CALL(asp_G2_n)(const asp_shape *k, size_t n, asp_cv3s wi, asp_cv3s wo, asp_cv3s m,
                         int mask, asp_real *out)
{
    asp_real sigma_i[ASP_BLOCK], sigma_o[ASP_BLOCK];
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n) {
        ASPI_OPS(k).sigma_n(k, size, R(1.0), wi.x + i, wi.y + i, wi.z + i, sigma_i);
        ASPI_OPS(k).sigma_n(k, size, R(1.0), wo.x + i, wo.y + i, wo.z + i, sigma_o);
        loop_joint(k, size, mask, ASPI_FROM(wi, i), ASPI_FROM(wo, i), ASPI_FROM(m, i), sigma_i, sigma_o,
                   out + i);
    }
}

void ASPI_CALL(asp_sample_normal_n)(const asp_shape *k, size_t n, const asp_real *u1,
                                    const asp_real *u2, asp_v3s m)
{
    asp_real s[3][ASP_BLOCK];
    int in_place = aspi_any_among(m, u1, u2, u2);
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n) {
        if (in_place) {
            ASPI_OPS(k).normal_n(k, size, u1 + i, u2 + i, s[0], s[1], s[2]);
            aspi_put_rows(m, i, size, s);
        } else {
            ASPI_OPS(k).normal_n(k, size, u1 + i, u2 + i, m.x + i, m.y + i, m.z + i);
        }
    }
}

void ASPI_CALL(asp_sample_visible_n)(const asp_shape *k, size_t n, asp_cv3s wi, const asp_real *u1,
                                     const asp_real *u2, asp_v3s m)
{
    asp_real s[3][ASP_BLOCK];
    int in_place = aspi_any_among(m, wi.x, wi.y, wi.z) || aspi_any_among(m, u1, u2, u2);
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n) {
        if (in_place) {
            ASPI_OPS(k).visible_n(k, size, wi.x + i, wi.y + i, wi.z + i, u1 + i, u2 + i, s[0], s[1],
                                  s[2]);
            aspi_put_rows(m, i, size, s);
        } else {
            ASPI_OPS(k).visible_n(k, size, wi.x + i, wi.y + i, wi.z + i, u1 + i, u2 + i, m.x + i,
                                  m.y + i, m.z + i);
        }
    }
}

void ASPI_CALL(asp_pdf_normal_n)(const asp_shape *k, size_t n, asp_cv3s m, asp_real *out)
{
    asp_real d[ASP_BLOCK];
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n) {
        ASPI_OPS(k).density_n(k, size, m.x + i, m.y + i, m.z + i, d);
        loop_times(size, d, m.z + i, out + i);
    }
}

void ASPI_CALL(asp_pdf_visible_n)(const asp_shape *k, size_t n, asp_cv3s wi, asp_cv3s m,
                                  asp_real *out)
{
    asp_real d[ASP_BLOCK], sigma[ASP_BLOCK];
    size_t i, size;
    ASPI_FOR_BLOCKS(i, size, n) {
        ASPI_OPS(k).density_n(k, size, m.x + i, m.y + i, m.z + i, d);
        ASPI_OPS(k).sigma_n(k, size, R(1.0), wi.x + i, wi.y + i, wi.z + i, sigma);
        loop_visible_density(size, ASPI_FROM(wi, i), ASPI_FROM(m, i), d, sigma, out + i);
    }
}

#undef IN
#undef OUT
#endif
