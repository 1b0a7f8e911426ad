/* encoder - a card's encoder counter: it decodes the lines A, B and index C, filters and counts.
 *
 * The caller gives samples of the encoder's phase [line periods]; between two samples the phase
 * moves on a straight line. The counter finds the clock of every edge from it and returns index
 * pulses and compare events with their clocks. Use: encoder_check, encoder_reset, then
 * encoder_sample and encoder_run in turn. */
#ifndef ENCODER_H
#define ENCODER_H

#include "encoder_count.h"

/* ENCODER_OK, or the first member that is out of range. */
enum encoder_status encoder_check(const struct encoder_config *c);

/* What a status but 0 says, in a sentence without a full stop. */
const char *encoder_status_text(enum encoder_status status);

/* Set the counter to zero; the next sample is the first. The configuration must have been
 * checked. */
void encoder_reset(struct encoder *e, const struct encoder_config *c);

/* Take another configuration, which must have been checked. The counter keeps its value; the levels
 * that the lines have now count as seen by the filter. */
void encoder_configure(struct encoder *e, const struct encoder_config *c);

/* Tell the phase [line periods] at `clock`, to which it moved on a straight line from the sample
 * before. The first sample only sets the lines. False, and nothing changed, if the phase is not a
 * number or larger than QUADRATURE_PHASE_MAX. */
bool encoder_sample(struct encoder *e, double phase, int64_t clock);

/* The same while the encoder's plug is out: no line moves, the counter keeps its value. Plugged in
 * again, it counts on from there; what the shaft has moved meanwhile is lost. */
bool encoder_unplugged(struct encoder *e, double phase, int64_t clock);

/* Count the edges up to and including the clock `until`, at most that of the latest sample; that
 * clock must have been reached before the next sample. Returns events (encoder_count.h). */
static inline int encoder_run(struct encoder *e, int64_t until);

/* What encoder_run does where edges may be left, or a filter sees them late. */
int encoder_run_on(struct encoder *e, int64_t until);

static inline int encoder_run(struct encoder *e, int64_t until)
{
    return e->config.filter == 0 && e->pins.quarter == e->pins.end ? 0 : encoder_run_on(e, until);
}

/* Set the counter to zero and clear `too_fast`. Returns ENCODER_COMPARE if the count 0 reaches the
 * compare value. */
int encoder_clear(struct encoder *e, int64_t clock);

/* Switch the comparator on or off and set its value [counts]. ENCODER_COMPARE comes when the
 * condition count >= value becomes true, by counting or by this write. Returns events. */
int encoder_set_compare(struct encoder *e, bool on, int32_t value, int64_t clock);

#endif
