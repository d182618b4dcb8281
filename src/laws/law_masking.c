/* law_masking.c - laws of sigma, G1, G2 and the densities made of them */
#include "laws/laws.h"

#include <math.h>

static const int smith[4] = { ASP_MASK_CORRELATED, ASP_MASK_UNCORRELATED,
                              ASP_MASK_CORRELATED | ASP_MASK_WALL,
                              ASP_MASK_UNCORRELATED | ASP_MASK_WALL };
static const char *const smith_name[4] = { "correlated", "uncorrelated", "correlated+wall",
                                           "uncorrelated+wall" };

static asp_vec3 minus(asp_vec3 w)
{
    asp_vec3 out;
    out.x = -w.x;
    out.y = -w.y;
    out.z = -w.z;
    return out;
}

/* w.z - t.w_xy is a difference: its rounding is a step of this size in the height of w'. */
static double height_step(const aspi_trial *t, asp_vec3 w)
{
    const asp_ndf *k = t->ndf;
    return 2.3e-16 * (fabs(w.z) + fabs(k->map.tx * w.x) + fabs(k->map.ty * w.y))
         + aspi_lattice_step(t, w);
}

/* The error of sigma that the distribution states for itself. Seen from below the mean plane, where
 * sigma may be the last of a tail, four times that is allowed. */
static double stated_error(const aspi_trial *t) { return t->ndf->model->area_error; }

#define FROM_BELOW 4

/* How far x lies outside [low, high], relative to the nearer end. */
static double outside(double x, double low, double high)
{
    if (!(x == x))
        return NAN;
    if (x < low)
        return (low - x) / low;
    return x > high ? (x - high) / (high > 0 ? high : 1) : 0;
}

/* ------------------------------------------------------------------ sigma */

static void sigma_at(aspi_trial *t, asp_vec3 w, const char *name)
{
    double h, s, step = height_step(t, w), found = asp_sigma(t->ndf, w), exact, low, high;
    aspi_standard_view(t->ndf, w, &h, &s);
    exact = aspi_sigma_expected(t, w, 0);
    low = high = exact;
    /* far below the mean plane sigma is the tail of the distribution, where a rounding of the
     * height costs digits that nobody can save: any value between is right */
    if (h < 0 && step > 1e-14 * fabs(h) / (1 + h * h / (s * s))) {
        low = aspi_sigma_expected(t, w, -step);
        high = aspi_sigma_expected(t, w, step);
    }
    if (exact > 1e-280) /* below, D itself is gone */
        aspi_find(t, outside(found, low, high), 1e-10 + (h < 0 ? FROM_BELOW : 1) * stated_error(t),
                  "%s w = (%.9g, %.9g, %.9g): %.15g, by quadrature %.15g", name, w.x, w.y, w.z,
                  found, exact);
    else
        aspi_find(t, found, 1e-270, "%s w = (%.9g, %.9g, %.9g): not gone", name, w.x, w.y, w.z);
}

void aspi_law_sigma(aspi_trial *t)
{
    size_t i;
    asp_vec3 across = { 0, 0, -1 };
    for (i = 0; i < t->view_count; i++) {
        sigma_at(t, t->views[i].w, t->views[i].name);
        sigma_at(t, minus(t->views[i].w), "below the horizon,");
        if (aspi_tick(t, (double)i / (double)t->view_count))
            return;
    }
    sigma_at(t, across, "straight from below,");
    for (i = 0; i < 12; i++)
        sigma_at(t, aspi_random_direction(t), "random");
}

void aspi_law_sigma_flip(aspi_trial *t)
{
    int i;
    for (i = 0; i < 2000; i++) {
        asp_vec3 w = aspi_random_direction(t);
        double up, down, h, s;
        if (i % 4 == 0)
            w = aspi_unit(w.x, w.y, 1e-4 * w.z);
        up = asp_sigma(t->ndf, w);
        down = asp_sigma(t->ndf, minus(w));
        aspi_standard_view(t->ndf, w, &h, &s);
        aspi_find(t, fabs((up - down) - h) / fmax(fmax(up, down), fabs(h)),
                  2e-15 + 2 * height_step(t, w) / fmax(up, down)
                  + stated_error(t) * (1 + FROM_BELOW * fmin(up, down) / fmax(up, down)),
                  "w = (%.9g, %.9g, %.9g): %.17g up, %.17g down", w.x, w.y, w.z, up, down);
        aspi_find(t, up < 0 || down < 0, 0, "w = (%.9g, %.9g, %.9g): negative", w.x, w.y, w.z);
    }
}

