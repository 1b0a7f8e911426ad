/* groups_damage - whether a state of groups that comes back from outside can be worked with, as
 * mcc_damage says of a single library. */
#ifndef GROUPS_DAMAGE_H
#define GROUPS_DAMAGE_H

#include "group.h"

/* What is wrong, in words, or NULL. */
const char *groups_damage(const struct groups *g);

#endif
