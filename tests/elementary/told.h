/* Put before each file of elementary: what is rounded, and the bound of what it may be off by, are
 * kept for a test to read. With ONLY_SLOW no quick way is taken, else every one is. */
#include "double_double.h"

extern double told[3]; /* h, l, bound */

static inline bool told_settled(double h, double l, double error, double *y)
{
#ifdef ONLY_SLOW
    error = NAN;
#else
    told[0] = h, told[1] = l, told[2] = error;
#endif
    *y = h + l;
    return error == error;
}

static inline double told_rounded(struct dd a, int k)
{
    told[0] = a.h, told[1] = a.l, told[2] = fabs(a.h) * 0x1p-96;
    return dd_rounded(a, k);
}

#define dd_settled told_settled
#define dd_rounded told_rounded
