/* patches.h - tables of 32 polynomials of degree 7: by octaves of a share, and over patches of a square
 *
 * A table holds row after row: 32 first coefficients, 32 second ones, ... Octaves have ASP_PATCH_TERMS rows,
 * patches ASP_PATCH_ROWS times as many, powers of y after powers of x. Read once per precision. */

#include "asperity/elementary.h"

#ifndef ASP_PATCHES
#define ASP_PATCHES 32
#define ASP_PATCH_TERMS 8     /* powers of x, */
#define ASP_PATCH_ROWS 6      /* and of y */
#define ASP_OCTAVES_NUMBERS (ASP_PATCHES * ASP_PATCH_TERMS)
#define ASP_PATCHES_NUMBERS (ASP_OCTAVES_NUMBERS * ASP_PATCH_ROWS)
/* The least share that octaves tell apart, and the largest. */
#define ASP_OCTAVES_LEAST R(0x1p-33)
#define ASP_OCTAVES_MOST (ASP_PRECISION == 64 ? R(0x1.fffffffffffffp-2) : R(0x1.fffffep-2))
#define aspi_share ASP_NAME(aspi_share)
#define aspi_octave ASP_NAME(aspi_octave)
#define aspi_octaves ASP_NAME(aspi_octaves)
#define aspi_patch ASP_NAME(aspi_patch)
#define aspi_octaves_n ASP_NAME(aspi_octaves_n)
#define aspi_patches_n ASP_NAME(aspi_patches_n)
#define aspi_patches_ready ASP_NAME(aspi_patches_ready)

/* c0 + ... + c7 t^7 by halves, with a chain of three products; and six rows in powers of y. For numbers
 * and for registers of them. */
#define ASP_PATCH_ROW(PLUS, TIMES, C, t, t2, t4) \
    PLUS(PLUS(PLUS(C(0), TIMES(C(1), t)), TIMES(PLUS(C(2), TIMES(C(3), t)), t2)), \
         TIMES(PLUS(PLUS(C(4), TIMES(C(5), t)), TIMES(PLUS(C(6), TIMES(C(7), t)), t2)), t4))
#define ASP_PATCH_SUM(PLUS, TIMES, r0, r1, r2, r3, r4, r5, y, y2) \
    PLUS(PLUS(PLUS(r0, TIMES(r1, y)), TIMES(PLUS(r2, TIMES(r3, y)), y2)), \
         TIMES(PLUS(r4, TIMES(r5, y)), TIMES(y2, y2)))

/* For loops over many elements a table may be made ready once: in `space`, n + ASP_PATCHES_SPARE numbers, the first n
 * of the table in the order that suits the machine, n a multiple of ASP_OCTAVES_NUMBERS; of these `octaves` are
 * tables of octaves, one after the other, and what is left is one of patches. NULL where the table itself will do. */
#define ASP_PATCHES_SPARE (64 / sizeof(asp_real))
const double *aspi_patches_ready_64(const double *table, size_t octaves, size_t n, double *space);
const float *aspi_patches_ready_32(const float *table, size_t octaves, size_t n, float *space);
/* out[i] = aspi_octaves(table, u[i]), and aspi_patch(table, at[i], x[i], y[i]); at within 0 ... 31. Of the arrays in
 * none overlaps `out`. ready: the same place of what was made ready, or NULL. */
void aspi_octaves_n_64(const double *table, const double *ready, size_t n, const double *u, double *out);
void aspi_octaves_n_32(const float *table, const float *ready, size_t n, const float *u, float *out);
void aspi_patches_n_64(const double *table, const double *ready, size_t n, const int *at, const double *x,
                       const double *y, double *out);
void aspi_patches_n_32(const float *table, const float *ready, size_t n, const int *at, const float *x,
                       const float *y, float *out);
#endif

#if (ASP_PRECISION == 64 && !defined(ASP_PATCHES_64)) || \
    (ASP_PRECISION == 32 && !defined(ASP_PATCHES_32))
#if ASP_PRECISION == 64
#define ASP_PATCHES_64
#define ASP_PATCH_BITS 52
#define ASP_PATCH_BIAS 1023
#else
#define ASP_PATCHES_32
#define ASP_PATCH_BITS 23
#define ASP_PATCH_BIAS 127
#endif

/* The smaller of u and 1 - u, from ASP_OCTAVES_LEAST up to below 1/2. */
ASP_FN asp_real aspi_share(asp_real u)
{
    return aspi_min(aspi_max(aspi_min(u, R(1.0) - u), ASP_OCTAVES_LEAST), ASP_OCTAVES_MOST);
}

/* The octave of such a share v: 0 from 1/4 to 1/2, 1 from 1/8 to 1/4 ... 31. */
ASP_FN int aspi_octave(asp_real v)
{
    return (ASP_PATCH_BIAS - 2 - (int)(aspi_to_bits(v) >> ASP_PATCH_BITS)) & (ASP_PATCHES - 1);
}

#define PLUS(a, b) ((a) + (b))
#define TIMES(a, b) ((a) * (b))

/* The polynomial of u's share in t, from -1/2 to 1/2 over an octave. A NaN comes out. */
ASP_FN asp_real aspi_octaves(const asp_real *table, asp_real u)
{
    const asp_bits one = (asp_bits)ASP_PATCH_BIAS << ASP_PATCH_BITS, fraction = ((asp_bits)1 << ASP_PATCH_BITS) - 1u;
    asp_real v = aspi_share(u);
    int i = aspi_octave(v);
    asp_real t = aspi_from_bits((aspi_to_bits(v) & fraction) | one) - R(1.5), t2 = t * t, t4 = t2 * t2, y;
#define C(j) table[(j) * ASP_PATCHES + i]
    y = ASP_PATCH_ROW(PLUS, TIMES, C, t, t2, t4);
#undef C
    return v == v ? y : v;
}

/* Patch i in x and y, each from -1 to 1. */
ASP_FN asp_real aspi_patch(const asp_real *table, int i, asp_real x, asp_real y)
{
    asp_real x2 = x * x, x4 = x2 * x2, r0, r1, r2, r3, r4, r5;
#define C0(j) table[(j) * ASP_PATCHES + i]
#define C1(j) table[((j) + 8) * ASP_PATCHES + i]
#define C2(j) table[((j) + 16) * ASP_PATCHES + i]
#define C3(j) table[((j) + 24) * ASP_PATCHES + i]
#define C4(j) table[((j) + 32) * ASP_PATCHES + i]
#define C5(j) table[((j) + 40) * ASP_PATCHES + i]
    r0 = ASP_PATCH_ROW(PLUS, TIMES, C0, x, x2, x4);
    r1 = ASP_PATCH_ROW(PLUS, TIMES, C1, x, x2, x4);
    r2 = ASP_PATCH_ROW(PLUS, TIMES, C2, x, x2, x4);
    r3 = ASP_PATCH_ROW(PLUS, TIMES, C3, x, x2, x4);
    r4 = ASP_PATCH_ROW(PLUS, TIMES, C4, x, x2, x4);
    r5 = ASP_PATCH_ROW(PLUS, TIMES, C5, x, x2, x4);
#undef C0
#undef C1
#undef C2
#undef C3
#undef C4
#undef C5
    return ASP_PATCH_SUM(PLUS, TIMES, r0, r1, r2, r3, r4, r5, y, y * y);
}
#undef PLUS
#undef TIMES
#undef ASP_PATCH_BITS
#undef ASP_PATCH_BIAS
#endif
