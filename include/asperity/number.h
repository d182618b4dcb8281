/* number.h - what a number is
 *
 * The kernels are one text, read once per precision. Before each reading define ASP_PRECISION as 64
 * or 32; this file then says what asp_real, R(1.5) and the kernels' names are. It has no include
 * guard: it is made to be read again.
 *
 * A kernel is straight-line scalar code: values in, values out, no libm but the square root (which
 * IEEE 754 rounds correctly), selections by ?: on values already computed. The compiler vectorises
 * the loops around it, and every compiler and instruction set gives the same bits, provided that it
 * is told neither to reassociate nor to contract (-ffp-contract=off). */

#ifndef ASP_NUMBER_ONCE
#define ASP_NUMBER_ONCE
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#if defined(__clang__) && defined(__CUDA__)
#define ASP_FN static __attribute__((host)) __attribute__((device)) inline
#elif defined(__CUDACC__)
#define ASP_FN static __host__ __device__ inline
#elif defined(__GNUC__)
#define ASP_FN static inline __attribute__((always_inline, unused))
#else
#define ASP_FN static inline
#endif

/* A loop over elements, compiled once per instruction set and chosen when the program is loaded. */
#if !defined(ASP_NO_CLONES) && defined(__x86_64__) && defined(__gnu_linux__) && defined(__ELF__) && \
    !defined(__CUDACC__) && !defined(__CUDA__) && \
    (defined(__clang__) ? __clang_major__ >= 14 : defined(__GNUC__) && __GNUC__ >= 6)
#define ASP_CLONES __attribute__((target_clones("default", "avx2", "avx512f")))
/* The same for a single call, which gains from three operands per instruction and loses by wide registers. */
#define ASP_CLONES_SINGLE __attribute__((target_clones("default", "avx2")))
#else
#define ASP_CLONES
#define ASP_CLONES_SINGLE
#endif

/* Not to be taken in by its callers. */
#ifdef __GNUC__
#define ASP_APART __attribute__((noinline))
#else
#define ASP_APART
#endif

#if defined(__GNUC__) || defined(__cplusplus)
#define ASP_RESTRICT __restrict
#else
#define ASP_RESTRICT restrict
#endif

/* Before a loop whose output may be one of its inputs: element i is read before it is written. */
#if defined(__clang__)
/* at low optimisation the request is refused, which is no fault */
#pragma clang diagnostic ignored "-Wpass-failed"
#define ASP_IN_PLACE _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define ASP_IN_PLACE _Pragma("GCC ivdep")
#else
#define ASP_IN_PLACE
#endif

#define ASP_PASTE_(a, b) a##b
#define ASP_PASTE(a, b) ASP_PASTE_(a, b)
/* A kernel's name in this precision. */
#define ASP_NAME(x) ASP_PASTE(x, ASP_SUFFIX)
/* A name that belongs to the distribution whose file defines ASP_NDF, as in
 * #define helper ASP_NDF_NAME(_helper). */
#define ASP_NDF_NAME(x) ASP_NAME(ASP_PASTE(ASP_NDF, x))

