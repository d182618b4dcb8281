/* sggx.c - SGGX microflakes: the ellipsoid's normals over the full sphere
 *
 * Heitz, Dupuy, Crassin, Dachsbacher 2015, with the notation of Walter et al. 2014, section 5.2: S = A^T A,
 * A upper triangular. Read three times: this head makes values, the body evaluates in each precision. */
#ifndef ASP_PRECISION
#include "asperity_study.h"

#include <math.h>

static int sggx_bad(double x) { return !(x > 1e-100 && x < 1e100); }

/* A = Q R by Gram and Schmidt on its columns, once more for what rounding left: R has the same R^T R. */
asp_status asp_sggx_from_matrix(const double A[9], asp_sggx *out, asp_error *err)
{
    double q[3][3], r[3][3] = { { 0 } };
    int i, j, k, again;
    for (j = 0; j < 3; j++) {
        double length, before = 0;
        for (k = 0; k < 3; k++) {
            q[j][k] = A[3 * k + j];
            before += q[j][k] * q[j][k];
        }
        if (sggx_bad(sqrt(before)))
            return asp_fail(err, ASP_EINVAL, "A", "a column is shorter than 1e-100 or longer than 1e100");
        for (again = 0; again < 2; again++)
            for (i = 0; i < j; i++) {
                double d = q[i][0] * q[j][0] + q[i][1] * q[j][1] + q[i][2] * q[j][2];
                r[i][j] += d;
                for (k = 0; k < 3; k++)
                    q[j][k] -= d * q[i][k];
            }
        length = sqrt(q[j][0] * q[j][0] + q[j][1] * q[j][1] + q[j][2] * q[j][2]);
        if (!(length > 1e-12 * sqrt(before)))
            return asp_fail(err, ASP_EINVAL, "A", "not invertible: its columns are dependent");
        r[j][j] = length;
        for (k = 0; k < 3; k++)
            q[j][k] /= length;
    }
    out->a11 = r[0][0];
    out->a12 = r[0][1];
    out->a13 = r[0][2];
    out->a22 = r[1][1];
    out->a23 = r[1][2];
    out->a33 = r[2][2];
    return ASP_OK;
}

/* Cholesky: S = A^T A. */
asp_status asp_sggx_from_gram(const double S[9], asp_sggx *out, asp_error *err)
{
    asp_sggx a;
    double d22, d33;
    if (!(S[1] == S[3] && S[2] == S[6] && S[5] == S[7]))
        return asp_fail(err, ASP_EINVAL, "S", "not symmetric");
    if (sggx_bad(S[0]) || sggx_bad(S[4]) || sggx_bad(S[8]))
        return asp_fail(err, ASP_EINVAL, "S", "a diagonal entry is outside [1e-100, 1e100]");
    a.a11 = sqrt(S[0]);
    a.a12 = S[1] / a.a11;
    a.a13 = S[2] / a.a11;
    d22 = S[4] - a.a12 * a.a12;
    if (!(d22 > 1e-15 * S[4]))
        return asp_fail(err, ASP_EINVAL, "S", "not positive definite");
    a.a22 = sqrt(d22);
    a.a23 = (S[5] - a.a12 * a.a13) / a.a22;
    d33 = S[8] - a.a13 * a.a13 - a.a23 * a.a23;
    if (!(d33 > 1e-15 * S[8]))
        return asp_fail(err, ASP_EINVAL, "S", "not positive definite");
    a.a33 = sqrt(d33);
    *out = a;
    return ASP_OK;
}

/* A = across 1 + (along - across) n n^T, which is symmetric: sigma(n) = along, sigma of what is across n =
 * across. */
asp_status asp_sggx_from_axis(asp_vec3 axis, double along, double across, asp_sggx *out, asp_error *err)
{
    double n[3] = { axis.x, axis.y, axis.z }, A[9], length;
    int i, j;
    length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (sggx_bad(length))
        return asp_fail(err, ASP_EINVAL, "axis", "its length is outside [1e-100, 1e100]");
    if (!(along >= 1e-6 && along <= 1e6))
        return asp_fail_range(err, "along", along, 1e-6, 0, 1e6);
    if (!(across >= 1e-6 && across <= 1e6))
        return asp_fail_range(err, "across", across, 1e-6, 0, 1e6);
    for (i = 0; i < 3; i++)
        for (j = 0; j < 3; j++)
            A[3 * i + j] = (i == j ? across : 0) + (along - across) * (n[i] / length) * (n[j] / length);
    return asp_sggx_from_matrix(A, out, err);
}

