/* Encoder latch: what triggers came since the latest sample, and which of them a counter keeps. */
#ifndef LATCH_H
#define LATCH_H

#include <stdbool.h>
#include <stdint.h>

/* Bits of the source mask. */
enum {
    LATCH_INDEX = 0, /* 9: index of encoder 1 to 9 */
    LATCH_LDI = 9,   /* 2: local inputs LDI0, LDI1, at the edges chosen for them */
    LATCH_RDI = 11,  /* 2: remote inputs DI0, DI1 of the first slave, at the edges chosen */
    LATCH_ADC = 13,  /* 2: compare events of ADC channels 1, 2 */
    LATCH_SOURCES = 15,
};

/* Clocks of the triggers since the latest sample: the first and the latest of each source. */
struct latch_moments {
    uint32_t came; /* sources that fired */
    int64_t first[LATCH_SOURCES];
    int64_t last[LATCH_SOURCES];
};

struct latch {
    uint32_t source; /* sources that latch; 0 switches the latch off */
    bool keep_last;  /* every trigger latches; else only the first after arming */
    bool armed;      /* waits for its first trigger, or keeps the last */
    int32_t seen;    /* sampling periods in which it has latched */
    int64_t value;   /* [counts] of the counter at `clock` */
    int64_t clock;
};

/* A source fires. */
void latch_note(struct latch_moments *m, int source, int64_t clock);

/* Choose sources and mode, and arm. The value stays until the next trigger. */
void latch_arm(struct latch *l, uint32_t source, bool keep_last);

/* Clock at which the counter has to be looked at; -1 if nothing triggered it. */
int64_t latch_due(const struct latch *l, const struct latch_moments *m);

/* Keep the counter's value at that clock. */
void latch_take(struct latch *l, int64_t value, int64_t clock);

#endif
