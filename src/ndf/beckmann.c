/* beckmann.c - Beckmann: a Gaussian distribution of slopes
 *
 * Beckmann, Spizzichino 1963; Walter et al. 2007, eqs. 25-27. The Student-t family at n = infinity,
 * without the logarithm. */
#ifndef ASP_PRECISION
#include "asperity_ndf.h"
#include "ndf/student.h"

#include <math.h>

static asp_status beckmann_prepare(asp_ndf *out, asp_error *err)
{
    (void)err;
    aspi_student_prepare(out, INFINITY);
    return ASP_OK;
}

#define ASP_NDF beckmann
#define STUDENT_GAUSSIAN 1
#define ASP_PRECISION 64
#include "beckmann.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "beckmann.c"
#undef ASP_PRECISION

ASP_RECORD asp_model asp_model_beckmann = {
    "beckmann", NULL, "Beckmann (Gaussian slopes)",
    "Beckmann, Spizzichino 1963; Walter et al. 2007",
    ASP_KEYS_SLOPE, 0.3, 0, 0, NULL, 0, beckmann_prepare, ASP_NDF_OPS(beckmann)
};
#undef STUDENT_GAUSSIAN
#undef ASP_NDF

#else
#include "asperity/elementary.h"
#include "student_kernel.h"
#include "asperity/ndf_loops.h"
#endif
