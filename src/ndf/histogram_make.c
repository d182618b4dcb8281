/* histogram_make.c - a slope histogram from its cells: masses, means, and the tables of rows */
#include "ndf/histogram.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"

extern const asp_model asp_model_histogram;

static int cells_side_ok(size_t n) { return n >= 1 && n <= ASPI_HISTOGRAM_SIDE; }

size_t asp_histogram_bytes(size_t nx, size_t ny)
{
    aspi_cells k;
    if (!cells_side_ok(nx) || !cells_side_ok(ny))
        return 0;
    k.nx = (int)nx;
    k.ny = (int)ny;
    return sizeof k + aspi_cells_numbers(&k) * sizeof(double);
}

/* A sum that keeps what it rounds away (Kahan 1965): the true sum is value - lost. */
typedef struct cells_sum { double value, lost; } cells_sum;

static void cells_add(cells_sum *s, double x)
{
    double y = x - s->lost, next = s->value + y;
    s->lost = (next - s->value) - y;
    s->value = next;
}

/* The rows and columns that hold anything, and the largest value. */
typedef struct cells_part { size_t x0, x1, y0, y1; double largest, sum; } cells_part;

static asp_status cells_used(size_t nx, size_t ny, const double *values, cells_part *out, asp_error *err)
{
    size_t i, j;
    cells_part p = { 0, 0, 0, 0, 0.0, 0.0 };
    cells_sum all = { 0.0, 0.0 };
    p.x0 = nx;
    p.y0 = ny;
    for (j = 0; j < ny; j++)
        for (i = 0; i < nx; i++) {
            double q = values[j * nx + i];
            if (!(q >= 0.0 && q <= 1e300)) {
                asp_fail_range(err, "values", q, 0.0, 0, 1e300);
                if (err)
                    err->position = (long long)(j * nx + i);
                return ASP_EINVAL;
            }
            if (q == 0.0)
                continue;
            p.largest = aspi_max(p.largest, q);
            p.x0 = i < p.x0 ? i : p.x0;
            p.x1 = i + 1 > p.x1 ? i + 1 : p.x1;
            p.y0 = j < p.y0 ? j : p.y0;
            p.y1 = j + 1;
        }
    if (!(p.largest > 0.0))
        return asp_fail(err, ASP_EINVAL, "values", "all cells are empty");
    for (j = p.y0; j < p.y1; j++)
        for (i = p.x0; i < p.x1; i++)
            cells_add(&all, values[j * nx + i] / p.largest);
    p.sum = all.value;
    *out = p;
    return ASP_OK;
}

/* One row of pairs (A, C); masses of the row's cells stand `step` apart, from `cell` on. */
static void cells_fill_row(double *row, const double *cell, ptrdiff_t step, int cols, double area)
{
    cells_sum before = { 0.0, 0.0 }, moment = { 0.0, 0.0 };
    int i;
    row[0] = row[1] = 0.0;
    for (i = 0; i <= cols; i++) {
        double q = i < cols ? cell[i * step] * area : 0.0;
        row[2 + 2 * i] = before.value;
        row[3 + 2 * i] = moment.value;
        cells_add(&moment, before.value);
        cells_add(&moment, 0.5 * q - before.lost);
        cells_add(&before, q);
    }
    row[2 + 2 * i] = before.value;
    row[3 + 2 * i] = moment.value;
}

static void cells_fill_tables(aspi_cells *k, double *numbers)
{
    const double *density = numbers + aspi_cells_density(k);
    double *below = numbers + aspi_cells_below(k), area = k->dx * k->dy;
    ptrdiff_t nx = k->nx, ny = k->ny, i, j;
    for (j = 0; j < ny; j++) {
        size_t at = (size_t)j * aspi_cells_stride(k, ASPI_FROM_LEFT);
        cells_fill_row(numbers + aspi_cells_place(k, ASPI_FROM_LEFT) + at, density + j * nx, 1, k->nx, area);
        cells_fill_row(numbers + aspi_cells_place(k, ASPI_FROM_RIGHT) + at, density + j * nx + nx - 1, -1,
                 k->nx, area);
    }
    for (i = 0; i < nx; i++) {
        size_t at = (size_t)i * aspi_cells_stride(k, ASPI_FROM_BELOW);
        cells_fill_row(numbers + aspi_cells_place(k, ASPI_FROM_BELOW) + at, density + i, nx, k->ny, area);
        cells_fill_row(numbers + aspi_cells_place(k, ASPI_FROM_ABOVE) + at, density + (ny - 1) * nx + i, -nx,
                 k->ny, area);
    }
    below[0] = 0.0;
    for (j = 0; j < ny; j++) {
        size_t end = (size_t)(j + 1) * aspi_cells_stride(k, ASPI_FROM_LEFT);
        below[j + 1] = below[j] + numbers[aspi_cells_place(k, ASPI_FROM_LEFT) + end - 2];
    }
}

