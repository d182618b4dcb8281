/* prepared_area.c - the tables of the projected area of a prepared surface */
#include "ndf/prepared_make.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"
#include "ndf/pieces.h"

#define AREA_FIRST (-80)
#define AREA_LAST 400
#define AREA_BLOCK 64

#define AREA_GROUP 8             /* of which terms are added before they are looked at */
#define AREA_TERMS (PREPARED_FINER * (AREA_LAST - AREA_FIRST))

/* x^2 and x^2 (x - atan x) for x = e^(j h), j = first ... first + count - 1, and a block more. */
typedef struct prepared_kernels {
    int first, count;
    double step, x2[AREA_TERMS + AREA_BLOCK], weight[AREA_TERMS + AREA_BLOCK];
} prepared_kernels;

ASP_CLONES static void area_kernel(double step, int first, size_t n, double *ASP_RESTRICT x2,
                                   double *ASP_RESTRICT weight)
{
    int i, count = (int)n;
    for (i = 0; i < count; i++) {
        double x = aspi_exp_64(step * (first + i)), z = x * x;
        x2[i] = z;
        weight[i] = z * aspi_select_64(x < 0.1, x * aspi_prepared_near(z), x - aspi_atan_64(x, 1));
    }
}

static void prepared_kernel(int finer, prepared_kernels *out)
{
    out->step = PREPARED_STEP / finer;
    out->first = finer * AREA_FIRST;
    out->count = finer * (AREA_LAST - AREA_FIRST);
    area_kernel(out->step, out->first, (size_t)out->count + AREA_BLOCK, out->x2, out->weight);
}

ASP_CLONES static void area_slopes(double m2, size_t n, const double *ASP_RESTRICT x2, double *ASP_RESTRICT r2)
{
    size_t i;
    for (i = 0; i < n; i++)
        r2[i] = m2 + m2 * x2[i];
}

ASP_CLONES static void area_terms(double base, size_t n, const double *ASP_RESTRICT log_density,
                                  const double *ASP_RESTRICT weight, double *ASP_RESTRICT out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = aspi_exp_64(log_density[i] - base) * weight[i];
}

static double area_most(const double *logs)
{
    double most[AREA_GROUP];
    int i, j;
    for (j = 0; j < AREA_GROUP; j++)
        most[j] = logs[j];
    for (i = AREA_GROUP; i < AREA_BLOCK; i += AREA_GROUP)
        for (j = 0; j < AREA_GROUP; j++)
            most[j] = aspi_max_64(most[j], logs[i + j]);
    for (j = 1; j < AREA_GROUP; j++)
        most[0] = aspi_max_64(most[0], most[j]);
    return most[0];
}

/* log J(mu): J = integral of 2 P22(mu^2 + rho^2) rho^2 (rho - mu atan(rho/mu)) d log rho by the trapezoidal rule,
 * rho = mu e^(j h). Before the first term and beyond log rho = `high` the integrand is taken for a power, whose
 * terms are a geometric series. */
static double prepared_log_area(const prepared_source *s, const prepared_kernels *kernel, double mu)
{
    double m2 = mu * mu, base = aspi_prepared_log(s, m2), sum = 0, term = 0, last = 0;
    double t = aspi_log_64(mu), end = aspi_max_64(s->high, t + 7) + 4;
    double logs[AREA_BLOCK], p[AREA_BLOCK], r2[AREA_BLOCK];
    int from = (int)((s->low + 13 - t) / kernel->step) - kernel->first, start, i, ended = 0;
    start = from = from < 0 ? 0 : from;
    for (; from < kernel->count && !ended; from += AREA_BLOCK) {
        double most;
        area_slopes(m2, AREA_BLOCK, kernel->x2 + from, r2);
        aspi_prepared_logs(s, AREA_BLOCK, r2, logs);
        most = area_most(logs);
        if (most > base + 200) {              /* the peak lies farther out: count from here on */
            sum *= aspi_exp_64(base - most);
            base = most;
        }
        area_terms(base, AREA_BLOCK, logs, kernel->weight + from, p);
        if (from == start && p[1] > p[0])
            sum = p[0] * p[0] / (p[1] - p[0]);
        for (i = 0; i < AREA_BLOCK && !ended; i += AREA_GROUP) {
            sum += ((p[i] + p[i + 1]) + (p[i + 2] + p[i + 3])) + ((p[i + 4] + p[i + 5]) + (p[i + 6] + p[i + 7]));
            last = p[i + AREA_GROUP - 2];
            term = p[i + AREA_GROUP - 1];
            ended = term < last && (term < 1e-10 * sum
                                    || t + kernel->step * (kernel->first + from + i + AREA_GROUP - 1) > end);
        }
    }
    if (term > 0 && term < last)
        sum += term * term / (last - term);
    return base + aspi_log_64(2 * kernel->step * m2 * mu * sum);
}

