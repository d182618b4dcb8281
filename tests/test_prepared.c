/* test_prepared.c - masking and sampling of prepared surfaces
 *
 * Student-t densities put through the preparation against their own formulas; the ABC distribution against
 * quadrature over its range: sigma from both sides, and the samplers by exact inversion: the share of slopes
 * beyond the radius that comes out, and the share of azimuths, by quadrature, give the uniform numbers back,
 * and so nothing but the law can come out. Batches and float32 against single float64 calls. */
#include "random.h"
#include "prepared_known.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

extern const asp_model asp_model_abc, asp_model_sgd, asp_model_gtr, asp_model_torrance_sparrow;

#define PI 3.14159265358979323846

static int passed, failed;

static void report(const char *what, const char *of, double worst, double bound)
{
    int ok = worst <= bound;
    printf("%-4s %-46s %-26s %.3g, bound %g\n", ok ? "ok" : "FAIL", what, of, worst, bound);
    passed += ok;
    failed += !ok;
}

static double larger(double a, double b) { return b <= a ? a : b; }   /* keeps a NaN of b */

static asp_ndf make(const asp_model *model, double a, double b)
{
    static const asp_map identity = { 1, 0, 0, 1, 0, 0 };
    double shape[ASP_SHAPE_NUMBERS] = { 0 };
    asp_ndf k;
    shape[0] = a;
    shape[1] = b;
    memset(&k, 0, sizeof k);
    if (asp_ndf_make(model, &identity, shape, &k, NULL)) {
        printf("FAIL make %s %g %g\n", model->name, a, b);
        failed++;
    }
    return k;
}

static double sigma(const asp_ndf *k, double mu, double sign)
{
    double s = 1 / sqrt(1 + mu * mu);
    return k->model->f64.sigma(k, s, 0, sign * mu * s) / s;
}

/* ------------------------------------------------------------------ quadrature from the density alone */

static double P22(const asp_ndf *k, double r)
{
    double s = 1 / sqrt(1 + r * r);
    return k->model->f64.density(k, r * s, 0, s) * (s * s) * (s * s);
}

/* eta - mu atan(eta/mu), what a ring of radius sqrt(mu^2 + eta^2) shows from below. */
static double bracket(double eta, double mu)
{
    double x = eta / mu, z = x * x;
    if (!(mu > 0))
        return eta;
    return x < 0.1 ? eta * z * (1.0 / 3 - z * (1.0 / 5 - z * (1.0 / 7 - z * (1.0 / 9 - z / 11))))
                   : eta - mu * atan(x);
}

/* Mass beyond a radius, of all slopes (mu < 0) or of those seen from below by a view of slope mu: Simpson's
 * rule in the logarithm, cumulated from outside; in between the logarithm is linear. */
#define NODES 16000
typedef struct shares {
    double low, step, beyond[NODES + 1];
} shares;

static void shares_make(shares *t, const asp_ndf *k, double mu, double scale)
{
    static double g[2 * NODES + 1];
    int i;
    t->low = log(scale) - 20;
    t->step = (40 - t->low) / NODES;
    for (i = 0; i <= 2 * NODES; i++) {
        double x = exp(t->low + 0.5 * i * t->step);
        g[i] = mu < 0 ? 2 * PI * P22(k, x) * x * x : 2 * P22(k, sqrt(mu * mu + x * x)) * x * x * bracket(x, mu);
    }
    t->beyond[NODES] = 0;
    for (i = NODES - 1; i >= 0; i--)
        t->beyond[i] = t->beyond[i + 1] + t->step * (g[2 * i] + 4 * g[2 * i + 1] + g[2 * i + 2]) / 6;
}

static double share(const shares *t, double x)
{
    double y = (log(x) - t->low) / t->step, a, b;
    int i = (int)y;
    if (!(y > 0))
        return 1;
    if (i >= NODES - 1)
        return 0;
    a = log(t->beyond[i] / t->beyond[0]);
    b = log(t->beyond[i + 1] / t->beyond[0]);
    return exp(a + (b - a) * (y - i));
}

/* ------------------------------------------------------------------ sigma */

