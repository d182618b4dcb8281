/* lambert_specular.c - a Lambertian term beside rough reflection
 *
 * f = diffuse/pi + specular F D G2 / (4 cos_i cos_o): the Cook-Torrance form that the STD paper fits
 * to measured materials (section 5). Not energy conserving by itself. */
#ifndef ASP_PRECISION
#include "bsdf/bsdf.h"

#define ASP_NDF lambert_specular
#define ASP_PRECISION 64
#include "lambert_specular.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "lambert_specular.c"
#undef ASP_PRECISION
#undef ASP_NDF

static asp_status lambert_specular_parse(aspi_spec *spec, asp_material *out, asp_error *err)
{
    asp_status s;
    out->a.r = out->a.g = out->a.b = 0.5;
    out->b.r = out->b.g = out->b.b = 1.0;
    s = aspi_spec_colour(spec, "diffuse", 0.0, 0, 1e3, &out->a, NULL, err);
    if (!s)
        s = aspi_spec_colour(spec, "specular", 0.0, 0, 1e3, &out->b, NULL, err);
    return s ? s : aspi_parse_fresnel(spec, 1.5, out, err);
}

static const aspi_bsdf_key lambert_specular_keys[] = {
    { "diffuse", "albedo of the Lambertian term, default 0.5" },
    { "specular", "scale of the reflection, default 1" },
    ASPI_FRESNEL_KEYS, { NULL, NULL }
};

ASP_RECORD asp_bsdf asp_bsdf_lambert_specular = {
    "lambert_specular", "Lambert + rough reflection", "Ribardiere et al. 2017, section 5",
    lambert_specular_keys, 1, ASPI_FACETS_NONE, lambert_specular_parse, NULL,
    ASPI_BSDF_OPS(lambert_specular)
};

#else
#include "asperity/elementary.h"
#include "bsdf/bsdf_number.h"

ASP_FN asp_c3 bsdf_value(const asp_mat *mat, asp_c3 F, asp_real x, asp_real y)
{
    asp_real base = y * R(1.0 / ASP_PI);
    F.r = mat->a.r * base + mat->b.r * F.r * x;
    F.g = mat->a.g * base + mat->b.g * F.g * x;
    F.b = mat->a.b * base + mat->b.b * F.b * x;
    return F;
}

/* In proportion to what either lobe reflects at cos_i, but at least a tenth for each that is there:
 * towards grazing the lobes overlap and a bad guess must not make weights large. */
ASP_FN asp_real bsdf_share(const asp_mat *mat, asp_c3 F)
{
    asp_real facets = mat->b.r * F.r + mat->b.g * F.g + mat->b.b * F.b;
    asp_real base = mat->a.r + mat->a.g + mat->a.b;
    asp_real sum = facets + base;
    asp_real p = facets / (sum > R(0.0) ? sum : R(1.0));
    p = p < R(0.1) ? R(0.1) : p;
    p = p > R(0.9) ? R(0.9) : p;
    p = base > R(0.0) ? p : R(1.0);
    return mat->b.r + mat->b.g + mat->b.b > R(0.0) ? p : R(0.0);
}

#include "bsdf/bsdf_loops.h"
#endif
