/* chart.c - curves over two axes, as SVG */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw/plot.h"

typedef struct layout {
    aspi_box    plot;
    aspi_axis   x, y;
    aspi_legend legend;
    asp_legend  place;
    double      legend_left, legend_top;
} layout;

#define TICK_SIZE 11.0
#define LABEL_SIZE 12.5
#define TITLE_SIZE 14.0

/* ------------------------------------------------------------------ limits */

typedef struct range { double low, high; } range;

static void include(range *r, double v)
{
    r->low = v < r->low ? v : r->low;
    r->high = v > r->high ? v : r->high;
}

/* The range of all points that can be drawn; of y only those whose x is within the x limits. */
static void data_ranges(const asp_chart *chart, range *x, range *y)
{
    int log_x = chart->x.scale == ASP_SCALE_LOG, log_y = chart->y.scale == ASP_SCALE_LOG;
    int fixed = chart->x.low != 0 || chart->x.high != 0;
    *x = *y = (range){ INFINITY, -INFINITY };
    for (size_t s = 0; s < chart->series_count; s++) {
        const asp_series *series = &chart->series[s];
        for (size_t i = 0; i < series->count; i++) {
            if (!aspi_on_axis(log_x, series->x[i]) || !aspi_on_axis(log_y, series->y[i]))
                continue;
            if (fixed && !(series->x[i] >= chart->x.low && series->x[i] <= chart->x.high))
                continue;
            include(x, series->x[i]);
            include(y, series->y[i]);
            if (series->low && series->high && aspi_on_axis(log_y, series->low[i])
                && aspi_on_axis(log_y, series->high[i])) {
                include(y, series->low[i]);
                include(y, series->high[i]);
            }
        }
    }
}

/* ------------------------------------------------------------------ layout */

static double widest_label(const aspi_axis *axis)
{
    double widest = 0;
    for (int i = 0; i < axis->tick_count; i++)
        widest = fmax(widest, aspi_label_width(axis->ticks[i].label, TICK_SIZE));
    return widest;
}

static aspi_point to_px(const layout *l, double x, double y)
{
    if (!aspi_on_axis(l->x.logarithmic, x) || !aspi_on_axis(l->y.logarithmic, y))
        return (aspi_point){ NAN, NAN };
    return (aspi_point){ aspi_axis_px(&l->x, x), aspi_axis_px(&l->y, y) };
}

/* Whether anything is drawn in a box. */
static int is_free(const asp_chart *chart, const layout *l, aspi_box box)
{
    for (size_t s = 0; s < chart->series_count; s++) {
        const asp_series *series = &chart->series[s];
        aspi_point last = { NAN, NAN };
        for (size_t i = 0; i < series->count; i++) {
            aspi_point p = to_px(l, series->x[i], series->y[i]), a = isnan(last.x) ? p : last, b = p;
            last = p;
            if (!isnan(p.x) && aspi_clip(&box, &a, &b))
                return 0;
        }
    }
    return 1;
}

static void corner(layout *l, asp_legend place)
{
    const double gap = 9;
    int right = place == ASP_LEGEND_TOP_RIGHT || place == ASP_LEGEND_BOTTOM_RIGHT;
    int top = place == ASP_LEGEND_TOP_RIGHT || place == ASP_LEGEND_TOP_LEFT;
    l->legend_left = right ? l->plot.right - gap - l->legend.width : l->plot.left + gap;
    l->legend_top = top ? l->plot.top + gap : l->plot.bottom - gap - l->legend.height;
}

/* The plot's box and both axes when `place` is taken by the legend. */
static void set_boxes(const asp_chart *chart, double width, double height, asp_legend place, layout *l)
{
    range x, y;
    data_ranges(chart, &x, &y);
    l->place = place;
    l->legend = (aspi_legend){ 0 };
    aspi_box box = { 0, chart->title ? 34 : 14, width - 18, height - (chart->x.label ? 46 : 28) };
    if (place == ASP_LEGEND_BELOW) {
        l->legend = aspi_legend_size(chart->series, chart->series_count, width - 40);
        box.bottom -= l->legend.height + 4;
    } else if (place != ASP_LEGEND_NONE) {
        l->legend = aspi_legend_size(chart->series, chart->series_count, 0);
        if (place == ASP_LEGEND_RIGHT)
            box.right -= l->legend.width;
    }
    box.bottom = fmax(box.bottom, box.top + 40);
    aspi_axis_set(&l->y, &chart->y, y.low, y.high, 1, box.bottom - box.top, 48);
    if (l->y.exponent && !chart->title) {       /* room for the factor above the axis */
        box.top += 10;
        aspi_axis_set(&l->y, &chart->y, y.low, y.high, 1, box.bottom - box.top, 48);
    }
    box.left = 14 + widest_label(&l->y) + (chart->y.label ? 22 : 0);
    box.right = fmax(box.right, box.left + 60);
    aspi_axis_set(&l->x, &chart->x, x.low, x.high, 0, box.right - box.left, 72);
    l->plot = box;
    l->x.from = box.left;
    l->x.to = box.right;
    l->y.from = box.bottom;
    l->y.to = box.top;
    if (place == ASP_LEGEND_RIGHT) {
        l->legend_left = box.right + 8;
        l->legend_top = box.top - 4;
    } else if (place == ASP_LEGEND_BELOW) {
        l->legend_left = fmax(box.left - 8, 0);
        l->legend_top = height - l->legend.height - 2;
    } else if (place != ASP_LEGEND_NONE) {
        corner(l, place);
    }
}

