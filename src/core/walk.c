/* walk.c - multiple scattering: a random walk over the microsurface, asperity.h section 12
 *
 * Heitz, Hanika, d'Eon, Dachsbacher 2016; flights and heights are in walker.h.
 *
 * Read three times like facets.c. */
#ifndef ASP_PRECISION
#include "bsdf/bsdf.h"

#define ASP_PRECISION 64
#include "walk.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "walk.c"
#undef ASP_PRECISION

#else
#include "core/blocks.h"
#include "bsdf/bsdf_number.h"
#include "bsdf/facet_fresnel.h"
#include "bsdf/reflection.h"
#include "bsdf/refraction.h"
#include "core/walker.h"

#ifndef ASPI_WALK_NAMES
#define ASPI_WALK_NAMES
#define fresnel_of ASP_NAME(walk_fresnel)
#define visible_normal ASP_NAME(visible_normal)
#define draw_eval ASP_NAME(walk_draw_eval)
#define draw_sample ASP_NAME(walk_draw_sample)
#define wall_normal ASP_NAME(wall_normal)
#define next_normal ASP_NAME(next_normal)
#define scatter ASP_NAME(scatter)
#define tint ASP_NAME(walk_tint)
#define by_reflection ASP_NAME(by_reflection)
#define by_refraction ASP_NAME(by_refraction)
#define by_walls ASP_NAME(by_walls)
#define add_product ASP_NAME(add_product)
#define connect ASP_NAME(connect)
#define facet_sends ASP_NAME(facet_sends)
#define by_wall ASP_NAME(by_wall)
#define crossing ASP_NAME(crossing)
#define draw_eval_as ASP_NAME(walk_draw_eval_as)
#define fly_one ASP_NAME(walk_fly_one)
#define mirror_eval ASP_NAME(mirror_eval)
#endif

/* The Fresnel term at the squared cosine c2 times by/over, 0 where c2 is negative and by 0. Apart, where the compiler
 * makes one vector of three channels. */
ASP_CLONES_SINGLE static void fresnel_of(const asp_mat *mat, asp_real c2, asp_real by, asp_real over, asp_real F[3])
{
    aspi_fresnel(mat, c2, by, over, F);
}

ASP_FN asp_v3 wall_normal(const asp_shape *k)
{
    asp_v3 m;
    m.x = k->map.tx;
    m.y = k->map.ty;
    m.z = R(0.0);
    return aspi_normalize(m);
}

ASP_FN asp_v3 visible_normal(const asp_shape *k, asp_v3 v, asp_real u1, asp_real u2)
{
    asp_real m[3];
    ASPI_OPS(k).visible(k, v.x, v.y, v.z, u1, u2, m);
    return aspi_vector(m[0], m[1], m[2]);
}

/* The facet that the ray meets, of those that face v, by two numbers; one of the walls where the first is
 * below their share. */
ASP_FN asp_v3 next_normal(const aspi_walker *r, asp_v3 v, asp_real seen)
{
    asp_real walls = aspi_walls_seen(r, v), u1 = aspi_walk_uniform(r), u2 = aspi_walk_uniform(r);
    if (walls > R(0.0)) {
        asp_real share = walls / seen;
        if (u1 < share)
            return wall_normal(&r->mat->ndf);
        u1 = aspi_min((u1 - share) / (R(1.0) - share), R(1.0) - R(0x1p-24));
    }
    return visible_normal(&r->mat->ndf, v, u1, u2);
}

ASP_FN void tint(aspi_walker *r, asp_c3 by)
{
    r->carried.r *= by.r;
    r->carried.g *= by.g;
    r->carried.b *= by.b;
}

