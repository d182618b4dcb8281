/* surface.h - what the files of this folder share: the transform, facets, the tracer and the cells
 * of the gonioreflectometer */
#ifndef ASPI_SURFACE_H
#define ASPI_SURFACE_H

#include "data/measured.h"

/* ---- the discrete Fourier transform */

typedef struct aspi_complex { double re, im; } aspi_complex;

/* In place over n x n values, n a power of two, unscaled, exponent +i; the result is transposed:
 * data[x n + y] = sum over kx, ky of data[ky n + kx] exp(2 pi i (kx x + ky y)/n). `roots` has room
 * for n/2 values. */
void aspi_fft2(aspi_complex *data, int n, aspi_complex *roots);

/* ---- facets */

typedef struct aspi_slope { double p, q; } aspi_slope;

/* Slopes of the two triangles of a square with corner heights h00, h10 (x + 1), h01 (y + 1), h11.
 * parity (x + y) & 1 says along which diagonal it is cut: 0 from 00 to 11, 1 from 10 to 01. The
 * first triangle is the one with the lower edge (y), the second the one with the upper. */
static inline void aspi_square_slopes(int parity, double h00, double h10, double h01, double h11,
                                      double dx, double dy, aspi_slope out[2])
{
    out[0].p = (h10 - h00) / dx;
    out[1].p = (h11 - h01) / dx;
    out[0].q = (parity ? h01 - h00 : h11 - h10) / dy;
    out[1].q = (parity ? h11 - h10 : h01 - h00) / dy;
}

/* The slopes of all facets with known corners, one after the other (slopes.c). */
typedef void aspi_facet_visitor(void *context, aspi_slope slope);
void aspi_each_facet(const asp_height_field *field, aspi_facet_visitor *visit, void *context);

/* ---- the tracer */

typedef struct aspi_tracer aspi_tracer;

/* Builds the search tree over a periodic field of even nx and ny with finite heights. The field
 * need not be kept. */
aspi_tracer *aspi_tracer_make(const asp_height_field *field, asp_error *err);
void aspi_tracer_free(aspi_tracer *tracer);

typedef struct aspi_path {
    asp_vec3 wo;         /* where the light leaves to, z > 0 */
    asp_rgb  weight;     /* product of the Fresnel terms */
    int      bounces;    /* facets met, >= 1 */
} aspi_path;

/* Light from direction wi (wi.z > 0) onto the place (u, v) in [0, 1)^2 of the period, at the height
 * of the highest point. metal NULL: reflects all. Returns 0 when the ray is lost numerically. */
int aspi_trace(const aspi_tracer *tracer, double u, double v, asp_vec3 wi, const asp_metal *metal,
               aspi_path *out);

/* ---- the cells of the gonioreflectometer */

enum { ASPI_CELLS_H = 180, ASPI_CELLS_D = 18, ASPI_CELLS_PHI = 12,
       ASPI_CELLS = ASPI_CELLS_H * ASPI_CELLS_D * ASPI_CELLS_PHI };

/* Fixed point, so that sums do not depend on the order: weights in units of 2^-28. */
#define ASPI_WEIGHT_ONE 0x1p28
typedef struct aspi_cell { uint64_t count, r, g, b; } aspi_cell;

/* Order [theta_d][phi_d][theta_h]: theta_h square-root spaced over [0, pi/2], theta_d even over
 * [0, pi/2], phi_d even over the folded range [0, pi/2]. */
typedef struct aspi_counts {
    aspi_cell cells[ASPI_CELLS];
    uint64_t  rays, lost, bounces;
    aspi_cell all, multiple;            /* multiple: paths of two bounces or more */
} aspi_counts;

/* One path that came in from wi. */
void aspi_gonio_add(aspi_counts *counts, asp_vec3 wi, const aspi_path *path);

/* Sends `rays` rays; *counts is overwritten. Random stream 3 + chunk of the seed. */
asp_status aspi_gonio_count(const aspi_tracer *tracer, const asp_metal *metal, uint64_t seed,
                            size_t rays, int threads, asp_progress *progress, void *context,
                            aspi_counts *counts, asp_error *err);

/* Turns counts into f over MERL's grid, 3 x 90 x 90 x 180, negative where there is no value. */
asp_status aspi_gonio_table(const aspi_counts *counts, double *values,
                            asp_fabrication_report *report, asp_error *err);

#endif
