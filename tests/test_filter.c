/* test_filter.c - sums and averages of distributions against brute force
 *
 * The truth is a mixture: of the parts themselves for an average, of one surface moved by 20,480 slopes of
 * the other for a sum, in rings with the weights of their density. Its density and projected area are
 * means over those; how far the one distribution that replaces it is off is printed, and bounded. */
#include "asperity_convert.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int passed, failed;

static void expect(int good, const char *what, double a, double b)
{
    passed += good;
    failed += !good;
    if (!good)
        printf("FAILED: %s: %.15g, expected %.15g\n", what, a, b);
}

static void near(const char *what, double a, double b, double tolerance)
{
    expect(fabs(a - b) <= tolerance * fabs(b), what, a, b);
}

static asp_ndf make(const char *spec)
{
    asp_ndf n;
    asp_error err;
    memset(&n, 0, sizeof n);
    if (asp_ndf_parse(NULL, spec, &n, &err))
        expect(0, spec, 0, 1);
    return n;
}

/* ---- the truth: distributions moved by slopes */

#define RINGS 160
#define SECTORS 128
#define MOST (RINGS * SECTORS)

typedef struct truth {
    size_t n;
    const asp_ndf *part[MOST];
    double x[MOST], y[MOST], weight[MOST];
} truth;

static double truth_P22(const truth *t, double px, double py)
{
    double sum = 0;
    for (size_t i = 0; i < t->n; i++)
        sum += t->weight[i] * asp_P22(t->part[i], px - t->x[i], py - t->y[i]);
    return sum;
}

static double truth_sigma(const truth *t, asp_vec3 w)
{
    double sum = 0;
    for (size_t i = 0; i < t->n; i++) {
        asp_vec3 v = { w.x, w.y, w.z - (t->x[i] * w.x + t->y[i] * w.y) };
        sum += t->weight[i] * asp_sigma(t->part[i], v);
    }
    return sum;
}

/* Two-dimensional golden ratio points (Roberts 2018). */
static asp_vec2 golden(size_t i)
{
    asp_vec2 u = { fmod(0.5 + 0.7548776662466927 * (double)i, 1), fmod(0.5 + 0.5698402909980532 * (double)i, 1) };
    return u;
}

/* Of b the slopes M (r cos phi, r sin phi) + t, log r in steps of 0.15, the rings turned against each
 * other. */
static truth sum_of(const asp_ndf *a, const asp_ndf *b)
{
    const asp_map *m = &b->map;
    double det = fabs(m->m00 * m->m11 - m->m01 * m->m10), total = 0;
    truth t;
    t.n = MOST;
    for (int i = 0; i < RINGS; i++)
        for (int j = 0; j < SECTORS; j++) {
            int k = i * SECTORS + j;
            double r = exp(-10 + 0.15 * i);
            double phi = 6.283185307179586 * (j + fmod(0.618 * i, 1)) / SECTORS;
            t.part[k] = a;
            t.x[k] = m->m00 * r * cos(phi) + m->m01 * r * sin(phi) + m->tx;
            t.y[k] = m->m10 * r * cos(phi) + m->m11 * r * sin(phi) + m->ty;
            t.weight[k] = 0.15 * 6.283185307179586 / SECTORS * r * r * det * asp_P22(b, t.x[k], t.y[k]);
            total += t.weight[k];
        }
    expect(fabs(total - 1) < 1e-4, "weights", total, 1);
    return t;
}

typedef struct distance { double l1, sigma, peak; } distance;

/* L1 of P22 over slopes, between 0 and 2, sampled from `n`; worst relative error of the projected area
 * at angles up to 89 degrees and 16 azimuths; P22 at the mean slope over the truth's. */
static distance compare(const asp_ndf *n, const truth *t, size_t points)
{
    distance d = { 0, 0, 0 };
    asp_vec2 mean = asp_mean_slope(n);
    for (size_t i = 0; i < points; i++) {
        asp_vec2 u = golden(i + 7);
        asp_vec3 m = asp_sample_normal(n, u.x, u.y);
        double x = -m.x / m.z, y = -m.y / m.z;
        d.l1 += fabs(1 - truth_P22(t, x, y) / asp_P22(n, x, y)) / (double)points;
    }
    for (int i = 0; i < 16 * 8; i++) {
        static const double degrees[8] = { 15, 30, 45, 60, 70, 80, 85, 89 };
        double theta = degrees[i % 8] * 0.017453292519943295, phi = i / 8 * 0.39269908169872414;
        asp_vec3 w = { sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta) };
        double s = truth_sigma(t, w);
        d.sigma = fmax(d.sigma, fabs(asp_sigma(n, w) - s) / s);
    }
    d.peak = asp_P22(n, mean.x, mean.y) / truth_P22(t, mean.x, mean.y);
    return d;
}

