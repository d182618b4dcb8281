/* prepared_turn.h - the azimuth of a visible normal, given the radius; read by prepared_kernel.h
 *
 * It has density proportional to c + g cos(phi) where that is positive, |phi| < end, and the distribution function
 * F = c phi + g sin(phi): Kepler's equation, up to signs, where c > g. F is inverted by steps from a start. */

#ifndef PREPARED_TURN_NAMES
#define PREPARED_TURN_NAMES
#define prepared_start ASP_NDF_NAME(_prepared_start)
#define prepared_forward ASP_NDF_NAME(_prepared_forward)
#define prepared_turned ASP_NDF_NAME(_prepared_turned)
#define prepared_towards ASP_NDF_NAME(_prepared_towards)
#define prepared_way ASP_NDF_NAME(_prepared_way)
#define prepared_near ASP_NDF_NAME(_prepared_near)
#define prepared_aim ASP_NDF_NAME(_prepared_aim)
#define prepared_step ASP_NDF_NAME(_prepared_step)
#define prepared_turn ASP_NDF_NAME(_prepared_turn)
#endif

/* phi/end to start from, exact at both ends: (1 - w)(1 + w K), w = sqrt(1 - F/F(end)), K linear in w and in 1, a = c/(|c| + g), |a|,
 * e = a - 1/2 + |a - 1/2| and e^2. F misses by 1 % of itself for c < 0 and by 8 % elsewhere, phi by 0.2 at most
 * (scripts/azimuth.py). */
ASP_FN asp_real prepared_start(asp_real a, asp_real w)
{
    asp_real size = aspi_abs(a), beyond = a - R(0.5), twice = beyond + aspi_abs(beyond);
    asp_real k0 = (R(0.06199533581) - R(0.7303047487) * a)
                + ((R(8.324184469) - R(6.677804595) * twice) * twice - R(0.6423741285) * size);
    asp_real k1 = (R(0.1220154073) + R(0.711368276) * a)
                + ((R(11.41463314) * twice - R(11.93800097)) * twice + R(1.01862363) * size);
    return (R(1.0) - w) * (R(1.0) + w * (k0 + k1 * w));
}

/* The step to the nearest zero of the parabola slope d - curve d^2/2 - miss (Cauchy), which also finds the double
 * zero of F' and F - t at the end; .y: the parabola's slope there. */
ASP_FN asp_v2 prepared_forward(asp_real miss, asp_real slope, asp_real curve)
{
    asp_v2 out;
    out.y = aspi_sqrt(aspi_max(slope * slope - R(2.0) * (curve * miss), R(0.0)));
    out.x = R(2.0) * miss / ((slope + out.y) + PREPARED_TINY);
    return out;
}

#if ASP_PRECISION == 64
/* c phi + g sin(phi) from c + g, which for c near -g is all that is left of the two. */
ASP_FN asp_real prepared_turned(asp_real sum, asp_real g, asp_real phi, asp_real sine)
{
    asp_real x = phi * phi;
    asp_real near = phi * x * (R(1.0 / 6.0) - x * (R(1.0 / 120.0) - x * (R(1.0 / 5040.0) - x * R(1.0 / 362880.0))));
    return sum * phi - g * aspi_select(x < R(0.04), near, phi - sine);
}

/* A step of F towards t. sum = c + g; p: cos and sin of phi. */
ASP_FN asp_real prepared_towards(asp_real sum, asp_real g, asp_real phi, asp_v2 p, asp_real t)
{
    asp_real miss = t - prepared_turned(sum, g, phi, p.y);
    asp_real less = p.x > R(0.0) ? p.y * p.y / (R(1.0) + aspi_abs(p.x)) : R(1.0) - p.x;
    return prepared_forward(miss, aspi_max(sum - g * less, R(0.0)), g * p.y).x;
}

#define PREPARED_SINCOS(x) aspi_sincos2pi((x) * R(0.5 / ASP_PI))
#endif

/* An azimuth on its way: c and g of any scale, their sum, F to be reached, phi = start and the end of the range;
 * then what a step found: cos and sin of phi, and F' there. */
typedef struct prepared_way {
    asp_real a, b, sum, target, phi, end;
} prepared_way;

typedef struct prepared_near {
    asp_real cosine, sine, phi, slope;
} prepared_near;

#if ASP_PRECISION == 64
/* r: sqrt(g^2 - c^2), or 0 where c > g. */
ASP_FN prepared_way prepared_aim(asp_real c, asp_real g, asp_real r, asp_real u)
{
    asp_real scale = R(1.0) / ((aspi_abs(c) + g) + PREPARED_TINY);
    asp_real sine_end = r * scale, f = aspi_abs(R(1.0) - R(2.0) * u);
    prepared_way w;
    w.a = c * scale;
    w.b = g * scale;
    w.end = aspi_atan(r, aspi_select(c > g, R(-1.0), -c));
    w.sum = aspi_select(c < R(0.0), sine_end * sine_end, w.a + w.b);
    w.target = f * prepared_turned(w.sum, w.b, w.end, sine_end / aspi_max(w.b, R(0.25)));
    w.phi = w.end * prepared_start(w.a, aspi_sqrt(R(1.0) - f));
    return w;
}

ASP_FN prepared_near prepared_step(prepared_way w)
{
    asp_v2 p = PREPARED_SINCOS(w.phi);
    prepared_near out;
    out.phi = aspi_min(w.phi + prepared_towards(w.sum, w.b, w.phi, p, w.target), w.end);
    p = PREPARED_SINCOS(out.phi);
    out.cosine = p.x;
    out.sine = p.y;
    out.slope = R(0.0);
    return out;
}

