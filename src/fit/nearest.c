/* nearest.c - the distribution of a model that comes nearest to a target
 *
 * Everything happens in slopes p = M (r cos phi, r sin phi) + t, M the target's map scaled to det 1: the
 * model's density is a function of r alone, and a norm of the hemisphere is a set of weights over (r,
 * phi). In log r the trapezoidal rule converges exponentially for what is smooth. Roughness and shape are
 * found by Brent's line search and, where two shape numbers or more are free, by a simplex. */
#include "core/round.h"
#include "fit.h"

#include <stdlib.h>
#include <string.h>

#define STEP 0.03125           /* in log r */
#define BELOW 14.0             /* log r down from the target's median slope, or from 1, */
#define ABOVE 18.0             /* and up from the other of the two */
#define SECTORS 48             /* directions phi of a target that is not round about the normal */
#define LINE_STEPS 48           /* of a line search, at most */
#define GOLDEN 0.61803398874989484820

enum { THETA, L2, L2_COS, L1_COS, SLOPE, LOG, PEAK, NORMS };

static const asp_norm norms[NORMS] = {
    { "theta", "sqrt(int (m - d)^2 dtheta / int d^2 dtheta)" },
    { "l2", "sqrt(int (m - d)^2 / int d^2) over the solid angle" },
    { "l2_cos", "sqrt(int (m - d)^2 cos / int d^2 cos) over the solid angle" },
    { "l1_cos", "int |m - d| cos over the solid angle" },
    { "slope", "sqrt(int (m - d)^2 / int d^2) over slopes, of P22" },
    { "log", "sqrt(int log((m + e)/(d + e))^2 cos/pi) over the solid angle, e = 0.001 of d's peak" },
    { "peak", "theta, among those with d's density at the mean slope" },
};
static const asp_norm *const norm_table[] = { &norms[0], &norms[1], &norms[2], &norms[3], &norms[4],
                                              &norms[5], &norms[6], NULL };

const asp_norm *const *asp_norms(void) { return norm_table; }

typedef struct field {
    int    rings, sectors;
    int    radial;                               /* 1: target depends on the ring alone */
    double *memory, *r, *zero, *ring;            /* rings each */
    double *whole;                               /* of a ring: the weight of the norm at work */
    double *target, *area, *secant;              /* rings x sectors: P22, r^2 dlog r dphi, 1/cos theta */
    double *sine;                                /* 1/(2 pi sin theta) */
    double peak, median;                         /* of the target */
    double scale[NORMS];                         /* what a sum of squares is divided by */
    asp_map map;                                 /* det 1 */
} field;

typedef struct search {
    const asp_model *model;
    const field *f;
    int norm, peak;
    double fixed_alpha;                          /* 0: free */
    int free_alpha, n, index[ASP_SHAPE_NUMBERS]; /* free shape numbers that the search moves */
    aspi_axis axis[ASP_SHAPE_NUMBERS];
    double shape[ASP_SHAPE_NUMBERS];
    asp_ndf surface;                             /* of shape, through the identity map */
    double made[ASP_SHAPE_NUMBERS];              /* the shape of surface; NaN: none */
    double alpha;                                /* where the last loss belongs */
    double peak_at;                              /* where the peak was last reached, on axis[0] */
    size_t evaluations;
} search;

/* ------------------------------------------------------------------ the target */

static asp_status field_memory(field *f, asp_error *err)
{
    size_t rings = (size_t)f->rings, nodes = rings * (size_t)f->sectors;
    f->memory = calloc(4 * rings + 4 * nodes, sizeof *f->memory);
    if (!f->memory)
        return asp_fail(err, ASP_ENOMEM, "", "not enough memory for the comparison");
    f->r = f->memory;
    f->zero = f->r + rings;
    f->ring = f->zero + rings;
    f->whole = f->ring + rings;
    f->target = f->whole + rings;
    f->area = f->target + nodes;
    f->secant = f->area + nodes;
    f->sine = f->secant + nodes;
    return ASP_OK;
}

