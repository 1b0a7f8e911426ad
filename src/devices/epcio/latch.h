/* latch - encoder latch: keeps a counter's value at the clock of a trigger, such as an index pulse
 * or an input, the first one or each. Triggers are noted with their clocks between two samples. */
#ifndef LATCH_H
#define LATCH_H

#include <stdbool.h>
#include <stdint.h>

/* First bit of each kind of source in the source mask. */
enum {
    LATCH_INDEX = 0, /* 9 bits: index of encoder 1 to 9 */
    LATCH_LDI = 9,   /* 2 bits: local inputs LDI0, LDI1, at the edges chosen for them */
    LATCH_RDI = 11,  /* 2 bits: remote inputs DI0, DI1 of the first slave, at the edges chosen */
    LATCH_ADC = 13,  /* 2 bits: compare events of ADC channels 1, 2 */
    LATCH_SOURCES = 15,
};

/* Clocks of the triggers since the latest sample: the first and the latest of each source. */
struct latch_moments {
    uint32_t came;                /* sources that fired, a bit each */
    int64_t first[LATCH_SOURCES]; /* [clock] */
    int64_t last[LATCH_SOURCES];  /* [clock] */
};

struct latch {
    uint32_t source; /* sources that latch; 0 switches the latch off */
    bool keep_last;  /* every trigger latches; else only the first after arming */
    bool armed;      /* the next trigger latches */
    int32_t seen;    /* number of sampling periods in which it has latched */
    int64_t value;   /* [counts] value of the counter at `clock` */
    int64_t clock;   /* [clock] of the trigger that latched last */
};

/* Note that a source fires. */
void latch_note(struct latch_moments *m, int source, int64_t clock);

/* Choose sources and mode, and arm. The value stays until the next trigger. */
void latch_arm(struct latch *l, uint32_t source, bool keep_last);

/* Clock at which the counter's value is to be kept; -1 if no source of it fired. */
int64_t latch_due(const struct latch *l, const struct latch_moments *m);

/* Keep the counter's value at that clock. */
void latch_take(struct latch *l, int64_t value, int64_t clock);

#endif
