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
        snprintf(buffer, size, "%.3g (%.2g..%.2g)", p->value, p->low, p->high);
    else
        snprintf(buffer, size, "%.*f %s %.*f", d, p->value, sign, d, p->uncertainty);
    return buffer;
}

static void row_of(const report *r, const char *name, FILE *file)
{
    char cell[64];
    fprintf(file, "  %-14s", name);
    for (size_t i = 0; i < r->count; i++) {
        const asp_fit_result *f = &r->result[i];
        const asp_fit_parameter *p = NULL;
        for (size_t k = 0; k < f->parameter_count; k++)
            if (!strcmp(f->parameter[k].name, name))
                p = &f->parameter[k];
        fprintf(file, " %-22s", p ? report_number(p, "+-", cell, sizeof cell) : "-");
    }
    fputc('\n', file);
}

/* Every parameter name once, in the order in which the results have them. */
static void rows(const report *r, FILE *file)
{
    const char *done[ASP_FIT_PARAMETERS * 4];
    size_t n = 0, room = sizeof done / sizeof *done;
    for (size_t k = 0; k < ASP_FIT_PARAMETERS; k++)
        for (size_t i = 0; i < r->count; i++) {
            const asp_fit_result *f = &r->result[i];
            size_t known = 0;
            /* shape numbers stand between alpha and eta: leave room for those of others */
            if (k >= f->parameter_count)
                continue;
            while (known < n && strcmp(done[known], f->parameter[k].name))
                known++;
            if (known == n && n < room)
                done[n++] = f->parameter[k].name;
        }
    /* alpha, shapes, then what all share */
    static const char *const last[] = { "eta", "diffuse_r", "diffuse_g", "diffuse_b", "specular_r",
                                        "specular_g", "specular_b" };
    for (size_t k = 0; k < n; k++) {
        int shared = 0;
        for (size_t i = 0; i < sizeof last / sizeof *last; i++)
            shared |= !strcmp(done[k], last[i]);
        if (!shared)
            row_of(r, done[k], file);
    }
    for (size_t i = 0; i < sizeof last / sizeof *last; i++)
        row_of(r, last[i], file);
}

void report_table(const report *r, FILE *file)
{
    const asp_loss *const *loss = asp_losses();
    fprintf(file, "%s: %s, %s%s%zu geometries fitted by %s\n", r->file ? r->file : r->title,
            r->info.format, r->info.description, r->info.description[0] ? ", " : "", r->geometries,
            r->loss);
    fprintf(file, "  %-14s", "");
    for (size_t i = 0; i < r->count; i++)
        fprintf(file, " %-22s", r->result[i].model->name);
    fputc('\n', file);
    for (int l = 0; loss[l]; l++) {
        fprintf(file, "  %-14s", loss[l]->name);
        for (size_t i = 0; i < r->count; i++) {
            char cell[32];
            snprintf(cell, sizeof cell, "%.6f%s", r->result[i].error[l],
                     l == r->loss_index && i == r->best ? "  <- best" : "");
            fprintf(file, " %-22s", cell);
        }
        fputc('\n', file);
    }
    rows(r, file);
    for (size_t i = 0; i < r->count; i++)
        if (r->result[i].reason < 0)
            fprintf(file, "  %s: %s\n", r->result[i].model->name,
                    asp_fit_reason_text(r->result[i].reason));
}
