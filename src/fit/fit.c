/* fit.c - the public call */
#include "fit.h"
#include "data/io.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LOSS "log_relative"
#define MODELS 32
#define STARTS 4
#define COARSE 1200            /* geometries, about, on which starts are compared */
#define COARSE_ROUNDS 6
#define FINALISTS 3            /* how many points are polished on all geometries */
#define ROUNDS 20

const char *asp_fit_reason_text(asp_fit_reason reason)
{
    switch (reason) {
    case ASP_FIT_EXACT:       return "exact: nothing but rounding is left";
    case ASP_FIT_STEP:        return "converged: the parameters no longer move";
    case ASP_FIT_LOSS:        return "converged: the loss no longer falls";
    case ASP_FIT_EVALUATIONS: return "stopped at the limit of evaluations";
    case ASP_FIT_SINGULAR:    return "failed: no start gave a finite loss";
    }
    return "unknown reason";
}

/* How many numbers of a distribution a search moves. */
static size_t numbers_of(const asp_model *model)
{
    return model->param_count + (model->own_scale ? 0 : 1);
}

/* The same formulas with as many numbers: isotropic, that is the same family of lobes. */
static int is_same_family(const asp_model *a, const asp_model *b)
{
    return a->f64.density == b->f64.density && numbers_of(a) == numbers_of(b);
}

size_t asp_fit_models(const asp_model **out, size_t room)
{
    const asp_model *const *all = asp_models();
    size_t n = 0;
    for (size_t i = 0; all[i]; i++) {
        size_t before = 0;
        while (before < i && !is_same_family(all[before], all[i]))
            before++;
        if (before < i)
            continue;
        if (n < room)
            out[n] = all[i];
        n++;
    }
    return n;
}

/* ------------------------------------------------------------------ one call */

typedef struct job {
    const asp_model *model[MODELS];
    size_t order[MODELS];                        /* fewest shape numbers first */
    size_t count, done;
    const aspi_loss *loss;
    asp_fit_options options;
    aspi_fit_set coarse, fine;
    aspi_box   box[MODELS];
    aspi_point optimum[MODELS];
    size_t asked;                                /* by the model at work */
} job;

/* How long a search takes is not known beforehand: each question closes a part of what is left. */
static int cancelled(void *context)
{
    job *j = context;
    double part = 1 - exp(-(double)j->asked++ / 300.0);
    return j->options.progress(j->options.context, ((double)j->done + part) / (double)j->count);
}

static aspi_search search_of(job *j, aspi_problem *p)
{
    return (aspi_search){ .problem = p, .reason = ASP_FIT_SINGULAR,
                          .cancelled = j->options.progress ? cancelled : NULL, .context = j };
}

/* Starts on the coarse set, each polished a little; their order is that of the coarse losses. */
static asp_status survey(job *j, size_t k, aspi_point *out, size_t *found, size_t *evaluations,
                         asp_error *err)
{
    aspi_problem p;
    size_t limit = (size_t)j->options.starts;
    asp_status status = aspi_problem_make(j->model[k], j->loss, &j->coarse, &j->options, &p, err);
    if (status)
        return status;
    aspi_search search = search_of(j, &p);
    status = aspi_starts(&search, j->options.seed, limit, out, found, err);
    for (size_t i = 0; i < *found && !status; i++)
        status = aspi_polish(&search, &out[i], NULL, COARSE_ROUNDS, err);
    *evaluations += p.evaluations;
    aspi_problem_free(&p);
    return status;
}

static void best_first(aspi_point *point, size_t n)
{
    for (size_t i = 1; i < n; i++)
        for (size_t k = i; k && point[k].loss < point[k - 1].loss; k--) {
            aspi_point swap = point[k];
            point[k] = point[k - 1];
            point[k - 1] = swap;
        }
}

