/* test_laws.c - the laws over every model of the library
 *
 * The ordinary run takes a sample of the representative specs; with ASPERITY_LONG set it takes all of
 * them with ten times the samples. Arguments (for work on a model): specs, and law=NAME. */
#include "asperity_data.h"
#include "asperity_ndf.h"

#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_JOBS 1000
#define MOST_LAWS 64

typedef struct job {
    char spec[256];
    const asp_model *const *models;
    size_t failed;
    char text[6000];
} job;

typedef struct summary {
    size_t values, checks;
    double ratio;
    char where[512];
} summary;

static job jobs[MOST_JOBS];
static size_t job_count, next_job;
static summary laws[MOST_LAWS];
static asp_laws_options options;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static size_t law_index(const asp_law *law)
{
    size_t i = 0;
    while (asp_laws(i) != law)
        i++;
    return i;
}

static void note(void *context, const asp_law_result *r)
{
    job *j = (job *)context;
    double ratio = r->checks == 0 || r->worst == 0 ? 0 : r->worst / r->allowed;
    summary *s = &laws[law_index(r->law)];
    pthread_mutex_lock(&lock);
    s->values += r->checks > 0;
    s->checks += r->checks;
    if (ratio > s->ratio || s->where[0] == '\0') {
        s->ratio = ratio;
        snprintf(s->where, sizeof s->where, "%s: %s", j->spec, r->where);
    }
    pthread_mutex_unlock(&lock);
    if (!r->passed) {
        size_t used = strlen(j->text);
        snprintf(j->text + used, sizeof j->text - used, "    BROKEN %-16s %.3g, allowed %.3g: %s\n",
                 r->law->name, r->worst, r->allowed, r->where);
    }
}

static void *work(void *unused)
{
    (void)unused;
    for (;;) {
        job *j;
        asp_ndf ndf;
        asp_error err;
        pthread_mutex_lock(&lock);
        j = next_job < job_count ? &jobs[next_job++] : NULL;
        pthread_mutex_unlock(&lock);
        if (!j)
            return NULL;
        if (asp_ndf_parse(j->models, j->spec, &ndf, &err) != ASP_OK) {
            char line[512];
            j->failed = 1;
            snprintf(j->text, sizeof j->text, "    %s\n", asp_error_text(&err, line, sizeof line));
        } else if (asp_laws_check(&ndf, &options, note, j, &j->failed, &err) != ASP_OK) {
            j->failed = 1;
            snprintf(j->text, sizeof j->text, "    asp_laws_check failed\n");
        }
    }
}

/* Every `stride`-th representative of a model, the first always. */
static void add_model(const asp_model *model, size_t stride)
{
    size_t i;
    for (i = 0; job_count < MOST_JOBS - 1; i++) {
        job *j = &jobs[job_count];
        if (!asp_laws_spec(model, i, j->spec, sizeof j->spec))
            break;
        if (i % stride == 0)
            job_count++;
    }
}

int main(int argc, char **argv)
{
    const char *longer = getenv("ASPERITY_LONG");
#ifdef __SANITIZE_ADDRESS__
    const size_t usual = 7;
#else
    const size_t usual = 3;
#endif
    size_t stride = longer ? 1 : usual, i, passed = 0, failed = 0;
    pthread_t thread;
    int threaded;
    options = asp_laws_options_default();
    options.samples = longer ? 1000000 : 20000;
    options.sparse = !longer;
    for (i = 1; i < (size_t)argc; i++) {
        if (strncmp(argv[i], "law=", 4) == 0)
            options.only = argv[i] + 4;
        else if (strncmp(argv[i], "samples=", 8) == 0)
            options.samples = (size_t)atof(argv[i] + 8);
        else if (strncmp(argv[i], "stride=", 7) == 0)
            stride = (size_t)atoi(argv[i] + 7);
        else if (job_count < MOST_JOBS)
            snprintf(jobs[job_count++].spec, sizeof jobs[0].spec, "%s", argv[i]);
    }
    if (job_count == 0) {
        const asp_model *const *m;
        for (m = asp_models(); *m; m++)
            add_model(*m, stride);
        /* nearly all visible facets are vertical walls */
        snprintf(jobs[job_count++].spec, sizeof jobs[0].spec, "student_t:alpha=0.3,gamma=1.501");
    }
    threaded = pthread_create(&thread, NULL, work, NULL) == 0;
    work(NULL);
    if (threaded)
        pthread_join(thread, NULL);
    for (i = 0; i < job_count; i++) {
        failed += jobs[i].failed != 0;
        passed += jobs[i].failed == 0;
        if (jobs[i].failed)
            printf("  %s: %zu laws broken\n%s", jobs[i].spec, jobs[i].failed, jobs[i].text);
    }
    printf("%-16s %7s %9s  %s\n", "law", "values", "checks", "worst/allowed, and where");
    for (i = 0; asp_laws(i); i++)
        if (laws[i].values)
            printf("%-16s %7zu %9zu  %.3g  %s\n", asp_laws(i)->name, laws[i].values,
                   laws[i].checks, laws[i].ratio, laws[i].where);
    printf("%zu passed, %zu failed\n", passed, failed);
    return failed != 0;
}
