/* asperity_data.h - measured data, height fields and fitting
 *
 *   1  Errors as text
 *   2  Measurements   read, evaluate, write: MERL, RGL, CSV
 *   3  Height fields  make, read, slopes; the fabricated measurement
 *   4  Fitting        distributions fitted to a measurement
 *   5  Laws           what every distribution must obey, checked
 *   6  Families       the nearest distribution of another model
 *
 * Everything here may allocate and do file I/O; nothing prints or exits. Handles are freed by their
 * _free function, which takes NULL. A finished handle is read-only: any number of threads may
 * evaluate it. */
#ifndef ASPERITY_DATA_H
#define ASPERITY_DATA_H

#include "asperity.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------ 1  Errors as text */

/* One line, e.g. `chm.bsdf: byte 219: field 'rgb': shape says 1x8x3x32x32 at byte 559616, the file
 * ends at byte 4096` or `alpha = -1 is outside [1e-05, 100]`. Always terminated; returns buffer. */
const char *asp_error_text(const asp_error *err, char *buffer, size_t size);

/* ------------------------------------------------------------------ 2  Measurements */

/* A measured BRDF, isotropic or anisotropic, RGB (a one-channel file fills all three). */
typedef struct asp_measured asp_measured;

/* One measured geometry, both directions above the horizon. f in 1/sr without the cosine, per
 * channel, not negative. */
typedef struct asp_measurement { asp_vec3 wi, wo; asp_rgb f; } asp_measurement;

typedef struct asp_measured_info {
    const char *format;        /* "merl", "rgl", "csv", "cornell", "lumos" */
    const char *description;   /* what the file says of itself, and after a "; " how many of its rows
                                  were left out (csv) or values read as 0 (rgl); "" if nothing */
    int    isotropic;          /* 1: depends on the azimuth difference only, as far as the file tells */
    int    scattered;          /* 1: only listed geometries are known (eval interpolates nothing) */
    int    channels;           /* 1 or 3 in the file */
    size_t samples;            /* stored values or geometries */
} asp_measured_info;

/* Reads a measurement; the format is recognised by content, not by name:
 *     merl      the MERL database's table of 90 x 90 x 180 bins (Matusik et al. 2003)
 *     rgl       RGB tensor files of the RGL database, isotropic or not (Dupuy, Jakob 2018)
 *     csv       rows of text whose columns have names: theta_i, phi_i, theta_o, phi_o in radians or
 *               with the suffix _deg; or wi_x, wi_y, wi_z, wo_x, wo_y, wo_z; or theta_h, theta_d,
 *               phi_d (phi_h); or theta_h_index, theta_d_index, phi_d_index, the bins of merl; and
 *               f or r, g, b. Separated by commas, semicolons or blanks; # starts a comment, and a
 *               comment may give what all rows share: `# phi_d = 90 deg`, `# isotropic = 1`
 *     cornell   spectra of the Cornell gonioreflectometer, 31 bands, as linear sRGB under D65
 *     lumos     `# phi_in theta_in phi_out theta_out brdf`, in degrees, phi the zenith
 * Negative values mean `no value`: such rows are left out, and rows with a direction at the horizon.
 * NULL on failure with err filled: file, byte or line, field or column, what was expected
 * (ASP_EIO, ASP_EFORMAT, ASP_EPARSE, ASP_ENOMEM). Allocates at most a small multiple of the file's
 * size. */
asp_measured *asp_measured_read(const char *path, asp_error *err);
/* The same from memory; `name` is used in errors. The bytes are not kept. */
asp_measured *asp_measured_read_memory(const void *bytes, size_t size, const char *name,
                                       asp_error *err);
void asp_measured_free(asp_measured *measured);
asp_measured_info asp_measured_get_info(const asp_measured *measured);

