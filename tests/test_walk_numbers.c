/* test_walk_numbers.c - walks against a walk of the test's own, as the paper writes it (Heitz, Hanika, d'Eon,
 * Dachsbacher 2016): heights uniform in [-1, 1] and drawn at each flight, no roulette, and GGX by its own formulas
 * (normals by the cap of Dupuy, Benyoub 2023). And asp_walk_pdf as a density. */
#include "scatter_test.h"

#include <string.h>

#if defined(__SANITIZE_ADDRESS__)
#define WALKS 40000
#else
#define WALKS 400000
#endif

static asp_vec3 minus(asp_vec3 a) { return (asp_vec3){ -a.x, -a.y, -a.z }; }

static asp_vec3 unit(asp_vec3 a)
{
    double n = sqrt(dot(a, a));
    return (asp_vec3){ a.x / n, a.y / n, a.z / n };
}

/* ---- the test's own walk */

enum kind { METAL, DIFFUSE, GLASS };

typedef struct surface {
    enum kind kind;
    double alpha;
    double f0[3];      /* of a metal by Schlick's term; a diffuse facet's albedo */
    double eta;
} surface;

/* Lambda of any direction, also below the horizon, where it is at most -1. */
static double lambda(double alpha, asp_vec3 w)
{
    double a = w.z / (alpha * sqrt(fmax(1 - w.z * w.z, 1e-30)));
    return 0.5 * (-1 + (a < 0 ? -1 : 1) * sqrt(1 + 1 / (a * a)));
}

/* The height where a ray at h in direction w meets a facet; 1: it does not. */
static double flight(double alpha, asp_vec3 w, double h, double u)
{
    double L = lambda(alpha, w), below = 0.5 * (h + 1), out, q;
    if (w.z > 0.999999)
        return 1;
    if (w.z < -0.999999)
        return 2 * u * below - 1;
    out = w.z > 0 ? pow(below, L) : 0;
    if (u >= 1 - out)
        return 1;
    q = below / pow(1 - u, 1 / L);
    return 2 * fmin(q, 1) - 1;
}

/* A facet visible from v, above or below the horizon. */
static asp_vec3 facet(double alpha, asp_vec3 v, uint64_t *state)
{
    asp_vec3 i = unit((asp_vec3){ alpha * v.x, alpha * v.y, v.z });
    double z = 1 - next(state) * (1 + i.z), phi = 2 * PI * next(state), s = sqrt(fmax(1 - z * z, 0));
    asp_vec3 m = { alpha * (s * cos(phi) + i.x), alpha * (s * sin(phi) + i.y), fmax(z + i.z, 0) };
    return unit(m);
}

static double fresnel(double c, double eta)
{
    double t = 1 - (1 - c * c) / (eta * eta), s, p;
    if (t <= 0)
        return 1;
    t = sqrt(t);
    s = (c - eta * t) / (c + eta * t);
    p = (eta * c - t) / (eta * c + t);
    return 0.5 * (s * s + p * p);
}

static asp_vec3 around(asp_vec3 m, double u1, double u2)
{
    asp_vec3 a = fabs(m.x) < 0.6 ? (asp_vec3){ 0, m.z, -m.y } : (asp_vec3){ -m.z, 0, m.x }, b;
    double r = sqrt(u1), x = r * cos(2 * PI * u2), y = r * sin(2 * PI * u2), z = sqrt(1 - u1);
    a = unit(a);
    b = (asp_vec3){ m.y * a.z - m.z * a.y, m.z * a.x - m.x * a.z, m.x * a.y - m.y * a.x };
    return (asp_vec3){ x * a.x + y * b.x + z * m.x, x * a.y + y * b.y + z * m.y, x * a.z + y * b.z + z * m.z };
}

