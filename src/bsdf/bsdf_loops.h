/* bsdf_loops.h - a scattering model's formula as a loop; r, g, b hold F and receive the value */
ASP_CLONES static void bsdf_value_n(const asp_mat *mat, size_t n, const asp_real *ASP_RESTRICT x,
                                    const asp_real *ASP_RESTRICT y, asp_real *ASP_RESTRICT r,
                                    asp_real *ASP_RESTRICT g, asp_real *ASP_RESTRICT b)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_c3 F;
        F.r = r[i];
        F.g = g[i];
        F.b = b[i];
        F = bsdf_value(mat, F, x[i], y[i]);
        r[i] = F.r;
        g[i] = F.g;
        b[i] = F.b;
    }
}
