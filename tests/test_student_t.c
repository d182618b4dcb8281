/* test_student_t.c - the Student-t family on its standard surface
 *
 * Calls the records' formulas directly. What must hold: float32 against float64 at the same inputs,
 * the limits (gamma = 2 is GGX, gamma = inf is Beckmann), sigma's identities, exact inversion by the
 * samplers (their distribution functions at the sample give the uniform numbers back), the samplers'
 * law by chi-square, also against a rejection sampler of another construction, and no NaN or infinity
 * for any finite input. ASPERITY_SAMPLES sets the samples per chi-square case. */
#include "random.h"
#include "student_reference.h"
#include "student_formulas.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double gammas[] = { 1.501, 1.51, 1.65, 2, 2.5, 4, 10, 50, 1e4, INFINITY };
#define GAMMAS (sizeof gammas / sizeof gammas[0])

static int passed, failed;

static void report(const char *what, double gamma, double worst, double bound)
{
    int ok = worst <= bound;
    printf("%-4s %-44s gamma %-7g %.3g, bound %g\n", ok ? "ok" : "FAIL", what, gamma, worst, bound);
    passed += ok;
    failed += !ok;
}

/* One prepared distribution in both precisions. */
typedef struct pair {
    const formulas *model;
    const asp_model *ops;
    double gamma, n;
    asp_ndf k;
    asp_ndff f;
} pair;

static pair make(const formulas *model, double gamma)
{
    pair p;
    int i;
    memset(&p, 0, sizeof p);
    p.model = model;
    p.ops = model->ops;
    p.gamma = gamma;
    p.n = gamma - 1;
    p.k.shape[0] = gamma;
    if (p.ops->prepare)
        p.ops->prepare(&p.k, NULL);
    p.k.map.m00 = p.k.map.m11 = p.k.i00 = p.k.i11 = p.k.inv_det = 1;
    p.f.map.m00 = p.f.map.m11 = p.f.i00 = p.f.i11 = p.f.inv_det = 1;
    for (i = 0; i < ASP_SHAPE_NUMBERS; i++)
        p.f.shape[i] = (float)p.k.shape[i];
    for (i = 0; i < ASP_TABLE_NUMBERS; i++)
        p.f.table[i] = (float)p.k.table[i];
    return p;
}

static double relative(double got, double want)
{
    return want == 0 ? fabs(got) : fabs(got / want - 1);
}

static double larger(double a, double b) { return b <= a ? a : b; }   /* keeps a NaN of b */

/* ------------------------------------------------------------------ values */

/* float32 against float64 at the same float inputs. */
static void check_float(const pair *p)
{
    const formulas *a = p->model;
    double d_main = 0, d_tail = 0, up = 0, down = 0, deep = 0;
    int i;
    for (i = 0; i < 200000; i++) {
        float z2 = (float)exp(-9 + 9 * uniform()), w, s2;
        float r2 = (float)(i & 1 ? z2 * exp(-10 + 35 * uniform()) : z2 * 30 * uniform());
        double want = a->density(&p->k, (double)r2, (double)z2), peak = 1 / (pi * (double)z2 * (double)z2);
        double e = relative((double)a->density_f(&p->f, r2, z2), want), s;
        if (want > 1e-6 * peak)
            d_main = larger(d_main, e);
        else if (want > 1e-30 && want > 1e-36 * peak)
            d_tail = larger(d_tail, e);
        s = exp(-10 + 10 * uniform());
        w = (float)(i & 1 ? s * exp(-10 + 26 * uniform()) : s * 9 * uniform());
        s2 = (float)(s * s);
        s = sqrt((double)s2);
        want = a->sigma(&p->k, (double)w, (double)s2);
        up = larger(up, relative((double)a->sigma_f(&p->f, w, s2), want));
        want = a->sigma(&p->k, -(double)w, (double)s2);
        e = relative((double)a->sigma_f(&p->f, -w, s2), want);
        if (want > 1e-6 * s)
            down = larger(down, e);
        else if (want > 1e-30 * s && want > 1e-30)
            deep = larger(deep, e);
    }
    report("float32 density above 1e-6 of the peak", p->gamma, d_main, 6e-7);
    report("float32 density below", p->gamma, d_tail, 8e-7);
    report("float32 sigma, w > 0", p->gamma, up, 1e-6);
    report("float32 sigma, w < 0, above 1e-6 s", p->gamma, down, 4e-6);
    report("float32 sigma, w < 0, below", p->gamma, deep, 2.5e-5);
}

