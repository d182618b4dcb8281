/* quadrature.c - integrals over slopes
 *
 * Three tools: a sum over log-spaced radii that neither small roughness nor a heavy tail can
 * escape, sigma by it, and the directional albedo by adaptive cubature. */
#include "laws/laws.h"

#include <math.h>
#include <stdlib.h>

void aspi_gauss(int n, double *node, double *weight)
{
    int i, k, step;
    for (i = 0; i < n; i++) {
        double x = cos(ASPI_PI * (i + 0.75) / (n + 0.5)), slope = 1;
        for (step = 0; step < 60; step++) { /* Newton on P_n by its three-term recurrence */
            double p0 = 1, p1 = x, dx;
            for (k = 2; k <= n; k++) {
                double p2 = ((2 * k - 1) * x * p1 - (k - 1) * p0) / k;
                p0 = p1;
                p1 = p2;
            }
            slope = n * (x * p1 - p0) / (x * x - 1);
            dx = p1 / slope;
            x -= dx;
            if (fabs(dx) < 1e-16)
                break;
        }
        node[i] = 0.5 * (1 - x);
        weight[i] = 1 / ((1 - x * x) * slope * slope);
    }
}

/* ------------------------------------------------------------------ log-radial sums */

/* From 1e-20 to 1e60: below, an area element is gone; above, D of a facet that steep is 0 by rule. h = 1/8
 * leaves exp(-2 pi (pi/2)/h), 1e-34, of a function with poles at r = i like GGX, 1e-17 of one with
 * features ten times sharper. */
#define RADIAL_STEP 0.125
#define RADIAL_FIRST (-46.0)
#define RADIAL_NODES 1474
#define RADIAL_FIT 160

double aspi_radial_integral(aspi_radial_function *f, const void *context)
{
    double sum = 0, lost = 0, last = 0, before = 0, total;
    int i;
    for (i = 0; i < RADIAL_NODES; i++) {
        double g = f(context, exp(RADIAL_FIRST + RADIAL_STEP * i), i);
        double y = g - lost, s = sum + y; /* Kahan: a sum of 1474 terms keeps its last digits */
        lost = (s - sum) - y;
        sum = s;
        if (i == RADIAL_NODES - 1 - RADIAL_FIT)
            before = g;
        last = g;
    }
    total = sum;
    /* a power of r is a geometric series in log r: g q + g q^2 + ... = g q / (1 - q) */
    if (last > 0 && last > sum * 1e-18 && before > last) {
        double log_q = log(last / before) / RADIAL_FIT;
        total += last * exp(log_q) / -expm1(log_q);
    }
    return total * RADIAL_STEP;
}

/* ------------------------------------------------------------------ sigma
 *
 * With x a slope along the view and mu = w/s, K(mu) = E[max(0, mu - x)] = mu + E[max(0, x - mu)],
 * and in polar slopes r^2 = mu^2 + rho^2 the second part is
 *     J(mu) = integral of 2 rho P22(r) (rho - mu atan(rho/mu)) d rho,
 * every term positive: J keeps its relative accuracy however small. Below the horizon
 * K(-mu) = J(mu). */

typedef struct sigma_context {
    const aspi_trial *trial;
    double mu;
} sigma_context;

static double sigma_term(const void *context, double rho, int index)
{
    const sigma_context *c = (const sigma_context *)context;
    double r = hypot(c->mu, rho), x = c->mu > 0 ? rho / c->mu : INFINITY, bracket;
    /* sectors in the golden ratio: a density that is not round shows up as noise */
    double phi = 2 * ASPI_PI * fmod(0.6180339887498949 * index, 1.0);
    double density = aspi_r2_density(c->trial, r, phi);
    double ratio = rho / r;
    if (density == 0)
        return 0;
    if (x < 0.03)
        bracket = rho * x * x * (1.0 / 3 - x * x * (1.0 / 5 - x * x * (1.0 / 7 - x * x * (1.0 / 9
                  - x * x / 11))));
    else
        bracket = rho - (c->mu > 0 ? c->mu * atan(x) : 0);
    return 2 * ratio * ratio * density * bracket;
}

double aspi_sigma_by_quadrature(const aspi_trial *t, double w, double s)
{
    sigma_context c;
    if (!(s > 0))
        return w > 0 ? w : 0;
    c.trial = t;
    c.mu = fabs(w) / s;
    return (w > 0 ? w : 0) + s * aspi_radial_integral(sigma_term, &c);
}

/* ------------------------------------------------------------------ albedo
 *
 * R(wi) = integral over facets of eval_cos(wi, wo(m)) 4 (wi.m), m ranging over those that send wi
 * above the horizon: in slopes the disc |p + wi_xy/wi_z| < 1/wi_z. It is covered by rays from the
 * mean slope, r = scale sinh(X(phi) (1 - (1 - u)^3)), and cut into cells in (u, phi): the distribution
 * lives at r = scale, and its masking changes within a roughness of the horizon, at u = 1. Of each cell the change from
 * Gauss's rule on the whole to the rule on its quarters is known; the cell that changed most is cut
 * next, until the changes add up to less than the tolerance. Nothing is assumed of the integrand, so
 * that kinks of the min() masking and the cusp at wo = n of heavy tails are only dearer. */

