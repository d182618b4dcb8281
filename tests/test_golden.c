/* test_golden.c - every row of the golden files, computed with 40 digits and more, against the
 * library: densities, sigma, masking, visible densities; float64 flat 1e-11, float32 2e-6. Distributions
 * that are prepared numerically are held to the error that they state, where sigma enters.
 *
 * A file is a row of `files` below: its name, how its parameters make a distribution, and which of
 * the common columns it has. */
#include "asperity_ndf.h"
#include "golden.h"

#include <complex.h>
#include <math.h>

#define TOLERANCE 1e-11

/* ------------------------------------------------------------------ distributions from a row */

static asp_status isotropic(const asp_model *model, double alpha, const double *shape, asp_ndf *out)
{
    asp_map map;
    asp_status s = asp_map_from_roughness(alpha, alpha, 0, 0, 0, &map, NULL);
    return s ? s : asp_ndf_make(model, &map, shape, out, NULL);
}

static asp_status make_std_iso(const golden *g, asp_ndf *out)
{
    double gamma = golden_value(g, "gamma");
    return isotropic(asp_find_model(NULL, "student_t"), golden_value(g, "sigma"), &gamma, out);
}

static asp_status make_std_aniso(const golden *g, asp_ndf *out)
{
    double gamma = golden_value(g, "gamma");
    asp_map map;
    asp_status s = asp_map_from_roughness(golden_value(g, "sigma_x"), golden_value(g, "sigma_y"),
                                          0, 0, 0, &map, NULL);
    return s ? s : asp_ndf_make(asp_find_model(NULL, "student_t"), &map, &gamma, out, NULL);
}

static asp_status make_beckmann(const golden *g, asp_ndf *out)
{
    return isotropic(asp_find_model(NULL, "beckmann"), golden_value(g, "alpha"), NULL, out);
}

static asp_status make_ggx(const golden *g, asp_ndf *out)
{
    return isotropic(asp_find_model(NULL, "trowbridge_reitz"), golden_value(g, "alpha"), NULL, out);
}

/* Through the spec's text, so that the parser's digits count too. */
static asp_status make_ellipsoid(const golden *g, asp_ndf *out)
{
    char spec[400];
    snprintf(spec, sizeof spec,
             "ellipsoid:alpha_x=%.17g,alpha_y=%.17g,theta_x=%.17g,theta_y=%.17g,theta_z=%.17g",
             golden_value(g, "alpha_x"), golden_value(g, "alpha_y"), golden_value(g, "theta_x"),
             golden_value(g, "theta_y"), golden_value(g, "theta_z"));
    return asp_ndf_parse(NULL, spec, out, NULL);
}

static asp_status make_ellipsoid_std(const golden *g, asp_ndf *out)
{
    double gamma = golden_value(g, "gamma");
    asp_map map;
    asp_status s = asp_map_from_correlation(golden_value(g, "sig_x"), golden_value(g, "sig_y"),
        golden_value(g, "rho"), golden_value(g, "mean_slope_x"), golden_value(g, "mean_slope_y"),
        &map, NULL);
    return s ? s : asp_ndf_make(asp_find_model(NULL, "student_t"), &map, &gamma, out, NULL);
}

/* Models whose shape numbers carry the roughness: the columns are their parameters in order. */
static asp_status make_shape(const golden *g, const asp_model *model, const char *first, const char *second,
                             asp_ndf *out)
{
    double shape[2];
    shape[0] = golden_value(g, first);
    shape[1] = second ? golden_value(g, second) : 0;
    return isotropic(model, 1, shape, out);
}

extern const asp_model asp_model_abc, asp_model_sgd, asp_model_gtr, asp_model_torrance_sparrow;

static asp_status make_phong(const golden *g, asp_ndf *out)
{
    return make_shape(g, asp_find_model(NULL, "phong"), "n", NULL, out);
}

static asp_status make_abc(const golden *g, asp_ndf *out)
{
    return make_shape(g, &asp_model_abc, "alpha", "gamma", out);
}

static asp_status make_sgd(const golden *g, asp_ndf *out)
{
    return make_shape(g, &asp_model_sgd, "alpha", "p", out);
}

static asp_status make_gtr(const golden *g, asp_ndf *out)
{
    return make_shape(g, &asp_model_gtr, "alpha", "gamma", out);
}

