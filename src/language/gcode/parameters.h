/* parameters - the variables of a part program: #1 to #5602, #<local>, #<_global>.
 *
 * #1 to #30 belong to a call, as do names without a leading _; all else to the program. A number
 * never set is 0, a name never set a fault. Numbers above 5000 exist where they have a meaning.
 * On Fanuc's controls #1 to #33 belong to a call; what was never set is vacant, and #0 always.
 */
#ifndef PARAMETERS_H
#define PARAMETERS_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "fault.h"

enum {
    PARAMETERS_LOCAL = 30,       /* #1 .. of a call, */
    PARAMETERS_LOCAL_FANUC = 33, /* of one of Fanuc's controls */
    PARAMETERS_NUMBERED = 5000,  /* #1 .. that hold any value */
    PARAMETERS_PAGE = 64,        /* numbers with a bit each in one word */
    PARAMETERS_PAGES = (PARAMETERS_NUMBERED + PARAMETERS_PAGE - 1) / PARAMETERS_PAGE,
    PARAMETERS_ALARM = 3000, /* of Fanuc's controls: a program that sets it stops */
    PARAMETERS_ZERO = -1,    /* #0 of theirs, as a number of struct parameter */
    PARAMETERS_NAMED = 100,  /* names in force at a time */
    PARAMETERS_NAME = 32     /* [byte] of a name: 31 characters at most */
};

/* Which parameter: a number, or a name in lower case, filled up with zeros. */
struct parameter {
    int32_t number; /* 0: it has a name */
    char name[PARAMETERS_NAME];
};

struct parameter_named {
    char name[PARAMETERS_NAME];
    int32_t level; /* of the call it belongs to, 0 the main program; -1 all */
    double value;
};

struct parameters {
    double value[PARAMETERS_NUMBERED]; /* of #1 on */
    uint64_t given[PARAMETERS_PAGES];  /* bits: has been set; else nobody reads the value */
    struct parameter_named named[PARAMETERS_NAMED];
    int32_t names;
    double debug; /* #5599 */
};

struct interpreter;
struct program;

/* Whether a value is none: #0 of Fanuc's controls and what was never set. It is a NaN, on the way
 * from where a parameter is read to where that makes a difference. */
static inline bool parameters_vacant(double value)
{
    return isnan(value);
}

/* A value to reckon with: what is vacant counts as 0. */
static inline double parameters_number(double value)
{
    return parameters_vacant(value) ? 0.0 : value;
}

/* The value of a parameter, or a vacant one. FAULT_PARAMETER: there is none of this number;
 * FAULT_UNSET. */
enum fault parameters_get(const struct interpreter *in, const struct program *p,
                          const struct parameter *which, double *value);

/* Set one, or make it vacant. FAULT_PARAMETER; FAULT_FIXED: only the machine sets it; FAULT_NAMES:
 * one too many. */
enum fault parameters_set(struct interpreter *in, const struct program *p,
                          const struct parameter *which, double value);

/* The names of a call that ends. */
void parameters_leave(struct parameters *all, int32_t level);

#endif
