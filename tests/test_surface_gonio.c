/* test_surface_gonio.c - the tracer and the virtual gonioreflectometer against what is known */
#define _POSIX_C_SOURCE 200809L
#include "core/rng.h"
#include "data_test.h"
#include "surface/surface.h"

static aspi_tracer *trace_field(asp_height_field *field)
{
    asp_error err;
    aspi_tracer *tracer = aspi_tracer_make(field, &err);
    CHECK(tracer != NULL, "no tracer: %s %s", err.name, err.reason);
    return tracer;
}

static double distance(asp_vec3 a, asp_vec3 b)
{
    return fmax(fabs(a.x - b.x), fmax(fabs(a.y - b.y), fabs(a.z - b.z)));
}

/* Flat: the mirror direction after one bounce, with the Fresnel term of the angle. */
static void test_flat(void)
{
    enum { N = 16 };
    float h[N * N];
    for (int i = 0; i < N * N; ++i)
        h[i] = 3.25f;
    asp_height_field field = { N, N, 1, 1, 1, h };
    aspi_tracer *tracer = trace_field(&field);
    const asp_metal *gold = asp_find_metal("Au");
    double worst = 0, fresnel = 0;
    int lost = 0, bounces = 0;
    for (int i = 0; tracer && i < 20000; ++i) {
        asp_vec3 wi = random_direction(), mirror = { -wi.x, -wi.y, wi.z };
        aspi_path path;
        if (!aspi_trace(tracer, random_number(), random_number(), wi, gold, &path)) {
            ++lost;
            continue;
        }
        bounces += path.bounces;
        worst = fmax(worst, distance(path.wo, mirror));
        fresnel = fmax(fresnel, fabs(path.weight.g - asp_fresnel_conductor(wi.z, gold->eta.g,
                                                                           gold->k.g)));
    }
    CHECK(lost == 0 && bounces == 20000, "%d rays lost, %d bounces", lost, bounces);
    CHECK(worst < 1e-12, "off the mirror direction by %g", worst);
    CHECK(fresnel < 1e-12, "off the Fresnel term by %g", fresnel);
    aspi_tracer_free(tracer);
    aspi_tracer_free(NULL);
}

/* Grooves along y of slope +-s, one period 8 steps wide, as high as they are anywhere. */
static void groove(float *h, int n, double s)
{
    for (int i = 0; i < n * n; ++i)
        h[i] = (float)(s * abs(i % n % 8 - 4));
}

static void test_grooves(void)
{
    enum { N = 32 };
    float h[N * N];
    asp_height_field field = { N, N, 1, 1, 1, h };

    /* right angles: light in the plane across them returns where it came from, off two facets */
    groove(h, N, 1);
    aspi_tracer *tracer = trace_field(&field);
    double worst = 0;
    int twice = 0;
    for (int i = 0; tracer && i < 5000; ++i) {
        double angle = 0.7 * (random_number() - 0.5);
        asp_vec3 wi = { sin(angle), 0, cos(angle) };
        aspi_path path;
        if (!aspi_trace(tracer, random_number(), random_number(), wi, NULL, &path))
            continue;
        if (path.bounces == 2) {
            ++twice;
            worst = fmax(worst, distance(path.wo, wi));
        }
    }
    CHECK(worst < 1e-12, "a retroreflector returns light off by %g", worst);
    /* of the light that falls on a groove at an angle t the share 1 - tan|t| meets both walls: the
       rest meets the wall that faces it once; mean of 1 - tan|t| over |t| < 0.35 */
    double share = 1 + log(cos(0.35)) / 0.35;
    CHECK(fabs(twice / 5000.0 - share) < 0.02, "%.4f meet two walls, expected %.4f", twice / 5000.0,
          share);
    /* a metal takes its share at both walls, at the angles 45 deg - t and 45 deg + t */
    const asp_metal *gold = asp_find_metal("Au");
    double t = 0.2, half = sqrt(0.5), fresnel = 0;
    double expected = asp_fresnel_conductor(half * (cos(t) + sin(t)), gold->eta.b, gold->k.b)
                    * asp_fresnel_conductor(half * (cos(t) - sin(t)), gold->eta.b, gold->k.b);
    for (int i = 0; tracer && i < 100; ++i) {
        aspi_path path;
        if (aspi_trace(tracer, random_number(), random_number(), direction_of(t, 0), gold, &path)
            && path.bounces == 2)
            fresnel = fmax(fresnel, fabs(path.weight.b - expected));
    }
    CHECK(fresnel < 1e-12, "two bounces in gold off by %g", fresnel);
    aspi_tracer_free(tracer);

    /* shallow: straight down, either wall sends it to an angle twice its own */
    groove(h, N, 0.25);
    tracer = trace_field(&field);
    double sine = 2 * 0.25 / (1 + 0.0625);
    int right = 0, wrong = 0;
    for (int i = 0; tracer && i < 5000; ++i) {
        aspi_path path;
        asp_vec3 up = { 0, 0, 1 };
        if (aspi_trace(tracer, random_number(), random_number(), up, NULL, &path)
            && path.bounces == 1 && fabs(fabs(path.wo.x) - sine) < 1e-12 && path.wo.y == 0)
            right += path.wo.x > 0;
        else
            ++wrong;
    }
    CHECK(wrong == 0, "%d rays do not leave a shallow groove as they should", wrong);
    CHECK(abs(right - 2500) < 150, "%d of 5000 go right", right);
    aspi_tracer_free(tracer);
}

