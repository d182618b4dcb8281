/* prepared_rows.c - which views get a row in TAIL
 *
 * Cubics between rows miss by the fourth derivative times the fourth power of their distance: rows
 * are as dense as its fourth root (de Boor 1973), as found at nodes far closer than the rows. */
#include "ndf/prepared_make.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"

#define ROWS_NODES 72
#define ROWS_SHARES 7
#define ROWS_SCAN 400
#define ROWS_FLOOR 1e-6          /* fourth differences that count for nothing; below, the nodes are not exact */

/* The largest mu worth a row: beyond, what is seen is too little for float64, or P22 a power. */
static double prepared_farthest(const prepared_source *s, double t0)
{
    const double step = 0.25;
    double from = aspi_log_64(t0), last = aspi_max_64(s->high + 1, from + 4), most = -1e300, far = from + 2;
    double t[ROWS_SCAN + 2], here[ROWS_SCAN + 2], power;
    int n = (int)aspi_min_64((last - from) / step, ROWS_SCAN - 1) + 1, i;
    for (i = 0; i <= n; i++)
        t[i] = from + step * i;
    aspi_prepared_along(s, (size_t)n + 1, t, here);
    power = here[n] - here[n - 1];
    for (i = 0; i < n; i++) {
        double falls = here[i + 1] - here[i] - power;
        most = aspi_max_64(most, here[i] + 3 * t[i]);
        if (here[i] + 3 * t[i] > most - 740 && (falls > 0.003 * step || falls < -0.003 * step))
            far = aspi_max_64(far, t[i]);
    }
    return aspi_exp_64(far);
}

/* Density of rows at every node, from fourth differences. */
static void prepared_density(const prepared_source *s, double t0, double near, double farthest,
                             double density[ROWS_NODES + 1])
{
    static const double share[ROWS_SHARES] = { -3, -1, 1, 3, 5, 7, 9 };
    static const double weight[ROWS_SHARES] = { 0.334, 0.551, 0.551, 0.334, 0.203, 0.123, 0.0742 };
    double y[ROWS_NODES + 1][ROWS_SHARES], rho[ROWS_SHARES], sum = 0;
    prepared_panels panels;
    int i, j;
    for (j = 0; j < ROWS_SHARES; j++)
        rho[j] = aspi_prepared_rho(share[j]);
    for (i = 0; i <= ROWS_NODES; i++) {
        double mu = near * aspi_expm1_64(farthest * aspi_max_64(i, 0.01) / ROWS_NODES);
        prepared_sight sight = aspi_prepared_sight(s, mu);
        double unit = 0.5 * aspi_log_64(mu * mu + t0 * t0);
        aspi_prepared_sight_panels(&sight, t0, 0.8, 1e-6, &panels);
        aspi_prepared_radii(&panels, aspi_prepared_seen, &sight, ROWS_SHARES, rho, y[i]);
        for (j = 0; j < ROWS_SHARES; j++)
            y[i][j] -= unit;
    }
    for (i = 2; i <= ROWS_NODES - 2; i++) {
        double size = 0;
        for (j = 0; j < ROWS_SHARES; j++) {
            double turn = j == 0 ? y[i][1] - y[i][0] : j == ROWS_SHARES - 1 ? y[i][j] - y[i][j - 1]
                        : 0.5 * (y[i][j + 1] - y[i][j - 1]);
            double d = y[i - 2][j] - 4 * y[i - 1][j] + 6 * y[i][j] - 4 * y[i + 1][j] + y[i + 2][j];
            size += weight[j] * weight[j] * (d * d) / aspi_max_64(turn, 1e-3);
        }
        density[i] = size < 1e300 ? sqrt(sqrt(aspi_max_64(sqrt(size) - ROWS_FLOOR, 0))) : 0;
        sum += density[i];
    }
    density[0] = density[1] = density[2];
    density[ROWS_NODES] = density[ROWS_NODES - 1] = density[ROWS_NODES - 2];
    sum = aspi_max_64(sum, 1e-100);
    for (i = 0; i <= ROWS_NODES; i++) {          /* and some rows for the rest, more of them near mu = 0 */
        double at = aspi_exp_64(-farthest * i / ROWS_NODES), at4 = (at * at) * (at * at);
        density[i] = density[i] / sum + 0.7 / ROWS_NODES * (0.5 + farthest * (0.3 * at + 0.8 * at4));
    }
}

