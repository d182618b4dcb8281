/* tensor.h - the tensor files of the RGL material database
 *
 * Little-endian: "tensor_file\0", version 1.0 in two bytes, uint32 number of fields; per field a
 * uint16 name length, the name, uint16 rank, uint8 type, uint64 offset of the data in the file and
 * rank x uint64 sizes. */
#ifndef ASPI_TENSOR_H
#define ASPI_TENSOR_H

#include "measured.h"

#define ASPI_TENSOR_UINT8   1
#define ASPI_TENSOR_FLOAT32 10
#define ASPI_TENSOR_RANK    6

typedef struct aspi_tensor {
    const char *name;
    int      type, rank;
    uint64_t size[ASPI_TENSOR_RANK];
    size_t   elements;                   /* product of the sizes, may be 0; the data lie inside the file */
    size_t   offset;
    size_t   entry;                      /* where the field's entry stands, for errors */
} aspi_tensor;

int aspi_is_tensor_file(const aspi_bytes *file);

/* Finds `count` fields by tensor[i].name; type 0 marks the ones that are absent. Everything that is
 * found has been checked against the file's size. */
asp_status aspi_read_tensors(const aspi_bytes *file, aspi_tensor *tensor, size_t count,
                             asp_error *err);

/* Copies a float32 field as doubles; each must be in [low, high]. NULL on failure. free() it. */
double *aspi_tensor_numbers(const aspi_bytes *file, const aspi_tensor *tensor, double low,
                            double high, asp_error *err);

asp_status aspi_tensor_fail(const aspi_bytes *file, const aspi_tensor *tensor, const char *reason,
                            asp_error *err);
#endif
