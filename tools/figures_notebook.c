/* figures_notebook.c - the static plots of the notebook to "Background: Physics and Math of Shading"
 *
 * One row a panel; a family of curves is a spec with %s for the number that varies, and the numbers.
 * The notebook's axes: theta_m from 0 to a right angle, D from 0.
 *
 * Where the scan has lost something, the figure's note says what stands in its place. */
#include "figures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ASP_PRECISION 64
#include "asperity/elementary.h"

enum { POINTS = 241 };

/* ------------------------------------------------------------------ the table */

typedef struct family {
    const char *spec;            /* %s: the number */
    const char *values;          /* with blanks between */
    const char *legend;
    enum { EACH_NOTED = 0, NOT_NOTED, PAIRED } notes;      /* PAIRED: written after those before */
    double width;
    asp_dash dash;               /* 0: solid, of a second family short dashes */
    double (*value)(double);     /* of the number, as it stands in the spec; NULL: itself */
} family;

typedef struct plot { const char *title; family families[3]; } plot;
typedef struct sheet { size_t columns; int width, height; plot plots[FIGURE_PANELS]; } sheet;

/* Walter et al. 2007: the exponent of Phong's that goes with a Beckmann roughness. */
static double exponent_of_alpha(double alpha) { return 2 / (alpha * alpha) - 2; }

#define BY_ALPHA "phong: n = 2/alpha^{2} - 2"
#define TR_ALPHA "trowbridge_reitz: alpha"
#define THICK 3.2
#define OVER 1.6

static const sheet phong = { 3, 420, 360, {
    { "n = 0 to 8", { { "phong:exponent=%s", "0 1 2 4 8", "phong: n", .notes = EACH_NOTED } } },
    { "n = 16 to 128",
      { { "phong:exponent=%s", "16 32 64 128", "phong: n", .notes = EACH_NOTED } } },
    { "n = 256 to 2048",
      { { "phong:exponent=%s", "256 512 1024 2048", "phong: n", .notes = EACH_NOTED } } },
} };

static const sheet beckmann = { 2, 480, 380, {
    { "alpha = 0.4 to 1", { { "beckmann:alpha=%s", "0.4 0.5 0.6 0.7 0.8 0.9 1", "beckmann: alpha",
                              .dash = ASP_DASH_SOLID } } },
    { "alpha = 1 to 7", { { "beckmann:alpha=%s", "1 2 3 4 5 6 7", "beckmann: alpha",
                            .dash = ASP_DASH_SOLID } } },
} };

static const sheet beckmann_phong = { 2, 480, 380, {
    { "rough", { { "beckmann:alpha=%s", "0.4 0.5 0.6 0.7 0.8 0.9 1", "beckmann: alpha",
                   .dash = ASP_DASH_SOLID },
                 { "phong:exponent=%s", "0.4 0.5 0.6 0.7 0.8 0.9 1", BY_ALPHA, .notes = NOT_NOTED,
                   .value = exponent_of_alpha } } },
    { "smooth", { { "beckmann:alpha=%s", "0.1 0.2 0.3 0.4", "beckmann: alpha",
                    .dash = ASP_DASH_SOLID },
                  { "phong:exponent=%s", "0.1 0.2 0.3 0.4", BY_ALPHA, .notes = NOT_NOTED,
                    .value = exponent_of_alpha } } },
} };

