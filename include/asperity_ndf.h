/* asperity_ndf.h - write a distribution or a scattering model of your own
 *
 * A distribution is one file. It reads itself twice, once per precision, and ends in its record;
 * docs/new-distribution.md is the recipe, src/ndf/ggx.c the shortest example:
 *
 *     #ifndef ASP_PRECISION
 *     #include "asperity_ndf.h"
 *     #define ASP_NDF toy
 *     (its parameter table and, if it prepares anything, its prepare function)
 *     #define ASP_PRECISION 64
 *     #include "toy.c"
 *     #undef ASP_PRECISION
 *     #define ASP_PRECISION 32
 *     #include "toy.c"
 *     #undef ASP_PRECISION
 *     ASP_RECORD asp_model asp_model_toy = { "toy", ..., ASP_NDF_OPS(toy) };
 *     #undef ASP_NDF
 *     #else
 *     #include "asperity/elementary.h"
 *     (four formulas of the standard surface: ndf_density, ndf_sigma, ndf_visible, ndf_normal)
 *     #include "asperity/ndf_loops.h"
 *     #endif
 *
 * The standard surface is radially symmetric in slopes and has unit roughness. Its four formulas
 * take homogeneous arguments, so that nothing is normalised twice and no cosine divides:
 *
 *   asp_real ndf_density(const asp_shape *k, asp_real r2, asp_real z2)
 *       density of normals of the vector (x, y, z), r2 = x^2 + y^2 >= 0, z2 = z^2 > 0:
 *       P22(r2/z2) / z2^2, homogeneous of degree -4 in the vector.
 *   asp_real ndf_sigma(const asp_shape *k, asp_real w, asp_real s2)
 *       projected area seen from the vector with height w (of either sign) and horizontal length
 *       s, s2 = s^2; homogeneous of degree 1. sigma(w) - sigma(-w) = w. s2 = 0 gives max(w, 0).
 *   asp_v3 ndf_visible(const asp_shape *k, asp_v3 v, asp_real u1, asp_real u2)
 *       a visible normal seen from v (any length, v.z of either sign), any length, z >= 0; its
 *       density over normals is max(0, v.m) D(m) / sigma(v). Continuous in (u1, u2) if it can be.
 *   asp_v3 ndf_normal(const asp_shape *k, asp_real u1, asp_real u2)
 *       a normal of any length with density D(m) m.z.
 *
 * A standard surface that is not radially symmetric defines ASP_NDF_PLANAR before its first reading;
 * then two of the formulas take the vector itself, in the standard frame:
 *
 *   asp_real ndf_density(const asp_shape *k, asp_v3 m)      P22(-m.x/m.z, -m.y/m.z) / m.z^4, m.z > 0
 *   asp_real ndf_sigma(const asp_shape *k, asp_v3 v)        any v; sigma(v) - sigma(-v) = v.(-t', 1),
 *                                                           t' the mean of the standard slopes
 *
 * k->shape[] and k->table[] hold what `prepare` wrote, k->data what the caller handed to
 * asp_ndf_make_data. Formulas are straight-line: no libm calls
 * (use asperity/elementary.h), no early returns, selections by ?:, loops of constant length only;
 * then the compiler vectorises the loops that ndf_loops.h wraps around them. */
#ifndef ASPERITY_NDF_H
#define ASPERITY_NDF_H

#include "asperity.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A number that the user sets. `low` itself is refused when low_open is 1. */
typedef struct asp_param {
    const char *name;
    double low;
    int    low_open;
    double high;          /* may be INFINITY, and infinity is then allowed */
    double initial;       /* the default */
    const char *what;     /* a line for `asperity list` */
} asp_param;

/* Everything a reflection needs of the surface: a visible normal seen from wi by the squares of its height
 * and of its cosine to wi (negative where the cosine is), which need no root, the mirrored direction, its
 * density D/(4 sigma_i), and the projected areas from both; sigma_o is of no meaning where wo points down. */
