/* parameters - the variables of a part program: #1 to #5602, #<local>, #<_global>.
 *
 * #1 to #30 belong to a call, as do names without a leading _; all else to the program. A number
 * never set is 0, a name never set a fault. Numbers above 5000 exist where they have a meaning.
 */
#ifndef PARAMETERS_H
#define PARAMETERS_H

#include <stdbool.h>
#include <stdint.h>

#include "fault.h"

enum {
    PARAMETERS_LOCAL = 30,      /* #1 .. of a call */
    PARAMETERS_NUMBERED = 5000, /* #1 .. that hold any value */
    PARAMETERS_PAGE = 64,       /* numbers of which one is set or none, for saved states */
    PARAMETERS_NAMED = 100,     /* names in force at a time */
    PARAMETERS_NAME = 32        /* [byte] of a name: 31 characters at most */
};

/* Which parameter: a number, or a name in lower case, filled up with zeros. */
struct parameter {
    int32_t number;             /* 0: it has a name */
    char    name[PARAMETERS_NAME];
};

struct parameter_named {
    char    name[PARAMETERS_NAME];
    int32_t level;              /* of the call it belongs to, 0 the main program; -1 all */
    double  value;
};

struct parameters {
    double value[PARAMETERS_NUMBERED];      /* of #1 on */
    uint64_t set[2];            /* bits: pages with a number that has been set; the first with #1
                                 * to #30 is one always */
    struct parameter_named named[PARAMETERS_NAMED];
    int32_t names;
};

struct interpreter;
struct program;

/* The value of a parameter. FAULT_PARAMETER: there is none of this number; FAULT_UNSET. */
enum fault parameters_get(const struct interpreter *in, const struct program *p,
                          const struct parameter *which, double *value);

/* Set one. FAULT_PARAMETER; FAULT_FIXED: only the machine sets it; FAULT_NAMES: one too many. */
enum fault parameters_set(struct interpreter *in, const struct program *p,
                          const struct parameter *which, double value);

/* The names of a call that ends. */
void parameters_leave(struct parameters *all, int32_t level);

/* Whether a state is none that it can have. */
static inline bool parameters_damaged(const struct parameters *all)
{
    return all->names < 0 || all->names > PARAMETERS_NAMED;
}

#endif
