/* oracle.c - visible normals by rejection
 *
 * In the standard frame, the view turned to azimuth 0: mu = cot of its angle, x the slope along it. Since
 * P22(-p) = P22(p), the density (mu - x)+ P22 of visible slopes is the sum of
 *     mu P22 with x turned to -|x| with probability min(1, (mu + |x|)/(2 mu)), nothing rejected;
 *     |x| P22 on |x| > mu, at x = -|x|, accepted with probability 1 - mu/|x|;
 * and from below the mean plane, mu < 0, only of the second with |mu| for mu. */
#include "asperity_study.h"
#include "ndf/student.h"

#define ASP_PRECISION 64
#include "asperity/facet.h"

#define MOST_TRIALS 10000000

extern const asp_model asp_model_student_t, asp_model_beckmann, asp_model_ggx;

/* A stream, and the way to say that it never accepted. */
typedef struct oracle_draw {
    const asp_oracle *o;
    asp_uniforms *next;
    void *state;
    double mu;
} oracle_draw;

/* In (0, 1]. */
static double oracle_uniform(oracle_draw *d) { return 1 - d->next(d->state); }

/* ---- Student's t: slopes as homogeneous (X, Y, W) */

static double oracle_power(double u, double p) { return aspi_exp_64(p * aspi_log_64(u)); }

/* Plain slopes, eqs. 16-17 of the STD paper. */
static asp_vec3 oracle_plain(oracle_draw *d)
{
    double e = aspi_log_64(oracle_uniform(d)), n = d->o->n;
    asp_vec2 t = aspi_sincos2pi_64(d->next(d->state));
    double r = n < INFINITY ? sqrt(n * -aspi_expm1_64(e / n)) : sqrt(-e);
    return aspi_vector_64(r * t.x, r * t.y, n < INFINITY ? aspi_exp_64(0.5 * e / n) : 1);
}

/* The slope across, in units of sqrt(n + x^2): Student's t with 2n + 1 degrees of freedom (Bailey 1994). */
static double oracle_across(oracle_draw *d)
{
    double l = -aspi_log_64(oracle_uniform(d)), n = d->o->n;
    asp_vec2 t = aspi_sincos2pi_64(d->next(d->state));
    return sqrt(n < INFINITY ? aspi_expm1_64(l / (n + 0.5)) : l) * t.x;
}

/* M(mu) = int_mu^inf q P2 dq: the proposals' mass. */
static double oracle_mass(const asp_oracle *o, double mu)
{
    return o->m0 * aspi_exp_64(o->n < INFINITY ? (0.5 - o->n) * aspi_log1p_64(mu * mu / o->n) : -mu * mu);
}

/* |x| from |x| P2 on |x| > mu; 0: rejected. X^2 + n W^2 = 1 (Beckmann: W = 1). */
static int oracle_tail(oracle_draw *d, asp_vec3 *p)
{
    double n = d->o->n, mu = d->mu, u = oracle_uniform(d);
    p->z = n < INFINITY ? oracle_power(u, 1 / (2 * n - 1)) / sqrt(n + mu * mu) : 1;
    p->x = n < INFINITY ? sqrt(aspi_max_64(1 - n * p->z * p->z, 0)) : sqrt(mu * mu - aspi_log_64(u));
    return d->next(d->state) * p->x < p->x - mu * p->z;
}

/* The same from (x^2 - mu^2) P2, n > 3/2: better far below the mean plane. */
static int oracle_far_tail(oracle_draw *d, asp_vec3 *p)
{
    double n = d->o->n, mu = d->mu, a = n - 1.5, u = oracle_uniform(d), v = oracle_uniform(d);
    if (n < INFINITY) {
        p->z = sqrt(oracle_power(u, 1 / a) * oracle_power(v, 1 / (a + 1)) / (n + mu * mu));
        p->x = sqrt(aspi_max_64(1 - n * p->z * p->z, 0));
    } else {
        p->z = 1;
        p->x = sqrt(mu * mu - aspi_log_64(u) - aspi_log_64(v));
    }
    return d->next(d->state) * (p->x + mu * p->z) * p->x < 2 * mu * mu * p->z * p->z;
}

static int oracle_far_better(const asp_oracle *o, double mu)
{
    double n = o->n, a = n - 1.5, m2 = mu * mu;
    double ratio = n < INFINITY ? (n + m2) * (2 * n - 1) / (4 * m2 * a * (a + 1)) : 0.5 / m2;
    return n > 1.5 && ratio < 1;
}