/* Leaves the facet m; the side and what is carried change. */
ASP_FN void scatter(aspi_walker *r, asp_v3 m)
{
    const asp_mat *mat = r->mat;
    asp_v3 v = aspi_facing(r->d, r->inside);
    asp_real c = aspi_dot(v, m), F[3];
    if (r->kind == ASPI_FACETS_DIFFUSE) {
        asp_real u1 = aspi_walk_uniform(r);
        r->d = aspi_around(m, aspi_cosine_lobe(m, u1, aspi_walk_uniform(r)));
        tint(r, mat->a);
        return;
    }
    if (r->kind == ASPI_FACETS_REFRACT) {
        asp_real eta = r->inside ? R(1.0) / mat->c.r : mat->c.r, mean;
        int crosses;
        aspi_reflected_shares(mat, aspi_has_film(mat), c, eta, F);
        mean = aspi_mean_share(aspi_has_film(mat), F);
        crosses = aspi_walk_uniform(r) >= mean;
        if (aspi_has_film(mat))
            tint(r, aspi_tinted(1, F, mean, crosses, R(1.0)));
        if (crosses) {
            asp_v3 t = aspi_refract(v, m, eta);
            r->d = r->inside ? aspi_negate(t) : t;
            aspi_cross_over(r);
            return;
        }
        v = aspi_reflect(v, m);
        r->d = r->inside ? aspi_negate(v) : v;
        return;
    }
    fresnel_of(mat, c * aspi_abs(c), R(1.0), R(1.0), F);
    r->carried.r *= F[0];
    r->carried.g *= F[1];
    r->carried.b *= F[2];
    r->d = aspi_reflect(v, m);
}

/* Density of the direction w (of travel, on the same side) after one reflection by facets that face v,
 * without F, times the area seen; *c is the cosine at the facet. */
ASP_FN asp_real by_reflection(const asp_shape *k, asp_v3 v, asp_v3 w, int inside, asp_real *c)
{
    asp_v3 m = aspi_half_vector(v, aspi_facing(w, !inside));
    *c = aspi_dot(v, m);
    return aspi_min(*c, m.z) <= R(0.0) ? R(0.0) : R(0.25) * aspi_density_of(k, m);
}

/* The same after refraction to the other side; eta as seen from v. From inside everything is turned
 * round, so that v faces m as outside. */
ASP_FN asp_real by_refraction(const asp_shape *k, asp_v3 v, asp_v3 w, int inside, asp_real eta, asp_real *c)
{
    asp_v3 away = inside ? aspi_negate(w) : w;
    asp_v3 m = aspi_bent_half(v, away, eta);
    asp_real wm = aspi_dot(away, m);
    *c = aspi_dot(v, m);
    if (*c <= R(0.0) || wm >= R(0.0) || m.z <= R(0.0))
        return R(0.0);
    return *c * aspi_density_of(k, m) * aspi_bent_density(*c, wm, eta);
}

/* What one meeting with facets sends of the light `by` from v to the direction w of travel, which is
 * inside where to_inside; mirrors and dielectrics. */
ASP_FN asp_c3 facet_sends(const aspi_walker *r, asp_v3 v, asp_v3 w, int to_inside, asp_real seen, asp_real by)
{
    const asp_mat *mat = r->mat;
    asp_real F[3], c, p;
    asp_c3 out;
    if (r->kind == ASPI_FACETS_REFRACT) {
        asp_real eta = r->inside ? R(1.0) / mat->c.r : mat->c.r;
        int crosses = to_inside != r->inside;
        p = crosses ? by_refraction(&mat->ndf, v, w, r->inside, eta, &c) : by_reflection(&mat->ndf, v, w, r->inside, &c);
        aspi_reflected_shares(mat, aspi_has_film(mat), c, eta, F);
        p = p * by / seen;
        out.r = (crosses ? R(1.0) - F[0] : F[0]) * p;
        out.g = (crosses ? R(1.0) - F[1] : F[1]) * p;
        out.b = (crosses ? R(1.0) - F[2] : F[2]) * p;
        return out;
    }
    p = by_reflection(&mat->ndf, v, w, 0, &c);
    fresnel_of(mat, c * aspi_abs(c), p * by, seen, F);
    out.r = F[0];
    out.g = F[1];
    out.b = F[2];
    return out;
}

ASP_FN void add_product(asp_c3 *sum, asp_c3 a, asp_c3 b)
{
    sum->r += a.r * b.r;
    sum->g += a.g * b.g;
    sum->b += a.b * b.b;
}

/* What goes to wo of the light `meets` by way of one wall, arriving there in direction d on side `inside` and
 * changed by `by` at the wall. */
