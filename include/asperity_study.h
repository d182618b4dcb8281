/* asperity_study.h - beside the core's own formulas: those of the papers, oracles, microflakes
 *
 *   1  Oracles       visible normals by rejection, from a stream of uniform numbers
 *   2  Walter        the sampler of the Ellipsoid NDF's own paper
 *   3  Microflakes   SGGX: the same ellipsoid in a volume
 *   4  Masking       Lambda by the formulas of the STD paper
 *
 * Part of the core library: libm only, no allocation, nothing global. */
#ifndef ASPERITY_STUDY_H
#define ASPERITY_STUDY_H

#include "asperity.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------ 1  Oracles
 *
 * Exact visible normals, density max(0, wi.m) D(m)/sigma(wi), by constructions that share nothing with
 * asp_sample_visible: no inversion, no sigma, no table of the model's. They take as many uniform
 * numbers as they need, so no stratification survives; use them to test samplers. float64, the bits the
 * same everywhere. */

typedef enum asp_oracle_kind {
    ASP_ORACLE_STUDENT,   /* reflect and tail, in closed form: Student's t and all that are it (ggx,
                             ellipsoid, beckmann, phong, ...). At most 1.22 trials, 3.75 for views
                             from below the mean plane */
    ASP_ORACLE_RADIAL     /* any distribution that is radially symmetric behind its slope map, from D
                             alone: radii by a table of P22 on the standard surface */
} asp_oracle_kind;

#define ASP_ORACLE_CELLS 1024

/* About 33 KB. Make it with asp_oracle_make and do not move what it points to. */
typedef struct asp_oracle {
    const asp_ndf *ndf;
    int    kind;
    double n;                 /* Student: gamma - 1, infinite for Beckmann */
    double m0;                /* and its projected area seen from the horizon */
    asp_ndf standard;         /* Radial: the surface without its map, */
    double first, step;       /* cells equal in log r; in each an upper bound of P22, */
    double bound[ASP_ORACLE_CELLS];
    double plain[ASP_ORACLE_CELLS + 1], tail[ASP_ORACLE_CELLS + 1];   /* and masses up to it of the
                                 majorants of r P22 dr and r^2 P22 dr */
} asp_oracle;

/* `ndf` must outlive the oracle. Radial bounds P22 in a cell by its largest value at nine places in and
 * around it times the spread of r: exact where P22 falls with r, as all of the documents' do; elsewhere
 * exact up to features narrower than 1/8 of a cell, which is at most 0.3 of r. ASP_EINVAL: kind STUDENT
 * of another distribution; kind RADIAL where more than 1e-9 of the area lies beyond slopes of 1e74 (gamma
 * below about 1.56), or P22 differs between azimuths. Takes about a millisecond. */
asp_status asp_oracle_make(const asp_ndf *ndf, asp_oracle_kind kind, asp_oracle *out, asp_error *err);

/* A visible normal seen from wi, which may lie below the horizon or the mean plane. The zero vector
 * where nothing was found in 1e7 trials: nothing is to be seen from there. */
asp_vec3 asp_oracle_visible(const asp_oracle *oracle, asp_vec3 wi, asp_uniforms *next, void *state);

/* ------------------------------------------------------------------ 2  Walter
 *
 * Visible normals of the Ellipsoid NDF by the steps (a) to (d) of section 4.1 of Walter, Dong, Marschner,
 * Greenberg 2014: a concentric map of the square to the disk (Shirley, Chiu 1997), the disk compressed
 * to a crescent, lifted to the sphere and carried back by A^T. A row-major and invertible, det A of either
 * sign, any scale; wi any direction from which something is seen. Same law as asp_sample_visible, another
 * map of (u1, u2), with less distortion. As a reflection sampler its weight with the min mask never
 * exceeds 1 (eq. 52). */
asp_vec3 asp_sample_visible_walter(const double A[9], asp_vec3 wi, double u1, double u2);

/* ------------------------------------------------------------------ 3  Microflakes
 *
 * SGGX (Heitz, Dupuy, Crassin, Dachsbacher 2015): flakes whose normals are those of an ellipsoid, over
 * the full sphere, S = A^T A with the A of the Ellipsoid NDF (Walter et al., section 5.2):
 *
 *     sigma(w) = sqrt(w^T S w)                         projected area of the flakes seen from w
 *     D(m)     = 1 / (pi sqrt(det S) (m^T S^-1 m)^2)   normalised so that its projection is sigma:
 *                                                      integral of max(0, w.m) D(m) over the sphere
 *     visible  = max(0, w.m) D(m) / sigma(w)           the phase function's normals
 *
 * Its scale counts: 2 A has twice the area. The integral of D is the area of all flakes, 4 times the mean
 * of sigma over directions. The Ellipsoid NDF is its upper half per unit of ground:
 * D_ellipsoid(m) = D(m)/sigma(n) for m.n > 0, and sigma_ellipsoid(w) + sigma_ellipsoid(-w) =
 * sigma(w)/sigma(n), n = (0, 0, 1). */
typedef struct asp_sggx { double a11, a12, a13, a22, a23, a33; } asp_sggx;   /* A upper triangular */
typedef struct asp_sggxf { float a11, a12, a13, a22, a23, a33; } asp_sggxf;

