/* plan_chain - a line of vertices as one smooth curve, driven as fast as the axes allow.
 *
 *     vertices ──> shape ──segments──> speed profile ──way──> place
 *
 * The curve keeps within a tolerance of the line, both ways. Vertices come as there is room; what
 * is behind the tool is forgotten, so the size does not depend on how many there are.
 */
#ifndef PLAN_CHAIN_H
#define PLAN_CHAIN_H

#include "speed_profile.h"
#include "shape.h"

struct plan_chain {
    bool open;        /* vertices may come */
    bool full;        /* none has room before the motion goes on */
    int32_t stops;    /* rests before its end so far */
    double tolerance; /* [mm] */
    double end[AXES]; /* [mm] the latest vertex */
    int32_t joined;   /* segments that the speed profile has, from the first that the shape keeps */
    double base; /* [mm] of the speed profile: start of the first segment that the shape keeps */
    double place[AXES]; /* [mm] where the motion is */
    struct speed_limits limits;
    struct shape shape;
    struct speed_profile profile;
};

/* A line begins there. */
void plan_chain_start(struct plan_chain *c, const double place[AXES], double tolerance,
                      const struct speed_limits *l);

/* On to a vertex at a speed of at most feed [mm/s]. False: no room, drive on first. */
bool plan_chain_line(struct plan_chain *c, const double place[AXES], double feed);

/* The latest vertex is the last. */
void plan_chain_end(struct plan_chain *c);

/* Whether it may be driven: all that can be seen ahead is there. */
bool plan_chain_ready(const struct plan_chain *c);

/* Let up to dt pass [s]; returns what is left: above 0 only at its end. */
double plan_chain_advance(struct plan_chain *c, double dt);

/* It is open no more, and the motion rests at its end. */
bool plan_chain_done(const struct plan_chain *c);

#endif
