/* homing - the axes' search of their origins: the state machine of `home` for each axis, wired to
 * the trajectory's axes, the card's signals and its index latch. The calls stand in mcc.h.
 *
 * Places are those of the encoder, in mm of the library: the library and the card begin with their
 * counters at zero. So what a search finds does not depend on how far the axis lags behind.
 */
#ifndef HOMING_H
#define HOMING_H

#include "home.h"
#include "machine.h"

struct mcc;

enum homing_state { HOMING_NEVER, HOMING_RUNS, HOMING_DONE, HOMING_FAILED };

struct homing_axis {
    struct home_config config; /* mode, ways, speeds; not valid: the axis cannot be homed */
    bool inverted;             /* the encoder counts down when the axis moves up */
    int32_t zero;              /* [counts] of the encoder where the axis is at 0 */
    struct home home;
    struct home_order order; /* the one that the trajectory's axis follows */
    int32_t latched;         /* the card's number of latches when armed last */
    int32_t still;           /* [counts] the encoder has stood within a count of here ... */
    int64_t clocks;          /* [clocks] for so long, all pulses being written */
};

struct homing {
    enum homing_state state;
    int32_t order[AXES]; /* of the call */
    int32_t group;       /* the number that is under way */
    int64_t settle;      /* [clocks] an axis stands still before it counts as at rest */
    struct homing_axis axis[AXES];
};

/* How an axis is homed; `inverted` as above. The offset counts in whole pulses. Refused with
 * MCC_PARAMETER if a value is out of range, or a speed above the safe speed, and with
 * MCC_COMMAND_NOTFINISHED while homing runs. */
int homing_set(struct mcc *m, int axis, const struct home_config *config, bool inverted);

/* Time that an axis must stand still behind its pulses to count as at rest: longer than the card's
 * FIFO lasts and the drive needs. [s] */
int homing_set_settle(struct mcc *m, double seconds);

/* Place of the machine at an encoder count of an axis. [mm] */
double homing_place(const struct mcc *m, int axis, int32_t count);

/* The card has reported its signals, `clocks` after the report before: the search takes its next
 * step. */
void homing_look(struct mcc *m, int64_t clocks);

#endif
