#include "pc.h"

#include <math.h>
#include <string.h>

#include "reaction.h"

static const double VOLTS_MAX = VOLTAGE_RANGE;  /* [V] */

/* What the modules are doing now is what others see. */
static void show(struct pc *pc)
{
    cyclic_tell(&pc->modules, &pc->shown);
    pc->shown_isr = pc->pcl.isr;
}

int pc_start(struct pc *pc, const struct machine *m, const struct pc_config *config, bool program)
{
    memset(pc, 0, sizeof *pc);
    pc->config = *config;
    pc->random = (uint64_t)(int64_t)config->seed;
    pc->program = program;
    cyclic_start(&pc->modules, &(struct cyclic_config){
        .tasks = PC_MODULES,
        .priority = { config->priority[0], config->priority[1], config->priority[2],
                      config->priority[3] },
        .cycle = { config->interpreter, config->ipo, 0, config->process },
        .offset = { config->offset[0], config->offset[1], 0, config->offset[3] }
    });
    struct isr_config isr = config->isr;
    for (int i = 0; i < AXES; i++) {
        isr.mask[ISR_LOOP_PAGE] |= (m->axis[i].used && m->axis[i].track_limit > 0) << i;
    }
    pcl_start(&pc->pcl, m, config->min_stock, config->batch, &isr);
    show(pc);
    const int code = MCC_init_motion(&pc->mcc, m);
    task_set_switches(&pc->mcc, config->block_delete, config->optional_stop);
    for (int i = 0; i < AXES && code == MCC_NO_ERR; i++) {
        if (config->home_order[i] > 0 &&
            homing_set(&pc->mcc, i, &config->home[i], config->encoder_backward[i])) {
            return MCC_PARAMETER;
        }
    }
    struct law_config law = config->law;
    law.period = (double)config->bus / CLOCK_HZ;
    for (int i = 0; i < AXES; i++) {
        law.axis[i].on = config->output_mode[i] == 2;
    }
    voltage_start(&pc->voltage, &law, m);
    homing_set_settle(&pc->mcc, config->home_settle);
    pc->home_due = config->home_first;
    if (config->dry_run) {
        MCC_enable_dry_run(&pc->mcc);
    }
    return code;
}

static void read_panel(struct pc *pc, const struct pc_panel *panel)
{
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
    pc->mcc.signals = signals_turned(&panel->signals, &pc->mcc.machine);
    manual_look(&pc->mcc, pc->config.bus);
}

/* Software voltages: the P law alone, or the law of figure 10 with what is added to it. */
static void control(struct pc *pc, int64_t now, const struct pcl_card *card,
                    const struct pc_panel *panel)
{
    const struct machine *m = &pc->mcc.machine;
    struct law_axis *axis = pc->voltage.config.axis;
    double volts[AXES] = { 0.0 };

    voltage_follow(&pc->voltage, m);
    for (int i = 0; i < AXES; i++) {
        const double fixed = pc->config.law.axis[i].gain;
        axis[i].gain = fixed > 0.0 ? fixed : panel->software_gain[i];
        if (axis[i].on && !pc->voltage.special) {
            const double v = axis[i].gain * panel->signals.err[i];
            pc->volts[i] = fmax(-VOLTS_MAX, fmin(VOLTS_MAX, v));
        }
    }
    if (pc->voltage.special) {
        voltage_tick(&pc->voltage, &pc->mcc, now, card->stock, VOLTS_MAX, volts);
        for (int i = 0; i < AXES; i++) {
            pc->volts[i] = m->axis[i].inverted ? -volts[i] : volts[i];
        }
    }
}

/* What the card shows: its frames first, for the law wants to know their points. */
static void look_at_card(struct pc *pc, const struct pcl_card *card, int64_t now)
{
    /* A number is drawn for each interrupt. */
    const int64_t latency = pcl_interrupt(&pc->pcl, card)
                          ? pcl_latency(&pc->random, pc->config.latency, pc->config.jitter) : 0;
    const int32_t taken = pcl_acknowledged(&pc->pcl, card);

    if (taken >= 0) {
        voltage_taken(&pc->voltage, &pc->mcc, &pc->pcl.part, taken);
        pc->pcl.starved += pcl_release(&pc->mcc, &pc->pcl.part, taken);
    }
    pcl_notice(&pc->pcl, card, now, latency);
}

