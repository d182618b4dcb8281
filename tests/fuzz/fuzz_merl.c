/* fuzz_merl.c - any bytes to the reader of MERL tables; a table of 90 x 90 x 180 bins is too large to
 * search in, so the reader is entered behind the check of the dimensions */
#include "fuzz_measured.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    aspi_bytes file = { data, size, "fuzz" };
    asp_error err;
    memset(&err, 0, sizeof err);
    if (aspi_format_merl.probe(&file))
        return fuzz_result(aspi_format_merl.read(&file, &err), &err);
    aspi_merl *merl = aspi_merl_parse(&file, &err);
    return fuzz_result(merl ? aspi_merl_wrap(merl, 3, "", 0, "merl", &err) : NULL, &err);
}
