/* manual - axes moved by hand, one by one: jog and hand wheel. The calls stand in mcc.h.
 *
 * While an axis is in use here, or in homing, commands are refused and the trajectory's axes follow
 * orders.
 */
#ifndef MANUAL_H
#define MANUAL_H

#include "machine.h"

struct mcc;

enum manual_use { MANUAL_NONE, MANUAL_JOG, MANUAL_WHEEL, MANUAL_HOME };

enum { MANUAL_ENCODERS = 9 }; /* counters of the card, those of the axes first */

struct manual_axis {
    enum manual_use use;
    int32_t encoder; /* hand wheel: its counter, 0 .. 8 */
    double ratio;    /* [pulses/count] */
    int32_t count;   /* [counts] of the counter at the latest look */
    int64_t turned;  /* [counts] since the axis was at `base` */
    int32_t base;    /* [pulses] */
};

struct manual {
    struct manual_axis axis[AXES];
};

/* MCC_NO_ERR if axes may be moved by hand now, or the code that says why not. */
int manual_allowed(const struct mcc *m);

/* Take an axis into use; the first one sets the axes free. */
void manual_use(struct mcc *m, int axis, enum manual_use use);

/* True while an axis follows a hand wheel. */
bool manual_wheel(const struct mcc *m);

/* The card has reported its signals: limit switches stop axes that move onto them, axes follow
 * their hand wheels. */
void manual_look(struct mcc *m);

/* After an IPO cycle: axes that have done what they should are out of use; the last one brings
 * back commands. */
void manual_end(struct mcc *m);

#endif
