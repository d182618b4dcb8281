/* cmd_energy.c - how much light surfaces give back: albedos over angle and over a parameter
 *
 * The albedo of a direction is the mean weight of its samples. They are taken on a lattice of (u1, u2)
 * and, for light from everywhere, of directions (Roberts' R4 sequence) shifted eight times: the spread of the
 * eight is the error. */
#include "cmd.h"
#include "asperity_ndf.h"
#include "bsdf/bsdf.h"
#include "core/rng.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SHIFTS 8
#define MOST 4096
#define GRAZING 89.99 /* along the surface nothing arrives */
#define PI 3.14159265358979323846

typedef struct albedo { double r, g, b, error; } albedo;

static double fraction(double x) { return x - floor(x); }

/* Dimension d of point i under shift k: powers of 1/g, g^5 = g + 1. */
static double lattice(size_t i, int k, int d)
{
    static const double step[4] = { 0.8566748838545029, 0.733891856627126,
                                    0.6287067210378086, 0.53859725722361 };
    return fmin(fraction(0.5 + k * fraction(0.37037 * (d + 1)) + step[d] * (double)i), 1 - 0x1p-53);
}

typedef struct stream { uint64_t start, next; } stream;

static double next_uniform(void *state)
{
    stream *s = state;
    return aspi_unit64(aspi_random_at(s->start, s->next++));
}

static asp_rgb weight_of(const asp_material *mat, asp_vec3 wi, double u1, double u2, int walk, stream *s)
{
    return walk ? asp_walk_sample(mat, wi, next_uniform, s).weight : asp_sample(mat, wi, u1, u2).weight;
}

/* All directions of all specs, for one bar. */
typedef struct work { cmd_progress bar; double done, all; } work;

static void tick(work *w, size_t i)
{
    if (i % 1024 == 0)
        cmd_progress_show(&w->bar, (w->done + (double)i) / w->all);
}

/* Directional albedo, or with theta < 0 that of white light from the whole hemisphere. */
static albedo albedo_of(const asp_material *mat, double theta, double phi, size_t n, int walk, work *w)
{
    double sum[SHIFTS][3], mean = 0, spread = 0;
    albedo out = { 0, 0, 0, 0 };
    stream random = { aspi_random_start(1, (uint64_t)walk), 0 };
    for (int k = 0; k < SHIFTS; k++) {
        memset(sum[k], 0, sizeof sum[k]);
        for (size_t i = 0; i < n; i++) {
            double u1 = lattice(i, k, 0), u2 = lattice(i, k, 1), c = cos(theta), a = phi;
            if (theta < 0) { /* cosine-weighted, by two more dimensions of the sequence */
                c = sqrt(1 - lattice(i, k, 2));
                a = 2 * PI * lattice(i, k, 3);
            }
            double s = sqrt(fmax(0, 1 - c * c));
            asp_rgb got = weight_of(mat, (asp_vec3){ s * cos(a), s * sin(a), c }, u1, u2, walk, &random);
            sum[k][0] += got.r / (double)n;
            sum[k][1] += got.g / (double)n;
            sum[k][2] += got.b / (double)n;
            tick(w, i);
        }
        w->done += (double)n;
        out.r += sum[k][0] / SHIFTS;
        out.g += sum[k][1] / SHIFTS;
        out.b += sum[k][2] / SHIFTS;
        mean += sum[k][1] / SHIFTS;
    }
    for (int k = 0; k < SHIFTS; k++)
        spread += (sum[k][1] - mean) * (sum[k][1] - mean);
    out.error = sqrt(spread / (SHIFTS * (SHIFTS - 1)));
    return out;
}

/* ------------------------------------------------------------------ surfaces with a hole for a number */

/* The spec with `{}` replaced by the number; 0 when it is too long. */
static int fill(const char *spec, double value, char *out, size_t size)
{
    const char *hole = strstr(spec, "{}");
    char number[ASPI_NUMBER_TEXT];
    aspi_format_number(value, 9, number);
    if (!hole)
        return snprintf(out, size, "%s", spec) < (int)size;
    return snprintf(out, size, "%.*s%s%s", (int)(hole - spec), spec, number, hole + 2) < (int)size;
}

/* ------------------------------------------------------------------ the table */

