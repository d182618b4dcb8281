/* polar.c - lobes in the plane of incidence, as SVG */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw/plot.h"

#define PI 3.14159265358979323846

typedef struct disc {
    double    x, y, radius;           /* centre of the half disc and its radius, px */
    aspi_axis axis;                   /* from 0 to radius px */
} disc;

static aspi_point at(const disc *d, double angle, double r)
{
    return (aspi_point){ d->x + r * sin(angle), d->y - r * cos(angle) };
}

/* NaN for a gap. On a logarithmic axis what is below the centre's value lies in the centre. */
static double radius_px(const disc *d, double v)
{
    if (!aspi_on_axis(d->axis.logarithmic, v) || v < 0)
        return NAN;
    return fmax(0, aspi_axis_px(&d->axis, v));
}

static void draw_grid(aspi_text *text, const disc *d)
{
    aspi_text_put(text, "<path fill=\"none\" stroke=\"#dcdcdc\" stroke-width=\"0.7\" d=\"");
    for (int i = 0; i < d->axis.tick_count; i++) {
        double r = radius_px(d, d->axis.ticks[i].value);
        if (d->axis.ticks[i].major && r > 0.5 && r < d->radius - 0.5)
            aspi_text_put(text, "M%n %nA%n %n 0 0 1 %n %n", d->x - r, d->y, r, r, d->x + r, d->y);
    }
    for (int degrees = -75; degrees <= 75; degrees += 15) {
        aspi_point edge = at(d, degrees * PI / 180, d->radius);
        aspi_text_put(text, "M%n %nL%n %n", d->x, d->y, edge.x, edge.y);
    }
    aspi_text_put(text, "\"/>\n<path fill=\"none\" stroke=\"#444444\" stroke-width=\"0.9\" "
                  "d=\"M%n %nA%n %n 0 0 1 %n %nz\"/>\n", d->x - d->radius, d->y, d->radius, d->radius,
                  d->x + d->radius, d->y);
}

static void angle_label(aspi_text *text, const disc *d, double degrees, const char *attributes)
{
    char label[32];
    aspi_text number = { 0 };
    aspi_text_number(&number, degrees, fabs(degrees - rint(degrees)) < 0.05 ? 0 : 1, "\xe2\x88\x92");
    snprintf(label, sizeof label, "%s\xc2\xb0", number.bytes && !number.failed ? number.bytes : "");
    aspi_text_free(&number);
    aspi_point p = at(d, degrees * PI / 180, d->radius + 9);
    aspi_anchor anchor = fabs(degrees) < 10 ? ASPI_MIDDLE : degrees < 0 ? ASPI_END : ASPI_START;
    aspi_text_label(text, label, p.x, p.y + 3.5, 11, anchor, 0, attributes);
}

static void draw_labels(aspi_text *text, const asp_polar *polar, const disc *d)
{
    for (int degrees = -90; degrees <= 90; degrees += 30)
        angle_label(text, d, degrees, NULL);
    double last = -1e9;
    for (int i = 0; i < d->axis.tick_count; i++) {
        const aspi_tick *tick = &d->axis.ticks[i];
        double r = radius_px(d, tick->value), half = 0.5 * aspi_label_width(tick->label, 10.5);
        if (!*tick->label || r - half < last + 5)
            continue;
        last = r + half;
        aspi_text_label(text, tick->label, d->x + r, d->y + 14, 10.5, ASPI_MIDDLE, 0, NULL);
        if (r > half + 8)             /* the same on the left, but one centre */
            aspi_text_label(text, tick->label, d->x - r, d->y + 14, 10.5, ASPI_MIDDLE, 0, NULL);
    }
    char label[300] = "";
    if (polar->radius.label)
        snprintf(label, sizeof label, "%s", polar->radius.label);
    if (d->axis.exponent) {
        size_t used = strlen(label);
        snprintf(label + used, sizeof label - used, " \xc3\x97" "10^{%s%d}",
                 d->axis.exponent < 0 ? "\xe2\x88\x92" : "", abs(d->axis.exponent));
    }
    if (*label)
        aspi_text_label(text, label, d->x, d->y + 33, 12.5, ASPI_MIDDLE, 0, NULL);
    if (polar->title)
        aspi_text_label(text, polar->title, d->x, 21, 14, ASPI_MIDDLE, 0, " font-weight=\"bold\"");
}

