/* visible_test.h - samplers of visible normals against the density, by chi-square, for the tests
 *
 * Cells are rings and sectors of the standard slope, sectors counted from the view's azimuth. Their shares
 * are int r P22(r) int (c - s r cos phi)+ dphi dr / sigma: the inner integral closed, the outer one by
 * Gauss and Legendre in log r. P22 and sigma are the library's. */
#ifndef VISIBLE_TEST_H
#define VISIBLE_TEST_H

#include "asperity.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define RINGS 14
#define SECTORS 16
#define CELLS (RINGS * SECTORS)
static const double pi_ = 3.14159265358979323846;
static int passed, failed;

static inline void say(int ok, const char *what)
{
    passed += ok != 0;
    failed += ok == 0;
    if (!ok)
        printf("FAIL %s\n", what);
}

static uint64_t stream_state = 88172645463325252u;

static inline double uniform(void *unused)
{
    (void)unused;
    stream_state ^= stream_state << 13;
    stream_state ^= stream_state >> 7;
    stream_state ^= stream_state << 17;
    return (double)(stream_state >> 11) * 0x1p-53;
}

typedef struct cells {
    const asp_ndf *ndf;
    asp_vec3 w;
    double c, s, azimuth;            /* the view in the standard frame */
    double edge[RINGS - 1];
    double share[CELLS];
} cells;

/* Polar standard slope of m, its angle counted from the view's azimuth, in [0, 2 pi). */
static inline void slope_of(const cells *k, asp_vec3 m, double *r, double *phi)
{
    double px = -m.x / m.z - k->ndf->map.tx, py = -m.y / m.z - k->ndf->map.ty;
    double qx = k->ndf->i00 * px + k->ndf->i01 * py, qy = k->ndf->i10 * px + k->ndf->i11 * py;
    *r = m.z > 0 ? hypot(qx, qy) : INFINITY;
    *phi = atan2(qy, qx) - k->azimuth;
    *phi -= 2 * pi_ * floor(*phi / (2 * pi_));
}

static inline int cell_of(const cells *k, asp_vec3 m)
{
    double r, phi;
    int i = 0, j;
    slope_of(k, m, &r, &phi);
    while (i < RINGS - 1 && !(r <= k->edge[i]))
        i++;
    j = (int)(phi / (2 * pi_) * SECTORS);
    return i * SECTORS + (j < SECTORS ? (j >= 0 ? j : 0) : SECTORS - 1);
}

/* int (c - h cos phi)+ dphi from 0 <= a to b <= pi, h >= 0. */
static inline double facing(double c, double h, double a, double b)
{
    double start = c >= h ? 0 : c <= -h ? pi_ : acos(c / h);
    a = fmax(a, start);
    return b > a ? c * (b - a) - h * (sin(b) - sin(a)) : 0;
}

static inline double standard_p22(const asp_ndf *k, double r)
{
    return asp_P22(k, k->map.m00 * r + k->map.tx, k->map.m10 * r + k->map.ty) / k->inv_det;
}

static inline int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Edges at the quantiles of a pilot sample, then the shares; those of the open ring by what is left of
 * each half of the view: its sectors are one cell. */
static inline void cells_make(cells *k, const asp_ndf *ndf, asp_vec3 w, double *radii, size_t count)
{
    static const double node[8] = { 0.0950125098376374, 0.2816035507792589, 0.4580167776572274,
        0.6178762444026438, 0.7554044083550030, 0.8656312023878318, 0.9445750230732326, 0.9894009349916499 };
    static const double weight[8] = { 0.1894506104550685, 0.1826034150449236, 0.1691565193950025,
        0.1495959888165767, 0.1246289712555339, 0.0951585116824928, 0.0622535239386479, 0.0271524594117541 };
    const asp_map *map = &ndf->map;
    double sigma = asp_sigma(ndf, w), vx = map->m00 * w.x + map->m10 * w.y, vy = map->m01 * w.x + map->m11 * w.y;
    double rest = 1;
    int i, j, part, g;
    memset(k, 0, sizeof *k);
    k->ndf = ndf;
    k->w = w;
    k->c = w.z - map->tx * w.x - map->ty * w.y;
    k->s = hypot(vx, vy);
    k->azimuth = atan2(vy, vx);
    qsort(radii, count, sizeof *radii, by_size);
    for (i = 0; i < RINGS - 1; i++)
        k->edge[i] = radii[count * (size_t)(i + 1) / RINGS];
    for (i = 0; i < RINGS - 1; i++) {
        double high = log(k->edge[i]), low = i ? log(k->edge[i - 1]) : high - 20;
        int parts = i ? 4 : 40;
        for (part = 0; part < parts; part++) {
            double mid = low + (high - low) * (part + 0.5) / parts, half = 0.5 * (high - low) / parts;
            for (g = 0; g < 16; g++) {
                double x = g < 8 ? -node[g] : node[g - 8], r = exp(mid + half * x);
                double f = weight[g % 8] * half * r * r * standard_p22(ndf, r) / sigma;
                for (j = 0; j < SECTORS / 2; j++) {
                    double share = f * facing(k->c, k->s * r, 2 * pi_ * j / SECTORS,
                                              2 * pi_ * (j + 1) / SECTORS);
                    k->share[i * SECTORS + j] += share;
                    k->share[i * SECTORS + SECTORS - 1 - j] += share;
                }
            }
        }
        for (j = 0; j < SECTORS; j++)
            rest -= k->share[i * SECTORS + j];
    }
    k->share[(RINGS - 1) * SECTORS] = rest;
}

