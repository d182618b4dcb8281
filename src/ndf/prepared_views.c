/* prepared_views.c - the tables of a prepared surface's samplers: plain normals, and slopes seen from below */
#include "ndf/prepared_make.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"

void aspi_prepared_normal_table(const prepared_source *s, double *out)
{
    const int n = PREPARED_NORMAL_CELLS;
    const double h = PREPARED_Z_END / n;
    double y[PREPARED_NORMAL_CELLS + 1], e, z;
    prepared_panels rings;
    int i, panel = 0;
    aspi_prepared_rings(s, &rings);
    /* r^2/e -> 1/(pi P22(0)) */
    y[0] = -0.5 * (aspi_prepared_log(s, 0) + aspi_log_64(ASP_PI));
    for (i = 1; i <= n; i++) {
        z = i * h;
        e = z * z * z * z;
        y[i] = aspi_prepared_radius(&rings, aspi_prepared_ring, s, e, &panel) - 0.5 * aspi_log_64(e);
    }
    aspi_prepared_spline(n, 1, y, 1, 0, -aspi_prepared_end_slope(y + n, -1), out, 1);
}

/* ---- slopes seen from below: density P22(mu^2 + eta^2) eta (eta - mu atan(eta/mu)) of eta */

typedef struct prepared_view {
    const prepared_source *s;
    double mu, base;
} prepared_view;

static double prepared_seen(const void *context, double t)
{
    const prepared_view *v = (const prepared_view *)context;
    double eta = aspi_exp_64(t), x = v->mu > 0 ? eta / v->mu : 1e9, z = x * x, bracket;
    bracket = x < 0.1 ? eta * z * (1.0 / 3 - z * (1.0 / 5 - z * (1.0 / 7 - z * (1.0 / 9 - z / 11))))
                      : eta - v->mu * aspi_atan_64(x, 1);
    return aspi_exp_64(aspi_prepared_log(v->s, v->mu * v->mu + eta * eta) - v->base) * eta * eta * bracket;
}

/* log eta below which nothing is seen: from far out down to past the peak. */
static double prepared_seen_low(const prepared_view *view, double t)
{
    double here = prepared_seen(view, t), next;
    for (; t > view->s->low; t -= 0.7, here = next) {
        next = prepared_seen(view, t - 0.7);
        if (next < here)
            break;
    }
    return t - 8;
}

/* Returns log eta where PREPARED_CUT lies beyond. */
static double prepared_tail_row(const prepared_source *s, double t0, double v, double *y)
{
    const int n = PREPARED_TAIL_CELLS;
    const double h = PREPARED_TAIL_END / n;
    prepared_panels panels;
    prepared_view view;
    double root = v / (1 - v), q = root * root, power = PREPARED_POWER(q * q);
    double unit, below, shift;
    int i, panel = 0;
    view.s = s;
    view.mu = t0 * q;
    view.base = aspi_prepared_log(s, view.mu * view.mu);
    unit = 0.5 * aspi_log_64(view.mu * view.mu + t0 * t0);
    aspi_prepared_integrate(prepared_seen, &view, prepared_seen_low(&view, unit + 2), view.mu > 0 ? 5 : 3,
                       aspi_max_64(s->high, unit + 10), 0.4, 1e-17, &panels);
    below = aspi_log_64(2 * (panels.below[0] + panels.beyond[0])) - 3 * unit;
    shift = PREPARED_STEEP(q * q) * below + unit;
    for (i = 1; i <= n; i++) {
        double z = i * h, rho = (z * z) * (z * z) * z;
        y[i] = aspi_prepared_radius(&panels, prepared_seen, &view, rho, &panel)
             - power * aspi_log_64(rho) - shift;
    }
    y[0] = 4 * y[1] - 6 * y[2] + 4 * y[3] - y[4];
    panel = 0;
    return aspi_prepared_radius(&panels, prepared_seen, &view, -aspi_log_64(PREPARED_CUT), &panel);
}

void aspi_prepared_tail_table(const prepared_source *s, double t0, double *edge, double *out)
{
    const int n = PREPARED_TAIL_CELLS, m = PREPARED_VIEW_CELLS, row = PREPARED_TAIL_ROW;
    double y[(PREPARED_VIEW_CELLS + 1) * (PREPARED_TAIL_CELLS + 1)];
    double half[(PREPARED_VIEW_CELLS + 1) * PREPARED_TAIL_ROW];
    int i;
    for (i = 0; i <= m; i++) {
        double *line = y + i * (n + 1);
        double cut = prepared_tail_row(s, t0, PREPARED_VIEW_END * i / m, line);
        *edge = i == 0 ? aspi_exp_64(cut) : *edge;
        aspi_prepared_spline(n, 1, line, 1, aspi_prepared_end_slope(line, 1), -aspi_prepared_end_slope(line + n, -1),
                        half + i * row, 1);
    }
    for (i = 0; i < row; i++)
        aspi_prepared_spline(m, 1, half + i, row, aspi_prepared_end_slope(half + i, row),
                        -aspi_prepared_end_slope(half + i + m * row, -row), out + i, row);
}
