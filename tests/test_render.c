/* test_render.c - the lit sphere against irradiance formulas, quadrature and itself */
#define _XOPEN_SOURCE 700
#include <pthread.h>

#include "draw_test.h"

#include "render/environment.h"
#include "render/sobol.h"

static asp_rgb white(const void *context, asp_vec3 wi, asp_vec3 wo)
{
    (void)context;
    (void)wi;
    (void)wo;
    return (asp_rgb){ 1 / PI, 1 / PI, 1 / PI };
}

static asp_image render(const asp_preview *preview)
{
    asp_image image = { 0, 0, NULL };
    asp_error err = { 0 };
    if (!CHECK(asp_preview_render(preview, &image, &err) == ASP_OK, "render: %s: %s", err.name, err.reason))
        exit(finish_());
    return image;
}

static const float *pixel(const asp_image *image, int x, int y)
{
    return image->rgb + 3 * ((size_t)y * (size_t)image->width + (size_t)x);
}

/* Normal in the middle of a pixel (orthographic); 0 when within 1.5 px of the outline or outside. */
static int normal_at(const asp_image *image, double zoom, int x, int y, asp_vec3 *n)
{
    double r = 0.5 * zoom * (image->width < image->height ? image->width : image->height);
    double px = (x + 0.5 - 0.5 * image->width) / r, py = (0.5 * image->height - y - 0.5) / r;
    double r2 = px * px + py * py;
    *n = (asp_vec3){ px, py, sqrt(fmax(0, 1 - r2)) };
    return sqrt(r2) < 1 - 1.5 / r;
}

static int same(const asp_image *a, const asp_image *b)
{
    return a->width == b->width && a->height == b->height
           && memcmp(a->rgb, b->rgb, sizeof(float) * 3 * (size_t)a->width * (size_t)a->height) == 0;
}

/* ------------------------------------------------------------------ sequence and lights */

/* 2^k points of a (0, 2)-sequence: one in every elementary interval of area 2^-k. */
static void test_sobol(void)
{
    int sets = 0;
    for (uint32_t seed = 0; seed < 40; seed++)
        for (int k = 0; k <= 8; k++) {
            int n = 1 << k, good = 1;
            for (int a = 0; a <= k; a++) {
                char taken[256] = { 0 };
                for (int i = 0; i < n; i++) {
                    double u, v;
                    aspi_sobol((uint32_t)i, aspi_mix(seed, 77), &u, &v);
                    good &= u >= 0 && u < 1 && v >= 0 && v < 1;
                    int cell = (int)(u * (1 << a)) << (k - a) | (int)(v * (1 << (k - a)));
                    good &= !taken[cell & 255];
                    taken[cell & 255] = 1;
                }
            }
            sets += CHECK(good, "seed %u: 2^%d points are not stratified", seed, k);
        }
    double sum = 0;
    for (uint32_t seed = 0; seed < 4096; seed++) {
        double u, v;
        aspi_sobol(5, aspi_mix(seed, 3), &u, &v);
        sum += u - v * v;
    }
    CHECK(fabs(sum / 4096 - (0.5 - 1.0 / 3)) < 4 * sqrt((1.0 / 12 + 4.0 / 45) / 4096), "scramble is biased");
    printf("sobol: %d scrambled sets, one point in every elementary interval\n", sets);
}

static double luminance(asp_rgb c)
{
    return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
}

/* Integral over all directions by the midpoint rule in height and azimuth; g may look at n. */
static double over_sphere(double (*g)(asp_vec3 w, const void *context), const void *context, int rows)
{
    double sum = 0;
    for (int i = 0; i < rows; i++)
        for (int k = 0; k < 2 * rows; k++) {
            double y = 2 * (i + 0.5) / rows - 1, phi = PI * (k + 0.5) / rows, s = sqrt(1 - y * y);
            sum += g((asp_vec3){ s * cos(phi), y, s * sin(phi) }, context);
        }
    return sum * 4 * PI / (2.0 * rows * rows);
}

typedef struct light_view { aspi_lights lights; double chance[ASP_LIGHTS]; asp_vec3 n; } light_view;

static double pdf_at(asp_vec3 w, const void *context)
{
    const light_view *v = context;
    return aspi_light_pdf(&v->lights, v->chance, w);
}

/* Irradiance of a plane with normal n, over pi: what a white Lambertian surface shows. */
static double irradiance_at(asp_vec3 w, const void *context)
{
    const light_view *v = context;
    double c = aspi_dot(w, v->n);
    return c > 0 ? c * luminance(aspi_radiance(&v->lights, w)) / PI : 0;
}

