/* preview.c - a lit sphere, row by row over all processors */
#define _XOPEN_SOURCE 700
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <unistd.h>

#include "render/environment.h"
#include "render/inside.h"
#include "render/scatter.h"
#include "render/sobol.h"

#define BACKGROUND_VIEW 0.36          /* tangent of half the view behind an orthographic sphere */

typedef struct camera {
    double scale;                     /* picture plane per pixel; the sphere's outline has radius 1 */
    double half_width, half_height;   /* of the picture, px */
    double tangent;                   /* of half the sphere's angle; 0: orthographic */
    double distance;                  /* of the camera from the centre */
} camera;

typedef struct job {
    aspi_scatter scatter;
    aspi_lights  lights;
    camera       camera;
    asp_image    image;
    int          samples, plain;
    asp_rgb      background;
    uint32_t     seed;
    atomic_int   next_row, rows_done, stop;
} job;

/* ------------------------------------------------------------------ geometry */

/* The point of the unit sphere seen through (px, py) of the picture plane, which is also its normal,
 * and the direction to the viewer. 0: the ray passes by; `w` is then where it goes. */
static int look(const camera *cam, double px, double py, asp_vec3 *n, asp_vec3 *view, asp_vec3 *w)
{
    double r2 = px * px + py * py;
    if (cam->tangent == 0) {
        double t = BACKGROUND_VIEW, scale = 1 / sqrt(1 + t * t * r2);
        *w = (asp_vec3){ px * t * scale, py * t * scale, -scale };
        *view = (asp_vec3){ 0, 0, 1 };
        *n = (asp_vec3){ px, py, sqrt(fmax(0, 1 - r2)) };
        return r2 < 1;
    }
    double t = cam->tangent, scale = 1 / sqrt(1 + t * t * r2);
    *w = (asp_vec3){ px * t * scale, py * t * scale, -scale };
    *view = (asp_vec3){ -w->x, -w->y, -w->z };
    /* closest approach to the centre, and back from there by half the chord */
    double along = cam->distance * scale, miss2 = cam->distance * cam->distance * (1 - scale * scale);
    if (!(r2 < 1) || miss2 >= 1)
        return 0;
    double s = along - sqrt(1 - miss2);
    *n = (asp_vec3){ s * w->x, s * w->y, cam->distance + s * w->z };
    double length = sqrt(aspi_dot(*n, *n));
    *n = (asp_vec3){ n->x / length, n->y / length, n->z / length };
    return 1;
}

static void put(aspi_directions *d, size_t i, asp_vec3 w)
{
    d->x[i] = w.x;
    d->y[i] = w.y;
    d->z[i] = w.z;
}

/* ------------------------------------------------------------------ one pixel */

/* What a block of samples of one pixel that hit the sphere needs to know. */
typedef struct block {
    size_t          n;
    aspi_frame      frame[ASPI_BLOCK];
    uint32_t        index[ASPI_BLOCK];
    double          chance[ASPI_BLOCK][ASP_LIGHTS];
    int             has_light[ASPI_BLOCK];
    double          u1[ASPI_BLOCK], u2[ASPI_BLOCK], pdf[ASPI_BLOCK];
    aspi_directions wi, wo;
    aspi_colours    value;
} block;

static void add(asp_rgb *sum, asp_rgb light, const aspi_colours *value, size_t i, double factor)
{
    sum->r += light.r * value->r[i] * factor;
    sum->g += light.g * value->g[i] * factor;
    sum->b += light.b * value->b[i] * factor;
}

/* One direction of the surface's own sampler per sample. The balance heuristic joins it with the
 * lights': f cos L / (p_surface + p_lights) = weight L / (1 + p_lights / p_surface). */
static void add_surface_samples(const job *job, block *b, uint32_t seed, asp_rgb *sum)
{
    for (size_t i = 0; i < b->n; i++)
        aspi_sobol(b->index[i], seed, &b->u1[i], &b->u2[i]);
    aspi_scatter_sample(&job->scatter, b->n, &b->wi, b->u1, b->u2, &b->wo, b->pdf, &b->value);
    for (size_t i = 0; i < b->n; i++) {
        asp_vec3 w = aspi_to_world(&b->frame[i], (asp_vec3){ b->wo.x[i], b->wo.y[i], b->wo.z[i] });
        if (b->wo.z[i] < 0 && job->scatter.material) {
            asp_rgb light = aspi_through(&job->scatter, &job->lights, b->frame[i].z, w,
                                         (asp_rgb){ b->value.r[i], b->value.g[i], b->value.b[i] },
                                         aspi_mix(seed, b->index[i]));
            sum->r += light.r;
            sum->g += light.g;
            sum->b += light.b;
        }
        if (b->pdf[i] == 0 || !(b->wo.z[i] > 0))
            continue;
        double other = b->has_light[i] ? aspi_light_pdf(&job->lights, b->chance[i], w) : 0;
        add(sum, aspi_radiance(&job->lights, w), &b->value, i, 1 / (1 + other / b->pdf[i]));
    }
}

