/* walk_batch.c - walks over arrays: asperity.h section 12
 *
 * Walks over mirrors that are level on average go side by side, one meeting at a time; those that go on are
 * moved together. Heights are drawn seldom, and then one by one. Other surfaces' walks go one after the other.
 * Element i is bit for bit what the single call of walk.c gives.
 *
 * Read three times like facets.c. */
#ifndef ASP_PRECISION
#include "bsdf/bsdf.h"

#define ASP_PRECISION 64
#include "walk_batch.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "walk_batch.c"
#undef ASP_PRECISION

#else
#include "core/blocks.h"
#include "bsdf/bsdf_number.h"
#include "core/block_fresnel.h"
#include "core/walk_loops.h"

#ifndef ASPI_WALK_BATCH_NAMES
#define ASPI_WALK_BATCH_NAMES
#define walks ASP_NAME(walks)
#define walks_alike ASP_NAME(walks_alike)
#define begin ASP_NAME(walks_begin)
#define start_walks ASP_NAME(start_walks)
#define state_of ASP_NAME(walk_state_of)
#define walk_at ASP_NAME(walk_at)
#define put_walk ASP_NAME(put_walk)
#define move_walk ASP_NAME(move_walk)
#define area_seen ASP_NAME(walks_area_seen)
#define draw_two ASP_NAME(walks_draw_two)
#define draw_flights ASP_NAME(walks_draw_flights)
#define fly_drawn ASP_NAME(walks_fly_drawn)
#define draw_three ASP_NAME(walks_draw_three)
#define leave_walks ASP_NAME(leave_walks)
#define come_out ASP_NAME(walks_come_out)
#define scatter_walks ASP_NAME(scatter_walks)
#define roulette ASP_NAME(walks_roulette)
#define meet_walks ASP_NAME(meet_walks)
#define turn_walks ASP_NAME(turn_walks)
#define gather_walks ASP_NAME(gather_walks)
#define sample_walks ASP_NAME(sample_walks)
#define density_of_walks ASP_NAME(density_of_walks)

/* What a ray of a block has: the way back, where facets in the way face; heights and colour as in aspi_walker;
 * for evaluation the way out, the area in that way, and what went there so far. */
enum {
    WALK_X, WALK_Y, WALK_Z, WALK_L, WALK_SEEN, WALK_HEIGHT, WALK_RED, WALK_GREEN, WALK_BLUE, WALK_SAMPLED,
    WALK_OUT_X = WALK_SAMPLED, WALK_OUT_Y, WALK_OUT_Z, WALK_OUT_AREA, WALK_SUM_RED, WALK_SUM_GREEN, WALK_SUM_BLUE,
    WALK_NUMBERS
};
#endif

#define IN const asp_real *ASP_RESTRICT
#define OUT asp_real *ASP_RESTRICT

/* The rays under way, `count` of them; `element` says where each began. */
typedef struct walks {
    const asp_mat *mat;
    asp_uniforms *next;
    char *states;
    size_t stride, count;
    int numbers;  /* how many a ray has */
    int in_order; /* all elements of a block, none moved */
    int longest;  /* no ray has met more facets */
    size_t element[ASP_BLOCK];
    int drawn[ASP_BLOCK], met[ASP_BLOCK];
    asp_real u[3][ASP_BLOCK];
    asp_real ray[WALK_NUMBERS][ASP_BLOCK];
} walks;

ASP_FN int walks_alike(const asp_mat *mat)
{
    return mat->model->facets == ASPI_FACETS_REFLECT && aspi_is_level(&mat->ndf);
}

ASP_FN void *state_of(const walks *a, size_t i) { return a->states + a->element[i] * a->stride; }

ASP_FN aspi_walker walk_at(const walks *a, size_t i)
{
    asp_v3 v = aspi_at(a->ray[WALK_X], a->ray[WALK_Y], a->ray[WALK_Z], i);
    aspi_walker r = aspi_start_walk(a->mat, ASPI_FACETS_REFLECT, 1, v, a->next, state_of(a, i));
    r.inside = 0;
    r.drawn = a->drawn[i];
    r.l = a->ray[WALK_L][i];
    r.seen = a->ray[WALK_SEEN][i];
    r.height = a->ray[WALK_HEIGHT][i];
    r.carried.r = a->ray[WALK_RED][i];
    r.carried.g = a->ray[WALK_GREEN][i];
    r.carried.b = a->ray[WALK_BLUE][i];
    return r;
}

