/* fabricate.c - surface, rays, table: one measurement from a recipe */
#include "surface/surface.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

asp_fabrication asp_fabrication_default(void)
{
    return (asp_fabrication){ .surface = asp_surface_recipe_default(),
                              .metal = asp_find_metal("Au"), .rays = 12000000, .threads = 2 };
}

/* Making the surface and its tree is about a tenth of the work. */
static const double SURFACE_SHARE = 0.1;

typedef struct scaled { asp_progress *progress; void *context; } scaled;

static int scaled_progress(void *context, double done)
{
    scaled *s = context;
    return s->progress(s->context, SURFACE_SHARE + (1 - SURFACE_SHARE) * done);
}

static asp_status measure_field(const asp_height_field *field, const asp_fabrication *what,
                                asp_progress *progress, void *context, aspi_counts *counts,
                                asp_error *err)
{
    aspi_tracer *tracer = aspi_tracer_make(field, err);
    if (!tracer)
        return err ? err->status : ASP_ENOMEM;
    scaled inner = { progress, context };
    asp_status status = ASP_OK;
    if (progress && progress(context, SURFACE_SHARE))
        status = asp_fail(err, ASP_ECANCELLED, "progress", "stopped by its progress function");
    if (status == ASP_OK)
        status = aspi_gonio_count(tracer, what->metal, what->surface.seed, what->rays,
                                  what->threads, progress ? scaled_progress : NULL, &inner, counts,
                                  err);
    aspi_tracer_free(tracer);
    return status;
}

static double ratio(uint64_t a, uint64_t b)
{
    return b ? (double)a / (double)b : 0;
}

static void summarise(const aspi_counts *n, asp_fabrication_report *report)
{
    double sent = (double)(n->rays - n->lost) * ASPI_WEIGHT_ONE;
    report->rays = n->rays;
    report->lost = n->lost;
    report->albedo = (asp_rgb){ (double)n->all.r / sent, (double)n->all.g / sent,
                                (double)n->all.b / sent };
    report->multiple = (asp_rgb){ ratio(n->multiple.r, n->all.r), ratio(n->multiple.g, n->all.g),
                                  ratio(n->multiple.b, n->all.b) };
    report->bounces = ratio(n->bounces, n->rays - n->lost);
}

static void describe(const asp_fabrication *what, const asp_fabrication_report *r, char *text,
                     size_t size)
{
    const asp_surface_recipe *s = &what->surface;
    char shape[96], name[64] = "a perfect mirror (F = 1)";
    snprintf(shape, sizeof shape, "Gaussian slopes, alpha %.4g", s->alpha);
    if (!isinf(s->gamma))
        snprintf(shape, sizeof shape, "Student's t slopes, alpha %.4g, gamma %.4g", s->alpha,
                 s->gamma);
    if (what->metal)
        snprintf(name, sizeof name, "%s (conductor Fresnel term per channel)", what->metal->name);
    snprintf(text, size,
             "Fabricated, not measured on a specimen: %zu rays traced against an explicit periodic "
             "height field of %d x %d points (seed %llu, %s; its facets by maximum likelihood: "
             "alpha %.4g, gamma %.4g), flat facets of %s, all bounces (%.2f %% of the green power "
             "met more than one facet). Counted in %zu cells of half/difference angles folded by "
             "reciprocity and mirror symmetry, median counting error %.1f %%, log f interpolated to "
             "90 x 90 x 180.",
             r->rays, s->size, s->size, (unsigned long long)s->seed, shape, r->slopes.alpha,
             r->slopes.gamma, name, 100 * r->multiple.g, r->cells, 100 * r->noise);
}

asp_measured *asp_fabricate(const asp_fabrication *what, asp_progress *progress, void *context,
                            asp_fabrication_report *report, asp_error *err)
{
    if (what->rays < 10000 || what->rays > 10000000000u) {
        asp_fail_range(err, "rays", (double)what->rays, 1e4, 0, 1e10);
        return NULL;
    }
    if (what->threads < 1 || what->threads > 256) {
        asp_fail_range(err, "threads", what->threads, 1, 0, 256);
        return NULL;
    }
    asp_height_field field = { 0 };
    asp_fabrication_report r = { 0 };
    asp_measured *measured = NULL;
    if (asp_height_field_make(&what->surface, &field, err) != ASP_OK)
        return NULL;
    aspi_counts *counts = malloc(sizeof *counts);
    double *values = malloc(sizeof *values * 3 * 90 * 90 * 180);
    if (!counts || !values) {
        asp_fail(err, ASP_ENOMEM, "table", "out of memory");
    } else if (asp_height_field_slopes(&field, &r.slopes, err) == ASP_OK
               && measure_field(&field, what, progress, context, counts, err) == ASP_OK
               && aspi_gonio_table(counts, values, &r, err) == ASP_OK) {
        char text[1024];
        summarise(counts, &r);
        describe(what, &r, text, sizeof text);
        measured = asp_measured_from_merl_table(values, text, err);
    }
    free(counts);
    free(values);
    asp_height_field_free(&field);
    if (measured && report)
        *report = r;
    return measured;
}
