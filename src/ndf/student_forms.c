/* student_forms.c - the masking of Student's t as its paper writes it, beside the exact one
 *
 * Ribardiere, Bringier, Meneveaux, Simonot 2017, eqs. 13-15 and 21-23, for study and for the paper's
 * figures: evaluation uses none of it. nu = cot(theta_v)/sigma, n = gamma - 1, q = nu^2/n. Every form is
 *
 *     Lambda = a [n^(3/2) (1 + q)^(3/2 - gamma) / (nu (2 gamma - 3)) + sqrt n S2] - 1/2,
 *     a = Gamma(gamma - 1/2) / (sqrt pi Gamma(gamma))
 *
 * (eq. 13 with the powers of n drawn together) or, with the same a, eq. 21; they differ in S2 and in
 * where the 1/2 went. */
#include "asperity_study.h"
#include "ndf/student.h"

#define ASP_PRECISION 64
#include "asperity/elementary.h"

extern const asp_model asp_model_student_t;

typedef double form_lambda(double gamma, double nu);

/* The first term of eqs. 13 and 21 without a: int_nu^inf q P2 dq / nu. */
static double form_first_term(double n, double nu)
{
    double e = aspi_exp_64((0.5 - n) * aspi_log1p_64(nu * nu / n));
    return n * sqrt(n) * e / (nu * (2 * n - 1));
}

/* Gamma(gamma - 1/2) / (sqrt pi Gamma(gamma)). */
static double form_gamma_factor(double n) { return aspi_gamma_ratio(n) / sqrt(n * ASP_PI); }

static double form_exact(double gamma, double nu)
{
    asp_ndf k;
    memset(&k, 0, sizeof k);
    aspi_student_prepare_area(&k, gamma - 1);
    k.map.m00 = k.map.m11 = 1;
    return asp_model_student_t.f64.sigma(&k, 1, 0, -nu) / nu;
}

/* ---- eq. 13 */

/* 2F1(1/2, b; 3/2; -q), b = n + 1/2 > 1, q >= 0. Where q is small, Pfaff's transformation makes all terms
 * positive: (1 + q)^-b 2F1(1, b; 3/2; q/(1 + q)). Else the connection to infinity: one power and
 * -(1 + q)^-b/(2b - 1) 2F1(1, b; b + 1/2; 1/(1 + q)), which is positive again, and from b log(1 + q) =
 * 40 on below rounding. At most 300 terms; 1e-14 for every b and q. */
static double form_2f1(double b, double q)
{
    double l = b * aspi_log1p_64(q), power = aspi_exp_64(-l);
    double n = b - 0.5, term = 1, sum = 1, k;
    if (q <= 1 && l < 40) {
        double y = q / (1 + q);
        for (k = 0; k < 2000 && term > 1e-17 * sum; k++) {
            term *= (b + k) / (1.5 + k) * y;
            sum += term;
        }
        return power * sum;
    }
    for (k = 0; l < 40 && k < 100 && term > 1e-17 * sum; k++) {
        term *= (b + k) / (b + 0.5 + k) / (1 + q);
        sum += term;
    }
    /* Gamma(3/2) Gamma(b - 1/2) / Gamma(b) = sqrt pi / (2 sqrt n R(n)) */
    return 0.5 * sqrt(ASP_PI / (n * q)) / aspi_gamma_ratio(n) - power * sum / (2 * b - 1);
}

static double form_hypergeometric(double gamma, double nu)
{
    double n = gamma - 1, s2 = nu * form_2f1(gamma - 0.5, nu * nu / n);
    return form_gamma_factor(n) * (form_first_term(n, nu) + sqrt(n) * s2) - 0.5;
}

/* ---- eq. 21, its 4 gamma - 1 read as 4^(gamma - 1) */

static double form_integer_sum(double gamma, double nu)
{
    double n = gamma - 1, t = nu / sqrt(n + nu * nu);
    double a1 = 1, a2 = 0, binomial = 1, power = t, k;
    for (k = 1; k <= n; k++)                /* (2n)! / (4^n n!^2) */
        a1 *= (2 * k - 1) / (2 * k);
    for (k = 0; k <= gamma - 2; k++) {
        a2 += binomial / (2 * k + 1) * (1 - power);
        binomial *= -(gamma - 2 - k) / (k + 1);
        power *= t * t;
    }
    return a1 * (form_first_term(n, nu) - n * a2);
}

