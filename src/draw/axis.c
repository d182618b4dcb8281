/* axis.c - limits and ticks: 1, 2, 5 times a power of ten; whole angles in degrees; decades */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "draw/plot.h"

#define MINUS "\xe2\x88\x92"            /* U+2212 */
#define TIMES "\xc3\x97"                /* U+00D7 */

int aspi_on_axis(int logarithmic, double value)
{
    if (!(fabs(value) <= ASPI_AXIS_MAX))
        return 0;
    return !logarithmic || value >= ASPI_AXIS_MIN;
}

static double forward(int logarithmic, double value)
{
    return logarithmic ? log10(value) : value;
}

double aspi_axis_px(const aspi_axis *axis, double value)
{
    double low = forward(axis->logarithmic, axis->low), high = forward(axis->logarithmic, axis->high);
    double t = (forward(axis->logarithmic, value) - low) / (high - low);
    double px = axis->from + t * (axis->to - axis->from);
    return px < -1e9 ? -1e9 : px > 1e9 ? 1e9 : px;      /* far outside; keeps the clipping exact */
}

static int is_set(const asp_axis *axis)
{
    return axis->low != 0 || axis->high != 0;
}

asp_status aspi_axis_check(const asp_axis *axis, const char *name, asp_error *err)
{
    char which[64];
    if ((unsigned)axis->scale > ASP_SCALE_LOG) {
        snprintf(which, sizeof which, "%s.scale", name);
        return asp_fail_range(err, which, axis->scale, 0, 0, ASP_SCALE_LOG);
    }
    int logarithmic = axis->scale == ASP_SCALE_LOG;
    if (is_set(axis)) {
        double least = logarithmic ? ASPI_AXIS_MIN : -ASPI_AXIS_MAX;
        snprintf(which, sizeof which, "%s.low", name);
        if (!(axis->low >= least && axis->low <= ASPI_AXIS_MAX))
            return asp_fail_range(err, which, axis->low, least, 0, ASPI_AXIS_MAX);
        snprintf(which, sizeof which, "%s.high", name);
        /* closer together than this the ticks could not be told apart in float64 */
        double apart = axis->low + fmax(1e-9 * fabs(axis->low), 1e-290);
        if (!(axis->high > apart && axis->high <= ASPI_AXIS_MAX))
            return asp_fail_range(err, which, axis->high, apart, 1, ASPI_AXIS_MAX);
    }
    if (!(axis->step >= 0 && axis->step <= ASPI_AXIS_MAX)) {
        snprintf(which, sizeof which, "%s.step", name);
        return asp_fail_range(err, which, axis->step, 0, 0, ASPI_AXIS_MAX);
    }
    if (!(axis->decades >= 0 && axis->decades <= 600)) {
        snprintf(which, sizeof which, "%s.decades", name);
        return asp_fail_range(err, which, axis->decades, 0, 0, 600);
    }
    return ASP_OK;
}

/* ------------------------------------------------------------------ linear */

static double round_step(double least)
{
    double unit = pow(10, floor(log10(least))), m = least / unit;
    return (m <= 1 + 1e-9 ? 1 : m <= 2 + 1e-9 ? 2 : m <= 5 + 1e-9 ? 5 : 10) * unit;
}

/* Angles: 15, 30, 45, 90 rather than 20 and 50. */
static double angle_step(double least)
{
    static const double steps[] = { 1, 2, 5, 10, 15, 30, 45, 90, 180 };
    for (size_t i = 0; least > 0.5 && i < sizeof steps / sizeof *steps; i++)
        if (steps[i] >= least * (1 - 1e-9))
            return steps[i];
    return round_step(least);
}

static int in_degrees(const char *label)
{
    return label && (strstr(label, "[deg]") || strstr(label, "\xc2\xb0"));
}

/* "0.30", "-2", with a real minus sign. */
static void number_label(char *label, size_t size, double value, int decimals)
{
    aspi_text text = { 0 };
    aspi_text_number(&text, value, decimals, MINUS);
    snprintf(label, size, "%s", text.failed || !text.bytes ? "" : text.bytes);
    aspi_text_free(&text);
}

static void linear_ticks(aspi_axis *out, double step)
{
    double largest = fmax(fabs(out->low), fabs(out->high));
    int exponent = (int)floor(log10(largest) + 1e-9);
    out->exponent = exponent >= 5 || exponent <= -4 ? exponent : 0;
    double scale = pow(10, -out->exponent);
    int decimals = (int)-floor(log10(step * scale) + 1e-9);
    double digit = step * scale * pow(10, decimals);
    if (decimals >= 0 && fabs(digit - rint(digit)) > 1e-6)       /* 0.25, 2.5 */
        decimals++;
    decimals = decimals < 0 ? 0 : decimals > 12 ? 12 : decimals;
    double first = ceil(out->low / step - 1e-6), last = floor(out->high / step + 1e-6);
    for (double i = first; i <= last && out->tick_count < ASPI_TICKS; i++) {
        aspi_tick *tick = &out->ticks[out->tick_count++];
        tick->value = i * step;
        tick->major = 1;
        number_label(tick->label, sizeof tick->label, i * step * scale, decimals);
    }
}