static void check_known(double tail, const asp_model *exact, double shape)
{
    asp_ndf k = make(&model_known, tail, 0), e = make(exact, shape, 0);
    char name[64];
    double above = 0, below = 0, t;
    snprintf(name, sizeof name, "%s, tail %g", exact->name, tail);
    for (t = -14; t < 12; t += 0.0371) {
        double mu = exp(t), down = sigma(&e, mu, -1);
        above = larger(above, fabs(sigma(&k, mu, 1) / sigma(&e, mu, 1) - 1));
        if (down > 1e-290)
            below = larger(below, fabs(sigma(&k, mu, -1) / down - 1));
    }
    report("sigma from above, relative", name, above, 3e-8);
    report("sigma from below, relative", name, below, 1e-6);
    report("mass found", name, fabs(k.table[PREPARED_LOG_MASS] - log(7 * PI)), 5e-8);
}

/* `bound`: from below while what is seen is above 1e-40; at last 1e-280 it is ten times that. */
static void check_sigma(const asp_ndf *k, const char *name, double bound)
{
    double above = 0, below = 0, far = 0, scale = k->table[PREPARED_SCALE], t;
    for (t = -12; t < 11; t += 0.19) {
        double mu = scale * exp(t), sum = 0, x, up = sigma(k, mu, 1), down = sigma(k, mu, -1);
        for (x = -30; x < 45; x += 0.05) {
            double eta = exp(x);
            sum += P22(k, sqrt(mu * mu + eta * eta)) * eta * eta * bracket(eta, mu);
        }
        sum *= 2 * 0.05;
        above = larger(above, fabs(up / (mu + sum) - 1));
        if (sum > 1e-40 * scale)
            below = larger(below, fabs(down / sum - 1));
        else if (sum > 1e-280)
            far = larger(far, fabs(down / sum - 1));
        if (!(up >= mu * (1 - 4e-16) && down >= 0))
            above = INFINITY;
    }
    report("sigma from above, relative", name, above, 1e-7);
    report("sigma from below, relative", name, below, bound);
    report("sigma from below, below 1e-40", name, far, 10 * bound);
    report("edge-on: sigma is half of E|x|", name, fabs(sigma(k, 0, 1) / (0.5 * scale) - 1), 1e-12);
}

/* ------------------------------------------------------------------ samplers */

/* Sum of (found - expected)^2/expected over cells of uniform numbers, for 1e7 samples. */
static double chi_square(double share0, double share1, double u0, double u1)
{
    double found = fabs(share0 - share1), expected = fabs(u0 - u1);
    double most = found > expected ? found : expected;
    return most > 0 ? 1e7 * (share0 - share1 - (u0 - u1)) * (share0 - share1 - (u0 - u1)) / most : 0;
}

static void check_normal(const asp_ndf *k, const char *name)
{
    static shares t;
    double chi = 0, z, last_share = 1, last_u = 1;
    shares_make(&t, k, -1, k->table[PREPARED_SCALE]);
    for (z = 0.02; z < 2.4; z += 0.02) {
        double e = (z * z) * (z * z), u = exp(-e), m[3], s;
        k->model->f64.normal(k, -expm1(-e), 0.3, m);
        s = share(&t, hypot(m[0], m[1]) / m[2]);
        chi += chi_square(last_share, s, last_u, u);
        last_share = s;
        last_u = u;
    }
    report("normals: chi-square of 1e7, 119 rings", name, chi, 1);
}

/* By how much the share that F = c phi + g sin(phi) has of the whole is not u2's. */
static double azimuth_miss(double x, double y, double z, double c, double s, double u2)
{
    double g = s * hypot(x, y) / z, phi = atan2(y, x), end = c > g ? PI : acos(fmax(-1, -c / g));
    double F = c * phi + g * sin(phi), most = c * end + g * sin(end);
    /* the cancellation of F below the mean plane is this test's */
    return z > 1e-12 && c > -0.9 * g ? fabs(F / most - (1 - 2 * u2)) : 0;
}

