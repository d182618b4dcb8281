/* prepared_known.h - Student-t densities, whose answers are known, as prepared surfaces
 *
 * shape[0] = 1/n: 1 is GGX, 0 Beckmann. A distribution as src/ndf has them, for test_prepared.c alone. */
#ifndef ASP_PRECISION
#define ASP_NO_CLONES 1    /* one instruction set is enough here */
#include "asperity_ndf.h"
#include "ndf/prepared.h"

#include <math.h>

static void known_log_density(const asp_ndf *k, size_t n, const double *r2, double *out)
{
    double inv = k->shape[0];
    /* times 7: the machinery has to find the mass */
    for (size_t i = 0; i < n; i++)
        out[i] = log(7.0) + (inv > 0 ? -(1 / inv + 1) * log1p(r2[i] * inv) : -r2[i]);
}

static asp_status known_prepare(asp_ndf *out, asp_error *err)
{
    return aspi_prepared_make(out, known_log_density, err);
}

static const asp_param known_params[] = {
    { "tail", 0, 0, 1.9, 1, "1/(gamma - 1)" }
};

#define ASP_NDF known
#define ASP_PRECISION 64
#include "prepared_known.h"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "prepared_known.h"
#undef ASP_PRECISION

static const asp_model model_known = {
    "known", NULL, "Student-t, prepared", "", ASP_KEYS_SLOPE, 1, 0, 1e-6, known_params, 1, known_prepare,
    ASP_NDF_OPS(known)
};
#undef ASP_NDF

#else
#include "asperity/elementary.h"

ASP_FN asp_real ndf_density(const asp_shape *k, asp_real r2, asp_real z2)
{
    asp_real inv = k->shape[0], x = r2 / z2;
    asp_real exponent = inv > R(0.0) ? (R(1.0) / inv + R(1.0)) * aspi_log1p(x * inv) : x;
    return aspi_exp(-exponent) * R(1.0 / ASP_PI) / (z2 * z2);
}

#include "ndf/prepared_kernel.h"
#include "asperity/ndf_loops.h"
#endif
