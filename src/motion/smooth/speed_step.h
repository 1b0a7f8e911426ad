/* speed_step - a step of the way with limited jerk, in time.
 *
 * With a constant c the acceleration is a + c u / 2: the motion is one of a spring. From rest and
 * to rest x(u) has no such form; there the jerk is constant in time, and on a hop from rest to rest
 * it is so in four parts.
 */
#ifndef SPEED_STEP_H
#define SPEED_STEP_H

#include "speed_box.h"

enum speed_step_kind { SPEED_NO_STEP, SPEED_BENT, SPEED_JERK, SPEED_HOP };

struct speed_step {
    enum speed_step_kind kind;
    double way, time;      /* [mm], [s] */
    double speed, acc;     /* [mm/s], [mm/s^2] at its start */
    double c;              /* bent: [1/s^2]; else the jerk [mm/s^3] */
    struct speed_state to; /* at its end */
};

/* Way, speed, acceleration and jerk at a time. */
struct speed_motion {
    double way, rate, gain, jerk;
};

struct speed_step speed_step_bent(struct speed_state from, double c, double s);

/* A step from rest for a time; one to rest, from a state with b < 0; one from rest to rest. */
struct speed_step speed_step_start(double jerk, double time);
struct speed_step speed_step_land(struct speed_state from);
struct speed_step speed_step_hop(double jerk, double way);

struct speed_motion speed_step_at(const struct speed_step *s, double t);

#endif
