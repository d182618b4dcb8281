/* student_t.c - Student's t-distribution of slopes (STD), and who else it is
 *
 * Ribardiere, Bringier, Meneveaux, Simonot 2017. gamma = 2 is GGX, gamma -> infinity Beckmann. Masking
 * is exact for every real gamma > 3/2, not the paper's fit. Phong, hyper-Cauchy and the paper's general
 * family have the same standard surface under other numbers: they are records of their own below. */
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

/* (n + 2)/(2 pi) cos^n of density (Phong normalised over the projected hemisphere) has slopes of
 * density proportional to (1 + r^2)^(-n/2 - 2): Student's t with gamma = n/2 + 2 and (gamma - 1) sigma^2
 * = 1. Its facets' area is finite for gamma > 3/2, n > -1. */
static asp_status phong_prepare(asp_ndf *out, asp_error *err)
{
    double n = 0.5 * out->shape[0] + 1;
    (void)err;
    aspi_student_prepare(out, n);
    asp_ndf_stretch(out, 1 / sqrt(n));
    return ASP_OK;
}

static const asp_param phong_params[] = {
    { "exponent", -0.99, 0, 1e6, 20, "of the cosine; 0 is uniform, 2/alpha^2 - 2 as rough as Beckmann's alpha" }
};

/* Eq. 9 with B = 1/sigma^2, C = gamma: (1 + r^2/sigma^2)^-gamma, sigma the map's roughness. */
static asp_status hyper_cauchy_prepare(asp_ndf *out, asp_error *err)
{
    double n = out->shape[0] - 1;
    (void)err;
    aspi_student_prepare(out, n);
    asp_ndf_stretch(out, 1 / sqrt(n));
    return ASP_OK;
}

static const asp_param hyper_cauchy_params[] = {
    { "gamma", 1.5, 1, 1000, 2.0, "1.5 heaviest tails, 2 GGX; larger is also smoother" }
};

/* Eqs. 9 and 10: (C - 1) B / (pi (1 + B r^2)^C). The paper asks for C > 1, which makes a density; sigma
 * is finite for C > 3/2. */
static asp_status student_t_general_prepare(asp_ndf *out, asp_error *err)
{
    double n = out->shape[1] - 1;
    (void)err;
    aspi_student_prepare(out, n);
    asp_ndf_stretch(out, 1 / sqrt(n * out->shape[0]));
    return ASP_OK;
}

static const asp_param student_t_general_params[] = {
    { "B", 0.01, 0, 1e4, 10.0, "1/sigma^2; Beckmann for B C = 1/sigma^2, C large" },
    { "C", 1.5, 1, 1e4, 2.0, "2 GGX; a finite area of facets needs C > 1.5" }
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

ASP_RECORD asp_model asp_model_phong = {
    "phong", NULL, "Phong (a power of the cosine)",
    "Phong 1975; normalised as by Hoffman 2013; Student's t with gamma = exponent/2 + 2",
    ASP_KEYS_SLOPE, 1.0, 1, 0, phong_params, 1, phong_prepare, ASP_NDF_OPS(student_t)
};

ASP_RECORD asp_model asp_model_hyper_cauchy = {
    "hyper_cauchy", NULL, "Hyper-Cauchy: Student's t scaled by sigma alone",
    "Wellems et al. 2006; Butler, Marciniak 2014; STD paper, eq. 9 with B = 1/sigma^2, C = gamma",
    ASP_KEYS_SLOPE, 0.3, 0, 0, hyper_cauchy_params, 1, hyper_cauchy_prepare, ASP_NDF_OPS(student_t)
};

ASP_RECORD asp_model asp_model_student_t_general = {
    "student_t_general", NULL, "Student's t by its two factors B and C",
    "Ribardiere, Bringier, Meneveaux, Simonot 2017, eqs. 9-10",
    ASP_KEYS_SLOPE, 1.0, 1, 0, student_t_general_params, 2, student_t_general_prepare,
    ASP_NDF_OPS(student_t)
};
#undef STUDENT_GAUSSIAN
#undef ASP_NDF

#else
#include "asperity/elementary.h"
#include "student_kernel.h"
#include "asperity/ndf_loops.h"
#endif
