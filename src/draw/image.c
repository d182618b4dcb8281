/* image.c - float images, tone, base64, and the choice of a file format by its extension */
#include "draw/image.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw/text.h"

asp_status aspi_image_check(const asp_image *image, asp_error *err)
{
    if (!image || !image->rgb)
        return asp_fail(err, ASP_EINVAL, "image", "an image without pixels");
    if (image->width < 1 || image->width > ASP_IMAGE_SIDE)
        return asp_fail_range(err, "width", image->width, 1, 0, ASP_IMAGE_SIDE);
    if (image->height < 1 || image->height > ASP_IMAGE_SIDE)
        return asp_fail_range(err, "height", image->height, 1, 0, ASP_IMAGE_SIDE);
    return ASP_OK;
}

asp_status asp_image_make(int width, int height, asp_image *out, asp_error *err)
{
    float one[3];
    asp_image image = { width, height, one };
    asp_status status = aspi_image_check(&image, err);
    if (status != ASP_OK)
        return status;
    image.rgb = calloc((size_t)width * (size_t)height, 3 * sizeof *image.rgb);
    if (!image.rgb)
        return asp_fail(err, ASP_ENOMEM, "image", "out of memory");
    *out = image;
    return ASP_OK;
}

void asp_image_free(asp_image *image)
{
    if (!image)
        return;
    free(image->rgb);
    *image = (asp_image){ 0, 0, NULL };
}

void asp_image_place(asp_image *target, const asp_image *source, int left, int top)
{
    /* 64 bits: left + width may leave int */
    long long first = left < 0 ? -(long long)left : 0;
    long long last = (long long)target->width - left;
    last = last < source->width ? last : source->width;
    if (first >= last)
        return;
    for (int row = 0; row < source->height; row++) {
        long long to = (long long)top + row;
        if (to < 0 || to >= target->height)
            continue;
        memcpy(target->rgb + 3 * (to * target->width + left + first),
               source->rgb + 3 * ((long long)row * source->width + first),
               3 * sizeof(float) * (size_t)(last - first));
    }
}

/* ------------------------------------------------------------------ tone */

asp_status aspi_tone_check(const asp_tone *tone, asp_error *err)
{
    if (!(tone->exposure >= -64 && tone->exposure <= 64))
        return asp_fail_range(err, "exposure", tone->exposure, -64, 0, 64);
    if (!(tone->soft >= 0 && tone->soft <= 1))
        return asp_fail_range(err, "soft", tone->soft, 0, 0, 1);
    return ASP_OK;
}

/* IEC 61966-2-1. */
static double srgb(double linear)
{
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1 / 2.4) - 0.055;
}

void aspi_tone_pixel(const asp_tone *tone, const float *rgb, unsigned char *out)
{
    if (isnan(rgb[0]) || isnan(rgb[1]) || isnan(rgb[2])) {
        memcpy(out, (unsigned char[]){ 255, 0, 255 }, 3);
        return;
    }
    for (int c = 0; c < 3; c++) {
        double x = exp2(tone->exposure) * rgb[c], knee = 1 - tone->soft;
        if (x > knee && tone->soft > 0)
            x = knee + tone->soft * (1 - exp(-(x - knee) / tone->soft));
        x = x > 0 ? x < 1 ? x : 1 : 0;
        out[c] = (unsigned char)(255 * srgb(x) + 0.5);
    }
}

/* ------------------------------------------------------------------ bytes */

int aspi_bytes_write(aspi_bytes *block, size_t offset, const void *data, size_t size)
{
    if (size > SIZE_MAX / 4 || offset > SIZE_MAX / 4)
        return 0;
    size_t end = offset + size;
    if (end > block->room) {
        size_t room = end + end / 2 + 4096;
        unsigned char *grown = realloc(block->data, room);
        if (!grown)
            return 0;
        block->data = grown;
        block->room = room;
    }
    if (offset > block->size)
        memset(block->data + block->size, 0, offset - block->size);
    memcpy(block->data + offset, data, size);
    block->size = end > block->size ? end : block->size;
    return 1;
}