/* The candidates on the fine set, the best of them polished to the end. */
static asp_status finish(job *j, size_t k, aspi_problem *p, aspi_point *candidate, size_t n,
                         asp_fit_result *out, asp_error *err)
{
    aspi_search search = search_of(j, p);
    asp_status status = ASP_OK;
    for (size_t i = 0; i < n; i++)
        aspi_problem_colours(p, &candidate[i], 60);
    /* optima of simpler models last in time: their loss is kept as it is, to the bit */
    for (size_t i = 0; i < j->done; i++) {
        size_t other = j->order[i];
        if (j->box[other].shape && p->box.shape
            && j->model[other]->param_count < j->model[k]->param_count)
            candidate[n++] = aspi_translate(&search, &j->box[other], &j->optimum[other]);
    }
    best_first(candidate, n);
    aspi_point best = candidate[0];
    asp_fit_reason reason = ASP_FIT_SINGULAR;
    for (size_t i = 0; i < n && i < FINALISTS && !status; i++) {
        if (i && candidate[i].loss == candidate[i - 1].loss)
            continue;
        status = aspi_polish(&search, &candidate[i], NULL, ROUNDS, err);
        if (i == 0 || candidate[i].loss < best.loss) {
            best = candidate[i];
            reason = search.reason;
        }
    }
    search.reason = reason;
    if (!status)
        status = aspi_try_ends(&search, &best, ROUNDS, err);
    j->optimum[k] = best;
    out->reason = search.reason;
    return status;
}

/* ------------------------------------------------------------------ the result */

typedef struct text { char *to; size_t size, used; } text;

static void put(text *t, const char *words)
{
    size_t n = strlen(words);
    if (t->used + n < t->size) {
        memcpy(t->to + t->used, words, n + 1);
        t->used += n;
    }
}

static void put_number(text *t, const char *before, double value)
{
    char digits[ASPI_NUMBER_TEXT];
    put(t, before);
    if (isinf(value))
        put(t, value < 0 ? "-inf" : "inf");
    else {
        aspi_format_number(value, 17, digits);
        put(t, digits);
    }
}

static void put_colour(text *t, const char *before, const double *rgb, int channels)
{
    put_number(t, before, rgb[0]);
    if (channels == 1)
        return;
    put_number(t, "/", rgb[1]);
    put_number(t, "/", rgb[2]);
}

/* `lambert_specular:...,ndf=(model:alpha=...,shape...)`, which asp_material_parse reads back. */
static void write_spec(const aspi_problem *p, const aspi_point *at, char *out, size_t size)
{
    static const char *const group[] = { "correlated", "uncorrelated", "v_cavity" };
    text t = { out, size, 0 };
    const aspi_axis *axis = p->box.axis;
    int eta = p->box.n - 1, first = p->box.shape, own_alpha = 0;
    put_colour(&t, "lambert_specular:diffuse=", at->colour, p->set->channels);
    put_colour(&t, ",specular=", at->colour + 3, p->set->channels);
    put_number(&t, ",eta=", aspi_axis_value(&axis[eta], at->b[eta]));
    if (p->mask) {
        put(&t, ",mask=");
        put(&t, group[p->mask & 3]);
        put(&t, p->mask & ASP_MASK_WALL ? "+wall" : "");
    }
    put(&t, ",ndf=(");
    put(&t, p->model->name);
    for (int i = first; i < eta; i++)
        own_alpha |= !strcmp(axis[i].name, "alpha");
    if (first) {
        double alpha = aspi_axis_value(&axis[0], at->b[0]);
        put_number(&t, own_alpha ? ":alpha_x=" : ":alpha=", alpha);
        if (own_alpha)
            put_number(&t, ",alpha_y=", alpha);
    }
    for (int i = first; i < eta; i++) {
        put(&t, i ? "," : ":");
        put(&t, axis[i].name);
        put_number(&t, "=", aspi_axis_value(&axis[i], at->b[i]));
    }
    put(&t, ")");
}

