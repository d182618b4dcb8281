/* student_guess.c - what makes the Student-t family fast: sigma from above without a power, and the
 * first guess of the search for visible normals, both fitted once per n */
#include "ndf/student.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"

#define STUDENT_TERMS (STUDENT_DEGREE * STUDENT_ACROSS)
#define STUDENT_VIEWS 12
#define STUDENT_ROOTS 14

static double student_power(double n, double p, double x)    /* (1 + x^2/n)^-p */
{
    return aspi_exp_64(-p * aspi_log1p_64(x * x / n));
}

/* J(x), by the polynomial that sigma is made of. */
static double student_far_side(const asp_ndf *k, double x)
{
    double n = k->table[STUDENT_N], g = sqrt(1 + x * x / n), d = STUDENT_A * g / (x + STUDENT_A * g);
    double t = d * k->table[STUDENT_SCALE] + k->table[STUDENT_OFFSET], sum = 0;
    int i;
    for (i = 23; i >= 0; i--)
        sum = sum * t + k->table[STUDENT_P64 + i];
    return k->table[STUDENT_M0] * g * student_power(n, n, x) * d * d * (1 - (1 - d) * sum);
}

/* T(x) */
static double student_tail(const asp_ndf *k, double x)
{
    double n = k->table[STUDENT_N], g = sqrt(1 + x * x / n), d = STUDENT_A * g / (x + STUDENT_A * g);
    double t = d * k->table[STUDENT_SCALE] + k->table[STUDENT_OFFSET], sum = 0;
    int i;
    for (i = 23; i >= 0; i--)
        sum = sum * t + k->table[STUDENT_B64 + i];
    return k->table[STUDENT_T0] * student_power(n, n, x) * d * sum;
}

/* ------------------------------------------------------------------ sigma from above */

/* ((sigma - w)/(den - w) - at_0)/x at the nodes for s = 1, den = a w + sqrt(b w^2 + k), x = w/den; at_0
 * the quotient at w = 0. */
static double student_above_nodes(const asp_ndf *k, const double form[3], double x[32], double value[32])
{
    double root = sqrt(form[2]), at_0 = k->table[STUDENT_M0] / root;
    int i;
    for (i = 0; i < 32; i++) {
        double w, rest;
        x[i] = 0.5 * (1 + aspi_sincos2pi_64(0.25 * (2 * i + 1) / 32).x);
        if (form[0] > 0) {
            w = root * x[i] / (1 - x[i]);
            rest = root;
        } else {
            w = root * x[i] / sqrt((1 - x[i]) * (1 + x[i]));
            rest = form[2] / (w + sqrt(w * w + form[2]));
        }
        value[i] = (student_far_side(k, w) / rest - at_0) / x[i];
    }
    return at_0;
}

/* Chooses among den = sqrt(w^2 + 8 s^2), best where the tails are light and for n = 1, and w + sqrt(K) s.
 * Below n = 0.98 none is close enough. */
static void student_fit_above(asp_ndf *out)
{
    static const double forms[4][3] = { { 0, 1, 8 }, { 1, 0, 1 }, { 1, 0, 2 }, { 1, 0, 8 } };
    double best = 2e-7;
    int f, i, j;
    for (f = 0; f < 4; f++) {
        double x[32], value[32], c[18], worst = 0;
        double at_0 = student_above_nodes(out, forms[f], x, value);
        aspi_student_coefficients(value, 18, c);
        for (i = 0; i < 32; i++) {
            double sum = 0, error;
            for (j = 17; j >= 0; j--)
                sum = sum * (2 * x[i] - 1) + c[j];
            /* of sigma/den = x + (1 - x) (at_0 + x value) */
            error = (1 - x[i]) * x[i] * (sum - value[i]) / (x[i] + (1 - x[i]) * (at_0 + x[i] * value[i]));
            error = error < 0 ? -error : error;
            worst = error > worst ? error : worst;
        }
        if (worst < best) {
            best = worst;
            out->table[STUDENT_ABOVE] = 1;
            memcpy(out->table + STUDENT_LINEAR, forms[f], sizeof forms[f]);
            out->table[STUDENT_S32] = at_0;
            memcpy(out->table + STUDENT_S32 + 1, c, sizeof c);
        }
    }
}

/* ------------------------------------------------------------------ first guess */

/* One row of the least squares. */
typedef struct student_guess_point {
    double own, view, value, weight;
} student_guess_point;

/* 1/(sqrt y_0 + e) of the right side over the view, for all = 1 (student_aim in student_visible.h). */
static void student_fit_scale(asp_ndf *out)
{
    double scale[32];
    int i;
    for (i = 0; i < 32; i++) {
        double view = 0.5 * (1 + aspi_sincos2pi_64(0.25 * (2 * i + 1) / 32).x);
        double mu = STUDENT_VIEW * view / (1 - view), far = student_far_side(out, mu);
        double all = 0.5 * mu + out->table[STUDENT_M0], right = mu + far - all;
        scale[i] = sqrt(all) / (sqrt(right > 0 ? right : 0) + sqrt(2 * far));
    }
    aspi_student_coefficients(scale, 14, out->table + STUDENT_SCALE_RIGHT);
}

static double student_polynomial(const double *c, int count, double t)
{
    double sum = 0;
    while (count-- > 0)
        sum = sum * t + c[count];
    return sum;
}

/* The points of one side: for each view slopes on a grid, from which the guess's own argument
 * follows; nothing is searched. side 1: left, -1: right (student_search in student_kernel.h). */
