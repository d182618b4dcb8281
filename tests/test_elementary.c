/* test_elementary.c - largest errors of the kernels' elementary functions, in units in the last place
 *
 * Against long double (float64) and double (float32) of the C library, over random arguments. The
 * bounds are those stated in asperity/elementary.h. */
#include "random.h"
#include "asperity.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "asperity/elementary.h"
#undef ASP_PRECISION

#include <float.h>
#include <stdio.h>

static int passed, failed;

static void report(const char *what, double low, double high, double worst, double at, double bound)
{
    int ok = worst <= bound;
    printf("%-4s %-16s [%g, %g]: %.3f ulp at %.9g, bound %g\n", ok ? "ok" : "FAIL", what, low, high,
           worst, at, bound);
    passed += ok;
    failed += !ok;
}

/* An argument in [low, high], or with a logarithm spread evenly (low > 0). */
static double argument(double low, double high, int spread)
{
    return spread ? low * exp(uniform() * (log(high) - log(low))) : low + (high - low) * uniform();
}

#define N 1000000

static void check64(const char *what, double (*f)(double), long double (*exact)(long double),
                    double low, double high, int spread, int sign, double bound)
{
    double worst = 0, at = 0;
    int i;
    for (i = 0; i < N; i++) {
        double x = sign * argument(low, high, spread);
        long double want = exact((long double)x);
        double e = (double)(fabsl((long double)f(x) - want) /
                            ldexpl(1, ilogbl(want) - (DBL_MANT_DIG - 1)));
        if (!(e <= worst)) {
            worst = e;
            at = x;
        }
    }
    report(what, sign * low, sign * high, worst, at, bound);
}

static void check32(const char *what, float (*f)(float), double (*exact)(double), double low,
                    double high, int spread, int sign, double bound)
{
    double worst = 0, at = 0;
    int i;
    for (i = 0; i < N; i++) {
        float x = (float)(sign * argument(low, high, spread));
        double want = exact((double)x);
        double e = fabs((double)f(x) - want) / ldexp(1, ilogb(want) - (FLT_MANT_DIG - 1));
        if (!(e <= worst)) {
            worst = e;
            at = (double)x;
        }
    }
    report(what, sign * low, sign * high, worst, at, bound);
}

static double exp_64(double x) { return aspi_exp_64(x); }
static double expm1_64(double x) { return aspi_expm1_64(x); }
static double log_64(double x) { return aspi_log_64(x); }
static double log1p_64(double x) { return aspi_log1p_64(x); }
static float exp_32(float x) { return aspi_exp_32(x); }
static float expm1_32(float x) { return aspi_expm1_32(x); }
static float log_32(float x) { return aspi_log_32(x); }
static float log1p_32(float x) { return aspi_log1p_32(x); }

/* sin and cos of a turn: absolute errors in units of 2^-53 and 2^-24; the reference reduces exactly. */
static void check_turn(void)
{
    double worst64 = 0, worst32 = 0, at64 = 0, at32 = 0;
    const long double two_pi = 6.283185307179586476925286766559L;
    int i;
    for (i = 0; i < N; i++) {
        double u = uniform() * (i & 1 ? 1 : 8) - (i & 2 ? 4 : 0);
        float v = (float)u;
        asp_vec2 a = aspi_sincos2pi_64(u);
        asp_vec2f b = aspi_sincos2pi_32(v);
        long double r = (long double)u - roundl(u), q = (long double)v - roundl(v);
        double e = (double)fmaxl(fabsl((long double)a.x - cosl(two_pi * r)),
                                 fabsl((long double)a.y - sinl(two_pi * r))) * 0x1p53;
        double f = (double)fmaxl(fabsl((long double)b.x - cosl(two_pi * q)),
                                 fabsl((long double)b.y - sinl(two_pi * q))) * 0x1p24;
        if (!(e <= worst64)) {
            worst64 = e;
            at64 = u;
        }
        if (!(f <= worst32)) {
            worst32 = f;
            at32 = (double)v;
        }
    }
    report("sincos2pi 64", -4, 8, worst64, at64, 2.0);
    report("sincos2pi 32", -4, 8, worst32, at32, 2.0);
}

/* The two-number logarithm: relative error of the sum in units of 2^-24. */
static void check_sum(void)
{
    double worst = 0, at = 0;
    int i;
    for (i = 0; i < N; i++) {
        float x = (float)argument(1e-6, 1e15, 1);
        float low = x * (float)((uniform() - 0.5) * 0x1p-23);
        asp_vec2f l = aspi_log1p_sum_32(x, low);
        double want = log1p((double)x + (double)low);
        double e = fabs(((double)l.x + (double)l.y) / want - 1) * 0x1p24;
        if (!(e <= worst)) {
            worst = e;
            at = (double)x;
        }
    }
    report("log1p_sum 32", 1e-6, 1e15, worst, at, 1.0);
}

