/* cmd_fabricate.c - a measurement made by rays on a rough surface whose slopes are known */
#include "writers.h"

#include <math.h>
#include <string.h>

static int find_metal(const cmd_args *args, const asp_metal **out)
{
    const char *names[128] = { NULL }, *name = cmd_text(args, "metal");
    size_t count;
    const asp_metal *metals = asp_metals(&count);
    *out = NULL;
    if (strcmp(name, "none") == 0)
        return CMD_OK;
    *out = asp_find_metal(name);
    for (size_t i = 0; i < count && i < 126; i++)
        names[i] = metals[i].name;
    names[count < 126 ? count : 126] = "none";
    return *out ? CMD_OK : cmd_unknown("unknown metal", name, names);
}

static json_t *report_json(const asp_fabrication *made, const asp_fabrication_report *r)
{
    const asp_slope_statistics *s = &r->slopes;
    return json_pack("{s:{s:I, s:f, s:f, s:f, s:f, s:f, s:f}, s:I, s:I, s:[f,f,f], s:[f,f,f], s:f, "
                     "s:I, s:f, s:s}",
                     "slopes", "facets", (json_int_t)s->facets, "rms_x", s->rms_x, "rms_y", s->rms_y,
                     "alpha", s->alpha, "gamma", s->gamma, "alpha_ggx", s->alpha_ggx,
                     "alpha_beckmann", s->alpha_beckmann,
                     "rays", (json_int_t)r->rays, "lost", (json_int_t)r->lost,
                     "albedo", r->albedo.r, r->albedo.g, r->albedo.b,
                     "multiple", r->multiple.r, r->multiple.g, r->multiple.b,
                     "bounces", r->bounces, "cells", (json_int_t)r->cells, "noise", r->noise,
                     "metal", made->metal ? made->metal->name : "none");
}

static void report_text(const asp_fabrication_report *r)
{
    const asp_slope_statistics *s = &r->slopes;
    printf("facets    %zu, rms slope %.5g along x, %.5g along y\n", s->facets, s->rms_x, s->rms_y);
    printf("slopes    student_t:alpha=%.5g,gamma=%.5g by maximum likelihood%s\n", s->alpha, s->gamma,
           s->gamma >= 100 ? " (100 stands for infinity)" : "");
    printf("rays      %zu, lost %zu, facets met per ray %.4g\n", r->rays, r->lost, r->bounces);
    printf("albedo    %.4f/%.4f/%.4f, by two facets or more %.4f/%.4f/%.4f of it\n", r->albedo.r,
           r->albedo.g, r->albedo.b, r->multiple.r, r->multiple.g, r->multiple.b);
    printf("noise     %.2g of a cell's value, median, in %zu cells\n", r->noise, r->cells);
}

static int run(const cmd_args *args)
{
    asp_error err;
    asp_fabrication what = asp_fabrication_default();
    asp_fabrication_report report;
    const writer *to;
    const char *path = cmd_operand(args, 0);
    int status = find_metal(args, &what.metal);
    if (status == CMD_OK)
        status = writer_choose(args, path, &to);
    if (status != CMD_OK)
        return status;
    what.surface.seed = (uint64_t)cmd_integer(args, "seed");
    what.surface.size = (int)cmd_integer(args, "size");
    what.surface.correlation = cmd_number(args, "correlation");
    what.surface.patch = cmd_number(args, "patch");
    what.surface.alpha = cmd_number(args, "alpha");
    what.surface.gamma = cmd_number(args, "gamma");
    what.rays = (size_t)cmd_integer(args, "rays");
    what.threads = (int)cmd_integer(args, "threads");
    cmd_progress bar = cmd_progress_begin("fabricate");
    asp_measured *data = asp_fabricate(&what, cmd_progress_show, &bar, &report, &err);
    cmd_progress_end(&bar);
    if (!data && err.status == ASP_EINVAL) {
        char line[640];
        return cmd_usage("--%s", asp_error_text(&err, line, sizeof line));
    }
    if (!data)
        return cmd_error(&err);
    status = writer_write(to, data, path);
    asp_measured_free(data);
    if (status == CMD_OK && cmd_given(args, "json"))
        status = cmd_print_json(report_json(&what, &report));
    else if (status == CMD_OK)
        report_text(&report);
    return status;
}

static const cmd_option options[] = {
    { "alpha", 0, "X", CMD_NUMBER, 1e-3, 1, .initial = "0.25", .help = "roughness of the slopes" },
    { "gamma", 0, "X", CMD_NUMBER, 1.6, INFINITY, .initial = "3",
      .help = "shape of their distribution, that of student_t; inf: beckmann" },
    { "metal", 0, "NAME", CMD_TEXT, .initial = "Au",
      .help = "as in `asperity list metals`, or none: reflects everything" },
    { "size", 0, "N", CMD_INTEGER, 64, 4096, .initial = "1024",
      .help = "points along a side of the surface, a power of two" },
    { "correlation", 0, "X", CMD_NUMBER, 2, 512, .initial = "8",
      .help = "correlation length of the heights in points, at most size/8" },
    { "patch", 0, "X", CMD_NUMBER, 1, 64, .initial = "4",
      .help = "correlation length of the local roughness in correlation lengths" },
    { "rays", 0, "N", CMD_INTEGER, 1e4, 1e10, .initial = "12000000", .help = "how many" },
    { "seed", 's', "N", CMD_INTEGER, 0, 9007199254740991.0, .initial = "1",
      .help = "of the surface and the rays" },
    { "threads", 0, "N", CMD_INTEGER, 1, 256, .initial = "2",
      .help = "the measurement does not depend on it" },
    { "to", 0, WRITER_NAMES, CMD_CHOICE, .help = "the format; default: by the ending of OUT" },
    { "json", 0, NULL, CMD_FLAG, .help = "report as JSON" },
    CMD_END
};

const cmd_record cmd_fabricate = {
    "fabricate", "measure a rough surface of known slopes with rays", "OUT", 1, 1,
    "Makes a random height field whose facets have the slopes of student_t, and\n"
    "measures it as a gonioreflectometer would, all reflections from facet to facet\n"
    "included: a measurement whose true distribution is known, to try a fit on.\n"
    "\n"
    "  asperity fabricate --alpha 0.3 --gamma 2.5 --metal Al rough.binary\n"
    "  asperity fit rough.binary",
    options, run
};