/* The same field moved by some steps is the same surface: no edge is seen. */
static void test_no_edge(void)
{
    enum { N = 64, MOVED_X = 30, MOVED_Y = 22 };
    asp_surface_recipe recipe = { .seed = 2, .size = N, .correlation = 4, .patch = 2, .alpha = 0.4,
                                  .gamma = 3 };
    asp_height_field field;
    float moved[N * N];
    asp_error err;
    CHECK(asp_height_field_make(&recipe, &field, &err) == ASP_OK, "no surface");
    for (int y = 0; y < N; ++y)
        for (int x = 0; x < N; ++x)
            moved[(y + MOVED_Y) % N * N + (x + MOVED_X) % N] = field.heights[y * N + x];
    asp_height_field other = { N, N, 1, 1, 1, moved };
    aspi_tracer *a = trace_field(&field), *b = trace_field(&other);
    int same = 0, lost = 0, oblique = 0;
    enum { RAYS = 50000 };
    for (int i = 0; a && b && i < RAYS; ++i) {
        double u = random_number(), v = random_number();
        asp_vec3 wi = random_direction();
        aspi_path p, q;
        if (!aspi_trace(a, u, v, wi, NULL, &p)
            || !aspi_trace(b, fmod(u + (double)MOVED_X / N, 1), fmod(v + (double)MOVED_Y / N, 1),
                           wi, NULL, &q)) {
            ++lost;
            continue;
        }
        oblique += wi.z < 0.2;
        same += distance(p.wo, q.wo) < 1e-9;
    }
    /* a ray within rounding of the edge of a facet may choose its neighbour */
    printf("moved field: %d of %d rays the same, %d grazing\n", same, RAYS, oblique);
    CHECK(lost == 0 && same > RAYS - RAYS / 500, "%d rays lost, %d the same", lost, same);
    CHECK(oblique > RAYS / 10, "too few rays cross the edge");
    aspi_tracer_free(a);
    aspi_tracer_free(b);
    asp_height_field_free(&field);
}

static void test_refused_fields(void)
{
    float h[9] = { 0 };
    asp_height_field odd = { 3, 3, 1, 1, 1, h }, open_edge = { 2, 2, 1, 1, 0, h };
    asp_height_field gap = { 2, 2, 1, 1, 1, (float[]){ 0, 0, NAN, 0 } };
    CHECK(!aspi_tracer_make(&odd, NULL), "an odd field is traced");
    CHECK(!aspi_tracer_make(&open_edge, NULL), "a field with edges is traced");
    CHECK(!aspi_tracer_make(&gap, NULL), "a field with gaps is traced");
}

