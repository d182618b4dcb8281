/* student_visible.h - visible normals of the Student-t family: from above by a prepared first guess and
 * one step in float32, else by the search; and the loops
 *
 * Read by student_kernel.h. */

#ifndef STUDENT_VISIBLE_NAMES
#define STUDENT_VISIBLE_NAMES
#define student_guess ASP_NDF_NAME(_guess)
#define student_near ASP_NDF_NAME(_near)
#define student_turned ASP_NDF_NAME(_turned)
#define student_long_way ASP_NDF_NAME(_long_way)
#define student_seen ASP_NDF_NAME(_seen)
#define student_see ASP_NDF_NAME(_see)
#define student_aim ASP_NDF_NAME(_aim)
#define student_see_n ASP_NDF_NAME(_see_n)
#define student_aim_n ASP_NDF_NAME(_aim_n)
#define student_guess_n ASP_NDF_NAME(_guess_n)
#define student_height ASP_NDF_NAME(_height)
#define student_point_n ASP_NDF_NAME(_point_n)
#define student_quantile_n ASP_NDF_NAME(_quantile_n)
#define student_near_n ASP_NDF_NAME(_near_n)
#define student_start_n ASP_NDF_NAME(_start_n)
#define student_step_n ASP_NDF_NAME(_step_n)
#define student_long_n ASP_NDF_NAME(_long_n)
#define student_across_n ASP_NDF_NAME(_across_n)
#define student_turned_n ASP_NDF_NAME(_turned_n)
#define student_above_n ASP_NDF_NAME(_above_n)
#define student_both_n ASP_NDF_NAME(_both_n)
#define student_any_n ASP_NDF_NAME(_any_n)
#define student_views_n ASP_NDF_NAME(_views_n)
/* Polynomial in x with coefficients of two tables, one or the other; picked by bits, as a selection
 * would be taken for a conditional load. */
#define STUDENT_PICK(i) \
    aspi_from_bits((asp_bits)((aspi_to_bits(cr[i]) & pick) | (aspi_to_bits(cl[i]) & (asp_bits)~pick)))
#define STUDENT_ROW(j) \
    (((((STUDENT_PICK((j) * 6 + 5) * x + STUDENT_PICK((j) * 6 + 4)) * x + STUDENT_PICK((j) * 6 + 3)) * x \
       + STUDENT_PICK((j) * 6 + 2)) * x + STUDENT_PICK((j) * 6 + 1)) * x + STUDENT_PICK((j) * 6))
#endif

#if ASP_PRECISION == 32
/* A view from above and u1: c, s, side (1 left, -1 right), shift and t as in student_search, and the
 * first r. Left and right meet where the share of the slopes below 0 is reached, `all`. The guess's
 * argument is -log sqrt(y/y_0) on the left, and on the right, where y has a double zero at the view's
 * own slope, -log((sqrt y + e)/(sqrt y_0 + e)) with e^2 = 2 far, far the area turned away, which ends
 * there. r is nearly a root of a quadratic in it; their ratio is a polynomial in that root and the view
 * (student_guess.c). */
typedef struct student_seen {
    asp_real c, s, sigma, inv_all, y;   /* 1/all; the polynomial's argument of the view */
} student_seen;

ASP_FN student_seen student_see(const asp_shape *k, asp_v3 v)
{
    asp_real s2 = v.x * v.x + v.y * v.y, s = aspi_sqrt(s2), c = aspi_max(v.z, R(0.0));
    asp_real all = R(0.5) * c + s * k->table[STUDENT_M0], seen = c + R(STUDENT_VIEW) * s;
    asp_real den = student_above_denominator(k, c, s2), both = all * seen;
    asp_real inverse = R(1.0) / aspi_max(den * both, R(1e-37));
    asp_real view = den * all * inverse * c;
    student_seen o;
    o.c = c;
    o.s = s;
    o.sigma = student_above(k, c, den, both * inverse * c);
    o.inv_all = den * seen * inverse;
    o.y = (view + view) - R(1.0);
    return o;
}

