/* jet - a quantity along a path with its first three derivatives: in the middle m of a part of the
 * path, which reaches h to either side, and the ranges that hold all over it.
 *
 *     f(s) = c0 + c1 (s - m) + c2 (s - m)^2 + c3 (s - m)^3 + ..      ck = f^(k)(m) / k!
 *
 * What follows from ranges by these rules holds at every place of the part: a proof, not a sample.
 * No range is wider than its middle and h times the range of the next derivative allow.
 * Ends of ranges are rounded to nearest: they hold but for some 1e-14 of what is added.
 */
#ifndef JET_H
#define JET_H

#include <stdbool.h>

enum { JET_TERMS = 4 };

struct jet_range {
    double low, high;
};

struct jet {
    double half;                     /* h */
    double middle[JET_TERMS];        /* ck */
    struct jet_range all[JET_TERMS]; /* f^(k) / k! all over the part */
};

struct jet jet_constant(double value, double half);
struct jet jet_sum(const struct jet *a, const struct jet *b);
struct jet jet_difference(const struct jet *a, const struct jet *b);
struct jet jet_scaled(const struct jet *a, double factor);
struct jet jet_product(const struct jet *a, const struct jet *b);

/* *good becomes false, and the result nothing, where b may be 0 in the part. */
struct jet jet_quotient(const struct jet *a, const struct jet *b, bool *good);

/* Likewise where a may be 0 or less. */
struct jet jet_root(const struct jet *a, bool *good);

/* The derivative, whose last term is nothing. */
struct jet jet_rate(const struct jet *a);

/* Derivative of the angle of (x, y); likewise where both may be 0. */
struct jet jet_angle_rate(const struct jet *x, const struct jet *y, bool *good);

/* Cosine and sine of an angle whose derivative is known, by their own in the middle. */
void jet_direction(double cosine, double sine, const struct jet *rate, struct jet out[2]);

/* A vector that turns evenly, by `turn` a unit of the way, and is `at` in the middle of a part that
 * reaches `half` to either side. */
void jet_turning(const double at[3], const double turn[3], double half, struct jet out[3]);

/* Largest absolute value in a range. */
double jet_most(const struct jet_range *r);

#endif