/* What flights and roulette changed. */
ASP_FN void put_walk(walks *a, size_t i, const aspi_walker *r)
{
    a->drawn[i] = r->drawn;
    a->ray[WALK_L][i] = r->l;
    a->ray[WALK_RED][i] = r->carried.r;
    a->ray[WALK_GREEN][i] = r->carried.g;
    a->ray[WALK_BLUE][i] = r->carried.b;
}

/* Ray i of one becomes ray j of the other, or of the same. */
ASP_FN void move_walk(const walks *from, size_t i, walks *to, size_t j)
{
    int f;
    to->element[j] = from->element[i];
    to->drawn[j] = from->drawn[i];
    to->met[j] = from->met[i];
    for (f = 0; f < from->numbers; f++)
        to->ray[f][j] = from->ray[f][i];
}

ASP_FN void begin(walks *a, const asp_mat *mat, asp_uniforms *next, void *states, size_t stride, int numbers)
{
    a->mat = mat;
    a->next = next;
    a->states = (char *)states;
    a->stride = stride;
    a->count = 0;
    a->numbers = numbers;
    a->in_order = 0;
    a->longest = 0;
}

/* Walks from those elements of a block, the first of which is element `first`, that may begin, to wo where it is
 * given; `may` tells which. */
ASP_CLONES static void start_walks(walks *a, size_t n, size_t first, asp_cv3s wi, const asp_cv3s *wo, int *may)
{
    asp_cv3s w = wo ? *wo : wi;
    const asp_real *from[6];
    int all = aspi_walk_all(n, wi.x, wi.y, wi.z, w.x, w.y, w.z), f, place[ASP_BLOCK];
    size_t i, j = 0;
    from[0] = wi.x;
    from[1] = wi.y;
    from[2] = wi.z;
    from[3] = w.x;
    from[4] = w.y;
    from[5] = w.z;
    for (i = 0; i < n; i++)
        may[i] = all;
    for (i = 0; i < n && !all; i++)
        may[i] = aspi_may_walk(a->mat, aspi_at(wi.x, wi.y, wi.z, i), aspi_at(w.x, w.y, w.z, i));
    for (i = 0; i < n; i++) {
        place[j] = (int)i;
        j += may[i] != 0;
    }
    a->count = j;
    a->in_order = all;
    a->longest = 0;
    for (f = 0; f < (wo ? 6 : 3); f++) {
        asp_real *to = a->ray[f < 3 ? WALK_X + f : WALK_OUT_X + f - 3];
        for (i = 0; i < j && !all; i++)
            to[i] = from[f][place[i]];
        if (all)
            memcpy(to, from[f], n * sizeof *to);
    }
    for (i = 0; i < j; i++) {
        a->element[i] = first + (size_t)place[i];
        a->drawn[i] = a->met[i] = 0;
    }
    for (i = 0; i < j && !wo; i++) {
        a->ray[WALK_L][i] = R(0.0);
        a->ray[WALK_RED][i] = a->ray[WALK_GREEN][i] = a->ray[WALK_BLUE][i] = R(1.0);
    }
}

/* ---- stages */

ASP_FN void area_seen(const asp_mat *mat, size_t n, asp_real sign, IN x, IN y, IN z, OUT area)
{
    ASPI_OPS(&mat->ndf).sigma_n(&mat->ndf, n, sign, x, y, z, area);
    aspi_walk_area(n, sign, z, area);
}

/* What calls the stream stands apart: between wide registers its narrow instructions would stall. */
ASP_APART static void draw_two(const walks *a, OUT u1, OUT u2)
{
    size_t i;
    for (i = 0; i < a->count; i++) {
        u1[i] = aspi_next_uniform(a->next, state_of(a, i));
        u2[i] = aspi_next_uniform(a->next, state_of(a, i));
    }
}

/* Two for the next facet and one that decides whether the walk goes on. */
ASP_APART static void draw_three(walks *a)
{
    asp_real *u0 = a->u[0], *u1 = a->u[1], *u2 = a->u[2];
    asp_uniforms *next = a->next;
    size_t i;
    for (i = 0; i < a->count; i++) {
        void *state = state_of(a, i);
        u0[i] = R(next(state));
        u1[i] = R(next(state));
        u2[i] = R(next(state));
    }
}

