/* loss_log.c - cosine-weighted logarithm
 *
 * Low, Kronander, Ynnerman, Unger 2012, error E2: log(1 + f cos(theta_i)), which compresses the peak
 * without giving the dark parts, where instruments are noisy, the same relative weight. */
#include "fit.h"

static void residual(size_t n, const double *model, const double *data, const double *weight,
                     double *r, double *slope)
{
    /* a measured value can be slightly negative: noise about zero */
    for (size_t i = 0; i < n; i++)
        r[i] = log1p(weight[i] * model[i]) - log1p(weight[i] * fmax(data[i], 0));
    if (slope)
        for (size_t i = 0; i < n; i++)
            slope[i] = weight[i] / (1 + weight[i] * model[i]);
}

static double weight(double cos_i, double cos_o)
{
    (void)cos_o;
    return cos_i;
}

const aspi_loss aspi_loss_log = {
    { "log", "cosine-weighted logarithm",
      "root mean square of log((1 + m cos(theta_i)) / (1 + d cos(theta_i)))" },
    2, 0, residual, weight, aspi_loss_count
};
