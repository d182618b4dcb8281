/* blocks.h - quantities over one block, for facets.c and the scattering models
 *
 * Batches are worked through in blocks that stay in the first-level cache. n <= ASPI_BLOCK; what is
 * written does not overlap what is read. A block is cut in loops so that the distribution's own loop
 * can stand in the middle. The loops are inlined where they are called: put ASP_CLONES on the caller,
 * so that one dispatch serves them all. Read once per precision. */

#include "asperity/facet.h"

#ifndef ASPI_BLOCKS_ONCE
#define ASPI_BLOCKS_ONCE
/* About twenty arrays are in use at a time: 20 KB. */
#define ASPI_BLOCK (ASP_PRECISION == 64 ? 128 : 256)
#define aspi_loop_density_in ASP_NAME(aspi_loop_density_in)
#define aspi_loop_density_out ASP_NAME(aspi_loop_density_out)
#define aspi_loop_view ASP_NAME(aspi_loop_view)
#define aspi_loop_view_vectors ASP_NAME(aspi_loop_view_vectors)
#define aspi_loop_back ASP_NAME(aspi_loop_back)
#define ASPI_FROM ASP_NAME(aspi_from)
#define ASPI_TO ASP_NAME(aspi_to)
#define ASPI_TO_RGB ASP_NAME(aspi_to_rgb)
/* A batch block by block; a block's inputs are read before its outputs are written. */
#define ASPI_FOR_BLOCKS(i, size, n) \
    for (i = 0; i < (n) && (size = (n) - i < ASPI_BLOCK ? (n) - i : ASPI_BLOCK, 1); \
         i += ASPI_BLOCK)
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

#define IN const asp_real *ASP_RESTRICT
#define OUT asp_real *ASP_RESTRICT

ASP_FN void aspi_loop_density_in(const asp_shape *k, size_t n, IN x, IN y, IN z, OUT r2,
                                 OUT z2, OUT mz)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v3 m;
        asp_v2 a;
        m = aspi_at(x, y, z, i);
        a = aspi_density_arguments(k, m);
        r2[i] = a.x;
        z2[i] = a.y;
        mz[i] = m.z;
    }
}

ASP_FN void aspi_loop_density_out(const asp_shape *k, size_t n, IN standard, IN mz, OUT out)
{
    size_t i;
    for (i = 0; i < n; i++)
        out[i] = aspi_density_result(k, standard[i], mz[i]);
}

/* height and squared length of the standard view; sign = -1 looks from below */
ASP_FN void aspi_loop_view(const asp_shape *k, size_t n, asp_real sign, IN x, IN y, IN z,
                           OUT w, OUT s2)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v3 v = aspi_at(x, y, z, i);
        v = aspi_view(k, v);
        w[i] = sign * v.z;
        s2[i] = aspi_length2(v);
    }
}

ASP_FN void aspi_loop_view_vectors(const asp_shape *k, size_t n, IN x, IN y, IN z, OUT vx,
                                   OUT vy, OUT vz)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v3 v = aspi_at(x, y, z, i);
        v = aspi_view(k, v);
        vx[i] = v.x;
        vy[i] = v.y;
        vz[i] = v.z;
    }
}

ASP_FN void aspi_loop_back(const asp_shape *k, size_t n, IN x, IN y, IN z, OUT mx, OUT my,
                           OUT mz)
{
    size_t i;
    for (i = 0; i < n; i++) {
        asp_v3 m = aspi_at(x, y, z, i);
        m = aspi_normalize(aspi_facet_back(k, m));
        mx[i] = m.x;
        my[i] = m.y;
        mz[i] = m.z;
    }
}

ASP_FN void aspi_block_density(const asp_shape *k, size_t n, asp_cv3s m, asp_real *out)
{
    asp_real r2[ASPI_BLOCK], z2[ASPI_BLOCK], mz[ASPI_BLOCK], d[ASPI_BLOCK];
    if (!n)
        return;
    aspi_loop_density_in(k, n, m.x, m.y, m.z, r2, z2, mz);
    ASPI_OPS(k).density_n(k, n, r2, z2, d);
    aspi_loop_density_out(k, n, d, mz, out);
}

ASP_FN void aspi_block_sigma(const asp_shape *k, size_t n, asp_cv3s w, asp_real *out)
{
    asp_real h[ASPI_BLOCK], s2[ASPI_BLOCK];
    if (!n)
        return;
    aspi_loop_view(k, n, R(1.0), w.x, w.y, w.z, h, s2);
    ASPI_OPS(k).sigma_n(k, n, h, s2, out);
}

ASP_FN void aspi_block_visible(const asp_shape *k, size_t n, asp_cv3s wi, const asp_real *u1,
                               const asp_real *u2, asp_v3s m)
{
    asp_real vx[ASPI_BLOCK], vy[ASPI_BLOCK], vz[ASPI_BLOCK];
    asp_real x[ASPI_BLOCK], y[ASPI_BLOCK], z[ASPI_BLOCK];
    if (!n)
        return;
    aspi_loop_view_vectors(k, n, wi.x, wi.y, wi.z, vx, vy, vz);
    ASPI_OPS(k).visible_n(k, n, vx, vy, vz, u1, u2, x, y, z);
    aspi_loop_back(k, n, x, y, z, m.x, m.y, m.z);
}

#undef IN
#undef OUT
#endif
