/* mcc_damage - whether a state that comes back from outside can be worked with: every index and
 * count lies within its array. Booleans and enumerations must have been looked at; values that are
 * only wrong are not seen. */
#ifndef MCC_DAMAGE_H
#define MCC_DAMAGE_H

#include "group.h"
#include "pc.h"

/* What is wrong, in words, or NULL. */
const char *mcc_damage_pc(const struct pc *pc);
const char *mcc_damage_groups(const struct groups *g);

#endif
