/* test_slopes.c - measured slopes from files: counting, grids, height fields, specs, refusals */
#define _POSIX_C_SOURCE 200809L
#include "data_test.h"
#include "data/slopes.h"

static double near(double a, double b) { return fabs(a - b) / fmax(fabs(b), 1e-300); }

static void write_file(const char *path, const char *text) { write_bytes(path, text, strlen(text)); }

static char csv[600];

static asp_status read_spec(const char *keys, asp_ndf *ndf, void **memory, asp_error *err)
{
    char spec[700];
    snprintf(spec, sizeof spec, "histogram:file=%s%s", csv, keys);
    return asp_ndf_read(NULL, spec, ndf, memory, err);
}

/* ------------------------------------------------------------------ what is counted */

static void lists(void)
{
    asp_ndf ndf;
    asp_error err;
    void *memory = NULL;
    /* four cells of 0.5 x 0.5 around 0; one slope outside goes to the cell next to it */
    write_file(csv, "# made by hand\np_x ; name ; p_y ; weight\n-0.25;a;-0.1;1\n 0.1;b;-0.4;2\n"
                    "-0.4;c;0.3;3\n\n0.2;d;0.2;4\n3;e;0.1;6\n");
    CHECK(read_spec(",bins=2,range=0.5", &ndf, &memory, &err) == ASP_OK, "a list is read");
    CHECK(near(asp_P22(&ndf, -0.3, -0.3), 1.0 / 16 / 0.25) < 1e-14, "cell 1");
    CHECK(near(asp_P22(&ndf, 0.3, -0.3), 2.0 / 16 / 0.25) < 1e-14, "cell 2");
    CHECK(near(asp_P22(&ndf, -0.3, 0.3), 3.0 / 16 / 0.25) < 1e-14, "cell 3");
    CHECK(near(asp_P22(&ndf, 0.3, 0.3), 10.0 / 16 / 0.25) < 1e-14, "cell 4, and what lies beyond it");
    CHECK(near(asp_mean_slope(&ndf).x, 0.25 * (12 - 4) / 16) < 1e-14, "mean of the cells");
    free(memory);
    CHECK(read_spec(",bins=2/1,range=-0.5/0.5/-2/2,alpha=2,mean_x=1", &ndf, &memory, &err) == ASP_OK, "two bins");
    CHECK(near(asp_P22(&ndf, 1 + 2 * 0.3, 1), 12.0 / 16 / 2 / 4) < 1e-14, "through the slope map");
    CHECK(near(asp_mean_slope(&ndf).x, 1 + 2 * 0.25 * (12 - 4) / 16) < 1e-14, "its mean, too");
    free(memory);
    write_file(csv, "p_x,p_y\n0.1,0.2\n");
    CHECK(read_spec("", &ndf, &memory, &err) == ASP_OK, "one slope");
    CHECK(fabs(asp_mean_slope(&ndf).x - 0.1) < 1e-3 && asp_P22(&ndf, 0.1, 0.2) > 0, "lies where it was");
    free(memory);
}

static void grids(void)
{
    asp_ndf ndf;
    asp_error err;
    void *memory = NULL;
    write_file(csv, "slope_x,slope_y,P22\n0.1,-1,1\n-0.1,-1,2\n0.3,-1,3\n0.1,1,4\n0.3,1,5\n-0.1,1,1e-9\n");
    CHECK(read_spec("", &ndf, &memory, &err) == ASP_OK, "a grid in any order");
    CHECK(near(asp_P22(&ndf, 0.31, 1.5), 5 / ((15 + 1e-9) * 0.2 * 2)) < 1e-13, "upper right");
    CHECK(near(asp_P22(&ndf, -0.19, -1.9), 2 / ((15 + 1e-9) * 0.2 * 2)) < 1e-13, "lower left");
    CHECK(asp_P22(&ndf, 0.41, 0) == 0 && asp_P22(&ndf, 0, -2.1) == 0, "nothing outside");
    free(memory);
}

/* ------------------------------------------------------------------ refusals */

