/* test_planar.c - a standard surface that is not radially symmetric, with numbers in the caller's memory
 *
 * GGX stretched by a lower triangular matrix L that `data` points to, seen through a map M: GGX through
 * M L. What must hold: the same D, P22, sigma and masking as the library's GGX through that map, the laws, single
 * calls and batches alike, in place too. Read three times: head, float64, float32. */
#ifndef ASP_PRECISION
#include "asperity_data.h"
#include "asperity_ndf.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct triangle { double a, b, c; } triangle;      /* L = (a 0; b c) */

static asp_status planar_prepare(asp_ndf *out, asp_error *err)
{
    const triangle *l = (const triangle *)out->data;
    if (!l)
        return asp_fail(err, ASP_EINVAL, "data", "this model needs its matrix");
    out->table[0] = 1 / fabs(l->a * l->c);
    return ASP_OK;
}

#define ASP_NDF planar
#define ASP_NDF_PLANAR
#define ASP_PRECISION 64
#include "test_planar.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "test_planar.c"
#undef ASP_PRECISION

static const asp_model planar = {
    "planar", NULL, "GGX stretched twice", "a test", ASP_KEYS_SLOPE, 0.3, 0, 0, NULL, 0, planar_prepare,
    ASP_NDF_OPS(planar)
};
#undef ASP_NDF
#undef ASP_NDF_PLANAR

static int passed, failed;

static void report(const char *what, double worst, double bound)
{
    int ok = worst <= bound;
    printf("%-4s %-52s %.3g, bound %g\n", ok ? "ok" : "FAIL", what, worst, bound);
    passed += ok;
    failed += !ok;
}

static double larger(double a, double b) { return b <= a ? a : b; }     /* keeps a NaN of b */

static double relative(double got, double want) { return fabs(got - want) / fmax(fabs(want), 1e-300); }

static void note(void *context, const asp_law_result *r)
{
    int *laws = (int *)context;
    *laws += 1;
    if (!r->passed)
        printf("     the law %s: %s, %.3g, allowed %.3g\n", r->law->name, r->where, r->worst, r->allowed);
}

static asp_vec3 direction(int i, int n, double low)
{
    double z = low + (1 - low) * (i + 0.5) / n, r = sqrt(1 - z * z), phi = 2.399963 * i;
    asp_vec3 w = { r * cos(phi), r * sin(phi), z };
    return w;
}

enum { COUNT = 1000 };

/* Whether samples that overwrite what they are made from are the single calls'. */
static double in_place(const asp_material *mat, int swap)
{
    static double x[COUNT], y[COUNT], z[COUNT], a[COUNT], b[COUNT], r[COUNT], g[COUNT];
    asp_cvec3s wi = { x, y, z };
    asp_vec3s wo = { r, a, g };
    asp_rgbs weight = { y, z, b };
    double bad = 0;
    int i;
    for (i = 0; i < COUNT; i++) {
        asp_vec3 w = direction(i, COUNT, 0.01);
        x[i] = w.x;
        y[i] = w.y;
        z[i] = w.z;
        a[i] = (i * 7 % COUNT + 0.5) / COUNT;
        b[i] = (i + 0.5) / COUNT;
    }
    if (swap) {     /* wo on wi, the rest elsewhere */
        wo.x = y;
        wo.y = x;
        wo.z = z;
        weight.r = r;
        weight.g = g;
    }
    asp_sample_n(mat, COUNT, wi, a, b, wo, swap ? a : x, weight);
    for (i = 0; i < COUNT; i++) {
        asp_bsdf_sample s = asp_sample(mat, direction(i, COUNT, 0.01), (i * 7 % COUNT + 0.5) / COUNT,
                                       (i + 0.5) / COUNT);
        bad += s.wo.x != wo.x[i] || s.wo.y != wo.y[i] || s.wo.z != wo.z[i];
        bad += s.pdf != (swap ? a : x)[i];
        bad += s.weight.r != weight.r[i] || s.weight.g != weight.g[i] || s.weight.b != weight.b[i];
    }
    return bad;
}

