/* Between the files of the encoder counter; see encoder.h for what a user calls. */
#ifndef ENCODER_PARTS_H
#define ENCODER_PARTS_H

#include "encoder.h"

enum { A, B, C };   /* lines */

/* Levels of the lines in a quarter of a line period. */
bool encoder_a_high(int64_t quarter);
bool encoder_b_high(int64_t quarter);
bool encoder_index_high(const struct encoder *e, int64_t quarter);

/* Edges that count, from phase 0 to what is seen. */
int64_t encoder_counting_edges(const struct encoder *e);

/* [clock] at which the edge between quarters `upper` - 1 and `upper` was passed; of the n-th edge
 * from here, n = 1 for the next, n < 1 for those behind. `way` is +1 or -1. */
int64_t encoder_edge_clock(const struct encoder *e, int64_t upper);
int64_t encoder_nth_clock(const struct encoder *e, int way, int64_t n);

/* Edges from here to a clock, to a change of the index line, to a change of the comparator. */
int64_t encoder_edges_until(const struct encoder *e, int way, int64_t until);
int64_t encoder_edges_to_index(const struct encoder *e, int way);
int64_t encoder_edges_to_compare(const struct encoder *e, int way);

/* Look at the comparator; show a level of the index line. Both return events. */
int encoder_compare(struct encoder *e, int64_t clock);
int encoder_show_index(struct encoder *e, bool level, int64_t clock);

/* encoder_run() behind the filter; blind with more than an edge a clock. */
int encoder_run_filtered(struct encoder *e, int way, int64_t until);
int encoder_run_blind(struct encoder *e, int way, int64_t until);

#endif