typedef struct row { double x; albedo single, walk; } row;
typedef struct table { row *rows; size_t count; } table;

static void write_table(const cmd_args *args, const char *spec, const table *t, cmd_out *out)
{
    char text[16 * ASPI_NUMBER_TEXT];
    int walk = cmd_given(args, "walk") > 0;
    for (size_t i = 0; i < t->count; i++) {
        const row *r = &t->rows[i];
        double numbers[9] = { r->x, r->single.r, r->single.g, r->single.b, r->single.error,
                              r->walk.r, r->walk.g, r->walk.b, r->walk.error };
        size_t used = 0;
        cmd_out_write(out, "\"", 1);
        cmd_out_write(out, spec, strlen(spec));
        cmd_out_write(out, "\"", 1);
        for (int k = 0; k < (walk ? 9 : 5); k++) {
            text[used++] = ',';
            used += aspi_format_number(numbers[k], 6, text + used);
        }
        text[used++] = '\n';
        cmd_out_write(out, text, used);
    }
}

/* A share of energy: what crosses is not scaled by 1/eta^2, as radiance is, unless the spec says so. */
static int read_surface(const cmd_args *args, const char *spec, asp_material *mat)
{
    aspi_spec cut;
    int status = cmd_surface_spec(args, spec, mat);
    if (status == CMD_OK && aspi_bsdf_crosses(mat->model)
        && aspi_spec_cut(spec, strlen(spec), &cut, NULL) == ASP_OK && !aspi_spec_find(&cut, "transport"))
        mat->transport = ASP_IMPORTANCE;
    return status == CMD_OK && cmd_given(args, "walk") ? cmd_can_walk(mat) : status;
}

static size_t per_shift(const cmd_args *args) { return (size_t)cmd_integer(args, "samples") / SHIFTS + 1; }

static int measure(const cmd_args *args, const char *spec, int over, double low, double high, int n, table *t,
                   work *w)
{
    size_t samples = per_shift(args);
    double phi = cmd_number(args, "phi") * PI / 180;
    char filled[512];
    asp_material mat;
    for (int i = 0; i < n; i++) {
        row *r = &t->rows[i];
        double x = n > 1 ? low + (high - low) * i / (n - 1) : low;
        double theta;
        int status;
        if (!fill(spec, x, filled, sizeof filled))
            return cmd_usage("%s: too long", spec);
        x = over ? x : fmin(x, GRAZING);
        theta = over ? -1 : x * PI / 180;
        if (over || i == 0) {
            status = read_surface(args, filled, &mat);
            if (status != CMD_OK)
                return status;
        }
        r->x = x;
        r->single = albedo_of(&mat, theta, phi, samples, 0, w);
        if (cmd_given(args, "walk"))
            r->walk = albedo_of(&mat, theta, phi, samples, 1, w);
        t->count++;
    }
    return CMD_OK;
}

/* ------------------------------------------------------------------ the plot */

static int draw(const cmd_args *args, const table *tables, size_t count, int over, const char *path)
{
    asp_series series[24];
    double *memory = malloc(2 * count * 2 * MOST * sizeof *memory), *at = memory;
    size_t used = 0;
    asp_error err;
    if (!memory)
        return cmd_failed("not enough memory");
    memset(series, 0, sizeof series);
    for (size_t k = 0; k < count; k++)
        for (int walk = 0; walk <= (cmd_given(args, "walk") > 0); walk++) {
            asp_series *s = &series[used++];
            double *x = at, *y = at + tables[k].count;
            for (size_t i = 0; i < tables[k].count; i++) {
                const albedo *a = walk ? &tables[k].rows[i].walk : &tables[k].rows[i].single;
                x[i] = tables[k].rows[i].x;
                y[i] = a->g;
            }
            s->label = cmd_operand(args, k);
            s->dash = walk ? ASP_DASH_LONG : ASP_DASH_SOLID;
            s->x = x;
            s->y = y;
            s->count = tables[k].count;
            at += 2 * tables[k].count;
        }
    asp_chart chart = { .title = cmd_given(args, "walk") ? "Light given back: single scattering, with walks dashed"
                                                         : "Light given back by single scattering",
                        .x = { .label = over ? "the number in {}" : "theta_{i} [deg]" },
                        .y = { .label = "albedo, green" }, .series = series, .series_count = used };
    cmd_hold();
    asp_status status = asp_chart_write(&chart, path, &err);
    cmd_release();
    free(memory);
    return status == ASP_OK ? CMD_OK : cmd_error(&err);
}

