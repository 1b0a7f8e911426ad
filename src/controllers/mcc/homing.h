/* homing - the axes' search of their origins: it runs the state machine of home.h for each axis,
 * between the trajectory's axes, the card's signals and its index latch. The calls are in mcc.h.
 *
 * Positions are those of the encoder, in mm of the library; library and card begin with their
 * counters at 0. So the origin found does not depend on the following error.
 */
#ifndef HOMING_H
#define HOMING_H

#include "home.h"
#include "machine.h"

struct mcc;

enum homing_state { HOMING_NEVER, HOMING_RUNS, HOMING_DONE, HOMING_FAILED };

struct homing_axis {
    struct home_config config; /* how the axis is homed; not valid: it cannot be homed */
    bool inverted;             /* the encoder counts down when the axis moves up */
    int32_t zero;              /* [counts] of the encoder where the axis is at 0 */
    struct home home;
    struct home_order order; /* the order that the trajectory's axis follows */
    int32_t latched;         /* signals.latched when the latch was armed last */
    int32_t still;           /* [counts] within one count of which the encoder has stood, */
    int64_t clocks;          /* [clocks] for so long, with every point in the card */
};

struct homing {
    enum homing_state state;
    int32_t order[AXES]; /* as MCC_go_home was given them */
    int32_t group;       /* the order whose axes search now */
    int64_t settle;      /* [clocks] for which an axis stands still before it is at rest */
    struct homing_axis axis[AXES];
};

/* Set how an axis is homed, with `inverted` as in struct homing_axis. The offset is rounded to
 * whole pulses. Refused with MCC_PARAMETER if a value is out of range or a speed above the safe
 * speed, and with MCC_COMMAND_NOTFINISHED while homing runs. */
int homing_set(struct mcc *m, int axis, const struct home_config *config, bool inverted);

/* Time for which the encoder must stand still, after the last point is in the card, until the axis
 * is at rest: 0 .. 1e6 s, longer than the FIFO lasts and than the drive needs to follow. */
int homing_set_settle(struct mcc *m, double seconds);

/* Position of an axis at a count of its encoder. [mm] */
double homing_place(const struct mcc *m, int axis, int32_t count);

/* Take the next step of the search, with the signals that the card has just reported, `clocks`
 * after those before. */
void homing_look(struct mcc *m, int64_t clocks);

#endif
