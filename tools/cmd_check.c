/* cmd_check.c - the laws that every distribution and material must obey, as a table */
#define _XOPEN_SOURCE 700
#include "cmd.h"
#include "asperity_ndf.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define LAWS 64
#define THREADS 64

/* What became of one law over the distributions of a group. */
typedef struct tally {
    asp_law_result worst;        /* furthest from, or nearest to, what is allowed */
    char   spec[320];            /* where */
    size_t seen, failed, checks;
} tally;

typedef struct group {
    const char *title;
    tally  laws[LAWS];
    size_t law_count, spec_count;
    int    material;
} group;

/* One distribution or material: what to check, and once it is done what was found. */
typedef struct item {
    char   spec[320];
    const char *title;           /* of its group */
    asp_material *material;      /* NULL: the spec is a distribution's */
    asp_law_result found[LAWS];
    size_t count;
    int    done, refused;        /* refused: the spec; `error` says why */
    double part;                 /* of the work, for the progress bar */
    asp_status status;
    asp_error  error;
} item;

/* Shared by the threads, which take items in turn. */
typedef struct board {
    asp_laws_options how;
    item  *item;
    size_t count, next, shown;   /* shown: items whose group is printed */
    double part;                 /* the sum of the items' */
    int    stop;
    cmd_progress bar;
    pthread_mutex_t lock;
} board;

typedef struct turn { board *board; item *item; } turn;

static double share(const asp_law_result *r)
{
    return r->allowed > 0 ? r->worst / r->allowed : r->worst > 0 ? 1e300 : 0;
}

static void add(group *g, const item *from)
{
    g->spec_count++;
    for (size_t k = 0; k < from->count; k++) {
        const asp_law_result *result = &from->found[k];
        size_t i = 0;
        while (i < g->law_count && asp_laws(i) != result->law)
            i++;
        if (i == g->law_count || !result->checks)
            continue;
        tally *t = &g->laws[i];
        int worse = !t->seen || (t->worst.passed && !result->passed)
                 || (t->worst.passed == result->passed && share(result) > share(&t->worst));
        t->seen++;
        t->failed += !result->passed;
        t->checks += result->checks;
        if (worse) {
            t->worst = *result;
            snprintf(t->spec, sizeof t->spec, "%s", from->spec);
        }
    }
}

/* ------------------------------------------------------------------ what to check */

static item *new_item(board *b, const char *title)
{
    if (b->count % 64 == 0) {
        item *more = realloc(b->item, (b->count + 64) * sizeof *more);
        if (!more)
            return NULL;
        b->item = more;
    }
    item *out = &b->item[b->count++];
    memset(out, 0, sizeof *out);
    out->title = title;
    return out;
}

/* Materials are read at once: a mistake in one is said before there is any work. */
static int list_materials(const cmd_args *args, board *b)
{
    for (size_t i = 0; i < cmd_given(args, "material"); i++) {
        item *one = new_item(b, cmd_text_at(args, "material", i));
        if (!one || !(one->material = malloc(sizeof *one->material)))
            return cmd_failed("out of memory");
        snprintf(one->spec, sizeof one->spec, "%s", one->title);
        int status = cmd_material(args, "material", i, one->material);
        if (status != CMD_OK)
            return status;
    }
    return CMD_OK;
}

static int list_items(const cmd_args *args, const asp_model *only, board *b)
{
    size_t operands = cmd_operand_count(args);
    int status = list_materials(args, b), all = !operands && !cmd_given(args, "material");
    if (status != CMD_OK)
        return status;
    for (size_t i = 0; i < operands; i++) {
        item *one = new_item(b, cmd_operand(args, i));
        if (!one)
            return cmd_failed("out of memory");
        snprintf(one->spec, sizeof one->spec, "%s", one->title);
    }
    for (const asp_model *const *m = asp_models(); all && *m; m++)
        for (size_t i = 0; !only || only == *m; i++) {
            item *one = new_item(b, (*m)->name);
            if (!one)
                return cmd_failed("out of memory");
            if (!asp_laws_spec(*m, i, one->spec, sizeof one->spec)) {
                b->count--;
                break;
            }
        }
    return CMD_OK;
}

/* ------------------------------------------------------------------ checking */

static void note(void *context, const asp_law_result *result)
{
    item *one = context;
    if (one->count < LAWS)
        one->found[one->count++] = *result;
}

