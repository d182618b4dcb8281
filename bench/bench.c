/* bench.c - how long each function takes: make bench, or bench [-r ROUNDS] [-o FILE.json]
 *
 * Every function, single and batch, float32 and float64, for every distribution of asp_models(), over
 * 65,536 random directions. The rounds are interleaved: each runs every case once, so that a slow
 * moment of the machine hits all cases alike; the median of the rounds is printed. The process is
 * pinned to one processor. A timing is never a test. */
#define _GNU_SOURCE
#include "asperity.h"
#include "asperity_ndf.h"
#include "bench.h"
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

enum { FUNCTIONS = 8, SCATTERING = 5, FIRST_OF_MATERIAL = 5, MAX_MODELS = 64, MAX_CASES = 4 * FUNCTIONS * MAX_MODELS + 8 };
const char *const bench_functions[] = { "D", "sigma", "G1", "visible", "normal", "eval", "pdf", "sample", NULL };
const char *const bench_scattering[] = { "eval", "pdf", "sample", "walk eval", "walk sample", NULL };

/* splitmix64 (Steele, Lea, Flood 2014), also as a stream for walks. */
static uint64_t random_state = 1;

static double uniform(void)
{
    uint64_t z = (random_state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

static double next(void *state)
{
    (void)state;
    return uniform();
}

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

#define WALKS
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

bench_case bench_cases[MAX_CASES];
int bench_case_count;

static void add_case(const char *model, const char *function, int bits, int batch,
                     run_function *run, const void *context)
{
    bench_case *c = &bench_cases[bench_case_count++];
    c->model = model;
    c->function = function;
    c->bits = bits;
    c->batch = batch;
    c->run = run;
    c->context = context;
    c->instructions = NAN;
}

const bench_case *bench_find(const char *model, const char *function, int bits, int batch)
{
    int i;
    for (i = 0; i < bench_case_count; i++)
        if (bench_cases[i].bits == bits && bench_cases[i].batch == batch && !strcmp(bench_cases[i].model, model) &&
            !strcmp(bench_cases[i].function, function))
            return &bench_cases[i];
    return NULL;
}

double bench_median(const char *model, const char *function, int bits, int batch)
{
    const bench_case *c = bench_find(model, function, bits, batch);
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

/* The same work by hand. It stands before GGX's samples over arrays, plain C first, so that whoever is compared
 * finds its arrays in the cache as another has just left them. */
static void add_references(const setup_32 *f)
{
    reference_batch *const batches[3] = { reference_scalar, reference_avx512(), reference_avx2() };
    static const char *const names[3] = { "plain C", "avx512", "avx2" };
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
            add_case("by hand", names[i], 32, i > 0, run_reference, s);
    }
}

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
        if (!strcmp(name, "ggx") && !strcmp(bench_functions[k], "sample"))
            add_references(f);
        add_case(name, bench_functions[k], 32, 1, calls_32[k][1], f);
        add_case(name, bench_functions[k], 32, 0, calls_32[k][0], f);
        add_case(name, bench_functions[k], 64, 1, calls_64[k][1], d);
        add_case(name, bench_functions[k], 64, 0, calls_64[k][0], d);
    }
}

