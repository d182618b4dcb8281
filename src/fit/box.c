/* box.c - the parameters of a search as numbers in [0, 1]
 *
 * Optimisers see b; each axis has the scale on which lobes change evenly: logarithmic for roughness,
 * 1/eta for the index, s/(s + v - low) for a shape number whose range ends at infinity, so that
 * infinity is the ordinary place b = 0 (for gamma of student_t this is a multiple of 1/gamma + ...,
 * in which the density is analytic through the Beckmann limit). A range that ends far beyond its
 * default is treated alike, up to its end. */
#include "fit.h"

#define ALPHA_LOW 1e-3
#define ALPHA_HIGH 4.0
#define ETA_LOW 1.05
#define ETA_HIGH 100.0
#define OPEN 1e-4           /* how near the search comes to an end that is itself refused */
#define FAR 20              /* times the default above the low end: a long range */

static aspi_axis shape_axis(const asp_param *param)
{
    aspi_axis axis = { param->name, ASPI_SCALE_LINEAR, param->low, param->high, 0, 0, 1 };
    double turn = param->initial > param->low ? param->initial - param->low : 1;
    if (param->low > 0 && isfinite(param->high) && param->high > 10 * param->low)
        axis.scale = ASPI_SCALE_LOG;
    else if (param->high - param->low > FAR * turn) {
        axis.scale = ASPI_SCALE_INVERSE;
        axis.turn = turn;
        axis.b_low = isinf(param->high) ? 0 : turn / (turn + param->high - param->low);
        if (param->low_open)
            axis.b_high = 1 - OPEN;
        return axis;
    }
    if (param->low_open)
        axis.b_low = OPEN;
    return axis;
}

aspi_box aspi_box_make(const asp_model *model)
{
    aspi_box box = { 0 };
    if (!model->own_scale)
        box.axis[box.n++] = (aspi_axis){ "alpha", ASPI_SCALE_LOG, ALPHA_LOW, ALPHA_HIGH, 0, 0, 1 };
    box.shape = box.n;
    for (size_t i = 0; i < model->param_count; i++)
        box.axis[box.n++] = shape_axis(&model->params[i]);
    box.axis[box.n++] = (aspi_axis){ "eta", ASPI_SCALE_INVERSE, ETA_LOW, ETA_HIGH, 1, 0, 1 };
    aspi_axis *eta = &box.axis[box.n - 1];
    eta->b_low = eta->turn / (eta->turn + ETA_HIGH - ETA_LOW);
    return box;
}

double aspi_axis_value(const aspi_axis *axis, double b)
{
    switch (axis->scale) {
    case ASPI_SCALE_LOG:
        return b <= 0 ? axis->low : b >= 1 ? axis->high
             : axis->low * exp(b * log(axis->high / axis->low));
    case ASPI_SCALE_INVERSE:
        if (b <= axis->b_low)
            return axis->high;
        return b >= 1 ? axis->low : axis->low + axis->turn * (1 - b) / b;
    case ASPI_SCALE_LINEAR:
        break;
    }
    return b >= 1 ? axis->high : axis->low + b * (axis->high - axis->low);
}

double aspi_axis_place(const aspi_axis *axis, double value)
{
    double b = 0;
    switch (axis->scale) {
    case ASPI_SCALE_LOG:
        b = value > 0 ? log(value / axis->low) / log(axis->high / axis->low) : 0;
        break;
    case ASPI_SCALE_INVERSE:
        b = isinf(value) ? 0 : axis->turn / (axis->turn + fmax(0, value - axis->low));
        break;
    case ASPI_SCALE_LINEAR:
        b = (value - axis->low) / (axis->high - axis->low);
        break;
    }
    return fmin(fmax(b, axis->b_low), axis->b_high);
}
