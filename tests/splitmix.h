/* splitmix.h - uniform random numbers of the tests, as walks ask for them: splitmix64 (Steele, Lea, Flood 2014) */
#ifndef SPLITMIX_H
#define SPLITMIX_H

#include <stdint.h>

/* [0, 1), 53 bits; `state` is a uint64_t. */
static inline double next(void *state)
{
    uint64_t *s = state, z = (*s += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

#endif
