/* uncertainty.c - how far the data pin the parameters down
 *
 * White 1980: cov = A^-1 B A^-1, A = sum h g g', B = sum over geometries of G G', G the sum of
 * psi g over the channels of a geometry (their errors are not independent), with
 *   squares             h = 1, psi = r
 *   absolute values     h = 2 p(0), psi = sign(r), p(0) the density of errors at 0: counted from all
 *                       r/s with |r/s| < 1/2 and divided by s, the mean |r| of the neighbouring
 *                       geometries (Powell 1984 with a local scale)
 * and g the derivative of a residual by the parameters: the places b of the axes and the colours. A
 * parameter at an end of its range has the derivative towards the inside. Data of one channel have two
 * colours, not six.
 *
 * Nothing is said (infinity) of a parameter without effect, of one whose effect the others imitate to
 * rounding, and of any where there are no more geometries than parameters: B is then 0 for what is
 * not known. */
#include "fit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define P_LIMIT ASP_FIT_PARAMETERS
#define WINDOW 8                       /* neighbours on either side */
#define STEP 1e-4                      /* of b in the differences */
#define INFLATION 1e10                 /* of a variance by the other parameters: nothing is left */

typedef struct work {
    aspi_problem *p;
    const aspi_point *at;
    int     axes, channels, count;
    size_t  n;
    double *d_axis;                    /* axes x n: dS/db */
    double *h, *psi, *slope;           /* 3 n each */
    double  A[P_LIMIT][P_LIMIT], B[P_LIMIT][P_LIMIT];
} work;

static void differentiate(work *w)
{
    aspi_problem *p = w->p;
    for (int k = 0; k < w->axes; k++) {
        double b[ASPI_AXES], *out = w->d_axis + (size_t)k * w->n;
        memcpy(b, w->at->b, sizeof b);
        double up = fmin(w->at->b[k] + STEP, p->box.axis[k].b_high);
        double down = fmax(w->at->b[k] - STEP, p->box.axis[k].b_low);
        memset(out, 0, w->n * sizeof *out);
        b[k] = up;
        if (!aspi_problem_move(p, b))
            continue;
        memcpy(out, p->specular, w->n * sizeof *out);
        b[k] = down;
        int moved = aspi_problem_move(p, b);
        for (size_t i = 0; i < w->n; i++)
            out[i] = moved ? (out[i] - p->specular[i]) / (up - down) : 0;
    }
    aspi_problem_move(p, w->at->b);
}

static void local_scale(size_t n, const double *r, double *h)
{
    for (size_t i = 0; i < n; i++) {
        size_t first = i > WINDOW ? i - WINDOW : 0, last = i + WINDOW < n ? i + WINDOW : n - 1;
        double sum = 0;
        for (size_t j = first; j <= last; j++)
            sum += fabs(r[j]);
        h[i] = (double)(last - first + 1) / fmax(sum, 1e-300);
    }
}

/* h from the residuals in psi, which become signs. */
static void absolute(work *w)
{
    size_t near_zero = 0, all = 3 * w->n;
    for (int c = 0; c < 3; c++)
        local_scale(w->n, w->psi + (size_t)c * w->n, w->h + (size_t)c * w->n);
    for (size_t j = 0; j < all; j++)
        near_zero += fabs(w->psi[j]) * w->h[j] < 0.5;
    double twice = 2 * (double)near_zero / (double)all;
    for (size_t j = 0; j < all; j++) {
        w->h[j] *= twice;
        w->psi[j] = (w->psi[j] > 0) - (w->psi[j] < 0);
    }
}

static void residuals(work *w)
{
    aspi_problem *p = w->p;
    for (int c = 0; c < 3; c++) {
        double *r = w->psi + (size_t)c * w->n, *slope = w->slope + (size_t)c * w->n;
        for (size_t i = 0; i < w->n; i++) {
            p->fit[i] = w->at->colour[c] * ASPI_INV_PI + w->at->colour[3 + c] * p->specular[i];
            w->h[(size_t)c * w->n + i] = 1;
        }
        p->loss->residual(w->n, p->fit, p->set->data[c], p->set->weight, r, slope);
    }
    if (p->loss->power == 1)
        absolute(w);
}

