/* notes.c - a few letters at each curve, where they have most room */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw/plot.h"

#define SIZE 10.0
#define HEIGHT 9.0          /* of digits and small letters */
#define GRAIN 3.0           /* px between the points that stand for a curve */
#define STRIDE 3            /* of them, between two places that are tried */
#define ENOUGH 13.0         /* px; more room is no better */

typedef struct dots { aspi_point *at; size_t count; } dots;

/* A curve as points no more than GRAIN apart, without what is outside the plot. */
static int sample(const aspi_box *plot, const aspi_point *points, size_t count, dots *out)
{
    size_t room = 0;
    for (int pass = 0; pass < 2; pass++) {
        size_t n = 0;
        for (size_t i = 1; i < count; i++) {
            aspi_point a = points[i - 1], b = points[i];
            if (isnan(a.x) || isnan(b.x) || !aspi_clip(plot, &a, &b))
                continue;
            int steps = 1 + (int)(hypot(b.x - a.x, b.y - a.y) / GRAIN);
            for (int k = 0; k < steps; k++, n++)
                if (pass)
                    out->at[n] = (aspi_point){ a.x + (b.x - a.x) * k / steps,
                                               a.y + (b.y - a.y) * k / steps };
        }
        room = n;
        if (!pass && !(out->at = malloc((n + 1) * sizeof *out->at)))
            return 0;
    }
    out->count = room;
    return 1;
}

static double distance(const aspi_box *b, aspi_point p)
{
    double dx = fmax(0, fmax(b->left - p.x, p.x - b->right));
    double dy = fmax(0, fmax(b->top - p.y, p.y - b->bottom));
    return sqrt(dx * dx + dy * dy);
}

static int apart(const aspi_box *a, const aspi_box *b, double by)
{
    return a->right + by < b->left || b->right + by < a->left || a->bottom + by < b->top
           || b->bottom + by < a->top;
}

/* Curves that lie on one another share a note. */
static int same_note(const asp_series *a, const asp_series *b)
{
    return a->note && b->note && strcmp(a->note, b->note) == 0;
}

/* The room around a box, negative where it cannot stand. The curves that share the note
 * may come near. Where others come close to `anchor`, the point that it stands at, nobody could tell whose
 * note it is. */
static double room(const aspi_box *box, aspi_point anchor, const aspi_box *plot, const aspi_box *legend,
                   const aspi_box *taken, size_t taken_count, const dots *curves,
                   const char *shared, size_t count)
{
    double least = ENOUGH;
    if (box->left < plot->left + 2 || box->right > plot->right - 2 || box->top < plot->top + 2
        || box->bottom > plot->bottom - 2 || !(legend->right < legend->left || apart(box, legend, 3)))
        return -1;
    for (size_t i = 0; i < taken_count; i++)
        if (!apart(box, &taken[i], 3))
            return -1;
    for (size_t k = 0; k < count; k++)
        for (size_t i = 0; i < curves[k].count && least >= 0; i++) {
            aspi_point p = curves[k].at[i];
            double d = distance(box, p), dx = p.x - anchor.x, dy = p.y - anchor.y;
            if (d < 1.2)
                least = -1;
            else if (!shared[k])
                least = fmin(least, fmin(d, 0.7 + sqrt(dx * dx + dy * dy)));
        }
    return least;
}

/* Places around a point of the curve, in parts of the box and px: above, right, left, below, and
 * between these, where a slanting curve leaves room. */
static const struct { double x, y, dx, dy; } sides[] = {
    { -0.5, -1, 0, -3 }, { 0, -0.5, 4, 0 }, { -1, -0.5, -4, 0 }, { -0.5, 0, 0, 3 },
    { 0, -1, 2, -1.5 }, { -1, 0, -2, 1.5 }, { -1, -1, -2, -1.5 }, { 0, 0, 2, 1.5 },
};
enum { SIDES = sizeof sides / sizeof *sides };

static aspi_box place(aspi_point p, int side, double width)
{
    double left = p.x + sides[side].x * width + sides[side].dx;
    double top = p.y + sides[side].y * HEIGHT + sides[side].dy;
    return (aspi_box){ left, top, left + width, top + HEIGHT };
}

static int best_place(const aspi_box *plot, const aspi_box *legend, const aspi_box *taken,
                      size_t taken_count, const dots *curves, const char *shared, size_t count,
                      size_t own, double width, aspi_box *out)
{
    double best = 0;
    for (size_t i = 0; i < curves[own].count; i += STRIDE)
        for (int side = 0; side < SIDES; side++) {
            aspi_box box = place(curves[own].at[i], side, width);
            double r = room(&box, curves[own].at[i], plot, legend, taken, taken_count, curves, shared, count);
            if (r > best + 0.5) {               /* of equal places the first: near the peak, above */
                best = r;
                *out = box;
            }
        }
    return best > 0;
}

/* The line's colour made darker, so that small letters can be read. */
static void darker(const char *colour, char *out, size_t size)
{
    unsigned r = 0, g = 0, b = 0;     /* of two hexadecimal digits each */
    sscanf(colour, "#%2x%2x%2x", &r, &g, &b);
    snprintf(out, size, " fill=\"#%02x%02x%02x\"", (r & 255) * 6 / 10, (g & 255) * 6 / 10,
             (b & 255) * 6 / 10);
}

asp_status aspi_draw_notes(aspi_text *text, const aspi_box *plot, const aspi_box *legend,
                           const asp_series *series, const aspi_style *styles,
                           aspi_point *const *points, size_t count, asp_error *err)
{
    dots *curves = calloc(count + 1, sizeof *curves);
    aspi_box *taken = calloc(count + 1, sizeof *taken);
    char *shared = malloc(count + 1);          /* whether a curve has the note at hand */
    size_t taken_count = 0;
    int good = curves && taken && shared;
    for (size_t k = 0; good && k < count; k++)
        good = sample(plot, points[k], series[k].count, &curves[k]);
    for (size_t k = 0; good && k < count; k++) {
        char fill[32];
        aspi_box box;
        int drawn = !series[k].note;
        for (size_t j = 0; j < k && !drawn; j++)
            drawn = same_note(&series[j], &series[k]);
        if (drawn)
            continue;
        for (size_t j = 0; j < count; j++)
            shared[j] = (char)same_note(&series[j], &series[k]);
        double width = aspi_label_width(series[k].note, SIZE) / 1.08;
        if (!best_place(plot, legend, taken, taken_count, curves, shared, count, k, width, &box))
            continue;
        darker(styles[k].colour, fill, sizeof fill);
        aspi_text_label(text, series[k].note, 0.5 * (box.left + box.right), box.bottom - 1, SIZE,
                        ASPI_MIDDLE, 0, fill);
        taken[taken_count++] = box;
    }
    for (size_t k = 0; curves && k < count; k++)
        free(curves[k].at);
    free(curves);
    free(taken);
    free(shared);
    return good ? ASP_OK : asp_fail(err, ASP_ENOMEM, "chart", "out of memory");
}
