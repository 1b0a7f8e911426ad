#include "group_parts.h"

#include <string.h>

void groups_counters(struct groups *s, int card, const struct link_card *link)
{
    int32_t *counts = s->card[card].counts;

    memcpy(counts, link->enc_count, sizeof link->enc_count);
    memcpy(s->card[card].pulses, link->pulse_count, sizeof link->pulse_count);
    counts[6] = link->enc_count_7;
    counts[7] = link->enc_count_8;
    counts[8] = link->enc_count_9;
}
_Static_assert(GROUP_COUNTERS == LINK_AXES + 3, "a counter of each axis, and three");

void groups_publish(const struct groups *s, int card, struct link_host *link)
{
    const struct group_card *c = &s->card[card];

    card_write(&c->pcl, &c->machine, groups_card_used(s, card), link);
    for (int i = 0; i < AXES; i++) {
        const bool loop = c->machine.axis[i].used && c->command_mode[i] == GROUP_COMMAND_VOLTAGE;
        link->loop_on[i] = loop;
        link->dac_source[i] = loop;
    }
    memset(link->index_low, 0, sizeof link->index_low);
    memset(link->latch_seq, 0, sizeof link->latch_seq);
    memcpy(link->dac_volts, c->volts, sizeof link->dac_volts);
    memcpy(link->dac_volts_aux, c->volts + AXES, sizeof link->dac_volts_aux);
    link->loop_on_aux = groups_watched(s, card, &link->command_aux);
}
_Static_assert(sizeof((struct link_host *)0)->dac_volts_aux / sizeof(double) == GROUP_DACS - AXES,
               "the DAC behind those of the axes");
