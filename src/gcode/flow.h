/* flow - where a part program goes on: O words, M98, M99, G65.
 *
 * A place is an offset in the text and the number of lines in front of it. What is called or jumped
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
    FLOW_CALLS = 10,        /* calls within calls */
    FLOW_OPEN = 64,         /* if, while, do, repeat within one another, those of the callers too */
    FLOW_KNOWN = 32,        /* places remembered: of subprograms, and of ends */
    FLOW_IDLE = FLOW_AGAIN
};

enum flow_kind { FLOW_IF, FLOW_WHILE, FLOW_DO, FLOW_REPEAT };

enum flow_caller { FLOW_SUB, FLOW_M98, FLOW_G65 };

struct flow_open {
    char    label[OWORD_LABEL];
    enum flow_kind kind;
    int32_t left;           /* runs of REPEAT, this one too; 1 of IF: a branch has been taken */
    struct oword_place here, behind;    /* its line, the one behind it */
};

struct flow_call {
    char    label[OWORD_LABEL];
    enum flow_caller caller;
    int32_t left;           /* runs, this one too */
    int32_t opens;          /* open when it was called */
    struct oword_place body, here, back;    /* where it begins, is called, goes on */
    double  local[PARAMETERS_LOCAL];    /* of the caller */
    double  given[PARAMETERS_LOCAL];    /* to each run */
};

struct flow_known_sub {
    char    label[OWORD_LABEL];
    int32_t words;          /* what was looked for; 0 nothing */
    struct oword_place place;
};

struct flow_known_end {
    int64_t from;           /* [byte] */
    int32_t words;
    struct oword_place place;
};

struct flow {
    struct flow_open open[FLOW_OPEN];
    struct flow_call call[FLOW_CALLS];
    int32_t opens, level;
    struct flow_known_sub sub[FLOW_KNOWN];
    struct flow_known_end end[FLOW_KNOWN];
    int32_t subs, ends;     /* the next to be replaced */
    double  value;          /* #<_value> */
    bool    returned;       /* #<_value_returned> */
    bool    begun;          /* words have been read: an O number no longer names the program */
    int64_t again;          /* lines read again: in loops, in calls, behind M99 */
    int64_t idle;           /* the same when the last command that takes time was made */
};

/* Execute a line that begins with an O word, s at its label. `here` is its place. */
enum fault flow_line(struct interpreter *in, struct reading *s, struct oword_place here);

/* M98 P L, or G65 P L with values of #1 to #30 (NULL: the caller's); the number may hold the runs
 * above its last four digits where the program has Fanuc's forms. */
enum fault flow_subprogram(struct interpreter *in, const struct program *p, double number,
                           const double *runs, const double *local, struct fault_report *r);

/* M99: back to the caller, or the program from its beginning. */
enum fault flow_return(struct interpreter *in, struct fault_report *r);

/* The text has ended: FAULT_O_END if something is still open. */
enum fault flow_end(const struct interpreter *in, const struct program *p,
                    struct fault_report *r);

/* Whether a state is none that it can have. */
bool flow_damaged(const struct flow *f);

#endif
