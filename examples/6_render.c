/* 6_render.c - spheres from GGX's long highlight to Beckmann's short one, side by side
 *
 * Installed with `make install PREFIX=...` (and PKG_CONFIG_PATH set when the prefix is your own):
 *
 *     cc -O2 examples/6_render.c $(pkg-config --cflags --libs asperity-draw) -o render && ./render
 */
#include "asperity_draw.h"
#include <stdio.h>

int main(void)
{
    static const char *const specs[3] = {
        "conductor:metal=Cu,ndf=(student_t:alpha=0.15,gamma=1.55)",
        "conductor:metal=Cu,ndf=(ggx:alpha=0.15)",
        "conductor:metal=Cu,ndf=(beckmann:alpha=0.15)"
    };
    asp_image_options tone = { .tone = { .exposure = -0.4, .soft = 0.5 } };
    asp_image strip = { 0 }, image = { 0 };
    asp_error err;
    char text[512];
    double mean = 0.0;
    int i;

    if (asp_image_make(3 * 192, 192, &strip, &err) != ASP_OK)
        goto failed;
    for (i = 0; i < 3; i++) {
        asp_material copper;
        asp_preview look = { .material = &copper, .width = 192, .height = 192, .samples = 64 };
        if (asp_material_parse(NULL, specs[i], &copper, &err) != ASP_OK ||
            asp_preview_render(&look, &image, &err) != ASP_OK)
            goto failed;
        asp_image_place(&strip, &image, 192 * i, 0);
        asp_image_free(&image);
    }
    if (asp_image_write(&strip, "spheres.png", &tone, &err) != ASP_OK)
        goto failed;
    for (i = 0; i < 3 * strip.width * strip.height; i++)
        mean += strip.rgb[i];
    printf("spheres.png: %d x %d, mean %.2f\n", strip.width, strip.height,
           mean / (3 * strip.width * strip.height));
    asp_image_free(&strip);
    return 0;
failed:
    fprintf(stderr, "%s\n", asp_error_text(&err, text, sizeof text));
    asp_image_free(&strip);
    return 1;
}
