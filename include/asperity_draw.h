/* asperity_draw.h - images, charts and the lit sphere
 *
 *   1  Images      float RGB buffers; .png, .exr, .pfm; base64
 *   2  Colours     one colour per distribution, the same in every picture
 *   3  Charts      curves over linear or logarithmic axes, as SVG
 *   4  Polar plots lobes in the plane of incidence, as SVG
 *   5  Preview     a sphere of a material under a studio of lights
 *
 * Everything here may allocate; what writes a file writes it completely or not at all. Nothing prints
 * or exits. There is no global state: calls with different outputs may run in different threads.
 *
 * A description (asp_chart, asp_polar, asp_preview) is a plain struct. Set it to zero, fill in what
 * matters: zero means the default everywhere.
 *
 *     asp_series curve = { .label = "student_t", .x = theta, .y = f, .count = 90 };
 *     asp_chart  chart = { .title = "nickel", .x = { .label = "theta_{h} [deg]" },
 *                          .y = { .label = "f [1/sr]", .scale = ASP_SCALE_LOG },
 *                          .series = &curve, .series_count = 1 };
 *     asp_chart_write(&chart, "nickel.svg", &err);
 *
 *     asp_preview look = { .material = &gold, .samples = 128 };
 *     asp_image   image;
 *     if (asp_preview_render(&look, &image, &err) == ASP_OK) {
 *         asp_image_write(&image, "gold.png", NULL, &err);
 *         asp_image_free(&image);
 *     } */
#ifndef ASPERITY_DRAW_H
#define ASPERITY_DRAW_H

#include "asperity.h"
#include "asperity_data.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------ 1  Images */

#define ASP_IMAGE_SIDE 16384         /* most pixels along a side */

/* Linear sRGB (Rec. 709 primaries, D65), three floats per pixel, rows from top to bottom without
 * padding: pixel (column, row) starts at rgb[3 * (row * width + column)]. */
typedef struct asp_image { int width, height; float *rgb; } asp_image;

/* A black image. Width and height in [1, ASP_IMAGE_SIDE]. ASP_EINVAL, ASP_ENOMEM. */
asp_status asp_image_make(int width, int height, asp_image *out, asp_error *err);
/* Frees the pixels and empties the image. NULL and an empty image are fine. */
void asp_image_free(asp_image *image);
/* Copies `source` into `target` with its upper left corner at (left, top), any integers; what falls
 * outside is left out. Two renderings beside one another, say. */
void asp_image_place(asp_image *target, const asp_image *source, int left, int top);

/* How linear light becomes the 8 bits of a PNG, per channel:
 *     x = 2^exposure * value
 *     x = 1 - soft + soft (1 - exp(-(x - 1 + soft)/soft))   where x > 1 - soft
 *     x cut to [0, 1], sRGB transfer function (IEC 61966-2-1), rounded to n/255.
 * soft = 0 cuts at 1; 0.4, say, keeps everything below 0.6 as it is and rolls highlights off with a
 * continuous slope. A NaN in any channel makes the pixel magenta: it should be seen. */
typedef struct asp_tone {
    double exposure;                 /* stops, [-64, 64] */
    double soft;                     /* [0, 1] */
} asp_tone;

typedef struct asp_image_options {
    asp_tone tone;                   /* .png only; .exr and .pfm store the values */
    int exr_float;                   /* 0: 16-bit half, finite values beyond 65504 stored as that */
    int exr_uncompressed;            /* 0: PIZ (lossless) */
} asp_image_options;

/* Writes by the extension (any case) of the name: .png (8-bit sRGB), .exr (OpenEXR scan lines,
 * channels B, G, R) or .pfm (32-bit float, little-endian). options NULL: the defaults. Any other
 * extension: ASP_EUNKNOWN, the reason lists the allowed. The file is made under a temporary name in
 * the same folder and renamed when complete; on failure (ASP_EIO with the system's reason,
 * ASP_ENOMEM) `path` is as it was. A path that is a device or a pipe is written directly. */
asp_status asp_image_write(const asp_image *image, const char *path,
                           const asp_image_options *options, asp_error *err);

