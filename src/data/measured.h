/* measured.h - what the readers and writers of measurements share; nothing outside src/data sees it
 *
 * A file format is a row (name, probe, read). What a reader makes is one of three kinds of data: a
 * MERL table, an RGL parametrisation, a list of geometries. */
#ifndef ASPI_MEASURED_H
#define ASPI_MEASURED_H

#include "io.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>

#define ASPI_PI 3.14159265358979323846

/* A file in memory; `name` is for errors. */
typedef struct aspi_bytes { const unsigned char *bytes; size_t size; const char *name; } aspi_bytes;

/* What can be done with the data of one kind. */
typedef struct aspi_kind {
    asp_rgb (*eval)(const void *data, asp_vec3 wi, asp_vec3 wo);
    void    (*release)(void *data);
    asp_status (*write_csv)(const asp_measured *measured, aspi_out *out, asp_error *err);
} aspi_kind;

struct asp_measured {
    asp_measured_info info;
    const aspi_kind  *kind;
    void             *data;
    char             *description;
};

/* A file format. probe says whether the bytes look like it, by content. */
typedef struct aspi_format {
    const char *name, *looks;            /* and how it is recognised, in words */
    int (*probe)(const aspi_bytes *file);
    asp_measured *(*read)(const aspi_bytes *file, asp_error *err);
} aspi_format;

extern const aspi_format *const aspi_formats[];       /* ends with NULL */
extern const aspi_format aspi_format_merl, aspi_format_rgl, aspi_format_csv, aspi_format_cornell,
                         aspi_format_lumos;
extern const aspi_kind   aspi_kind_merl, aspi_kind_rgl, aspi_kind_list;

/* Wraps data of a kind; takes the data (and releases it on failure). `length` bytes of description
 * are copied, control characters as spaces. */
asp_measured *aspi_measured_wrap(const aspi_kind *kind, void *data, asp_measured_info info,
                                 const char *description, size_t length, asp_error *err);

/* Adds a remark on what was read to the description, after "; ". Takes the measurement; NULL (no
 * memory, or none given) with err filled in the first case. */
asp_measured *aspi_measured_remark(asp_measured *measured, const char *remark, asp_error *err);

/* ---- MERL tables (merl.c): stored numbers, f = value times the scale of the channel */

typedef struct aspi_merl {
    size_t  n_h, n_d, n_p;               /* 90, 90, 180 */
    double *values;                      /* [channel][theta_h][theta_d][phi_d], negative: missing */
} aspi_merl;

#define ASPI_MERL_H 90
#define ASPI_MERL_D 90
#define ASPI_MERL_P 180

extern const double aspi_merl_scale[3];

aspi_merl *aspi_merl_new(size_t n_h, size_t n_d, size_t n_p);     /* all missing; NULL: no memory */
/* Reads any dimensions; what the public reader does after it has insisted on 90 x 90 x 180. */
aspi_merl *aspi_merl_parse(const aspi_bytes *file, asp_error *err);
/* Directions of the centre of a bin; 0 where one of them is at or below the horizon. */
int aspi_merl_centre(const aspi_merl *merl, size_t i_h, size_t i_d, size_t i_p,
                     asp_vec3 *wi, asp_vec3 *wo);
asp_measured *aspi_merl_wrap(aspi_merl *merl, int channels, const char *description, size_t length,
                             const char *format, asp_error *err);

/* ---- lists of geometries (list.c) */

typedef struct aspi_node { double key[4]; uint32_t index, axis; } aspi_node;

typedef struct aspi_list {
    asp_measurement *item;
    size_t count, room;
    int isotropic;
    aspi_node *node;                     /* the search tree, `count` nodes */
} aspi_list;

/* Appends; 0 when out of memory. */
int  aspi_list_add(aspi_list *list, asp_vec3 wi, asp_vec3 wo, asp_rgb f);
void aspi_list_clear(aspi_list *list);
/* Builds the search tree and wraps; takes the list's contents in every case. */
asp_measured *aspi_list_wrap(aspi_list *list, asp_measured_info info, const char *description,
                             size_t length, const char *file, asp_error *err);

/* ---- csv rows (csv_write.c) */

/* The measurement's description and isotropy as comment lines, which the reader understands. */
void aspi_csv_comment(const asp_measured *measured, aspi_out *out);
/* One row of numbers, 17 digits. */
void aspi_csv_row(aspi_out *out, const double *number, int count);
/* Rows of theta_i, phi_i, theta_o, phi_o, r, g, b sampled from a gridded measurement. */
asp_status aspi_csv_sampled(const asp_measured *measured, aspi_out *out, asp_error *err);

/* ---- half and difference angles (Rusinkiewicz 1998) */

/* theta, phi of the half vector; theta, phi of wi in the frame in which the half vector is +z. */
typedef struct aspi_half { double theta_h, phi_h, theta_d, phi_d; } aspi_half;
aspi_half aspi_half_of(asp_vec3 wi, asp_vec3 wo);
void      aspi_half_to(aspi_half a, asp_vec3 *wi, asp_vec3 *wo);

#endif
