/* The elementary functions, with the same bits on every platform: from + - * / and sqrt alone.
 *
 * Each gives the double nearest to the true value, which is unique (what is computed is off by less
 * than a 2^-20th of a unit in the last place before it is rounded, in most functions 2^-40th); so
 * they are monotone, odd and even where the function is. Special values are those of C11, Annex F;
 * no function sets errno or promises a flag. */
#ifndef ELEMENTARY_H
#define ELEMENTARY_H

/* x [rad], any size. */
double el_sin(double x);
double el_cos(double x);
double el_tan(double x);
/* Both at once, the same bits. */
struct el_turn {
    double sine, cosine;
};
struct el_turn el_sincos(double x);

/* [rad] */
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
