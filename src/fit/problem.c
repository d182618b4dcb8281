/* problem.c - a model over geometries, its residuals, and its colours
 *
 * For given alpha, shape and eta the model is linear in the colours, f = diffuse/pi + specular S, and
 * the channels are independent: per channel a least-squares problem of two unknowns in a box, repeated where the loss is not a square of something linear:
 * Gauss-Newton with halved steps for logarithms, reweighting for absolute values. */
#include "fit.h"

#include <stdlib.h>
#include <string.h>


asp_status aspi_problem_make(const asp_model *model, const aspi_loss *loss, const aspi_fit_set *set,
                             const asp_fit_options *options, aspi_problem *out, asp_error *err)
{
    size_t n = set->n;
    aspi_problem p = { .model = model, .loss = loss, .set = set,
                       .mask = options->mask, .specular_high = options->specular_limit };
    p.box = aspi_box_make(model);
    p.memory = malloc(10 * n * sizeof *p.memory);
    if (!p.memory)
        return asp_fail(err, ASP_ENOMEM, "", "not enough memory for the fit");
    p.facets = p.memory;
    p.specular = p.memory + n;
    p.fit = p.memory + 2 * n;
    p.residual = p.memory + 3 * n;
    p.slope = p.memory + 4 * n;
    p.irls = p.memory + 5 * n;
    p.scratch = p.memory + 8 * n;
    for (int i = 0; i < ASPI_AXES; i++)
        p.last[i] = NAN;
    for (size_t i = 0; i < 3 * n; i++)
        p.irls[i] = 1;
    *out = p;
    return ASP_OK;
}

void aspi_problem_free(aspi_problem *p)
{
    free(p->memory);
    p->memory = NULL;
}

asp_status aspi_problem_ndf(const aspi_problem *p, const double *b, asp_ndf *out)
{
    double shape[ASP_SHAPE_NUMBERS] = { 0 };
    asp_map map;
    double alpha = p->box.shape ? aspi_axis_value(&p->box.axis[0], b[0]) : 1;
    asp_status status = asp_map_from_roughness(alpha, alpha, 0, 0, 0, &map, NULL);
    for (int i = p->box.shape; i < p->box.n - 1; i++)
        shape[i - p->box.shape] = aspi_axis_value(&p->box.axis[i], b[i]);
    return status ? status : asp_ndf_make(p->model, &map, shape, out, NULL);
}

int aspi_problem_move(aspi_problem *p, const double *b)
{
    const aspi_fit_set *set = p->set;
    int eta = p->box.n - 1;
    size_t size = (size_t)eta * sizeof *b;
    if (memcmp(p->last, b, size)) {
        asp_ndf ndf;
        p->last[0] = p->last[eta] = NAN;
        if (aspi_problem_ndf(p, b, &ndf) != ASP_OK)
            return 0;
        asp_material mirror = asp_mirror(&ndf, p->mask);
        asp_cvec3s wi = { set->wi_x, set->wi_y, set->wi_z }, wo = { set->wo_x, set->wo_y, set->wo_z };
        asp_rgbs out = { p->facets, p->fit, p->residual };
        asp_eval_n(&mirror, set->n, wi, wo, out);
        memcpy(p->last, b, size);
        p->evaluations++;
    }
    if (p->last[eta] != b[eta]) {
        double index = aspi_axis_value(&p->box.axis[eta], b[eta]);
        for (size_t i = 0; i < set->n; i++)
            p->specular[i] = p->facets[i] * asp_fresnel_dielectric(set->cos_d[i], index);
        p->last[eta] = b[eta];
    }
    return 1;
}

/* The model of one channel with the colours (diffuse, specular). */
static void compose(aspi_problem *p, const double x[2])
{
    double base = x[0] * ASPI_INV_PI;
    for (size_t i = 0; i < p->set->n; i++)
        p->fit[i] = base + x[1] * p->specular[i];
}

static void residuals_of(aspi_problem *p, int c, const double x[2], double *r, double *slope)
{
    compose(p, x);
    p->loss->residual(p->set->n, p->fit, p->set->data[c], p->set->weight, r, slope);
}

static double sum_of(const aspi_problem *p, const double *r)
{
    double sum = 0;
    if (p->loss->power == 1)
        for (size_t i = 0; i < p->set->n; i++)
            sum += fabs(r[i]);
    else
        for (size_t i = 0; i < p->set->n; i++)
            sum += r[i] * r[i];
    return sum;
}

