/* test_draw_image.c - PNG, EXR and PFM read back by other code, errors of the disk, base64 */
#define _XOPEN_SOURCE 700
#include <openexr.h>
#include <png.h>
#include <signal.h>
#include <sys/resource.h>

#include "draw_test.h"

#include "draw/image.h"

static asp_image make(int width, int height)
{
    asp_image image = { 0, 0, NULL };
    if (asp_image_make(width, height, &image, NULL) != ASP_OK)
        exit(1);
    return image;
}

/* ------------------------------------------------------------------ PNG */

static unsigned char *decode_png(const void *bytes, size_t size, int *width, int *height)
{
    png_image png;
    memset(&png, 0, sizeof png);
    png.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_memory(&png, bytes, size))
        return NULL;
    png.format = PNG_FORMAT_RGB;
    *width = (int)png.width;
    *height = (int)png.height;
    unsigned char *pixels = malloc(PNG_IMAGE_SIZE(png));
    if (!pixels || !png_image_finish_read(&png, NULL, pixels, 0, NULL)) {
        free(pixels);
        return NULL;
    }
    return pixels;
}

/* The pixel a PNG makes of three values. */
static int png_pixel(float r, float g, float b, asp_tone tone, unsigned char out[3])
{
    float rgb[3] = { r, g, b };
    asp_image one = { 1, 1, rgb };
    unsigned char *bytes;
    size_t size;
    int width = 0, height = 0;
    if (asp_image_png(&one, &tone, &bytes, &size, NULL) != ASP_OK)
        return 0;
    unsigned char *pixels = decode_png(bytes, size, &width, &height);
    free(bytes);
    if (!pixels || width != 1 || height != 1) {
        free(pixels);
        return 0;
    }
    memcpy(out, pixels, 3);
    free(pixels);
    return 1;
}

static void test_tone(void)
{
    const asp_tone plain = { 0, 0 };
    unsigned char p[3] = { 0 }, q[3] = { 0 };
    /* code n/255 taken back to linear light by the standard's inverse must give n again */
    for (int n = 0; n < 256; n++) {
        double v = n / 255.0, linear = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
        CHECK(png_pixel((float)linear, 0, 1, plain, p) && p[0] == n && p[1] == 0 && p[2] == 255,
              "sRGB code %d comes back as %d", n, p[0]);
    }
    CHECK(png_pixel(0.18f, 0.5f, 2, plain, p) && p[0] == 118 && p[1] == 188 && p[2] == 255,
          "0.18, 0.5, 2 give %d %d %d", p[0], p[1], p[2]);
    CHECK(png_pixel(NAN, 0.5f, 0, plain, p) && p[0] == 255 && p[1] == 0 && p[2] == 255, "NaN is magenta");
    CHECK(png_pixel(-1, INFINITY, -INFINITY, plain, p) && p[0] == 0 && p[1] == 255 && p[2] == 0,
          "below 0, infinities");
    CHECK(png_pixel(0.1f, 0.2f, 0.3f, (asp_tone){ 1, 0 }, p)
          && png_pixel(0.2f, 0.4f, 0.6f, plain, q) && memcmp(p, q, 3) == 0, "one stop doubles");
    CHECK(png_pixel(0.59f, 0.2f, 0.1f, (asp_tone){ 0, 0.4 }, p)
          && png_pixel(0.59f, 0.2f, 0.1f, plain, q) && memcmp(p, q, 3) == 0, "soft leaves what is below");
    int last = 0, largest = 0;
    for (int i = 0; i <= 300; i++) {
        if (!CHECK(png_pixel((float)(0.01 * i), 0, 0, (asp_tone){ 0, 0.4 }, p), "soft pixel"))
            continue;
        CHECK(p[0] >= last && p[0] - last <= 26, "soft tone at %g: %d after %d", 0.01 * i, p[0], last);
        last = p[0];
        largest = p[0] > largest ? p[0] : largest;
    }
    CHECK(largest >= 250 && largest <= 255 && png_pixel(0.8f, 1, 1.2f, (asp_tone){ 0, 0.4 }, p)
          && p[0] < p[1] && p[1] < p[2] && p[2] < 255, "soft keeps highlights apart");
    asp_error err;
    float rgb[3] = { 0 };
    asp_image one = { 1, 1, rgb };
    unsigned char *bytes;
    size_t size;
    CHECK(asp_image_png(&one, &(asp_tone){ 65, 0 }, &bytes, &size, &err) == ASP_EINVAL
          && strcmp(err.name, "exposure") == 0 && err.value == 65 && err.high == 64, "exposure refused");
    CHECK(asp_image_png(&one, &(asp_tone){ NAN, 0 }, &bytes, &size, &err) == ASP_EINVAL, "NaN exposure");
    CHECK(asp_image_png(&one, &(asp_tone){ 0, 1.5 }, &bytes, &size, &err) == ASP_EINVAL
          && strcmp(err.name, "soft") == 0, "soft refused");
    printf("tone: 256 sRGB codes, exposure, soft highlights, NaN\n");
}

