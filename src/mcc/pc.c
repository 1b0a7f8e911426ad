#include "pc.h"

#include <math.h>
#include <string.h>

#include "reaction.h"

static const double VOLTS_MAX = 10.0;   /* [V] range of the card's DAC */

int pc_start(struct pc *pc, const struct machine *m, const struct pc_config *config, bool program)
{
    memset(pc, 0, sizeof *pc);
    pc->config = *config;
    pc->random = (uint64_t)(int64_t)config->seed;
    pc->program = program;
    struct isr_config isr = config->isr;
    for (int i = 0; i < AXES; i++) {
        isr.mask[ISR_LOOP_PAGE] |= (m->axis[i].used && m->axis[i].track_limit > 0) << i;
    }
    pcl_start(&pc->pcl, m, config->min_stock, config->batch, &isr);
    const int code = MCC_init_motion(&pc->mcc, m);
    task_set_switches(&pc->mcc, config->block_delete, config->optional_stop);
    for (int i = 0; i < AXES && code == MCC_NO_ERR; i++) {
        if (config->home_order[i] > 0 &&
            homing_set(&pc->mcc, i, &config->home[i], config->encoder_backward[i])) {
            return MCC_PARAMETER;
        }
    }
    homing_set_settle(&pc->mcc, config->home_settle);
    pc->home_due = config->home_first;
    if (config->dry_run) {
        MCC_enable_dry_run(&pc->mcc);
    }
    return code;
}

/* Uniform in [0, 1): SplitMix64, the 53 upper bits. */
static double uniform(uint64_t *state)
{
    uint64_t x = *state += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return ldexp((double)((x ^ (x >> 31)) >> 11), -53);
}

/* Latency of an interrupt; a number is drawn for each. [clocks] */
static int64_t latency(struct pc *pc)
{
    return (int64_t)llround(pc->config.latency + pc->config.jitter * uniform(&pc->random));
}

static void read_panel(struct pc *pc, const struct pc_panel *panel)
{
    const struct machine *m = &pc->mcc.machine;

    pc->abort_due = pc->abort_due || (panel->abort && !pc->abort_seen);
    pc->abort_seen = panel->abort;
    pc->cycle_due = pc->cycle_due || (panel->cycle_start && !pc->cycle_seen);
    pc->cycle_seen = panel->cycle_start;
    pc->home_due = pc->home_due || (panel->go_home && !pc->home_seen);
    pc->home_seen = panel->go_home;
    pc->clear_due = pc->clear_due || (panel->clear_error && !pc->clear_seen);
    pc->clear_seen = panel->clear_error;
    if (!pc->config.no_panel) {
        MCC_set_P_gain(&pc->mcc, panel->p_gain);
    }
    pc->mcc.signals = signals_turned(&panel->signals, m);
    manual_look(&pc->mcc, pc->config.bus);
    for (int i = 0; i < AXES; i++) {
        if (pc->config.output_mode[i] == 2 && m->axis[i].used) {
            const double v = panel->software_gain[i] * panel->signals.err[i];
            pc->volts[i] = fmax(-VOLTS_MAX, fmin(VOLTS_MAX, v));
        }
    }
}

/* Homing, jog, hand wheel; the library refuses what cannot be now. */
static void by_hand(struct pc *pc, const struct pc_panel *panel)
{
    struct mcc *m = &pc->mcc;

    if (pc->home_due && pc->next_ipo >= pc->config.start) {
        pc->home_due = false;
        MCC_go_home(m, pc->config.home_order);
    }
    for (int i = 0; i < AXES; i++) {
        if (panel->jog[i] != pc->jog_seen[i]) {
            pc->jog_seen[i] = panel->jog[i];
            MCC_jog_c(m, i, panel->jog[i], panel->jog_percent);
        }
    }
    if (panel->wheel_axis != pc->wheel_seen) {
        pc->wheel_seen = panel->wheel_axis;
        MCC_MPG_disable(m);
        MCC_MPG_set(m, panel->wheel_axis - 1, panel->wheel_encoder - 1, panel->wheel_ratio);
    }
}

/* The program may start: it waits for a search of the origins; home_first wants a good one. */
static bool may_start(const struct pc *pc)
{
    const int homed = MCC_check_homef(&pc->mcc);
    return pc->next_ipo >= pc->config.start &&
           (homed == 1 || (homed < 0 && !pc->config.home_first));
}

