/* specs.c - representative values of a model, as specs
 *
 * Every map with the default shape, and every other shape with a few maps that take turns, so that
 * each end of each parameter meets small and large roughness, anisotropy and skew. */
#include "data/io.h"
#include "laws/laws.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const char *const slope_maps[] = {
    "alpha=0.3",
    "alpha_x=0.35,alpha_y=0.08,rotation=0.6,mean_x=0.4,mean_y=-0.25",
    "alpha=0.001",
    "alpha_x=0.2,alpha_y=0.6",
    "alpha=4",
    "alpha_x=0.7,alpha_y=0.3,rho=-0.6,mean_x=1.2,mean_y=1.6",
    "alpha=0.03",
    "alpha_x=0.001,alpha_y=0.5,rotation=-1.1",
    "alpha=1,mean_x=0.3",
    "alpha_x=0.05,alpha_y=0.02,rho=0.5,mean_y=0.1",
    "alpha=0.01,mean_x=-2",
    "alpha_x=3,alpha_y=0.4,rotation=2.2,mean_x=-0.7,mean_y=0.2"
};

/* Stretches and skews of a surface whose shape numbers carry the roughness. */
static const char *const own_maps[] = {
    "alpha_x=1,alpha_y=1",
    "alpha_x=1.4,alpha_y=0.5,rotation=0.6,mean_x=0.4,mean_y=-0.25",
    "alpha_x=0.3,alpha_y=0.3",
    "alpha_x=0.8,alpha_y=1.2,rho=-0.6,mean_x=1.2,mean_y=1.6",
    "alpha_x=1,alpha_y=2.5,rotation=-1.1",
    "alpha_x=1,alpha_y=1,mean_x=0.3"
};

static const char *const ellipsoid_maps[] = {
    "alpha=0.3",
    "alpha_x=0.2,alpha_y=0.1,theta_x=0.3,theta_y=-0.2,theta_z=0.7",
    "alpha_x=0.6,alpha_y=0.25,theta_x=-0.8,theta_y=0.5,theta_z=2",
    "alpha_x=0.01,alpha_y=0.02,theta_x=0.02",
    "a11=0.3,a12=0.1,a13=0.05,a21=-0.02,a22=0.2,a23=0,a31=0.3,a32=-0.5,a33=1",
    "a11=-0.4,a12=0.1,a13=0,a21=0,a22=0.7,a23=0.2,a31=0.1,a32=0.2,a33=0.9",
    "s11=0.3,s12=0.02,s13=-0.4,s22=0.2,s23=0.1,s33=1"
};

#define COUNT(a) (sizeof (a) / sizeof (a)[0])
#define VALUES 8
#define TURNS 3

/* Values of one parameter away from its default: near both ends, in between on a log scale from the
 * low end, and infinity where it is allowed. */
static int values_of(const asp_param *p, double out[VALUES])
{
    static const double steps[4] = { 0.005, 0.5, 5, 500 };
    double bottom = isfinite(p->low) ? p->low : -10;
    int n = 0, i;
    if (!p->low_open && isfinite(p->low))
        out[n++] = p->low;
    for (i = 0; i < 4; i++)
        if (bottom + steps[i] < p->high && bottom + steps[i] != p->initial)
            out[n++] = bottom + steps[i];
    if (p->high != p->initial)
        out[n++] = p->high;
    return n;
}

static int append(char *spec, size_t size, const char *text)
{
    size_t used = strlen(spec), more = strlen(text);
    if (used + more + 1 > size)
        return 0;
    memcpy(spec + used, text, more + 1);
    return 1;
}

static int append_value(char *spec, size_t size, const char *name, double value)
{
    char number[ASPI_NUMBER_TEXT] = "inf", text[96];
    if (!isinf(value))
        aspi_format_number(value, 9, number);
    snprintf(text, sizeof text, ",%s=%s", name, number);
    return append(spec, size, text);
}

int asp_laws_spec(const asp_model *model, size_t index, char *spec, size_t size)
{
    const char *const *maps = slope_maps;
    size_t count = COUNT(slope_maps), k, turn = 1, corner;
    if (size == 0)
        return 0;
    spec[0] = '\0';
    if (!append(spec, size, model->name) || !append(spec, size, ":"))
        return 0;
    if (model->keys == ASP_KEYS_ELLIPSOID) {
        maps = ellipsoid_maps;
        count = COUNT(ellipsoid_maps);
    } else if (model->own_scale) {
        maps = own_maps;
        count = COUNT(own_maps);
    }
    if (index < count)
        return append(spec, size, maps[index]);
    index -= count;
    for (k = 0; k < model->param_count; k++) {
        double values[VALUES];
        int n = values_of(&model->params[k], values), i;
        size_t j;
        for (i = 0; i < n; i++)
            for (j = 0; j < TURNS; j++, turn++)
                if (index-- == 0)
                    return append(spec, size, maps[turn * 5 % count])
                        && append_value(spec, size, model->params[k].name, values[i]);
    }
    /* every corner of the first two ranges, the others at the end of the first */
    corner = index;
    if (model->param_count > 1 && corner < 4) {
        int ok = append(spec, size, maps[corner * 5 % count]);
        for (k = 0; ok && k < model->param_count; k++) {
            double values[VALUES];
            int n = values_of(&model->params[k], values), far = (int)(k == 1 ? corner / 2 : corner % 2);
            ok = append_value(spec, size, model->params[k].name, values[far ? n - 1 : 0]);
        }
        return ok;
    }
    return 0;
}
