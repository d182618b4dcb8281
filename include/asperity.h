/* asperity.h - microfacet surface appearance: the core library
 *
 * Read this file from top to bottom and you know the library.
 *
 *   1  Words          directions, slopes, units
 *   2  Errors         what makers and parsers say
 *   3  Slope maps     roughness, anisotropy, rotation, skew; the Ellipsoid's matrix A
 *   4  Distributions  make one from a spec or from numbers
 *   5  Facets         D, P22, sigma, masking, densities, sampling
 *   6  Fresnel        dielectrics, conductors, metals by name
 *   7  Materials      eval, pdf, sample
 *   8  Batches        the same calls over arrays
 *   9  float32        the same calls with the suffix f
 *  10  Study          where the papers' own forms, oracles and SGGX are
 *  11  Conversions    where roughness as others count it, moments and filtering are
 *  12  Walks          multiple scattering
 *
 * The core needs libm only. It allocates nothing, prints nothing, keeps no global state, and every
 * function may be called from any thread. Values are plain structs: copy them freely.
 *
 * Evaluators cannot fail: outside its domain a function answers 0; a NaN that comes in goes out;
 * finite unit vectors never give NaN or infinity. Makers return a status and write only on success.
 *
 * MIT licence. */
#ifndef ASPERITY_H
#define ASPERITY_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ASP_VERSION_MAJOR 0
#define ASP_VERSION_MINOR 1
#define ASP_VERSION_PATCH 0

/* ------------------------------------------------------------------ 1  Words
 *
 * Right-handed local frame, +z the normal of the flat (macroscopic) surface. Directions are unit
 * vectors that point away from the surface. `wi` is given and `wo` is sampled (Mitsuba's and RGL's
 * habit; pbrt and dj_brdf sample wi). `m` is a facet normal, m.z > 0. The slope of a facet is
 * p = (-m.x/m.z, -m.y/m.z). Angles in radians; D and densities in 1/sr; P22 per unit slope area. */

typedef struct asp_vec3 { double x, y, z; } asp_vec3;
typedef struct asp_rgb  { double r, g, b; } asp_rgb;      /* linear sRGB */
typedef struct asp_vec2 { double x, y; } asp_vec2;

/* ------------------------------------------------------------------ 2  Errors */

typedef enum asp_status {
    ASP_OK = 0,
    ASP_EINVAL,    /* a value outside its range, or one that does not go with another */
    ASP_EPARSE,    /* a spec or a text file that cannot be read */
    ASP_EUNKNOWN,  /* a name that is not in a table */
    ASP_EIO,       /* the operating system refused to read or write */
    ASP_EFORMAT,   /* a file that is not what it says it is: corrupt, truncated, hostile */
    ASP_ENOMEM,    /* out of memory */
    ASP_ECANCELLED /* stopped by the progress function of the caller */
} asp_status;

/* Filled on failure, untouched on success. Owned by the caller; every function takes NULL for it.
 * asp_error_text (asperity_data.h) makes one line of it. */
typedef struct asp_error {
    asp_status  status;
    long long   position;    /* byte offset in the spec or binary file, -1 where there is none */
    long long   line;        /* 1-based line of a text file, 0 where there is none */
    double      value;       /* the value refused, and its allowed range; NaN where there is none */
    double      low, high;
    int         low_open;    /* 1: low itself is refused */
    char        file[256];   /* file or source, "" where there is none */
    char        name[64];    /* the parameter, column, field or word at fault */
    char        reason[192]; /* what is wrong, in words */
} asp_error;

/* Fills err (when not NULL) with status, name and reason, and clears the rest; returns status. */
asp_status asp_fail(asp_error *err, asp_status status, const char *name, const char *reason);

/* The same for a number outside [low, high]. */
asp_status asp_fail_range(asp_error *err, const char *name, double value,
                          double low, int low_open, double high);

/* ------------------------------------------------------------------ 3  Slope maps
 *
 * A distribution is a standard surface of unit roughness seen through an affine map of slopes,
 *
 *     p = M q + t,      M 2x2 and invertible,   t the mean slope.
 *
 * Only M M^T (the scatter matrix [[ax^2, rho ax ay], [rho ax ay, ay^2]]) and t matter to D; M itself
 * decides how the unit square is laid out by the samplers. */

typedef struct asp_map { double m00, m01, m10, m11, tx, ty; } asp_map;

/* alpha_x, alpha_y: [1e-5, 100]. rotation turns the x axis of the roughness towards +y (a
 * counter-clockwise turn by `rotation` radians seen from +z), |rotation| <= 1e4. |mean_x|, |mean_y|
 * <= 100.
 * Returns ASP_EINVAL and names the value that is out of range. */
asp_status asp_map_from_roughness(double alpha_x, double alpha_y, double rotation,
                                  double mean_x, double mean_y, asp_map *out, asp_error *err);

