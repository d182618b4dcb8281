/* energy.h - how much of the light a perfect mirror microsurface keeps with single scattering */
#ifndef ENERGY_H
#define ENERGY_H

#include "asperity.h"

/* The share of white light from everywhere that leaves again after one reflection,
 * (1/pi) times the double integral of f cos cos (STD paper eq. 24 with the factors of its two misprints
 * set right), for both maskings at once. For distributions that are radial in the slopes, made with a
 * roughness between 0.01 and 3. Error: tests/test_figures.py. */
typedef struct energy_kept { double separable, correlated; } energy_kept;
energy_kept energy_of(const asp_ndf *ndf, double alpha);

#endif
