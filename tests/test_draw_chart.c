/* test_draw_chart.c - charts taken apart again: ticks, positions, gaps, clipping, text, colours */
#define _XOPEN_SOURCE 700
#include <locale.h>

#include "svg_test.h"

static char *draw(const asp_chart *chart)
{
    asp_error err = { 0 };
    char *svg = asp_chart_svg(chart, &err);
    if (!CHECK(svg, "no chart: %s: %s", err.name, err.reason))
        exit(finish_());
    return svg;
}

/* What makes it safe to put into any page. */
static void check_text(const char *svg, const char *what)
{
    const char *fault = svg_fault(svg);
    CHECK(!fault, "%s: not well-formed: %s", what, fault);
    static const char *const words[] = { "<script", " id=", "href", "url(", "<style", "<use", "<image",
                                         " on", "nan", "inf\"", "@", "<foreign", "<a " };
    for (size_t i = 0; i < sizeof words / sizeof *words; i++)
        CHECK(!strstr(svg, words[i]), "%s: holds %s", what, words[i]);
    const char *space = "http://www.w3.org/2000/svg";
    const char *first = strstr(svg, "http");
    CHECK(first && strncmp(first, space, strlen(space)) == 0 && !strstr(first + 4, "http"),
          "%s: only the name space", what);
}

/* ------------------------------------------------------------------ ticks and positions */

typedef struct scale_row { double low, high; int logarithmic; } scale_row;

/* Collects the tick labels of the x axis (centred, on one line) with their px. */
static int x_ticks(const char *svg, double plot_bottom, double px[64], double value[64])
{
    static label labels[300];
    int n = read_labels(svg, labels, 300), count = 0;
    for (int i = 0; i < n && count < 64; i++)
        if (strcmp(labels[i].anchor, "middle") == 0 && fabs(labels[i].y - plot_bottom - 17) < 0.02) {
            px[count] = labels[i].x;
            value[count++] = label_value(labels[i].text);
        }
    return count;
}

static double factor_of(const char *svg)
{
    const char *p = strstr(svg, ">\xc3\x97" "10<tspan");
    if (!p)
        return 1;
    static label labels[300];
    int n = read_labels(svg, labels, 300);
    for (int i = 0; i < n; i++)
        if (strncmp(labels[i].text, "\xc3\x97" "10^", 5) == 0)
            return label_value(labels[i].text + 2);
    return NAN;
}

/* Bottom of the frame: the second number of its V. */
static double frame_bottom(const char *svg)
{
    const char *p = strstr(svg, "stroke=\"#444444\"");
    p = p ? strstr(p, "V") : NULL;
    return p ? atof(p + 1) : NAN;
}

