/* metals.c - metals by name */
#include "asperity.h"

#include <string.h>

/* name, source of n and k, eta, k, reflectance at normal incidence; linear sRGB under D65 */
static const asp_metal metals[] = {
#include "core/metals_table.h"
};

const asp_metal *asp_metals(size_t *count)
{
    if (count)
        *count = sizeof metals / sizeof *metals;
    return metals;
}

const asp_metal *asp_find_metal(const char *name)
{
    size_t i;
    for (i = 0; i < sizeof metals / sizeof *metals; i++)
        if (!strcmp(metals[i].name, name))
            return &metals[i];
    return NULL;
}
