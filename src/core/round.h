/* round.h - is a standard surface radially symmetric in slopes? */
#ifndef ASPI_ROUND_H
#define ASPI_ROUND_H

#include "asperity.h"

/* P22 in directions 0, 3/4/5 and 90 degrees and against them, at four slopes. `surface` stands in the
 * identity map (or a multiple of it). */
static inline int aspi_is_round(const asp_ndf *surface)
{
    static const double x[] = { 0.0, -1.0, 0.0, 0.6, -0.8, 0.28 }, y[] = { 1.0, 0.0, -1.0, 0.8, 0.6, -0.96 };
    double r = 0.05;
    int i, k;
    for (k = 0; k < 4; k++, r *= 4.0)
        for (i = 0; i < 6; i++) {
            double a = asp_P22(surface, r, 0.0), b = asp_P22(surface, r * x[i], r * y[i]);
            if (!(b - a <= 1e-6 * a + 1e-300 && a - b <= 1e-6 * a + 1e-300))
                return 0;
        }
    return 1;
}

#endif
