/* cmd_fit.c - distributions fitted to measurements, and the report */
#define _POSIX_C_SOURCE 200809L
#include "report.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define SPHERE 220             /* pixels; shown as they are */

typedef struct job {
    asp_fit_options options;
    const asp_model *model[REPORT_MODELS + 1];
    const char *folder;                  /* NULL: no report */
    int  json, several, spp;
    json_t *all;                         /* with --json: what is printed at the end */
    report_entry *entry;
    size_t entries;
} job;

/* ------------------------------------------------------------------ what the user asked for */

static int parse_models(const cmd_args *args, job *j)
{
    const asp_model *const *all = asp_models();
    const char *names[REPORT_MODELS + 1] = { NULL }, *text = cmd_text(args, "ndf");
    size_t n = 0;
    if (!text)
        return CMD_OK;
    for (size_t i = 0; all[i] && i < REPORT_MODELS; i++)
        names[i] = all[i]->name;
    while (*text) {
        char name[64];
        size_t length = strcspn(text, ",");
        snprintf(name, sizeof name, "%.*s", (int)length, text);
        text += length + (text[length] == ',');
        if (!length)
            continue;
        const asp_model *model = asp_find_model(NULL, name);
        if (!model)
            return cmd_unknown("--ndf: unknown distribution", name, names);
        if (model->keys == ASP_KEYS_ELLIPSOID)
            return cmd_usage("--ndf: '%s' is another way to write a distribution that can be fitted "
                             "under its own name", name);
        for (size_t i = 0; i < n; i++)
            if (j->model[i] == model)
                return cmd_usage("--ndf: '%s' is given twice", name);
        if (n < REPORT_MODELS)
            j->model[n++] = model;
    }
    if (!n)
        return cmd_usage("--ndf: no distribution is named");
    j->options.models = j->model;
    return CMD_OK;
}

static int parse_loss(const cmd_args *args, job *j)
{
    const char *names[ASP_LOSS_LIMIT + 1] = { NULL };
    for (int i = 0; asp_losses()[i]; i++)
        names[i] = asp_losses()[i]->name;
    j->options.loss = cmd_text(args, "loss");
    if (cmd_find(j->options.loss, names) < 0)
        return cmd_unknown("--loss: unknown loss", j->options.loss, names);
    return CMD_OK;
}

/* `made` (may be NULL) says whether it is new. */
static int make_folder(const char *path, int *made)
{
    struct stat about;
    if (mkdir(path, 0777) == 0) {
        if (made)
            *made = 1;
        return CMD_OK;
    }
    int why = errno;
    if (why == EEXIST && stat(path, &about) == 0 && S_ISDIR(about.st_mode))
        return CMD_OK;
    return cmd_failed("%s: cannot make the folder: %s", path, strerror(why));
}

/* ------------------------------------------------------------------ pictures */

static asp_rgb of_measured(const void *context, asp_vec3 wi, asp_vec3 wo)
{
    return asp_measured_eval(context, wi, wo);
}

typedef struct share { cmd_progress *bar; double from, part; } share;

static int show_share(void *context, double done)
{
    share *s = context;
    return cmd_progress_show(s->bar, s->from + s->part * done);
}

static int sphere(const asp_preview *look, char **out)
{
    asp_error err;
    asp_image image;
    unsigned char *png;
    size_t size;
    const asp_tone tone = { .exposure = 0, .soft = 0.4 };
    if (asp_preview_render(look, &image, &err))
        return cmd_error(&err);
    asp_status status = asp_image_png(&image, &tone, &png, &size, &err);
    asp_image_free(&image);
    if (status)
        return cmd_error(&err);
    *out = asp_base64(png, size);
    free(png);
    return *out ? CMD_OK : cmd_failed("out of memory");
}

/* The measurement first, its rays sampled by the best fit, then each fit. */
static int spheres(const job *j, report *r)
{
    cmd_progress bar = cmd_progress_begin("render");
    int status = CMD_OK;
    r->sphere_side = SPHERE;
    for (size_t k = r->info.scattered; k <= r->count && k <= REPORT_MODELS && !status; k++) {
        share part = { &bar, (double)k / (double)(r->count + 1), 1.0 / (double)(r->count + 1) };
        asp_preview look = { .width = SPHERE, .height = SPHERE, .samples = j->spp,
                             .progress = show_share, .progress_context = &part };
        if (k) {
            look.material = &r->result[k - 1].material;
        } else {
            look.function = of_measured;
            look.context = r->measured;
            look.proposal = &r->result[r->best].material;
        }
        status = sphere(&look, &r->sphere[k]);
    }
    cmd_progress_end(&bar);
    return status;
}

