/* test_fit.c - parameters come back from data made with them; errors and uncertainties mean what
 * they say; the same call gives the same bits */
#define _XOPEN_SOURCE 700
#include "data_test.h"
#include "asperity_ndf.h"

#include <pthread.h>

/* ------------------------------------------------------------------ data made from a material */

static asp_rgb of_material(const void *context, asp_vec3 wi, asp_vec3 wo)
{
    return asp_eval(context, wi, wo);
}

/* The geometries of gridded data, once: a listing of them is what a fit of a table would see. */
static asp_measurement *grid;
static size_t grid_count;

/* Every stride-th geometry as rows wi, wo, r, g, b that read back exactly; every value times 1 + noise (x in [-1.7, 1.7]). */
static asp_measured *listed(const asp_material *mat, double noise, size_t stride)
{
    char *text = malloc(grid_count * 240 + 100), *to = text;
    to += sprintf(to, "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,r,g,b\n");
    for (size_t i = 0; i < grid_count; i += stride) {
        const asp_measurement *m = &grid[i];
        asp_rgb f = asp_eval(mat, m->wi, m->wo);
        double e[3] = { 1, 1, 1 };
        for (int c = 0; c < 3 && noise > 0; c++)
            e[c] += noise * sqrt(3) * (2 * random_number() - 1);
        to += sprintf(to, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", m->wi.x, m->wi.y,
                      m->wi.z, m->wo.x, m->wo.y, m->wo.z, f.r * e[0], f.g * e[1], f.b * e[2]);
    }
    asp_error err;
    asp_measured *out = asp_measured_read_memory(text, (size_t)(to - text), "made.csv", &err);
    if (!out) {
        char line[600];
        printf("%s\n", asp_error_text(&err, line, sizeof line));
        exit(1);
    }
    free(text);
    return out;
}

static void make_grid(void)
{
    asp_material plain;
    asp_error err;
    asp_status status = asp_material_parse(NULL, "lambert_specular:diffuse=1,ndf=(ggx:alpha=0.5)",
                                           &plain, &err);
    asp_measured *table = status ? NULL : asp_measured_from_function(of_material, &plain, "", &err);
    grid = table ? asp_fit_geometries(table, &grid_count, &err) : NULL;
    if (!grid) {
        char line[600];
        printf("%s\n", asp_error_text(&err, line, sizeof line));
        exit(1);
    }
    asp_measured_free(table);
    double lowest = 1;
    for (size_t i = 0; i < grid_count; i++)
        lowest = fmin(lowest, fmin(grid[i].wi.z, grid[i].wo.z));
    printf("gridded data: %zu geometries, none beyond %.2f degrees\n", grid_count,
           acos(lowest) * 57.29577951308232);
    CHECK(lowest >= cos(80.0001 / 57.29577951308232), "a geometry beyond 80 degrees");
    CHECK(grid_count > 4000, "only %zu geometries", grid_count);
}

/* One of each kind: closed forms, a shape number, a scale of its own. */
static const asp_model *few[5];

static void choose_few(void)
{
    static const char *const names[4] = { "ggx", "beckmann", "student_t", "phong" };
    for (size_t i = 0; i < 4; i++)
        few[i] = asp_find_model(NULL, names[i]);
}

/* ------------------------------------------------------------------ coming back */

typedef struct truth { double alpha, shape[ASP_SHAPE_NUMBERS], eta, colour[6]; } truth;

static asp_material material_of(const asp_model *model, const truth *t)
{
    asp_map map;
    asp_ndf ndf;
    double alpha = model->own_scale ? 1 : t->alpha;
    if (asp_map_from_roughness(alpha, alpha, 0, 0, 0, &map, NULL)
        || asp_ndf_make(model, &map, t->shape, &ndf, NULL))
        exit(1);
    const double *x = t->colour;
    return asp_lambert_specular(&ndf, (asp_rgb){ x[0], x[1], x[2] }, (asp_rgb){ x[3], x[4], x[5] },
                                t->eta, 0);
}

/* Relative, except where infinity is the truth: then 1/value. */
static double distance(double value, double truth)
{
    if (isinf(truth))
        return isinf(value) ? 0 : 1 / value;
    return truth ? fabs(value / truth - 1) : fabs(value);
}

