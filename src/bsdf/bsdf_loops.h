/* bsdf_loops.h - a scattering model's formulas as functions and as loops */

static void bsdf_value_1(const asp_mat *mat, asp_real F_r, asp_real F_g, asp_real F_b, asp_real x,
                         asp_real y, asp_c3 *out)
{
    asp_c3 F;
    F.r = F_r;
    F.g = F_g;
    F.b = F_b;
    F = bsdf_value(mat, F, x, y);
    out->r = F.r;
    out->g = F.g;
    out->b = F.b;
}

static asp_real bsdf_share_1(const asp_mat *mat, const asp_real F[3])
{
    asp_c3 c;
    c.r = F[0];
    c.g = F[1];
    c.b = F[2];
    return bsdf_share(mat, c);
}

/* r, g, b hold F and receive the value */
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

ASP_CLONES static void bsdf_share_n(const asp_mat *mat, size_t n, const asp_real *ASP_RESTRICT r,
                                    const asp_real *ASP_RESTRICT g, const asp_real *ASP_RESTRICT b,
                                    asp_real *ASP_RESTRICT share)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_c3 F;
        F.r = r[i];
        F.g = g[i];
        F.b = b[i];
        share[i] = bsdf_share(mat, F);
    }
}
