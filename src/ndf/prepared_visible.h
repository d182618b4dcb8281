/* prepared_visible.h - plain and visible normals of a prepared surface; read by prepared_kernel.h */

#ifndef PREPARED_VISIBLE_NAMES
#define PREPARED_VISIBLE_NAMES
#define prepared_share ASP_NDF_NAME(_prepared_share)
#define prepared_share_at ASP_NDF_NAME(_prepared_share_at)
#define prepared_plain ASP_NDF_NAME(_prepared_plain)
#define prepared_row ASP_NDF_NAME(_prepared_row)
#define prepared_tail_at ASP_NDF_NAME(_prepared_tail_at)
#define prepared_tail ASP_NDF_NAME(_prepared_tail)
#define prepared_draw ASP_NDF_NAME(_prepared_draw)
#define prepared_begin ASP_NDF_NAME(_prepared_begin)
#define prepared_facet ASP_NDF_NAME(_prepared_facet)
#define prepared_turn ASP_NDF_NAME(_prepared_turn)
#define prepared_turned ASP_NDF_NAME(_prepared_turned)
#define prepared_step ASP_NDF_NAME(_prepared_step)
#endif

/* t = log(within/beyond), of which NORMAL and TAIL are tables; both shares of any common scale. */
ASP_FN asp_real prepared_share(asp_real within, asp_real beyond)
{
    return aspi_log(aspi_max(within, PREPARED_TINY) / aspi_max(beyond, PREPARED_TINY));
}

/* Where t lies among the cells: x, and y what t is beyond the first of them (negative) or the last. */
ASP_FN asp_v2 prepared_share_at(asp_real t)
{
    asp_real in = aspi_min(aspi_max(t, R(PREPARED_SHARE_FIRST)), R(PREPARED_SHARE_LAST));
    asp_real s = aspi_min(in, R(0.0)) * R(1.0 / PREPARED_WITHIN) + aspi_max(in, R(0.0)) * R(1.0 / PREPARED_BEYOND);
    asp_v2 out;
    out.x = in / aspi_sqrt(R(1.0) + s * s) * R(1.0 / PREPARED_SHARE_STEP) + R(PREPARED_SHARE_ZERO);
    out.y = aspi_min(t, R(PREPARED_SHARE_LEAST)) - in;
    return out;
}

/* Radius of the slope that has the shares of t. */
ASP_FN asp_real prepared_plain(const asp_shape *k, asp_real t)
{
    asp_v2 at = prepared_share_at(t);
    asp_real x = at.x * R(PREPARED_NORMAL_CELLS / PREPARED_SHARE_CELLS);
    asp_real more = aspi_min(at.y, R(0.0)) * k->table[PREPARED_NORMAL_START]
                  + aspi_max(at.y, R(0.0)) * k->table[PREPARED_NORMAL_END];
    return aspi_exp(prepared_spline_at(k->table + PREPARED_NORMAL, PREPARED_NORMAL_CELLS, x) + more);
}

#ifndef PREPARED_OWN_NORMAL
ASP_FN asp_v3 ndf_normal(const asp_shape *k, asp_real u1, asp_real u2)
{
    asp_real last = R(1.0) - (ASP_PRECISION == 64 ? R(0x1p-53) : R(0x1p-24));
    asp_real u = aspi_select(u1 > last, last, u1);
    asp_real r = prepared_plain(k, prepared_share(u, R(1.0) - u));
    asp_v2 t = aspi_sincos2pi(u2);
    asp_v3 m;
    m.x = r * t.x;
    m.y = r * t.y;
    m.z = R(1.0);
    return m;
}
#endif

/* The row of TAIL, in cells, of a view; h and s: its height and length, b = (s T0)^2. */
ASP_FN asp_real prepared_row(const asp_shape *k, asp_real h, asp_real b)
{
    asp_real unit = aspi_max(aspi_sqrt(b) * k->table[PREPARED_NEAR], PREPARED_TINY);
    asp_real y = aspi_min(aspi_log((h + unit) / unit), k->table[PREPARED_FARTHEST]);
    asp_real x = prepared_spline_at(k->table + PREPARED_VIEWS, PREPARED_VIEWS_CELLS, y * k->table[PREPARED_PER_VIEW]);
    return aspi_min(aspi_max(x, R(0.0)), R(PREPARED_VIEW_CELLS));
}

