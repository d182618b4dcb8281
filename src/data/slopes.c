/* slopes.c - measured slopes from text, counted into cells */
#include "slopes.h"

#include <stdlib.h>
#include <string.h>

/* ------------------------------------------------------------------ text */

enum { X, Y, DENSITY, WEIGHT, COLUMNS };
#define MOST_WORDS 64

static const struct { const char *name; int column; } names[] = {
    { "p_x", X }, { "slope_x", X }, { "p_y", Y }, { "slope_y", Y }, { "density", DENSITY },
    { "p22", DENSITY }, { "weight", WEIGHT }, { "count", WEIGHT }
};

typedef struct header { int at[COLUMNS]; size_t words; char separator; } header;

static asp_status read_header(const aspi_bytes *file, aspi_line line, header *h, asp_error *err)
{
    aspi_word word[MOST_WORDS];
    h->separator = aspi_separator(line);
    h->words = aspi_split(line, h->separator, word, MOST_WORDS);
    for (int i = 0; i < COLUMNS; i++)
        h->at[i] = -1;
    for (size_t i = 0; i < h->words && i < MOST_WORDS; i++)
        for (size_t k = 0; k < sizeof names / sizeof *names; k++)
            if (aspi_word_is(word[i], names[k].name)) {
                if (h->at[names[k].column] >= 0)
                    return aspi_fail_line(err, ASP_EPARSE, file->name, line.number, names[k].name,
                                          "this quantity has a column already");
                h->at[names[k].column] = (int)i;
            }
    if (h->words > MOST_WORDS)
        return aspi_fail_line(err, ASP_EPARSE, file->name, line.number, "", "more than 64 columns");
    if (h->at[X] < 0 || h->at[Y] < 0)
        return aspi_fail_line(err, ASP_EPARSE, file->name, line.number, h->at[X] < 0 ? "p_x" : "p_y",
                              "no such column in the header; wanted: p_x, p_y and density or weight");
    if (h->at[DENSITY] >= 0 && h->at[WEIGHT] >= 0)
        return aspi_fail_line(err, ASP_EPARSE, file->name, line.number, "weight",
                              "give density or weight, not both");
    return ASP_OK;
}

static asp_status read_value(const aspi_bytes *file, long long line, const aspi_word *word, size_t count,
                             int at, const char *name, double low, double high, double *out,
                             asp_error *err)
{
    if (at < 0) {
        *out = 1;
        return ASP_OK;
    }
    if ((size_t)at >= count || !aspi_word_number(word[at], out))
        return aspi_fail_line(err, ASP_EPARSE, file->name, line, name,
                              (size_t)at >= count ? "missing in this row" : "not a number");
    if (*out >= low && *out <= high)
        return ASP_OK;
    asp_fail_range(err, name, *out, low, 0, high);
    aspi_error_file(err, file->name);
    if (err)
        err->line = line;
    return ASP_EINVAL;
}

static size_t count_lines(const aspi_bytes *file)
{
    size_t count = 1;
    for (size_t i = 0; i < file->size; i++)
        count += file->bytes[i] == '\n' || file->bytes[i] == '\r';
    return count;
}

static asp_status read_row(const aspi_bytes *file, aspi_line line, const header *h, aspi_slopes *to,
                           asp_error *err)
{
    aspi_word word[MOST_WORDS];
    size_t n = aspi_split(line, h->separator, word, MOST_WORDS), i = to->count;
    int values = h->at[DENSITY] >= 0 ? h->at[DENSITY] : h->at[WEIGHT];
    const char *name = h->at[DENSITY] >= 0 ? "density" : "weight";
    n = n < MOST_WORDS ? n : MOST_WORDS;
    asp_status s = read_value(file, line.number, word, n, h->at[X], "p_x", -1e3, 1e3, &to->x[i], err);
    if (s == ASP_OK)
        s = read_value(file, line.number, word, n, h->at[Y], "p_y", -1e3, 1e3, &to->y[i], err);
    if (s == ASP_OK)
        s = read_value(file, line.number, word, n, values, name, 0, 1e100, &to->value[i], err);
    to->line[i] = line.number;
    to->count += s == ASP_OK;
    return s;
}

static asp_status make_room(const aspi_bytes *file, aspi_slopes *out, asp_error *err)
{
    size_t rows = count_lines(file);
    if (rows > ASPI_SLOPES_MOST)
        return aspi_fail_at(err, ASP_EFORMAT, file->name, -1, "rows", "more than 4194304 lines");
    memset(out, 0, sizeof *out);
    out->x = malloc(rows * (3 * sizeof *out->x + sizeof *out->line));
    if (!out->x)
        return aspi_fail_at(err, ASP_ENOMEM, file->name, -1, "", "out of memory");
    out->y = out->x + rows;
    out->value = out->y + rows;
    out->line = (long long *)(void *)(out->value + rows);
    return ASP_OK;
}

