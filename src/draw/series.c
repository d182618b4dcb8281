/* series.c - curves cut to the plot, bands, markers and legends */
#include <math.h>
#include <string.h>

#include "draw/plot.h"

/* ------------------------------------------------------------------ clipping */

/* One side of the box: keeps t in [*t0, *t1] where p t <= q. */
static int clip_side(double p, double q, double *t0, double *t1)
{
    if (p == 0)
        return q >= 0;
    double t = q / p;
    if (p < 0) {
        if (t > *t1)
            return 0;
        *t0 = t > *t0 ? t : *t0;
    } else {
        if (t < *t0)
            return 0;
        *t1 = t < *t1 ? t : *t1;
    }
    return 1;
}

int aspi_clip(const aspi_box *box, aspi_point *a, aspi_point *b)
{
    double t0 = 0, t1 = 1, dx = b->x - a->x, dy = b->y - a->y;
    if (!clip_side(-dx, a->x - box->left, &t0, &t1) || !clip_side(dx, box->right - a->x, &t0, &t1)
        || !clip_side(-dy, a->y - box->top, &t0, &t1) || !clip_side(dy, box->bottom - a->y, &t0, &t1))
        return 0;
    aspi_point from = *a;
    *a = (aspi_point){ from.x + t0 * dx, from.y + t0 * dy };
    *b = (aspi_point){ from.x + t1 * dx, from.y + t1 * dy };
    return 1;
}

static int inside(const aspi_box *box, aspi_point p)
{
    return p.x >= box->left - 0.01 && p.x <= box->right + 0.01 && p.y >= box->top - 0.01
           && p.y <= box->bottom + 0.01;
}

/* ------------------------------------------------------------------ lines and markers */

/* Steps shorter than this are joined: nobody sees them, and files with a million points stay small. */
#define SHORTEST 0.3
/* A point this near to the line past it is left out. */
#define STRAIGHT 0.04

/* The directions from `from` in which a line passes all points left out since: those whose cross
 * products with both edges have the right sign. Nothing is left out yet: open. */
typedef struct wedge { int open; aspi_point low, high; double reach; } wedge;

static double cross(aspi_point a, aspi_point b) { return a.x * b.y - a.y * b.x; }

/* Whether b can follow straight on, so that the point before it is of no use. */
static int goes_on(const wedge *w, aspi_point from, aspi_point b)
{
    aspi_point d = { b.x - from.x, b.y - from.y };
    return w->open || (cross(w->low, d) >= 0 && cross(d, w->high) >= 0 && hypot(d.x, d.y) > w->reach);
}

/* p is left out: the line has to pass it. */
static void narrow(wedge *w, aspi_point from, aspi_point p)
{
    aspi_point d = { p.x - from.x, p.y - from.y };
    double length = hypot(d.x, d.y), t = STRAIGHT / fmax(length, STRAIGHT);
    aspi_point low = { d.x + t * d.y, d.y - t * d.x }, high = { d.x - t * d.y, d.y + t * d.x };
    w->low = w->open || cross(w->low, low) > 0 ? low : w->low;
    w->high = w->open || cross(high, w->high) > 0 ? high : w->high;
    w->reach = w->open || length > w->reach ? length : w->reach;
    w->open = 0;
}

static void draw_line(aspi_text *text, const aspi_box *box, const aspi_point *points, size_t count)
{
    aspi_point last = { NAN, NAN };     /* where the pen is */
    aspi_point from = { NAN, NAN };     /* the point before that was not left out */
    wedge      on = { .open = 1 };
    for (size_t i = 0; i < count; i++) {
        aspi_point a = from, b = points[i];
        if (!isnan(a.x) && !isnan(b.x) && i + 1 < count && !isnan(points[i + 1].x)) {
            if (hypot(b.x - a.x, b.y - a.y) < SHORTEST)
                continue;
            wedge after = on;
            narrow(&after, a, b);
            if (goes_on(&on, a, b) && goes_on(&after, a, points[i + 1])) {
                on = after;
                continue;
            }
        }
        from = b;
        on.open = 1;
        if (isnan(a.x) || isnan(b.x) || !aspi_clip(box, &a, &b))
            continue;
        if (!(fabs(a.x - last.x) < 1e-6 && fabs(a.y - last.y) < 1e-6))
            aspi_text_put(text, "M%n %n", a.x, a.y);
        aspi_text_put(text, "L%n %n", b.x, b.y);
        last = b;
    }
}

