/* coat.h - what coat_calls.h needs; read before the model's own coat_rest and coat_share */

#include "bsdf/energy_at.h"
#include "bsdf/facet_fresnel.h"
#include "bsdf/reflection.h"

#ifndef ASPI_COAT_NAMES
#define ASPI_COAT_NAMES
#define coat_rest ASP_NDF_NAME(_rest)
#define coat_share ASP_NDF_NAME(_share_of)
#define coat_lobe ASP_NDF_NAME(_lobe)
#endif