void asp_sggx_to_gram(const asp_sggx *k, double S[9])
{
    S[0] = k->a11 * k->a11;
    S[1] = S[3] = k->a11 * k->a12;
    S[2] = S[6] = k->a11 * k->a13;
    S[4] = k->a12 * k->a12 + k->a22 * k->a22;
    S[5] = S[7] = k->a12 * k->a13 + k->a22 * k->a23;
    S[8] = k->a13 * k->a13 + k->a23 * k->a23 + k->a33 * k->a33;
}

asp_sggxf asp_sggx_narrow(const asp_sggx *k)
{
    asp_sggxf f;
    f.a11 = (float)k->a11;
    f.a12 = (float)k->a12;
    f.a13 = (float)k->a13;
    f.a22 = (float)k->a22;
    f.a23 = (float)k->a23;
    f.a33 = (float)k->a33;
    return f;
}

#define ASP_PRECISION 64
#include "sggx.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "sggx.c"
#undef ASP_PRECISION

#else
#include "core/blocks.h"

#ifndef SGGX_NAMES
#define SGGX_NAMES
#define SGGX_VALUE_64 asp_sggx
#define SGGX_VALUE_32 asp_sggxf
#define SGGX_VALUE ASP_NAME(SGGX_VALUE)
#define sggx_apply ASP_NAME(sggx_apply)
#define sggx_density ASP_NAME(sggx_density)
#define sggx_area ASP_NAME(sggx_area)
#define sggx_visible_density ASP_NAME(sggx_visible_density)
#define sggx_visible ASP_NAME(sggx_visible)
#define sggx_loop_density ASP_NAME(sggx_loop_density)
#define sggx_loop_area ASP_NAME(sggx_loop_area)
#define sggx_loop_visible_density ASP_NAME(sggx_loop_visible_density)
#define sggx_loop_visible ASP_NAME(sggx_loop_visible)
#endif

/* A w: the view in the space where the flakes are those of a sphere. */
ASP_FN asp_v3 sggx_apply(const SGGX_VALUE *k, asp_v3 w)
{
    return aspi_vector((k->a11 * w.x + k->a12 * w.y) + k->a13 * w.z, k->a22 * w.y + k->a23 * w.z,
                       k->a33 * w.z);
}

/* 1 / (pi |A| |A^-T m|^4), Walter et al. eq. 1 without ||A n|| and without a horizon. */
ASP_FN asp_real sggx_density(const SGGX_VALUE *k, asp_v3 m)
{
    asp_real x = m.x / k->a11;
    asp_real y = (m.y - k->a12 * x) / k->a22;
    asp_real z = (m.z - k->a13 * x - k->a23 * y) / k->a33;
    asp_real l2 = x * x + y * y + z * z;
    return aspi_finite(R(1.0 / ASP_PI) / (k->a11 * k->a22 * k->a33) / (l2 * l2));
}

/* sqrt(w^T S w) = |A w| (eq. 26 with C_e^2 = |A|/pi). */
ASP_FN asp_real sggx_area(const SGGX_VALUE *k, asp_v3 w)
{
    asp_v3 a = sggx_apply(k, w);
    return aspi_sqrt(aspi_dot(a, a));
}

ASP_FN asp_real sggx_visible_density(const SGGX_VALUE *k, asp_v3 wi, asp_v3 m)
{
    asp_real c = aspi_dot(wi, m);
    asp_real p = aspi_finite(c * sggx_density(k, m) / sggx_area(k, wi));
    return c <= R(0.0) ? R(0.0) : p;
}

/* Rays along A wi hit the sphere uniformly over its disk: p there, m = A^T p. The disk's frame is Duff et
 * al.'s (2017). */
