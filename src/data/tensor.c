/* tensor.c - the tensor files of the RGL material database */
#include "tensor.h"

#include <stdlib.h>
#include <string.h>

#define MAGIC "tensor_file"            /* with its final zero, 12 bytes */
#define HEADER 18
#define ENTRY 13                       /* the least that a field takes of the table */
#define TYPES 11

static const unsigned char type_bytes[TYPES + 1] = { 0, 1, 1, 2, 2, 4, 4, 8, 8, 2, 4, 8 };

static uint64_t little(const unsigned char *p, int bytes)
{
    uint64_t v = 0;
    for (int i = 0; i < bytes; i++)
        v |= (uint64_t)p[i] << 8 * i;
    return v;
}

int aspi_is_tensor_file(const aspi_bytes *file)
{
    return file->size >= sizeof MAGIC && memcmp(file->bytes, MAGIC, sizeof MAGIC) == 0;
}

asp_status aspi_tensor_fail(const aspi_bytes *file, const aspi_tensor *tensor, const char *reason,
                            asp_error *err)
{
    return aspi_fail_at(err, ASP_EFORMAT, file->name, (long long)tensor->entry, tensor->name,
                        reason);
}

/* The shape as text, 8x32x32. */
static void shape_text(const aspi_tensor *t, char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
    for (int i = 0; i < t->rank && used < size; i++)
        used += (size_t)snprintf(text + used, size - used, "%s%llu", i ? "x" : "",
                                 (unsigned long long)t->size[i]);
}

/* Type, sizes and place of one field against the file. */
static asp_status check_field(const aspi_bytes *file, aspi_tensor *t, uint64_t offset,
                              asp_error *err)
{
    char shape[112], reason[192];
    uint64_t bytes = type_bytes[t->type];
    shape_text(t, shape, sizeof shape);
    for (int i = 0; i < t->rank; i++) {
        if (t->size[i] && bytes > file->size / t->size[i]) {
            snprintf(reason, sizeof reason, "shape says %s, the whole file has %zu bytes", shape,
                     file->size);
            return aspi_tensor_fail(file, t, reason, err);
        }
        bytes *= t->size[i];
    }
    if (offset > file->size || bytes > file->size - offset) {
        snprintf(reason, sizeof reason, "shape says %s at byte %llu, the file ends at byte %zu",
                 shape, (unsigned long long)offset, file->size);
        return aspi_tensor_fail(file, t, reason, err);
    }
    t->offset = (size_t)offset;
    t->elements = (size_t)(bytes / type_bytes[t->type]);
    return ASP_OK;
}

static asp_status fail_table(const aspi_bytes *file, size_t at, const char *reason, asp_error *err)
{
    return aspi_fail_at(err, ASP_EFORMAT, file->name, (long long)at, "", reason);
}

/* Reads one entry at *at and moves on; keeps it if its name is asked for. */
static asp_status read_entry(const aspi_bytes *file, size_t *at, aspi_tensor *tensor, size_t count,
                             asp_error *err)
{
    const unsigned char *p = file->bytes + *at;
    size_t left = file->size - *at;
    if (left < 2)
        return fail_table(file, *at, "the file ends inside the field table", err);
    size_t length = (size_t)little(p, 2);
    if (left < 2 + length + 11)
        return fail_table(file, *at, "the file ends inside the field table", err);
    const unsigned char *after = p + 2 + length;
    size_t rank = (size_t)little(after, 2), type = after[2];
    uint64_t offset = little(after + 3, 8);
    if ((left - 2 - length - 11) / 8 < rank)
        return fail_table(file, *at, "the file ends inside the field table", err);
    aspi_tensor *wanted = NULL;
    for (size_t i = 0; i < count; i++)
        if (strlen(tensor[i].name) == length && memcmp(tensor[i].name, p + 2, length) == 0)
            wanted = &tensor[i];
    size_t entry = *at;
    *at += 2 + length + 11 + 8 * rank;
    if (!wanted)
        return ASP_OK;
    if (wanted->type)
        return aspi_fail_at(err, ASP_EFORMAT, file->name, (long long)entry, wanted->name,
                            "this field is listed twice");
    wanted->entry = entry;
    if (type < 1 || type > TYPES)
        return aspi_tensor_fail(file, wanted, "unknown element type", err);
    if (rank < 1 || rank > ASPI_TENSOR_RANK)
        return aspi_tensor_fail(file, wanted, "more dimensions than this field can have", err);
    wanted->type = (int)type;
    wanted->rank = (int)rank;
    for (size_t i = 0; i < rank; i++)
        wanted->size[i] = little(after + 11 + 8 * i, 8);
    return check_field(file, wanted, offset, err);
}

asp_status aspi_read_tensors(const aspi_bytes *file, aspi_tensor *tensor, size_t count,
                             asp_error *err)
{
    if (file->size < HEADER)
        return fail_table(file, file->size, "the file ends inside its header of 18 bytes", err);
    if (file->bytes[12] != 1 || file->bytes[13] != 0) {
        char reason[96];
        snprintf(reason, sizeof reason, "version %d.%d; only 1.0 is known", file->bytes[12],
                 file->bytes[13]);
        return aspi_fail_at(err, ASP_EFORMAT, file->name, 12, "version", reason);
    }
    size_t fields = (size_t)little(file->bytes + 14, 4), at = HEADER;
    if (fields > (file->size - HEADER) / ENTRY) {
        char reason[128];
        snprintf(reason, sizeof reason, "%zu fields, of %d bytes or more each in the field table; "
                 "the file has %zu bytes", fields, ENTRY, file->size);
        return aspi_fail_at(err, ASP_EFORMAT, file->name, 14, "number of fields", reason);
    }
    for (size_t i = 0; i < count; i++)
        tensor[i] = (aspi_tensor){ .name = tensor[i].name };
    for (size_t i = 0; i < fields; i++) {
        asp_status status = read_entry(file, &at, tensor, count, err);
        if (status != ASP_OK)
            return status;
    }
    return ASP_OK;
}

double *aspi_tensor_numbers(const aspi_bytes *file, const aspi_tensor *tensor, double low,
                            double high, asp_error *err)
{
    double *out = malloc(tensor->elements * sizeof *out);
    if (!out) {
        aspi_fail_at(err, ASP_ENOMEM, file->name, -1, tensor->name, "out of memory");
        return NULL;
    }
    for (size_t i = 0; i < tensor->elements; i++) {
        uint32_t bits = (uint32_t)little(file->bytes + tensor->offset + 4 * i, 4);
        float value;
        memcpy(&value, &bits, sizeof value);
        if (!(value >= low && value <= high)) {
            asp_fail_range(err, tensor->name, value, low, 0, high);
            aspi_error_file(err, file->name);
            if (err) {
                err->status = ASP_EFORMAT;
                err->position = (long long)(tensor->offset + 4 * i);
            }
            free(out);
            return NULL;
        }
        out[i] = value;
    }
    return out;
}