ASP_FN void by_wall(const aspi_walker *r, asp_v3 v, asp_real seen, asp_v3 d, int inside, asp_c3 by,
                    const aspi_way_out *to, asp_real meets, asp_c3 *sum)
{
    asp_v3 f = aspi_facing(d, inside);
    asp_real all = aspi_area_seen(r, f), share = aspi_walls_seen(r, f) / aspi_max(all, ASP_SMALLEST);
    aspi_walker side = *r;
    asp_c3 sent;
    if (share <= R(0.0))
        return;
    side.d = d;
    if (inside != r->inside)
        aspi_cross_over(&side);
    share *= aspi_fly_surely(&side, all);
    share *= aspi_gets_out(&side, to);
    sent = facet_sends(r, v, d, inside, seen, share * meets);
    sent.r *= by.r;
    sent.g *= by.g;
    sent.b *= by.b;
    add_product(sum, r->carried, sent);
}

/* All ways to wo with one wall last: mirrored in it, and for dielectrics refracted by it. */
static void by_walls(const aspi_walker *r, asp_v3 v, asp_real seen, const aspi_way_out *to, asp_real meets, asp_c3 *sum)
{
    const asp_mat *mat = r->mat;
    asp_v3 wo = to->w, n = wall_normal(&mat->ndf), toward;
    int out = to->inside;
    asp_real c, F[3], eta;
    asp_c3 by;
    n = aspi_facing(n, !out);                 /* towards the side of wo */
    c = aspi_dot(wo, n);
    if (c <= R(0.0))
        return;
    if (r->kind != ASPI_FACETS_REFRACT) {
        fresnel_of(mat, c * aspi_abs(c), R(1.0), R(1.0), F);
        by.r = F[0];
        by.g = F[1];
        by.b = F[2];
        by_wall(r, v, seen, aspi_negate(aspi_reflect(wo, n)), out, by, to, meets, sum);
        return;
    }
    eta = out ? R(1.0) / mat->c.r : mat->c.r;
    aspi_reflected_shares(mat, aspi_has_film(mat), c, eta, F);
    by.r = F[0];
    by.g = F[1];
    by.b = F[2];
    by_wall(r, v, seen, aspi_negate(aspi_reflect(wo, n)), out, by, to, meets, sum);
    if (aspi_mean_share(aspi_has_film(mat), F) < R(1.0)) {
        asp_v3 t = aspi_refract(wo, n, eta);
        asp_real ct = aspi_abs(aspi_dot(t, n)), rarer = c / (eta * eta * aspi_max(ct, ASP_SMALLEST));
        toward = aspi_negate(t);
        /* solid angles before and after: Snell's law */
        by.r = (R(1.0) - F[0]) * rarer;
        by.g = (R(1.0) - F[1]) * rarer;
        by.b = (R(1.0) - F[2]) * rarer;
        by_wall(r, v, seen, toward, !out, by, to, meets, sum);
    }
}

/* Adds what this meeting, whose probability is `meets`, sends to wo: by the facet m if it is diffuse, else by
 * all that face v, and by those and then a wall. */
ASP_FN void connect(aspi_walker *r, asp_v3 v, asp_v3 m, asp_real seen, const aspi_way_out *to, asp_real meets,
                    asp_c3 *sum)
{
    asp_real open = aspi_gets_out(r, to) * meets;
    asp_c3 sent = r->mat->a;
    if (r->kind == ASPI_FACETS_DIFFUSE) {
        open *= aspi_max(aspi_dot(m, to->w), R(0.0)) * R(1.0 / ASP_PI);
        sent.r *= open;
        sent.g *= open;
        sent.b *= open;
        add_product(sum, r->carried, sent);
        return;
    }
    add_product(sum, r->carried, facet_sends(r, v, to->w, to->inside, seen, open));
    if (!r->level)
        by_walls(r, v, seen, to, meets, sum);
}

/* Radiance is denser inside by the square of the index; importance is not. */
ASP_FN asp_real crossing(const asp_mat *mat, asp_v3 wi, asp_v3 wo)
{
    asp_real eta = mat->c.r;
    if (mat->model->facets != ASPI_FACETS_REFRACT || wi.z * wo.z >= R(0.0)
        || mat->transport == ASP_IMPORTANCE)
        return R(1.0);
    return wi.z > R(0.0) ? R(1.0) / (eta * eta) : eta * eta;
}

