/* curve - commands in a row as one smooth curve, driven as fast as the limits of the axes allow.
 *
 *     ring ──> shape ──segments──> speed profile ──way──> point
 *              smooth path       speed along it
 *
 * Shape and speed profile are large and stand beside the trajectory, which keeps the place of the
 * motion in them: an earlier place can be put back until what lies behind the tool is dropped.
 */
#ifndef CURVE_H
#define CURVE_H

#include "limited.h"
#include "speed_profile.h"
#include "ring.h"
#include "shape.h"

/* What stands beside the trajectory. */
struct curve_plan {
    struct speed_limits limits; /* limits of chains from now on */
    bool last;                  /* no more commands come for now: none is waited for */
    double end[AXES];           /* [mm] end of the latest command taken */
    double widest;              /* [mm] highest tolerance of the commands of the chain */
    int32_t joined;    /* number of finished segments of the shape that the speed profile has */
    double joined_way; /* [mm] their end on the chain */
    double part;       /* [mm] length of the next one that the speed profile has, too */
    double start;      /* [mm] where the speed profile begins, from the start of the chain */
    struct shape shape;
    struct speed_profile profile;
};

struct curve {
    struct speed_profile_place place; /* the motion since it rested last */
    double start;                     /* [mm] where it rested, from the start of the chain */
    bool closed;                      /* no further command joins */
    bool halts;                       /* single block: a goal is to be chosen */
    double goal;   /* [mm] where a block begins, before which it rests; or INFINITY */
    int32_t line;  /* line of the latest mark */
    int32_t idle;  /* points since the ring has been empty */
    int32_t begun; /* number of marks of the shape that the tool has passed */
    int32_t at;    /* segment of the tool, from the first that the shape keeps */
    double base;   /* [mm] start of that segment on the chain */
    double point[AXES], velocity[AXES]; /* [mm], [mm/s] of the tool */
};

/* Whether the first command of the ring begins a curve. */
bool curve_begins(const struct ring *r);

/* Begin one, at rest. */
void curve_start(struct curve *c, struct curve_plan *m, const struct ring *r);

/* Take what the ring has, or let up to dt seconds pass under an override; 0 brings the motion to
 * rest. Returns the time left: above 0 at the end of the chain, and if the ring, now empty, could
 * be filled again before time passes. */
double curve_advance(struct curve *c, struct curve_plan *m, struct ring *r, double override,
                     double dt);

/* Single block: no further command joins, and the motion comes to rest before the first block that
 * it can rest before; or no longer. */
void curve_single(struct curve *c, struct curve_plan *m, bool on);

/* Whether it rests before a block. */
bool curve_waits(const struct curve *c);

/* Go on from there, to the next block or to the end. */
void curve_go(struct curve *c, struct curve_plan *m, bool single);

/* A point is due: the tool to where the motion is. */
void curve_sample(struct curve *c, struct curve_plan *m);

/* The next command that the tool has begun since it was asked last, or NULL. */
const struct shape_mark *curve_begun(struct curve *c, const struct curve_plan *m);

/* The point is taken: drop what the tool has left. */
void curve_drop(struct curve *c, struct curve_plan *m);

/* Smallest and largest coordinates of the way from the tool to where an override of 0 brings it to
 * rest by speed_profile_stop_way, or up to 1 nm more. [mm] */
void curve_stop_extent(const struct curve *c, struct curve_plan *m, double low[AXES],
                       double high[AXES]);

/* What limits the motion, an override being above 0. */
struct limited curve_limited(const struct curve *c, const struct curve_plan *m, double override);

/* Whether it stands; whether it is at the end of a chain that nothing joins any more. */
bool curve_rests(const struct curve *c);
bool curve_done(const struct curve *c, const struct curve_plan *m);

#endif
