/* signals - what the card reports of the machine to the library: switches, pulse, encoder and error
 * counters, latches and inputs. The state of FIFO and interrupts is in struct pcl_card. */
#ifndef SIGNALS_H
#define SIGNALS_H

#include <stdbool.h>
#include <stdint.h>

#include "machine.h"

enum { SIGNALS_ANALOG = 4 };

struct signals {
    bool stop;                     /* the emergency stop acts */
    uint32_t home;                 /* logic level of the home sensors, a bit for each axis */
    uint32_t upper, lower;         /* limit switches, a bit for each axis; 1: on the switch */
    int32_t pulses[AXES];          /* [pulses] put out */
    int32_t enc[AXES];             /* [counts] encoder counters */
    int32_t enc_aux[3];            /* [counts] encoder counters 7 to 9 */
    int32_t err[AXES];             /* [counts] error counters */
    int32_t latch[AXES];           /* [counts] encoder counter at the index latched last */
    int32_t latched[AXES];         /* number of latches so far */
    bool probe;                    /* the probe touches */
    uint32_t digital;              /* digital inputs of M66, a bit each */
    double analog[SIGNALS_ANALOG]; /* analog inputs of M66 */
};

/* A count with its sign turned. Counters wrap, so the lowest value is its own opposite. */
static inline int32_t signals_opposite(int32_t count)
{
    return (int32_t)(0u - (uint32_t)count);
}

/* Turn the card's counts into the library's, or back: those of inverted axes change their sign. */
static inline void signals_turn(struct signals *s, const struct machine *m)
{
    for (int i = 0; i < AXES; i++) {
        if (m->axis[i].inverted) {
            s->pulses[i] = signals_opposite(s->pulses[i]);
            s->enc[i] = signals_opposite(s->enc[i]);
            s->err[i] = signals_opposite(s->err[i]);
            s->latch[i] = signals_opposite(s->latch[i]);
        }
    }
}

#endif
