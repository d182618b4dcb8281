/* figures_models.c - every distribution of the library: its density and its masking, for a few values of
 * each of its numbers; whatever asp_models() has gets its figure */
#include "figures.h"
#include "asperity_ndf.h"

#include <math.h>
#include <string.h>

enum { POINTS = 241, VALUES = 4 };

/* The map's roughness, which is the first number of a shape that has none of its own. */
static const double alphas[VALUES] = { 0.1, 0.2, 0.4, 0.8 };

/* Values of a parameter around its default, within its range and as far from its lower end again. */
static size_t values_of(const asp_param *p, double *out)
{
    static const double factors[VALUES] = { 1, 0.25, 3, 10 };
    size_t n = 0;
    double above = p->initial - p->low;
    for (int i = 0; i < VALUES; i++) {
        double v = isfinite(p->low) && above > 0 ? p->low + above * factors[i] : p->initial * factors[i];
        double unit = pow(10, floor(log10(fabs(v))) - 1);        /* two digits */
        v = i == 0 ? v : unit >= 1 ? rint(v / unit) * unit : rint(v / unit) / rint(1 / unit);
        int inside = (p->low_open ? v > p->low : v >= p->low) && v <= p->high && v != 0;
        for (size_t k = 0; k < n; k++)
            inside &= out[k] != v;
        if (inside)
            out[n++] = v;
    }
    return n;
}

static int add_pair(const char *spec, const char *note, size_t index, drawing *d, size_t panel)
{
    static const asp_dash dashes[VALUES] = { ASP_DASH_SOLID, ASP_DASH_LONG, ASP_DASH_SHORT,
                                             ASP_DASH_DOTS };
    asp_ndf ndf;
    int status = figure_ndf(spec, &ndf);
    for (size_t k = 0; status == CMD_OK && k < 2; k++) {
        figure_curve *c = drawing_curve(d, &d->panels[panel + k], POINTS, spec);
        if (!c)
            return CMD_OK;
        snprintf(c->colour, sizeof c->colour, "%s",
                 asp_colour(ndf.model->name) ? ndf.model->name : "#555555");
        snprintf(c->note, sizeof c->note, "%s", note);
        c->dash = dashes[index % VALUES];
        for (size_t i = 0; i < POINTS; i++) {
            asp_vec3 w = { 0, 0, 0 };
            figure_angle(i, POINTS - 1, &c->x[i], &w.z, &w.x);
            c->y[i] = k ? asp_G1(&ndf, w, ASP_MASK_CORRELATED) : asp_D(&ndf, w);
        }
    }
    return status;
}

/* D and G1 as one number varies: the map's alpha (parameter NULL) or one of its own. */
static int add_row(const asp_model *m, const asp_param *p, drawing *d)
{
    const char *name = p ? p->name : "alpha";
    double own[VALUES];
    const double *value = p ? own : alphas;
    size_t count = p ? values_of(p, own) : VALUES, first = d->panel_count;
    char title[120];
    int status = CMD_OK;
    snprintf(title, sizeof title, "density, for values of %s", name);
    figure_panel *density = drawing_panel(d, title, "theta_{m} [deg]", "D [1/sr]", "D");
    snprintf(title, sizeof title, "masking, for values of %s", name);
    figure_panel *masking = drawing_panel(d, title, "theta [deg]", "G_{1}", "G1");
    density->y.scale = ASP_SCALE_LOG;
    density->y.decades = 6;
    masking->y.high = 1.06;
    masking->y.step = 0.2;
    density->x.high = masking->x.high = 90;
    density->x.step = masking->x.step = 15;
    for (size_t i = 0; status == CMD_OK && i < count; i++) {
        char spec[120], number[ASPI_NUMBER_TEXT], note[ASPI_NUMBER_TEXT + 40];
        number[aspi_format_number(value[i], 6, number)] = 0;
        snprintf(spec, sizeof spec, "%s:%s=%s", m->name, name, number);
        snprintf(note, sizeof note, "%s", number);
        status = add_pair(spec, note, i, d, first);
    }
    return status;
}

static int draw_model(const figure *f, const figure_job *job)
{
    const asp_model *m = f->rows;
    drawing *d = job->out;
    int status = CMD_OK;
    d->width = 460;
    d->height = 330;
    if (!m->own_scale)
        status = add_row(m, NULL, d);
    for (size_t i = 0; status == CMD_OK && i < m->param_count && d->panel_count + 2 <= FIGURE_PANELS;
         i++)
        status = add_row(m, &m->params[i], d);
    return status;
}

size_t figures_models(figure *out, size_t room)
{
    static char name[FIGURE_MODELS][48], title[FIGURE_MODELS][120];
    size_t n = 0;
    for (const asp_model *const *m = asp_models(); *m && n < room && n < FIGURE_MODELS; m++) {
        asp_ndf ndf;
        if (asp_ndf_parse(NULL, (*m)->name, &ndf, NULL) != ASP_OK)
            continue;                        /* one that is made of data has no curves of its own */
        snprintf(name[n], sizeof name[n], "ndf-%s", (*m)->name);
        snprintf(title[n], sizeof title[n], "%s", (*m)->title);
        out[n] = (figure){ .name = name[n], .title = title[n], .source = (*m)->source,
                           .x_name = "theta_deg", .seconds = 0.05, .make = draw_model, .rows = *m };
        n++;
    }
    return n;
}
