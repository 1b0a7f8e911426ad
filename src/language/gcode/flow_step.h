/* flow_step - a line with an O word on its way, between flow and flow_fanuc. */
#ifndef FLOW_STEP_H
#define FLOW_STEP_H

#include "flow.h"

struct flow_step {
    struct interpreter *in;
    struct reading *s;
    struct oword o;
    struct oword_place here;
    int32_t at; /* the O */
};

/* Note the line as far as it has been read as the offending text; returns f. */
enum fault flow_refuse(const struct flow_step *l, enum fault f);

/* Go on elsewhere; or back, where what is read again counts. */
void flow_go(struct interpreter *in, struct oword_place to);
enum fault flow_again(struct interpreter *in, struct oword_place to, struct fault_report *r);

/* The place behind the line that has been read. */
struct oword_place flow_behind(const struct interpreter *in);

/* Begin what has an end: `left` as in struct flow_open. */
enum fault flow_open(const struct flow_step *l, enum flow_kind kind, int32_t left);

/* The end of a WHILE, the innermost that is open: back to its line. */
enum fault flow_loop_end(const struct flow_step *l);

#endif