static double worst_of(const asp_fit_result *r, const truth *t, const char **where)
{
    double worst = 0;
    size_t map = r->model->own_scale ? 0 : 1, shapes = map + r->model->param_count;
    for (size_t k = 0; k < r->parameter_count; k++) {
        double want = k < map ? t->alpha : k < shapes ? t->shape[k - map]
                    : k == shapes ? t->eta : t->colour[k - shapes - 1];
        double d = distance(r->parameter[k].value, want);
        if (!(d <= worst)) {
            worst = d;
            *where = r->parameter[k].name;
        }
    }
    return worst;
}

static void comes_back(const asp_model *model, const truth *t, const char *loss, int table)
{
    asp_material mat = material_of(model, t);
    asp_error err;
    asp_measured *m = table ? asp_measured_from_function(of_material, &mat, "made", &err)
                            : listed(&mat, 0, 1);
    const asp_model *models[] = { model, NULL };
    asp_fit_options options = { .models = models, .loss = loss, .specular_limit = 2 };
    asp_fit_result *r = NULL;
    size_t n = 0;
    const char *where = "nothing";
    if (CHECK(m && asp_fit(m, &options, &r, &n, &err) == ASP_OK && n == 1, "%s %s: no fit",
              model->name, loss)) {
        double d = worst_of(r, t, &where);
        printf("  %-10s", model->name);
        if (!model->own_scale)
            printf(" alpha %-5g", t->alpha);
        for (size_t k = 0; k < model->param_count; k++)
            printf(" %s %-5g", model->params[k].name, t->shape[k]);
        printf(" eta %-4g %-12s %s worst %.1e (%s), %zu evaluations, %s\n", t->eta, loss,
               table ? "table" : "list ", d, where, r->evaluations, asp_fit_reason_text(r->reason));
        CHECK(d < 1e-4, "%s: %s is off by %g", r->spec, where, d);
        CHECK(r->reason > 0, "%s: %s", r->spec, asp_fit_reason_text(r->reason));
    }
    free(r);
    asp_measured_free(m);
}

/* Shape numbers to try: for a range that ends at infinity also infinity itself. */
static double shape_value(const asp_param *p, int which)
{
    if (isinf(p->high))
        return which == 0 ? p->low + 0.3 : which == 1 ? p->low + 1.875 : which == 2 ? p->low + 8
             : INFINITY;
    return p->low + (p->high - p->low) * (0.2 + 0.2 * which);
}

/* Shapes that carry a roughness, about those of the four sets below. */
static const struct { const char *model; double shape[4][2]; } own[] = {
    { "phong",             { { 16000 }, { 116 }, { 12.6 }, { 1.65 } } },
    { "torrance_sparrow",  { { 0.011 }, { 0.13 }, { 0.37 }, { 0.74 } } },
    { "abc",               { { 16000, 1.75 }, { 240, 0.8 }, { 30, 1.3 }, { 8, 2.5 } } },
    { "sgd",               { { 1e-4, 0.3 }, { 0.017, 0.9 }, { 0.14, 0.5 }, { 0.55, 1.2 } } },
    { "gtr",               { { 0.011, 1.7 }, { 0.13, 1 }, { 0.37, 3 }, { 0.74, 0.8 } } },
    { "student_t_general", { { 8000, 1.8 }, { 30, 3.375 }, { 5, 9.5 }, { 1.2, 2 } } },
};

static void own_shape(const asp_model *model, size_t set, double *shape)
{
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (!strcmp(own[i].model, model->name))
            memcpy(shape, own[i].shape[set], sizeof own[i].shape[set]);
}

static void all_come_back(void)
{
    static const struct { double alpha, eta, colour[6]; } set[] = {
        { 0.011, 1.53, { 0.21, 0.13, 0.04, 1.0, 0.93, 1.1 } },
        { 0.13, 2.7, { 0.002, 0.003, 0.001, 1.7, 1.1, 0.6 } },
        { 0.37, 1.41, { 0.6, 0.5, 0.45, 1.0, 1.0, 1.0 } },
        { 0.74, 4.3, { 0, 0, 0, 1.2, 0.9, 0.5 } }
    };
    const asp_model *models[32];
    size_t n = asp_fit_models(models, 32), losses = 0;
    int everything = getenv("ASPERITY_LONG") != NULL, sparing = 0;
#ifdef __SANITIZE_ADDRESS__
    sparing = 1;
#endif
    while (asp_losses()[losses])
        losses++;
    printf("parameters of noiseless data:\n");
    for (size_t k = 0; k < n; k++)
        for (size_t s = 0; s < sizeof set / sizeof set[0]; s++) {
            if (!everything && (sparing || models[k]->area_error > 0) && s != k % 4)
                continue;                            /* each evaluation prepares tables, or is instrumented */
            truth t = { set[s].alpha, { 0 }, set[s].eta, { 0 } };
            memcpy(t.colour, set[s].colour, sizeof t.colour);
            for (size_t i = 0; i < models[k]->param_count; i++)
                t.shape[i] = shape_value(&models[k]->params[i], (int)((s + i) % 4));
            own_shape(models[k], s, t.shape);
            comes_back(models[k], &t, asp_losses()[(s + k) % losses]->name, s == 1);
        }
}