static const struct { const char *text, *keys; asp_status status; long long line; const char *name; } bad[] = {
    { "p_x,p_y\n0.1,x\n", "", ASP_EPARSE, 2, "p_y" },
    { "p_x,p_y\n\n0.1\n", "", ASP_EPARSE, 3, "p_y" },
    { "p_x,p_y,weight\n0,0,-1\n", "", ASP_EINVAL, 2, "weight" },
    { "p_x,p_y,weight\n0,1001,1\n", "", ASP_EINVAL, 2, "p_y" },
    { "p_x,p_y,weight\n0,0,nan\n", "", ASP_EPARSE, 2, "weight" },
    { "p_x,p_y,weight\n0,0,0\n", "", ASP_EINVAL, 0, "slopes" },
    { "p_x,weight\n0,0\n", "", ASP_EPARSE, 1, "p_y" },
    { "p_x,p_y,weight,density\n0,0,1,1\n", "", ASP_EPARSE, 1, "weight" },
    { "p_x,p_x,p_y\n0,0,1\n", "", ASP_EPARSE, 1, "p_x" },
    { "", "", ASP_EFORMAT, 0, "" },
    { "p_x,p_y\n", "", ASP_EFORMAT, 0, "" },
    { "\x01\x02", "", ASP_EFORMAT, 0, "" },
    { "p_x,p_y,density\n0,0,1\n1,0,1\n0,1,1\n", "", ASP_EFORMAT, 0, "density" },
    { "p_x,p_y,density\n0,0,1\n1,0,1\n0,1,1\n0,1,2\n", "", ASP_EFORMAT, 5, "density" },
    { "p_x,p_y,density\n0,0,1\n1,0,1\n1.7,0,1\n0,1,1\n1,1,1\n1.7,1,1\n", "", ASP_EFORMAT, 0, "p_x" },
    { "p_x,p_y,density\n0,0,1\n1,0,1\n0,1,1\n1,1,1\n", ",bins=3", ASP_EINVAL, 0, "bins" },
    { "p_x,p_y,density\n0,0,0\n1,0,0\n0,1,0\n1,1,0\n", "", ASP_EINVAL, 0, "values" },
    { "p_x,p_y\n0,0\n", ",bins=0", ASP_EINVAL, 0, "bins" },
    { "p_x,p_y\n0,0\n", ",bins=1025", ASP_EINVAL, 0, "bins" },
    { "p_x,p_y\n0,0\n", ",bins=2.5", ASP_EINVAL, 0, "bins" },
    { "p_x,p_y\n0,0\n", ",bins=2/3/4", ASP_EPARSE, 0, "bins" },
    { "p_x,p_y\n0,0\n", ",range=1/2", ASP_EPARSE, 0, "range" },
    { "p_x,p_y\n0,0\n", ",range=1/-1/0/1", ASP_EINVAL, 0, "range" },
    { "p_x,p_y\n0,0\n", ",range=-1", ASP_EINVAL, 0, "range" },
    { "p_x,p_y\n0,0\n", ",range=2000", ASP_EINVAL, 0, "range" },
    { "p_x,p_y\n0,0\n", ",gamma=2", ASP_EUNKNOWN, 0, "gamma" },
    { "p_x,p_y\n0,0\n", ",alpha=0", ASP_EINVAL, 0, "alpha" },
};

static void refusals(void)
{
    asp_ndf ndf;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        asp_error err;
        void *memory = (void *)&err;
        char text[500];
        memset(&err, 0, sizeof err);
        write_file(csv, bad[i].text);
        asp_status s = read_spec(bad[i].keys, &ndf, &memory, &err);
        CHECK(s == bad[i].status && err.line == bad[i].line && !strcmp(err.name, bad[i].name) && !memory,
              "refusal %zu: status %d, %s", i, s, asp_error_text(&err, text, sizeof text));
    }
    asp_error err;
    void *memory;
    CHECK(asp_ndf_read(NULL, "histogram:bins=4", &ndf, &memory, &err) == ASP_EINVAL && !strcmp(err.name, "file"),
          "no file");
    CHECK(asp_ndf_read(NULL, "histogram", &ndf, &memory, &err) == ASP_EINVAL, "no keys at all");
    CHECK(asp_ndf_read(NULL, "histogram:file=nowhere.csv", &ndf, &memory, &err) == ASP_EIO, "no such file");
    CHECK(asp_ndf_read(NULL, "histograms:file=x", &ndf, &memory, &err) == ASP_EUNKNOWN && err.position == 0,
          "another name");
    CHECK(asp_ndf_read(NULL, "ggx:alpha=0.3", &ndf, &memory, &err) == ASP_OK && !memory, "no file needed");
}

/* ------------------------------------------------------------------ materials, positions */

