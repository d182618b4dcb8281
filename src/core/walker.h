/* walker.h - a ray that walks over the microsurface: heights, flights, roulette; for walk.c and walk_batch.c
 *
 * Heights appear only through q, the share of the surface that lies below the ray (outside) or above it
 * (inside), so that no distribution of heights is needed. With v the direction that facets in the ray's way
 * face (back along the ray outside, along it inside) and
 *     rate = sigma(v) / |d.z|
 * a ray towards the bulk meets a facet before q' with probability 1 - (q'/q)^rate, one that leads away
 * gets out with probability q^rate. The first flight leaves q distributed like x^a, a its rate, and so does
 * every flight after it that leads away and meets a facet: it does so with probability rate/(a + rate), and
 * light gets out by a/(a + rate). q is drawn only when a ray turns back or crosses. A surface of mean slope t is
 * closed by vertical walls of area |t| facing +t (Walter et al. 2014, sec. 5.1); then
 * sigma(v) - sigma(-v) = v.z, which makes both agree. */

#include "bsdf/bsdf.h"
#include "bsdf/bsdf_number.h"
#include "bsdf/ops.h"

#ifndef ASPI_WALKER_NAMES
#define ASPI_WALKER_NAMES
#define aspi_area_seen ASP_NAME(aspi_area_seen)
#define aspi_below_1 ASP_NAME(aspi_below_1)
#define aspi_cross_over ASP_NAME(aspi_cross_over)
#define aspi_deeper ASP_NAME(aspi_deeper)
#define aspi_facing ASP_NAME(aspi_facing)
#define aspi_flight ASP_NAME(aspi_flight)
#define aspi_fly ASP_NAME(aspi_fly)
#define aspi_fly_deeper ASP_NAME(aspi_fly_deeper)
#define aspi_fly_surely ASP_NAME(aspi_fly_surely)
#define aspi_free_above ASP_NAME(aspi_free_above)
#define aspi_gets_out ASP_NAME(aspi_gets_out)
#define aspi_height_of ASP_NAME(aspi_height_of)
#define aspi_is_level ASP_NAME(aspi_is_level)
#define aspi_higher ASP_NAME(aspi_higher)
#define aspi_leads_deeper ASP_NAME(aspi_leads_deeper)
#define aspi_leave_by ASP_NAME(aspi_leave_by)
#define aspi_meets_above ASP_NAME(aspi_meets_above)
#define aspi_meets_none ASP_NAME(aspi_meets_none)
#define aspi_meets_one ASP_NAME(aspi_meets_one)
#define aspi_negate ASP_NAME(aspi_negate)
#define aspi_next_uniform ASP_NAME(aspi_next_uniform)
#define aspi_other_side ASP_NAME(aspi_other_side)
#define aspi_ratio_exponent ASP_NAME(aspi_ratio_exponent)
#define aspi_start_walk ASP_NAME(aspi_start_walk)
#define aspi_survives ASP_NAME(aspi_survives)
#define aspi_walk_uniform ASP_NAME(aspi_walk_uniform)
#define aspi_may_walk ASP_NAME(aspi_may_walk)
#define aspi_walk_nothing ASP_NAME(aspi_walk_nothing)
#define aspi_walkable ASP_NAME(aspi_walkable)
#define aspi_walls_seen ASP_NAME(aspi_walls_seen)
#define aspi_walk_mixture ASP_NAME(aspi_walk_mixture)
#define aspi_facets_send ASP_NAME(aspi_facets_send)
#define aspi_flown ASP_NAME(aspi_flown)
#define aspi_flown_to ASP_NAME(aspi_flown_to)
#define aspi_goes_on ASP_NAME(aspi_goes_on)
#define aspi_walker ASP_NAME(aspi_walker)
#define aspi_way_out ASP_NAME(aspi_way_out)
/* Roulette begins after so many facets; walks end by it, and by this bound where nothing is absorbed. */
#define ASPI_WALK_SURE 4
#define ASPI_WALK_LONGEST 100000
#endif

#if (ASP_PRECISION == 64 && !defined(ASPI_WALKER_64)) || \
    (ASP_PRECISION == 32 && !defined(ASPI_WALKER_32))
