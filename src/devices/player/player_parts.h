/* player_parts - what player.c, player_ramp.c and player_view.c share. */
#ifndef PLAYER_PARTS_H
#define PLAYER_PARTS_H

#include "player.h"

/* Of the period in progress [1/PLAYER_FULL_RATE ticks]: all of it, and so much up to a clock. */
int64_t player_period_phase(const struct player *p);
int64_t player_phase(const struct player *p, int64_t clock);

/* Pulses that an axis has put out in the frame in progress up to a phase, signed. */
int64_t player_pulses(const struct player *p, int axis, int64_t phase);

/* Clock of the j-th pulse of the frame, j > 0, which comes behind base. */
int64_t player_pulse_clock(const struct player *p, int axis, int64_t j);

/* Clock of an axis' latest pulse up to a clock; -1 none yet. */
int64_t player_latest(const struct player *p, int axis, int64_t clock);

/* The phase counts from this clock on: before its rate changes, or at its end. */
void player_rebase(struct player *p, int64_t clock);

/* Bits of player_tells, at the player's clock. */
void player_tell(struct player *p, uint32_t what);

/* The next period begins, at the player's clock. */
void player_begin_period(struct player *p);

/* At a step of the rate's grid: up to the next one it has the value of the middle. */
void player_step_rate(struct player *p);

/* Whether a configuration, a job, a frame can be played. */
bool player_good_config(const struct player_config *c);
bool player_good_job(const struct player_job *job);
bool player_good_frame(const struct player *p, const struct frame *frame);

#endif
