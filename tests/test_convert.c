/* test_convert.c - conventions of roughness, and moments of slopes there and back */
#include "asperity_convert.h"
#include "core/rng.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int passed, failed;

static void expect(int good, const char *what, double a, double b)
{
    passed += good;
    failed += !good;
    if (!good)
        printf("FAILED: %s: %.17g, expected %.17g\n", what, a, b);
}

static void near(const char *what, double a, double b, double tolerance)
{
    expect(fabs(a - b) <= tolerance * fabs(b), what, a, b);
}

/* alpha worked out by hand from the formula of each system */
static void values(void)
{
    static const struct { const char *spec; double x, y, rotation; } rows[] = {
        { "disney:roughness=0.5", 0.25, 0.25, 0 },
        { "disney:roughness=0.5,anisotropic=0.3", 0.29260286799, 0.213600093633, 0 },
        { "disney:roughness=0.5,anisotropic=1", 0.790569415042, 0.0790569415042, 0 },
        { "disney:roughness=0.01", 0.001, 0.001, 0 },
        { "gltf:roughness=0.4,anisotropyStrength=0.5", 0.37, 0.16, 0 },
        { "gltf:roughness=0.4,anisotropyStrength=1,anisotropyRotation=0.3", 1, 0.16, 0.3 },
        { "materialx:roughness=0.5,anisotropy=0.75", 0.5, 0.125, 0 },
        { "materialx:roughness=0.9,anisotropy=0.99", 1, 0.114551298552, 0 },
        { "openpbr:roughness=0.5,anisotropy=0", 0.25, 0.25, 0 },
        { "openpbr:roughness=0.5,anisotropy=0.5", 0.316227766017, 0.158113883008, 0 },
        { "filament:roughness=0.5,anisotropy=-0.4", 0.15, 0.35, 0 },
        { "imageworks:roughness=0.5,anisotropy=0.4", 0.35, 0.15, 0 },
        { "pbrt:uroughness=0.09,vroughness=0.25,rotation=1", 0.3, 0.5, 1 },
        { "pbrt3:uroughness=1,vroughness=0.1", 1.62142, 0.461760032009, 0 },
        { "mitsuba:alpha_x=0.2,alpha_y=0.1", 0.2, 0.1, 0 },
        { "smoothness:smoothness=0.6", 0.16, 0.16, 0 },
        { "exponent:exponent=20.222222222222222", 0.3, 0.3, 0 },   /* the notebook: 2/alpha^2 - 2 */
        { "blinn_phong:exponent=0", 1, 1, 0 },
    };
    printf("conventions\n");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        const asp_convention *c = NULL;
        asp_roughness r = { 0, 0, 0, 0, 0 };
        expect(asp_convention_parse(rows[i].spec, &c, &r, NULL) == ASP_OK, rows[i].spec, 1, 0);
        near(rows[i].spec, r.alpha_x, rows[i].x, 1e-11);
        near(rows[i].spec, r.alpha_y, rows[i].y, 1e-11);
        near(rows[i].spec, r.rotation, rows[i].rotation, 1e-15);
        printf("  %-66s %.12g %.12g\n", rows[i].spec, r.alpha_x, r.alpha_y);
    }
}

