/* optimise.c - downhill in the box
 *
 * Levenberg-Marquardt (More 1978, MINPACK's lmdif) over u with b = (1 + sin u)/2, so that no step
 * leaves the box. The residuals are those after the colours have been eliminated: variable projection
 * (Golub, Pereyra 1973), whose derivatives by finite differences already contain the colours' answer.
 * sin is flat at the ends of the box, where a search would move slowly or not at all: aspi_try_ends
 * goes there and compares.
 *
 * Absolute differences are squares with weights 1/|r|, renewed from the residuals round by round. */
#include "fit.h"

#include <cminpack.h>
#include <stdlib.h>
#include <string.h>

#define TURN 6.28318530717958647692    /* keeps u away from 0, where relative steps would vanish */
#define NEAR 0.12                      /* how close to an end the end itself is tried */
#define COARSE_ROUNDS 8                /* fewer rounds than that ask for a rough answer */
#define INSIDE 1e-3                    /* how far from an end a search starts */

typedef struct run {
    aspi_search *search;
    aspi_point   at;
    const int   *free_axes;
} run;

static double to_u(double b)
{
    b = fmin(fmax(b, INSIDE), 1 - INSIDE);
    return TURN + asin(2 * b - 1);
}

static double to_b(const aspi_axis *axis, double u)
{
    return fmin(fmax(0.5 * (1 + sin(u)), axis->b_low), axis->b_high);
}

static void place(run *r, const double *u)
{
    const aspi_box *box = &r->search->problem->box;
    for (int i = 0, k = 0; i < box->n; i++)
        if (!r->free_axes || r->free_axes[i])
            r->at.b[i] = to_b(&box->axis[i], u[k++]);
}

static int residuals(void *context, int m, int n, const double *u, double *out, int flag)
{
    run *r = context;
    aspi_search *search = r->search;
    (void)n;
    if (flag == 1 && search->cancelled && search->cancelled(search->context)) {
        search->stopped = 1;
        return -1;
    }
    place(r, u);
    if (!aspi_problem_move(search->problem, r->at.b)) {
        for (int i = 0; i < m; i++)
            out[i] = 1e150 / m;        /* no distribution here: the step is refused */
        return 0;
    }
    aspi_problem_weighted(search->problem, &r->at, out);
    return 0;
}

/* One run of lmdif from `at`, which is replaced by where it ended, better or not. */
static asp_status descend(aspi_search *search, aspi_point *at, const int *free_axes, int calls,
                          int *info, asp_error *err)
{
    aspi_problem *p = search->problem;
    int m = (int)(3 * p->set->n), n = 0, evaluations = 0, pivot[ASPI_AXES];
    double u[ASPI_AXES], diag[ASPI_AXES], qtf[ASPI_AXES];
    double wa1[ASPI_AXES], wa2[ASPI_AXES], wa3[ASPI_AXES];
    for (int i = 0; i < p->box.n; i++)
        if (!free_axes || free_axes[i])
            u[n++] = to_u(at->b[i]);
    *info = 2;
    if (!n || m < n)
        return ASP_OK;
    double *memory = malloc((size_t)m * (size_t)(n + 2) * sizeof *memory);
    if (!memory)
        return asp_fail(err, ASP_ENOMEM, "", "not enough memory for the fit");
    run r = { search, *at, free_axes };
    double *fvec = memory, *wa4 = memory + m, *fjac = memory + 2 * (size_t)m;
    *info = lmdif(residuals, &r, m, n, u, fvec, 1e-12, 1e-10, 0, calls * (n + 1), 1e-11, diag, 1, 1.0,
                  0, &evaluations, fjac, m, pivot, qtf, wa1, wa2, wa3, wa4);
    free(memory);
    if (search->stopped)
        return asp_fail(err, ASP_ECANCELLED, "", "stopped by the progress function");
    place(&r, u);
    *at = r.at;
    return ASP_OK;
}

static asp_fit_reason reason_of(int info)
{
    return info == 5 ? ASP_FIT_EVALUATIONS : info == 2 ? ASP_FIT_STEP : ASP_FIT_LOSS;
}

