/* fuzz_cornell.c - any bytes to the reader of cornell files */
#include "fuzz_measured.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    return fuzz_format(&aspi_format_cornell, data, size);
}
