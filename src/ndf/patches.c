/* patches.c - tables of 32 polynomials over arrays
 *
 * Compilers read a table element by element. With AVX-512 rows of 32 fit a few registers, which are permuted, and
 * with AVX2 (float32) the coefficients of each element are read at once: the bits are the same. */
#ifndef ASP_PRECISION
#include "asperity.h"

#define ASP_PRECISION 64
#include "patches.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "patches.c"
#undef ASP_PRECISION

#else
#include "ndf/patches.h"

#ifndef ASPI_PATCHES_NAMES
#define ASPI_PATCHES_NAMES
#define plain_octaves ASP_NAME(plain_octaves)
#define plain_patches ASP_NAME(plain_patches)
#if !defined(ASP_NO_CLONES) && defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__)
#define ASPI_PATCHES_WIDE
#include <immintrin.h>

#define WIDE_512 __attribute__((target("avx512f"))) static void
#define WIDE_256 __attribute__((target("avx2"))) static void

/* A loop of registers: a few kilobytes are too few for what memcpy does before it starts. */
WIDE_512 copy_512(const void *table, size_t bytes, void *out)
{
    size_t i;
    for (i = 0; i < bytes; i += 64)
        _mm512_store_si512((char *)out + i, _mm512_loadu_si512((const char *)table + i));
}

/* The six rows of a patch in each lane. */
#define ROWS(PLUS, TIMES, x, x2, x4, y, out) \
    do { \
        r0 = ASP_PATCH_ROW(PLUS, TIMES, C0, x, x2, x4); \
        r1 = ASP_PATCH_ROW(PLUS, TIMES, C1, x, x2, x4); \
        r2 = ASP_PATCH_ROW(PLUS, TIMES, C2, x, x2, x4); \
        r3 = ASP_PATCH_ROW(PLUS, TIMES, C3, x, x2, x4); \
        r4 = ASP_PATCH_ROW(PLUS, TIMES, C4, x, x2, x4); \
        r5 = ASP_PATCH_ROW(PLUS, TIMES, C5, x, x2, x4); \
        out = ASP_PATCH_SUM(PLUS, TIMES, r0, r1, r2, r3, r4, r5, y, TIMES(y, y)); \
    } while (0)
#define C0(j) LOOK(table + (j) * ASP_PATCHES)
#define C1(j) LOOK(table + ((j) + 8) * ASP_PATCHES)
#define C2(j) LOOK(table + ((j) + 16) * ASP_PATCHES)
#define C3(j) LOOK(table + ((j) + 24) * ASP_PATCHES)
#define C4(j) LOOK(table + ((j) + 32) * ASP_PATCHES)
#define C5(j) LOOK(table + ((j) + 40) * ASP_PATCHES)
/* ---- float32, 16 lanes */

#define LOOK(row) _mm512_permutex2var_ps(_mm512_loadu_ps(row), at, _mm512_loadu_ps((row) + 16))
#define SOME(n, i) ((n) - (i) < 16 ? (__mmask16)((1u << ((n) - (i))) - 1u) : (__mmask16)0xffffu)

WIDE_512 octaves_512_32(const float *table, size_t n, const float *u, float *out)
{
    const __m512 one = _mm512_set1_ps(1.0f);
    const __m512i first = _mm512_set1_epi32(0x7d), fraction = _mm512_set1_epi32(0x7fffff);
    size_t i;
    for (i = 0; i < n; i += 16) {
        __mmask16 some = SOME(n, i);
        __m512 v = _mm512_maskz_loadu_ps(some, u + i), t, t2, t4;
        __m512i bits, at;
        v = _mm512_maskz_min_ps(some, _mm512_sub_ps(one, v), v);
        v = _mm512_maskz_max_ps(some, _mm512_set1_ps(0x1p-33f), v);
        v = _mm512_maskz_min_ps(some, _mm512_set1_ps(0x1.fffffep-2f), v);
        bits = _mm512_castps_si512(v);
        at = _mm512_sub_epi32(first, _mm512_maskz_srli_epi32(some, bits, 23));
        bits = _mm512_or_si512(_mm512_and_si512(bits, fraction), _mm512_castps_si512(one));
        t = _mm512_sub_ps(_mm512_castsi512_ps(bits), _mm512_set1_ps(1.5f));
        t2 = _mm512_mul_ps(t, t);
        t4 = _mm512_mul_ps(t2, t2);
        t = ASP_PATCH_ROW(_mm512_add_ps, _mm512_mul_ps, C0, t, t2, t4);
        t = _mm512_mask_blend_ps(_mm512_cmp_ps_mask(v, v, _CMP_UNORD_Q), t, v);
        _mm512_mask_storeu_ps(out + i, some, t);
    }
}