/* sigma against M - x T where that does not cancel much (the reference's lgamma errs by 1e-10 at
 * gamma = 1e4), and the identity of its two sides. */
static void check_sigma(const pair *p)
{
    double worst = 0, sides = 0, zero = 0;
    int i;
    for (i = 0; i < 4000; i++) {
        double x = exp(-10 + 10.4 * uniform()), s = exp(-4 + 8 * uniform()), w = x * s;
        double j = moment(p->n, x) - x * tail(p->n, x);
        worst = larger(worst, relative(p->model->sigma(&p->k, -w, s * s), s * j));
        sides = larger(sides, fabs(p->model->sigma(&p->k, w, s * s)
                                   - p->model->sigma(&p->k, -w, s * s) - w)
                              / p->model->sigma(&p->k, w, s * s));
        zero = larger(zero, fabs(p->model->sigma(&p->k, w, 0) - w)
                            + p->model->sigma(&p->k, -w, 0));
        zero = larger(zero, relative(p->model->sigma(&p->k, 0, s * s), s * moment(p->n, 0)));
    }
    report("sigma = s (M - x T), x < 1.5", p->gamma, worst, p->gamma > 100 ? 1e-9 : 1e-11);
    report("sigma(w) - sigma(-w) = w", p->gamma, sides, 1e-15);
    report("sigma at w = 0 and s = 0", p->gamma, zero, 1e-11);
}

static void check_limits(void)
{
    pair two = make(&of_student_t, 2), ggx = make(&of_ggx, 2);
    pair inf = make(&of_student_t, INFINITY), b = make(&of_beckmann, INFINITY);
    pair far = make(&of_student_t, 1e9), near = make(&of_student_t, 1e12);
    double d = 0, s = 0, di = 0, si = 0, ratio = 0;
    int i;
    for (i = 0; i < 20000; i++) {
        double r2 = exp(-20 + 40 * uniform()), w = exp(-10 + 26 * uniform()), s2 = exp(-4 + 8 * uniform());
        double x = 4 * uniform(), exact;
        w = i & 1 ? w : -w;
        d = larger(d, relative(two.model->density(&two.k, r2, 0.7),
                               ggx.model->density(&ggx.k, r2, 0.7)));
        s = larger(s, relative(two.model->sigma(&two.k, w, s2), ggx.model->sigma(&ggx.k, w, s2)));
        exact = b.model->density(&b.k, x * x, 1);
        di = larger(di, relative(inf.model->density(&inf.k, x * x, 1), exact));
        /* the distance to the limit falls as 1/gamma */
        ratio = larger(ratio, 1e9 * relative(far.model->density(&far.k, x * x, 1), exact) / 150);
        ratio = larger(ratio, 1e12 * (relative(near.model->density(&near.k, x * x, 1), exact)
                                      - 1e-14) / 150);
        si = larger(si, relative(inf.model->sigma(&inf.k, x - 2, 1), b.model->sigma(&b.k, x - 2, 1)));
    }
    report("density: gamma 2 is GGX", 2, d, 1e-13);
    report("sigma: gamma 2 is GGX", 2, s, 1e-12);
    report("density: gamma inf is Beckmann", INFINITY, di, 1e-14);
    report("sigma: gamma inf is Beckmann", INFINITY, si, 1e-13);
    report("distance to Beckmann, times gamma, over 150", 1e12, ratio, 1);
}

/* ------------------------------------------------------------------ samplers invert */

/* Views (c, s), from along the normal to below the mean plane. */
static const double views[][2] = {
    { 1, 0 }, { 1, 1e-4 }, { 1, 0.02 }, { 0.98, 0.2 }, { 0.8, 0.6 }, { 0.3, 0.95 }, { 0.02, 1 },
    { 1e-4, 1 }, { 0, 1 }, { -1e-3, 1 }, { -0.1, 1 }, { -0.5, 0.8 }, { -0.9, 0.4 }
};
#define VIEWS (sizeof views / sizeof views[0])

/* Share of the visible normals with a slope below x along the view, by T and M; as the smaller of it
 * and its complement (negative) where that is more accurate. */
