/* args.c - the command line by the table of the subcommand */
#define _POSIX_C_SOURCE 200809L
#include "frame.h"

#include <getopt.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LONG_BASE 256            /* getopt's value of option i is LONG_BASE + i: above any letter */

/* ------------------------------------------------------------------ one value */

static void put_number(char *text, size_t size, double value)
{
    if (value == floor(value) && fabs(value) < 1e16)
        snprintf(text, size, "%.0f", value);
    else
        snprintf(text, size, "%g", value);
}

void frame_range(const cmd_option *option, char *text, size_t size)
{
    char low[40], high[40];
    text[0] = 0;
    if (option->kind == CMD_CHOICE) {
        snprintf(text, size, "one of %s", option->argument);
    } else if ((option->kind == CMD_NUMBER || option->kind == CMD_INTEGER) &&
               (option->low != 0 || option->high != 0)) {
        put_number(low, sizeof low, option->low);
        put_number(high, sizeof high, option->high);
        snprintf(text, size, "%s%s, %s]", option->low_open ? "(" : "[", low, high);
    }
}

/* Index of `word` among words that stand between bars, -1 if none. */
static int choice_index(const char *choices, const char *word)
{
    size_t n = strlen(word);
    for (int index = 0;; index++) {
        size_t length = strcspn(choices, "|");
        if (length == n && memcmp(choices, word, n) == 0)
            return index;
        if (!choices[length])
            return -1;
        choices += length + 1;
    }
}

int frame_check(const cmd_option *option, const char *text, double *number, char *why, size_t size)
{
    char range[160];
    frame_range(option, range, sizeof range);
    switch (option->kind) {
    case CMD_FLAG:
        return 0;
    case CMD_TEXT:
        if (!text[0]) {
            snprintf(why, size, "is empty");
            return 1;
        }
        return 0;
    case CMD_CHOICE:
        *number = choice_index(option->argument, text);
        if (*number < 0) {
            snprintf(why, size, "'%s' is none of %s", text, option->argument);
            return 1;
        }
        return 0;
    case CMD_NUMBER:
    case CMD_INTEGER:
        break;
    }
    int endless = option->kind == CMD_NUMBER && isinf(option->high) && strcmp(text, "inf") == 0;
    if (endless)
        *number = option->high;
    if (!endless && !aspi_parse_number(text, strlen(text), number)) {
        snprintf(why, size, "'%s' is not a number%s%s", text, range[0] ? "; allowed is " : "",
                 range);
        return 1;
    }
    if (option->kind == CMD_INTEGER && *number != floor(*number)) {
        snprintf(why, size, "%s is not a whole number; allowed is %s", text, range);
        return 1;
    }
    if (range[0] && (*number < option->low || *number > option->high ||
                     (option->low_open && *number == option->low))) {
        snprintf(why, size, "%s is outside %s", text, range);
        return 1;
    }
    return 0;
}

/* ------------------------------------------------------------------ all of them */

static size_t option_count(const cmd_record *record)
{
    size_t count = 0;
    while (record->options && record->options[count].name)
        count++;
    return count;
}

static int unknown_option(const cmd_record *record, const char *word)
{
    const char *names[64];
    char given[80];
    size_t count = option_count(record), used = 0, length = strcspn(word, "=");
    for (size_t i = 0; i < count && used < 62; i++)
        names[used++] = record->options[i].name;
    names[used++] = "help";
    names[used] = NULL;
    snprintf(given, sizeof given, "%.*s", (int)(length < 70 ? length : 70), word);
    const char *begun[64];
    size_t matches = 0;
    for (size_t i = 0; i < used; i++)
        if (strncmp(names[i], given, strlen(given)) == 0)
            begun[matches++] = names[i];
    begun[matches] = NULL;
    return matches > 1 ? cmd_unknown("ambiguous option", given, begun)
                       : cmd_unknown("unknown option", given, names);
}

static int add_value(cmd_args *out, int index, const char *text)
{
    const cmd_option *option = &out->record->options[index];
    frame_value *value = &out->values[out->value_count];
    char why[256];
    if (!option->many && option->kind != CMD_FLAG && cmd_given(out, option->name))
        return cmd_usage("--%s is given twice", option->name);
    value->option = index;
    value->text = text;
    value->number = NAN;
    if (frame_check(option, text, &value->number, why, sizeof why))
        return cmd_usage("--%s: %s", option->name, why);
    out->value_count++;
    return CMD_OK;
}

static int check_whole(const cmd_args *args)
{
    const cmd_record *record = args->record;
    for (size_t i = 0; i < option_count(record); i++)
        if (record->options[i].required && !cmd_given(args, record->options[i].name))
            return cmd_usage("--%s %s is missing: %s", record->options[i].name,
                             record->options[i].argument, record->options[i].help);
    if ((int)args->operand_count < record->least)
        return cmd_usage("something is missing: asperity %s %s", record->name, record->operands);
    if (record->most >= 0 && (int)args->operand_count > record->most)
        return cmd_usage("'%s' is one too many: asperity %s %s", args->operands[record->most],
                         record->name, record->operands);
    return CMD_OK;
}

/* The option that getopt means by c: a letter or LONG_BASE + index; -1 if none. */
static int option_of(const cmd_record *record, int c)
{
    for (size_t i = 0; i < option_count(record); i++)
        if (c == LONG_BASE + (int)i || c == record->options[i].letter)
            return (int)i;
    return -1;
}

