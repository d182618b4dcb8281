/* figures_std.c - the charts of the STD paper (Ribardiere et al. 2017)
 *
 * Where a caption does not say what it integrates, the norm is the one that gives its numbers: Figure 5,
 * the integral of |dG1| over the hemisphere; Figure 10, the difference of the two integrals, signs kept.
 * Roughnesses and gammas that only the paper's pictures show are those of its Figure 8 and captions. */
#include "asperity_study.h"
#include "energy.h"
#include "figures.h"

#include <math.h>
#include <string.h>

#define ASP_PRECISION 64
#include "asperity/elementary.h"

/* ------------------------------------------------------------------ one look per gamma
 *
 * gamma = 2 is GGX and infinity Beckmann, and both have their colours; between them shades of
 * student_t's. */

static void look(figure_curve *c, double gamma, int shade)
{
    static const struct { const char *colour; asp_dash dash; } looks[] = {
        { "#0e4a30", ASP_DASH_SOLID }, { "#157548", ASP_DASH_LONG }, { "#22bb77", ASP_DASH_SOLID },
        { "#22bb77", ASP_DASH_SHORT }, { "#5fd0a0", ASP_DASH_LONG_DOT }, { "#0e4a30", ASP_DASH_DOTS },
    };
    if (gamma == 2 || isinf(gamma)) {
        snprintf(c->colour, sizeof c->colour, gamma == 2 ? "ggx" : "beckmann");
        c->dash = gamma == 2 ? ASP_DASH_SOLID : ASP_DASH_LONG;
    } else {
        snprintf(c->colour, sizeof c->colour, "%s", looks[shade % 6].colour);
        c->dash = looks[shade % 6].dash;
    }
    snprintf(c->legend, sizeof c->legend, gamma == 2 ? "gamma = %g (ggx)" : isinf(gamma)
             ? "gamma = inf (beckmann)" : "gamma = %g", gamma);
}

static figure_curve *gamma_curve(drawing *d, figure_panel *panel, size_t count, double gamma,
                                 const char *also, int *shade)
{
    char label[80];
    snprintf(label, sizeof label, "gamma=%g%s", gamma, also);
    figure_curve *c = drawing_curve(d, panel, count, label);
    if (c)
        look(c, gamma, *shade);
    *shade += gamma != 2 && !isinf(gamma);
    return c;
}

static int student(double alpha, double gamma, asp_ndf *out)
{
    char spec[96];
    int n = snprintf(spec, sizeof spec, "student_t:alpha=");
    n += (int)aspi_format_number(alpha, 17, spec + n);
    n += snprintf(spec + n, sizeof spec - (size_t)n, ",gamma=");
    if (isinf(gamma))
        snprintf(spec + n, sizeof spec - (size_t)n, "inf");
    else
        spec[n + (int)aspi_format_number(gamma, 17, spec + n)] = 0;
    return figure_ndf(spec, out);
}

static const double paper_gammas[] = { 1.51, 1.65, 2, 4, 10, 50 };
#define COUNT(list) (sizeof list / sizeof *list)

/* ------------------------------------------------------------------ Figure 3 */

enum { SLOPES = 241 };

static int slopes_and_masking(const figure *f, const figure_job *job)
{
    static const double sigmas[] = { 0.1, 0.3, 0.7 };
    static const double gammas[] = { 1.51, 1.65, 2, 4, 10, 50, INFINITY };
    drawing *d = job->out;
    (void)f;
    d->columns = 3;
    d->width = 430;
    d->height = 360;
    for (int row = 0; row < 2; row++)
        for (size_t k = 0; k < COUNT(sigmas); k++) {
            char title[80];
            int shade = 0;
            snprintf(title, sizeof title, "sigma = %g", sigmas[k]);
            figure_panel *p = row ? drawing_panel(d, title, "theta_{v} [deg]", "G_{1}", "G1")
                                  : drawing_panel(d, title, "slope along x", "P_{22}", "P22");
            p->x.high = row ? 90 : 1.5;
            p->x.step = row ? 15 : 0.5;
            p->y.scale = row ? ASP_SCALE_LINEAR : ASP_SCALE_LOG;
            p->y.low = row ? 0 : 1e-5;
            p->y.high = row ? 1.04 : 100;
            p->legend = !row && k == 2 ? ASP_LEGEND_BOTTOM_LEFT : ASP_LEGEND_NONE;
            for (size_t g = 0; g < COUNT(gammas); g++) {
                asp_ndf ndf;
                int status = student(sigmas[k], gammas[g], &ndf);
                if (status != CMD_OK)
                    return status;
                figure_curve *c = gamma_curve(d, p, SLOPES, gammas[g], "", &shade);
                for (size_t i = 0; c && i < SLOPES; i++) {
                    asp_vec3 v = { 0, 0, 0 };
                    c->x[i] = 1.5 * (double)i / (SLOPES - 1);
                    if (row)
                        figure_angle(i, SLOPES - 1, &c->x[i], &v.z, &v.x);
                    c->y[i] = row ? asp_G1(&ndf, v, ASP_MASK_CORRELATED) : asp_P22(&ndf, c->x[i], 0);
                }
            }
        }
    return CMD_OK;
}

