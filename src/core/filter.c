/* filter.c - moments of slopes, and many distributions seen as one
 *
 * A slope map takes standard slopes q to p = M q + t, so that E[p] = t and Cov[p] = V M M^T with V the
 * variance of the standard surface along one axis. Where V is infinite the mean absolute slope takes
 * its place: along u it is E|u.(p - t)| = |M^T u| E|q_x|, twice the projected area seen from the
 * horizon, which is finite as soon as masking is (Heitz 2014, sec. 4). */
#define ASP_PRECISION 64
#include "asperity_convert.h"
#include "asperity/elementary.h"
#include "core/round.h"

/* Symmetric, 2 x 2. */
typedef struct scatter { double xx, xy, yy; } scatter;

static scatter scatter_of(const asp_map *m)
{
    scatter s;
    s.xx = m->m00 * m->m00 + m->m01 * m->m01;
    s.xy = m->m00 * m->m10 + m->m01 * m->m11;
    s.yy = m->m10 * m->m10 + m->m11 * m->m11;
    return s;
}

static scatter scatter_scaled(scatter s, double by)
{
    s.xx *= by;
    s.xy *= by;
    s.yy *= by;
    return s;
}

/* A triangular M with M M^T = s (Cholesky). */
static asp_status map_of_scatter(scatter s, double tx, double ty, asp_map *out, asp_error *err)
{
    double m00 = aspi_sqrt(aspi_max(s.xx, 0.0)), m10 = m00 > 0.0 ? s.xy / m00 : 0.0;
    double rest = s.yy - m10 * m10;
    asp_map map;
    if (!(m00 > 0.0) || !(rest > 1e-15 * s.yy))
        return asp_fail(err, ASP_EINVAL, "covariance", "not positive definite: E[p p^T] must exceed "
                        "E[p] E[p]^T along every direction");
    map.m00 = m00;
    map.m01 = 0.0;
    map.m10 = m10;
    map.m11 = aspi_sqrt(rest);
    map.tx = tx;
    map.ty = ty;
    if (!(map.m11 >= 1e-5 && m00 >= 1e-5))
        return asp_fail(err, ASP_EINVAL, "covariance", "smoother than alpha = 1e-5");
    if (!(m00 <= 100.0 && aspi_sqrt(s.yy) <= 100.0))
        return asp_fail(err, ASP_EINVAL, "covariance", "rougher than alpha = 100");
    if (!(aspi_abs(tx) <= 100.0))
        return asp_fail_range(err, "mean_x", tx, -100.0, 0, 100.0);
    if (!(aspi_abs(ty) <= 100.0))
        return asp_fail_range(err, "mean_y", ty, -100.0, 0, 100.0);
    *out = map;
    return ASP_OK;
}

/* The same surface through the identity map. */
static asp_ndf standard_of(const asp_ndf *ndf)
{
    asp_ndf out = *ndf;
    out.map.m00 = out.map.m11 = out.i00 = out.i11 = out.inv_det = 1.0;
    out.map.m01 = out.map.m10 = out.i01 = out.i10 = out.map.tx = out.map.ty = 0.0;
    return out;
}

/* A model through the identity map: the map that its own numbers may add stays. */
static asp_status model_surface(const asp_model *model, const double *shape, asp_ndf *out,
                                asp_error *err)
{
    asp_map map;
    asp_status s = asp_map_from_roughness(1.0, 1.0, 0.0, 0.0, 0.0, &map, err);
    if (!s)
        s = asp_ndf_make(model, &map, shape, out, err);
    if (!s && !aspi_is_round(out))
        s = asp_fail(err, ASP_EINVAL, model->name, "its standard surface is not radially symmetric");
    return s;
}

/* ---- the variance of a standard surface
 *
 * E|q|^2 / 2 = pi int r^3 P22(r) dr, by the trapezoidal rule in log r from 1e-20 to 1e75, where P22 of
 * the steepest slopes ends. A power of r beyond is a geometric series; one that does not fall is an
 * infinite variance. */
#define VARIANCE_STEP 0.125
#define VARIANCE_FIRST (-46.0)
#define VARIANCE_NODES 1744
#define VARIANCE_TAIL 160

