/* prepared_sigma.h - the projected area of a prepared surface; read by prepared_kernel.h */

#ifndef PREPARED_SIGMA_NAMES
#define PREPARED_SIGMA_NAMES
#define prepared_sigma_block ASP_NDF_NAME(_prepared_sigma_block)
#define prepared_place ASP_NDF_NAME(_prepared_place)
#define prepared_far ASP_NDF_NAME(_prepared_far)
#define prepared_below ASP_NDF_NAME(_prepared_below)
#define prepared_deep ASP_NDF_NAME(_prepared_deep)
#define prepared_is_deep ASP_NDF_NAME(_prepared_is_deep)
#define PREPARED_AREA_FROM ASP_PIECES_FROM(PREPARED_AREA_OCTAVE)
#define PREPARED_DEEP_FROM ASP_PIECES_FROM(PREPARED_DEEP_OCTAVE)
#define PREPARED_DEEP_Y(y) aspi_max(y, R(1e-30))
#endif

#ifndef PREPARED_OWN_SIGMA
/* q = h/a and y = a/(h + a) = 1/(1 + q), a = s T0, as .x and .y, with .z = a; b = a^2. */
ASP_FN asp_v3 prepared_place(asp_real h, asp_real b)
{
    asp_real a = aspi_sqrt(b), sum = h + a;
    asp_real inverse = R(1.0) / aspi_max(a * sum, ASP_TINY);       /* one division for two */
    return aspi_vector(h * sum * inverse, b * inverse, a);
}

/* s J(|w|/s) for the larger part of sigma, through E: relative to sigma its error is that of E. */
ASP_FN asp_real prepared_far(const asp_shape *k, asp_real h, asp_real b)
{
    asp_v3 p = prepared_place(h, b);
    asp_real area = aspi_pieces(k->table + PREPARED_AREA, PREPARED_AREA_FROM, p.x, p.y);
    return p.z * p.y * aspi_max(area, R(0.0));
}

/* The same relative to itself; deep: what DEEP holds. */
#ifdef PREPARED_BENT
ASP_FN asp_real prepared_below(const asp_shape *k, asp_real h, asp_real s2, asp_real a, asp_real y, asp_real deep)
{
    asp_real beyond = aspi_log(aspi_min(y * R(1 / PREPARED_DEEP_LAST), R(1.0)));
    (void)h;
    (void)s2;
    return a * aspi_exp(deep + k->table[PREPARED_FALL] * beyond);
}
#else
ASP_FN asp_real prepared_below(const asp_shape *k, asp_real h, asp_real s2, asp_real a, asp_real y, asp_real deep)
{
    asp_real g = a / aspi_max(deep, R(1e-30)), z2 = aspi_max(s2, ASP_PRECISION == 64 ? R(1e-150) : R(1e-18));
    asp_real d = ndf_density(k, h * h, z2) * s2;
    (void)y;
    return d * (g * g) * aspi_sqrt(g * (h + a));
}
#endif

ASP_FN asp_real prepared_deep(const asp_shape *k, asp_real h, asp_real s2, asp_real b)
{
    asp_v3 p = prepared_place(h, b);
    asp_real y = PREPARED_DEEP_Y(p.y);
    return prepared_below(k, h, s2, p.z, y, aspi_pieces(k->table + PREPARED_DEEP, PREPARED_DEEP_FROM, p.x, y));
}

/* Where `far` no longer is good enough relative to itself. */
ASP_FN int prepared_is_deep(asp_real w, asp_real b) { return w < R(0.0) && R(2.0) * (w * w) > b; }

/* sigma = max(w, 0) + s J(|w|/s). */
ASP_FN asp_real ndf_sigma(const asp_shape *k, asp_real w, asp_real s2)
{
    asp_real h = aspi_abs(w), b = s2 * k->table[PREPARED_SCALE2];
    if (prepared_is_deep(w, b))
        return prepared_deep(k, h, s2, b);
    return aspi_max(w, R(0.0)) + prepared_far(k, h, b);
}

/* The same in loops, in stages: the pieces are looked up in a loop of their own, and a block without views from
 * below skips their part. */
ASP_FN void prepared_sigma_block(const asp_shape *k, size_t n, asp_real sign, const asp_real *ASP_RESTRICT wx,
                                 const asp_real *ASP_RESTRICT wy, const asp_real *ASP_RESTRICT wz,
                                 asp_real *ASP_RESTRICT out)
{
    asp_real w[PREPARED_BLOCK], s2[PREPARED_BLOCK], a[PREPARED_BLOCK];
    asp_real q[PREPARED_BLOCK], y[PREPARED_BLOCK], found[PREPARED_BLOCK];
    asp_bits signs = 0;
    size_t i;
    if (!n)
        return;
    for (i = 0; i < n; i++) {
        asp_v3 v = aspi_view(k, aspi_vector(sign * wx[i], sign * wy[i], sign * wz[i])), p;
        w[i] = v.z;
        s2[i] = aspi_length2(v);
        p = prepared_place(aspi_abs(v.z), s2[i] * k->table[PREPARED_SCALE2]);
        q[i] = p.x;
        y[i] = p.y;
        a[i] = p.z;
    }
    aspi_pieces_n(k->table + PREPARED_AREA, PREPARED_AREA_FROM, n, q, y, found);
    for (i = 0; i < n; i++) {
        signs |= aspi_to_bits(w[i]);
        out[i] = aspi_max(w[i], R(0.0)) + a[i] * y[i] * aspi_max(found[i], R(0.0));
    }
    if (!(signs >> (8 * sizeof signs - 1)))
        return;
    for (i = 0; i < n; i++)
        y[i] = PREPARED_DEEP_Y(y[i]);
    aspi_pieces_n(k->table + PREPARED_DEEP, PREPARED_DEEP_FROM, n, q, y, found);
    for (i = 0; i < n; i++) {
        asp_real below = prepared_below(k, aspi_abs(w[i]), s2[i], a[i], y[i], found[i]);
        out[i] = aspi_select(prepared_is_deep(w[i], s2[i] * k->table[PREPARED_SCALE2]), below, out[i]);
    }
}

#define ASP_OWN_SIGMA_N
ASP_CLONES static void ndf_sigma_n(const asp_shape *k, size_t n, asp_real sign,
                                   const asp_real *ASP_RESTRICT wx, const asp_real *ASP_RESTRICT wy,
                                   const asp_real *ASP_RESTRICT wz, asp_real *ASP_RESTRICT out)
{
    size_t from;
    for (from = 0; from < n; from += PREPARED_BLOCK)
        prepared_sigma_block(k, n - from < PREPARED_BLOCK ? n - from : PREPARED_BLOCK, sign, wx + from, wy + from,
                             wz + from, out + from);
}
#endif
