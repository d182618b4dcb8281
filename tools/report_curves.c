/* report_curves.c - what was measured, drawn with what was fitted */
#include "report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DEGREES 57.295779513082320877
#define DENSE 701              /* points of a fitted curve */
#define CHART_WIDTH 500
#define CHART_HEIGHT 330
#define SERIES (REPORT_MODELS + 1)

double report_luminance(asp_rgb f)
{
    return 0.2126 * f.r + 0.7152 * f.g + 0.0722 * f.b;
}

/* ------------------------------------------------------------------ the plane of incidence */

static asp_vec3 in_plane(double angle)
{
    return (asp_vec3){ sin(angle), 0, cos(angle) };
}

/* Is a listed geometry in its plane of incidence? Then the two angles, wo's positive on the far side
 * of the normal. */
static int plane_angles(const asp_measurement *m, double *theta_i, double *theta_o)
{
    double si = hypot(m->wi.x, m->wi.y), so = hypot(m->wo.x, m->wo.y);
    double dot = m->wi.x * m->wo.x + m->wi.y * m->wo.y;
    double cross = m->wi.x * m->wo.y - m->wi.y * m->wo.x;
    if (fabs(cross) > 0.01 * si * so + 1e-6)
        return 0;
    *theta_i = atan2(si, m->wi.z);
    *theta_o = atan2(so, m->wo.z) * (dot > 0 ? -1 : 1);
    return 1;
}

static int same_angle(double a, double b)
{
    return fabs(a - b) < 0.1 / DEGREES;
}

/* Listed angles of incidence whose outgoing directions are many and spread over half of the plane;
 * where there are more than room for, evenly chosen ones. */
static size_t listed_incidences(const report *r, double *out, size_t room)
{
    enum { ANGLES = 256, ENOUGH = 15 };
    struct { double theta_i, low, high; size_t count; } group[ANGLES];
    double good[ANGLES];
    size_t n = 0, m = 0;
    for (size_t i = 0; i < r->geometries; i++) {
        double ti, to;
        size_t k = 0;
        if (!plane_angles(&r->geometry[i], &ti, &to))
            continue;
        while (k < n && !same_angle(group[k].theta_i, ti))
            k++;
        if (k == ANGLES)
            continue;
        if (k == n) {
            group[n].theta_i = ti;
            group[n].low = group[n].high = to;
            group[n++].count = 0;
        }
        group[k].low = fmin(group[k].low, to);
        group[k].high = fmax(group[k].high, to);
        group[k].count++;
    }
    for (size_t k = 0; k < n; k++)
        if (group[k].count >= ENOUGH && group[k].high - group[k].low > 90 / DEGREES) {
            size_t at = m++;
            for (; at && good[at - 1] > group[k].theta_i; at--)
                good[at] = good[at - 1];
            good[at] = group[k].theta_i;
        }
    for (size_t k = 0; k < room && k < m; k++)
        out[k] = m <= room ? good[k] : good[(2 * k + 1) * m / (2 * room)];
    return m < room ? m : room;
}

size_t report_incidences(const report *r, double *out, size_t room)
{
    static const double usual[] = { 15, 45, 70 };
    if (r->info.scattered)
        return listed_incidences(r, out, room);
    size_t n = sizeof usual / sizeof *usual < room ? sizeof usual / sizeof *usual : room;
    for (size_t k = 0; k < n; k++)
        out[k] = usual[k] / DEGREES;
    return n;
}

/* ------------------------------------------------------------------ curves */

/* The series of a chart: the measured one and one for each fit, over x of their own. */
typedef struct curves {
    asp_series series[SERIES];
    double *x[SERIES], *y[SERIES];       /* of the series, to write to */
    double *memory;
    size_t  count;
} curves;

static int curves_make(curves *c, const report *r, size_t measured, size_t fitted)
{
    size_t n = r->count < SERIES - 1 ? r->count : SERIES - 1;
    memset(c, 0, sizeof *c);
    c->memory = malloc((2 * measured + 2 * n * fitted + 1) * sizeof *c->memory);
    if (!c->memory)
        return 0;
    double *at = c->memory;
    c->count = n + 1;
    for (size_t k = 0; k <= n; k++) {
        size_t points = k ? fitted : measured;
        c->series[k] = (asp_series){ .label = k ? r->result[k - 1].model->name : "measured",
                                     .x = at, .y = at + points, .count = points };
        c->x[k] = at;
        c->y[k] = at + points;
        at += 2 * points;
    }
    return 1;
}

