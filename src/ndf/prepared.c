/* prepared.c - the tables of a prepared surface, by quadrature
 *
 * All in float64 and with the kernels' own elementary functions, so that a prepared distribution has
 * the same bits on every machine. 0.7 to 1.5 ms. */
#include "ndf/prepared.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"

/* The density under preparation. */
typedef struct prepared_source {
    const asp_ndf *k;
    aspi_log_density *f;
    double log_mass;             /* of e^f */
    double low, high;            /* log r below which there is nothing, above which P22 is a power */
} prepared_source;

static double prepared_log(const prepared_source *s, double r2)
{
    return s->f(s->k, r2) - s->log_mass;
}

/* ------------------------------------------------------------------ splines */

#define PREPARED_MOST 196

/* Coefficients, divided by 6, of the cubic B-spline on n cells of width h with values y[0 ... n],
 * y[j] = value[j step], and slopes d0, d1 at the ends: out[0 ... n + 2], out_step apart. */
static void prepared_spline(int n, double h, const double *value, int step, double d0, double d1,
                            double *out, int out_step)
{
    double diagonal[PREPARED_MOST], right[PREPARED_MOST], c[PREPARED_MOST + 2];
    int i;
    /* c[i-1] + 4 c[i] + c[i+1] = y[i], c[1] - c[-1] = h d0/3 and likewise at the end */
    diagonal[0] = 4;
    right[0] = value[0] + h * d0 / 3;
    for (i = 1; i <= n; i++) {
        double above = i == 1 ? 2 : 1;                 /* entry right of the diagonal, row i - 1 */
        double below = i == n ? 2 : 1, m = below / diagonal[i - 1];
        double y = value[i * step] - (i == n ? h * d1 / 3 : 0);
        diagonal[i] = 4 - m * above;
        right[i] = y - m * right[i - 1];
    }
    c[n + 1] = right[n] / diagonal[n];
    for (i = n - 1; i >= 0; i--)
        c[i + 1] = (right[i] - (i == 0 ? 2 : 1) * c[i + 2]) / diagonal[i];
    c[0] = c[2] - h * d0 / 3;
    c[n + 2] = c[n] + h * d1 / 3;
    for (i = 0; i <= n + 2; i++)
        out[i * out_step] = c[i];
}

/* Slope at the first of five equidistant values, one cell apart; step < 0 looks back, and the slope
 * is then that of the way back. */
static double prepared_end_slope(const double *y, int step)
{
    return (-25.0 * y[0] + 48.0 * y[step] - 36.0 * y[2 * step] + 16.0 * y[3 * step]
            - 3.0 * y[4 * step]) / 12;
}

/* ------------------------------------------------------------------ radial mass
 *
 * Panels in the logarithm of a radius, short where the integrand falls steeply, each by Gauss's rule
 * of 4 nodes. */

#define PREPARED_PANELS 400

static const double gauss_node[2] = { 0.43056815579702629, 0.16999052179242813 };  /* from the middle */
static const double gauss_weight[2] = { 0.17392742256872693, 0.32607257743127307 };

typedef struct prepared_panels {
    int count;
    double edge[PREPARED_PANELS + 1];        /* log of the radius */
    double value[PREPARED_PANELS + 1];       /* integrand there, per unit of the logarithm */
    double mass[PREPARED_PANELS];
    double below[PREPARED_PANELS + 1], beyond[PREPARED_PANELS + 1];   /* cumulated */
} prepared_panels;

typedef double prepared_integrand(const void *context, double t);

static double prepared_panel(prepared_integrand *g, const void *context, double t, double h)
{
    double sum = 0;
    int j;
    for (j = 0; j < 2; j++)
        sum += gauss_weight[j] * (g(context, t + h * (0.5 - gauss_node[j]))
                                  + g(context, t + h * (0.5 + gauss_node[j])));
    return h * sum;
}

/* From t = `low`, below which the integrand is radius^power, up to where less than `least` of the sum is left or t = high; there the integrand
 * goes on as a power of the radius. */
