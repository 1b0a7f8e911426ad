/* el_decimal - the double nearest to a decimal number, for readers of numbers in text: digits are
 * collected one by one, then converted. A double printed in full is read back exactly. */
#ifndef EL_DECIMAL_H
#define EL_DECIMAL_H

#include <stdbool.h>
#include <stdint.h>

enum {
    EL_DECIMAL_DIGITS = 120, /* most digits of a number; the double 0.1 printed in full has 55 */
    EL_DECIMAL_SHORT = 15,   /* numbers of so many digits are integers below 2^53, exact */
    EL_DECIMAL_EXACT = 22    /* largest power of ten that is exact as a double */
};

/* The digits of a number as they are read, without leading zeros. */
struct el_decimal {
    int32_t count, behind; /* number of digits; of digits behind the decimal point */
    int64_t whole;         /* the first EL_DECIMAL_SHORT digits as an integer */
    uint8_t digit[EL_DECIMAL_DIGITS];
};

/* No digit yet. */
static inline void el_decimal_begin(struct el_decimal *d)
{
    d->count = d->behind = 0;
    d->whole = 0;
}

/* Append a digit, 0 .. 9, before or behind the decimal point; false if there is no room. */
static inline bool el_decimal_add(struct el_decimal *d, int32_t digit, bool behind)
{
    if (d->count == EL_DECIMAL_DIGITS || d->behind == EL_DECIMAL_DIGITS) {
        return false;
    }
    d->behind += behind;
    if (digit > 0 || d->count > 0) {
        d->whole = d->count < EL_DECIMAL_SHORT ? d->whole * 10 + digit : d->whole;
        d->digit[d->count++] = (uint8_t)digit;
    }
    return true;
}

/* The nearest double, >= 0, for any number of digits; of two equally near ones the even one. */
double el_decimal_long(const struct el_decimal *d);

/* The same; quick for short numbers, which one division of exact numbers rounds correctly. */
static inline double el_decimal_value(const struct el_decimal *d)
{
    static const double TEN_TO[EL_DECIMAL_EXACT + 1] = { 1e0,  1e1,  1e2,  1e3,  1e4,  1e5,
                                                         1e6,  1e7,  1e8,  1e9,  1e10, 1e11,
                                                         1e12, 1e13, 1e14, 1e15, 1e16, 1e17,
                                                         1e18, 1e19, 1e20, 1e21, 1e22 };
    return d->count <= EL_DECIMAL_SHORT && d->behind <= EL_DECIMAL_EXACT
               ? (double)d->whole / TEN_TO[d->behind]
               : el_decimal_long(d);
}

#endif
