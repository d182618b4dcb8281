/* columns.c - headers of tables: which column holds what, in which unit */
#include "columns.h"

#include <string.h>

#define MOST_COLUMNS 64

static const aspi_column known_names[] = {
    { "theta_i", ASPI_THETA_I, 0 },   { "theta_i_deg", ASPI_THETA_I, 1 },
    { "phi_i", ASPI_PHI_I, 0 },       { "phi_i_deg", ASPI_PHI_I, 1 },
    { "theta_o", ASPI_THETA_O, 0 },   { "theta_o_deg", ASPI_THETA_O, 1 },
    { "phi_o", ASPI_PHI_O, 0 },       { "phi_o_deg", ASPI_PHI_O, 1 },
    { "wi_x", ASPI_WI_X, 0 }, { "wi_y", ASPI_WI_Y, 0 }, { "wi_z", ASPI_WI_Z, 0 },
    { "wo_x", ASPI_WO_X, 0 }, { "wo_y", ASPI_WO_Y, 0 }, { "wo_z", ASPI_WO_Z, 0 },
    { "theta_h", ASPI_THETA_H, 0 },   { "theta_h_deg", ASPI_THETA_H, 1 },
    { "phi_h", ASPI_PHI_H, 0 },       { "phi_h_deg", ASPI_PHI_H, 1 },
    { "theta_d", ASPI_THETA_D, 0 },   { "theta_d_deg", ASPI_THETA_D, 1 },
    { "phi_d", ASPI_PHI_D, 0 },       { "phi_d_deg", ASPI_PHI_D, 1 },
    { "theta_h_index", ASPI_INDEX_H, 0 }, { "theta_d_index", ASPI_INDEX_D, 0 },
    { "phi_d_index", ASPI_INDEX_P, 0 },
    { "f", ASPI_F, 0 }, { "brdf", ASPI_F, 0 }, { "fr", ASPI_F, 0 },
    { "r", ASPI_R, 0 }, { "g", ASPI_G, 0 }, { "b", ASPI_B, 0 },
    { NULL, ASPI_ROLES, 0 }
};

#define ACCEPTED "accepted: theta_i, phi_i, theta_o, phi_o (radians, or _deg); wi_x .. wo_z; " \
                 "theta_h, theta_d, phi_d; theta_h_index ..; and f or r, g, b"

const aspi_column *aspi_csv_columns(void) { return known_names; }

static const aspi_column *find_column(aspi_word word, const aspi_column *known)
{
    for (; known->name; known++)
        if (aspi_word_is(word, known->name))
            return known;
    return NULL;
}

int aspi_names_columns(aspi_line line, const aspi_column *known)
{
    aspi_word word[MOST_COLUMNS];
    size_t n = aspi_split(line, aspi_separator(line), word, MOST_COLUMNS);
    if (n < 2 || n > MOST_COLUMNS)
        return 0;
    for (size_t i = 0; i < n; i++)
        if (!find_column(word[i], known))
            return 0;
    return 1;
}

static void word_text(aspi_word word, char *text, size_t size)
{
    size_t n = word.length < size - 1 ? word.length : size - 1;
    memcpy(text, word.text, n);
    text[n] = 0;
}

/* ------------------------------------------------------------------ constants in comments */

