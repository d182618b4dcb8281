/* material_batch.c - eval, pdf and sample of reflecting materials over arrays: asperity.h sections 8, 9
 *
 * Read three times like facets.c; the formulas are in reflection.h, so that element i is bit for bit
 * what the single call gives. */
#ifndef ASP_PRECISION
#include "bsdf/bsdf.h"

#define ASP_PRECISION 64
#include "material_batch.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "material_batch.c"
#undef ASP_PRECISION

#else
#include "core/blocks.h"
#include "bsdf/bsdf_number.h"
#include "core/block_fresnel.h"
#include "bsdf/reflection.h"
#include "core/own_batch.h"

#ifndef ASPI_MATERIAL_BATCH_NAMES
#define ASPI_MATERIAL_BATCH_NAMES
#define block_share ASP_NAME(block_share)
#define block_eval ASP_NAME(block_eval)
#define block_pdf ASP_NAME(block_pdf)
#define block_sample_pure ASP_NAME(block_sample_pure)
#define block_sample_mixed ASP_NAME(block_sample_mixed)
#define loop_half ASP_NAME(loop_half)
#define loop_reflect ASP_NAME(loop_reflect)
#define loop_parts ASP_NAME(loop_parts)
#define loop_weights ASP_NAME(loop_weights)
#define loop_lobe_density ASP_NAME(loop_lobe_density)
#define loop_mixed_density ASP_NAME(loop_mixed_density)
#define loop_choose ASP_NAME(loop_choose)
#define loop_mixed_direction ASP_NAME(loop_mixed_direction)
#define loop_mixed_parts ASP_NAME(loop_mixed_parts)
#define block_value ASP_NAME(block_value)
#define loop_ratio ASP_NAME(loop_ratio)
#define loop_square ASP_NAME(loop_square)
#endif

#define IN const asp_real *ASP_RESTRICT
#define OUT asp_real *ASP_RESTRICT

/* ---- loops */

ASP_FN void loop_half(size_t n, IN ix, IN iy, IN iz, IN ox, IN oy, IN oz, OUT mx, OUT my,
                      OUT mz, OUT mz2, OUT c2)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v3 wi, wo, m;
        asp_real c;
        wi = aspi_at(ix, iy, iz, i);
        wo = aspi_at(ox, oy, oz, i);
        m = aspi_half_vector(wi, wo);
        mx[i] = m.x;
        my[i] = m.y;
        mz[i] = m.z;
        c = aspi_dot(wi, m);
        mz2[i] = m.z * aspi_abs(m.z);
        c2[i] = c * aspi_abs(c);
    }
}

ASP_FN void loop_reflect(size_t n, IN ix, IN iy, IN iz, IN mx, IN my, IN mz, OUT ox,
                         OUT oy, OUT oz)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v3 wi, m, wo;
        wi = aspi_at(ix, iy, iz, i);
        m = aspi_at(mx, my, mz, i);
        wo = aspi_reflect(wi, m);
        ox[i] = wo.x;
        oy[i] = wo.y;
        oz[i] = wo.z;
    }
}

/* aspi_reflected times D/4 and `by` (cosines or ones); y is `by` or 0. */
ASP_FN void loop_parts(const asp_shape *k, size_t n, int mask, asp_cv3s wi, asp_cv3s wo, IN mz2, IN c2, IN D,
                       IN sigma_i, IN sigma_o, IN by, OUT x, OUT over, OUT y)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_v3 a, b;
        asp_v2 part;
        a = aspi_at(wi.x, wi.y, wi.z, i);
        b = aspi_at(wo.x, wo.y, wo.z, i);
        y[i] = aspi_min(a.z, b.z) <= R(0.0) ? R(0.0) : by[i];
        part = aspi_reflected(k, a, b, mz2[i], c2[i], sigma_i[i], sigma_o[i], R(0.25) * D[i] * y[i], mask);
        x[i] = part.x;
        over[i] = part.y;
    }
}

/* The weight but for F, as x/over. */
ASP_FN void loop_weights(const asp_shape *k, size_t n, int mask, asp_cv3s wi, IN ox, IN oy, IN oz, IN mz2,
                         IN c2, IN sigma_i, IN sigma_o, OUT x, OUT over)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v3 a, b;
        asp_v2 part;
        a = aspi_at(wi.x, wi.y, wi.z, i);
        b = aspi_at(ox, oy, oz, i);
        part = aspi_reflected(k, a, b, mz2[i], c2[i], sigma_i[i], sigma_o[i], sigma_i[i] * b.z, mask);
        x[i] = part.x;
        over[i] = part.y;
    }
}

