/* read.c - height fields of instruments
 *
 * A format is a row: how the name ends, and what reads it. */
#include "data/text.h"
#include "surface/surface.h"

#include <stdlib.h>
#include <string.h>

typedef asp_status read_function(const char *path, asp_height_field *out, asp_error *err);

/* ---- f32: float32 heights, key=value lines beside them */

enum { MOST_POINTS = 32768 };

typedef struct meta { double nx, ny, dx, dy; int unit; } meta;

/* One key=value line; unknown keys are other people's business. */
static asp_status meta_line(const char *path, aspi_line line, meta *m, asp_error *err)
{
    static const char *const names[] = { "nx", "ny", "dx_um", "dy_um" };
    double *const values[] = { &m->nx, &m->ny, &m->dx, &m->dy };
    const char *equals = memchr(line.text, '=', line.length);
    if (!equals)
        return ASP_OK;
    aspi_line key = aspi_trimmed((aspi_line){ line.text, (size_t)(equals - line.text), 0 });
    aspi_line value = aspi_trimmed((aspi_line){ equals + 1,
                                                line.length - (size_t)(equals + 1 - line.text), 0 });
    aspi_word name = { key.text, key.length }, word = { value.text, value.length };
    if (aspi_word_is(name, "height_unit")) {
        m->unit = aspi_word_is(word, "um");
        if (!m->unit)
            return aspi_fail_line(err, ASP_EFORMAT, path, line.number, "height_unit", "is not um");
    }
    for (size_t i = 0; i < 4; ++i)
        if (aspi_word_is(name, names[i]) && !aspi_word_number(word, values[i]))
            return aspi_fail_line(err, ASP_EFORMAT, path, line.number, names[i], "not a number");
    return ASP_OK;
}

static asp_status meta_check(const char *path, const meta *m, asp_error *err)
{
    if (!(m->nx >= 2 && m->nx <= MOST_POINTS && m->nx == (int)m->nx))
        return aspi_fail_at(err, ASP_EFORMAT, path, -1, "nx", "not a whole number in 2..32768");
    if (!(m->ny >= 2 && m->ny <= MOST_POINTS && m->ny == (int)m->ny))
        return aspi_fail_at(err, ASP_EFORMAT, path, -1, "ny", "not a whole number in 2..32768");
    if (!(m->dx > 0) || !(m->dy > 0))
        return aspi_fail_at(err, ASP_EFORMAT, path, -1, m->dx > 0 ? "dy_um" : "dx_um",
                            "not a positive number");
    if (!m->unit)
        return aspi_fail_at(err, ASP_EFORMAT, path, -1, "height_unit", "missing");
    return ASP_OK;
}

static asp_status read_meta(const char *path, meta *m, asp_error *err)
{
    aspi_bytes file = { .name = path };
    unsigned char *bytes;
    asp_status status = aspi_read_file(path, &bytes, &file.size, err);
    if (status != ASP_OK)
        return status;
    file.bytes = bytes;
    aspi_lines lines = aspi_lines_of(&file);
    aspi_line line;
    while (status == ASP_OK && aspi_next_line(&lines, &line))
        status = meta_line(path, line, m, err);
    free(bytes);
    return status == ASP_OK ? meta_check(path, m, err) : status;
}

static float little_endian_float(const unsigned char *b)
{
    uint32_t bits = b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static asp_status read_heights(const char *path, const meta *m, asp_height_field *out,
                               asp_error *err)
{
    unsigned char *bytes;
    size_t size, count = (size_t)m->nx * (size_t)m->ny;
    asp_status status = aspi_read_file(path, &bytes, &size, err);
    if (status != ASP_OK)
        return status;
    float *heights = NULL;
    if (size != 4 * count)
        status = aspi_fail_at(err, ASP_EFORMAT, path, (long long)size, "heights",
                              "the file does not hold 4 nx ny bytes");
    else if (!(heights = malloc(count * sizeof *heights)))
        status = aspi_fail_at(err, ASP_ENOMEM, path, -1, "heights", "out of memory");
    else
        for (size_t i = 0; i < count; ++i)
            heights[i] = little_endian_float(bytes + 4 * i);
    free(bytes);
    if (status == ASP_OK)
        *out = (asp_height_field){ (int)m->nx, (int)m->ny, m->dx, m->dy, 0, heights };
    return status;
}

static asp_status read_f32(const char *path, asp_height_field *out, asp_error *err)
{
    static const char ending[] = ".meta.txt";
    size_t stem = strlen(path) - strlen(".f32");
    char *beside = malloc(stem + sizeof ending);
    if (!beside)
        return aspi_fail_at(err, ASP_ENOMEM, path, -1, "file", "out of memory");
    memcpy(beside, path, stem);
    memcpy(beside + stem, ending, sizeof ending);
    meta m = { 0 };
    asp_status status = read_meta(beside, &m, err);
    free(beside);
    return status == ASP_OK ? read_heights(path, &m, out, err) : status;
}

/* ---- the table */

static const struct { const char *ending; read_function *read; } formats[] = {
    { ".f32", read_f32 },
};

asp_status asp_height_field_read(const char *path, asp_height_field *out, asp_error *err)
{
    size_t length = strlen(path);
    for (size_t i = 0; i < sizeof formats / sizeof *formats; ++i) {
        size_t n = strlen(formats[i].ending);
        if (length >= n && !strcmp(path + length - n, formats[i].ending))
            return formats[i].read(path, out, err);
    }
    return aspi_fail_at(err, ASP_EUNKNOWN, path, -1, "name", "no height field ends like this: .f32");
}