static double along(const pair *p, double c, double s, double x)
{
    double t = tail(p->n, fabs(x)), m = moment(p->n, x), f = x < 0 ? t : 1 - t;
    double far = c < 0 || s > 0 ? s * moment(p->n, c / fmax(s, 1e-30))
                                  - fabs(c) * tail(p->n, fabs(c) / fmax(s, 1e-30)) : 0;
    return (c * f + s * m) / (fmax(c, 0) + far);
}

static void check_visible(const pair *p)
{
    double worst = 0, across = 0, worst_f = 0, across_f = 0, hidden = 0;
    size_t v;
    int i;
    for (v = 0; v < VIEWS; v++) {
        double l = hypot(views[v][0], views[v][1]);
        double c = (double)(float)(views[v][0] / l), s = (double)(float)(views[v][1] / l);
        /* below the mean plane T and M cancel in the reference; where nothing is left, skip */
        double cancel = c < 0 ? moment(p->n, c / s) / p->model->sigma(&p->k, c, s * s) : 1;
        if (cancel > 1e4)
            continue;
        for (i = 0; i < 400; i++) {
            double u1 = uniform(), u2 = uniform(), m[3], x, y, g;
            float f[3];
            if (i % 8 == 0)
                u1 = exp(-20 * u1);
            if (i % 8 == 1)
                u1 = 1 - exp(-15 * u1);
            if (i % 8 == 2)
                u2 = exp(-15 * u2);
            u1 = (double)(float)u1 < 1 ? (double)(float)u1 : 0.5;
            u2 = (double)(float)u2;
            p->ops->f64.visible(&p->k, s, 0, c, u1, u2, m);
            p->ops->f32.visible(&p->f, (float)s, 0, (float)c, (float)u1, (float)u2, f);
            /* the slope along is -m.x/m.z */
            x = -m[0] / m[2];
            if (m[2] > 1e-140)      /* heavy tails: a vertical facet has lost its slope */
                worst = larger(worst, fabs(along(p, c, s, x) - u1) / cancel);
            x = -(double)f[0] / (double)f[2];
            if (f[2] > 1e-36f)
                worst_f = larger(worst_f, fabs(along(p, c, s, x) - u1) / cancel);
            hidden = larger(hidden, -(s * m[0] + c * m[2])
                                    / sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]));
            /* across: y/sqrt(n + x^2) is a quantile of the family at n + 1/2 */
            y = -m[1] / (p->n < 1e12 ? hypot(sqrt(p->n) * m[2], m[0]) : m[2]);
            g = p->n < 1e12 ? p->n + 0.5 : p->n;
            y = p->n < 1e12 ? y * sqrt(g) : y;
            across = larger(across, fabs((y > 0 ? 1 - tail(g, y) : tail(g, -y)) - u2));
            y = -(double)f[1] / (p->n < 1e12 ? hypot(sqrt(p->n) * (double)f[2], (double)f[0])
                                             : (double)f[2]);
            y = p->n < 1e12 ? y * sqrt(g) : y;
            across_f = larger(across_f, fabs((y > 0 ? 1 - tail(g, y) : tail(g, -y)) - u2));
        }
    }
    report("visible: distribution along - u1, float64", p->gamma, worst, 2e-11);
    report("visible: distribution across - u2, float64", p->gamma, across, p->gamma > 100 ? 2e-11 : 1e-12);
    report("visible: distribution along - u1, float32", p->gamma, worst_f, p->gamma < 1.51 ? 3e-6 : 1e-6);
    report("visible: distribution across - u2, float32", p->gamma, across_f, 1e-6);
    report("visible: nothing faces away", p->gamma, hidden, 1e-15);
}

