/* test_surface.c - height fields: recipes, slope statistics, files */
#define _POSIX_C_SOURCE 200809L
#include "data_test.h"
#include "surface/surface.h"

static asp_surface_recipe small(double alpha, double gamma, uint64_t seed)
{
    return (asp_surface_recipe){ .seed = seed, .size = 512, .correlation = 6, .patch = 4,
                                 .alpha = alpha, .gamma = gamma };
}

static asp_height_field make(const asp_surface_recipe *recipe)
{
    asp_error err;
    asp_height_field field = { 0 };
    CHECK(asp_height_field_make(recipe, &field, &err) == ASP_OK, "a surface cannot be made: %s",
          err.name);
    return field;
}

static asp_slope_statistics slopes(const asp_height_field *field)
{
    asp_error err;
    asp_slope_statistics s = { 0 };
    CHECK(asp_height_field_slopes(field, &s, &err) == ASP_OK, "no statistics: %s", err.reason);
    return s;
}

/* Expected share of facets between two slopes, over its ring: the mean of P22 over the ring. */
static double ring_P22(double alpha, double gamma, int degree)
{
    double a = tan(degree * ASPI_PI / 180), b = tan((degree + 1) * ASPI_PI / 180), n = gamma - 1;
    double low, high, a2 = alpha * alpha;
    if (isinf(gamma)) {
        low = exp(-a * a / a2);
        high = exp(-b * b / a2);
    } else {
        low = pow(1 + a * a / (n * a2), -n);
        high = pow(1 + b * b / (n * a2), -n);
    }
    return (low - high) / (ASPI_PI * (b * b - a * a));
}

/* Worst deviation of the measured density from the recipe's, over rings that hold a share of at
 * least `least`. */
static double worst_ring(const asp_slope_statistics *s, double alpha, double gamma, double least)
{
    double worst = 0;
    for (int i = 0; i < 89; ++i) {
        double a = tan(i * ASPI_PI / 180), b = tan((i + 1) * ASPI_PI / 180);
        double expected = ring_P22(alpha, gamma, i);
        if (expected * ASPI_PI * (b * b - a * a) >= least)
            worst = fmax(worst, fabs(s->P22[i] / expected - 1));
    }
    return worst;
}

