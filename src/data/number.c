/* number.c - numbers as text with a '.', whatever the locale says */
#include "io.h"

#include "bsdf/spec.h"

#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LONGEST 400          /* no double needs more digits to be told apart in practice */

static int is_digit(char c) { return c >= '0' && c <= '9'; }

/* Position of the decimal point (n where there is none); 0 returned where it is no number. */
static int plain_decimal(const char *s, size_t n, size_t *point)
{
    size_t i = 0, digits = 0;
    *point = n;
    if (i < n && (s[i] == '+' || s[i] == '-'))
        i++;
    for (; i < n && is_digit(s[i]); i++)
        digits++;
    if (i < n && s[i] == '.') {
        *point = i++;
        for (; i < n && is_digit(s[i]); i++)
            digits++;
    }
    if (!digits)
        return 0;
    if (i < n && (s[i] == 'e' || s[i] == 'E')) {
        i++;
        if (i < n && (s[i] == '+' || s[i] == '-'))
            i++;
        if (i == n || !is_digit(s[i]))
            return 0;
        while (i < n && is_digit(s[i]))
            i++;
    }
    return i == n;
}

/* Copies a checked number with the locale's own decimal point, which is what strtod expects. */
static int localised(const char *s, size_t n, char *copy, size_t size)
{
    size_t point;
    if (!n || n > LONGEST || !plain_decimal(s, n, &point))
        return 0;
    const char *mark = localeconv()->decimal_point;
    size_t marks = point < n ? strlen(mark) : 0;
    if (n + marks + 1 > size)
        return 0;
    memcpy(copy, s, point);
    if (point < n) {
        memcpy(copy + point, mark, marks);
        memcpy(copy + point + marks, s + point + 1, n - point - 1);
        copy[n - 1 + marks] = 0;
    } else {
        copy[n] = 0;
    }
    return 1;
}

int aspi_parse_number(const char *text, size_t n, double *out)
{
    size_t point;
    double value;
    if (!n || n > LONGEST || !plain_decimal(text, n, &point)
        || aspi_read_number(text, n, &value) != n || !isfinite(value))
        return 0;
    *out = value;
    return 1;
}

int aspi_parse_long_double(const char *text, size_t n, long double *out)
{
    char copy[LONGEST + 32];
    if (!localised(text, n, copy, sizeof copy))
        return 0;
    long double value = strtold(copy, NULL);
    if (!isfinite((double)value))
        return 0;
    *out = value;
    return 1;
}

/* Puts '.' where the locale put its own mark (which may be several bytes long). */
static size_t delocalise(char *text)
{
    const char *mark = localeconv()->decimal_point;
    if (mark[0] && strcmp(mark, ".") != 0) {
        char *at = strstr(text, mark);
        if (at) {
            size_t marks = strlen(mark);
            *at = '.';
            memmove(at + 1, at + marks, strlen(at + marks) + 1);
        }
    }
    return strlen(text);
}

size_t aspi_format_number(double value, int digits, char text[ASPI_NUMBER_TEXT])
{
    snprintf(text, ASPI_NUMBER_TEXT, "%.*g", digits > 40 ? 40 : digits, value);
    return delocalise(text);
}

size_t aspi_format_long_double(long double value, int digits, char text[ASPI_NUMBER_TEXT])
{
    snprintf(text, ASPI_NUMBER_TEXT, "%.*Lg", digits > 40 ? 40 : digits, value);
    return delocalise(text);
}
