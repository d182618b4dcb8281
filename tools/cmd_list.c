/* cmd_list.c - what there is: distributions, materials, metals, maskings, file formats, losses, laws
 *
 * One tree is built from the tables of the library; --json writes it as it is, otherwise it is
 * printed, so that the two cannot disagree. */
#include "cmd.h"
#include "asperity_ndf.h"
#include "bsdf/bsdf.h"
#include "data/measured.h"
#include "list_page.h"

#include <math.h>
#include <string.h>

/* ------------------------------------------------------------------ what has no table below */

#define RIGHT_ANGLE 1.5707963267948966

/* The keys of a slope map; tests/test_cli.py tries both ends of each against the parser. */
static const asp_param slope_keys[] = {
    { "alpha", 1e-5, 0, 100, NAN, "roughness along both axes" },
    { "alpha_x", 1e-5, 0, 100, NAN, "roughness along x (with alpha_y, instead of alpha)" },
    { "alpha_y", 1e-5, 0, 100, NAN, "roughness along y" },
    { "rotation", -1e4, 0, 1e4, 0, "turns the axes from x towards y, radians" },
    { "rho", -1, 1, 1, 0, "correlation of the axes, instead of rotation" },
    { "mean_x", -100, 0, 100, 0, "mean slope along x" },
    { "mean_y", -100, 0, 100, 0, "mean slope along y" },
    { NULL, 0, 0, 0, 0, NULL }
};
static const asp_param ellipsoid_keys[] = {
    { "alpha", 1e-5, 0, 100, NAN, "roughness along both axes" },
    { "alpha_x", 1e-5, 0, 100, NAN, "roughness along x (with alpha_y, instead of alpha)" },
    { "alpha_y", 1e-5, 0, 100, NAN, "roughness along y" },
    { "theta_x", -RIGHT_ANGLE, 0, RIGHT_ANGLE, 0, "tilts the normals to +y, radians" },
    { "theta_y", -RIGHT_ANGLE, 0, RIGHT_ANGLE, 0, "tilts the normals to -x, radians" },
    { "theta_z", -1e4, 0, 1e4, 0, "turns the distribution by -theta_z, radians" },
    { NULL, 0, 0, 0, 0, NULL }
};

/* Distributions that are nothing without data, and what is no slope distribution: no rows of asp_models(). */
static const struct made { const char *name, *title, *source; } made[] = {
    { "tabulated", "slopes=0/.../r,density=d/.../d[,tail=power]: a round density of slopes by samples",
      "docs/tabulated.md; prepared numerically" },
    { "histogram", "file=PATH[,bins=N][,range=R]: counted slopes, or those of a height field",
      "docs/tabulated.md; exact sums over cells" },
    { "sggx", "microflakes of the ellipsoid S = A^T A, in C: asperity_study.h",
      "Walter et al. 2014, sec. 5.2; Heitz et al. 2015" },
};

static const struct mask { const char *name, *also, *title; } masks[] = {
    { "correlated", "height_correlated", "G2 = 1/(1 + Lambda_i + Lambda_o); the default" },
    { "uncorrelated", "separable", "G2 = G1(wi) G1(wo)" },
    { "v_cavity", NULL, "the grooves of Torrance and Sparrow" },
    { "min", NULL, "skewed surfaces: G1 = min(1, w.z/sigma); the default" },
    { "wall", NULL, "skewed surfaces: closed by vertical walls" },
};

/* ------------------------------------------------------------------ the tree */

static json_t *number(double value)          /* JSON has no infinities */
{
    if (isnan(value))
        return json_null();
    return isinf(value) ? json_string(value < 0 ? "-inf" : "inf") : json_real(value);
}

static json_t *text(const char *value) { return value ? json_string(value) : json_null(); }

static json_t *parameter(const asp_param *p)
{
    return json_pack("{s:s, s:o, s:b, s:o, s:b, s:o, s:s}", "name", p->name, "low", number(p->low),
                     "low_refused", p->low_open, "high", number(p->high), "high_refused",
                     p->low_open && p->high == -p->low, "default", number(p->initial), "what",
                     p->what);
}

static json_t *parameters(const asp_param *p, size_t count)
{
    json_t *list = json_array();
    for (size_t i = 0; i < count && p[i].name; i++)
        json_array_append_new(list, parameter(&p[i]));
    return list;
}

