/* facet_fresnel.h - the Fresnel term of a material, in both precisions */

#include "asperity/facet.h"
#include "asperity/fresnel.h"
#include "bsdf/cubic.h"
#include "bsdf/energy.h"

#ifndef ASPI_FACET_FRESNEL_NAMES
#define ASPI_FACET_FRESNEL_NAMES
#define aspi_fresnel ASP_NAME(aspi_fresnel)
#define aspi_fresnel_metal ASP_NAME(aspi_fresnel_metal)
#define aspi_fresnel_film ASP_NAME(aspi_fresnel_film)
#define aspi_film_colours ASP_NAME(aspi_film_colours)
#endif

#if (ASP_PRECISION == 64 && !defined(ASPI_FACET_FRESNEL_64)) || \
    (ASP_PRECISION == 32 && !defined(ASPI_FACET_FRESNEL_32))
#if ASP_PRECISION == 64
#define ASPI_FACET_FRESNEL_64
#else
#define ASPI_FACET_FRESNEL_32
#endif

/* Cubic through four nodes of a channel. */
ASP_FN asp_real aspi_fresnel_film(const asp_real *f, asp_real c)
{
    asp_real x = aspi_unit_cosine(c) * R(ENERGY_FILM_NODES - 1), weight[4], y;
    /* the first of the four; a NaN gives 0 here and comes out by the weights */
    int i = (int)aspi_min(aspi_max(R(0.0), x - R(1.0)), R(ENERGY_FILM_NODES - 4));
    aspi_cubic(x - R(i + 1), weight);
    y = f[i] * weight[0] + f[i + 1] * weight[1] + f[i + 2] * weight[2] + f[i + 3] * weight[3];
    y = y < R(0.0) ? R(0.0) : y;
    return y > R(1.0) ? R(1.0) : y;
}

ASP_FN void aspi_film_colours(const asp_mat *mat, asp_real c, asp_real F[3])
{
    F[0] = aspi_fresnel_film(mat->energy + ENERGY_FILM, c);
    F[1] = aspi_fresnel_film(mat->energy + ENERGY_FILM + ENERGY_FILM_NODES, c);
    F[2] = aspi_fresnel_film(mat->energy + ENERGY_FILM + 2 * ENERGY_FILM_NODES, c);
}

/* The metal's three channels side by side, which the compiler makes one vector of four. */
ASP_FN void aspi_fresnel_metal(const asp_mat *mat, asp_real c2, asp_real by, asp_real over, asp_real F[3])
{
    asp_real eta[4], k[4], f[4];
    int i;
    c2 = aspi_abs(c2);
    eta[0] = mat->c.r;
    eta[1] = mat->c.g;
    eta[2] = eta[3] = mat->c.b;
    k[0] = mat->d.r;
    k[1] = mat->d.g;
    k[2] = k[3] = mat->d.b;
    for (i = 0; i < 4; i++) {
        asp_v2 ratio = aspi_conductor_ratio(c2, eta[i], k[i]);
        f[i] = aspi_finite((ratio.x * by) / (ratio.y * over));
    }
    F[0] = f[0];
    F[1] = f[1];
    F[2] = f[2];
}

/* The Fresnel term at the squared cosine c2 (with its sign; by is 0 where it is negative), times by/over. Numbers go by pointer: small structs of floats stall
 * in the usual calling convention. */
ASP_FN void aspi_fresnel(const asp_mat *mat, asp_real c2, asp_real by, asp_real over, asp_real F[3])
{
    asp_real c;
    if (mat->fresnel == ASPI_FRESNEL_METAL) {
        aspi_fresnel_metal(mat, c2, by, over, F);
        return;
    }
    by = aspi_finite(by / over);
    c2 = aspi_unit_cosine(c2);
    c = aspi_sqrt(c2);
    switch (mat->fresnel) {
    case ASPI_FRESNEL_CONDUCTOR:
        F[0] = aspi_fresnel_conductor_at(c2, mat->c.r, mat->d.r);
        F[1] = aspi_fresnel_conductor_at(c2, mat->c.g, mat->d.g);
        F[2] = aspi_fresnel_conductor_at(c2, mat->c.b, mat->d.b);
        break;
    case ASPI_FRESNEL_F82:
        F[0] = aspi_fresnel_f82(c, mat->c.r, mat->d.r);
        F[1] = aspi_fresnel_f82(c, mat->c.g, mat->d.g);
        F[2] = aspi_fresnel_f82(c, mat->c.b, mat->d.b);
        break;
    case ASPI_FRESNEL_DIELECTRIC:
        F[0] = F[1] = F[2] = aspi_fresnel_dielectric(c, mat->c.r);
        break;
    case ASPI_FRESNEL_FILM:
        aspi_film_colours(mat, c, F);
        break;
    default:
        F[0] = F[1] = F[2] = c == c ? R(1.0) : c;
    }
    F[0] = F[0] * by;
    F[1] = F[1] * by;
    F[2] = F[2] * by;
}
#endif