/* The angle of (x, y) in the first quadrant, in ulps: lengths far apart, and all angles evenly. */
static void check_angle(void)
{
    double worst64 = 0, worst32 = 0, at64 = 0, at32 = 0;
    int i;
    for (i = 0; i < N; i++) {
        double t = 1.5707 * uniform(), size = argument(1e-12, 1e12, 1);
        double x = i & 1 ? argument(1e-17, 1e17, 1) : size * cos(t);
        double y = i & 1 ? argument(1e-17, 1e17, 1) : size * sin(t);
        float xf = (float)x, yf = (float)y;
        long double want = atan2l((long double)y, (long double)x);
        double narrow = atan2((double)yf, (double)xf);
        double e = (double)(fabsl((long double)aspi_angle_64(y, x) - want)
                            / ldexpl(1, ilogbl(want) - (DBL_MANT_DIG - 1)));
        double f = fabs((double)aspi_angle_32(yf, xf) - narrow)
                 / ldexp(1, ilogb(narrow) - (FLT_MANT_DIG - 1));
        if (!(e <= worst64)) {
            worst64 = e;
            at64 = y / x;
        }
        if (!(f <= worst32)) {
            worst32 = f;
            at32 = y / x;
        }
    }
    report("angle 64", 0, INFINITY, worst64, at64, 2.6);
    report("angle 32", 0, INFINITY, worst32, at32, 2.9);
}

static void check_edges(void)
{
    const double nan = (double)NAN;
    struct { const char *what; int ok; } row[] = {
        { "exp(0) = 1", aspi_exp_64(0) == 1 && aspi_exp_32(0) == 1 },
        { "exp of very negative is 0", aspi_exp_64(-1e300) == 0 && aspi_exp_32(-1e38f) == 0 },
        { "exp of very large is finite", aspi_exp_64(1e300) < DBL_MAX && aspi_exp_32(1e38f) < FLT_MAX },
        { "expm1 of very negative is -1", aspi_expm1_64(-1e300) == -1 && aspi_expm1_32(-1e38f) == -1 },
        { "log(1) = 0, log1p(0) = 0", aspi_log_64(1) == 0 && aspi_log_32(1) == 0
          && aspi_log1p_64(0) == 0 && aspi_log1p_32(0) == 0 },
        { "angles of the axes", aspi_angle_64(0, 1) == 0 && aspi_angle_64(0, 0) == 0
          && aspi_angle_64(1, 0) == 0.5 * ASP_PI && aspi_angle_32(0, 1) == 0
          && aspi_angle_32(1, 0) == (float)(0.5 * ASP_PI) && isnan(aspi_angle_64(nan, 1))
          && isnan(aspi_angle_64(1, nan)) && isnan(aspi_angle_32((float)nan, 1)) },
        { "NaN in, NaN out", isnan(aspi_exp_64(nan)) && isnan(aspi_exp_32((float)nan))
          && isnan(aspi_expm1_64(nan)) && isnan(aspi_expm1_32((float)nan))
          && isnan(aspi_log_64(nan)) && isnan(aspi_log_32((float)nan))
          && isnan(aspi_log1p_64(nan)) && isnan(aspi_log1p_32((float)nan)) }
    };
    size_t i;
    for (i = 0; i < sizeof row / sizeof row[0]; i++) {
        printf("%-4s %s\n", row[i].ok ? "ok" : "FAIL", row[i].what);
        passed += row[i].ok;
        failed += !row[i].ok;
    }
}

int main(void)
{
    check64("exp 64", exp_64, expl, 1e-10, 707, 0, -1, 1.0);
    check64("exp 64", exp_64, expl, 1e-10, 700, 0, 1, 1.0);
    check64("expm1 64", expm1_64, expm1l, 1e-12, 700, 1, -1, 2.0);
    check64("expm1 64", expm1_64, expm1l, 1e-12, 700, 1, 1, 2.0);
    check64("log 64", log_64, logl, 1e-300, 1e300, 1, 1, 1.0);
    check64("log 64", log_64, logl, 0.3, 3, 0, 1, 1.0);
    check64("log1p 64", log1p_64, log1pl, 1e-20, 1e150, 1, 1, 1.5);
    check64("log1p 64", log1p_64, log1pl, 1e-20, 0.9999, 1, -1, 1.5);
    check32("exp 32", exp_32, exp, 1e-6, 86.9, 0, -1, 1.1);
    check32("exp 32", exp_32, exp, 1e-6, 87, 0, 1, 1.1);
    check32("expm1 32", expm1_32, expm1, 1e-8, 80, 1, -1, 2.0);
    check32("expm1 32", expm1_32, expm1, 1e-8, 80, 1, 1, 2.0);
    check32("log 32", log_32, log, 1e-37, 1e38, 1, 1, 1.0);
    check32("log 32", log_32, log, 0.3, 3, 0, 1, 1.0);
    check32("log1p 32", log1p_32, log1p, 1e-20, 1e37, 1, 1, 1.6);
    check32("log1p 32", log1p_32, log1p, 1e-10, 0.9999, 1, -1, 1.6);
    check_turn();
    check_sum();
    check_angle();
    check_edges();
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