static asp_status make_torrance_sparrow(const golden *g, asp_ndf *out)
{
    return make_shape(g, &asp_model_torrance_sparrow, "alpha", NULL, out);
}

typedef struct file_row {
    const char *file;
    asp_status (*make)(const golden *g, asp_ndf *out);
    const char *sigma, *pdf;   /* columns; sigma NULL: from Lambda, sigma = (1 + Lambda) cos */
    int matrix;                /* the ellipsoid's other columns: A and its slope map */
} file_row;

static const file_row files[] = {
    { "std_iso.csv", make_std_iso, NULL, "vndf_pdf", 0 },
    { "std_aniso.csv", make_std_aniso, NULL, "vndf_pdf", 0 },
    { "beckmann.csv", make_beckmann, NULL, "vndf_pdf", 0 },
    { "ggx_tr.csv", make_ggx, NULL, "vndf_pdf", 0 },
    { "ellipsoid.csv", make_ellipsoid, "visible_area_K", "vndf_pdf_eq33", 1 },
    { "ellipsoid_std.csv", make_ellipsoid_std, "visible_area_K", "vndf_pdf", 0 },
    { "phong.csv", make_phong, NULL, "vndf_pdf", 0 },
    { "abc.csv", make_abc, NULL, "vndf_pdf", 0 },
    { "sgd.csv", make_sgd, NULL, "vndf_pdf", 0 },
    { "gtr.csv", make_gtr, NULL, "vndf_pdf", 0 },
    { "torrance_sparrow.csv", make_torrance_sparrow, NULL, "vndf_pdf", 0 },
};

/* ------------------------------------------------------------------ comparison */

/* Flat relative tolerance; what is below the normal range must come out as nearly nothing. */
static void compare(golden_column *c, const golden *g, double found, double exact, double tolerance,
                    double smallest)
{
    if (exact == 0 || fabs(exact) < smallest) {
        golden_note(c, g, fabs(found) <= smallest ? 0 : INFINITY, tolerance, found, exact);
        return;
    }
    golden_note(c, g, fabs(found - exact) / fabs(exact), tolerance, found, exact);
}

typedef struct row_values {
    asp_vec3 v, m;
    double D, sigma, lambda, G1, pdf, cosine;
} row_values;

static row_values read_row(const file_row *f, const golden *g)
{
    row_values r;
    double tv = golden_value(g, "theta_v"), pv = golden_value(g, "phi_v");
    double tm = golden_value(g, "theta_m"), pm = golden_value(g, "phi_m");
    r.v = golden_direction(tv, pv);
    r.m = golden_direction(tm, pm);
    r.D = golden_value(g, "D");
    r.G1 = golden_value(g, "G1");
    r.pdf = golden_value(g, f->pdf);
    r.cosine = golden_value(g, "v_dot_m");
    if (f->sigma) {
        r.sigma = golden_value(g, f->sigma);
        r.lambda = NAN;
    } else {
        r.lambda = golden_value(g, "Lambda");
        r.sigma = (1 + r.lambda) * cos(tv);
    }
    return r;
}

enum { C_D, C_P22, C_SIGMA, C_G1, C_ONE_LAMBDA, C_LAMBDA, C_PDF, C_NORMAL, C_MAP, C_D32, C_SIGMA32,
       C_PDF32, COLUMNS };
static const char *const column_names[COLUMNS] = {
    "D", "P22/cos^4", "sigma", "G1", "1 + Lambda", "Lambda", "visible pdf", "D cos", "slope map",
    "float32 D", "float32 sigma", "float32 visible pdf"
};