/* ------------------------------------------------------------------ writing */

/* Signals are held by the callers. */
static int write_text(const char *folder, const char *name, const char *text, size_t size)
{
    asp_error err;
    size_t room = strlen(folder) + strlen(name) + 2;
    char *path = malloc(room);
    if (!path)
        return cmd_failed("out of memory");
    snprintf(path, room, "%s/%s", folder, name);
    asp_status status = asp_file_write(path, text, size, &err);
    free(path);
    return status ? cmd_error(&err) : CMD_OK;
}

static char *json_text(const json_t *json)
{
    char *text = json ? json_dumps(json, JSON_INDENT(2) | JSON_REAL_PRECISION(17)) : NULL;
    char *line = text ? realloc(text, strlen(text) + 2) : NULL;
    if (line)
        strcat(line, "\n");
    else
        free(text);
    return line;
}

static int write_page(const char *folder, const char *name, page *p)
{
    int status = p->broken ? cmd_failed("out of memory") : write_text(folder, name, p->text, p->used);
    page_free(p);
    return status;
}

/* The folders are made only now, and go again if nothing comes to lie in them: an interrupted or
 * failed fit leaves none. Signals wait until both files are complete. */
static int write_files(const job *j, const char *folder, const char *json, page *html)
{
    int outer = 0, inner = 0;
    cmd_hold();
    int status = j->several ? make_folder(j->folder, &outer) : CMD_OK;
    if (!status)
        status = make_folder(folder, &inner);
    if (!status)
        status = write_text(folder, "fit.json", json, strlen(json));
    if (!status)
        status = write_page(folder, "report.html", html);
    if (status && inner && rmdir(folder)) {
        /* not empty: one of the two is there */
    }
    if (status && outer && rmdir(j->folder)) {
        /* as above */
    }
    cmd_release();
    return status;
}

/* Both files are complete in memory before the first is written. */
static int write_report(const job *j, report *r, const char *folder)
{
    page html = { 0 };
    json_t *json = report_json(r);
    char *text = json_text(json);
    int status = text ? spheres(j, r) : cmd_failed("out of memory");
    if (!status) {
        report_html(r, &html);
        status = html.broken ? cmd_failed("out of memory") : write_files(j, folder, text, &html);
    }
    page_free(&html);
    free(text);
    json_decref(json);
    return status;
}

/* ------------------------------------------------------------------ one measurement */

/* The last part of a path without what follows its last dot. */
static void stem_of(const char *path, char *out, size_t size)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    snprintf(out, size, "%.*s", dot && dot != name ? (int)(dot - name) : (int)strlen(name), name);
}

/* A folder for each of several; a name that has been taken gets a number. */
static void folder_of(const job *j, const report *r, char *name, size_t size)
{
    char stem[200];
    stem_of(r->title, stem, sizeof stem);
    snprintf(name, size, "%s", stem);
    for (unsigned number = 2;; number++) {
        size_t i = 0;
        while (i < j->entries && strcmp(j->entry[i].name, name))
            i++;
        if (i == j->entries)
            return;
        snprintf(name, size, "%s-%u", stem, number);
    }
}

static char *summary_of(const report *r)
{
    page p = { 0 };
    for (size_t i = 0; i < r->count; i++)
        page_put(&p, "<td class=\"n%s\">%s %.5f</td>", i == r->best ? " best" : "",
                 r->result[i].model->name, r->result[i].error[r->loss_index]);
    return p.text;
}

/* After each of several, so that a failure or an interrupt later leaves what is finished listed. */
static int write_index(const job *j)
{
    page index = { 0 };
    report_index(j->entry, j->entries, &index);
    cmd_hold();
    int status = write_page(j->folder, "index.html", &index);
    cmd_release();
    return status;
}

