/* test_nearest.c - the nearest distribution of another model: members found again, norms against plain
 * sums over the hemisphere, optimality, and the fits by hand of the 2013 notebook
 *
 * The notebook moved one number until two plots of D over theta had the same peak. The numbers to be found
 * were computed apart, by bisection on the closed normalisation factors with mpmath. */
#include "asperity_data.h"
#include "asperity_ndf.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int passed, failed;

static void expect(int good, const char *what, const char *more, double a, double b)
{
    passed += good;
    failed += !good;
    if (!good)
        printf("FAILED: %s, %s: %.12g, expected %.12g\n", what, more, a, b);
}

static void near(const char *what, const char *more, double a, double b, double tolerance)
{
    expect(fabs(a - b) <= tolerance * fabs(b), what, more, a, b);
}

static int make(const char *spec, asp_ndf *out)
{
    asp_error err;
    int good = asp_ndf_parse(NULL, spec, out, &err) == ASP_OK;
    expect(good, "parse", spec, 0, 1);
    return good;
}

static int norm_index(const char *name)
{
    for (int i = 0; asp_norms()[i]; i++)
        if (!strcmp(asp_norms()[i]->name, name))
            return i;
    return -1;
}

/* ---- one distribution under two names */

static void same_surfaces(void)
{
    static const struct { const char *target, *model; double shape[2]; double alpha_x, alpha_y; } rows[] = {
        { "ggx:alpha=0.3", "student_t", { 2 }, 0.3, 0.3 },
        { "student_t:alpha=0.05,gamma=2", "ggx", { 0 }, 0.05, 0.05 },
        { "beckmann:alpha=0.6", "student_t", { INFINITY }, 0.6, 0.6 },
        { "student_t:alpha=0.2,gamma=inf", "beckmann", { 0 }, 0.2, 0.2 },
        { "student_t:alpha_x=0.4,alpha_y=0.1,rotation=0.5,mean_x=0.3,gamma=3.7", "student_t", { 3.7 }, 0.4, 0.1 },
        { "phong:exponent=20", "student_t", { 12 }, 0.30151134457776363, 0.30151134457776363 },
        { "student_t:alpha=0.5,gamma=5", "phong", { 6 }, 0.5, 0.5 },
        { "ellipsoid:alpha_x=0.2,alpha_y=0.1,theta_x=0.3", "ggx", { 0 }, 0, 0 },
    };
    static const char *const names[] = { "theta", "l2", "l1_cos", "slope", "log" };
    printf("one distribution under two names\n");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (int k = 0; k < 5; k++) {
            asp_ndf target, back;
            asp_nearest_options o = { .norm = names[k] };
            static asp_nearest_result r;
            char text[ASP_NDF_TEXT];
            const asp_model *model = asp_find_model(NULL, rows[i].model);
            if (!make(rows[i].target, &target))
                continue;
            expect(asp_nearest(&target, model, &o, &r, NULL) == ASP_OK, rows[i].target, names[k], 0, 1);
            if (k == 0)
                printf("  %-72s -> %-10s error %.1e\n", rows[i].target, model->name, r.error);
            expect(r.error < 2e-6, rows[i].target, names[k], r.error, 0);
            if (model->param_count && isfinite(rows[i].shape[0]))
                near(rows[i].target, names[k], r.ndf.shape[0], rows[i].shape[0], 1e-5);
            else if (model->param_count)
                expect(r.ndf.shape[0] > 1e5, rows[i].target, names[k], r.ndf.shape[0], INFINITY);
            asp_roughness q = asp_map_to_roughness(&r.ndf.map);
            if (rows[i].alpha_x > 0) {
                near(rows[i].target, names[k], q.alpha_x, rows[i].alpha_x, 1e-5);
                near(rows[i].target, names[k], q.alpha_y, rows[i].alpha_y, 1e-5);
            }
            near(rows[i].target, names[k], r.peak, 1, 1e-5);
            /* its text is the same distribution */
            expect(asp_ndf_text(&r.ndf, 17, text, sizeof text) == strlen(text), text, "length", 0, 0);
            if (make(text, &back))
                for (int j = 0; j < 20; j++)
                    near(text, "read back", asp_P22(&back, 0.03 * j, 0.1 - 0.02 * j),
                         asp_P22(&r.ndf, 0.03 * j, 0.1 - 0.02 * j), 1e-12);
        }
    char small[20];
    asp_ndf n;
    if (make("beckmann:alpha=0.3,mean_x=0.1", &n))
        expect(asp_ndf_text(&n, 17, small, sizeof small) == 0, "a small buffer", "", 0, 0);
}