/* ---- sums */

/* Complete elliptic integral of the second kind, parameter m, by the arithmetic-geometric mean. */
static double elliptic_e(double m)
{
    double a = 1, b = sqrt(1 - m), c = sqrt(m), sum = 0.5 * m, power = 0.5;
    for (int i = 0; i < 12; i++) {
        double next = 0.5 * (a + b);
        c = 0.5 * (a - b);
        b = sqrt(a * b);
        a = next;
        power *= 2;
        sum += power * c * c;
    }
    return 1.5707963267948966 / a * (1 - sum);
}

static void exact_sums(void)
{
    asp_ndf a = make("beckmann:alpha_x=0.4,alpha_y=0.1,rotation=0.5,mean_x=0.2");
    asp_ndf b = make("beckmann:alpha_x=0.3,alpha_y=0.05,rotation=-0.9,mean_y=-0.3"), out;
    static truth t;
    printf("exact sums\n");
    for (int match = ASP_MATCH_AUTO; match <= ASP_MATCH_AREA; match++) {
        expect(asp_ndf_sum(&a, &b, a.model, NULL, (asp_match)match, &out, NULL) == ASP_OK, "sum", 0, 1);
        /* covariances add */
        asp_moments p, q, r;
        asp_ndf_moments(&a, &p, NULL);
        asp_ndf_moments(&b, &q, NULL);
        asp_ndf_moments(&out, &r, NULL);
        double tolerance = match == ASP_MATCH_AREA ? 1e-7 : 1e-12;
        near("mean_x", r.mean_x, 0.2, 1e-14);
        near("mean_y", r.mean_y, -0.3, 1e-14);
        near("xx", r.xx - 0.04, p.xx - 0.04 + q.xx, tolerance);
        near("yy", r.yy - 0.09, p.yy + q.yy - 0.09, tolerance);
        expect(fabs(r.xy + 0.06 - p.xy - q.xy) < tolerance * r.xx, "xy", r.xy, p.xy + q.xy);
        printf("  match %d: covariance off by %.1e\n", match, fabs((r.xx - 0.04) / (p.xx - 0.04 + q.xx) - 1));
    }
    /* and the density is the convolution's */
    t = sum_of(&a, &b);
    distance d = compare(&out, &t, 256);
    printf("  beckmann + beckmann: L1 %.1e, sigma %.1e, peak %.6f (the error of brute force)\n", d.l1,
           d.sigma, d.peak);
    expect(d.l1 < 1e-4 && d.sigma < 1e-4 && fabs(d.peak - 1) < 1e-4, "density", d.l1, 0);
    /* E|x1 + s x2| of GGX is an elliptic integral: the projected area of one GGX is
     * (w + sqrt(w^2 + 1))/2, so it is the mean of sqrt(1 + s^2 x^2) over the other */
    asp_ndf g = make("ggx:alpha=0.2");
    static const double ratios[] = { 1e-3, 0.03, 0.3, 0.9, 1, 1.1, 4, 50, 1e3 };
    for (size_t i = 0; i < sizeof ratios / sizeof *ratios; i++) {
        char spec[64];
        snprintf(spec, sizeof spec, "ggx:alpha=%.17g", 0.02 * ratios[i]);
        asp_ndf h = make(spec), small = make("ggx:alpha=0.02");
        expect(asp_ndf_sum(&small, &h, g.model, NULL, ASP_MATCH_AUTO, &out, NULL) == ASP_OK, spec, 0, 1);
        double s = fmin(ratios[i], 1 / ratios[i]);
        double expected = 0.02 * fmax(ratios[i], 1) * elliptic_e(1 - s * s);
        asp_roughness r = asp_map_to_roughness(&out.map);
        printf("  ggx 0.02 + ggx %-8g alpha %.12f, off by %.1e\n", 0.02 * ratios[i], r.alpha_x,
               fabs(r.alpha_x / expected - 1));
        near(spec, r.alpha_x, expected, 1e-7);
        near(spec, r.alpha_y, expected, 1e-7);
    }
}

