/* flow - where a part program goes on: O words, GOTO and WHILE, M98, M99, G65.
 *
 * A place is the offset of a line in its text (the program, or a file that it calls) and the number
 * of lines in front of it. Subprograms and the ends of loops and conditions are searched in the
 * text. The latest FLOW_KNOWN of each are remembered; any other one is searched again.
 */
#ifndef FLOW_H
#define FLOW_H

#include "oword.h"

/* Lines that may be read again without a command that takes time. A slow fuzzer sets it lower. */
#ifndef FLOW_AGAIN
#define FLOW_AGAIN 1000000
#endif

enum {
    FLOW_CALLS = 10,  /* depth of calls */
    FLOW_OPEN = 64,   /* depth of if, while, do, repeat; those of the callers count */
    FLOW_FILES = 32,  /* files that a program may call */
    FLOW_FANUC = 'D', /* begins the label of DO 1 .. DO 3; those of O words have no capitals */
    FLOW_KNOWN = 32,  /* remembered places of subprograms, and as many of ends */
    FLOW_IDLE = FLOW_AGAIN
};

enum flow_kind { FLOW_IF, FLOW_WHILE, FLOW_DO, FLOW_REPEAT };

/* What made a call: `call` or M100 to M199; M98; G65 or G66. */
enum flow_caller { FLOW_SUB, FLOW_M98, FLOW_G65 };

/* A condition or a loop whose end has not been reached. */
struct flow_open {
    char label[OWORD_LABEL];
    enum flow_kind kind;
    int32_t left; /* REPEAT: runs left, this one included; IF: 1 once a branch was taken */
    struct oword_place here, behind; /* its line, and the line behind it */
};

/* Values of the local parameters #1, #2 .. of a call. */
struct flow_local {
    double value[PARAMETERS_LOCAL_FANUC];
    uint64_t set; /* bit i - 1: #i has been set */
};

/* G66: a macro that is called behind each line that moves the axes. */
struct flow_modal {
    bool on;
    int32_t level; /* depth of calls in which G66 stands, whose lines make the call */
    char label[OWORD_LABEL];
    int32_t runs;            /* of each call (L) */
    struct oword_place body; /* first line of the macro */
    struct flow_local given; /* its local parameters at the start of a run */
};

/* A subprogram that runs. */
struct flow_call {
    char label[OWORD_LABEL];
    enum flow_caller caller;
    int32_t left;  /* runs left, this one included */
    int32_t opens; /* conditions and loops that were open when it was called */
    bool rest;     /* M100 .. M199: the other words of the calling line are still to be executed */
    struct oword_place body, here, back; /* its first line, the call, where reading goes on */
    int32_t locals; /* number of local parameters of its own; M98: 0, it has its caller's */
    struct flow_local before, given; /* local parameters of the caller; of each run */
};

/* Place of a subprogram that has been found. */
struct flow_known_sub {
    char label[OWORD_LABEL];
    int32_t words; /* bits of oword_is that were searched; 0: the entry is free */
    int32_t file;  /* that has the call */
    struct oword_place place;
};

/* Place of the end of a loop, a condition or a subprogram that has been found. */
struct flow_known_end {
    int64_t from;        /* [byte] where the search began */
    int32_t file, words; /* of the search; bits of oword_is, negative: behind the end */
    struct oword_place place;
};

/* Where reading goes on: what is open, the calls that run, places that have been found. */
struct flow {
    struct flow_open open[FLOW_OPEN];
    struct flow_call call[FLOW_CALLS];
    int32_t opens, level; /* number of entries of open, of call */
    struct flow_modal modal;
    struct flow_known_sub sub[FLOW_KNOWN];
    struct flow_known_end end[FLOW_KNOWN];
    int32_t subs, ends; /* index of the entry of sub, of end that is replaced next */
    char file[FLOW_FILES][OWORD_LABEL]; /* names of the files called so far */
    int32_t files;
    double value;  /* #<_value>: what the latest return or endsub gave back */
    bool returned; /* #<_value_returned>: whether it gave anything */
    int32_t left;  /* depth of the call that has just ended and restores modes (M73); 0: none */
    bool begun;    /* words have been read, so that an O number no longer names the program */
    bool rest;     /* the next line is read again: its M100 .. M199 has made its call */
    int64_t again; /* number of lines read again: in loops, in calls, behind M99 */
    int64_t idle;  /* value of `again` at the latest command or wait that takes time */
};

/* Name of a file by its number; empty for the program, 0. */
const char *flow_file(const struct interpreter *in, int32_t file);

/* Line of the program that is executed, from 1; within a called file that of the call. */
int32_t flow_line_shown(const struct interpreter *in);

/* Execute a line that begins with an O word, where s is. `here` is the place of the line. */
enum fault flow_line(struct interpreter *in, struct reading *s, struct oword_place here);

/* Whether IF, GOTO, WHILE, DO or END stands here, in a program of Fanuc's controls. */
bool flow_fanuc_begins(struct reading s);

/* Execute such a line, s at the word. *then: its condition holds, so what stands behind THEN is to
 * be executed. */
enum fault flow_fanuc(struct interpreter *in, struct reading *s, struct oword_place here,
                      bool *then);

/* M98 or G65: call the numbered program P, *runs times (L; NULL: once). `local` has the local
 * parameters of G65; NULL: M98, which keeps its caller's. With p->fanuc and without L, the digits
 * of P above the last four are the runs. FAULT_VALUE, FAULT_NO_SUB, FAULT_CALLS, FAULT_ENDLESS. */
enum fault flow_subprogram(struct interpreter *in, const struct program *p, double number,
                           const double *runs, const struct flow_local *local,
                           struct fault_report *r);

/* G66, with the arguments of flow_subprogram (FAULT_MODAL: one is in force); and the call that it
 * makes behind a line that has moved the axes. */
enum fault flow_modal_begin(struct interpreter *in, const struct program *p, double number,
                            const double *runs, const struct flow_local *local,
                            struct fault_report *r);
enum fault flow_modal_call(struct interpreter *in, const struct program *p, struct fault_report *r);

/* Whether G66 is in force for lines of the subprogram that runs. */
bool flow_modal_acts(const struct flow *f);

/* M100 .. M199: call the subprogram o<m100> .. with `given`, P and Q, as #1 and #2. Then the line,
 * whose place is `here`, is read again for its other words. FAULT_USER: no such subprogram. */
enum fault flow_user(struct interpreter *in, const struct program *p, int32_t number,
                     const double given[2], struct oword_place here, struct fault_report *r);

/* M99: back to the caller; in the main program, back to its beginning. FAULT_M99: the subprogram
 * ends with endsub; FAULT_ALONE: a line by hand has no beginning; FAULT_ENDLESS. */
enum fault flow_return(struct interpreter *in, const struct program *p, struct fault_report *r);

/* Reading goes on with another text: no call, loop or condition is open, and the local parameters
 * are those of the program. */
void flow_drop(struct interpreter *in);

/* The text has ended. FAULT_O_END, in the line that began it: a condition, loop or call is open. */
enum fault flow_end(const struct interpreter *in, const struct program *p, struct fault_report *r);

#endif