/* RFC 4648, section 4. */
char *asp_base64(const void *bytes, size_t size)
{
    static const char digit[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *b = bytes;
    if (size > SIZE_MAX / 2)
        return NULL;
    char *text = malloc((size + 2) / 3 * 4 + 1), *out = text;
    if (!text)
        return NULL;
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i;
        uint32_t v = (uint32_t)b[i] << 16 | (left > 1 ? (uint32_t)b[i + 1] << 8 : 0)
                     | (left > 2 ? b[i + 2] : 0u);
        *out++ = digit[v >> 18];
        *out++ = digit[v >> 12 & 63];
        *out++ = left > 1 ? digit[v >> 6 & 63] : '=';
        *out++ = left > 2 ? digit[v & 63] : '=';
    }
    *out = '\0';
    return text;
}

/* ------------------------------------------------------------------ pfm */

/* "PF", sizes, scale (negative: little-endian), rows from bottom to top. */
asp_status aspi_pfm_encode(const asp_image *image, const asp_image_options *options,
                           unsigned char **bytes, size_t *size, asp_error *err)
{
    (void)options;
    char header[64];
    int start = snprintf(header, sizeof header, "PF\n%d %d\n-1.0\n", image->width, image->height);
    size_t row = 3 * (size_t)image->width;
    unsigned char *data = malloc((size_t)start + 4 * row * (size_t)image->height);
    if (!data)
        return asp_fail(err, ASP_ENOMEM, "pfm", "out of memory");
    memcpy(data, header, (size_t)start);
    unsigned char *out = data + start;
    for (int y = image->height - 1; y >= 0; y--)
        for (size_t i = 0; i < row; i++) {
            uint32_t v;
            memcpy(&v, image->rgb + (size_t)y * row + i, 4);
            for (int k = 0; k < 4; k++)
                *out++ = (unsigned char)(v >> 8 * k & 255);
        }
    *bytes = data;
    *size = (size_t)(out - data);
    return ASP_OK;
}

/* ------------------------------------------------------------------ by extension */

typedef asp_status encoder(const asp_image *image, const asp_image_options *options,
                           unsigned char **bytes, size_t *size, asp_error *err);

static const struct { const char *extension; encoder *encode; } formats[] = {
    { ".png", aspi_png_encode },
    { ".exr", aspi_exr_encode },
    { ".pfm", aspi_pfm_encode },
};
#define FORMATS (sizeof formats / sizeof *formats)

static int same_word(const char *a, const char *b)
{
    for (; *a && *b; a++, b++)
        if ((*a | 32) != (*b | 32))         /* letters and a dot: 32 is the case bit */
            return 0;
    return *a == *b;
}

static encoder *find_encoder(const char *path, asp_error *err)
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path, *dot = strrchr(name, '.');
    for (size_t i = 0; dot && i < FORMATS; i++)
        if (same_word(dot, formats[i].extension))
            return formats[i].encode;
    char reason[192] = "the name must end in one of";
    for (size_t i = 0; i < FORMATS; i++) {
        size_t used = strlen(reason);
        snprintf(reason + used, sizeof reason - used, "%s %s", i ? "," : "", formats[i].extension);
    }
    asp_fail(err, ASP_EUNKNOWN, dot ? dot : "extension", reason);
    if (err)
        snprintf(err->file, sizeof err->file, "%s", path);
    return NULL;
}

asp_status asp_image_write(const asp_image *image, const char *path,
                           const asp_image_options *options, asp_error *err)
{
    static const asp_image_options defaults = { { 0, 0 }, 0, 0 };
    if (!path || !*path)
        return asp_fail(err, ASP_EINVAL, "path", "no file name");
    encoder *encode = find_encoder(path, err);
    if (!encode)
        return ASP_EUNKNOWN;
    asp_status status = aspi_image_check(image, err);
    if (status != ASP_OK)
        return status;
    unsigned char *bytes;
    size_t size;
    status = encode(image, options ? options : &defaults, &bytes, &size, err);
    if (status != ASP_OK)
        return status;
    status = asp_file_write(path, bytes, size, err);
    free(bytes);
    return status;
}

asp_status asp_image_png(const asp_image *image, const asp_tone *tone, unsigned char **bytes,
                         size_t *size, asp_error *err)
{
    asp_image_options options = { { 0, 0 }, 0, 0 };
    if (tone)
        options.tone = *tone;
    asp_status status = aspi_image_check(image, err);
    return status == ASP_OK ? aspi_png_encode(image, &options, bytes, size, err) : status;
}
