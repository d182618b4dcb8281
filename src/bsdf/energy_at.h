/* energy_at.h - looking up the table of energy.h, in both precisions */

#include "asperity/facet.h"
#include "bsdf/bsdf_number.h"
#include "bsdf/cubic.h"
#include "bsdf/energy.h"
#include "bsdf/reflection.h"

#ifndef ASPI_ENERGY_NAMES
#define ASPI_ENERGY_NAMES
#define aspi_energy_at ASP_NAME(aspi_energy_at)
#define aspi_energy_row ASP_NAME(aspi_energy_row)
#define aspi_energy_sum ASP_NAME(aspi_energy_sum)
#define aspi_energy_bend ASP_NAME(aspi_energy_bend)
#define aspi_energy_turn ASP_NAME(aspi_energy_turn)
#define aspi_energy_place ASP_NAME(aspi_energy_place)
#define aspi_energy_masked ASP_NAME(aspi_energy_masked)
#define aspi_rest_lobe ASP_NAME(aspi_rest_lobe)
#define aspi_rest_density ASP_NAME(aspi_rest_density)
#endif

#if (ASP_PRECISION == 64 && !defined(ASPI_ENERGY_64)) || \
    (ASP_PRECISION == 32 && !defined(ASPI_ENERGY_32))
#if ASP_PRECISION == 64
#define ASPI_ENERGY_64
#else
#define ASPI_ENERGY_32
#endif

/* The four rows round x in [0, rows - 1] and their weights. */
ASP_FN int aspi_energy_row(int rows, asp_real x, asp_real weight[4])
{
    int i = (int)aspi_select(x > R(1.0), x, R(1.0));             /* a NaN too, and stays one by the weights */
    i = i > rows - 3 ? rows - 3 : i;
    aspi_cubic(x - R(i), weight);
    return i - 1;
}

ASP_FN asp_real aspi_energy_sum(const asp_real *e, const asp_real weight[4])
{
    return e[0] * weight[0] + e[1] * weight[1] + e[2] * weight[2] + e[3] * weight[3];
}

/* What a skewed surface shows without `min` and walls, over what it shows with them. */
ASP_FN asp_real aspi_energy_masked(const asp_shape *k, asp_v3 w, int mask)
{
    asp_real sigma, seen;
    if (k->map.tx == R(0.0) && k->map.ty == R(0.0))
        return R(1.0);
    sigma = ASPI_CALL(asp_sigma)(k, w);
    seen = aspi_masked(k, w, sigma, mask);
    return aspi_max(sigma / aspi_max(seen, ASP_SMALLEST), R(1e-6));
}

/* g of the head of energy.h, v the roughness towards the facet. */
ASP_FN asp_real aspi_energy_bend(asp_real d, asp_real v)
{
    return d / (v + aspi_abs(d)) + R(ENERGY_EVEN) * d;
}

/* The column of the azimuth of (x, y), of length u, in turns: half way between it and L times it. */
ASP_FN asp_real aspi_energy_turn(const asp_real *energy, asp_real x, asp_real y, asp_real u)
{
    asp_real lx = energy[ENERGY_BEND] * x + energy[ENERGY_BEND + 1] * y;
    asp_real ly = energy[ENERGY_BEND + 1] * x + energy[ENERGY_BEND + 2] * y;
    asp_real by = u / aspi_sqrt(aspi_max(lx * lx + ly * ly, ASP_TINY));
    return aspi_atan(y + ly * by, x + lx * by) * R(0.5 / ASP_PI);
}

/* Where a direction w, w.z > 0, lies in a table of several columns: the turn .x of its column and its place .y
 * between the first row, 0, and the last, 1. */