static void test_positions(void)
{
    static const scale_row rows[] = {
        { 0, 1, 0 }, { 0, 90, 0 }, { -3.7, 12.2, 0 }, { 1e-9, 3e-9, 0 }, { -5e7, 2e8, 0 }, { 1e12, 7e12, 0 },
        { 1000, 1000.5, 0 }, { -1e-4, 1e-4, 0 }, { 3, 3.001, 0 }, { 0.2, 0.77, 0 },
        { 1e-3, 10, 1 }, { 1e-12, 1e6, 1 }, { 0.02, 0.9, 1 }, { 3, 5, 1 }, { 1.1, 1.4, 1 }, { 1e-40, 1e40, 1 },
        { 200, 90000, 1 }, { 2.5e-7, 8e-6, 1 },
    };
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        double low = rows[r].low, high = rows[r].high;
        int logarithmic = rows[r].logarithmic;
        double x[33], y[33];
        for (int i = 0; i < 33; i++) {
            double t = i / 32.0;
            x[i] = logarithmic ? low * pow(high / low, t) : low + t * (high - low);
            y[i] = sin(i);
        }
        asp_series series = { .label = "curve", .x = x, .y = y, .count = 33 };
        asp_chart chart = { .x = { .low = low, .high = high, .scale = logarithmic }, .series = &series,
                            .series_count = 1, .legend = ASP_LEGEND_NONE };
        char *svg = draw(&chart);
        check_text(svg, "scale");
        double px[64], value[64], points[64][2], factor = factor_of(svg);
        int moves, count = x_ticks(svg, frame_bottom(svg), px, value);
        int n = path_points(series_part(svg, "curve"), points, 64, &moves);
        CHECK(count >= 2 && count <= 12, "[%g, %g]: %d labels", low, high, count);
        CHECK(n == 33 && moves == 1, "[%g, %g]: %d points in %d strokes", low, high, n, moves);
        /* px of the labels against px of the curve, whose ends are the limits */
        for (int i = 0; i < count; i++) {
            double v = value[i] * factor;
            double t = logarithmic ? log(v / low) / log(high / low) : (v - low) / (high - low);
            double expected = points[0][0] + t * (points[n - 1][0] - points[0][0]);
            /* a label is rounded to the digits it shows: at most 0.1 % of the axis */
            CHECK(fabs(px[i] - expected) < 0.02 + 1e-3 * fabs(points[n - 1][0] - points[0][0]),
                  "[%g, %g]: label %g at %g, belongs at %g", low, high, v, px[i], expected);
            if (i > 0)
                CHECK(v > value[i - 1] * factor && px[i] > px[i - 1] + 18,
                      "[%g, %g]: labels %g and %g collide or repeat", low, high, value[i - 1] * factor, v);
        }
        for (int i = 0; i < n; i++)
            CHECK(fabs(points[i][0] - (points[0][0] + i / 32.0 * (points[32][0] - points[0][0]))) < 0.011,
                  "[%g, %g]: point %d", low, high, i);
        if (!logarithmic && count > 1) {
            double step = (value[count - 1] - value[0]) / (count - 1);
            double mantissa = step / pow(10, floor(log10(step) + 1e-9));
            CHECK(fabs(mantissa - 1) < 1e-6 || fabs(mantissa - 2) < 1e-6 || fabs(mantissa - 5) < 1e-6,
                  "[%g, %g]: step %g", low, high, step);
        }
        free(svg);
    }
    printf("axes: %zu ranges, every label at its place, curves between them\n",
           sizeof rows / sizeof *rows);
}

static void test_degrees(void)
{
    double x[] = { 0.5, 45, 89.5 }, y[] = { 1, 2, 3 };
    asp_series series = { .x = x, .y = y, .count = 3 };
    asp_chart chart = { .x = { .label = "theta [deg]" }, .series = &series, .series_count = 1 };
    char *svg = draw(&chart);
    double px[64], value[64];
    int n = x_ticks(svg, frame_bottom(svg), px, value);
    CHECK(n == 7 && value[0] == 0 && value[1] == 15 && value[6] == 90, "%d ticks", n);
    free(svg);
    chart.x.step = 30;
    svg = draw(&chart);
    n = x_ticks(svg, frame_bottom(svg), px, value);
    CHECK(n == 4 && value[1] == 30 && value[3] == 90, "step 30: %d ticks", n);
    free(svg);
}

/* ------------------------------------------------------------------ gaps and clipping */

static void test_gaps(void)
{
    double x[12], y[12], points[64][2];
    int moves;
    for (int i = 0; i < 12; i++) {
        x[i] = i;
        y[i] = 1 + i + i % 2;
    }
    asp_series series = { .label = "curve", .x = x, .y = y, .count = 12 };
    asp_chart chart = { .series = &series, .series_count = 1 };
    static const double holes[] = { NAN, INFINITY, -INFINITY };
    for (int k = 0; k < 3; k++) {
        y[5] = holes[k];
        char *svg = draw(&chart);
        int n = path_points(series_part(svg, "curve"), points, 64, &moves);
        CHECK(n == 11 && moves == 2, "hole %g: %d points in %d strokes", holes[k], n, moves);
        free(svg);
    }
    chart.y.scale = ASP_SCALE_LOG;
    static const double below[] = { 0, -3 };
    for (int k = 0; k < 2; k++) {
        y[5] = below[k];
        char *svg = draw(&chart);
        int n = path_points(series_part(svg, "curve"), points, 64, &moves);
        CHECK(n == 11 && moves == 2, "%g on a log axis: %d points in %d strokes", below[k], n, moves);
        CHECK(!strstr(series_part(svg, "curve"), "a1.4"), "no dots beside a gap");
        free(svg);
    }
    /* a point between two gaps: a dot instead of a line */
    y[3] = NAN;
    y[5] = NAN;
    char *svg = draw(&chart);
    const char *part = series_part(svg, "curve");
    CHECK(path_points(part, points, 64, &moves) == 9 && moves == 2 && strstr(part, "a1.4"), "lonely point");
    free(svg);
    for (int i = 0; i < 12; i++)
        y[i] = i % 2 ? NAN : -1;
    svg = draw(&chart);
    check_text(svg, "nothing to draw");
    CHECK(path_points(series_part(svg, "curve"), points, 64, &moves) == 0, "nothing drawn");
    free(svg);
    chart.series_count = 0;
    svg = draw(&chart);
    check_text(svg, "no series");
    free(svg);
    printf("gaps: NaN, infinities, 0 and negative on log axes, lonely points, empty charts\n");
}

