/* text.c - growing text, XML escapes, labels with lowered and raised parts */
#include "draw/text.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void aspi_text_add(aspi_text *text, const char *bytes, size_t size)
{
    if (text->failed)
        return;
    if (size >= SIZE_MAX / 4 - text->size) {
        text->failed = 1;
        return;
    }
    if (text->size + size + 1 > text->room) {
        size_t room = 2 * (text->size + size) + 1024;
        char *grown = realloc(text->bytes, room);
        if (!grown) {
            text->failed = 1;
            return;
        }
        text->bytes = grown;
        text->room = room;
    }
    memcpy(text->bytes + text->size, bytes, size);
    text->size += size;
    text->bytes[text->size] = '\0';
}

static void add_string(aspi_text *text, const char *string)
{
    aspi_text_add(text, string, strlen(string));
}

void aspi_text_free(aspi_text *text)
{
    free(text->bytes);
    memset(text, 0, sizeof *text);
}

char *aspi_text_finish(aspi_text *text, asp_error *err)
{
    aspi_text_add(text, "", 0);
    if (text->failed) {
        aspi_text_free(text);
        asp_fail(err, ASP_ENOMEM, "svg", "out of memory");
        return NULL;
    }
    return text->bytes;
}

/* Written from integers: printf's decimal separator follows the caller's locale. */
void aspi_text_number(aspi_text *text, double v, int decimals, const char *minus)
{
    double scale = 1;
    decimals = decimals < 0 ? 0 : decimals > 15 ? 15 : decimals;
    for (int i = 0; i < decimals; i++)
        scale *= 10;
    double rounded = floor(fabs(v) * scale + 0.5);
    if (!(rounded < 9e15)) {            /* cannot happen to coordinates; still well-formed */
        add_string(text, "0");
        return;
    }
    long long n = (long long)rounded, unit = (long long)scale;
    char digits[64];
    if (v < 0 && n > 0)
        add_string(text, minus ? minus : "-");
    if (decimals > 0)
        snprintf(digits, sizeof digits, "%lld.%0*lld", n / unit, decimals, n % unit);
    else
        snprintf(digits, sizeof digits, "%lld", n);
    add_string(text, digits);
}

/* Two decimals at most, without trailing zeros: a hundredth of a pixel. */
static void add_coordinate(aspi_text *text, double v)
{
    aspi_text_number(text, v, 2, NULL);
    if (text->failed)
        return;
    while (text->size && text->bytes[text->size - 1] == '0')
        text->size--;
    if (text->size && text->bytes[text->size - 1] == '.')
        text->size--;
    text->bytes[text->size] = '\0';
}

/* Decodes one character of UTF-8 (Unicode 15, table 3-7); what is not well-formed, or not allowed
 * in XML 1.0, is U+FFFD. Returns the bytes used, at least 1. */
static int decode(const char *s, uint32_t *code)
{
    const unsigned char *b = (const unsigned char *)s;
    int more = b[0] < 0x80 ? 0 : b[0] >= 0xc2 && b[0] < 0xe0 ? 1 : (b[0] & 0xf0) == 0xe0 ? 2
             : b[0] >= 0xf0 && b[0] < 0xf5 ? 3 : -1;
    uint32_t c = more <= 0 ? b[0] : b[0] & (0x3fu >> more);
    for (int i = 1; i <= more; i++) {
        if ((b[i] & 0xc0) != 0x80) {
            more = -1;
            break;
        }
        c = c << 6 | (b[i] & 0x3f);
    }
    int overlong = (more == 2 && c < 0x800) || (more == 3 && c < 0x10000);
    if (c == '\t' || c == '\n' || c == '\r')
        c = ' ';
    if (more < 0 || overlong || c < 0x20 || c == 0x7f || (c >= 0xd800 && c < 0xe000) || c > 0x10ffff
        || (c & 0xfffe) == 0xfffe) {
        *code = 0xfffd;
        return 1;
    }
    *code = c;
    return 1 + more;
}

static void add_escaped(aspi_text *text, const char *s, size_t size)
{
    for (size_t i = 0; i < size && s[i];) {
        uint32_t c;
        int n = decode(s + i, &c);
        if (c == 0xfffd)
            add_string(text, "\xef\xbf\xbd");
        else if (c == '&')
            add_string(text, "&amp;");
        else if (c == '<')
            add_string(text, "&lt;");
        else if (c == '>')
            add_string(text, "&gt;");
        else if (c == '"')
            add_string(text, "&quot;");
        else if (c == '\'')
            add_string(text, "&#39;");
        else if (c == ' ')
            add_string(text, " ");
        else
            aspi_text_add(text, s + i, (size_t)n);
        i += (size_t)n;
    }
}