/* Random numbers of each convention to alpha, back, and to alpha again. */
static void round_trips(void)
{
    uint64_t stream = aspi_random_start(3, 0), at = 0;
    printf("there and back\n");
    for (const asp_convention *const *c = asp_conventions(); *c; c++) {
        double worst = 0, v[ASP_CONVENTION_NUMBERS], back[ASP_CONVENTION_NUMBERS];
        int made = 0, refused = 0;
        for (int i = 0; i < 20000; i++) {
            asp_roughness r, s;
            for (size_t k = 0; k < (*c)->param_count; k++) {
                const asp_param *p = &(*c)->params[k];
                double u = aspi_unit64(aspi_random_at(stream, at++));
                double high = p->high > 1e3 ? 3 : p->high, low = p->low < -10 ? -3 : p->low;
                v[k] = low + (high - low) * u * u;
            }
            if (asp_convention_to_alpha(*c, v, &r, NULL))
                continue;
            made++;
            if (asp_convention_from_alpha(*c, &r, back, NULL)) {
                refused++;
                continue;
            }
            expect(asp_convention_to_alpha(*c, back, &s, NULL) == ASP_OK, (*c)->name, 1, 0);
            double large = fmax(r.alpha_x, r.alpha_y), small = fmin(r.alpha_x, r.alpha_y);
            worst = fmax(worst, fabs(fmax(s.alpha_x, s.alpha_y) - large) / large);
            worst = fmax(worst, fabs(fmin(s.alpha_x, s.alpha_y) - small) / large);
            /* the rougher axis is the same line */
            double a = r.rotation + (r.alpha_x < r.alpha_y ? asin(1) : 0);
            double b = s.rotation + (s.alpha_x < s.alpha_y ? asin(1) : 0);
            if (large > small * (1 + 1e-6))
                worst = fmax(worst, fabs(sin(a - b)));
        }
        printf("  %-10s %5d made, %3d not sayable, worst %.1e\n", (*c)->name, made, refused, worst);
        /* what a clamp made is another roughness than its numbers say, but still one of the system's */
        expect(refused == 0 || !strcmp((*c)->name, "disney") || !strcmp((*c)->name, "materialx"),
               (*c)->name, refused, 0);
        expect(made > 10000 && worst < 1e-12, (*c)->name, worst, 1e-12);
    }
}

static void refusals(void)
{
    static const struct { const char *convention; double x, y, mean; const char *name; } rows[] = {
        { "disney", 0.5, 0.04, 0, "anisotropic" }, { "disney", 0.002, 0.0005, 0, "disney" },
        { "gltf", 1.5, 0.5, 0, "anisotropyStrength" }, { "gltf", 1.5, 1.5, 0, "roughness" }, { "pbrt3", 0.01, 0.01, 0, "pbrt3" },
        { "materialx", 1.5, 1.3, 0, "roughness" }, { "exponent", 0.3, 0.2, 0, "exponent" },
        { "smoothness", 1.5, 1.5, 0, "smoothness" }, { "disney", 0.3, 0.3, 0.1, "disney" },
    };
    static const char *const specs[][2] = {
        { "disney:roughness=20", "roughness" }, { "disney:anisotropic=1.5", "anisotropic" },
        { "disney:roughnes=0.5", "roughnes" }, { "dysney:roughness=0.5", "dysney" },
        { "pbrt:uroughness=0,vroughness=1", "uroughness" }, { "gltf:roughness=0.001", "alpha_x" },
        { "smoothness:smoothness=1", "alpha_x" }, { "exponent:exponent=nan", "exponent" },
    };
    printf("refusals\n");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        asp_roughness r = { rows[i].x, rows[i].y, 0, rows[i].mean, 0 };
        double v[ASP_CONVENTION_NUMBERS] = { 7, 7, 7, 7 };
        asp_error err;
        asp_status s = asp_convention_from_alpha(asp_find_convention(rows[i].convention), &r, v, &err);
        expect(s == ASP_EINVAL && v[0] == 7, rows[i].convention, s, ASP_EINVAL);
        expect(!strcmp(err.name, rows[i].name), err.name, 0, 0);
    }
    for (size_t i = 0; i < sizeof specs / sizeof *specs; i++) {
        const asp_convention *c;
        asp_roughness r;
        asp_error err;
        expect(asp_convention_parse(specs[i][0], &c, &r, &err) != ASP_OK, specs[i][0], 0, 1);
        expect(!strcmp(err.name, specs[i][1]), err.name, 0, 0);
    }
    expect(asp_find_convention("") == NULL, "no name", 0, 0);
}