static void test_clipping(void)
{
    static double x[2000], y[2000], points[4000][2];
    for (int i = 0; i < 2000; i++) {
        x[i] = -1 + 4 * uniform();
        y[i] = tan(3 * uniform()) * 1e3;
    }
    asp_series series = { .label = "wild", .x = x, .y = y, .count = 2000 };
    asp_chart chart = { .x = { .low = 0, .high = 1 }, .y = { .low = -1, .high = 2 }, .series = &series,
                        .series_count = 1, .width = 500, .height = 300, .legend = ASP_LEGEND_NONE };
    char *svg = draw(&chart);
    int moves, n = path_points(series_part(svg, "wild"), points, 4000, &moves), out = 0;
    double left = 1e9, right = -1e9, top = 1e9, bottom = -1e9;
    for (int i = 0; i < n; i++) {
        left = fmin(left, points[i][0]);
        right = fmax(right, points[i][0]);
        top = fmin(top, points[i][1]);
        bottom = fmax(bottom, points[i][1]);
    }
    out = left < 14 || right > 482 || top < 0 || bottom > 300;
    CHECK(n > 100 && !out, "%d points in [%g, %g] x [%g, %g]", n, left, right, top, bottom);
    CHECK(fabs(bottom - frame_bottom(svg)) < 0.02, "cut at the frame, not before");
    free(svg);
    /* a straight line through both limits: the cut ends lie on it */
    double lx[] = { -1, 2 }, ly[] = { -10, 10 };
    series = (asp_series){ .label = "line", .x = lx, .y = ly, .count = 2 };
    svg = draw(&chart);
    n = path_points(series_part(svg, "line"), points, 10, &moves);
    const char *frame = strstr(strstr(svg, "stroke=\"#444444\""), " d=\"M");
    left = atof(frame + 5);
    top = atof(strchr(frame + 5, ' '));
    double plot_width = atof(strchr(frame, 'H') + 1) - left, plot_height = bottom - top;
    /* y = -10 + 20 (x + 1)/3 enters at y = -1 (x = 0.35) and leaves at y = 2 (x = 0.8) */
    CHECK(n == 2 && fabs(points[0][0] - (left + 0.35 * plot_width)) < 0.05
          && fabs(points[0][1] - bottom) < 0.05 && fabs(points[1][0] - (left + 0.8 * plot_width)) < 0.05
          && fabs(points[1][1] - (bottom - plot_height)) < 0.05, "a line cut at both limits");
    free(svg);
    printf("clipping: 2000 wild points and a line\n");
}

