/* student_kernel.h - the formulas of the Student-t family
 *
 * Read once per precision by a distribution's file, which defines STUDENT_GAUSSIAN: 1 where n is
 * infinite (Beckmann), so that powers become exponentials and n disappears. student.h says what the
 * table holds. */

#include "asperity/facet.h"
#include "patches.h"

#ifndef STUDENT_KERNEL_NAMES
#define STUDENT_KERNEL_NAMES
#define student_decay ASP_NDF_NAME(_decay)
#define student_p ASP_NDF_NAME(_p)
#define student_b ASP_NDF_NAME(_b)
#define student_point ASP_NDF_NAME(_point)
#define student_across ASP_NDF_NAME(_across)
#define student_quantile ASP_NDF_NAME(_quantile)
#define student_search ASP_NDF_NAME(_search)
#define student_rough_log ASP_NDF_NAME(_rough_log)
#define student_start ASP_NDF_NAME(_start)
#define student_step ASP_NDF_NAME(_step)
#define student_sigma ASP_NDF_NAME(_sigma_by_power)
#define student_above_denominator ASP_NDF_NAME(_above_denominator)
#define student_above ASP_NDF_NAME(_above)
/* Polynomial of an even number of coefficients c[first ...]: even and odd powers apart, which halves
 * the chain of dependent operations. Between START and END go the steps, highest first. */
#define STUDENT_START(t, c, last) \
    asp_real t2 = (t) * (t), even = (c)[(last) - 1], odd = (c)[last];
#define STUDENT_STEP(c, i) \
    even = even * t2 + (c)[i]; \
    odd = odd * t2 + (c)[(i) + 1];
#define STUDENT_STEP5(c, i) \
    STUDENT_STEP(c, (i) + 8) STUDENT_STEP(c, (i) + 6) STUDENT_STEP(c, (i) + 4) \
    STUDENT_STEP(c, (i) + 2) STUDENT_STEP(c, i)
#endif

/* (1 + x/n)^-p with p = table[power]; e^-x for the Gaussian, where p is not used. In float32 the
 * relative error is that of x and p times the exponent, as of every power. */
ASP_FN asp_real student_decay(const asp_shape *k, int power, asp_real x)
{
#if STUDENT_GAUSSIAN
    (void)k;
    (void)power;
    return aspi_exp(-x);
#else
    return aspi_exp(-(k->table[power] * aspi_log1p(x * k->table[STUDENT_INVN])));
#endif
}

/* P at d, as 1 - (1 - d) times a polynomial: exact at d = 1, the edge-on view. */
ASP_FN asp_real student_p(const asp_shape *k, asp_real d)
{
    asp_real t = d * k->table[STUDENT_SCALE] + k->table[STUDENT_OFFSET];
#if ASP_PRECISION == 64
    const asp_real *c = k->table + STUDENT_P64;
    STUDENT_START(t, c, 23)
    STUDENT_STEP(c, 20)
    STUDENT_STEP5(c, 10)
    STUDENT_STEP5(c, 0)
#else
    const asp_real *c = k->table + STUDENT_P32;
    STUDENT_START(t, c, 11)
    STUDENT_STEP5(c, 0)
#endif
    return R(1.0) - (R(1.0) - d) * (odd * t + even);
}

/* sigma = max(w, 0) + s J(|w|/s), J as in student.h. With g^2 = s2 + w^2/n all is homogeneous.
 * Relative error 4e-15 (float64) and 1e-6 (float32, w >= 0). Below the mean plane only the tail is
 * left, and float32 answers within 1e-6 + 2e-7 E, E = n log(1 + w^2/(n s2)): a rounding error of w or
 * s2 by itself changes the tail by E times as much, so that more digits would not be worth their
 * time. 0 where e^-E is below e^-87. */
ASP_FN asp_real student_sigma(const asp_shape *k, asp_real w, asp_real s2)
{
    asp_real h = aspi_abs(w), w2 = w * w;
    asp_real den = aspi_max(s2, ASP_PRECISION == 64 ? R(1e-200) : R(1e-24));
    asp_real g = aspi_sqrt(STUDENT_GAUSSIAN ? den : den + w2 * k->table[STUDENT_INVN]);
    asp_real ag = R(STUDENT_A) * g;
    /* two divisions: one for both would make the power wait for the root */
    asp_real d = ag / (h + ag), r = R(1.0) / den;
    asp_real tail = student_decay(k, STUDENT_N, w2 * r) * (d * d) * student_p(k, d)
                  * (g * k->table[STUDENT_M0]);
    return aspi_max(w, R(0.0)) + (s2 > R(0.0) ? tail : R(0.0));
}

#if ASP_PRECISION == 32
/* sigma for w >= 0 without a power, where student_tables.c found a polynomial: with the denominator
 * a w + sqrt(b w^2 + k s2) and x = w over it, w + (denominator - w) (at_0 + x Q(x)): exact at s = 0 and
 * at w = 0. Relative error 5e-7. */
ASP_FN asp_real student_above_denominator(const asp_shape *k, asp_real w, asp_real s2)
{
    const asp_real *form = k->table + STUDENT_LINEAR;
    return form[0] * w + aspi_sqrt(aspi_max(form[1] * (w * w) + form[2] * s2, R(1e-36)));
}