/* .r: the quadratic's root. */
ASP_FN student_search student_aim(const asp_shape *k, student_seen o, asp_real u1)
{
    const asp_real *g = k->table + STUDENT_SCALE_RIGHT;
    asp_real u = aspi_max(u1, R(STUDENT_LEAST_32)), rest = aspi_max(R(1.0) - u1, R(STUDENT_LEAST_32));
    asp_real share = u * o.sigma * o.inv_all, y = o.y;
    int is_right = share > R(1.0);
    asp_real t = aspi_select(is_right, rest, u) * o.sigma;
    asp_real far = aspi_max(o.sigma - o.c, R(0.0)), shift = aspi_select(is_right, far, R(0.0));
    STUDENT_START(y, g, 13)
    STUDENT_STEP(g, 10)
    STUDENT_STEP5(g, 0)
    asp_real scale = aspi_select(is_right, odd * y + even, R(1.0));
    asp_real part = (aspi_sqrt(t * o.inv_all) + aspi_sqrt((shift + shift) * o.inv_all)) * scale;
    asp_real exponent = -aspi_log(aspi_max(part, R(1e-37)));
    asp_real within = aspi_min(aspi_max(exponent, R(0.0)), R(STUDENT_FAR_END));
    asp_real left = R(2.0) * k->table[STUDENT_T0] * (o.c * o.inv_all);
    asp_real b = aspi_select(is_right, R(STUDENT_SLOPE), left);
    student_search a;
    a.r = aspi_sqrt(b * b + R(8.0) * within) - b;
    a.c = o.c;
    a.s = o.s;
    a.side = aspi_select(is_right, R(-1.0), R(1.0));
    a.shift = shift;
    a.t = aspi_max(t, R(1e-37));
    a.turn = R(1.0);
    a.r_view = R(0.0);
    return a;
}

/* The first r from the quadratic's root. */
ASP_FN asp_real student_guess(const asp_shape *k, asp_real root, asp_real side, asp_real y)
{
    const asp_real *cl = k->table + STUDENT_LEFT, *cr = k->table + STUDENT_RIGHT;
    asp_real end_left = k->table[STUDENT_END], end_right = k->table[STUDENT_END + 1];
    asp_real x = root * (side < R(0.0) ? end_right : end_left) - R(1.0);
    asp_bits pick = (asp_bits)((asp_bits)0 - (asp_bits)(side < R(0.0)));
    asp_real p0 = STUDENT_ROW(0), p1 = STUDENT_ROW(1), p2 = STUDENT_ROW(2), p3 = STUDENT_ROW(3);
    asp_real p4 = STUDENT_ROW(4);
    return aspi_max(root * ((((p4 * y + p3) * y + p2) * y + p1) * y + p0), R(0.0));
}

/* W^(2n - 2) at the point of r */
ASP_FN asp_real student_height(const asp_shape *k, asp_real r)
{
#if STUDENT_GAUSSIAN
    (void)k;
    return aspi_exp(-(r * r));
#else
    return aspi_exp(-(r * r) * k->table[STUDENT_ONE_LESS]);
#endif
}

/* One step of Halley's method for y = t in the angle whose tangent is x/sqrt n, times sqrt n; the point
 * of the slope is turned by it. Takes and returns (x W, W), W = cos; e = W^(2n - 2); for the Gaussian W = 1. The error
 * falls from 3e-3 of u1 to 2e-7 (gamma 2: 6e-7). */
ASP_FN asp_v2 student_near(const asp_shape *k, student_search a, asp_v2 p, asp_real e)
{
    asp_real t0 = k->table[STUDENT_T0], ss = a.side * a.s;
#if STUDENT_GAUSSIAN
    asp_real two = R(2.0), invn = R(0.0);
#else
    asp_real two = k->table[STUDENT_ONE_LESS] + k->table[STUDENT_ONE_LESS], invn = k->table[STUDENT_INVN];
#endif
    asp_real d = R(STUDENT_A) / (R(STUDENT_A) + p.x);
    asp_real value = e * (p.y * (a.c * (t0 * p.y * (d * student_b(k, d))) + ss * k->table[STUDENT_M0]));
    asp_real y = aspi_max(value + a.shift, R(0.05) * a.t);
    asp_real f = y - a.t;
    /* -y'/(2 T0 e) and its derivative */
    asp_real slope = a.c * p.y + ss * p.x;
    asp_real bend = ss * p.y - a.c * p.x * invn;
    asp_real sw = slope * p.y, fw = f * p.y;
    asp_real over = R(4.0) * t0 * (e * (slope * sw)) + f * (p.y * bend - two * (p.x * slope));
    /* at most three quarters of the way to the view's own slope; from behind it, back */
    asp_real by = aspi_max(over, R(2.6667) * aspi_abs(fw * bend));
    asp_real step = (slope > R(0.0) ? R(2.0) * (f * sw) : R(1.25) * slope)
                  / aspi_max(slope > R(0.0) ? by : aspi_abs(bend), R(1e-37));
    asp_v2 out;
#if STUDENT_GAUSSIAN
    out.x = p.x + step;
    out.y = p.y;
#else
    asp_real z = step * step * invn;
    asp_real cs = R(1.0) - z * (R(0.5) - z * (R(1.0 / 24) - z * R(1.0 / 720)));
    asp_real sn = step * (R(1.0) - z * (R(1.0 / 6) - z * (R(1.0 / 120) - z * R(1.0 / 5040))));
    out.x = p.x * cs + p.y * sn;
    out.y = aspi_max(p.y * cs - p.x * sn * invn, R(0.1) * p.y);
#endif
    return out;
}

