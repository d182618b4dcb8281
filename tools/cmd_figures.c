/* cmd_figures.c - the figures of the source documents, each as SVG, PNG and numbers */
#include "figures.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <errno.h>
#include <sys/stat.h>

enum { MOST = 96 };

static size_t all_figures(const figure *out[MOST])
{
    static const figure *const tables[] = { figures_notebook, figures_std };
    static figure models[FIGURE_MODELS];
    size_t count = 0, more = figures_models(models, FIGURE_MODELS);
    for (size_t t = 0; t < sizeof tables / sizeof *tables; t++)
        for (const figure *f = tables[t]; f->name && count < MOST; f++)
            if (!f->available || f->available(f))
                out[count++] = f;
    for (size_t i = 0; i < more && count < MOST; i++)
        out[count++] = &models[i];
    return count;
}

void figure_progress(const figure_job *job, double done)
{
    cmd_progress_show(job->progress, job->from + (job->to - job->from) * done);
}

/* ------------------------------------------------------------------ the three files */

static int write_bytes(const char *path, const void *bytes, size_t size)
{
    cmd_out out;
    int status = cmd_out_open(&out, path);
    if (status != CMD_OK)
        return status;
    cmd_out_write(&out, bytes, size);
    return cmd_out_close(&out);
}

static int write_png(const char *path, const char *svg, double scale)
{
    unsigned char *bytes = NULL;
    size_t size = 0;
    int status = svg_png(svg, scale, &bytes, &size);
    if (status == CMD_OK)
        status = write_bytes(path, bytes, size);
    free(bytes);
    return status;
}

static int write_numbers(const char *path, const figure *f, const drawing *d)
{
    cmd_out out;
    int status = cmd_out_open(&out, path);
    if (status != CMD_OK)
        return status;
    drawing_numbers(d, f->x_name, &out);
    return cmd_out_close(&out);
}

static int write_figure(const cmd_args *args, const figure *f, const drawing *d)
{
    char path[1024];
    const char *folder = cmd_text(args, "output");
    char *svg = drawing_svg(d, f->title);
    if (!svg)
        return CMD_FAILED;
    snprintf(path, sizeof path, "%s/%s.svg", folder, f->name);
    int status = write_bytes(path, svg, strlen(svg));
    snprintf(path, sizeof path, "%s/%s.png", folder, f->name);
    if (status == CMD_OK && !cmd_given(args, "no-png"))
        status = write_png(path, svg, cmd_number(args, "scale"));
    snprintf(path, sizeof path, "%s/%s.csv", folder, f->name);
    if (status == CMD_OK)
        status = write_numbers(path, f, d);
    free(svg);
    return status;
}

/* ------------------------------------------------------------------ which ones */

static int choose(const cmd_args *args, const figure *chosen[MOST], size_t *count)
{
    const figure *all[MOST];
    const char *names[MOST + 1];
    size_t known = all_figures(all);
    for (size_t i = 0; i < known; i++)
        names[i] = all[i]->name;
    names[known] = NULL;
    *count = 0;
    for (size_t i = 0; i < cmd_operand_count(args); i++) {
        int index = cmd_find(cmd_operand(args, i), names);
        if (index < 0)
            return cmd_unknown("unknown figure", cmd_operand(args, i), names);
        int again = 0;
        for (size_t k = 0; k < *count; k++)
            again |= chosen[k] == all[index];
        if (!again)
            chosen[(*count)++] = all[index];
    }
    if (!*count)
        for (; *count < known; (*count)++)
            chosen[*count] = all[*count];
    return CMD_OK;
}

static void list(void)
{
    const figure *all[MOST];
    size_t known = all_figures(all);
    for (size_t i = 0; i < known; i++)
        printf("%-34s %s [%s]\n", all[i]->name, all[i]->title, all[i]->source);
}

