/* rgl.c - materials of the RGL database (EPFL), isotropic and anisotropic, RGB
 *
 * J. Dupuy, W. Jakob, An Adaptive Parameterization for Efficient Material Acquisition and
 * Rendering, SIGGRAPH Asia 2018. The measurement is stored over the unit square of a visible normal
 * sampler: (u, v) = the pair of uniform numbers that make the half vector m appear from wi, found by
 * inverting the tabulated density `vndf`. Then
 *
 *     f cos(theta_o) = rgb(u, v; wi) ndf(m) / (4 sigma(wi))
 *
 * with angles in the unit square as u = sqrt(2 theta / pi), v = (phi + pi) / (2 pi); the azimuth of m
 * counts from that of wi where the material is isotropic (at most two phi_i). Colours that the
 * conversion from spectra put outside sRGB are clipped at 0, as the database's loader does; the
 * description says how many. Where
 * `jacobian` is 0 the stored values are f cos(theta_o) themselves. */
#include "tensor.h"
#include "warp.h"

#include <stdlib.h>
#include <string.h>

typedef struct rgl {
    aspi_warp ndf, sigma, vndf, rgb;
    double *phi, *theta;                 /* of the slices */
    size_t  n_phi, n_theta;
    int     isotropic, jacobian;
    int     symmetry;                    /* 1, 2 or 4: what part of the circle phi_i covers */
} rgl;

static void rgl_release(void *data)
{
    rgl *m = data;
    if (!m)
        return;
    aspi_warp_clear(&m->ndf);
    aspi_warp_clear(&m->sigma);
    aspi_warp_clear(&m->vndf);
    aspi_warp_clear(&m->rgb);
    free(m->phi);
    free(m->theta);
    free(m);
}

/* ------------------------------------------------------------------ evaluation */

static double clamp01(double x) { return x < 0 ? 0 : x > 1 ? 1 : x; }

/* The interval of a list of increasing numbers that x falls into, and its place there. */
static size_t interval(const double *list, size_t n, double x, double *inside)
{
    size_t low = 0, high = n - 1;
    *inside = 0;
    if (n == 1)
        return 0;
    while (high - low > 1) {
        size_t middle = low + (high - low) / 2;
        if (list[middle] <= x)
            low = middle;
        else
            high = middle;
    }
    *inside = clamp01((x - list[low]) / (list[low + 1] - list[low]));
    return low;
}

static void add_slice(aspi_blend *blend, size_t slice, double weight)
{
    if (weight > 0) {
        blend->slice[blend->count] = slice;
        blend->weight[blend->count++] = weight;
    }
}

static aspi_blend blend_of(const rgl *m, double phi, double theta)
{
    double p, t;
    size_t i = interval(m->phi, m->n_phi, phi, &p), j = interval(m->theta, m->n_theta, theta, &t);
    aspi_blend blend = { 0, { 0 }, { 0 } };
    add_slice(&blend, i * m->n_theta + j, (1 - p) * (1 - t));
    add_slice(&blend, i * m->n_theta + j + 1, (1 - p) * t);
    add_slice(&blend, (i + 1) * m->n_theta + j, p * (1 - t));
    add_slice(&blend, (i + 1) * m->n_theta + j + 1, p * t);
    return blend;
}

/* The same slices of a table that has three channels per slice. */
static aspi_blend of_channel(aspi_blend blend, int channel)
{
    for (int i = 0; i < blend.count; i++)
        blend.slice[i] = 3 * blend.slice[i] + (size_t)channel;
    return blend;
}

/* Turns both directions into the part of the circle that was measured: phi_i in [-pi, 0] by a half
 * turn, or in [-pi, -pi/2] by mirrors. */
static void fold(int symmetry, asp_vec3 *wi, asp_vec3 *wo)
{
    int flip_y = symmetry >= 2 && wi->y > 0;
    int flip_x = symmetry == 4 ? wi->x > 0 : flip_y;
    if (flip_x) {
        wi->x = -wi->x;
        wo->x = -wo->x;
    }
    if (flip_y) {
        wi->y = -wi->y;
        wo->y = -wo->y;
    }
}

