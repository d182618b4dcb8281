/* law_scatter.c - laws of scattering over the distribution: a mirror under every masking, gold, and
 * a diffuse base under a coat; plastic, metals with lost light or a film, Lambertian facets, glass */
#include "laws/laws.h"
#include "bsdf/bsdf.h"

#include <math.h>
#include <stdio.h>

enum { MIRRORS = 5 };
extern const asp_bsdf asp_bsdf_compensated, asp_bsdf_compensated_dielectric;
static const int masks[MIRRORS] = { ASP_MASK_CORRELATED, ASP_MASK_UNCORRELATED, ASP_MASK_V_CAVITY,
                                    ASP_MASK_CORRELATED | ASP_MASK_WALL,
                                    ASP_MASK_UNCORRELATED | ASP_MASK_WALL };
static const char *const names[ASPI_ALL_MATERIALS] = {
    "mirror correlated", "mirror uncorrelated", "mirror v_cavity", "mirror correlated+wall",
    "mirror uncorrelated+wall", "conductor", "lambert_specular", "plastic", "compensated", "film", "eon",
    "rough_diffuse", "dielectric", "sheet", "compensated_dielectric", "film on glass"
};

/* Trials of a material, more where more samples are asked for. */
static int trials(const aspi_trial *t, const asp_material *mat, int most)
{
    int more = (int)(t->samples / 100000 < 100 ? t->samples / 100000 : 100);
    most *= more > 1 ? more : 1;
    return aspi_traits_of(mat).quadrature ? most / 10 : most;
}

/* There are no makers of these: their records prepare what others made. */
static asp_material prepared(asp_material mat, const asp_bsdf *model, double form)
{
    mat.model = model;
    mat.b.r = form;
    mat.model->prepare(&mat, NULL);
    return mat;
}

static asp_material make(const asp_ndf *ndf, int kind)
{
    static const asp_rgb eta = { 0.17, 0.39, 1.45 }, k = { 3.5, 2.4, 1.9 };
    static const asp_rgb diffuse = { 0.4, 0.2, 0.05 }, specular = { 1, 0.9, 0.8 };
    asp_material mat = asp_conductor(ndf, eta, k, ASP_MASK_CORRELATED);
    if (kind < MIRRORS)
        return asp_mirror(ndf, masks[kind]);
    switch (kind) {
    case ASPI_MIXTURE:
        return asp_lambert_specular(ndf, diffuse, specular, 1.5, ASP_MASK_CORRELATED);
    case ASPI_PLASTIC:
        return asp_plastic(ndf, diffuse, 1.5, ASP_MASK_CORRELATED);
    case ASPI_COMPENSATED:
        return prepared(mat, &asp_bsdf_compensated, COMPENSATED_KULLA_CONTY);
    case ASPI_FILM:
        asp_film(&mat, 1.6, 350, NULL);
        return mat;
    case ASPI_EON:
        mat = asp_rough_diffuse(ndf, diffuse, ASP_MASK_CORRELATED);
        return prepared(mat, mat.model, ROUGH_EON);
    case ASPI_ROUGH_DIFFUSE:
        return asp_rough_diffuse(ndf, diffuse, ASP_MASK_CORRELATED);
    case ASPI_DIELECTRIC:
    case ASPI_SHEET:
        return asp_dielectric(ndf, 1.5, kind == ASPI_SHEET, ASP_RADIANCE, ASP_MASK_CORRELATED);
    case ASPI_COMPENSATED_DIELECTRIC:
        mat = asp_dielectric(ndf, 1.5, 0, ASP_RADIANCE, ASP_MASK_CORRELATED);
        return prepared(mat, &asp_bsdf_compensated_dielectric, COMPENSATED_KULLA_CONTY);
    case ASPI_FILM_GLASS:
        mat = asp_dielectric(ndf, 1.5, 0, ASP_RADIANCE, ASP_MASK_CORRELATED);
        asp_film(&mat, 2.2, 300, NULL);
        return mat;
    default:
        return mat;
    }
}

