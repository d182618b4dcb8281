/* test_data_files.c - files that are absent, are folders, cannot be written; errors as text; numbers
 * as text */
#define _POSIX_C_SOURCE 200809L
#include "data_test.h"
#include "data/io.h"

#include <dirent.h>
#include <locale.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

static void expect_unreadable(const char *path, const char *word)
{
    asp_error err;
    char text[900];
    asp_measured *m = asp_measured_read(path, &err);
    asp_error_text(&err, text, sizeof text);
    printf("  %s\n", text);
    CHECK(!m && strstr(text, word) && (!path || strstr(text, path)), "'%s' in: %s", word, text);
    CHECK(!asp_measured_read(path, NULL), "a caller may pass no error");
}

static int entries(const char *path)
{
    DIR *folder = opendir(path);
    int n = 0;
    while (folder && readdir(folder))
        n++;
    if (folder)
        closedir(folder);
    return n - 2;
}

static asp_measured *some_list(void)
{
    static char text[60000];
    size_t used = (size_t)sprintf(text, "theta_i,theta_o,phi_o,f\n");
    for (int i = 0; i < 900; i++)
        used += (size_t)sprintf(text + used, "0.5,%.6f,%.6f,%.6f\n", 1.5 * random_number(),
                                6 * random_number(), random_number());
    return asp_measured_read_memory(text, used, "some", NULL);
}

/* A limit on the size of files stands for a full disk: writing fails half way. */
static void check_full_disk(void)
{
    asp_measured *m = some_list();
    const char *path = temporary_path("out.csv");
    struct rlimit before, limit;
    asp_error err;
    char text[900];
    size_t size, after_size;
    CHECK(m && asp_measured_write_csv(m, path, &err) == ASP_OK, "written while there is room");
    unsigned char *old = read_bytes(path, &size);
    int files = entries(folder_);

    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    limit = before;
    limit.rlim_cur = 20000;
    setrlimit(RLIMIT_FSIZE, &limit);
    asp_status csv = asp_measured_write_csv(m, path, &err);
    asp_error_text(&err, text, sizeof text);
    asp_status merl = asp_measured_write_merl(m, path, NULL);
    setrlimit(RLIMIT_FSIZE, &before);
    printf("  %s\n", text);
    CHECK(csv == ASP_EIO && strstr(text, path) && strstr(text, "cannot write"), "CSV: %s", text);
    CHECK(merl == ASP_EIO, "MERL fails too");
    unsigned char *after = read_bytes(path, &after_size);
    CHECK(after_size == size && !memcmp(old, after, size), "the old file is as it was");
    CHECK(entries(folder_) == files, "no other file is left behind");
    free(old);
    free(after);
    remove(path);

    struct stat about;
    if (stat("/dev/full", &about) == 0) {
        CHECK(asp_measured_write_csv(m, "/dev/full", &err) == ASP_EIO, "a full device is reported");
        CHECK(stat("/dev/full", &about) == 0 && S_ISCHR(about.st_mode), "and is still a device");
    }
    CHECK(asp_measured_write_csv(m, folder_, &err) == ASP_EIO, "a folder is no file");
    CHECK(asp_measured_write_merl(m, temporary_path("no/such/folder"), &err) == ASP_EIO,
          "nor can a file stand in no folder");
    CHECK(asp_measured_write_csv(NULL, path, &err) == ASP_EINVAL
          && asp_measured_write_merl(NULL, path, &err) == ASP_EINVAL, "nothing to write");
    CHECK(asp_measured_write_csv(m, NULL, &err) == ASP_EINVAL
          && asp_measured_write_csv(m, "", &err) == ASP_EINVAL, "nowhere to write");
    asp_measured_free(m);
}