static void prepared_integrate(prepared_integrand *g, const void *context, double low, double power,
                               double high, double longest, double least, prepared_panels *out)
{
    double t = low, value = g(context, t), sum = 0, h = longest, rest;
    int i;
    for (i = 0; i < PREPARED_PANELS && t < high; i++) {
        double next, ratio;
        for (;;) {
            next = g(context, t + h);
            ratio = next / value;
            if (ratio > 0.15 || h < 1e-3 || !(value > 0))
                break;
            h *= 0.5;
        }
        out->edge[i] = t;
        out->value[i] = value;
        out->mass[i] = prepared_panel(g, context, t, h);
        sum += out->mass[i];
        t += h;
        value = next;
        if (ratio > 0.4)
            h = aspi_min_64(2 * h, longest);
        if (next < least * sum && ratio < 0.999) {
            i++;
            break;
        }
    }
    out->count = i;
    out->edge[i] = t;
    out->value[i] = value;
    /* the power that the last panel follows */
    rest = 0;
    if (i > 0 && value > 0 && value < out->value[i - 1])
        rest = value * (t - out->edge[i - 1]) / aspi_log_64(out->value[i - 1] / value);
    out->beyond[i] = rest;
    while (i-- > 0)
        out->beyond[i] = out->beyond[i + 1] + out->mass[i];
    out->below[0] = out->value[0] / power;
    for (i = 0; i < out->count; i++)
        out->below[i + 1] = out->below[i] + out->mass[i];
}

/* -log of a share beyond, from the mass below or beyond. */
static double prepared_rho(const prepared_panels *p, double below, double beyond)
{
    double total = p->below[0] + p->beyond[0];
    return below < 0.5 * total ? -aspi_log1p_64(-below / total) : -aspi_log_64(beyond / total);
}

static double prepared_edge_rho(const prepared_panels *p, int i)
{
    return prepared_rho(p, p->below[i], p->beyond[i]);
}

/* log of the radius where -log of the share beyond is rho: Hermite's cubic over log rho, whose slope is known
 * (d rho/dt = value/beyond), then a step of Newton's with the integral up to there. `panel` is where to look
 * from; it moves on with growing rho. */
static double prepared_radius(const prepared_panels *p, prepared_integrand *g, const void *context,
                              double rho, int *panel)
{
    double r0, r1, x, h, a, b, d, t, mass;
    int i = *panel, n = p->count;
    while (i < n - 1 && prepared_edge_rho(p, i + 1) < rho)
        i++;
    *panel = i;
    r0 = prepared_edge_rho(p, i);
    r1 = prepared_edge_rho(p, i + 1);
    if (rho >= r1)                            /* beyond the last edge: a power */
        return p->edge[n] + (rho - r1) * p->beyond[n] / p->value[n];
    h = aspi_log_64(r1 / r0);
    x = aspi_log_64(rho / r0) / h;
    d = p->edge[i + 1] - p->edge[i];
    a = h * r0 * p->beyond[i] / p->value[i] - d;
    b = d - h * r1 * p->beyond[i + 1] / p->value[i + 1];
    t = p->edge[i] + x * d + x * (1 - x) * (a * (1 - x) + b * x);
    mass = prepared_panel(g, context, p->edge[i], t - p->edge[i]);
    r1 = prepared_rho(p, p->below[i] + mass, p->beyond[i] - mass);
    return t + aspi_log_64(rho / r1) * r1 * (p->beyond[i] - mass) / g(context, t);
}

/* ------------------------------------------------------------------ the four tables */

/* r^2 P22 2 pi: mass per unit of log r. */
static double prepared_ring(const void *context, double t)
{
    const prepared_source *s = (const prepared_source *)context;
    return 2 * ASP_PI * aspi_exp_64(prepared_log(s, aspi_exp_64(2 * t)) + 2 * t);
}

/* Where the mass lies: log r of the largest ring, from a coarse scan; returns log of that ring. */
static double prepared_scan(const prepared_source *s, double *at)
{
    double best = -1e300, t;
    for (t = -35; t <= 40; t += 0.5) {
        double x = prepared_log(s, aspi_exp_64(2 * t)) + 2 * t;
        if (x > best) {
            best = x;
            *at = t;
        }
    }
    return best;
}

static void prepared_rings(const prepared_source *s, prepared_panels *out)
{
    prepared_integrate(prepared_ring, s, s->low, 2, s->high, 0.4, 1e-18, out);
}

