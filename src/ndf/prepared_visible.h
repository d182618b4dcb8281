/* prepared_visible.h - plain and visible normals of a prepared surface; read by prepared_kernel.h */

#ifndef PREPARED_VISIBLE_NAMES
#define PREPARED_VISIBLE_NAMES
#define prepared_odds ASP_NDF_NAME(_prepared_odds)
#define prepared_within ASP_NDF_NAME(_prepared_within)
#define prepared_beyond ASP_NDF_NAME(_prepared_beyond)
#define prepared_plain ASP_NDF_NAME(_prepared_plain)
#define prepared_plains ASP_NDF_NAME(_prepared_plains)
#define prepared_drawn ASP_NDF_NAME(_prepared_drawn)
#define prepared_around ASP_NDF_NAME(_prepared_around)
#define prepared_normals ASP_NDF_NAME(_prepared_normals)
#define prepared_look ASP_NDF_NAME(_prepared_look)
#define prepared_seen ASP_NDF_NAME(_prepared_seen)
#define prepared_draw ASP_NDF_NAME(_prepared_draw)
#define prepared_begin ASP_NDF_NAME(_prepared_begin)
#define prepared_ring ASP_NDF_NAME(_prepared_ring)
#define prepared_inner ASP_NDF_NAME(_prepared_inner)
#define prepared_tail ASP_NDF_NAME(_prepared_tail)
#define prepared_outer ASP_NDF_NAME(_prepared_outer)
#define prepared_facet ASP_NDF_NAME(_prepared_facet)
#define prepared_block ASP_NDF_NAME(_prepared_block)
#define prepared_tails ASP_NDF_NAME(_prepared_tails)
#define prepared_collect ASP_NDF_NAME(_prepared_collect)
#define prepared_find ASP_NDF_NAME(_prepared_find)
#define prepared_put ASP_NDF_NAME(_prepared_put)
#define prepared_azimuths ASP_NDF_NAME(_prepared_azimuths)
#define prepared_visibles ASP_NDF_NAME(_prepared_visibles)
#define PREPARED_NORMAL_FROM ASP_PIECES_FROM(PREPARED_NORMAL_OCTAVE)
/* Shorter views count as straight from above. */
#define PREPARED_UPRIGHT (ASP_PRECISION == 64 ? R(1e-200) : R(1e-30))
/* Elements at a time; tails are padded to whole vectors. */
#define PREPARED_DRAWN (ASP_PRECISION == 64 ? 128 : 256)
#define PREPARED_LANES (ASP_PRECISION == 64 ? 4 : 8)
#endif

/* x = sqrt(within/beyond), of which NORMAL is a table; both shares of any common scale. */
ASP_FN asp_real prepared_odds(asp_real within, asp_real beyond)
{
    return aspi_sqrt(aspi_max(within, PREPARED_TINY) / aspi_max(beyond, PREPARED_TINY));
}

/* Radius of the slope with the odds x, from x up to PREPARED_NORMAL_LAST, and what it is times beyond; it may be
 * below 0 by rounding. */
ASP_FN asp_real prepared_within(asp_real x) { return aspi_min(x, R(PREPARED_NORMAL_LAST)); }

ASP_FN asp_real prepared_beyond(const asp_shape *k, asp_real x)
{
    asp_real far = x * R(1.0 / PREPARED_NORMAL_LAST);
    return aspi_exp(k->table[PREPARED_NORMAL_END] * aspi_log(far));
}

ASP_FN asp_real prepared_plain(const asp_shape *k, asp_real x)
{
    asp_real in = prepared_within(x), r = aspi_pieces(k->table + PREPARED_NORMAL, PREPARED_NORMAL_FROM, in, in);
    return x > R(PREPARED_NORMAL_LAST) ? r * prepared_beyond(k, x) : r;
}

