/* parse.c - distributions and masks from text */
#define ASP_PRECISION 64
#include "asperity_ndf.h"
#include "asperity/elementary.h"
#include "bsdf/spec.h"

static const char slope_keys[] =
    "unknown key; every distribution takes alpha or alpha_x alpha_y, rotation or rho, mean_x mean_y, "
    "and its own parameters (asperity list)";
static const char ellipsoid_keys[] =
    "unknown key; the ellipsoid takes alpha_x alpha_y theta_x theta_y theta_z, or a11 ... a33, or "
    "s11 s12 s13 s22 s23 s33";

/* Does the model have a number of its own called alpha? Then that key is not the map's. */
static int own_alpha(const asp_model *model)
{
    size_t i;
    for (i = 0; i < model->param_count; i++)
        if (!strcmp(model->params[i].name, "alpha"))
            return 1;
    return 0;
}

/* alpha for both axes, or alpha_x and alpha_y. */
static asp_status read_alphas(aspi_spec *spec, const asp_model *model, double *x, double *y,
                              asp_error *err)
{
    double both = model->alpha;
    int has_both = 0, has_x = 0, has_y = 0;
    asp_status s = ASP_OK;
    if (!own_alpha(model))
        s = aspi_spec_number(spec, "alpha", &both, &has_both, err);
    *x = *y = both;
    if (!s)
        s = aspi_spec_number(spec, "alpha_x", x, &has_x, err);
    if (!s)
        s = aspi_spec_number(spec, "alpha_y", y, &has_y, err);
    if (!s && has_both && (has_x || has_y))
        s = aspi_spec_fail(spec, spec->text, ASP_EINVAL, "alpha", 5,
                           "give alpha or alpha_x and alpha_y, not both", err);
    if (!s && has_x != has_y)
        s = aspi_spec_fail(spec, spec->text, ASP_EINVAL, has_x ? "alpha_y" : "alpha_x", 7,
                           "alpha_x and alpha_y go together", err);
    return s;
}

/* A range error of a map names a key: point to it, or to alpha where that was written instead. */
static asp_status blame(const aspi_spec *spec, asp_status s, asp_error *err)
{
    if (err && s) {
        err->position = 0;
        aspi_spec_blame(spec, err->name, s, err);
        if (!strncmp(err->name, "alpha_", 6) && err->position == 0) {
            aspi_spec_blame(spec, "alpha", s, err);
            if (err->position)
                memcpy(err->name, "alpha", 6);
        }
    }
    return s;
}

static asp_status read_slope_map(aspi_spec *spec, const asp_model *model, asp_map *map, asp_error *err)
{
    double x, y, rotation = 0.0, rho = 0.0, mean_x = 0.0, mean_y = 0.0;
    int turned = 0, correlated = 0;
    asp_status s = read_alphas(spec, model, &x, &y, err);
    if (!s)
        s = aspi_spec_number(spec, "rotation", &rotation, &turned, err);
    if (!s)
        s = aspi_spec_number(spec, "rho", &rho, &correlated, err);
    if (!s)
        s = aspi_spec_number(spec, "mean_x", &mean_x, NULL, err);
    if (!s)
        s = aspi_spec_number(spec, "mean_y", &mean_y, NULL, err);
    if (s)
        return s;
    if (turned && correlated)
        return aspi_spec_fail(spec, spec->text, ASP_EINVAL, "rho", 3,
                              "give rotation or rho, not both", err);
    s = correlated ? asp_map_from_correlation(x, y, rho, mean_x, mean_y, map, err)
                   : asp_map_from_roughness(x, y, rotation, mean_x, mean_y, map, err);
    return blame(spec, s, err);
}

/* All of `count` keys into values, or none of them: *found is how many there were. */
static asp_status read_entries(aspi_spec *spec, const char *const *keys, int count, double *values,
                               int *found, asp_error *err)
{
    int i, has;
    *found = 0;
    for (i = 0; i < count; i++) {
        asp_status s = aspi_spec_number(spec, keys[i], &values[i], &has, err);
        if (s)
            return s;
        *found += has;
    }
    if (*found && *found != count)
        return aspi_spec_fail(spec, spec->text, ASP_EINVAL, keys[0], strlen(keys[0]),
                              "a matrix needs all its entries", err);
    return ASP_OK;
}

