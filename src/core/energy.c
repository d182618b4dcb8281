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

/* Mean of E against 2 cos dcos and over azimuth: Simpson's rule, eight steps a row; columns have equal
 * shares unless masking has kinks between them. */
static double mean_of(const asp_material *lobe, const double *energy)
{
    int skewed = lobe->ndf.map.tx != 0.0 || lobe->ndf.map.ty != 0.0;
    int n = 8 * ((int)energy[ENERGY_HEIGHT] - 1), turns = skewed ? 8 * ENERGY_COLUMNS : (int)energy[ENERGY_COUNT], i, j;
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
    for (j = 0; j < columns; j++) {
        double *e = energy + j * rows;
        asp_vec2 at = aspi_sincos2pi((double)j / (columns * turns));
        for (i = 0; i < rows; i++) {
            double slope, c = cosine_at(aspi_max((double)i / (rows - 1), 1e-3), &slope);
            double s = aspi_sqrt(1.0 - c * c);
            asp_vec3 w = aspi_vector(s * at.x, s * at.y, c);
            e[i] = albedo(lobe, aspi_vector(side * w.x, side * w.y, side * w.z), r) / aspi_energy_masked(&lobe->ndf, w, lobe->mask);
        }
    }
    energy[ENERGY_COUNT] = columns;
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