static int read_options(const cmd_record *record, int argc, char **argv, const char *letters,
                        const struct option *longs, cmd_args *out)
{
    size_t count = option_count(record);
    int c, status = CMD_OK;
    opterr = 0;
    optind = 1;
    while (status == CMD_OK && (c = getopt_long(argc, argv, letters, longs, NULL)) != -1) {
        if (c == 'h' || c == LONG_BASE + (int)count)
            return FRAME_HELP;
        if (c == ':' || (c == '?' && optopt >= LONG_BASE)) {
            int index = option_of(record, optopt);
            status = c == ':' && index >= 0
                ? cmd_usage("--%s needs a value: %s", record->options[index].name,
                            record->options[index].argument)
                : cmd_usage("'%s': the option takes no value", argv[optind - 1]);
        } else if (c == '?' && optopt) {
            status = cmd_usage("unknown option -%c; see asperity help %s", optopt, record->name);
        } else if (c == '?') {
            status = unknown_option(record, argv[optind - 1] + 2);
        } else {
            status = add_value(out, option_of(record, c), optarg);
        }
    }
    out->operands = argv + optind;
    out->operand_count = (size_t)(argc - optind);
    return status;
}

int frame_parse(const cmd_record *record, int argc, char **argv, cmd_args *out)
{
    size_t count = option_count(record), used = 0;
    struct option *longs = calloc(count + 2, sizeof *longs);
    char *letters = calloc(2 * count + 4, 1);
    memset(out, 0, sizeof *out);
    out->record = record;
    out->values = calloc((size_t)argc + 1, sizeof *out->values);
    if (!longs || !letters || !out->values) {
        free(longs);
        free(letters);
        return cmd_failed("out of memory");
    }
    letters[used++] = ':';                   /* tells a missing value from an unknown option */
    letters[used++] = 'h';
    for (size_t i = 0; i < count; i++) {
        const cmd_option *option = &record->options[i];
        longs[i].name = option->name;
        longs[i].has_arg = option->kind == CMD_FLAG ? no_argument : required_argument;
        longs[i].val = LONG_BASE + (int)i;
        if (option->letter) {
            letters[used++] = option->letter;
            if (option->kind != CMD_FLAG)
                letters[used++] = ':';
        }
    }
    longs[count].name = "help";
    longs[count].val = LONG_BASE + (int)count;
    int status = read_options(record, argc, argv, letters, longs, out);
    free(longs);
    free(letters);
    return status ? status : check_whole(out);
}

void frame_release(cmd_args *args)
{
    free(args->values);
    args->values = NULL;
}

/* ------------------------------------------------------------------ asking for them */

static int option_index(const cmd_args *args, const char *name)
{
    for (size_t i = 0; i < option_count(args->record); i++)
        if (strcmp(args->record->options[i].name, name) == 0)
            return (int)i;
    abort();                                 /* not in the table: a mistake in the program */
}

static const frame_value *last_value(const cmd_args *args, int index)
{
    for (size_t i = args->value_count; i-- > 0;)
        if (args->values[i].option == index)
            return &args->values[i];
    return NULL;
}

const cmd_record *cmd_args_record(const cmd_args *args) { return args->record; }

size_t cmd_given(const cmd_args *args, const char *option)
{
    int index = option_index(args, option);
    size_t count = 0;
    for (size_t i = 0; i < args->value_count; i++)
        count += args->values[i].option == index;
    return count;
}

const char *cmd_text(const cmd_args *args, const char *option)
{
    int index = option_index(args, option);
    const frame_value *value = last_value(args, index);
    return value ? value->text : args->record->options[index].initial;
}

const char *cmd_text_at(const cmd_args *args, const char *option, size_t at)
{
    int index = option_index(args, option);
    for (size_t i = 0; i < args->value_count; i++)
        if (args->values[i].option == index && at-- == 0)
            return args->values[i].text;
    return NULL;
}

double cmd_number(const cmd_args *args, const char *option)
{
    int index = option_index(args, option);
    const frame_value *value = last_value(args, index);
    const char *initial = args->record->options[index].initial;
    double number = NAN;
    char why[8];
    if (value)
        return value->number;
    if (initial && frame_check(&args->record->options[index], initial, &number, why, sizeof why))
        abort();                             /* a default that its own table refuses */
    return number;
}

long long cmd_integer(const cmd_args *args, const char *option)
{
    double number = cmd_number(args, option);
    return isnan(number) ? 0 : (long long)number;
}

int cmd_choice(const cmd_args *args, const char *option)
{
    return (int)cmd_integer(args, option);
}

int cmd_range(const cmd_args *args, const char *option, int most, double *low, double *high, int *n)
{
    const char *text = cmd_text(args, option);
    char rest;
    if (sscanf(text, "%lf:%lf:%d%c", low, high, n, &rest) == 3 && *n >= 1 && *n <= most && isfinite(*low)
        && isfinite(*high))
        return CMD_OK;
    return cmd_usage("--%s %s: expected LOW:HIGH:N, N from 1 to %d", option, text, most);
}

size_t cmd_operand_count(const cmd_args *args) { return args->operand_count; }

const char *cmd_operand(const cmd_args *args, size_t index)
{
    return index < args->operand_count ? args->operands[index] : NULL;
}
