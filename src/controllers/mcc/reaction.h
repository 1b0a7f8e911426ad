/* reaction - what the library does about danger to the machine.
 *
 *     every point before it is queued      reaction_point: pulses, their change, travel, switches
 *     every look at the card               reaction_look: emergency stop, following error, overflow
 *                                          of an error counter, in-position check
 *
 * A reaction drops program and commands, and is one of three stops:
 *
 *     ramp       as MCC_motion_abort, behind the points in the queue
 *     at once    the points that no transaction holds are dropped
 *     emergency  all points are lost; the position follows the card's pulse count
 *
 * Homing is left alone: it meets limit switches, and looks for the origin that software limits
 * count from. Otherwise the ramp from each point on is known to keep the software limits, so they
 * are not passed whatever stops a motion. The ramp of an error is only checked for what the card
 * can take.
 */
#ifndef REACTION_H
#define REACTION_H

#include "mcc.h"

/* Complete a point, where m->trajectory is, with its frame; `ramping`: an abort has led there.
 * False: it must not be queued, and *error is the run-time error to raise, 0 for a stop without
 * one. The machine is that of m. */
bool reaction_point(struct mcc *m, const struct mechanism *machine, bool ramping, struct point *p,
                    int32_t *error);

/* Ramp to rest; a second error, met on the ramp of the first, stops without a ramp. */
void reaction_stop(struct mcc *m, int32_t error);

/* Run-time error of a command that was refused while the program ran. */
int32_t reaction_error_of(const struct fault_report *r);

struct reaction_look {
    int64_t clocks;    /* since the latest look */
    int32_t flying;    /* points at the head of the queue that a transaction holds */
    uint32_t overflow; /* axes whose error counter has told an overflow since, a bit each */
};

/* Look at m->signals. */
void reaction_look(struct mcc *m, const struct reaction_look *l);

/* Motion has ended and the card has put out every pulse. */
bool reaction_arrived(const struct mcc *m);

/* Position by the pulses that the card has put out, of which the compensation is no part. */
int32_t reaction_put_out(const struct mcc *m, int axis);

/* MCC_clear_error of an open library. */
int reaction_clear(struct mcc *m);

#endif
