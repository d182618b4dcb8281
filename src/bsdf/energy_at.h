/* energy_at.h - looking up the table of energy.h, in both precisions */

#include "asperity/facet.h"
#include "bsdf/energy.h"

#ifndef ASPI_ENERGY_NAMES
#define ASPI_ENERGY_NAMES
#define aspi_energy_at ASP_NAME(aspi_energy_at)
#define aspi_energy_row ASP_NAME(aspi_energy_row)
#endif

#if (ASP_PRECISION == 64 && !defined(ASPI_ENERGY_64)) || \
    (ASP_PRECISION == 32 && !defined(ASPI_ENERGY_32))
#if ASP_PRECISION == 64
#define ASPI_ENERGY_64
#else
#define ASPI_ENERGY_32
#endif

/* Cubic through four rows of a column (Lagrange), x in [0, ENERGY_ROWS - 1]. */
ASP_FN asp_real aspi_energy_row(const asp_real *e, asp_real x)
{
    int i = (int)x;
    asp_real d;
    i = i < 1 ? 1 : i;
    i = i > ENERGY_ROWS - 3 ? ENERGY_ROWS - 3 : i;
    d = x - R(i);
    e += i - 1;
    return e[0] * (R(-1.0 / 6.0) * d * (d - R(1.0)) * (d - R(2.0)))
         + e[1] * (R(0.5) * (d + R(1.0)) * (d - R(1.0)) * (d - R(2.0)))
         + e[2] * (R(-0.5) * (d + R(1.0)) * d * (d - R(2.0)))
         + e[3] * (R(1.0 / 6.0) * (d + R(1.0)) * d * (d - R(1.0)));
}

/* E(w), w.z > 0, in [0, 1]. */
ASP_FN asp_real aspi_energy_at(const asp_real *energy, asp_v3 w)
{
    int columns = (int)energy[ENERGY_COUNT];
    asp_real x = aspi_sqrt(aspi_min(aspi_max(w.z, R(0.0)), R(1.0))) * R(ENERGY_ROWS - 1), E;
    if (columns == 1) {
        E = aspi_energy_row(energy, x);
    } else {
        asp_real turn = aspi_atan(w.y, w.x) * R(0.5 / ASP_PI) * energy[ENERGY_TURNS], y, d, weight[4];
        int j, k;
        turn = turn - R((int)turn);
        turn = turn < R(0.0) ? turn + R(1.0) : turn;
        y = turn * R(columns);
        j = (int)y;
        d = y - R(j);
        weight[0] = R(-1.0 / 6.0) * d * (d - R(1.0)) * (d - R(2.0));
        weight[1] = R(0.5) * (d + R(1.0)) * (d - R(1.0)) * (d - R(2.0));
        weight[2] = R(-0.5) * (d + R(1.0)) * d * (d - R(2.0));
        weight[3] = R(1.0 / 6.0) * (d + R(1.0)) * d * (d - R(1.0));
        E = R(0.0);
        for (k = 0; k < 4; k++)
            E = E + weight[k] * aspi_energy_row(energy + (j + k + columns - 1) % columns * ENERGY_ROWS, x);
    }
    return aspi_min(aspi_max(E, R(0.0)), R(1.0));
}
#endif
