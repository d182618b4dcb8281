/* cmd_eval.c - one more column: a quantity at the directions of each row */
#include "asperity_ndf.h"
#include "asperity_study.h"
#include "csv.h"
#include "precision.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BLOCK 1024               /* rows between one batch call and the next */
#define MOST_WAVELENGTHS 81
#define COLUMNS MOST_WAVELENGTHS /* of one row */

/* ------------------------------------------------------------------ the quantities */

enum { IN_M = 1, IN_W = 2, IN_WI = 4, IN_WO = 8, IN_P = 16 };

/* The slots of a row: three numbers for each direction and two for a slope. */
enum { AT_M = 0, AT_W = 3, AT_WI = 6, AT_WO = 9, AT_P = 12, SLOTS = 14 };

static const struct input { int bit, at, count; const char *column[3]; } inputs[] = {
    { IN_M,  AT_M,  3, { "mx", "my", "mz" } },
    { IN_W,  AT_W,  3, { "wx", "wy", "wz" } },
    { IN_WI, AT_WI, 3, { "wi_x", "wi_y", "wi_z" } },
    { IN_WO, AT_WO, 3, { "wo_x", "wo_y", "wo_z" } },
    { IN_P,  AT_P,  2, { "px", "py", NULL } },
};
enum { INPUTS = sizeof inputs / sizeof *inputs };

typedef struct block64 { double in[SLOTS][BLOCK], out[COLUMNS][BLOCK]; } block64;
typedef struct block32 { float in[SLOTS][BLOCK], out[3][BLOCK]; } block32;

typedef struct job {
    int quantity, mask, columns;
    const char *form;            /* lambda and G1 by a formula of the STD paper, or NULL */
    int wavelengths;             /* 0: three channels */
    double nm[MOST_WAVELENGTHS];
    asp_material  material;      /* its ndf is the distribution */
    asp_materialf materialf;
} job;

enum { Q_D, Q_P22, Q_SIGMA, Q_LAMBDA, Q_G1, Q_G2, Q_PDF_NORMAL, Q_PDF_VISIBLE, Q_BRDF, Q_BRDF_COS,
       Q_PDF_BRDF, QUANTITIES };

static const struct quantity { const char *name; int needs; } quantities[QUANTITIES] = {
    { "D", IN_M }, { "P22", IN_P }, { "sigma", IN_W }, { "lambda", IN_W }, { "G1", IN_W },
    { "G2", IN_WI | IN_WO | IN_M }, { "pdf_normal", IN_M }, { "pdf_visible", IN_WI | IN_M },
    { "brdf", IN_WI | IN_WO }, { "brdf_cos", IN_WI | IN_WO }, { "pdf_brdf", IN_WI | IN_WO },
};

/* The batch calls in one precision: S is the suffix of its names. */
#define DEFINE_EVALUATE(S, MATERIAL, CVEC3S, RGBS)                                                 \
    static void evaluate##S(const job *work, block##S *b, size_t n)                                \
    {                                                                                              \
        const CVEC3S m = { b->in[AT_M], b->in[AT_M + 1], b->in[AT_M + 2] };                        \
        const CVEC3S w = { b->in[AT_W], b->in[AT_W + 1], b->in[AT_W + 2] };                        \
        const CVEC3S wi = { b->in[AT_WI], b->in[AT_WI + 1], b->in[AT_WI + 2] };                    \
        const CVEC3S wo = { b->in[AT_WO], b->in[AT_WO + 1], b->in[AT_WO + 2] };                    \
        const RGBS rgb = { b->out[0], b->out[1], b->out[2] };                                      \
        switch (work->quantity) {                                                                  \
        case Q_D:           N_##S(asp_D)(&MATERIAL.ndf, n, m, b->out[0]); break;                   \
        case Q_P22:         N_##S(asp_P22)(&MATERIAL.ndf, n, b->in[AT_P], b->in[AT_P + 1],         \
                                           b->out[0]); break;                                      \
        case Q_SIGMA:       N_##S(asp_sigma)(&MATERIAL.ndf, n, w, b->out[0]); break;               \
        case Q_LAMBDA:      N_##S(asp_lambda)(&MATERIAL.ndf, n, w, work->mask, b->out[0]); break;  \
        case Q_G1:          N_##S(asp_G1)(&MATERIAL.ndf, n, w, work->mask, b->out[0]); break;      \
        case Q_G2:          N_##S(asp_G2)(&MATERIAL.ndf, n, wi, wo, m, work->mask, b->out[0]);     \
                            break;                                                                 \
        case Q_PDF_NORMAL:  N_##S(asp_pdf_normal)(&MATERIAL.ndf, n, m, b->out[0]); break;          \
        case Q_PDF_VISIBLE: N_##S(asp_pdf_visible)(&MATERIAL.ndf, n, wi, m, b->out[0]); break;     \
        case Q_BRDF:        N_##S(asp_eval)(&MATERIAL, n, wi, wo, rgb); break;                     \
        case Q_BRDF_COS:    N_##S(asp_eval_cos)(&MATERIAL, n, wi, wo, rgb); break;                 \
        case Q_PDF_BRDF:    N_##S(asp_pdf)(&MATERIAL, n, wi, wo, b->out[0]); break;                \
        }                                                                                          \
    }