/* f at a pair of directions, 0 below the horizon and where nothing is known; a NaN goes out as NaN.
 * merl: linear between bin centres in sqrt(theta_h), theta_d and phi_d, over the bins that have a
 * value (the database's own reader takes the nearest bin). rgl: as the database's loader, negative
 * channels clipped at 0. Lists: the nearest geometry in half and difference angles; use the
 * geometries themselves to fit. */
asp_rgb asp_measured_eval(const asp_measured *measured, asp_vec3 wi, asp_vec3 wo);

/* The listed geometries of scattered data, NULL and 0 for gridded data. */
const asp_measurement *asp_measured_geometries(const asp_measured *measured, size_t *count);

/* Writers. Each writes to a temporary name beside `path` and renames it when complete: on failure
 * (ASP_EIO) `path` is as it was. merl: the table of doubles (35 MB) with the database's channel
 * scales; other kinds are evaluated at the bin centres, with the half vector at azimuth 0: the table
 * holds isotropic BRDFs, look at asp_measured_info first. csv: a table by bin index (110 MB), which
 * gives the same table back bit for bit where long double is wider than double, else to one unit in
 * the last place; a list as unit vectors, exact too; rgl sampled on a grid of half and difference
 * angles (45 x 18 x 24, times 12 azimuths if anisotropic). */
asp_status asp_measured_write_merl(const asp_measured *measured, const char *path, asp_error *err);
asp_status asp_measured_write_csv(const asp_measured *measured, const char *path, asp_error *err);

/* Builds a gridded measurement in MERL's parametrisation from a function (a model, say), called at
 * the bin centres with both directions above the horizon, or from 3 x 90 x 90 x 180 values of f
 * ordered [channel][theta_h][theta_d][phi_d]; negative = missing. Values above 1e26, infinite or NaN
 * are refused (ASP_EINVAL, the bin is named). description may be NULL. f is held to one rounding. */
typedef asp_rgb asp_brdf_function(const void *context, asp_vec3 wi, asp_vec3 wo);
asp_measured *asp_measured_from_function(asp_brdf_function *f, const void *context,
                                         const char *description, asp_error *err);
asp_measured *asp_measured_from_merl_table(const double *values, const char *description,
                                           asp_error *err);

/* ------------------------------------------------------------------ 3  Height fields
 *
 * Explicit rough surfaces: made with known statistics or read from an instrument, their slopes, and
 * a virtual gonioreflectometer that traces rays against one and writes down what comes back. */

/* Called now and then by long work, always on the thread that called, with the share done in [0, 1].
 * Nonzero cancels: the work ends with ASP_ECANCELLED. */
typedef int asp_progress(void *context, double done);

/* Heights over a grid of nx x ny points, row-major, ny rows of nx (x runs fastest), in the length
 * unit of the spacing. NaN: not measured. A facet is a triangle: each square of four points is cut
 * along a diagonal that alternates like a chessboard. */
typedef struct asp_height_field {
    int    nx, ny;
    double dx, dy;
    int    periodic;      /* 1: point nx is point 0 again, and the same in y */
    float *heights;       /* owned; released by asp_height_field_free */
} asp_height_field;

/* What to make. The facets' slopes then have, per unit flat area, the density
 * P22(p) = (1 + |p|^2/((gamma - 1) alpha^2))^-gamma / (pi alpha^2), which is the model `student_t`;
 * gamma = infinity: exp(-|p|^2/alpha^2) / (pi alpha^2), `beckmann`. */
typedef struct asp_surface_recipe {
    uint64_t seed;
    int    size;          /* points per side: a power of two, [64, 4096] */
    double correlation;   /* where the height correlation exp(-r^2/c^2) falls to 1/e, in grid steps,
                             [2, size/8] */
    double patch;         /* the same for the local roughness, in correlation lengths, [1, 64], and
                             correlation * patch <= size/4. Of no effect for gamma = infinity */
    double alpha;         /* [1e-3, 1] */
    double gamma;         /* [1.6, infinity] */
} asp_surface_recipe;

