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
    double eta;                /* where light crosses: index of the other side over that of wi; else 0 */
    int crossing, thin;        /* look at what crosses; a sheet */
    size_t samples;
} sampling;

/* As seen from the side of wi: turned by a point reflection, or for a sheet mirrored. */
static asp_vec3 turned(const sampling *s, asp_vec3 w)
{
    double sign = s->eta > 0 && s->view->w.z < 0 ? -1 : 1, across = s->thin ? 1 : sign;
    asp_vec3 out = { across * w.x, across * w.y, sign * w.z };
    return out;
}

/* The facet that joins the view and wo, or a vertical one, which falls into the open cell, where it does
 * not do what is looked at. */
static asp_vec3 facet_of(const sampling *s, asp_vec3 wo)
{
    static const asp_vec3 none = { 1, 0, 0 };
    asp_vec3 v = s->view->w, w = wo, m;
    int across = 0;
    double n = 1;
    if (s->eta > 0) {
        v = turned(s, v);
        w = turned(s, w);
        across = w.z < 0;
        if (across != s->crossing)
            return none;
        w.z = s->thin ? fabs(w.z) : w.z;
        n = across && !s->thin ? s->eta : 1;
    }
    m = aspi_unit(v.x + n * w.x, v.y + n * w.y, v.z + n * w.z);
    if (!across || s->thin)
        return m;
    if (aspi_dot(v, m) < 0)
        m.x = -m.x, m.y = -m.y, m.z = -m.z;
    return aspi_dot(w, m) < 0 ? m : none;
}

/* Where the facet m sends the view's light, and the solid angle there per one of facets; 0: nowhere. */
static double sent_by(const sampling *s, asp_vec3 m, asp_vec3 *wo)
{
    asp_vec3 v = s->eta > 0 ? turned(s, s->view->w) : s->view->w;
    double c = aspi_dot(v, m), along = 2 * c, by = 1, solid = 4 * c;
    if (c <= 0)
        return 0;
    if (s->crossing && !s->thin) {
        double g2 = 1 - (1 - c * c) / (s->eta * s->eta), g = sqrt(fmax(g2, 0)), over = c - s->eta * g;
        if (g2 <= 0)
            return 0;
        along = c / s->eta - g;
        by = 1 / s->eta;
        solid = over * over / (s->eta * s->eta * g);
    }
    wo->x = along * m.x - by * v.x;
    wo->y = along * m.y - by * v.y;
    wo->z = along * m.z - by * v.z;
    if (s->eta > 0) {
        if (s->crossing && !s->thin ? wo->z >= 0 : wo->z <= 0)
            return 0;
        wo->z = s->crossing && s->thin ? -wo->z : wo->z;
        *wo = turned(s, *wo);
    }
    return solid;
}

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
            asp_vec3 wo = { b->mx[i], b->my[i], b->mz[i] }, facet = facet_of(s, wo);
            int lost = s->eta > 0 && b->pdf[i] <= 0;
            b->mx[i] = lost ? 1 : facet.x;
            b->my[i] = lost ? 0 : facet.y;
            b->mz[i] = lost ? 0 : facet.z;
        }
    }
}

/* The density that the library states for facet m, and eval's for the weights. */
static void stated(const void *context, asp_vec3 m, double *density, double *value)
{
    const sampling *s = (const sampling *)context;
    double solid;
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
    solid = sent_by(s, m, &wo);
    *density = 0;
    if (solid <= 0)
        return;
    if (s->horizon_only) {
        /* a point of the rule on a cell that the horizon cuts must not fall to either side of it
         * by rounding: eval is 0 there and continuous */
        *value = solid * asp_eval_cos(s->mat, wi, wo).r;
        *density = *value;
    } else
        *density = solid * asp_pdf(s->mat, wi, wo);
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
    double *radii = (double *)malloc(PILOT * sizeof *radii), p = 0, phi, largest = 0, mean = 0;
    size_t done, i, known = 0;
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
            known += radii[done + i] <= farthest(s);
            largest = fmax(largest, b->red[i]);
            mean += b->red[i] / PILOT;
        }
    }
    /* seen from far below the mean plane next to nothing is sent back, eval is integrated to a share of 1; under
     * total reflection too few cross to lay cells by */
    if ((s->horizon_only && largest < LEAST_WEIGHT) || (s->eta > 0 && known < PILOT / 20)) {
        p = 1;
        goto out;
    }
    aspi_histogram_edges(h, radii, PILOT, s->view ? standard_azimuth(s->ndf, turned(s, s->view->w)) : 0.1,
                         farthest(s));
    if (s->horizon_only)
        h->typical = fmin(30 * mean, 1);         /* a cell's sum of some hundred spreads by ten weights or more */
    if (t->planar)
        aspi_histogram_blocks(h, &t->lattice);
    aspi_histogram_integrate(h, t, stated, s);
    for (done = 0; done < s->samples; done += BLOCK) {
        size_t n = s->samples - done < BLOCK ? s->samples - done : BLOCK;
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
    p = s->horizon_only ? aspi_histogram_weight_p(h, (double)s->samples)
                        : aspi_histogram_count_p(h, (double)s->samples);
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
    s.samples = t->samples;
    p = test_stream(t, &s, "normals");
    aspi_find(t, aspi_sidak(p, 1), ALLOWED, "p = %.3g of %zu samples", p, t->samples);
}

