/* The process control: what the panel asks for. */
#include "pc_parts.h"
#include "reaction.h"

void pc_look_at_panel(struct pc *pc, const struct pc_panel *panel)
{
    struct pc_process *p = &pc->process;

    key_look(&p->abort, panel->abort);
    key_look(&p->cycle_start, panel->cycle_start);
    key_look(&p->go_home, panel->go_home);
    key_look(&p->clear_error, panel->clear_error);
}

/* Act on the keys of homing, jog and handwheel; the library refuses what is not possible now. */
static void by_hand(struct pc *pc, const struct pc_panel *panel)
{
    struct pc_process *p = &pc->process;
    struct mcc *m = &pc->mcc;

    if (pc_clock(pc) >= pc->config.start && key_take(&p->go_home)) {
        MCC_go_home(m, pc->config.home_order);
    }
    for (int i = 0; i < AXES; i++) {
        if (panel->jog[i] != p->jog[i]) {
            p->jog[i] = panel->jog[i];
            MCC_jog_c(m, i, panel->jog[i], panel->jog_percent);
        }
    }
    if (panel->wheel_axis != p->wheel_axis) {
        p->wheel_axis = panel->wheel_axis;
        MCC_MPG_disable(m);
        MCC_MPG_set(m, panel->wheel_axis - 1, panel->wheel_encoder - 1, panel->wheel_ratio);
    }
}

/* True if the program may start: not before `start`, not while homing runs, and with home_first
 * only after homing has succeeded. */
static bool may_start(const struct pc *pc)
{
    const int homed = MCC_check_homef(&pc->mcc);
    return pc_clock(pc) >= pc->config.start
           && (homed == 1 || (homed < 0 && !pc->config.home_first));
}

/* Run the program once more from its first block, from where the axes stand. */
static void run_anew(struct pc *pc, const struct source *program)
{
    struct mcc *m = &pc->mcc;
    struct fault_report r;

    task_check(m, program, &r);
    if (r.fault != FAULT_NONE) {
        reaction_stop(m, reaction_error_of(&r));
    } else {
        task_start(m);
    }
    pc->process.anew = false;
}

static void error_keys(struct pc *pc, const struct source *program)
{
    struct pc_process *p = &pc->process;
    struct mcc *m = &pc->mcc;

    if (key_take(&p->clear_error)) {
        const bool error = m->error != 0;
        p->anew = (MCC_clear_error(m) == MCC_NO_ERR && error && p->started) || p->anew;
    }
    if (key_take(&p->cycle_start) && task_continue(m) != MCC_NO_ERR && p->anew && pc->program
        && MCC_check_stop(m) && !m->error) {
        run_anew(pc, program);
    }
}

void pc_control_process(struct pc *pc, const struct pc_panel *panel, const struct source *program)
{
    struct pc_process *p = &pc->process;
    struct mcc *m = &pc->mcc;

    by_hand(pc, panel);
    if (!pc->config.no_panel) {
        task_set_single_block(m, panel->single_block);
    }
    if (pc->program && !p->started && may_start(pc)) {
        task_start(m);
        p->started = true;
    }
    if (key_take(&p->abort)) {
        key_take(&p->go_home);
        p->started = true; /* a program that waits for its start is dropped too */
        MCC_motion_abort(m);
    }
    error_keys(pc, program);
    if (!pc->config.no_panel) {
        task_operate(m, panel->hold, panel->override);
        trajectory_adapt(&m->trajectory, panel->adaptive);
    }
}
