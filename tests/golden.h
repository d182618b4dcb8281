/* golden.h - reading the golden files, for test_golden.c and test_golden_energy.c */
#ifndef GOLDEN_H
#define GOLDEN_H

#include "asperity.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GOLDEN_COLUMNS 40

typedef struct golden {
    FILE *file;
    long line;
    int columns;
    char head[1024], text[4096];
    const char *names[GOLDEN_COLUMNS];
    double values[GOLDEN_COLUMNS];
} golden;

/* One compared column: how many, how many failed, and where it was worst against its tolerance. */
typedef struct golden_column {
    const char *name;
    size_t count, failed;
    double ratio, worst, tolerance, found, exact, flat;
    long line;
} golden_column;

static size_t golden_passed, golden_failed;

static const char *golden_folder(void)
{
    static char folder[1024];
    const char *shared = getenv("ASPERITY_SHARED");
    FILE *f;
    snprintf(folder, sizeof folder, "%.900s/golden", shared ? shared : "../shared");
    {
        char probe[1100];
        snprintf(probe, sizeof probe, "%s/README.md", folder);
        f = fopen(probe, "r");
    }
    if (!f)
        return NULL;
    fclose(f);
    return folder;
}

static int golden_skip(void)
{
    printf("skipped: no golden files (ASPERITY_SHARED)\n0 passed, 0 failed\n");
    return 77;
}

static int golden_open(golden *g, const char *name)
{
    char path[1200], *word;
    memset(g, 0, sizeof *g);
    snprintf(path, sizeof path, "%s/%s", golden_folder(), name);
    g->file = fopen(path, "r");
    if (!g->file || !fgets(g->head, sizeof g->head, g->file))
        return 0;
    for (word = strtok(g->head, ",\r\n"); word && g->columns < GOLDEN_COLUMNS;
         word = strtok(NULL, ",\r\n"))
        g->names[g->columns++] = word;
    g->line = 1;
    return 1;
}

static int golden_next(golden *g)
{
    char *p = g->text;
    int i;
    if (!fgets(g->text, sizeof g->text, g->file))
        return 0;
    g->line++;
    for (i = 0; i < g->columns; i++) {
        char *end;
        g->values[i] = strtod(p, &end); /* 1.2e-8671 is 0, which is what the library must say */
        if (end == p || (*end != ',' && i + 1 < g->columns)) {
            printf("line %ld, column %d: not a number\n", g->line, i + 1);
            golden_failed++;
            return 0;
        }
        p = end + 1;
    }
    return 1;
}

static void golden_close(golden *g) { fclose(g->file); }

static double golden_value(const golden *g, const char *name)
{
    int i;
    for (i = 0; i < g->columns; i++)
        if (strcmp(g->names[i], name) == 0)
            return g->values[i];
    printf("no column %s\n", name);
    golden_failed++;
    return NAN;
}

static asp_vec3 golden_direction(double theta, double phi)
{
    asp_vec3 v;
    v.x = sin(theta) * cos(phi);
    v.y = sin(theta) * sin(phi);
    v.z = cos(theta);
    return v;
}

static void golden_note(golden_column *c, const golden *g, double error, double tolerance,
                        double found, double exact)
{
    double ratio = tolerance > 0 ? error / tolerance : error > 0 ? INFINITY : 0;
    if (!(error == error) || !(tolerance == tolerance))
        ratio = error = INFINITY;
    c->count++;
    c->failed += !(ratio <= 1);
    c->flat = fmax(c->flat, error);
    if (c->count == 1 || ratio > c->ratio) {
        c->ratio = ratio;
        c->worst = error;
        c->tolerance = tolerance;
        c->found = found;
        c->exact = exact;
        c->line = g->line;
    }
}

static void golden_print(const golden_column *c)
{
    if (c->count == 0)
        return;
    printf("  %-20s %5zu  worst %.2e (allowed %.2e) at line %ld: %.17g, golden %.17g%s\n", c->name,
           c->count, c->worst, c->tolerance, c->line, c->found, c->exact,
           c->failed ? "  FAILED" : "");
    if (c->flat > c->worst)
        printf("  %-20s        largest without allowance %.2e\n", "", c->flat);
    if (c->failed)
        printf("  %-20s        %zu rows failed\n", "", c->failed);
    golden_passed += c->count - c->failed;
    golden_failed += c->failed;
}

static void golden_expect(int ok, const char *what)
{
    if (!ok)
        printf("  FAILED: %s\n", what);
    golden_passed += ok != 0;
    golden_failed += ok == 0;
}

static int golden_result(void)
{
    printf("%zu passed, %zu failed\n", golden_passed, golden_failed);
    return golden_failed != 0;
}

#endif
