/* law_walk.c - laws of multiple scattering over the distribution
 *
 * A walk between perfect mirrors, or through a dielectric without absorption, always ends with weight 1;
 * what could be wrong is where it ends. So eval, which connects every facet met to wo, is integrated with
 * directions that are not the walk's, and compared with 1 and, cell by cell, with where walks end. */
#include "laws/laws.h"

#include <math.h>

#define CELLS 12      /* three bands of height on either side, two halves of azimuth */

static int cell_of(asp_vec3 w, asp_vec3 wi)
{
    int band = (int)(3 * fmin(fabs(w.z), 0.999999)), side = w.z < 0;
    int half = w.x * wi.y - w.y * wi.x > 0;
    return (side * 3 + band) * 2 + half;
}

/* Mean of samples with its standard error. */
typedef struct mean { double sum, sum2; } mean;

static void put(mean *m, double x)
{
    m->sum += x;
    m->sum2 += x * x;
}

static double value(const mean *m, double n) { return m->sum / n; }

static double error2(const mean *m, double n)
{
    double v = m->sum / n;
    return fmax(m->sum2 / n - v * v, 0) / n;
}

/* Carried by less than 100 samples of equal size: with fewer, the largest that there are may not have come yet. */
static int few(const mean *m) { return m->sum * m->sum < 100 * m->sum2 || !(m->sum > 0); }

static void join(mean *into, const mean *m)
{
    into->sum += m->sum;
    into->sum2 += m->sum2;
}

/* The mirror image in the walls that close a skewed surface. */
static asp_vec3 in_wall(const aspi_trial *t, asp_vec3 w)
{
    double x = t->ndf->map.tx, y = t->ndf->map.ty, along = 2 * (w.x * x + w.y * y) / fmax(x * x + y * y, 1e-300);
    return (asp_vec3){ w.x - along * x, w.y - along * y, w.z };
}

/* Directions from half single scattering, half a cosine lobe on either side: density of both. On a skewed
 * surface a wall may come before or after the facet, which on a smooth one makes lobes elsewhere. */
static asp_vec3 propose(aspi_trial *t, const asp_material *mat, asp_vec3 wi, int both, double *pdf)
{
    double u1 = aspi_uniform(t), u2 = aspi_uniform(t), z = sqrt(1 - u1), lobes = 0;
    asp_vec3 wo = { sqrt(u1) * cos(2 * ASPI_PI * u2), sqrt(u1) * sin(2 * ASPI_PI * u2), z };
    int ways = t->skewed ? 4 : 1, way = (int)(aspi_uniform(t) * ways);
    if (aspi_uniform(t) < 0.5) {
        asp_bsdf_sample s = asp_sample_lobe(mat, way & 1 ? in_wall(t, wi) : wi, u1, u2, aspi_uniform(t));
        *pdf = 0;
        if (s.pdf <= 0) /* into the surface: asp_pdf knows nothing of these */
            return wi;
        wo = way & 2 ? in_wall(t, s.wo) : s.wo;
    } else if (both && aspi_uniform(t) < 0.5) {
        wo.z = -wo.z;
    }
    for (way = 0; way < ways; way++)
        lobes += asp_pdf(mat, way & 1 ? in_wall(t, wi) : wi, way & 2 ? in_wall(t, wo) : wo) / ways;
    *pdf = 0.5 * lobes + (both || wo.z > 0 ? 0.5 : 0) * (both ? 0.5 : 1) * fabs(wo.z) / ASPI_PI;
    return wo;
}

/* Distributions whose D rises towards the horizon (Student's t below gamma = 1.9) give estimates of large or, with a
 * pole there (below 1.75), infinite variance: their walks are right, but samples do not show that eval is. */
