/* test_sggx.c - microflakes: the laws of SGGX, and that the Ellipsoid NDF is its upper half
 *
 * Reference: D by S^-1 written out with cofactors, sigma and the area by quadrature over the sphere, the
 * sampler's law by chi-square in cells of the sphere. */
#include "asperity_study.h"
#include "visible_test.h"

#define POLAR 24
#define AROUND 24

static const struct matrix { const char *name; double A[9]; } matrices[] = {
    { "sphere", { 1, 0, 0, 0, 1, 0, 0, 0, 1 } },
    { "leaf", { 0.3, 0, 0, 0, 0.3, 0, 0, 0, 1 } },
    { "fibre", { 1, 0, 0, 0, 1, 0, 0, 0, 0.2 } },
    { "skewed", { 0.5, 0.1, 0.05, -0.02, 0.4, 0, 0.3, -0.5, 1 } },
    { "det A < 0, large", { -4, 1, 0, 0, 7, 2, 1, 2, 9 } },
};
#define MATRICES (sizeof matrices / sizeof *matrices)

static void below(const char *name, const char *what, double found, double bound)
{
    char line[400];
    snprintf(line, sizeof line, "%s: %s: %.3g, bound %g", name, what, found, bound);
    printf("%-4s %s\n", found <= bound ? "ok" : "FAIL", line);
    say(found <= bound, line);
}