#endif

/* The normal of the slope along (the point p on its side) and the slope across, turned to the view's
 * azimuth; any azimuth for a view along the normal. Longer by the view's horizontal length. */
ASP_FN asp_v3 student_turned(const asp_shape *k, asp_v2 p, asp_real side, asp_v2 across, asp_v3 v)
{
    asp_real along = side * p.x * across.y;
    asp_real over = across.x * k->table[STUDENT_Y_WIDTH];
    asp_real s = aspi_sqrt(v.x * v.x + v.y * v.y);
    int aside = s > (ASP_PRECISION == 64 ? R(1e-100) : R(1e-12));
    asp_real ax = aside ? v.x : R(1.0), ay = aside ? v.y : R(0.0);
    asp_v3 m;
    m.x = along * ax - over * ay;
    m.y = along * ay + over * ax;
    m.z = p.y * across.y * (aside ? s : R(1.0));
    return m;
}

/* Steps: the search's error falls from 1e-1 to 1e-4, 1e-10 ... of u1 for gamma > 1.6, one step later at
 * 1.501. The distribution function of the slope along the view at what comes out is u1 within 1e-6
 * (float32; 3e-6 below gamma 1.51) and 1e-11; across it is u2 within 1e-7 and 1e-14. */
#define STUDENT_MORE_STEPS (ASP_PRECISION == 64 ? 3 : 2)

ASP_FN asp_v3 student_long_way(const asp_shape *k, asp_v3 v, asp_real u1, asp_v2 across)
{
    student_search a = student_start(k, v, u1);
    a.r = student_step(k, a, 1);
    a.r = student_step(k, a, 0);
    a.r = student_step(k, a, 0);
#if ASP_PRECISION == 64
    a.r = student_step(k, a, 0);
#endif
    return student_turned(k, student_point(a.r * a.r, k->table[STUDENT_N], k->table[STUDENT_INVN]), a.side,
                          across, v);
}

/* float64 keeps the search: two steps from the guess would leave 1e-10. */
ASP_FN asp_v3 ndf_visible(const asp_shape *k, asp_v3 v, asp_real u1, asp_real u2)
{
    asp_v2 across = student_across(k, student_quantile(k, u2), u2);
#if ASP_PRECISION == 32
    if (k->table[STUDENT_SHORT] > R(0.0) && !(v.z < R(0.0))) {
        student_seen o = student_see(k, v);
        student_search a = student_aim(k, o, u1);
        asp_v2 p;
        a.r = student_guess(k, a.r, a.side, o.y);
        p = student_point(a.r * a.r, k->table[STUDENT_N], k->table[STUDENT_INVN]);
        return student_turned(k, student_near(k, a, p, student_height(k, a.r)), a.side, across, v);
    }
#endif
    return student_long_way(k, v, u1, across);
}

/* ---- loops over blocks, stage by stage: in one loop each element would be a chain of a thousand
 * operations, too long for the processor to overlap with the next */

#define STUDENT_BLOCK 128
#define IN const asp_real *ASP_RESTRICT
#define OUT asp_real *ASP_RESTRICT
#define BLOCK asp_real (*ASP_RESTRICT f)[STUDENT_BLOCK]
#define STUDENT_STORE(a, f, i) \
    f[0][i] = a.c; f[1][i] = a.s; f[2][i] = a.side; f[3][i] = a.shift; f[4][i] = a.t; f[5][i] = a.r;
#define STUDENT_LOAD(a, f, i) \
    a.c = f[0][i]; a.s = f[1][i]; a.side = f[2][i]; a.shift = f[3][i]; a.t = f[4][i]; a.r = f[5][i];

/* The views of a block; whether one of them looks from below. */
ASP_FN int student_views_n(const asp_shape *k, size_t n, asp_real sign, IN wx, IN wy, IN wz, OUT vx, OUT vy,
                           OUT vz)
{
    asp_bits any = 0;
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v3 v = aspi_view(k, aspi_vector(sign * wx[i], sign * wy[i], sign * wz[i]));
        vx[i] = v.x;
        vy[i] = v.y;
        vz[i] = v.z;
        any |= aspi_to_bits(v.z);
    }
    return (int)(any >> (8 * sizeof any - 1));
}

