/* material.c - eval, pdf and sample of reflecting materials, one by one: asperity.h sections 7 and 9
 *
 * Read three times like facets.c; the formulas are in reflection.h. */
#ifndef ASP_PRECISION
#include "bsdf/bsdf.h"

#define ASP_PRECISION 64
#include "material.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "material.c"
#undef ASP_PRECISION

#else
#include "core/blocks.h"
#include "bsdf/bsdf_number.h"
#include "bsdf/facet_fresnel.h"
#include "bsdf/reflection.h"
#include "core/own_batch.h"

#ifndef ASPI_MATERIAL_NAMES
#define ASPI_MATERIAL_NAMES
#define value_of ASP_NAME(value_of)
#define share_of ASP_NAME(share_of)
#define eval_scaled ASP_NAME(eval_scaled)
#define lit_part ASP_NAME(lit_part)
#define sample_pure ASP_NAME(sample_pure)
#define sample_mixed ASP_NAME(sample_mixed)
#define sample_facets ASP_NAME(sample_facets)
#define sample_value ASP_NAME(sample_value)
#define reflected ASP_NAME(reflected)
#endif

/* The model's value from the Fresnel term at the squared cosine c2; x.x/x.y multiplies what comes from facets. */
ASP_FN void value_of(const asp_mat *mat, asp_real c2, asp_v2 x, asp_real y, asp_c3 *out)
{
    asp_real F[3];
    if (!mat->model->ASPI_CALL(value)) {
        aspi_fresnel(mat, c2, x.x, x.y, F);
        out->r = F[0];
        out->g = F[1];
        out->b = F[2];
        return;
    }
    aspi_fresnel(mat, c2, R(1.0), R(1.0), F);
    mat->model->ASPI_CALL(value)(mat, F[0], F[1], F[2], aspi_finite(x.x / x.y), y, out);
}

/* ---- single calls */

/* aspi_reflected; a constant mask spares the default the others' arithmetic. */
ASP_FN asp_v2 lit_part(const asp_mat *mat, asp_v3 wi, asp_v3 wo, asp_real mz2, asp_real c2,
                       asp_real sigma_i, asp_real sigma_o, asp_real by)
{
    return mat->mask == 0
         ? aspi_reflected(&mat->ndf, wi, wo, mz2, c2, sigma_i, sigma_o, by, 0)
         : aspi_reflected(&mat->ndf, wi, wo, mz2, c2, sigma_i, sigma_o, by, mat->mask);
}

static asp_real share_of(const asp_mat *mat, asp_real ci)
{
    asp_real F[3];
    if (!mat->model->mixed)
        return R(1.0);
    aspi_fresnel(mat, ci * aspi_abs(ci), R(1.0), R(1.0), F);
    return mat->model->ASPI_CALL(share)(mat, F);
}

/* f times by, where `by` is 1 or a cosine. */
ASP_CLONES_SINGLE static asp_c3 eval_scaled(const asp_mat *mat, asp_v3 wi, asp_v3 wo, asp_real by)
{
    const asp_shape *k = &mat->ndf;
    asp_v3 m = aspi_half_vector(wi, wo);
    asp_real D = aspi_density_of(k, m), sigma_i = aspi_sigma_of(k, wi), sigma_o = aspi_sigma_of(k, wo);
    asp_real c = aspi_dot(wi, m), c2 = c * aspi_abs(c), mz2 = m.z * aspi_abs(m.z);
    asp_real y = aspi_min(wi.z, wo.z) <= R(0.0) ? R(0.0) : by;
    asp_c3 out;
    value_of(mat, c2, lit_part(mat, wi, wo, mz2, c2, sigma_i, sigma_o, R(0.25) * D * y), y, &out);
    return out;
}

asp_c3 ASPI_CALL(asp_eval)(const asp_mat *mat, asp_v3 wi, asp_v3 wo)
{
    asp_c3 f;
    if (!mat->model->ASPI_CALL(eval))
        return eval_scaled(mat, wi, wo, R(1.0));
    mat->model->ASPI_CALL(eval)(mat, &wi, &wo, 0, &f);
    return f;
}

asp_c3 ASPI_CALL(asp_eval_cos)(const asp_mat *mat, asp_v3 wi, asp_v3 wo)
{
    asp_c3 f;
    if (!mat->model->ASPI_CALL(eval))
        return eval_scaled(mat, wi, wo, wo.z);
    mat->model->ASPI_CALL(eval)(mat, &wi, &wo, 1, &f);
    return f;
}

asp_real ASPI_CALL(asp_pdf)(const asp_mat *mat, asp_v3 wi, asp_v3 wo)
{
    asp_v3 m;
    asp_real lobe;
    if (mat->model->ASPI_CALL(pdf))
        return mat->model->ASPI_CALL(pdf)(mat, &wi, &wo);
    m = aspi_half_vector(wi, wo);
    lobe = aspi_lobe_density(wi.z, aspi_density_of(&mat->ndf, m), aspi_sigma_of(&mat->ndf, wi));
    return mat->model->mixed ? aspi_mixed_density(wi.z, wo.z, lobe, share_of(mat, wi.z)) : lobe;
}

