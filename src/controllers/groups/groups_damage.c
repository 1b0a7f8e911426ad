#include "groups_damage.h"

#include <stddef.h>


static const char *card_damage(const struct group_card *c)
{
    for (int i = 0; i < GROUP_DACS; i++) {
        if (c->dac[i].encoder < 0 || c->dac[i].encoder >= GROUP_COUNTERS) {
            return "the counter of a DAC";
        }
    }
    const char *what = machine_damage(&c->machine);
    return what ? what : pcl_damage(&c->pcl);
}

static const char *group_damage(const struct group *group)
{
    const int32_t channels = group->voltage ? GROUP_DACS : AXES;

    if (group->card < 0 || group->card >= GROUP_CARDS) {
        return "the card of a group";
    }
    for (int i = 0; i < AXES; i++) {
        if (group->channel[i] < -1 || group->channel[i] >= channels) {
            return "a channel of a group";
        }
    }
    const char *what = mcc_damage(&group->mcc);
    what = what ? what : voltage_damage(&group->servo.voltage);
    what = what || !group->voltage ? what : servo_damage(&group->servo);
    return what ? what : pcl_part_damage(&group->part);
}

const char *groups_damage(const struct groups *g)
{
    const char *what = NULL;

    for (int k = 0; k < GROUP_CARDS && !what; k++) {
        what = card_damage(&g->card[k]);
    }
    for (int n = 0; n < GROUP_MAX && !what; n++) {
        what = g->group[n].used ? group_damage(&g->group[n]) : NULL;
    }
    if (!what && (g->config.ipo < 1 || g->config.bus < 1 || g->next_ipo < 0)) {
        what = "a period";
    }
    return what;
}
