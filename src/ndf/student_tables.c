/* student_tables.c - what makes the Student-t family fast: sigma from above without a power, and the
 * tables of the visible normals, both fitted once per n */
#include "ndf/student.h"

#define ASP_PRECISION 64
#include "ndf/patches.h"

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

/* ------------------------------------------------------------------ tables of the visible normals */

extern const asp_model asp_model_student_t;

#define STUDENT_NODES 12      /* along x of a patch or an octave, */
#define STUDENT_LINES 8       /* and along y */

/* The polynomial of `terms` coefficients that fits values at the points best, squares weighted: coefficient i is
 * the sum of out[i][j] value[j]. By polynomials that are orthogonal on the points (Stieltjes). */
static void student_fitter(int count, const double *x, const double *weight, int terms,
                           double out[ASP_PATCH_TERMS][STUDENT_NODES])
{
    double now[STUDENT_NODES], last[STUDENT_NODES], c[ASP_PATCH_TERMS] = { 1 }, d[ASP_PATCH_TERMS] = { 0 };
    double length = 0;
    int a, i, j;
    memset(out, 0, sizeof *out * ASP_PATCH_TERMS);
    for (j = 0; j < count; j++) {
        now[j] = 1;
        last[j] = 0;
    }
    for (a = 0; a < terms; a++) {
        double sum = 0, mean = 0, before = length;
        for (j = 0; j < count; j++) {
            sum += weight[j] * now[j] * now[j];
            mean += weight[j] * now[j] * now[j] * x[j];
        }
        length = sum;
        mean /= sum;
        for (i = 0; i <= a; i++)
            for (j = 0; j < count; j++)
                out[i][j] += c[i] * now[j] * weight[j] / sum;
        /* (x - mean) now - ratio last */
        before = a ? length / before : 0;
        for (j = 0; j < count; j++) {
            double next = (x[j] - mean) * now[j] - before * last[j];
            last[j] = now[j];
            now[j] = next;
        }
        for (i = a + 1 < terms ? a + 1 : terms - 1; i >= 0; i--) {
            double next = (i ? c[i - 1] : 0) - mean * c[i] - before * d[i];
            d[i] = c[i];
            c[i] = next;
        }
    }
}

/* Chebyshev points of the first kind. */
static void student_chebyshev(int count, double *x)
{
    int j;
    for (j = 0; j < count; j++)
        x[j] = aspi_sincos2pi_64(0.25 * (2 * j + 1) / count).x;
}

/* r of the slope x */
static double student_r(double n, double x) { return sqrt(n * aspi_log1p_64(x * x / n)); }

/* Octaves of u1 and u2, from what a view along the normal sees. */
static void student_fit_octaves(const asp_ndf *search, asp_ndf *out)
{
    const double n = out->table[STUDENT_N];
    double x[STUDENT_NODES], weight[STUDENT_NODES], fit[ASP_PATCH_TERMS][STUDENT_NODES];
    double zero[STUDENT_NODES] = { 0 }, one[STUDENT_NODES], u[STUDENT_NODES], m[3][STUDENT_NODES], scale = 0.25;
    int octave, i, j;
    student_chebyshev(STUDENT_NODES, x);
    for (j = 0; j < STUDENT_NODES; j++) {
        weight[j] = one[j] = 1;
        x[j] *= 0.5;
    }
    student_fitter(STUDENT_NODES, x, weight, ASP_PATCH_TERMS, fit);
    for (octave = 0; octave < ASP_PATCHES; octave++, scale *= 0.5) {
        for (j = 0; j < STUDENT_NODES; j++)
            u[j] = scale * (1.5 + x[j]);
        asp_model_student_t.f64.visible_n(search, STUDENT_NODES, zero, zero, one, u, u, m[0], m[1], m[2]);
        for (j = 0; j < STUDENT_NODES; j++) {
            double along = m[0][j] / m[2][j], over = m[1][j] / m[2][j] / sqrt(1 + along * along / n);
            double z = student_r(n, along);
            for (i = 0; i < ASP_PATCH_TERMS; i++) {
                out->table[STUDENT_ALONG + i * ASP_PATCHES + octave] += fit[i][j] * z;
                out->table[STUDENT_ACROSS + i * ASP_PATCHES + octave] += fit[i][j] * over;
            }
        }
    }
}

