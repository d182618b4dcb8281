/* cmd_convert_ndf.c - one distribution in other words: matrices, moments, roughness as other systems count
 * it, the nearest distribution of another model */
#include "cmd.h"
#include "asperity_convert.h"
#include "bsdf/spec.h"
#include "notebook.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define NAMES 64
#define LINE 640

static const char *const representations[] = { "roughness", "map", "matrix", "gram", "moments", NULL };

/* ------------------------------------------------------------------ one answer */

/* `name=value,...` for people and pipes, an object for JSON. */
typedef struct answer {
    char    text[LINE];
    json_t *values;          /* NULL unless asked for */
    int     digits;
} answer;

static void put(answer *a, const char *key, double value)
{
    char number[ASPI_NUMBER_TEXT] = "inf";
    size_t used = strlen(a->text);
    if (!isinf(value))
        aspi_format_number(value == 0 ? 0 : value, a->digits, number);      /* no -0 */
    snprintf(a->text + used, sizeof a->text - used, "%s%s=%s", used ? "," : "", key, number);
    if (a->values)
        json_object_set_new(a->values, key, isinf(value) ? json_string("inf") : json_real(value));
}

/* Does the roughness stand in the model's own numbers, and not in the map? */
static int rough_by_itself(const asp_model *model)
{
    static const asp_map identity = { 1, 0, 0, 1, 0, 0 };
    asp_ndf plain;
    return model->own_scale
        && (asp_ndf_make(model, &identity, NULL, &plain, NULL) || plain.map.m00 == 1);
}

/* A representation of a distribution, or what a convention says of it. */
static asp_status represent(const asp_ndf *ndf, const char *what, answer *a, asp_error *err)
{
    static const char *const a_keys[] = { "a11", "a12", "a13", "a21", "a22", "a23", "a31", "a32", "a33" };
    static const char *const s_keys[] = { "s11", "s12", "s13", NULL, "s22", "s23", NULL, NULL, "s33" };
    const asp_map *map = &ndf->map;
    const asp_convention *c = asp_find_convention(what);
    asp_roughness r = asp_map_to_roughness(map);
    double A[9], numbers[ASP_CONVENTION_NUMBERS];
    asp_status status = ASP_OK;
    asp_map_to_matrix(map, A);
    if (c && rough_by_itself(ndf->model)) {
        status = asp_fail(err, ASP_EINVAL, ndf->model->name,
                          "its own numbers carry the roughness: take the nearest ggx or beckmann first");
    } else if (c) {
        status = asp_convention_from_alpha(c, &r, numbers, err);
        for (size_t i = 0; !status && i < c->param_count; i++)
            put(a, c->params[i].name, numbers[i]);
    } else if (strcmp(what, "roughness") == 0) {
        put(a, "alpha_x", r.alpha_x);
        put(a, "alpha_y", r.alpha_y);
        put(a, "rotation", r.rotation);
        put(a, "mean_x", r.mean_x);
        put(a, "mean_y", r.mean_y);
    } else if (strcmp(what, "map") == 0) {
        put(a, "m00", map->m00);
        put(a, "m01", map->m01);
        put(a, "m10", map->m10);
        put(a, "m11", map->m11);
        put(a, "tx", map->tx);
        put(a, "ty", map->ty);
    } else if (strcmp(what, "matrix") == 0) {
        for (int i = 0; i < 9; i++)
            put(a, a_keys[i], A[i]);
    } else if (strcmp(what, "gram") == 0) {
        for (int i = 0; i < 9; i++)
            if (s_keys[i])
                put(a, s_keys[i], A[i / 3] * A[i % 3] + A[3 + i / 3] * A[3 + i % 3]
                                  + A[6 + i / 3] * A[6 + i % 3]);
    } else {
        asp_moments m;
        status = asp_ndf_moments(ndf, &m, err);
        if (!status) {
            put(a, "mean_x", m.mean_x);
            put(a, "mean_y", m.mean_y);
            put(a, "xx", m.xx);
            put(a, "xy", m.xy);
            put(a, "yy", m.yy);
        }
    }
    return status;
}

/* ------------------------------------------------------------------ reading what is given */

static size_t head(const char *text) { return strcspn(text, ":"); }

static int named(const char *text, const char *name)
{
    return strlen(name) == head(text) && strncmp(text, name, head(text)) == 0;
}

static int first_word(const char *text, char name[64])
{
    snprintf(name, 64, "%.*s", (int)head(text), text);
    return (int)head(text) < 64;
}

