/* law_adjoint.c - light that crosses a boundary: the way back, and importance against radiance
 *
 * With indices n_i, n_o of the sides of wi, wo radiance has f(wo, wi) n_i^2 = f(wi, wo) n_o^2, and importance from wi
 * to wo is radiance from wo to wi (Veach 1997, sec. 5.2). On one side f is the same both ways. */
#include "laws/laws.h"

#include <math.h>

double aspi_total_steps(double c, double n)
{
    double g = sqrt(fabs((n - 1) * (n + 1) + c * c));
    return n < 1 ? 4 * c / (n * n * fmax(g, 1e-8)) : 0;
}

double aspi_facet_steps(const aspi_trial *t, asp_vec3 wi, asp_vec3 wo, double n)
{
    double k = wi.z * wo.z > 0 ? 1 : n, dot = aspi_dot(wi, wo), more;
    double apart = hypot(hypot(wi.x + k * wo.x, wi.y + k * wo.y), wi.z + k * wo.z);
    /* cosines of both to the facet */
    double ci = fabs(1 + k * dot) / apart, co = fabs(k + dot) / apart;
    double least = fmax(fmin(ci, co), 1e-12), square = 1 / (least * least);
    /* 1 - F is in proportion to g = n co, and g^2 = n^2 - 1 + ci^2 is known to a step of ci */
    more = wi.z * wo.z > 0 ? square + aspi_total_steps(ci, n) : square / fmin(n * n, 1);
    return aspi_refracted_steps(t, wi, wo, n, more);
}

static void compare(aspi_trial *t, const char *name, double found, double expected, double allowed, asp_vec3 wi,
                    asp_vec3 wo, const char *what)
{
    aspi_find(t, fabs(found - expected) / fmax(fmax(found, expected), 1e-200), allowed,
              "%s, wi (%.6g, %.6g, %.6g), wo (%.6g, %.6g, %.6g), %s: %.15g, %.15g", name, wi.x, wi.y, wi.z,
              wo.x, wo.y, wo.z, what, found, expected);
}

void aspi_law_adjoint(aspi_trial *t)
{
    for (int kind = aspi_first(t, ASPI_ONE_SIDED); kind < aspi_end(t, ASPI_ALL_MATERIALS); kind++) {
        const char *name;
        const asp_material *made = aspi_material(t, kind, &name);
        aspi_traits is = aspi_traits_of(made);
        double eta = is.eta;
        asp_material radiance = *made, imp = aspi_importance(made), *rad = &radiance;
        radiance.transport = ASP_RADIANCE;
        for (int i = 0; i < 300 && is.crosses && is.reciprocal; i++) {
            asp_vec3 wi = aspi_random_direction(t), wo = aspi_random_direction(t);
            double n, side, steps, there, back;
            if (i % 3) /* a pair that shines */
                wo = asp_sample_lobe(rad, wi, aspi_uniform(t), aspi_uniform(t), aspi_uniform(t)).wo;
            n = wi.z < 0 ? 1 / eta : eta;
            side = wi.z * wo.z < 0 ? n : 1;
            steps = 1e-12 + aspi_facet_steps(t, wi, wo, n) + aspi_facet_steps(t, wo, wi, wi.z * wo.z < 0 ? 1 / n : n);
            if (!(steps < 1e-3) || wi.z == 0 || wo.z == 0)
                continue;
            there = aspi_average(asp_eval(rad, wi, wo));
            back = aspi_average(asp_eval(rad, wo, wi));
            if (fmax(there, back) < 1e-200)
                continue;
            compare(t, name, back, there * side * side, steps, wi, wo, "f(wo, wi) and f(wi, wo) n_o^2/n_i^2");
            compare(t, name, aspi_average(asp_eval(&imp, wi, wo)), back, steps, wi, wo, "importance and radiance back");
        }
    }
}
