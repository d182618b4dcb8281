/* own_batch.h - batches of models that bring calls of their own, read once per precision */

#include "core/rng.h"

#ifndef ASPI_OWN_BATCH_NAMES
#define ASPI_OWN_BATCH_NAMES
#define aspi_third_number ASP_NAME(aspi_third_number)
#endif

#if (ASP_PRECISION == 64 && !defined(ASPI_OWN_BATCH_64)) || \
    (ASP_PRECISION == 32 && !defined(ASPI_OWN_BATCH_32))
#if ASP_PRECISION == 64
#define ASPI_OWN_BATCH_64
#else
#define ASPI_OWN_BATCH_32
#endif

/* A number that knows nothing of u1 and u2 but is made of their bits. */
ASP_FN asp_real aspi_third_number(asp_real u1, asp_real u2)
{
    uint64_t a = aspi_to_bits(u1), b = aspi_to_bits(u2);
    return ASP_NAME(aspi_unit)(aspi_random_at(aspi_mix64(a), b));
}

void ASP_NAME(aspi_own_eval_n)(const asp_mat *mat, size_t n, asp_cv3s wi, asp_cv3s wo, int cosine, asp_c3s out);
void ASP_NAME(aspi_own_pdf_n)(const asp_mat *mat, size_t n, asp_cv3s wi, asp_cv3s wo, asp_real *out);
void ASP_NAME(aspi_own_sample_n)(const asp_mat *mat, size_t n, asp_cv3s wi, const asp_real *u1,
                         const asp_real *u2, asp_v3s wo, asp_real *pdf, asp_c3s weight);
#endif