/* Where the walk ends and what it carries. Inside everything is turned upside down. */
static asp_vec3 own_walk(const surface *s, asp_vec3 wi, uint64_t *state, double carried[3])
{
    int inside = wi.z < 0;
    asp_vec3 d = inside ? wi : minus(wi);     /* in the frame of its side */
    double h = 1;
    carried[0] = carried[1] = carried[2] = 1;
    for (int met = 0; met < 2000; met++) {
        asp_vec3 v, m;
        double c;
        h = flight(s->alpha, d, h, next(state));
        if (h >= 1)
            break;
        v = minus(d);
        m = facet(s->alpha, v, state);
        c = dot(v, m);
        if (s->kind == DIFFUSE) {
            double u = next(state);
            d = around(m, u, next(state));
            for (int i = 0; i < 3; i++)
                carried[i] *= s->f0[i];
            continue;
        }
        if (s->kind == GLASS) {
            double eta = inside ? 1 / s->eta : s->eta;
            if (next(state) >= fresnel(c, eta)) {
                double by = c / eta - sqrt(1 - (1 - c * c) / (eta * eta));
                asp_vec3 t = { by * m.x - v.x / eta, by * m.y - v.y / eta, by * m.z - v.z / eta };
                d = minus(t);
                h = -h;
                inside = !inside;
                continue;
            }
        }
        for (int i = 0; i < 3 && s->kind == METAL; i++)
            carried[i] *= s->f0[i] + (1 - s->f0[i]) * pow(1 - c, 5);
        d = (asp_vec3){ 2 * c * m.x - v.x, 2 * c * m.y - v.y, 2 * c * m.z - v.z };
    }
    return inside ? minus(d) : d;
}

/* ---- comparison: colour by colour, in four bands of height on either side and in all */

#define CELLS 9
typedef struct tally { double sum[CELLS][3], sum2[CELLS][3]; } tally;

static void put(tally *t, asp_vec3 w, const double carried[3])
{
    int band = (int)fmin(4 * fabs(w.z), 3) + (w.z < 0 ? 4 : 0);
    for (int i = 0; i < 3; i++) {
        t->sum[band][i] += carried[i];
        t->sum2[band][i] += carried[i] * carried[i];
        t->sum[8][i] += carried[i];
        t->sum2[8][i] += carried[i] * carried[i];
    }
}

static double largest_z(const tally *a, const tally *b, double n)
{
    double z = 0;
    for (int k = 0; k < CELLS; k++)
        for (int i = 0; i < 3; i++) {
            double x = a->sum[k][i] / n, y = b->sum[k][i] / n;
            double var = (a->sum2[k][i] / n - x * x + b->sum2[k][i] / n - y * y) / n;
            if (a->sum[k][i] > 0 || b->sum[k][i] > 0)
                z = fmax(z, fabs(x - y) / sqrt(var + 1e-20));
        }
    return z;
}

static void check_walks(void)
{
    static const struct { const char *spec; surface s; double theta; } cases[] = {
        { "conductor:f0=0.95/0.5/0.2,tint=1,ndf=(ggx:alpha=2)", { METAL, 2, { 0.95, 0.5, 0.2 }, 0 }, 0.4 },
        { "conductor:f0=0.5/0.45/0.4,tint=1,ndf=(ggx:alpha=2)", { METAL, 2, { 0.5, 0.45, 0.4 }, 0 }, 1.2 },
        { "conductor:f0=0.9/0.8/0.7,tint=1,ndf=(ggx:alpha=1)", { METAL, 1, { 0.9, 0.8, 0.7 }, 0 }, 1.3 },
        { "rough_diffuse:albedo=0.8/0.6/0.3,ndf=(ggx:alpha=1)", { DIFFUSE, 1, { 0.8, 0.6, 0.3 }, 0 }, 1.0 },
        { "dielectric:eta=1.5,transport=importance,ndf=(ggx:alpha=1)", { GLASS, 1, { 1, 1, 1 }, 1.5 }, 1.0 },
        { "dielectric:eta=1.5,transport=importance,ndf=(ggx:alpha=1)", { GLASS, 1, { 1, 1, 1 }, 1.5 }, PI - 0.5 }
    };
    double worst = 0, worst_eval = 0;
    for (int i = 0; i < (int)(sizeof cases / sizeof *cases); i++) {
        asp_material mat = material(cases[i].spec);
        asp_vec3 wi = direction(cases[i].theta, 0.3);
        int both = cases[i].s.kind == GLASS;
        tally own, walk, eval;
        uint64_t a = 11 + (uint64_t)i, b = 1001 + (uint64_t)i, c = 5001 + (uint64_t)i;
        double z, z_eval;
        memset(&own, 0, sizeof own);
        memset(&walk, 0, sizeof walk);
        memset(&eval, 0, sizeof eval);
        for (int j = 0; j < WALKS; j++) {
            double carried[3], u1 = next(&c), u2 = next(&c), pdf;
            asp_bsdf_sample s = asp_walk_sample(&mat, wi, next, &b);
            asp_vec3 wo = own_walk(&cases[i].s, wi, &a, carried);
            asp_rgb f;
            put(&own, wo, carried);
            put(&walk, s.wo, (double[3]){ s.weight.r, s.weight.g, s.weight.b });
            /* eval with directions of a cosine lobe */
            wo = around((asp_vec3){ 0, 0, 1 }, u1, u2);
            pdf = wo.z / PI * (both ? 0.5 : 1);
            wo.z = both && next(&c) < 0.5 ? -wo.z : wo.z;
            f = asp_walk_eval_cos(&mat, wi, wo, next, &c);
            put(&eval, wo, (double[3]){ f.r / pdf, f.g / pdf, f.b / pdf });
        }
        z = largest_z(&own, &walk, WALKS);
        z_eval = largest_z(&own, &eval, WALKS);
        printf("       %s: returns %.4f %.4f %.4f, own walk %.4f %.4f %.4f; %.2f and, eval, %.2f standard errors\n",
               cases[i].spec, walk.sum[8][0] / WALKS, walk.sum[8][1] / WALKS, walk.sum[8][2] / WALKS,
               own.sum[8][0] / WALKS, own.sum[8][1] / WALKS, own.sum[8][2] / WALKS, z, z_eval);
        worst = fmax(worst, z);
        worst_eval = fmax(worst_eval, z_eval);
    }
    expect(worst < 4.5, "walks of the library and of the test, by height and colour, standard errors apart", worst);
    expect(worst_eval < 4.5, "and what eval estimates", worst_eval);
}

