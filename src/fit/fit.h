/* fit.h - what the files of the fit share; nothing outside src/fit sees it
 *
 *   geometries.c   which geometries of a measurement are used
 *   loss_*.c       one loss each; losses.c the table of them
 *   box.c          parameters as numbers in [0, 1], and back
 *   problem.c      model over geometries, residuals, colours by non-negative least squares
 *   optimise.c     Levenberg-Marquardt over the box, reweighting, ends of ranges
 *   simplex.c      the last steps for absolute differences, and distances between distributions
 *   starts.c       where the searches begin
 *   uncertainty.c  covariance at the optimum
 *   fit.c          the public call */
#ifndef ASPI_FIT_H
#define ASPI_FIT_H

#include "asperity_data.h"
#include "asperity_ndf.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>

#define ASPI_INV_PI 0.31830988618379067154

#define DIFFUSE_HIGH 1.0               /* a diffuse base returns no more than it receives */

/* ---- geometries as arrays */

typedef struct aspi_fit_set {
    size_t  n;
    int     channels;                            /* 1: the same three times */
    double *memory;                              /* owns all below */
    double *wi_x, *wi_y, *wi_z, *wo_x, *wo_y, *wo_z;
    double *cos_d;                               /* between wi and the half vector */
    double *data[3];
    double *weight;                              /* of the loss, see aspi_loss */
} aspi_fit_set;

/* Every `stride`-th of the geometries. */
asp_status aspi_fit_set_make(const asp_measurement *item, size_t count, size_t stride, int channels,
                             aspi_fit_set *out, asp_error *err);
void aspi_fit_set_free(aspi_fit_set *set);

/* ---- losses: sum over geometries and channels of |residual|^power, then an error of it */

typedef struct aspi_loss {
    asp_loss about;
    int power;                                   /* 1: absolute, 2: squared */
    int linear;                                  /* 1: residuals are linear in the model */
    /* Residuals of n geometries of one channel and their derivatives by the model (NULL: not
     * wanted). `weight` is what `prepare` wrote. */
    void (*residual)(size_t n, const double *model, const double *data, const double *weight,
                     double *r, double *slope);
    /* The weight of a geometry. */
    double (*weight)(double cos_i, double cos_o);
    /* What the sum is divided by, from all data of one channel; power 2: a count. */
    double (*scale)(size_t n, const double *data, const double *weight);
} aspi_loss;

extern const aspi_loss aspi_loss_nad, aspi_loss_log, aspi_loss_relative;
extern const aspi_loss *const aspi_losses[];     /* ends with NULL */
const aspi_loss *aspi_find_loss(const char *name);
void aspi_fit_set_weights(aspi_fit_set *set, const aspi_loss *loss);
double aspi_loss_count(size_t n, const double *data, const double *weight);

/* ---- the box: alpha, the shape numbers, eta, each as b in [0, 1] along a smooth scale. Where the
 * shape numbers carry the roughness (own_scale) there is no alpha, and the map's stays 1; the first
 * of them then takes its place: the longest axis, and the one along which starts are dense. */

#define ASPI_AXES (ASP_SHAPE_NUMBERS + 2)

typedef enum aspi_scale { ASPI_SCALE_LINEAR, ASPI_SCALE_LOG, ASPI_SCALE_INVERSE } aspi_scale;

typedef struct aspi_axis {
    const char *name;
    aspi_scale  scale;
    double low, high;                            /* b = 0 and b = 1, except for INVERSE */
    double turn;                                 /* INVERSE: low + turn lies at b = 1/2 */
    double b_low, b_high;                        /* the ends that can be evaluated */
} aspi_axis;

typedef struct aspi_box {
    int n;
    int shape;                                   /* where the shape numbers begin: 1, or 0 without alpha */
    aspi_axis axis[ASPI_AXES];
} aspi_box;

aspi_box aspi_box_make(const asp_model *model);
double aspi_axis_value(const aspi_axis *axis, double b);
double aspi_axis_place(const aspi_axis *axis, double value);    /* clamped to the ends */

/* ---- a point of the search */

typedef struct aspi_point {
    double b[ASPI_AXES];
    double colour[6];                            /* diffuse r g b, specular r g b */
    double loss;                                 /* the sum, not the error */
} aspi_point;

