/* law_samplers.c - samplers against densities, cell by cell
 *
 * A sample falls into a cell of the standard slope plane (statistics.c), whose expected share is the
 * integral of the density that the library states. A wrong eval could hide behind a right pdf; the
 * weights are summed in the same cells and compared with the integral of eval. The p-values of all
 * tests of a law are corrected for their number; a law allows 1e-6, so that trying a hundred
 * distributions raises a false alarm once in a few thousand runs. */
#include "laws/laws.h"

#include <math.h>
#include <stdlib.h>

#define ALLOWED 6.0 /* -log10 p */
#define PILOT 4096
#define LEAST_WEIGHT 1e-9
#define BLOCK 512

typedef struct sampling {
    const asp_ndf *ndf;
    const asp_material *mat;   /* of directions; NULL: of normals */
    const aspi_view *view;     /* NULL: all normals */
    int horizon_only;          /* weights are compared, not counts */
} sampling;

/* ------------------------------------------------------------------ one sampler as a stream */

typedef struct block {
    double wx[BLOCK], wy[BLOCK], wz[BLOCK], u1[BLOCK], u2[BLOCK], pdf[BLOCK];
    double mx[BLOCK], my[BLOCK], mz[BLOCK], red[BLOCK], green[BLOCK], blue[BLOCK];
} block;

static void draw(aspi_trial *t, const sampling *s, size_t n, block *b)
{
    asp_cvec3s wi;
    asp_vec3s m;
    asp_rgbs weight;
    size_t i;
    wi.x = b->wx; wi.y = b->wy; wi.z = b->wz;
    m.x = b->mx; m.y = b->my; m.z = b->mz;
    weight.r = b->red; weight.g = b->green; weight.b = b->blue;
    for (i = 0; i < n; i++) {
        b->u1[i] = aspi_uniform(t);
        b->u2[i] = aspi_uniform(t);
        b->wx[i] = s->view ? s->view->w.x : 0;
        b->wy[i] = s->view ? s->view->w.y : 0;
        b->wz[i] = s->view ? s->view->w.z : 1;
        b->red[i] = 0;
    }
    if (!s->view)
        asp_sample_normal_n(s->ndf, n, b->u1, b->u2, m);
    else if (!s->mat)
        asp_sample_visible_n(s->ndf, n, wi, b->u1, b->u2, m);
    else {
        asp_sample_n(s->mat, n, wi, b->u1, b->u2, m, b->pdf, weight);
        for (i = 0; i < n; i++) { /* directions to the facets that sent them */
            double x = b->wx[i] + b->mx[i], y = b->wy[i] + b->my[i], z = b->wz[i] + b->mz[i];
            double size = sqrt(x * x + y * y + z * z);
            b->mx[i] = x / size;
            b->my[i] = y / size;
            b->mz[i] = z / size;
        }
    }
}

/* The density that the library states for facet m, and eval's for the weights. */
static void stated(const void *context, asp_vec3 m, double *density, double *value)
{
    const sampling *s = (const sampling *)context;
    double c;
    asp_vec3 wo, wi;
    *value = 0;
    if (!s->view) {
        *density = asp_pdf_normal(s->ndf, m);
        return;
    }
    wi = s->view->w;
    if (!s->mat) {
        *density = asp_pdf_visible(s->ndf, wi, m);
        return;
    }
    c = aspi_dot(wi, m);
    *density = 0;
    if (c <= 0)
        return;
    wo.x = 2 * c * m.x - wi.x;
    wo.y = 2 * c * m.y - wi.y;
    wo.z = 2 * c * m.z - wi.z;
    if (s->horizon_only) {
        /* a point of the rule on a cell that the horizon cuts must not fall to either side of it
         * by rounding: eval is 0 there and continuous */
        *value = 4 * c * asp_eval_cos(s->mat, wi, wo).r;
        *density = *value;
    } else
        *density = 4 * c * asp_pdf(s->mat, wi, wo);
}

/* Azimuth of the view in the standard slope plane: the visible density ends on a line across it. */
static double standard_azimuth(const asp_ndf *k, asp_vec3 w)
{
    return atan2(k->map.m01 * w.x + k->map.m11 * w.y, k->map.m00 * w.x + k->map.m10 * w.y);
}

/* A direction carries its facet in the last digits of wi + wo: the facet's height is known to 1e-16, a
 * slope of 1e10 to 1e-6. Student's t with gamma = 1.501 has nine of ten visible facets beyond a slope of
 * 1e16, where the direction is that of a vertical wall; the open cell takes them all. */
