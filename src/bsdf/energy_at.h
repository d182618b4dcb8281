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

/* Cubic through four of the rows of a column, x in [0, rows - 1]. */
ASP_FN asp_real aspi_energy_row(const asp_real *e, int rows, asp_real x)
{
    asp_real weight[4];
    int i = (int)aspi_select(x > R(1.0), x, R(1.0));             /* a NaN too, and stays one by the weights */
    i = i > rows - 3 ? rows - 3 : i;
    aspi_cubic(x - R(i), weight);
    e += i - 1;
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

/* E(w) from a table of the material, w.z > 0, in [0, 1]. */
ASP_FN asp_real aspi_energy_at(const asp_mat *mat, const asp_real *energy, asp_v3 w)
{
    int columns = (int)energy[ENERGY_COUNT], rows = (int)energy[ENERGY_HEIGHT];
    asp_real c = aspi_min(aspi_max(w.z, R(0.0)), R(1.0)), a = aspi_sqrt(c);
    asp_real x = a / (a + aspi_sqrt(R(1.0) - c)) * R(rows - 1), E;
    if (columns == 1) {
        E = aspi_energy_row(energy, rows, x);
    } else {
        asp_real turn = aspi_atan(w.y, w.x) * R(0.5 / ASP_PI) * energy[ENERGY_TURNS], y, weight[4];
        int j, k;
        turn = turn - R((int)aspi_select(turn == turn, turn, R(0.0)));
        turn = turn < R(0.0) ? turn + R(1.0) : turn;
        y = turn * R(columns);
        j = (int)aspi_select(y == y, y, R(0.0));
        aspi_cubic(y - R(j), weight);
        E = R(0.0);
        for (k = 0; k < 4; k++)
            E = E + weight[k] * aspi_energy_row(energy + (j + k + columns - 1) % columns * rows, rows, x);
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
