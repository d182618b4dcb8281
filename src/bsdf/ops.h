/* ops.h - a distribution's formulas by its record, in both precisions */

#include "asperity_ndf.h"
#include "asperity/facet.h"

#ifndef ASPI_OPS_NAMES
#define ASPI_OPS_NAMES
/* The record's formulas in this precision. */
#define ASPI_OPS_64(k) ((k)->model->f64)
#define ASPI_OPS_32(k) ((k)->model->f32)
#define ASPI_OPS ASP_NAME(ASPI_OPS)
#define aspi_density_of ASP_NAME(aspi_density_of)
#define aspi_sigma_of ASP_NAME(aspi_sigma_of)
#endif

#if (ASP_PRECISION == 64 && !defined(ASPI_OPS_READ_64)) || \
    (ASP_PRECISION == 32 && !defined(ASPI_OPS_READ_32))
#if ASP_PRECISION == 64
#define ASPI_OPS_READ_64
#else
#define ASPI_OPS_READ_32
#endif

ASP_FN asp_real aspi_density_of(const asp_shape *k, asp_v3 m) { return ASPI_OPS(k).density(k, m.x, m.y, m.z); }

ASP_FN asp_real aspi_sigma_of(const asp_shape *k, asp_v3 w) { return ASPI_OPS(k).sigma(k, w.x, w.y, w.z); }
#endif
