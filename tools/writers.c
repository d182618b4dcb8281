/* writers.c - the formats in which a measurement is written */
#include "writers.h"

#include <string.h>

static const writer writers[] = {
    { "merl", { ".binary", ".merl", NULL }, asp_measured_write_merl },
    { "csv",  { ".csv", NULL, NULL },       asp_measured_write_csv },
};
enum { WRITERS = sizeof writers / sizeof *writers };

static int ends_in(const char *path, const char *ending)
{
    size_t n = strlen(path), m = strlen(ending);
    return n > m && strcmp(path + n - m, ending) == 0;
}

int writer_choose(const cmd_args *args, const char *path, const writer **out)
{
    *out = cmd_given(args, "to") ? &writers[cmd_choice(args, "to")] : NULL;
    for (int i = 0; !*out && i < WRITERS; i++)
        for (int j = 0; writers[i].endings[j]; j++)
            if (ends_in(path, writers[i].endings[j]))
                *out = &writers[i];
    if (!*out)
        return cmd_usage("%s: the name must end in .binary, .merl or .csv, or give --to", path);
    return cmd_out_check(path);
}

int writer_write(const writer *to, const asp_measured *data, const char *path)
{
    asp_error err;
    cmd_hold();
    asp_status status = to->write(data, path, &err);
    cmd_release();
    return status == ASP_OK ? CMD_OK : cmd_error(&err);
}