/* Perfectly diffuse counts without a surface: f = 1/pi in every cell, up to the horizon. */
static void test_table_of_diffuser(void)
{
    enum { RAYS = 4000000 };
    aspi_counts *counts = calloc(1, sizeof *counts);
    double *values = malloc(sizeof *values * 3 * 90 * 90 * 180);
    if (!counts || !values)
        exit(1);
    uint64_t start = aspi_random_start(3, 0);
    for (uint64_t i = 0; i < RAYS; ++i) {
        double z[4];
        for (uint64_t k = 0; k < 4; ++k)
            z[k] = aspi_unit64(aspi_random_at(start, 4 * i + k));
        asp_vec3 wi = { sqrt(z[0]), 0, sqrt(1 - z[0]) };
        double phi = 2 * ASPI_PI * z[2];
        aspi_path path = { { sqrt(z[1]) * cos(phi), sqrt(z[1]) * sin(phi), sqrt(1 - z[1]) },
                           { 1, 0.5, 0.25 }, 1 };
        aspi_gonio_add(counts, wi, &path);
    }
    counts->rays = RAYS;
    asp_fabrication_report report = { 0 };
    asp_error err;
    CHECK(aspi_gonio_table(counts, values, &report, &err) == ASP_OK, "no table");
    /* errors weighted as the cells were filled: by cos_i cos_o dwi dwo */
    double sum = 0, square = 0, weights = 0, worst = 0;
    size_t n = 0, wrong_channels = 0, misplaced = 0, missing = 0, grazing = 0, plane = 90u * 90 * 180;
    for (size_t i = 0; i < plane; ++i) {
        double root = ((double)(i / 16200) + 0.5) / 90;
        aspi_half a = { 0.5 * ASPI_PI * root * root, 0,
                        ((double)(i / 180 % 90) + 0.5) * ASPI_PI / 180,
                        ((double)(i % 180) + 0.5) * ASPI_PI / 180 };
        asp_vec3 wi, wo;
        aspi_half_to(a, &wi, &wo);
        int above = wi.z > 1e-9 && wo.z > 1e-9, below = wi.z < -1e-9 || wo.z < -1e-9;
        misplaced += below && values[i] >= 0;
        missing += above && !(values[i] >= 0);
        grazing += above && wi.z * wo.z < 0.01;
        if (!(values[i] >= 0))
            continue;
        double off = values[i] * ASPI_PI - 1;
        double weight = wi.z * wo.z * sin(2 * a.theta_d) * sin(a.theta_h) * root;
        wrong_channels += !(fabs(values[i] - 2 * values[plane + i]) < 1e-6 * values[i])
                       || !(fabs(values[i] - 4 * values[2 * plane + i]) < 1e-6 * values[i]);
        sum += weight * off;
        square += weight * off * off;
        weights += weight;
        worst = fmax(worst, fabs(off));
        ++n;
    }
    double mean = sum / weights, rms = sqrt(square / weights);
    printf("diffuser: %zu values, mean error %.4f, rms %.4f, worst %.3f, reported noise %.4f\n", n,
           mean, rms, worst, report.noise);
    CHECK(misplaced == 0, "%zu values below the horizon", misplaced);
    /* no ray at all came to the most grazing cells */
    CHECK(n > 1000000 && missing < grazing / 10, "%zu values, %zu missing of %zu grazing", n,
          missing, grazing);
    CHECK(wrong_channels == 0, "%zu values with channels mixed up", wrong_channels);
    CHECK(fabs(mean) < 0.002, "biased by %g", mean);
    CHECK(rms < 1.5 * report.noise, "rms %g for a reported noise of %g", rms, report.noise);
    free(counts);
    free(values);
}

/* All rays of a reflecting surface leave upward, and the table gives the power back. */
static void test_energy(void)
{
    asp_fabrication what = asp_fabrication_default();
    asp_fabrication_report r;
    asp_error err;
    what.metal = NULL;
    what.rays = 2000000;
    asp_measured *m = asp_fabricate(&what, NULL, NULL, &r, &err);
    if (!CHECK(m != NULL, "no measurement: %s %s", err.name, err.reason))
        return;
    printf("mirror surface: %zu of %zu rays lost, albedo %.9f, %.2f %% multiple\n", r.lost, r.rays,
           r.albedo.g, 100 * r.multiple.g);
    CHECK(r.rays == what.rays && r.lost <= r.rays / 100000, "%zu rays lost", r.lost);
    CHECK(fabs(r.albedo.r - 1) < 1e-9 && fabs(r.albedo.b - 1) < 1e-9, "albedo %.12g", r.albedo.r);
    CHECK(r.multiple.g > 0.01 && r.multiple.g < 0.1 && r.bounces > 1, "multiple %g", r.multiple.g);
    for (int i = 0; i < 3; ++i) {
        double theta = (double[]){ 0.15, 0.6, 1.0 }[i], power = 0;
        asp_vec3 wi = direction_of(theta, 0);
        enum { Z = 400, PHI = 400 };
        for (int a = 0; a < Z; ++a)
            for (int b = 0; b < PHI; ++b) {
                double s2 = (a + 0.5) / Z, phi = (b + 0.5) * 2 * ASPI_PI / PHI;
                asp_vec3 wo = { sqrt(s2) * cos(phi), sqrt(s2) * sin(phi), sqrt(1 - s2) };
                power += asp_measured_eval(m, wi, wo).g * ASPI_PI / (Z * PHI);
            }
        printf("albedo of the table at %.2f rad: %.4f\n", theta, power);
        CHECK(fabs(power - 1) < 0.02, "directional albedo %g at %g rad", power, theta);
    }
    asp_measured_free(m);
}