static const sheet torrance_sparrow = { 3, 420, 380, {
    { "at equal roughness",
      { { "torrance_sparrow:alpha=%s", "0.2 0.3 0.4 0.5", "torrance_sparrow: alpha", .notes = EACH_NOTED },
        { "phong:exponent=%s", "0.2 0.3 0.4 0.5", BY_ALPHA, .notes = NOT_NOTED,
          .value = exponent_of_alpha } } },
    { "at equal peaks",
      { { "torrance_sparrow:alpha=%s", "0.2027 0.3097 0.425 0.552", "torrance_sparrow: alpha", .width = THICK,
          .dash = ASP_DASH_SOLID },
        { "phong:exponent=%s", "0.2 0.3 0.4 0.5", BY_ALPHA, .notes = PAIRED, .width = OVER,
          .value = exponent_of_alpha } } },
    { "at equal peaks, rougher",
      { { "torrance_sparrow:alpha=%s", "0.7035 0.899 1.195 1.81", "torrance_sparrow: alpha",
          .dash = ASP_DASH_SOLID },
        { "torrance_sparrow:alpha=%s", "100", NULL, .width = THICK },
        { "phong:exponent=%s", "0.6 0.7 0.8 0.9 1", BY_ALPHA, .notes = NOT_NOTED,
          .value = exponent_of_alpha } } },
} };

static const sheet trowbridge_reitz = { 2, 480, 380, {
    { "alpha = 0.4 to 1", { { "trowbridge_reitz:alpha=%s", "0.4 0.5 0.6 0.7 0.8 0.9 1",
                              TR_ALPHA, .notes = EACH_NOTED } } },
    { "alpha = 1 to 7", { { "trowbridge_reitz:alpha=%s", "1 2 3 4 5 6 7",
                            TR_ALPHA, .notes = EACH_NOTED } } },
} };

static const sheet trowbridge_reitz_phong = { 2, 480, 380, {
    { "rough", { { "trowbridge_reitz:alpha=%s", "0.4 0.5 0.6 0.7 0.8 0.9", TR_ALPHA, .notes = EACH_NOTED },
                 { "trowbridge_reitz:alpha=%s", "1", NULL, .width = THICK },
                 { "phong:exponent=%s", "0.4 0.5 0.6 0.7 0.8 0.9 1", BY_ALPHA, .notes = NOT_NOTED,
                   .value = exponent_of_alpha } } },
    { "smooth", { { "trowbridge_reitz:alpha=%s", "0.1 0.2 0.3 0.4", TR_ALPHA, .notes = EACH_NOTED },
                  { "phong:exponent=%s", "0.1 0.2 0.3 0.4", BY_ALPHA, .notes = NOT_NOTED,
                    .value = exponent_of_alpha } } },
} };

#define ABC_OF_ALPHA(gamma) { "gamma = " gamma, { { "abc:alpha=%s,gamma=" gamma, "1 10 100 1000", \
    "abc: alpha", .notes = EACH_NOTED } } }
#define ABC_OF_GAMMA(alpha) { "alpha = " alpha, { { "abc:gamma=%s,alpha=" alpha, "0.1 0.5 1 1.5", \
    "abc: gamma", .notes = EACH_NOTED } } }
static const sheet abc = { 4, 360, 320, {
    ABC_OF_ALPHA("0.1"), ABC_OF_ALPHA("0.5"), ABC_OF_ALPHA("1"), ABC_OF_ALPHA("1.5"),
    ABC_OF_GAMMA("1"), ABC_OF_GAMMA("10"), ABC_OF_GAMMA("100"), ABC_OF_GAMMA("1000"),
} };

static const sheet abc_fits = { 2, 480, 400, {
    { "gamma = 1.75 against Trowbridge-Reitz",
      { { "trowbridge_reitz:alpha=%s", "0.3 0.4 0.5 0.6 0.7", TR_ALPHA, .notes = EACH_NOTED },
        { "abc:alpha=%s,gamma=1.75", "23.5 11.6 6.3 3.55 2.0", "abc: alpha, gamma = 1.75", .notes = PAIRED,
          .width = THICK, .dash = ASP_DASH_DOTS } } },
    { "gamma = 1000 against Phong",
      { { "phong:exponent=%s", "0.3 0.4 0.5 0.6 0.7", BY_ALPHA, .dash = ASP_DASH_SOLID,
          .value = exponent_of_alpha },
        { "abc:alpha=%s,gamma=1000", "0.0212 0.0114 0.0068 0.0043 0.0026",
          "abc: alpha, gamma = 1000", .notes = PAIRED, .width = THICK, .dash = ASP_DASH_DOTS } } },
} };