static double theta_of(asp_vec3 w) { return atan2(sqrt(w.x * w.x + w.y * w.y), w.z); }
static double phi_of(asp_vec3 w) { return w.x == 0 && w.y == 0 ? 0 : atan2(w.y, w.x); }
static double theta_to_unit(double theta) { return sqrt(theta * (2 / ASPI_PI)); }

/* The tables are not quite periodic, so directions in the plane of incidence, which lie on the seam
 * at phi = pi, must not fall to its two sides by rounding: the last 3e-8 of the circle, which are 1
 * in the float32 of the files, belong to v = 0. */
static double phi_to_unit(double phi)
{
    double v = (phi + ASPI_PI) / (2 * ASPI_PI);
    v -= floor(v);
    return v > 1 - 3e-8 ? 0 : v;
}

static asp_rgb rgl_eval(const void *data, asp_vec3 wi, asp_vec3 wo)
{
    const rgl *m = data;
    static const aspi_blend single = { 1, { 0 }, { 1 } };
    double f[3], u, v, scale = 1;
    if (wo.z < 1e-100)                                     /* the quotient would overflow */
        return (asp_rgb){ 0, 0, 0 };
    double cosine = wo.z;
    fold(m->symmetry, &wi, &wo);
    asp_vec3 h = { wi.x + wo.x, wi.y + wo.y, wi.z + wo.z };
    double theta_i = theta_of(wi), phi_i = phi_of(wi);
    double x = theta_to_unit(theta_of(h));
    double y = phi_to_unit(m->isotropic ? phi_of(h) - phi_i : phi_of(h));
    aspi_blend blend = blend_of(m, phi_i, theta_i);
    aspi_warp_invert(&m->vndf, &blend, x, y, &u, &v);
    if (m->jacobian) {
        double sigma = aspi_warp_eval(&m->sigma, &single, theta_to_unit(theta_i),
                                      (phi_i + ASPI_PI) / (2 * ASPI_PI));
        if (sigma < 1e-20)
            return (asp_rgb){ 0, 0, 0 };
        scale = aspi_warp_eval(&m->ndf, &single, x, y) / (4 * sigma);
    }
    for (int c = 0; c < 3; c++) {
        aspi_blend channel = of_channel(blend, c);
        f[c] = fmax(0, aspi_warp_eval(&m->rgb, &channel, u, v)) * scale / cosine;
    }
    return (asp_rgb){ f[0], f[1], f[2] };
}

static asp_status rgl_write_csv(const asp_measured *measured, aspi_out *out, asp_error *err)
{
    return aspi_csv_sampled(measured, out, err);
}

const aspi_kind aspi_kind_rgl = { rgl_eval, rgl_release, rgl_write_csv };

/* ------------------------------------------------------------------ reading */

enum { PHI, THETA, NDF, SIGMA, VNDF, RGB, DESCRIPTION, JACOBIAN, SPECTRA, LUMINANCE, FIELDS };

#define LARGEST 1e20                     /* products of three stay far below the largest double */

static asp_status fail_field(const aspi_bytes *file, const aspi_tensor *t, const char *reason,
                             asp_error *err)
{
    return aspi_tensor_fail(file, t, reason, err);
}