static int show(job *j, report *r)
{
    char name[256], *folder;
    int status = CMD_OK;
    if (j->folder) {
        folder_of(j, r, name, sizeof name);
        size_t room = strlen(j->folder) + sizeof name + 2;
        folder = malloc(room);
        if (!folder)
            return cmd_failed("out of memory");
        snprintf(folder, room, j->several ? "%s/%s" : "%s", j->folder, name);
        status = write_report(j, r, folder);
        free(folder);
        if (!status && j->several) {
            report_entry *e = &j->entry[j->entries++];
            memcpy(e->name, name, sizeof e->name);
            e->summary = summary_of(r);
            e->cells = r->count;
            status = e->summary ? write_index(j) : cmd_failed("out of memory");
        }
    }
    if (!status && j->json)
        status = json_array_append_new(j->all, report_json(r)) ? cmd_failed("out of memory") : CMD_OK;
    else if (!status)
        report_table(r, stdout);
    return status;
}

static int fit_one(job *j, report *r)
{
    asp_error err;
    asp_fit_result *result = NULL;
    char label[64];
    snprintf(label, sizeof label, "fit %.40s", r->title);
    cmd_progress bar = cmd_progress_begin(label);
    j->options.progress = cmd_progress_show;
    j->options.context = &bar;
    asp_status failed = asp_fit(r->measured, &j->options, &result, &r->count, &err);
    cmd_progress_end(&bar);
    if (!failed)
        r->geometry = asp_fit_geometries(r->measured, &r->geometries, &err);
    if (failed || !r->geometry) {
        free(result);
        if (r->file && !err.file[0])
            snprintf(err.file, sizeof err.file, "%s", r->file);
        return cmd_error(&err);
    }
    r->info = asp_measured_get_info(r->measured);
    r->loss = j->options.loss;
    for (int i = 0; asp_losses()[i]; i++)
        if (!strcmp(asp_losses()[i]->name, r->loss))
            r->loss_index = i;
    r->seed = j->options.seed;
    r->starts = j->options.starts;
    r->mask = j->options.mask;
    r->specular_limit = j->options.specular_limit;
    r->result = result;
    r->best = report_best(r);
    int status = show(j, r);
    for (size_t k = 0; k < sizeof r->sphere / sizeof *r->sphere; k++)
        free(r->sphere[k]);
    free(r->geometry);
    free(result);
    return status;
}

static int fit_file(job *j, const char *path)
{
    asp_error err;
    const char *slash = strrchr(path, '/');
    asp_measured *measured = asp_measured_read(path, &err);
    if (!measured)
        return cmd_error(&err);
    report r = { .title = slash ? slash + 1 : path, .file = path, .measured = measured };
    int status = fit_one(j, &r);
    asp_measured_free(measured);
    return status;
}

static int fit_fabricated(job *j)
{
    asp_error err;
    asp_fabrication made = asp_fabrication_default();
    asp_fabrication_report truth;
    cmd_progress bar = cmd_progress_begin("trace a rough surface");
    asp_measured *measured = asp_fabricate(&made, cmd_progress_show, &bar, &truth, &err);
    cmd_progress_end(&bar);
    if (!measured)
        return cmd_error(&err);
    report r = { .title = "fabricated", .measured = measured, .made = &made, .truth = &truth };
    int status = fit_one(j, &r);
    asp_measured_free(measured);
    return status;
}

/* ------------------------------------------------------------------ the command */

static int finish(job *j)
{
    if (!j->json)
        return CMD_OK;
    json_t *out = json_pack("{s:O}", "fits", j->all);
    return out ? cmd_print_json(out) : cmd_failed("out of memory");
}

/* Can the folder be made, or written to? Nothing is left of the attempt. */
static int try_folder(const char *path)
{
    int made = 0;
    cmd_hold();
    int status = make_folder(path, &made);
    if (!status && access(path, W_OK | X_OK))
        status = cmd_failed("%s: cannot write there: %s", path, strerror(errno));
    if (made && rmdir(path)) {
        /* somebody else has put something there meanwhile */
    }
    cmd_release();
    return status;
}

