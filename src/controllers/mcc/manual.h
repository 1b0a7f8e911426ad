/* manual - axes moved by hand, one by one: jog and handwheel. The calls are in mcc.h.
 *
 * While any axis is moved by hand or homed, commands are refused and each axis of the trajectory
 * moves by itself, as it is ordered.
 */
#ifndef MANUAL_H
#define MANUAL_H

#include "machine.h"

struct mcc;

enum manual_use { MANUAL_NONE, MANUAL_JOG, MANUAL_WHEEL, MANUAL_HOME };

enum { MANUAL_ENCODERS = 9 }; /* counters of the card, those of the axes first */

struct manual_axis {
    enum manual_use use;
    bool steps;      /* JOG: its goal is the end of steps (manual_step) */
    int32_t encoder; /* encoder counter of the handwheel, 0 .. 8 */
    double ratio;    /* [pulses/count] of the axis by the handwheel */
    bool rests;      /* WHEEL: it does not lead beyond a software limit in force */
    int32_t count;   /* [counts] of that counter at the latest look */
    int64_t turned;  /* [counts] that the wheel has turned since the axis was at `base` */
    int32_t base;    /* [pulses] position from which those counts move the axis */
};

struct manual {
    struct manual_axis axis[AXES];
};

/* MCC_NO_ERR if axes may be moved by hand now, or the code that says why not. */
int manual_allowed(const struct mcc *m);

/* Take an axis into use. The first one lets all axes of the trajectory move by themselves. */
void manual_use(struct mcc *m, int axis, enum manual_use use);

/* As MCC_jog_c; with the software limits of the axis in force the jog ends at rest at the limit
 * that it leads to. Refused with MCC_COMMAND_NOTACCEPTED at that limit and beyond. */
int manual_jog(struct mcc *m, int axis, int direction, double percent);

/* As MCC_jog_i; a step while the axis is under way by steps moves its goal on. A step that would
 * end beyond a software limit in force, further out than the axis is, is refused with
 * MCC_COMMAND_NOTACCEPTED. */
int manual_step(struct mcc *m, int axis, double distance, double percent);

/* As MCC_MPG_set; with the software limits of the axis in force it comes to rest at the limit to
 * which the wheel leads. What it is turned beyond is forgotten: turned back it leaves at once. */
int manual_follow(struct mcc *m, int axis, int encoder, double ratio);

/* True while some axis follows a handwheel. */
bool manual_wheel(const struct mcc *m);

/* Act on the signals that the card has just reported: stop jogged axes that move onto a limit
 * switch, and let axes follow their handwheels. */
void manual_look(struct mcc *m);

/* Call after an IPO cycle: axes whose jog is done are no longer in use; once none is, commands are
 * taken again. */
void manual_end(struct mcc *m);

#endif
