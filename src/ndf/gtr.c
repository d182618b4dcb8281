/* gtr.c - Generalised Trowbridge-Reitz
 *
 * Burley 2012; Ribardiere et al. 2017, eq. 8; Hoffman's notebook, 2013, Out[64]-[69].
 * D is a power of b = sin^2 + alpha^2 cos^2, and b is distributed over [alpha^2, 1] (or [1, alpha^2])
 * with density b^-gamma. Everything is written from the smaller end of that range, where D is
 * largest: with B = b/smallest, L = log of the range's ratio and kappa = e^L - 1
 *
 *     D = D_max B^-gamma,   D_max = kappa/L  Y/(1 - e^-Y) / pi,   Y = (gamma - 1) L
 *
 * so that neither gamma = 1 nor alpha = 1 is a special case (only 0/0, which a least L and Y avoid),
 * and no power overflows. gamma = 2 is GGX, alpha = 1 the sphere. */
#ifndef ASP_PRECISION
#include "asperity_ndf.h"
#include "ndf/prepared.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"
#undef ASP_PRECISION

/* In `table`: B = 1 + (GTR_R2 r2 + GTR_Z2 z2)/(r2 + z2), one of the two 0. */
enum { GTR_R2, GTR_Z2, GTR_ONE_R2, GTR_ONE_Z2, GTR_MAX, GTR_INV_KAPPA, GTR_UNIT, GTR_WHOLE, GTR_LOW, GTR_HIGH,
       GTR_LESS, GTR_FLIP, GTR_STEEP };

static const asp_param gtr_params[] = {
    { "alpha", 1e-3, 0, 4, 0.3, "roughness; 1 the sphere" },
    { "gamma", 0, 1, 1e4, 1.5, "tails: 1 Berry, 2 GGX" }
};

#define ASP_NDF gtr
#define ASP_PRECISION 64
#include "gtr.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "gtr.c"
#undef ASP_PRECISION

/* P22 = D cos^4. */
ASP_CLONES static void gtr_log_density(const asp_ndf *k, size_t n, const double *ASP_RESTRICT r2,
                                       double *ASP_RESTRICT out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = -gtr_exponent_64(k, r2[i], 1) - 2 * aspi_log1p_64(r2[i]);
}

static asp_status gtr_prepare(asp_ndf *out, asp_error *err)
{
    double alpha = out->shape[0], gamma = out->shape[1], *t = out->table;
    double spread = (alpha - 1) * (alpha + 1), rough = spread > 0, kappa, L, Y;
    kappa = rough ? spread : -spread / (alpha * alpha);
    t[GTR_R2] = rough ? 0 : kappa;
    t[GTR_Z2] = rough ? kappa : 0;
    t[GTR_ONE_R2] = 1 + t[GTR_R2];
    t[GTR_ONE_Z2] = 1 + t[GTR_Z2];
    kappa = kappa > 1e-17 ? kappa : 1e-17;
    L = aspi_log1p_64(kappa);
    Y = (gamma - 1) * L;
    Y = Y < 1e-17 && Y > -1e-17 ? 1e-17 : Y;
    t[GTR_MAX] = kappa / L * (Y / -aspi_expm1_64(-Y)) / ASP_PI;
    t[GTR_INV_KAPPA] = 1 / kappa;
    t[GTR_UNIT] = L / Y;
    t[GTR_WHOLE] = L;
    t[GTR_LOW] = aspi_expm1_64(-Y);
    t[GTR_STEEP] = Y > 60;
    t[GTR_HIGH] = aspi_expm1_64(Y < 60 ? Y : 60);
    t[GTR_LESS] = -1 / aspi_expm1_64(-L);
    t[GTR_FLIP] = rough;
    return aspi_prepared_make(out, gtr_log_density, err);
}

ASP_RECORD asp_model asp_model_gtr = {
    "gtr", NULL, "Generalised Trowbridge-Reitz (GTR)",
    "Burley 2012; Ribardiere et al. 2017, eq. 8",
    ASP_KEYS_SLOPE, 1, 1, 6e-6, gtr_params, 2, gtr_prepare, ASP_NDF_OPS(gtr)
};
#undef ASP_NDF

#else
#include "asperity/elementary.h"

#define exponent ASP_NDF_NAME(_exponent)

/* D = D_max B^-gamma. */
ASP_FN asp_real exponent(const asp_shape *k, asp_real r2, asp_real z2)
{
    const asp_real *t = k->table;
    asp_real h = r2 + z2;
    asp_real b = (t[GTR_ONE_R2] * r2 + t[GTR_ONE_Z2] * z2) / h;
    asp_real less = (t[GTR_R2] * r2 + t[GTR_Z2] * z2) / h;
    return k->shape[1] * aspi_log_near(b, less);
}

ASP_FN asp_real ndf_density(const asp_shape *k, asp_real r2, asp_real z2)
{
    asp_real h = r2 + z2, d = aspi_exp(R(-0.5) * exponent(k, r2, z2));
    return d * k->table[GTR_MAX] * d / (h * h);       /* its square alone may underflow where D does not */
}
#undef exponent

/* B^(1 - gamma) is uniform between its ends: with u = 0 at B = 1 and l = log B,
 * l = L log(1 + u (e^-Y - 1)) / -Y, and from the other end L - l = L log(1 + (1 - u)(e^Y - 1)) / Y.
 * The share of sin^2 (alpha < 1) or cos^2 is (B - 1)/kappa, the other's (1 - B e^-L)/(1 - e^-L). */
ASP_FN asp_v3 ndf_normal(const asp_shape *k, asp_real u1, asp_real u2)
{
    const asp_real *t = k->table;
    int flip = t[GTR_FLIP] > R(0.5), steep = t[GTR_STEEP] > R(0.5);
    asp_real u = flip ? R(1.0) - u1 : u1, v = flip ? u1 : R(1.0) - u1;
    asp_real l = aspi_min(-t[GTR_UNIT] * aspi_log1p(u * t[GTR_LOW]), t[GTR_WHOLE]);
    asp_real far = t[GTR_UNIT] * aspi_log1p(v * t[GTR_HIGH]);
    /* for Y > 60 no u leads near the other end */
    asp_real rest = steep ? t[GTR_WHOLE] - l : far;
    /* 0 + keeps a zero positive: WASM's maximum tells -0 from 0 */
    asp_real a = aspi_sqrt(R(0.0) + aspi_max(aspi_expm1(l) * t[GTR_INV_KAPPA], R(0.0)));
    asp_real b = aspi_sqrt(R(0.0) + aspi_max(-aspi_expm1(-rest) * t[GTR_LESS], R(0.0)));
    asp_v2 phi = aspi_sincos2pi(u2);
    asp_real s = flip ? b : a;
    asp_v3 m;
    m.x = s * phi.x;
    m.y = s * phi.y;
    m.z = flip ? a : b;
    return m;
}

#define ASP_OWN_NORMAL
#include "prepared_kernel.h"
#include "asperity/ndf_loops.h"
#undef ASP_OWN_NORMAL
#endif
