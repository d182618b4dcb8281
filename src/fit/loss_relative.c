/* loss_relative.c - logarithm of f itself: peak and tail count alike */
#include "fit.h"

#define FLOOR 1e-3    /* 1/sr: 0.3 % of a white diffuser, where instruments end */

static void residual(size_t n, const double *model, const double *data, const double *weight,
                     double *r, double *slope)
{
    (void)weight;
    for (size_t i = 0; i < n; i++)
        r[i] = log((model[i] + FLOOR) / (fmax(data[i], 0) + FLOOR));
    if (slope)
        for (size_t i = 0; i < n; i++)
            slope[i] = 1 / (model[i] + FLOOR);
}

static double weight(double cos_i, double cos_o)
{
    (void)cos_i;
    (void)cos_o;
    return 1;
}

const aspi_loss aspi_loss_relative = {
    { "log_relative", "relative logarithm",
      "root mean square of log((m + 0.001/sr) / (d + 0.001/sr))" },
    2, 0, residual, weight, aspi_loss_count
};
