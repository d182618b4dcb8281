/* tabulated.c - a density of slopes measured ring by ring
 *
 * log P22 between the samples is a cubic in x = log(r^2 + s^2), s the first slope above 0, monotone where
 * the samples are; beyond the last one P22 falls as (r^2 + s^2)^-tail. GGX, Student's t
 * and every power are straight lines there. Masking and samplers are prepared from it numerically. */
#ifndef ASP_PRECISION
#include "asperity_ndf.h"
#include "ndf/prepared.h"

#define TABULATED_KNOTS 30
#define TABULATED_STEP 5.0
#define TABULATED_BLOCK 128

/* table[]: s^2, log of 1/mass, the last knot, the slope beyond it, then x, log P22 and d log P22/dx of the
 * knots. */
enum { TABULATED_S2, TABULATED_NORM, TABULATED_LAST, TABULATED_TAIL, TABULATED_X,
       TABULATED_Y = TABULATED_X + TABULATED_KNOTS, TABULATED_M = TABULATED_Y + TABULATED_KNOTS,
       TABULATED_END = TABULATED_M + TABULATED_KNOTS };

/* rows of 32 are read, the last as well */
typedef char tabulated_fits[TABULATED_M + 32 <= PREPARED_OWN ? 1 : -1];

#define ASP_PRECISION 64
#include "asperity/elementary.h"

/* The knots' slopes: those of the cubic spline with continuous second derivative, as far as it is monotone
 * (Fritsch, Carlson 1980: between 0 and three times the lesser secant), which keeps what is prepared exact. */
static void tabulated_slopes(double *table, int last, double tail)
{
    const double *x = table + TABULATED_X, *y = table + TABULATED_Y;
    double *m = table + TABULATED_M, d[TABULATED_KNOTS] = { 0 }, h[TABULATED_KNOTS] = { 0 };
    double pivot[TABULATED_KNOTS];
    int i;
    for (i = 0; i < last; i++) {
        h[i] = x[i + 1] - x[i];
        d[i] = (y[i + 1] - y[i]) / h[i];
    }
    pivot[0] = 2 / h[0];
    m[0] = 3 * d[0] / h[0];
    for (i = 1; i < last; i++) {
        double by = 1 / (h[i - 1] * pivot[i - 1]);
        pivot[i] = 2 / h[i - 1] + 2 / h[i] - by / h[i - 1];
        m[i] = 3 * (d[i - 1] / h[i - 1] + d[i] / h[i]) - by * m[i - 1];
    }
    m[last] = -tail;
    for (i = last - 1; i >= 0; i--)
        m[i] = (m[i] - m[i + 1] / h[i]) / pivot[i];
    for (i = 0; i <= last; i++) {
        double before = d[i > 0 ? i - 1 : 0], after = i < last ? d[i] : before;
        double most = 3 * aspi_min_64(aspi_abs_64(before), aspi_abs_64(after));
        double size = aspi_min_64(aspi_abs_64(m[i]), most);
        if (before * after <= 0 || m[i] * before < 0)
            size = 0;
        m[i] = before < 0 ? -size : size;
    }
    table[TABULATED_TAIL] = -tail;
}

static asp_status tabulated_refuse(asp_error *err, const char *name, double value, double low, int open,
                                   double high, size_t i)
{
    asp_fail_range(err, name, value, low, open, high);
    if (err)
        err->position = (long long)i;
    return ASP_EINVAL;
}

static asp_status tabulated_check(const asp_slope_samples *s, asp_error *err)
{
    size_t i;
    if (s->count < 2 || s->count > TABULATED_KNOTS - 1)
        return asp_fail_range(err, "slopes", (double)s->count, 2, 0, TABULATED_KNOTS - 1);
    for (i = 0; i < s->count; i++) {
        double low = i ? s->slope[i - 1] : 0;
        if (!(s->slope[i] <= 1e3 && (i ? s->slope[i] > low * (1 + 1e-6) + 1e-6 : s->slope[i] >= 0)))
            return tabulated_refuse(err, "slopes", s->slope[i], low, i > 0, 1e3, i);
        if (!(s->density[i] >= 1e-100 && s->density[i] <= 1e100))
            return tabulated_refuse(err, "density", s->density[i], 1e-100, 0, 1e100, i);
        /* steeper, and what is prepared from the samples is worse than stated */
        if (i && !(s->density[i] <= TABULATED_STEP * s->density[i - 1]
                   && s->density[i - 1] <= TABULATED_STEP * s->density[i]))
            return tabulated_refuse(err, "density", s->density[i], s->density[i - 1] / TABULATED_STEP, 0,
                                    s->density[i - 1] * TABULATED_STEP, i);
    }
    if (s->tail != 0 && !(s->tail >= 2 && s->tail <= 1e3))
        return asp_fail_range(err, "tail", s->tail, 2, 0, 1e3);
    return ASP_OK;
}

#undef ASP_PRECISION

