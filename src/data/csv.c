/* csv.c - measured geometries as rows of text
 *
 * The columns say what they hold. Directions in one of four ways:
 *     theta_i, phi_i, theta_o, phi_o            zenith and azimuth; theta may be negative (the other
 *                                               side), phi_i may be absent (0)
 *     wi_x, wi_y, wi_z, wo_x, wo_y, wo_z        unit vectors
 *     theta_h, theta_d, phi_d, phi_h            half and difference angles; phi_h may be absent (0)
 *     theta_h_index, theta_d_index, phi_d_index bins of a MERL table
 * in radians, or in degrees with the suffix _deg; and f (brdf, fr) or r, g, b in 1/sr. Words are
 * separated by commas, semicolons or blanks. Lines that start with # are comments; a comment may
 * give a quantity that is the same in all rows, `# phi_d = 90 deg`, and `# isotropic = 1`.
 *
 * Rows with a negative value have none and are left out, and so are directions at the horizon; the
 * description says how many.
 * Rows by bin that number at least a quarter of a MERL table make a table; fewer make a list of the
 * bins' centres. */
#include "columns.h"

#include <stdlib.h>
#include <string.h>

typedef struct row { double value[ASPI_ROLES]; aspi_word word[64]; long long line; } row;

/* The allowed range of each kind of column, in radians. */
static void range_of(aspi_role role, double *low, double *high)
{
    const double right = ASPI_PI / 2;
    *low = -1e26;
    *high = 1e26;
    switch (role) {
    case ASPI_THETA_I: case ASPI_THETA_O: *low = -right; *high = right; break;
    case ASPI_THETA_H: case ASPI_THETA_D: *low = 0; *high = right; break;
    case ASPI_PHI_I: case ASPI_PHI_O: case ASPI_PHI_H: case ASPI_PHI_D:
        *low = -4 * ASPI_PI;
        *high = 4 * ASPI_PI;
        break;
    case ASPI_INDEX_H: *low = 0; *high = ASPI_MERL_H - 1; break;
    case ASPI_INDEX_D: *low = 0; *high = ASPI_MERL_D - 1; break;
    case ASPI_INDEX_P: *low = 0; *high = ASPI_MERL_P - 1; break;
    case ASPI_WI_X: case ASPI_WI_Y: case ASPI_WI_Z:
    case ASPI_WO_X: case ASPI_WO_Y: case ASPI_WO_Z: *low = -1; *high = 1; break;
    default: break;
    }
}

static asp_status fail_range(const aspi_bytes *file, const row *r, const aspi_header *h,
                             aspi_role role, double low, double high, asp_error *err)
{
    double unit = h->unit[role];
    asp_fail_range(err, h->name[role], r->value[role] / unit, low / unit, 0, high / unit);
    aspi_error_file(err, file->name);
    if (err) {
        err->status = ASP_EPARSE;
        err->line = r->line;
        if (role <= ASPI_PHI_D && unit == 1 && (role < ASPI_WI_X || role > ASPI_WO_Z))
            snprintf(err->reason, sizeof err->reason,
                     "in radians; for degrees name the column %s_deg", h->name[role]);
    }
    return ASP_EPARSE;
}

static asp_status parse_row(const aspi_bytes *file, aspi_line line, const aspi_header *h, row *r,
                            asp_error *err)
{
    r->line = line.number;
    size_t n = aspi_split(line, h->separator, r->word, 64);
    if (n != (size_t)h->columns) {
        char reason[96];
        snprintf(reason, sizeof reason, "%zu columns here, %d in the header", n, h->columns);
        return aspi_fail_line(err, ASP_EPARSE, file->name, line.number, "", reason);
    }
    for (int i = 0; i < ASPI_ROLES; i++) {
        double low, high;
        if (h->at[i] < 0) {
            r->value[i] = h->constant[i] ? h->value[i] : 0;
            continue;
        }
        aspi_word word = r->word[h->at[i]];
        if (!aspi_word_number(word, &r->value[i])) {
            char reason[128];
            int length = word.length < 60 ? (int)word.length : 60;
            snprintf(reason, sizeof reason, "'%.*s' is not a finite decimal number", length,
                     word.text);
            return aspi_fail_line(err, ASP_EPARSE, file->name, line.number, h->name[i], reason);
        }
        r->value[i] *= h->unit[i];
        range_of((aspi_role)i, &low, &high);
        int whole = i >= ASPI_INDEX_H && i <= ASPI_INDEX_P;
        if (whole && r->value[i] != floor(r->value[i]))
            return aspi_fail_line(err, ASP_EPARSE, file->name, line.number, h->name[i],
                                  "a bin number must be whole");
        double slack = whole ? 0 : 1e-6 * high;         /* 90 deg may be written 1.570797 */
        if (r->value[i] < low - slack || r->value[i] > high + slack)
            return fail_range(file, r, h, (aspi_role)i, low, high, err);
    }
    return ASP_OK;
}

