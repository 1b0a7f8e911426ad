/* elementary - the elementary functions with the same bits on every platform, made of + - * / and
 * sqrt alone. All cores use these instead of the C library's.
 *
 * Each returns the double nearest to the true value (correctly rounded): the error before the final
 * rounding is below 2^-20 of a unit in the last place, in most functions below 2^-40. So a function
 * is monotone, odd or even where the mathematical one is. Special values are those of C11, Annex F;
 * no function sets errno or promises a floating-point exception flag. */
#ifndef ELEMENTARY_H
#define ELEMENTARY_H

/* Of an angle x [rad] of any magnitude. */
double el_sin(double x);
double el_cos(double x);
double el_tan(double x);
/* Sine and cosine at once, with the same bits as el_sin and el_cos. */
struct el_turn {
    double sine, cosine;
};
struct el_turn el_sincos(double x);

/* Angles [rad]. */
double el_asin(double x);
double el_acos(double x);
double el_atan(double x);
double el_atan2(double y, double x);

double el_exp(double x);
double el_expm1(double x);
double el_sinh(double x);
double el_cosh(double x);
double el_tanh(double x);
double el_log(double x);
double el_pow(double x, double y);

double el_hypot(double x, double y);
double el_cbrt(double x);

#endif
