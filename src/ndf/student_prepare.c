/* student_prepare.c - exact values of the Student-t family and the polynomials fitted to them
 *
 * All in float64 and with the kernels' own elementary functions, so that a prepared distribution
 * has the same bits on every machine. About 0.6 ms. */
#include "ndf/student.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"

#define STUDENT_NODES 32

/* Asymptotic series of Gamma(n + 1/2) / (Gamma(n) sqrt n) in 1/n: scripts/gamma_ratio.py. Below 20 the
 * recurrence R(n) = R(n + 1) (n / (n + 1/2)) sqrt((n + 1)/n) lifts n; 4e-16. */
double aspi_gamma_ratio(double n)
{
    static const double c[12] = {
        1.0, -1.0 / 8, 1.0 / 128, 5.0 / 1024, -21.0 / 32768, -399.0 / 262144, 869.0 / 4194304,
        39325.0 / 33554432, -334477.0 / 2147483648, -28717403.0 / 17179869184,
        59697183.0 / 274877906944, 8400372435.0 / 2199023255552
    };
    double f = 1, m = n, s = 0;
    int i;
    while (m < 20) {
        f *= m / (m + 0.5);
        m += 1;
    }
    for (i = 11; i >= 0; i--)
        s = s / m + c[i];
    return f * sqrt(m / n) * s;
}

/* 2F1(1, b; n + 1; -n/z2) as Stieltjes' continued fraction (Gauss), all terms positive, by modified
 * Lentz. The partial numerators are k w with w = n/z2 multiplied in first: for n -> infinity they
 * become those of the error function's fraction. For z2 >= min(1.5, n) at most 120 terms. */
static double student_fraction(double n, double b, double z2)
{
    double f = 1, c = 1, d = 0;
    int j;
    for (j = 1; j <= 400; j++) {
        double i = j / 2, delta;    /* j = 2i or 2i + 1 */
        double low = n + j - 1;
        double num = j & 1 ? (b + i) * (n + i) : i * (n - b + i);
        double a = num / (low * (low + 1)) * n / z2;
        d = 1 / (1 + a * d);
        c = 1 + a / c;
        delta = c * d;
        f *= delta;
        if (delta - 1 < 1.2e-16 && 1 - delta < 1.2e-16)
            break;
    }
    return 1 / f;
}

/* T(x)/M(x) and J(x)/M(x) for x >= 0, n finite. */
static void student_exact(double n, double m0, double x, double *t_m, double *j_m)
{
    double z2 = x * x, q = z2 / n;
    if (z2 >= 1.5 || z2 >= n) {
        *t_m = (n - 0.5) / (n * x) * student_fraction(n, 0.5, z2);
        *j_m = (1 + q) / (2 * z2) * student_fraction(n, 1.5, z2);
    } else {
        /* int_0^x P2 = P2(0) x (1 + q)^(-n-1/2) sum (n + 1/2)_k / (3/2)_k y^k, y = z2/(n + z2):
         * divided by M that is x times (2n - 1)/n / (1 + q) times the sum */
        double y = z2 / (n + z2), term = 1, sum = 1, half;
        int k;
        for (k = 0; k < 200 && term > 1e-17 * sum; k++) {
            term *= (n + 0.5 + k) * y / (1.5 + k);
            sum += term;
        }
        half = 0.5 / m0 * aspi_exp_64((n - 0.5) * aspi_log1p_64(q));
        *t_m = half - x * (2 * n - 1) / n / (1 + q) * sum;
        *j_m = 1 - x * *t_m;
    }
}

/* Values at the Chebyshev points of the first kind -> the first `count` power coefficients. */
void aspi_student_coefficients(const double value[STUDENT_NODES], int count, double *out)
{
    double row[2][STUDENT_NODES] = {{0}, {0}}, c[STUDENT_NODES];
    double *now = row[0], *before = row[1];
    int i, j;
    for (j = 0; j < count; j++) {
        double sum = 0;
        for (i = 0; i < STUDENT_NODES; i++)
            sum += value[i] * aspi_sincos2pi_64(0.25 * j * (2 * i + 1) / STUDENT_NODES).x;
        c[j] = sum * (j ? 2.0 : 1.0) / STUDENT_NODES;
        out[j] = 0;
    }
    /* T0 = 1, T1 = t, T(j+1) = 2 t T(j) - T(j-1) */
    now[0] = 1;
    for (j = 0; j < count; j++) {
        double *next = before;
        for (i = 0; i <= j; i++)
            out[i] += c[j] * now[i];
        for (i = STUDENT_NODES - 1; i >= 0; i--)
            next[i] = (j ? 2 : 1) * (i ? now[i - 1] : 0) - before[i];
        before = now;
        now = next;
    }
}

/* x, the upper 12 bits of its significand, and the rest. */
static void student_split(double x, double *out)
{
    float whole = (float)x;
    uint32_t bits;
    memcpy(&bits, &whole, sizeof bits);
    bits &= 0xfffff000u;
    memcpy(&whole, &bits, sizeof whole);
    out[0] = x;
    out[1] = whole;
    out[2] = x - out[1];
}

