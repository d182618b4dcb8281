/* notebook.c - the fits by hand of "Background: Physics and Math of Shading" (Hoffman, SIGGRAPH 2013
 * courses, the Mathematica notebook), beside the computed ones
 *
 * Its parameters were moved until two plots of D over theta had the same peak. `peak` solves for that;
 * `theta` is the least distance of the two curves. */
#include "cmd.h"
#include "asperity_ndf.h"
#include "notebook.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct fit {
    const char *target, *model;
    double held;             /* the model's gamma; NAN: it has none */
    double printed;          /* the notebook's alpha; NAN: not given there */
} fit;

static const struct group {
    const char *claim;
    fit fits[9];
} groups[] = {
    { "ABC with gamma 1.75 fits Trowbridge-Reitz (In[51])",
      { { "ggx:alpha=0.3", "abc", 1.75, 23.5 }, { "ggx:alpha=0.4", "abc", 1.75, 11.6 },
        { "ggx:alpha=0.5", "abc", 1.75, 6.3 }, { "ggx:alpha=0.6", "abc", 1.75, 3.55 },
        { "ggx:alpha=0.7", "abc", 1.75, 2.0 } } },
    { "ABC with gamma 1000 approaches Phong (In[51]); exponents are 2/alpha^2 - 2, alpha 0.3 to 0.7",
      { { "phong:exponent=20.222222222222222", "abc", 1000, 0.0212 }, { "phong:exponent=10.5", "abc", 1000, 0.0114 },
        { "phong:exponent=6", "abc", 1000, 0.0068 }, { "phong:exponent=3.5555555555555556", "abc", 1000, 0.0043 },
        { "phong:exponent=2.0816326530612246", "abc", 1000, 0.0026 } } },
    { "ABC with gamma 0.5 is spikier than Trowbridge-Reitz of the same peak (In[54])",
      { { "ggx:alpha=0.2", "abc", 0.5, 4250 }, { "ggx:alpha=0.3", "abc", 0.5, 785 }, { "ggx:alpha=0.4", "abc", 0.5, 240 },
        { "ggx:alpha=0.5", "abc", 0.5, 82.5 }, { "ggx:alpha=0.6", "abc", 0.5, 33.5 }, { "ggx:alpha=0.7", "abc", 0.5, 14 },
        { "ggx:alpha=0.8", "abc", 0.5, 5.75 } } },
    { "GTR with gamma 10000 approaches Phong (In[76])",
      { { "phong:exponent=100", "gtr", 10000, 0.99745 }, { "phong:exponent=50", "gtr", 10000, 0.9987 },
        { "phong:exponent=25", "gtr", 10000, 0.999325 }, { "phong:exponent=8", "gtr", 10000, 0.999752 },
        { "phong:exponent=4", "gtr", 10000, 0.999859 }, { "phong:exponent=2", "gtr", 10000, 0.99992 },
        { "phong:exponent=1", "gtr", 10000, 0.999956 } } },
    { "Torrance-Sparrow is close to Phong (In[29], In[30]); exponents are 2/alpha^2 - 2, alpha 0.2 to 0.9",
      { { "phong:exponent=48", "torrance_sparrow", NAN, 0.2027 },
        { "phong:exponent=20.222222222222222", "torrance_sparrow", NAN, 0.3097 },
        { "phong:exponent=10.5", "torrance_sparrow", NAN, 0.425 }, { "phong:exponent=6", "torrance_sparrow", NAN, 0.552 },
        { "phong:exponent=3.5555555555555556", "torrance_sparrow", NAN, 0.7035 },
        { "phong:exponent=2.0816326530612246", "torrance_sparrow", NAN, 0.899 },
        { "phong:exponent=1.125", "torrance_sparrow", NAN, 1.195 },
        { "phong:exponent=0.46913580246913580", "torrance_sparrow", NAN, 1.81 } } },
    { "GTR with gamma 0.54 fits ABC with gamma 0.5 (the numbers are cut off in the document)",
      { { "abc:alpha=4250,gamma=0.5", "gtr", 0.54, NAN }, { "abc:alpha=785,gamma=0.5", "gtr", 0.54, NAN },
        { "abc:alpha=240,gamma=0.5", "gtr", 0.54, NAN }, { "abc:alpha=82.5,gamma=0.5", "gtr", 0.54, NAN },
        { "abc:alpha=33.5,gamma=0.5", "gtr", 0.54, NAN }, { "abc:alpha=14,gamma=0.5", "gtr", 0.54, NAN },
        { "abc:alpha=5.75,gamma=0.5", "gtr", 0.54, NAN } } },
};

