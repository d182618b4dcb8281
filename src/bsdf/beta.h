/* beta.h - Euler's beta function of numbers of at least 1, in both precisions */

#include "asperity/elementary.h"

#ifndef ASPI_BETA_NAMES
#define ASPI_BETA_NAMES
#define aspi_stirling ASP_NAME(aspi_stirling)
#define aspi_beta ASP_NAME(aspi_beta)
#define aspi_beta_terms ASP_NAME(aspi_beta_terms)
#define aspi_beta_series ASP_NAME(aspi_beta_series)
#define aspi_beta_near ASP_NAME(aspi_beta_near)
#define aspi_beta_near_1 ASP_NAME(aspi_beta_near_1)
#define aspi_beta_is_near ASP_NAME(aspi_beta_is_near)
#define aspi_beta_n ASP_NAME(aspi_beta_n)
#endif

#if (ASP_PRECISION == 64 && !defined(ASPI_BETA_64)) || \
    (ASP_PRECISION == 32 && !defined(ASPI_BETA_32))
#if ASP_PRECISION == 64
#define ASPI_BETA_64
#else
#define ASPI_BETA_32
#endif

/* Stirling's series, the logarithm of Gamma(z) over sqrt(2 pi/z) (z/e)^z, from 1/z; z is at least 3 in
 * float32, 9 in float64. */
#define ASPI_BETA_STEPS (ASP_PRECISION == 64 ? 8 : 2)
ASP_FN asp_real aspi_stirling(asp_real i)
{
    asp_real i2 = i * i, s = R(-1.0 / 1680.0);
#if ASP_PRECISION == 64
    s = R(1.0 / 1188.0) + i2 * (R(-691.0 / 360360.0) + i2 * R(1.0 / 156.0));
    s = R(-1.0 / 1680.0) + i2 * s;
#endif
    s = R(1.0 / 1260.0) + i2 * s;
    s = R(-1.0 / 360.0) + i2 * s;
    return i * (R(1.0 / 12.0) + i2 * s);
}

/* Euler's B(a, b), a and b at least 1: brought to a + n, b + n by the recurrence. With x = B/A <= 1 the power is
 * exp(-((A + B) log(1 + x) - B log x)), whose error by that of x vanishes. Relative error 1e-11 and 5e-7 per
 * 1 + |ln B|; float32 answers 0 below about 1e-20. */
ASP_FN asp_real aspi_beta(asp_real p, asp_real q)
{
    asp_real a = aspi_max(p, q), b = aspi_min(p, q);
    int low = a + b < R(1e6);
    asp_real over = R(1.0), under = R(1.0), A, B, S, one, x, e;
    int i;
    a = low ? a : R(1.0);
    b = low ? b : R(1.0);
    A = a + R(ASPI_BETA_STEPS);
    B = b + R(ASPI_BETA_STEPS);
    S = A + B;
    for (i = 0; i < ASPI_BETA_STEPS; i++) {
        asp_real s = (a + b) + R(2 * i);
        over = over * (s * (s + R(1.0)));
        under = under * ((a + R(i)) * (b + R(i)));
    }
    one = R(1.0) / (A * B * S);
    x = B * (B * S * one);
    e = (aspi_stirling(B * S * one) + aspi_stirling(A * S * one) - aspi_stirling(A * B * one))
      - (S * aspi_log1p(x) - B * aspi_log(x));
    x = over / under * aspi_sqrt(R(2.0 * ASP_PI) * (S * S * one)) * aspi_exp(e);
    return low ? x : R(0.0);
}

/* The same for a and b within [1, 2], float32: Gamma(a) and Gamma(b) and 1/Gamma(a + b) as polynomials
 * (scripts/series.py), relative error 4e-7. */
ASP_FN int aspi_beta_is_near(asp_real a, asp_real b) { return ASP_PRECISION == 32 && aspi_max(a, b) <= R(2.0); }

