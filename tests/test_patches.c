/* test_patches.c - tables of 32 polynomials: loops over arrays against single look-ups, bit by bit
 *
 * Every length up to a few registers and a bit, tables as they are and made ready, shares at and beyond all ends, NaN. Single
 * look-ups also against the polynomials added up term by term. */
#include "asperity.h"

#define ASP_PRECISION 64
#include "ndf/patches.h"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "ndf/patches.h"
#undef ASP_PRECISION

#include <stdio.h>

enum { LONGEST = 53, OCTAVES = 2, NUMBERS = OCTAVES * ASP_OCTAVES_NUMBERS + ASP_PATCHES_NUMBERS };

static int passed, failed;
static uint64_t state = 88172645463325252u;

static double uniform(void)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (double)(state >> 11) * 0x1p-53;
}

static void report(const char *what, double worst, double bound)
{
    int ok = worst <= bound;
    printf("%-4s %-56s %.3g, bound %g\n", ok ? "ok" : "FAIL", what, worst, bound);
    passed += ok;
    failed += !ok;
}

static double share(int i)
{
    static const double ends[] = { 0, 1, 0.5, 1e-30, NAN, 0.25, 0x1p-33, 0x1p-24, 1 - 0x1p-24, 0.75, 0x1.fffffep-2 };
    return i % 3 == 0 ? ends[(size_t)(i / 3) % (sizeof ends / sizeof *ends)] : i & 1 ? uniform() : exp(-26 * uniform());
}

/* Bits differ; any NaN equals any other. */
#define DIFFER(a, b) ((a) == (a) || (b) == (b) ? memcmp(&(a), &(b), sizeof(a)) != 0 : 0)

#define CHECK(REAL, S, EPSILON) \
static void check##S(void) \
{ \
    static REAL table[NUMBERS], space[NUMBERS + 64 / sizeof(REAL)]; \
    REAL u[LONGEST], x[LONGEST], y[LONGEST], o[OCTAVES][LONGEST], p[LONGEST]; \
    const REAL *patches = table + OCTAVES * ASP_OCTAVES_NUMBERS, *ready; \
    int at[LONGEST], n, i, j, l, round, differ = 0; \
    double worst = 0; \
    for (i = 0; i < NUMBERS; i++) \
        table[i] = (REAL)(uniform() - 0.5); \
    for (round = 0; round < 2; round++) { \
        ready = round ? aspi_patches_ready##S(table, OCTAVES, NUMBERS, space) : NULL; \
        for (n = 1; n <= LONGEST; n++) { \
            for (i = 0; i < n; i++) { \
                u[i] = (REAL)share(i + n); \
                x[i] = (REAL)(2 * uniform() - 1); \
                y[i] = (REAL)(2 * uniform() - 1); \
                at[i] = (int)(32 * uniform()); \
            } \
            for (l = 0; l < OCTAVES; l++) \
                aspi_octaves_n##S(table + l * ASP_OCTAVES_NUMBERS, ready ? ready + l * ASP_OCTAVES_NUMBERS : NULL, \
                                  (size_t)n, u, o[l]); \
            aspi_patches_n##S(patches, ready ? ready + OCTAVES * ASP_OCTAVES_NUMBERS : NULL, (size_t)n, at, x, y, p); \
            for (i = 0; i < n; i++) { \
                REAL one; \
                double sum = 0, v, t, power; \
                for (l = 0; l < OCTAVES; l++) { \
                    one = aspi_octaves##S(table + l * ASP_OCTAVES_NUMBERS, u[i]); \
                    differ += DIFFER(one, o[l][i]); \
                    v = (double)aspi_share##S(u[i]); \
                    j = 0; \
                    while (v < 0.25 && j < 31) { \
                        v *= 2; \
                        j++; \
                    } \
                    t = 4 * v - 1.5; \
                    sum = 0; \
                    for (int k = 7; k >= 0; k--) \
                        sum = sum * t + (double)table[l * ASP_OCTAVES_NUMBERS + k * 32 + j]; \
                    if (u[i] == u[i]) \
                        worst = fmax(worst, fabs(sum - (double)one)); \
                    else \
                        worst += one == one; \
                } \
                one = aspi_patch##S(patches, at[i], x[i], y[i]); \
                differ += DIFFER(one, p[i]); \
                sum = 0; \
                for (l = 0, power = 1; l < ASP_PATCH_ROWS; l++, power *= (double)y[i]) { \
                    double row = 0; \
                    for (j = 7; j >= 0; j--) \
                        row = row * (double)x[i] + (double)patches[(l * 8 + j) * 32 + at[i]]; \
                    sum += row * power; \
                } \
                worst = fmax(worst, fabs(sum - (double)one)); \
            } \
        } \
    } \
    report("loops against single look-ups, " #REAL, differ, 0); \
    report("polynomials against their terms, " #REAL, worst, EPSILON); \
}

CHECK(double, _64, 2e-15)
CHECK(float, _32, 2e-6)

int main(void)
{
    check_64();
    check_32();
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
