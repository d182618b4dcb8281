/* environment.c - a studio of discs and rectangles at infinity under a smooth sky */
#include "render/environment.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define PI 3.14159265358979323846

static double luminance(asp_rgb c)
{
    return 0.2126 * c.r + 0.7152 * c.g + 0.0722 * c.b;
}

/* ------------------------------------------------------------------ preparing */

static asp_status refuse(asp_error *err, int index, const char *what, double value, double low,
                         int low_open, double high)
{
    char name[64];
    if (index < 0)
        snprintf(name, sizeof name, "environment.%s", what);
    else
        snprintf(name, sizeof name, "environment.lights[%d].%s", index, what);
    return asp_fail_range(err, name, value, low, low_open, high);
}

static int is_radiance(asp_rgb c)
{
    return c.r >= 0 && c.r <= 1e30 && c.g >= 0 && c.g <= 1e30 && c.b >= 0 && c.b <= 1e30;
}

static asp_status prepare_light(const asp_light *light, int index, aspi_light *out, asp_error *err)
{
    memset(out, 0, sizeof *out);
    asp_vec3 d = light->direction;
    double length = sqrt(aspi_dot(d, d));
    if (!(length > 0 && length < 1e150))
        return refuse(err, index, "direction", length, 0, 1, 1e150);
    if (!is_radiance(light->radiance))
        return refuse(err, index, "radiance", luminance(light->radiance), 0, 0, 1e30);
    out->shape = light->shape;
    out->radiance = light->radiance;
    out->d = d = (asp_vec3){ d.x / length, d.y / length, d.z / length };
    /* right = d x up; straight above and below, the world's x */
    double level = hypot(d.x, d.z);
    asp_vec3 right = level > 1e-9 ? (asp_vec3){ -d.z / level, 0, d.x / level } : (asp_vec3){ 1, 0, 0 };
    asp_vec3 up = { right.y * d.z - right.z * d.y, right.z * d.x - right.x * d.z,
                    right.x * d.y - right.y * d.x };
    double c = cos(light->roll), s = sin(light->roll);
    if (light->shape == ASP_LIGHT_RECTANGLE && !isfinite(light->roll))
        return refuse(err, index, "roll", light->roll, -1e9, 0, 1e9);
    out->u = (asp_vec3){ c * right.x + s * up.x, c * right.y + s * up.y, c * right.z + s * up.z };
    out->v = (asp_vec3){ c * up.x - s * right.x, c * up.y - s * right.y, c * up.z - s * right.z };
    double bound;
    if (light->shape == ASP_LIGHT_DISC) {
        if (!(light->radius > 0 && light->radius < PI / 2))
            return refuse(err, index, "radius", light->radius, 0, 1, PI / 2);
        bound = light->radius;
        out->cos_radius = cos(bound);
        out->solid_angle = 4 * PI * sin(0.5 * bound) * sin(0.5 * bound);
    } else if (light->shape == ASP_LIGHT_RECTANGLE) {
        double a = light->half_width, b = light->half_height;
        if (!(a > 0 && a <= 100))
            return refuse(err, index, "half_width", a, 0, 1, 100);
        if (!(b > 0 && b <= 100))
            return refuse(err, index, "half_height", b, 0, 1, 100);
        bound = atan(hypot(a, b));
        out->half_width = a;
        out->half_height = b;
        out->solid_angle = 4 * asin(a * b / sqrt((1 + a * a) * (1 + b * b)));
    } else {
        return refuse(err, index, "shape", light->shape, ASP_LIGHT_DISC, 0, ASP_LIGHT_RECTANGLE);
    }
    out->cos_bound = cos(bound);
    out->sin_bound = sin(bound);
    out->power = luminance(light->radiance) * out->solid_angle;
    return ASP_OK;
}

asp_status aspi_lights_prepare(const asp_environment *environment, aspi_lights *out, asp_error *err)
{
    const asp_environment *e = environment;
    const struct { const char *name; asp_rgb value; } sky[] = {
        { "zenith", e->zenith }, { "horizon", e->horizon }, { "ground", e->ground }, { "nadir", e->nadir }
    };
    for (int i = 0; i < 4; i++)
        if (!is_radiance(sky[i].value))
            return refuse(err, -1, sky[i].name, luminance(sky[i].value), 0, 0, 1e30);
    if (e->light_count < 0 || e->light_count > ASP_LIGHTS)
        return refuse(err, -1, "light_count", e->light_count, 0, 0, ASP_LIGHTS);
    out->count = e->light_count;
    out->zenith = e->zenith;
    out->horizon = e->horizon;
    out->ground = e->ground;
    out->nadir = e->nadir;
    for (int i = 0; i < e->light_count; i++) {
        asp_status status = prepare_light(&e->lights[i], i, &out->light[i], err);
        if (status != ASP_OK)
            return status;
    }
    return ASP_OK;
}

/* ------------------------------------------------------------------ radiance */

static int lights_up(const aspi_light *light, asp_vec3 w, double *a, double *b)
{
    double c = aspi_dot(w, light->d);
    if (light->shape == ASP_LIGHT_DISC)
        return c >= light->cos_radius;
    if (c <= 0)
        return 0;
    *a = aspi_dot(w, light->u) / c;
    *b = aspi_dot(w, light->v) / c;
    return fabs(*a) <= light->half_width && fabs(*b) <= light->half_height;
}