#define ORDER 10
#define NODES (ORDER * ORDER)
#define SECTORS 8

typedef struct cell {
    double u0, u1, phi0, phi1;
    double quarter[4], value, change;   /* value: the sum of the quarters */
} cell;

typedef struct cubature {
    const asp_material *mat;
    asp_vec3 wi;
    asp_vec2 origin;       /* where the rays start */
    double scale, det, c;  /* c = |origin - centre|^2 - radius^2, negative inside */
    double node[ORDER], weight[ORDER];
    int order, planar;     /* planar: u and phi are slopes x and y, within the lattice's cells */
    asp_lattice lattice;
} cubature;

/* sinh^-1 of the length of the ray at phi, in units of the scale. */
static double ray_length(const cubature *q, double ex, double ey)
{
    double bx = q->origin.x + q->wi.x / q->wi.z, by = q->origin.y + q->wi.y / q->wi.z;
    double a = ex * ex + ey * ey, b = bx * ex + by * ey;
    double root = sqrt(b * b - a * q->c);
    double length = b > 0 ? -q->c / (b + root) : (root - b) / a;
    return asinh(length / q->scale);
}

static double cell_integral(const cubature *q, double u0, double u1, double phi0, double phi1)
{
    double wox[NODES], woy[NODES], woz[NODES], wix[NODES], wiy[NODES], wiz[NODES], jac[NODES];
    double red[NODES], green[NODES], blue[NODES], sum = 0;
    asp_cvec3s in, out;
    asp_rgbs f;
    const asp_map *map = &q->mat->ndf.map;
    int i, j;
    for (i = 0; i < q->order; i++) {
        double phi = phi0 + (phi1 - phi0) * q->node[i];
        double cx = cos(phi), cy = sin(phi);
        double ex = map->m00 * cx + map->m01 * cy, ey = map->m10 * cx + map->m11 * cy;
        double length = q->planar ? 0 : ray_length(q, ex, ey);
        for (j = 0; j < q->order; j++) {
            double at = u0 + (u1 - u0) * q->node[j], v = 1 - at;
            double x = (1 - v * v * v) * length, r = q->scale * sinh(x);
            asp_vec2 p = aspi_map_slope(map, at, phi);
            double px = q->planar ? p.x : q->origin.x + r * ex;
            double py = q->planar ? p.y : q->origin.y + r * ey;
            double mz = 1 / sqrt(1 + px * px + py * py);
            double cosine = mz * (q->wi.z - px * q->wi.x - py * q->wi.y);
            int k = i * q->order + j;
            wox[k] = -2 * cosine * mz * px - q->wi.x;
            woy[k] = -2 * cosine * mz * py - q->wi.y;
            woz[k] = 2 * cosine * mz - q->wi.z;
            wix[k] = q->wi.x;
            wiy[k] = q->wi.y;
            wiz[k] = q->wi.z;
            jac[k] = 4 * cosine * mz * mz * mz * q->det * q->weight[i] * q->weight[j]
                   * (q->planar ? 1 : r * q->scale * cosh(x) * length * 3 * v * v);
        }
    }
    in.x = wix; in.y = wiy; in.z = wiz;
    out.x = wox; out.y = woy; out.z = woz;
    f.r = red; f.g = green; f.b = blue;
    asp_eval_cos_n(q->mat, (size_t)(q->order * q->order), in, out, f);
    for (i = 0; i < q->order * q->order; i++) /* behind the facet there is no reflection */
        sum += jac[i] > 0 ? red[i] * jac[i] : 0;
    return sum * (u1 - u0) * (phi1 - phi0);
}

/* The mean slope if light reflected there stays above the horizon by half a roughness, else the
 * point of the disc next to it that does. */
static void choose_origin(cubature *q)
{
    const asp_map *map = &q->mat->ndf.map;
    double cx = -q->wi.x / q->wi.z, cy = -q->wi.y / q->wi.z, radius = 1 / q->wi.z;
    double dx = map->tx - cx, dy = map->ty - cy, d = hypot(dx, dy);
    double inside = radius - d, wanted;
    double rough = (q->mat->ndf.model->own_scale ? q->scale : 1) * sqrt(q->det);
    wanted = 0.5 * fmin(radius, rough);
    q->origin.x = map->tx;
    q->origin.y = map->ty;
    if (inside < wanted) {
        q->origin.x = cx + dx / d * (radius - wanted);
        q->origin.y = cy + dy / d * (radius - wanted);
    }
    /* |o - centre|^2 - radius^2, the squares of 1/wi.z taken out: |wi_xy|^2 - 1 = -wi.z^2 */
    q->c = q->origin.x * q->origin.x + q->origin.y * q->origin.y
         + 2 * (q->origin.x * q->wi.x + q->origin.y * q->wi.y) / q->wi.z - 1;
}

