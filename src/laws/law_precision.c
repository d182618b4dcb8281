/* law_precision.c - batch = single, finite results, NaN out: in both precisions
 *
 * Read three times: this head, then the body per precision. */
#ifndef ASP_PRECISION
#include "laws/laws.h"

#include <stdlib.h>

#define ASP_PRECISION 64
#include "law_precision.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "law_precision.c"
#undef ASP_PRECISION

void aspi_law_batch(aspi_trial *t)
{
    batch_64(t, t->ndf);
    batch_32(t, &t->ndff);
}

void aspi_law_finite(aspi_trial *t)
{
    finite_64(t, t->ndf);
    finite_32(t, &t->ndff);
}

void aspi_law_nan(aspi_trial *t)
{
    nan_64(t, t->ndf);
    nan_32(t, &t->ndff);
}

#else
#include "asperity/number.h"

#undef CALL
#undef CALL_N
#undef V3
#undef CV3
#undef VRGB
#undef MATERIAL
#undef SAMPLE
#undef BITS_NAME
#if ASP_PRECISION == 64
#define CALL(what) asp_##what
#define CALL_N(what) asp_##what##_n
#define V3 asp_vec3s
#define CV3 asp_cvec3s
#define VRGB asp_rgbs
#define MATERIAL(t, kind, name) (*aspi_material(t, kind, name))
#define MATERIAL_TYPE asp_material
#define SAMPLE asp_bsdf_sample
#define BITS_NAME "float64"
#else
#undef MATERIAL_TYPE
#define CALL(what) asp_##what##f
#define CALL_N(what) asp_##what##_nf
#define V3 asp_vec3sf
#define CV3 asp_cvec3sf
#define VRGB asp_rgbsf
#define MATERIAL(t, kind, name) asp_material_narrow(aspi_material(t, kind, name))
#define MATERIAL_TYPE asp_materialf
#define SAMPLE asp_bsdf_samplef
#define BITS_NAME "float32"
#endif

/* ------------------------------------------------------------------ batch */

#define MOST 600
#define buffers ASP_NAME(buffers)
#define same_bits ASP_NAME(same_bits)
#define fill ASP_NAME(fill)
#define check_scalar ASP_NAME(check_scalar)
#define batch_size ASP_NAME(batch_size)
#define batch ASP_NAME(batch)
#define finite ASP_NAME(finite)
#define nan_law ASP_NAME(nan)
#define expect_finite ASP_NAME(expect_finite)
#define finite_pair ASP_NAME(finite_pair)
#define finite_walk ASP_NAME(finite_walk)
#define walk_uniform ASP_NAME(walk_uniform)
#define expect_nan ASP_NAME(expect_nan)
#define vector ASP_NAME(vector)

typedef struct buffers {
    asp_real ix[MOST], iy[MOST], iz[MOST], ox[MOST], oy[MOST], oz[MOST], mx[MOST], my[MOST],
             mz[MOST], u1[MOST], u2[MOST], a[MOST], b[MOST], c[MOST], d[MOST], e[MOST], f[MOST],
             g[MOST];
} buffers;

/* The same bits, or two NaNs. */
static int same_bits(asp_real x, asp_real y)
{
    return memcmp(&x, &y, sizeof x) == 0 || (x != x && y != y);
}

static asp_v3 vector(asp_real x, asp_real y, asp_real z)
{
    asp_v3 v;
    v.x = x;
    v.y = y;
    v.z = z;
    return v;
}