const asp_material *aspi_material(aspi_trial *t, int kind, const char **name)
{
    if (kind == ASPI_OWN) {
        *name = t->own->model->name;
        return t->own;
    }
    *name = names[kind];
    if (!t->made[kind])
        t->material[kind] = make(t->ndf, kind);
    t->made[kind] = 1;
    return &t->material[kind];
}

int aspi_first(const aspi_trial *t, int from) { return t->own ? ASPI_OWN : from; }

int aspi_end(const aspi_trial *t, int to) { return t->own ? ASPI_OWN + 1 : to; }

aspi_traits aspi_traits_of(const asp_material *mat)
{
    aspi_traits out = { 0 };
    int facets = mat->model->facets, gives_back = mat->model == &asp_bsdf_compensated
                                               || mat->model == &asp_bsdf_compensated_dielectric;
    out.crosses = aspi_bsdf_crosses(mat->model);
    out.thin = out.crosses && mat->a.r > 0;
    out.eta = out.crosses && !out.thin ? mat->c.r : 1;
    out.mirrors = facets == ASPI_FACETS_REFLECT;
    out.grooves = (mat->mask & 15) == ASP_MASK_V_CAVITY;
    out.mixed = !out.mirrors && facets != ASPI_FACETS_REFRACT;
    out.coloured = facets == ASPI_FACETS_REFRACT && mat->fresnel == ASPI_FRESNEL_FILM;
    out.quadrature = facets == ASPI_FACETS_DIFFUSE && mat->b.r == ROUGH_EXACT;
    out.reciprocal = !(gives_back && mat->b.r == COMPENSATED_TURQUIN);
    out.walks = asp_can_walk(mat);
    return out;
}

asp_material aspi_importance(const asp_material *mat)
{
    asp_material out = *mat;
    out.transport = ASP_IMPORTANCE;
    return out;
}

static asp_vec3 up(asp_vec3 w)
{
    if (w.z < 0)
        w.x = -w.x, w.y = -w.y, w.z = -w.z;
    return w;
}

static double difference(asp_rgb a, asp_rgb b)
{
    return fmax(fabs(a.r - b.r), fmax(fabs(a.g - b.g), fabs(a.b - b.b)));
}

void aspi_law_reciprocity(aspi_trial *t)
{
    int kind, i;
    const char *name;
    for (kind = aspi_first(t, 0); kind < aspi_end(t, ASPI_ALL_MATERIALS); kind++) {
        const asp_material *mat = aspi_material(t, kind, &name);
        for (i = 0; i < trials(t, mat, 300) && aspi_traits_of(mat).reciprocal; i++) {
            asp_vec3 wi = up(aspi_random_direction(t)), wo = up(aspi_random_direction(t)), m;
            asp_rgb a, b;
            double steps;
            if (i % 2) { /* a pair that shines */
                m = aspi_random_facet(t);
                wo = aspi_unit(2 * aspi_dot(wi, m) * m.x - wi.x, 2 * aspi_dot(wi, m) * m.y - wi.y,
                               2 * aspi_dot(wi, m) * m.z - wi.z);
                if (wo.z <= 0)
                    continue;
            }
            a = asp_eval(mat, wi, wo);
            b = asp_eval(mat, wo, wi);
            /* opposite directions: the cosine to the half vector is |wi + wo|/2, in steps of eps
             * over |wi + wo| */
            steps = aspi_dot(wi, wo) + 1;
            steps = 1e-15 / fmax(steps, 1e-15);
            if (aspi_traits_of(mat).crosses)
                steps += 1e-15 * aspi_total_steps(sqrt(fmax(1 + aspi_dot(wi, wo), 0) / 2), mat->c.r);
            aspi_find(t, difference(a, b) / fmax(aspi_largest(a), 1e-200), 1e-13 + steps,
                      "%s, wi (%.6g, %.6g, %.6g), wo (%.6g, %.6g, %.6g)", name, wi.x, wi.y, wi.z,
                      wo.x, wo.y, wo.z);
            aspi_find(t, !(a.r >= 0 && a.g >= 0 && a.b >= 0), 0, "%s: negative f", name);
        }
    }
}

