/* cmd_check.c - the laws that every distribution must obey, as a table */
#include "cmd.h"
#include "asperity_ndf.h"

#include <stdlib.h>
#include <string.h>

#define LAWS 32

/* What became of one law over the distributions of a group. */
typedef struct tally {
    asp_law_result worst;        /* furthest from, or nearest to, what is allowed */
    char   spec[320];            /* where */
    size_t seen, failed, checks;
} tally;

typedef struct group {
    const char *title, *spec;    /* spec: the one being checked */
    tally  laws[LAWS];
    size_t law_count, spec_count;
} group;

static double share(const asp_law_result *r)
{
    return r->allowed > 0 ? r->worst / r->allowed : r->worst > 0 ? 1e300 : 0;
}

static void note(void *context, const asp_law_result *result)
{
    group *g = context;
    size_t i = 0;
    while (i < g->law_count && asp_laws(i) != result->law)
        i++;
    if (i == g->law_count || !result->checks)
        return;
    tally *t = &g->laws[i];
    int worse = !t->seen || (t->worst.passed && !result->passed)
             || (t->worst.passed == result->passed && share(result) > share(&t->worst));
    t->seen++;
    t->failed += !result->passed;
    t->checks += result->checks;
    if (worse) {
        t->worst = *result;
        snprintf(t->spec, sizeof t->spec, "%s", g->spec);
    }
}

/* ------------------------------------------------------------------ what to check */

typedef struct progress { cmd_progress bar; size_t done, all; } progress;

static int show(void *context, double done)
{
    progress *p = context;
    return cmd_progress_show(&p->bar, ((double)p->done + done) / (double)p->all);
}

static int check_spec(const char *spec, asp_laws_options *how, progress *p, group *g)
{
    asp_ndf ndf;
    asp_error err;
    if (cmd_read_ndf(spec, &ndf, &err) != ASP_OK)
        return err.file[0] ? cmd_error(&err) : cmd_bad_ndf("", spec, &err);
    g->spec = spec;
    g->spec_count++;
    how->progress = show;
    how->context = p;
    asp_status status = asp_laws_check(&ndf, how, note, g, NULL, &err);
    p->done++;
    return status == ASP_OK ? CMD_OK : cmd_error(&err);
}

static size_t spec_count(const asp_model *model)
{
    char spec[320];
    size_t count = 0;
    while (asp_laws_spec(model, count, spec, sizeof spec))
        count++;
    return count;
}

static int check_model(const asp_model *model, asp_laws_options *how, progress *p, group *g)
{
    char spec[320];
    int status = CMD_OK;
    for (size_t i = 0; status == CMD_OK && asp_laws_spec(model, i, spec, sizeof spec); i++)
        status = check_spec(spec, how, p, g);
    return status;
}

/* ------------------------------------------------------------------ the findings */

static size_t failures(const group *g)
{
    size_t failed = 0;
    for (size_t i = 0; i < g->law_count; i++)
        failed += g->laws[i].failed;
    return failed;
}

static void print_group(const group *g)
{
    printf("%s", g->title);
    if (g->spec_count > 1)
        printf(" (%zu sets of parameters)", g->spec_count);
    printf("\n  %-16s %8s %10s %10s         unit\n", "law", "checks", "worst", "allowed");
    for (size_t i = 0; i < g->law_count; i++) {
        const tally *t = &g->laws[i];
        const asp_law *law = asp_laws(i);
        if (!t->seen)
            continue;
        printf("  %-16s %8zu %10.3g %10.3g  %-6s %s\n", law->name, t->checks, t->worst.worst,
               t->worst.allowed, t->failed ? "BROKEN" : "holds", law->unit);
        if (t->failed)
            printf("      %s\n      %s: %s\n", law->says, t->spec, t->worst.where);
    }
    fputs("\n", stdout);
}

static json_t *group_json(const group *g)
{
    json_t *laws = json_array();
    for (size_t i = 0; i < g->law_count; i++) {
        const tally *t = &g->laws[i];
        if (t->seen)
            json_array_append_new(laws, json_pack(
                "{s:s, s:b, s:I, s:I, s:o, s:f, s:s, s:s, s:s}", "law", asp_laws(i)->name,
                "holds", !t->failed, "broken_for", (json_int_t)t->failed, "checks",
                (json_int_t)t->checks, "worst", t->worst.worst < 1e300
                ? json_real(t->worst.worst) : json_string("inf"), "allowed", t->worst.allowed,
                "unit", asp_laws(i)->unit, "spec", t->spec, "where", t->worst.where));
    }
    return json_pack("{s:s, s:I, s:b, s:o}", "distribution", g->title, "sets",
                     (json_int_t)g->spec_count, "holds", failures(g) == 0, "laws", laws);
}

