/* el_log - the natural logarithm to more than 53 bits, for el_pow and the slow ways of this
 * core. */
#ifndef EL_LOG_H
#define EL_LOG_H

#include "double_double.h"

/* log x to some 100 bits; 0 < x < infinity. */
struct dd el_log_dd(double x);
/* log x and the bound of its absolute error, which is at most 2^-61 of it; 2^-1022 <= x <
 * infinity. */
struct dd el_log_quick(double x, double *error);

#endif