/* Visible normals only: D cancels in the weight, which is F J sigma_i cos_o. */
ASP_FN asp_v2 reflected(const asp_mat *mat, asp_v3 wi, asp_real u1, asp_real u2, asp_mirrored *s)
{
    ASPI_OPS(&mat->ndf).reflect(&mat->ndf, wi.x, wi.y, wi.z, u1, u2, s);
    return lit_part(mat, wi, aspi_vector(s->wo_x, s->wo_y, s->wo_z), s->m_z2, s->cosine2, s->sigma_i, s->sigma_o,
                    s->sigma_i * s->wo_z);
}

ASP_CLONES_SINGLE static asp_sampled sample_pure(const asp_mat *mat, asp_v3 wi, asp_real u1, asp_real u2)
{
    asp_sampled out;
    asp_mirrored s;
    asp_v2 x = reflected(mat, wi, u1, u2, &s);
    asp_real F[3];
    aspi_fresnel(mat, s.cosine2, x.x, x.y, F);
    out.wo.x = s.wo_x;
    out.wo.y = s.wo_y;
    out.wo.z = s.wo_z;
    out.pdf = s.pdf;
    out.weight.r = F[0];
    out.weight.g = F[1];
    out.weight.b = F[2];
    return out;
}

/* The same with the model's formula. */
static asp_sampled sample_value(const asp_mat *mat, asp_v3 wi, asp_real u1, asp_real u2)
{
    asp_sampled out;
    asp_mirrored s;
    asp_v2 x = reflected(mat, wi, u1, u2, &s);
    asp_c3 weight;
    value_of(mat, s.cosine2, x, x.x / x.y, &weight);
    out.wo = aspi_vector(s.wo_x, s.wo_y, s.wo_z);
    out.pdf = s.pdf;
    out.weight = weight;
    return out;
}

/* Facets or base by u1, which is stretched again; the density is that of the mixture. */
static asp_sampled sample_mixed(const asp_mat *mat, asp_v3 wi, asp_real u1, asp_real u2)
{
    asp_sampled out;
    const asp_shape *k = &mat->ndf;
    asp_real sigma_i = aspi_sigma_of(k, wi), share = share_of(mat, wi.z), c, c2, mz2, D, y, scale;
    asp_v3 m;
    int facet = u1 < share;
    u1 = facet ? u1 / share : (u1 - share) / (R(1.0) - share);
    m = ASPI_CALL(asp_sample_visible)(k, wi, u1, u2);
    out.wo = facet ? aspi_reflect(wi, m) : aspi_cosine_lobe(wi, u1, u2);
    m = aspi_half_vector(wi, out.wo);
    c = aspi_dot(wi, m);
    c2 = c * aspi_abs(c);
    mz2 = m.z * aspi_abs(m.z);
    D = aspi_density_of(k, m);
    out.pdf = aspi_mixed_density(wi.z, out.wo.z, aspi_lobe_density(wi.z, D, sigma_i), share);
    y = aspi_min(wi.z, out.wo.z) <= R(0.0) || out.pdf <= R(0.0) ? R(0.0) : out.wo.z / out.pdf;
    scale = out.pdf <= R(0.0) ? R(0.0) : R(0.25) * D / out.pdf;
    value_of(mat, c2, lit_part(mat, wi, out.wo, mz2, c2, sigma_i, aspi_sigma_of(k, out.wo),
                               aspi_above(out.wo.z) * scale), y, &out.weight);
    return out;
}

/* The compiler must not take this in: a copy of what was just written in parts would stall. */
ASP_APART static asp_sampled sample_facets(const asp_mat *mat, asp_v3 wi, asp_real u1, asp_real u2)
{
    if (mat->model->mixed)
        return sample_mixed(mat, wi, u1, u2);
    return sample_value(mat, wi, u1, u2);
}

asp_sampled ASPI_CALL(asp_sample_lobe)(const asp_mat *mat, asp_v3 wi, asp_real u1, asp_real u2, asp_real u3)
{
    if (mat->model->ASPI_CALL(sample))
        return mat->model->ASPI_CALL(sample)(mat, wi, u1, u2, u3);
    return mat->model->ASPI_CALL(value) ? sample_facets(mat, wi, u1, u2) : sample_pure(mat, wi, u1, u2);
}

asp_sampled ASPI_CALL(asp_sample)(const asp_mat *mat, asp_v3 wi, asp_real u1, asp_real u2)
{
    if (mat->model->ASPI_CALL(sample))
        return mat->model->ASPI_CALL(sample)(mat, wi, u1, u2, aspi_third_number(u1, u2));
    return mat->model->ASPI_CALL(value) ? sample_facets(mat, wi, u1, u2) : sample_pure(mat, wi, u1, u2);
}
#endif