/* One view, all u1: the tail from below is drawn for u1 sigma > c. */
static void check_visible(const asp_ndf *k, const char *name, double q, double sign, double bound)
{
    static shares t, all;
    double mu = q * k->table[PREPARED_SCALE], s = 1 / sqrt(1 + mu * mu), c = sign * mu * s;
    double far = sigma(k, mu, -1) * s, area = (c > 0 ? c : 0) + far, chi = 0, z, last_share = 1, last_u = 1;
    double azimuth = 0, single[2] = { 0, 0 };
    asp_ndff narrow = asp_ndf_narrow(k);
    char of[96];
    int i;
    shares_make(&t, k, mu, k->table[PREPARED_SCALE]);
    /* from below: u1 = share */
    for (z = 0.02; z < 2.02; z += 0.02) {
        double u = exp(-(z * z) * (z * z) * z), m[3], r;
        double u1 = c > 0 ? (c + u * far) / area : u;
        if (u * far < 1e-6 * area)         /* ten samples */
            break;
        k->model->f64.visible(k, s, 0, c, u1, 0.5, m);
        r = hypot(m[0], m[1]) / m[2];
        r = share(&t, sqrt((r - mu) * (r + mu)));
        chi += chi_square(last_share, r, last_u, u) * (c > 0 ? far / area : 1);
        last_share = r;
        last_u = u;
    }
    if (c > 0) {
        double before = 1, before_u = 1;
        shares_make(&all, k, -1, k->table[PREPARED_SCALE]);
        for (z = 0.02; z < 1.9; z += 0.02) {
            double u = exp(-(z * z) * (z * z)), m[3], r;
            if (u * c < 1e-6 * area)
                break;
            k->model->f64.visible(k, s, 0, c, (1 - u) * c / area, 0.5, m);
            r = share(&all, hypot(m[0], m[1]) / m[2]);
            chi += chi_square(before, r, before_u, u) * c / area;
            before = r;
            before_u = u;
        }
    }
    snprintf(of, sizeof of, "%s, q %g", name, sign * q);
    report("visible: chi-square of 1e7, radius", of, chi, bound);
    /* the azimuth given the radius: F = c phi + g sin(phi) is linear in u2 */
    for (i = 0; i < 4000; i++) {
        double u1 = uniform(), u2 = i % 4 ? uniform() : pow(10, -9 * uniform()), m[3];
        float n[3];
        k->model->f64.visible(k, s, 0, c, u1, u2, m);
        azimuth = larger(azimuth, azimuth_miss(m[0], m[1], m[2], c, s, u2));
        k->model->f32.visible(&narrow, (float)s, 0, (float)c, (float)u1, (float)u2, n);
        single[i % 4 == 0] = larger(single[i % 4 == 0],
                                    azimuth_miss(n[0], n[1], n[2], (float)c, (float)s, (float)u2));
    }
    report("visible: azimuth", of, azimuth, 2e-12);
    report("visible: azimuth, float32", of, single[0], 5e-6);
    report("visible: azimuth, float32, near the end", of, single[1], 5e-5);
}

/* ------------------------------------------------------------------ float32, batches, ends */

#define COUNT 331
static void check_batch(const asp_ndf *k, const char *name)
{
    static double x[COUNT], y[COUNT], z[COUNT], u[COUNT], v[COUNT], a[COUNT], b[COUNT], c[COUNT], o[COUNT];
    const asp_ndf_ops *f = &k->model->f64;
    asp_ndff narrow = asp_ndf_narrow(k);
    double scale = k->table[PREPARED_SCALE], areas = 0, facets = 0;
    int i, differ = 0, sign;
    for (i = 0; i < COUNT; i++) {
        double mu = scale * exp(8 * uniform() - 4) * (i % 3 ? 1 : -1), s = 1 / sqrt(1 + mu * mu);
        double phi = 2 * PI * uniform();
        x[i] = (float)(s * cos(phi));
        y[i] = (float)(s * sin(phi));
        z[i] = (float)(mu * s);
        u[i] = (float)uniform();
        v[i] = (float)uniform();
        if (i < 8) {
            u[i] = i & 1 ? 1 - 0x1p-24 : 0;
            v[i] = i & 2 ? 1 - 0x1p-24 : 0;
            z[i] = i & 4 ? 0 : z[i];
        }
    }
    f->visible_n(k, COUNT, x, y, z, u, v, a, b, c);
    for (i = 0; i < COUNT; i++) {
        double m[3];
        float w[3];
        f->visible(k, x[i], y[i], z[i], u[i], v[i], m);
        differ += memcmp(m, a + i, sizeof m[0]) || memcmp(m + 1, b + i, sizeof m[0])
               || memcmp(m + 2, c + i, sizeof m[0]);
        differ += !(fabs(m[0] * m[0] + m[1] * m[1] + m[2] * m[2] - 1) < 1e-12 && m[2] >= 0);
        k->model->f32.visible(&narrow, (float)x[i], (float)y[i], (float)z[i], (float)u[i], (float)v[i], w);
        /* roundings are amplified without bound at the ends and where u1 sigma = c */
        if (u[i] > 0.02 && u[i] < 0.98 && v[i] > 0.02 && v[i] < 0.98)
            facets = larger(facets, hypot(hypot(w[0] - m[0], w[1] - m[1]), w[2] - m[2])
                            / (scale < 1 ? scale : 1));
    }
    for (sign = -1; sign < 2; sign += 2) {
        f->sigma_n(k, COUNT, sign, x, y, z, o);
        for (i = 0; i < COUNT; i++) {
            double one = f->sigma(k, sign * x[i], sign * y[i], sign * z[i]);
            float single = k->model->f32.sigma(&narrow, (float)(sign * x[i]), (float)(sign * y[i]),
                                               (float)(sign * z[i]));
            differ += memcmp(&one, o + i, sizeof one) != 0;
            if (sign * z[i] >= 0)
                areas = larger(areas, fabs(single / one - 1));
        }
    }
    report("batches and single calls, differing", name, differ, 0);
    report("float32: sigma from above", name, areas, 2e-6);
    report("float32: visible normals / scale", name, facets, 1e-2);
}

