/* table.c - from counted rays to MERL's table
 *
 * A column is one cell of (theta_d, phi_d) with its fine cells of theta_h. Along theta_h they are
 * joined until the bins hold enough rays; log f of the bins is interpolated in theta_h^2 (in which the
 * lobe of a rough surface is nearly a straight line) and between columns. */
#include "surface/surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = ASPI_CELLS_D * ASPI_CELLS_PHI, MERL_H = 90, MERL_D = 90, MERL_PHI = 180 };

static const double WIDEST = 4 * ASPI_PI / 180;    /* a bin of theta_h grows no further ... */
static const double FEWEST = 64;                   /* ... once it holds a quarter of so many rays */

typedef struct fbin { double square, count, log_f[3], power; } fbin;
typedef struct column { int n; double end; fbin bins[ASPI_CELLS_H]; } column;

/* ---- the measure of a cell */

/* Cosines of both directions at half/difference angles: h = (sin, 0, cos) theta_h, d turned by it. */
static void cosines(double cos_h, double sin_h, double cos_d, double sin_d, double cos_phi,
                    double *ci, double *co)
{
    *ci = cos_h * cos_d - sin_h * sin_d * cos_phi;
    *co = cos_h * cos_d + sin_h * sin_d * cos_phi;
}

/* Integral over the cell of cos_i cos_o/pi dwi dwo. With dwi dwo = 4 cos(theta_d) dwh dwd (Walter et
 * al. 2007, eq. 14, for fixed h), and the azimuth of h integrated. Midpoint rule, zero where a
 * direction is below the horizon. phi_d stands for its four mirror images. *square becomes the mean
 * of theta_h^2 times the measure. */
static double measure(int i, int j, int k, double *square)
{
    enum { STEPS_H = 2, STEPS = 5 };
    double quarter = 0.5 * ASPI_PI, sum = 0, moment = 0;
    double step_d = quarter / (ASPI_CELLS_D * STEPS), step_phi = quarter / (ASPI_CELLS_PHI * STEPS);
    for (int a = 0; a < STEPS_H; ++a) {
        double root = (i + (a + 0.5) / STEPS_H) / ASPI_CELLS_H, theta = quarter * root * root;
        double width = quarter * 2 * root / (ASPI_CELLS_H * STEPS_H);
        double ch = cos(theta), sh = sin(theta), part = 0;
        for (int b = 0; b < STEPS; ++b) {
            double td = (j * STEPS + b + 0.5) * step_d, cd = cos(td), sd = sin(td);
            for (int c = 0; c < STEPS; ++c) {
                double ci, co;
                cosines(ch, sh, cd, sd, cos((k * STEPS + c + 0.5) * step_phi), &ci, &co);
                if (ci > 0 && co > 0)
                    part += ci * co * cd * sd;
            }
        }
        part *= sh * width * step_d * step_phi;
        sum += part;
        moment += part * theta * theta;
    }
    double scale = 4 * 4 * 2 * ASPI_PI / ASPI_PI;    /* Jacobian, mirror images, azimuth, 1/pi */
    *square = scale * moment;
    return scale * sum;
}

/* ---- columns */

typedef struct pending { double rays, power[3], measure, moment; } pending;

static void add_pending(pending *into, const pending *p)
{
    into->rays += p->rays;
    into->measure += p->measure;
    into->moment += p->moment;
    for (int c = 0; c < 3; ++c)
        into->power[c] += p->power[c];
}

static void put_bin(column *col, const pending *p, double rays)
{
    fbin *b = &col->bins[col->n++];
    *b = (fbin){ .square = p->moment / p->measure, .count = p->rays };
    for (int c = 0; c < 3; ++c) {
        /* no ray: half a ray is the least that can be told from nothing */
        double power = p->rays > 0 ? fmax(p->power[c], 1) : 0.5 * ASPI_WEIGHT_ONE;
        b->log_f[c] = log(power / (ASPI_WEIGHT_ONE * rays * p->measure));
        b->power += p->power[c];
    }
}

/* The end of a column holds too few rays for a bin: more of the same as the last bin, if their
 * number could be chance, else a bin of its own. */
