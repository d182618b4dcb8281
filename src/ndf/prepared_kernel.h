/* prepared_kernel.h - the formulas of a prepared surface
 *
 * Read once per precision by a distribution's file, after its ndf_density. prepared.h says what the
 * tables hold. */

#ifndef PREPARED_KERNEL_NAMES
#define PREPARED_KERNEL_NAMES
#define prepared_cell ASP_NDF_NAME(_prepared_cell)
#define prepared_weights ASP_NDF_NAME(_prepared_weights)
#define prepared_spline_at ASP_NDF_NAME(_prepared_spline_at)
#define prepared_tail_at ASP_NDF_NAME(_prepared_tail_at)
#define prepared_far ASP_NDF_NAME(_prepared_far)
#define prepared_below ASP_NDF_NAME(_prepared_below)
#define prepared_plain ASP_NDF_NAME(_prepared_plain)
#define prepared_tail ASP_NDF_NAME(_prepared_tail)
#define prepared_arc ASP_NDF_NAME(_prepared_arc)
#define prepared_turn ASP_NDF_NAME(_prepared_turn)
#define prepared_step ASP_NDF_NAME(_prepared_step)
#define PREPARED_TINY (ASP_PRECISION == 64 ? R(1e-200) : R(1e-24))
#endif

/* x in cells, within [0, n] (a NaN counts as 0): the cell as .x, the place in it as .y. By bits: the compilers
 * would branch on the ends. */
ASP_FN asp_v2 prepared_cell(asp_real x, int n)
{
    asp_real end = (asp_real)n, y = aspi_select(x > R(0.0), x, R(0.0));
    asp_real z = aspi_select(y < end, y, end);
    asp_real cell = (asp_real)(int)z;
    asp_v2 out;
    out.x = aspi_select(cell < end, cell, end - R(1.0));
    out.y = z - out.x;
    return out;
}

/* The inner two weights of the cubic B-spline, times 6; the outer ones are (1 - t)^3 and t^3. */
ASP_FN asp_v2 prepared_weights(asp_real t)
{
    asp_real s = R(1.0) - t;
    asp_v2 out;
    out.x = R(4.0) - R(3.0) * (t * t) * (R(2.0) - t);
    out.y = R(4.0) - R(3.0) * (s * s) * (R(2.0) - s);
    return out;
}

/* The spline of n cells that starts at c[0], x in cells. */
ASP_FN asp_real prepared_spline_at(const asp_real *c, int n, asp_real x)
{
    asp_v2 p = prepared_cell(x, n), w = prepared_weights(p.y);
    int i = (int)p.x;
    asp_real t = p.y, s = R(1.0) - t;
    return (c[i] * (s * s * s) + c[i + 1] * w.x) + (c[i + 2] * w.y + c[i + 3] * (t * t * t));
}

#ifndef PREPARED_OWN_SIGMA
/* s J(|w|/s) for the larger part of sigma, w >= 0, through E: relative to sigma its error is that of E. */
ASP_FN asp_real prepared_far(const asp_shape *k, asp_real h, asp_real b)
{
    asp_real y = aspi_sqrt(aspi_sqrt(b)), x = aspi_sqrt(h);
    asp_real v = x / aspi_max(x + y, PREPARED_TINY) * R(PREPARED_AREA_CELLS);
    asp_real unit = R(0.5) * b / aspi_max(h + aspi_sqrt(h * h + b), PREPARED_TINY);
    return unit * aspi_max(prepared_spline_at(k->table + PREPARED_AREA, PREPARED_AREA_CELLS, v), R(0.0));
}

/* The same relative to itself, through the density. */
ASP_FN asp_real prepared_below(const asp_shape *k, asp_real h, asp_real s2, asp_real b)
{
    asp_real y = aspi_sqrt(aspi_sqrt(aspi_sqrt(b))), x = aspi_sqrt(aspi_sqrt(h));
    asp_real v = x / aspi_max(x + y, PREPARED_TINY) * R(PREPARED_BELOW_CELLS);
    asp_real l2 = h * h + b, z2 = aspi_max(s2, ASP_PRECISION == 64 ? R(1e-150) : R(1e-18));
    asp_real d = ndf_density(k, h * h, z2) * s2;
    return d * (l2 * aspi_sqrt(l2))
         * aspi_exp(prepared_spline_at(k->table + PREPARED_BELOW, PREPARED_BELOW_CELLS, v));
}

