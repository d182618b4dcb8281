/* test_batch.c - batches and walks over arrays give element by element what single calls give, in place too
 *
 * Read three times: this head, then the body in each precision. */
#ifndef REAL
#include "asperity.h"
#include "splitmix.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { N = 3001 };                     /* blocks and a rest */

static int passed, failed;
static uint64_t state = 1;

static double uniform(void) { return next(&state); }

#define REAL double
#define NAME(x) x
#define TEST(x) x##_64
#define MATERIAL asp_material
#define SAMPLE asp_bsdf_sample
#define VEC3 asp_vec3
#define IN asp_cvec3s
#define OUT asp_vec3s
#define RGB asp_rgbs
#define ONE asp_rgb
#define BATCH(x) x##_n
#include "test_batch.c"
#define REAL float
#define NAME(x) x##f
#define TEST(x) x##_32
#define MATERIAL asp_materialf
#define SAMPLE asp_bsdf_samplef
#define VEC3 asp_vec3f
#define IN asp_cvec3sf
#define OUT asp_vec3sf
#define RGB asp_rgbsf
#define ONE asp_rgbf
#define BATCH(x) x##_nf
#include "test_batch.c"

int main(void)
{
    static const char *const specs[] = {
        "dielectric:eta=1.5,ndf=(ggx:alpha_x=0.3,alpha_y=0.1)",
        "dielectric:eta=0.7,transport=importance,ndf=(beckmann:alpha=0.8)",
        "dielectric:eta=1.33,ndf=(student_t:alpha=0.5,gamma=2,mean_x=0.3)",
        "dielectric:eta=1.5,thin=1,ndf=(ggx)",
        "conductor:metal=Au,ndf=(ggx:alpha_x=0.7,alpha_y=0.2,mean_x=0.5)",
        "conductor:eta=1.5/1.4/1.2,k=0,ndf=(ggx:alpha=0.5)",
        "conductor:f0=0.9,tint=0.8,ndf=(student_t:alpha=0.5)",
        "lambert_specular:diffuse=0.2/0.1/0.05,specular=1,eta=1.5,ndf=(ggx:alpha=0.2)",
        "conductor:metal=Cu,ndf=(abc:alpha=0.5)",
        "conductor:f0=1,ndf=(student_t:alpha=1,gamma=1.9)",
        "rough_diffuse:albedo=0.8/0.5/0.2,ndf=(ggx:alpha=0.7)",
        "compensated:metal=Au,ndf=(beckmann:alpha=0.8)"
    };
    size_t i;
    for (i = 0; i < sizeof specs / sizeof *specs; i++) {
        asp_material mat;
        asp_materialf narrow;
        asp_error err;
        if (asp_material_parse(NULL, specs[i], &mat, &err)) {
            printf("FAILED: %s: %s\n", specs[i], err.reason);
            failed++;
            continue;
        }
        narrow = asp_material_narrow(&mat);
        check_64(specs[i], &mat);
        check_32(specs[i], &narrow);
        check_values_64(specs[i], &mat);
        check_values_32(specs[i], &narrow);
        walk_64(specs[i], &mat);
        walk_32(specs[i], &narrow);
    }
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}

#else
/* Directions all around, among them vertical, grazing and bad ones. */
static void TEST(fill)(REAL wi[3][N], REAL u[2][N])
{
    int i, k;
    for (i = 0; i < N; i++) {
        double z = 2 * uniform() - 1, phi = 6.283185307179586 * uniform(), r = sqrt(1 - z * z);
        wi[0][i] = (REAL)(i % 97 ? r * cos(phi) : 0);
        wi[1][i] = (REAL)(i % 97 ? r * sin(phi) : 0);
        wi[2][i] = (REAL)(i % 97 ? i % 101 ? i % 107 ? z : 1e-6 * z : 0 : i & 1 ? 1 : -1);
        if (i % 103 == 0)
            wi[0][i] = NAN;
        for (k = 0; k < 2; k++)
            u[k][i] = (REAL)(i % (109 + k) ? 0.99999 * uniform() : 0);
    }
}

static int TEST(same)(REAL a, REAL b) { return (a != a && b != b) || !memcmp(&a, &b, sizeof a); }