#if ASP_PRECISION == 64
#define ASPI_WALKER_64
#else
#define ASPI_WALKER_32
#endif

/* A ray: direction, side, colour carried; log q where it is drawn, else q is distributed like x^(seen/height),
 * seen = 0 where the walk begins. What facets do (`kind`) and whether there are no walls (`level`) are constants
 * to the compiler where walks of the most common kind are compiled apart. */
typedef struct aspi_walker {
    const asp_mat *mat;
    int kind, level;
    asp_uniforms *next;
    void *state;
    asp_v3 d;
    int inside, drawn;
    asp_real l, seen, height;
    asp_c3 carried;
} aspi_walker;

/* The direction that light is to leave by: its side, height there, and the area that stands in its way. */
typedef struct aspi_way_out {
    asp_v3 w;
    int inside;
    asp_real height, area;
} aspi_way_out;

/* float32 rounds numbers near 1 up. */
ASP_FN asp_real aspi_below_1(asp_real u)
{
    return u < R(1.0) ? u : (ASP_PRECISION == 64 ? R(1.0 - 0x1p-53) : R(1.0 - 0x1p-24));
}

ASP_FN asp_real aspi_next_uniform(asp_uniforms *next, void *state) { return aspi_below_1(R(next(state))); }

ASP_FN asp_real aspi_walk_uniform(const aspi_walker *r) { return aspi_next_uniform(r->next, r->state); }

ASP_FN asp_v3 aspi_negate(asp_v3 a)
{
    a.x = -a.x;
    a.y = -a.y;
    a.z = -a.z;
    return a;
}

/* Area of the walls seen from v. */
ASP_FN asp_real aspi_walls_seen(const aspi_walker *r, asp_v3 v)
{
    const asp_shape *k = &r->mat->ndf;
    asp_real s = k->map.tx * v.x + k->map.ty * v.y;
    return r->level || s <= R(0.0) ? R(0.0) : s;
}

/* Facets and walls seen from v: at least v.z, which rounding must not undercut. */
ASP_FN asp_real aspi_area_seen(const aspi_walker *r, asp_v3 v)
{
    asp_real a = aspi_sigma_of(&r->mat->ndf, v) + aspi_walls_seen(r, v);
    return aspi_max(a, v.z);
}

/* over/under as an exponent. */
ASP_FN asp_real aspi_ratio_exponent(asp_real over, asp_real under)
{
    return aspi_min(over / aspi_max(under, ASP_SMALLEST), R(1e6));
}

/* log(1 - q): what lies on the other side of the surface. Like every q it is at least 1e-30. */
ASP_FN asp_real aspi_other_side(asp_real l) { return aspi_log(aspi_max(-aspi_expm1(l), R(1e-30))); }

/* What facets in the way of the ray face. */
ASP_FN asp_v3 aspi_facing(asp_v3 d, int inside) { return inside ? d : aspi_negate(d); }

/* The change of log q, which is negative, on the way to a facet, by u; the ray moves by `rise` in height and sees
 * `area`. */
ASP_FN asp_real aspi_flight(asp_real u, asp_real rise, asp_real area)
{
    return aspi_log(R(1.0) - u) * aspi_ratio_exponent(rise, area);
}

/* log q after such a flight towards the bulk. */
ASP_FN asp_real aspi_deeper(asp_real l, asp_real u, asp_real rise, asp_real area)
{
    return aspi_max(l + aspi_flight(u, rise, area), R(-69.0));
}

/* Probability that a ray which leads away from log q meets a facet, and log q at that facet, by u. */
ASP_FN asp_real aspi_meets_above(asp_real l, asp_real rate) { return -aspi_expm1(rate * l); }

ASP_FN asp_real aspi_higher(asp_real l, asp_real u, asp_real rate, asp_real meets)
{
    return aspi_min(l - aspi_log1p(-meets * u) / rate, R(0.0));
}

/* Probability that it meets none. */
ASP_FN asp_real aspi_free_above(asp_real l, asp_real area, asp_real rise)
{
    return aspi_exp(l * aspi_ratio_exponent(area, rise));
}

/* log q, drawn now if it was not. */
ASP_FN asp_real aspi_height_of(aspi_walker *r)
{
    if (!r->drawn) {
        r->l = aspi_deeper(R(0.0), aspi_walk_uniform(r), r->height, r->seen);
        r->drawn = 1;
    }
    return r->l;
}

