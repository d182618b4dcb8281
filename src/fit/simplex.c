/* simplex.c - the last steps for absolute differences
 *
 * Reweighted squares come to the neighbourhood of an optimum quickly and then creep, because the
 * residuals nearest to zero pin them. The simplex of Nelder, Mead 1965 looks at the loss alone; with
 * the colours eliminated it has few dimensions. Coefficients by Gao, Han 2012, which keep their effect
 * as the number of dimensions grows. */
#include "fit.h"

#include <string.h>

#define SIZE 0.02              /* of the first simplex, in b */
#define FLAT 1e-6              /* relative spread of losses at which it stops */
#define CALLS 200              /* evaluations per dimension at most */

typedef struct simplex {
    aspi_search *search;
    int n, axis[ASPI_AXES];                      /* the free axes */
    aspi_point corner[ASPI_AXES + 1];            /* best first */
    int calls;
} simplex;

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
    aspi_problem *p = s->search->problem;
    aspi_point out = s->corner[0];
    for (int i = 0; i < s->n; i++) {
        int k = s->axis[i];
        double b = centre[i] + t * (s->corner[s->n].b[k] - centre[i]);
        out.b[k] = fmin(fmax(b, p->box.axis[k].b_low), p->box.axis[k].b_high);
    }
    aspi_problem_colours(p, &out, 20);
    s->calls++;
    return out;
}

static void shrink(simplex *s, double by)
{
    for (int j = 1; j <= s->n; j++) {
        for (int i = 0; i < s->n; i++) {
            int k = s->axis[i];
            s->corner[j].b[k] = s->corner[0].b[k] + by * (s->corner[j].b[k] - s->corner[0].b[k]);
        }
        aspi_problem_colours(s->search->problem, &s->corner[j], 20);
        s->calls++;
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
            centre[i] += s->corner[j].b[s->axis[i]] / s->n;
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

asp_status aspi_simplex(aspi_search *search, aspi_point *at, const int *free_axes, int *flat,
                        asp_error *err)
{
    aspi_problem *p = search->problem;
    simplex s = { .search = search };
    for (int k = 0; k < p->box.n; k++)
        if (!free_axes || free_axes[k])
            s.axis[s.n++] = k;
    s.corner[0] = *at;
    for (int i = 0; i < s.n; i++) {
        int k = s.axis[i];
        aspi_point *corner = &s.corner[i + 1];
        *corner = *at;
        corner->b[k] += at->b[k] + SIZE > p->box.axis[k].b_high ? -SIZE : SIZE;
        aspi_problem_colours(p, corner, 20);
    }
    sort(&s);
    *flat = s.n == 0;
    while (!*flat && s.calls < CALLS * s.n) {
        if (search->cancelled && search->cancelled(search->context)) {
            search->stopped = 1;
            return asp_fail(err, ASP_ECANCELLED, "", "stopped by the progress function");
        }
        step(&s);
        *flat = s.corner[s.n].loss - s.corner[0].loss <= FLAT * s.corner[0].loss;
    }
    if (s.corner[0].loss < at->loss)
        *at = s.corner[0];
    return ASP_OK;
}