/* ---- norms by plain sums of D over theta and phi */

static void plain_errors(const asp_ndf *m, const asp_ndf *d, int sectors, double error[ASP_NORM_LIMIT])
{
    enum { N = 4000 };
    double top[ASP_NORM_LIMIT] = { 0 }, bottom[ASP_NORM_LIMIT] = { 0 }, peak;
    asp_vec2 t = asp_mean_slope(d);
    peak = asp_P22(d, t.x, t.y);
    for (int i = 0; i < N; i++)
        for (int j = 0; j < sectors; j++) {
            double x = (i + 0.5) / N, theta = 1.5707963267948966 * x * x, phi = 6.283185307179586 * (j + 0.5) / sectors;
            double dt = 3.1415926535897931 * x / N, c = cos(theta), s = sin(theta);
            double solid = s * dt * 6.283185307179586 / sectors, e = 1e-3 * peak;
            asp_vec3 w = { s * cos(phi), s * sin(phi), c };
            double a = asp_D(m, w), b = asp_D(d, w), ratio = log((a + e) / (b + e));
            double weights[5] = { dt / sectors, solid, solid * c, solid * c, solid * pow(c, 5) };
            for (int k = 0; k < 5; k++) {
                top[k] += weights[k] * (k == 3 ? fabs(a - b) : (a - b) * (a - b));
                bottom[k] += weights[k] * b * b;
            }
            top[5] += ratio * ratio * solid * c / 3.1415926535897931;
        }
    for (int k = 0; k < 5; k++)
        error[k] = k == 3 ? top[k] : sqrt(top[k] / bottom[k]);
    error[5] = sqrt(top[5]);
}

static void norms(void)
{
    static const struct { const char *target, *model; double alpha; int sectors; } rows[] = {
        { "ggx:alpha=0.3", "beckmann", 0.3, 1 }, { "ggx:alpha=0.05", "beckmann", 0.06, 1 },
        { "beckmann:alpha=1.5", "ggx", 0.8, 1 },
        { "ggx:alpha_x=0.5,alpha_y=0.2,rotation=0.4,mean_x=0.3,mean_y=0.2", "beckmann", 0.3, 720 },
    };
    printf("norms beside plain sums             theta     l2     l2_cos   l1_cos    slope    log\n");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        asp_ndf target;
        asp_nearest_options o = { .alpha = rows[i].alpha };
        static asp_nearest_result r;
        double plain[ASP_NORM_LIMIT];
        if (!make(rows[i].target, &target))
            continue;
        expect(asp_nearest(&target, asp_find_model(NULL, rows[i].model), &o, &r, NULL) == ASP_OK, rows[i].target, "", 0, 1);
        plain_errors(&r.ndf, &target, rows[i].sectors, plain);
        printf("  %.32s\n%36s", rows[i].target, "");
        for (int k = rows[i].sectors > 1; k < 6; k++) {   /* theta has a pole at the normal if skewed */
            printf(" %8.5f", r.errors[k]);
            near(rows[i].target, asp_norms()[k]->name, r.errors[k], plain[k], 2e-4);
        }
        printf("\n");
    }
}

/* ---- no neighbour is nearer */

