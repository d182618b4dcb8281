/* asperity_data.h - measured data, height fields and fitting
 *
 *   1  Errors as text
 *   2  Measurements   read, evaluate, write: MERL, RGL, CSV
 *
 * Everything here may allocate and do file I/O; nothing prints or exits. Handles are freed by their
 * _free function, which takes NULL. A finished handle is read-only: any number of threads may
 * evaluate it. */
#ifndef ASPERITY_DATA_H
#define ASPERITY_DATA_H

#include "asperity.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------ 1  Errors as text */

/* One line, e.g. `chm.bsdf: byte 4096: field 'luminance': shape says 8x8x32, file ends after 12 KB`
 * or `alpha = -1 is outside (0, 100]`. Always terminated; returns buffer. */
const char *asp_error_text(const asp_error *err, char *buffer, size_t size);

/* ------------------------------------------------------------------ 2  Measurements */

/* A measured BRDF, isotropic or anisotropic, RGB (a one-channel file fills all three). */
typedef struct asp_measured asp_measured;

/* One measured geometry. f in 1/sr without the cosine, per channel; `valid` 0 where the instrument
 * gave no value. */
typedef struct asp_measurement { asp_vec3 wi, wo; asp_rgb f; } asp_measurement;

typedef struct asp_measured_info {
    const char *format;        /* "merl", "rgl", "csv" */
    const char *description;   /* what the file says of itself, "" if nothing */
    int    isotropic;          /* 1: depends on the azimuth difference only */
    int    scattered;          /* 1: only listed geometries are known (eval interpolates nothing) */
    int    channels;           /* 1 or 3 in the file */
    size_t samples;            /* stored values or geometries */
} asp_measured_info;

/* Reads a measurement; the format is recognised by content, not by name. NULL on failure with err
 * filled (file, position or line, what was expected). Allocates at most a small multiple of the
 * file's size. */
asp_measured *asp_measured_read(const char *path, asp_error *err);
/* The same from memory; `name` is used in errors. The bytes are not kept. */
asp_measured *asp_measured_read_memory(const void *bytes, size_t size, const char *name,
                                       asp_error *err);
void asp_measured_free(asp_measured *measured);
asp_measured_info asp_measured_get_info(const asp_measured *measured);

/* f at a pair of directions, 0 below the horizon. For scattered data: the nearest listed geometry
 * (in half/difference angles); use the geometries themselves to fit. */
asp_rgb asp_measured_eval(const asp_measured *measured, asp_vec3 wi, asp_vec3 wo);

/* The listed geometries of scattered data, NULL and 0 for gridded data. */
const asp_measurement *asp_measured_geometries(const asp_measured *measured, size_t *count);

/* Writers. Each writes to a temporary name beside `path` and renames it when complete: on failure
 * `path` is as it was. merl: the 90 x 90 x 180 half/difference table of doubles (33 MB) with the
 * database's channel scales. csv: header and one row per geometry. */
asp_status asp_measured_write_merl(const asp_measured *measured, const char *path, asp_error *err);
asp_status asp_measured_write_csv(const asp_measured *measured, const char *path, asp_error *err);

/* Builds a gridded measurement in MERL's parametrisation from a function (a model, say) or from
 * 3 x 90 x 90 x 180 values of f ordered [channel][theta_h][theta_d][phi_d], negative = missing. */
typedef asp_rgb asp_brdf_function(const void *context, asp_vec3 wi, asp_vec3 wo);
asp_measured *asp_measured_from_function(asp_brdf_function *f, const void *context,
                                         const char *description, asp_error *err);
asp_measured *asp_measured_from_merl_table(const double *values, const char *description,
                                           asp_error *err);

#ifdef __cplusplus
}
#endif
#endif
