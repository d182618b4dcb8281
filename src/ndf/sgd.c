/* sgd.c - the Shifted Gamma Distribution of squared slopes
 *
 * Bagher, Soler, Holzschuch 2012, whose p is gamma here; Hoffman's notebook, 2013, Out[57].
 * gamma = 0 is Beckmann with roughness sqrt(alpha). */
#ifndef ASP_PRECISION
#include "asperity_ndf.h"
#include "ndf/prepared.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"
#undef ASP_PRECISION

/* e^a E_p(a) = integral of e^-(a s) (1 + s)^-p over s > 0, by the trapezoidal rule in log s: the
 * integrand is analytic for |Im log s| < pi/2, so that the rule's error is e^-39. */
static double sgd_integral(double a, double p)
{
    const double h = 0.25;
    double end = 4 - aspi_log_64(a), sum = 0;
    int i, last = (int)(end / h);
    for (i = -160; i <= last; i++) {
        double s = aspi_exp_64(h * i);
        sum += s * aspi_exp_64(-(a * s + p * aspi_log1p_64(s)));
    }
    return sum * h;
}

static const asp_param sgd_params[] = {
    { "alpha", 1e-4, 0, 4, 0.1, "about the squared slope" },
    { "gamma", 0, 0, 4, 0.5, "a sharper peak: 0 Beckmann, Bagher's fits up to 1.8" }
};

#define ASP_NDF sgd
#define ASP_PRECISION 64
#include "sgd.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "sgd.c"
#undef ASP_PRECISION

ASP_CLONES static void sgd_log_density(const asp_ndf *k, size_t n, const double *ASP_RESTRICT r2,
                                       double *ASP_RESTRICT out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = -sgd_exponent_64(k, r2[i], 1);
}

static asp_status sgd_prepare(asp_ndf *out, asp_error *err)
{
    double alpha = out->shape[0], gamma = out->shape[1];
    out->table[0] = 1 / alpha;
    out->table[1] = 1 / (alpha * alpha);
    out->table[2] = 1 / (ASP_PI * (alpha * alpha) * sgd_integral(alpha, gamma));
    return aspi_prepared_make(out, sgd_log_density, err);
}

ASP_RECORD asp_model asp_model_sgd = {
    "sgd", NULL, "Shifted Gamma Distribution (SGD)",
    "Bagher, Soler, Holzschuch 2012; Hoffman 2013, Out[57]",
    ASP_KEYS_SLOPE, 1, 1, 3e-7, sgd_params, 2, sgd_prepare, ASP_NDF_OPS(sgd)
};
#undef ASP_NDF

#else
#include "asperity/elementary.h"

#define exponent ASP_NDF_NAME(_exponent)

/* pi P22 = e^(-x/alpha) (1 + x/alpha^2)^-gamma / (alpha^2 e^alpha E_gamma(alpha)), x = r2/z2. */
ASP_FN asp_real exponent(const asp_shape *k, asp_real r2, asp_real z2)
{
    asp_real x = r2 / z2;
    /* far beyond where the exponential is 0 */
    asp_real shifted = aspi_min(x * k->table[1], ASP_PRECISION == 64 ? R(1e150) : R(1e18));
    return x * k->table[0] + k->shape[1] * aspi_log1p(shifted);
}

ASP_FN asp_real ndf_density(const asp_shape *k, asp_real r2, asp_real z2)
{
    return k->table[2] * aspi_exp(-exponent(k, r2, z2)) / (z2 * z2);
}
#undef exponent

#include "prepared_kernel.h"
#include "asperity/ndf_loops.h"
#endif
