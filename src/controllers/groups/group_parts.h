/* group_parts - between the files of the groups: what a voltage group has on its card. */
#ifndef GROUP_PARTS_H
#define GROUP_PARTS_H

#include "group.h"

/* 0 if the axes of a new voltage group may have these DAC, else the code of the refusal. */
int group_dac_check(const struct groups *s, int card, const int32_t dac[AXES]);

/* The same of pulse channels whose command mode takes their DAC and their counter. */
int group_dac_check_pulse(const struct groups *s, int card, const int32_t channel[AXES]);

/* A voltage group begins, with everything at rest; one bus instant of it. */
void group_dac_start(struct groups *s, struct group *g);
void group_dac_instant(struct groups *s, struct group *g, int64_t now);

#endif
