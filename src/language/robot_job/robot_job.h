/* robot_job - a robot's jobs in the words of INFORM: their text becomes instructions, and every
 * fault is found before anything runs.
 *
 * The compiled program stays as it is while it runs (robot_job_run), so it is no part of a state.
 */
#ifndef ROBOT_JOB_H
#define ROBOT_JOB_H

#include "robot_job_points.h"

enum {
    ROBOT_JOB_INSTRUCTIONS = 16384, /* instructions */
    ROBOT_JOB_JOBS = 64,
    ROBOT_JOB_CALLEES = 256,     /* names of jobs that are called */
    ROBOT_JOB_POSITIONS = 16384, /* in the jobs themselves */
    ROBOT_JOB_TERMS = 4096,      /* further comparisons of conditions, arguments of calls */
    ROBOT_JOB_LABELS = 1024,     /* of all jobs */
    ROBOT_JOB_NAME_MAX = 32,     /* [characters] of a job or label */
    ROBOT_JOB_BLOCKS = 16,       /* IF, LOOP, WHILE, FOR, SWITCH inside each other */
    ROBOT_JOB_LOOPS = 8,         /* of them LOOP */
    ROBOT_JOB_CALLS = 12,        /* CALL inside each other, as the maker's job stack */
    ROBOT_JOB_VARIABLES = 100,   /* of each kind */
    ROBOT_JOB_LOCALS = 10,       /* of each kind, in each call */
    ROBOT_JOB_ARGUMENTS = 8,     /* of a call */
    ROBOT_JOB_SIGNALS = 32,      /* IN#(1) .. IN#(32), OT#(1) .. OT#(32) */
    ROBOT_JOB_GROUP = 8,         /* signals of IG#(n), OG#(n) */
    ROBOT_JOB_CHANGED = 128,     /* positions that a program may change while it runs */
    ROBOT_JOB_ANALOGS = 8,       /* AI#(1) .. AI#(8), AO#(1) .. AO#(8) */
    ROBOT_JOB_LEVELS = 8         /* PL=0 .. PL=8 */
};

#define ROBOT_JOB_VOLT_MAX 10.0 /* [V] of analog outputs, either sign */

/* Kind of an operand: a constant, a variable (B 0 .. 255, I 16 bit, D 32 bit, R a double; LB LI LD
 * LR those of a call), a signal, eight of them as a number, or an analog channel. Signals and
 * channels count from 0 here. */
enum robot_job_operand_kind {
    ROBOT_JOB_NOTHING,
    ROBOT_JOB_CONSTANT,
    ROBOT_JOB_B,
    ROBOT_JOB_I,
    ROBOT_JOB_D,
    ROBOT_JOB_R,
    ROBOT_JOB_IN,
    ROBOT_JOB_OT,
    ROBOT_JOB_AI,
    ROBOT_JOB_IG,
    ROBOT_JOB_OG,
    ROBOT_JOB_LB,
    ROBOT_JOB_LI,
    ROBOT_JOB_LD,
    ROBOT_JOB_LR
};

/* The variable of whole numbers that says which element is meant, as in B[I000]; NOTHING: the
 * number that stands there. */
struct robot_job_by {
    enum robot_job_operand_kind kind;
    int32_t index;
};

struct robot_job_operand {
    enum robot_job_operand_kind kind;
    int32_t index;
    struct robot_job_by by;
    double number; /* value of a CONSTANT: ON is 1, OFF 0 */
};

enum robot_job_relation {
    ROBOT_JOB_ALWAYS,
    ROBOT_JOB_EQUAL,
    ROBOT_JOB_NOT_EQUAL,
    ROBOT_JOB_LESS,
    ROBOT_JOB_MORE,
    ROBOT_JOB_AT_MOST,
    ROBOT_JOB_AT_LEAST
};

/* One comparison. */
struct robot_job_term {
    enum robot_job_relation relation;
    struct robot_job_operand left, right;
};

enum robot_job_path { ROBOT_JOB_JOINT, ROBOT_JOB_LINE, ROBOT_JOB_CIRCLE, ROBOT_JOB_SPLINE };

