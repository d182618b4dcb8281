/* test_walter.c - the Ellipsoid paper's sampler, and its two rejection versions as oracles
 *
 * Section 4 of Walter et al. 2014: version 1 shoots rays through the ellipsoid's bounding sphere, version 2
 * through its own silhouette; version 3 is asp_sample_visible_walter. All of them, and the library's
 * sampler, against the density of eq. 33; and the weights of eqs. 49-52. */
#include "asperity_study.h"
#include "visible_test.h"

#define PILOT 4000

static const struct matrix { const char *name; double A[9]; } matrices[] = {
    { "GGX 0.3", { 0.3, 0, 0, 0, 0.3, 0, 0, 0, 1 } },
    { "anisotropic", { 0.6, 0, 0, 0, 0.1, 0, 0, 0, 1 } },
    { "skewed", { 0.3, 0.1, 0.05, -0.02, 0.2, 0, 0.3, -0.5, 1 } },
    { "det A < 0", { -0.4, 0.1, 0, 0, 0.7, 0.2, 0.1, 0.2, 0.9 } },
    { "rows turned and scaled", { 0, 0, 7, 2.1, 0.2, 1, -0.3, 1.4, 0.5 } },
    { "det A < 0, skewed, scaled", { 0.02, 0.05, 0.1, 0.03, -0.02, 0.08, 0.05, 0.04, -0.02 } },
};
#define MATRICES (sizeof matrices / sizeof *matrices)

static const double views[][2] = { { 0, 0 }, { 35, 1 }, { 75, -2 }, { 89.5, 2.5 }, { 89.5, -0.7 }, { 105, 0.4 } };
#define VIEWS (sizeof views / sizeof *views)

static asp_vec3 apply(const double M[9], asp_vec3 v)
{
    asp_vec3 r = { M[0] * v.x + M[1] * v.y + M[2] * v.z, M[3] * v.x + M[4] * v.y + M[5] * v.z,
                   M[6] * v.x + M[7] * v.y + M[8] * v.z };
    return r;
}

static asp_vec3 apply_transposed(const double M[9], asp_vec3 v)
{
    asp_vec3 r = { M[0] * v.x + M[3] * v.y + M[6] * v.z, M[1] * v.x + M[4] * v.y + M[7] * v.z,
                   M[2] * v.x + M[5] * v.y + M[8] * v.z };
    return r;
}