static int oracle_slope(oracle_draw *d, int below, asp_vec3 *p)
{
    double mass = oracle_mass(d->o, d->mu);
    if (!below && d->next(d->state) * (d->mu + mass) < d->mu) {
        *p = oracle_plain(d);
        p->x = aspi_abs_64(p->x);
        if (d->next(d->state) * 2 * d->mu * p->z < d->mu * p->z + p->x)
            p->x = -p->x;
        return 1;
    }
    if (!(below && oracle_far_better(d->o, d->mu) ? oracle_far_tail(d, p) : oracle_tail(d, p)))
        return 0;
    /* sqrt(n + x^2) is 1/W, so that Y is the quantile itself */
    p->x = -p->x;
    p->y = oracle_across(d);
    return 1;
}

/* ---- any radial distribution, by tables in log r */

static double radial_p22(const asp_oracle *o, double r) { return asp_P22(&o->standard, r, 0); }

/* The cell of a mass, counted from `from`, and a radius in it, uniform in log r. */
static double radial_radius(oracle_draw *d, const double *mass, int from, int *cell)
{
    const asp_oracle *o = d->o;
    double want = mass[from] + d->next(d->state) * (mass[ASP_ORACLE_CELLS] - mass[from]);
    int low = from, high = ASP_ORACLE_CELLS;
    while (high - low > 1) {
        int mid = (low + high) / 2;
        if (mass[mid] <= want)
            low = mid;
        else
            high = mid;
    }
    *cell = low;
    return aspi_exp_64(o->first + o->step * (low + d->next(d->state)));
}

/* r accepted against its cell's majorant r_end^k bound, k = 2 for r P22 dr = r^2 P22 dlog r. */
static int radial_accept(oracle_draw *d, double r, int cell, int k)
{
    const asp_oracle *o = d->o;
    double end = aspi_exp_64(o->first + o->step * (cell + 1)), x = r / end;
    return d->next(d->state) * o->bound[cell] < (k == 2 ? x * x : x * x * x) * radial_p22(o, r);
}

static int radial_slope(oracle_draw *d, int below, asp_vec3 *p)
{
    const asp_oracle *o = d->o;
    double l = d->mu > 0 ? (aspi_log_64(d->mu) - o->first) / o->step : 0, r, mass, sine, q;
    int from = l > 0 ? (l < ASP_ORACLE_CELLS ? (int)l : ASP_ORACLE_CELLS - 1) : 0, cell;
    /* 2 int r^2 P22 dr on r > mu, and mu times 2 pi int r P22 dr = 1 */
    mass = 2 * (o->tail[ASP_ORACLE_CELLS] - o->tail[from]);
    p->z = 1;
    if (!below && d->next(d->state) * (d->mu + mass) < d->mu) {
        asp_vec2 t;
        do
            r = radial_radius(d, o->plain, 0, &cell);
        while (!radial_accept(d, r, cell, 2));
        t = aspi_sincos2pi_64(d->next(d->state));
        p->x = r * aspi_abs_64(t.x);
        p->y = r * t.y;
        if (d->next(d->state) * 2 * d->mu < d->mu + p->x)
            p->x = -p->x;
        return 1;
    }
    r = radial_radius(d, o->tail, from, &cell);
    q = d->mu / r;
    if (!(q < 1) || !radial_accept(d, r, cell, 3))
        return 0;
    /* |x| = r cos phi > mu, weight |x|: the sine is uniform within sqrt(1 - q^2) */
    sine = sqrt((1 - q) * (1 + q));
    if (!(d->next(d->state) < sine))
        return 0;
    sine *= 2 * d->next(d->state) - 1;
    p->x = -r * sqrt((1 - sine) * (1 + sine));
    p->y = r * sine;
    return d->next(d->state) * -p->x < -p->x - d->mu;
}

/* ---- making one */

static asp_status oracle_make(const asp_ndf *ndf, asp_oracle *out, asp_error *err)
{
    const asp_model *model = ndf->model;
    if (model->f64.visible == asp_model_ggx.f64.visible)
        out->n = 1;
    else if (model->f64.visible == asp_model_beckmann.f64.visible)
        out->n = INFINITY;
    else if (model->f64.visible == asp_model_student_t.f64.visible)
        out->n = ndf->table[STUDENT_N];
    else
        return asp_fail(err, ASP_EINVAL, model->name, "is no Student's t distribution");
    if (out->n >= 0x1p58)
        out->n = INFINITY;
    out->m0 = out->n < INFINITY ? aspi_gamma_ratio(out->n) * out->n / (sqrt(ASP_PI) * (2 * out->n - 1))
                                : 0.5 / sqrt(ASP_PI);
    return ASP_OK;
}