static void test_refusals(void)
{
    static const struct { asp_surface_recipe r; const char *name; } bad[] = {
        { { 1, 1000, 8, 4, 0.2, 3 }, "size" },       { { 1, 32, 8, 4, 0.2, 3 }, "size" },
        { { 1, 1024, 1, 4, 0.2, 3 }, "correlation" }, { { 1, 64, 9, 1, 0.2, 3 }, "correlation" },
        { { 1, 1024, 8, 4, 0, 3 }, "alpha" },         { { 1, 1024, 8, 4, 0.2, 1.5 }, "gamma" },
        { { 1, 1024, 8, 0.5, 0.2, 3 }, "patch" },     { { 1, 1024, 64, 8, 0.2, 3 }, "patch" },
        { { 1, 1024, 8, 4, (double)NAN, 3 }, "alpha" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i) {
        asp_height_field field = { 0 };
        asp_error err;
        memset(&err, 0, sizeof err);
        CHECK(asp_height_field_make(&bad[i].r, &field, &err) == ASP_EINVAL && !field.heights
                  && !strcmp(err.name, bad[i].name),
              "recipe %zu: refused as '%s', expected '%s'", i, err.name, bad[i].name);
    }
    asp_surface_recipe ok = asp_surface_recipe_default();
    CHECK(ok.gamma == 3 && ok.size == 1024, "the default recipe is not the documented one");
}

static void test_same_seed(void)
{
    asp_surface_recipe r = small(0.3, 3, 7), other = small(0.3, 3, 8);
    asp_height_field a = make(&r), b = make(&r), c = make(&other);
    size_t bytes = 512u * 512u * sizeof(float);
    CHECK(!memcmp(a.heights, b.heights, bytes), "the same recipe gave other heights");
    CHECK(memcmp(a.heights, c.heights, bytes) != 0, "another seed gave the same heights");
    asp_height_field_free(&a);
    asp_height_field_free(&b);
    asp_height_field_free(&c);
    asp_height_field_free(NULL);
    CHECK(!a.heights && a.nx == 0, "free does not clear");
}

/* The transform against its definition. */
static void test_fft(void)
{
    enum { N = 8 };
    aspi_complex in[N * N], out[N * N], roots[N];
    double worst = 0;
    for (int i = 0; i < N * N; ++i)
        in[i] = out[i] = (aspi_complex){ random_number() - 0.5, random_number() - 0.5 };
    aspi_fft2(out, N, roots);
    for (int x = 0; x < N; ++x)
        for (int y = 0; y < N; ++y) {
            double re = 0, im = 0;
            for (int ky = 0; ky < N; ++ky)
                for (int kx = 0; kx < N; ++kx) {
                    double t = 2 * ASPI_PI * (kx * x + ky * y) / N, c = cos(t), s = sin(t);
                    re += in[ky * N + kx].re * c - in[ky * N + kx].im * s;
                    im += in[ky * N + kx].re * s + in[ky * N + kx].im * c;
                }
            worst = fmax(worst, fabs(re - out[x * N + y].re) + fabs(im - out[x * N + y].im));
        }
    CHECK(worst < 1e-13, "fft differs from the sum by %g", worst);
}

static void test_gaussian(void)
{
    for (int i = 0; i < 3; ++i) {
        double alpha = (double[]){ 0.05, 0.2, 0.6 }[i];
        asp_surface_recipe r = small(alpha, INFINITY, 11 + (uint64_t)i);
        asp_height_field field = make(&r);
        asp_slope_statistics s = slopes(&field);
        printf("gaussian alpha %.3g: rms slopes %.6f %.6f (recipe %.6f), ML gamma %.1f\n", alpha,
               s.rms_x, s.rms_y, alpha / sqrt(2.0), s.gamma);
        /* one phase per wave and no random amplitude: exact but for the floats of the heights */
        CHECK(fabs(s.rms_x * sqrt(2.0) / alpha - 1) < 1e-5, "rms_x %.9g", s.rms_x);
        CHECK(fabs(s.rms_y * sqrt(2.0) / alpha - 1) < 1e-5, "rms_y %.9g", s.rms_y);
        CHECK(fabs(s.mean_x) < 1e-6 && fabs(s.mean_y) < 1e-6, "mean %g %g", s.mean_x, s.mean_y);
        CHECK(fabs(s.correlation) < 0.02, "correlation %g", s.correlation);
        CHECK(s.gamma > 40, "gamma %g of a Gaussian surface", s.gamma);
        CHECK(s.facets == 2u * 512u * 512u, "%zu facets", s.facets);
        double worst = worst_ring(&s, alpha, INFINITY, 0.01);
        CHECK(worst < 0.05, "density off by %g", worst);
        asp_height_field_free(&field);
    }
}

static void test_correlation(void)
{
    asp_surface_recipe r = small(0.2, INFINITY, 5);
    asp_height_field f = make(&r);
    double zero = 0, lag[2] = { 0, 0 };
    for (int y = 0; y < f.ny; ++y)
        for (int x = 0; x < f.nx; ++x) {
            double h = (double)f.heights[y * f.nx + x];
            zero += h * h;
            lag[0] += h * (double)f.heights[y * f.nx + (x + 6) % f.nx];
            lag[1] += h * (double)f.heights[(y + 6) % f.ny * f.nx + x];
        }
    for (int i = 0; i < 2; ++i)
        CHECK(fabs(lag[i] / zero - exp(-1.0)) < 0.02, "height correlation at 6 steps: %.4f",
              lag[i] / zero);
    asp_height_field_free(&f);
}

static void test_student(void)
{
    static const struct { double alpha, gamma; } rows[] = {
        { 0.25, 3 }, { 0.1, 2 }, { 0.4, 5 }, { 0.05, 1.7 } };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
        double alpha = rows[i].alpha, gamma = rows[i].gamma;
        asp_surface_recipe r = asp_surface_recipe_default();
        r.alpha = alpha;
        r.gamma = gamma;
        asp_height_field field = make(&r);
        asp_slope_statistics s = slopes(&field);
        double worst = worst_ring(&s, alpha, gamma, 0.01);
        printf("student alpha %.3g gamma %.3g: ML alpha %.4f gamma %.3f, density within %.1f %%\n",
               alpha, gamma, s.alpha, s.gamma, 100 * worst);
        CHECK(fabs(s.alpha / alpha - 1) < 0.03, "alpha %g for %g", s.alpha, alpha);
        /* the tail index in terms of its own scale, gamma - 1 */
        CHECK(fabs((s.gamma - 1) / (gamma - 1) - 1) < 0.05, "gamma %g for %g", s.gamma, gamma);
        CHECK(worst < 0.08, "density off by %g", worst);
        CHECK(s.log_student >= s.log_ggx && s.log_student > s.log_beckmann,
              "log-likelihoods %g %g %g", s.log_student, s.log_ggx, s.log_beckmann);
        asp_height_field_free(&field);
    }
}

