/* specs.c - options that are distributions, materials, directions and maskings */
#include "frame.h"
#include "asperity_ndf.h"
#include "bsdf/bsdf.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Names of distributions, materials and metals (option ndf, material, or surface for either); `at_start` leaves those that a spec begins with. */
static void known_names(const char *option, int at_start, const char *names[128])
{
    size_t used = 0, metals;
    int material = strcmp(option, "ndf") != 0, either = strcmp(option, "surface") == 0;
    const asp_metal *metal = asp_metals(&metals);
    for (const asp_bsdf *const *b = asp_bsdfs(); material && *b && used < 127; b++)
        names[used++] = (*b)->name;
    for (const asp_model *const *m = asp_models(); (!material || either || !at_start) && *m && used < 127; m++)
        names[used++] = (*m)->name;
    for (size_t i = 0; !at_start && material && i < metals && used < 127; i++)
        names[used++] = metal[i].name;
    names[used] = NULL;
}

/* `--ndf ggx:alpha=-1: byte 10: alpha = -1 is outside ...`; with the name that was meant. `given` is what
 * stands before the text, option what it is. */
static int bad_value(const char *given, const char *option, const char *text, const asp_error *err)
{
    char line[640], what[700];
    const char *names[128], *nearest = NULL;
    asp_error_text(err, line, sizeof line);
    if (err->status == ASP_EUNKNOWN && strcmp(option, "mask") != 0) {
        int at_start = err->position == 0;
        known_names(option, at_start, names);
        if (at_start) {
            snprintf(what, sizeof what, "%s%s: unknown %s", given, text,
                     strcmp(option, "ndf") == 0 ? "distribution" : strcmp(option, "surface") ? "material"
                     : "distribution or material");
            return cmd_unknown(what, err->name, names);
        }
        nearest = cmd_nearest(err->name, names);
    }
    return cmd_usage("%s%s: %s%s%s%s", given, text, line, nearest ? "; did you mean '" : "",
                     nearest ? nearest : "", nearest ? "'?" : "");
}

int cmd_bad_ndf(const char *given, const char *spec, const asp_error *err)
{
    char line[640], known[512] = "";
    const char *names[128];
    size_t used = 0;
    int scatters = 0;
    for (const asp_bsdf *const *b = asp_bsdfs(); *b; b++)
        scatters |= strcmp((*b)->name, err->name) == 0;
    if (err->status != ASP_EUNKNOWN || err->position != 0)
        return cmd_usage("%s%s: %s", given, spec, asp_error_text(err, line, sizeof line));
    known_names("ndf", 1, names);
    if (!scatters) {
        snprintf(line, sizeof line, "%s%.400s: unknown distribution", given, spec);
        return cmd_unknown(line, err->name, names);
    }
    for (size_t i = 0; names[i] && used < sizeof known; i++)
        used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "", names[i]);
    return cmd_usage("%s%s: '%s' is a scattering model, which stands in --material; known "
                     "distributions: %s", given, spec, err->name, known);
}

/* What distributions stand on lives as long as the command. */
static void *kept[256];
static size_t kept_count;

static int keep(void *memory)
{
    if (!memory)
        return CMD_OK;
    if (kept_count == sizeof kept / sizeof *kept) {
        free(memory);
        return CMD_FAILED;
    }
    kept[kept_count++] = memory;
    return CMD_OK;
}

void frame_release_files(void)
{
    while (kept_count)
        free(kept[--kept_count]);
}

/* A file that cannot be read, or memory that is out, is no mistake in the command line. */
static int from_file(const asp_error *err) { return err->file[0] || err->status == ASP_ENOMEM; }

asp_status cmd_read_ndf(const char *spec, asp_ndf *out, asp_error *err)
{
    void *memory;
    asp_status status = asp_ndf_read(NULL, spec, out, &memory, err);
    if (status == ASP_OK && keep(memory) != CMD_OK)
        return asp_fail(err, ASP_ENOMEM, "file", "too many distributions from files");
    return status;
}

static int read_ndf(const char *given, const char *spec, asp_ndf *out)
{
    asp_error err;
    if (cmd_read_ndf(spec, out, &err) == ASP_OK)
        return CMD_OK;
    if (from_file(&err))
        return cmd_error(&err);
    if (err.status != ASP_EUNKNOWN || err.position != 0 || !*given)
        return bad_value(given, *given ? "ndf" : "surface", spec, &err);
    return cmd_bad_ndf(given, spec, &err);
}

static int read_material(const char *given, const char *spec, asp_material *out)
{
    asp_error err;
    void *memory;
    if (asp_material_read(NULL, spec, out, &memory, &err) == ASP_OK)
        return keep(memory) == CMD_OK ? CMD_OK : cmd_failed("more than 256 distributions from files");
    return from_file(&err) ? cmd_error(&err) : bad_value(given, "material", spec, &err);
}

int cmd_ndf(const cmd_args *args, const char *option, size_t index, asp_ndf *out)
{
    char given[64];
    snprintf(given, sizeof given, "--%s ", option);
    return read_ndf(given, cmd_text_at(args, option, index), out);
}

int cmd_material(const cmd_args *args, const char *option, size_t index, asp_material *out)
{
    char given[64];
    snprintf(given, sizeof given, "--%s ", option);
    return read_material(given, cmd_text_at(args, option, index), out);
}

