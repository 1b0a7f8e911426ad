/* signals - what the card tells the library of the machine, beside FIFO and interrupts. */
#ifndef SIGNALS_H
#define SIGNALS_H

#include <stdbool.h>
#include <stdint.h>

#include "machine.h"

enum { SIGNALS_ANALOG = 4 };

struct signals {
    bool stop;                     /* the emergency stop acts */
    uint32_t home;                 /* logic level of the home switches, a bit an axis */
    uint32_t upper, lower;         /* limit switches, a bit an axis, 1: run onto */
    int32_t pulses[AXES];          /* [pulses] put out */
    int32_t enc[AXES];             /* [counts] encoder counters */
    int32_t enc_aux[3];            /* [counts] encoder counters 7 to 9 */
    int32_t err[AXES];             /* [counts] error counters */
    int32_t latch[AXES];           /* [counts] encoder counter at the index latched last */
    int32_t latched[AXES];         /* how often it has latched */
    bool probe;                    /* the probe touches */
    uint32_t digital;              /* inputs of M66, a bit each */
    double analog[SIGNALS_ANALOG]; /* the same */
};

/* The counters wrap, so the lowest value has itself as its opposite. */
static inline int32_t signals_opposite(int32_t count)
{
    return (int32_t)(0u - (uint32_t)count);
}

/* The counts of the card as counts of the library, or back: of an inverted axis they turn round. */
static inline struct signals signals_turned(const struct signals *s, const struct machine *m)
{
    struct signals t = *s;

    for (int i = 0; i < AXES; i++) {
        if (m->axis[i].inverted) {
            t.pulses[i] = signals_opposite(t.pulses[i]);
            t.enc[i] = signals_opposite(t.enc[i]);
            t.err[i] = signals_opposite(t.err[i]);
            t.latch[i] = signals_opposite(t.latch[i]);
        }
    }
    return t;
}

#endif