/* ------------------------------------------------------------------ directions of a row */

static asp_vec3 from_angles(double theta, double phi)
{
    double s = sin(theta);
    return (asp_vec3){ s * cos(phi), s * sin(phi), cos(theta) };
}

/* A vector of a file is a direction if its length is 1 to a thousandth; it is then made 1, and left
 * alone where rounding could only move it. */
static int unit_vector(asp_vec3 *v)
{
    double square = v->x * v->x + v->y * v->y + v->z * v->z;
    if (!(fabs(square - 1) < 2e-3))
        return 0;
    if (fabs(square - 1) > 1e-14) {
        double length = sqrt(square);
        *v = (asp_vec3){ v->x / length, v->y / length, v->z / length };
    }
    return 1;
}

static asp_status directions(const aspi_bytes *file, const aspi_header *h, const row *r,
                             const aspi_merl *bins, asp_vec3 *wi, asp_vec3 *wo, asp_error *err)
{
    const double *v = r->value;
    if (h->at[ASPI_WI_X] >= 0) {
        *wi = (asp_vec3){ v[ASPI_WI_X], v[ASPI_WI_Y], v[ASPI_WI_Z] };
        *wo = (asp_vec3){ v[ASPI_WO_X], v[ASPI_WO_Y], v[ASPI_WO_Z] };
        int first = unit_vector(wi), second = unit_vector(wo);
        if (!first || !second)
            return aspi_fail_line(err, ASP_EPARSE, file->name, r->line, first ? "wo_x" : "wi_x",
                                  "the vector's length is not 1");
    } else if (h->at[ASPI_INDEX_H] >= 0) {
        if (h->at[ASPI_INDEX_P] >= 0) {
            aspi_merl_centre(bins, (size_t)v[ASPI_INDEX_H], (size_t)v[ASPI_INDEX_D],
                             (size_t)v[ASPI_INDEX_P], wi, wo);
        } else {
            double u = (v[ASPI_INDEX_H] + 0.5) / ASPI_MERL_H;
            aspi_half a = { u * u * (ASPI_PI / 2), 0,
                            (v[ASPI_INDEX_D] + 0.5) / ASPI_MERL_D * (ASPI_PI / 2), v[ASPI_PHI_D] };
            aspi_half_to(a, wi, wo);
        }
    } else if (h->at[ASPI_THETA_H] >= 0 || h->at[ASPI_THETA_D] >= 0 || h->at[ASPI_PHI_D] >= 0) {
        aspi_half a = { v[ASPI_THETA_H], v[ASPI_PHI_H], v[ASPI_THETA_D], v[ASPI_PHI_D] };
        aspi_half_to(a, wi, wo);
    } else {
        *wi = from_angles(v[ASPI_THETA_I], v[ASPI_PHI_I]);
        *wo = from_angles(v[ASPI_THETA_O], v[ASPI_PHI_O]);
    }
    return ASP_OK;
}

/* Isotropic as far as the file tells: it gives no azimuth of its own, or wi always has the same. */
static int same_azimuth(const aspi_list *list)
{
    double x = 0, y = 0;
    for (size_t i = 0; i < list->count; i++) {
        asp_vec3 wi = list->item[i].wi;
        double across = sqrt(wi.x * wi.x + wi.y * wi.y);
        if (across < 1e-9)
            continue;
        if (x == 0 && y == 0) {
            x = wi.x / across;
            y = wi.y / across;
        }
        if (x * wi.x + y * wi.y < across * (1 - 1e-12))
            return 0;
    }
    return 1;
}

/* Rows that were read and left out. */
typedef struct left_out { size_t negative, horizon; long long first_negative; } left_out;

/* A list without a row: where that is because of negative values, it says so. */
static asp_measured *fail_negative(const aspi_bytes *file, aspi_list *list, const left_out *out,
                                   asp_error *err)
{
    char reason[160];
    int n = snprintf(reason, sizeof reason, "no row has a value: negative ones mark missing values, "
                     "here");
    if (out->negative > 1)
        snprintf(reason + n, sizeof reason - (size_t)n, " and in %zu more", out->negative - 1);
    aspi_list_clear(list);
    aspi_fail_line(err, ASP_EFORMAT, file->name, out->first_negative, "", reason);
    return NULL;
}

