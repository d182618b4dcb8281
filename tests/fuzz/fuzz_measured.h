/* fuzz_measured.h - what every reader of measurements must hold for any bytes: it refuses with a
 * reason, or what it read evaluates to finite numbers */
#ifndef FUZZ_MEASURED_H
#define FUZZ_MEASURED_H

#include "data/measured.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static inline void fuzz_require(int good, const char *what)
{
    if (!good) {
        fprintf(stderr, "broken promise: %s\n", what);
        abort();
    }
}

/* Takes what a reader returned, with the error it was given. */
static inline int fuzz_result(asp_measured *m, const asp_error *err)
{
    if (!m) {
        char text[64], whole[700];
        fuzz_require(err->status > ASP_OK && err->status <= ASP_ENOMEM, "a status");
        fuzz_require(strncmp(err->file, "fuzz", 4) == 0, "the file's name");
        fuzz_require(err->reason[0] != 0, "a reason");
        fuzz_require(strlen(asp_error_text(err, text, sizeof text)) < sizeof text, "fits");
        fuzz_require(strlen(asp_error_text(err, whole, sizeof whole)) > 8, "has words");
        return 0;
    }
    static const double angle[6][4] = {
        { 0, 0, 0, 0 }, { 0.4, 0, 0.4, 3.141592653589793 }, { 1.2, 0.5, 0.3, 5 },
        { 1.5707, 2, 1.5706, 6 }, { 0.9, -2.5, 1.1, 1 }, { 1.570796, 3.1, 0, 0 },
    };
    for (int i = 0; i < 6; i++) {
        const double *a = angle[i];
        asp_vec3 wi = { sin(a[0]) * cos(a[1]), sin(a[0]) * sin(a[1]), cos(a[0]) };
        asp_vec3 wo = { sin(a[2]) * cos(a[3]), sin(a[2]) * sin(a[3]), cos(a[2]) };
        asp_rgb f = asp_measured_eval(m, wi, wo);
        fuzz_require(isfinite(f.r) && isfinite(f.g) && isfinite(f.b), "finite values");
        fuzz_require(f.r >= 0 && f.g >= 0 && f.b >= 0, "no negative values");
    }
    size_t count = 0;
    const asp_measurement *g = asp_measured_geometries(m, &count);
    for (size_t i = 0; i < count; i++) {
        double square = g[i].wi.x * g[i].wi.x + g[i].wi.y * g[i].wi.y + g[i].wi.z * g[i].wi.z;
        fuzz_require(g[i].wi.z > 0 && g[i].wo.z > 0 && fabs(square - 1) < 1e-9, "directions");
        fuzz_require(isfinite(asp_measured_eval(m, g[i].wi, g[i].wo).r), "its own geometries");
    }
    asp_measured_info info = asp_measured_get_info(m);
    fuzz_require(info.samples > 0 && (info.channels == 1 || info.channels == 3), "info");
    fuzz_require(strlen(info.description) < 100000, "a description");
    asp_measured_free(m);
    return 0;
}

static inline int fuzz_format(const aspi_format *format, const uint8_t *data, size_t size)
{
    aspi_bytes file = { data, size, "fuzz" };
    asp_error err;
    memset(&err, 0, sizeof err);
    if (!format->probe(&file))
        return -1;                        /* not worth keeping */
    return fuzz_result(format->read(&file, &err), &err);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#endif
