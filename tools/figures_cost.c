/* figures_cost.c - Figure 4 of the STD paper: what evaluation costs
 *
 * Times differ from machine to machine and from run to run, so no test compares them. With --cost the
 * figure is drawn from its own numbers, NAME.csv of an earlier run, and then it is the same everywhere. */
#define _XOPEN_SOURCE 700
#include "asperity_study.h"
#include "csv.h"
#include "figures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define ASP_PRECISION 64
#include "asperity/elementary.h"

enum { COUNT = 1024, ROUNDS = 7 };

/* ------------------------------------------------------------------ what is timed */

typedef struct setup {
    double x[COUNT], y[COUNT], z[COUNT], mx[COUNT], my[COUNT], mz[COUNT], u1[COUNT], u2[COUNT];
    double out[3][COUNT];
    asp_ndf ndf;
    const char *form;
    double gamma, sigma;
    int failed;
} setup;

typedef void timed(setup *s);

static void masking_batch(setup *s)
{
    asp_lambda_n(&s->ndf, COUNT, (asp_cvec3s){ s->x, s->y, s->z }, 0, s->out[0]);
}

static void masking_single(setup *s)
{
    for (int i = 0; i < COUNT; i++)
        s->out[0][i] = asp_lambda(&s->ndf, (asp_vec3){ s->x[i], s->y[i], s->z[i] }, 0);
}

static void masking_form(setup *s)
{
    for (int i = 0; i < COUNT; i++) {
        double across = sqrt(s->x[i] * s->x[i] + s->y[i] * s->y[i]);
        s->failed |= asp_student_lambda(s->form, s->gamma, s->z[i] / (s->sigma * across),
                                        &s->out[0][i], NULL) != ASP_OK;
    }
}

/* Distribution, masking and a sample, as in the paper's first row. */
static void everything(setup *s)
{
    asp_cvec3s w = { s->x, s->y, s->z }, m = { s->mx, s->my, s->mz };
    asp_D_n(&s->ndf, COUNT, m, s->out[0]);
    asp_G1_n(&s->ndf, COUNT, w, 0, s->out[1]);
    asp_sample_visible_n(&s->ndf, COUNT, w, s->u1, s->u2,
                         (asp_vec3s){ s->out[0], s->out[1], s->out[2] });
}

/* ------------------------------------------------------------------ the clock */

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Nanoseconds per direction: the shortest of several rounds, each long enough for the clock. */
static double nanoseconds(timed *work, setup *s)
{
    double best = INFINITY;
    int repeats = 1;
    for (int round = 0; round < ROUNDS;) {
        double start = now();
        for (int i = 0; i < repeats; i++)
            work(s);
        double spent = now() - start;
        if (spent < 1e-4) {
            repeats *= 2;
            continue;
        }
        best = fmin(best, spent / repeats);
        round++;
    }
    return 1e9 * best / COUNT;
}

/* Directions and numbers that are spread evenly (additive recurrence of the plastic number). */
static void fill(setup *s)
{
    for (int i = 0; i < COUNT; i++) {
        double a = fmod(0.5 + 0.7548776662466927 * i, 1), b = fmod(0.5 + 0.5698402909980532 * i, 1);
        asp_v2 turn = aspi_sincos2pi(a);
        s->z[i] = 0.02 + 0.97 * b;
        s->mz[i] = 1 - 0.4 * fmod(a + b, 1);
        double across = sqrt(1 - s->z[i] * s->z[i]), m_across = sqrt(1 - s->mz[i] * s->mz[i]);
        s->x[i] = across * turn.x;
        s->y[i] = across * turn.y;
        s->mx[i] = m_across * turn.y;
        s->my[i] = m_across * turn.x;
        s->u1[i] = a;
        s->u2[i] = b;
    }
}

/* ------------------------------------------------------------------ the curves */

enum { ALL, INTEGERS, HALVES, FLAT };
enum { MASKING, EVERYTHING, ROUGHNESS };

static const double gammas[] = { 1.51, 1.75, 2, 2.5, 3, 3.5, 4, 4.5, 5, 6, 6.5, 8, 10, 10.5, 12, 15, 15.5,
                                 20, 20.5, 30, 40 };
static const double sigmas[] = { 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1, 1.5 };
enum { GAMMAS = sizeof gammas / sizeof *gammas, SIGMAS = sizeof sigmas / sizeof *sigmas };

