/* file.c - complete files or none: write beside the target, then rename */
#define _XOPEN_SOURCE 700
#include "draw/text.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

asp_status aspi_fail_system(asp_error *err, int number, const char *path, const char *doing)
{
    char reason[sizeof err->reason], system[128];
    if (strerror_r(number, system, sizeof system) != 0)
        snprintf(system, sizeof system, "error %d", number);
    snprintf(reason, sizeof reason, "%s: %s", doing, system);
    asp_status status = asp_fail(err, ASP_EIO, "", reason);
    if (err)
        snprintf(err->file, sizeof err->file, "%s", path);
    return status;
}

/* 0, or errno. */
static int write_all(int file, const unsigned char *bytes, size_t size)
{
    while (size > 0) {
        ssize_t done = write(file, bytes, size < ((size_t)1 << 30) ? size : (size_t)1 << 30);
        if (done < 0 && errno == EINTR)
            continue;
        if (done <= 0)
            return done < 0 ? errno : ENOSPC;
        bytes += done;
        size -= (size_t)done;
    }
    return 0;
}

/* A device or a pipe cannot be replaced by a file; renaming over /dev/null would remove it. */
static asp_status write_through(const char *path, const void *bytes, size_t size, asp_error *err)
{
    int file = open(path, O_WRONLY | O_CLOEXEC);
    if (file < 0)
        return aspi_fail_system(err, errno, path, "cannot open for writing");
    int wrong = write_all(file, bytes, size);
    if (close(file) != 0 && !wrong)
        wrong = errno;
    return wrong ? aspi_fail_system(err, wrong, path, "cannot write") : ASP_OK;
}

/* open() rather than mkstemp(): the new file gets the permissions of the caller's umask. */
static int open_beside(const char *path, char *name, size_t room)
{
    for (int i = 0; i < 1000; i++) {
        snprintf(name, room, "%s.%ld-%d.tmp", path, (long)getpid(), i);
        int file = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file >= 0 || errno != EEXIST)
            return file;
    }
    return -1;
}

static asp_status write_and_rename(const char *path, const void *bytes, size_t size, asp_error *err)
{
    size_t room = strlen(path) + 64;
    char *name = malloc(room);
    if (!name)
        return asp_fail(err, ASP_ENOMEM, "path", "out of memory");
    int file = open_beside(path, name, room);
    if (file < 0) {
        int wrong = errno;
        free(name);
        return aspi_fail_system(err, wrong, path, "cannot create");
    }
    int wrong = write_all(file, bytes, size);
    if (!wrong && fsync(file) != 0 && errno != EINVAL)     /* some disks say 'full' only here */
        wrong = errno;
    if (close(file) != 0 && !wrong)
        wrong = errno;
    asp_status status = ASP_OK;
    if (wrong)
        status = aspi_fail_system(err, wrong, path, "cannot write");
    else if (rename(name, path) != 0)
        status = aspi_fail_system(err, errno, path, "cannot replace");
    if (status != ASP_OK)
        unlink(name);
    free(name);
    return status;
}

asp_status asp_file_write(const char *path, const void *bytes, size_t size, asp_error *err)
{
    if (!path || !*path)
        return asp_fail(err, ASP_EINVAL, "path", "no file name");
    struct stat is;
    if (stat(path, &is) == 0 && !S_ISREG(is.st_mode) && !S_ISDIR(is.st_mode))
        return write_through(path, bytes, size, err);
    /* through a symbolic link: replace what it points to, not the link */
    char *target = lstat(path, &is) == 0 && S_ISLNK(is.st_mode) ? realpath(path, NULL) : NULL;
    asp_status status = write_and_rename(target ? target : path, bytes, size, err);
    free(target);
    return status;
}