/* Directions of all kinds, some below the horizon, some exactly along an axis. */
static void fill(aspi_trial *t, buffers *b)
{
    int i;
    for (i = 0; i < MOST; i++) {
        asp_vec3 wi = aspi_random_direction(t), m = aspi_random_facet(t);
        asp_vec3 wo = aspi_random_direction(t);
        double c = aspi_dot(wi, m);
        if (i % 4) {
            wi.z = fabs(wi.z);
            wo.x = 2 * c * m.x - wi.x;
            wo.y = 2 * c * m.y - wi.y;
            wo.z = 2 * c * m.z - wi.z;
        }
        if (i % 31 == 0)
            wi.x = wi.y = 0, wi.z = 1;
        if (i % 37 == 0)
            wo.x = 1, wo.y = wo.z = 0;
        b->ix[i] = (asp_real)wi.x; b->iy[i] = (asp_real)wi.y; b->iz[i] = (asp_real)wi.z;
        b->ox[i] = (asp_real)wo.x; b->oy[i] = (asp_real)wo.y; b->oz[i] = (asp_real)wo.z;
        b->mx[i] = (asp_real)m.x; b->my[i] = (asp_real)m.y; b->mz[i] = (asp_real)m.z;
        b->u1[i] = i % 41 == 0 ? 0 : (asp_real)(0.9999999 * aspi_uniform(t));
        b->u2[i] = (asp_real)(0.9999999 * aspi_uniform(t));
    }
}

static void check_scalar(aspi_trial *t, const char *what, size_t n, size_t i, asp_real single,
                         asp_real from_batch)
{
    aspi_find(t, !same_bits(single, from_batch), 0, "%s, %s, element %zu of %zu: %.17g, single %.17g",
              BITS_NAME, what, i, n, (double)from_batch, (double)single);
}

#define COMPARE(name, batch_call, single_call) do { \
        batch_call; \
        for (i = 0; i < n; i++) \
            check_scalar(t, name, n, i, single_call, b->a[i]); \
    } while (0)
#define I(i) vector(b->ix[i], b->iy[i], b->iz[i])
#define O(i) vector(b->ox[i], b->oy[i], b->oz[i])
#define M(i) vector(b->mx[i], b->my[i], b->mz[i])

