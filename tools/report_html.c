/* report_html.c - one page that stands alone: style, charts and pictures are inside it */
#include "report.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define DEGREE 0.017453292519943295769

/* ------------------------------------------------------------------ head */

void report_head(page *out, const char *title)
{
    page_add(out, "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                  "<meta name=\"viewport\" content=\"width=device-width\">\n<title>");
    page_escaped(out, title);
    page_add(out,
        "</title>\n<style>\n"
        "body { font: 15px/1.5 system-ui, sans-serif; color: #1b1b1b; background: #fff;\n"
        "       max-width: 1040px; margin: 2em auto; padding: 0 1em; }\n"
        "h1 { font-size: 1.7em; margin: 0 0 .2em; } h2 { font-size: 1.2em; margin: 2em 0 .4em; }\n"
        "p { margin: .4em 0; max-width: 48em; } .note { color: #555; font-size: .92em; }\n"
        ".made { border-left: 4px solid #b36b00; background: #fff6e6; padding: .5em 1em; }\n"
        "table { border-collapse: collapse; margin: .6em 0; }\n"
        "th, td { padding: .25em .9em; text-align: left; border-bottom: 1px solid #ddd; }\n"
        "th { font-weight: 600; } td.n { font-variant-numeric: tabular-nums; }\n"
        "td.best { background: #e3f3e3; font-weight: 600; } tr.fitted th::after { content: ' *'; }\n"
        "td.weak { color: #8a4b00; }\n"
        ".pair { display: flex; flex-wrap: wrap; gap: 0 20px; }\n"
        "svg { max-width: 100%; height: auto; }\n"
        "figure { display: inline-block; margin: .4em 1.2em .4em 0; }\n"
        "figcaption { text-align: center; font-size: .92em; } figure img { display: block; }\n"
        "code { font-size: .86em; background: #f4f4f4; padding: .1em .3em;\n"
        "       overflow-wrap: anywhere; }\n"
        ".key { display: inline-block; width: .8em; height: .8em; margin-right: .4em; }\n"
        "</style>\n</head>\n<body>\n");
}

static void measured_what(const report *r, page *out)
{
    page_add(out, "<p>");
    if (r->file) {
        page_add(out, "File <code>");
        page_escaped(out, r->title);
        page_put(out, "</code>, format %s", r->info.format);
        if (r->info.description[0]) {
            page_add(out, ": ");
            page_escaped(out, r->info.description);
        }
        page_add(out, ". ");
    }
    page_put(out, "%s, %s, %d channel%s, %zu stored values; %zu geometries are used in the fit",
             r->info.isotropic ? "Isotropic" : "Anisotropic (fitted by isotropic models)",
             r->info.scattered ? "listed geometries" : "a full table", r->info.channels,
             r->info.channels == 1 ? "" : "s", r->info.samples, r->geometries);
    page_add(out, ", none beyond 80° from the normal.</p>\n");
}

static void made_what(const report *r, page *out)
{
    const asp_surface_recipe *s = &r->made->surface;
    const asp_fabrication_report *t = r->truth;
    page_put(out,
        "<div class=\"made\"><p><b>This measurement is fabricated.</b> No instrument was involved: %zu "
        "rays were traced against an explicit height field of %d × %d points with %s facets, for as "
        "many bounces as it took, and what came back was collected as a gonioreflectometer would. ",
        t->rays, s->size, s->size, r->made->metal ? r->made->metal->name : "perfectly reflecting");
    page_put(out,
        "The surface was made with slopes of a Student's t-distribution, α = %.4g, γ = %.4g. The "
        "%zu facets that the rays met have, by maximum likelihood, <b>α = %.4f, γ = %.3f</b> (as GGX "
        "α = %.4f, as Beckmann α = %.4f). Reflected at uniform light: %.3f / %.3f / %.3f; of it "
        "%.1f %% met two facets or more, which no single-scattering model contains. Median counting "
        "error of a cell: %.1f %%.</p></div>\n",
        s->alpha, s->gamma, t->slopes.facets, t->slopes.alpha, t->slopes.gamma, t->slopes.alpha_ggx,
        t->slopes.alpha_beckmann, t->albedo.r, t->albedo.g, t->albedo.b, 100 * t->multiple.g,
        100 * t->noise);
}

