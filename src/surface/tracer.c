/* tracer.c - light on a periodic field of flat mirrors, with Embree
 *
 * Lengths are in grid steps. One period plus a rim of one square is in the search tree; a ray that
 * leaves the period sideways enters it again on the other side, so there is no edge to be seen. */
#include "surface/surface.h"

#include <embree3/rtcore.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_BOUNCES = 1000, MAX_PERIODS = 1000000 };

/* how far above its facet a reflected ray starts, in grid steps: above the rounding of a float
 * height, far below a facet */
static const double LIFT = 1e-5;

struct aspi_tracer {
    RTCDevice device;
    RTCScene  scene;
    int       nx, ny;
    double    top, bottom;
    float    *heights;       /* (nx + 1) x (ny + 1) points in grid steps, as in the tree */
};

/* ---- geometry */

static double height_at(const aspi_tracer *t, int x, int y)
{
    return (double)t->heights[(size_t)y * (size_t)(t->nx + 1) + (size_t)x];
}

static int wrapped(int i, int n)
{
    return i < 0 ? i + n : i >= n ? i - n : i;
}

/* Slopes of both triangles of square (x, y), and the four corners. */
static void square(const aspi_tracer *t, int x, int y, double corner[4], aspi_slope s[2])
{
    corner[0] = height_at(t, x, y);
    corner[1] = height_at(t, x + 1, y);
    corner[2] = height_at(t, x, y + 1);
    corner[3] = height_at(t, x + 1, y + 1);
    aspi_square_slopes((x + y) & 1, corner[0], corner[1], corner[2], corner[3], 1, 1, s);
}

/* Height of triangle `which` of a square, or of its extension, at (u, v) from corner 00. Whichever
 * the diagonal, the first triangle has corner 00 and the second corner 11. */
static double plane(const double corner[4], const aspi_slope s[2], int which, double u, double v)
{
    return which == 0 ? corner[0] + s[0].p * u + s[0].q * v
                      : corner[3] + s[1].p * (u - 1) + s[1].q * (v - 1);
}

/* ---- the search tree */

static int add_mesh(aspi_tracer *t)
{
    int nx = t->nx, ny = t->ny;
    size_t wide = (size_t)nx + 3, points = wide * ((size_t)ny + 3);
    size_t squares = ((size_t)nx + 2) * ((size_t)ny + 2);
    RTCGeometry mesh = rtcNewGeometry(t->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (!mesh)
        return 0;
    float *point = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                           3 * sizeof *point, points);
    unsigned *corner = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                               3 * sizeof *corner, 2 * squares);
    int ok = point && corner;
    for (int y = -1; ok && y <= ny + 1; ++y)
        for (int x = -1; x <= nx + 1; ++x) {
            *point++ = (float)x;
            *point++ = (float)y;
            *point++ = (float)height_at(t, wrapped(x, nx), wrapped(y, ny));
        }
    /* square (x, y) with x, y from -1: triangle 2 i has the lower edge, 2 i + 1 the upper */
    for (int y = -1; ok && y <= ny; ++y)
        for (int x = -1; x <= nx; ++x) {
            unsigned a = (unsigned)((size_t)(y + 1) * wide + (size_t)(x + 1));
            unsigned b = a + 1, c = a + (unsigned)wide, d = c + 1;
            unsigned even[6] = { a, b, d, a, d, c }, odd[6] = { a, b, c, b, d, c };
            memcpy(corner, (x + y) & 1 ? odd : even, sizeof even);
            corner += 6;
        }
    if (ok) {
        rtcCommitGeometry(mesh);
        rtcAttachGeometry(t->scene, mesh);
    }
    rtcReleaseGeometry(mesh);
    return ok;
}

