/* print.c - what bench measured, as tables beside peers' figures and as JSON */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bench.h"
#include "peers.h"

const char *bench_number(double x, char *buffer, size_t size)
{
    if (x == x)
        snprintf(buffer, size, x < 10.0 ? "%.2f" : x < 100.0 ? "%.1f" : "%.0f", x);
    else
        snprintf(buffer, size, "n/a");
    return buffer;
}

/* Each function's time over GGX's in the same run. */
static double over_ggx(const bench_case *c)
{
    return c->median / bench_median("ggx", c->function, c->bits, c->batch);
}

/* One row of each model with such cases. Over GGX's: ratios instead. */
static void print_rows(int bits, int batch, int material, int over)
{
    const char *const *columns = material ? bench_scattering : bench_functions, *model = NULL;
    char a[32], b[32], cell[80];
    int i, k;
    for (i = 0; i < bench_case_count; i++) {
        const bench_case *c = &bench_cases[i];
        if (c->bits != bits || c->batch != batch || c->material != material || c->model == model
            || !strcmp(c->model, "by hand") || (over && !strcmp(c->model, "ggx")))
            continue;
        printf("%-25s", model = c->model);
        for (k = 0; columns[k]; k++) {
            const bench_case *found = bench_find(model, columns[k], bits, batch);
            if (!found)
                cell[0] = '\0';
            else if (over)
                bench_number(over_ggx(found), cell, sizeof cell);
            else
                snprintf(cell, sizeof cell, "%s / %s", bench_number(found->median, a, sizeof a),
                         bench_number(found->instructions, b, sizeof b));
            printf(" %13s", cell);
        }
        printf("\n");
    }
}

static void print_table(int bits, int batch, int material)
{
    const char *const *columns = material ? bench_scattering : bench_functions;
    printf("\nfloat%d, %s: ns per call / instructions per call\n%-25s", bits, batch ? "batch" : "single", "");
    for (; *columns; columns++)
        printf(" %13s", *columns);
    printf("\n");
    print_rows(bits, batch, material, 0);
    if (!material) {
        printf("over GGX\n");
        print_rows(bits, batch, material, 1);
    }
}

static void print_peers(double reference)
{
    size_t i;
    printf("\nBeside peers, float32. `of hand`: time over the hand-written GGX conductor kernel's, each"
           "\nin its own run (bench/peers.h)\n%-30s %8s %8s   %-18s %8s %8s   %s\n", "",
           "ns", "of hand", "fastest peer", "ns", "of hand", "ratio of ratios");
    for (i = 0; i < sizeof peer_rows / sizeof *peer_rows; i++) {
        const peer_row *p = &peer_rows[i];
        const char *model = !strcmp(p->model, "student_t") ? "student_t 3.7" : p->model;
        double ours = bench_median(model, p->function, 32, p->batch);
        char name[64];
        snprintf(name, sizeof name, "%s %s, %s", model, p->function, p->batch ? "batch" : "single");
        printf("%-30s %8.2f %8.2f   %-18s %8.2f %8.2f   %.2f\n", name, ours, ours / reference,
               p->peer, p->ns, p->ns / PEER_REFERENCE,
               (p->ns / PEER_REFERENCE) / (ours / reference));
    }
}

static void goal(const char *what, double value, double limit)
{
    printf("  %-66s %6.2f  goal %6.2f  %s\n", what, value, limit,
           value <= limit ? "reached" : "NOT reached");
}

