/* loss_nad.c - normalised absolute difference
 *
 * Ribardiere, Bringier, Meneveaux, Simonot 2017, section 5 ("normalized absolute distance between
 * data and the model"); the paper leaves weights open. With w = cos(theta_i) cos(theta_o), f w is
 * the power exchanged between two patches of the sky, and grazing angles do not rule the sum. */
#include "fit.h"

static void residual(size_t n, const double *model, const double *data, const double *weight,
                     double *r, double *slope)
{
    for (size_t i = 0; i < n; i++)
        r[i] = weight[i] * (model[i] - data[i]);
    if (slope)
        for (size_t i = 0; i < n; i++)
            slope[i] = weight[i];
}

static double weight(double cos_i, double cos_o)
{
    return cos_i * cos_o;
}

static double scale(size_t n, const double *data, const double *w)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += w[i] * fabs(data[i]);
    return sum;
}

const aspi_loss aspi_loss_nad = {
    { "nad", "normalised absolute difference",
      "sum w |m - d| / sum w d, w = cos(theta_i) cos(theta_o)" },
    1, 1, residual, weight, scale
};