static void test_lights(void)
{
    asp_environment studio = asp_environment_studio();
    light_view view;
    CHECK(aspi_lights_prepare(&studio, &view.lights, NULL) == ASP_OK, "studio");
    static const asp_vec3 normals[] = { { 0, 0, 1 }, { -0.6, 0.64, 0.48 }, { 0.8, -0.6, 0 }, { 0, -1, 0 },
                                        { 0.36, 0.48, -0.8 } };
    for (int k = 0; k < 5; k++) {
        double any = aspi_light_chances(&view.lights, normals[k], view.chance), sum = 0;
        for (int i = 0; i < view.lights.count; i++)
            sum += view.chance[i];
        CHECK(any == 0 || fabs(sum - 1) < 1e-12, "chances sum to %g", sum);
        double whole = over_sphere(pdf_at, &view, 1200);
        CHECK(fabs(whole - any) < 4e-3, "density of light directions integrates to %g", whole);
        /* no direction that shines on the surface may have density 0 */
        int forgotten = 0;
        for (int i = 0; i < view.lights.count; i++)
            for (int s = 0; s < 2000; s++) {
                asp_vec3 w = aspi_light_sample(&view.lights.light[i], uniform(), uniform());
                double length = sqrt(aspi_dot(w, w));
                forgotten += fabs(length - 1) > 1e-12;
                forgotten += aspi_dot(w, normals[k]) > 1e-9 && !(pdf_at(w, &view) > 0);
            }
        CHECK(!forgotten, "%d light samples off", forgotten);
    }
    for (int i = 0; i < view.lights.count; i++) {
        /* a light's own samples: mean of 1/pdf is its solid angle */
        double chance[ASP_LIGHTS] = { 0 }, sum = 0;
        chance[i] = 1;
        for (int s = 0; s < 100000; s++)
            sum += 1 / aspi_light_pdf(&view.lights, chance, aspi_light_sample(&view.lights.light[i], uniform(),
                                                                             uniform()));
        CHECK(fabs(sum / 1e5 / view.lights.light[i].solid_angle - 1) < 0.01, "solid angle of light %d: %g, %g",
              i, sum / 1e5, view.lights.light[i].solid_angle);
    }
    /* upright, width level, roll counter-clockwise seen from the origin */
    asp_environment one = { .light_count = 1, .lights = { { .shape = ASP_LIGHT_RECTANGLE,
        .direction = { 0, 0, -2 }, .half_width = 0.5, .half_height = 0.1, .radiance = { 1, 1, 1 } } } };
    CHECK(asp_environment_radiance(&one, (asp_vec3){ 0.4 / 1.077, 0, -1 / 1.077 }).r == 1
          && asp_environment_radiance(&one, (asp_vec3){ 0, 0.4 / 1.077, -1 / 1.077 }).r == 0
          && asp_environment_radiance(&one, (asp_vec3){ 0, 0, 1 }).r == 0, "rectangle lies level");
    one.lights[0].roll = PI / 4;
    CHECK(asp_environment_radiance(&one, (asp_vec3){ 0.3 / 1.0863, 0.3 / 1.0863, -1 / 1.0863 }).r == 1
          && asp_environment_radiance(&one, (asp_vec3){ 0.3 / 1.0863, -0.3 / 1.0863, -1 / 1.0863 }).r == 0,
          "roll");
    CHECK(asp_environment_radiance(&studio, (asp_vec3){ 0, -1, 0 }).r == studio.nadir.r, "nadir");
    printf("lights: densities integrate to 1, samples agree, orientation\n");
}

/* ------------------------------------------------------------------ known answers */

