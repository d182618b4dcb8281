/* prepared_kernel.h - the formulas of a prepared surface
 *
 * Read once per precision by a distribution's file, after its ndf_density. prepared.h says what the
 * tables hold. */

#include "asperity/facet.h"
#include "pieces.h"

#ifndef PREPARED_KERNEL_NAMES
#define PREPARED_KERNEL_NAMES
#define prepared_cell ASP_NDF_NAME(_prepared_cell)
#define prepared_weights ASP_NDF_NAME(_prepared_weights)
#define prepared_spline_at ASP_NDF_NAME(_prepared_spline_at)
#define PREPARED_BLOCK 128
#define PREPARED_HUGE (ASP_PRECISION == 64 ? R(1e200) : R(1e18))
#define PREPARED_TINY (ASP_PRECISION == 64 ? R(1e-200) : R(1e-24))
#endif

/* x in cells, x < 2^31: the cell out of n, of which the last goes on beyond its end; a NaN counts as 0. By bits: the
 * compilers would branch. */
ASP_FN int prepared_cell(asp_real x, int n)
{
    int i = (int)aspi_select(x > R(0.0), x, R(0.0));
    return i < n - 1 ? i : n - 1;
}

/* The inner two weights of the cubic B-spline, times 6; the outer ones are (1 - t)^3 and t^3. */
ASP_FN asp_v2 prepared_weights(asp_real t)
{
    asp_real s = R(1.0) - t;
    asp_v2 out;
    out.x = R(4.0) - R(3.0) * (t * t) * (R(2.0) - t);
    out.y = R(4.0) - R(3.0) * (s * s) * (R(2.0) - s);
    return out;
}

/* The spline of n cells that starts at c[0], x in cells. */
ASP_FN asp_real prepared_spline_at(const asp_real *c, int n, asp_real x)
{
    int i = prepared_cell(x, n);
    asp_real t = x - (asp_real)i, s = R(1.0) - t;
    asp_v2 w = prepared_weights(t);
    return (c[i] * (s * s * s) + c[i + 1] * w.x) + (c[i + 2] * w.y + c[i + 3] * (t * t * t));
}

#include "prepared_sigma.h"
#include "prepared_visible.h"