/* Correlated axes instead of a rotation: |rho| < 1. */
asp_status asp_map_from_correlation(double alpha_x, double alpha_y, double rho,
                                    double mean_x, double mean_y, asp_map *out, asp_error *err);

/* The Ellipsoid NDF's matrix: A = diag(alpha_x, alpha_y, 1) Rx(theta_x) Ry(theta_y) Rz(theta_z)
 * (Walter et al. 2014, eqs. 2-3). theta_x > 0 tilts the normals to +y, theta_y > 0 to -x, and
 * theta_z turns the distribution by -theta_z. Row-major. |theta_x|, |theta_y| <= pi/2 (a lobe
 * that lies on its side is refused when a map is made of A), |theta_z| <= 1e4. */
asp_status asp_ellipsoid_matrix(double alpha_x, double alpha_y, double theta_x, double theta_y,
                                double theta_z, double A[9], asp_error *err);

/* The slope map of any invertible A, row-major, of either sign of det A: with S = A^T A, mean slope
 * -(S13, S23)/S33 and scatter S[1:2,1:2]/S33 - mean mean^T. A scales out. Refused: mean slopes
 * beyond 100, roughness above 100 or below 1e-8, |A n| outside [1e-100, 1e100]. */
asp_status asp_map_from_matrix(const double A[9], asp_map *out, asp_error *err);

/* The same from the symmetric S = A^T A, row-major; it must be positive definite. */
asp_status asp_map_from_gram(const double S[9], asp_map *out, asp_error *err);

/* Back to a matrix: A = [[M^T, 0], [-tx, -ty, 1]], so that |A n| = 1 and det A = det M. */
void asp_map_to_matrix(const asp_map *map, double A[9]);

/* The five numbers of a map: rotation in (-pi/2, pi/2] with alpha_x >= alpha_y, the form in which
 * two maps of one distribution compare equal. */
typedef struct asp_roughness { double alpha_x, alpha_y, rotation, mean_x, mean_y; } asp_roughness;
asp_roughness asp_map_to_roughness(const asp_map *map);

/* ------------------------------------------------------------------ 4  Distributions */

typedef struct asp_model asp_model;      /* what a distribution is: see asperity_ndf.h */

#define ASP_SHAPE_NUMBERS 8
#define ASP_TABLE_NUMBERS 2240

/* A prepared distribution, about 18 KB. Read-only for callers; make it with a function below. */
typedef struct asp_ndf {
    const asp_model *model;
    asp_map map;                          /* p = M q + t */
    double  i00, i01, i10, i11;           /* the inverse of M */
    double  inv_det;                      /* 1 / |det M| */
    double  shape[ASP_SHAPE_NUMBERS];     /* the model's own numbers */
    double  table[ASP_TABLE_NUMBERS];     /* what the model prepared */
    const void *data;                     /* numbers too many for the table, or NULL; see below */
} asp_ndf;

/* The models of this library in the order of `asperity list`; ends with NULL. */
const asp_model *const *asp_models(void);

/* Finds a model by name or alias in a NULL-terminated table (NULL: asp_models()). NULL if none. */
const asp_model *asp_find_model(const asp_model *const *models, const char *name);

/* Makes a distribution from a model, a slope map and the model's shape numbers in the order of its
 * parameter table (NULL: the defaults). Spends up to 1 ms, `tabulated` 2, twice that on a processor without AVX2;
 * evaluation never prepares anything. */
asp_status asp_ndf_make(const asp_model *model, const asp_map *map, const double *shape,
                        asp_ndf *out, asp_error *err);

/* The same with `data`, for models that need more numbers than a value holds; their documentation says
 * what it points to. The memory stays the caller's: it must not change and must outlive the value, all
 * its copies and its narrowed form, which keep the pointer. asp_ndf_make gives NULL; a model that needs
 * data refuses that. */
asp_status asp_ndf_make_data(const asp_model *model, const asp_map *map, const double *shape,
                             const void *data, asp_ndf *out, asp_error *err);

/* Makes a distribution from a spec, `name:key=value,key=value`. Every model takes the map's keys
 * alpha (or alpha_x, alpha_y), rotation or rho, mean_x, mean_y, and its own. Examples:
 *     ggx:alpha=0.3        beckmann:alpha_x=0.3,alpha_y=0.1,rotation=0.5
 *     student_t:alpha=0.3,gamma=3.7        student_t:alpha=0.3,gamma=inf
 *     ellipsoid:alpha_x=0.2,alpha_y=0.1,theta_x=0.3,theta_y=-0.2,theta_z=0.7
 *     ellipsoid:a11=0.2,a12=0,...,a33=1      (the nine entries of A)
 *     ellipsoid:s11=...,s12=...,s13=...,s22=...,s23=...,s33=...      (A^T A)
 * models: NULL for asp_models(). On failure err->position is the byte of the spec at fault. */
asp_status asp_ndf_parse(const asp_model *const *models, const char *spec, asp_ndf *out,
                         asp_error *err);

