/* cmd_sample.c - directions drawn by the samplers of the library */
#include "asperity_ndf.h"
#include "asperity_study.h"
#include "cmd.h"
#include "bsdf/bsdf.h"
#include "core/rng.h"
#include "precision.h"

#include <stdlib.h>
#include <string.h>

#define BLOCK 1024

enum { NORMAL, VISIBLE, BRDF };
enum { DEFAULT, WALTER, REJECTION };

/* What one block holds; in the order of the columns of `sample brdf`. */
enum { AT_U = 0, AT_WI = 2, AT_DIRECTION = 5, AT_PDF = 8, AT_WEIGHT = 9, SLOTS = 12 };

typedef struct block64 { double at[SLOTS][BLOCK]; } block64;
typedef struct block32 { float at[SLOTS][BLOCK]; } block32;

/* The stream of one row of the rejection sampler. */
typedef struct row_stream { uint64_t start, next; } row_stream;

typedef struct job {
    int what, sampler;
    double matrix[9];            /* walter */
    asp_oracle oracle;           /* rejection */
    asp_vec3 wi;
    uint64_t start;              /* of the random stream */
    asp_material  material;
    asp_materialf materialf;
} job;

static double next_uniform(void *state)
{
    row_stream *row = state;
    return aspi_unit64(aspi_random_at(row->start, row->next++));
}

/* A visible normal by Walter's map of (u1, u2), or by rejection from a stream of the row's own. */
static asp_vec3 draw_other(const job *work, uint64_t row, double u1, double u2)
{
    row_stream stream = { aspi_random_start(aspi_random_at(work->start, row), 1), 0 };
    return work->sampler == WALTER ? asp_sample_visible_walter(work->matrix, work->wi, u1, u2)
                                   : asp_oracle_visible(&work->oracle, work->wi, next_uniform, &stream);
}

#define DEFINE_DRAW_OTHER(S, REAL)                                                                 \
    static void draw_other##S(const job *work, block##S *b, uint64_t first, size_t n)              \
    {                                                                                              \
        for (size_t i = 0; i < n; i++) {                                                           \
            asp_vec3 m = draw_other(work, first + i, b->at[AT_U][i], b->at[AT_U + 1][i]);          \
            b->at[AT_DIRECTION][i] = (REAL)m.x;                                                    \
            b->at[AT_DIRECTION + 1][i] = (REAL)m.y;                                                \
            b->at[AT_DIRECTION + 2][i] = (REAL)m.z;                                                \
        }                                                                                          \
    }
DEFINE_DRAW_OTHER(64, double)
DEFINE_DRAW_OTHER(32, float)

/* Fills u1, u2 and wi, then the batch calls; S is the precision. */
#define DEFINE_DRAW(S, REAL, MATERIAL, CVEC3S, VEC3S, RGBS)                                        \
    static void draw##S(const job *work, block##S *b, uint64_t first, size_t n)                    \
    {                                                                                              \
        REAL *u1 = b->at[AT_U], *u2 = b->at[AT_U + 1], *pdf = b->at[AT_PDF];                       \
        const CVEC3S wi = { b->at[AT_WI], b->at[AT_WI + 1], b->at[AT_WI + 2] };                    \
        const VEC3S to = { b->at[AT_DIRECTION], b->at[AT_DIRECTION + 1], b->at[AT_DIRECTION + 2] };\
        const CVEC3S drawn = { to.x, to.y, to.z };                                                 \
        const RGBS weight = { b->at[AT_WEIGHT], b->at[AT_WEIGHT + 1], b->at[AT_WEIGHT + 2] };      \
        for (size_t i = 0; i < n; i++) {                                                           \
            u1[i] = aspi_unit##S(aspi_random_at(work->start, 2 * (first + i)));                    \
            u2[i] = aspi_unit##S(aspi_random_at(work->start, 2 * (first + i) + 1));                \
            b->at[AT_WI][i] = (REAL)work->wi.x;                                                    \
            b->at[AT_WI + 1][i] = (REAL)work->wi.y;                                                \
            b->at[AT_WI + 2][i] = (REAL)work->wi.z;                                                \
        }                                                                                          \
        if (work->sampler) {                                                                       \
            draw_other##S(work, b, first, n);                                                      \
            N_##S(asp_pdf_visible)(&MATERIAL.ndf, n, wi, drawn, pdf);                              \
        } else if (work->what == BRDF) {                                                              \
            N_##S(asp_sample)(&MATERIAL, n, wi, u1, u2, to, pdf, weight);                          \
        } else if (work->what == VISIBLE) {                                                        \
            N_##S(asp_sample_visible)(&MATERIAL.ndf, n, wi, u1, u2, to);                           \
            N_##S(asp_pdf_visible)(&MATERIAL.ndf, n, wi, drawn, pdf);                              \
        } else {                                                                                   \
            N_##S(asp_sample_normal)(&MATERIAL.ndf, n, u1, u2, to);                                \
            N_##S(asp_pdf_normal)(&MATERIAL.ndf, n, drawn, pdf);                                   \
        }                                                                                          \
    }