/* Of each power the coefficients of Gamma(3/2 + t), twice, and of 1/Gamma(3 + t). */
static const asp_real aspi_beta_terms[10][4] = {
    { R(0.8862269557), R(0.8862269557), R(0.4999999876), R(0.0) },
    { R(0.03233828362), R(0.03233828362), R(-0.4613921502), R(0.0) },
    { R(0.4148074728), R(0.4148074728), R(0.1141498354), R(0.0) },
    { R(-0.1072858207), R(-0.1072858207), R(0.03847059524), R(0.0) },
    { R(0.1448331843), R(0.1448331843), R(-0.03151665695), R(0.0) },
    { R(-0.07772028495), R(-0.07772028495), R(0.006935187604), R(0.0) },
    { R(0.05657111942), R(0.05657111942), R(0.0005587637258), R(0.0) },
    { R(-0.03625772053), R(-0.03625772053), R(-0.0006791526744), R(0.0) },
    { R(0.03459742257), R(0.03459742257), R(0.0001414160983), R(0.0) },
    { R(-0.02374981865), R(-0.02374981865), R(-1.148210216e-6), R(0.0) }
};

/* c[0] + c[1] t + ... + c[9] t^9, numbers or several at once. */
#define ASPI_BETA_SERIES(t, t2, t4, c0, c1, c2, c3, c4, c5, c6, c7, c8, c9) \
    (((c0 + c1 * t) + (c2 + c3 * t) * t2) + ((c4 + c5 * t) + (c6 + c7 * t) * t2) * t4 + (c8 + c9 * t) * (t4 * t4))
#define ASPI_BETA_SERIES_OF(t, t2, t4, c) \
    ASPI_BETA_SERIES(t, t2, t4, c(0), c(1), c(2), c(3), c(4), c(5), c(6), c(7), c(8), c(9))

ASP_FN asp_real aspi_beta_series(asp_real t, int j)
{
    asp_real t2 = t * t, t4 = t2 * t2;
#define ASPI_BETA_TERM(i) aspi_beta_terms[i][j]
    return ASPI_BETA_SERIES_OF(t, t2, t4, ASPI_BETA_TERM);
#undef ASPI_BETA_TERM
}

ASP_FN asp_real aspi_beta_near(asp_real a, asp_real b)
{
    return aspi_beta_series(a - R(1.5), 0) * aspi_beta_series(b - R(1.5), 1) * aspi_beta_series(a + b - R(3.0), 2);
}

/* The same for a single pair, the three side by side. */
ASP_FN asp_real aspi_beta_near_1(asp_real a, asp_real b)
{
#if defined(__GNUC__) && !defined(__CUDACC__) && !defined(__CUDA__)
    typedef asp_real four __attribute__((vector_size(4 * sizeof(asp_real))));
    four t = { a - R(1.5), b - R(1.5), a + b - R(3.0), R(0.0) }, t2 = t * t, t4 = t2 * t2, c[10];
    memcpy(c, aspi_beta_terms, sizeof c);
#define ASPI_BETA_TERM(i) c[i]
    t = ASPI_BETA_SERIES_OF(t, t2, t4, ASPI_BETA_TERM);
#undef ASPI_BETA_TERM
    return t[0] * t[1] * t[2];
#else
    return aspi_beta_near(a, b);
#endif
}

/* beta of a block whose elements with far[i] != 0 matter and are not near: those are collected. */
ASP_FN void aspi_beta_n(size_t n, const asp_real *ASP_RESTRICT a, const asp_real *ASP_RESTRICT b,
                        const int *ASP_RESTRICT far, asp_real *ASP_RESTRICT out)
{
    asp_real x[ASP_BLOCK], y[ASP_BLOCK];
    int place[ASP_BLOCK];
    size_t i, count;
    for (i = count = 0; i < n; i++) {
        place[count] = (int)i;
        count += far[i] != 0;
    }
    for (i = 0; i < count; i++) {
        x[i] = a[place[i]];
        y[i] = b[place[i]];
    }
    ASP_IN_PLACE
    for (i = 0; i < count; i++)
        x[i] = aspi_beta(x[i], y[i]);
    for (i = 0; i < count; i++)
        out[place[i]] = x[i];
}
#undef ASPI_BETA_STEPS
#endif