/* Leaves the facets, each drawn by two numbers. */
ASP_FN void scatter_walks(walks *a)
{
    asp_real u1[ASP_BLOCK], u2[ASP_BLOCK], m[3][ASP_BLOCK], F[3][ASP_BLOCK], c2[ASP_BLOCK], ones[ASP_BLOCK];
    asp_real *x = a->ray[WALK_X], *y = a->ray[WALK_Y], *z = a->ray[WALK_Z];
    asp_c3s to;
    size_t n = a->count;
    draw_two(a, u1, u2);
    ASPI_OPS(&a->mat->ndf).visible_n(&a->mat->ndf, n, x, y, z, u1, u2, m[0], m[1], m[2]);
    aspi_walk_scatter(n, m[0], m[1], m[2], x, y, z, c2);
    to.r = F[0];
    to.g = F[1];
    to.b = F[2];
    aspi_block_ones(ones);
    aspi_block_fresnel(a->mat, n, c2, ones, ones, to);
    aspi_walk_tint(n, F[0], a->ray[WALK_RED]);
    aspi_walk_tint(n, F[1], a->ray[WALK_GREEN]);
    aspi_walk_tint(n, F[2], a->ray[WALK_BLUE]);
}

/* Moves those rays together for which q is drawn or must be, because they lead deeper; draws their numbers. */
ASP_APART static size_t draw_flights(const walks *a, IN vz, IN area, int *place, int *drawn, int *deeper,
                                     asp_real f[FLIGHT_NUMBERS][ASP_BLOCK])
{
    size_t i, j, n = 0;
    for (i = 0; i < a->count; i++) {
        place[n] = (int)i;
        n += (a->drawn[i] != 0) | (vz[i] > R(0.0));
    }
    for (j = 0; j < n; j++) {
        i = (size_t)place[j];
        drawn[j] = a->drawn[i];
        deeper[j] = vz[i] > R(0.0);
        f[FLIGHT_L][j] = a->ray[WALK_L][i];
        f[FLIGHT_SEEN][j] = a->ray[WALK_SEEN][i];
        f[FLIGHT_HEIGHT][j] = a->ray[WALK_HEIGHT][i];
        f[FLIGHT_RISE][j] = aspi_abs(vz[i]);
        f[FLIGHT_AREA][j] = area[i];
        f[FLIGHT_OUT_AREA][j] = a->ray[WALK_OUT_AREA][i];
        f[FLIGHT_OUT_RISE][j] = a->ray[WALK_OUT_Z][i];
        f[FLIGHT_U0][j] = drawn[j] ? R(0.0) : aspi_next_uniform(a->next, state_of(a, i));
        f[FLIGHT_U1][j] = deeper[j] || area[i] > ASP_SMALLEST ? aspi_next_uniform(a->next, state_of(a, i)) : R(0.0);
    }
    return n;
}

ASP_FN void fly_drawn(walks *a, IN vz, IN area, IN D, OUT meets, OUT sent)
{
    asp_real f[FLIGHT_NUMBERS][ASP_BLOCK], out[3][ASP_BLOCK];
    int place[ASP_BLOCK], deeper[ASP_BLOCK], drawn[ASP_BLOCK];
    size_t j, n = draw_flights(a, vz, area, place, drawn, deeper, f);
    aspi_walk_flights(n, drawn, deeper, f, out[0], out[1], out[2]);
    for (j = 0; j < n; j++) {
        size_t i = (size_t)place[j];
        a->drawn[i] = 1;
        a->ray[WALK_L][i] = out[0][j];
        meets[i] = out[1][j];
        sent[i] = aspi_facets_send(D[i], out[2][j]);
    }
}

/* Writes down what every walk has sent so far, and moves those together that go on, by which `spare` is
 * positive. */
ASP_APART static void leave_walks(walks *a, IN spare, asp_c3s out)
{
    const asp_real *r = a->ray[WALK_SUM_RED], *g = a->ray[WALK_SUM_GREEN], *b = a->ray[WALK_SUM_BLUE];
    int on[ASP_BLOCK];
    size_t i, j, n = 0;
    if (a->in_order) {
        memcpy(out.r + a->element[0], r, a->count * sizeof *r);
        memcpy(out.g + a->element[0], g, a->count * sizeof *g);
        memcpy(out.b + a->element[0], b, a->count * sizeof *b);
    }
    for (i = 0; i < a->count && !a->in_order; i++) {
        size_t e = a->element[i];
        out.r[e] = r[i];
        out.g[e] = g[i];
        out.b[e] = b[i];
    }
    for (i = 0; i < a->count; i++) {
        on[n] = (int)i;
        n += spare[i] > R(0.0);
    }
    for (j = 0; j < n; j++)
        move_walk(a, (size_t)on[j], a, j);
    a->count = n;
    a->in_order = 0;
}

