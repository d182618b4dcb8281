/* student_kernel.h - the formulas of the Student-t family
 *
 * Read once per precision by a distribution's file, which defines STUDENT_GAUSSIAN: 1 where n is
 * infinite (Beckmann), so that powers become exponentials and n disappears. student.h says what the
 * table holds. */

#ifndef STUDENT_KERNEL_NAMES
#define STUDENT_KERNEL_NAMES
#define student_decay ASP_NDF_NAME(_decay)
#define student_p ASP_NDF_NAME(_p)
#define student_b ASP_NDF_NAME(_b)
#define student_point ASP_NDF_NAME(_point)
#define student_side ASP_NDF_NAME(_side)
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

/* (1 + invn (a + a_low) / den)^-p with p = table[power]; e^-(a + a_low)/den for the Gaussian, where
 * p is not used. a >= 0, |a_low| below an ulp of a, den > 0. In float32 the exponent, which may
 * reach 87, is carried in two numbers from the quotient on: its own rounding errors would come out
 * magnified by the exponent. */
ASP_FN asp_real student_decay(const asp_shape *k, int power, asp_real a, asp_real a_low,
                              asp_real den)
{
#if ASP_PRECISION == 64
    asp_real e = a / den;
    (void)a_low;
    (void)power;
#if !STUDENT_GAUSSIAN
    e = k->table[power] * aspi_log1p(e * k->table[STUDENT_INVN]);
#else
    (void)k;
#endif
    return aspi_exp(-e);
#else
    asp_real r = R(1.0) / den;
#if STUDENT_GAUSSIAN
    asp_real y = a * r;
    asp_real y_low = (a_low - aspi_product_error(y, den, a)) * r;
    (void)k;
    (void)power;
    return aspi_exp_less(-y, y_low);
#else
    /* a/n exactly */
    asp_real ah = aspi_high(a), al = (a - ah) + a_low;
    asp_real nh = k->table[STUDENT_INVN + 1], nl = k->table[STUDENT_INVN + 2];
    asp_real main = ah * nh, rest = ah * nl + al * k->table[STUDENT_INVN];
    asp_real b = main + rest;
    asp_real b_low = rest - (b - main);
    /* y = b/den */
    asp_real y = b * r;
    asp_real y_low = (b_low - aspi_product_error(y, den, b)) * r;
    asp_v2 l = aspi_log1p_sum(y, y_low);
    /* p l */
    asp_real lh = aspi_high(l.x), ll = (l.x - lh) + l.y;
    asp_real e = lh * k->table[power + 1];
    asp_real e_low = ll * k->table[power] + lh * k->table[power + 2];
    return aspi_exp_less(-e, e_low);
#endif
#endif
}

/* P at d, relative error 3e-8 and 1e-13 beside rounding. */
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
    STUDENT_START(t, c, 13)
    STUDENT_STEP(c, 10)
    STUDENT_STEP5(c, 0)
#endif
    return odd * t + even;
}

/* Density of normals: (1 + r2/(n z2))^-gamma / (pi z2^2) (Ribardiere et al. 2017, eqs. 5-6).
 * z2 below 1e-18 (float32) or 1e-150 counts as that. */
ASP_FN asp_real ndf_density(const asp_shape *k, asp_real r2, asp_real z2)
{
    asp_real z = aspi_max(z2, ASP_PRECISION == 64 ? R(1e-150) : R(1e-18));
    return student_decay(k, STUDENT_GAMMA, r2, R(0.0), z) * (R(1.0 / ASP_PI) / (z * z));
}

/* sigma = max(w, 0) + s J(|w|/s), J as in student.h. With g2 = s2 + w^2/n all is homogeneous. */
ASP_FN asp_real ndf_sigma(const asp_shape *k, asp_real w, asp_real s2)
{
    asp_real h = aspi_abs(w);
    asp_real w2 = w * w;
    asp_real den = aspi_max(s2, ASP_PRECISION == 64 ? R(1e-290) : R(1e-24));
    asp_real g = aspi_sqrt(STUDENT_GAUSSIAN ? s2 : s2 + w2 * k->table[STUDENT_INVN]);
    asp_real ag = R(STUDENT_A) * g;
    asp_real d = ag / aspi_max(h + ag, R(1e-37));
    asp_real low = ASP_PRECISION == 64 ? R(0.0) : aspi_product_error(w, w, w2);
    asp_real tail = student_decay(k, STUDENT_N, w2, low, den) * (d * d) * student_p(k, d)
                  * (g * k->table[STUDENT_M0]);
    return aspi_max(w, R(0.0)) + (s2 > R(0.0) ? tail : R(0.0));
}

