/* test_float32.c - what asperity.h section 9 says of float32 against float64 at the same directions */
#include "asperity_ndf.h"
#include "core/rng.h"

#include <math.h>
#include <stdio.h>

extern const asp_model asp_model_abc, asp_model_sgd, asp_model_gtr, asp_model_torrance_sparrow;

static const char *const specs[] = {
    "ggx:alpha=0.3", "ggx:alpha=0.017", "student_t:alpha=0.3,gamma=1.51", "student_t:alpha=0.3,gamma=3.7",
    "student_t:alpha=0.7,gamma=10", "student_t:alpha=0.07,gamma=200", "beckmann:alpha=0.3",
    "beckmann:alpha=0.07", "beckmann:alpha=1.3", "student_t:alpha=2.3,gamma=inf",
    "phong:exponent=20", "phong:exponent=2000", "hyper_cauchy:alpha=0.3", "student_t_general:alpha=0.3"
};
/* prepared ones, with their shape numbers; `slope`: error of D per E, of section 9 */
static const struct row { const asp_model *model; double a, b, slope; } rows[] = {
    { &asp_model_abc, 20, 1.75, 3e-7 }, { &asp_model_abc, 200, 0.7, 3e-7 }, { &asp_model_abc, 0.5, 40, 3e-7 },
    { &asp_model_sgd, 0.1, 0.5, 3e-7 }, { &asp_model_sgd, 0.003, 1.8, 3e-7 }, { &asp_model_sgd, 1.2, 0.1, 3e-7 },
    { &asp_model_gtr, 0.3, 1.5, 3e-7 }, { &asp_model_gtr, 0.03, 1, 3e-7 }, { &asp_model_gtr, 0.7, 6, 3e-7 },
    { &asp_model_torrance_sparrow, 0.3, 0, 4e-7 }, { &asp_model_torrance_sparrow, 0.04, 0, 4e-7 },
    { &asp_model_torrance_sparrow, 3, 0, 4e-7 }, { &asp_model_torrance_sparrow, 0.004, 0, 4e-7 }
};

static int passed, failed;

static void expect(const char *what, const char *spec, double worst)
{
    int good = worst <= 1.0;
    printf("%-6s %-32s worst %.2f of what is stated%s\n", what, spec, worst, good ? "" : "  FAILED");
    passed += good;
    failed += !good;
}

static void check(const asp_ndf *made, const char *spec, double slope, uint64_t seed)
{
    uint64_t stream = aspi_random_start(seed, 0);
    double worst_D = 0.0, worst_visible = 0.0, worst_sigma = 0.0, peak = 0.0, top;
    asp_vec3f wi = { 0.6f, 0.0f, 0.8f };
    asp_vec3 wide = { (double)0.6f, 0.0, (double)0.8f };
    asp_ndff f;
    asp_ndf n = *made;
    uint64_t i;
    int j;
    f = asp_ndf_narrow(&n);
    top = asp_P22(&n, 0.0, 0.0);
    for (j = 0; j < 2000; j++) {
        double t = 1.57 * j / 2000;
        asp_vec3 m = { sin(t), 0.0, cos(t) };
        peak = fmax(peak, asp_D(&n, m));
    }
    for (i = 0; i < 200000; i++) {
        double u = aspi_unit64(aspi_random_at(stream, 2 * i)), t = 1.5706 * u * u;
        double phi = 6.2831853 * aspi_unit64(aspi_random_at(stream, 2 * i + 1));
        asp_vec3f m = { (float)(sin(t) * cos(phi)), (float)(sin(t) * sin(phi)), (float)cos(t) };
        asp_vec3 w = { m.x, m.y, m.z };
        double D = asp_D(&n, w), stated, v, cosine = wide.x * w.x + wide.z * w.z;
        worst_sigma = fmax(worst_sigma, fabs(asp_sigmaf(&f, m) / asp_sigma(&n, w) - 1.0) / 2e-6);
        if (!(D > 1e-6 * peak))
            continue;
        stated = 1e-6 + slope * log(top / asp_P22(&n, -w.x / w.z, -w.y / w.z));
        worst_D = fmax(worst_D, fabs(asp_Df(&f, m) / D - 1.0) / stated);
        v = asp_pdf_visible(&n, wide, w);
        if (cosine > 0.1) /* the cosine's own cancellation is the input's */
            worst_visible = fmax(worst_visible,
                                 fabs(asp_pdf_visiblef(&f, wi, m) / v - 1.0) / stated);
    }
    expect("D", spec, worst_D);
    expect("visible", spec, worst_visible);
    expect("sigma", spec, worst_sigma);
}

int main(void)
{
    asp_ndf n;
    asp_map map;
    size_t i;
    for (i = 0; i < sizeof specs / sizeof *specs; i++) {
        if (asp_ndf_parse(NULL, specs[i], &n, NULL))
            expect("parse", specs[i], INFINITY);
        else
            check(&n, specs[i], 3e-7, 7 + i);
    }
    for (i = 0; i < sizeof rows / sizeof *rows; i++) {
        double shape[2];
        char name[64];
        shape[0] = rows[i].a;
        shape[1] = rows[i].b;
        snprintf(name, sizeof name, "%s %g %g", rows[i].model->name, rows[i].a, rows[i].b);
        if (asp_map_from_roughness(1, 1, 0, 0, 0, &map, NULL)
            || asp_ndf_make(rows[i].model, &map, shape, &n, NULL))
            expect("make", name, INFINITY);
        else
            check(&n, name, rows[i].slope, 40 + i);
    }
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
