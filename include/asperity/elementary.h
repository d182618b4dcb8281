/* elementary.h - the elementary functions of the kernels, in both precisions
 *
 * Own, because libm's are not vectorised by the compilers without -ffast-math and differ from one
 * libm to the next; these give the same bits everywhere. Series are Taylor's, with the number of
 * terms that the reduced range asks for, so that no coefficient needs a table; float32's logarithm,
 * sine and cosine alone have fitted polynomials. Measured bounds in units in the last place, float64 and float32
 * (tests/test_elementary.c, 10^6 random arguments per row):
 *     exp 1.0, 1.1    expm1 2.0, 2.0    log 1.0, 1.0    log1p 1.5, 1.6
 *     sincos2pi absolute 1.8e-16, 1e-7    angle 2.6, 2.9 */

#include "asperity/number.h"

#ifndef ASP_ELEMENTARY_NAMES
#define ASP_ELEMENTARY_NAMES
#define aspi_abs ASP_NAME(aspi_abs)
#define aspi_min ASP_NAME(aspi_min)
#define aspi_max ASP_NAME(aspi_max)
#define aspi_sqrt ASP_NAME(aspi_sqrt)
#define aspi_to_bits ASP_NAME(aspi_to_bits)
#define aspi_from_bits ASP_NAME(aspi_from_bits)
#define aspi_select ASP_NAME(aspi_select)
#define aspi_high ASP_NAME(aspi_high)
#define aspi_product_error ASP_NAME(aspi_product_error)
#define aspi_exp ASP_NAME(aspi_exp)
#define aspi_exp_series ASP_NAME(aspi_exp_series)
#define aspi_exp_split ASP_NAME(aspi_exp_split)
#define aspi_exp_less ASP_NAME(aspi_exp_less)
#define aspi_exp_both ASP_NAME(aspi_exp_both)
#define aspi_expm1 ASP_NAME(aspi_expm1)
#define aspi_log_rest ASP_NAME(aspi_log_rest)
#define aspi_log_parts ASP_NAME(aspi_log_parts)
#define aspi_log ASP_NAME(aspi_log)
#define aspi_log_split ASP_NAME(aspi_log_split)
#define aspi_lost ASP_NAME(aspi_lost)
#define aspi_log_near ASP_NAME(aspi_log_near)
#define aspi_log1p ASP_NAME(aspi_log1p)
#define aspi_log1p_sum ASP_NAME(aspi_log1p_sum)
#define aspi_sin_cos ASP_NAME(aspi_sin_cos)
#define aspi_sincos2pi ASP_NAME(aspi_sincos2pi)
#define aspi_angle ASP_NAME(aspi_angle)
#define aspi_atan ASP_NAME(aspi_atan)
#endif

#if (ASP_PRECISION == 64 && !defined(ASP_ELEMENTARY_64)) || \
    (ASP_PRECISION == 32 && !defined(ASP_ELEMENTARY_32))
#if ASP_PRECISION == 64
#define ASP_ELEMENTARY_64
#else
#define ASP_ELEMENTARY_32
#endif

/* min and max by selection: a NaN in the first argument comes out. */
ASP_FN asp_real aspi_min(asp_real a, asp_real b) { return b < a ? b : a; }
ASP_FN asp_real aspi_max(asp_real a, asp_real b) { return b > a ? b : a; }

ASP_FN asp_bits aspi_to_bits(asp_real x)
{
    asp_bits b;
    memcpy(&b, &x, sizeof b);
    return b;
}

ASP_FN asp_real aspi_from_bits(asp_bits b)
{
    asp_real x;
    memcpy(&x, &b, sizeof x);
    return x;
}

/* a where the condition is 1, b where it is 0, by bits: the compiler cannot turn it into a branch
 * around what a or b cost, which would keep a loop from being vectorised. */
ASP_FN asp_real aspi_select(int condition, asp_real a, asp_real b)
{
    asp_bits mask = (asp_bits)((asp_bits)0 - (asp_bits)condition);
    return aspi_from_bits((aspi_to_bits(a) & mask) | (aspi_to_bits(b) & (asp_bits)~mask));
}

