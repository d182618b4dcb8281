/* test_student_models.c - the distributions that are Student's t under other numbers
 *
 * Phong, hyper-Cauchy and the paper's general family against their own closed forms, against one
 * another, and in their limits: Beckmann and GGX. Their golden file is test_golden.c's. */
#include "random.h"
#include "asperity.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;
static int passed, failed;

static void report(const char *what, double worst, double bound)
{
    int ok = worst <= bound;
    printf("%-4s %-64s %.3g, bound %g\n", ok ? "ok" : "FAIL", what, worst, bound);
    passed += ok;
    failed += !ok;
}

static asp_ndf make(const char *format, double a, double b)
{
    asp_ndf out;
    asp_error err;
    char spec[200];
    snprintf(spec, sizeof spec, format, a, b);
    if (asp_ndf_parse(NULL, spec, &out, &err) != ASP_OK) {
        printf("FAIL %s: %s: %s\n", spec, err.name, err.reason);
        printf("%d passed, %d failed\n", passed, failed + 1);
        exit(1);
    }
    return out;
}

static asp_vec3 direction(double z)
{
    double s = sqrt((1 - z) * (1 + z)), phi = 2 * pi * uniform();
    asp_vec3 v = { s * cos(phi), s * sin(phi), z };
    return v;
}

static double relative(double got, double want)
{
    return want == 0 ? fabs(got) : fabs(got / want - 1);
}

/* Greatest relative difference of D, of G1 and of sigma from below, down to `least`. */
static double distance(const asp_ndf *a, const asp_ndf *b, double least)
{
    double worst = 0;
    int i;
    for (i = 0; i < 4000; i++) {
        asp_vec3 m = direction(1 - pow(uniform(), 4)), w = direction(1 - uniform() * uniform());
        double d = asp_D(b, m), e = 0;
        if (d > least)
            e = relative(asp_D(a, m), d);
        worst = e <= worst ? worst : e;
        e = relative(asp_G1(a, w, 0), asp_G1(b, w, 0));
        worst = e <= worst ? worst : e;
        w.z = -w.z;
        d = asp_sigma(b, w);
        e = d > least ? relative(asp_sigma(a, w), d) : 0;
        worst = e <= worst ? worst : e;
    }
    return worst;
}

/* (n + 2)/(2 pi) cos^n. */
static void check_phong(void)
{
    static const double exponents[] = { -0.99, -0.5, 0, 1, 2.5, 20, 1000, 1e6 };
    size_t e;
    int i;
    for (e = 0; e < sizeof exponents / sizeof *exponents; e++) {
        double n = exponents[e], worst = 0;
        asp_ndf k = make("phong:exponent=%.17g", n, 0), t;
        char what[100];
        for (i = 0; i < 2000; i++) {
            /* cosines of every size, as many as keep cos^n above underflow */
            double low = fmax(exp(-600 / fmax(n, 1)), 1e-9), c = exp(log(low) * uniform());
            worst = fmax(worst, relative(asp_D(&k, direction(c)), (n + 2) / (2 * pi) * exp(n * log(c))));
        }
        snprintf(what, sizeof what, "phong %g: D = (n + 2)/(2 pi) cos^n", n);
        report(what, worst, 1e-11);
        t = make("student_t:alpha=%.17g,gamma=%.17g", sqrt(2 / (n + 2)), n / 2 + 2);
        snprintf(what, sizeof what, "phong %g is student_t", n);
        report(what, distance(&k, &t, 1e-200), 1e-11);
    }
    {
        /* uniform: G1 = w.z / (1/pi integral of (w.m)+ over the hemisphere) = 2 w.z / (1 + w.z) */
        asp_ndf k = make("phong:exponent=0", 0, 0);
        double worst = 0;
        for (i = 0; i < 1000; i++) {
            double c = uniform();
            worst = fmax(worst, relative(asp_G1(&k, direction(c), 0), 2 * c / (1 + c)));
        }
        report("phong 0: uniform normals, G1 = 2 cos/(1 + cos)", worst, 1e-12);
    }
    {
        /* Beckmann of alpha^2 = 2/(n + 2) for n -> infinity: differs as 1/gamma */
        asp_ndf a = make("phong:exponent=1e4", 0, 0), b = make("beckmann:alpha=%.17g", sqrt(2 / 10002.0), 0);
        asp_ndf c = make("phong:exponent=1e6", 0, 0), d = make("beckmann:alpha=%.17g", sqrt(2 / 1000002.0), 0);
        double first = distance(&a, &b, 1.0), second = distance(&c, &d, 100.0);
        report("phong 1e4 is nearly Beckmann", first, 0.05);
        report("and 1e6 a hundred times nearer", second, first / 80);
    }
    {
        /* an exponent per axis by the map's stretch, and skewed: still Student's t */
        asp_ndf a = make("phong:exponent=48,alpha_x=2,alpha_y=0.5,rotation=0.4,mean_x=0.3", 0, 0);
        asp_ndf b = make("student_t:alpha_x=0.4,alpha_y=0.1,rotation=0.4,mean_x=0.3,gamma=26", 0, 0);
        report("phong stretched, turned and skewed", distance(&a, &b, 1e-100), 1e-11);
    }
}

