/* ndf_read.c - distributions whose slopes stand in a file: `histogram:file=...` in a spec
 *
 * The keys that name the file and say how it is counted are taken out of the spec; what is left, the slope
 * map, and whatever stands around it is read by the core's own parser, through a record that has the map's
 * keys and no others. Positions in errors are those of the spec as it was given. */
#include "asperity_ndf.h"
#include "bsdf/bsdf.h"
#include "slopes.h"
#include "surface/surface.h"

#include <stdlib.h>
#include <string.h>

static const char histogram[] = "histogram";

typedef struct request {
    char *text;              /* the spec without the file's keys */
    size_t *origin;          /* where each of its bytes stood */
    char  path[1024];        /* "" : none was asked for */
    aspi_counting how;
} request;

static void release(request *r)
{
    free(r->text);
    free(r->origin);
}

/* Where `histogram:...` begins and ends in a spec, or in the parentheses of another; 0: nowhere. */
static size_t find(const char *spec, const char **inner)
{
    size_t name = sizeof histogram - 1, depth = 0, size = 0;
    const char *p = spec;
    if (strncmp(p, histogram, name) != 0) {
        while ((p = strstr(p, histogram)) != NULL && p[-1] != '(')
            p++;
        if (!p)
            return 0;
    }
    if (p[name] && p[name] != ':' && p[name] != ')')
        return 0;
    *inner = p;
    for (; p[size] && (depth || p[size] != ')'); size++)
        depth = p[size] == '(' ? depth + 1 : p[size] == ')' ? depth - 1 : depth;
    return size;
}

static void append(request *r, size_t *used, const char *spec, const char *from, size_t size)
{
    for (size_t i = 0; i < size; i++) {
        r->text[*used] = from[i];
        r->origin[(*used)++] = (size_t)(from + i - spec);
    }
}

/* One to `most` numbers between slashes. How many; 0: not numbers. */
static int numbers(const aspi_item *item, int most, double *out)
{
    const char *p = item->value, *end = p + item->value_size;
    for (int count = 0; count < most;) {
        size_t used = aspi_read_number(p, (size_t)(end - p), &out[count++]);
        p += used;
        if (!used || (p < end && *p != '/'))
            return 0;
        if (p++ == end)
            return count;
    }
    return 0;
}

static asp_status read_key(request *r, const aspi_spec *cut, const aspi_item *item, asp_error *err)
{
    double n[4];
    int count = numbers(item, 4, n);
    size_t size = item->value_size;
    const char *path = item->value;
    switch (item->key[0]) {
    case 'f':
        if (size >= 2 && path[0] == '(' && path[size - 1] == ')') {
            path++;                          /* a name with a comma stands in parentheses */
            size -= 2;
        }
        if (size >= sizeof r->path)
            return aspi_spec_fail(cut, path, ASP_EINVAL, "file", 4, "the name is too long", err);
        memcpy(r->path, path, size);
        r->path[size] = 0;
        return ASP_OK;
    case 'b':
        if (count != 1 && count != 2)
            return aspi_spec_fail(cut, item->value, ASP_EPARSE, "bins", 4,
                                  "expected a number, or two as across/along", err);
        n[1] = n[count - 1];
        for (int i = 0; i < 2; i++)
            if (!(n[i] >= 1 && n[i] <= 1024 && n[i] == floor(n[i]))) {
                asp_fail_range(err, "bins", n[i], 1, 0, 1024);
                return aspi_spec_blame(cut, "bins", ASP_EINVAL, err);
            }
        r->how.nx = (size_t)n[0];
        r->how.ny = (size_t)n[1];
        return ASP_OK;
    default:
        if (count != 1 && count != 4)
            return aspi_spec_fail(cut, item->value, ASP_EPARSE, "range", 5,
                                  "expected a slope, or low_x/high_x/low_y/high_y", err);
        r->how.ranged = 1;
        r->how.range = (asp_slope_range){ count == 1 ? -n[0] : n[0], count == 1 ? n[0] : n[1],
                                          count == 1 ? -n[0] : n[2], count == 1 ? n[0] : n[3] };
        if (r->how.range.low_x < r->how.range.high_x && r->how.range.low_y < r->how.range.high_y)
            return ASP_OK;
        return aspi_spec_fail(cut, item->value, ASP_EINVAL, "range", 5,
                              "the upper slope must lie above the lower one", err);
    }
}

static int is_ours(const aspi_item *item)
{
    static const char *const keys[] = { "file", "bins", "range" };
    for (int i = 0; i < 3; i++)
        if (strlen(keys[i]) == item->key_size && !memcmp(keys[i], item->key, item->key_size))
            return 1;
    return 0;
}