static void materials(void)
{
    asp_material mat;
    asp_error err;
    void *memory;
    char spec[800];
    write_file(csv, "p_x,p_y\n0,0.1\n0.2,0.3\n-0.2,0.1\n");
    snprintf(spec, sizeof spec, "conductor:metal=Au,ndf=(histogram:file=%s,bins=8,alpha=0.5),mask=uncorrelated", csv);
    CHECK(asp_material_read(NULL, spec, &mat, &memory, &err) == ASP_OK, "a material");
    asp_vec3 up = { 0, 0, 1 };
    CHECK(mat.mask == ASP_MASK_UNCORRELATED && fabs(asp_sigma(&mat.ndf, up) - 1) < 1e-14
          && asp_mean_slope(&mat.ndf).y > 0.05, "its parts");
    free(memory);
    snprintf(spec, sizeof spec, "conductor:metal=Au,ndf=(histogram:file=%s,bins=8,alpha=-1)", csv);
    CHECK(asp_material_read(NULL, spec, &mat, &memory, &err) == ASP_EINVAL
          && err.position == strstr(spec, "-1") - spec, "the byte of a wrong number");
    snprintf(spec, sizeof spec, "conductor:metal=Xx,ndf=(histogram:file=%s)", csv);
    CHECK(asp_material_read(NULL, spec, &mat, &memory, &err) == ASP_EUNKNOWN && err.position == 16,
          "the byte of a wrong metal");
    snprintf(spec, sizeof spec, "conductor:metal=Au,ndf=(histogram:file=%s),colour=3", csv);
    CHECK(asp_material_read(NULL, spec, &mat, &memory, &err) == ASP_EUNKNOWN
          && err.position == strstr(spec, "colour") - spec, "the byte of a key behind it");
    snprintf(spec, sizeof spec, "conductor:metal=Au,ndf=(histogram:file=%s,bins=0)", csv);
    CHECK(asp_material_read(NULL, spec, &mat, &memory, &err) == ASP_EINVAL
          && err.position == strstr(spec, "=0)") - spec + 1, "the byte of wrong bins");
}

/* ------------------------------------------------------------------ a fabricated height field */

/* Facets are those of a Student-t surface: their histogram masks as it does, within what cells of 4/96
 * standard deviations and the grid's correlation leave; so does the fit's best member. */
static void fabricated(void)
{
    asp_surface_recipe recipe = asp_surface_recipe_default();
    asp_height_field field;
    asp_slope_statistics st;
    asp_ndf ndf, fit;
    asp_error err;
    void *memory;
    char spec[100];
    double worst = 0;
    recipe.size = 512;
    recipe.gamma = 6;
    if (asp_height_field_make(&recipe, &field, &err) || asp_height_field_slopes(&field, &st, &err)
        || asp_height_field_histogram(&field, 192, 192, NULL, NULL, &memory, &ndf, &err)) {
        CHECK(0, "a height field: %s", err.reason);
        return;
    }
    snprintf(spec, sizeof spec, "student_t:alpha=%.9g,gamma=%.9g", st.alpha, st.gamma);
    CHECK(asp_ndf_parse(NULL, spec, &fit, NULL) == ASP_OK, "%s", spec);
    for (int i = 1; i < 90; i++)
        for (int k = 0; k < 8; k++) {
            double theta = i * 1.5707963 / 90, phi = k * 0.7853981;
            asp_vec3 w = { sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta) };
            worst = fmax(worst, fabs(asp_G1(&ndf, w, 0) - asp_G1(&fit, w, 0)));
        }
    printf("  G1 of the facets' histogram against %s: %.2g\n", spec, worst);
    CHECK(worst < 0.02, "G1 differs by %g", worst);
    CHECK(fabs(asp_mean_slope(&ndf).x - st.mean_x) < 1e-3, "mean slope");
    free(memory);
    asp_slope_range narrow = { 1, 1, 0, 1 };
    memory = NULL;
    CHECK(asp_height_field_histogram(&field, 8, 8, &narrow, NULL, &memory, &ndf, &err) == ASP_EINVAL && !memory,
          "a range of no width");
    CHECK(asp_height_field_histogram(&field, 0, 8, NULL, NULL, &memory, &ndf, &err) == ASP_EINVAL && !memory,
          "no bins");
    asp_height_field_free(&field);
}

int main(void)
{
    snprintf(csv, sizeof csv, "%s", temporary_path("slopes.csv"));
    lists();
    grids();
    refusals();
    materials();
    fabricated();
    remove(csv);
    rmdir(folder_);
    return finish();
}