/* Roulette. */
ASP_APART static void roulette(walks *a, int met)
{
    size_t i, j = 0;
    for (i = 0; i < a->count; i++) {
        aspi_walker r = walk_at(a, i);
        if (aspi_survives(&r, met)) {
            put_walk(a, i, &r);
            move_walk(a, i, a, j++);
        }
    }
    a->count = j;
}

/* The first meeting of all rays. */
ASP_CLONES static void meet_walks(walks *a)
{
    asp_real D[ASP_BLOCK], between[ASP_BLOCK], sent[ASP_BLOCK], *seen = a->ray[WALK_SEEN];
    const asp_real *wz = a->ray[WALK_OUT_Z], *z = a->ray[WALK_Z];
    asp_mets to = { NULL, NULL, NULL, between, NULL, D, seen, a->ray[WALK_OUT_AREA] };
    asp_c3s all = { a->ray[WALK_SUM_RED], a->ray[WALK_SUM_GREEN], a->ray[WALK_SUM_BLUE] };
    size_t n = a->count;
    ASPI_OPS(&a->mat->ndf).meet_n(&a->mat->ndf, n, a->ray[WALK_X], a->ray[WALK_Y], z, a->ray[WALK_OUT_X],
                                  a->ray[WALK_OUT_Y], wz, &to);
    memcpy(a->ray[WALK_HEIGHT], z, n * sizeof *z);
    aspi_walk_begin(n, seen, z, to.area_out, wz, D, sent);
    aspi_block_fresnel(a->mat, n, between, sent, seen, all);
}

/* The next: walk.c's mirror_eval once round. */
ASP_CLONES static void turn_walks(walks *a, asp_c3s out)
{
    asp_real area[ASP_BLOCK], D[ASP_BLOCK], between[ASP_BLOCK], at[ASP_BLOCK], v[3][ASP_BLOCK], F[3][ASP_BLOCK];
    asp_real meets[ASP_BLOCK], sent[ASP_BLOCK], ones[ASP_BLOCK], *share = ones;
    asp_real *x = a->ray[WALK_X], *y = a->ray[WALK_Y], *z = a->ray[WALK_Z], *out_area = a->ray[WALK_OUT_AREA];
    asp_real *wx = a->ray[WALK_OUT_X], *wy = a->ray[WALK_OUT_Y], *wz = a->ray[WALK_OUT_Z];
    asp_real *r = a->ray[WALK_RED], *g = a->ray[WALK_GREEN], *b = a->ray[WALK_BLUE];
    asp_mets to = { v[0], at, v[1], between, v[2], D, area, NULL };
    asp_c3s carried = { r, g, b }, product = { F[0], F[1], F[2] };
    size_t n = a->count, i;
    int f;
    draw_three(a);
    for (f = 0; f < 3; f++)
        aspi_walk_below_1(n, a->u[f]);
    ASPI_OPS(&a->mat->ndf).turn_n(&a->mat->ndf, n, x, y, z, a->u[0], a->u[1], wx, wy, wz, &to);
    for (i = 0; i < n; i++)
        a->met[i]++;
    aspi_block_ones(ones);
    aspi_block_fresnel(a->mat, n, at, ones, ones, a->longest ? product : carried);
    if (a->longest++) {
        aspi_walk_tint(n, F[0], r);
        aspi_walk_tint(n, F[1], g);
        aspi_walk_tint(n, F[2], b);
    }
    aspi_walk_meet(n, area, v[2], a->ray[WALK_SEEN], a->ray[WALK_HEIGHT], out_area, wz, D, meets, sent);
    fly_drawn(a, v[2], area, D, meets, sent);
    aspi_block_fresnel(a->mat, n, between, sent, area, product);
    aspi_walk_sum(n, r, F[0], meets, a->ray[WALK_SUM_RED]);
    aspi_walk_sum(n, g, F[1], meets, a->ray[WALK_SUM_GREEN]);
    aspi_walk_sum(n, b, F[2], meets, a->ray[WALK_SUM_BLUE]);
    if (a->longest >= ASPI_WALK_SURE)
        aspi_walk_roulette(n, a->met, r, g, b, share = at);
    aspi_walk_spare(n, meets, share, a->u[2], sent);
    memcpy(x, v[0], n * sizeof *x);
    memcpy(y, v[1], n * sizeof *y);
    memcpy(z, v[2], n * sizeof *z);
    leave_walks(a, sent, out);
}

