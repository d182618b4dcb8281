/* io.h - whole files, finished files, numbers as text: what every reader and writer shares */
#ifndef ASPI_IO_H
#define ASPI_IO_H

#include "asperity_data.h"

#include <stdio.h>

/* ---- numbers, always with a '.', whatever the locale says */

#define ASPI_NUMBER_TEXT 64

/* The whole of text[0..n) as a decimal number, [+-]digits[.digits][e[+-]digits], correctly
 * rounded. 0 where it is anything else (nan, inf and hexadecimal included) or overflows. */
int aspi_parse_number(const char *text, size_t n, double *out);
int aspi_parse_long_double(const char *text, size_t n, long double *out);

/* The shortest %g form of `digits` significant digits (17 read back exactly). Returns the length. */
size_t aspi_format_number(double value, int digits, char text[ASPI_NUMBER_TEXT]);
size_t aspi_format_long_double(long double value, int digits, char text[ASPI_NUMBER_TEXT]);

/* ---- errors with a file */

/* Adds the file's name (shortened from the left to fit). */
void aspi_error_file(asp_error *err, const char *file);
/* asp_fail with a file and a byte position (-1: none). Returns status. */
asp_status aspi_fail_at(asp_error *err, asp_status status, const char *file, long long position,
                        const char *name, const char *reason);
/* asp_fail with a file and a line. Returns status. */
asp_status aspi_fail_line(asp_error *err, asp_status status, const char *file, long long line,
                          const char *name, const char *reason);

/* ---- files */

/* A whole regular file (or pipe) into memory, free() it. A zero byte follows the last one. */
asp_status aspi_read_file(const char *path, unsigned char **bytes, size_t *size, asp_error *err);

/* A file being written: to a temporary name in the same folder, renamed by aspi_out_close when all
 * of it is on disk. Devices and pipes are written in place. Writes after a failure do nothing, so
 * that only the end needs a check. */
typedef struct aspi_out {
    FILE *file;
    int   failed;              /* the errno of the first failure */
    int   in_place;
    char  path[1024], temporary[1088];
} aspi_out;

asp_status aspi_out_open(aspi_out *out, const char *path, asp_error *err);
void       aspi_out_write(aspi_out *out, const void *bytes, size_t size);
void       aspi_out_text(aspi_out *out, const char *text);
/* Finishes and renames. On failure removes the temporary file and says why. */
asp_status aspi_out_close(aspi_out *out, asp_error *err);
/* Gives up: removes the temporary file, leaves `path` as it was. */
void       aspi_out_abandon(aspi_out *out);

#endif
