/* torrance_sparrow.c - the Torrance-Sparrow distribution: a Gaussian in the facets' angle
 *
 * Torrance, Sparrow 1967; normalised in Hoffman's notebook to 'Background: Physics and Math of
 * Shading', 2013, Out[25], whose closed form overflows: here the integral is summed. */
#ifndef ASP_PRECISION
#include "asperity_ndf.h"
#include "ndf/prepared.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"
#undef ASP_PRECISION

/* Integral of e^-(theta/alpha)^2 sin(2 theta) over theta from 0 to pi/2, or to where e^-42 is left.
 * With theta = L / (1 + e^(-pi sinh t)) both ends fall off doubly exponentially (Takahasi, Mori
 * 1974) and the trapezoidal rule is exact to rounding. */
static double torrance_sparrow_integral(double alpha)
{
    const double h = 0.0625, end = 6.5 * alpha < 0.5 * ASP_PI ? 6.5 * alpha : 0.5 * ASP_PI;
    double sum = 0;
    int i;
    for (i = -54; i <= 54; i++) {
        double e = aspi_exp_64(h * i), w = aspi_exp_64(-0.5 * ASP_PI * (e - 1 / e));
        double theta = end / (1 + w), x = theta / alpha;
        double slope = theta * (w / (1 + w)) * (0.5 * ASP_PI * (e + 1 / e));
        sum += aspi_exp_64(-x * x) * aspi_sincos2pi_64(theta / ASP_PI).y * slope;
    }
    return sum * h;
}

static const asp_param torrance_sparrow_params[] = {
    { "alpha", 1e-3, 0, 100, 0.3, "1/e angle of the facets, in radians" }
};

#define ASP_NDF torrance_sparrow
#define ASP_PRECISION 64
#include "torrance_sparrow.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "torrance_sparrow.c"
#undef ASP_PRECISION

/* P22 = D cos^4. */
ASP_CLONES static void torrance_sparrow_log_density(const asp_ndf *k, size_t n, const double *ASP_RESTRICT r2,
                                                    double *ASP_RESTRICT out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = -torrance_sparrow_exponent_64(k, r2[i], 1) - 2 * aspi_log1p_64(r2[i]);
}

static asp_status torrance_sparrow_prepare(asp_ndf *out, asp_error *err)
{
    double alpha = out->shape[0];
    out->table[0] = 1 / (alpha * alpha);
    out->table[1] = 1 / (ASP_PI * torrance_sparrow_integral(alpha));
    return aspi_prepared_make(out, torrance_sparrow_log_density, err);
}

ASP_RECORD asp_model asp_model_torrance_sparrow = {
    "torrance_sparrow", NULL, "Torrance-Sparrow: a Gaussian in the angle",
    "Torrance, Sparrow 1967; Hoffman 2013, Out[25]",
    ASP_KEYS_SLOPE, 1, 1, 3e-7, torrance_sparrow_params, 1,
    torrance_sparrow_prepare, ASP_NDF_OPS(torrance_sparrow)
};
#undef ASP_NDF

#else
#include "asperity/elementary.h"

#define exponent ASP_NDF_NAME(_exponent)

/* D = e^-(theta/alpha)^2 / N (Hoffman 2013, In[24]). */
ASP_FN asp_real exponent(const asp_shape *k, asp_real r2, asp_real z2)
{
    asp_real theta = aspi_angle(aspi_sqrt(r2), aspi_sqrt(z2));
    return theta * theta * k->table[0];
}

ASP_FN asp_real ndf_density(const asp_shape *k, asp_real r2, asp_real z2)
{
    asp_real h = r2 + z2;
    return k->table[1] * aspi_exp(-exponent(k, r2, z2)) / (h * h);
}
#undef exponent

#include "prepared_kernel.h"
#include "asperity/ndf_loops.h"
#endif
