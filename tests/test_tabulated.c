/* test_tabulated.c - a density of slopes given by samples: what is between and beyond them, masking against
 * quadrature, samplers by the laws, specs and refusals */
#include "asperity_data.h"
#include "asperity_ndf.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int passed, failed;

static void report(const char *what, double worst, double bound)
{
    int ok = worst <= bound;
    printf("%-4s %-60s %.3g, bound %g\n", ok ? "ok" : "FAIL", what, worst, bound);
    passed += ok;
    failed += !ok;
}

enum { MOST = 29 };

typedef struct samples { double slope[MOST], density[MOST]; asp_slope_samples s; } samples;

static asp_ndf make(samples *from)
{
    asp_ndf out;
    asp_error err;
    char text[300];
    from->s.slope = from->slope;
    from->s.density = from->density;
    if (asp_tabulated_make(&from->s, NULL, &out, &err) != ASP_OK) {
        printf("FAIL made: %s\n", asp_error_text(&err, text, sizeof text));
        exit(1);
    }
    return out;
}

/* Samples of a distribution, nearer to each other in the middle. */
static void take(samples *to, const char *spec, double furthest, double tail)
{
    asp_ndf ndf;
    asp_ndf_parse(NULL, spec, &ndf, NULL);
    memset(to, 0, sizeof *to);
    for (int i = 0; i < MOST; i++) {
        double u = (double)i / (MOST - 1);
        to->slope[i] = furthest * u * (0.3 + 0.7 * u);
        to->density[i] = 7 * asp_P22(&ndf, to->slope[i], 0);
    }
    to->s.count = MOST;
    to->s.tail = tail;
}

/* ------------------------------------------------------------------ integrals that know of the samples */

/* Gauss's rule of 4 nodes on 40 pieces of each stretch between two samples, in the logarithm beyond them. */
static double over_stretch(const asp_ndf *k, double low, double high, int logarithmic, double power,
                           double mu)
{
    static const double node[4] = { 0.0694318442029737, 0.330009478207572, 0.669990521792428, 0.930568155797026 };
    static const double weight[4] = { 0.173927422568727, 0.326072577431273, 0.326072577431273,
                                      0.173927422568727 };
    double sum = 0;
    for (int i = 0; i < 40; i++)
        for (int n = 0; n < 4; n++) {
            double u = (i + node[n]) / 40, r, dr;
            r = logarithmic ? low * pow(high / low, u) : low + (high - low) * u;
            dr = (logarithmic ? r * log(high / low) : high - low) * weight[n] / 40;
            if (mu < 0) {
                sum += asp_P22(k, r, 0) * pow(r, power) * dr;
                continue;
            }
            /* E[max(0, x - mu)] of a ring of radius r */
            if (r > mu)
                sum += 2 * asp_P22(k, r, 0) * r * (sqrt(r * r - mu * mu) - mu * acos(mu / r)) * dr;
        }
    return sum;
}

static double over_all(const asp_ndf *k, const samples *s, double power, double mu)
{
    double sum = 0, low = 0;
    for (size_t i = 0; i < s->s.count; i++) {
        if (s->slope[i] > 0 && mu > low && mu < s->slope[i])       /* a root stands at mu */
            sum += over_stretch(k, mu, mu + 0.1 * (s->slope[i] - mu), 0, power, mu)
                 + over_stretch(k, mu + 0.1 * (s->slope[i] - mu), s->slope[i], 0, power, mu);
        else if (s->slope[i] > 0)
            sum += over_stretch(k, low, s->slope[i], 0, power, mu);
        low = s->slope[i];
    }
    for (int i = 0; i < 12; i++) {
        double from = fmax(low, mu > low ? mu : 0) * pow(4, i);
        sum += over_stretch(k, from, 4 * from, 1, power, mu);
    }
    return sum;
}

