/* rng.h - random numbers by place: number k of a stream is a function of (seed, stream, k)
 *
 * SplitMix64 (Steele, Lea, Flood 2014): number k of a generator is a mix of its start plus k + 1
 * steps of 2^64 divided by the golden ratio, so that any place of the stream is reached at once and
 * work may be split among threads without changing a number. Used by callers of the kernels, which
 * take their uniform numbers as arguments. */
#ifndef ASPI_CORE_RNG_H
#define ASPI_CORE_RNG_H

#include <stdint.h>

static inline uint64_t aspi_mix64(uint64_t z)
{
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

/* Number k of the generator that starts at `start`. */
static inline uint64_t aspi_random_at(uint64_t start, uint64_t k)
{
    return aspi_mix64(start + (k + 1) * 0x9E3779B97F4A7C15u);
}

/* The start of a stream: two seeds or two streams that differ in one bit are unrelated. */
static inline uint64_t aspi_random_start(uint64_t seed, uint64_t stream)
{
    return aspi_random_at(seed, 0) ^ aspi_random_at(stream ^ 0xD1B54A32D192ED03u, 0);
}

/* 53 or 24 random bits as a number in [0, 1). */
static inline double aspi_unit64(uint64_t bits) { return (double)(bits >> 11) * 0x1p-53; }
static inline float  aspi_unit32(uint64_t bits) { return (float)(bits >> 40) * 0x1p-24f; }
#define aspi_unit_64 aspi_unit64
#define aspi_unit_32 aspi_unit32

#endif
