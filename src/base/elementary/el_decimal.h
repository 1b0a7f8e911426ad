/* el_decimal - the double nearest to a decimal number; a double printed in full comes back. */
#ifndef EL_DECIMAL_H
#define EL_DECIMAL_H

#include <stdbool.h>
#include <stdint.h>

enum {
    EL_DECIMAL_DIGITS = 120, /* 0.1 as a double has 55 */
    EL_DECIMAL_SHORT = 15,   /* digits of an integer below 2^53 */
    EL_DECIMAL_EXACT = 22    /* powers of ten that are doubles */
};

/* Digits as they are read, without leading zeros. */
struct el_decimal {
    int32_t count, behind; /* all, and those behind the point */
    int64_t whole;         /* the first EL_DECIMAL_SHORT as an integer */
    uint8_t digit[EL_DECIMAL_DIGITS];
};

/* No digit yet. */
static inline void el_decimal_begin(struct el_decimal *d)
{
    d->count = d->behind = 0;
    d->whole = 0;
}

/* Append a digit; false: there is no room. */
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

/* The nearest double, of two equally near the even one; 0 or more: of any number of digits. */
double el_decimal_long(const struct el_decimal *d);

/* The same, at once where one division of exact numbers rounds. */
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
