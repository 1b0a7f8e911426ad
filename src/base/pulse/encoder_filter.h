/* The digital filter before an encoder counter. */
#ifndef ENCODER_FILTER_H
#define ENCODER_FILTER_H

#include "encoder_count.h"

/* Work off the edges up to and including `until` behind the filter; blind with more than an edge a
 * clock. `way` is the sign of the motion; both return events. */
int encoder_run_filtered(struct encoder *e, int way, int64_t until);
int encoder_run_blind(struct encoder *e, int way, int64_t until);

#endif