/* Sum w r^2, or for absolute values with w = NULL the curve that is |r| beyond `soft` and a parabola
 * below, which reweighting by 1/max(|r|, soft) never raises. */
static double objective(const aspi_problem *p, const double *r, const double *w, double soft)
{
    double sum = 0;
    size_t n = p->set->n;
    if (w)
        for (size_t i = 0; i < n; i++)
            sum += w[i] * r[i] * r[i];
    else if (p->loss->power == 2)
        for (size_t i = 0; i < n; i++)
            sum += r[i] * r[i];
    else
        for (size_t i = 0; i < n; i++) {
            double a = fabs(r[i]);
            sum += a > soft ? a : 0.5 * (a * a / soft + soft);
        }
    return sum;
}

/* The x in [0, 1] x [0, high] that minimises x.Ax/2 - x.b for a 2x2 positive semidefinite A: inside, or the best of the four edges. */
static void bounded(double a00, double a01, double a11, double b0, double b1, double high,
                    double x[2])
{
    double det = a00 * a11 - a01 * a01, least = INFINITY;
    if (det > 1e-13 * a00 * a11) {
        x[0] = (b0 * a11 - b1 * a01) / det;
        x[1] = (b1 * a00 - b0 * a01) / det;
        if (x[0] >= 0 && x[1] >= 0 && x[0] <= DIFFUSE_HIGH && x[1] <= high)
            return;
    }
    for (int edge = 0; edge < 4; edge++) {
        double y[2], fixed = edge & 1 ? edge & 2 ? high : DIFFUSE_HIGH : 0;
        if (edge & 2) {
            y[1] = fixed;
            y[0] = a00 > 0 ? fmin(fmax((b0 - a01 * fixed) / a00, 0), DIFFUSE_HIGH) : 0;
        } else {
            y[0] = fixed;
            y[1] = a11 > 0 ? fmin(fmax((b1 - a01 * fixed) / a11, 0), high) : 0;
        }
        double value = 0.5 * (a00 * y[0] * y[0] + a11 * y[1] * y[1]) + a01 * y[0] * y[1]
                     - b0 * y[0] - b1 * y[1];
        if (value < least) {
            least = value;
            x[0] = y[0];
            x[1] = y[1];
        }
    }
}

/* The normal equations are summed in lanes, which the compiler can keep side by side: it may not
 * reorder a sum by itself. */
#define LANES 4
enum { A00, A01, A11, B0, B1, SUMS };
typedef struct lanes { double sum[SUMS][LANES]; } lanes;

static inline void add(lanes *t, int lane, double w, double slope, double specular, double target)
{
    double g0 = slope * ASPI_INV_PI, g1 = slope * specular;
    t->sum[A00][lane] += w * g0 * g0;
    t->sum[A01][lane] += w * g0 * g1;
    t->sum[A11][lane] += w * g1 * g1;
    t->sum[B0][lane] += w * g0 * target;
    t->sum[B1][lane] += w * g1 * target;
}

static inline double larger(double a, double b)
{
    return a > b ? a : b;
}

/* One Gauss-Newton step for channel c from x, with the residuals there in p->residual, p->slope. The
 * weights of the squares are w, or 1/max(|r|, soft) for absolute values, or 1. */
static void step(const aspi_problem *p, const double *w, double soft, const double x[2],
                 double next[2])
{
    const double *slope = p->slope, *specular = p->specular, *r = p->residual;
    double x0 = x[0] * ASPI_INV_PI, x1 = x[1], total[SUMS] = { 0 };
    size_t n = p->set->n, whole = n - n % LANES;
    int absolute = p->loss->power == 1;
    lanes t = { { { 0 } } };
    for (size_t i = 0; i < n; i += LANES) {
        int count = i < whole ? LANES : (int)(n - whole);
        double weight[LANES];
        for (int k = 0; k < count; k++)
            weight[k] = w ? w[i + k] : absolute ? 1 / larger(fabs(r[i + k]), soft) : 1;
        if (count == LANES)
            for (int k = 0; k < LANES; k++)
                add(&t, k, weight[k], slope[i + k], specular[i + k],
                    slope[i + k] * (x0 + x1 * specular[i + k]) - r[i + k]);
        else
            for (int k = 0; k < count; k++)
                add(&t, k, weight[k], slope[i + k], specular[i + k],
                    slope[i + k] * (x0 + x1 * specular[i + k]) - r[i + k]);
    }
    for (int s = 0; s < SUMS; s++)
        for (int k = 0; k < LANES; k++)
            total[s] += t.sum[s][k];
    bounded(total[A00], total[A01], total[A11], total[B0], total[B1], p->specular_high, next);
}