static void check_normal(const pair *p)
{
    double worst = 0, worst_f = 0, turn = 0;
    int i;
    for (i = 0; i < 2000; i++) {
        double u1 = (double)(float)uniform(), u2 = (double)(float)uniform(), m[3], q;
        float f[3];
        if (!(u1 < 1))
            u1 = 0.5;
        p->ops->f64.normal(&p->k, u1, u2, m);
        q = (m[0] * m[0] + m[1] * m[1]) / (m[2] * m[2]);
        q = p->n < 1e12 ? p->n * log1p(q / p->n) : q;
        worst = larger(worst, fabs(-expm1(-q) - u1));
        turn = larger(turn, fabs(remainder(atan2(m[1], m[0]) / (2 * pi) - u2, 1)));
        p->ops->f32.normal(&p->f, (float)u1, (float)u2, f);
        q = ((double)f[0] * (double)f[0] + (double)f[1] * (double)f[1]) / ((double)f[2] * (double)f[2]);
        q = p->n < 1e12 ? p->n * log1p(q / p->n) : q;
        worst_f = larger(worst_f, fabs(-expm1(-q) - u1));
    }
    report("normal: distribution - u1, float64", p->gamma, worst, 1e-12);
    report("normal: azimuth - u2, float64", p->gamma, turn, 1e-15);
    report("normal: distribution - u1, float32", p->gamma, worst_f, 1e-6);
}

/* ------------------------------------------------------------------ samplers' law */

#define RINGS 20
#define SECTORS 24

/* Bin of a normal: rings of equal mass of the plain distribution, sectors of the azimuth from the
 * view's. The slope is -m_xy/m_z. */
static int bin(const pair *p, double mx, double my, double mz)
{
    double r2 = (mx * mx + my * my), q, phi = atan2(-my, -mx);
    int i, j;
    q = p->n < 1e12 ? pow(mz * mz / (mz * mz + r2 / p->n), p->n) : exp(-r2 / (mz * mz));
    i = (int)((1 - q) * RINGS);
    j = (int)((phi / pi * 0.5 + 0.5) * SECTORS);
    return (i < RINGS ? i : RINGS - 1) * SECTORS + (j < SECTORS ? j : SECTORS - 1);
}

/* int of max(0, c - h cos phi) from phi0 to phi1, 0 <= phi0 < phi1 <= pi, h >= 0. */
static double sector(double c, double h, double phi0, double phi1)
{
    double start = c >= h ? 0 : (c <= -h ? pi : acos(c / h));
    phi0 = fmax(phi0, start);
    return phi1 > phi0 ? c * (phi1 - phi0) - h * (sin(phi1) - sin(phi0)) : 0;
}

/* Shares of the bins by the definition max(0, v.m) D(m)/sigma(v): with a = -log(1 - q) and r^2 = n
 * (e^(a/n) - 1) that is (c - s r cos phi)+ e^-a da dphi/(2 pi sigma). Composite Simpson in a. */
static void expected(const pair *p, double c, double s, double share[RINGS * SECTORS])
{
    double sigma = p->model->sigma(&p->k, c, s * s), sum = 0;
    double beta = p->n < 1e12 ? 1 - 0.5 / p->n : 1;
    int i, j, k;
    for (i = 0; i < RINGS; i++) {
        double a0 = -log1p(-(double)i / RINGS);
        double a1 = i < RINGS - 1 ? -log1p(-(i + 1.0) / RINGS) : a0 + 40 / beta;
        int steps = i < RINGS - 1 ? 200 : 4000;
        for (j = 0; j < SECTORS; j++)
            share[i * SECTORS + j] = 0;
        for (k = 0; k <= steps; k++) {
            /* the first ring starts with a square root: spread a quadratically */
            double t = (double)k / steps, a = a0 + (a1 - a0) * t * t;
            double w = (k == 0 || k == steps ? 1 : (k & 1 ? 4 : 2)) / (3.0 * steps) * (a1 - a0) * 2 * t;
            double e = exp(-a);
            double re = p->n < 1e12 ? sqrt(-p->n * expm1(-a / p->n)) * exp(-beta * a) : sqrt(a) * e;
            for (j = 0; j < SECTORS / 2; j++)
                share[i * SECTORS + SECTORS / 2 + j] += w / (2 * pi * sigma)
                    * sector(c * e, s * re, 2 * pi * j / SECTORS, 2 * pi * (j + 1) / SECTORS);
        }
        for (j = 0; j < SECTORS / 2; j++)
            share[i * SECTORS + SECTORS / 2 - 1 - j] = share[i * SECTORS + SECTORS / 2 + j];
    }
    for (i = 0; i < RINGS * SECTORS; i++)
        sum += share[i];
    if (!(fabs(sum - 1) < 1e-4))
        printf("     expected shares of gamma %g, c %g sum to %.7f\n", p->gamma, c, sum);
}