/* Are the residuals nothing but rounding? */
static int vanishes(const aspi_problem *p, double loss)
{
    double size = 0;
    for (int c = 0; c < 3; c++)
        size += p->loss->scale(p->set->n, p->set->data[c], p->set->weight);
    return p->loss->power == 1 ? loss <= 1e-12 * size : loss <= 1e-24 * size;
}

/* Absolute differences as squares weighted by 1/|r|, until that no longer pays. */
static asp_status reweighted(aspi_search *search, aspi_point *at, const int *free_axes, int rounds,
                             asp_error *err)
{
    aspi_problem *p = search->problem;
    double soften = 1;
    for (int round = 0; round < rounds && soften > 1e-3 && !vanishes(p, at->loss); round++) {
        int info;
        aspi_point next = *at;
        aspi_problem_reweight(p, at, soften);
        asp_status status = descend(search, &next, free_axes, 3, &info, err);
        if (status)
            return status;
        aspi_problem_colours(p, &next, 60);
        /* weights of nearly fitted points pin a search down: they grow only when it has come to rest */
        if (at->loss - next.loss < 1e-3 * at->loss)
            soften *= 0.25;
        if (next.loss < at->loss)
            *at = next;
    }
    return ASP_OK;
}

asp_status aspi_polish(aspi_search *search, aspi_point *at, const int *free_axes, int rounds,
                       asp_error *err)
{
    aspi_problem *p = search->problem;
    asp_status status;
    search->reason = ASP_FIT_SINGULAR;
    if (!isfinite(at->loss))
        return ASP_OK;
    if (p->loss->power == 2) {
        int info;
        aspi_point next = *at;
        aspi_problem_reweight(p, at, 1);
        status = descend(search, &next, free_axes, 4 * rounds, &info, err);
        if (status)
            return status;
        aspi_problem_colours(p, &next, 60);
        if (next.loss < at->loss)
            *at = next;
        search->reason = reason_of(info);
        /* slopes of a valley whose colours are at their limits turn abruptly */
        if (info == 5 && rounds > COARSE_ROUNDS) {
            int flat;
            status = aspi_simplex(search, at, free_axes, &flat, err);
            search->reason = flat ? ASP_FIT_LOSS : ASP_FIT_EVALUATIONS;
        }
    } else {
        int flat = 0;
        status = reweighted(search, at, free_axes, rounds, err);
        if (!status && rounds > COARSE_ROUNDS && !vanishes(p, at->loss))
            status = aspi_simplex(search, at, free_axes, &flat, err);
        search->reason = flat ? ASP_FIT_LOSS : ASP_FIT_EVALUATIONS;
    }
    if (vanishes(p, at->loss))
        search->reason = ASP_FIT_EXACT;
    return status;
}

asp_status aspi_try_ends(aspi_search *search, aspi_point *at, int rounds, asp_error *err)
{
    aspi_problem *p = search->problem;
    asp_fit_reason reason = search->reason;
    for (int i = 0; i < p->box.n; i++) {
        const aspi_axis *axis = &p->box.axis[i];
        double near_low = at->b[i] - axis->b_low, near_high = axis->b_high - at->b[i];
        if (fmin(near_low, near_high) > NEAR || fmin(near_low, near_high) == 0)
            continue;
        int free_axes[ASPI_AXES];
        for (int k = 0; k < p->box.n; k++)
            free_axes[k] = k != i && at->b[k] > p->box.axis[k].b_low
                                  && at->b[k] < p->box.axis[k].b_high;
        aspi_point end = *at;
        end.b[i] = near_low < near_high ? axis->b_low : axis->b_high;
        aspi_problem_colours(p, &end, 60);
        asp_status status = aspi_polish(search, &end, free_axes, rounds, err);
        if (status)
            return status;
        if (end.loss <= at->loss) {
            *at = end;
            reason = search->reason;
        }
    }
    search->reason = reason;
    return ASP_OK;
}