static void remark_of(const left_out *out, char *text, size_t size)
{
    size_t rows = out->negative + out->horizon;
    text[0] = 0;
    if (rows)
        snprintf(text, size, "%zu row%s left out: %s", rows, rows == 1 ? "" : "s",
                 !out->horizon ? "a negative value" : !out->negative ? "a direction at the horizon"
                 : "a negative value or a direction at the horizon");
}

static asp_measured *read_list(const aspi_bytes *file, aspi_lines lines, const aspi_header *h,
                               const char *format, asp_error *err)
{
    aspi_list list = { 0 };
    aspi_merl bins = { ASPI_MERL_H, ASPI_MERL_D, ASPI_MERL_P, NULL };
    aspi_line line;
    left_out out = { 0, 0, 0 };
    char remark[160];
    row r;
    int grey = h->at[ASPI_F] >= 0;
    while (aspi_next_line(&lines, &line)) {
        asp_vec3 wi, wo;
        line = aspi_trimmed(line);
        if (!line.length || aspi_is_comment(line, NULL))
            continue;
        if (parse_row(file, line, h, &r, err) != ASP_OK
            || directions(file, h, &r, &bins, &wi, &wo, err) != ASP_OK) {
            aspi_list_clear(&list);
            return NULL;
        }
        const double *v = r.value;
        asp_rgb f = grey ? (asp_rgb){ v[ASPI_F], v[ASPI_F], v[ASPI_F] }
                         : (asp_rgb){ v[ASPI_R], v[ASPI_G], v[ASPI_B] };
        if (f.r < 0 || f.g < 0 || f.b < 0) {       /* one channel missing: the colour is unknown */
            if (!out.negative++)
                out.first_negative = r.line;
            continue;
        }
        if (wi.z < 1e-6 || wo.z < 1e-6) {
            out.horizon++;
            continue;
        }
        if (!aspi_list_add(&list, wi, wo, f)) {
            aspi_list_clear(&list);
            aspi_fail_line(err, ASP_ENOMEM, file->name, line.number, "", "out of memory");
            return NULL;
        }
    }
    if (!list.count && out.negative && !out.horizon)
        return fail_negative(file, &list, &out, err);
    int halves = h->at[ASPI_INDEX_H] >= 0 || (h->at[ASPI_THETA_H] >= 0 && h->at[ASPI_PHI_H] < 0);
    asp_measured_info info = { .format = format, .channels = grey ? 1 : 3 };
    info.isotropic = h->isotropic >= 0 ? h->isotropic : halves || same_azimuth(&list);
    remark_of(&out, remark, sizeof remark);
    return aspi_measured_remark(aspi_list_wrap(&list, info, h->description.text,
                                               h->description.length, file->name, err),
                                remark, err);
}

/* ------------------------------------------------------------------ rows by bin */

/* The stored numbers of a row: f over the scale, rounded to double only after the division (merl.c
 * says why). */
static void store_bin(const aspi_header *h, const row *r, aspi_merl *merl, size_t at, size_t bins)
{
    for (int c = 0; c < 3; c++) {
        aspi_role role = h->at[ASPI_F] >= 0 ? ASPI_F : (aspi_role)(ASPI_R + c);
        aspi_word word = r->word[h->at[role]];
        long double f = (long double)r->value[role];
        aspi_parse_long_double(word.text, word.length, &f);
        merl->values[(size_t)c * bins + at] = (double)(f / (long double)aspi_merl_scale[c]);
    }
}

static asp_measured *read_table(const aspi_bytes *file, aspi_lines lines, const aspi_header *h,
                                const char *format, asp_error *err)
{
    const size_t bins = (size_t)ASPI_MERL_H * ASPI_MERL_D * ASPI_MERL_P;
    aspi_merl *merl = aspi_merl_new(ASPI_MERL_H, ASPI_MERL_D, ASPI_MERL_P);
    unsigned char *seen = calloc(bins, 1);
    asp_status status = merl && seen ? ASP_OK
        : aspi_fail_at(err, ASP_ENOMEM, file->name, -1, "", "not enough memory for the table");
    aspi_line line;
    row r;
    while (status == ASP_OK && aspi_next_line(&lines, &line)) {
        line = aspi_trimmed(line);
        if (!line.length || aspi_is_comment(line, NULL))
            continue;
        status = parse_row(file, line, h, &r, err);
        if (status != ASP_OK)
            break;
        size_t at = ((size_t)r.value[ASPI_INDEX_H] * ASPI_MERL_D + (size_t)r.value[ASPI_INDEX_D])
                  * ASPI_MERL_P + (size_t)r.value[ASPI_INDEX_P];
        if (seen[at])
            status = aspi_fail_line(err, ASP_EPARSE, file->name, line.number, "theta_h_index",
                                    "this bin has a row already");
        seen[at] = 1;
        store_bin(h, &r, merl, at, bins);
    }
    free(seen);
    if (status != ASP_OK) {
        if (merl)
            aspi_kind_merl.release(merl);
        return NULL;
    }
    return aspi_merl_wrap(merl, h->at[ASPI_F] >= 0 ? 1 : 3, h->description.text,
                          h->description.length, format, err);
}

