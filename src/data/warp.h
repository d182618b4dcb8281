/* warp.h - functions and densities on the unit square, tabulated for several parameters
 *
 * Values at nx x ny grid points span the unit square and are bilinear between them; there is one
 * such slice per parameter value, and slices are blended linearly. A density's slice integrates to
 * 1. J. Dupuy, W. Jakob, An Adaptive Parameterization for Efficient Material Acquisition and
 * Rendering, SIGGRAPH Asia 2018. */
#ifndef ASPI_WARP_H
#define ASPI_WARP_H

#include <stddef.h>

typedef struct aspi_warp {
    size_t  nx, ny, slices;
    double *value;                       /* [slice][y][x] */
    double *row;                         /* densities: integral over x from 0, [slice][y][x] */
    double *column;                      /* densities: integral over y from 0, [slice][y] */
} aspi_warp;

/* Slices and their weights, which sum to 1. */
#define ASPI_BLEND 4
typedef struct aspi_blend { int count; size_t slice[ASPI_BLEND]; double weight[ASPI_BLEND]; } aspi_blend;

/* Takes `value`. density: normalises each slice and prepares its integrals. 0: no memory;
 * -1 - i: slice i of a density is zero everywhere. The warp is to be cleared in every case. */
long long aspi_warp_make(aspi_warp *warp, double *value, size_t nx, size_t ny, size_t slices,
                         int density);
void   aspi_warp_clear(aspi_warp *warp);

double aspi_warp_eval(const aspi_warp *warp, const aspi_blend *blend, double x, double y);
/* The point (u, v) of the unit square from which the density's map sends mass to (x, y):
 * v = share of the mass below y, u = share of the row at y left of x. */
void   aspi_warp_invert(const aspi_warp *warp, const aspi_blend *blend, double x, double y,
                        double *u, double *v);
#endif
