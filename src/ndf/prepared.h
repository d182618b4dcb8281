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
 * A density whose logarithm has corners in its second derivative or its first (knots) defines PREPARED_BENT before
 * that line and has its prepare set table[PREPARED_IS_BENT] to 1: then what is seen from below the mean plane,
 * which is smoother than the density, is not put together from it.
 *
 * What is asked of the density: finite and positive at r = 0, falling at least as r^-4 times a constant far
 * out (every density of normals that is finite for vertical facets does), smooth on a logarithmic scale of
 * r, defined for r2 from 0 to 1e40. Several scales in one density are found by themselves. */
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

/* ---- the tables, for prepared_kernel.h: AREA and DEEP by pieces (ndf/pieces.h), the others
 * coefficients of uniform cubic B-splines, divided by 6
 *
 * With T0 = 2 J(0), J as in student.h, slopes in units of T0 and q = |w|/(T0 s):
 *     AREA      E = J(mu) (mu + T0)/T0^2 over y = 1/(1 + q), by pieces (ndf/pieces.h)
 *     DEEP      (J/(P22(mu) T0^3 sqrt(1 + q)))^(-2/5), likewise, from q = 1/2 on: what is seen from below the
 *               mean plane keeps its relative accuracy. While P22 is the power -2n this is about n/(1 + q): J/P22 falls like
 *               n^(-5/2)
 *               If bent, log(J/T0) instead, in the last piece less PREPARED_FALL log(y/PREPARED_DEEP_LAST)
 *     BELOW     for TAIL, log of J/(P22(mu) (mu^2 + T0^2)^(3/2)) over q^(1/4)/(1 + q^(1/4))
 *     NORMAL    log(r/sqrt e) over z = e^(1/4), e = -log Q(r), Q(r) the share of slopes beyond r
 *     TAIL      what a view below the mean plane sees are slopes of radius sqrt(mu^2 + eta^2): over v and
 *               rho^(1/5), rho = -log of the share with larger eta, log(eta/sqrt(mu^2 + T0^2)) - p log rho - a BELOW
 *               with p = PREPARED_POWER: while P22 is constant eta starts like rho^(1/5), or rho^(1/3) for
 *               mu = 0; a = PREPARED_STEEP: far below the plane eta^5 = 7.5 rho mu^2 J/P22(mu) at first, so
 *               that what is left varies little however steep the tail */
#define PREPARED_PIECES 256             /* numbers of a table by pieces */
#define PREPARED_AREA_OCTAVE (-8)       /* where their first octave begins */
#define PREPARED_DEEP_OCTAVE (-1)
#define PREPARED_DEEP_LAST (1.0 / (1 + 24576.0))      /* y where the last piece of DEEP begins */
#define PREPARED_BELOW_CELLS 180
#define PREPARED_NORMAL_CELLS 40
#define PREPARED_VIEW_CELLS 19
#define PREPARED_TAIL_CELLS 25
#define PREPARED_TAIL_ROW (PREPARED_TAIL_CELLS + 3)
#define PREPARED_LEAST 0x1p-53          /* the least share that is told from none; e, rho up to 36.8 */
/* Visible normals drawn from above the mean plane end at a radius beyond which less than this share lies: there
 * the two parts of the sampler meet, which without an end would only do so at infinity. */
#define PREPARED_CUT 0x1p-26
#define PREPARED_Z_END 2.4625           /* (-log of it)^(1/4), rounded up */
#define PREPARED_TAIL_END 2.0565        /* (-log of it)^(1/5), rounded up */
#define PREPARED_VIEW_END .96875          /* v beyond this counts as this for TAIL */
#define PREPARED_POWER(q2) (0.2 + (2.0 / 15) / (1 + 100 * (q2)))
#define PREPARED_STEEP(q2) (0.2 * (q2) / (1 + (q2)))

enum {
    PREPARED_LOG_MASS = PREPARED_OWN,
    PREPARED_SCALE,              /* T0 = twice the area seen edge-on, E|x|: the unit of slopes; */
    PREPARED_SCALE2,             /* its square */
    PREPARED_IS_BENT,            /* 1 where prepare said so: see PREPARED_BENT */
    PREPARED_FALL,               /* d log J/d log y far out, then */
    PREPARED_EDGE,               /* radius beyond which PREPARED_CUT of what an edge-on view sees lies */
    PREPARED_AREA = PREPARED_OWN + 16,
    PREPARED_DEEP = PREPARED_AREA + PREPARED_PIECES,
    PREPARED_BELOW = PREPARED_DEEP + PREPARED_PIECES,
    PREPARED_NORMAL = PREPARED_BELOW + PREPARED_BELOW_CELLS + 3,
    PREPARED_TAIL = PREPARED_NORMAL + PREPARED_NORMAL_CELLS + 3,
    PREPARED_END = PREPARED_TAIL + PREPARED_TAIL_ROW * (PREPARED_VIEW_CELLS + 3)
};

#endif
