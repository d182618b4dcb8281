/* map.c - slope maps and the Ellipsoid NDF's matrix
 *
 * Walter, Dong, Marschner, Greenberg 2014, eqs. 1-3; the identity between A and the slope map, and
 * its way back, follow from S = A^T A: D depends on A through S alone, up to its scale. */
#define ASP_PRECISION 64
#include "asperity.h"
#include "asperity/elementary.h"

#define ALPHA_LOW 1e-5
#define ALPHA_HIGH 100.0
#define MEAN_HIGH 100.0

static asp_status check_range(const char *name, double value, double low, double high,
                              asp_error *err)
{
    return value >= low && value <= high ? ASP_OK : asp_fail_range(err, name, value, low, 0, high);
}

static asp_status check_common(double alpha_x, double alpha_y, double mean_x, double mean_y,
                               asp_error *err)
{
    asp_status s = check_range("alpha_x", alpha_x, ALPHA_LOW, ALPHA_HIGH, err);
    if (!s)
        s = check_range("alpha_y", alpha_y, ALPHA_LOW, ALPHA_HIGH, err);
    if (!s)
        s = check_range("mean_x", mean_x, -MEAN_HIGH, MEAN_HIGH, err);
    if (!s)
        s = check_range("mean_y", mean_y, -MEAN_HIGH, MEAN_HIGH, err);
    return s;
}

/* cos and sin of any angle that a user would write. */
static asp_vec2 cos_sin(double angle)
{
    return aspi_sincos2pi(angle * (0.5 / ASP_PI));
}

asp_status asp_map_from_roughness(double alpha_x, double alpha_y, double rotation, double mean_x,
                                  double mean_y, asp_map *out, asp_error *err)
{
    asp_vec2 t;
    asp_status s = check_common(alpha_x, alpha_y, mean_x, mean_y, err);
    if (!s)
        s = check_range("rotation", rotation, -1e4, 1e4, err);
    if (s)
        return s;
    t = cos_sin(rotation);
    out->m00 = t.x * alpha_x;
    out->m01 = -t.y * alpha_y;
    out->m10 = t.y * alpha_x;
    out->m11 = t.x * alpha_y;
    out->tx = mean_x;
    out->ty = mean_y;
    return ASP_OK;
}

asp_status asp_map_from_correlation(double alpha_x, double alpha_y, double rho, double mean_x,
                                    double mean_y, asp_map *out, asp_error *err)
{
    asp_status s = check_common(alpha_x, alpha_y, mean_x, mean_y, err);
    if (s)
        return s;
    if (!(rho > -1.0 && rho < 1.0)) {
        asp_fail(err, ASP_EINVAL, "rho", "must lie between -1 and 1, both excluded");
        if (err)
            err->value = rho;
        return ASP_EINVAL;
    }
    out->m00 = alpha_x;
    out->m01 = 0.0;
    out->m10 = rho * alpha_y;
    out->m11 = alpha_y * aspi_sqrt((1.0 - rho) * (1.0 + rho));
    out->tx = mean_x;
    out->ty = mean_y;
    return ASP_OK;
}

asp_status asp_ellipsoid_matrix(double alpha_x, double alpha_y, double theta_x, double theta_y,
                                double theta_z, double A[9], asp_error *err)
{
    asp_status s = check_common(alpha_x, alpha_y, 0.0, 0.0, err);
    asp_vec2 x, y, z;
    if (!s)
        s = check_range("theta_x", theta_x, -0.5 * ASP_PI, 0.5 * ASP_PI, err);
    if (!s)
        s = check_range("theta_y", theta_y, -0.5 * ASP_PI, 0.5 * ASP_PI, err);
    if (!s)
        s = check_range("theta_z", theta_z, -1e4, 1e4, err);
    if (s)
        return s;
    x = cos_sin(theta_x);
    y = cos_sin(theta_y);
    z = cos_sin(theta_z);
    /* rows of Rx Ry Rz, each scaled */
    A[0] = alpha_x * (y.x * z.x);
    A[1] = alpha_x * (-y.x * z.y);
    A[2] = alpha_x * y.y;
    A[3] = alpha_y * (x.y * y.y * z.x + x.x * z.y);
    A[4] = alpha_y * (x.x * z.x - x.y * y.y * z.y);
    A[5] = alpha_y * (-x.y * y.x);
    A[6] = x.y * z.y - x.x * y.y * z.x;
    A[7] = x.x * y.y * z.y + x.y * z.x;
    A[8] = x.x * y.x;
    return ASP_OK;
}

/* M from the two horizontal columns of A, with what is along A n taken out of each:
 * S/S33 - mean mean^T = B^T B, B = (columns - A n (mean)) / |A n|, so M = R^T of B = Q R. Unlike a
 * difference of entries of S, this loses nothing when the mean slope is large. */