static void masking(samples *s, const char *name, double bound_above, double bound_below)
{
    asp_ndf k = make(s);
    asp_ndff f = asp_ndf_narrow(&k);
    double mass = 2 * 3.14159265358979323846 * over_all(&k, s, 1, -1), above = 0, below = 0, single = 0, at = 0;
    char text[100];
    for (size_t i = 1; i < s->s.count; i++)
        at = fmax(at, fabs(asp_P22(&k, s->slope[i], 0) / asp_P22(&k, s->slope[0], 0)
                           * s->density[0] / s->density[i] - 1));
    for (int i = 1; i < 90; i++) {
        double theta = i * 1.57079632679489662 / 90, mu = cos(theta) / sin(theta);
        asp_vec3 w = { sin(theta), 0, cos(theta) }, down = { -w.x, 0, -w.z };
        asp_vec3f wf = { (float)w.x, 0, (float)w.z };
        asp_vec3 wide = { wf.x, 0, wf.z };
        double hidden = sin(theta) * over_all(&k, s, 1, mu);
        above = fmax(above, fabs(asp_sigma(&k, w) / (w.z + hidden) - 1));
        if (hidden > 1e-6)
            below = fmax(below, fabs(asp_sigma(&k, down) / hidden - 1));
        single = fmax(single, fabs(asp_sigmaf(&f, wf) / asp_sigma(&k, wide) - 1));
    }
    snprintf(text, sizeof text, "%s: P22 at the samples", name);
    report(text, at, 1e-12);
    snprintf(text, sizeof text, "%s: P22 integrates to 1", name);
    report(text, fabs(mass - 1), 1e-9);
    snprintf(text, sizeof text, "%s: sigma above the horizon, by quadrature", name);
    report(text, above, bound_above);
    snprintf(text, sizeof text, "%s: sigma below the horizon", name);
    report(text, below, bound_below);
    snprintf(text, sizeof text, "%s: sigma in float32", name);
    report(text, single, 2e-6);
}

/* Chi-square that 10^7 visible normals seen edge-on give beyond that of their number, in 99 rings: the share of
 * what is seen that lies beyond the radius drawn against the uniform number it was drawn from. */
static void edge_on(samples *s, const char *name, double bound)
{
    asp_ndf k = make(s);
    asp_vec3 view = { 1, 0, 0 };
    double all = 0, chi = 0, last_share = 1, last_u = 1;
    char text[100];
    for (int i = 0; i <= 100; i++) {
        double e = 0.02 * i, u = exp(-e * e * e * e * e), share = 0, low, r = 0;
        if (i > 0) {
            asp_vec3 m = asp_sample_visible(&k, view, u, 0.5);
            r = hypot(m.x, m.y) / m.z;
        }
        if (u < 1e-6)
            break;
        low = r;
        for (size_t j = 0; j < s->s.count; j++)
            if (s->slope[j] > low) {
                share += over_stretch(&k, low, s->slope[j], 0, 2, -1);
                low = s->slope[j];
            }
        for (int j = 0; j < 24; j++)
            share += over_stretch(&k, low * pow(4, j), low * pow(4, j + 1), 1, 2, -1);
        if (i == 0)
            all = share;
        share /= all;
        if (i > 0)
            chi += 1e7 * pow(last_share - share - (last_u - u), 2) / fmax(last_share - share, last_u - u);
        last_share = share;
        last_u = u;
    }
    snprintf(text, sizeof text, "%s: visible normals edge-on, chi-square of 10^7", name);
    report(text, chi, bound);
}

/* ------------------------------------------------------------------ shapes */

static void monotone(void)
{
    samples s = { { 0, 0.1, 0.2, 0.25, 0.4, 0.6, 0.8 }, { 10, 10, 9.9, 4, 3.9, 3.9, 1.5 }, { 7, NULL, NULL, 3 } };
    asp_ndf k = make(&s);
    double rise = 0, last = asp_P22(&k, 0, 0), tail;
    for (int i = 1; i <= 20000; i++) {
        double p = asp_P22(&k, 1e-4 * i, 0);
        rise = fmax(rise, p / last - 1);
        last = p;
    }
    report("samples that fall and stand: P22 never rises", rise, 1e-13);
    tail = log(asp_P22(&k, 100, 0) / asp_P22(&k, 1000, 0)) / log((1e6 + 0.01) / (1e4 + 0.01));
    report("the tail is that asked for", fabs(tail - 3), 1e-9);
    masking(&s, "steps", 2.5e-3, 1e-2);
}

static void few(void)
{
    samples s = { { 0, 0.1, 0.3 }, { 5, 4, 1 }, { 3, NULL, NULL, 0 } };
    edge_on(&s, "three samples", 15);
}

static void powers(void)
{
    /* GGX through its own samples of two points: a straight line if s is alpha */
    samples s = { { 0, 0.2, 0.3 }, { 1, 0.25, 1 / 10.5625 }, { 3, NULL, NULL, 0 } };
    asp_ndf k = make(&s), g;
    double worst = 0;
    asp_ndf_parse(NULL, "ggx:alpha=0.2", &g, NULL);
    for (int i = 0; i < 2000; i++)
        worst = fmax(worst, fabs(asp_P22(&k, 0.01 * i, 0) / asp_P22(&g, 0.01 * i, 0) - 1));
    report("GGX of three samples is GGX", worst, 1e-12);
}

