#!/usr/bin/env python3
"""Writes the hand-made binary seeds of the fuzzers: tests/fuzz/corpus/merl and corpus/rgl."""
import os
import struct

here = os.path.join(os.path.dirname(os.path.abspath(__file__)), "corpus")


def save(name, data):
    with open(os.path.join(here, name), "wb") as file:
        file.write(data)


def merl(h, d, p, value):
    n = h * d * p
    return struct.pack("<3i", h, d, p) + b"".join(struct.pack("<d", value(i)) for i in range(3 * n))


def tensor(fields):
    table = sum(2 + len(name) + 11 + 8 * len(shape) for name, _, shape, _ in fields)
    head, body, at = b"tensor_file\0" + struct.pack("<BBI", 1, 0, len(fields)), b"", 18 + table
    for name, kind, shape, data in fields:
        head += struct.pack("<H", len(name)) + name.encode()
        head += struct.pack("<HBQ", len(shape), kind, at + len(body))
        head += struct.pack("<%dQ" % len(shape), *shape)
        body += data
    return head + body


def floats(values):
    values = list(values)
    return struct.pack("<%df" % len(values), *values)


def rgl(phi, theta, n, jacobian=1):
    p, t = len(phi), len(theta)
    return tensor([
        ("description", 1, (4,), b"seed"),
        ("phi_i", 10, (p,), floats(phi)),
        ("theta_i", 10, (t,), floats(theta)),
        ("sigma", 10, (2, 2), floats([1, .5, 1, .5])),
        ("ndf", 10, (2, 2), floats([2, .1, 2, .1])),
        ("vndf", 10, (p, t, n, n), floats(1 + i % 5 for i in range(p * t * n * n))),
        ("luminance", 10, (p, t, n, n), floats(1 for i in range(p * t * n * n))),
        ("rgb", 10, (p, t, 3, n, n), floats(.1 * (i % 7) - .05 for i in range(3 * p * t * n * n))),
        ("jacobian", 1, (1,), bytes([jacobian])),
    ])


save("merl/one", merl(1, 1, 1, lambda i: 1500.0))
save("merl/missing", merl(2, 3, 4, lambda i: -1.0 if i % 3 else 0.1 * i))
save("merl/header", struct.pack("<3i", 90, 90, 180))
save("rgl/isotropic", rgl([0.0], [0.0, 0.8, 1.57079], 2))
save("rgl/plain", rgl([0.0], [0.0, 1.57079], 2, 0))
save("rgl/anisotropic", rgl([-3.1415926, -1, 1, 3.1415926], [0.0, 1.57079], 2))
save("rgl/quarter", rgl([-3.1415926, -2.4, -1.5707963], [0.5], 2))