static void choose_layout(const asp_chart *chart, double width, double height, layout *l)
{
    asp_legend place = chart->legend;
    if (place != ASP_LEGEND_AUTO) {
        set_boxes(chart, width, height, place, l);
        return;
    }
    for (place = ASP_LEGEND_TOP_RIGHT; place <= ASP_LEGEND_BOTTOM_RIGHT; place++) {
        set_boxes(chart, width, height, place, l);
        aspi_box around = { l->legend_left - 4, l->legend_top - 4,
                            l->legend_left + l->legend.width + 4, l->legend_top + l->legend.height + 4 };
        int fits = around.left >= l->plot.left && around.right <= l->plot.right
                   && around.top >= l->plot.top && around.bottom <= l->plot.bottom;
        if (!l->legend.entries || (fits && is_free(chart, l, around)))
            return;
    }
    set_boxes(chart, width, height, l->legend.width > 0.4 * width ? ASP_LEGEND_BELOW : ASP_LEGEND_RIGHT,
              l);
}

/* ------------------------------------------------------------------ drawing */

static void draw_grid(aspi_text *text, const layout *l)
{
    const aspi_box *p = &l->plot;
    for (int pass = 0; pass < 2; pass++) {          /* minor lines below major ones */
        aspi_text_put(text, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"0.7\" d=\"",
                      pass ? "#dcdcdc" : "#f1f1f1");
        for (int i = 0; i < l->x.tick_count; i++)
            if (l->x.ticks[i].major == pass)
                aspi_text_put(text, "M%n %nV%n", aspi_axis_px(&l->x, l->x.ticks[i].value), p->top,
                              p->bottom);
        for (int i = 0; i < l->y.tick_count; i++)
            if (l->y.ticks[i].major == pass)
                aspi_text_put(text, "M%n %nH%n", p->left, aspi_axis_px(&l->y, l->y.ticks[i].value),
                              p->right);
        aspi_text_put(text, "\"/>\n");
    }
}

static void draw_factor(aspi_text *text, int exponent, double x, double y, aspi_anchor anchor)
{
    char label[48];
    snprintf(label, sizeof label, "\xc3\x97" "10^{%s%d}", exponent < 0 ? "\xe2\x88\x92" : "",
             abs(exponent));
    aspi_text_label(text, label, x, y, TICK_SIZE, anchor, 0, NULL);
}

static void draw_axes(aspi_text *text, const asp_chart *chart, const layout *l)
{
    const aspi_box *p = &l->plot;
    aspi_text_put(text, "<path fill=\"none\" stroke=\"#444444\" stroke-width=\"0.9\" d=\"M%n %nV%nH%nV%nz",
                  p->left, p->top, p->bottom, p->right, p->top);
    for (int i = 0; i < l->x.tick_count; i++)
        aspi_text_put(text, "M%n %nv%n", aspi_axis_px(&l->x, l->x.ticks[i].value), p->bottom,
                      l->x.ticks[i].major ? 5.0 : 3.0);
    for (int i = 0; i < l->y.tick_count; i++)
        aspi_text_put(text, "M%n %nh%n", p->left, aspi_axis_px(&l->y, l->y.ticks[i].value),
                      l->y.ticks[i].major ? -5.0 : -3.0);
    aspi_text_put(text, "\"/>\n");
    for (int i = 0; i < l->x.tick_count; i++)
        if (*l->x.ticks[i].label)
            aspi_text_label(text, l->x.ticks[i].label, aspi_axis_px(&l->x, l->x.ticks[i].value),
                            p->bottom + 17, TICK_SIZE, ASPI_MIDDLE, 0, NULL);
    for (int i = 0; i < l->y.tick_count; i++)
        if (*l->y.ticks[i].label)
            aspi_text_label(text, l->y.ticks[i].label, p->left - 8,
                            aspi_axis_px(&l->y, l->y.ticks[i].value) + 4, TICK_SIZE, ASPI_END, 0, NULL);
    if (l->x.exponent)
        draw_factor(text, l->x.exponent, p->right, p->bottom + 32, ASPI_END);
    if (l->y.exponent)
        draw_factor(text, l->y.exponent, p->left, p->top - 6, ASPI_START);
    if (chart->x.label)
        aspi_text_label(text, chart->x.label, 0.5 * (p->left + p->right), p->bottom + 36, LABEL_SIZE,
                        ASPI_MIDDLE, 0, NULL);
    if (chart->y.label)
        aspi_text_label(text, chart->y.label, 16, 0.5 * (p->top + p->bottom), LABEL_SIZE, ASPI_MIDDLE,
                        -90, NULL);
    if (chart->title)
        aspi_text_label(text, chart->title, 0.5 * (p->left + p->right), 21, TITLE_SIZE, ASPI_MIDDLE, 0,
                        " font-weight=\"bold\"");
}