/* ------------------------------------------------------------------ G1 */

static double wall_facing(const asp_ndf *k, asp_vec3 w)
{
    return fmax(0, k->map.tx * w.x + k->map.ty * w.y);
}

static void G1_value(aspi_trial *t, asp_vec3 w, int k)
{
    int mask = smith[k];
    double G1 = asp_G1(t->ndf, w, mask), lambda = asp_lambda(t->ndf, w, mask);
    double area = asp_sigma(t->ndf, w), other = asp_sigma(t->ndf, minus(w)), expected;
    expected = mask & ASP_MASK_WALL ? w.z / (area + wall_facing(t->ndf, w))
                                    : fmin(1, w.z / area);
    aspi_find(t, fabs(G1 - expected) / expected,
              4e-15 + (mask & ASP_MASK_WALL ? 4 * height_step(t, w) / area : 0),
              "%s w = (%.9g, %.9g, %.9g): G1 %.17g, from sigma %.17g", smith_name[k], w.x, w.y,
              w.z, G1, expected);
    /* Lambda is the area of the other side less what faces it: that area's error is one of Lambda w.z */
    aspi_find(t, fabs(G1 * (1 + lambda) - 1), 4e-15 + 4 * height_step(t, w) / area
              + stated_error(t) * (FROM_BELOW + other / fmax(area, w.z)),
              "%s w = (%.9g, %.9g, %.9g): G1 (1 + Lambda)", smith_name[k], w.x, w.y, w.z);
    aspi_find(t, !(G1 >= 0 && G1 <= 1 && lambda >= 0), 0,
              "%s w = (%.9g, %.9g, %.9g): G1 %.17g, Lambda %.17g out of range", smith_name[k],
              w.x, w.y, w.z, G1, lambda);
}

void aspi_law_G1(aspi_trial *t)
{
    static const asp_vec3 normal = { 0, 0, 1 }, horizon = { 1, 0, 0 };
    int k, i, a;
    for (k = 0; k < 4; k++) {
        aspi_find(t, fabs(asp_G1(t->ndf, normal, smith[k]) - 1), 1e-15, "%s at the normal",
                  smith_name[k]);
        aspi_find(t, asp_G1(t->ndf, horizon, smith[k]), 0, "%s at the horizon", smith_name[k]);
        aspi_find(t, !(asp_lambda(t->ndf, horizon, smith[k]) == INFINITY), 0,
                  "%s: Lambda at the horizon is not infinite", smith_name[k]);
        for (a = 0; a < 7; a++) {
            double phi = a * 0.9 + (t->skewed ? atan2(t->ndf->map.ty, t->ndf->map.tx) : 0);
            double last = 1;
            /* sigma / w.z is convex in tan(theta) and 1 at the normal, so that a ratio that has
             * passed 1 on the way down goes on rising: G1 falls under min and wall alike */
            for (i = 1; i < 250; i++) {
                double cot = exp(8 - 0.08 * i);
                asp_vec3 w = aspi_unit(cos(phi), sin(phi), cot);
                double G1 = asp_G1(t->ndf, w, smith[k]);
                aspi_find(t, (G1 - last) / last, 2e-15 + 4 * height_step(t, w)
                          / asp_sigma(t->ndf, w) + stated_error(t),
                          "%s rises with the angle at phi %.6g, cot(theta) %.6g",
                          smith_name[k], phi, cot);
                last = G1;
            }
        }
        for (i = 0; i < (int)t->view_count; i++)
            G1_value(t, t->views[i].w, k);
        for (i = 0; i < 200; i++) {
            asp_vec3 w = aspi_random_direction(t);
            if (w.z < 0)
                w = minus(w);
            G1_value(t, w, k);
        }
    }
    aspi_find(t, fabs(asp_G1(t->ndf, t->views[1].w, ASP_MASK_V_CAVITY) - 1), 0, "v_cavity");
}

