/* compensated.c - a rough conductor that gives back what single scattering loses, without a walk
 *
 * form=kulla_conty (Kulla, Conty 2017): a second lobe (1 - E(wi))(1 - E(wo))/(pi (1 - Emean)), E the
 * albedo of the surface as a perfect mirror, coloured by F^2 Emean/(1 - F (1 - Emean)) with F the mean of
 * the Fresnel term. Reciprocal; F = 1 returns all light.
 * form=turquin (Turquin 2019): the single reflection times 1 + F0 (1 - E(wo))/E(wo), here with the E of
 * the given direction wi and F0 the reflectance along the normal. Not reciprocal, says its author. */
#ifndef ASP_PRECISION
#include "bsdf/bsdf.h"
#include "bsdf/energy.h"

#define ASP_NDF compensated
#define ASP_PRECISION 64
#include "compensated.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "compensated.c"
#undef ASP_PRECISION
#undef ASP_NDF

/* Mean of F against 2 c dc, by Simpson's rule. */
static void fresnel_mean(const asp_material *mat, double mean[3])
{
    int i, k, n = 64;
    mean[0] = mean[1] = mean[2] = 0.0;
    for (i = 0; i <= n; i++) {
        double c = (double)i / n, F[3], w = i == 0 || i == n ? 1.0 : i & 1 ? 4.0 : 2.0;
        aspi_fresnel_64(mat, c * c, 1.0, 1.0, F);
        for (k = 0; k < 3; k++)
            mean[k] += 2.0 * c * F[k] * w / (3.0 * n);
    }
}

static asp_status compensated_prepare(asp_material *out, asp_error *err)
{
    asp_material mirror = *out;
    double F[3], E, colour[3];
    int k;
    (void)err;
    mirror.fresnel = ASPI_FRESNEL_ONE;
    aspi_energy_prepare(&mirror);
    memcpy(out->energy, mirror.energy, sizeof out->energy);
    E = out->energy[ENERGY_MEAN];
    fresnel_mean(out, F);
    for (k = 0; k < 3; k++)
        colour[k] = F[k] * F[k] * E / (1.0 - F[k] * (1.0 - E)) / (ASP_PI * aspi_max_64(1.0 - E, 1e-12));
    if (out->b.r == COMPENSATED_TURQUIN)
        aspi_fresnel_64(out, 1.0, 1.0, 1.0, colour);
    out->a.r = colour[0];
    out->a.g = colour[1];
    out->a.b = colour[2];
    return ASP_OK;
}

asp_status aspi_parse_compensation(aspi_spec *spec, asp_material *out, asp_error *err)
{
    aspi_item *item = aspi_spec_find(spec, "form");
    out->b.r = COMPENSATED_KULLA_CONTY;
    if (item && item->value_size == 7 && !memcmp(item->value, "turquin", 7))
        out->b.r = COMPENSATED_TURQUIN;
    else if (item && (item->value_size != 11 || memcmp(item->value, "kulla_conty", 11)))
        return aspi_spec_fail(spec, item->value, ASP_EUNKNOWN, "form", 4,
                              "expected kulla_conty or turquin", err);
    return ASP_OK;
}

static asp_status compensated_parse(aspi_spec *spec, asp_material *out, asp_error *err)
{
    asp_status s = aspi_parse_compensation(spec, out, err);
    return s ? s : aspi_parse_fresnel(spec, 0.0, out, err);
}

static const aspi_bsdf_key compensated_keys[] = { ASPI_COMPENSATION_KEY, ASPI_FRESNEL_KEYS, { NULL, NULL } };

ASP_RECORD asp_bsdf asp_bsdf_compensated = {
    "compensated", "Rough conductor, energy given back", "Kulla, Conty 2017; Turquin 2019",
    compensated_keys, 0, ASPI_FACETS_NONE, compensated_parse, compensated_prepare,
    ASPI_BSDF_OWN(compensated)
};

#else
#include "asperity/elementary.h"
#include "bsdf/bsdf_number.h"
#include "bsdf/coat.h"

ASP_FN asp_c3 coat_rest(const asp_mat *mat, asp_real ei, asp_real eo)
{
    asp_real by = mat->b.r == R(COMPENSATED_TURQUIN) ? R(0.0) : (R(1.0) - ei) * (R(1.0) - eo);
    asp_c3 f;
    f.r = mat->a.r * by;
    f.g = mat->a.g * by;
    f.b = mat->a.b * by;
    return f;
}

ASP_FN asp_real coat_share(const asp_mat *mat, asp_real ei)
{
    return mat->b.r == R(COMPENSATED_TURQUIN) ? R(1.0) : aspi_min(aspi_max(ei, R(0.1)), R(0.9999));
}

#define COAT_SCALE(mat, F0, ei) \
    ((mat)->b.r == R(COMPENSATED_TURQUIN) ? R(1.0) + (F0) * (R(1.0) - (ei)) / aspi_max(ei, R(1e-3)) : R(1.0))
#include "bsdf/coat_calls.h"
#endif