ASP_FN void student_start_n(const asp_shape *k, size_t n, IN vx, IN vy, IN vz, IN u1, BLOCK)
{
    size_t i;
    for (i = 0; i < n; i++) {
        student_search a = student_start(k, aspi_vector(vx[i], vy[i], vz[i]), u1[i]);
        STUDENT_STORE(a, f, i)
        f[6][i] = a.turn;
        f[7][i] = a.r_view;
    }
}

ASP_FN void student_step_n(const asp_shape *k, size_t n, int logs, BLOCK)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        student_search a;
        STUDENT_LOAD(a, f, i)
        a.turn = f[6][i];
        a.r_view = f[7][i];
        f[5][i] = student_step(k, a, logs);
    }
}

/* The points and sides by the search, of all or only of the views from below. */
ASP_FN void student_long_n(const asp_shape *k, size_t n, int all, IN vz, BLOCK, OUT x, OUT y, OUT side)
{
    asp_real limit = all ? R(INFINITY) : R(0.0);
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v2 p = student_point(f[5][i] * f[5][i], k->table[STUDENT_N], k->table[STUDENT_INVN]);
        asp_real px = x[i], py = y[i], ps = side[i], ls = f[2][i], z = vz[i];
        x[i] = z < limit ? p.x : px;
        y[i] = z < limit ? p.y : py;
        side[i] = z < limit ? ls : ps;
    }
}

#if ASP_PRECISION == 32
ASP_FN void student_see_n(const asp_shape *k, size_t n, IN vx, IN vy, IN vz, BLOCK)
{
    size_t i;
    for (i = 0; i < n; i++) {
        student_seen o = student_see(k, aspi_vector(vx[i], vy[i], vz[i]));
        f[0][i] = o.c;
        f[1][i] = o.s;
        f[2][i] = o.sigma;
        f[3][i] = o.inv_all;
        f[6][i] = o.y;
    }
}

ASP_FN void student_aim_n(const asp_shape *k, size_t n, IN u1, BLOCK)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        student_seen o;
        student_search a;
        o.c = f[0][i];
        o.s = f[1][i];
        o.sigma = f[2][i];
        o.inv_all = f[3][i];
        o.y = f[6][i];
        a = student_aim(k, o, u1[i]);
        f[2][i] = a.side;
        f[3][i] = a.shift;
        f[4][i] = a.t;
        f[5][i] = a.r;
    }
}

ASP_FN void student_guess_n(const asp_shape *k, size_t n, BLOCK)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++)
        f[5][i] = student_guess(k, f[5][i], f[2][i], f[6][i]);
}

ASP_FN void student_point_n(const asp_shape *k, size_t n, IN r, OUT x, OUT y, OUT e)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v2 p = student_point(r[i] * r[i], k->table[STUDENT_N], k->table[STUDENT_INVN]);
        x[i] = p.x;
        y[i] = p.y;
        e[i] = student_height(k, r[i]);
    }
}

ASP_FN void student_near_n(const asp_shape *k, size_t n, BLOCK, OUT x, OUT y, OUT side)
{
    size_t i;
    for (i = 0; i < n; i++) {
        student_search a;
        asp_v2 p;
        STUDENT_LOAD(a, f, i)
        p.x = x[i];
        p.y = y[i];
        p = student_near(k, a, p, f[6][i]);
        x[i] = p.x;
        y[i] = p.y;
        side[i] = a.side;
    }
}
#endif

ASP_FN void student_quantile_n(const asp_shape *k, size_t n, IN u2, OUT q)
{
    size_t i;
    for (i = 0; i < n; i++)
        q[i] = student_quantile(k, u2[i]);
}

ASP_FN void student_across_n(const asp_shape *k, size_t n, IN q, IN u2, OUT x, OUT y)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v2 across = student_across(k, q[i], u2[i]);
        x[i] = across.x;
        y[i] = across.y;
    }
}

ASP_FN void student_turned_n(const asp_shape *k, size_t n, IN x, IN y, IN side, IN ox, IN oy, IN vx, IN vy,
                             OUT mx, OUT my, OUT mz)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v2 p, across;
        asp_v3 m;
        p.x = x[i];
        p.y = y[i];
        across.x = ox[i];
        across.y = oy[i];
        m = student_turned(k, p, side[i], across, aspi_vector(vx[i], vy[i], R(0.0)));
        m = aspi_normalize(aspi_facet_back(k, m));
        mx[i] = m.x;
        my[i] = m.y;
        mz[i] = m.z;
    }
}