/* Moves a block's last walks to those of blocks before it: short loops cost most. Those go on as far as there must
 * be room. */
static void gather_walks(const walks *a, walks *late, asp_c3s out)
{
    size_t i;
    while (late->count + a->count > ASP_BLOCK)
        turn_walks(late, out);
    for (i = 0; i < a->count; i++)
        move_walk(a, i, late, late->count++);
    late->longest = a->longest > late->longest ? a->longest : late->longest;
}

/* Flies on; the rays that come out leave direction and colour. */
ASP_APART static void come_out(walks *a, IN area, IN meets, asp_real wo[3][ASP_BLOCK],
                               asp_real colour[3][ASP_BLOCK], int *came)
{
    size_t i, j = 0;
    for (i = 0; i < a->count; i++) {
        size_t e = a->element[i];
        int meets_one;
        if (a->drawn[i] | (a->ray[WALK_Z][i] > R(0.0))) {
            aspi_walker r = walk_at(a, i);
            meets_one = aspi_fly(&r, area[i]);
            put_walk(a, i, &r);
        } else {
            meets_one = aspi_next_uniform(a->next, state_of(a, i)) < meets[i];
        }
        if (meets_one) {
            move_walk(a, i, a, j++);
            continue;
        }
        came[e] = 1;
        wo[0][e] = -a->ray[WALK_X][i];
        wo[1][e] = -a->ray[WALK_Y][i];
        wo[2][e] = -a->ray[WALK_Z][i];
        colour[0][e] = a->ray[WALK_RED][i];
        colour[1][e] = a->ray[WALK_GREEN][i];
        colour[2][e] = a->ray[WALK_BLUE][i];
    }
    a->count = j;
}

ASP_CLONES static void sample_walks(walks *a, asp_real wo[3][ASP_BLOCK], asp_real colour[3][ASP_BLOCK], int *came)
{
    asp_real area[ASP_BLOCK], meets[ASP_BLOCK];
    int met;
    for (met = 0; a->count; met++) {
        if (met >= ASPI_WALK_SURE)
            roulette(a, met);
        area_seen(a->mat, a->count, R(1.0), a->ray[WALK_X], a->ray[WALK_Y], a->ray[WALK_Z], area);
        if (met == 0) {
            aspi_walk_first(a->count, area, a->ray[WALK_Z], a->ray[WALK_SEEN], a->ray[WALK_HEIGHT], meets);
        } else {
            aspi_walk_again(a->count, area, a->ray[WALK_Z], a->ray[WALK_SEEN], a->ray[WALK_HEIGHT], meets);
            come_out(a, area, meets, wo, colour, came);
        }
        scatter_walks(a);
    }
}

ASP_CLONES static void density_of_walks(const asp_mat *mat, size_t n, asp_cv3s wi, asp_cv3s wo, asp_real *pdf)
{
    asp_real area[ASP_BLOCK], m[3][ASP_BLOCK], c[ASP_BLOCK], D[ASP_BLOCK], p[ASP_BLOCK];
    size_t i;
    area_seen(mat, n, R(1.0), wi.x, wi.y, wi.z, area);
    aspi_walk_facets(n, wi.x, wi.y, wi.z, wo.x, wo.y, wo.z, m[0], m[1], m[2], c);
    ASPI_OPS(&mat->ndf).density_n(&mat->ndf, n, m[0], m[1], m[2], D);
    aspi_walk_densities(n, wi.z, wo.z, area, D, m[2], c, p);
    for (i = 0; i < n; i++) {
        asp_v3 v = aspi_at(wi.x, wi.y, wi.z, i), w = aspi_at(wo.x, wo.y, wo.z, i);
        p[i] = aspi_may_walk(mat, v, w) ? p[i] : aspi_walk_nothing(v, w);
    }
    memcpy(pdf, p, n * sizeof *pdf);
}

/* ---- batches */

