/* prepared_views.c - the tables of a prepared surface's samplers: plain normals, and slopes seen from below */
#include "ndf/prepared_make.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"

/* t at x in cells. */
static double prepared_share_of(double x)
{
    double z = PREPARED_SHARE_STEP * (x - PREPARED_SHARE_ZERO), s = z / (z < 0 ? PREPARED_WITHIN : PREPARED_BEYOND);
    return z / sqrt(1 - s * s);
}

double aspi_prepared_rho(double t)
{
    return t < 0 ? aspi_log1p_64(aspi_exp_64(t)) : t + aspi_log1p_64(aspi_exp_64(-t));
}

/* log of the radius at n + 1 values of t from the first to the last, from panels. */
static void prepared_radii(const prepared_panels *p, prepared_integrand *g, const void *context, int n, double *out)
{
    int i, panel = 0;
    for (i = 0; i <= n; i++) {
        double t = prepared_share_of((double)(i * PREPARED_SHARE_CELLS) / n);
        out[i] = aspi_prepared_radius(p, g, context, aspi_prepared_rho(t), &panel);
    }
}

/* d/dt at both ends of the n + 1 values. */
static void prepared_ends(const double *y, int n, double *first, double *last)
{
    const double low = PREPARED_SHARE_STEP * PREPARED_SHARE_ZERO / PREPARED_WITHIN;
    const double high = PREPARED_SHARE_STEP * (PREPARED_SHARE_CELLS - PREPARED_SHARE_ZERO) / PREPARED_BEYOND;
    double cell = PREPARED_SHARE_STEP * PREPARED_SHARE_CELLS / n, a = 1 - low * low, b = 1 - high * high;
    *first = aspi_prepared_end_slope(y, 1) / cell * a * sqrt(a);
    *last = -aspi_prepared_end_slope(y + n, -1) / cell * b * sqrt(b);
}

static void prepared_shares_spline(int n, const double *y, double *out)
{
    aspi_prepared_spline(n, 1, y, 1, aspi_prepared_end_slope(y, 1), -aspi_prepared_end_slope(y + n, -1), out, 1);
}

void aspi_prepared_normal_table(const prepared_source *s, double *table)
{
    const int n = PREPARED_NORMAL_CELLS;
    double y[PREPARED_NORMAL_CELLS + 1];
    prepared_panels rings;
    aspi_prepared_rings(s, &rings);
    prepared_radii(&rings, aspi_prepared_ring, s, n, y);
    prepared_shares_spline(n, y, table + PREPARED_NORMAL);
    prepared_ends(y, n, table + PREPARED_NORMAL_START, table + PREPARED_NORMAL_END);
}

/* ------------------------------------------------------------------ slopes seen from below */

prepared_sight aspi_prepared_sight(const prepared_source *s, double mu)
{
    prepared_sight sight;
    sight.s = s;
    sight.mu = mu;
    sight.base = aspi_prepared_base(s, mu);
    return sight;
}

double aspi_prepared_seen(const void *context, double t)
{
    const prepared_sight *v = (const prepared_sight *)context;
    double eta = aspi_exp_64(t), x = v->mu > 0 ? eta / v->mu : 1e9, z = x * x, bracket;
    bracket = x < 0.1 ? eta * z * (1.0 / 3 - z * (1.0 / 5 - z * (1.0 / 7 - z * (1.0 / 9 - z / 11))))
                      : eta - v->mu * aspi_atan_64(x, 1);
    return aspi_exp_64(aspi_prepared_log(v->s, v->mu * v->mu + eta * eta) - v->base) * eta * eta * bracket;
}

/* From far out down to past the peak and to where next to nothing is left. */
void aspi_prepared_sight_panels(const prepared_sight *sight, double t0, double longest, double least,
                               prepared_panels *out)
{
    double unit = 0.5 * aspi_log_64(sight->mu * sight->mu + t0 * t0), t = unit + 2, peak = 0;
    for (; t > sight->s->low; t -= 0.7) {
        double here = aspi_prepared_seen(sight, t);
        peak = aspi_max_64(peak, here);
        if (here < 1e-8 * peak)
            break;
    }
    aspi_prepared_integrate(aspi_prepared_seen, sight, t, sight->mu > 0 ? 5 : 3,
                            aspi_max_64(sight->s->high, unit + 10), longest, least, out);
}

/* A row of TAIL; returns log eta where PREPARED_CUT lies beyond. */
static double prepared_tail_row(const prepared_source *s, double t0, double mu, double *y)
{
    prepared_panels panels;
    prepared_sight sight = aspi_prepared_sight(s, mu);
    double unit = 0.5 * aspi_log_64(mu * mu + t0 * t0);
    int i, panel = 0;
    aspi_prepared_sight_panels(&sight, t0, .6, 1e-10, &panels);
    prepared_radii(&panels, aspi_prepared_seen, &sight, PREPARED_SHARE_CELLS, y);
    for (i = 0; i <= PREPARED_SHARE_CELLS; i++)
        y[i] -= unit;
    return aspi_prepared_radius(&panels, aspi_prepared_seen, &sight, -aspi_log_64(PREPARED_CUT), &panel);
}

void aspi_prepared_tail_table(const prepared_source *s, double t0, const double *mu, double *table)
{
    const int n = PREPARED_SHARE_CELLS, m = PREPARED_VIEW_CELLS, row = PREPARED_SHARE_ROW;
    double line[PREPARED_SHARE_CELLS + 1], half[(PREPARED_VIEW_CELLS + 1) * PREPARED_SHARE_ROW];
    int i;
    for (i = 0; i <= m; i++) {
        double cut = prepared_tail_row(s, t0, mu[i], line);
        if (i == 0) {
            table[PREPARED_EDGE] = aspi_exp_64(cut);
            prepared_ends(line, n, table + PREPARED_TAIL_START, table + PREPARED_TAIL_END);
            /* 1/3 edge-on, 1/5 for all others, next to nothing within a ring */
            table[PREPARED_TAIL_START] = aspi_min_64(table[PREPARED_TAIL_START], 0.25);
        }
        prepared_shares_spline(n, line, half + i * row);
    }
    for (i = 0; i < row; i++)
        aspi_prepared_spline(m, 1, half + i, row, aspi_prepared_end_slope(half + i, row),
                             -aspi_prepared_end_slope(half + i + m * row, -row), table + PREPARED_TAIL + i, row);
}
