/* laws.c - the laws, run on a distribution that lives outside the library
 *
 * Built against the installed library by run.sh. Exit status 0 when every law holds for every
 * representative value. */
#include "asperity_data.h"
#include "asperity_ndf.h"
#include <stdio.h>
#include <string.h>

extern const asp_model asp_model_two_scale;
static const asp_model *const models[] = { &asp_model_two_scale, NULL };

static void print_law(void *context, const asp_law_result *r)
{
    if (r->passed)
        return;
    printf("FAILED %s: %s: %g %s, allowed %g, %s\n", (const char *)context, r->law->name, r->worst,
           r->law->unit, r->allowed, r->where);
}

int main(void)
{
    asp_laws_options options = asp_laws_options_default();
    asp_error err;
    asp_ndf ndf;
    char spec[256], line[512];
    size_t passed = 0, broken = 0, failed, i;

    options.samples = 20000;
    options.sparse = 1;            /* other cases of the samplers at other values */
    for (i = 0; asp_laws_spec(models[0], i, spec, sizeof spec); i++) {
        if (asp_ndf_parse(models, spec, &ndf, &err) != ASP_OK ||
            asp_laws_check(&ndf, &options, print_law, spec, &failed, &err) != ASP_OK) {
            printf("FAILED %s: %s\n", spec, asp_error_text(&err, line, sizeof line));
            return 1;
        }
        broken += failed > 0;
        passed += failed == 0;
    }
    /* the library's own table does not know it, and a wrong value is refused */
    if (asp_ndf_parse(NULL, "two_scale:alpha=0.2", &ndf, NULL) == ASP_OK ||
        asp_ndf_parse(models, "two_scale:share=1.5", &ndf, NULL) == ASP_OK || passed + broken < 10) {
        printf("FAILED: the table of the program\n");
        broken++;
    }
    printf("two_scale: %zu values keep every law, %zu do not\n", passed, broken);
    return broken > 0;
}
