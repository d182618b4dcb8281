/* 2_sample.c - the share of light that a mirror with a rough surface gives back, by sampling
 *
 * f cos / pdf is `weight`: its mean over samples is the albedo. (u1, u2) come from a grid, because
 * the library draws no numbers of its own and the samplers keep stratification.
 *
 *     cc -O2 -Iinclude -Isrc examples/2_sample.c src/asperity_core.c -lm -o sample && ./sample
 */
#include "asperity.h"
#include <math.h>
#include <stdio.h>

int main(void)
{
    static const double alphas[] = { 0.1, 0.3, 1.0 };
    enum { SIDE = 64 };
    size_t a;
    int theta, i, j;

    printf("albedo by one bounce  20 deg  50 deg  80 deg\n");
    for (a = 0; a < 3; a++) {
        asp_map map;
        asp_ndf ndf;
        asp_material mirror;
        if (asp_map_from_roughness(alphas[a], alphas[a], 0.0, 0.0, 0.0, &map, NULL) != ASP_OK ||
            asp_ndf_make(asp_find_model(NULL, "ggx"), &map, NULL, &ndf, NULL) != ASP_OK)
            return 1;
        mirror = asp_mirror(&ndf, ASP_MASK_CORRELATED);
        printf("ggx, alpha = %-7g", alphas[a]);
        for (theta = 20; theta <= 80; theta += 30) {
            double t = theta * 3.14159265358979 / 180.0, sum = 0.0;
            asp_vec3 wi = { sin(t), 0.0, cos(t) };
            for (i = 0; i < SIDE; i++)
                for (j = 0; j < SIDE; j++)
                    sum += asp_sample(&mirror, wi, (i + 0.5) / SIDE, (j + 0.5) / SIDE).weight.r;
            printf("  %6.3f", sum / (SIDE * SIDE));
        }
        printf("\n");
    }
    return 0;
}