static double form_half_integer_sum(double gamma, double nu)
{
    double n = gamma - 1, m = 2 * gamma - 3;      /* an even number */
    double angle = aspi_atan_64(nu, sqrt(n)), a1 = 0, a21 = 0, binomial = 1, scale = 1, k;
    for (k = 0; k <= gamma - 1.5; k++) {
        a1 += binomial / (2 * k + 1);
        binomial *= -(gamma - 1.5 - k) / (k + 1);
    }
    binomial = 1;
    for (k = 0; k <= gamma - 2.5; k++) {
        double turns = (m - 2 * k) * angle * (0.5 / ASP_PI);
        a21 -= binomial / (m - 2 * k) * aspi_sincos2pi_64(turns).y;
        binomial *= (m - k) / (k + 1);
        scale *= 0.25;                            /* 2^-m in the end */
    }
    /* A22's binomial is the next one */
    return 2 / ASP_PI * a1 * (form_first_term(n, nu)
                              - n * scale * (2 * a21 + binomial * (0.5 * ASP_PI - angle)));
}

/* ---- eqs. 22 and 23 */

static double form_cubic(const double c[4], double x)
{
    return c[0] + x * (c[1] + x * (c[2] + x * c[3]));
}

static double form_ratio(const double c[8], double x)
{
    return form_cubic(c, x) / form_cubic(c + 4, x);
}

static double form_rational(double gamma, double z)
{
    static const double f21[8] = { 0, 1.066, 2.655, 4.892, 1.038, 2.969, 4.305, 4.418 };
    static const double f22[8] = { 14.402, -27.145, 20.574, -2.745, -30.612, 86.567, -84.341, 29.938 };
    static const double f23[8] = { -129.404, 324.987, -299.305, 93.268,
                                   -92.609, 256.006, -245.663, 86.064 };
    static const double f24[8] = { 6.537, 6.074, -0.623, 5.223, 6.538, 6.103, -3.218, 6.347 };
    double n = gamma - 1;
    double s2 = form_ratio(f21, z) * (form_ratio(f22, gamma) + form_ratio(f23, gamma) * form_ratio(f24, z));
    return form_gamma_factor(n) * (form_first_term(n, z) + sqrt(n) * s2) - 0.5;
}

/* ---- by name */

static const struct form_row {
    const char *name;
    form_lambda *lambda;
    double low, high;
    int low_open;
    int whole;                   /* 1: gamma - low must be a whole number */
    const char *what;
} form_rows[] = {
    { "exact", form_exact, 1.5, INFINITY, 1, 0, "" },
    { "hypergeometric", form_hypergeometric, 1.5, 1e6, 1, 0, "" },
    { "integer", form_integer_sum, 2, 500, 0, 1, "the integer sum needs gamma = 2, 3, 4, ..." },
    { "half_integer", form_half_integer_sum, 2.5, 499.5, 0, 1,
      "the half-integer sum needs gamma = 2.5, 3.5, 4.5, ..." },
    { "rational", form_rational, 1.5, 1e6, 1, 0, "" },
};

asp_status asp_student_lambda(const char *form, double gamma, double nu, double *out, asp_error *err)
{
    const struct form_row *row = NULL;
    size_t i;
    for (i = 0; i < sizeof form_rows / sizeof *form_rows; i++)
        if (!strcmp(form_rows[i].name, form))
            row = &form_rows[i];
    if (!row)
        return asp_fail(err, ASP_EUNKNOWN, form,
                        "no such form: exact, hypergeometric, integer, half_integer, rational");
    if (!(gamma <= row->high && (row->low_open ? gamma > row->low : gamma >= row->low)))
        return asp_fail_range(err, "gamma", gamma, row->low, row->low_open, row->high);
    if (row->whole && gamma - row->low != (double)(int)(gamma - row->low)) {
        asp_fail(err, ASP_EINVAL, "gamma", row->what);
        if (err)
            err->value = gamma;
        return ASP_EINVAL;
    }
    if (!(nu >= 0))
        return asp_fail_range(err, "nu", nu, 0, 0, INFINITY);
    *out = nu > 0 ? row->lambda(gamma, aspi_min_64(nu, 1e50)) : (double)INFINITY;
    return ASP_OK;
}

#undef ASP_PRECISION
