/* pieces.c - tables of 32 over arrays
 *
 * Compilers read a table element by element. Where rows of 32 fit two registers (AVX-512) they are permuted
 * instead, which only selects: the bits are the same. */
#ifndef ASP_PRECISION
#include "asperity.h"

#define ASP_PRECISION 64
#include "pieces.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "pieces.c"
#undef ASP_PRECISION

#else
#include "ndf/pieces.h"

#ifndef ASPI_PIECES_NAMES
#define ASPI_PIECES_NAMES
#define plain_pieces ASP_NAME(plain_pieces)
#define plain_knots ASP_NAME(plain_knots)
#define plain_rows ASP_NAME(plain_rows)
#if !defined(ASP_NO_CLONES) && defined(__x86_64__) && defined(__gnu_linux__) && defined(__GNUC__)
#define ASPI_PIECES_AVX512
#include <immintrin.h>

#define FROM(row, at) _mm512_permutex2var_ps(_mm512_loadu_ps(row), at, _mm512_loadu_ps((row) + 16))
#define ROW(r) FROM(table + (r) * ASP_PIECES, piece)
#define SOME(n, i) ((n) - (i) < 16 ? (__mmask16)((1u << ((n) - (i))) - 1u) : (__mmask16)0xffffu)
#define PLUS_TIMES(a, b, c) _mm512_add_ps(a, _mm512_mul_ps(b, c))

/* aspi_pieces, 8 or 16 elements at a time. */
#define FROM_64(row, at, upper) \
    _mm512_mask_blend_pd(upper, _mm512_permutex2var_pd(_mm512_loadu_pd(row), at, _mm512_loadu_pd((row) + 8)), \
                         _mm512_permutex2var_pd(_mm512_loadu_pd((row) + 16), at, _mm512_loadu_pd((row) + 24)))
#define ROW_64(r) FROM_64(table + (r) * ASP_PIECES, piece, upper)
#define SOME_64(n, i) ((n) - (i) < 8 ? (__mmask8)((1u << ((n) - (i))) - 1u) : (__mmask8)0xffu)
#define PLUS_TIMES_64(a, b, c) _mm512_add_pd(a, _mm512_mul_pd(b, c))

__attribute__((target("avx512f")))
static void wide_pieces_64(const double *table, int first, size_t n, const double *q, const double *y, double *out)
{
    size_t i;
    for (i = 0; i < n; i += 8) {
        __mmask8 some = SOME_64(n, i), upper;
        __m512i bits = _mm512_castpd_si512(_mm512_maskz_loadu_pd(some, q + i));
        __m512i piece = _mm512_sub_epi64(_mm512_maskz_srli_epi64(some, bits, 51), _mm512_set1_epi64(first));
        __m512d t, t2, low, high;
        piece = _mm512_maskz_max_epi64(some, piece, _mm512_setzero_si512());
        piece = _mm512_maskz_min_epi64(some, piece, _mm512_set1_epi64(ASP_PIECES - 1));
        upper = _mm512_test_epi64_mask(piece, _mm512_set1_epi64(16));
        t = _mm512_sub_pd(_mm512_maskz_loadu_pd(some, y + i), ROW_64(0));
        t2 = _mm512_mul_pd(t, t);
        low = PLUS_TIMES_64(PLUS_TIMES_64(ROW_64(1), ROW_64(2), t), PLUS_TIMES_64(ROW_64(3), ROW_64(4), t), t2);
        high = PLUS_TIMES_64(PLUS_TIMES_64(ROW_64(5), ROW_64(6), t), ROW_64(7), t2);
        _mm512_mask_storeu_pd(out + i, some, PLUS_TIMES_64(low, high, _mm512_mul_pd(t2, t2)));
    }
}

__attribute__((target("avx512f")))
static void wide_pieces_32(const float *table, int first, size_t n, const float *q, const float *y, float *out)
{
    size_t i;
    for (i = 0; i < n; i += 16) {
        __mmask16 some = SOME(n, i);
        __m512i bits = _mm512_castps_si512(_mm512_maskz_loadu_ps(some, q + i));
        __m512i piece = _mm512_sub_epi32(_mm512_maskz_srli_epi32(some, bits, 22), _mm512_set1_epi32(first));
        __m512 t, t2, low, high;
        piece = _mm512_maskz_max_epi32(some, piece, _mm512_setzero_si512());
        piece = _mm512_maskz_min_epi32(some, piece, _mm512_set1_epi32(ASP_PIECES - 1));
        t = _mm512_sub_ps(_mm512_maskz_loadu_ps(some, y + i), ROW(0));
        t2 = _mm512_mul_ps(t, t);
        low = PLUS_TIMES(PLUS_TIMES(ROW(1), ROW(2), t), PLUS_TIMES(ROW(3), ROW(4), t), t2);
        high = PLUS_TIMES(PLUS_TIMES(ROW(5), ROW(6), t), ROW(7), t2);
        _mm512_mask_storeu_ps(out + i, some, PLUS_TIMES(low, high, _mm512_mul_ps(t2, t2)));
    }
}

__attribute__((target("avx512f")))
static void wide_knots_64(const double *knots, int last, size_t n, const double *x, int *out)
{
    size_t i;
    int step;
    for (i = 0; i < n; i += 8) {
        __mmask8 some = SOME_64(n, i);
        __m512d here = _mm512_maskz_loadu_pd(some, x + i);
        __m512i at = _mm512_setzero_si512();
        for (step = ASP_PIECES / 2; step; step /= 2) {
            __m512i to = _mm512_add_epi64(at, _mm512_set1_epi64(step));
            __mmask8 upper = _mm512_test_epi64_mask(to, _mm512_set1_epi64(16));
            __mmask8 take = _mm512_mask_cmp_pd_mask(_mm512_cmple_epi64_mask(to, _mm512_set1_epi64(last)), here,
                                                    FROM_64(knots, to, upper), _CMP_GE_OQ);
            at = _mm512_mask_mov_epi64(at, take, to);
        }
        _mm512_mask_cvtepi64_storeu_epi32(out + i, some, at);
    }
}