/* The errors of every loss; leaves the weights of the fitted one behind. */
static void all_errors(job *j, aspi_problem *p, const aspi_point *at, double *out)
{
    aspi_fit_set *set = &j->fine;
    for (size_t i = 0; aspi_losses[i]; i++) {
        p->loss = aspi_losses[i];
        aspi_fit_set_weights(set, p->loss);
        double sum = aspi_problem_loss(p, at), scale = 0;
        for (int c = 0; c < 3; c++)
            scale += p->loss->scale(set->n, set->data[c], set->weight);
        out[i] = p->loss->power == 1 ? sum / scale : sqrt(sum / scale);
    }
    p->loss = j->loss;
    aspi_fit_set_weights(set, j->loss);
}

static asp_status describe(job *j, size_t k, aspi_problem *p, asp_fit_result *out, asp_error *err)
{
    const aspi_point *at = &j->optimum[k];
    const double *x = at->colour;
    int eta = p->box.n - 1;
    asp_ndf ndf;
    out->model = j->model[k];
    out->geometries = p->set->n;
    if (!isfinite(at->loss) || aspi_problem_ndf(p, at->b, &ndf) != ASP_OK) {
        char reason[160];
        snprintf(reason, sizeof reason, "no start of '%s' gave a finite loss", out->model->name);
        return asp_fail(err, ASP_EFORMAT, "", reason);
    }
    out->material = asp_lambert_specular(&ndf, (asp_rgb){ x[0], x[1], x[2] },
                                         (asp_rgb){ x[3], x[4], x[5] },
                                         aspi_axis_value(&p->box.axis[eta], at->b[eta]), p->mask);
    write_spec(p, at, out->spec, sizeof out->spec);
    asp_status status = aspi_uncertainties(p, at, out, err);
    all_errors(j, p, at, out->error);
    return status;
}

static asp_status fit_model(job *j, size_t k, asp_fit_result *out, asp_error *err)
{
    aspi_problem p;
    size_t found = 0, evaluations = 0, room = (size_t)j->options.starts + MODELS;
    aspi_point *candidate = calloc(room, sizeof *candidate);
    if (!candidate)
        return asp_fail(err, ASP_ENOMEM, "", "not enough memory for the fit");
    memset(out, 0, sizeof *out);
    j->asked = 0;
    asp_status status = survey(j, k, candidate, &found, &evaluations, err);
    if (!status)
        status = aspi_problem_make(j->model[k], j->loss, &j->fine, &j->options, &p, err);
    if (!status) {
        j->box[k] = p.box;
        if (found)
            status = finish(j, k, &p, candidate, found, out, err);
        else
            j->optimum[k].loss = INFINITY;
        if (!status)
            status = describe(j, k, &p, out, err);
        out->evaluations = evaluations + p.evaluations;
        aspi_problem_free(&p);
    }
    free(candidate);
    return status;
}

/* ------------------------------------------------------------------ the public call */