static size_t choose(const double *chance, int count, double u)
{
    int k = 0;
    for (; k + 1 < count && u >= chance[k]; k++)
        u -= chance[k];
    while (k > 0 && chance[k] == 0)          /* rounding may run past the last possible one */
        k--;
    return (size_t)k;
}

/* One direction towards a light per sample. */
static void add_light_samples(const job *job, block *b, uint32_t seed, asp_rgb *sum)
{
    asp_vec3 w[ASPI_BLOCK];
    for (size_t i = 0; i < b->n; i++) {
        double u1, u2, which, unused;
        aspi_sobol(b->index[i], seed, &u1, &u2);
        aspi_sobol(b->index[i], aspi_mix(seed, 7), &which, &unused);
        w[i] = b->frame[i].z;
        if (b->has_light[i]) {
            size_t k = choose(b->chance[i], job->lights.count, which);
            w[i] = aspi_light_sample(&job->lights.light[k], u1, u2);
        }
        put(&b->wo, i, aspi_to_local(&b->frame[i], w[i]));
    }
    aspi_scatter_eval(&job->scatter, b->n, &b->wi, &b->wo, b->pdf, &b->value);
    for (size_t i = 0; i < b->n; i++) {
        double mine = b->has_light[i] ? aspi_light_pdf(&job->lights, b->chance[i], w[i]) : 0;
        if (mine > 0 && b->wo.z[i] > 0)
            add(sum, aspi_radiance(&job->lights, w[i]), &b->value, i, 1 / (mine + b->pdf[i]));
    }
}

static void add_block(const job *job, block *b, uint32_t seed, asp_rgb *sum)
{
    if (b->n == 0)
        return;
    add_surface_samples(job, b, aspi_mix(seed, 102), sum);
    if (job->lights.count > 0)
        add_light_samples(job, b, aspi_mix(seed, 103), sum);
    b->n = 0;
}

static asp_rgb render_pixel(const job *job, block *b, int column, int row)
{
    const camera *cam = &job->camera;
    uint32_t seed = aspi_mix(aspi_mix(job->seed, (uint32_t)column), (uint32_t)row);
    asp_rgb sum = { 0, 0, 0 };
    b->n = 0;
    for (int s = 0; s < job->samples; s++) {
        double u1, u2;
        aspi_sobol((uint32_t)s, aspi_mix(seed, 101), &u1, &u2);
        asp_vec3 n, view, w;
        if (!look(cam, (column + u1 - cam->half_width) * cam->scale,
                  (cam->half_height - row - u2) * cam->scale, &n, &view, &w)) {
            asp_rgb behind = job->plain ? job->background : aspi_radiance(&job->lights, w);
            sum.r += behind.r;
            sum.g += behind.g;
            sum.b += behind.b;
            continue;
        }
        size_t i = b->n++;
        b->index[i] = (uint32_t)s;
        b->frame[i] = aspi_frame_at(n);
        put(&b->wi, i, aspi_to_local(&b->frame[i], view));
        b->has_light[i] = aspi_light_chances(&job->lights, n, b->chance[i]) > 0;
        if (b->n == ASPI_BLOCK)
            add_block(job, b, seed, &sum);
    }
    add_block(job, b, seed, &sum);
    double share = 1.0 / job->samples;
    return (asp_rgb){ share * sum.r, share * sum.g, share * sum.b };
}

/* ------------------------------------------------------------------ rows and threads */

/* Renders the next row that nobody has taken; 0 when there is none. */
static int render_row(job *job, block *b)
{
    if (atomic_load(&job->stop))
        return 0;
    int row = atomic_fetch_add(&job->next_row, 1);
    if (row >= job->image.height)
        return 0;
    float *out = job->image.rgb + 3 * (size_t)row * (size_t)job->image.width;
    for (int column = 0; column < job->image.width && !atomic_load(&job->stop); column++) {
        asp_rgb c = render_pixel(job, b, column, row);
        *out++ = (float)c.r;
        *out++ = (float)c.g;
        *out++ = (float)c.b;
    }
    atomic_fetch_add(&job->rows_done, 1);
    return 1;
}

