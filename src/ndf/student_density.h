/* student_density.h - the density of normals of the Student-t family
 *
 * Read by student_kernel.h. (1 + x/n)^-gamma in steps, which the loop takes one by one: short loops let the
 * processor overlap several elements. In float32 the exponent, which may reach 87, is carried in two numbers
 * from the quotient on, so that its rounding errors do not come out magnified. */

#ifndef STUDENT_DENSITY_NAMES
#define STUDENT_DENSITY_NAMES
#define student_quotient ASP_NDF_NAME(_quotient)
#define student_exponent ASP_NDF_NAME(_exponent)
#define student_power ASP_NDF_NAME(_power)
#define student_floor ASP_NDF_NAME(_floor)
#define student_densities ASP_NDF_NAME(_densities)
#endif

/* x/n (x for the Gaussian) of x = a/z, r = 1/z rounded, as .x and what it lacks as .y. */
ASP_FN asp_v2 student_quotient(const asp_shape *k, asp_real a, asp_real z, asp_real r)
{
    asp_v2 out;
#if ASP_PRECISION == 64
    (void)z;
    out.x = STUDENT_GAUSSIAN ? a * r : a * r * k->table[STUDENT_INVN];
    out.y = R(0.0);
#elif STUDENT_GAUSSIAN
    (void)k;
    out.x = a * r;
    out.y = aspi_product_error(out.x, z, a) * -r;
#else
    asp_real ah = aspi_high(a), al = a - ah;
    asp_real main = ah * k->table[STUDENT_INVN + 1];
    asp_real rest = ah * k->table[STUDENT_INVN + 2] + al * k->table[STUDENT_INVN];
    asp_real b = main + rest, b_low = rest - (b - main);
    out.x = b * r;
    out.y = (b_low - aspi_product_error(out.x, z, b)) * r;
#endif
    return out;
}

/* p log(1 + x/n), p = table[power], as .x and, to be added, .y; x for the Gaussian, where p is not used. */
ASP_FN asp_v2 student_exponent(const asp_shape *k, int power, asp_v2 y)
{
#if STUDENT_GAUSSIAN
    (void)k;
    (void)power;
    return y;
#elif ASP_PRECISION == 64
    y.x = k->table[power] * aspi_log1p(y.x);
    return y;
#else
    asp_v2 l = aspi_log1p_sum(y.x, y.y);
    asp_real lh = aspi_high(l.x), ll = (l.x - lh) + l.y;
    l.x = lh * k->table[power + 1];
    l.y = ll * k->table[power] + lh * k->table[power + 2];
    return l;
#endif
}

ASP_FN asp_real student_power(asp_v2 e)
{
#if ASP_PRECISION == 64
    return aspi_exp(-e.x);
#else
    return aspi_exp_less(-e.x, e.y);
#endif
}

/* z2 below 1e-18 (float32) or 1e-150 counts as that. */
ASP_FN asp_real student_floor(asp_real z2) { return aspi_max(z2, ASP_PRECISION == 64 ? R(1e-150) : R(1e-18)); }

/* Density of normals: (1 + r2/(n z2))^-gamma / (pi z2^2) (Ribardiere et al. 2017, eq. 11). A density whose
 * power is below e^-87 or e^-708 is 0. Relative error 5e-7 (float32; 8e-7 in the far tail) and
 * 1e-15 (1 + |log of the power|). */
ASP_FN asp_real ndf_density(const asp_shape *k, asp_real r2, asp_real z2)
{
    asp_real z = student_floor(z2), r = R(1.0) / z;
    asp_v2 e = student_exponent(k, STUDENT_GAMMA, student_quotient(k, r2, z, r));
    return student_power(e) * (r * r * R(1.0 / ASP_PI));
}

/* A block. */
ASP_FN void student_densities(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT mx,
                              const asp_real *ASP_RESTRICT my, const asp_real *ASP_RESTRICT mz,
                              asp_real *ASP_RESTRICT out)
{
    asp_real x[ASP_BLOCK], low[ASP_BLOCK];
    size_t i, powers = STUDENT_GAUSSIAN ? 0 : n;
    for (i = 0; i < n; i++) {
        asp_v3 m = aspi_facet(k, aspi_vector(mx[i], my[i], mz[i]));
        asp_real z = student_floor(m.z * m.z), r = R(1.0) / z;
        asp_v2 y = student_quotient(k, aspi_length2(m), z, r);
        x[i] = y.x;
        low[i] = y.y;
        out[i] = r * r * R(1.0 / ASP_PI);
    }
    ASP_IN_PLACE
    for (i = 0; i < powers; i++) {
        asp_v2 y;
        y.x = x[i];
        y.y = low[i];
        y = student_exponent(k, STUDENT_GAMMA, y);
        x[i] = y.x;
        low[i] = y.y;
    }
    ASP_IN_PLACE
    for (i = 0; i < n; i++) {
        asp_v2 e;
        e.x = x[i];
        e.y = low[i];
        out[i] = aspi_density_result(k, student_power(e) * out[i], mz[i]);
    }
}

#define ASP_OWN_DENSITY_N
ASP_CLONES static void ndf_density_n(const asp_shape *k, size_t n, const asp_real *ASP_RESTRICT mx,
                                     const asp_real *ASP_RESTRICT my, const asp_real *ASP_RESTRICT mz,
                                     asp_real *ASP_RESTRICT out)
{
    size_t from;
    for (from = 0; from < n; from += ASP_BLOCK)
        student_densities(k, n - from < ASP_BLOCK ? n - from : ASP_BLOCK, mx + from, my + from, mz + from,
                          out + from);
}