/* cos and sin of the azimuth. Steps bring F to 1e-4, 3e-7 and 2e-13 of itself, and the last of them is a turn by a
 * small angle. */
ASP_FN asp_v2 prepared_turn(prepared_way w, prepared_near at, asp_real u)
{
    asp_real phi, d, d2, sine, cosine;
    asp_v2 p, out;
    p.x = at.cosine;
    p.y = at.sine;
    phi = aspi_min(at.phi + prepared_towards(w.sum, w.b, at.phi, p, w.target), w.end);
    p = PREPARED_SINCOS(phi);
    d = aspi_min(prepared_towards(w.sum, w.b, phi, p, w.target), w.end - phi);
    d2 = d * d;
    sine = d * (R(1.0) - d2 * (R(1.0 / 6.0) - d2 * R(1.0 / 120.0)));
    cosine = R(1.0) - d2 * (R(0.5) - d2 * (R(1.0 / 24.0) - d2 * R(1.0 / 720.0)));
    out.x = p.x * cosine - p.y * sine;
    out.y = p.y * cosine + p.x * sine;
    out.y = u > R(0.5) ? -out.y : out.y;
    return out;
}
#else
/* The same. With x = r/(|c| + g) = tan(end/2) or, above, tan((pi - end)/2) nothing cancels: F(end) is a end + x, or
 * x - |a| end = x^3 (1 + (1 - x^2) A) where atan x = x - x^3 A. A to 8e-8 by scripts/azimuth.py. */
ASP_FN prepared_way prepared_aim(asp_real c, asp_real g, asp_real r, asp_real u)
{
    asp_real scale = R(1.0) / ((aspi_abs(c) + g) + PREPARED_TINY), x = r * scale, z = x * x;
    asp_real f = aspi_abs(R(1.0) - R(2.0) * u), z2 = z * z, A, half;
    int below = c < R(0.0);
    prepared_way w;
    w.a = c * scale;
    w.b = g * scale;
    A = ((R(0.3333332568) - R(0.1999892725) * z) + (R(0.1426091101) - R(0.1088864553) * z) * z2)
      + ((R(0.08074397253) - R(0.04985569133) * z) + (R(0.02070679649) - R(0.00405995675) * z) * z2) * (z2 * z2);
    half = x - x * z * A;
    w.end = below ? half + half : R(ASP_PI) - (half + half);
    w.sum = below ? z : R(1.0);
    w.target = f * (below ? x * z * (R(1.0) + (R(1.0) - z) * A) : w.a * w.end + x);
    w.phi = w.end * prepared_start(w.a, aspi_sqrt(R(1.0) - f));
    return w;
}

/* Cauchy's step brings F to 1e-4 of itself, for c < 0 to 3e-7, as a turn by a small angle. (phi - sin phi)/phi^3 and
 * (1 - cos phi)/phi^2 up to pi by scripts/azimuth.py, in sine to 2e-9 and in cosine to 1.2e-8. */
ASP_FN prepared_near prepared_step(prepared_way w)
{
    asp_real phi = w.phi, x = phi * phi, x2 = x * x, P, Q;
    asp_real cube, less, sine, cosine, d, d2, s, k;
    prepared_near out;
    asp_v2 step;
    P = (R(0.1666666569) - R(0.008333317803) * x) + (R(0.0001984038106) - R(2.753291871e-6) * x) * x2
      + (R(2.470307813e-8) - R(1.352831256e-10) * x) * (x2 * x2);
    Q = (R(0.4999999249) - R(0.04166651787) * x) + (R(0.00138879056) - R(2.477163482e-5) * x) * x2
      + (R(2.709339591e-7) - R(1.72902783e-9) * x) * (x2 * x2);
    cube = phi * x * P;
    less = x * Q;
    sine = phi - cube;
    cosine = R(1.0) - less;
    step = prepared_forward(w.target - (w.sum * phi - w.b * cube), aspi_max(w.sum - w.b * less, R(0.0)), w.b * sine);
    d = aspi_min(step.x, w.end - phi);
    d2 = d * d;
    s = d * (R(1.0) - d2 * (R(1.0 / 6.0) - d2 * R(1.0 / 120.0)));
    k = d2 * (R(0.5) - d2 * (R(1.0 / 24.0) - d2 * R(1.0 / 720.0)));
    out.cosine = cosine - (cosine * k + sine * s);
    out.sine = sine + (cosine * s - sine * k);
    out.phi = phi + d;
    out.slope = step.y;
    return out;
}

/* One of Newton's brings F to 3e-7 where it is not. */
ASP_FN asp_v2 prepared_turn(prepared_way w, prepared_near at, asp_real u)
{
    asp_real miss = w.target - (w.a * at.phi + w.b * at.sine);
    asp_real d = miss / aspi_max(aspi_max(at.slope, w.a + w.b * at.cosine), R(0.02)), k;
    asp_v2 out;
    d = aspi_min(w.a < R(0.0) ? R(0.0) : d, w.end - at.phi);
    k = R(0.5) * (d * d);
    out.x = at.cosine - (at.cosine * k + at.sine * d);
    out.y = copysignf(at.sine + (at.cosine * d - at.sine * k), R(0.5) - u);
    return out;
}
#endif