static void TEST(check)(const char *spec, const MATERIAL *mat)
{
    static REAL wi[3][N], u[2][N], o[7][N];
    IN in = { wi[0], wi[1], wi[2] };
    OUT out = { o[0], o[1], o[2] }, back = { wi[0], wi[1], wi[2] };
    RGB rgb = { o[4], o[5], o[6] }, weight = { u[0], u[1], o[6] };
    int i, k, differ = 0, moved = 0, lit = 0;
    TEST(fill)(wi, u);
    BATCH(asp_sample)(mat, N, in, u[0], u[1], out, o[3], rgb);
    for (i = 0; i < N; i++) {
        SAMPLE s = NAME(asp_sample)(mat, (VEC3){ wi[0][i], wi[1][i], wi[2][i] }, u[0][i], u[1][i]);
        REAL one[7] = { s.wo.x, s.wo.y, s.wo.z, s.pdf, s.weight.r, s.weight.g, s.weight.b };
        for (k = 0; k < 7; k++)
            differ += !TEST(same)(one[k], o[k][i]);
        lit += s.weight.r > 0;
    }
    BATCH(asp_sample)(mat, N, in, u[0], u[1], back, o[3], weight);
    for (i = 0; i < N; i++) {
        for (k = 0; k < 3; k++)
            moved += !TEST(same)(wi[k][i], o[k][i]);
        moved += !TEST(same)(u[0][i], o[4][i]) || !TEST(same)(u[1][i], o[5][i]);
    }
    printf("%s  float%d %s: %d samples with light; %d numbers differ, %d in place\n",
           differ || moved || lit < N / 4 ? "FAILED" : "ok    ", (int)(8 * sizeof(REAL)), spec, lit, differ, moved);
    if (differ || moved || lit < N / 4)
        failed++;
    else
        passed++;
}

/* eval, eval_cos and pdf of pairs, every third of which the material has made. */
static void TEST(check_values)(const char *spec, const MATERIAL *mat)
{
    static REAL wi[3][N], wo[3][N], u[2][N], o[7][N];
    IN in = { wi[0], wi[1], wi[2] }, to = { wo[0], wo[1], wo[2] };
    RGB f = { o[0], o[1], o[2] }, f_cos = { o[3], o[4], o[5] }, back = { wi[0], wi[1], wi[2] };
    int i, k, differ = 0, moved = 0, lit = 0, through = 0;
    TEST(fill)(wo, u);
    TEST(fill)(wi, u);
    for (i = 0; i < N; i += 3) {
        SAMPLE s = NAME(asp_sample)(mat, (VEC3){ wi[0][i], wi[1][i], wi[2][i] }, u[0][i], u[1][i]);
        wo[0][i] = s.wo.x;
        wo[1][i] = s.wo.y;
        wo[2][i] = s.wo.z;
    }
    BATCH(asp_eval)(mat, N, in, to, f);
    BATCH(asp_eval_cos)(mat, N, in, to, f_cos);
    BATCH(asp_pdf)(mat, N, in, to, o[6]);
    for (i = 0; i < N; i++) {
        VEC3 a = { wi[0][i], wi[1][i], wi[2][i] }, b = { wo[0][i], wo[1][i], wo[2][i] };
        ONE e = NAME(asp_eval)(mat, a, b), c = NAME(asp_eval_cos)(mat, a, b);
        REAL one[7] = { e.r, e.g, e.b, c.r, c.g, c.b, NAME(asp_pdf)(mat, a, b) };
        for (k = 0; k < 7; k++)
            differ += !TEST(same)(one[k], o[k][i]);
        lit += e.r > 0;
        through += e.r > 0 && a.z * b.z < 0;
    }
    BATCH(asp_eval)(mat, N, in, to, back);
    for (i = 0; i < N; i++)
        for (k = 0; k < 3; k++)
            moved += !TEST(same)(wi[k][i], o[k][i]);
    printf("%s  float%d %s: %d pairs with light, %d of them through it; %d numbers differ, %d in place\n",
           differ || moved || lit < N / 10 ? "FAILED" : "ok    ", (int)(8 * sizeof(REAL)), spec, lit, through, differ,
           moved);
    if (differ || moved || lit < N / 10)
        failed++;
    else
        passed++;
}