__attribute__((target("avx512f")))
static void wide_rows_64(const double *row, size_t n, const int *at, double *out)
{
    size_t i;
    for (i = 0; i < n; i += 8) {
        __mmask8 some = SOME_64(n, i);
        __m256i part = _mm512_maskz_extracti64x4_epi64(0xff, _mm512_maskz_loadu_epi32(some, at + i), 0);
        __m512i from = _mm512_maskz_cvtepi32_epi64(some, part);
        __mmask8 upper = _mm512_test_epi64_mask(from, _mm512_set1_epi64(16));
        _mm512_mask_storeu_pd(out + i, some, FROM_64(row, from, upper));
    }
}

__attribute__((target("avx512f")))
static void wide_knots_32(const float *knots, int last, size_t n, const float *x, int *out)
{
    size_t i;
    int step;
    for (i = 0; i < n; i += 16) {
        __mmask16 some = SOME(n, i);
        __m512 here = _mm512_maskz_loadu_ps(some, x + i);
        __m512i at = _mm512_setzero_si512();
        for (step = ASP_PIECES / 2; step; step /= 2) {
            __m512i to = _mm512_add_epi32(at, _mm512_set1_epi32(step));
            __mmask16 take = _mm512_mask_cmp_ps_mask(_mm512_cmple_epi32_mask(to, _mm512_set1_epi32(last)), here,
                                                     FROM(knots, to), _CMP_GE_OQ);
            at = _mm512_mask_mov_epi32(at, take, to);
        }
        _mm512_mask_storeu_epi32(out + i, some, at);
    }
}

__attribute__((target("avx512f")))
static void wide_rows_32(const float *row, size_t n, const int *at, float *out)
{
    size_t i;
    for (i = 0; i < n; i += 16) {
        __mmask16 some = SOME(n, i);
        __m512i from = _mm512_maskz_loadu_epi32(some, at + i);
        _mm512_mask_storeu_ps(out + i, some, FROM(row, from));
    }
}

__attribute__((target("avx512f")))
static size_t wide_places(size_t n, const int *some, int *out)
{
    __m512i at = _mm512_set_epi32(15, 14, 13, 12, 11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0);
    size_t i, count = 0;
    for (i = 0; i < n; i += 16) {
        __m512i here = _mm512_maskz_loadu_epi32(SOME(n, i), some + i);
        __mmask16 take = _mm512_test_epi32_mask(here, here);
        _mm512_storeu_si512(out + count, _mm512_maskz_compress_epi32(take, at));
        count += (size_t)__builtin_popcount(take);
        at = _mm512_add_epi32(at, _mm512_set1_epi32(16));
    }
    return count;
}
#undef FROM
#undef FROM_64
#undef ROW_64
#undef PLUS_TIMES_64
#undef SOME_64
#undef ROW
#undef SOME
#undef PLUS_TIMES
#endif
#endif

#if ASP_PRECISION == 32
size_t aspi_places_n(size_t n, const int *some, int *out)
{
    size_t i, count = 0;
#ifdef ASPI_PIECES_AVX512
    if (__builtin_cpu_supports("avx512f"))
        return wide_places(n, some, out);
#endif
    for (i = 0; i < n; i++) {
        out[count] = (int)i;
        count += some[i] != 0;
    }
    return count;
}
#endif

ASP_CLONES static void plain_pieces(const asp_real *table, int first, size_t n, const asp_real *ASP_RESTRICT q,
                                    const asp_real *ASP_RESTRICT y, asp_real *ASP_RESTRICT out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = aspi_pieces(table, first, q[i], y[i]);
}

void aspi_pieces_n(const asp_real *table, int first, size_t n, const asp_real *q, const asp_real *y, asp_real *out)
{
#ifdef ASPI_PIECES_AVX512
    if (__builtin_cpu_supports("avx512f")) {
        ASP_NAME(wide_pieces)(table, first, n, q, y, out);
        return;
    }
#endif
    plain_pieces(table, first, n, q, y, out);
}

ASP_CLONES static void plain_knots(const asp_real *knots, int last, size_t n, const asp_real *ASP_RESTRICT x,
                                   int *ASP_RESTRICT out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = aspi_knot(knots, last, x[i]);
}

void aspi_knots_n(const asp_real *knots, int last, size_t n, const asp_real *x, int *out)
{
#ifdef ASPI_PIECES_AVX512
    if (__builtin_cpu_supports("avx512f")) {
        ASP_NAME(wide_knots)(knots, last, n, x, out);
        return;
    }
#endif
    plain_knots(knots, last, n, x, out);
}

ASP_CLONES static void plain_rows(const asp_real *row, size_t n, const int *ASP_RESTRICT at,
                                  asp_real *ASP_RESTRICT out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = row[at[i]];
}

void aspi_rows_n(const asp_real *row, size_t n, const int *at, asp_real *out)
{
#ifdef ASPI_PIECES_AVX512
    if (__builtin_cpu_supports("avx512f")) {
        ASP_NAME(wide_rows)(row, n, at, out);
        return;
    }
#endif
    plain_rows(row, n, at, out);
}
#endif
