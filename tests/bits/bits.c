/* bits.c - a hash of everything the core computes
 *
 * Same inputs, same text, same bits: on every compiler, instruction set and WASM. run.sh builds this
 * with the core in a dozen ways and compares what it prints, a line per precision and quantity.
 * NaNs count as one number, for IEEE 754 leaves their payload open. Inputs are made with +, -, *, /
 * and square roots only. Read three times: head, float64, float32. */
#ifndef ASP_PRECISION
#include "asperity.h"
#include "asperity_ndf.h"
#include "asperity_study.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define COUNT 700   /* more than two blocks, and a rest */

static const char *const specs[] = {
    "alpha=0.3", "alpha_x=0.35,alpha_y=0.08,rotation=0.6,mean_x=0.4,mean_y=-0.25", "alpha=0.001",
    "alpha_x=0.7,alpha_y=0.3,rho=-0.6,mean_x=1.2,mean_y=1.6", "alpha=4"
};
static const char *const ellipsoids[] = {
    "alpha=0.3", "alpha_x=0.2,alpha_y=0.1,theta_x=0.3,theta_y=-0.2,theta_z=0.7",
    "a11=0.3,a12=0.1,a13=0.05,a21=-0.02,a22=0.2,a23=0,a31=0.3,a32=-0.5,a33=1",
    "s11=0.3,s12=0.02,s13=-0.4,s22=0.2,s23=0.1,s33=1", "alpha_x=0.01,alpha_y=0.02,theta_x=0.02"
};

/* ---- FNV-1a, 64 bits, over 8-byte words */

enum { Q_MAKE, Q_MAP, Q_D, Q_P22, Q_SIGMA, Q_G1, Q_LAMBDA, Q_G2, Q_NORMAL, Q_VISIBLE, Q_PDF_NORMAL,
       Q_PDF_VISIBLE, Q_FRESNEL, Q_EVAL, Q_EVAL_COS, Q_PDF, Q_SAMPLE, Q_FORMS, Q_ORACLE, Q_WALTER, Q_SGGX,
       Q_MODEL_MAKE, Q_MODEL_EVAL, Q_MODEL_PDF, Q_MODEL_SAMPLE, Q_BOUNDED, Q_WALK_EVAL, Q_WALK_SAMPLE,
       Q_WALK_PDF, QUANTITIES };
static const char *const quantity[QUANTITIES] = {
    "make", "map", "D", "P22", "sigma", "G1", "lambda", "G2", "sample_normal", "sample_visible",
    "pdf_normal", "pdf_visible", "fresnel", "eval", "eval_cos", "pdf", "sample",
    "student_lambda", "oracle", "walter", "sggx",
    "model_make", "model_eval", "model_pdf", "model_sample", "bounded", "walk_eval", "walk_sample", "walk_pdf"
};

typedef uint64_t hashes[QUANTITIES];

static void add_bits(uint64_t *h, uint64_t bits)
{
    *h = (*h ^ bits) * 0x100000001b3u;
    *h ^= *h >> 29;
}

static uint64_t state;