static asp_status read_ellipsoid(aspi_spec *spec, const asp_model *model, asp_map *map, asp_error *err)
{
    static const char *const a_keys[] = { "a11", "a12", "a13", "a21", "a22",
                                          "a23", "a31", "a32", "a33" };
    static const char *const s_keys[] = { "s11", "s12", "s13", "s22", "s23", "s33" };
    double A[9], S[6], x, y, tx = 0.0, ty = 0.0, tz = 0.0;
    int has_a, has_s;
    asp_status s = read_entries(spec, a_keys, 9, A, &has_a, err);
    if (!s)
        s = read_entries(spec, s_keys, 6, S, &has_s, err);
    if (s)
        return s;
    if (has_a && has_s)
        return aspi_spec_fail(spec, spec->text, ASP_EINVAL, "s11", 3, "give A or S, not both", err);
    if (has_a)
        return asp_map_from_matrix(A, map, err);
    if (has_s) {
        const double full[9] = { S[0], S[1], S[2], S[1], S[3], S[4], S[2], S[4], S[5] };
        return asp_map_from_gram(full, map, err);
    }
    s = read_alphas(spec, model, &x, &y, err);
    if (!s)
        s = aspi_spec_number(spec, "theta_x", &tx, NULL, err);
    if (!s)
        s = aspi_spec_number(spec, "theta_y", &ty, NULL, err);
    if (!s)
        s = aspi_spec_number(spec, "theta_z", &tz, NULL, err);
    if (!s)
        s = blame(spec, asp_ellipsoid_matrix(x, y, tx, ty, tz, A, err), err);
    return s ? s : asp_map_from_matrix(A, map, err);
}

/* ---- samples */

/* Made of samples, without which it is nothing: found by name, and not in the table of models. */
extern const asp_model asp_model_tabulated;

enum { MOST_SAMPLES = 64 };
typedef struct sample_list { size_t count; double value[MOST_SAMPLES]; size_t at[MOST_SAMPLES]; } sample_list;

/* Numbers between slashes; out->at is where each stands in the text. */
static asp_status read_samples(aspi_spec *spec, const char *key, sample_list *out, asp_error *err)
{
    aspi_item *item = aspi_spec_find(spec, key);
    const char *p, *end;
    if (!item)
        return aspi_spec_fail(spec, spec->text, ASP_EINVAL, key, strlen(key),
                              "needed, as in tabulated:slopes=0/0.1/0.3,density=5/4/1", err);
    p = item->value;
    end = p + item->value_size;
    for (out->count = 0; out->count < MOST_SAMPLES;) {
        size_t used = aspi_read_number(p, (size_t)(end - p), &out->value[out->count]);
        out->at[out->count++] = (size_t)(p - spec->text);
        if (!used || (p + used < end && p[used] != '/'))
            return aspi_spec_fail(spec, p, ASP_EPARSE, key, strlen(key),
                                  "expected numbers between slashes, as in 0/0.1/0.3", err);
        p += used;
        if (p == end)
            return ASP_OK;
        p++;
    }
    return aspi_spec_fail(spec, p, ASP_EPARSE, key, strlen(key), "more than 64 numbers", err);
}

static asp_status parse_tabulated(aspi_spec *spec, const asp_model *model, asp_ndf *out, asp_error *err)
{
    sample_list slopes, densities;
    asp_slope_samples samples = { 0, NULL, NULL, 0.0 };
    asp_map map;
    asp_status s = read_samples(spec, "slopes", &slopes, err);
    if (!s)
        s = read_samples(spec, "density", &densities, err);
    if (!s)
        s = aspi_spec_number(spec, "tail", &samples.tail, NULL, err);
    if (!s)
        s = read_slope_map(spec, model, &map, err);
    if (!s)
        s = aspi_spec_rest(spec, slope_keys, err);
    if (s)
        return s;
    if (slopes.count != densities.count)
        return aspi_spec_fail(spec, spec->text, ASP_EINVAL, "density", 7,
                              "as many densities as slopes are needed", err);
    samples.count = slopes.count;
    samples.slope = slopes.value;
    samples.density = densities.value;
    s = asp_tabulated_make(&samples, &map, out, err);
    if (s && err && err->position >= 0)      /* the index of a sample */
        err->position = (long long)(strcmp(err->name, "density") ? slopes.at : densities.at)[err->position];
    else if (s)
        aspi_spec_blame(spec, err ? err->name : "", s, err);
    return s;
}

