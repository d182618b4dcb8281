#!/usr/bin/env python3
"""Prints src/core/metals_table.h: metals as linear sRGB eta + i k; with --spectrum
src/core/metals_spectrum.h: n and k, and what each wavelength gives to linear sRGB.

For each metal the conductor Fresnel term is evaluated per wavelength from measured n, k, weighted
with D65 and the CIE 1931 observer, taken to linear sRGB (a perfect mirror is 1, 1, 1), and each
channel's curve over the angle is followed by eta + i k in the least squares sense. Needs numpy and
scipy, and the tables in $ASPERITY_SHARED/data (default ../shared).
"""
import csv
import os
import sys

import numpy as np
from scipy.optimize import least_squares

SHARED = os.environ.get("ASPERITY_SHARED", "../shared")
METALS = [
    ("Au", "Au_Johnson", "Johnson, Christy 1972"), ("Ag", "Ag_Johnson", "Johnson, Christy 1972"),
    ("Al", "Al_McPeak", "McPeak et al. 2015"), ("Cu", "Cu_Johnson", "Johnson, Christy 1972"),
    ("Fe", "Fe_Johnson", "Johnson, Christy 1974"), ("Cr", "Cr_Johnson", "Johnson, Christy 1974"),
    ("Ni", "Ni_Johnson", "Johnson, Christy 1974"), ("Ti", "Ti_Johnson", "Johnson, Christy 1974"),
    ("W", "W_Weaver", "Weaver et al. 1975"), ("Pt", "Pt_Rakic-BB", "Rakic et al. 1998"),
    ("Co", "Co_Johnson", "Johnson, Christy 1974"), ("Hg", "Hg_Inagaki", "Inagaki et al. 1981"),
    ("TiN", "TiN_Beliaev-sputtering", "Beliaev et al. 2023"),
]
TO_SRGB = np.array([[3.2404542, -1.5371385, -0.4985314], [-0.9692660, 1.8760108, 0.0415560],
                    [0.0556434, -0.2040259, 1.0572252]])


def table(path):
    with open(os.path.join(SHARED, "data", path)) as f:
        rows = list(csv.reader(line for line in f if not line.startswith("#")))
    return rows[0], rows[1:]


def number(x):
    return float(x) if x else np.nan


def fresnel(cosine, n, k):
    c = cosine
    m = n + 1j * k
    t = np.sqrt(m * m - (1 - c * c))
    s = (c - t) / (c + t)
    p = (m * m * c - t) / (m * m * c + t)
    return 0.5 * (abs(s) ** 2 + abs(p) ** 2)


def spectrum():
    """Every 10 nm from 380 to 780: weights of linear sRGB under D65, then n and k of each metal."""
    head, rows = table("ior/ior_5nm_360_830.csv")
    wave = np.array([number(r[0]) for r in rows])
    _, cie = table("cie/cie1931_2deg_1nm.csv")
    cie = np.array([[float(x) for x in r] for r in cie])
    _, d65 = table("cie/d65_300_830.csv")
    d65 = np.array([[float(x) for x in r] for r in d65])
    nm = np.arange(380, 781, 10)
    # hat functions of 10 nm over the 1 nm table: the weights of piecewise linear spectra
    fine = np.arange(380, 781)
    light = np.stack([np.interp(fine, cie[:, 0], cie[:, i]) for i in (1, 2, 3)])
    light = TO_SRGB @ (light * np.interp(fine, d65[:, 0], d65[:, 1]))
    hats = np.maximum(0.0, 1.0 - np.abs(fine[None, :] - nm[:, None]) / 10.0)
    weights = hats @ light.T
    weights /= weights.sum(axis=0)

    def rows_of(values, per_line):
        text = [f"{v:.6g}" for v in values]
        for i in range(0, len(text), per_line):
            print("    " + ", ".join(text[i:i + per_line]) + ",")

    print("/* metals_spectrum.h - printed by scripts/metals.py --spectrum from tables of refractiveindex.info\n"
          " * (CC0) and of the CIE: every 10 nm from 380 to 780 */")
    print("static const double rgb_weights[3][SPECTRUM] = {")
    for c in range(3):
        print("  {")
        rows_of(weights[:, c], 9)
        print("  },")
    print("};\n\n/* n, then k, in the order of the metals */\nstatic const double metal_index[][2][SPECTRUM] = {")
    for name, column, _ in METALS:
        i = head.index(column + ":n")
        print("  {   /* " + name + " */")
        for j in (i, i + 1):
            values = np.array([number(r[j]) for r in rows])
            ok = ~np.isnan(values)
            print("  {")
            rows_of(np.interp(nm, wave[ok], values[ok]), 10)
            print("  },")
        print("  },")
    print("};")


def main():
    if sys.argv[1:] == ["--spectrum"]:
        spectrum()
        return
    head, rows = table("ior/ior_5nm_360_830.csv")
    wave = np.array([number(r[0]) for r in rows])
    _, cie = table("cie/cie1931_2deg_1nm.csv")
    cie = np.array([[float(x) for x in r] for r in cie])
    _, d65 = table("cie/d65_300_830.csv")
    d65 = np.array([[float(x) for x in r] for r in d65])
    weight = np.stack([np.interp(wave, cie[:, 0], cie[:, i]) for i in (1, 2, 3)])
    weight = weight * np.interp(wave, d65[:, 0], d65[:, 1])
    rgb = TO_SRGB @ weight
    rgb /= rgb.sum(axis=1, keepdims=True)  # a perfect mirror is white
    cosines = np.cos(np.radians(np.linspace(0, 88, 45)))
    print("/* metals_table.h - printed by scripts/metals.py from tables of refractiveindex.info (CC0) */")
    for name, column, source in METALS:
        i = head.index(column + ":n")
        n = np.array([number(r[i]) for r in rows])
        k = np.array([number(r[i + 1]) for r in rows])
        curves = np.array([rgb @ fresnel(c, n, k) for c in cosines])
        worst = 0.0
        fits = []
        for channel in range(3):
            target = np.clip(curves[:, channel], 0.0, 1.0)
            best = min((least_squares(lambda q: fresnel(cosines, q[0], q[1]) - target, start,
                                      bounds=([1e-3, 0], [20, 30]), xtol=1e-14, ftol=1e-14)
                        for start in ([0.2, 3.0], [1.5, 4.0], [3.0, 3.0])), key=lambda r: r.cost)
            fits.append(best.x)
            worst = max(worst, abs(best.fun).max())
        e = [f"{f[0]:.5f}" for f in fits]
        q = [f"{f[1]:.5f}" for f in fits]
        f0 = [f"{x:.5f}" for x in curves[0]]
        print(f'    {{ "{name}", "{source}", {{ {", ".join(e)} }}, {{ {", ".join(q)} }},\n'
              f'      {{ {", ".join(f0)} }} }},')
        print(f"{name}: worst difference of a channel's curve {worst:.4f}", file=sys.stderr)


if __name__ == "__main__":
    main()
