/* reference.c - the hand-written kernel: AVX-512, AVX2, and plain scalar C */
#include "reference.h"
#include <math.h>

#if defined(__x86_64__) && defined(__GNUC__)
#include <immintrin.h>
#define HAVE_LANES 1

/* ---- sixteen lanes */
#define FN(name) name##_512
#define LANES inline __attribute__((target("avx512f,avx512dq"), always_inline))
#define WIDTH 16
#define V __m512
#define SET(x) _mm512_set1_ps(x)
#define LOAD(p) _mm512_loadu_ps(p)
#define STORE(p, v) _mm512_storeu_ps(p, v)
#define ADD(a, b) _mm512_add_ps(a, b)
#define SUB(a, b) _mm512_sub_ps(a, b)
#define MUL(a, b) _mm512_mul_ps(a, b)
#define DIV(a, b) _mm512_div_ps(a, b)
#define FMA(a, b, c) _mm512_fmadd_ps(a, b, c)
#define SQRT(a) _mm512_sqrt_ps(a)
#define MAX(a, b) _mm512_max_ps(a, b)
#define MIN(a, b) _mm512_min_ps(a, b)
#define NEG(a) _mm512_xor_ps(a, _mm512_set1_ps(-0.0f))
#define KEEP_POSITIVE(t, v) \
    _mm512_maskz_mov_ps(_mm512_cmp_ps_mask(t, _mm512_setzero_ps(), _CMP_GT_OQ), v)
/* Quarter turns from the low bits of the shifted argument: swap on odd, then the signs. */
#define TURN(q, c0, s0, c, s) do { \
    __m512i b_ = _mm512_castps_si512(q), one_ = _mm512_set1_epi32(1); \
    __mmask16 odd_ = _mm512_test_epi32_mask(b_, one_); \
    __m512i sign_s_ = _mm512_slli_epi32(_mm512_and_si512(b_, _mm512_set1_epi32(2)), 30); \
    __m512i sign_c_ = _mm512_slli_epi32( \
        _mm512_and_si512(_mm512_add_epi32(b_, one_), _mm512_set1_epi32(2)), 30); \
    *(c) = _mm512_xor_ps(_mm512_mask_blend_ps(odd_, c0, s0), _mm512_castsi512_ps(sign_c_)); \
    *(s) = _mm512_xor_ps(_mm512_mask_blend_ps(odd_, s0, c0), _mm512_castsi512_ps(sign_s_)); \
} while (0)
#include "reference_lanes.h"

#undef FN
#undef LANES
#undef WIDTH
#undef V
#undef SET
#undef LOAD
#undef STORE
#undef ADD
#undef SUB
#undef MUL
#undef DIV
#undef FMA
#undef SQRT
#undef MAX
#undef MIN
#undef NEG
#undef KEEP_POSITIVE
#undef TURN

/* ---- eight lanes */
#define FN(name) name##_256
#define LANES inline __attribute__((target("avx2,fma"), always_inline))
#define WIDTH 8
#define V __m256
#define SET(x) _mm256_set1_ps(x)
#define LOAD(p) _mm256_loadu_ps(p)
#define STORE(p, v) _mm256_storeu_ps(p, v)
#define ADD(a, b) _mm256_add_ps(a, b)
#define SUB(a, b) _mm256_sub_ps(a, b)
#define MUL(a, b) _mm256_mul_ps(a, b)
#define DIV(a, b) _mm256_div_ps(a, b)
#define FMA(a, b, c) _mm256_fmadd_ps(a, b, c)
#define SQRT(a) _mm256_sqrt_ps(a)
#define MAX(a, b) _mm256_max_ps(a, b)
#define MIN(a, b) _mm256_min_ps(a, b)
#define NEG(a) _mm256_xor_ps(a, _mm256_set1_ps(-0.0f))
#define KEEP_POSITIVE(t, v) _mm256_and_ps(_mm256_cmp_ps(t, _mm256_setzero_ps(), _CMP_GT_OQ), v)
#define TURN(q, c0, s0, c, s) do { \
    __m256i b_ = _mm256_castps_si256(q), one_ = _mm256_set1_epi32(1), two_ = _mm256_set1_epi32(2); \
    __m256 odd_ = _mm256_castsi256_ps(_mm256_slli_epi32(b_, 31)); \
    __m256i sign_s_ = _mm256_slli_epi32(_mm256_and_si256(b_, two_), 30); \
    __m256i sign_c_ = _mm256_slli_epi32(_mm256_and_si256(_mm256_add_epi32(b_, one_), two_), 30); \
    *(c) = _mm256_xor_ps(_mm256_blendv_ps(c0, s0, odd_), _mm256_castsi256_ps(sign_c_)); \
    *(s) = _mm256_xor_ps(_mm256_blendv_ps(s0, c0, odd_), _mm256_castsi256_ps(sign_s_)); \
} while (0)
#include "reference_lanes.h"

