/* spec.c - the grammar of specs: name:key=value,key=value with values in parentheses */
#include "bsdf/spec.h"

#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Powers of ten that a double holds exactly. */
static const double tens[] = { 1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                               1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22 };

static int digit(char c) { return c >= '0' && c <= '9'; }

static size_t read_word(const char *text, size_t size, const char *word, double value, double *out)
{
    size_t n = strlen(word);
    if (size < n || memcmp(text, word, n))
        return 0;
    *out = value;
    return n;
}

/* strtod follows the locale, and a comma is no decimal point here. A number of at most 15 digits and
 * a power of ten up to 22 is one exact product or quotient; only longer ones go to strtod, with the
 * point written as the locale wants it. */
static double slow_number(const char *text, size_t size)
{
    const char *mark = localeconv()->decimal_point;
    char buffer[512];
    size_t i, n = 0, marks = strlen(mark);
    for (i = 0; i < size && n + marks + 1 < sizeof buffer; i++)
        if (text[i] == '.') {
            memcpy(buffer + n, mark, marks);
            n += marks;
        } else {
            buffer[n++] = text[i];
        }
    buffer[n] = '\0';
    return strtod(buffer, NULL);
}

size_t aspi_read_number(const char *text, size_t size, double *out)
{
    size_t i = 0, digits = 0, significant = 0, start;
    int negative = 0, exponent = 0, point = 0;
    double mantissa = 0.0, value = 0.0;
    if (i < size && (text[i] == '-' || text[i] == '+'))
        negative = text[i++] == '-';
    start = read_word(text + i, size - i, "infinity", INFINITY, &value);
    if (!start)
        start = read_word(text + i, size - i, "inf", INFINITY, &value);
    if (!start)
        start = read_word(text + i, size - i, "nan", NAN, &value);
    if (start) {
        *out = negative ? -value : value;
        return i + start;
    }
    for (; i < size && (digit(text[i]) || (text[i] == '.' && !point)); i++) {
        if (text[i] == '.') {
            point = 1;
            continue;
        }
        digits++;
        significant += significant || text[i] != '0';
        if (significant <= 15) {
            mantissa = 10.0 * mantissa + (text[i] - '0');
            exponent -= point;
        }
    }
    if (!digits)
        return 0;
    if (i + 1 < size && (text[i] == 'e' || text[i] == 'E')) {
        size_t j = i + 1;
        int sign = 1, e = 0;
        if (text[j] == '-' || text[j] == '+')
            sign = text[j++] == '-' ? -1 : 1;
        if (j < size && digit(text[j])) {
            for (; j < size && digit(text[j]); j++)
                if (e < 100000)
                    e = 10 * e + (text[j] - '0');
            exponent += sign * e;
            i = j;
        }
    }
    if (significant > 15 || exponent > 22 || exponent < -22) {
        *out = slow_number(text, i);
        return i;
    }
    value = exponent < 0 ? mantissa / tens[-exponent] : mantissa * tens[exponent];
    *out = negative ? -value : value;
    return i;
}

asp_status aspi_spec_fail(const aspi_spec *spec, const char *at, asp_status status,
                          const char *name, size_t name_size, const char *reason, asp_error *err)
{
    char word[64];
    if (name_size >= sizeof word)
        name_size = sizeof word - 1;
    memcpy(word, name, name_size);
    word[name_size] = '\0';
    asp_fail(err, status, word, reason);
    if (err)
        err->position = at - spec->text;
    return status;
}

static int same(const char *a, size_t size, const char *b)
{
    return strlen(b) == size && !memcmp(a, b, size);
}

/* Where a value ends: at a comma or the end, outside parentheses; NULL if they do not match. */
static const char *value_end(const char *p, const char *end)
{
    int depth = 0;
    for (; p < end && (depth > 0 || *p != ','); p++) {
        depth += (*p == '(') - (*p == ')');
        if (depth < 0)
            return NULL;
    }
    return depth ? NULL : p;
}