static int is_isolated(const aspi_point *points, size_t count, size_t i)
{
    return !isnan(points[i].x) && (i == 0 || isnan(points[i - 1].x))
           && (i + 1 == count || isnan(points[i + 1].x));
}

static void add_marker(aspi_text *text, asp_marker marker, aspi_point p)
{
    switch (marker) {
    case ASP_MARKER_SQUARE:
        aspi_text_put(text, "M%n %nh5.6v5.6h-5.6z", p.x - 2.8, p.y - 2.8);
        break;
    case ASP_MARKER_DIAMOND:
        aspi_text_put(text, "M%n %nl3.7 3.7l-3.7 3.7l-3.7 -3.7z", p.x, p.y - 3.7);
        break;
    case ASP_MARKER_TRIANGLE:
        aspi_text_put(text, "M%n %nl3.5 6h-7z", p.x, p.y - 4);
        break;
    case ASP_MARKER_CROSS:
        aspi_text_put(text, "M%n %nl5.6 5.6m-5.6 0l5.6 -5.6", p.x - 2.8, p.y - 2.8);
        break;
    case ASP_MARKER_DOT:
        aspi_text_put(text, "M%n %na1.4 1.4 0 1 0 2.8 0a1.4 1.4 0 1 0 -2.8 0z", p.x - 1.4, p.y);
        break;
    default:
        aspi_text_put(text, "M%n %na3 3 0 1 0 6 0a3 3 0 1 0 -6 0z", p.x - 3, p.y);
        break;
    }
}

static void begin_markers(aspi_text *text, asp_marker marker, const char *colour)
{
    if (marker == ASP_MARKER_CROSS)
        aspi_text_put(text, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"1.5\" d=\"", colour);
    else if (marker == ASP_MARKER_DOT)
        aspi_text_put(text, "<path fill=\"%s\" d=\"", colour);
    else
        aspi_text_put(text, "<path fill=\"%s\" stroke=\"#ffffff\" stroke-width=\"0.6\" d=\"", colour);
}

void aspi_draw_series(aspi_text *text, const aspi_box *box, const aspi_style *style,
                      const char *label, const aspi_point *points, size_t count)
{
    aspi_text_put(text, "<g>");
    if (label)
        aspi_text_put(text, "<title>%e</title>", label);
    if (style->dash) {
        aspi_text_put(text, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%n\" "
                      "stroke-linejoin=\"round\"", style->colour, style->width);
        if (*style->dash)
            aspi_text_put(text, " stroke-dasharray=\"%s\"", style->dash);
        aspi_text_put(text, " d=\"");
        draw_line(text, box, points, count);
        aspi_text_put(text, "\"/>\n");
    }
    /* a point between two gaps has no line: without a marker of its own it gets a dot */
    asp_marker marker = style->marker == ASP_MARKER_NONE ? ASP_MARKER_DOT : style->marker;
    begin_markers(text, marker, style->colour);
    for (size_t i = 0; i < count; i++)
        if (!isnan(points[i].x) && inside(box, points[i])
            && (style->marker != ASP_MARKER_NONE || is_isolated(points, count, i)))
            add_marker(text, marker, points[i]);
    aspi_text_put(text, "\"/></g>\n");
}

/* ------------------------------------------------------------------ areas */

/* How far p is inside one side (0 left, 1 right, 2 top, 3 bottom). */
static double depth(const aspi_box *box, int side, aspi_point p)
{
    return side == 0 ? p.x - box->left : side == 1 ? box->right - p.x
         : side == 2 ? p.y - box->top : box->bottom - p.y;
}