/* float32 against float64 at the same float32 inputs: what is rounded first is not an error. */
static void compare_float32(golden_column *c, const golden *g, const asp_ndf *k, const row_values *r)
{
    asp_ndff f = asp_ndf_narrow(k);
    asp_ndf wide = *k;
    asp_vec3f vf, mf;
    asp_vec3 v, m;
    double D, peak, tolerance, z4, h, s, cosine;
    vf.x = (float)r->v.x; vf.y = (float)r->v.y; vf.z = (float)r->v.z;
    mf.x = (float)r->m.x; mf.y = (float)r->m.y; mf.z = (float)r->m.z;
    v.x = vf.x; v.y = vf.y; v.z = vf.z;
    m.x = mf.x; m.y = mf.y; m.z = mf.z;
    wide.map.m00 = f.map.m00; wide.map.m01 = f.map.m01; wide.map.m10 = f.map.m10;
    wide.map.m11 = f.map.m11; wide.map.tx = f.map.tx; wide.map.ty = f.map.ty;
    wide.i00 = f.i00; wide.i01 = f.i01; wide.i10 = f.i10; wide.i11 = f.i11;
    wide.inv_det = f.inv_det;
    D = asp_D(&wide, m);
    peak = asp_D(&wide, asp_mean_normal(&wide));
    z4 = m.z * m.z / (asp_mean_normal(&wide).z * asp_mean_normal(&wide).z);
    tolerance = D * z4 * z4 < 1e-6 * peak ? 1e-4 : 2e-6;
    /* skewed or turned, M^-1 (p - t) subtracts: those files say how far that goes, in their own
     * column's worst, and are held to 2e-6 plus eps times what was subtracted */
    h = fabs(m.x / m.z) + fabs(m.y / m.z) + fabs(wide.map.tx) + fabs(wide.map.ty);
    s = fabs(wide.i00) + fabs(wide.i01) + fabs(wide.i10) + fabs(wide.i11);
    if (wide.map.tx != 0 || wide.map.ty != 0 || wide.map.m01 != 0 || wide.map.m10 != 0) {
        asp_vec3 q;
        double qx, qy, r_, step = 1.2e-7 * s * h, up, down;
        q.x = m.x / m.z + wide.map.tx;
        q.y = m.y / m.z + wide.map.ty;
        qx = wide.i00 * q.x + wide.i01 * q.y;
        qy = wide.i10 * q.x + wide.i11 * q.y;
        r_ = hypot(qx, qy);
        wide.map.m00 = wide.map.m11 = wide.i00 = wide.i11 = wide.inv_det = 1;
        wide.map.m01 = wide.map.m10 = wide.i01 = wide.i10 = wide.map.tx = wide.map.ty = 0;
        up = asp_P22(&wide, r_ + step, 0);
        down = asp_P22(&wide, r_ > step ? r_ - step : 0, 0);
        tolerance += up > 0 ? log(down / up) : INFINITY;
        wide = *k;
        wide.map.m00 = f.map.m00; wide.map.m01 = f.map.m01; wide.map.m10 = f.map.m10;
        wide.map.m11 = f.map.m11; wide.map.tx = f.map.tx; wide.map.ty = f.map.ty;
    }
    if (D < 1e37 && r->m.z > 2e-9)
        compare(&c[C_D32], g, asp_Df(&f, mf), D, tolerance, 1e-30);
    {
        double step = 1.2e-7 * (fabs(v.z) + fabs(wide.map.tx * v.x) + fabs(wide.map.ty * v.y));
        double sigma = asp_sigma(&wide, v), share = sigma;
        if (wide.map.tx == 0 && wide.map.ty == 0)
            step = 0;
        /* sigma moves with the height by the visible share of the facets, at most 1; far below the
         * mean plane its relative slope is that of a tail, measured here */
        if (step > 0) {
            asp_vec3 a = v;
            a.z += step;
            share = asp_sigma(&wide, a);
        }
        compare(&c[C_SIGMA32], g, asp_sigmaf(&f, vf), sigma,
                2e-6 + (sigma > 0 ? (share - sigma) / sigma : 0), 1e-25);
        cosine = v.x * m.x + v.y * m.y + v.z * m.z;
        if (cosine > 1e-3 && D < 1e37 && r->m.z > 2e-9) {
            wide.i00 = f.i00; wide.i01 = f.i01; wide.i10 = f.i10; wide.i11 = f.i11;
            wide.inv_det = f.inv_det;
            if (asp_pdf_visible(&wide, v, m) < 1e37)
                compare(&c[C_PDF32], g, asp_pdf_visiblef(&f, vf, mf), asp_pdf_visible(&wide, v, m),
                        tolerance + 1.2e-7 / cosine + (sigma > 0 ? (share - sigma) / sigma : 0),
                        1e-30);
        }
    }
}

