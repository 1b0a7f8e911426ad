#include "mcc.h"

#include "pcl.h"
#include "voltage.h"

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
