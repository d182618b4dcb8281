/* figures.h - the figures of the source documents, drawn again from this library
 *
 *   cmd_figures.c       which ones, and the three files of each: SVG, PNG, CSV
 *   figures_drawing.c   panels of curves; their picture and their numbers
 *   figures_notebook.c  the notebook's plots: one row a panel, specs as text
 *   figures_std.c       the STD paper's charts
 *   figures_cost.c      its Figure 4, measured
 *   figures_models.c    the distributions of the library, whichever there are
 *   svg_png.c           SVG to PNG */
#ifndef FIGURES_H
#define FIGURES_H

#include "cmd.h"

/* ---- a drawing: panels side by side, each with its curves */

#define FIGURE_PANELS 8
#define FIGURE_CURVES 24

typedef struct figure_curve {
    char   label[80];               /* in the numbers: a spec or a name */
    char   legend[96], note[40];    /* "": none */
    char   colour[40];              /* of asp_series; "": by the label */
    asp_dash dash;
    asp_marker marker;
    double width;
    double *x, *y;
    size_t count;
} figure_curve;

typedef struct figure_panel {
    char     title[120], quantity[40];        /* quantity: in the numbers */
    asp_axis x, y;
    char     x_label[60], y_label[60];
    asp_rule rules[4];
    char     rule_label[4][48];
    size_t   rule_count;
    asp_legend legend;
    figure_curve curves[FIGURE_CURVES];
    size_t   curve_count;
} figure_panel;

typedef struct drawing {
    figure_panel panels[FIGURE_PANELS];
    size_t panel_count, columns;
    int    width, height;           /* of one panel; 0: 600 and 400 */
    int    broken;                  /* memory ran out */
} drawing;

/* A panel to fill in. Labels as in asp_axis. */
figure_panel *drawing_panel(drawing *d, const char *title, const char *x_label, const char *y_label,
                            const char *quantity);
/* A curve with room for `count` points, or NULL (d->broken). */
figure_curve *drawing_curve(drawing *d, figure_panel *panel, size_t count, const char *label);
void drawing_rule(figure_panel *panel, double value, int horizontal, const char *label);
void drawing_free(drawing *d);

/* One SVG, to be freed; NULL with the error printed. */
char *drawing_svg(const drawing *d, const char *title);
/* panel, quantity, curve, x, value. */
void drawing_numbers(const drawing *d, const char *x_name, cmd_out *out);

/* ---- a figure */

typedef struct figure_job {
    const cmd_args *args;
    cmd_progress *progress;
    double from, to;                /* this figure's share of all the work */
    drawing *out;
} figure_job;

void figure_progress(const figure_job *job, double done);

typedef struct figure {
    const char *name, *title;
    const char *source;             /* document and place */
    const char *x_name;             /* column of the numbers */
    const char *note;               /* for the page; NULL: none */
    double seconds;                 /* about, for the bar */
    int (*make)(const struct figure *figure, const figure_job *job);    /* CMD_OK or the error printed */
    const void *rows;               /* what `make` reads */
    int (*available)(const struct figure *figure);     /* 0: a distribution that it shows is not among
                                                        * asp_models(); NULL: always there */
} figure;

extern const figure figures_notebook[], figures_std[];     /* end with a NULL name */

/* One for each of asp_models(), as many as there is room for. */
#define FIGURE_MODELS 48
size_t figures_models(figure *out, size_t room);

/* ---- pieces that figures share */

/* A distribution by spec, or the error printed. */
int figure_ndf(const char *spec, asp_ndf *out);
/* Parts of n on [0, 1] as angles, closer together near 0: degrees, cosine and sine. */
void figure_angle(size_t i, size_t n, double *degrees, double *cosine, double *sine);

int figures_cost(const figure *f, const figure_job *job);

/* ---- PNG */

/* 1 where the program was built with librsvg. */
int  svg_png_available(void);
/* The bytes of a PNG of `scale` pixels per px, to be freed with free(). CMD_OK, or the error printed. */
int  svg_png(const char *svg, double scale, unsigned char **bytes, size_t *size);

#endif