/* P22 of a round surface measured ring by ring, in any unit (it is normalised): 2 to 29 slopes that grow,
 * each by 1e-6 at least, and densities in [1e-100, 1e100], neighbours within a factor of 5. Between them log P22 is a cubic of log(r^2 + s^2),
 * s the first slope above 0, monotone where the samples are; below the first it is flat; beyond the last P22
 * falls as (r^2 + s^2)^-tail, tail in [2, 1000], or 0: as between the last two, but at least as 2. Masking
 * and samplers are prepared numerically, sigma to 2.5e-3 where samples fall in steps (far below the horizon 1e-2; 1.5e-2 where they zigzag), to 1e-4 and
 * better where they are smooth. A plain value: the arrays are not kept. In a spec:
 *     tabulated:slopes=0/0.1/0.3,density=5/4/1        (and tail=3, and the slope map's keys; alpha is 1)
 * ASP_EINVAL: of a sample, err->position is its index. */
typedef struct asp_slope_samples {
    size_t count;
    const double *slope, *density;
    double tail;
} asp_slope_samples;
asp_status asp_tabulated_make(const asp_slope_samples *samples, const asp_map *map, asp_ndf *out,
                              asp_error *err);

/* Slopes as they were counted: nx x ny cells over a rectangle of slopes, row-major, ny rows of nx (x runs
 * fastest), P22 constant in each and 0 outside. values: not negative, in any unit (they are normalised).
 * sigma and the samplers integrate this very P22 in closed form, in a time that grows with the rows
 * (1024 at most each way), not with the cells.
 *
 * Prepared numbers go to `memory`, which is the caller's: asp_histogram_bytes(nx, ny) bytes (0: a size
 * that is refused), aligned as malloc aligns, about 72 per cell. It must stay as it is for as long as the
 * value, its copies and its narrowed form are used. Rows and columns at the border that hold nothing are
 * dropped. `map` (NULL: none) bends the measured slopes further; their mean becomes the map's. ASP_EINVAL:
 * of a value, err->position is its index. */
typedef struct asp_slope_range { double low_x, high_x, low_y, high_y; } asp_slope_range;
size_t asp_histogram_bytes(size_t nx, size_t ny);
asp_status asp_histogram_make(void *memory, size_t nx, size_t ny, asp_slope_range range,
                              const double *values, const asp_map *map, asp_ndf *out, asp_error *err);

/* ------------------------------------------------------------------ 5  Facets */

/* Which masking. Add one of the first group and one of the second. Default: 0. */
typedef enum asp_mask {
    ASP_MASK_CORRELATED = 0,    /* G2 = 1/(1 + Lambda_i + Lambda_o): height-correlated Smith */
    ASP_MASK_UNCORRELATED = 1,  /* G2 = G1(i) G1(o): the Ellipsoid and STD papers */
    ASP_MASK_V_CAVITY = 2,      /* Torrance-Sparrow's grooves; knows nothing of the distribution, and
                                   on a skewed surface may reflect more than falls on it */
    ASP_MASK_MIN = 0,           /* skewed surfaces: G1 = min(1, w.z/sigma), Walter eq. 6 */
    ASP_MASK_WALL = 16          /* skewed surfaces: vertical walls close the surface; exact, no min */
} asp_mask;

/* Names: correlated (height_correlated), uncorrelated (separable), v_cavity, min, wall, and two
 * joined by '+', as in uncorrelated+wall. ASP_EUNKNOWN on any other. */
asp_status asp_mask_parse(const char *name, int *mask, asp_error *err);

/* Density of facet normals, area of facets per unit flat area and solid angle, 1/sr. Its integral
 * against m.z is 1. 0 for m.z <= 0. */
double asp_D(const asp_ndf *ndf, asp_vec3 m);

/* Density of slopes, D = P22 / cos^4 (STD paper eq. 5). Any finite slope; 0 where the square of the
 * standard surface's slope is beyond 1e150 (float32: 1e18). */
double asp_P22(const asp_ndf *ndf, double p_x, double p_y);

/* Projected area of the facets seen from w, per unit flat area: the integral of max(0, w.m) D(m).
 * Any w, also below the horizon; sigma(-w) = sigma(w) - (w.z - tx w.x - ty w.y). Never negative. */
double asp_sigma(const asp_ndf *ndf, asp_vec3 w);

/* Smith's masking. G1 = w.z / (masked sigma) in [0, 1], 0 for w.z <= 0. Lambda = 1/G1 - 1, infinite
 * at the horizon (not NaN), 0 along the normal of an unskewed surface. `mask` as above; the
 * V-cavity form needs m, so here it is taken for m = the direction that masks least: 1. */
double asp_G1(const asp_ndf *ndf, asp_vec3 w, int mask);
double asp_lambda(const asp_ndf *ndf, asp_vec3 w, int mask);

/* Share of the facets with normal m seen from both. 0 where either direction is below the horizon
 * or behind the facet. */