/* ---- the density */

static void check_density(void)
{
    static const char *const specs[] = {
        "conductor:f0=0.9,ndf=(ggx:alpha=0.4)", "conductor:f0=0.9,ndf=(ggx:alpha=2)",
        "conductor:f0=0.9,ndf=(beckmann:alpha_x=0.3,alpha_y=0.8,mean_x=0.3),mask=wall",
        "rough_diffuse:albedo=0.5,ndf=(ggx:alpha=0.7)", "dielectric:eta=1.5,ndf=(ggx:alpha=0.5)",
        "dielectric:eta=1.5,ndf=(beckmann:alpha=0.6,mean_y=0.2)"
    };
    static const double thetas[] = { 0.2, 1.0, 1.4 };
    double most = 0, least = 1e9, apart = 0, dark = 0;
    uint64_t state = 5;
    for (int i = 0; i < (int)(sizeof specs / sizeof *specs); i++)
        for (int t = 0; t < 6; t++) {
            const int rings = 400, sectors = 400;
            asp_material mat = material(specs[i]);
            asp_vec3 wi = direction(thetas[t / 2], 0.4);
            double sum = 0;
            if (t & 1 && strncmp(specs[i], "dielectric", 10) != 0)
                continue;
            wi.z = t & 1 ? -wi.z : wi.z;
            for (int j = 0; j < rings; j++)
                for (int k = 0; k < sectors; k++) {
                    double z = -1 + 2 * (j + 0.5) / rings, phi = 2 * PI * (k + 0.5) / sectors, s = sqrt(1 - z * z);
                    double p = asp_walk_pdf(&mat, wi, (asp_vec3){ s * cos(phi), s * sin(phi), z });
                    dark += !(p >= 0);
                    sum += p * 4 * PI / (rings * (double)sectors);
                }
            most = fmax(most, sum);
            least = fmin(least, sum);
            for (int j = 0; j < 5000; j++) {
                asp_bsdf_sample s = asp_walk_sample(&mat, wi, next, &state);
                if (s.weight.r > 0) {
                    dark += !(s.pdf > 0);
                    apart = fmax(apart, fabs(s.pdf / asp_walk_pdf(&mat, wi, s.wo) - 1));
                }
            }
        }
    expect(most < 1 + 1e-3, "asp_walk_pdf integrates to at most 1 over the sphere", most);
    expect(least > 0.2, "and to some of it from everywhere, at least", least);
    expect(dark == 0, "it is never negative, and positive where walks end; exceptions", dark);
    expect(apart < 1e-12, "it is what a sample says, relative", apart);
}

int main(void)
{
    check_walks();
    check_density();
    return finish();
}