static asp_status check(job *j, const asp_fit_options *options, asp_error *err)
{
    memset(j, 0, sizeof *j);
    if (options)
        j->options = *options;
    asp_fit_options *o = &j->options;
    if (!o->starts)
        o->starts = STARTS;
    if (o->starts < 1 || o->starts > 64)
        return asp_fail_range(err, "starts", o->starts, 1, 0, 64);
    if (o->specular_limit == 0)
        o->specular_limit = 1;
    if (!(o->specular_limit > 0 && o->specular_limit <= 1000))
        return asp_fail_range(err, "specular_limit", o->specular_limit, 0, 1, 1000);
    if ((o->mask & ~ASP_MASK_WALL) < 0 || (o->mask & ~ASP_MASK_WALL) > ASP_MASK_V_CAVITY)
        return asp_fail(err, ASP_EINVAL, "mask", "not one of asp_mask");
    const char *name = o->loss ? o->loss : LOSS;
    j->loss = aspi_find_loss(name);
    if (!j->loss) {
        char reason[192] = "unknown loss; known are";
        for (size_t i = 0; aspi_losses[i]; i++) {
            strncat(reason, i ? ", " : " ", sizeof reason - strlen(reason) - 1);
            strncat(reason, aspi_losses[i]->about.name, sizeof reason - strlen(reason) - 1);
        }
        return asp_fail(err, ASP_EUNKNOWN, name, reason);
    }
    if (o->models)
        for (; o->models[j->count] && j->count < MODELS; j->count++)
            j->model[j->count] = o->models[j->count];
    else
        j->count = asp_fit_models(j->model, MODELS);
    if (j->count < 1 || j->count > MODELS || (o->models && o->models[j->count]))
        return asp_fail_range(err, "models", (double)j->count, 1, 0, MODELS);
    for (size_t i = 0; i < j->count; i++) {
        size_t k = i;
        for (; k && numbers_of(j->model[j->order[k - 1]]) > numbers_of(j->model[i]); k--)
            j->order[k] = j->order[k - 1];
        j->order[k] = i;
    }
    return ASP_OK;
}

/* Data from which nothing can follow. */
static asp_status check_data(const job *j, const asp_measurement *item, size_t n, int channels,
                             asp_error *err)
{
    size_t values = n * (size_t)channels, i = 0;
    char reason[160];
    while (i < n && !(item[i].f.r > 0 || item[i].f.g > 0 || item[i].f.b > 0))
        i++;
    if (i == n)
        return asp_fail(err, ASP_EFORMAT, "", "every value is 0: there is nothing to fit");
    for (size_t k = 0; k < j->count; k++) {
        aspi_box box = aspi_box_make(j->model[k]);
        size_t parameters = (size_t)box.n + 2 * (size_t)channels;
        if (values >= parameters)
            continue;
        snprintf(reason, sizeof reason, "%zu value%s below 80 degrees cannot determine the %zu "
                 "parameters of '%s'", values, values == 1 ? "" : "s", parameters,
                 j->model[k]->name);
        return asp_fail(err, ASP_EFORMAT, "", reason);
    }
    return ASP_OK;
}

asp_status asp_fit(const asp_measured *measured, const asp_fit_options *options,
                   asp_fit_result **results, size_t *count, asp_error *err)
{
    if (!results || !count)
        return asp_fail(err, ASP_EINVAL, results ? "count" : "results", "nothing given");
    job *j = malloc(sizeof *j);
    if (!j)
        return asp_fail(err, ASP_ENOMEM, "", "not enough memory for the fit");
    asp_status status = check(j, options, err);
    size_t n = 0;
    asp_measurement *item = NULL;
    asp_fit_result *out = NULL;
    asp_error why;
    if (!status && !(item = asp_fit_geometries(measured, &n, &why))) {
        status = why.status;
        if (err)
            *err = why;
    }
    int channels = status ? 0 : asp_measured_get_info(measured).channels;
    if (!status)
        status = check_data(j, item, n, channels, err);
    if (!status && !(out = calloc(j->count, sizeof *out)))
        status = asp_fail(err, ASP_ENOMEM, "", "not enough memory for the results");
    if (!status)
        status = aspi_fit_set_make(item, n, 1, channels, &j->fine, err);
    if (!status)
        status = aspi_fit_set_make(item, n, 1 + n / COARSE, channels, &j->coarse, err);
    if (!status) {
        aspi_fit_set_weights(&j->fine, j->loss);
        aspi_fit_set_weights(&j->coarse, j->loss);
    }
    for (; !status && j->done < j->count; j->done++)
        status = fit_model(j, j->order[j->done], &out[j->order[j->done]], err);
    if (!status) {
        *results = out;
        *count = j->count;
        out = NULL;
    }
    aspi_fit_set_free(&j->fine);
    aspi_fit_set_free(&j->coarse);
    free(item);
    free(out);
    free(j);
    return status;
}
