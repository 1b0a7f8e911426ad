/* pulse - a card's pulse output: levels of the two lines A and B of a DDA channel at any clock, in
 * one of three formats, with the width of a pulse and the wiring of the lines. */
#ifndef PULSE_H
#define PULSE_H

#include <stdbool.h>
#include <stdint.h>

#include "dda.h"
#include "lines.h"

enum pulse_format {
    PULSE_DIRECTION, /* pulses on A; B is the direction, high = backward */
    PULSE_CW_CCW,    /* pulses on A forward, on B backward */
    PULSE_AB,        /* quadrature: each pulse is one edge of A or B; A leads B forward */
    PULSE_NONE,      /* both lines low */
};

struct pulse_config {
    enum pulse_format format;
    uint32_t wiring; /* bits of lines.h */
    int32_t width;   /* [clocks] that a pulse is high, 1 or more; PULSE_AB does not use it */
};

enum pulse_status {
    PULSE_OK,
    PULSE_BAD_FORMAT, /* no such format */
    PULSE_BAD_WIRING, /* no such bit */
    PULSE_BAD_WIDTH,  /* not 1 .. the largest width */
};

/* The latest pulse of the DDA times before the one in progress, which `struct dda` has. */
struct pulse {
    int64_t last;  /* [clock] of that pulse, -1 if there was none */
    int32_t high;  /* [clocks] that it is high if a DDA time begins at its clock */
    bool backward; /* its direction */
};

/* PULSE_OK, or the first member that is out of range; `widest` is the largest width [clocks]. */
enum pulse_status pulse_check(const struct pulse_config *c, int32_t widest);

/* The state that belongs to dda_reset(): no pulse yet, direction forward. */
void pulse_reset(struct pulse *p);

/* Call it at each boundary, right before dda_begin(). With a command of zero it does nothing, so
 * the call may be left out: the direction stays. */
void pulse_boundary(const struct pulse_config *c, struct pulse *p, const struct dda *d,
                    int channel);

/* The lines at the terminals, at `clock` of the DDA time in progress: start <= clock < boundary;
 * the boundary's own clock belongs to the next DDA time, after dda_begin(). At the clock of a pulse
 * its line is high (before inversion) already. Pulses one clock apart (divider 1, a command above
 * half the ticks) merge into one on the line.
 *
 * High lasts `width` clocks, but at most half the distance to the channel's next pulse, rounded
 * down, and at least one clock. The pulse after the last one of a DDA time is taken to come one
 * tick behind the boundary. The direction changes at the boundary, or when the pulse that the DDA
 * time before put on that very clock has ended.
 *
 * While the DDA is stopped the lines keep their levels: a pulse in progress stays high, and its
 * rest follows when the DDA goes on. Only a pulse on the first clock of a DDA time that is stopped
 * ends at once then. */
struct lines pulse_at(const struct pulse_config *c, const struct pulse *p, const struct dda *d,
                      int channel, int64_t clock);

/* Clock of the channel's latest pulse up to and including `clock` >= start, whatever the format;
 * -1 if there was none since reset. A stop moves the pulses of the DDA time it interrupts: once it
 * goes on, their clocks count from the shifted start, as in dda_edge_clock(). */
int64_t pulse_latest(const struct pulse *p, const struct dda *d, int channel, int64_t clock);

#endif
