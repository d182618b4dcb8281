/* test_data_reference.c - real measurements: RGL files against the values of the database's own
 * loader, MERL slices, Cornell, Starlink. Needs the folder $ASPERITY_SHARED (default ../shared). */
#define _POSIX_C_SOURCE 200809L
#include "data_test.h"

#include <dirent.h>

static const char *shared(const char *path)
{
    static char text[4][900];
    static int turn;
    const char *base = getenv("ASPERITY_SHARED");
    turn = (turn + 1) % 4;
    snprintf(text[turn], sizeof text[turn], "%s/data/%s", base && base[0] ? base : "../shared", path);
    return text[turn];
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* <name>.powitacq_reference.csv: rows `eval,wi,wo,f cos(theta_o) as r, g, b,pdf`, computed in
 * float32 by rgl-epfl/brdf-loader with clipping on. */
static void check_rgl(const char *bsdf, const char *csv, const char *name)
{
    enum { MOST = 6000 };
    static double deviation[MOST];
    asp_error err;
    char text[600], line[600];
    asp_measured *m = asp_measured_read(bsdf, &err);
    if (!CHECK(m != NULL, "%s", m ? "" : asp_error_text(&err, text, sizeof text)))
        return;
    FILE *file = fopen(csv, "r");
    if (!CHECK(file != NULL, "no reference %s", csv)) {
        asp_measured_free(m);
        return;
    }
    size_t n = 0, dark = 0;
    while (fgets(line, sizeof line, file) && n + 3 <= MOST) {
        asp_vec3 wi, wo;
        double want[3];
        if (sscanf(line, "eval,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &wi.x, &wi.y, &wi.z, &wo.x,
                   &wo.y, &wo.z, &want[0], &want[1], &want[2]) != 9)
            continue;
        asp_rgb f = asp_measured_eval(m, wi, wo);
        const double got[3] = { f.r * wo.z, f.g * wo.z, f.b * wo.z };
        double most = fmax(want[0], fmax(want[1], want[2]));
        for (int c = 0; c < 3; c++) {
            /* clipped channels are exact zeros; next to them the sign alone decides */
            if (want[c] == 0 || got[c] == 0) {
                dark++;
                CHECK(fabs(got[c] - want[c]) <= 1e-4 * most, "%s: %g, not %g", name, got[c], want[c]);
                continue;
            }
            deviation[n++] = fabs(got[c] / want[c] - 1);
        }
    }
    fclose(file);
    qsort(deviation, n, sizeof *deviation, by_value);
    double p50 = deviation[n / 2], p90 = deviation[n * 9 / 10], p99 = deviation[n * 99 / 100];
    printf("%-28s %5zu values: median %.1e  90 %% %.1e  99 %% %.1e  largest %.1e; %zu clipped\n",
           name, n, p50, p90, p99, deviation[n - 1], dark);
    CHECK(n >= 600 && p99 < 1e-4, "%s: 99 %% within 1e-4 (%g)", name, p99);
    CHECK(p50 < 1e-5, "%s: median within 1e-5 (%g)", name, p50);
    asp_measured_free(m);
}

static void check_all_rgl(void)
{
    DIR *folder = opendir(shared("rgl"));
    struct dirent *entry;
    int files = 0;
    while (folder && (entry = readdir(folder)) != NULL) {
        char bsdf[1300], csv[1300];
        size_t n = strlen(entry->d_name);
        if (n < 6 || strcmp(entry->d_name + n - 5, ".bsdf") != 0)
            continue;
        snprintf(bsdf, sizeof bsdf, "%s/%s", shared("rgl"), entry->d_name);
        snprintf(csv, sizeof csv, "%.*s.powitacq_reference.csv", (int)strlen(bsdf) - 5, bsdf);
        check_rgl(bsdf, csv, entry->d_name);
        files++;
    }
    if (folder)
        closedir(folder);
    CHECK(files > 0, "RGL files are there");
}

typedef struct expected {
    const char *path, *format;
    int channels;
    size_t rows;
    asp_vec3 wi, wo;                     /* a listed geometry */
    double f;                            /* and its green value */
} expected;

/* Tables: rows counted in the file, and a value read from it by eye. */
static void check_tables(void)
{
    const double d = 3.14159265358979323846 / 180;
    const expected list[] = {
        { "measured/merl_subset/aluminium_inplane_lumos.csv", "lumos", 1, 1785,
          direction_of(11.25 * d, 180 * d), direction_of(-87.1875 * d, 0), 0.0026 },
        { "measured/starlink_scatterworks/chassis_brdf.csv", "lumos", 1, 716,
          direction_of(75 * d, -180 * d), direction_of(-84 * d, 0), 2.2081e-2 },
        { "measured/starlink_scatterworks/solar_array_brdf.csv", "lumos", 1, 716,
          direction_of(75 * d, -180 * d), direction_of(-80 * d, 0), 1.57758e-3 },
        { "measured/merl_subset/red-fabric_phid90_slice.csv", "csv", 3, 7740,
          { 0, 0, 1 }, { 0, 0, 1 }, 0.016953 },
        { "measured/cornell_pbrt2/cayman.brdf", "cornell", 3, 1439,
          direction_of(0.872665, 0), direction_of(0.573513, 0), -1 },
        { "measured/cornell_pbrt2/acryl_blue.brdf", "cornell", 3, 1439,
          direction_of(0.872665, 0), direction_of(0.573513, 0), -1 },
        { "measured/cornell_pbrt2/garnet_red.brdf", "cornell", 3, 1439,
          direction_of(0.872665, 0), direction_of(0.573513, 0), -1 },
    };
    for (size_t i = 0; i < sizeof list / sizeof list[0]; i++) {
        const expected *e = &list[i];
        asp_error err;
        char text[600];
        asp_measured *m = asp_measured_read(shared(e->path), &err);
        if (!CHECK(m != NULL, "%s", m ? "" : asp_error_text(&err, text, sizeof text)))
            continue;
        asp_measured_info info = asp_measured_get_info(m);
        size_t count = 0;
        const asp_measurement *g = asp_measured_geometries(m, &count);
        CHECK(!strcmp(info.format, e->format) && info.channels == e->channels && info.scattered
              && info.isotropic && count == e->rows && info.samples == count,
              "%s: %s, %d channels, %zu rows", e->path, info.format, info.channels, count);
        asp_rgb f = asp_measured_eval(m, e->wi, e->wo);
        if (e->f >= 0)
            CHECK(fabs(f.g - e->f) < 1e-9, "%s: %.9g, not %.9g", e->path, f.g, e->f);
        /* where wo is nearest the mirror of wi, f cos is largest: the conventions are right */
        size_t best = 0;
        for (size_t k = 1; k < count; k++)
            if (g[k].f.g * g[k].wo.z > g[best].f.g * g[best].wo.z)
                best = k;
        double across = fabs(g[best].wi.x + g[best].wo.x) + fabs(g[best].wi.y + g[best].wo.y);
        printf("%-52s %s, %zu rows, peak %.0f %% off the mirror direction\n", e->path, info.format,
               count, 100 * across);
        CHECK(across < 0.06, "%s: the highlight is where a mirror's is (%g)", e->path, across);
        asp_measured_free(m);
    }
}

/* Cornell's spectra as colours: the blue paint, 0.034 at 440..450 nm and almost black above 520 nm,
 * is a blue beyond sRGB; the red one is 0.05 above 620 nm and 0.005 between 500 and 580. */
static void check_colours(void)
{
    asp_error err;
    asp_measured *blue = asp_measured_read(shared("measured/cornell_pbrt2/acryl_blue.brdf"), &err);
    asp_measured *red = asp_measured_read(shared("measured/cornell_pbrt2/garnet_red.brdf"), &err);
    asp_vec3 wi = direction_of(0.872665, 0), wo = direction_of(0.573513, 0);
    asp_rgb b = asp_measured_eval(blue, wi, wo), r = asp_measured_eval(red, wi, wo);
    printf("acryl_blue %.5f %.5f %.5f   garnet_red %.5f %.5f %.5f\n", b.r, b.g, b.b, r.r, r.g, r.b);
    CHECK(b.b > 10 * b.g && b.b > 10 * b.r && b.r >= 0 && b.g >= 0 && b.b > 0.025 && b.b < 0.036,
          "blue is blue, and the rest of it inside the gamut");
    CHECK(r.r > 2 * r.g && r.g > 0 && r.r > 0.03 && r.r < 0.05, "red is red");
    asp_measured_free(blue);
    asp_measured_free(red);
}

/* Files of the same folders that hold no measurement this library reads. */
static void check_refused(void)
{
    const char *const list[] = {
        "measured/jsss_mwir/jsss_mwir_brdf.csv", "measured/merl_subset/alta_data-example-01.exr",
        "measured/merl_subset/pink-felt-1d.alta", "merl/nbrdf_merl.f32", "merl/README.txt", "merl",
    };
    for (size_t i = 0; i < sizeof list / sizeof list[0]; i++) {
        asp_error err;
        char text[900];
        asp_measured *m = asp_measured_read(shared(list[i]), &err);
        CHECK(!m && strstr(asp_error_text(&err, text, sizeof text), list[i]), "%s is refused by name",
              list[i]);
        asp_measured_free(m);
    }
}

int main(void)
{
    if (access(shared("rgl"), R_OK) != 0) {
        printf("skipped: no reference data; set ASPERITY_SHARED\n");
        return 77;
    }
    check_all_rgl();
    check_tables();
    check_colours();
    check_refused();
    return finish();
}
