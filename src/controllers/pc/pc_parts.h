/* pc_parts - what the files of pc share: the work of the modules, and of the process control. */
#ifndef PC_PARTS_H
#define PC_PARTS_H

#include "pc.h"

/* What a bus instant brings. */
struct pc_now {
    int64_t publish; /* [clock] (k+1) T_b, at which decisions of this instant show */
    const struct pc_panel *panel;
    const struct source *program;
};

/* Do all that the modules do before this clock. */
void pc_work(struct pc *pc, int64_t until, const struct pc_now *now);

/* Note which keys go down; then, in a run of the process control, act on keys and panel. */
void pc_look_at_panel(struct pc *pc, const struct pc_panel *panel);
void pc_control_process(struct pc *pc, const struct pc_panel *panel, const struct source *program);

static inline int64_t pc_clock(const struct pc *pc)
{
    return pc->modules.processor.clock;
}

#endif
