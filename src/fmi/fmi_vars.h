/* fmi_vars - row type of the table of an FMU's variables (name, type, limits, place), which the
 * generated vars.c fills in and the FMI layer reads. */
#ifndef FMI_VARS_H
#define FMI_VARS_H

#include <float.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum var_type { VAR_F64, VAR_I32, VAR_BOOL, VAR_STRING };

/* The kinds that a call may set come first: see fmi_settable() in fmi_values.inc. */
enum var_causality { CAUSE_PARAMETER, CAUSE_INPUT, CAUSE_OUTPUT, CAUSE_LOCAL };

enum var_variability { VARY_FIXED, VARY_TUNABLE, VARY_DISCRETE, VARY_CONTINUOUS };

struct var_info {
    const char *name;
    uint32_t ref;        /* value reference of the first element; the others follow */
    uint32_t count;      /* number of elements, row-major */
    uint32_t offset;     /* [byte] of the first element in struct vars */
    uint8_t type;        /* enum var_type */
    uint8_t causality;   /* enum var_causality */
    uint8_t variability; /* enum var_variability */
    double min, max;     /* -DBL_MAX, DBL_MAX where there is no limit: finite at least */
    bool own;            /* stays the instance's when it begins in a saved state: names of files */
};

#endif
