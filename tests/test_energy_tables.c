/* test_energy_tables.c - energy given back on skewed and stretched surfaces, at the corners of the tables
 *
 * Without absorption the albedo is 1 - T + E, with E that of single scattering and 1 - T what the table gives
 * back: single scattering is added up over its own samples and the rest, which is smooth, over a lattice. */
#include "scatter_test.h"

#define COUNT(a) (sizeof (a) / sizeof *(a))

/* Mean weight of the samples of n points of a lattice, bent so that the integrand is periodic. */
static double single(const asp_material *mat, asp_vec3 wi, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++) {
        double a = (i + 0.5) / n, b = fmod(0.6180339887498949 * i, 1), c = fmod(0.3 + 0.7548776662466927 * i, 1);
        double by = 36 * a * (1 - a) * b * (1 - b);
        sum += by * asp_sample_lobe(mat, wi, a * a * (3 - 2 * a), b * b * (3 - 2 * b), c).weight.g;
    }
    return sum / n;
}

/* What `whole` scatters beyond `part`, by the cosine lobes of `sides` sides. */
static double rest(const asp_material *whole, const asp_material *part, asp_vec3 wi, int sides, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++) {
        double u = (i + 0.5) / n, s = sqrt(u), c = sqrt(1 - u), phi = 2 * PI * fmod(0.6180339887498949 * i, 1);
        for (int k = 0; k < sides; k++) {
            asp_vec3 wo = { s * cos(phi), s * sin(phi), k ? -c : c };
            sum += PI * (asp_eval(whole, wi, wo).g - asp_eval(part, wi, wo).g);
        }
    }
    return sum / n;
}

typedef struct row { const char *ndf; double more, less, mean; } row;

/* Largest gain and loss of light over the directions, each over what the row allows, and the mean of both. */
static void check(const char *model, const char *part_model, int sides, const row *rows, size_t count, int azimuths,
                  int points)
{
    static const double thetas[] = { 0.3, 0.9, 1.25, 1.4, 1.49, 1.54 };
    for (size_t r = 0; r < count; r++) {
        char spec[300];
        asp_material whole, part;
        double more = 0, less = 0, mean = 0, worst;
        int n = 0;
        snprintf(spec, sizeof spec, "%s,ndf=(%s)", model, rows[r].ndf);
        whole = material(spec);
        if (part_model) {
            snprintf(spec, sizeof spec, "%s,ndf=(%s)", part_model, rows[r].ndf);
            part = material(spec);
            part.mask = whole.mask;
        } else {
            part = asp_mirror(&whole.ndf, whole.mask);
        }
        for (size_t t = 0; t < COUNT(thetas); t++)
            for (int j = 0; j < azimuths; j++)
                for (int side = 0; side < sides; side++) {
                    asp_vec3 wi = direction(thetas[t], 1.67 + 2 * PI * j / azimuths);
                    double off;
                    wi.z = side ? -wi.z : wi.z;
                    off = single(&part, wi, points) + rest(&whole, &part, wi, sides, points / 2) - 1;
                    more = fmax(more, off);
                    less = fmax(less, -off);
                    mean += fabs(off);
                    n++;
                }
        mean /= n;
        printf("  %s %s: +%.4f -%.4f, mean %.4f\n", model, rows[r].ndf, more, less, mean);
        worst = fmax(fmax(more / rows[r].more, less / rows[r].less), mean / rows[r].mean);
        snprintf(spec, sizeof spec, "%.40s, %.60s: of what is allowed", model, rows[r].ndf);
        expect(worst < 1, spec, worst);
    }
}

/* Single scattering over E, in the range that docs/materials.md states. */
static void check_turquin(void)
{
    static const char *const specs[] = {
        "compensated:form=turquin,f0=1,ndf=(ggx:alpha=0.05)", "compensated:form=turquin,f0=1,ndf=(ggx:alpha=2)",
        "compensated:form=turquin,f0=1,ndf=(beckmann:alpha_x=0.3,alpha_y=0.9,rotation=0.4)",
        "compensated:form=turquin,f0=1,ndf=(ggx:alpha_x=0.05,alpha_y=1)",
        "compensated_dielectric:form=turquin,transport=importance,ndf=(ggx:alpha=1)"
    };
    double worst = 0;
    for (size_t i = 0; i < COUNT(specs); i++) {
        asp_material mat = material(specs[i]);
        double off = 0;
        for (int t = 0; t < 6; t++)
            for (int j = 0; j < 12; j++)
                off = fmax(off, fabs(single(&mat, direction(0.02 + 0.3 * t, 0.5 * j), 6000) - 1));
        printf("  %s: off by %.4f\n", specs[i], off);
        worst = fmax(worst, off);
    }
    expect(worst < 0.015, "Turquin's form returns all light in its range", worst);
}

int main(void)
{
    static const row mirrors[] = {
        { "ggx:alpha=0.05,mean_x=1", 0.015, 0.03, 0.003 }, { "ggx:alpha=0.01,mean_x=1", 0.05, 0.05, 0.005 },
        { "beckmann:alpha=0.05,mean_x=0.3", 0.03, 0.03, 0.003 }, { "beckmann:alpha_x=0.3,alpha_y=1.9", 0.01, 0.01, 0.003 },
        { "ggx:alpha_x=0.02,alpha_y=0.6", 0.01, 0.01, 0.003 }, { "ggx:alpha=0.5,mean_x=0.3,mean_y=0.2", 0.01, 0.01, 0.003 },
        { "ggx:alpha_x=0.1,alpha_y=0.4,mean_y=0.5", 0.01, 0.015, 0.003 },
        { "ggx:alpha_x=0.05,alpha_y=1,rotation=0.4", 0.01, 0.01, 0.003 },
        { "beckmann:alpha=0.3,mean_x=0.7,mean_y=0.2", 0.015, 0.03, 0.003 }
    };
    static const row glass[] = {
        { "beckmann:alpha=0.3,mean_x=0.3", 0.03, 0.03, 0.004 }, { "ggx:alpha_x=0.1,alpha_y=0.6", 0.03, 0.03, 0.004 },
        { "ggx:alpha=0.05,mean_x=1", 0.3, 0.3, 0.02 }, { "ggx:alpha_x=0.2,alpha_y=0.4,mean_x=0.2", 0.03, 0.03, 0.004 }
    };
    check("compensated:f0=1", NULL, 1, mirrors, COUNT(mirrors), 24, 2000);
    check("compensated_dielectric:transport=importance", "dielectric:transport=importance", 2, glass, COUNT(glass), 8, 4000);
    check_turquin();
    return finish();
}
