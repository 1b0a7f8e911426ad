/* reaction - what the library does when the machine is in danger: it checks each point before it is
 * queued and the card's signals at each look, and stops the motion.
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
 * Homing is not watched for travel: it meets limit switches, and looks for the origin from which
 * software limits count. Otherwise a point is queued only if the ramp from there keeps within the
 * software limits, so that they are not passed whatever stops a motion. On the ramp of an error
 * only the pulses per DDA time are checked.
 */
#ifndef REACTION_H
#define REACTION_H

#include "mcc.h"

/* Check the point at which m->trajectory is, and give it its frame. `machine` is that of m, and
 * `ramping` says that an abort has led to the point. False: the point must not be queued, and
 * *error is the run-time error to raise, 0 for a stop without one. */
bool reaction_point(struct mcc *m, const struct mechanism *machine, bool ramping, struct point *p,
                    int32_t *error);

/* Ramp to rest and raise the error, 0 for none. A second error, on the ramp of the first, stops at
 * once; the first one stays. */
void reaction_stop(struct mcc *m, int32_t error);

/* Run-time error for a command of the running program that was refused. */
int32_t reaction_error_of(const struct fault_report *r);

/* A look at the card. */
struct reaction_look {
    int64_t clocks;    /* [clocks] since the look before */
    int32_t flying;    /* points at the head of the queue that a transaction holds */
    uint32_t overflow; /* axes whose error counter has reported an overflow since, a bit each */
};

/* Check m->signals, and react. */
void reaction_look(struct mcc *m, const struct reaction_look *l);

/* True if motion has ended and the card has put out every pulse. */
bool reaction_arrived(const struct mcc *m);

/* Position of an axis by the pulses that the card has put out, less compensation. [pulses] */
int32_t reaction_put_out(const struct mcc *m, int axis);

/* MCC_clear_error for a library that is open. */
int reaction_clear(struct mcc *m);

#endif