double asp_G2(const asp_ndf *ndf, asp_vec3 wi, asp_vec3 wo, asp_vec3 m, int mask);

/* Normal sampling with density D(m) m.z, and visible normals seen from wi with density
 * max(0, wi.m) D(m) / sigma(wi). u1, u2 in [0, 1). Both are continuous maps of (u1, u2).
 * wi may point below the horizon as long as sigma(wi) > 0. */
asp_vec3 asp_sample_normal(const asp_ndf *ndf, double u1, double u2);
asp_vec3 asp_sample_visible(const asp_ndf *ndf, asp_vec3 wi, double u1, double u2);
double   asp_pdf_normal(const asp_ndf *ndf, asp_vec3 m);
double   asp_pdf_visible(const asp_ndf *ndf, asp_vec3 wi, asp_vec3 m);

/* Mean of the slopes, and the unit normal of the mean plane, (-mean, 1) normalised. */
asp_vec2 asp_mean_slope(const asp_ndf *ndf);
asp_vec3 asp_mean_normal(const asp_ndf *ndf);

/* ------------------------------------------------------------------ 6  Fresnel
 *
 * c is the cosine between direction and facet normal, clamped to [0, 1]. Unpolarised reflectance. */

/* eta = interior/exterior in (0, 1e4]. Total internal reflection gives 1; eta = 1 gives 0. */
double asp_fresnel_dielectric(double c, double eta);
/* Complex index eta + i k relative to the exterior, eta in (0, 1e4], k in [0, 1e4]. One division, no complex numbers. */
double asp_fresnel_conductor(double c, double eta, double k);
/* f0 + (1 - f0)(1 - c)^5 (Schlick 1994). */
double asp_fresnel_schlick(double c, double f0);
/* Schlick's with the value at 82 degrees tinted: f82 = tint * schlick(c82), c82 = 1/7 (Kutz et al.
 * 2021). tint = 1 is Schlick's. Result clamped to [0, 1]. */
double asp_fresnel_f82(double c, double f0, double tint);

/* A metal as the linear sRGB triple whose conductor Fresnel term best follows the spectral one
 * under D65. */
typedef struct asp_metal { const char *name, *source; asp_rgb eta, k, f0; } asp_metal;
const asp_metal *asp_metals(size_t *count);
const asp_metal *asp_find_metal(const char *name);        /* "Au", "Ag", ...; NULL if none */

/* n and k of a metal of asp_metals() at a wavelength in nm, [380, 780], linear between 10 nm steps. */
asp_status asp_metal_index(const asp_metal *metal, double nm, double *eta, double *k, asp_error *err);

/* Linear sRGB of a spectral reflectance in [0, 1] under D65, CIE 1931; 1 at every wavelength is white. */
typedef double asp_reflectance(const void *context, double nm);
asp_rgb asp_rgb_of_reflectance(asp_reflectance *reflectance, const void *context);

/* A film of index film_eta (relative to the exterior, like eta and k below it) and `thickness` nm, seen at
 * wavelength nm: Airy's sum of all reflections, unpolarised. Thickness 0 is the bare surface. */
double asp_fresnel_film(double c, double film_eta, double thickness, double eta, double k, double nm);

/* F82-tint's two numbers of a conductor: exact at normal incidence and at 82 degrees. And back: f0 in
 * (0, 1); ASP_EINVAL with the range of tint where no eta + i k has this pair. */
void asp_f82_of_index(double eta, double k, double *f0, double *tint);
asp_status asp_index_of_f82(double f0, double tint, double *eta, double *k, asp_error *err);

/* ------------------------------------------------------------------ 7  Materials
 *
 * A scattering model over a distribution. Spec grammar: `model:key=value,...` where a value may be
 * a spec in parentheses, and a colour is one number or r/g/b:
 *     conductor:metal=Au,ndf=(student_t:alpha=0.3,gamma=3),mask=uncorrelated
 *     conductor:eta=0.2/0.9/1.5,k=3.9/2.4/1.9,ndf=(ggx:alpha=0.1)      conductor:f0=0.9/0.6/0.3,tint=0.9
 *     conductor:metal=Al,film=300,film_eta=1.4,ndf=(ggx:alpha=0.2)      (a thin film, nm)
 *     compensated:metal=Au,form=kulla_conty,ndf=(beckmann:alpha=0.8)    (energy given back:
 *         without absorption albedo 1 to 0.003, skewed 0.03 near grazing; docs/materials.md)
 *     compensated_dielectric:eta=1.5,form=kulla_conty,ndf=(ggx:alpha=0.6)  (the same for both sides of glass)
 *     dielectric:eta=1.5,film=400,film_eta=1.8,ndf=(ggx:alpha=0.2)      (the same on glass, from both sides)
 *     dielectric:eta=1.5,transport=radiance,ndf=(ggx:alpha=0.2)         plastic:albedo=0.4/0.1/0.1,eta=1.5,ndf=(ggx)
 *     rough_diffuse:albedo=0.8,form=eon,ndf=(beckmann:alpha=1)
 *     lambert_specular:diffuse=0.2/0.1/0.05,specular=1,eta=1.5,ndf=(ggx:alpha=0.2) */