static const sheet abc_spiky = { 2, 480, 400, {
    { "rough", { { "trowbridge_reitz:alpha=%s", "0.5 0.6 0.7 0.8", TR_ALPHA, .notes = EACH_NOTED },
                 { "abc:alpha=%s,gamma=0.5", "82.5 33.5 14.0 5.75", "abc: alpha, gamma = 0.5",
                   .notes = PAIRED } } },
    { "smooth", { { "trowbridge_reitz:alpha=%s", "0.2 0.3 0.4 0.5", TR_ALPHA, .notes = EACH_NOTED },
                  { "abc:alpha=%s,gamma=0.5", "4250 785 240 82.5", "abc: alpha, gamma = 0.5",
                    .notes = PAIRED } } },
} };

#define SGD_OF_ALPHA(gamma) { "gamma = " gamma, { { "sgd:alpha=%s,gamma=" gamma, "1 0.5 0.2 0.1", \
    "sgd: alpha", .notes = EACH_NOTED } } }
#define SGD_OF_GAMMA(alpha) { "alpha = " alpha, { { "sgd:gamma=%s,alpha=" alpha, "0 0.5 1 1.5", \
    "sgd: gamma", .notes = EACH_NOTED } } }
static const sheet sgd = { 4, 360, 320, {
    SGD_OF_ALPHA("0"), SGD_OF_ALPHA("0.5"), SGD_OF_ALPHA("1"), SGD_OF_ALPHA("1.5"),
    SGD_OF_GAMMA("1"), SGD_OF_GAMMA("0.5"), SGD_OF_GAMMA("0.2"), SGD_OF_GAMMA("0.1"),
} };

#define GTR_OF_ALPHA(gamma) { "gamma = " gamma, { { "gtr:alpha=%s,gamma=" gamma, "1 0.5 0.25 0.1", \
    "gtr: alpha", .notes = EACH_NOTED } } }
#define GTR_OF_GAMMA(alpha) { "alpha = " alpha, { { "gtr:gamma=%s,alpha=" alpha, "1 1.5 2 2.5", \
    "gtr: gamma", .notes = EACH_NOTED } } }
static const sheet gtr = { 4, 360, 320, {
    GTR_OF_ALPHA("1"), GTR_OF_ALPHA("1.5"), GTR_OF_ALPHA("2"), GTR_OF_ALPHA("2.5"),
    GTR_OF_GAMMA("1"), GTR_OF_GAMMA("0.5"), GTR_OF_GAMMA("0.25"), GTR_OF_GAMMA("0.1"),
} };

static const sheet gtr_phong = { 2, 480, 400, {
    { "rough", { { "phong:exponent=%s", "8 4 2 1", "phong: n", .notes = EACH_NOTED },
                 { "gtr:alpha=%s,gamma=10000", "0.999752 0.999859 0.99992 0.999956",
                   "gtr: alpha, gamma = 10000", .notes = PAIRED } } },
    { "smooth", { { "phong:exponent=%s", "100 50 25 8", "phong: n", .notes = EACH_NOTED },
                  { "gtr:alpha=%s,gamma=10000", "0.99745 0.9987 0.999325 0.99975",
                    "gtr: alpha, gamma = 10000", .notes = PAIRED, .width = THICK, .dash = ASP_DASH_DOTS } } },
} };

static const sheet gtr_abc = { 2, 480, 400, {
    { "smooth", { { "abc:alpha=%s,gamma=0.5", "4250 785 240 82.5", "abc: alpha, gamma = 0.5",
                    .dash = ASP_DASH_SOLID },
                  { "gtr:alpha=%s,gamma=0.54", "0.0255193 0.0560768 0.0973288 0.159239",
                    "gtr: alpha, gamma = 0.54", .notes = PAIRED, .width = THICK, .dash = ASP_DASH_DOTS } } },
    { "rough", { { "abc:alpha=%s,gamma=0.5", "82.5 33.5 14.0 5.75", "abc: alpha, gamma = 0.5",
                   .dash = ASP_DASH_SOLID },
                 { "gtr:alpha=%s,gamma=0.54", "0.159239 0.239007 0.347616 0.491061",
                   "gtr: alpha, gamma = 0.54", .notes = PAIRED, .width = THICK, .dash = ASP_DASH_DOTS } } },
} };

