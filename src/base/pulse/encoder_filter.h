/* encoder_filter - the digital filter before an encoder counter: it passes a level only when that
 * has lasted `filter` clocks at the pin, so that edges may be lost in fast motion. */
#ifndef ENCODER_FILTER_H
#define ENCODER_FILTER_H

#include "encoder_count.h"

/* Count the edges that the filter passes up to and including the clock `until`; _blind is for more
 * than one edge per clock, of which it passes none. `way` is the sign of the motion, +1 or -1. Both
 * return events. */
int encoder_run_filtered(struct encoder *e, int way, int64_t until);
int encoder_run_blind(struct encoder *e, int way, int64_t until);

#endif
