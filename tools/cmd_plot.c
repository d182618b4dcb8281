/* cmd_plot.c - curves of distributions and lobes of materials and measurements, as SVG */
#include "cmd.h"
#include "panels.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SURFACES 12
#define INCIDENCES 6
#define PANELS 8
#define CURVES (SURFACES * INCIDENCES)
#define POINTS 1441              /* 0.125 degrees apart from -90 to 90 */

static const double degree = 3.14159265358979323846 / 180;

/* ------------------------------------------------------------------ the quantities */

enum { WANTS_NDF = 1, SIGNED_ANGLE = 2, TO_NADIR = 4, POLAR = 8, WITH_COSINE = 16 };

static double at_D(const asp_ndf *k, asp_vec3 w, int mask) { (void)mask; return asp_D(k, w); }
static double at_sigma(const asp_ndf *k, asp_vec3 w, int mask) { (void)mask; return asp_sigma(k, w); }
static double at_lambda(const asp_ndf *k, asp_vec3 w, int mask) { return asp_lambda(k, w, mask); }
static double at_G1(const asp_ndf *k, asp_vec3 w, int mask) { return asp_G1(k, w, mask); }
static double at_P22(const asp_ndf *k, asp_vec3 w, int mask)
{
    (void)mask;
    return w.z > 0 ? asp_P22(k, -w.x / w.z, -w.y / w.z) : NAN;
}

static const struct quantity {
    const char *name, *title, *x, *y;
    int form;
    double (*at)(const asp_ndf *, asp_vec3, int);
} quantities[] = {
    { "D", "Density of normals", "theta_{m} [deg]", "D [1/sr]", WANTS_NDF, at_D },
    { "P22", "Density of slopes", "theta_{m} [deg], slope tan(theta_{m})", "P_{22}", WANTS_NDF,
      at_P22 },
    { "sigma", "Projected area of the facets", "theta [deg]", "sigma", WANTS_NDF | TO_NADIR,
      at_sigma },
    { "lambda", "Smith's Lambda", "theta [deg]", "Lambda", WANTS_NDF, at_lambda },
    { "G1", "Masking", "theta [deg]", "G_{1}", WANTS_NDF, at_G1 },
    { "brdf", "BRDF in the plane of incidence", "theta_{o} [deg]", "f [1/sr]", SIGNED_ANGLE, NULL },
    { "brdf_cos", "Scattered light in the plane of incidence", "theta_{o} [deg]",
      "f cos(theta_{o}) [1/sr]", SIGNED_ANGLE | WITH_COSINE, NULL },
    { "polar", "Scattered light", NULL, "f cos(theta_{o})", SIGNED_ANGLE | POLAR | WITH_COSINE,
      NULL },
};
enum { QUANTITIES = sizeof quantities / sizeof *quantities };

/* ------------------------------------------------------------------ what is drawn */

typedef struct surface {
    const char *label, *colour;
    asp_dash dash;
    asp_material material;
    asp_measured *data;          /* NULL: the material */
} surface;

typedef struct picture {
    surface surfaces[SURFACES];
    size_t  surface_count;
    double  incidence[INCIDENCES];           /* radians */
    size_t  incidence_count;
    double  azimuth;
    int     logarithmic, skewed;
    const char *title;
    const struct quantity *panels[PANELS];
    size_t  panel_count;
} picture;

typedef struct curves {
    asp_series series[CURVES];
    char   label[CURVES][200];
    double x[CURVES][POINTS], y[CURVES][POINTS];
    size_t count;
} curves;

static asp_rgb measured(const void *context, asp_vec3 wi, asp_vec3 wo)
{
    return asp_measured_eval(context, wi, wo);
}