/* seed 1, 1024 points, correlation 4, patch 8, alpha 0.2, gamma 3. */
asp_surface_recipe asp_surface_recipe_default(void);

/* Makes an isotropic, periodic height field with dx = dy = 1. Same recipe, same heights.
 * gamma = infinity: a Gaussian process by spectral synthesis, scaled so that the facets' rms slope
 * is alpha/sqrt(2) along x and y. Finite gamma: the same process times a slowly varying local
 * roughness whose square follows the inverse gamma distribution of shape gamma - 1 exactly, each
 * quantile on an equal area; its slow change adds about (0.5/patch)^2 to the slope variance.
 * ASP_EINVAL (the recipe's member is named), ASP_ENOMEM. On failure *out is untouched. */
asp_status asp_height_field_make(const asp_surface_recipe *recipe, asp_height_field *out,
                                 asp_error *err);

/* Reads a measured height field, not periodic. Format f32: raw little-endian float32 in rows of x,
 * with a text file of `key=value` lines beside it (<name>.meta.txt for <name>.f32: nx, ny, dx_um,
 * dy_um, height_unit=um); heights and spacing in micrometres.
 * ASP_EIO, ASP_EFORMAT, ASP_EUNKNOWN (a name that ends in no known format), ASP_ENOMEM. */
asp_status asp_height_field_read(const char *path, asp_height_field *out, asp_error *err);
void asp_height_field_free(asp_height_field *field);      /* takes NULL; clears *field */

/* The slopes of the facets, each weighted by its flat area; facets with a NaN corner are left out. */
typedef struct asp_slope_statistics {
    size_t facets;
    double mean_x, mean_y;
    double rms_x, rms_y;        /* about the mean */
    double correlation;         /* between the two, [-1, 1] */
    /* Maximum likelihood of the radial families over |p - mean|, and the mean log-likelihood per
     * facet that each reaches. gamma is capped at 100, which stands for infinity. */
    double alpha, gamma;        double log_student;
    double alpha_ggx;           double log_ggx;         /* gamma = 2 */
    double alpha_beckmann;      double log_beckmann;    /* the rms of |p - mean| */
    double P22[90];             /* measured density of slopes, averaged over the ring of slopes
                                   tan(i) <= |p - mean| < tan(i + 1), i in degrees; 0 in the last,
                                   which has no outer edge */
} asp_slope_statistics;

/* ASP_EINVAL when no facet can be formed or all lie flat, ASP_ENOMEM. */
asp_status asp_height_field_slopes(const asp_height_field *field, asp_slope_statistics *out,
                                   asp_error *err);

/* The slopes of the facets as a distribution: counted in nx x ny cells (asp_histogram_make; 1024 at most
 * each way) over `range`, or where that is NULL from the least slope to the largest but not beyond 4
 * standard deviations; slopes outside count in the cell next to them. `map` as there, NULL: none.
 * *memory is what the value stands on: free() it when the value and its copies are no longer used.
 * ASP_EINVAL (no facets, bins, range), ASP_ENOMEM; then *out and *memory are untouched. */
asp_status asp_height_field_histogram(const asp_height_field *field, size_t nx, size_t ny,
                                      const asp_slope_range *range, const asp_map *map, void **memory,
                                      asp_ndf *out, asp_error *err);

/* asp_ndf_parse and asp_material_parse for specs that may name a file of slopes,
 *     histogram:file=PATH[,bins=N|NX/NY][,range=R|LOW_X/HIGH_X/LOW_Y/HIGH_Y][,the slope map's keys]
 * with alpha = 1 unless given; a path with a comma stands in parentheses. The file is a height field (.f32)
 * or text with a header (csv): p_x, p_y and either density (P22 at the centres of an even grid, each cell
 * once: then its cells are the histogram's) or weight (slopes one by one, all of weight 1 where there is
 * no such column), at most 4194304 rows, slopes up to 1000. bins is 64 unless given.
 *
 * *memory: NULL, or what the value stands on: free() it when the value and its copies are no longer used.
 * On failure err names the file, the line and the value, or the byte of the spec. */
