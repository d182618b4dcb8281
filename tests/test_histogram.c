/* test_histogram.c - slopes counted in cells: exact masking, samplers, the laws, convergence
 *
 * Cells of known content against integrals that know nothing of the library's tables: polygons for sigma,
 * closed forms for one cell; histograms of GGX and Beckmann, finer and finer, against the distributions
 * themselves. */
#include "asperity_data.h"
#include "asperity_ndf.h"
#include "splitmix.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int passed, failed;

static void report(const char *what, double worst, double bound)
{
    int ok = worst <= bound;
    printf("%-4s %-64s %.3g, bound %g\n", ok ? "ok" : "FAIL", what, worst, bound);
    passed += ok;
    failed += !ok;
}

static uint64_t state = 7;

static double uniform(void) { return next(&state); }

static asp_vec3 direction(double low)
{
    double z = low + (1 - low) * uniform(), s = sqrt(1 - z * z), phi = 6.283185307179586 * uniform();
    asp_vec3 w = { s * cos(phi), s * sin(phi), z };
    return w;
}

static double relative(double a, double b) { return fabs(a - b) / fmax(fabs(b), 1e-12); }

/* ------------------------------------------------------------------ values */

typedef struct surface {
    size_t nx, ny;
    asp_slope_range range;
    double *values;
    void *memory;
    asp_ndf ndf;
} surface;

static void make(surface *s, const asp_map *map)
{
    asp_error err;
    char text[300];
    s->memory = malloc(asp_histogram_bytes(s->nx, s->ny));
    if (!s->memory || asp_histogram_make(s->memory, s->nx, s->ny, s->range, s->values, map, &s->ndf, &err)) {
        printf("FAIL made: %s\n", asp_error_text(&err, text, sizeof text));
        exit(1);
    }
}

static surface start(size_t nx, size_t ny, double low_x, double high_x, double low_y, double high_y)
{
    surface s = { nx, ny, { low_x, high_x, low_y, high_y }, calloc(nx * ny, sizeof(double)), NULL, { 0 } };
    if (!s.values)
        exit(1);
    return s;
}

static void release(surface *s)
{
    free(s->values);
    free(s->memory);
}

/* Holes, a heavy corner, a long tail to one side: nothing is symmetric. */
static surface skewed(size_t nx, size_t ny, const asp_map *map)
{
    surface s = start(nx, ny, -0.35, 1.1, -0.6, 0.4);
    for (size_t i = 0; i < nx * ny; i++)
        s.values[i] = uniform() < 0.25 ? 0 : exp(3 * uniform() - 4 * (double)(i % nx) / (double)nx);
    make(&s, map);
    return s;
}

/* Mass of a distribution in each cell, by Gauss's rule of 5 x 5 nodes. */
static surface counted(const asp_ndf *from, size_t n, double size)
{
    static const double at[5] = { 0.046910077030668, 0.230765344947158, 0.5, 0.769234655052842,
                                  0.953089922969332 };
    static const double weight[5] = { 0.118463442528095, 0.239314335249683, 0.284444444444444,
                                      0.239314335249683, 0.118463442528095 };
    surface s = start(n, n, -size, size, -size, size);
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < n; i++)
            for (int k = 0; k < 25; k++)
                s.values[j * n + i] += weight[k / 5] * weight[k % 5]
                    * asp_P22(from, -size + 2 * size * ((double)i + at[k % 5]) / (double)n,
                              -size + 2 * size * ((double)j + at[k / 5]) / (double)n);
    make(&s, NULL);
    return s;
}

/* ------------------------------------------------------------------ sigma by polygons */

/* Integral of max(0, h) over a rectangle, h linear: the visible polygon in triangles from its first
 * corner, area times mean height. */
static double rectangle(asp_vec3 w, double x0, double x1, double y0, double y1)
{
    const double cx[4] = { x0, x1, x1, x0 }, cy[4] = { y0, y0, y1, y1 };
    double px[8], py[8], h[8], sum = 0;
    int n = 0;
    for (int i = 0; i < 4; i++) {
        int j = (i + 1) % 4;
        double a = w.z - w.x * cx[i] - w.y * cy[i], b = w.z - w.x * cx[j] - w.y * cy[j];
        if (a >= 0) {
            px[n] = cx[i];
            py[n] = cy[i];
            h[n++] = a;
        }
        if ((a > 0 && b < 0) || (a < 0 && b > 0)) {
            px[n] = cx[i] + a / (a - b) * (cx[j] - cx[i]);
            py[n] = cy[i] + a / (a - b) * (cy[j] - cy[i]);
            h[n++] = 0;
        }
    }
    for (int i = 2; i < n; i++)
        sum += ((px[i - 1] - px[0]) * (py[i] - py[0]) - (px[i] - px[0]) * (py[i - 1] - py[0]))
             * (h[0] + h[i - 1] + h[i]) / 6;
    return sum;
}

