/* soft_dda - frames put out by the PC itself, for axes that have no pulse generator.
 *
 * The DDA of the card in software: one frame each DDA time, spread evenly over it, in the same
 * whole pulses. It runs on the PC's clock, from clock 0 on, and its pulses exist as numbers only.
 */
#ifndef SOFT_DDA_H
#define SOFT_DDA_H

#include "machine.h"

struct soft_dda {
    int64_t begin;          /* [clock] of the DDA time in progress */
    int32_t length;         /* [bit] of it */
    int32_t divider;
    int32_t frame[AXES];    /* [pulses] being put out */
    int32_t sum[AXES];      /* [pulses] of the frames before; wraps */
};

/* A DDA time without pulses begins at clock 0. */
void soft_dda_start(struct soft_dda *d, const struct machine *m);

/* Clock at which the DDA time in progress ends. */
int64_t soft_dda_boundary(const struct soft_dda *d);

/* There the next one begins, as long as the machine has it, with a frame; NULL: without pulses. */
void soft_dda_next(struct soft_dda *d, const struct machine *m, const int32_t frame[AXES]);

/* Pulses put out up to a clock of the DDA time in progress, its end included. [pulses] */
void soft_dda_pulses(const struct soft_dda *d, int64_t clock, int32_t pulses[AXES]);

#endif
