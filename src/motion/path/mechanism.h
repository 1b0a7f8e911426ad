/* mechanism - what moves the tool: joints with their bounds, and how they follow its place.
 *
 *     tool place --kinematics--> joints --scale--> pulses
 *     [mm]                       [mm], [deg]
 *
 * Without kinematics a joint is a coordinate of the place: a Cartesian machine. A mechanism is an
 * argument of the calls that need it and part of no state. Coordinates and joints have the units of
 * their own axis; "mm" in the other headers stands for them.
 */
#ifndef MECHANISM_H
#define MECHANISM_H

#include <stdbool.h>
#include <stdint.h>

#include "path.h"

struct joint {
    bool used;        /* false: it gets no pulses */
    bool bounded;     /* low and high are its range */
    double scale;     /* [pulses/mm] */
    double speed;     /* [mm/s] highest */
    double acc, jerk; /* [mm/s^2], [mm/s^3] highest along a path; 0: the ramps' alone */
    double low, high; /* [mm] range */
};

/* Functions of a mechanism whose joints are not the coordinates of the tool. */
struct kinematics {
    /* Joints of a place. joint[] holds those of a place nearby, of which the branch is kept. False,
     * and joint[] as it was: the place is out of reach. */
    bool (*joints)(const void *geometry, const double place[AXES], double joint[AXES]);
    /* d(joint)/ds of a tool that moves from a place, whose joints are given, by slope[] ds. False
     * where they have none: at a singular place. */
    bool (*rates)(const void *geometry, const double joint[AXES], const double slope[AXES],
                  double rate[AXES]);
    /* Place of the tool by the joints. */
    void (*place)(const void *geometry, const double joint[AXES], double place[AXES]);
};

struct mechanism {
    bool axis[AXES]; /* the coordinate of the tool may be commanded */
    struct joint joint[AXES];
    const struct kinematics *kinematics; /* NULL: joints are coordinates */
    const void *geometry;                /* what its functions know of the mechanism */
    const double *near; /* [mm] joints: the branch of a path is the one near these */
};

/* Joints of a place, joint[] nearby before. False: out of reach. */
bool mechanism_joints(const struct mechanism *m, const double place[AXES], double joint[AXES]);

/* Joints of the first place of a path, on the branch near m->near. */
bool mechanism_first(const struct mechanism *m, const double place[AXES], double joint[AXES]);

/* Joints at a position in pulses, to begin mechanism_joints with; a joint not in use is at 0.
 * Without kinematics none are needed, and joint[] is left as it is. */
void mechanism_near(const struct mechanism *m, const int32_t pulses[AXES], double joint[AXES]);

/* Place of joints. */
void mechanism_place(const struct mechanism *m, const double joint[AXES], double place[AXES]);

/* The joints' position in whole pulses; that of a joint not in use stays as it was. */
void mechanism_pulses(const struct mechanism *m, const double joint[AXES], int32_t pulses[AXES]);

/* What a path asks of the joints. */
struct mechanism_way {
    bool reached;                 /* every place of it can be reached, and none is singular */
    double share[AXES];           /* highest |d(joint)/ds| */
    double low[AXES], high[AXES]; /* extent of the joints [mm] */
};

/* Without kinematics it is exact. With them it is found at places no further apart than
 * 1/MECHANISM_PLACES of the path, or of a radian on an arc, and at the tops of the parabolas
 * through three places in a row. */
enum { MECHANISM_PLACES = 64 };
void mechanism_way(const struct mechanism *m, const struct path *p, struct mechanism_way *w);

/* First joint whose motion from a position [pulses] to these extremes [mm] leads beyond its bounds,
 * and further out than it is; -1 none. *side: 1 above, -1 below. Compared in whole
 * pulses, so that a target on a bound is within it. */
int mechanism_beyond(const struct mechanism *m, const double from[AXES], const double low[AXES],
                     const double high[AXES], int *side);

/* The same for a motion from one position to another. [pulses] */
int mechanism_outside(const struct mechanism *m, const int32_t from[AXES], const int32_t to[AXES]);

/* Whether any joint has a range. */
bool mechanism_bounded(const struct mechanism *m);

#endif
