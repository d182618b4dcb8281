/* prepared_kernel.h - the formulas of a prepared surface
 *
 * Read once per precision by a distribution's file, after its ndf_density. prepared.h says what the
 * tables hold. */

#include "asperity/facet.h"
#include "pieces.h"

#ifndef PREPARED_KERNEL_NAMES
#define PREPARED_KERNEL_NAMES
#define prepared_cell ASP_NDF_NAME(_prepared_cell)
#define PREPARED_BLOCK 128
#define PREPARED_HUGE (ASP_PRECISION == 64 ? R(1e200) : R(1e18))
#define PREPARED_TINY (ASP_PRECISION == 64 ? R(1e-200) : R(1e-24))
#endif

#undef PREPARED_BENDS
#ifdef PREPARED_BENT
#define PREPARED_BENDS 1
#else
#define PREPARED_BENDS 0
#endif

/* x in cells, x < 2^31: the cell out of n, of which the last goes on beyond its end; a NaN counts as 0. By bits: the
 * compilers would branch. */
ASP_FN int prepared_cell(asp_real x, int n)
{
    int i = (int)aspi_select(x > R(0.0), x, R(0.0));
    return i < n - 1 ? i : n - 1;
}

#include "prepared_sigma.h"
#include "prepared_turn.h"
#include "prepared_tail.h"
#include "prepared_visible.h"
