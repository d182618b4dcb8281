/* abc.c - the ABC distribution, D proportional to (1 + alpha (1 - cos theta))^-gamma
 *
 * Low, Kronander, Ynnerman, Unger 2012, as in Hoffman 2013 (notebook, ABC NDF). alpha is its roughness
 * and gamma its shape; gamma = 0 is the uniform distribution, GGX with alpha = 1. */
#ifndef ASP_PRECISION
#include "asperity_ndf.h"
#include "ndf/prepared.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"

enum { ABC_ALPHA, ABC_GAMMA };

/* ((1 + alpha)^x - 1)/x, l = log(1 + alpha). */
static double abc_power(double x, double l)
{
    return x == 0 ? l : aspi_expm1_64(x * l) / x;
}

/* Integral of (1 + alpha (1 - cos))^-gamma cos over the hemisphere, the notebook's Out[38] without its
 * cancellation: a series, or two forms that divide by gamma - 1 and by alpha. */
static double abc_mass(double alpha, double gamma)
{
    double l = aspi_log1p_64(alpha);
    if (alpha * aspi_max_64(1, gamma) < 0.5) {
        double term = 1, sum = 0;
        int k;
        for (k = 0; k < 60; k++) {
            sum += term / ((k + 1.0) * (k + 2.0));
            term *= -alpha * (gamma + k) / (k + 1.0);
        }
        return 2 * ASP_PI * sum;
    }
    if (gamma >= 1.5)
        return 2 * ASP_PI * (1 - abc_power(2 - gamma, l) / alpha) / (alpha * (gamma - 1));
    return 2 * ASP_PI * ((1 + alpha) * abc_power(1 - gamma, l) - abc_power(2 - gamma, l)) / (alpha * alpha);
}

/* 1 - cos = r^2/(h (h + 1)), h = sqrt(1 + r^2); P22 = D cos^4. */
ASP_CLONES static void abc_log_density(const asp_ndf *k, size_t n, const double *ASP_RESTRICT r2,
                                       double *ASP_RESTRICT out)
{
    const double alpha = k->shape[ABC_ALPHA], gamma = k->shape[ABC_GAMMA], most = k->table[0];
    size_t i;
    for (i = 0; i < n; i++) {
        double h = sqrt(1 + r2[i]);
        out[i] = most - gamma * aspi_log1p_64(alpha * (r2[i] / (h * (h + 1)))) - 4 * aspi_log_64(h);
    }
}

static asp_status abc_prepare(asp_ndf *out, asp_error *err)
{
    out->table[1] = 1 / abc_mass(out->shape[ABC_ALPHA], out->shape[ABC_GAMMA]);
    out->table[0] = aspi_log_64(out->table[1]);
    return aspi_prepared_make(out, abc_log_density, err);
}

static const asp_param abc_params[] = {
    { "alpha", 1e-4, 0, 1e6, 20, "sharpness: 0 is uniform, 1/alpha the squared width" },
    { "gamma", 0, 0, 1000, 1.75, "tails: 0.5 heavy, 1.75 like GGX, large like exp(-k (1 - cos))" }
};
#undef ASP_PRECISION

#define ASP_NDF abc
#define ASP_PRECISION 64
#include "abc.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "abc.c"
#undef ASP_PRECISION

ASP_RECORD asp_model asp_model_abc = {
    "abc", NULL, "ABC distribution", "Low, Kronander, Ynnerman, Unger 2012; Hoffman 2013",
    ASP_KEYS_SLOPE, 1, 1, 3e-7, abc_params, 2, abc_prepare, ASP_NDF_OPS(abc)
};
#undef ASP_NDF

#else
#include "asperity/elementary.h"

/* P22(r2/z2)/z2^2 = D/(r2 + z2)^2. */
ASP_FN asp_real ndf_density(const asp_shape *k, asp_real r2, asp_real z2)
{
    asp_real h2 = r2 + z2, z = aspi_sqrt(z2), h = aspi_sqrt(h2);
    asp_real x = r2 / (h2 + h * z);                 /* 1 - cos */
    asp_real d = aspi_exp(R(-0.5) * (k->shape[1] * aspi_log1p(k->shape[0] * x)));
    return d * k->table[1] * d / (h2 * h2);           /* its square alone may underflow where D does not */
}

#include "prepared_kernel.h"
#include "asperity/ndf_loops.h"
#endif