/* ------------------------------------------------------------------ laws */

static void note(void *context, const asp_law_result *r)
{
    (void)context;
    if (!r->passed)
        printf("     %s: %.3g, allowed %.3g: %s\n", r->law->name, r->worst, r->allowed, r->where);
}

static void laws(const char *spec)
{
    static const char *const names[] = { "normalisation", "slope_density", "slope_map", "rotation", "matrix",
        "reciprocity", "weight", "sample_normal", "sample_visible", "sample_bsdf", "weight_histogram",
        "continuity", "batch", "finite", "nan" };
    asp_ndf ndf;
    size_t all = 0;
    char text[120];
    if (asp_ndf_parse(NULL, spec, &ndf, NULL))
        all = 99;
    for (size_t i = 0; i < sizeof names / sizeof *names && all != 99; i++) {
        asp_laws_options o = asp_laws_options_default();
        size_t broken = 1;
        o.samples = 20000;
        o.only = names[i];
        asp_laws_check(&ndf, &o, note, NULL, &broken, NULL);
        all += broken;
    }
    snprintf(text, sizeof text, "laws broken: %.100s", spec);
    report(text, (double)all, 0);
}

/* ------------------------------------------------------------------ refusals */

static const struct { const char *spec; asp_status status; const char *at, *name; } bad[] = {
    { "tabulated:slopes=0/0.1,density=5", ASP_EINVAL, NULL, "density" },
    { "tabulated:slopes=0/x,density=5/4", ASP_EPARSE, "x,", "slopes" },
    { "tabulated:slopes=0/0.1/,density=5/4", ASP_EPARSE, ",density", "slopes" },
    { "tabulated:slopes=0/0.2/0.1,density=5/4/3", ASP_EINVAL, "0.1", "slopes" },
    { "tabulated:slopes=-1/0.2,density=5/4", ASP_EINVAL, "-1", "slopes" },
    { "tabulated:slopes=0/2000,density=5/4", ASP_EINVAL, "2000", "slopes" },
    { "tabulated:slopes=0/nan,density=5/4", ASP_EINVAL, "nan", "slopes" },
    { "tabulated:slopes=0/1,density=5/0", ASP_EINVAL, "0", "density" },
    { "tabulated:slopes=0/1,density=-5/1", ASP_EINVAL, "-5", "density" },
    { "tabulated:slopes=0/1,density=5/0.9", ASP_EINVAL, "0.9", "density" },
    { "tabulated:slopes=0,density=5", ASP_EINVAL, NULL, "slopes" },
    { "tabulated:slopes=0/1,density=5/1,tail=1.5", ASP_EINVAL, "1.5", "tail" },
    { "tabulated:slopes=0/1,density=5/1,alpha=0", ASP_EINVAL, NULL, "alpha" },
    { "tabulated:slopes=0/1,density=5/1,gamma=2", ASP_EUNKNOWN, "gamma", "gamma" },
    { "tabulated:alpha=0.3", ASP_EINVAL, NULL, "slopes" },
};

static void refusals(void)
{
    asp_ndf ndf;
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        asp_error err = { 0 };
        asp_status s = asp_ndf_parse(NULL, bad[i].spec, &ndf, &err);
        int there = !bad[i].at || (err.position >= 0 && err.position < (long long)strlen(bad[i].spec)
                    && !strncmp(bad[i].spec + err.position, bad[i].at, strlen(bad[i].at)));
        char text[120];
        snprintf(text, sizeof text, "refused: %.100s", bad[i].spec);
        report(text, s == bad[i].status && !strcmp(err.name, bad[i].name) && there ? 0 : 1, 0);
    }
}

int main(void)
{
    samples s;
    take(&s, "beckmann:alpha=0.2", 0.55, 0);
    masking(&s, "Beckmann's", 1e-4, 1e-2);
    take(&s, "student_t:alpha=0.1,gamma=3", 2, 0);
    masking(&s, "Student's", 2e-6, 1e-4);
    edge_on(&s, "Student's", 15);
    take(&s, "ggx:alpha=0.01", 0.2, 2.5);
    edge_on(&s, "GGX's, far apart", 15);
    few();
    monotone();
    powers();
    laws("tabulated:slopes=0/0.1/0.3,density=5/4/1");
    laws("tabulated:slopes=0/0.1/0.2/0.3/0.4/0.5,density=5/4.5/3/1.5/0.5/0.15,alpha_x=0.5,alpha_y=1.2,mean_x=0.2");
    refusals();
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
