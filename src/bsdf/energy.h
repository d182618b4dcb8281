/* energy.h - the albedo of single scattering as a table in a material, for what gives back the rest
 *
 * If the surface looks the same from all azimuths, asp_material.energy holds ENERGY_FINE values over t = a/(a + b),
 * a^2 = cos_i and b^2 = 1 - cos_i, which is even in the angle towards the normal and in the root of the cosine
 * towards grazing.
 *
 * Else ENERGY_COLUMNS columns of ENERGY_ROWS, half as many columns if the surface is the same after half a turn. The
 * mirror image of w in a facet of slopes q is above the horizon for q in the circle of radius 1/w.z round -w_xy/w.z;
 * E is about the share of slopes in it. So what counts is how far inside the mean slope t is,
 *
 *     d = 1/w.z - |t + w_xy/w.z| = (w.z (1 - t^2) - 2 t.w_xy)/(1 + |u|),   u = w_xy + t w.z,
 *
 * against the roughness v = |M^T u|/|u| towards the circle. At the horizon d = -t.u/|u|. The rows are even in the root
 * of g(d) = d/(v + |d|) + ENERGY_EVEN d, from the horizon's g in the column to the g of light along the mean facet's
 * normal at the least v of all; beyond d's end a column goes on as it ended. The columns are even in the angle half
 * way between u and L u,
 *
 *     L = P/|P| + t t^T/(2 |t| v),   P^2 = M M^T, v across t,
 *
 * so that as many lie where E changes with azimuth as elsewhere.
 *
 * Then the mean over the hemisphere. On a skewed surface the values are E(w) times what `min` or walls add to the
 * area seen, over that area, so that masking's own kinks are not interpolated. A dielectric has a second such
 * table, of its inside, where others have the colours of a film. */
#ifndef ASPI_ENERGY_H
#define ASPI_ENERGY_H

#include "bsdf/bsdf.h"
#define ENERGY_ROWS 20
#define ENERGY_FINE 28
#define ENERGY_EVEN 0.5
#define ENERGY_COLUMNS 32
#define ENERGY_FILM_NODES 31
enum {
    ENERGY_TABLE = 0,
    ENERGY_MEAN = ENERGY_ROWS * ENERGY_COLUMNS,      /* mean of E, cosine-weighted */
    ENERGY_COUNT,                                    /* columns in use, */
    ENERGY_HEIGHT,                                   /* rows of each, */
    ENERGY_TURNS,                                    /* and how often they repeat round the surface */
    ENERGY_SPREAD,                                   /* 1 - E is about in proportion to 1/(cos^2 + spread); */
    ENERGY_SPREAD_LOG,                               /* log(1 + 1/spread) */
    ENERGY_BEND,                                     /* L: xx, xy, yy */
    ENERGY_TOP = ENERGY_BEND + 3,                    /* g of the last row */
    ENERGY_FILM,                                     /* a film's colour over the cosine, or the */
    ENERGY_INSIDE = ENERGY_FILM,                     /* table of the other side */
    ENERGY_END = ENERGY_FILM + 3 * ENERGY_FILM_NODES
};
#if ENERGY_ROWS * ENERGY_COLUMNS + 10 + 3 * ENERGY_FILM_NODES > ASP_ENERGY_NUMBERS \
    || 2 * (ENERGY_ROWS * ENERGY_COLUMNS + 10) > ASP_ENERGY_NUMBERS
#error "asp_material.energy is too small"
#endif

/* Fills out->energy for what the material's Fresnel term reflects once, in float64. */
void aspi_energy_prepare(asp_material *out);

/* The same for a dielectric, reflected and refracted together: outside, and inside for -w. */
void aspi_energy_prepare_sides(asp_material *out);

#endif
