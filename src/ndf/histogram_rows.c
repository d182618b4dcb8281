/* histogram_rows.c - the formulas of a slope histogram; histogram.h derives them */
#include "ndf/histogram.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"

/* ---- a view in units of cells */

typedef struct cells_sight {
    const double *table;        /* of the first row */
    ptrdiff_t stride;           /* to the next row, towards rows that see more */
    int rows, cols;
    int across, back_s, back_t; /* rows are columns of cells; s, t run backwards */
    double a, b, low;           /* a > 0, b >= 0; h = low + b t */
    double per_a, per_b;
    double farthest, nearest;   /* least and greatest height over the rectangle */
} cells_sight;

static cells_sight cells_look(const aspi_cells *k, asp_vec3 v)
{
    double a = v.x * k->dx, b = v.y * k->dy, swap;
    /* the height at the corner where it is least: exact where both ends of an axis are taken */
    double at_x = a > 0.0 ? k->high_x : k->x0, at_y = b > 0.0 ? k->high_y : k->y0;
    double from_x = a > 0.0 ? k->x0 : k->high_x, from_y = b > 0.0 ? k->y0 : k->high_y;
    aspi_cells_table which;
    cells_sight q;
    q.farthest = v.z - (v.x * at_x + v.y * at_y);
    q.nearest = v.z - (v.x * from_x + v.y * from_y);
    q.across = aspi_abs(b) > aspi_abs(a);
    /* along a row from its near end, at the row that sees least */
    q.low = q.across ? v.z - (v.x * at_x + v.y * from_y) : v.z - (v.x * from_x + v.y * at_y);
    if (q.across) {
        swap = a;
        a = b;
        b = swap;
    }
    q.back_s = a < 0.0;
    q.back_t = b > 0.0;
    q.a = aspi_abs(a);
    q.b = aspi_abs(b);
    q.per_a = q.a > 1e-300 ? 1.0 / q.a : 1e300;
    q.per_b = q.b > 1e-300 ? 1.0 / q.b : 0.0;
    which = q.across ? (q.back_s ? ASPI_FROM_ABOVE : ASPI_FROM_BELOW)
                     : (q.back_s ? ASPI_FROM_RIGHT : ASPI_FROM_LEFT);
    q.rows = q.across ? k->nx : k->ny;
    q.cols = q.across ? k->ny : k->nx;
    q.stride = (ptrdiff_t)aspi_cells_stride(k, which);
    q.table = aspi_cells_at(k, aspi_cells_place(k, which));
    if (q.back_t) {
        q.table += q.stride * (q.rows - 1);
        q.stride = -q.stride;
    }
    return q;
}

/* The part of one row on one side of the edge that its heights cross: in one cell, from e0 to e0 +
 * wide above the cell's edge, g = g0 + g1 x + g2 x^2 over x in [0, 1], every term positive. */
typedef struct cells_piece { double e0, wide, share, g0, g1, g2; } cells_piece;

ASP_FN cells_piece cells_make_piece(double mass, double next, double moment, double e0, double wide,
                                    double share, double a, double per_a)
{
    double bend = 0.5 * (next - mass) * per_a;
    cells_piece p;
    p.e0 = e0;
    p.wide = wide;
    p.share = share;
    p.g0 = a * moment + e0 * (mass + e0 * bend);
    p.g1 = wide * (mass + 2.0 * e0 * bend);
    p.g2 = wide * wide * bend;
    return p;
}

ASP_FN double cells_piece_mean(cells_piece p) { return p.g0 + p.g1 * 0.5 + p.g2 * (1.0 / 3.0); }

/* The cell of height h: -1 before the first, cols behind the last. A NaN is in some cell. */
ASP_FN int cells_of_height(double h, double per_a, double cols)
{
    double s = aspi_max(aspi_min(cols, h * per_a), -1.0);
    return (int)(s + 1.0) - 1;
}

ASP_FN double cells_positive(double x) { return x > 0.0 ? x : 0.0; }

/* Lower and upper piece of the row whose heights run from h0 to h1. Where no edge lies between, or
 * where b is less than a rounding of h, the split falls anywhere: g is continuous. */
ASP_FN cells_piece cells_upper_piece(const double *row, int c, double h0, double h1, double a,
                                     double per_a, double per_b)
{
    double edge = c * a, from = aspi_max(edge, h0);
    double wide = aspi_max(h1 - from, 0.0), share = aspi_min(wide * per_b, 1.0);
    return cells_make_piece(row[2 * c + 2], row[2 * c + 4], row[2 * c + 3], from - edge, wide, share,
                            a, per_a);
}