/* The bytes of a PNG file in memory; *bytes is to be freed with free(). tone NULL: the default. */
asp_status asp_image_png(const asp_image *image, const asp_tone *tone, unsigned char **bytes,
                         size_t *size, asp_error *err);

/* Base64 (RFC 4648, padded, no line breaks), terminated; to be freed with free(). NULL: no memory.
 * In HTML: <img alt="..." src="data:image/png;base64,HERE">. */
char *asp_base64(const void *bytes, size_t size);

/* Writes any text or bytes with the promise of asp_image_write: complete or not at all. */
asp_status asp_file_write(const char *path, const void *bytes, size_t size, asp_error *err);

/* ------------------------------------------------------------------ 2  Colours
 *
 * Colours are strings "#rrggbb". Those of the distributions stay apart for protan, deutan and tritan
 * eyes (how far: tests/test_draw_chart.c), and each has a dash pattern of its own for print in grey. */

/* The colour of a distribution (ggx, beckmann, student_t, ellipsoid, phong, torrance_sparrow, abc,
 * sgd, gtr, hyper_cauchy: more than asp_models() has, so that a colour stays a name's) or of "measured"
 * (black). The name may go on after ':', ',', ' ' or '(' as
 * in a spec. Any other name, or NULL: NULL. */
const char *asp_colour(const char *name);
/* For things without a name: eight colours that go round, the first ones most distinct. */
const char *asp_colour_nth(size_t index);

typedef enum asp_dash {
    ASP_DASH_AUTO = 0,     /* that of the distribution when the label begins with its name, or solid */
    ASP_DASH_SOLID, ASP_DASH_LONG, ASP_DASH_SHORT, ASP_DASH_DOTS, ASP_DASH_LONG_DOT,
    ASP_DASH_NONE          /* no line: markers only */
} asp_dash;

typedef enum asp_marker {
    ASP_MARKER_NONE = 0, ASP_MARKER_CIRCLE, ASP_MARKER_SQUARE, ASP_MARKER_DIAMOND,
    ASP_MARKER_TRIANGLE, ASP_MARKER_CROSS, ASP_MARKER_DOT    /* dot: small, for many points */
} asp_marker;

/* ------------------------------------------------------------------ 3  Charts
 *
 * The text is one <svg> element without scripts, ids, style sheets, fonts or references: it can be
 * written to a file, and any number of them stand inline in one HTML page. Labels are UTF-8 and
 * escaped; _{...} lowers and ^{...} raises (one level), as in "theta_{h}"; "student_t" is left as it
 * is. Invalid UTF-8 and control characters come out as U+FFFD. Resting the pointer on a curve shows
 * its label. */

typedef enum asp_scale { ASP_SCALE_LINEAR = 0, ASP_SCALE_LOG } asp_scale;

typedef struct asp_axis {
    const char *label;               /* with the unit: "theta_{h} [deg]" */
    asp_scale   scale;
    double      low, high;           /* low < high (log: both > 0); both 0: from the data */
    double      step;                /* linear: distance of the ticks; 0: 1, 2 or 5 times 10^n,
                                      * or 15, 30, 45 where the label says [deg] */
    double      decades;             /* log from data: at most so many below the highest; 0: 8 */
} asp_axis;

/* One curve. A point whose x or y is not finite, or not above 0 on a logarithmic axis, is a gap: the
 * line breaks there. What lies outside the limits is cut off, not drawn at the edge. */
typedef struct asp_series {
    const char   *label;             /* for the legend; NULL: not in it */
    const double *x, *y;             /* count values each */
    const double *low, *high;        /* count values each, or NULL: a shaded band around the curve */
    size_t        count;
    const char   *colour;            /* "#rrggbb" or a name of section 2; NULL: by the label when it
                                      * begins with such a name, else the next of asp_colour_nth */
    asp_dash      dash;
    asp_marker    marker;
    double        width;             /* of the line in px; 0: 1.8 */
    const char   *note;              /* small, in a chart written at the curve where it has most room:
                                      * the parameter that tells it from its family. Curves with the
                                      * same note share it. NULL: none */
} asp_series;