/* Those that ask nothing of the standard surface's symmetry. */
static const char *const laws[] = { "sigma_flip", "sample_normal", "sample_visible", "sample_bsdf",
                                    "batch", "nan", "finite", "reciprocity", "weight" };

int main(void)
{
    static double x[COUNT], y[COUNT], z[COUNT], out[COUNT], u[COUNT];
    triangle l = { 1.3, 0.4, 0.5 };
    asp_map map, product;
    asp_ndf a, b;
    asp_ndff f;
    asp_error err;
    asp_cvec3s in = { x, y, z };
    asp_vec3s back = { x, y, z };
    asp_laws_options options = asp_laws_options_default();
    asp_material mats[2];
    asp_rgb grey = { 0.4, 0.5, 0.6 };
    size_t broken = 99;
    double d = 0, s = 0, g = 0, p = 0, narrow = 0, same = 0, place = 0;
    int i, run = 0;
    asp_map_from_roughness(0.4, 0.2, 0.7, 0.2, -0.3, &map, NULL);
    product = map;
    product.m00 = map.m00 * l.a + map.m01 * l.b;
    product.m01 = map.m01 * l.c;
    product.m10 = map.m10 * l.a + map.m11 * l.b;
    product.m11 = map.m11 * l.c;
    report("without data it is refused", asp_ndf_make(&planar, &map, NULL, &a, &err) != ASP_EINVAL, 0);
    if (asp_ndf_make_data(&planar, &map, NULL, &l, &a, &err) != ASP_OK ||
        asp_ndf_make(asp_find_model(NULL, "ggx"), &product, NULL, &b, &err) != ASP_OK)
        return 1;
    f = asp_ndf_narrow(&a);
    report("the narrowed value keeps the data", f.data != &l, 0);
    for (i = 0; i < COUNT; i++) {
        asp_vec3 m = direction(i, COUNT, 0.01), w = direction(i, COUNT, -1), t = direction(i, COUNT, 0.1);
        asp_vec3f mf = { (float)m.x, (float)m.y, (float)m.z };
        d = larger(d, relative(asp_D(&a, m), asp_D(&b, m)));
        p = larger(p, relative(asp_P22(&a, w.x, w.y), asp_P22(&b, w.x, w.y)));
        s = larger(s, relative(asp_sigma(&a, w), asp_sigma(&b, w)));
        g = larger(g, relative(1 + asp_lambda(&a, m, 0), 1 + asp_lambda(&b, m, 0)));
        g = larger(g, relative(asp_G2(&a, t, m, t, 0), asp_G2(&b, t, m, t, 0)));
        narrow = larger(narrow, relative((double)asp_Df(&f, mf), asp_D(&a, m)));
        x[i] = w.x;
        y[i] = w.y;
        z[i] = w.z;
        u[i] = (i + 0.5) / COUNT;
    }
    report("D is GGX's through the product of the maps", d, 1e-14);
    report("P22 likewise", p, 1e-14);
    report("sigma likewise, above and below", s, 1e-12);
    report("Lambda and G2 likewise", g, 1e-13);
    report("float32 D", narrow, 1e-5);
    asp_sigma_n(&a, COUNT, in, out);
    for (i = 0; i < COUNT; i++)
        same += asp_sigma(&a, direction(i, COUNT, -1)) != out[i];
    asp_sample_visible_n(&a, COUNT, in, u, u, back);
    for (i = 0; i < COUNT; i++) {
        asp_vec3 m = asp_sample_visible(&a, direction(i, COUNT, -1), u[i], u[i]);
        place += m.x != x[i] || m.y != y[i] || m.z != z[i];
    }
    asp_D_n(&a, COUNT, in, x);
    for (i = 0; i < COUNT; i++)
        place += asp_D(&a, asp_sample_visible(&a, direction(i, COUNT, -1), u[i], u[i])) != x[i];
    report("batches give the single calls' bits", same, 0);
    report("in place too", place, 0);
    mats[0] = asp_mirror(&a, ASP_MASK_WALL);
    mats[1] = asp_lambert_specular(&a, grey, grey, 1.5, 0);
    for (i = 0; i < 4; i++)
        report("samples that overwrite their inputs", in_place(&mats[i / 2], i % 2), 0);
    options.samples = 100000;
    for (i = 0; i < (int)(sizeof laws / sizeof *laws); i++) {
        options.only = laws[i];
        if (asp_laws_check(&a, &options, note, &run, &broken, &err) != ASP_OK)
            printf("     %s %s\n", err.name, err.reason);
        report(laws[i], (double)broken, 0);
    }
    report("laws that did not run", (double)i - run, 0);
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}