/* ------------------------------------------------------------------ drawing it */

int figure_ndf(const char *spec, asp_ndf *out)
{
    asp_error err;
    return asp_ndf_parse(NULL, spec, out, &err) == ASP_OK ? CMD_OK : cmd_bad_ndf("", spec, &err);
}

void figure_angle(size_t i, size_t n, double *degrees, double *cosine, double *sine)
{
    double t = (double)i / (double)n;
    asp_v2 at = aspi_sincos2pi(0.25 * t * sqrt(t));
    *degrees = 90 * t * sqrt(t);
    *cosine = i == n ? 0 : at.x;
    *sine = at.y;
}

static int curve(const char *spec, drawing *d, figure_panel *panel, figure_curve **out)
{
    asp_ndf ndf;
    int status = figure_ndf(spec, &ndf);
    if (status != CMD_OK)
        return status;
    figure_curve *c = *out = drawing_curve(d, panel, POINTS, spec);
    for (size_t i = 0; c && i < POINTS; i++) {
        asp_vec3 m = { 0, 0, 0 };
        figure_angle(i, POINTS - 1, &c->x[i], &m.z, &m.x);
        if (m.z == 0)                              /* the limit: D is 0 at the horizon itself */
            m.z = 1e-9;
        c->y[i] = asp_D(&ndf, m);
    }
    return CMD_OK;
}

static int add_family(const family *f, drawing *d, figure_panel *panel, size_t first)
{
    char values[120];
    size_t index = 0;
    int status = CMD_OK;
    asp_dash second = f->legend && panel->curve_count ? ASP_DASH_SHORT : ASP_DASH_SOLID;
    asp_dash dash = f->dash ? f->dash : second;
    snprintf(values, sizeof values, "%s", f->values);
    for (char *v = strtok(values, " "); v && status == CMD_OK; v = strtok(NULL, " "), index++) {
        char number[ASPI_NUMBER_TEXT], spec[160];
        double value;
        figure_curve *c = NULL;
        snprintf(number, sizeof number, "%s", v);
        aspi_parse_number(v, strlen(v), &value);
        if (f->value)
            number[aspi_format_number(f->value(value), 17, number)] = 0;
        /* the only conversion in a row's spec is its %s */
        const char *at = strstr(f->spec, "%s");
        snprintf(spec, sizeof spec, "%.*s%s%s", (int)(at - f->spec), f->spec, number, at + 2);
        status = curve(spec, d, panel, &c);
        if (!c)
            continue;
        if (index == 0 && f->legend)
            snprintf(c->legend, sizeof c->legend, "%s", f->legend);
        snprintf(c->colour, sizeof c->colour, "%.*s", (int)strcspn(spec, ":"), spec);
        c->width = f->width;
        c->dash = dash;
        if (f->notes == EACH_NOTED)
            snprintf(c->note, sizeof c->note, "%s", v);
        else if (f->notes == PAIRED) {
            figure_curve *other = &panel->curves[first + index];
            size_t n = strlen(other->note);
            snprintf(other->note + n, sizeof other->note - n, " | %s", v);
            memcpy(c->note, other->note, sizeof c->note);
        }
    }
    return status;
}