static const struct row {
    int panel;
    const char *label, *model, *form, *colour;
    int where;
    timed *work;
    asp_dash dash;
} rows[] = {
    { MASKING, "exact, batch", "student_t", NULL, "student_t", ALL, masking_batch, ASP_DASH_SOLID },
    { MASKING, "exact, single", "student_t", NULL, "student_t", ALL, masking_single, ASP_DASH_LONG },
    { MASKING, "eq. 13", NULL, "hypergeometric", "#e69f00", ALL, masking_form, ASP_DASH_SOLID },
    { MASKING, "eq. 21, integer", NULL, "integer", "#56b4e9", INTEGERS, masking_form,
      ASP_DASH_SHORT },
    { MASKING, "eq. 21, half integer", NULL, "half_integer", "#770011", HALVES, masking_form,
      ASP_DASH_SHORT },
    { MASKING, "eq. 22, rational", NULL, "rational", "#cc79a7", ALL, masking_form, ASP_DASH_DOTS },
    { MASKING, "beckmann, batch", "beckmann", NULL, "beckmann", FLAT, masking_batch, ASP_DASH_LONG },
    { MASKING, "ggx, batch", "ggx", NULL, "ggx", FLAT, masking_batch, ASP_DASH_SOLID },
    { EVERYTHING, "student_t", "student_t", NULL, "student_t", ALL, everything, ASP_DASH_SOLID },
    { EVERYTHING, "beckmann", "beckmann", NULL, "beckmann", FLAT, everything, ASP_DASH_LONG },
    { EVERYTHING, "ggx", "ggx", NULL, "ggx", FLAT, everything, ASP_DASH_SOLID },
    { ROUGHNESS, "student_t, gamma = 3.7", "student_t", NULL, "student_t", ALL, everything,
      ASP_DASH_SOLID },
    { ROUGHNESS, "beckmann", "beckmann", NULL, "beckmann", ALL, everything, ASP_DASH_LONG },
    { ROUGHNESS, "ggx", "ggx", NULL, "ggx", ALL, everything, ASP_DASH_SOLID },
};
enum { ROWS = sizeof rows / sizeof *rows };

/* The values of gamma, or sigma, of a row. */
static size_t places(const struct row *r, double *out)
{
    size_t n = 0;
    if (r->panel == ROUGHNESS) {
        memcpy(out, sigmas, sizeof sigmas);
        return SIGMAS;
    }
    for (size_t i = 0; i < GAMMAS; i++) {
        double twice = 2 * gammas[i];
        int whole = twice == floor(twice), even = fmod(twice, 2) == 0;
        if (r->where == ALL || (r->where == INTEGERS && whole && even)
            || (r->where == HALVES && whole && !even) || (r->where == FLAT && (i == 0 || i + 1 == GAMMAS)))
            out[n++] = gammas[i];
    }
    return n;
}

static int measure(const struct row *r, double at, setup *s, double *out)
{
    char spec[96];
    s->sigma = r->panel == ROUGHNESS ? at : 0.3;
    s->gamma = r->panel == ROUGHNESS ? 3.7 : at;
    s->form = r->form;
    if (r->model) {
        int student = strcmp(r->model, "student_t") == 0;
        size_t n = (size_t)snprintf(spec, sizeof spec, "%s:alpha=", r->model);
        n += aspi_format_number(s->sigma, 17, spec + n);
        spec[n] = 0;
        if (student) {
            n += (size_t)snprintf(spec + n, sizeof spec - n, ",gamma=");
            n += aspi_format_number(s->gamma, 9, spec + n);
            spec[n] = 0;
        }
        int status = figure_ndf(spec, &s->ndf);
        if (status != CMD_OK)
            return status;
    }
    *out = nanoseconds(r->work, s);
    return s->failed ? cmd_failed("std-4: %s at gamma = %g cannot be evaluated", r->form, at) : CMD_OK;
}

/* ------------------------------------------------------------------ numbers of an earlier run */

static int put_number(const csv *table, drawing *d, const char *panel, const char *label,
                      const double at[2])
{
    for (size_t p = 0; p < d->panel_count; p++)
        for (size_t c = 0; c < d->panels[p].curve_count; c++) {
            figure_curve *curve = &d->panels[p].curves[c];
            if (strcmp(d->panels[p].title, panel) != 0 || strcmp(curve->label, label) != 0)
                continue;
            for (size_t i = 0; i < curve->count; i++)
                if (fabs(curve->x[i] - at[0]) < 1e-9 * at[0]) {
                    curve->y[i] = at[1];
                    return CMD_OK;
                }
        }
    return cmd_failed("%s: line %lld: not a row of std-4's numbers", table->name, table->number);
}