/* sigma = max(w, 0) + s J(|w|/s). */
ASP_FN asp_real ndf_sigma(const asp_shape *k, asp_real w, asp_real s2)
{
    asp_real h = aspi_abs(w), b = s2 * k->table[PREPARED_SCALE2];
    asp_real above = prepared_far(k, h, b), below = prepared_below(k, h, s2, b);
    return aspi_select(w < R(0.0), below, w + above);
}
#endif

/* Radius of the slope beyond which the share e^-e of all slopes lies. */
ASP_FN asp_real prepared_plain(const asp_shape *k, asp_real e)
{
    asp_real root = aspi_sqrt(e);
    asp_real z = aspi_sqrt(root) * R(PREPARED_NORMAL_CELLS / PREPARED_Z_END);
    return root * aspi_exp(prepared_spline_at(k->table + PREPARED_NORMAL, PREPARED_NORMAL_CELLS, z));
}

#ifndef PREPARED_OWN_NORMAL
ASP_FN asp_v3 ndf_normal(const asp_shape *k, asp_real u1, asp_real u2)
{
    asp_real last = R(1.0) - (ASP_PRECISION == 64 ? R(0x1p-53) : R(0x1p-24));
    asp_real u = aspi_select(u1 > last, last, u1);
    asp_real r = prepared_plain(k, aspi_abs(aspi_log1p(-u)));
    asp_v2 t = aspi_sincos2pi(u2);
    asp_v3 m;
    m.x = r * t.x;
    m.y = r * t.y;
    m.z = R(1.0);
    return m;
}
#endif

/* The table of TAIL at v and z, both in cells. */
ASP_FN asp_real prepared_tail_at(const asp_shape *k, asp_real v, asp_real z)
{
    asp_v2 p = prepared_cell(v, PREPARED_VIEW_CELLS), q = prepared_cell(z, PREPARED_TAIL_CELLS);
    asp_v2 wp = prepared_weights(p.y), wq = prepared_weights(q.y);
    asp_real sp = R(1.0) - p.y, sq = R(1.0) - q.y;
    asp_real w0 = sp * sp * sp, w3 = p.y * p.y * p.y, z0 = sq * sq * sq, z3 = q.y * q.y * q.y;
    const asp_real *c = k->table + PREPARED_TAIL;
    int i = (int)p.x * PREPARED_TAIL_ROW + (int)q.x;
#define ROW(i) ((c[i] * z0 + c[(i) + 1] * wq.x) + (c[(i) + 2] * wq.y + c[(i) + 3] * z3))
    return (ROW(i) * w0 + ROW(i + PREPARED_TAIL_ROW) * wp.x)
         + (ROW(i + 2 * PREPARED_TAIL_ROW) * wp.y + ROW(i + 3 * PREPARED_TAIL_ROW) * w3);
#undef ROW
}

/* s eta of the slope sqrt(mu^2 + eta^2) beyond which the share `u` of what is seen from below lies, with `rest`
 * = 1 - u; h and s: height and length of the view, b = (s T0)^2. */
ASP_FN asp_real prepared_tail(const asp_shape *k, asp_real h, asp_real b, asp_real u, asp_real rest)
{
    asp_real h2 = h * h, scale = aspi_sqrt(h2 + b);
    asp_real x = aspi_sqrt(h), y = aspi_sqrt(aspi_sqrt(b));
    asp_real v = x / aspi_max(x + y, PREPARED_TINY) * R(PREPARED_VIEW_CELLS / PREPARED_VIEW_END);
    asp_real least = R(PREPARED_LEAST);
    asp_real rho = aspi_abs(aspi_log_near(aspi_max(u, least), -rest)) + (ASP_PRECISION == 64 ? R(1e-30) : R(1e-20));
    asp_real z = aspi_sqrt(aspi_sqrt(rho)) * R(PREPARED_TAIL_CELLS / PREPARED_Z_END);
    asp_real power = R(0.2) + R(2.0 / 15.0) * b / aspi_max(b + R(100.0) * h2, PREPARED_TINY);
    return scale * aspi_exp(power * aspi_log(rho) + prepared_tail_at(k, v, z));
}

/* Angle of the vector (x, y), y >= 0. */
ASP_FN asp_real prepared_arc(asp_real y, asp_real x)
{
    return aspi_atan(y, x);
}

/* Given the radius the azimuth has density proportional to c + g cos(phi) where that is positive:
 * |phi| < end. With a = c/g its distribution function is F = sin(phi) + a phi, to be brought to t F(end); one
 * step towards it by F's parabola (Cauchy), which also finds the double zero at the end. */
