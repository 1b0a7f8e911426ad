/* robot_job_run - a program that runs: what it requests of the robot next.
 *
 * The program runs ahead of the motion, so that corners can be rounded. Moves are numbered 1, 2, ..
 * as they are requested, and the caller says how many it has reached:
 *  - a move joins the queue of the motion;
 *  - an output carries `after`, the number of the latest move requested before it, or of the one
 *    before that if it is NWAIT. It changes when that move has reached its point: at rest, or where
 *    the path passes the corner if that is rounded; at once if reached >= after. So it costs no
 *    stop;
 *  - a move that an input may end (UNTIL) keeps what follows waiting until it is over: it is
 *    reached where it ends, too;
 *  - what looks at inputs, at the arm (GETS) or at time (IF and WAIT on IN# or AI#, DIN, AIN,
 *    TIMER, PAUSE, the end)
 *    waits until all moves before it are reached: ROBOT_JOB_REACH. The caller may count a move as
 *    reached where its zone begins.
 * Call until the answer is none of MOVE, DOUT, AOUT, or the queue is full; then again next cycle.
 */
#ifndef ROBOT_JOB_RUN_H
#define ROBOT_JOB_RUN_H

#include "robot_job.h"

enum {
    ROBOT_JOB_IDLE_MAX = 1000000 /* instructions without motion, input, output or wait */
};

/* What is in force when a program starts. */
struct robot_job_start {
    int32_t job;   /* number of the job to start with */
    double vj;     /* [%] 0.01 .. 100 */
    double v;      /* [mm/s] */
    double vr;     /* [deg/s] */
    int32_t level; /* PL */
    int32_t tool, user;
    uint32_t out; /* present digital outputs; bit 0 is OT#(1) */
};

struct robot_job_call {
    int32_t pc;                    /* next instruction; of a caller: where it goes on afterwards */
    int32_t loop[ROBOT_JOB_LOOPS]; /* rounds left, -1: for ever */
    int32_t arguments;             /* number of those that it was called with */
    double argument[ROBOT_JOB_ARGUMENTS];
    int32_t whole[3][ROBOT_JOB_LOCALS]; /* LB LI LD */
    double real[ROBOT_JOB_LOCALS];      /* LR */
};

/* A position P that the program has changed. */
struct robot_job_changed {
    int32_t number;
    struct robot_job_point point;
};

/* State of a program that runs: plain bytes without pointers. */
struct robot_job_run {
    int32_t depth;  /* calls inside each other */
    int32_t frames; /* in use: depth + 1, or 0 before a program begins */
    struct robot_job_call frame[ROBOT_JOB_CALLS + 1];
    int32_t whole[3][ROBOT_JOB_VARIABLES]; /* B I D */
    double real[ROBOT_JOB_VARIABLES];      /* R */
    int64_t moves;                         /* requested so far */
    int64_t began;                         /* [ns] start of the WAIT or TIMER under way; -1: none */
    int32_t idle;                          /* instructions since the latest request or input */
    uint32_t out;                          /* digital outputs as set so far, ahead of the motion */
    double speed[4];                       /* by enum robot_job_speed; [0] is not used */
    int32_t rotary;                        /* MOVL and MOVC without a speed take VR: 0 or 1 */
    int32_t level, tool, user;
    int32_t shift, shift_user; /* point by which the moves are shifted, -1: none; its frame */
    double shift_by[3];        /* [mm] what that was */
    int32_t hand;              /* tool of the latest move or TOOL, from which IMOV goes on */
    int32_t until;             /* the latest move may be ended by an input: 1 */
    int32_t changes;           /* positions that have been changed */
    struct robot_job_changed changed[ROBOT_JOB_CHANGED];
    int32_t early;              /* the latest move is NWAIT: 1 */
    int32_t ended;              /* 1: the program is over */
    enum robot_job_fault fault; /* that stopped it */
};