DEFINE_DRAW(64, double, work->material, asp_cvec3s, asp_vec3s, asp_rgbs)
DEFINE_DRAW(32, float, work->materialf, asp_cvec3sf, asp_vec3sf, asp_rgbsf)

/* Which slots are columns, and how they are called. */
static const struct form { const char *header; int slot[SLOTS], columns; } forms[] = {
    [NORMAL]  = { "u1,u2,mx,my,mz,pdf\n", { 0, 1, 5, 6, 7, 8 }, 6 },
    [VISIBLE] = { "u1,u2,wi_x,wi_y,wi_z,mx,my,mz,pdf\n", { 0, 1, 2, 3, 4, 5, 6, 7, 8 }, 9 },
    [BRDF]    = { "u1,u2,wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,pdf,weight_r,weight_g,weight_b\n",
                  { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11 }, 12 },
};

static void write_row(const struct form *form, const block64 *b, size_t i, int digits, cmd_out *out)
{
    char text[SLOTS * (ASPI_NUMBER_TEXT + 1)];
    size_t used = 0;
    for (int k = 0; k < form->columns; k++) {
        used += aspi_format_number(b->at[form->slot[k]][i], digits, text + used);
        text[used++] = k + 1 < form->columns ? ',' : '\n';
    }
    cmd_out_write(out, text, used);
}

static void draw_all(const job *work, block64 *b, block32 *bf, uint64_t count, cmd_out *out)
{
    const struct form *form = &forms[work->what];
    cmd_progress bar = cmd_progress_beside(out, "sample");
    cmd_out_write(out, form->header, strlen(form->header));
    for (uint64_t first = 0; first < count && !cmd_out_broken(out); first += BLOCK) {
        size_t n = count - first < BLOCK ? (size_t)(count - first) : BLOCK;
        if (bf) {
            draw32(work, bf, first, n);
            for (int k = 0; k < SLOTS; k++)
                for (size_t i = 0; i < n; i++)
                    b->at[k][i] = bf->at[k][i];
        } else {
            draw64(work, b, first, n);
        }
        for (size_t i = 0; i < n; i++)
            write_row(form, b, i, bf ? 9 : 17, out);
        cmd_progress_show(&bar, (double)(first + n) / (double)count);
    }
    cmd_progress_end(&bar);
}

static int make_sampler(const cmd_args *args, job *work)
{
    const asp_ndf *ndf = &work->material.ndf;
    char line[640];
    asp_error err;
    work->sampler = cmd_choice(args, "sampler");
    if (work->sampler == DEFAULT)
        return CMD_OK;
    if (work->what != VISIBLE)
        return cmd_usage("--sampler: only sample visible has a choice of samplers");
    if (work->sampler == WALTER) {
        if (ndf->model != asp_find_model(NULL, "ggx") && ndf->model != asp_find_model(NULL, "ellipsoid"))
            return cmd_usage("--sampler walter: is for ggx and ellipsoid, not %s", ndf->model->name);
        asp_map_to_matrix(&ndf->map, work->matrix);
        return CMD_OK;
    }
    if (asp_oracle_make(ndf, ASP_ORACLE_STUDENT, &work->oracle, NULL)
        && asp_oracle_make(ndf, ASP_ORACLE_RADIAL, &work->oracle, &err))
        return cmd_usage("--sampler rejection: %s", asp_error_text(&err, line, sizeof line));
    return CMD_OK;
}