static int is_name_character(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/* Finds `name = number` in a comment; rest is what follows the number. */
static int constant_in(aspi_line comment, const char *name, double *value, aspi_line *rest)
{
    size_t n = strlen(name);
    for (size_t i = 0; i + n < comment.length; i++) {
        if ((i && is_name_character(comment.text[i - 1]))
            || !aspi_word_is((aspi_word){ comment.text + i, n }, name))
            continue;
        aspi_line after = aspi_trimmed((aspi_line){ comment.text + i + n, comment.length - i - n,
                                                    comment.number });
        if (!after.length || after.text[0] != '=')
            continue;
        after = aspi_trimmed((aspi_line){ after.text + 1, after.length - 1, comment.number });
        size_t digits = 0;
        while (digits < after.length && strchr("+-.0123456789eE", after.text[digits])
               && after.text[digits])
            digits++;
        if (!aspi_parse_number(after.text, digits, value))
            continue;
        *rest = aspi_trimmed((aspi_line){ after.text + digits, after.length - digits,
                                          comment.number });
        return 1;
    }
    return 0;
}

/* `name = ...` says something of the rows, not of the material. */
static int is_setting(aspi_line comment)
{
    size_t i = 0;
    while (i < comment.length && is_name_character(comment.text[i]))
        i++;
    aspi_line rest = aspi_trimmed((aspi_line){ comment.text + i, comment.length - i, 0 });
    return i && rest.length && rest.text[0] == '=';
}

static void note_constants(aspi_line comment, aspi_header *header)
{
    double value;
    aspi_line rest;
    for (const aspi_column *c = known_names; c->name; c++)
        if (c->role < ASPI_WI_X || (c->role >= ASPI_THETA_H && c->role <= ASPI_PHI_D))
            if (constant_in(comment, c->name, &value, &rest)) {
                int degrees = c->degrees || (rest.length >= 3 && memcmp(rest.text, "deg", 3) == 0);
                header->constant[c->role] = 1;
                header->value[c->role] = degrees ? value * (ASPI_PI / 180) : value;
            }
    if (constant_in(comment, "isotropic", &value, &rest))
        header->isotropic = value != 0;
    else if (!header->description.length && !is_setting(comment))
        header->description = comment;
}

/* ------------------------------------------------------------------ headers */

static asp_status fail_header(const aspi_bytes *file, long long line, const char *name,
                              const char *reason, asp_error *err)
{
    return aspi_fail_line(err, ASP_EPARSE, file->name, line, name, reason);
}

static asp_status understand(const aspi_bytes *file, aspi_line line, const aspi_column *known,
                             aspi_header *header, asp_error *err)
{
    aspi_word word[MOST_COLUMNS];
    char name[64];
    header->separator = aspi_separator(line);
    header->line = line.number;
    size_t n = aspi_split(line, header->separator, word, MOST_COLUMNS);
    if (n > MOST_COLUMNS)
        return fail_header(file, line.number, "", "more than 64 columns", err);
    header->columns = (int)n;
    for (size_t i = 0; i < n; i++) {
        const aspi_column *column = find_column(word[i], known);
        word_text(word[i], name, sizeof name);
        if (!column)
            return fail_header(file, line.number, name, "not a column known here; " ACCEPTED, err);
        if (header->at[column->role] >= 0)
            return fail_header(file, line.number, name, "this quantity has a column already", err);
        header->at[column->role] = (int)i;
        header->unit[column->role] = column->degrees ? ASPI_PI / 180 : 1;
        header->name[column->role] = column->name;
    }
    return ASP_OK;
}

static int has(const aspi_header *h, aspi_role role) { return h->at[role] >= 0; }
static int given(const aspi_header *h, aspi_role role) { return has(h, role) || h->constant[role]; }

/* Exactly one way of giving directions, and one way of giving values. */
static asp_status check_complete(const aspi_bytes *file, const aspi_header *h, asp_error *err)
{
    int angles = has(h, ASPI_THETA_I) || has(h, ASPI_THETA_O) || has(h, ASPI_PHI_I)
              || has(h, ASPI_PHI_O);
    int vectors = 0;
    for (aspi_role role = ASPI_WI_X; role <= ASPI_WO_Z; role++)
        vectors |= has(h, role);
    int halves = has(h, ASPI_THETA_H) || has(h, ASPI_THETA_D) || has(h, ASPI_PHI_D)
              || has(h, ASPI_PHI_H);
    int bins = has(h, ASPI_INDEX_H) || has(h, ASPI_INDEX_D) || has(h, ASPI_INDEX_P);
    int rgb = has(h, ASPI_R) || has(h, ASPI_G) || has(h, ASPI_B);

    if (angles + vectors + halves + bins > 1)
        return fail_header(file, h->line, "", "directions are given in two ways; use one of "
            "theta_i.., wi_x.., theta_h.., theta_h_index..", err);
    if (!angles && !vectors && !halves && !bins)
        return fail_header(file, h->line, "", "no column gives directions; " ACCEPTED, err);
    if (rgb && has(h, ASPI_F))
        return fail_header(file, h->line, "f", "values are given in two ways: f and r, g, b", err);
    if (!rgb && !has(h, ASPI_F))
        return fail_header(file, h->line, "", "no column gives values: f or r, g, b", err);

    static const struct { aspi_role role; const char *name; } wanted[] = {
        { ASPI_THETA_I, "theta_i" }, { ASPI_THETA_O, "theta_o" }, { ASPI_PHI_O, "phi_o" },
        { ASPI_WI_X, "wi_x" }, { ASPI_WI_Y, "wi_y" }, { ASPI_WI_Z, "wi_z" },
        { ASPI_WO_X, "wo_x" }, { ASPI_WO_Y, "wo_y" }, { ASPI_WO_Z, "wo_z" },
        { ASPI_THETA_H, "theta_h" }, { ASPI_THETA_D, "theta_d" }, { ASPI_PHI_D, "phi_d" },
        { ASPI_INDEX_H, "theta_h_index" }, { ASPI_INDEX_D, "theta_d_index" },
        { ASPI_R, "r" }, { ASPI_G, "g" }, { ASPI_B, "b" },
    };
    for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++) {
        aspi_role role = wanted[i].role;
        int needed = role <= ASPI_PHI_O ? angles : role <= ASPI_WO_Z ? vectors
                   : role <= ASPI_PHI_D ? halves : role <= ASPI_INDEX_P ? bins : rgb;
        if (needed && !given(h, role))
            return fail_header(file, h->line, wanted[i].name, role == ASPI_PHI_O
                || role == ASPI_PHI_D ? "this column is missing; a comment may give it for all "
                "rows, as in '# phi_d = 90 deg'" : "this column is missing", err);
    }
    if (bins && !has(h, ASPI_INDEX_P) && !h->constant[ASPI_PHI_D])
        return fail_header(file, h->line, "phi_d_index", "this column is missing; a comment may "
            "give it for all rows, as in '# phi_d = 90 deg'", err);
    return ASP_OK;
}

