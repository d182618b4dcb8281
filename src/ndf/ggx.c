/* ggx.c - GGX, Trowbridge-Reitz; the standard surface of the Ellipsoid NDF
 *
 * The standard surface is the upper unit hemisphere. Walter et al. 2007; Walter, Dong, Marschner,
 * Greenberg 2014; visible normals as spherical caps: Dupuy, Benyoub 2023. */
#ifndef ASP_PRECISION
#include "asperity_ndf.h"

#define ASP_NDF ggx
#define ASP_NDF_UP
#define ASP_NDF_DENSITY_OVER
#define ASP_PRECISION 64
#include "ggx.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "ggx.c"
#undef ASP_PRECISION

ASP_RECORD asp_model asp_model_ggx = {
    "ggx", "trowbridge_reitz", "GGX (Trowbridge-Reitz)",
    "Trowbridge, Reitz 1975; Walter et al. 2007",
    ASP_KEYS_SLOPE, 0.3, 0, 0, NULL, 0, NULL, ASP_NDF_OPS(ggx)
};

/* The same surface, its slope map given by the ellipsoid's matrix A. */
ASP_RECORD asp_model asp_model_ellipsoid = {
    "ellipsoid", NULL, "Ellipsoid NDF: GGX through the slope map of A",
    "Walter, Dong, Marschner, Greenberg 2014, eqs. 1-3",
    ASP_KEYS_ELLIPSOID, 0.3, 0, 0, NULL, 0, NULL, ASP_NDF_OPS(ggx)
};
#undef ASP_NDF_UP
#undef ASP_NDF_DENSITY_OVER
#undef ASP_NDF

#else
#include "asperity/facet.h"

/* P22 = 1 / (pi (1 + r^2/z^2)^2). */
ASP_FN asp_real ndf_density_over(const asp_shape *k, asp_real r2, asp_real z2)
{
    asp_real h = r2 + z2;
    (void)k;
    return R(ASP_PI) * (h * h);
}

ASP_FN asp_real ndf_density(const asp_shape *k, asp_real r2, asp_real z2)
{
    return R(1.0) / ndf_density_over(k, r2, z2);
}

/* Half the hemisphere's area seen from above is its own disc, half the turned disc: (|v| + w)/2
 * (Walter et al. 2014, eq. 6 with A = 1). Below the mean plane the sum would cancel. */
ASP_FN asp_real ndf_sigma_up(const asp_shape *k, asp_real w, asp_real s2)
{
    (void)k;
    return R(0.5) * (aspi_sqrt(s2 + w * w) + aspi_abs(w));
}

ASP_FN asp_real ndf_sigma(const asp_shape *k, asp_real w, asp_real s2)
{
    asp_real up = aspi_sqrt(s2 + w * w) + aspi_abs(w);
    (void)k;
    return R(0.5) * (w < R(0.0) ? s2 / aspi_max(up, R(1e-37)) : up);
}

/* The mirror image of v in the visible half of a sphere as large as v is uniform on the cap z > -v.z: the
 * normal is v plus a point of the cap. Written so that neither end cancels: with a = |v| + v.z the point's
 * height plus v.z is (1 - u1) a, and |v| minus its height is u1 a. First the horizontal part of v, a and |v|;
 * `up` for v.z >= 0. */
ASP_FN aspi_aimed ndf_aim_up(const asp_shape *k, asp_v3 v)
{
    aspi_aimed a;
    (void)k;
    a.x = v.x;
    a.y = v.y;
    a.w = aspi_sqrt(v.x * v.x + v.y * v.y + v.z * v.z);
    a.z = a.w + aspi_abs(v.z);
    return a;
}

ASP_FN aspi_aimed ndf_aim(const asp_shape *k, asp_v3 v)
{
    aspi_aimed a = ndf_aim_up(k, v);
    a.z = v.z < R(0.0) ? aspi_length2(v) / aspi_max(a.z, R(1e-37)) : a.z;
    return a;
}

ASP_FN void ndf_aim_below(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT wx,
                      const asp_real *ASP_RESTRICT wy, const asp_real *ASP_RESTRICT wz,
                      asp_real *ASP_RESTRICT sigma, asp_real *ASP_RESTRICT z)
{
    size_t i;
    for (i = 0; i < n; i++) {
        z[i] = ndf_aim(k, aspi_view(k, aspi_vector(wx[i], wy[i], wz[i]))).z;
        sigma[i] = R(0.5) * z[i];
    }
}

ASP_FN asp_v3 ndf_aimed(const asp_shape *k, aspi_aimed a, asp_real u1, asp_real u2)
{
    asp_real d = u1 * a.z;
    asp_real r = aspi_sqrt(d * (R(2.0) * a.w - d));
    asp_v2 t = aspi_sincos2pi(u2);
    asp_v3 m;
    (void)k;
    m.x = r * t.x + a.x;
    m.y = r * t.y + a.y;
    m.z = (R(1.0) - u1) * a.z;
    return m;
}

/* tan^2 = u1 / (1 - u1) (Walter et al. 2007, eq. 35). */
ASP_FN asp_v3 ndf_normal(const asp_shape *k, asp_real u1, asp_real u2)
{
    asp_real r = aspi_sqrt(u1);
    asp_v2 t = aspi_sincos2pi(u2);
    asp_v3 m;
    (void)k;
    m.x = r * t.x;
    m.y = r * t.y;
    m.z = aspi_sqrt(R(1.0) - u1);
    return m;
}

/* Above the mean plane, where the directions of a block mostly are, there is nothing to divide. */
ASP_CLONES static void ndf_sigma_n(const asp_shape *k, size_t n, asp_real sign, const asp_real *ASP_RESTRICT wx,
                                   const asp_real *ASP_RESTRICT wy, const asp_real *ASP_RESTRICT wz,
                                   asp_real *ASP_RESTRICT out)
{
    asp_bits below = 0;
    size_t i;
    for (i = 0; i < n; i++)
        below |= aspi_to_bits(aspi_view(k, aspi_vector(sign * wx[i], sign * wy[i], sign * wz[i])).z);
    if (below >> (8 * sizeof below - 1)) {
        for (i = 0; i < n; i++) {
            asp_v3 v = aspi_view(k, aspi_vector(sign * wx[i], sign * wy[i], sign * wz[i]));
            out[i] = ndf_sigma(k, v.z, aspi_length2(v));
        }
        return;
    }
    for (i = 0; i < n; i++) {
        asp_v3 v = aspi_view(k, aspi_vector(sign * wx[i], sign * wy[i], sign * wz[i]));
        out[i] = ndf_sigma_up(k, v.z, aspi_length2(v));
    }
}

#define ASP_OWN_SIGMA_N
#include "asperity/ndf_loops.h"
#endif