#if ASP_PRECISION == 64
#define ASP_FRACTION_BITS 52
#define ASP_EXPONENT_BIAS 1023u
#define ASP_ROUND_SHIFT 6755399441055744.0 /* 1.5 * 2^52: adding it rounds to the nearest integer */
#define ASP_INT_SHIFT 4503599627370496.0   /* 2^52 */
#define ASP_SIGN_BIT 0x8000000000000000u
#define ASP_SQRT_HALF_BITS 0x3fe6a09e667f3bcdu
#define ASP_HIGH_HALF 0xfffffffff8000000u /* sign, exponent and 26 bits */
#define ASP_EXP_LOW (-708.0)
#define ASP_EXP_HIGH 709.0
#define ASP_LN2_HIGH 0x1.62e42fefa3p-1 /* ln 2 cut to 41 bits, so that k times it is exact ... */
#define ASP_LN2_LOW 0x1.3de6af278ece6p-42 /* ... and what is left */
#else
#define ASP_FRACTION_BITS 23
#define ASP_EXPONENT_BIAS 127u
#define ASP_ROUND_SHIFT 12582912.0
#define ASP_INT_SHIFT 8388608.0
#define ASP_SIGN_BIT 0x80000000u
#define ASP_SQRT_HALF_BITS 0x3f3504f3u
#define ASP_HIGH_HALF 0xfffff000u /* sign, exponent and 12 bits */
#define ASP_EXP_LOW (-87.0)
#define ASP_EXP_HIGH 88.0
#define ASP_LN2_HIGH 0x1.62ep-1
#define ASP_LN2_LOW 0x1.0bfbe8e7bcd5ep-15
#endif

ASP_FN asp_real aspi_abs(asp_real x)
{
#if ASP_PRECISION == 64
    return fabs(x);
#else
    return fabsf(x);
#endif
}

ASP_FN asp_real aspi_sqrt(asp_real x)
{
#if ASP_PRECISION == 64
    return sqrt(x);
#else
    return sqrtf(x);
#endif
}

/* The upper half of the significand: x - aspi_high(x) is exact, and so is the product of two upper
 * halves (Dekker 1971; cut instead of rounded). */
ASP_FN asp_real aspi_high(asp_real x)
{
    return aspi_from_bits(aspi_to_bits(x) & (asp_bits)ASP_HIGH_HALF);
}

/* a b - p for p = a b rounded, without a fused multiply-add. */
ASP_FN asp_real aspi_product_error(asp_real a, asp_real b, asp_real p)
{
    asp_real ah = aspi_high(a), bh = aspi_high(b);
    asp_real al = a - ah, bl = b - bh;
    return ((ah * bh - p) + (ah * bl + al * bh)) + al * bl;
}

/* (e^r - 1 - r) / r^2 for |r| <= ln(2)/2. */
ASP_FN asp_real aspi_exp_series(asp_real r)
{
    asp_real p;
#if ASP_PRECISION == 64
    p = R(1.0 / 6227020800.0);
    p = p * r + R(1.0 / 479001600.0);
    p = p * r + R(1.0 / 39916800.0);
    p = p * r + R(1.0 / 3628800.0);
    p = p * r + R(1.0 / 362880.0);
    p = p * r + R(1.0 / 40320.0);
    p = p * r + R(1.0 / 5040.0);
#else
    p = R(1.0 / 5040.0);
#endif
    p = p * r + R(1.0 / 720.0);
    p = p * r + R(1.0 / 120.0);
    p = p * r + R(1.0 / 24.0);
    p = p * r + R(1.0 / 6.0);
    return p * r + R(0.5);
}

/* x = k ln 2 + r, |r| <= ln(2)/2, as .x = r and .y = 2^k; x is taken at the nearer of ASP_EXP_LOW and
 * ASP_EXP_HIGH where it lies outside them. */
ASP_FN asp_v2 aspi_exp_split(asp_real x)
{
    asp_real y = x < R(ASP_EXP_LOW) ? R(ASP_EXP_LOW) : x;
    asp_real z = y > R(ASP_EXP_HIGH) ? R(ASP_EXP_HIGH) : y;
    asp_real shifted = z * R(1.44269504088896340736) + R(ASP_ROUND_SHIFT);
    asp_real k = shifted - R(ASP_ROUND_SHIFT);
    asp_v2 out;
    out.x = (z - k * R(ASP_LN2_HIGH)) - k * R(ASP_LN2_LOW);
    /* the low bits of `shifted` hold k: make 2^k of them */
    out.y = aspi_from_bits((asp_bits)((aspi_to_bits(shifted) + (asp_bits)ASP_EXPONENT_BIAS)
                           << ASP_FRACTION_BITS));
    return out;
}