ASP_FN asp_real prepared_step(asp_real c, asp_real g, asp_real phi, asp_real t)
{
    asp_v2 p = aspi_sincos2pi(phi * R(0.5 / ASP_PI));
    asp_real miss = t - (g * p.y + c * phi);
    asp_real slope = aspi_max(c + g * p.x, R(0.0));
    asp_real root = slope * slope - R(2.0) * (g * p.y * miss);
    return phi + R(2.0) * miss / aspi_max(slope + aspi_sqrt(aspi_max(root, R(0.0))), R(1e-12));
}

/* cos and sin of the azimuth. c, g: as above, of any common scale; r: sqrt(g^2 - c^2) where that is positive, else
 * not used. */
ASP_FN asp_v2 prepared_turn(asp_real c, asp_real g, asp_real r, asp_real u)
{
    asp_real scale = R(1.0) / aspi_max(aspi_abs(c) + g, PREPARED_TINY);
    asp_real a = c * scale, b = g * scale;
    asp_real inside = c - g;
    asp_real end = inside > R(0.0) ? R(ASP_PI) : prepared_arc(r, -c);
    asp_real sine = inside > R(0.0) ? R(0.0) : r * scale;
    asp_real t = R(1.0) - R(2.0) * u, f = aspi_abs(t);
    asp_real target = f * (a * end + sine);
    asp_real phi;
    asp_v2 out;
    phi = end * f * R(0.5);
    phi = aspi_min(prepared_step(a, b, phi, target), end);
    phi = aspi_min(prepared_step(a, b, phi, target), end);
    phi = aspi_min(prepared_step(a, b, phi, target), end);
    phi = aspi_min(prepared_step(a, b, phi, target), end);
    phi = aspi_min(prepared_step(a, b, phi, target), end);
    phi = aspi_min(prepared_step(a, b, phi, target), end);
    out = aspi_sincos2pi(phi * R(0.5 / ASP_PI));
    out.y = t < R(0.0) ? -out.y : out.y;
    return out;
}

/* sigma = c + far. The share c of it, if c > 0, is drawn from all normals, and the share `far` from those
 * that a view below the mean plane sees: since (c + s x)+ = c + s (x + c/s)+ ... the sum over the azimuth is
 * that of both. The first goes outwards with u1 and the second comes back, so that the map is continuous. Given
 * the radius the azimuth is the same for both. */
ASP_FN asp_v3 ndf_visible(const asp_shape *k, asp_v3 v, asp_real u1, asp_real u2)
{
    asp_real s2 = v.x * v.x + v.y * v.y;
    asp_real scale = R(1.0) / aspi_sqrt(s2 + v.z * v.z);
    asp_real c = v.z * scale, s = aspi_sqrt(s2) * scale, h = aspi_abs(c), ss = s * s;
    asp_real b = ss * k->table[PREPARED_SCALE2];
    asp_real far = prepared_far(k, h, b);
    asp_real up = aspi_max(c, R(0.0)), sigma = up + far;
    asp_real area = u1 * sigma;
    asp_real inner = up - area;                     /* positive: from all normals */
    asp_real inv_far = R(1.0) / aspi_max(far, PREPARED_TINY);
    asp_real share = aspi_min(-inner * inv_far, R(1.0));
    asp_real rest = aspi_min((R(1.0) - u1) * sigma * inv_far, R(1.0));
    asp_real left = aspi_max(inner / aspi_max(up, PREPARED_TINY), ASP_PRECISION == 64 ? R(0x1p-53) : R(0x1p-24));
    asp_real e = aspi_abs(aspi_log(left));
    asp_real plain = prepared_plain(k, e);
    asp_real eta = prepared_tail(k, h, b, share, rest);
    asp_real steep = aspi_sqrt(h * h + eta * eta);
    asp_real x = aspi_select(inner > R(0.0), plain, steep);
    asp_real z = aspi_select(inner > R(0.0), R(1.0), s);
    asp_real g = s * x, cz = c * z;
    asp_real root = aspi_select(inner > R(0.0), aspi_sqrt(aspi_max(g * g - cz * cz, R(0.0))), s * eta);
    asp_v2 p = prepared_turn(cz, g, root, u2);
    asp_real inverse = s2 > R(0.0) ? R(1.0) / aspi_sqrt(s2) : R(0.0);
    asp_real ax = s2 > R(0.0) ? v.x * inverse : R(1.0), ay = v.y * inverse;
    asp_v3 m;
    p.x *= x;
    p.y *= x;
    m.x = p.x * ax - p.y * ay;
    m.y = p.x * ay + p.y * ax;
    m.z = z;
    return m;
}
