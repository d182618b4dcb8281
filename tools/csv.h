/* csv.h - tables of text, read row by row in constant memory
 *
 * The first line that is neither empty nor a '#' comment is the header. Cells are separated by a
 * comma, a semicolon or a tab, whichever the header has; blanks around a cell do not count, and a
 * cell in double quotes may contain the separator. Numbers have a '.', whatever the locale. */
#ifndef CSV_H
#define CSV_H

#include "cmd.h"

typedef struct csv {
    const char *name;         /* for errors */
    FILE *file;
    char *line;               /* the line just read, without its end */
    size_t length, room;
    long long number;         /* its number, from 1 */
    char separator;
    size_t columns;
    char **column;            /* their names */
} csv;

typedef enum csv_row { CSV_END = 0, CSV_CELLS, CSV_ASIDE, CSV_BROKEN } csv_row;

/* `path` NULL or "-": standard input. Reads up to the header; lines before it go to `aside`.
 * CMD_OK, or the error printed and CMD_FAILED. */
int  csv_open(csv *table, const char *path, cmd_out *aside);
/* The next line: CSV_CELLS with the header's number of cells, CSV_ASIDE (empty or a comment),
 * CSV_END, or CSV_BROKEN with the error printed. */
csv_row csv_next(csv *table);
/* How much of the file is read, in [0, 1]; -1 where its size is not known (a pipe). */
double csv_done(const csv *table);
/* Index of a column, -1 if none. */
int  csv_find(const csv *table, const char *name);
/* The numbers in the cells `wanted[0..count)` of the line. 0, or 1 and the error
 * printed. */
int  csv_numbers(const csv *table, const int *wanted, size_t count, double *out);
/* The cell of a column as text, cut to what fits. */
void csv_text(const csv *table, int column, char *out, size_t size);
void csv_close(csv *table);

#endif
