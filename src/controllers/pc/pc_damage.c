/* pc_damage - whether a state that comes back from outside can be worked with. */
#include "pc.h"

#include <stddef.h>

/* No cycle has begun that has not been seen: its timer is asked at most once a clock. */
static bool modules_good(const struct cyclic *s)
{
    const struct processor *p = &s->processor;

    if (p->clock < 0 || p->tasks != PC_MODULES || p->running < -1 ||
        p->running >= PC_MODULES) {
        return false;
    }
    for (int i = 0; i < PC_MODULES; i++) {
        const struct cyclic_task *t = &s->task[i];
        if (t->cycle < 0 || (t->cycle == 0 && t->next != INT64_MAX) ||
            t->next < p->clock - t->cycle || p->task[i].left < 0) {
            return false;
        }
    }
    return true;
}

const char *pc_damage(const struct pc *pc)
{
    const char *what = mcc_damage(&pc->mcc);
    what = what ? what : pcl_damage(&pc->pcl);
    what = what ? what : pcl_part_damage(&pc->pcl.part);
    if (what) {
        return what;
    }
    if (pc->config.bus < 1) {
        return "the bus period";
    }
    if (!modules_good(&pc->modules)) {
        return "a time of the modules";
    }
    return voltage_damage(&pc->voltage);
}
