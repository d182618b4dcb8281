/* 5_fit.c - measure a surface whose heights are known, and find its slope distribution again
 *
 * Installed with `make install PREFIX=...` (and PKG_CONFIG_PATH set when the prefix is your own):
 *
 *     cc -O2 examples/5_fit.c $(pkg-config --cflags --libs asperity-data) -o fit && ./fit
 */
#include "asperity_data.h"
#include "asperity_ndf.h"
#include <stdio.h>
#include <stdlib.h>

int main(void)
{
    asp_fabrication what = asp_fabrication_default();
    asp_fit_options options = { 0 };
    asp_fit_result *fits = NULL;
    asp_measured *measured;
    asp_error err;
    char text[512];
    size_t count, i;

    what.surface.size = 512;                /* smaller than the default: this is an example */
    what.surface.gamma = 3.0;
    what.rays = 2000000;
    measured = asp_fabricate(&what, NULL, NULL, NULL, &err);
    if (!measured || asp_fit(measured, &options, &fits, &count, &err) != ASP_OK) {
        fprintf(stderr, "%s\n", asp_error_text(&err, text, sizeof text));
        asp_measured_free(measured);
        return 1;
    }
    printf("made with alpha = %.2f, gamma = %.1f\n", what.surface.alpha, what.surface.gamma);
    for (i = 0; i < count; i++) {
        size_t p;
        printf("%-10s error %.2f:", fits[i].model->name, fits[i].error[0]);
        for (p = 0; p < fits[i].parameter_count; p++)
            if (fits[i].parameter[p].name[0] == 'a' || fits[i].parameter[p].name[0] == 'g')
                printf("  %s = %.2f", fits[i].parameter[p].name, fits[i].parameter[p].value);
        printf("\n");
    }
    free(fits);
    asp_measured_free(measured);
    return 0;
}