/* ------------------------------------------------------------------ integrals over directions */

/* Nodes of (0, 1) and weights of the double exponential rule: masking leaves 0 at the horizon with
 * any power. */
enum { DIRECTIONS = 400 };

static void direction(int k, double *c, double *weight)
{
    const double reach = 3, h = 2 * reach / (DIRECTIONS - 1), s = -reach + h * k;
    double up = aspi_exp(s), down = aspi_exp(-s), e = aspi_exp(-ASP_PI / 2 * (up - down));
    *c = 1 / (1 + e);
    *weight = h * ASP_PI / 2 * (up + down) * *c * (e / (1 + e));
}

static asp_vec3 seen_from(double c) { return (asp_vec3){ sqrt((1 - c) * (1 + c)), 0, c }; }

/* ------------------------------------------------------------------ Figure 5 */

enum { SIGMAS = 30 };
static double sigma_at(size_t i) { return 0.05 * (double)(i + 1); }

typedef struct masking_error { double absolute, signed_, largest; } masking_error;

/* What the rational functions of eqs. 22-23 do to G1, as printed, in per cent. */
static int rational_error(double sigma, double gamma, masking_error *out)
{
    asp_ndf ndf;
    asp_error err;
    double absolute = 0, sum = 0, all = 0, largest = 0;
    int status = student(sigma, gamma, &ndf);
    for (int k = 0; status == CMD_OK && k < DIRECTIONS; k++) {
        double c, weight, lambda = 0;
        direction(k, &c, &weight);
        asp_vec3 w = seen_from(c);
        double g = asp_G1(&ndf, w, ASP_MASK_CORRELATED);
        if (!(w.x > 0))
            continue;
        if (asp_student_lambda("rational", gamma, c / (sigma * w.x), &lambda, &err) != ASP_OK)
            return cmd_error(&err);
        double error = 1 / (1 + lambda) - g;
        absolute += weight * fabs(error);
        sum += weight * error;
        all += weight * g;
        largest = fmax(largest, fabs(error));
    }
    *out = (masking_error){ 100 * absolute / all, 100 * sum / all, 100 * largest };
    return status;
}

static int approximation(const figure *f, const figure_job *job)
{
    static const double gammas[] = { 1.51, 1.65, 2, 2.25, 4, 10, 40 };
    drawing *d = job->out;
    figure_panel *p[2];
    int shades[2] = { 0, 0 };
    (void)f;
    d->width = 500;
    d->height = 400;
    p[0] = drawing_panel(d, "integral of |dG_{1}| over the hemisphere", "sigma",
                         "of the integral of G_{1} [%]", "integral |dG1| / integral G1");
    p[1] = drawing_panel(d, "largest |dG_{1}|", "sigma", "|dG_{1}| [%]", "max |dG1|");
    for (int i = 0; i < 2; i++) {
        p[i]->x.high = 1.5;
        p[i]->x.step = 0.25;
        p[i]->y.high = 0.8;
        p[i]->legend = ASP_LEGEND_BELOW;
        drawing_rule(p[i], 0.7, 1, "the caption's bound");
    }
    for (size_t g = 0; g < COUNT(gammas); g++) {
        figure_curve *a = gamma_curve(d, p[0], SIGMAS, gammas[g], "", &shades[0]);
        figure_curve *b = gamma_curve(d, p[1], SIGMAS, gammas[g], "", &shades[1]);
        for (size_t i = 0; a && b && i < SIGMAS; i++) {
            masking_error e;
            int status = rational_error(sigma_at(i), gammas[g], &e);
            if (status != CMD_OK)
                return status;
            a->x[i] = b->x[i] = sigma_at(i);
            a->y[i] = e.absolute;
            b->y[i] = e.largest;
        }
        figure_progress(job, (double)(g + 1) / COUNT(gammas));
    }
    return CMD_OK;
}

/* ------------------------------------------------------------------ Figure 9 */

enum { ROUGH = 40 };
static double fine_sigma_at(size_t i) { return 0.025 * (double)(i + 1); }

