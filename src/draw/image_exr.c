/* image_exr.c - OpenEXR scan lines through OpenEXR's C interface, into memory
 *
 * Readers take a chunk whose packed size equals its raw size for an uncompressed one; the ZIP writer
 * of OpenEXR 3.1.5 stores compressed bytes in that case. So PIZ, and `compress` below stores every
 * chunk raw that did not get smaller. */
#include <openexr.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw/image.h"

typedef struct writer {
    aspi_bytes block;
    int        no_memory;
    char       message[160];
    exr_result_t (*compress)(exr_encode_pipeline_t *pipe);
} writer;

/* The library's own handler prints. */
static void on_error(exr_const_context_t context, exr_result_t code, const char *message)
{
    void *user = NULL;
    (void)code;
    if (context && exr_get_user_data(context, &user) == EXR_ERR_SUCCESS && user) {
        writer *w = user;
        snprintf(w->message, sizeof w->message, "%s", message);
    }
}

static int64_t on_write(exr_const_context_t context, void *user, const void *data, uint64_t size,
                        uint64_t offset, exr_stream_error_func_ptr_t error)
{
    (void)context;
    (void)error;
    writer *w = user;
    if (!aspi_bytes_write(&w->block, (size_t)offset, data, (size_t)size)) {
        w->no_memory = 1;
        return -1;
    }
    return (int64_t)size;
}

static exr_result_t compress(exr_encode_pipeline_t *pipe)
{
    writer *w = pipe->encoding_user_data;
    exr_result_t result = w->compress(pipe);
    if (result == EXR_ERR_SUCCESS && pipe->compressed_buffer && pipe->compressed_buffer != pipe->packed_buffer
        && pipe->compressed_bytes >= pipe->packed_bytes) {
        memcpy(pipe->compressed_buffer, pipe->packed_buffer, pipe->packed_bytes);
        pipe->compressed_bytes = pipe->packed_bytes;
    }
    return result;
}

/* Lossless rounding by the float's bits: exponents 113..142 are normal halfs, 103..112 subnormal. */
uint16_t aspi_half(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, 4);
    uint16_t sign = (uint16_t)(bits >> 16 & 0x8000);
    uint32_t magnitude = bits & 0x7fffffff;
    if (magnitude > 0x7f800000)
        return (uint16_t)(sign | 0x7e00);               /* NaN */
    if (magnitude == 0x7f800000)
        return (uint16_t)(sign | 0x7c00);
    if (magnitude >= 0x477fe000)
        return (uint16_t)(sign | 0x7bff);               /* 65504 and beyond */
    if (magnitude < 0x33000000)
        return sign;                                    /* below half of the least, 2^-25 */
    int exponent = (int)(magnitude >> 23);
    uint32_t mantissa = (magnitude & 0x7fffff) | 0x800000;
    int shift = exponent >= 113 ? 13 : 126 - exponent;
    uint32_t kept = mantissa >> shift, rest = mantissa & ((1u << shift) - 1), tie = 1u << (shift - 1);
    if (exponent >= 113)
        kept += (uint32_t)(exponent - 113) << 10;       /* the leading 1 adds one more exponent */
    kept += rest > tie || (rest == tie && (kept & 1));
    return (uint16_t)(sign | kept);
}

/* One chunk's lines as planes B, G, R (the alphabetical order of the file). */
static void fill_planes(const asp_image *image, int first, int lines, int is_float, void *planes)
{
    size_t width = (size_t)image->width, plane = width * (size_t)lines;
    for (int line = 0; line < lines; line++) {
        const float *from = image->rgb + 3 * (size_t)(first + line) * width;
        for (size_t x = 0; x < width; x++)
            for (size_t c = 0; c < 3; c++) {
                size_t to = (2 - c) * plane + (size_t)line * width + x;
                if (is_float)
                    ((float *)planes)[to] = from[3 * x + c];
                else
                    ((uint16_t *)planes)[to] = aspi_half(from[3 * x + c]);
            }
    }
}

