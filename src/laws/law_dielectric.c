/* law_dielectric.c - laws of refraction over the distribution: both sides, both transports */
#include "laws/laws.h"

#include <math.h>
#include <stdio.h>

/* Index, thin sheet or not; each tried with both transports. */
static const struct { double eta; int thin; const char *name; } cases[] = {
    { 1.5, 0, "dielectric 1.5" }, { 0.6, 0, "dielectric 0.6" }, { 1.5, 1, "sheet 1.5" }
};
#define CASES (sizeof cases / sizeof *cases)

static asp_vec3 flip(asp_vec3 w)
{
    return (asp_vec3){ -w.x, -w.y, -w.z };
}

static asp_material make(const aspi_trial *t, size_t i, int transport, int mask)
{
    asp_material mat = asp_dielectric(t->ndf, cases[i].eta, cases[i].thin, transport, mask);
    return mat;
}

double aspi_refracted_steps(const aspi_trial *t, asp_vec3 wi, asp_vec3 wo, double n, double more)
{
    double k = wi.z * wo.z > 0 ? 1 : n;
    double apart = hypot(hypot(wi.x + k * wo.x, wi.y + k * wo.y), wi.z + k * wo.z);
    double mz = fmax(fabs(wi.z + k * wo.z) / apart, 1e-12);
    double size = fabs(t->ndf->i00) + fabs(t->ndf->i01) + fabs(t->ndf->i10) + fabs(t->ndf->i11);
    double slope = 1 / mz + hypot(t->ndf->map.tx, t->ndf->map.ty);
    return 3e-15 * (1 + n) / apart / mz
         * (1 / mz + size * slope / t->scale * 40 + 1 / fabs(wo.z) + 1 / fabs(wi.z) + more);
}

void aspi_law_refraction(aspi_trial *t)
{
    if (t->own && !aspi_traits_of(t->own).crosses)
        return;
    for (size_t i = 0; i < (t->own ? 1 : CASES); i++)
        for (int k = 0; k < 300; k++) {
            const char *name = cases[i].name;
            asp_material rad = t->own ? *aspi_material(t, ASPI_OWN, &name)
                                      : make(t, i, ASP_RADIANCE, k % 3 == 2 ? ASP_MASK_UNCORRELATED : 0);
            aspi_traits is = aspi_traits_of(&rad);
            const aspi_view *v = &t->views[(size_t)k % t->view_count];
            asp_vec3 wi = k & 1 ? flip(v->w) : v->w;
            asp_bsdf_sample s = asp_sample_lobe(&rad, wi, aspi_uniform(t), aspi_uniform(t), aspi_uniform(t));
            double pdf = asp_pdf(&rad, wi, s.wo), n = is.eta, weight = aspi_average(s.weight), steps, side, a;
            if (!(weight > 1e-100) || pdf < 1e-200)      /* products of two such numbers are lost */
                continue;
            steps = aspi_refracted_steps(t, wi, s.wo, wi.z < 0 ? 1 / n : n, 0);
            if (steps > 1e-3)
                continue;
            a = aspi_average(asp_eval_cos(&rad, wi, s.wo));
            aspi_find(t, fabs(weight * s.pdf - a) / fmax(a, 1e-200), 1e-11 + steps,
                      "%s, %s: weight pdf %.15g, f cos %.15g", name, v->name, weight * s.pdf, a);
            aspi_find(t, fabs(s.pdf - pdf) / pdf, 1e-11 + steps, "%s, %s: density", name, v->name);
            if (is.mixed || is.grooves) /* grooves know nothing of this distribution */
                continue;
            side = wi.z * s.wo.z > 0 || rad.transport == ASP_IMPORTANCE ? 1 : wi.z > 0 ? is.eta : 1 / is.eta;
            /* what one facet sends is at most all, in importance */
            aspi_find(t, weight * (side * side) - 1, 1e-9 + t->ndf->model->area_error,
                      "%s, %s: weight above 1", name, v->name);
        }
}

static void straight(aspi_trial *t, const asp_bsdf_sample *s, asp_vec3 w, double allowed, const char *what, const char *view)
{
    aspi_find(t, fabs(s->wo.x + w.x) + fabs(s->wo.y + w.y) + fabs(s->wo.z + w.z) + fabs(s->weight.r - 1), allowed,
              "%s, %s: bent or dimmed", what, view);
}

/* eta = 1 is not there (eta near 1 hardly: `limits`). For single scattering that is a case of its own, which reflects
 * nothing anywhere; walks meet facet after facet and pass. */
void aspi_law_no_boundary(aspi_trial *t)
{
    asp_material none = asp_dielectric(t->ndf, 1, 0, ASP_RADIANCE, ASP_MASK_WALL);
    asp_material sheet = asp_dielectric(t->ndf, 1, 1, ASP_RADIANCE, 0);
    for (size_t i = 0; i < t->view_count; i++)
        for (int k = 0; k < 40; k++) {
            asp_vec3 w = k & 1 ? flip(t->views[i].w) : t->views[i].w, wo = aspi_random_direction(t);
            asp_bsdf_sample s = asp_sample_lobe(&none, w, aspi_uniform(t), aspi_uniform(t), aspi_uniform(t));
            straight(t, &s, w, 0, "sample", t->views[i].name);
            s = asp_sample_lobe(&sheet, w, aspi_uniform(t), aspi_uniform(t), aspi_uniform(t));
            straight(t, &s, w, 0, "sheet", t->views[i].name);
            aspi_find(t, asp_eval_cos(&none, w, wo).r + asp_eval_cos(&sheet, w, wo).r + asp_pdf(&none, w, wo), 0,
                      "%s: something is scattered", t->views[i].name);
            /* a walk along the surface crosses as many facets as it is long */
            if (k < 10 && t->views[i].w.z > 0.1 * fmax(1, asp_sigma(t->ndf, t->views[i].w))) {
                s = asp_walk_sample(&none, w, aspi_next, t);
                straight(t, &s, w, 1e-12, "walk", t->views[i].name);
            }
        }
}
