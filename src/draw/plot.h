/* plot.h - what charts and polar plots share: axes, ticks, clipped curves, legends */
#ifndef ASPI_DRAW_PLOT_H
#define ASPI_DRAW_PLOT_H

#include "draw/text.h"

#define ASPI_TICKS 128

/* A value on an axis beyond these is a gap: their differences stay finite. */
#define ASPI_AXIS_MAX 1e300
#define ASPI_AXIS_MIN 1e-300          /* log axes */

typedef struct aspi_tick {
    double value;
    int    major;
    char   label[48];                 /* with ^{...}; "" for minor ticks */
} aspi_tick;

/* An axis with its limits decided, from `from` px (low) to `to` px (high). */
typedef struct aspi_axis {
    int       logarithmic;
    double    low, high;
    double    from, to;
    int       tick_count;
    aspi_tick ticks[ASPI_TICKS];
    int       exponent;               /* labels are to be multiplied by 10^exponent */
} aspi_axis;

/* Whether a value can stand on such an axis. */
int aspi_on_axis(int logarithmic, double value);
double aspi_axis_px(const aspi_axis *axis, double value);

/* Checks what the caller fixed; `name` is used in errors ("x", "y", "radius"). */
asp_status aspi_axis_check(const asp_axis *axis, const char *name, asp_error *err);

/* Sets limits: the caller's or those of the data [low, high] (low > high: no data), widened to whole
 * ticks when `round`; then the ticks for an axis of `length` px with about `spacing` px each. */
void aspi_axis_set(aspi_axis *out, const asp_axis *axis, double low, double high, int round,
                   double length, double spacing);

/* ---- series */

/* Colour and dash of a series, in px of line and gap ("" is solid). */
typedef struct aspi_style {
    const char *colour;
    const char *dash;                 /* stroke-dasharray, NULL: no line, "": solid */
    asp_marker  marker;
    double      width;
} aspi_style;

asp_status aspi_series_style(const asp_series *series, size_t *next, aspi_style *out, asp_error *err);

typedef struct aspi_point { double x, y; } aspi_point;          /* px; NaN x: a gap */
typedef struct aspi_box { double left, top, right, bottom; } aspi_box;

/* The part of a segment in a box (Liang, Barsky 1984); 0 when there is none. */
int aspi_clip(const aspi_box *box, aspi_point *a, aspi_point *b);

/* Line, isolated points and markers of a series. */
void aspi_draw_series(aspi_text *text, const aspi_box *box, const aspi_style *style,
                      const char *label, const aspi_point *points, size_t count);
/* The area between two curves, given as one polygon of px. */
void aspi_draw_polygon(aspi_text *text, const aspi_box *box, const char *colour, aspi_point *points,
                       size_t count, aspi_point *scratch);

/* ---- legend */

typedef struct aspi_legend {
    int    entries, columns, rows;
    double column_width, width, height;
} aspi_legend;

/* Its size when it may be `room` px wide. */
aspi_legend aspi_legend_size(const asp_series *series, size_t count, double room);
void aspi_legend_draw(aspi_text *text, const aspi_legend *legend, const asp_series *series,
                      const aspi_style *styles, size_t count, double left, double top, int box);

/* ---- notes at the curves */

/* Curves in px, each of count[k] points with NaN for gaps; writes series[k].note where nothing else is
 * drawn, `legend` (right < left: none) included. */
asp_status aspi_draw_notes(aspi_text *text, const aspi_box *plot, const aspi_box *legend,
                           const asp_series *series, const aspi_style *styles,
                           aspi_point *const *points, size_t count, asp_error *err);

#endif
