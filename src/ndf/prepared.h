/* prepared.h - masking and sampling of any radially symmetric slope density, prepared numerically
 *
 * A distribution whose density is known but whose projected area and samplers have no closed form
 * gives the logarithm of its slope density once, as a C function in float64:
 *
 *     static double toy_log_density(const asp_ndf *k, double r2) { ... }
 *     static asp_status toy_prepare(asp_ndf *out, asp_error *err)
 *     {
 *         out->table[0] = ...;              (its own numbers: PREPARED_OWN of them)
 *         return aspi_prepared_make(out, toy_log_density, err);
 *     }
 *
 * and in its kernel part writes ndf_density itself and reads the rest:
 *
 *     #include "asperity/elementary.h"
 *     (ndf_density)
 *     #include "prepared_kernel.h"          ndf_sigma, ndf_visible, ndf_normal
 *     #include "asperity/ndf_loops.h"
 *
 * If it has a closed form of its own for the plain normal or for sigma, it defines PREPARED_OWN_NORMAL or
 * PREPARED_OWN_SIGMA before that line and writes ndf_normal or ndf_sigma itself.
 *
 * What is asked of the density: finite and positive at r = 0, falling at least as r^-4 times a constant far
 * out (every density of normals that is finite for vertical facets does), smooth on a logarithmic scale of
 * r, defined for r2 from 0 to 1e40; steps from one scale to another are found by themselves. */
#ifndef ASPI_PREPARED_H
#define ASPI_PREPARED_H

#include "asperity_ndf.h"

#define PREPARED_OWN 96          /* table[0 ... 95] belong to the distribution */

/* Natural logarithm of the slope density P22 at r2 = slope^2, up to a constant. */
typedef double aspi_log_density(const asp_ndf *k, double r2);

/* Fills out->table from PREPARED_OWN on; out->shape and the distribution's own numbers are read by f.
 * out->table[PREPARED_LOG_MASS] is the logarithm of the integral of e^f over all slopes: what a density
 * without a closed normalisation subtracts, and 0 within 1e-9 where f is normalised. */
asp_status aspi_prepared_make(asp_ndf *out, aspi_log_density *f, asp_error *err);

enum { PREPARED_LOG_MASS = PREPARED_OWN };

#endif