/* What is to be added to radii that the table gave: nothing, but for the rare odds beyond it. */
ASP_FN void prepared_plains(const asp_shape *k, size_t n, asp_bits beyond, const asp_real *ASP_RESTRICT x,
                            const asp_real *ASP_RESTRICT in, asp_real *ASP_RESTRICT r)
{
    size_t i;
    aspi_pieces_n(k->table + PREPARED_NORMAL, PREPARED_NORMAL_FROM, n, in, in, r);
    if (!(beyond >> (8 * sizeof beyond - 1)))
        return;
    for (i = 0; i < n; i++)
        r[i] = aspi_select(x[i] > R(PREPARED_NORMAL_LAST), r[i] * prepared_beyond(k, x[i]), r[i]);
}

#ifndef ASP_OWN_NORMAL
ASP_FN asp_real prepared_drawn(asp_real u1)
{
    asp_real last = R(1.0) - (ASP_PRECISION == 64 ? R(0x1p-53) : R(0x1p-24));
    asp_real u = aspi_select(u1 > last, last, u1);
    return prepared_odds(u, R(1.0) - u);
}

ASP_FN asp_v3 prepared_around(asp_real r, asp_real u2)
{
    asp_v2 t = aspi_sincos2pi(u2);
    return aspi_vector(r * t.x, r * t.y, R(1.0));
}

ASP_FN asp_v3 ndf_normal(const asp_shape *k, asp_real u1, asp_real u2)
{
    return prepared_around(prepared_plain(k, prepared_drawn(u1)), u2);
}

ASP_FN void prepared_normals(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT u1,
                             const asp_real *ASP_RESTRICT u2, asp_real *ASP_RESTRICT mx, asp_real *ASP_RESTRICT my,
                             asp_real *ASP_RESTRICT mz)
{
    asp_real x[PREPARED_DRAWN], in[PREPARED_DRAWN], r[PREPARED_DRAWN];
    asp_bits beyond = 0;
    size_t i;
    for (i = 0; i < n; i++) {
        x[i] = prepared_drawn(u1[i]);
        in[i] = prepared_within(x[i]);
        beyond |= aspi_to_bits(R(PREPARED_NORMAL_LAST) - x[i]);
    }
    prepared_plains(k, n, beyond, x, in, r);
    for (i = 0; i < n; i++) {
        asp_v3 m = aspi_normalize(aspi_facet_back(k, prepared_around(r[i], u2[i])));
        mx[i] = m.x;
        my[i] = m.y;
        mz[i] = m.z;
    }
}

#define ASP_OWN_NORMAL_N
ASP_CLONES static void ndf_normal_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT u1,
                                    const asp_real *ASP_RESTRICT u2, asp_real *ASP_RESTRICT mx,
                                    asp_real *ASP_RESTRICT my, asp_real *ASP_RESTRICT mz)
{
    size_t from;
    for (from = 0; from < n; from += PREPARED_DRAWN)
        prepared_normals(k, n - from < PREPARED_DRAWN ? n - from : PREPARED_DRAWN, u1 + from, u2 + from, mx + from,
                         my + from, mz + from);
}
#endif

/* A view in the standard frame, of any length: its height and horizontal length, where it stands in AREA as in
 * prepared_place, and the direction of its horizontal part. */
typedef struct prepared_look {
    asp_real c, s, a, q, y, x_axis, y_axis;
} prepared_look;

ASP_FN prepared_look prepared_seen(const asp_shape *k, asp_v3 v)
{
    asp_real s2 = v.x * v.x + v.y * v.y, t0 = k->table[PREPARED_SCALE], h = aspi_abs(v.z), sum, inverse, turn;
    int known = s2 > PREPARED_UPRIGHT;
    prepared_look out;
    out.c = v.z;
    out.s = aspi_sqrt(aspi_max(s2, PREPARED_UPRIGHT));
    out.a = out.s * t0;
    sum = h + out.a;
    inverse = R(1.0) / aspi_max(out.a * sum, ASP_TINY);       /* one division for three */
    out.q = h * sum * inverse;
    out.y = out.a * out.a * inverse;
    turn = t0 * sum * inverse;
    out.x_axis = aspi_select(known, v.x, out.s) * turn;
    out.y_axis = aspi_select(known, v.y, R(0.0)) * turn;
    return out;
}