static double sigma_of_cells(const surface *s, asp_vec3 w)
{
    double dx = (s->range.high_x - s->range.low_x) / (double)s->nx;
    double dy = (s->range.high_y - s->range.low_y) / (double)s->ny, sum = 0, all = 0;
    for (size_t j = 0; j < s->ny; j++)
        for (size_t i = 0; i < s->nx; i++) {
            double q = s->values[j * s->nx + i];
            all += q * dx * dy;
            if (q > 0)
                sum += q * rectangle(w, s->range.low_x + dx * (double)i, s->range.low_x + dx * (double)(i + 1),
                                     s->range.low_y + dy * (double)j, s->range.low_y + dy * (double)(j + 1));
        }
    return sum / all;
}

static void sigma_exact(void)
{
    static const size_t sizes[6][2] = { { 1, 1 }, { 1, 9 }, { 3, 2 }, { 12, 31 }, { 64, 64 }, { 200, 7 } };
    double worst = 0, worst32 = 0, mass = 0;
    for (int k = 0; k < 6; k++) {
        surface s = k ? skewed(sizes[k][0], sizes[k][1], NULL) : start(1, 1, -0.2, 0.7, 0.1, 0.4);
        asp_ndff f;
        if (!k) {
            s.values[0] = 3;
            make(&s, NULL);
        }
        f = asp_ndf_narrow(&s.ndf);
        for (int i = 0; i < 3000; i++) {
            asp_vec3 w = direction(-1), v;
            double exact;
            if (i % 5 == 0)
                w.x = 0;
            if (i % 7 == 0)
                w.y = 0;
            if (i % 3 == 0)
                w.z *= 0.01;
            exact = sigma_of_cells(&s, w);
            worst = fmax(worst, fabs(asp_sigma(&s.ndf, w) - exact) / fmax(exact, 1e-5));
            asp_vec3f wf = { (float)w.x, (float)w.y, (float)w.z };
            v.x = wf.x;
            v.y = wf.y;
            v.z = wf.z;
            worst32 = fmax(worst32, fabs(asp_sigmaf(&f, wf) - asp_sigma(&s.ndf, v)));
        }
        double dx = (s.range.high_x - s.range.low_x) / (double)s.nx;
        double dy = (s.range.high_y - s.range.low_y) / (double)s.ny, sum = 0;
        for (size_t j = 0; j < s.ny; j++)
            for (size_t i = 0; i < s.nx; i++)
                sum += asp_P22(&s.ndf, s.range.low_x + dx * ((double)i + 0.5),
                               s.range.low_y + dy * ((double)j + 0.5)) * dx * dy;
        mass = fmax(mass, fabs(sum - 1));
        release(&s);
    }
    report("sigma of 1x1 ... 200x7 cells against polygons", worst, 1e-11);
    report("float32 against float64, absolute", worst32, 3e-7);
    report("the cells sum to 1", mass, 1e-13);
}

/* One cell, seen along x: the slopes x are uniform over [a, b]. */
static void one_cell(void)
{
    const double a = -0.2, b = 0.7;
    surface s = start(1, 1, a, b, -0.3, 0.3);
    double worst = 0, D = 0;
    s.values[0] = 1;
    make(&s, NULL);
    for (int i = 1; i < 2000; i++) {
        double theta = 3.14159265358979 * i / 2000, c = cos(theta), n = sin(theta), mu = c / n;
        asp_vec3 w = { n, 0, c };
        double x = fmin(fmax(mu, a), b), exact = n * ((x - a) * (2 * mu - a - x)) / (2 * (b - a));
        worst = fmax(worst, fabs(asp_sigma(&s.ndf, w) - exact));
    }
    report("one cell: sigma in closed form", worst, 4e-16);
    report("the mean of the slopes is the cell's middle",
           fabs(asp_mean_slope(&s.ndf).x - 0.25) + fabs(asp_mean_slope(&s.ndf).y), 1e-16);
    asp_vec3 m = { -0.1 / sqrt(1.01), 0, 1 / sqrt(1.01) };
    D = relative(asp_D(&s.ndf, m), 1.01 * 1.01 / (0.9 * 0.6));
    report("one cell: D = 1 / (area cos^4)", D, 1e-15);
    release(&s);
}

/* ------------------------------------------------------------------ through a slope map */