static asp_series *add_curve(const picture *p, curves *to, const surface *s, double incidence)
{
    static const asp_dash dashes[] = { ASP_DASH_SOLID, ASP_DASH_LONG, ASP_DASH_SHORT,
                                       ASP_DASH_DOTS, ASP_DASH_LONG_DOT };
    asp_series *series = &to->series[to->count];
    char *label = to->label[to->count];
    memset(series, 0, sizeof *series);
    if (isnan(incidence)) {
        snprintf(label, sizeof to->label[0], "%s", s->label);
        series->dash = s->dash;
    } else {
        size_t which = 0;
        while (p->incidence[which] != incidence)
            which++;
        snprintf(label, sizeof to->label[0], "%s, %g deg", s->label, incidence / degree);
        series->dash = p->incidence_count > 1 ? dashes[which % 5] : s->dash;
    }
    series->label = label;
    series->colour = s->colour;
    series->x = to->x[to->count];
    series->y = to->y[to->count];
    series->count = POINTS;
    to->count++;
    return series;
}

/* A facet quantity along the arc from the normal (skewed surfaces: from one horizon over the normal
 * to the other). Densities of normals are narrow around the normal: their points lie closer there. */
static void facet_curve(const picture *p, const struct quantity *q, const surface *s, curves *to)
{
    double *x = to->x[to->count], *y = to->y[to->count];
    double high = q->form & TO_NADIR ? 180 : 90, low = p->skewed ? -high : 0;
    int closer = (q->at == at_D || q->at == at_P22) && !p->skewed;
    for (int i = 0; i < POINTS; i++) {
        double t = (double)i / (POINTS - 1), angle = low + (high - low) * (closer ? t * t : t);
        asp_vec3 w = { sin(angle * degree) * cos(p->azimuth),
                       sin(angle * degree) * sin(p->azimuth), cos(angle * degree) };
        if (fabs(angle) == 90)
            w.z = 0;
        x[i] = angle;
        y[i] = q->at(&s->material.ndf, w, s->material.mask);
    }
    add_curve(p, to, s, NAN);
}

static void lobe_curve(const picture *p, const struct quantity *q, const surface *s,
                       double incidence, curves *to)
{
    double *x = to->x[to->count], *y = to->y[to->count];
    asp_lobe(s->data ? measured : NULL, s->data ? (const void *)s->data : &s->material, incidence,
             p->azimuth, (q->form & WITH_COSINE) != 0, POINTS, x, y);
    for (int i = 0; i < POINTS && !(q->form & POLAR); i++)
        x[i] /= degree;
    if (!(q->form & WITH_COSINE))            /* f ends above the horizon, it does not fall to 0 */
        y[0] = y[POINTS - 1] = NAN;
    add_curve(p, to, s, incidence);
}

static void make_curves(const picture *p, const struct quantity *q, curves *to)
{
    to->count = 0;
    for (size_t i = 0; i < p->surface_count; i++) {
        const surface *s = &p->surfaces[i];
        if (q->form & WANTS_NDF) {
            if (!s->data)
                facet_curve(p, q, s, to);
        } else {
            for (size_t j = 0; j < p->incidence_count; j++)
                lobe_curve(p, q, s, p->incidence[j], to);
        }
    }
}

static char *panel_svg(const picture *p, const struct quantity *q, const curves *from,
                       asp_error *err)
{
    const char *title = p->title ? p->title : q->title;
    if (q->form & POLAR) {
        asp_polar polar;
        memset(&polar, 0, sizeof polar);
        polar.title = title;
        polar.radius.label = q->y;
        polar.radius.scale = p->logarithmic ? ASP_SCALE_LOG : ASP_SCALE_LINEAR;
        polar.series = from->series;
        polar.series_count = from->count;
        polar.incidence = p->incidence;
        polar.incidence_count = p->incidence_count;
        return asp_polar_svg(&polar, err);
    }
    asp_chart chart;
    asp_rule mirror[INCIDENCES];
    memset(&chart, 0, sizeof chart);
    memset(mirror, 0, sizeof mirror);
    chart.title = title;
    chart.x.label = q->x;
    chart.x.low = q->form & SIGNED_ANGLE || p->skewed ? (q->form & TO_NADIR ? -180 : -90) : 0;
    chart.x.high = q->form & TO_NADIR ? 180 : 90;
    chart.x.step = q->form & TO_NADIR ? 30 : 15;
    chart.y.label = q->y;
    chart.y.scale = p->logarithmic ? ASP_SCALE_LOG : ASP_SCALE_LINEAR;
    chart.series = from->series;
    chart.series_count = from->count;
    chart.legend = from->count > 4 ? ASP_LEGEND_BELOW : ASP_LEGEND_AUTO;
    for (size_t i = 0; q->form & SIGNED_ANGLE && i < p->incidence_count; i++) {
        mirror[i].value = p->incidence[i] / degree;
        chart.rule_count = i + 1;
    }
    chart.rules = mirror;
    return asp_chart_svg(&chart, err);
}

