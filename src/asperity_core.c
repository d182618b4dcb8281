/* asperity_core.c - the whole core as one translation unit: cc -O2 -Iinclude -Isrc -c src/asperity_core.c
 *
 * Written by scripts/single-file.sh (make docs). Whatever the command line says, products and sums are
 * rounded one by one, so that the bits are the library's; -O3 gives its speed. */
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=off", "no-math-errno", "no-trapping-math")
#endif

#include "core/bounded.c"
#undef ASP_PRECISION
#include "core/convert.c"
#undef ASP_PRECISION
#include "core/energy.c"
#undef ASP_PRECISION
#include "core/error.c"
#undef ASP_PRECISION
#include "core/facets.c"
#undef ASP_PRECISION
#include "core/filter.c"
#undef ASP_PRECISION
#include "core/fresnel.c"
#undef ASP_PRECISION
#include "core/make_material.c"
#undef ASP_PRECISION
#include "core/map.c"
#undef ASP_PRECISION
#include "core/material.c"
#undef ASP_PRECISION
#include "core/material_batch.c"
#undef ASP_PRECISION
#include "core/metals.c"
#undef ASP_PRECISION
#include "core/ndf.c"
#undef ASP_PRECISION
#include "core/oracle.c"
#undef ASP_PRECISION
#include "core/own_batch.c"
#undef ASP_PRECISION
#include "core/parse.c"
#undef ASP_PRECISION
#include "core/sggx.c"
#undef ASP_PRECISION
#include "core/spec.c"
#undef ASP_PRECISION
#include "core/spectrum.c"
#undef ASP_PRECISION
#include "core/walk.c"
#undef ASP_PRECISION
#include "core/walter.c"
#undef ASP_PRECISION
#include "bsdf/compensated.c"
#undef ASP_PRECISION
#include "bsdf/conductor.c"
#undef ASP_PRECISION
#include "bsdf/dielectric.c"
#undef ASP_PRECISION
#include "bsdf/lambert_specular.c"
#undef ASP_PRECISION
#include "bsdf/plastic.c"
#undef ASP_PRECISION
#include "bsdf/rough_diffuse.c"
#undef ASP_PRECISION
#include "ndf/abc.c"
#undef ASP_PRECISION
#include "ndf/beckmann.c"
#undef ASP_PRECISION
#include "ndf/ggx.c"
#undef ASP_PRECISION
#include "ndf/histogram.c"
#undef ASP_PRECISION
#include "ndf/histogram_make.c"
#undef ASP_PRECISION
#include "ndf/histogram_rows.c"
#undef ASP_PRECISION
#include "ndf/prepared.c"
#undef ASP_PRECISION
#include "ndf/student_forms.c"
#undef ASP_PRECISION
#include "ndf/student_guess.c"
#undef ASP_PRECISION
#include "ndf/student_prepare.c"
#undef ASP_PRECISION
#include "ndf/student_t.c"
#undef ASP_PRECISION