static asp_rgb blend(asp_rgb from, asp_rgb to, double t)
{
    return (asp_rgb){ from.r + t * (to.r - from.r), from.g + t * (to.g - from.g),
                      from.b + t * (to.b - from.b) };
}

asp_rgb aspi_radiance(const aspi_lights *lights, asp_vec3 w)
{
    double height = fabs(w.y), left = height < 1 ? 1 - height : 0;
    double s = 1 - left * left * left, a, b;
    asp_rgb sum = w.y >= 0 ? blend(lights->horizon, lights->zenith, s)
                           : blend(lights->ground, lights->nadir, s);
    for (int i = 0; i < lights->count; i++)
        if (lights_up(&lights->light[i], w, &a, &b)) {
            sum.r += lights->light[i].radiance.r;
            sum.g += lights->light[i].radiance.g;
            sum.b += lights->light[i].radiance.b;
        }
    return sum;
}

asp_rgb asp_environment_radiance(const asp_environment *environment, asp_vec3 w)
{
    aspi_lights lights;
    if (aspi_lights_prepare(environment, &lights, NULL) != ASP_OK)
        return (asp_rgb){ 0, 0, 0 };
    return aspi_radiance(&lights, w);
}

/* ------------------------------------------------------------------ sampling */

/* Power times the greatest cosine any point of the light's bounding cone can have: 0 only when the
 * light is wholly behind the surface, so the density is nowhere 0 where the light shines. */
double aspi_light_chances(const aspi_lights *lights, asp_vec3 n, double chance[ASP_LIGHTS])
{
    double sum = 0;
    for (int i = 0; i < lights->count; i++) {
        const aspi_light *l = &lights->light[i];
        double c = aspi_dot(n, l->d);
        double s2 = 1 - c * c, s = sqrt(s2 > 0 ? s2 : 0);
        double best = c >= l->cos_bound ? 1 : c * l->cos_bound + s * l->sin_bound;
        sum += chance[i] = best > 0 ? l->power * best : 0;
    }
    for (int i = 0; i < lights->count; i++)
        chance[i] = sum > 0 ? chance[i] / sum : 0;
    return sum > 0 ? 1 : 0;
}

/* Disc: uniform over its solid angle. Rectangle: uniform over its plane. */
asp_vec3 aspi_light_sample(const aspi_light *l, double u1, double u2)
{
    double a, b, c = 1;
    if (l->shape == ASP_LIGHT_DISC) {
        double h = u1 * (1 - l->cos_radius);           /* 1 - cos, exact for small discs */
        double s = sqrt(h * (2 - h));
        c = 1 - h;
        a = s * cos(2 * PI * u2);
        b = s * sin(2 * PI * u2);
    } else {
        a = (2 * u1 - 1) * l->half_width;
        b = (2 * u2 - 1) * l->half_height;
        c = 1 / sqrt(1 + a * a + b * b);
        a *= c;
        b *= c;
    }
    return (asp_vec3){ a * l->u.x + b * l->v.x + c * l->d.x, a * l->u.y + b * l->v.y + c * l->d.y,
                       a * l->u.z + b * l->v.z + c * l->d.z };
}

/* On the rectangle dA = (1 + a^2 + b^2)^(3/2) dw: distance squared over the cosine. */
double aspi_light_pdf(const aspi_lights *lights, const double chance[ASP_LIGHTS], asp_vec3 w)
{
    double sum = 0, a, b;
    for (int i = 0; i < lights->count; i++) {
        const aspi_light *l = &lights->light[i];
        if (chance[i] == 0 || !lights_up(l, w, &a, &b))
            continue;
        if (l->shape == ASP_LIGHT_DISC) {
            sum += chance[i] / l->solid_angle;
        } else {
            double r2 = 1 + a * a + b * b;
            sum += chance[i] * r2 * sqrt(r2) / (4 * l->half_width * l->half_height);
        }
    }
    return sum;
}

/* ------------------------------------------------------------------ two environments */

asp_environment asp_environment_studio(void)
{
    return (asp_environment){
        .zenith = { 0.30, 0.34, 0.40 }, .horizon = { 0.20, 0.21, 0.23 },
        .ground = { 0.075, 0.07, 0.065 }, .nadir = { 0.14, 0.13, 0.12 },
        .lights = {
            { .shape = ASP_LIGHT_RECTANGLE, .direction = { -0.62, 0.60, 0.62 }, .half_width = 0.42,
              .half_height = 0.42, .roll = 0.25, .radiance = { 4.0, 3.9, 3.7 } },
            { .shape = ASP_LIGHT_RECTANGLE, .direction = { 0.92, 0.18, 0.10 }, .half_width = 0.14,
              .half_height = 0.85, .radiance = { 2.3, 2.5, 2.9 } },
            { .shape = ASP_LIGHT_DISC, .direction = { 0.42, 0.66, 0.72 }, .radius = 0.11,
              .radiance = { 7.0, 5.6, 4.0 } },
            { .shape = ASP_LIGHT_RECTANGLE, .direction = { -0.10, 0.80, -0.90 }, .half_width = 0.75,
              .half_height = 0.20, .radiance = { 2.6, 2.6, 2.7 } },
        },
        .light_count = 4
    };
}

asp_environment asp_environment_furnace(double radiance)
{
    asp_rgb c = { radiance, radiance, radiance };
    return (asp_environment){ .zenith = c, .horizon = c, .ground = c, .nadir = c };
}
