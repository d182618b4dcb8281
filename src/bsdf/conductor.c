/* conductor.c - rough conductor: reflection by the facets alone
 *
 * f = F D G2 / (4 cos_i cos_o): Walter et al. 2007, eq. 20; the Ellipsoid NDF paper, section 3. */
#include "bsdf/bsdf.h"

static asp_status conductor_parse(aspi_spec *spec, asp_material *out, asp_error *err)
{
    out->b.r = out->b.g = out->b.b = 1.0;
    return aspi_parse_fresnel(spec, 0.0, out, err);
}

static const aspi_bsdf_key conductor_keys[] = { ASPI_FRESNEL_KEYS, { NULL, NULL } };

ASP_RECORD asp_bsdf asp_bsdf_conductor = {
    "conductor", "Rough conductor", "Walter et al. 2007, eq. 20", conductor_keys, 0,
    ASPI_FACETS_REFLECT, conductor_parse, NULL, ASPI_BSDF_FACETS
};