ASP_FN cells_piece cells_lower_piece(const double *row, int c, int upper, double h0, double share,
                                     double a, double per_a)
{
    double edge = c * a, from = aspi_max(edge, h0), wide = aspi_max(upper * a - from, 0.0);
    return cells_make_piece(row[2 * c + 2], row[2 * c + 4], row[2 * c + 3], from - edge, wide, share,
                            a, per_a);
}

ASP_FN double cells_row_sees(const cells_sight *q, int r)
{
    double h0 = q->low + q->b * r, h1 = q->low + q->b * (r + 1), cols = q->cols;
    int c0 = cells_of_height(h0, q->per_a, cols), c1 = cells_of_height(h1, q->per_a, cols);
    const double *row = q->table + r * q->stride;
    cells_piece upper = cells_upper_piece(row, c1, h0, h1, q->a, q->per_a, q->per_b);
    cells_piece lower = cells_lower_piece(row, c0, c1, h0, 1.0 - upper.share, q->a, q->per_a);
    return upper.share * cells_piece_mean(upper) + lower.share * cells_piece_mean(lower);
}

ASP_CLONES static void cells_rows_see(const cells_sight *q, double *ASP_RESTRICT out)
{
    int i, n = q->rows;
    cells_sight local = *q;
    for (i = 0; i < n; i++)
        out[i] = cells_row_sees(&local, i);
}

double aspi_cells_sigma(const aspi_cells *k, asp_vec3 v)
{
    double seen[ASPI_HISTOGRAM_SIDE], sum[4] = { 0.0, 0.0, 0.0, 0.0 };
    cells_sight q = cells_look(k, v);
    int r;
    if (q.nearest <= 0.0)
        return 0.0;
    if (q.farthest >= 0.0)
        return v.z;                    /* the mean of the slopes is 0 */
    cells_rows_see(&q, seen);
    for (r = 0; r < q.rows; r++)
        sum[r & 3] += seen[r];
    /* infinite or NaN came in: NaN goes out */
    return ((sum[0] + sum[1]) + (sum[2] + sum[3])) + (v.x + v.y + v.z) * 0.0;
}

/* ---- densities */

double aspi_cells_P22(const aspi_cells *k, double x, double y)
{
    double s = (x - k->x0) * k->per_x, t = (y - k->y0) * k->per_y, out = 0.0;
    if (s >= 0.0 && s < k->nx && t >= 0.0 && t < k->ny)
        out = aspi_cells_at(k, aspi_cells_density(k))[(size_t)t * (size_t)k->nx + (size_t)s];
    return s == s && t == t ? out : s + t;
}

/* ---- samples */

static asp_vec3 cells_facet(const aspi_cells *k, double s, double t, double nothing)
{
    asp_vec3 m;
    m.x = -(k->x0 + k->dx * s) + nothing;
    m.y = -(k->y0 + k->dy * t);
    m.z = 1.0;
    return m;
}

static double cells_between(double x, double low, double high)
{
    x = x > low ? x : low;
    return x < high ? x : high;
}

/* The last of `count` cells whose edge lies at or below `at`; edges stand `step` apart. */
static int cells_last_below(const double *edge, int step, int count, double at)
{
    int low = 0, high = count;         /* edge[low] <= at < edge[high], in spirit */
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (edge[middle * step] <= at)
            low = middle;
        else
            high = middle;
    }
    return low;
}

asp_vec3 aspi_cells_normal(const aspi_cells *k, double u1, double u2)
{
    const double *below = aspi_cells_at(k, aspi_cells_below(k)), *row;
    double at = cells_between(u1, 0.0, 1.0) * below[k->ny], s, t;
    int j = cells_last_below(below, 1, k->ny, at), i;
    t = cells_between((at - below[j]) / (below[j + 1] - below[j]), 0.0, 1.0);
    row = aspi_cells_at(k, aspi_cells_place(k, ASPI_FROM_LEFT))
        + (size_t)j * aspi_cells_stride(k, ASPI_FROM_LEFT) + 2;
    at = cells_between(u2, 0.0, 1.0) * row[2 * k->nx];
    i = cells_last_below(row, 2, k->nx, at);
    s = cells_between((at - row[2 * i]) / (row[2 * i + 2] - row[2 * i]), 0.0, 1.0);
    return cells_facet(k, i + s, j + t, (u1 + u2) * 0.0);
}

/* x in [0, 1] with g0 x + g1 x^2/2 + g2 x^3/3 = at: convex, so that Newton's steps from above fall
 * without overshooting; each term alone bounds x from above. */