/* TAIL at row and cell. */
ASP_FN asp_real prepared_tail_at(const asp_shape *k, asp_real row, asp_real cell)
{
    int p = prepared_cell(row, PREPARED_VIEW_CELLS), q = prepared_cell(cell, PREPARED_SHARE_CELLS);
    asp_real tp = row - (asp_real)p, tq = cell - (asp_real)q, sp = R(1.0) - tp, sq = R(1.0) - tq;
    asp_v2 wp = prepared_weights(tp), wq = prepared_weights(tq);
    asp_real w0 = sp * sp * sp, w3 = tp * tp * tp, z0 = sq * sq * sq, z3 = tq * tq * tq;
    const asp_real *c = k->table + PREPARED_TAIL;
    int i = p * PREPARED_SHARE_ROW + q;
#define ROW(i) ((c[i] * z0 + c[(i) + 1] * wq.x) + (c[(i) + 2] * wq.y + c[(i) + 3] * z3))
    return (ROW(i) * w0 + ROW(i + PREPARED_SHARE_ROW) * wp.x)
         + (ROW(i + 2 * PREPARED_SHARE_ROW) * wp.y + ROW(i + 3 * PREPARED_SHARE_ROW) * w3);
#undef ROW
}

/* s eta of the slope sqrt(mu^2 + eta^2) with the shares of t among those that are seen from below. */
ASP_FN asp_real prepared_tail(const asp_shape *k, asp_real h, asp_real b, asp_real t)
{
    asp_v2 at = prepared_share_at(t);
    asp_real more = aspi_min(at.y, R(0.0)) * k->table[PREPARED_TAIL_START]
                  + aspi_max(at.y, R(0.0)) * k->table[PREPARED_TAIL_END];
    return aspi_sqrt(h * h + b) * aspi_exp(prepared_tail_at(k, prepared_row(k, h, b), at.x) + more);
}

/* c phi + g sin(phi) from c + g, which for c near -g is all that is left of the two. */
ASP_FN asp_real prepared_turned(asp_real sum, asp_real g, asp_real phi, asp_real sine)
{
    asp_real x = phi * phi;
    asp_real near = phi * x * (R(1.0 / 6.0) - x * (R(1.0 / 120.0) - x * (R(1.0 / 5040.0) - x * R(1.0 / 362880.0))));
    return sum * phi - g * aspi_select(x < R(0.04), near, phi - sine);
}

/* Given the radius the azimuth has density proportional to c + g cos(phi) where that is positive, |phi| < end,
 * and the distribution function F = c phi + g sin(phi), to be brought to t: one step towards it by F's
 * parabola (Cauchy), which also finds the double zero of F' and F - t at the end. sum = c + g, p: cos and sin of phi. */
ASP_FN asp_real prepared_step(asp_real sum, asp_real g, asp_real phi, asp_v2 p, asp_real t)
{
    asp_real miss = t - prepared_turned(sum, g, phi, p.y);
    asp_real less = p.x > R(0.0) ? p.y * p.y / (R(1.0) + aspi_abs(p.x)) : R(1.0) - p.x;
    asp_real slope = aspi_max(sum - g * less, R(0.0));
    asp_real root = slope * slope - R(2.0) * (g * p.y * miss);
    return R(2.0) * miss / aspi_max(slope + aspi_sqrt(aspi_max(root, R(0.0))), R(1e-12));
}

#define PREPARED_SINCOS(x) aspi_sincos2pi((x) * R(0.5 / ASP_PI))

/* cos and sin of the azimuth. c, g: as above, of any common scale; r: sqrt(g^2 - c^2) where that is positive, else
 * not used. The start is 0.2 end away at most; steps bring F to 2e-3, 4e-6, 5e-8, 2e-13 of itself, and the last of
 * them is a turn by a small angle. */
