/* test_fit_measured.c - fits of real measurements: a distribution is never fitted worse than one it
 * contains, and the fitted lobes lie where the measured ones do
 *
 * Reads the RGL files and a MERL slice in $ASPERITY_SHARED (default ../shared); skipped without. */
#define _XOPEN_SOURCE 700
#include "data_test.h"
#include "asperity_ndf.h"

#include <dirent.h>
#include <time.h>

static const char *shared(void)
{
    const char *folder = getenv("ASPERITY_SHARED");
    return folder && folder[0] ? folder : "../shared";
}

static const asp_fit_result *find(const asp_fit_result *r, size_t n, const char *name)
{
    for (size_t i = 0; i < n; i++)
        if (!strcmp(r[i].model->name, name))
            return &r[i];
    return NULL;
}

/* Instrumented code is slower, and has a smaller job: of one file the loss that is faster, both of the slice. */
#ifdef __SANITIZE_ADDRESS__
#define MOST_FILES 1
#define BOTH 0
#else
#define MOST_FILES 100
#define BOTH 1
#endif

static void one(const char *path, const char *name, const char *loss, size_t at)
{
    asp_error err;
    char line[600];
    asp_fit_result *r = NULL;
    size_t n = 0;
    asp_measured *m = asp_measured_read(path, &err);
    if (!CHECK(m != NULL, "%s", m ? "" : asp_error_text(&err, line, sizeof line)))
        return;
    clock_t start = clock();
    asp_fit_options options = { .loss = loss, .starts = 2 };
    if (CHECK(asp_fit(m, &options, &r, &n, &err) == ASP_OK, "%s: no fit", name)) {
        const asp_fit_result *student = find(r, n, "student_t"), *ggx = find(r, n, "ggx"),
                             *beckmann = find(r, n, "beckmann");
        printf("  %-28s %-4s", name, loss);
        for (size_t i = 0; i < n; i++) {
            printf(" %s %.5f", r[i].model->name, r[i].error[at]);
            CHECK(r[i].reason > 0, "%s, %s: %s", name, r[i].model->name,
                  asp_fit_reason_text(r[i].reason));
            for (size_t k = 0; k < r[i].parameter_count; k++) {
                const asp_fit_parameter *p = &r[i].parameter[k];
                CHECK(!isnan(p->value) && !isnan(p->uncertainty) && p->low <= p->value
                      && p->value <= p->high, "%s, %s: %s = %g in [%g, %g]", name,
                      r[i].model->name, p->name, p->value, p->low, p->high);
            }
        }
        printf("  %.1f s\n", (double)(clock() - start) / CLOCKS_PER_SEC);
        if (CHECK(student && ggx && beckmann, "models missing")) {
            CHECK(student->error[at] <= ggx->error[at], "%s: student_t %.9g, ggx %.9g", name,
                  student->error[at], ggx->error[at]);
            CHECK(student->error[at] <= beckmann->error[at], "%s: student_t %.9g, beckmann %.9g",
                  name, student->error[at], beckmann->error[at]);
        }
    }
    free(r);
    asp_measured_free(m);
}

int main(void)
{
    char path[700];
    struct dirent *entry;
    size_t files = 0;
    snprintf(path, sizeof path, "%s/data/rgl", shared());
    DIR *folder = opendir(path);
    if (!folder) {
        printf("skipped: no measurements in %s\n", path);
        return 77;
    }
    while ((entry = readdir(folder))) {
        const char *end = strrchr(entry->d_name, '.');
        if (!end || strcmp(end, ".bsdf"))
            continue;
        snprintf(path, sizeof path, "%s/data/rgl/%s", shared(), entry->d_name);
        if (files++ >= MOST_FILES)
            continue;
        if (BOTH)
            one(path, entry->d_name, "nad", 0);
        one(path, entry->d_name, "log", 1);
    }
    closedir(folder);
    snprintf(path, sizeof path, "%s/data/measured/merl_subset/aluminium_inplane_lumos.csv", shared());
    one(path, "aluminium_inplane_lumos.csv", "nad", 0);
    one(path, "aluminium_inplane_lumos.csv", "log", 1);
    CHECK(files >= 7, "only %zu RGL files", files);
    return finish();
}
