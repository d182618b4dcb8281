/* law_limits.c - what a surface becomes at the ends: no index, no roughness, no tail */
#include "laws/laws.h"

#include <math.h>
#include <string.h>

static double apart(asp_vec3 a, asp_vec3 b) { return hypot(hypot(a.x - b.x, a.y - b.y), a.z - b.z); }

/* A boundary of index 1 + e bends a ray by e tan at the facet, and reflects e^2/4 or so. */
static void no_index(aspi_trial *t)
{
    static const double e = 1e-6;
    asp_material thin_air = asp_dielectric(t->ndf, 1 + e, 0, ASP_IMPORTANCE, 0);
    for (size_t i = 0; i < t->view_count; i++)
        for (int k = 0; k < 20; k++) {
            asp_vec3 w = t->views[i].w, back = { -w.x, -w.y, -w.z };
            double u1 = aspi_uniform(t), u2 = aspi_uniform(t), c;
            asp_bsdf_sample s = asp_sample_lobe(&thin_air, w, u1, u2, 0.5);
            c = aspi_dot(w, asp_sample_visible(t->ndf, w, u1, u2));
            if (c < 0.01) /* all but along the facet */
                continue;
            aspi_find(t, apart(s.wo, back) * c, 2 * e, "index 1 + 1e-6, %s: a ray is bent by %.3g, cosine %.3g",
                      t->views[i].name, apart(s.wo, back), c);
            aspi_find(t, asp_fresnel_dielectric(c, 1 + e) * c * c * c * c, e * e, "index 1 + 1e-6: reflected");
        }
}

/* The same surface with slopes 1e-6 times as large, and level. */
static asp_ndf flattened(const asp_ndf *ndf)
{
    static const double by = 1e-6;
    asp_ndf out = *ndf;
    out.map.m00 *= by, out.map.m01 *= by, out.map.m10 *= by, out.map.m11 *= by;
    out.map.tx = out.map.ty = 0;
    out.i00 /= by, out.i01 /= by, out.i10 /= by, out.i11 /= by;
    out.inv_det /= by * by;
    return out;
}

/* Samples leave as from a smooth boundary, but for the tilt of their facet, and in Fresnel's shares. */
static void no_roughness(aspi_trial *t)
{
    asp_ndf flat = flattened(t->ndf);
    for (int inside = 0; inside < 2; inside++) {
        double eta = inside ? 1 / 1.5 : 1.5;
        asp_material glass = asp_dielectric(&flat, 1.5, 0, ASP_IMPORTANCE, 0);
        for (int k = 0; k < 200; k++) {
            asp_vec3 w = aspi_direction(0.1 + 1.2 * aspi_uniform(t), 6 * aspi_uniform(t)), wi = w, m, wo, is;
            double u1 = aspi_uniform(t), u2 = aspi_uniform(t), u3 = aspi_uniform(t), F, tilt, g2, by;
            asp_bsdf_sample s;
            m = asp_sample_visible(&flat, w, u1, u2);
            tilt = hypot(m.x, m.y);
            g2 = 1 - (1 - w.z * w.z) / (eta * eta);
            if (tilt > 1e-4 || fabs(g2) < 0.02) /* a tail, or next to total reflection */
                continue;
            if (inside)
                wi.x = -w.x, wi.y = -w.y, wi.z = -w.z;
            F = asp_fresnel_dielectric(w.z, eta);
            if (fabs(u3 - F) < 100 * tilt + 1e-9)
                continue;
            s = asp_sample_lobe(&glass, wi, u1, u2, u3);
            by = u3 < F ? -1 : -1 / eta;
            wo.x = by * w.x;
            wo.y = by * w.y;
            wo.z = u3 < F ? w.z : -sqrt(g2);
            is = s.wo;
            if (inside)
                is.x = -is.x, is.y = -is.y, is.z = -is.z;
            aspi_find(t, apart(is, wo), 40 * tilt + 1e-13, "no roughness, %s: wo (%.9g, %.9g, %.9g), smooth (%.9g, %.9g, %.9g)",
                      inside ? "inside" : "outside", is.x, is.y, is.z, wo.x, wo.y, wo.z);
        }
    }
}

/* A shape number whose range has no end is at 1e9 what it is at infinity. Student's t is Beckmann there. */
static void no_tail(aspi_trial *t)
{
    const asp_model *model = t->ndf->model, *beckmann = asp_find_model(NULL, "beckmann");
    for (size_t p = 0; p < model->param_count; p++) {
        double shape[ASP_SHAPE_NUMBERS];
        asp_ndf far, end;
        if (!isinf(model->params[p].high))
            continue;
        memcpy(shape, t->ndf->shape, sizeof shape);
        shape[p] = 1e9;
        if (asp_ndf_make(model, &t->ndf->map, shape, &far, NULL) != ASP_OK)
            continue;
        shape[p] = INFINITY;
        if (asp_ndf_make(model, &t->ndf->map, shape, &end, NULL) != ASP_OK)
            continue;
        for (int own = 0; own < 2; own++) {
            if (own && (strcmp(model->name, "student_t") != 0 || !beckmann
                        || asp_ndf_make(beckmann, &t->ndf->map, NULL, &end, NULL) != ASP_OK))
                continue;
            for (int k = 0; k < 100; k++) {
                asp_vec3 m = asp_sample_normal(&end, aspi_uniform(t), aspi_uniform(t));
                asp_vec3 w = t->views[(size_t)k % t->view_count].w;
                double D = asp_D(&end, m), sigma = asp_sigma(&end, w), height, length;
                aspi_standard_view(&end, w, &height, &length);
                aspi_find(t, fabs(asp_D(&far, m) - D) / D, 1e-6, "%s = 1e9: D %.15g, %s %.15g", model->params[p].name,
                          asp_D(&far, m), own ? "beckmann" : "at infinity", D);
                if (height > 0)
                    aspi_find(t, fabs(asp_sigma(&far, w) - sigma) / sigma, 1e-6, "%s = 1e9: sigma %.15g, %s %.15g",
                              model->params[p].name, asp_sigma(&far, w), own ? "beckmann" : "at infinity", sigma);
            }
        }
    }
}

void aspi_law_limits(aspi_trial *t)
{
    no_index(t);
    if (!t->planar)
        no_roughness(t);
    no_tail(t);
}