ASP_FN asp_v2 prepared_turn(asp_real c, asp_real g, asp_real r, asp_real u)
{
    asp_real scale = R(1.0) / aspi_max(aspi_abs(c) + g, PREPARED_TINY);
    asp_real a = c * scale, b = g * scale;
    int all = c > g;
    asp_real end = aspi_atan(aspi_select(all, R(0.0), r), aspi_select(all, R(-1.0), -c));
    asp_real t = R(1.0) - R(2.0) * u, f = aspi_abs(t), w = aspi_sqrt(R(1.0) - f);
    asp_real sine_end = aspi_select(all, R(0.0), r * scale);
    asp_real sum = aspi_select(c < R(0.0), sine_end * sine_end, a + b);
    asp_real target = f * prepared_turned(sum, b, end, sine_end / aspi_max(b, R(0.25)));
    /* exact at both ends, and within 1 % for c = -g (2 sin(asin(f)/3)) and c = 0 (asin f) */
    asp_real k = R(0.9) + R(0.084) * aspi_min(a + a, R(0.0));
    asp_real phi = end * (R(1.0) - w * (k + (R(1.0) - k) * (w * w)));
    asp_real d, d2, sine, cosine;
    asp_v2 p = PREPARED_SINCOS(phi), out;
    phi = aspi_min(phi + prepared_step(sum, b, phi, p, target), end);
    p = PREPARED_SINCOS(phi);
#if ASP_PRECISION == 64
    phi = aspi_min(phi + prepared_step(sum, b, phi, p, target), end);
    p = PREPARED_SINCOS(phi);
    phi = aspi_min(phi + prepared_step(sum, b, phi, p, target), end);
    p = PREPARED_SINCOS(phi);
#endif
    d = aspi_min(prepared_step(sum, b, phi, p, target), end - phi);
    d2 = d * d;
    sine = d * (R(1.0) - d2 * (R(1.0 / 6.0) - d2 * R(1.0 / 120.0)));
    cosine = R(1.0) - d2 * (R(0.5) - d2 * (R(1.0 / 24.0) - d2 * R(1.0 / 720.0)));
    out.x = p.x * cosine - p.y * sine;
    out.y = p.y * cosine + p.x * sine;
    out.y = t < R(0.0) ? -out.y : out.y;
    return out;
}

/* A view and what is to be drawn from it: sigma = c + far. The share c of it, if c > 0, is drawn from all normals,
 * and the share `far` from those that a view below the mean plane sees: the integrals over the azimuth of
 * max(0, c + s x) and max(0, -c - s x), x a slope along the view, differ by 2 pi c. The first goes outwards with u1 and
 * the second comes back, so that the map is continuous; given the radius the azimuth is the same for both. They
 * meet at the radius PREPARED_EDGE, where both stop. */
typedef struct prepared_draw {
    asp_real c, s, h, b;
    asp_real most;               /* the largest eta */
    asp_real inner;              /* positive: from all normals */
    asp_real t;                  /* the shares that are drawn */
} prepared_draw;

ASP_FN prepared_draw prepared_begin(const asp_shape *k, asp_v3 v, asp_real u1)
{
    asp_real s2 = v.x * v.x + v.y * v.y;
    asp_real scale = R(1.0) / aspi_sqrt(s2 + v.z * v.z);
    asp_real c = v.z * scale, s = aspi_sqrt(s2) * scale, up = aspi_max(c, R(0.0));
    asp_real b = s * s * k->table[PREPARED_SCALE2];
    asp_real far = prepared_far(k, aspi_abs(c), b), sigma = aspi_select(c > R(0.0), up + far, R(1.0));
    asp_real inner = up - u1 * sigma;
    asp_real edge = s * k->table[PREPARED_EDGE];
    prepared_draw d;
    d.most = aspi_select(c > R(0.0), aspi_sqrt(aspi_max(edge * edge - c * c, R(0.0))), PREPARED_HUGE);
    d.c = c;
    d.s = s;
    d.h = aspi_abs(c);
    d.b = b;
    d.inner = inner;
    d.t = prepared_share(sigma * aspi_select(inner > R(0.0), u1, R(1.0) - u1), aspi_abs(inner));
    return d;
}

/* The normal of the slope x/z at the azimuth that u2 draws; root: sqrt((s x)^2 - (c z)^2), as in prepared_turn. */
ASP_FN asp_v3 prepared_facet(asp_v3 v, asp_real c, asp_real s, asp_real x, asp_real z, asp_real root, asp_real u2)
{
    asp_v2 p = prepared_turn(c * z, s * x, root, u2);
    asp_real s2 = v.x * v.x + v.y * v.y, known = s2 > R(0.0) ? s2 : R(1.0), scale = R(1.0) / aspi_sqrt(known);
    asp_real ax = s2 > R(0.0) ? v.x * scale : R(1.0), ay = v.y * scale;
    asp_v3 m;
    m.x = x * (p.x * ax - p.y * ay);
    m.y = x * (p.x * ay + p.y * ax);
    m.z = z;
    return m;
}

