/* test_golden_energy.c - single-scattering albedo of a perfect mirror surface against the golden
 * files, by cubature of asp_eval_cos: masking, density and Jacobians together, both maskings.
 * Tolerance: ten times the golden's own error estimate plus 1e-9, plus the stated error of sigma. */
#include "asperity_ndf.h"
#include "golden.h"
#include "laws/laws.h"

typedef struct file_row {
    const char *file;
    const char *alpha_x, *alpha_y, *mean_x, *mean_y, *rho, *gamma;   /* columns or NULL */
    const char *model;
    const asp_model *record;    /* instead of model: alpha_x and gamma are its own parameters */
} file_row;

extern const asp_model asp_model_phong, asp_model_abc, asp_model_sgd, asp_model_gtr, asp_model_torrance_sparrow;

static const file_row files[] = {
    { "energy_std.csv", "sigma", "sigma", NULL, NULL, NULL, "gamma", "student_t", NULL },
    { "energy_std_aniso.csv", "sigma_x", "sigma_y", NULL, NULL, NULL, "gamma", "student_t", NULL },
    { "energy_beckmann.csv", "alpha", "alpha", NULL, NULL, NULL, NULL, "beckmann", NULL },
    { "energy_ggx.csv", "alpha", "alpha", NULL, NULL, NULL, NULL, "ggx", NULL },
    { "energy_ellipsoid.csv", "alpha_x", "alpha_y", NULL, NULL, NULL, NULL, "ellipsoid", NULL },
    { "energy_ellipsoid_std.csv", "sig_x", "sig_y", "mean_slope_x", "mean_slope_y", "rho", "gamma",
      "student_t", NULL },
    { "energy_phong.csv", "n", NULL, NULL, NULL, NULL, NULL, NULL, &asp_model_phong },
    { "energy_abc.csv", "alpha", NULL, NULL, NULL, NULL, "gamma", NULL, &asp_model_abc },
    { "energy_sgd.csv", "alpha", NULL, NULL, NULL, NULL, "p", NULL, &asp_model_sgd },
    { "energy_gtr.csv", "alpha", NULL, NULL, NULL, NULL, "gamma", NULL, &asp_model_gtr },
    { "energy_ts.csv", "alpha", NULL, NULL, NULL, NULL, NULL, NULL, &asp_model_torrance_sparrow },
};

/* Values of the golden files that are further off than ten times their own error estimate, and what
 * they are held to instead. std, line 117: at normal incidence Lambda(wi) = 0, both maskings are
 * one, and the file's other column (which passes) has that value. ellipsoid: the midpoint rule over
 * theta_o and phi_o with 2000, 4000 and 8000 times twice as many points, extrapolated; its error
 * falls by 4.0 each time. */
typedef struct correction {
    const char *file;
    long line;
    int column;         /* 0 separable, 1 height-correlated */
    double value, error;
} correction;

static const correction corrections[] = {
    { "energy_std.csv", 117, 0, 0.00187852824877702, 1e-14 },
    { "energy_ellipsoid.csv", 41, 0, 0.9241562356, 1e-10 },
    { "energy_ellipsoid.csv", 47, 0, 0.5666721444, 1e-10 },
    { "energy_ellipsoid.csv", 47, 1, 0.5746971536, 1e-10 },
};

/* The value to compare with and its error estimate. */
static double reference(const char *file, const golden *g, int column, const char *name,
                        double *error)
{
    size_t i;
    *error = golden_value(g, "est_err");
    for (i = 0; i < sizeof corrections / sizeof corrections[0]; i++) {
        const correction *c = &corrections[i];
        if (strcmp(c->file, file) == 0 && c->line == g->line && c->column == column) {
            printf("%s, line %ld, %s: golden %.15g +- %.1e is held to %.12g\n", file, c->line, name,
                   golden_value(g, name), *error, c->value);
            *error = c->error;
            return c->value;
        }
    }
    return golden_value(g, name);
}

static double optional(const golden *g, const char *name) { return name ? golden_value(g, name) : 0; }

static int has_column(const golden *g, const char *name)
{
    int i;
    for (i = 0; i < g->columns; i++)
        if (strcmp(g->names[i], name) == 0)
            return 1;
    return 0;
}

static asp_status make(const file_row *f, const golden *g, asp_ndf *out)
{
    double ax = golden_value(g, f->alpha_x), ay = f->record ? 0 : golden_value(g, f->alpha_y);
    double gamma = optional(g, f->gamma), A[9];
    asp_map map;
    asp_status s;
    if (f->record) {
        double shape[2];
        shape[0] = ax;
        shape[1] = gamma;
        s = asp_map_from_roughness(1, 1, 0, 0, 0, &map, NULL);
        return s ? s : asp_ndf_make(f->record, &map, shape, out, NULL);
    }
    if (strcmp(f->model, "ellipsoid") == 0) {
        s = asp_ellipsoid_matrix(ax, ay, golden_value(g, "theta_x"), golden_value(g, "theta_y"),
                                 golden_value(g, "theta_z"), A, NULL);
        s = s ? s : asp_map_from_matrix(A, &map, NULL);
    } else
        s = asp_map_from_correlation(ax, ay, optional(g, f->rho), optional(g, f->mean_x),
                                     optional(g, f->mean_y), &map, NULL);
    return s ? s : asp_ndf_make(asp_find_model(NULL, f->model), &map, f->gamma ? &gamma : NULL, out,
                                NULL);
}

/* Instrumented code is some six times slower, and has a smaller job: every path, not every value. */
#ifdef __SANITIZE_ADDRESS__
#define EVERY 8
#else
#define EVERY 1
#endif

int main(void)
{
    static const int masks[2] = { ASP_MASK_UNCORRELATED, ASP_MASK_CORRELATED };
    static const char *const columns[2] = { "R_separable", "R_height_correlated" };
    size_t i;
    if (!golden_folder())
        return golden_skip();
    for (i = 0; i < sizeof files / sizeof files[0]; i++) {
        golden g;
        golden_column c[2];
        double doubted = 0;
        int k;
        if (!golden_open(&g, files[i].file))
            return golden_skip();
        memset(c, 0, sizeof c);
        while (golden_next(&g)) {
            asp_ndf ndf;
            asp_vec3 wi = golden_direction(golden_value(&g, "theta_v"),
                                           has_column(&g, "phi_v") ? golden_value(&g, "phi_v") : 0);
            if (g.line % EVERY != 0)
                continue;
            if (make(&files[i], &g, &ndf) != ASP_OK) {
                golden_expect(0, "a distribution could not be made");
                continue;
            }
            for (k = 0; k < 2; k++) {
                asp_material mat = asp_mirror(&ndf, masks[k]);
                double doubt, error;
                double exact = reference(files[i].file, &g, k, columns[k], &error);
                double allowed = 10 * error + 1e-9 + ndf.model->area_error;
                double found = aspi_albedo(&mat, wi, allowed / 20, &doubt);
                c[k].name = columns[k];
                golden_note(&c[k], &g, fabs(found - exact), allowed, found, exact);
                doubted = fmax(doubted, doubt);
            }
        }
        printf("%s: our own estimate of the cubature's error, at most %.1e\n", files[i].file,
               doubted);
        golden_print(&c[0]);
        golden_print(&c[1]);
        golden_close(&g);
    }
    return golden_result();
}
