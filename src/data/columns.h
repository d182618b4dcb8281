/* columns.h - tables of text whose columns have names: angles and values of measured geometries */
#ifndef ASPI_COLUMNS_H
#define ASPI_COLUMNS_H

#include "text.h"

/* What a column holds. */
typedef enum aspi_role {
    ASPI_THETA_I, ASPI_PHI_I, ASPI_THETA_O, ASPI_PHI_O,
    ASPI_WI_X, ASPI_WI_Y, ASPI_WI_Z, ASPI_WO_X, ASPI_WO_Y, ASPI_WO_Z,
    ASPI_THETA_H, ASPI_PHI_H, ASPI_THETA_D, ASPI_PHI_D,
    ASPI_INDEX_H, ASPI_INDEX_D, ASPI_INDEX_P,
    ASPI_F, ASPI_R, ASPI_G, ASPI_B,
    ASPI_ROLES
} aspi_role;

typedef struct aspi_column { const char *name; aspi_role role; int degrees; } aspi_column;

/* A header that has been understood: the word of a row and the unit that each role has; a role
 * without a column may have a constant from a comment. */
typedef struct aspi_header {
    int       at[ASPI_ROLES];            /* word number, -1: none */
    double    unit[ASPI_ROLES];          /* times this gives radians */
    int       constant[ASPI_ROLES];      /* 1: `value` holds for every row, in radians */
    double    value[ASPI_ROLES];
    const char *name[ASPI_ROLES];        /* the column's name, for errors */
    int       columns;
    char      separator;
    long long line;                      /* where the header stands */
    int       isotropic;                 /* 0, 1: said in a comment; -1: not said */
    aspi_line description;               /* the first comment that is no `name = ...` */
} aspi_header;

/* The names of the csv format: {theta,phi}_{i,o,h,d} in radians or with _deg, wi_x .. wo_z,
 * theta_h_index .. phi_d_index, f (brdf, fr) or r, g, b. */
const aspi_column *aspi_csv_columns(void);

/* Is this a header of these columns: every word one of the names. */
int aspi_names_columns(aspi_line line, const aspi_column *known);

/* Finds and understands the header of a table: its first line that is no comment if that holds
 * names, otherwise the last comment before it. On success `lines` stands at the first row. */
asp_status aspi_read_header(const aspi_bytes *file, const aspi_column *known, aspi_lines *lines,
                            aspi_header *header, asp_error *err);

/* Reads the rows after a header: a MERL table or a list, as the columns say. */
asp_measured *aspi_read_rows(const aspi_bytes *file, aspi_lines lines, const aspi_header *header,
                             const char *format, asp_error *err);

#endif