static int all_of(const cmd_args *args, job *j)
{
    size_t files = cmd_operand_count(args);
    int status = CMD_OK, fabricate = cmd_given(args, "fabricate") > 0;
    if (!files && !fabricate)
        return cmd_usage("fit: name a measurement, or give --fabricate");
    j->several = files + (size_t)fabricate > 1;
    j->entry = calloc(files + 1, sizeof *j->entry);
    j->all = json_array();
    if (!j->entry || !j->all)
        return cmd_failed("out of memory");
    for (size_t i = 0; i < files && !status; i++)         /* refused now rather than after minutes */
        if (access(cmd_operand(args, i), R_OK))
            status = cmd_failed("%s: %s", cmd_operand(args, i), strerror(errno));
    if (!status && j->folder)
        status = try_folder(j->folder);
    if (!status && fabricate)
        status = fit_fabricated(j);
    for (size_t i = 0; i < files && !status; i++)
        status = fit_file(j, cmd_operand(args, i));
    if (!status)
        status = finish(j);
    return status;
}

static int run(const cmd_args *args)
{
    job j = { .folder = cmd_text(args, "output"), .json = cmd_given(args, "json") > 0,
              .spp = (int)cmd_integer(args, "spp") };
    j.options.seed = (uint64_t)cmd_integer(args, "seed");
    j.options.starts = (int)cmd_integer(args, "starts");
    j.options.specular_limit = cmd_number(args, "specular-limit");
    int status = parse_models(args, &j);
    if (!status)
        status = parse_loss(args, &j);
    if (!status && cmd_given(args, "mask"))
        status = cmd_mask(args, "mask", &j.options.mask);
    if (!status)
        status = all_of(args, &j);
    for (size_t i = 0; i < j.entries; i++)
        free(j.entry[i].summary);
    free(j.entry);
    json_decref(j.all);
    return status;
}

static const cmd_option options[] = {
    { "output", 'o', "DIR", CMD_TEXT,
      .help = "write DIR/report.html and DIR/fit.json; several files: a folder each, and an index" },
    { "ndf", 0, "NAME,...", CMD_TEXT,
      .help = "the distributions to fit; default: all that are not another one's parametrisation" },
    { "loss", 0, "NAME", CMD_TEXT, .initial = "log_relative",
      .help = "what is minimised: nad, log or log_relative" },
    { "fabricate", 0, NULL, CMD_FLAG,
      .help = "fit a measurement traced from an explicit rough surface with known statistics" },
    { "mask", 0, "NAME", CMD_TEXT, .help = "masking; default: correlated" },
    { "specular-limit", 0, "X", CMD_NUMBER, 0, 1000, .low_open = 1, .initial = "1",
      .help = "highest specular colour; above 1 facets may return more than they receive" },
    { "starts", 0, "N", CMD_INTEGER, 1, 64, .initial = "4", .help = "searches per distribution" },
    { "seed", 's', "N", CMD_INTEGER, 0, 9007199254740992.0, .initial = "0",
      .help = "moves the places where searches start" },
    { "spp", 0, "N", CMD_INTEGER, 1, 65536, .initial = "64",
      .help = "samples per pixel of the spheres in the report" },
    { "json", 0, NULL, CMD_FLAG, .help = "write JSON to standard output instead of a table" },
    CMD_END
};

const cmd_record cmd_fit = {
    "fit", "fit distributions to a measurement and write a report", "[FILE...]", 0, -1,
    "Fits f = diffuse/pi + specular F(eta) D G2 / (4 cos cos) with each distribution\n"
    "and prints errors and parameters with their uncertainties (one standard\n"
    "deviation; `limit`: the value lies at an end of its range; a range in\n"
    "parentheses: the data leave it open).\n"
    "\n"
    "  asperity fit chm_mint_rgb.bsdf -o mint      and open mint/report.html\n"
    "  asperity fit --ndf ggx,student_t --loss log --json paper_white_rgb.bsdf\n"
    "\n"
    "nad            sum w |m - d| / sum w d, w = cos(theta_i) cos(theta_o)\n"
    "log            rms of log((1 + m cos(theta_i)) / (1 + d cos(theta_i)))\n"
    "log_relative   rms of log((m + 0.001/sr) / (d + 0.001/sr)): peak and tail alike\n"
    "\n"
    "Stops at the first file that cannot be read or fitted; nothing is written for\n"
    "it, and the index lists those before it. The same file, options and seed give\n"
    "the same numbers.",
    options, run
};