/* e^(x - low), |low| much smaller than 1. 0 for x below ASP_EXP_LOW (no subnormal results),
 * e^ASP_EXP_HIGH above ASP_EXP_HIGH: a kernel's exponent is bounded above by construction. */
ASP_FN asp_real aspi_exp_less(asp_real x, asp_real low)
{
    asp_v2 s = aspi_exp_split(x);
    asp_real r = s.x - low;
    asp_real e = R(1.0) + (r + (r * r) * aspi_exp_series(r));
    return x < R(ASP_EXP_LOW) ? R(0.0) : e * s.y;
}

ASP_FN asp_real aspi_exp(asp_real x) { return aspi_exp_less(x, R(0.0)); }

/* e^x as .x and e^x - 1 as .y, each accurate where it is small. 0 and -1 below ASP_EXP_LOW; above
 * ASP_EXP_HIGH as aspi_exp. */
ASP_FN asp_v2 aspi_exp_both(asp_real x)
{
    asp_v2 s = aspi_exp_split(x), out;
    asp_real e = s.y * (s.x + (s.x * s.x) * aspi_exp_series(s.x));
    out.x = x < R(ASP_EXP_LOW) ? R(0.0) : s.y + e;
    out.y = (s.y - R(1.0)) + e;
    return out;
}

ASP_FN asp_real aspi_expm1(asp_real x) { return aspi_exp_both(x).y; }

/* f - log(1 + f) for 1 + f within [sqrt(1/2), sqrt(2)). In float64 by the series of 2 atanh(s) =
 * log(1 + f), s = f/(2 + f), |s| <= 0.1716: f - 2 atanh(s) = s (f - s^2 p). In float32 a polynomial,
 * which saves the division: f^2/2 - f^3 q, q by scripts/series.py, relative error 4e-9. */
ASP_FN asp_real aspi_log_rest(asp_real f)
{
#if ASP_PRECISION == 64
    asp_real s = f / (R(2.0) + f);
    asp_real z = s * s;
    asp_real p = R(2.0 / 21.0);
    p = p * z + R(2.0 / 19.0);
    p = p * z + R(2.0 / 17.0);
    p = p * z + R(2.0 / 15.0);
    p = p * z + R(2.0 / 13.0);
    p = p * z + R(2.0 / 11.0);
    p = p * z + R(2.0 / 9.0);
    p = p * z + R(2.0 / 7.0);
    p = p * z + R(2.0 / 5.0);
    p = p * z + R(2.0 / 3.0);
    return s * (f - z * p);
#else
    asp_real z = f * f;
    asp_real even = R(0.07149753891), odd = R(-0.1157120073);
    even = even * z + R(0.1166151107);
    odd = odd * z + R(-0.1241105068);
    even = even * z + R(0.1424993653);
    odd = odd * z + R(-0.1666848024);
    even = even * z + R(0.2000070748);
    odd = odd * z + R(-0.2499998905);
    even = even * z + R(0.3333333119);
    return z * (R(0.5) - f * (even + f * odd));
#endif
}

/* log(2^k (1 + f)): f is exact, so only the small second part is rounded. */
ASP_FN asp_real aspi_log_parts(asp_real k, asp_real f)
{
    return k * R(ASP_LN2_HIGH) + (f - (aspi_log_rest(f) - k * R(ASP_LN2_LOW)));
}

/* x = 2^k (1 + f) with 1 + f within [sqrt(1/2), sqrt(2)), as .x = k, .y = f and .z = 2^-k. */
ASP_FN asp_v3 aspi_log_split(asp_real x)
{
    /* exponent field of x / sqrt(1/2): the mantissa then lies in [sqrt(1/2), sqrt(2)) */
    asp_bits b = aspi_to_bits(x);
    asp_bits biased = (asp_bits)(b - (asp_bits)ASP_SQRT_HALF_BITS
                      + ((asp_bits)ASP_EXPONENT_BIAS << ASP_FRACTION_BITS)) >> ASP_FRACTION_BITS;
    asp_bits shift = (asp_bits)(biased - (asp_bits)ASP_EXPONENT_BIAS) << ASP_FRACTION_BITS;
    asp_v3 out;
    out.x = aspi_from_bits(biased | aspi_to_bits(R(ASP_INT_SHIFT))) - R(ASP_INT_SHIFT + ASP_EXPONENT_BIAS);
    out.y = aspi_from_bits((asp_bits)(b - shift)) - R(1.0);
    out.z = aspi_from_bits((asp_bits)(aspi_to_bits(R(1.0)) - shift));
    return out;
}

