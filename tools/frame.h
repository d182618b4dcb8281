/* frame.h - what main.c and the frame's own files share; subcommands include cmd.h only */
#ifndef FRAME_H
#define FRAME_H

#include "cmd.h"

/* One thing that the user wrote. */
typedef struct frame_value {
    int         option;          /* index into the record's table */
    const char *text;            /* NULL for a flag */
    double      number;          /* of CMD_NUMBER, CMD_INTEGER; the index of a CMD_CHOICE */
} frame_value;

struct cmd_args {
    const cmd_record *record;
    frame_value *values;         /* in the order given */
    size_t       value_count;
    char       **operands;
    size_t       operand_count;
};

#define FRAME_HELP (-1)          /* frame_parse: --help was among the options */

/* Reads argv[1...] by the record's table. CMD_OK, FRAME_HELP, or the error printed and CMD_USAGE
 * (CMD_FAILED where there is no memory). */
int  frame_parse(const cmd_record *record, int argc, char **argv, cmd_args *out);
void frame_release(cmd_args *args);
/* What cmd_read_ndf and cmd_material keep. */
void frame_release_files(void);

/* Checks one value of an option by its kind and range. 0, or 1 with the reason in `why`. */
int  frame_check(const cmd_option *option, const char *text, double *number, char *why, size_t size);

/* The allowed values of an option in words, "" where anything goes. */
void frame_range(const cmd_option *option, char *text, size_t size);
/* The same for every kind in the help: range and default. */
void frame_option_text(const cmd_option *option, char *text, size_t size);

void frame_help(FILE *to);                            /* all subcommands */
void frame_help_command(FILE *to, const cmd_record *record);
void frame_help_markdown(FILE *to);                   /* docs/commands.md */

/* Makes signals remove the temporary files. */
void frame_signals(void);
/* Flushes standard output. CMD_OK, or the error printed and CMD_FAILED. */
int  frame_finish_output(void);

#endif
