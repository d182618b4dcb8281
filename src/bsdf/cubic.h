/* cubic.h - the cubic through four even nodes, for tables */

#include "asperity/facet.h"

#ifndef ASPI_CUBIC_NAMES
#define ASPI_CUBIC_NAMES
#define aspi_cubic ASP_NAME(aspi_cubic)
#endif

#if (ASP_PRECISION == 64 && !defined(ASPI_CUBIC_64)) || (ASP_PRECISION == 32 && !defined(ASPI_CUBIC_32))
#if ASP_PRECISION == 64
#define ASPI_CUBIC_64
#else
#define ASPI_CUBIC_32
#endif

/* Lagrange's weights of the nodes -1, 0, 1, 2 at d. */
ASP_FN void aspi_cubic(asp_real d, asp_real weight[4])
{
    weight[0] = R(-1.0 / 6.0) * d * (d - R(1.0)) * (d - R(2.0));
    weight[1] = R(0.5) * (d + R(1.0)) * (d - R(1.0)) * (d - R(2.0));
    weight[2] = R(-0.5) * (d + R(1.0)) * d * (d - R(2.0));
    weight[3] = R(1.0 / 6.0) * (d + R(1.0)) * d * (d - R(1.0));
}
#endif