static int run(const cmd_args *args)
{
    const char *path = cmd_text(args, "output");
    int over = cmd_given(args, "over") > 0, n = (int)cmd_integer(args, "angles"), status = CMD_OK;
    int svg = path && cmd_ends_in(path, ".svg");
    double low = 0, high = 90;
    size_t count = cmd_operand_count(args);
    table tables[12] = { { 0 } };
    cmd_out out;
    if (count > 12)
        return cmd_usage("%zu surfaces: at most 12 at once", count);
    if (over && (status = cmd_range(args, "over", MOST, &low, &high, &n)) != CMD_OK)
        return status;
    for (size_t k = 0; k < count && over; k++)
        if (!strstr(cmd_operand(args, k), "{}"))
            return cmd_usage("%s: --over needs {} where the number goes", cmd_operand(args, k));
    work w = { cmd_progress_begin("energy"), 0,
               (double)count * n * SHIFTS * (double)per_shift(args) * (1 + (cmd_given(args, "walk") > 0)) };
    for (size_t k = 0; k < count && status == CMD_OK; k++) {
        tables[k].rows = calloc((size_t)n, sizeof *tables[k].rows);
        status = tables[k].rows ? measure(args, cmd_operand(args, k), over, low, high, n, &tables[k], &w)
                                : cmd_failed("not enough memory");
    }
    cmd_progress_end(&w.bar);
    if (status == CMD_OK && svg)
        status = draw(args, tables, count, over, path);
    else if (status == CMD_OK && (status = cmd_out_open(&out, path)) == CMD_OK) {
        const char *head = over ? "spec,value,albedo_r,albedo_g,albedo_b,error"
                                : "spec,theta,albedo_r,albedo_g,albedo_b,error";
        cmd_out_write(&out, head, strlen(head));
        if (cmd_given(args, "walk"))
            cmd_out_write(&out, ",walk_r,walk_g,walk_b,walk_error", 32);
        cmd_out_write(&out, "\n", 1);
        for (size_t k = 0; k < count; k++)
            write_table(args, cmd_operand(args, k), &tables[k], &out);
        status = cmd_out_close(&out);
    }
    for (size_t k = 0; k < count; k++)
        free(tables[k].rows);
    return status;
}

static const cmd_option options[] = {
    { "angles",  0,   "N",    CMD_INTEGER, 2, MOST, .initial = "10", .help = "rows from 0 to 90 degrees, of which the last is 89.99" },
    { "phi",     0,   "DEG",  CMD_NUMBER, -360, 360, .initial = "0", .help = "azimuth of wi" },
    { "over",    0,   "LOW:HIGH:N", CMD_TEXT, .help = "white light from everywhere, over the number in {}" },
    { "walk",    0,   NULL,   CMD_FLAG, .help = "multiple scattering beside it (conductor, dielectric, rough_diffuse)" },
    { "mask",    0,   "NAME", CMD_TEXT, .help = "masking, as in eval" },
    { "samples", 'n', "N",    CMD_INTEGER, 64, 1e8, .initial = "16384", .help = "directions per row" },
    { "output",  'o', "FILE", CMD_TEXT, .help = "CSV, or a plot if it ends in .svg; default standard output" },
    CMD_END
};

const cmd_record cmd_energy = {
    "energy", "How much light surfaces give back", "SPEC...", 1, -1,
    "A SPEC is a distribution, whose facets are perfect mirrors then, or a\n"
    "material. Directional albedo over theta; with --over the albedo of white\n"
    "light from everywhere over a number that stands as {} in the SPEC. `error`\n"
    "is the standard error of the green albedo. Of a material that light crosses it\n"
    "is the share of energy on both sides (transport=importance) unless the SPEC has\n"
    "a transport: radiance is scaled by 1/eta^2 on the way, and its sum is no share.\n\n"
    "  asperity energy ggx:alpha=0.5 conductor:metal=Au,ndf=(ggx:alpha=0.5)\n"
    "  asperity energy 'student_t:alpha={},gamma=2' --over 0.1:1:10 --walk",
    options, run
};