static void how_far(double fitted, double measured, page *out)
{
    double ratio = fitted / measured;
    if (ratio > 0.8 && ratio < 1.25)
        page_put(out, "%.3g (%+.0f %%)", fitted, 100 * (ratio - 1));
    else if (ratio > 0)
        page_put(out, "%.3g (too %s by a factor of %.*f)", fitted, ratio < 1 ? "low" : "high",
                 fmax(ratio, 1 / ratio) < 9.95, fmax(ratio, 1 / ratio));
    else
        page_add(out, "0");
}

/* A mean over all geometries hides the few at which a lobe is decided. */
static void at_peak(const report *r, page *out)
{
    const asp_measurement *m = report_peak(r);
    double f = report_luminance(m->f), h, d;
    report_half_angles(m, &h, &d);
    page_put(out, "<p>At the highest measured value, f = %.3g/sr at θ<sub>i</sub> = %.3g°, "
                  "θ<sub>o</sub> = %.3g°, θ<sub>h</sub> = %.2g°, <b>%s gives ", f,
             acos(fmin(1, m->wi.z)) / DEGREE, acos(fmin(1, m->wo.z)) / DEGREE,
             h < 1e-6 ? 0 : h / DEGREE, r->result[r->best].model->name);
    how_far(report_luminance(asp_eval(&r->result[r->best].material, m->wi, m->wo)), f, out);
    page_add(out, "</b>");
    for (size_t i = 0; i < r->count; i++)
        if (i != r->best) {
            page_put(out, "%s %s ", i == (r->best == 0) ? ";" : ",", r->result[i].model->name);
            how_far(report_luminance(asp_eval(&r->result[i].material, m->wi, m->wo)), f, out);
        }
    page_add(out, ".</p>\n");
}

static void verdict(const report *r, page *out)
{
    const asp_fit_result *b = &r->result[r->best];
    page_put(out, "<p><b>%s fits best</b> by %s: %.4f", b->model->name, r->loss,
             b->error[r->loss_index]);
    for (size_t i = 0; i < r->count; i++)
        if (i != r->best)
            page_put(out, "%s %s %.4f", i == (r->best == 0) ? ";" : ",", r->result[i].model->name,
                     r->result[i].error[r->loss_index]);
    page_add(out, ".</p>\n");
    at_peak(r, out);
}

/* ------------------------------------------------------------------ pictures */

static void spheres(const report *r, page *out)
{
    page_add(out, "<h2>Seen</h2>\n");
    if (r->info.scattered)
        page_add(out, "<p class=\"note\">The measurement lists geometries and cannot be rendered; the "
                      "spheres are the fits.</p>\n");
    for (size_t k = 0; k <= r->count; k++) {
        const char *name = k ? r->result[k - 1].model->name : "measured";
        if (!r->sphere[k])
            continue;
        page_put(out, "<figure><img alt=\"sphere: %s\" width=\"%d\" height=\"%d\" "
                      "src=\"data:image/png;base64,", name, r->sphere_side, r->sphere_side);
        page_add(out, r->sphere[k]);
        page_put(out, "\"><figcaption>%s%s</figcaption></figure>\n", name,
                 k == r->best + 1 ? " (best)" : "");
    }
}

static void chart(char *svg, page *out)
{
    if (svg)
        page_add(out, svg);
    free(svg);
}