/* Presence, type, rank and the sizes that must agree. */
static asp_status check_shapes(const aspi_bytes *file, const aspi_tensor *t, asp_error *err)
{
    static const int rank[FIELDS] = { 1, 1, 2, 2, 4, 5, 1, 1, 0, 0 };
    if (!t[RGB].type && t[SPECTRA].type)
        return fail_field(file, &t[SPECTRA], "a spectral file; the RGB one (_rgb.bsdf) is read",
                          err);
    for (int i = PHI; i <= JACOBIAN; i++) {
        int optional = i == DESCRIPTION || i == JACOBIAN;
        if (!t[i].type) {
            if (optional)
                continue;
            return aspi_fail_at(err, ASP_EFORMAT, file->name, 14, t[i].name,
                                "this field is missing");
        }
        if (t[i].type != (optional ? ASPI_TENSOR_UINT8 : ASPI_TENSOR_FLOAT32))
            return fail_field(file, &t[i], optional ? "elements must be uint8"
                                                    : "elements must be float32", err);
        if (t[i].rank != rank[i])
            return fail_field(file, &t[i], "wrong number of dimensions", err);
        if (!t[i].elements && i != DESCRIPTION)
            return fail_field(file, &t[i], "a size of 0", err);
    }
    for (int i = NDF; i <= RGB; i++) {
        int last = t[i].rank - 1;
        if (t[i].size[last] < 2 || t[i].size[last - 1] < 2)
            return fail_field(file, &t[i], "needs at least 2 x 2 points", err);
        if (i >= VNDF && (t[i].size[0] != t[PHI].size[0] || t[i].size[1] != t[THETA].size[0]))
            return fail_field(file, &t[i], "sizes do not agree with phi_i and theta_i", err);
    }
    if (t[RGB].size[2] != 3)
        return fail_field(file, &t[RGB], "needs 3 channels", err);
    if (t[LUMINANCE].type && t[LUMINANCE].type != ASPI_TENSOR_FLOAT32)
        return fail_field(file, &t[LUMINANCE], "elements must be float32", err);
    return ASP_OK;
}

/* The angles of the slices must increase. */
static asp_status check_angles(const aspi_bytes *file, const aspi_tensor *t, const double *angle,
                               asp_error *err)
{
    for (size_t i = 1; i < t->elements; i++)
        if (!(angle[i] - angle[i - 1] > 1e-6))
            return aspi_fail_at(err, ASP_EFORMAT, file->name, (long long)(t->offset + 4 * i),
                                t->name, "angles must increase");
    return ASP_OK;
}

static asp_status find_symmetry(const aspi_bytes *file, const aspi_tensor *t, rgl *m,
                                asp_error *err)
{
    m->isotropic = m->n_phi <= 2;
    m->symmetry = 1;
    if (m->isotropic)
        return ASP_OK;
    double parts = 2 * ASPI_PI / (m->phi[m->n_phi - 1] - m->phi[0]);
    m->symmetry = parts < 1.5 ? 1 : parts < 3 ? 2 : 4;
    if (parts < 0.9 || fabs(parts / m->symmetry - 1) > 0.1)
        return fail_field(file, t, "phi_i must cover a circle, a half or a quarter of it", err);
    if (fabs(m->phi[0] + ASPI_PI) > 0.1)
        return fail_field(file, t, "phi_i must begin at -pi", err);
    return ASP_OK;
}

static asp_status read_warp(const aspi_bytes *file, const aspi_tensor *t, double low, int density,
                            aspi_warp *warp, asp_error *err)
{
    double *value = aspi_tensor_numbers(file, t, low, LARGEST, err);
    if (!value)
        return ASP_EFORMAT;
    size_t nx = (size_t)t->size[t->rank - 1], ny = (size_t)t->size[t->rank - 2];
    long long made = aspi_warp_make(warp, value, nx, ny, t->elements / (nx * ny), density);
    if (made == 0)
        return aspi_fail_at(err, ASP_ENOMEM, file->name, -1, t->name, "out of memory");
    if (made < 0) {
        char reason[96];
        snprintf(reason, sizeof reason, "slice %lld is zero everywhere", -1 - made);
        return fail_field(file, t, reason, err);
    }
    return ASP_OK;
}

/* Nothing is computed from the luminance, but a file with numbers that are none is damaged. */
static asp_status check_luminance(const aspi_bytes *file, const aspi_tensor *t, asp_error *err)
{
    if (!t->type || !t->elements)
        return ASP_OK;
    double *value = aspi_tensor_numbers(file, t, -LARGEST, LARGEST, err);
    free(value);
    return value ? ASP_OK : ASP_EFORMAT;
}

