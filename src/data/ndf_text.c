/* ndf_text.c - a distribution as the text that asp_ndf_parse reads */
#include "asperity_ndf.h"
#include "data/io.h"

#include <math.h>
#include <string.h>

typedef struct ndf_text { char *to; size_t size, used; int digits, full, keys; } ndf_text;

static void put(ndf_text *t, const char *words)
{
    size_t n = strlen(words);
    t->full |= t->used + n >= t->size;
    if (!t->full)
        memcpy(t->to + t->used, words, n + 1);
    t->used += n;
}

static void put_key(ndf_text *t, const char *key, double value)
{
    char number[ASPI_NUMBER_TEXT] = "inf";
    put(t, t->keys++ ? "," : ":");
    put(t, key);
    put(t, "=");
    if (!isinf(value))
        aspi_format_number(value, t->digits, number);
    put(t, number);
}

/* The map without the stretch that the model's own numbers add. */
static asp_map own_map(const asp_ndf *ndf)
{
    asp_map map = { 1, 0, 0, 1, 0, 0 };
    asp_ndf plain;
    double by = 1;
    if (ndf->model->prepare && asp_ndf_make(ndf->model, &map, ndf->shape, &plain, NULL) == ASP_OK)
        by = plain.map.m00;
    map = ndf->map;
    map.m00 /= by;
    map.m01 /= by;
    map.m10 /= by;
    map.m11 /= by;
    return map;
}

static void put_matrix(ndf_text *t, const asp_map *map)
{
    static const char *const key[] = { "a11", "a12", "a13", "a21", "a22", "a23", "a31", "a32", "a33" };
    double A[9];
    asp_map_to_matrix(map, A);
    for (int i = 0; i < 9; i++)
        put_key(t, key[i], A[i] == 0 ? 0 : A[i]);        /* no -0 */
}

static void put_map(ndf_text *t, const asp_model *model, const asp_map *map)
{
    asp_roughness r = asp_map_to_roughness(map);
    int own_alpha = 0, round = fabs(r.alpha_x - r.alpha_y) <= 1e-15 * r.alpha_x;
    for (size_t i = 0; i < model->param_count; i++)
        own_alpha |= strcmp(model->params[i].name, "alpha") == 0;
    if (round && map->m01 == 0 && map->m10 == 0)
        r.alpha_x = r.alpha_y = fabs(map->m00);            /* as it was written */
    if (!round || (own_alpha && r.alpha_x != model->alpha)) {
        put_key(t, "alpha_x", r.alpha_x);
        put_key(t, "alpha_y", r.alpha_y);
    } else if (!own_alpha && !(model->own_scale && r.alpha_x == model->alpha)) {
        put_key(t, "alpha", r.alpha_x);
    }
    if (!round && r.rotation != 0)
        put_key(t, "rotation", r.rotation);
    if (r.mean_x != 0)
        put_key(t, "mean_x", r.mean_x);
    if (r.mean_y != 0)
        put_key(t, "mean_y", r.mean_y);
}

size_t asp_ndf_text(const asp_ndf *ndf, int digits, char *text, size_t size)
{
    ndf_text t = { text, size, 0, digits, 0, 0 };
    const asp_model *model = ndf->model;
    asp_map map = own_map(ndf);
    put(&t, model->name);
    if (model->keys == ASP_KEYS_ELLIPSOID)
        put_matrix(&t, &map);
    else
        put_map(&t, model, &map);
    for (size_t i = 0; i < model->param_count; i++)
        put_key(&t, model->params[i].name, ndf->shape[i]);
    return t.full ? 0 : t.used;
}