/* What the table of a model that gives back what is lost may be off by (docs/materials.md). */
#define GIVEN_BACK 0.003

/* The mean weight of samples, for what cubature in the slopes cannot know: another lobe, another side. */
static void furnace_by_samples(aspi_trial *t, asp_vec3 wi, const char *view, size_t n)
{
    asp_material mat = aspi_importance(t->own);
    aspi_traits is = aspi_traits_of(t->own);
    double sum = 0, sum2 = 0, mean, error;
    for (size_t i = 0; i < n; i++) {
        double u1 = aspi_uniform(t), u2 = aspi_uniform(t);
        asp_rgb c = asp_sample_lobe(&mat, wi, u1, u2, aspi_uniform(t)).weight;
        double w = is.coloured ? aspi_average(c) : aspi_largest(c);
        sum += w;
        sum2 += w * w;
    }
    mean = sum / (double)n;
    error = sqrt(fmax(sum2 / (double)n - mean * mean, 0) / (double)n);
    aspi_find(t, fmax(0, mean - 1), 6 * error + 2 * t->ndf->model->area_error + (is.walks ? 1e-9 : GIVEN_BACK),
              "%s, %s%s: albedo %.5f +- %.5f", t->own->model->name, view, wi.z < 0 ? ", inside" : "", mean, error);
    aspi_find(t, !(mean >= 0), 0, "%s, %s: albedo %.9g", t->own->model->name, view, mean);
}

static void furnace_own(aspi_trial *t)
{
    enum { AROUND = 48 };
    static const double slant[4] = { 0.8, 1.3, 1.5, 1.55 };
    aspi_traits is = aspi_traits_of(t->own);
    if (is.grooves && t->skewed)
        return;
    /* beside the views all around: tables err between their columns */
    for (size_t i = 0; i < t->view_count + AROUND; i++) {
        size_t k = i - t->view_count;
        int known = i < t->view_count;
        char name[64];
        asp_vec3 w = known ? t->views[i].w : aspi_direction(slant[k % 4], 2 * ASPI_PI * ((double)(k / 4) + 0.19) / 12);
        asp_vec3 below = { -w.x, -w.y, -w.z };
        size_t n = t->samples / (known ? 2 : 8);
        if (known)
            snprintf(name, sizeof name, "%s", t->views[i].name);
        else
            snprintf(name, sizeof name, "wi (%.4f, %.4f, %.4f)", w.x, w.y, w.z);
        furnace_by_samples(t, w, name, n);
        if (is.crosses)
            furnace_by_samples(t, below, name, n);
        if (aspi_tick(t, (double)i / (double)(t->view_count + AROUND)))
            return;
    }
}

void aspi_law_furnace(aspi_trial *t)
{
    size_t i;
    int kind;
    const char *name;
    if (t->own && !aspi_traits_of(t->own).mirrors) {
        furnace_own(t);
        return;
    }
    for (i = 0; i < t->view_count; i++)
        for (kind = aspi_first(t, 0); kind < aspi_end(t, MIRRORS); kind++) {
            const asp_material *mat = aspi_material(t, kind, &name);
            double doubt, albedo;
            /* grooves are those of a level surface: on a skewed one they return up to twice what
             * came. Their kinks near the horizon are too fine for the cubature */
            if (aspi_traits_of(mat).grooves && (t->skewed || t->views[i].w.z < 1e-4))
                continue;
            albedo = aspi_albedo(mat, t->views[i].w, 1e-6, &doubt);
            aspi_find(t, fmax(0, albedo - 1), 1e-7 + fmin(doubt, 1e-4)
                      + 2 * t->ndf->model->area_error, "%s, %s: albedo %.9g", name,
                      t->views[i].name, albedo);
            aspi_find(t, !(albedo >= 0), 0, "%s, %s: albedo %.9g", name, t->views[i].name, albedo);
            if (aspi_tick(t, t->own ? (double)i / (double)t->view_count
                                    : (double)(i * MIRRORS + (size_t)kind) / (double)(t->view_count * MIRRORS)))
                return;
        }
}

