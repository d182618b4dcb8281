/* panels.h - several pictures in one SVG */
#ifndef PANELS_H
#define PANELS_H

#include <stddef.h>

/* Panels `columns` abreast, each with its own coordinates inside, below a title where there is one (a
 * label of asp_chart). A single panel without a title is itself. To be freed; NULL: no memory. */
char *panels_svg(char *const *svg, size_t count, size_t columns, const char *title);

#endif