static int energy(const figure *f, const figure_job *job)
{
    drawing *d = job->out;
    figure_panel *p[2];
    int shades[2] = { 0, 0 };
    (void)f;
    d->width = 500;
    d->height = 420;
    p[0] = drawing_panel(d, "G_{2} = G_{1} G_{1}, as in the paper", "sigma", "energy kept [%]",
                         "separable");
    p[1] = drawing_panel(d, "height-correlated G_{2}", "sigma", "energy kept [%]", "correlated");
    for (int i = 0; i < 2; i++) {
        p[i]->x.high = 1;
        p[i]->x.step = 0.1;
        p[i]->y.high = 100;
        p[i]->y.step = 10;
        p[i]->legend = ASP_LEGEND_BELOW;
    }
    for (size_t g = 0; g < COUNT(paper_gammas); g++) {
        figure_curve *a = gamma_curve(d, p[0], ROUGH, paper_gammas[g], "", &shades[0]);
        figure_curve *b = gamma_curve(d, p[1], ROUGH, paper_gammas[g], "", &shades[1]);
        for (size_t i = 0; a && b && i < ROUGH; i++) {
            asp_ndf ndf;
            int status = student(fine_sigma_at(i), paper_gammas[g], &ndf);
            if (status != CMD_OK)
                return status;
            energy_kept kept = energy_of(&ndf, fine_sigma_at(i));
            a->x[i] = b->x[i] = fine_sigma_at(i);
            a->y[i] = 100 * kept.separable;
            b->y[i] = 100 * kept.correlated;
            figure_progress(job, (double)(g * ROUGH + i + 1) / (COUNT(paper_gammas) * ROUGH));
        }
    }
    return CMD_OK;
}

/* ------------------------------------------------------------------ Figure 10 */

typedef struct difference {
    double d_signed, g_signed, energy;          /* integrals over the hemisphere and Eq. 24 */
    double d_absolute, g_absolute, g_largest;   /* other norms */
} difference;

/* int D dm = 2 pi int P22 r^2 sqrt(1 + r^2) d(log r), and of the difference's size. */
static void compare_densities(const asp_ndf *a, const asp_ndf *b, double sigma, difference *out)
{
    enum { STEPS = 2400 };
    double low = aspi_log(sigma) - 12, h = 20.0 / STEPS, sa = 0, sb = 0, sum = 0;
    for (int k = 0; k <= STEPS; k++) {
        double r = aspi_exp(low + h * k), jacobian = r * r * sqrt(1 + r * r);
        double pa = asp_P22(a, r, 0) * jacobian, pb = asp_P22(b, r, 0) * jacobian;
        sa += pa;
        sb += pb;
        sum += fabs(pa - pb);
    }
    out->d_signed = 100 * (sa / sb - 1);
    out->d_absolute = 100 * sum / sb;
}

static void compare_masking(const asp_ndf *a, const asp_ndf *b, difference *out)
{
    double sa = 0, sb = 0, sum = 0, largest = 0;
    for (int k = 0; k < DIRECTIONS; k++) {
        double c, weight;
        direction(k, &c, &weight);
        double ga = asp_G1(a, seen_from(c), 0), gb = asp_G1(b, seen_from(c), 0);
        sa += weight * ga;
        sb += weight * gb;
        sum += weight * fabs(ga - gb);
        largest = fmax(largest, fabs(ga / gb - 1));
    }
    out->g_signed = 100 * (sa / sb - 1);
    out->g_absolute = 100 * sum / sb;
    out->g_largest = 100 * largest;
}

static int compare(double sigma, double gamma, double energy_of_limit, difference *out)
{
    asp_ndf a, b;
    int status = student(sigma, gamma, &a);
    if (status == CMD_OK)
        status = student(sigma, INFINITY, &b);
    if (status != CMD_OK)
        return status;
    compare_densities(&a, &b, sigma, out);
    compare_masking(&a, &b, out);
    out->energy = 100 * (energy_of(&a, sigma).separable / energy_of_limit - 1);
    return CMD_OK;
}

static figure_curve *norm_curve(drawing *d, figure_panel *p, const char *label, const char *colour,
                                asp_dash dash)
{
    figure_curve *c = drawing_curve(d, p, SIGMAS, label);
    if (c) {
        snprintf(c->legend, sizeof c->legend, "%s", label);
        snprintf(c->colour, sizeof c->colour, "%s", colour);
        c->dash = dash;
    }
    return c;
}

