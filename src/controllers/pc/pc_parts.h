/* pc_parts - between the files of pc: what the modules work on, and what each does. */
#ifndef PC_PARTS_H
#define PC_PARTS_H

#include "pc.h"

/* What a bus instant brings. */
struct pc_now {
    int64_t publish; /* [clocks] what is decided now shows then: (k+1) T_b */
    const struct pc_panel *panel;
    const struct source *program;
};

/* All that the modules do before a clock. */
void pc_work(struct pc *pc, int64_t until, const struct pc_now *now);

/* Keys that were pressed; what the process control does with them and with the panel. */
void pc_look_at_panel(struct pc *pc, const struct pc_panel *panel);
void pc_control_process(struct pc *pc, const struct pc_panel *panel, const struct source *program);

static inline int64_t pc_clock(const struct pc *pc)
{
    return pc->modules.processor.clock;
}

#endif