asp_status asp_ndf_read(const asp_model *const *models, const char *spec, asp_ndf *out, void **memory,
                        asp_error *err);
asp_status asp_material_read(const asp_model *const *models, const char *spec, asp_material *out,
                             void **memory, asp_error *err);

/* A measurement to be made. */
typedef struct asp_fabrication {
    asp_surface_recipe surface;
    const asp_metal *metal;     /* NULL: reflects everything */
    size_t rays;                /* [1e4, 1e10] */
    int    threads;             /* [1, 256] */
} asp_fabrication;

/* The default surface in gold, 12 million rays, 2 threads. */
asp_fabrication asp_fabrication_default(void);

typedef struct asp_fabrication_report {
    asp_slope_statistics slopes;    /* of the very facets that were hit */
    size_t  rays, lost;             /* lost: numerically trapped or through the surface */
    asp_rgb albedo;                 /* reflected power over incident power, uniform hemispherical
                                       light */
    asp_rgb multiple;               /* share of the reflected power that met two facets or more */
    double  bounces;                /* mean number of facets met */
    size_t  cells;                  /* cells of the measurement before interpolation */
    double  noise;                  /* counting error 1/sqrt(rays) of a cell, median by power: half
                                       of the power lies in cells of a smaller one */
} asp_fabrication_report;

/* A virtual gonioreflectometer. Rays fall on the surface of the recipe from all directions (uniform
 * in projected solid angle, uniform in place, periodic: there is no edge), are reflected by flat
 * facets with the metal's Fresnel term for as many bounces as it takes, and the power that leaves
 * is collected in cells of half/difference angles. f of a cell is its power over the integral of
 * cos(theta_i) cos(theta_o)/pi over the cell. Reciprocity and mirror symmetry fold phi_d to
 * [0, pi/2]. Cells: 18 in theta_d, 12 in phi_d, in theta_h as fine as the counts allow; log f is
 * then interpolated to MERL's 90 x 90 x 180. Where wi or wo would be below the horizon the table
 * has no value.
 *
 * Same recipe, same table, whatever the number of threads. progress, report and err may be NULL.
 * NULL on failure: ASP_EINVAL (the member is named), ASP_ENOMEM, ASP_ECANCELLED. */
asp_measured *asp_fabricate(const asp_fabrication *what, asp_progress *progress, void *context,
                            asp_fabrication_report *report, asp_error *err);

/* ------------------------------------------------------------------ 4  Fitting
 *
 * Distributions fitted to a measurement through one material, in every channel c
 *
 *     f_c = diffuse_c / pi + specular_c F(eta) D G2 / (4 cos(theta_i) cos(theta_o)),
 *
 * which is `lambert_specular`: a Lambertian base under isotropic facets (Ribardiere et al. 2017,
 * section 5). diffuse and specular lie in [0, 1] (a facet reflects no more than it receives; the
 * limit of specular is an option), eta in [1.05, 100] is shared by the channels, alpha lies in
 * [0.001, 4]. The same form serves metals: for eta -> 100 the dielectric term F tends to 1 at all angles below 80 degrees, and
 * `specular` is the coloured reflectance. Between the two, eta and specular trade against each other
 * (specular F(eta) is all that is seen near the normal); what the data do not tell apart has a large
 * uncertainty and a correlation near -1.
 *
 * Free are alpha of the slope map, every shape number of the model within its range, eta, diffuse
 * and specular. Where the shape numbers carry the roughness themselves (asp_model.own_scale) the map
 * stays that of alpha 1. */

/* A way to measure the distance between model m and data d over the geometries j and channels. */
typedef struct asp_loss {
    const char *name;
    const char *title;                    /* one line */
    const char *definition;               /* the formula of the reported error, in words */
} asp_loss;

