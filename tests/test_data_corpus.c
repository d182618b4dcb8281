/* test_data_corpus.c - the fuzzers' corpora in the ordinary test run: every kept file, its
 * truncations and its single-bit changes through the fuzzers' own entries (tests/fuzz). A broken
 * promise aborts with its name. */
#define _POSIX_C_SOURCE 200809L
#include "data_test.h"

#include <dirent.h>

#define LLVMFuzzerTestOneInput fuzz_merl
#include "fuzz/fuzz_merl.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_rgl
#include "fuzz/fuzz_rgl.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_csv
#include "fuzz/fuzz_csv.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_cornell
#include "fuzz/fuzz_cornell.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_lumos
#include "fuzz/fuzz_lumos.c"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_slopes
#include "fuzz/fuzz_slopes.c"
#undef LLVMFuzzerTestOneInput

typedef int fuzz_entry(const uint8_t *data, size_t size);

/* Each input in a block of its own size, so that a sanitizer sees a read past its end. */
static int run(fuzz_entry *entry, const unsigned char *bytes, size_t size)
{
    unsigned char *copy = malloc(size ? size : 1);
    memcpy(copy, bytes, size);
    int result = entry(copy, size);
    free(copy);
    return result;
}

static long replay(fuzz_entry *entry, unsigned char *bytes, size_t size)
{
    long runs = 0;
    size_t step = 1 + size / 150;
    for (size_t n = 0; n < size; n += step, runs++)
        run(entry, bytes, n);
    for (size_t i = 0; i < size; i += step)
        for (int bit = 0; bit < 8; bit++, runs++) {
            bytes[i] ^= (unsigned char)(1 << bit);
            run(entry, bytes, size);
            bytes[i] ^= (unsigned char)(1 << bit);
        }
    return runs;
}

static void replay_folder(const char *name, fuzz_entry *entry)
{
    char path[600];
    int files = 0, kept = 0;
    long runs = 0;
    snprintf(path, sizeof path, "tests/fuzz/corpus/%s", name);
    DIR *folder = opendir(path);
    struct dirent *item;
    while (folder && (item = readdir(folder)) != NULL) {
        if (item->d_name[0] == '.')
            continue;
        size_t size;
        snprintf(path, sizeof path, "tests/fuzz/corpus/%s/%s", name, item->d_name);
        unsigned char *bytes = read_bytes(path, &size);
        kept += run(entry, bytes, size) == 0;
        runs += 1 + replay(entry, bytes, size);
        free(bytes);
        files++;
    }
    if (folder)
        closedir(folder);
    printf("%-8s %3d files, %6ld inputs\n", name, files, runs);
    CHECK(files > 0, "the corpus %s is there (run from the source folder)", name);
    CHECK(kept == files, "%s: every kept file looks like its format (%d of %d)", name, kept, files);
}

int main(void)
{
    replay_folder("merl", fuzz_merl);
    replay_folder("rgl", fuzz_rgl);
    replay_folder("csv", fuzz_csv);
    replay_folder("cornell", fuzz_cornell);
    replay_folder("lumos", fuzz_lumos);
    replay_folder("slopes", fuzz_slopes);
    return finish();
}