#define ASP_OWN_VISIBLE_N
ASP_CLONES static void ndf_visible_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT wx,
                                     const asp_real *ASP_RESTRICT wy,
                                     const asp_real *ASP_RESTRICT wz,
                                     const asp_real *ASP_RESTRICT u1,
                                     const asp_real *ASP_RESTRICT u2, asp_real *ASP_RESTRICT mx,
                                     asp_real *ASP_RESTRICT my, asp_real *ASP_RESTRICT mz)
{
    asp_real f[8][STUDENT_BLOCK], v[3][STUDENT_BLOCK], p[3][STUDENT_BLOCK], o[2][STUDENT_BLOCK];
    int is_short = ASP_PRECISION == 32 && k->table[STUDENT_SHORT] > R(0.0), below, step;
    size_t from, m;
    for (from = 0; from < n; from += STUDENT_BLOCK) {
        m = n - from < STUDENT_BLOCK ? n - from : STUDENT_BLOCK;
        below = student_views_n(k, m, R(1.0), wx + from, wy + from, wz + from, v[0], v[1], v[2]);
#if ASP_PRECISION == 32
        if (is_short) {
            student_see_n(k, m, v[0], v[1], v[2], f);
            student_aim_n(k, m, u1 + from, f);
            student_guess_n(k, m, f);
            student_point_n(k, m, f[5], p[0], p[1], f[6]);
            student_near_n(k, m, f, p[0], p[1], p[2]);
        }
#endif
        if (below || !is_short) {
            student_start_n(k, m, v[0], v[1], v[2], u1 + from, f);
            student_step_n(k, m, 1, f);
            for (step = 0; step < STUDENT_MORE_STEPS; step++)
                student_step_n(k, m, 0, f);
            student_long_n(k, m, !is_short, v[2], f, p[0], p[1], p[2]);
        }
        student_quantile_n(k, m, u2 + from, f[0]);
        student_across_n(k, m, f[0], u2 + from, o[0], o[1]);
        student_turned_n(k, m, p[0], p[1], p[2], o[0], o[1], v[0], v[1], mx + from, my + from, mz + from);
    }
}

#if ASP_PRECISION == 32
ASP_FN void student_above_n(const asp_shape *k, size_t n, IN vx, IN vy, IN vz, OUT out)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_real den = student_above_denominator(k, vz[i], vx[i] * vx[i] + vy[i] * vy[i]);
        out[i] = student_above(k, vz[i], den, vz[i] / den);
    }
}

ASP_FN void student_both_n(const asp_shape *k, size_t n, IN vx, IN vy, IN vz, OUT out)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_real s2 = vx[i] * vx[i] + vy[i] * vy[i], z = vz[i];
        asp_real den = student_above_denominator(k, z, s2);
        asp_real up = student_above(k, z, den, z / den), any = student_sigma(k, z, s2);
        out[i] = z < R(0.0) ? any : up;
    }
}

ASP_FN void student_any_n(const asp_shape *k, size_t n, IN vx, IN vy, IN vz, OUT out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = student_sigma(k, vz[i], vx[i] * vx[i] + vy[i] * vy[i]);
}

#define ASP_OWN_SIGMA_N
ASP_CLONES static void ndf_sigma_n(const asp_shape *k, size_t n, asp_real sign,
                                   const asp_real *ASP_RESTRICT wx, const asp_real *ASP_RESTRICT wy,
                                   const asp_real *ASP_RESTRICT wz, asp_real *ASP_RESTRICT out)
{
    asp_real v[3][STUDENT_BLOCK];
    int above = k->table[STUDENT_ABOVE] > R(0.0), below;
    size_t from, m;
    for (from = 0; from < n; from += STUDENT_BLOCK) {
        m = n - from < STUDENT_BLOCK ? n - from : STUDENT_BLOCK;
        below = student_views_n(k, m, sign, wx + from, wy + from, wz + from, v[0], v[1], v[2]);
        if (!above)
            student_any_n(k, m, v[0], v[1], v[2], out + from);
        else if (below)
            student_both_n(k, m, v[0], v[1], v[2], out + from);
        else
            student_above_n(k, m, v[0], v[1], v[2], out + from);
    }
}
#endif

#undef IN
#undef OUT
#undef BLOCK