static void check_text(void)
{
    asp_error err;
    char text[600], tiny[8];
    asp_fail_range(&err, "alpha", -1, 0, 1, 100);
    CHECK(!strcmp(asp_error_text(&err, text, sizeof text), "alpha = -1 is outside (0, 100]"), "%s", text);
    asp_fail(&err, ASP_EUNKNOWN, "gxx", "no distribution has this name");
    err.position = 7;
    CHECK(!strcmp(asp_error_text(&err, text, sizeof text), "byte 7: gxx: no distribution has this name"),
          "%s", text);
    aspi_fail_at(&err, ASP_EFORMAT, "chm.bsdf", 4096, "luminance", "shape says 8x8x32");
    CHECK(!strcmp(asp_error_text(&err, text, sizeof text),
                  "chm.bsdf: byte 4096: field 'luminance': shape says 8x8x32"), "%s", text);
    aspi_fail_line(&err, ASP_EPARSE, "a.csv", 3, "f", "\x1b[2J");
    CHECK(!strcmp(asp_error_text(&err, text, sizeof text), "a.csv: line 3: column 'f': ?[2J"), "%s", text);
    CHECK(!strcmp(asp_error_text(&err, tiny, sizeof tiny), "a.csv: "), "cut to fit: %s", tiny);
    CHECK(asp_error_text(NULL, text, sizeof text)[0] && asp_error_text(&err, NULL, 0)[0] == 0,
          "no error, no room");
    for (int s = ASP_OK; s <= ASP_ENOMEM; s++) {
        asp_fail(&err, (asp_status)s, NULL, NULL);
        CHECK(strlen(asp_error_text(&err, text, sizeof text)) > 5, "status %d has words", s);
    }
    char longest[1000];
    memset(longest, 'x', sizeof longest - 1);
    longest[sizeof longest - 1] = 0;
    memcpy(longest + sizeof longest - 6, "y.csv", 5);
    aspi_fail_at(&err, ASP_EIO, longest, -1, "", "cannot open");
    asp_error_text(&err, text, sizeof text);
    CHECK(!strncmp(text, "...xxx", 6) && strstr(text, "y.csv: cannot open"), "a long name keeps its end");
}

static void check_numbers(void)
{
    const struct { const char *text; double value; } good[] = {
        { "0", 0 }, { "-0.5", -0.5 }, { "+.5", 0.5 }, { "5.", 5 }, { "1e3", 1000 }, { "1E-3", 0.001 },
        { "0.1", 0.1 }, { "2.2250738585072011e-308", 2.2250738585072011e-308 },
        { "9007199254740993", 9007199254740992.0 }, { "9007199254740993.00001", 9007199254740994.0 },
        { "1e-400", 0 }, { "1.7976931348623157e308", 1.7976931348623157e308 },
    };
    const char *const bad[] = { "", "+", ".", "e5", "1e", "1e+", "1 ", " 1", "1,5", "0x1", "nan", "inf",
                                "1e309", "--1", "1.2.3", "1f", "1_0" };
    double value;
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++)
        CHECK(aspi_parse_number(good[i].text, strlen(good[i].text), &value) && value == good[i].value,
              "%s is a number", good[i].text);
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++)
        CHECK(!aspi_parse_number(bad[i], strlen(bad[i]), &value), "'%s' is no number", bad[i]);
    char text[ASPI_NUMBER_TEXT], digits[2000];
    memset(digits, '3', sizeof digits);
    CHECK(!aspi_parse_number(digits, sizeof digits, &value), "nor are 2000 digits");
    int wrong = 0;
    for (int i = 0; i < 100000; i++) {
        double x = (random_number() - 0.5) * pow(10, 600 * (random_number() - 0.5));
        size_t n = aspi_format_number(x, 17, text);
        wrong += !aspi_parse_number(text, n, &value) || value != x;
    }
    CHECK(wrong == 0, "17 digits come back (%d do not)", wrong);
    /* a locale with a comma, where this machine has one */
    const char *const locales[] = { "de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "de_DE" };
    int tried = 0;
    for (size_t i = 0; i < 4 && !tried; i++)
        if (setlocale(LC_ALL, locales[i]) && localeconv()->decimal_point[0] == ',') {
            tried = 1;
            aspi_format_number(0.125, 17, text);
            CHECK(!strcmp(text, "0.125") && aspi_parse_number("0.125", 5, &value) && value == 0.125
                  && !aspi_parse_number("0,125", 5, &value), "numbers have a '.' in %s", locales[i]);
        }
    setlocale(LC_ALL, "C");
    printf(tried ? "locale with a decimal comma: checked\n" : "no locale with a decimal comma here\n");
}

int main(void)
{
    const char *empty = temporary_path("empty.csv");
    write_bytes(empty, "", 0);
    expect_unreadable(temporary_path("absent.bsdf"), "No such file");
    expect_unreadable(folder_, "directory");
    expect_unreadable(empty, "empty");
    expect_unreadable("", "no file name");
    remove(empty);
    asp_error err;
    CHECK(!asp_measured_read_memory(NULL, 5, "x", &err) && !asp_measured_read_memory(NULL, 0, NULL, &err),
          "no bytes");
    asp_measured_free(NULL);
    check_full_disk();
    check_text();
    check_numbers();
    rmdir(folder_);
    return finish();
}
