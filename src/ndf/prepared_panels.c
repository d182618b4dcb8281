/* prepared_panels.c - integrals over a radius in panels, and where a share of one lies
 *
 * Panels in the logarithm of the radius, short where the integrand falls steeply, each by Gauss's rule of 4
 * nodes. Integrands are asked for arrays, so that they run in vectors: all panels that are too long are halved
 * at a time, then all nodes of all panels are computed. */
#include "ndf/prepared_make.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"

/* From the start of a panel of length 1. */
static const double gauss_node[4] = { 0.5 - 0.43056815579702629, 0.5 - 0.16999052179242813,
                                      0.5 + 0.16999052179242813, 0.5 + 0.43056815579702629 };
static const double gauss_weight[2] = { 0.17392742256872693, 0.32607257743127307 };

#define PANELS_CHUNK 16          /* panels that are looked at together on the way out, */
#define PANELS_SUMMED 64         /* and that are summed together */

/* ------------------------------------------------------------------ panels */

/* Below `nothing` nothing has to be told from nothing. */
static int panels_too_long(double length, double from, double to, double nothing)
{
    return length >= 1e-3 && from > 0 && (from > nothing || to > nothing)
        && (to <= 0.15 * from || (to >= 60 * from && from >= 1e-12 * to));
}

static int panels_halve(prepared_integrand *g, const void *context, double nothing, int n, double *edge,
                        double *value)
{
    double middle[PREPARED_PANELS], found[PREPARED_PANELS];
    int after[PREPARED_PANELS], more = 0, i;
    for (i = 0; i < n && n + more < PREPARED_PANELS; i++)
        if (panels_too_long(edge[i + 1] - edge[i], value[i], value[i + 1], nothing)) {
            after[more] = i;
            middle[more++] = 0.5 * (edge[i] + edge[i + 1]);
        }
    if (more == 0)
        return n;
    g(context, (size_t)more, middle, found);
    n += more;
    for (i = n; more > 0; i--) {
        if (after[more - 1] == i - more) {
            more--;
            edge[i] = middle[more];
            value[i] = found[more];
        } else {
            edge[i] = edge[i - more];
            value[i] = value[i - more];
        }
    }
    return n;
}

/* The panel after which less than `least` of the sum is left and the integrand falls; n: not among these. */
static int panels_end(int n, const double *edge, const double *value, double least)
{
    double sum = 0;
    int i;
    for (i = 0; i < n; i++) {
        sum += 0.5 * (value[i] + value[i + 1]) * (edge[i + 1] - edge[i]);
        if (value[i + 1] < least * sum && value[i + 1] < 0.999 * value[i])
            return i + 1;
    }
    return n;
}

static void panels_sums(prepared_integrand *g, const void *context, int n, const double *edge, double *mass)
{
    double t[4 * PANELS_SUMMED], found[4 * PANELS_SUMMED];
    int from, i, j;
    for (from = 0; from < n; from += PANELS_SUMMED) {
        int m = n - from < PANELS_SUMMED ? n - from : PANELS_SUMMED;
        const double *e = edge + from;
        for (j = 0; j < 4; j++)
            for (i = 0; i < m; i++)
                t[j * m + i] = e[i] + gauss_node[j] * (e[i + 1] - e[i]);
        g(context, 4 * (size_t)m, t, found);
        for (i = 0; i < m; i++)
            mass[from + i] = (e[i + 1] - e[i]) * (gauss_weight[0] * (found[i] + found[3 * m + i])
                                                  + gauss_weight[1] * (found[m + i] + found[2 * m + i]));
    }
}

void aspi_prepared_integrate(prepared_integrand *g, const void *context, double low, double power, double high,
                             double longest, double least, prepared_panels *out)
{
    double *edge = out->edge, *value = out->value, most = 0, rest = 0;
    int n = 0, last, i;
    edge[0] = low;
    for (;;) {
        int more = aspi_min_64(PANELS_CHUNK, (high - low) / longest + 1 - n);
        more = more < PREPARED_PANELS * 3 / 4 - n ? more : PREPARED_PANELS * 3 / 4 - n;
        for (i = n; i <= n + more; i++)
            edge[i] = low + longest * i;
        g(context, (size_t)more + 1, edge + n, value + n);
        n += more;
        last = panels_end(n, edge, value, least);
        if (last < n || more < PANELS_CHUNK)
            break;
    }
    n = last;
    for (i = 0; i <= n; i++)
        most = aspi_max_64(most, value[i]);
    do {
        last = n;
        n = panels_halve(g, context, 1e-3 * least * most, n, edge, value);
    } while (n > last);
    n = panels_end(n, edge, value, least);
    panels_sums(g, context, n, edge, out->mass);
    out->count = n;
    /* the power that the last panel follows */
    if (n > 0 && value[n] > 0 && value[n] < value[n - 1])
        rest = value[n] * (edge[n] - edge[n - 1]) / aspi_log_64(value[n - 1] / value[n]);
    out->beyond[n] = rest;
    for (i = n; i-- > 0; )
        out->beyond[i] = out->beyond[i + 1] + out->mass[i];
    out->below[0] = value[0] / power;
    for (i = 0; i < n; i++)
        out->below[i + 1] = out->below[i] + out->mass[i];
}