static json_t *distributions(void)
{
    json_t *list = json_array();
    for (const asp_model *const *m = asp_models(); *m; m++)
        json_array_append_new(list, json_pack("{s:s, s:o, s:s, s:s, s:s, s:f, s:o}",
            "name", (*m)->name, "also", text((*m)->alias), "title", (*m)->title,
            "source", (*m)->source,
            "map", (*m)->keys == ASP_KEYS_ELLIPSOID ? "ellipsoid" : "slope",
            "alpha_default", (*m)->alpha, "parameters",
            parameters((*m)->params, (*m)->param_count)));
    return list;
}

static json_t *from_data(void)
{
    json_t *list = json_array();
    for (size_t i = 0; i < sizeof made / sizeof *made; i++)
        json_array_append_new(list, json_pack("{s:s, s:s, s:s}", "name", made[i].name, "title", made[i].title,
                                              "source", made[i].source));
    return list;
}

static json_t *materials(void)
{
    json_t *list = json_array();
    for (const asp_bsdf *const *b = asp_bsdfs(); *b; b++) {
        json_t *keys = json_array();
        for (const aspi_bsdf_key *k = (*b)->keys; k->name; k++)
            json_array_append_new(keys, json_pack("{s:s, s:s}", "name", k->name, "what", k->what));
        json_array_append_new(list, json_pack("{s:s, s:s, s:s, s:o}", "name", (*b)->name, "title",
                                              (*b)->title, "source", (*b)->source, "parameters",
                                              keys));
    }
    return list;
}

static json_t *colour(asp_rgb c) { return json_pack("[f, f, f]", c.r, c.g, c.b); }

static json_t *metals(void)
{
    size_t count;
    const asp_metal *metal = asp_metals(&count);
    json_t *list = json_array();
    for (size_t i = 0; i < count; i++)
        json_array_append_new(list, json_pack("{s:s, s:s, s:o, s:o, s:o}", "name", metal[i].name,
            "source", metal[i].source, "eta", colour(metal[i].eta), "k", colour(metal[i].k),
            "f0", colour(metal[i].f0)));
    return list;
}

static json_t *maskings(void)
{
    json_t *list = json_array();
    for (size_t i = 0; i < sizeof masks / sizeof *masks; i++)
        json_array_append_new(list, json_pack("{s:s, s:o, s:s}", "name", masks[i].name, "also",
                                              text(masks[i].also), "title", masks[i].title));
    return list;
}

static json_t *file_formats(void)
{
    json_t *list = json_array();
    for (const aspi_format *const *f = aspi_formats; *f; f++)
        json_array_append_new(list, json_pack("{s:s, s:s}", "name", (*f)->name, "title",
                                              (*f)->looks));
    return list;
}

static json_t *losses(void)
{
    json_t *list = json_array();
    for (const asp_loss *const *l = asp_losses(); *l; l++)
        json_array_append_new(list, json_pack("{s:s, s:s, s:s}", "name", (*l)->name, "title",
                                              (*l)->title, "source", (*l)->definition));
    return list;
}

static json_t *laws(void)
{
    const asp_law *law;
    json_t *list = json_array();
    for (size_t i = 0; (law = asp_laws(i)) != NULL; i++)
        json_array_append_new(list, json_pack("{s:s, s:s, s:s, s:s}", "name", law->name, "title",
                                              law->says, "source", law->source, "unit",
                                              law->unit));
    return list;
}

static json_t *slope_map(void) { return parameters(slope_keys, 99); }
static json_t *ellipsoid_map(void) { return parameters(ellipsoid_keys, 99); }

static const struct section {
    const char *name, *heading;
    json_t *(*make)(void);
} sections[] = {
    { "distributions", "Distributions, --ndf name:key=value,...", distributions },
    { "from_data", "Made of data, and microflakes", from_data },
    { "slope_map", "Keys of every distribution but the ellipsoid", slope_map },
    { "ellipsoid_map", "Keys of the ellipsoid; or the matrix a11 ... a33, or s11 s12 s13 s22 s23 "
      "s33 of A^T A", ellipsoid_map },
    { "materials", "Materials, --material name:key=value,...,ndf=(...),mask=...", materials },
    { "metals", "Metals, metal=NAME; f0: reflectance at normal incidence, linear sRGB", metals },
    { "masks", "Maskings, --mask; one of the first three and one of the last two join by +",
      maskings },
    { "formats", "Measurement files that are read; convert writes merl and csv", file_formats },
    { "losses", "Losses of `asperity fit`", losses },
    { "laws", "Laws of `asperity check`", laws },
};
enum { SECTIONS = sizeof sections / sizeof *sections };

