/* cuda_kernels.cu - the kernels' text as CUDA, compiled by tests/test_cuda.sh without a toolkit
 *
 * A toolkit's headers would give the keywords and the device's square root, signs and memcpy; here are
 * the few lines that are needed. cuda_kernels.list holds a row KERNEL(name) per standard surface. */
#include <math.h>
#include <string.h>

#define __host__ __attribute__((host))
#define __device__ __attribute__((device))
#define __global__ __attribute__((global))

static __device__ inline float sqrtf(float x) { return __nvvm_sqrt_rn_f(x); }
static __device__ inline double sqrt(double x) { return __nvvm_sqrt_rn_d(x); }
static __device__ inline float fabsf(float x) { return __builtin_fabsf(x); }
static __device__ inline double fabs(double x) { return __builtin_fabs(x); }
static __device__ inline float copysignf(float x, float y) { return __builtin_copysignf(x, y); }
static __device__ inline void *memcpy(void *to, const void *from, size_t n)
{
    return __builtin_memcpy(to, from, n);
}

#include "asperity_core.c"

#define KERNEL_IN(name, suffix, ndf, real, vec3) \
    __global__ void name##_kernel##suffix(const ndf *k, vec3 v, real u1, real u2, real *out) \
    { \
        real s2 = v.x * v.x + v.y * v.y; \
        vec3 m = name##_visible##suffix(k, v, u1, u2), n = name##_normal##suffix(k, u1, u2); \
        out[0] = m.x; \
        out[1] = m.y; \
        out[2] = m.z; \
        out[3] = n.x; \
        out[4] = n.y; \
        out[5] = n.z; \
        out[6] = name##_sigma##suffix(k, v.z, s2); \
        out[7] = name##_density##suffix(k, s2, v.z * v.z); \
    }
#define KERNEL(name) \
    KERNEL_IN(name, _64, asp_ndf, double, asp_vec3) \
    KERNEL_IN(name, _32, asp_ndff, float, asp_vec3f)
#include "cuda_kernels.list"