/* From any invertible A, row-major; from the symmetric S, positive definite; from an axis (any length)
 * and the projected areas along it and across it: (1, alpha) is a rough leaf, (alpha, 1) a fibre.
 * ASP_EINVAL: numbers outside [1e-100, 1e100] or [1e-6, 1e6] for the areas, dependent columns. */
asp_status asp_sggx_from_matrix(const double A[9], asp_sggx *out, asp_error *err);
asp_status asp_sggx_from_gram(const double S[9], asp_sggx *out, asp_error *err);
asp_status asp_sggx_from_axis(asp_vec3 axis, double along, double across, asp_sggx *out, asp_error *err);
void       asp_sggx_to_gram(const asp_sggx *flakes, double S[9]);
asp_sggxf  asp_sggx_narrow(const asp_sggx *flakes);

/* Directions are unit vectors. The sample is a closed form, continuous in (u1, u2). Relative errors:
 * float64 rounding times A's condition; float32 D 1e-6 and sigma 3e-7 for moderate A, and 5e-8 over the
 * cosine w.m for the density. */
double   asp_sggx_D(const asp_sggx *flakes, asp_vec3 m);
double   asp_sggx_sigma(const asp_sggx *flakes, asp_vec3 w);
double   asp_sggx_pdf_visible(const asp_sggx *flakes, asp_vec3 wi, asp_vec3 m);
asp_vec3 asp_sggx_sample_visible(const asp_sggx *flakes, asp_vec3 wi, double u1, double u2);
float     asp_sggx_Df(const asp_sggxf *flakes, asp_vec3f m);
float     asp_sggx_sigmaf(const asp_sggxf *flakes, asp_vec3f w);
float     asp_sggx_pdf_visiblef(const asp_sggxf *flakes, asp_vec3f wi, asp_vec3f m);
asp_vec3f asp_sggx_sample_visiblef(const asp_sggxf *flakes, asp_vec3f wi, float u1, float u2);

/* Batches, as in asperity.h: bit for bit the single calls, outputs may be inputs. */
void asp_sggx_D_n(const asp_sggx *flakes, size_t n, asp_cvec3s m, double *out);
void asp_sggx_sigma_n(const asp_sggx *flakes, size_t n, asp_cvec3s w, double *out);
void asp_sggx_pdf_visible_n(const asp_sggx *flakes, size_t n, asp_cvec3s wi, asp_cvec3s m, double *out);
void asp_sggx_sample_visible_n(const asp_sggx *flakes, size_t n, asp_cvec3s wi, const double *u1,
                               const double *u2, asp_vec3s m);
void asp_sggx_D_nf(const asp_sggxf *flakes, size_t n, asp_cvec3sf m, float *out);
void asp_sggx_sigma_nf(const asp_sggxf *flakes, size_t n, asp_cvec3sf w, float *out);
void asp_sggx_pdf_visible_nf(const asp_sggxf *flakes, size_t n, asp_cvec3sf wi, asp_cvec3sf m, float *out);
void asp_sggx_sample_visible_nf(const asp_sggxf *flakes, size_t n, asp_cvec3sf wi, const float *u1,
                                const float *u2, asp_vec3sf m);

/* ------------------------------------------------------------------ 4  Masking */

/* Lambda of Student's t by the formulas of its paper (Ribardiere et al. 2017), gamma as there, nu =
 * cot(theta_v)/sigma >= 0: nu is infinite along the normal, and 0 at the horizon gives infinity. Forms:
 *
 *   exact           what asp_lambda gives: relative error 1e-12 of Lambda itself; gamma in (1.5, inf]
 *   hypergeometric  eq. 13 with Gamma and 2F1, gamma in (1.5, 1e6]. 2F1 itself is good to 1e-14, but
 *                   the terms of eq. 13 cancel: an absolute error of about 1e-15 remains, which for nu
 *                   up to 6 is 5e-8 of Lambda at gamma = 10, 7 % at 40 and all of it from 100 on
 *   integer         eq. 21 (its 4 gamma - 1 read as 4^(gamma - 1)), gamma = 2, 3, ..., 500. The sum's
 *                   terms grow and cancel: G1 errs by 3e-12 at gamma = 20, 1e-9 at 30, 1e-6 at 40, and
 *                   30 times as much per 5 beyond, which is nonsense soon after
 *   half_integer    the same for gamma = 2.5, 3.5, ..., 499.5
 *   rational        eq. 13 with S2 by eqs. 22-23, as printed and not clamped, gamma in (1.5, 1e6]. The
 *                   paper fitted it up to 40: G1 errs by at most 0.715 %, and between gamma of about 2
 *                   and 5.9 Lambda falls to -0.0045, so that G1 rises to 1.0045; it is never zero along
 *                   the normal. Clamp it at 0 where G1 <= 1 is needed
 *
 * A form applied outside its gamma is ASP_EINVAL, an unknown one ASP_EUNKNOWN. `exact` prepares the
 * distribution at each call; for many directions make one and call asp_lambda. */
asp_status asp_student_lambda(const char *form, double gamma, double nu, double *out, asp_error *err);

#ifdef __cplusplus
}
#endif
#endif