/* ------------------------------------------------------------------ numbers beside the picture */

static void quoted(const char *text, cmd_out *out)
{
    cmd_out_write(out, "\"", 1);
    for (; *text; text++)
        cmd_out_write(out, *text == '"' ? "'" : text, 1);
    cmd_out_write(out, "\"", 1);
}

static void write_numbers(const struct quantity *q, const curves *from, cmd_out *out)
{
    for (size_t i = 0; i < from->count; i++)
        for (int j = 0; j < POINTS; j++) {
            char text[2 * ASPI_NUMBER_TEXT + 4];
            double x = from->x[i][j] / (q->form & POLAR ? degree : 1);
            size_t used = 0;
            if (isnan(from->y[i][j]))
                continue;
            cmd_out_write(out, q->name, strlen(q->name));
            cmd_out_write(out, ",", 1);
            quoted(from->label[i], out);
            text[used++] = ',';
            used += aspi_format_number(x, 12, text + used);
            text[used++] = ',';
            used += aspi_format_number(from->y[i][j], 17, text + used);
            text[used++] = '\n';
            cmd_out_write(out, text, used);
        }
}

/* ------------------------------------------------------------------ the files */

static int draw(const picture *p, cmd_out *out, cmd_out *numbers)
{
    asp_error err;
    char *svg[PANELS] = { NULL };
    size_t made = 0;
    curves *c = malloc(sizeof *c);
    int status = c ? CMD_OK : cmd_failed("out of memory");
    if (numbers)
        cmd_out_write(numbers, "quantity,curve,theta_deg,value\n", 31);
    for (; status == CMD_OK && made < p->panel_count; made++) {
        make_curves(p, p->panels[made], c);
        svg[made] = panel_svg(p, p->panels[made], c, &err);
        if (!svg[made])
            status = cmd_error(&err);
        else if (numbers)
            write_numbers(p->panels[made], c, numbers);
    }
    if (status == CMD_OK) {
        char *all = panels_svg(svg, p->panel_count, 2, NULL);
        if (all)
            cmd_out_write(out, all, strlen(all));
        else
            status = cmd_failed("out of memory");
        free(all);
    }
    for (size_t i = 0; i < PANELS; i++)
        free(svg[i]);
    free(c);
    return status;
}

/* ------------------------------------------------------------------ what the user asked for */

/* One colour per distribution; where two curves would share it, the general colours instead. */
static void choose_colours(picture *p)
{
    const char *given[SURFACES];
    for (size_t i = 0; i < p->surface_count; i++)
        given[i] = p->surfaces[i].data ? asp_colour("measured")
                                       : asp_colour(p->surfaces[i].label);
    int shared = 0;
    for (size_t i = 0; i < p->surface_count; i++)
        for (size_t j = 0; j < i; j++)
            shared |= !given[i] || (given[j] && strcmp(given[i], given[j]) == 0);
    for (size_t i = 0; i < p->surface_count; i++) {
        surface *s = &p->surfaces[i];
        s->colour = shared || !given[i] ? asp_colour_nth(i) : given[i];
        s->dash = shared || s->data ? ASP_DASH_SOLID : ASP_DASH_AUTO;
    }
}