/* An arrow to the centre, its head two thirds of the way out where lobes rarely are. */
static void draw_incidence(aspi_text *text, const disc *d, double theta)
{
    if (!(theta >= 0 && theta <= PI / 2))
        return;
    aspi_point tail = at(d, -theta, d->radius), head = at(d, -theta, 0.62 * d->radius);
    double ux = sin(theta), uy = cos(theta);       /* towards the centre, y down */
    aspi_text_put(text, "<path fill=\"none\" stroke=\"#777777\" stroke-width=\"1.2\" d=\"M%n %nL%n %n\"/>\n"
                  "<path fill=\"#777777\" d=\"M%n %nL%n %nL%n %nz\"/>\n", tail.x, tail.y, d->x, d->y,
                  head.x + 5 * ux, head.y + 5 * uy, head.x - 5 * ux - 4 * uy, head.y - 5 * uy + 4 * ux,
                  head.x - 5 * ux + 4 * uy, head.y - 5 * uy - 4 * ux);
    double degrees = -theta * 180 / PI, off = fabs(degrees - 30 * rint(degrees / 30));
    if (off > 4)
        angle_label(text, d, degrees, " fill=\"#777777\"");
}

/* The part of a segment inside the disc, as t0 <= t <= t1; 0 when there is none. */
static int clip_disc(const disc *d, aspi_point a, aspi_point b, double *t0, double *t1)
{
    double x = a.x - d->x, y = a.y - d->y, dx = b.x - a.x, dy = b.y - a.y, r = d->radius + 0.01;
    double A = dx * dx + dy * dy, B = x * dx + y * dy, C = x * x + y * y - r * r;
    *t0 = 0;
    *t1 = 1;
    if (A == 0)
        return C <= 0;
    double root = B * B - A * C;
    if (!(root >= 0))
        return 0;
    root = sqrt(root);
    *t0 = fmax(0, (-B - root) / A);
    *t1 = fmin(1, (-B + root) / A);
    return *t0 <= *t1;
}

/* The curve in px, cut at the disc's edge; at most 3 points per value. */
static size_t curve(const disc *d, const asp_series *series, aspi_point *out)
{
    const aspi_point gap = { NAN, NAN };
    aspi_point before = gap;
    size_t n = 0;
    for (size_t i = 0; i < series->count; i++) {
        double angle = series->x[i], r = radius_px(d, series->y[i]);
        int good = fabs(angle) <= PI / 2 * (1 + 1e-9) && !isnan(r);
        aspi_point p = good ? at(d, angle, r) : gap;
        double t0, t1;
        if (!good)
            out[n++] = gap;
        else if (isnan(before.x) && r <= d->radius + 0.01)
            out[n++] = p;
        else if (!isnan(before.x) && clip_disc(d, before, p, &t0, &t1)) {
            aspi_point a = { before.x + t0 * (p.x - before.x), before.y + t0 * (p.y - before.y) };
            if (t0 > 0) {             /* comes in from outside */
                out[n++] = gap;
                out[n++] = a;
            }
            out[n++] = (aspi_point){ before.x + t1 * (p.x - before.x), before.y + t1 * (p.y - before.y) };
        }
        before = p;
    }
    return n;
}

static void radius_axis(const asp_polar *polar, disc *d)
{
    asp_axis axis = polar->radius;
    int logarithmic = axis.scale == ASP_SCALE_LOG;
    double low = INFINITY, high = -INFINITY;
    for (size_t s = 0; s < polar->series_count; s++)
        for (size_t i = 0; i < polar->series[s].count; i++) {
            double v = polar->series[s].y[i];
            if (aspi_on_axis(logarithmic, v) && v >= 0) {
                low = fmin(low, v);
                high = fmax(high, v);
            }
        }
    if (axis.decades == 0)
        axis.decades = 4;
    if (!logarithmic && high > 0 && low > 0)
        low = 0;
    if (!logarithmic && !(high > 0)) {      /* nothing to draw, or nothing but zeros */
        low = 0;
        high = 1;
    }
    aspi_axis_set(&d->axis, &axis, low, high, 1, d->radius, 44);
    d->axis.from = 0;
    d->axis.to = d->radius;
}

