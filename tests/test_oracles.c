/* test_oracles.c - rejection oracles against the densities and against every distribution's own sampler
 *
 * Every distribution of the table, through upright, turned and skewed maps, seen from the normal down to
 * below the mean plane: chi-square of each sampler against pdf_visible's formula, and of the oracle and
 * asp_sample_visible against one another. ASPERITY_SAMPLES sets the samples per case. */
#include "asperity_ndf.h"
#include "asperity_study.h"
#include "visible_test.h"

#define PILOT 4000

static const char *const maps[] = {
    "alpha=0.3", "alpha_x=0.6,alpha_y=0.15,rotation=0.7", "alpha_x=0.4,alpha_y=0.25,rho=0.5,mean_x=0.3,mean_y=-0.4"
};

/* Angles from the normal, in degrees, and azimuths. */
static const double views[][2] = { { 0, 0 }, { 40, 1 }, { 80, -2 }, { 89.9, 2.5 }, { 97, 0.4 }, { 112, -2.2 } };
#define VIEWS (sizeof views / sizeof *views)

static asp_oracle oracle, other;
static double tallies[3][CELLS];

static void one_view(const asp_ndf *ndf, const char *spec, size_t v, int students, int radial, size_t samples)
{
    static double radii[PILOT];
    static const char *const names[3] = { "asp_sample_visible", "Student oracle", "radial oracle" };
    double t = views[v][0] * pi_ / 180;
    asp_vec3 w = { sin(t) * cos(views[v][1]), sin(t) * sin(views[v][1]), cos(t) };
    char what[400];
    cells k;
    size_t i;
    int s;
    if (!(asp_sigma(ndf, w) > 1e-7))      /* too deep: all trials are rejected, all normals equal */
        return;
    memset(&k, 0, sizeof k);
    k.ndf = ndf;
    for (i = 0; i < PILOT; i++) {
        double phi;
        slope_of(&k, asp_sample_visible(ndf, w, uniform(NULL), uniform(NULL)), &radii[i], &phi);
    }
    cells_make(&k, ndf, w, radii, PILOT);
    memset(tallies, 0, sizeof tallies);
    for (s = 0; s < 3; s++) {
        int behind = 0;
        if ((s == 1 && !students) || (s == 2 && !radial))
            continue;
        for (i = 0; i < samples; i++) {
            asp_vec3 m = s == 0 ? asp_sample_visible(ndf, w, uniform(NULL), uniform(NULL))
                                : asp_oracle_visible(s == 1 ? &oracle : &other, w, uniform, NULL);
            double c = w.x * m.x + w.y * m.y + w.z * m.z;
            behind += !(c > -1e-14) || !(fabs(m.x * m.x + m.y * m.y + m.z * m.z - 1) < 1e-12);
            cells_count(&k, m, tallies[s]);
        }
        snprintf(what, sizeof what, "%s, view %g degrees: %s: nothing faces away", spec, views[v][0], names[s]);
        say(behind == 0, what);
        snprintf(what, sizeof what, "%s, view %g degrees: %s", spec, views[v][0], names[s]);
        note_p(chi_share(&k, tallies[s], (double)samples), what);
        if (s == 0)
            continue;
        snprintf(what, sizeof what, "%s, view %g degrees: asp_sample_visible and %s", spec, views[v][0], names[s]);
        note_p(chi_two(tallies[0], tallies[s]), what);
    }
}

static void one_spec(const char *spec, size_t samples)
{
    asp_ndf ndf;
    asp_error err;
    size_t v, before = p_count;
    int students, radial;
    if (asp_ndf_parse(NULL, spec, &ndf, &err) != ASP_OK) {
        printf("%s: %s: %s\n", spec, err.name, err.reason);
        say(0, spec);
        return;
    }
    students = asp_oracle_make(&ndf, ASP_ORACLE_STUDENT, &oracle, NULL) == ASP_OK;
    radial = asp_oracle_make(&ndf, ASP_ORACLE_RADIAL, &other, &err) == ASP_OK;
    if (!radial)
        printf("     %s: no radial oracle: %s\n", spec, err.reason);
    if (!students && !radial)
        return;
    for (v = 0; v < VIEWS; v++)
        one_view(&ndf, spec, v, students, radial, samples);
    printf("%-70s %s%s %zu tests\n", spec, students ? "student " : "", radial ? "radial" : "", p_count - before);
}