/* docs/figures.md; the distributions' own are on the page of the distributions. */
static void markdown(void)
{
    const figure *all[MOST];
    size_t known = all_figures(all);
    printf("# Figures of the source documents\n\n"
           "Written by `asperity figures --markdown`; do not edit by hand. The pictures and their numbers come\n"
           "from `asperity figures`, each drawn again from this library: the static plots of the notebook to\n"
           "\"Background: Physics and Math of Shading\" (Hoffman 2013) and the charts of \"STD: Student's\n"
           "t-Distribution of Slopes for Microfacet Based BSDFs\" (Ribardiere et al. 2017). A distribution has\n"
           "the same colour everywhere. At a curve stands the number that tells it from its family, in the\n"
           "comparisons those of both. The curves of every distribution are in\n"
           "[distributions.md](distributions.md).\n\n");
    for (size_t i = 0; i < known; i++)
        if (strncmp(all[i]->name, "ndf-", 4) != 0) {
            printf("## %s\n\n%s (%s).", all[i]->name, all[i]->title, all[i]->source);
            if (all[i]->note)
                printf(" %s", all[i]->note);
            printf("\n\n![%s](images/figures/%s.svg)\n\n", all[i]->title, all[i]->name);
        }
}

static int make_folder(const char *path)
{
    if (mkdir(path, 0777) == 0 || errno == EEXIST)
        return CMD_OK;
    return cmd_failed("%s: %s", path, strerror(errno));
}

static int make_all(const cmd_args *args, const figure *const *chosen, size_t count)
{
    drawing *d = calloc(1, sizeof *d);
    int status = d ? CMD_OK : cmd_failed("out of memory");
    double total = 0, before = 0;
    cmd_progress bar = cmd_progress_begin("figures");
    for (size_t i = 0; i < count; i++)
        total += chosen[i]->seconds;
    for (size_t i = 0; status == CMD_OK && i < count; i++) {
        figure_job job = { args, &bar, before / total, (before + chosen[i]->seconds) / total, d };
        status = chosen[i]->make(chosen[i], &job);
        if (status == CMD_OK)
            status = write_figure(args, chosen[i], d);
        drawing_free(d);
        before += chosen[i]->seconds;
        cmd_progress_show(&bar, before / total);
    }
    cmd_progress_end(&bar);
    free(d);
    return status;
}

static int run(const cmd_args *args)
{
    const figure *chosen[MOST];
    size_t count;
    int status = choose(args, chosen, &count);
    if (status != CMD_OK)
        return status;
    if (cmd_given(args, "list")) {
        list();
        return CMD_OK;
    }
    if (cmd_given(args, "markdown")) {
        markdown();
        return CMD_OK;
    }
    if (!cmd_given(args, "no-png") && !svg_png_available())
        return cmd_failed("built without librsvg, which makes PNG of SVG: give --no-png, or install "
                          "librsvg2-dev and build again");
    status = make_folder(cmd_text(args, "output"));
    return status == CMD_OK ? make_all(args, chosen, count) : status;
}

static const cmd_option options[] = {
    { "output", 'o', "DIR", CMD_TEXT, .initial = "out/figures",
      .help = "where the files go; made if it is not there" },
    { "list", 'l', NULL, CMD_FLAG, .help = "say which figures there are, and draw none" },
    { "markdown", 0, NULL, CMD_FLAG, .help = "write the page of the figures, and draw none" },
    { "no-png", 0, NULL, CMD_FLAG, .help = "SVG and numbers only" },
    { "scale", 0, "N", CMD_NUMBER, 0.25, 8, .initial = "2", .help = "pixels of the PNG per px" },
    { "cost", 0, "FILE", CMD_TEXT,
      .help = "std-4: draw the times in this file, which the command wrote before, and measure none" },
    CMD_END
};

const cmd_record cmd_figures = {
    "figures", "draw the figures of the source documents again: SVG, PNG and numbers",
    "[NAME...]", 0, -1,
    "The static plots of the notebook to `Background: Physics and Math of Shading`,\n"
    "the charts of the STD paper, and density and masking of each distribution, all\n"
    "drawn from this library. Of each figure three files: NAME.svg, NAME.png and its\n"
    "numbers, NAME.csv, with the columns panel, quantity, curve, the horizontal axis,\n"
    "value. Without a name: all of them.\n"
    "\n"
    "  asperity figures --list\n"
    "  asperity figures -o plots std-9 notebook-abc",
    options, run
};