void aspi_law_wall(aspi_trial *t)
{
    int i;
    for (i = 0; i < 500; i++) {
        asp_vec3 w = aspi_random_direction(t), other;
        double front, back, h, G1;
        if (w.z < 0)
            w = minus(w);
        other = minus(w);
        /* facets and the walls that close the surface, seen from both sides: no area is lost */
        front = asp_sigma(t->ndf, w) + wall_facing(t->ndf, w);
        back = asp_sigma(t->ndf, other) + wall_facing(t->ndf, other);
        aspi_find(t, fabs((front - back) - w.z), 4e-16 * front + 4 * height_step(t, w)
                  + FROM_BELOW * stated_error(t) * front,
                  "w = (%.9g, %.9g, %.9g): front %.17g, back %.17g", w.x, w.y, w.z, front, back);
        aspi_standard_view(t->ndf, w, &h, &G1);
        if (i < 6) {
            /* the weak white furnace: what G1 leaves of the area is the pixel it came from */
            double area = aspi_sigma_expected(t, w, 0) + wall_facing(t->ndf, w);
            G1 = asp_G1(t->ndf, w, ASP_MASK_WALL);
            aspi_find(t, fabs(G1 * area - w.z), (1e-10 + stated_error(t)) * w.z
                      + 4 * height_step(t, w),
                      "w = (%.9g, %.9g, %.9g): G1 times the area by quadrature, %.15g", w.x, w.y,
                      w.z, G1 * area);
        }
    }
}

/* ------------------------------------------------------------------ G2 */

void aspi_law_G2(aspi_trial *t)
{
    int i, k;
    for (i = 0; i < 1500; i++) {
        asp_vec3 m = aspi_random_facet(t), wi = aspi_random_direction(t);
        asp_vec3 wo = aspi_random_direction(t);
        if (i % 3 == 0)
            wi = t->views[(size_t)i % t->view_count].w;
        if (wi.z < 0)
            wi = minus(wi);
        if (wo.z < 0 && i % 5 != 0)
            wo = minus(wo);
        for (k = 0; k < 4; k++) {
            double G2 = asp_G2(t->ndf, wi, wo, m, smith[k]);
            double a = asp_G1(t->ndf, wi, smith[k]), b = asp_G1(t->ndf, wo, smith[k]);
            double ci = aspi_dot(wi, m), co = aspi_dot(wo, m);
            if (wo.z <= 0 || ci <= -1e-15 || co <= -1e-15) {
                aspi_find(t, G2, 0, "%s not 0 behind the facet or below the horizon",
                          smith_name[k]);
                continue;
            }
            if (ci < 1e-15 || co < 1e-15)
                continue;
            aspi_find(t, G2 - fmin(a, b), 1e-14, "%s above min(G1, G1), wi.z %.6g, wo.z %.6g",
                      smith_name[k], wi.z, wo.z);
            aspi_find(t, a * b - G2, 1e-14, "%s below G1 G1, wi.z %.6g, wo.z %.6g",
                      smith_name[k], wi.z, wo.z);
            if (smith[k] & ASP_MASK_UNCORRELATED)
                aspi_find(t, fabs(a * b - G2), 1e-14, "%s is not G1 G1, wi.z %.6g, wo.z %.6g",
                          smith_name[k], wi.z, wo.z);
            else {
                double lambda = asp_lambda(t->ndf, wi, smith[k]) + asp_lambda(t->ndf, wo, smith[k]);
                aspi_find(t, fabs(G2 * (1 + lambda) - 1),
                          2e-14 + 8 * (height_step(t, wi) / wi.z
                          + height_step(t, wo) / wo.z) + 2 * FROM_BELOW * stated_error(t),
                          "%s is not 1/(1 + Lambda_i + Lambda_o), wi.z %.6g, wo.z %.6g",
                          smith_name[k], wi.z, wo.z);
            }
            aspi_find(t, fabs(G2 - asp_G2(t->ndf, wo, wi, m, smith[k])), 1e-15,
                      "%s differs from wo to wi, wi.z %.6g, wo.z %.6g", smith_name[k], wi.z, wo.z);
        }
        if (wo.z > 0 && aspi_dot(wi, m) > 1e-15 && aspi_dot(wo, m) > 1e-15) {
            double bound = fmin(1, 2 * m.z * fmin(wi.z / aspi_dot(wi, m), wo.z / aspi_dot(wo, m)));
            aspi_find(t, fabs(asp_G2(t->ndf, wi, wo, m, ASP_MASK_V_CAVITY) - bound), 1e-14,
                      "v_cavity, wi.z %.6g, wo.z %.6g", wi.z, wo.z);
        }
    }
}

/* ------------------------------------------------------------------ densities of normals */

/* ---- the integral of pdf_visible, in slopes x along the view and y across it
 *
 * The density ends where a facet turns edge-on, on the line x = mu: no node may meet that kink, and
 * no scale is known. So x is log-spaced towards the ends of (-inf, min(0, mu)] and [0, mu], and
 * y = width sinh b reaches any tail: the width is the roughness where a Gaussian still lives, and
 * |x| far out, where only powers do. A surface with a scale of its own may have others: there the
 * width is a hundredth, and b goes further. */