/* What the speed of a move counts: VJ [% of the joints' highest speeds], V [mm/s] or VR [deg/s] of
 * the tool; DEFAULT: the speed in force. */
enum robot_job_speed { ROBOT_JOB_DEFAULT, ROBOT_JOB_VJ, ROBOT_JOB_V, ROBOT_JOB_VR };

enum robot_job_op {
    ROBOT_JOB_OP_MOVE,
    ROBOT_JOB_OP_SPEED,
    ROBOT_JOB_OP_LEVEL,
    ROBOT_JOB_OP_TOOL,
    ROBOT_JOB_OP_USER,
    ROBOT_JOB_OP_DOUT,
    ROBOT_JOB_OP_AOUT,
    ROBOT_JOB_OP_GROUP,
    ROBOT_JOB_OP_PULSE,
    ROBOT_JOB_OP_SHIFT,
    ROBOT_JOB_OP_GETARG,
    ROBOT_JOB_OP_PLACE_SET,
    ROBOT_JOB_OP_PLACE_ADD,
    ROBOT_JOB_OP_PLACE_SUB,
    ROBOT_JOB_OP_SETE,
    ROBOT_JOB_OP_GETE,
    ROBOT_JOB_OP_GETS,
    ROBOT_JOB_OP_CNVRT,
    ROBOT_JOB_OP_MSHIFT,
    ROBOT_JOB_OP_SET,
    ROBOT_JOB_OP_ADD,
    ROBOT_JOB_OP_SUB,
    ROBOT_JOB_OP_MUL,
    ROBOT_JOB_OP_DIV,
    ROBOT_JOB_OP_WAIT,
    ROBOT_JOB_OP_TIMER,
    ROBOT_JOB_OP_REACHED,
    ROBOT_JOB_OP_JUMP,
    ROBOT_JOB_OP_UNLESS,
    ROBOT_JOB_OP_CALL,
    ROBOT_JOB_OP_RET,
    ROBOT_JOB_OP_LOOP,
    ROBOT_JOB_OP_ENDLOOP,
    ROBOT_JOB_OP_PAUSE,
    ROBOT_JOB_OP_NOP
};

/* The frame in which a move goes on by a position from where the move before ends, as IMOV does: a
 * user frame, 0 the base, or one of these. */
enum { ROBOT_JOB_NOT_BY = -2, ROBOT_JOB_BY_TOOL = -1 };

/* One instruction. Its condition decides whether it is done; for WAIT, whether the wait is over;
 * for UNLESS (the beginning of IF, ELSEIF, WHILE, FOR, CASE), whether it does not jump. */
struct robot_job_instruction {
    enum robot_job_op op;
    int32_t line;
    enum robot_job_relation relation;
    struct robot_job_operand left, right; /* compared; in SET .. DIV what changes, and by what; of a
                                           * move right: its speed, if a variable says it */
    int32_t more, terms;                  /* further comparisons: place and number */
    bool any;                             /* one of them is enough */
    int32_t argument, arguments;          /* of CALL: place and number; of GETARG: number from 0 */
    bool early;  /* NWAIT: what follows a move need not wait until it is reached */
    int32_t to;  /* point; instruction; tool, user frame; level; signal, channel; -1: no shift */
    int32_t via; /* of CIRCLE: point; of LOOP, ENDLOOP: depth; of a shift: user frame; of SET, ADD,
                  * SUB, GETE, CNVRT, MSHIFT of positions: the other position */
    int32_t end; /* of MSHIFT: the position to which the shift leads, from that of `via` */
    struct robot_job_by to_by, via_by, end_by; /* of positions */
    int32_t increment; /* of a move: its frame, or ROBOT_JOB_NOT_BY; of CNVRT, MSHIFT: the frame */
    int32_t beside;    /* of a move: position of the axis outside the arm; -1: none */
    int32_t until;     /* input that ends a move, from 0; -1: none */
    bool until_on;     /* by coming on, not by going off */
    enum robot_job_path path;
    bool goes_on; /* of a SPLINE: the next instruction is the one it goes on with */
    enum robot_job_speed tag;
    int32_t inside; /* the LOOP it stands in, -1: none */
    double speed;   /* in the unit of the tag */
    struct robot_job_operand
        acc[2];    /* [%] of the accelerations to speed up, slow down; none: all */
    int32_t level; /* PL; ROBOT_JOB_ANY: the level in force; of SETE, GETE: element from 0; of
                     * GETS: 0 pulses, 1 a pose; of CNVRT: tool, ROBOT_JOB_ANY: the position's */
    double corner; /* CR [mm]; 0: the level decides */
    int64_t time;  /* [ns] length of a TIMER or WAIT; -1: without end */
};