/* ------------------------------------------------------------------ the command */

static int read_options(const cmd_args *args, asp_laws_options *how, const asp_model **only)
{
    const char *names[64] = { NULL }, *model = cmd_text(args, "model");
    *how = asp_laws_options_default();
    how->samples = (size_t)cmd_integer(args, "samples");
    how->seed = (uint64_t)cmd_integer(args, "seed");
    how->only = cmd_text(args, "law");
    for (size_t i = 0; asp_laws(i) && i < 63; i++)
        names[i] = asp_laws(i)->name;
    if (how->only && cmd_find(how->only, names) < 0)
        return cmd_unknown("unknown law", how->only, names);
    memset(names, 0, sizeof names);
    for (size_t i = 0; asp_models()[i] && i < 63; i++)
        names[i] = asp_models()[i]->name;
    *only = model ? asp_find_model(NULL, model) : NULL;
    if (model && !*only)
        return cmd_unknown("unknown distribution", model, names);
    if (model && cmd_operand_count(args))
        return cmd_usage("--model does not go with a SPEC");
    return CMD_OK;
}

static int finish_group(const group *g, json_t *list, size_t *failed)
{
    *failed += failures(g);
    if (list)
        json_array_append_new(list, group_json(g));
    else
        print_group(g);
    fflush(stdout);
    return CMD_OK;
}

static int check_all(const cmd_args *args, asp_laws_options *how, const asp_model *only,
                     json_t *list, size_t *failed)
{
    size_t operands = cmd_operand_count(args), law_count = 0;
    progress p = { cmd_progress_begin("check"), 0, 0 };
    group *g = malloc(sizeof *g);
    int status = g ? CMD_OK : cmd_failed("out of memory");
    while (law_count < LAWS && asp_laws(law_count))
        law_count++;
    p.all = operands;
    for (const asp_model *const *m = asp_models(); !operands && *m; m++)
        p.all += !only || only == *m ? spec_count(*m) : 0;
    for (size_t i = 0; status == CMD_OK; i++) {
        const asp_model *model = operands ? NULL : asp_models()[i];
        if (operands ? i == operands : !model)
            break;
        if (model && only && model != only)
            continue;
        memset(g, 0, sizeof *g);
        g->law_count = law_count;
        g->title = operands ? cmd_operand(args, i) : model->name;
        status = operands ? check_spec(g->title, how, &p, g) : check_model(model, how, &p, g);
        cmd_progress_end(&p.bar);
        if (status == CMD_OK)
            status = finish_group(g, list, failed);
        p.bar.shown = cmd_progress_begin("").shown;
    }
    cmd_progress_end(&p.bar);
    free(g);
    return status;
}

static int run(const cmd_args *args)
{
    asp_laws_options how;
    const asp_model *only = NULL;
    size_t failed = 0;
    json_t *list = cmd_given(args, "json") ? json_array() : NULL;
    int status = read_options(args, &how, &only);
    if (status == CMD_OK)
        status = check_all(args, &how, only, list, &failed);
    if (status == CMD_OK && list)
        status = cmd_print_json(json_pack("{s:b, s:O}", "holds", failed == 0, "results", list));
    else if (status == CMD_OK)
        printf(failed ? "%zu broken\n" : "all laws hold\n", failed);
    json_decref(list);
    return status ? status : failed ? CMD_FAILED : CMD_OK;
}

static const cmd_option options[] = {
    { "model", 0, "NAME", CMD_TEXT, .help = "representative parameters of this distribution only" },
    { "law", 0, "NAME", CMD_TEXT, .help = "this law only; `asperity list laws` has their names" },
    { "samples", 0, "N", CMD_INTEGER, 1000, 1e8, .initial = "100000",
      .help = "per test of a sampler; the other laws scale with its root" },
    { "seed", 's', "N", CMD_INTEGER, 0, 9007199254740991.0, .initial = "1",
      .help = "the same seed, the same findings" },
    { "json", 0, NULL, CMD_FLAG, .help = "write JSON" },
    CMD_END
};

const cmd_record cmd_check = {
    "check", "check distributions against the laws they must obey", "[SPEC...]", 0, -1,
    "Without a SPEC: every distribution over representative parameters. For each\n"
    "law the worst deviation, and what is allowed there. Exit status 1 when one is\n"
    "broken.\n"
    "\n"
    "  asperity check student_t:alpha=0.3,gamma=1.6 ellipsoid:alpha=0.2,theta_x=0.7",
    options, run
};