ASP_FN void draw_eval_as(const asp_mat *mat, int kind, int level, asp_v3 wi, asp_v3 wo, asp_uniforms *next,
                         void *state, asp_c3 *sum)
{
    aspi_walker r = aspi_start_walk(mat, kind, level, wi, next, state);
    aspi_way_out to = aspi_leave_by(&r, wo);
    int met, diffuse = kind == ASPI_FACETS_DIFFUSE;
    for (met = 0;; met++) {
        asp_v3 v = aspi_facing(r.d, r.inside), m = v;
        asp_real seen = aspi_area_seen(&r, v), meets = aspi_fly_surely(&r, seen);
        if (meets <= R(0.0))
            break;
        if (diffuse)
            m = next_normal(&r, v, seen);
        connect(&r, v, m, seen, &to, meets, sum);
        if (meets < R(1.0) && aspi_walk_uniform(&r) >= meets)
            break;
        scatter(&r, diffuse ? m : next_normal(&r, v, seen));
        if (!aspi_survives(&r, met + 1))
            break;
    }
}

/* A flight from or to a height that is drawn, with its numbers. Apart: it is seldom. */
ASP_APART static aspi_flown fly_one(asp_uniforms *next, void *state, int drawn, asp_real l, asp_real seen,
                                    asp_real height, asp_real vz, asp_real area, asp_real out_area, asp_real out_rise)
{
    int deeper = vz > R(0.0);
    asp_real u0 = drawn ? R(0.0) : aspi_next_uniform(next, state);
    asp_real u1 = deeper || area > ASP_SMALLEST ? aspi_next_uniform(next, state) : R(0.0);
    return aspi_flown_to(drawn, deeper, l, u0, u1, seen, height, aspi_abs(vz), area, out_area, out_rise);
}

/* Over mirrors level on average; walk_batch.c's turn_walks is this in loops. What does not wait for anything comes
 * first: the numbers and the first meeting. */
static void mirror_eval(const asp_mat *mat, asp_v3 wi, asp_v3 wo, asp_uniforms *next, void *state, asp_real sum[3])
{
    const asp_shape *k = &mat->ndf;
    asp_real u1 = aspi_next_uniform(next, state), u2 = aspi_next_uniform(next, state);
    asp_real u3 = aspi_next_uniform(next, state);
    asp_real seen, height = wi.z, out, l = R(0.0), carried[3] = { R(1.0), R(1.0), R(1.0) }, F[3], open;
    int met, drawn = 0, c;
    asp_v3 v;
    asp_met first, at;
    ASPI_OPS(k).turn(k, wi.x, wi.y, wi.z, u1, u2, wo.x, wo.y, wo.z, &at);
    ASPI_OPS(k).meet(k, wi.x, wi.y, wi.z, wo.x, wo.y, wo.z, &first);
    seen = first.area;
    out = first.area_out;
    open = aspi_meets_none(seen, height, out, wo.z);
    fresnel_of(mat, first.between2, aspi_facets_send(first.D, open), seen, sum);
    for (met = 1;; met++) {
        asp_real meets, most, p;
        v = aspi_vector(at.x, at.y, at.z);
        fresnel_of(mat, at.cosine2, R(1.0), R(1.0), F);
        for (c = 0; c < 3; c++)
            carried[c] = carried[c] * F[c];
        if (drawn | (v.z > R(0.0))) {
            aspi_flown f = fly_one(next, state, drawn, l, seen, height, v.z, at.area, out, wo.z);
            drawn = 1;
            l = f.l;
            meets = f.meets;
            open = f.open;
        } else {
            meets = aspi_meets_one(seen, height, at.area, aspi_abs(v.z));
            open = aspi_meets_none(seen, height, out, wo.z) * meets;
        }
        fresnel_of(mat, at.between2, aspi_facets_send(at.D, open), at.area, F);
        most = aspi_max(carried[0], aspi_max(carried[1], carried[2]));
        p = aspi_goes_on(met, most);
        for (c = 0; c < 3; c++)
            sum[c] = meets > R(0.0) ? sum[c] + carried[c] * F[c] : sum[c];
        if (!(u3 < meets * p))
            return;
        if (met >= ASPI_WALK_SURE)
            for (c = 0; c < 3; c++)
                carried[c] = carried[c] / p;
        u1 = aspi_next_uniform(next, state);
        u2 = aspi_next_uniform(next, state);
        u3 = aspi_next_uniform(next, state);
        ASPI_OPS(k).turn(k, v.x, v.y, v.z, u1, u2, wo.x, wo.y, wo.z, &at);
    }
}

