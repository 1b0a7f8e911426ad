#include "el_decimal.h"

#include <math.h>

enum {
    LIMBS = 14, /* of 32 bits: 10^120 has 399, and it is doubled twice at most */
    BITS = 54   /* bits of the quotient: those of a double and one to round by */
};

/* An integer of 448 bits, its lowest limb first. */
struct large {
    uint32_t limb[LIMBS];
};

/* x becomes 10 x + plus. */
static void times_ten(struct large *x, uint32_t plus)
{
    uint64_t carry = plus;

    for (int i = 0; i < LIMBS; i++) {
        carry += (uint64_t)x->limb[i] * 10;
        x->limb[i] = (uint32_t)carry;
        carry >>= 32;
    }
}

static void twice(struct large *x)
{
    for (int i = LIMBS - 1; i >= 0; i--) {
        x->limb[i] = x->limb[i] << 1 | (i > 0 ? x->limb[i - 1] >> 31 : 0);
    }
}

/* -1, 0, 1: a is below b, the same, above. */
static int compare(const struct large *a, const struct large *b)
{
    int i = LIMBS - 1;

    while (i > 0 && a->limb[i] == b->limb[i]) {
        i--;
    }
    return (a->limb[i] > b->limb[i]) - (a->limb[i] < b->limb[i]);
}

/* a becomes a - b, which is not below 0. */
static void subtract(struct large *a, const struct large *b)
{
    uint32_t borrow = 0;

    for (int i = 0; i < LIMBS; i++) {
        const uint64_t difference = (uint64_t)a->limb[i] - b->limb[i] - borrow;
        a->limb[i] = (uint32_t)difference;
        borrow = (uint32_t)(difference >> 63);
    }
}

/* up / down rounded to the nearest double: the quotient bit by bit from the highest on, rounded by
 * its last bit and the remainder. */
static double quotient(struct large *up, struct large *down)
{
    int exponent = 0;
    int64_t bits = 0;

    for (; compare(up, down) >= 0; exponent++) {
        twice(down);
    }
    for (; compare(up, down) < 0; exponent--) {
        twice(up);
    }
    for (int i = 0; i < BITS; i++) { /* up < 2 down */
        const bool one = compare(up, down) >= 0;
        if (one) {
            subtract(up, down);
        }
        bits = bits << 1 | one;
        twice(up);
    }
    static const struct large ZERO;
    const bool more = compare(up, &ZERO) != 0 || bits & 2;
    bits += (bits & 1) && more;
    return ldexp((double)(bits >> 1), exponent - (BITS - 2));
}

double el_decimal_long(const struct el_decimal *d)
{
    struct large up = { { 0 } }, down = { { 1 } };

    if (d->count == 0) {
        return 0.0;
    }
    for (int i = 0; i < d->count; i++) {
        times_ten(&up, d->digit[i]);
    }
    for (int i = 0; i < d->behind; i++) {
        times_ten(&down, 0);
    }
    return quotient(&up, &down);
}
