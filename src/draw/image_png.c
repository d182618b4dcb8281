/* image_png.c - 8-bit sRGB through libpng, into memory */
#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw/image.h"

typedef struct writer {
    aspi_bytes block;
    char       message[128];
} writer;

/* libpng's own handlers print; these keep the reason. */
static void on_error(png_structp png, png_const_charp message)
{
    writer *w = png_get_error_ptr(png);
    snprintf(w->message, sizeof w->message, "%s", message);
    longjmp(png_jmpbuf(png), 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static void on_write(png_structp png, png_bytep data, png_size_t size)
{
    writer *w = png_get_io_ptr(png);
    if (!aspi_bytes_write(&w->block, w->block.size, data, size))
        png_error(png, "out of memory");
}

static void on_flush(png_structp png)
{
    (void)png;
}

/* Nothing that changes after setjmp is read after longjmp but what `w` points to. */
static int encode(writer *w, png_structp png, png_infop info, const asp_image *image,
                  const asp_tone *tone, png_bytep row)
{
    if (setjmp(png_jmpbuf(png)))
        return 0;
    png_set_write_fn(png, w, on_write, on_flush);
    png_set_IHDR(png, info, (png_uint_32)image->width, (png_uint_32)image->height, 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    for (int y = 0; y < image->height; y++) {
        const float *from = image->rgb + 3 * (size_t)y * (size_t)image->width;
        for (int x = 0; x < image->width; x++)
            aspi_tone_pixel(tone, from + 3 * x, row + 3 * x);
        png_write_row(png, row);
    }
    png_write_end(png, info);
    return 1;
}

asp_status aspi_png_encode(const asp_image *image, const asp_image_options *options,
                           unsigned char **bytes, size_t *size, asp_error *err)
{
    asp_status status = aspi_tone_check(&options->tone, err);
    if (status != ASP_OK)
        return status;
    writer w = { { NULL, 0, 0 }, "out of memory" };
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &w, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    png_bytep row = malloc(3 * (size_t)image->width);
    int good = info && row && encode(&w, png, info, image, &options->tone, row);
    if (png)
        png_destroy_write_struct(&png, info ? &info : NULL);
    free(row);
    if (!good) {
        free(w.block.data);
        return asp_fail(err, ASP_ENOMEM, "png", w.message);
    }
    *bytes = w.block.data;
    *size = w.block.size;
    return ASP_OK;
}