static double median_slope(const asp_ndf *target, const field *f)
{
    asp_vec3 m = asp_sample_normal(target, 0.5, 0.25);
    double x = -m.x / m.z - f->map.tx, y = -m.y / m.z - f->map.ty;
    double r = hypot(x * f->map.m11 - y * f->map.m01, y * f->map.m00 - x * f->map.m10);
    return r > 1e-30 && r < 1e30 ? r : 1;
}

/* The weight of (m - d)^2, of |m - d| (l1_cos) or of log^2, m and d being P22; D = P22 / cos^4 and a
 * solid angle is cos^3 of an area of slopes. */
static double weight(const field *f, int norm, int i)
{
    double s = f->secant[i], s2 = s * s;
    switch (norm) {
    case L2:     return f->area[i] * s2 * s2 * s;
    case L2_COS: return f->area[i] * s2 * s2;
    case LOG:    return f->area[i] / (s2 * s2) * ASPI_INV_PI;
    case L1_COS:
    case SLOPE:  return f->area[i];
    default:     return f->area[i] * s2 * s2 * s * f->sine[i];
    }
}

static asp_status field_make(const asp_ndf *target, int norm, field *f, asp_error *err)
{
    const asp_map *map = &target->map;
    double root = sqrt(fabs(map->m00 * map->m11 - map->m01 * map->m10)), first;
    int round = fabs(map->m00 * map->m10 + map->m01 * map->m11) <= 1e-12 * root * root
             && fabs(hypot(map->m00, map->m01) - hypot(map->m10, map->m11)) <= 1e-12 * root
             && map->tx == 0 && map->ty == 0;
    asp_ndf surface = *target;
    surface.map.m00 = surface.map.m11 = surface.i00 = surface.i11 = surface.inv_det = 1;
    surface.map.m01 = surface.map.m10 = surface.i01 = surface.i10 = surface.map.tx = surface.map.ty = 0;
    f->radial = aspi_is_round(&surface);
    round = round && f->radial;
    f->map = *map;
    f->map.m00 /= root;
    f->map.m01 /= root;
    f->map.m10 /= root;
    f->map.m11 /= root;
    f->median = median_slope(target, f);
    first = fmin(log(f->median), 0) - BELOW;
    f->rings = (int)((BELOW + ABOVE + fabs(log(f->median))) / STEP);
    f->sectors = round ? 1 : SECTORS;
    asp_status status = field_memory(f, err);
    if (status)
        return status;
    f->peak = asp_P22(target, map->tx, map->ty);
    for (int i = 0; i < f->rings; i++) {
        double r = f->r[i] = exp(first + STEP * i);
        for (int j = 0; j < f->sectors; j++) {
            int k = i * f->sectors + j;
            double phi = 6.28318530717958647692 * (j + 0.5) / f->sectors;
            double x = f->map.m00 * r * cos(phi) + f->map.m01 * r * sin(phi) + map->tx;
            double y = f->map.m10 * r * cos(phi) + f->map.m11 * r * sin(phi) + map->ty;
            double tangent = hypot(x, y);
            f->target[k] = asp_P22(target, x, y);
            f->area[k] = r * r * STEP * 6.28318530717958647692 / f->sectors;
            f->secant[k] = hypot(1, tangent);
            f->sine[k] = 0.5 * ASPI_INV_PI * f->secant[k] / tangent;
        }
    }
    for (int k = 0; k < f->rings * f->sectors; k++) {
        for (int i = 0; i < NORMS; i++)
            f->scale[i] += weight(f, i, k) * f->target[k] * f->target[k];
        f->whole[k / f->sectors] += weight(f, norm, k);
    }
    return ASP_OK;
}