static asp_status check(const asp_polar *polar, int width, asp_error *err)
{
    if (width < 160 || width > 8192)
        return asp_fail_range(err, "width", width, 160, 0, 8192);
    if (polar->radius.scale == ASP_SCALE_LINEAR && polar->radius.low != 0)
        return asp_fail_range(err, "radius.low", polar->radius.low, 0, 0, 0);
    return aspi_axis_check(&polar->radius, "radius", err);
}

char *asp_polar_svg(const asp_polar *polar, asp_error *err)
{
    int width = polar->width ? polar->width : 600;
    if (check(polar, width, err) != ASP_OK)
        return NULL;
    size_t most = 1, next = 0;
    for (size_t s = 0; s < polar->series_count; s++)
        most = polar->series[s].count > most ? polar->series[s].count : most;
    aspi_text text = { 0 };
    aspi_style *styles = calloc(polar->series_count + 1, sizeof *styles);
    aspi_point *points = calloc(3 * most, sizeof *points);
    char *svg = NULL;
    if (!styles || !points) {
        asp_fail(err, ASP_ENOMEM, "polar", "out of memory");
        goto done;
    }
    for (size_t s = 0; s < polar->series_count; s++)
        if (aspi_series_style(&polar->series[s], &next, &styles[s], err) != ASP_OK)
            goto done;
    disc d = { .x = 0.5 * width, .radius = 0.5 * width - 44 };
    d.y = (polar->title ? 52 : 30) + d.radius;
    radius_axis(polar, &d);
    aspi_legend legend = { 0 };
    if (polar->legend != ASP_LEGEND_NONE)
        legend = aspi_legend_size(polar->series, polar->series_count, width - 20);
    double bottom = d.y + (polar->radius.label || d.axis.exponent ? 42 : 24);
    aspi_svg_begin(&text, width, (int)ceil(bottom + legend.height), polar->title);
    draw_grid(&text, &d);
    draw_labels(&text, polar, &d);
    for (size_t i = 0; i < polar->incidence_count; i++)
        draw_incidence(&text, &d, polar->incidence[i]);
    const aspi_box all = { d.x - d.radius, d.y - d.radius, d.x + d.radius, d.y };
    for (size_t s = 0; s < polar->series_count; s++)
        aspi_draw_series(&text, &all, &styles[s], polar->series[s].label, points,
                         curve(&d, &polar->series[s], points));
    aspi_legend_draw(&text, &legend, polar->series, styles, polar->series_count,
                     0.5 * (width - legend.width), bottom, 0);
    aspi_svg_end(&text);
    svg = aspi_text_finish(&text, err);
done:
    free(styles);
    free(points);
    return svg;
}

asp_status asp_polar_write(const asp_polar *polar, const char *path, asp_error *err)
{
    asp_error mine = { 0 };
    return aspi_svg_write(asp_polar_svg(polar, &mine), path, &mine, err);
}

void asp_lobe(asp_brdf_function *f, const void *context, double theta_i, double azimuth,
              int with_cosine, size_t count, double *angle, double *value)
{
    double ca = cos(azimuth), sa = sin(azimuth);
    asp_vec3 wi = { -sin(theta_i) * ca, -sin(theta_i) * sa, cos(theta_i) };
    for (size_t i = 0; i < count; i++) {
        angle[i] = count > 1 ? PI * ((double)i / (double)(count - 1) - 0.5) : 0;
        double s = sin(angle[i]), c = cos(angle[i]);
        c = i == 0 || i + 1 == count ? 0 : c;       /* the horizon itself, not a rounding beside it */
        asp_vec3 wo = { s * ca, s * sa, c };
        asp_rgb v = f ? f(context, wi, wo) : asp_eval(context, wi, wo);
        value[i] = (0.2126 * v.r + 0.7152 * v.g + 0.0722 * v.b) * (with_cosine ? c : 1);
    }
}