ASP_FN void aspi_cross_over(aspi_walker *r)
{
    r->l = aspi_other_side(aspi_height_of(r));
    r->inside = !r->inside;
}

/* Towards the bulk: there is always a facet. */
ASP_FN int aspi_leads_deeper(const aspi_walker *r) { return r->inside ? r->d.z > R(0.0) : r->d.z < R(0.0); }

ASP_FN void aspi_fly_deeper(aspi_walker *r, asp_real seen)
{
    if (!r->drawn && r->seen == R(0.0)) {
        r->seen = seen;
        r->height = aspi_abs(r->d.z);
        return;
    }
    aspi_height_of(r);
    r->l = aspi_deeper(r->l, aspi_walk_uniform(r), aspi_abs(r->d.z), seen);
}

/* Where q is distributed like x^(seen/height): probability that a ray which leads away, rises by `rise` and sees
 * `area` meets a facet, and that it meets none. */
ASP_FN asp_real aspi_meets_one(asp_real seen, asp_real height, asp_real area, asp_real rise)
{
    asp_real x = area * height, p = x / (x + seen * rise);
    return area > ASP_SMALLEST ? p : R(0.0);
}

ASP_FN asp_real aspi_meets_none(asp_real seen, asp_real height, asp_real area, asp_real rise)
{
    asp_real x = seen * rise;
    return x / (x + area * height);
}

/* Flies to the next facet; 0 where there is none and the ray is out. */
ASP_FN int aspi_fly(aspi_walker *r, asp_real seen)
{
    asp_real p;
    if (aspi_leads_deeper(r)) {
        aspi_fly_deeper(r, seen);
        return 1;
    }
    if (!r->drawn)
        return aspi_walk_uniform(r) < aspi_meets_one(r->seen, r->height, seen, aspi_abs(r->d.z));
    p = aspi_flight(aspi_walk_uniform(r), aspi_abs(r->d.z), seen);
    if (r->l >= p)
        return 0;
    r->l = r->l - p;
    return 1;
}

/* Flies to the next facet for certain and returns the probability that there is one. A ray that leads
 * away seldom meets the few facets that face it, which then send much light: the product is small, and
 * estimates that use it have a finite variance. */
ASP_FN asp_real aspi_fly_surely(aspi_walker *r, asp_real seen)
{
    asp_real rate, meets;
    if (aspi_leads_deeper(r)) {
        aspi_fly_deeper(r, seen);
        return R(1.0);
    }
    if (!(seen > ASP_SMALLEST))
        return R(0.0);
    if (!r->drawn)
        return aspi_meets_one(r->seen, r->height, seen, aspi_abs(r->d.z));
    rate = aspi_ratio_exponent(seen, aspi_abs(r->d.z));
    meets = aspi_meets_above(r->l, rate);
    r->l = aspi_higher(r->l, aspi_walk_uniform(r), rate, meets);
    return meets;
}

ASP_FN aspi_way_out aspi_leave_by(const aspi_walker *r, asp_v3 w)
{
    aspi_way_out out;
    out.w = w;
    out.inside = w.z < R(0.0);
    out.height = aspi_abs(w.z);
    out.area = aspi_area_seen(r, aspi_facing(w, out.inside));
    return out;
}

/* Probability that the ray, sent to wo, meets nothing more; wo.z is not 0. */
ASP_FN asp_real aspi_gets_out(aspi_walker *r, const aspi_way_out *to)
{
    if (to->inside == r->inside && !r->drawn)
        return aspi_meets_none(r->seen, r->height, to->area, to->height);
    aspi_height_of(r);
    return aspi_free_above(to->inside == r->inside ? r->l : aspi_other_side(r->l), to->area, to->height);
}

/* Roulette: walks go on with the probability of what they carry, so that none is cut short. */
ASP_FN int aspi_survives(aspi_walker *r, int met)
{
    asp_real p = aspi_min(aspi_max(r->carried.r, aspi_max(r->carried.g, r->carried.b)), R(1.0));
    if (met < ASPI_WALK_SURE)
        return 1;
    if (met >= ASPI_WALK_LONGEST || aspi_walk_uniform(r) >= p)
        return 0;
    r->carried.r /= p;
    r->carried.g /= p;
    r->carried.b /= p;
    return 1;
}