static void batch_size(aspi_trial *t, const asp_shape *k, buffers *b, size_t n)
{
    static const int masks[3] = { ASP_MASK_CORRELATED, ASP_MASK_UNCORRELATED | ASP_MASK_WALL,
                                  ASP_MASK_V_CAVITY };
    CV3 wi, wo, m;
    V3 out;
    VRGB colour;
    size_t i;
    int q, kind;
    wi.x = b->ix; wi.y = b->iy; wi.z = b->iz;
    wo.x = b->ox; wo.y = b->oy; wo.z = b->oz;
    m.x = b->mx; m.y = b->my; m.z = b->mz;
    out.x = b->a; out.y = b->b; out.z = b->c;
    colour.r = b->d; colour.g = b->e; colour.b = b->f;
    COMPARE("D", CALL_N(D)(k, n, m, b->a), CALL(D)(k, M(i)));
    COMPARE("P22", CALL_N(P22)(k, n, b->mx, b->my, b->a), CALL(P22)(k, b->mx[i], b->my[i]));
    COMPARE("sigma", CALL_N(sigma)(k, n, wo, b->a), CALL(sigma)(k, O(i)));
    COMPARE("pdf_normal", CALL_N(pdf_normal)(k, n, m, b->a), CALL(pdf_normal)(k, M(i)));
    COMPARE("pdf_visible", CALL_N(pdf_visible)(k, n, wi, m, b->a),
            CALL(pdf_visible)(k, I(i), M(i)));
    for (q = 0; q < 3; q++) {
        COMPARE("G1", CALL_N(G1)(k, n, wi, masks[q], b->a), CALL(G1)(k, I(i), masks[q]));
        COMPARE("lambda", CALL_N(lambda)(k, n, wi, masks[q], b->a),
                CALL(lambda)(k, I(i), masks[q]));
        COMPARE("G2", CALL_N(G2)(k, n, wi, wo, m, masks[q], b->a),
                CALL(G2)(k, I(i), O(i), M(i), masks[q]));
    }
    /* in place: an output may be an input */
    for (i = 0; i < n; i++)
        b->g[i] = b->ox[i];
    wo.x = b->g;
    CALL_N(sigma)(k, n, wo, b->g);
    wo.x = b->ox;
    for (i = 0; i < n; i++)
        check_scalar(t, "sigma in place", n, i, CALL(sigma)(k, O(i)), b->g[i]);
    for (q = 0; q < 2; q++) {
        if (q)
            CALL_N(sample_visible)(k, n, wi, b->u1, b->u2, out);
        else
            CALL_N(sample_normal)(k, n, b->u1, b->u2, out);
        for (i = 0; i < n; i++) {
            asp_v3 s = q ? CALL(sample_visible)(k, I(i), b->u1[i], b->u2[i])
                         : CALL(sample_normal)(k, b->u1[i], b->u2[i]);
            const char *name = q ? "sample_visible" : "sample_normal";
            check_scalar(t, name, n, i, s.x, b->a[i]);
            check_scalar(t, name, n, i, s.y, b->b[i]);
            check_scalar(t, name, n, i, s.z, b->c[i]);
        }
    }
    for (kind = aspi_first(t, 0); kind < aspi_end(t, n == 7 ? ASPI_ALL_MATERIALS : ASPI_MATERIALS); kind++) {
        const char *name;
        MATERIAL_TYPE mat = MATERIAL(t, kind, &name);
        for (q = 0; q < 2; q++) {
            if (q)
                CALL_N(eval)(&mat, n, wi, wo, colour);
            else
                CALL_N(eval_cos)(&mat, n, wi, wo, colour);
            for (i = 0; i < n; i++) {
                asp_c3 f = q ? CALL(eval)(&mat, I(i), O(i)) : CALL(eval_cos)(&mat, I(i), O(i));
                check_scalar(t, name, n, i, f.r, b->d[i]);
                check_scalar(t, name, n, i, f.g, b->e[i]);
                check_scalar(t, name, n, i, f.b, b->f[i]);
            }
        }
        CALL_N(pdf)(&mat, n, wi, wo, b->g);
        for (i = 0; i < n; i++)
            check_scalar(t, "pdf", n, i, CALL(pdf)(&mat, I(i), O(i)), b->g[i]);
        CALL_N(sample)(&mat, n, wi, b->u1, b->u2, out, b->g, colour);
        for (i = 0; i < n; i++) {
            SAMPLE s = CALL(sample)(&mat, I(i), b->u1[i], b->u2[i]);
            check_scalar(t, "sample wo.x", n, i, s.wo.x, b->a[i]);
            check_scalar(t, "sample wo.y", n, i, s.wo.y, b->b[i]);
            check_scalar(t, "sample wo.z", n, i, s.wo.z, b->c[i]);
            check_scalar(t, "sample pdf", n, i, s.pdf, b->g[i]);
            check_scalar(t, "sample weight.r", n, i, s.weight.r, b->d[i]);
            check_scalar(t, "sample weight.b", n, i, s.weight.b, b->f[i]);
        }
    }
}

static void batch(aspi_trial *t, const asp_shape *k)
{
    static const size_t sizes[3] = { MOST, 7, 1 };
    buffers *b = (buffers *)malloc(sizeof *b);
    int i;
    if (!b) {
        t->no_memory = 1;
        return;
    }
    for (i = 0; i < 3; i++) {
        fill(t, b);
        batch_size(t, k, b, sizes[i]);
    }
    free(b);
}

/* ------------------------------------------------------------------ finite */

static void expect_finite(aspi_trial *t, const char *what, asp_real x, asp_v3 a, asp_v3 b)
{
    aspi_find(t, !(x >= 0 && x < INFINITY), 0,
              "%s, %s is %g at (%.9g, %.9g, %.9g), (%.9g, %.9g, %.9g)", BITS_NAME, what, (double)x,
              (double)a.x, (double)a.y, (double)a.z, (double)b.x, (double)b.y, (double)b.z);
}

