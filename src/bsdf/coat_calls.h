/* coat_calls.h - eval, pdf and sample of single reflection plus a diffuse rest
 *
 * The model defines coat_rest(mat, E(wi), E(wo)), what is added to single reflection, coat_share(mat, E(wi)),
 * the share of samples spent on visible normals (the others: aspi_rest_lobe), and may define COAT_SCALE(mat, F0, E(wi)), a factor of
 * the reflection with mat->a as F0. */

#ifndef COAT_SCALE
#define COAT_SCALE(mat, F0, ei) R(1.0)
#endif

/* D/4 J and F of the reflection wi -> wo, and the density of visible normals through it. */
ASP_FN asp_real coat_lobe(const asp_mat *mat, asp_v3 wi, asp_v3 wo, asp_real F[3], asp_real *pdf)
{
    const asp_shape *k = &mat->ndf;
    asp_v3 m = aspi_half_vector(wi, wo);
    asp_real c = aspi_dot(wi, m), D = ASPI_CALL(asp_D)(k, m), si = ASPI_CALL(asp_sigma)(k, wi);
    aspi_fresnel(mat, c * aspi_abs(c), R(1.0), R(1.0), F);
    *pdf = aspi_lobe_density(wi.z, D, si);
    return aspi_facet_part(k, wi, wo, m.z, c, si, ASPI_CALL(asp_sigma)(k, wo), R(0.25) * D, mat->mask);
}

static void bsdf_eval(const asp_mat *mat, const asp_v3 *wi, const asp_v3 *wo, int cosine, asp_c3 *out)
{
    asp_real F[3], pdf, x = coat_lobe(mat, *wi, *wo, F, &pdf);
    asp_real by = cosine ? wo->z : R(1.0), ei, eo;
    if (!(aspi_min(wi->z, wo->z) > R(0.0))) {
        out->r = out->g = out->b = x * R(0.0);
        return;
    }
    ei = aspi_energy_at(mat, mat->energy, *wi);
    eo = aspi_energy_at(mat, mat->energy, *wo);
    *out = coat_rest(mat, ei, eo);
    out->r = (out->r + F[0] * x * COAT_SCALE(mat, mat->a.r, ei)) * by;
    out->g = (out->g + F[1] * x * COAT_SCALE(mat, mat->a.g, ei)) * by;
    out->b = (out->b + F[2] * x * COAT_SCALE(mat, mat->a.b, ei)) * by;
}

static asp_real bsdf_pdf(const asp_mat *mat, const asp_v3 *wi, const asp_v3 *wo)
{
    asp_real F[3], pdf, share;
    coat_lobe(mat, *wi, *wo, F, &pdf);
    share = coat_share(mat, aspi_energy_at(mat, mat->energy, *wi));
    pdf = share * pdf + (R(1.0) - share) * aspi_rest_density(mat->energy, aspi_above(wo->z));
    return wi->z <= R(0.0) ? R(0.0) : pdf;
}

static asp_sampled bsdf_sample(const asp_mat *mat, asp_v3 wi, asp_real u1, asp_real u2, asp_real u3)
{
    asp_sampled out;
    asp_real share = coat_share(mat, aspi_energy_at(mat, mat->energy, wi)), pdf;
    asp_v3 m = ASPI_CALL(asp_sample_visible)(&mat->ndf, wi, u1, u2);
    out.wo = u3 < share ? aspi_reflect(wi, m) : aspi_rest_lobe(mat->energy, wi, u1, u2);
    out.pdf = bsdf_pdf(mat, &wi, &out.wo);
    bsdf_eval(mat, &wi, &out.wo, 1, &out.weight);
    /* next to the horizon both may be too small to have an inverse */
    pdf = out.pdf > R(0.0) ? out.pdf : R(INFINITY);
    out.weight.r = out.weight.r / pdf;
    out.weight.g = out.weight.g / pdf;
    out.weight.b = out.weight.b / pdf;
    return out;
}
#undef COAT_SCALE
