/* plastic.c - a rough dielectric coat over a Lambertian base, with all reflections between them
 *
 * What the coat does not reflect, 1 - E(wi), reaches the base. Of the diffuse light that comes back up,
 * T = (1 - Emean)/eta^2 gets out (both follow from reciprocity), the rest is reflected down again:
 *
 *     f = F D G2/(4 cos cos) + (1 - E(wi))(1 - E(wo)) / (pi (1 - Emean)) a T/(1 - a (1 - T))
 *
 * with a the base's albedo. Reciprocal; a = 1 returns all light (Kelemen, Szirmay-Kalos 2001 for the
 * coupling; Walter et al. 2007 for the coat). E comes from a table of the coat itself. */
#ifndef ASP_PRECISION
#include "bsdf/bsdf.h"
#include "bsdf/energy.h"

#define ASP_NDF plastic
#define ASP_PRECISION 64
#include "plastic.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "plastic.c"
#undef ASP_PRECISION
#undef ASP_NDF

static double came_out(double a, double T) { return a * T / (1.0 - a * (1.0 - T)); }

static asp_status plastic_prepare(asp_material *out, asp_error *err)
{
    double rest, T;
    (void)err;
    aspi_energy_prepare(out);
    rest = 1.0 - out->energy[ENERGY_MEAN];
    T = rest / (out->c.r * out->c.r);
    /* the base's term without the two factors of the views */
    out->b.r = came_out(out->a.r, T) / (ASP_PI * rest);
    out->b.g = came_out(out->a.g, T) / (ASP_PI * rest);
    out->b.b = came_out(out->a.b, T) / (ASP_PI * rest);
    return ASP_OK;
}

static asp_status plastic_parse(aspi_spec *spec, asp_material *out, asp_error *err)
{
    double eta = 1.5;
    asp_status s;
    out->a.r = out->a.g = out->a.b = 0.5;
    s = aspi_spec_colour(spec, "albedo", 0.0, 0, 1.0, &out->a, NULL, err);
    if (!s)
        s = aspi_spec_ranged(spec, "eta", 1.0, 1, 10.0, &eta, NULL, err);
    out->fresnel = ASPI_FRESNEL_DIELECTRIC;
    out->c.r = out->c.g = out->c.b = eta;
    return s;
}

static const aspi_bsdf_key plastic_keys[] = {
    { "albedo", "of the base, 0 to 1, default 0.5" },
    { "eta", "index of the coat, above 1 to 10, default 1.5" },
    { NULL, NULL }
};

ASP_RECORD asp_bsdf asp_bsdf_plastic = {
    "plastic", "Rough coat over a Lambertian base", "Walter et al. 2007; Kelemen, Szirmay-Kalos 2001",
    plastic_keys, 0, ASPI_FACETS_NONE, plastic_parse, plastic_prepare, ASPI_BSDF_OWN(plastic)
};

#else
#include "asperity/elementary.h"
#include "bsdf/bsdf_number.h"
#include "bsdf/coat.h"

/* The base's term is b (1 - E(wi))(1 - E(wo)). */
ASP_FN asp_c3 coat_rest(const asp_mat *mat, asp_real ei, asp_real eo)
{
    asp_real by = (R(1.0) - ei) * (R(1.0) - eo);
    asp_c3 f;
    f.r = mat->b.r * by;
    f.g = mat->b.g * by;
    f.b = mat->b.b * by;
    return f;
}

/* In proportion to what coat and base reflect. */
ASP_FN asp_real coat_share(const asp_mat *mat, asp_real ei)
{
    asp_real base = (mat->b.r + mat->b.g + mat->b.b) * R(ASP_PI / 3.0) * (R(1.0) - ei)
                  * (R(1.0) - mat->energy[ENERGY_MEAN]);
    asp_real p = ei / (ei + base);
    return base > R(0.0) ? aspi_min(aspi_max(p, R(0.1)), R(0.9)) : R(1.0);
}

#include "bsdf/coat_calls.h"
#endif
