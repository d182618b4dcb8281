/* laws.h - what the files of the laws share */
#ifndef ASPI_LAWS_H
#define ASPI_LAWS_H

#include "asperity_data.h"
#include "asperity_ndf.h"

/* ---- a check under way */

typedef struct aspi_view {
    asp_vec3 w;
    const char *name;
} aspi_view;

#define ASPI_VIEWS 12

/* Kinds of materials: five mirrors, a conductor and a mixture; those that are slow to make; those that light
 * crosses. */
enum {
    ASPI_MIRROR = 0, ASPI_MIXTURE = 6, ASPI_MATERIALS = 7,
    ASPI_PLASTIC = 7, ASPI_COMPENSATED, ASPI_FILM, ASPI_EON, ASPI_ROUGH_DIFFUSE, ASPI_ONE_SIDED,
    ASPI_DIELECTRIC = ASPI_ONE_SIDED, ASPI_SHEET, ASPI_COMPENSATED_DIELECTRIC, ASPI_FILM_GLASS, ASPI_ALL_MATERIALS,
    ASPI_OWN = ASPI_ALL_MATERIALS       /* the caller's, alone */
};

/* What laws have to know of a material. */
typedef struct aspi_traits {
    int mirrors;                  /* single scattering by mirror facets, whatever their Fresnel term */
    int grooves;                  /* masked by them: those of a level surface */
    int mixed;                    /* a cosine lobe is sampled beside the facets */
    int crosses, thin;            /* light goes through; a sheet */
    int quadrature;               /* each f is one */
    int coloured;                 /* facets reflect with the channels' mean probability: only the mean of a weight's
                                   * channels is bounded */
    int reciprocal, walks;
    double eta;                   /* of what light crosses; 1 for a sheet */
} aspi_traits;

typedef struct aspi_trial {
    const asp_ndf *ndf;
    const asp_material *own;      /* NULL: materials of every kind */
    asp_ndff ndff;
    asp_ndf standard;             /* the same shape through the identity map */
    double det;                   /* |det M| */
    double scale;                 /* median slope of the standard surface */
    int skewed;
    int planar;                   /* the slopes are counted in cells, not round */
    asp_lattice lattice;          /* of those, in the standard frame */
    size_t samples;
    int sparse;
    unsigned phase;               /* a number of the distribution: which cases a sparse run takes */
    uint64_t state;               /* of the generator, reset for each law */
    aspi_view views[ASPI_VIEWS];  /* above the horizon, from the normal to grazing */
    size_t view_count;
    asp_law_result *result;
    double ratio;                 /* of the worst finding: deviation / allowed */
    asp_progress *progress;
    void *context;
    double done, share;           /* progress made before this law, and what the law is worth */
    int cancelled;
    int no_memory;
    int made[ASPI_ALL_MATERIALS];
    asp_material material[ASPI_ALL_MATERIALS];
} aspi_trial;

/* A law: what it says, and the function that looks. `weight`: its share of the time. */
typedef struct aspi_law_row {
    asp_law law;
    void (*check)(aspi_trial *t);
    double weight;
    int materials;                /* 1: it speaks of materials */
} aspi_law_row;

/* One comparison. A deviation that is not a number counts as infinite. `where` is printf's. */
#if defined(__GNUC__)
__attribute__((format(printf, 4, 5)))
#endif
void aspi_find(aspi_trial *t, double deviation, double allowed, const char *where, ...);

/* Whether case `index` of a law is tried; a sparse run takes one of three. */
int aspi_taken(const aspi_trial *t, size_t index);

/* Tells the caller how far the law is, in [0, 1]; nonzero: stop. */
int aspi_tick(aspi_trial *t, double done);