/* Upper tail probability of chi-square by Wilson and Hilferty. */
static double chi_probability(double chi2, int dof)
{
    double h = 2.0 / (9.0 * dof);
    return 0.5 * erfc((cbrt(chi2 / dof) - (1 - h)) / sqrt(2 * h));
}

static double chi_square(const double *count, const double *share, double total)
{
    double chi2 = 0, rest_count = 0, rest_share = 0;
    int i, dof = -1;
    for (i = 0; i < RINGS * SECTORS; i++) {
        double want = share[i] * total;
        if (want < 10) {
            rest_count += count[i];
            rest_share += want;
            continue;
        }
        chi2 += (count[i] - want) * (count[i] - want) / want;
        dof++;
    }
    if (rest_share > 5) {
        chi2 += (rest_count - rest_share) * (rest_count - rest_share) / rest_share;
        dof++;
    }
    return dof > 0 ? chi_probability(chi2, dof) : 1;
}

#define BLOCK 512
static double in64[5][BLOCK], out64[3][BLOCK];
static float in32[5][BLOCK], out32[3][BLOCK];

/* Samples of the batch loops, the view at an azimuth of 0.7, turned back. */
static void draw(const pair *p, double c, double s, int single, long total, double *count)
{
    const double ca = cos(0.7), sa = sin(0.7);
    long done;
    int i, j;
    memset(count, 0, RINGS * SECTORS * sizeof *count);
    for (done = 0; done < total; done += BLOCK) {
        for (i = 0; i < BLOCK; i++) {
            const double v[5] = { s * ca, s * sa, c, uniform(), uniform() };
            for (j = 0; j < 5; j++) {
                in64[j][i] = v[j];
                in32[j][i] = j < 3 ? (float)v[j] : (float)(v[j] * (1 - 0x1p-25));
            }
        }
        if (single)
            p->ops->f32.visible_n(&p->f, BLOCK, in32[0], in32[1], in32[2], in32[3], in32[4],
                                    out32[0], out32[1], out32[2]);
        else
            p->ops->f64.visible_n(&p->k, BLOCK, in64[0], in64[1], in64[2], in64[3], in64[4],
                                    out64[0], out64[1], out64[2]);
        for (i = 0; i < BLOCK; i++) {
            double x = single ? (double)out32[0][i] : out64[0][i];
            double y = single ? (double)out32[1][i] : out64[1][i];
            double z = single ? (double)out32[2][i] : out64[2][i];
            count[bin(p, x * ca + y * sa, y * ca - x * sa, z)]++;
        }
    }
}

static long samples(void)
{
    const char *text = getenv("ASPERITY_SAMPLES");
    long n = text ? atol(text) : 0;
    n = n > 0 ? n : 60000;
    return (n + BLOCK - 1) / BLOCK * BLOCK;
}

static void check_law(void)
{
    static double share[RINGS * SECTORS], count[RINGS * SECTORS];
    static const double view[][2] = { { 1, 0 }, { 0.9, 0.2 }, { 0.7, 0.7 }, { 0.1, 1 }, { 0, 1 },
                                      { -0.3, 1 } };
    double lowest = 1;
    size_t g, v;
    int single, cases = 0;
    for (g = 0; g < GAMMAS; g++) {
        pair p = make(g < GAMMAS - 1 ? &of_student_t : &of_beckmann, gammas[g]);
        for (v = 0; v < sizeof view / sizeof view[0]; v++) {
            double l = hypot(view[v][0], view[v][1]), c = view[v][0] / l, s = view[v][1] / l;
            expected(&p, c, s, share);
            for (single = 0; single < 2; single++) {
                double prob;
                draw(&p, c, s, single, samples(), count);
                prob = chi_square(count, share, (double)samples());
                cases++;
                if (prob < 1e-4)
                    printf("     gamma %g, c %g, float%d: p = %.3g\n", p.gamma, c, single ? 32 : 64, prob);
                lowest = fmin(lowest, prob);
            }
        }
    }
    printf("     %d chi-square tests of %ld samples, lowest p %.3g\n", cases, samples(), lowest);
    report("visible: chi-square, -log10 of the lowest p", NAN, -log10(lowest), 5);
}

