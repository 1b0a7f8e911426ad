/* inquiry - what a part program asks of the machine: the value of an input (M66), and where a probe
 * makes contact (G38). The interpreter waits until the answer is there.
 *
 *     M66    motion ends, wait for the input, the program is read on
 *     G38    motion ends, is the probe free?, line -> contact, ramp, pulses out -> read on
 *                                                  -> end, pulses out, settled: no contact
 */
#ifndef INQUIRY_H
#define INQUIRY_H

#include <stdbool.h>
#include <stdint.h>

#include "axis_count.h"

struct mcc;

/* What tells where the axes were at a contact. */
enum inquiry_place {
    INQUIRY_ENCODERS, /* the encoder counters at the look that saw the contact */
    INQUIRY_LATCH,    /* the encoder counts that the card has latched; a latch is a contact, too */
    INQUIRY_PULSES    /* the pulses put out at that look, for axes without encoders */
};

struct inquiry {
    enum inquiry_place place;
    bool waits;            /* M66: motion has ended and the program waits for the input */
    double was;            /* value of that input at the latest look */
    int64_t clocks;        /* M66: waited so far; G38: since every pulse is out */
    bool touched;          /* the probe has made contact */
    double contact[AXES];  /* [mm] where the axes were at the contact */
    int32_t latched[AXES]; /* signals.latched when the probe began to move */
};

/* Set what tells the place of a contact. Refused while a program runs. */
int inquiry_set_place(struct mcc *m, enum inquiry_place place);

/* Look at m->signals, `clocks` after the look before, and answer what the program has asked. */
void inquiry_look(struct mcc *m, int64_t clocks);

#endif
