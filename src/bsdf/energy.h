/* energy.h - the albedo of single scattering as a table in a material, for what gives back the rest
 *
 * asp_material.energy holds values over t = a/(a + b), a^2 = cos_i and b^2 = 1 - cos_i, which is even in the
 * angle towards the normal and in the root of the cosine towards grazing. One column of ENERGY_FINE rows if
 * the surface looks the same from all azimuths, else ENERGY_COLUMNS of ENERGY_ROWS, half as many if it does
 * after half a turn. Then their mean over the hemisphere. On a skewed surface the values are E(w) times what
 * `min` or walls add to the area seen, over that area, so that masking's own kinks are not interpolated. A
 * dielectric has a second such table, of its inside, where others have the colours of a film. */
#ifndef ASPI_ENERGY_H
#define ASPI_ENERGY_H

#include "bsdf/bsdf.h"
#define ENERGY_ROWS 20
#define ENERGY_FINE 28
#define ENERGY_COLUMNS 16
#define ENERGY_FILM_NODES 31
enum {
    ENERGY_TABLE = 0,
    ENERGY_MEAN = ENERGY_ROWS * ENERGY_COLUMNS,      /* mean of E, cosine-weighted */
    ENERGY_COUNT,                                    /* columns in use, */
    ENERGY_HEIGHT,                                   /* rows of each, */
    ENERGY_TURNS,                                    /* and how often they repeat round the surface */
    ENERGY_SPREAD,                                   /* 1 - E is about in proportion to 1/(cos^2 + spread); */
    ENERGY_SPREAD_LOG,                               /* log(1 + 1/spread) */
    ENERGY_FILM,                                     /* a film's colour over the cosine, or the */
    ENERGY_INSIDE = ENERGY_FILM,                     /* table of the other side */
    ENERGY_END = ENERGY_FILM + 3 * ENERGY_FILM_NODES
};
#if ENERGY_ROWS * ENERGY_COLUMNS + 6 + 3 * ENERGY_FILM_NODES > ASP_ENERGY_NUMBERS \
    || 2 * (ENERGY_ROWS * ENERGY_COLUMNS + 6) > ASP_ENERGY_NUMBERS
#error "asp_material.energy is too small"
#endif

/* Fills out->energy for what the material's Fresnel term reflects once, in float64. */
void aspi_energy_prepare(asp_material *out);

/* The same for a dielectric, reflected and refracted together: outside, and inside for -w. */
void aspi_energy_prepare_sides(asp_material *out);

#endif