static void prepared_normal_table(const prepared_source *s, double *out)
{
    const int n = PREPARED_NORMAL_CELLS;
    const double h = PREPARED_Z_END / n;
    double y[PREPARED_NORMAL_CELLS + 1], e, z;
    prepared_panels rings;
    int i, panel = 0;
    prepared_rings(s, &rings);
    /* r^2/e -> 1/(pi P22(0)) */
    y[0] = -0.5 * (prepared_log(s, 0) + aspi_log_64(ASP_PI));
    for (i = 1; i <= n; i++) {
        z = i * h;
        e = z * z * z * z;
        y[i] = prepared_radius(&rings, prepared_ring, s, e, &panel) - 0.5 * aspi_log_64(e);
    }
    prepared_spline(n, 1, y, 1, 0, -prepared_end_slope(y + n, -1), out, 1);
}

/* x^2 and x^2 (x - atan x) for x = e^(j h), all j that occur. */
#define AREA_STEP 0.2
#define AREA_FIRST (-80)
#define AREA_LAST 400

typedef struct prepared_kernels {
    double x2[AREA_LAST - AREA_FIRST + 1], weight[AREA_LAST - AREA_FIRST + 1];
} prepared_kernels;

static void prepared_kernel(prepared_kernels *out)
{
    int j;
    for (j = AREA_FIRST; j <= AREA_LAST; j++) {
        double x = aspi_exp_64(AREA_STEP * j), z = x * x;
        out->x2[j - AREA_FIRST] = z;
        out->weight[j - AREA_FIRST] = z * (x < 0.1
            ? x * z * (1.0 / 3 - z * (1.0 / 5 - z * (1.0 / 7 - z * (1.0 / 9 - z / 11))))
            : x - aspi_atan_64(x, 1));
    }
}

/* log of J(mu)/P22(mu): J = integral of 2 P22(mu^2 + rho^2) rho^2 (rho - mu atan(rho/mu)) d log rho by the
 * trapezoidal rule, rho = mu e^(j h). Before the first term and beyond log rho = `high` the integrand is taken
 * for a power, whose terms are a geometric series. */
static double prepared_log_far(const prepared_source *s, const prepared_kernels *kernel, double mu)
{
    double m2 = mu * mu, base = prepared_log(s, m2), sum = 0, term = 0, last = 0, first = 0;
    double t = aspi_log_64(mu), end = aspi_max_64(s->high, t + 7);
    int j, start = (int)((s->low + 13 - t) / AREA_STEP);
    start = start < AREA_FIRST ? AREA_FIRST : start;
    for (j = start; j <= AREA_LAST; j++) {
        const int i = j - AREA_FIRST;
        last = term;
        term = aspi_exp_64(prepared_log(s, m2 + m2 * kernel->x2[i]) - base) * kernel->weight[i];
        sum += term;
        if (j == start)
            first = term;
        if (j == start + 1 && term > first)
            sum += first * first / (term - first);
        if (term < last && (term < 1e-10 * sum || t + AREA_STEP * j > end))
            break;
    }
    if (term > 0 && term < last)
        sum += term * term / (last - term);
    return aspi_log_64(2 * AREA_STEP * m2 * mu * sum);
}

/* The same at mu = 0: 2 P22 rho^3 per log rho. */
static double prepared_edge_on(const prepared_source *s)
{
    double sum = 0, term = 0, last = 0, t;
    for (t = s->low; t < 200; t += AREA_STEP) {
        last = term;
        term = aspi_exp_64(prepared_log(s, aspi_exp_64(2 * t)) + 3 * t);
        sum += term;
        if (term < last && (term < 1e-17 * sum || t > s->high))
            break;
    }
    if (term > 0 && term < last)
        sum += term * term / (last - term);
    return 2 * AREA_STEP * sum;
}

