/* cmd_convert.c - measurement files from one format into another, models as measurements */
#include "writers.h"

#include <math.h>
#include <string.h>

static asp_rgb evaluate(const void *material, asp_vec3 wi, asp_vec3 wo)
{
    return asp_eval(material, wi, wo);
}

static const double degree = 3.14159265358979323846 / 180;

/* Directions of the half vector (theta_h, phi_h) and wi at (theta_d, phi_d) around it. */
static void from_half(double theta_h, double phi_h, double theta_d, double phi_d, asp_vec3 *wi,
                      asp_vec3 *wo)
{
    double ch = cos(theta_h), sh = sin(theta_h), cp = cos(phi_h), sp = sin(phi_h);
    double a = sin(theta_d) * cos(phi_d), b = sin(theta_d) * sin(phi_d), c = cos(theta_d);
    *wi = (asp_vec3){ a * ch * cp - b * sp + c * sh * cp, a * ch * sp + b * cp + c * sh * sp,
                      c * ch - a * sh };
    *wo = (asp_vec3){ 2 * c * sh * cp - wi->x, 2 * c * sh * sp - wi->y, 2 * c * ch - wi->z };
}

/* Is f the same at eight azimuths of the half vector, from slopes of 1e-6 to 4 and three differences?
 * Sheared or stretched slopes change it by more than rounding does. */
static int is_isotropic(const asp_material *material)
{
    static const double difference[3][2] = { { 0, 0 }, { 25, 40 }, { 55, 100 } };
    for (int d = 0; d < 3; d++)
        for (double slope = 1e-6; slope < 4; slope *= 1.25) {
            double low = INFINITY, high = 0;
            for (int k = 0; k < 8; k++) {
                asp_vec3 wi, wo;
                from_half(atan(slope), (11 + 37 * k) * degree, difference[d][0] * degree,
                          difference[d][1] * degree, &wi, &wo);
                asp_rgb f = asp_eval(material, wi, wo);
                low = fmin(low, f.r + f.g + f.b);
                high = fmax(high, f.r + f.g + f.b);
            }
            if (high > 1e-20 && high - low > 1e-6 * high)
                return 0;
        }
    return 1;
}

static int anisotropic(const char *what)
{
    return cmd_failed("%s: its BRDF changes as the surface turns; MERL tables and their CSV hold "
                      "isotropic BRDFs only", what);
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
        if (*status == CMD_OK && !is_isotropic(&material))
            *status = anisotropic(spec);
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
    if (data && strcmp(to->name, "merl") == 0 && !asp_measured_get_info(data).isotropic)
        status = anisotropic(cmd_operand(args, 0));
    if (data && status == CMD_OK)
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
    "MERL table (.binary, .merl: 90 x 90 x 180 half/difference angles) or CSV. MERL\n"
    "tables hold isotropic BRDFs: an anisotropic measurement is written as CSV only,\n"
    "an anisotropic material not at all.\n"
    "\n"
    "  asperity convert gold-paint.binary gold-paint.csv\n"
    "  asperity convert --material 'conductor:metal=Cu,ndf=(ggx:alpha=0.1)' cu.binary",
    options, run
};
