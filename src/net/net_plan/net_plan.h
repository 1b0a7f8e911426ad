/* net_plan - planner of the network card's jobs: a drawing becomes frames, whole pulses of four
 * axes in each DDA period.
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
 * - A command is the difference of two rounded positions: the error is at most half a pulse and
 * does
 *   not accumulate.
 * - The planner's size is constant, however long the drawing.
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
    double pulses_per_mm; /* [pulses/mm] > 0 for X, Y and the pen's axis; 0: the axis stands */
    double speed;         /* [mm/s] limit, > 0 */
    double acc;           /* [mm/s^2] limit, > 0 */
    double jerk;          /* [mm/s^3] limit, > 0 */
};

struct net_plan_config {
    struct net_plan_axis axis[JOB_AXES];
    int32_t period_ns; /* [ns] of a frame */
    double tolerance;  /* [mm] > 0 largest distance between curve and polyline, both ways */
    double rapid;      /* [mm/s] > 0 speed with the pen up, and of the pen's axis */
    double reserve;    /* share of acceleration and jerk left free, 0 .. < 1 */
    enum net_plan_pen pen;
    int32_t pen_axis; /* axis that moves the pen, 2 or 3 */
    double up, down;  /* [mm] its positions with the pen up, down */
    double dwell;     /* [s] time at rest while an output moves the pen */
};

enum net_plan_kind {
    NET_PLAN_MOVE, /* move there with the pen up */
    NET_PLAN_DRAW, /* draw a line there */
    NET_PLAN_STOP  /* draw a line there and come to rest exactly at the vertex */
};

struct net_plan_vertex {
    double point[2]; /* [mm] X, Y */
    double feed;     /* [mm/s] > 0; not used by a move */
    enum net_plan_kind kind;
};

/* Motion under way: none; a dwell while the pen moves; a straight move; drawing. */
enum net_plan_step { NET_PLAN_NOTHING, NET_PLAN_RESTS, NET_PLAN_SLIDES, NET_PLAN_DRAWS };

struct net_plan_frame {
    struct job_frame job;
    double place[JOB_AXES];  /* [mm] planned position at its end */
    enum net_plan_step step; /* motion that it belongs to */
};

enum net_plan_result {
    NET_PLAN_FRAME, /* a frame has been planned */
    NET_PLAN_WANTS, /* the planner needs a vertex, or net_plan_end */
    NET_PLAN_OVER   /* the job is complete */
};

struct net_plan {
    struct net_plan_config config;
    double place[JOB_AXES];     /* [mm] planned position */
    int64_t pulses[JOB_AXES];   /* [pulses] the same, rounded */
    bool lowered, told;         /* the pen is down; it has been moved at least once */
    bool moving, drawing, over; /* a move waits; a line waits or is drawn; no vertices come */
    double goal[2], target[2];  /* [mm] the latest vertex; end of the move */
    enum net_plan_step step;
    int32_t rest;                           /* [frames] left of the dwell */
    int32_t stops;                          /* rests within lines, where no curve has room */
    struct scurve slide;                    /* speed profile of the straight move */
    double from[JOB_AXES], slope[JOB_AXES]; /* [mm] its start; its direction, |slope| = 1 */
    double time;                            /* [s] since it began */
    struct plan_chain chain;                /* the line being drawn */
};

/* Start a job, at rest at 0 of all axes; the pen will be raised first. */
void net_plan_start(struct net_plan *p, const struct net_plan_config *config);

/* Give the next vertex. False, and not taken, if frames must be taken first. */
bool net_plan_take(struct net_plan *p, const struct net_plan_vertex *v);

/* No more vertices come: the pen will be raised after the last line. */
void net_plan_end(struct net_plan *p);

/* Plan the next frame. */
enum net_plan_result net_plan_next(struct net_plan *p, struct net_plan_frame *f);

#endif