static void test_png_file(void)
{
    asp_image image = make(37, 11);
    for (int i = 0; i < 37 * 11 * 3; i++)
        image.rgb[i] = (float)uniform();
    asp_error err = { 0 };
    const char *path = in_folder("picture.PNG");
    CHECK(asp_image_write(&image, path, NULL, &err) == ASP_OK, "png: %s", err.reason);
    size_t size, memory_size = 0;
    char *bytes = read_file(path, &size);
    unsigned char *memory = NULL;
    CHECK(asp_image_png(&image, NULL, &memory, &memory_size, &err) == ASP_OK
          && memory_size == size && bytes && memcmp(bytes, memory, size) == 0, "file and memory differ");
    int width = 0, height = 0;
    unsigned char *pixels = bytes ? decode_png(bytes, size, &width, &height) : NULL;
    int same = pixels && width == 37 && height == 11;
    for (int i = 0; same && i < 37 * 11; i++) {
        unsigned char expected[3];
        aspi_tone_pixel(&(asp_tone){ 0, 0 }, image.rgb + 3 * i, expected);
        same = memcmp(expected, pixels + 3 * i, 3) == 0;
    }
    CHECK(same, "png pixels");
    int has_srgb = 0;
    for (size_t i = 8; bytes && i + 4 < 120 && i + 4 < size; i++)
        has_srgb |= memcmp(bytes + i, "sRGB", 4) == 0;
    CHECK(has_srgb, "png has an sRGB chunk");
    free(pixels);
    free(memory);
    free(bytes);
    asp_image_free(&image);
}

/* ------------------------------------------------------------------ EXR */

/* Reads channels B, G, R as float through the library's decoder. 0 on any error. */
static int decode_exr(const char *path, asp_image *out, int *is_half)
{
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t file;
    if (exr_start_read(&file, path, &init) != EXR_ERR_SUCCESS)
        return 0;
    exr_attr_box2i_t window;
    const exr_attr_chlist_t *channels;
    int lines = 0, good = exr_get_data_window(file, 0, &window) == EXR_ERR_SUCCESS
        && exr_get_channels(file, 0, &channels) == EXR_ERR_SUCCESS && channels->num_channels == 3
        && exr_get_scanlines_per_chunk(file, 0, &lines) == EXR_ERR_SUCCESS;
    if (good) {
        *is_half = channels->entries[0].pixel_type == EXR_PIXEL_HALF;
        *out = make(window.max.x + 1, window.max.y + 1);
    }
    exr_decode_pipeline_t pipe = EXR_DECODE_PIPELINE_INITIALIZER;
    for (int y = 0; good && y < out->height; y += lines) {
        exr_chunk_info_t chunk;
        good = exr_read_scanline_chunk_info(file, 0, y, &chunk) == EXR_ERR_SUCCESS;
        good = good && (y == 0 ? exr_decoding_initialize(file, 0, &chunk, &pipe)
                               : exr_decoding_update(file, 0, &chunk, &pipe)) == EXR_ERR_SUCCESS;
        for (int c = 0; good && c < 3; c++) {
            const char *name = pipe.channels[c].channel_name;
            int to = name[0] == 'R' ? 0 : name[0] == 'G' ? 1 : 2;
            pipe.channels[c].user_bytes_per_element = 4;
            pipe.channels[c].user_data_type = EXR_PIXEL_FLOAT;
            pipe.channels[c].user_pixel_stride = 12;
            pipe.channels[c].user_line_stride = 12 * out->width;
            pipe.channels[c].decode_to_ptr =
                (uint8_t *)(out->rgb + 3 * (size_t)y * (size_t)out->width + to);
        }
        if (good && y == 0)
            good = exr_decoding_choose_default_routines(file, 0, &pipe) == EXR_ERR_SUCCESS;
        good = good && exr_decoding_run(file, 0, &pipe) == EXR_ERR_SUCCESS;
    }
    exr_decoding_destroy(file, &pipe);
    exr_finish(&file);
    return good;
}