/* The ellipsoid's other columns: A itself and the slope map of it. */
static void compare_matrix(golden_column *c, const golden *g, const asp_ndf *k)
{
    static const char *const names[9] = { "A11", "A12", "A13", "A21", "A22", "A23", "A31", "A32",
                                          "A33" };
    double A[9], ours[9], sig_x, sig_y, rho;
    asp_map map;
    int i;
    for (i = 0; i < 9; i++)
        A[i] = golden_value(g, names[i]);
    asp_ellipsoid_matrix(golden_value(g, "alpha_x"), golden_value(g, "alpha_y"),
                         golden_value(g, "theta_x"), golden_value(g, "theta_y"),
                         golden_value(g, "theta_z"), ours, NULL);
    for (i = 0; i < 9; i++)
        golden_note(&c[C_MAP], g, fabs(ours[i] - A[i]), 1e-15, ours[i], A[i]);
    if (asp_map_from_matrix(A, &map, NULL) != ASP_OK) {
        golden_note(&c[C_MAP], g, INFINITY, 0, 0, 0);
        return;
    }
    for (i = 0; i < 2; i++) {
        const asp_map *m = i ? &map : &k->map;
        sig_x = hypot(m->m00, m->m01);
        sig_y = hypot(m->m10, m->m11);
        rho = (m->m00 * m->m10 + m->m01 * m->m11) / (sig_x * sig_y);
        golden_note(&c[C_MAP], g, fabs(m->tx - golden_value(g, "mean_slope_x")), 1e-12, m->tx,
                    golden_value(g, "mean_slope_x"));
        golden_note(&c[C_MAP], g, fabs(m->ty - golden_value(g, "mean_slope_y")), 1e-12, m->ty,
                    golden_value(g, "mean_slope_y"));
        compare(&c[C_MAP], g, sig_x, golden_value(g, "sig_x"), 1e-12, 0);
        compare(&c[C_MAP], g, sig_y, golden_value(g, "sig_y"), 1e-12, 0);
        golden_note(&c[C_MAP], g, fabs(rho - golden_value(g, "rho")), 1e-12, rho,
                    golden_value(g, "rho"));
    }
}

static void compare_row(const file_row *f, golden_column *c, const golden *g, double bend)
{
    row_values r = read_row(f, g);
    asp_ndf k;
    double z2 = r.m.z * r.m.z, area;
    if (f->make(g, &k) != ASP_OK) {
        golden_note(&c[C_D], g, INFINITY, 0, 0, 0);
        return;
    }
    area = TOLERANCE + k.model->area_error;
    compare(&c[C_D], g, asp_D(&k, r.m) * bend, r.D, TOLERANCE, 1e-307);
    compare(&c[C_P22], g, asp_P22(&k, -r.m.x / r.m.z, -r.m.y / r.m.z) / (z2 * z2), r.D, TOLERANCE,
            1e-290);
    compare(&c[C_NORMAL], g, asp_pdf_normal(&k, r.m), r.D * r.m.z, TOLERANCE, 1e-300);
    compare(&c[C_SIGMA], g, asp_sigma(&k, r.v) * bend, r.sigma, area, 1e-300);
    compare(&c[C_G1], g, asp_G1(&k, r.v, ASP_MASK_UNCORRELATED) * bend, r.G1, area, 1e-300);
    if (r.lambda == r.lambda) {
        double lambda = asp_lambda(&k, r.v, 0) * bend;
        compare(&c[C_ONE_LAMBDA], g, 1 + lambda, 1 + r.lambda, area, 0);
        if (k.model->area_error == 0) /* of nearly nothing, in shallow views */
            compare(&c[C_LAMBDA], g, lambda, r.lambda, TOLERANCE, 1e-280);
    }
    compare(&c[C_PDF], g, asp_pdf_visible(&k, r.v, r.m) * bend, r.pdf, area, 1e-300);
    if (f->matrix)
        compare_matrix(c, g, &k);
    compare_float32(c, g, &k, &r);
}

/* ------------------------------------------------------------------ the comparison itself */