/* What is drawn: sigma = c + far. The share c of it, if c > 0, is drawn from all normals,
 * and the share `far` from those that a view below the mean plane sees: the integrals over the azimuth of
 * max(0, c + s x) and max(0, -c - s x), x a slope along the view, differ by 2 pi c. The first goes outwards with u1 and
 * the second comes back, so that the map is continuous; given the radius the azimuth is the same for both. They
 * meet at the radius PREPARED_EDGE, where both stop. */
typedef struct prepared_draw {
    asp_real inner;              /* positive: from all normals */
    asp_real odds;               /* of the shares that are drawn */
} prepared_draw;

ASP_FN prepared_draw prepared_begin(asp_real c, asp_real far, asp_real u1)
{
    asp_real up = aspi_max(c, R(0.0)), sigma = aspi_select(c > R(0.0), up + far, R(1.0));
    prepared_draw d;
    d.inner = up - u1 * sigma;
    d.odds = prepared_odds(sigma * aspi_select(d.inner > R(0.0), u1, R(1.0) - u1), aspi_abs(d.inner));
    return d;
}

/* A ring of slopes as the azimuth is drawn from it: density c + g cos(phi), root = sqrt(g^2 - c^2), or 0. The
 * slope is g/s. */
typedef struct prepared_ring {
    asp_real g, root;
} prepared_ring;

ASP_FN prepared_ring prepared_inner(const asp_shape *k, asp_real c, asp_real s, asp_real radius)
{
    prepared_ring out;
    out.g = s * aspi_min(aspi_max(radius, R(0.0)), k->table[PREPARED_EDGE]);
    out.root = aspi_sqrt(aspi_max((out.g - c) * (out.g + c), R(0.0)));
    return out;
}

ASP_FN prepared_ring prepared_outer(const asp_shape *k, asp_real c, asp_real s, asp_real unit, asp_real log_eta)
{
    asp_real edge = s * k->table[PREPARED_EDGE];
    asp_real most = aspi_select(c > R(0.0), aspi_sqrt(aspi_max((edge - c) * (edge + c), R(0.0))), PREPARED_HUGE);
    prepared_ring out;
    out.root = aspi_min(unit * aspi_exp(log_eta), most);
    out.g = aspi_sqrt(c * c + out.root * out.root);
    return out;
}

ASP_FN prepared_ring prepared_tail(const asp_shape *k, asp_real c, asp_real s, asp_real odds)
{
    prepared_far_view w = prepared_tail_place(k, aspi_abs(c), s, odds);
    return prepared_outer(k, c, s, w.unit, w.more + prepared_tail_at(k, w.view, w.in_view, w.share, w.in_share));
}

ASP_FN asp_v3 prepared_facet(asp_real x_axis, asp_real y_axis, asp_real g, asp_real s, asp_v2 turn)
{
    asp_v3 m;
    m.x = g * (turn.x * x_axis - turn.y * y_axis);
    m.y = g * (turn.x * y_axis + turn.y * x_axis);
    m.z = s;
    return m;
}

ASP_FN asp_v3 ndf_visible(const asp_shape *k, asp_v3 v, asp_real u1, asp_real u2)
{
    prepared_look w = prepared_seen(k, v);
    asp_real area = aspi_pieces(k->table + PREPARED_AREA, PREPARED_AREA_FROM, w.q, w.y);
    prepared_draw d = prepared_begin(w.c, w.a * w.y * aspi_max(area, R(0.0)), u1);
    prepared_ring ring = d.inner > R(0.0) ? prepared_inner(k, w.c, w.s, prepared_plain(k, d.odds))
                                          : prepared_tail(k, w.c, w.s, d.odds);
    prepared_way way = prepared_aim(w.c, ring.g, ring.root, u2);
    return prepared_facet(w.x_axis, w.y_axis, ring.g, w.s, prepared_turn(way, prepared_step(way), u2));
}

