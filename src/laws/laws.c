/* laws.c - the table of laws, and how one distribution is tried by it
 *
 * A law is a function and a row. It sees the distribution through the public header only and
 * reports comparisons to aspi_find, which keeps the one that is worst against what is allowed. */
#include "laws/laws.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const aspi_law_row rows[] = {
    { { "normalisation", "the integral of D(m) m.z over facets is 1",
        "Walter et al. 2007, eq. 4", "absolute" }, aspi_law_normalisation, 1, 0 },
    { { "slope_density", "P22 integrates to 1, and D = P22 / cos^4",
        "Ribardiere et al. 2017, eq. 5", "relative" }, aspi_law_slope_density, 1, 0 },
    { { "mean_slope", "the mean of the slopes is the map's; the mean normal is (-mean, 1)",
        "Walter et al. 2014, sec. 5", "relative to mean + roughness" }, aspi_law_mean_slope, 1, 0 },
    { { "slope_map", "P22(M q + t) |det M| = P22 of the standard surface at q, round in q",
        "p = M q + t", "relative" }, aspi_law_slope_map, 1, 0 },
    { { "rotation", "turning the map is turning the directions",
        "p = M q + t", "relative" }, aspi_law_rotation, 1, 0 },
    { { "matrix", "map -> A -> map, A^T A -> map and map -> five numbers -> map are one distribution",
        "Walter et al. 2014, eqs. 1-3", "relative" }, aspi_law_matrix, 1, 0 },
    { { "sigma", "sigma(w) is the integral of max(0, w.m) D, above and below the horizon",
        "Heitz 2014, eq. 22; Walter et al. 2014, eq. 6", "relative" }, aspi_law_sigma, 4, 0 },
    { { "sigma_flip", "sigma(-w) = sigma(w) - (w.z - t.w_xy), and sigma >= 0",
        "the two sides of one surface", "relative" }, aspi_law_sigma_flip, 1, 0 },
    { { "G1", "G1 = min(1, w.z/sigma) or w.z/(sigma + wall), Lambda = 1/G1 - 1, falls with the angle",
        "Walter et al. 2014, eq. 6; Heitz 2014, eqs. 43, 71", "relative" }, aspi_law_G1, 1, 0 },
    { { "G2", "G1 G1 <= correlated G2 <= min(G1, G1), the same both ways, 0 behind the facet",
        "Heitz 2014, eqs. 72-99", "absolute" }, aspi_law_G2, 1, 0 },
    { { "wall", "with walls the visible area is w.z exactly: (sigma + wall) front less back, G1 <= 1",
        "Walter et al. 2014, sec. 5.1", "absolute" }, aspi_law_wall, 1, 0 },
    { { "pdf_normal", "the density of normals is that of their slopes, P22 / cos^3; its integral is 1",
        "Walter et al. 2007, eq. 24", "relative" }, aspi_law_density_normal, 1, 0 },
    { { "pdf_visible", "the density of visible normals is max(0, w.m) D / sigma; its integral is 1",
        "Heitz, d'Eon 2014, eq. 2; Walter et al. 2014, eq. 33", "relative" },
      aspi_law_density_visible, 8, 0 },
    { { "reciprocity", "f(wi, wo) = f(wo, wi)", "Helmholtz", "relative" }, aspi_law_reciprocity, 2, 1 },
    { { "furnace", "a surface in a white furnace returns at most what came",
        "Heitz 2014, sec. 5.4", "albedo above 1" }, aspi_law_furnace, 20, 1 },
    { { "weak_furnace", "the integral of G1 D / (4 cos_i) over all wo is 1 where nothing is skewed",
        "Heitz 2014, eq. 91", "absolute" }, aspi_law_weak_furnace, 4, 0 },
    { { "weight", "weight = f cos / pdf of the sample, never above 1 for a mirror surface",
        "importance sampling", "relative" }, aspi_law_weight, 2, 1 },
    { { "sample_normal", "sampled normals follow D m.z", "chi-square", "-log10 p" },
      aspi_law_sample_normal, 6, 0 },
    { { "sample_visible", "sampled visible normals follow their density", "chi-square", "-log10 p" },
      aspi_law_sample_visible, 25, 0 },
    { { "sample_bsdf", "sampled directions follow pdf", "chi-square", "-log10 p" },
      aspi_law_sample_bsdf, 30, 1 },
    { { "weight_histogram", "weights of samples add up to the integral of eval, cell by cell",
        "chi-square of weight sums", "-log10 p" }, aspi_law_weight_histogram, 25, 1 },
    { { "sample_materials", "coats, films and glass: samples follow pdf, their weights add up to eval",
        "chi-square", "-log10 p" }, aspi_law_sample_materials, 30, 1 },
    { { "refraction", "weight = f cos / pdf on both sides, in importance never above 1",
        "Walter et al. 2007, sec. 5", "relative" }, aspi_law_refraction, 2, 1 },
    { { "adjoint", "f(wo, wi) n_i^2 = f(wi, wo) n_o^2, and importance is the adjoint of radiance",
        "Veach 1997, sec. 5.2", "relative" }, aspi_law_adjoint, 2, 1 },
    { { "no_boundary", "a dielectric of index 1 is not there: samples, sheets and walks over its facets go straight on",
        "Snell", "absolute" }, aspi_law_no_boundary, 1, 0 },
    { { "limits", "no index: nothing bends; no roughness: a smooth boundary; gamma without end: Beckmann",
        "Snell; Ribardiere et al. 2017, sec. 3", "absolute; relative" }, aspi_law_limits, 1, 0 },
    { { "walk", "walks without absorption return all light, and end where eval says",
        "Heitz, Hanika, d'Eon, Dachsbacher 2016", "standard errors; albedo" }, aspi_law_walk, 20, 1 },
    { { "continuity", "samples are continuous in (u1, u2), and periodic or not, never jump",
        "stratification survives", "absolute" }, aspi_law_continuity, 2, 0 },
    { { "float32", "float32 agrees with float64 at the same float32 inputs",
        "2e-6, and 1e-4 below 1e-6 of the peak", "relative" }, aspi_law_float32, 4, 1 },
    { { "batch", "a batch gives the bits of the single calls", "asperity.h, section 8",
        "differing results" }, aspi_law_batch, 2, 1 },
    { { "finite", "finite unit vectors never give NaN or infinity, nor u at its ends",
        "asperity.h", "bad results" }, aspi_law_finite, 2, 1 },
    { { "nan", "a NaN that comes in goes out", "asperity.h", "NaN lost" }, aspi_law_nan, 1, 1 },
};