ASP_FN void loop_lobe_density(size_t n, const asp_real *ci, IN D, IN sigma_i,
                              asp_real *out)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++)
        out[i] = aspi_lobe_density(ci[i], D[i], sigma_i[i]);
}

ASP_FN void loop_mixed_density(size_t n, const asp_real *ci, const asp_real *co,
                               IN share, asp_real *out)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++)
        out[i] = aspi_mixed_density(ci[i], co[i], out[i], share[i]);
}

/* Cuts u1 in the share of the facets and the rest, each stretched to [0, 1). */
ASP_FN void loop_choose(size_t n, IN share, IN u1, OUT facet, OUT stretched)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_real in = u1[i] / share[i], out = (u1[i] - share[i]) / (R(1.0) - share[i]);
        facet[i] = u1[i] < share[i] ? R(1.0) : R(0.0);
        stretched[i] = u1[i] < share[i] ? in : out;
    }
}

ASP_FN void loop_mixed_direction(size_t n, asp_cv3s wi, IN facet, IN u1, IN u2, OUT ox, OUT oy,
                                 OUT oz)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v3 w = aspi_cosine_lobe(aspi_at(wi.x, wi.y, wi.z, i), u1[i], u2[i]);
        int in = facet[i] > R(0.0);
        ox[i] = aspi_select(in, ox[i], w.x);
        oy[i] = aspi_select(in, oy[i], w.y);
        oz[i] = aspi_select(in, oz[i], w.z);
    }
}

/* What the facets' and the base's terms are multiplied with to give f cos / pdf. */
ASP_FN void loop_mixed_parts(const asp_shape *k, size_t n, int mask, asp_cv3s wi, IN ox, IN oy, IN oz, IN mz2,
                             IN c2, IN D, IN sigma_i, IN sigma_o, IN pdf, OUT x, OUT over, OUT y)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_v3 a, b;
        asp_v2 part;
        asp_real p = pdf[i] <= R(0.0) ? R(1.0) : pdf[i], base, scale;
        a = aspi_at(wi.x, wi.y, wi.z, i);
        b = aspi_at(ox, oy, oz, i);
        base = b.z / p;
        scale = R(0.25) * D[i] / p;
        y[i] = aspi_min(a.z, b.z) <= R(0.0) || pdf[i] <= R(0.0) ? R(0.0) : base;
        scale = pdf[i] <= R(0.0) ? R(0.0) : scale;
        part = aspi_reflected(k, a, b, mz2[i], c2[i], sigma_i[i], sigma_o[i], aspi_above(b.z) * scale, mask);
        x[i] = part.x;
        over[i] = part.y;
    }
}

ASP_FN void loop_ratio(size_t n, IN by, IN over, OUT x)
{
    size_t i;
    for (i = 0; i < n; i++)
        x[i] = aspi_finite(by[i] / over[i]);
}

ASP_FN void loop_square(size_t n, IN c, OUT c2)
{
    size_t i;
    for (i = 0; i < n; i++)
        c2[i] = c[i] * aspi_abs(c[i]);
}

/* ---- blocks */

/* The model's value from the Fresnel term at the squared cosines c2; x/over multiplies what comes from facets, and
 * y, NULL for the same, what comes from a base. */
ASP_FN void block_value(const asp_mat *mat, size_t n, const asp_real *c2, const asp_real *x,
                        const asp_real *over, const asp_real *y, asp_c3s out)
{
    asp_real ones[ASP_BLOCK], part[ASP_BLOCK];
    if (!mat->model->ASPI_CALL(value)) {
        aspi_block_fresnel(mat, n, c2, x, over, out);
        return;
    }
    aspi_block_ones(ones);
    aspi_block_fresnel(mat, n, c2, ones, ones, out);
    loop_ratio(n, x, over, part);
    mat->model->ASPI_CALL(value_n)(mat, n, part, y ? y : part, out.r, out.g, out.b);
}

ASP_FN void block_share(const asp_mat *mat, size_t n, const asp_real *ci, asp_real *share)
{
    asp_real F[3][ASP_BLOCK], ones[ASP_BLOCK], c2[ASP_BLOCK];
    asp_c3s to;
    if (!n)
        return;
    to.r = F[0];
    to.g = F[1];
    to.b = F[2];
    aspi_block_ones(ones);
    loop_square(n, ci, c2);
    aspi_block_fresnel(mat, n, c2, ones, ones, to);
    mat->model->ASPI_CALL(share_n)(mat, n, F[0], F[1], F[2], share);
}