static exr_result_t write_chunk(exr_context_t file, const asp_image *image, int y, int is_float,
                                void *planes, exr_encode_pipeline_t *pipe, writer *w)
{
    exr_chunk_info_t chunk;
    exr_result_t r = exr_write_scanline_chunk_info(file, 0, y, &chunk);
    if (r == EXR_ERR_SUCCESS)
        r = y == 0 ? exr_encoding_initialize(file, 0, &chunk, pipe)
                   : exr_encoding_update(file, 0, &chunk, pipe);
    if (r != EXR_ERR_SUCCESS)
        return r;
    int size = is_float ? 4 : 2;
    fill_planes(image, y, chunk.height, is_float, planes);
    for (int c = 0; c < pipe->channel_count; c++) {
        exr_coding_channel_info_t *channel = &pipe->channels[c];
        channel->user_bytes_per_element = (int16_t)size;
        channel->user_data_type = is_float ? EXR_PIXEL_FLOAT : EXR_PIXEL_HALF;
        channel->user_pixel_stride = size;
        channel->user_line_stride = size * image->width;
        channel->encode_from_ptr = (const uint8_t *)planes
            + (size_t)c * (size_t)size * (size_t)image->width * (size_t)chunk.height;
    }
    if (y == 0) {
        r = exr_encoding_choose_default_routines(file, 0, pipe);
        w->compress = pipe->compress_fn;
        pipe->encoding_user_data = w;
        if (pipe->compress_fn)
            pipe->compress_fn = compress;
    }
    return r == EXR_ERR_SUCCESS ? exr_encoding_run(file, 0, pipe) : r;
}

static exr_result_t write_header(exr_context_t file, const asp_image *image, int is_float,
                                 exr_compression_t compression)
{
    static const char *const names[] = { "B", "G", "R" };
    int part;
    exr_result_t r = exr_add_part(file, "image", EXR_STORAGE_SCANLINE, &part);
    if (r == EXR_ERR_SUCCESS)
        r = exr_initialize_required_attr_simple(file, part, image->width, image->height, compression);
    for (int c = 0; c < 3 && r == EXR_ERR_SUCCESS; c++)
        r = exr_add_channel(file, part, names[c], is_float ? EXR_PIXEL_FLOAT : EXR_PIXEL_HALF,
                            EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1);
    return r == EXR_ERR_SUCCESS ? exr_write_header(file) : r;
}

asp_status aspi_exr_encode(const asp_image *image, const asp_image_options *options,
                           unsigned char **bytes, size_t *size, asp_error *err)
{
    writer w = { { NULL, 0, 0 }, 0, "the encoder failed", NULL };
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    init.error_handler_fn = on_error;
    init.user_data = &w;
    init.write_fn = on_write;
    int is_float = options->exr_float != 0;
    exr_compression_t compression = options->exr_uncompressed ? EXR_COMPRESSION_NONE
                                                              : EXR_COMPRESSION_PIZ;
    exr_context_t file;
    exr_encode_pipeline_t pipe = EXR_ENCODE_PIPELINE_INITIALIZER;
    void *planes = NULL;
    exr_result_t r = exr_start_write(&file, "memory", EXR_WRITE_FILE_DIRECTLY, &init);
    if (r == EXR_ERR_SUCCESS) {
        int lines = 1;
        r = write_header(file, image, is_float, compression);
        if (r == EXR_ERR_SUCCESS)
            r = exr_get_scanlines_per_chunk(file, 0, &lines);
        planes = malloc(3 * (is_float ? 4u : 2u) * (size_t)image->width * (size_t)lines);
        if (!planes) {
            w.no_memory = 1;
            r = EXR_ERR_OUT_OF_MEMORY;
        }
        for (int y = 0; y < image->height && r == EXR_ERR_SUCCESS; y += lines)
            r = write_chunk(file, image, y, is_float, planes, &pipe, &w);
        exr_encoding_destroy(file, &pipe);
        exr_result_t last = exr_finish(&file);       /* writes the table of chunks */
        r = r == EXR_ERR_SUCCESS ? last : r;
    }
    free(planes);
    if (r != EXR_ERR_SUCCESS || w.no_memory) {
        free(w.block.data);
        int no_memory = w.no_memory || r == EXR_ERR_OUT_OF_MEMORY;
        return asp_fail(err, no_memory ? ASP_ENOMEM : ASP_EIO, "exr",
                        no_memory ? "out of memory" : w.message);
    }
    *bytes = w.block.data;
    *size = w.block.size;
    return ASP_OK;
}