static void charts(const report *r, page *out)
{
    double angle[3], ratio = 1;
    size_t n = report_incidences(r, angle, 3);
    if (n) {
        page_add(out, "<h2>In the plane of incidence</h2>\n<p class=\"note\">Luminance of f, without "
                      "the cosine. Left: the lobe on a linear scale. Right: everything, logarithmic; "
                      "negative θ<sub>o</sub> lies on the side of the light.</p>\n");
        for (size_t k = 0; k < n; k++) {
            page_add(out, "<div class=\"pair\">");
            chart(report_plane(r, angle[k], ASP_SCALE_LINEAR), out);
            chart(report_plane(r, angle[k], ASP_SCALE_LOG), out);
            page_add(out, "</div>\n");
        }
    }
    page_add(out, "<h2>Along the half angle</h2>\n<p class=\"note\">Where the distribution of normals "
                  "shows itself: f over θ<sub>h</sub> at a fixed difference angle, both logarithmic.");
    if (report_at_edge(r, REPORT_PROFILE_EDGE))
        page_put(out, " What was measured below θ<sub>h</sub> = %g°, the mirror direction included, is "
                      "drawn at the left edge.", REPORT_PROFILE_EDGE);
    page_add(out, "</p>\n<div class=\"pair\">");
    chart(report_profile(r, 12.5 * DEGREE), out);
    chart(report_profile(r, 57.5 * DEGREE), out);
    page_add(out, "</div>\n<h2>Residual</h2>\n<p class=\"note\">Fitted over measured luminance at all "
                  "geometries of the fit: the median in bins of θ<sub>h</sub>, and for the best fit "
                  "the band that holds 80 % of them.");
    size_t mirror = report_at_edge(r, REPORT_RATIO_EDGE), left = report_left_out(r, &ratio);
    if (mirror)
        page_put(out, " The leftmost point stands for the %zu geometr%s below θ<sub>h</sub> = %.2g°, the "
                      "mirror direction included.", mirror, mirror == 1 ? "y" : "ies",
                 REPORT_RATIO_EDGE);
    if (left)
        page_put(out, " Not drawn: %zu geometr%s in bins with too few for a median, where the best fit "
                      "over the measured value is %.3g in the median.", left, left == 1 ? "y" : "ies",
                 ratio);
    page_add(out, "</p>\n");
    chart(report_ratio(r), out);
}

/* ------------------------------------------------------------------ tables */

static void model_names(const report *r, page *out)
{
    page_add(out, "<tr><th></th>");
    for (size_t i = 0; i < r->count; i++) {
        const char *name = r->result[i].model->name, *colour = asp_colour(name);
        page_put(out, "<th><span class=\"key\" style=\"background:%s\"></span>%s</th>",
                 colour ? colour : "#888", name);
    }
    page_add(out, "</tr>\n");
}

static void errors(const report *r, page *out)
{
    const asp_loss *const *loss = asp_losses();
    page_add(out, "<h2>Errors</h2>\n<table>\n");
    model_names(r, out);
    for (int l = 0; loss[l]; l++) {
        double least = INFINITY;
        for (size_t i = 0; i < r->count; i++)
            least = fmin(least, r->result[i].error[l]);
        page_put(out, "<tr%s><th>%s</th>", l == r->loss_index ? " class=\"fitted\"" : "",
                 loss[l]->name);
        for (size_t i = 0; i < r->count; i++)
            page_put(out, "<td class=\"n%s\">%.5f</td>",
                     r->result[i].error[l] == least ? " best" : "", r->result[i].error[l]);
        page_add(out, "</tr>\n");
    }
    page_add(out, "</table>\n<p class=\"note\">* what was minimised; the best of each row is marked.");
    for (int l = 0; loss[l]; l++) {
        page_put(out, "<br><b>%s</b>: ", loss[l]->name);
        page_escaped(out, loss[l]->definition);
    }
    page_add(out, "</p>\n");
}

static void parameter_row(const report *r, const char *name, page *out)
{
    char cell[64];
    page_put(out, "<tr><th>%s</th>", name);
    for (size_t i = 0; i < r->count; i++) {
        const asp_fit_parameter *p = report_find(&r->result[i], name);
        int weak = p && (p->at_bound || !p->determined);
        page_put(out, "<td class=\"n%s\">", weak ? " weak" : "");
        page_escaped(out, p ? report_number(p, "±", cell, sizeof cell) : "–");
        page_add(out, "</td>");
    }
    page_add(out, "</tr>\n");
}

static void truth_note(const report *r, page *out)
{
    if (!r->truth)
        return;
    const asp_slope_statistics *s = &r->truth->slopes;
    page_put(out, "<p>The facets themselves: student_t α = %.4f, γ = %.3f; ggx α = %.4f; "
                  "beckmann α = %.4f.</p>\n", s->alpha, s->gamma, s->alpha_ggx, s->alpha_beckmann);
}

