/* text.h - a growing text, and the few words of SVG and XML that every picture needs */
#ifndef ASPI_DRAW_TEXT_H
#define ASPI_DRAW_TEXT_H

#include <stddef.h>

#include "asperity_draw.h"

/* Starts as all zero. When memory runs out `failed` is set and everything added later is ignored, so
 * that one look at the end is enough. */
typedef struct aspi_text {
    char  *bytes;
    size_t size, room;
    int    failed;
} aspi_text;

void aspi_text_add(aspi_text *text, const char *bytes, size_t size);

/* Adds `format` where   %n is a double, at most two decimals   %d an int   %s raw text
 *                       %e text escaped for XML                %% a per cent sign. */
void aspi_text_put(aspi_text *text, const char *format, ...);

/* Hands out the terminated text, or frees it and fills err when memory ran out. */
char *aspi_text_finish(aspi_text *text, asp_error *err);

void aspi_text_free(aspi_text *text);

/* v with `decimals` decimals and, when `minus` is given, that in place of '-'. No locale. */
void aspi_text_number(aspi_text *text, double v, int decimals, const char *minus);

/* ---- labels: UTF-8 with _{...} and ^{...} */

typedef enum aspi_anchor { ASPI_START, ASPI_MIDDLE, ASPI_END } aspi_anchor;

/* A <text> element of `size` px with its baseline at (x, y), turned by `turn` degrees around it. */
void aspi_text_label(aspi_text *text, const char *label, double x, double y, double size,
                     aspi_anchor anchor, double turn, const char *attributes);

/* Its width in px, estimated from Helvetica's metrics and a little generous. */
double aspi_label_width(const char *label, double size);

/* ---- the frame of every picture */

void aspi_svg_begin(aspi_text *text, int width, int height, const char *title);
void aspi_svg_end(aspi_text *text);

/* Writes a finished SVG and frees it; NULL means that making it failed, and `why` says why. */
asp_status aspi_svg_write(char *svg, const char *path, const asp_error *why, asp_error *err);

/* asp_fail with the reason of errno and the name of the file. */
asp_status aspi_fail_system(asp_error *err, int number, const char *path, const char *doing);

#endif