static void mapped(void)
{
    asp_map map = { 0.7, 0.3, -0.2, 1.4, 0.1, -0.3 };
    surface plain, bent;
    double worst = 0, density = 0;
    state = 11;
    plain = skewed(9, 14, NULL);
    state = 11;
    bent = skewed(9, 14, &map);
    for (int i = 0; i < 3000; i++) {
        asp_vec3 w = direction(-1), v = { map.m00 * w.x + map.m10 * w.y, map.m01 * w.x + map.m11 * w.y,
                                          w.z - map.tx * w.x - map.ty * w.y };
        double x = 1.4 * uniform() - 0.3, y = uniform() - 0.6;
        worst = fmax(worst, fabs(asp_sigma(&bent.ndf, w) - asp_sigma(&plain.ndf, v)));
        density = fmax(density, relative(asp_P22(&bent.ndf, map.m00 * x + map.m01 * y + map.tx,
                                                 map.m10 * x + map.m11 * y + map.ty) * 1.04,
                                         asp_P22(&plain.ndf, x, y)));
    }
    report("sigma through a slope map", worst, 3e-15);
    report("P22 through a slope map", density, 1e-14);
    release(&plain);
    release(&bent);
}

/* ------------------------------------------------------------------ samplers */

/* Kolmogorov's distance of both coordinates of what u1 and u2 are mapped to, by the distribution functions
 * from polygons: with stratified u1, u2 an exact inversion is at most one stratum away. */
static void strata(const surface *s, asp_vec3 w, const char *name)
{
    enum { N = 96 };
    static double at[N * N];
    double dx = (s->range.high_x - s->range.low_x), worst = 0, all = 0;
    int across = 0;
    for (int axis = 0; axis < 2; axis++) {
        for (int i = 0; i < N * N; i++) {
            asp_vec3 m = asp_sample_visible(&s->ndf, w, (i % N + 0.5) / N, (i / N + 0.5) / N);
            at[i] = axis ? -m.y / m.z : -m.x / m.z;
        }
        for (int k = 1; k < 40; k++) {
            double low = axis ? s->range.low_y : s->range.low_x, high = axis ? s->range.high_y : s->range.high_x;
            double cut = low + (high - low) * k / 40, count = 0, share = 0, sum = 0;
            for (int i = 0; i < N * N; i++)
                count += at[i] < cut;
            for (size_t j = 0; j < s->ny; j++)
                for (size_t i = 0; i < s->nx; i++) {
                    double q = s->values[j * s->nx + i], y0, y1, x0, x1, hx = dx / (double)s->nx;
                    double hy = (s->range.high_y - s->range.low_y) / (double)s->ny;
                    x0 = s->range.low_x + hx * (double)i;
                    y0 = s->range.low_y + hy * (double)j;
                    x1 = x0 + hx;
                    y1 = y0 + hy;
                    if (!(q > 0))
                        continue;
                    sum += q * rectangle(w, x0, x1, y0, y1);
                    share += q * (axis ? rectangle(w, x0, x1, y0, fmax(y0, fmin(y1, cut)))
                                       : rectangle(w, x0, fmax(x0, fmin(x1, cut)), y0, y1));
                }
            all = fmax(all, fabs(count / (N * N) - share / sum));
        }
        across += axis;
        worst = fmax(worst, all);
    }
    report(name, worst, 2.0 / N);
}

static void samples(void)
{
    static const struct { const char *name; asp_vec3 w; } views[5] = {
        { "visible normals, from above", { 0.02, 0.01, 0.99975 } },
        { "visible normals, oblique", { -0.5, 0.4, 0.7681 } },
        { "visible normals, grazing", { 0.8, 0.5999, 0.004 } },
        { "visible normals, from below the horizon", { 0.1, -0.98, -0.1718 } },
        { "visible normals, below the mean plane", { 0.95, 0.3, 0.0872 } }
    };
    surface s = skewed(13, 8, NULL);
    double facing = 0, inside = 0;
    for (int i = 0; i < 5; i++)
        strata(&s, views[i].w, views[i].name);
    for (int i = 0; i < 200000; i++) {
        asp_vec3 w = direction(-0.3), m;
        if (asp_sigma(&s.ndf, w) < 1e-9)
            continue;
        m = asp_sample_visible(&s.ndf, w, uniform(), uniform());
        facing = fmax(facing, -(m.x * w.x + m.y * w.y + m.z * w.z));
        inside += !(asp_D(&s.ndf, m) > 0);
    }
    report("samples face the view", facing, 3e-15);
    report("samples lie in cells that hold something (of 200000)", inside, 2);
    release(&s);
}

/* ------------------------------------------------------------------ convergence */

