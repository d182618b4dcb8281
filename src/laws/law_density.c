/* law_density.c - laws of D and of the slope map */
#include "laws/laws.h"

#include <math.h>

static double relative(double a, double b)
{
    double scale = fmax(fabs(a), fabs(b));
    return scale > 0 ? fabs(a - b) / scale : a == b ? 0 : NAN;
}

/* ------------------------------------------------------------------ integrals over slopes */

/* Sectors differ from node to node by the golden ratio, so that all azimuths are seen. */
static double golden(int index) { return 2 * ASPI_PI * fmod(0.6180339887498949 * index, 1.0); }

static double normal_term(const void *context, double r, int index)
{
    return 2 * ASPI_PI * aspi_r2_density((const aspi_trial *)context, r, golden(index));
}

/* A density in pieces bends where they meet, and the trapezoidal rule loses its digits there; such a
 * distribution states an error above 1e-4 of what is prepared from it. */
static double sum_allowed(const aspi_trial *t)
{
    return t->ndf->model->area_error > 1e-4 ? 0.1 * t->ndf->model->area_error : 1e-10;
}

void aspi_law_normalisation(aspi_trial *t)
{
    double sum = t->planar ? aspi_planar_mass(t) : aspi_radial_integral(normal_term, t);
    aspi_find(t, fabs(sum - 1), sum_allowed(t), "integral %.15g", sum);
}

static double slope_term(const void *context, double r, int index)
{
    const aspi_trial *t = (const aspi_trial *)context;
    double phi = golden(index);
    asp_vec2 p = aspi_map_slope(&t->ndf->map, r * cos(phi), r * sin(phi));
    return 2 * ASPI_PI * ((asp_P22(t->ndf, p.x, p.y) * t->det) * r) * r;
}

/* What rounding of its slope does to D at m: near the mean slope of a narrow, tilted lobe p moves by steps of
 * eps |p| / alpha in q, and d ln P22 / dq is at most 4 for algebraic tails, 2 q for Gaussian ones. */
static double slope_rounding(const aspi_trial *t, asp_vec3 m)
{
    double r, phi;
    aspi_standard_polar(t->ndf, m, &r, &phi);
    return (4 + 2 * fmin(r / t->scale, 40)) * 2.3e-16
         * (fabs(t->ndf->i00) + fabs(t->ndf->i01) + fabs(t->ndf->i10) + fabs(t->ndf->i11))
         * (hypot(m.x, m.y) / m.z + hypot(t->ndf->map.tx, t->ndf->map.ty)) / t->scale;
}

void aspi_law_slope_density(aspi_trial *t)
{
    double sum = t->planar ? aspi_planar_slope_mass(t) : aspi_radial_integral(slope_term, t);
    int i;
    aspi_find(t, fabs(sum - 1), sum_allowed(t), "integral %.15g", sum);
    for (i = 0; i < 1000; i++) {
        asp_vec3 m = aspi_random_facet(t);
        double z2 = m.z * m.z;
        double D = asp_D(t->ndf, m), other = asp_P22(t->ndf, -m.x / m.z, -m.y / m.z) / z2 / z2;
        if (!(D > 1e-250 && m.z > 1e-60))
            continue;
        aspi_find(t, relative(D, other), 1e-13 * (1 + fabs(log(D))) + slope_rounding(t, m),
                  "m = (%.6g, %.6g, %.6g): D %.17g, P22/cos^4 %.17g", m.x, m.y, m.z, D, other);
    }
}

/* The density of normals, in slopes and times r^2. */
static double normal_density_term(const void *context, double r, int index)
{
    const aspi_trial *t = (const aspi_trial *)context;
    double phi = golden(index), zr;
    asp_vec2 p = aspi_map_slope(&t->ndf->map, r * cos(phi), r * sin(phi));
    asp_vec3 m = aspi_unit(-p.x, -p.y, 1);
    zr = m.z * r;
    return 2 * ASPI_PI * (asp_pdf_normal(t->ndf, m) * m.z) * zr * zr * t->det;
}

