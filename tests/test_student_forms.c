/* test_student_forms.c - the masking of Student's t as its paper writes it, against the exact one
 *
 * The exact form (asp_lambda's, which the golden files hold) against the marginal's own integrals; the
 * other forms where they must agree, and where the paper's arithmetic must fail, by how much the header
 * says. */
#include "asperity_study.h"
#include "student_reference.h"

#include <stdio.h>
#include <string.h>

static int passed, failed;

static void expect(int ok, const char *what, double gamma, double found, double bound)
{
    printf("%-4s %-58s gamma %-6g %.3g, bound %.3g\n", ok ? "ok" : "FAIL", what, gamma, found, bound);
    passed += ok != 0;
    failed += ok == 0;
}

static void say(int ok, const char *what)
{
    printf("%-4s %s\n", ok ? "ok" : "FAIL", what);
    passed += ok != 0;
    failed += ok == 0;
}

static void below(const char *what, double gamma, double found, double bound)
{
    expect(found <= bound, what, gamma, found, bound);
}

static double lambda(const char *form, double gamma, double nu)
{
    double out = NAN;
    if (asp_student_lambda(form, gamma, nu, &out, NULL) != ASP_OK)
        return NAN;
    return out;
}

/* Largest relative difference from the exact Lambda, of G1, and the least Lambda, nu up to 6. */
typedef struct worst { double lambda, g1, least; } worst;

#ifdef __SANITIZE_ADDRESS__        /* instrumented code is slower, and has a smaller job */
#define STEPS 80
#else
#define STEPS 400
#endif

static worst compare(const char *form, double gamma, double from, double to)
{
    worst w = { 0, 0, 1 };
    int i;
    for (i = 0; i <= STEPS; i++) {
        double nu = from * pow(to / from, i / (double)STEPS), e = lambda("exact", gamma, nu);
        double l = lambda(form, gamma, nu);
        double a = fabs(l / e - 1), b = fabs((1 + e) / (1 + l) - 1);
        w.lambda = a <= w.lambda ? w.lambda : a;        /* a NaN stays */
        w.g1 = b <= w.g1 ? w.g1 : b;
        w.least = fmin(w.least, l);
    }
    return w;
}

static void check_exact(void)
{
    static const double gammas[] = { 1.501, 1.65, 2, 2.5, 4, 10, 100, INFINITY };
    size_t g;
    int i;
    for (g = 0; g < sizeof gammas / sizeof *gammas; g++) {
        double gamma = gammas[g], most = 0;
        for (i = 0; i < 300; i++) {
            double nu = 1e-6 * pow(1e6, i / 299.0);      /* up to 1: beyond, the two terms cancel */
            double want = moment(gamma - 1, nu) / nu - tail(gamma - 1, nu);
            most = fmax(most, fabs(lambda("exact", gamma, nu) / want - 1));
        }
        below("exact: M/nu - T", gamma, most, 3e-11);
    }
}

/* Where the forms are sound, they agree; where their arithmetic cancels, by how much. */
static void check_forms(void)
{
    static const double smooth[] = { 1.5001, 1.501, 1.75, 2, 2.14, 3, 7.3, 40, 400, 1e4, 1e6 };
    static const struct { const char *form; double gamma, g1, lambda_low, lambda_high; } sums[] = {
        { "integer", 2, 1e-14, 0, 1e-13 },       { "integer", 3, 1e-14, 0, 1e-11 },
        { "integer", 10, 1e-13, 1e-9, 1e-5 },    { "integer", 20, 1e-11, 1e-4, 10 },
        { "integer", 30, 1e-8, 1, 1e5 },         { "integer", 40, 1e-5, 1e4, 1e10 },
        { "half_integer", 2.5, 1e-14, 0, 1e-12 }, { "half_integer", 5.5, 1e-13, 0, 1e-9 },
        { "half_integer", 20.5, 1e-11, 0, 1e-3 }, { "half_integer", 30.5, 1e-8, 0, 0.1 },
        { "half_integer", 40.5, 1e-5, 0, 1 },
    };
    size_t i;
    for (i = 0; i < sizeof smooth / sizeof *smooth; i++)
        below("hypergeometric: G1, any nu", smooth[i], compare("hypergeometric", smooth[i], 1e-6, 1e4).g1,
              1e-14);
    below("hypergeometric: Lambda", 10, compare("hypergeometric", 10, 1e-3, 6).lambda, 1e-7);
    expect(compare("hypergeometric", 100, 1e-3, 6).lambda > 0.5, "hypergeometric: Lambda is lost", 100,
           compare("hypergeometric", 100, 1e-3, 6).lambda, 0.5);
    for (i = 0; i < sizeof sums / sizeof *sums; i++) {
        worst w = compare(sums[i].form, sums[i].gamma, 1e-3, 6);
        below(sums[i].form[0] == 'i' ? "integer: G1" : "half_integer: G1", sums[i].gamma, w.g1, sums[i].g1);
        expect(w.lambda >= sums[i].lambda_low && w.lambda <= sums[i].lambda_high,
               "  and Lambda, cancelling", sums[i].gamma, w.lambda, sums[i].lambda_high);
    }
}