static cell make_cell(const cubature *q, double u0, double u1, double phi0, double phi1,
                      double whole)
{
    double um = 0.5 * (u0 + u1), pm = 0.5 * (phi0 + phi1);
    cell c;
    c.u0 = u0;
    c.u1 = u1;
    c.phi0 = phi0;
    c.phi1 = phi1;
    c.quarter[0] = cell_integral(q, u0, um, phi0, pm);
    c.quarter[1] = cell_integral(q, um, u1, phi0, pm);
    c.quarter[2] = cell_integral(q, u0, um, pm, phi1);
    c.quarter[3] = cell_integral(q, um, u1, pm, phi1);
    c.value = (c.quarter[0] + c.quarter[1]) + (c.quarter[2] + c.quarter[3]);
    c.change = fabs(c.value - whole);
    return c;
}

/* A binary heap, the largest change first. */
static void push(cell *heap, int *count, cell c)
{
    int i = (*count)++;
    while (i > 0 && heap[(i - 1) / 2].change < c.change) {
        heap[i] = heap[(i - 1) / 2];
        i = (i - 1) / 2;
    }
    heap[i] = c;
}

static cell pop(cell *heap, int *count)
{
    cell top = heap[0], last = heap[--*count];
    int i = 0;
    for (;;) {
        int child = 2 * i + 1;
        if (child + 1 < *count && heap[child + 1].change > heap[child].change)
            child++;
        if (child >= *count || !(heap[child].change > last.change))
            break;
        heap[i] = heap[child];
        i = child;
    }
    if (*count > 0)
        heap[i] = last;
    return top;
}

static void prepare_cubature(cubature *q, const asp_material *mat, asp_vec3 wi, double *phi_start)
{
    double r;
    asp_vec3 half = aspi_unit(wi.x, wi.y, wi.z + 1);
    q->mat = mat;
    q->wi = wi;
    q->det = fabs(mat->ndf.map.m00 * mat->ndf.map.m11 - mat->ndf.map.m01 * mat->ndf.map.m10);
    aspi_standard_polar(&mat->ndf, asp_sample_normal(&mat->ndf, 0.5, 0.25), &q->scale, phi_start);
    aspi_standard_polar(&mat->ndf, half, &r, phi_start); /* the cusp lies on an edge of cells */
    if (!(q->scale > 0 && q->scale < 1e30))
        q->scale = 1;
    if (!(*phi_start == *phi_start))
        *phi_start = 0;
    q->planar = mat->ndf.model->lattice && mat->ndf.model->lattice(&mat->ndf, &q->lattice);
    q->order = q->planar ? 2 : ORDER;
    aspi_gauss(q->order, q->node, q->weight);
    choose_origin(q);
}

/* The cells to begin with: number i of them, or 0 past the last. */
static int first_cell(const cubature *q, double phi_start, int i, double edges[4])
{
    const asp_lattice *l = &q->lattice;
    int nx = q->planar ? (int)l->nx : 4, ny = q->planar ? (int)l->ny : SECTORS;
    int at_x = i % nx, at_y = i / nx;
    if (at_y >= ny)
        return 0;
    edges[0] = q->planar ? l->x0 + l->dx * at_x : at_x / 4.0;
    edges[1] = q->planar ? l->x0 + l->dx * (at_x + 1) : (at_x + 1) / 4.0;
    edges[2] = q->planar ? l->y0 + l->dy * at_y : phi_start + 2 * ASPI_PI * at_y / SECTORS;
    edges[3] = q->planar ? l->y0 + l->dy * (at_y + 1) : phi_start + 2 * ASPI_PI * (at_y + 1) / SECTORS;
    return 1;
}

double aspi_albedo(const asp_material *mat, asp_vec3 wi, double tolerance, double *error)
{
    cell *heap;
    cubature q;
    double total = 0, doubt = 0, phi_start, edge[4];
    int count = 0, most = 4000, i;
    prepare_cubature(&q, mat, wi, &phi_start);
    if (q.planar)
        most += (int)(q.lattice.nx * q.lattice.ny);
    heap = (cell *)malloc((size_t)most * sizeof *heap);
    if (!heap) {
        if (error)
            *error = INFINITY;
        return NAN;
    }
    for (i = 0; first_cell(&q, phi_start, i, edge); i++) {
        double whole = cell_integral(&q, edge[0], edge[1], edge[2], edge[3]);
        cell c = make_cell(&q, edge[0], edge[1], edge[2], edge[3], whole);
        doubt += c.change;
        push(heap, &count, c);
    }
    while (doubt > tolerance && count + 4 <= most) {
        cell c = pop(heap, &count);
        double um = 0.5 * (c.u0 + c.u1), pm = 0.5 * (c.phi0 + c.phi1);
        doubt -= c.change;
        for (i = 0; i < 4; i++) {
            cell part = make_cell(&q, i & 1 ? um : c.u0, i & 1 ? c.u1 : um, i & 2 ? pm : c.phi0,
                                  i & 2 ? c.phi1 : pm, c.quarter[i]);
            doubt += part.change;
            push(heap, &count, part);
        }
    }
    for (i = 0; i < count; i++)
        total += heap[i].value;
    free(heap);
    if (error)
        *error = doubt;
    return total;
}