/* nad           sum w |m - d| / sum w d, w = cos(theta_i) cos(theta_o): the normalised absolute
 *               difference of the STD paper, weighted so that grazing angles do not rule
 * log           root mean square of log((1 + m cos(theta_i)) / (1 + d cos(theta_i))): error E2 of
 *               Low et al. 2012; what is below 1/sr hardly counts in relative terms
 * log_relative  root mean square of log((m + 0.001/sr) / (d + 0.001/sr)): peak and tail alike; the
 *               default, because it gives back the slopes of a surface with known statistics, where
 *               nad follows the brightest geometries at grazing angles
 * Ends with NULL. */
#define ASP_LOSS_LIMIT 8
const asp_loss *const *asp_losses(void);

typedef enum asp_fit_reason {
    ASP_FIT_EXACT = 3,        /* the residual vanishes to rounding */
    ASP_FIT_STEP = 2,         /* the parameters no longer move */
    ASP_FIT_LOSS = 1,         /* the loss no longer falls */
    ASP_FIT_EVALUATIONS = -1, /* the limit of evaluations was reached while the loss still fell */
    ASP_FIT_SINGULAR = -2     /* no start gave a finite loss */
} asp_fit_reason;

const char *asp_fit_reason_text(asp_fit_reason reason);

#define ASP_FIT_PARAMETERS 16

typedef struct asp_fit_parameter {
    char   name[24];          /* "alpha", "gamma", "eta", "diffuse_r", ...; data of one
                                 channel have "diffuse" and "specular" */
    double value;
    double uncertainty;       /* one standard deviation; infinity where the data say nothing */
    double low, high;         /* value minus and plus one standard deviation, within the range and in
                                 the scale of the search: 1/gamma for a range that ends at infinity */
    int    at_bound;          /* -1 at the lower end of its range, 1 at the upper, 0 inside */
    int    determined;        /* 0: the interval spans a large part of the range or, inside it, reaches
                                 past an end; the value is then one of many that fit as well */
} asp_fit_parameter;

typedef struct asp_fit_result {
    const asp_model *model;
    asp_material material;
    char   spec[640];                     /* of the material, read back exactly */
    size_t parameter_count;
    asp_fit_parameter parameter[ASP_FIT_PARAMETERS];
    /* Row-major, parameter_count columns used of ASP_FIT_PARAMETERS; NaN where undetermined. */
    double correlation[ASP_FIT_PARAMETERS * ASP_FIT_PARAMETERS];
    double error[ASP_LOSS_LIMIT];         /* of all losses, in the order of asp_losses() */
    size_t geometries;                    /* used in the fit */
    size_t evaluations;                   /* of the model over the geometries */
    asp_fit_reason reason;
} asp_fit_result;

/* Set to zero for the defaults. */
typedef struct asp_fit_options {
    const asp_model *const *models;       /* ends with NULL, at most 32; NULL: asp_fit_models */
    const char *loss;                     /* NULL: "log_relative" */
    int      starts;                      /* polished starts per distribution, [1, 64]; 0: 4 */
    uint64_t seed;                        /* of the jitter of the starts */
    int      mask;                        /* asp_mask */
    double   specular_limit;              /* (0, 1000]; 0: 1. More lets sheen that is not made by
                                             facets pass as reflection of more than 100 % */
    asp_progress *progress;               /* NULL: none */
    void    *context;
} asp_fit_options;

/* The default models: all of asp_models() but those that are, isotropic, another parametrisation of a
 * model before them: ellipsoid of ggx, hyper_cauchy and student_t_general of student_t. Writes at most `room` of them and returns how many there are. */
size_t asp_fit_models(const asp_model **out, size_t room);

/* The geometries that a fit sees, to be freed with free(); NULL on failure.
 * Scattered data: all listed ones with finite values. Gridded data: the 84 theta_h of MERL's bins up
 * to 78 degrees, theta_d = 2.5, 7.5, ... 77.5 degrees, 8 phi_d, all at centres of MERL's bins, so
 * that sums are like sums over a MERL table; where a channel has a value above 0; anisotropic data
 * at 4 azimuths of the half vector. Left out of either are geometries with a direction beyond 80
 * degrees, where instruments extrapolate and single scattering ends. */