static int variance_of(const asp_ndf *surface, double *out)
{
    double sum = 0.0, last = 0.0, before = 0.0;
    int i;
    if (!aspi_is_round(surface))
        return 0;
    for (i = 0; i < VARIANCE_NODES; i++) {
        double r = aspi_exp(VARIANCE_FIRST + VARIANCE_STEP * i), r2 = r * r;
        double term = r2 * asp_P22(surface, r, 0.0) * r2;
        sum += term;
        if (i == VARIANCE_NODES - 1 - VARIANCE_TAIL)
            before = term;
        last = term;
    }
    if (before * VARIANCE_NODES > 1e-16 * sum) {
        double q = last > 0.0 ? aspi_log(last / before) / VARIANCE_TAIL : -1.0;
        if (!(q < -1e-7))
            return 0;
        sum += last * aspi_exp(q) / -aspi_expm1(q);
    }
    *out = ASP_PI * VARIANCE_STEP * sum;
    return *out > 0.0 && *out < 1e30;
}

static asp_status fail_variance(const asp_model *model, const asp_ndf *surface, asp_error *err)
{
    return asp_fail(err, ASP_EINVAL, model->name, aspi_is_round(surface)
                    ? "the covariance of its slopes is infinite (the tail falls too slowly)"
                    : "its standard surface is not radially symmetric");
}

asp_status asp_ndf_moments(const asp_ndf *ndf, asp_moments *out, asp_error *err)
{
    asp_ndf surface = standard_of(ndf);
    scatter s = scatter_of(&ndf->map);
    double v, tx = ndf->map.tx, ty = ndf->map.ty;
    if (!variance_of(&surface, &v))
        return fail_variance(ndf->model, &surface, err);
    out->mean_x = tx;
    out->mean_y = ty;
    out->xx = v * s.xx + tx * tx;
    out->xy = v * s.xy + tx * ty;
    out->yy = v * s.yy + ty * ty;
    return ASP_OK;
}

static asp_status check_weights(size_t n, const double *weight, double *sum, asp_error *err)
{
    size_t i;
    *sum = 0.0;
    for (i = 0; i < n; i++) {
        double w = weight ? weight[i] : 1.0;
        if (!(w >= 0.0 && w <= 1e300))
            return asp_fail_range(err, "weight", w, 0.0, 0, 1e300);
        *sum += w;
    }
    if (!(*sum > 0.0 && *sum <= 1e300))
        return asp_fail(err, ASP_EINVAL, "weight", n ? "the sum of the weights must be above 0 and "
                        "at most 1e300" : "nothing to average");
    return ASP_OK;
}

asp_status asp_normals_moments(size_t n, asp_cvec3s m, const double *weight, asp_moments *out,
                               asp_error *err)
{
    asp_moments sum = { 0, 0, 0, 0, 0 };
    double total;
    size_t i;
    asp_status s = check_weights(n, weight, &total, err);
    if (s)
        return s;
    for (i = 0; i < n; i++) {
        double w = (weight ? weight[i] : 1.0) / total, x = -m.x[i] / m.z[i], y = -m.y[i] / m.z[i];
        if (!(m.z[i] > 0.0) || !(aspi_abs(x) <= 1e100 && aspi_abs(y) <= 1e100))
            return asp_fail(err, ASP_EINVAL, "m", "a normal does not point up, or is no normal");
        sum.mean_x += w * x;
        sum.mean_y += w * y;
        sum.xx += w * x * x;
        sum.xy += w * x * y;
        sum.yy += w * y * y;
    }
    *out = sum;
    return ASP_OK;
}

asp_status asp_map_from_moments(const asp_model *model, const double *shape, const asp_moments *in,
                                asp_map *out, asp_error *err)
{
    asp_ndf surface;
    scatter cov;
    double v;
    asp_status s = model_surface(model, shape, &surface, err);
    if (s)
        return s;
    if (!variance_of(&surface, &v))
        return fail_variance(model, &surface, err);
    cov.xx = in->xx - in->mean_x * in->mean_x;
    cov.xy = in->xy - in->mean_x * in->mean_y;
    cov.yy = in->yy - in->mean_y * in->mean_y;
    return map_of_scatter(scatter_scaled(cov, 1.0 / v), in->mean_x, in->mean_y, out, err);
}

