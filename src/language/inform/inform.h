/* inform - a program in the robot language: text to instructions, all faults found beforehand.
 *
 * The compiled program is not part of a state. It stays as it is while it runs (inform_run).
 */
#ifndef INFORM_H
#define INFORM_H

#include "inform_points.h"

enum {
    INFORM_CODES = 4096, /* instructions */
    INFORM_JOBS = 64,
    INFORM_LABELS = 1024,   /* of all jobs */
    INFORM_NAME_MAX = 32,   /* [characters] of a job or label */
    INFORM_BLOCKS = 16,     /* IF, LOOP, WHILE inside each other */
    INFORM_LOOPS = 8,       /* of them LOOP */
    INFORM_CALLS = 12,      /* CALL inside each other, as the maker's job stack */
    INFORM_VARIABLES = 100, /* of each kind */
    INFORM_SIGNALS = 32,    /* IN#(1) .. IN#(32), OT#(1) .. OT#(32) */
    INFORM_ANALOGS = 8,     /* AI#(1) .. AI#(8), AO#(1) .. AO#(8) */
    INFORM_LEVELS = 8       /* PL=0 .. PL=8 */
};

#define INFORM_VOLT_MAX 10.0 /* [V] of analog outputs, either sign */

/* B 0 .. 255, I 16 bit, D 32 bit, R a double; signals and channels count from 0 here. */
enum inform_operand_kind {
    INFORM_NOTHING,
    INFORM_CONSTANT,
    INFORM_B,
    INFORM_I,
    INFORM_D,
    INFORM_R,
    INFORM_IN,
    INFORM_OT,
    INFORM_AI
};

struct inform_operand {
    enum inform_operand_kind kind;
    int32_t index;
    double number; /* of CONSTANT: ON is 1, OFF 0 */
};

enum inform_relation {
    INFORM_ALWAYS,
    INFORM_EQUAL,
    INFORM_NOT_EQUAL,
    INFORM_LESS,
    INFORM_MORE,
    INFORM_AT_MOST,
    INFORM_AT_LEAST
};

enum inform_path { INFORM_JOINT, INFORM_LINE, INFORM_CIRCLE };

/* VJ [% of the joints' highest], V [mm/s of the tool], VR [deg/s of the tool]. */
enum inform_speed { INFORM_DEFAULT, INFORM_VJ, INFORM_V, INFORM_VR };

enum inform_op {
    INFORM_OP_MOVE,
    INFORM_OP_SPEED,
    INFORM_OP_LEVEL,
    INFORM_OP_TOOL,
    INFORM_OP_USER,
    INFORM_OP_DOUT,
    INFORM_OP_AOUT,
    INFORM_OP_SET,
    INFORM_OP_ADD,
    INFORM_OP_SUB,
    INFORM_OP_MUL,
    INFORM_OP_DIV,
    INFORM_OP_WAIT,
    INFORM_OP_TIMER,
    INFORM_OP_JUMP,
    INFORM_OP_UNLESS,
    INFORM_OP_CALL,
    INFORM_OP_RET,
    INFORM_OP_LOOP,
    INFORM_OP_ENDLOOP,
    INFORM_OP_PAUSE,
    INFORM_OP_NOP
};

/* One instruction. A condition decides whether it is done; of WAIT, whether it is over; of UNLESS
 * (the beginning of IF, ELSEIF, WHILE), whether it does not jump. */
struct inform_code {
    enum inform_op op;
    int32_t line;
    enum inform_relation relation;
    struct inform_operand left, right; /* of the condition; of SET .. DIV what changes, and by */
    int32_t to;  /* point; instruction; tool, user frame; level; signal, channel */
    int32_t via; /* of CIRCLE: point; of LOOP, ENDLOOP: depth */
    enum inform_path path;
    enum inform_speed tag;
    int32_t inside; /* the LOOP it stands in, -1: none */
    double speed;   /* by tag */
    int32_t level;  /* PL, INFORM_ANY: that in force */
    double corner;  /* CR [mm], 0: by level */
    int64_t time;   /* [ns] of TIMER, WAIT; -1: without end */
};

struct inform_job {
    char name[INFORM_NAME_MAX + 1];
    int32_t start; /* its first instruction */
    int32_t line;
};

struct inform_label {
    int32_t offset, length; /* [byte] its name in the text */
    int32_t job, to, line;
    int32_t inside; /* the LOOP it stands in, -1: none */
};

struct inform_program {
    int32_t count, jobs, labels;
    struct inform_code code[INFORM_CODES];
    struct inform_job job[INFORM_JOBS];
    struct inform_label label[INFORM_LABELS];
};

/* Read a program; the points are those it may go to. -1: refused, the report says why, *p is
 * undefined. */
int inform_read(struct inform_program *p, const struct inform_points *points, const char *text,
                int64_t length, struct inform_report *r);

/* What a variable of a kind can be: B, I, D; R anything finite. */
double inform_low(enum inform_operand_kind kind);
double inform_high(enum inform_operand_kind kind);

/* Number of the job of a name, or -1. */
int32_t inform_job(const struct inform_program *p, const char *name);

#endif