static void optimal(void)
{
    static const char *const rows[][2] = { { "ggx:alpha=0.3", "beckmann" }, { "beckmann:alpha=0.8", "ggx" },
                                           { "beckmann:alpha=0.3", "student_t" }, { "student_t:alpha=0.3,gamma=1.6", "ggx" },
                                           { "ggx:alpha=0.3", "abc" }, { "ggx:alpha=0.4", "phong" } };
    printf("no neighbour is nearer\n");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        for (int norm = 0; norm < 6; norm++) {
            asp_ndf target;
            const asp_model *model = asp_find_model(NULL, rows[i][1]);
            static asp_nearest_result r, near_by;
            asp_nearest_options o = { .norm = asp_norms()[norm]->name };
            if (!model || !make(rows[i][0], &target) || (norm > 1 && model->area_error > 0))
                continue;
            expect(asp_nearest(&target, model, &o, &r, NULL) == ASP_OK, rows[i][0], o.norm, 0, 1);
            o.fixed = (1u << model->param_count) - 1;
            asp_roughness q = asp_map_to_roughness(&r.ndf.map);
            for (int k = model->own_scale ? 1 : 0; k <= (int)model->param_count; k++)
                for (int sign = -1; sign <= 1; sign += 2) {
                    double by = 1 + 1e-3 * sign;
                    memcpy(o.shape, r.ndf.shape, sizeof o.shape);
                    o.alpha = model->own_scale ? 0 : sqrt(q.alpha_x * q.alpha_y) * (k ? 1 : by);
                    if (k)
                        o.shape[k - 1] *= by;
                    if (asp_nearest(&target, model, &o, &near_by, NULL))
                        continue;               /* past the end of the range */
                    expect(near_by.error >= r.error * (1 - 1e-9), rows[i][0], o.norm, near_by.error, r.error);
                }
        }
}

/* ---- the notebook and the STD paper */

