/* 1_evaluate.c - how much light a rough gold surface scatters, direction by direction
 *
 *     cc -O2 -Iinclude -Isrc examples/1_evaluate.c src/asperity_core.c -lm -o evaluate && ./evaluate
 */
#include "asperity.h"
#include <math.h>
#include <stdio.h>

int main(void)
{
    const char *spec = "conductor:metal=Au,ndf=(student_t:alpha=0.3,gamma=2.5)";
    const double degree = 3.14159265358979 / 180.0;
    asp_vec3 wi = { -sin(40.0 * degree), 0.0, cos(40.0 * degree) }; /* light from the left, 40 degrees */
    asp_material gold;
    asp_error err;
    int theta;

    if (asp_material_parse(NULL, spec, &gold, &err) != ASP_OK) {
        fprintf(stderr, "%s\n%*s^ %s\n", spec, (int)err.position, "", err.reason);
        return 1;
    }
    printf("theta_o   f red   green    blue     pdf\n");
    for (theta = -80; theta <= 80; theta += 20) {
        asp_vec3 wo = { sin(theta * degree), 0.0, cos(theta * degree) };
        asp_rgb f = asp_eval(&gold, wi, wo);
        printf("%7d %7.4f %7.4f %7.4f %7.4f\n", theta, f.r, f.g, f.b, asp_pdf(&gold, wi, wo));
    }
    return 0;
}
