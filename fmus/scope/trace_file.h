/* trace_file - writes the rows that the scope FMU has recorded: two .npy files (real numbers and
 * integers) and a .csv file. The writers return false, with errno, on an error. */
#ifndef TRACE_FILE_H
#define TRACE_FILE_H

#include <inttypes.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "npy_head.h"

struct trace {
    const double *real;               /* rows x real_columns */
    const int32_t *ints;              /* rows x int_columns */
    int64_t rows;                     /* number of rows */
    size_t real_columns, int_columns; /* numbers of columns */
    int64_t period;                   /* [ns] between two rows */
};

/* Write the head of a .npy file; `type` is f8 or i4. */
static bool trace_write_head(FILE *file, const char *type, int64_t rows, size_t columns)
{
    char head[128];
    npy_head(head, sizeof head, type, rows, (int64_t)columns);
    return fwrite(head, 1, sizeof head, file) == sizeof head;
}

static bool trace_write_real(FILE *file, const struct trace *t)
{
    size_t n = (size_t)t->rows * t->real_columns;
    return trace_write_head(file, "f8", t->rows, t->real_columns)
           && fwrite(t->real, sizeof *t->real, n, file) == n;
}

static bool trace_write_int(FILE *file, const struct trace *t)
{
    size_t n = (size_t)t->rows * t->int_columns;
    return trace_write_head(file, "i4", t->rows, t->int_columns)
           && fwrite(t->ints, sizeof *t->ints, n, file) == n;
}

/* Write a comma and a number that reads back as the same double, with a decimal point in any
 * locale. */
static bool trace_write_number(FILE *file, double x)
{
    char text[40];
    snprintf(text, sizeof text, ",%.17g", x);
    char *comma = strchr(text + 1, ',');
    if (comma) {
        *comma = '.';
    }
    return fputs(text, file) >= 0;
}

static bool trace_write_row(FILE *file, const struct trace *t, int64_t k)
{
    const int64_t second = 1000000000; /* [ns] */
    const double *real = t->real + (size_t)k * t->real_columns;
    const int32_t *ints = t->ints + (size_t)k * t->int_columns;
    int64_t time = k * t->period; /* [ns] */
    bool good = fprintf(file, "%" PRId64 ".%09" PRId64, time / second, time % second) > 0;
    for (size_t i = 0; good && i < t->real_columns; i++) {
        good = trace_write_number(file, real[i]);
    }
    for (size_t i = 0; good && i < t->int_columns; i++) {
        good = fprintf(file, ",%" PRId32, ints[i]) > 0;
    }
    return good && fputc('\n', file) != EOF;
}

static bool trace_write_csv(FILE *file, const struct trace *t)
{
    bool good = fputs("time", file) >= 0;
    for (size_t i = 1; good && i <= t->real_columns; i++) {
        good = fprintf(file, ",r%zu", i) > 0;
    }
    for (size_t i = 1; good && i <= t->int_columns; i++) {
        good = fprintf(file, ",i%zu", i) > 0;
    }
    good = good && fputc('\n', file) != EOF;
    for (int64_t k = 0; good && k < t->rows; k++) {
        good = trace_write_row(file, t, k);
    }
    return good;
}

#endif