/* What stands for `given` in an error, and the error. */
static int bad(const char *given, const char *spec, const asp_error *err)
{
    char line[LINE];
    return cmd_usage("%s%s: %s", given, spec, asp_error_text(err, line, sizeof line));
}

/* moments:mean_x=...,xx=...: the distribution of --as that has them. */
static int from_moments(const char *text, const char *as, asp_ndf *out)
{
    asp_moments m = { 0, 0, 0, 0, 0 };
    asp_ndf shape;
    asp_map map;
    aspi_spec spec;
    asp_error err;
    int has[2];
    if (asp_ndf_parse(NULL, as, &shape, &err))
        return cmd_bad_ndf("--as ", as, &err);
    if (aspi_spec_cut(text, strlen(text), &spec, &err)
        || aspi_spec_number(&spec, "mean_x", &m.mean_x, NULL, &err)
        || aspi_spec_number(&spec, "mean_y", &m.mean_y, NULL, &err)
        || aspi_spec_number(&spec, "xx", &m.xx, &has[0], &err)
        || aspi_spec_number(&spec, "xy", &m.xy, NULL, &err)
        || aspi_spec_number(&spec, "yy", &m.yy, &has[1], &err)
        || aspi_spec_rest(&spec, "unknown key; moments take mean_x mean_y xx xy yy", &err))
        return bad("", text, &err);
    if (!has[0] || !has[1])
        return cmd_usage("%s: moments need xx and yy, the means of the squared slopes", text);
    if (asp_map_from_moments(shape.model, shape.shape, &m, &map, &err)
        || asp_ndf_make(shape.model, &map, shape.shape, out, &err))
        return bad("", text, &err);
    return CMD_OK;
}

static int from_convention(const char *text, const char *as, asp_ndf *out)
{
    const asp_convention *which;
    asp_roughness r;
    asp_ndf shape;
    asp_map map;
    asp_error err;
    if (asp_ndf_parse(NULL, as, &shape, &err))
        return cmd_bad_ndf("--as ", as, &err);
    if (asp_convention_parse(text, &which, &r, &err)
        || asp_map_from_roughness(r.alpha_x, r.alpha_y, r.rotation, 0, 0, &map, &err)
        || asp_ndf_make(shape.model, &map, shape.shape, out, &err))
        return bad("", text, &err);
    return CMD_OK;
}

static int read_source(const cmd_args *args, asp_ndf *out)
{
    const char *text = cmd_operand(args, 0), *as = cmd_text(args, "as");
    char name[64];
    asp_error err;
    int moments = named(text, "moments"), convention = first_word(text, name) && asp_find_convention(name);
    if (as && !moments && !convention)
        return cmd_usage("--as goes with moments and roughness conventions; %s is a distribution", text);
    if (moments)
        return from_moments(text, as ? as : "beckmann", out);
    if (convention)
        return from_convention(text, as ? as : "ggx", out);
    if (asp_ndf_parse(NULL, text, out, &err) == ASP_OK)
        return CMD_OK;
    if (err.status != ASP_EUNKNOWN || err.position != 0)
        return bad("", text, &err);
    const char *names[NAMES];
    size_t used = 0;
    for (const asp_model *const *m = asp_models(); *m && used < NAMES / 2; m++)
        names[used++] = (*m)->name;
    for (const asp_convention *const *c = asp_conventions(); *c && used < NAMES - 2; c++)
        names[used++] = (*c)->name;
    names[used++] = "moments";
    names[used] = NULL;
    return cmd_unknown("unknown distribution or convention", err.name, names);
}

/* ------------------------------------------------------------------ the nearest of a model */

/* `abc:gamma=1.75`: what is given stays, the rest is free. */
static int read_family(const char *text, const asp_model *model, asp_nearest_options *o)
{
    aspi_spec spec;
    asp_error err;
    int found, own_alpha = 0;
    if (aspi_spec_cut(text, strlen(text), &spec, &err))
        return bad("--to ", text, &err);
    for (size_t k = 0; k < model->param_count; k++) {
        if (aspi_spec_number(&spec, model->params[k].name, &o->shape[k], &found, &err))
            return bad("--to ", text, &err);
        o->fixed |= found ? 1u << k : 0;
        own_alpha |= strcmp(model->params[k].name, "alpha") == 0;
    }
    found = 0;
    if (!own_alpha && aspi_spec_number(&spec, "alpha", &o->alpha, &found, &err))
        return bad("--to ", text, &err);
    if (found && !(o->alpha >= 1e-5 && o->alpha <= 100)) {
        asp_fail_range(&err, "alpha", o->alpha, 1e-5, 0, 100);
        return bad("--to ", text, &err);
    }
    if (aspi_spec_rest(&spec, "unknown key; what may be held is alpha and the model's own numbers: axes and "
                       "mean slope are the given distribution's", &err))
        return bad("--to ", text, &err);
    return CMD_OK;
}

