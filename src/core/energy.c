/* energy.c - preparing the table of energy.h: directional albedos of single reflection */
#define ASP_PRECISION 64
#include "bsdf/bsdf.h"
#include "asperity/fresnel.h"
#include "bsdf/energy_at.h"

/* A view's albedo is the mean weight of its samples over a Fibonacci lattice in (u1, u2), bent by 3v^2 - 2v^3
 * so that the integrand is periodic: 233 points do what takes 2000 unbent ones. The kink of total
 * reflection takes more. */
typedef struct rule { size_t nodes, step; } rule;
static const rule coarse = { 233, 144 }, fine = { 377, 233 }, finest = { 1597, 987 };
#define SIZE 128

static double bent(double v, double *weight)
{
    *weight *= 6.0 * v * (1.0 - v);
    return v * v * (3.0 - 2.0 * v);
}

/* Point i of the lattice and its weight. */
static asp_vec2 node(const rule *r, size_t i, double *weight)
{
    asp_vec2 u;
    *weight = 1.0 / (double)r->nodes;
    u.x = bent(((double)i + 0.5) / (double)r->nodes, weight);
    u.y = bent(((double)(i * r->step % r->nodes) + 0.5) / (double)r->nodes, weight);
    return u;
}

static double albedo_of(const asp_material *lobe, asp_vec3 wi, const rule *rule)
{
    const size_t most = SIZE;
    double x[SIZE], y[SIZE], z[SIZE], u1[SIZE], u2[SIZE], by[SIZE], pdf[SIZE], r[SIZE], g[SIZE], b[SIZE], sum = 0.0;
    size_t i, start, size;
    for (start = 0; start < rule->nodes; start += SIZE) {
        asp_cvec3s in;
        asp_vec3s out;
        asp_rgbs weight;
        size = rule->nodes - start < most ? rule->nodes - start : most;
        for (i = 0; i < size; i++) {
            asp_vec2 u = node(rule, start + i, &by[i]);
            x[i] = wi.x;
            y[i] = wi.y;
            z[i] = wi.z;
            u1[i] = u.x;
            u2[i] = u.y;
        }
        in.x = out.x = x;
        in.y = out.y = y;
        in.z = out.z = z;
        weight.r = r;
        weight.g = g;
        weight.b = b;
        asp_sample_n(lobe, size, in, u1, u2, out, pdf, weight);
        for (i = 0; i < size; i++)
            sum += by[i] * r[i];
    }
    return sum;
}

/* Does the surface look the same from all azimuths? Data of the caller's need not. */
static int is_round(const asp_ndf *ndf)
{
    const asp_map *m = &ndf->map;
    double a = m->m00 * m->m00 + m->m01 * m->m01, c = m->m10 * m->m10 + m->m11 * m->m11;
    double b = m->m00 * m->m10 + m->m01 * m->m11;
    return !ndf->data && m->tx == 0.0 && m->ty == 0.0 && aspi_abs(a - c) <= 1e-12 * (a + c)
        && aspi_abs(b) <= 1e-12 * (a + c);
}

/* The cosine at t, and its derivative. */
static double cosine_at(double t, double *slope)
{
    double a = t * t, b = (1.0 - t) * (1.0 - t);
    *slope = 2.0 * t * (1.0 - t) / ((a + b) * (a + b));
    return a / (a + b);
}

/* The azimuth of a column: aspi_energy_turn by bisection; it rises, by less than a quarter of a turn off. */
static asp_vec2 azimuth_at(const double *energy, double turn)
{
    double low = turn - 0.25, high = turn + 0.25;
    int i;
    for (i = 0; i < 50; i++) {
        double middle = 0.5 * (low + high), off;
        asp_vec2 at = aspi_sincos2pi(middle);
        off = aspi_energy_turn(energy, at.x, at.y, 1.0) - turn;
        off = off < -0.5 ? off + 1.0 : off;
        if (off < 0.0)
            low = middle;
        else
            high = middle;
    }
    return aspi_sincos2pi(high);
}

/* The direction of azimuth u = at and aspi_energy_place's y: d by bisection, then w from (r u - t, 1), r how far the
 * mean slope is from that of a facet facing w. */