/* The laws, one function each. */
void aspi_law_normalisation(aspi_trial *t);
void aspi_law_slope_density(aspi_trial *t);
void aspi_law_mean_slope(aspi_trial *t);
void aspi_law_slope_map(aspi_trial *t);
void aspi_law_rotation(aspi_trial *t);
void aspi_law_matrix(aspi_trial *t);
void aspi_law_sigma(aspi_trial *t);
void aspi_law_sigma_flip(aspi_trial *t);
void aspi_law_G1(aspi_trial *t);
void aspi_law_G2(aspi_trial *t);
void aspi_law_wall(aspi_trial *t);
void aspi_law_density_normal(aspi_trial *t);
void aspi_law_density_visible(aspi_trial *t);
void aspi_law_reciprocity(aspi_trial *t);
void aspi_law_furnace(aspi_trial *t);
void aspi_law_weight(aspi_trial *t);
void aspi_law_sample_normal(aspi_trial *t);
void aspi_law_sample_visible(aspi_trial *t);
void aspi_law_sample_bsdf(aspi_trial *t);
void aspi_law_weight_histogram(aspi_trial *t);
void aspi_law_refraction(aspi_trial *t);
void aspi_law_adjoint(aspi_trial *t);
void aspi_law_limits(aspi_trial *t);
void aspi_law_weak_furnace(aspi_trial *t);
void aspi_law_sample_materials(aspi_trial *t);
void aspi_law_no_boundary(aspi_trial *t);
void aspi_law_walk(aspi_trial *t);
void aspi_law_continuity(aspi_trial *t);
void aspi_law_float32(aspi_trial *t);
void aspi_law_batch(aspi_trial *t);
void aspi_law_finite(aspi_trial *t);
void aspi_law_nan(aspi_trial *t);

/* ---- vectors */

#define ASPI_PI 3.14159265358979323846

asp_vec3 aspi_unit(double x, double y, double z);
double aspi_dot(asp_vec3 a, asp_vec3 b);
double aspi_largest(asp_rgb c);                  /* of its three channels */
double aspi_average(asp_rgb c);                  /* one alone may nearly vanish under a film, but not its rounding */
/* The direction at angle theta from the normal and azimuth phi. */
asp_vec3 aspi_direction(double theta, double phi);
/* p = M q + t and back. */
asp_vec2 aspi_map_slope(const asp_map *map, double qx, double qy);
/* Slope of m in the standard frame, in polar form; infinite radius for m.z <= 0. */
void aspi_standard_polar(const asp_ndf *ndf, asp_vec3 m, double *r, double *phi);
/* Height and horizontal length of w' = (M^T w_xy, w.z - w_xy.t): what sigma sees. */
void aspi_standard_view(const asp_ndf *ndf, asp_vec3 w, double *height, double *length);
/* Density of standard slopes times r^2, from D of the mapped surface. */
double aspi_r2_density(const aspi_trial *t, double r, double phi);

/* The material of a kind over the distribution (law_scatter.c), made when it is first asked for. */
const asp_material *aspi_material(aspi_trial *t, int kind, const char **name);
aspi_traits aspi_traits_of(const asp_material *mat);
/* Kinds in [from, to) are tried: those, or the caller's material alone. */
int aspi_first(const aspi_trial *t, int from);
int aspi_end(const aspi_trial *t, int to);
/* The same material with what it sends across not scaled by 1/eta^2. */
asp_material aspi_importance(const asp_material *mat);

/* Steps of rounding that a facet found from wi and wo carries, n the index where wo is over that where wi is: the
 * half vector is what is left of two vectors of length 1 and n. `more`: what else is as many steps (law_dielectric.c). */
double aspi_refracted_steps(const aspi_trial *t, asp_vec3 wi, asp_vec3 wo, double n, double more);

/* Steps that reflection carries next to total reflection, seen at the cosine c to the facet: F falls by about 4 g/n^2
 * from 1, g^2 = n^2 - 1 + c^2 (law_adjoint.c). */
double aspi_total_steps(double c, double n);

/* The same of all of eval: Fresnel's term takes the root of what is left of 1 next to total reflection (law_adjoint.c). */
double aspi_facet_steps(const aspi_trial *t, asp_vec3 wi, asp_vec3 wo, double n);

/* ---- random numbers and statistics (statistics.c) */

double aspi_uniform(aspi_trial *t);              /* [0, 1), 53 bits */
double aspi_next(void *trial);                   /* the same, as walks ask for it */
asp_vec3 aspi_random_direction(aspi_trial *t);   /* unit sphere, uniform */
/* A facet normal from the surface itself, and now and then far out in its tail. */
asp_vec3 aspi_random_facet(aspi_trial *t);

/* Q(dof/2, chi2/2): probability that chi-square is larger by chance. */
double aspi_chi_square_p(double chi2, double dof);
/* -log10 of the probability that the least of `tests` p-values is as small as p (Sidak 1967). */
double aspi_sidak(double p, size_t tests);

/* A histogram of facets in the polar standard slope: rings at quantiles of a pilot sample, equal
 * sectors; the last ring is one open cell. */
