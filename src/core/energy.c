/* energy.c - preparing the table of energy.h: directional albedos of single reflection */
#define ASP_PRECISION 64
#include "bsdf/bsdf.h"
#include "bsdf/energy_at.h"

/* A Fibonacci lattice in (u1, u2); a view's albedo is the mean weight of its samples. */
#define NODES 610
#define STEP 377
#define NODES_TURNED 233     /* for each of several azimuths */
#define STEP_TURNED 144
#define SIZE 128

static double albedo_of(const asp_material *lobe, asp_vec3 wi, size_t nodes, size_t step)
{
    const size_t most = SIZE;
    double x[SIZE], y[SIZE], z[SIZE], u1[SIZE], u2[SIZE], pdf[SIZE], r[SIZE], g[SIZE], b[SIZE], sum = 0.0;
    size_t i, start, size;
    for (start = 0; start < nodes; start += SIZE) {
        asp_cvec3s in;
        asp_vec3s out;
        asp_rgbs weight;
        size = nodes - start < most ? nodes - start : most;
        for (i = 0; i < size; i++) {
            size_t k = start + i;
            x[i] = wi.x;
            y[i] = wi.y;
            z[i] = wi.z;
            u1[i] = ((double)k + 0.5) / (double)nodes;
            u2[i] = (double)(k * step % nodes) / (double)nodes;
        }
        in.x = out.x = x;
        in.y = out.y = y;
        in.z = out.z = z;
        weight.r = r;
        weight.g = g;
        weight.b = b;
        asp_sample_n(lobe, size, in, u1, u2, out, pdf, weight);
        for (i = 0; i < size; i++)
            sum += r[i];
    }
    return sum / (double)nodes;
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

/* Mean of a column against 2 cos dcos = 4 t^3 dt: Simpson's rule on the cubics, eight steps a row. */
static double column_mean(const double *e)
{
    double sum = 0.0;
    int i, n = 8 * (ENERGY_ROWS - 1);
    for (i = 0; i <= n; i++) {
        double t = (double)i / n, f = 4.0 * t * t * t * aspi_energy_row(e, t * (ENERGY_ROWS - 1));
        sum += f * (i == 0 || i == n ? 1.0 : i & 1 ? 4.0 : 2.0);
    }
    return sum / (3.0 * n);
}

void aspi_energy_prepare(asp_material *out)
{
    asp_material lobe = asp_mirror(&out->ndf, out->mask);
    int columns = is_round(&out->ndf) ? 1 : ENERGY_COLUMNS, i, j;
    /* without a mean slope half a turn is as good as none */
    int turns = out->ndf.map.tx == 0.0 && out->ndf.map.ty == 0.0 && !out->ndf.data ? 2 : 1;
    double mean = 0.0;
    lobe.fresnel = out->fresnel;
    lobe.c = out->c;
    lobe.d = out->d;
    memcpy(lobe.energy + ENERGY_FILM, out->energy + ENERGY_FILM, 3 * ENERGY_FILM_NODES * sizeof(double));
    for (j = 0; j < columns; j++) {
        double *e = out->energy + j * ENERGY_ROWS;
        asp_vec2 at = aspi_sincos2pi((double)j / (columns * turns));
        for (i = 0; i < ENERGY_ROWS; i++) {
            double t = aspi_max((double)i / (ENERGY_ROWS - 1), 1e-3), c = t * t;
            double s = aspi_sqrt(1.0 - c * c);
            asp_vec3 wi;
            wi.x = s * at.x;
            wi.y = s * at.y;
            wi.z = c;
            e[i] = columns == 1 ? albedo_of(&lobe, wi, NODES, STEP)
                                : albedo_of(&lobe, wi, NODES_TURNED, STEP_TURNED);
        }
        mean += column_mean(e) / columns;
    }
    out->energy[ENERGY_MEAN] = mean;
    out->energy[ENERGY_COUNT] = columns;
    out->energy[ENERGY_TURNS] = turns;
}