static void test_band(void)
{
    double x[] = { 0, 1, 2, 3, 4, 5 }, y[] = { 1, 2, 3, 2, 1, 1 };
    double low[] = { 0.5, 1, 1, 0, NAN, 0.1 }, high[] = { 2, 100, 1e300, 3, 2, 2 };
    asp_series series = { .label = "with band", .x = x, .y = y, .low = low, .high = high, .count = 6 };
    asp_chart chart = { .y = { .low = 0.1, .high = 10, .scale = ASP_SCALE_LOG }, .series = &series,
                        .series_count = 1 };
    char *svg = draw(&chart);
    check_text(svg, "band");
    const char *band = strstr(svg, "fill-opacity=\"0.18\"");
    double points[64][2], bottom = frame_bottom(svg);
    int moves, n = 0, inside = 1;
    char copy[4096];
    snprintf(copy, sizeof copy, "%s", band ? band : "");
    char *z = strchr(copy, 'z');
    if (z)
        *z = '"';
    n = path_points(copy, points, 64, &moves);
    for (int i = 0; i < n && i < 64; i++)
        inside &= points[i][1] <= bottom + 0.011 && points[i][1] >= 13.9;
    CHECK(n >= 8 && moves == 1 && inside, "band: %d corners, inside %d", n, inside);
    free(svg);
}

/* ------------------------------------------------------------------ text */

static void test_labels(void)
{
    double x[] = { 1, 2 }, y[] = { 1, 2 };
    asp_series series[] = {
        { .label = "a <b> & \"c\" 'd'", .x = x, .y = y, .count = 2 },
        { .label = "bad \xff\xc0\xaf\xed\xa0\x80 \x01 utf-8 \xe2\x82", .x = x, .y = y, .count = 2 },
        { .label = "student_t^2 {x} _{unclosed", .x = x, .y = y, .count = 2 },
        { .label = "\xce\xb8_{h}^{2} [deg]", .x = x, .y = y, .count = 2 },
    };
    asp_chart chart = { .title = "</svg><script>alert(1)</script>", .x = { .label = "\"x\"" },
                        .y = { .label = "f_{<}" }, .series = series, .series_count = 4 };
    char *svg = draw(&chart);
    check_text(svg, "odd labels");
    CHECK(strstr(svg, "a &lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;"), "escaped label");
    CHECK(strstr(svg, "bad \xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbd"), "bad UTF-8 is replaced");
    CHECK(strstr(svg, ">student_t^2 {x} _{unclosed<"), "underscores without braces stay");
    label labels[100];
    int n = read_labels(svg, labels, 100), found = 0;
    for (int i = 0; i < n; i++)
        found |= strcmp(labels[i].text, "\xce\xb8_h^2_ [deg]") == 0;      /* the last _ leads back down */
    CHECK(found, "lowered and raised parts");
    free(svg);
    printf("labels: escapes, bad UTF-8, scripts, lowered and raised parts\n");
}

static void test_locale(void)
{
    double x[] = { 0, 1.5, 2.25 }, y[] = { 0.001, 0.125, 7.5 };
    asp_series series = { .x = x, .y = y, .count = 3 };
    asp_chart chart = { .y = { .scale = ASP_SCALE_LOG }, .series = &series, .series_count = 1 };
    char *before = draw(&chart);
    static const char *const names[] = { "de_DE.UTF-8", "fr_FR.UTF-8", "de_DE", "nl_NL.UTF-8", "ru_RU.UTF-8" };
    int set = 0;
    for (int i = 0; i < 5 && !set; i++)
        set = setlocale(LC_NUMERIC, names[i]) != NULL;
    char *after = draw(&chart);
    setlocale(LC_NUMERIC, "C");
    CHECK(strcmp(before, after) == 0, "the same text again%s", set ? ", with a decimal comma" : "");
    printf("locale: %s\n", set ? "a decimal comma changes nothing" : "none with a decimal comma installed");
    free(before);
    free(after);
}

/* ------------------------------------------------------------------ legends */

