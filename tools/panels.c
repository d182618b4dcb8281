/* panels.c - several pictures in one SVG */
#include "panels.h"

#include "cmd.h"
#include "draw/text.h"

#include <math.h>
#include <string.h>

#define TITLE_HEIGHT 30.0
#define TITLE_SIZE 16.0

/* The size that the panel's own <svg> tag states. */
static double attribute(const char *svg, const char *name)
{
    char key[24];
    const char *end = strchr(svg, '>');
    double value = 0;
    snprintf(key, sizeof key, " %s=\"", name);
    const char *at = strstr(svg, key);
    if (at && end && at < end) {
        at += strlen(key);
        aspi_parse_number(at, strcspn(at, "\""), &value);
    }
    return value;
}

static double row_height(char *const *svg, size_t count, size_t first, size_t columns)
{
    double height = 0;
    for (size_t i = first; i < count && i < first + columns; i++)
        height = fmax(height, attribute(svg[i], "height"));
    return height;
}

char *panels_svg(char *const *svg, size_t count, size_t columns, const char *title)
{
    aspi_text text = { 0 };
    double cell = 0, top = title ? TITLE_HEIGHT : 0, height = top;
    if (count == 1 && !title) {
        aspi_text_put(&text, "%s", svg[0]);
        return aspi_text_finish(&text, NULL);
    }
    columns = columns < count ? columns : count;
    for (size_t i = 0; i < count; i++)
        cell = fmax(cell, attribute(svg[i], "width"));
    for (size_t i = 0; i < count; i += columns)
        height += row_height(svg, count, i, columns);
    double width = (double)columns * cell;
    if (title) {
        aspi_svg_begin(&text, (int)width, (int)height, title);
        aspi_text_label(&text, title, width / 2, 21, TITLE_SIZE, ASPI_MIDDLE, 0,
                        " font-weight=\"bold\"");
    } else {
        aspi_text_put(&text, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%n\" height=\"%n\" "
                      "viewBox=\"0 0 %n %n\">\n", width, height, width, height);
    }
    for (size_t i = 0; i < count; i++) {
        aspi_text_put(&text, "<g transform=\"translate(%n %n)\">\n%s</g>\n",
                      (double)(i % columns) * cell, top, svg[i]);
        if ((i + 1) % columns == 0)
            top += row_height(svg, count, i + 1 - columns, columns);
    }
    aspi_svg_end(&text);
    return aspi_text_finish(&text, NULL);
}
