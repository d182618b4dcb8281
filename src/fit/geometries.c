/* geometries.c - which geometries of a measurement a fit sees
 *
 * Gridded data are read at centres of MERL's bins (theta_h = ((i + 1/2)/90)^2 90 degrees), which are
 * dense where lobes are narrow and where a MERL table gives back a stored value. */
#include "fit.h"

#include <stdlib.h>
#include <string.h>

#define DEGREE 0.017453292519943295769
#define COS_GRAZING 0.17364817766693034885    /* cos 80 degrees */

/* phi_d over half a turn: the other half is its mirror image, and phi_d + 180 degrees exchanges wi
 * and wo, which instruments do not do exactly. */
static const double phi_d_degrees[] = { 11.5, 33.5, 56.5, 78.5, 101.5, 123.5, 146.5, 168.5 };
#define PHIS (sizeof phi_d_degrees / sizeof phi_d_degrees[0])

/* Directions of half and difference angles (Rusinkiewicz 1998): wi has theta_d, phi_d in the frame in
 * which the half vector is +z, and wo is its mirror image about the half vector. */
static void from_half(double theta_h, double phi_h, double theta_d, double phi_d, asp_vec3 *wi,
                      asp_vec3 *wo)
{
    double sh = sin(theta_h), ch = cos(theta_h), sd = sin(theta_d), cd = cos(theta_d);
    double x = sd * cos(phi_d), y = sd * sin(phi_d);
    double sp = sin(phi_h), cp = cos(phi_h);
    for (int side = 0; side < 2; side++) {
        double u = ch * x + sh * cd, w = ch * cd - sh * x;
        *(side ? wo : wi) = (asp_vec3){ cp * u - sp * y, sp * u + cp * y, w };
        x = -x;
        y = -y;
    }
}

static int usable(const asp_measurement *m)
{
    if (!(m->wi.z >= COS_GRAZING && m->wo.z >= COS_GRAZING))
        return 0;
    return isfinite(m->f.r) && isfinite(m->f.g) && isfinite(m->f.b);
}

static size_t from_list(const asp_measurement *item, size_t count, asp_measurement *out)
{
    size_t n = 0;
    for (size_t i = 0; i < count; i++)
        if (usable(&item[i]))
            out[n++] = item[i];
    return n;
}

static size_t from_grid(const asp_measured *measured, int isotropic, asp_measurement *out)
{
    size_t n = 0;
    for (int i = 0; i < 84; i++) {
        double u = (i + 0.5) / 90, theta_h = u * u * 90 * DEGREE;
        for (int j = 2; j < 80; j += 5)
            for (size_t k = 0; k < PHIS; k++)
                for (int turn = 0; turn < (isotropic ? 1 : 4); turn++) {
                    asp_measurement m;
                    from_half(theta_h, turn * 45 * DEGREE, (j + 0.5) * DEGREE,
                              phi_d_degrees[k] * DEGREE, &m.wi, &m.wo);
                    m.f = asp_measured_eval(measured, m.wi, m.wo);
                    if (usable(&m) && (m.f.r > 0 || m.f.g > 0 || m.f.b > 0))
                        out[n++] = m;
                }
    }
    return n;
}

asp_measurement *asp_fit_geometries(const asp_measured *measured, size_t *count, asp_error *err)
{
    if (!measured || !count) {
        asp_fail(err, ASP_EINVAL, measured ? "count" : "measured", "nothing given");
        return NULL;
    }
    asp_measured_info info = asp_measured_get_info(measured);
    size_t listed = 0, room = 84 * 16 * PHIS * 4;
    const asp_measurement *list = info.scattered ? asp_measured_geometries(measured, &listed) : NULL;
    asp_measurement *out = malloc((info.scattered ? listed + 1 : room) * sizeof *out);
    if (!out) {
        asp_fail(err, ASP_ENOMEM, "", "not enough memory for the geometries");
        return NULL;
    }
    size_t n = info.scattered ? from_list(list, listed, out)
                              : from_grid(measured, info.isotropic, out);
    if (!n) {
        free(out);
        asp_fail(err, ASP_EFORMAT, "",
                 "the measurement has no usable value at any geometry below 80 degrees");
        return NULL;
    }
    *count = n;
    return out;
}

asp_status aspi_fit_set_make(const asp_measurement *item, size_t count, size_t stride, int channels,
                             aspi_fit_set *out, asp_error *err)
{
    size_t n = (count + stride - 1) / stride;
    double *memory = malloc(11 * n * sizeof *memory);
    if (!memory)
        return asp_fail(err, ASP_ENOMEM, "", "not enough memory for the geometries");
    double **array[] = { &out->wi_x, &out->wi_y, &out->wi_z, &out->wo_x, &out->wo_y, &out->wo_z,
                         &out->cos_d, &out->data[0], &out->data[1], &out->data[2], &out->weight };
    for (size_t a = 0; a < sizeof array / sizeof array[0]; a++)
        *array[a] = memory + a * n;
    out->n = n;
    out->channels = channels;
    out->memory = memory;
    for (size_t i = 0; i < n; i++) {
        const asp_measurement *m = &item[i * stride];
        double dot = m->wi.x * m->wo.x + m->wi.y * m->wo.y + m->wi.z * m->wo.z;
        out->wi_x[i] = m->wi.x;
        out->wi_y[i] = m->wi.y;
        out->wi_z[i] = m->wi.z;
        out->wo_x[i] = m->wo.x;
        out->wo_y[i] = m->wo.y;
        out->wo_z[i] = m->wo.z;
        out->cos_d[i] = sqrt(fmax(0, (1 + dot) / 2));
        out->data[0][i] = m->f.r;
        out->data[1][i] = m->f.g;
        out->data[2][i] = m->f.b;
        out->weight[i] = 1;
    }
    return ASP_OK;
}

void aspi_fit_set_free(aspi_fit_set *set)
{
    free(set->memory);
    memset(set, 0, sizeof *set);
}