static int make_job(const cmd_args *args, job *work)
{
    static const char *const whats[] = { "normal", "visible", "brdf", NULL };
    memset(work, 0, sizeof *work);
    work->what = cmd_find(cmd_operand(args, 0), whats);
    if (work->what < 0)
        return cmd_unknown("unknown sampler", cmd_operand(args, 0), whats);
    if (work->what != NORMAL && !cmd_given(args, "wi"))
        return cmd_usage("--wi X,Y,Z is missing: sample %s needs a direction",
                         whats[work->what]);
    work->start = aspi_random_start((uint64_t)cmd_integer(args, "seed"), 0);
    int status = cmd_surface(args, &work->material);
    if (status == CMD_OK && cmd_given(args, "wi"))
        status = cmd_direction(args, "wi", &work->wi);
    if (status != CMD_OK)
        return status;
    work->materialf = asp_material_narrow(&work->material);
    if (work->what == VISIBLE && !(asp_sigma(&work->material.ndf, work->wi) > 0))
        return cmd_usage("--wi %s: no facet is seen from there", cmd_text(args, "wi"));
    int both = work->material.model && aspi_bsdf_crosses(work->material.model);
    if (work->what == BRDF && both && work->wi.z == 0)
        return cmd_usage("--wi %s: lies in the surface", cmd_text(args, "wi"));
    if (work->what == BRDF && !both && !(work->wi.z > 0))
        return cmd_usage("--wi %s: z = %g is outside (0, 1]", cmd_text(args, "wi"), work->wi.z);
    return make_sampler(args, work);
}

static int run(const cmd_args *args)
{
    int single = cmd_choice(args, "precision");
    job *work = malloc(sizeof *work);
    block64 *b = malloc(sizeof *b);
    block32 *bf = single ? malloc(sizeof *bf) : NULL;
    cmd_out out;
    int status = work && b && (bf || !single) ? make_job(args, work) : cmd_failed("out of memory");
    if (status == CMD_OK)
        status = cmd_out_open(&out, cmd_text(args, "output"));
    if (status == CMD_OK) {
        draw_all(work, b, bf, (uint64_t)cmd_integer(args, "count"), &out);
        status = cmd_out_close(&out);
    }
    free(work);
    free(b);
    free(bf);
    return status;
}

static const cmd_option options[] = {
    { "ndf", 0, "SPEC", CMD_TEXT,
      .help = "the distribution; brdf then samples its perfect mirror facets" },
    { "material", 0, "SPEC", CMD_TEXT, .help = "the material; either this or --ndf" },
    { "mask", 0, "NAME", CMD_TEXT,
      .help = "masking, as in `asperity list`; it enters the weights of brdf" },
    { "wi", 0, "X,Y,Z", CMD_TEXT,
      .help = "the given direction, made a unit vector; or THETA,PHI in degrees" },
    { "count", 'n', "N", CMD_INTEGER, 1, 1e12, .initial = "10", .help = "how many" },
    { "seed", 's', "N", CMD_INTEGER, 0, 9007199254740991.0, .initial = "1",
      .help = "another seed, other numbers" },
    { "sampler", 0, "default|walter|rejection", CMD_CHOICE, .initial = "default",
      .help = "of visible: walter is the Ellipsoid paper's (ggx, ellipsoid), rejection exact without "
              "inversion or tables; it leaves u1, u2 unused" },
    { "precision", 0, "f64|f32", CMD_CHOICE, .initial = "f64",
      .help = "f32 draws and evaluates in single precision" },
    { "output", 'o', "FILE", CMD_TEXT, .help = "write there instead of standard output" },
    CMD_END
};

const cmd_record cmd_sample = {
    "sample", "draw normals, visible normals or scattered directions", "normal|visible|brdf", 1, 1,
    "Writes CSV: the uniform numbers u1, u2, the given direction wi, the drawn normal\n"
    "m or direction wo, its density, and for brdf the weight f cos(theta_o) / pdf (0\n"
    "where wo is lost to the surface; through a dielectric wi and wo may be on either\n"
    "side, and cos is its absolute value). The columns are those that `eval` reads:\n"
    "\n"
    "  asperity sample brdf --ndf ggx:alpha=0.3 --wi 30,0 -n 1000 |\n"
    "  asperity eval brdf_cos --ndf ggx:alpha=0.3\n"
    "\n"
    "Row i has u1 = number 2i and u2 = number 2i + 1 of a SplitMix64 stream (Steele,\n"
    "Lea, Flood 2014) that the seed alone selects, so that a longer run begins with\n"
    "the rows of a shorter one. 53 bits of each are used, with f32 24.",
    options, run
};