/* Peaks with plateaus, Gaussian tails, slopes of all sizes. */
static void check_others(void)
{
    static const struct { const asp_model *model; double a, b, bound; } rows[] = {
        { &asp_model_torrance_sparrow, 0.001, 0, 1e-6 }, { &asp_model_torrance_sparrow, 0.1, 0, 1e-6 },
        { &asp_model_torrance_sparrow, 0.4, 0, 1e-6 }, { &asp_model_sgd, 0.1, 0.5, 1e-6 },
        { &asp_model_sgd, 1e-4, 1, 1e-6 }, { &asp_model_sgd, 1e-4, 4, 1e-6 }, { &asp_model_sgd, 0.01, 1.8, 1e-6 },
        { &asp_model_gtr, 0.001, 1, 1e-6 }, { &asp_model_gtr, 0.001, 5, 1e-6 }, { &asp_model_gtr, 0.1, 10, 3e-6 },
        { &asp_model_gtr, 0.2, 17, 5e-6 }, { &asp_model_gtr, 0.99, 1e4, 2e-6 }, { &asp_model_gtr, 4, 1e4, 1e-6 }
    };
    size_t i;
    for (i = 0; i < sizeof rows / sizeof *rows; i++) {
        asp_ndf k = make(rows[i].model, rows[i].a, rows[i].b);
        char name[64];
        snprintf(name, sizeof name, "%s %g, %g", rows[i].model->name, rows[i].a, rows[i].b);
        check_sigma(&k, name, rows[i].bound);
    }
}

int main(void)
{
    static const double abc[][2] = {
        { 20, 1.75 }, { 1e-4, 0 }, { 1e-4, 1000 }, { 1e6, 1000 }, { 1e6, 0.54 }, { 1e5, 1 }, { 1000, 3 },
        { 4250, 0.5 }, { 0.0212, 1000 }, { 1, 20 }, { 1e5, 1.75 }
    };
    static const double q[] = { 0, 1e-3, 0.02, 0.1, 0.4, 1.3, 6 };
    size_t i, j;
    check_known(1, asp_find_model(NULL, "ggx"), 0);
    check_known(0, asp_find_model(NULL, "beckmann"), 0);
    check_known(1 / 1.5, asp_find_model(NULL, "student_t"), 2.5);
    check_known(0.02, asp_find_model(NULL, "student_t"), 51);
    for (i = 0; i < sizeof abc / sizeof abc[0]; i++) {
        asp_ndf k = make(&asp_model_abc, abc[i][0], abc[i][1]);
        char name[64];
        snprintf(name, sizeof name, "abc %g, %g", abc[i][0], abc[i][1]);
        report("mass", name, fabs(k.table[PREPARED_LOG_MASS]), 5e-8);
        check_sigma(&k, name, 1e-6);
        check_normal(&k, name);
        for (j = 0; j < sizeof q / sizeof q[0]; j++)
            check_visible(&k, name, q[j], 1, 15);
        check_visible(&k, name, 0.1, -1, 15);
        check_visible(&k, name, 1, -1, 30);
        check_batch(&k, name);
    }
    check_others();
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
