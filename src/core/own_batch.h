/* own_batch.h - batches of models that bring calls of their own, read once per precision */

#if (ASP_PRECISION == 64 && !defined(ASPI_OWN_BATCH_64)) || \
    (ASP_PRECISION == 32 && !defined(ASPI_OWN_BATCH_32))
#if ASP_PRECISION == 64
#define ASPI_OWN_BATCH_64
#else
#define ASPI_OWN_BATCH_32
#endif

void ASP_NAME(aspi_own_eval_n)(const asp_mat *mat, size_t n, asp_cv3s wi, asp_cv3s wo, int cosine, asp_c3s out);
void ASP_NAME(aspi_own_pdf_n)(const asp_mat *mat, size_t n, asp_cv3s wi, asp_cv3s wo, asp_real *out);
void ASP_NAME(aspi_own_sample_n)(const asp_mat *mat, size_t n, asp_cv3s wi, const asp_real *u1,
                         const asp_real *u2, asp_v3s wo, asp_real *pdf, asp_c3s weight);
#endif
