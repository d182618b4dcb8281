/* prepared_sigma.h - the projected area of a prepared surface; read by prepared_kernel.h */

#ifndef PREPARED_SIGMA_NAMES
#define PREPARED_SIGMA_NAMES
#define prepared_far ASP_NDF_NAME(_prepared_far)
#define prepared_below ASP_NDF_NAME(_prepared_below)
#define prepared_deep ASP_NDF_NAME(_prepared_deep)
#define prepared_view ASP_NDF_NAME(_prepared_view)
#endif

#ifndef PREPARED_OWN_SIGMA
/* s J(|w|/s) for the larger part of sigma, w >= 0, through E: relative to sigma its error is that of E. */
ASP_FN asp_real prepared_far(const asp_shape *k, asp_real h, asp_real b)
{
    asp_real x = aspi_sqrt(h), sum = x + aspi_sqrt(aspi_sqrt(b)), up = h + aspi_sqrt(h * h + b);
    asp_real inverse = R(1.0) / aspi_max(sum * up, PREPARED_TINY);       /* one division for two */
    asp_real v = x * up * inverse * R(PREPARED_AREA_CELLS);
    asp_real area = prepared_spline_at(k->table + PREPARED_AREA, PREPARED_AREA_CELLS, v);
    return R(0.5) * b * sum * inverse * aspi_max(area, R(0.0));
}

/* q^(1/4)/(1 + q^(1/4)). */
ASP_FN asp_real prepared_view(asp_real h, asp_real b)
{
    asp_real y = aspi_sqrt(aspi_sqrt(aspi_sqrt(b))), x = aspi_sqrt(aspi_sqrt(h));
    return x / aspi_max(x + y, PREPARED_TINY);
}

/* The same relative to itself, through the density. */
ASP_FN asp_real prepared_below(const asp_shape *k, asp_real h, asp_real s2, asp_real b)
{
    asp_real v = prepared_view(h, b) * R(PREPARED_BELOW_CELLS);
    asp_real l2 = h * h + b, z2 = aspi_max(s2, ASP_PRECISION == 64 ? R(1e-150) : R(1e-18));
    asp_real d = ndf_density(k, h * h, z2) * s2;
    return d * (l2 * aspi_sqrt(l2))
         * aspi_exp(prepared_spline_at(k->table + PREPARED_BELOW, PREPARED_BELOW_CELLS, v));
}

/* Where `far` no longer is good enough relative to itself. */
ASP_FN int prepared_deep(asp_real w, asp_real b) { return w < R(0.0) && R(2.0) * (w * w) > b; }

/* sigma = max(w, 0) + s J(|w|/s). */
ASP_FN asp_real ndf_sigma(const asp_shape *k, asp_real w, asp_real s2)
{
    asp_real h = aspi_abs(w), b = s2 * k->table[PREPARED_SCALE2];
    return prepared_deep(w, b) ? prepared_below(k, h, s2, b) : aspi_max(w, R(0.0)) + prepared_far(k, h, b);
}

/* The same in loops: views from below are rare, and a block without any skips their part. */
#define ASP_OWN_SIGMA_N
ASP_CLONES static void ndf_sigma_n(const asp_shape *k, size_t n, asp_real sign,
                                   const asp_real *ASP_RESTRICT wx, const asp_real *ASP_RESTRICT wy,
                                   const asp_real *ASP_RESTRICT wz, asp_real *ASP_RESTRICT out)
{
    asp_real w[PREPARED_BLOCK], s2[PREPARED_BLOCK];
    size_t from, i, count;
    for (from = 0; from < n; from += PREPARED_BLOCK) {
        asp_bits signs = 0;
        count = n - from < PREPARED_BLOCK ? n - from : PREPARED_BLOCK;
        for (i = 0; i < count; i++) {
            asp_v3 v = aspi_view(k, aspi_vector(sign * wx[from + i], sign * wy[from + i], sign * wz[from + i]));
            w[i] = v.z;
            s2[i] = aspi_length2(v);
            out[from + i] = aspi_max(v.z, R(0.0)) + prepared_far(k, aspi_abs(v.z), s2[i] * k->table[PREPARED_SCALE2]);
        }
        for (i = 0; i < count; i++)
            signs |= aspi_to_bits(w[i]);
        if (signs >> (8 * sizeof signs - 1))
            for (i = 0; i < count; i++) {
                asp_real b = s2[i] * k->table[PREPARED_SCALE2];
                asp_real below = prepared_below(k, aspi_abs(w[i]), s2[i], b);
                out[from + i] = aspi_select(prepared_deep(w[i], b), below, out[from + i]);
            }
    }
}
#endif