ASP_FN asp_v3 ndf_visible(const asp_shape *k, asp_v3 v, asp_real u1, asp_real u2)
{
    prepared_draw d = prepared_begin(k, v, u1);
    asp_real x, z, root;
    if (d.inner > R(0.0)) {
        x = aspi_min(prepared_plain(k, d.t), k->table[PREPARED_EDGE]);
        z = R(1.0);
        root = aspi_sqrt(aspi_max(d.s * x * (d.s * x) - d.c * d.c, R(0.0)));
    } else {
        asp_real eta = aspi_min(prepared_tail(k, d.h, d.b, d.t), d.most);
        x = aspi_sqrt(d.h * d.h + eta * eta);
        z = d.s;
        root = d.s * eta;
    }
    return prepared_facet(v, d.c, d.s, x, z, root, u2);
}

/* The same in loops over blocks: all as if drawn from all normals, those that are not are then collected and
 * drawn again. */
#define ASP_OWN_VISIBLE_N
ASP_CLONES static void ndf_visible_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT wx,
                                     const asp_real *ASP_RESTRICT wy,
                                     const asp_real *ASP_RESTRICT wz,
                                     const asp_real *ASP_RESTRICT u1,
                                     const asp_real *ASP_RESTRICT u2, asp_real *ASP_RESTRICT mx,
                                     asp_real *ASP_RESTRICT my, asp_real *ASP_RESTRICT mz)
{
    asp_real c[PREPARED_BLOCK], s[PREPARED_BLOCK], b[PREPARED_BLOCK], t[PREPARED_BLOCK];
    asp_real inner[PREPARED_BLOCK], x[PREPARED_BLOCK], z[PREPARED_BLOCK];
    asp_real root[PREPARED_BLOCK], most[PREPARED_BLOCK], far[4][PREPARED_BLOCK];
    int place[PREPARED_BLOCK];
    size_t from, i, count, tails;
    for (from = 0; from < n; from += PREPARED_BLOCK) {
        count = n - from < PREPARED_BLOCK ? n - from : PREPARED_BLOCK;
        for (i = 0; i < count; i++) {
            asp_v3 v = aspi_view(k, aspi_at(wx, wy, wz, from + i));
            prepared_draw d = prepared_begin(k, v, u1[from + i]);
            c[i] = d.c;
            s[i] = d.s;
            b[i] = d.b;
            t[i] = d.t;
            most[i] = d.most;
            inner[i] = d.inner;
            x[i] = aspi_min(prepared_plain(k, d.t), k->table[PREPARED_EDGE]);
            z[i] = R(1.0);
            root[i] = aspi_sqrt(aspi_max(d.s * x[i] * (d.s * x[i]) - d.c * d.c, R(0.0)));
        }
        for (i = tails = 0; i < count; i++) {
            place[tails] = (int)i;
            tails += !(inner[i] > R(0.0));
        }
        for (i = 0; i < tails; i++) {
            int j = place[i];
            far[0][i] = aspi_abs(c[j]);
            far[1][i] = b[j];
            far[2][i] = t[j];
            far[3][i] = most[j];
        }
        for (i = 0; i < tails; i++)
            far[0][i] = aspi_min(prepared_tail(k, far[0][i], far[1][i], far[2][i]), far[3][i]);
        for (i = 0; i < tails; i++) {
            int j = place[i];
            x[j] = aspi_sqrt(c[j] * c[j] + far[0][i] * far[0][i]);
            z[j] = s[j];
            root[j] = s[j] * far[0][i];
        }
        for (i = 0; i < count; i++) {
            asp_v3 v = aspi_view(k, aspi_at(wx, wy, wz, from + i)), m;
            m = aspi_normalize(aspi_facet_back(k, prepared_facet(v, c[i], s[i], x[i], z[i], root[i], u2[from + i])));
            mx[from + i] = m.x;
            my[from + i] = m.y;
            mz[from + i] = m.z;
        }
    }
}