static double half_value(uint16_t h)
{
    int exponent = h >> 10 & 31, mantissa = h & 1023;
    double v = exponent ? ldexp(1024 + mantissa, exponent - 25) : ldexp(mantissa, -24);
    return h & 0x8000 ? -v : v;
}

static void test_half(void)
{
    int wrong = 0, ties = 0;
    for (uint32_t h = 0; h < 0x7c00; h++) {
        double v = half_value((uint16_t)h);
        wrong += aspi_half((float)v) != h || aspi_half((float)-v) != (h | 0x8000);
        if (h + 1 < 0x7c00) {
            double middle = 0.5 * (v + half_value((uint16_t)(h + 1)));
            ties += aspi_half((float)middle) != (h & 1 ? h + 1 : h);
            wrong += aspi_half(nextafterf((float)middle, 0)) != h;
            wrong += aspi_half(nextafterf((float)middle, 1e9f)) != h + 1;
        }
    }
    CHECK(wrong == 0, "%d halfs wrong", wrong);
    CHECK(ties == 0, "%d ties not to even", ties);
    CHECK(aspi_half(65504) == 0x7bff && aspi_half(1e30f) == 0x7bff && aspi_half(-1e30f) == 0xfbff,
          "large values stay finite");
    CHECK(aspi_half(INFINITY) == 0x7c00 && (aspi_half(NAN) & 0x7fff) > 0x7c00, "infinity and NaN");
    printf("half: all 63488 finite values, the middles between them and their neighbours\n");
}

/* kind 0 noise, 1 constant, 2 gradient, 3 noise with many equal values (compresses about to nothing) */
static void fill(asp_image *image, int kind)
{
    for (int i = 0; i < image->width * image->height * 3; i++)
        image->rgb[i] = (float)(kind == 0 ? exp(8 * uniform() - 4) : kind == 1 ? 0.25 * (1 + i % 3)
                                : kind == 2 ? 0.01 * i : uniform() < 0.3 ? uniform() : 0.5);
}

static void test_exr(void)
{
    int files = 0;
    for (int round = 0; round < 240; round++) {
        asp_image image = make(1 + (int)(70 * uniform()), 1 + (int)(70 * uniform()));
        asp_image_options options = { .exr_float = round & 1, .exr_uncompressed = round >> 1 & 1 };
        fill(&image, round >> 2 & 3);
        asp_error err = { 0 };
        const char *path = in_folder("picture.exr");
        CHECK(asp_image_write(&image, path, &options, &err) == ASP_OK, "exr: %s", err.reason);
        asp_image back = { 0, 0, NULL };
        int is_half = -1, good = decode_exr(path, &back, &is_half) && back.width == image.width
                                 && back.height == image.height && is_half == !options.exr_float;
        int differ = 0;
        for (int i = 0; good && i < image.width * image.height * 3; i++) {
            float expected = options.exr_float ? image.rgb[i] : (float)half_value(aspi_half(image.rgb[i]));
            differ += memcmp(&expected, &back.rgb[i], 4) != 0;
        }
        files += CHECK(good && differ == 0, "exr %d: %dx%d, %d values differ", round, image.width,
                       image.height, differ);
        asp_image_free(&image);
        asp_image_free(&back);
    }
    printf("exr: %d files written and read back (half and float, PIZ and raw)\n", files);
}

/* ------------------------------------------------------------------ PFM */