/* Every model as it is, then parameters from their ranges. */
static void every_model(size_t samples)
{
    const asp_model *const *m;
    for (m = asp_models(); *m; m++) {
        size_t i;
        for (i = 0; i < 3; i++) {
            char spec[300];
            asp_ndf probe;
            snprintf(spec, sizeof spec, "%s:%s", (*m)->name,
                     (*m)->keys == ASP_KEYS_ELLIPSOID
                         ? (i == 0 ? "alpha=0.3" : i == 1 ? "alpha_x=0.6,alpha_y=0.2,theta_x=0.4,theta_z=1"
                                                          : "alpha_x=0.2,alpha_y=0.4,theta_x=-0.3,theta_y=0.5")
                         : maps[i]);
            if ((*m)->own_scale && i == 0)
                snprintf(spec, sizeof spec, "%s", (*m)->name);
            if (asp_ndf_parse(NULL, spec, &probe, NULL) != ASP_OK && (*m)->own_scale)
                snprintf(spec, sizeof spec, "%s:alpha_x=2,alpha_y=0.5,mean_x=0.3", (*m)->name);
            if (asp_ndf_parse(NULL, spec, &probe, NULL) != ASP_OK) {
                printf("     %s: needs data, left out\n", spec);
                break;
            }
            one_spec(spec, samples);
        }
    }
}

/* A test that accepts anything would pass: samples of a neighbouring view must fail. */
static void check_power(void)
{
    asp_ndf ndf;
    asp_vec3 w = { sin(1.2), 0, cos(1.2) }, near = { sin(1.16), 0, cos(1.16) };
    static double radii[PILOT];
    double tally[CELLS] = { 0 };
    cells k;
    size_t i;
    asp_ndf_parse(NULL, "student_t:alpha=0.5,gamma=3", &ndf, NULL);
    asp_oracle_make(&ndf, ASP_ORACLE_STUDENT, &oracle, NULL);
    memset(&k, 0, sizeof k);
    k.ndf = &ndf;
    for (i = 0; i < PILOT; i++) {
        double phi;
        slope_of(&k, asp_sample_visible(&ndf, w, uniform(NULL), uniform(NULL)), &radii[i], &phi);
    }
    cells_make(&k, &ndf, w, radii, PILOT);
    for (i = 0; i < 40000; i++)
        cells_count(&k, asp_oracle_visible(&oracle, near, uniform, NULL), tally);
    say(chi_share(&k, tally, 40000) < 1e-7, "a view two degrees off is noticed");
}

static void check_refusals(void)
{
    asp_ndf ndf;
    asp_error err;
    asp_vec3 down = { 0, 0, -1 }, m;
    asp_ndf_parse(NULL, "student_t:gamma=1.51", &ndf, NULL);
    say(asp_oracle_make(&ndf, ASP_ORACLE_RADIAL, &oracle, &err) == ASP_EINVAL, "tails too heavy for a table");
    say(asp_oracle_make(&ndf, ASP_ORACLE_STUDENT, &oracle, &err) == ASP_OK, "not for the closed form");
    m = asp_oracle_visible(&oracle, down, uniform, NULL);
    say(m.x == 0 && m.y == 0 && m.z == 0, "nothing is seen from straight below");
}

int main(void)
{
    static const char *const more[] = {
        "student_t:alpha=0.4,gamma=1.51", "student_t:alpha_x=0.4,alpha_y=0.1,mean_y=0.5,gamma=1.7",
        "student_t:alpha=0.4,gamma=inf", "student_t:alpha=0.2,mean_x=-0.3,gamma=60", "phong:exponent=0",
        "phong:exponent=-0.9,alpha_x=0.5,alpha_y=1", "phong:exponent=300,mean_x=0.2", "beckmann:alpha=1.5,mean_y=1",
        "hyper_cauchy:alpha=0.6,gamma=3.5", "student_t_general:B=4,C=1.8"
    };
    size_t samples = sample_count(20000), i;
    char line[100];
    for (i = 0; i < sizeof more / sizeof *more; i++)
        one_spec(more[i], samples);
    every_model(samples);
    check_power();
    check_refusals();
    snprintf(line, sizeof line, "the %zu p-values are uniform: KS p = %.3g", p_count, p_of_all());
    printf("%s\n", line);
    say(p_of_all() > 1e-4, line);
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