static void notebook(void)
{
    static const struct {
        const char *target, *model;
        double gamma, printed, exact, tolerance, off;    /* off: per cent over theta; 0: not stated */
    } rows[] = {
        { "ggx:alpha=0.3", "abc", 1.75, 23.5, 23.444, 2e-5, 0.8 }, { "ggx:alpha=0.4", "abc", 1.75, 11.6, 11.582, 2e-5, 2.14 },
        { "ggx:alpha=0.5", "abc", 1.75, 6.3, 6.3102, 2e-5, 3.76 }, { "ggx:alpha=0.6", "abc", 1.75, 3.55, 3.5736, 2e-5, 5.32 },
        { "ggx:alpha=0.7", "abc", 1.75, 2.0, 2.0040, 3e-5, 6.4 },
        { "phong:exponent=20.222222222222222", "abc", 1000, 0.0212, 0.02119, 3e-4, 1.1 },
        { "phong:exponent=10.5", "abc", 1000, 0.0114, 0.01141, 5e-4, 0 }, { "phong:exponent=6", "abc", 1000, 0.0068, 0.006835, 1e-4, 3.1 },
        { "phong:exponent=3.5555555555555556", "abc", 1000, 0.0043, 0.004277, 1.2e-4, 0 },
        { "phong:exponent=2.0816326530612246", "abc", 1000, 0.0026, 0.002652, 2e-4, 7.7 },
        { "ggx:alpha=0.2", "abc", 0.5, 4250, 4245.2, 1e-4, 0 }, { "ggx:alpha=0.3", "abc", 0.5, 785, 789.78, 1e-4, 0 },
        { "ggx:alpha=0.4", "abc", 0.5, 240, 228.54, 1e-4, 0 }, { "ggx:alpha=0.5", "abc", 0.5, 82.5, 82.553, 1e-4, 0 },
        { "ggx:alpha=0.6", "abc", 0.5, 33.5, 33.435, 1e-4, 0 }, { "ggx:alpha=0.7", "abc", 0.5, 14, 14.095, 1e-4, 0 },
        { "ggx:alpha=0.8", "abc", 0.5, 5.75, 5.6856, 1e-4, 0 },
        { "phong:exponent=8", "gtr", 1e4, 0.999752, 0.99975181, 1e-8, 5.4 }, { "phong:exponent=4", "gtr", 1e4, 0.999859, 0.99985895, 1e-8, 0 },
        { "phong:exponent=2", "gtr", 1e4, 0.99992, 0.99992032, 1e-8, 0 }, { "phong:exponent=1", "gtr", 1e4, 0.999956, 0.99995629, 1e-8, 19 },
        { "phong:exponent=100", "gtr", 1e4, 0.99745, 0.99745946, 1e-8, 0.5 }, { "phong:exponent=50", "gtr", 1e4, 0.9987, 0.99870240, 1e-8, 0 },
        { "phong:exponent=25", "gtr", 1e4, 0.999325, 0.99932562, 1e-8, 0 },
        { "abc:alpha=4250,gamma=0.5", "gtr", 0.54, 0, 0.0255193, 3e-6, 4.6 }, { "abc:alpha=785,gamma=0.5", "gtr", 0.54, 0, 0.0560768, 3e-6, 2.4 },
        { "abc:alpha=240,gamma=0.5", "gtr", 0.54, 0, 0.0973288, 3e-6, 2.3 }, { "abc:alpha=82.5,gamma=0.5", "gtr", 0.54, 0, 0.159239, 5e-6, 3.0 },
        { "abc:alpha=33.5,gamma=0.5", "gtr", 0.54, 0, 0.239007, 5e-6, 3.7 }, { "abc:alpha=14,gamma=0.5", "gtr", 0.54, 0, 0.347616, 5e-6, 4.2 },
        { "abc:alpha=5.75,gamma=0.5", "gtr", 0.54, 0, 0.491061, 5e-6, 4.3 },
        { "phong:exponent=48", "torrance_sparrow", 0, 0.2027, 0.20275, 3e-5, 0 },
        { "phong:exponent=20.222222222222222", "torrance_sparrow", 0, 0.3097, 0.30968, 3e-5, 0 },
        { "phong:exponent=10.5", "torrance_sparrow", 0, 0.425, 0.42445, 3e-5, 0 }, { "phong:exponent=6", "torrance_sparrow", 0, 0.552, 0.55235, 3e-5, 0 },
        { "phong:exponent=3.5555555555555556", "torrance_sparrow", 0, 0.7035, 0.70338, 3e-5, 0 },
        { "phong:exponent=2.0816326530612246", "torrance_sparrow", 0, 0.899, 0.89904, 3e-5, 0 },
        { "phong:exponent=1.125", "torrance_sparrow", 0, 1.195, 1.19494, 3e-5, 0 },
        { "phong:exponent=0.46913580246913580", "torrance_sparrow", 0, 1.81, 1.80833, 3e-5, 0 },
    };
    int off = norm_index("theta");
    printf("the notebook's fits by equal peaks: printed, computed apart, found, per cent over theta\n");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        asp_ndf target;
        const asp_model *model = asp_find_model(NULL, rows[i].model);
        asp_nearest_options o = { .norm = "peak", .fixed = rows[i].gamma > 0 ? 2 : 0, .shape = { 0, rows[i].gamma } };
        static asp_nearest_result r;
        asp_error err;
        if (!model || (!strncmp(rows[i].target, "abc", 3) && !asp_find_model(NULL, "abc"))) {
            printf("  %-36s %-16s absent\n", rows[i].target, rows[i].model);
            continue;
        }
        if (!make(rows[i].target, &target))
            continue;
        expect(asp_nearest(&target, model, &o, &r, &err) == ASP_OK, rows[i].target, rows[i].model, 0, 1);
        printf("  %-36s %-16s %9.6g %11.8g %11.8g %6.2f\n", rows[i].target, rows[i].model, rows[i].printed,
               rows[i].exact, r.ndf.shape[0], 100 * r.errors[off]);
        near(rows[i].target, rows[i].model, r.ndf.shape[0], rows[i].exact, rows[i].tolerance);
        near(rows[i].target, "peak", r.peak, 1, 1e-9);
        /* by hand they came within 3 per cent; one is a slip, 240 for 228.54, and two digits are few */
        if (rows[i].printed > 0)
            near(rows[i].target, "printed", rows[i].printed, rows[i].exact, rows[i].printed == 240 ? 0.06 : 0.025);
        if (rows[i].off > 0)
            expect(fabs(100 * r.errors[off] - rows[i].off) < (rows[i].off > 10 ? 0.5 : 0.06), rows[i].target, "off",
                   100 * r.errors[off], rows[i].off);
    }
}