/* The error of the densities in f->ring. */
static double distance(const field *f, int norm)
{
    double sum = 0, e = 1e-3 * f->peak;
    for (int i = 0; i < f->rings; i++)
        for (int j = 0; j < f->sectors; j++) {
            int k = i * f->sectors + j;
            double m = f->ring[i], d = f->target[k], c4 = 1 / (f->secant[k] * f->secant[k]);
            c4 *= c4;
            double x = norm == LOG ? log((m + e * c4) / (d + e * c4)) : m - d;
            sum += weight(f, norm, k) * (norm == L1_COS ? fabs(x) : x * x);
        }
    if (!(sum < 1e300))
        return INFINITY;
    return norm == L1_COS ? sum : sqrt(norm == LOG ? sum : sum / f->scale[norm]);
}

/* The same for the norm at work, and a target that is alike around each ring. */
static double distance_by_rings(const field *f, int norm)
{
    double sum = 0;
    for (int i = 0; i < f->rings; i++) {
        double x = f->ring[i] - f->target[i * f->sectors];
        sum += f->whole[i] * (norm == L1_COS ? fabs(x) : x * x);
    }
    return !(sum < 1e300) ? INFINITY : norm == L1_COS ? sum : sqrt(sum / f->scale[norm]);
}

/* ------------------------------------------------------------------ the model at one place */

static int make_surface(search *s)
{
    static const asp_map identity = { 1, 0, 0, 1, 0, 0 };
    if (memcmp(s->made, s->shape, sizeof s->made) == 0)
        return 1;
    s->made[0] = NAN;
    if (asp_ndf_make(s->model, &identity, s->shape, &s->surface, NULL))
        return 0;
    memcpy(s->made, s->shape, sizeof s->made);
    return 1;
}

/* Densities over the rings: P22(r/alpha)/alpha^2. */
static void fill_ring(search *s, double alpha)
{
    const field *f = s->f;
    for (int i = 0; i < f->rings; i++)
        f->ring[i] = f->r[i] / alpha;
    asp_P22_n(&s->surface, (size_t)f->rings, f->ring, f->zero, f->ring);
    for (int i = 0; i < f->rings; i++)
        f->ring[i] /= alpha * alpha;
    s->evaluations++;
}

static double loss_at_alpha(search *s, double alpha)
{
    fill_ring(s, alpha);
    return s->f->radial && s->norm != LOG ? distance_by_rings(s->f, s->norm) : distance(s->f, s->norm);
}

/* The least of f over [low, high]: the best of `grid` + 1 places, then golden sections and parabolas
 * around it (Brent 1973, ch. 5) until the place is known to `tolerance`. */
typedef double line_function(search *s, double x);

/* Squares are smooth where a loss vanishes, which is a kink. */
static double squared(search *s, line_function *f, double x)
{
    double value = f(s, x);
    return value * value;
}

static double least(search *s, line_function *f, double low, double high, int grid, double tolerance,
                    double *at)
{
    double fx = INFINITY, step = (high - low) / grid, x = low, a, b, v, w, fv, fw, d = 0, e = 0;
    for (int i = 0; i <= grid; i++) {
        double value = squared(s, f, low + step * i);
        if (value < fx) {
            fx = value;
            x = low + step * i;
        }
    }
    a = fmax(x - step, low);
    b = fmin(x + step, high);
    v = w = x;
    fv = fw = fx;
    for (int i = 0; i < LINE_STEPS; i++) {
        double middle = 0.5 * (a + b), p, q, u, fu;
        if (fmax(x - a, b - x) <= 2 * tolerance || !isfinite(fx))
            break;
        p = (x - v) * (x - v) * (fx - fw) - (x - w) * (x - w) * (fx - fv);
        q = 2 * ((x - v) * (fx - fw) - (x - w) * (fx - fv));
        p = q > 0 ? -p : p;
        q = fabs(q);
        if (fabs(e) > tolerance && isfinite(p) && fabs(p) < fabs(0.5 * q * e) && p > q * (a - x)
            && p < q * (b - x)) {
            e = d;
            d = p / q;
            if (x + d - a < 2 * tolerance || b - x - d < 2 * tolerance)
                d = x < middle ? tolerance : -tolerance;
        } else {
            e = x < middle ? b - x : a - x;
            d = (1 - GOLDEN) * e;
        }
        u = fmin(fmax(x + (fabs(d) >= tolerance ? d : d > 0 ? tolerance : -tolerance), a), b);
        fu = squared(s, f, u);
        if (fu <= fx) {
            *(u < x ? &b : &a) = x;
            v = w; fv = fw;
            w = x; fw = fx;
            x = u; fx = fu;
        } else {
            *(u < x ? &a : &b) = u;
            if (fu <= fw || w == x) {
                v = w; fv = fw;
                w = u; fw = fu;
            } else if (fu <= fv || v == x || v == w) {
                v = u; fv = fu;
            }
        }
    }
    *at = x;
    return sqrt(fx);
}