/* A thin grey line across the plot: the mirror direction, a reference value. */
typedef struct asp_rule {
    double      value;               /* outside the limits or not finite: not drawn */
    int         horizontal;          /* 0: at x = value; 1: at y = value, its label on the right; 2: the
                                      * same, its label on the left */
    const char *label;               /* small, beside the line; NULL: none */
} asp_rule;

typedef enum asp_legend {
    ASP_LEGEND_AUTO = 0,             /* in a free corner, or on the right when none is free */
    ASP_LEGEND_RIGHT, ASP_LEGEND_BELOW, ASP_LEGEND_NONE,
    ASP_LEGEND_TOP_RIGHT, ASP_LEGEND_TOP_LEFT, ASP_LEGEND_BOTTOM_LEFT, ASP_LEGEND_BOTTOM_RIGHT
} asp_legend;

typedef struct asp_chart {
    const char       *title;
    asp_axis          x, y;
    const asp_series *series;        /* drawn in this order, the last on top */
    size_t            series_count;
    const asp_rule   *rules;
    size_t            rule_count;
    asp_legend        legend;
    int               width, height; /* px, [160, 8192]; 0: 600 and 400 */
} asp_chart;

/* The SVG text, terminated; to be freed with free(). NULL on failure: limits or sizes that cannot be
 * (ASP_EINVAL), an unknown colour (ASP_EUNKNOWN), no memory (ASP_ENOMEM). A chart without any point
 * to draw is an empty frame with its axes, not an error. */
char *asp_chart_svg(const asp_chart *chart, asp_error *err);
/* The same into a file (.svg is usual, not required) with the promise of asp_image_write. */
asp_status asp_chart_write(const asp_chart *chart, const char *path, asp_error *err);

/* ------------------------------------------------------------------ 4  Polar plots
 *
 * Scattered light in the plane of incidence: the normal points up, light comes in from the left, the
 * mirror direction lies on the right. */

typedef struct asp_polar {
    const char       *title;
    asp_axis          radius;        /* linear: low must be 0 (or both 0); log: low at the centre;
                                      * log from data: `decades`, 0: 4 */
    const asp_series *series;        /* x: angle from the normal, radians, > 0 to the right, in
                                      * [-pi/2, pi/2] (else a gap); y: radius. No bands. */
    size_t            series_count;
    const double     *incidence;     /* angles of incidence, radians in [0, pi/2]: arrows on the left */
    size_t            incidence_count;
    asp_legend        legend;        /* NONE, or below the plot for any other */
    int               width;         /* px, [160, 8192]; 0: 600. The height follows. */
} asp_polar;

char *asp_polar_svg(const asp_polar *polar, asp_error *err);
asp_status asp_polar_write(const asp_polar *polar, const char *path, asp_error *err);

/* Fills angle[i], evenly from -pi/2 to pi/2 (count >= 2), and value[i] = luminance (Rec. 709) of
 * f(wi, wo), times cos(theta_o) when with_cosine, at wi = (-sin theta_i, 0, cos theta_i) and
 * wo = (sin angle, 0, cos angle), both turned about the normal by `azimuth`: one curve of a polar
 * plot, or of a chart. f NULL: evaluates `context` as an asp_material. */
void asp_lobe(asp_brdf_function *f, const void *context, double theta_i, double azimuth,
              int with_cosine, size_t count, double *angle, double *value);

/* ------------------------------------------------------------------ 5  Preview
 *
 * World: x to the right, y up, z towards the viewer; the camera looks along -z at a sphere around the
 * origin. The surface's local frame at the unit normal n: z = n; x = the direction of growing azimuth
 * around the y axis (east, to the right in the middle of the picture); y = z cross x (north, up in the
 * middle). At the two poles x is the world's. So alpha_x is the roughness along the parallels.
 *
 * Lights are infinitely far away: the environment is a function of direction. One bounce: the sphere
 * does not see itself. A pixel is the average over its area of
 *     L(view) = integral of f(view, w) max(0, n.w) L_env(w) dw                (rendering equation)
 * with wi = the direction to the viewer and wo = the direction to the light, both local. */