typedef struct asp_bsdf asp_bsdf;        /* what a scattering model is: see asperity_ndf.h */

/* What is carried from wo to wi: radiance (a path from the camera), or importance (one from a light).
 * They differ where light crosses a boundary: radiance is denser inside by eta^2. With indices n_i, n_o of
 * the two sides a dielectric has f(wo, wi) = f(wi, wo) n_o^2/n_i^2 in radiance, and f of importance from
 * wi to wo is f of radiance from wo to wi. */
typedef enum asp_transport { ASP_RADIANCE = 0, ASP_IMPORTANCE = 1 } asp_transport;

#define ASP_ENERGY_NUMBERS 1300

typedef struct asp_material {
    const asp_bsdf *model;
    int     mask;                         /* asp_mask */
    int     fresnel;                      /* which Fresnel term the numbers below are for */
    int     transport;                    /* asp_transport */
    asp_rgb a, b, c, d;                   /* the model's colours; see its record */
    double  film, film_eta;               /* thickness in nm of a film on the facets, 0: none; its index */
    double  energy[ASP_ENERGY_NUMBERS];   /* what the model prepared */
    asp_ndf ndf;
} asp_material;

const asp_bsdf *const *asp_bsdfs(void);   /* ends with NULL */
asp_status asp_material_parse(const asp_model *const *models, const char *spec, asp_material *out,
                              asp_error *err);

/* A perfectly specular microsurface (F = 1) of a distribution: albedo 1 minus what masking loses. */
asp_material asp_mirror(const asp_ndf *ndf, int mask);

/* A conductor: eta + i k per channel. */
asp_material asp_conductor(const asp_ndf *ndf, asp_rgb eta, asp_rgb k, int mask);

/* A diffuse base under a specular lobe of a dielectric of index eta, scaled by `specular`; the form
 * fitted in the STD paper: f = diffuse/pi + specular F D G / (4 cos cos). */
asp_material asp_lambert_specular(const asp_ndf *ndf, asp_rgb diffuse, asp_rgb specular, double eta,
                                  int mask);

/* A dielectric: reflection and refraction, wi and wo on either side. eta = interior/exterior, [0.01, 100];
 * 1 is no boundary: sample passes straight on with weight 1 and density 0, eval is 0. thin: 1 for a sheet. */
asp_material asp_dielectric(const asp_ndf *ndf, double eta, int thin, int transport, int mask);

/* Lays a film of index film_eta, [1, 10], and `thickness` nm, (0, 10000], on every facet of a conductor, a dielectric
 * (from both sides; a sheet's both faces), a compensated conductor or a Lambert + rough reflection: three channels in
 * linear sRGB, by 41 wavelengths; one of asp_metals(), known by its numbers, has its spectrum. ASP_EINVAL where there is
 * no index, where a dielectric's is 1, and of other materials: mat is as it was. */
asp_status asp_film(asp_material *mat, double film_eta, double thickness, asp_error *err);

/* Lambertian facets of an albedo in [0, 1]; eval is a quadrature of 466 nodes. Its relative error, above
 * cosines of 0.1: about 1e-3, at most 0.02; it grows near grazing (0.1 for ggx of alpha 0.3). */
asp_material asp_rough_diffuse(const asp_ndf *ndf, asp_rgb albedo, int mask);

/* A dielectric coat, eta in (1, 10], over a Lambertian base, all reflections between them included; an
 * albedo of 1 returns all light. Prepares a table: about 1 ms, 20 ms where azimuth matters. */
asp_material asp_plastic(const asp_ndf *ndf, asp_rgb albedo, double eta, int mask);

/* f of a conductor or a dielectric at n wavelengths, whose indices are eta[i] + i k[i] (a dielectric's k is not
 * read). ASP_EINVAL for other materials and under films: out is as it was. */
asp_status asp_eval_spectrum(const asp_material *mat, asp_vec3 wi, asp_vec3 wo, size_t n, const double *eta,
                       const double *k, double *out);

/* f of a conductor or a dielectric at n wavelengths nm[i], [380, 780]: a metal of asp_metals() has its spectrum, an index
 * that is the same in three channels is that of all wavelengths, and a film is exact. ASP_EINVAL for other materials, for
 * f0 and tint and for an index per channel; and for a wavelength outside: out is then as it was. */
asp_status asp_eval_wavelengths(const asp_material *mat, asp_vec3 wi, asp_vec3 wo, size_t n, const double *nm,
                                double *out, asp_error *err);

typedef struct asp_bsdf_sample {
    asp_vec3 wo;
    double   pdf;                         /* per solid angle of wo */
    asp_rgb  weight;                      /* f cos(theta_o) / pdf; 0 where wo is below the horizon */
} asp_bsdf_sample;

