#include "mcc_damage.h"

#include <stddef.h>

#include "mover_damage.h"

static bool within(int64_t x, int64_t low, int64_t high)
{
    return x >= low && x <= high;
}

static bool machine_good(const struct machine *m)
{
    return within(m->dda_length, 10, 15);
}

static const char *library(const struct mcc *m)
{
    if (!machine_good(&m->machine) || !within(m->machine.queue_depth, 1, QUEUE_SIZE)) {
        return "the DDA length or the depth of the queue";
    }
    if (interpreter_damaged(&m->program)) {
        return "the place in the part program";
    }
    if (mover_damaged(&m->mover, &m->ring)) {
        return "a count or a place of the commands";
    }
    if (queue_damaged(&m->queue)) {
        return "a count or a place of the queue";
    }
    for (int i = 0; i < AXES; i++) {
        if (!comp_valid(&m->comp_table[i]) ||
            !within(m->manual.axis[i].encoder, 0, MANUAL_ENCODERS - 1)) {
            return "a compensation table or a hand wheel";
        }
    }
    return NULL;
}

static const char *control(const struct pcl *p)
{
    const bool good = within(p->axis, 0, AXES - 1) && within(p->count, 0, PCL_FRAMES) &&
                      within(p->min_stock, 0, PCL_FIFO) && within(p->batch, 1, PCL_FRAMES) &&
                      within(p->prime, 0, 2 * PCL_FIFO) && within(p->isr.page, -1, ISR_PAGES - 1);
    return good ? NULL : "a count of the position control or its page";
}

static bool part_good(const struct pcl_part *part, const struct pcl *p, const struct queue *q)
{
    return within(part->points, 0, p->count < q->count ? p->count : q->count);
}

/* No cycle has begun that has not been seen: its timer is asked at most once a clock. */
static bool modules_good(const struct cyclic *s)
{
    const struct processor *p = &s->processor;

    if (p->clock < 0 || p->tasks != PC_MODULES || !within(p->running, -1, PC_MODULES - 1)) {
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

static bool trail_good(const struct trail *t)
{
    return t->first >= 0 && t->frames >= t->first && t->frames - t->first < TRAIL_SIZE &&
           within(t->foot, t->first, t->frames);
}

const char *mcc_damage_pc(const struct pc *pc)
{
    const char *what = library(&pc->mcc);
    what = what ? what : control(&pc->pcl);
    if (what) {
        return what;
    }
    if (pc->config.bus < 1 || !part_good(&pc->pcl.part, &pc->pcl, &pc->mcc.queue)) {
        return "the bus period or the frames under way";
    }
    if (!modules_good(&pc->modules)) {
        return "a time of the modules";
    }
    return trail_good(&pc->voltage.trail) ? NULL : "a place on the path behind";
}

const char *mcc_damage_groups(const struct groups *g)
{
    const char *what = NULL;
    for (int k = 0; k < GROUP_CARDS && !what; k++) {
        what = machine_good(&g->card[k].machine) ? control(&g->card[k].pcl)
                                                 : "the DDA length of a card";
    }
    for (int n = 0; n < GROUP_MAX && !what; n++) {
        const struct group *group = &g->group[n];
        if (!group->used) {
            continue;
        }
        what = within(group->card, 0, GROUP_CARDS - 1) ? library(&group->mcc)
                                                       : "the card of a group";
        for (int i = 0; i < AXES && !what; i++) {
            what = within(group->channel[i], -1, AXES - 1) ? NULL : "a channel of a group";
        }
        if (!what && !part_good(&group->part, &g->card[group->card].pcl, &group->mcc.queue)) {
            what = "the frames under way";
        }
        what = !what && group->voltage ? servo_damage(&group->servo) : what;
    }
    if (!what && (g->config.ipo < 1 || g->config.bus < 1 || g->next_ipo < 0)) {
        what = "a period";
    }
    return what;
}