DEFINE_EVALUATE(64, work->material, asp_cvec3s, asp_rgbs)
DEFINE_EVALUATE(32, work->materialf, asp_cvec3sf, asp_rgbsf)

/* lambda and G1 of an unskewed student_t by one of its paper's formulas. */
static void evaluate_form(const job *work, block64 *b, size_t n)
{
    const asp_map *map = &work->material.ndf.map;
    for (size_t i = 0; i < n; i++) {
        double x = b->in[AT_W][i], y = b->in[AT_W + 1][i], z = b->in[AT_W + 2][i], lambda = HUGE_VAL;
        double s = hypot(map->m00 * x + map->m10 * y, map->m01 * x + map->m11 * y);
        if (z > 0)
            asp_student_lambda(work->form, work->material.ndf.shape[0], s > 0 ? z / s : HUGE_VAL,
                               &lambda, NULL);
        b->out[0][i] = work->quantity == Q_LAMBDA ? lambda : 1 / (1 + lambda);
    }
}

/* f at wavelengths, one column each. */
static void evaluate_wavelengths(const job *work, block64 *b, size_t n)
{
    double f[MOST_WAVELENGTHS];
    for (size_t i = 0; i < n; i++) {
        asp_vec3 wi = { b->in[AT_WI][i], b->in[AT_WI + 1][i], b->in[AT_WI + 2][i] };
        asp_vec3 wo = { b->in[AT_WO][i], b->in[AT_WO + 1][i], b->in[AT_WO + 2][i] };
        double by = work->quantity == Q_BRDF_COS ? fabs(wo.z) : 1;
        asp_eval_wavelengths(&work->material, wi, wo, (size_t)work->wavelengths, work->nm, f, NULL);
        for (int j = 0; j < work->wavelengths; j++)
            b->out[j][i] = by * f[j];
    }
}

/* ------------------------------------------------------------------ which columns */

/* Where the numbers of a row come from and go to. */
typedef struct layout {
    int    column[SLOTS], slot[SLOTS];
    size_t count;
    int    vectors[INPUTS];      /* which directions to check, as indices of `inputs` */
    size_t vector_count;
    int    slope_of_normal;      /* P22 where the file has normals */
} layout;

