/* prepared_tail.h - slopes seen from below a prepared surface, from VIEWS and TAIL; read by prepared_kernel.h
 *
 * Single elements of four neighbouring numbers: compilers that vectorised over elements would read them one by one. */

#ifndef PREPARED_TAIL_NAMES
#define PREPARED_TAIL_NAMES
#define prepared_four ASP_NDF_NAME(_prepared_four)
#define prepared_views_at ASP_NDF_NAME(_prepared_views_at)
#define prepared_tail_at ASP_NDF_NAME(_prepared_tail_at)
#define prepared_far_view ASP_NDF_NAME(_prepared_far_view)
#define prepared_tail_place ASP_NDF_NAME(_prepared_tail_place)
#endif

/* Four numbers: as one where the compiler has them. */
#if defined(__GNUC__) && !defined(__CUDACC__) && !defined(__CUDA__)
typedef asp_real prepared_four __attribute__((vector_size(4 * sizeof(asp_real))));
#define FOUR_READ(to, from) memcpy(&(to), (from), sizeof(to))
#define FOUR_WEIGHTS(w, t) do { \
        const prepared_four k0_ = { 1, 4, 1, 0 }, k1_ = { -3, 0, 3, 0 }, k2_ = { 3, -6, 3, 0 }, k3_ = { -1, 3, -3, 1 }; \
        (w) = k0_ + (k1_ + (k2_ + k3_ * (t)) * (t)) * (t); \
    } while (0)
#define FOUR_ROWS(out, r, w) \
    ((out) = ((r)[0] * (w)[0] + (r)[1] * (w)[1]) + ((r)[2] * (w)[2] + (r)[3] * (w)[3]))
#define FOUR_TIMES(out, r, w) ((out) = (r) * (w))
#define FOUR_SUM(v) (((v)[0] + (v)[1]) + ((v)[2] + (v)[3]))
#else
typedef struct prepared_four { asp_real v[4]; } prepared_four;
#define FOUR_READ(to, from) memcpy((to).v, (from), sizeof (to).v)
#define FOUR_WEIGHTS(w, t) do { \
        static const asp_real k_[4][4] = { { 1, 4, 1, 0 }, { -3, 0, 3, 0 }, { 3, -6, 3, 0 }, { -1, 3, -3, 1 } }; \
        int j_; \
        for (j_ = 0; j_ < 4; j_++) \
            (w).v[j_] = k_[0][j_] + (k_[1][j_] + (k_[2][j_] + k_[3][j_] * (t)) * (t)) * (t); \
    } while (0)
#define FOUR_ROWS(out, r, w) do { \
        int j_; \
        for (j_ = 0; j_ < 4; j_++) \
            (out).v[j_] = ((r)[0].v[j_] * (w).v[0] + (r)[1].v[j_] * (w).v[1]) \
                        + ((r)[2].v[j_] * (w).v[2] + (r)[3].v[j_] * (w).v[3]); \
    } while (0)
#define FOUR_TIMES(out, r, w) do { \
        int j_; \
        for (j_ = 0; j_ < 4; j_++) \
            (out).v[j_] = (r).v[j_] * (w).v[j_]; \
    } while (0)
#define FOUR_SUM(x) (((x).v[0] + (x).v[1]) + ((x).v[2] + (x).v[3]))
#endif

/* Where a view and the odds of what is drawn from it stand in VIEWS and TAIL, in cells and how far within, and what
 * t = log(odds^2) is beyond the first or the last cell, times TAIL's slope there; s sqrt(mu^2 + T0^2), the unit. */
typedef struct prepared_far_view {
    int view, share;
    asp_real in_view, in_share, more, unit;
} prepared_far_view;

/* The row of TAIL, in cells, of a view t into cell i of VIEWS: a uniform cubic B-spline, of which the four weights
 * times 6 are polynomials. */
ASP_FN asp_real prepared_views_at(const asp_shape *k, int i, asp_real t)
{
    asp_real row;
    prepared_four w, c;
    FOUR_WEIGHTS(w, t);
    FOUR_READ(c, k->table + PREPARED_VIEWS + i);
    FOUR_TIMES(c, c, w);
    row = FOUR_SUM(c);
    return aspi_min(aspi_max(row, R(0.0)), R(PREPARED_VIEW_CELLS(PREPARED_BENDS)));
}

/* TAIL there. */
ASP_FN asp_real prepared_tail_at(const asp_shape *k, int view, asp_real in_view, int share, asp_real in_share)
{
    asp_real row = prepared_views_at(k, view, in_view);
    int i = prepared_cell(row, PREPARED_VIEW_CELLS(PREPARED_BENDS)), j;
    asp_real in_row = row - (asp_real)i;
    const asp_real *from = k->table + PREPARED_TAIL + (i * PREPARED_SHARE_ROW(PREPARED_BENDS) + share);
    prepared_four r[4], w, z, v;
    FOUR_WEIGHTS(w, in_row);
    FOUR_WEIGHTS(z, in_share);
    for (j = 0; j < 4; j++)
        FOUR_READ(r[j], from + j * PREPARED_SHARE_ROW(PREPARED_BENDS));
    FOUR_ROWS(v, r, w);
    FOUR_TIMES(v, v, z);
    return FOUR_SUM(v);
}

ASP_FN prepared_far_view prepared_tail_place(const asp_shape *k, asp_real h, asp_real s, asp_real odds)
{
    asp_real t = R(2.0) * aspi_log(odds), a = s * k->table[PREPARED_SCALE];
    asp_real near = aspi_max(a * k->table[PREPARED_NEAR], PREPARED_TINY);
    asp_real y = aspi_min(aspi_log((h + near) / near), k->table[PREPARED_FARTHEST]);
    asp_real in = aspi_min(aspi_max(t, R(PREPARED_SHARE_FIRST)), R(PREPARED_SHARE_LAST));
    asp_real z = aspi_min(in, R(0.0)) * R(1.0 / PREPARED_WITHIN) + aspi_max(in, R(0.0)) * R(1.0 / PREPARED_BEYOND);
    asp_real beyond = aspi_min(t, R(PREPARED_SHARE_LEAST)) - in;
    prepared_far_view out;
    y = y * k->table[PREPARED_PER_VIEW];
    z = in / aspi_sqrt(R(1.0) + z * z) * R(1.0 / PREPARED_SHARE_STEP(PREPARED_BENDS)) + R(PREPARED_SHARE_ZERO(PREPARED_BENDS));
    out.view = prepared_cell(y, PREPARED_VIEWS_CELLS);
    out.share = prepared_cell(z, PREPARED_SHARE_CELLS(PREPARED_BENDS));
    out.in_view = y - (asp_real)out.view;
    out.in_share = z - (asp_real)out.share;
    out.more = aspi_min(beyond, R(0.0)) * k->table[PREPARED_TAIL_START]
             + aspi_max(beyond, R(0.0)) * k->table[PREPARED_TAIL_END];
    out.unit = aspi_sqrt(h * h + a * a);
    return out;
}
#undef FOUR_READ
#undef FOUR_WEIGHTS
#undef FOUR_ROWS
#undef FOUR_TIMES
#undef FOUR_SUM