/* The finest histogram's masking against the distribution's, and how the error falls from 32 to 64 to 128. */
static void convergence(const char *spec, double size, double sigma_bound, double order)
{
    asp_ndf ndf;
    double error[3] = { 0, 0, 0 }, g1[3] = { 0, 0, 0 }, d[3] = { 0, 0, 0 };
    char text[100];
    if (asp_ndf_parse(NULL, spec, &ndf, NULL))
        exit(1);
    for (int k = 0; k < 3; k++) {
        surface s = counted(&ndf, (size_t)32 << k, size);
        state = 3;
        for (int i = 0; i < 2000; i++) {
            asp_vec3 w = direction(0.01), m = asp_sample_normal(&ndf, uniform() * 0.9, uniform());
            error[k] = fmax(error[k], fabs(asp_sigma(&s.ndf, w) - asp_sigma(&ndf, w)));
            g1[k] = fmax(g1[k], fabs(asp_G1(&s.ndf, w, 0) - asp_G1(&ndf, w, 0)));
            d[k] += fabs(asp_P22(&s.ndf, -m.x / m.z, -m.y / m.z) / asp_P22(&ndf, -m.x / m.z, -m.y / m.z) - 1)
                  / 2000;
        }
        release(&s);
    }
    printf("     %s, 32, 64, 128 cells: sigma %.2g %.2g %.2g, G1 %.2g %.2g %.2g, P22 (mean) %.2g %.2g %.2g\n", spec,
           error[0], error[1], error[2], g1[0], g1[1], g1[2], d[0], d[1], d[2]);
    snprintf(text, sizeof text, "%s: sigma of 128 x 128 cells", spec);
    report(text, error[2], sigma_bound);
    snprintf(text, sizeof text, "%s: P22 halves with the cells", spec);
    report(text, d[2] / d[0], 0.3);
    if (order > 0) {
        snprintf(text, sizeof text, "%s: sigma's error falls with the square", spec);
        report(text, error[2] / error[0], order);
    }
}

/* ------------------------------------------------------------------ laws, refusals */

static void law(void *context, const asp_law_result *r)
{
    *(int *)context += r->checks > 0;
    if (!r->passed)
        printf("     %s: %.3g, allowed %.3g: %s\n", r->law->name, r->worst, r->allowed, r->where);
}

static void laws(void)
{
    asp_map map = { 0.5, 0.2, -0.1, 0.8, 0.05, 0.2 };
    asp_laws_options o = asp_laws_options_default();
    o.samples = 20000;
    for (int k = 0; k < 3; k++) {
        surface s = k == 0 ? skewed(5, 4, NULL) : k == 1 ? skewed(12, 9, &map) : start(1, 1, -0.3, 0.3, -0.1, 0.1);
        size_t broken = 99;
        int held = 0;
        char text[60];
        if (k == 2) {
            s.values[0] = 1;
            make(&s, NULL);
        }
        asp_laws_check(&s.ndf, &o, law, &held, &broken, NULL);
        snprintf(text, sizeof text, "laws broken of %d, %zu x %zu cells", held, s.nx, s.ny);
        report(text, (double)broken, 0);
        release(&s);
    }
}

static void refused(const char *what, size_t nx, asp_slope_range range, double value, const char *name)
{
    static double memory[1000];
    double values[4] = { value, value, value, value };
    asp_ndf ndf;
    asp_error err = { 0 };
    asp_status s = asp_histogram_make(memory, nx, 2, range, values, NULL, &ndf, &err);
    report(what, s == ASP_EINVAL && !strcmp(err.name, name) ? 0 : 1, 0);
}

static void refusals(void)
{
    asp_slope_range good = { -1, 1, -1, 1 }, flat = { 1, 1, -1, 1 }, wide = { -1, 1e9, -1, 1 };
    asp_ndf ndf;
    asp_map map = { 1, 0, 0, 1, 0, 0 };
    asp_error err;
    refused("refused: a negative value", 2, good, -1, "values");
    refused("refused: NaN", 2, good, NAN, "values");
    refused("refused: all empty", 2, good, 0, "values");
    refused("refused: no columns", 0, good, 1, "nx");
    refused("refused: a range of no width", 2, flat, 1, "range");
    refused("refused: slopes beyond 1000", 2, wide, 1, "range");
    report("bytes of what is refused", (double)(asp_histogram_bytes(0, 5) + asp_histogram_bytes(5, 1025)), 0);
    extern const asp_model asp_model_histogram;
    report("refused: no data", asp_ndf_make(&asp_model_histogram, &map, NULL, &ndf, &err) != ASP_EINVAL, 0);
}

int main(void)
{
    sigma_exact();
    one_cell();
    mapped();
    samples();
    /* slopes beyond 4 are cut off: half of alpha^2/4 is missing at the horizon, however small the cells */
    convergence("ggx:alpha=0.2", 4, 0.5 * 0.2 * 0.2 / 4 + 5e-4, 0);
    convergence("beckmann:alpha_x=0.3,alpha_y=0.15,rotation=0.4", 1, 1e-4, 0.08);
    laws();
    refusals();
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