ASP_FN asp_real student_above(const asp_shape *k, asp_real w, asp_real den, asp_real x)
{
    const asp_real *c = k->table + STUDENT_S32 + 1;
    asp_real t = (x + x) - R(1.0);
    STUDENT_START(t, c, 17)
    STUDENT_STEP(c, 14)
    STUDENT_STEP(c, 12)
    STUDENT_STEP(c, 10)
    STUDENT_STEP5(c, 0)
    return w + (den - w) * (k->table[STUDENT_S32] + x * (odd * t + even));
}
#endif

ASP_FN asp_real ndf_sigma(const asp_shape *k, asp_real w, asp_real s2)
{
#if ASP_PRECISION == 32
    if (w >= R(0.0) && k->table[STUDENT_ABOVE] > R(0.0)) {
        asp_real den = student_above_denominator(k, w, s2);
        return student_above(k, w, den, w / den);
    }
#endif
    return student_sigma(k, w, s2);
}

/* B at d. */
ASP_FN asp_real student_b(const asp_shape *k, asp_real d)
{
    asp_real t = d * k->table[STUDENT_SCALE] + k->table[STUDENT_OFFSET];
#if ASP_PRECISION == 64
    const asp_real *c = k->table + STUDENT_B64;
    STUDENT_START(t, c, 23)
    STUDENT_STEP(c, 20)
    STUDENT_STEP5(c, 10)
    STUDENT_STEP5(c, 0)
#else
    const asp_real *c = k->table + STUDENT_B32;
    STUDENT_START(t, c, 11)
    STUDENT_STEP5(c, 0)
#endif
    return odd * t + even;
}

/* The point x of an axis given by q = n log(1 + x^2/n) (x^2 for the Gaussian), as .x / .y: x and 1
 * over g. */
ASP_FN asp_v2 student_point(asp_real q, asp_real n, asp_real invn)
{
    asp_v2 out;
#if STUDENT_GAUSSIAN
    (void)n;
    (void)invn;
    out.x = aspi_sqrt(q);
    out.y = R(1.0);
#else
    asp_v2 w = aspi_exp_both(R(-0.5) * q * invn);
    out.x = aspi_sqrt(n * (-w.y * (R(1.0) + w.x)));
    out.y = w.x;
#endif
    return out;
}

/* The slope across the view, given the slope x along it, is sqrt(n + x^2) times a t-quantile of u. float32 has
 * that times sqrt n in a table; float64 first its q = m log(1 + y^2/m), then the homogeneous point of
 * student_point. u = 1/2 gives 0. */
#if ASP_PRECISION == 64
ASP_FN asp_real student_quantile(const asp_shape *k, asp_real u)
{
    const asp_real *c = k->table + STUDENT_Y64;
    asp_real v = aspi_max(aspi_min(u, R(1.0) - u), R(STUDENT_LEAST_64));
    asp_real h = R(1.0) - (v + v);
    asp_real l = -aspi_log_near(R(4.0) * v * (R(1.0) - v), -h * h);
    asp_real t = R(2.0 / STUDENT_Y_END_64) * l / (l + R(STUDENT_Y_K)) - R(1.0);
    STUDENT_START(t, c, 25)
    STUDENT_STEP(c, 22)
    STUDENT_STEP(c, 20)
    STUDENT_STEP5(c, 10)
    STUDENT_STEP5(c, 0)
    even = odd * t + even;
    return l * (even * even);
}
#else
ASP_FN asp_real student_quantile(const asp_shape *k, asp_real u)
{
    return aspi_octaves(k->table + STUDENT_ACROSS, u);
}
#endif

/* Of the slope across, in homogeneous form. */
ASP_FN asp_v2 student_across(const asp_shape *k, asp_real q, asp_real u)
{
    asp_v2 p;
#if ASP_PRECISION == 64
    p = student_point(q, k->table[STUDENT_Y_N], k->table[STUDENT_Y_N + 1]);
    p.x *= k->table[STUDENT_Y_WIDTH];
#else
    (void)k;
    p.x = q;
    p.y = R(1.0);
#endif
    p.x = u > R(0.5) ? -p.x : p.x;
    return p;
}

/* r^2 = n ((1 - u1)^(-1/n) - 1) (eq. 16), in homogeneous form: with e = log(1 - u1), the height is
 * exp(e/(2n)) and the length sqrt n sqrt(1 - height^2). */
ASP_FN asp_v3 ndf_normal(const asp_shape *k, asp_real u1, asp_real u2)
{
    asp_real u = aspi_min(u1, ASP_PRECISION == 64 ? R(1.0 - 0x1p-53) : R(1.0 - 0x1p-24));
    asp_v2 p = student_point(-aspi_log1p(-u), STUDENT_GAUSSIAN ? R(1.0) : k->table[STUDENT_N],
                             k->table[STUDENT_INVN]);
    asp_v2 t = aspi_sincos2pi(u2);
    asp_v3 m;
    m.x = p.x * t.x;
    m.y = p.x * t.y;
    m.z = p.y;
    return m;
}

#include "student_density.h"
#include "student_search.h"
#include "student_visible.h"
