/* output.c - errors, files, signals and the progress bar */
#define _XOPEN_SOURCE 700                  /* strcasecmp, SIGXFSZ */
#include "frame.h"

#include <errno.h>
#include <signal.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* ------------------------------------------------------------------ errors */

static void say(const char *format, va_list list)
{
    fflush(stdout);
    fputs("asperity: ", stderr);
    vfprintf(stderr, format, list);
    fputc('\n', stderr);
}

int cmd_usage(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    say(format, list);
    va_end(list);
    return CMD_USAGE;
}

int cmd_failed(const char *format, ...)
{
    va_list list;
    va_start(list, format);
    say(format, list);
    va_end(list);
    return CMD_FAILED;
}

int cmd_error(const asp_error *err)
{
    char line[640];
    return cmd_failed("%s", asp_error_text(err, line, sizeof line));
}

/* Levenshtein's distance of two words, of words up to 63 letters. */
static size_t distance(const char *a, const char *b)
{
    size_t row[64], na = strlen(a), nb = strlen(b);
    if (na > 63 || nb > 63)
        return 64;
    for (size_t j = 0; j <= nb; j++)
        row[j] = j;
    for (size_t i = 1; i <= na; i++) {
        size_t corner = row[0];
        row[0] = i;
        for (size_t j = 1; j <= nb; j++) {
            size_t change = corner + (a[i - 1] != b[j - 1]);
            corner = row[j];
            size_t least = row[j] + 1 < row[j - 1] + 1 ? row[j] + 1 : row[j - 1] + 1;
            row[j] = change < least ? change : least;
        }
    }
    return row[nb];
}

const char *cmd_nearest(const char *name, const char *const *names)
{
    const char *nearest = NULL;
    size_t best = 3;                       /* further apart is another word, not a slip */
    for (; *names; names++) {
        size_t d = distance(name, *names);
        if (d < best && d < strlen(*names) && d < strlen(name)) {
            best = d;
            nearest = *names;
        }
    }
    return nearest;
}

int cmd_unknown(const char *what, const char *name, const char *const *names)
{
    const char *nearest = cmd_nearest(name, names);
    char known[1024] = "";
    size_t used = 0;
    for (; *names && used < sizeof known - 1; names++)
        used += (size_t)snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "",
                                 *names);
    if (nearest)
        return cmd_usage("%s '%s'; did you mean '%s'? known: %s", what, name, nearest, known);
    return cmd_usage("%s '%s'; known: %s", what, name, known);
}

int cmd_find(const char *name, const char *const *names)
{
    for (int i = 0; names[i]; i++)
        if (strcmp(names[i], name) == 0)
            return i;
    return -1;
}

/* ------------------------------------------------------------------ signals */

#define TEMPORARIES 4

static char temporary[TEMPORARIES][sizeof ((aspi_out *)0)->temporary];
static volatile sig_atomic_t in_use[TEMPORARIES];
static volatile sig_atomic_t bar_shown;
static int stdout_errno;                   /* of the first write that failed */

static void on_signal(int number)
{
    static const char wipe[] = "\r\033[K";
    for (int i = 0; i < TEMPORARIES; i++)
        if (in_use[i])
            unlink(temporary[i]);
    if (bar_shown && write(STDERR_FILENO, wipe, sizeof wipe - 1) < 0) {
        /* nothing to be done about a terminal that went away */
    }
    raise(number);                         /* SA_RESETHAND: this time with its default effect */
}

void frame_signals(void)
{
    static const int numbers[] = { SIGINT, SIGTERM, SIGHUP };
    struct sigaction action;
    memset(&action, 0, sizeof action);
    action.sa_handler = SIG_IGN;           /* past `ulimit -f` a write then fails with EFBIG, which */
    sigaction(SIGXFSZ, &action, NULL);     /* is reported like a full disk */
    action.sa_handler = on_signal;
    action.sa_flags = (int)SA_RESETHAND;
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        struct sigaction old;
        if (sigaction(numbers[i], NULL, &old) == 0 && old.sa_handler != SIG_IGN)   /* nohup */
            sigaction(numbers[i], &action, NULL);
    }
}

static void signals_mask(int how)
{
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGINT);
    sigaddset(&set, SIGTERM);
    sigaddset(&set, SIGHUP);
    sigprocmask(how, &set, NULL);
}

void cmd_hold(void)    { signals_mask(SIG_BLOCK); }
void cmd_release(void) { signals_mask(SIG_UNBLOCK); }

/* ------------------------------------------------------------------ files */

int cmd_ends_in(const char *path, const char *ending)
{
    size_t n = strlen(path), m = strlen(ending);
    return n > m && strcasecmp(path + n - m, ending) == 0;
}