/* The density of slopes that this very surface has over the recipe's, between ring centres. */
static double own_density(const asp_slope_statistics *s, double alpha, double theta)
{
    double at = fmax(0, theta * 180 / ASPI_PI - 0.5), ratio[2];
    for (int i = 0; i < 2; ++i) {
        double a = tan(((int)at + i) * ASPI_PI / 180), b = tan(((int)at + i + 1) * ASPI_PI / 180);
        ratio[i] = s->P22[(int)at + i] * ASPI_PI * (b * b - a * a)
                 / (exp(-a * a / (alpha * alpha)) - exp(-b * b / (alpha * alpha)));
    }
    return ratio[0] + (at - (int)at) * (ratio[1] - ratio[0]);
}

/* On a gently rough Gaussian surface light rarely meets a second facet, so the single-scattering
 * microfacet model must hold. D of a surface of finite size differs from the recipe's by a percent
 * or two: its own density of slopes is taken. */
static void test_microfacets(void)
{
    asp_fabrication what = asp_fabrication_default();
    asp_fabrication_report r;
    asp_error err;
    asp_ndf ndf;
    what.surface.alpha = 0.1;
    what.surface.gamma = INFINITY;
    what.rays = 3000000;
    asp_measured *m = asp_fabricate(&what, NULL, NULL, &r, &err);
    if (!CHECK(m && asp_ndf_parse(NULL, "beckmann:alpha=0.1", &ndf, &err) == ASP_OK, "%s %s",
               err.name, err.reason))
        return;
    asp_material gold = asp_conductor(&ndf, what.metal->eta, what.metal->k, ASP_MASK_CORRELATED);
    double sum[3] = { 0, 0, 0 }, square = 0, worst = 0;
    int n = 0;
    while (n < 20000) {
        /* centres of the table's cells: between them it is linear in f and reads high by a percent */
        double root = ((int)(32 * random_number()) + 0.5) / 90;
        double half_pi = 0.5 * ASPI_PI, turn = (int)(180 * random_number()) + 0.5;
        aspi_half centre = { half_pi * root * root, 0,
                             ((int)(60 * random_number()) + 0.5) * ASPI_PI / 180,
                             turn * ASPI_PI / 180 };
        asp_vec3 wi, wo;
        aspi_half_to(centre, &wi, &wo);
        if (wi.z < 0.5 || wo.z < 0.5)
            continue;
        double own = log(own_density(&r.slopes, what.surface.alpha, centre.theta_h));
        asp_rgb a = asp_measured_eval(m, wi, wo), b = asp_eval(&gold, wi, wo);
        double off = log(a.g / b.g) - own;
        sum[0] += log(a.r / b.r) - own;
        sum[1] += off;
        sum[2] += log(a.b / b.b) - own;
        square += off * off;
        worst = fmax(worst, fabs(off));
        ++n;
    }
    double rms = sqrt(square / n);
    printf("gaussian 0.1 in gold against beckmann: mean of log %.4f %.4f %.4f, rms %.4f, worst "
           "%.3f; noise %.4f, multiple %.2g\n", sum[0] / n, sum[1] / n, sum[2] / n, rms, worst,
           r.noise, r.multiple.g);
    for (int c = 0; c < 3; ++c)
        CHECK(fabs(sum[c] / n) < 0.01, "channel %d off by %g on average", c, sum[c] / n);
    CHECK(rms < 1.5 * r.noise, "rms %g for a noise of %g", rms, r.noise);
    asp_measured_free(m);
}