asp_measured *aspi_read_rows(const aspi_bytes *file, aspi_lines lines, const aspi_header *h,
                             const char *format, asp_error *err)
{
    if (h->at[ASPI_INDEX_P] >= 0) {
        /* a table takes 35 MB: only a file with rows to fill it may ask for it */
        const size_t bins = (size_t)ASPI_MERL_H * ASPI_MERL_D * ASPI_MERL_P;
        aspi_lines count = lines;
        aspi_line line;
        size_t rows = 0;
        while (aspi_next_line(&count, &line))
            rows += line.length >= 7;
        if (rows >= bins / 4)
            return read_table(file, lines, h, format, err);
    }
    return read_list(file, lines, h, format, err);
}

/* ------------------------------------------------------------------ the formats csv and lumos */

static asp_measured *read_columns(const aspi_bytes *file, const aspi_column *known,
                                  const char *format, asp_error *err)
{
    aspi_header header;
    aspi_lines lines;
    if (aspi_read_header(file, known, &lines, &header, err) != ASP_OK)
        return NULL;
    return aspi_read_rows(file, lines, &header, format, err);
}

static asp_measured *csv_read(const aspi_bytes *file, asp_error *err)
{
    return read_columns(file, aspi_csv_columns(), "csv", err);
}

const aspi_format aspi_format_csv = { "csv", "text with named columns", aspi_is_text, csv_read };

/* Tables of lumos-sat and of the Starlink measurements by Scatterworks: five columns in degrees
 * named in a comment, phi the zenith (negative on the other side) and theta the azimuth. Only these
 * exact names in this exact order are read so; everywhere else theta is the zenith. */
static const aspi_column lumos_names[] = {
    { "phi_in", ASPI_THETA_I, 1 },  { "phi_i", ASPI_THETA_I, 1 },
    { "theta_in", ASPI_PHI_I, 1 },  { "theta_i", ASPI_PHI_I, 1 },
    { "phi_out", ASPI_THETA_O, 1 }, { "phi_o", ASPI_THETA_O, 1 },
    { "theta_out", ASPI_PHI_O, 1 }, { "theta_o", ASPI_PHI_O, 1 },
    { "brdf", ASPI_F, 0 },          { NULL, ASPI_ROLES, 0 }
};

static int is_lumos_header(aspi_line line)
{
    static const char *const names[2][5] = {
        { "phi_in", "theta_in", "phi_out", "theta_out", "brdf" },
        { "phi_i", "theta_i", "phi_o", "theta_o", "brdf" },
    };
    aspi_word word[5];
    if (aspi_separator(line) != ' ' || aspi_split(line, ' ', word, 5) != 5)
        return 0;
    for (int set = 0; set < 2; set++) {
        int same = 1;
        for (int i = 0; i < 5; i++)
            same &= aspi_word_is(word[i], names[set][i]);
        if (same)
            return 1;
    }
    return 0;
}

static int lumos_probe(const aspi_bytes *file)
{
    aspi_lines lines = aspi_lines_of(file);
    aspi_line line, comment, last = { "", 0, 0 };
    if (!aspi_is_text(file))
        return 0;
    while (aspi_next_line(&lines, &line)) {
        line = aspi_trimmed(line);
        if (aspi_is_comment(line, &comment)) {
            if (comment.length)
                last = comment;
        } else if (line.length) {
            break;
        }
    }
    return is_lumos_header(last);
}

static asp_measured *lumos_read(const aspi_bytes *file, asp_error *err)
{
    return read_columns(file, lumos_names, "lumos", err);
}

const aspi_format aspi_format_lumos = {
    "lumos", "# phi_in theta_in phi_out theta_out brdf (degrees)", lumos_probe, lumos_read
};