static int starts_with_number(aspi_line line)
{
    aspi_word word;
    double value;
    return aspi_split(line, aspi_separator(line), &word, 1) && aspi_word_number(word, &value);
}

asp_status aspi_read_header(const aspi_bytes *file, const aspi_column *known, aspi_lines *lines,
                            aspi_header *header, asp_error *err)
{
    aspi_line line = { "", 0, 0 }, comment, last_comment = { "", 0, 0 };
    memset(header, 0, sizeof *header);
    header->isotropic = -1;
    for (int i = 0; i < ASPI_ROLES; i++)
        header->at[i] = -1;
    *lines = aspi_lines_of(file);
    aspi_lines before = *lines;
    int found = 0;
    while (!found && aspi_next_line(lines, &line)) {
        line = aspi_trimmed(line);
        if (aspi_is_comment(line, &comment)) {
            note_constants(comment, header);
            if (comment.length)
                last_comment = comment;
        } else if (line.length) {
            found = 1;
        }
        if (!found)
            before = *lines;
    }
    if (!found)
        return fail_header(file, line.number, "", "no rows; the first line must name the columns; "
                           ACCEPTED, err);
    asp_status status;
    if (!starts_with_number(line)) {
        status = understand(file, line, known, header, err);
    } else if (last_comment.length && aspi_names_columns(last_comment, known)) {
        status = understand(file, last_comment, known, header, err);
        header->separator = aspi_separator(line);
        *lines = before;                               /* that line is a row already */
    } else {
        return fail_header(file, line.number, "", "the columns have no names before this row; "
                           ACCEPTED, err);
    }
    return status == ASP_OK ? check_complete(file, header, err) : status;
}