/* The same in loops over blocks: all as if drawn from all normals, those that are not are collected and drawn again.
 * What is done for these few in three loops, each of which waits for the one before, stands between the loops over all. */
typedef struct prepared_block {
    asp_real c[PREPARED_DRAWN], s[PREPARED_DRAWN], a[PREPARED_DRAWN], q[PREPARED_DRAWN], y[PREPARED_DRAWN];
    asp_real x_axis[PREPARED_DRAWN], y_axis[PREPARED_DRAWN], odds[PREPARED_DRAWN], g[PREPARED_DRAWN];
} prepared_block;

typedef struct prepared_tails {
    size_t count, padded;
    int outer[PREPARED_DRAWN], place[PREPARED_DRAWN + ASP_PLACES_MORE];
    int view[PREPARED_DRAWN], share[PREPARED_DRAWN];
    asp_real c[PREPARED_DRAWN], s[PREPARED_DRAWN], odds[PREPARED_DRAWN], unit[PREPARED_DRAWN];
    asp_real in_view[PREPARED_DRAWN], in_share[PREPARED_DRAWN], log_eta[PREPARED_DRAWN];
} prepared_tails;

ASP_FN void prepared_collect(const asp_shape *k, size_t n, const prepared_block *b, prepared_tails *t)
{
    size_t i, count = aspi_places_n(n, t->outer, t->place);
    t->count = count;
    t->padded = n = (count + PREPARED_LANES - 1) / PREPARED_LANES * PREPARED_LANES;
    for (i = count; i < n; i++)
        t->place[i] = t->place[0];
    for (i = 0; i < t->padded; i++) {
        t->c[i] = b->c[t->place[i]];
        t->s[i] = b->s[t->place[i]];
        t->odds[i] = b->odds[t->place[i]];
    }
    for (i = 0; i < n; i++) {
        prepared_far_view w = prepared_tail_place(k, aspi_abs(t->c[i]), t->s[i], t->odds[i]);
        t->view[i] = w.view;
        t->share[i] = w.share;
        t->in_view[i] = w.in_view;
        t->in_share[i] = w.in_share;
        t->log_eta[i] = w.more;
        t->unit[i] = w.unit;
    }
}

ASP_FN void prepared_find(const asp_shape *k, prepared_tails *t)
{
    size_t i;
    for (i = 0; i < t->count; i++)
        t->log_eta[i] += prepared_tail_at(k, t->view[i], t->in_view[i], t->share[i], t->in_share[i]);
}

ASP_FN void prepared_put(const asp_shape *k, prepared_tails *t, prepared_block *b)
{
    size_t i, n = t->padded;
    for (i = 0; i < n; i++) {
        prepared_ring ring = prepared_outer(k, t->c[i], t->s[i], t->unit[i], t->log_eta[i]);
        t->unit[i] = ring.g;
        t->log_eta[i] = ring.root;
    }
    for (i = 0; i < t->count; i++) {
        b->g[t->place[i]] = t->unit[i];
        b->q[t->place[i]] = t->log_eta[i];
    }
}

/* From c, g and root as .q to cos and sin as .a and .y; in steps, which the processor overlaps. What the block no longer
 * needs is overwritten: all of it stays close. */
ASP_FN void prepared_azimuths(size_t n, prepared_block *block, const asp_real *ASP_RESTRICT u2)
{
    asp_real *a = block->a, *b = block->y, *sum = block->odds, *phi = block->q;
    asp_real target[PREPARED_DRAWN], end[PREPARED_DRAWN];
    asp_real cosine[PREPARED_DRAWN], sine[PREPARED_DRAWN], slope[PREPARED_DRAWN];
    size_t i;
    for (i = 0; i < n; i++) {
        prepared_way w = prepared_aim(block->c[i], block->g[i], block->q[i], u2[i]);
        a[i] = w.a;
        b[i] = w.b;
        sum[i] = w.sum;
        target[i] = w.target;
        phi[i] = w.phi;
        end[i] = w.end;
    }
    for (i = 0; i < n; i++) {
        prepared_way w = { a[i], b[i], sum[i], target[i], phi[i], end[i] };
        prepared_near near = prepared_step(w);
        cosine[i] = near.cosine;
        sine[i] = near.sine;
        phi[i] = near.phi;
        slope[i] = near.slope;
    }
    for (i = 0; i < n; i++) {
        prepared_way w = { a[i], b[i], sum[i], target[i], phi[i], end[i] };
        prepared_near near = { cosine[i], sine[i], phi[i], slope[i] };
        asp_v2 turn = prepared_turn(w, near, u2[i]);
        block->a[i] = turn.x;
        block->y[i] = turn.y;
    }
}