/* Streams of their own, which must be as far as after single calls; the densities of pairs, and in place. */
static void TEST(walk)(const char *spec, const MATERIAL *mat)
{
    static REAL wi[3][N], wo[3][N], u[2][N], o[8][N], f[3][N];
    static uint64_t streams[3][N];
    IN in = { wi[0], wi[1], wi[2] }, to = { wo[0], wo[1], wo[2] };
    OUT out = { o[0], o[1], o[2] }, back = { wi[0], wi[1], wi[2] };
    RGB rgb = { o[4], o[5], o[6] }, eval = { f[0], f[1], f[2] };
    RGB over = { wo[0], wo[1], wo[2] };
    int i, k, differ = 0, late = 0, moved = 0, lit = 0;
    TEST(fill)(wo, u);
    TEST(fill)(wi, u);
    for (i = 0; i < N; i++)
        streams[0][i] = streams[1][i] = streams[2][i] = (uint64_t)i * 65537;
    BATCH(asp_walk_sample)(mat, N, in, next, streams[0], sizeof **streams, out, o[3], rgb);
    BATCH(asp_walk_eval_cos)(mat, N, in, to, next, streams[0], sizeof **streams, eval);
    BATCH(asp_walk_pdf)(mat, N, in, to, o[7]);
    for (i = 0; i < N; i++) {
        VEC3 from = { wi[0][i], wi[1][i], wi[2][i] }, toward = { wo[0][i], wo[1][i], wo[2][i] };
        SAMPLE s = NAME(asp_walk_sample)(mat, from, next, &streams[1][i]);
        ONE x = NAME(asp_walk_eval_cos)(mat, from, toward, next, &streams[1][i]);
        REAL one[8] = { s.wo.x, s.wo.y, s.wo.z, s.pdf, s.weight.r, s.weight.g, s.weight.b,
                        NAME(asp_walk_pdf)(mat, from, toward) };
        for (k = 0; k < 8; k++)
            differ += !TEST(same)(one[k], o[k][i]);
        differ += !TEST(same)(x.r, f[0][i]) + !TEST(same)(x.g, f[1][i]) + !TEST(same)(x.b, f[2][i]);
        late += streams[0][i] != streams[1][i];
        lit += s.weight.r > 0 && (x.r > 0 || toward.z <= 0 || from.z <= 0);
    }
    BATCH(asp_walk_sample)(mat, N, in, next, streams[2], sizeof **streams, back, o[3], rgb);
    for (i = 0; i < N; i++)
        for (k = 0; k < 3; k++) {
            moved += !TEST(same)(wi[k][i], o[k][i]);
            wi[k][i] = (REAL)0.57735;
        }
    BATCH(asp_walk_eval_cos)(mat, N, in, to, next, streams[2], sizeof **streams, eval);
    for (i = 0; i < N; i++)
        streams[2][i] = streams[1][i];
    BATCH(asp_walk_eval_cos)(mat, N, in, to, next, streams[1], sizeof **streams, eval);
    BATCH(asp_walk_eval_cos)(mat, N, in, to, next, streams[2], sizeof **streams, over);
    for (i = 0; i < N; i++)
        for (k = 0; k < 3; k++)
            moved += !TEST(same)(wo[k][i], f[k][i]);
    k = strstr(spec, "thin") || !strncmp(spec, "lambert", 7) || !strncmp(spec, "compensated", 11); /* no walks there */
    k = differ || late || moved || (k ? lit != 0 : lit < N / 4);
    printf("%s  float%d %s: %d walks with light; %d numbers differ, %d streams, %d in place\n", k ? "FAILED" : "ok    ",
           (int)(8 * sizeof(REAL)), spec, lit, differ, late, moved);
    if (k)
        failed++;
    else
        passed++;
}

#undef REAL
#undef NAME
#undef ONE
#undef TEST
#undef MATERIAL
#undef SAMPLE
#undef VEC3
#undef IN
#undef OUT
#undef RGB
#undef BATCH
#endif
