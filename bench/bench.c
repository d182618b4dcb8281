/* bench.c - how long each function takes: make bench, or bench [-r ROUNDS] [-o FILE.json]
 *
 * Every function, single and batch, float32 and float64, for every distribution of asp_models(), over
 * 65,536 random directions. The rounds are interleaved: each runs every case once, so that a slow
 * moment of the machine hits all cases alike; the median of the rounds is printed. The process is
 * pinned to one processor. A timing is never a test. */
#define _GNU_SOURCE
#include "asperity.h"
#include "asperity_ndf.h"
#include "peers.h"
#include "reference.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>
#ifdef __linux__
#include <linux/perf_event.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#endif

enum { COUNT = 65536, FUNCTIONS = 8, MAX_MODELS = 64, MAX_CASES = 4 * FUNCTIONS * MAX_MODELS + 8,
       MAX_ROUNDS = 99 };
static const char *const function_names[FUNCTIONS] = { "D", "sigma", "G1", "visible", "normal",
                                                       "eval", "pdf", "sample" };
typedef void run_function(const void *context);

#define REAL double
#define VEC3 asp_vec3
#define S(name) name
#define B(name) name##_n
#define F(name) name##_64
typedef asp_ndf asp_ndf_type_64;
typedef asp_material asp_material_type_64;
typedef asp_rgb asp_rgb_type_64;
typedef asp_bsdf_sample asp_sample_type_64;
typedef asp_cvec3s asp_in_type_64;
typedef asp_vec3s asp_out_type_64;
typedef asp_rgbs asp_rgbs_type_64;
#include "calls.h"

#define REAL float
#define VEC3 asp_vec3f
#define S(name) name##f
#define B(name) name##_nf
#define F(name) name##_32
typedef asp_ndff asp_ndf_type_32;
typedef asp_materialf asp_material_type_32;
typedef asp_rgbf asp_rgb_type_32;
typedef asp_bsdf_samplef asp_sample_type_32;
typedef asp_cvec3sf asp_in_type_32;
typedef asp_vec3sf asp_out_type_32;
typedef asp_rgbsf asp_rgbs_type_32;
#include "calls.h"

/* ------------------------------------------------------------------ cases */

typedef struct bench_case {
    const char *model, *function;
    int    bits, batch;
    run_function *run;
    const void *context;
    double ns[MAX_ROUNDS];
    double median, instructions;
} bench_case;

static bench_case cases[MAX_CASES];
static int case_count;

static void add_case(const char *model, const char *function, int bits, int batch,
                     run_function *run, const void *context)
{
    bench_case *c = &cases[case_count++];
    c->model = model;
    c->function = function;
    c->bits = bits;
    c->batch = batch;
    c->run = run;
    c->context = context;
    c->instructions = NAN;
}

static const bench_case *find_case(const char *model, const char *function, int bits, int batch)
{
    int i;
    for (i = 0; i < case_count; i++)
        if (cases[i].bits == bits && cases[i].batch == batch && !strcmp(cases[i].model, model) &&
            !strcmp(cases[i].function, function))
            return &cases[i];
    return NULL;
}

static double median_of(const char *model, const char *function, int bits, int batch)
{
    const bench_case *c = find_case(model, function, bits, batch);
    return c ? c->median : NAN;
}

typedef struct reference_setup {
    reference_conductor conductor;
    reference_arrays arrays;
    reference_batch *batch;
} reference_setup;

static void run_reference(const void *context)
{
    const reference_setup *s = context;
    s->batch(&s->conductor, COUNT, &s->arrays);
}

/* ------------------------------------------------------------------ clock and counter */

/* Time of this thread on its processor: what others do meanwhile does not count. */
static double now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return 1e9 * (double)t.tv_sec + (double)t.tv_nsec;
}

static int counter = -1;

static void open_counter(void)
{
#ifdef __linux__
    struct perf_event_attr a;
    memset(&a, 0, sizeof a);
    a.type = PERF_TYPE_HARDWARE;
    a.size = sizeof a;
    a.config = PERF_COUNT_HW_INSTRUCTIONS;
    a.disabled = 1;
    a.exclude_kernel = 1;
    a.exclude_hv = 1;
    counter = (int)syscall(SYS_perf_event_open, &a, 0, -1, -1, 0);
#endif
}