static void put_rest(column *col, const pending *last, const pending *rest, double rays)
{
    double expected = last->measure > 0 ? last->rays / last->measure * rest->measure : 0;
    if (!col->n || fabs(rest->rays - expected) > 2 + 3 * sqrt(expected)) {
        put_bin(col, rest, rays);
        return;
    }
    pending both = *last;
    add_pending(&both, rest);
    --col->n;
    put_bin(col, &both, rays);
}

static const aspi_cell *column_cells(const aspi_counts *counts, int j, int k)
{
    return counts->cells + ((size_t)j * ASPI_CELLS_PHI + (size_t)k) * ASPI_CELLS_H;
}

/* Where the bins of a row (all columns of one theta_d) end: ends[i] says that one ends with fine
 * cell i. Equal counts where there is plenty, an eighth of what is still to come in the tail, so
 * that f changes little within a bin. The columns of a row share their ends because a column that
 * ended a bin when its own count is reached would do so after lucky cells, and read too high. */
static void row_ends(const aspi_counts *counts, int j, int ends[ASPI_CELLS_H])
{
    double cells[ASPI_CELLS_H] = { 0 }, left = 0, held = 0, from = 0;
    for (int k = 0; k < ASPI_CELLS_PHI; ++k)
        for (int i = 0; i < ASPI_CELLS_H; ++i)
            cells[i] += (double)column_cells(counts, j, k)[i].count / ASPI_CELLS_PHI;
    for (int i = 0; i < ASPI_CELLS_H; ++i)
        left += cells[i];
    double plenty = fmin(1600, left / 40);
    for (int i = 0; i < ASPI_CELLS_H; ++i) {
        double root = (i + 1.0) / ASPI_CELLS_H, theta = 0.5 * ASPI_PI * root * root;
        held += cells[i];
        ends[i] = held >= fmax(FEWEST, fmin(plenty, left / 8))
               || (theta - from > WIDEST && held >= FEWEST / 4);
        if (ends[i]) {
            left -= held;
            held = 0;
            from = theta;
        }
    }
}

static void make_column(const aspi_counts *counts, int j, int k, const int ends[ASPI_CELLS_H],
                        column *col)
{
    const aspi_cell *cells = column_cells(counts, j, k);
    double rays = (double)(counts->rays - counts->lost);
    pending p = { 0 }, last = { 0 };
    col->n = 0;
    for (int i = 0; i < ASPI_CELLS_H; ++i) {
        double moment, m = measure(i, j, k, &moment), root = (i + 1.0) / ASPI_CELLS_H;
        pending cell = { (double)cells[i].count, { (double)cells[i].r, (double)cells[i].g,
                                                   (double)cells[i].b }, m, moment };
        add_pending(&p, &cell);
        if (m > 0)
            col->end = 0.5 * ASPI_PI * root * root;
        if (p.measure > 0 && ends[i] && p.rays >= FEWEST / 8) {
            put_bin(col, &p, rays);
            last = p;
            p = (pending){ 0 };
        }
    }
    if (p.measure > 0 && (col->n || p.rays > 0))
        put_rest(col, &last, &p, rays);
}

/* log f of a column at theta_h^2 = square. Below the first bin along the slope of the first few, so
 * that the peak is not cut off; beyond the last one constant. */
static double column_log(const column *col, double square, int channel)
{
    const fbin *b = col->bins;
    int n = col->n, low = 0, high = n - 1;
    if (square >= b[high].square)
        return b[high].log_f[channel];
    if (square < b[0].square) {
        int far = high < 3 ? high : 3;
        double slope = far ? (b[far].log_f[channel] - b[0].log_f[channel])
                           / (b[far].square - b[0].square) : 0;
        return b[0].log_f[channel] + slope * (square - b[0].square);
    }
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (b[middle].square <= square)
            low = middle;
        else
            high = middle;
    }
    double t = (square - b[low].square) / (b[high].square - b[low].square);
    return b[low].log_f[channel] + t * (b[high].log_f[channel] - b[low].log_f[channel]);
}

/* ---- the table */

/* Neighbouring cells and weight of the upper one for the position `at` in units of cells. */
static double neighbours(double at, int n, int *low, int *high)
{
    double x = fmax(0, fmin(n - 1, at - 0.5));
    *low = (int)x;
    *high = *low < n - 1 ? *low + 1 : *low;
    return x - *low;
}