static asp_status read_fields(const aspi_bytes *file, const aspi_tensor *t, rgl *m, asp_error *err)
{
    m->n_phi = t[PHI].elements;
    m->n_theta = t[THETA].elements;
    m->jacobian = !t[JACOBIAN].type || file->bytes[t[JACOBIAN].offset] != 0;
    m->phi = aspi_tensor_numbers(file, &t[PHI], -7, 7, err);
    m->theta = m->phi ? aspi_tensor_numbers(file, &t[THETA], 0, 1.5709, err) : NULL;
    if (!m->phi || !m->theta)
        return ASP_EFORMAT;
    asp_status status = check_angles(file, &t[PHI], m->phi, err);
    if (status == ASP_OK)
        status = check_angles(file, &t[THETA], m->theta, err);
    if (status == ASP_OK)
        status = find_symmetry(file, &t[PHI], m, err);
    if (status == ASP_OK)
        status = read_warp(file, &t[NDF], 0, 0, &m->ndf, err);
    if (status == ASP_OK)
        status = read_warp(file, &t[SIGMA], 0, 0, &m->sigma, err);
    if (status == ASP_OK)
        status = read_warp(file, &t[VNDF], 0, 1, &m->vndf, err);
    if (status == ASP_OK)
        status = read_warp(file, &t[RGB], -LARGEST, 0, &m->rgb, err);
    if (status == ASP_OK)
        status = check_luminance(file, &t[LUMINANCE], err);
    return status;
}

/* `63 % of red, 2 % of blue values are negative and read as 0`, "" where none is. */
static void remark_of(const aspi_warp *rgb, char *text, size_t size)
{
    static const char *const name[3] = { "red", "green", "blue" };
    size_t points = rgb->nx * rgb->ny, of_each = rgb->slices / 3 * points, used = 0;
    text[0] = 0;
    for (size_t c = 0; c < 3; c++) {
        size_t negative = 0;
        for (size_t slice = c; slice < rgb->slices; slice += 3)
            for (size_t i = 0; i < points; i++)
                negative += rgb->value[slice * points + i] < 0;
        double percent = 100 * (double)negative / (double)of_each;
        if (negative && used < size)
            used += (size_t)snprintf(text + used, size - used, percent < 9.95 ? "%s%.2g %% of %s"
                                     : "%s%.0f %% of %s", used ? ", " : "", percent, name[c]);
    }
    if (used && used < size)
        snprintf(text + used, size - used, " values are negative and read as 0");
}

static asp_measured *rgl_read(const aspi_bytes *file, asp_error *err)
{
    aspi_tensor t[FIELDS] = {
        { .name = "phi_i" }, { .name = "theta_i" }, { .name = "ndf" }, { .name = "sigma" },
        { .name = "vndf" }, { .name = "rgb" }, { .name = "description" }, { .name = "jacobian" },
        { .name = "spectra" }, { .name = "luminance" }
    };
    if (aspi_read_tensors(file, t, FIELDS, err) != ASP_OK || check_shapes(file, t, err) != ASP_OK)
        return NULL;
    rgl *m = calloc(1, sizeof *m);
    if (!m) {
        aspi_fail_at(err, ASP_ENOMEM, file->name, -1, "", "out of memory");
        return NULL;
    }
    if (read_fields(file, t, m, err) != ASP_OK) {
        rgl_release(m);
        return NULL;
    }
    asp_measured_info info = { "rgl", "", m->isotropic, 0, 3, t[RGB].elements };
    const char *text = "";
    size_t length = 0;
    if (t[DESCRIPTION].type) {
        text = (const char *)file->bytes + t[DESCRIPTION].offset;
        length = t[DESCRIPTION].elements;
    }
    char remark[160];
    remark_of(&m->rgb, remark, sizeof remark);
    return aspi_measured_remark(aspi_measured_wrap(&aspi_kind_rgl, m, info, text, length, err),
                                remark, err);
}

const aspi_format aspi_format_rgl = {
    "rgl", "tensor_file (RGL material database)", aspi_is_tensor_file, rgl_read
};