/* ------------------------------------------------------------------ where a share lies */

/* -log of the share beyond, from the masses below and beyond. */
ASP_FN double panels_rho(double below, double beyond, double total)
{
    double near = -aspi_log1p_64(-aspi_min_64(below / total, 0.75)), far = -aspi_log_64(beyond / total);
    return aspi_select_64(below < 0.5 * total, near, far);
}

ASP_CLONES static void panels_rhos(size_t n, double total, const double *ASP_RESTRICT below,
                                   const double *ASP_RESTRICT beyond, double *ASP_RESTRICT out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = panels_rho(below[i], beyond[i], total);
}

/* Where shares are looked for: the panel's start and length, rho at its ends, d t/d rho there, the masses below
 * and beyond its start. */
typedef struct panels_search {
    double start[PREPARED_SHARES], length[PREPARED_SHARES], rho0[PREPARED_SHARES], rho1[PREPARED_SHARES];
    double turn0[PREPARED_SHARES], turn1[PREPARED_SHARES], below[PREPARED_SHARES], beyond[PREPARED_SHARES];
} panels_search;

/* Hermite's cubic over log rho, whose slope is known: d rho/dt = value/beyond. */
ASP_CLONES static void panels_guess(size_t n, const panels_search *q, const double *ASP_RESTRICT rho,
                                    double *ASP_RESTRICT t)
{
    size_t i;
    for (i = 0; i < n; i++) {
        double h = aspi_log_64(q->rho1[i] / q->rho0[i]), x = aspi_min_64(aspi_log_64(rho[i] / q->rho0[i]) / h, 1);
        double a = h * q->rho0[i] * q->turn0[i] - q->length[i], b = q->length[i] - h * q->rho1[i] * q->turn1[i];
        t[i] = q->start[i] + x * q->length[i] + x * (1 - x) * (a * (1 - x) + b * x);
    }
}

/* A step of Newton's in log rho, with the mass from the panel's start to t and the integrand there. */
ASP_CLONES static void panels_newton(size_t n, double total, const panels_search *q, const double *ASP_RESTRICT rho,
                                     const double *ASP_RESTRICT mass, const double *ASP_RESTRICT value,
                                     double *ASP_RESTRICT t)
{
    size_t i;
    for (i = 0; i < n; i++) {
        double beyond = q->beyond[i] - mass[i], found = panels_rho(q->below[i] + mass[i], beyond, total);
        t[i] += aspi_log_64(rho[i] / found) * found * beyond / value[i];
    }
}

void aspi_prepared_radii(const prepared_panels *p, prepared_integrand *g, const void *context, int n,
                         const double *rho, double *out)
{
    double edge_rho[PREPARED_PANELS + 1], t[5 * PREPARED_SHARES], found[5 * PREPARED_SHARES];
    double mass[PREPARED_SHARES], total = p->below[0] + p->beyond[0];
    panels_search q;
    int last = p->count, panel = 0, i, j;
    if (n < 1)
        return;
    panels_rhos((size_t)last + 1, total, p->below, p->beyond, edge_rho);
    for (i = 0; i < n; i++) {
        while (panel < last - 1 && edge_rho[panel + 1] < rho[i])
            panel++;
        q.start[i] = p->edge[panel];
        q.length[i] = p->edge[panel + 1] - p->edge[panel];
        q.rho0[i] = edge_rho[panel];
        q.rho1[i] = edge_rho[panel + 1];
        q.turn0[i] = p->beyond[panel] / p->value[panel];
        q.turn1[i] = p->beyond[panel + 1] / p->value[panel + 1];
        q.below[i] = p->below[panel];
        q.beyond[i] = p->beyond[panel];
    }
    panels_guess((size_t)n, &q, rho, out);
    for (i = 0; i < n; i++)
        for (j = 0; j < 5; j++)
            t[j * n + i] = j == 4 ? out[i] : q.start[i] + gauss_node[j] * (out[i] - q.start[i]);
    g(context, 5 * (size_t)n, t, found);
    for (i = 0; i < n; i++)
        mass[i] = (out[i] - q.start[i]) * (gauss_weight[0] * (found[i] + found[3 * n + i])
                                           + gauss_weight[1] * (found[n + i] + found[2 * n + i]));
    panels_newton((size_t)n, total, &q, rho, mass, found + 4 * n, out);
    for (i = 0; i < n; i++)                   /* beyond the last edge: a power */
        if (rho[i] >= edge_rho[last])
            out[i] = p->edge[last] + (rho[i] - edge_rho[last]) * p->beyond[last] / p->value[last];
}