#define STEEPEST_KNOWN 1e10

static double farthest(const sampling *s)
{
    const asp_map *m = &s->ndf->map;
    double size = sqrt(m->m00 * m->m00 + m->m01 * m->m01 + m->m10 * m->m10 + m->m11 * m->m11);
    return s->mat ? STEEPEST_KNOWN / size : 1e60;
}

/* Returns p. */
static double test_stream(aspi_trial *t, const sampling *s, const char *name)
{
    aspi_histogram *h = (aspi_histogram *)malloc(sizeof *h);
    block *b = (block *)malloc(sizeof *b);
    double *radii = (double *)malloc(PILOT * sizeof *radii), p = 0, phi, largest = 0;
    size_t done, i;
    if (!h || !b || !radii) {
        t->no_memory = 1;
        goto out;
    }
    for (done = 0; done < PILOT; done += BLOCK) {
        draw(t, s, BLOCK, b);
        for (i = 0; i < BLOCK; i++) {
            asp_vec3 m;
            m.x = b->mx[i]; m.y = b->my[i]; m.z = b->mz[i];
            aspi_standard_polar(s->ndf, m, &radii[done + i], &phi);
            if (!(radii[done + i] == radii[done + i]))
                radii[done + i] = INFINITY;
            largest = fmax(largest, b->red[i]);
        }
    }
    /* seen from far below the mean plane next to nothing is sent back; eval is integrated to a share of 1 */
    if (s->horizon_only && largest < LEAST_WEIGHT) {
        p = 1;
        goto out;
    }
    aspi_histogram_edges(h, radii, PILOT, s->view ? standard_azimuth(s->ndf, s->view->w) : 0.1, farthest(s));
    if (t->planar)
        aspi_histogram_blocks(h, &t->lattice);
    aspi_histogram_integrate(h, t, stated, s);
    for (done = 0; done < t->samples; done += BLOCK) {
        size_t n = t->samples - done < BLOCK ? t->samples - done : BLOCK;
        draw(t, s, n, b);
        for (i = 0; i < n; i++) {
            asp_vec3 m;
            double size;
            m.x = b->mx[i]; m.y = b->my[i]; m.z = b->mz[i];
            size = m.x * m.x + m.y * m.y + m.z * m.z;
            if (!(fabs(size - 1) < 1e-14) || (!s->mat && m.z < 0)) {
                aspi_find(t, INFINITY, 0, "%s: sample (%g, %g, %g) is no facet", name, m.x, m.y,
                          m.z);
                goto out;
            }
            aspi_histogram_add(h, s->ndf, m, b->red[i]);
        }
        if (done / BLOCK % 64 == 0 && aspi_tick(t, 0))
            break;
    }
    p = s->horizon_only ? aspi_histogram_weight_p(h, (double)t->samples)
                        : aspi_histogram_count_p(h, (double)t->samples);
out:
    free(h);
    free(b);
    free(radii);
    return p;
}

/* ------------------------------------------------------------------ the laws */

void aspi_law_sample_normal(aspi_trial *t)
{
    sampling s = { 0 };
    double p;
    s.ndf = t->ndf;
    p = test_stream(t, &s, "normals");
    aspi_find(t, aspi_sidak(p, 1), ALLOWED, "p = %.3g of %zu samples", p, t->samples);
}

void aspi_law_sample_visible(aspi_trial *t)
{
    aspi_view below[2];
    size_t tests = t->view_count + 2, i;
    sampling s = { 0 };
    s.ndf = t->ndf;
    /* the library also samples for views below the horizon, of which sigma > 0 remains */
    below[0].w = aspi_direction(0.5 * ASPI_PI + atan(0.5 * t->scale * sqrt(t->det)), 0.3);
    below[0].name = "below the horizon";
    below[1].w = aspi_direction(0.5 * ASPI_PI, 2.0);
    below[1].w.z = 0;
    below[1].name = "in the horizon";
    for (i = 0; i < tests; i++) {
        double p;
        s.view = i < t->view_count ? &t->views[i] : &below[i - t->view_count];
        if (!(asp_sigma(t->ndf, s.view->w) > 1e-150)) /* no facet to be seen */
            continue;
        p = test_stream(t, &s, s.view->name);
        aspi_find(t, aspi_sidak(p, tests), ALLOWED, "%s, p = %.3g of %zu samples", s.view->name, p,
                  t->samples);
        if (aspi_tick(t, (double)(i + 1) / (double)tests))
            return;
    }
}