int cmd_mask(const cmd_args *args, const char *option, int *out)
{
    asp_error err;
    const char *name = cmd_text(args, option);
    if (asp_mask_parse(name, out, &err) == ASP_OK)
        return CMD_OK;
    char given[64];
    snprintf(given, sizeof given, "--%s ", option);
    return bad_value(given, "mask", name, &err);
}

int cmd_direction(const cmd_args *args, const char *option, asp_vec3 *out)
{
    const double degree = 3.14159265358979323846 / 180;
    const char *text = cmd_text(args, option), *at = text;
    double value[3];
    int count = 0;
    for (;; at++) {
        size_t n = strcspn(at, ",");
        if (count == 3 || !aspi_parse_number(at, n, &value[count++]))
            return cmd_usage("--%s '%s': expected x,y,z or theta,phi in degrees", option, text);
        at += n;
        if (!*at)
            break;
    }
    if (count == 1)
        return cmd_usage("--%s '%s': expected x,y,z or theta,phi in degrees", option, text);
    if (count == 2) {
        double theta = value[0] * degree, phi = value[1] * degree;
        if (!(value[0] >= 0 && value[0] <= 180))
            return cmd_usage("--%s '%s': theta = %g is outside [0, 180]", option, text, value[0]);
        value[0] = sin(theta) * cos(phi);
        value[1] = sin(theta) * sin(phi);
        value[2] = theta == 90 * degree ? 0 : cos(theta);
    }
    double largest = fmax(fabs(value[0]), fmax(fabs(value[1]), fabs(value[2])));
    for (int i = 0; i < 3 && largest > 0 && (largest < 1e-150 || largest > 1e150); i++)
        value[i] /= largest;                   /* else the length has too few digits, or overflows */
    double length = hypot(hypot(value[0], value[1]), value[2]);
    if (!(length > 0) || isinf(length))
        return cmd_usage("--%s '%s': length %g is outside (0, 1e308]", option, text, length);
    out->x = value[0] / length;
    out->y = value[1] / length;
    out->z = value[2] / length;
    return CMD_OK;
}

/* What a material's tables hold depends on how it is masked. */
static int set_mask(asp_material *out, int mask)
{
    asp_error err;
    int same = out->mask == mask;
    out->mask = mask;
    if (same || !out->model->prepare || out->model->prepare(out, &err) == ASP_OK)
        return CMD_OK;
    return cmd_error(&err);
}

/* A material, or the perfect mirror facets of a distribution. */
static int read_surface(const cmd_args *args, const char *given, int is_ndf, const char *spec, asp_material *out)
{
    int mask = 0, status = CMD_OK, masked = cmd_given(args, "mask") > 0;
    asp_ndf ndf;
    if (masked)
        status = cmd_mask(args, "mask", &mask);
    if (status == CMD_OK && is_ndf) {
        status = read_ndf(given, spec, &ndf);
        if (status == CMD_OK)
            *out = asp_mirror(&ndf, mask);
    } else if (status == CMD_OK) {
        status = read_material(given, spec, out);
        if (status == CMD_OK && masked)
            status = set_mask(out, mask);
    }
    return status;
}

int cmd_surface_spec(const cmd_args *args, const char *spec, asp_material *out)
{
    size_t length = strcspn(spec, ":");
    int scatters = 0; /* distributions are many: those made of data are in no list */
    for (const asp_bsdf *const *b = asp_bsdfs(); *b; b++)
        scatters |= strlen((*b)->name) == length && strncmp((*b)->name, spec, length) == 0;
    return read_surface(args, "", !scatters, spec, out);
}

int cmd_surface_at(const cmd_args *args, const char *option, size_t index, asp_material *out)
{
    char given[64];
    snprintf(given, sizeof given, "--%s ", option);
    return read_surface(args, given, strcmp(option, "ndf") == 0, cmd_text_at(args, option, index), out);
}

int cmd_surface(const cmd_args *args, asp_material *out)
{
    size_t ndfs = cmd_given(args, "ndf"), materials = cmd_given(args, "material");
    if (ndfs + materials == 0)
        return cmd_usage("no surface: give --ndf SPEC or --material SPEC");
    if (ndfs + materials > 1)
        return cmd_usage("--ndf and --material: only one of them, once");
    return cmd_surface_at(args, ndfs ? "ndf" : "material", 0, out);
}

/* What is wrong with one of a kind that could walk. */
static const char *not_walking(const asp_material *m)
{
    return m->model->facets == ASPI_FACETS_NONE ? "" : m->model->facets == ASPI_FACETS_REFRACT ? ":thin=1"
         : " with an approximation by name";
}

int cmd_can_walk(const asp_material *material)
{
    char known[256] = "";
    size_t used = 0;
    if (asp_can_walk(material))
        return CMD_OK;
    for (const asp_bsdf *const *b = asp_bsdfs(); *b && used < sizeof known; b++)
        if ((*b)->facets != ASPI_FACETS_NONE)
            used += (size_t)snprintf(known + used, sizeof known - used, "%s%s%s", used ? ", " : "", (*b)->name,
                                     (*b)->facets == ASPI_FACETS_REFRACT ? " (a half space)"
                                     : (*b)->facets == ASPI_FACETS_DIFFUSE ? " (exact)" : "");
    return cmd_usage("--walk: %s%s has no walk; those that have: %s", material->model->name, not_walking(material),
                     known);
}