/* Slopes have the density P22, and a solid angle of facets is cos^3 of the slopes' area. */
void aspi_law_density_normal(aspi_trial *t)
{
    int i;
    if (!t->planar) {
        double sum = aspi_radial_integral(normal_density_term, t);
        aspi_find(t, fabs(sum - 1), sum_allowed(t), "integral %.15g", sum);
    }
    for (i = 0; i < 1000; i++) {
        asp_vec3 m = aspi_random_facet(t), below = m;
        double pdf = asp_pdf_normal(t->ndf, m), other = asp_P22(t->ndf, -m.x / m.z, -m.y / m.z) / m.z / m.z / m.z;
        below.z = -m.z;
        aspi_find(t, asp_pdf_normal(t->ndf, below), 0, "a facet that faces down");
        if (!(pdf > 1e-250 && m.z > 1e-60))
            continue;
        aspi_find(t, relative(pdf, other), 1e-13 * (1 + fabs(log(pdf))) + slope_rounding(t, m),
                  "m = (%.6g, %.6g, %.6g): density %.17g, P22/cos^3 %.17g", m.x, m.y, m.z, pdf, other);
    }
}

/* The first moment of opposite sectors: what is odd in q cancels, t is left. */
static double first_moment(const aspi_trial *t, int axis)
{
    double sum = 0, size = hypot(t->ndf->map.tx, t->ndf->map.ty);
    int k, i;
    if (t->planar)
        return aspi_planar_moment(t, axis) / (size + t->scale * sqrt(t->det));
    for (k = 0; k < 120; k++)
        for (i = 0; i < 8; i++) {
            double r = t->scale * exp(-12 + 0.125 * k), phi = 2 * ASPI_PI * (i + 0.3) / 8;
            asp_vec2 p = aspi_map_slope(&t->ndf->map, r * cos(phi), r * sin(phi));
            double p_axis = axis ? p.y - t->ndf->map.ty : p.x - t->ndf->map.tx;
            sum += p_axis * aspi_r2_density(t, r, phi) * (2 * ASPI_PI / 8) * 0.125;
        }
    return sum / (size + t->scale * sqrt(t->det));
}

void aspi_law_mean_slope(aspi_trial *t)
{
    const asp_map *map = &t->ndf->map;
    asp_vec2 mean = asp_mean_slope(t->ndf);
    asp_vec3 normal = asp_mean_normal(t->ndf), expected = aspi_unit(-map->tx, -map->ty, 1);
    /* relative to the roughness along the longer axis: sums of odd terms cancel to rounding, and
     * slopes near the mean of a tilted lobe are rounded in steps of eps |t| */
    double stretch = hypot(hypot(map->m00, map->m01), hypot(map->m10, map->m11))
                   / sqrt(t->det);
    double steps = 1 + hypot(map->tx, map->ty)
                 * (fabs(t->ndf->i00) + fabs(t->ndf->i01) + fabs(t->ndf->i10) + fabs(t->ndf->i11));
    int axis;
    aspi_find(t, fabs(mean.x - map->tx) + fabs(mean.y - map->ty), 0, "asp_mean_slope");
    aspi_find(t, fabs(normal.x - expected.x) + fabs(normal.y - expected.y)
                 + fabs(normal.z - expected.z), 1e-15, "asp_mean_normal");
    for (axis = 0; axis < 2; axis++)
        aspi_find(t, fabs(first_moment(t, axis)), 1e-14 * stretch * steps,
                  "integral of the slope less the mean along %s", axis ? "y" : "x");
}

/* ------------------------------------------------------------------ the slope map */

/* How much ln P22 can move when the slopes that go into it are rounded: cancellation in
 * q = M^-1 (p - t) leaves steps of eps times the terms that were subtracted. Zero where nothing is
 * subtracted, that is without skew and along the axes. */
