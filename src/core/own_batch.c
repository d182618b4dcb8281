/* own_batch.c - batches of models that bring calls of their own: one by one where they bring no blocks, so
 * that element i is what the single call gives. */
#ifndef ASP_PRECISION
#include "bsdf/bsdf.h"

#define ASP_PRECISION 64
#include "own_batch.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "own_batch.c"
#undef ASP_PRECISION

#else
#include "core/blocks.h"
#include "bsdf/bsdf_number.h"
#include "core/own_batch.h"

void ASP_NAME(aspi_own_eval_n)(const asp_mat *mat, size_t n, asp_cv3s wi, asp_cv3s wo, int cosine, asp_c3s out)
{
    size_t i = 0, k, size;
    asp_real g[ASP_BLOCK];
    if (mat->model->ASPI_CALL(eval_n))
        ASPI_FOR_BLOCKS(i, size, n) {
            const asp_real *const in[3] = { wi.x + i, wi.y + i, wi.z + i };
            const asp_real *const to[3] = { wo.x + i, wo.y + i, wo.z + i };
            if (!mat->model->ASPI_CALL(eval_n)(mat, size, in, to, cosine, g))
                break;
            for (k = 0; k < size; k++)
                out.r[i + k] = out.g[i + k] = out.b[i + k] = g[k];
        }
    for (; i < n; i++) {
        asp_v3 a, b;
        asp_c3 f;
        a = aspi_at(wi.x, wi.y, wi.z, i);
        b = aspi_at(wo.x, wo.y, wo.z, i);
        mat->model->ASPI_CALL(eval)(mat, &a, &b, cosine, &f);
        out.r[i] = f.r;
        out.g[i] = f.g;
        out.b[i] = f.b;
    }
}

void ASP_NAME(aspi_own_pdf_n)(const asp_mat *mat, size_t n, asp_cv3s wi, asp_cv3s wo, asp_real *out)
{
    size_t i = 0, size;
    asp_real p[ASP_BLOCK];
    if (mat->model->ASPI_CALL(pdf_n))
        ASPI_FOR_BLOCKS(i, size, n) {
            const asp_real *const in[3] = { wi.x + i, wi.y + i, wi.z + i };
            const asp_real *const to[3] = { wo.x + i, wo.y + i, wo.z + i };
            if (!mat->model->ASPI_CALL(pdf_n)(mat, size, in, to, p))
                break;
            memcpy(out + i, p, size * sizeof *p);
        }
    for (; i < n; i++) {
        asp_v3 a, b;
        a = aspi_at(wi.x, wi.y, wi.z, i);
        b = aspi_at(wo.x, wo.y, wo.z, i);
        out[i] = mat->model->ASPI_CALL(pdf)(mat, &a, &b);
    }
}

void ASP_NAME(aspi_own_sample_n)(const asp_mat *mat, size_t n, asp_cv3s wi, const asp_real *u1,
                         const asp_real *u2, asp_v3s wo, asp_real *pdf, asp_c3s weight)
{
    asp_real u3[ASP_BLOCK];
    size_t i = 0, k, size;
    if (mat->model->ASPI_CALL(sample_n))
        ASPI_FOR_BLOCKS(i, size, n) {
            const asp_real *const in[3] = { wi.x + i, wi.y + i, wi.z + i }, *const u[3] = { u1 + i, u2 + i, u3 };
            asp_real *const out[3] = { wo.x + i, wo.y + i, wo.z + i };
            asp_real *const by[3] = { weight.r + i, weight.g + i, weight.b + i };
            for (k = 0; k < size; k++)
                u3[k] = aspi_third_number(u1[i + k], u2[i + k]);
            if (!mat->model->ASPI_CALL(sample_n)(mat, size, in, u, out, pdf + i, by))
                break;
        }
    for (; i < n; i++) {
        asp_sampled s = ASPI_CALL(asp_sample)(mat, aspi_at(wi.x, wi.y, wi.z, i), u1[i], u2[i]);
        wo.x[i] = s.wo.x;
        wo.y[i] = s.wo.y;
        wo.z[i] = s.wo.z;
        pdf[i] = s.pdf;
        weight.r[i] = s.weight.r;
        weight.g[i] = s.weight.g;
        weight.b[i] = s.weight.b;
    }
}
#endif
