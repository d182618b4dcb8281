/* sobol.h - two-dimensional Sobol points with hashed Owen scrambling
 *
 * Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020: points of a (0, 2)-sequence, their
 * order and their digits permuted by nested permutations that a hash makes from a seed. Each pair of
 * dimensions of a pixel gets a seed of its own; 2^k samples are stratified in every one of them. */
#ifndef ASPI_RENDER_SOBOL_H
#define ASPI_RENDER_SOBOL_H

#include <stdint.h>

static inline uint32_t aspi_reverse(uint32_t x)
{
    x = (x >> 16) | (x << 16);
    x = (x >> 8 & 0x00ff00ffu) | (x & 0x00ff00ffu) << 8;
    x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
    x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
    return (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
}

/* Mixes two words: the finaliser of MurmurHash3 (Appleby) over a sum that tells (a, b) from (b, a). */
static inline uint32_t aspi_mix(uint32_t a, uint32_t b)
{
    uint32_t h = a * 0x9e3779b1u + (b ^ 0x85ebca6bu) * 0xc2b2ae35u;
    h = (h ^ h >> 16) * 0x85ebca6bu;
    h = (h ^ h >> 13) * 0xc2b2ae35u;
    return h ^ h >> 16;
}

/* Laine and Karras's permutation: on reversed digits a nested uniform scramble (Burley, section 3). */
static inline uint32_t aspi_permute(uint32_t x, uint32_t seed)
{
    x += seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    return x ^ x * 0x8d22f6e6u;
}

static inline uint32_t aspi_scramble(uint32_t x, uint32_t seed)
{
    return aspi_reverse(aspi_permute(aspi_reverse(x), seed));
}

/* Second dimension of the Sobol sequence from the reversed index. Its matrix is Pascal's triangle
 * modulo 2, P(2n) = [P(n) P(n); 0 P(n)], applied halving by halving. */
static inline uint32_t aspi_pascal(uint32_t x)
{
    x ^= x << 16;
    x ^= (x & 0x00ff00ffu) << 8;
    x ^= (x & 0x0f0f0f0fu) << 4;
    x ^= (x & 0x33333333u) << 2;
    return x ^ (x & 0x55555555u) << 1;
}

/* Point `index` of the set `seed`, in [0, 1)^2. */
static inline void aspi_sobol(uint32_t index, uint32_t seed, double *u1, double *u2)
{
    uint32_t reversed = aspi_permute(aspi_reverse(index), seed);
    *u1 = 0x1p-32 * aspi_scramble(reversed, aspi_mix(seed, 1));
    *u2 = 0x1p-32 * aspi_scramble(aspi_pascal(reversed), aspi_mix(seed, 2));
}

#endif
