/* orders - what a program wants done next, whichever language it is written in.
 *
 *     part program      --interpreter-->  \
 *                                           order: move, output, delay, stop, end
 *     robot language    --robot_job_next-->  /
 *
 * Moves are numbered 1, 2, .. as they are ordered. An output belongs behind a move: it changes once
 * that has reached its point.
 */
#ifndef ORDERS_H
#define ORDERS_H

#include "robot_job_run.h"
#include "interpreter.h"
#include "robot.h"

/* The program; all of it constant while it runs. One of the languages, or none. */
struct orders_text {
    const struct source *gcode;
    const struct robot_job_program *job;
    const struct robot_job_points *points;
};

struct orders_config {
    struct robot_job_start start;             /* of the robot language */
    double zone[ROBOT_JOB_LEVELS + 1];        /* [mm] of PL=0 .. 8; the last one of G64, too */
    double rapid;                             /* share of the joints' speeds of G0 */
    double feed, feed_most;                   /* [mm/s] of a part program until F; highest */
    double origin[INTERPRETER_SYSTEMS][AXES]; /* [mm], [deg] of G54 .. G59.3 */
    bool block_delete, optional_stop, tool_stop;
    enum robot_singular singular;
    int32_t lines; /* instructions of a call */
};

enum order_kind {
    ORDER_NONE, /* nothing now: the program waits for inputs, time or motion */
    ORDER_MOVE,
    ORDER_OUT,
    ORDER_ANALOG,
    ORDER_DELAY,
    ORDER_PAUSE,
    ORDER_END,
    ORDER_FAULT
};

struct order {
    enum order_kind kind;
    int32_t line;
    int64_t after; /* number of the move, or of the one before */
    int64_t known; /* [clock] at which the driver could have it */
    struct robot_move move;
    struct robot_target via; /* of a circle */
    struct pose tool;        /* of the move */
    bool plain;              /* the tool is that of the arm's parameters */
    uint32_t mask, value;    /* digital outputs */
    int32_t index;           /* analog output, from 0 */
    double amount;           /* [V]; [s] of a delay */
};

struct orders {
    bool on;       /* a program runs */
    bool waits;    /* for an input or a time */
    int64_t moves; /* ordered so far */
    struct interpreter gcode;
    struct command kept; /* of a part program, behind outputs of its line */
    bool keeps;
    bool passes;   /* waits of a part program are answered as in a check */
    int64_t since; /* [ns] that one waits */
    double was;    /* its input at the look before */
    struct robot_job_run job;
};

/* Begin; a part program at a pose of the tip. */
void orders_start(struct orders *o, const struct orders_config *c, const struct orders_text *t,
                  const struct pose *at);

/* What comes next; in->reached and in->now as robot_job_run has them. */
void orders_next(struct orders *o, const struct orders_config *c, const struct orders_text *t,
                 const struct robot_job_inputs *in, struct order *order);

/* A part program from its start to its end, nothing moves: all its faults and notes. */
void orders_check(const struct orders_config *c, const struct orders_text *t, const struct pose *at,
                  struct fault_list *all);

#endif
