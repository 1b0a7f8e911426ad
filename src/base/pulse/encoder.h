/* Encoder counter: sampled line phase in; counts, index pulses and compare events out. */
#ifndef ENCODER_H
#define ENCODER_H

#include "encoder_count.h"

enum encoder_status encoder_check(const struct encoder_config *c);

/* What a status but 0 says, in a sentence without a full stop. */
const char *encoder_status_text(enum encoder_status status);

/* Counter at zero; the next sample is the first. The configuration must have been checked. */
void encoder_reset(struct encoder *e, const struct encoder_config *c);

/* Another configuration, checked; the counter keeps its value, the lines as they stand are seen. */
void encoder_configure(struct encoder *e, const struct encoder_config *c);

/* The phase at `clock` is known; it moved there on a straight line from the sample before. The
 * first sample only sets the lines. False, and nothing changed, if it is no number or too large. */
bool encoder_sample(struct encoder *e, double phase, int64_t clock);

/* Work off what happened up to and including `until`, at most the clock of the latest sample; to
 * that clock before the next sample comes. Returns events. */
int encoder_run(struct encoder *e, int64_t until);

/* Set the counter to zero where it stands, and take back `too_fast`. Returns events: a compare
 * value of zero or less may be reached by it. */
int encoder_clear(struct encoder *e, int64_t clock);

/* Switch the comparator and set its value [counts]; the event comes when the condition
 * count >= value becomes true, by counting or by this write. Returns events. */
int encoder_set_compare(struct encoder *e, bool on, int32_t value, int64_t clock);

#endif