/* f, f cos(theta_o) and the density of sample's wo. Where nothing refracts f is 0 for wi.z <= 0 and for
 * wo.z <= 0, the density for wi.z <= 0 only (a facet can send light down). */
asp_rgb asp_eval(const asp_material *mat, asp_vec3 wi, asp_vec3 wo);
asp_rgb asp_eval_cos(const asp_material *mat, asp_vec3 wi, asp_vec3 wo);
double  asp_pdf(const asp_material *mat, asp_vec3 wi, asp_vec3 wo);
asp_bsdf_sample asp_sample(const asp_material *mat, asp_vec3 wi, double u1, double u2);
/* The same with the number that chooses between reflection and refraction given; asp_sample makes one
 * of the bits of u1 and u2. Models with one lobe do not use it. */
asp_bsdf_sample asp_sample_lobe(const asp_material *mat, asp_vec3 wi, double u1, double u2, double u3);

/* An estimate of f by one facet, drawn by u1 and u2: its mean over both is f without quadrature. f itself for
 * all but rough_diffuse of exact form. */
asp_rgb asp_eval_stochastic(const asp_material *mat, asp_vec3 wi, asp_vec3 wo, double u1, double u2);

/* Reflection by visible normals that leaves out most of those that send light down (Eto, Tokuyoshi 2023):
 * less variance on rough GGX. Conductors over ggx without mean slope; anything else as asp_sample does. */
asp_bsdf_sample asp_sample_bounded(const asp_material *mat, asp_vec3 wi, double u1, double u2);
double          asp_pdf_bounded(const asp_material *mat, asp_vec3 wi, asp_vec3 wo);

/* ------------------------------------------------------------------ 8  Batches
 *
 * n elements, structure of arrays. Outputs may be inputs (in place); otherwise arrays must not
 * overlap. Element i is bit for bit what the single call gives. */

typedef struct asp_vec3s  { double *x, *y, *z; } asp_vec3s;              /* written */
typedef struct asp_cvec3s { const double *x, *y, *z; } asp_cvec3s;      /* read */
typedef struct asp_rgbs  { double *r, *g, *b; } asp_rgbs;

void asp_D_n(const asp_ndf *ndf, size_t n, asp_cvec3s m, double *out);
void asp_P22_n(const asp_ndf *ndf, size_t n, const double *p_x, const double *p_y, double *out);
void asp_sigma_n(const asp_ndf *ndf, size_t n, asp_cvec3s w, double *out);
void asp_G1_n(const asp_ndf *ndf, size_t n, asp_cvec3s w, int mask, double *out);
void asp_lambda_n(const asp_ndf *ndf, size_t n, asp_cvec3s w, int mask, double *out);
void asp_G2_n(const asp_ndf *ndf, size_t n, asp_cvec3s wi, asp_cvec3s wo, asp_cvec3s m, int mask,
              double *out);
void asp_sample_normal_n(const asp_ndf *ndf, size_t n, const double *u1, const double *u2,
                         asp_vec3s m);
void asp_sample_visible_n(const asp_ndf *ndf, size_t n, asp_cvec3s wi, const double *u1,
                          const double *u2, asp_vec3s m);
void asp_pdf_normal_n(const asp_ndf *ndf, size_t n, asp_cvec3s m, double *out);
void asp_pdf_visible_n(const asp_ndf *ndf, size_t n, asp_cvec3s wi, asp_cvec3s m, double *out);
void asp_eval_n(const asp_material *mat, size_t n, asp_cvec3s wi, asp_cvec3s wo, asp_rgbs out);
void asp_eval_cos_n(const asp_material *mat, size_t n, asp_cvec3s wi, asp_cvec3s wo, asp_rgbs out);
void asp_pdf_n(const asp_material *mat, size_t n, asp_cvec3s wi, asp_cvec3s wo, double *out);
void asp_sample_n(const asp_material *mat, size_t n, asp_cvec3s wi, const double *u1,
                  const double *u2, asp_vec3s wo, double *pdf, asp_rgbs weight);

/* ------------------------------------------------------------------ 9  float32
 *
 * Prepare in float64, narrow once, evaluate in float32 from the same text.
 *
 * Against float64 at the same directions: sigma and G1 within 2e-6 relative (where they come from tables
 * the error that the model states, area_error, is in both); D and the densities within 1e-6 + 3e-7 E
 * (torrance_sparrow 4e-7 E: its angle is rounded once more), E = log(P22(mean slope)/P22): a power turns a
 * rounding of its argument (here of the map's inverse, of its products and squares) into E times as much. So 2e-6 holds everywhere for GGX
 * and for Student's t with gamma up to 4, and for every distribution where P22 is above 0.04 of its
 * largest; at 1e-6 of the peak Beckmann's D is within 6e-6. sigma seen from below the mean plane
 * carries its exponent alike, and a map that turns, skews or stretches by a factor s adds cancellation
 * of about 1e-7 s. */