/* What facets of density D send, of what meets them and then gets out, but for F and over the area seen. */
ASP_FN asp_real aspi_facets_send(asp_real D, asp_real open) { return R(0.25) * D * open; }

/* The share of walks that go on by roulette after so many turns: the most that they carry. */
ASP_FN asp_real aspi_goes_on(int met, asp_real most)
{
    asp_real p = aspi_min(most, R(1.0));
    p = met < ASPI_WALK_SURE ? R(1.0) : p;
    return met < ASPI_WALK_LONGEST ? p : R(0.0);
}

/* A flight from or to a height that is drawn: log q at the facet, the probability that there is one, and that
 * times the probability that light gets out from there. */
typedef struct aspi_flown { asp_real l, meets, open; } aspi_flown;

ASP_FN aspi_flown aspi_flown_to(int drawn, int deeper, asp_real l, asp_real u0, asp_real u1, asp_real seen,
                                asp_real height, asp_real rise, asp_real area, asp_real out_area, asp_real out_rise)
{
    asp_real first = aspi_deeper(R(0.0), u0, height, seen), rate = aspi_ratio_exponent(area, rise), down, up, p;
    aspi_flown f;
    first = drawn ? l : first;
    down = aspi_deeper(first, u1, rise, area);
    p = aspi_meets_above(first, rate);
    up = aspi_higher(first, u1, rate, p);
    p = area > ASP_SMALLEST ? p : R(0.0);
    f.meets = deeper ? R(1.0) : p;
    f.l = deeper ? down : up;
    f.open = aspi_free_above(f.l, out_area, out_rise) * f.meets;
    return f;
}

/* The density for multiple importance sampling: `once`, of one meeting, in the share of light that it lets out,
 * and a cosine lobe, `diffuse`, for the rest. Facets level on average let out 1/(1 + hidden part) of what meets
 * them once. */
ASP_FN asp_real aspi_walk_mixture(asp_real ci, asp_real seen, asp_real once, asp_real diffuse)
{
    asp_real first = R(0.9) * (aspi_abs(ci) / seen) + R(0.05);
    return first * once + (R(1.0) - first) * diffuse;
}

ASP_FN int aspi_is_level(const asp_shape *k) { return k->map.tx == R(0.0) && k->map.ty == R(0.0); }

ASP_FN aspi_walker aspi_start_walk(const asp_mat *mat, int kind, int level, asp_v3 wi, asp_uniforms *next, void *state)
{
    aspi_walker r;
    r.mat = mat;
    r.kind = kind;
    r.level = level;
    r.next = next;
    r.state = state;
    r.d = aspi_negate(wi);
    r.inside = wi.z < R(0.0);
    r.drawn = 0;
    r.l = r.seen = r.height = R(0.0);
    r.carried.r = r.carried.g = r.carried.b = R(1.0);
    return r;
}

/* Is there anything to walk on: facets known, wi on a side where light can be? */
ASP_FN int aspi_walkable(const asp_mat *mat, asp_v3 wi)
{
    int kind = mat->model->facets;
    if (kind == ASPI_FACETS_REFRACT && mat->a.r > R(0.0))
        return 0; /* a thin sheet has no inside */
    return kind != ASPI_FACETS_NONE && (wi.z > R(0.0) || (wi.z < R(0.0) && kind == ASPI_FACETS_REFRACT));
}

/* 0, but NaN where a number is. */
ASP_FN asp_real aspi_walk_nothing(asp_v3 wi, asp_v3 wo)
{
    return (wi.x + wi.y + wi.z + wo.x + wo.y + wo.z) * R(0.0);
}

/* Whether light may walk from wi to wo: it leaves below where facets refract, never along the horizon. */
ASP_FN int aspi_may_walk(const asp_mat *mat, asp_v3 wi, asp_v3 wo)
{
    int leaves = wo.z > R(0.0) || (wo.z < R(0.0) && mat->model->facets == ASPI_FACETS_REFRACT);
    return aspi_walkable(mat, wi) && leaves && aspi_walk_nothing(wi, wo) == R(0.0);
}
#endif