static int draw_sheet(const figure *f, const figure_job *job)
{
    const sheet *s = f->rows;
    drawing *d = job->out;
    int status = CMD_OK;
    d->columns = s->columns;
    d->width = s->width;
    d->height = s->height;
    for (size_t i = 0; status == CMD_OK && i < FIGURE_PANELS && s->plots[i].title; i++) {
        const plot *p = &s->plots[i];
        figure_panel *panel = drawing_panel(d, p->title, "theta_{m} [deg]", "D [1/sr]", "D");
        panel->x.high = 90;
        panel->x.step = 15;
        size_t first = 0;
        for (size_t k = 0; status == CMD_OK && k < 3 && p->families[k].spec; k++) {
            size_t before = panel->curve_count;
            status = add_family(&p->families[k], d, panel, first);
            first = before;
        }
        double highest = 0;
        for (size_t k = 0; k < panel->curve_count; k++)
            for (size_t j = 0; j < panel->curves[k].count; j++)
                highest = fmax(highest, panel->curves[k].y[j]);
        panel->y.high = 1.06 * highest;
        figure_progress(job, (double)(i + 1) / FIGURE_PANELS);
    }
    return status;
}

static int sheet_available(const figure *f)
{
    const sheet *s = f->rows;
    int all = 1;
    for (size_t i = 0; i < FIGURE_PANELS && s->plots[i].title; i++)
        for (size_t k = 0; k < 3 && s->plots[i].families[k].spec; k++) {
            char name[40];
            const char *spec = s->plots[i].families[k].spec;
            snprintf(name, sizeof name, "%.*s", (int)strcspn(spec, ":"), spec);
            all &= asp_find_model(NULL, name) != NULL;
        }
    return all;
}

/* ------------------------------------------------------------------ Out[26]
 *
 * The notebook asks whether its factor for Torrance-Sparrow, Out[25],
 *     N = 1/4 exp(-a^2) pi^(3/2) a (-i erf(pi/2a - i a) + i erf(pi/2a + i a) + 2 erfi(a)),
 * is real, and draws its imaginary part. erf(z) = 2 z/sqrt(pi) int_0^1 exp(-z^2 t^2) dt here by the
 * trapezoid rule after t = (1 + tanh(pi/2 sinh s))/2. */

typedef struct complex_number { double re, im; } complex_number;

static complex_number error_function(double x, double y)
{
    enum { NODES = 400 };
    const double reach = 3.2, h = 2 * reach / (NODES - 1);
    complex_number sum = { 0, 0 };
    for (int k = 0; k < NODES; k++) {
        double s = -reach + h * k, up = aspi_exp(s), down = aspi_exp(-s);
        double e = aspi_exp(-ASP_PI / 2 * (up - down)), t = 1 / (1 + e);
        double weight = h * ASP_PI / 2 * (up + down) * t * (e / (1 + e));
        double size = weight * aspi_exp(-(x * x - y * y) * t * t), turn = x * fabs(y) * t * t / ASP_PI;
        asp_v2 c = aspi_sincos2pi(turn - floor(turn));
        sum.re += size * c.x;
        sum.im -= y < 0 ? -size * c.y : size * c.y;
    }
    double f = 2 / sqrt(ASP_PI);
    return (complex_number){ f * (x * sum.re - y * sum.im), f * (x * sum.im + y * sum.re) };
}

static complex_number torrance_sparrow_factor(double a)
{
    double x = ASP_PI / (2 * a), f = 0.25 * aspi_exp(-a * a) * ASP_PI * sqrt(ASP_PI) * a;
    complex_number minus = error_function(x, -a), plus = error_function(x, a);
    double erfi = error_function(0, a).im;
    return (complex_number){ f * (minus.im - plus.im + 2 * erfi), f * (plus.re - minus.re) };
}