static void set_linear(aspi_axis *out, const asp_axis *axis, int round, double length, double spacing)
{
    double least = (out->high - out->low) * spacing / length;
    double step = in_degrees(axis->label) ? angle_step(least) : round_step(least);
    if (axis->step > 0 && (out->high - out->low) / axis->step < ASPI_TICKS)
        step = axis->step;
    if (round && !is_set(axis)) {
        if (out->low > 0 && out->low < 0.4 * out->high)
            out->low = 0;
        out->low = step * floor(out->low / step + 1e-6);
        out->high = step * ceil(out->high / step - 1e-6);
    } else if (!is_set(axis)) {             /* 0.5 to 89.5 degrees reads better as 0 to 90 */
        double near = 0.02 * (out->high - out->low);
        double low = step * floor(out->low / step + 1e-6), high = step * ceil(out->high / step - 1e-6);
        out->low = out->low - low <= near ? low : out->low;
        out->high = high - out->high <= near ? high : out->high;
    }
    linear_ticks(out, step);
}

/* ------------------------------------------------------------------ logarithmic */

/* The largest of m * 10^n <= value (up: smallest >= value) with m = 1, 2, 5. */
static double round_value(double value, int up)
{
    double unit = pow(10, floor(log10(value)));
    static const double m[] = { 0.5, 1, 2, 5, 10, 20 };
    if (up) {
        for (size_t i = 0; i < 6; i++)
            if (m[i] * unit >= value * (1 - 1e-9))
                return m[i] * unit;
    } else {
        for (size_t i = 6; i-- > 0;)
            if (m[i] * unit <= value * (1 + 1e-9))
                return m[i] * unit;
    }
    return value;
}

static void power_label(char *label, size_t size, int m, int n, int plain)
{
    const char *sign = n < 0 ? MINUS : "";
    int magnitude = n < 0 ? -n : n;
    if (plain && magnitude <= 3)
        number_label(label, size, m * pow(10, n), n < 0 ? magnitude : 0);
    else if (m == 1)
        snprintf(label, size, "10^{%s%d}", sign, magnitude);
    else
        snprintf(label, size, "%d" TIMES "10^{%s%d}", m, sign, magnitude);
}

/* Decades; below two decades also 2 and 5 are labelled, and minor ticks go where there is room. */
static void log_ticks(aspi_axis *out, double length, double spacing)
{
    double low = log10(out->low), high = log10(out->high), decade = length / (high - low);
    int every = (int)ceil(spacing / decade - 1e-9);
    int between = decade > 3.2 * spacing, minor = decade > 24;
    every = every < 1 ? 1 : every;
    for (int n = (int)floor(low); n <= (int)floor(high) + 1; n++)
        for (int m = 1; m < 10; m++) {
            double value = m * pow(10, n);
            int major = (m == 1 && n % every == 0) || (between && (m == 2 || m == 5));
            if ((!major && m > 1 && !minor) || value < out->low * (1 - 1e-9)
                || value > out->high * (1 + 1e-9) || out->tick_count >= ASPI_TICKS)
                continue;
            aspi_tick *tick = &out->ticks[out->tick_count++];
            *tick = (aspi_tick){ .value = value, .major = major };
            if (major)
                power_label(tick->label, sizeof tick->label, m, n, between);
        }
}

static void set_log(aspi_axis *out, const asp_axis *axis, int round, double length, double spacing)
{
    if (round && !is_set(axis)) {
        out->low = round_value(out->low, 0);
        out->high = round_value(out->high, 1);
    }
    log_ticks(out, length, spacing);
    int majors = 0;
    for (int i = 0; i < out->tick_count; i++)
        majors += out->ticks[i].major;
    if (majors < 2 && out->high / out->low < 1e3) {  /* a third of a decade: ticks as if linear */
        out->tick_count = 0;
        linear_ticks(out, round_step((out->high - out->low) * spacing / length));
    }
}

/* ------------------------------------------------------------------ both */

static void limits_from_data(aspi_axis *out, const asp_axis *axis, double low, double high)
{
    if (low > high)
        low = high = 1;
    if (out->logarithmic) {
        double decades = axis->decades > 0 ? axis->decades : 8;
        low = fmax(low, fmax(high * pow(10, -decades), ASPI_AXIS_MIN));
        if (high <= low * (1 + 1e-9)) {
            low /= 2;
            high *= 2;
        }
    } else if (high - low <= fmax(1e-9 * fmax(fabs(low), fabs(high)), 1e-290)) {
        double half = fabs(high) > 1e-280 ? 0.5 * fabs(high) : 0.5;
        low -= half;
        high += half;
    }
    out->low = low;
    out->high = high;
}

void aspi_axis_set(aspi_axis *out, const asp_axis *axis, double low, double high, int round,
                   double length, double spacing)
{
    memset(out, 0, sizeof *out);
    out->logarithmic = axis->scale == ASP_SCALE_LOG;
    if (is_set(axis)) {
        out->low = axis->low;
        out->high = axis->high;
    } else {
        limits_from_data(out, axis, low, high);
    }
    (out->logarithmic ? set_log : set_linear)(out, axis, round, length, spacing);
}
