/* student_search.h - the visible normals of the Student-t family from any side, for every gamma
 *
 * Read by student_kernel.h. student_visible.h has the shorter way for views from above. */

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