#define ndf_density ASP_NDF_NAME(_density)
#define ndf_sigma ASP_NDF_NAME(_sigma)
#define ndf_visible ASP_NDF_NAME(_visible)
#define ndf_normal ASP_NDF_NAME(_normal)
#define ndf_density_at ASP_NDF_NAME(_density_at)
#define ndf_sigma_at ASP_NDF_NAME(_sigma_at)
#define ndf_world_density ASP_NDF_NAME(_world_density)
#define ndf_world_visible ASP_NDF_NAME(_world_visible)
#define ndf_world_normal ASP_NDF_NAME(_world_normal)
#define ndf_density_over ASP_NDF_NAME(_density_over)
#define ndf_lobe ASP_NDF_NAME(_lobe)
#define ndf_aim ASP_NDF_NAME(_aim)
#define ndf_aim_up ASP_NDF_NAME(_aim_up)
#define ndf_aimed ASP_NDF_NAME(_aimed)
#define ndf_aim_below ASP_NDF_NAME(_aim_below)
#define ndf_mirror ASP_NDF_NAME(_mirror)
#define ndf_sigma_up ASP_NDF_NAME(_sigma_up)
#define ndf_sigma_up_at ASP_NDF_NAME(_sigma_up_at)
#define ndf_reflect_n ASP_NDF_NAME(_reflect_n)
#define ndf_density_1 ASP_NDF_NAME(_density_1)
#define ndf_sigma_1 ASP_NDF_NAME(_sigma_1)
#define ndf_visible_1 ASP_NDF_NAME(_visible_1)
#define ndf_normal_1 ASP_NDF_NAME(_normal_1)
#define ndf_reflect_1 ASP_NDF_NAME(_reflect_1)
#define ndf_refract_1 ASP_NDF_NAME(_refract_1)
#define ndf_refract_n ASP_NDF_NAME(_refract_n)
#define ndf_draw ASP_NDF_NAME(_draw)
#define ndf_draw_n ASP_NDF_NAME(_draw_n)
#define ndf_drawn ASP_NDF_NAME(_drawn)
#define ndf_facets ASP_NDF_NAME(_facets)
#define ndf_seen ASP_NDF_NAME(_seen)
#define ndf_halfway ASP_NDF_NAME(_halfway)
#define ndf_unit_density ASP_NDF_NAME(_unit_density)
#define ndf_along ASP_NDF_NAME(_along)
#define ndf_way_back ASP_NDF_NAME(_way_back)
#define ndf_meet_1 ASP_NDF_NAME(_meet_1)
#define ndf_turn_1 ASP_NDF_NAME(_turn_1)
#define ndf_meet_at ASP_NDF_NAME(_meet_at)
#define ndf_meet_n ASP_NDF_NAME(_meet_n)
#define ndf_turn_n ASP_NDF_NAME(_turn_n)
#define ndf_density_n ASP_NDF_NAME(_density_n)
#define ndf_sigma_n ASP_NDF_NAME(_sigma_n)
#define ndf_visible_n ASP_NDF_NAME(_visible_n)
#define ndf_normal_n ASP_NDF_NAME(_normal_n)

/* Batches go in blocks of this many elements at most, about twenty arrays in use at a time: 20 KB. */
#define ASP_BLOCK (ASP_PRECISION == 64 ? 128 : 256)

/* A public call's name in this precision. */
#define ASPI_CALL_64(x) x
#define ASPI_CALL_32(x) ASP_PASTE(x, f)
#define ASPI_CALL ASP_NAME(ASPI_CALL)

#define ASP_PI 3.14159265358979323846
#endif

#undef ASP_SUFFIX
#undef asp_real
#undef asp_bits
#undef R
#undef asp_v3
#undef asp_v2
#undef asp_c3
#undef asp_shape
#undef asp_mirrored
#undef asp_split_ray
#undef asp_split_rays
#undef asp_mirrored_s
#undef asp_met
#undef asp_mets
#if ASP_PRECISION == 64
#define ASP_SUFFIX _64
#define asp_real double
#define asp_bits uint64_t
#define asp_v3 asp_vec3
#define asp_v2 asp_vec2
#define asp_c3 asp_rgb
#define asp_shape asp_ndf
#define asp_mirrored asp_reflection
#define asp_split_ray asp_refraction
#define asp_split_rays asp_refractions
#define asp_mirrored_s asp_reflections
#define asp_met asp_meeting
#define asp_mets asp_meetings
#elif ASP_PRECISION == 32
#define ASP_SUFFIX _32
#define asp_real float
#define asp_bits uint32_t
#define asp_v3 asp_vec3f
#define asp_v2 asp_vec2f
#define asp_c3 asp_rgbf
#define asp_shape asp_ndff
#define asp_mirrored asp_reflectionf
#define asp_split_ray asp_refractionf
#define asp_split_rays asp_refractionsf
#define asp_mirrored_s asp_reflectionsf
#define asp_met asp_meetingf
#define asp_mets asp_meetingsf
#else
#error "define ASP_PRECISION as 64 or 32"
#endif
#define R(x) ((asp_real)(x))
