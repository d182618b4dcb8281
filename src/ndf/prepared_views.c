/* prepared_views.c - the tables of a prepared surface's samplers: plain normals, and slopes seen from below */
#include "ndf/prepared_make.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"
#include "ndf/pieces.h"

/* t at x in cells. */
static double prepared_share_of(int bent, int x)
{
    double z = PREPARED_SHARE_STEP(bent) * (x - PREPARED_SHARE_ZERO(bent)), s = z / (z < 0 ? PREPARED_WITHIN : PREPARED_BEYOND);
    return z / sqrt(1 - s * s);
}

double aspi_prepared_rho(double t)
{
    return t < 0 ? aspi_log1p_64(aspi_exp_64(t)) : t + aspi_log1p_64(aspi_exp_64(-t));
}

/* d/dt at both ends of a row. */
static void prepared_ends(const double *y, int bent, double *first, double *last)
{
    const double cell = PREPARED_SHARE_STEP(bent), low = cell * PREPARED_SHARE_ZERO(bent) / PREPARED_WITHIN;
    const int n = PREPARED_SHARE_CELLS(bent);
    double high = cell * (n - PREPARED_SHARE_ZERO(bent)) / PREPARED_BEYOND, a = 1 - low * low, b = 1 - high * high;
    *first = aspi_prepared_end_slope(y, 1) / cell * a * sqrt(a);
    *last = -aspi_prepared_end_slope(y + n, -1) / cell * b * sqrt(b);
}

static void prepared_shares_spline(int n, const double *y, double *out)
{
    aspi_prepared_spline(n, 1, y, 1, aspi_prepared_end_slope(y, 1), -aspi_prepared_end_slope(y + n, -1), out, 1);
}

/* Radii at odds x^2, growing; their share within is x^2/(1 + x^2). */
static void prepared_normals_at(const prepared_source *s, const prepared_panels *rings, int n, const double *x,
                                double *out)
{
    double rho[PREPARED_SHARES];
    int from, count, i;
    for (from = 0; from < n; from += count) {
        count = n - from < PREPARED_SHARES ? n - from : PREPARED_SHARES;
        for (i = 0; i < count; i++)
            rho[i] = aspi_log1p_64(x[from + i] * x[from + i]);
        aspi_prepared_radii(rings, aspi_prepared_ring, s, count, rho, out + from);
    }
    for (i = 0; i < n; i++)
        out[i] = aspi_exp_64(out[i]);
}

/* Each piece is the polynomial through seven points, the last of them the first of the next piece. */
#define NORMAL_STEP (ASP_PIECES_TERMS - 1)
#define NORMAL_POINTS (ASP_PIECES * NORMAL_STEP + 1)

void aspi_prepared_normal_table(const prepared_source *s, double *table)
{
    double x[NORMAL_POINTS + 1], r[NORMAL_POINTS + 1], first = 0;
    const double *last = r + NORMAL_POINTS - 1;
    prepared_panels rings;
    int i, j;
    for (i = 0; i < ASP_PIECES; i++) {
        double end = i < ASP_PIECES - 1 ? aspi_prepared_half_octave(PREPARED_NORMAL_OCTAVE, i + 1)
                                        : PREPARED_NORMAL_LAST;
        for (j = 0; j <= NORMAL_STEP; j++)
            x[i * NORMAL_STEP + j] = aspi_prepared_node(first, end, j);
        first = end;
    }
    x[0] = 1e-7;
    x[NORMAL_POINTS] = 2 * PREPARED_NORMAL_LAST;
    aspi_prepared_rings(s, &rings);
    prepared_normals_at(s, &rings, NORMAL_POINTS + 1, x, r);
    for (i = 0; i < ASP_PIECES; i++) {
        const double *at = x + i * NORMAL_STEP;
        double center = (double)(float)(0.5 * (at[0] + at[NORMAL_STEP]));
        aspi_prepared_piece_put(at, r + i * NORMAL_STEP, center, table + PREPARED_NORMAL, i);
    }
    table[PREPARED_NORMAL_END] = aspi_log_64(last[1] / last[0]) / aspi_log_64(2);
}

/* ------------------------------------------------------------------ slopes seen from below */

/* A row of TAIL from -log of the shares beyond its cells, of which the last is PREPARED_CUT; returns log eta there. */
static double prepared_tail_row(const prepared_source *s, double t0, double mu, int n, const double *rho, double *y)
{
    prepared_panels panels;
    prepared_sight sight = aspi_prepared_sight(s, mu);
    double unit = 0.5 * aspi_log_64(mu * mu + t0 * t0), cut;
    int i;
    aspi_prepared_sight_panels(&sight, t0, 0.6 / aspi_prepared_finer(s), 1e-10, &panels);
    aspi_prepared_radii(&panels, aspi_prepared_seen, &sight, n, rho, y);
    for (i = 0; i < n; i++)
        y[i] -= unit;
    aspi_prepared_radii(&panels, aspi_prepared_seen, &sight, 1, rho + n, &cut);
    return cut;
}

void aspi_prepared_tail_table(const prepared_source *s, double t0, const double *mu, double *table)
{
    const int bent = aspi_prepared_bent(s), n = PREPARED_SHARE_CELLS(bent), m = PREPARED_VIEW_CELLS(bent), row = n + 3;
    double rho[PREPARED_CELLS_MOST + 2], line[PREPARED_CELLS_MOST + 1], half[PREPARED_END - PREPARED_TAIL];
    int i;
    for (i = 0; i <= n; i++)
        rho[i] = aspi_prepared_rho(prepared_share_of(bent, i));
    rho[n + 1] = -aspi_log_64(PREPARED_CUT);
    for (i = 0; i <= m; i++) {
        double cut = prepared_tail_row(s, t0, mu[i], n + 1, rho, line);
        if (i == 0) {
            table[PREPARED_EDGE] = aspi_exp_64(cut);
            prepared_ends(line, bent, table + PREPARED_TAIL_START, table + PREPARED_TAIL_END);
            /* 1/3 edge-on, 1/5 for all others, next to nothing within a ring */
            table[PREPARED_TAIL_START] = aspi_min_64(table[PREPARED_TAIL_START], 0.25);
        }
        prepared_shares_spline(n, line, half + i * row);
    }
    for (i = 0; i < row; i++)
        aspi_prepared_spline(m, 1, half + i, row, aspi_prepared_end_slope(half + i, row),
                             -aspi_prepared_end_slope(half + i + m * row, -row), table + PREPARED_TAIL + i, row);
}