WIDE_512 patches_512_32(const float *table, size_t n, const int *place, const float *x, const float *y, float *out)
{
    size_t i;
    for (i = 0; i < n; i += 16) {
        __mmask16 some = SOME(n, i);
        __m512i at = _mm512_maskz_loadu_epi32(some, place + i);
        __m512 a = _mm512_maskz_loadu_ps(some, x + i), b = _mm512_maskz_loadu_ps(some, y + i), r0, r1, r2, r3, r4, r5;
        __m512 a2 = _mm512_mul_ps(a, a), a4 = _mm512_mul_ps(a2, a2);
        ROWS(_mm512_add_ps, _mm512_mul_ps, a, a2, a4, b, a);
        _mm512_mask_storeu_ps(out + i, some, a);
    }
}
#undef LOOK
#undef SOME

/* ---- float64, 8 lanes */

#define LOOK(row) \
    _mm512_mask_blend_pd(upper, _mm512_permutex2var_pd(_mm512_loadu_pd(row), at, _mm512_loadu_pd((row) + 8)), \
                         _mm512_permutex2var_pd(_mm512_loadu_pd((row) + 16), at, _mm512_loadu_pd((row) + 24)))
#define SOME(n, i) ((n) - (i) < 8 ? (__mmask8)((1u << ((n) - (i))) - 1u) : (__mmask8)0xffu)

WIDE_512 octaves_512_64(const double *table, size_t n, const double *u, double *out)
{
    const __m512d one = _mm512_set1_pd(1.0);
    const __m512i first = _mm512_set1_epi64(0x3fd), fraction = _mm512_set1_epi64(0xfffffffffffff);
    size_t i;
    for (i = 0; i < n; i += 8) {
        __mmask8 some = SOME(n, i), upper;
        __m512d v = _mm512_maskz_loadu_pd(some, u + i), t, t2, t4;
        __m512i bits, at;
        v = _mm512_maskz_min_pd(some, _mm512_sub_pd(one, v), v);
        v = _mm512_maskz_max_pd(some, _mm512_set1_pd(0x1p-33), v);
        v = _mm512_maskz_min_pd(some, _mm512_set1_pd(0x1.fffffffffffffp-2), v);
        bits = _mm512_castpd_si512(v);
        at = _mm512_sub_epi64(first, _mm512_maskz_srli_epi64(some, bits, 52));
        upper = _mm512_test_epi64_mask(at, _mm512_set1_epi64(16));
        bits = _mm512_or_si512(_mm512_and_si512(bits, fraction), _mm512_castpd_si512(one));
        t = _mm512_sub_pd(_mm512_castsi512_pd(bits), _mm512_set1_pd(1.5));
        t2 = _mm512_mul_pd(t, t);
        t4 = _mm512_mul_pd(t2, t2);
        t = ASP_PATCH_ROW(_mm512_add_pd, _mm512_mul_pd, C0, t, t2, t4);
        t = _mm512_mask_blend_pd(_mm512_cmp_pd_mask(v, v, _CMP_UNORD_Q), t, v);
        _mm512_mask_storeu_pd(out + i, some, t);
    }
}

WIDE_512 patches_512_64(const double *table, size_t n, const int *place, const double *x, const double *y,
                        double *out)
{
    int rest[8] = { 0, 0, 0, 0, 0, 0, 0, 0 };
    size_t i;
    for (i = 0; i < n; i += 8) {
        __mmask8 some = SOME(n, i), upper;
        const int *from = n - i < 8 ? (const int *)memcpy(rest, place + i, (n - i) * sizeof *place) : place + i;
        __m512i at = _mm512_maskz_cvtepi32_epi64(some, _mm256_loadu_si256((const __m256i *)(const void *)from));
        __m512d a = _mm512_maskz_loadu_pd(some, x + i), b = _mm512_maskz_loadu_pd(some, y + i), r0, r1, r2, r3, r4, r5;
        __m512d a2 = _mm512_mul_pd(a, a), a4 = _mm512_mul_pd(a2, a2);
        upper = _mm512_test_epi64_mask(at, _mm512_set1_epi64(16));
        ROWS(_mm512_add_pd, _mm512_mul_pd, a, a2, a4, b, a);
        _mm512_mask_storeu_pd(out + i, some, a);
    }
}
#undef LOOK
#undef SOME

