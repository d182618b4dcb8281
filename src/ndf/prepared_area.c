/* prepared_area.c - the tables of the projected area of a prepared surface */
#include "ndf/prepared_make.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"

/* x^2 and x^2 (x - atan x) for x = e^(j h), all j that occur. */
#define AREA_STEP 0.2
#define AREA_FIRST (-80)
#define AREA_LAST 400

typedef struct prepared_kernels {
    double x2[AREA_LAST - AREA_FIRST + 1], weight[AREA_LAST - AREA_FIRST + 1];
} prepared_kernels;

static void prepared_kernel(prepared_kernels *out)
{
    int j;
    for (j = AREA_FIRST; j <= AREA_LAST; j++) {
        double x = aspi_exp_64(AREA_STEP * j), z = x * x;
        out->x2[j - AREA_FIRST] = z;
        out->weight[j - AREA_FIRST] = z * (x < 0.1
            ? x * z * (1.0 / 3 - z * (1.0 / 5 - z * (1.0 / 7 - z * (1.0 / 9 - z / 11))))
            : x - aspi_atan_64(x, 1));
    }
}

/* log of J(mu)/P22(mu): J = integral of 2 P22(mu^2 + rho^2) rho^2 (rho - mu atan(rho/mu)) d log rho by the
 * trapezoidal rule, rho = mu e^(j h). Before the first term and beyond log rho = `high` the integrand is taken
 * for a power, whose terms are a geometric series. */
static double prepared_log_far(const prepared_source *s, const prepared_kernels *kernel, double mu)
{
    double m2 = mu * mu, base = aspi_prepared_log(s, m2), sum = 0, term = 0, last = 0, first = 0;
    double t = aspi_log_64(mu), end = aspi_max_64(s->high, t + 7);
    int j, start = (int)((s->low + 13 - t) / AREA_STEP);
    start = start < AREA_FIRST ? AREA_FIRST : start;
    for (j = start; j <= AREA_LAST; j++) {
        const int i = j - AREA_FIRST;
        last = term;
        term = aspi_exp_64(aspi_prepared_log(s, m2 + m2 * kernel->x2[i]) - base) * kernel->weight[i];
        sum += term;
        if (j == start)
            first = term;
        if (j == start + 1 && term > first)
            sum += first * first / (term - first);
        if (term < last && (term < 1e-10 * sum || t + AREA_STEP * j > end))
            break;
    }
    if (term > 0 && term < last)
        sum += term * term / (last - term);
    return aspi_log_64(2 * AREA_STEP * m2 * mu * sum);
}

/* The same at mu = 0: 2 P22 rho^3 per log rho. */
double aspi_prepared_edge_on(const prepared_source *s)
{
    double sum = 0, term = 0, last = 0, t;
    for (t = s->low; t < 200; t += AREA_STEP) {
        last = term;
        term = aspi_exp_64(aspi_prepared_log(s, aspi_exp_64(2 * t)) + 3 * t);
        sum += term;
        if (term < last && (term < 1e-17 * sum || t > s->high))
            break;
    }
    if (term > 0 && term < last)
        sum += term * term / (last - term);
    return 2 * AREA_STEP * sum;
}

void aspi_prepared_area_tables(const prepared_source *s, double t0, double *out)
{
    const int n = PREPARED_AREA_CELLS, m = PREPARED_BELOW_CELLS;
    prepared_kernels kernel;
    double area[PREPARED_AREA_CELLS + 1], below[PREPARED_BELOW_CELLS + 1];
    int i;
    prepared_kernel(&kernel);
    area[0] = 1;
    for (i = 1; i < n; i++) {
        double root = (double)i / (n - i), mu = t0 * root * root;
        area[i] = aspi_exp_64(prepared_log_far(s, &kernel, mu) + aspi_prepared_log(s, mu * mu))
                * (2 * (mu + sqrt(mu * mu + t0 * t0)) / (t0 * t0));
    }
    area[n] = (4 * area[n - 1] - area[n - 2]) / 3;
    aspi_prepared_spline(n, 1.0 / n, area, 1, 0, 0, out + PREPARED_AREA, 1);
    below[0] = aspi_log_64(0.5 / (t0 * t0)) - aspi_prepared_log(s, 0);
    for (i = 1; i < m; i++) {
        double root = (double)i / (m - i), mu = t0 * (root * root) * (root * root);
        /* where P22 is long gone the differences of its logarithm are, too */
        below[i] = aspi_prepared_log(s, mu * mu) < -1e7 ? below[i - 1]
                 : prepared_log_far(s, &kernel, mu) - 1.5 * aspi_log_64(mu * mu + t0 * t0);
    }
    below[m] = below[m - 1];
    aspi_prepared_spline(m, 1.0 / m, below, 1, 0, 0, out + PREPARED_BELOW, 1);
}
