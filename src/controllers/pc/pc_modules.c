/* The PC's modules: what each does when a run of it begins, and when its time is over. */
#include "pc_parts.h"

#include <stddef.h>

/* Begin a unit if it can be made and the run may have one more. Returns its time [clocks], else
 * 0. */
static int64_t next_unit(struct pc *pc, int module, bool can)
{
    struct pc_run *run = &pc->run[module];
    const int32_t most = pc->config.most[module];

    run->unit = can && (most == 0 || run->units < most);
    run->units += run->unit;
    return run->unit ? pc->config.unit[module] : 0;
}

static int64_t next_command(struct pc *pc)
{
    return next_unit(pc, PC_INTERPRETER, task_can_read(&pc->mcc));
}

static int64_t next_point(struct pc *pc)
{
    return next_unit(pc, PC_IPO, task_can_point(&pc->mcc));
}

/* Begin a run of the IPO, and in it the modules without a cycle of their own. Returns the time
 * until the first point [clocks]. */
static int64_t ipo_begin(struct pc *pc, const struct pc_now *now)
{
    const struct pc_config *c = &pc->config;
    int64_t time = c->time[PC_IPO];

    if (c->process == 0) {
        pc_control_process(pc, now->panel, now->program);
        time += c->time[PC_PROCESS];
    }
    if (c->interpreter == 0) {
        time += c->time[PC_INTERPRETER];
        time += c->unit[PC_INTERPRETER] * task_read_all(&pc->mcc, now->program);
    }
    return time + next_point(pc);
}

/* Begin a run of the PCL: a page, or a transaction that is due. Returns the clock from which it was
 * due; *time is that of the write [clocks], 0: there is none. */
static int64_t pcl_begin(struct pc *pc, int64_t *time)
{
    struct pcl *p = &pc->pcl;
    const int64_t clock = pc_clock(pc);
    int64_t due = pcl_due(p);

    *time = 0;
    pc->page = due > clock;
    if (pc->page) {
        const int page = isr_next(&p->isr, clock);
        due = p->isr.raised[page];
        isr_begin(&p->isr, page, clock);
        if (page == ISR_FIFO_PAGE && (p->isr.sources[page] & p->mask)) {
            pcl_turn(p, clock);
        }
    } else if (p->raised >= 0) {
        due = p->raised;
    }
    pc->run[PC_PCL].unit = pcl_due(p) <= clock;
    if (pc->run[PC_PCL].unit) {
        pcl_take(p, &pc->mcc);
        *time = pc->config.time[PC_PCL] + pc->config.unit[PC_PCL] * p->count;
    }
    return due;
}

static void begin(struct pc *pc, int module, const struct pc_now *now)
{
    int64_t due = pc->modules.task[module].due;
    int64_t time = pc->config.time[module];

    pc->run[module] = (struct pc_run){ 0 };
    switch (module) {
    case PC_INTERPRETER: time += next_command(pc); break;
    case PC_IPO:         time = ipo_begin(pc, now); break;
    case PC_PCL:         due = pcl_begin(pc, &time); break;
    default:             pc->panel = *now->panel; break;
    }
    cyclic_begin(&pc->modules, module, due, time);
}

static void interpreter_end(struct pc *pc, const struct pc_now *now)
{
    if (!pc->run[PC_INTERPRETER].unit) {
        cyclic_end(&pc->modules, PC_INTERPRETER);
        return;
    }
    if (task_can_read(&pc->mcc)) { /* an abort may have come meanwhile */
        task_read(&pc->mcc, now->program);
    }
    cyclic_more(&pc->modules, PC_INTERPRETER, next_command(pc));
}

static void ipo_end(struct pc *pc, const struct pc_now *now)
{
    if (!pc->run[PC_IPO].unit) {
        task_settle(&pc->mcc);
        cyclic_end(&pc->modules, PC_IPO);
        return;
    }
    int made = 0;
    if (task_can_point(&pc->mcc)) { /* likewise */
        made = task_point(&pc->mcc, pc->config.interpreter > 0 ? NULL : now->program);
    }
    cyclic_more(&pc->modules, PC_IPO, made * pc->config.unit[PC_INTERPRETER] + next_point(pc));
}

/* True if the write comes in time: less than n + 1 DDA times after its interrupt. */
static bool in_time(const struct pc *pc)
{
    const struct pcl *p = &pc->pcl;
    const int64_t deadline = (p->min_stock + 1) * machine_dda_clocks(&pc->mcc.machine);

    return p->raised < 0 || pc_clock(pc) - p->raised < deadline;
}

/* End the write, then serve the rest of its page. */
static void pcl_end(struct pc *pc, const struct pc_now *now)
{
    const int64_t clock = pc_clock(pc);

    if (pc->run[PC_PCL].unit) {
        pc->run[PC_PCL].unit = false;
        pc->modules.task[PC_PCL].use.missed += !in_time(pc);
        pcl_write(&pc->pcl, clock < now->publish ? now->publish : clock);
    }
    if (pc->page) {
        pc->page = false;
        cyclic_more(&pc->modules, PC_PCL, pc->config.isr.service);
    } else {
        cyclic_end(&pc->modules, PC_PCL);
    }
}

static void end(struct pc *pc, int module, const struct pc_now *now)
{
    switch (module) {
    case PC_INTERPRETER: interpreter_end(pc, now); break;
    case PC_IPO:         ipo_end(pc, now); break;
    case PC_PCL:         pcl_end(pc, now); break;
    default:
        pc_control_process(pc, &pc->panel, now->program);
        cyclic_end(&pc->modules, module);
        break;
    }
}

/* With ipo_event, ask for a run of the IPO when a point can be made and none could before, unless a
 * run is asked for already. If the IPO is at work it sees that by itself. */
static void wake_ipo(struct pc *pc)
{
    if (!pc->config.ipo_event) {
        return;
    }
    const struct cyclic_task *ipo = &pc->modules.task[PC_IPO];
    const bool due = task_can_point(&pc->mcc);
    if (due && !pc->point_due && !ipo->active && !ipo->asked) {
        cyclic_wake(&pc->modules, PC_IPO, pc_clock(pc), pc_clock(pc));
    }
    pc->point_due = due;
}

/* Ask for the next service of the position control, unless it is at work. */
static void wake_pcl(struct pc *pc)
{
    const int64_t page = isr_ready(&pc->pcl.isr), write = pcl_due(&pc->pcl);
    const int64_t ready = page < write ? page : write;

    if (!pc->modules.task[PC_PCL].active && ready != INT64_MAX) {
        cyclic_wake(&pc->modules, PC_PCL, ready, ready);
    }
}

void pc_work(struct pc *pc, int64_t until, const struct pc_now *now)
{
    for (;;) {
        wake_pcl(pc);
        wake_ipo(pc);
        const struct cyclic_event e = cyclic_next(&pc->modules, until);
        if (e.what == CYCLIC_NONE) {
            return;
        }
        (e.what == CYCLIC_BEGIN ? begin : end)(pc, e.task, now);
    }
}
