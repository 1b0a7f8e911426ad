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

/* A new direction jogs an axis, by a step or until the direction is 0. A step goes to its end,
 * unless direction and step are both 0. */
static void jog(struct pc *pc, const struct pc_panel *panel, int i)
{
    struct pc_process *p = &pc->process;
    const bool turned = panel->jog[i] != p->jog[i];
    const double step = panel->jog_step[i];

    p->jog[i] = panel->jog[i];
    if (panel->jog[i] == 0) {
        if (step == 0.0 && (turned || p->steps[i])) {
            manual_jog(&pc->mcc, i, 0, panel->jog_percent);
            p->steps[i] = false;
        }
    } else if (turned) {
        p->steps[i] = step > 0.0;
        if (p->steps[i]) {
            manual_step(&pc->mcc, i, panel->jog[i] * step, panel->jog_percent);
        } else {
            manual_jog(&pc->mcc, i, panel->jog[i], panel->jog_percent);
        }
    }
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
        jog(pc, panel, i);
    }
    if (panel->wheel_axis != p->wheel_axis) {
        p->wheel_axis = panel->wheel_axis;
        MCC_MPG_disable(m);
        manual_follow(m, panel->wheel_axis - 1, panel->wheel_encoder - 1, panel->wheel_ratio);
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

/* Run the program from its first block, or from a line, from where the axes stand. */
static void run_anew(struct pc *pc, const struct source *program, int32_t from)
{
    struct mcc *m = &pc->mcc;
    struct fault_report r;

    pc->process.anew = false;
    if (task_start_at(m, program, from, &r) == MCC_NO_ERR) {
        pc->process.started = true;
        return;
    }
    pc->process.refused = r;
    pc->process.refusals++;
    if (r.fault != FAULT_FROM_LINE && r.fault != FAULT_FROM_HELD) {
        reaction_stop(m, reaction_error_of(&r));
    }
}

/* Whether cycle_start runs the program anew: with wait_start always, else once a cleared error has
 * ended it. */
static bool may_run(const struct pc *pc)
{
    const struct mcc *m = &pc->mcc;

    return pc->program && (pc->process.anew || (pc->config.wait_start && may_start(pc)))
           && !mdi_waits(&m->mdi) && MCC_check_stop(m) && !m->error;
}

static void error_keys(struct pc *pc, const struct pc_panel *panel, const struct source *program)
{
    struct pc_process *p = &pc->process;
    struct mcc *m = &pc->mcc;

    if (key_take(&p->clear_error)) {
        const bool error = m->error != 0;
        p->anew = (MCC_clear_error(m) == MCC_NO_ERR && error && p->started) || p->anew;
    }
    if (key_take(&p->cycle_start) && task_continue(m) != MCC_NO_ERR && may_run(pc)) {
        run_anew(pc, program, panel->run_from);
    }
}

/* Begin what runs by itself: the program, once, and lines by hand. */
static void begin(struct pc *pc)
{
    struct pc_process *p = &pc->process;
    const bool by_hand = pc->mcc.mdi.on && (pc->mcc.running || mdi_waits(&pc->mcc.mdi));

    if (pc->program && !pc->config.wait_start && !p->started && !by_hand && may_start(pc)) {
        task_start(&pc->mcc);
        p->started = true;
    }
    mdi_start(&pc->mcc);
}

void pc_control_process(struct pc *pc, const struct pc_panel *panel, const struct source *program)
{
    struct pc_process *p = &pc->process;
    struct mcc *m = &pc->mcc;

    by_hand(pc, panel);
    if (!pc->config.no_panel) {
        task_set_single_block(m, panel->single_block);
        task_set_switches(m, panel->block_delete, panel->optional_stop);
    }
    begin(pc);
    if (key_take(&p->abort)) {
        key_take(&p->go_home);
        p->started = true; /* a program that waits for its start is dropped too */
        mdi_drop(&m->mdi);
        MCC_motion_abort(m);
    }
    error_keys(pc, panel, program);
    if (!pc->config.no_panel) {
        task_operate(m, panel->hold, panel->override, panel->override * panel->rapid);
        trajectory_adapt(&m->trajectory, panel->adaptive);
    }
}
