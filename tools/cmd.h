/* cmd.h - the frame that every subcommand stands in
 *
 * A subcommand is one file, tools/cmd_<name>.c, that ends in its record, and one row in
 * tools/commands.c:
 *
 *     #include "cmd.h"
 *     static int run(const cmd_args *args)
 *     {
 *         asp_ndf ndf;
 *         int status = cmd_ndf(args, "ndf", 0, &ndf);
 *         if (status)
 *             return status;
 *         for (long long i = 0; i < cmd_integer(args, "count"); i++)
 *             ...
 *         return CMD_OK;
 *     }
 *     static const cmd_option options[] = {
 *         { "ndf",   0,   "SPEC", CMD_TEXT,    .required = 1, .help = "the distribution" },
 *         { "count", 'n', "N",    CMD_INTEGER, 1, 1e9, .initial = "10", .help = "how many" },
 *         { "json",  0,   NULL,   CMD_FLAG,    .help = "write JSON" },
 *         CMD_END
 *     };
 *     const cmd_record cmd_count = { "count", "one line", "[FILE]", 0, 1, "More words.",
 *                                    options, run };
 *
 * The table of options is read by the parser, by `asperity help`, by --help and by the page
 * docs/commands.md, so that they cannot disagree. Ranges and choices are checked before `run`. */
#ifndef CMD_H
#define CMD_H

#include "asperity.h"
#include "asperity_data.h"
#include "asperity_draw.h"
#include "data/io.h"

#include <jansson.h>
#include <stdio.h>

/* What `run` returns, and the exit status of the program. */
enum { CMD_OK = 0, CMD_FAILED = 1, CMD_USAGE = 2 };

/* ------------------------------------------------------------------ the record */

typedef enum cmd_kind {
    CMD_FLAG,       /* takes no value */
    CMD_TEXT,
    CMD_NUMBER,     /* in [low, high]; both 0: any finite number; high INFINITY: also `inf` */
    CMD_INTEGER,    /* in [low, high] */
    CMD_CHOICE      /* one of the words in `argument`, which stand between bars: "f64|f32" */
} cmd_kind;

typedef struct cmd_option {
    const char *name;         /* the long name, without --; NULL ends the table */
    char        letter;       /* the short one, or 0 */
    const char *argument;     /* what the value is called in the help: "SPEC", "f64|f32" */
    cmd_kind    kind;
    double      low, high;
    int         low_open;     /* 1: low itself is refused */
    const char *initial;      /* the default as the user would write it, or NULL */
    int         required;     /* 1: must be given */
    int         many;         /* 1: may be given more than once; else giving it twice is refused */
    const char *help;         /* a line, without the range and the default: those are added */
} cmd_option;

#define CMD_END { .name = NULL }

typedef struct cmd_args cmd_args;

typedef struct cmd_record {
    const char *name;
    const char *summary;          /* one line, no full stop */
    const char *operands;         /* "QUANTITY [FILE]", "" for none */
    int least, most;              /* how many operands; most -1: any number */
    const char *details;          /* paragraphs and examples for the help, lines of 78 at most */
    const cmd_option *options;
    int (*run)(const cmd_args *args);
} cmd_record;

/* All subcommands in the order of the help; ends with NULL. */
extern const cmd_record *const cmd_commands[];

/* ------------------------------------------------------------------ what the user gave
 *
 * `option` is a long name of the record's table (anything else is a mistake in the program and
 * aborts). */

const cmd_record *cmd_args_record(const cmd_args *args);
size_t      cmd_given(const cmd_args *args, const char *option);        /* how often */
const char *cmd_text(const cmd_args *args, const char *option);         /* the last, the default, or NULL */
const char *cmd_text_at(const cmd_args *args, const char *option, size_t index);
double      cmd_number(const cmd_args *args, const char *option);       /* NAN where neither */
long long   cmd_integer(const cmd_args *args, const char *option);      /* 0 where neither */
int         cmd_choice(const cmd_args *args, const char *option);       /* which word, from 0 */
/* LOW:HIGH:N, N from 1 to `most`. CMD_OK, or the error printed and CMD_USAGE. */
int         cmd_range(const cmd_args *args, const char *option, int most, double *low, double *high, int *n);
size_t      cmd_operand_count(const cmd_args *args);
const char *cmd_operand(const cmd_args *args, size_t index);            /* NULL past the last */

/* The index-th value of an option read as a distribution, a material, a direction `x,y,z` (made
 * unit; theta,phi in degrees when there are two numbers) or a mask. CMD_OK, or the error printed
 * (with the name at fault, its range, or the known names) and CMD_USAGE. */
