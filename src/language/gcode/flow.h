/* flow - where a part program goes on: O words, GOTO and WHILE, M98, M99, G65.
 *
 * A place is an offset in a text, the program's or that of a file which it calls, and the number of
 * lines in front of it. What is called or jumped
 * over is looked for in the text; places that were found are remembered, as many as there is room
 * for, and looked for again otherwise.
 */
#ifndef FLOW_H
#define FLOW_H

#include "oword.h"

/* Lines that may be read again without a command that takes time; a fuzzer that runs slowly takes
 * fewer. */
#ifndef FLOW_AGAIN
#define FLOW_AGAIN 1000000
#endif

enum {
    FLOW_CALLS = 10,  /* calls within calls */
    FLOW_OPEN = 64,   /* if, while, do, repeat within one another, those of the callers too */
    FLOW_FILES = 32,  /* that are called */
    FLOW_FANUC = 'D', /* in front of the number of DO; labels of O words have no capitals */
    FLOW_KNOWN = 32,  /* places remembered: of subprograms, and of ends */
    FLOW_IDLE = FLOW_AGAIN
};

enum flow_kind { FLOW_IF, FLOW_WHILE, FLOW_DO, FLOW_REPEAT };

enum flow_caller { FLOW_SUB, FLOW_M98, FLOW_G65 };

struct flow_open {
    char label[OWORD_LABEL];
    enum flow_kind kind;
    int32_t left; /* runs of REPEAT, this one too; 1 of IF: a branch has been taken */
    struct oword_place here, behind; /* its line, the one behind it */
};

/* Values of a call for the local numbers, #1 and those behind it. */
struct flow_local {
    double value[PARAMETERS_LOCAL_FANUC];
    uint64_t set; /* bits, as parameters.given has them */
};

/* G66: a macro that is called behind each line that moves. */
struct flow_modal {
    bool on;
    int32_t level; /* of the calls in which lines make it */
    char label[OWORD_LABEL];
    int32_t runs;
    struct oword_place body;
    struct flow_local given;
};

struct flow_call {
    char label[OWORD_LABEL];
    enum flow_caller caller;
    int32_t left;  /* runs, this one too */
    int32_t opens; /* open when it was called */
    bool rest;     /* the line that calls it is still to be executed: M100 .. M199 */
    struct oword_place body, here, back; /* where it begins, is called, goes on */
    int32_t locals;                  /* #1 .. that belong to it; 0 of M98, which has its caller's */
    struct flow_local before, given; /* of the caller; to each run */
};

struct flow_known_sub {
    char label[OWORD_LABEL];
    int32_t words; /* what was looked for; 0 nothing */
    int32_t file;  /* from where */
    struct oword_place place;
};

struct flow_known_end {
    int64_t from; /* [byte] */
    int32_t file, words;
    struct oword_place place;
};

struct flow {
    struct flow_open open[FLOW_OPEN];
    struct flow_call call[FLOW_CALLS];
    int32_t opens, level;
    struct flow_modal modal;
    struct flow_known_sub sub[FLOW_KNOWN];
    struct flow_known_end end[FLOW_KNOWN];
    int32_t subs, ends;                 /* the next to be replaced */
    char file[FLOW_FILES][OWORD_LABEL]; /* that have been called */
    int32_t files;
    double value;  /* #<_value> */
    bool returned; /* #<_value_returned> */
    int32_t left;  /* the call that has just ended and restores modes; 0 none */
    bool begun;    /* words have been read: an O number no longer names the program */
    bool rest;     /* the next line has made its call already */
    int64_t again; /* lines read again: in loops, in calls, behind M99 */
    int64_t idle;  /* the same when the last command that takes time was made */
};

/* Name of a file, empty for the program. */
const char *flow_file(const struct interpreter *in, int32_t file);

/* The line of the program that is executed, of a call where it is in a file. */
int32_t flow_line_shown(const struct interpreter *in);

/* Execute a line that begins with an O word, s at its label. `here` is its place. */
enum fault flow_line(struct interpreter *in, struct reading *s, struct oword_place here);

/* Whether IF, GOTO, WHILE, DO or END stands here, in a program of Fanuc's controls. */
bool flow_fanuc_begins(struct reading s);

/* Execute such a line, s at the word. *then: what stands behind THEN is to be executed. */
enum fault flow_fanuc(struct interpreter *in, struct reading *s, struct oword_place here,
                      bool *then);

/* M98 P L, or G65 P L with values of #1 .. (NULL: the caller's); the number may hold the runs
 * above its last four digits where the program has Fanuc's forms. */
enum fault flow_subprogram(struct interpreter *in, const struct program *p, double number,
                           const double *runs, const struct flow_local *local,
                           struct fault_report *r);

/* G66 with what G65 takes; and behind a line that has moved the axes, its call. */
enum fault flow_modal_begin(struct interpreter *in, const struct program *p, double number,
                            const double *runs, const struct flow_local *local,
                            struct fault_report *r);
enum fault flow_modal_call(struct interpreter *in, const struct program *p, struct fault_report *r);

/* Whether lines of the call that runs make it. */
bool flow_modal_acts(const struct flow *f);

/* M100 .. M199 of a line that begins here: the subprogram o<m100> .. with P and Q as #1 and #2; the
 * line is read once more behind it. */
enum fault flow_user(struct interpreter *in, const struct program *p, int32_t number,
                     const double given[2], struct oword_place here, struct fault_report *r);

/* M99: back to the caller, or the program from its beginning. */
enum fault flow_return(struct interpreter *in, struct fault_report *r);

/* The text has ended: FAULT_O_END if something is still open. */
enum fault flow_end(const struct interpreter *in, const struct program *p, struct fault_report *r);

#endif