/* f, or f cos_o where cosine is 1. Outputs may be inputs: they are written last. */
ASP_CLONES static void block_eval(const asp_mat *mat, size_t n, asp_cv3s wi, asp_cv3s wo, int cosine,
                                  asp_c3s out)
{
    const asp_shape *k = &mat->ndf;
    asp_real mx[ASP_BLOCK], my[ASP_BLOCK], mz[ASP_BLOCK], mz2[ASP_BLOCK], c2[ASP_BLOCK];
    asp_real D[ASP_BLOCK], si[ASP_BLOCK], so[ASP_BLOCK], x[ASP_BLOCK], over[ASP_BLOCK], y[ASP_BLOCK];
    asp_real ones[ASP_BLOCK];
    if (!n)
        return;
    if (!cosine)
        aspi_block_ones(ones);
    loop_half(n, wi.x, wi.y, wi.z, wo.x, wo.y, wo.z, mx, my, mz, mz2, c2);
    ASPI_OPS(k).density_n(k, n, mx, my, mz, D);
    ASPI_OPS(k).sigma_n(k, n, R(1.0), wi.x, wi.y, wi.z, si);
    ASPI_OPS(k).sigma_n(k, n, R(1.0), wo.x, wo.y, wo.z, so);
    if (mat->mask == 0)
        loop_parts(k, n, 0, wi, wo, mz2, c2, D, si, so, cosine ? wo.z : ones, x, over, y);
    else
        loop_parts(k, n, mat->mask, wi, wo, mz2, c2, D, si, so, cosine ? wo.z : ones, x, over, y);
    block_value(mat, n, c2, x, over, y, out);
}

ASP_CLONES static void block_pdf(const asp_mat *mat, size_t n, asp_cv3s wi, asp_cv3s wo, asp_real *out)
{
    const asp_shape *k = &mat->ndf;
    asp_real mx[ASP_BLOCK], my[ASP_BLOCK], mz[ASP_BLOCK], mz2[ASP_BLOCK], c2[ASP_BLOCK];
    asp_real D[ASP_BLOCK], si[ASP_BLOCK], share[ASP_BLOCK], p[ASP_BLOCK];
    if (!n)
        return;
    loop_half(n, wi.x, wi.y, wi.z, wo.x, wo.y, wo.z, mx, my, mz, mz2, c2);
    ASPI_OPS(k).density_n(k, n, mx, my, mz, D);
    ASPI_OPS(k).sigma_n(k, n, R(1.0), wi.x, wi.y, wi.z, si);
    loop_lobe_density(n, wi.z, D, si, p);
    if (mat->model->mixed) {
        block_share(mat, n, wi.z, share);
        loop_mixed_density(n, wi.z, wo.z, share, p);
    }
    memcpy(out, p, n * sizeof *out);
}

/* Visible normals only: D cancels in the weight, which is F J sigma_i cos_o. */
ASP_CLONES static void block_sample_pure(const asp_mat *mat, size_t n, asp_cv3s wi,
                                         const asp_real *u1, const asp_real *u2, asp_v3s wo,
                                         asp_real *pdf, asp_c3s F)
{
    const asp_shape *k = &mat->ndf;
    asp_real mz2[ASP_BLOCK], c2[ASP_BLOCK], si[ASP_BLOCK], so[ASP_BLOCK], x[ASP_BLOCK], over[ASP_BLOCK];
    asp_mirrored_s to;
    if (!n)
        return;
    to.wo_x = wo.x;
    to.wo_y = wo.y;
    to.wo_z = wo.z;
    to.m_z2 = mz2;
    to.cosine2 = c2;
    to.pdf = pdf;
    to.sigma_i = si;
    to.sigma_o = so;
    ASPI_OPS(k).reflect_n(k, n, wi.x, wi.y, wi.z, u1, u2, &to);
    if (mat->mask == 0) /* a constant here spares the default the other masks' arithmetic */
        loop_weights(k, n, 0, wi, wo.x, wo.y, wo.z, mz2, c2, si, so, x, over);
    else
        loop_weights(k, n, mat->mask, wi, wo.x, wo.y, wo.z, mz2, c2, si, so, x, over);
    block_value(mat, n, c2, x, over, NULL, F);
}

