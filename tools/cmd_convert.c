/* cmd_convert.c - measurement files from one format into another, models as measurements */
#include "writers.h"

static asp_rgb evaluate(const void *material, asp_vec3 wi, asp_vec3 wo)
{
    return asp_eval(material, wi, wo);
}

/* The measurement: read, or a model evaluated at every cell. NULL with the error printed. */
static asp_measured *source(const cmd_args *args, int modelled, int *status)
{
    asp_error err;
    asp_material material;
    asp_measured *data;
    if (!modelled) {
        data = asp_measured_read(cmd_operand(args, 0), &err);
    } else {
        const char *spec = cmd_text(args, cmd_given(args, "ndf") ? "ndf" : "material");
        *status = cmd_surface(args, &material);
        if (*status != CMD_OK)
            return NULL;
        data = asp_measured_from_function(evaluate, &material, spec, &err);
    }
    if (!data)
        *status = cmd_error(&err);
    return data;
}

static int run(const cmd_args *args)
{
    int modelled = cmd_given(args, "material") || cmd_given(args, "ndf"), status = CMD_OK;
    size_t files = cmd_operand_count(args);
    if (modelled && files != 1)
        return cmd_usage("with --material or --ndf there is one file name, OUT; '%s' is one too "
                         "many", cmd_operand(args, 1));
    if (!modelled && files != 2)
        return cmd_usage("needed are IN and OUT, or --material SPEC and OUT");
    const char *path = cmd_operand(args, files - 1);
    const writer *to;
    status = writer_choose(args, path, &to);
    asp_measured *data = status == CMD_OK ? source(args, modelled, &status) : NULL;
    if (data)
        status = writer_write(to, data, path);
    asp_measured_free(data);
    return status;
}

static const cmd_option options[] = {
    { "to", 0, WRITER_NAMES, CMD_CHOICE, .help = "the format; default: by the ending of OUT" },
    { "material", 0, "SPEC", CMD_TEXT, .help = "write a material as a measurement" },
    { "ndf", 0, "SPEC", CMD_TEXT, .help = "or a distribution's perfect mirror facets" },
    { "mask", 0, "NAME", CMD_TEXT, .help = "masking, as in `asperity list`" },
    CMD_END
};

const cmd_record cmd_convert = {
    "convert", "convert a measurement file, or write a model as one", "[IN] OUT", 1, 2,
    "IN may have any format of `asperity list`; it is recognised by content. OUT is a\n"
    "MERL table (.binary, .merl: 90 x 90 x 180 half/difference angles) or CSV.\n"
    "\n"
    "  asperity convert gold-paint.binary gold-paint.csv\n"
    "  asperity convert --material 'conductor:metal=Cu,ndf=(ggx:alpha=0.1)' cu.binary",
    options, run
};