static int find_columns(const csv *table, int needs, layout *out)
{
    memset(out, 0, sizeof *out);
    if (needs == IN_P && csv_find(table, "px") < 0 && csv_find(table, "mx") >= 0) {
        needs = IN_M;
        out->slope_of_normal = 1;
    }
    for (int i = 0; i < INPUTS; i++) {
        if (!(needs & inputs[i].bit))
            continue;
        for (int j = 0; j < inputs[i].count; j++) {
            int column = csv_find(table, inputs[i].column[j]);
            if (column < 0)
                return cmd_failed("%s: line %lld: there is no column '%s'; needed are %s, %s%s%s%s",
                                  table->name, table->number, inputs[i].column[j],
                                  inputs[i].column[0], inputs[i].column[1],
                                  inputs[i].count > 2 ? ", " : "",
                                  inputs[i].count > 2 ? inputs[i].column[2] : "",
                                  inputs[i].bit == IN_P ? ", or mx, my, mz" : "");
            out->column[out->count] = column;
            out->slot[out->count++] = inputs[i].at + j;
        }
        if (inputs[i].count == 3)
            out->vectors[out->vector_count++] = i;
    }
    return CMD_OK;
}

/* Directions are taken as they are, so they have to be unit vectors. */
static int check_units(const csv *table, const layout *where, const double row[SLOTS],
                       double tolerance)
{
    for (size_t i = 0; i < where->vector_count; i++) {
        const struct input *in = &inputs[where->vectors[i]];
        const double *v = row + in->at;
        double length = hypot(hypot(v[0], v[1]), v[2]);
        if (!(fabs(length - 1) <= tolerance))
            return cmd_failed("%s: line %lld: columns '%s', '%s', '%s': (%g, %g, %g) is no unit "
                              "vector: length %.9g is outside [1 - %g, 1 + %g]", table->name,
                              table->number, in->column[0], in->column[1], in->column[2], v[0],
                              v[1], v[2], length, tolerance, tolerance);
    }
    return CMD_OK;
}

static int read_row(const csv *table, const layout *where, int single, block64 *b, size_t at)
{
    double number[SLOTS], row[SLOTS] = { 0 };
    if (csv_numbers(table, where->column, where->count, number))
        return CMD_FAILED;
    for (size_t i = 0; i < where->count; i++) {
        if (single && fabs(number[i]) > FLT_MAX)
            return cmd_failed("%s: line %lld: column '%s': %g is outside [-%.9g, %.9g], the range "
                              "of float32", table->name, table->number,
                              table->column[where->column[i]], number[i], (double)FLT_MAX,
                              (double)FLT_MAX);
        row[where->slot[i]] = number[i];
    }
    if (check_units(table, where, row, single ? 1e-4 : 1e-6))
        return CMD_FAILED;
    if (where->slope_of_normal) {            /* a normal at or below the horizon has no slope */
        double px = -row[AT_M] / row[AT_M + 2], py = -row[AT_M + 1] / row[AT_M + 2];
        double steepest = single ? FLT_MAX : DBL_MAX;
        int known = row[AT_M + 2] > 0 && fabs(px) <= steepest && fabs(py) <= steepest;
        row[AT_P] = known ? px : HUGE_VAL;
        row[AT_P + 1] = known ? py : HUGE_VAL;
    }
    for (size_t i = 0; i < SLOTS; i++)
        b->in[i][at] = row[i];
    return CMD_OK;
}

/* ------------------------------------------------------------------ block by block */

/* The lines of a block as they were read; `row` is -1 for a comment or an empty line. */
typedef struct lines {
    char *text;
    size_t used, room;
    struct { size_t end; int row; } line[2 * BLOCK];
    size_t count;
} lines;

static int keep_line(lines *kept, const csv *table, int row)
{
    if (kept->used + table->length > kept->room) {
        size_t room = 2 * (kept->used + table->length) + 4096;
        char *text = realloc(kept->text, room);
        if (!text)
            return cmd_failed("out of memory");
        kept->text = text;
        kept->room = room;
    }
    memcpy(kept->text + kept->used, table->line, table->length);
    kept->used += table->length;
    kept->line[kept->count].end = kept->used;
    kept->line[kept->count++].row = row;
    return CMD_OK;
}

static void narrow(const block64 *from, block32 *to, size_t n)
{
    for (int i = 0; i < SLOTS; i++)
        for (size_t j = 0; j < n; j++)
            to->in[i][j] = (float)from->in[i][j];
}

