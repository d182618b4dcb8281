/* make.c - rough surfaces with known slope statistics
 *
 * A stationary Gaussian process has Gaussian slopes, that is Beckmann's distribution with
 * alpha = sqrt(2) times the rms slope along an axis. Multiplied by a slowly varying local roughness
 * a(x) its slopes become a mixture of Gaussians; where a^2 = alpha^2 n / tau with tau following the
 * gamma distribution of shape n = gamma - 1, the mixture
 *
 *     integral of tau^(n-1) e^-tau / Gamma(n) * tau/(pi n alpha^2) exp(-tau p^2/(n alpha^2)) dtau
 *         = (1 + p^2/(n alpha^2))^-gamma / (pi alpha^2)
 *
 * is the Student's t-distribution of STD (Ribardiere et al. 2017, eq. 11). */
#include "core/rng.h"
#include "surface/surface.h"

#include <math.h>
#include <stdlib.h>

asp_surface_recipe asp_surface_recipe_default(void)
{
    return (asp_surface_recipe){ .seed = 1, .size = 1024, .correlation = 4, .patch = 8,
                                 .alpha = 0.2, .gamma = 3 };
}

static asp_status check(const asp_surface_recipe *r, asp_error *err)
{
    if (r->size < 64 || r->size > 4096)
        return asp_fail_range(err, "size", r->size, 64, 0, 4096);
    if (r->size & (r->size - 1))
        return asp_fail(err, ASP_EINVAL, "size", "not a power of two");
    if (!(r->correlation >= 2 && r->correlation <= r->size / 8.0))
        return asp_fail_range(err, "correlation", r->correlation, 2, 0, r->size / 8.0);
    if (!(r->alpha >= 1e-3 && r->alpha <= 1))
        return asp_fail_range(err, "alpha", r->alpha, 1e-3, 0, 1);
    if (!(r->gamma >= 1.6))
        return asp_fail_range(err, "gamma", r->gamma, 1.6, 0, INFINITY);
    double patches = r->size / (4 * r->correlation);
    if (!isinf(r->gamma) && !(r->patch >= 1 && r->patch <= fmin(64, patches)))
        return asp_fail_range(err, "patch", r->patch, 1, 0, fmin(64, patches));
    return ASP_OK;
}

/* ---- Gaussian process */

/* A periodic real process with correlation exp(-r^2/length^2), hence power ~ exp(-k^2 length^2/4):
 * one random phase per pair of waves +-k and no random amplitude, so that the variance of every
 * realisation is exact and, of many waves, the values are Gaussian. The result is in data[].re.
 * Returns the mean square of the differences between neighbours along x (that along y is equal). */
static double process(aspi_complex *data, aspi_complex *roots, int n, double length,
                      uint64_t start)
{
    double step = 2 * ASPI_PI / n, square = 0;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) {
            int kx = x < n / 2 ? x : x - n, ky = y < n / 2 ? y : y - n;
            size_t at = (size_t)y * (size_t)n + (size_t)x;
            double phase = 2 * ASPI_PI * aspi_unit64(aspi_random_at(start, at));
            /* half of the plane: the other half is the conjugate, and -n/2 has no partner */
            int used = (ky > 0 || (ky == 0 && kx > 0)) && kx > -n / 2;
            double k2 = step * step * ((double)kx * kx + (double)ky * ky);
            double amplitude = used ? exp(-k2 * length * length / 8) : 0;
            double s = sin(0.5 * step * kx);
            data[at] = (aspi_complex){ amplitude * cos(phase), amplitude * sin(phase) };
            square += 2 * amplitude * amplitude * s * s;
        }
    aspi_fft2(data, n, roots);
    return square;
}

/* ---- the local roughness */

/* Regularised incomplete gamma functions (DLMF 8.11.4 and 8.9.2): *lower = P(a, x) and *upper =
 * Q(a, x), each accurate where it is small. */