#else
#include "asperity/facet.h"

#define planar_in ASP_NDF_NAME(_in)
#define planar_out ASP_NDF_NAME(_out)

/* L^T v and L m. */
ASP_FN asp_v3 planar_in(const asp_shape *k, asp_v3 v)
{
    const triangle *l = (const triangle *)k->data;
    v.x = (asp_real)l->a * v.x + (asp_real)l->b * v.y;
    v.y = (asp_real)l->c * v.y;
    return v;
}

ASP_FN asp_v3 planar_out(const asp_shape *k, asp_v3 m)
{
    const triangle *l = (const triangle *)k->data;
    m.y = (asp_real)l->b * m.x + (asp_real)l->c * m.y;
    m.x = (asp_real)l->a * m.x;
    return m;
}

ASP_FN asp_real ndf_density(const asp_shape *k, asp_v3 m)
{
    const triangle *l = (const triangle *)k->data;
    asp_real x = m.x / (asp_real)l->a, y = (m.y - (asp_real)l->b * x) / (asp_real)l->c;
    asp_real h = x * x + y * y + m.z * m.z;
    return k->table[0] * R(1.0 / ASP_PI) / (h * h);
}

ASP_FN asp_real ndf_sigma(const asp_shape *k, asp_v3 w)
{
    asp_v3 v = planar_in(k, w);
    asp_real s2 = v.x * v.x + v.y * v.y, up = R(0.5) * (aspi_sqrt(v.z * v.z + s2) + aspi_abs(v.z));
    return v.z < R(0.0) ? R(0.25) * s2 / aspi_max(up, R(1e-37)) : up;
}

/* The spherical cap again (Dupuy, Benyoub 2023). */
ASP_FN asp_v3 ndf_visible(const asp_shape *k, asp_v3 w, asp_real u1, asp_real u2)
{
    asp_v3 v = planar_in(k, w);
    asp_real s2 = v.x * v.x + v.y * v.y;
    asp_real inverse = R(1.0) / aspi_sqrt(s2 + v.z * v.z), up = R(1.0) + aspi_abs(v.z) * inverse;
    asp_real a = v.z < R(0.0) ? s2 * inverse * inverse / up : up, d = u1 * a;
    asp_real r = aspi_sqrt(d * aspi_max(R(2.0) - d, R(0.0)));
    asp_v2 t = aspi_sincos2pi(u2);
    v.x = r * t.x + v.x * inverse;
    v.y = r * t.y + v.y * inverse;
    v.z = (R(1.0) - u1) * a;
    return planar_out(k, v);
}

ASP_FN asp_v3 ndf_normal(const asp_shape *k, asp_real u1, asp_real u2)
{
    asp_real r = aspi_sqrt(u1);
    asp_v2 t = aspi_sincos2pi(u2);
    return planar_out(k, aspi_vector(r * t.x, r * t.y, aspi_sqrt(R(1.0) - u1)));
}

#include "asperity/ndf_loops.h"
#endif