static int has_pole(const asp_ndf *ndf)
{
    for (int i = 0; i < 8; i++) {
        double a = 2 * ASPI_PI * i / 8, z1 = 1e-3, z2 = 1e-6;
        asp_vec3 m1 = { sqrt(1 - z1 * z1) * cos(a), sqrt(1 - z1 * z1) * sin(a), z1 };
        asp_vec3 m2 = { sqrt(1 - z2 * z2) * cos(a), sqrt(1 - z2 * z2) * sin(a), z2 };
        if (asp_D(ndf, m2) > 4 * asp_D(ndf, m1))
            return 1;
    }
    return 0;
}

/* Surfaces whose walks have narrow lobes from chains of facets and walls that no proposal here covers:
 * skewed or much stretched ones that are smooth along an axis, and steep ones. */
static int many_lobes(const aspi_trial *t)
{
    asp_roughness five = asp_map_to_roughness(&t->ndf->map);
    int smooth = t->scale * five.alpha_y < 0.15;
    return (smooth && (t->skewed || five.alpha_x > 10 * five.alpha_y)) || hypot(five.mean_x, five.mean_y) > 1;
}

/* What is tried: `guide` proposes directions; walks end on `both` sides; a `lossless` one carries 1, and so must eval in
 * a furnace, else both lose the same; a `coloured` one carries 1 in the mean; `compare`: eval is looked at too. */
typedef struct subject {
    const asp_material *mat, *guide;
    const char *name, *view;
    asp_vec3 wi;
    int both, lossless, coloured, compare;
} subject;

/* The furnace of eval with its standard error and what walks carry, and the cell farthest from where walks end. */
typedef struct view_found {
    double furnace, se, carried, worst, ends, parts;
    int cell;
} view_found;

static double furnace_off(const view_found *f) { return fabs(f->furnace - f->carried); }

static double furnace_allowed(const view_found *f) { return 1e-3 + 3 * f->se; }

static int lost(const view_found *f, const subject *s)
{
    return s->coloured && fabs(f->carried - 1) > furnace_allowed(f);
}

#define CELL_ALLOWED 5.5

/* n walks, each of which is looked at, and as many samples of eval. */
static view_found measure(aspi_trial *t, const subject *s, size_t samples)
{
    mean total = { 0, 0 }, carried = { 0, 0 }, ends[CELLS + 1] = { { 0, 0 } }, parts[CELLS + 1] = { { 0, 0 } };
    double n = (double)samples, most = 1;
    view_found f = { 0, 0, 1, 0, 0, 0, 0 };
    if (s->both && s->mat->transport != ASP_IMPORTANCE) /* a walk crosses more than once; radiance is 1/eta^2 below */
        most = fmax(1, 1 / (s->mat->c.r * s->mat->c.r));
    for (size_t i = 0; i < samples; i++) {
        asp_bsdf_sample end = asp_walk_sample(s->mat, s->wi, aspi_next, t);
        double pdf, x;
        asp_vec3 wo;
        if (!s->coloured)
            aspi_find(t, s->lossless ? fabs(end.weight.r - 1) : end.weight.r - most, 1e-12, "%s, %s: a walk carries %.15g",
                      s->name, s->view, end.weight.r);
        put(&carried, end.weight.r);
        put(&ends[cell_of(end.wo, s->wi)], end.weight.r);
        if (!s->compare)
            continue;
        wo = propose(t, s->guide, s->wi, s->both, &pdf);
        x = pdf > 0 ? asp_walk_eval_cos(s->mat, s->wi, wo, aspi_next, t).r / pdf : 0;
        put(&total, x);
        put(&parts[cell_of(wo, s->wi)], x);
    }
    f.furnace = value(&total, n);
    f.se = sqrt(error2(&total, n) + (s->lossless ? 0 : error2(&carried, n)));
    if (!s->lossless)
        f.carried = value(&carried, n);
    /* a cell that a few paths carry has no variance to speak of, and is counted with the others like it, at the end */
    for (int c = 0; c < CELLS; c++)
        if (few(&ends[c]) || few(&parts[c])) {
            join(&ends[CELLS], &ends[c]);
            join(&parts[CELLS], &parts[c]);
            ends[c] = parts[c] = (mean){ 0, 0 };
        }
    for (int c = 0; c <= CELLS; c++) {
        double a = value(&ends[c], n), b = value(&parts[c], n);
        double off = fabs(a - b) / sqrt(error2(&ends[c], n) + error2(&parts[c], n) + 1e-12);
        if (!few(&ends[c]) && !few(&parts[c]) && off > f.worst) {
            f.worst = off;
            f.cell = c;
            f.ends = a;
            f.parts = b;
        }
    }
    return f;
}

