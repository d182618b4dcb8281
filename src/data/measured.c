/* measured.c - the public face of measurements, and the table of file formats */
#include "measured.h"

#include <stdlib.h>
#include <string.h>

/* Asked in this order; csv last because almost any text could be one. */
const aspi_format *const aspi_formats[] = {
    &aspi_format_merl, &aspi_format_rgl, &aspi_format_cornell, &aspi_format_lumos,
    &aspi_format_csv, NULL
};

asp_measured *aspi_measured_wrap(const aspi_kind *kind, void *data, asp_measured_info info,
                                 const char *description, size_t length, asp_error *err)
{
    asp_measured *measured = malloc(sizeof *measured);
    char *text = malloc(length + 1);
    if (!measured || !text) {
        free(measured);
        free(text);
        kind->release(data);
        asp_fail(err, ASP_ENOMEM, "", "not enough memory for the measurement");
        return NULL;
    }
    for (size_t i = 0; i < length; i++) {
        unsigned char c = (unsigned char)description[i];
        text[i] = c < 32 || c == 127 ? ' ' : (char)c;
    }
    text[length] = 0;
    info.description = text;
    measured->info = info;
    measured->kind = kind;
    measured->data = data;
    measured->description = text;
    return measured;
}

asp_measured *aspi_measured_remark(asp_measured *measured, const char *remark, asp_error *err)
{
    if (!measured || !remark[0])
        return measured;
    size_t length = strlen(measured->description), more = strlen(remark);
    char *text = realloc(measured->description, length + more + 3);
    if (!text) {
        asp_measured_free(measured);
        asp_fail(err, ASP_ENOMEM, "", "not enough memory for the measurement");
        return NULL;
    }
    if (length) {
        memcpy(text + length, "; ", 2);
        length += 2;
    }
    memcpy(text + length, remark, more + 1);
    measured->description = text;
    measured->info.description = text;
    return measured;
}

static asp_measured *read_bytes(const aspi_bytes *file, asp_error *err)
{
    if (!file->size) {
        aspi_fail_at(err, ASP_EFORMAT, file->name, 0, "", "the file is empty");
        return NULL;
    }
    for (size_t i = 0; aspi_formats[i]; i++)
        if (aspi_formats[i]->probe(file))
            return aspi_formats[i]->read(file, err);
    char reason[192];
    size_t used = (size_t)snprintf(reason, sizeof reason, "format not recognised; known are");
    for (size_t i = 0; aspi_formats[i] && used < sizeof reason; i++)
        used += (size_t)snprintf(reason + used, sizeof reason - used, "%s %s", i ? "," : "",
                                 aspi_formats[i]->name);
    aspi_fail_at(err, ASP_EFORMAT, file->name, 0, "", reason);
    return NULL;
}

asp_measured *asp_measured_read(const char *path, asp_error *err)
{
    unsigned char *bytes;
    size_t size;
    if (aspi_read_file(path, &bytes, &size, err) != ASP_OK)
        return NULL;
    aspi_bytes file = { bytes, size, path };
    asp_measured *measured = read_bytes(&file, err);
    free(bytes);
    return measured;
}

asp_measured *asp_measured_read_memory(const void *bytes, size_t size, const char *name,
                                       asp_error *err)
{
    if (!bytes && size) {
        asp_fail(err, ASP_EINVAL, "bytes", "no bytes given");
        return NULL;
    }
    aspi_bytes file = { bytes, size, name && name[0] ? name : "memory" };
    return read_bytes(&file, err);
}

void asp_measured_free(asp_measured *measured)
{
    if (!measured)
        return;
    measured->kind->release(measured->data);
    free(measured->description);
    free(measured);
}

asp_measured_info asp_measured_get_info(const asp_measured *measured)
{
    asp_measured_info none = { "", "", 0, 0, 0, 0 };
    return measured ? measured->info : none;
}

asp_rgb asp_measured_eval(const asp_measured *measured, asp_vec3 wi, asp_vec3 wo)
{
    asp_rgb zero = { 0, 0, 0 };
    double sum = wi.x + wi.y + wi.z + wo.x + wo.y + wo.z;
    if (isnan(sum))
        return (asp_rgb){ sum, sum, sum };
    if (!measured || wi.z <= 0 || wo.z <= 0 || isinf(sum))
        return zero;
    return measured->kind->eval(measured->data, wi, wo);
}

const asp_measurement *asp_measured_geometries(const asp_measured *measured, size_t *count)
{
    const aspi_list *list = measured && measured->kind == &aspi_kind_list ? measured->data : NULL;
    if (count)
        *count = list ? list->count : 0;
    return list ? list->item : NULL;
}

asp_status asp_measured_write_csv(const asp_measured *measured, const char *path, asp_error *err)
{
    aspi_out out;
    if (!measured)
        return asp_fail(err, ASP_EINVAL, "measured", "no measurement given");
    asp_status status = aspi_out_open(&out, path, err);
    if (status != ASP_OK)
        return status;
    status = measured->kind->write_csv(measured, &out, err);
    if (status != ASP_OK) {
        aspi_out_abandon(&out);
        return status;
    }
    return aspi_out_close(&out, err);
}