/* What a program sees of the world. */
struct robot_job_inputs {
    int64_t now;                  /* [ns] from 0, never less than before */
    int64_t reached;              /* number of moves that have reached their points */
    uint32_t di;                  /* bit 0 is IN#(1) */
    double ai[ROBOT_JOB_ANALOGS]; /* [V] */
    /* Where the arm is, when it rests: in pulses, in the base. GETS alone asks for it. */
    void (*here)(const void *arm, struct robot_job_point here[2]);
    /* A position by the arm's kinematics as a pose with pose->tool, in pose->user; tool and user
     * frame of both are told. CNVRT alone asks for it. */
    void (*convert)(const void *arm, const struct robot_job_point *from,
                    struct robot_job_point *pose);
    /* What leads from a position to another as an increment in a frame, X Y Z [mm] A B C [deg].
     * MSHIFT alone asks for it. */
    void (*shift)(const void *arm, const struct robot_job_point *from,
                  const struct robot_job_point *to, int32_t frame, double by[6]);
    const void *arm;
};

enum robot_job_answer {
    ROBOT_JOB_MOVE,  /* go to a point */
    ROBOT_JOB_DOUT,  /* digital outputs from `index` become `on`, after a move */
    ROBOT_JOB_AOUT,  /* analog output `index` becomes `volt`, after a move */
    ROBOT_JOB_REACH, /* needs reached = after; ask again */
    ROBOT_JOB_WAIT,  /* WAIT, TIMER: ask again */
    ROBOT_JOB_BUSY,  /* so many instructions are done: ask again next cycle */
    ROBOT_JOB_PAUSE, /* stop until the operator goes on; then ask again */
    ROBOT_JOB_END,   /* all moves are reached, nothing follows */
    ROBOT_JOB_FAULT  /* stopped: `fault` */
};

struct robot_job_request {
    enum robot_job_answer answer;
    int32_t line;  /* of the program */
    int32_t job;   /* number of the job in which that is */
    int64_t after; /* MOVE: its own number; else the latest move before */
    /* MOVE */
    enum robot_job_path path;
    int32_t point, via;       /* numbers; via of CIRCLE only */
    int32_t beside;           /* position of the axis outside the arm; -1: that of the point */
    int32_t next, next_user;  /* of SPLINE: the point it goes on to, -1: it ends; its user frame */
    enum robot_job_speed tag; /* VJ, V or VR */
    double speed;
    double acc[2];      /* [%] of the accelerations to speed up, slow down */
    int32_t level;      /* PL; 0: stop at the point */
    double corner;      /* CR [mm]; 0: by level */
    int32_t tool, user; /* those of the point, or in force */
    int32_t shift;      /* point that says how far it is shifted, -1: not */
    int32_t shift_user; /* user frame in which that counts */
    double shift_by[3]; /* [mm] how far */
    int32_t increment;  /* the point is what is added, in this frame; ROBOT_JOB_NOT_BY */
    int32_t until;      /* input that ends it, from 0; -1: none */
    bool until_on;
    /* DOUT, AOUT */
    int32_t index; /* from 0 */
    int32_t count; /* DOUT: number of outputs from there, 1 or ROBOT_JOB_GROUP */
    int32_t on;    /* their levels as a number */
    int64_t time;  /* [ns] of a pulse, after which the output is off; 0: none */
    double volt;   /* [V] -10 .. 10 */
    /* FAULT */
    enum robot_job_fault fault;
};

void robot_job_begin(struct robot_job_run *run, const struct robot_job_program *p,
                     const struct robot_job_start *start);

/* Carry the program on to its next request, by at most `most` instructions. */
void robot_job_next(struct robot_job_run *run, const struct robot_job_program *p,
                    const struct robot_job_points *points, const struct robot_job_inputs *in,
                    int32_t most, struct robot_job_request *r);

/* A position as it is now, by the number that a request has. */
const struct robot_job_point *robot_job_place(const struct robot_job_run *run,
                                              const struct robot_job_program *p,
                                              const struct robot_job_points *points,
                                              int32_t number);

/* Number of the job that runs, and the line of its next instruction, for display. */
int32_t robot_job_running(const struct robot_job_run *run, const struct robot_job_program *p,
                          int32_t *line);

#endif