typedef struct asp_reflection {
    double wo_x, m_z2, wo_y, cosine2, wo_z, pdf, sigma_i, sigma_o;
} asp_reflection;
typedef struct asp_reflectionf {
    float wo_x, m_z2, wo_y, cosine2, wo_z, pdf, sigma_i, sigma_o;
} asp_reflectionf;

/* The same of a dielectric: F of the facet, which reflects where u3 < F; wo, of length 1 to rounding, its
 * density, and the projected area from the side of the surface where it leaves. The facet is a vector m of length
 * 1/sqrt(q): m_z, wi_m = wi.m and, of light that crosses, wo_m = -eta wo.m. Gaps hold nothing: neighbours would be
 * packed into one wide store, which waits for the last of them. */
typedef struct asp_refraction {
    double wo_x, gap0, F, gap1, wo_y, gap2, pdf, gap3, wo_z, gap4, sigma_i, gap5, q, gap6, sigma_o, gap7, m_z, gap8, wi_m,
        gap9, wo_m;
} asp_refraction;
typedef struct asp_refractionf {
    float wo_x, gap0, F, gap1, wo_y, gap2, pdf, gap3, wo_z, gap4, sigma_i, gap5, q, gap6, sigma_o, gap7, m_z, gap8, wi_m,
        gap9, wo_m;
} asp_refractionf;

/* The reflections of a block. */
typedef struct asp_reflections {
    double *wo_x, *m_z2, *wo_y, *cosine2, *wo_z, *pdf, *sigma_i, *sigma_o;
} asp_reflections;
typedef struct asp_reflectionsf {
    float *wo_x, *m_z2, *wo_y, *cosine2, *wo_z, *pdf, *sigma_i, *sigma_o;
} asp_reflectionsf;

/* The refractions of a block, but for the facets. */
typedef struct asp_refractions { double *wo_x, *wo_y, *wo_z, *F, *pdf, *sigma_i, *sigma_o; } asp_refractions;
typedef struct asp_refractionsf { float *wo_x, *wo_y, *wo_z, *F, *pdf, *sigma_i, *sigma_o; } asp_refractionsf;

/* A walk at its next facets, on a surface level on average. v is the way back, w the way out: the area seen from v,
 * D of the facets that mirror v to w and the squared cosine there. Where the walk begins also the area seen from
 * -w; after a turn the new v and the squared cosine at the facet that turned it. Gaps as above. */
typedef struct asp_meeting {
    double x, gap0, cosine2, gap1, y, gap2, between2, gap3, z, gap4, D, gap5, area, gap6,
        area_out;
} asp_meeting;
typedef struct asp_meetingf {
    float x, gap0, cosine2, gap1, y, gap2, between2, gap3, z, gap4, D, gap5, area, gap6,
        area_out;
} asp_meetingf;

/* The meetings of a block. */
typedef struct asp_meetings { double *x, *cosine2, *y, *between2, *z, *D, *area, *area_out; } asp_meetings;
typedef struct asp_meetingsf { float *x, *cosine2, *y, *between2, *z, *D, *area, *area_out; } asp_meetingsf;

/* The distribution in one precision, as the world sees it, through its slope map; ndf_loops.h makes
 * all of it from the four formulas.
 *     density    D(m): finite, 0 where m.z <= 0; m need not be unit, D is homogeneous of degree -4
 *     sigma      of any vector w, homogeneous of degree 1; the loop takes sign * w, sign = 1 or -1
 *     visible    a unit normal seen from w
 *     normal     a unit normal with density D(m) m.z
 *     reflect    visible, mirror wi in it, and what is known of both directions
 *     refract    visible, mirror wi in it or refract it by u3; eta is the index of the other side over that of
 *                the side of wi, wi.z > 0, and inverse 1/eta
 *     meet       the first meeting of a walk
 *     turn       visible, seen from v, v mirrored in it, and the meeting then
 * Loops take a block of n elements, n <= ASP_BLOCK (number.h: 256 in float32, 128 in float64), and
 * their outputs do not overlap anything else. Vectors go number by number: small structs of floats pass
 * through memory in the usual calling convention and stall there. */
