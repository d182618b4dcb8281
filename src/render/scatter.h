/* scatter.h - one face for materials and functions, in blocks */
#ifndef ASPI_RENDER_SCATTER_H
#define ASPI_RENDER_SCATTER_H

#include "asperity_draw.h"

#define ASPI_BLOCK 64

typedef struct aspi_scatter {
    const asp_material *material;        /* or, when NULL: */
    asp_brdf_function  *function;
    const void         *context;
    const asp_material *proposal;        /* may be NULL */
    int                 walk;            /* 1: multiple scattering of the material */
} aspi_scatter;

/* A stream of uniform numbers (core/rng.h). */
typedef struct aspi_stream { uint64_t start, next; } aspi_stream;
double aspi_stream_next(void *stream);

/* Arrays of one block: directions in, or out of, the surface's frame. */
typedef struct aspi_directions { double x[ASPI_BLOCK], y[ASPI_BLOCK], z[ASPI_BLOCK]; } aspi_directions;
typedef struct aspi_colours { double r[ASPI_BLOCK], g[ASPI_BLOCK], b[ASPI_BLOCK]; } aspi_colours;

/* n <= ASPI_BLOCK. Samples wo, its density and f cos(theta_o) / density; a density of 0 means that
 * there is no direction to look at. */
void aspi_scatter_sample(const aspi_scatter *scatter, size_t n, const aspi_directions *wi,
                         const double *u1, const double *u2, aspi_directions *wo, double *pdf,
                         aspi_colours *weight);
/* f cos(theta_o) and the density of the above. */
void aspi_scatter_eval(const aspi_scatter *scatter, size_t n, const aspi_directions *wi,
                       const aspi_directions *wo, double *pdf, aspi_colours *value);

#endif