static double map_rounding(const aspi_trial *t, double px, double py, double qx, double qy)
{
    const asp_ndf *k = t->ndf;
    double x = fabs(px) + fabs(k->map.tx), y = fabs(py) + fabs(k->map.ty);
    double ex = fabs(k->i00) * x + fabs(k->i01) * y - fabs(qx);
    double ey = fabs(k->i10) * x + fabs(k->i11) * y - fabs(qy);
    double r = hypot(qx, qy) / t->scale;
    return (fmax(ex, 0) + fmax(ey, 0)) / t->scale * fmin(4, 4 + 2 * r) * (1 + fmin(r, 40));
}

void aspi_law_slope_map(aspi_trial *t)
{
    int i;
    for (i = 0; i < 2000; i++) {
        double r = t->scale * exp(8 * aspi_uniform(t) - 4), phi = 2 * ASPI_PI * aspi_uniform(t);
        double other = 2 * ASPI_PI * aspi_uniform(t), mapped, standard;
        double qx = r * cos(phi), qy = r * sin(phi);
        asp_vec2 p = aspi_map_slope(&t->ndf->map, qx, qy);
        mapped = asp_P22(t->ndf, p.x, p.y) * t->det;
        /* the standard surface elsewhere on the same circle: it must be round, unless it says that
         * it is not */
        other = t->planar ? phi : other;
        standard = asp_P22(&t->standard, r * cos(other), r * sin(other));
        if (standard < 1e-250)
            continue;
        aspi_find(t, relative(mapped, standard),
                  2e-14 * (1 + fabs(log(standard))) + 2.3e-16 * map_rounding(t, p.x, p.y, qx, qy),
                  "slope (%.6g, %.6g): %.17g, standard %.17g", p.x, p.y, mapped, standard);
    }
}

static asp_ndf with_map(const asp_ndf *ndf, const asp_map *map)
{
    asp_ndf out = *ndf;
    double det = map->m00 * map->m11 - map->m01 * map->m10;
    out.map = *map;
    out.i00 = map->m11 / det;
    out.i01 = -map->m01 / det;
    out.i10 = -map->m10 / det;
    out.i11 = map->m00 / det;
    out.inv_det = 1 / fabs(det);
    return out;
}

static asp_vec3 turn(asp_vec3 v, double c, double s)
{
    asp_vec3 out = v;
    out.x = c * v.x - s * v.y;
    out.y = s * v.x + c * v.y;
    return out;
}

/* Where two values of one distribution may differ in their last digits: P22 within the map's
 * rounding, sigma by eps times what is summed. */
static void compare(aspi_trial *t, const asp_ndf *a, const asp_ndf *b, double c, double s,
                    double slack, const char *what)
{
    int i;
    for (i = 0; i < 300; i++) {
        asp_vec3 m = aspi_random_facet(t), w = aspi_random_direction(t), turned = turn(m, c, s);
        double Da = asp_D(a, m), Db = asp_D(b, turned), px = -m.x / m.z, py = -m.y / m.z;
        double sa = asp_sigma(a, w), sb = asp_sigma(b, turn(w, c, s)), r, phi, size, h, l;
        aspi_standard_polar(a, m, &r, &phi);
        size = fabs(a->i00) + fabs(a->i01) + fabs(a->i10) + fabs(a->i11);
        if (Da > 1e-250 && m.z > 1e-60)
            aspi_find(t, relative(Da, Db),
                      slack * (1e-13 * (1 + fabs(log(Da)))
                      + 1e-15 * (4 + 4 * fmin(r / t->scale, 40)) / t->scale * size
                        * (hypot(px, py) + hypot(a->map.tx, a->map.ty))),
                      "%s: D at m = (%.6g, %.6g, %.6g)", what, m.x, m.y, m.z);
        aspi_standard_view(a, w, &h, &l);
        if (h > 0)
            aspi_find(t, relative(sa, sb),
                      slack * 1e-13 * (1 + (1 + hypot(a->map.tx, a->map.ty)) / sa),
                      "%s: sigma at w = (%.6g, %.6g, %.6g)", what, w.x, w.y, w.z);
    }
}

