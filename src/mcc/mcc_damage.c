#include "mcc_damage.h"

#include <stddef.h>

static bool within(int64_t x, int64_t low, int64_t high)
{
    return x >= low && x <= high;
}

const char *mcc_damage_machine(const struct machine *m)
{
    return within(m->dda_length, 10, 15) ? NULL : "the DDA length";
}

const char *mcc_damage_library(const struct mcc *m)
{
    if (mcc_damage_machine(&m->machine) || !within(m->machine.queue_depth, 1, QUEUE_SIZE)) {
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

const char *mcc_damage_control(const struct pcl *p)
{
    const bool good = within(p->axis, 0, AXES - 1) && within(p->count, 0, PCL_FRAMES) &&
                      within(p->min_stock, 0, PCL_FIFO) && within(p->batch, 1, PCL_FRAMES) &&
                      within(p->prime, 0, 2 * PCL_FIFO) && within(p->isr.page, -1, ISR_PAGES - 1);
    return good ? NULL : "a count of the position control or its page";
}

const char *mcc_damage_part(const struct pcl_part *part, const struct pcl *p,
                            const struct queue *q)
{
    const int32_t most = p->count < q->count ? p->count : q->count;
    return within(part->points, 0, most) ? NULL : "the frames under way";
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

const char *mcc_damage_voltage(const struct voltage *v)
{
    const struct trail *t = &v->trail;
    return t->first >= 0 && t->frames >= t->first && t->frames - t->first < TRAIL_SIZE &&
           within(t->foot, t->first, t->frames) ? NULL : "a place on the path behind";
}

const char *mcc_damage_pc(const struct pc *pc)
{
    const char *what = mcc_damage_library(&pc->mcc);
    what = what ? what : mcc_damage_control(&pc->pcl);
    what = what ? what : mcc_damage_part(&pc->pcl.part, &pc->pcl, &pc->mcc.queue);
    if (what) {
        return what;
    }
    if (pc->config.bus < 1) {
        return "the bus period";
    }
    if (!modules_good(&pc->modules)) {
        return "a time of the modules";
    }
    return mcc_damage_voltage(&pc->voltage);
}