int cmd_is_device(const char *path)
{
    struct stat about;
    return stat(path, &about) == 0 && !S_ISREG(about.st_mode) && !S_ISDIR(about.st_mode);
}

int cmd_out_check(const char *path)
{
    asp_error err;
    aspi_out out;
    if (cmd_is_device(path))
        return CMD_OK;                     /* opening a device or a pipe may do something already */
    cmd_hold();
    asp_status status = aspi_out_open(&out, path, &err);
    if (status == ASP_OK)
        aspi_out_abandon(&out);
    cmd_release();
    return status == ASP_OK ? CMD_OK : cmd_error(&err);
}

int cmd_out_open(cmd_out *out, const char *path)
{
    asp_error err;
    memset(out, 0, sizeof *out);
    out->standard = !path || strcmp(path, "-") == 0;
    if (out->standard)
        return CMD_OK;
    cmd_hold();
    asp_status status = aspi_out_open(&out->out, path, &err);
    for (int i = 0; status == ASP_OK && !out->out.in_place && i < TEMPORARIES; i++)
        if (!in_use[i]) {
            strcpy(temporary[i], out->out.temporary);
            in_use[i] = 1;
            break;
        }
    cmd_release();
    return status == ASP_OK ? CMD_OK : cmd_error(&err);
}

static void forget(const cmd_out *out)
{
    for (int i = 0; i < TEMPORARIES; i++)
        if (in_use[i] && strcmp(temporary[i], out->out.temporary) == 0)
            in_use[i] = 0;
}

void cmd_out_write(cmd_out *out, const char *text, size_t size)
{
    if (!out->standard)
        aspi_out_write(&out->out, text, size);
    else if (!ferror(stdout) && fwrite(text, 1, size, stdout) != size)
        stdout_errno = errno;
}

int cmd_out_broken(const cmd_out *out)
{
    return out->standard ? ferror(stdout) != 0 : out->out.failed != 0;
}

int cmd_out_close(cmd_out *out)
{
    asp_error err;
    if (out->standard)
        return frame_finish_output();
    cmd_hold();
    asp_status status = aspi_out_close(&out->out, &err);
    forget(out);
    cmd_release();
    return status == ASP_OK ? CMD_OK : cmd_error(&err);
}

void cmd_out_abandon(cmd_out *out)
{
    if (out->standard)
        return;
    cmd_hold();
    aspi_out_abandon(&out->out);
    forget(out);
    cmd_release();
}

int frame_finish_output(void)
{
    errno = 0;
    if (fflush(stdout) == 0 && !ferror(stdout))
        return CMD_OK;
    int number = stdout_errno ? stdout_errno : errno ? errno : EIO;
    return cmd_failed("standard output: %s", strerror(number));
}

int cmd_print_json(json_t *json)
{
    if (!json)
        return cmd_failed("out of memory");
    int failed = json_dumpf(json, stdout, JSON_INDENT(2));
    json_decref(json);
    putchar('\n');
    if (failed && !ferror(stdout))
        return cmd_failed("a value cannot be written as JSON");
    return CMD_OK;                         /* main looks at standard output at the end */
}

/* ------------------------------------------------------------------ progress */

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

cmd_progress cmd_progress_begin(const char *label)
{
    cmd_progress progress = { label, isatty(STDERR_FILENO), now(), 0 };
    return progress;
}

cmd_progress cmd_progress_beside(const cmd_out *out, const char *label)
{
    cmd_progress progress = cmd_progress_begin(label);
    progress.shown &= !(out->standard && isatty(STDOUT_FILENO));
    return progress;
}

int cmd_progress_show(void *context, double done)
{
    enum { CELLS = 32 };
    cmd_progress *progress = context;
    double time = now(), spent = time - progress->start;
    char bar[CELLS + 1], left[32] = "";
    if (!progress->shown || time - progress->last < 0.1)
        return 0;
    progress->last = time;
    done = done < 0 ? 0 : done > 1 ? 1 : done;
    for (int i = 0; i < CELLS; i++)
        bar[i] = i < (int)(done * CELLS) ? '#' : '.';
    bar[CELLS] = 0;
    if (done > 0.01 && spent > 0.5) {
        long seconds = (long)(spent * (1 - done) / done + 0.5);
        snprintf(left, sizeof left, "%ld:%02ld left", seconds / 60, seconds % 60);
    }
    bar_shown = 1;
    fprintf(stderr, "\r%s [%s] %3d %% %s\033[K", progress->label, bar, (int)(100 * done), left);
    fflush(stderr);
    return 0;
}

void cmd_progress_end(cmd_progress *progress)
{
    if (progress->shown && bar_shown)
        fputs("\r\033[K", stderr);
    bar_shown = 0;
    progress->shown = 0;
}
