/* draw.c - a program that uses all three libraries */
#include "asperity_draw.h"
#include <stdio.h>
#include <stdlib.h>

int main(void)
{
    double theta[19], D[19];
    asp_series curve = { .label = "ggx", .x = theta, .y = D, .count = 19 };
    asp_chart chart = { .title = "D", .series = &curve, .series_count = 1 };
    asp_error err;
    asp_measured *none = asp_measured_read("no such file", &err);
    char *svg;
    int i;
    if (none || err.status != ASP_EIO)
        return 1;
    for (i = 0; i < 19; i++) {
        theta[i] = 5.0 * i;
        D[i] = 1.0 / (1.0 + i);
    }
    svg = asp_chart_svg(&chart, &err);
    if (!svg)
        return 1;
    printf("%.4s\n", svg);
    free(svg);
    return 0;
}
