/* statistics.c - random numbers, chi-square, histograms of facets */
#include "laws/laws.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ------------------------------------------------------------------ random numbers */

/* splitmix64 (Steele, Lea, Flood 2014). */
double aspi_uniform(aspi_trial *t)
{
    uint64_t z = (t->state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return (double)(z >> 11) * 0x1p-53;
}

asp_vec3 aspi_random_direction(aspi_trial *t)
{
    double z = 2 * aspi_uniform(t) - 1, phi = 2 * ASPI_PI * aspi_uniform(t);
    double s = sqrt(1 - z * z);
    return aspi_unit(s * cos(phi), s * sin(phi), z);
}

asp_vec3 aspi_random_facet(aspi_trial *t)
{
    double u1 = aspi_uniform(t), u2 = aspi_uniform(t), r, phi;
    asp_vec3 m = asp_sample_normal(t->ndf, u1, u2);
    asp_vec2 p;
    if (aspi_uniform(t) < 0.75 && m.z > 1e-6)
        return m;
    r = t->scale * exp(9 * aspi_uniform(t) - 3);
    phi = 2 * ASPI_PI * aspi_uniform(t);
    p = aspi_map_slope(&t->ndf->map, r * cos(phi), r * sin(phi));
    return aspi_unit(-p.x, -p.y, 1);
}

/* ------------------------------------------------------------------ chi-square */

/* Regularised incomplete gamma functions: the series of P below a + 1, Lentz's continued fraction
 * of Q above (Abramowitz, Stegun 6.5.29, 6.5.31). */
double aspi_chi_square_p(double chi2, double dof)
{
    double a = 0.5 * dof, x = 0.5 * chi2, front;
    int i;
    if (!(x > 0))
        return 1;
    if (!(x < 1e6))
        return 0;
    front = exp(a * log(x) - x - lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (i = 1; i < 10000 && term > sum * 1e-17; i++) {
            term *= x / (a + i);
            sum += term;
        }
        return 1 - front * sum;
    } else {
        double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
        for (i = 1; i < 10000; i++) {
            double an = -i * (i - a), delta;
            b += 2;
            d = 1 / (an * d + b);
            c = b + an / c;
            delta = c * d;
            h *= delta;
            if (fabs(delta - 1) < 1e-15)
                break;
        }
        return front * h;
    }
}

double aspi_sidak(double p, size_t tests)
{
    double all = -expm1((double)tests * log1p(-(p < 1 ? p : 1 - 1e-16)));
    return all > 1e-300 ? -log10(all) : 300;
}

/* ------------------------------------------------------------------ histograms */

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void aspi_histogram_edges(aspi_histogram *h, double *radii, size_t count, double phi0)
{
    static const double tail[3] = { 0.97, 0.99, 0.997 };
    int i;
    memset(h, 0, sizeof *h);
    h->phi0 = phi0;
    qsort(radii, count, sizeof *radii, ascending);
    for (i = 0; i < ASPI_RINGS - 1; i++) {
        double share = i < 12 ? (i + 1) / 12.6 : tail[i - 12];
        double edge = radii[(size_t)(share * (double)count)];
        double least = i > 0 ? h->edge[i - 1] * 1.0001 : 1e-30;
        edge = edge < 1e60 ? edge : 1e60;
        h->edge[i] = edge > least ? edge : least;
    }
}

static int cell_of(const aspi_histogram *h, double r, double phi)
{
    int ring = 0, sector;
    double turn;
    while (ring < ASPI_RINGS - 1 && !(r < h->edge[ring]))
        ring++;
    if (ring == ASPI_RINGS - 1)
        return ASPI_CELLS - 1;
    turn = (phi - h->phi0) / (2 * ASPI_PI);
    turn -= floor(turn);
    sector = (int)(turn * ASPI_SECTORS);
    return ring * ASPI_SECTORS + (sector < ASPI_SECTORS ? sector : ASPI_SECTORS - 1);
}

void aspi_histogram_add(aspi_histogram *h, const asp_ndf *ndf, asp_vec3 m, double weight)
{
    double r, phi;
    int cell;
    aspi_standard_polar(ndf, m, &r, &phi);
    cell = cell_of(h, r, phi);
    h->count[cell] += 1;
    h->sum[cell] += weight;
    h->sum2[cell] += weight * weight;
}

/* Over a ring: Gauss's rule in r or, where the ring spans scales, in log r by panels of e^1.5. */
void aspi_histogram_integrate(aspi_histogram *h, const aspi_trial *t, aspi_facet_function *f,
                              const void *context)
{
    enum { N = 6 };
    double node[N], weight[N], inner_density = 0, inner_value = 0;
    int ring, sector, panel, i, j;
    aspi_gauss(N, node, weight);
    for (ring = 0; ring < ASPI_RINGS - 1; ring++) {
        double r0 = ring ? h->edge[ring - 1] : 0, r1 = h->edge[ring];
        double span = ring ? log(r1 / r0) : 0;
        int panels = ring ? 1 + (int)(span / 1.5) : 1;
        for (sector = 0; sector < ASPI_SECTORS; sector++) {
            double sum = 0, other = 0;
            int cell = ring * ASPI_SECTORS + sector;
            for (panel = 0; panel < panels; panel++)
                for (i = 0; i < N; i++)
                    for (j = 0; j < N; j++) {
                        double phi = h->phi0 + 2 * ASPI_PI * (sector + node[i]) / ASPI_SECTORS;
                        double x = (panel + node[j]) / panels, r, step, jacobian, d, v;
                        asp_vec2 p;
                        asp_vec3 m;
                        r = ring ? r0 * exp(span * x) : r1 * x;
                        step = (ring ? r * span / panels : r1) * weight[i] * weight[j]
                             * 2 * ASPI_PI / ASPI_SECTORS;
                        p = aspi_map_slope(&t->ndf->map, r * cos(phi), r * sin(phi));
                        m = aspi_unit(-p.x, -p.y, 1);
                        f(context, m, &d, &v);
                        jacobian = (m.z * r) * m.z * m.z * t->det * step;
                        sum += d * jacobian;
                        other += v * jacobian;
                    }
            h->density[cell] = sum;
            h->value[cell] = other;
            inner_density += sum;
            inner_value += other;
        }
    }
    /* what a density does not spend inside, it spends in the open cell */
    h->density[ASPI_CELLS - 1] = 1 - inner_density;
    h->value[ASPI_CELLS - 1] = NAN;
    (void)inner_value;
}

/* Pearson's statistic. Neighbours that expect fewer than 8 are pooled until they do; what is left at
 * the end joins the open cell, whose expectation may be negative by rounding. */
double aspi_histogram_count_p(const aspi_histogram *h, double samples)
{
    double chi2 = 0, seen = 0, expected = 0;
    int i, cells = 0;
    for (i = 0; i < ASPI_CELLS; i++) {
        double d;
        seen += h->count[i];
        expected += samples * h->density[i];
        if (!(expected == expected))
            return 0;
        if (expected < 8 && i < ASPI_CELLS - 1)
            continue;
        d = seen - expected;
        /* too few for the statistic, and still refused what they cannot have */
        chi2 += d * d / fmax(expected, 8);
        cells++;
        seen = expected = 0;
    }
    return cells > 1 ? aspi_chi_square_p(chi2, cells - 1) : 0;
}

double aspi_histogram_weight_p(const aspi_histogram *h, double samples)
{
    double chi2 = 0;
    int i, cells = 0;
    for (i = 0; i < ASPI_CELLS - 1; i++) {
        double mean = h->sum[i] / samples;
        double variance = h->sum2[i] - samples * mean * mean;
        double d = h->sum[i] - samples * h->value[i];
        if (!(d == d))
            return 0;
        if (h->count[i] < 100 || !(variance > 0)) {
            /* no sample carries a weight, but eval says that some should */
            if (h->count[i] >= 100 && samples * h->value[i] > 25)
                return 0;
            continue;
        }
        chi2 += d * d / variance;
        cells++;
    }
    return cells > 0 ? aspi_chi_square_p(chi2, cells) : 1;
}
