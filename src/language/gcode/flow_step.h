/* flow_step - what flow and flow_fanuc share: a line that controls the flow (an O word, or IF,
 * GOTO, WHILE, DO, END of Fanuc's controls) while it is executed. */
#ifndef FLOW_STEP_H
#define FLOW_STEP_H

#include "flow.h"

struct flow_step {
    struct interpreter *in;
    struct reading *s;
    struct oword o;
    struct oword_place here;
    int32_t at; /* [characters] where its O, IF .. begins in the line */
};

/* The offending text is the line from `at` to where it has been read; returns f. */
enum fault flow_refuse(const struct flow_step *l, enum fault f);

/* Go on reading at a place; flow_again: at one that has been read before, or in a call, and count
 * the lines that are read again. FAULT_ENDLESS: over FLOW_IDLE without anything that takes time. */
void flow_go(struct interpreter *in, struct oword_place to);
enum fault flow_again(struct interpreter *in, struct oword_place to, struct fault_report *r);

/* The place behind the line that has been read. */
struct oword_place flow_behind(const struct interpreter *in);

/* Open a condition or a loop with the label of l; `left` as in struct flow_open. FAULT_O_OPEN: the
 * label is open already; FAULT_O_DEEP. */
enum fault flow_open(const struct flow_step *l, enum flow_kind kind, int32_t left);

/* The end of a WHILE: back to its line. FAULT_O_PLACE: what is open innermost is something else. */
enum fault flow_loop_end(const struct flow_step *l);

#endif
