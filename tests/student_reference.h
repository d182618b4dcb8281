/* student_reference.h - the marginal of the Student-t family by standard special functions, as the
 * tests' reference */
#ifndef STUDENT_REFERENCE_H
#define STUDENT_REFERENCE_H

#include <math.h>

static const double pi = 3.14159265358979323846;

/* Tail probability of the marginal (1 + x^2/n)^(-n - 1/2), x >= 0, by the regularised incomplete beta
 * function I_w(n, 1/2)/2, w = 1/(1 + x^2/n), with the C library's lgamma: a continued fraction in
 * its region of fast convergence, the mirrored one elsewhere. */
static double beta_fraction(double a, double b, double x)
{
    double c = 1, d = 1 - (a + b) * x / (a + 1), h;
    int m;
    d = 1 / d;
    h = d;
    for (m = 1; m < 2000; m++) {
        double e = m * (b - m) * x / ((a + 2 * m - 1) * (a + 2 * m)), delta;
        d = 1 / (1 + e * d);
        c = 1 + e / c;
        h *= d * c;
        e = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1));
        d = 1 / (1 + e * d);
        c = 1 + e / c;
        delta = d * c;
        h *= delta;
        if (fabs(delta - 1) < 4e-16)
            break;
    }
    return h;
}

static double tail(double n, double x)
{
    double q = x * x / n, w, front, a = n, b = 0.5;
    if (!(n < 1e12))
        return 0.5 * erfc(x);
    w = 1 / (1 + q);
    front = exp(lgamma(a + b) - lgamma(a) - lgamma(b) - n * log1p(q) + 0.5 * log(q * w));
    if (x == 0)
        return 0.5;
    return w < (a + 1) / (a + b + 2) ? 0.5 * front * beta_fraction(a, b, w) / a
                                     : 0.5 * (1 - front * beta_fraction(b, a, q * w) / b);
}

/* int_x^inf q P2 dq. */
static double moment(double n, double x)
{
    double m0;
    if (!(n < 1e12))
        return exp(-x * x) / (2 * sqrt(pi));
    m0 = exp(lgamma(n + 0.5) - lgamma(n)) * sqrt(n) / (sqrt(pi) * (2 * n - 1));
    return m0 * exp((0.5 - n) * log1p(x * x / n));
}

#endif