/* (C - 1) B / (pi cos^4 (1 + B tan^2)^C), eq. 9. */
static double eq9(double B, double C, double cosine)
{
    double t2 = (1 - cosine) * (1 + cosine) / (cosine * cosine);
    return (C - 1) * B / (pi * pow(cosine, 4)) * exp(-C * log1p(B * t2));
}

static void check_general(void)
{
    static const double pairs[][2] = { { 0.01, 1.505 }, { 0.01, 1e4 }, { 1, 1.6 }, { 10, 2 }, { 30, 3.5 },
                                       { 1e4, 1.505 }, { 1e4, 20 }, { 1e4, 1e4 } };
    size_t p;
    int i;
    for (p = 0; p < sizeof pairs / sizeof *pairs; p++) {
        double B = pairs[p][0], C = pairs[p][1], worst = 0, worst_h = 0;
        asp_ndf k = make("student_t_general:B=%.17g,C=%.17g", B, C), t, h;
        char what[100];
        h = make("hyper_cauchy:alpha=%.17g,gamma=%.17g", 1 / sqrt(B), fmin(C, 1000));
        for (i = 0; i < 2000; i++) {
            double c = exp(-7 * uniform()), want = eq9(B, C, c);
            if (want > 1e-250)
                worst = fmax(worst, relative(asp_D(&k, direction(c)), want));
            want = eq9(B, fmin(C, 1000), c);
            if (want > 1e-250)
                worst_h = fmax(worst_h, relative(asp_D(&h, direction(c)), want));
        }
        snprintf(what, sizeof what, "student_t_general B = %g, C = %g: eq. 9", B, C);
        report(what, worst, 1e-11);
        snprintf(what, sizeof what, "hyper_cauchy sigma = %g, gamma = %g: eq. 9", 1 / sqrt(B), fmin(C, 1000));
        report(what, worst_h, 1e-11);
        t = make("student_t:alpha=%.17g,gamma=%.17g", 1 / sqrt(B * (C - 1)), C);
        snprintf(what, sizeof what, "student_t_general B = %g, C = %g is student_t", B, C);
        report(what, distance(&k, &t, 1e-200), 1e-11);
    }
    {
        asp_ndf a = make("hyper_cauchy:alpha=0.4,gamma=2", 0, 0), b = make("ggx:alpha=0.4", 0, 0);
        asp_ndf c = make("student_t_general:B=%.17g,C=2", 1 / 0.16, 0);
        report("hyper_cauchy: gamma 2 is GGX", distance(&a, &b, 0), 1e-11);
        report("student_t_general: C = 2 is GGX", distance(&c, &b, 0), 1e-11);
    }
    {
        /* B C = 1/sigma^2, C large: Beckmann */
        asp_ndf a = make("student_t_general:B=%.17g,C=1e4", 0.01, 0);
        asp_ndf b = make("beckmann:alpha=0.1", 0, 0);
        report("student_t_general: B C = 1/sigma^2, C = 1e4 is nearly Beckmann", distance(&a, &b, 0.5), 0.05);
    }
    {
        asp_ndf a = make("hyper_cauchy:alpha_x=0.4,alpha_y=0.1,rho=0.3,mean_y=-0.2,gamma=5", 0, 0);
        asp_ndf b = make("student_t:alpha_x=0.2,alpha_y=0.05,rho=0.3,mean_y=-0.2,gamma=5", 0, 0);
        report("hyper_cauchy, correlated and skewed, is student_t", distance(&a, &b, 0), 1e-11);
    }
}

static void refused(const char *spec, const char *name, double low, double high)
{
    asp_error err;
    asp_ndf out;
    int ok = asp_ndf_parse(NULL, spec, &out, &err) == ASP_EINVAL && !strcmp(err.name, name)
          && err.low == low && err.high == high;
    printf("%-4s %s is refused\n", ok ? "ok" : "FAIL", spec);
    passed += ok;
    failed += !ok;
}

int main(void)
{
    check_phong();
    check_general();
    refused("phong:exponent=-1", "exponent", -0.99, 1e6);
    refused("phong:exponent=inf", "exponent", -0.99, 1e6);
    refused("hyper_cauchy:gamma=1.5", "gamma", 1.5, 1000);
    refused("student_t_general:C=1.2", "C", 1.5, 1e4);
    refused("student_t_general:B=0", "B", 0.01, 1e4);
    refused("student_t_general:B=nan", "B", 0.01, 1e4);
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