/* Moments of distributions: closed forms, then a Monte Carlo estimate of each entry. */
static void moments(void)
{
    static const struct { const char *spec; double v; } rows[] = {
        { "beckmann:alpha=0.3", 0.5 }, { "student_t:alpha=0.3,gamma=inf", 0.5 },
        { "student_t:alpha=0.3,gamma=2.05", 1.05 / 0.1 }, { "student_t:alpha=0.3,gamma=3", 1 },
        { "student_t:alpha=0.3,gamma=40", 39.0 / 76 }, { "student_t:alpha=0.01,gamma=1000", 999.0 / 1996 },
        { "beckmann:alpha_x=0.5,alpha_y=0.1,rotation=0.4,mean_x=0.3,mean_y=-1", 0.5 },
        { "student_t:alpha_x=0.5,alpha_y=0.1,rho=0.7,mean_x=0.3,gamma=2.5", 1.5 },
    };
    printf("moments of distributions\n");
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        asp_ndf n, again;
        asp_moments m;
        asp_map map;
        if (asp_ndf_parse(NULL, rows[i].spec, &n, NULL) || asp_ndf_moments(&n, &m, NULL)) {
            expect(0, rows[i].spec, 0, 1);
            continue;
        }
        asp_roughness r = asp_map_to_roughness(&n.map);
        double c = cos(r.rotation), s = sin(r.rotation), v = rows[i].v;
        double x2 = r.alpha_x * r.alpha_x, y2 = r.alpha_y * r.alpha_y;
        near(rows[i].spec, m.xx, v * (c * c * x2 + s * s * y2) + r.mean_x * r.mean_x, 1e-12);
        near(rows[i].spec, m.yy, v * (s * s * x2 + c * c * y2) + r.mean_y * r.mean_y, 1e-12);
        expect(fabs(m.xy - (v * c * s * (x2 - y2) + r.mean_x * r.mean_y)) < 1e-12, rows[i].spec, m.xy, 0);
        /* and back: the same distribution */
        expect(asp_map_from_moments(n.model, n.shape, &m, &map, NULL) == ASP_OK, rows[i].spec, 0, 1);
        expect(asp_ndf_make(n.model, &map, n.shape, &again, NULL) == ASP_OK, rows[i].spec, 0, 1);
        for (int k = 0; k < 50; k++) {
            double px = r.mean_x + 0.1 * (k % 7 - 3), py = r.mean_y + 0.02 * (k % 5 - 2);
            near(rows[i].spec, asp_P22(&again, px, py), asp_P22(&n, px, py), 1e-10);
        }
        /* Monte Carlo; the fourth moment must exist */
        if (v > 0.6)
            continue;
        enum { SAMPLES = 400000 };
        uint64_t stream = aspi_random_start(11 + i, 0);
        double sum[5] = { 0 };
        for (uint64_t k = 0; k < SAMPLES; k++) {
            asp_vec3 f = asp_sample_normal(&n, aspi_unit64(aspi_random_at(stream, 2 * k)),
                                           aspi_unit64(aspi_random_at(stream, 2 * k + 1)));
            double x = -f.x / f.z, y = -f.y / f.z;
            sum[0] += x;
            sum[1] += y;
            sum[2] += x * x;
            sum[3] += x * y;
            sum[4] += y * y;
        }
        double spread = sqrt(m.xx + m.yy) / sqrt(SAMPLES);
        expect(fabs(sum[0] / SAMPLES - m.mean_x) < 5 * spread, "mean_x", sum[0] / SAMPLES, m.mean_x);
        expect(fabs(sum[2] / SAMPLES - m.xx) < 20 * (m.xx + m.yy) / sqrt(SAMPLES), "xx",
               sum[2] / SAMPLES, m.xx);
        expect(fabs(sum[3] / SAMPLES - m.xy) < 20 * (m.xx + m.yy) / sqrt(SAMPLES), "xy",
               sum[3] / SAMPLES, m.xy);
        printf("  %-66s mean %.4f (%.4f) xx %.5f (%.5f)\n", rows[i].spec, m.mean_x, sum[0] / SAMPLES,
               m.xx, sum[2] / SAMPLES);
    }
}

