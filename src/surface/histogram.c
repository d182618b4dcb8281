/* histogram.c - the slopes of a height field, counted in cells */
#include "data/slopes.h"
#include "surface/surface.h"

typedef struct visit { aspi_slope_visitor *visit; void *context; } visit;

static void pass_on(void *context, aspi_slope s)
{
    const visit *v = context;
    v->visit(v->context, s.p, s.q, 1);
}

static void each(const void *field, aspi_slope_visitor *to, void *context)
{
    visit v = { to, context };
    aspi_each_facet(field, pass_on, &v);
}

asp_status asp_height_field_histogram(const asp_height_field *field, size_t nx, size_t ny,
                                      const asp_slope_range *range, const asp_map *map, void **memory,
                                      asp_ndf *out, asp_error *err)
{
    aspi_counting how = { nx, ny, range != NULL, range ? *range : (asp_slope_range){ 0, 0, 0, 0 } };
    return aspi_slopes_count(each, field, &how, map, memory, out, err);
}