/* How far the sums that are not closed are off. The bounds are what was measured, rounded up. */
static void other_sums(void)
{
    static const struct { const char *a, *b, *to; asp_match match; double l1, sigma; } rows[] = {
        { "ggx:alpha=0.2", "ggx:alpha=0.2", "ggx", ASP_MATCH_AUTO, 0.09, 0.008 },
        { "ggx:alpha=0.2", "ggx:alpha=0.05", "ggx", ASP_MATCH_AUTO, 0.04, 0.0035 },
        { "ggx:alpha=0.2", "beckmann:alpha=0.2", "ggx", ASP_MATCH_AUTO, 0.23, 0.018 },
        { "ggx:alpha=0.05", "beckmann:alpha=0.3", "ggx", ASP_MATCH_AUTO, 0.55, 0.046 },
        { "ggx:alpha=0.05", "beckmann:alpha=0.3", "beckmann", ASP_MATCH_AUTO, 0.042, 0.0035 },
        { "student_t:alpha=0.2,gamma=3", "student_t:alpha=0.2,gamma=3", "student_t:gamma=3", ASP_MATCH_AUTO, 0.115, 0.038 },
        { "student_t:alpha=0.2,gamma=3", "student_t:alpha=0.2,gamma=3", "student_t:gamma=3", ASP_MATCH_AREA, 0.08, 0.0055 },
        { "student_t:alpha=0.2,gamma=1.6", "ggx:alpha=0.1", "student_t:gamma=1.6", ASP_MATCH_AUTO, 0.17, 0.0145 },
        { "ggx:alpha_x=0.4,alpha_y=0.1,rotation=0.5", "beckmann:alpha_x=0.05,alpha_y=0.3,mean_x=0.3", "ggx", ASP_MATCH_AUTO, 0.32, 0.13 },
    };
    static truth t;
    printf("sums that are not closed           L1 of P22   sigma    peak ratio\n");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        asp_ndf a = make(rows[i].a), b = make(rows[i].b), to = make(rows[i].to), out;
        expect(asp_ndf_sum(&a, &b, to.model, to.shape, rows[i].match, &out, NULL) == ASP_OK, rows[i].a, 0, 1);
        t = sum_of(&a, &b);
        distance d = compare(&out, &t, 256);
        printf("  %s + %s -> %s%s\n      %33.4f %9.4f %9.4f\n", rows[i].a, rows[i].b, rows[i].to,
               rows[i].match == ASP_MATCH_AREA ? " (area)" : "", d.l1, d.sigma, d.peak);
        expect(d.l1 < rows[i].l1, rows[i].to, d.l1, rows[i].l1);
        expect(d.sigma < rows[i].sigma, rows[i].to, d.sigma, rows[i].sigma);
        /* what is matched: the width along the horizon */
        asp_ndf back;
        expect(asp_ndf_sum(&b, &a, to.model, to.shape, rows[i].match, &back, NULL) == ASP_OK, "turned", 0, 1);
        near("either order", asp_P22(&back, 0.1, 0.2), asp_P22(&out, 0.1, 0.2), 1e-7);
        if (rows[i].match == ASP_MATCH_AUTO && strncmp(rows[i].a, "student_t:alpha=0.2,gamma=3", 27)) {
            asp_vec3 along = { 1, 0, 0 };
            asp_vec2 mean = asp_mean_slope(&out);
            along.z = mean.x;
            if (out.map.m01 == 0 && out.map.m10 == 0)
                near("area", asp_sigma(&out, along), truth_sigma(&t, along), 2e-3);
        }
    }
}

/* ---- averages */

