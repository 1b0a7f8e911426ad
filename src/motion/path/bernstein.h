/* bernstein - polynomials of a degree up to 5 by their control values over 0 .. 1. */
#ifndef BERNSTEIN_H
#define BERNSTEIN_H

/* Control values of the part t0 .. t1 instead of 0 .. 1, in place; 0 <= t0 < t1 <= 1. */
void bernstein_part(double control[], int n, double t0, double t1);

/* Control values of the part 0 .. t go into `before`; those of t .. 1 replace the given ones. */
void bernstein_cut(double control[], int n, double t, double before[]);

#endif