struct robot_job {
    char name[ROBOT_JOB_NAME_MAX + 1];
    int32_t start; /* its first instruction */
    int32_t text;  /* number of the text it is in, from 0 */
    int32_t line;
};

/* A job that is called or gone on in, and where that is said first. */
struct robot_job_callee {
    char name[ROBOT_JOB_NAME_MAX + 1];
    int32_t text, line, column, offset, length;
};

/* A position that stands in a job: C00000 is the job's own, P00000 that of all jobs. Those of axes
 * outside the arm, BC00000, EC00000 and BP00000, EX00000, have one place, in point.external. */
struct robot_job_position {
    enum robot_job_outside outside;
    bool more;   /* there are further axes outside, which are not at 0 */
    int32_t job; /* -1: of all */
    int32_t number;
    struct robot_job_point point;
};

/* Where something is said first; line 0: nowhere. */
struct robot_job_mention {
    int32_t text, line, column, offset, length;
};

struct robot_job_label {
    int32_t offset, length; /* [byte] place of its name in the text */
    int32_t job, to, line;
    int32_t inside; /* the LOOP it stands in, -1: none */
};

struct robot_job_program {
    int32_t count, jobs, labels, callees, positions, terms, texts;
    struct robot_job_instruction instruction[ROBOT_JOB_INSTRUCTIONS];
    struct robot_job job[ROBOT_JOB_JOBS];
    struct robot_job_label label[ROBOT_JOB_LABELS];
    struct robot_job_callee callee[ROBOT_JOB_CALLEES];
    struct robot_job_position position[ROBOT_JOB_POSITIONS];
    struct robot_job_term term[ROBOT_JOB_TERMS];       /* of an argument: left */
    struct robot_job_mention wanted[ROBOT_JOB_POINTS]; /* positions that no file has so far */
    bool changed[ROBOT_JOB_POINTS];                    /* positions that the program sets */
    bool changes_any;                                  /* one of them is P[..] of a variable */
};

/* Read a program that may go to these points. -1: it is refused, the report says why, and *p is
 * undefined. */
int robot_job_read(struct robot_job_program *p, const struct robot_job_points *points,
                   const char *text, int64_t length, struct robot_job_report *r);

/* The same from several texts, as folders of pendants have one for each job: begin, read text after
 * text, the program's first, until no name is called that has no job yet; end. */
void robot_job_begin_reading(struct robot_job_program *p);
int robot_job_read_text(struct robot_job_program *p, const struct robot_job_points *points,
                        const char *text, int64_t length, struct robot_job_report *r);
bool robot_job_wanted(const struct robot_job_program *p, int32_t callee);
int robot_job_end_reading(struct robot_job_program *p, struct robot_job_report *r);

/* A point by the number that instructions have: of the points file, or a position of a job. */
const struct robot_job_point *robot_job_point(const struct robot_job_program *p,
                                              const struct robot_job_points *points,
                                              int32_t number);

/* Least and greatest speed of a tag, and what one of a variable counts, in its unit. */
double robot_job_speed_low(enum robot_job_speed tag);
double robot_job_speed_high(enum robot_job_speed tag);
double robot_job_speed_unit(enum robot_job_speed tag);

/* Least and greatest share of ACC and DEC, as in the maker's language. [%] */
#define ROBOT_JOB_ACC_MIN 20.0
#define ROBOT_JOB_ACC_MAX 100.0

/* Least and greatest value of a variable of a kind: B, I, D; R takes anything finite. */
double robot_job_low(enum robot_job_operand_kind kind);
double robot_job_high(enum robot_job_operand_kind kind);

/* Number of the job that has this name; -1: none has. */
int32_t robot_job_find(const struct robot_job_program *p, const char *name);

#endif