static void averages(void)
{
    asp_ndf parts[4], out, narrow, wide;
    const asp_ndf *list[4];
    double weight[4] = { 1, 1, 1, 1 }, x[4] = { 0.1, -0.2, 0.05, 0.3 }, y[4] = { 0, 0.1, -0.3, 0.2 };
    printf("averages\n");
    /* one part, any model: itself */
    static const char *const one[] = { "ggx:alpha_x=0.3,alpha_y=0.1,rotation=0.4,mean_x=0.2",
                                       "beckmann:alpha_x=0.3,alpha_y=0.1,rho=0.4", "student_t:alpha=0.3,gamma=1.6" };
    for (size_t i = 0; i < 3; i++)
        for (int match = ASP_MATCH_AUTO; match <= ASP_MATCH_AREA; match += ASP_MATCH_AREA) {
            asp_ndf n = make(one[i]);
            list[0] = &n;
            expect(asp_ndf_average(1, list, NULL, n.model, n.shape, (asp_match)match, &out, NULL) == ASP_OK, one[i], 0, 1);
            near(one[i], asp_P22(&out, 0.2, 0.1), asp_P22(&n, 0.2, 0.1), 1e-12);
            near(one[i], asp_P22(&out, -0.2, 0.1), asp_P22(&n, -0.2, 0.1), 1e-12);
        }
    /* covariance within and between, by hand */
    narrow = make("beckmann:alpha=0.2,mean_x=0.3");
    wide = make("beckmann:alpha_x=0.6,alpha_y=0.4,mean_x=-0.1,mean_y=0.2");
    list[0] = &narrow;
    list[1] = &wide;
    weight[0] = 3;
    asp_moments m;
    expect(asp_ndf_average(2, list, weight, narrow.model, NULL, ASP_MATCH_AUTO, &out, NULL) == ASP_OK, "two", 0, 1);
    asp_ndf_moments(&out, &m, NULL);
    near("mean_x", m.mean_x, 0.2, 1e-14);
    near("mean_y", m.mean_y, 0.05, 1e-14);
    near("xx", m.xx, 0.75 * (0.02 + 0.09) + 0.25 * (0.18 + 0.01), 1e-12);
    near("xy", m.xy, 0.25 * -0.02, 1e-12);
    near("yy", m.yy, 0.75 * 0.02 + 0.25 * (0.08 + 0.04), 1e-12);
    /* a footprint is the average of the base moved, whatever is matched */
    for (int match = ASP_MATCH_AUTO; match <= ASP_MATCH_AREA; match += ASP_MATCH_AREA) {
        asp_ndf base = make("student_t:alpha_x=0.2,alpha_y=0.1,gamma=4"), print;
        for (int i = 0; i < 4; i++) {
            parts[i] = base;
            parts[i].map.tx += x[i];
            parts[i].map.ty += y[i];
            list[i] = &parts[i];
        }
        expect(asp_ndf_average(4, list, weight, base.model, base.shape, (asp_match)match, &out, NULL) == ASP_OK, "four", 0, 1);
        expect(asp_ndf_footprint(&base, 4, x, y, weight, base.model, base.shape, (asp_match)match, &print, NULL) == ASP_OK, "print", 0, 1);
        near("footprint", asp_P22(&print, 0.1, 0.1), asp_P22(&out, 0.1, 0.1), 1e-12);
    }
}

