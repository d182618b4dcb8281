/* report.h - what a fit writes down: a table, fit.json and one self-contained page of HTML
 *
 *   report_page.c     text that grows, escaped for HTML
 *   report_numbers.c  numbers with their uncertainties; the table on the terminal
 *   report_curves.c   measured against fitted curves, as SVG
 *   report_html.c     the page
 *   report_json.c     fit.json */
#ifndef REPORT_H
#define REPORT_H

#include "asperity_ndf.h"
#include "cmd.h"

#define REPORT_MODELS 32

/* ---- text that grows; after running out of memory it stays empty and `broken` */

typedef struct page { char *text; size_t used, room; int broken; } page;

void page_put(page *p, const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 2, 3)))
#endif
    ;
void page_add(page *p, const char *text);
void page_escaped(page *p, const char *text);      /* & < > " as entities */
void page_free(page *p);

/* ---- one measurement and its fits */

typedef struct report {
    const char *title;                   /* the file's name without folders, or "fabricated" */
    const char *file;                    /* as the user gave it; NULL: fabricated */
    const asp_measured *measured;
    asp_measured_info info;
    const asp_fabrication *made;         /* of the fabricated one, else NULL */
    const asp_fabrication_report *truth;
    const char *loss;
    int    loss_index, starts;
    uint64_t seed;
    int    mask;
    double specular_limit;
    const asp_fit_result *result;
    size_t count, best;
    asp_measurement *geometry;           /* what the fits saw */
    size_t geometries;
    char  *sphere[REPORT_MODELS + 1];    /* base64 PNG: measured, then each fit; NULL: none */
    int    sphere_side;
} report;

/* The best result by the fitted loss. */
size_t report_best(const report *r);

/* `0.1234 +- 0.0012`, with `sign` for the two letters, or what there is to say instead. */
const char *report_number(const asp_fit_parameter *p, const char *sign, char *buffer, size_t size);
void report_table(const report *r, FILE *file);

/* The names of the parameters, one for each row of a table; how many. */
#define REPORT_ROWS 64
size_t report_rows(const report *r, const char **out, size_t room);
const asp_fit_parameter *report_find(const asp_fit_result *f, const char *name);   /* NULL: none */
const char *report_mask_name(int mask);

/* One object, NULL without memory. */
json_t *report_json(const report *r);

/* Charts as SVG, NULL where there is nothing to draw or no memory; free(). */
double report_luminance(asp_rgb f);
/* Angles of incidence, radians, that have a curve in the plane of incidence. */
size_t report_incidences(const report *r, double *out, size_t room);
char *report_plane(const report *r, double theta_i, asp_scale scale);
char *report_profile(const report *r, double theta_d);
char *report_ratio(const report *r);
/* Listed geometries nearer to the mirror direction than where the logarithmic axes of the charts
 * begin: they are drawn at the left edge. The number of them; *edge in degrees. */
#define REPORT_PROFILE_EDGE 0.2
#define REPORT_RATIO_EDGE 0.04178
size_t report_at_edge(const report *r, double edge);
/* Geometries in bins too small for a median, and fitted over measured of the best fit there. */
size_t report_left_out(const report *r, double *ratio);
/* The geometry with the highest measured luminance; theta_h and theta_d of any, radians. */
const asp_measurement *report_peak(const report *r);
void report_half_angles(const asp_measurement *m, double *theta_h, double *theta_d);

/* The whole page. */
void report_html(const report *r, page *out);
/* The page that leads to several. */
typedef struct report_entry { char name[256]; char *summary; size_t cells; } report_entry;
void report_index(const report_entry *entry, size_t count, page *out);

/* Style and head shared by both pages; `title` is escaped. */
void report_head(page *out, const char *title);

#endif