/* Fields whose slopes are known by hand. */
static void test_by_hand(void)
{
    enum { N = 16 };
    float h[N * N];
    asp_error err;
    asp_slope_statistics s;
    asp_height_field f = { N, N, 0.5, 0.25, 0, h };
    for (int i = 0; i < N * N; ++i)
        h[i] = (float)(0.5 * (i % N)) + 0.125f * (float)(i / N);    /* slopes 1 and 0.5 everywhere */
    memset(&err, 0, sizeof err);
    CHECK(asp_height_field_slopes(&f, &s, &err) == ASP_EINVAL, "a plane has statistics");

    for (int i = 0; i < N * N; ++i)                                  /* a tilted roof along y */
        h[i] = (float)abs(i % N * 2 - N) * 0.25f + 0.125f * (float)(i / N);
    f.periodic = 0;
    s = slopes(&f);    /* x slopes: 8 columns of squares of -1 and 7 of +1 */
    CHECK(s.facets == 2u * 15u * 15u, "%zu facets", s.facets);
    CHECK(fabs(s.mean_x + 1.0 / 15) < 1e-12 && fabs(s.mean_y - 0.5) < 1e-12, "mean %g %g", s.mean_x,
          s.mean_y);
    CHECK(fabs(s.rms_x - sqrt(1 - 1.0 / 225)) < 1e-12 && s.rms_y < 1e-7, "rms %g %g", s.rms_x,
          s.rms_y);

    h[5 * N + 5] = NAN;    /* x + y even: all four diagonals end here, so it is in 8 triangles */
    s = slopes(&f);
    CHECK(s.facets == 450u - 8u, "%zu facets around one gap", s.facets);
    h[5 * N + 5] = h[5 * N + 11];
    h[6 * N + 5] = NAN;    /* x + y odd: no diagonal does, 4 triangles */
    s = slopes(&f);
    CHECK(s.facets == 450u - 4u, "%zu facets around another gap", s.facets);
    for (int i = 0; i < N * N; ++i)
        h[i] = NAN;
    CHECK(asp_height_field_slopes(&f, &s, &err) == ASP_EINVAL, "no heights have statistics");
}

static asp_status read_field(const char *meta, const void *bytes, size_t size, asp_error *err,
                             asp_height_field *field)
{
    memset(err, 0, sizeof *err);
    write_bytes(temporary_path("field.meta.txt"), meta, strlen(meta));
    write_bytes(temporary_path("field.f32"), bytes, size);
    return asp_height_field_read(temporary_path("field.f32"), field, err);
}

static void test_read(void)
{
    static const char good[] = "file=field.f32\nnx=3\nny = 2\r\ndx_um=0.5\ndy_um=2\nheight_unit=um\n"
                               "instrument=none=at all\n";
    const unsigned char bytes[24] = { 0, 0, 0x80, 0x3F, 0, 0, 0, 0xC0 };    /* 1, -2, 0, ... */
    asp_height_field f = { 0 };
    asp_error err;
    CHECK(read_field(good, bytes, 24, &err, &f) == ASP_OK, "refused: %s %s", err.name, err.reason);
    CHECK(f.nx == 3 && f.ny == 2 && f.dx == 0.5 && f.dy == 2 && !f.periodic, "wrong shape");
    CHECK(f.heights && f.heights[0] == 1 && f.heights[1] == -2 && f.heights[5] == 0,
          "wrong heights");
    asp_height_field_free(&f);

    static const struct { const char *meta; size_t size; const char *name; } bad[] = {
        { "nx=3\nny=2\ndx_um=1\ndy_um=1\nheight_unit=um\n", 23, "heights" },
        { "nx=3\nny=2\ndx_um=1\ndy_um=1\nheight_unit=nm\n", 24, "height_unit" },
        { "nx=3\nny=2\ndx_um=1\ndy_um=1\n", 24, "height_unit" },
        { "nx=3x\nny=2\ndx_um=1\ndy_um=1\nheight_unit=um\n", 24, "nx" },
        { "nx=3\nny=1\ndx_um=1\ndy_um=1\nheight_unit=um\n", 24, "ny" },
        { "nx=1e9\nny=2\ndx_um=1\ndy_um=1\nheight_unit=um\n", 24, "nx" },
        { "nx=2.5\nny=2\ndx_um=1\ndy_um=1\nheight_unit=um\n", 24, "nx" },
        { "nx=3\nny=2\ndx_um=-1\ndy_um=1\nheight_unit=um\n", 24, "dx_um" },
        { "", 24, "nx" },
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; ++i)
        CHECK(read_field(bad[i].meta, bytes, bad[i].size, &err, &f) == ASP_EFORMAT && !f.heights
                  && !strcmp(err.name, bad[i].name) && err.file[0],
              "file %zu: refused as '%s' in '%s', expected '%s'", i, err.name, err.file,
              bad[i].name);
    CHECK(asp_height_field_read(temporary_path("field.xyz"), &f, &err) == ASP_EUNKNOWN,
          "an unknown ending is read");
    CHECK(asp_height_field_read(temporary_path("none.f32"), &f, &err) == ASP_EIO,
          "a missing file is read");
}

int main(void)
{
    test_refusals();
    test_same_seed();
    test_fft();
    test_gaussian();
    test_correlation();
    test_student();
    test_by_hand();
    test_read();
    return finish();
}
