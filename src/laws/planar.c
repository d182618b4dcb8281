/* planar.c - integrals over a surface whose slopes are counted in cells
 *
 * The distribution says where its cells lie (asp_lattice), nothing else: the density is asked for at the
 * nodes of Gauss's rules in each cell, cut where facets turn edge-on. What is linear within a cell, as all
 * integrands of sigma and of visible normals are, is integrated exactly. */
#include "laws/laws.h"

#include <math.h>

asp_vec3 aspi_standard_vector(const asp_ndf *ndf, asp_vec3 w)
{
    const asp_map *map = &ndf->map;
    asp_vec3 v;
    v.x = map->m00 * w.x + map->m10 * w.y;
    v.y = map->m01 * w.x + map->m11 * w.y;
    v.z = w.z - (map->tx * w.x + map->ty * w.y);
    return v;
}

double aspi_lattice_step(const aspi_trial *t, asp_vec3 w)
{
    const asp_lattice *l = &t->lattice;
    asp_vec3 v;
    if (!t->planar)
        return 0;
    v = aspi_standard_vector(t->ndf, w);
    return 2.3e-16 * (fabs(v.x) * fmax(fabs(l->x0), fabs(l->x0 + l->dx * (double)l->nx))
                      + fabs(v.y) * fmax(fabs(l->y0), fabs(l->y0 + l->dy * (double)l->ny)));
}

typedef struct sum { double value, lost; } sum;

static void add(sum *s, double x)
{
    double y = x - s->lost, next = s->value + y;
    s->lost = (next - s->value) - y;
    s->value = next;
}

/* Nodes and weights of Gauss's rules on [0, 1]. */
static const double two[2] = { 0.21132486540518712, 0.78867513459481288 };
static const double three[3] = { 0.11270166537925831, 0.5, 0.88729833462074169 };
static const double weights[3] = { 5.0 / 18, 8.0 / 18, 5.0 / 18 };

typedef struct plane { aspi_planar_function *f; const void *context; asp_vec3 v; } plane;

/* The visible part of one line y. */
static double along(const plane *p, double x0, double x1, double y)
{
    double h = p->v.z - p->v.y * y, cut = h / p->v.x;
    if (p->v.x > 0)
        x1 = fmin(x1, cut);
    else if (p->v.x < 0)
        x0 = fmax(x0, cut);
    else if (!(h > 0))
        return 0;
    if (!(x1 > x0))
        return 0;
    return 0.5 * (x1 - x0) * (p->f(p->context, x0 + (x1 - x0) * two[0], y)
                              + p->f(p->context, x0 + (x1 - x0) * two[1], y));
}

static void over_cell(const plane *p, double x0, double x1, double y0, double y1, sum *s)
{
    /* heights at the corners; the line crosses x0 and x1 at the kinks in y */
    double at[4], h = p->v.z - fmin(p->v.x * x0, p->v.x * x1) - fmin(p->v.y * y0, p->v.y * y1);
    int i, j, count = 0;
    if (h <= 0)
        return;
    at[count++] = y0;
    for (i = 0; i < 2 && p->v.y != 0; i++) {
        double y = (p->v.z - p->v.x * (i ? x1 : x0)) / p->v.y;
        if (y > y0 && y < y1)
            at[count++] = y;
    }
    if (count == 3 && at[1] > at[2]) {
        double swap = at[1];
        at[1] = at[2];
        at[2] = swap;
    }
    at[count] = y1;
    for (i = 0; i < count; i++)
        for (j = 0; j < 3; j++)
            add(s, weights[j] * (at[i + 1] - at[i])
                   * along(p, x0, x1, at[i] + (at[i + 1] - at[i]) * three[j]));
}

double aspi_planar_integral(const aspi_trial *t, asp_vec3 v, aspi_planar_function *f,
                            const void *context)
{
    const asp_lattice *l = &t->lattice;
    plane p;
    sum s = { 0, 0 };
    size_t i, j;
    p.f = f;
    p.context = context;
    p.v = v;
    for (j = 0; j < l->ny; j++)
        for (i = 0; i < l->nx; i++)
            over_cell(&p, l->x0 + l->dx * (double)i, l->x0 + l->dx * (double)(i + 1),
                      l->y0 + l->dy * (double)j, l->y0 + l->dy * (double)(j + 1), &s);
    return s.value;
}