typedef struct asp_vec3f { float x, y, z; } asp_vec3f;
typedef struct asp_rgbf  { float r, g, b; } asp_rgbf;
typedef struct asp_vec2f { float x, y; } asp_vec2f;
typedef struct asp_mapf  { float m00, m01, m10, m11, tx, ty; } asp_mapf;
typedef struct asp_vec3sf { float *x, *y, *z; } asp_vec3sf;
typedef struct asp_cvec3sf { const float *x, *y, *z; } asp_cvec3sf;
typedef struct asp_rgbsf  { float *r, *g, *b; } asp_rgbsf;

typedef struct asp_ndff {
    const asp_model *model;
    asp_mapf map;
    float i00, i01, i10, i11;
    float inv_det;
    float shape[ASP_SHAPE_NUMBERS];
    float table[ASP_TABLE_NUMBERS];
    const void *data;
} asp_ndff;

typedef struct asp_materialf {
    const asp_bsdf *model;
    int      mask;
    int      fresnel;
    int      transport;
    asp_rgbf a, b, c, d;
    float    energy[ASP_ENERGY_NUMBERS];
    asp_ndff ndf;
} asp_materialf;

typedef struct asp_bsdf_samplef { asp_vec3f wo; float pdf; asp_rgbf weight; } asp_bsdf_samplef;

asp_ndff      asp_ndf_narrow(const asp_ndf *ndf);
asp_materialf asp_material_narrow(const asp_material *mat);

float asp_Df(const asp_ndff *ndf, asp_vec3f m);
float asp_P22f(const asp_ndff *ndf, float p_x, float p_y);
float asp_sigmaf(const asp_ndff *ndf, asp_vec3f w);
float asp_G1f(const asp_ndff *ndf, asp_vec3f w, int mask);
float asp_lambdaf(const asp_ndff *ndf, asp_vec3f w, int mask);
float asp_G2f(const asp_ndff *ndf, asp_vec3f wi, asp_vec3f wo, asp_vec3f m, int mask);
asp_vec3f asp_sample_normalf(const asp_ndff *ndf, float u1, float u2);
asp_vec3f asp_sample_visiblef(const asp_ndff *ndf, asp_vec3f wi, float u1, float u2);
float asp_pdf_normalf(const asp_ndff *ndf, asp_vec3f m);
float asp_pdf_visiblef(const asp_ndff *ndf, asp_vec3f wi, asp_vec3f m);
asp_vec2f asp_mean_slopef(const asp_ndff *ndf);
asp_vec3f asp_mean_normalf(const asp_ndff *ndf);
float asp_fresnel_dielectricf(float c, float eta);
float asp_fresnel_conductorf(float c, float eta, float k);
float asp_fresnel_schlickf(float c, float f0);
float asp_fresnel_f82f(float c, float f0, float tint);
asp_rgbf asp_evalf(const asp_materialf *mat, asp_vec3f wi, asp_vec3f wo);
asp_rgbf asp_eval_cosf(const asp_materialf *mat, asp_vec3f wi, asp_vec3f wo);
float    asp_pdff(const asp_materialf *mat, asp_vec3f wi, asp_vec3f wo);
asp_bsdf_samplef asp_samplef(const asp_materialf *mat, asp_vec3f wi, float u1, float u2);
asp_bsdf_samplef asp_sample_lobef(const asp_materialf *mat, asp_vec3f wi, float u1, float u2, float u3);

void asp_D_nf(const asp_ndff *ndf, size_t n, asp_cvec3sf m, float *out);
void asp_P22_nf(const asp_ndff *ndf, size_t n, const float *p_x, const float *p_y, float *out);
void asp_sigma_nf(const asp_ndff *ndf, size_t n, asp_cvec3sf w, float *out);
void asp_G1_nf(const asp_ndff *ndf, size_t n, asp_cvec3sf w, int mask, float *out);
void asp_lambda_nf(const asp_ndff *ndf, size_t n, asp_cvec3sf w, int mask, float *out);
void asp_G2_nf(const asp_ndff *ndf, size_t n, asp_cvec3sf wi, asp_cvec3sf wo, asp_cvec3sf m, int mask,
               float *out);
void asp_sample_normal_nf(const asp_ndff *ndf, size_t n, const float *u1, const float *u2,
                          asp_vec3sf m);
void asp_sample_visible_nf(const asp_ndff *ndf, size_t n, asp_cvec3sf wi, const float *u1,
                           const float *u2, asp_vec3sf m);
void asp_pdf_normal_nf(const asp_ndff *ndf, size_t n, asp_cvec3sf m, float *out);
void asp_pdf_visible_nf(const asp_ndff *ndf, size_t n, asp_cvec3sf wi, asp_cvec3sf m, float *out);
void asp_eval_nf(const asp_materialf *mat, size_t n, asp_cvec3sf wi, asp_cvec3sf wo, asp_rgbsf out);
void asp_eval_cos_nf(const asp_materialf *mat, size_t n, asp_cvec3sf wi, asp_cvec3sf wo,
                     asp_rgbsf out);
