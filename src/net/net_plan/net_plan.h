/* net_plan - a drawing as the frames of a job: whole pulses of four axes in each DDA period.
 *
 *     moves, vertices ──> net_plan_take ──┐
 *                                         ├──> net_plan_next ──> frames
 *     raise, rapid, lower, draw ──────────┘
 *
 * - X and Y draw. A move raises the pen, goes there on a straight line with limited jerk, and
 *   lowers the pen when something is drawn. An output moves the pen (events of the job, with a
 *   dwell), or an axis does.
 * - Speed, acceleration and jerk of each axis keep to its limits at every instant; a share of the
 *   last two is left free, by which the card can slow down for a pause.
 * - A command is the difference of two rounded places: half a pulse off at most, nothing adds up.
 * - Constant size, however long the drawing.
 */
#ifndef NET_PLAN_H
#define NET_PLAN_H

#include "job_page.h"
#include "plan_chain.h"
#include "scurve.h"

enum net_plan_pen { NET_PLAN_OUTPUT, NET_PLAN_AXIS };

/* Events of the job that move a pen by an output. */
enum net_plan_event { NET_PLAN_LOWER = 1, NET_PLAN_RAISE = 2 };

struct net_plan_axis {
    double pulses_per_mm; /* > 0; X and Y must, others without a pen are 0 and stand */
    double speed;         /* [mm/s] > 0 */
    double acc;           /* [mm/s^2] > 0 */
    double jerk;          /* [mm/s^3] > 0 */
};

struct net_plan_config {
    struct net_plan_axis axis[JOB_AXES];
    int32_t period_ns; /* [ns] of a frame */
    double tolerance;  /* [mm] > 0 of the curve from the vertices, both ways */
    double rapid;      /* [mm/s] > 0 with the pen up, and of an axis that moves it */
    double reserve;    /* 0 .. < 1 share of acceleration and jerk left free */
    enum net_plan_pen pen;
    int32_t pen_axis; /* 2 or 3 */
    double up, down;  /* [mm] its places */
    double dwell;     /* [s] of rest while the pen moves */
};

enum net_plan_kind {
    NET_PLAN_MOVE, /* there with the pen up */
    NET_PLAN_DRAW, /* there with the pen down */
    NET_PLAN_STOP  /* the same, to rest exactly there */
};

struct net_plan_vertex {
    double point[2]; /* [mm] */
    double feed;     /* [mm/s] > 0; of a move any */
    enum net_plan_kind kind;
};

enum net_plan_step { NET_PLAN_NOTHING, NET_PLAN_RESTS, NET_PLAN_SLIDES, NET_PLAN_DRAWS };

struct net_plan_frame {
    struct job_frame job;
    double place[JOB_AXES];  /* [mm] planned at its end */
    enum net_plan_step step; /* what it is part of */
};

enum net_plan_result {
    NET_PLAN_FRAME,
    NET_PLAN_WANTS, /* a vertex, or the end */
    NET_PLAN_OVER
};

struct net_plan {
    struct net_plan_config config;
    double place[JOB_AXES];     /* [mm] */
    int64_t pulses[JOB_AXES];   /* of it */
    bool lowered, told;         /* the pen is down; where it is has been said */
    bool moving, drawing, over; /* a move, a line waits or is under way; nothing more comes */
    double goal[2], target[2];  /* [mm] the end of all that has come; of the move */
    enum net_plan_step step;
    int32_t rest;        /* frames left */
    int32_t stops;       /* rests within lines so far, where there is no room for a curve */
    struct scurve slide; /* along a straight line, */
    double from[JOB_AXES], slope[JOB_AXES]; /* [mm], [1] from there */
    double time;                            /* [s] since it began */
    struct plan_chain chain;
};

/* A job begins at rest at 0 of all axes, the pen to be raised. */
void net_plan_start(struct net_plan *p, const struct net_plan_config *config);

/* The next vertex. False: frames must be taken first. */
bool net_plan_take(struct net_plan *p, const struct net_plan_vertex *v);

/* Nothing more comes: the pen is raised behind the last line. */
void net_plan_end(struct net_plan *p);

/* The next frame. */
enum net_plan_result net_plan_next(struct net_plan *p, struct net_plan_frame *f);

#endif
