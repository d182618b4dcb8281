/* prepared_make.h - what the files that prepare a surface share
 *
 * prepared.c: splines, aspi_prepared_make; prepared_panels.c: integrals over the radius; prepared_area.c: the
 * tables of the projected area; prepared_sight.c: what is seen from below; prepared_rows.c, prepared_views.c:
 * tables of the samplers. All that costs time goes over arrays. */
#ifndef ASPI_PREPARED_MAKE_H
#define ASPI_PREPARED_MAKE_H

#include "ndf/prepared.h"

#define ASP_PRECISION 64
#include "asperity/number.h"

/* The density under preparation. */
typedef struct prepared_source {
    const asp_ndf *k;
    aspi_log_density *f;
    double log_mass;             /* of e^f */
    double at;                   /* log r of the largest ring, */
    double low, high;            /* below which there is nothing, above which P22 is a power */
} prepared_source;

typedef void prepared_integrand(const void *context, size_t n, const double *t, double *out);

#define PREPARED_PANELS 512

typedef struct prepared_panels {
    int count;
    double edge[PREPARED_PANELS + 1];        /* log of the radius */
    double value[PREPARED_PANELS + 1];       /* integrand there, per unit of the logarithm */
    double mass[PREPARED_PANELS];
    double below[PREPARED_PANELS + 1], beyond[PREPARED_PANELS + 1];   /* cumulated */
} prepared_panels;

void aspi_prepared_logs(const prepared_source *s, size_t n, const double *r2, double *out);
double aspi_prepared_log(const prepared_source *s, double r2);
/* The same at r = e^t. */
void aspi_prepared_along(const prepared_source *s, size_t n, const double *t, double *out);
/* About the largest logarithm from a radius on. */
double aspi_prepared_base(const prepared_source *s, double radius);

/* Coefficients, divided by 6, of the cubic B-spline on n cells of width h with values y[0 ... n],
 * y[j] = value[j step], and slopes d0, d1 at the ends: out[0 ... n + 2], out_step apart. */
void aspi_prepared_spline(int n, double h, const double *value, int step, double d0, double d1, double *out,
                          int out_step);
/* Slope at the first of five equidistant values, one cell apart; step < 0 looks back, and the slope
 * is then that of the way back. */
double aspi_prepared_end_slope(const double *y, int step);

/* From t = `low`, below which the integrand is radius^power, up to where less than `least` of the sum is left or
 * t = high; there the integrand goes on as a power of the radius. */
void aspi_prepared_integrate(prepared_integrand *g, const void *context, double low, double power, double high,
                             double longest, double least, prepared_panels *out);
/* log of the radii where -log of the share beyond is rho[0 ... n - 1], growing; n up to PREPARED_SHARES. */
#define PREPARED_SHARES 256
void aspi_prepared_radii(const prepared_panels *p, prepared_integrand *g, const void *context, int n,
                         const double *rho, double *out);
/* r^2 P22 2 pi: mass per unit of t = log r; `context` is the source. */
void aspi_prepared_ring(const void *context, size_t n, const double *t, double *out);
/* The panels of all slopes. */
void aspi_prepared_rings(const prepared_source *s, prepared_panels *out);

/* The trapezoidal rule in log rho converges fast where the density is smooth; bent ones take a finer step. */
#define PREPARED_STEP 0.2
#define PREPARED_FINER 4
ASP_FN int aspi_prepared_bent(const prepared_source *s) { return s->k->table[PREPARED_IS_BENT] > 0; }
ASP_FN int aspi_prepared_finer(const prepared_source *s) { return aspi_prepared_bent(s) ? PREPARED_FINER : 1; }

/* 1 - atan(x)/x for z = x^2, |x| < 0.1. */
ASP_FN double aspi_prepared_near(double z)
{
    return z * (1.0 / 3 - z * (1.0 / 5 - z * (1.0 / 7 - z * (1.0 / 9 - z / 11))));
}

/* Integral of P22 r^power over log r: the mass is 2 pi times that of power 2, J(0) twice that of 3. */
double aspi_prepared_moment(const prepared_source *s, int power);
/* Of tables by pieces: where piece i ends, counted from the octave that a table begins with; point i of the seven at
 * which a piece from y0 to y1 is looked at, Chebyshev's of the second kind, both ends included, so that neighbours
 * meet; and piece i from the values there, the polynomial through them in powers of y - center. */
double aspi_prepared_half_octave(int octave, int i);
double aspi_prepared_node(double y0, double y1, int i);
void aspi_prepared_piece_put(const double *y, const double *value, double center, double *table, int i);
/* AREA and DEEP. */
void aspi_prepared_area_tables(const prepared_source *s, double t0, double *table);
/* r^2 P22 of slopes sqrt(mu^2 + eta^2) seen from below by a view of slope mu, eta (eta - mu atan(eta/mu)) P22 of
 * eta, per unit of t = log eta and of e^base. */
typedef struct prepared_sight {
    const prepared_source *s;
    double mu, base;
} prepared_sight;

prepared_sight aspi_prepared_sight(const prepared_source *s, double mu);
void aspi_prepared_seen(const void *sight, size_t n, const double *t, double *out);
void aspi_prepared_sight_panels(const prepared_sight *sight, double t0, double longest, double least,
                               prepared_panels *out);
/* -log of the share beyond at t = log(within/beyond). */
double aspi_prepared_rho(double t);

/* NORMAL. */
void aspi_prepared_normal_table(const prepared_source *s, double *table);
#define PREPARED_VIEWS_MOST 32   /* cells between rows, */
#define PREPARED_CELLS_MOST 52   /* and within them */
/* VIEWS; mu of every row of TAIL. */
void aspi_prepared_views(const prepared_source *s, double t0, double *table, double mu[PREPARED_VIEWS_MOST + 1]);
/* TAIL. */
void aspi_prepared_tail_table(const prepared_source *s, double t0, const double *mu, double *table);

#endif