/* ------------------------------------------------------------------ errors and specs */

/* The errors computed again from the spec, by their definitions. */
static void errors_are_what_they_say(void)
{
    asp_material mat, back;
    asp_error err;
    if (asp_material_parse(NULL, "lambert_specular:diffuse=0.1/0.2/0.3,specular=1/0.8/0.9,eta=1.7,"
                                 "ndf=(ggx:alpha=0.2)", &mat, &err))
        exit(1);
    asp_measured *m = listed(&mat, 0.2, 1);
    asp_fit_result *r = NULL;
    size_t n = 0;
    asp_fit_options nad = { .models = few, .loss = "nad" };
    if (!CHECK(asp_fit(m, &nad, &r, &n, &err) == ASP_OK, "no fit"))
        return;
    for (size_t k = 0; k < n; k++) {
        CHECK(asp_material_parse(NULL, r[k].spec, &back, &err) == ASP_OK, "not read: %s", r[k].spec);
        size_t count, rows = 0;
        const asp_measurement *g = asp_measured_geometries(m, &count);
        double nad = 0, scale = 0, log2 = 0, relative = 0, spread = 0;
        for (size_t i = 0; i < count; i++) {
            asp_rgb f = asp_eval(&back, g[i].wi, g[i].wo), e = asp_eval(&r[k].material, g[i].wi, g[i].wo);
            const double model[3] = { f.r, f.g, f.b }, data[3] = { g[i].f.r, g[i].f.g, g[i].f.b };
            spread = fmax(spread, fmax(fabs(f.r - e.r), fmax(fabs(f.g - e.g), fabs(f.b - e.b))));
            for (int c = 0; c < 3; c++, rows++) {
                double w = g[i].wi.z * g[i].wo.z;
                nad += w * fabs(model[c] - data[c]);
                scale += w * data[c];
                log2 += pow(log((1 + model[c] * g[i].wi.z) / (1 + data[c] * g[i].wi.z)), 2);
                relative += pow(log((model[c] + 1e-3) / (data[c] + 1e-3)), 2);
            }
        }
        const double want[3] = { nad / scale, sqrt(log2 / (double)rows),
                                 sqrt(relative / (double)rows) };
        for (int i = 0; i < 3; i++)
            CHECK(fabs(r[k].error[i] / want[i] - 1) < 1e-9, "%s: %s is %.12g, by definition %.12g",
                  r[k].model->name, asp_losses()[i]->name, r[k].error[i], want[i]);
        CHECK(spread == 0, "%s: the spec is another material (by %g)", r[k].spec, spread);
    }
    printf("errors of %zu fits agree with their definitions, specs read back exactly\n", n);
    free(r);
    asp_measured_free(m);
}

/* ------------------------------------------------------------------ the same bits */

static void *one_fit(void *context)
{
    asp_fit_result *r = NULL;
    size_t n;
    asp_fit_options o = { .models = few, .seed = 5, .loss = "nad" };
    return asp_fit(context, &o, &r, &n, NULL) ? NULL : r;
}

static void same_bits(void)
{
    asp_material mat;
    if (asp_material_parse(NULL, "lambert_specular:diffuse=0.1,eta=1.6,ndf=(student_t:alpha=0.15,"
                                 "gamma=2.8)", &mat, NULL))
        exit(1);
    asp_measured *m = listed(&mat, 0.1, 1);
    pthread_t other;
    pthread_create(&other, NULL, one_fit, m);
    asp_fit_result *a = one_fit(m), *c = NULL;
    void *b = NULL;
    pthread_join(other, &b);
    size_t n = 0;
    CHECK(a && b && !memcmp(a, b, 4 * sizeof *a), "two threads gave different bits");
    asp_fit_options o = { .models = few, .seed = 99, .loss = "nad" };
    CHECK(asp_fit(m, &o, &c, &n, NULL) == ASP_OK, "no fit");
    double worst = 0;
    for (size_t k = 0; a && c && k < n; k++)
        worst = fmax(worst, fabs(a[k].error[0] / c[k].error[0] - 1));
    printf("two threads: same bits; another seed: errors differ by %.1e\n", worst);
    CHECK(worst < 1e-4, "another seed ends elsewhere: %g", worst);
    free(a);
    free(b);
    free(c);
    asp_measured_free(m);
}