/* A visible slope by rejection (no special functions): with mass mu a plain slope folded to the
 * visible side, with mass M(mu) the tail x < -mu thinned by 1 - mu/|x|; below the plane the tail
 * alone. Returns the homogeneous normal, the view towards +x. */
static void rejection(const pair *p, double mu, double m[3])
{
    double h = fabs(mu), mass = moment(p->n, h), up = fmax(mu, 0);
    for (;;) {
        if (uniform() * (up + mass) < up) {
            double e = log1p(-uniform()), r = sqrt(-p->n * expm1(e / p->n)), w = exp(e / (2 * p->n));
            double phi = 2 * pi * uniform(), x = fabs(r * cos(phi));
            m[2] = w;
            m[1] = r * sin(phi);
            m[0] = uniform() * 2 * mu * w < mu * w + x ? x : -x;
            return;
        } else {
            double w = pow(uniform(), 1 / (2 * p->n - 1)) / sqrt(p->n + h * h);
            double x = sqrt(fmax(0, 1 - p->n * w * w));
            if (uniform() * x < x - h * w) {
                double t = sqrt(expm1(-log(uniform()) / (p->n + 0.5)));
                m[0] = x;
                m[1] = t * cos(2 * pi * uniform());
                m[2] = w;
                return;
            }
        }
    }
}

/* Two samples of one law: chi-square of the difference. */
static void check_rejection(void)
{
    static double a[RINGS * SECTORS], b[RINGS * SECTORS];
    static const double view[][2] = { { 0.95, 0.3 }, { 0.5, 1 }, { 0.02, 1 }, { -0.2, 1 }, { -0.6, 0.8 } };
    double lowest = 1;
    size_t g, v;
    for (g = 0; g + 2 < GAMMAS; g++)
        for (v = 0; v < sizeof view / sizeof view[0]; v++) {
            pair p = make(&of_student_t, gammas[g]);
            double c = view[v][0], s = view[v][1], chi2 = 0, prob;
            long i, total = samples();
            int dof = -1;
            memset(b, 0, sizeof b);
            for (i = 0; i < total; i++) {
                double m[3];
                rejection(&p, c / s, m);
                b[bin(&p, m[0], m[1], m[2])]++;
            }
            draw(&p, c, s, 0, total, a);
            for (i = 0; i < RINGS * SECTORS; i++)
                if (a[i] + b[i] > 20) {
                    chi2 += (a[i] - b[i]) * (a[i] - b[i]) / (a[i] + b[i]);
                    dof++;
                }
            prob = dof > 0 ? chi_probability(chi2, dof) : 1;
            if (prob < 1e-4)
                printf("     gamma %g, c %g: p = %.3g\n", p.gamma, c, prob);
            lowest = fmin(lowest, prob);
        }
    report("visible: against rejection, -log10 of the lowest p", NAN, -log10(lowest), 5);
}

/* ------------------------------------------------------------------ any finite input */

static double rough(int i)
{
    static const double ends[] = { 0, 1e-30, 1e-12, 1e-6, 1e-3, 0.5, 1, 1 - 0x1p-24, 1e3 };
    return i % 3 ? ends[(int)(uniform() * 9)] : exp(-30 + 35 * uniform());
}

static void check_finite(const pair *p)
{
    double bad = 0;
    int i;
    for (i = 0; i < 40000; i++) {
        double r2 = rough(i), z2 = rough(i / 3), s = rough(i / 5), c = rough(i / 7), m[3];
        double u1 = fmin(rough(i / 2), 1 - 0x1p-24), u2 = fmin(rough(i / 4), 1 - 0x1p-24);
        double az = 2 * pi * uniform(), l;
        float f[3];
        c = i & 1 ? c : -c;
        bad += !isfinite(p->model->density(&p->k, r2, z2));
        bad += !isfinite(p->model->density_f(&p->f, (float)r2, (float)z2));
        bad += !isfinite(p->model->sigma(&p->k, c, s * s));
        bad += !isfinite(p->model->sigma_f(&p->f, (float)c, (float)(s * s)));
        l = hypot(c, s);
        if (l == 0)
            continue;
        c /= l;
        s /= l;
        p->ops->f64.visible(&p->k, s * cos(az), s * sin(az), c, u1, u2, m);
        bad += !(isfinite(m[0]) && isfinite(m[1]) && isfinite(m[2]) && m[2] >= 0
                 && m[0] * m[0] + m[1] * m[1] + m[2] * m[2] > 0);
        p->ops->f32.visible(&p->f, (float)(s * cos(az)), (float)(s * sin(az)), (float)c, (float)u1,
                              (float)u2, f);
        bad += !(isfinite(f[0]) && isfinite(f[1]) && isfinite(f[2]) && f[2] >= 0
                 && f[0] * f[0] + f[1] * f[1] + f[2] * f[2] > 0);
        p->ops->f64.normal(&p->k, u1, u2, m);
        bad += !(isfinite(m[0]) && isfinite(m[1]) && isfinite(m[2]) && m[2] >= 0);
        p->ops->f32.normal(&p->f, (float)u1, (float)u2, f);
        bad += !(isfinite(f[0]) && isfinite(f[1]) && isfinite(f[2]) && f[2] >= 0);
    }
    report("no NaN, no infinity", p->gamma, bad, 0);
}