/* Draws and frees. */
static char *draw(curves *c, asp_chart *chart)
{
    asp_error err;
    chart->series = c->series;
    chart->series_count = c->count;
    chart->width = CHART_WIDTH;
    chart->height = CHART_HEIGHT;
    char *svg = asp_chart_svg(chart, &err);
    free(c->memory);
    return svg;
}

/* Highest of the measured curve and limits that show the part that matters, six decades of it. */
static void log_limits(const curves *c, asp_axis *axis)
{
    double high = 0, low = INFINITY;
    for (size_t i = 0; i < c->series[0].count; i++) {
        double y = c->series[0].y[i];
        if (y > high)
            high = y;
        if (y > 0 && y < low)
            low = y;
    }
    axis->scale = ASP_SCALE_LOG;
    if (!(high > 0))
        return;
    low = fmax(low, 1e-6 * high);
    axis->low = 0.5 * low;
    axis->high = 2.5 * high;
}

/* How far from the mirror direction the lobe is still worth seeing on a linear scale. */
static double lobe_width(const report *r)
{
    /* the median slope is alpha for GGX, and something like it for all */
    asp_vec3 m = asp_sample_normal(&r->result[r->best].material.ndf, 0.5, 0);
    return fmin(fmax(12 * atan2(hypot(m.x, m.y), m.z), 2 / DEGREES), 80 / DEGREES);
}

/* Circles have a white edge, with which many of them wipe each other out. */
static asp_marker measured_marker(size_t count)
{
    return count > 40 ? ASP_MARKER_CROSS : ASP_MARKER_CIRCLE;
}

static void measured_in_plane(const report *r, curves *c, double theta_i, double from, double to)
{
    double *x = c->x[0], *y = c->y[0];
    size_t n = 0;
    if (!r->info.scattered) {
        for (; n < DENSE; n++) {
            x[n] = c->series[1].x[n];
            y[n] = report_luminance(asp_measured_eval(r->measured, in_plane(-theta_i),
                                                      in_plane(x[n] / DEGREES)));
        }
    } else {
        for (size_t i = 0; i < r->geometries; i++) {
            double ti, t;
            if (plane_angles(&r->geometry[i], &ti, &t) && same_angle(ti, theta_i) && t >= from
                && t <= to) {
                x[n] = t * DEGREES;
                y[n++] = report_luminance(r->geometry[i].f);
            }
        }
        c->series[0].dash = ASP_DASH_NONE;
        c->series[0].marker = measured_marker(n);
    }
    c->series[0].count = n;
}

char *report_plane(const report *r, double theta_i, asp_scale scale)
{
    curves c;
    size_t measured = r->info.scattered ? r->geometries : DENSE;
    double from = -88 / DEGREES, to = 88 / DEGREES, width = lobe_width(r);
    if (scale == ASP_SCALE_LINEAR) {
        from = fmax(from, theta_i - width);
        to = fmin(to, theta_i + width);
    }
    if (!r->count || !curves_make(&c, r, measured, DENSE))
        return NULL;
    for (size_t k = 1; k < c.count; k++)
        for (size_t i = 0; i < DENSE; i++) {
            /* denser towards the mirror direction, from both sides */
            double s = 2.0 * (double)i / (DENSE - 1) - 1, side = s < 0 ? theta_i - from : to - theta_i;
            double t = theta_i + side * s * fabs(s);
            c.x[k][i] = t * DEGREES;
            c.y[k][i] = report_luminance(asp_eval(&r->result[k - 1].material, in_plane(-theta_i),
                                                       in_plane(t)));
        }
    measured_in_plane(r, &c, theta_i, from, to);
    char title[96];
    asp_rule mirror = { theta_i * DEGREES, 0, "mirror" };
    snprintf(title, sizeof title, "θ_{i} = %.4g°%s", theta_i * DEGREES,
             scale == ASP_SCALE_LINEAR ? ", around the mirror direction" : ", logarithmic");
    asp_chart chart = { .title = title, .x = { .label = "θ_{o} [deg]" },
                        .y = { .label = "f [1/sr]" }, .rules = &mirror, .rule_count = 1 };
    if (scale == ASP_SCALE_LOG)
        log_limits(&c, &chart.y);
    chart.x.low = from * DEGREES;
    chart.x.high = to * DEGREES;
    return draw(&c, &chart);
}

/* ------------------------------------------------------------------ along theta_h */

#define PROFILE 161
#define PROFILE_LOW 0.05       /* degrees */
#define BAND 4.0               /* listed geometries within so many degrees of theta_d */