static int student_guess_points(const asp_ndf *k, int side, student_guess_point *p)
{
    const double n = k->table[STUDENT_N], m0 = k->table[STUDENT_M0], p0 = 2 * k->table[STUDENT_T0];
    int i, j, count = 0;
    for (j = 0; j < STUDENT_VIEWS; j++) {
        double view = 0.5 * (1 + aspi_sincos2pi_64(0.25 * (2 * j + 1) / STUDENT_VIEWS).x);
        double mu = STUDENT_VIEW * view / (1 - view), far = student_far_side(k, mu), sigma = mu + far;
        double all = 0.5 * mu + m0, at = side > 0 ? all : sigma - all;
        double shift = side > 0 ? 0 : far;
        double scale = student_polynomial(k->table + STUDENT_SCALE_RIGHT, 14, 2 * view - 1);
        double slope = side > 0 ? mu * p0 / all : STUDENT_SLOPE;
        double beta = 1 - 0.5 / n, end = 2 * STUDENT_FAR_END / (beta > 0.15 ? beta : 0.15);
        if (side < 0) {
            double q = n * aspi_log1p_64(mu * mu / n);
            end = q < 30 ? q : 30;
        }
        scale = side > 0 ? 1 : scale;
        end = sqrt(end);
        for (i = 0; i < STUDENT_ROOTS; i++) {
            double r = 0.5 * end * (1 + aspi_sincos2pi_64(0.25 * (2 * i + 1) / STUDENT_ROOTS).x);
            double x = sqrt(n * aspi_expm1_64(r * r / n)), y, exponent, root, g2, dy;
            y = mu * student_tail(k, x) + side * m0 * student_power(n, n - 0.5, x) + shift;
            if (!(y > 1e-14 * at))
                continue;
            exponent = -aspi_log_64((sqrt(y / all) + sqrt(2 * shift / all)) * scale);
            if (!(exponent < STUDENT_FAR_END && exponent > (side > 0 ? 1e-9 : 1e-2)))
                continue;
            root = sqrt(slope * slope + 8 * exponent) - slope;
            /* -r dy/dr = (c + side s x) P2 r dx/dr, dx/dr = r (1 + x^2/n)/x */
            g2 = 1 + x * x / n;
            dy = (mu + side * x) * p0 * student_power(n, n + 0.5, x) * (r * r * g2 / x);
            p[count].own = root;
            p[count].view = 2 * view - 1;
            p[count].value = r / root;
            p[count].weight = dy * root / r * (1 / sigma + 0.05 / (y > 1e-6 * at ? y : 1e-6 * at)) + 1e-3;
            count++;
        }
    }
    return count;
}

/* Least squares by the normal equations, which are well enough conditioned for a guess: Cholesky. */
static void student_solve(double a[STUDENT_TERMS][STUDENT_TERMS], double *b)
{
    int i, j, m;
    for (j = 0; j < STUDENT_TERMS; j++) {
        double s = a[j][j], inverse;
        for (m = 0; m < j; m++)
            s -= a[j][m] * a[j][m];
        inverse = 1 / sqrt(s > 1e-30 ? s : 1e-30);
        a[j][j] = inverse;
        for (i = j + 1; i < STUDENT_TERMS; i++) {
            s = a[i][j];
            for (m = 0; m < j; m++)
                s -= a[i][m] * a[j][m];
            a[i][j] = s * inverse;
        }
        s = b[j];
        for (m = 0; m < j; m++)
            s -= a[j][m] * b[m];
        b[j] = s * inverse;
    }
    for (j = STUDENT_TERMS - 1; j >= 0; j--) {
        for (m = j + 1; m < STUDENT_TERMS; m++)
            b[j] -= a[m][j] * b[m];
        b[j] *= a[j][j];
    }
}

static void student_fit_guess(asp_ndf *out, int side)
{
    student_guess_point p[STUDENT_VIEWS * STUDENT_ROOTS];
    double a[STUDENT_TERMS][STUDENT_TERMS] = {{0}}, b[STUDENT_TERMS] = {0}, end = 0;
    int count = student_guess_points(out, side, p), i, j, m;
    for (i = 0; i < count; i++)
        end = p[i].own > end ? p[i].own : end;
    for (i = 0; i < count; i++) {
        double x = 2 * p[i].own / end - 1, row[STUDENT_TERMS], v = p[i].weight;
        for (j = 0; j < STUDENT_ACROSS; j++) {
            double t = v;
            for (m = 0; m < STUDENT_DEGREE; m++) {
                row[j * STUDENT_DEGREE + m] = t;
                t *= x;
            }
            v *= p[i].view;
        }
        for (j = 0; j < STUDENT_TERMS; j++) {
            for (m = 0; m <= j; m++)
                a[j][m] += row[j] * row[m];
            b[j] += row[j] * p[i].value * p[i].weight;
        }
    }
    for (j = 0; j < STUDENT_TERMS; j++)
        a[j][j] *= 1 + 1e-13;
    student_solve(a, b);
    out->table[STUDENT_END + (side < 0)] = 2 / end;
    memcpy(out->table + (side < 0 ? STUDENT_RIGHT : STUDENT_LEFT), b, sizeof b);
}

void aspi_student_fit(asp_ndf *out)
{
    double n = out->table[STUDENT_N];
    student_fit_above(out);
    out->table[STUDENT_ONE_LESS] = 1 - 1 / n;
    /* heavier tails need more than one step from it */
    if (n < 0.95 || !(out->table[STUDENT_ABOVE] > 0))
        return;
    out->table[STUDENT_SHORT] = 1;
    student_fit_scale(out);
    student_fit_guess(out, 1);
    student_fit_guess(out, -1);
}

#undef STUDENT_TERMS
#undef STUDENT_VIEWS
#undef STUDENT_ROOTS
#undef ASP_PRECISION