asp_status aspi_spec_cut(const char *text, size_t size, aspi_spec *out, asp_error *err)
{
    const char *p = text, *end = text + size;
    memset(out, 0, sizeof *out);
    out->text = text;
    out->name = text;
    while (p < end && *p != ':')
        p++;
    out->name_size = (size_t)(p - text);
    if (!out->name_size)
        return aspi_spec_fail(out, text, ASP_EPARSE, "spec", 4, "a name must come first, as in ggx:alpha=0.3", err);
    if (p < end && ++p == end)
        return aspi_spec_fail(out, p, ASP_EPARSE, "spec", 4, "key=value must follow the colon", err);
    while (p < end) {
        aspi_item *item = &out->items[out->count];
        const char *stop = value_end(p, end), *equal = p;
        size_t i;
        if (!stop)
            return aspi_spec_fail(out, p, ASP_EPARSE, "spec", 4, "parentheses do not match", err);
        while (equal < stop && *equal != '=')
            equal++;
        if (equal == p || equal == stop || equal + 1 == stop)
            return aspi_spec_fail(out, p, ASP_EPARSE, p, (size_t)(stop - p), "expected key=value", err);
        if (out->count == ASPI_SPEC_KEYS)
            return aspi_spec_fail(out, p, ASP_EPARSE, p, (size_t)(equal - p), "too many keys", err);
        item->key = p;
        item->key_size = (size_t)(equal - p);
        item->value = equal + 1;
        item->value_size = (size_t)(stop - equal) - 1;
        for (i = 0; i < out->count; i++)
            if (out->items[i].key_size == item->key_size
                && !memcmp(out->items[i].key, p, item->key_size))
                return aspi_spec_fail(out, p, ASP_EPARSE, p, item->key_size, "given twice", err);
        out->count++;
        p = stop;
        if (p < end && ++p == end)
            return aspi_spec_fail(out, p, ASP_EPARSE, "spec", 4, "key=value must follow the comma", err);
    }
    return ASP_OK;
}

aspi_item *aspi_spec_find(aspi_spec *spec, const char *key)
{
    size_t i;
    for (i = 0; i < spec->count; i++)
        if (same(spec->items[i].key, spec->items[i].key_size, key)) {
            spec->items[i].used = 1;
            return &spec->items[i];
        }
    return NULL;
}

asp_status aspi_spec_number(aspi_spec *spec, const char *key, double *out, int *found,
                            asp_error *err)
{
    aspi_item *item = aspi_spec_find(spec, key);
    double value;
    if (found)
        *found = item != NULL;
    if (!item)
        return ASP_OK;
    if (aspi_read_number(item->value, item->value_size, &value) != item->value_size)
        return aspi_spec_fail(spec, item->value, ASP_EPARSE, key, strlen(key), "not a number", err);
    *out = value;
    return ASP_OK;
}

asp_status aspi_spec_ranged(aspi_spec *spec, const char *key, double low, int low_open, double high,
                            double *out, int *found, asp_error *err)
{
    double value = *out;
    int has;
    asp_status s = aspi_spec_number(spec, key, &value, &has, err);
    if (found)
        *found = has;
    if (s || !has)
        return s;
    if (!(value <= high && (low_open ? value > low : value >= low))) {
        asp_fail_range(err, key, value, low, low_open, high);
        return aspi_spec_blame(spec, key, ASP_EINVAL, err);
    }
    *out = value;
    return ASP_OK;
}

asp_status aspi_spec_colour(aspi_spec *spec, const char *key, double low, int low_open,
                            double high, asp_rgb *out, int *found, asp_error *err)
{
    aspi_item *item = aspi_spec_find(spec, key);
    double c[3] = { 0, 0, 0 };
    const char *p, *end;
    int i = 0, n;
    if (found)
        *found = item != NULL;
    if (!item)
        return ASP_OK;
    p = item->value;
    end = p + item->value_size;
    for (n = 0; n < 3; n++) {
        size_t used = aspi_read_number(p, (size_t)(end - p), &c[n]);
        p += used;
        if (!used || (p < end && *p != '/'))
            break;
        if (p == end) {
            n++;
            break;
        }
        p++;
    }
    if (p != end || (n != 1 && n != 3))
        return aspi_spec_fail(spec, item->value, ASP_EPARSE, key, strlen(key),
                              "expected one number or three as r/g/b", err);
    if (n == 1)
        c[1] = c[2] = c[0];
    for (i = 0; i < 3; i++)
        if (!(c[i] <= high && (low_open ? c[i] > low : c[i] >= low))) {
            asp_fail_range(err, key, c[i], low, low_open, high);
            return aspi_spec_blame(spec, key, ASP_EINVAL, err);
        }
    out->r = c[0];
    out->g = c[1];
    out->b = c[2];
    return ASP_OK;
}

asp_status aspi_spec_rest(const aspi_spec *spec, const char *known, asp_error *err)
{
    size_t i;
    for (i = 0; i < spec->count; i++)
        if (!spec->items[i].used)
            return aspi_spec_fail(spec, spec->items[i].key, ASP_EUNKNOWN, spec->items[i].key,
                                  spec->items[i].key_size, known, err);
    return ASP_OK;
}

asp_status aspi_spec_blame(const aspi_spec *spec, const char *key, asp_status status,
                           asp_error *err)
{
    size_t i;
    for (i = 0; err && i < spec->count; i++)
        if (same(spec->items[i].key, spec->items[i].key_size, key))
            err->position = spec->items[i].value - spec->text;
    return status;
}
