/* refraction.h - the formulas of refraction by facets, shared by materials and walks
 *
 * Walter et al. 2007, section 5. eta is the index of the other side over that of the side of v. */

#include "asperity/facet.h"
#include "asperity/fresnel.h"
#include "bsdf/bsdf.h"

#ifndef ASPI_REFRACTION_NAMES
#define ASPI_REFRACTION_NAMES
#define aspi_refract ASP_NAME(aspi_refract)
#define aspi_bent_half ASP_NAME(aspi_bent_half)
#define aspi_bent_density ASP_NAME(aspi_bent_density)
#define aspi_around ASP_NAME(aspi_around)
#define aspi_turned ASP_NAME(aspi_turned)
#define aspi_crossing_scale ASP_NAME(aspi_crossing_scale)
#define aspi_crossing_scales ASP_NAME(aspi_crossing_scales)
#define aspi_film_shares ASP_NAME(aspi_film_shares)
#define aspi_has_film ASP_NAME(aspi_has_film)
#define aspi_mean_share ASP_NAME(aspi_mean_share)
#define aspi_reflected_shares ASP_NAME(aspi_reflected_shares)
#define aspi_tinted ASP_NAME(aspi_tinted)
#endif

#if (ASP_PRECISION == 64 && !defined(ASPI_REFRACTION_64)) || \
    (ASP_PRECISION == 32 && !defined(ASPI_REFRACTION_32))
#if ASP_PRECISION == 64
#define ASPI_REFRACTION_64
#else
#define ASPI_REFRACTION_32
#endif

/* As seen from the side of `sign`: by a point reflection, or for a sheet by a mirror. */
ASP_FN asp_v3 aspi_turned(asp_v3 w, asp_real sign, int thin)
{
    asp_real across = thin ? R(1.0) : sign;
    w.x = across * w.x;
    w.y = across * w.y;
    w.z = sign * w.z;
    return w;
}

/* Whether what crosses is scaled: radiance is, but by sheets. */
ASP_FN int aspi_crossing_scales(int transport, asp_real thin) { return transport != ASP_IMPORTANCE && !(thin > R(0.0)); }

/* What crosses into the index eta is scaled so, where `scales` says that it is; from 1/eta. */
ASP_FN asp_real aspi_crossing_scale(asp_real inverse, int scales) { return scales ? inverse * inverse : R(1.0); }

ASP_FN int aspi_has_film(const asp_mat *mat) { return mat->fresnel == ASPI_FRESNEL_FILM; }

/* What a facet of a dielectric under a film reflects of each channel; in dielectric.c. */
void aspi_film_shares(const asp_mat *mat, asp_real c, asp_real eta, asp_real F[3]);

/* What a dielectric's facet reflects of each channel. */
ASP_FN void aspi_reflected_shares(const asp_mat *mat, int film, asp_real c, asp_real eta, asp_real F[3])
{
    if (film)
        aspi_film_shares(mat, c, eta, F);
    else
        F[0] = F[1] = F[2] = aspi_fresnel_dielectric(c, eta);
}

/* With what probability light is reflected: without a film the share of each channel. */
ASP_FN asp_real aspi_mean_share(int film, const asp_real F[3])
{
    return film ? (F[0] + F[1] + F[2]) * R(1.0 / 3.0) : F[0];
}

/* `by` what was chosen with the mean share's probability is worth in each channel: where it crosses, of the rest. */
ASP_FN asp_c3 aspi_tinted(int film, const asp_real F[3], asp_real mean, int crosses, asp_real by)
{
    asp_c3 out;
    out.r = out.g = out.b = by;
    if (film) {
        asp_real over = by / aspi_max(crosses ? R(1.0) - mean : mean, ASP_SMALLEST);
        out.r = (crosses ? R(1.0) - F[0] : F[0]) * over;
        out.g = (crosses ? R(1.0) - F[1] : F[1]) * over;
        out.b = (crosses ? R(1.0) - F[2] : F[2]) * over;
    }
    return out;
}

/* Where light that comes from v goes behind the facet m, v.m >= 0: a unit vector away from the surface
 * (Walter et al. 2007, eq. 40). Meaningless under total reflection, where F = 1. */
ASP_FN asp_v3 aspi_refract(asp_v3 v, asp_v3 m, asp_real eta)
{
    asp_real c = aspi_dot(v, m), inverse = R(1.0) / eta;
    /* 1 - (1 - c^2)/eta^2, kept from cancelling where eta is near 1 */
    asp_real g2 = ((eta - R(1.0)) * (eta + R(1.0)) + c * c) * (inverse * inverse);
    asp_real by = c * inverse - aspi_sqrt(g2 < R(0.0) ? R(0.0) : g2);
    m.x = by * m.x - inverse * v.x;
    m.y = by * m.y - inverse * v.y;
    m.z = by * m.z - inverse * v.z;
    return aspi_normalize(m);
}

/* The facet that refracts v into w, facing v: along -(v + eta w), turned so that v.m >= 0 (Walter et al.
 * 2007, eq. 16). Zero where v and w cannot be joined so. */
ASP_FN asp_v3 aspi_bent_half(asp_v3 v, asp_v3 w, asp_real eta)
{
    asp_v3 m;
    asp_real l2, scale, front, back;
    m.x = -(v.x + eta * w.x);
    m.y = -(v.y + eta * w.y);
    m.z = -(v.z + eta * w.z);
    l2 = aspi_dot(m, m);
    scale = R(1.0) / aspi_sqrt(l2 > R(0.0) ? l2 : R(1.0));
    front = aspi_dot(v, m);
    scale = front < R(0.0) ? -scale : scale;
    m.x = m.x * scale;
    m.y = m.y * scale;
    m.z = m.z * scale;
    back = aspi_dot(w, m);
    scale = back < R(0.0) && l2 > R(0.0) ? R(1.0) : R(0.0);
    m.x = m.x * scale;
    m.y = m.y * scale;
    m.z = m.z * scale;
    return m;
}

/* Solid angle of facets per solid angle of w: eta^2 |w.m| / (v.m + eta w.m)^2 (Walter et al. 2007,
 * eq. 17). */
ASP_FN asp_real aspi_bent_density(asp_real vm, asp_real wm, asp_real eta)
{
    asp_real over = vm + eta * wm, o2 = over * over;
    return eta * eta * aspi_abs(wm) / (o2 < ASP_SMALLEST ? ASP_SMALLEST : o2);
}

/* The local direction w, z along m, in the frame of m (Duff et al. 2017). */
ASP_FN asp_v3 aspi_around(asp_v3 m, asp_v3 w)
{
    asp_real sign = m.z < R(0.0) ? R(-1.0) : R(1.0);
    asp_real a = R(-1.0) / (sign + m.z), b = m.x * m.y * a;
    asp_v3 out;
    out.x = (R(1.0) + sign * m.x * m.x * a) * w.x + b * w.y + m.x * w.z;
    out.y = sign * b * w.x + (sign + m.y * m.y * a) * w.y + m.y * w.z;
    out.z = -sign * m.x * w.x - m.y * w.y + m.z * w.z;
    return out;
}
#endif