/* ------------------------------------------------------------------ polynomials by pieces */

typedef char prepared_pieces_fit[PREPARED_PIECES == ASP_PIECES_NUMBERS && ASP_PIECES_TERMS == 7 ? 1 : -1];

#define TERMS ASP_PIECES_TERMS
#define HALF_ROOT_3 0.86602540378443865

/* A piece: where it is looked at, in y = 1/(1 + q), and J there. */
typedef struct prepared_piece {
    double y[TERMS], log_area[TERMS], log_density[TERMS];
} prepared_piece;

/* Less than e^this of what an edge-on view sees is gone in float64. */
#define AREA_GONE (-3000.0)

double aspi_prepared_half_octave(int octave, int i)
{
    double q = 1 + 0.5 * (i & 1);
    for (octave += i / 2; octave < 0; octave++)
        q *= 0.5;
    for (; octave > 0; octave--)
        q *= 2;
    return q;
}

double aspi_prepared_node(double y0, double y1, int i)
{
    static const double node[TERMS] = { -1, -HALF_ROOT_3, -0.5, 0, 0.5, HALF_ROOT_3, 1 };
    return i == 0 ? y0 : i == TERMS - 1 ? y1 : 0.5 * (y0 + y1) + 0.5 * (y1 - y0) * node[i];
}

/* y = 0 is not looked at. */
static void prepared_look(const prepared_source *s, const prepared_kernels *kernel, double t0, double y0,
                          double y1, prepared_piece *out)
{
    int i;
    for (i = 0; i < TERMS; i++) {
        double y = aspi_prepared_node(y0, y1, i);
        double far = y > 1e-7 * y0 ? y : 1e-7 * y0, mu = t0 * (1 - far) / far;
        out->y[i] = y;
        out->log_density[i] = aspi_prepared_log(s, mu * mu);
        out->log_area[i] = mu <= 0 ? aspi_log_64(0.5 * t0)
                         : out->log_density[i] < AREA_GONE && mu > t0 ? AREA_GONE
                         : prepared_log_area(s, kernel, mu);
    }
}

void aspi_prepared_piece_put(const double *y, const double *value, double center, double *table, int i)
{
    double d[TERMS], c[TERMS] = { 0 }, next[TERMS];
    int j, k;
    for (j = 0; j < TERMS; j++)
        d[j] = value[j];
    /* from row to row, not in place: clang 14 turns that into wrong vectors for WASM */
    for (k = 1; k < TERMS; k++) {
        for (j = k; j < TERMS; j++)
            next[j] = (d[j] - d[j - 1]) / (y[j] - y[j - k]);
        for (j = k; j < TERMS; j++)
            d[j] = next[j];
    }
    for (j = TERMS - 1; j >= 0; j--) {
        next[0] = d[j] - (y[j] - center) * c[0];
        for (k = 1; k < TERMS; k++)
            next[k] = c[k - 1] - (y[j] - center) * c[k];
        for (k = 0; k < TERMS; k++)
            c[k] = next[k];
    }
    table[i] = center;
    for (k = 0; k < TERMS; k++)
        table[(1 + k) * ASP_PIECES + i] = c[k];
}

static double prepared_center(const prepared_piece *p)
{
    return (double)(float)(0.5 * (p->y[0] + p->y[TERMS - 1]));     /* the same in both precisions */
}

