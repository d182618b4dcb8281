/* student_visible.h - visible normals of the Student-t family: from above by a table of the slope along the view, else
 * by the search; and the loops
 *
 * Read by student_kernel.h. */

#ifndef STUDENT_VISIBLE_NAMES
#define STUDENT_VISIBLE_NAMES
#define student_place ASP_NDF_NAME(_place)
#define student_view_place ASP_NDF_NAME(_view_place)
#define student_along_place ASP_NDF_NAME(_along_place)
#define student_slope ASP_NDF_NAME(_slope)
#define student_turned ASP_NDF_NAME(_turned)
#define student_long_way ASP_NDF_NAME(_long_way)
#define student_start_n ASP_NDF_NAME(_start_n)
#define student_step_n ASP_NDF_NAME(_step_n)
#define student_views_n ASP_NDF_NAME(_views_n)
#define student_above_n ASP_NDF_NAME(_above_n)
#define student_both_n ASP_NDF_NAME(_both_n)
#define student_any_n ASP_NDF_NAME(_any_n)
#define student_long_n ASP_NDF_NAME(_long_n)
#define student_rest_n ASP_NDF_NAME(_rest_n)
#define student_margin ASP_NDF_NAME(_margin)
#define student_margins_n ASP_NDF_NAME(_margins_n)
#define student_near ASP_NDF_NAME(_near)
#define student_near_n ASP_NDF_NAME(_near_n)
#define student_see_n ASP_NDF_NAME(_see_n)
#define student_aim_n ASP_NDF_NAME(_aim_n)
#define student_slope_n ASP_NDF_NAME(_slope_n)
#define student_quantile_n ASP_NDF_NAME(_quantile_n)
#define student_turned_n ASP_NDF_NAME(_turned_n)
#endif

/* Where STUDENT_PATCHES has a view from above and u1 (student.h): .x and .y within the patch `at`. */
typedef struct student_place {
    asp_real x, y;
    int at;
} student_place;

ASP_FN student_place student_view_place(const asp_shape *k, asp_real c, asp_real s)
{
    const asp_real whole = ASP_PRECISION == 64 ? R(0x1.8p52) : R(0x1.8p23);
    asp_real side = k->table[STUDENT_VIEW] * s;
    asp_real part = side / aspi_max(aspi_max(c, R(0.0)) + side, ASP_SMALLEST);
    asp_real all = k->table[STUDENT_VIEW + 1] * part + k->table[STUDENT_VIEW + 2] * aspi_sqrt(part);
    asp_real t = (R(1.0) - all) * k->table[STUDENT_VIEWS];
    /* the whole part, also of the largest t */
    asp_real cell = (t * R(1.0 - 0x1p-20) - R(0.5)) + whole;
    student_place p;
    p.x = R(0.0);
    p.y = R(2.0) * (t - (cell - whole)) - R(1.0);
    p.at = (int)(aspi_to_bits(cell) & 7);
    return p;
}

/* The same with u1, of which z is the table's STUDENT_ALONG. */
ASP_FN student_place student_along_place(const asp_shape *k, student_place p, asp_real z, asp_real u1)
{
    /* read here: a table entry inside a selection would be a conditional load */
    const asp_real *e = k->table + STUDENT_EDGES, *w = k->table + STUDENT_SCALES;
    asp_real l1 = e[0], l2 = e[1], r1 = e[2], r2 = e[3];
    asp_real w0 = w[0], w1 = w[1], w2 = w[2], w3 = w[3], w4 = w[4], w5 = w[5];
    int views = (int)k->table[STUDENT_VIEWS], first = (int)k->table[STUDENT_RIGHT];
    int right = u1 > R(0.5);
    asp_real second = right ? r1 : l1, third = right ? r2 : l2;
    asp_real scale = z > third ? (right ? w5 : w2) : z > second ? (right ? w4 : w1) : right ? w3 : w0;
    asp_real from = z > third ? third : z > second ? second : R(0.0);
    p.x = (z - from) * scale - R(1.0);
    p.at += (right ? first : 0) + (z > second ? views : 0) + (z > third ? views : 0);
    return p;
}

/* The point of the signed r. */
ASP_FN asp_v2 student_slope(const asp_shape *k, asp_real r)
{
    asp_v2 p;
#if STUDENT_GAUSSIAN
    (void)k;
    p.x = r;
    p.y = R(1.0);
#else
    p = student_point(r * r, k->table[STUDENT_N], k->table[STUDENT_INVN]);
    p.x = r < R(0.0) ? -p.x : p.x;
#endif
    return p;
}

/* The normal of the slope along (the point p, p.x < 0 towards the view) and the slope across, turned to the view's
 * azimuth; any azimuth for a view along the normal. Longer by the square of the view's horizontal length s. What
 * would face away is edge-on. */