static int add_model(const cmd_args *args, const char *option, size_t index, picture *p)
{
    surface *s = &p->surfaces[p->surface_count++];
    int status = cmd_surface_at(args, option, index, &s->material);
    s->label = cmd_text_at(args, option, index);
    if (status == CMD_OK) {
        asp_vec2 mean = asp_mean_slope(&s->material.ndf);
        p->skewed |= mean.x != 0 || mean.y != 0;
    }
    return status;
}

static int add_data(const char *path, picture *p)
{
    asp_error err;
    surface *s = &p->surfaces[p->surface_count++];
    const char *slash = strrchr(path, '/');
    s->label = slash ? slash + 1 : path;
    s->data = asp_measured_read(path, &err);
    return s->data ? CMD_OK : cmd_error(&err);
}

static int read_surfaces(const cmd_args *args, picture *p)
{
    size_t ndfs = cmd_given(args, "ndf"), materials = cmd_given(args, "material");
    size_t files = cmd_given(args, "data");
    int status = CMD_OK;
    if (ndfs + materials + files == 0)
        return cmd_usage("nothing to draw: give --ndf SPEC, --material SPEC or --data FILE");
    if (ndfs + materials + files > SURFACES)
        return cmd_usage("%zu surfaces: the number is outside [1, %d]", ndfs + materials + files,
                         SURFACES);
    for (size_t i = 0; status == CMD_OK && i < ndfs; i++)
        status = add_model(args, "ndf", i, p);
    for (size_t i = 0; status == CMD_OK && i < materials; i++)
        status = add_model(args, "material", i, p);
    for (size_t i = 0; status == CMD_OK && i < files; i++)
        status = add_data(cmd_text_at(args, "data", i), p);
    return status;
}

static int read_incidences(const cmd_args *args, picture *p)
{
    const char *text = cmd_text(args, "incidence"), *at = text;
    for (;; at++) {
        double value;
        size_t n = strcspn(at, ",");
        if (p->incidence_count == INCIDENCES)
            return cmd_usage("--incidence %s: more than %d angles", text, INCIDENCES);
        if (!aspi_parse_number(at, n, &value))
            return cmd_usage("--incidence %s: '%.*s' is not a number", text, (int)n, at);
        if (!(value >= 0 && value < 90))
            return cmd_usage("--incidence %s: %g is outside [0, 90)", text, value);
        p->incidence[p->incidence_count++] = value * degree;
        at += n;
        if (!*at)
            return CMD_OK;
    }
}

static int read_quantities(const cmd_args *args, picture *p)
{
    const char *names[QUANTITIES + 1] = { NULL };
    size_t count = cmd_operand_count(args);
    for (int i = 0; i < QUANTITIES; i++)
        names[i] = quantities[i].name;
    if (count > PANELS)
        return cmd_usage("%zu quantities: the number is outside [1, %d]", count, PANELS);
    for (size_t i = 0; i < (count ? count : 1); i++) {
        const char *name = count ? cmd_operand(args, i) : cmd_given(args, "data") ? "brdf" : "D";
        int index = cmd_find(name, names);
        if (index < 0)
            return cmd_unknown("unknown quantity", name, names);
        if (quantities[index].form & WANTS_NDF
            && !cmd_given(args, "ndf") && !cmd_given(args, "material"))
            return cmd_usage("%s is not known of measured data: give --ndf or --material", name);
        p->panels[p->panel_count++] = &quantities[index];
    }
    return CMD_OK;
}

/* The name of the numbers' file: the picture's with .csv for its ending. */
static void beside(const char *path, char *out, size_t size)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    size_t n = dot && dot > (slash ? slash + 1 : path) ? (size_t)(dot - path) : strlen(path);
    snprintf(out, size, "%.*s.csv", (int)n, path);
}