static void test_furnace(void)
{
    asp_environment furnace = asp_environment_furnace(1);
    for (int perspective = 0; perspective < 2; perspective++) {
        asp_preview preview = { .function = white, .environment = &furnace, .width = 48, .height = 40,
                                .samples = 256, .field_of_view = perspective ? 0.7 : 0 };
        asp_image image = render(&preview);
        /* the picture's own scatter says what noise is: 5 standard errors for the mean of the middle
         * and of the rim (where half the lobes' directions are lost and noise is higher), 6 deviations
         * for a pixel of the middle */
        double sum[2] = { 0 }, squares[2] = { 0 }, worst = 0, count[2] = { 0 };
        for (int i = 0; i < 48 * 40; i++) {
            double r = hypot(i % 48 + 0.5 - 24, i / 48 + 0.5 - 20) / 18, off = image.rgb[3 * i] - 1;
            int rim = r > 0.85;
            if (r > 1.1)
                CHECK(fabs(off) < 1e-6, "the furnace behind the sphere");
            else {
                sum[rim] += off;
                squares[rim] += off * off;
                count[rim]++;
                worst = rim ? worst : fmax(worst, fabs(off));
            }
        }
        for (int rim = 0; rim < 2; rim++) {
            double deviation = sqrt(squares[rim] / count[rim]), off = sum[rim] / count[rim];
            CHECK(fabs(off) < 5 * deviation / sqrt(count[rim]) && deviation < 0.03
                  && (rim || worst < 6 * deviation), "white furnace%s: mean %g, deviation %g, worst %g",
                  rim ? " at the rim" : "", 1 + off, deviation, worst);
            printf("furnace%s: %g pixels, mean %.5f, deviation of a pixel %.4f\n", rim ? " at the rim" : "",
                   count[rim], 1 + off, deviation);
        }
        asp_image_free(&image);
    }
    /* a Lambertian material samples itself: cosine against cosine leaves no noise at all */
    asp_material material;
    CHECK(asp_material_parse(NULL, "lambert_specular:diffuse=0.5,specular=0,eta=1.5,ndf=(ggx:alpha=0.5)",
                             &material, NULL) == ASP_OK, "material");
    asp_preview preview = { .material = &material, .environment = &furnace, .width = 32, .height = 32,
                            .plain = 1, .samples = 256 };
    asp_image image = render(&preview);
    double sum = 0;
    int count = 0;
    asp_vec3 n;
    for (int y = 0; y < 32; y++)
        for (int x = 0; x < 32; x++)
            if (normal_at(&image, 0.9, x, y, &n)) {
                sum += pixel(&image, x, y)[1];
                count++;
            }
    CHECK(fabs(sum / count - 0.5) < 2e-3, "grey furnace: %g", sum / count);
    CHECK(pixel(&image, 0, 0)[0] == 0 && pixel(&image, 31, 31)[2] == 0, "plain black behind");
    asp_image_free(&image);
}

/* A disc light wholly above a surface at cosine c gives E = pi L sin^2(radius) c. */
static void test_direction(void)
{
    double d[3] = { 0.48, 0.6, 0.64 }, radius = 0.2;
    asp_environment one = { .light_count = 1, .lights = { { .direction = { d[0], d[1], d[2] },
        .radius = radius, .radiance = { 3, 2, 1 } } } };
    asp_preview preview = { .function = white, .environment = &one, .width = 96, .height = 96, .samples = 256,
                            .zoom = 1 };
    asp_image image = render(&preview);
    double squares = 0, sum = 0, expected_sum = 0, dark = 0, top = 3 * sin(radius) * sin(radius);
    int count = 0;
    for (int y = 0; y < 96; y++)
        for (int x = 0; x < 96; x++) {
            asp_vec3 n;
            if (!normal_at(&image, 1, x, y, &n))
                continue;
            double c = n.x * d[0] + n.y * d[1] + n.z * d[2], e = top * c;
            if (c < -sin(radius) - 0.05)
                dark = fmax(dark, pixel(&image, x, y)[0]);
            if (c < sin(radius) + 0.05)
                continue;
            squares += pow((pixel(&image, x, y)[0] - e) / top, 2);
            sum += pixel(&image, x, y)[0];
            expected_sum += e;
            count++;
            CHECK(fabs(pixel(&image, x, y)[2] * 3 - pixel(&image, x, y)[0]) < 1e-5, "colour of the light");
        }
    double rms = sqrt(squares / count);
    CHECK(count > 2000 && rms < 0.01 && fabs(sum / expected_sum - 1) < 1e-3 && dark == 0,
          "disc light: %d pixels, rms %g, sum %g, dark side %g", count, rms, sum / expected_sum, dark);
    printf("disc light: %d pixels, rms %.4f from the formula, all together %.5f\n", count, rms,
           sum / expected_sum);
    asp_image_free(&image);
}