ASP_FN asp_v3 student_turned(asp_v2 p, asp_v2 across, asp_v3 v, asp_real s)
{
    int aside = !(s <= (ASP_PRECISION == 64 ? R(1e-50) : R(1e-6)));
    asp_real ax = aside ? v.x : R(1.0), ay = aside ? v.y : R(0.0), length = aside ? s : R(1.0);
    asp_real edge = aside ? -(p.y * v.z) : -ASP_STEEPEST;
    asp_real along = aspi_max(p.x * length, edge) * across.y;
    asp_real over = across.x * length;
    asp_v3 m;
    m.x = along * ax - over * ay;
    m.y = along * ay + over * ax;
    m.z = p.y * across.y * (length * length);
    return m;
}

/* Steps: the search's error falls from 1e-1 to 1e-4, 1e-10 ... of u1 for gamma > 1.6, one step later at
 * 1.501. The distribution function of the slope along the view at what comes out is u1 within 1e-6
 * (float32; 3e-6 below gamma 1.51) and 1e-11; across it is u2 within 2e-7 and 1e-14. */
#define STUDENT_MORE_STEPS (ASP_PRECISION == 64 ? 3 : 2)

ASP_FN asp_v2 student_long_way(const asp_shape *k, asp_v3 v, asp_real u1)
{
    student_search a = student_start(k, v, u1);
    a.r = student_step(k, a, 1);
    a.r = student_step(k, a, 0);
    a.r = student_step(k, a, 0);
#if ASP_PRECISION == 64
    a.r = student_step(k, a, 0);
#endif
    return student_slope(k, a.side * a.r);
}

/* Negative where the table does not lead to the slope. In float64 two steps start from it, which do not reach what is
 * left of the distribution function close to its ends; in float32 it is the slope. */
ASP_FN asp_real student_margin(asp_real vz, asp_real u1)
{
#if ASP_PRECISION == 64
    return aspi_min(vz, aspi_min(u1 - ASP_OCTAVES_LEAST, R(1.0 - 0x1p-17) - u1));
#else
    (void)u1;
    return vz;
#endif
}

#if ASP_PRECISION == 64
/* The search from r, which has the sign of -x. */
ASP_FN asp_real student_near(const asp_shape *k, asp_v3 v, asp_real u1, asp_real r)
{
    student_search a = student_start(k, v, u1);
    a.r = aspi_max(a.side * r, R(1e-12));
    a.r = student_step(k, a, 0);
    a.r = student_step(k, a, 0);
    return a.side * a.r;
}
#endif

ASP_FN asp_v3 ndf_visible(const asp_shape *k, asp_v3 v, asp_real u1, asp_real u2)
{
    asp_v2 across = student_across(k, student_quantile(k, u2), u2);
    asp_real s = aspi_sqrt(v.x * v.x + v.y * v.y);
    if (k->table[STUDENT_SHORT] > R(0.0) && !(student_margin(v.z, u1) < R(0.0))) {
        student_place p = student_along_place(k, student_view_place(k, v.z, s),
                                              aspi_octaves(k->table + STUDENT_ALONG, u1), u1);
        asp_real r = aspi_patch(k->table + STUDENT_PATCHES, p.at, p.x, p.y);
#if ASP_PRECISION == 64
        r = student_near(k, v, u1, r);
#endif
        return student_turned(student_slope(k, r), across, v, s);
    }
    return student_turned(student_long_way(k, v, u1), across, v, s);
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

/* The signed r by the search. */
ASP_FN void student_long_n(size_t n, BLOCK, OUT r)
{
    size_t i;
    for (i = 0; i < n; i++)
        r[i] = f[2][i] * f[5][i];
}

ASP_FN void student_see_n(const asp_shape *k, size_t n, IN vx, IN vy, IN vz, OUT s, OUT y, int *ASP_RESTRICT at)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_real length = aspi_sqrt(vx[i] * vx[i] + vy[i] * vy[i]);
        student_place p = student_view_place(k, vz[i], length);
        s[i] = length;
        y[i] = p.y;
        at[i] = p.at;
    }
}

ASP_FN void student_aim_n(const asp_shape *k, size_t n, IN z, IN u1, int *ASP_RESTRICT at, OUT x)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        student_place p;
        p.x = R(0.0);
        p.y = R(0.0);
        p.at = at[i];
        p = student_along_place(k, p, z[i], u1[i]);
        x[i] = p.x;
        at[i] = p.at;
    }
}

/* The signed r by the search where the table did not lead to it. */
ASP_FN void student_rest_n(size_t n, IN vz, IN u1, BLOCK, OUT r)
{
    size_t i;
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_real found = f[2][i] * f[5][i], kept = r[i];
        r[i] = student_margin(vz[i], u1[i]) < R(0.0) ? found : kept;
    }
}