static double count_instructions(const bench_case *c)
{
#ifdef __linux__
    long long n;
    if (counter < 0)
        return NAN;
    ioctl(counter, PERF_EVENT_IOC_RESET, 0);
    ioctl(counter, PERF_EVENT_IOC_ENABLE, 0);
    c->run(c->context);
    ioctl(counter, PERF_EVENT_IOC_DISABLE, 0);
    if (read(counter, &n, sizeof n) == (ssize_t)sizeof n)
        return (double)n / COUNT;
#endif
    (void)c;
    return NAN;
}

static void pin_to_one_processor(void)
{
#ifdef __linux__
    cpu_set_t set;
    int cpu = sched_getcpu();
    CPU_ZERO(&set);
    CPU_SET((size_t)(cpu < 0 ? 0 : cpu), &set);
    sched_setaffinity(0, sizeof set, &set);
#endif
}

/* ------------------------------------------------------------------ data */

static uint64_t random_state = 1;

/* splitmix64, Steele et al. 2014 */
static double uniform(void)
{
    uint64_t z = (random_state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static void *allocate(size_t size)
{
    void *p = aligned_alloc(64, (size + 63) & ~(size_t)63);
    if (!p) {
        fputs("bench: out of memory\n", stderr);
        exit(1);
    }
    memset(p, 0, size);
    return p;
}

/* Directions uniform over the upper hemisphere. */
static void fill_directions(double *const d[3], float *const f[3])
{
    size_t i;
    int k;
    for (i = 0; i < COUNT; i++) {
        double z = 1.0 - uniform(), phi = 6.283185307179586 * uniform(), r = sqrt(1.0 - z * z);
        d[0][i] = r * cos(phi);
        d[1][i] = r * sin(phi);
        d[2][i] = z;
        for (k = 0; k < 3; k++)
            f[k][i] = (float)d[k][i];
    }
}

static void fill(setup_64 *d, setup_32 *f)
{
    size_t i;
    int k;
    for (k = 0; k < 3; k++) {
        d->wi[k] = allocate(COUNT * sizeof(double));
        d->wo[k] = allocate(COUNT * sizeof(double));
        d->m[k] = allocate(COUNT * sizeof(double));
        f->wi[k] = allocate(COUNT * sizeof(float));
        f->wo[k] = allocate(COUNT * sizeof(float));
        f->m[k] = allocate(COUNT * sizeof(float));
    }
    for (k = 0; k < 8; k++) {
        d->out[k] = allocate(COUNT * sizeof(double));
        f->out[k] = allocate(COUNT * sizeof(float));
    }
    d->u1 = allocate(COUNT * sizeof(double));
    d->u2 = allocate(COUNT * sizeof(double));
    f->u1 = allocate(COUNT * sizeof(float));
    f->u2 = allocate(COUNT * sizeof(float));
    fill_directions(d->wi, f->wi);
    fill_directions(d->wo, f->wo);
    fill_directions(d->m, f->m);
    for (i = 0; i < COUNT; i++) {
        f->u1[i] = (float)(0.99999 * (d->u1[i] = uniform()));
        f->u2[i] = (float)(0.99999 * (d->u2[i] = uniform()));
    }
}

/* ------------------------------------------------------------------ set-up */

static const asp_rgb gold_eta = { 0.18, 0.42, 1.37 }, gold_k = { 3.42, 2.35, 1.77 };
static const double alpha_x = 0.3, alpha_y = 0.1;

static void add_model(const asp_model *model, const char *name, const double *shape,
                      const setup_64 *d0, const setup_32 *f0)
{
    setup_64 *d = allocate(sizeof *d);
    setup_32 *f = allocate(sizeof *f);
    asp_map map;
    asp_error err;
    int k;
    *d = *d0;
    *f = *f0;
    if (asp_map_from_roughness(alpha_x, alpha_y, 0.0, 0.0, 0.0, &map, &err) != ASP_OK ||
        asp_ndf_make(model, &map, shape, &d->ndf, &err) != ASP_OK) {
        fprintf(stderr, "bench: %s: %s %s\n", model->name, err.name, err.reason);
        exit(1);
    }
    d->material = asp_conductor(&d->ndf, gold_eta, gold_k, 0);
    f->ndf = asp_ndf_narrow(&d->ndf);
    f->material = asp_material_narrow(&d->material);
    for (k = 0; k < FUNCTIONS; k++) {
        add_case(name, function_names[k], 32, 1, calls_32[k][1], f);
        add_case(name, function_names[k], 32, 0, calls_32[k][0], f);
        add_case(name, function_names[k], 64, 1, calls_64[k][1], d);
        add_case(name, function_names[k], 64, 0, calls_64[k][0], d);
    }
}

static void add_references(const setup_32 *f)
{
    reference_batch *const batches[3] = { reference_avx512(), reference_avx2(), reference_scalar };
    static const char *const names[3] = { "avx512", "avx2", "plain C" };
    int i;
    for (i = 0; i < 3; i++) {
        reference_setup *s = allocate(sizeof *s);
        reference_conductor c = {
            (float)alpha_x, (float)alpha_y,
            { (float)gold_eta.r, (float)gold_eta.g, (float)gold_eta.b },
            { (float)gold_k.r, (float)gold_k.g, (float)gold_k.b } };
        reference_arrays a = { f->wi[0], f->wi[1], f->wi[2], f->u1, f->u2, f->out[0], f->out[1],
                               f->out[2], f->out[3], f->out[4], f->out[5], f->out[6] };
        s->conductor = c;
        s->arrays = a;
        s->batch = batches[i];
        if (s->batch)
            add_case("by hand", names[i], 32, i < 2, run_reference, s);
    }
}

/* ------------------------------------------------------------------ measuring */

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void measure(int rounds)
{
    int r, i;
    for (r = -1; r < rounds; r++) {             /* round -1 warms up */
        for (i = 0; i < case_count; i++) {
            double begin = now_ns();
            cases[i].run(cases[i].context);
            if (r >= 0)
                cases[i].ns[r] = (now_ns() - begin) / COUNT;
        }
        if (isatty(2))
            fprintf(stderr, "\rround %d of %d ", r + 1, rounds);
    }
    if (isatty(2))
        fputs("\r                      \r", stderr);
    for (i = 0; i < case_count; i++) {
        qsort(cases[i].ns, (size_t)rounds, sizeof(double), by_value);
        cases[i].median = cases[i].ns[rounds / 2];
        cases[i].instructions = count_instructions(&cases[i]);
    }
}

/* ------------------------------------------------------------------ printing */

static const char *number(double x, char *buffer, size_t size)
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
    return c->median / median_of("ggx", c->function, c->bits, c->batch);
}

static void print_ratios(int bits, int batch)
{
    const char *model = NULL;
    char a[32];
    int i;
    printf("\nover GGX");
    for (i = 0; i < case_count; i++) {
        const bench_case *c = &cases[i];
        if (c->bits != bits || c->batch != batch || !strcmp(c->model, "by hand") || !strcmp(c->model, "ggx"))
            continue;
        if (c->model != model)
            printf("\n%-17s", model = c->model);
        printf(" %13s", number(over_ggx(c), a, sizeof a));
    }
    printf("\n");
}

static void print_table(int bits, int batch)
{
    char a[32], b[32], cell[80];
    const char *model = NULL;
    int i, k;
    printf("\nfloat%d, %s: ns per call / instructions per call\n%-17s", bits,
           batch ? "batch" : "single", "");
    for (k = 0; k < FUNCTIONS; k++)
        printf(" %13s", function_names[k]);
    for (i = 0; i < case_count; i++) {
        if (cases[i].bits != bits || cases[i].batch != batch || !strcmp(cases[i].model, "by hand"))
            continue;
        if (cases[i].model != model)
            printf("\n%-17s", model = cases[i].model);
        snprintf(cell, sizeof cell, "%s / %s", number(cases[i].median, a, sizeof a),
                 number(cases[i].instructions, b, sizeof b));
        printf(" %13s", cell);
    }
    print_ratios(bits, batch);
}

static double best_reference(void)
{
    double x = median_of("by hand", "avx512", 32, 1), y = median_of("by hand", "avx2", 32, 1);
    return y < x || x != x ? y : x;
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
        double ours = median_of(model, p->function, 32, p->batch);
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
         median_of("ggx", "sample", 32, 1) / reference, 4.0 / 3.7);
    goal("GGX conductor sample, single, over the hand-written kernel",
         median_of("ggx", "sample", 32, 0) / reference, 0.5 * 83.0 / 3.7);
    goal("student_t (3.7) conductor eval, batch, over GGX's",
         median_of("student_t 3.7", "eval", 32, 1) / median_of("ggx", "eval", 32, 1), 2.0);
    for (i = 0; i < case_count; i++)
        for (k = 0; k < 4; k++) {
            const char *function = k < 3 ? alone[k] : "eval";
            double ratio;
            if (cases[i].bits != 32 || !cases[i].batch || strcmp(cases[i].function, function))
                continue;
            ratio = cases[i].median / median_of("ggx", function, 32, 1);
            if (ratio > worst[k]) {
                worst[k] = ratio;
                who[k] = cases[i].model;
            }
        }
    for (k = 0; k < 4; k++) {
        snprintf(line, sizeof line, "slowest distribution's %s, batch, over GGX's: %s",
                 k < 3 ? alone[k] : "conductor eval", who[k]);
        goal(line, worst[k], k < 3 ? 4.0 : 2.0);
    }
}