/* B at d from the coefficients at `first`, which lie 12 apart of float64's. */
ASP_FN asp_real student_b(const asp_shape *k, int first32, int first64, asp_real t)
{
#if ASP_PRECISION == 64
    const asp_real *c = k->table + first64;
    STUDENT_START(t, c, 23)
    (void)first32;
    STUDENT_STEP(c, 20)
    STUDENT_STEP5(c, 10)
    STUDENT_STEP5(c, 0)
#else
    const asp_real *c = k->table + first32;
    STUDENT_START(t, c, 11)
    (void)first64;
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
    asp_real m = aspi_expm1(R(-0.5) * q * invn);
    out.x = aspi_sqrt(n * (-m * (R(2.0) + m)));
    out.y = R(1.0) + m;
#endif
    return out;
}

ASP_FN asp_real student_side(const asp_shape *k, asp_real q, asp_v2 p)
{
    asp_real d = R(STUDENT_A) / (R(STUDENT_A) + p.x);
    asp_real t = d * k->table[STUDENT_SCALE] + k->table[STUDENT_OFFSET];
    return k->table[STUDENT_T0] * aspi_exp(-q) * d * student_b(k, STUDENT_B32, STUDENT_B64, t);
}

/* A visible normal by inversion. */
ASP_FN asp_v3 ndf_visible(const asp_shape *k, asp_v3 v, asp_real u1, asp_real u2)
{
    asp_real s2 = v.x * v.x + v.y * v.y;
    asp_real scale = R(1.0) / aspi_sqrt(s2 + v.z * v.z);
    asp_real s = aspi_sqrt(s2), c = v.z * scale, sn = s * scale;
    asp_real far = ndf_sigma(k, -aspi_abs(c), sn * sn);
    asp_real sigma = aspi_max(c, R(0.0)) + far;
    asp_real n = STUDENT_GAUSSIAN ? R(1.0) : k->table[STUDENT_N];
    asp_real invn = k->table[STUDENT_INVN];
    asp_real beta = R(1.0) - R(0.5) * invn;
    asp_real m0 = k->table[STUDENT_M0];
    asp_real start = R(0.5) * c + sn * m0;
    asp_real uu = aspi_max(u1, ASP_PRECISION == 64 ? R(1e-30) : R(1e-12));
    asp_real left = uu * sigma;
    asp_real right = (R(1.0) - uu) * sigma;
    int is_left = (left <= start) | (c < R(0.0));
    asp_real eps = is_left ? R(1.0) : R(-1.0);
    asp_real t0 = is_left ? -left : far - right;
    asp_real lo = R(0.0), hi = R(10.0), hy = hi;
    asp_v2 p, y, t;
    asp_v3 m;
    int i;
    asp_real uy = aspi_max(aspi_min(u2, R(1.0) - u2), ASP_PRECISION == 64 ? R(1e-30) : R(1e-12));
    asp_real ly = R(0.0), x, e;
    hi = aspi_sqrt(aspi_max(aspi_log((R(0.5) * aspi_abs(c) + sn * m0) / left) / beta, R(0.0)));
    hi = is_left ? hi : R(6.0) * aspi_sqrt(beta);
    for (i = 0; i < (ASP_PRECISION == 64 ? 56 : 28); i++) {
        asp_real mid = R(0.5) * (lo + hi), q = mid * mid, f;
        p = student_point(q, n, invn);
        f = c * student_side(k, q, p) + eps * sn * m0 * aspi_exp(-beta * q) + t0;
        if (!is_left && p.x * sn > c * p.y)
            f = R(-1.0);
        if (p.x * sn < -c * p.y)
            f = R(1.0);
        lo = f > R(0.0) ? mid : lo;
        hi = f > R(0.0) ? hi : mid;
    }
    p = student_point(lo * lo, n, invn);
    for (i = 0; i < (ASP_PRECISION == 64 ? 56 : 28); i++) {
        asp_real mid = R(0.5) * (ly + hy), q = mid * mid, d, f;
        y = student_point(q, k->table[STUDENT_Y_N], k->table[STUDENT_Y_INVN]);
        d = R(STUDENT_A) / (R(STUDENT_A) + y.x);
        f = k->table[STUDENT_Y_T0] * aspi_exp(-q) * d * student_b(k, STUDENT_Y32, STUDENT_Y64,
            d * k->table[STUDENT_Y_SCALE] + k->table[STUDENT_Y_OFFSET]) - uy;
        ly = f > R(0.0) ? mid : ly;
        hy = f > R(0.0) ? hy : mid;
    }
    y = student_point(ly * ly, k->table[STUDENT_Y_N], k->table[STUDENT_Y_INVN]);
    x = eps * p.x * y.y;
    e = (u2 > R(0.5) ? R(-1.0) : R(1.0)) * y.x * (STUDENT_GAUSSIAN ? R(1.0) : k->table[STUDENT_Y_WIDTH]);
    /* the view's azimuth; any for a view along the normal */
    t.x = s > R(0.0) ? v.x / s : R(1.0);
    t.y = s > R(0.0) ? v.y / s : R(0.0);
    m.x = x * t.x - e * t.y;
    m.y = x * t.y + e * t.x;
    m.z = p.y * y.y;
    return m;
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