ASP_FN asp_v2 aspi_energy_place(const asp_shape *k, const asp_real *energy, asp_v3 w)
{
    asp_real tx = k->map.tx, ty = k->map.ty, c = aspi_max(w.z, R(0.0)), t2 = tx * tx + ty * ty;
    asp_real x = w.x + tx * c, y = w.y + ty * c, u = aspi_sqrt(x * x + y * y), by = R(1.0) / aspi_max(u, ASP_SMALLEST);
    asp_real d = (c * (R(1.0) - t2) - R(2.0) * (tx * w.x + ty * w.y)) / (R(1.0) + u);
    asp_real low = -(tx * x + ty * y) * by;
    asp_real vx = k->map.m00 * x + k->map.m10 * y, vy = k->map.m01 * x + k->map.m11 * y;
    asp_real v = aspi_max(aspi_sqrt(vx * vx + vy * vy) * by, ASP_SMALLEST);
    /* (g(d) - g(low))/(top - g(low)) with one division */
    asp_real p = v + aspi_abs(d), q = v + aspi_abs(low), e = R(ENERGY_EVEN);
    asp_real over = (d * q - low * p) + e * (d - low) * (p * q);
    asp_real under = p * (energy[ENERGY_TOP] * q - low - e * low * q);
    asp_v2 out;
    out.x = aspi_energy_turn(energy, x, y, u);
    out.y = aspi_sqrt(aspi_min(aspi_max(over / under, R(0.0)), R(1.0)));
    return out;
}

/* E(w) from a table of the material, w.z > 0, in [0, 1]. */
ASP_FN asp_real aspi_energy_at(const asp_mat *mat, const asp_real *energy, asp_v3 w)
{
    int columns = (int)energy[ENERGY_COUNT], rows = (int)energy[ENERGY_HEIGHT], row, column, k;
    asp_real E, along[4], across[4];
    if (columns == 1) {
        asp_real c = aspi_min(aspi_max(w.z, R(0.0)), R(1.0)), a = aspi_sqrt(c);
        row = aspi_energy_row(rows, a / (a + aspi_sqrt(R(1.0) - c)) * R(rows - 1), along);
        E = aspi_energy_sum(energy + row, along);
    } else {
        asp_v2 place = aspi_energy_place(&mat->ndf, energy, w);
        asp_real turn = place.x * energy[ENERGY_TURNS];
        turn = turn - R((int)aspi_select(turn == turn, turn, R(0.0)));
        turn = (turn < R(0.0) ? turn + R(1.0) : turn) * R(columns);
        column = (int)aspi_select(turn == turn, turn, R(0.0));
        aspi_cubic(turn - R(column), across);
        row = aspi_energy_row(rows, place.y * R(rows - 1), along);
        column = column > 0 ? column - 1 : columns - 1;
        E = R(0.0);
        for (k = 0; k < 4; k++) {
            column = column >= columns ? 0 : column;
            E = E + across[k] * aspi_energy_sum(energy + column * rows + row, along);
            column++;
        }
    }
    E = E * aspi_energy_masked(&mat->ndf, w, mat->mask);
    return aspi_min(aspi_max(E, R(0.0)), R(1.0));
}

/* A direction for what is given back, about (1 - E) cos: density cos/(pi L (cos^2 + spread)), L = log(1 + 1/spread),
 * which is cos/pi on a rough surface; of a smooth one next to all is lost within a roughness of the horizon. */
ASP_FN asp_v3 aspi_rest_lobe(const asp_real *energy, asp_v3 wi, asp_real u1, asp_real u2)
{
    asp_real c2 = energy[ENERGY_SPREAD] * aspi_expm1(energy[ENERGY_SPREAD_LOG] * (R(1.0) - u1));
    c2 = aspi_select(c2 > R(1.0), R(1.0), c2);
    return aspi_lobe_around(wi, R(1.0) - c2, c2, u2);
}

ASP_FN asp_real aspi_rest_density(const asp_real *energy, asp_real c)
{
    return c / (R(ASP_PI) * energy[ENERGY_SPREAD_LOG] * (c * c + energy[ENERGY_SPREAD]));
}
#endif
