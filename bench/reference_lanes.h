/* reference_lanes.h - the hand-written kernel over one instruction set's lanes
 *
 * Read once per instruction set by reference.c, which defines what V, ADD, MUL, ... are. A block goes
 * through three stages, so that each keeps its values in registers:
 *     1  stretch wi, sample the spherical cap, reflect
 *     2  D, projected areas, masking: pdf and weight without the Fresnel term
 *     3  the Fresnel term per channel */

/* cos and sin of 2 pi u, u in [0, 1): the nearest quarter turn is taken off, then Taylor's. */
static LANES void FN(turn)(V u, V *c, V *s)
{
    V shifted = FMA(u, SET(4.0f), SET(12582912.0f));
    V quarter = SUB(shifted, SET(12582912.0f));
    V x = MUL(FMA(quarter, SET(-0.25f), u), SET(6.28318531f));
    V z = MUL(x, x);
    V sn = FMA(SET(2.7557319e-6f), z, SET(-1.9841270e-4f));
    V cs = FMA(SET(-2.7557319e-7f), z, SET(2.4801587e-5f));
    sn = FMA(sn, z, SET(8.3333333e-3f));
    cs = FMA(cs, z, SET(-1.3888889e-3f));
    sn = FMA(sn, z, SET(-1.6666667e-1f));
    cs = FMA(cs, z, SET(4.1666667e-2f));
    sn = FMA(MUL(sn, z), x, x);
    cs = FMA(FMA(cs, z, SET(-0.5f)), z, SET(1.0f));
    TURN(shifted, cs, sn, c, s);
}

/* Exact unpolarised reflectance of a conductor with one division. */
static LANES V FN(conductor)(V c, V eta, V k)
{
    V c2 = MUL(c, c);
    V s2 = SUB(SET(1.0f), c2);
    V e2 = MUL(eta, eta), k2 = MUL(k, k);
    V t0 = SUB(SUB(e2, k2), s2);
    V m = SQRT(FMA(t0, t0, MUL(SET(4.0f), MUL(e2, k2))));
    V a = SQRT(MAX(SET(0.0f), MUL(SET(0.5f), ADD(m, t0))));
    V t1 = ADD(m, c2);
    V t2 = MUL(MUL(SET(2.0f), a), c);
    V t3 = FMA(c2, m, MUL(s2, s2));
    V t4 = MUL(t2, s2);
    return DIV(MUL(SUB(t1, t2), t3), MUL(ADD(t1, t2), ADD(t3, t4)));
}

static LANES void FN(batch)(const reference_conductor *k, size_t n, const reference_arrays *a)
{
    enum { BLOCK = 256 };
    float facet2[BLOCK], scaled[BLOCK], cosine[BLOCK], plain[BLOCK];
    V ax = SET(k->alpha_x), ay = SET(k->alpha_y);
    V four_pi_axay = SET(12.5663706f * k->alpha_x * k->alpha_y);
    size_t begin, i, size;
    int channel;

    for (begin = 0; begin < n; begin += BLOCK) {
        size = n - begin < BLOCK ? n - begin : BLOCK;
        for (i = 0; i < size; i += WIDTH) {
            size_t j = begin + i;
            V wx = LOAD(a->wi_x + j), wy = LOAD(a->wi_y + j), wz = LOAD(a->wi_z + j);
            V u1 = LOAD(a->u1 + j);
            V vx = MUL(ax, wx), vy = MUL(ay, wy), s2, h, inv, up, d, r, c, s, mx, my, mz, dot, m2, k2;
            s2 = FMA(vx, vx, MUL(vy, vy));
            h = SQRT(FMA(wz, wz, s2));
            inv = DIV(SET(1.0f), h);
            up = FMA(wz, inv, SET(1.0f));
            d = MUL(u1, up);
            r = SQRT(MUL(d, MAX(SUB(SET(2.0f), d), SET(0.0f))));
            FN(turn)(LOAD(a->u2 + j), &c, &s);
            mx = FMA(r, c, MUL(vx, inv));
            my = FMA(r, s, MUL(vy, inv));
            mz = SUB(up, d);
            /* |m'|^2 of the standard facet, then the facet itself, not normalised */
            m2 = FMA(mx, mx, FMA(my, my, MUL(mz, mz)));
            mx = MUL(ax, mx);
            my = MUL(ay, my);
            k2 = FMA(mx, mx, FMA(my, my, MUL(mz, mz)));
            dot = FMA(mx, wx, FMA(my, wy, MUL(mz, wz)));
            inv = DIV(SET(1.0f), k2);
            d = MUL(MUL(SET(2.0f), dot), inv);
            STORE(a->wo_x + j, FMA(d, mx, NEG(wx)));
            STORE(a->wo_y + j, FMA(d, my, NEG(wy)));
            STORE(a->wo_z + j, FMA(d, mz, NEG(wz)));
            STORE(facet2 + i, MUL(m2, inv));
            STORE(cosine + i, MIN(MUL(dot, SQRT(inv)), SET(1.0f)));
            STORE(scaled + i, MUL(SET(0.5f), ADD(h, wz)));
        }
        for (i = 0; i < size; i += WIDTH) {
            size_t j = begin + i;
            V wiz = LOAD(a->wi_z + j), woz = LOAD(a->wo_z + j);
            V ox = MUL(ax, LOAD(a->wo_x + j)), oy = MUL(ay, LOAD(a->wo_y + j));
            V so = MUL(SET(0.5f), ADD(SQRT(FMA(ox, ox, FMA(oy, oy, MUL(woz, woz)))), woz));
            V si = LOAD(scaled + i), f2 = LOAD(facet2 + i);
            V g = DIV(MUL(si, woz), FMA(si, woz, MUL(wiz, SUB(so, woz))));
            V p = DIV(SET(1.0f), MUL(MUL(four_pi_axay, si), MUL(f2, f2)));
            STORE(a->pdf + j, p);
            STORE(plain + i, KEEP_POSITIVE(woz, g));
        }
        for (channel = 0; channel < 3; channel++) {
            float *out = channel == 0 ? a->r : channel == 1 ? a->g : a->b;
            V eta = SET(k->eta[channel]), kk = SET(k->k[channel]);
            for (i = 0; i < size; i += WIDTH)
                STORE(out + begin + i, MUL(LOAD(plain + i), FN(conductor)(LOAD(cosine + i), eta, kk)));
        }
    }
}
