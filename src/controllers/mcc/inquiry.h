/* inquiry - what a part program asks of the machine: inputs (M66), contact of a probe (G38).
 *
 *     M66    motion ends, wait for the input, reading goes on
 *     G38    motion ends, is the probe free?, line -> contact, ramp, pulses out -> reading goes on
 *                                                  -> end, pulses out, settled: no contact
 */
#ifndef INQUIRY_H
#define INQUIRY_H

#include <stdbool.h>
#include <stdint.h>

#include "axis_count.h"

struct mcc;

/* Where the axes were at a contact. */
enum inquiry_place {
    INQUIRY_ENCODERS, /* the encoder counters at the look that saw it */
    INQUIRY_LATCH,    /* what the card's counters have latched, which is a contact, too */
    INQUIRY_PULSES    /* the pulses put out at that look, where there are no encoders */
};

struct inquiry {
    enum inquiry_place place;
    bool waits;     /* for an input: motion has ended */
    double was;     /* its value at the latest look */
    int64_t clocks; /* waited so far, or stood still at the end of probing */
    bool touched;
    double contact[AXES];  /* [mm] then */
    int32_t latched[AXES]; /* signals.latched as the probe began to move */
};

/* How the place of a contact is found. Refused while a program runs. */
int inquiry_set_place(struct mcc *m, enum inquiry_place place);

/* Look at m->signals, `clocks` after the latest look. */
void inquiry_look(struct mcc *m, int64_t clocks);

#endif
