/* fuzz_slopes.c - any bytes to the reader of slopes: refused with a reason, or a distribution whose
 * projected area is right where it is known */
#include "fuzz_measured.h"
#include "data/slopes.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const asp_vec3 up = { 0, 0, 1 }, down = { 0, 0, -1 }, low = { 0.8, -0.59, 0.1 };
    aspi_bytes file = { data, size, "fuzz" };
    aspi_counting how = { 0, 0, 0, { 0, 0, 0, 0 } };
    aspi_slopes slopes;
    asp_error err;
    memset(&err, 0, sizeof err);
    asp_status s = aspi_slopes_read(&file, &slopes, &err);
    if (s == ASP_OK) {
        asp_ndf ndf;
        void *memory = NULL;
        s = aspi_slopes_histogram(&slopes, "fuzz", &how, NULL, &memory, &ndf, &err);
        aspi_slopes_free(&slopes);
        if (s == ASP_OK) {
            asp_vec3 m = asp_sample_visible(&ndf, low, 0.3, 0.7);
            fuzz_require(fabs(asp_sigma(&ndf, up) - 1) < 1e-9, "sigma from above");
            fuzz_require(asp_sigma(&ndf, down) == 0, "sigma from below");
            fuzz_require(isfinite(asp_sigma(&ndf, low)) && isfinite(m.x) && m.z >= 0, "finite values");
            free(memory);
            return 0;
        }
    }
    fuzz_require(err.status == s && s != ASP_OK, "a status");
    fuzz_require(strncmp(err.file, "fuzz", 4) == 0, "the file's name");
    fuzz_require(err.reason[0] != 0, "a reason");
    return aspi_is_text(&file) ? 0 : -1;
}
