/* facet_fresnel.h - the Fresnel term of a material, in both precisions */

#include "asperity/fresnel.h"

#ifndef ASPI_FACET_FRESNEL_NAMES
#define ASPI_FACET_FRESNEL_NAMES
#define aspi_fresnel ASP_NAME(aspi_fresnel)
#endif

#if (ASP_PRECISION == 64 && !defined(ASPI_FACET_FRESNEL_64)) || \
    (ASP_PRECISION == 32 && !defined(ASPI_FACET_FRESNEL_32))
#if ASP_PRECISION == 64
#define ASPI_FACET_FRESNEL_64
#else
#define ASPI_FACET_FRESNEL_32
#endif

/* Numbers go by pointer: small structs of floats stall in the usual calling convention. */
ASP_FN void aspi_fresnel(const asp_mat *mat, asp_real c, asp_real F[3])
{
    switch (mat->fresnel) {
    case ASPI_FRESNEL_CONDUCTOR:
        F[0] = aspi_fresnel_conductor(c, mat->c.r, mat->d.r);
        F[1] = aspi_fresnel_conductor(c, mat->c.g, mat->d.g);
        F[2] = aspi_fresnel_conductor(c, mat->c.b, mat->d.b);
        break;
    case ASPI_FRESNEL_F82:
        F[0] = aspi_fresnel_f82(c, mat->c.r, mat->d.r);
        F[1] = aspi_fresnel_f82(c, mat->c.g, mat->d.g);
        F[2] = aspi_fresnel_f82(c, mat->c.b, mat->d.b);
        break;
    case ASPI_FRESNEL_DIELECTRIC:
        F[0] = F[1] = F[2] = aspi_fresnel_dielectric(c, mat->c.r);
        break;
    default:
        F[0] = F[1] = F[2] = c == c ? R(1.0) : c;
    }
}
#endif
