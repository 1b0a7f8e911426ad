/* sequence - main program of the positioner, run once per timer period: buttons, homing,
 * positioning and faults. README.md has the state diagram and the table of codes. TRACK is the
 * command position (trapezoid.h), wMCounter and wSt are the two counters of the scale (port.h). */
#ifndef SEQUENCE_H
#define SEQUENCE_H

#include <stdbool.h>
#include <stdint.h>

#include "regulator.h"
#include "trapezoid.h"

enum sequence_state {
    SEQUENCE_UNHOMED = 0,    /* not homed; valve at zero */
    SEQUENCE_BACK_OFF = 1,   /* homing began on the home switch: move off it first */
    SEQUENCE_SEARCH = 2,     /* move towards the home switch at constant speed */
    SEQUENCE_STOP = 3,       /* come to rest, behind the switch or by PB1 */
    SEQUENCE_READY = 4,      /* homed and at rest, position held */
    SEQUENCE_ACCELERATE = 5, /* phases of a move to the target: speed rises, */
    SEQUENCE_CRUISE = 6,     /* is constant, */
    SEQUENCE_DECELERATE = 7, /* falls */
    SEQUENCE_FAULT = 8,      /* valve at zero until PB1 */
};

enum sequence_code {
    SEQUENCE_NO_CODE = 0,
    SEQUENCE_NOT_HOMED = 1,  /* PB2 before homing: refused, no fault */
    SEQUENCE_TARGET = 2,     /* target outside the stroke */
    SEQUENCE_FOLLOWING = 3,  /* |TRACK - wMCounter| beyond error_limit */
    SEQUENCE_SCALE = 4,      /* no edges while the valve is open */
    SEQUENCE_HOME_STUCK = 5, /* home switch does not release */
    SEQUENCE_NO_HOME = 6,    /* home switch not found */
    SEQUENCE_HOME_LOST = 7,  /* home switch is on, but its interrupt never came */
};

struct sequence_config {
    struct regulator_config law;
    int32_t speed;                 /* Q16.16 [counts/tick] speed limit of moves */
    int32_t home_speed;            /* Q16.16 [counts/tick] speed of homing */
    int32_t acceleration;          /* Q16.16 [counts/tick^2], at least 1 */
    int home_way;                  /* direction of the home search, +1 or -1 */
    int32_t home_search;           /* [counts] longest way onto the switch, or off it */
    int32_t low_limit, high_limit; /* [counts] ends of the stroke */
    int16_t error_limit;           /* [counts] following error that is a fault, 1 .. 32767 */
    int32_t scale_open;            /* [PWM counts] deviation that counts as an open valve */
    int32_t scale_ticks;           /* [ticks] without an edge until the fault; 0: never */
    int32_t debounce;              /* [ticks] for which a button's level must last */
    bool step;                     /* TRACK jumps to the target: step response */
};

struct sequence_input {
    bool pb1, pb2, home;         /* buttons, home switch */
    bool home_pending;           /* the home interrupt waits */
    int64_t zeroed;              /* number of home interrupts served so far */
    int32_t target;              /* [counts] */
    int16_t share;               /* of the speed limit, 0 .. 4095 for 0 .. 1 */
    uint16_t counter, counter_2; /* wMCounter, wSt [counts] */
};

struct sequence_button {
    bool down;     /* debounced state */
    int32_t ticks; /* [ticks] for which the pin has differed from it */
};

struct sequence {
    enum sequence_state state;
    enum sequence_code code;
    bool homed;
    struct sequence_button pb1, pb2;
    struct trapezoid track; /* TRACK */
    struct regulator law;
    int16_t error;       /* [counts] following error, TRACK - wMCounter */
    int16_t deviation;   /* [PWM counts] of the PWM from its middle */
    int64_t zeroed;      /* number of home interrupts served, at the latest tick */
    uint16_t difference; /* wMCounter - wSt at the latest home interrupt */
    uint16_t counter_2;  /* wSt at the latest tick */
    int32_t still;       /* [ticks] without an edge while the valve is open */
};

/* Power up, unhomed or, for studies, homed and ready at count 0. A button that is held then must be
 * released first. */
void sequence_reset(struct sequence *s, bool homed);

/* One timer period. Returns the PWM's deviation from its middle [PWM counts]. */
int16_t sequence_tick(const struct sequence_config *c, struct sequence *s,
                      const struct sequence_input *in);

#endif
