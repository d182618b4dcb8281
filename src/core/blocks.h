/* blocks.h - batches block by block, for facets.c and the scattering models
 *
 * Batches are worked through in blocks that stay in the first-level cache; what is written does not
 * overlap what is read. A block is cut in loops so that the distribution's own loops can stand in the
 * middle. Read once per precision. */

#include "asperity/facet.h"
#include "bsdf/ops.h"

#ifndef ASPI_BLOCKS_ONCE
#define ASPI_BLOCKS_ONCE
#define ASPI_FROM ASP_NAME(aspi_from)
#define ASPI_TO ASP_NAME(aspi_to)
#define ASPI_TO_RGB ASP_NAME(aspi_to_rgb)
#define aspi_any_among ASP_NAME(aspi_any_among)
#define aspi_rows ASP_NAME(aspi_rows)
#define aspi_put_rows ASP_NAME(aspi_put_rows)
#define aspi_among ASP_NAME(aspi_among)
/* A batch block by block; a block's inputs are read before its outputs are written. */
#define ASPI_FOR_BLOCKS(i, size, n) \
    for (i = 0; i < (n) && (size = (n) - i < ASP_BLOCK ? (n) - i : ASP_BLOCK, 1); i += ASP_BLOCK)
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

#if (ASP_PRECISION == 64 && !defined(ASPI_BLOCKS_64)) || \
    (ASP_PRECISION == 32 && !defined(ASPI_BLOCKS_32))
#if ASP_PRECISION == 64
#define ASPI_BLOCKS_64
#else
#define ASPI_BLOCKS_32
#endif

/* The arrays from element i on. */
ASP_FN asp_cv3s ASPI_FROM(asp_cv3s a, size_t i)
{
    a.x += i;
    a.y += i;
    a.z += i;
    return a;
}

ASP_FN asp_v3s ASPI_TO(asp_v3s a, size_t i)
{
    a.x += i;
    a.y += i;
    a.z += i;
    return a;
}

ASP_FN asp_c3s ASPI_TO_RGB(asp_c3s a, size_t i)
{
    a.r += i;
    a.g += i;
    a.b += i;
    return a;
}

/* Whether an output is one of the inputs. */
ASP_FN int aspi_among(const asp_real *out, asp_cv3s in)
{
    return out == in.x || out == in.y || out == in.z;
}

ASP_FN int aspi_any_among(asp_v3s out, const asp_real *a, const asp_real *b, const asp_real *c)
{
    asp_cv3s in;
    in.x = a;
    in.y = b;
    in.z = c;
    return aspi_among(out.x, in) || aspi_among(out.y, in) || aspi_among(out.z, in);
}

/* A block's vectors in memory of its own, for outputs that are inputs too, and into the output. */
ASP_FN asp_v3s aspi_rows(asp_real m[3][ASP_BLOCK])
{
    asp_v3s out;
    out.x = m[0];
    out.y = m[1];
    out.z = m[2];
    return out;
}

ASP_FN void aspi_put_rows(asp_v3s to, size_t i, size_t size, asp_real m[3][ASP_BLOCK])
{
    memcpy(to.x + i, m[0], size * sizeof **m);
    memcpy(to.y + i, m[1], size * sizeof **m);
    memcpy(to.z + i, m[2], size * sizeof **m);
}
#endif