static void test_threads(void)
{
    asp_surface_recipe recipe = asp_surface_recipe_default();
    recipe.size = 256;
    asp_height_field field;
    asp_error err;
    CHECK(asp_height_field_make(&recipe, &field, &err) == ASP_OK, "no surface");
    aspi_tracer *tracer = trace_field(&field), *again = trace_field(&field);
    aspi_counts *a = malloc(sizeof *a), *b = malloc(sizeof *b);
    if (!a || !b)
        exit(1);
    const asp_metal *gold = asp_find_metal("Au");
    aspi_gonio_count(tracer, gold, 5, 100000, 1, NULL, NULL, a, &err);
    aspi_gonio_count(again, gold, 5, 100000, 3, NULL, NULL, b, &err);
    CHECK(a->rays == 100000 && !memcmp(a, b, sizeof *a), "three threads count otherwise than one");
    aspi_gonio_count(tracer, gold, 6, 100000, 2, NULL, NULL, b, &err);
    CHECK(memcmp(a, b, sizeof *a) != 0, "another seed counts the same");
    free(a);
    free(b);
    aspi_tracer_free(tracer);
    aspi_tracer_free(again);
    asp_height_field_free(&field);
}

typedef struct watch { double last; int calls, falls, stop_after; } watch;

static int watching(void *context, double done)
{
    watch *w = context;
    w->falls += done < w->last || done > 1;
    w->last = done;
    return ++w->calls == w->stop_after;
}

static void test_progress(void)
{
    asp_fabrication what = asp_fabrication_default();
    asp_error err;
    what.rays = 200000;
    what.surface.size = 256;
    watch all = { 0, 0, 0, 0 }, first = { 0, 0, 0, 1 }, third = { 0, 0, 0, 3 };
    asp_measured *m = asp_fabricate(&what, watching, &all, NULL, &err);
    CHECK(m && all.calls > 3 && !all.falls && all.last <= 1, "%d calls, %d backwards, last %g",
          all.calls, all.falls, all.last);
    asp_measured_free(m);
    memset(&err, 0, sizeof err);
    CHECK(!asp_fabricate(&what, watching, &first, NULL, &err) && err.status == ASP_ECANCELLED,
          "not cancelled at once");
    memset(&err, 0, sizeof err);
    CHECK(!asp_fabricate(&what, watching, &third, NULL, &err) && err.status == ASP_ECANCELLED
              && third.calls == 3, "not cancelled under way");
    CHECK(!asp_fabricate(&what, watching, &(watch){ 0, 0, 0, 1 }, NULL, NULL), "err NULL");

    what.rays = 10;
    CHECK(!asp_fabricate(&what, NULL, NULL, NULL, &err) && !strcmp(err.name, "rays"), "10 rays");
    what.rays = 20000;
    what.threads = 0;
    CHECK(!asp_fabricate(&what, NULL, NULL, NULL, &err) && !strcmp(err.name, "threads"), "0 threads");
    what.threads = 1;
    what.surface.alpha = -1;
    CHECK(!asp_fabricate(&what, NULL, NULL, NULL, &err) && !strcmp(err.name, "alpha"), "alpha -1");
}

static void test_description(void)
{
    asp_fabrication what = asp_fabrication_default();
    asp_error err;
    what.rays = 20000;
    what.surface.size = 128;
    what.surface.patch = 3;
    asp_measured *m = asp_fabricate(&what, NULL, NULL, NULL, &err);
    if (!CHECK(m != NULL, "no measurement"))
        return;
    asp_measured_info info = asp_measured_get_info(m);
    printf("%s\n", info.description);
    CHECK(strstr(info.description, "Fabricated") && strstr(info.description, "20000 rays")
              && strstr(info.description, "gamma 3") && strstr(info.description, "Au"),
          "the description hides what was done");
    asp_measured_free(m);
}

int main(void)
{
    test_flat();
    test_grooves();
    test_no_edge();
    test_refused_fields();
    test_table_of_diffuser();
    test_energy();
    test_microfacets();
    test_threads();
    test_progress();
    test_description();
    return finish();
}
