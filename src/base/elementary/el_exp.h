/* The exponential function to 100 bits, for elementary's own files. */
#ifndef EL_EXP_H
#define EL_EXP_H

#include "double_double.h"

/* e^x = 2^k times what it returns, 1 to 2; |x| < 1200. */
struct dd el_exp_dd(struct dd x, int *k);
/* e^(x.h + x.l) rounded, if that is sure where x is off by so much; |x| < 700. */
bool el_exp_quick(struct dd x, double error, double *y);

#endif
