/* draw_test.h - counting checks and a folder of its own for the tests of images, charts and renderings
 *
 * Include after defining _XOPEN_SOURCE 700. */
#ifndef DRAW_TEST_H
#define DRAW_TEST_H

#include "asperity_draw.h"

#include <dirent.h>
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define PI 3.14159265358979323846

static int passed_, failed_;

static inline int check_(int good, const char *format, ...)
{
    if (good) {
        passed_++;
        return 1;
    }
    if (++failed_ <= 40) {
        va_list list;
        va_start(list, format);
        printf("FAILED: ");
        vprintf(format, list);
        printf("\n");
        va_end(list);
    }
    return 0;
}
#define CHECK(condition, ...) check_((condition) ? 1 : 0, __VA_ARGS__)

/* ---- a folder that is removed at the end */

static char folder_[512];

static inline const char *in_folder(const char *name)
{
    static char path[8][800];
    static int turn;
    if (!folder_[0]) {
        const char *base = getenv("TMPDIR");
        snprintf(folder_, sizeof folder_, "%s/asperity-draw-XXXXXX", base && *base ? base : P_tmpdir);
        if (!mkdtemp(folder_)) {
            perror(folder_);
            exit(1);
        }
    }
    turn = (turn + 1) % 8;
    snprintf(path[turn], sizeof path[turn], "%s/%s", folder_, name);
    return path[turn];
}

/* How many files are in the folder; removes them when asked to. */
static inline int count_files(int remove_them)
{
    int count = 0;
    in_folder("");
    DIR *folder = opendir(folder_);
    for (struct dirent *entry; folder && (entry = readdir(folder));)
        if (strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0) {
            count++;
            if (remove_them)
                unlink(in_folder(entry->d_name));
        }
    if (folder)
        closedir(folder);
    return count;
}

static inline char *read_file(const char *path, size_t *size)
{
    FILE *file = fopen(path, "rb");
    *size = 0;
    if (!file)
        return NULL;
    char *bytes = malloc(1 << 24);
    if (bytes) {
        *size = fread(bytes, 1, (1 << 24) - 1, file);
        bytes[*size] = '\0';
    }
    fclose(file);
    return bytes;
}

static inline int finish_(void)
{
    if (folder_[0]) {
        count_files(1);
        rmdir(folder_);
    }
    if (failed_ > 40)
        printf("(%d more failures not shown)\n", failed_ - 40);
    printf("%d passed, %d failed\n", passed_, failed_);
    return failed_ ? 1 : 0;
}

/* ---- numbers (SplitMix64, Steele et al. 2014) */

static uint64_t state_ = 2385;

static inline double uniform(void)
{
    uint64_t z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return 0x1p-53 * (double)((z ^ z >> 31) >> 11);
}

#endif