/* What the card and the interrupts just served tell of danger. */
static void protect(struct pc *pc)
{
    const struct isr *isr = &pc->pcl.isr;
    const bool served = isr->served[ISR_LOOP_PAGE] != pc->loop_served;
    const struct reaction_look look = {
        .clocks = pc->config.bus, .flying = pc->pcl.open ? pc->pcl.points : 0,
        .overflow = served ? (uint32_t)isr->sources[ISR_LOOP_PAGE] : 0
    };

    pc->loop_served = isr->served[ISR_LOOP_PAGE];
    pcl_halt(&pc->pcl, pc->mcc.signals.stop);
    reaction_look(&pc->mcc, &look);
}

/* The program once more from its first line, from where the axes stand. */
static void run_again(struct pc *pc, const struct source *program)
{
    struct mcc *m = &pc->mcc;
    struct fault_report r;

    task_check(m, program, &r);
    if (r.fault != FAULT_NONE) {
        reaction_stop(m, reaction_error_of(&r));
    } else {
        task_start(m);
    }
    pc->again = false;
}

static void panel_keys(struct pc *pc, const struct source *program)
{
    struct mcc *m = &pc->mcc;

    if (pc->clear_due) {
        pc->clear_due = false;
        const bool error = m->error != 0;
        pc->again = (MCC_clear_error(m) == MCC_NO_ERR && error && pc->started) || pc->again;
    }
    if (pc->cycle_due) {
        pc->cycle_due = false;
        if (task_continue(m) != MCC_NO_ERR && pc->again && pc->program && MCC_check_stop(m) &&
            !m->error) {
            run_again(pc, program);
        }
    }
}

/* The levels of the panel are offered every time: what does not apply is refused. */
static void offer_levels(struct mcc *m, const struct pc_panel *panel)
{
    if (panel->hold) {
        MCC_motion_hold(m);
    } else {
        MCC_motion_conti(m);
    }
    MCC_set_over_spd(m, 100.0 * panel->override);
    MCC_set_ptp_ospd(m, 100.0 * panel->override);
}

/* One cycle of the IPO task, with the panel as read last. */
static void cycle(struct pc *pc, const struct pc_panel *panel, const struct source *program)
{
    struct mcc *m = &pc->mcc;

    by_hand(pc, panel);
    if (!pc->config.no_panel) {
        task_set_single_block(m, panel->single_block);
    }
    if (pc->program && !pc->started && may_start(pc)) {
        task_start(m);
        pc->started = true;
    }
    if (pc->abort_due) {
        pc->home_due = false;
        pc->started = true;     /* a program that waits for its start is dropped too */
        pc->abort_due = false;
        MCC_motion_abort(m);
    }
    panel_keys(pc, program);
    if (!pc->config.no_panel) {
        offer_levels(m, panel);
    }
    task_run(m, program);
    pc->next_ipo += pc->config.ipo;
}

void pc_instant(struct pc *pc, int64_t now, const struct pcl_card *card,
                const struct pc_panel *panel, const struct source *program)
{
    const int64_t publish = now + pc->config.bus, horizon = publish + pc->config.bus;

    pcl_look(&pc->pcl, &pc->mcc, card, now,
             pcl_interrupt(&pc->pcl, card) ? latency(pc) : 0);
    read_panel(pc, panel);
    isr_run(&pc->pcl.isr, publish + 1);
    protect(pc);
    for (;;) {
        const int64_t due = pcl_due(&pc->pcl);
        if (pc->next_ipo < horizon && pc->next_ipo <= due) {
            cycle(pc, panel, program);
        } else if (due < horizon) {
            pcl_serve(&pc->pcl, &pc->mcc, due < publish ? publish : due);
        } else {
            return;
        }
    }
}

bool pc_done(const struct pc *pc)
{
    /* Points leave the queue when the card has acknowledged them. */
    return (pc->started || !pc->program) && !pc->mcc.error && MCC_check_stop(&pc->mcc);
}

bool pc_loop_on(const struct pc *pc, int axis)
{
    return pc->mcc.machine.axis[axis].used && pc->config.output_mode[axis] != 0;
}

int32_t pc_dac_source(const struct pc *pc, int axis)
{
    return pc->config.output_mode[axis] == 1 ? 1 : 0;
}