typedef struct asp_ndf_ops {
    double (*density)(const asp_ndf *k, double mx, double my, double mz);
    double (*sigma)(const asp_ndf *k, double wx, double wy, double wz);
    void (*visible)(const asp_ndf *k, double wx, double wy, double wz, double u1, double u2, double m[3]);
    void (*normal)(const asp_ndf *k, double u1, double u2, double m[3]);
    void (*reflect)(const asp_ndf *k, double wi_x, double wi_y, double wi_z, double u1, double u2,
                    asp_reflection *out);
    void (*refract)(const asp_ndf *k, double wi_x, double wi_y, double wi_z, double u1, double u2, double u3,
                    double eta, double inverse, asp_refraction *out);
    void (*meet)(const asp_ndf *k, double vx, double vy, double vz, double wx, double wy, double wz,
                 asp_meeting *out);
    void (*turn)(const asp_ndf *k, double vx, double vy, double vz, double u1, double u2, double wx, double wy,
                 double wz, asp_meeting *out);
    void (*density_n)(const asp_ndf *k, size_t n, const double *mx, const double *my,
                      const double *mz, double *out);
    void (*sigma_n)(const asp_ndf *k, size_t n, double sign, const double *wx, const double *wy,
                    const double *wz, double *out);
    void (*visible_n)(const asp_ndf *k, size_t n, const double *wx, const double *wy,
                      const double *wz, const double *u1, const double *u2, double *mx, double *my,
                      double *mz);
    void (*normal_n)(const asp_ndf *k, size_t n, const double *u1, const double *u2,
                     double *mx, double *my, double *mz);
    void (*reflect_n)(const asp_ndf *k, size_t n, const double *wx, const double *wy, const double *wz,
                      const double *u1, const double *u2, const asp_reflections *out);
    void (*refract_n)(const asp_ndf *k, size_t n, const double *wx, const double *wy, const double *wz,
                      const double *u1, const double *u2, const double *u3, const double *eta,
                      const double *inverse, const asp_refractions *out);
    void (*meet_n)(const asp_ndf *k, size_t n, const double *vx, const double *vy, const double *vz,
                   const double *wx, const double *wy, const double *wz, const asp_meetings *out);
    void (*turn_n)(const asp_ndf *k, size_t n, const double *vx, const double *vy, const double *vz,
                   const double *u1, const double *u2, const double *wx, const double *wy, const double *wz,
                   const asp_meetings *out);
} asp_ndf_ops;

typedef struct asp_ndf_opsf {
    float (*density)(const asp_ndff *k, float mx, float my, float mz);
    float (*sigma)(const asp_ndff *k, float wx, float wy, float wz);
    void (*visible)(const asp_ndff *k, float wx, float wy, float wz, float u1, float u2, float m[3]);
    void (*normal)(const asp_ndff *k, float u1, float u2, float m[3]);
    void (*reflect)(const asp_ndff *k, float wi_x, float wi_y, float wi_z, float u1, float u2,
                    asp_reflectionf *out);
    void (*refract)(const asp_ndff *k, float wi_x, float wi_y, float wi_z, float u1, float u2, float u3,
                    float eta, float inverse, asp_refractionf *out);
    void (*meet)(const asp_ndff *k, float vx, float vy, float vz, float wx, float wy, float wz,
                 asp_meetingf *out);
    void (*turn)(const asp_ndff *k, float vx, float vy, float vz, float u1, float u2, float wx, float wy,
                 float wz, asp_meetingf *out);
    void (*density_n)(const asp_ndff *k, size_t n, const float *mx, const float *my,
                      const float *mz, float *out);
    void (*sigma_n)(const asp_ndff *k, size_t n, float sign, const float *wx, const float *wy,
                    const float *wz, float *out);
    void (*visible_n)(const asp_ndff *k, size_t n, const float *wx, const float *wy,
                      const float *wz, const float *u1, const float *u2, float *mx, float *my,
                      float *mz);
    void (*normal_n)(const asp_ndff *k, size_t n, const float *u1, const float *u2,
                     float *mx, float *my, float *mz);
    void (*reflect_n)(const asp_ndff *k, size_t n, const float *wx, const float *wy, const float *wz,
                      const float *u1, const float *u2, const asp_reflectionsf *out);
    void (*refract_n)(const asp_ndff *k, size_t n, const float *wx, const float *wy, const float *wz,
                      const float *u1, const float *u2, const float *u3, const float *eta,
                      const float *inverse, const asp_refractionsf *out);
    void (*meet_n)(const asp_ndff *k, size_t n, const float *vx, const float *vy, const float *vz,
                   const float *wx, const float *wy, const float *wz, const asp_meetingsf *out);
    void (*turn_n)(const asp_ndff *k, size_t n, const float *vx, const float *vy, const float *vz,
                   const float *u1, const float *u2, const float *wx, const float *wy, const float *wz,
                   const asp_meetingsf *out);
} asp_ndf_opsf;