/* Upper bound of P22 over a cell, looking a little over its ends. */
static double radial_bound(const asp_oracle *o, double at)
{
    double most = 0, last = INFINITY, rises = 0;
    int i;
    for (i = -1; i <= 7; i++) {
        double p = radial_p22(o, aspi_exp_64(at + o->step * i / 7));
        rises += i > 0 && p > last * (1 + 1e-9);
        most = i >= 0 && p > most ? p : most;
        last = p;
    }
    return rises > 0 ? 1.2 * most : most;
}

static asp_status radial_make(const asp_ndf *ndf, asp_oracle *out, asp_error *err)
{
    asp_ndf *k = &out->standard;
    double t, r, peak = 0, low = 0, high = 0, f, rest = 0;
    int i;
    *k = *ndf;
    memset(&k->map, 0, sizeof k->map);
    k->map.m00 = k->map.m11 = k->i00 = k->i11 = k->inv_det = 1;
    k->i01 = k->i10 = 0;
    /* where r^3 P22, per log r, matters */
    for (t = -170; t <= 170; t += 0.25) {
        r = aspi_exp_64(t);
        f = r * r * r * radial_p22(out, r);
        peak = f > peak ? f : peak;
    }
    for (t = -170; t <= 170; t += 0.25) {
        r = aspi_exp_64(t);
        f = r * r * r * radial_p22(out, r);
        low = f > 1e-27 * peak && low == 0 ? t - 0.25 : low;
        high = f > 1e-20 * peak ? t + 0.25 : high;
        rest = f / peak;
        if (asp_P22(k, 0.6 * r, 0.8 * r) > 1.001 * asp_P22(k, r, 0)
            || asp_P22(k, 0.6 * r, 0.8 * r) < 0.999 * asp_P22(k, r, 0))
            return asp_fail(err, ASP_EINVAL, ndf->model->name, "its slopes are not radially symmetric");
    }
    if (!(rest < 1e-9) || !(peak > 0))
        return asp_fail(err, ASP_EINVAL, ndf->model->name, "its tails are too heavy for a table of slopes");
    out->first = low;
    out->step = (high - low) / ASP_ORACLE_CELLS;
    for (i = 0; i < ASP_ORACLE_CELLS; i++) {
        double end = aspi_exp_64(out->first + out->step * (i + 1));
        out->bound[i] = radial_bound(out, out->first + out->step * i);
        out->plain[i + 1] = out->plain[i] + end * end * out->bound[i] * out->step;
        out->tail[i + 1] = out->tail[i] + end * end * end * out->bound[i] * out->step;
    }
    return ASP_OK;
}

asp_status asp_oracle_make(const asp_ndf *ndf, asp_oracle_kind kind, asp_oracle *out, asp_error *err)
{
    memset(out, 0, sizeof *out);
    out->ndf = ndf;
    out->kind = kind;
    return kind == ASP_ORACLE_STUDENT ? oracle_make(ndf, out, err) : radial_make(ndf, out, err);
}

asp_vec3 asp_oracle_visible(const asp_oracle *oracle, asp_vec3 wi, asp_uniforms *next, void *state)
{
    oracle_draw d;
    asp_vec3 v = aspi_view_64(oracle->ndf, wi), p = aspi_vector_64(0, 0, 0), m;
    double s = sqrt(aspi_length2_64(v)), cx = s > 0 ? v.x / s : 1, cy = s > 0 ? v.y / s : 0;
    int i, found = 0;
    if (!(s > 0) && !(v.z > 0))
        return p;
    d.o = oracle;
    d.next = next;
    d.state = state;
    d.mu = s > 0 ? aspi_min_64(aspi_abs_64(v.z) / s, 1e150) : 1e150;
    for (i = 0; !found && i < MOST_TRIALS; i++)
        found = oracle->kind == ASP_ORACLE_STUDENT ? oracle_slope(&d, v.z < 0, &p)
                                                   : radial_slope(&d, v.z < 0, &p);
    if (!found)
        return aspi_vector_64(0, 0, 0);
    m = aspi_vector_64(-(cx * p.x - cy * p.y), -(cy * p.x + cx * p.y), p.z);
    return aspi_normalize_64(aspi_facet_back_64(oracle->ndf, m));
}

#undef ASP_PRECISION