static asp_vec3 direction_at(const asp_ndf *ndf, const double *energy, asp_vec2 at, double y)
{
    const asp_map *m = &ndf->map;
    double vx = m->m00 * at.x + m->m10 * at.y, vy = m->m01 * at.x + m->m11 * at.y, v = aspi_sqrt(vx * vx + vy * vy);
    double top = aspi_sqrt(1.0 + m->tx * m->tx + m->ty * m->ty), bottom = -(m->tx * at.x + m->ty * at.y);
    double low = bottom, high = top, goal, r, c;
    int i;
    y = aspi_max(y, 1e-3);
    goal = aspi_energy_bend(bottom, v) * (1.0 - y * y) + energy[ENERGY_TOP] * y * y;
    for (i = 0; i < 60; i++) {
        double middle = 0.5 * (low + high);
        if (aspi_energy_bend(middle, v) < goal)
            low = middle;
        else
            high = middle;
    }
    r = 0.5 * (top - high) * (top + high) / aspi_max(high - bottom, 1e-9);
    at.x = r * at.x - m->tx;
    at.y = r * at.y - m->ty;
    c = 1.0 / aspi_sqrt(1.0 + at.x * at.x + at.y * at.y);
    return aspi_vector(at.x * c, at.y * c, c);
}

/* L and the last row's g, of the head of energy.h. */
static void bend_azimuths(double *energy, const asp_ndf *ndf)
{
    const asp_map *m = &ndf->map;
    double a = m->m00 * m->m00 + m->m01 * m->m01, c = m->m10 * m->m10 + m->m11 * m->m11;
    double b = m->m00 * m->m10 + m->m01 * m->m11, det = aspi_sqrt(aspi_max(a * c - b * b, 0.0));
    double most = aspi_sqrt(0.5 * (a + c) + aspi_sqrt(0.25 * (a - c) * (a - c) + b * b));
    double by = 1.0 / (most * aspi_sqrt(a + c + 2.0 * det));
    double across = aspi_sqrt(a * m->ty * m->ty + c * m->tx * m->tx - 2.0 * b * m->tx * m->ty);
    double skew = across > 0.0 ? 0.5 / across : 0.0;
    energy[ENERGY_BEND] = by * (a + det) + skew * m->tx * m->tx;
    energy[ENERGY_BEND + 1] = by * b + skew * m->tx * m->ty;
    energy[ENERGY_BEND + 2] = by * (c + det) + skew * m->ty * m->ty;
    energy[ENERGY_TOP] = aspi_energy_bend(aspi_sqrt(1.0 + m->tx * m->tx + m->ty * m->ty), det / most);
}

/* Mean of E against 2 cos dcos and over azimuth: Simpson's rule, four or eight steps a row. */
static double mean_of(const asp_material *lobe, const double *energy)
{
    int columns = (int)energy[ENERGY_COUNT], turns = columns > 1 ? energy[ENERGY_TURNS] > 1.0 ? 32 : 128 : 1, i, j;
    int n = (columns > 1 ? 4 : 8) * ((int)energy[ENERGY_HEIGHT] - 1);
    double sum = 0.0;
    for (j = 0; j < turns; j++) {
        asp_vec2 at = aspi_sincos2pi((double)j / (turns * energy[ENERGY_TURNS]));
        for (i = 0; i <= n; i++) {
            double slope, c = cosine_at((double)i / n, &slope), s = aspi_sqrt(1.0 - c * c);
            double f = 2.0 * c * slope * aspi_energy_at(lobe, energy, aspi_vector(s * at.x, s * at.y, c));
            sum += f * (i == 0 || i == n ? 1.0 : i & 1 ? 4.0 : 2.0);
        }
    }
    return sum / (3.0 * n * turns);
}

/* Reflected and refracted by each facet, which the sample of u3 = 0 shows, in their shares F and 1 - F. */
static double both_ways(const asp_material *glass, asp_vec3 wi, const rule *r)
{
    double eta = wi.z < 0.0 ? 1.0 / glass->c.r : glass->c.r, sum = 0.0, by;
    size_t i;
    for (i = 0; i < r->nodes; i++) {
        asp_vec2 u = node(r, i, &by);
        asp_bsdf_sample up = asp_sample_lobe(glass, wi, u.x, u.y, 0.0);
        asp_bsdf_sample down = asp_sample_lobe(glass, wi, u.x, u.y, 1.0 - 0x1p-53);
        double twice = 1.0 + wi.x * up.wo.x + wi.y * up.wo.y + wi.z * up.wo.z;
        double F = aspi_fresnel_dielectric(aspi_sqrt(aspi_max(0.5 * twice, 0.0)), eta);
        sum += by * (F * up.weight.r + (1.0 - F) * down.weight.r);
    }
    return sum;
}