/* A patch of a bumpy normal map with one roughness: slopes of two crossed waves and noise. */
static void footprints(void)
{
    enum { N = 4096 };
    static const struct { const char *base, *to; double bumps; asp_match match; double l1, sigma; } rows[] = {
        { "beckmann:alpha=0.2", "beckmann", 0.1, ASP_MATCH_AUTO, 0.0087, 0.0037 },
        { "beckmann:alpha=0.2", "beckmann", 0.1, ASP_MATCH_AREA, 0.0074, 0.001 },
        { "beckmann:alpha=0.1", "beckmann", 0.3, ASP_MATCH_AUTO, 0.33, 0.095 },
        { "beckmann:alpha=0.02", "beckmann", 0.3, ASP_MATCH_AUTO, 0.53, 0.12 },
        { "ggx:alpha=0.2", "ggx", 0.1, ASP_MATCH_AUTO, 0.077, 0.0101 },
        { "ggx:alpha=0.1", "ggx", 0.3, ASP_MATCH_AUTO, 0.58, 0.065 },
        { "ggx:alpha=0.1", "beckmann", 0.3, ASP_MATCH_AUTO, 0.285, 0.017 },
        { "student_t:alpha=0.2,gamma=3", "student_t:gamma=3", 0.1, ASP_MATCH_AUTO, 0.069, 0.0385 },
        { "student_t:alpha=0.2,gamma=3", "student_t:gamma=3", 0.1, ASP_MATCH_AREA, 0.0545, 0.0094 },
    };
    static truth t;
    static double x[N], y[N];
    printf("footprints of a bumpy map          L1 of P22   sigma    peak ratio\n");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        asp_ndf base = make(rows[i].base), to = make(rows[i].to), out;
        t.n = N;
        for (size_t k = 0; k < N; k++) {
            asp_vec2 u = golden(k);
            double s = 6.283185307179586;
            x[k] = rows[i].bumps * (cos(s * (u.x + 2 * u.y)) + 0.3 * cos(s * 7 * u.x)) + 0.1;
            y[k] = rows[i].bumps * (0.5 * sin(s * (u.x - u.y)) + 0.3 * cos(s * 9 * u.y));
            t.part[k] = &base;
            t.weight[k] = 1.0 / N;
            t.x[k] = x[k];
            t.y[k] = y[k];
        }
        expect(asp_ndf_footprint(&base, N, x, y, NULL, to.model, to.shape, rows[i].match, &out, NULL) == ASP_OK, rows[i].to, 0, 1);
        distance d = compare(&out, &t, 1024);
        printf("  %s, bumps %g -> %s%s\n      %33.4f %9.4f %9.4f\n", rows[i].base, rows[i].bumps, rows[i].to,
               rows[i].match == ASP_MATCH_AREA ? " (area)" : "", d.l1, d.sigma, d.peak);
        expect(d.l1 < rows[i].l1, rows[i].to, d.l1, rows[i].l1);
        expect(d.sigma < rows[i].sigma, rows[i].to, d.sigma, rows[i].sigma);
    }
}

static void refusals(void)
{
    asp_ndf g = make("ggx:alpha=0.2"), b = make("beckmann:alpha=0.2"), out;
    const asp_ndf *list[2] = { &b, &g };
    double weight[2] = { 1, -1 }, none[2] = { 0, 0 }, far[2] = { 1e4, -1e4 };
    double bad[2] = { 0.1, NAN };
    asp_error err;
    printf("refusals\n");
    out.model = NULL;
    expect(asp_ndf_sum(&b, &g, b.model, NULL, ASP_MATCH_COVARIANCE, &out, &err) == ASP_EINVAL, "ggx", 0, 1);
    expect(!strcmp(err.name, "ggx") && strstr(err.reason, "infinite"), err.reason, 0, 0);
    expect(asp_ndf_sum(&b, &b, g.model, NULL, ASP_MATCH_COVARIANCE, &out, &err) == ASP_EINVAL, "ggx", 0, 1);
    expect(asp_ndf_sum(&b, &b, b.model, NULL, (asp_match)9, &out, &err) == ASP_EINVAL, "match", 0, 1);
    expect(asp_ndf_average(2, list, NULL, b.model, NULL, ASP_MATCH_COVARIANCE, &out, &err) == ASP_EINVAL, "covariance", 0, 1);
    expect(asp_ndf_average(2, list, weight, b.model, NULL, ASP_MATCH_AUTO, &out, &err) == ASP_EINVAL, "weight", 0, 1);
    expect(err.value == -1, "weight", err.value, -1);
    expect(asp_ndf_average(2, list, none, b.model, NULL, ASP_MATCH_AUTO, &out, &err) == ASP_EINVAL, "none", 0, 1);
    expect(asp_ndf_average(0, list, NULL, b.model, NULL, ASP_MATCH_AUTO, &out, &err) == ASP_EINVAL, "empty", 0, 1);
    expect(asp_ndf_footprint(&b, 2, far, none, NULL, b.model, NULL, ASP_MATCH_AUTO, &out, &err) == ASP_EINVAL, "far", 0, 1);
    expect(asp_ndf_footprint(&b, 2, bad, none, NULL, b.model, NULL, ASP_MATCH_AUTO, &out, &err) == ASP_EINVAL, "nan", 0, 1);
    expect(out.model == NULL, "untouched", 0, 0);
}

int main(void)
{
    exact_sums();
    other_sums();
    averages();
    footprints();
    refusals();
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
