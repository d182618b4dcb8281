/* file.c - whole files in, finished files out */
#define _POSIX_C_SOURCE 200809L
#include "io.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* What has no size of its own is read up to here, and not until memory ends. */
#define LARGEST_PIPE ((size_t)1 << 30)

void aspi_error_file(asp_error *err, const char *file)
{
    if (!err || !file)
        return;
    size_t n = strlen(file), room = sizeof err->file - 1;
    if (n > room) {                        /* the end of a path tells more than its beginning */
        memcpy(err->file, "...", 3);
        memcpy(err->file + 3, file + n - (room - 3), room - 3);
        err->file[room] = 0;
    } else {
        memcpy(err->file, file, n + 1);
    }
}

asp_status aspi_fail_at(asp_error *err, asp_status status, const char *file, long long position,
                        const char *name, const char *reason)
{
    asp_fail(err, status, name, reason);
    aspi_error_file(err, file);
    if (err)
        err->position = position;
    return status;
}

asp_status aspi_fail_line(asp_error *err, asp_status status, const char *file, long long line,
                          const char *name, const char *reason)
{
    asp_fail(err, status, name, reason);
    aspi_error_file(err, file);
    if (err)
        err->line = line;
    return status;
}

static asp_status io_fail(asp_error *err, const char *path, const char *doing, int number)
{
    char reason[192];
    snprintf(reason, sizeof reason, "%s: %s", doing, strerror(number));
    return aspi_fail_at(err, ASP_EIO, path, -1, "", reason);
}

asp_status aspi_read_file(const char *path, unsigned char **bytes, size_t *size, asp_error *err)
{
    struct stat about;
    if (!path || !path[0])
        return asp_fail(err, ASP_EINVAL, "path", "no file name given");
    FILE *file = fopen(path, "rb");
    if (!file)
        return io_fail(err, path, "cannot open", errno);
    if (fstat(fileno(file), &about) != 0 || S_ISDIR(about.st_mode)) {
        fclose(file);
        return io_fail(err, path, "cannot read", EISDIR);
    }
    /* the size is only a first guess: a pipe has none, and a file may grow while it is read */
    size_t room = S_ISREG(about.st_mode) && about.st_size > 0 ? (size_t)about.st_size + 1 : 65536;
    size_t used = 0;
    unsigned char *data = malloc(room);
    while (data) {
        used += fread(data + used, 1, room - 1 - used, file);
        if (used < room - 1)
            break;
        int next = getc(file);
        if (next == EOF)
            break;
        if (room > LARGEST_PIPE) {
            free(data);
            fclose(file);
            return io_fail(err, path, "more than 1 GB from a pipe or device", EFBIG);
        }
        room *= 2;
        unsigned char *more = realloc(data, room);
        if (!more)
            free(data);
        data = more;
        if (data)
            data[used++] = (unsigned char)next;
    }
    int number = ferror(file) ? (errno ? errno : EIO) : 0;
    fclose(file);
    if (!data)
        return aspi_fail_at(err, ASP_ENOMEM, path, -1, "", "not enough memory to read the file");
    if (number) {
        free(data);
        return io_fail(err, path, "cannot read", number);
    }
    data[used] = 0;
    *bytes = data;
    *size = used;
    return ASP_OK;
}

/* ------------------------------------------------------------------ writing */

asp_status aspi_out_open(aspi_out *out, const char *path, asp_error *err)
{
    struct stat about;
    memset(out, 0, sizeof *out);
    if (!path || !path[0])
        return asp_fail(err, ASP_EINVAL, "path", "no file name given");
    if (strlen(path) >= sizeof out->path)
        return aspi_fail_at(err, ASP_EINVAL, path, -1, "path", "the file name is too long");
    strcpy(out->path, path);
    if (stat(path, &about) == 0) {
        if (S_ISDIR(about.st_mode))
            return io_fail(err, path, "cannot write", EISDIR);
        out->in_place = !S_ISREG(about.st_mode);
    }
    if (out->in_place) {                 /* renaming over a device would replace the device */
        out->file = fopen(path, "wb");
        if (!out->file)
            return io_fail(err, path, "cannot write", errno);
        return ASP_OK;
    }
    int handle = -1;
    for (int attempt = 0; attempt < 100 && handle < 0; attempt++) {
        snprintf(out->temporary, sizeof out->temporary, "%s.%ld-%d.part", path, (long)getpid(),
                 attempt);
        handle = open(out->temporary, O_WRONLY | O_CREAT | O_EXCL, 0666);
        if (handle < 0 && errno != EEXIST)
            break;
    }
    if (handle < 0)
        return io_fail(err, path, "cannot write beside it", errno);
    out->file = fdopen(handle, "wb");
    if (!out->file) {
        int number = errno;
        close(handle);
        unlink(out->temporary);
        return io_fail(err, path, "cannot write", number);
    }
    return ASP_OK;
}

void aspi_out_write(aspi_out *out, const void *bytes, size_t size)
{
    if (!out->file || out->failed || !size)
        return;
    errno = 0;
    if (fwrite(bytes, 1, size, out->file) != size)
        out->failed = errno ? errno : EIO;
}

void aspi_out_text(aspi_out *out, const char *text)
{
    aspi_out_write(out, text, strlen(text));
}

void aspi_out_abandon(aspi_out *out)
{
    if (!out->file)
        return;
    fclose(out->file);
    out->file = NULL;
    if (!out->in_place)
        unlink(out->temporary);
}

asp_status aspi_out_close(aspi_out *out, asp_error *err)
{
    if (!out->file)
        return asp_fail(err, ASP_EINVAL, "file", "not open");
    errno = 0;
    if (!out->failed && fflush(out->file) != 0)
        out->failed = errno ? errno : EIO;
    errno = 0;
    if (fclose(out->file) != 0 && !out->failed)
        out->failed = errno ? errno : EIO;
    out->file = NULL;
    if (!out->failed && !out->in_place && rename(out->temporary, out->path) != 0)
        out->failed = errno ? errno : EIO;
    if (!out->failed)
        return ASP_OK;
    if (!out->in_place)
        unlink(out->temporary);
    return io_fail(err, out->path, "cannot write", out->failed);
}
