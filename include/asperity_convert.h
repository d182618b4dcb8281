/* asperity_convert.h - roughness as other systems count it, moments of slopes, filtering
 *
 *   1  Conventions    disney:roughness=0.5,anisotropic=0.3 and the like, to alpha and back
 *   2  Moments        E[p] and E[p p^T], which LEAN and LEADR mapping filter
 *   3  Filtering      sums and averages of distributions as one distribution
 *
 * Part of the core: no allocation, no state. docs/conversions.md has examples and errors in numbers. */
#ifndef ASPERITY_CONVERT_H
#define ASPERITY_CONVERT_H

#include "asperity.h"
#include "asperity_ndf.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------ 1  Conventions
 *
 * Roughness as other systems count it. A convention is a few named numbers, e.g. roughness and
 * anisotropic, and two closed formulas. */

#define ASP_CONVENTION_NUMBERS 4

typedef struct asp_convention {
    const char *name, *alias;            /* alias may be NULL */
    const char *title;                   /* who counts so */
    const char *formula, *inverse;       /* to alpha, and back, in words */
    const char *source;
    const asp_param *params;             /* its numbers, in this order everywhere below */
    size_t param_count;                  /* at most ASP_CONVENTION_NUMBERS */
    void (*to_alpha)(const double *numbers, asp_roughness *out);
    void (*from_alpha)(const asp_roughness *in, double *numbers);
} asp_convention;

const asp_convention *const *asp_conventions(void);                 /* ends with NULL */
const asp_convention *asp_find_convention(const char *name);        /* name or alias; NULL if none */

/* Its numbers to alpha_x, alpha_y and rotation, mean slope 0. ASP_EINVAL: a number or an alpha is
 * out of range; it is named. */
asp_status asp_convention_to_alpha(const asp_convention *convention, const double *numbers,
                                   asp_roughness *out, asp_error *err);

/* And back. ASP_EINVAL when the convention cannot say it: a number would leave its range (named),
 * anisotropy or a mean slope where it has no number for them. Going there and back gives the same
 * alphas to 1e-12 of the larger. */
asp_status asp_convention_from_alpha(const asp_convention *convention, const asp_roughness *in,
                                     double *numbers, asp_error *err);

/* `disney:roughness=0.5,anisotropic=0.3`: which convention, and the roughness. */
asp_status asp_convention_parse(const char *spec, const asp_convention **which, asp_roughness *out,
                                asp_error *err);

/* ------------------------------------------------------------------ 2  Moments of slopes
 *
 * E[p] and E[p p^T]: what LEAN mapping (Olano, Baker 2010) and LEADR mapping (Dupuy et al. 2013)
 * average over texels. LEAN's B is m.xy/m.z, that is -mean here; its M is the same. */
typedef struct asp_moments { double mean_x, mean_y, xx, xy, yy; } asp_moments;

/* Of a distribution: mean slope t, E[p p^T] = V M M^T + t t^T with V the variance of the standard
 * surface: 1/2 for Beckmann, (gamma - 1)/(2 (gamma - 2)) for Student's t, to 1e-12; others by
 * quadrature. ASP_EINVAL where it is infinite (ggx; student_t with gamma <= 2; any density that is
 * not 0 at the horizon, unless it adds less than 1e-16 up to a slope of 1e75). */
asp_status asp_ndf_moments(const asp_ndf *ndf, asp_moments *out, asp_error *err);

/* Of n normals, e.g. the texels of a normal map; weight NULL: equal. ASP_EINVAL: m.z <= 0, a weight
 * that is negative, their sum 0. Normals need not be unit vectors. */
asp_status asp_normals_moments(size_t n, asp_cvec3s m, const double *weight, asp_moments *out,
                               asp_error *err);

/* The slope map through which a model (shape: NULL for the defaults) has these moments. ASP_EINVAL:
 * the model's are infinite; E[p p^T] - E[p] E[p]^T is not positive definite. */
asp_status asp_map_from_moments(const asp_model *model, const double *shape, const asp_moments *in,
                                asp_map *out, asp_error *err);

/* ------------------------------------------------------------------ 3  Many distributions seen as one
 *
 * The result is a distribution of `model` with `shape` (NULL: its defaults) through the slope map
 * that has the mean slope of the whole and matches, by `match`, */
typedef enum asp_match {
    ASP_MATCH_AUTO = 0,   /* covariance where it is finite for all that take part, else area */
    ASP_MATCH_COVARIANCE, /* the covariance of slopes, as LEAN and LEADR mapping do */
    ASP_MATCH_AREA        /* E|u.(p - mean)| along all directions u: twice the projected area seen
                             from the horizon of the mean plane, which every distribution here has
                             (GGX's covariance is infinite). Along all u to least squares of its
                             square for an average, exact along two conjugate axes for a sum */
} asp_match;

/* The slopes of two independent surfaces added, p = p1 + p2: their slope densities convolved.
 * Beckmann and Beckmann make Beckmann, exactly. The rest keeps what is matched, see
 * docs/conversions.md for how far D is off. */
asp_status asp_ndf_sum(const asp_ndf *a, const asp_ndf *b, const asp_model *model,
                       const double *shape, asp_match match, asp_ndf *out, asp_error *err);

/* The weighted mean of n distributions, side by side (NULL: equal weights): their covariance is the
 * mean of the covariances within and that of the mean slopes between. */
asp_status asp_ndf_average(size_t n, const asp_ndf *const *parts, const double *weight,
                           const asp_model *model, const double *shape, asp_match match,
                           asp_ndf *out, asp_error *err);

/* One roughness under n facets of a normal map: the mean of `base` with each slope added in turn.
 * ASP_EINVAL for these three: sizes and weights as above, an infinite covariance where it is asked
 * for, a result rougher or smoother than a slope map can be. */
asp_status asp_ndf_footprint(const asp_ndf *base, size_t n, const double *slope_x,
                             const double *slope_y, const double *weight, const asp_model *model,
                             const double *shape, asp_match match, asp_ndf *out, asp_error *err);

#ifdef __cplusplus
}
#endif
#endif
