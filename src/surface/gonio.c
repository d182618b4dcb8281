/* gonio.c - the virtual gonioreflectometer: rays in, power per cell out */
#define _POSIX_C_SOURCE 200809L
#include "core/rng.h"
#include "surface/surface.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

static int bin(double at, int n)
{
    return at < 0 ? 0 : at >= n ? n - 1 : (int)at;
}

/* phi_d and pi - phi_d are the same by mirror symmetry with reciprocity, phi_d and -phi_d by mirror
 * symmetry: all fold to [0, pi/2]. */
static size_t cell_of(asp_vec3 wi, asp_vec3 wo)
{
    const double half_pi = ASPI_PI / 2;
    aspi_half a = aspi_half_of(wi, wo);
    double phi = fabs(a.phi_d);
    if (phi > half_pi)
        phi = ASPI_PI - phi;
    int i = bin(ASPI_CELLS_H * sqrt(a.theta_h / half_pi), ASPI_CELLS_H);
    int j = bin(ASPI_CELLS_D * (a.theta_d / half_pi), ASPI_CELLS_D);
    int k = bin(ASPI_CELLS_PHI * (phi / half_pi), ASPI_CELLS_PHI);
    return ((size_t)j * ASPI_CELLS_PHI + (size_t)k) * ASPI_CELLS_H + (size_t)i;
}

/* ---- counting */

static void count_path(aspi_cell *cell, const aspi_path *path)
{
    ++cell->count;
    cell->r += (uint64_t)(path->weight.r * ASPI_WEIGHT_ONE + 0.5);
    cell->g += (uint64_t)(path->weight.g * ASPI_WEIGHT_ONE + 0.5);
    cell->b += (uint64_t)(path->weight.b * ASPI_WEIGHT_ONE + 0.5);
}

void aspi_gonio_add(aspi_counts *counts, asp_vec3 wi, const aspi_path *path)
{
    counts->bounces += (uint64_t)path->bounces;
    count_path(&counts->cells[cell_of(wi, path->wo)], path);
    count_path(&counts->all, path);
    if (path->bounces > 1)
        count_path(&counts->multiple, path);
}

static void add_cell(aspi_cell *a, const aspi_cell *b)
{
    a->count += b->count;
    a->r += b->r;
    a->g += b->g;
    a->b += b->b;
}

enum { CHUNK = 8192 };    /* rays of one random stream: what a thread takes at a time */

typedef struct job {
    const aspi_tracer *tracer;
    const asp_metal *metal;
    uint64_t seed;
    size_t   rays;
    atomic_size_t next;    /* chunk */
    atomic_int stop;
} job;

typedef struct worker {
    job *job;
    aspi_counts *counts;
    pthread_t thread;
} worker;

/* wi uniform in projected solid angle: cosine-weighted, its azimuth random (the cells know only the
 * difference of the azimuths, so that this averages over the orientation of the surface). */
static void trace_chunk(const job *work, size_t chunk, aspi_counts *counts)
{
    size_t first = chunk * CHUNK, left = work->rays - first, n = left < CHUNK ? left : CHUNK;
    uint64_t start = aspi_random_start(work->seed, 3 + chunk);
    for (size_t i = 0; i < n; ++i) {
        double u = aspi_unit64(aspi_random_at(start, 4 * i));
        double v = aspi_unit64(aspi_random_at(start, 4 * i + 1));
        double square = aspi_unit64(aspi_random_at(start, 4 * i + 2));
        double phi = 2 * ASPI_PI * aspi_unit64(aspi_random_at(start, 4 * i + 3));
        double radius = sqrt(square);
        asp_vec3 wi = { radius * cos(phi), radius * sin(phi), sqrt(1 - square) };
        aspi_path path;
        ++counts->rays;
        if (aspi_trace(work->tracer, u, v, wi, work->metal, &path))
            aspi_gonio_add(counts, wi, &path);
        else
            ++counts->lost;
    }
}

/* Takes chunks until there are none left. Only the calling thread has a progress function. */
static asp_status take_chunks(job *work, aspi_counts *counts, asp_progress *progress,
                              void *context)
{
    size_t chunks = (work->rays + CHUNK - 1) / CHUNK;
    while (!atomic_load(&work->stop)) {
        size_t chunk = atomic_fetch_add(&work->next, 1);
        if (chunk >= chunks)
            break;
        trace_chunk(work, chunk, counts);
        if (progress && progress(context, (double)(chunk + 1) / (double)chunks)) {
            atomic_store(&work->stop, 1);
            return ASP_ECANCELLED;
        }
    }
    return ASP_OK;
}

static void *run(void *argument)
{
    worker *w = argument;
    take_chunks(w->job, w->counts, NULL, NULL);
    return NULL;
}

static void merge(aspi_counts *into, const aspi_counts *from)
{
    for (size_t i = 0; i < ASPI_CELLS; ++i)
        add_cell(&into->cells[i], &from->cells[i]);
    into->rays += from->rays;
    into->lost += from->lost;
    into->bounces += from->bounces;
    add_cell(&into->all, &from->all);
    add_cell(&into->multiple, &from->multiple);
}

asp_status aspi_gonio_count(const aspi_tracer *tracer, const asp_metal *metal, uint64_t seed,
                            size_t rays, int threads, asp_progress *progress, void *context,
                            aspi_counts *counts, asp_error *err)
{
    job work = { .tracer = tracer, .metal = metal, .seed = seed, .rays = rays };
    worker *workers = calloc((size_t)threads, sizeof *workers);
    if (!workers)
        return asp_fail(err, ASP_ENOMEM, "gonioreflectometer", "out of memory");
    memset(counts, 0, sizeof *counts);
    /* a helper that cannot be started only makes it slower: the chunks do not care who takes them */
    int started = 0;
    for (; started < threads - 1; ++started) {
        worker *w = &workers[started];
        *w = (worker){ .job = &work, .counts = calloc(1, sizeof *w->counts) };
        if (!w->counts)
            break;
        if (pthread_create(&w->thread, NULL, run, w) != 0) {
            free(w->counts);
            break;
        }
    }
    asp_status status = take_chunks(&work, counts, progress, context);
    for (int i = 0; i < started; ++i) {
        pthread_join(workers[i].thread, NULL);
        merge(counts, workers[i].counts);
        free(workers[i].counts);
    }
    free(workers);
    return status == ASP_OK ? ASP_OK
                            : asp_fail(err, status, "progress", "stopped by its progress function");
}
