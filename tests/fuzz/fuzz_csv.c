/* fuzz_csv.c - any bytes to the reader of csv files */
#include "fuzz_measured.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_format(&aspi_format_csv, data, size);
}
