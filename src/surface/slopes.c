/* slopes.c - what the facets of a height field look like: moments, densities, best families */
#include "surface/surface.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- every facet once */

void aspi_each_facet(const asp_height_field *f, aspi_facet_visitor *visit, void *context)
{
    int last_x = f->periodic ? f->nx : f->nx - 1, last_y = f->periodic ? f->ny : f->ny - 1;
    for (int y = 0; y < last_y; ++y) {
        const float *row = f->heights + (size_t)y * (size_t)f->nx;
        const float *next = f->heights + (size_t)((y + 1) % f->ny) * (size_t)f->nx;
        for (int x = 0; x < last_x; ++x) {
            int x1 = (x + 1) % f->nx;
            aspi_slope s[2];
            aspi_square_slopes((x + y) & 1, (double)row[x], (double)row[x1], (double)next[x],
                               (double)next[x1], f->dx, f->dy, s);
            for (int i = 0; i < 2; ++i)
                if (isfinite(s[i].p) && isfinite(s[i].q))
                    visit(context, s[i]);
        }
    }
}

/* ---- moments */

typedef struct moments { size_t n; double p, q, pp, qq, pq; } moments;

static void add_moments(void *context, aspi_slope s)
{
    moments *m = context;
    ++m->n;
    m->p += s.p;
    m->q += s.q;
    m->pp += s.p * s.p;
    m->qq += s.q * s.q;
    m->pq += s.p * s.q;
}

/* ---- the distribution of |p - mean|^2, in bins even in its logarithm */

enum { BINS = 8192, PER_OCTAVE = 96, LOWEST = -60 };    /* 2^-60 .. 2^25 */

typedef struct radial {
    double mean_x, mean_y;
    double count[BINS], sum[BINS];
    double ring[90];
} radial;

static void add_radial(void *context, aspi_slope s)
{
    radial *r = context;
    double p = s.p - r->mean_x, q = s.q - r->mean_y, square = p * p + q * q;
    double at = square > 0 ? (log2(square) - LOWEST) * PER_OCTAVE : 0;
    int bin = at < 0 ? 0 : at > BINS - 1 ? BINS - 1 : (int)at;
    r->count[bin] += 1;
    r->sum[bin] += square;
    int degree = (int)(atan(sqrt(square)) * (180 / ASPI_PI));
    r->ring[degree > 89 ? 89 : degree] += 1;
}

/* ---- maximum likelihood of P22 = (1 + r^2/(n alpha^2))^-gamma / (pi alpha^2), n = gamma - 1 */

/* For given gamma: the stationary point in alpha^2 of the log-likelihood is the fixed point of
 * alpha^2 = gamma/n * mean(r^2 / (1 + r^2/(n alpha^2))), the EM step of the mixture. Returns the
 * mean log-likelihood. */
static double likelihood(const radial *r, double total, double mean_square, double gamma,
                         double *alpha)
{
    double n = gamma - 1, a2 = 0.5 * mean_square, sum;
    for (int step = 0; step < 400; ++step) {
        sum = 0;
        for (int i = 0; i < BINS; ++i)
            if (r->count[i] > 0)
                sum += r->sum[i] / (1 + r->sum[i] / (r->count[i] * n * a2));
        double next = gamma / n * sum / total;
        int done = fabs(next - a2) < 1e-10 * a2;
        a2 = next;
        if (done)
            break;
    }
    sum = 0;
    for (int i = 0; i < BINS; ++i)
        if (r->count[i] > 0)
            sum += r->count[i] * log1p(r->sum[i] / (r->count[i] * n * a2));
    *alpha = sqrt(a2);
    return -log(ASPI_PI * a2) - gamma * sum / total;
}

/* Golden section over 1/gamma: there the likelihood is smooth up to gamma = infinity. */
static void best_student(const radial *r, double total, double mean_square,
                         asp_slope_statistics *out)
{
    const double golden = 0.61803398874989485;
    double low = 0.01, high = 1 / 1.02, alpha;
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double fa = likelihood(r, total, mean_square, 1 / a, &alpha);
    double fb = likelihood(r, total, mean_square, 1 / b, &alpha);
    while (high - low > 1e-6) {
        if (fa > fb) {
            high = b;
            b = a;
            fb = fa;
            a = high - golden * (high - low);
            fa = likelihood(r, total, mean_square, 1 / a, &alpha);
        } else {
            low = a;
            a = b;
            fa = fb;
            b = low + golden * (high - low);
            fb = likelihood(r, total, mean_square, 1 / b, &alpha);
        }
    }
    double middle = 0.5 * (low + high);
    out->gamma = middle < 0.01 + 2e-6 ? 100 : 1 / middle;
    out->log_student = likelihood(r, total, mean_square, out->gamma, &out->alpha);
}

asp_status asp_height_field_slopes(const asp_height_field *field, asp_slope_statistics *out,
                                   asp_error *err)
{
    moments m = { 0 };
    aspi_each_facet(field, add_moments, &m);
    if (!m.n)
        return asp_fail(err, ASP_EINVAL, "heights", "no facet has three known corners");
    double n = (double)m.n;
    asp_slope_statistics s = { .facets = m.n, .mean_x = m.p / n, .mean_y = m.q / n };
    double xx = fmax(0, m.pp / n - s.mean_x * s.mean_x);
    double yy = fmax(0, m.qq / n - s.mean_y * s.mean_y);
    if (!(xx + yy > 0x1p-58))
        return asp_fail(err, ASP_EINVAL, "heights", "all facets lie flat");
    s.rms_x = sqrt(xx);
    s.rms_y = sqrt(yy);
    s.correlation = xx > 0 && yy > 0
                  ? fmax(-1, fmin(1, (m.pq / n - s.mean_x * s.mean_y) / sqrt(xx * yy))) : 0;

    radial *r = calloc(1, sizeof *r);
    if (!r)
        return asp_fail(err, ASP_ENOMEM, "slopes", "out of memory");
    r->mean_x = s.mean_x;
    r->mean_y = s.mean_y;
    aspi_each_facet(field, add_radial, r);
    for (int i = 0; i < 90; ++i) {
        double inner = tan(i * ASPI_PI / 180), outer = tan((i + 1) * ASPI_PI / 180);
        s.P22[i] = i < 89 ? r->ring[i] / (n * ASPI_PI * (outer * outer - inner * inner)) : 0;
    }
    s.alpha_beckmann = sqrt(xx + yy);
    s.log_beckmann = -log(ASPI_PI * (xx + yy)) - 1;
    s.log_ggx = likelihood(r, n, xx + yy, 2, &s.alpha_ggx);
    best_student(r, n, xx + yy, &s);
    free(r);
    *out = s;
    return ASP_OK;
}