/* ---- a distribution */

asp_status aspi_ndf_parse(const asp_model *const *models, const char *text, size_t size,
                          asp_ndf *out, asp_error *err)
{
    aspi_spec spec;
    const asp_model *model;
    double shape[ASP_SHAPE_NUMBERS] = { 0 };
    asp_map map;
    char name[64];
    size_t i;
    int has_matrix;
    asp_status s = aspi_spec_cut(text, size, &spec, err);
    if (s)
        return s;
    if (spec.name_size >= sizeof name)
        return aspi_spec_fail(&spec, text, ASP_EUNKNOWN, spec.name, spec.name_size,
                              "no such distribution (asperity list)", err);
    memcpy(name, spec.name, spec.name_size);
    name[spec.name_size] = '\0';
    model = asp_find_model(models, name);
    if (!model && !strcmp(name, asp_model_tabulated.name))
        return parse_tabulated(&spec, &asp_model_tabulated, out, err);
    if (!model)
        return aspi_spec_fail(&spec, text, ASP_EUNKNOWN, name, spec.name_size,
                              "no such distribution (asperity list)", err);
    has_matrix = aspi_spec_find(&spec, "a11") != NULL;
    for (i = 0; i < spec.count; i++)
        spec.items[i].used = 0;
    for (i = 0; i < model->param_count; i++) {
        shape[i] = model->params[i].initial;
        s = aspi_spec_number(&spec, model->params[i].name, &shape[i], NULL, err);
        if (s)
            return s;
    }
    s = model->keys == ASP_KEYS_ELLIPSOID ? read_ellipsoid(&spec, model, &map, err)
                                          : read_slope_map(&spec, model, &map, err);
    if (!s)
        s = aspi_spec_rest(&spec, model->keys == ASP_KEYS_ELLIPSOID ? ellipsoid_keys : slope_keys,
                           err);
    if (!s)
        s = asp_ndf_make(model, &map, shape, out, err);
    if (s && err && err->position < 0) {
        err->position = 0;
        aspi_spec_blame(&spec, has_matrix ? "a11" : "s11", s, err);
        aspi_spec_blame(&spec, err->name, s, err);
    }
    return s;
}

asp_status asp_ndf_parse(const asp_model *const *models, const char *text, asp_ndf *out,
                         asp_error *err)
{
    return aspi_ndf_parse(models, text, strlen(text), out, err);
}

/* ---- masks */

static const struct { const char *name; int mask, group; } masks[] = {
    { "correlated", ASP_MASK_CORRELATED, 1 },     { "height_correlated", ASP_MASK_CORRELATED, 1 },
    { "uncorrelated", ASP_MASK_UNCORRELATED, 1 }, { "separable", ASP_MASK_UNCORRELATED, 1 },
    { "v_cavity", ASP_MASK_V_CAVITY, 1 },         { "min", ASP_MASK_MIN, 2 },
    { "wall", ASP_MASK_WALL, 2 }
};

static asp_status fail_mask(const char *name, const char *at, const char *reason, asp_error *err)
{
    asp_fail(err, ASP_EUNKNOWN, name, reason);
    if (err)
        err->position = at - name;
    return ASP_EUNKNOWN;
}

asp_status asp_mask_parse(const char *name, int *mask, asp_error *err)
{
    const char *p = name, *end;
    int sum = 0, groups = 0;
    do {
        size_t i, size;
        for (end = p; *end && *end != '+'; end++)
            ;
        size = (size_t)(end - p);
        for (i = 0; i < sizeof masks / sizeof *masks; i++)
            if (strlen(masks[i].name) == size && !memcmp(masks[i].name, p, size))
                break;
        if (i == sizeof masks / sizeof *masks)
            return fail_mask(name, p, "no such mask: correlated, uncorrelated or v_cavity, and min or "
                             "wall, joined by +", err);
        if (groups & masks[i].group)
            return fail_mask(name, p, "one of correlated, uncorrelated, v_cavity and one of min, wall",
                             err);
        groups |= masks[i].group;
        sum |= masks[i].mask;
        p = end + 1;
    } while (*end);
    *mask = sum;
    return ASP_OK;
}