static int beckmann_limit(const figure *f, const figure_job *job)
{
    static const double gammas[] = { 30, 40, 50, 100 };
    static const struct { const char *title, *y, *quantity; double high; } panels[] = {
        { "D: integral over the hemisphere", "above Beckmann's [%]", "integral D, signed", 1 },
        { "G_{1}: integral over the hemisphere", "below Beckmann's [%]", "integral G1, signed", 0.6 },
        { "I_{err}: energy kept by single scattering", "below Beckmann's [%]", "Eq. 24", 2 },
    };
    drawing *d = job->out;
    figure_panel *p[4];
    double limit[SIGMAS];
    int shades[3] = { 0, 0, 0 };
    (void)f;
    d->width = 500;
    d->height = 400;
    for (int i = 0; i < 3; i++)
        p[i] = drawing_panel(d, panels[i].title, "sigma", panels[i].y, panels[i].quantity);
    p[3] = drawing_panel(d, "gamma = 40 in other norms", "sigma", "of Beckmann's [%]", "gamma = 40");
    for (int i = 0; i < 4; i++) {
        p[i]->x.high = 1.5;
        p[i]->x.step = 0.25;
        p[i]->y.high = i < 3 ? panels[i].high : 2.5;
        p[i]->legend = ASP_LEGEND_BELOW;
        drawing_rule(p[i], 1.2, 0, "");
    }
    drawing_rule(p[0], 0.5, 1, "caption, gamma = 40");
    drawing_rule(p[1], 0.3, 1, "caption, gamma = 40");
    figure_curve *d_abs = norm_curve(d, p[3], "integral |dD|", "student_t", ASP_DASH_SOLID);
    figure_curve *g_abs = norm_curve(d, p[3], "integral |dG_{1}|", "student_t", ASP_DASH_LONG);
    figure_curve *g_max = norm_curve(d, p[3], "largest |dG_{1}|/G_{1}", "student_t", ASP_DASH_DOTS);
    for (size_t i = 0; i < SIGMAS; i++) {
        asp_ndf ndf;
        int status = student(sigma_at(i), INFINITY, &ndf);
        if (status != CMD_OK)
            return status;
        limit[i] = energy_of(&ndf, sigma_at(i)).separable;
    }
    for (size_t g = 0; g < COUNT(gammas); g++) {
        figure_curve *c[3];
        for (int k = 0; k < 3; k++)
            c[k] = gamma_curve(d, p[k], SIGMAS, gammas[g], "", &shades[k]);
        for (size_t i = 0; !d->broken && i < SIGMAS; i++) {
            difference e;
            int status = compare(sigma_at(i), gammas[g], limit[i], &e);
            if (status != CMD_OK)
                return status;
            c[0]->x[i] = c[1]->x[i] = c[2]->x[i] = sigma_at(i);
            c[0]->y[i] = e.d_signed;
            c[1]->y[i] = -e.g_signed;
            c[2]->y[i] = -e.energy;
            if (gammas[g] == 40) {
                d_abs->x[i] = g_abs->x[i] = g_max->x[i] = sigma_at(i);
                d_abs->y[i] = e.d_absolute;
                g_abs->y[i] = e.g_absolute;
                g_max->y[i] = e.g_largest;
            }
            figure_progress(job, (double)(g * SIGMAS + i + 1) / (COUNT(gammas) * SIGMAS));
        }
    }
    return CMD_OK;
}

const figure figures_std[] = {
    { "std-3", "Student's t: slopes and masking", "STD paper, Figure 3", "slope_or_theta_v_deg",
      "gamma = 2 is GGX, in its colour; the limit is Beckmann.", 0.1, slopes_and_masking, NULL, NULL },
    { "std-4", "Student's t: what evaluation costs, measured", "STD paper, Figure 4", "gamma_or_sigma",
      "The exact masking of this library takes the same time for every gamma. The forms of the paper are "
      "evaluated one by one (`exact, single` beside them); eqs. 21 lose all digits towards gamma = 40. The "
      "numbers are of one run on one machine, kept in images/figures/std-4.csv.", 2, figures_cost, NULL, NULL },
    { "std-5", "Masking by the paper's rational functions against the exact one",
      "STD paper, Figure 5", "sigma",
      "The caption's bound of 0.7 % holds for the integral over the hemisphere, by a wide margin; point "
      "by point it does not quite.", 1, approximation, NULL, NULL },
    { "std-9", "Energy kept by single scattering, perfect mirror facets", "STD paper, Figure 9",
      "sigma", "(1/pi) times the double integral of f cos cos: eq. 24 with the factors that are missing in "
      "print.", 1.5, energy, NULL, NULL },
    { "std-10", "Student's t against its limit, Beckmann", "STD paper, Figure 10", "sigma",
      "The caption's bounds for gamma = 40, 0.5 % and 0.3 % below sigma = 1.2, are those of the integral over "
      "the hemisphere with signs kept, and hold up to sigma = 1. Other norms are larger.", 1.5,
      beckmann_limit, NULL, NULL },
    { .name = NULL }
};
