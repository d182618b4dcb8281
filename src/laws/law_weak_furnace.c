/* law_weak_furnace.c - the weak white furnace: the facets seen from w make up its projected area
 *
 * With G1 alone and no horizon for wo, the integral of G1 D(h) / (4 cos_i) over all wo is 1 (Heitz 2014, eq.
 * 91). On a skewed surface that holds for the mean plane, not for the flat one. */
#include "laws/laws.h"

#include <math.h>

void aspi_law_weak_furnace(aspi_trial *t)
{
    static const int masks[3] = { ASP_MASK_CORRELATED, ASP_MASK_UNCORRELATED, ASP_MASK_UNCORRELATED | ASP_MASK_WALL };
    asp_vec2 mean = asp_mean_slope(t->ndf);
    if (t->skewed || t->planar || mean.x != 0 || mean.y != 0)
        return;
    for (size_t i = 0; i < t->view_count; i++) {
        asp_vec3 w = t->views[i].w;
        /* dwo = 4 (w.m) dm: G1 D (w.m)/cos_i, sigma times the density of visible normals */
        double doubt, seen = asp_sigma(t->ndf, w) * aspi_visible_integral(t, w, &doubt);
        for (int k = 0; k < 3; k++) {
            double sum = asp_G1(t->ndf, w, masks[k]) / w.z * seen;
            aspi_find(t, fabs(sum - 1), 1e-5 + doubt, "%s, masking %d: %.12g", t->views[i].name, masks[k], sum);
        }
    }
}