ASP_CLONES_SINGLE static void draw_eval(const asp_mat *mat, asp_v3 wi, asp_v3 wo, asp_uniforms *next,
                                        void *state, asp_c3 *sum)
{
    asp_real by = crossing(mat, wi, wo);
    draw_eval_as(mat, mat->model->facets, aspi_is_level(&mat->ndf), wi, wo, next, state, sum);
    sum->r *= by;
    sum->g *= by;
    sum->b *= by;
}

asp_c3 ASPI_CALL(asp_walk_eval_cos)(const asp_mat *mat, asp_v3 wi, asp_v3 wo, asp_uniforms *next,
                                    void *state)
{
    asp_c3 sum;
    sum.r = sum.g = sum.b = aspi_walk_nothing(wi, wo);
    if (!aspi_may_walk(mat, wi, wo))
        return sum;
    if (mat->model->facets == ASPI_FACETS_REFLECT && aspi_is_level(&mat->ndf)) {
        asp_real sent[3];
        mirror_eval(mat, wi, wo, next, state, sent);
        sum.r = sent[0];
        sum.g = sent[1];
        sum.b = sent[2];
    } else {
        draw_eval(mat, wi, wo, next, state, &sum);
    }
    return sum;
}

/* 1 where the walk came out. */
ASP_CLONES_SINGLE static int draw_sample(aspi_walker *r)
{
    int met;
    for (met = 0;; met++) {
        asp_v3 v = aspi_facing(r->d, r->inside);
        asp_real seen = aspi_area_seen(r, v);
        if (met && !aspi_survives(r, met))
            return 0;
        if (!aspi_fly(r, seen))
            return 1;
        scatter(r, next_normal(r, v, seen));
    }
}

asp_sampled ASPI_CALL(asp_walk_sample)(const asp_mat *mat, asp_v3 wi, asp_uniforms *next, void *state)
{
    aspi_walker r = aspi_start_walk(mat, mat->model->facets, aspi_is_level(&mat->ndf), wi, next, state);
    asp_real by;
    asp_sampled out;
    out.wo = wi;
    out.pdf = out.weight.r = out.weight.g = out.weight.b = aspi_walk_nothing(wi, wi);
    if (!aspi_may_walk(mat, wi, wi) || !draw_sample(&r))
        return out;
    by = crossing(mat, wi, r.d);
    out.wo = r.d;
    out.pdf = ASPI_CALL(asp_walk_pdf)(mat, wi, r.d);
    out.weight.r = r.carried.r * by;
    out.weight.g = r.carried.g * by;
    out.weight.b = r.carried.b * by;
    return out;
}

/* One meeting exactly, the rest as if it came out diffusely. */
asp_real ASPI_CALL(asp_walk_pdf)(const asp_mat *mat, asp_v3 wi, asp_v3 wo)
{
    aspi_walker r = aspi_start_walk(mat, mat->model->facets, aspi_is_level(&mat->ndf), wi, 0, 0);
    asp_v3 v = aspi_facing(r.d, r.inside);
    int out = wo.z < R(0.0);
    asp_real seen, once, height = aspi_abs(wo.z), c, eta, F[3];
    if (!aspi_may_walk(mat, wi, wo))
        return aspi_walk_nothing(wi, wo);
    seen = aspi_area_seen(&r, v);
    if (r.kind == ASPI_FACETS_DIFFUSE)
        return height * R(1.0 / ASP_PI);
    if (r.kind == ASPI_FACETS_REFLECT) {
        once = by_reflection(&mat->ndf, v, wo, 0, &c);
        return aspi_walk_mixture(wi.z, seen, once / seen, height * R(1.0 / ASP_PI));
    }
    eta = r.inside ? R(1.0) / mat->c.r : mat->c.r;
    once = out == r.inside ? by_reflection(&mat->ndf, v, wo, r.inside, &c)
                           : by_refraction(&mat->ndf, v, wo, r.inside, eta, &c);
    aspi_reflected_shares(mat, aspi_has_film(mat), c, eta, F);
    once *= out == r.inside ? aspi_mean_share(aspi_has_film(mat), F) : R(1.0) - aspi_mean_share(aspi_has_film(mat), F);
    return aspi_walk_mixture(wi.z, seen, once / seen, height * R(0.5 / ASP_PI));
}
#endif