#define ROWS (sizeof rows / sizeof rows[0])

const asp_law *asp_laws(size_t index)
{
    return index < ROWS ? &rows[index].law : NULL;
}

int asp_law_of_materials(const asp_law *law)
{
    size_t i = 0;
    while (i < ROWS && &rows[i].law != law)
        i++;
    return i < ROWS && rows[i].materials;
}

/* Is the law asked for? */
static int wanted(const aspi_law_row *row, const asp_laws_options *o)
{
    return (!o->only || strcmp(o->only, row->law.name) == 0) && (!o->material || row->materials);
}

asp_laws_options asp_laws_options_default(void)
{
    asp_laws_options o;
    memset(&o, 0, sizeof o);
    o.samples = 100000;
    o.seed = 1;
    return o;
}

/* ------------------------------------------------------------------ findings */

void aspi_find(aspi_trial *t, double deviation, double allowed, const char *where, ...)
{
    asp_law_result *r = t->result;
    double ratio = allowed > 0 ? deviation / allowed : deviation > 0 ? INFINITY : 0;
    va_list args;
    r->checks++;
    if (!(deviation == deviation) || !(allowed == allowed))
        ratio = deviation = INFINITY;
    if (r->checks > 1 && !(ratio > t->ratio))
        return;
    t->ratio = ratio;
    r->worst = deviation;
    r->allowed = allowed;
    va_start(args, where);
    vsnprintf(r->where, sizeof r->where, where, args);
    va_end(args);
}

int aspi_taken(const aspi_trial *t, size_t index)
{
    return !t->sparse || (index + t->phase) % 3 == 0;
}

int aspi_tick(aspi_trial *t, double done)
{
    if (!t->cancelled && t->progress && t->progress(t->context, t->done + t->share * done) != 0)
        t->cancelled = 1;
    return t->cancelled;
}

/* ------------------------------------------------------------------ vectors */

