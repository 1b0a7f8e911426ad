/* scurve_root - the root of a quartic between two bounds. */
#ifndef SCURVE_ROOT_H
#define SCURVE_ROOT_H

/* Where z^4 + c[3] z^3 + c[2] z^2 + c[1] z + c[0] turns from negative to positive between low and
 * high, to the last digits; the bound itself if it does not. A good guess saves time; one outside
 * the bounds stands for high. */
double scurve_root(const double c[4], double low, double guess, double high);

#endif
