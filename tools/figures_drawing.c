/* figures_drawing.c - panels of curves: their picture and their numbers */
#include "figures.h"

#include <stdlib.h>
#include <string.h>

#include "panels.h"

figure_panel *drawing_panel(drawing *d, const char *title, const char *x_label, const char *y_label,
                            const char *quantity)
{
    if (d->panel_count >= FIGURE_PANELS)
        abort();                                 /* a table of this program is wrong */
    figure_panel *p = &d->panels[d->panel_count++];
    snprintf(p->title, sizeof p->title, "%s", title);
    snprintf(p->x_label, sizeof p->x_label, "%s", x_label);
    snprintf(p->y_label, sizeof p->y_label, "%s", y_label);
    snprintf(p->quantity, sizeof p->quantity, "%s", quantity);
    return p;
}

figure_curve *drawing_curve(drawing *d, figure_panel *panel, size_t count, const char *label)
{
    if (panel->curve_count >= FIGURE_CURVES)
        abort();
    figure_curve *c = &panel->curves[panel->curve_count];
    c->x = calloc(2 * count, sizeof *c->x);
    if (!c->x) {
        d->broken = 1;
        return NULL;
    }
    panel->curve_count++;
    c->y = c->x + count;
    c->count = count;
    snprintf(c->label, sizeof c->label, "%s", label);
    return c;
}

void drawing_rule(figure_panel *panel, double value, int horizontal, const char *label)
{
    size_t n = panel->rule_count++;
    snprintf(panel->rule_label[n], sizeof panel->rule_label[n], "%s", label);
    panel->rules[n] = (asp_rule){ .value = value, .horizontal = 2 * horizontal };
}

void drawing_free(drawing *d)
{
    for (size_t i = 0; i < d->panel_count; i++)
        for (size_t k = 0; k < d->panels[i].curve_count; k++)
            free(d->panels[i].curves[k].x);
    memset(d, 0, sizeof *d);
}

static char *panel_svg(const drawing *d, const figure_panel *p, const char *title, asp_error *err)
{
    asp_series series[FIGURE_CURVES];
    asp_rule rules[4];
    asp_chart chart;
    memset(series, 0, sizeof series);
    memset(&chart, 0, sizeof chart);
    for (size_t i = 0; i < p->curve_count; i++) {
        const figure_curve *c = &p->curves[i];
        series[i] = (asp_series){ .label = *c->legend ? c->legend : NULL, .x = c->x, .y = c->y,
                                  .count = c->count, .colour = *c->colour ? c->colour : NULL,
                                  .dash = c->dash, .marker = c->marker, .width = c->width,
                                  .note = *c->note ? c->note : NULL };
    }
    for (size_t i = 0; i < p->rule_count; i++) {
        rules[i] = p->rules[i];
        rules[i].label = *p->rule_label[i] ? p->rule_label[i] : NULL;
    }
    chart.title = title;
    chart.x = p->x;
    chart.y = p->y;
    chart.x.label = p->x_label;
    chart.y.label = p->y_label;
    chart.series = series;
    chart.series_count = p->curve_count;
    chart.rules = rules;
    chart.rule_count = p->rule_count;
    chart.legend = p->legend;
    chart.width = d->width;
    chart.height = d->height;
    return asp_chart_svg(&chart, err);
}

char *drawing_svg(const drawing *d, const char *title)
{
    char *svg[FIGURE_PANELS] = { NULL }, *all = NULL;
    asp_error err;
    int good = !d->broken;
    if (!good)
        cmd_failed("out of memory");
    for (size_t i = 0; good && i < d->panel_count; i++) {
        const figure_panel *p = &d->panels[i];
        svg[i] = panel_svg(d, p, d->panel_count > 1 ? p->title : title, &err);
        good = svg[i] != NULL;
        if (!good)
            cmd_error(&err);
    }
    if (good && !(all = panels_svg(svg, d->panel_count, d->columns ? d->columns : 2,
                                   d->panel_count > 1 ? title : NULL)))
        cmd_failed("out of memory");
    for (size_t i = 0; i < d->panel_count; i++)
        free(svg[i]);
    return all;
}

/* In quotes: labels hold commas. */
static void quoted(const char *text, cmd_out *out)
{
    cmd_out_write(out, "\"", 1);
    cmd_out_write(out, text, strlen(text));
    cmd_out_write(out, "\",", 2);
}

/* Values with ten digits: less than any of the figures' formulas lose, so that the file is the same on
 * every machine. */
void drawing_numbers(const drawing *d, const char *x_name, cmd_out *out)
{
    char text[2 * ASPI_NUMBER_TEXT + 4];
    int used = snprintf(text, sizeof text, "panel,quantity,curve,%s,value\n", x_name);
    cmd_out_write(out, text, (size_t)used);
    for (size_t i = 0; i < d->panel_count; i++)
        for (size_t k = 0; k < d->panels[i].curve_count; k++) {
            const figure_curve *c = &d->panels[i].curves[k];
            for (size_t j = 0; j < c->count; j++) {
                quoted(d->panels[i].title, out);
                quoted(d->panels[i].quantity, out);
                quoted(c->label, out);
                size_t n = aspi_format_number(c->x[j], 15, text);
                text[n++] = ',';
                n += aspi_format_number(c->y[j], 10, text + n);
                text[n++] = '\n';
                cmd_out_write(out, text, n);
            }
        }
}