#define ASP_SCALAR_LOOPS        /* of reflections: gcc 12 leaves the search in them as it is */
#define ASP_NDF tabulated
#define ASP_PRECISION 64
#include "tabulated.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "tabulated.c"
#undef ASP_PRECISION

ASP_CLONES static void tabulated_log_density(const asp_ndf *k, size_t n, const double *ASP_RESTRICT r2,
                                             double *ASP_RESTRICT out)
{
    double x[TABULATED_BLOCK], s2 = k->table[TABULATED_S2];
    size_t from, count, i;
    for (from = 0; from < n; from += count) {
        count = n - from < TABULATED_BLOCK ? n - from : TABULATED_BLOCK;
        for (i = 0; i < count; i++)
            x[i] = aspi_log_64(r2[from + i] + s2);
        tabulated_logs_64(k, count, x, out + from);
    }
}

/* Sum of weight e^(y + x). */
ASP_CLONES static void tabulated_terms(size_t n, const double *ASP_RESTRICT x, const double *ASP_RESTRICT y,
                                       double *ASP_RESTRICT out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = aspi_exp_64(y[i] + x[i]);
}

/* Integral of P22 over the slopes: pi e^(y + x) over x, by Gauss's rule of 8 nodes on short pieces; beyond
 * the last knot a power. */
#define TABULATED_NODES 64       /* 8 of each of 8 pieces between two knots */
static double tabulated_mass(const asp_ndf *k)
{
    static const double node[4] = { 0.18343464249564980, 0.52553240991632899, 0.79666647741362674,
                                    0.96028985649753623 };
    static const double weight[4] = { 0.36268378337836198, 0.31370664587788729, 0.22238103445337447,
                                      0.10122853629037626 };
    const double *x = k->table + TABULATED_X;
    double at[TABULATED_NODES], y[TABULATED_NODES], terms[TABULATED_NODES], sum = 0;
    int last = (int)k->table[TABULATED_LAST], i, n;
    for (i = 0; i < last; i++) {
        double half = (x[i + 1] - x[i]) / 16;
        for (n = 0; n < TABULATED_NODES; n++)
            at[n] = x[i] + half * (2 * (n >> 3) + 1 + (n & 4 ? -node[n & 3] : node[n & 3]));
        tabulated_logs_64(k, TABULATED_NODES, at, y);
        tabulated_terms(TABULATED_NODES, at, y, terms);
        for (n = 0; n < TABULATED_NODES; n++)
            sum += half * weight[n & 3] * terms[n];
    }
    sum += aspi_exp_64(k->table[TABULATED_Y + last] + x[last]) / (-k->table[TABULATED_TAIL] - 1);
    return ASP_PI * sum;
}

static asp_status tabulated_prepare(asp_ndf *out, asp_error *err)
{
    const asp_slope_samples *s = (const asp_slope_samples *)out->data;
    double *x = out->table + TABULATED_X, *y = out->table + TABULATED_Y, first, tail;
    int last = 0;
    size_t i;
    asp_status status;
    if (!s)
        return asp_fail(err, ASP_EINVAL, "slopes", "the samples are missing: tabulated:slopes=0/0.1/0.3,"
                        "density=5/4/1");
    status = tabulated_check(s, err);
    if (status)
        return status;
    first = s->slope[0] > 0 ? s->slope[0] : s->slope[1];
    out->table[TABULATED_S2] = first * first;
    if (s->slope[0] > 0) {                   /* flat below the first sample */
        x[0] = aspi_log_64(first * first);
        y[0] = aspi_log_64(s->density[0]);
        last = 1;
    }
    for (i = 0; i < s->count; i++, last++) {
        x[last] = aspi_log_64(s->slope[i] * s->slope[i] + first * first);
        y[last] = aspi_log_64(s->density[i]);
    }
    last--;
    out->table[TABULATED_LAST] = last;
    tail = s->tail != 0 ? s->tail : aspi_max_64(2, (y[last - 1] - y[last]) / (x[last] - x[last - 1]));
    tabulated_slopes(out->table, last, tail);
    out->data = NULL;                        /* all that is needed stands in the value */
    out->table[TABULATED_NORM] = -aspi_log_64(tabulated_mass(out));
    out->table[PREPARED_IS_BENT] = 1;
    return aspi_prepared_make(out, tabulated_log_density, err);
}

ASP_RECORD asp_model asp_model_tabulated = {
    "tabulated", NULL, "a density of slopes measured ring by ring", "samples of P22 over the slope",
    ASP_KEYS_SLOPE, 1.0, 1, 2.5e-3, NULL, 0, tabulated_prepare, ASP_NDF_OPS(tabulated)
};
#undef ASP_NDF

asp_status asp_tabulated_make(const asp_slope_samples *samples, const asp_map *map, asp_ndf *out,
                              asp_error *err)
{
    static const asp_map whole = { 1.0, 0.0, 0.0, 1.0, 0.0, 0.0 };
    return asp_ndf_make_data(&asp_model_tabulated, map ? map : &whole, NULL, samples, out, err);
}