static int show(void *context, double done)
{
    turn *t = context;
    board *b = t->board;
    pthread_mutex_lock(&b->lock);
    b->part += done - t->item->part;
    t->item->part = done;
    cmd_progress_show(&b->bar, b->part / (double)b->count);
    int stop = b->stop;
    pthread_mutex_unlock(&b->lock);
    return stop;
}

static void check_item(board *b, item *one)
{
    turn t = { b, one };
    asp_laws_options how = b->how;
    asp_ndf ndf;
    how.progress = show;
    how.context = &t;
    if (one->material) {
        how.material = one->material;
        one->status = asp_laws_check(NULL, &how, note, one, NULL, &one->error);
        return;
    }
    pthread_mutex_lock(&b->lock);                /* files that specs name are kept in one list */
    one->status = strlen(one->title) < sizeof one->spec ? cmd_read_ndf(one->spec, &ndf, &one->error)
                : asp_fail(&one->error, ASP_EPARSE, "spec", "too long");
    pthread_mutex_unlock(&b->lock);
    one->refused = one->status != ASP_OK;
    if (!one->refused)
        one->status = asp_laws_check(&ndf, &how, note, one, NULL, &one->error);
}

static item *take(board *b)
{
    pthread_mutex_lock(&b->lock);
    item *one = b->next < b->count && !b->stop ? &b->item[b->next++] : NULL;
    pthread_mutex_unlock(&b->lock);
    return one;
}

static void leave(board *b, item *one)
{
    pthread_mutex_lock(&b->lock);
    one->done = 1;
    b->part += 1 - one->part;
    one->part = 1;
    b->stop |= one->status != ASP_OK;
    pthread_mutex_unlock(&b->lock);
}