static void draw_rules(aspi_text *text, const asp_chart *chart, const layout *l)
{
    const aspi_box *p = &l->plot;
    for (size_t i = 0; i < chart->rule_count; i++) {
        const asp_rule *rule = &chart->rules[i];
        const aspi_axis *axis = rule->horizontal ? &l->y : &l->x;
        if (!(rule->value >= axis->low && rule->value <= axis->high))
            continue;
        double at = aspi_axis_px(axis, rule->value);
        aspi_text_put(text, "<path fill=\"none\" stroke=\"#777777\" stroke-width=\"1\" "
                      "stroke-dasharray=\"2 2\" d=\"");
        if (rule->horizontal)
            aspi_text_put(text, "M%n %nH%n\"/>\n", p->left, at, p->right);
        else
            aspi_text_put(text, "M%n %nV%n\"/>\n", at, p->top, p->bottom);
        if (!rule->label)
            continue;
        double width = aspi_label_width(rule->label, 10.5);
        if (rule->horizontal)
            aspi_text_label(text, rule->label, rule->horizontal == 2 ? p->left + 5 : p->right - 5,
                            at - p->top > 16 ? at - 4 : at + 12, 10.5,
                            rule->horizontal == 2 ? ASPI_START : ASPI_END, 0, " fill=\"#666666\"");
        else
            aspi_text_label(text, rule->label, at + width + 6 < p->right ? at + 4 : at - 4, p->top + 12,
                            10.5, at + width + 6 < p->right ? ASPI_START : ASPI_END, 0,
                            " fill=\"#666666\"");
    }
}

/* Bounds of a band that cannot stand on the axis (0 on a logarithmic one) reach to its end. */
static double band_px(const layout *l, double v)
{
    if (aspi_on_axis(l->y.logarithmic, v))
        return aspi_axis_px(&l->y, v);
    return isnan(v) ? NAN : v > 0 ? l->plot.top - 1 : l->plot.bottom + 1;
}

/* One polygon per stretch without gaps. `points` and `scratch` have room for 32 * count. */
static void draw_band(aspi_text *text, const layout *l, const asp_series *series, const char *colour,
                      aspi_point *points, aspi_point *scratch)
{
    size_t n = 0;
    for (size_t i = 0; i <= series->count; i++) {
        int good = i < series->count && aspi_on_axis(l->x.logarithmic, series->x[i])
                   && !isnan(series->low[i]) && !isnan(series->high[i]);
        if (good) {
            n++;
            continue;
        }
        for (size_t k = 0; k < n; k++) {
            double x = aspi_axis_px(&l->x, series->x[i - n + k]);
            points[k] = (aspi_point){ x, band_px(l, series->low[i - n + k]) };
            points[2 * n - 1 - k] = (aspi_point){ x, band_px(l, series->high[i - n + k]) };
        }
        if (n > 1)
            aspi_draw_polygon(text, &l->plot, colour, points, 2 * n, scratch);
        n = 0;
    }
}

