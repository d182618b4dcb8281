/* student_t.c - Student's t-distribution of slopes (STD)
 *
 * Ribardiere, Bringier, Meneveaux, Simonot 2017. gamma = 2 is GGX, gamma -> infinity Beckmann,
 * gamma = n/2 + 2 Phong. Masking is exact for every real gamma > 3/2, not the paper's fit. */
#ifndef ASP_PRECISION
#include "asperity_ndf.h"
#include "ndf/student.h"

#include <math.h>

static asp_status student_t_prepare(asp_ndf *out, asp_error *err)
{
    (void)err;
    aspi_student_prepare(out, out->shape[0] - 1);
    return ASP_OK;
}

static const asp_param student_t_params[] = {
    { "gamma", 1.5, 1, INFINITY, 2.0, "tails: 1.5 heaviest, 2 GGX, inf Beckmann" }
};

#define ASP_NDF student_t
#define STUDENT_GAUSSIAN 0
#define ASP_PRECISION 64
#include "student_t.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "student_t.c"
#undef ASP_PRECISION

ASP_RECORD asp_model asp_model_student_t = {
    "student_t", "std", "Student's t-distribution of slopes (STD)",
    "Ribardiere, Bringier, Meneveaux, Simonot 2017",
    ASP_KEYS_SLOPE, 0.3, 0, 0, student_t_params, 1, student_t_prepare, ASP_NDF_OPS(student_t)
};
#undef STUDENT_GAUSSIAN
#undef ASP_NDF

#else
#include "asperity/elementary.h"
#include "student_kernel.h"
#include "asperity/ndf_loops.h"
#endif
