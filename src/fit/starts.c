/* starts.c - where searches begin
 *
 * A grid of roughness (alpha, or the first shape number where that carries the roughness), shape and
 * index, jittered by the seed, of which the best few that differ are polished. Shape numbers are visited at whole numbers, defaults and ends, because that is where one
 * distribution becomes another (gamma = 2: GGX, gamma = infinity: Beckmann). */
#include "fit.h"

#include <string.h>

#define ALPHAS 9                      /* over 3.6 decades; a longer axis has more, up to: */
#define MOST_ALPHAS 24
#define PER_DECADE 2.5
#define ETAS 3
#define PLACES 8
#define SHAPES 24                     /* combinations of shape numbers at most */

/* SplitMix64 (Steele, Lea, Flood 2014): a uniform number in [-1, 1) of a seed and a counter. */
static double jitter(uint64_t seed, uint64_t counter)
{
    uint64_t x = seed + 0x9e3779b97f4a7c15u * (counter + 1);
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    x ^= x >> 31;
    return (double)(x >> 11) * 0x1p-52 - 1;
}

static int add_place(double b, double *out, int n)
{
    for (int i = 0; i < n; i++)
        if (fabs(out[i] - b) < 1e-6)
            return n;
    if (n < PLACES)
        out[n++] = b;
    return n;
}

/* The places that starts visit along the axis of a shape number. */
static int places(const aspi_axis *axis, const asp_param *param, double out[PLACES])
{
    static const double whole[] = { 2, 1, 3, 5 };
    int n = add_place(aspi_axis_place(axis, param->initial), out, 0);
    for (int i = 0; i < 4; i++)
        if (whole[i] > param->low && whole[i] <= param->high)
            n = add_place(aspi_axis_place(axis, whole[i]), out, n);
    n = add_place(axis->b_low, out, n);
    return add_place(axis->b_low + 0.95 * (axis->b_high - axis->b_low), out, n);
}

/* All combinations of the places of the shape numbers, as many as there is room for; without that
 * on axis 0. */
static int combinations(const aspi_problem *p, double out[SHAPES][ASPI_AXES])
{
    int n = 1;
    memset(out, 0, SHAPES * sizeof out[0]);
    for (size_t k = p->box.shape ? 0 : 1; k < p->model->param_count; k++) {
        double place[PLACES];
        size_t axis = k + (size_t)p->box.shape;
        int count = places(&p->box.axis[axis], &p->model->params[k], place);
        if (count * n > SHAPES)
            count = SHAPES / n;
        for (int j = count - 1; j >= 0; j--)       /* j = 0 last: it fills the rows being copied */
            for (int i = 0; i < n; i++) {
                memmove(out[j * n + i], out[i], sizeof out[0]);
                out[j * n + i][axis] = place[j];
            }
        n *= count;
    }
    return n;
}

/* Two starts that would end in the same place are one. */
static int differ(const aspi_problem *p, const aspi_point *a, const aspi_point *b)
{
    for (int i = 0; i < p->box.n - 1; i++)
        if (fabs(a->b[i] - b->b[i]) > 0.04)
            return 1;
    return 0;
}

static size_t insert(const aspi_problem *p, const aspi_point *point, size_t limit, aspi_point *out,
                     size_t found)
{
    for (size_t i = 0; i < found; i++)
        if (!differ(p, &out[i], point)) {
            if (point->loss >= out[i].loss)
                return found;
            memmove(&out[i], &out[i + 1], (found - i - 1) * sizeof *out);
            found--;
            break;
        }
    size_t at = found;
    while (at && out[at - 1].loss > point->loss)
        at--;
    if (at >= limit)
        return found;
    if (found == limit)
        found--;
    memmove(&out[at + 1], &out[at], (found - at) * sizeof *out);
    out[at] = *point;
    return found + 1;
}

static int roughnesses(const aspi_axis *axis)
{
    if (axis->scale != ASPI_SCALE_LOG)
        return ALPHAS;
    return (int)fmin(fmax(PER_DECADE * log10(axis->high / axis->low), ALPHAS), MOST_ALPHAS);
}

asp_status aspi_starts(aspi_search *search, uint64_t seed, size_t limit, aspi_point *out,
                       size_t *found, asp_error *err)
{
    static const double etas[ETAS] = { 1.3, 1.8, 5 };
    aspi_problem *p = search->problem;
    double shape[SHAPES][ASPI_AXES];
    int shapes = combinations(p, shape), eta = p->box.n - 1;
    int alphas = roughnesses(&p->box.axis[0]);
    double low = p->box.axis[0].b_low, range = p->box.axis[0].b_high - low;
    uint64_t counter = 0;
    *found = 0;
    for (int s = 0; s < shapes; s++)
        for (int a = 0; a < alphas; a++) {
            aspi_point point = { 0 };
            memcpy(point.b, shape[s], sizeof point.b);
            point.b[0] = low + range * ((a + 0.5 + 0.4 * jitter(seed, counter++)) / alphas);
            if (search->cancelled && search->cancelled(search->context)) {
                search->stopped = 1;
                return asp_fail(err, ASP_ECANCELLED, "", "stopped by the progress function");
            }
            for (int e = 0; e < ETAS; e++) {
                point.b[eta] = aspi_axis_place(&p->box.axis[eta], etas[e]);
                aspi_problem_colours(p, &point, 8);
                if (isfinite(point.loss))
                    *found = insert(p, &point, limit, out, *found);
            }
        }
    return ASP_OK;
}

aspi_point aspi_translate(aspi_search *search, const aspi_box *from, const aspi_point *optimum)
{
    aspi_problem *p = search->problem;
    double shape[SHAPES][ASPI_AXES];
    int shapes = combinations(p, shape), eta = p->box.n - 1;
    aspi_point best = { .loss = INFINITY };
    for (int s = 0; s < shapes; s++) {
        aspi_point point = *optimum;
        memcpy(point.b, shape[s], sizeof point.b);
        point.b[0] = optimum->b[0];
        point.b[eta] = optimum->b[from->n - 1];
        point.loss = aspi_problem_loss(p, &point);
        if (point.loss < best.loss)
            best = point;
    }
    return best;
}
