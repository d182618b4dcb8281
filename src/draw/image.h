/* image.h - encoders: an image as the bytes of a file, to be freed with free() */
#ifndef ASPI_DRAW_IMAGE_H
#define ASPI_DRAW_IMAGE_H

#include "asperity_draw.h"

/* ASP_EINVAL for an empty image or sizes out of range. */
asp_status aspi_image_check(const asp_image *image, asp_error *err);
asp_status aspi_tone_check(const asp_tone *tone, asp_error *err);

/* One pixel of linear light as three bytes of sRGB. */
void aspi_tone_pixel(const asp_tone *tone, const float *rgb, unsigned char *out);

/* The nearest half (IEEE 754 binary16, ties to even); finite values never become infinite. */
uint16_t aspi_half(float value);

asp_status aspi_png_encode(const asp_image *image, const asp_image_options *options,
                           unsigned char **bytes, size_t *size, asp_error *err);
asp_status aspi_exr_encode(const asp_image *image, const asp_image_options *options,
                           unsigned char **bytes, size_t *size, asp_error *err);
asp_status aspi_pfm_encode(const asp_image *image, const asp_image_options *options,
                           unsigned char **bytes, size_t *size, asp_error *err);

/* A growing block of bytes that can be written to anywhere (holes are zero). 0: no memory. */
typedef struct aspi_bytes { unsigned char *data; size_t size, room; } aspi_bytes;
int aspi_bytes_write(aspi_bytes *block, size_t offset, const void *data, size_t size);

#endif
