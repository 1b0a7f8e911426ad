/* player_parts - functions that player.c, player_ramp.c and player_view.c share: the phase of the
 * period in progress and its pulses. Not for the player's users. */
#ifndef PLAYER_PARTS_H
#define PLAYER_PARTS_H

#include "player.h"

/* Phase [ticks/PLAYER_FULL_RATE]: of a whole period; of the period in progress at a clock. */
int64_t player_period_phase(const struct player *p);
int64_t player_phase(const struct player *p, int64_t clock);

/* Signed number of pulses of an axis in the frame in progress up to a phase. */
int64_t player_pulses(const struct player *p, int axis, int64_t phase);

/* Clock of the j-th pulse of the frame, j > 0, which must come behind `base`. */
int64_t player_pulse_clock(const struct player *p, int axis, int64_t j);

/* Clock of an axis' latest pulse up to a clock; -1 none yet. */
int64_t player_latest(const struct player *p, int axis, int64_t clock);

/* Move `base` to this clock; to be called before the rate changes and at a period's end. */
void player_rebase(struct player *p, int64_t clock);

/* Report bits of player_tells at the player's clock. */
void player_tell(struct player *p, uint32_t what);

/* Begin the next period at the player's clock. */
void player_begin_period(struct player *p);

/* A step of the rate's grid: set the rate to the ramp's value halfway to the next step, or end the
 * ramp. */
void player_step_rate(struct player *p);

/* Whether a configuration, a job, a frame can be played. */
bool player_good_config(const struct player_config *c);
bool player_good_job(const struct player_job *job);
bool player_good_frame(const struct player *p, const struct frame *frame);

#endif