#undef C0
#undef C1
#undef C2
#undef C3
#undef C4
#undef C5

/* ---- float32, 8 lanes, whole registers only: each lane's eight coefficients side by side, then turned */

#define TURN(row, c, half) \
    do { \
        __m256 a0, a1, a2, a3, b0, b1, b2, b3; \
        a0 = PAIR((row)[0] + 4 * (half), (row)[4] + 4 * (half)); \
        a1 = PAIR((row)[1] + 4 * (half), (row)[5] + 4 * (half)); \
        a2 = PAIR((row)[2] + 4 * (half), (row)[6] + 4 * (half)); \
        a3 = PAIR((row)[3] + 4 * (half), (row)[7] + 4 * (half)); \
        b0 = _mm256_unpacklo_ps(a0, a1); \
        b1 = _mm256_unpackhi_ps(a0, a1); \
        b2 = _mm256_unpacklo_ps(a2, a3); \
        b3 = _mm256_unpackhi_ps(a2, a3); \
        (c)[4 * (half)] = _mm256_shuffle_ps(b0, b2, 0x44); \
        (c)[4 * (half) + 1] = _mm256_shuffle_ps(b0, b2, 0xee); \
        (c)[4 * (half) + 2] = _mm256_shuffle_ps(b1, b3, 0x44); \
        (c)[4 * (half) + 3] = _mm256_shuffle_ps(b1, b3, 0xee); \
    } while (0)
#define PAIR(low, high) \
    _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(low)), _mm_loadu_ps(high), 1)
#define C(j) c[j]

/* out: 8 numbers to each of 32, `apart` from one to the next. */
WIDE_256 turn_256(const float *table, size_t apart, float *out)
{
    int i, j;
    for (i = 0; i < ASP_PATCHES; i += 8) {
        const float *row[8];
        __m256 c[8];
        for (j = 0; j < 8; j++)
            row[j] = table + j * ASP_PATCHES + i;
        TURN(row, c, 0);
        TURN(row, c, 1);
        for (j = 0; j < 8; j++)
            _mm256_storeu_ps(out + (size_t)(i + j) * apart, c[j]);
    }
}

WIDE_256 octaves_256_32(const float *ready, size_t n, const float *u, float *out)
{
    const __m256 one = _mm256_set1_ps(1.0f);
    const __m256i first = _mm256_set1_epi32(0x7d), fraction = _mm256_set1_epi32(0x7fffff);
    int place[8], j;
    size_t i;
    for (i = 0; i < n; i += 8) {
        __m256 v = _mm256_loadu_ps(u + i), t, t2, t4, c[8];
        const float *row[8];
        __m256i bits, at;
        v = _mm256_min_ps(_mm256_sub_ps(one, v), v);
        v = _mm256_max_ps(_mm256_set1_ps(0x1p-33f), v);
        v = _mm256_min_ps(_mm256_set1_ps(0x1.fffffep-2f), v);
        bits = _mm256_castps_si256(v);
        at = _mm256_and_si256(_mm256_sub_epi32(first, _mm256_srli_epi32(bits, 23)),
                              _mm256_set1_epi32(ASP_PATCHES - 1));
        _mm256_storeu_si256((__m256i *)(void *)place, at);
        for (j = 0; j < 8; j++)
            row[j] = ready + place[j] * ASP_PATCH_TERMS;
        TURN(row, c, 0);
        TURN(row, c, 1);
        bits = _mm256_or_si256(_mm256_and_si256(bits, fraction), _mm256_castps_si256(one));
        t = _mm256_sub_ps(_mm256_castsi256_ps(bits), _mm256_set1_ps(1.5f));
        t2 = _mm256_mul_ps(t, t);
        t4 = _mm256_mul_ps(t2, t2);
        t = ASP_PATCH_ROW(_mm256_add_ps, _mm256_mul_ps, C, t, t2, t4);
        _mm256_storeu_ps(out + i, _mm256_blendv_ps(t, v, _mm256_cmp_ps(v, v, _CMP_UNORD_Q)));
    }
}

