/* text.c - lines and words of a text file */
#include "text.h"

#include <string.h>

static int is_blank(char c) { return c == ' ' || c == '\t'; }

aspi_lines aspi_lines_of(const aspi_bytes *file)
{
    const char *text = (const char *)file->bytes;
    aspi_lines lines = { text, text + file->size, 0 };
    if (file->size >= 3 && memcmp(text, "\xef\xbb\xbf", 3) == 0)
        lines.at += 3;
    return lines;
}

int aspi_next_line(aspi_lines *lines, aspi_line *line)
{
    if (lines->at >= lines->end)
        return 0;
    const char *start = lines->at, *p = start;
    while (p < lines->end && *p != '\n' && *p != '\r')
        p++;
    *line = (aspi_line){ start, (size_t)(p - start), ++lines->number };
    if (p < lines->end && *p == '\r' && p + 1 < lines->end && p[1] == '\n')
        p++;
    lines->at = p < lines->end ? p + 1 : p;
    return 1;
}

int aspi_is_text(const aspi_bytes *file)
{
    size_t n = file->size < 4096 ? file->size : 4096;
    for (size_t i = 0; i < n; i++) {
        unsigned char c = file->bytes[i];
        if ((c < 32 && c != '\t' && c != '\n' && c != '\r') || c == 127)
            return 0;
    }
    return n > 0;
}

aspi_line aspi_trimmed(aspi_line line)
{
    while (line.length && is_blank(line.text[0])) {
        line.text++;
        line.length--;
    }
    while (line.length && is_blank(line.text[line.length - 1]))
        line.length--;
    return line;
}

int aspi_is_comment(aspi_line trimmed, aspi_line *content)
{
    if (!trimmed.length || trimmed.text[0] != '#')
        return 0;
    while (trimmed.length && trimmed.text[0] == '#') {
        trimmed.text++;
        trimmed.length--;
    }
    if (content)
        *content = aspi_trimmed(trimmed);
    return 1;
}

char aspi_separator(aspi_line line)
{
    if (memchr(line.text, ';', line.length))
        return ';';
    return memchr(line.text, ',', line.length) ? ',' : ' ';
}

static aspi_word bare(const char *text, size_t length)
{
    aspi_line line = aspi_trimmed((aspi_line){ text, length, 0 });
    if (line.length >= 2 && line.text[0] == '"' && line.text[line.length - 1] == '"')
        line = aspi_trimmed((aspi_line){ line.text + 1, line.length - 2, 0 });
    return (aspi_word){ line.text, line.length };
}

size_t aspi_split(aspi_line line, char separator, aspi_word *word, size_t room)
{
    size_t count = 0, i = 0;
    line = aspi_trimmed(line);
    if (!line.length)
        return 0;
    for (;;) {
        size_t start = i;
        while (i < line.length
               && (separator == ' ' ? !is_blank(line.text[i]) : line.text[i] != separator))
            i++;
        if (count < room)
            word[count] = bare(line.text + start, i - start);
        count++;
        if (i == line.length)
            return count;
        i++;
        while (separator == ' ' && i < line.length && is_blank(line.text[i]))
            i++;
    }
}

static char lower(char c) { return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c; }

int aspi_word_is(aspi_word word, const char *text)
{
    size_t i = 0;
    for (; i < word.length && text[i]; i++)
        if (lower(word.text[i]) != text[i])
            return 0;
    return i == word.length && !text[i];
}

int aspi_word_number(aspi_word word, double *out)
{
    return aspi_parse_number(word.text, word.length, out);
}