static void finite_pair(aspi_trial *t, const asp_shape *k, const MATERIAL_TYPE *mat, asp_v3 w,
                        asp_v3 v, int mask)
{
    asp_v3 up = vector(0, 0, 1);
    asp_c3 f = CALL(eval)(mat, w, v), fc = CALL(eval_cos)(mat, w, v);
    expect_finite(t, "G2", CALL(G2)(k, w, v, up, mask), w, v);
    expect_finite(t, "G2 with this m", CALL(G2)(k, w, w, v, mask), w, v);
    expect_finite(t, "pdf_visible", CALL(pdf_visible)(k, w, v), w, v);
    expect_finite(t, "eval r", f.r, w, v);
    expect_finite(t, "eval b", f.b, w, v);
    expect_finite(t, "eval_cos r", fc.r, w, v);
    expect_finite(t, "pdf", CALL(pdf)(mat, w, v), w, v);
}

static double walk_uniform(void *state) { return aspi_uniform((aspi_trial *)state); }

static void finite_walk(aspi_trial *t, const MATERIAL_TYPE *mat, asp_v3 w, asp_v3 v)
{
    SAMPLE s = CALL(walk_sample)(mat, w, walk_uniform, t);
    asp_c3 f = CALL(walk_eval_cos)(mat, w, v, walk_uniform, t);
    expect_finite(t, "walk pdf", s.pdf, w, s.wo);
    expect_finite(t, "walk weight", s.weight.r, w, s.wo);
    expect_finite(t, "walk eval_cos", f.r, w, v);
    expect_finite(t, "walk_pdf", CALL(walk_pdf)(mat, w, v), w, v);
}