static double cells_invert_piece(const cells_piece *p, double at)
{
    double x = 1.0;
    int i;
    if (p->g0 > at)
        x = at / p->g0;
    if (p->g1 * x * x > 2.0 * at)
        x = aspi_sqrt(2.0 * at / p->g1);
    for (i = 0; i < 64; i++) {
        double slope = p->g0 + x * (p->g1 + x * p->g2);
        double over = x * (p->g0 + x * (p->g1 * 0.5 + x * p->g2 * (1.0 / 3.0))) - at;
        double next = slope > 0.0 ? x - over / slope : x;
        if (!(next < x))
            break;
        x = next;
    }
    return cells_positive(x);
}

/* Where in a row: `at` is the visible mass before it. Returns x in [0, 1], and the height there. */
static double cells_invert_row(const cells_sight *q, int r, double at, double *height)
{
    double h0 = q->low + q->b * r, h1 = q->low + q->b * (r + 1);
    int c0 = cells_of_height(h0, q->per_a, q->cols), c1 = cells_of_height(h1, q->per_a, q->cols);
    const double *row = q->table + r * q->stride;
    cells_piece upper = cells_upper_piece(row, c1, h0, h1, q->a, q->per_a, q->per_b);
    cells_piece lower = cells_lower_piece(row, c0, c1, h0, 1.0 - upper.share, q->a, q->per_a);
    double first = lower.share * cells_piece_mean(lower), x;
    if (at < first) {
        x = cells_invert_piece(&lower, at / lower.share);
        *height = c0 * q->a + lower.e0 + x * lower.wide;
        return cells_between(x * lower.share, 0.0, 1.0);
    }
    x = cells_invert_piece(&upper, cells_positive(at - first) / (upper.share > 0.0 ? upper.share : 1.0));
    *height = c1 * q->a + upper.e0 + x * upper.wide;
    return cells_between(lower.share + x * upper.share, 0.0, 1.0);
}

/* Where along a row at height h: the visible mass before edge c is a C_c + (h - a c) A_c, and inside
 * a cell it grows by f (e x - a x^2/2). */
static double cells_invert_along(const cells_sight *q, int r, double h, double u)
{
    const double *row = q->table + r * q->stride + 2;
    int c = cells_of_height(h, q->per_a, q->cols), low = 0, high;
    double e, f, at, rest, x;
    c = c < 0 ? 0 : c;
    e = cells_positive(h - c * q->a);
    at = u * (q->a * row[2 * c + 1] + e * (row[2 * c] + 0.5 * e * q->per_a
         * (row[2 * c + 2] - row[2 * c])));
    high = c < q->cols ? c + 1 : q->cols;
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (q->a * row[2 * middle + 1] + (h - middle * q->a) * row[2 * middle] <= at)
            low = middle;
        else
            high = middle;
    }
    e = cells_positive(h - low * q->a);
    f = row[2 * low + 2] - row[2 * low];
    rest = cells_positive(at - (q->a * row[2 * low + 1] + e * row[2 * low]));
    if (!(f > 0.0))
        return low;
    rest = rest / f;
    x = 2.0 * rest / (e + aspi_sqrt(cells_positive(e * e - 2.0 * q->a * rest)));
    return low + (x > 0.0 ? cells_between(x, 0.0, 1.0) : 0.0);
}

asp_vec3 aspi_cells_visible(const aspi_cells *k, asp_vec3 v, double u1, double u2)
{
    double seen[ASPI_HISTOGRAM_SIDE], total = 0.0, before = 0.0, at, h, s, t;
    cells_sight q = cells_look(k, v);
    int r;
    cells_rows_see(&q, seen);
    for (r = 0; r < q.rows; r++)
        total += seen[r];
    at = cells_between(u1, 0.0, 1.0) * total;
    for (r = 0; r + 1 < q.rows && before + seen[r] <= at; r++)
        before += seen[r];
    while (r > 0 && !(seen[r] > 0.0))  /* rounding has run past the last row that sees */
        before -= seen[--r];
    t = r + cells_invert_row(&q, r, cells_between(at - before, 0.0, seen[r]), &h);
    s = cells_invert_along(&q, r, h, cells_between(u2, 0.0, 1.0));
    s = q.back_s ? q.cols - s : s;
    t = q.back_t ? q.rows - t : t;
    return cells_facet(k, q.across ? t : s, q.across ? s : t, (u1 + u2 + (v.x + v.y + v.z)) * 0.0);
}