/* What the sum u = 1 + x rounded away. */
ASP_FN asp_real aspi_lost(asp_real x, asp_real u)
{
    return u < R(2.0) ? x - (u - R(1.0)) : R(1.0) - (u - x);
}

/* log x for a caller who knows x - 1 better than x: x_less_1 replaces it for x within [sqrt(1/2),
 * sqrt(2)), where the logarithm's zero lies. x positive and normal; anything else gives an
 * unspecified finite number, and a NaN gives a NaN. */
ASP_FN asp_real aspi_log_near(asp_real x, asp_real x_less_1)
{
    asp_v3 s = aspi_log_split(x);
    asp_real y = aspi_log_parts(s.x, s.x == R(0.0) ? x_less_1 : s.y);
    return x == x ? y : x;
}

ASP_FN asp_real aspi_log(asp_real x) { return aspi_log_near(x, x - R(1.0)); }

/* log(1 + x) for x > -1, finite and below the square root of the largest number. What 1 + x rounds
 * away is given back to f before the series, so that the relative error stays small near 0. */
ASP_FN asp_real aspi_log1p(asp_real x)
{
    asp_real u = R(1.0) + x;
    asp_v3 s = aspi_log_split(u);
    return aspi_log_parts(s.x, s.y + aspi_lost(x, u) * s.z);
}

/* log(1 + x + low) as the sum .x + .y, |low| at most an ulp of x >= 0: about twice as many bits as
 * one number holds where the logarithm is large, for exponents that multiply it. */
ASP_FN asp_v2 aspi_log1p_sum(asp_real x, asp_real low)
{
    asp_real u = R(1.0) + x;
    asp_v3 s = aspi_log_split(u);
    asp_real k = s.x, add = aspi_lost(x, u) * s.z;
    asp_real f = s.y + add;
    asp_real f_low = (add - (f - s.y)) + low * s.z;
    asp_real t = aspi_log_rest(f), a, kh;
    asp_v2 out;
    a = f - t;
    kh = k * R(ASP_LN2_HIGH);
    out.x = kh + a;
    /* what the two additions rounded away, ln 2's tail, and nearly f_low / (1 + f) */
    out.y = (((kh - out.x) + a) + ((f - a) - t)) + (k * R(ASP_LN2_LOW) + f_low * (R(1.0) - f));
    return out;
}

#if ASP_PRECISION == 64
/* sine and cosine of x, |x| <= pi/4, as .x = cos, .y = sin. */
ASP_FN asp_v2 aspi_sin_cos(asp_real x)
{
    asp_real z = x * x;
    asp_real s, c;
    asp_v2 out;
    s = R(1.0 / 355687428096000.0);
    s = s * z - R(1.0 / 1307674368000.0);
    s = s * z + R(1.0 / 6227020800.0);
    s = s * z - R(1.0 / 39916800.0);
    c = R(1.0 / 20922789888000.0);
    c = c * z - R(1.0 / 87178291200.0);
    c = c * z + R(1.0 / 479001600.0);
    c = c * z - R(1.0 / 3628800.0);
    s = s * z + R(1.0 / 362880.0);
    c = c * z + R(1.0 / 40320.0);
    s = s * z - R(1.0 / 5040.0);
    s = s * z + R(1.0 / 120.0);
    s = s * z - R(1.0 / 6.0);
    c = c * z - R(1.0 / 720.0);
    c = c * z + R(1.0 / 24.0);
    out.y = x + (x * z) * s;
    out.x = R(1.0) - (R(0.5) * z - (z * z) * c);
    return out;
}