static void incomplete_gamma(double a, double x, double *lower, double *upper)
{
    double front = exp(a * log(x) - x - lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (int k = 1; k < 1000 && term > 1e-17 * sum; ++k)
            sum += term *= x / (a + k);
        *lower = front * sum;
        *upper = 1 - *lower;
        return;
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;          /* Lentz's method */
    for (int k = 1; k < 1000; ++k) {
        double an = k * (a - k);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        h *= d * c;
        if (fabs(d * c - 1) < 1e-15)
            break;
    }
    *upper = front * h;
    *lower = 1 - *upper;
}

/* log tau at which the gamma distribution of shape a has the given logit = log(P/Q), by bisection */
static double log_quantile(double a, double logit)
{
    double low = -800, high = log(a + 60 * sqrt(a) + 800);
    for (int i = 0; i < 70; ++i) {
        double middle = 0.5 * (low + high), p, q;
        incomplete_gamma(a, exp(middle), &p, &q);
        if (log(p) - log(q) < logit)
            low = middle;
        else
            high = middle;
    }
    return 0.5 * (low + high);
}

typedef struct ranked { float value; uint32_t index; } ranked;

static int by_value(const void *a, const void *b)
{
    const ranked *p = a, *q = b;
    if (p->value != q->value)
        return p->value < q->value ? -1 : 1;
    return p->index < q->index ? -1 : p->index > q->index;
}

/* Multiplies the heights by sqrt(n / tau): tau falls with the rank of the value of a second process,
 * so that every quantile of tau covers the same area. tau is interpolated in logit(probability). */
static void roughen(float *heights, ranked *order, size_t count, double gamma)
{
    enum { NODES = 1024 };
    double node[NODES + 1], n = gamma - 1, reach = log(2 * (double)count);
    for (int i = 0; i <= NODES; ++i)
        node[i] = log_quantile(n, reach * (2.0 * i / NODES - 1));
    qsort(order, count, sizeof *order, by_value);
    for (size_t rank = 0; rank < count; ++rank) {
        double p = ((double)(count - rank) - 0.5) / (double)count;
        double at = (log(p / (1 - p)) / reach + 1) * 0.5 * NODES;
        int i = at < 0 ? 0 : at >= NODES ? NODES - 1 : (int)at;
        double log_tau = node[i] + (at - i) * (node[i + 1] - node[i]);
        float *h = &heights[order[rank].index];
        *h = (float)(*h * sqrt(n) * exp(-0.5 * log_tau));
    }
}

asp_status asp_height_field_make(const asp_surface_recipe *recipe, asp_height_field *out,
                                 asp_error *err)
{
    asp_status status = check(recipe, err);
    if (status != ASP_OK)
        return status;
    int n = recipe->size, mixed = !isinf(recipe->gamma);
    size_t count = (size_t)n * (size_t)n;
    aspi_complex *data = malloc(count * sizeof *data), *roots = malloc((size_t)n * sizeof *roots);
    float *heights = malloc(count * sizeof *heights);
    ranked *order = mixed ? malloc(count * sizeof *order) : NULL;
    if (data && roots && heights && (order || !mixed)) {
        double square = process(data, roots, n, recipe->correlation,
                                aspi_random_start(recipe->seed, 1));
        double scale = recipe->alpha / sqrt(2 * square);
        for (size_t i = 0; i < count; ++i)
            heights[i] = (float)(scale * data[i].re);
        if (mixed) {
            process(data, roots, n, recipe->correlation * recipe->patch,
                    aspi_random_start(recipe->seed, 2));
            for (size_t i = 0; i < count; ++i)
                order[i] = (ranked){ (float)data[i].re, (uint32_t)i };
            roughen(heights, order, count, recipe->gamma);
        }
        *out = (asp_height_field){ n, n, 1, 1, 1, heights };
        heights = NULL;
    } else {
        status = asp_fail(err, ASP_ENOMEM, "height field", "out of memory");
    }
    free(data);
    free(roots);
    free(heights);
    free(order);
    return status;
}

void asp_height_field_free(asp_height_field *field)
{
    if (!field)
        return;
    free(field->heights);
    *field = (asp_height_field){ 0 };
}
