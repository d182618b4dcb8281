/* energy.h - the albedo of single reflection as a table in a material, for what gives back the rest
 *
 * asp_material.energy holds ENERGY_ROWS values of E(wi) over t = sqrt(cos_i) for each of the columns, which
 * are azimuths (one if the surface looks the same from all), then their mean over the hemisphere. */
#ifndef ASPI_ENERGY_H
#define ASPI_ENERGY_H

#include "bsdf/bsdf.h"
#define ENERGY_ROWS 20
#define ENERGY_COLUMNS 8
#define ENERGY_FILM_NODES 31
enum {
    ENERGY_TABLE = 0,
    ENERGY_MEAN = ENERGY_ROWS * ENERGY_COLUMNS,      /* mean of E, cosine-weighted */
    ENERGY_COUNT,                                    /* columns in use, */
    ENERGY_TURNS,                                    /* and how often they repeat round the surface */
    ENERGY_FILM,                                     /* a film's colour over the cosine */
    ENERGY_END = ENERGY_FILM + 3 * ENERGY_FILM_NODES
};
#if ENERGY_ROWS * ENERGY_COLUMNS + 3 + 3 * ENERGY_FILM_NODES > ASP_ENERGY_NUMBERS
#error "asp_material.energy is too small"
#endif

/* Fills out->energy for what the material's Fresnel term reflects once, in float64. */
void aspi_energy_prepare(asp_material *out);

#endif