static void accumulate(work *w)
{
    for (size_t i = 0; i < w->n; i++) {
        double G[P_LIMIT] = { 0 };
        for (int c = 0; c < w->channels; c++) {
            size_t j = (size_t)c * w->n + i;
            double g[P_LIMIT] = { 0 };
            for (int k = 0; k < w->axes; k++)
                g[k] = w->slope[j] * w->at->colour[3 + c] * w->d_axis[(size_t)k * w->n + i];
            g[w->axes + c] = w->slope[j] * ASPI_INV_PI;
            g[w->axes + w->channels + c] = w->slope[j] * w->p->specular[i];
            for (int a = 0; a < w->count; a++) {
                G[a] += w->psi[j] * g[a];
                for (int b = 0; b < w->count; b++)
                    w->A[a][b] += w->h[j] * g[a] * g[b];
            }
        }
        for (int a = 0; a < w->count; a++)
            for (int b = 0; b < w->count; b++)
                w->B[a][b] += G[a] * G[b];
    }
}

/* Replaces A by its inverse. Scaled to a unit diagonal; a ridge of rounding size keeps directions
 * that the data do not see finite, and large: `blind` is set for them and for rows without any
 * information, which become 0. */
static void invert(double A[P_LIMIT][P_LIMIT], int n, int *blind)
{
    double s[P_LIMIT], M[P_LIMIT][2 * P_LIMIT] = { { 0 } };
    for (int a = 0; a < n; a++)
        s[a] = A[a][a] > 0 ? 1 / sqrt(A[a][a]) : 0;
    for (int a = 0; a < n; a++) {
        for (int b = 0; b < n; b++)
            M[a][b] = A[a][b] * s[a] * s[b];
        M[a][a] = s[a] > 0 ? 1 + 1e-12 : 1;
        M[a][n + a] = 1;
    }
    for (int a = 0; a < n; a++)                      /* Gauss-Jordan: M is positive definite */
        for (int b = 0; b < n; b++) {
            if (b == a)
                continue;
            double q = M[b][a] / M[a][a];
            for (int k = a; k < 2 * n; k++)
                M[b][k] -= q * M[a][k];
        }
    for (int a = 0; a < n; a++) {
        blind[a] = !(s[a] > 0) || !(M[a][n + a] / M[a][a] < INFLATION);
        for (int b = 0; b < n; b++)
            A[a][b] = M[a][n + b] / M[a][a] * s[a] * s[b];
    }
}

static void sandwich(work *w, double cov[P_LIMIT][P_LIMIT], int *blind)
{
    double AB[P_LIMIT][P_LIMIT] = { { 0 } };
    int n = w->count;
    int few = w->n <= (size_t)n;
    double more = few ? 1 : (double)w->n / (double)(w->n - (size_t)n);
    invert(w->A, n, blind);
    for (int a = 0; a < n; a++)
        blind[a] |= few;
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++)
            for (int k = 0; k < n; k++)
                AB[a][b] += w->A[a][k] * w->B[k][b];
    for (int a = 0; a < n; a++)
        for (int b = 0; b < n; b++) {
            double sum = 0;
            for (int k = 0; k < n; k++)
                sum += AB[a][k] * w->A[k][b];
            cov[a][b] = more * sum;
        }
}