static void finish_block(const job *work, const layout *where, char separator, block64 *b,
                         block32 *bf, lines *kept, size_t rows, cmd_out *out)
{
    if (work->form) {
        evaluate_form(work, b, rows);
    } else if (work->wavelengths) {
        evaluate_wavelengths(work, b, rows);
    } else if (bf) {
        narrow(b, bf, rows);
        evaluate32(work, bf, rows);
        for (int i = 0; i < work->columns; i++)
            for (size_t j = 0; j < rows; j++)
                b->out[i][j] = bf->out[i][j];
    } else {
        evaluate64(work, b, rows);
    }
    for (size_t j = 0; where->slope_of_normal && j < rows; j++)
        if (isinf(b->in[AT_P][j]))
            b->out[0][j] = 0;
    size_t start = 0;
    for (size_t i = 0; i < kept->count; i++) {
        char text[COLUMNS * (ASPI_NUMBER_TEXT + 1) + 1];
        size_t used = 0;
        cmd_out_write(out, kept->text + start, kept->line[i].end - start);
        start = kept->line[i].end;
        for (int k = 0; kept->line[i].row >= 0 && k < work->columns; k++) {
            text[used++] = separator;
            used += aspi_format_number(b->out[k][kept->line[i].row], bf ? 9 : 17, text + used);
        }
        text[used++] = '\n';
        cmd_out_write(out, text, used);
    }
    kept->count = kept->used = 0;
}

static int eval_rows(const job *work, csv *table, const layout *where, block64 *b, block32 *bf,
                     cmd_out *out)
{
    lines *kept = calloc(1, sizeof *kept);
    size_t rows = 0;
    int status = kept ? CMD_OK : cmd_failed("out of memory");
    csv_row got = CSV_END;
    cmd_progress bar = cmd_progress_beside(out, "eval");
    if (csv_done(table) < 0)
        bar.shown = 0;
    while (status == CMD_OK && (got = csv_next(table)) != CSV_END) {
        if (got == CSV_BROKEN)
            status = CMD_FAILED;
        else if (got == CSV_CELLS)
            status = read_row(table, where, bf != NULL, b, rows);
        if (status == CMD_OK)
            status = keep_line(kept, table, got == CSV_CELLS ? (int)rows++ : -1);
        if (status == CMD_OK && (rows == BLOCK || kept->count == 2 * BLOCK)) {
            finish_block(work, where, table->separator, b, bf, kept, rows, out);
            rows = 0;
            if (bar.shown)
                cmd_progress_show(&bar, csv_done(table));
            if (cmd_out_broken(out))
                break;
        }
    }
    if (status == CMD_OK && !cmd_out_broken(out))
        finish_block(work, where, table->separator, b, bf, kept, rows, out);
    cmd_progress_end(&bar);
    free(kept ? kept->text : NULL);
    free(kept);
    return status;
}

/* The header as it was, with the new columns at its end. */
static int write_header(const job *work, const csv *table, const char *name, cmd_out *out)
{
    static const char *const channel[] = { "_r", "_g", "_b" };
    char column[128];
    cmd_out_write(out, table->line, table->length);
    for (int i = 0; i < work->columns; i++) {
        if (work->wavelengths)
            snprintf(column, sizeof column, "%c%.100s_%.10g", table->separator, name, work->nm[i]);
        else
            snprintf(column, sizeof column, "%c%.100s%s", table->separator, name,
                     work->columns == 3 ? channel[i] : "");
        if (csv_find(table, column + 1) >= 0)
            return cmd_failed("%s: line %lld: column '%s' is there already; name the new one with "
                              "--as", table->name, table->number, column + 1);
        cmd_out_write(out, column, strlen(column));
    }
    cmd_out_write(out, "\n", 1);
    return CMD_OK;
}

/* ------------------------------------------------------------------ the command */