typedef struct aspi_problem {
    const asp_model *model;
    const aspi_loss *loss;
    const aspi_fit_set *set;
    aspi_box box;
    int      mask;
    double   specular_high;
    double  *memory;
    double  *facets;                             /* D G2 / (4 cos cos) at the last alpha and shape */
    double  *specular;                           /* the same times F at the last eta */
    double  *fit, *residual, *slope;             /* n each: of the channel at work */
    double  *irls;                               /* 3 n: weights of the reweighted squares */
    double *scratch;                             /* 2 n */
    double   last[ASPI_AXES];                    /* where facets and specular belong; NaN: nowhere */
    size_t   evaluations;
} aspi_problem;

asp_status aspi_problem_make(const asp_model *model, const aspi_loss *loss, const aspi_fit_set *set,
                             const asp_fit_options *options, aspi_problem *out, asp_error *err);
void aspi_problem_free(aspi_problem *p);

/* Brings facets and specular to the place b; 0 when the distribution cannot be made there. */
int aspi_problem_move(aspi_problem *p, const double *b);
/* The distribution at b. */
asp_status aspi_problem_ndf(const aspi_problem *p, const double *b, asp_ndf *out);
/* The loss of a point as it is. Infinite where it cannot be evaluated. */
double aspi_problem_loss(aspi_problem *p, const aspi_point *at);
/* Improves the colours of a point (those it has are the start) and sets its loss. */
void aspi_problem_colours(aspi_problem *p, aspi_point *at, int rounds);
/* The same for the squares weighted by p->irls, and the 3 n weighted residuals; for optimise.c. */
void aspi_problem_weighted(aspi_problem *p, aspi_point *at, double *residuals);
/* Sets irls from the residuals at a point: 1 for squares; `soften` times the median of |r| is where
 * 1/|r| is cut off. Returns the median. */
double aspi_problem_reweight(aspi_problem *p, const aspi_point *at, double soften);

/* ---- searching */

typedef struct aspi_search {
    aspi_problem *problem;
    asp_fit_reason reason;                       /* of the last polish */
    int (*cancelled)(void *context);             /* asked now and then; NULL: never */
    void *context;
    int   stopped;                               /* 1: cancelled said so */
} aspi_search;

/* Moves a point downhill along the axes with free[i] != 0 (NULL: all); never makes its loss worse.
 * `rounds`: how often absolute differences are reweighted at most. ASP_ENOMEM, ASP_ECANCELLED. */
asp_status aspi_polish(aspi_search *search, aspi_point *at, const int *free_axes, int rounds,
                       asp_error *err);
/* A simplex goes down from a point whose loss is known, along some of the axes of a box. */
typedef struct aspi_descent {
    const aspi_axis *box;
    const int *axis;                             /* those that are free, */
    int    n, calls;                             /* how many, and evaluations for each of them at most */
    double size, flat;                           /* of the first simplex, in b; relative spread to stop at */
    void (*evaluate)(void *context, aspi_point *at);   /* sets the loss */
    int  (*cancelled)(void *context);            /* NULL: never */
    void  *context;
} aspi_descent;
typedef enum aspi_rest { ASPI_FLAT, ASPI_STEEP, ASPI_CANCELLED } aspi_rest;
aspi_rest aspi_descend(const aspi_descent *how, aspi_point *at);
/* Absolute differences to the end; `flat` says whether it came to rest. */
asp_status aspi_simplex(aspi_search *search, aspi_point *at, const int *free_axes, int *flat,
                        asp_error *err);
/* Tries the very ends of ranges that the point has come close to. */
asp_status aspi_try_ends(aspi_search *search, aspi_point *at, int rounds, asp_error *err);

/* Fills up to `limit` points to start from, best first, evaluated in the problem; *found says how
 * many. ASP_ENOMEM, ASP_ECANCELLED. */
asp_status aspi_starts(aspi_search *search, uint64_t seed, size_t limit, aspi_point *out,
                       size_t *found, asp_error *err);
/* The optimum of another model as seen by this one: the same alpha, eta and colours, at the shape
 * (all whole numbers, ends and defaults are tried) that fits best. Both have an alpha. */
aspi_point aspi_translate(aspi_search *search, const aspi_box *from, const aspi_point *optimum);

/* Fills parameter[], parameter_count and correlation[] of a result. ASP_ENOMEM. */
asp_status aspi_uncertainties(aspi_problem *p, const aspi_point *at, asp_fit_result *out,
                              asp_error *err);

#endif
