/* parameters - the variables of a part program: #1 to #5602, #<local>, #<_global>.
 *
 * #1 to #30 are local to a call, and so are names without a leading _; all others belong to the
 * program. A number that was never set is 0; such a name is a fault. Numbers above 5000 exist where
 * they have a meaning. On Fanuc's controls #1 to #33 are local, a number that was never set is
 * vacant, and #0 is always vacant.
 */
#ifndef PARAMETERS_H
#define PARAMETERS_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "fault.h"

enum {
    PARAMETERS_LOCAL = 30,       /* #1 .. #30 are local to a call */
    PARAMETERS_LOCAL_FANUC = 33, /* #1 .. #33 on Fanuc's controls */
    PARAMETERS_NUMBERED = 5000,  /* #1 .. #5000 hold any value */
    PARAMETERS_PAGE = 64,        /* numbers whose bits are in one word of `given` */
    PARAMETERS_PAGES = (PARAMETERS_NUMBERED + PARAMETERS_PAGE - 1) / PARAMETERS_PAGE,
    PARAMETERS_ALARM = 3000, /* on Fanuc's controls a program that sets it stops */
    PARAMETERS_ZERO = -1,    /* #0 on Fanuc's controls: struct parameter's number */
    PARAMETERS_NAMED = 100,  /* names in force at a time */
    PARAMETERS_NAME = 32     /* [byte] of a name: 31 characters at most */
};

/* Which parameter: a number, or a name in lower case, padded with bytes 0. */
struct parameter {
    int32_t number; /* 0: it has a name */
    char name[PARAMETERS_NAME];
};

/* A parameter with a name that has been set. */
struct parameter_named {
    char name[PARAMETERS_NAME];
    int32_t level; /* depth of the call it belongs to, 0: main program; -1: all calls */
    double value;
};

struct parameters {
    double value[PARAMETERS_NUMBERED]; /* of #1, #2 .. */
    uint64_t given[PARAMETERS_PAGES];  /* a bit for each: its value has been set */
    struct parameter_named named[PARAMETERS_NAMED];
    int32_t names;
    double debug; /* #5599: above 0 (DEBUG, ) comments get a note */
};

struct interpreter;
struct program;

/* Whether a value is vacant, as #0 and what was never set are on Fanuc's controls. Such a value is
 * a NaN from where a parameter is read to where that makes a difference. */
static inline bool parameters_vacant(double value)
{
    return isnan(value);
}

/* The value as a number: 0 if it is vacant. */
static inline double parameters_number(double value)
{
    return parameters_vacant(value) ? 0.0 : value;
}

/* The value of a parameter, which may be vacant. FAULT_PARAMETER: none has this number;
 * FAULT_UNSET: the name was never set; FAULT_FOREIGN: only LinuxCNC has a value for it. */
enum fault parameters_get(const struct interpreter *in, const struct program *p,
                          const struct parameter *which, double *value);

/* Set a parameter, or make a number vacant. FAULT_PARAMETER, FAULT_FOREIGN; FAULT_FIXED: only the
 * machine sets it; FAULT_NAMES: there are PARAMETERS_NAMED already. */
enum fault parameters_set(struct interpreter *in, const struct program *p,
                          const struct parameter *which, double value);

/* Forget the local names of a call of this depth, which ends. */
void parameters_leave(struct parameters *all, int32_t level);

#endif
