#!/usr/bin/env python3
"""Prints the table in src/data/cornell.c: linear sRGB weights of 31 bands, 400 to 700 nm.

usage: cornell_weights.py CIE_1931_CSV D65_CSV   (columns lambda,xbar,ybar,zbar and lambda,spd)

Reflectance R(lambda) under D65, seen by the CIE 1931 2-degree observer, as linear sRGB (IEC
61966-2-1). The sums run over the bands that were measured; each channel is then scaled so that a
flat spectrum of 1 gives exactly 1, 1, 1 (the bands beyond 400..700 nm hold 0.5 % of Y)."""
import csv
import sys


def table(path):
    rows = [r for r in csv.reader(open(path)) if r and not r[0].startswith("#")]
    return {float(r[0]): [float(v) for v in r[1:]] for r in rows[1:]}


XYZ_TO_SRGB = ((3.2406, -1.5372, -0.4986), (-0.9689, 1.8758, 0.0415), (0.0557, -0.2040, 1.0570))

if len(sys.argv) != 3:
    sys.exit(__doc__)
observer, light = table(sys.argv[1]), table(sys.argv[2])
weights = []
for band in range(400, 701, 10):
    xyz = [v * light[band][0] for v in observer[band]]
    weights.append([sum(m * v for m, v in zip(row, xyz)) for row in XYZ_TO_SRGB])
total = [sum(w[c] for w in weights) for c in range(3)]
for band, w in zip(range(400, 701, 10), weights):
    print("    { %s }, /* %d */" % (", ".join("% .8f" % (w[c] / total[c]) for c in range(3)), band))
