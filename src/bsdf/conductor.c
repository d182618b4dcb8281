/* conductor.c - rough conductor: reflection by the facets alone
 *
 * f = F D G2 / (4 cos_i cos_o): Walter et al. 2007, eq. 20; the Ellipsoid NDF paper, section 3. */
#ifndef ASP_PRECISION
#include "bsdf/bsdf.h"

#define ASP_NDF conductor
#define ASP_PRECISION 64
#include "conductor.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "conductor.c"
#undef ASP_PRECISION
#undef ASP_NDF

static asp_status conductor_parse(aspi_spec *spec, asp_material *out, asp_error *err)
{
    out->b.r = out->b.g = out->b.b = 1.0;
    return aspi_parse_fresnel(spec, 0.0, out, err);
}

static const aspi_bsdf_key conductor_keys[] = { ASPI_FRESNEL_KEYS, { NULL, NULL } };

ASP_RECORD asp_bsdf asp_bsdf_conductor = {
    "conductor", "Rough conductor", "Walter et al. 2007, eq. 20", conductor_keys, 0,
    ASPI_FACETS_REFLECT, conductor_parse, NULL, ASPI_BSDF_OPS(conductor)
};

#else
#include "asperity/elementary.h"
#include "bsdf/bsdf_number.h"

ASP_FN asp_c3 bsdf_value(const asp_mat *mat, asp_c3 F, asp_real x, asp_real y)
{
    (void)mat;
    (void)y;
    F.r = F.r * x;
    F.g = F.g * x;
    F.b = F.b * x;
    return F;
}

ASP_FN asp_real bsdf_share(const asp_mat *mat, asp_c3 F)
{
    (void)mat;
    (void)F;
    return R(1.0);
}

#include "bsdf/bsdf_loops.h"
#endif
