/* orders - what a program wants done next, in whichever language it is written.
 *
 *     part program      --interpreter-->  \
 *                                           order: move, output, delay, stop, end
 *     robot language    --robot_job_next-->  /
 *
 * Moves are numbered 1, 2, .. as they are ordered. An output belongs behind a move: it changes once
 * that move has reached its point.
 */
#ifndef ORDERS_H
#define ORDERS_H

#include "robot_job_run.h"
#include "interpreter.h"
#include "robot.h"

/* The text of a program, constant while it runs: a part program, a job with its points, or
 * neither. */
struct orders_text {
    const struct source *gcode;
    const struct robot_job_program *job;
    const struct robot_job_points *points;
};

struct orders_config {
    struct robot_job_start start;             /* with which a job starts */
    double zone[ROBOT_JOB_LEVELS + 1];        /* [mm] zone of PL=0 .. 8; G64 has the last */
    double rapid;                             /* 0..1 share of the joints' speeds in G0 */
    double feed, feed_most;                   /* [mm/s] of a part program until its F; highest */
    double origin[INTERPRETER_SYSTEMS][AXES]; /* [mm], [deg] of G54 .. G59.3 */
    bool block_delete, optional_stop, tool_stop;
    enum robot_singular singular;
    double pulses[OPW_JOINTS]; /* [pulses/rad] of the joints, signed as they are */
    bool slides[OPW_JOINTS];   /* joints that are told in mm, not in degrees */
    struct external external;  /* beside the arm */
    int32_t lines;             /* most instructions of a job that one call carries out */
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
    int64_t after; /* number of the move; of another order: of the move before it */
    int64_t known; /* [clock] at which the driver could have it */
    struct robot_move move;
    struct robot_target via; /* where a circle passes, or a spline goes on to */
    struct pose tool;        /* with which the move is made */
    double shift[3];         /* [mm] by which target and via are shifted in the base */
    bool goes_on;            /* the target is to be found: `step` from where the move before ends */
    bool in_tool;            /* that counts in the tool's frame, not in `frame` */
    struct pose step, frame; /* frame: in the base */
    int32_t until;           /* input that ends the move, 1 or more; 0: none */
    bool until_on;
    int32_t wrist;        /* ROBOT_JOB_WRIST_NEAR, _FAR: it decides the branch of the wrist */
    int32_t job;          /* number of the job it is from */
    bool plain;           /* that tool is the one of the arm's parameters */
    uint32_t mask, value; /* digital outputs of the mask become those of the value */
    double pulse;         /* [s] after which outputs that come on go off; 0: they stay */
    int32_t index;        /* analog output, from 0 */
    double amount;        /* [V] of an analog output, [s] of a delay */
};

struct orders {
    bool on;       /* a program runs */
    bool waits;    /* it waits for an input or a time */
    int64_t moves; /* number of moves ordered so far */
    struct interpreter gcode;
    struct command kept; /* motion of a line whose outputs are ordered before it */
    bool keeps;          /* `kept` holds one */
    bool passes;         /* a check: waits of the part program are over at once */
    int64_t since;       /* [ns] begin of the part program's wait */
    double was;          /* its input at the look before */
    struct robot_job_run job;
};

/* Begin a program; a part program begins at a pose of the tip. */
void orders_start(struct orders *o, const struct orders_config *c, const struct orders_text *t,
                  const struct pose *at);

/* The program's next order. in->reached and in->now are those of robot_job_run. */
void orders_next(struct orders *o, const struct orders_config *c, const struct orders_text *t,
                 const struct robot_job_inputs *in, struct order *order);

/* Read a part program from its start to its end, while nothing moves, for all its faults and
 * notes. */
void orders_check(const struct orders_config *c, const struct orders_text *t, const struct pose *at,
                  struct fault_list *all);

#endif
