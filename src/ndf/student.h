/* student.h - what the Student-t family shares: the layout of its tables and their preparation
 *
 * The standard surface has slopes of density (1 + r^2/n)^-gamma / pi, n = gamma - 1 (Ribardiere et
 * al. 2017, eq. 11 with sigma = 1); n -> infinity is Beckmann's e^-r^2 / pi. Marginal along one
 * axis: P2(q) proportional to (1 + q^2/n)^(-n - 1/2). With M(x) = int_x^inf q P2 dq and
 * T(x) = int_x^inf P2 dq, both of one elementary factor and one smooth one, x >= 0:
 *
 *     g = sqrt(1 + x^2/n),  d = a / (x/g + a)  in (0, 1],  a = 2
 *     M(x) = M0 g^(1 - 2n)
 *     T(x) = T0 g^(-2n) d B(d)
 *     J(x) = M(x) - x T(x) = M0 g^(1 - 2n) d^2 P(d)      the projected area of the far side
 *
 * P and B are analytic and of one sign on [0, 1] (their nearest singularity is at x/g = -sqrt n,
 * the far side of the pole d), so that short polynomials carry them: `table` holds these, once per
 * precision. Exactly, B d is, up to scale, sqrt(n) 2F1(1/2, n; n + 1; 1 - h^2/n) and P d^2 = 2F1(1, n -
 * 1/2; n + 1; 1 - h^2/n)/(2n), h = x/g, by Pfaff's transformation of the paper's eq. 13; both tend to
 * the error function's for n -> infinity. Errors of the fits beside rounding, for every n: P 1e-13 and
 * 2e-7, B 1e-13 and 2e-8, R 1e-13. */
#ifndef ASPI_STUDENT_H
#define ASPI_STUDENT_H

#include "asperity_ndf.h"

/* Where things lie in asp_ndf.table. A number that multiplies an exponent is kept twice: whole, and
 * as an upper part of 12 bits plus the rest, which float32 needs for products without rounding. */
enum {
    STUDENT_INVN = 0,            /* 1/n, upper, rest */
    STUDENT_GAMMA = 3,           /* gamma, upper, rest */
    STUDENT_N = 6,               /* n, upper, rest */
    STUDENT_M0 = 9,
    STUDENT_T0 = 10,
    STUDENT_SCALE = 11,          /* d scale + offset runs over [-1, 1] */
    STUDENT_OFFSET = 12,
    STUDENT_BETA = 13,           /* 1 - 1/(2n) */
    /* the conditional distribution across the view: the same family at m = n + 1/2 */
    STUDENT_Y_N = 14,            /* m, 1/m */
    STUDENT_Y_WIDTH = 16,        /* sqrt(n/m) */
    STUDENT_INV_BETA = 17,
    STUDENT_BELOW = 18,          /* 1/(2n - 1) */
    STUDENT_P32 = 32,            /* 12 coefficients of (1 - P)/(1 - d) for float32, */
    STUDENT_B32 = 46,            /* 12 of B; */
    STUDENT_P64 = 58,            /* 24 of the same for float64, */
    STUDENT_B64 = 82,            /* 24 of B, */
    STUDENT_Y64 = 106,           /* 26 of the quantile's R */
    /* sigma from above without a power (student_above), 0 where its polynomial does not reach 2e-7 */
    STUDENT_ABOVE = 132,
    STUDENT_LINEAR = 133,        /* A, B, K of its denominator */
    STUDENT_S32 = 136,           /* its value at w = 0 for s = 1, 18 coefficients */
    /* what follows is by tables (ndf/patches.h). The slope across the view, from u2: its size for the slope 0 along it */
    STUDENT_ACROSS = 160,
    /* From u1 the size of z: the slope along the view that a view along the normal sees, as r = sqrt(n log(1 + x^2/n)) */
    STUDENT_ALONG = STUDENT_ACROSS + 256,
    /* From z and the view, r with the sign of -x, in patches side by side. Over the view with p = a s/(c + a s) along
     * 1 - (b p + d sqrt p), in STUDENT_VIEWS equal steps; over z, on each side of 0, from STUDENT_EDGES on */
    STUDENT_PATCHES = STUDENT_ALONG + 256,
    STUDENT_TABLES = 256 + 256 + 1536,
    STUDENT_SHORT = STUDENT_ACROSS + STUDENT_TABLES,      /* 0 where STUDENT_PATCHES is too coarse */
    STUDENT_VIEW,                /* a, b, d */
    STUDENT_VIEWS = STUDENT_VIEW + 3,
    STUDENT_RIGHT,               /* the first patch where u1 > 1/2 */
    STUDENT_EDGES,               /* second and third edge for u1 < 1/2 and > 1/2, */
    STUDENT_SCALES = STUDENT_EDGES + 4,   /* 2/width of the first, second, third patch likewise */
    STUDENT_END = STUDENT_SCALES + 6
};

#define STUDENT_A 2.0

/* Quantile of the marginal of m = n + 1/2: with l = -log(4 u (1 - u)) and q = m log(1 + y^2/m),
 * q = l R(l/(l + STUDENT_Y_K))^2. Uniform numbers nearer to 0 or 1 than these count as these. */
#define STUDENT_Y_K 9.0
#define STUDENT_LEAST_32 0x1p-40
#define STUDENT_LEAST_64 0x1p-70
#define STUDENT_Y_END_64 0.8397   /* l/(l + k) there, rounded up: 0.83967 */

/* Fills out->table for n > 1/2, infinity included. */
void aspi_student_prepare(asp_ndf *out, double n);

/* The part of it that D and float64's sigma read. */
void aspi_student_prepare_area(asp_ndf *out, double n);

/* The part of it in student_tables.c: from the rest of the table. */
void aspi_student_fit(asp_ndf *out);

/* Values at 32 Chebyshev points of the first kind -> the first `count` power coefficients. */
void aspi_student_coefficients(const double value[32], int count, double *out);

/* Gamma(n + 1/2) / (Gamma(n) sqrt n), n > 0. */
double aspi_gamma_ratio(double n);

#endif