aspi_tracer *aspi_tracer_make(const asp_height_field *field, asp_error *err)
{
    if (!field->periodic || field->nx < 2 || field->ny < 2 || field->nx % 2 || field->ny % 2
        || field->nx > 16384 || field->ny > 16384 || field->dx != field->dy) {
        asp_fail(err, ASP_EINVAL, "field", "not periodic with even sides and square steps");
        return NULL;
    }
    aspi_tracer *t = calloc(1, sizeof *t);
    size_t nx = (size_t)field->nx, ny = (size_t)field->ny;
    if (t)
        t->heights = malloc((nx + 1) * (ny + 1) * sizeof *t->heights);
    if (!t || !t->heights) {
        asp_fail(err, ASP_ENOMEM, "tracer", "out of memory");
        aspi_tracer_free(t);
        return NULL;
    }
    t->nx = field->nx;
    t->ny = field->ny;
    t->top = -INFINITY;
    t->bottom = INFINITY;
    for (size_t y = 0; y <= ny; ++y)
        for (size_t x = 0; x <= nx; ++x) {
            double h = (double)field->heights[(y % ny) * nx + x % nx] / field->dx;
            t->heights[y * (nx + 1) + x] = (float)h;
            t->top = fmax(t->top, h);
            t->bottom = fmin(t->bottom, h);
            if (!isfinite(h)) {
                asp_fail(err, ASP_EINVAL, "heights", "not a finite number");
                aspi_tracer_free(t);
                return NULL;
            }
        }
    /* one thread builds the tree, so that the same field always gives the same tree */
    t->device = rtcNewDevice("threads=1");
    t->scene = t->device ? rtcNewScene(t->device) : NULL;
    if (t->scene)
        rtcSetSceneFlags(t->scene, RTC_SCENE_FLAG_ROBUST);
    if (!t->scene || !add_mesh(t)) {
        asp_fail(err, ASP_ENOMEM, "tracer", "Embree cannot hold the surface");
        aspi_tracer_free(t);
        return NULL;
    }
    rtcCommitScene(t->scene);
    if (rtcGetDeviceError(t->device) != RTC_ERROR_NONE) {
        asp_fail(err, ASP_ENOMEM, "tracer", "Embree cannot build its tree");
        aspi_tracer_free(t);
        return NULL;
    }
    return t;
}

void aspi_tracer_free(aspi_tracer *tracer)
{
    if (!tracer)
        return;
    if (tracer->scene)
        rtcReleaseScene(tracer->scene);
    if (tracer->device)
        rtcReleaseDevice(tracer->device);
    free(tracer->heights);
    free(tracer);
}

/* ---- one ray */

static asp_vec3 reflect(asp_vec3 d, asp_vec3 n, double dn)
{
    return (asp_vec3){ d.x - 2 * dn * n.x, d.y - 2 * dn * n.y, d.z - 2 * dn * n.z };
}

/* Distance along d to leave [0, n]; a direction along the sides never does. */
static double to_side(double o, double d, double n)
{
    return d > 0 ? (n - o) / d : d < 0 ? -o / d : INFINITY;
}

typedef enum next_event { HIT, ESCAPED, LOST } next_event;

/* Follows the ray from *o along d to its next facet: *x, *y the square, *which the triangle and *o
 * the point. Wraps as often as needed. */