/* Lambertian sphere in the studio against midpoint quadrature of the whole environment. */
static void test_studio(void)
{
    asp_environment studio = asp_environment_studio();
    light_view view;
    aspi_lights_prepare(&studio, &view.lights, NULL);
    asp_preview preview = { .function = white, .width = 33, .height = 33, .samples = 4096, .zoom = 1 };
    static const int at[][2] = { { 16, 16 }, { 7, 8 }, { 27, 15 }, { 16, 29 }, { 10, 5 }, { 22, 10 } };
    asp_image image = render(&preview);
    double worst = 0, brightest = 0;
    for (int k = 0; k < 6; k++) {
        CHECK(normal_at(&image, 1, at[k][0], at[k][1], &view.n), "pixel on the sphere");
        const float *p = pixel(&image, at[k][0], at[k][1]);
        double shown = luminance((asp_rgb){ p[0], p[1], p[2] });
        double expected = over_sphere(irradiance_at, &view, 700);
        worst = fmax(worst, fabs(shown / expected - 1));
        CHECK(fabs(shown / expected - 1) < 0.015, "studio at %d, %d: %g, quadrature %g", at[k][0], at[k][1],
              shown, expected);
    }
    for (int i = 0; i < 33 * 33; i++) {
        asp_vec3 n;
        if (normal_at(&image, 1, i % 33, i / 33, &n))
            brightest = fmax(brightest, luminance((asp_rgb){ image.rgb[3 * i], image.rgb[3 * i + 1],
                                                             image.rgb[3 * i + 2] }));
    }
    CHECK(brightest > 0.85 && brightest < 1.2, "brightest side of a white sphere: %g", brightest);
    printf("studio: six points within %.4f of quadrature; brightest %.3f\n", worst, brightest);
    asp_image_free(&image);
}

/* ------------------------------------------------------------------ frames */

static asp_rgb shows_wi(const void *context, asp_vec3 wi, asp_vec3 wo)
{
    (void)context;
    (void)wo;
    return (asp_rgb){ (2 + wi.x) / PI, (2 + wi.y) / PI, (2 + wi.z) / PI };
}

static void test_frames(void)
{
    asp_environment furnace = asp_environment_furnace(1);
    asp_preview preview = { .function = shows_wi, .environment = &furnace, .width = 64, .height = 64,
                            .samples = 256, .zoom = 1 };
    asp_image image = render(&preview);
    double worst = 0;
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 64; x++) {
            asp_vec3 n;
            if (!normal_at(&image, 1, x, y, &n) || hypot(n.x, n.z) < 0.15)
                continue;
            /* view = z; x axis = d/dphi = (n.z, 0, -n.x)/s; y axis = n cross x, its z = -n.y n.z / s */
            double s = hypot(n.x, n.z), expected[3] = { 2 - n.x / s, 2 - n.y * n.z / s, 2 + n.z };
            for (int c = 0; c < 3; c++)
                worst = fmax(worst, fabs(pixel(&image, x, y)[c] / expected[c] - 1));
        }
    CHECK(worst < 0.08, "local frames: worst %g", worst);
    printf("frames: local direction to the viewer within %.3f\n", worst);
    asp_image_free(&image);
    /* in perspective the outline is still a circle of the asked size, and what is behind is seen */
    preview.field_of_view = 1.2;
    preview.zoom = 0.5;
    preview.plain = 1;
    preview.background = (asp_rgb){ 7, 8, 9 };
    image = render(&preview);
    int wrong = 0;
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 64; x++) {
            double r = hypot(x + 0.5 - 32, y + 0.5 - 32) / 16;
            int behind = pixel(&image, x, y)[0] == 7 && pixel(&image, x, y)[2] == 9;
            wrong += r > 1.06 ? !behind : r < 0.94 ? behind : 0;
        }
    CHECK(wrong == 0, "%d pixels on the wrong side of the outline", wrong);
    asp_image_free(&image);
}

/* ------------------------------------------------------------------ materials and proposals */

static asp_rgb eval_material(const void *context, asp_vec3 wi, asp_vec3 wo)
{
    return asp_eval(context, wi, wo);
}

static void means(const asp_image *image, double out[3])
{
    out[0] = out[1] = out[2] = 0;
    for (int i = 0; i < image->width * image->height; i++)
        for (int c = 0; c < 3; c++)
            out[c] += image->rgb[3 * i + c] / image->width / image->height;
}

#define SEEDS 8