static int check_form(const cmd_args *args, job *work)
{
    const asp_ndf *ndf = &work->material.ndf;
    char line[640];
    double lambda;
    asp_error err;
    work->form = cmd_text(args, "form");
    if (!work->form)
        return CMD_OK;
    if (work->quantity != Q_LAMBDA && work->quantity != Q_G1)
        return cmd_usage("--form %s: only lambda and G1 have forms", work->form);
    if (strcmp(ndf->model->name, "student_t") != 0 || ndf->map.tx != 0 || ndf->map.ty != 0)
        return cmd_usage("--form %s: needs --ndf student_t without a mean slope", work->form);
    if (cmd_given(args, "mask") || cmd_choice(args, "precision"))
        return cmd_usage("--form %s: takes neither --mask nor f32", work->form);
    if (asp_student_lambda(work->form, ndf->shape[0], 1, &lambda, &err))
        return cmd_usage("--form %s: %s", work->form, asp_error_text(&err, line, sizeof line));
    return CMD_OK;
}

/* LOW:HIGH:N nm, or wavelengths with commas between them. */
static int read_wavelengths(const cmd_args *args, job *work)
{
    const char *text = cmd_text(args, "wavelengths"), *at = text;
    double low, high, f[MOST_WAVELENGTHS];
    asp_vec3 up = { 0, 0, 1 };
    asp_error err;
    char line[640];
    int n = 0, status;
    if (!text)
        return CMD_OK;
    if (work->quantity != Q_BRDF && work->quantity != Q_BRDF_COS)
        return cmd_usage("--wavelengths: only brdf and brdf_cos have wavelengths");
    if (cmd_choice(args, "precision"))
        return cmd_usage("--wavelengths: there is no f32 of it");
    if (strchr(text, ':')) {
        if ((status = cmd_range(args, "wavelengths", MOST_WAVELENGTHS, &low, &high, &n)) != CMD_OK)
            return status;
        for (int i = 0; i < n; i++)
            work->nm[i] = n == 1 ? low : low + (high - low) * i / (n - 1);
    }
    for (int used = 1; !strchr(text, ':') && (*at || !n); at += used) {
        if (n == MOST_WAVELENGTHS || sscanf(at, "%lf%n", &work->nm[n], &used) != 1 || (at[used] && at[used] != ',')
            || (at[used] && !at[used + 1]))
            return cmd_usage("--wavelengths %s: expected LOW:HIGH:N or up to %d numbers with commas between them", text,
                             MOST_WAVELENGTHS);
        used += at[used] == ',';
        n++;
    }
    if (asp_eval_wavelengths(&work->material, up, up, (size_t)n, work->nm, f, &err))
        return cmd_usage("--wavelengths: %s", asp_error_text(&err, line, sizeof line));
    work->wavelengths = work->columns = n;
    return CMD_OK;
}

static int make_job(const cmd_args *args, job *work)
{
    const char *names[QUANTITIES + 1] = { NULL };
    for (int i = 0; i < QUANTITIES; i++)
        names[i] = quantities[i].name;
    memset(work, 0, sizeof *work);
    work->quantity = cmd_find(cmd_operand(args, 0), names);
    if (work->quantity < 0)
        return cmd_unknown("unknown quantity", cmd_operand(args, 0), names);
    work->columns = work->quantity == Q_BRDF || work->quantity == Q_BRDF_COS ? 3 : 1;
    int status = cmd_surface(args, &work->material);
    work->mask = work->material.mask;
    if (status == CMD_OK)
        work->materialf = asp_material_narrow(&work->material);
    if (status == CMD_OK)
        status = read_wavelengths(args, work);
    return status == CMD_OK ? check_form(args, work) : status;
}

/* The new column's name stands in the header without quotes. */
static int check_name(const char *name)
{
    for (const char *c = name; c && *c; c++)
        if ((unsigned char)*c < 32 || *c == 127 || strchr(",;\"", *c))
            return cmd_usage("--as: a name may hold no comma, semicolon, tab, quote or line end");
    if (name && strlen(name) > 100)
        return cmd_usage("--as: %zu letters are more than 100", strlen(name));
    return CMD_OK;
}