static int read_numbers(const char *path, const char *x_name, drawing *d)
{
    csv table;
    cmd_out aside = { .standard = 0 };
    char panel[120], label[80];
    double at[2];
    csv_row row;
    int status = csv_open(&table, path, &aside);
    if (status != CMD_OK)
        return status;
    int wanted[] = { csv_find(&table, x_name), csv_find(&table, "value") };
    int texts[] = { csv_find(&table, "panel"), csv_find(&table, "curve") };
    if (wanted[0] < 0 || wanted[1] < 0 || texts[0] < 0 || texts[1] < 0)
        status = cmd_failed("%s: these are not std-4's numbers: the columns are panel, quantity, curve, "
                            "%s, value", path, x_name);
    while (status == CMD_OK && (row = csv_next(&table)) != CSV_END) {
        if (row == CSV_BROKEN || (row == CSV_CELLS && csv_numbers(&table, wanted, 2, at)))
            status = CMD_FAILED;
        else if (row == CSV_CELLS) {
            csv_text(&table, texts[0], panel, sizeof panel);
            csv_text(&table, texts[1], label, sizeof label);
            status = put_number(&table, d, panel, label, at);
        }
    }
    csv_close(&table);
    for (size_t p = 0; p < d->panel_count; p++)
        for (size_t c = 0; status == CMD_OK && c < d->panels[p].curve_count; c++)
            for (size_t i = 0; status == CMD_OK && i < d->panels[p].curves[c].count; i++)
                if (isnan(d->panels[p].curves[c].y[i]))
                    status = cmd_failed("%s: no number for %s, %s, %g", path, d->panels[p].title,
                                        d->panels[p].curves[c].label, d->panels[p].curves[c].x[i]);
    return status;
}

/* ------------------------------------------------------------------ the figure */

static void lay_out(drawing *d)
{
    static const struct { const char *title, *x, *quantity; } panels[] = {
        { "Lambda, sigma = 0.3", "gamma", "Lambda" },
        { "D, G_{1} and a visible normal, sigma = 0.3", "gamma", "D, G1, visible" },
        { "D, G_{1} and a visible normal", "sigma", "D, G1, visible" },
    };
    d->columns = 3;
    d->width = 460;
    d->height = 420;
    for (int i = 0; i < 3; i++) {
        figure_panel *p = drawing_panel(d, panels[i].title, panels[i].x, "per direction [ns]",
                                        panels[i].quantity);
        p->x.scale = ASP_SCALE_LOG;
        p->x.low = i < 2 ? 1.5 : 0.05;
        p->x.high = i < 2 ? 40 : 1.5;
        p->y.scale = i ? ASP_SCALE_LINEAR : ASP_SCALE_LOG;
        p->legend = ASP_LEGEND_BELOW;
    }
    for (int r = 0; r < ROWS; r++) {
        double at[GAMMAS];
        size_t n = places(&rows[r], at);
        figure_curve *c = drawing_curve(d, &d->panels[rows[r].panel], n, rows[r].label);
        if (!c)
            return;
        snprintf(c->legend, sizeof c->legend, "%s", rows[r].label);
        snprintf(c->colour, sizeof c->colour, "%s", rows[r].colour);
        c->dash = rows[r].dash;
        for (size_t i = 0; i < n; i++) {
            c->x[i] = at[i];
            c->y[i] = NAN;
        }
    }
}

static int measure_all(const figure_job *job)
{
    size_t next[3] = { 0, 0, 0 };
    setup *s = calloc(1, sizeof *s);
    int status = s ? CMD_OK : cmd_failed("out of memory");
    if (s)
        fill(s);
    for (int r = 0; status == CMD_OK && r < ROWS; r++) {
        figure_curve *c = &job->out->panels[rows[r].panel].curves[next[rows[r].panel]++];
        double shared = NAN;
        for (size_t i = 0; status == CMD_OK && i < c->count; i++) {
            if (rows[r].where != FLAT || i == 0)         /* it knows no gamma */
                status = measure(&rows[r], c->x[i], s, &shared);
            c->y[i] = shared;
        }
        figure_progress(job, (double)(r + 1) / ROWS);
    }
    free(s);
    return status;
}

int figures_cost(const figure *f, const figure_job *job)
{
    const char *numbers = cmd_text(job->args, "cost");
    drawing *d = job->out;
    int status = CMD_OK;
    lay_out(d);
    if (d->broken)
        return cmd_failed("out of memory");
    status = numbers ? read_numbers(numbers, f->x_name, d) : measure_all(job);
    for (size_t p = 0; status == CMD_OK && p < d->panel_count; p++) {
        double highest = 0;
        for (size_t c = 0; c < d->panels[p].curve_count; c++)
            for (size_t i = 0; i < d->panels[p].curves[c].count; i++)
                highest = fmax(highest, d->panels[p].curves[c].y[i]);
        if (d->panels[p].y.scale == ASP_SCALE_LINEAR)
            d->panels[p].y.high = 1.1 * highest;
    }
    return status;
}