asp_measurement *asp_fit_geometries(const asp_measured *measured, size_t *count, asp_error *err);

/* Fits each model. *results: one per model in the order given, to be freed with free(); written on
 * success only. Levenberg-Marquardt (MINPACK) over alpha, shape and eta with the colours eliminated
 * by bounded least squares at each step; absolute differences by iterative reweighting, then by a
 * simplex. Starts: a jittered grid, the whole numbers and the ends of each shape range, and the
 * optima of the models with fewer shape numbers of the same call, so that a distribution is never
 * fitted worse than one it contains. Same measurement, same options: same bits.
 *
 * Uncertainties: White's heteroscedasticity-consistent covariance A^-1 B A^-1 of the joint Jacobian
 * at the optimum, A the curvature of the loss, B the scatter of its gradient over geometries. They
 * assume independent errors; where the model itself does not fit they are too small.
 *
 * ASP_EINVAL, ASP_EUNKNOWN (loss), ASP_EFORMAT (no usable geometry, no value above 0, fewer values
 * than a model has parameters), ASP_ENOMEM, ASP_ECANCELLED. */
asp_status asp_fit(const asp_measured *measured, const asp_fit_options *options,
                   asp_fit_result **results, size_t *count, asp_error *err);

/* ------------------------------------------------------------------ 5  Laws
 *
 * What every distribution must obey, whatever its model: a model of your own is tried by the same
 * table. Only the public face is used (evaluators, samplers, the slope map), never a formula that
 * the model itself was written from. */

typedef struct asp_law {
    const char *name;       /* one word, e.g. "sigma" */
    const char *says;       /* the law in a line */
    const char *source;     /* paper and equation, or the page of docs that derives it */
    const char *unit;       /* what `worst` and `allowed` count: "relative", "absolute",
                               "-log10 p" (of a chi-square test, corrected for their number) */
} asp_law;

/* The laws in the order in which they are checked; NULL past the last. */
const asp_law *asp_laws(size_t index);

/* The finding nearest to, or furthest beyond, what is allowed. */
typedef struct asp_law_result {
    const asp_law *law;
    int    passed;          /* worst <= allowed, everywhere */
    double worst;           /* the largest deviation, in law->unit; infinite for a NaN */
    double allowed;         /* what is allowed there; it may depend on the place */
    size_t checks;          /* comparisons made; 0 where the law says nothing of this value */
    char   where[192];      /* the place: direction, masking, sizes; "" where checks is 0 */
} asp_law_result;

typedef struct asp_laws_options {
    size_t   samples;       /* per chi-square test, [1000, 1e8]; the others scale with its root */
    uint64_t seed;          /* the same seed, the same findings */
    const char *only;       /* the name of one law, or NULL for all */
    int      sparse;        /* 1: of the views and materials that the samplers' laws try a third, which one the
                               distribution decides: for runs over many distributions */
    const asp_material *material;   /* NULL: materials of every kind over the distribution; else just this one, as
                               it is, over its own distribution, by the laws that speak of materials */
    asp_progress *progress; /* may be NULL */
    void    *context;       /* of progress */
} asp_laws_options;

/* 100,000 samples, seed 1, all laws, not sparse, no material, no progress. */
asp_laws_options asp_laws_options_default(void);

/* Called once per law. The result is valid during the call. */
typedef void asp_law_report(void *context, const asp_law_result *result);

/* Does a law speak of materials, too? Those are the ones that asp_laws_options.material is tried by. */
int asp_law_of_materials(const asp_law *law);

/* Checks one distribution; about half a second with the default options. options and report may be
 * NULL, and ndf is not looked at where there is a material; failed (may be NULL) is the number of laws
 * broken. ASP_OK also when laws are broken.
 * ASP_EINVAL (samples; a law that does not speak of materials), ASP_EUNKNOWN (only), ASP_ENOMEM, ASP_ECANCELLED. */
