/* What the generated text of a system of parts is made of: wires, limits, tables. */
#ifndef FMU_SYSTEM_H
#define FMU_SYSTEM_H

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmu_part.h"

/* A program that is made for a run or two shall not wait for the optimization of what runs once a
 * call, which takes longer than that of the loop. */
#if defined(SYSTEM_QUICKLY) && defined(__clang__)
#define SYSTEM_COLD_BEGIN _Pragma("clang optimize off")
#define SYSTEM_COLD_END   _Pragma("clang optimize on")
#elif defined(SYSTEM_QUICKLY) && defined(__GNUC__)
#define SYSTEM_COLD_BEGIN _Pragma("GCC push_options") _Pragma("GCC optimize(\"O0\")")
#define SYSTEM_COLD_END   _Pragma("GCC pop_options")
#else
#define SYSTEM_COLD_BEGIN
#define SYSTEM_COLD_END
#endif

struct vars;

struct system_part {
    const char *name; /* of the component */
    const struct fmu_part *part;
    size_t at;                                      /* of its instance, in struct model */
    void (*give)(void *part, const struct vars *v); /* all values that are set before a run */
};

struct system_wire {
    int to;    /* part */
    size_t at; /* of the input, in the part's struct vars */
};

struct system_column {
    const char *name;
    size_t at; /* in struct model */
    char kind;
    int32_t count;
};

/* A part that is linked in; its name is not one of the program's. */
#if defined(__GNUC__)
#define SYSTEM_PART(name) __attribute__((visibility("hidden"))) extern const struct fmu_part name
#else
#define SYSTEM_PART(name) extern const struct fmu_part name
#endif

#define SYSTEM_COPY(to, from) \
    do { \
        _Static_assert(sizeof(to) == sizeof(from), "one type, one size"); \
        memcpy(&(to), &(from), sizeof(to)); \
    } while (0)

/* What the values that all wires have brought are together, so that it is asked once. Most need
 * only be finite: x * 0 is 0 of these and no number of all others. */
struct system_check {
    double off[2]; /* sums of x * 0, of every other element */
    uint32_t bits; /* that no whole number may have */
    bool good;     /* those with other limits are within them */
};

#define SYSTEM_FINITE(x) system_finite(&check, (const double *)&(x), sizeof(x) / sizeof(double))
#define SYSTEM_REALS(x, low, high) \
    system_reals(&check, (const double *)&(x), sizeof(x) / sizeof(double), low, high)
#define SYSTEM_BITS(x, high) \
    system_bits(&check, (const int32_t *)&(x), sizeof(x) / sizeof(int32_t), high)
#define SYSTEM_WHOLES(x, low, high) \
    system_wholes(&check, (const int32_t *)&(x), sizeof(x) / sizeof(int32_t), low, high)

static inline void system_finite(struct system_check *c, const double *x, size_t n)
{
    for (size_t i = 0; i + 1 < n; i += 2) {
        c->off[0] += x[i] * 0.0;
        c->off[1] += x[i + 1] * 0.0;
    }
    if (n % 2) {
        c->off[0] += x[n - 1] * 0.0;
    }
}

static inline void system_reals(struct system_check *c, const double *x, size_t n, double low,
                                double high)
{
    for (size_t i = 0; i < n; i++) {
        c->good &= (x[i] >= low) & (x[i] <= high);
    }
}

/* Whole numbers from 0 to 2^k - 1. */
static inline void system_bits(struct system_check *c, const int32_t *x, size_t n, int32_t high)
{
    for (size_t i = 0; i < n; i++) {
        c->bits |= (uint32_t)x[i] & ~(uint32_t)high;
    }
}

static inline void system_wholes(struct system_check *c, const int32_t *x, size_t n, int32_t low,
                                 int32_t high)
{
    for (size_t i = 0; i < n; i++) {
        c->good &= (x[i] >= low) & (x[i] <= high);
    }
}

static inline bool system_good(const struct system_check *c)
{
    return c->good & (c->bits == 0) & (c->off[0] + c->off[1] == 0.0);
}

#endif