/* Cuts a polygon at one side (Sutherland, Hodgman 1974); a polygon of n corners gets at most 2n. */
static size_t cut(const aspi_box *box, int side, const aspi_point *in, size_t n, aspi_point *out)
{
    size_t m = 0;
    for (size_t i = 0; i < n; i++) {
        aspi_point a = in[i], b = in[(i + 1) % n];
        double da = depth(box, side, a), db = depth(box, side, b);
        if (da >= 0)
            out[m++] = a;
        if ((da >= 0) != (db >= 0)) {
            double t = da / (da - db);
            out[m++] = (aspi_point){ a.x + t * (b.x - a.x), a.y + t * (b.y - a.y) };
        }
    }
    return m;
}

/* points and scratch hold 16 * count entries each: four cuts, each at most doubling. */
void aspi_draw_polygon(aspi_text *text, const aspi_box *box, const char *colour, aspi_point *points,
                       size_t count, aspi_point *scratch)
{
    count = cut(box, 0, points, count, scratch);
    count = cut(box, 1, scratch, count, points);
    count = cut(box, 2, points, count, scratch);
    count = cut(box, 3, scratch, count, points);
    if (count < 3)
        return;
    aspi_text_put(text, "<path fill=\"%s\" fill-opacity=\"0.18\" d=\"", colour);
    for (size_t i = 0; i < count; i++)
        aspi_text_put(text, "%s%n %n", i ? "L" : "M", points[i].x, points[i].y);
    aspi_text_put(text, "z\"/>\n");
}

/* ------------------------------------------------------------------ legend */

#define SWATCH 26.0
#define ROW 17.0
#define SIZE 11.5

aspi_legend aspi_legend_size(const asp_series *series, size_t count, double room)
{
    aspi_legend legend = { 0 };
    for (size_t i = 0; i < count; i++)
        if (series[i].label) {
            double width = SWATCH + 7 + aspi_label_width(series[i].label, SIZE) + 14;
            legend.column_width = fmax(legend.column_width, width);
            legend.entries++;
        }
    if (!legend.entries)
        return legend;
    legend.columns = (int)(room / legend.column_width);
    if (legend.columns > legend.entries)
        legend.columns = legend.entries;
    if (legend.columns < 1)
        legend.columns = 1;
    legend.rows = (legend.entries + legend.columns - 1) / legend.columns;
    legend.width = legend.columns * legend.column_width;
    legend.height = legend.rows * ROW + 8;
    return legend;
}

void aspi_legend_draw(aspi_text *text, const aspi_legend *legend, const asp_series *series,
                      const aspi_style *styles, size_t count, double left, double top, int box)
{
    if (!legend->entries)
        return;
    aspi_text_put(text, "<g>\n");
    if (box)
        aspi_text_put(text, "<rect x=\"%n\" y=\"%n\" width=\"%n\" height=\"%n\" rx=\"2\" fill=\"#ffffff\" "
                      "fill-opacity=\"0.88\" stroke=\"#c8c8c8\" stroke-width=\"0.6\"/>\n",
                      left, top, legend->width, legend->height);
    int entry = 0;
    for (size_t i = 0; i < count; i++) {
        if (!series[i].label)
            continue;
        double x = left + 8 + (entry / legend->rows) * legend->column_width;
        double y = top + 4 + ROW * (entry % legend->rows + 0.5);
        const aspi_style *style = &styles[i];
        if (series[i].low && series[i].high)
            aspi_text_put(text, "<rect x=\"%n\" y=\"%n\" width=\"%n\" height=\"10\" fill=\"%s\" "
                          "fill-opacity=\"0.18\"/>\n", x, y - 5, SWATCH, style->colour);
        if (style->dash) {
            aspi_text_put(text, "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%n\"", style->colour,
                          style->width);
            if (*style->dash)
                aspi_text_put(text, " stroke-dasharray=\"%s\"", style->dash);
            aspi_text_put(text, " d=\"M%n %nh%n\"/>\n", x, y, SWATCH);
        }
        if (style->marker != ASP_MARKER_NONE) {
            begin_markers(text, style->marker, style->colour);
            add_marker(text, style->marker, (aspi_point){ x + SWATCH / 2, y });
            aspi_text_put(text, "\"/>\n");
        }
        aspi_text_label(text, series[i].label, x + SWATCH + 6, y + 4, SIZE, ASPI_START, 0, NULL);
        entry++;
    }
    aspi_text_put(text, "</g>\n");
}
