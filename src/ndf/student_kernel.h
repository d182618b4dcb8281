/* student_kernel.h - the formulas of the Student-t family
 *
 * Read once per precision by a distribution's file, which defines STUDENT_GAUSSIAN: 1 where n is
 * infinite (Beckmann), so that powers become exponentials and n disappears. student.h says what the
 * table holds. */

#include "asperity/facet.h"

#ifndef STUDENT_KERNEL_NAMES
#define STUDENT_KERNEL_NAMES
#define student_decay ASP_NDF_NAME(_decay)
#define student_decay_exact ASP_NDF_NAME(_decay_exact)
#define student_p ASP_NDF_NAME(_p)
#define student_b ASP_NDF_NAME(_b)
#define student_point ASP_NDF_NAME(_point)
#define student_across ASP_NDF_NAME(_across)
#define student_search ASP_NDF_NAME(_search)
#define student_rough_log ASP_NDF_NAME(_rough_log)
#define student_start ASP_NDF_NAME(_start)
#define student_step ASP_NDF_NAME(_step)
#define student_normal ASP_NDF_NAME(_normal_of)
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

/* The same for x = a/z, r = 1/z rounded. In float32 the exponent, which may reach 87, is carried in
 * two numbers from the quotient on, so that its rounding errors do not come out magnified. */