/* ASP_OK also where the spec has no histogram: then r->text is NULL. */
static asp_status take(const char *spec, request *r, asp_error *err)
{
    const char *inner;
    size_t size = find(spec, &inner), used = 0, length = strlen(spec);
    aspi_spec cut;
    int more = 0;
    memset(r, 0, sizeof *r);
    if (!size)
        return ASP_OK;
    asp_status s = aspi_spec_cut(inner, size, &cut, err);
    r->text = malloc(length + 2);
    r->origin = malloc((length + 2) * sizeof *r->origin);
    if (s == ASP_OK && (!r->text || !r->origin))
        s = asp_fail(err, ASP_ENOMEM, "spec", "out of memory");
    if (s == ASP_OK)
        append(r, &used, spec, spec, (size_t)(inner - spec) + sizeof histogram - 1);
    for (size_t i = 0; s == ASP_OK && i < cut.count; i++) {
        const aspi_item *item = &cut.items[i];
        if (is_ours(item)) {
            s = read_key(r, &cut, item, err);
            continue;
        }
        append(r, &used, spec, item->key - 1, 1);
        r->text[used - 1] = more++ ? ',' : ':';
        append(r, &used, spec, item->key, item->key_size + 1 + item->value_size);
    }
    if (s == ASP_OK && !r->path[0])
        s = aspi_spec_fail(&cut, inner, ASP_EINVAL, "file", 4, "a histogram is read from a file: "
                           "histogram:file=slopes.csv or a height field .f32, with bins=, range=", err);
    if (s != ASP_OK) {
        if (err && err->position >= 0 && s != ASP_ENOMEM)
            err->position += inner - spec;
        release(r);
        return s;
    }
    append(r, &used, spec, inner + size, length - (size_t)(inner - spec) - size);
    r->text[used] = 0;
    r->origin[used] = length;
    return ASP_OK;
}

static void restore(const request *r, asp_error *err)
{
    size_t length = strlen(r->text);
    if (err && err->position >= 0)
        err->position = (long long)r->origin[(size_t)err->position < length ? (size_t)err->position : length];
}

static asp_status read_path(const request *r, const asp_map *map, asp_ndf *out, void **memory,
                            asp_error *err)
{
    size_t length = strlen(r->path), size;
    unsigned char *bytes;
    asp_status s;
    if (length > 4 && !strcmp(r->path + length - 4, ".f32")) {
        asp_height_field field;
        s = asp_height_field_read(r->path, &field, err);
        if (s != ASP_OK)
            return s;
        s = asp_height_field_histogram(&field, r->how.nx ? r->how.nx : 64, r->how.nx ? r->how.ny : 64,
                                       r->how.ranged ? &r->how.range : NULL, map, memory, out, err);
        if (s != ASP_OK)
            aspi_error_file(err, r->path);
        asp_height_field_free(&field);
        return s;
    }
    s = aspi_read_file(r->path, &bytes, &size, err);
    if (s != ASP_OK)
        return s;
    aspi_bytes file = { bytes, size, r->path };
    aspi_slopes slopes;
    s = aspi_slopes_read(&file, &slopes, err);
    free(bytes);
    if (s != ASP_OK)
        return s;
    s = aspi_slopes_histogram(&slopes, r->path, &r->how, map, memory, out, err);
    aspi_slopes_free(&slopes);
    return s;
}

/* The library's models and one that has a slope map and is called histogram. */
enum { MODELS = 64 };
static asp_status with_carrier(const asp_model *const *models, asp_model *carrier,
                               const asp_model *out[MODELS + 2], asp_error *err)
{
    size_t n = 0;
    *carrier = *asp_find_model(NULL, "ggx");
    carrier->name = histogram;
    carrier->alias = NULL;
    carrier->alpha = 1;
    models = models ? models : asp_models();
    for (; models[n]; n++) {
        if (n == MODELS)
            return asp_fail(err, ASP_EINVAL, "models", "more than 64");
        out[n] = models[n];
    }
    out[n] = carrier;
    out[n + 1] = NULL;
    return ASP_OK;
}

asp_status asp_ndf_read(const asp_model *const *models, const char *spec, asp_ndf *out, void **memory,
                        asp_error *err)
{
    const asp_model *table[MODELS + 2];
    asp_model carrier;
    asp_ndf plain;
    request r;
    asp_status s = take(spec, &r, err);
    *memory = NULL;
    if (s != ASP_OK)
        return s;
    if (!r.text)
        return asp_ndf_parse(models, spec, out, err);
    s = with_carrier(models, &carrier, table, err);
    if (s == ASP_OK && (s = asp_ndf_parse(table, r.text, &plain, err)) != ASP_OK)
        restore(&r, err);
    if (s == ASP_OK)
        s = read_path(&r, &plain.map, out, memory, err);
    release(&r);
    return s;
}

asp_status asp_material_read(const asp_model *const *models, const char *spec, asp_material *out,
                             void **memory, asp_error *err)
{
    const asp_model *table[MODELS + 2];
    asp_model carrier;
    asp_material made;
    asp_map map;
    request r;
    asp_status s = take(spec, &r, err);
    *memory = NULL;
    if (s != ASP_OK)
        return s;
    if (!r.text)
        return asp_material_parse(models, spec, out, err);
    s = with_carrier(models, &carrier, table, err);
    if (s == ASP_OK && (s = asp_material_parse(table, r.text, &made, err)) != ASP_OK)
        restore(&r, err);
    if (s == ASP_OK) {
        map = made.ndf.map;
        s = read_path(&r, &map, &made.ndf, memory, err);
    }
    if (s == ASP_OK && made.model->prepare) /* over these slopes, not over the carrier's */
        s = made.model->prepare(&made, err);
    if (s == ASP_OK)
        *out = made;
    release(&r);
    return s;
}
