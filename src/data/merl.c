/* merl.c - the MERL database's table
 *
 * W. Matusik, H. Pfister, M. Brand, L. McMillan, A Data-Driven Reflectance Model, SIGGRAPH 2003.
 * Three int32 dimensions (90 theta_h, 90 theta_d, 180 phi_d), then for red, green and blue one
 * double per bin, little-endian, phi_d fastest. Bin i of theta_h covers (i/90)^2 .. ((i+1)/90)^2 of
 * a right angle; theta_d and phi_d are in steps of a degree; phi_d and phi_d + 180 degrees are one
 * bin by reciprocity. Negative: no value. f = value * (1, 1.15, 1.66) / 1500.
 *
 * The database's own reader takes the bin a geometry falls into. Here a bin's value stands at its
 * centre and f is linear between centres in sqrt(theta_h), theta_d and phi_d (which is periodic);
 * bins without a value lend their weight to the others. */
#include "measured.h"

#include <stdlib.h>
#include <string.h>

const double aspi_merl_scale[3] = { 1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0 };

#define HEADER 12

static uint32_t u32_at(const unsigned char *p)
{
    return (uint32_t)p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static double double_at(const unsigned char *p)
{
    uint64_t bits = (uint64_t)u32_at(p) | (uint64_t)u32_at(p + 4) << 32;
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static size_t bins_of(const aspi_merl *merl) { return merl->n_h * merl->n_d * merl->n_p; }

aspi_merl *aspi_merl_new(size_t n_h, size_t n_d, size_t n_p)
{
    aspi_merl *merl = malloc(sizeof *merl);
    if (!merl)
        return NULL;
    merl->n_h = n_h;
    merl->n_d = n_d;
    merl->n_p = n_p;
    size_t n = 3 * bins_of(merl);
    merl->values = malloc(n * sizeof *merl->values);
    if (!merl->values) {
        free(merl);
        return NULL;
    }
    for (size_t i = 0; i < n; i++)
        merl->values[i] = -1;
    return merl;
}

static void merl_release(void *data)
{
    aspi_merl *merl = data;
    if (merl)
        free(merl->values);
    free(merl);
}

/* ------------------------------------------------------------------ evaluation */

/* One axis of the interpolation: the bins on either side of a position counted in bins, and the
 * weight of the second. */
typedef struct side { size_t bin[2]; double weight; } side;

static side side_clamped(double position, size_t n)
{
    side s = { { 0, 0 }, 0 };
    double x = position - 0.5;
    if (x > 0) {
        double cell = floor(x);
        s.bin[0] = cell < (double)(n - 1) ? (size_t)cell : n - 1;
        s.bin[1] = s.bin[0] + 1 < n ? s.bin[0] + 1 : n - 1;
        s.weight = s.bin[1] > s.bin[0] ? x - cell : 0;
    }
    return s;
}

static side side_periodic(double position, size_t n)
{
    side s;
    double x = position - 0.5;
    if (x < 0)
        x += (double)n;
    if (!(x < (double)n))                /* a whisker below 0 rounds up to n */
        x = 0;
    double cell = floor(x);
    s.bin[0] = (size_t)cell;
    s.bin[1] = s.bin[0] + 1 < n ? s.bin[0] + 1 : 0;
    s.weight = x - cell;
    return s;
}

static asp_rgb merl_eval(const void *data, asp_vec3 wi, asp_vec3 wo)
{
    const aspi_merl *merl = data;
    aspi_half a = aspi_half_of(wi, wo);
    double half_pi = ASPI_PI / 2;
    double phi = a.phi_d < 0 ? a.phi_d + ASPI_PI : a.phi_d;
    side h = side_clamped(sqrt(a.theta_h / half_pi) * (double)merl->n_h, merl->n_h);
    side d = side_clamped(a.theta_d / half_pi * (double)merl->n_d, merl->n_d);
    side p = side_periodic(phi / ASPI_PI * (double)merl->n_p, merl->n_p);
    double f[3];
    for (int channel = 0; channel < 3; channel++) {
        const double *values = merl->values + (size_t)channel * bins_of(merl);
        double sum = 0, weights = 0;
        for (int corner = 0; corner < 8; corner++) {
            int ih = corner >> 2, id = corner >> 1 & 1, ip = corner & 1;
            double weight = (ih ? h.weight : 1 - h.weight) * (id ? d.weight : 1 - d.weight)
                          * (ip ? p.weight : 1 - p.weight);
            double value = values[(h.bin[ih] * merl->n_d + d.bin[id]) * merl->n_p + p.bin[ip]];
            if (value >= 0 && weight > 0) {
                sum += weight * value;
                weights += weight;
            }
        }
        f[channel] = weights > 0 ? sum / weights * aspi_merl_scale[channel] : 0;
    }
    return (asp_rgb){ f[0], f[1], f[2] };
}

int aspi_merl_centre(const aspi_merl *merl, size_t i_h, size_t i_d, size_t i_p,
                     asp_vec3 *wi, asp_vec3 *wo)
{
    double u = ((double)i_h + 0.5) / (double)merl->n_h;
    aspi_half a = { u * u * (ASPI_PI / 2), 0,
                    ((double)i_d + 0.5) / (double)merl->n_d * (ASPI_PI / 2),
                    ((double)i_p + 0.5) / (double)merl->n_p * ASPI_PI };
    aspi_half_to(a, wi, wo);
    return wi->z > 0 && wo->z > 0;
}

/* ------------------------------------------------------------------ csv
 *
 * One row per bin, by index; rows of bins without a value (all three -1) are left out as long as a
 * quarter of the rows remains, which the reader asks for before it makes a table. The numbers are f,
 * but what comes back is the stored number itself: 17 digits of the product place it within 5e-17 of
 * its value, less than half the distance of two doubles (2^-54 = 5.6e-17 at the least), provided that
 * product and quotient are rounded later than that, in long double. Where long double is no wider
 * than double, it comes back to one unit in its last place. */

static int is_blank_bin(const double *v, size_t bins)
{
    return v[0] == -1 && v[bins] == -1 && v[2 * bins] == -1;
}

static asp_status merl_write_csv(const asp_measured *measured, aspi_out *out, asp_error *err)
{
    const aspi_merl *merl = measured->data;
    size_t bins = bins_of(merl), at = 0, blank = 0;
    (void)err;
    for (size_t i = 0; i < bins; i++)
        blank += (size_t)is_blank_bin(merl->values + i, bins);
    int skip = bins - blank >= bins / 4;
    aspi_csv_comment(measured, out);
    aspi_out_text(out, "# grid = bins of MERL: theta_h from (i/90)^2 90 to ((i+1)/90)^2 90 deg, "
                       "theta_d from j to j+1 deg, phi_d from k to k+1 deg; negative: no value\n"
                       "theta_h_index,theta_d_index,phi_d_index,r,g,b\n");
    for (size_t i = 0; i < merl->n_h; i++)
        for (size_t j = 0; j < merl->n_d; j++)
            for (size_t k = 0; k < merl->n_p; k++, at++) {
                const double *v = merl->values + at;
                if (skip && is_blank_bin(v, bins))
                    continue;
                char row[64 + 3 * ASPI_NUMBER_TEXT];
                int n = snprintf(row, 64, "%zu,%zu,%zu", i, j, k);
                for (int c = 0; c < 3; c++) {
                    long double f = (long double)v[(size_t)c * bins]
                                  * (long double)aspi_merl_scale[c];
                    row[n++] = ',';
                    n += (int)aspi_format_long_double(f, 17, row + n);
                }
                row[n++] = '\n';
                aspi_out_write(out, row, (size_t)n);
                if (out->failed)             /* a full disk: no use in formatting the rest */
                    return ASP_OK;
            }
    return ASP_OK;
}

const aspi_kind aspi_kind_merl = { merl_eval, merl_release, merl_write_csv };

/* ------------------------------------------------------------------ reading */

aspi_merl *aspi_merl_parse(const aspi_bytes *file, asp_error *err)
{
    static const char *const channel[3] = { "red", "green", "blue" };
    char reason[160];
    size_t dims[3], bins = 1;
    if (file->size < HEADER) {
        aspi_fail_at(err, ASP_EFORMAT, file->name, (long long)file->size, "dimensions",
                     "the file ends inside its header of 12 bytes");
        return NULL;
    }
    /* each dimension is at most 65535, so that three of them cannot overflow 64 bits */
    for (int i = 0; i < 3; i++) {
        dims[i] = u32_at(file->bytes + 4 * i);
        if (dims[i] < 1 || dims[i] > 65535) {
            asp_fail_range(err, "dimensions", (double)(int32_t)dims[i], 1, 0, 65535);
            aspi_error_file(err, file->name);
            if (err) {
                err->status = ASP_EFORMAT;
                err->position = 4 * i;
            }
            return NULL;
        }
    }
    uint64_t wanted = (uint64_t)dims[0] * dims[1] * dims[2];
    if (wanted != (file->size - HEADER) / 24 || (file->size - HEADER) % 24) {
        snprintf(reason, sizeof reason, "%zu x %zu x %zu bins need %llu bytes, the file has %zu",
                 dims[0], dims[1], dims[2], (unsigned long long)(HEADER + 24 * wanted),
                 file->size);
        aspi_fail_at(err, ASP_EFORMAT, file->name, (long long)file->size, "values", reason);
        return NULL;
    }
    bins = (size_t)wanted;
    aspi_merl *merl = aspi_merl_new(dims[0], dims[1], dims[2]);
    if (!merl) {
        aspi_fail_at(err, ASP_ENOMEM, file->name, -1, "", "not enough memory for the table");
        return NULL;
    }
    for (size_t i = 0; i < 3 * bins; i++) {
        double value = double_at(file->bytes + HEADER + 8 * i);
        /* up to 1e30: sums of eight and the scale stay far from overflow */
        if (!(fabs(value) <= 1e30)) {
            snprintf(reason, sizeof reason, "bin %zu is not a finite number below 1e30", i % bins);
            aspi_fail_at(err, ASP_EFORMAT, file->name, (long long)(HEADER + 8 * i),
                         channel[i / bins], reason);
            merl_release(merl);
            return NULL;
        }
        merl->values[i] = value;
    }
    return merl;
}

asp_measured *aspi_merl_wrap(aspi_merl *merl, int channels, const char *description, size_t length,
                             const char *format, asp_error *err)
{
    asp_measured_info info = { format, "", 1, 0, channels, 3 * bins_of(merl) };
    return aspi_measured_wrap(&aspi_kind_merl, merl, info, description, length, err);
}

static int is_size_of_merl(size_t size)
{
    return size == HEADER + 24u * ASPI_MERL_H * ASPI_MERL_D * ASPI_MERL_P;
}

static int has_dims_of_merl(const aspi_bytes *file)
{
    return file->size >= HEADER && u32_at(file->bytes) == ASPI_MERL_H
        && u32_at(file->bytes + 4) == ASPI_MERL_D && u32_at(file->bytes + 8) == ASPI_MERL_P;
}

/* Dimensions or size: a damaged header of a file of the right size deserves its own message. */
static int merl_probe(const aspi_bytes *file)
{
    return has_dims_of_merl(file) || is_size_of_merl(file->size);
}

static asp_measured *merl_read(const aspi_bytes *file, asp_error *err)
{
    if (!has_dims_of_merl(file)) {
        aspi_fail_at(err, ASP_EFORMAT, file->name, 0, "dimensions",
                     "a MERL table has 90 x 90 x 180 bins");
        return NULL;
    }
    aspi_merl *merl = aspi_merl_parse(file, err);
    return merl ? aspi_merl_wrap(merl, 3, "", 0, "merl", err) : NULL;
}

const aspi_format aspi_format_merl = {
    "merl", "three int32 90, 90, 180 (MERL database)", merl_probe, merl_read
};

/* ------------------------------------------------------------------ writing and making */

asp_measured *asp_measured_from_merl_table(const double *values, const char *description,
                                           asp_error *err)
{
    if (!values) {
        asp_fail(err, ASP_EINVAL, "values", "no table given");
        return NULL;
    }
    aspi_merl *merl = aspi_merl_new(ASPI_MERL_H, ASPI_MERL_D, ASPI_MERL_P);
    if (!merl) {
        asp_fail(err, ASP_ENOMEM, "values", "not enough memory for the table");
        return NULL;
    }
    size_t bins = bins_of(merl);
    for (size_t i = 0; i < 3 * bins; i++) {
        if (!(fabs(values[i]) <= 1e26)) {
            char reason[96];
            snprintf(reason, sizeof reason, "element %zu is not a finite number below 1e26", i);
            asp_fail(err, ASP_EINVAL, "values", reason);
            merl_release(merl);
            return NULL;
        }
        merl->values[i] = values[i] < 0 ? -1 : values[i] / aspi_merl_scale[i / bins];
    }
    if (!description)
        description = "";
    return aspi_merl_wrap(merl, 3, description, strlen(description), "merl", err);
}

/* Samples any function at the bin centres. */
static aspi_merl *sample_function(asp_brdf_function *function, const void *context, asp_error *err)
{
    aspi_merl *merl = aspi_merl_new(ASPI_MERL_H, ASPI_MERL_D, ASPI_MERL_P);
    if (!merl) {
        asp_fail(err, ASP_ENOMEM, "", "not enough memory for the table");
        return NULL;
    }
    size_t bins = bins_of(merl), at = 0;
    for (size_t i = 0; i < merl->n_h; i++)
        for (size_t j = 0; j < merl->n_d; j++)
            for (size_t k = 0; k < merl->n_p; k++, at++) {
                asp_vec3 wi, wo;
                if (!aspi_merl_centre(merl, i, j, k, &wi, &wo))
                    continue;
                asp_rgb f = function(context, wi, wo);
                const double rgb[3] = { f.r, f.g, f.b };
                for (int c = 0; c < 3; c++) {
                    if (!(fabs(rgb[c]) <= 1e26)) {
                        char reason[128];
                        snprintf(reason, sizeof reason,
                                 "no finite value in bin theta_h %zu, theta_d %zu, phi_d %zu",
                                 i, j, k);
                        asp_fail(err, ASP_EINVAL, "function", reason);
                        merl_release(merl);
                        return NULL;
                    }
                    merl->values[(size_t)c * bins + at] =
                        rgb[c] < 0 ? -1 : rgb[c] / aspi_merl_scale[c];
                }
            }
    return merl;
}

asp_measured *asp_measured_from_function(asp_brdf_function *f, const void *context,
                                         const char *description, asp_error *err)
{
    if (!f) {
        asp_fail(err, ASP_EINVAL, "function", "no function given");
        return NULL;
    }
    aspi_merl *merl = sample_function(f, context, err);
    if (!description)
        description = "";
    return merl ? aspi_merl_wrap(merl, 3, description, strlen(description), "merl", err) : NULL;
}

static void put_u32(unsigned char *p, uint32_t v)
{
    for (int i = 0; i < 4; i++)
        p[i] = (unsigned char)(v >> 8 * i);
}

static void write_table(const aspi_merl *merl, aspi_out *out)
{
    unsigned char block[8 * 1024];
    size_t used = 0, n = 3 * bins_of(merl);
    put_u32(block, (uint32_t)merl->n_h);
    put_u32(block + 4, (uint32_t)merl->n_d);
    put_u32(block + 8, (uint32_t)merl->n_p);
    aspi_out_write(out, block, HEADER);
    for (size_t i = 0; i < n; i++) {
        uint64_t bits;
        memcpy(&bits, &merl->values[i], sizeof bits);
        put_u32(block + used, (uint32_t)bits);
        put_u32(block + used + 4, (uint32_t)(bits >> 32));
        used += 8;
        if (used == sizeof block || i + 1 == n) {
            aspi_out_write(out, block, used);
            used = 0;
        }
    }
}

static asp_rgb eval_measured(const void *measured, asp_vec3 wi, asp_vec3 wo)
{
    return asp_measured_eval(measured, wi, wo);
}

asp_status asp_measured_write_merl(const asp_measured *measured, const char *path, asp_error *err)
{
    if (!measured)
        return asp_fail(err, ASP_EINVAL, "measured", "no measurement given");
    aspi_merl *sampled = NULL;
    const aspi_merl *merl = measured->data;
    if (measured->kind != &aspi_kind_merl) {
        asp_error why = { .status = ASP_ENOMEM };
        merl = sampled = sample_function(eval_measured, measured, &why);
        if (!sampled) {
            if (err)
                *err = why;
            return why.status;
        }
    }
    aspi_out out;
    asp_status status = aspi_out_open(&out, path, err);
    if (status == ASP_OK) {
        write_table(merl, &out);
        status = aspi_out_close(&out, err);
    }
    merl_release(sampled);
    return status;
}