ASP_CLONES static void block_sample_mixed(const asp_mat *mat, size_t n, asp_cv3s wi,
                                          const asp_real *u1,
                                          const asp_real *u2, asp_v3s wo, asp_real *pdf, asp_c3s F)
{
    const asp_shape *k = &mat->ndf;
    asp_real mx[ASP_BLOCK], my[ASP_BLOCK], mz[ASP_BLOCK], mz2[ASP_BLOCK], c2[ASP_BLOCK];
    asp_real D[ASP_BLOCK], si[ASP_BLOCK], so[ASP_BLOCK], x[ASP_BLOCK], over[ASP_BLOCK], y[ASP_BLOCK];
    asp_real share[ASP_BLOCK], facet[ASP_BLOCK], v1[ASP_BLOCK], p[ASP_BLOCK];
    if (!n)
        return;
    block_share(mat, n, wi.z, share);
    loop_choose(n, share, u1, facet, v1);
    ASPI_OPS(k).visible_n(k, n, wi.x, wi.y, wi.z, v1, u2, mx, my, mz);
    loop_reflect(n, wi.x, wi.y, wi.z, mx, my, mz, wo.x, wo.y, wo.z);
    loop_mixed_direction(n, wi, facet, v1, u2, wo.x, wo.y, wo.z);
    loop_half(n, wi.x, wi.y, wi.z, wo.x, wo.y, wo.z, mx, my, mz, mz2, c2);
    ASPI_OPS(k).density_n(k, n, mx, my, mz, D);
    ASPI_OPS(k).sigma_n(k, n, R(1.0), wi.x, wi.y, wi.z, si);
    ASPI_OPS(k).sigma_n(k, n, R(1.0), wo.x, wo.y, wo.z, so);
    loop_lobe_density(n, wi.z, D, si, p);
    loop_mixed_density(n, wi.z, wo.z, share, p);
    loop_mixed_parts(k, n, mat->mask, wi, wo.x, wo.y, wo.z, mz2, c2, D, si, so, p, x, over, y);
    memcpy(pdf, p, n * sizeof *pdf);
    block_value(mat, n, c2, x, over, y, F);
}

/* ---- batches */

void ASPI_CALL(asp_eval_n)(const asp_mat *mat, size_t n, asp_cv3s wi, asp_cv3s wo, asp_c3s out)
{
    size_t i, size;
    if (mat->model->ASPI_CALL(eval)) {
        ASP_NAME(aspi_own_eval_n)(mat, n, wi, wo, 0, out);
        return;
    }
    ASPI_FOR_BLOCKS(i, size, n)
        block_eval(mat, size, ASPI_FROM(wi, i), ASPI_FROM(wo, i), 0, ASPI_TO_RGB(out, i));
}

void ASPI_CALL(asp_eval_cos_n)(const asp_mat *mat, size_t n, asp_cv3s wi, asp_cv3s wo, asp_c3s out)
{
    size_t i, size;
    if (mat->model->ASPI_CALL(eval)) {
        ASP_NAME(aspi_own_eval_n)(mat, n, wi, wo, 1, out);
        return;
    }
    ASPI_FOR_BLOCKS(i, size, n)
        block_eval(mat, size, ASPI_FROM(wi, i), ASPI_FROM(wo, i), 1, ASPI_TO_RGB(out, i));
}

void ASPI_CALL(asp_pdf_n)(const asp_mat *mat, size_t n, asp_cv3s wi, asp_cv3s wo, asp_real *out)
{
    size_t i, size;
    if (mat->model->ASPI_CALL(pdf)) {
        ASP_NAME(aspi_own_pdf_n)(mat, n, wi, wo, out);
        return;
    }
    ASPI_FOR_BLOCKS(i, size, n)
        block_pdf(mat, size, ASPI_FROM(wi, i), ASPI_FROM(wo, i), out + i);
}

void ASPI_CALL(asp_sample_n)(const asp_mat *mat, size_t n, asp_cv3s wi, const asp_real *u1,
                             const asp_real *u2, asp_v3s wo, asp_real *pdf, asp_c3s weight)
{
    asp_real o[3][ASP_BLOCK], p[ASP_BLOCK];
    int in_place = aspi_any_among(wo, wi.x, wi.y, wi.z) || aspi_any_among(wo, u1, u2, u2)
                || aspi_among(pdf, wi) || pdf == u1 || pdf == u2;
    size_t i, size;
    if (mat->model->ASPI_CALL(sample)) {
        ASP_NAME(aspi_own_sample_n)(mat, n, wi, u1, u2, wo, pdf, weight);
        return;
    }
    ASPI_FOR_BLOCKS(i, size, n) {
        asp_v3s to = in_place ? aspi_rows(o) : ASPI_TO(wo, i);
        asp_real *density = in_place ? p : pdf + i;
        if (mat->model->mixed)
            block_sample_mixed(mat, size, ASPI_FROM(wi, i), u1 + i, u2 + i, to, density,
                               ASPI_TO_RGB(weight, i));
        else
            block_sample_pure(mat, size, ASPI_FROM(wi, i), u1 + i, u2 + i, to, density,
                              ASPI_TO_RGB(weight, i));
        if (in_place) {
            aspi_put_rows(wo, i, size, o);
            memcpy(pdf + i, p, size * sizeof *p);
        }
    }
}

#undef IN
#undef OUT
#endif
