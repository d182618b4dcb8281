/* test_draw_polar.c - lobes in the plane of incidence: where points lie, what is cut, what is refused */
#define _XOPEN_SOURCE 700
#include "svg_test.h"

static char *draw(const asp_polar *polar)
{
    asp_error err = { 0 };
    char *svg = asp_polar_svg(polar, &err);
    if (!CHECK(svg, "no plot: %s: %s", err.name, err.reason))
        exit(finish_());
    const char *fault = svg_fault(svg);
    CHECK(!fault && !strstr(svg, "nan") && !strstr(svg, " id="), "not well-formed: %s", fault);
    return svg;
}

typedef struct disc { double x, y, radius; } disc;

/* The frame is M left y A r r ... */
static disc frame_of(const char *svg)
{
    const char *p = strstr(strstr(svg, "stroke=\"#444444\""), " d=\"M");
    double left = atof(p + 5), y = atof(strchr(p + 5, ' ')), r = atof(strchr(p, 'A') + 1);
    return (disc){ left + r, y, r };
}

static void test_positions(void)
{
    enum { N = 37 };
    double angle[N], r[N], points[64][2];
    for (int i = 0; i < N; i++) {
        angle[i] = PI * (i / 36.0 - 0.5);
        r[i] = 0.05 + 0.9 * (i % 5) / 4.0;
    }
    asp_series series = { .label = "lobe", .x = angle, .y = r, .count = N };
    asp_polar polar = { .radius = { .low = 0, .high = 1 }, .series = &series, .series_count = 1 };
    for (int logarithmic = 0; logarithmic < 2; logarithmic++) {
        if (logarithmic)
            polar.radius = (asp_axis){ .low = 1e-2, .high = 1, .scale = ASP_SCALE_LOG };
        char *svg = draw(&polar);
        disc d = frame_of(svg);
        int moves, n = path_points(series_part(svg, "lobe"), points, 64, &moves);
        CHECK(n == N && moves == 1, "%d points in %d strokes", n, moves);
        for (int i = 0; i < n; i++) {
            double px = d.radius * (logarithmic ? 1 + log10(r[i]) / 2 : r[i]);
            CHECK(fabs(points[i][0] - d.x - px * sin(angle[i])) < 0.02
                  && fabs(points[i][1] - d.y + px * cos(angle[i])) < 0.02, "point %d of %s", i,
                  logarithmic ? "log" : "linear");
        }
        free(svg);
    }
    /* labels of the radius stand at their rings, on both sides */
    polar.radius = (asp_axis){ .low = 0, .high = 1 };
    char *svg = draw(&polar);
    disc d = frame_of(svg);
    label labels[100];
    int n = read_labels(svg, labels, 100), rings = 0, angles = 0;
    for (int i = 0; i < n; i++) {
        double v = label_value(labels[i].text);
        if (fabs(labels[i].y - d.y - 14) < 0.02) {
            rings++;
            CHECK(fabs(fabs(labels[i].x - d.x) - v * d.radius) < 0.02, "ring %g", v);
        }
        angles += strstr(labels[i].text, "\xc2\xb0") != NULL;
    }
    CHECK(rings >= 5 && angles == 7, "%d rings, %d angles", rings, angles);
    free(svg);
    printf("positions: linear and logarithmic radius, rings, angles\n");
}

static void test_cut_and_gaps(void)
{
    static double angle[721], r[721], points[3000][2];
    for (int i = 0; i < 721; i++) {
        angle[i] = PI * (i / 720.0 - 0.5);
        r[i] = 2 * pow(cos(angle[i] - 0.5), 40);
    }
    asp_series series = { .label = "lobe", .x = angle, .y = r, .count = 721 };
    asp_polar polar = { .radius = { .low = 0, .high = 1 }, .series = &series, .series_count = 1 };
    char *svg = draw(&polar);
    disc d = frame_of(svg);
    int moves, n = path_points(series_part(svg, "lobe"), points, 3000, &moves);
    double farthest = 0;
    for (int i = 0; i < n; i++)
        farthest = fmax(farthest, hypot(points[i][0] - d.x, points[i][1] - d.y));
    CHECK(moves == 2 && fabs(farthest - d.radius) < 0.05, "cut: %d strokes, reaches %g of %g", moves, farthest,
          d.radius);
    free(svg);
    angle[440] = 1.7;           /* below the horizon */
    r[400] = NAN;
    r[500] = -1;
    polar.radius = (asp_axis){ .low = 0, .high = 3 };
    svg = draw(&polar);
    path_points(series_part(svg, "lobe"), points, 3000, &moves);
    CHECK(moves == 4, "three gaps: %d strokes", moves);
    free(svg);
    polar.radius = (asp_axis){ .scale = ASP_SCALE_LOG };
    svg = draw(&polar);
    d = frame_of(svg);
    n = path_points(series_part(svg, "lobe"), points, 3000, &moves);
    double nearest = 1e9;
    for (int i = 0; i < n; i++)
        nearest = fmin(nearest, hypot(points[i][0] - d.x, points[i][1] - d.y));
    CHECK(nearest < 0.02, "what is below the least decade lies in the centre, not beyond: %g", nearest);
    free(svg);
    for (int i = 0; i < 721; i++)
        r[i] = 0;
    polar.radius = (asp_axis){ .low = 0 };
    free(draw(&polar));
    polar.series_count = 0;
    free(draw(&polar));
    printf("cut at the edge, gaps, zeros, no series\n");
}

