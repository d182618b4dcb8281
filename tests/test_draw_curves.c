/* test_draw_curves.c - curves with the points left out that nobody sees, and notes that stand at them */
#define _XOPEN_SOURCE 700
#include "svg_test.h"

static char *draw(const asp_chart *chart)
{
    asp_error err = { 0 };
    char *svg = asp_chart_svg(chart, &err);
    if (!CHECK(svg, "no chart: %s: %s", err.name, err.reason))
        exit(finish_());
    return svg;
}

/* How far a point is from the nearest piece of a path. */
static double path_distance(double x, double y, double path[][2], int count)
{
    double best = 1e9;
    for (int i = 1; i < count; i++) {
        double dx = path[i][0] - path[i - 1][0], dy = path[i][1] - path[i - 1][1];
        double t = ((x - path[i - 1][0]) * dx + (y - path[i - 1][1]) * dy) / (dx * dx + dy * dy + 1e-12);
        t = t < 0 ? 0 : t > 1 ? 1 : t;
        best = fmin(best, hypot(x - path[i - 1][0] - t * dx, y - path[i - 1][1] - t * dy));
    }
    return best;
}

/* Points that lie on the line between their neighbours are left out, and nothing else is: every point
 * given is on the path drawn, within a twentieth of a pixel and the rounding of coordinates. */
static void test_thinning(void)
{
    enum { COUNT = 1001 };
    static double x[COUNT], y[COUNT], points[COUNT][2];
    int moves;
    for (int kind = 0; kind < 5; kind++) {
        for (int i = 0; i < COUNT; i++) {
            double t = (double)i / (COUNT - 1);
            x[i] = kind == 4 ? fabs(fmod(7 * t, 2) - 1) : t;        /* to and fro along one line */
            y[i] = kind == 0 ? t : kind == 1 ? exp(-50 * t * t) : kind == 2 ? 0.5 + 0.4 * sin(40 * t)
                 : kind == 3 ? (i / 100) % 2 : 0.5;
        }
        asp_series series = { .label = "curve", .x = x, .y = y, .count = COUNT };
        asp_chart chart = { .series = &series, .series_count = 1, .x = { .high = 1 }, .y = { .high = 1 },
                            .legend = ASP_LEGEND_NONE };
        char *svg = draw(&chart);
        int n = path_points(series_part(svg, "curve"), points, COUNT, &moves);
        double worst = 0, left = points[0][0], right = points[0][0], low = points[0][1], high = points[0][1];
        for (int i = 0; i < n; i++) {
            left = fmin(left, points[i][0]);
            right = fmax(right, points[i][0]);
            low = fmax(low, points[i][1]);
            high = fmin(high, points[i][1]);
        }
        double bottom = kind == 2 ? 0.1 : kind == 4 ? 0.5 : 0, top = kind == 2 ? 0.9 : kind == 4 ? 0.5 : 1;
        for (int i = 0; i < COUNT; i++) {
            double px = left + x[i] * (right - left);
            double py = top == bottom ? low : low + (y[i] - bottom) / (top - bottom) * (high - low);
            worst = fmax(worst, path_distance(px, py, points, n));
        }
        static const int most[] = { 2, 70, 400, 40, 9 };
        CHECK(moves == 1 && n <= most[kind], "thinning %d: %d points in %d strokes", kind, n, moves);
        CHECK(worst < 0.08, "thinning %d: %g px from the line drawn", kind, worst);
        free(svg);
    }
    printf("thinning: 5 curves of %d points, all on the lines drawn\n", COUNT);
}

/* Where a note stands: its text element's x and y; 0 when there is none. */
static int note_at(const char *svg, const char *note, double *x, double *y)
{
    char wanted[64];
    snprintf(wanted, sizeof wanted, ">%s</text>", note);
    const char *end = strstr(svg, wanted), *at = end;
    while (at && at > svg && *at != '<')
        at--;
    return at && sscanf(at, "<text xml:space=\"preserve\" x=\"%lf\" y=\"%lf\"", x, y) == 2;
}

/* Each note stands at its own curve, nearer than at any other, and not on a line. */
static void test_notes(void)
{
    enum { CURVES = 5, COUNT = 181 };
    static double x[COUNT], y[CURVES][COUNT], points[COUNT][2];
    static const char *const notes[CURVES] = { "0.1", "0.2", "0.4", "0.8", "1.6" };
    asp_series series[CURVES];
    int moves, placed = 0;
    memset(series, 0, sizeof series);
    for (int k = 0; k < CURVES; k++) {
        double a = atof(notes[k]);
        for (int i = 0; i < COUNT; i++) {
            double t = x[i] = 0.5 * i, c = cos(t * acos(-1) / 180);
            y[k][i] = 1 / (a * a) / pow(1 + (1 / (a * a) - 1) * (1 - c * c), 2);
        }
        series[k] = (asp_series){ .label = notes[k], .x = x, .y = y[k], .count = COUNT, .note = notes[k],
                                  .colour = "ggx" };
    }
    asp_chart chart = { .series = series, .series_count = CURVES, .y = { .scale = ASP_SCALE_LOG },
                        .legend = ASP_LEGEND_NONE };
    char *svg = draw(&chart);
    CHECK(!svg_fault(svg), "notes: %s", svg_fault(svg));
    for (int k = 0; k < CURVES; k++) {
        double at_x, at_y, own = 0, other = 1e9;
        int found = note_at(svg, notes[k], &at_x, &at_y);
        CHECK(found, "note %s is there", notes[k]);
        if (!found)
            continue;
        placed++;
        for (int j = 0; j < CURVES; j++) {
            int n = path_points(series_part(svg, notes[j]), points, COUNT, &moves);
            double d = path_distance(at_x, at_y - 4, points, n);
            own = j == k ? d : own;
            other = j == k ? other : fmin(other, d);
        }
        CHECK(own > 3 && own < 25 && other > own, "note %s: %.1f px from its curve, %.1f from another",
              notes[k], own, other);
    }
    free(svg);
    printf("notes: %d of %d at their curves\n", placed, CURVES);
}

int main(void)
{
    test_thinning();
    test_notes();
    return finish_();
}