/* ------------------------------------------------------------------ the tree on a screen */

static const char *word(const json_t *item, const char *key)
{
    return json_string_value(json_object_get(item, key));
}

static void put_number(const json_t *value)
{
    if (json_is_string(value))
        fputs(json_string_value(value), stdout);
    else
        printf("%g", json_number_value(value));
}

static void print_parameter(const json_t *p, int indent)
{
    const json_t *low = json_object_get(p, "low"), *initial = json_object_get(p, "default");
    printf("%*s%-10s", indent, "", word(p, "name"));
    if (low) {
        printf(" %s", json_is_true(json_object_get(p, "low_refused")) ? "(" : "[");
        put_number(low);
        fputs(", ", stdout);
        put_number(json_object_get(p, "high"));
        fputs(json_is_true(json_object_get(p, "high_refused")) ? ")" : "]", stdout);
        if (!json_is_null(initial)) {
            fputs(", default ", stdout);
            put_number(initial);
        }
        fputs(":", stdout);
    }
    printf(" %s\n", word(p, "what"));
}

static void print_item(const json_t *item)
{
    const json_t *f0 = json_object_get(item, "f0"), *list = json_object_get(item, "parameters");
    const json_t *alpha = json_object_get(item, "alpha_default");
    if (word(item, "what")) {
        print_parameter(item, 2);
        return;
    }
    printf("  %s%s%s", word(item, "name"), word(item, "also") ? ", " : "",
           word(item, "also") ? word(item, "also") : "");
    if (word(item, "title"))
        printf(": %s", word(item, "title"));
    if (f0)
        printf("  f0 = %.3f/%.3f/%.3f", json_number_value(json_array_get(f0, 0)),
               json_number_value(json_array_get(f0, 1)), json_number_value(json_array_get(f0, 2)));
    if (alpha)
        printf(" (alpha: default %g)", json_number_value(alpha));
    fputs("\n", stdout);
    if (word(item, "source"))
        printf("      %s\n", word(item, "source"));
    for (size_t i = 0; i < json_array_size(list); i++)
        print_parameter(json_array_get(list, i), 6);
}

static int run(const cmd_args *args)
{
    const char *names[SECTIONS + 1] = { NULL }, *only = cmd_operand(args, 0);
    for (int i = 0; i < SECTIONS; i++)
        names[i] = sections[i].name;
    if (only && cmd_find(only, names) < 0)
        return cmd_unknown("unknown section", only, names);
    if (cmd_given(args, "markdown")) {
        if (only && strcmp(only, "distributions") != 0)
            return cmd_usage("--markdown writes the page of the distributions, not of %s", only);
        list_page();
        return CMD_OK;
    }
    json_t *tree = json_object();
    for (int i = 0; i < SECTIONS; i++)
        if (!only || strcmp(only, names[i]) == 0)
            json_object_set_new(tree, names[i], sections[i].make());
    if (cmd_given(args, "json"))
        return cmd_print_json(tree);
    for (int i = 0, first = 1; i < SECTIONS; i++) {
        const json_t *list = json_object_get(tree, names[i]);
        if (!list)
            continue;
        printf("%s%s\n", first ? "" : "\n", sections[i].heading);
        for (size_t j = 0; j < json_array_size(list); j++)
            print_item(json_array_get(list, j));
        first = 0;
    }
    json_decref(tree);
    return CMD_OK;
}

static const cmd_option options[] = {
    { "json", 0, NULL, CMD_FLAG, .help = "write JSON; infinite ends of ranges are strings" },
    { "markdown", 0, NULL, CMD_FLAG, .help = "write the page of the distributions" },
    CMD_END
};

const cmd_record cmd_list = {
    "list", "list distributions, materials, metals, maskings, formats, losses and laws",
    "[SECTION]", 0, 1,
    "With parameters, ranges, defaults and sources. SECTION is one of distributions,\n"
    "from_data, slope_map, ellipsoid_map, materials, metals, masks, formats, losses,\n"
    "laws.",
    options, run
};