/* Mirror and mixture; the other materials share their samplers. The mixture's diffuse lobe becomes a
 * thread in the standard slopes of a map that is much narrower one way than the other, too fine for
 * cells: there the mirror is tried alone. */
static void each_material(aspi_trial *t, int weights)
{
    static const int kinds[2] = { 0, ASPI_MATERIALS - 1 };
    asp_roughness five = asp_map_to_roughness(&t->ndf->map);
    size_t i, tests = 2 * t->view_count;
    int k, count = five.alpha_x < 50 * five.alpha_y ? 2 : 1;
    for (k = 0; k < count; k++)
        for (i = 0; i < t->view_count; i++) {
            const char *name;
            asp_material mat = aspi_material(t->ndf, kinds[k], &name);
            sampling s;
            double p;
            if (!(asp_sigma(t->ndf, t->views[i].w) > 1e-150)) /* no facet to be seen */
                continue;
            s.ndf = t->ndf;
            s.mat = &mat;
            s.view = &t->views[i];
            s.horizon_only = weights;
            p = test_stream(t, &s, s.view->name);
            aspi_find(t, aspi_sidak(p, tests), ALLOWED, "%s, %s, p = %.3g of %zu samples", name,
                      s.view->name, p, t->samples);
            if (aspi_tick(t, (double)((size_t)k * t->view_count + i + 1) / (double)tests))
                return;
        }
}

void aspi_law_sample_bsdf(aspi_trial *t) { each_material(t, 0); }

void aspi_law_weight_histogram(aspi_trial *t) { each_material(t, 1); }

/* ------------------------------------------------------------------ continuity */

typedef struct path {
    int sampler;              /* 0 normal, 1 visible */
    int axis;                 /* which number runs */
    double other;
    asp_vec3 w;
} path;

static asp_vec3 along(const aspi_trial *t, const path *p, double u)
{
    double u1 = p->axis ? p->other : u, u2 = p->axis ? u : p->other;
    return p->sampler ? asp_sample_visible(t->ndf, p->w, u1, u2)
                      : asp_sample_normal(t->ndf, u1, u2);
}

static double step_size(asp_vec3 a, asp_vec3 b)
{
    return hypot(hypot(a.x - b.x, a.y - b.y), a.z - b.z);
}

/* The largest step on a grid of the unit interval is halved until it is 2^-53 wide: a jump stays, a
 * steep place goes. The ends, where slopes run off to infinity, are left out. */
static double worst_jump(const aspi_trial *t, const path *p, double *at)
{
    enum { GRID = 512, HALVINGS = 44 };
    double lo = 0, hi = 0, worst = -1;
    asp_vec3 last = along(t, p, 0.002), a, b;
    int i;
    for (i = 1; i <= GRID; i++) {
        double u = 0.002 + 0.99 * i / GRID;
        asp_vec3 next = along(t, p, u);
        double d = step_size(last, next);
        if (d > worst)
            worst = d, lo = 0.002 + 0.99 * (i - 1) / GRID, hi = u;
        last = next;
    }
    a = along(t, p, lo);
    b = along(t, p, hi);
    for (i = 0; i < HALVINGS; i++) {
        double mid = 0.5 * (lo + hi);
        asp_vec3 c = along(t, p, mid);
        if (step_size(a, c) > step_size(c, b))
            hi = mid, b = c;
        else
            lo = mid, a = c;
    }
    *at = lo;
    return step_size(a, b);
}

void aspi_law_continuity(aspi_trial *t)
{
    static const char *const axis_name[2] = { "u1", "u2" };
    int i;
    if (t->planar) /* no map of the square follows a density that jumps without jumping itself */
        return;
    for (i = 0; i < 24; i++) {
        path p;
        const aspi_view *v = &t->views[(size_t)(i / 4) % t->view_count];
        double jump, at;
        if (!(asp_sigma(t->ndf, v->w) > 1e-150))
            continue;
        p.sampler = i % 4 > 1;
        p.axis = i % 2;
        p.other = 0.05 + 0.9 * aspi_uniform(t);
        p.w = v->w;
        jump = worst_jump(t, &p, &at);
        aspi_find(t, jump, 1e-6, "%s, along %s at %.9g, the other %.6g",
                  p.sampler ? v->name : "normals", axis_name[p.axis], at, p.other);
    }
}
