/* prepared.h - masking and sampling of any radially symmetric slope density, prepared numerically
 *
 * A distribution whose density is known but whose projected area and samplers have no closed form
 * gives the logarithm of its slope density once, as a loop in float64:
 *
 *     ASP_CLONES static void toy_log_density(const asp_ndf *k, size_t n, const double *ASP_RESTRICT r2,
 *                                            double *ASP_RESTRICT out) { ... }
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
 * If it has a closed form of its own for the plain normal or for sigma, it defines ASP_OWN_NORMAL or
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

/* Natural logarithms of the slope density P22 at r2 = slope^2, up to a constant. */
typedef void aspi_log_density(const asp_ndf *k, size_t n, const double *r2, double *out);

/* Fills out->table from PREPARED_OWN on; out->shape and the distribution's own numbers are read by f.
 * out->table[PREPARED_LOG_MASS] is the logarithm of the integral of e^f over all slopes: what a density
 * without a closed normalisation subtracts, and 0 within 1e-9 where f is normalised. */
asp_status aspi_prepared_make(asp_ndf *out, aspi_log_density *f, asp_error *err);

/* ---- the tables, for prepared_kernel.h: AREA, DEEP and NORMAL by pieces (ndf/pieces.h), the others
 * coefficients of uniform cubic B-splines, divided by 6
 *
 * With T0 = 2 J(0), J as in student.h, slopes in units of T0 and q = |w|/(T0 s):
 *     AREA      E = J(mu) (mu + T0)/T0^2 over y = 1/(1 + q), by pieces (ndf/pieces.h)
 *     DEEP      (J/(P22(mu) T0^3 sqrt(1 + q)))^(-2/5), likewise, from q = 1/2 on: what is seen from below the
 *               mean plane keeps its relative accuracy. While P22 is the power -2n this is about n/(1 + q): J/P22 falls like
 *               n^(-5/2)
 *               If bent, log(J/T0) instead, in the last piece less PREPARED_FALL log(y/PREPARED_DEEP_LAST)
 *     NORMAL    r over x = sqrt(share within r/share beyond r) of all slopes, by pieces in x up to
 *               PREPARED_NORMAL_LAST, and from there on as a power of x
 *     VIEWS     x over y = log(1 + mu/c): where among the rows of TAIL a view of slope mu stands. Rows are close
 *               where what is seen changes its shape, as on the way from a peak to a plateau
 *     TAIL      what a view below the mean plane sees are slopes of radius sqrt(mu^2 + eta^2): over x and z,
 *               z of t = log(share within eta/share beyond eta) of what is seen,
 *               log(eta/sqrt(mu^2 + T0^2))
 *
 * In t everything starts and ends as a straight line: r like e^(t/2) and eta like e^(t/5) (e^(t/3) for mu = 0)
 * while P22 is constant, and as powers of e^t where P22 is a power. z = t/sqrt(1 + (t/a)^2) only makes the cells longer
 * where fewer samples fall; a = PREPARED_WITHIN for t < 0, PREPARED_BEYOND above. Before the first
 * cell and beyond the last one it goes on straight, for TAIL as it does edge-on. */
#define PREPARED_PIECES 256             /* numbers of a table by pieces */
#define PREPARED_AREA_OCTAVE (-8)       /* where their first octave begins */
#define PREPARED_DEEP_OCTAVE (-1)
#define PREPARED_NORMAL_OCTAVE (-5)
#define PREPARED_NORMAL_LAST 5800.0     /* x beyond the largest that float32 has */
#define PREPARED_DEEP_LAST (1.0 / (1 + 24576.0))      /* y where the last piece of DEEP begins */
#define PREPARED_WITHIN 8.0
#define PREPARED_BEYOND 14.0
/* TAIL of bent densities has half as many rows, with twice as many cells: their corners lie across the rows. */
#define PREPARED_SHARE_STEP(bent) ((bent) ? 0.34 : 0.68)      /* a cell of z, */
#define PREPARED_SHARE_CELLS(bent) ((bent) ? 52 : 26)
#define PREPARED_SHARE_ZERO(bent) ((bent) ? 20 : 10)          /* where t = 0 */
#define PREPARED_SHARE_FIRST (-12.908548742233984)   /* t at both ends */
#define PREPARED_SHARE_LAST 17.288385820467795
#define PREPARED_SHARE_LEAST 37.0       /* the least share that is told from none: 2^-53 */
#define PREPARED_SHARE_ROW(bent) (PREPARED_SHARE_CELLS(bent) + 3)
#define PREPARED_VIEWS_CELLS 64
#define PREPARED_VIEW_CELLS(bent) ((bent) ? 15 : 32)          /* rows of TAIL, less 1 */
#define PREPARED_TAIL_NUMBERS(bent) (PREPARED_SHARE_ROW(bent) * (PREPARED_VIEW_CELLS(bent) + 3))
/* Visible normals drawn from above the mean plane end at a radius beyond which less than this share lies: there
 * the two parts of the sampler meet, which without an end would only do so at infinity. */
#define PREPARED_CUT 0x1p-26

enum {
    PREPARED_LOG_MASS = PREPARED_OWN,
    PREPARED_SCALE,              /* T0 = twice the area seen edge-on, E|x|: the unit of slopes; */
    PREPARED_SCALE2,             /* its square */
    PREPARED_IS_BENT,            /* 1 where prepare said so: see PREPARED_BENT */
    PREPARED_FALL,               /* d log J/d log y far out, then */
    PREPARED_EDGE,               /* radius beyond which PREPARED_CUT of what an edge-on view sees lies */
    PREPARED_NEAR,               /* c of VIEWS over T0, */
    PREPARED_FARTHEST,           /* its last y, */
    PREPARED_PER_VIEW,           /* and cells per unit of y */
    PREPARED_NORMAL_END,         /* d log r/d log x beyond PREPARED_NORMAL_LAST */
    PREPARED_TAIL_START,         /* d log eta/dt before the first t, and beyond the last */
    PREPARED_TAIL_END,
    PREPARED_AREA = PREPARED_OWN + 16,
    PREPARED_DEEP = PREPARED_AREA + PREPARED_PIECES,
    PREPARED_NORMAL = PREPARED_DEEP + PREPARED_PIECES,
    PREPARED_VIEWS = PREPARED_NORMAL + PREPARED_PIECES,
    PREPARED_TAIL = PREPARED_VIEWS + PREPARED_VIEWS_CELLS + 3,
    PREPARED_END = PREPARED_TAIL + (PREPARED_TAIL_NUMBERS(0) > PREPARED_TAIL_NUMBERS(1) ? PREPARED_TAIL_NUMBERS(0)
                                                                                        : PREPARED_TAIL_NUMBERS(1))
};

#endif
