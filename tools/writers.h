/* writers.h - the formats in which a measurement is written */
#ifndef WRITERS_H
#define WRITERS_H

#include "cmd.h"

typedef struct writer {
    const char *name;
    const char *endings[3];
    asp_status (*write)(const asp_measured *, const char *, asp_error *);
} writer;

#define WRITER_NAMES "merl|csv"              /* in the order of the table, for an option --to */

/* By the option `to` where it is given, else by the ending of `path`, after a look whether the file
 * can be written. CMD_OK, or the error printed. */
int writer_choose(const cmd_args *args, const char *path, const writer **out);
/* Writes the whole file. CMD_OK, or the error printed and CMD_FAILED. */
int writer_write(const writer *to, const asp_measured *data, const char *path);

#endif
