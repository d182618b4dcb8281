/* cmd_render.c - a lit sphere of a material, a model or a measurement */
#include "cmd.h"

#include <string.h>

static asp_rgb measured(const void *context, asp_vec3 wi, asp_vec3 wo)
{
    return asp_measured_eval(context, wi, wo);
}

/* Refused before the rendering rather than after it. */
static int check_name(const cmd_args *args)
{
    static const char *const known[] = { ".png", ".exr", ".pfm" };
    const char *path = cmd_text(args, "output");
    int exr = cmd_ends_in(path, ".exr");
    if (cmd_given(args, "float") && !exr)
        return cmd_usage("--float goes with an .exr only, not with --output %s", path);
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (cmd_ends_in(path, known[i]))
            return CMD_OK;
    return cmd_usage("--output %s: the name must end in .png, .exr or .pfm", path);
}

/* Between listed geometries nothing is known: a picture of the nearest ones would show their
 * pattern and not the material. */
static int read_data(const char *path, asp_measured **out)
{
    asp_error err;
    *out = asp_measured_read(path, &err);
    if (!*out)
        return cmd_error(&err);
    if (asp_measured_get_info(*out).scattered)
        return cmd_failed("%s: the measurement lists geometries and cannot be rendered", path);
    return CMD_OK;
}

static int render(const cmd_args *args, asp_preview *look)
{
    asp_error err;
    asp_image image;
    asp_image_options form;
    memset(&form, 0, sizeof form);
    form.tone.exposure = cmd_number(args, "exposure");
    form.tone.soft = cmd_number(args, "soft");
    form.exr_float = cmd_given(args, "float") > 0;
    cmd_progress bar = cmd_progress_begin("render");
    look->progress = cmd_progress_show;
    look->progress_context = &bar;
    asp_status status = asp_preview_render(look, &image, &err);
    cmd_progress_end(&bar);
    if (status != ASP_OK)
        return cmd_error(&err);
    cmd_hold();
    status = asp_image_write(&image, cmd_text(args, "output"), &form, &err);
    cmd_release();
    asp_image_free(&image);
    return status == ASP_OK ? CMD_OK : cmd_error(&err);
}

static int run(const cmd_args *args)
{
    asp_material material;
    asp_measured *data = NULL;
    asp_environment environment = cmd_choice(args, "env") ? asp_environment_furnace(1)
                                                          : asp_environment_studio();
    asp_preview look;
    int status = check_name(args);
    memset(&look, 0, sizeof look);
    look.environment = &environment;
    look.width = look.height = (int)cmd_integer(args, "size");
    look.samples = (int)cmd_integer(args, "spp");
    look.seed = (uint32_t)cmd_integer(args, "seed");
    look.threads = (int)cmd_integer(args, "threads");
    look.field_of_view = 0;
    look.walk = cmd_given(args, "walk") > 0;
    if (status != CMD_OK)
        return status;
    if (cmd_given(args, "data")) {
        if (cmd_given(args, "ndf") || cmd_given(args, "material"))
            return cmd_usage("--data does not go with --ndf or --material");
        status = read_data(cmd_text(args, "data"), &data);
        look.function = measured;
        look.context = data;
    } else {
        status = cmd_surface(args, &material);
        look.material = &material;
        if (status == CMD_OK && look.walk)
            status = cmd_can_walk(&material);
    }
    if (status == CMD_OK)
        status = cmd_out_check(cmd_text(args, "output"));
    if (status == CMD_OK)
        status = render(args, &look);
    asp_measured_free(data);
    return status;
}

static const cmd_option options[] = {
    { "output", 'o', "FILE", CMD_TEXT, .required = 1,
      .help = "the picture: .png (8 bits, sRGB), .exr or .pfm (linear)" },
    { "material", 0, "SPEC", CMD_TEXT, .help = "the material" },
    { "ndf", 0, "SPEC", CMD_TEXT, .help = "or a distribution of perfect mirror facets" },
    { "mask", 0, "NAME", CMD_TEXT, .help = "masking, as in `asperity list`" },
    { "walk", 0, NULL, CMD_FLAG,
      .help = "multiple scattering between facets (conductor, dielectric, rough_diffuse)" },
    { "data", 0, "FILE", CMD_TEXT, .help = "or a measurement over a grid (merl, rgl); not one that lists geometries" },
    { "size", 0, "N", CMD_INTEGER, 1, 16384, .initial = "512", .help = "pixels along a side" },
    { "spp", 0, "N", CMD_INTEGER, 1, 65536, .initial = "64", .help = "samples per pixel" },
    { "env", 0, "studio|furnace", CMD_CHOICE, .initial = "studio",
      .help = "the light: a studio, or radiance 1 from everywhere, in which a surface that loses "
              "nothing disappears" },
    { "exposure", 0, "STOPS", CMD_NUMBER, -64, 64, .initial = "0", .help = "of the .png" },
    { "soft", 0, "X", CMD_NUMBER, 0, 1, .initial = "0.4",
      .help = "how much of the top of the .png's range rolls off highlights" },
    { "float", 0, NULL, CMD_FLAG, .help = "32-bit numbers in the .exr instead of 16-bit" },
    { "seed", 's', "N", CMD_INTEGER, 0, 4294967295.0, .initial = "0", .help = "of the noise" },
    { "threads", 0, "N", CMD_INTEGER, 0, 256, .initial = "0",
      .help = "0: as many as processors; the picture does not depend on it" },
    CMD_END
};

const cmd_record cmd_render = {
    "render", "render a lit sphere of a material or a measurement", "", 0, 0,
    "  asperity render --material 'conductor:metal=Au,ndf=(ggx:alpha=.2)' -o gold.png\n"
    "  asperity render --data chm_orange_rgb.bsdf -o orange.png\n"
    "\n"
    "Shows a bar with the time left when standard error is a terminal.",
    options, run
};