/* ------------------------------------------------------------------ uncertainties */

/* Over repeated noise the spread of an estimate and its stated uncertainty agree. */
static void uncertainties_hold(const char *loss)
{
    /* specular = 1 is true: a limit there would cut the spread off */
    enum { REPEATS = 24, P = ASP_FIT_PARAMETERS };
    asp_material mat;
    if (asp_material_parse(NULL, "lambert_specular:diffuse=0.2/0.1/0.3,eta=1.6,"
                                 "ndf=(ggx:alpha=0.25)", &mat, NULL))
        exit(1);
    const asp_model *models[] = { asp_find_model(NULL, "ggx"), NULL };
    double sum[P] = { 0 }, square[P] = { 0 }, stated[P] = { 0 };
    char names[P][24];
    size_t parameters = 0;
    for (int i = 0; i < REPEATS; i++) {
        asp_measured *m = listed(&mat, 0.15, 3);
        asp_fit_options o = { .models = models, .loss = loss, .starts = 1, .specular_limit = 2 };
        asp_fit_result *r = NULL;
        size_t n;
        if (asp_fit(m, &o, &r, &n, NULL))
            exit(1);
        parameters = r->parameter_count;
        for (size_t k = 0; k < parameters; k++) {
            sum[k] += r->parameter[k].value;
            square[k] += r->parameter[k].value * r->parameter[k].value;
            stated[k] += r->parameter[k].uncertainty / REPEATS;
            memcpy(names[k], r->parameter[k].name, sizeof names[k]);
        }
        free(r);
        asp_measured_free(m);
    }
    printf("stated / observed spread over %d noisy fits, %s:", REPEATS, loss);
    for (size_t k = 0; k < parameters; k++) {
        double mean = sum[k] / REPEATS;
        double sd = sqrt(fmax(0, square[k] / REPEATS - mean * mean) * REPEATS / (REPEATS - 1));
        printf(" %s %.2f", names[k], stated[k] / sd);
        /* the spread of 24 numbers is itself known to 15 %: three times that and some room */
        CHECK(stated[k] / sd > 0.55 && stated[k] / sd < 1.8, "%s, %s: states %g, varies by %g", loss,
              names[k], stated[k], sd);
    }
    printf("\n");
}

/* A mirror without a lobe says nothing about roughness: it must not claim to. */
static void undetermined_is_said(void)
{
    asp_material mat;
    if (asp_material_parse(NULL, "lambert_specular:diffuse=0.5,specular=0,ndf=(ggx:alpha=0.25)", &mat,
                           NULL))
        exit(1);
    asp_measured *m = listed(&mat, 0.05, 3);
    asp_fit_result *r = NULL;
    size_t n, open = 0;
    if (CHECK(asp_fit(m, NULL, &r, &n, NULL) == ASP_OK, "a diffuser cannot be fitted"))
        for (size_t k = 0; k < n; k++) {
            CHECK(fabs(r[k].parameter[r[k].parameter_count - 6].value - 0.5) < 0.01,
                  "diffuse of a diffuser: %g", r[k].parameter[r[k].parameter_count - 6].value);
            open += !r[k].parameter[0].determined || !r[k].parameter[r[k].parameter_count - 7].determined;
        }
    CHECK(open == n, "alpha and eta of a diffuser are said to be known in %zu of %zu fits", n - open, n);
    printf("a diffuser: alpha or eta is said to be undetermined in %zu of %zu fits\n", open, n);
    free(r);
    asp_measured_free(m);
}

/* ------------------------------------------------------------------ too little to fit */

static asp_measured *of_text(const char *text)
{
    asp_error err;
    char line[600];
    asp_measured *m = asp_measured_read_memory(text, strlen(text), "made.csv", &err);
    if (!CHECK(m != NULL, "%s", m ? "" : asp_error_text(&err, line, sizeof line)))
        exit(1);
    return m;
}