WIDE_256 patches_256_32(const float *ready, size_t n, const int *place, const float *x, const float *y, float *out)
{
    int j, p;
    size_t i;
    for (i = 0; i < n; i += 8) {
        __m256 a = _mm256_loadu_ps(x + i), b = _mm256_loadu_ps(y + i), r[ASP_PATCH_ROWS], c[8];
        __m256 a2 = _mm256_mul_ps(a, a), a4 = _mm256_mul_ps(a2, a2);
        const float *row[8];
        for (j = 0; j < 8; j++)
            row[j] = ready + place[i + (size_t)j] * (ASP_PATCH_TERMS * ASP_PATCH_ROWS);
        for (p = 0; p < ASP_PATCH_ROWS; p++) {
            TURN(row, c, 0);
            TURN(row, c, 1);
            r[p] = ASP_PATCH_ROW(_mm256_add_ps, _mm256_mul_ps, C, a, a2, a4);
            for (j = 0; j < 8; j++)
                row[j] += ASP_PATCH_TERMS;
        }
        a = ASP_PATCH_SUM(_mm256_add_ps, _mm256_mul_ps, r[0], r[1], r[2], r[3], r[4], r[5], b,
                          _mm256_mul_ps(b, b));
        _mm256_storeu_ps(out + i, a);
    }
}
#undef TURN
#undef PAIR
#undef C
#undef ROWS
#undef WIDE_512
#undef WIDE_256
#endif
#endif

ASP_CLONES static void plain_octaves(const asp_real *table, size_t n, const asp_real *ASP_RESTRICT u,
                                     asp_real *ASP_RESTRICT out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = aspi_octaves(table, u[i]);
}

ASP_CLONES static void plain_patches(const asp_real *table, size_t n, const int *ASP_RESTRICT at,
                                     const asp_real *ASP_RESTRICT x, const asp_real *ASP_RESTRICT y,
                                     asp_real *ASP_RESTRICT out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = aspi_patch(table, at[i], x[i], y[i]);
}

const asp_real *aspi_patches_ready(const asp_real *table, size_t octaves, size_t n, asp_real *space)
{
#ifdef ASPI_PATCHES_WIDE
    /* rows that begin with a line of the cache are read twice as fast */
    asp_real *out = space + (64 - ((uintptr_t)space & 63)) / sizeof *space;
    if (__builtin_cpu_supports("avx512f")) {
        copy_512(table, n * sizeof *table, out);
        return out;
    }
#if ASP_PRECISION == 32
    if (__builtin_cpu_supports("avx2")) {
        size_t i, rows = n / ASP_OCTAVES_NUMBERS;
        for (i = 0; i < octaves; i++)
            turn_256(table + i * ASP_OCTAVES_NUMBERS, ASP_PATCH_TERMS, out + i * ASP_OCTAVES_NUMBERS);
        for (; i < rows; i++)
            turn_256(table + i * ASP_OCTAVES_NUMBERS, ASP_PATCH_TERMS * ASP_PATCH_ROWS,
                     out + octaves * ASP_OCTAVES_NUMBERS + (i - octaves) * ASP_PATCH_TERMS);
        return out;
    }
#endif
#endif
    (void)table;
    (void)octaves;
    (void)n;
    (void)space;
    return NULL;
}

void aspi_octaves_n(const asp_real *table, const asp_real *ready, size_t n, const asp_real *u, asp_real *out)
{
#ifdef ASPI_PATCHES_WIDE
    if (__builtin_cpu_supports("avx512f")) {
        ASP_NAME(octaves_512)(ready ? ready : table, n, u, out);
        return;
    }
#if ASP_PRECISION == 32
    if (ready && __builtin_cpu_supports("avx2")) {
        size_t whole = n - n % 8;
        octaves_256_32(ready, whole, u, out);
        u += whole;
        out += whole;
        n -= whole;
    }
#endif
#endif
    (void)ready;
    plain_octaves(table, n, u, out);
}

void aspi_patches_n(const asp_real *table, const asp_real *ready, size_t n, const int *at, const asp_real *x,
                    const asp_real *y, asp_real *out)
{
#ifdef ASPI_PATCHES_WIDE
    if (__builtin_cpu_supports("avx512f")) {
        ASP_NAME(patches_512)(ready ? ready : table, n, at, x, y, out);
        return;
    }
#if ASP_PRECISION == 32
    if (ready && __builtin_cpu_supports("avx2")) {
        size_t whole = n - n % 8;
        patches_256_32(ready, whole, at, x, y, out);
        at += whole;
        x += whole;
        y += whole;
        out += whole;
        n -= whole;
    }
#endif
#endif
    (void)ready;
    plain_patches(table, n, at, x, y, out);
}
#endif
