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

double aspi_next(void *trial) { return aspi_uniform((aspi_trial *)trial); }

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

void aspi_histogram_edges(aspi_histogram *h, double *radii, size_t count, double phi0, double most)
{
    static const double tail[3] = { 0.97, 0.99, 0.997 };
    int i;
    memset(h, 0, sizeof *h);
    h->phi0 = phi0;
    h->typical = 1;
    qsort(radii, count, sizeof *radii, ascending);
    while (count > 1 && !(radii[count - 1] <= most))
        count--;
    for (i = 0; i < ASPI_RINGS - 1; i++) {
        double share = i < 12 ? (i + 1) / 12.6 : tail[i - 12];
        double edge = fmin(radii[(size_t)(share * (double)count)], most);
        double least = i > 0 ? h->edge[i - 1] * 1.0001 : 1e-30;
        h->edge[i] = edge > least ? edge : least;
    }
}

void aspi_histogram_blocks(aspi_histogram *h, const asp_lattice *lattice)
{
    int nx = 2 * (int)lattice->nx, ny = 2 * (int)lattice->ny;
    h->planar = 1;
    h->lattice = *lattice;
    h->block_x = (nx + ASPI_RINGS - 3) / (ASPI_RINGS - 2);
    h->block_y = (ny + ASPI_SECTORS - 2) / (ASPI_SECTORS - 1);
    /* odd blocks have their edges within cells, where a wrong share of a cell shows */
    h->block_x += h->block_x % 2 == 0;
    h->block_y += h->block_y % 2 == 0;
    h->blocks_x = (nx - 1) / h->block_x + 1;
}

/* The block of half cell (i, j). */
static int block_of(const aspi_histogram *h, double i, double j)
{
    if (!(i >= 0 && j >= 0 && i < 2.0 * (double)h->lattice.nx && j < 2.0 * (double)h->lattice.ny))
        return ASPI_CELLS - 1;
    return (int)j / h->block_y * h->blocks_x + (int)i / h->block_x;
}

static int cell_of(const aspi_histogram *h, double r, double phi)
{
    int ring = 0, sector;
    double turn;
    if (h->planar)
        return r < 1e60 ? block_of(h, 2 * (r * cos(phi) - h->lattice.x0) / h->lattice.dx,
                                   2 * (r * sin(phi) - h->lattice.y0) / h->lattice.dy)
                        : ASPI_CELLS - 1;
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
    h->carried[cell] += weight > 0;
}

/* ---- what a cell expects: Gauss's rule in (log r, phi), the rectangle cut in four until the rule
 * agrees with itself. The line where a visible density ends may cross a cell, and from below the mean
 * plane all of the density may stand in a corner of one. */

#define RULE 6

typedef struct rectangle { double s0, s1, phi0, phi1, density, value; } rectangle;

typedef struct integrand {
    const aspi_trial *t;
    aspi_facet_function *f;
    const void *context;
    double node[RULE], weight[RULE], tolerance, value_tolerance;
    int order, planar;        /* planar: s and phi of a rectangle are x and y */
} integrand;

/* Both at (x, y) of [0, 1]^2 in a rectangle, times `weight`. */
static void add_point(const integrand *q, rectangle *a, double x, double y, double weight)
{
    double s = a->s0 + (a->s1 - a->s0) * x, phi = a->phi0 + (a->phi1 - a->phi0) * y;
    double r = q->planar ? 1 : exp(s), d, v, jacobian;
    asp_vec2 p = q->planar ? aspi_map_slope(&q->t->ndf->map, s, phi)
                           : aspi_map_slope(&q->t->ndf->map, r * cos(phi), r * sin(phi));
    asp_vec3 m = aspi_unit(-p.x, -p.y, 1);
    q->f(q->context, m, &d, &v);
    jacobian = (m.z * r) * (m.z * r) * m.z * weight;
    a->density += d * jacobian;
    a->value += v * jacobian;
}

static void apply_rule(const integrand *q, rectangle *a)
{
    int i, j;
    a->density = a->value = 0;
    for (i = 0; i < q->order; i++)
        for (j = 0; j < q->order; j++)
            add_point(q, a, q->node[j], q->node[i], q->weight[i] * q->weight[j]);
    a->density *= q->t->det * (a->s1 - a->s0) * (a->phi1 - a->phi0);
    a->value *= q->t->det * (a->s1 - a->s0) * (a->phi1 - a->phi0);
}

/* A strip along an edge that all points of the rule miss, as of what sends light just above the horizon. */
static int has_strip(const integrand *q, const rectangle *a)
{
    rectangle corners = *a;
    corners.density = corners.value = 0;
    for (int i = 0; i < 4; i++)
        add_point(q, &corners, i & 1 ? 0.999 : 0.001, i & 2 ? 0.999 : 0.001, 1);
    return (a->density == 0 && corners.density > 0) || (a->value == 0 && corners.value > 0);
}

