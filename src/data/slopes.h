/* slopes.h - measured slopes on their way to a distribution */
#ifndef ASPI_SLOPES_H
#define ASPI_SLOPES_H

#include "text.h"

/* What a text file of slopes holds: a density over a grid of slopes, or weighted slopes one by one. */
typedef struct aspi_slopes {
    int     grid;              /* 1: value is the density in the cell around (x, y) */
    size_t  count;
    double *x, *y, *value;     /* one block of memory, x owns it */
    long long *line;
} aspi_slopes;

#define ASPI_SLOPES_MOST 4194304

/* Rows of text with a header: p_x, p_y (or slope_x, slope_y) and density (P22) for a grid, or weight
 * (count), or neither for slopes that all weigh the same. # starts a comment. */
asp_status aspi_slopes_read(const aspi_bytes *file, aspi_slopes *out, asp_error *err);
void aspi_slopes_free(aspi_slopes *slopes);

/* How slopes are to be counted. */
typedef struct aspi_counting {
    size_t nx, ny;
    int ranged;                /* 1: the range is given; else it is taken from the slopes */
    asp_slope_range range;
} aspi_counting;

/* Slopes one by one: calls visit for each, in the same order every time. */
typedef void aspi_slope_visitor(void *context, double x, double y, double weight);
typedef void aspi_slope_source(const void *source, aspi_slope_visitor *visit, void *context);

/* Counts twice over: first where they lie, then into cells. *memory: one block, of free(). */
asp_status aspi_slopes_count(aspi_slope_source *each, const void *source, const aspi_counting *how,
                             const asp_map *map, void **memory, asp_ndf *out, asp_error *err);
/* A histogram of what a file holds. A grid has its own cells; `how` may be for them or 0 x 0. */
asp_status aspi_slopes_histogram(const aspi_slopes *slopes, const char *name, const aspi_counting *how,
                                 const asp_map *map, void **memory, asp_ndf *out, asp_error *err);

#endif