static void finite(aspi_trial *t, const asp_shape *k)
{
    static const double heights[12] = { 0, 1, -1, 1e-8, -1e-8, 1e-30, 1e-45, 1e-75, 1e-150, 1e-310,
                                        -1e-310, 0.4 };
    /* the largest number below 1 of float32, which is fair for float64 too, and a tiny one */
    static const double ends[6] = { 0, 1e-12, 0.25, 0.5, 0.999, 0.99999994039535522 };
    enum { DIRECTIONS = 36 };
    asp_v3 w[DIRECTIONS];
    int i, j, kind, a, b;
    for (i = 0; i < DIRECTIONS; i++) {
        double phi = i % 3 == 0 ? 0 : i % 3 == 1 ? atan2(t->ndf->map.ty, t->ndf->map.tx) : 4.1;
        double z = heights[i / 3], s = sqrt(1 - z * z);
        w[i] = vector((asp_real)(s * cos(phi)), (asp_real)(s * sin(phi)), (asp_real)z);
    }
    for (i = 0; i < DIRECTIONS; i++) {
        asp_real lambda;
        expect_finite(t, "D", CALL(D)(k, w[i]), w[i], w[i]);
        expect_finite(t, "pdf_normal", CALL(pdf_normal)(k, w[i]), w[i], w[i]);
        expect_finite(t, "sigma", CALL(sigma)(k, w[i]), w[i], w[i]);
        expect_finite(t, "G1", CALL(G1)(k, w[i], 0), w[i], w[i]);
        lambda = CALL(lambda)(k, w[i], 0);
        /* infinite at the horizon, and where its true value is past the largest number */
        expect_finite(t, "lambda", w[i].z < (asp_real)(ASP_PRECISION == 64 ? 1e-300 : 1e-35)
                      && lambda > 0 ? 0 : lambda, w[i], w[i]);
    }
    for (kind = aspi_first(t, 0); kind < aspi_end(t, ASPI_ALL_MATERIALS); kind++) {
        const char *name;
        MATERIAL_TYPE mat = MATERIAL(t, kind, &name);
        aspi_traits is = aspi_traits_of(aspi_material(t, kind, &name));
        for (i = 0; i < DIRECTIONS; i++)
            for (j = 0; j < DIRECTIONS; j += is.quadrature ? 11 : kind < ASPI_MATERIALS || t->own ? 1 : 5)
                finite_pair(t, k, &mat, w[i], w[j], mat.mask);
        /* all draw from the same normals: one material from everywhere, the others from an azimuth each */
        for (i = t->own ? 0 : kind % 3; i < DIRECTIONS; i += kind == ASPI_MIRROR || t->own ? 1 : 3)
            for (a = 0; a < 6; a++)
                for (b = 0; b < 6; b++) {
                    SAMPLE s = CALL(sample)(&mat, w[i], (asp_real)ends[a], (asp_real)ends[b]);
                    double size = (double)s.wo.x * s.wo.x + (double)s.wo.y * s.wo.y
                                + (double)s.wo.z * s.wo.z;
                    if (w[i].z <= 0 && (!is.crosses || w[i].z == 0))
                        size = 1; /* outside the domain: no direction is promised */
                    expect_finite(t, "sample pdf", s.pdf, w[i], s.wo);
                    expect_finite(t, "sample weight.r", s.weight.r, w[i], s.wo);
                    expect_finite(t, "sample weight.b", s.weight.b, w[i], s.wo);
                    aspi_find(t, !(fabs(size - 1) < (ASP_PRECISION == 64 ? 1e-14 : 3e-6)), 0,
                              "%s, %s, wo (%.9g, %.9g, %.9g) at wi (%.9g, %.9g, %.9g), u (%.9g, %.9g)",
                              BITS_NAME, name, (double)s.wo.x, (double)s.wo.y, (double)s.wo.z,
                              (double)w[i].x, (double)w[i].y, (double)w[i].z, ends[a], ends[b]);
                }
        if (t->own ? is.walks : kind == ASPI_MIRROR || kind == ASPI_FILM || kind == ASPI_ROUGH_DIFFUSE
                                || kind == ASPI_DIELECTRIC || kind == ASPI_FILM_GLASS)
            for (i = 0; i < DIRECTIONS; i++)
                finite_walk(t, &mat, w[i], w[(7 * i + 5) % DIRECTIONS]);
    }
    for (i = -1; i < DIRECTIONS; i++)
        for (a = 0; a < 6; a++)
            for (b = 0; b < 6; b++) {
                asp_v3 m;
                double size;
                if (i >= 0 && !(CALL(sigma)(k, w[i]) > 0))
                    continue;
                m = i < 0 ? CALL(sample_normal)(k, (asp_real)ends[a], (asp_real)ends[b])
                  : CALL(sample_visible)(k, w[i], (asp_real)ends[a], (asp_real)ends[b]);
                size = (double)m.x * m.x + (double)m.y * m.y + (double)m.z * m.z;
                aspi_find(t, !(fabs(size - 1) < (ASP_PRECISION == 64 ? 1e-14 : 1e-6) && m.z >= 0),
                          0, "%s, %s (%.9g, %.9g, %.9g), height of the view %.9g, u (%.9g, %.9g)",
                          BITS_NAME, i < 0 ? "normal" : "visible normal", (double)m.x, (double)m.y,
                          (double)m.z, i < 0 ? 1 : (double)w[i].z, ends[a], ends[b]);
            }
}

/* ------------------------------------------------------------------ NaN */

static void expect_nan(aspi_trial *t, const char *what, int place, asp_real x)
{
    aspi_find(t, x == x, 0, "%s, %s gives %g for a NaN in argument number %d", BITS_NAME, what,
              (double)x, place);
}