/* Mean over nodes within `radius`, three times over. */
static void prepared_smooth(double radius, double *density)
{
    double from[ROWS_NODES + 1];
    int width = (int)(radius + 0.5), i, j, turn;
    for (turn = 0; turn < 3; turn++) {
        for (i = 0; i <= ROWS_NODES; i++)
            from[i] = density[i];
        for (i = 0; i <= ROWS_NODES; i++) {
            double sum = 0;
            for (j = i - width; j <= i + width; j++)
                sum += from[j < 0 ? 0 : j > ROWS_NODES ? ROWS_NODES : j];
            density[i] = sum / (2 * width + 1);
        }
    }
}

/* VIEWS and its slope at y, in cells. */
static double prepared_views_at(const double *c, double y, double *slope)
{
    int i = y < PREPARED_VIEWS_CELLS - 1 ? (int)y : PREPARED_VIEWS_CELLS - 1;
    double t, s;
    t = y - i;
    s = 1 - t;
    c += i;
    *slope = 3 * (s * s * (c[1] - c[0]) + (1 + 2 * t * s) * (c[2] - c[1]) + t * t * (c[3] - c[2]));
    return c[0] * (s * s * s) + c[1] * (4 - 3 * (t * t) * (2 - t)) + c[2] * (4 - 3 * (s * s) * (2 - s))
         + c[3] * (t * t * t);
}

void aspi_prepared_views(const prepared_source *s, double t0, double *table, double mu[PREPARED_VIEWS_MOST + 1])
{
    const int n = PREPARED_VIEWS_CELLS, rows = PREPARED_VIEW_CELLS(aspi_prepared_bent(s));
    double *c = table + PREPARED_VIEWS, density[ROWS_NODES + 1], sum[ROWS_NODES + 1], low, high, y = 0;
    /* slopes up to where the core ends, if that is within T0 */
    double core = aspi_exp_64(-0.5 * aspi_max_64(aspi_prepared_log(s, 0) + aspi_log_64(ASP_PI), -1400));
    double near = aspi_min_64(aspi_max_64(core, 1e-6 * t0), t0), slope;
    double farthest = aspi_log_64(1 + prepared_farthest(s, t0) / near);
    int i;
    table[PREPARED_NEAR] = near / t0;
    table[PREPARED_FARTHEST] = farthest;
    table[PREPARED_PER_VIEW] = n / farthest;
    prepared_density(s, t0, near, farthest, density);
    prepared_smooth(0.2 * ROWS_NODES / farthest, density);
    for (sum[0] = 0, i = 0; i < ROWS_NODES; i++)
        sum[i + 1] = sum[i] + 0.5 * (density[i] + density[i + 1]);
    /* their integral as coefficients: a monotone spline, near enough */
    for (i = 1; i <= n + 1; i++) {
        double x = (double)(i - 1) / n * ROWS_NODES;
        int k = (int)x < ROWS_NODES - 1 ? (int)x : ROWS_NODES - 1;
        c[i] = sum[k] + (x - k) * (sum[k + 1] - sum[k]);
    }
    c[0] = 2 * c[1] - c[2];
    c[n + 2] = 2 * c[n + 1] - c[n];
    low = prepared_views_at(c, 0, &slope);
    high = prepared_views_at(c, n, &slope);
    for (i = 0; i <= n + 2; i++)
        c[i] = (6 * c[i] - low) * rows / (6 * (high - low));
    mu[0] = 0;
    for (i = 1; i <= rows; i++) {
        double below = y, above = n, at;
        int turn;
        for (turn = 0; turn < 60; turn++) {      /* Newton's, kept within what is known */
            at = prepared_views_at(c, y, &slope);
            if (at < i)
                below = y;
            else
                above = y;
            at = y + (i - at) / slope;
            at = at > below && at < above ? at : 0.5 * (below + above);
            if (at - y < 1e-13 * n && y - at < 1e-13 * n)
                break;
            y = at;
        }
        mu[i] = near * aspi_expm1_64(y * farthest / n);
    }
}