/* theta_h, theta_d in radians of any pair of directions. */
void report_half_angles(const asp_measurement *m, double *theta_h, double *theta_d)
{
    double x = m->wi.x + m->wo.x, y = m->wi.y + m->wo.y, z = m->wi.z + m->wo.z;
    double length = sqrt(x * x + y * y + z * z);
    *theta_h = atan2(hypot(x, y), z);
    *theta_d = acos(fmin(1, length / 2));
}

/* The plane perpendicular to that of incidence: wi and wo are mirror images of each other. */
static asp_measurement across(double theta_h, double theta_d)
{
    asp_measurement m = { { sin(theta_h) * cos(theta_d), sin(theta_d), cos(theta_h) * cos(theta_d) },
                          { 0, 0, 0 }, { 0, 0, 0 } };
    m.wo = m.wi;
    m.wo.y = -m.wi.y;
    return m;
}

static size_t listed_profile(const report *r, curves *c, double theta_d)
{
    size_t n = 0;
    for (size_t i = 0; i < r->geometries; i++) {
        const asp_measurement *m = &r->geometry[i];
        double h, d;
        report_half_angles(m, &h, &d);
        if (fabs(d - theta_d) * DEGREES > BAND)
            continue;
        for (size_t k = 0; k < c->count; k++) {
            c->x[k][n] = fmax(h * DEGREES, 1.06 * REPORT_PROFILE_EDGE);
            c->y[k][n] = report_luminance(k ? asp_eval(&r->result[k - 1].material, m->wi, m->wo)
                                               : m->f);
        }
        n++;
    }
    for (size_t k = 0; k < c->count; k++) {
        c->series[k].count = n;
        c->series[k].dash = ASP_DASH_NONE;
        c->series[k].marker = k ? ASP_MARKER_DOT : measured_marker(n);
    }
    return n;
}

static size_t gridded_profile(const report *r, curves *c, double theta_d)
{
    size_t n = 0;
    for (size_t i = 0; i < PROFILE; i++) {
        double h = PROFILE_LOW * pow(85 / PROFILE_LOW, (double)i / (PROFILE - 1));
        asp_measurement m = across(h / DEGREES, theta_d);
        if (m.wi.z < 0.03)
            break;
        for (size_t k = 0; k < c->count; k++) {
            c->x[k][n] = h;
            c->y[k][n] = report_luminance(k ? asp_eval(&r->result[k - 1].material, m.wi, m.wo)
                                               : asp_measured_eval(r->measured, m.wi, m.wo));
        }
        n++;
    }
    for (size_t k = 0; k < c->count; k++)
        c->series[k].count = n;
    return n;
}

char *report_profile(const report *r, double theta_d)
{
    curves c;
    size_t room = r->info.scattered ? r->geometries : PROFILE;
    if (!curves_make(&c, r, room, room))
        return NULL;
    size_t n = r->info.scattered ? listed_profile(r, &c, theta_d) : gridded_profile(r, &c, theta_d);
    if (n < 15) {
        free(c.memory);
        return NULL;
    }
    char title[96];
    if (r->info.scattered)
        snprintf(title, sizeof title, "θ_{d} = %.4g° ± %.3g°", theta_d * DEGREES, BAND);
    else
        snprintf(title, sizeof title, "θ_{d} = %.4g°, φ_{d} = 90°", theta_d * DEGREES);
    asp_chart chart = { .title = title,
                        .x = { .label = "θ_{h} [deg]", .scale = ASP_SCALE_LOG },
                        .y = { .label = "f [1/sr]" } };
    log_limits(&c, &chart.y);
    chart.x.low = r->info.scattered ? REPORT_PROFILE_EDGE : PROFILE_LOW;
    chart.x.high = 90;
    return draw(&c, &chart);
}

/* ------------------------------------------------------------------ model over measured */

#define BINS 24
#define BIN_LOW 0.03           /* degrees; the first bin reaches down to 0 */
#define ENOUGH 8               /* geometries in a bin; in the first bin of a list one will do */

typedef struct sample { double theta_h, ratio; } sample;

static int by_ratio(const void *a, const void *b)
{
    double x = ((const sample *)a)->ratio, y = ((const sample *)b)->ratio;
    return (x > y) - (x < y);
}

/* One for each geometry with a value above 0. */
static size_t samples_of(const report *r, size_t k, sample *out)
{
    size_t n = 0;
    for (size_t i = 0; i < r->geometries; i++) {
        const asp_measurement *m = &r->geometry[i];
        double f = report_luminance(m->f), h, d;
        report_half_angles(m, &h, &d);
        if (f > 0)
            out[n++] = (sample){ h * DEGREES,
                                 report_luminance(asp_eval(&r->result[k].material, m->wi, m->wo)) / f };
    }
    return n;
}