static void *work(void *context)
{
    board *b = context;
    for (item *one = take(b); one; one = take(b)) {
        check_item(b, one);
        leave(b, one);
    }
    return NULL;
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
    return json_pack("{s:s, s:I, s:b, s:o}", g->material ? "material" : "distribution", g->title, "sets",
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
    how->sparse = cmd_operand_count(args) == 0 && !cmd_given(args, "material");
    for (size_t i = 0; asp_laws(i) && i < 63; i++)
        names[i] = asp_laws(i)->name;
    if (how->only && cmd_find(how->only, names) < 0)
        return cmd_unknown("unknown law", how->only, names);
    for (size_t i = 0; how->only && cmd_given(args, "material") && asp_laws(i); i++)
        if (strcmp(asp_laws(i)->name, how->only) == 0 && !asp_law_of_materials(asp_laws(i)))
            return cmd_usage("--law %s: speaks of distributions, not of a --material", how->only);
    memset(names, 0, sizeof names);
    for (size_t i = 0; asp_models()[i] && i < 63; i++)
        names[i] = asp_models()[i]->name;
    *only = model ? asp_find_model(NULL, model) : NULL;
    if (model && !*only)
        return cmd_unknown("unknown distribution", model, names);
    if (model && (cmd_operand_count(args) || cmd_given(args, "material")))
        return cmd_usage("--model does not go with a SPEC or --material");
    return CMD_OK;
}

/* Prints the groups that are complete, in their order; at the end all are. */
static int print_done(board *b, group *g, json_t *list, size_t *failed)
{
    while (b->shown < b->count) {
        size_t first = b->shown, end = first;
        int done = 1;
        pthread_mutex_lock(&b->lock);
        while (end < b->count && b->item[end].title == b->item[first].title)
            done &= b->item[end++].done;
        pthread_mutex_unlock(&b->lock);
        if (!done)
            return CMD_OK;
        memset(g, 0, sizeof *g);
        while (g->law_count < LAWS && asp_laws(g->law_count))
            g->law_count++;
        g->title = b->item[first].title;
        g->material = b->item[first].material != NULL;
        for (size_t i = first; i < end; i++)
            add(g, &b->item[i]);
        *failed += failures(g);
        if (list)
            json_array_append_new(list, group_json(g));
        else {
            pthread_mutex_lock(&b->lock);
            cmd_progress_end(&b->bar);
            print_group(g);
            pthread_mutex_unlock(&b->lock);
        }
        fflush(stdout);
        b->shown = end;
    }
    return CMD_OK;
}

/* The first item that could not be checked. */
static int say_error(const board *b)
{
    for (size_t i = 0; i < b->count; i++)
        if (b->item[i].status != ASP_OK && b->item[i].status != ASP_ECANCELLED)
            return b->item[i].refused && !b->item[i].error.file[0] ? cmd_bad_ndf("", b->item[i].spec, &b->item[i].error)
                                      : cmd_error(&b->item[i].error);
    return CMD_OK;
}

static int check_all(board *b, int threads, json_t *list, size_t *failed)
{
    pthread_t other[THREADS];
    int others = 0, status = CMD_OK;
    group *g = malloc(sizeof *g);
    if (!g)
        return cmd_failed("out of memory");
    /* fewer threads than wished for is slower, not wrong */
    while (others < threads - 1 && pthread_create(&other[others], NULL, work, b) == 0)
        others++;
    for (item *one = take(b); one; one = take(b)) {
        check_item(b, one);
        leave(b, one);
        if (!b->stop)
            status = print_done(b, g, list, failed);
    }
    for (int i = 0; i < others; i++)
        pthread_join(other[i], NULL);
    cmd_progress_end(&b->bar);
    if (status == CMD_OK)
        status = say_error(b);
    if (status == CMD_OK)
        status = print_done(b, g, list, failed);
    free(g);
    return status;
}

static int thread_count(const cmd_args *args)
{
    int wished = (int)cmd_integer(args, "threads");
    long n = wished ? wished : sysconf(_SC_NPROCESSORS_ONLN);
    return n < 1 ? 1 : n > THREADS ? THREADS : (int)n;
}

static int run(const cmd_args *args)
{
    board b = { .bar = cmd_progress_begin("check"), .lock = PTHREAD_MUTEX_INITIALIZER };
    const asp_model *only = NULL;
    size_t failed = 0;
    json_t *list = cmd_given(args, "json") ? json_array() : NULL;
    int status = read_options(args, &b.how, &only);
    if (status == CMD_OK)
        status = list_items(args, only, &b);
    if (status == CMD_OK)
        status = check_all(&b, thread_count(args), list, &failed);
    for (size_t i = 0; i < b.count; i++)
        free(b.item[i].material);
    free(b.item);
    if (status == CMD_OK && list)
        status = cmd_print_json(json_pack("{s:b, s:O}", "holds", failed == 0, "results", list));
    else if (status == CMD_OK)
        printf(failed ? "%zu broken\n" : "all laws hold\n", failed);
    json_decref(list);
    return status ? status : failed ? CMD_FAILED : CMD_OK;
}

static const cmd_option options[] = {
    { "material", 0, "SPEC", CMD_TEXT, .many = 1,
      .help = "this material as it is, over its own distribution; more than once: each" },
    { "model", 0, "NAME", CMD_TEXT, .help = "representative parameters of this distribution only" },
    { "law", 0, "NAME", CMD_TEXT, .help = "this law only; `asperity list laws` has their names" },
    { "samples", 0, "N", CMD_INTEGER, 1000, 1e8, .initial = "100000",
      .help = "per test of a sampler; the other laws scale with its root" },
    { "seed", 's', "N", CMD_INTEGER, 0, 9007199254740991.0, .initial = "1",
      .help = "the same seed, the same findings" },
    { "threads", 0, "N", CMD_INTEGER, 0, THREADS, .initial = "0",
      .help = "0: as many as processors; the findings do not depend on it" },
    { "json", 0, NULL, CMD_FLAG, .help = "write JSON" },
    CMD_END
};

const cmd_record cmd_check = {
    "check", "check distributions and materials against the laws they must obey", "[SPEC...]", 0, -1,
    "For each law the worst deviation, and what is allowed there. Exit status 1\n"
    "when one is broken. Without a SPEC: every distribution over representative\n"
    "parameters; the samplers' laws then try a third of their views and materials\n"
    "with each.\n"
    "\n"
    "A SPEC is a distribution, with mirrors, glass, coats... made over it. --material\n"
    "tries one material by the laws that speak of materials: weights and densities\n"
    "of its samples, reciprocity (which form=turquin has not), both ways across a\n"
    "boundary, its walk, float32, and the furnace: what a lambert_specular of albedos\n"
    "above 1 breaks, and models whose tables are off by more than is stated.\n"
    "\n"
    "  asperity check student_t:alpha=0.3,gamma=1.6 ellipsoid:alpha=0.2,theta_x=0.7\n"
    "  asperity check --material 'plastic:albedo=0.8,ndf=(beckmann:alpha=0.3)'",
    options, run
};