/* splitmix64; [0, 1) in 24 bits, exact in both precisions */
static double next_of(void *from)
{
    uint64_t *s = (uint64_t *)from, z = (*s += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return (double)((z ^ (z >> 31)) >> 40) * 0x1p-24;
}

static double uniform(void) { return next_of(&state); }

/* Uniform on the sphere without sine and cosine (Marsaglia 1972). */
static asp_vec3 direction(void)
{
    double a, b, s;
    asp_vec3 w;
    do {
        a = 2 * uniform() - 1;
        b = 2 * uniform() - 1;
        s = a * a + b * b;
    } while (s >= 1);
    w.x = 2 * a * sqrt(1 - s);
    w.y = 2 * b * sqrt(1 - s);
    w.z = 1 - 2 * s;
    return w;
}

static double next_uniform(void *unused)
{
    (void)unused;
    return uniform();
}

static int mismatches;

#define ASP_PRECISION 64
#include "bits.c"
#undef ASP_PRECISION
#define ASP_PRECISION 32
#include "bits.c"
#undef ASP_PRECISION

static void hash_doubles(uint64_t *h, const double *x, size_t n)
{
    size_t i;
    for (i = 0; i < n; i++)
        hash_64(h, x[i]);
}

static void one_ndf(asp_ndf ndf, const char *text, int verbose, hashes wide, hashes narrow)
{
    asp_ndff ndff;
    double A[9];
    asp_roughness five;
    hashes w, n;
    int i;
    memset(w, 0, sizeof w);
    memset(n, 0, sizeof n);
    ndff = asp_ndf_narrow(&ndf);
    hash_doubles(&w[Q_MAKE], ndf.shape, ASP_SHAPE_NUMBERS);
    hash_doubles(&w[Q_MAKE], ndf.table, ASP_TABLE_NUMBERS);
    hash_doubles(&w[Q_MAKE], &ndf.i00, 5);
    for (i = 0; i < ASP_TABLE_NUMBERS; i++)
        hash_32(&n[Q_MAKE], ndff.table[i]);
    asp_map_to_matrix(&ndf.map, A);
    five = asp_map_to_roughness(&ndf.map);
    hash_doubles(&w[Q_MAP], A, 9);
    hash_doubles(&w[Q_MAP], &five.alpha_x, 5);
    all_64(&ndf, &ndf, w);
    all_32(&ndff, &ndf, n);
    for (i = 0; i < QUANTITIES; i++) {
        add_bits(&wide[i], w[i]);
        add_bits(&narrow[i], n[i]);
        if (verbose)
            printf("%s %s %016llx %016llx\n", text, quantity[i], (unsigned long long)w[i],
                   (unsigned long long)n[i]);
    }
}

static int one_value(const asp_model *model, const char *spec, int verbose, hashes wide,
                     hashes narrow)
{
    char text[256];
    asp_ndf ndf;
    asp_error err;
    strcpy(text, model->name);
    strcat(text, ":");
    strcat(text, spec);
    if (asp_ndf_parse(NULL, text, &ndf, &err) != ASP_OK) {
        printf("%s refused: %s %s\n", text, err.name, err.reason);
        return 1;
    }
    one_ndf(ndf, text, verbose, wide, narrow);
    return 0;
}

/* Slopes counted in cells, some of them empty, through a map. */
static int one_histogram(int verbose, hashes wide, hashes narrow)
{
    enum { NX = 23, NY = 17 };
    static double memory[32 * (NX + 3) * (NY + 3)], values[NX * NY];
    const asp_slope_range range = { -0.5, 0.9, -0.3, 0.4 };
    const asp_map map = { 0.75, 0.25, -0.1, 1.25, 0.05, -0.1 };
    asp_ndf ndf;
    int i;
    state = 54321;
    for (i = 0; i < NX * NY; i++)
        values[i] = i % 5 ? uniform() * (double)(i % NX + 1) : 0;
    if (asp_histogram_bytes(NX, NY) > sizeof memory
        || asp_histogram_make(memory, NX, NY, range, values, &map, &ndf, NULL) != ASP_OK)
        return 1;
    one_ndf(ndf, "histogram", verbose, wide, narrow);
    return 0;
}

static void hash_vector(uint64_t *h, asp_vec3 v)
{
    hash_64(h, v.x);
    hash_64(h, v.y);
    hash_64(h, v.z);
}

/* asperity_study.h, and the STD paper's maskings. */
static int study(hashes wide, hashes narrow)
{
    static const char *const forms[] = { "exact", "hypergeometric", "integer", "half_integer", "rational" };
    static const char *const surfaces[] = { "ggx:alpha=0.5,mean_y=0.4", "beckmann:alpha=0.3",
                                            "student_t:alpha=0.4,gamma=3.3,mean_x=0.2" };
    static const double A[9] = { 0.3, 0.1, 0.05, -0.02, 0.2, 0, 0.3, -0.5, 1 };
    static asp_oracle oracle;
    asp_sggx flakes;
    asp_sggxf small;
    int i, j, kind, bad = asp_sggx_from_matrix(A, &flakes, NULL) != ASP_OK;
    state = 98765;
    for (i = 0; i < 60; i++)
        for (j = 0; j < 5; j++) {
            double lambda = 0;
            asp_student_lambda(forms[j], j == 3 ? i + 2.5 : i + 2, 0.04 * i, &lambda, NULL);
            hash_64(&wide[Q_FORMS], lambda);
        }
    for (i = 0; i < 3; i++)
        for (kind = 0; kind < 2; kind++) {
            asp_ndf ndf;
            bad += asp_ndf_parse(NULL, surfaces[i], &ndf, NULL)
                || asp_oracle_make(&ndf, kind ? ASP_ORACLE_RADIAL : ASP_ORACLE_STUDENT, &oracle, NULL);
            for (j = 0; !bad && j < COUNT; j++) {
                asp_vec3 w = direction();
                w.z = w.z < -0.1 ? -w.z : w.z;
                hash_vector(&wide[Q_ORACLE], asp_oracle_visible(&oracle, w, next_uniform, NULL));
            }
        }
    small = asp_sggx_narrow(&flakes);
    for (i = 0; i < COUNT; i++) {
        asp_vec3 w = direction(), m;
        asp_vec3f v, n;
        double u1 = uniform(), u2 = uniform();
        v.x = (float)w.x; v.y = (float)w.y; v.z = (float)w.z;
        m = asp_sggx_sample_visible(&flakes, w, u1, u2);
        n = asp_sggx_sample_visiblef(&small, v, (float)u1, (float)u2);
        hash_vector(&wide[Q_SGGX], m);
        hash_64(&wide[Q_SGGX], asp_sggx_pdf_visible(&flakes, w, m));
        hash_32(&narrow[Q_SGGX], n.x + 2 * n.y + 4 * n.z);
        hash_32(&narrow[Q_SGGX], asp_sggx_pdf_visiblef(&small, v, n));
        w.z = fabs(w.z);
        hash_vector(&wide[Q_WALTER], asp_sample_visible_walter(A, w, u1, u2));
    }
    return bad;
}

/* The scattering models beside those of `all`, each with a distribution, and what walks over them. */
static int models(int verbose, hashes wide, hashes narrow)
{
    static const char *const specs_of[] = {
        "dielectric:eta=1.5,ndf=(ggx:alpha=0.3)", "rough_diffuse:albedo=0.8/0.5/0.2,ndf=(ggx:alpha=0.5)",
        "dielectric:eta=0.6,transport=importance,mask=uncorrelated,ndf=(beckmann:alpha_x=0.5,alpha_y=0.2,mean_x=0.3)",
        "dielectric:eta=1.8,thin=1,mask=v_cavity,ndf=(student_t:alpha=0.4,gamma=2.7)",
        "rough_diffuse:form=oren_nayar,ndf=(beckmann:alpha=0.5)", "rough_diffuse:form=fujii,ndf=(ggx:alpha=0.6)",
        "rough_diffuse:form=eon,albedo=0.9/0.5/0.1,ndf=(ggx:alpha_x=0.6,alpha_y=0.2)",
        "plastic:albedo=0.7/0.4/0.2,eta=1.6,ndf=(ggx:alpha=0.2)",
        "plastic:albedo=1,mask=wall,ndf=(student_t:alpha_x=0.2,alpha_y=0.5,gamma=3.1,mean_x=0.3)",
        "compensated:metal=Au,ndf=(beckmann:alpha_x=0.7,alpha_y=0.4)", "compensated:metal=Cu,form=turquin,ndf=(ggx:alpha=0.6)",
        "compensated_dielectric:eta=1.6,ndf=(student_t:alpha=0.5,gamma=2.7)",
        "compensated_dielectric:eta=0.7,form=turquin,mask=wall,ndf=(ggx:alpha_x=0.6,alpha_y=0.3,mean_x=0.2)",
        "compensated_dielectric:eta=1.4,thin=1,ndf=(beckmann:alpha=0.6)",
        "dielectric:eta=0.7,film=240,film_eta=1.7,transport=importance,ndf=(ggx:alpha_x=0.4,alpha_y=0.2,mean_y=0.2)",
        "dielectric:eta=1.5,thin=1,film=600,mask=uncorrelated,ndf=(beckmann:alpha=0.4)",
        "conductor:metal=Ti,film=320,film_eta=2.1,ndf=(ggx:alpha_x=0.3,alpha_y=0.1,rotation=0.4)",
        "conductor:f0=0.9/0.6/0.3,tint=0.8,ndf=(student_t:alpha=0.5,gamma=2.2,mean_y=-0.4)"
    };
    size_t i;
    int q, bad = 0;
    for (i = 0; i < sizeof specs_of / sizeof *specs_of; i++) {
        asp_material mat;
        asp_materialf matf;
        hashes w, n;
        memset(w, 0, sizeof w);
        memset(n, 0, sizeof n);
        if (asp_material_parse(NULL, specs_of[i], &mat, NULL) != ASP_OK) {
            printf("%s refused\n", specs_of[i]);
            bad++;
            continue;
        }
        matf = asp_material_narrow(&mat);
        state = 777u + i;
        hash_doubles(&w[Q_MODEL_MAKE], mat.energy, ASP_ENERGY_NUMBERS);
        hash_doubles(&w[Q_MODEL_MAKE], &mat.a.r, 12);
        model_64(&mat, w);
        model_32(&matf, n);
        for (q = 0; q < QUANTITIES; q++) {
            add_bits(&wide[q], w[q]);
            add_bits(&narrow[q], n[q]);
            if (verbose && q >= Q_MODEL_MAKE)
                printf("%s %s %016llx %016llx\n", specs_of[i], quantity[q], (unsigned long long)w[q],
                       (unsigned long long)n[q]);
        }
    }
    return bad;
}

int main(int argc, char **argv)
{
    hashes wide, narrow;
    const asp_model *const *m;
    int i, refused = 0, verbose = argc > 1 && strcmp(argv[1], "-v") == 0;
    memset(wide, 0, sizeof wide);
    memset(narrow, 0, sizeof narrow);
    for (m = asp_models(); *m; m++) {
        const char *const *list = (*m)->keys == ASP_KEYS_ELLIPSOID ? ellipsoids : specs;
        for (i = 0; i < 5; i++) {
            char spec[200], more[100] = "";
            size_t k;
            /* away from the default shape, nearer to the low end the later the map */
            for (k = 0; k < (*m)->param_count; k++) {
                const asp_param *p = &(*m)->params[k];
                double step = i == 0 ? 0.01 : i == 1 ? 0.7 : i == 2 ? 2.385 : i == 3 ? 30.5 : 0;
                double value = (isfinite(p->low) ? p->low : 0) + step;
                char *end = more + strlen(more);
                if (i == 4 || value > p->high)
                    continue;
                snprintf(end, sizeof more - (size_t)(end - more), ",%s=%.10g", p->name, value);
            }
            /* where alpha is the model's own number, the map's is alpha_x and alpha_y */
            if ((*m)->own_scale && strncmp(list[i], "alpha=", 6) == 0)
                snprintf(spec, sizeof spec, "alpha_x=%.40s,alpha_y=%.40s", list[i] + 6, list[i] + 6);
            else
                strcpy(spec, list[i]);
            strcat(spec, more);
            state = 12345u + (uint64_t)i;
            refused += one_value(*m, spec, verbose, wide, narrow);
        }
    }
    refused += one_histogram(verbose, wide, narrow);
    refused += study(wide, narrow);
    refused += models(verbose, wide, narrow);
    for (i = 0; i < QUANTITIES; i++)
        printf("%-16s float64 %016llx float32 %016llx\n", quantity[i],
               (unsigned long long)wide[i], (unsigned long long)narrow[i]);
    if (mismatches)
        printf("%d results of batches differ from single calls\n", mismatches);
    return refused != 0 || mismatches != 0;
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
#if ASP_PRECISION == 64
#define CALL(what) asp_##what
#define CALL_N(what) asp_##what##_n
#define V3 asp_vec3s
#define CV3 asp_cvec3s
#define VRGB asp_rgbs
#define MATERIAL asp_material
#define SAMPLE asp_bsdf_sample
#else
#define CALL(what) asp_##what##f
#define CALL_N(what) asp_##what##_nf
#define V3 asp_vec3sf
#define CV3 asp_cvec3sf
#define VRGB asp_rgbsf
#define MATERIAL asp_materialf
#define SAMPLE asp_bsdf_samplef
#endif
#define hash ASP_NAME(hash)
#define all ASP_NAME(all)
#define same ASP_NAME(same)
#define arrays ASP_NAME(arrays)
#define store ASP_NAME(store)
#define materials ASP_NAME(materials)
#define walks ASP_NAME(walks)
#define model ASP_NAME(model)
#define hash_sample ASP_NAME(hash_sample)
#define some_direction ASP_NAME(some_direction)

static void hash(uint64_t *h, asp_real x)
{
    asp_bits b;
    memcpy(&b, &x, sizeof b);
    add_bits(h, x == x ? b : (asp_bits)0x7ff80000u);
}

/* Hashes a single result, and sees to it that the batch gave the same bits. */
static void same(uint64_t *h, asp_real single, asp_real from_batch)
{
    hash(h, single);
    if (memcmp(&single, &from_batch, sizeof single) != 0
        && !(single != single && from_batch != from_batch))
        mismatches++;
}

typedef struct arrays {
    asp_real ix[COUNT], iy[COUNT], iz[COUNT], ox[COUNT], oy[COUNT], oz[COUNT], mx[COUNT],
             my[COUNT], mz[COUNT], u1[COUNT], u2[COUNT], a[COUNT], b[COUNT], c[COUNT], d[COUNT],
             e[COUNT], f[COUNT], g[COUNT];
} arrays;
static arrays store;

static asp_v3 ASP_NAME(vector)(const asp_real *x, const asp_real *y, const asp_real *z, size_t i)
{
    return (asp_v3){ x[i], y[i], z[i] };
}
#define WI ASP_NAME(vector)(store.ix, store.iy, store.iz, i)
#define WO ASP_NAME(vector)(store.ox, store.oy, store.oz, i)
#define M ASP_NAME(vector)(store.mx, store.my, store.mz, i)
#define EACH for (i = 0; i < COUNT; i++)

static void materials(const MATERIAL *mat, uint64_t *h, CV3 wi, CV3 wo, V3 out, VRGB colour)
{
    size_t i;
    CALL_N(eval)(mat, COUNT, wi, wo, colour);
    EACH {
        asp_c3 f = CALL(eval)(mat, WI, WO);
        same(&h[Q_EVAL], f.r, store.d[i]);
        same(&h[Q_EVAL], f.g, store.e[i]);
        same(&h[Q_EVAL], f.b, store.f[i]);
    }
    CALL_N(eval_cos)(mat, COUNT, wi, wo, colour);
    EACH
        same(&h[Q_EVAL_COS], CALL(eval_cos)(mat, WI, WO).g, store.e[i]);
    CALL_N(pdf)(mat, COUNT, wi, wo, store.g);
    EACH
        same(&h[Q_PDF], CALL(pdf)(mat, WI, WO), store.g[i]);
    CALL_N(sample)(mat, COUNT, wi, store.u1, store.u2, out, store.g, colour);
    EACH {
        SAMPLE s = CALL(sample)(mat, WI, store.u1[i], store.u2[i]);
        same(&h[Q_SAMPLE], s.wo.x, store.a[i]);
        same(&h[Q_SAMPLE], s.wo.y, store.b[i]);
        same(&h[Q_SAMPLE], s.wo.z, store.c[i]);
        same(&h[Q_SAMPLE], s.pdf, store.g[i]);
        same(&h[Q_SAMPLE], s.weight.r, store.d[i]);
        same(&h[Q_SAMPLE], s.weight.g, store.e[i]);
        same(&h[Q_SAMPLE], s.weight.b, store.f[i]);
    }
}

/* Each from a stream of its own, which goes as far as with single calls. */
static void walks(const MATERIAL *mat, uint64_t *h, CV3 wi, CV3 wo, V3 out, VRGB colour)
{
    static uint64_t batch[COUNT], single[COUNT];
    size_t i;
    EACH
        batch[i] = single[i] = (uint64_t)i << 32;
    CALL_N(walk_eval_cos)(mat, COUNT, wi, wo, next_of, batch, sizeof *batch, colour);
    EACH {
        asp_c3 f = CALL(walk_eval_cos)(mat, WI, WO, next_of, &single[i]);
        same(&h[Q_WALK_EVAL], f.r, store.d[i]);
        same(&h[Q_WALK_EVAL], f.g, store.e[i]);
        same(&h[Q_WALK_EVAL], f.b, store.f[i]);
    }
    CALL_N(walk_sample)(mat, COUNT, wi, next_of, batch, sizeof *batch, out, store.g, colour);
    EACH {
        SAMPLE s = CALL(walk_sample)(mat, WI, next_of, &single[i]);
        same(&h[Q_WALK_SAMPLE], s.wo.x, store.a[i]);
        same(&h[Q_WALK_SAMPLE], s.wo.y, store.b[i]);
        same(&h[Q_WALK_SAMPLE], s.wo.z, store.c[i]);
        same(&h[Q_WALK_SAMPLE], s.pdf, store.g[i]);
        same(&h[Q_WALK_SAMPLE], s.weight.g, store.e[i]);
        mismatches += batch[i] != single[i];
    }
    CALL_N(walk_pdf)(mat, COUNT, wi, wo, store.g);
    EACH
        same(&h[Q_WALK_PDF], CALL(walk_pdf)(mat, WI, WO), store.g[i]);
}

static void all(const asp_shape *k, const asp_ndf *ndf, uint64_t *h)
{
    static const asp_rgb eta = { 0.17, 0.39, 1.45 }, kappa = { 3.5, 2.4, 1.9 };
    static const asp_rgb diffuse = { 0.4, 0.2, 0.05 }, specular = { 1, 0.9, 0.8 };
    asp_material wide;
    MATERIAL mat;
    CV3 wi, wo, m;
    V3 out;
    VRGB colour;
    size_t i;
    int mask, q;
    wi.x = store.ix; wi.y = store.iy; wi.z = store.iz;
    wo.x = store.ox; wo.y = store.oy; wo.z = store.oz;
    m.x = store.mx; m.y = store.my; m.z = store.mz;
    out.x = store.a; out.y = store.b; out.z = store.c;
    colour.r = store.d; colour.g = store.e; colour.b = store.f;
    EACH {
        asp_vec3 w = direction(), v = direction();
        store.u1[i] = (asp_real)(i % 50 == 0 ? 0 : i % 51 == 0 ? 1 - 0x1p-24 : uniform());
        store.u2[i] = (asp_real)uniform();
        store.ix[i] = (asp_real)w.x;
        store.iy[i] = (asp_real)w.y;
        store.iz[i] = (asp_real)(i % 5 ? fabs(w.z) : w.z);
        store.ox[i] = (asp_real)v.x;
        store.oy[i] = (asp_real)v.y;
        store.oz[i] = (asp_real)(i % 7 ? fabs(v.z) : i % 2 ? v.z : 0);
    }
    CALL_N(sample_normal)(k, COUNT, store.u1, store.u2, out);
    EACH {
        asp_v3 s = CALL(sample_normal)(k, store.u1[i], store.u2[i]);
        same(&h[Q_NORMAL], s.x, store.a[i]);
        same(&h[Q_NORMAL], s.y, store.b[i]);
        same(&h[Q_NORMAL], s.z, store.c[i]);
        store.mx[i] = s.x;
        store.my[i] = s.y;
        store.mz[i] = s.z;
        if (i % 3 == 0) { /* what shines, so that eval is not all tails */
            asp_real c = 2 * (store.ix[i] * s.x + store.iy[i] * s.y + store.iz[i] * s.z);
            store.ox[i] = c * s.x - store.ix[i];
            store.oy[i] = c * s.y - store.iy[i];
            store.oz[i] = c * s.z - store.iz[i];
        }
    }
    CALL_N(sample_visible)(k, COUNT, wi, store.u1, store.u2, out);
    EACH {
        asp_v3 s = CALL(sample_visible)(k, WI, store.u1[i], store.u2[i]);
        same(&h[Q_VISIBLE], s.x, store.a[i]);
        same(&h[Q_VISIBLE], s.y, store.b[i]);
        same(&h[Q_VISIBLE], s.z, store.c[i]);
    }
    store.ix[17] = store.oy[40] = store.mz[63] = store.u1[101] = (asp_real)NAN;
    CALL_N(D)(k, COUNT, m, store.a);
    EACH same(&h[Q_D], CALL(D)(k, M), store.a[i]);
    CALL_N(P22)(k, COUNT, store.ox, store.oy, store.a);
    EACH same(&h[Q_P22], CALL(P22)(k, store.ox[i], store.oy[i]), store.a[i]);
    CALL_N(sigma)(k, COUNT, wi, store.a);
    EACH same(&h[Q_SIGMA], CALL(sigma)(k, WI), store.a[i]);
    CALL_N(pdf_normal)(k, COUNT, m, store.a);
    EACH same(&h[Q_PDF_NORMAL], CALL(pdf_normal)(k, M), store.a[i]);
    CALL_N(pdf_visible)(k, COUNT, wi, m, store.a);
    EACH same(&h[Q_PDF_VISIBLE], CALL(pdf_visible)(k, WI, M), store.a[i]);
    for (q = 0; q < 6; q++) {
        mask = q % 3 + (q > 2 ? ASP_MASK_WALL : 0);
        CALL_N(G1)(k, COUNT, wo, mask, store.a);
        EACH same(&h[Q_G1], CALL(G1)(k, WO, mask), store.a[i]);
        CALL_N(lambda)(k, COUNT, wo, mask, store.a);
        EACH same(&h[Q_LAMBDA], CALL(lambda)(k, WO, mask), store.a[i]);
        CALL_N(G2)(k, COUNT, wi, wo, m, mask, store.a);
        EACH same(&h[Q_G2], CALL(G2)(k, WI, WO, M, mask), store.a[i]);
    }
    EACH {
        asp_real c = store.u2[i], x = store.iz[i];
        hash(&h[Q_FRESNEL], CALL(fresnel_dielectric)(c, (asp_real)1.5));
        hash(&h[Q_FRESNEL], CALL(fresnel_dielectric)(c, (asp_real)0.7));
        hash(&h[Q_FRESNEL], CALL(fresnel_conductor)(x, (asp_real)0.2, (asp_real)3.9));
        hash(&h[Q_FRESNEL], CALL(fresnel_schlick)(c, (asp_real)0.04));
        hash(&h[Q_FRESNEL], CALL(fresnel_f82)(c, (asp_real)0.9, (asp_real)0.8));
    }
    for (q = 0; q < 4; q++) {
        wide = q == 0 ? asp_mirror(ndf, ASP_MASK_UNCORRELATED | ASP_MASK_WALL)
             : q == 1 ? asp_conductor(ndf, eta, kappa, ASP_MASK_CORRELATED)
             : q == 2 ? asp_lambert_specular(ndf, diffuse, specular, 1.5, ASP_MASK_V_CAVITY)
                      : asp_conductor(ndf, eta, kappa, ASP_MASK_V_CAVITY);
#if ASP_PRECISION == 64
        mat = wide;
#else
        mat = asp_material_narrow(&wide);
#endif
        materials(&mat, h, wi, wo, out, colour);
        if (q < 2)
            walks(&mat, h, wi, wo, out, colour);
    }
}

static asp_v3 some_direction(int i)
{
    asp_vec3 w = direction();
    asp_v3 v;
    v.x = (asp_real)w.x;
    v.y = (asp_real)w.y;
    v.z = (asp_real)(i % 3 ? fabs(w.z) : w.z);
    return v;
}

static void hash_sample(uint64_t *h, SAMPLE s)
{
    hash(h, s.wo.x);
    hash(h, s.wo.y);
    hash(h, s.wo.z);
    hash(h, s.pdf);
    hash(h, s.weight.r);
    hash(h, s.weight.g);
    hash(h, s.weight.b);
}

/* Random directions, and those that samples lead to, so that refracted pairs are not all dark. */
static void model(const MATERIAL *mat, uint64_t *h)
{
    int i;
    for (i = 0; i < 150; i++) {
        asp_v3 wi = some_direction(i), wo = some_direction(i + 1);
        asp_real u1 = (asp_real)uniform(), u2 = (asp_real)uniform(), u3 = (asp_real)uniform();
        SAMPLE s = CALL(sample_lobe)(mat, wi, u1, u2, u3);
        asp_c3 f;
        hash_sample(&h[Q_MODEL_SAMPLE], s);
        hash_sample(&h[Q_MODEL_SAMPLE], CALL(sample)(mat, wi, u1, u2));
        wo = i % 2 ? s.wo : wo;
        f = CALL(eval)(mat, wi, wo);
        hash(&h[Q_MODEL_EVAL], f.r);
        hash(&h[Q_MODEL_EVAL], f.g);
        hash(&h[Q_MODEL_EVAL], f.b);
        hash(&h[Q_MODEL_EVAL], CALL(eval_cos)(mat, wi, wo).g);
        hash(&h[Q_MODEL_PDF], CALL(pdf)(mat, wi, wo));
        hash_sample(&h[Q_BOUNDED], CALL(sample_bounded)(mat, wi, u1, u2));
        hash(&h[Q_BOUNDED], CALL(pdf_bounded)(mat, wi, wo));
        s = CALL(walk_sample)(mat, wi, next_uniform, NULL);
        hash_sample(&h[Q_WALK_SAMPLE], s);
        f = CALL(walk_eval_cos)(mat, wi, wo, next_uniform, NULL);
        hash(&h[Q_WALK_EVAL], f.r);
        hash(&h[Q_WALK_EVAL], f.g);
        hash(&h[Q_WALK_EVAL], f.b);
        hash(&h[Q_WALK_PDF], CALL(walk_pdf)(mat, wi, wo));
    }
}

#undef hash
#undef all
#undef walks
#undef same
#undef arrays
#undef store
#undef materials
#undef model
#undef hash_sample
#undef some_direction
#undef WI
#undef WO
#undef M
#undef EACH
#endif