/* The legend box, when it stands in the plot, must not cover any point of the curve. */
static void test_legend(void)
{
    static const char *const what[] = { "rising", "falling", "hill", "valley", "everywhere" };
    int inside = 0, outside = 0;
    for (int shape = 0; shape < 5; shape++) {
        double x[200], y[200], points[400][2];
        for (int i = 0; i < 200; i++) {
            double t = x[i] = i / 199.0;
            y[i] = shape == 0 ? t : shape == 1 ? 1 - t : shape == 2 ? 4 * t * (1 - t)
                 : shape == 3 ? 1 - 4 * t * (1 - t) : 0.5 + 0.5 * sin(120 * t);
        }
        asp_series series = { .label = "ggx:alpha=0.3", .x = x, .y = y, .count = 200 };
        asp_chart chart = { .series = &series, .series_count = 1 };
        char *svg = draw(&chart);
        int moves, n = path_points(series_part(svg, "ggx:alpha=0.3"), points, 400, &moves), covered = 0;
        const char *box = strstr(svg, "rx=\"2\"");
        while (box && box > svg && *box != '<')
            box--;
        if (box) {
            double left = atof(attribute_of(box, "x")), top = atof(attribute_of(box, "y"));
            double right = left + atof(attribute_of(box, "width")), bottom = top + atof(attribute_of(box, "height"));
            for (int i = 0; i < n; i++)
                covered += points[i][0] > left && points[i][0] < right && points[i][1] > top
                           && points[i][1] < bottom;
            inside++;
        } else {
            outside++;
        }
        CHECK(!covered, "%s: the legend covers %d points", what[shape], covered);
        CHECK(strstr(svg, ">ggx:alpha=0.3</text>"), "%s: no legend", what[shape]);
        CHECK((shape < 4) == (box != NULL), "%s: legend inside %d", what[shape], box != NULL);
        free(svg);
    }
    printf("legends: %d in a free corner, %d outside\n", inside, outside);
}

/* ------------------------------------------------------------------ colours */

typedef struct lab { double l, a, b; } lab;

static lab to_lab(const double rgb[3])          /* linear sRGB to CIELAB, D65 */
{
    static const double m[3][3] = { { 0.4124564, 0.3575761, 0.1804375 },
        { 0.2126729, 0.7151522, 0.0721750 }, { 0.0193339, 0.1191920, 0.9503041 } };
    static const double white[3] = { 0.95047, 1, 1.08883 };
    double f[3];
    for (int i = 0; i < 3; i++) {
        double t = (m[i][0] * rgb[0] + m[i][1] * rgb[1] + m[i][2] * rgb[2]) / white[i];
        f[i] = t > 0.008856 ? cbrt(t) : 7.787 * t + 16.0 / 116;
    }
    return (lab){ 116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2]) };
}

static void test_colours(void)
{
    static const char *const names[] = { "ggx", "beckmann", "student_t", "ellipsoid", "phong",
        "torrance_sparrow", "abc", "sgd", "gtr", "hyper_cauchy", "measured" };
    /* Machado, Oliveira, Fernandes 2009, severity 1 */
    static const double eyes[4][3][3] = { { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } },
        { { 0.152286, 1.052583, -0.204868 }, { 0.114503, 0.786281, 0.099216 }, { -0.003882, -0.048116, 1.051998 } },
        { { 0.367322, 0.860646, -0.227968 }, { 0.280085, 0.672501, 0.047413 }, { -0.011820, 0.042940, 0.968881 } },
        { { 1.255528, -0.076749, -0.178779 }, { -0.078411, 0.930809, 0.147602 }, { 0.004733, 0.691367, 0.303900 } } };
    lab seen[11][4];
    double least = 1e9;
    for (int i = 0; i < 11; i++) {
        const char *colour = asp_colour(names[i]);
        unsigned v = 0;
        if (!CHECK(colour && sscanf(colour, "#%6x", &v) == 1 && strlen(colour) == 7, "%s", names[i]))
            continue;
        double rgb[3], eye[3];
        for (int c = 0; c < 3; c++) {
            double s = (v >> (16 - 8 * c) & 255) / 255.0;
            rgb[c] = s <= 0.04045 ? s / 12.92 : pow((s + 0.055) / 1.055, 2.4);
        }
        double y = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
        CHECK(1.05 / (y + 0.05) >= 2.2, "%s: contrast to white %.2f", names[i], 1.05 / (y + 0.05));
        for (int e = 0; e < 4; e++) {
            for (int c = 0; c < 3; c++) {
                double t = eyes[e][c][0] * rgb[0] + eyes[e][c][1] * rgb[1] + eyes[e][c][2] * rgb[2];
                eye[c] = fmin(1, fmax(0, t));
            }
            seen[i][e] = to_lab(eye);
            for (int k = 0; k < i; k++) {
                double d = sqrt(pow(seen[i][e].l - seen[k][e].l, 2) + pow(seen[i][e].a - seen[k][e].a, 2)
                                + pow(seen[i][e].b - seen[k][e].b, 2));
                least = fmin(least, d);
                CHECK(d > 22, "%s and %s are %.1f apart for eye %d", names[i], names[k], d, e);
            }
        }
    }
    printf("colours: closest pair %.1f apart in CIELAB over four kinds of eyes\n", least);
    CHECK(strcmp(asp_colour("measured"), "#000000") == 0, "measured is black");
    CHECK(asp_colour("ggx:alpha=0.3") == asp_colour("ggx") && asp_colour("ggx (fit)") == asp_colour("ggx")
          && asp_colour("std") == asp_colour("student_t"), "names at the head of labels, aliases");
    CHECK(!asp_colour("ggxx") && !asp_colour("gg") && !asp_colour("") && !asp_colour(NULL)
          && !asp_colour(":"), "no other names");
    for (size_t i = 0; i < 20; i++)
        CHECK(asp_colour_nth(i) && strcmp(asp_colour_nth(i), asp_colour_nth(i + 8)) == 0
              && strcmp(asp_colour_nth(i), asp_colour_nth(i + 1)) != 0, "colour %zu", i);
}