static int draw_factor(const figure *f, const figure_job *job)
{
    enum { STEPS = 95 };
    static const char *const titles[] = { "imaginary part", "real part" };
    (void)f;
    job->out->width = 480;
    job->out->height = 360;
    for (int k = 0; k < 2; k++) {
        figure_panel *p = drawing_panel(job->out, titles[k], "alpha [rad]", k ? "Re N [sr]" : "Im N [sr]",
                                        k ? "Re N" : "Im N");
        figure_curve *c = drawing_curve(job->out, p, STEPS + 1, "torrance_sparrow");
        p->x.low = 0;
        p->x.high = 1;
        p->y.low = k ? 0 : -0.01;
        p->y.high = k ? 2 : 0.01;
        for (int i = 0; c && i <= STEPS; i++) {
            c->x[i] = 0.05 + 0.01 * i;
            complex_number n = torrance_sparrow_factor(c->x[i]);
            c->y[i] = k ? n.re : n.im;
        }
        if (c) {
            snprintf(c->colour, sizeof c->colour, "torrance_sparrow");
            c->dash = ASP_DASH_SOLID;
        }
    }
    return CMD_OK;
}

#define SHEET(id, heading, place, rows, note) \
    { id, heading, "notebook, " place, "theta_m_deg", note, 0.05, draw_sheet, &rows, sheet_available }
#define GRID "The lists of the scan are lost; the grid is that of SGD, whose text is whole: each row varies " \
             "what the other keeps."

const figure figures_notebook[] = {
    SHEET("notebook-phong", "Phong: cosine powers", "Out[13]", phong,
          "n = 0 is the uniform distribution."),
    SHEET("notebook-beckmann", "Beckmann", "Out[18], Out[19]", beckmann,
          "From alpha = 1/sqrt 2 on the maximum leaves the normal: its cos^2 is 1/(2 alpha^2)."),
    SHEET("notebook-beckmann-phong", "Beckmann and Phong", "Out[21]", beckmann_phong,
          "The plot's text is lost in the scan; the roughnesses are those of Out[35]. The "
          "equivalence of the parameters is Walter's."),
    { "notebook-torrance-sparrow-factor", "Torrance-Sparrow: is the normalisation real?",
      "notebook, Out[26]", "alpha",
      "The plot is the notebook's, the real part is added. The two error functions are conjugate, so that "
      "Out[25] is real.", 0.05, draw_factor, NULL, NULL },
    SHEET("notebook-torrance-sparrow", "Torrance-Sparrow and Phong", "Out[28], Out[29], Out[30]",
          torrance_sparrow,
          "The thick curve without a Phong beside it is alpha = 100: the uniform distribution."),
    SHEET("notebook-trowbridge-reitz", "Trowbridge-Reitz (GGX)", "Out[34]", trowbridge_reitz,
          "alpha = 1 is the uniform distribution."),
    SHEET("notebook-trowbridge-reitz-phong", "Trowbridge-Reitz and Phong", "Out[35]",
          trowbridge_reitz_phong,
          "Thick: alpha = 1, where both are uniform."),
    SHEET("notebook-abc", "ABC", "Out[47]", abc,
          GRID),
    SHEET("notebook-abc-fits", "ABC fitted to Trowbridge-Reitz and to Phong", "Out[51]", abc_fits,
          "Trowbridge-Reitz is met the better the smoother the surface; the limit gamma = inf is not "
          "Phong but exp(-k (1 - cos))."),
    SHEET("notebook-abc-spiky", "ABC, gamma = 0.5, and Trowbridge-Reitz", "Out[54]", abc_spiky,
          "The listed alpha = 240 for a Trowbridge-Reitz of 0.4 gives a peak 2.2 % too high; 228.54 would "
          "meet it."),
    SHEET("notebook-sgd", "SGD", "Out[60]", sgd,
          "The formula is an image in the notebook; it is Bagher et al. 2012's."),
    SHEET("notebook-gtr", "GTR", "Out[73]", gtr,
          GRID),
    SHEET("notebook-gtr-phong", "GTR, gamma = 10000, and Phong", "Out[76]", gtr_phong,
          "The limit gamma = inf is exp(k cos^2), not Phong: the rough curves differ."),
    SHEET("notebook-gtr-abc", "GTR, gamma = 0.54, and ABC, gamma = 0.5", "last plots", gtr_abc,
          "The notebook breaks off before the numbers of these two plots; those of GTR are computed so that "
          "the peaks meet."),
    { .name = NULL }
};
