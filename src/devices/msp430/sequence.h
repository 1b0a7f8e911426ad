/* Program of the positioner, once a timer period: buttons, homing, positioning, faults.
 * README.md has the state diagram and the table of codes. */
#ifndef SEQUENCE_H
#define SEQUENCE_H

#include <stdbool.h>
#include <stdint.h>

#include "regulator.h"
#include "trapezoid.h"

enum sequence_state {
    SEQUENCE_UNHOMED = 0,  /* valve at zero */
    SEQUENCE_BACK_OFF = 1, /* PB1 on the home switch: off it first */
    SEQUENCE_SEARCH = 2,   /* towards the home switch, constant speed */
    SEQUENCE_STOP = 3,     /* to rest, behind the switch or by PB1 */
    SEQUENCE_READY = 4,    /* stands at TRACK */
    SEQUENCE_ACCELERATE = 5,
    SEQUENCE_CRUISE = 6,
    SEQUENCE_DECELERATE = 7,
    SEQUENCE_FAULT = 8, /* valve at zero until PB1 */
};

enum sequence_code {
    SEQUENCE_NO_CODE = 0,
    SEQUENCE_NOT_HOMED = 1,  /* PB2 before homing: refused, no fault */
    SEQUENCE_TARGET = 2,     /* target outside the stroke */
    SEQUENCE_FOLLOWING = 3,  /* |TRACK - wMCounter| beyond error_limit */
    SEQUENCE_SCALE = 4,      /* no edges while the valve is open */
    SEQUENCE_HOME_STUCK = 5, /* home switch does not release */
    SEQUENCE_NO_HOME = 6,    /* home switch not found */
    SEQUENCE_HOME_LOST = 7,  /* home switch is on, its interrupt never came */
};

struct sequence_config {
    struct regulator_config law;
    int32_t speed;                 /* Q16.16 [counts/tick] */
    int32_t home_speed;            /* Q16.16 [counts/tick] */
    int32_t acceleration;          /* Q16.16 [counts/tick^2], at least 1 */
    int home_way;                  /* +1 or -1 */
    int32_t home_search;           /* [counts] longest way onto the switch, or off it */
    int32_t low_limit, high_limit; /* [counts] stroke */
    int16_t error_limit;           /* [counts] 1 .. 32767 */
    int32_t scale_open;            /* [PWM counts] deviation that counts as an open valve */
    int32_t scale_ticks;           /* ticks without an edge until the fault; 0: never */
    int32_t debounce;              /* ticks a button must stand */
    bool step;                     /* TRACK jumps to the target */
};

struct sequence_input {
    bool pb1, pb2, home;
    bool home_pending;           /* its interrupt waits */
    int64_t zeroed;              /* home interrupts served so far */
    int32_t target;              /* [counts] */
    int16_t share;               /* 0 .. 4095 of the speed */
    uint16_t counter, counter_2; /* wMCounter, wSt */
};

struct sequence_button {
    bool down;     /* as debounced */
    int32_t ticks; /* it has been otherwise */
};

struct sequence {
    enum sequence_state state;
    enum sequence_code code;
    bool homed;
    struct sequence_button pb1, pb2;
    struct trapezoid track;
    struct regulator law;
    int16_t error;       /* [counts] TRACK - wMCounter */
    int16_t deviation;   /* [PWM counts] */
    int64_t zeroed;      /* home interrupts when last looked */
    uint16_t difference; /* wMCounter - wSt when last looked */
    uint16_t counter_2;  /* wSt when last looked */
    int32_t still;       /* ticks without an edge while the valve is open */
};

/* At power-up, unhomed or, for studies, ready at count 0. A button that is held then must be let go
 * first. */
void sequence_reset(struct sequence *s, bool homed);

/* One timer period; deviation of the PWM from its middle [PWM counts]. */
int16_t sequence_tick(const struct sequence_config *c, struct sequence *s,
                      const struct sequence_input *in);

#endif