ASP_FN void prepared_visibles(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT wx,
                              const asp_real *ASP_RESTRICT wy, const asp_real *ASP_RESTRICT wz,
                              const asp_real *ASP_RESTRICT u1, const asp_real *ASP_RESTRICT u2,
                              asp_real *ASP_RESTRICT mx, asp_real *ASP_RESTRICT my, asp_real *ASP_RESTRICT mz)
{
    prepared_block b;
    prepared_tails t;
    asp_real found[PREPARED_DRAWN];
    asp_bits beyond = 0;
    size_t i;
    for (i = 0; i < n; i++) {
        prepared_look w = prepared_seen(k, aspi_view(k, aspi_at(wx, wy, wz, i)));
        b.c[i] = w.c;
        b.s[i] = w.s;
        b.a[i] = w.a;
        b.q[i] = w.q;
        b.y[i] = w.y;
        b.x_axis[i] = w.x_axis;
        b.y_axis[i] = w.y_axis;
    }
    aspi_pieces_n(k->table + PREPARED_AREA, PREPARED_AREA_FROM, n, b.q, b.y, found);
    for (i = 0; i < n; i++) {
        prepared_draw d = prepared_begin(b.c[i], b.a[i] * b.y[i] * aspi_max(found[i], R(0.0)), u1[i]);
        t.outer[i] = !(d.inner > R(0.0));
        b.odds[i] = d.odds;
        b.a[i] = prepared_within(d.odds);
        beyond |= aspi_to_bits(R(PREPARED_NORMAL_LAST) - d.odds);
    }
    prepared_collect(k, n, &b, &t);
    prepared_plains(k, n, beyond, b.odds, b.a, found);
    prepared_find(k, &t);
    for (i = 0; i < n; i++) {
        prepared_ring ring = prepared_inner(k, b.c[i], b.s[i], found[i]);
        b.g[i] = ring.g;
        b.q[i] = ring.root;
    }
    prepared_put(k, &t, &b);
    prepared_azimuths(n, &b, u2);
    for (i = 0; i < n; i++) {
        asp_v2 turn;
        asp_v3 m;
        turn.x = b.a[i];
        turn.y = b.y[i];
        m = prepared_facet(b.x_axis[i], b.y_axis[i], b.g[i], b.s[i], turn);
        m = aspi_normalize(aspi_facet_back(k, m));
        mx[i] = m.x;
        my[i] = m.y;
        mz[i] = m.z;
    }
}

#define ASP_OWN_VISIBLE_N
ASP_CLONES static void ndf_visible_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT wx,
                                     const asp_real *ASP_RESTRICT wy,
                                     const asp_real *ASP_RESTRICT wz,
                                     const asp_real *ASP_RESTRICT u1,
                                     const asp_real *ASP_RESTRICT u2, asp_real *ASP_RESTRICT mx,
                                     asp_real *ASP_RESTRICT my, asp_real *ASP_RESTRICT mz)
{
    size_t from;
    for (from = 0; from < n; from += PREPARED_DRAWN)
        prepared_visibles(k, n - from < PREPARED_DRAWN ? n - from : PREPARED_DRAWN, wx + from, wy + from, wz + from,
                          u1 + from, u2 + from, mx + from, my + from, mz + from);
}
