/* mover_inside - what the halves of the mover share, mover.c and mover_time.c. */
#ifndef MOVER_INSIDE_H
#define MOVER_INSIDE_H

#include "mover.h"

static inline bool is_ptp(const struct command *c)
{
    return c->type == COMMAND_PTP || c->type == COMMAND_PTP_ASYN;
}

/* Whether the motion is on a ramp to rest, or rests there. */
bool mover_brakes(const struct mover *p);

/* Override in force for a kind of command, and for the motion under way. */
double mover_share(const struct mover *p, bool ptp);

/* Single block: whether the next command is the first of a block that may not begin yet. */
bool mover_blocked(const struct mover *p, const struct ring *r);

/* Plan what is under way afresh from where it is; chain and curve do it by themselves. */
void mover_replan(struct mover *p);

/* A command of axes lasts as long as the last of them. */
void mover_wait_for_axes(struct mover *p);

/* The motion ends at a place: nothing is under way any more. */
void mover_rest_at(struct mover *p, const double place[AXES], bool joints);

#endif
