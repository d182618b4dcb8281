#!/usr/bin/env python3
"""Coefficients of float32's logarithm in include/asperity/elementary.h.

log(1 + f) = f - f^2/2 + f^3 q(f), 1 + f within [sqrt(1/2), sqrt(2)]. q is interpolated at Chebyshev
points and printed as a polynomial in f, lowest power first, with the largest relative error of the
logarithm. Needs mpmath.
"""
import mpmath as mp

mp.mp.dps = 40
DEGREE = 8
LOW, HIGH = mp.sqrt(mp.mpf(1) / 2) - 1, mp.sqrt(2) - 1


def exact(f):
    return (mp.log1p(f) - f + f * f / 2) / f ** 3


def chebyshev(degree, points=60):
    x = [mp.cos(mp.pi * (k + mp.mpf(1) / 2) / points) for k in range(points)]
    y = [exact((LOW + HIGH) / 2 + (HIGH - LOW) / 2 * t) for t in x]
    c = [mp.mpf(2) / points * mp.fsum(v * mp.cos(j * mp.acos(t)) for v, t in zip(y, x))
         for j in range(degree + 1)]
    c[0] /= 2
    return c


def powers(c):
    """Sum of c[j] T_j(a f + b) as powers of f."""
    a, b = 2 / (HIGH - LOW), -(HIGH + LOW) / (HIGH - LOW)
    before, now = [mp.mpf(1)], [b, a]
    out = [mp.mpf(0)] * len(c)
    out[0] += c[0]
    for j in range(1, len(c)):
        for i, v in enumerate(now):
            out[i] += c[j] * v
        following = [mp.mpf(0)] * (len(now) + 1)
        for i, v in enumerate(now):
            following[i] += 2 * b * v
            following[i + 1] += 2 * a * v
        for i, v in enumerate(before):
            following[i] -= v
        before, now = now, following
    return out


q = powers(chebyshev(DEGREE))
worst = max(abs(f ** 3 * (mp.polyval(q[::-1], f) - exact(f)) / mp.log1p(f))
            for f in (LOW + (HIGH - LOW) * (k + mp.mpf(1) / 3) / 1000 for k in range(1000)))
for v in q:
    print(mp.nstr(v, 10))
print("relative error", mp.nstr(worst, 3))
