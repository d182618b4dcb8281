/* error_text.c - an asp_error as one line of text */
#include "asperity_data.h"
#include "io.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct line { char *text; size_t size, used; } line;

static void add(line *l, const char *text)
{
    while (*text && l->used + 1 < l->size) {
        /* control characters of a hostile file must not reach a terminal */
        unsigned char c = (unsigned char)*text++;
        l->text[l->used++] = c < 32 || c == 127 ? '?' : (char)c;
    }
    l->text[l->used] = 0;
}

static void add_number(line *l, double value, int digits)
{
    char text[ASPI_NUMBER_TEXT];
    aspi_format_number(value, digits, text);
    add(l, text);
}

/* Six, or as many as tell the value from the end of the range that it misses. */
static int digits_of(double value, double low, double high)
{
    char a[ASPI_NUMBER_TEXT], b[ASPI_NUMBER_TEXT], c[ASPI_NUMBER_TEXT];
    for (int digits = 6; digits < 17; digits++) {
        aspi_format_number(value, digits, a);
        aspi_format_number(low, digits, b);
        aspi_format_number(high, digits, c);
        if ((value == low || strcmp(a, b) != 0) && (value == high || strcmp(a, c) != 0))
            return digits;
    }
    return 17;
}

static void add_count(line *l, const char *word, long long count)
{
    char text[48];
    snprintf(text, sizeof text, "%s %lld: ", word, count);
    add(l, text);
}

static const char *status_words(asp_status status)
{
    switch (status) {
    case ASP_OK:       return "no error";
    case ASP_EINVAL:   return "value not allowed";
    case ASP_EPARSE:   return "cannot be read";
    case ASP_EUNKNOWN: return "unknown name";
    case ASP_EIO:      return "input or output failed";
    case ASP_EFORMAT:  return "not a valid file";
    case ASP_ENOMEM:   return "out of memory";
    case ASP_ECANCELLED: return "stopped before it was done";
    }
    return "unknown error";
}

const char *asp_error_text(const asp_error *err, char *buffer, size_t size)
{
    line l = { buffer, size, 0 };
    if (!buffer || !size)
        return "";
    buffer[0] = 0;
    if (!err) {
        add(&l, "no error information");
        return buffer;
    }
    if (err->file[0]) {
        add(&l, err->file);
        add(&l, ": ");
    }
    if (err->line > 0)
        add_count(&l, "line", err->line);
    else if (err->position >= 0 && err->status != ASP_OK)
        add_count(&l, "byte", err->position);

    /* in a file a name is a field or a column; elsewhere it is the parameter itself */
    int in_file = err->file[0] != 0;
    if (err->name[0] && in_file)
        add(&l, err->line > 0 ? "column '" : "field '");
    add(&l, err->name);
    if (err->name[0] && in_file)
        add(&l, "'");

    int ranged = !isnan(err->low) && !isnan(err->high);
    if (ranged) {
        int digits = digits_of(err->value, err->low, err->high);
        add(&l, err->name[0] ? " = " : "");
        add_number(&l, err->value, digits);
        add(&l, err->low_open ? " is outside (" : " is outside [");
        add_number(&l, err->low, digits);
        add(&l, ", ");
        add_number(&l, err->high, digits);
        add(&l, "]");                         /* the upper end is allowed, infinity too */
        if (err->reason[0] && strcmp(err->reason, "outside its range") != 0) {
            add(&l, "; ");
            add(&l, err->reason);
        }
        return buffer;
    }
    if (err->name[0])
        add(&l, ": ");
    add(&l, err->reason[0] ? err->reason : status_words(err->status));
    return buffer;
}
