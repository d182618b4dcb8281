/* csv.c - tables of text, read row by row */
#define _POSIX_C_SOURCE 200809L
#include "csv.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static int is_blank(char c) { return c == ' ' || c == '\t'; }

/* The cell that begins at `at`: its bounds without blanks and quotes. Returns where the next one
 * begins, NULL after the last. */
static const char *cell(const char *at, char separator, const char **start, size_t *length)
{
    while (is_blank(*at) && *at != separator)
        at++;
    const char *end;
    if (*at == '"') {
        *start = ++at;
        end = at + strcspn(at, "\"");
        at = *end ? end + 1 : end;
        while (*at && *at != separator)
            at++;
    } else {
        *start = at;
        while (*at && *at != separator)
            at++;
        end = at;
        while (end > *start && is_blank(end[-1]))
            end--;
    }
    *length = (size_t)(end - *start);
    return *at ? at + 1 : NULL;
}

static size_t cell_count(const char *line, char separator)
{
    const char *start;
    size_t length, count = 0;
    while (line) {
        line = cell(line, separator, &start, &length);
        count++;
    }
    return count;
}

/* One line without its end. 1, 0 at the end of the file, -1 with the error printed. */
static int read_line(csv *table)
{
    errno = 0;
    ssize_t n = getline(&table->line, &table->room, table->file);
    if (n < 0 && !ferror(table->file) && errno != ENOMEM)
        return 0;
    if (n < 0) {
        int number = errno ? errno : EIO;
        if (table->number == 0)                /* a directory: there is no line to speak of */
            cmd_failed("%s: cannot read: %s", table->name, strerror(number));
        else
            cmd_failed("%s: line %lld: %s", table->name, table->number + 1, strerror(number));
        return -1;
    }
    table->number++;
    if (memchr(table->line, 0, (size_t)n)) {
        cmd_failed("%s: line %lld: a zero byte: this is not a text file", table->name,
                   table->number);
        return -1;
    }
    while (n > 0 && (table->line[n - 1] == '\n' || table->line[n - 1] == '\r'))
        n--;
    table->line[n] = 0;
    if (table->number == 1 && strncmp(table->line, "\xef\xbb\xbf", 3) == 0) {
        n -= 3;                                /* a byte order mark is no part of the text */
        memmove(table->line, table->line + 3, (size_t)n + 1);
    }
    table->length = (size_t)n;
    return 1;
}

static int is_aside(const char *line)
{
    line += strspn(line, " \t");
    return !*line || *line == '#';
}

static int read_header(csv *table)
{
    const char *at = table->line, *start;
    size_t length;
    table->separator = strchr(at, '\t') ? '\t' : strchr(at, ';') ? ';' : ',';
    table->columns = cell_count(at, table->separator);
    table->column = calloc(table->columns, sizeof *table->column);
    for (size_t i = 0; table->column && i < table->columns; i++) {
        at = cell(at, table->separator, &start, &length);
        table->column[i] = strndup(start, length);
        if (!table->column[i])
            return cmd_failed("out of memory");
        if (length && csv_find(table, table->column[i]) != (int)i)
            return cmd_failed("%s: line %lld: column '%s' stands there twice", table->name,
                              table->number, table->column[i]);
    }
    return table->column ? CMD_OK : cmd_failed("out of memory");
}

int csv_open(csv *table, const char *path, cmd_out *aside)
{
    int got;
    memset(table, 0, sizeof *table);
    if (!path || strcmp(path, "-") == 0) {
        table->name = "standard input";
        table->file = stdin;
    } else {
        table->name = path;
        table->file = fopen(path, "rb");
        if (!table->file)
            return cmd_failed("%s: cannot open: %s", path, strerror(errno));
    }
    while ((got = read_line(table)) > 0 && is_aside(table->line)) {
        cmd_out_write(aside, table->line, table->length);
        cmd_out_write(aside, "\n", 1);
    }
    if (got > 0 && read_header(table) == CMD_OK)
        return CMD_OK;
    if (got == 0)
        cmd_failed("%s: there is no header line", table->name);
    csv_close(table);
    return CMD_FAILED;
}

csv_row csv_next(csv *table)
{
    int got = read_line(table);
    if (got <= 0)
        return got ? CSV_BROKEN : CSV_END;
    if (is_aside(table->line))
        return CSV_ASIDE;
    size_t count = cell_count(table->line, table->separator);
    if (count == table->columns)
        return CSV_CELLS;
    cmd_failed("%s: line %lld: %zu cells, the header has %zu", table->name, table->number, count,
               table->columns);
    return CSV_BROKEN;
}

int csv_find(const csv *table, const char *name)
{
    for (size_t i = 0; i < table->columns; i++)
        if (table->column[i] && strcmp(table->column[i], name) == 0)
            return (int)i;
    return -1;
}

int csv_numbers(const csv *table, const int *wanted, size_t count, double *out)
{
    const char *at = table->line, *start;
    size_t length, done = 0;
    for (int i = 0; at && done < count; i++) {
        at = cell(at, table->separator, &start, &length);
        for (size_t j = 0; j < count; j++) {
            if (wanted[j] != i)
                continue;
            if (!aspi_parse_number(start, length, &out[j])) {
                cmd_failed("%s: line %lld: column '%s': '%.*s' is not a finite number",
                           table->name, table->number, table->column[i],
                           (int)(length < 40 ? length : 40), start);
                return 1;
            }
            done++;
        }
    }
    return 0;
}

void csv_text(const csv *table, int column, char *out, size_t size)
{
    const char *at = table->line, *start = "";
    size_t length = 0;
    for (int i = 0; at && i <= column; i++)
        at = cell(at, table->separator, &start, &length);
    snprintf(out, size, "%.*s", (int)length, start);
}

void csv_close(csv *table)
{
    for (size_t i = 0; table->column && i < table->columns; i++)
        free(table->column[i]);
    free(table->column);
    free(table->line);
    if (table->file && table->file != stdin)
        fclose(table->file);
    memset(table, 0, sizeof *table);
}

double csv_done(const csv *table)
{
    struct stat about;
    off_t at = ftello(table->file);
    if (at < 0 || fstat(fileno(table->file), &about) || !S_ISREG(about.st_mode) || about.st_size <= 0)
        return -1;
    return (double)at / (double)about.st_size;
}
