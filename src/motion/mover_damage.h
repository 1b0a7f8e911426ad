/* mover_damage - whether counts and places of a motion are such that it stays within its arrays. */
#ifndef MOVER_DAMAGE_H
#define MOVER_DAMAGE_H

#include "mover.h"

bool mover_damaged(const struct mover *p, const struct ring *r);
bool queue_damaged(const struct queue *q);

#endif