static void parameters(const report *r, page *out)
{
    const char *name[REPORT_ROWS];
    size_t rows = report_rows(r, name, REPORT_ROWS);
    page_add(out, "<h2>Parameters</h2>\n<table>\n");
    model_names(r, out);
    for (size_t k = 0; k < rows; k++)
        parameter_row(r, name[k], out);
    page_add(out, "</table>\n");
    truth_note(r, out);
    page_add(out, "<p class=\"note\">± is one standard deviation for independent errors; where a model "
                  "does not fit, the true uncertainty is larger. “limit”: the value lies at an "
                  "end of its range. A range in parentheses: the data leave it open. f = diffuse/π + "
                  "specular F(eta) D G<sub>2</sub> / (4 cos θ<sub>i</sub> cos θ<sub>o</sub>); specular "
                  "and eta trade against each other, and towards eta = 100 the surface is a metal of "
                  "reflectance specular.</p>\n");
}

static void strong_pairs(const asp_fit_result *f, page *out)
{
    const char *before = " Nearly dependent: ";
    for (size_t a = 0; a < f->parameter_count; a++)
        for (size_t b = a + 1; b < f->parameter_count; b++) {
            double c = f->correlation[a * ASP_FIT_PARAMETERS + b];
            int colours = !strncmp(f->parameter[a].name, "specular", 8);
            if (!(fabs(c) > 0.95) || colours)
                continue;
            page_put(out, "%s%s and %s (%+.2f)", before, f->parameter[a].name, f->parameter[b].name, c);
            before = ", ";
        }
}

static void materials(const report *r, page *out)
{
    page_add(out, "<h2>Materials</h2>\n");
    for (size_t i = 0; i < r->count; i++) {
        const asp_fit_result *f = &r->result[i];
        page_put(out, "<p><b>%s</b>, %s, %zu evaluations.", f->model->name,
                 asp_fit_reason_text(f->reason), f->evaluations);
        strong_pairs(f, out);
        page_add(out, "<br><code>");
        page_escaped(out, f->spec);
        page_add(out, "</code></p>\n");
    }
}

void report_html(const report *r, page *out)
{
    report_head(out, r->title);
    page_add(out, "<h1>");
    page_escaped(out, r->title);
    page_add(out, "</h1>\n");
    if (r->made)
        made_what(r, out);
    measured_what(r, out);
    verdict(r, out);
    spheres(r, out);
    errors(r, out);
    charts(r, out);
    parameters(r, out);
    materials(r, out);
    page_put(out, "<p class=\"note\">asperity %d.%d.%d, seed %llu, %d starts per distribution, %s "
                  "masking, specular at most %g.</p>\n</body>\n</html>\n", ASP_VERSION_MAJOR,
             ASP_VERSION_MINOR, ASP_VERSION_PATCH, (unsigned long long)r->seed, r->starts, report_mask_name(r->mask),
             r->specular_limit);
}

/* ------------------------------------------------------------------ several files */

void report_index(const report_entry *entry, size_t count, page *out)
{
    report_head(out, "Fits");
    size_t cells = 1;
    for (size_t i = 0; i < count; i++)
        cells = entry[i].cells > cells ? entry[i].cells : cells;
    page_put(out, "<h1>Fits</h1>\n<table>\n<tr><th>measurement</th><th colspan=\"%zu\">error, the "
                  "best of each marked</th></tr>\n", cells);
    for (size_t i = 0; i < count; i++) {
        page_add(out, "<tr><td><a href=\"");
        for (const char *c = entry[i].name; *c; c++)       /* RFC 3986: the unreserved as they are */
            if ((*c >= 'a' && *c <= 'z') || (*c >= 'A' && *c <= 'Z') || (*c >= '0' && *c <= '9')
                || strchr("-._~", *c))
                page_put(out, "%c", *c);
            else
                page_put(out, "%%%02X", (unsigned)(unsigned char)*c);
        page_add(out, "/report.html\">");
        page_escaped(out, entry[i].name);
        page_put(out, "</a></td>%s</tr>\n", entry[i].summary);
    }
    page_add(out, "</table>\n</body>\n</html>\n");
}