static next_event follow(const aspi_tracer *t, asp_vec3 *o, asp_vec3 d, int *x, int *y, int *which)
{
    for (int period = 0; period < MAX_PERIODS; ++period) {
        double side_x = to_side(o->x, d.x, t->nx), side_y = to_side(o->y, d.y, t->ny);
        double side = fmax(0, fmin(side_x, side_y));
        double rise = d.z > 0 ? (t->top - o->z) / d.z : INFINITY;
        if (rise < 0)
            return ESCAPED;
        struct RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        struct RTCRayHit r = { .ray = { .org_x = (float)o->x, .org_y = (float)o->y,
                                        .org_z = (float)o->z, .dir_x = (float)d.x,
                                        .dir_y = (float)d.y, .dir_z = (float)d.z,
                                        /* a little beyond the side: the rim is there for that */
                                        .tfar = (float)(fmin(side, rise) * (1 + 1e-6) + 1e-3),
                                        .mask = UINT32_MAX } };
        r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(t->scene, &context, &r);
        double far = r.hit.geomID == RTC_INVALID_GEOMETRY_ID ? side : (double)r.ray.tfar;
        if (r.hit.geomID == RTC_INVALID_GEOMETRY_ID && rise <= side)
            return ESCAPED;
        *o = (asp_vec3){ o->x + far * d.x, o->y + far * d.y, o->z + far * d.z };
        if (r.hit.geomID != RTC_INVALID_GEOMETRY_ID) {
            int squares = t->nx + 2, index = (int)(r.hit.primID / 2);
            *which = (int)(r.hit.primID & 1);
            *x = wrapped(index % squares - 1, t->nx);
            *y = wrapped(index / squares - 1, t->ny);
            /* a hit on the rim, seen from the period it belongs to */
            o->x += *x - (index % squares - 1);
            o->y += *y - (index / squares - 1);
            return HIT;
        }
        if (o->z < t->bottom - 1)
            return LOST;
        if (side_x <= side_y)
            o->x = d.x > 0 ? 0 : t->nx;
        if (side_y <= side_x)
            o->y = d.y > 0 ? 0 : t->ny;
    }
    return LOST;
}

/* The starting point of a ray reflected at *o on a facet of square (x, y): rounded to the floats
 * that the tree will see and lifted above the facets of the square it then lies in. */
static void lift(const aspi_tracer *t, asp_vec3 *o, int x, int y, int which)
{
    /* volatile: gcc 12 drops a pair of casts double -> float -> double when it vectorises them */
    volatile float nearest_x = (float)o->x, nearest_y = (float)o->y;
    double u = (double)nearest_x, v = (double)nearest_y, corner[4];
    aspi_slope s[2];
    square(t, x, y, corner, s);
    double z = plane(corner, s, which, u - x, v - y);
    int x1 = (int)fmin(fmax(floor(u), 0), t->nx - 1), y1 = (int)fmin(fmax(floor(v), 0), t->ny - 1);
    square(t, x1, y1, corner, s);
    double a = u - x1, b = v - y1;
    int lower = (x1 + y1) & 1 ? a + b < 1 : b < a;
    z = fmax(z, plane(corner, s, !lower, a, b));
    *o = (asp_vec3){ u, v, z + LIFT };
}

int aspi_trace(const aspi_tracer *t, double u, double v, asp_vec3 wi, const asp_metal *metal,
               aspi_path *out)
{
    asp_vec3 o = { u * t->nx, v * t->ny, t->top + 1 }, d = { -wi.x, -wi.y, -wi.z };
    asp_rgb weight = { 1, 1, 1 };
    for (int bounces = 0; bounces <= MAX_BOUNCES; ++bounces) {
        int x, y, which;
        next_event event = follow(t, &o, d, &x, &y, &which);
        if (event == LOST)
            return 0;
        if (event == ESCAPED) {
            double length = sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
            *out = (aspi_path){ { d.x / length, d.y / length, d.z / length }, weight, bounces };
            return bounces > 0 && d.z > 0;
        }
        double corner[4];
        aspi_slope s[2];
        square(t, x, y, corner, s);
        double p = s[which].p, q = s[which].q, scale = 1 / sqrt(1 + p * p + q * q);
        asp_vec3 n = { -p * scale, -q * scale, scale };
        double dn = d.x * n.x + d.y * n.y + d.z * n.z;
        if (!(dn < 0))       /* from behind: through a crack */
            return 0;
        if (metal) {
            weight.r *= asp_fresnel_conductor(-dn, metal->eta.r, metal->k.r);
            weight.g *= asp_fresnel_conductor(-dn, metal->eta.g, metal->k.g);
            weight.b *= asp_fresnel_conductor(-dn, metal->eta.b, metal->k.b);
        }
        d = reflect(d, n, dn);
        lift(t, &o, x, y, which);
    }
    return 0;
}