/* Bilinear over the columns that reach theta_h; 0 where none does. */
static int interpolate(const column *columns, double theta_h, double at_d, double at_phi,
                       double f[3])
{
    int j[2], k[2];
    double td = neighbours(at_d, ASPI_CELLS_D, &j[0], &j[1]);
    double tp = neighbours(at_phi, ASPI_CELLS_PHI, &k[0], &k[1]);
    double weights = 0, sum[3] = { 0, 0, 0 };
    for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b) {
            const column *col = &columns[j[a] * ASPI_CELLS_PHI + k[b]];
            double w = (a ? td : 1 - td) * (b ? tp : 1 - tp);
            if (!col->n || theta_h > col->end || !(w > 0))
                continue;
            weights += w;
            for (int c = 0; c < 3; ++c)
                sum[c] += w * column_log(col, theta_h * theta_h, c);
        }
    for (int c = 0; c < 3; ++c)
        f[c] = weights > 0 ? exp(sum[c] / weights) : -1;
    return weights > 0;
}

static void fill(const column *columns, double *values)
{
    const size_t plane = (size_t)MERL_H * MERL_D * MERL_PHI;
    for (int i = 0; i < MERL_H; ++i)
        for (int j = 0; j < MERL_D; ++j)
            for (int k = 0; k < MERL_PHI; ++k) {
                double root = (i + 0.5) / MERL_H, theta_h = 0.5 * ASPI_PI * root * root;
                double theta_d = 0.5 * ASPI_PI * (j + 0.5) / MERL_D;
                double phi = ASPI_PI * (k + 0.5) / MERL_PHI, f[3] = { -1, -1, -1 }, ci, co;
                double folded = phi < 0.5 * ASPI_PI ? phi : ASPI_PI - phi;
                cosines(cos(theta_h), sin(theta_h), cos(theta_d), sin(theta_d), cos(phi), &ci, &co);
                if (ci > 0 && co > 0)
                    interpolate(columns, theta_h, theta_d * ASPI_CELLS_D / (0.5 * ASPI_PI),
                                folded * ASPI_CELLS_PHI / (0.5 * ASPI_PI), f);
                size_t at = ((size_t)i * MERL_D + (size_t)j) * MERL_PHI + (size_t)k;
                for (size_t c = 0; c < 3; ++c)
                    values[c * plane + at] = f[c];
            }
}

/* ---- noise */

typedef struct share { double power, error; } share;

static int by_error(const void *a, const void *b)
{
    double x = ((const share *)a)->error, y = ((const share *)b)->error;
    return (x > y) - (x < y);
}

/* The counting error below which half of the power lies. */
static double median_error(const column *columns, size_t *cells)
{
    size_t n = 0, i = 0;
    double total = 0, below = 0;
    share *all = malloc(COLUMNS * (size_t)ASPI_CELLS_H * sizeof *all);
    if (!all)
        return -1;
    for (int c = 0; c < COLUMNS; ++c)
        for (int b = 0; b < columns[c].n; ++b) {
            const fbin *f = &columns[c].bins[b];
            all[n++] = (share){ f->power, 1 / sqrt(f->count) };
            total += f->power;
        }
    qsort(all, n, sizeof *all, by_error);
    while (i + 1 < n && (below += all[i].power) < 0.5 * total)
        ++i;
    double error = n ? all[i].error : 0;
    *cells = n;
    free(all);
    return error;
}

asp_status aspi_gonio_table(const aspi_counts *counts, double *values,
                            asp_fabrication_report *report, asp_error *err)
{
    column *columns = calloc(COLUMNS, sizeof *columns);
    if (!columns)
        return asp_fail(err, ASP_ENOMEM, "gonioreflectometer", "out of memory");
    for (int j = 0; j < ASPI_CELLS_D; ++j) {
        int ends[ASPI_CELLS_H];
        row_ends(counts, j, ends);
        for (int k = 0; k < ASPI_CELLS_PHI; ++k)
            make_column(counts, j, k, ends, &columns[j * ASPI_CELLS_PHI + k]);
    }
    fill(columns, values);
    report->noise = median_error(columns, &report->cells);
    free(columns);
    return report->noise < 0 ? asp_fail(err, ASP_ENOMEM, "gonioreflectometer", "out of memory")
                             : ASP_OK;
}