/* The least distance over theta of GTR with gamma 0.54 to ABC with gamma 0.5, found apart by scipy. */
static void least_theta(void)
{
    static const struct { double abc, gtr; } rows[] = {
        { 4250, 0.026423 }, { 785, 0.056997 }, { 240, 0.097785 }, { 82.5, 0.158375 }, { 33.5, 0.235496 },
        { 14, 0.338816 }, { 5.75, 0.473091 }
    };
    const asp_model *gtr = asp_find_model(NULL, "gtr");
    printf("gtr of gamma 0.54 nearest to abc of gamma 0.5\n");
    for (int i = 0; gtr && asp_find_model(NULL, "abc") && i < 7; i++) {
        char spec[64];
        asp_ndf target;
        asp_nearest_options o = { .fixed = 2, .shape = { 0, 0.54 } };
        static asp_nearest_result r;
        snprintf(spec, sizeof spec, "abc:alpha=%g,gamma=0.5", rows[i].abc);
        if (!make(spec, &target))
            continue;
        expect(asp_nearest(&target, gtr, &o, &r, NULL) == ASP_OK, spec, "", 0, 1);
        near(spec, "least theta", r.ndf.shape[0], rows[i].gtr, 2e-5);
    }
}

/* STD with gamma = 40 stands for Beckmann: off by 1.38 % of cosine-weighted area at equal alpha, any alpha;
 * at its best, 1.17 %. */
static void beckmann_limit(void)
{
    static const double alphas[] = { 0.01, 0.1, 0.5, 1 };
    printf("student_t of gamma 40 to beckmann\n");
    for (int i = 0; i < 4; i++) {
        char spec[64];
        asp_ndf target;
        static asp_nearest_result same, best;
        asp_nearest_options o = { .norm = "l1_cos", .alpha = alphas[i] };
        snprintf(spec, sizeof spec, "student_t:alpha=%g,gamma=40", alphas[i]);
        if (!make(spec, &target))
            continue;
        expect(asp_nearest(&target, asp_find_model(NULL, "beckmann"), &o, &same, NULL) == ASP_OK, spec, "", 0, 1);
        o.alpha = 0;
        expect(asp_nearest(&target, asp_find_model(NULL, "beckmann"), &o, &best, NULL) == ASP_OK, spec, "", 0, 1);
        printf("  alpha %-5g equal %.3f %%, nearest %.3f %% at %.6g\n", alphas[i], 100 * same.error, 100 * best.error,
               asp_map_to_roughness(&best.ndf.map).alpha_x);
        near(spec, "equal alpha", 100 * same.error, 1.38, 5e-3);
        expect(best.error < 0.86 * same.error, spec, "nearest", best.error, same.error);
    }
}

static void refusals(void)
{
    static const struct { const char *target, *model, *norm; double alpha; unsigned fixed; double shape; asp_status status; const char *name; } rows[] = {
        { "ggx:alpha=0.3", "beckmann", "l3", 0, 0, 0, ASP_EUNKNOWN, "l3" },
        { "ggx:alpha=0.3", "beckmann", "l2", 1e3, 0, 0, ASP_EINVAL, "alpha" },
        { "ggx:alpha=0.3", "beckmann", "l2", NAN, 0, 0, ASP_EINVAL, "alpha" },
        { "ggx:alpha=0.3", "student_t", "l2", 0, 1, 1.5, ASP_EINVAL, "gamma" },
        { "ggx:alpha=0.3", "beckmann", "peak", 0.3, 0, 0, ASP_EINVAL, "alpha" },
        { "ggx:alpha=3", "phong", "peak", 0, 0, 0, ASP_EINVAL, "exponent" },
        { "ggx:alpha=3", "phong", "peak", 0, 1, 5, ASP_EINVAL, "exponent" },
    };
    printf("refusals\n");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        asp_ndf target;
        asp_error err;
        asp_nearest_options o = { .norm = rows[i].norm, .alpha = rows[i].alpha, .fixed = rows[i].fixed, .shape = { rows[i].shape } };
        static asp_nearest_result r;
        r.error = 7;
        if (!make(rows[i].target, &target))
            continue;
        asp_status s = asp_nearest(&target, asp_find_model(NULL, rows[i].model), &o, &r, &err);
        expect(s == rows[i].status && r.error == 7, rows[i].model, rows[i].norm, s, rows[i].status);
        expect(!strcmp(err.name, rows[i].name), err.name, rows[i].name, 0, 0);
    }
}

int main(void)
{
    same_surfaces();
    norms();
    optimal();
    notebook();
    least_theta();
    beckmann_limit();
    refusals();
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
