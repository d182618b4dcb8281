/* block_fresnel.h - the Fresnel term of a material over a block: facet_fresnel.h in loops, with the same bits */

#include "bsdf/facet_fresnel.h"
#include "core/blocks.h"

#ifndef ASPI_BLOCK_FRESNEL_NAMES
#define ASPI_BLOCK_FRESNEL_NAMES
#define aspi_block_fresnel ASP_NAME(aspi_block_fresnel)
#define aspi_block_ones ASP_NAME(aspi_block_ones)
#define aspi_fresnel_conductors ASP_NAME(aspi_fresnel_conductors)
#define aspi_fresnel_dielectrics ASP_NAME(aspi_fresnel_dielectrics)
#define aspi_fresnel_f82s ASP_NAME(aspi_fresnel_f82s)
#define aspi_fresnel_films ASP_NAME(aspi_fresnel_films)
#define aspi_fresnel_metals ASP_NAME(aspi_fresnel_metals)
#define aspi_fresnel_ones ASP_NAME(aspi_fresnel_ones)
#define aspi_fresnel_scale ASP_NAME(aspi_fresnel_scale)
#endif

#if (ASP_PRECISION == 64 && !defined(ASPI_BLOCK_FRESNEL_64)) || \
    (ASP_PRECISION == 32 && !defined(ASPI_BLOCK_FRESNEL_32))
#if ASP_PRECISION == 64
#define ASPI_BLOCK_FRESNEL_64
#else
#define ASPI_BLOCK_FRESNEL_32
#endif

#define IN const asp_real *ASP_RESTRICT
#define OUT asp_real *ASP_RESTRICT

ASP_FN void aspi_fresnel_metals(size_t n, asp_real eta, asp_real kappa, IN c2, IN by, IN over, OUT F)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v2 ratio = aspi_conductor_ratio(aspi_abs(c2[i]), eta, kappa);
        F[i] = aspi_finite((ratio.x * by[i]) / (ratio.y * over[i]));
    }
}

/* by/over, and the cosine. */
ASP_FN void aspi_fresnel_scale(size_t n, IN c2, IN by, IN over, OUT c, OUT x)
{
    size_t i;
    for (i = 0; i < n; i++) {
        c[i] = aspi_sqrt(aspi_unit_cosine(c2[i]));
        x[i] = aspi_finite(by[i] / over[i]);
    }
}

ASP_FN void aspi_fresnel_conductors(size_t n, asp_real eta, asp_real kappa, IN c2, IN by, OUT F)
{
    size_t i;
    for (i = 0; i < n; i++)
        F[i] = aspi_fresnel_conductor_at(aspi_unit_cosine(c2[i]), eta, kappa) * by[i];
}

ASP_FN void aspi_fresnel_f82s(size_t n, asp_real f0, asp_real tint, IN c, IN by, OUT F)
{
    size_t i;
    for (i = 0; i < n; i++)
        F[i] = aspi_fresnel_f82(c[i], f0, tint) * by[i];
}

ASP_FN void aspi_fresnel_dielectrics(size_t n, asp_real eta, IN c, IN by, OUT F)
{
    size_t i;
    for (i = 0; i < n; i++)
        F[i] = aspi_fresnel_dielectric(c[i], eta) * by[i];
}

ASP_FN void aspi_fresnel_films(size_t n, IN table, IN c, IN by, OUT F)
{
    size_t i;
    for (i = 0; i < n; i++)
        F[i] = aspi_fresnel_film(table, c[i]) * by[i];
}

ASP_FN void aspi_fresnel_ones(size_t n, IN c, IN by, OUT F)
{
    size_t i;
    for (i = 0; i < n; i++)
        F[i] = (c[i] == c[i] ? R(1.0) : c[i]) * by[i];
}

/* The Fresnel term at the squared cosines c2, times by/over. */
ASP_FN void aspi_block_fresnel(const asp_mat *mat, size_t n, const asp_real *c2, const asp_real *above,
                          const asp_real *over, asp_c3s F)
{
    asp_real c[ASP_BLOCK], by[ASP_BLOCK];
    if (mat->fresnel == ASPI_FRESNEL_METAL) { /* one loop for the channels: half as long a function */
        const asp_real eta[3] = { mat->c.r, mat->c.g, mat->c.b }, kappa[3] = { mat->d.r, mat->d.g, mat->d.b };
        asp_real *const to[3] = { F.r, F.g, F.b };
        int channel;
        for (channel = 0; channel < 3; channel++)
            aspi_fresnel_metals(n, eta[channel], kappa[channel], c2, above, over, to[channel]);
        return;
    }
    aspi_fresnel_scale(n, c2, above, over, c, by);
    switch (mat->fresnel) {
    case ASPI_FRESNEL_CONDUCTOR:
        aspi_fresnel_conductors(n, mat->c.r, mat->d.r, c2, by, F.r);
        aspi_fresnel_conductors(n, mat->c.g, mat->d.g, c2, by, F.g);
        aspi_fresnel_conductors(n, mat->c.b, mat->d.b, c2, by, F.b);
        break;
    case ASPI_FRESNEL_F82:
        aspi_fresnel_f82s(n, mat->c.r, mat->d.r, c, by, F.r);
        aspi_fresnel_f82s(n, mat->c.g, mat->d.g, c, by, F.g);
        aspi_fresnel_f82s(n, mat->c.b, mat->d.b, c, by, F.b);
        break;
    case ASPI_FRESNEL_DIELECTRIC:
        aspi_fresnel_dielectrics(n, mat->c.r, c, by, F.r);
        memcpy(F.g, F.r, n * sizeof *F.r);
        memcpy(F.b, F.r, n * sizeof *F.r);
        break;
    case ASPI_FRESNEL_FILM:
        aspi_fresnel_films(n, mat->energy + ENERGY_FILM, c, by, F.r);
        aspi_fresnel_films(n, mat->energy + ENERGY_FILM + ENERGY_FILM_NODES, c, by, F.g);
        aspi_fresnel_films(n, mat->energy + ENERGY_FILM + 2 * ENERGY_FILM_NODES, c, by, F.b);
        break;
    default:
        aspi_fresnel_ones(n, c, by, F.r);
        memcpy(F.g, F.r, n * sizeof *F.r);
        memcpy(F.b, F.r, n * sizeof *F.r);
    }
}

ASP_FN void aspi_block_ones(asp_real ones[ASP_BLOCK])
{
    size_t i;
    for (i = 0; i < ASP_BLOCK; i++)
        ones[i] = R(1.0);
}
#undef IN
#undef OUT
#endif
