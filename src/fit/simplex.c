/* simplex.c - downhill by the loss alone, Nelder, Mead 1965
 *
 * Reweighted squares come to the neighbourhood of an optimum of absolute differences quickly and then
 * creep, because the residuals nearest to zero pin them; a distance between distributions has no residuals
 * at all. With the colours eliminated there are few dimensions. Coefficients by Gao, Han 2012, which keep
 * their effect as the number of dimensions grows and are Nelder's for two. */
#include "fit.h"

#include <string.h>

#define SIZE 0.02              /* of a fit's first simplex, in b */
#define FLAT 1e-6              /* relative spread of losses at which it stops */
#define CALLS 200              /* evaluations per dimension at most */

typedef struct simplex {
    const aspi_descent *how;
    aspi_point corner[ASPI_AXES + 1];            /* best first */
    int n, calls;
} simplex;

static void evaluate(simplex *s, aspi_point *at)
{
    s->how->evaluate(s->how->context, at);
    s->calls++;
}

static void sort(simplex *s)
{
    for (int i = 1; i <= s->n; i++)
        for (int k = i; k && s->corner[k].loss < s->corner[k - 1].loss; k--) {
            aspi_point swap = s->corner[k];
            s->corner[k] = s->corner[k - 1];
            s->corner[k - 1] = swap;
        }
}

/* centre + t (worst - centre), in the box, with the best corner's colours to start from. */
static aspi_point probe(simplex *s, const double *centre, double t)
{
    aspi_point out = s->corner[0];
    for (int i = 0; i < s->n; i++) {
        const aspi_axis *axis = &s->how->box[s->how->axis[i]];
        int k = s->how->axis[i];
        double b = centre[i] + t * (s->corner[s->n].b[k] - centre[i]);
        out.b[k] = fmin(fmax(b, axis->b_low), axis->b_high);
    }
    evaluate(s, &out);
    return out;
}

static void shrink(simplex *s, double by)
{
    for (int j = 1; j <= s->n; j++) {
        for (int i = 0; i < s->n; i++) {
            int k = s->how->axis[i];
            s->corner[j].b[k] = s->corner[0].b[k] + by * (s->corner[j].b[k] - s->corner[0].b[k]);
        }
        evaluate(s, &s->corner[j]);
    }
}

static void step(simplex *s)
{
    double n = fmax(s->n, 2), centre[ASPI_AXES] = { 0 };
    double grow = 1 + 2 / n, contract = 0.75 - 0.5 / n, by = 1 - 1 / n;
    aspi_point *worst = &s->corner[s->n];
    double second = s->corner[s->n > 1 ? s->n - 1 : 0].loss;
    for (int i = 0; i < s->n; i++)
        for (int j = 0; j < s->n; j++)
            centre[i] += s->corner[j].b[s->how->axis[i]] / s->n;
    aspi_point next = probe(s, centre, -1);
    if (next.loss < s->corner[0].loss) {
        aspi_point far = probe(s, centre, -grow);
        *worst = far.loss < next.loss ? far : next;
    } else if (next.loss < second) {
        *worst = next;
    } else {
        aspi_point near = probe(s, centre, next.loss < worst->loss ? -contract : contract);
        if (near.loss < fmin(next.loss, worst->loss))
            *worst = near;
        else
            shrink(s, by);
    }
    sort(s);
}

aspi_rest aspi_descend(const aspi_descent *how, aspi_point *at)
{
    simplex s = { .how = how, .n = how->n };
    int flat = s.n == 0;
    s.corner[0] = *at;
    for (int i = 0; i < s.n; i++) {
        int k = how->axis[i];
        aspi_point *corner = &s.corner[i + 1];
        *corner = *at;
        corner->b[k] += at->b[k] + how->size > how->box[k].b_high ? -how->size : how->size;
        how->evaluate(how->context, corner);
    }
    sort(&s);
    while (!flat && s.calls < how->calls * s.n) {
        if (how->cancelled && how->cancelled(how->context))
            return ASPI_CANCELLED;
        step(&s);
        flat = s.corner[s.n].loss - s.corner[0].loss <= how->flat * s.corner[0].loss;
    }
    if (s.corner[0].loss < at->loss)
        *at = s.corner[0];
    return flat ? ASPI_FLAT : ASPI_STEEP;
}

static void improve_colours(void *context, aspi_point *at)
{
    aspi_problem_colours(((aspi_search *)context)->problem, at, 20);
}

static int is_cancelled(void *context)
{
    aspi_search *search = context;
    search->stopped |= search->cancelled && search->cancelled(search->context);
    return search->stopped;
}

asp_status aspi_simplex(aspi_search *search, aspi_point *at, const int *free_axes, int *flat,
                        asp_error *err)
{
    const aspi_box *box = &search->problem->box;
    int axis[ASPI_AXES];
    aspi_descent how = { box->axis, axis, 0, CALLS, SIZE, FLAT, improve_colours, is_cancelled, search };
    for (int k = 0; k < box->n; k++)
        if (!free_axes || free_axes[k])
            axis[how.n++] = k;
    aspi_rest rest = aspi_descend(&how, at);
    *flat = rest == ASPI_FLAT;
    return rest == ASPI_CANCELLED ? asp_fail(err, ASP_ECANCELLED, "", "stopped by the progress function") : ASP_OK;
}