/* One channel: alpha, eta, diffuse and specular of ggx, from rows at different angles. */
static asp_measured *grey(size_t rows, double scale)
{
    char text[8000] = "theta_i_deg,phi_i_deg,theta_o_deg,phi_o_deg,f\n";
    for (size_t i = 0; i < rows; i++)
        sprintf(text + strlen(text), "%d,0,%d,180,%.17g\n", 10 + 7 * (int)(i % 8), (int)(i * 11 % 70),
                scale * (1 + random_number()));
    return of_text(text);
}

static void too_little(void)
{
    const asp_model *models[] = { asp_find_model(NULL, "ggx"), NULL };
    asp_fit_options o = { .models = models, .specular_limit = 2 };
    asp_error err;
    asp_fit_result *r = NULL;
    size_t n = 0;
    asp_measured *m = grey(40, 0);
    CHECK(asp_fit(m, &o, &r, &n, &err) == ASP_EFORMAT && strstr(err.reason, "every value is 0"),
          "zeros: %s", err.reason);
    asp_measured_free(m);
    m = grey(3, 1);
    CHECK(asp_fit(m, &o, &r, &n, &err) == ASP_EFORMAT && strstr(err.reason, "3 values")
          && strstr(err.reason, "4 parameters"), "three values: %s", err.reason);
    asp_measured_free(m);
    CHECK(!r && !n, "results written on failure");
    m = grey(4, 1);
    if (CHECK(asp_fit(m, &o, &r, &n, &err) == ASP_OK, "four values: %s", err.reason)) {
        CHECK(r->parameter_count == 4, "one channel: %zu parameters", r->parameter_count);
        for (size_t k = 0; k < r->parameter_count; k++)
            CHECK(isinf(r->parameter[k].uncertainty) && !r->parameter[k].determined,
                  "four values: %s +- %g", r->parameter[k].name, r->parameter[k].uncertainty);
    }
    printf("too little: zeros and three values refused, four values determine nothing\n");
    free(r);
    asp_measured_free(m);
}

/* ------------------------------------------------------------------ refusals */

static int stop(void *context, double done)
{
    double *last = context;
    int good = done >= *last && done <= 1;
    *last = good ? done : -1;
    return done > 0.2;
}

static void refusals(void)
{
    asp_material mat;
    asp_error err;
    asp_fit_result *r = NULL;
    size_t n = 0;
    double last = 0;
    if (asp_material_parse(NULL, "lambert_specular:ndf=(ggx:alpha=0.25)", &mat, NULL))
        exit(1);
    asp_measured *m = listed(&mat, 0, 1);
    asp_fit_options bad_loss = { .loss = "nadd" }, bad_starts = { .starts = 65 };
    asp_fit_options cancel = { .progress = stop, .context = &last }, bad_mask = { .mask = 7 };
    asp_fit_options bad_limit = { .specular_limit = 2000 };
    CHECK(asp_fit(m, &bad_loss, &r, &n, &err) == ASP_EUNKNOWN && strstr(err.reason, "nad, log"),
          "unknown loss: %s", err.reason);
    CHECK(asp_fit(m, &bad_starts, &r, &n, &err) == ASP_EINVAL && !strcmp(err.name, "starts"),
          "65 starts: %s", err.name);
    CHECK(asp_fit(m, &bad_limit, &r, &n, &err) == ASP_EINVAL && !strcmp(err.name, "specular_limit"),
          "specular limit 2000: %s", err.name);
    CHECK(asp_fit(m, &bad_mask, &r, &n, &err) == ASP_EINVAL, "mask 7");
    CHECK(asp_fit(m, &cancel, &r, &n, &err) == ASP_ECANCELLED, "not cancelled");
    CHECK(last > 0.2, "progress went backwards or nowhere: %g", last);
    CHECK(asp_fit(NULL, NULL, &r, &n, &err) == ASP_EINVAL, "no measurement");
    CHECK(!r && !n, "results written on failure");
    printf("refusals: loss, starts, mask, cancelled, no measurement\n");
    asp_measured_free(m);
}

int main(void)
{
    make_grid();
    choose_few();
    all_come_back();
    errors_are_what_they_say();
    same_bits();
    uncertainties_hold("nad");
    uncertainties_hold("log");
    undetermined_is_said();
    too_little();
    refusals();
    free(grid);
    return finish();
}