#define STEP 0.2
#define ACROSS 80

typedef struct visible_plane {
    const aspi_trial *t;
    asp_vec3 w;
    double ux, uy;       /* the view's azimuth in the standard plane */
} visible_plane;

/* Integral over y at x, times dx. */
static double visible_row(const visible_plane *v, double x, double dx)
{
    const aspi_trial *t = v->t;
    int fine = t->ndf->model->own_scale, across = fine ? ACROSS + 30 : ACROSS, j;
    double width = (fabs(x) < 30 * t->scale ? t->scale : fabs(x)) * (fine ? 0.01 : 1), row = 0;
    for (j = -across; j <= across; j++) {
        double b = STEP * j, y = width * sinh(b);
        asp_vec2 p = aspi_map_slope(&t->ndf->map, x * v->ux - y * v->uy, x * v->uy + y * v->ux);
        asp_vec3 m = aspi_unit(-p.x, -p.y, 1);
        double zx = m.z * dx, zy = m.z * width * cosh(b);
        row += asp_pdf_visible(t->ndf, v->w, m) * m.z * zx * zy;
    }
    return row * t->det * STEP * STEP;
}

static double visible_integral(const aspi_trial *t, asp_vec3 w)
{
    const asp_map *map = &t->ndf->map;
    enum { FIT = 40, LAST = 600 };
    visible_plane v;
    double h, s, mu, sum = 0, last = 0, before = 0, end;
    int i;
    if (t->planar)
        return aspi_planar_visible(t, w);
    aspi_standard_view(t->ndf, w, &h, &s);
    v.t = t;
    v.w = w;
    if (!(s > 1e-9 * fabs(h))) /* along the mean normal any azimuth is across */
        s = 1e-9 * fabs(h), v.ux = 1, v.uy = 0;
    else {
        v.ux = (map->m00 * w.x + map->m10 * w.y) / s;
        v.uy = (map->m01 * w.x + map->m11 * w.y) / s;
    }
    mu = h / s;
    end = mu < 0 ? mu : 0;
    for (i = -200; i <= LAST; i++) {
        double a = t->scale * exp(STEP * i);
        last = visible_row(&v, end - a, a);
        sum += last;
        if (i == LAST - FIT)
            before = last;
    }
    if (last > sum * 1e-16 && before > last) { /* a power of x: a geometric series */
        double log_q = log(last / before) / FIT;
        sum += last * exp(log_q) / -expm1(log_q);
    }
    if (mu > 0) {
        double down = 40 + fmax(0, log(mu / t->scale));
        for (i = -(int)(down / STEP); i <= (int)(40 / STEP); i++) {
            double q = exp(STEP * i), x = mu * q / (1 + q);
            sum += visible_row(&v, x, x / (1 + q));
        }
    }
    return sum;
}

double aspi_visible_integral(const aspi_trial *t, asp_vec3 w, double *doubt)
{
    double h, s;
    aspi_standard_view(t->ndf, w, &h, &s);
    *doubt = (h < 0 ? FROM_BELOW : 1) * stated_error(t);
    return visible_integral(t, w);
}

void aspi_law_density_visible(aspi_trial *t)
{
    size_t i;
    int k;
    for (i = 0; i < t->view_count; i++) {
        asp_vec3 w = t->views[i].w;
        double sigma = asp_sigma(t->ndf, w), sum, h, s;
        aspi_standard_view(t->ndf, w, &h, &s);
        if (!(sigma > 1e-150)) /* nothing can be seen from there */
            continue;
        for (k = 0; k < 200; k++) {
            asp_vec3 m = aspi_random_facet(t);
            double c = aspi_dot(w, m), pdf = asp_pdf_visible(t->ndf, w, m);
            double expected = c > 0 ? c * asp_D(t->ndf, m) / sigma : 0;
            if (expected > 1e-290 || c < -1e-15)
                aspi_find(t, expected > 0 ? fabs(pdf - expected) / expected : pdf,
                          4e-15 + (expected > 0 ? 4.6e-16 / c : 0),
                          "%s, m = (%.6g, %.6g, %.6g): %.17g, formula %.17g", t->views[i].name,
                          m.x, m.y, m.z, pdf, expected);
        }
        sum = visible_integral(t, w);
        aspi_find(t, fabs(sum - 1), 1e-7 + (h < 0 ? FROM_BELOW : 1) * stated_error(t),
                  "%s: integral %.12g", t->views[i].name, sum);
        if (aspi_tick(t, (double)(i + 1) / (double)t->view_count))
            return;
    }
}
