/* card_outputs - the network card's sixteen programmable outputs, switched by a software interrupt:
 * several pins change at the same instant.
 *
 * Whoever wants outputs switched writes the variable of each pin, raises its flag and asks for the
 * software interrupt. The routine goes through the flags from pin 0 up, writes all levels in one
 * store, starts the timers of pulses and takes the flags down. A variable that is written again
 * before that replaces the one before.
 *
 * A pulse holds its active level for its width, then the other level. A new pulse begins its width
 * anew; a level ends a pulse. */
#ifndef CARD_OUTPUTS_H
#define CARD_OUTPUTS_H

#include <stdbool.h>
#include <stdint.h>

#include "card_settings.h"

enum mc_po_mode { MC_PO_LEVEL, MC_PO_PULSE };

enum { MC_PO_WIDTH_LONGEST = 1000000 }; /* [us] */

/* What an output shall do, as the document's MC_PO. Without padding, as it is copied whole. */
struct mc_po {
    uint16_t pin;      /* 0 .. 15 */
    uint8_t mode;      /* enum mc_po_mode */
    uint8_t active;    /* the level to be set, or the level of a pulse: 1 high, 0 low */
    uint32_t width_us; /* [us] width of a pulse, 1 .. MC_PO_WIDTH_LONGEST */
};

struct card_outputs {
    struct mc_po po[CARD_OUTPUTS];   /* variable of each pin */
    bool flag[CARD_OUTPUTS];         /* pins still to be served, the document's MC_PO_Pins */
    uint32_t levels;                 /* levels of the outputs, a bit each */
    uint32_t pulses;                 /* outputs whose level is a pulse, a bit each, */
    int64_t pulse_end[CARD_OUTPUTS]; /* [ns] and the end of each */
    int64_t stores;                  /* how often the routine has written levels */
    int64_t merged;                  /* variables written again before they were served */
};

void card_outputs_start(struct card_outputs *c);

/* Write the variable of a pin and raise its flag. False, and nothing changes, if a value is out of
 * range. */
bool card_outputs_flag(struct card_outputs *c, const struct mc_po *po);

/* The same for all pins of a mask, each with this variable. */
bool card_outputs_flag_pins(struct card_outputs *c, uint32_t pins, const struct mc_po *po);

/* The software interrupt's routine. Returns the pins that it served, a bit each. */
uint32_t card_outputs_serve(struct card_outputs *c, int64_t now);

/* End of the next pulse [ns]; INT64_MAX: there is none. Call card_outputs_advance at that time. */
int64_t card_outputs_next(const struct card_outputs *c);
void card_outputs_advance(struct card_outputs *c, int64_t now);

#endif
