/* 3_masking.c - masking: the weight of the tail, and what to do when the mean normal is tilted
 *
 *     cc -O2 -Iinclude -Isrc examples/3_masking.c src/asperity_core.c -lm -o masking && ./masking
 */
#include "asperity.h"
#include <math.h>
#include <stdio.h>

int main(void)
{
    static const char *const specs[] = {
        "student_t:alpha=0.3,gamma=1.6", "ggx:alpha=0.3", "student_t:alpha=0.3,gamma=10",
        "beckmann:alpha=0.3", "ggx:alpha=0.3,mean_x=0.2"
    };
    size_t s;
    int theta;
    printf("%-32s", "G1 seen from");
    for (theta = 30; theta < 90; theta += 15)
        printf("  %2d deg", theta);
    printf("\n");
    for (s = 0; s < sizeof specs / sizeof *specs; s++) {
        int mask, skewed = s == 4;
        for (mask = ASP_MASK_MIN; mask <= (skewed ? ASP_MASK_WALL : 0); mask += ASP_MASK_WALL) {
            asp_ndf ndf;
            if (asp_ndf_parse(NULL, specs[s], &ndf, NULL) != ASP_OK)
                return 1;
            printf("%-24s %-7s", specs[s], skewed ? mask ? "wall" : "min" : "");
            for (theta = 30; theta < 90; theta += 15) {
                double t = theta * 3.14159265358979 / 180.0;
                asp_vec3 w = { sin(t), 0.0, cos(t) };
                printf("  %6.4f", asp_G1(&ndf, w, mask));
            }
            printf("\n");
        }
    }
    return 0;
}
