/* fmu_system - macros and types of which the generated C text of a system of parts consists: tables
 * of parts, wires and recorded columns, and quick checks of the values on all wires. */
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

/* For a program that is compiled for a run or two, code outside of the loop is not optimised: that
 * would take longer than optimising the loop. */
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

/* A function that is not to become part of its caller, which is large already. */
#if defined(__GNUC__)
#define SYSTEM_APART __attribute__((noinline))
#else
#define SYSTEM_APART
#endif

struct vars;

struct system_part {
    const char *name; /* name of the component */
    const struct fmu_part *part;
    size_t at; /* [byte] place of its instance in struct model */
    void (*give)(void *part, const struct vars *v); /* set its parameters and inputs before a run */
};

/* Destination of a wire. */
struct system_wire {
    int to;    /* index of the part */
    size_t at; /* [byte] place of the input in the part's struct vars */
};

/* Declare a part that is linked in; its name is not exported. */
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

/* Copy a recorded value into the current row of its column; the column of times is -1. */
#define SYSTEM_KEEP(column, value) memcpy(block[(column) + 1] + at, &(value), sizeof(value))

/* Step a part of several runs, those that have not failed: at once if it can, else one by one. */
#define SYSTEM_TOGETHER(part, member) \
    if ((part).together) { \
        void *at[FMU_PART_RUNS]; \
        for (int r = 0; r < runs; r++) { \
            at[r] = &m[r]->member; \
        } \
        (part).together(at, runs, t0, t1, failed); \
    } else { \
        for (int r = 0; r < runs; r++) { \
            failed[r] = failed[r] || (part).step(&m[r]->member, t0, t1) != 0; \
        } \
    }

/* Check of the values on all wires together, which is evaluated once. Most values need only be
 * finite: x * 0 is 0 for a finite x and NaN for any other. */
#if defined(__GNUC__)
typedef double system_pair __attribute__((vector_size(16)));
#define SYSTEM_SUM(pair) ((pair)[0] + (pair)[1])
#else
typedef double system_pair;
#define SYSTEM_SUM(pair) (pair)
#endif
enum { SYSTEM_PAIR = sizeof(system_pair) / sizeof(double) };

struct system_check {
    system_pair off; /* sums of x * 0, of pairs of elements, */
    double rest;     /* and of what has no other */
    uint32_t bits;   /* union of the bits that integers have and must not have */
    bool good;       /* the values with other limits are within them */
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
    size_t i = 0;
    for (system_pair pair; i + SYSTEM_PAIR <= n; i += SYSTEM_PAIR) {
        memcpy(&pair, x + i, sizeof pair);
        c->off += pair * 0.0;
    }
    for (; i < n; i++) {
        c->rest += x[i] * 0.0;
    }
}

static inline void system_reals(struct system_check *c, const double *x, size_t n, double low,
                                double high)
{
    for (size_t i = 0; i < n; i++) {
        c->good &= (x[i] >= low) & (x[i] <= high);
    }
}

/* Integers whose range is 0 .. high = 2^k - 1. */
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
    return c->good & (c->bits == 0) & (SYSTEM_SUM(c->off) + c->rest == 0.0);
}

#endif