#if ASP_PRECISION == 32
#else
ASP_FN void student_quantile_n(const asp_shape *k, size_t n, IN u2, OUT q)
{
    size_t i;
    for (i = 0; i < n; i++)
        q[i] = student_quantile(k, u2[i]);
}

ASP_FN asp_bits student_margins_n(size_t n, IN vz, IN u1)
{
    asp_bits any = 0;
    size_t i;
    for (i = 0; i < n; i++)
        any |= aspi_to_bits(student_margin(vz[i], u1[i]));
    return any >> (8 * sizeof any - 1);
}

/* The equations, and as first r the table's. */
ASP_FN void student_near_n(const asp_shape *k, size_t n, IN vx, IN vy, IN vz, IN u1, IN r, BLOCK)
{
    size_t i;
    for (i = 0; i < n; i++) {
        student_search a = student_start(k, aspi_vector(vx[i], vy[i], vz[i]), u1[i]);
        a.r = aspi_max(a.side * r[i], R(1e-12));
        STUDENT_STORE(a, f, i)
        f[6][i] = a.turn;
        f[7][i] = a.r_view;
    }
}
#endif

ASP_FN void student_slope_n(const asp_shape *k, size_t n, IN r, OUT x, OUT y)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v2 p = student_slope(k, r[i]);
        x[i] = p.x;
        y[i] = p.y;
    }
}

ASP_FN void student_turned_n(const asp_shape *k, size_t n, IN px, IN py, IN q, IN u2, IN vx, IN vy, IN vz,
                             OUT mx, OUT my, OUT mz)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v2 p, across = student_across(k, q[i], u2[i]);
        asp_real s = aspi_sqrt(vx[i] * vx[i] + vy[i] * vy[i]);
        asp_v3 m;
        p.x = px[i];
        p.y = py[i];
        m = student_turned(p, across, aspi_vector(vx[i], vy[i], vz[i]), s);
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
    asp_real f[8][STUDENT_BLOCK], v[3][STUDENT_BLOCK], r[STUDENT_BLOCK], p[2][STUDENT_BLOCK], q[STUDENT_BLOCK];
    int is_short = k->table[STUDENT_SHORT] > R(0.0), rest, step, at[STUDENT_BLOCK];
    size_t from, m;
    const asp_real *tables = k->table + STUDENT_ACROSS, *ready = NULL, *along = NULL, *patches = NULL;
#if ASP_PRECISION == 32
    asp_real copy[STUDENT_TABLES + ASP_PATCHES_SPARE];
    if (n >= STUDENT_BLOCK)
        ready = aspi_patches_ready(tables, 2, STUDENT_TABLES, copy);
    if (ready) {
        along = ready + (STUDENT_ALONG - STUDENT_ACROSS);
        patches = ready + (STUDENT_PATCHES - STUDENT_ACROSS);
    }
#endif
    for (from = 0; from < n; from += STUDENT_BLOCK) {
        m = n - from < STUDENT_BLOCK ? n - from : STUDENT_BLOCK;
        rest = student_views_n(k, m, R(1.0), wx + from, wy + from, wz + from, v[0], v[1], v[2]);
        if (is_short) {
            student_see_n(k, m, v[0], v[1], v[2], f[0], f[1], at);
            aspi_octaves_n(k->table + STUDENT_ALONG, along, m, u1 + from, f[2]);
            student_aim_n(k, m, f[2], u1 + from, at, f[3]);
            aspi_patches_n(k->table + STUDENT_PATCHES, patches, m, at, f[3], f[1], r);
        }
#if ASP_PRECISION == 32
        aspi_octaves_n(tables, ready, m, u2 + from, q);
#else
        (void)tables;
        (void)ready;
        student_quantile_n(k, m, u2 + from, q);
        if (is_short) {
            rest = (int)student_margins_n(m, v[2], u1 + from);
            student_near_n(k, m, v[0], v[1], v[2], u1 + from, r, f);
            student_step_n(k, m, 0, f);
            student_step_n(k, m, 0, f);
            student_long_n(m, f, r);
        }
#endif
        if (rest || !is_short) {
            student_start_n(k, m, v[0], v[1], v[2], u1 + from, f);
            student_step_n(k, m, 1, f);
            for (step = 0; step < STUDENT_MORE_STEPS; step++)
                student_step_n(k, m, 0, f);
            if (is_short)
                student_rest_n(m, v[2], u1 + from, f, r);
            else
                student_long_n(m, f, r);
        }
        student_slope_n(k, m, r, p[0], p[1]);
        student_turned_n(k, m, p[0], p[1], q, u2 + from, v[0], v[1], v[2], mx + from, my + from, mz + from);
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