ASP_FN asp_real student_decay_exact(const asp_shape *k, int power, asp_real a, asp_real z,
                                    asp_real r)
{
#if ASP_PRECISION == 64
    (void)z;
    return student_decay(k, power, a * r);
#elif STUDENT_GAUSSIAN
    asp_real y = a * r;
    (void)k;
    (void)power;
    return aspi_exp_less(-y, aspi_product_error(y, z, a) * -r);
#else
    /* a/n */
    asp_real ah = aspi_high(a), al = a - ah;
    asp_real main = ah * k->table[STUDENT_INVN + 1];
    asp_real rest = ah * k->table[STUDENT_INVN + 2] + al * k->table[STUDENT_INVN];
    asp_real b = main + rest, b_low = rest - (b - main);
    /* y = b/z */
    asp_real y = b * r;
    asp_v2 l = aspi_log1p_sum(y, (b_low - aspi_product_error(y, z, b)) * r);
    /* p l */
    asp_real lh = aspi_high(l.x), ll = (l.x - lh) + l.y;
    asp_real e_low = ll * k->table[power] + lh * k->table[power + 2];
    return aspi_exp_less(-(lh * k->table[power + 1]), e_low);
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

/* Density of normals: (1 + r2/(n z2))^-gamma / (pi z2^2) (Ribardiere et al. 2017, eq. 11).
 * z2 below 1e-18 (float32) or 1e-150 counts as that, and a density whose power is below e^-87 or e^-708
 * is 0. Relative error 5e-7 (float32; 8e-7 in the far tail) and 1e-15 (1 + |log of the power|). */
ASP_FN asp_real ndf_density(const asp_shape *k, asp_real r2, asp_real z2)
{
    asp_real z = aspi_max(z2, ASP_PRECISION == 64 ? R(1e-150) : R(1e-18));
    asp_real r = R(1.0) / z;
    return student_decay_exact(k, STUDENT_GAMMA, r2, z, r) * (r * r * R(1.0 / ASP_PI));
}

/* sigma = max(w, 0) + s J(|w|/s), J as in student.h. With g^2 = s2 + w^2/n all is homogeneous.
 * Relative error 4e-15 (float64) and 1e-6 (float32, w >= 0). Below the mean plane only the tail is
 * left, and float32 answers within 1e-6 + 2e-7 E, E = n log(1 + w^2/(n s2)): a rounding error of w or
 * s2 by itself changes the tail by E times as much, so that more digits would not be worth their
 * time. 0 where e^-E is below e^-87. */
ASP_FN asp_real ndf_sigma(const asp_shape *k, asp_real w, asp_real s2)
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

/* The slope across the view, given the slope x along it, is sqrt(n + x^2) times a t-quantile of u:
 * returned as the homogeneous point of student_point, .x of either sign (to be multiplied by
 * sqrt n/sqrt(n + 1/2)). u = 1/2 gives 0. */
ASP_FN asp_v2 student_across(const asp_shape *k, asp_real u)
{
#if ASP_PRECISION == 64
    const asp_real least = R(STUDENT_LEAST_64), scale = R(2.0 / STUDENT_Y_END_64);
    const asp_real *c = k->table + STUDENT_Y64;
#else
    const asp_real least = R(STUDENT_LEAST_32), scale = R(2.0 / STUDENT_Y_END_32);
    const asp_real *c = k->table + STUDENT_Y32;
#endif
    asp_real v = aspi_max(aspi_min(u, R(1.0) - u), least);
    asp_real h = R(1.0) - (v + v);
    asp_real l = -aspi_log_near(R(4.0) * v * (R(1.0) - v), -h * h);
    asp_real t = scale * l / (l + R(STUDENT_Y_K)) - R(1.0);
    asp_v2 p;
#if ASP_PRECISION == 64
    STUDENT_START(t, c, 25)
    STUDENT_STEP(c, 22)
    STUDENT_STEP(c, 20)
    STUDENT_STEP5(c, 10)
#else
    STUDENT_START(t, c, 11)
#endif
    STUDENT_STEP5(c, 0)
    even = odd * t + even;
    p = student_point(l * (even * even), k->table[STUDENT_Y_N], k->table[STUDENT_Y_N + 1]);
    p.x = u > R(0.5) ? -p.x : p.x;
    return p;
}

/* A visible normal is drawn by inversion of the exact conditional distributions: first the slope x
 * along the view, whose distribution function is (c F(x) + s M(x))/sigma with F = 1 - T, then the
 * slope across, a t-quantile. (c, s): height and length of the view. Three cases:
 *     left    x = -X <= 0       c T(X) + s M(X) = u1 sigma
 *     right   0 <= x <= c/s     c T(X) - s M(X) + far = (1 - u1) sigma, double zero at X = c/s
 *     below   c < 0, x = -X     c T(X) + s M(X) = u1 far, or far minus it = (1 - u1) far, double zero
 *                               at X = -c/s
 * where far is the projected area of the side turned away. All are y(r) = t for
 *     y = turn (c T + side s M) + shift
 * with r = sqrt q, q = n log(1 + X^2/n), in which T and M are nearly Gaussian. */
typedef struct student_search {
    asp_real c, s, side, turn, shift, t;
    asp_real r_view;     /* r of the view itself */
    asp_real r;
} student_search;

/* log x within 0.03, relatively close near x = 1; for first guesses. */
ASP_FN asp_real student_rough_log(asp_real x)
{
    asp_v3 m = aspi_log_split(x);
    return m.x * R(0.69314718) + m.y * (R(1.0) - R(0.42) * m.y);
}

/* The equation, and a first r: left and right it solves a quadratic, b r + q2 r^2 = log of y's ratio
 * to its value at 0. */
ASP_FN student_search student_start(const asp_shape *k, asp_v3 v, asp_real u1)
{
    const asp_real tiny = ASP_PRECISION == 64 ? R(1e-200) : R(1e-30);
    const asp_real least = ASP_PRECISION == 64 ? R(STUDENT_LEAST_64) : R(STUDENT_LEAST_32);
    student_search a;
    asp_real vs2 = v.x * v.x + v.y * v.y;
    asp_real scale = R(1.0) / aspi_sqrt(vs2 + v.z * v.z);
    asp_real c = v.z * scale, s = aspi_sqrt(vs2) * scale, s2 = s * s, c2 = c * c, h = aspi_abs(c);
    asp_real m0 = k->table[STUDENT_M0], t0 = k->table[STUDENT_T0], invn = k->table[STUDENT_INVN];
    /* read here: a table entry inside a selection would be a conditional load */
    asp_real beta = k->table[STUDENT_BETA], inv_beta = k->table[STUDENT_INV_BETA];
    asp_real flat = k->table[STUDENT_BELOW];
    /* q where the view itself lies, and the far side's area, as in ndf_sigma */
    asp_real den = aspi_max(s2, ASP_PRECISION == 64 ? R(1e-200) : R(1e-24));
    asp_real g = aspi_sqrt(STUDENT_GAUSSIAN ? den : den + c2 * invn);
    asp_real ag = R(STUDENT_A) * g;
    asp_real steep = c2 / den, d = ag / (h + ag);
#if STUDENT_GAUSSIAN
    asp_real q_view = steep;
#else
    asp_real q_view = k->table[STUDENT_N] * aspi_log1p(steep * invn);
#endif
    asp_real far0 = g * m0 * aspi_exp(-q_view), far = far0 * (d * d) * student_p(k, d);
    asp_real r_view = aspi_sqrt(q_view), inv_r_view = R(1.0) / aspi_max(r_view, tiny);
    /* the case, as numbers, positive where it holds: the compilers vectorise selections on one
     * comparison, not on its logic */
    asp_real up = aspi_max(c, R(0.0)), sigma = aspi_max(up + far, tiny);
    asp_real u = aspi_max(u1, least), rest = aspi_max(R(1.0) - u, least);
    asp_real area = u * sigma;
    asp_real at_left = R(0.5) * up + s * m0, at_right = aspi_max(sigma - at_left, tiny);
    asp_real below = -c;
    asp_real right = c < R(0.0) ? R(-1.0) : area - at_left;
    asp_real near = c < R(0.0) ? u - R(0.5) : R(-1.0);
    asp_real folded = aspi_max(right, near);
    asp_real t = aspi_max(folded > R(0.0) ? rest * sigma : area, tiny);
    /* the quadratic, both sides times damp^2 */
    asp_real at_mean = below > R(0.0) ? sigma : at_left;
    asp_real at_0 = right > R(0.0) ? at_right : at_mean;
    asp_real inv_0 = R(1.0) / at_0;
    asp_real l1 = aspi_max(student_rough_log(at_0 / t), R(0.0));
    asp_real l = near > R(0.0) ? R(1.2) * rest : l1;
    asp_real root = aspi_sqrt(l);
    asp_real part = R(0.5) * up * inv_0;
    asp_real damp = R(1.0) + R(0.2) * root + (right > R(0.0) ? R(0.0) : l * invn);
    asp_real b = R(2.0) * t0 * up * inv_0, ld = l * damp;
    asp_real q2 = right > R(0.0) ? R(1.0) + inv_r_view * inv_r_view
                                 : part + (R(1.0) - part) * beta;
    asp_real r = (ld + ld) / (b + aspi_sqrt(b * b + R(4.0) * (q2 * (ld * damp))) + tiny);
    /* right: bent towards the end of the range */
    asp_real z = r * inv_r_view;
    asp_real z1 = aspi_min(z * (R(1.0) + z * (R(0.5) + R(0.6) * z)), R(30.0));
    asp_real z2 = z1 * (R(1.0) + z1 * (R(0.5) + R(1.0 / 6.0) * z1));
    asp_real r_right = r_view * (z2 / (R(1.0) + z2));
    /* left: not less than the M term's own solution; below: from r_view on */
    asp_real w = l + R(1.41421356) * root;
    asp_real l2 = student_rough_log(below > R(0.0)
                                    ? R(1.0) + c2 * w / (R(1.0) + w * flat)
                                    : aspi_max(R(1.0) - part, tiny));
    asp_real q_low = aspi_max((l + l2) * inv_beta, R(0.0));
    asp_real r_low = aspi_sqrt(q_low + (below > R(0.0) ? q_view : R(0.0)));
    /* near the double zero: distance from r_view by y's leading term, (r - r_view)^2; closer to it y
     * would be lost in rounding */
    asp_real gap = R(0.8) * inv_r_view * aspi_sqrt(rest * sigma * c2 * inv_beta
                                                   / aspi_max(far0 * (g * g), tiny));
    r = aspi_max(below > R(0.0) ? r_view + (near > R(0.0) ? gap : R(0.0)) : r, r_low);
    a.r = right > R(0.0) ? aspi_min(r_right, r_view - aspi_min(gap, R(0.5) * r_view)) : r;
    a.c = c;
    a.s = s;
    a.side = right > R(0.0) ? R(-1.0) : R(1.0);
    a.turn = near > R(0.0) ? R(-1.0) : R(1.0);
    a.shift = folded > R(0.0) ? far : R(0.0);
    a.t = t;
    a.r_view = r_view;
    return a;
}

/* One step of Halley's method for sqrt y = sqrt t, or where `logs` and there is no double zero for
 * log y = log t, which starts from further away. Returns the new r. */
ASP_FN asp_real student_step(const asp_shape *k, student_search a, int logs)
{
    const asp_real tiny = ASP_PRECISION == 64 ? R(1e-200) : R(1e-30);
    asp_real r = aspi_max(a.r, ASP_PRECISION == 64 ? R(1e-12) : R(1e-6));
    asp_real q = r * r;
    asp_v2 p = student_point(q, k->table[STUDENT_N], k->table[STUDENT_INVN]);
    asp_real ss = a.side * a.s;
    /* far out W only leads to subnormal numbers, which are slow */
    asp_real pw = p.y < (ASP_PRECISION == 64 ? R(1e-150) : R(1e-18)) ? R(0.0) : p.y;
    /* what is below rounding would throw the step off */
    asp_real cw = a.c * pw, sx = ss * p.x;
    asp_real noise = (aspi_abs(cw) + aspi_abs(sx)) * (ASP_PRECISION == 64 ? R(0x1p-48) : R(0x1p-20));
    asp_real slope = aspi_max(cw + sx, noise + (ASP_PRECISION == 64 ? R(1e-40) : R(1e-12)));
    asp_real d = R(STUDENT_A) / (R(STUDENT_A) + p.x);
#if STUDENT_GAUSSIAN
    asp_real e = aspi_exp(-q);
    asp_real ratio = R(1.0), bend = R(-2.0) * r;
#else
    asp_real e = aspi_exp(-q * k->table[STUDENT_BETA]);          /* g^(1 - 2n) */
    asp_real inverse = R(1.0) / (r * p.x);                       /* for r/p.x and 1/r */
    asp_real ratio = q * inverse, z = ratio * pw;
    asp_real bend = (R(1.0) - z * z) * (p.x * inverse) - (r + r);
#endif
    asp_real ew = e * pw;                                       /* g^(-2n) */
    asp_real value = a.c * (k->table[STUDENT_T0] * ew * d * student_b(k, d))
                   + ss * (k->table[STUDENT_M0] * e);
    asp_real y = aspi_max(a.turn * value + a.shift, R(0.05) * a.t);
    asp_real x = a.t / y;
    asp_real by_log = logs ? a.side + a.turn : R(0.0);           /* 2, but 0 with a double zero */
    /* 2 (1 - sqrt x), but y - t is exact in the end */
    asp_real g = R(2.0) * (y - a.t) / (y + y * aspi_sqrt(x));
    asp_real half = R(0.25) * g, step, apart, low, high;
    if (logs) {
        g = by_log > R(1.0) ? -aspi_log(x) : g;
        half = by_log > R(1.0) ? R(0.5) * g : half;
    }
    /* y' = -turn times the product below, y''/y' = bend + ss ratio/slope; `half` is what the logarithm
     * or the root adds */
    step = -a.turn * g * y / (R(2.0) * k->table[STUDENT_T0] * ratio * (e * slope) + tiny);
    bend = R(1.0) - R(0.5) * (step * (bend + ss * ratio / slope)) + half;
    /* with a double zero at r_view the distance from it changes by a factor of 4 at most: close to it
     * y may be all rounding */
    apart = r - a.r_view;
    low = a.side + a.turn < R(1.0) ? a.r_view + aspi_min(R(0.25) * apart, R(4.0) * apart)
                                   : (a.c < R(0.0) ? a.r_view : R(0.0));
    high = a.side + a.turn < R(1.0) ? a.r_view + aspi_max(R(0.25) * apart, R(4.0) * apart) : R(1e18);
    r = r - step / aspi_min(aspi_max(bend, R(0.4)), R(3.0));
    return aspi_min(aspi_max(r, aspi_max(low, R(0.0))), high);
}

/* The normal of the two slopes, turned to the view's azimuth; any azimuth for a view along the normal. */
ASP_FN asp_v3 student_normal(const asp_shape *k, asp_real r, asp_real side, asp_v2 across, asp_real vx,
                             asp_real vy)
{
    asp_v2 p = student_point(r * r, k->table[STUDENT_N], k->table[STUDENT_INVN]);
    asp_real along = side * p.x * across.y;
    asp_real over = across.x * k->table[STUDENT_Y_WIDTH];
    asp_real s2 = vx * vx + vy * vy;
    asp_real scale = R(1.0) / aspi_sqrt(s2 > R(0.0) ? s2 : R(1.0));
    asp_real ax = s2 > R(0.0) ? vx * scale : R(1.0), ay = vy * scale;
    asp_v3 m;
    m.x = along * ax - over * ay;
    m.y = along * ay + over * ax;
    m.z = p.y * across.y;
    return m;
}

/* Steps: the search's error falls from 1e-1 to 1e-4, 1e-10 ... of u1 for gamma > 1.6, one step later at
 * 1.501. The distribution function of the slope along the view at what comes out is u1 within 1e-6
 * (float32; 3e-6 below gamma 1.51) and 1e-11; across it is u2 within 1e-7 and 1e-14. */
#define STUDENT_MORE_STEPS (ASP_PRECISION == 64 ? 3 : 2)

ASP_FN asp_v3 ndf_visible(const asp_shape *k, asp_v3 v, asp_real u1, asp_real u2)
{
    student_search a = student_start(k, v, u1);
    a.r = student_step(k, a, 1);
    a.r = student_step(k, a, 0);
    a.r = student_step(k, a, 0);
#if ASP_PRECISION == 64
    a.r = student_step(k, a, 0);
#endif
    return student_normal(k, a.r, a.side, student_across(k, u2), v.x, v.y);
}

/* The same over blocks, stage by stage: in one loop each element would be a chain of a thousand
 * operations, too long for the processor to overlap with the next. */
#define STUDENT_BLOCK 128
#define STUDENT_LOAD(a, f, i) \
    a.c = f[0][i]; a.s = f[1][i]; a.side = f[2][i]; a.turn = f[3][i]; a.shift = f[4][i]; a.t = f[5][i]; \
    a.r_view = f[6][i]; a.r = f[7][i];

#define ASP_OWN_VISIBLE_N
ASP_CLONES static void ndf_visible_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT wx,
                                     const asp_real *ASP_RESTRICT wy,
                                     const asp_real *ASP_RESTRICT wz,
                                     const asp_real *ASP_RESTRICT u1,
                                     const asp_real *ASP_RESTRICT u2, asp_real *ASP_RESTRICT mx,
                                     asp_real *ASP_RESTRICT my, asp_real *ASP_RESTRICT mz)
{
    asp_real f[8][STUDENT_BLOCK];
    size_t from, i, count;
    int step;
    for (from = 0; from < n; from += STUDENT_BLOCK) {
        count = n - from < STUDENT_BLOCK ? n - from : STUDENT_BLOCK;
        for (i = 0; i < count; i++) {
            student_search a;
            a = student_start(k, aspi_view(k, aspi_at(wx, wy, wz, from + i)), u1[from + i]);
            f[0][i] = a.c;
            f[1][i] = a.s;
            f[2][i] = a.side;
            f[3][i] = a.turn;
            f[4][i] = a.shift;
            f[5][i] = a.t;
            f[6][i] = a.r_view;
            f[7][i] = a.r;
        }
        for (i = 0; i < count; i++) {
            student_search a;
            STUDENT_LOAD(a, f, i)
            f[7][i] = student_step(k, a, 1);
        }
        for (step = 0; step < STUDENT_MORE_STEPS; step++)
            for (i = 0; i < count; i++) {
                student_search a;
                STUDENT_LOAD(a, f, i)
                f[7][i] = student_step(k, a, 0);
            }
        for (i = 0; i < count; i++) {
            asp_v2 across = student_across(k, u2[from + i]);
            f[0][i] = across.x;
            f[1][i] = across.y;
        }
        for (i = 0; i < count; i++) {
            asp_v3 v = aspi_view(k, aspi_at(wx, wy, wz, from + i)), m;
            asp_v2 across;
            across.x = f[0][i];
            across.y = f[1][i];
            m = aspi_normalize(aspi_facet_back(k, student_normal(k, f[7][i], f[2][i], across, v.x,
                                                                 v.y)));
            mx[from + i] = m.x;
            my[from + i] = m.y;
            mz[from + i] = m.z;
        }
    }
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