#define ASPI_RINGS 16
#define ASPI_SECTORS 16
#define ASPI_CELLS ((ASPI_RINGS - 1) * ASPI_SECTORS + 1)
typedef struct aspi_histogram {
    double edge[ASPI_RINGS - 1];                 /* outer radius of each ring but the last */
    double phi0;
    double typical;                              /* what sums of the other value are large against, 1 at most */
    int planar;                                  /* cells are blocks of half the lattice's cells */
    asp_lattice lattice;
    int block_x, block_y, blocks_x;
    double count[ASPI_CELLS], sum[ASPI_CELLS], sum2[ASPI_CELLS];
    double carried[ASPI_CELLS];                  /* samples whose weight is not 0 */
    double density[ASPI_CELLS], value[ASPI_CELLS];  /* integrals of a density and of another value */
} aspi_histogram;

/* Per unit solid angle of facets, at facet m: a probability density and another value. */
typedef void aspi_facet_function(const void *context, asp_vec3 m, double *density, double *value);

/* No ring but the open one reaches beyond `most`. */
void aspi_histogram_edges(aspi_histogram *h, double *radii, size_t count, double phi0, double most);
/* The same for a surface counted in cells: blocks of half cells, their edges inside the lattice's. */
void aspi_histogram_blocks(aspi_histogram *h, const asp_lattice *lattice);
void aspi_histogram_add(aspi_histogram *h, const asp_ndf *ndf, asp_vec3 m, double weight);
void aspi_histogram_integrate(aspi_histogram *h, const aspi_trial *t, aspi_facet_function *f,
                              const void *context);
/* p of counts against density, and of weight sums against value, the latter without the open cell. */
double aspi_histogram_count_p(const aspi_histogram *h, double samples);
double aspi_histogram_weight_p(const aspi_histogram *h, double samples);

/* ---- quadrature (quadrature.c) */

/* Nodes and weights of Gauss-Legendre's rule on [0, 1], n <= 32. */
void aspi_gauss(int n, double *node, double *weight);

/* Integral of f(r) dr/r over all r > 0 by the trapezoidal rule in log r; what lies beyond the last
 * node is the geometric series that the last nodes follow. Scale-free: no roughness is assumed. */
typedef double aspi_radial_function(const void *context, double r, int index);
double aspi_radial_integral(aspi_radial_function *f, const void *context);

/* sigma of a view of height w and horizontal length s in the standard frame, from D alone. */
double aspi_sigma_by_quadrature(const aspi_trial *t, double w, double s);

/* sigma(w) by quadrature, with the height of w' raised a little. */
double aspi_sigma_expected(const aspi_trial *t, asp_vec3 w, double raise);

/* Integral of the visible normals' density over facets by quadrature, and the stated error of sigma there
 * (law_masking.c). */
double aspi_visible_integral(const aspi_trial *t, asp_vec3 w, double *doubt);

/* ---- surfaces counted in cells (planar.c) */

/* w' = (M^T w_xy, w.z - w_xy.t). */
asp_vec3 aspi_standard_vector(const asp_ndf *ndf, asp_vec3 w);
/* Rounding of the height of w' over the farthest corner of the cells; 0 for a round surface. */
double aspi_lattice_step(const aspi_trial *t, asp_vec3 w);
/* Integral over the cells of a function that is linear within each, where v sees it: where
 * v.z - v.x x - v.y y > 0. */
typedef double aspi_planar_function(const void *context, double x, double y);
double aspi_planar_integral(const aspi_trial *t, asp_vec3 v, aspi_planar_function *f,
                            const void *context);
double aspi_planar_density(const aspi_trial *t, double x, double y);   /* of standard slopes, from D */
double aspi_planar_mass(const aspi_trial *t);
double aspi_planar_slope_mass(const aspi_trial *t);
double aspi_planar_moment(const aspi_trial *t, int axis);
double aspi_planar_visible(const aspi_trial *t, asp_vec3 w);
void aspi_planar_bounds(const aspi_trial *t, double x, double y, double lost_x, double lost_y,
                        double *low, double *high);

/* Directional albedo of the first channel, integral of eval_cos over wo, by adaptive cubature in
 * the slope plane; wi.z > 0. tolerance is absolute, and of the estimated error, which is usually
 * far too large; *error (may be NULL) is that estimate. NaN when out of memory. */
double aspi_albedo(const asp_material *mat, asp_vec3 wi, double tolerance, double *error);

#endif