void asp_pdf_nf(const asp_materialf *mat, size_t n, asp_cvec3sf wi, asp_cvec3sf wo, float *out);
void asp_sample_nf(const asp_materialf *mat, size_t n, asp_cvec3sf wi, const float *u1,
                   const float *u2, asp_vec3sf wo, float *pdf, asp_rgbsf weight);

/* ------------------------------------------------------------------ 10  Study
 *
 * asperity_study.h: the STD paper's own maskings, rejection oracles, Walter's sampler, SGGX. */

/* ------------------------------------------------------------------ 11  Conversions
 *
 * asperity_convert.h: roughness as other systems count it, moments of slopes, sums and averages. */

/* ------------------------------------------------------------------ 12  Multiple scattering
 *
 * Facets light one another. The walk follows light from facet to facet (Heitz, Hanika, d'Eon, Dachsbacher
 * 2016) over every distribution, skewed ones included: those are closed by vertical walls (mask `wall`),
 * which reflect and refract like facets, so that nothing is lost. Materials: conductor, dielectric (not
 * thin: 0) and rough_diffuse. Uniform numbers come from a stream, because no walk's length is known. */

/* 1 where a walk is of this material: else (a form of rough_diffuse by name included, whose facets are not known)
 * what the calls below give is not the material's. */
int asp_can_walk(const asp_material *mat);

/* A number in [0, 1), each time another. */
typedef double asp_uniforms(void *state);

/* An unbiased estimate of f cos(theta_o), single scattering included, by next-event estimation at each
 * facet met. Its spread is that of the walk: use it with many numbers, or beside a sampler. Light that crosses
 * a wall of a skewed dielectric before it meets any facet makes a Dirac peak, which only
 * asp_walk_sample sees. Where D has a pole at the horizon (student_t below gamma 1.75) the variance is
 * infinite: sample instead. */
asp_rgb asp_walk_eval_cos(const asp_material *mat, asp_vec3 wi, asp_vec3 wo, asp_uniforms *next,
                          void *state);
/* Where the walk comes out: wo, its weight f cos / (true density), and for multiple importance sampling
 * the density below, which is not the walk's own. A walk that is absorbed has weight 0. */
asp_bsdf_sample asp_walk_sample(const asp_material *mat, asp_vec3 wi, asp_uniforms *next, void *state);
/* Density of single scattering in the share that gets out unhidden, a cosine lobe for the rest. Positive
 * wherever the walk can end, integrates to at most 1. */
double asp_walk_pdf(const asp_material *mat, asp_vec3 wi, asp_vec3 wo);

asp_rgbf asp_eval_stochasticf(const asp_materialf *mat, asp_vec3f wi, asp_vec3f wo, float u1, float u2);
asp_bsdf_samplef asp_sample_boundedf(const asp_materialf *mat, asp_vec3f wi, float u1, float u2);
float            asp_pdf_boundedf(const asp_materialf *mat, asp_vec3f wi, asp_vec3f wo);
asp_rgbf asp_walk_eval_cosf(const asp_materialf *mat, asp_vec3f wi, asp_vec3f wo, asp_uniforms *next,
                            void *state);
asp_bsdf_samplef asp_walk_samplef(const asp_materialf *mat, asp_vec3f wi, asp_uniforms *next, void *state);
float asp_walk_pdff(const asp_materialf *mat, asp_vec3f wi, asp_vec3f wo);

/* Over arrays (see section 8). The stream of element i is (char *)states + i stride, and it is bit for bit what the
 * single call gives with it; with stride 0 all draw from one stream, in another order than single calls would.
 * Conductors of mean slope 0 walk side by side, several times as fast; others go one after the other. */
void asp_walk_eval_cos_n(const asp_material *mat, size_t n, asp_cvec3s wi, asp_cvec3s wo, asp_uniforms *next,
                         void *states, size_t stride, asp_rgbs out);
void asp_walk_sample_n(const asp_material *mat, size_t n, asp_cvec3s wi, asp_uniforms *next, void *states,
                       size_t stride, asp_vec3s wo, double *pdf, asp_rgbs weight);
void asp_walk_pdf_n(const asp_material *mat, size_t n, asp_cvec3s wi, asp_cvec3s wo, double *out);
void asp_walk_eval_cos_nf(const asp_materialf *mat, size_t n, asp_cvec3sf wi, asp_cvec3sf wo, asp_uniforms *next,
                          void *states, size_t stride, asp_rgbsf out);
void asp_walk_sample_nf(const asp_materialf *mat, size_t n, asp_cvec3sf wi, asp_uniforms *next, void *states,
                        size_t stride, asp_vec3sf wo, float *pdf, asp_rgbsf weight);
void asp_walk_pdf_nf(const asp_materialf *mat, size_t n, asp_cvec3sf wi, asp_cvec3sf wo, float *out);

#ifdef __cplusplus
}
#endif
#endif