/* A comparison that accepts anything would pass all of the above: values off by 3e-11 must fail. */
static void self_test(const golden *g, const file_row *f)
{
    golden_column c[COLUMNS];
    int i, caught = 0;
    memset(c, 0, sizeof c);
    for (i = 0; i < COLUMNS; i++)
        c[i].name = column_names[i];
    compare_row(f, c, g, 1 + 3e-11);
    caught = c[C_D].failed && c[C_SIGMA].failed && c[C_G1].failed && c[C_LAMBDA].failed
          && c[C_PDF].failed;
    golden_expect(caught, "values off by 3e-11 are caught");
    golden_expect(c[C_P22].failed == 0, "and only those");
}

/* ------------------------------------------------------------------ Fresnel by complex numbers */

/* Textbook amplitudes (Born, Wolf, 1.5.2), in complex arithmetic. */
static double fresnel_complex(double c, double complex index)
{
    double complex ct = csqrt(1 - (1 - c * c) / (index * index));
    double complex s = (c - index * ct) / (c + index * ct);
    double complex p = (index * c - ct) / (index * c + ct);
    return 0.5 * (cabs(s) * cabs(s) + cabs(p) * cabs(p));
}

static void check_fresnel(void)
{
    static const double index[8][2] = { { 0.17, 3.5 }, { 1.5, 0 }, { 2.9, 2.9 }, { 0.05, 4.2 },
                                        { 1.0, 0.02 }, { 4.5, 0.1 }, { 0.7, 0 }, { 3.2, 30 } };
    double worst = 0, worst32 = 0;
    size_t count, i, k;
    const asp_metal *metals = asp_metals(&count);
    for (k = 0; k < 8 + 3 * count; k++) {
        double eta, kappa;
        if (k < 8) {
            eta = index[k][0];
            kappa = index[k][1];
        } else {
            const asp_metal *m = &metals[(k - 8) / 3];
            size_t channel = (k - 8) % 3;
            eta = channel == 0 ? m->eta.r : channel == 1 ? m->eta.g : m->eta.b;
            kappa = channel == 0 ? m->k.r : channel == 1 ? m->k.g : m->k.b;
        }
        for (i = 0; i <= 200; i++) {
            double c = (double)i / 200, exact = fresnel_complex(c, eta + I * kappa);
            double found = asp_fresnel_conductor(c, eta, kappa);
            double cf = (float)c, narrow = asp_fresnel_conductorf((float)c, (float)eta, (float)kappa);
            if (kappa == 0 && eta < 1 && 1 - c * c >= eta * eta)
                exact = 1; /* total reflection: on the branch cut */
            worst = fmax(worst, fabs(found - exact));
            worst32 = fmax(worst32, fabs(narrow - asp_fresnel_conductor(cf, (float)eta,
                                                                        (float)kappa)));
            if (kappa == 0)
                worst = fmax(worst, fabs(asp_fresnel_dielectric(c, eta) - exact));
        }
    }
    printf("Fresnel against complex amplitudes: %.2e, float32 %.2e, %zu metals\n", worst, worst32,
           count);
    golden_expect(worst < 1e-13, "conductor and dielectric within 1e-13");
    golden_expect(worst32 < 2e-6, "float32 within 2e-6");
    /* special values that general tests do not enter */
    golden_expect(asp_fresnel_dielectric(0.3, 1) == 0, "eta = 1 reflects nothing");
    golden_expect(asp_fresnel_dielectric(0.1, 0.5) == 1, "total internal reflection");
    golden_expect(fabs(asp_fresnel_conductor(0, 0.2, 3) - 1) < 1e-15, "grazing reflects all");
}

int main(void)
{
    size_t i, rows = 0;
    if (!golden_folder())
        return golden_skip();
    check_fresnel();
    for (i = 0; i < sizeof files / sizeof files[0]; i++) {
        golden g;
        golden_column c[COLUMNS];
        int k;
        if (!golden_open(&g, files[i].file))
            return golden_skip();
        memset(c, 0, sizeof c);
        for (k = 0; k < COLUMNS; k++)
            c[k].name = column_names[k];
        while (golden_next(&g)) {
            compare_row(&files[i], c, &g, 1);
            if (i == 0 && g.line == 2)
                self_test(&g, &files[i]);
            rows++;
        }
        golden_close(&g);
        printf("%s: %ld rows\n", files[i].file, g.line - 1);
        for (k = 0; k < COLUMNS; k++)
            golden_print(&c[k]);
    }
    printf("%zu rows in all\n", rows);
    return golden_result();
}