static double loss_at_log_alpha(search *s, double x) { return loss_at_alpha(s, exp(x)); }

/* log of the model's peak over the target's at a place b of the first shape number. */
static double peak_excess(search *s, double b)
{
    s->shape[0] = aspi_axis_value(&s->axis[0], b);
    if (!make_surface(s))
        return NAN;
    return log(asp_P22(&s->surface, 0, 0) / s->f->peak / (s->fixed_alpha * s->fixed_alpha));
}

/* A bracket [low, high] of the first shape number's place at which the peaks are equal, found outwards
 * from the last solution, or from the default; 0 if there is none. */
static int bracket_peak(search *s, double *low, double *f_low, double *high, double *f_high)
{
    const aspi_axis *axis = &s->axis[0];
    double middle = s->peak_at, at = peak_excess(s, middle), a = middle, b = middle, fa = at, fb = at;
    for (double step = 0.01; a > axis->b_low || b < axis->b_high; step *= 2) {
        double next = fmax(a - step, axis->b_low), value = a > axis->b_low ? peak_excess(s, next) : fa;
        if (!isnan(value) && !isnan(fa) && (value < 0) != (fa < 0)) {
            *low = next; *f_low = value; *high = a; *f_high = fa;
            return 1;
        }
        a = next;
        fa = value;
        next = fmin(b + step, axis->b_high);
        value = b < axis->b_high ? peak_excess(s, next) : fb;
        if (!isnan(value) && !isnan(fb) && (value < 0) != (fb < 0)) {
            *low = b; *f_low = fb; *high = next; *f_high = value;
            return 1;
        }
        b = next;
        fb = value;
    }
    return at == 0 ? (*low = *high = middle, *f_low = *f_high = 0, 1) : 0;
}

/* The place of equal peaks: regula falsi, with the halving of an end that stays (Illinois). */
static int solve_peak(search *s)
{
    double low, high, f_low, f_high, b;
    int side = 0;
    if (!bracket_peak(s, &low, &f_low, &high, &f_high))
        return 0;
    b = low;
    for (int i = 0; i < 100 && high - low > 2e-16 && f_low != f_high; i++) {
        double value;
        b = i % 8 == 7 ? 0.5 * (low + high) : (low * f_high - high * f_low) / (f_high - f_low);
        b = b > low && b < high ? b : 0.5 * (low + high);
        value = peak_excess(s, b);
        if (fabs(value) < 1e-14)
            break;
        if ((value < 0) == (f_low < 0)) {
            f_high *= side == -1 ? 0.5 : 1;
            low = b; f_low = value; side = -1;
        } else {
            f_low *= side == 1 ? 0.5 : 1;
            high = b; f_high = value; side = 1;
        }
    }
    s->peak_at = b;
    return isfinite(peak_excess(s, b));
}

/* The least loss over the roughness, the shape numbers of the search being as they are. */
static double loss_over_alpha(search *s)
{
    double x;
    if (s->peak && !s->free_alpha && !solve_peak(s))
        return INFINITY;
    if (!make_surface(s))
        return INFINITY;
    if (!s->free_alpha)
        s->alpha = s->fixed_alpha;
    else if (s->peak)
        s->alpha = sqrt(asp_P22(&s->surface, 0, 0) / s->f->peak);
    if (!s->free_alpha || s->peak)
        return loss_at_alpha(s, s->alpha);
    asp_vec3 m = asp_sample_normal(&s->surface, 0.5, 0.25);
    double start = log(s->f->median / (hypot(m.x, m.y) / m.z));
    double loss = least(s, loss_at_log_alpha, start - 4, start + 4, 32, 1e-10, &x);
    s->alpha = exp(x);
    return loss;
}

