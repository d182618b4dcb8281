/* colour.c - the colours of the distributions
 *
 * Chosen by search: Okabe and Ito's blue and vermillion, a green and a pink fixed, the other six the
 * farthest apart in CIELAB for normal, protan, deutan and tritan eyes (Machado et al. 2009, severity
 * 1) with a contrast of at least 2.2 to white. The closest pair is 23 apart, black 22 from each. */
#include <string.h>

#include "draw/plot.h"

typedef struct named_colour {
    const char *name, *colour;
    asp_dash    dash;
} named_colour;

static const named_colour colours[] = {
    { "measured",         "#000000", ASP_DASH_SOLID },
    { "ggx",              "#0072b2", ASP_DASH_SOLID },
    { "trowbridge_reitz", "#0072b2", ASP_DASH_SOLID },
    { "beckmann",         "#d55e00", ASP_DASH_LONG },
    { "student_t",        "#22bb77", ASP_DASH_SOLID },
    { "std",              "#22bb77", ASP_DASH_SOLID },
    { "ellipsoid",        "#994466", ASP_DASH_LONG_DOT },
    { "phong",            "#dd88bb", ASP_DASH_SHORT },
    { "torrance_sparrow", "#770011", ASP_DASH_DOTS },
    { "abc",              "#9900ff", ASP_DASH_LONG },
    { "sgd",              "#330099", ASP_DASH_SHORT },
    { "gtr",              "#9977ff", ASP_DASH_LONG_DOT },
    { "hyper_cauchy",     "#551166", ASP_DASH_LONG_DOT },
};

static const named_colour *find(const char *name)
{
    size_t n = name ? strcspn(name, ":, (") : 0;
    for (size_t i = 0; n && i < sizeof colours / sizeof *colours; i++)
        if (strlen(colours[i].name) == n && strncmp(colours[i].name, name, n) == 0)
            return &colours[i];
    return NULL;
}

const char *asp_colour(const char *name)
{
    const named_colour *c = find(name);
    return c ? c->colour : NULL;
}

const char *asp_colour_nth(size_t index)
{
    static const char *const round[8] = { "#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                          "#e69f00", "#330099", "#56b4e9", "#770011" };
    return round[index % 8];
}

static int is_hex_colour(const char *s)
{
    return s[0] == '#' && strlen(s) == 7 && strspn(s + 1, "0123456789abcdefABCDEF") == 6;
}

asp_status aspi_series_style(const asp_series *series, size_t *next, aspi_style *out, asp_error *err)
{
    static const char *const dashes[] = { "", "", "8 3.5", "3.5 3", "1.3 2.7", "9 3 1.6 3", NULL };
    const named_colour *by_label = find(series->label);
    if (series->colour) {
        const named_colour *by_name = find(series->colour);
        if (!by_name && !is_hex_colour(series->colour))
            return asp_fail(err, ASP_EUNKNOWN, "colour",
                            "neither #rrggbb nor the name of a distribution nor measured");
        out->colour = by_name ? by_name->colour : series->colour;
    } else {
        out->colour = by_label ? by_label->colour : asp_colour_nth((*next)++);
    }
    asp_dash dash = series->dash;
    if (dash == ASP_DASH_AUTO)
        dash = by_label ? by_label->dash : ASP_DASH_SOLID;
    if ((unsigned)dash > ASP_DASH_NONE)
        return asp_fail_range(err, "dash", dash, 0, 0, ASP_DASH_NONE);
    if ((unsigned)series->marker > ASP_MARKER_DOT)
        return asp_fail_range(err, "marker", series->marker, 0, 0, ASP_MARKER_DOT);
    if (series->count && (!series->x || !series->y))
        return asp_fail(err, ASP_EINVAL, "series", "a count but no x or y");
    if (!(series->width >= 0 && series->width <= 100))
        return asp_fail_range(err, "width", series->width, 0, 0, 100);
    out->dash = dashes[dash];
    out->marker = series->marker;
    out->width = series->width > 0 ? series->width : 1.8;
    return ASP_OK;
}