/* A material in float32; `name` stays with the cases. walks: it has facets that light one another. */
static void add_material(const char *name, const char *spec, int walks, const setup_32 *f0)
{
    setup_32 *f = allocate(sizeof *f);
    asp_material mat;
    asp_error err;
    int k, first = bench_case_count;
    if (asp_material_parse(NULL, spec, &mat, &err) != ASP_OK) {
        fprintf(stderr, "bench: %s: %s %s\n", spec, err.name, err.reason);
        exit(1);
    }
    *f = *f0;
    f->ndf = asp_ndf_narrow(&mat.ndf);
    f->material = asp_material_narrow(&mat);
    for (k = 0; k < SCATTERING; k++)
        if (k < FUNCTIONS - FIRST_OF_MATERIAL) {
            add_case(name, bench_scattering[k], 32, 1, calls_32[FIRST_OF_MATERIAL + k][1], f);
            add_case(name, bench_scattering[k], 32, 0, calls_32[FIRST_OF_MATERIAL + k][0], f);
        } else if (walks) {
            add_case(name, bench_scattering[k], 32, 1, walk_calls_32[k - 3][1], f);
            add_case(name, bench_scattering[k], 32, 0, walk_calls_32[k - 3][0], f);
        }
    while (first < bench_case_count)
        bench_cases[first++].material = 1;
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
        for (i = 0; i < bench_case_count; i++) {
            double begin = now_ns();
            bench_cases[i].run(bench_cases[i].context);
            if (r >= 0)
                bench_cases[i].ns[r] = (now_ns() - begin) / COUNT;
        }
        if (isatty(2))
            fprintf(stderr, "\rround %d of %d ", r + 1, rounds);
    }
    if (isatty(2))
        fputs("\r                      \r", stderr);
    for (i = 0; i < bench_case_count; i++) {
        qsort(bench_cases[i].ns, (size_t)rounds, sizeof(double), by_value);
        bench_cases[i].median = bench_cases[i].ns[rounds / 2];
        bench_cases[i].instructions = count_instructions(&bench_cases[i]);
    }
}

#define GGX "ndf=(ggx:alpha_x=0.3,alpha_y=0.1)"
#define STUDENT "ndf=(student_t:alpha_x=0.3,alpha_y=0.1,gamma=3.7)"
static const struct { const char *name, *spec; int walks; } materials[] = {
    { "conductor ggx", "conductor:metal=Au," GGX, 1 },
    { "conductor student_t 3.7", "conductor:metal=Au," STUDENT, 1 },
    { "compensated ggx", "compensated:metal=Au," GGX, 0 },
    { "dielectric ggx", "dielectric:" GGX, 1 },
    { "dielectric student_t 3.7", "dielectric:" STUDENT, 1 },
    { "sheet ggx", "dielectric:thin=1," GGX, 0 },
    { "compensated_dielectric ggx", "compensated_dielectric:" GGX, 0 },
    { "lambert_specular ggx", "lambert_specular:" GGX, 0 },
    { "plastic ggx", "plastic:" GGX, 0 },
    { "rough_diffuse ggx, eon", "rough_diffuse:form=eon," GGX, 1 },
};

static double best_reference(void)
{
    double x = bench_median("by hand", "avx512", 32, 1), y = bench_median("by hand", "avx2", 32, 1);
    return y < x || x != x ? y : x;
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
    for (models = asp_models(), i = 0; models[i] && i < MAX_MODELS - 1; i++)
        add_model(models[i], models[i]->name, NULL, &d, &f);
    if (asp_find_model(NULL, "student_t"))
        add_model(asp_find_model(NULL, "student_t"), "student_t 3.7", &gamma, &d, &f);
    for (i = 0; i < (int)(sizeof materials / sizeof *materials); i++)
        add_material(materials[i].name, materials[i].spec, materials[i].walks, &f);
    measure(rounds);

    reference = best_reference();
    if (reference != reference)         /* no lanes on this machine: the plain kernel instead */
        reference = bench_median("by hand", "plain C", 32, 0);
    printf("%d random directions, alpha %.1f x %.1f, default shapes, median of %d interleaved rounds\n",
           COUNT, alpha_x, alpha_y, rounds);
    printf("The hand-written GGX conductor kernel (sample, weight, pdf, RGB), ns per element:");
    for (i = 0; i < bench_case_count; i++)
        if (!strcmp(bench_cases[i].model, "by hand"))
            printf("  %s %s", bench_cases[i].function, bench_number(bench_cases[i].median, buffer, sizeof buffer));
    printf("\n");
    bench_print(reference);
    return path ? bench_write(path, rounds, reference) : 0;
}