/* Homing, jog, hand wheel; the library refuses what cannot be now. */
static void by_hand(struct pc *pc)
{
    const struct pc_panel *panel = &pc->panel;
    struct mcc *m = &pc->mcc;

    if (pc->home_due && pc->modules.processor.clock >= pc->config.start) {
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
    return pc->modules.processor.clock >= pc->config.start &&
           (homed == 1 || (homed < 0 && !pc->config.home_first));
}

/* What the card and the interrupts just served tell of danger. */
static void protect(struct pc *pc)
{
    const struct isr *isr = &pc->pcl.isr;
    const bool served = isr->served[ISR_LOOP_PAGE] != pc->loop_served;
    const struct reaction_look look = {
        .clocks = pc->config.bus, .flying = pc->pcl.open || pc->writing ? pc->pcl.part.points : 0,
        .overflow = served ? (uint32_t)isr->sources[ISR_LOOP_PAGE] : 0
    };

    pc->loop_served = isr->served[ISR_LOOP_PAGE];
    pcl_halt(&pc->pcl, pc->mcc.signals.stop);
    pc->writing = pc->writing && !pc->mcc.signals.stop;
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

/* What the process control does, with the panel as it read it. */
static void process_act(struct pc *pc, const struct source *program)
{
    struct mcc *m = &pc->mcc;

    by_hand(pc);
    if (!pc->config.no_panel) {
        task_set_single_block(m, pc->panel.single_block);
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
        task_operate(m, pc->panel.hold, pc->panel.override);
    }
}

/* May a run begin one more unit? Counts it. */
static bool one_more(struct pc *pc, int module, bool can)
{
    const int32_t most = pc->config.most[module];
    const bool more = can && (most == 0 || pc->units[module] < most);

    pc->units[module] += more;
    return more;
}

/* The next command of a run of the interpreter, the next point of the IPO, if there is one: its
 * time. [clocks] */
static int64_t next_command(struct pc *pc)
{
    pc->reading = one_more(pc, PC_INTERPRETER, task_can_read(&pc->mcc));
    return pc->reading ? pc->config.unit[PC_INTERPRETER] : 0;
}

static int64_t next_point(struct pc *pc)
{
    pc->computing = one_more(pc, PC_IPO, task_can_point(&pc->mcc));
    return pc->computing ? pc->config.unit[PC_IPO] : 0;
}

/* The IPO begins, and with it the modules without a cycle. Returns the time to the first point. */
static int64_t ipo_begin(struct pc *pc, const struct pc_panel *panel, const struct source *program)
{
    const struct pc_config *c = &pc->config;
    int64_t time = c->time[PC_IPO];

    if (c->process == 0) {
        pc->panel = *panel;
        process_act(pc, program);
        time += c->time[PC_PROCESS];
    }
    if (c->interpreter == 0) {
        time += c->time[PC_INTERPRETER];
        time += c->unit[PC_INTERPRETER] * task_read_all(&pc->mcc, program);
    }
    return time + next_point(pc);
}

/* The transaction or page the PCL serves at this clock. */
static void pcl_begin(struct pc *pc)
{
    struct pcl *p = &pc->pcl;
    const int64_t clock = pc->modules.processor.clock;
    int64_t due = pcl_due(p), time = 0;

    if (due > clock) {
        const int page = isr_next(&p->isr, clock);
        due = p->isr.raised[page];
        isr_begin(&p->isr, page, clock);
        if (page == ISR_FIFO_PAGE && (p->isr.sources[page] & p->mask)) {
            pcl_turn(p, clock);
        }
        pc->tail = pc->config.isr.service;
    } else if (p->raised >= 0) {
        due = p->raised;
    }
    pc->writing = pcl_due(p) <= clock;
    if (pc->writing) {
        pcl_take(p, &pc->mcc);
        time = pc->config.time[PC_PCL] + pc->config.unit[PC_PCL] * p->count;
    }
    cyclic_begin(&pc->modules, PC_PCL, due, time);
}

static void begin(struct pc *pc, int module, const struct pc_panel *panel,
                  const struct source *program)
{
    const int64_t due = pc->modules.task[module].due;
    int64_t time = pc->config.time[module];

    pc->units[module] = 0;
    if (module == PC_PCL) {
        pcl_begin(pc);
        return;
    }
    if (module == PC_INTERPRETER) {
        time += next_command(pc);
    } else if (module == PC_IPO) {
        time = ipo_begin(pc, panel, program);
    } else {
        pc->panel = *panel;
    }
    cyclic_begin(&pc->modules, module, due, time);
}

/* The time of what the IPO has under way is over. */
static void ipo_end(struct pc *pc, const struct source *program)
{
    if (!pc->computing) {
        task_settle(&pc->mcc);
        cyclic_end(&pc->modules, PC_IPO);
        return;
    }
    int made = 0;
    if (task_can_point(&pc->mcc)) {         /* an abort may have come meanwhile */
        made = task_point(&pc->mcc, pc->config.interpreter > 0 ? NULL : program);
    }
    cyclic_more(&pc->modules, PC_IPO, made * pc->config.unit[PC_INTERPRETER] + next_point(pc));
}

/* The latest write came in time: less than (n + 1) T after its interrupt. */
static bool in_time(const struct pc *pc)
{
    const struct pcl *p = &pc->pcl;
    const int64_t deadline = (p->min_stock + 1) * machine_dda_clocks(&pc->mcc.machine);

    return p->raised < 0 || pc->modules.processor.clock - p->raised < deadline;
}

static void pcl_end(struct pc *pc)
{
    struct pcl *p = &pc->pcl;
    const int64_t clock = pc->modules.processor.clock;

    if (pc->writing) {
        pc->writing = false;
        pc->modules.task[PC_PCL].use.missed += !in_time(pc);
        pcl_write(p, clock < pc->publish ? pc->publish : clock);
        cyclic_more(&pc->modules, PC_PCL, pc->tail);
        pc->tail = 0;
    } else if (pc->tail > 0) {
        cyclic_more(&pc->modules, PC_PCL, pc->tail);
        pc->tail = 0;
    } else {
        cyclic_end(&pc->modules, PC_PCL);
    }
}

static void end(struct pc *pc, int module, const struct source *program)
{
    if (module == PC_INTERPRETER && pc->reading) {
        if (task_can_read(&pc->mcc)) {      /* an abort may have come meanwhile */
            task_read(&pc->mcc, program);
        }
        cyclic_more(&pc->modules, module, next_command(pc));
    } else if (module == PC_IPO) {
        ipo_end(pc, program);
    } else if (module == PC_PCL) {
        pcl_end(pc);
    } else {
        if (module == PC_PROCESS) {
            process_act(pc, program);
        }
        cyclic_end(&pc->modules, module);
    }
}

/* Timer and event: ask for the IPO when a point has come to be made, unless it is asked already; if
 * it is at work it sees that itself. */
static void wake_ipo(struct pc *pc)
{
    if (!pc->config.ipo_event) {
        return;
    }
    const struct cyclic_task *ipo = &pc->modules.task[PC_IPO];
    const bool due = task_can_point(&pc->mcc);
    if (due && !pc->point_due && !ipo->active && !ipo->asked) {
        cyclic_wake(&pc->modules, PC_IPO, pc->modules.processor.clock, pc->modules.processor.clock);
    }
    pc->point_due = due;
}

/* Ask for the next service of the PCL, unless it is at work. */
static void wake(struct pc *pc)
{
    const int64_t page = isr_ready(&pc->pcl.isr), write = pcl_due(&pc->pcl);
    const int64_t ready = page < write ? page : write;

    if (!pc->modules.task[PC_PCL].active && ready != INT64_MAX) {
        cyclic_wake(&pc->modules, PC_PCL, ready, ready);
    }
}

/* All that happens before a clock. */
static void work(struct pc *pc, int64_t until, const struct pc_panel *panel,
                 const struct source *program)
{
    for (;;) {
        wake(pc);
        wake_ipo(pc);
        const struct cyclic_event e = cyclic_next(&pc->modules, until);
        if (e.what == CYCLIC_NONE) {
            return;
        }
        if (e.what == CYCLIC_BEGIN) {
            begin(pc, e.task, panel, program);
        } else {
            end(pc, e.task, program);
        }
    }
}

void pc_instant(struct pc *pc, int64_t now, const struct pcl_card *card,
                const struct pc_panel *panel, const struct source *program)
{
    pc->publish = now + pc->config.bus;
    look_at_card(pc, card, now);
    read_panel(pc, panel);
    control(pc, now, card, panel);
    protect(pc);
    work(pc, pc->publish + 1, panel, program);
    show(pc);
    work(pc, pc->publish + pc->config.bus, panel, program);
}

bool pc_done(const struct pc *pc)
{
    /* Points leave the queue when the card has acknowledged them. */
    return (pc->started || !pc->program) && !pc->mcc.error && MCC_check_stop(&pc->mcc);
}

enum pc_cycle pc_ipo_cycle(const struct pc *pc)
{
    const struct pc_config *c = &pc->config;
    int64_t run = c->time[PC_IPO] + c->unit[PC_IPO];

    run += c->interpreter == 0 ? c->time[PC_INTERPRETER] : 0;
    run += c->process == 0 ? c->time[PC_PROCESS] : 0;
    return c->ipo < run ? PC_CYCLE_SHORT :
           c->ipo > machine_dda_clocks(&pc->mcc.machine) ? PC_CYCLE_LONG : PC_CYCLE_KEPT;
}

bool pc_loop_on(const struct pc *pc, int axis)
{
    return pc->mcc.machine.axis[axis].used && pc->config.output_mode[axis] != 0;
}

int32_t pc_dac_source(const struct pc *pc, int axis)
{
    return pc->config.output_mode[axis] == 1 ? 1 : 0;
}