static void *work(void *argument)
{
    job *job = argument;
    block b;
    while (render_row(job, &b))
        continue;
    return NULL;
}

#define MOST_THREADS 256

static void run(job *job, int threads, asp_preview_progress *progress, void *context)
{
    pthread_t other[MOST_THREADS];
    int others = 0;
    /* fewer threads than wished for is slower, not wrong */
    while (others < threads - 1 && pthread_create(&other[others], NULL, work, job) == 0)
        others++;
    block b;
    do {
        double fraction = (double)atomic_load(&job->rows_done) / job->image.height;
        if (progress && !atomic_load(&job->stop) && progress(context, fraction))
            atomic_store(&job->stop, 1);
    } while (render_row(job, &b));
    for (int i = 0; i < others; i++)
        pthread_join(other[i], NULL);
    if (progress && !atomic_load(&job->stop) && progress(context, 1))
        atomic_store(&job->stop, 1);
}

/* ------------------------------------------------------------------ the description */

static asp_rgb eval_material(const void *material, asp_vec3 wi, asp_vec3 wo)
{
    return asp_eval(material, wi, wo);
}

static int processors(void)
{
    long n = sysconf(_SC_NPROCESSORS_ONLN);
    return n < 1 ? 1 : n > MOST_THREADS ? MOST_THREADS : (int)n;
}

static asp_status in_range(asp_error *err, const char *name, double v, double low, double high)
{
    return v >= low && v <= high ? ASP_OK : asp_fail_range(err, name, v, low, 0, high);
}

static asp_status check(const asp_preview *p, asp_error *err)
{
    if (!p->material == !p->function)
        return asp_fail(err, ASP_EINVAL, "material", "exactly one of material and function is needed");
    if (p->walk && p->material && !asp_can_walk(p->material))
        return asp_fail(err, ASP_EINVAL, "walk", "facets of this material are not known well enough to walk");
    const struct { const char *name; double value, low, high; } ranges[] = {
        { "width", p->width, 0, ASP_IMAGE_SIDE },     { "height", p->height, 0, ASP_IMAGE_SIDE },
        { "samples", p->samples, 0, 65536 },          { "zoom", p->zoom, 0, 1000 },
        { "field_of_view", p->field_of_view, 0, 2 },  { "threads", p->threads, 0, MOST_THREADS },
    };
    for (size_t i = 0; i < sizeof ranges / sizeof *ranges; i++) {
        asp_status status = in_range(err, ranges[i].name, ranges[i].value, ranges[i].low, ranges[i].high);
        if (status != ASP_OK)
            return status;
    }
    return ASP_OK;
}

static camera make_camera(const asp_preview *p, int width, int height)
{
    double zoom = p->zoom > 0 ? p->zoom : 0.9, shorter = width < height ? width : height;
    camera cam = { .scale = 2 / (zoom * shorter), .half_width = 0.5 * width, .half_height = 0.5 * height };
    if (p->field_of_view > 1e-4) {        /* narrower ones differ by less than rounding */
        cam.tangent = tan(0.5 * p->field_of_view);
        cam.distance = 1 / sin(0.5 * p->field_of_view);
    }
    return cam;
}

asp_status asp_preview_render(const asp_preview *preview, asp_image *out, asp_error *err)
{
    const asp_preview *p = preview;
    asp_status status = check(p, err);
    if (status != ASP_OK)
        return status;
    asp_environment studio = asp_environment_studio();
    job job = { .scatter = { p->material, p->function, p->context, p->proposal, p->walk },
                .samples = p->samples ? p->samples : 64,
                .plain = p->plain, .background = p->background, .seed = p->seed };
    if (p->material && p->proposal)
        job.scatter = (aspi_scatter){ NULL, eval_material, p->material, p->proposal, 0 };
    status = aspi_lights_prepare(p->environment ? p->environment : &studio, &job.lights, err);
    if (status != ASP_OK)
        return status;
    int width = p->width ? p->width : 256, height = p->height ? p->height : 256;
    status = asp_image_make(width, height, &job.image, err);
    if (status != ASP_OK)
        return status;
    job.camera = make_camera(p, width, height);
    atomic_init(&job.next_row, 0);
    atomic_init(&job.rows_done, 0);
    atomic_init(&job.stop, 0);
    int threads = p->threads ? p->threads : processors();
    run(&job, threads < height ? threads : height, p->progress, p->progress_context);
    if (atomic_load(&job.stop)) {
        asp_image_free(&job.image);
        return asp_fail(err, ASP_ECANCELLED, "preview", "stopped by the progress function");
    }
    *out = job.image;
    return ASP_OK;
}