asp_status asp_laws_check(const asp_ndf *ndf, const asp_laws_options *options,
                          asp_law_report *report, void *context, size_t *failed, asp_error *err);

/* Representative values of a model: its parameters over their range (near the ends, in the middle,
 * infinite where allowed) times slope maps (isotropic from alpha 1e-3 to 4, anisotropic, rotated,
 * correlated, skewed up to mean slope 2). Writes spec number `index` and returns 1; returns 0 past
 * the last one or when size is too small (256 is enough). */
int asp_laws_spec(const asp_model *model, size_t index, char *spec, size_t size);

/* ------------------------------------------------------------------ 6  Families
 *
 * A distribution as text, and the one of another model that comes nearest to it. */

/* `name:key=value,...` with `digits` significant digits (17 read back to rounding), keys at their
 * defaults of a map left out; the ellipsoid as its matrix. Returns the length without the final 0, or
 * 0 when size is too small (ASP_NDF_TEXT is enough). */
#define ASP_NDF_TEXT 512
size_t asp_ndf_text(const asp_ndf *ndf, int digits, char *text, size_t size);

/* A distance between the density D of a model and that of a target. */
typedef struct asp_norm {
    const char *name;
    const char *definition;               /* a line; m is the model's density, d the target's */
} asp_norm;

/* theta     sqrt(int (m - d)^2 / int d^2) over the angle from the mean plane's normal, as a plot of D
 *           over theta shows it
 * l2, l2_cos    the same over the solid angle, without and with the cosine
 * l1_cos    int |m - d| cos: 0 to 2; also int |P22_m - P22_d| over slopes
 * slope     sqrt(int (P22_m - P22_d)^2 / int P22_d^2) over slopes; knows no scale
 * log       root of the mean over cos/pi of log((m + e)/(d + e))^2, e = 0.001 of the target's D at its
 *           mean slope
 * peak      theta, but only among those that have the target's density at the mean slope
 * Ends with NULL. */
#define ASP_NORM_LIMIT 8
const asp_norm *const *asp_norms(void);

/* What stays as it is. Set to zero for: nothing. */
typedef struct asp_nearest_options {
    const char *norm;                     /* NULL: "theta" */
    double   alpha;                       /* 0: free; else the roughness of the slope map,
                                             sqrt(alpha_x alpha_y), in [1e-5, 100] */
    unsigned fixed;                       /* bit k: shape number k stays at shape[k] */
    double   shape[ASP_SHAPE_NUMBERS];
} asp_nearest_options;

typedef struct asp_nearest_result {
    asp_ndf  ndf;
    double   error;                       /* in the norm asked for */
    double   errors[ASP_NORM_LIMIT];      /* in all norms, in the order of asp_norms() */
    double   peak;                        /* P22 at the mean slope over the target's */
    int      at_bound[ASP_SHAPE_NUMBERS]; /* a free shape number at the end of its range: -1, 1 */
    size_t   evaluations;                 /* densities compared */
} asp_nearest_result;

/* The nearest distribution of a model whose standard surface is round: through a slope map with the
 * target's axes and mean slope, the roughness and the shape numbers free. A model whose shape numbers
 * carry the roughness keeps sqrt(alpha_x alpha_y) = 1 (unless alpha says otherwise), and the first of
 * them is what `peak` is solved for. Deterministic; up to some seconds when two numbers are free and the
 * model prepares tables.
 * ASP_EUNKNOWN (norm), ASP_EINVAL: a fixed number out of range; peak with nothing free to reach it, or
 * out of reach; ASP_ENOMEM. */
asp_status asp_nearest(const asp_ndf *target, const asp_model *model,
                       const asp_nearest_options *options, asp_nearest_result *out, asp_error *err);

#ifdef __cplusplus
}
#endif
#endif