static void integrate(const integrand *q, rectangle *a, int depth)
{
    rectangle part[4];
    double sm = 0.5 * (a->s0 + a->s1), pm = 0.5 * (a->phi0 + a->phi1), density = 0, value = 0;
    int i;
    for (i = 0; i < 4; i++) {
        part[i].s0 = i & 1 ? sm : a->s0;
        part[i].s1 = i & 1 ? a->s1 : sm;
        part[i].phi0 = i & 2 ? pm : a->phi0;
        part[i].phi1 = i & 2 ? a->phi1 : pm;
        apply_rule(q, &part[i]);
        density += part[i].density;
        value += part[i].value;
    }
    if (depth > 0 && (fabs(density - a->density) > q->tolerance
                      || fabs(value - a->value) > q->value_tolerance
                      || ((density == 0 || value == 0) && has_strip(q, a)))) {
        density = value = 0;
        for (i = 0; i < 4; i++) {
            integrate(q, &part[i], depth - 1);
            density += part[i].density;
            value += part[i].value;
        }
    }
    a->density = density;
    a->value = value;
}

/* Half cells one by one: within a whole cell a visible density is linear. */
static double integrate_blocks(aspi_histogram *h, const integrand *q)
{
    const asp_lattice *l = &h->lattice;
    double inner = 0;
    int i, j;
    for (j = 0; j < 2 * (int)l->ny; j++)
        for (i = 0; i < 2 * (int)l->nx; i++) {
            rectangle a;
            int block = block_of(h, i, j);
            a.s0 = l->x0 + 0.5 * l->dx * i;
            a.s1 = l->x0 + 0.5 * l->dx * (i + 1);
            a.phi0 = l->y0 + 0.5 * l->dy * j;
            a.phi1 = l->y0 + 0.5 * l->dy * (j + 1);
            apply_rule(q, &a);
            integrate(q, &a, 8);
            h->density[block] += a.density;
            h->value[block] += a.value;
            inner += a.density;
        }
    return inner;
}

void aspi_histogram_integrate(aspi_histogram *h, const aspi_trial *t, aspi_facet_function *f,
                              const void *context)
{
    integrand q;
    double inner = 0;
    int ring, sector, panel;
    q.t = t;
    q.f = f;
    q.context = context;
    q.tolerance = 0.05 / (double)t->samples; /* a twentieth of a sample */
    q.value_tolerance = q.tolerance * h->typical;
    q.planar = h->planar;
    q.order = h->planar ? 2 : RULE;
    aspi_gauss(q.order, q.node, q.weight);
    if (h->planar)
        inner = integrate_blocks(h, &q);
    for (ring = 0; !h->planar && ring < ASPI_RINGS - 1; ring++) {
        /* the innermost ring reaches down to where an area is nothing, by panels that double: all
         * that is seen from far below the mean plane lies at its rim */
        double s1 = log(h->edge[ring]), s0 = ring ? log(h->edge[ring - 1]) : s1 - 16;
        int panels = ring ? 1 + (int)((s1 - s0) / 2) : 10;
        for (sector = 0; sector < ASPI_SECTORS; sector++) {
            int cell = ring * ASPI_SECTORS + sector;
            for (panel = 0; panel < panels; panel++) {
                rectangle a;
                a.s0 = ring ? s0 + (s1 - s0) * panel / panels
                            : s1 - (panel < 9 ? ldexp(16, panel - 9) : 16);
                a.s1 = ring ? s0 + (s1 - s0) * (panel + 1) / panels
                            : s1 - (panel > 0 ? ldexp(16, panel - 10) : 0);
                a.phi0 = h->phi0 + 2 * ASPI_PI * sector / ASPI_SECTORS;
                a.phi1 = h->phi0 + 2 * ASPI_PI * (sector + 1) / ASPI_SECTORS;
                apply_rule(&q, &a);
                integrate(&q, &a, 8);
                h->density[cell] += a.density;
                h->value[cell] += a.value;
            }
            inner += h->density[cell];
        }
    }
    /* what a density does not spend inside, it spends in the open cell */
    h->density[ASPI_CELLS - 1] = 1 - inner;
    h->value[ASPI_CELLS - 1] = NAN;
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

/* Sums of weights against integrals of eval. Cells are pooled until 100 samples in them carry a
 * weight: a sum of fewer has no Gaussian spread, and near the horizon most weights are 0. */
double aspi_histogram_weight_p(const aspi_histogram *h, double samples)
{
    double chi2 = 0, carried = 0, sum = 0, sum2 = 0, value = 0, all = 0, all2 = 0, typical;
    int i, cells = 0;
    for (i = 0; i < ASPI_CELLS - 1; i++) {
        all += h->sum[i];
        all2 += h->sum2[i];
    }
    typical = all > 0 ? all2 / all : 1; /* weight, where too few samples say what is usual */
    for (i = 0; i < ASPI_CELLS - 1; i++) {
        double variance, d;
        carried += h->carried[i];
        sum += h->sum[i];
        sum2 += h->sum2[i];
        value += samples * h->value[i];
        if (!(value == value) || !(sum == sum))
            return 0;
        /* enough of them, and not a few large weights among many small ones: (sum w)^2 / sum w^2 counts
         * those that matter */
        if ((carried < 100 || sum * sum < 60 * sum2) && i < ASPI_CELLS - 2)
            continue;
        d = sum - value;
        variance = sum2 - sum * sum / samples;
        /* at the end a pool may hold less: then its spread is at least that of 100 mean weights */
        if (carried < 100 || sum * sum < 60 * sum2)
            variance = fmax(fmax(variance, value * typical), 100 * (carried > 0 ? sum2 / fmin(carried, sum * sum / sum2) : 1));
        chi2 += d * d / variance;
        cells++;
        carried = sum = sum2 = value = 0;
    }
    return cells > 0 ? aspi_chi_square_p(chi2, cells) : 1;
}
