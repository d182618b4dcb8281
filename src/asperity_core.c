/* asperity_core.c - the whole core as one translation unit: cc -O2 -Iinclude -Isrc -c src/asperity_core.c
 *
 * Written by scripts/single-file.sh (make docs). Add -fno-math-errno -fno-trapping-math
 * -ffp-contract=off -O3 to get the speed and the bits of the library. */
#include "core/error.c"
#undef ASP_PRECISION
#include "core/facets.c"
#undef ASP_PRECISION
#include "core/fresnel.c"
#undef ASP_PRECISION
#include "core/make_material.c"
#undef ASP_PRECISION
#include "core/map.c"
#undef ASP_PRECISION
#include "core/material.c"
#undef ASP_PRECISION
#include "core/metals.c"
#undef ASP_PRECISION
#include "core/ndf.c"
#undef ASP_PRECISION
#include "core/parse.c"
#undef ASP_PRECISION
#include "core/spec.c"
#undef ASP_PRECISION
#include "bsdf/conductor.c"
#undef ASP_PRECISION
#include "bsdf/lambert_specular.c"
#undef ASP_PRECISION
#include "ndf/beckmann.c"
#undef ASP_PRECISION
#include "ndf/ggx.c"
#undef ASP_PRECISION
#include "ndf/student_prepare.c"
#undef ASP_PRECISION
#include "ndf/student_t.c"
#undef ASP_PRECISION