static void describe_axis(const aspi_axis *axis, double b, double sd, asp_fit_parameter *out)
{
    double one = aspi_axis_value(axis, fmax(b - sd, axis->b_low));
    double two = aspi_axis_value(axis, fmin(b + sd, axis->b_high));
    int inverse = axis->scale == ASPI_SCALE_INVERSE;
    snprintf(out->name, sizeof out->name, "%s", axis->name);
    out->value = aspi_axis_value(axis, b);
    out->low = fmin(one, two);
    out->high = fmax(one, two);
    double step = 1e-6, slope = fabs(aspi_axis_value(axis, fmin(b + step, axis->b_high))
                                     - aspi_axis_value(axis, fmax(b - step, axis->b_low)))
                              / (fmin(b + step, axis->b_high) - fmax(b - step, axis->b_low));
    out->uncertainty = isfinite(out->value) ? slope * sd : INFINITY;
    double margin = 1e-9;
    out->at_bound = b <= axis->b_low + margin ? -1 : b >= axis->b_high - margin ? 1 : 0;
    if (inverse)
        out->at_bound = -out->at_bound;
    double least = aspi_axis_value(axis, axis->b_low), most = aspi_axis_value(axis, axis->b_high);
    int leaves = b - sd < axis->b_low || b + sd > axis->b_high
              || out->value - out->uncertainty < fmin(least, most)
              || out->value + out->uncertainty > fmax(least, most);
    out->determined = sd < 0.25 * (axis->b_high - axis->b_low) && (out->at_bound || !leaves);
}

#define OPEN 0.05           /* a colour known better than this may reach past the end of its range */

static void describe_colour(const char *name, double value, double sd, double highest,
                            asp_fit_parameter *out)
{
    snprintf(out->name, sizeof out->name, "%s", name);
    out->value = value;
    out->uncertainty = sd;
    out->low = fmax(0, value - sd);
    out->high = fmin(value + sd, highest);
    out->at_bound = value > 0 ? value < highest ? 0 : 1 : -1;
    int leaves = sd > OPEN && (value - sd < 0 || value + sd > highest);
    out->determined = (sd < 0.25 || sd < 0.5 * value) && (out->at_bound || !leaves);
}

asp_status aspi_uncertainties(aspi_problem *p, const aspi_point *at, asp_fit_result *out,
                              asp_error *err)
{
    static const char *const grey[] = { "diffuse", "specular" };
    static const char *const rgb[] = { "diffuse_r", "diffuse_g", "diffuse_b", "specular_r",
                                       "specular_g", "specular_b" };
    int axes = p->box.n, channels = p->set->channels;
    size_t n = p->set->n;
    work *w = calloc(1, sizeof *w);
    double *memory = malloc(((size_t)axes + 9) * n * sizeof *memory);
    if (!w || !memory) {
        free(w);
        free(memory);
        return asp_fail(err, ASP_ENOMEM, "", "not enough memory for the uncertainties");
    }
    w->p = p;
    w->at = at;
    w->axes = axes;
    w->channels = channels;
    w->count = axes + 2 * channels;
    w->n = n;
    w->d_axis = memory;
    w->h = memory + (size_t)axes * n;
    w->psi = w->h + 3 * n;
    w->slope = w->psi + 3 * n;
    differentiate(w);
    residuals(w);
    accumulate(w);
    int blind[P_LIMIT];
    double cov[P_LIMIT][P_LIMIT];
    sandwich(w, cov, blind);
    out->parameter_count = (size_t)w->count;
    for (int a = 0; a < w->count; a++) {
        double sd = blind[a] ? INFINITY : sqrt(fmax(0, cov[a][a]));
        int k = a - axes, specular = k >= channels;
        if (a < axes)
            describe_axis(&p->box.axis[a], at->b[a], sd, &out->parameter[a]);
        else
            describe_colour((channels == 1 ? grey : rgb)[k],
                            at->colour[specular ? 3 + k - channels : k], sd,
                            specular ? p->specular_high : DIFFUSE_HIGH, &out->parameter[a]);
        for (int b = 0; b < w->count; b++) {
            double both = sqrt(cov[a][a] * cov[b][b]);
            out->correlation[a * P_LIMIT + b] = blind[a] || blind[b] || !(both > 0)
                                              ? NAN : fmin(1, fmax(-1, cov[a][b] / both));
        }
    }
    free(memory);
    free(w);
    return ASP_OK;
}