/* `enough`: the relative gain of a round below which it stops. */
static void improve(aspi_problem *p, int c, double x[2], const double *w, double soft, double enough,
                    int rounds)
{
    double now, best;
    residuals_of(p, c, x, p->residual, p->slope);
    best = objective(p, p->residual, w, soft);
    for (int round = 0; round < rounds; round++) {
        double next[2];
        step(p, w, soft, x, next);
        for (int half = 0;; half++) {
            residuals_of(p, c, next, p->residual, p->slope);
            now = objective(p, p->residual, w, soft);
            if (now <= best || half == 6)
                break;
            next[0] = 0.5 * (x[0] + next[0]);
            next[1] = 0.5 * (x[1] + next[1]);
        }
        if (!(now < best))
            break;
        double gain = best - now;
        best = now;
        x[0] = next[0];
        x[1] = next[1];
        if (gain <= enough * best)
            break;
    }
}

double aspi_problem_loss(aspi_problem *p, const aspi_point *at)
{
    double sum = 0;
    if (!aspi_problem_move(p, at->b))
        return INFINITY;
    for (int c = 0; c < 3; c++) {
        const double x[2] = { at->colour[c], at->colour[3 + c] };
        residuals_of(p, c, x, p->residual, NULL);
        sum += sum_of(p, p->residual);
    }
    return isnan(sum) ? INFINITY : sum;
}

void aspi_problem_colours(aspi_problem *p, aspi_point *at, int rounds)
{
    double sum = 0;
    if (!aspi_problem_move(p, at->b)) {
        at->loss = INFINITY;
        return;
    }
    for (int c = 0; c < 3; c++) {
        double x[2] = { at->colour[c], at->colour[3 + c] };
        residuals_of(p, c, x, p->residual, NULL);
        double before = sum_of(p, p->residual), mean = before / (double)p->set->n + 1e-300;
        if (p->loss->power == 1)         /* coarse to fine: see aspi_polish */
            improve(p, c, x, NULL, 0.3 * mean, 1e-5, rounds);
        improve(p, c, x, NULL, 0.003 * mean, p->loss->power == 1 ? 1e-8 : 1e-14, rounds);
        residuals_of(p, c, x, p->residual, NULL);
        double after = sum_of(p, p->residual);
        if (after < before) {
            at->colour[c] = x[0];
            at->colour[3 + c] = x[1];
        }
        sum += fmin(before, after);
    }
    at->loss = isnan(sum) ? INFINITY : sum;
}

void aspi_problem_weighted(aspi_problem *p, aspi_point *at, double *residuals)
{
    size_t n = p->set->n;
    for (int c = 0; c < 3; c++) {
        double x[2] = { at->colour[c], at->colour[3 + c] };
        const double *w = p->irls + (size_t)c * n;
        double *r = residuals + (size_t)c * n;
        improve(p, c, x, w, 0, 1e-14, p->loss->linear ? 1 : 40);
        residuals_of(p, c, x, r, NULL);
        for (size_t i = 0; i < n; i++)
            r[i] *= sqrt(w[i]);
        at->colour[c] = x[0];
        at->colour[3 + c] = x[1];
    }
}

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double aspi_problem_reweight(aspi_problem *p, const aspi_point *at, double soften)
{
    size_t n = p->set->n;
    if (p->loss->power == 2 || !aspi_problem_move(p, at->b))
        return 0;
    for (int c = 0; c < 3; c++) {
        const double x[2] = { at->colour[c], at->colour[3 + c] };
        residuals_of(p, c, x, p->irls + (size_t)c * n, NULL);
    }
    /* the median over a sixteenth of the residuals is near enough for a cut-off */
    size_t m = 0, stride = 3 * n > 64 ? 16 : 1;
    for (size_t i = 0; i < 3 * n && m < 2 * n; i += stride)
        p->scratch[m++] = fabs(p->irls[i]);
    qsort(p->scratch, m, sizeof *p->scratch, ascending);
    double median = p->scratch[m / 2], cut = soften * median + 1e-300;
    for (size_t i = 0; i < 3 * n; i++)
        p->irls[i] = 1 / fmax(fabs(p->irls[i]), cut);
    return median;
}
