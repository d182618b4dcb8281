/* report_json.c - fit.json: the same keys in the same order, numbers that read back exactly */
#include "report.h"

#include <math.h>

/* JSON has no infinity: it is written as the word that specs use; what is not a number as null. */
static json_t *number(double x)
{
    if (isnan(x))
        return json_null();
    if (isinf(x))
        return json_string(x < 0 ? "-inf" : "inf");
    return json_real(x);
}

static json_t *parameter(const asp_fit_parameter *p)
{
    return json_pack("{s:s, s:o, s:o, s:o, s:o, s:i, s:b}", "name", p->name, "value",
                     number(p->value), "uncertainty", number(p->uncertainty), "low",
                     number(p->low), "high", number(p->high), "at_bound", p->at_bound, "determined",
                     p->determined);
}

static json_t *result(const asp_fit_result *f, int best)
{
    json_t *errors = json_object(), *parameters = json_array(), *correlation = json_array();
    for (size_t i = 0; asp_losses()[i]; i++)
        json_object_set_new(errors, asp_losses()[i]->name, number(f->error[i]));
    for (size_t k = 0; k < f->parameter_count; k++) {
        json_t *row = json_array();
        json_array_append_new(parameters, parameter(&f->parameter[k]));
        for (size_t m = 0; m < f->parameter_count; m++)
            json_array_append_new(row, number(f->correlation[k * ASP_FIT_PARAMETERS + m]));
        json_array_append_new(correlation, row);
    }
    return json_pack("{s:s, s:b, s:s, s:o, s:o, s:o, s:I, s:i, s:s}", "model", f->model->name, "best",
                     best, "spec", f->spec, "errors", errors, "parameters", parameters,
                     "correlation", correlation, "evaluations", (json_int_t)f->evaluations, "reason",
                     (int)f->reason, "reason_text", asp_fit_reason_text(f->reason));
}

static json_t *rgb(asp_rgb c)
{
    return json_pack("[f, f, f]", c.r, c.g, c.b);
}

static json_t *fabricated(const asp_fabrication *made, const asp_fabrication_report *truth)
{
    const asp_surface_recipe *s = &made->surface;
    const asp_slope_statistics *p = &truth->slopes;
    json_t *recipe = json_pack("{s:I, s:i, s:f, s:f, s:f, s:o, s:s, s:I}", "seed",
                               (json_int_t)s->seed, "size", s->size, "correlation", s->correlation,
                               "patch", s->patch, "alpha", s->alpha, "gamma", number(s->gamma),
                               "metal", made->metal ? made->metal->name : "none", "rays",
                               (json_int_t)made->rays);
    json_t *slopes = json_pack("{s:I, s:f, s:f, s:f, s:f, s:f}", "facets", (json_int_t)p->facets,
                               "alpha", p->alpha, "gamma", p->gamma, "alpha_ggx", p->alpha_ggx,
                               "alpha_beckmann", p->alpha_beckmann, "rms_x", p->rms_x);
    return json_pack("{s:o, s:o, s:o, s:o, s:f}", "recipe", recipe, "slopes", slopes, "albedo",
                     rgb(truth->albedo), "multiple", rgb(truth->multiple), "noise", truth->noise);
}

json_t *report_json(const report *r)
{
    json_t *results = json_array();
    for (size_t i = 0; i < r->count; i++)
        json_array_append_new(results, result(&r->result[i], i == r->best));
    json_t *out = json_pack("{s:s, s:s, s:s, s:b, s:b, s:i, s:I, s:I, s:s, s:s, s:I, s:i, s:s, s:f}",
                            "name", r->title, "format", r->info.format, "description",
                            r->info.description, "isotropic", r->info.isotropic, "scattered",
                            r->info.scattered, "channels", r->info.channels, "samples",
                            (json_int_t)r->info.samples, "geometries", (json_int_t)r->geometries,
                            "loss", r->loss, "loss_definition",
                            asp_losses()[r->loss_index]->definition, "seed", (json_int_t)r->seed,
                            "starts", r->starts, "mask", report_mask_name(r->mask), "specular_limit",
                            r->specular_limit);
    if (out && r->made)
        json_object_set_new(out, "fabricated", fabricated(r->made, r->truth));
    if (out)
        json_object_set_new(out, "results", results);
    else
        json_decref(results);
    return out;
}
