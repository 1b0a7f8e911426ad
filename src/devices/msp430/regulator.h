/* regulator - the positioner's control law, P or PI in fixed point: from the position error
 * [counts] to the PWM's deviation from its middle, once per timer period.
 *
 *     P = Kp error,   Kp = p_gain / 2^p_shift [PWM counts / count]
 *     literal:  count = count + 1;    I = Ki (error count)     as the article has it
 *     sum:      sum = sum + error;    I = Ki sum               a true integral
 *     Ki = i_gain / 2^i_shift;    output = P + I
 *
 * With a band the integral runs only while |error| < band. Widths: error, gains, count and output
 * 16 bits; error count and sum 32; their products with Ki 48, rounded when shifted; all
 * saturate. */
#ifndef REGULATOR_H
#define REGULATOR_H

#include <stdint.h>

enum regulator_kind { REGULATOR_P = 0, REGULATOR_LITERAL = 1, REGULATOR_SUM = 2 };

/* What the integral does outside its band. */
enum regulator_outside {
    REGULATOR_RESET = 0, /* count and sum become 0 */
    REGULATOR_HOLD = 1,  /* count and sum keep their values, and I is computed from them */
};

enum { REGULATOR_SHIFT_MAX = 31 };

struct regulator_config {
    enum regulator_kind kind;
    int16_t p_gain, i_gain; /* Kp 2^p_shift, Ki 2^i_shift */
    int p_shift, i_shift;   /* 0 .. REGULATOR_SHIFT_MAX */
    int16_t band;           /* [counts] 0: no band */
    enum regulator_outside outside;
};

struct regulator {
    int16_t count;        /* number of periods, literal law */
    int32_t sum;          /* [counts] sum of errors, true integral */
    int16_t proportional; /* [PWM counts] P of the latest period */
    int16_t integral;     /* [PWM counts] I of the latest period */
};

/* One timer period. Returns the PWM's deviation from its middle [PWM counts]. */
int16_t regulator_tick(const struct regulator_config *c, struct regulator *s, int16_t error);

/* A move begins: `count` of the literal law starts at 0. `sum` stays, because it holds the valve's
 * offset. */
void regulator_move(struct regulator *s);

#endif