static inline void cells_count(const cells *k, asp_vec3 m, double count[CELLS])
{
    int i = cell_of(k, m);
    count[i >= (RINGS - 1) * SECTORS ? (RINGS - 1) * SECTORS : i] += 1;
}

/* P(chi-square larger) by Wilson and Hilferty. */
static inline double chi_probability(double chi2, int dof)
{
    double h = 2.0 / (9.0 * dof);
    return dof < 1 ? 1 : 0.5 * erfc((cbrt(chi2 / dof) - (1 - h)) / sqrt(2 * h));
}

/* Cells with fewer than 10 expected are one. */
static inline double chi_share(const cells *k, const double count[CELLS], double total)
{
    double chi2 = 0, rest = 0, rest_share = 0;
    int i, dof = -1;
    for (i = 0; i < CELLS; i++) {
        double want = k->share[i] * total;
        if (want < 10) {
            rest += count[i];
            rest_share += want;
            continue;
        }
        chi2 += (count[i] - want) * (count[i] - want) / want;
        dof++;
    }
    if (rest_share > 1 || rest > 20) {
        rest_share = fmax(rest_share, 1e-3);
        chi2 += (rest - rest_share) * (rest - rest_share) / rest_share;
        dof++;
    }
    return chi_probability(chi2, dof);
}

/* Two samples of one size: are they of one law? */
static inline double chi_two(const double a[CELLS], const double b[CELLS])
{
    double chi2 = 0, rest_a = 0, rest_b = 0;
    int i, dof = -1;
    for (i = 0; i < CELLS; i++) {
        double sum = a[i] + b[i];
        if (sum < 20) {
            rest_a += a[i];
            rest_b += b[i];
            continue;
        }
        chi2 += (a[i] - b[i]) * (a[i] - b[i]) / sum;
        dof++;
    }
    if (rest_a + rest_b > 0) {
        chi2 += (rest_a - rest_b) * (rest_a - rest_b) / (rest_a + rest_b);
        dof++;
    }
    return chi_probability(chi2, dof);
}

/* All p-values of a run: the least of them, and whether they are uniform. */
#define MOST_P 6000
static double all_p[MOST_P];
static size_t p_count;

static inline void note_p(double p, const char *what)
{
    if (p_count < MOST_P)
        all_p[p_count++] = p;
    if (!(p > 1e-7))
        printf("     p = %.3g: %s\n", p, what);
    say(p > 1e-7, what);
}

/* Kolmogorov and Smirnov's test of the p-values against the uniform law. */
static inline double p_of_all(void)
{
    double d = 0, t, sum = 0;
    size_t i;
    qsort(all_p, p_count, sizeof *all_p, by_size);
    for (i = 0; i < p_count; i++)
        d = fmax(d, fmax(all_p[i] - (double)i / (double)p_count, (double)(i + 1) / (double)p_count - all_p[i]));
    t = d * (sqrt((double)p_count) + 0.12 + 0.11 / sqrt((double)p_count));
    for (i = 1; i < 100; i++)
        sum += (i & 1 ? 2 : -2) * exp(-2 * t * t * (double)(i * i));
    return t < 0.3 ? 1 : sum;
}

static inline size_t sample_count(size_t usual)
{
    const char *text = getenv("ASPERITY_SAMPLES");
    return text ? (size_t)atof(text) : usual;
}

#endif
