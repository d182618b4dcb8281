#!/usr/bin/env python3
"""Coefficients of src/ndf/prepared_turn.h.

Polynomials of float32, lowest power first, by Lawson's reweighting of least squares at Chebyshev points:
atan x = x - x^3 A(x^2), x within [0, 1]; phi - sin phi = phi^3 P(phi^2) and 1 - cos phi = phi^2 Q(phi^2), phi within
[0, pi]. Printed with the largest error: of A; of sine; of cosine.

Start of the azimuth phi of density a + b cos(phi) > 0, |a| + b = 1, at the share f of F = a phi + b sin(phi):
phi/end = (1 - w)(1 + w K), w = sqrt(1 - f), K = K0 + K1 w, both linear in 1, a, |a|, e = a - 1/2 + |a - 1/2| and
e^2. Fitted so that what one step of Cauchy's leaves of F is even and small, 300 times smaller
for a < 0, where the step has to do, and phi moves by little. Printed in the order K0, K1; then the largest errors of F,
relative to F(end), and of phi before and after. Needs numpy.
"""
import numpy as np
from numpy.polynomial import Polynomial, chebyshev


def lawson(exact, weight, low, high, degree):
    x = (low + high) / 2 + (high - low) / 2 * np.cos(np.pi * (np.arange(600) + 0.5) / 600)
    y, of = exact(x), weight(x)
    basis = chebyshev.chebvander((2 * x - low - high) / (high - low), degree)
    by, best = np.ones_like(x), (np.inf, None)
    for _ in range(200):
        q = np.sqrt(by) * of
        c = np.linalg.lstsq(basis * q[:, None], y * q, rcond=None)[0]
        error = np.abs(basis @ c - y) * of
        if error.max() < best[0]:
            best = error.max(), c
        by = by * (error + 1e-30)
        by /= by.mean()
    inner = Polynomial([-(low + high) / (high - low), 2 / (high - low)])
    return best[0], Polynomial(chebyshev.cheb2poly(best[1]))(inner).coef


def series(x, terms):
    """Where a difference cancels: Taylor's."""
    return sum(c * x ** i for i, c in enumerate(terms))


def arc(z):
    f = np.sqrt(z)
    return np.where(z < 1e-2, series(z, [1 / 3, -1 / 5, 1 / 7, -1 / 9, 1 / 11, -1 / 13]), (f - np.arctan(f)) / (f * z))


def sine(z):
    f = np.sqrt(z)
    return np.where(z < 0.1, series(z, [1 / 6, -1 / 120, 1 / 5040, -1 / 362880, 1 / 39916800]),
                    (f - np.sin(f)) / (f * z))


def cosine(z):
    return 0.5 * np.sinc(np.sqrt(z) / (2 * np.pi)) ** 2


def show(name, found):
    print(name, 'error %.2g' % found[0])
    for c in found[1]:
        print('  %.10g' % c)


def solve(a, f):
    """phi, end and F(end), by bisection."""
    b = 1 - np.abs(a)
    end = np.where(a >= b, np.pi, np.arccos(np.clip(-a / np.maximum(b, 1e-9), -1, 1)))
    whole = a * end + b * np.sin(end)
    low, high = np.zeros_like(a), end
    for _ in range(100):
        middle = (low + high) / 2
        less = a * middle + b * np.sin(middle) < f * whole
        low, high = np.where(less, middle, low), np.where(less, high, middle)
    return (low + high) / 2, end, whole


def step(a, f, phi, end, whole):
    b = 1 - np.abs(a)
    miss = f * whole - (a * phi + b * np.sin(phi))
    slope = np.maximum(a + b * np.cos(phi), 0)
    root = np.sqrt(np.maximum(slope ** 2 - 2 * b * np.sin(phi) * miss, 0))
    return np.minimum(phi + 2 * miss / np.maximum(slope + root, 1e-12), end)


def off(a, f, phi, whole):
    return np.abs(a * phi + (1 - np.abs(a)) * np.sin(phi) - f * whole) / whole


def start():
    u = np.linspace(0, 1, 40)
    a = np.concatenate([-(1 - np.linspace(0.01, 1, 30)[1:] ** 2) / 2, (1 - u ** 2) / 2, (1 + u ** 2) / 2])
    w = np.concatenate([np.linspace(0, 1, 121)[1:-1], [1e-3, 3e-3]])
    a, w = (x.ravel() for x in np.meshgrid(a, w, indexing='ij'))
    f = 1 - w * w
    phi, end, whole = solve(a, f)
    e = a - 0.5 + np.abs(a - 0.5)
    parts = [np.ones_like(a), a, np.abs(a), e, e * e]
    basis = np.stack([w * (1 - w) * w ** i * p for i in range(2) for p in parts], 1) * end[:, None]
    weight = (np.abs(a + (1 - np.abs(a)) * np.cos(phi)) + 0.02) / whole
    by, best = np.ones_like(a), (np.inf, None)
    for _ in range(300):
        q = np.sqrt(by) * weight
        c = np.linalg.lstsq(basis * q[:, None], (phi - end * (1 - w)) * q, rcond=None)[0]
        first = np.clip(end * (1 - w) + basis @ c, 0, end)
        second = step(a, f, first, end, whole)
        error = off(a, f, second, whole) * np.where(a < 0, 300, 1) + 1e-4 * (np.abs(second - first) / 0.2) ** 6
        if error.max() < best[0]:
            best = error.max(), c, first, second
        by = by * (1e-12 + error) ** 0.2
        by /= by.mean()
    c, first, second = best[1:]
    print('start')
    for v in c:
        print('  %.10g' % v)
    for name, where in (('a < 0', a < 0), ('a >= 0', a >= 0)):
        print('  %-6s F %.2g, after the step %.2g; phi moves by %.2g'
              % (name, off(a, f, first, whole)[where].max(), off(a, f, second, whole)[where].max(),
                 np.abs(second - first)[where].max()))


show('A', lawson(arc, np.ones_like, 0, 1, 7))
show('P', lawson(sine, lambda z: z ** 1.5, 0, 9.8706, 5))
show('Q', lawson(cosine, lambda z: z, 0, 9.8706, 5))
start()