/* ---- sums
 *
 * With M1 M1^T = W W^T and M2 M2^T = W diag(d) W^T (one turn diagonalises both), the two surfaces have
 * scales 1 and sqrt(d) along the columns of W^-T, and by symmetry so has their sum: two sums of one
 * variable each. */

typedef struct axes { double w00, w01, w10, w11, d[2]; } axes;

static axes common_axes(const asp_ndf *a, const asp_ndf *b)
{
    asp_map n, w;
    asp_roughness r;
    asp_vec2 turn;
    axes out;
    n.m00 = a->i00 * b->map.m00 + a->i01 * b->map.m10; /* M1^-1 M2 */
    n.m01 = a->i00 * b->map.m01 + a->i01 * b->map.m11;
    n.m10 = a->i10 * b->map.m00 + a->i11 * b->map.m10;
    n.m11 = a->i10 * b->map.m01 + a->i11 * b->map.m11;
    n.tx = n.ty = 0.0;
    r = asp_map_to_roughness(&n);
    turn = aspi_sincos2pi(r.rotation * (0.5 / ASP_PI));
    w = a->map;
    out.w00 = w.m00 * turn.x + w.m01 * turn.y;
    out.w01 = w.m01 * turn.x - w.m00 * turn.y;
    out.w10 = w.m10 * turn.x + w.m11 * turn.y;
    out.w11 = w.m11 * turn.x - w.m10 * turn.y;
    out.d[0] = r.alpha_x;
    out.d[1] = r.alpha_y;
    return out;
}

static scatter scatter_of_axes(const axes *a, double e0, double e1)
{
    scatter s;
    s.xx = a->w00 * a->w00 * e0 + a->w01 * a->w01 * e1;
    s.xy = a->w00 * a->w10 * e0 + a->w01 * a->w11 * e1;
    s.yy = a->w10 * a->w10 * e0 + a->w11 * a->w11 * e1;
    return s;
}

/* E|q_x| = 2 E[max(0, q_x)]. */
static double mean_absolute(const asp_ndf *surface)
{
    asp_vec3 u = { 1.0, 0.0, 0.0 };
    return 2.0 * asp_sigma(surface, u);
}

/* E|x1 + s x2| for the x of two standard surfaces, s <= 1. Given x2 = y it is |y| + 2 J1(|y|) with
 * J(mu) = E[max(0, x - mu)] = sigma of a view below the horizon; the first part is known, and the
 * second is smooth over x2 and falls twice as fast as either tail. In phi, where J has a kink at
 * x2 = 0, a polynomial of v with five vanishing derivatives makes the trapezoidal rule converge. */
#define SUM_STEP 0.25
#define SUM_FIRST (-16.0)
#define SUM_NODES 168
#define SUM_ANGLES 48

static double sum_absolute_smoother(const asp_ndf *rough, const asp_ndf *smooth, double s)
{
    double sum = 0.0;
    int i, j;
    for (i = 0; i < SUM_NODES; i++) {
        double r = aspi_exp(SUM_FIRST + SUM_STEP * i), ring = 0.0;
        double density = r * r * asp_P22(smooth, r, 0.0);
        for (j = 1; j < SUM_ANGLES && density > 0.0; j++) {
            double v = (double)j / SUM_ANGLES, v3 = v * v * v, u = 1.0 - v, u3 = u * u * u;
            double turn = 0.25 * v3 * v3
                        * (462.0 - v * (1980.0 - v * (3465.0 - v * (3080.0 - v * (1386.0 - v * 252.0)))));
            asp_vec3 w = { 1.0, 0.0, 0.0 };
            w.z = -s * r * aspi_max(aspi_sincos2pi(turn).x, 0.0);
            ring += asp_sigma(rough, w) * (v3 * v * v) * (u3 * u * u);
        }
        sum += density * ring;
    }
    /* d phi = (pi/2) 2772 v^5 (1 - v)^5 dv over a quarter of the circle */
    return s * mean_absolute(smooth)
         + 2.0 * sum * SUM_STEP * 4.0 * (0.5 * ASP_PI * 2772.0 / SUM_ANGLES);
}

static double sum_absolute(const asp_ndf *a, const asp_ndf *b, double s)
{
    return s <= 1.0 ? sum_absolute_smoother(a, b, s) : s * sum_absolute_smoother(b, a, 1.0 / s);
}