static void print_goals(double reference)
{
    static const char *const alone[3] = { "D", "sigma", "visible" };
    double worst[4] = { 0.0, 0.0, 0.0, 0.0 };
    const char *who[4] = { "", "", "", "" };
    char line[96];
    int i, k;
    printf("\nGoals\n");
    goal("GGX conductor sample, batch, over the hand-written kernel",
         bench_median("ggx", "sample", 32, 1) / reference, 4.0 / 3.7);
    goal("GGX conductor sample, single, over the hand-written kernel",
         bench_median("ggx", "sample", 32, 0) / reference, 0.5 * 83.0 / 3.7);
    goal("student_t (3.7) conductor eval, batch, over GGX's",
         bench_median("student_t 3.7", "eval", 32, 1) / bench_median("ggx", "eval", 32, 1), 2.0);
    goal("dielectric GGX sample, single, over the hand-written kernel",
         bench_median("dielectric ggx", "sample", 32, 0) / reference, 0.5 * 106.0 / PEER_REFERENCE);
    goal("GGX walk eval, single, over GGX's D",
         bench_median("conductor ggx", "walk eval", 32, 0) / bench_median("ggx", "D", 32, 0), 572.0 / PEER_WALK_D / 3.0);
    goal("GGX walk eval, batch, over a single call of GGX's D",
         bench_median("conductor ggx", "walk eval", 32, 1) / bench_median("ggx", "D", 32, 0), 572.0 / PEER_WALK_D / 3.0);
    goal("student_t (3.7) walk eval, single, over its D",
         bench_median("conductor student_t 3.7", "walk eval", 32, 0) / bench_median("student_t 3.7", "D", 32, 0),
         572.0 / PEER_WALK_D / 3.0);
    for (i = 0; i < bench_case_count; i++)
        for (k = 0; k < 4; k++) {
            const char *function = k < 3 ? alone[k] : "eval";
            double ratio;
            if (bench_cases[i].bits != 32 || bench_cases[i].material || !bench_cases[i].batch || strcmp(bench_cases[i].function, function))
                continue;
            ratio = bench_cases[i].median / bench_median("ggx", function, 32, 1);
            if (ratio > worst[k]) {
                worst[k] = ratio;
                who[k] = bench_cases[i].model;
            }
        }
    for (k = 0; k < 4; k++) {
        snprintf(line, sizeof line, "slowest distribution's %s, batch, over GGX's: %s",
                 k < 3 ? alone[k] : "conductor eval", who[k]);
        goal(line, worst[k], k < 3 ? 4.0 : 2.0);
    }
}

void bench_print(double reference)
{
    print_table(32, 1, 0);
    print_table(32, 0, 0);
    print_table(64, 1, 0);
    print_table(64, 0, 0);
    print_table(32, 1, 1);
    print_table(32, 0, 1);
    print_peers(reference);
    print_goals(reference);
}

static void write_number(FILE *f, double x, const char *after)
{
    if (x == x)
        fprintf(f, "%.4f%s", x, after);
    else
        fprintf(f, "null%s", after);
}

int bench_write(const char *path, int rounds, double reference)
{
    char temporary[4096];
    FILE *f;
    int i;
    snprintf(temporary, sizeof temporary, "%s.part", path);
    f = fopen(temporary, "w");
    if (!f) {
        perror(temporary);
        return 1;
    }
    fprintf(f, "{\"count\": %d, \"rounds\": %d, \"reference_ns\": %.4f,\n \"cases\": [", COUNT, rounds,
            reference);
    for (i = 0; i < bench_case_count; i++) {
        fprintf(f, "%s\n  {\"model\": \"%s\", \"function\": \"%s\", \"bits\": %d, \"batch\": %s, "
                   "\"ns\": %.4f, \"of_reference\": %.4f, \"of_ggx\": ",
                i ? "," : "", bench_cases[i].model, bench_cases[i].function, bench_cases[i].bits,
                bench_cases[i].batch ? "true" : "false", bench_cases[i].median, bench_cases[i].median / reference);
        write_number(f, over_ggx(&bench_cases[i]), ", \"instructions\": ");
        write_number(f, bench_cases[i].instructions, "}");
    }
    fputs("\n]}\n", f);
    if (ferror(f) | fclose(f) || rename(temporary, path)) {
        perror(path);
        remove(temporary);
        return 1;
    }
    printf("\nAll numbers: %s\n", path);
    return 0;
}