asp_vec3 aspi_unit(double x, double y, double z)
{
    /* scaled first: the slopes of heavy tails have no squares */
    double big = fmax(fmax(fabs(x), fabs(y)), fabs(z)), n;
    asp_vec3 v;
    x /= big;
    y /= big;
    z /= big;
    n = 1 / sqrt(x * x + y * y + z * z);
    v.x = x * n;
    v.y = y * n;
    v.z = z * n;
    return v;
}

double aspi_dot(asp_vec3 a, asp_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

double aspi_largest(asp_rgb c) { return fmax(c.r, fmax(c.g, c.b)); }

double aspi_average(asp_rgb c) { return (c.r + c.g + c.b) / 3; }

asp_vec3 aspi_direction(double theta, double phi)
{
    asp_vec3 v;
    v.x = sin(theta) * cos(phi);
    v.y = sin(theta) * sin(phi);
    v.z = cos(theta);
    return v;
}

asp_vec2 aspi_map_slope(const asp_map *map, double qx, double qy)
{
    asp_vec2 p;
    p.x = map->m00 * qx + map->m01 * qy + map->tx;
    p.y = map->m10 * qx + map->m11 * qy + map->ty;
    return p;
}

void aspi_standard_polar(const asp_ndf *ndf, asp_vec3 m, double *r, double *phi)
{
    /* homogeneous: the slope of a vertical facet is infinite, its direction is not */
    double x = -m.x - ndf->map.tx * m.z, y = -m.y - ndf->map.ty * m.z;
    double qx = ndf->i00 * x + ndf->i01 * y, qy = ndf->i10 * x + ndf->i11 * y;
    *r = m.z > 0 ? hypot(qx, qy) / m.z : INFINITY;
    *phi = atan2(qy, qx);
}

void aspi_standard_view(const asp_ndf *ndf, asp_vec3 w, double *height, double *length)
{
    const asp_map *map = &ndf->map;
    *height = w.z - map->tx * w.x - map->ty * w.y;
    *length = hypot(map->m00 * w.x + map->m10 * w.y, map->m01 * w.x + map->m11 * w.y);
}

double aspi_r2_density(const aspi_trial *t, double r, double phi)
{
    asp_vec2 p = aspi_map_slope(&t->ndf->map, r * cos(phi), r * sin(phi));
    asp_vec3 m = aspi_unit(-p.x, -p.y, 1);
    double zr = m.z * r;
    /* P22 = D z^4, in an order that neither D's growth nor z's fall can spoil */
    return ((asp_D(t->ndf, m) * m.z) * m.z) * zr * zr * t->det;
}

/* ------------------------------------------------------------------ a trial */

static void add_view(aspi_trial *t, asp_vec3 w, const char *name)
{
    if (t->view_count < ASPI_VIEWS && w.z > 0) {
        t->views[t->view_count].w = w;
        t->views[t->view_count++].name = name;
    }
}

/* Views by angle, and by what matters to masking: cot(theta) against the roughness along the
 * azimuth. A skewed surface is also seen along its tilt and from below its mean plane. */
static void choose_views(aspi_trial *t)
{
    const asp_map *map = &t->ndf->map;
    double tilt = hypot(map->tx, map->ty), along = tilt > 0 ? atan2(map->ty, map->tx) : 0.7;
    double cx = cos(along + 0.4), sx = sin(along + 0.4);
    double rough = t->scale * hypot(map->m00 * cx + map->m10 * sx, map->m01 * cx + map->m11 * sx);
    asp_vec3 normal = { 0, 0, 1 };
    t->view_count = 0;
    add_view(t, normal, "normal incidence");
    add_view(t, aspi_direction(0.5, 1.1), "oblique");
    add_view(t, aspi_direction(1.1, -2.0), "steep");
    add_view(t, aspi_direction(0.5 * ASPI_PI - atan(rough), along + 0.4), "cot = roughness");
    add_view(t, aspi_direction(0.5 * ASPI_PI - atan(0.1 * rough), along + 0.4), "grazing");
    add_view(t, aspi_direction(0.5 * ASPI_PI - 1e-5, 2.5), "1e-5 from the horizon");
    if (t->skewed) {
        add_view(t, aspi_direction(0.9, along), "against the tilt");
        add_view(t, aspi_direction(1.2, along + ASPI_PI), "along the tilt");
        add_view(t, aspi_direction(0.5 * ASPI_PI - atan(0.5 * tilt), along),
                 "below the mean plane");
        add_view(t, aspi_direction(0.5 * ASPI_PI - atan(0.99 * tilt), along + 0.02),
                 "in the mean plane");
    }
}

static void prepare_trial(aspi_trial *t, const asp_ndf *ndf)
{
    double phi;
    memset(t, 0, sizeof *t);
    t->ndf = ndf;
    t->ndff = asp_ndf_narrow(ndf);
    t->standard = *ndf;
    t->standard.map.m00 = t->standard.map.m11 = 1;
    t->standard.map.m01 = t->standard.map.m10 = t->standard.map.tx = t->standard.map.ty = 0;
    t->standard.i00 = t->standard.i11 = t->standard.inv_det = 1;
    t->standard.i01 = t->standard.i10 = 0;
    t->det = fabs(ndf->map.m00 * ndf->map.m11 - ndf->map.m01 * ndf->map.m10);
    t->skewed = ndf->map.tx != 0 || ndf->map.ty != 0;
    aspi_standard_polar(ndf, asp_sample_normal(ndf, 0.5, 0.25), &t->scale, &phi);
    t->planar = ndf->model->lattice && ndf->model->lattice(ndf, &t->lattice);
    if (t->planar) /* no slope stands for the others: an eighth of the rectangle's diagonal */
        t->scale = 0.125 * hypot(t->lattice.dx * (double)t->lattice.nx,
                                 t->lattice.dy * (double)t->lattice.ny);
    if (!(t->scale > 0 && t->scale < 1e30)) /* a broken sampler; its law will say so */
        t->scale = 1;
    choose_views(t);
    t->phase = (unsigned)fmod(1e4 * fabs(log(t->scale * t->det) + ndf->map.m01 + 0.3 * ndf->map.tx), 1e6);
}

static int check_row(aspi_trial *t, const aspi_law_row *row, uint64_t seed, asp_law_report *report,
                     void *context)
{
    asp_law_result result;
    memset(&result, 0, sizeof result);
    result.law = &row->law;
    t->result = &result;
    t->ratio = 0;
    t->state = seed * 0xd1342543de82ef95u + (uint64_t)(row - rows) * 0x9e3779b97f4a7c15u;
    row->check(t);
    result.passed = t->ratio <= 1;
    if (report && !t->cancelled && !t->no_memory)
        report(context, &result);
    return result.passed;
}

asp_status asp_laws_check(const asp_ndf *ndf, const asp_laws_options *options,
                          asp_law_report *report, void *context, size_t *failed, asp_error *err)
{
    asp_laws_options o = options ? *options : asp_laws_options_default();
    aspi_trial *t;
    size_t i, broken = 0, found = 0;
    double weight = 0;
    asp_status status = ASP_OK;
    if (o.samples < 1000 || o.samples > 100000000)
        return asp_fail_range(err, "samples", (double)o.samples, 1000, 0, 1e8);
    for (i = 0; i < ROWS; i++)
        if (wanted(&rows[i], &o)) {
            found++;
            weight += rows[i].weight;
        } else if (o.only && strcmp(o.only, rows[i].law.name) == 0) {
            return asp_fail(err, ASP_EINVAL, o.only, "this law speaks of distributions, not of a material");
        }
    if (found == 0)
        return asp_fail(err, ASP_EUNKNOWN, o.only, "no such law");
    t = (aspi_trial *)malloc(sizeof *t);
    if (!t)
        return asp_fail(err, ASP_ENOMEM, "laws", "out of memory");
    prepare_trial(t, o.material ? &o.material->ndf : ndf);
    t->own = o.material;
    t->samples = o.samples;
    t->sparse = o.sparse;
    t->progress = o.progress;
    t->context = o.context;
    for (i = 0; i < ROWS && status == ASP_OK; i++) {
        if (!wanted(&rows[i], &o))
            continue;
        t->share = rows[i].weight / weight;
        if (!check_row(t, &rows[i], o.seed, report, context))
            broken++;
        t->done += t->share;
        if (t->no_memory)
            status = asp_fail(err, ASP_ENOMEM, rows[i].law.name, "out of memory");
        else if (aspi_tick(t, 0))
            status = asp_fail(err, ASP_ECANCELLED, rows[i].law.name, "cancelled");
    }
    free(t);
    if (status == ASP_OK && failed)
        *failed = broken;
    return status;
}