ASP_FN asp_v3 sggx_visible(const SGGX_VALUE *k, asp_v3 wi, asp_real u1, asp_real u2)
{
    asp_v3 e = aspi_normalize(sggx_apply(k, wi)), p;
    asp_real sign = e.z < R(0.0) ? R(-1.0) : R(1.0);
    asp_real a = R(-1.0) / (sign + e.z), b = e.x * e.y * a;
    asp_real r = aspi_sqrt(u1), h = aspi_sqrt(aspi_max(R(1.0) - u1, R(0.0)));
    asp_v2 t = aspi_sincos2pi(u2);
    asp_real x = r * t.x, y = r * t.y;
    p.x = x * (R(1.0) + sign * e.x * e.x * a) + y * b + h * e.x;
    p.y = x * (sign * b) + y * (sign + e.y * e.y * a) + h * e.y;
    p.z = h * e.z - x * (sign * e.x) - y * e.y;
    return aspi_normalize(aspi_vector(k->a11 * p.x, k->a12 * p.x + k->a22 * p.y,
                                      (k->a13 * p.x + k->a23 * p.y) + k->a33 * p.z));
}

/* ---- single calls */

asp_real ASPI_CALL(asp_sggx_D)(const SGGX_VALUE *k, asp_v3 m) { return sggx_density(k, m); }

asp_real ASPI_CALL(asp_sggx_sigma)(const SGGX_VALUE *k, asp_v3 w) { return sggx_area(k, w); }

asp_real ASPI_CALL(asp_sggx_pdf_visible)(const SGGX_VALUE *k, asp_v3 wi, asp_v3 m)
{
    return sggx_visible_density(k, wi, m);
}

asp_v3 ASPI_CALL(asp_sggx_sample_visible)(const SGGX_VALUE *k, asp_v3 wi, asp_real u1, asp_real u2)
{
    return sggx_visible(k, wi, u1, u2);
}

/* ---- loops: the outputs may be inputs, an element is read before it is written */

ASP_CLONES static void sggx_loop_density(SGGX_VALUE k, size_t n, asp_cv3s m, asp_real *out)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++)
        out[i] = sggx_density(&k, aspi_at(m.x, m.y, m.z, i));
}

ASP_CLONES static void sggx_loop_area(SGGX_VALUE k, size_t n, asp_cv3s w, asp_real *out)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++)
        out[i] = sggx_area(&k, aspi_at(w.x, w.y, w.z, i));
}

ASP_CLONES static void sggx_loop_visible_density(SGGX_VALUE k, size_t n, asp_cv3s wi,
                                                 asp_cv3s m, asp_real *out)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++)
        out[i] = sggx_visible_density(&k, aspi_at(wi.x, wi.y, wi.z, i), aspi_at(m.x, m.y, m.z, i));
}

ASP_CLONES static void sggx_loop_visible(SGGX_VALUE k, size_t n, asp_cv3s wi, const asp_real *u1,
                                         const asp_real *u2, asp_v3s m)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_v3 v = sggx_visible(&k, aspi_at(wi.x, wi.y, wi.z, i), u1[i], u2[i]);
        m.x[i] = v.x;
        m.y[i] = v.y;
        m.z[i] = v.z;
    }
}

void ASPI_CALL(asp_sggx_D_n)(const SGGX_VALUE *k, size_t n, asp_cv3s m, asp_real *out)
{
    sggx_loop_density(*k, n, m, out);
}

void ASPI_CALL(asp_sggx_sigma_n)(const SGGX_VALUE *k, size_t n, asp_cv3s w, asp_real *out)
{
    sggx_loop_area(*k, n, w, out);
}

void ASPI_CALL(asp_sggx_pdf_visible_n)(const SGGX_VALUE *k, size_t n, asp_cv3s wi, asp_cv3s m, asp_real *out)
{
    sggx_loop_visible_density(*k, n, wi, m, out);
}

void ASPI_CALL(asp_sggx_sample_visible_n)(const SGGX_VALUE *k, size_t n, asp_cv3s wi, const asp_real *u1,
                                          const asp_real *u2, asp_v3s m)
{
    sggx_loop_visible(*k, n, wi, u1, u2, m);
}
#endif