void aspi_law_rotation(aspi_trial *t)
{
    double angle = 1 + 4 * aspi_uniform(t), c = cos(angle), s = sin(angle);
    asp_map map = t->ndf->map, turned;
    asp_ndf other;
    char what[40] = "turned";
    turned.m00 = c * map.m00 - s * map.m10;
    turned.m01 = c * map.m01 - s * map.m11;
    turned.m10 = s * map.m00 + c * map.m10;
    turned.m11 = s * map.m01 + c * map.m11;
    turned.tx = c * map.tx - s * map.ty;
    turned.ty = s * map.tx + c * map.ty;
    other = with_map(t->ndf, &turned);
    compare(t, t->ndf, &other, c, s, 1, what);
}

void aspi_law_matrix(aspi_trial *t)
{
    double B[9], A[9], S[9];
    asp_map back;
    asp_roughness five = asp_map_to_roughness(&t->ndf->map);
    asp_ndf other;
    int i, j;
    /* what is narrow beside the mean slope loses digits to it when the columns of A are split, and
     * twice as many when A^T A squares them first */
    double tilt = hypot(t->ndf->map.tx, t->ndf->map.ty);
    double own = t->ndf->model->own_scale ? fmin(t->scale, 1) : 1;
    double narrow = (1 + tilt + five.alpha_x) / (five.alpha_y * own);
    double once = 1 + 0.02 * narrow, twice = once + 0.02 * narrow * narrow;
    if (t->planar) /* A^T A alone does not tell how a surface that is not round lies in it */
        return;
    /* D depends on A^T A alone: A is turned from the left, and scaled */
    asp_vec3 a = aspi_random_direction(t), b, c;
    asp_map_to_matrix(&t->ndf->map, B);
    b = fabs(a.x) < 0.7 ? aspi_unit(0, a.z, -a.y) : aspi_unit(-a.z, 0, a.x);
    c.x = a.y * b.z - a.z * b.y;
    c.y = a.z * b.x - a.x * b.z;
    c.z = a.x * b.y - a.y * b.x;
    for (j = 0; j < 3; j++) {
        A[j] = 3.7 * (a.x * B[j] + a.y * B[3 + j] + a.z * B[6 + j]);
        A[3 + j] = 3.7 * (b.x * B[j] + b.y * B[3 + j] + b.z * B[6 + j]);
        A[6 + j] = 3.7 * (c.x * B[j] + c.y * B[3 + j] + c.z * B[6 + j]);
    }
    if (asp_map_from_matrix(A, &back, NULL) != ASP_OK)
        aspi_find(t, INFINITY, 0, "asp_map_from_matrix refused the matrix of the map");
    else {
        other = with_map(t->ndf, &back);
        compare(t, t->ndf, &other, 1, 0, once, "map -> A -> map");
    }
    for (i = 0; i < 3; i++)
        for (j = 0; j < 3; j++)
            S[3 * i + j] = A[i] * A[j] + A[3 + i] * A[3 + j] + A[6 + i] * A[6 + j];
    /* positive definite to the last digit only as long as those digits are left */
    if (asp_map_from_gram(S, &back, NULL) == ASP_OK) {
        other = with_map(t->ndf, &back);
        compare(t, t->ndf, &other, 1, 0, twice, "A^T A -> map");
    } else if (narrow < 1e6)
        aspi_find(t, INFINITY, 0, "asp_map_from_gram refused A^T A of the map");
    if (asp_map_from_roughness(five.alpha_x, five.alpha_y, five.rotation, five.mean_x, five.mean_y,
                               &back, NULL) != ASP_OK)
        aspi_find(t, INFINITY, 0, "asp_map_from_roughness refused the five numbers of the map");
    else {
        other = with_map(t->ndf, &back);
        compare(t, t->ndf, &other, 1, 0, 1 + five.alpha_x / five.alpha_y,
                "map -> five numbers -> map");
    }
    if (!(five.alpha_x >= five.alpha_y && five.rotation > -0.5000001 * ASPI_PI
          && five.rotation < 0.5000001 * ASPI_PI))
        aspi_find(t, INFINITY, 0, "asp_map_to_roughness: alpha %g, %g, rotation %g",
                  five.alpha_x, five.alpha_y, five.rotation);
}
