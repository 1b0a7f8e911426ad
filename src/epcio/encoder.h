/* Encoder counter: sampled line phase in, counts and index pulses out. */
#ifndef ENCODER_H
#define ENCODER_H

#include <stdbool.h>
#include <stdint.h>

/* Largest |phase|: four times it is still a whole number exactly in a double [line periods]. */
#define ENCODER_PHASE_MAX 1125899906842624.0 /* 2^50 */

struct encoder_config {
    int32_t rate;           /* 0, 1, 2 or 4 counts per line period; 0 switches the input off */
    bool    inverse;        /* count backwards */
    int32_t index_lines;    /* [line periods] between two index pulses, >= 1 */
};

struct encoder {
    bool    primed;         /* there was a first sample */
    double  phase;          /* [line periods] at the latest sample */
    int64_t clock;          /* [clock] of the latest sample */
    int64_t quarter;        /* quadrature edges: floor(4 phase) */
    int64_t origin;         /* floor(rate phase) where the counter is zero */
    int64_t count;          /* [counts]; the register shows the low 32 bits */
    int32_t index_seen;     /* index pulses so far */
    int64_t index_clock;    /* [clock] of the latest, interpolated */
    int64_t index_count;    /* [counts] the counter's value at that edge */
};

enum encoder_event { ENCODER_BAD_PHASE = -1, ENCODER_NONE = 0, ENCODER_INDEX = 1 };

/* Take the phase at `clock`. The first sample sets the counter to zero. Says whether an index pulse
 * came since the sample before; a phase that is no number or too large changes nothing. */
enum encoder_event encoder_sample(const struct encoder_config *c, struct encoder *e, double phase,
                                  int64_t clock);

/* Set the counter to zero where it stands. */
void encoder_clear(const struct encoder_config *c, struct encoder *e);

/* The phase moves on a straight line from `from` at clock 0 to `to` at clock `span`: first clock,
 * in 1 .. span, at which it has passed `edge`: >= edge on the way up, < edge on the way down. The
 * edge must lie between them. All phases in line periods. */
int64_t encoder_edge(double from, double to, int64_t span, double edge);

#endif