/* ------------------------------------------------------------------ refusals, size, files */

static void test_errors(void)
{
    double x[] = { 1, 2 };
    asp_series series = { .x = x, .y = x, .count = 2 };
    const struct { asp_chart chart; asp_status status; const char *name; } rows[] = {
        { { .x = { .low = 2, .high = 1 } }, ASP_EINVAL, "x.high" },
        { { .x = { .low = 1, .high = 1 } }, ASP_EINVAL, "x.high" },
        { { .y = { .low = 0, .high = 1, .scale = ASP_SCALE_LOG } }, ASP_EINVAL, "y.low" },
        { { .y = { .low = NAN, .high = 1 } }, ASP_EINVAL, "y.low" },
        { { .y = { .low = 0, .high = INFINITY } }, ASP_EINVAL, "y.high" },
        { { .y = { .step = -1 } }, ASP_EINVAL, "y.step" },
        { { .y = { .decades = -1 } }, ASP_EINVAL, "y.decades" },
        { { .y = { .scale = (asp_scale)7 } }, ASP_EINVAL, "y.scale" },
        { { .width = 10 }, ASP_EINVAL, "width" },
        { { .height = 100000 }, ASP_EINVAL, "height" },
        { { .legend = (asp_legend)99 }, ASP_EINVAL, "legend" },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        asp_chart chart = rows[i].chart;
        chart.series = &series;
        chart.series_count = 1;
        asp_error err = { 0 };
        char *svg = asp_chart_svg(&chart, &err);
        CHECK(!svg && err.status == rows[i].status && strcmp(err.name, rows[i].name) == 0,
              "row %zu: %s: %s", i, err.name, err.reason);
        free(svg);
    }
    asp_chart chart = { .series = &series, .series_count = 1 };
    static const char *const bad[] = { "red", "#12345", "#12345g", "\"/><script>", "" };
    asp_error err = { 0 };
    for (size_t i = 0; i < 5; i++) {
        series.colour = bad[i];
        CHECK(!asp_chart_svg(&chart, &err) && err.status == ASP_EUNKNOWN, "colour %s", bad[i]);
    }
    series.colour = "beckmann";
    char *svg = draw(&chart);
    CHECK(strstr(svg, asp_colour("beckmann")), "colour by name");
    free(svg);
    series.x = NULL;
    CHECK(!asp_chart_svg(&chart, &err) && err.status == ASP_EINVAL, "no x");
    CHECK(!asp_chart_svg(&chart, NULL), "errors may be left out");
}

