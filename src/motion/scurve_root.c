#include "scurve_root.h"

#include <float.h>
#include <math.h>

/* Most roots take 4 or 5 steps. Where rounding leads them astray the bounds are halved instead. */
enum { FREE_STEPS = 12, STEPS = 100 };

double scurve_root(const double c[4], double low, double guess, double high)
{
    double z = guess > low && guess < high ? guess : high;
    for (int i = 0; i < STEPS; i++) {
        const double f = (((z + c[3]) * z + c[2]) * z + c[1]) * z + c[0];
        const double d = ((4.0 * z + 3.0 * c[3]) * z + 2.0 * c[2]) * z + c[1];
        const double h = (12.0 * z + 6.0 * c[3]) * z + 2.0 * c[2];
        /* Laguerre's step, n = 4: n f/(f' +- sqrt((n - 1)^2 f'^2 - n (n - 1) f f'')). It triples
         * the correct digits, and from far away it still goes at once to where the root may be. */
        const double r = sqrt(fmax(0.0, 9.0 * d * d - 12.0 * f * h));
        double next = z - 4.0 * f / (d + (d < 0.0 ? -r : r));
        if (f > 0.0) {
            high = z;
        } else {
            low = z;
        }
        if (i >= FREE_STEPS || !(next >= low && next <= high)) {
            next = low + (high - low) / 2.0;
        }
        if (fabs(next - z) <= 4.0 * DBL_EPSILON * fabs(z)) {
            return next;
        }
        z = next;
    }
    return z;
}