static void infinite(void)
{
    static const char *const specs[] = { "ggx:alpha=0.3", "student_t:alpha=0.1,gamma=2",
                                         "student_t:alpha=0.1,gamma=1.6", "ellipsoid:alpha=0.2,theta_x=0.3" };
    asp_moments m = { 7, 7, 7, 7, 7 };
    asp_map map;
    asp_error err;
    printf("infinite covariances, and none\n");
    for (size_t i = 0; i < sizeof specs / sizeof *specs; i++) {
        asp_ndf n;
        expect(asp_ndf_parse(NULL, specs[i], &n, NULL) == ASP_OK, specs[i], 0, 0);
        expect(asp_ndf_moments(&n, &m, &err) == ASP_EINVAL && m.xx == 7, specs[i], m.xx, 7);
        expect(strstr(err.reason, "infinite") != NULL, err.reason, 0, 0);
    }
    const asp_model *beckmann = asp_find_model(NULL, "beckmann"), *ggx = asp_find_model(NULL, "ggx");
    asp_moments good = { 0.1, 0.2, 0.05, 0.02, 0.08 }, flat = { 0.1, 0.2, 0.01, 0.02, 0.04 };
    expect(asp_map_from_moments(ggx, NULL, &good, &map, &err) == ASP_EINVAL, "ggx", 0, 1);
    expect(asp_map_from_moments(beckmann, NULL, &flat, &map, &err) == ASP_EINVAL, "flat", 0, 1);
    expect(!strcmp(err.name, "covariance"), err.name, 0, 0);
    expect(asp_map_from_moments(beckmann, NULL, &good, &map, &err) == ASP_OK, "good", 0, 1);
}

/* A normal map's texels: LEAN's B and M, computed in another way. */
static void texels(void)
{
    enum { N = 1000 };
    static double x[N], y[N], z[N], w[N];
    double total = 0, b[2] = { 0 }, m2[3] = { 0 };
    uint64_t stream = aspi_random_start(5, 0);
    for (uint64_t i = 0; i < N; i++) {
        double length = 0.5 + aspi_unit64(aspi_random_at(stream, 4 * i));
        double theta = aspi_unit64(aspi_random_at(stream, 4 * i + 1)), phi = 6.28 * aspi_unit64(aspi_random_at(stream, 4 * i + 2));
        w[i] = aspi_unit64(aspi_random_at(stream, 4 * i + 3));
        x[i] = length * sin(theta) * cos(phi);
        y[i] = length * sin(theta) * sin(phi);
        z[i] = length * cos(theta);
        total += w[i];
        b[0] += w[i] * tan(theta) * cos(phi);
        b[1] += w[i] * tan(theta) * sin(phi);
        m2[0] += w[i] * pow(tan(theta) * cos(phi), 2);
        m2[1] += w[i] * pow(tan(theta), 2) * cos(phi) * sin(phi);
        m2[2] += w[i] * pow(tan(theta) * sin(phi), 2);
    }
    asp_cvec3s normals = { x, y, z };
    asp_moments m = { 0, 0, 0, 0, 0 };
    printf("texels\n");
    expect(asp_normals_moments(N, normals, w, &m, NULL) == ASP_OK, "texels", 0, 1);
    near("B.x", -m.mean_x, b[0] / total, 1e-12);
    near("B.y", -m.mean_y, b[1] / total, 1e-12);
    near("M.xx", m.xx, m2[0] / total, 1e-12);
    near("M.xy", m.xy, m2[1] / total, 1e-11);
    near("M.yy", m.yy, m2[2] / total, 1e-12);
    z[500] = -z[500];
    expect(asp_normals_moments(N, normals, w, &m, NULL) == ASP_EINVAL, "below", 0, 1);
    expect(asp_normals_moments(0, normals, NULL, &m, NULL) == ASP_EINVAL, "none", 0, 1);
    z[500] = -z[500];
    w[3] = -1;
    expect(asp_normals_moments(N, normals, w, &m, NULL) == ASP_EINVAL, "weight", 0, 1);
}

int main(void)
{
    values();
    round_trips();
    refusals();
    moments();
    infinite();
    texels();
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