void aspi_slopes_free(aspi_slopes *slopes)
{
    free(slopes->x);
    memset(slopes, 0, sizeof *slopes);
}

asp_status aspi_slopes_read(const aspi_bytes *file, aspi_slopes *out, asp_error *err)
{
    aspi_lines lines = aspi_lines_of(file);
    aspi_line line;
    aspi_slopes made;
    header h = { { -1, -1, -1, -1 }, 0, ' ' };
    int headed = 0;
    if (!aspi_is_text(file))
        return aspi_fail_at(err, ASP_EFORMAT, file->name, 0, "", "not text: slopes are rows of p_x, p_y and "
                            "density or weight under a header, or a height field .f32");
    asp_status s = make_room(file, &made, err);
    while (s == ASP_OK && aspi_next_line(&lines, &line)) {
        line = aspi_trimmed(line);
        if (!line.length || aspi_is_comment(line, NULL))
            continue;
        s = headed ? read_row(file, line, &h, &made, err) : read_header(file, line, &h, err);
        headed = 1;
    }
    if (s == ASP_OK && !made.count)
        s = aspi_fail_at(err, ASP_EFORMAT, file->name, -1, "", "no row of slopes");
    if (s != ASP_OK) {
        aspi_slopes_free(&made);
        return s;
    }
    made.grid = h.at[DENSITY] >= 0;
    *out = made;
    return ASP_OK;
}

/* ------------------------------------------------------------------ a grid of densities */

