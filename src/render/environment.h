/* environment.h - the lights prepared for sampling */
#ifndef ASPI_RENDER_ENVIRONMENT_H
#define ASPI_RENDER_ENVIRONMENT_H

#include "asperity_draw.h"

static inline double aspi_dot(asp_vec3 a, asp_vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

typedef struct aspi_light {
    asp_light_shape shape;
    asp_vec3 d, u, v;                /* towards it; its width and height */
    double   cos_radius;             /* disc */
    double   half_width, half_height;
    double   solid_angle;
    double   cos_bound, sin_bound;   /* of a cone around d that holds it */
    asp_rgb  radiance;
    double   power;                  /* luminance times solid angle */
} aspi_light;

typedef struct aspi_lights {
    int        count;
    aspi_light light[ASP_LIGHTS];
    asp_rgb    zenith, horizon, ground, nadir;
} aspi_lights;

asp_status aspi_lights_prepare(const asp_environment *environment, aspi_lights *out, asp_error *err);

asp_rgb aspi_radiance(const aspi_lights *lights, asp_vec3 w);

/* Chances to choose each light at a point with normal n; they sum to 1, or to 0 when no light can be
 * seen from there. */
double aspi_light_chances(const aspi_lights *lights, asp_vec3 n, double chance[ASP_LIGHTS]);

/* A direction towards light `index`, and the density of such directions under `chance`. */
asp_vec3 aspi_light_sample(const aspi_light *light, double u1, double u2);
double aspi_light_pdf(const aspi_lights *lights, const double chance[ASP_LIGHTS], asp_vec3 w);

#endif