/* Odd numbers in every place: always a well-formed picture or a named refusal. */
static void test_anything(void)
{
    static const double odd[] = { 0, -0.0, 1, -1, 1e-320, 1e300, -1e300, 1.7e308, NAN, INFINITY, -INFINITY,
                                  1e-300, 5e-324, 0.1, 1000, 1.0000000001, 89.99, 1e15 };
    const int n_odd = sizeof odd / sizeof *odd;
    int drawn = 0;
    for (int round = 0; round < 3000; round++) {
        double x[8], y[8], low[8], high[8], limit[4];
        for (int i = 0; i < 8; i++) {
            x[i] = odd[(int)(n_odd * uniform())];
            y[i] = odd[(int)(n_odd * uniform())];
            low[i] = odd[(int)(n_odd * uniform())];
            high[i] = odd[(int)(n_odd * uniform())];
        }
        for (int i = 0; i < 4; i++)
            limit[i] = uniform() < 0.6 ? 0 : odd[(int)(n_odd * uniform())];
        asp_series series = { .label = "odd", .x = x, .y = y, .count = 8, .marker = round % 7,
                              .low = round % 3 ? NULL : low, .high = high };
        asp_rule rule = { limit[0], round & 1, "here" };
        asp_chart chart = { .x = { .low = limit[0], .high = limit[1], .scale = round & 1, .label = "[deg]" },
                            .y = { .low = limit[2], .high = limit[3], .scale = round >> 1 & 1 },
                            .series = &series, .series_count = 1, .rules = &rule, .rule_count = 1,
                            .legend = round % 8, .width = 160 + round % 300, .height = 160 };
        asp_error err = { 0 };
        char *svg = asp_chart_svg(&chart, &err);
        if (!svg) {
            CHECK(err.status == ASP_EINVAL && (err.name[0] == 'x' || err.name[0] == 'y'), "%s", err.reason);
            continue;
        }
        drawn++;
        const char *fault = svg_fault(svg);
        CHECK(!fault && !strstr(svg, "nan") && !strstr(svg, "inf"), "round %d: %s", round, fault);
        free(svg);
    }
    CHECK(drawn > 500, "only %d drawn", drawn);
    printf("odd numbers: 3000 charts, %d drawn, the others refused by name\n", drawn);
}

static void test_size(void)
{
    const size_t n = 1000000;
    double *x = malloc(n * sizeof *x), *y = malloc(n * sizeof *y);
    if (!x || !y)
        exit(1);
    for (size_t i = 0; i < n; i++) {
        x[i] = (double)i / (double)n;
        y[i] = sin(20 * x[i]);
    }
    asp_series series = { .label = "long", .x = x, .y = y, .count = n };
    asp_chart chart = { .series = &series, .series_count = 1 };
    char *svg = draw(&chart);
    CHECK(strlen(svg) < 150000, "a million points make %zu bytes", strlen(svg));
    printf("size: a million points in %zu bytes\n", strlen(svg));
    free(svg);
    free(x);
    free(y);
}

static void test_files(void)
{
    double x[] = { 1, 2 };
    asp_series series = { .x = x, .y = x, .count = 2 };
    asp_chart chart = { .series = &series, .series_count = 1 };
    asp_error err = { 0 };
    char *svg = draw(&chart);
    size_t size;
    CHECK(asp_chart_write(&chart, in_folder("chart.svg"), &err) == ASP_OK, "written");
    char *bytes = read_file(in_folder("chart.svg"), &size);
    CHECK(bytes && size == strlen(svg) && memcmp(bytes, svg, size) == 0, "file and text differ");
    free(bytes);
    free(svg);
    char missing[900];
    snprintf(missing, sizeof missing, "%s/a.svg", in_folder("missing"));
    CHECK(asp_chart_write(&chart, missing, &err) == ASP_EIO && strstr(err.file, "missing"), "missing folder");
    if (access("/dev/full", W_OK) == 0)
        CHECK(asp_chart_write(&chart, "/dev/full", &err) == ASP_EIO, "full disk");
    chart.width = 1;
    CHECK(asp_chart_write(&chart, in_folder("never.svg"), &err) == ASP_EINVAL
          && access(in_folder("never.svg"), F_OK) != 0, "no file of a refused chart");
}

int main(void)
{
    test_positions();
    test_degrees();
    test_gaps();
    test_clipping();
    test_band();
    test_labels();
    test_locale();
    test_legend();
    test_colours();
    test_errors();
    test_anything();
    test_size();
    test_files();
    return finish_();
}