/* ---- what the laws integrate */

double aspi_planar_density(const aspi_trial *t, double x, double y)
{
    asp_vec2 p = aspi_map_slope(&t->ndf->map, x, y);
    asp_vec3 m = aspi_unit(-p.x, -p.y, 1);
    return asp_D(t->ndf, m) * m.z * m.z * m.z * m.z * t->det;
}

typedef struct seen { const aspi_trial *t; asp_vec3 v; } seen;

static double sigma_term(const void *context, double x, double y)
{
    const seen *s = (const seen *)context;
    double h = s->v.z - s->v.x * x - s->v.y * y;
    return h > 0 ? h * aspi_planar_density(s->t, x, y) : 0;
}

double aspi_sigma_expected(const aspi_trial *t, asp_vec3 w, double raise)
{
    double h, s;
    if (t->planar) {
        seen c;
        c.t = t;
        c.v = aspi_standard_vector(t->ndf, w);
        c.v.z += raise;
        return aspi_planar_integral(t, c.v, sigma_term, &c);
    }
    aspi_standard_view(t->ndf, w, &h, &s);
    return aspi_sigma_by_quadrature(t, h + raise, s);
}

static double density_term(const void *context, double x, double y)
{
    return aspi_planar_density((const aspi_trial *)context, x, y);
}

static double slope_term(const void *context, double x, double y)
{
    const aspi_trial *t = (const aspi_trial *)context;
    asp_vec2 p = aspi_map_slope(&t->ndf->map, x, y);
    return asp_P22(t->ndf, p.x, p.y) * t->det;
}

typedef struct moment { const aspi_trial *t; int axis; } moment;

static double moment_term(const void *context, double x, double y)
{
    const moment *c = (const moment *)context;
    asp_vec2 p = aspi_map_slope(&c->t->ndf->map, x, y);
    return (c->axis ? p.y - c->t->ndf->map.ty : p.x - c->t->ndf->map.tx)
         * aspi_planar_density(c->t, x, y);
}

static const asp_vec3 above = { 0, 0, 1 };

double aspi_planar_mass(const aspi_trial *t)
{
    return aspi_planar_integral(t, above, density_term, t);
}

double aspi_planar_slope_mass(const aspi_trial *t)
{
    return aspi_planar_integral(t, above, slope_term, t);
}

double aspi_planar_moment(const aspi_trial *t, int axis)
{
    moment c;
    c.t = t;
    c.axis = axis;
    return aspi_planar_integral(t, above, moment_term, &c);
}

typedef struct visible { const aspi_trial *t; asp_vec3 w; } visible;

static double visible_term(const void *context, double x, double y)
{
    const visible *c = (const visible *)context;
    asp_vec2 p = aspi_map_slope(&c->t->ndf->map, x, y);
    asp_vec3 m = aspi_unit(-p.x, -p.y, 1);
    return asp_pdf_visible(c->t->ndf, c->w, m) * m.z * m.z * m.z * c->t->det;
}

double aspi_planar_visible(const aspi_trial *t, asp_vec3 w)
{
    visible c;
    c.t = t;
    c.w = w;
    return aspi_planar_integral(t, aspi_standard_vector(t->ndf, w), visible_term, &c);
}

/* Least and largest density within `lost` of a slope on either axis. */
void aspi_planar_bounds(const aspi_trial *t, double x, double y, double lost_x, double lost_y,
                        double *low, double *high)
{
    int i, j;
    *low = INFINITY;
    *high = 0;
    for (i = -1; i < 2; i++)
        for (j = -1; j < 2; j++) {
            double d = asp_P22(&t->standard, x + i * lost_x, y + j * lost_y);
            *low = fmin(*low, d);
            *high = fmax(*high, d);
        }
}
