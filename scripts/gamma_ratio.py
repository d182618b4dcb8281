#!/usr/bin/env python3
"""Coefficients of the asymptotic series of Gamma(n + 1/2) / (Gamma(n) sqrt n) in 1/n, exact
fractions, as in src/ndf/student_prepare.c. No packages.

log of the ratio = sum over k of B(k + 1, 1/2) - B(k + 1, 0) times (-1)^(k + 1) / (k (k + 1) n^k), B the
Bernoulli polynomials; the exponential of that power series by its derivative.
"""
from fractions import Fraction as F
from math import comb

TERMS = 12


def bernoulli(count):
    b = [F(1)]
    for m in range(1, count + 1):
        b.append(-sum(comb(m + 1, k) * b[k] for k in range(m)) / (m + 1))
    return b


B = bernoulli(TERMS + 1)


def polynomial(m, x):
    return sum(comb(m, k) * B[k] * x ** (m - k) for k in range(m + 1))


# log Gamma(n + a) ~ (n + a - 1/2) log n - n + ... + sum (-1)^(k+1) B_{k+1}(a) / (k (k+1) n^k)
log_series = [F(0)] + [F((-1) ** (k + 1)) * (polynomial(k + 1, F(1, 2)) - polynomial(k + 1, F(0)))
                       / (k * (k + 1)) for k in range(1, TERMS)]
out = [F(1)]
for k in range(1, TERMS):
    out.append(sum(j * log_series[j] * out[k - j] for j in range(1, k + 1)) / k)
print(", ".join(str(c) for c in out))
