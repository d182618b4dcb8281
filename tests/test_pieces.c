/* test_pieces.c - tables of 32: loops over arrays against single look-ups, bit by bit
 *
 * Every length up to three registers and a bit, arguments at and beyond all ends. The knots also against a search
 * one by one, and a polynomial of degree 6 against itself. */
#include "random.h"
#include "asperity.h"

#define ASP_PRECISION 64
#include "ndf/pieces.h"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "ndf/pieces.h"
#undef ASP_PRECISION

#include <stdio.h>

enum { LONGEST = 53 };

static int passed, failed;

static void report(const char *what, int differ)
{
    printf("%-4s %-56s %d differ\n", differ ? "FAIL" : "ok", what, differ);
    passed += !differ;
    failed += differ != 0;
}

static double argument(int i)
{
    static const double ends[] = { 0, 1e-30, INFINITY, NAN, 0x1p-8, 1.5 * 0x1p-8, 0x1p8, 0x1.7ffffep7, 1, 1e30 };
    return i % 3 == 0 ? ends[(size_t)(i / 3) % (sizeof ends / sizeof *ends)] : exp(24 * uniform() - 12);
}

#define SAME(a, b) (!memcmp(&(a), &(b), sizeof(a)) || ((a) != (a) && (b) != (b)))

#define CHECK(real, bits) \
static void check_##bits(void) \
{ \
    static real table[ASP_PIECES_NUMBERS], q[LONGEST], y[LONGEST], out[LONGEST + 1]; \
    static int at[LONGEST + 1]; \
    const int first = 2 * ((bits == 64 ? 1023 : 127) - 8); \
    int i, n, last, pieces = 0, knots = 0, rows = 0, search = 0, over = 0; \
    for (i = 0; i < ASP_PIECES_NUMBERS; i++) \
        table[i] = (real)(uniform() - 0.5); \
    for (n = 0; n <= LONGEST; n++) { \
        for (i = 0; i < n; i++) { \
            q[i] = (real)argument(i + n); \
            y[i] = (real)uniform(); \
        } \
        out[n] = 7; \
        at[n] = 7; \
        aspi_pieces_n_##bits(table, first, (size_t)n, q, y, out); \
        for (i = 0; i < n; i++) { \
            real one = aspi_pieces_##bits(table, first, q[i], y[i]); \
            pieces += !SAME(one, out[i]); \
        } \
        for (i = 0; i < n; i++) \
            at[i] = (int)(32 * uniform()); \
        aspi_rows_n_##bits(table + n, (size_t)n, at, out); \
        for (i = 0; i < n; i++) \
            rows += !SAME(table[n + at[i]], out[i]); \
        over += out[n] != 7 || at[n] != 7; \
    } \
    table[0] = -20; \
    for (i = 1; i < 32; i++) \
        table[i] = table[i - 1] + (real)(2 * uniform()); \
    for (last = 0; last < 32; last++) { \
        for (i = 0; i < LONGEST; i++) \
            q[i] = i % 4 ? (real)(70 * uniform() - 25) : i % 8 ? table[i % 32] : (real)argument(i); \
        aspi_knots_n_##bits(table, last, LONGEST, q, at); \
        for (i = 0; i < LONGEST; i++) { \
            int j = 0; \
            while (j < last && q[i] >= table[j + 1]) \
                j++; \
            knots += aspi_knot_##bits(table, last, q[i]) != at[i]; \
            search += j != at[i]; \
        } \
    } \
    report("float" #bits ": polynomials by pieces", pieces); \
    report("float" #bits ": rows", rows); \
    report("float" #bits ": knots", knots); \
    report("float" #bits ": knots, one by one", search); \
    report("float" #bits ": written beyond the end", over); \
}

CHECK(double, 64)
CHECK(float, 32)

/* Two pieces to an octave; the polynomial that stands in one comes out. */
static void check_polynomial(void)
{
    static double table[ASP_PIECES_NUMBERS];
    int i, k, differ = 0;
    for (i = 0; i < ASP_PIECES; i++) {
        table[i] = 0.25 * i;
        for (k = 0; k < ASP_PIECES_TERMS; k++)
            table[(1 + k) * ASP_PIECES + i] = 1 + k + i;
    }
    for (i = 0; i < ASP_PIECES; i++) {
        double q = ldexp(i % 2 ? 1.6 : 1.2, i / 2 - 8), y = 0.25 * i + 0.5, sum = 0;
        for (k = ASP_PIECES_TERMS - 1; k >= 0; k--)
            sum = sum * 0.5 + (1 + k + i);
        differ += fabs(aspi_pieces_64(table, 2 * (1023 - 8), q, y) - sum) > 1e-13 * sum;
    }
    report("a piece's polynomial", differ);
}

/* Places, in order, of blocks of all lengths, from none to all. */
static void check_places(void)
{
    int some[LONGEST], out[LONGEST + ASP_PLACES_MORE], n, i, differ = 0;
    for (n = 0; n <= LONGEST; n++) {
        size_t found, count = 0;
        for (i = 0; i < n; i++)
            some[i] = n % 5 == 0 ? n % 2 : uniform() < 0.2 * (n % 5) ? 1 + i : 0;
        found = aspi_places_n((size_t)n, some, out);
        for (i = 0; i < n; i++)
            if (some[i]) {
                differ += count >= found || out[count] != i;
                count++;
            }
        differ += count != found;
    }
    report("places", differ);
}

int main(void)
{
    check_places();
    check_64();
    check_32();
    check_polynomial();
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