/* The spread for which the mean of h spread/(cos^2 + spread) against 2 cos dcos, h spread log(1 + 1/spread), is that
 * of 1 - E, with h the loss at the horizon. */
static void fit_spread(double *energy)
{
    int rows = (int)energy[ENERGY_HEIGHT], columns = (int)energy[ENERGY_COUNT], i;
    double h = 1.0, low = -40.0, high = 7.0, mean, spread = 0.0;
    for (i = 0; i < columns; i++)
        h -= aspi_min(energy[i * rows], 1.0) / columns;
    mean = (1.0 - energy[ENERGY_MEAN]) / aspi_max(h, 1e-3);
    for (i = 0; i < 50; i++) {
        double middle = 0.5 * (low + high);
        spread = aspi_exp(middle);
        if (spread * aspi_log1p(1.0 / spread) < mean)
            low = middle;
        else
            high = middle;
    }
    energy[ENERGY_SPREAD] = spread;
    energy[ENERGY_SPREAD_LOG] = aspi_log1p(1.0 / spread);
}

typedef double albedo_function(const asp_material *lobe, asp_vec3 wi, const rule *r);

/* A table of one side, 1 outside and -1 inside; `kinked`: there is total reflection. */
static void fill(double *energy, const asp_material *lobe, albedo_function *albedo, double side, int kinked)
{
    const asp_map *map = &lobe->ndf.map;
    int round = is_round(&lobe->ndf), i, j;
    /* without a mean slope half a turn is as good as none */
    int turns = map->tx == 0.0 && map->ty == 0.0 && !lobe->ndf.data ? 2 : 1;
    int columns = round ? 1 : ENERGY_COLUMNS / turns, rows = round ? ENERGY_FINE : ENERGY_ROWS;
    const rule *r = kinked ? round ? &finest : &fine : round ? &fine : &coarse;
    energy[ENERGY_COUNT] = columns;
    bend_azimuths(energy, &lobe->ndf);
    for (j = 0; j < columns; j++) {
        double *e = energy + j * rows;
        asp_vec2 at = azimuth_at(energy, (double)j / (columns * turns));
        for (i = 0; i < rows; i++) {
            double slope, c = cosine_at(aspi_max((double)i / (rows - 1), 1e-3), &slope);
            asp_vec3 w = round ? aspi_vector(aspi_sqrt(1.0 - c * c), 0.0, c)
                       : direction_at(&lobe->ndf, energy, at, (double)i / (rows - 1));
            e[i] = albedo(lobe, aspi_vector(side * w.x, side * w.y, side * w.z), r)
                 / aspi_energy_masked(&lobe->ndf, w, lobe->mask);
        }
    }
    energy[ENERGY_HEIGHT] = rows;
    energy[ENERGY_TURNS] = turns;
    energy[ENERGY_MEAN] = mean_of(lobe, energy);
    fit_spread(energy);
}

void aspi_energy_prepare(asp_material *out)
{
    asp_material lobe = asp_mirror(&out->ndf, out->mask);
    lobe.fresnel = out->fresnel;
    lobe.c = out->c;
    lobe.d = out->d;
    memcpy(lobe.energy + ENERGY_FILM, out->energy + ENERGY_FILM, 3 * ENERGY_FILM_NODES * sizeof(double));
    fill(out->energy, &lobe, albedo_of, 1.0, 0);
}

void aspi_energy_prepare_sides(asp_material *out)
{
    asp_material glass = asp_dielectric(&out->ndf, out->c.r, 0, ASP_IMPORTANCE, out->mask);
    fill(out->energy, &glass, both_ways, 1.0, out->c.r < 1.0);
    fill(out->energy + ENERGY_INSIDE, &glass, both_ways, -1.0, out->c.r > 1.0);
}
