/* walk.c - multiple scattering: a random walk over the microsurface, asperity.h section 12
 *
 * Heitz, Hanika, d'Eon, Dachsbacher 2016. Heights appear only through q, the share of the surface that
 * lies below the ray (outside) or above it (inside), so that no distribution of heights is needed. With
 * v the direction that facets in the ray's way face (back along the ray outside, along it inside) and
 *     rate = sigma(v) / |d.z|
 * a ray towards the bulk meets a facet before q' with probability 1 - (q'/q)^rate, one that leads away
 * gets out with probability q^rate. A surface of mean slope t is closed by vertical walls of area |t|
 * facing +t (Walter et al. 2014, sec. 5.1); then sigma(v) - sigma(-v) = v.z, which makes both agree.
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

#ifndef ASPI_WALK_NAMES
#define ASPI_WALK_NAMES
#define walker ASP_NAME(walker)
#define fresnel_of ASP_NAME(walk_fresnel)
#define way_out ASP_NAME(way_out)
#define leave_by ASP_NAME(leave_by)
#define other_side ASP_NAME(other_side)
#define visible_normal ASP_NAME(visible_normal)
#define draw_eval ASP_NAME(walk_draw_eval)
#define draw_sample ASP_NAME(walk_draw_sample)
#define uniform ASP_NAME(uniform)
#define negate ASP_NAME(negate)
#define walls_seen ASP_NAME(walls_seen)
#define area ASP_NAME(area)
#define ratio_exponent ASP_NAME(ratio_exponent)
#define facing ASP_NAME(facing)
#define fly ASP_NAME(fly)
#define fly_surely ASP_NAME(fly_surely)
#define leaves ASP_NAME(leaves)
#define wall_normal ASP_NAME(wall_normal)
#define next_normal ASP_NAME(next_normal)
#define scatter ASP_NAME(scatter)
#define facet_phase ASP_NAME(facet_phase)
#define by_reflection ASP_NAME(by_reflection)
#define by_refraction ASP_NAME(by_refraction)
#define by_walls ASP_NAME(by_walls)
#define add_scaled ASP_NAME(add_scaled)
#define connect ASP_NAME(connect)
#define survives ASP_NAME(survives)
#define start_walk ASP_NAME(start_walk)
#define facet_sends ASP_NAME(facet_sends)
#define by_wall ASP_NAME(by_wall)
#define crossing ASP_NAME(crossing)
#define walkable ASP_NAME(walkable)
/* Roulette begins after so many facets; walks end by it, and by this bound where nothing is absorbed. */
#define ASPI_WALK_SURE 4
#define ASPI_WALK_LONGEST 100000
#endif

/* A ray: direction, side, log q, colour carried. */
typedef struct walker {
    const asp_mat *mat;
    asp_uniforms *next;
    void *state;
    asp_v3 d;
    int inside;
    asp_real l;
    asp_c3 carried;
} walker;

/* The direction that light is to leave by: its side, height there, and the area that stands in its way. */
typedef struct way_out {
    asp_v3 w;
    int inside;
    asp_real height, area;
} way_out;

ASP_FN asp_real uniform(const walker *r)
{
    asp_real u = R(r->next(r->state));
    /* float32 rounds numbers near 1 up */
    return u < R(1.0) ? u : (ASP_PRECISION == 64 ? R(1.0 - 0x1p-53) : R(1.0 - 0x1p-24));
}

ASP_FN asp_v3 negate(asp_v3 a)
{
    a.x = -a.x;
    a.y = -a.y;
    a.z = -a.z;
    return a;
}

/* Apart, where the compiler makes one vector of three channels. */
ASP_CLONES_SINGLE static void fresnel_of(const asp_mat *mat, asp_real c, asp_real F[3])
{
    aspi_fresnel(mat, c * aspi_abs(c), R(1.0), R(1.0), F);
}

/* Area of the walls seen from v. */
ASP_FN asp_real walls_seen(const asp_shape *k, asp_v3 v)
{
    asp_real s = k->map.tx * v.x + k->map.ty * v.y;
    return s > R(0.0) ? s : R(0.0);
}

/* Facets and walls seen from v: at least v.z, which rounding must not undercut. */
ASP_FN asp_real area(const asp_shape *k, asp_v3 v)
{
    asp_real a = aspi_sigma_of(k, v) + walls_seen(k, v);
    return aspi_max(a, v.z);
}

/* over/under as an exponent. */
ASP_FN asp_real ratio_exponent(asp_real over, asp_real under)
{
    return aspi_min(over / aspi_max(under, ASP_SMALLEST), R(1e6));
}

