/* pace_step - a step of the way with limited jerk, in time.
 *
 * With a constant c the acceleration is a + c u / 2: the motion is one of a spring. From rest and
 * to rest x(u) has no such form; there the jerk is constant in time, and on a hop from rest to rest
 * it is so in four parts.
 */
#ifndef PACE_STEP_H
#define PACE_STEP_H

#include "pace_box.h"

enum pace_step_kind { PACE_NO_STEP, PACE_BENT, PACE_JERK, PACE_HOP };

struct pace_step {
    enum pace_step_kind kind;
    double way, time;     /* [mm], [s] */
    double speed, acc;    /* [mm/s], [mm/s^2] at its start */
    double c;             /* bent: [1/s^2]; else the jerk [mm/s^3] */
    struct pace_state to; /* at its end */
};

/* Way, speed, acceleration and jerk at a time. */
struct pace_motion {
    double way, rate, gain, jerk;
};

struct pace_step pace_step_bent(struct pace_state from, double c, double s);

/* A step from rest for a time; one to rest, from a state with b < 0; one from rest to rest. */
struct pace_step pace_step_start(double jerk, double time);
struct pace_step pace_step_land(struct pace_state from);
struct pace_step pace_step_hop(double jerk, double way);

struct pace_motion pace_step_at(const struct pace_step *s, double t);

#endif