static double dot(asp_vec3 a, asp_vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

static asp_vec3 unit(asp_vec3 a)
{
    double l = sqrt(dot(a, a));
    asp_vec3 r = { a.x / l, a.y / l, a.z / l };
    return r;
}

static asp_vec3 cross(asp_vec3 a, asp_vec3 b)
{
    asp_vec3 r = { a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x };
    return r;
}

static asp_vec3 sum(double a, asp_vec3 u, double b, asp_vec3 v)
{
    asp_vec3 r = { a * u.x + b * v.x, a * u.y + b * v.y, a * u.z + b * v.z };
    return r;
}

/* A random point of the disk of radius r across e. */
static asp_vec3 disk_point(asp_vec3 e, double r)
{
    asp_vec3 any = { fabs(e.x) < 0.5, fabs(e.x) >= 0.5, 0 }, a = unit(cross(e, any)), b = cross(e, a);
    double l = r * sqrt(uniform(NULL)), t = 2 * pi_ * uniform(NULL);
    return sum(l * cos(t), a, l * sin(t), b);
}

/* Version 1: the ellipsoid p^T S p = 1, rays against psi through the disk of a sphere around it. */
static asp_vec3 version_1(const double A[9], double radius, asp_vec3 psi)
{
    for (;;) {
        asp_vec3 from = disk_point(psi, radius), a = apply(A, from), d = apply(A, psi), m;
        double qa = dot(d, d), qb = dot(a, d), qc = dot(a, a) - 1, disc = qb * qb - qa * qc;
        if (disc < 0)
            continue;
        /* the outermost point along psi, its normal S p */
        m = apply_transposed(A, sum(1, a, (-qb + sqrt(disc)) / qa, d));
        if (m.z >= 0)
            return unit(m);
    }
}

/* Version 2: through the silhouette of the sphere that the ellipsoid becomes. */
static asp_vec3 version_2(const double A[9], asp_vec3 psi)
{
    asp_vec3 e = unit(apply(A, psi));
    for (;;) {
        asp_vec3 p = disk_point(e, 1), m = apply_transposed(A, sum(1, p, sqrt(fmax(0, 1 - dot(p, p))), e));
        if (m.z >= 0)
            return unit(m);
    }
}

/* 1 over the least singular value of A, by inverse iteration on S with Cramer's rule. */
static double bounding_radius(const double A[9])
{
    asp_vec3 r0 = { A[0], A[1], A[2] }, r1 = { A[3], A[4], A[5] }, r2 = { A[6], A[7], A[8] };
    asp_vec3 c0 = cross(r1, r2), c1 = cross(r2, r0), c2 = cross(r0, r1);
    double det = dot(r0, c0), most = 0;
    asp_vec3 v = { 0.3, 0.5, 0.8 };
    int i;
    for (i = 0; i < 300; i++) {
        /* A^-1 has columns c/det; one step by (A^T A)^-1 */
        asp_vec3 t = { dot(c0, v) / det, dot(c1, v) / det, dot(c2, v) / det };
        asp_vec3 w = sum(t.x / det, c0, t.y / det, c1);
        w = sum(1, w, t.z / det, c2);
        most = sqrt(sqrt(dot(w, w)));
        v = unit(w);
    }
    return 1.0001 * most;
}

static void one_view(const struct matrix *a, const asp_ndf *ndf, size_t v, size_t samples)
{
    static const char *const names[4] = { "version 1", "version 2", "version 3", "asp_sample_visible" };
    static double radii[PILOT], tally[4][CELLS];
    double t = views[v][0] * pi_ / 180, radius = bounding_radius(a->A);
    asp_vec3 w = { sin(t) * cos(views[v][1]), sin(t) * sin(views[v][1]), cos(t) };
    int s;
    size_t i;
    char what[300];
    cells k;
    if (!(asp_sigma(ndf, w) > 1e-4))
        return;
    memset(&k, 0, sizeof k);
    k.ndf = ndf;
    for (i = 0; i < PILOT; i++) {
        double phi;
        slope_of(&k, version_2(a->A, w), &radii[i], &phi);
    }
    cells_make(&k, ndf, w, radii, PILOT);
    memset(tally, 0, sizeof tally);
    for (s = 0; s < 4; s++) {
        int bad = 0;
        for (i = 0; i < samples; i++) {
            asp_vec3 m;
            if (s == 0)
                m = version_1(a->A, radius, w);
            else if (s == 1)
                m = version_2(a->A, w);
            else if (s == 2)
                m = asp_sample_visible_walter(a->A, w, uniform(NULL), uniform(NULL));
            else
                m = asp_sample_visible(ndf, w, uniform(NULL), uniform(NULL));
            bad += !(dot(m, w) > -1e-14) || !(m.z >= 0) || !(fabs(dot(m, m) - 1) < 1e-12);
            cells_count(&k, m, tally[s]);
        }
        snprintf(what, sizeof what, "%s, view %g, %s: on the lune", a->name, views[v][0], names[s]);
        say(bad == 0, what);
        snprintf(what, sizeof what, "%s, view %g, %s against eq. 33", a->name, views[v][0], names[s]);
        note_p(chi_share(&k, tally[s], (double)samples), what);
        if (s == 2)
            continue;
        snprintf(what, sizeof what, "%s, view %g, version 3 and %s", a->name, views[v][0], names[s]);
        if (s == 3)
            note_p(chi_two(tally[2], tally[3]), what);
    }
    note_p(chi_two(tally[0], tally[2]), "versions 1 and 3");
    note_p(chi_two(tally[1], tally[2]), "versions 2 and 3");
}

/* Eqs. 47-52: mirror facets, G = G1 G1 with the min. Weight = f cos / p_o <= 1. */
static void check_weights(const struct matrix *a, const asp_ndf *ndf)
{
    double most = 0, differs = 0;
    asp_material mirror = asp_mirror(ndf, ASP_MASK_UNCORRELATED);
    int i;
    for (i = 0; i < 60000; i++) {
        double z = uniform(NULL), s = sqrt(1 - z * z), t = 2 * pi_ * uniform(NULL), pdf, weight, closed;
        asp_vec3 w = { s * cos(t), s * sin(t), z }, m, o;
        m = asp_sample_visible_walter(a->A, w, uniform(NULL), uniform(NULL));
        o = sum(2 * dot(w, m), m, -1, w);
        if (!(o.z > 1e-6) || !(dot(w, m) > 1e-6) || !(z > 1e-6) || !(m.z > 1e-6))
            continue;
        pdf = asp_pdf(&mirror, w, o);
        weight = asp_eval_cos(&mirror, w, o).r / pdf;
        most = fmax(most, weight);
        /* eq. 50: G1 G1 A_l / (A_e |psi.n|), the latter being sigma/cos */
        closed = asp_G1(ndf, w, 0) * asp_G1(ndf, o, 0) * asp_sigma(ndf, w) / z;
        differs = fmax(differs, fabs(weight - closed));
    }
    printf("%-28s largest weight %.17g, against eq. 50 within %.2g\n", a->name, most, differs);
    say(most <= 1 + 1e-12, "no weight exceeds 1");
    say(most > 0.5, "and they are weights");
    say(differs < 1e-10, "weights are those of eq. 50");
}

/* Places of the square: continuous across the diagonals and the axes, its centre, its corners; views along
 * A n, where the frame is undetermined; and the whole rim. */
static void check_places(const struct matrix *a, const asp_ndf *ndf)
{
    static const double places[] = { 0, 0x1p-53, 0.25, 0.5, 0.75, 1 - 0x1p-53 };
    asp_vec3 n = asp_mean_normal(ndf), wi[4] = { { 0, 0, 1 }, { 0.6, 0, 0.8 }, { 0, 0, 0 }, { 0, 0, 0 } };
    double jump = 0, bad = 0;
    size_t v, i, j;
    wi[2] = n;
    wi[3] = unit(sum(1, n, 1e-9, wi[1]));
    for (v = 0; v < 4; v++)
        for (i = 0; i < 6; i++)
            for (j = 0; j < 6; j++) {
                asp_vec3 m = asp_sample_visible_walter(a->A, wi[v], places[i], places[j]), d;
                bad += !(dot(m, wi[v]) > -1e-9) || !(m.z >= 0) || !(fabs(dot(m, m) - 1) < 1e-12);
                if (i && j && i < 5 && j < 5) {
                    d = asp_sample_visible_walter(a->A, wi[v], places[i] + 1e-9, places[j] - 1e-9);
                    d = sum(1, m, -1, d);
                    jump = fmax(jump, sqrt(dot(d, d)));
                }
            }
    say(bad == 0, "corners, centre and views along the mean normal give unit normals that are seen");
    printf("%-28s step of 1e-9 moves the normal by %.2g\n", a->name, jump);
    say(jump < 2e-3, "no jump: at the rim a root of the step");
}

int main(void)
{
    size_t samples = sample_count(20000), i, v;
    for (i = 0; i < MATRICES; i++) {
        asp_ndf ndf;
        asp_map map;
        asp_error err;
        if (asp_map_from_matrix(matrices[i].A, &map, &err) != ASP_OK
            || asp_ndf_make(asp_find_model(NULL, "ellipsoid"), &map, NULL, &ndf, &err) != ASP_OK) {
            printf("%s: %s\n", matrices[i].name, err.reason);
            say(0, matrices[i].name);
            continue;
        }
        for (v = 0; v < VIEWS; v++)
            one_view(&matrices[i], &ndf, v, samples);
        check_weights(&matrices[i], &ndf);
        check_places(&matrices[i], &ndf);
    }
    printf("the %zu p-values: KS p = %.3g\n", p_count, p_of_all());
    say(p_of_all() > 1e-4, "the p-values are uniform");
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
