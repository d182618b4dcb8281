/* random.h - uniform random numbers of the tests: xorshift (Marsaglia 2003), the same in every run */
#ifndef RANDOM_H
#define RANDOM_H

#include <stdint.h>

static uint64_t state = 88172645463325252u;

/* [0, 1), 53 bits. */
static double uniform(void)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11) * 0x1p-53;
}

#endif