static void nan_law(aspi_trial *t, const asp_shape *k)
{
    int i, mask, kind;
    for (i = 0; i < 9; i++) {
        asp_real x[9] = { (asp_real)0.48, 0, (asp_real)0.8771, (asp_real)-0.2, (asp_real)0.3,
                          (asp_real)0.9327, (asp_real)0.12, (asp_real)0.1, (asp_real)0.9877 };
        asp_v3 wi, wo, m;
        x[i] = (asp_real)NAN;
        wi = vector(x[0], x[1], x[2]);
        wo = vector(x[3], x[4], x[5]);
        m = vector(x[6], x[7], x[8]);
        if (i < 3) {
            expect_nan(t, "D", i, CALL(D)(k, wi));
            expect_nan(t, "pdf_normal", i, CALL(pdf_normal)(k, wi));
            expect_nan(t, "sigma", i, CALL(sigma)(k, wi));
        }
        for (mask = 0; mask < 3; mask++) {
            expect_nan(t, "G2", i, CALL(G2)(k, wi, wo, m, mask));
            if (i < 3 && (mask < 2 || i == 2)) { /* grooves look at the height only */
                expect_nan(t, "G1", i, CALL(G1)(k, wi, mask));
                expect_nan(t, "lambda", i, CALL(lambda)(k, wi, mask));
            }
        }
        if (i < 6)
            expect_nan(t, "pdf_visible", i, CALL(pdf_visible)(k, wi, wo));
        for (kind = aspi_first(t, 0); kind < aspi_end(t, ASPI_ALL_MATERIALS); kind++) {
            const char *name;
            MATERIAL_TYPE mat = MATERIAL(t, kind, &name);
            aspi_traits is = aspi_traits_of(aspi_material(t, kind, &name));
            SAMPLE s;
            if (i < 6) {
                expect_nan(t, "eval", i, CALL(eval)(&mat, wi, wo).r);
                expect_nan(t, "eval_cos", i, CALL(eval_cos)(&mat, wi, wo).g);
                expect_nan(t, "pdf", i, CALL(pdf)(&mat, wi, wo));
            }
            if (i < 5) { /* the view or one of the uniform numbers */
                s = CALL(sample)(&mat, wi, (asp_real)(i == 3 ? NAN : 0.3),
                                 (asp_real)(i == 4 ? NAN : 0.3));
                /* a diffuse lobe's direction does not depend on wi; its pdf and weight do */
                if (is.mirrors || i > 2)
                    expect_nan(t, "sample wo", i, s.wo.x + s.wo.y + s.wo.z);
                expect_nan(t, "sample pdf", i, s.pdf);
                expect_nan(t, "sample weight", i, s.weight.r);
            }
            if (i < 3 && (t->own ? is.walks : kind == ASPI_MIRROR || kind == ASPI_ROUGH_DIFFUSE
                                              || kind == ASPI_DIELECTRIC || kind == ASPI_FILM_GLASS)) {
                expect_nan(t, "walk weight", i, CALL(walk_sample)(&mat, wi, walk_uniform, t).weight.r);
                expect_nan(t, "walk eval_cos", i, CALL(walk_eval_cos)(&mat, wi, wo, walk_uniform, t).r);
                expect_nan(t, "walk_pdf", i, CALL(walk_pdf)(&mat, wi, wo));
            }
        }
        if (i < 5) {
            asp_real u1 = (asp_real)(i == 3 ? NAN : 0.3), u2 = (asp_real)(i == 4 ? NAN : 0.3);
            asp_v3 s = CALL(sample_visible)(k, wi, u1, u2);
            expect_nan(t, "sample_visible", i, s.x + s.y + s.z);
            if (i >= 3) {
                s = CALL(sample_normal)(k, u1, u2);
                expect_nan(t, "sample_normal", i, s.x + s.y + s.z);
            }
        }
        if (i < 2)
            expect_nan(t, "P22", i, CALL(P22)(k, x[0], x[1]));
    }
}

#undef buffers
#undef same_bits
#undef fill
#undef check_scalar
#undef batch_size
#undef batch
#undef finite
#undef nan_law
#undef expect_finite
#undef finite_pair
#undef finite_walk
#undef walk_uniform
#undef expect_nan
#undef vector
#undef COMPARE
#undef I
#undef O
#undef M
#undef MOST
#endif