/* log(1 - q): what lies on the other side of the surface. Like every q it is at least 1e-30. */
ASP_FN asp_real other_side(asp_real l) { return aspi_log(aspi_max(-aspi_expm1(l), R(1e-30))); }

/* What facets in the way of the ray face. */
ASP_FN asp_v3 facing(asp_v3 d, int inside) { return inside ? d : negate(d); }

/* Flies to the next facet; 0 where there is none and the ray is out. */
ASP_FN int fly(walker *r, asp_real seen)
{
    asp_real p = aspi_log(R(1.0) - uniform(r)) * ratio_exponent(aspi_abs(r->d.z), seen);
    int deeper = r->inside ? r->d.z > R(0.0) : r->d.z < R(0.0);
    if (deeper) {
        r->l = aspi_max(r->l + p, R(-69.0));
        return 1;
    }
    if (r->l >= p)
        return 0;
    r->l = r->l - p;
    return 1;
}

/* Flies to the next facet for certain and returns the probability that there is one. A ray that leads
 * away seldom meets the few facets that face it, which then send much light: the product is small, and
 * estimates that use it have a finite variance. */
ASP_FN asp_real fly_surely(walker *r, asp_real seen)
{
    asp_real rate, meets;
    int deeper = r->inside ? r->d.z > R(0.0) : r->d.z < R(0.0);
    if (deeper) {
        fly(r, seen);
        return R(1.0);
    }
    if (!(seen > ASP_SMALLEST))
        return R(0.0);
    rate = ratio_exponent(seen, aspi_abs(r->d.z));
    meets = -aspi_expm1(rate * r->l);
    r->l = aspi_min(r->l - aspi_log1p(-meets * uniform(r)) / rate, R(0.0));
    return meets;
}

ASP_FN way_out leave_by(const asp_shape *k, asp_v3 w)
{
    way_out out;
    out.w = w;
    out.inside = w.z < R(0.0);
    out.height = aspi_abs(w.z);
    out.area = area(k, facing(w, out.inside));
    return out;
}

