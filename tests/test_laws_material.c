/* test_laws_material.c - the laws over one material: they hold where it is right, and see what is wrong with it */
#include "asperity_data.h"
#include "asperity_ndf.h"
#include "bsdf/bsdf.h"

#include <stdio.h>
#include <string.h>

static size_t passed, failed;

static void check(int good, const char *what)
{
    passed += good != 0;
    failed += !good;
    printf("  %s%s\n", good ? "" : "FAILED: ", what);
}

typedef struct findings { char broken[512]; size_t laws; } findings;

static void note(void *context, const asp_law_result *result)
{
    findings *f = context;
    f->laws += result->checks > 0;
    if (!result->passed) {
        strcat(f->broken, result->law->name);
        strcat(f->broken, " ");
    }
}

static findings laws_of(const asp_material *mat)
{
    asp_laws_options o = asp_laws_options_default();
    findings f = { "", 0 };
    o.samples = 4000;
    o.material = mat;
    check(asp_laws_check(NULL, &o, note, &f, NULL, NULL) == ASP_OK, "checked");
    printf("    %zu laws; broken: %s\n", f.laws, f.broken);
    return f;
}

/* A mirror of 1.2 times the light. */
static void too_bright(const asp_material *mat, double r, double g, double b, double x, double y, asp_rgb *out)
{
    (void)mat;
    (void)y;
    out->r = 1.2 * r * x;
    out->g = 1.2 * g * x;
    out->b = 1.2 * b * x;
}

static void too_bright_n(const asp_material *mat, size_t n, const double *x, const double *y, double *r, double *g,
                         double *b)
{
    for (size_t i = 0; i < n; i++) {
        asp_rgb out;
        too_bright(mat, r[i], g[i], b[i], x[i], y[i], &out);
        r[i] = out.r;
        g[i] = out.g;
        b[i] = out.b;
    }
}

int main(void)
{
    asp_ndf ndf;
    asp_material mirror, metal;
    asp_bsdf record;
    asp_laws_options o = asp_laws_options_default();
    asp_error err;
    findings f;
    size_t of_materials = 0;
    if (asp_ndf_parse(NULL, "ggx:alpha=0.3", &ndf, &err) != ASP_OK)
        return 1;
    mirror = asp_mirror(&ndf, 0);
    f = laws_of(&mirror);
    check(f.laws >= 10 && !f.broken[0], "a mirror keeps the laws");
    metal = mirror;
    record = *mirror.model;
    record.value = too_bright;
    record.value_n = too_bright_n;
    metal.model = &record;
    f = laws_of(&metal);
    check(strstr(f.broken, "furnace ") && strstr(f.broken, "float32 "), "1.2 times the light, in float64 only: seen");
    for (size_t i = 0; asp_laws(i); i++)
        of_materials += asp_law_of_materials(asp_laws(i)) != 0;
    check(of_materials == 13 && !asp_law_of_materials(NULL), "13 laws speak of materials");
    o.material = &mirror;
    o.only = "sigma";
    check(asp_laws_check(NULL, &o, NULL, NULL, NULL, &err) == ASP_EINVAL && !strcmp(err.name, "sigma"),
          "a law of distributions is refused for a material");
    o.only = "no_such_law";
    check(asp_laws_check(NULL, &o, NULL, NULL, NULL, &err) == ASP_EUNKNOWN, "a law that is not there is refused");
    check(asp_can_walk(&mirror), "mirrors walk");
    printf("%zu passed, %zu failed\n", passed, failed);
    return failed != 0;
}
