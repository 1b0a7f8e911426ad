/* group_parts - what the files of groups share: the voltage groups at the DAC of a card. */
#ifndef GROUP_PARTS_H
#define GROUP_PARTS_H

#include "group.h"

/* MCC_NO_ERR if a new voltage group may have these DAC for its axes, else the code that refuses
 * it. */
int group_dac_check(const struct groups *s, int card, const int32_t dac[AXES]);

/* The same for pulse channels: in command mode voltage they take the DAC and the encoder counter of
 * their number. */
int group_dac_check_pulse(const struct groups *s, int card, const int32_t channel[AXES]);

/* Start a voltage group, with everything at rest; do one bus instant of it. */
void group_dac_start(struct groups *s, struct group *g);
void group_dac_instant(struct groups *s, struct group *g, int64_t now);

#endif