/* Probability that a ray from q on its side meets nothing more; wo.z is not 0. */
ASP_FN asp_real leaves(const way_out *to, asp_real l)
{
    return aspi_exp(l * ratio_exponent(to->area, to->height));
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
ASP_FN asp_v3 next_normal(const walker *r, asp_v3 v, asp_real seen, asp_real u1, asp_real u2)
{
    const asp_shape *k = &r->mat->ndf;
    asp_real share = walls_seen(k, v) / seen;
    if (u1 < share)
        return wall_normal(k);
    u1 = (u1 - share) / (R(1.0) - share);
    return visible_normal(k, v, aspi_min(u1, R(1.0) - R(0x1p-24)), u2);
}

/* Leaves the facet m; the side and what is carried change. */
ASP_FN void scatter(walker *r, asp_v3 m)
{
    const asp_mat *mat = r->mat;
    asp_v3 v = facing(r->d, r->inside);
    asp_real c = aspi_dot(v, m), F[3];
    if (mat->model->facets == ASPI_FACETS_DIFFUSE) {
        asp_real u1 = uniform(r);
        r->d = aspi_around(m, aspi_cosine_lobe(m, u1, uniform(r)));
        r->carried.r *= mat->a.r;
        r->carried.g *= mat->a.g;
        r->carried.b *= mat->a.b;
        return;
    }
    if (mat->model->facets == ASPI_FACETS_REFRACT) {
        asp_real eta = r->inside ? R(1.0) / mat->c.r : mat->c.r;
        if (uniform(r) >= aspi_fresnel_dielectric(c, eta)) {
            asp_v3 t = aspi_refract(v, m, eta);
            r->d = r->inside ? negate(t) : t;
            r->inside = !r->inside;
            r->l = other_side(r->l);
            return;
        }
        v = aspi_reflect(v, m);
        r->d = r->inside ? negate(v) : v;
        return;
    }
    fresnel_of(mat, c, F);
    r->carried.r *= F[0];
    r->carried.g *= F[1];
    r->carried.b *= F[2];
    r->d = aspi_reflect(v, m);
}

/* Density of normals met, of those that face v, over the area seen. */
ASP_FN asp_real facet_phase(const asp_shape *k, asp_v3 v, asp_v3 m, asp_real seen)
{
    asp_real c = aspi_dot(v, m);
    return c <= R(0.0) ? R(0.0) : c * aspi_density_of(k, m) / seen;
}

/* Density of the direction w (of travel, on the same side) after one reflection by facets that face v,
 * without F; *c is the cosine at the facet. */
ASP_FN asp_real by_reflection(const asp_shape *k, asp_v3 v, asp_v3 w, int inside, asp_real seen,
                              asp_real *c)
{
    asp_v3 m = aspi_half_vector(v, facing(w, !inside));
    *c = aspi_dot(v, m);
    return *c <= R(0.0) || m.z <= R(0.0) ? R(0.0) : R(0.25) * aspi_density_of(k, m) / seen;
}

/* The same after refraction to the other side; eta as seen from v. From inside everything is turned
 * round, so that v faces m as outside. */
ASP_FN asp_real by_refraction(const asp_shape *k, asp_v3 v, asp_v3 w, int inside, asp_real eta,
                              asp_real seen, asp_real *c)
{
    asp_v3 away = inside ? negate(w) : w;
    asp_v3 m = aspi_bent_half(v, away, eta);
    asp_real wm = aspi_dot(away, m);
    *c = aspi_dot(v, m);
    if (*c <= R(0.0) || wm >= R(0.0) || m.z <= R(0.0))
        return R(0.0);
    return facet_phase(k, v, m, seen) * aspi_bent_density(*c, wm, eta);
}

/* The share of light that one meeting with facets sends from v to the direction w of travel, which is
 * inside where to_inside; mirrors and dielectrics. */
ASP_FN asp_c3 facet_sends(const walker *r, asp_v3 v, asp_v3 w, int to_inside, asp_real seen)
{
    const asp_mat *mat = r->mat;
    asp_real F[3], c, p;
    asp_c3 out;
    if (mat->model->facets == ASPI_FACETS_REFRACT) {
        asp_real eta = r->inside ? R(1.0) / mat->c.r : mat->c.r;
        if (to_inside != r->inside) {
            p = by_refraction(&mat->ndf, v, w, r->inside, eta, seen, &c);
            p *= R(1.0) - aspi_fresnel_dielectric(c, eta);
        } else {
            p = by_reflection(&mat->ndf, v, w, r->inside, seen, &c);
            p *= aspi_fresnel_dielectric(c, eta);
        }
        out.r = out.g = out.b = p;
        return out;
    }
    p = by_reflection(&mat->ndf, v, w, 0, seen, &c);
    fresnel_of(mat, c, F);
    out.r = F[0] * p;
    out.g = F[1] * p;
    out.b = F[2] * p;
    return out;
}

ASP_FN void add_scaled(asp_c3 *sum, asp_c3 a, asp_c3 b, asp_real by)
{
    sum->r += a.r * b.r * by;
    sum->g += a.g * b.g * by;
    sum->b += a.b * b.b * by;
}

/* What goes to wo by way of one wall, arriving there in direction d on side `inside` and changed by
 * `by` at the wall. */
ASP_FN void by_wall(const walker *r, asp_v3 v, asp_real seen, asp_v3 d, int inside, asp_c3 by,
                    const way_out *to, asp_c3 *sum)
{
    const asp_shape *k = &r->mat->ndf;
    asp_v3 f = facing(d, inside);
    asp_real all = area(k, f), share = walls_seen(k, f) / aspi_max(all, ASP_SMALLEST);
    walker side = *r;
    asp_c3 sent;
    if (share <= R(0.0))
        return;
    sent = facet_sends(r, v, d, inside, seen);
    side.d = d;
    if (inside != r->inside)
        side.l = other_side(side.l);
    side.inside = inside;
    share *= fly_surely(&side, all);
    if (inside != to->inside)
        side.l = other_side(side.l);
    share *= leaves(to, side.l);
    sent.r *= by.r;
    sent.g *= by.g;
    sent.b *= by.b;
    add_scaled(sum, r->carried, sent, share);
}

/* All ways to wo with one wall last: mirrored in it, and for dielectrics refracted by it. */
static void by_walls(const walker *r, asp_v3 v, asp_real seen, const way_out *to, asp_c3 *sum)
{
    const asp_mat *mat = r->mat;
    asp_v3 wo = to->w, n = wall_normal(&mat->ndf), toward;
    int out = to->inside;
    asp_real c, F[3], eta, f;
    asp_c3 by;
    n = facing(n, !out);                 /* towards the side of wo */
    c = aspi_dot(wo, n);
    if (c <= R(0.0))
        return;
    if (mat->model->facets != ASPI_FACETS_REFRACT) {
        fresnel_of(mat, c, F);
        by.r = F[0];
        by.g = F[1];
        by.b = F[2];
        by_wall(r, v, seen, negate(aspi_reflect(wo, n)), out, by, to, sum);
        return;
    }
    eta = out ? R(1.0) / mat->c.r : mat->c.r;
    f = aspi_fresnel_dielectric(c, eta);
    by.r = by.g = by.b = f;
    by_wall(r, v, seen, negate(aspi_reflect(wo, n)), out, by, to, sum);
    if (f < R(1.0)) {
        asp_v3 t = aspi_refract(wo, n, eta);
        asp_real ct = aspi_abs(aspi_dot(t, n));
        toward = negate(t);
        /* solid angles before and after: Snell's law */
        by.r = by.g = by.b = (R(1.0) - f) * c / (eta * eta * aspi_max(ct, ASP_SMALLEST));
        by_wall(r, v, seen, toward, !out, by, to, sum);
    }
}

/* Adds what this meeting, whose probability is `meets`, sends to wo: by the facet m if it is diffuse, else by all that face v, and by
 * those and then a wall. `first`: nothing was met before, so that the way out is averaged
 * over heights: rate_i / (rate_i + rate_o) instead of q^rate_o. */
ASP_FN void connect(const walker *r, asp_v3 v, asp_v3 m, asp_real seen, const way_out *to, int first,
                    asp_real meets, asp_c3 *sum)
{
    const asp_mat *mat = r->mat;
    asp_real open;
    if (to->inside && mat->model->facets != ASPI_FACETS_REFRACT)
        return;
    if (first && to->inside == r->inside)
        open = seen * to->height / (seen * to->height + to->area * aspi_abs(r->d.z));
    else
        open = leaves(to, to->inside == r->inside ? r->l : other_side(r->l));
    open *= meets;
    if (mat->model->facets == ASPI_FACETS_DIFFUSE) {
        asp_c3 by = mat->a;
        add_scaled(sum, r->carried, by, aspi_max(aspi_dot(m, to->w), R(0.0)) * R(1.0 / ASP_PI) * open);
        return;
    }
    add_scaled(sum, r->carried, facet_sends(r, v, to->w, to->inside, seen), open);
    if (mat->ndf.map.tx != R(0.0) || mat->ndf.map.ty != R(0.0)) {
        walker now = *r;
        now.carried.r *= meets;
        now.carried.g *= meets;
        now.carried.b *= meets;
        by_walls(&now, v, seen, to, sum);
    }
}

/* Roulette: walks go on with the probability of what they carry, so that none is cut short. */
ASP_FN int survives(walker *r, int met)
{
    asp_real most = aspi_max(r->carried.r, aspi_max(r->carried.g, r->carried.b)), p;
    if (most <= R(0.0) || met >= ASPI_WALK_LONGEST)
        return 0;
    if (met < ASPI_WALK_SURE)
        return 1;
    p = aspi_min(most, R(1.0));
    if (uniform(r) >= p)
        return 0;
    r->carried.r /= p;
    r->carried.g /= p;
    r->carried.b /= p;
    return 1;
}

ASP_FN walker start_walk(const asp_mat *mat, asp_v3 wi, asp_uniforms *next, void *state)
{
    walker r;
    r.mat = mat;
    r.next = next;
    r.state = state;
    r.d = negate(wi);
    r.inside = wi.z < R(0.0);
    r.l = R(0.0);
    r.carried.r = r.carried.g = r.carried.b = R(1.0);
    return r;
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

/* Is there anything to walk on: facets known, wi on a side where light can be? */
ASP_FN int walkable(const asp_mat *mat, asp_v3 wi)
{
    int kind = mat->model->facets;
    if (kind == ASPI_FACETS_REFRACT && mat->a.r > R(0.0))
        return 0; /* a thin sheet has no inside */
    return kind != ASPI_FACETS_NONE && (wi.z > R(0.0) || (wi.z < R(0.0) && kind == ASPI_FACETS_REFRACT));
}

/* The numbers of a meeting are drawn one after the other, whether they are needed or not; the facet is
 * made of them when it is. */
ASP_CLONES_SINGLE static void draw_eval(const asp_mat *mat, asp_v3 wi, asp_v3 wo, asp_uniforms *next,
                                        void *state, asp_c3 *sum)
{
    walker r = start_walk(mat, wi, next, state);
    way_out to = leave_by(&mat->ndf, wo);
    int met, diffuse = mat->model->facets == ASPI_FACETS_DIFFUSE;
    asp_real by;
    for (met = 0;; met++) {
        asp_v3 v = facing(r.d, r.inside), m = v;
        asp_real seen = area(&mat->ndf, v), meets = fly_surely(&r, seen), u1, u2;
        if (meets <= R(0.0))
            break;
        u1 = uniform(&r);
        u2 = uniform(&r);
        if (diffuse)
            m = next_normal(&r, v, seen, u1, u2);
        connect(&r, v, m, seen, &to, met == 0, meets, sum);
        if (uniform(&r) >= meets)
            break;
        scatter(&r, diffuse ? m : next_normal(&r, v, seen, u1, u2));
        if (!survives(&r, met + 1))
            break;
    }
    by = crossing(mat, wi, wo);
    sum->r *= by;
    sum->g *= by;
    sum->b *= by;
}

asp_c3 ASPI_CALL(asp_walk_eval_cos)(const asp_mat *mat, asp_v3 wi, asp_v3 wo, asp_uniforms *next,
                                    void *state)
{
    asp_real nothing = (wi.x + wi.y + wi.z + wo.x + wo.y + wo.z) * R(0.0);
    asp_c3 sum;
    sum.r = sum.g = sum.b = nothing;
    if (walkable(mat, wi) && nothing == R(0.0) && wo.z != R(0.0))
        draw_eval(mat, wi, wo, next, state, &sum);
    return sum;
}

/* 1 where the walk came out. */
ASP_CLONES_SINGLE static int draw_sample(walker *r)
{
    int met;
    for (met = 0;; met++) {
        asp_v3 v = facing(r->d, r->inside);
        asp_real seen = area(&r->mat->ndf, v), u1;
        if (met && !survives(r, met))
            return 0;
        if (!fly(r, seen))
            return 1;
        u1 = uniform(r);
        scatter(r, next_normal(r, v, seen, u1, uniform(r)));
    }
}

asp_sampled ASPI_CALL(asp_walk_sample)(const asp_mat *mat, asp_v3 wi, asp_uniforms *next, void *state)
{
    walker r = start_walk(mat, wi, next, state);
    asp_real nothing = (wi.x + wi.y + wi.z) * R(0.0), by;
    asp_sampled out;
    out.wo = wi;
    out.pdf = out.weight.r = out.weight.g = out.weight.b = nothing;
    if (!walkable(mat, wi) || nothing != R(0.0) || !draw_sample(&r))
        return out;
    by = crossing(mat, wi, r.d);
    out.wo = r.d;
    out.pdf = ASPI_CALL(asp_walk_pdf)(mat, wi, r.d);
    out.weight.r = r.carried.r * by;
    out.weight.g = r.carried.g * by;
    out.weight.b = r.carried.b * by;
    return out;
}

/* One meeting exactly, the rest as if it came out diffusely: what the first does not let out. */
asp_real ASPI_CALL(asp_walk_pdf)(const asp_mat *mat, asp_v3 wi, asp_v3 wo)
{
    walker r = start_walk(mat, wi, 0, 0);
    asp_v3 v = facing(r.d, r.inside);
    int out = wo.z < R(0.0);
    asp_real nothing = (wi.x + wi.y + wi.z + wo.x + wo.y + wo.z) * R(0.0);
    asp_real seen, once, first, height = aspi_abs(wo.z) + nothing, c, eta;
    if (!walkable(mat, wi) || wo.z == R(0.0)
        || (out && mat->model->facets != ASPI_FACETS_REFRACT))
        return nothing;
    seen = area(&mat->ndf, v);
    /* facets level on average let out 1/(1 + hidden part) of what meets them once */
    first = aspi_abs(wi.z) / seen;
    first = R(0.9) * first + R(0.05);
    eta = r.inside ? R(1.0) / mat->c.r : mat->c.r;
    if (mat->model->facets == ASPI_FACETS_DIFFUSE)
        return height * R(1.0 / ASP_PI);
    if (mat->model->facets != ASPI_FACETS_REFRACT) {
        once = by_reflection(&mat->ndf, v, wo, 0, seen, &c);
        return first * once + (R(1.0) - first) * height * R(1.0 / ASP_PI);
    }
    if (out == r.inside) {
        once = by_reflection(&mat->ndf, v, wo, r.inside, seen, &c);
        once *= aspi_fresnel_dielectric(c, eta);
    } else {
        once = by_refraction(&mat->ndf, v, wo, r.inside, eta, seen, &c);
        once *= R(1.0) - aspi_fresnel_dielectric(c, eta);
    }
    return first * once + (R(1.0) - first) * height * R(0.5 / ASP_PI);
}
#endif