/* How a spec gives the slope map. */
typedef enum asp_map_keys {
    ASP_KEYS_SLOPE,       /* alpha | alpha_x alpha_y, rotation | rho, mean_x mean_y */
    ASP_KEYS_ELLIPSOID    /* alpha_x alpha_y theta_x theta_y theta_z | a11..a33 | s11..s33 */
} asp_map_keys;

/* Slopes counted in cells: where they lie among the standard slopes, whose mean is 0. */
typedef struct asp_lattice { size_t nx, ny; double x0, y0, dx, dy; } asp_lattice;

struct asp_model {
    const char *name;
    const char *alias;            /* a second name, or NULL */
    const char *title;            /* one line */
    const char *source;           /* paper and equation */
    asp_map_keys keys;
    double alpha;                 /* default roughness of the map */
    int own_scale;                /* 1: the shape numbers carry a roughness themselves; the map's is a
                                     stretch, 1 unless given, and fits leave it alone */
    double area_error;            /* stated relative error of sigma in float64; 0: rounding only */
    const asp_param *params;      /* shape numbers of its own, in the order of shape[]; may be NULL */
    size_t param_count;           /* at most ASP_SHAPE_NUMBERS */
    /* Fills out->shape and out->table from the checked parameter values, already in out->shape; may
     * stretch out->map (asp_ndf_stretch), whose inverse is made afterwards. NULL if there is nothing
     * to prepare. */
    asp_status (*prepare)(asp_ndf *out, asp_error *err);
    asp_ndf_ops  f64;
    asp_ndf_opsf f32;
    /* Fills *out and returns 1 where P22 is constant within the cells of a lattice and jumps between
     * them, which laws and quadratures have to know; NULL: it never does. */
    int (*lattice)(const asp_ndf *ndf, asp_lattice *out);
};

/* For `prepare`: the standard surface is `by` times as rough as its formulas say. */
void asp_ndf_stretch(asp_ndf *out, double by);

/* A record is a constant with external linkage, in C++ too. */
#ifdef __cplusplus
#define ASP_RECORD extern const
#else
#define ASP_RECORD const
#endif

#define ASP_NDF_OPS_(n, s) { n##density_1##s, n##sigma_1##s, n##visible_1##s, n##normal_1##s, n##reflect_1##s, \
    n##refract_1##s, n##meet_1##s, n##turn_1##s, n##density_n##s, n##sigma_n##s, n##visible_n##s, n##normal_n##s, \
    n##reflect_n##s, n##refract_n##s, n##meet_n##s, n##turn_n##s }
#define ASP_NDF_OPS_LATTICE(n, lattice) ASP_NDF_OPS_(n##_, _64), ASP_NDF_OPS_(n##_, _32), lattice
#define ASP_NDF_OPS(n) ASP_NDF_OPS_LATTICE(n, NULL)

#ifdef __cplusplus
}
#endif
#endif
