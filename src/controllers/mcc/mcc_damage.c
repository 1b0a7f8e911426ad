/* mcc_damage - whether states that come back from outside can be worked with. */
#include "mcc.h"

#include <stddef.h>

#include "pcl.h"
#include "voltage.h"

static bool within(int64_t x, int64_t low, int64_t high)
{
    return x >= low && x <= high;
}

const char *machine_damage(const struct machine *m)
{
    return within(m->dda_length, 10, 15) ? NULL : "the DDA length";
}

const char *mcc_damage(const struct mcc *m)
{
    if (machine_damage(&m->machine) || !within(m->machine.queue_depth, 1, QUEUE_SIZE)) {
        return "the DDA length or the depth of the queue";
    }
    if (interpreter_damaged(&m->program)) {
        return "the place in the part program";
    }
    const bool curve = m->mover.motion == MOVER_CURVE;
    if (mover_damaged(&m->mover, &m->ring) ||
        (curve && curve_damaged(&m->mover.curve, &m->curve_plan))) {
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

const char *pcl_damage(const struct pcl *p)
{
    const bool good = within(p->axis, 0, AXES - 1) && within(p->count, 0, PCL_FRAMES) &&
                      within(p->min_stock, 0, PCL_FIFO) && within(p->batch, 1, PCL_FRAMES) &&
                      within(p->prime, 0, 2 * PCL_FIFO) && within(p->isr.page, -1, ISR_PAGES - 1);
    return good ? NULL : "a count of the position control or its page";
}

const char *pcl_part_damage(const struct pcl_part *part)
{
    return within(part->points, 0, PCL_FRAMES) ? NULL : "the frames under way";
}

const char *voltage_damage(const struct voltage *v)
{
    const struct trail *t = &v->trail;
    return t->first >= 0 && t->frames >= t->first && t->frames - t->first < TRAIL_SIZE &&
           within(t->foot, t->first, t->frames) ? NULL : "a place on the path behind";
}

void mcc_unused(const struct mcc *m, struct spans *s)
{
    const struct mover_beside beside = mcc_beside((struct mcc *)(uintptr_t)m);

    spans_leave(s, &m->tools.tool[m->tools.count], m->tools.tool + TOOL_TABLE_MAX);
    interpreter_unused(&m->program, s);
    mover_unused(&m->mover, &beside, s);
    queue_unused(&m->queue, s);
    for (int i = 0; i < AXES; i++) {
        const struct comp_table *t = &m->comp_table[i];
        if (t->interval == 0) {
            spans_leave(s, t->forward, t + 1);
        }
    }
}

void voltage_unused(const struct voltage *v, struct spans *s)
{
    const struct trail *t = &v->trail;

    spans_ring(s, t->point, sizeof t->point[0], TRAIL_SIZE, (int32_t)(t->first % TRAIL_SIZE),
               (int32_t)(t->frames - t->first + 1));
}
