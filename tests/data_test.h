/* data_test.h - counting checks, temporary files and synthetic measurements for test_data_*.c */
#ifndef DATA_TEST_H
#define DATA_TEST_H

#include "asperity_data.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int passed_count, failed_count;

static inline int check_(int good, const char *format, ...)
{
    va_list arguments;
    if (good) {
        passed_count++;
        return 1;
    }
    failed_count++;
    printf("FAILED: ");
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
    printf("\n");
    return 0;
}

#define CHECK(condition, ...) check_((condition), __VA_ARGS__)

static inline int finish(void)
{
    printf("%d passed, %d failed\n", passed_count, failed_count);
    return failed_count ? 1 : 0;
}

/* A path in a folder of this run; the same name gives the same path. */
static char folder_[256];

static inline const char *temporary_path(const char *name)
{
    static char path[4][600];
    static int turn;
    if (!folder_[0]) {
        const char *base = getenv("TMPDIR");
        snprintf(folder_, sizeof folder_, "%s/asperity-data-XXXXXX", base && base[0] ? base : "/tmp");
        if (!mkdtemp(folder_)) {
            perror(folder_);
            exit(1);
        }
    }
    turn = (turn + 1) % 4;
    snprintf(path[turn], sizeof path[turn], "%s/%s", folder_, name);
    return path[turn];
}

static inline void write_bytes(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    if (!file || fwrite(bytes, 1, size, file) != size || fclose(file) != 0) {
        perror(path);
        exit(1);
    }
}

static inline unsigned char *read_bytes(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    if (!file) {
        perror(path);
        exit(1);
    }
    fseek(file, 0, SEEK_END);
    *size = (size_t)ftell(file);
    rewind(file);
    unsigned char *bytes = malloc(*size + 1);
    if (!bytes || fread(bytes, 1, *size, file) != *size)
        exit(1);
    bytes[*size] = 0;
    fclose(file);
    return bytes;
}

/* xorshift64*: the same numbers everywhere */
static uint64_t random_state = 88172645463325252u;

static inline double random_number(void)
{
    random_state ^= random_state >> 12;
    random_state ^= random_state << 25;
    random_state ^= random_state >> 27;
    return (double)(random_state * 2685821657736338717u >> 11) * 0x1p-53;
}

static inline asp_vec3 direction_of(double theta, double phi)
{
    return (asp_vec3){ sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta) };
}

static inline asp_vec3 random_direction(void)
{
    double z = 0.02 + 0.98 * random_number(), phi = 6.283185307179586 * random_number();
    double s = sqrt(1 - z * z);
    return (asp_vec3){ s * cos(phi), s * sin(phi), z };
}

/* Reads text as a file; expects failure and these words in the error's line. */
static inline void expect_refusal(const void *bytes, size_t size, const char *name, int words, ...)
{
    asp_error err;
    char text[600];
    memset(&err, 0, sizeof err);
    asp_measured *m = asp_measured_read_memory(bytes, size, name, &err);
    if (!CHECK(!m, "%s: read although it should be refused", name)) {
        asp_measured_free(m);
        return;
    }
    asp_error_text(&err, text, sizeof text);
    printf("  %s\n", text);
    CHECK(strncmp(text, name, strlen(name)) == 0, "%s: error does not name it: %s", name, text);
    va_list list;
    va_start(list, words);
    for (int i = 0; i < words; i++) {
        const char *word = va_arg(list, const char *);
        CHECK(strstr(text, word) != NULL, "%s: '%s' is not in: %s", name, word, text);
    }
    va_end(list);
}

#endif