/* What is matched, with the variances of parts and target where they are finite. */
static asp_status choose_match(asp_match match, const asp_model *infinite, int *covariance,
                               asp_error *err)
{
    if (match != ASP_MATCH_AUTO && match != ASP_MATCH_COVARIANCE && match != ASP_MATCH_AREA)
        return asp_fail(err, ASP_EINVAL, "match", "neither automatic, nor covariance, nor area");
    *covariance = match != ASP_MATCH_AREA && !infinite;
    if (match != ASP_MATCH_COVARIANCE || !infinite)
        return ASP_OK;
    return asp_fail(err, ASP_EINVAL, infinite->name,
                    "the covariance of its slopes is infinite, or its standard surface is not round");
}

static asp_status make_matched(const asp_model *model, const double *shape, scatter s, double tx,
                               double ty, asp_ndf *out, asp_error *err)
{
    asp_map map;
    asp_status status = map_of_scatter(s, tx, ty, &map, err);
    return status ? status : asp_ndf_make(model, &map, shape, out, err);
}

asp_status asp_ndf_sum(const asp_ndf *a, const asp_ndf *b, const asp_model *model,
                       const double *shape, asp_match match, asp_ndf *out, asp_error *err)
{
    asp_ndf surface, first = standard_of(a), second = standard_of(b);
    double va = 0.0, vb = 0.0, v = 0.0, e[2];
    int ok_a, ok_b, ok, covariance = 0;
    axes common = common_axes(a, b);
    scatter s;
    asp_status status = model_surface(model, shape, &surface, err);
    if (!status && !(aspi_is_round(&first) && aspi_is_round(&second)))
        status = asp_fail(err, ASP_EINVAL, (aspi_is_round(&first) ? b : a)->model->name,
                          "its standard surface is not radially symmetric");
    if (status)
        return status;
    ok_a = variance_of(&first, &va);
    ok_b = variance_of(&second, &vb);
    ok = variance_of(&surface, &v);
    status = choose_match(match, !ok_a ? a->model : !ok_b ? b->model : !ok ? model : NULL,
                          &covariance, err);
    if (status)
        return status;
    if (covariance) {
        scatter sa = scatter_of(&a->map), sb = scatter_of(&b->map);
        s.xx = (va * sa.xx + vb * sb.xx) / v;
        s.xy = (va * sa.xy + vb * sb.xy) / v;
        s.yy = (va * sa.yy + vb * sb.yy) / v;
    } else {
        double unit = mean_absolute(&surface);
        e[0] = sum_absolute(&first, &second, common.d[0]) / unit;
        e[1] = sum_absolute(&first, &second, common.d[1]) / unit;
        s = scatter_of_axes(&common, e[0] * e[0], e[1] * e[1]);
    }
    return make_matched(model, shape, s, a->map.tx + b->map.tx, a->map.ty + b->map.ty, out, err);
}

/* ---- averages
 *
 * The parts are distributions, or one distribution moved by each of n slopes. */

typedef struct mixture {
    size_t n;
    const asp_ndf *const *parts;     /* or NULL and: */
    const asp_ndf *base;
    const double *slope_x, *slope_y;
    const double *weight;
    double total, tx, ty;            /* sum of the weights, mean slope */
} mixture;

static asp_vec2 part_mean(const mixture *m, size_t i)
{
    const asp_map *map = m->parts ? &m->parts[i]->map : &m->base->map;
    asp_vec2 t;
    t.x = map->tx + (m->parts ? 0.0 : m->slope_x[i]);
    t.y = map->ty + (m->parts ? 0.0 : m->slope_y[i]);
    return t;
}

static double part_weight(const mixture *m, size_t i)
{
    return (m->weight ? m->weight[i] : 1.0) / m->total;
}

static void mixture_mean(mixture *m)
{
    size_t i;
    m->tx = m->ty = 0.0;
    for (i = 0; i < m->n; i++) {
        asp_vec2 t = part_mean(m, i);
        m->tx += part_weight(m, i) * t.x;
        m->ty += part_weight(m, i) * t.y;
    }
}