static int run(const cmd_args *args)
{
    job *work = malloc(sizeof *work);
    block64 *b = malloc(sizeof *b);
    block32 *bf = cmd_choice(args, "precision") ? malloc(sizeof *bf) : NULL;
    layout where;
    csv table;
    cmd_out out;
    int status = work && b && (bf || !cmd_choice(args, "precision"))
        ? make_job(args, work) : cmd_failed("out of memory");
    if (status == CMD_OK)
        status = check_name(cmd_text(args, "as"));
    if (status == CMD_OK)
        status = cmd_out_open(&out, cmd_text(args, "output"));
    if (status == CMD_OK) {
        const char *name = cmd_text(args, "as");
        const struct quantity *quantity = &quantities[work->quantity];
        status = csv_open(&table, cmd_operand(args, 1), &out);
        if (status == CMD_OK) {
            status = find_columns(&table, quantity->needs, &where);
            if (status == CMD_OK)
                status = write_header(work, &table, name ? name : quantity->name, &out);
            if (status == CMD_OK)
                status = eval_rows(work, &table, &where, b, bf, &out);
            csv_close(&table);
        }
        if (status == CMD_OK)
            status = cmd_out_close(&out);
        else
            cmd_out_abandon(&out);
    }
    free(work);
    free(b);
    free(bf);
    return status;
}

static const cmd_option options[] = {
    { "ndf", 0, "SPEC", CMD_TEXT,
      .help = "the distribution; brdf and pdf_brdf are then those of its perfect mirror facets" },
    { "material", 0, "SPEC", CMD_TEXT, .help = "the material; either this or --ndf" },
    { "mask", 0, "NAME", CMD_TEXT,
      .help = "masking: correlated, uncorrelated or v_cavity, and min or wall, joined by '+'; "
              "default: the material's, else correlated+min" },
    { "form", 0, "NAME", CMD_TEXT,
      .help = "lambda and G1 of student_t by a formula of its paper: exact, hypergeometric, integer, "
              "half_integer or rational" },
    { "precision", 0, "f64|f32", CMD_CHOICE, .initial = "f64",
      .help = "f32 narrows each number and evaluates in single precision" },
    { "wavelengths", 0, "LIST", CMD_TEXT,
      .help = "brdf and brdf_cos at these instead of red, green, blue: nm with commas between them, or "
              "LOW:HIGH:N, in [380, 780]; of metals by name, of one index, and of films on them" },
    { "as", 0, "NAME", CMD_TEXT, .help = "name of the new column; default: the quantity" },
    { "output", 'o', "FILE", CMD_TEXT, .help = "write there instead of standard output" },
    CMD_END
};

const cmd_record cmd_eval = {
    "eval", "evaluate a quantity at the directions in a CSV file", "QUANTITY [FILE]", 1, 2,
    "Reads rows with a header from FILE or standard input and writes the same rows\n"
    "with one more column (brdf and brdf_cos: three, with _r _g _b added). The\n"
    "numbers read back exactly (17 digits, f32: 9). Works in constant memory.\n"
    "\n"
    "quantity      needs the columns      is\n"
    "D             mx,my,mz               density of normals, 1/sr\n"
    "P22           px,py or mx,my,mz      density of slopes\n"
    "sigma         wx,wy,wz               projected area of the facets\n"
    "lambda, G1    wx,wy,wz               Smith's masking\n"
    "G2            wi_x..wo_z, mx,my,mz   masking from both directions\n"
    "pdf_normal    mx,my,mz               density of `sample normal`\n"
    "pdf_visible   wi_x.., mx,my,mz       density of `sample visible`\n"
    "brdf          wi_x.., wo_x..         f, 1/sr\n"
    "brdf_cos      wi_x.., wo_x..         f cos(theta_o)\n"
    "pdf_brdf      wi_x.., wo_x..         density of `sample brdf`\n"
    "\n"
    "Directions are unit vectors to 1e-6 (f32: 1e-4) and are used as they stand;\n"
    "below the horizon the result is 0 where the quantity says so. Empty lines and\n"
    "lines that begin with # are passed through. Cells are separated by commas,\n"
    "semicolons or tabs. Anything wrong in a row stops with its line and column.",
    options, run
};