/* The batch loops give the single calls' bits. */
static void check_batch(const pair *p)
{
    double bad = 0;
    int i, j;
    for (i = 0; i < BLOCK; i++) {
        double l;
        for (j = 0; j < 5; j++)
            in64[j][i] = j < 3 ? 2 * uniform() - 1 : uniform();
        l = sqrt(in64[0][i] * in64[0][i] + in64[1][i] * in64[1][i] + in64[2][i] * in64[2][i]);
        for (j = 0; j < 3; j++)
            in64[j][i] /= l;
        for (j = 0; j < 5; j++)
            in32[j][i] = (float)in64[j][i] * (1 - 0x1p-23f);
    }
    p->ops->f64.visible_n(&p->k, BLOCK - 3, in64[0], in64[1], in64[2], in64[3], in64[4], out64[0],
                                 out64[1], out64[2]);
    p->ops->f32.visible_n(&p->f, BLOCK - 3, in32[0], in32[1], in32[2], in32[3], in32[4], out32[0],
                                 out32[1], out32[2]);
    for (i = 0; i < BLOCK - 3; i++) {
        double m[3];
        float f[3];
        p->ops->f64.visible(&p->k, in64[0][i], in64[1][i], in64[2][i], in64[3][i], in64[4][i], m);
        p->ops->f32.visible(&p->f, in32[0][i], in32[1][i], in32[2][i], in32[3][i], in32[4][i], f);
        for (j = 0; j < 3; j++)
            bad += memcmp(&m[j], &out64[j][i], sizeof m[j]) || memcmp(&f[j], &out32[j][i], sizeof f[j]);
    }
    p->ops->f64.sigma_n(&p->k, BLOCK, 1, in64[0], in64[1], in64[2], out64[0]);
    p->ops->f64.density_n(&p->k, BLOCK, in64[0], in64[1], in64[2], out64[1]);
    p->ops->f32.sigma_n(&p->f, BLOCK, 1, in32[0], in32[1], in32[2], out32[0]);
    p->ops->f32.density_n(&p->f, BLOCK, in32[0], in32[1], in32[2], out32[1]);
    for (i = 0; i < BLOCK; i++) {
        bad += p->ops->f64.sigma(&p->k, in64[0][i], in64[1][i], in64[2][i]) != out64[0][i];
        bad += p->ops->f64.density(&p->k, in64[0][i], in64[1][i], in64[2][i]) != out64[1][i];
        bad += p->ops->f32.sigma(&p->f, in32[0][i], in32[1][i], in32[2][i]) != out32[0][i];
        bad += p->ops->f32.density(&p->f, in32[0][i], in32[1][i], in32[2][i]) != out32[1][i];
    }
    report("batches give the single calls' bits", p->gamma, bad, 0);
}

int main(void)
{
    size_t g;
    for (g = 0; g <= GAMMAS; g++) {
        pair p = make(g < GAMMAS ? &of_student_t : &of_beckmann,
                      g < GAMMAS ? gammas[g] : INFINITY);
        if (g == GAMMAS)
            printf("Beckmann's own record:\n");
        check_float(&p);
        check_sigma(&p);
        check_visible(&p);
        check_normal(&p);
        check_finite(&p);
        check_batch(&p);
    }
    check_limits();
    check_law();
    check_rejection();
    printf("%d passed, %d failed\n", passed, failed);
    return failed != 0;
}
