/* report_numbers.c - numbers with as many digits as they deserve, and the table on the terminal */
#include "report.h"

#include <math.h>
#include <string.h>

size_t report_best(const report *r)
{
    size_t best = 0;
    for (size_t i = 1; i < r->count; i++)
        if (r->result[i].error[r->loss_index] < r->result[best].error[r->loss_index])
            best = i;
    return best;
}

/* Decimals that show two digits of the uncertainty, between one and six. */
static int decimals(double uncertainty)
{
    if (!(uncertainty > 0))
        return 4;
    int d = 1 - (int)floor(log10(uncertainty));
    return d < 1 ? 1 : d > 6 ? 6 : d;
}

const char *report_number(const asp_fit_parameter *p, const char *sign, char *buffer, size_t size)
{
    int d = decimals(p->uncertainty);
    if (isinf(p->value))
        snprintf(buffer, size, "inf (> %.3g)", p->low);
    else if (p->at_bound)
        snprintf(buffer, size, "%.4g (limit)", p->value);
    else if (isinf(p->uncertainty))
        snprintf(buffer, size, "%.4g (free)", p->value);
    else if (!p->determined)
        snprintf(buffer, size, "%.3g (%.3g..%.3g)", p->value, p->low, p->high);
    else
        snprintf(buffer, size, "%.*f %s %.*f", d, p->value, sign, d, p->uncertainty);
    return buffer;
}

const char *report_mask_name(int mask)
{
    static const char *const name[2][3] = {
        { "correlated", "uncorrelated", "v_cavity" },
        { "correlated+wall", "uncorrelated+wall", "v_cavity+wall" }
    };
    return name[(mask & ASP_MASK_WALL) != 0][mask & 3];
}

const asp_fit_parameter *report_find(const asp_fit_result *f, const char *name)
{
    for (size_t k = 0; k < f->parameter_count; k++)
        if (!strcmp(f->parameter[k].name, name))
            return &f->parameter[k];
    return NULL;
}

#define ABREAST 4                      /* distributions that stand beside each other on a terminal */

static void row_of(const report *r, const char *name, size_t first, size_t end, FILE *file)
{
    char cell[64];
    int any = 0;
    for (size_t i = first; i < end; i++)
        any |= report_find(&r->result[i], name) != NULL;
    if (!any)
        return;
    fprintf(file, "  %-14s", name);
    for (size_t i = first; i < end; i++) {
        const asp_fit_parameter *p = report_find(&r->result[i], name);
        fprintf(file, " %-22s", p ? report_number(p, "+-", cell, sizeof cell) : "-");
    }
    fputc('\n', file);
}

static int is_among(const char *name, const char *const *list, size_t count)
{
    for (size_t k = 0; k < count; k++)
        if (!strcmp(name, list[k]))
            return 1;
    return 0;
}

/* Alpha, then what only some models have, then what all share (as many colours as channels). */
size_t report_rows(const report *r, const char **out, size_t room)
{
    static const char *const shared[] = { "eta", "diffuse", "diffuse_r", "diffuse_g", "diffuse_b",
                                          "specular", "specular_r", "specular_g", "specular_b" };
    size_t n = 0, all = sizeof shared / sizeof *shared;
    for (size_t i = 0; i < r->count && n < room && !n; i++)
        if (report_find(&r->result[i], "alpha"))
            out[n++] = "alpha";
    for (size_t i = 0; i < r->count; i++)
        for (size_t k = 0; k < r->result[i].parameter_count; k++) {
            const char *name = r->result[i].parameter[k].name;
            if (n < room && !is_among(name, shared, all) && !is_among(name, out, n))
                out[n++] = name;
        }
    for (size_t k = 0; k < all; k++)
        if (n < room && r->count && report_find(&r->result[0], shared[k]))
            out[n++] = shared[k];
    return n;
}

static void table_of(const report *r, size_t first, size_t end, FILE *file)
{
    const asp_loss *const *loss = asp_losses();
    fprintf(file, "  %-14s", "");
    for (size_t i = first; i < end; i++)
        fprintf(file, " %-22s", r->result[i].model->name);
    fputc('\n', file);
    for (int l = 0; loss[l]; l++) {
        fprintf(file, "  %-14s", loss[l]->name);
        for (size_t i = first; i < end; i++) {
            char cell[32];
            snprintf(cell, sizeof cell, "%.6f%s", r->result[i].error[l],
                     l == r->loss_index && i == r->best ? "  <- best" : "");
            fprintf(file, " %-22s", cell);
        }
        fputc('\n', file);
    }
    const char *name[REPORT_ROWS];
    size_t rows = report_rows(r, name, REPORT_ROWS);
    for (size_t k = 0; k < rows; k++)
        row_of(r, name[k], first, end, file);
}

void report_table(const report *r, FILE *file)
{
    if (r->made)
        fprintf(file, "fabricated: rays traced against an explicit surface whose facets have "
                      "student_t slopes of alpha %.4f, gamma %.3f", r->truth->slopes.alpha,
                r->truth->slopes.gamma);
    else
        fprintf(file, "%s: %s%s%s", r->file, r->info.format, r->info.description[0] ? ", " : "",
                r->info.description);
    fprintf(file, "\n  %zu geometries, fitted by %s\n", r->geometries, r->loss);
    for (size_t first = 0; first < r->count; first += ABREAST)
        table_of(r, first, first + ABREAST < r->count ? first + ABREAST : r->count, file);
    for (size_t i = 0; i < r->count; i++)
        if (r->result[i].reason < 0)
            fprintf(file, "  %s: %s\n", r->result[i].model->name,
                    asp_fit_reason_text(r->result[i].reason));
}
