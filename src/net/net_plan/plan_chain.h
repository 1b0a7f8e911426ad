/* plan_chain - a polyline as one smooth curve within a tolerance, driven as fast as the axes allow.
 *
 *     vertices ──> shape ──segments──> speed profile ──way──> place
 *
 * The curve stays within the tolerance of the polyline, and the polyline of the curve. Vertices are
 * taken as there is room; those behind the tool are dropped, so the size does not depend on their
 * number.
 */
#ifndef PLAN_CHAIN_H
#define PLAN_CHAIN_H

#include "speed_profile.h"
#include "shape.h"

struct plan_chain {
    bool open;        /* more vertices may come */
    bool full;        /* the latest vertex had no room; the motion must go on first */
    int32_t stops;    /* number of rests before its end so far */
    double tolerance; /* [mm] */
    double end[AXES]; /* [mm] the latest vertex */
    int32_t
        joined;  /* number of segments that the speed profile has, of those that the shape keeps */
    double base; /* [mm] path parameter at the start of the first segment kept */
    double place[AXES]; /* [mm] position of the motion */
    struct speed_limits limits;
    struct shape shape;           /* the curve */
    struct speed_profile profile; /* the speed along it */
};

/* Begin a polyline at a place [mm], at rest. */
void plan_chain_start(struct plan_chain *c, const double place[AXES], double tolerance,
                      const struct speed_limits *l);

/* Append a vertex, reached at a speed of at most feed [mm/s]. False if there is no room: call
 * plan_chain_advance first. */
bool plan_chain_line(struct plan_chain *c, const double place[AXES], double feed);

/* The latest vertex is the last. */
void plan_chain_end(struct plan_chain *c);

/* Whether it may be driven: the look-ahead is full or the last vertex is known. */
bool plan_chain_ready(const struct plan_chain *c);

/* Let up to dt [s] pass. Returns the time that is left; it is above 0 only at the end. */
double plan_chain_advance(struct plan_chain *c, double dt);

/* Whether no more vertices come and the motion rests at the end. */
bool plan_chain_done(const struct plan_chain *c);

#endif