static int nearest(const cmd_args *args, const asp_ndf *ndf, const char *to, const asp_model *model,
                   json_t *list)
{
    asp_nearest_options o = { .norm = cmd_text(args, "norm") };
    asp_nearest_result *r = malloc(sizeof *r);
    asp_error err;
    char spec[ASP_NDF_TEXT];
    int status = r ? read_family(to, model, &o) : cmd_failed("out of memory");
    if (status == CMD_OK && asp_nearest(ndf, model, &o, r, &err))
        status = err.status == ASP_ENOMEM ? cmd_error(&err) : bad("--to ", to, &err);
    if (status == CMD_OK) {
        json_t *errors = list ? json_object() : NULL;
        asp_ndf_text(&r->ndf, (int)cmd_integer(args, "digits"), spec, sizeof spec);
        if (!list)
            printf("%s\n ", spec);
        for (int i = 0; asp_norms()[i]; i++) {
            if (list)
                json_object_set_new(errors, asp_norms()[i]->name, json_real(r->errors[i]));
            else if (strcmp(asp_norms()[i]->name, "peak") != 0)
                printf(" %s %.4g%s", asp_norms()[i]->name, r->errors[i],
                       strcmp(asp_norms()[i]->name, o.norm) ? "" : "*");
        }
        if (list)
            json_array_append_new(list, json_pack("{s:s, s:s, s:s, s:f, s:f, s:o}", "to", to, "spec", spec,
                                                  "norm", o.norm, "error", r->error, "peak", r->peak,
                                                  "errors", errors));
        else
            printf("; peak %.6g\n", r->peak);
    }
    free(r);
    return status;
}

/* ------------------------------------------------------------------ answers */

static int answer_one(const cmd_args *args, const asp_ndf *ndf, const char *to, int all, json_t *list)
{
    char name[64];
    const asp_model *model = first_word(to, name) ? asp_find_model(NULL, name) : NULL;
    const asp_convention *convention = asp_find_convention(to);
    answer a = { "", NULL, (int)cmd_integer(args, "digits") };
    asp_error err;
    if (model)
        return nearest(args, ndf, to, model, list);
    if (cmd_find(to, representations) < 0 && !convention) {
        const char *names[NAMES];
        size_t used = 0;
        for (int i = 0; representations[i]; i++)
            names[used++] = representations[i];
        for (const asp_convention *const *c = asp_conventions(); *c && used < NAMES / 2; c++)
            names[used++] = (*c)->name;
        for (const asp_model *const *m = asp_models(); *m && used < NAMES - 1; m++)
            names[used++] = (*m)->name;
        names[used] = NULL;
        return cmd_unknown("--to: unknown", name, names);
    }
    if (list)
        a.values = json_object();
    asp_status status = represent(ndf, to, &a, &err);
    if (status && !all) {
        json_decref(a.values);
        return bad("--to ", to, &err);
    }
    if (list && status)
        json_object_set_new(a.values, "reason", json_string(err.reason));
    if (list)
        json_array_append_new(list, json_pack("{s:s, s:b, s:o}", "to", to, "possible", !status, "values",
                                              a.values));
    else if (status)
        printf("%-10s - (%s)\n", to, isnan(err.value) ? err.reason : "out of its range");
    else if (all)
        printf("%-10s %s%s%s\n", to, convention ? to : "", convention ? ":" : "", a.text);
    else
        printf("%s%s%s\n", convention ? to : "", convention ? ":" : "", a.text);
    return CMD_OK;
}

static int conventions_table(int json)
{
    json_t *list = json_array();
    for (const asp_convention *const *p = asp_conventions(); *p; p++) {
        const asp_convention *c = *p;
        json_t *numbers = json_array();
        if (!json)
            printf("%s%s%s: %s\n  alpha_x, alpha_y = %s\n  back: %s\n  source: %s\n", c->name,
                   c->alias ? ", " : "", c->alias ? c->alias : "", c->title, c->formula, c->inverse, c->source);
        for (size_t i = 0; i < c->param_count; i++) {
            const asp_param *n = &c->params[i];
            if (!json)
                printf("  %-18s %s%g, %g], default %g: %s\n", n->name, n->low_open ? "(" : "[", n->low,
                       n->high, n->initial, n->what);
            json_array_append_new(numbers, json_pack("{s:s, s:f, s:b, s:f, s:f, s:s}", "name", n->name,
                "low", n->low, "low_refused", n->low_open, "high", n->high, "default", n->initial, "what",
                n->what));
        }
        json_array_append_new(list, json_pack("{s:s, s:o, s:s, s:s, s:s, s:s, s:o}", "name", c->name, "also",
            c->alias ? json_string(c->alias) : json_null(), "title", c->title, "formula", c->formula,
            "inverse", c->inverse, "source", c->source, "numbers", numbers));
    }
    if (json)
        return cmd_print_json(list);
    json_decref(list);
    return CMD_OK;
}

