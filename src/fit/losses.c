/* losses.c - the table of losses: one row each */
#include "fit.h"

#include <string.h>

#define ROWS(row) row(nad) row(log) row(relative)

#define RECORD(name) &aspi_loss_##name,
#define ABOUT(name) &aspi_loss_##name.about,
const aspi_loss *const aspi_losses[] = { ROWS(RECORD) NULL };
static const asp_loss *const public_rows[] = { ROWS(ABOUT) NULL };

const asp_loss *const *asp_losses(void)
{
    return public_rows;
}

const aspi_loss *aspi_find_loss(const char *name)
{
    for (size_t i = 0; aspi_losses[i]; i++)
        if (!strcmp(aspi_losses[i]->about.name, name))
            return aspi_losses[i];
    return NULL;
}

double aspi_loss_count(size_t n, const double *data, const double *weight)
{
    (void)data;
    (void)weight;
    return (double)n;
}

void aspi_fit_set_weights(aspi_fit_set *set, const aspi_loss *loss)
{
    for (size_t i = 0; i < set->n; i++)
        set->weight[i] = loss->weight(set->wi_z[i], set->wo_z[i]);
}
