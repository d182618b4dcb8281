/* inside.c - light that crosses the sphere: from wall to wall by the material's own sampler */
#include "render/inside.h"
#include "core/rng.h"

#define LONGEST 64        /* walls; what is left is dark: total reflection may go round for ever */

asp_rgb aspi_through(const aspi_scatter *scatter, const aspi_lights *lights, asp_vec3 n, asp_vec3 w,
                     asp_rgb carried, uint32_t seed)
{
    aspi_stream stream = { aspi_random_start(seed, 1), 0 };
    for (int k = 0; k < LONGEST && carried.r + carried.g + carried.b > 0; k++) {
        /* the other end of the chord, which is its normal too */
        double chord = -2 * aspi_dot(n, w), length;
        n = (asp_vec3){ n.x + chord * w.x, n.y + chord * w.y, n.z + chord * w.z };
        length = sqrt(aspi_dot(n, n));
        n = (asp_vec3){ n.x / length, n.y / length, n.z / length };
        aspi_frame f = aspi_frame_at(n);
        asp_vec3 wi = aspi_to_local(&f, (asp_vec3){ -w.x, -w.y, -w.z });
        asp_bsdf_sample s;
        if (scatter->walk) {
            s = asp_walk_sample(scatter->material, wi, aspi_stream_next, &stream);
        } else {
            double u1 = aspi_stream_next(&stream), u2 = aspi_stream_next(&stream);
            s = asp_sample_lobe(scatter->material, wi, u1, u2, aspi_stream_next(&stream));
        }
        carried = (asp_rgb){ carried.r * s.weight.r, carried.g * s.weight.g, carried.b * s.weight.b };
        w = aspi_to_world(&f, s.wo);
        if (s.wo.z > 0) {
            asp_rgb light = aspi_radiance(lights, w);
            return (asp_rgb){ carried.r * light.r, carried.g * light.g, carried.b * light.b };
        }
    }
    return (asp_rgb){ 0, 0, 0 };
}