static asp_status cells_check_range(const asp_slope_range *r, size_t nx, size_t ny, asp_error *err)
{
    double width = r->high_x - r->low_x, height = r->high_y - r->low_y;
    if (!cells_side_ok(nx) || !cells_side_ok(ny))
        return asp_fail_range(err, cells_side_ok(nx) ? "ny" : "nx", (double)(cells_side_ok(nx) ? ny : nx), 1, 0,
                              ASPI_HISTOGRAM_SIDE);
    if (!(aspi_abs(r->low_x) <= 1e3 && aspi_abs(r->high_x) <= 1e3 && aspi_abs(r->low_y) <= 1e3
          && aspi_abs(r->high_y) <= 1e3))
        return asp_fail(err, ASP_EINVAL, "range", "a slope is beyond 1000 or not a number");
    if (!(width >= 1e-5 * (double)nx && height >= 1e-5 * (double)ny))
        return asp_fail(err, ASP_EINVAL, "range", "a cell is less than 1e-5 wide: the upper slope must "
                        "lie above the lower one");
    return ASP_OK;
}

/* Cells without the empty border; the mean of the slopes moves into the map. */
static void cells_fill(aspi_cells *k, const cells_part *p, size_t nx, const double *values, double *mean)
{
    double *numbers = (double *)(void *)(k + 1), *density = numbers + aspi_cells_density(k);
    double scale = 1.0 / (p->sum * k->dx * k->dy);
    cells_sum sum_x = { 0.0, 0.0 }, sum_y = { 0.0, 0.0 };
    int i, j;
    for (j = 0; j < k->ny; j++)
        for (i = 0; i < k->nx; i++) {
            double q = values[(p->y0 + (size_t)j) * nx + p->x0 + (size_t)i] / p->largest;
            density[j * k->nx + i] = q * scale;
            cells_add(&sum_x, q * (i + 0.5));
            cells_add(&sum_y, q * (j + 0.5));
        }
    mean[0] = k->x0 + k->dx * (sum_x.value / p->sum);
    mean[1] = k->y0 + k->dy * (sum_y.value / p->sum);
    k->x0 -= mean[0];
    k->y0 -= mean[1];
    k->high_x = k->x0 + k->dx * k->nx;
    k->high_y = k->y0 + k->dy * k->ny;
    k->per_x = 1.0 / k->dx;
    k->per_y = 1.0 / k->dy;
    cells_fill_tables(k, numbers);
}

asp_status asp_histogram_make(void *memory, size_t nx, size_t ny, asp_slope_range range,
                              const double *values, const asp_map *map, asp_ndf *out, asp_error *err)
{
    aspi_cells *k = (aspi_cells *)memory;
    asp_map whole = { 1.0, 0.0, 0.0, 1.0, 0.0, 0.0 };
    cells_part p = { 0, 0, 0, 0, 0.0, 0.0 };
    double mean[2];
    asp_status s = cells_check_range(&range, nx, ny, err);
    if (!s)
        s = cells_used(nx, ny, values, &p, err);
    if (s)
        return s;
    k->nx = (int)(p.x1 - p.x0);
    k->ny = (int)(p.y1 - p.y0);
    k->dx = (range.high_x - range.low_x) / (double)nx;
    k->dy = (range.high_y - range.low_y) / (double)ny;
    k->x0 = range.low_x + k->dx * (double)p.x0;
    k->y0 = range.low_y + k->dy * (double)p.y0;
    cells_fill(k, &p, nx, values, mean);
    if (map)
        whole = *map;
    whole.tx += whole.m00 * mean[0] + whole.m01 * mean[1];
    whole.ty += whole.m10 * mean[0] + whole.m11 * mean[1];
    return asp_ndf_make_data(&asp_model_histogram, &whole, NULL, k, out, err);
}