void aspi_law_sample_visible(aspi_trial *t)
{
    aspi_view below[2];
    size_t tests = t->view_count + 2, i;
    sampling s = { 0 };
    s.ndf = t->ndf;
    s.samples = t->samples;
    /* the library also samples for views below the horizon, of which sigma > 0 remains */
    below[0].w = aspi_direction(0.5 * ASPI_PI + atan(0.5 * t->scale * sqrt(t->det)), 0.3);
    below[0].name = "below the horizon";
    below[1].w = aspi_direction(0.5 * ASPI_PI, 2.0);
    below[1].w.z = 0;
    below[1].name = "in the horizon";
    for (i = 0; i < tests; i++) {
        double p;
        s.view = i < t->view_count ? &t->views[i] : &below[i - t->view_count];
        if (!aspi_taken(t, i) || !(asp_sigma(t->ndf, s.view->w) > 1e-150)) /* or no facet to be seen */
            continue;
        p = test_stream(t, &s, s.view->name);
        aspi_find(t, aspi_sidak(p, tests), ALLOWED, "%s, p = %.3g of %zu samples", s.view->name, p,
                  t->samples);
        if (aspi_tick(t, (double)(i + 1) / (double)tests))
            return;
    }
}

/* Mirror and mixture, from everywhere. The mixture's diffuse lobe becomes a
 * thread in the standard slopes of a map that is much narrower one way than the other, too fine for
 * cells: there the mirror is tried alone. */
static void each_material(aspi_trial *t, int weights)
{
    static const int kinds[2] = { ASPI_MIRROR, ASPI_MIXTURE };
    asp_roughness five = asp_map_to_roughness(&t->ndf->map);
    size_t i, tests = 2 * t->view_count;
    size_t stride = 1;
    int k, wide = five.alpha_x < 50 * five.alpha_y, count = wide && !t->own ? 2 : 1;
    if (t->own) {
        aspi_traits is = aspi_traits_of(t->own);
        tests = t->view_count;
        stride = is.quadrature && weights ? 4 : 1;  /* a cell's integral is one of integrals */
        if (is.crosses || (is.mixed && !wide))  /* what light crosses has a law of its own */
            return;
    }
    for (k = 0; k < count; k++)
        for (i = 0; i < t->view_count; i += stride) {
            const char *name;
            sampling s = { 0 };
            double p;
            if (!aspi_taken(t, i + (size_t)k + (size_t)weights) || !(asp_sigma(t->ndf, t->views[i].w) > 1e-150))
                continue;           /* or no facet to be seen */
            s.ndf = t->ndf;
            s.samples = t->samples;
            s.mat = aspi_material(t, t->own ? ASPI_OWN : kinds[k], &name);
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

/* The other samplers, from one view each: a lobe and, where there is one, the light that crosses. */
void aspi_law_sample_materials(aspi_trial *t)
{
    static const struct { int kind, below, crossing; } cases[] = {
        { ASPI_PLASTIC, 0, 0 }, { ASPI_DIELECTRIC, 0, 1 }, { ASPI_DIELECTRIC, 1, 0 },
        { ASPI_COMPENSATED, 0, 0 }, { ASPI_SHEET, 0, 0 }, { ASPI_DIELECTRIC, 1, 1 },
        { ASPI_COMPENSATED_DIELECTRIC, 0, 0 }, { ASPI_COMPENSATED_DIELECTRIC, 0, 1 }, { ASPI_SHEET, 1, 1 },
        { ASPI_COMPENSATED_DIELECTRIC, 1, 0 }, { ASPI_COMPENSATED_DIELECTRIC, 1, 1 }, { ASPI_FILM, 0, 0 }, { ASPI_DIELECTRIC, 0, 0 },
        { ASPI_FILM_GLASS, 0, 1 }, { ASPI_FILM_GLASS, 1, 0 }
    };
    enum { CASES = sizeof cases / sizeof *cases };
    asp_roughness five = asp_map_to_roughness(&t->ndf->map);
    int count = t->own ? 4 * (int)t->view_count : CASES;
    if (t->own && !aspi_traits_of(t->own).crosses)
        return;
    for (int i = 0; i < count; i++)
        for (int weights = 0; weights < 2; weights++) {
            /* the caller's: from every view, on either side */
            int kind = t->own ? ASPI_OWN : cases[i].kind;
            int below = t->own ? i & 1 : cases[i].below, crossing = t->own ? i >> 1 & 1 : cases[i].crossing;
            aspi_view view = t->views[t->own ? (size_t)i / 4 : (size_t)(5 * i + 1) % t->view_count];
            sampling s = { 0 };
            const char *name;
            aspi_traits is;
            double p;
            s.mat = aspi_material(t, kind, &name);
            is = aspi_traits_of(s.mat);
            if (!aspi_taken(t, (size_t)(i + weights)) || !(asp_sigma(t->ndf, view.w) > 1e-150)
                || (is.mixed && five.alpha_x >= 50 * five.alpha_y))
                continue;
            s.ndf = t->ndf;
            s.view = &view;
            s.horizon_only = weights;
            s.samples = t->sparse ? t->samples / 2 : t->samples;     /* most are drawn one by one */
            s.thin = is.thin;
            s.crossing = crossing;
            s.eta = !is.crosses ? 0 : below && !s.thin ? 1 / s.mat->c.r : s.mat->c.r;
            if (below) {
                view.w.z = -view.w.z;
                view.w.x = s.thin ? view.w.x : -view.w.x;
                view.w.y = s.thin ? view.w.y : -view.w.y;
            }
            p = test_stream(t, &s, name);
            aspi_find(t, aspi_sidak(p, 2 * (size_t)count), ALLOWED, "%s%s%s, %s, %s, p = %.3g of %zu samples", name,
                      below ? " from inside" : "", crossing ? " across" : "", view.name,
                      weights ? "weights" : "counts", p, s.samples);
            if (aspi_tick(t, (double)(i + 1) / count))
                return;
        }
}

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
