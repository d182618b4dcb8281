/* spec.h - `name:key=value,key=value`, cut into pieces and looked up by key */
#ifndef ASPI_SPEC_H
#define ASPI_SPEC_H

#include "asperity.h"

#define ASPI_SPEC_KEYS 24

typedef struct aspi_item {
    const char *key, *value;         /* into the spec's text, not terminated */
    size_t key_size, value_size;
    int used;
} aspi_item;

typedef struct aspi_spec {
    const char *text;
    const char *name;
    size_t name_size, count;
    aspi_item items[ASPI_SPEC_KEYS];
} aspi_spec;

/* Cuts `text` of `size` bytes; a value in parentheses keeps its commas. Positions in errors count
 * from `text`. */
asp_status aspi_spec_cut(const char *text, size_t size, aspi_spec *out, asp_error *err);

/* Like asp_fail with the position of `at`. */
asp_status aspi_spec_fail(const aspi_spec *spec, const char *at, asp_status status,
                          const char *name, size_t name_size, const char *reason, asp_error *err);

/* The item of a key, marked as used, or NULL. */
aspi_item *aspi_spec_find(aspi_spec *spec, const char *key);

/* The number of a key into *out, which keeps its value when the key is absent. */
asp_status aspi_spec_number(aspi_spec *spec, const char *key, double *out, int *found,
                            asp_error *err);

/* The same for a number within [low, high]. */
asp_status aspi_spec_ranged(aspi_spec *spec, const char *key, double low, int low_open, double high,
                            double *out, int *found, asp_error *err);

/* One number or r/g/b, each within [low, high]. */
asp_status aspi_spec_colour(aspi_spec *spec, const char *key, double low, int low_open,
                            double high, asp_rgb *out, int *found, asp_error *err);

/* Fails on the first item that nobody used; `known` lists the keys in words. */
asp_status aspi_spec_rest(const aspi_spec *spec, const char *known, asp_error *err);

/* Puts the position of the key's value into an error that came from a range check. */
asp_status aspi_spec_blame(const aspi_spec *spec, const char *key, asp_status status,
                           asp_error *err);

/* A decimal number as C writes it, or inf; whatever the locale. Returns the bytes read, 0 if none. */
size_t aspi_read_number(const char *text, size_t size, double *out);

/* A distribution from a spec of `size` bytes. */
asp_status aspi_ndf_parse(const asp_model *const *models, const char *text, size_t size,
                          asp_ndf *out, asp_error *err);
#endif