/* ------------------------------------------------------------------ shape numbers */

static double loss_at_b(search *s, const double *b)
{
    for (int i = 0; i < s->n; i++) {
        const aspi_axis *axis = &s->axis[s->index[i]];
        s->shape[s->index[i]] = aspi_axis_value(axis, fmin(fmax(b[i], axis->b_low), axis->b_high));
    }
    return loss_over_alpha(s);
}

static double loss_at_one(search *s, double b) { return loss_at_b(s, &b); }

static void set_loss(void *context, aspi_point *at)
{
    at->loss = loss_at_b(context, at->b);
}

/* The simplex of simplex.c over the free shape numbers; the best place comes back in b. */
static double simplex(search *s, double *b, double size)
{
    static const int axis[ASP_SHAPE_NUMBERS] = { 0, 1, 2, 3, 4, 5, 6, 7 };
    aspi_axis box[ASP_SHAPE_NUMBERS];
    aspi_descent how = { box, axis, s->n, 250, size, 1e-12, set_loss, NULL, s };
    aspi_point at = { .loss = 0 };
    for (int i = 0; i < s->n; i++) {
        box[i] = s->axis[s->index[i]];
        at.b[i] = b[i];
    }
    set_loss(s, &at);
    aspi_descend(&how, &at);
    memcpy(b, at.b, (size_t)s->n * sizeof *b);
    return at.loss;
}

/* The ends of a range are places too: 1/gamma = 0 is one. */
static void try_ends(search *s, double *b, double *loss)
{
    for (int i = 0; i < s->n; i++)
        for (int end = 0; end < 2; end++) {
            const aspi_axis *axis = &s->axis[s->index[i]];
            double keep = b[i];
            b[i] = end ? axis->b_high : axis->b_low;
            double value = loss_at_b(s, b);
            if (value < *loss)
                *loss = value;
            else
                b[i] = keep;
        }
}

static double search_shapes(search *s, double *b)
{
    enum { GRID = 8 };
    double loss = INFINITY, place[ASP_SHAPE_NUMBERS];
    if (s->n == 1)
        loss = least(s, loss_at_one, s->axis[s->index[0]].b_low, s->axis[s->index[0]].b_high, 32, 1e-11, b);
    for (int code = 0; s->n > 1 && code < (s->n == 2 ? GRID * GRID : GRID * GRID * GRID); code++) {
        for (int i = 0, rest = code; i < s->n; i++, rest /= GRID) {
            const aspi_axis *axis = &s->axis[s->index[i]];
            place[i] = axis->b_low + (axis->b_high - axis->b_low) * (rest % GRID + 0.5) / GRID;
        }
        double value = loss_at_b(s, place);
        if (value < loss) {
            loss = value;
            memcpy(b, place, sizeof place);
        }
    }
    for (int round = 0; s->n > 1 && round < 3; round++)
        loss = simplex(s, b, 0.06 / (1 + 4 * round));
    if (s->n > 1)
        try_ends(s, b, &loss);
    return loss_at_b(s, b);
}

/* ------------------------------------------------------------------ the public call */