static asp_status map_from_columns(const double a[3], const double b[3], const double c[3],
                                   asp_map *out, asp_error *err)
{
    double c2 = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
    double xa, xb, length, ra, rb, p[3], q[3];
    asp_map map;
    int i;
    if (!(c2 > 1e-200) || !(c2 < 1e200))
        return asp_fail(err, ASP_EINVAL, "A",
                        "the third column, A n, must be longer than 1e-100 and shorter than 1e100");
    length = aspi_sqrt(c2);
    xa = (a[0] * c[0] + a[1] * c[1] + a[2] * c[2]) / c2;
    xb = (b[0] * c[0] + b[1] * c[1] + b[2] * c[2]) / c2;
    for (i = 0; i < 3; i++) {
        p[i] = (a[i] - xa * c[i]) / length;
        q[i] = (b[i] - xb * c[i]) / length;
    }
    ra = aspi_sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    if (!(ra >= ALPHA_LOW * 1e-3))
        return asp_fail(err, ASP_EINVAL, "A", "not invertible: its columns are dependent");
    rb = (p[0] * q[0] + p[1] * q[1] + p[2] * q[2]) / ra;
    for (i = 0; i < 3; i++)
        q[i] -= p[i] * (rb / ra);
    map.m00 = ra;
    map.m01 = 0.0;
    map.m10 = rb;
    map.m11 = aspi_sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2]);
    map.tx = -xa;
    map.ty = -xb;
    if (!(map.m11 >= ALPHA_LOW * 1e-3))
        return asp_fail(err, ASP_EINVAL, "A", "not invertible: its columns are dependent");
    if (!(aspi_abs(map.tx) <= MEAN_HIGH))
        return asp_fail_range(err, "mean_x of A", map.tx, -MEAN_HIGH, 0, MEAN_HIGH);
    if (!(aspi_abs(map.ty) <= MEAN_HIGH))
        return asp_fail_range(err, "mean_y of A", map.ty, -MEAN_HIGH, 0, MEAN_HIGH);
    if (!(ra <= ALPHA_HIGH && aspi_abs(rb) <= ALPHA_HIGH && map.m11 <= ALPHA_HIGH))
        return asp_fail(err, ASP_EINVAL, "A", "rougher than alpha = 100");
    *out = map;
    return ASP_OK;
}

asp_status asp_map_from_matrix(const double A[9], asp_map *out, asp_error *err)
{
    double a[3], b[3], c[3];
    int i;
    for (i = 0; i < 3; i++) {
        a[i] = A[3 * i];
        b[i] = A[3 * i + 1];
        c[i] = A[3 * i + 2];
    }
    return map_from_columns(a, b, c, out, err);
}

asp_status asp_map_from_gram(const double S[9], asp_map *out, asp_error *err)
{
    /* a triangular A with A^T A = S: last column (0, 0, sqrt S33) */
    double c = aspi_sqrt(S[8] > 0.0 ? S[8] : 0.0), a[3], b[3], n[3];
    double largest = 0.0, skew = 0.0, d00, d01, d11;
    int i;
    for (i = 0; i < 9; i++)
        largest = aspi_max(largest, aspi_abs(S[i]));
    skew = aspi_max(aspi_abs(S[1] - S[3]),
                    aspi_max(aspi_abs(S[2] - S[6]), aspi_abs(S[5] - S[7])));
    if (!(skew <= 1e-12 * largest))
        return asp_fail(err, ASP_EINVAL, "S", "not symmetric");
    if (!(c > 0.0))
        return asp_fail(err, ASP_EINVAL, "S", "not positive definite");
    a[2] = S[2] / c;
    b[2] = S[5] / c;
    d00 = S[0] - a[2] * a[2];
    d01 = S[1] - a[2] * b[2];
    if (!(d00 > 0.0))
        return asp_fail(err, ASP_EINVAL, "S", "not positive definite");
    a[0] = aspi_sqrt(d00);
    a[1] = 0.0;
    b[0] = d01 / a[0];
    d11 = S[4] - b[2] * b[2] - b[0] * b[0];
    if (!(d11 > 0.0))
        return asp_fail(err, ASP_EINVAL, "S", "not positive definite");
    b[1] = aspi_sqrt(d11);
    n[0] = n[1] = 0.0;
    n[2] = c;
    return map_from_columns(a, b, n, out, err);
}

void asp_map_to_matrix(const asp_map *map, double A[9])
{
    A[0] = map->m00;
    A[1] = map->m10;
    A[2] = 0.0;
    A[3] = map->m01;
    A[4] = map->m11;
    A[5] = 0.0;
    A[6] = -map->tx;
    A[7] = -map->ty;
    A[8] = 1.0;
}

/* Singular values of M by one exact rotation: with E, H half the difference and sum on the diagonal
 * and F, G on the other, they are |(E,F)| and |(H,G)| added and subtracted; the small one comes from
 * the determinant, which cancels less. */
asp_roughness asp_map_to_roughness(const asp_map *map)
{
    double a = map->m00, b = map->m01, c = map->m10, d = map->m11;
    double e = 0.5 * (a - d), f = 0.5 * (c + b), g = 0.5 * (c - b), h = 0.5 * (a + d);
    double q = aspi_sqrt(h * h + g * g), r = aspi_sqrt(e * e + f * f);
    double det = a * d - b * c;
    asp_roughness out;
    out.alpha_x = q + r;
    out.alpha_y = aspi_min(aspi_abs(det) / out.alpha_x, out.alpha_x);
    /* the left rotation: half the sum of the two angles */
    out.rotation = r > 1e-15 * q && q > 1e-15 * r
                 ? 0.5 * (aspi_atan(f, e) + aspi_atan(g, h)) : (q > r ? 0.0 : 0.5 * aspi_atan(f, e));
    if (out.rotation > 0.5 * ASP_PI)
        out.rotation -= ASP_PI;
    if (out.rotation <= -0.5 * ASP_PI)
        out.rotation += ASP_PI;
    out.mean_x = map->tx;
    out.mean_y = map->ty;
    return out;
}