static double bin_edge(int b)
{
    return BIN_LOW * pow(85 / BIN_LOW, (double)b / BINS);
}

/* The samples of a bin by their ratio; *enough: is there a median? */
static size_t bin_of(const report *r, const sample *s, size_t n, int b, sample *out, int *enough)
{
    double low = b ? bin_edge(b) : 0, high = bin_edge(b + 1);
    size_t inside = 0;
    for (size_t i = 0; i < n; i++)
        if (s[i].theta_h >= low && s[i].theta_h < high)
            out[inside++] = s[i];
    qsort(out, inside, sizeof *out, by_ratio);
    *enough = inside >= (b || !r->info.scattered ? ENOUGH : 1);
    return inside;
}

size_t report_left_out(const report *r, double *ratio)
{
    sample *s = malloc((r->geometries + 1) * sizeof *s);
    sample *left = malloc((r->geometries + 1) * sizeof *left);
    size_t count = 0, n = s && left ? samples_of(r, r->best, s) : 0;
    for (int b = 0; b < BINS && n; b++) {
        int enough;
        size_t inside = bin_of(r, s, n, b, left + count, &enough);
        count += enough ? 0 : inside;
    }
    if (count) {
        qsort(left, count, sizeof *left, by_ratio);
        *ratio = left[count / 2].ratio;
    }
    free(s);
    free(left);
    return count;
}

size_t report_at_edge(const report *r, double edge)
{
    size_t count = 0;
    for (size_t i = 0; i < r->geometries && r->info.scattered; i++) {
        double h, d;
        report_half_angles(&r->geometry[i], &h, &d);
        count += h * DEGREES < edge;
    }
    return count;
}

const asp_measurement *report_peak(const report *r)
{
    const asp_measurement *peak = r->geometry;
    for (size_t i = 1; i < r->geometries; i++)
        if (report_luminance(r->geometry[i].f) > report_luminance(peak->f))
            peak = &r->geometry[i];
    return peak;
}

/* Median and central 80 % of model/measured in bins of theta_h that hold enough geometries. */
char *report_ratio(const report *r)
{
    sample *s = malloc((r->geometries + 1) * sizeof *s);
    sample *bin = malloc((r->geometries + 1) * sizeof *bin);
    double (*out)[4][BINS] = malloc((r->count + 1) * sizeof *out);      /* x, median, low, high */
    asp_series series[SERIES];
    size_t count = r->count < SERIES ? r->count : SERIES;
    double least = 0.03, most = 30;
    char *svg = NULL;
    memset(series, 0, sizeof series);
    for (size_t k = 0; s && bin && out && k < count; k++) {
        size_t n = samples_of(r, k, s), used = 0;
        for (int b = 0; b < BINS; b++) {
            int enough;
            size_t inside = bin_of(r, s, n, b, bin, &enough);
            if (!enough)
                continue;
            double median = bin[inside / 2].ratio;
            least = median > 0 ? fmin(least, 0.6 * median) : least;
            most = fmax(most, 1.6 * median);
            out[k][0][used] = sqrt(bin_edge(b) * bin_edge(b + 1));
            out[k][1][used] = median;
            out[k][2][used] = bin[inside / 10].ratio;
            out[k][3][used++] = bin[inside - 1 - inside / 10].ratio;
        }
        series[k] = (asp_series){ .label = r->result[k].model->name, .x = out[k][0],
                                  .y = out[k][1], .count = used };
        if (r->info.scattered)
            series[k].marker = ASP_MARKER_DOT;
        if (k == r->best) {
            series[k].low = out[k][2];
            series[k].high = out[k][3];
        }
    }
    if (s && bin && out) {
        asp_rule one = { 1, 1, NULL };
        asp_chart chart = { .title = "fitted over measured",
                            .x = { .label = "θ_{h} [deg]", .scale = ASP_SCALE_LOG },
                            .y = { .label = "f fitted / f measured", .scale = ASP_SCALE_LOG,
                                   .low = fmax(least, 1e-4), .high = fmin(most, 1e4) },
                            .series = series, .series_count = count, .rules = &one, .rule_count = 1,
                            .width = 2 * CHART_WIDTH, .height = CHART_HEIGHT };
        asp_error err;
        svg = asp_chart_svg(&chart, &err);
    }
    free(s);
    free(bin);
    free(out);
    return svg;
}