/* Covariance within and between; the first model whose own is infinite, or NULL. */
static const asp_model *mixture_covariance(const mixture *m, scatter *out)
{
    const asp_ndf *last = NULL;
    scatter within = { 0, 0, 0 };
    double v = 0.0;
    size_t i;
    out->xx = out->xy = out->yy = 0.0;
    for (i = 0; i < m->n; i++) {
        const asp_ndf *part = m->parts ? m->parts[i] : m->base;
        double w = part_weight(m, i);
        asp_vec2 t = part_mean(m, i);
        t.x -= m->tx;
        t.y -= m->ty;
        if (part != last) {
            asp_ndf surface = standard_of(part);
            if (!variance_of(&surface, &v))
                return part->model;
            within = scatter_scaled(scatter_of(&part->map), v);
            last = part;
        }
        out->xx += w * (within.xx + t.x * t.x);
        out->xy += w * (within.xy + t.x * t.y);
        out->yy += w * (within.yy + t.y * t.y);
    }
    return NULL;
}

/* E|u.(p - mean)| along u = (x, y): the facets seen from u and from -u, of each part moved. */
static double mixture_absolute(const mixture *m, double x, double y)
{
    double sum = 0.0;
    size_t i;
    for (i = 0; i < m->n; i++) {
        const asp_ndf *part = m->parts ? m->parts[i] : m->base;
        double z = x * (m->tx - (m->parts ? 0.0 : m->slope_x[i]))
                 + y * (m->ty - (m->parts ? 0.0 : m->slope_y[i]));
        asp_vec3 u, v;
        u.x = x;
        u.y = y;
        u.z = z;
        v.x = -x;
        v.y = -y;
        v.z = -z;
        sum += part_weight(m, i) * (asp_sigma(part, u) + asp_sigma(part, v));
    }
    return sum;
}

/* The scatter whose widths u^T s u come nearest to the squares of E|u.(p - mean)|: a constant and the
 * second harmonic over directions. */
#define AREA_DIRECTIONS 64

static scatter mixture_area(const mixture *m)
{
    double mean = 0.0, even = 0.0, odd = 0.0;
    scatter s;
    int i;
    for (i = 0; i < AREA_DIRECTIONS; i++) {
        double turn = (double)i / AREA_DIRECTIONS;
        asp_vec2 u = aspi_sincos2pi(0.5 * turn), twice = aspi_sincos2pi(turn);
        double a = mixture_absolute(m, u.x, u.y);
        mean += a * a / AREA_DIRECTIONS;
        even += a * a * twice.x * (2.0 / AREA_DIRECTIONS);
        odd += a * a * twice.y * (2.0 / AREA_DIRECTIONS);
    }
    s.xx = mean + even;
    s.xy = odd;
    s.yy = mean - even;
    return s;
}

static asp_status average(mixture *m, const asp_model *model, const double *shape, asp_match match,
                          asp_ndf *out, asp_error *err)
{
    asp_ndf surface;
    const asp_model *infinite;
    scatter s;
    double v = 0.0, unit;
    int covariance = 0;
    asp_status status = check_weights(m->n, m->weight, &m->total, err);
    if (!status)
        status = model_surface(model, shape, &surface, err);
    if (status)
        return status;
    mixture_mean(m);
    infinite = mixture_covariance(m, &s);
    if (!variance_of(&surface, &v) && !infinite)
        infinite = model;
    status = choose_match(match, infinite, &covariance, err);
    if (status)
        return status;
    if (!covariance) {
        s = mixture_area(m);
        unit = mean_absolute(&surface);
        v = unit * unit;
    }
    return make_matched(model, shape, scatter_scaled(s, 1.0 / v), m->tx, m->ty, out, err);
}

asp_status asp_ndf_average(size_t n, const asp_ndf *const *parts, const double *weight,
                           const asp_model *model, const double *shape, asp_match match,
                           asp_ndf *out, asp_error *err)
{
    mixture m;
    memset(&m, 0, sizeof m);
    m.n = n;
    m.parts = parts;
    m.weight = weight;
    return average(&m, model, shape, match, out, err);
}

asp_status asp_ndf_footprint(const asp_ndf *base, size_t n, const double *slope_x,
                             const double *slope_y, const double *weight, const asp_model *model,
                             const double *shape, asp_match match, asp_ndf *out, asp_error *err)
{
    mixture m;
    memset(&m, 0, sizeof m);
    m.n = n;
    m.base = base;
    m.slope_x = slope_x;
    m.slope_y = slope_y;
    m.weight = weight;
    return average(&m, model, shape, match, out, err);
}