/* Four ways to sample the same surface have the same mean: nothing is biased. */
static void test_proposals(void)
{
    static const char *const specs[] = { "conductor:metal=Au,ndf=(ggx:alpha=0.3)",
        "conductor:metal=Cu,ndf=(ggx:alpha_x=0.4,alpha_y=0.08,rotation=0.4)",
        "lambert_specular:diffuse=0.3/0.1/0.05,specular=1,eta=1.5,ndf=(ggx:alpha=0.12)" };
    for (int k = 0; k < 3; k++) {
        asp_material material, other;
        asp_error err = { 0 };
        if (!CHECK(asp_material_parse(NULL, specs[k], &material, &err) == ASP_OK
                   && asp_material_parse(NULL, "lambert_specular:diffuse=0.5,specular=1,eta=1.5,"
                                         "ndf=(ggx:alpha=0.25)", &other, &err) == ASP_OK, "%s", err.reason))
            continue;
        const asp_preview ways[4] = { { .material = &material },
            { .function = eval_material, .context = &material },
            { .function = eval_material, .context = &material, .proposal = &other },
            { .material = &material, .proposal = &other } };
        double mean[4][3] = { { 0 } }, variance[4][3] = { { 0 } };     /* of the mean */
        for (int way = 0; way < 4; way++) {
            double seen[SEEDS][3];
            for (int seed = 0; seed < SEEDS; seed++) {
                asp_preview preview = ways[way];
                preview.width = preview.height = 32;
                preview.samples = 128;
                preview.plain = 1;
                preview.seed = (uint32_t)(100 * way + seed);
                asp_image image = render(&preview);
                means(&image, seen[seed]);
                asp_image_free(&image);
            }
            for (int c = 0; c < 3; c++) {
                for (int seed = 0; seed < SEEDS; seed++)
                    mean[way][c] += seen[seed][c] / SEEDS;
                for (int seed = 0; seed < SEEDS; seed++)
                    variance[way][c] += pow(seen[seed][c] - mean[way][c], 2) / (SEEDS - 1) / SEEDS;
                double off = mean[way][c] - mean[0][c], error = sqrt(variance[way][c] + variance[0][c]);
                CHECK(way == 0 || (fabs(off) < 5 * error && fabs(off) < 0.01 * mean[0][c]),
                      "%s, way %d, channel %d: %g, first way %g, error %g", specs[k], way, c, mean[way][c],
                      mean[0][c], error);
            }
        }
        printf("means %.4f %.4f %.4f %.4f of %s\n", mean[0][1], mean[1][1], mean[2][1], mean[3][1], specs[k]);
    }
}

/* A nearly mirroring sphere shows the light where the mirror direction meets it. */
static void test_mirror(void)
{
    asp_material material;
    CHECK(asp_material_parse(NULL, "conductor:metal=Ag,ndf=(ggx:alpha=0.01)", &material, NULL) == ASP_OK, "Ag");
    asp_environment one = { .light_count = 1, .lights = { { .direction = { 0.6, 0.48, 0.64 }, .radius = 0.1,
        .radiance = { 5, 5, 5 } } } };
    asp_preview preview = { .material = &material, .environment = &one, .width = 128, .height = 128,
                            .samples = 64, .zoom = 1 };
    asp_image image = render(&preview);
    double x = 0, y = 0, sum = 0;
    for (int i = 0; i < 128 * 128; i++) {
        sum += image.rgb[3 * i];
        x += image.rgb[3 * i] * (i % 128 + 0.5);
        y += image.rgb[3 * i] * (i / 128 + 0.5);
    }
    /* half way between the light and the viewer: n = (d + z)/|d + z| */
    double length = sqrt(0.6 * 0.6 + 0.48 * 0.48 + 1.64 * 1.64);
    double ex = 64 + 64 * 0.6 / length, ey = 64 - 64 * 0.48 / length;
    CHECK(sum > 0 && fabs(x / sum - ex) < 1 && fabs(y / sum - ey) < 1, "highlight at %g, %g, belongs at %g, %g",
          x / sum, y / sum, ex, ey);
    asp_image_free(&image);
}

/* ------------------------------------------------------------------ determinism, noise, refusals */

static void test_determinism(void)
{
    asp_material material;
    asp_material_parse(NULL, "conductor:metal=Au,ndf=(ggx:alpha=0.2)", &material, NULL);
    asp_preview preview = { .material = &material, .width = 37, .height = 29, .samples = 24, .threads = 1 };
    asp_image first = render(&preview);
    static const int threads[] = { 2, 3, 7, 64, 0 };
    for (int i = 0; i < 5; i++) {
        preview.threads = threads[i];
        asp_image image = render(&preview);
        CHECK(same(&first, &image), "%d threads give another picture", threads[i]);
        asp_image_free(&image);
    }
    preview.seed = 1;
    asp_image other = render(&preview);
    CHECK(!same(&first, &other), "the seed changes nothing");
    asp_image_free(&other);
    asp_image_free(&first);
    printf("determinism: 1, 2, 3, 7, 64 and all threads give the same bits\n");
}