/* Claims of the paper, and of this library's header, on eqs. 22-23. */
static void check_rational(void)
{
    double gamma, g1 = 0, least = 1, outside = 1, at = 0, at_least = 0;
    for (gamma = 1.51; gamma <= 40; gamma *= 1.02) {
        worst w = compare("rational", gamma, 1e-3, 1e3);
        at = w.g1 > g1 ? gamma : at;
        at_least = w.least < least ? gamma : at_least;
        g1 = fmax(g1, w.g1);
        least = fmin(least, w.least);
        if (gamma < 1.95 || gamma > 6)
            outside = fmin(outside, w.least);
    }
    expect(outside > 0, "rational: Lambda > 0 for gamma < 1.95 and > 6", 0, outside, 0);
    below("rational: G1", at, g1, 0.00716);
    expect(g1 > 0.007, "rational: and it errs as printed", at, g1, 0.007);
    expect(least < -0.004 && least > -0.0046, "rational: the least Lambda is not clamped", at_least, least,
           -0.0045);
}

static void check_refusals(void)
{
    asp_error err;
    double out = 7;
    say(asp_student_lambda("fast", 2, 1, &out, &err) == ASP_EUNKNOWN
                  && !strcmp(err.name, "fast"), "an unknown form is refused by name");
    say(asp_student_lambda("exact", 1.5, 1, &out, &err) == ASP_EINVAL && err.low_open
                  && err.low == 1.5, "gamma = 1.5 is refused");
    say(asp_student_lambda("integer", 2.5, 1, &out, &err) == ASP_EINVAL && err.value == 2.5,
                  "the integer sum refuses 2.5");
    say(asp_student_lambda("half_integer", 3, 1, &out, &err) == ASP_EINVAL,
                  "the half-integer sum refuses 3");
    say(asp_student_lambda("half_integer", 1.5, 1, &out, &err) == ASP_EINVAL,
                  "the half-integer sum refuses 1.5");
    say(asp_student_lambda("integer", 501, 1, &out, &err) == ASP_EINVAL && err.high == 500,
                  "the integer sum refuses 501");
    say(asp_student_lambda("rational", INFINITY, 1, &out, &err) == ASP_EINVAL,
                  "the fit refuses infinity");
    say(asp_student_lambda("exact", 2, NAN, &out, &err) == ASP_EINVAL, "nu: NaN is refused");
    say(asp_student_lambda("exact", 2, -1, &out, NULL) == ASP_EINVAL, "nu: -1 is refused");
    say(out == 7, "nothing is written on failure");
    say(isinf(lambda("rational", 2, 0)) && isinf(lambda("exact", INFINITY, 0)),
                  "infinite at the horizon");
    say(fabs(lambda("exact", 2, INFINITY)) < 1e-15 && fabs(lambda("hypergeometric", 3, INFINITY)) < 1e-15
                  && fabs(lambda("integer", 3, INFINITY)) < 1e-15
                  && fabs(lambda("half_integer", 3.5, INFINITY)) < 1e-15
                  && fabs(lambda("rational", 3, INFINITY)) < 0.005, "nothing hidden along the normal");
}

int main(void)
{
    check_exact();
    check_forms();
    check_rational();
    check_refusals();
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