static void test_pfm(void)
{
    asp_image image = make(5, 3);
    fill(&image, 0);
    CHECK(asp_image_write(&image, in_folder("picture.pfm"), NULL, NULL) == ASP_OK, "pfm");
    size_t size;
    char *bytes = read_file(in_folder("picture.pfm"), &size);
    const char *header = "PF\n5 3\n-1.0\n";
    int good = bytes && size == strlen(header) + 4 * 45 && memcmp(bytes, header, strlen(header)) == 0;
    for (int y = 0; good && y < 3; y++)
        for (int i = 0; good && i < 15; i++) {
            const unsigned char *b = (unsigned char *)bytes + strlen(header) + 4 * (15 * (2 - y) + i);
            uint32_t bits = b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
            float v;
            memcpy(&v, &bits, 4);
            good = v == image.rgb[15 * y + i];
        }
    CHECK(good, "pfm contents");
    free(bytes);
    asp_image_free(&image);
}

/* ------------------------------------------------------------------ names and disks */

static void test_names(void)
{
    asp_image image = make(2, 2);
    asp_error err;
    static const char *const wrong[] = { "a.jpg", "png", "folder.png/name", "a.png.gz", "a." };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        memset(&err, 0, sizeof err);
        CHECK(asp_image_write(&image, in_folder(wrong[i]), NULL, &err) == ASP_EUNKNOWN
              && strstr(err.reason, ".png") && strstr(err.reason, ".exr") && strstr(err.reason, ".pfm")
              && strstr(err.file, wrong[i]), "%s: %s", wrong[i], err.reason);
    }
    CHECK(asp_image_write(&image, "", NULL, &err) == ASP_EINVAL, "empty name");
    CHECK(asp_image_write(&image, NULL, NULL, NULL) == ASP_EINVAL, "no name");
    asp_image none = { 3, 3, NULL };
    CHECK(asp_image_write(&none, in_folder("a.png"), NULL, &err) == ASP_EINVAL, "no pixels");
    asp_image out = { 7, 7, NULL };
    CHECK(asp_image_make(0, 5, &out, &err) == ASP_EINVAL && strcmp(err.name, "width") == 0, "width 0");
    CHECK(asp_image_make(5, ASP_IMAGE_SIDE + 1, &out, &err) == ASP_EINVAL && err.high == ASP_IMAGE_SIDE,
          "too high");
    CHECK(out.width == 7, "a failed maker writes nothing");
    asp_image_free(&image);
}

static void test_disk(void)
{
    static const char *const names[] = { "x.png", "x.exr", "x.pfm" };
    asp_image image = make(64, 64);
    fill(&image, 0);
    asp_error err;
    count_files(1);
    for (int i = 0; i < 3; i++) {
        char missing[900];
        snprintf(missing, sizeof missing, "%s/%s", in_folder("missing"), names[i]);
        memset(&err, 0, sizeof err);
        CHECK(asp_image_write(&image, missing, NULL, &err) == ASP_EIO && err.status == ASP_EIO
              && strstr(err.file, "missing") && strstr(err.reason, strerror(ENOENT)),
              "missing folder: %s", err.reason);
        /* a device: written through, its error reported, and still a device afterwards */
        const char *path = in_folder(names[i]);
        if (access("/dev/full", W_OK) == 0) {
            CHECK(symlink("/dev/full", path) == 0, "symlink");
            memset(&err, 0, sizeof err);
            CHECK(asp_image_write(&image, path, NULL, &err) == ASP_EIO
                  && strstr(err.reason, strerror(ENOSPC)), "full device: %s", err.reason);
            struct stat is;
            CHECK(lstat(path, &is) == 0 && S_ISLNK(is.st_mode) && stat("/dev/full", &is) == 0
                  && S_ISCHR(is.st_mode), "the device is still there");
            unlink(path);
        }
        CHECK(count_files(1) == 0, "files left behind");
    }
    /* a disk with room for 4 KB only: the old file stays, nothing else is left */
    signal(SIGXFSZ, SIG_IGN);
    struct rlimit old, small;
    getrlimit(RLIMIT_FSIZE, &old);
    for (int i = 0; i < 3; i++) {
        const char *path = in_folder(names[i]);
        CHECK(asp_file_write(path, "before", 6, NULL) == ASP_OK, "first file");
        small = old;
        small.rlim_cur = 4096;
        setrlimit(RLIMIT_FSIZE, &small);
        memset(&err, 0, sizeof err);
        asp_status status = asp_image_write(&image, path, NULL, &err);
        setrlimit(RLIMIT_FSIZE, &old);
        CHECK(status == ASP_EIO && strstr(err.reason, strerror(EFBIG)), "small disk: %s", err.reason);
        size_t size;
        char *bytes = read_file(path, &size);
        CHECK(bytes && size == 6 && memcmp(bytes, "before", 6) == 0, "the old file has changed");
        free(bytes);
        CHECK(count_files(1) == 1, "files left behind");
    }
    /* permissions of the umask; a link stays a link and its target is replaced */
    mode_t mask = umask(027);
    CHECK(asp_file_write(in_folder("target"), "old", 3, NULL) == ASP_OK, "target");
    umask(mask);
    struct stat is;
    CHECK(stat(in_folder("target"), &is) == 0 && (is.st_mode & 0777) == 0640, "mode %o", is.st_mode);
    CHECK(symlink("target", in_folder("link")) == 0
          && asp_file_write(in_folder("link"), "newer", 5, NULL) == ASP_OK
          && lstat(in_folder("link"), &is) == 0 && S_ISLNK(is.st_mode)
          && stat(in_folder("target"), &is) == 0 && is.st_size == 5, "written through a link");
    CHECK(asp_file_write(folder_, "x", 1, &err) == ASP_EIO, "a folder is no file");
    count_files(1);
    CHECK(asp_file_write(in_folder("empty"), "", 0, NULL) == ASP_OK && count_files(1) == 1, "empty file");
    asp_image_free(&image);
    printf("disk: missing folder, full device, full disk, links, permissions\n");
}

