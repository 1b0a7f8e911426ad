/* npy_head - head of a NumPy .npy file (format version 1.0): a Python dictionary with type and
 * shape, padded to a fixed size, so that it can be written again when the number of rows is known.
 * https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html */
#ifndef NPY_HEAD_H
#define NPY_HEAD_H

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* Write a head of `size` bytes, a multiple of 64 and at least 128, so that data is aligned when it
 * is mapped. `type` is f8, i4 or b1; columns = -1 means one value per row, shape (rows,). */
static inline void npy_head(char *head, size_t size, const char *type, int64_t rows,
                            int64_t columns)
{
    const uint16_t one = 1;
    const char order = type[1] == '1' ? '|' : *(const char *)&one == 1 ? '<' : '>';
    char wide[24] = "";
    if (columns >= 0) {
        snprintf(wide, sizeof wide, " %" PRId64, columns);
    }
    const int n =
        10
        + snprintf(head + 10, size - 10,
                   "{'descr': '%c%s', 'fortran_order': False, 'shape': (%" PRId64 ",%s), }", order,
                   type, rows, wide);
    memset(head + n, ' ', size - (size_t)n);
    memcpy(head, "\x93NUMPY\x01\x00", 8);
    head[8] = (char)((size - 10) & 0xFF); /* size of the dictionary, low byte first */
    head[9] = (char)((size - 10) >> 8);
    head[size - 1] = '\n';
}

#endif