typedef enum asp_light_shape { ASP_LIGHT_DISC = 0, ASP_LIGHT_RECTANGLE } asp_light_shape;

/* A light of constant radiance. Disc: all directions closer to `direction` than `radius` radians in
 * (0, pi/2). Rectangle: the directions through a rectangle on the plane at distance 1 in `direction`,
 * half_width by half_height (tangents of half its angles, (0, 100]), upright (its width level with
 * the horizon), then turned by `roll` radians counter-clockwise as seen from the origin. */
typedef struct asp_light {
    asp_light_shape shape;
    asp_vec3 direction;              /* towards the light, any length > 0 */
    double   radius;
    double   half_width, half_height, roll;
    asp_rgb  radiance;               /* >= 0; lights that overlap add up */
} asp_light;

#define ASP_LIGHTS 8

/* radiance(w) = lights + sky. Above the horizon (w.y >= 0) the sky is
 * horizon + (zenith - horizon) s, below it ground + (nadir - ground) s, s = 1 - (1 - |w.y|)^3. */
typedef struct asp_environment {
    asp_rgb   zenith, horizon, ground, nadir;
    asp_light lights[ASP_LIGHTS];
    int       light_count;
} asp_environment;

/* The default: dim sky over a darker ground; a large soft box on the upper left (key), a tall strip on
 * the right (rim), a small warm disc on the upper right and a wide panel behind and above. A white
 * Lambertian sphere reaches a radiance of about 1 on its brightest side. */
asp_environment asp_environment_studio(void);
/* The same radiance from everywhere: a surface that absorbs nothing disappears in it. */
asp_environment asp_environment_furnace(double radiance);
/* Radiance from the direction w (world, unit). */
asp_rgb asp_environment_radiance(const asp_environment *environment, asp_vec3 w);

/* Called now and then by the thread that called asp_preview_render, and by no other; fraction grows
 * from 0 to 1. Anything but 0 stops the rendering. */
typedef int asp_preview_progress(void *context, double fraction);

typedef struct asp_preview {
    /* What scatters: either a material, sampled by itself, or a function (f without the cosine, with
     * its own context, called from several threads), sampled by `proposal`. Measured data:
     * .function = a wrapper around asp_measured_eval. */
    const asp_material *material;
    asp_brdf_function  *function;
    const void         *context;
    /* A material that scatters about where the function does, say the one fitted to it; it sets the
     * noise, never the mean. NULL: a built-in mix of a cosine and five lobes from wide to narrow.
     * Beside .material it replaces that one's own sampler: for one that is slow to sample, a quick one
     * of the same roughness. */
    const asp_material *proposal;

    int walk;                            /* 1: multiple scattering of the material (asperity.h 12) */

    const asp_environment *environment;  /* NULL: the studio */
    int      width, height;              /* [1, ASP_IMAGE_SIDE]; 0: 256 */
    int      samples;                    /* per pixel, [1, 65536]; 0: 64; powers of two are best */
    double   zoom;                       /* sphere's diameter / shorter side, up to 1000; 0: 0.9 */
    double   field_of_view;              /* of the sphere, radians [0, 2]; 0: orthographic */
    int      plain;                      /* 0: the environment behind the sphere; 1: `background` */
    asp_rgb  background;
    uint32_t seed;
    int      threads;                    /* 0: as many as processors; [1, 256] */
    asp_preview_progress *progress;      /* NULL: none */
    void    *progress_context;
} asp_preview;

/* Renders into a new image (asp_image_free it); `out` is written on success only. The result depends
 * on the description alone, not on the number of threads. The estimate is unbiased: every sample
 * joins one direction of the surface's sampler and one towards a light by the balance heuristic
 * (Veach, Guibas 1995); light refracted into the sphere is followed until it leaves it; numbers from a Sobol sequence with hashed Owen scrambling (Burley 2020).
 * ASP_EINVAL (named value), ASP_ENOMEM, ASP_ECANCELLED when `progress` said so. */
asp_status asp_preview_render(const asp_preview *preview, asp_image *out, asp_error *err);

#ifdef __cplusplus
}
#endif
#endif