int cmd_ndf(const cmd_args *args, const char *option, size_t index, asp_ndf *out);
/* asp_ndf_read; what the value stands on is kept until the command ends. */
asp_status cmd_read_ndf(const char *spec, asp_ndf *out, asp_error *err);
int cmd_material(const cmd_args *args, const char *option, size_t index, asp_material *out);
/* For an option `walk`: can light walk on it? CMD_OK, or CMD_USAGE with the material and those that can named. */
int cmd_can_walk(const asp_material *material);
int cmd_direction(const cmd_args *args, const char *option, asp_vec3 *out);
int cmd_mask(const cmd_args *args, const char *option, int *out);
/* The same for the options ndf, material and mask of one record: a material, or the perfect mirror
 * facets of a distribution; --mask overrules the material's. cmd_surface: there must be just one. */
int cmd_surface_at(const cmd_args *args, const char *option, size_t index, asp_material *out);
int cmd_surface(const cmd_args *args, asp_material *out);
/* The same of a spec whose name says which of the two it is. */
int cmd_surface_spec(const cmd_args *args, const char *spec, asp_material *out);
/* Says what is wrong with `spec`, which is no distribution by `err`; `given` stands before it
 * ("--ndf ", ""). CMD_USAGE. */
int cmd_bad_ndf(const char *given, const char *spec, const asp_error *err);

/* ------------------------------------------------------------------ saying what is wrong
 *
 * One line on stderr, `asperity: ...`. */

int cmd_usage(const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 1, 2)))
#endif
    ;                                             /* returns CMD_USAGE */
int cmd_failed(const char *format, ...)
#if defined(__GNUC__)
    __attribute__((format(printf, 1, 2)))
#endif
    ;                                             /* returns CMD_FAILED */
int cmd_error(const asp_error *err);              /* asp_error_text; returns CMD_FAILED */

/* `unknown WHAT 'name'; did you mean 'x'? known: a, b, c`. names ends with NULL. CMD_USAGE. */
int cmd_unknown(const char *what, const char *name, const char *const *names);
/* The name that was meant, if a slip or two lie between; NULL if none. */
const char *cmd_nearest(const char *name, const char *const *names);
/* The index of name in names, or -1 (nothing printed). */
int cmd_find(const char *name, const char *const *names);

/* ------------------------------------------------------------------ files
 *
 * A signal (Ctrl-C, a closed terminal) ends the program at once and leaves nothing half-written:
 * temporary files opened here are removed by the handler; calls of the library that write a file
 * stand between cmd_hold and cmd_release, which make a signal wait until the file is complete. */

void cmd_hold(void);
void cmd_release(void);

/* Does a file name end so, in upper or lower case (".svg")? */
int cmd_ends_in(const char *path, const char *ending);
/* 1: there is a device or a pipe of this name, which may be called anything. */
int cmd_is_device(const char *path);

/* Before long work: can a file be written there? CMD_OK, or the error printed and CMD_FAILED. */
int cmd_out_check(const char *path);

/* A file that is written over a longer time, under a temporary name. `path` NULL or "-": standard
 * output. CMD_OK, or the error printed and CMD_FAILED. */
typedef struct cmd_out { aspi_out out; int standard; } cmd_out;
int  cmd_out_open(cmd_out *out, const char *path);
void cmd_out_write(cmd_out *out, const char *text, size_t size);
int  cmd_out_broken(const cmd_out *out);          /* 1: a write failed; going on is of no use */
int  cmd_out_close(cmd_out *out);                 /* finishes and renames */
void cmd_out_abandon(cmd_out *out);               /* removes the temporary file */

/* Writes json and a newline to standard output, and frees it. */
int cmd_print_json(json_t *json);

/* ------------------------------------------------------------------ progress
 *
 * A bar on stderr with the time left, drawn only when stderr is a terminal, at most ten times a
 * second. cmd_progress_show is an asp_progress and an asp_preview_progress; it never cancels. */
typedef struct cmd_progress {
    const char *label;
    int    shown;             /* set by the frame */
    double start, last;
} cmd_progress;

cmd_progress cmd_progress_begin(const char *label);
/* The same while rows are written: none where they go to the terminal themselves. */
cmd_progress cmd_progress_beside(const cmd_out *out, const char *label);
int  cmd_progress_show(void *progress, double done);
void cmd_progress_end(cmd_progress *progress);    /* wipes the bar away */

#endif
