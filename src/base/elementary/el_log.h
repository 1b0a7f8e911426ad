/* The logarithm to 100 bits, for elementary's own files. */
#ifndef EL_LOG_H
#define EL_LOG_H

#include "double_double.h"

/* log x; 0 < x < infinity. */
struct dd el_log_dd(double x);
/* log x and the bound of what it is off by, 2^-61 of it or less; 2^-1022 <= x < infinity. */
struct dd el_log_quick(double x, double *error);

#endif