void aspi_text_put(aspi_text *text, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    for (const char *p = format; *p;) {
        size_t plain = strcspn(p, "%");
        aspi_text_add(text, p, plain);
        p += plain;
        if (!*p)
            break;
        switch (p[1]) {
        case 'n': add_coordinate(text, va_arg(list, double)); break;
        case 'd': aspi_text_number(text, va_arg(list, int), 0, NULL); break;
        case 's': add_string(text, va_arg(list, const char *)); break;
        case 'e': {
            const char *s = va_arg(list, const char *);
            add_escaped(text, s, strlen(s));
            break;
        }
        default: add_string(text, "%"); break;
        }
        p += p[1] ? 2 : 1;
    }
    va_end(list);
}

/* ------------------------------------------------------------------ labels */

/* The next run of a label: [*start, *end) at level -1 lowered, 0, +1 raised. 0 at the end. */
static int next_run(const char **p, const char **start, const char **end, int *level)
{
    const char *s = *p;
    if (!*s)
        return 0;
    const char *close = (*s == '_' || *s == '^') && s[1] == '{' ? strchr(s + 2, '}') : NULL;
    if (close) {
        *level = *s == '_' ? -1 : 1;
        *start = s + 2;
        *end = close;
        *p = close + 1;
        return 1;
    }
    const char *e = s + 1;
    while (*e && !((*e == '_' || *e == '^') && e[1] == '{' && strchr(e + 2, '}')))
        e++;
    *level = 0;
    *start = s;
    *end = e;
    *p = e;
    return 1;
}

#define SCRIPT 0.72     /* size of lowered and raised parts */

void aspi_text_label(aspi_text *text, const char *label, double x, double y, double size,
                     aspi_anchor anchor, double turn, const char *attributes)
{
    static const char *const anchors[] = { "start", "middle", "end" };
    aspi_text_put(text, "<text xml:space=\"preserve\" x=\"%n\" y=\"%n\" font-size=\"%n\" "
                  "text-anchor=\"%s\"", x, y, size,
                  anchors[anchor]);
    if (turn != 0)
        aspi_text_put(text, " transform=\"rotate(%n %n %n)\"", turn, x, y);
    aspi_text_put(text, "%s>", attributes ? attributes : "");
    /* dy moves everything that follows, so each run undoes the shift of the one before */
    double shift = 0;
    const char *p = label, *start, *end;
    int level;
    while (next_run(&p, &start, &end, &level)) {
        double wanted = level < 0 ? 0.22 * size : level > 0 ? -0.36 * size : 0;
        int plain = level == 0 && wanted == shift;
        if (!plain)
            aspi_text_put(text, "<tspan dy=\"%n\" font-size=\"%n\">", wanted - shift,
                          level ? SCRIPT * size : size);
        add_escaped(text, start, (size_t)(end - start));
        if (!plain)
            aspi_text_put(text, "</tspan>");
        shift = wanted;
    }
    aspi_text_put(text, "</text>\n");
}

/* Advance widths of Helvetica for ASCII 32..126 in 1/1000 of the size (Adobe's font metrics). */
static const short helvetica[95] = {
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, 556, 556, 556, 556,
    556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, 1015, 667, 667, 722, 722, 667, 611, 778,
    722, 278, 500, 667, 556, 833, 722, 778, 667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278,
    278, 278, 469, 556, 333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556,
    556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584
};

double aspi_label_width(const char *label, double size)
{
    double width = 0;
    const char *p = label, *start, *end;
    int level;
    while (next_run(&p, &start, &end, &level))
        for (const char *s = start; s < end && *s;) {
            uint32_t c;
            s += decode(s, &c);
            double advance = c < 127 ? helvetica[c - 32] : c < 0x2e80 ? 600 : 1000;
            width += advance * (level ? SCRIPT : 1);
        }
    return 1.16 * width * size / 1000;   /* DejaVu Sans, which may stand in, runs wider */
}

/* ------------------------------------------------------------------ the frame */

void aspi_svg_begin(aspi_text *text, int width, int height, const char *title)
{
    aspi_text_put(text, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" "
                  "viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"%e\" "
                  "font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\" fill=\"#222222\">\n"
                  "<rect width=\"%d\" height=\"%d\" fill=\"#ffffff\"/>\n",
                  width, height, width, height, title ? title : "chart", width, height);
}

void aspi_svg_end(aspi_text *text)
{
    aspi_text_put(text, "</svg>\n");
}

asp_status aspi_svg_write(char *svg, const char *path, const asp_error *why, asp_error *err)
{
    if (!svg) {
        if (err)
            *err = *why;
        return why->status;
    }
    asp_status status = asp_file_write(path, svg, strlen(svg), err);
    free(svg);
    return status;
}