void ASPI_CALL(asp_walk_eval_cos_n)(const asp_mat *mat, size_t n, asp_cv3s wi, asp_cv3s wo, asp_uniforms *next,
                                    void *states, size_t stride, asp_c3s out)
{
    size_t i, k, size;
    int alike = walks_alike(mat), may[ASP_BLOCK] = { 0 };
    walks a, late;
    begin(&a, mat, next, states, stride, WALK_NUMBERS);
    begin(&late, mat, next, states, stride, WALK_NUMBERS);
    ASPI_FOR_BLOCKS(i, size, n) {
        asp_cv3s from = ASPI_FROM(wi, i), to = ASPI_FROM(wo, i);
        if (alike)
            start_walks(&a, size, i, from, &to, may);
        for (k = 0; k < size && a.count < size; k++)
            if (!may[k]) {
                asp_v3 v = aspi_at(from.x, from.y, from.z, k), w = aspi_at(to.x, to.y, to.z, k);
                asp_c3 f = ASPI_CALL(asp_walk_eval_cos)(mat, v, w, next, a.states + (i + k) * stride);
                out.r[i + k] = f.r;
                out.g[i + k] = f.g;
                out.b[i + k] = f.b;
            }
        if (!a.count)
            continue;
        meet_walks(&a);
        do
            turn_walks(&a, out);
        while (a.count > ASP_BLOCK / 4);
        gather_walks(&a, &late, out);
    }
    while (late.count)
        turn_walks(&late, out);
}

void ASPI_CALL(asp_walk_sample_n)(const asp_mat *mat, size_t n, asp_cv3s wi, asp_uniforms *next, void *states,
                                  size_t stride, asp_v3s wo, asp_real *pdf, asp_c3s weight)
{
    size_t i, k, size;
    int alike = walks_alike(mat), may[ASP_BLOCK] = { 0 };
    ASPI_FOR_BLOCKS(i, size, n) {
        asp_real to[3][ASP_BLOCK], colour[3][ASP_BLOCK], p[ASP_BLOCK];
        asp_cv3s from = ASPI_FROM(wi, i), out;
        int came[ASP_BLOCK] = { 0 };
        walks a;
        out.x = to[0];
        out.y = to[1];
        out.z = to[2];
        begin(&a, mat, next, (char *)states + i * stride, stride, WALK_SAMPLED);
        if (alike) {
            /* what walks that are absorbed leave */
            memcpy(to[0], from.x, size * sizeof *to[0]);
            memcpy(to[1], from.y, size * sizeof *to[1]);
            memcpy(to[2], from.z, size * sizeof *to[2]);
            start_walks(&a, size, 0, from, NULL, may);
            sample_walks(&a, to, colour, came);
            density_of_walks(mat, size, from, out, p);
        }
        for (k = 0; k < size; k++) {
            asp_v3 v = aspi_at(from.x, from.y, from.z, k);
            if (!may[k]) {
                asp_sampled one = ASPI_CALL(asp_walk_sample)(mat, v, next, a.states + k * stride);
                to[0][k] = one.wo.x;
                to[1][k] = one.wo.y;
                to[2][k] = one.wo.z;
                p[k] = one.pdf;
                colour[0][k] = one.weight.r;
                colour[1][k] = one.weight.g;
                colour[2][k] = one.weight.b;
            } else if (!came[k]) {
                p[k] = colour[0][k] = colour[1][k] = colour[2][k] = aspi_walk_nothing(v, v);
            }
        }
        aspi_put_rows(wo, i, size, to);
        memcpy(pdf + i, p, size * sizeof *pdf);
        memcpy(weight.r + i, colour[0], size * sizeof *weight.r);
        memcpy(weight.g + i, colour[1], size * sizeof *weight.g);
        memcpy(weight.b + i, colour[2], size * sizeof *weight.b);
    }
}

void ASPI_CALL(asp_walk_pdf_n)(const asp_mat *mat, size_t n, asp_cv3s wi, asp_cv3s wo, asp_real *out)
{
    size_t i, size;
    if (walks_alike(mat)) {
        ASPI_FOR_BLOCKS(i, size, n)
            density_of_walks(mat, size, ASPI_FROM(wi, i), ASPI_FROM(wo, i), out + i);
        return;
    }
    for (i = 0; i < n; i++)
        out[i] = ASPI_CALL(asp_walk_pdf)(mat, aspi_at(wi.x, wi.y, wi.z, i), aspi_at(wo.x, wo.y, wo.z, i));
}

#undef IN
#undef OUT
#endif
