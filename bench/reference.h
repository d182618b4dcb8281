/* reference.h - what careful hand-written code reaches on this machine: the ratios' denominator
 *
 * One task: GGX, anisotropic, not rotated, not skewed; conductor, exact Fresnel term, three channels;
 * height-correlated masking; visible normals. Given wi and (u1, u2): wo, pdf and weight. float32.
 * Divisions and square roots are exact (IEEE), products may be fused. */
#ifndef ASP_BENCH_REFERENCE_H
#define ASP_BENCH_REFERENCE_H

#include <stddef.h>

typedef struct reference_conductor {
    float alpha_x, alpha_y;
    float eta[3], k[3];
} reference_conductor;

/* Five arrays in, seven out. */
typedef struct reference_arrays {
    const float *wi_x, *wi_y, *wi_z, *u1, *u2;
    float *wo_x, *wo_y, *wo_z, *pdf, *r, *g, *b;
} reference_arrays;

typedef void reference_batch(const reference_conductor *c, size_t n, const reference_arrays *a);

/* The intrinsics, n a multiple of 16; NULL where the processor or the compiler has none. */
reference_batch *reference_avx512(void);
reference_batch *reference_avx2(void);

/* The same in plain scalar C, any n. */
void reference_scalar(const reference_conductor *c, size_t n, const reference_arrays *a);

#endif