static double dot(asp_vec3 a, asp_vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

static asp_vec3 direction(double z, double phi)
{
    double s = sqrt(fmax(0, (1 - z) * (1 + z)));
    asp_vec3 v = { s * cos(phi), s * sin(phi), z };
    return v;
}

static asp_vec3 anywhere(void) { return direction(2 * uniform(NULL) - 1, 2 * pi_ * uniform(NULL)); }

static void gram(const double A[9], double S[9])
{
    int i, j;
    for (i = 0; i < 3; i++)
        for (j = 0; j < 3; j++)
            S[3 * i + j] = A[i] * A[j] + A[3 + i] * A[3 + j] + A[6 + i] * A[6 + j];
}

static double quadratic(const double S[9], asp_vec3 v)
{
    return v.x * (S[0] * v.x + S[1] * v.y + S[2] * v.z) + v.y * (S[3] * v.x + S[4] * v.y + S[5] * v.z)
         + v.z * (S[6] * v.x + S[7] * v.y + S[8] * v.z);
}

/* Heitz et al. 2015, as printed: 1/(pi sqrt|S| (m^T S^-1 m)^2). */
static double printed_density(const double S[9], asp_vec3 m)
{
    double C[9] = { S[4] * S[8] - S[5] * S[7], S[2] * S[7] - S[1] * S[8], S[1] * S[5] - S[2] * S[4],
                    S[5] * S[6] - S[3] * S[8], S[0] * S[8] - S[2] * S[6], S[2] * S[3] - S[0] * S[5],
                    S[3] * S[7] - S[4] * S[6], S[1] * S[6] - S[0] * S[7], S[0] * S[4] - S[1] * S[3] };
    double det = S[0] * C[0] + S[1] * C[3] + S[2] * C[6], q = quadratic(C, m) / det;
    return 1 / (pi_ * sqrt(det) * q * q);
}

/* int over the sphere: of D, and of max(0, w.m) D. Plain midpoints in (z, phi) of a frame around w, of
 * which the kink is one of the grid's lines. */
static void integrals(const asp_sggx *k, asp_vec3 w, double *area, double *seen)
{
    const int n = 400;
    asp_vec3 any = { fabs(w.x) < 0.5, fabs(w.x) >= 0.5, 0 }, a, b;
    double l;
    int i, j;
    a.x = w.y * any.z - w.z * any.y;
    a.y = w.z * any.x - w.x * any.z;
    a.z = w.x * any.y - w.y * any.x;
    l = sqrt(dot(a, a));
    a.x /= l; a.y /= l; a.z /= l;
    b.x = w.y * a.z - w.z * a.y;
    b.y = w.z * a.x - w.x * a.z;
    b.z = w.x * a.y - w.y * a.x;
    *area = *seen = 0;
    for (i = 0; i < n; i++)
        for (j = 0; j < n; j++) {
            /* theta in equal steps, by midpoints: sin and cos vanish at the ends as they should */
            double t = pi_ * (i + 0.5) / n, z = cos(t);
            asp_vec3 h = direction(z, 2 * pi_ * (j + 0.5) / n), m;
            double d;
            m.x = h.x * a.x + h.y * b.x + h.z * w.x;
            m.y = h.x * a.y + h.y * b.y + h.z * w.y;
            m.z = h.x * a.z + h.y * b.z + h.z * w.z;
            d = asp_sggx_D(k, m) * sin(t) * (pi_ / n) * (2 * pi_ / n);
            *area += d;
            *seen += z > 0 ? z * d : 0;
        }
}

static void check_values(const struct matrix *a, const asp_sggx *k)
{
    double S[9], back[9], d = 0, s = 0, gap = 0, area, seen, project = 0, mean = 0, areas = 0, bound = 0;
    double f = 0, fs = 0, fp = 0;
    asp_sggxf kf = asp_sggx_narrow(k);
    asp_sggx other;
    int i;
    gram(a->A, S);
    asp_sggx_to_gram(k, back);
    for (i = 0; i < 9; i++)
        gap = fmax(gap, fabs(back[i] - S[i]) / S[8]);
    below(a->name, "S = A^T A", gap, 1e-13);
    say(asp_sggx_from_gram(back, &other, NULL) == ASP_OK, "and back from S");
    for (i = 0; i < 20000; i++) {
        asp_vec3 m = anywhere(), w = anywhere();
        asp_vec3f mf = { (float)m.x, (float)m.y, (float)m.z }, wf = { (float)w.x, (float)w.y, (float)w.z };
        double D = asp_sggx_D(k, m), sigma = asp_sggx_sigma(k, w), p;
        d = fmax(d, fabs(D / printed_density(S, m) - 1));
        d = fmax(d, fabs(asp_sggx_D(&other, m) / D - 1));
        s = fmax(s, fabs(sigma / sqrt(quadratic(S, w)) - 1));
        f = fmax(f, fabs((double)asp_sggx_Df(&kf, mf) / D - 1));
        fs = fmax(fs, fabs((double)asp_sggx_sigmaf(&kf, wf) / sigma - 1));
        p = asp_sggx_pdf_visible(k, w, m);
        gap = fmax(0, dot(w, m)) * D / sigma;
        bound = fmax(bound, fabs(p - gap) / (gap + 1e-300) * (gap > 0));
        if (dot(w, m) > 0.01)
            fp = fmax(fp, fabs((double)asp_sggx_pdf_visiblef(&kf, wf, mf) / p - 1));
        mean += sigma;
    }
    below(a->name, "D as printed, relative", d, 1e-11);
    below(a->name, "sigma = sqrt(w S w), relative", s, 1e-12);
    below(a->name, "pdf_visible = (w.m)+ D/sigma", bound, 1e-14);
    below(a->name, "float32 D", f, 3e-6);
    below(a->name, "float32 sigma", fs, 1e-6);
    below(a->name, "float32 pdf_visible, w.m > 0.01", fp, 2e-5);
    mean /= 20000;
    for (i = 0; i < 4; i++) {
        asp_vec3 w = i ? anywhere() : direction(1, 0);
        integrals(k, w, &area, &seen);
        project = fmax(project, fabs(seen / asp_sggx_sigma(k, w) - 1));
        areas = fmax(areas, fabs(area / (4 * mean) - 1));
    }
    below(a->name, "integral of (w.m)+ D = sigma", project, 2e-4);
    below(a->name, "integral of D = 4 mean sigma (Monte Carlo)", areas, 0.02);
}

/* The Ellipsoid NDF of the same A. */
static void check_relation(const struct matrix *a, const asp_sggx *k)
{
    asp_vec3 n = { 0, 0, 1 };
    double ground = asp_sggx_sigma(k, n), d = 0, s = 0;
    asp_map map;
    asp_ndf ndf;
    int i;
    if (asp_map_from_matrix(a->A, &map, NULL)
        || asp_ndf_make(asp_find_model(NULL, "ellipsoid"), &map, NULL, &ndf, NULL)) {
        say(0, "an ellipsoid of the same A");
        return;
    }
    for (i = 0; i < 20000; i++) {
        asp_vec3 m = anywhere(), w = anywhere(), below_w = { -w.x, -w.y, -w.z };
        m.z = fabs(m.z);
        d = fmax(d, fabs(asp_D(&ndf, m) * ground / asp_sggx_D(k, m) - 1));
        s = fmax(s, fabs((asp_sigma(&ndf, w) + asp_sigma(&ndf, below_w)) * ground / asp_sggx_sigma(k, w) - 1));
    }
    below(a->name, "D_ellipsoid = D/sigma(n) above", d, 1e-11);
    below(a->name, "both of sigma_ellipsoid = sigma/sigma(n)", s, 1e-12);
}

/* Cells in the frame of the normal: POLAR equal steps of z, AROUND of phi; expected by 12 x 12 midpoints. */
static void check_sampler(const struct matrix *a, const asp_sggx *k, size_t samples)
{
    static double share[POLAR * AROUND], count[2][POLAR * AROUND];
    asp_sggxf kf = asp_sggx_narrow(k);
    int view, i, j, x, y, p;
    for (view = 0; view < 4; view++) {
        asp_vec3 w = view ? anywhere() : direction(-1, 0);
        asp_vec3f wf = { (float)w.x, (float)w.y, (float)w.z };
        double total = 0, hidden = 0;
        char what[200];
        size_t c;
        memset(count, 0, sizeof count);
        for (i = 0; i < POLAR; i++)
            for (j = 0; j < AROUND; j++) {
                double sum = 0;
                for (x = 0; x < 24; x++)
                    for (y = 0; y < 24; y++)
                        sum += asp_sggx_pdf_visible(k, w, direction(-1 + 2 * (i + (x + 0.5) / 24) / POLAR,
                                                                    2 * pi_ * (j + (y + 0.5) / 24) / AROUND));
                share[i * AROUND + j] = sum / 576 * (2.0 / POLAR) * (2 * pi_ / AROUND);
                total += share[i * AROUND + j];
            }
        snprintf(what, sizeof what, "view %d: pdf_visible integrates to 1", view);
        below(a->name, what, fabs(total - 1), 2e-3);
        for (c = 0; c < samples; c++) {
            double u1 = uniform(NULL), u2 = uniform(NULL);
            asp_vec3 m[2];
            asp_vec3f f = asp_sggx_sample_visiblef(&kf, wf, (float)(u1 < 0.9999999 ? u1 : 0.5),
                                                   (float)(u2 < 0.9999999 ? u2 : 0.5));
            m[0] = asp_sggx_sample_visible(k, w, u1, u2);
            m[1].x = f.x; m[1].y = f.y; m[1].z = f.z;
            hidden = fmax(hidden, -dot(w, m[0]));
            hidden = fmax(hidden, fabs(dot(m[0], m[0]) - 1));
            for (p = 0; p < 2; p++) {
                double phi = atan2(m[p].y, m[p].x);
                i = (int)((m[p].z + 1) / 2 * POLAR);
                j = (int)((phi < 0 ? phi + 2 * pi_ : phi) / (2 * pi_) * AROUND);
                count[p][(i < POLAR ? i : POLAR - 1) * AROUND + (j < AROUND ? j : AROUND - 1)] += 1;
            }
        }
        snprintf(what, sizeof what, "view %d: normals are unit and seen", view);
        below(a->name, what, hidden, 1e-14);
        for (p = 0; p < 2; p++) {
            double chi2 = 0, rest = 0, rest_share = 0, probability;
            int dof = -1;
            for (i = 0; i < POLAR * AROUND; i++) {
                double want = share[i] / total * (double)samples;
                if (want < 10) {
                    rest += count[p][i];
                    rest_share += want;
                    continue;
                }
                chi2 += (count[p][i] - want) * (count[p][i] - want) / want;
                dof++;
            }
            if (rest_share > 1) {
                chi2 += (rest - rest_share) * (rest - rest_share) / rest_share;
                dof++;
            }
            probability = chi_probability(chi2, dof);
            snprintf(what, sizeof what, "%s, view %d, float%d: chi-square", a->name, view, p ? 32 : 64);
            note_p(probability, what);
        }
    }
}

/* Small steps of (u1, u2) make small steps of the normal; u2 is periodic. */
static void check_continuity(const struct matrix *a, const asp_sggx *k)
{
    double jump = 0;
    int i;
    for (i = 0; i < 4000; i++) {
        asp_vec3 w = anywhere(), m, o;
        double u1 = 0.001 + 0.998 * uniform(NULL), u2 = uniform(NULL);
        if (i % 4 == 0)
            u2 = 0;
        m = asp_sggx_sample_visible(k, w, u1, u2);
        o = asp_sggx_sample_visible(k, w, u1 + 1e-9, i % 4 ? u2 + 1e-9 : 1 - 1e-9);
        jump = fmax(jump, sqrt(pow(m.x - o.x, 2) + pow(m.y - o.y, 2) + pow(m.z - o.z, 2)));
    }
    below(a->name, "continuous: a step of 1e-9", jump, 1e-5);
}

/* Loops give the bits of single calls, in place too. */
#define MANY 300
#define DEFINE_BATCHES(NAME, REAL, FLAKES, V3, V3S, CV3S, S, NS)                                          \
    static void NAME(const char *name, const FLAKES *k)                                                   \
    {                                                                                                     \
        static REAL x[MANY], y[MANY], z[MANY], u[MANY], v[MANY], ax[MANY], ay[MANY], az[MANY], out[4][MANY]; \
        const CV3S w = { x, y, z }, m = { ax, ay, az };                                                   \
        const V3S to = { ax, ay, az }, over = { x, y, z };                                                \
        int i, bad = 0;                                                                                   \
        for (i = 0; i < MANY; i++) {                                                                      \
            asp_vec3 d = anywhere();                                                                      \
            x[i] = (REAL)d.x; y[i] = (REAL)d.y; z[i] = (REAL)d.z;                                         \
            u[i] = (REAL)(0.999 * uniform(NULL)); v[i] = (REAL)(0.999 * uniform(NULL));                   \
        }                                                                                                 \
        asp_sggx_sample_visible_##NS(k, MANY, w, u, v, to);                                               \
        asp_sggx_pdf_visible_##NS(k, MANY, w, m, out[0]);                                                 \
        asp_sggx_D_##NS(k, MANY, m, out[1]);                                                              \
        asp_sggx_sigma_##NS(k, MANY, w, out[2]);                                                          \
        for (i = 0; i < MANY; i++) {                                                                      \
            V3 wi = { x[i], y[i], z[i] }, h = asp_sggx_sample_visible##S(k, wi, u[i], v[i]);              \
            bad += h.x != ax[i] || h.y != ay[i] || h.z != az[i];                                          \
            bad += asp_sggx_pdf_visible##S(k, wi, h) != out[0][i] || asp_sggx_D##S(k, h) != out[1][i];    \
            bad += asp_sggx_sigma##S(k, wi) != out[2][i];                                                 \
        }                                                                                                 \
        asp_sggx_sample_visible_##NS(k, MANY, w, u, v, over);                                             \
        for (i = 0; i < MANY; i++)                                                                        \
            bad += x[i] != ax[i] || y[i] != ay[i] || z[i] != az[i];                                       \
        below(name, #NAME ": bits that differ from the single calls'", bad, 0);                           \
    }
DEFINE_BATCHES(batches_64, double, asp_sggx, asp_vec3, asp_vec3s, asp_cvec3s, , n)
DEFINE_BATCHES(batches_32, float, asp_sggxf, asp_vec3f, asp_vec3sf, asp_cvec3sf, f, nf)

static void check_makers(void)
{
    asp_vec3 axis = { 3, -4, 12 }, n = { 3 / 13.0, -4 / 13.0, 12 / 13.0 }, across = { 0.8, 0.6, 0 };
    double S[9] = { 1, 2, 0, 2, 1, 0, 0, 0, 1 }, A[9] = { 1, 2, 3, 2, 4, 6, 0, 0, 1 }, bad[9] = { 0 };
    asp_sggx k = { 7, 0, 0, 0, 0, 0 };
    asp_error err;
    say(asp_sggx_from_axis(axis, 0.25, 2, &k, &err) == ASP_OK, "from an axis");
    below("axis", "sigma along", fabs(asp_sggx_sigma(&k, n) - 0.25), 1e-14);
    below("axis", "sigma across", fabs(asp_sggx_sigma(&k, across) - 2), 1e-14);
    k.a11 = 7;
    say(asp_sggx_from_axis(axis, 0, 2, &k, &err) == ASP_EINVAL && !strcmp(err.name, "along"), "along = 0");
    say(asp_sggx_from_axis(axis, 1, 1e7, &k, &err) == ASP_EINVAL && err.high == 1e6, "across = 1e7");
    axis.x = NAN;
    say(asp_sggx_from_axis(axis, 1, 1, &k, &err) == ASP_EINVAL && !strcmp(err.name, "axis"), "axis of NaN");
    say(asp_sggx_from_gram(S, &k, &err) == ASP_EINVAL, "S is not positive definite");
    S[1] = 0.5;
    say(asp_sggx_from_gram(S, &k, &err) == ASP_EINVAL && strstr(err.reason, "symmetric"), "S is not symmetric");
    say(asp_sggx_from_matrix(A, &k, &err) == ASP_EINVAL, "dependent columns");
    say(asp_sggx_from_matrix(bad, &k, &err) == ASP_EINVAL, "zero");
    say(k.a11 == 7, "nothing is written on failure");
}

int main(void)
{
    size_t samples = sample_count(40000), i;
    for (i = 0; i < MATRICES; i++) {
        asp_sggx k;
        asp_sggxf kf;
        if (asp_sggx_from_matrix(matrices[i].A, &k, NULL) != ASP_OK) {
            say(0, matrices[i].name);
            continue;
        }
        check_values(&matrices[i], &k);
        check_relation(&matrices[i], &k);
        check_sampler(&matrices[i], &k, samples);
        check_continuity(&matrices[i], &k);
        kf = asp_sggx_narrow(&k);
        batches_64(matrices[i].name, &k);
        batches_32(matrices[i].name, &kf);
    }
    check_makers();
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