#else
#include "asperity/elementary.h"

#include "asperity/facet.h"
#include "ndf/pieces.h"

#define tabulated_ring ASP_NDF_NAME(_ring)
#define tabulated_between ASP_NDF_NAME(_between)
#define tabulated_logs ASP_NDF_NAME(_logs)
#define tabulated_block ASP_NDF_NAME(_block)

/* Where the ring of slopes lies: x of the knots. */
ASP_FN asp_real tabulated_ring(const asp_shape *k, asp_real r2, asp_real z2)
{
    return aspi_log((r2 + k->table[TABULATED_S2] * z2) / z2);
}

/* log P22(x) from the knots before and after x, the same where the last is left behind: values y, slopes m. */
ASP_FN asp_real tabulated_between(const asp_shape *k, asp_real x, asp_real x0, asp_real x1, asp_real y0, asp_real y1,
                                  asp_real m0, asp_real m1)
{
    asp_real d = x - x0, h = x1 - x0, t = d / aspi_select(h > R(0.0), h, R(1.0)), rise = y1 - y0;
    asp_real line = y0 + d * k->table[TABULATED_TAIL];
    asp_real cubic = y0 + t * (h * m0 + t * ((R(3.0) * rise - h * (R(2.0) * m0 + m1))
                                             + t * (h * (m0 + m1) - R(2.0) * rise)));
    return k->table[TABULATED_NORM] + aspi_select(h > R(0.0), cubic, line);
}

ASP_FN asp_real ndf_density(const asp_shape *k, asp_real r2, asp_real z2)
{
    const asp_real *x = k->table + TABULATED_X, *y = k->table + TABULATED_Y, *m = k->table + TABULATED_M;
    asp_real at = tabulated_ring(k, r2, z2);
    int last = (int)k->table[TABULATED_LAST], i = aspi_knot(x, last, at), j = i < last ? i + 1 : last;
    return aspi_exp(tabulated_between(k, at, x[i], x[j], y[i], y[j], m[i], m[j])) / (z2 * z2);
}

/* The same in loops, in stages, up to TABULATED_BLOCK at a time: log P22, */
ASP_FN void tabulated_logs(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT x, asp_real *ASP_RESTRICT out)
{
    asp_real x0[TABULATED_BLOCK], x1[TABULATED_BLOCK], y0[TABULATED_BLOCK], y1[TABULATED_BLOCK];
    asp_real m0[TABULATED_BLOCK], m1[TABULATED_BLOCK];
    int before[TABULATED_BLOCK], after[TABULATED_BLOCK], last = (int)k->table[TABULATED_LAST];
    size_t i;
    aspi_knots_n(k->table + TABULATED_X, last, n, x, before);
    for (i = 0; i < n; i++)
        after[i] = before[i] < last ? before[i] + 1 : last;
    aspi_rows_n(k->table + TABULATED_X, n, before, x0);
    aspi_rows_n(k->table + TABULATED_X, n, after, x1);
    aspi_rows_n(k->table + TABULATED_Y, n, before, y0);
    aspi_rows_n(k->table + TABULATED_Y, n, after, y1);
    aspi_rows_n(k->table + TABULATED_M, n, before, m0);
    aspi_rows_n(k->table + TABULATED_M, n, after, m1);
    for (i = 0; i < n; i++)
        out[i] = tabulated_between(k, x[i], x0[i], x1[i], y0[i], y1[i], m0[i], m1[i]);
}

/* and the density. */
ASP_FN void tabulated_block(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT mx,
                            const asp_real *ASP_RESTRICT my, const asp_real *ASP_RESTRICT mz,
                            asp_real *ASP_RESTRICT out)
{
    asp_real x[TABULATED_BLOCK], z2[TABULATED_BLOCK], y[TABULATED_BLOCK];
    size_t i;
    if (!n)
        return;
    for (i = 0; i < n; i++) {
        asp_v3 m = aspi_facet(k, aspi_vector(mx[i], my[i], mz[i]));
        z2[i] = m.z * m.z;
        x[i] = tabulated_ring(k, aspi_length2(m), z2[i]);
    }
    tabulated_logs(k, n, x, y);
    for (i = 0; i < n; i++)
        out[i] = aspi_density_result(k, aspi_exp(y[i]) / (z2[i] * z2[i]), mz[i]);
}

#define ASP_OWN_DENSITY_N
ASP_CLONES static void ndf_density_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT mx,
                                     const asp_real *ASP_RESTRICT my, const asp_real *ASP_RESTRICT mz,
                                     asp_real *ASP_RESTRICT out)
{
    size_t from;
    for (from = 0; from < n; from += TABULATED_BLOCK)
        tabulated_block(k, n - from < TABULATED_BLOCK ? n - from : TABULATED_BLOCK, mx + from, my + from, mz + from,
                        out + from);
}

#define PREPARED_BENT
#include "prepared_kernel.h"
#include "asperity/ndf_loops.h"
#undef PREPARED_BENT
#endif
