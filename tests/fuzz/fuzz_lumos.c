/* fuzz_lumos.c - any bytes to the reader of lumos files */
#include "fuzz_measured.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_format(&aspi_format_lumos, data, size);
}