static void draw_chart(aspi_text *text, const asp_chart *chart, const layout *l,
                       const aspi_style *styles, int width, int height, aspi_point *points,
                       aspi_point *scratch)
{
    aspi_svg_begin(text, width, height, chart->title);
    draw_grid(text, l);
    for (size_t s = 0; s < chart->series_count; s++)
        if (chart->series[s].low && chart->series[s].high)
            draw_band(text, l, &chart->series[s], styles[s].colour, points, scratch);
    draw_rules(text, chart, l);
    draw_axes(text, chart, l);
    for (size_t s = 0; s < chart->series_count; s++) {
        const asp_series *series = &chart->series[s];
        for (size_t i = 0; i < series->count; i++)
            points[i] = to_px(l, series->x[i], series->y[i]);
        aspi_draw_series(text, &l->plot, &styles[s], series->label, points, series->count);
    }
    aspi_legend_draw(text, &l->legend, chart->series, styles, chart->series_count, l->legend_left,
                     l->legend_top, l->place != ASP_LEGEND_RIGHT && l->place != ASP_LEGEND_BELOW);
}

/* The notes, once all that they must not touch is decided. */
static asp_status draw_notes(aspi_text *text, const asp_chart *chart, const layout *l,
                             const aspi_style *styles, asp_error *err)
{
    size_t total = 0, used = 0, notes = 0;
    for (size_t s = 0; s < chart->series_count; s++) {
        total += chart->series[s].count;
        notes += chart->series[s].note != NULL;
    }
    if (!notes)
        return ASP_OK;
    aspi_point *all = malloc((total + 1) * sizeof *all);
    aspi_point **points = malloc((chart->series_count + 1) * sizeof *points);
    asp_status status = all && points ? ASP_OK
                                      : asp_fail(err, ASP_ENOMEM, "chart", "out of memory");
    for (size_t s = 0; status == ASP_OK && s < chart->series_count; s++) {
        points[s] = all + used;
        for (size_t i = 0; i < chart->series[s].count; i++)
            all[used++] = to_px(l, chart->series[s].x[i], chart->series[s].y[i]);
    }
    aspi_box legend = { l->legend_left, l->legend_top, l->legend_left + l->legend.width,
                        l->legend_top + l->legend.height };
    if (!l->legend.entries)
        legend = (aspi_box){ 0, 0, -1, -1 };
    if (status == ASP_OK)
        status = aspi_draw_notes(text, &l->plot, &legend, chart->series, styles, points,
                                 chart->series_count, err);
    free(points);
    free(all);
    return status;
}

static asp_status check(const asp_chart *chart, int width, int height, asp_error *err)
{
    if (width < 160 || width > 8192)
        return asp_fail_range(err, "width", width, 160, 0, 8192);
    if (height < 160 || height > 8192)
        return asp_fail_range(err, "height", height, 160, 0, 8192);
    if ((unsigned)chart->legend > ASP_LEGEND_BOTTOM_RIGHT)
        return asp_fail_range(err, "legend", chart->legend, 0, 0, ASP_LEGEND_BOTTOM_RIGHT);
    asp_status status = aspi_axis_check(&chart->x, "x", err);
    return status == ASP_OK ? aspi_axis_check(&chart->y, "y", err) : status;
}

char *asp_chart_svg(const asp_chart *chart, asp_error *err)
{
    int width = chart->width ? chart->width : 600, height = chart->height ? chart->height : 400;
    if (check(chart, width, height, err) != ASP_OK)
        return NULL;
    size_t most = 1, next = 0, bands = 0;
    for (size_t s = 0; s < chart->series_count; s++) {
        most = chart->series[s].count > most ? chart->series[s].count : most;
        bands |= chart->series[s].low && chart->series[s].high;
    }
    most = bands ? 32 * most : most;
    aspi_text text = { 0 };
    aspi_style *styles = calloc(chart->series_count + 1, sizeof *styles);
    aspi_point *points = calloc(most, sizeof *points);
    aspi_point *scratch = calloc(bands ? most : 1, sizeof *scratch);
    char *svg = NULL;
    if (!styles || !points || !scratch) {
        asp_fail(err, ASP_ENOMEM, "chart", "out of memory");
        goto done;
    }
    for (size_t s = 0; s < chart->series_count; s++)
        if (aspi_series_style(&chart->series[s], &next, &styles[s], err) != ASP_OK)
            goto done;
    layout l;
    choose_layout(chart, width, height, &l);
    draw_chart(&text, chart, &l, styles, width, height, points, scratch);
    if (draw_notes(&text, chart, &l, styles, err) != ASP_OK)
        goto done;
    aspi_svg_end(&text);
    svg = aspi_text_finish(&text, err);
done:
    if (!svg)
        aspi_text_free(&text);
    free(styles);
    free(points);
    free(scratch);
    return svg;
}

asp_status asp_chart_write(const asp_chart *chart, const char *path, asp_error *err)
{
    asp_error mine = { 0 };
    return aspi_svg_write(asp_chart_svg(chart, &mine), path, &mine, err);
}