static void prepared_area_piece(const prepared_piece *p, double t0, double *table, int i)
{
    double value[TERMS];
    int j;
    for (j = 0; j < TERMS; j++) {
        double y = p->y[j] > 1e-7 * p->y[0] ? p->y[j] : 1e-7 * p->y[0];
        value[j] = aspi_exp_64(p->log_area[j]) / (t0 * y);
        value[j] = value[j] > 1e-25 ? value[j] : 0;        /* subnormal numbers are slow */
    }
    aspi_prepared_piece_put(p->y, value, prepared_center(p), table, i);
}

/* d log J/d log y for y -> 0. */
static double prepared_fall(const prepared_source *s, const prepared_kernels *kernel, double t0)
{
    double mu = t0 / PREPARED_DEEP_LAST * 1e3;
    return (prepared_log_area(s, kernel, mu) - prepared_log_area(s, kernel, 2 * mu)) / aspi_log_64(2);
}

/* log(J/T0) of bent densities, less the power it ends as in the last piece. */
static void prepared_bent_piece(const prepared_piece *p, double t0, double fall, double *table, int i)
{
    double value[TERMS];
    int j;
    for (j = 0; j < TERMS; j++) {
        double y = p->y[j] > 1e-7 * p->y[0] ? p->y[j] : 1e-7 * p->y[0];
        value[j] = p->log_area[j] - aspi_log_64(t0);
        if (i == ASP_PIECES - 1)
            value[j] -= fall * aspi_log_64(y / PREPARED_DEEP_LAST);
    }
    aspi_prepared_piece_put(p->y, value, prepared_center(p), table, i);
}

/* The last piece is centered at y = 0, where the value is 0 and keeps its relative accuracy. */
static void prepared_smooth_piece(const prepared_piece *p, double t0, double *table, int i)
{
    double value[TERMS];
    int j, gone = !(p->log_area[TERMS - 1] > AREA_GONE), last = i == ASP_PIECES - 1;
    for (j = 0; j < TERMS; j++) {
        double y = p->y[j] > 0 ? p->y[j] : 1;
        double x = p->log_area[j] - p->log_density[j] - 3 * aspi_log_64(t0) + 0.5 * aspi_log_64(y);
        value[j] = gone ? 1 : p->y[j] > 0 ? aspi_exp_64(-0.4 * x) : 0;
    }
    aspi_prepared_piece_put(p->y, value, last ? 0 : prepared_center(p), table, i);
}

static void prepared_deep_piece(const prepared_piece *p, double t0, double *table, int i)
{
    if (table[PREPARED_IS_BENT] > 0)
        prepared_bent_piece(p, t0, table[PREPARED_FALL], table + PREPARED_DEEP, i);
    else
        prepared_smooth_piece(p, t0, table + PREPARED_DEEP, i);
}

void aspi_prepared_area_tables(const prepared_source *s, double t0, double *out)
{
    const int both = 2 * (PREPARED_DEEP_OCTAVE - PREPARED_AREA_OCTAVE), last = ASP_PIECES - 1;
    prepared_kernels kernel;
    prepared_piece p;
    double y = 1, next;
    int i;
    prepared_kernel(aspi_prepared_finer(s), &kernel);
    out[PREPARED_FALL] = prepared_fall(s, &kernel, t0);
    for (i = 0; i < last + both; i++, y = next) {
        next = 1 / (1 + aspi_prepared_half_octave(PREPARED_AREA_OCTAVE, i + 1));
        prepared_look(s, &kernel, t0, y, next, &p);
        if (i < last)
            prepared_area_piece(&p, t0, out + PREPARED_AREA, i);
        if (i >= both)
            prepared_deep_piece(&p, t0, out, i - both);
    }
    prepared_look(s, &kernel, t0, y, 0, &p);
    prepared_deep_piece(&p, t0, out, last);
    y = 1 / (1 + aspi_prepared_half_octave(PREPARED_AREA_OCTAVE, last));
    prepared_look(s, &kernel, t0, y, 0, &p);
    prepared_area_piece(&p, t0, out + PREPARED_AREA, last);
}
