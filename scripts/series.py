#!/usr/bin/env python3
"""Coefficients of float32's logarithm and of its sine and cosine in include/asperity/elementary.h, and of the
gamma functions in src/bsdf/beta.h.

log(1 + f) = f - f^2/2 + f^3 q(f), 1 + f within [sqrt(1/2), sqrt(2)];
sin(pi x/2) = x + x (1 - x^2) g(x^2), cos(pi x/2) = (1 - x^2)(1 - x^2 r(x^2)), x within [-1, 1].
Gamma(3/2 + t), |t| <= 1/2, and 1/Gamma(3 + t), |t| <= 1.
Each is interpolated at Chebyshev points and printed as a polynomial, lowest power first, with the largest
error of the function: relative for the logarithm and the gamma functions,
absolute for the others. Needs mpmath.
"""
import mpmath as mp

mp.mp.dps = 40


def chebyshev(exact, low, high, degree, points=60):
    x = [mp.cos(mp.pi * (k + mp.mpf(1) / 2) / points) for k in range(points)]
    y = [exact((low + high) / 2 + (high - low) / 2 * t) for t in x]
    c = [mp.mpf(2) / points * mp.fsum(v * mp.cos(j * mp.acos(t)) for v, t in zip(y, x))
         for j in range(degree + 1)]
    c[0] /= 2
    return c


def powers(c, low, high):
    """Sum of c[j] T_j(a f + b) as powers of f."""
    a, b = 2 / (high - low), -(high + low) / (high - low)
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


def show(name, exact, low, high, degree, error):
    q = powers(chebyshev(exact, low, high, degree), low, high)
    print(name)
    for v in q:
        print(' ', mp.nstr(v, 10))
    middle = [low + (high - low) * (k + mp.mpf(1) / 3) / 1000 for k in range(1000)]
    worst = max(abs(error(f, mp.polyval(q[::-1], f) - exact(f))) for f in middle)
    print('  error', mp.nstr(worst, 3))


show('log', lambda f: (mp.log1p(f) - f + f * f / 2) / f ** 3, mp.sqrt(mp.mpf(1) / 2) - 1, mp.sqrt(2) - 1, 8,
     lambda f, e: f ** 3 * e / mp.log1p(f))
show('sin', lambda z: (mp.sin(mp.pi / 2 * mp.sqrt(z)) / mp.sqrt(z) - 1) / (1 - z), mp.mpf(0), mp.mpf(1), 3,
     lambda z, e: mp.sqrt(z) * (1 - z) * e)
show('cos', lambda z: (1 - mp.cos(mp.pi / 2 * mp.sqrt(z)) / (1 - z)) / z, mp.mpf(0), mp.mpf(1), 3,
     lambda z, e: z * (1 - z) * e)
show('gamma from 1 to 2', lambda t: mp.gamma(mp.mpf(3) / 2 + t), -mp.mpf(1) / 2, mp.mpf(1) / 2, 9,
     lambda t, e: e / mp.gamma(mp.mpf(3) / 2 + t))
show('1/gamma from 2 to 4', lambda t: mp.rgamma(3 + t), mp.mpf(-1), mp.mpf(1), 9, lambda t, e: e * mp.gamma(3 + t))