/* Values of (1 - P)/(1 - d) and B at the nodes for one n. */
static void student_nodes(double n, double m0, double p[STUDENT_NODES], double b[STUDENT_NODES])
{
    const double a = STUDENT_A;
    double root = sqrt(n), low = a / (a + root);
    int i;
    for (i = 0; i < STUDENT_NODES; i++) {
        double node = aspi_sincos2pi_64(0.25 * (2 * i + 1) / STUDENT_NODES).x;
        double d = 0.5 * ((1 + low) + (1 - low) * node);
        double h = a / d - a;                          /* x/g */
        double g = 1 / sqrt((1 - h / root) * (1 + h / root));
        double t_m, j_m;
        student_exact(n, m0, h * g, &t_m, &j_m);
        p[i] = (1 - j_m / (d * d)) / (1 - d);
        b[i] = t_m * g / d * (2 * n / (2 * n - 1));
    }
}

static double student_m0(double n)
{
    return aspi_gamma_ratio(n) * n / (sqrt(ASP_PI) * (2 * n - 1));
}

/* R at the nodes of one precision: solves T(q) = u for the marginal of m by Halley's method on log T,
 * which is nearly linear in sqrt q. T0, b: of m. */
static void student_quantile(double m, double t0, const double b[24], double end,
                             double r[STUDENT_NODES])
{
    const double a = STUDENT_A;
    double low = a / (a + sqrt(m));
    int i, j, step;
    for (i = 0; i < STUDENT_NODES; i++) {
        double node = 0.5 * end * (1 + aspi_sincos2pi_64(0.25 * (2 * i + 1) / STUDENT_NODES).x);
        double l = STUDENT_Y_K * node / (1 - node);
        double h = sqrt(-aspi_expm1_64(-l));                     /* 1 - 2u */
        double target = -l - aspi_log_64(2 * (1 + h));           /* log u */
        double root = sqrt(l);
        for (step = 0; step < 6; step++) {
            double q = root * root, e = aspi_expm1_64(-0.5 * q / m);
            double x = sqrt(m * -e * (2 + e)), w = 1 + e, d = a / (a + x);
            double t = (2 * d - (1 + low)) / (1 - low), sum = 0, value, g, g1, g2;
            for (j = 23; j >= 0; j--)
                sum = sum * t + b[j];
            value = t0 * aspi_exp_64(-q) * d * sum;
            g = aspi_log_64(value) - target;
            g1 = -2 * t0 * aspi_exp_64(-q) * (root / x) / value;
            g2 = g1 * (-2 * root + 1 / root - root * (w / x) * (w / x) - g1);
            root -= g / g1 / (1 - 0.5 * g * g2 / (g1 * g1));
        }
        r[i] = root / sqrt(l);
    }
}

/* 2^58 is infinity: the density's relative error is then x^2/(2n) < 1e-12 for e^-x > 1e-308 */
static double student_n(double n) { return n < 0x1p58 ? n : 0x1p58; }

void aspi_student_prepare_area(asp_ndf *out, double n_wanted)
{
    const double a = STUDENT_A;
    double n = student_n(n_wanted), p[STUDENT_NODES], b[STUDENT_NODES], low = a / (a + sqrt(n)), *t = out->table;

    memset(t, 0, sizeof out->table);
    student_split(1 / n, t + STUDENT_INVN);
    student_split(n + 1, t + STUDENT_GAMMA);
    student_split(n, t + STUDENT_N);
    t[STUDENT_M0] = student_m0(n);
    t[STUDENT_T0] = student_m0(n) * (2 * n - 1) / (2 * n);
    t[STUDENT_SCALE] = 2 / (1 - low);
    t[STUDENT_OFFSET] = -(1 + low) / (1 - low);
    t[STUDENT_BETA] = (n - 0.5) / n;
    t[STUDENT_INV_BETA] = n / (n - 0.5);
    t[STUDENT_BELOW] = 1 / (2 * n - 1);
    student_nodes(n, t[STUDENT_M0], p, b);
    aspi_student_coefficients(p, 12, t + STUDENT_P32);
    aspi_student_coefficients(p, 24, t + STUDENT_P64);
    aspi_student_coefficients(b, 12, t + STUDENT_B32);
    aspi_student_coefficients(b, 24, t + STUDENT_B64);
}

void aspi_student_prepare(asp_ndf *out, double n)
{
    double m = student_n(n) + 0.5, p[STUDENT_NODES], b[STUDENT_NODES], bm[24], t0, *t = out->table;
    aspi_student_prepare_area(out, n);
    t[STUDENT_Y_N] = m;
    t[STUDENT_Y_N + 1] = 1 / m;
    t[STUDENT_Y_WIDTH] = sqrt(student_n(n) / m);
    student_nodes(m, student_m0(m), p, b);
    aspi_student_coefficients(b, 24, bm);
    t0 = student_m0(m) * (2 * m - 1) / (2 * m);
    student_quantile(m, t0, bm, STUDENT_Y_END_64, p);
    aspi_student_coefficients(p, 26, t + STUDENT_Y64);
    aspi_student_fit(out);
}

#undef STUDENT_NODES
#undef ASP_PRECISION
