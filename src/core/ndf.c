/* ndf.c - the table of distributions, and making a value of one */
#define ASP_PRECISION 64
#include "asperity_ndf.h"
#include "asperity/elementary.h"

#define ASPI_MODEL(name) extern const asp_model asp_model_##name;
#include "core/models.def"
#undef ASPI_MODEL

static const asp_model *const models[] = {
#define ASPI_MODEL(name) &asp_model_##name,
#include "core/models.def"
#undef ASPI_MODEL
    NULL
};

const asp_model *const *asp_models(void) { return models; }

const asp_model *asp_find_model(const asp_model *const *table, const char *name)
{
    size_t i;
    if (!table)
        table = models;
    for (i = 0; table[i]; i++)
        if (!strcmp(table[i]->name, name) || (table[i]->alias && !strcmp(table[i]->alias, name)))
            return table[i];
    return NULL;
}

static int in_range(const asp_param *p, double x)
{
    return x <= p->high && (p->low_open ? x > p->low : x >= p->low);
}

static asp_status prepare(asp_ndf *out, const double *shape, asp_error *err)
{
    const asp_model *model = out->model;
    size_t i;
    for (i = 0; i < model->param_count; i++) {
        const asp_param *p = &model->params[i];
        double x = shape ? shape[i] : p->initial;
        if (!in_range(p, x))
            return asp_fail_range(err, p->name, x, p->low, p->low_open, p->high);
        out->shape[i] = x;
    }
    return model->prepare ? model->prepare(out, err) : ASP_OK;
}

void asp_ndf_stretch(asp_ndf *out, double by)
{
    out->map.m00 *= by;
    out->map.m01 *= by;
    out->map.m10 *= by;
    out->map.m11 *= by;
}

static void invert(asp_ndf *ndf)
{
    const asp_map *map = &ndf->map;
    double det = map->m00 * map->m11 - map->m01 * map->m10;
    ndf->i00 = map->m11 / det;
    ndf->i01 = -map->m01 / det;
    ndf->i10 = -map->m10 / det;
    ndf->i11 = map->m00 / det;
    ndf->inv_det = 1.0 / aspi_abs(det);
}

asp_status asp_ndf_make_data(const asp_model *model, const asp_map *map, const double *shape,
                             const void *data, asp_ndf *out, asp_error *err)
{
    asp_ndf ndf;
    asp_status s;
    double det = map->m00 * map->m11 - map->m01 * map->m10;
    double largest = aspi_max(aspi_max(aspi_abs(map->m00), aspi_abs(map->m01)),
                              aspi_max(aspi_abs(map->m10), aspi_abs(map->m11)));
    double mean = aspi_max(aspi_abs(map->tx), aspi_abs(map->ty));
    if (!(largest <= 200.0 && mean <= 200.0) || !(aspi_abs(det) >= 1e-16))
        return asp_fail(err, ASP_EINVAL, "map", "an entry of the slope map is beyond 200 or not a "
                        "number, or its determinant is below 1e-16");
    memset(&ndf, 0, sizeof ndf);
    ndf.model = model;
    ndf.map = *map;
    ndf.data = data;
    s = prepare(&ndf, shape, err);
    if (s)
        return s;
    invert(&ndf);
    *out = ndf;
    return ASP_OK;
}

asp_status asp_ndf_make(const asp_model *model, const asp_map *map, const double *shape,
                        asp_ndf *out, asp_error *err)
{
    return asp_ndf_make_data(model, map, shape, NULL, out, err);
}

asp_ndff asp_ndf_narrow(const asp_ndf *ndf)
{
    asp_ndff out;
    size_t i;
    out.model = ndf->model;
    out.map.m00 = (float)ndf->map.m00;
    out.map.m01 = (float)ndf->map.m01;
    out.map.m10 = (float)ndf->map.m10;
    out.map.m11 = (float)ndf->map.m11;
    out.map.tx = (float)ndf->map.tx;
    out.map.ty = (float)ndf->map.ty;
    out.i00 = (float)ndf->i00;
    out.i01 = (float)ndf->i01;
    out.i10 = (float)ndf->i10;
    out.i11 = (float)ndf->i11;
    out.inv_det = (float)ndf->inv_det;
    for (i = 0; i < ASP_SHAPE_NUMBERS; i++)
        out.shape[i] = (float)ndf->shape[i];
    for (i = 0; i < ASP_TABLE_NUMBERS; i++)
        out.table[i] = (float)ndf->table[i];
    out.data = ndf->data;
    return out;
}