/* cos and sin of 2 pi u as .x and .y, |u| < 2^20. The reduction is exact. */
ASP_FN asp_v2 aspi_sincos2pi(asp_real u)
{
    asp_real shifted = R(4.0) * u + R(ASP_ROUND_SHIFT);
    asp_real k = shifted - R(ASP_ROUND_SHIFT);
    asp_bits q = aspi_to_bits(shifted);
    asp_v2 a = aspi_sin_cos((u - R(0.25) * k) * R(2.0 * ASP_PI));
    asp_v2 out;
    /* quarter turns: swap on odd, then signs, by bits so that no branch is left */
    asp_bits odd = (asp_bits)((asp_bits)0 - (q & 1u));
    asp_bits c = aspi_to_bits(a.x), s = aspi_to_bits(a.y);
    asp_bits flip = (asp_bits)((c ^ s) & odd);
    asp_bits sign_s = (asp_bits)((q & 2u) << (8 * sizeof(asp_bits) - 2));
    asp_bits sign_c = (asp_bits)(((q + 1u) & 2u) << (8 * sizeof(asp_bits) - 2));
    out.x = aspi_from_bits((asp_bits)((c ^ flip) ^ sign_c));
    out.y = aspi_from_bits((asp_bits)((s ^ flip) ^ sign_s));
    return out;
}
#else
/* cos and sin of 2 pi u as .x and .y, |u| < 2^20. With x = 1 - 4 |t|, t what a whole number of turns leaves,
 * they are sin(pi x/2) = x + x (1 - x^2) g(x^2) and, with t's sign, cos(pi x/2) = (1 - x^2)(1 - x^2 r(x^2)):
 * no quarters to swap, and little left to round near 1. g and r by scripts/series.py, errors 1e-8 and 1e-9. */
ASP_FN asp_v2 aspi_sincos2pi(asp_real u)
{
    asp_real t = u - ((u + R(ASP_ROUND_SHIFT)) - R(ASP_ROUND_SHIFT));
    asp_real x = R(1.0) - R(4.0) * aspi_abs(t), z = x * x;
    asp_real rest = R(1.0) - z, g = R(-0.0001499694053), r = R(-2.382530163e-5);
    asp_v2 out;
    g = g * z + R(0.004520557049);
    r = r * z + R(0.000893956649);
    g = g * z + R(-0.07516691423);
    r = r * z + R(-0.01996884486);
    g = g * z + R(0.5707963001);
    r = r * z + R(0.2337005466);
    out.x = x + (x * rest) * g;
    out.y = copysignf(rest - (rest * z) * r, t);
    return out;
}
#endif

/* Angle of the vector (x, y) to the x axis, x >= 0, y >= 0; 0 for the zero vector. The nearest of 0,
 * pi/8 and pi/4 is taken off by the tangent of a difference, which leaves at most tan(pi/16). */
ASP_FN asp_real aspi_angle(asp_real y, asp_real x)
{
    int steep = y > x;
    asp_real high = steep ? y : x, low = steep ? x : y;
    int middle = low > R(0.19891236737965800691) * high;   /* tan(pi/16) */
    int far = low > R(0.66817863791929891999) * high;      /* tan(3 pi/16) */
    asp_real tangent = far ? R(1.0) : middle ? R(0.41421356237309504880) : R(0.0);
    asp_real off = far ? R(0.25 * ASP_PI) : middle ? R(0.125 * ASP_PI) : R(0.0);
    asp_real t = (low - high * tangent) / aspi_max(high + low * tangent, R(1e-37));
    asp_real z = t * t, p;
#if ASP_PRECISION == 64
    p = R(1.0 / 21.0);
    p = p * z - R(1.0 / 19.0);
    p = p * z + R(1.0 / 17.0);
    p = p * z - R(1.0 / 15.0);
    p = p * z + R(1.0 / 13.0);
    p = p * z - R(1.0 / 11.0);
    p = p * z + R(1.0 / 9.0);
#else
    p = R(1.0 / 9.0);
#endif
    p = p * z - R(1.0 / 7.0);
    p = p * z + R(1.0 / 5.0);
    p = p * z - R(1.0 / 3.0);
    t = off + (t + (t * z) * p);
    return steep ? R(0.5 * ASP_PI) - t : t;
}

/* Angle of the vector (x, y) in (-pi, pi]; 0 for the zero vector. */
ASP_FN asp_real aspi_atan(asp_real y, asp_real x)
{
    asp_real a = aspi_angle(aspi_abs(y), aspi_abs(x));
    a = x < R(0.0) ? R(ASP_PI) - a : a;
    return y < R(0.0) ? -a : a;
}

#undef ASP_FRACTION_BITS
#undef ASP_EXPONENT_BIAS
#undef ASP_ROUND_SHIFT
#undef ASP_INT_SHIFT
#undef ASP_SIGN_BIT
#undef ASP_HIGH_HALF
#undef ASP_SQRT_HALF_BITS
#undef ASP_EXP_LOW
#undef ASP_EXP_HIGH
#undef ASP_LN2_HIGH
#undef ASP_LN2_LOW
#endif