static int write_all(const cmd_args *args, const picture *p)
{
    const char *path = cmd_text(args, "output");
    char other[1024];
    cmd_out out, numbers;
    int csv = cmd_given(args, "csv") > 0, status;
    if (strcmp(path, "-") != 0 && !cmd_ends_in(path, ".svg") && !cmd_is_device(path))
        return cmd_usage("--output %s: the name must end in .svg", path);
    beside(path, other, sizeof other);
    if (csv && (strcmp(path, "-") == 0 || strcmp(path, other) == 0))
        return cmd_usage("--csv needs a picture's file name that can be followed by one in .csv");
    status = cmd_out_open(&out, path);
    if (status != CMD_OK)
        return status;
    if (csv && (status = cmd_out_open(&numbers, other)) != CMD_OK) {
        cmd_out_abandon(&out);
        return status;
    }
    status = draw(p, &out, csv ? &numbers : NULL);
    if (status != CMD_OK) {
        cmd_out_abandon(&out);
        if (csv)
            cmd_out_abandon(&numbers);
        return status;
    }
    status = cmd_out_close(&out);
    int second = csv ? cmd_out_close(&numbers) : CMD_OK;
    return status ? status : second;
}

static int run(const cmd_args *args)
{
    picture *p = calloc(1, sizeof *p);
    int status = p ? read_quantities(args, p) : cmd_failed("out of memory");
    if (status == CMD_OK)
        status = read_incidences(args, p);
    if (status == CMD_OK)
        status = read_surfaces(args, p);
    if (status == CMD_OK) {
        p->azimuth = cmd_number(args, "phi") * degree;
        p->logarithmic = cmd_given(args, "log") > 0;
        p->title = cmd_text(args, "title");
        choose_colours(p);
        status = write_all(args, p);
    }
    for (size_t i = 0; p && i < p->surface_count; i++)
        asp_measured_free(p->surfaces[i].data);
    free(p);
    return status;
}

static const cmd_option options[] = {
    { "output", 'o', "FILE", CMD_TEXT, .required = 1, .help = "the picture, .svg; - is standard output" },
    { "ndf", 0, "SPEC", CMD_TEXT, .many = 1,
      .help = "a distribution (its lobes are those of perfect mirror facets)" },
    { "material", 0, "SPEC", CMD_TEXT, .many = 1, .help = "a material" },
    { "data", 0, "FILE", CMD_TEXT, .many = 1, .help = "a measurement: brdf, brdf_cos and polar" },
    { "mask", 0, "NAME", CMD_TEXT, .help = "masking, as in `asperity list`" },
    { "incidence", 'i', "DEG,...", CMD_TEXT, .initial = "30",
      .help = "angles of incidence of the lobes, each in [0, 90)" },
    { "phi", 0, "DEG", CMD_NUMBER, -360, 360, .initial = "0",
      .help = "azimuth of the plane in which the angles lie" },
    { "log", 'l', NULL, CMD_FLAG, .help = "logarithmic values" },
    { "title", 0, "TEXT", CMD_TEXT, .help = "instead of the quantity's" },
    { "csv", 0, NULL, CMD_FLAG,
      .help = "write the numbers too, beside the picture: name.csv for name.svg, with the columns "
              "quantity, curve, theta_deg, value" },
    CMD_END
};

const cmd_record cmd_plot = {
    "plot", "draw distributions, masking and lobes as SVG", "[QUANTITY...]", 0, PANELS,
    "Facet quantities against the angle from the normal: D, P22, sigma, lambda, G1.\n"
    "Lobes in the plane of incidence, as luminance: brdf, brdf_cos, polar (f cos).\n"
    "Several quantities make one picture of several panels. Without a quantity: D, or\n"
    "brdf where there is --data.\n"
    "\n"
    "  asperity plot D G1 --ndf ggx:alpha=0.3 --ndf beckmann:alpha=0.3 -l -o d.svg\n"
    "  asperity plot polar --data chm.bsdf --ndf ggx:alpha=0.2 -i 0,45,75 -o lobe.svg",
    options, run
};
