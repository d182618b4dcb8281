/* warp.c - functions and densities on the unit square */
#include "warp.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void aspi_warp_clear(aspi_warp *warp)
{
    free(warp->value);
    free(warp->row);
    free(warp->column);
    memset(warp, 0, sizeof *warp);
}

/* Trapezoids are exact for a bilinear function. Lengths are counted in cells. */
static int integrate_slice(aspi_warp *warp, size_t slice)
{
    size_t nx = warp->nx, ny = warp->ny;
    double *value = warp->value + slice * nx * ny, *row = warp->row + slice * nx * ny;
    double *column = warp->column + slice * ny;
    for (size_t y = 0; y < ny; y++) {
        double sum = 0;
        row[y * nx] = 0;
        for (size_t x = 1; x < nx; x++) {
            sum += 0.5 * (value[y * nx + x - 1] + value[y * nx + x]);
            row[y * nx + x] = sum;
        }
    }
    column[0] = 0;
    for (size_t y = 1; y < ny; y++)
        column[y] = column[y - 1] + 0.5 * (row[y * nx - 1] + row[(y + 1) * nx - 1]);
    double total = column[ny - 1];
    if (!(total > 0))
        return 0;
    for (size_t i = 0; i < nx * ny; i++) {
        value[i] /= total;
        row[i] /= total;
    }
    for (size_t y = 0; y < ny; y++)
        column[y] /= total;
    return 1;
}

long long aspi_warp_make(aspi_warp *warp, double *value, size_t nx, size_t ny, size_t slices,
                         int density)
{
    *warp = (aspi_warp){ nx, ny, slices, value, NULL, NULL };
    if (!density)
        return 1;
    warp->row = malloc(slices * nx * ny * sizeof *warp->row);
    warp->column = malloc(slices * ny * sizeof *warp->column);
    if (!warp->row || !warp->column)
        return 0;
    for (size_t i = 0; i < slices; i++)
        if (!integrate_slice(warp, i))
            return -1 - (long long)i;
    return 1;
}

/* An entry of a table, blended over the slices. */
static double blended(const double *table, size_t slice_size, size_t at, const aspi_blend *blend)
{
    double sum = 0;
    for (int i = 0; i < blend->count; i++)
        sum += blend->weight[i] * table[blend->slice[i] * slice_size + at];
    return sum;
}

/* The cell of a coordinate in [0, 1] and the place in it. */
static size_t cell_of(double x, size_t n, double *inside)
{
    double cells = (double)(n - 1);
    double at = x > 0 ? (x < 1 ? x * cells : cells) : 0;
    size_t cell = (size_t)at < n - 2 ? (size_t)at : n - 2;
    *inside = at - (double)cell;
    return cell;
}

static double mix(double a, double b, double t) { return (1 - t) * a + t * b; }

double aspi_warp_eval(const aspi_warp *warp, const aspi_blend *blend, double x, double y)
{
    double s, t;
    size_t nx = warp->nx, size = nx * warp->ny;
    size_t cell_x = cell_of(x, nx, &s), cell_y = cell_of(y, warp->ny, &t);
    size_t at = cell_y * nx + cell_x;
    return mix(mix(blended(warp->value, size, at, blend),
                   blended(warp->value, size, at + 1, blend), s),
               mix(blended(warp->value, size, at + nx, blend),
                   blended(warp->value, size, at + nx + 1, blend), s), t);
}

void aspi_warp_invert(const aspi_warp *warp, const aspi_blend *blend, double x, double y,
                      double *u, double *v)
{
    double s, t;
    size_t nx = warp->nx, size = nx * warp->ny;
    size_t cell_x = cell_of(x, nx, &s), cell_y = cell_of(y, warp->ny, &t);
    size_t line = cell_y * nx, at = line + cell_x;
    double left = mix(blended(warp->value, size, at, blend),
                      blended(warp->value, size, at + nx, blend), t);
    double right = mix(blended(warp->value, size, at + 1, blend),
                       blended(warp->value, size, at + nx + 1, blend), t);
    double before = mix(blended(warp->row, size, at, blend),
                        blended(warp->row, size, at + nx, blend), t);
    double low = blended(warp->row, size, line + nx - 1, blend);
    double high = blended(warp->row, size, line + 2 * nx - 1, blend);

    /* integrals of linear functions up to s and t */
    double mass = before + s * (left + 0.5 * s * (right - left)), whole = mix(low, high, t);
    *u = whole > 0 ? mass / whole : x;           /* an empty row: any place in it will do */
    *v = blended(warp->column, warp->ny, cell_y, blend) + t * (low + 0.5 * t * (high - low));
}
