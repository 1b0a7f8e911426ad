#include "pc_parts.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "el_extremes.h"
#include "reaction.h"

static const double VOLTS_MAX = VOLTAGE_RANGE; /* [V] */

/* Keep what the modules are doing now, as it is shown to others. */
static void show(struct pc *pc)
{
    cyclic_tell(&pc->modules, &pc->shown);
    if (pc->shown_isr.order != pc->pcl.isr.order) { /* else no page was served since */
        pc->shown_isr = pc->pcl.isr;
    }
}

int pc_start(struct pc *pc, const struct machine *m, const struct pc_config *config, bool program)
{
    memset(&pc->pcl, 0, sizeof *pc - offsetof(struct pc, pcl)); /* the library opens itself */
    pc->config = *config;
    pc->random = (uint64_t)(int64_t)config->seed;
    pc->program = program;
    cyclic_start(&pc->modules,
                 &(struct cyclic_config){
                     .tasks = PC_MODULES,
                     .priority = { config->priority[0], config->priority[1], config->priority[2],
                                   config->priority[3] },
                     .cycle = { config->interpreter, config->ipo, 0, config->process },
                     .offset = { config->offset[0], config->offset[1], 0, config->offset[3] } });
    struct isr_config isr = config->isr;
    for (int i = 0; i < AXES; i++) {
        isr.mask[ISR_LOOP_PAGE] |= (m->axis[i].used && m->axis[i].track_limit > 0) << i;
    }
    pcl_start(&pc->pcl, m, config->min_stock, config->batch, &isr);
    pc->shown_isr = pc->pcl.isr;
    show(pc);
    const int code = MCC_init_motion(&pc->mcc, m);
    task_set_switches(&pc->mcc, config->block_delete, config->optional_stop);
    for (int i = 0; i < AXES && code == MCC_NO_ERR; i++) {
        if (config->home_order[i] > 0
            && homing_set(&pc->mcc, i, &config->home[i], config->encoder_backward[i])) {
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
    pc->process.go_home.pressed = config->home_first;
    if (config->dry_run) {
        MCC_enable_dry_run(&pc->mcc);
    }
    return code;
}

static void read_panel(struct pc *pc, const struct pc_panel *panel)
{
    pc_look_at_panel(pc, panel);
    if (!pc->config.no_panel) {
        MCC_set_P_gain(&pc->mcc, panel->p_gain);
    }
    pc->mcc.signals = panel->signals;
    signals_turn(&pc->mcc.signals, &pc->mcc.machine);
    manual_look(&pc->mcc);
    mdi_look(&pc->mcc);
    readout_look(&pc->mcc);
    homing_look(&pc->mcc, pc->config.bus);
}

/* Compute the voltages of output mode 2: by the P law alone, or by the whole law of law.h. */
static void control(struct pc *pc, int64_t now, const struct pcl_card *card,
                    const struct pc_panel *panel)
{
    const struct machine *m = &pc->mcc.machine;
    struct law_axis *axis = pc->voltage.config.axis;
    double volts[AXES] = { 0.0 };

    voltage_follow(&pc->voltage, m);
    for (int i = 0; i < AXES; i++) {
        const double fixed = pc->config.law.axis[i].gain;
        if (!axis[i].on) {
            continue;
        }
        axis[i].gain = fixed > 0.0 ? fixed : panel->software_gain[i];
        if (!pc->voltage.special) {
            const double v = axis[i].gain * panel->signals.err[i];
            pc->volts[i] = el_max(-VOLTS_MAX, el_min(VOLTS_MAX, v));
        }
    }
    if (pc->voltage.special) {
        voltage_tick(&pc->voltage, &pc->mcc, now, card->stock, VOLTS_MAX, volts);
        for (int i = 0; i < AXES; i++) {
            pc->volts[i] = m->axis[i].inverted ? -volts[i] : volts[i];
        }
    }
}

/* Look at what the card shows: at its frames first, as the law needs their points. */
static void look_at_card(struct pc *pc, const struct pcl_card *card, int64_t now)
{
    /* A number is drawn for each interrupt. */
    const int64_t latency = pcl_interrupt(&pc->pcl, card)
                                ? pcl_latency(&pc->random, pc->config.latency, pc->config.jitter)
                                : 0;
    const int32_t taken = pcl_acknowledged(&pc->pcl, card);

    if (taken >= 0) {
        voltage_taken(&pc->voltage, &pc->mcc, &pc->pcl.part, taken);
        pc->pcl.starved += pcl_release(&pc->mcc, &pc->pcl.part, taken);
    }
    pcl_notice(&pc->pcl, card, now, latency);
}

/* React to danger, as the card and the interrupts just served report it. */
static void protect(struct pc *pc)
{
    const struct isr *isr = &pc->pcl.isr;
    bool *writing = &pc->run[PC_PCL].unit;
    const bool served = isr->served[ISR_LOOP_PAGE] != pc->loop_served;
    const struct reaction_look look = { .clocks = pc->config.bus,
                                        .flying =
                                            pc->pcl.open || *writing ? pc->pcl.part.points : 0,
                                        .overflow =
                                            served ? (uint32_t)isr->sources[ISR_LOOP_PAGE] : 0 };

    pc->loop_served = isr->served[ISR_LOOP_PAGE];
    pcl_halt(&pc->pcl, pc->mcc.signals.stop);
    *writing = *writing && !pc->mcc.signals.stop;
    reaction_look(&pc->mcc, &look);
}

void pc_instant(struct pc *pc, int64_t now, const struct pcl_card *card,
                const struct pc_panel *panel, const struct source *program)
{
    const struct pc_now here = { now + pc->config.bus, panel, program };

    look_at_card(pc, card, now);
    read_panel(pc, panel);
    control(pc, now, card, panel);
    protect(pc);
    pc_work(pc, here.publish + 1, &here);
    show(pc);
    pc_work(pc, here.publish + pc->config.bus, &here);
}

bool pc_done(const struct pc *pc)
{
    /* Points leave the queue when the card has acknowledged them. */
    return (pc->process.started || !pc->program) && !pc->mcc.error && MCC_check_stop(&pc->mcc);
}

enum pc_cycle pc_ipo_cycle(const struct pc *pc)
{
    const struct pc_config *c = &pc->config;
    int64_t run = c->time[PC_IPO] + c->unit[PC_IPO];

    run += c->interpreter == 0 ? c->time[PC_INTERPRETER] : 0;
    run += c->process == 0 ? c->time[PC_PROCESS] : 0;
    return c->ipo < run                                    ? PC_CYCLE_SHORT
           : c->ipo > machine_dda_clocks(&pc->mcc.machine) ? PC_CYCLE_LONG
                                                           : PC_CYCLE_KEPT;
}

void pc_publish(const struct pc *pc, struct link_host *link)
{
    const struct machine *m = &pc->mcc.machine;

    card_write(&pc->pcl, m, true, link);
    for (int i = 0; i < AXES; i++) {
        link->loop_on[i] = m->axis[i].used && pc->config.output_mode[i] != 0;
        link->dac_source[i] = pc->config.output_mode[i] == 1;
        link->index_low[i] = m->axis[i].index_low;
    }
    memcpy(link->dac_volts, pc->volts, sizeof link->dac_volts);
    memcpy(link->latch_seq, pc->mcc.latch_seq, sizeof link->latch_seq);
}