/* ------------------------------------------------------------------ the rest */

static void test_base64(void)
{
    static const char *const rows[][2] = { { "", "" }, { "f", "Zg==" }, { "fo", "Zm8=" }, { "foo", "Zm9v" },
        { "foob", "Zm9vYg==" }, { "fooba", "Zm9vYmE=" }, { "foobar", "Zm9vYmFy" } };   /* RFC 4648 */
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char *text = asp_base64(rows[i][0], strlen(rows[i][0]));
        CHECK(text && strcmp(text, rows[i][1]) == 0, "base64 of %s: %s", rows[i][0], text ? text : "-");
        free(text);
    }
    char *text = asp_base64("\xfb\xff\xbf\x00", 4);
    CHECK(text && strcmp(text, "+/+/AA==") == 0, "base64 of high bytes");
    free(text);
}

static void test_place(void)
{
    asp_image target = make(8, 6), source = make(3, 3);
    for (int i = 0; i < 27; i++)
        source.rgb[i] = (float)(i + 1);
    static const int at[][2] = { { 0, 0 }, { 6, 4 }, { -2, -1 }, { 8, 0 }, { -3, 2 }, { 2, -3 },
        { 2147483647, 2147483647 }, { -2147483647 - 1, 0 }, { 0, -2147483647 - 1 }, { 5, 3 } };
    for (size_t k = 0; k < sizeof at / sizeof *at; k++) {
        memset(target.rgb, 0, sizeof(float) * 8 * 6 * 3);
        asp_image_place(&target, &source, at[k][0], at[k][1]);
        int good = 1;
        for (int y = 0; y < 6; y++)
            for (int x = 0; x < 8; x++) {
                long long sx = (long long)x - at[k][0], sy = (long long)y - at[k][1];
                int covered = sx >= 0 && sx < 3 && sy >= 0 && sy < 3;
                for (int c = 0; c < 3; c++)
                    good &= target.rgb[3 * (8 * y + x) + c]
                            == (covered ? source.rgb[3 * (3 * sy + sx) + c] : 0);
            }
        CHECK(good, "placed at %d, %d", at[k][0], at[k][1]);
    }
    asp_image_free(&target);
    asp_image_free(&source);
    asp_image_free(&source);
    asp_image_free(NULL);
    CHECK(source.rgb == NULL && source.width == 0, "freed");
}

int main(void)
{
    test_tone();
    test_png_file();
    test_half();
    test_exr();
    test_pfm();
    test_names();
    test_disk();
    test_base64();
    test_place();
    return finish_();
}
