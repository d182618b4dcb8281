/* histogram.c - slopes counted in cells, as a distribution
 *
 * Not round, so planar; too many numbers for a value, so they stand in the caller's memory. Its loops
 * call the formulas of histogram_rows.c one by one, which run over the rows of cells in vectors. float32
 * computes in float64 between its rounded arguments and results: the numbers are read, not stored, and
 * a slope must fall into the same cell. */
#ifndef ASP_PRECISION
#include "ndf/histogram.h"

static asp_status histogram_prepare(asp_ndf *out, asp_error *err)
{
    if (!out->data)
        return asp_fail(err, ASP_EINVAL, "histogram", "its values are missing: it is made by "
                        "asp_histogram_make or from a file");
    return ASP_OK;
}

static int histogram_lattice(const asp_ndf *ndf, asp_lattice *out)
{
    const aspi_cells *k = (const aspi_cells *)ndf->data;
    out->nx = (size_t)k->nx;
    out->ny = (size_t)k->ny;
    out->x0 = k->x0;
    out->y0 = k->y0;
    out->dx = k->dx;
    out->dy = k->dy;
    return 1;
}

#define ASP_SCALAR_LOOPS        /* of the batches; what runs in vectors is a view's rows */
#define ASP_NDF histogram
#define ASP_NDF_PLANAR
#define ASP_PRECISION 64
#include "histogram.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "histogram.c"
#undef ASP_PRECISION
#undef ASP_NDF_PLANAR

ASP_RECORD asp_model asp_model_histogram = {
    "histogram", NULL, "slopes counted in cells: anisotropic, skewed, as measured",
    "P22 constant in each cell", ASP_KEYS_SLOPE, 1.0, 1, 0.0, NULL, 0, histogram_prepare,
    ASP_NDF_OPS_LATTICE(histogram, histogram_lattice)
};
#undef ASP_NDF

#else
#include "asperity/elementary.h"

#define histogram_narrow ASP_NDF_NAME(_narrow)
#define histogram_wide ASP_NDF_NAME(_wide)

ASP_FN asp_vec3 histogram_wide(asp_real x, asp_real y, asp_real z)
{
    asp_vec3 v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
}

ASP_FN asp_v3 histogram_narrow(asp_vec3 m)
{
    asp_v3 out;
    out.x = (asp_real)m.x;
    out.y = (asp_real)m.y;
    out.z = (asp_real)m.z;
    return out;
}

ASP_FN asp_real ndf_density(const asp_shape *k, asp_v3 m)
{
    double per_z = 1.0 / m.z, square = per_z * per_z;
    double d = aspi_cells_P22((const aspi_cells *)k->data, -m.x * per_z, -m.y * per_z);
    return (asp_real)(d > 0.0 ? d * square * square : d);
}

ASP_FN asp_real ndf_sigma(const asp_shape *k, asp_v3 v)
{
    return (asp_real)aspi_cells_sigma((const aspi_cells *)k->data, histogram_wide(v.x, v.y, v.z));
}

ASP_FN asp_v3 ndf_visible(const asp_shape *k, asp_v3 v, asp_real u1, asp_real u2)
{
    return histogram_narrow(aspi_cells_visible((const aspi_cells *)k->data,
                                               histogram_wide(v.x, v.y, v.z), u1, u2));
}

ASP_FN asp_v3 ndf_normal(const asp_shape *k, asp_real u1, asp_real u2)
{
    return histogram_narrow(aspi_cells_normal((const aspi_cells *)k->data, u1, u2));
}

#include "asperity/ndf_loops.h"
#endif
