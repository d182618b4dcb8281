/* core.c - a program that uses the core alone */
#include "asperity.h"
#include <stdio.h>

int main(void)
{
    asp_vec3 w = { 0.6, 0.0, 0.8 };
    asp_error err;
    asp_ndf ndf;
    if (asp_ndf_parse(NULL, "ggx:alpha=0.5", &ndf, &err) != ASP_OK)
        return 1;
    printf("sigma %.12f\n", asp_sigma(&ndf, w));
    return 0;
}