/* Stratified samples: four times as many must more than halve the error. */
static void test_noise(void)
{
    double error[3] = { 0 };
    asp_preview preview = { .function = white, .width = 24, .height = 24, .zoom = 3, .samples = 4096 };
    asp_image exact = render(&preview);
    for (int k = 0; k < 3; k++) {
        preview.samples = 16 << 2 * k;
        preview.seed = 5 + (uint32_t)k;
        asp_image image = render(&preview);
        for (int i = 0; i < 24 * 24 * 3; i++)
            error[k] += pow(image.rgb[i] - exact.rgb[i], 2);
        error[k] = sqrt(error[k] / (24 * 24 * 3));
        asp_image_free(&image);
    }
    asp_image_free(&exact);
    CHECK(error[1] < 0.5 * error[0] && error[2] < 0.5 * error[1] && error[2] < 0.01, "errors %g %g %g", error[0],
          error[1], error[2]);
    printf("noise: rms %.4f, %.4f, %.4f at 16, 64, 256 samples\n", error[0], error[1], error[2]);
}

typedef struct watcher { pthread_t thread; double last; int calls, wrong; double stop_at; } watcher;

static int watch(void *context, double fraction)
{
    watcher *w = context;
    w->calls++;
    w->wrong += !pthread_equal(w->thread, pthread_self()) || fraction < w->last || fraction > 1;
    w->last = fraction;
    return fraction >= w->stop_at;
}

static asp_rgb not_a_number(const void *context, asp_vec3 wi, asp_vec3 wo)
{
    (void)context;
    (void)wo;
    double v = wi.x > 0 ? NAN : 0.1;
    return (asp_rgb){ v, v, v };
}

static void test_progress_and_errors(void)
{
    watcher w = { .thread = pthread_self(), .stop_at = 2 };
    asp_preview preview = { .function = white, .width = 64, .height = 64, .samples = 16, .threads = 2,
                            .progress = watch, .progress_context = &w };
    asp_image image = render(&preview), untouched = { 3, 4, NULL };
    CHECK(w.calls > 3 && w.wrong == 0 && w.last == 1, "%d calls, %d wrong, last %g", w.calls, w.wrong, w.last);
    asp_image_free(&image);
    asp_error err = { 0 };
    w = (watcher){ .thread = pthread_self(), .stop_at = 0.3 };
    CHECK(asp_preview_render(&preview, &untouched, &err) == ASP_ECANCELLED && err.status == ASP_ECANCELLED
          && untouched.width == 3 && !untouched.rgb && w.last < 0.6, "cancelled at %g", w.last);
    preview.progress = NULL;
    asp_environment wrong_light = { .light_count = 1, .lights = { { .direction = { 0, 1, 0 } } } };
    asp_environment many = { .light_count = 9 }, dark = { .zenith = { -1, 0, 0 } };
    const struct { asp_preview preview; const char *name; } rows[] = {
        { { .width = 5 }, "material" },
        { { .function = white, .width = -1 }, "width" },
        { { .function = white, .height = 20000 }, "height" },
        { { .function = white, .samples = 70000 }, "samples" },
        { { .function = white, .field_of_view = 2.5 }, "field_of_view" },
        { { .function = white, .zoom = NAN }, "zoom" },
        { { .function = white, .threads = 300 }, "threads" },
        { { .function = white, .environment = &wrong_light }, "environment.lights[0].radius" },
        { { .function = white, .environment = &many }, "environment.light_count" },
        { { .function = white, .environment = &dark }, "environment.zenith" },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        CHECK(asp_preview_render(&rows[i].preview, &untouched, &err) == ASP_EINVAL
              && strcmp(err.name, rows[i].name) == 0 && !untouched.rgb, "row %zu: %s", i, err.name);
    /* bad data is seen, not hidden */
    preview = (asp_preview){ .function = not_a_number, .width = 16, .height = 16, .samples = 4, .plain = 1 };
    image = render(&preview);
    CHECK(isnan(pixel(&image, 4, 8)[0]) && !isnan(pixel(&image, 12, 8)[0]), "NaN on the left half only");
    asp_image_free(&image);
    printf("progress, cancelling, refusals\n");
}

int main(void)
{
    test_sobol();
    test_lights();
    test_furnace();
    test_direction();
    test_studio();
    test_frames();
    test_proposals();
    test_mirror();
    test_determinism();
    test_noise();
    test_progress_and_errors();
    return finish_();
}
