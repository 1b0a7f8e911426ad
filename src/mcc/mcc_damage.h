/* mcc_damage - whether a state that comes back from outside can be worked with: every index and
 * count lies within its array. Booleans and enumerations must have been looked at; values that are
 * only wrong are not seen. */
#ifndef MCC_DAMAGE_H
#define MCC_DAMAGE_H

#include "pc.h"

/* What is wrong, in words, or NULL. */
const char *mcc_damage_pc(const struct pc *pc);

/* The same of parts: a library, the DDA of its machine, a position control, what a library has in
 * its transaction, a law. */
const char *mcc_damage_library(const struct mcc *m);
const char *mcc_damage_machine(const struct machine *m);
const char *mcc_damage_control(const struct pcl *p);
const char *mcc_damage_part(const struct pcl_part *part, const struct pcl *p,
                            const struct queue *q);
const char *mcc_damage_voltage(const struct voltage *v);

#endif
