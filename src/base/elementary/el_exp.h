/* el_exp - e^x of an argument of more than 53 bits, for el_pow and the slow ways of this core. */
#ifndef EL_EXP_H
#define EL_EXP_H

#include "double_double.h"

/* e^x to some 100 bits: returns m, 1 to 2, with e^x = 2^k m; |x| < 1200. */
struct dd el_exp_dd(struct dd x, int *k);
/* *y = e^(x.h + x.l) rounded, |x| < 700. True if the rounding is certain although x has an absolute
 * error of up to `error`. */
bool el_exp_quick(struct dd x, double error, double *y);

#endif