void aspi_law_weight(aspi_trial *t)
{
    int kind, i;
    const char *name;
    for (kind = aspi_first(t, 0); kind < aspi_end(t, ASPI_ONE_SIDED); kind++) {
        const asp_material *mat = aspi_material(t, kind, &name);
        aspi_traits is = aspi_traits_of(mat);
        for (i = 0; i < trials(t, mat, 400) && !is.crosses; i++) {
            const aspi_view *v = &t->views[(size_t)i % t->view_count];
            asp_bsdf_sample s = asp_sample(mat, v->w, aspi_uniform(t), aspi_uniform(t));
            asp_rgb f = asp_eval_cos(mat, v->w, s.wo), again = asp_eval(mat, v->w, s.wo), w;
            double pdf = asp_pdf(mat, v->w, s.wo), size, apart, scale, steps;
            asp_vec3 h = aspi_unit(v->w.x + s.wo.x, v->w.y + s.wo.y, v->w.z + s.wo.z);
            double norm = s.wo.x * s.wo.x + s.wo.y * s.wo.y + s.wo.z * s.wo.z;
            if (!(asp_sigma(t->ndf, v->w) > 1e-150)) /* nothing can be seen from there */
                continue;
            aspi_find(t, fabs(norm - 1), 1e-14, "%s, %s: wo is not a unit vector", name, v->name);
            aspi_find(t, !(s.pdf >= 0) || !(aspi_largest(s.weight) >= 0), 0,
                      "%s, %s: pdf %g, weight %g", name, v->name, s.pdf, aspi_largest(s.weight));
            if (s.wo.z <= 0) {
                aspi_find(t, aspi_largest(s.weight), 0, "%s, %s: weight below the horizon", name,
                          v->name);
                continue;
            }
            if (is.mirrors && !is.grooves) /* grooves know nothing of this distribution */
                aspi_find(t, aspi_largest(s.weight) - 1, 1e-9, "%s, %s: weight above 1", name, v->name);
            /* wo carries the facet in its last digits: the half vector of wi and wo is known to
             * eps over |wi + wo|, its slope to that over h.z^2, and D moves with slope/roughness */
            apart = hypot(hypot(v->w.x + s.wo.x, v->w.y + s.wo.y), v->w.z + s.wo.z);
            size = fabs(t->ndf->i00) + fabs(t->ndf->i01) + fabs(t->ndf->i10) + fabs(t->ndf->i11);
            scale = hypot(h.x, h.y) / h.z + hypot(t->ndf->map.tx, t->ndf->map.ty) + 1e-3;
            steps = 2e-15 / apart / h.z * (1 / h.z + size * scale / t->scale * 40 + 1 / s.wo.z);
            if (steps > 1e-3 || pdf < 1e-200)
                continue;
            w = s.weight;
            w.r *= s.pdf; w.g *= s.pdf; w.b *= s.pdf;
            aspi_find(t, difference(w, f) / fmax(aspi_largest(f), 1e-200), 1e-11 + steps,
                      "%s, %s, wo (%.6g, %.6g, %.6g): weight pdf %.15g, f cos %.15g", name,
                      v->name, s.wo.x, s.wo.y, s.wo.z, w.r, f.r);
            aspi_find(t, fabs(s.pdf - pdf) / pdf, 1e-11 + steps,
                      "%s, %s, wo (%.6g, %.6g, %.6g): pdf of the sample %.15g, asp_pdf %.15g",
                      name, v->name, s.wo.x, s.wo.y, s.wo.z, s.pdf, pdf);
            again.r *= s.wo.z; again.g *= s.wo.z; again.b *= s.wo.z;
            aspi_find(t, difference(again, f) / fmax(aspi_largest(f), 1e-200), 1e-14,
                      "%s, %s: eval cos against eval_cos", name, v->name);
        }
    }
}
