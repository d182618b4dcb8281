/* 5_fit.c - read a measurement and find the distribution behind it
 *
 * Takes a MERL, RGL or CSV file. Without one it writes a MERL file of a material that it knows, reads
 * it back and should find the same numbers again. Installed with `make install PREFIX=...` (and
 * PKG_CONFIG_PATH set when the prefix is your own):
 *
 *     cc -O2 examples/5_fit.c $(pkg-config --cflags --libs asperity-data) -o fit && ./fit
 */
#include "asperity_data.h"
#include "asperity_ndf.h"
#include <stdio.h>
#include <stdlib.h>

static asp_rgb known(const void *context, asp_vec3 wi, asp_vec3 wo)
{
    return asp_eval(context, wi, wo);
}

static asp_status write_known(const char *path, asp_error *err)
{
    const char *spec = "lambert_specular:diffuse=0.1/0.05/0.02,specular=1,eta=1.5,"
                       "ndf=(student_t:alpha=0.15,gamma=2.6)";
    asp_material material;
    asp_measured *table;
    asp_status status = asp_material_parse(NULL, spec, &material, err);
    if (status != ASP_OK)
        return status;
    table = asp_measured_from_function(known, &material, spec, err);
    status = table ? asp_measured_write_merl(table, path, err) : err->status;
    asp_measured_free(table);
    return status;
}

int main(int argc, char **argv)
{
    const char *path = argc > 1 ? argv[1] : "known.binary";
    const asp_model *model = asp_find_model(NULL, "student_t");
    const asp_model *models[] = { model, NULL };
    asp_fit_options options = { .models = models };
    asp_fit_result *fits = NULL;
    asp_measured *measured = NULL;
    asp_error err;
    char text[512];
    size_t count, i;

    if ((argc < 2 && write_known(path, &err) != ASP_OK) ||
        !(measured = asp_measured_read(path, &err)) ||
        asp_fit(measured, &options, &fits, &count, &err) != ASP_OK) {
        fprintf(stderr, "%s\n", asp_error_text(&err, text, sizeof text));
        asp_measured_free(measured);
        return 1;
    }
    for (i = 0; i < fits[0].parameter_count; i++)
        printf("%-10s %.3f\n", fits[0].parameter[i].name, fits[0].parameter[i].value);
    free(fits);
    asp_measured_free(measured);
    return 0;
}