__attribute__((target("avx512f,avx512dq")))
static void run_512(const reference_conductor *c, size_t n, const reference_arrays *a)
{
    batch_512(c, n, a);
}

__attribute__((target("avx2,fma")))
static void run_256(const reference_conductor *c, size_t n, const reference_arrays *a)
{
    batch_256(c, n, a);
}
#endif

reference_batch *reference_avx512(void)
{
#ifdef HAVE_LANES
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
        return run_512;
#endif
    return NULL;
}

reference_batch *reference_avx2(void)
{
#ifdef HAVE_LANES
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        return run_256;
#endif
    return NULL;
}

static float scalar_conductor(float c, float eta, float k)
{
    float c2 = c * c, s2 = 1.0f - c2, t0 = eta * eta - k * k - s2;
    float m = sqrtf(t0 * t0 + 4.0f * eta * eta * k * k);
    float h = 0.5f * (m + t0);
    float a = sqrtf(h > 0.0f ? h : 0.0f);
    float t1 = m + c2, t2 = 2.0f * a * c, t3 = c2 * m + s2 * s2, t4 = t2 * s2;
    return (t1 - t2) * t3 / ((t1 + t2) * (t3 + t4));
}

void reference_scalar(const reference_conductor *k, size_t n, const reference_arrays *a)
{
    float ax = k->alpha_x, ay = k->alpha_y;
    size_t i;
    for (i = 0; i < n; i++) {
        float wx = a->wi_x[i], wy = a->wi_y[i], wz = a->wi_z[i], u1 = a->u1[i];
        float vx = ax * wx, vy = ay * wy, h = sqrtf(vx * vx + vy * vy + wz * wz);
        float inv = 1.0f / h, up = 1.0f + wz * inv, d = u1 * up;
        float r = sqrtf(d * (d < 2.0f ? 2.0f - d : 0.0f));
        float phi = 6.28318531f * a->u2[i];
        float mx = r * cosf(phi) + vx * inv, my = r * sinf(phi) + vy * inv, mz = up - d;
        float m2 = mx * mx + my * my + mz * mz;
        float dot, k2, ox, oy, oz, si, so, g, c;
        mx *= ax;
        my *= ay;
        k2 = 1.0f / (mx * mx + my * my + mz * mz);
        dot = mx * wx + my * wy + mz * wz;
        d = 2.0f * dot * k2;
        ox = d * mx - wx;
        oy = d * my - wy;
        oz = d * mz - wz;
        c = dot * sqrtf(k2);
        c = c < 1.0f ? c : 1.0f;
        si = 0.5f * (h + wz);
        so = 0.5f * (sqrtf(ax * ax * ox * ox + ay * ay * oy * oy + oz * oz) + oz);
        g = oz > 0.0f ? si * oz / (si * oz + wz * (so - oz)) : 0.0f;
        m2 *= k2;
        a->wo_x[i] = ox;
        a->wo_y[i] = oy;
        a->wo_z[i] = oz;
        a->pdf[i] = 1.0f / (12.5663706f * ax * ay * si * m2 * m2);
        a->r[i] = g * scalar_conductor(c, k->eta[0], k->k[0]);
        a->g[i] = g * scalar_conductor(c, k->eta[1], k->k[1]);
        a->b[i] = g * scalar_conductor(c, k->eta[2], k->k[2]);
    }
}