static void write_number(FILE *f, double x, const char *after)
{
    if (x == x)
        fprintf(f, "%.4f%s", x, after);
    else
        fprintf(f, "null%s", after);
}

static int write_json(const char *path, int rounds, double reference)
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
    for (i = 0; i < case_count; i++) {
        fprintf(f, "%s\n  {\"model\": \"%s\", \"function\": \"%s\", \"bits\": %d, \"batch\": %s, "
                   "\"ns\": %.4f, \"of_reference\": %.4f, \"of_ggx\": ",
                i ? "," : "", cases[i].model, cases[i].function, cases[i].bits,
                cases[i].batch ? "true" : "false", cases[i].median, cases[i].median / reference);
        write_number(f, over_ggx(&cases[i]), ", \"instructions\": ");
        write_number(f, cases[i].instructions, "}");
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

int main(int argc, char **argv)
{
    static setup_64 d;
    static setup_32 f;
    const asp_model *const *models;
    const char *path = NULL;
    double gamma = 3.7, reference;
    int rounds = 15, option, i;
    char buffer[32];

    while ((option = getopt(argc, argv, "r:o:")) != -1) {
        if (option == 'r')
            rounds = atoi(optarg);
        else if (option == 'o')
            path = optarg;
        if (option == '?' || rounds < 1 || rounds > MAX_ROUNDS) {
            fprintf(stderr, "usage: bench [-r ROUNDS (1..%d)] [-o FILE.json]\n", MAX_ROUNDS);
            return 2;
        }
    }
    pin_to_one_processor();
    open_counter();
    fill(&d, &f);
    add_references(&f);
    for (models = asp_models(), i = 0; models[i] && i < MAX_MODELS - 1; i++)
        add_model(models[i], models[i]->name, NULL, &d, &f);
    if (asp_find_model(NULL, "student_t"))
        add_model(asp_find_model(NULL, "student_t"), "student_t 3.7", &gamma, &d, &f);
    measure(rounds);

    reference = best_reference();
    if (reference != reference)         /* no lanes on this machine: the plain kernel instead */
        reference = median_of("by hand", "plain C", 32, 0);
    printf("%d random directions, alpha %.1f x %.1f, default shapes, median of %d interleaved rounds\n",
           COUNT, alpha_x, alpha_y, rounds);
    printf("The hand-written GGX conductor kernel (sample, weight, pdf, RGB), ns per element:");
    for (i = 0; i < case_count; i++)
        if (!strcmp(cases[i].model, "by hand"))
            printf("  %s %s", cases[i].function, number(cases[i].median, buffer, sizeof buffer));
    printf("\n");
    print_table(32, 1);
    print_table(32, 0);
    print_table(64, 1);
    print_table(64, 0);
    print_peers(reference);
    print_goals(reference);
    return path ? write_json(path, rounds, reference) : 0;
}
