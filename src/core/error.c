/* error.c - the two ways in which a maker says no */
#include "asperity.h"

#include <math.h>
#include <string.h>

static void copy_text(char *to, size_t size, const char *from)
{
    size_t n = from ? strlen(from) : 0;
    if (n >= size)
        n = size - 1;
    if (n)
        memcpy(to, from, n);
    to[n] = '\0';
}

asp_status asp_fail(asp_error *err, asp_status status, const char *name, const char *reason)
{
    if (err) {
        memset(err, 0, sizeof *err);
        err->status = status;
        err->position = -1;
        err->value = err->low = err->high = NAN;
        copy_text(err->name, sizeof err->name, name);
        copy_text(err->reason, sizeof err->reason, reason);
    }
    return status;
}

asp_status asp_fail_range(asp_error *err, const char *name, double value, double low, int low_open,
                          double high)
{
    asp_fail(err, ASP_EINVAL, name, "outside its range");
    if (err) {
        err->value = value;
        err->low = low;
        err->low_open = low_open;
        err->high = high;
    }
    return ASP_EINVAL;
}