/* A patch: the view'th step of views, z from `low` to `high` on one side. */
static void student_fit_patch(const asp_ndf *search, asp_ndf *out, int view, int right, double low, double high,
                              double *table)
{
    const double n = out->table[STUDENT_N], b = out->table[STUDENT_VIEW + 1], d = out->table[STUDENT_VIEW + 2];
    double z[STUDENT_NODES], y[STUDENT_LINES], weight[STUDENT_NODES], one[STUDENT_LINES], zero[STUDENT_NODES] = { 0 };
    double of_x[ASP_PATCH_TERMS][STUDENT_NODES], of_y[ASP_PATCH_TERMS][STUDENT_NODES];
    double u[STUDENT_NODES], half[STUDENT_NODES], s[STUDENT_NODES], c[STUDENT_NODES], m[3][STUDENT_NODES];
    int i, j, l, p;
    student_chebyshev(STUDENT_NODES, z);
    student_chebyshev(STUDENT_LINES, y);
    for (j = 0; j < STUDENT_NODES; j++) {
        double at = low + 0.5 * (high - low) * (1 + z[j]), x = sqrt(n * aspi_expm1_64(at * at / n));
        double share = student_tail(out, x), w = aspi_exp_64(-0.8 * at * at) + 1e-6;
        /* an error of r counts by the density there */
        weight[j] = w * w;
        u[j] = right ? 1 - share : share;
        half[j] = 0.5;
    }
    for (l = 0; l < STUDENT_LINES; l++)
        one[l] = 1;
    student_fitter(STUDENT_NODES, z, weight, ASP_PATCH_TERMS, of_x);
    student_fitter(STUDENT_LINES, y, one, ASP_PATCH_ROWS, of_y);
    for (l = 0; l < STUDENT_LINES; l++) {
        /* b p + d sqrt p */
        double rest = 1 - (view + 0.5 * (1 + y[l])) / out->table[STUDENT_VIEWS], row[ASP_PATCH_TERMS] = { 0 };
        double root = 2 * rest / (d + sqrt(d * d + 4 * b * rest));
        for (j = 0; j < STUDENT_NODES; j++) {
            c[j] = 1 - root * root;
            s[j] = root * root / out->table[STUDENT_VIEW];
        }
        asp_model_student_t.f64.visible_n(search, STUDENT_NODES, s, zero, c, u, half, m[0], m[1], m[2]);
        for (j = 0; j < STUDENT_NODES; j++) {
            double x = m[0][j] / m[2][j], r = student_r(n, x);
            for (i = 0; i < ASP_PATCH_TERMS; i++)
                row[i] += of_x[i][j] * (x < 0 ? -r : r);
        }
        for (p = 0; p < ASP_PATCH_ROWS; p++)
            for (i = 0; i < ASP_PATCH_TERMS; i++)
                table[(p * ASP_PATCH_TERMS + i) * ASP_PATCHES] += of_y[p][l] * row[i];
    }
}

void aspi_student_fit(asp_ndf *out)
{
    /* the view's a, b, d and steps, the first patch on the right, edges left and right: those of the least error
     * that a search found */
    static const double of_heavy[9] = { 0.82, -0.03, 1.03, 5, 15, 0.88, 2.34, 1.44, 2.36 };
    static const double of_light[9] = { 2, 1, 0, 6, 12, 1.8, 100, 1.2, 2.4 };
    const double n = out->table[STUDENT_N];
    int light = n > 1.5, patch = 0, view, i, j;
    double edge[4], end = 0;
    asp_ndf search;
    student_fit_above(out);
    search = *out;
    memset(&search.map, 0, sizeof search.map);
    search.map.m00 = search.map.m11 = 1;
    student_fit_octaves(&search, out);
    /* heavier tails are too far from those of a view along the normal */
    if (n < 0.97)
        return;
    for (i = ASP_PATCH_TERMS - 1; i >= 0; i--)
        end = out->table[STUDENT_ALONG + i * ASP_PATCHES + ASP_PATCHES - 1] - 0.5 * end;
    memcpy(out->table + STUDENT_VIEW, light ? of_light : of_heavy, sizeof of_light);
    edge[0] = 0;
    for (i = 0; i < 2; i++) {
        memcpy(edge + 1, out->table + STUDENT_EDGES + 2 * i, 2 * sizeof *edge);
        edge[3] = end;
        for (j = 0; j < 3 && edge[j] < end; j++) {
            double last = edge[j + 1] < end ? edge[j + 1] : end;
            out->table[STUDENT_SCALES + 3 * i + j] = 2 / (last - edge[j]);
            for (view = 0; view < (int)out->table[STUDENT_VIEWS]; view++)
                student_fit_patch(&search, out, view, i, edge[j], last, out->table + STUDENT_PATCHES + patch++);
        }
    }
    out->table[STUDENT_SHORT] = 1;
}

#undef STUDENT_NODES
#undef STUDENT_LINES
#undef ASP_PRECISION
