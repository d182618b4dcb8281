/* 4_batch.c - a hundred thousand samples in one call, float32, and that a batch is the single call
 *
 *     cc -O2 -Iinclude -Isrc examples/4_batch.c src/asperity_core.c -lm -o batch && ./batch
 */
#include "asperity.h"
#include <math.h>
#include <stdio.h>

enum { N = 100000 };
static float wi_x[N], wi_y[N], wi_z[N], u1[N], u2[N];
static float wo_x[N], wo_y[N], wo_z[N], pdf[N], r[N], g[N], b[N];

int main(void)
{
    asp_material silver;
    asp_materialf f;
    asp_cvec3sf wi = { wi_x, wi_y, wi_z };
    asp_vec3sf wo = { wo_x, wo_y, wo_z };
    asp_rgbsf weight = { r, g, b };
    double sum[3] = { 0.0, 0.0, 0.0 };
    int i, different = 0;

    if (asp_material_parse(NULL, "conductor:metal=Ag,ndf=(ggx:alpha_x=0.3,alpha_y=0.1)", &silver,
                           NULL) != ASP_OK)
        return 1;
    f = asp_material_narrow(&silver);       /* prepare in float64, evaluate in float32 */
    for (i = 0; i < N; i++) {
        wi_x[i] = 0.6f;
        wi_z[i] = 0.8f;
        /* the additive sequence of the plastic number covers the square evenly */
        u1[i] = (float)fmod(0.5 + 0.7548776662466927 * i, 1.0) * 0.99999f;
        u2[i] = (float)fmod(0.5 + 0.5698402909980532 * i, 1.0) * 0.99999f;
    }
    asp_sample_nf(&f, N, wi, u1, u2, wo, pdf, weight);
    for (i = 0; i < N; i++) {
        asp_vec3f w = { 0.6f, 0.0f, 0.8f };
        asp_bsdf_samplef s = asp_samplef(&f, w, u1[i], u2[i]);
        different += s.wo.x != wo_x[i] || s.pdf != pdf[i] || s.weight.r != r[i];
        sum[0] += r[i];
        sum[1] += g[i];
        sum[2] += b[i];
    }
    printf("silver at 37 degrees reflects %.3f %.3f %.3f\n", sum[0] / N, sum[1] / N, sum[2] / N);
    printf("%d of %d samples differ from the single call\n", different, N);
    return different > 0;
}