static void try_material(aspi_trial *t, const asp_material *mat, const asp_material *guide,
                         const char *name, int both, int lossless, size_t n)
{
    subject s = { mat, guide, name, "", { 0, 0, 1 }, both, lossless, aspi_traits_of(mat).coloured, 0 };
    s.compare = !has_pole(t->ndf) && !many_lobes(t) && !(both && t->skewed); /* a wall that refracts makes a Dirac peak */
    for (size_t k = 0; k < t->view_count; k += 3) {
        view_found f;
        s.wi = t->views[k].w;
        s.view = t->views[k].name;
        f = measure(t, &s, n);
        /* beyond a bound by chance or by a few heavy samples, or a fault: that one comes back */
        if (lost(&f, &s) || (s.compare && (furnace_off(&f) > furnace_allowed(&f) || f.worst > CELL_ALLOWED)))
            f = measure(t, &s, 8 * n);
        if (s.coloured)
            aspi_find(t, fabs(f.carried - 1), furnace_allowed(&f), "%s, %s: walks carry %.5f, not 1", name, s.view, f.carried);
        if (s.compare) {
            aspi_find(t, furnace_off(&f), furnace_allowed(&f), "%s, %s: furnace %.5f +- %.5f, not %.5f", name, s.view,
                      f.furnace, f.se, f.carried);
            aspi_find(t, f.worst, CELL_ALLOWED, "%s, %s: ends against eval, cell %d: %.5f, %.5f", name, s.view, f.cell,
                      f.ends, f.parts);
        }
        if (aspi_tick(t, (double)k / (double)t->view_count))
            return;
    }
}

/* The largest area seen along the mean plane: GGX with alpha 3 has 1.5. Beyond it walks are long, and few
 * of them carry most of an estimate. */
#define STEEPEST 1.6

void aspi_law_walk(aspi_trial *t)
{
    asp_vec3 level[2] = { { 1, 0, 0 }, { 0, 1, 0 } };
    if (fmax(asp_sigma(t->ndf, level[0]), asp_sigma(t->ndf, level[1])) > STEEPEST)
        return;
    static const asp_rgb white = { 1, 1, 1 };
    size_t n = t->samples / 20;
    if (t->own) {
        const char *name;
        const asp_material *own = aspi_material(t, ASPI_OWN, &name);
        aspi_traits is = aspi_traits_of(own);
        asp_material facets = asp_mirror(t->ndf, ASP_MASK_WALL), kept;
        if (is.coloured) {
            kept = aspi_importance(own);
            own = &kept;
        }
        if (is.walks)
            try_material(t, own, is.mirrors || is.crosses ? own : &facets, name, is.crosses, 0, n);
        return;
    }
    asp_material mirror = asp_mirror(t->ndf, ASP_MASK_WALL);
    asp_material diffuse = asp_rough_diffuse(t->ndf, white, ASP_MASK_WALL);
    asp_material glass = asp_dielectric(t->ndf, 1.5, 0, ASP_IMPORTANCE, ASP_MASK_WALL);
    try_material(t, &mirror, &mirror, "mirror", 0, 1, n);
    try_material(t, &diffuse, &mirror, "diffuse", 0, 1, n);
    try_material(t, &glass, &glass, "dielectric", 1, 1, n);
}
