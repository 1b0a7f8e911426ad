/* Pulse output: the two lines A and B of a DDA channel; formats, width, wiring. */
#ifndef PULSE_H
#define PULSE_H

#include <stdbool.h>
#include <stdint.h>

#include "dda.h"
#include "lines.h"

enum pulse_format {
    PULSE_DIRECTION, /* a pulse on A; B is the direction, high = backward */
    PULSE_CW_CCW,    /* a pulse on A forward, on B backward */
    PULSE_AB,        /* quadrature, a pulse is an edge; A leads B forward */
    PULSE_NONE,      /* both low */
};

struct pulse_config {
    enum pulse_format format;
    uint32_t wiring; /* see lines.h */
    int32_t width;   /* [clocks] a pulse is high, 1 or more; PULSE_AB does not use it */
};

enum pulse_status {
    PULSE_OK,
    PULSE_BAD_FORMAT, /* no such format */
    PULSE_BAD_WIRING, /* no such bit */
    PULSE_BAD_WIDTH,  /* not 1 .. the largest */
};

/* What is left of the DDA times before; `struct dda` has the one in progress. */
struct pulse {
    int64_t last;  /* [clock] of their latest pulse, -1 if there was none */
    int32_t high;  /* [clocks] it reaches into the DDA time that begins at `last` */
    bool backward; /* its direction */
};

/* PULSE_OK, or the first member that is out of range; `widest` is the largest width [clocks]. */
enum pulse_status pulse_check(const struct pulse_config *c, int32_t widest);

/* As after dda_reset(): no pulse yet, direction forward. */
void pulse_reset(struct pulse *p);

/* At each boundary, right before dda_begin(). With a command of zero it does nothing, and the call
 * may be left out: the direction stands. */
void pulse_boundary(const struct pulse_config *c, struct pulse *p, const struct dda *d,
                    int channel);

/* The lines at the terminals, at `clock` of the DDA time in progress: start <= clock < boundary;
 * the boundary's own clock belongs to the next DDA time, after dda_begin(). At the clock of a pulse
 * its line is high (before inversion) already. Pulses one clock apart (divider 1, a command above
 * half the ticks) are one on the line.
 *
 * High lasts `width` clocks, but at most half the distance to the channel's next pulse, rounded
 * down, and at least one clock. After the last pulse of a DDA time the next one is taken to come a
 * tick behind the boundary. The direction changes at the boundary; if the DDA time before put its
 * last pulse on that very clock, when this pulse has ended.
 *
 * While the DDA is stopped the lines stand as they were at the clock of the stop, a pulse in
 * progress stays high; then its rest follows. Only a pulse on the first clock of the DDA time that
 * is cut by a stop ends when the DDA goes on. */
struct lines pulse_at(const struct pulse_config *c, const struct pulse *p, const struct dda *d,
                      int channel, int64_t clock);

/* Clock of the channel's latest pulse up to and including `clock` >= start, whatever the format;
 * -1 if there was none since reset. A stop moves the pulses of the DDA time it interrupts: once it
 * goes on, their clocks count from the shifted start, as in dda_edge_clock(). */
int64_t pulse_latest(const struct pulse *p, const struct dda *d, int channel, int64_t clock);

#endif