static void prepared_area_tables(const prepared_source *s, double t0, double *out)
{
    const int n = PREPARED_AREA_CELLS, m = PREPARED_BELOW_CELLS;
    prepared_kernels kernel;
    double area[PREPARED_AREA_CELLS + 1], below[PREPARED_BELOW_CELLS + 1];
    int i;
    prepared_kernel(&kernel);
    area[0] = 1;
    for (i = 1; i < n; i++) {
        double root = (double)i / (n - i), mu = t0 * root * root;
        area[i] = aspi_exp_64(prepared_log_far(s, &kernel, mu) + prepared_log(s, mu * mu))
                * (2 * (mu + sqrt(mu * mu + t0 * t0)) / (t0 * t0));
    }
    area[n] = (4 * area[n - 1] - area[n - 2]) / 3;
    prepared_spline(n, 1.0 / n, area, 1, 0, 0, out + PREPARED_AREA, 1);
    below[0] = aspi_log_64(0.5 / (t0 * t0)) - prepared_log(s, 0);
    for (i = 1; i < m; i++) {
        double root = (double)i / (m - i), mu = t0 * (root * root) * (root * root);
        /* where P22 is long gone the differences of its logarithm are, too */
        below[i] = prepared_log(s, mu * mu) < -1e7 ? below[i - 1]
                 : prepared_log_far(s, &kernel, mu) - 1.5 * aspi_log_64(mu * mu + t0 * t0);
    }
    below[m] = below[m - 1];
    prepared_spline(m, 1.0 / m, below, 1, 0, 0, out + PREPARED_BELOW, 1);
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
    return aspi_exp_64(prepared_log(v->s, v->mu * v->mu + eta * eta) - v->base) * eta * eta * bracket;
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
    view.base = prepared_log(s, view.mu * view.mu);
    unit = 0.5 * aspi_log_64(view.mu * view.mu + t0 * t0);
    prepared_integrate(prepared_seen, &view, prepared_seen_low(&view, unit + 2), view.mu > 0 ? 5 : 3,
                       aspi_max_64(s->high, unit + 10), 0.4, 1e-17, &panels);
    below = aspi_log_64(2 * (panels.below[0] + panels.beyond[0])) - 3 * unit;
    shift = PREPARED_STEEP(q * q) * below + unit;
    for (i = 1; i <= n; i++) {
        double z = i * h, rho = (z * z) * (z * z) * z;
        y[i] = prepared_radius(&panels, prepared_seen, &view, rho, &panel)
             - power * aspi_log_64(rho) - shift;
    }
    y[0] = 4 * y[1] - 6 * y[2] + 4 * y[3] - y[4];
    panel = 0;
    return prepared_radius(&panels, prepared_seen, &view, -aspi_log_64(PREPARED_CUT), &panel);
}

static void prepared_tail_table(const prepared_source *s, double t0, double *edge, double *out)
{
    const int n = PREPARED_TAIL_CELLS, m = PREPARED_VIEW_CELLS, row = PREPARED_TAIL_ROW;
    double y[(PREPARED_VIEW_CELLS + 1) * (PREPARED_TAIL_CELLS + 1)];
    double half[(PREPARED_VIEW_CELLS + 1) * PREPARED_TAIL_ROW];
    int i;
    for (i = 0; i <= m; i++) {
        double *line = y + i * (n + 1);
        double cut = prepared_tail_row(s, t0, PREPARED_VIEW_END * i / m, line);
        *edge = i == 0 ? aspi_exp_64(cut) : *edge;
        prepared_spline(n, 1, line, 1, prepared_end_slope(line, 1), -prepared_end_slope(line + n, -1),
                        half + i * row, 1);
    }
    for (i = 0; i < row; i++)
        prepared_spline(m, 1, half + i, row, prepared_end_slope(half + i, row),
                        -prepared_end_slope(half + i + m * row, -row), out + i, row);
}

typedef char prepared_tables_fit[PREPARED_END <= ASP_TABLE_NUMBERS ? 1 : -1];

asp_status aspi_prepared_make(asp_ndf *out, aspi_log_density *f, asp_error *err)
{
    prepared_source s;
    prepared_panels rings;
    double at = 0, t0;
    s.k = out;
    s.f = f;
    s.log_mass = 0;
    s.log_mass = prepared_scan(&s, &at);
    if (!(s.log_mass > -1e300))
        return asp_fail(err, ASP_EINVAL, "density", "it is not positive anywhere");
    s.low = at - 20;
    s.high = aspi_max_64(at, 0) + 8;
    prepared_rings(&s, &rings);
    s.log_mass += aspi_log_64(rings.below[0] + rings.beyond[0]);
    out->table[PREPARED_LOG_MASS] = s.log_mass;
    t0 = 2 * prepared_edge_on(&s);
    out->table[PREPARED_SCALE] = t0;
    out->table[PREPARED_SCALE2] = t0 * t0;
    prepared_normal_table(&s, out->table + PREPARED_NORMAL);
    prepared_area_tables(&s, t0, out->table);
    prepared_tail_table(&s, t0, &out->table[PREPARED_EDGE], out->table + PREPARED_TAIL);
    return ASP_OK;
}
