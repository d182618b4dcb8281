/* pieces.h - tables of 32: polynomials of degree 6 by pieces, two to an octave; knots and rows
 *
 * A function with structure on several scales is cut into ASP_PIECES pieces: two to each octave of some
 * q >= 0, the first from q = 0 and the last without end. Which piece, q says; the polynomial's argument is
 * y less the piece's center, where y is any function of q that keeps its digits. A table holds the centers
 * and then the seven coefficients, ASP_PIECES of each. Read once per precision. */

#include "asperity/elementary.h"

#ifndef ASP_PIECES
#define ASP_PIECES 32
#define ASP_PIECES_TERMS 7
#define ASP_PIECES_NUMBERS (ASP_PIECES * (1 + ASP_PIECES_TERMS))
/* `first` of a table whose first piece ends at 1.5 2^octave. */
#define ASP_PIECES_FROM(octave) (2 * ((ASP_PRECISION == 64 ? 1023 : 127) + (octave)))
#define aspi_piece ASP_NAME(aspi_piece)
#define aspi_pieces ASP_NAME(aspi_pieces)
#define aspi_pieces_n ASP_NAME(aspi_pieces_n)

#define aspi_knot ASP_NAME(aspi_knot)
#define aspi_knots_n ASP_NAME(aspi_knots_n)
#define aspi_rows_n ASP_NAME(aspi_rows_n)

/* Loops; inputs and outputs do not overlap. Of a row 32 numbers are read, whatever stands there. */
void aspi_knots_n_64(const double *knots, int last, size_t n, const double *x, int *out);
void aspi_knots_n_32(const float *knots, int last, size_t n, const float *x, int *out);
/* out[i] = row[at[i]] */
void aspi_rows_n_64(const double *row, size_t n, const int *at, double *out);
void aspi_rows_n_32(const float *row, size_t n, const int *at, float *out);
/* aspi_pieces */
void aspi_pieces_n_64(const double *table, int first, size_t n, const double *q, const double *y, double *out);
void aspi_pieces_n_32(const float *table, int first, size_t n, const float *q, const float *y, float *out);
/* Every i with some[i] other than 0, in order; how many. There is room for ASP_PLACES_MORE numbers more than that. */
#define ASP_PLACES_MORE 16
size_t aspi_places_n(size_t n, const int *some, int *out);
#endif

#if (ASP_PRECISION == 64 && !defined(ASP_PIECES_64)) || \
    (ASP_PRECISION == 32 && !defined(ASP_PIECES_32))
#if ASP_PRECISION == 64
#define ASP_PIECES_64
#else
#define ASP_PIECES_32
#endif

/* The piece of q: its exponent and the first bit of its fraction; a NaN counts as infinity. */
ASP_FN int aspi_piece(int first, asp_real q)
{
    int i = (int)(aspi_to_bits(q) >> (ASP_PRECISION == 64 ? 51 : 22)) - first;
    i = i < 0 ? 0 : i;
    return i > ASP_PIECES - 1 ? ASP_PIECES - 1 : i;
}

/* Short chains: pairs first (Estrin). By index, not by a pointer to the piece: loops around it are vectorised. */
ASP_FN asp_real aspi_pieces(const asp_real *table, int first, asp_real q, asp_real y)
{
    int i = aspi_piece(first, q);
    asp_real t = y - table[i], t2 = t * t;
#define C(n) table[i + (1 + n) * ASP_PIECES]
    asp_real low = (C(0) + C(1) * t) + (C(2) + C(3) * t) * t2;
    asp_real high = (C(4) + C(5) * t) + C(6) * t2;
#undef C
    return low + high * (t2 * t2);
}

/* The last of knots 0 ... last, growing, last < 32, that is not above x; 0 if there is none. */
ASP_FN int aspi_knot(const asp_real *knots, int last, asp_real x)
{
    int i = 0, step, to;
    for (step = ASP_PIECES / 2; step; step /= 2) {
        to = i + step;
        i = ((x >= knots[to]) & (to <= last)) ? to : i;
    }
    return i;
}
#endif