static int ascending(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The centres of an even axis among `count` values: first, step, how many; 0 if they are not even. */
static size_t even_axis(const double *values, size_t count, double *work, double *first, double *step)
{
    memcpy(work, values, count * sizeof *work);
    qsort(work, count, sizeof *work, ascending);
    double range = work[count - 1] - work[0];
    size_t n = 1;
    for (size_t i = 1; i < count; i++)
        n += work[i] - work[i - 1] > 1e-6 * range;
    *first = work[0];
    *step = n > 1 ? range / (double)(n - 1) : 0;
    for (size_t i = 0; i < count && n > 1; i++) {
        double at = (values[i] - *first) / *step;
        if (fabs(at - floor(at + 0.5)) > 1e-3)
            return 0;
    }
    return n;
}

static asp_status grid_histogram(const aspi_slopes *s, const char *name, const asp_map *map, void **memory,
                                 asp_ndf *out, asp_error *err)
{
    double *work = malloc(s->count * sizeof *work), x0, y0, dx, dy;
    if (!work)
        return aspi_fail_at(err, ASP_ENOMEM, name, -1, "", "out of memory");
    size_t nx = even_axis(s->x, s->count, work, &x0, &dx), ny = even_axis(s->y, s->count, work, &y0, &dy);
    free(work);
    if (nx < 2 || ny < 2)
        return aspi_fail_at(err, ASP_EFORMAT, name, -1, nx < 2 ? "p_x" : "p_y",
                            "a density needs evenly spaced slopes, two or more on each axis; slopes one by "
                            "one go with weight");
    if (nx > 1024 || ny > 1024)
        return aspi_fail_at(err, ASP_EFORMAT, name, -1, nx > 1024 ? "p_x" : "p_y", "more than 1024 cells");
    double *values = malloc(nx * ny * sizeof *values);
    asp_status status = values ? ASP_OK : aspi_fail_at(err, ASP_ENOMEM, name, -1, "", "out of memory");
    for (size_t i = 0; values && i < nx * ny; i++)
        values[i] = -1;
    for (size_t i = 0; status == ASP_OK && i < s->count; i++) {
        size_t ix = (size_t)((s->x[i] - x0) / dx + 0.5), iy = (size_t)((s->y[i] - y0) / dy + 0.5);
        if (values[iy * nx + ix] >= 0)
            status = aspi_fail_line(err, ASP_EFORMAT, name, s->line[i], "density",
                                    "this cell has a value already");
        values[iy * nx + ix] = s->value[i];
    }
    if (status == ASP_OK && s->count != nx * ny)
        status = aspi_fail_at(err, ASP_EFORMAT, name, -1, "density",
                              "some cells of the grid have no row: a density needs them all, 0 where nothing is");
    if (status == ASP_OK && !(*memory = malloc(asp_histogram_bytes(nx, ny))))
        status = aspi_fail_at(err, ASP_ENOMEM, name, -1, "", "out of memory");
    if (status == ASP_OK) {
        asp_slope_range range = { x0 - 0.5 * dx, x0 + dx * ((double)nx - 0.5), y0 - 0.5 * dy,
                                  y0 + dy * ((double)ny - 0.5) };
        status = asp_histogram_make(*memory, nx, ny, range, values, map, out, err);
        if (status != ASP_OK) {
            aspi_error_file(err, name);
            free(*memory);
            *memory = NULL;
        }
    }
    free(values);
    return status;
}

/* ------------------------------------------------------------------ counting */

typedef struct extent { size_t n; double w, x, y, xx, yy; asp_slope_range range; } extent;

static void add_extent(void *context, double x, double y, double weight)
{
    extent *e = context;
    if (!(weight > 0))
        return;
    asp_slope_range *r = &e->range;
    r->low_x = e->n && r->low_x < x ? r->low_x : x;
    r->high_x = e->n && r->high_x > x ? r->high_x : x;
    r->low_y = e->n && r->low_y < y ? r->low_y : y;
    r->high_y = e->n && r->high_y > y ? r->high_y : y;
    e->n++;
    e->w += weight;
    e->x += weight * x;
    e->y += weight * y;
    e->xx += weight * x * x;
    e->yy += weight * y * y;
}

/* From the least slope to the largest, but not beyond 4 standard deviations: one outlier must not make
 * all cells large. A little wider, so that both ends lie inside; never without width. */
static void own_range(double low, double high, double mean, double square, double *from, double *to)
{
    double spread = 4 * sqrt(fmax(0, square - mean * mean)), margin;
    low = fmax(low, mean - spread);
    high = fmin(high, mean + spread);
    margin = 1e-9 * (high - low) + 1e-3 * (high - low <= 1e-3);
    *from = low - margin;
    *to = high + margin;
}

typedef struct cells { const aspi_counting *how; asp_slope_range range; double *values; } cells;

static size_t cell_of(double at, double low, double high, size_t n)
{
    double cell = (at - low) / (high - low) * (double)n;
    return cell > 0 ? cell < (double)n ? (size_t)cell : n - 1 : 0;
}

static void add_cell(void *context, double x, double y, double weight)
{
    cells *c = context;
    const asp_slope_range *r = &c->range;
    c->values[cell_of(y, r->low_y, r->high_y, c->how->ny) * c->how->nx
              + cell_of(x, r->low_x, r->high_x, c->how->nx)] += weight;
}

asp_status aspi_slopes_count(aspi_slope_source *each, const void *source, const aspi_counting *how,
                             const asp_map *map, void **memory, asp_ndf *out, asp_error *err)
{
    extent e = { 0 };
    cells c = { how, how->range, NULL };
    size_t bytes = asp_histogram_bytes(how->nx, how->ny);
    if (!bytes)
        return asp_fail_range(err, "bins", (double)(how->nx < 1 || how->nx > 1024 ? how->nx : how->ny), 1, 0,
                              1024);
    each(source, add_extent, &e);
    if (!e.n)
        return asp_fail(err, ASP_EINVAL, "slopes", "there are none, or they weigh nothing");
    if (!how->ranged) {
        own_range(e.range.low_x, e.range.high_x, e.x / e.w, e.xx / e.w, &c.range.low_x, &c.range.high_x);
        own_range(e.range.low_y, e.range.high_y, e.y / e.w, e.yy / e.w, &c.range.low_y, &c.range.high_y);
    }
    c.values = calloc(how->nx * how->ny, sizeof *c.values);
    void *block = malloc(bytes);
    asp_status status = ASP_OK;
    if (!c.values || !block)
        status = asp_fail(err, ASP_ENOMEM, "histogram", "out of memory");
    else if (!(c.range.high_x > c.range.low_x && c.range.high_y > c.range.low_y))
        status = asp_fail(err, ASP_EINVAL, "range", "the upper slope must lie above the lower one");
    if (status == ASP_OK) {
        each(source, add_cell, &c);
        status = asp_histogram_make(block, how->nx, how->ny, c.range, c.values, map, out, err);
    }
    free(c.values);
    if (status != ASP_OK)
        free(block);
    else
        *memory = block;
    return status;
}

static void each_row(const void *source, aspi_slope_visitor *visit, void *context)
{
    const aspi_slopes *s = source;
    for (size_t i = 0; i < s->count; i++)
        visit(context, s->x[i], s->y[i], s->value[i]);
}

asp_status aspi_slopes_histogram(const aspi_slopes *slopes, const char *name, const aspi_counting *how,
                                 const asp_map *map, void **memory, asp_ndf *out, asp_error *err)
{
    if (slopes->grid && (how->nx || how->ranged))
        return aspi_fail_at(err, ASP_EINVAL, name, -1, how->nx ? "bins" : "range",
                            "a grid of densities has its own cells");
    if (slopes->grid)
        return grid_histogram(slopes, name, map, memory, out, err);
    aspi_counting own = *how;
    if (!own.nx)
        own.nx = own.ny = 64;
    asp_status status = aspi_slopes_count(each_row, slopes, &own, map, memory, out, err);
    if (status != ASP_OK)
        aspi_error_file(err, name);
    return status;
}