/* The model's alpha, where shape number 0 is alpha and 1 is gamma; *error its distance theta. alpha 0:
 * free. */
static asp_status solve(const fit *f, const asp_ndf *target, const char *norm, double *alpha,
                        double *error, double *peak, asp_error *err)
{
    const asp_model *model = asp_find_model(NULL, f->model);
    asp_nearest_options o = { .norm = norm };
    asp_nearest_result *r = malloc(sizeof *r);
    if (!r)
        return asp_fail(err, ASP_ENOMEM, "", "out of memory");
    if (!isnan(f->held)) {
        o.fixed = 2;
        o.shape[1] = f->held;
    }
    if (*alpha > 0) {
        o.fixed |= 1;
        o.shape[0] = *alpha;
    }
    asp_status status = asp_nearest(target, model, &o, r, err);
    if (!status) {
        *alpha = r->ndf.shape[0];
        *error = r->errors[0];
        *peak = r->peak;
    }
    free(r);
    return status;
}

static asp_status row(const fit *f, json_t *list, asp_error *err)
{
    double printed = f->printed, peak_alpha = 0, best_alpha = 0, e[3] = { NAN, 0, 0 }, peak[3] = { NAN, 0, 0 };
    char text[64];
    asp_ndf target;
    asp_status status = asp_ndf_parse(NULL, f->target, &target, err);
    if (!status && !isnan(printed))
        status = solve(f, &target, "theta", &printed, &e[0], &peak[0], err);
    if (!status)
        status = solve(f, &target, "peak", &peak_alpha, &e[1], &peak[1], err);
    if (!status)
        status = solve(f, &target, "theta", &best_alpha, &e[2], &peak[2], err);
    if (status)
        return status;
    if (list) {
        json_array_append_new(list, json_pack("{s:s, s:s, s:o, s:o, s:o, s:f, s:f, s:f, s:f}", "target",
            f->target, "model", f->model, "printed", isnan(printed) ? json_null() : json_real(printed),
            "printed_error", isnan(printed) ? json_null() : json_real(e[0]),
            "printed_peak", isnan(printed) ? json_null() : json_real(peak[0]),
            "peak", peak_alpha, "peak_error", e[1], "nearest", best_alpha, "nearest_error", e[2]));
        return ASP_OK;
    }
    snprintf(text, sizeof text, "%.28s", f->target);
    printf("  %-28s", text);
    if (isnan(printed))
        printf(" %9s %6s %7s", "-", "-", "-");
    else
        printf(" %9.6g %6.2f %7.4f", printed, 100 * e[0], peak[0]);
    printf("   %11.7g %6.2f   %11.6g %6.2f\n", peak_alpha, 100 * e[1], best_alpha, 100 * e[2]);
    return ASP_OK;
}

/* Are the distributions of a group in the library? */
static int known(const struct group *g)
{
    char name[64];
    snprintf(name, sizeof name, "%.*s", (int)strcspn(g->fits[0].target, ":"), g->fits[0].target);
    return asp_find_model(NULL, name) && asp_find_model(NULL, g->fits[0].model);
}

int notebook_table(int json)
{
    json_t *all = json ? json_array() : NULL;
    asp_error err;
    asp_status status = ASP_OK;
    for (size_t i = 0; !status && i < sizeof groups / sizeof *groups; i++) {
        if (!known(&groups[i]))
            continue;
        json_t *list = json ? json_array() : NULL;
        if (!json)
            printf("%s%s\n  %-28s %9s %6s %7s   %11s %6s   %11s %6s\n", i ? "\n" : "", groups[i].claim, "target",
                   "printed", "off %", "peak", "same peak", "off %", "nearest", "off %");
        for (int k = 0; !status && k < 9 && groups[i].fits[k].target; k++)
            status = row(&groups[i].fits[k], list, &err);
        if (json)
            json_array_append_new(all, json_pack("{s:s, s:o}", "claim", groups[i].claim, "fits", list));
    }
    if (status) {
        json_decref(all);
        return cmd_error(&err);
    }
    return json ? cmd_print_json(all) : CMD_OK;
}
