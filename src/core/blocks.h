/* blocks.h - what facets.c offers to the scattering models: quantities over one block
 *
 * Batches are worked through in blocks that stay in the first-level cache. n <= ASPI_BLOCK; arrays
 * do not overlap, n is not 0. Read once per precision, after asperity/number.h. */

#ifndef ASPI_BLOCKS_ONCE
#define ASPI_BLOCKS_ONCE
#define ASPI_BLOCK 256
#define aspi_block_density ASP_NAME(aspi_block_density)
#define aspi_block_sigma ASP_NAME(aspi_block_sigma)
#define aspi_block_visible ASP_NAME(aspi_block_visible)
/* The record's formulas and the public calls' names in this precision. */
#define ASPI_OPS_64(k) ((k)->model->f64)
#define ASPI_OPS_32(k) ((k)->model->f32)
#define ASPI_OPS ASP_NAME(ASPI_OPS)
#define ASPI_CALL_64(x) x
#define ASPI_CALL_32(x) ASP_PASTE(x, f)
#define ASPI_CALL ASP_NAME(ASPI_CALL)
#endif

#undef asp_v3s
#undef asp_c3s
#undef asp_cv3s
#if ASP_PRECISION == 64
#define asp_v3s asp_vec3s
#define asp_cv3s asp_cvec3s
#define asp_c3s asp_rgbs
#else
#define asp_v3s asp_vec3sf
#define asp_cv3s asp_cvec3sf
#define asp_c3s asp_rgbsf
#endif

void aspi_block_density(const asp_shape *k, size_t n, asp_cv3s m, asp_real *out);
void aspi_block_sigma(const asp_shape *k, size_t n, asp_cv3s w, asp_real *out);
void aspi_block_visible(const asp_shape *k, size_t n, asp_cv3s wi, const asp_real *u1,
                        const asp_real *u2, asp_v3s m);