static int convert(const cmd_args *args, json_t *list)
{
    asp_ndf ndf;
    int status = read_source(args, &ndf);
    size_t wanted = cmd_given(args, "to");
    for (size_t i = 0; status == CMD_OK && i < wanted; i++)
        status = answer_one(args, &ndf, cmd_text_at(args, "to", i), 0, list);
    for (int i = 0; status == CMD_OK && !wanted && representations[i]; i++)
        status = answer_one(args, &ndf, representations[i], 1, list);
    for (const asp_convention *const *c = asp_conventions(); status == CMD_OK && !wanted && *c; c++)
        status = answer_one(args, &ndf, (*c)->name, 1, list);
    return status;
}

static int run(const cmd_args *args)
{
    int table = cmd_given(args, "table") > 0, conventions = cmd_given(args, "conventions") > 0;
    int json = cmd_given(args, "json") > 0, operands = (int)cmd_operand_count(args), status;
    const char *names[ASP_NORM_LIMIT + 1] = { NULL };
    for (int i = 0; asp_norms()[i]; i++)
        names[i] = asp_norms()[i]->name;
    if (cmd_find(cmd_text(args, "norm"), names) < 0)
        return cmd_unknown("unknown norm", cmd_text(args, "norm"), names);
    if (table + conventions + operands > 1)
        return cmd_usage("a SPEC, --table and --conventions: only one of them");
    if ((table || conventions) && cmd_given(args, "to"))
        return cmd_usage("--to goes with a SPEC");
    if (conventions)
        return conventions_table(json);
    if (table)
        return notebook_table(json);
    if (!operands)
        return cmd_usage("nothing to convert: give a SPEC, or --table or --conventions");
    json_t *list = json ? json_array() : NULL;
    status = convert(args, list);
    if (status == CMD_OK && json)
        return cmd_print_json(list);
    json_decref(list);
    return status;
}

static const cmd_option options[] = {
    { "to", 0, "WHAT", CMD_TEXT, .many = 1,
      .help = "roughness, map, matrix, gram, moments, a convention, or a distribution: then the nearest "
              "one, with what is given (abc:gamma=1.75) held" },
    { "norm", 0, "NAME", CMD_TEXT, .initial = "theta",
      .help = "what nearest means: theta, l2, l2_cos, l1_cos, slope, log, peak" },
    { "as", 0, "SPEC", CMD_TEXT,
      .help = "which distribution a convention's roughness is for (ggx), or has the moments (beckmann)" },
    { "digits", 0, "N", CMD_INTEGER, 1, 17, .initial = "9", .help = "significant digits of what is printed" },
    { "conventions", 0, NULL, CMD_FLAG, .help = "list how other systems count roughness" },
    { "table", 0, NULL, CMD_FLAG, .help = "the fits by hand in Hoffman's notebook of 2013, and computed" },
    { "json", 0, NULL, CMD_FLAG, .help = "write JSON" },
    CMD_END
};

const cmd_record cmd_convert_ndf = {
    "convert-ndf", "write a distribution in other terms, or find the nearest of another model", "[SPEC]", 0, 1,
    "SPEC is a distribution, a roughness as another system counts it, or moments of\n"
    "slopes (those of LEAN mapping; its B is the mean slope with the other sign).\n"
    "Without --to: everything but the nearest distributions.\n"
    "\n"
    "  asperity convert-ndf disney:roughness=0.5,anisotropic=0.3\n"
    "  asperity convert-ndf gltf:roughness=0.4 --to beckmann --to pbrt\n"
    "  asperity convert-ndf ggx:alpha=0.3 --to abc:gamma=1.75 --norm peak\n"
    "  asperity convert-ndf moments:xx=0.02,yy=0.05 --as student_t:gamma=4 --to map\n"
    "\n"
    "Errors of a nearest distribution are relative; an asterisk marks the norm that\n"
    "was made least; `peak` is its density at the mean slope over the other's.",
    options, run
};
