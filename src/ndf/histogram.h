/* histogram.h - slopes counted in cells: the prepared numbers, and the surface in float64
 *
 * P22 is constant in each cell of a rectangle of slopes and 0 outside. In units of cells, s along x
 * and t along y, a view sees the height c - a s - b t of the facets above the plane through the eye,
 *     sigma = sum over cells q of the integral of max(0, c - a s - b t).
 * Let |a| >= |b| (else the axes change places) and a > 0 (else s runs backwards). A row then sees
 *     g(h) = integral of max(0, h - a s) q(s) ds,  h = c - b t,
 * which in cell k, with e = h - a k, is a parabola of positive terms,
 *     g = a C_k + e A_k + e^2 (A_(k+1) - A_k) / (2 a),
 * A_k the row's mass before edge k and C_k = integral of (k - s) q before it. Within one row h crosses
 * one edge at most. So sigma costs a few products per row, nothing cancels, and the same parabolas
 * are inverted by the sampler. */
#ifndef ASPI_HISTOGRAM_H
#define ASPI_HISTOGRAM_H

#include "asperity_ndf.h"

#define ASPI_HISTOGRAM_SIDE 1024

/* The head of the caller's memory; the tables follow it. */
typedef struct aspi_cells {
    int nx, ny;
    double x0, y0, dx, dy;      /* lower corner and size of a cell, slopes less their mean */
    double per_x, per_y;        /* 1/dx, 1/dy */
    double high_x, high_y;      /* upper corner */
} aspi_cells;

double aspi_cells_P22(const aspi_cells *k, double x, double y);
double aspi_cells_sigma(const aspi_cells *k, asp_vec3 v);
asp_vec3 aspi_cells_visible(const aspi_cells *k, asp_vec3 v, double u1, double u2);
asp_vec3 aspi_cells_normal(const aspi_cells *k, double u1, double u2);

/* Where the tables stand: per table a row holds cols + 3 pairs (A, C) for the edges -1 .. cols + 1. */
typedef enum aspi_cells_table { ASPI_FROM_LEFT, ASPI_FROM_RIGHT, ASPI_FROM_BELOW, ASPI_FROM_ABOVE }
    aspi_cells_table;

static inline size_t aspi_cells_rows(const aspi_cells *k, aspi_cells_table which)
{
    return (size_t)(which < ASPI_FROM_BELOW ? k->ny : k->nx);
}

static inline size_t aspi_cells_stride(const aspi_cells *k, aspi_cells_table which)
{
    return 2 * ((size_t)(which < ASPI_FROM_BELOW ? k->nx : k->ny) + 3);
}

static inline size_t aspi_cells_place(const aspi_cells *k, aspi_cells_table which)
{
    size_t x = aspi_cells_rows(k, ASPI_FROM_LEFT) * aspi_cells_stride(k, ASPI_FROM_LEFT);
    size_t y = aspi_cells_rows(k, ASPI_FROM_BELOW) * aspi_cells_stride(k, ASPI_FROM_BELOW);
    return which < ASPI_FROM_BELOW ? (size_t)which * x
                                   : 2 * x + (size_t)(which - ASPI_FROM_BELOW) * y;
}

/* P22 by cell, row by row, behind the tables; then the mass below each edge of a row. */
static inline size_t aspi_cells_density(const aspi_cells *k)
{
    return aspi_cells_place(k, ASPI_FROM_ABOVE)
         + aspi_cells_rows(k, ASPI_FROM_BELOW) * aspi_cells_stride(k, ASPI_FROM_BELOW);
}

static inline size_t aspi_cells_below(const aspi_cells *k)
{
    return aspi_cells_density(k) + (size_t)k->nx * (size_t)k->ny;
}

static inline size_t aspi_cells_numbers(const aspi_cells *k)
{
    return aspi_cells_below(k) + (size_t)k->ny + 1;
}

static inline const double *aspi_cells_at(const aspi_cells *k, size_t place)
{
    return (const double *)(const void *)(k + 1) + place;
}
#endif
