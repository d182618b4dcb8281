/* inside.h - the frame at a point of the sphere, and light that goes through it */
#ifndef ASPI_RENDER_INSIDE_H
#define ASPI_RENDER_INSIDE_H

#include "render/environment.h"
#include "render/scatter.h"

#include <math.h>

typedef struct aspi_frame { asp_vec3 x, y, z; } aspi_frame;

/* x = dn/dphi of n = (sin theta sin phi, cos theta, sin theta cos phi). */
static inline aspi_frame aspi_frame_at(asp_vec3 n)
{
    double s = sqrt(n.x * n.x + n.z * n.z);
    asp_vec3 x = s > 1e-9 ? (asp_vec3){ n.z / s, 0, -n.x / s } : (asp_vec3){ 1, 0, 0 };
    asp_vec3 y = { n.y * x.z - n.z * x.y, n.z * x.x - n.x * x.z, n.x * x.y - n.y * x.x };
    return (aspi_frame){ x, y, n };
}

static inline asp_vec3 aspi_to_local(const aspi_frame *f, asp_vec3 w)
{
    return (asp_vec3){ aspi_dot(w, f->x), aspi_dot(w, f->y), aspi_dot(w, f->z) };
}

static inline asp_vec3 aspi_to_world(const aspi_frame *f, asp_vec3 w)
{
    return (asp_vec3){ w.x * f->x.x + w.y * f->y.x + w.z * f->z.x,
                       w.x * f->x.y + w.y * f->y.y + w.z * f->z.y,
                       w.x * f->x.z + w.y * f->y.z + w.z * f->z.z };
}

/* What comes along w (world) into the unit sphere at the point n of it, carried to `carried`: followed
 * from wall to wall until it is out. */
asp_rgb aspi_through(const aspi_scatter *scatter, const aspi_lights *lights, asp_vec3 n, asp_vec3 w,
                     asp_rgb carried, uint32_t seed);

#endif