static void test_incidence_and_errors(void)
{
    static const double incidence[] = { 0, 0.9, PI / 2, -1, 3, NAN };
    asp_polar polar = { .title = "arrows", .incidence = incidence, .incidence_count = 6 };
    char *svg = draw(&polar);
    int heads = 0;
    for (const char *p = svg; (p = strstr(p, "<path fill=\"#777777\"")); p++)
        heads++;
    CHECK(heads == 3, "%d arrows of 3 possible", heads);
    free(svg);
    asp_error err = { 0 };
    polar.radius = (asp_axis){ .low = 0.5, .high = 1 };
    CHECK(!asp_polar_svg(&polar, &err) && strcmp(err.name, "radius.low") == 0, "linear from the middle");
    polar.radius = (asp_axis){ .low = 0, .high = 1, .scale = ASP_SCALE_LOG };
    CHECK(!asp_polar_svg(&polar, &err) && strcmp(err.name, "radius.low") == 0, "log from 0");
    polar.radius = (asp_axis){ .low = 0 };
    polar.width = 20;
    CHECK(!asp_polar_svg(&polar, &err) && strcmp(err.name, "width") == 0, "too narrow");
    CHECK(asp_polar_write(&polar, in_folder("x.svg"), &err) == ASP_EINVAL && count_files(0) == 0, "no file");
    polar.width = 0;
    CHECK(asp_polar_write(&polar, in_folder("x.svg"), &err) == ASP_OK && count_files(1) == 1, "a file");
}

static asp_rgb probe(const void *context, asp_vec3 wi, asp_vec3 wo)
{
    (void)context;
    return (asp_rgb){ wi.x, wo.y, wi.z * wo.z };
}

static void test_lobe(void)
{
    double angle[5], value[5];
    asp_lobe(probe, NULL, 0.6, 0, 0, 5, angle, value);
    for (int i = 0; i < 5; i++) {
        double a = PI * (i - 2) / 4;
        double expected = 0.2126 * -sin(0.6) + 0.0722 * cos(0.6) * cos(a);
        CHECK(fabs(angle[i] - a) < 1e-12 && fabs(value[i] - expected) < 1e-12, "lobe %d: %g", i, value[i]);
    }
    asp_lobe(probe, NULL, 0.6, PI / 2, 1, 5, angle, value);
    for (int i = 0; i < 5; i++) {
        double a = PI * (i - 2) / 4, c = i == 0 || i == 4 ? 0 : cos(a);
        double expected = c * (0.7152 * sin(a) + 0.0722 * cos(0.6) * c);
        CHECK(fabs(value[i] - expected) < 1e-12, "lobe %d turned, with cosine: %g", i, value[i]);
    }
    asp_material material;
    CHECK(asp_material_parse(NULL, "lambert_specular:diffuse=0.5,specular=0,eta=1.5,ndf=(ggx:alpha=0.3)",
                             &material, NULL) == ASP_OK, "material");
    asp_lobe(NULL, &material, 0.3, 0, 1, 5, angle, value);
    for (int i = 0; i < 5; i++) {
        double expected = 0.5 / PI * (i == 0 || i == 4 ? 0 : cos(PI * (i - 2) / 4));
        CHECK(fabs(value[i] - expected) < 1e-12, "material's lobe %d: %g", i, value[i]);
    }
    printf("lobes: of a function, turned, of a material\n");
}

int main(void)
{
    test_positions();
    test_cut_and_gaps();
    test_incidence_and_errors();
    test_lobe();
    return finish_();
}