static asp_status read_options(const asp_nearest_options *o, search *s, asp_error *err)
{
    const asp_model *model = s->model;
    aspi_box box = aspi_box_make(model);
    int first = box.n - 1 - (int)model->param_count;
    s->norm = 0;
    while (o->norm && s->norm < NORMS && strcmp(norms[s->norm].name, o->norm) != 0)
        s->norm++;
    if (s->norm == NORMS)
        return asp_fail(err, ASP_EUNKNOWN, o->norm, "no such norm");
    s->peak = s->norm == PEAK;
    if (o->alpha != 0 && !(o->alpha >= 1e-5 && o->alpha <= 100))
        return asp_fail_range(err, "alpha", o->alpha, 1e-5, 0, 100);
    s->free_alpha = o->alpha == 0 && !model->own_scale;
    s->fixed_alpha = o->alpha != 0 ? o->alpha : 1;
    for (size_t k = 0; k < model->param_count; k++) {
        const asp_param *p = &model->params[k];
        int fixed = (int)(o->fixed >> k & 1u);
        double x = fixed ? o->shape[k] : p->initial;
        if (!(x <= p->high && (p->low_open ? x > p->low : x >= p->low)))
            return asp_fail_range(err, p->name, x, p->low, p->low_open, p->high);
        s->shape[k] = x;
        s->axis[k] = box.axis[first + (int)k];
        if (k == 0 && fixed && s->peak && !s->free_alpha)
            return asp_fail(err, ASP_EINVAL, p->name, "nothing is free to reach the target's peak with");
        if (!fixed && !(k == 0 && s->peak && !s->free_alpha))
            s->index[s->n++] = (int)k;
    }
    if (s->peak && !s->free_alpha && model->param_count == 0)
        return asp_fail(err, ASP_EINVAL, "alpha", "nothing is free to reach the target's peak with");
    return ASP_OK;
}

static asp_status finish(search *s, const asp_ndf *target, asp_nearest_result *out, asp_error *err)
{
    asp_map map = s->f->map;
    map.m00 *= s->alpha;
    map.m01 *= s->alpha;
    map.m10 *= s->alpha;
    map.m11 *= s->alpha;
    memset(out, 0, sizeof *out);
    asp_status status = asp_ndf_make(s->model, &map, s->shape, &out->ndf, err);
    if (status)
        return status;
    fill_ring(s, s->alpha);
    for (int norm = 0; norm < NORMS; norm++)
        out->errors[norm] = distance(s->f, norm);
    out->error = out->errors[s->norm];
    out->peak = asp_P22(&out->ndf, map.tx, map.ty) / asp_P22(target, map.tx, map.ty);
    for (int i = 0; i < s->n; i++) {
        int k = s->index[i];
        double b = aspi_axis_place(&s->axis[k], s->shape[k]);
        double low = aspi_axis_value(&s->axis[k], s->axis[k].b_low), at = s->shape[k];
        out->at_bound[k] = b <= s->axis[k].b_low || b >= s->axis[k].b_high
                         ? (at <= fmin(low, aspi_axis_value(&s->axis[k], s->axis[k].b_high)) ? -1 : 1) : 0;
    }
    out->evaluations = s->evaluations;
    return ASP_OK;
}

asp_status asp_nearest(const asp_ndf *target, const asp_model *model,
                       const asp_nearest_options *options, asp_nearest_result *out, asp_error *err)
{
    static const asp_nearest_options none;
    field f = { 0 };
    search s = { .model = model, .f = &f };
    double b[ASP_SHAPE_NUMBERS] = { 0 }, loss;
    asp_status status = read_options(options ? options : &none, &s, err);
    if (!status)
        status = field_make(target, s.norm, &f, err);
    if (status)
        return status;
    s.made[0] = NAN;
    s.peak_at = model->param_count ? aspi_axis_place(&s.axis[0], model->params[0].initial) : 0;
    loss = search_shapes(&s, b);
    if (loss < 1e300 && !aspi_is_round(&s.surface))
        status = asp_fail(err, ASP_EINVAL, model->name, "its standard surface is not radially symmetric");
    else if (!(loss < 1e300))
        status = s.peak ? asp_fail(err, ASP_EINVAL, s.free_alpha ? "alpha" : model->params[0].name,
                                   "no value in its range reaches the target's peak")
                        : asp_fail(err, ASP_EINVAL, model->name, "cannot be made with these numbers");
    else
        status = finish(&s, target, out, err);
    free(f.memory);
    return status;
}
