/* FMU of the motion library on its PC (core pc): bus grid, inputs from the card, levels and
 * mailboxes to it, files. */
#include <string.h>

#include "library_in_use.h"
#include "pc.h"
#include "vars.h"

struct model {
    struct pc pc;
    int64_t bus;           /* [ns] period of the bus grid */
    int32_t taken;         /* number of the latest text of mdi that was taken */
    int64_t instant;       /* [ns] next instant of the grid, at which inputs are read */
    bool unpublished;      /* the outputs of the latest instant are shown at the next one */
    int32_t told_error;    /* run-time error that was reported last */
    int32_t told_refusals; /* starts of the program that were refused, */
    int32_t told_refused;  /* and line by hand that was, as reported last */
    bool told_change;      /* the tool change for which the program waits was reported */
    int32_t shown_order;   /* services of interrupts begun so far, */
    uint32_t shown_uses;   /* and changes of the modules' statistics, in what is shown */
};

#define MODEL_BLOB
#define MODEL_IN_USE MCC_IN_USE(pc.mcc) VOLTAGE_IN_USE(pc.voltage)
#include "fmi_model.h"
#include "comp_file.h"
#include "mcc_parameters.h"
#include "path_file.h"
#include "plan_file.h"
#include "program_fault.h"
#include "tool_file.h"

/* Files that are read and that path_file and plan_file must not replace. */
enum { INPUTS = 3 };
struct inputs {
    struct output_input of[INPUTS];
};

static struct inputs inputs_of(const struct fmu *f)
{
    const struct vars *v = &f->s.v;
    return (struct inputs){ {
        { fmu_path(f, v->program, FMU_READ), "it is program" },
        { fmu_path(f, v->comp_file, FMU_READ), "it is comp_file" },
        { fmu_path(f, v->tool_table, FMU_READ), "it is tool_table" },
    } };
}

static int cannot_write(struct fmu *f, const char *parameter, const char *name, const char *why)
{
    return fmu_fail(f, "%s: cannot write %s: %s", parameter, name, why);
}

/* Check that a file can be written, if the parameter names one. */
static int try_to_write(struct fmu *f, const char *parameter, const char *name)
{
    const struct inputs in = inputs_of(f);
    const struct fmu_path path = fmu_path(f, name, FMU_WRITTEN);
    const char *why = !name[0]    ? NULL
                      : path.good ? output_try(path.text, in.of, INPUTS)
                                  : path.text;
    return why ? cannot_write(f, parameter, name, why) : 0;
}

/* Check before the run, not after it, that its files can be written. */
static int model_open(struct fmu *f)
{
    const struct vars *v = &f->s.v;

    if (try_to_write(f, "path_file", v->path_file) || try_to_write(f, "plan_file", v->plan_file)) {
        return -1;
    }
    struct program_file *program;
    const int code = open_program(f, "program", v->program, &program);
    f->blob = program;
    return code;
}

static void model_close(struct fmu *f)
{
    program_close(f->blob);
}

static struct source source_of_program(const struct fmu *f)
{
    return (struct source){ program_look, f->blob };
}

static const char *axes_of(const struct vars *v)
{
    return v->rotary_names ? "XYZABC" : "XYZUVW";
}

static void publish_card(struct vars *v, const struct pc *pc)
{
    struct link_host link;

    link.cmd_seq = v->card_cmd_seq;
    pc_publish(pc, &link);
#define SHOW(type, name, elements) LINK_CARRY(v->card_##name, link.name)
    LINK_LEVELS(SHOW)
    if (link.cmd_seq != v->card_cmd_seq) {
        LINK_WRITE(SHOW)
    }
}

/* Show how the PC's processor is used: what has changed, and loads, which time changes. */
static void publish_schedule(struct vars *v, struct model *m)
{
    const struct isr *isr = &m->pc.shown_isr;
    const struct cyclic_report *r = &m->pc.shown;
    const bool served = m->shown_order != isr->order, used = m->shown_uses != r->changes;

    for (int i = 0; i < ISR_PAGES && served; i++) {
        v->served[i] = isr->served[i];
        v->served_latency[i] = (double)isr->latency[i] / CLOCK_HZ;
    }
    v->serving = isr->page + 1;
    v->module = r->running + 1;
    for (int i = 0; i <= PC_MODULES; i++) {
        const struct cyclic_use *u = i < PC_MODULES ? &r->task[i] : &r->all;
        v->module_load[i] = r->clock > 0 ? (double)u->busy / (double)r->clock : 0.0;
    }
    for (int i = 0; i <= PC_MODULES && used; i++) {
        const struct cyclic_use *u = i < PC_MODULES ? &r->task[i] : &r->all;
        v->module_runs[i] = u->runs;
        v->module_latency[i] = (double)u->latency / CLOCK_HZ;
        v->module_response[i] = (double)u->response / CLOCK_HZ;
        v->module_missed[i] = u->missed;
    }
    m->shown_order = isr->order;
    m->shown_uses = r->changes;
}

/* Show a window of the tool table. */
static void publish_tools(struct vars *v, const struct tool_table *t)
{
    enum { ROWS = sizeof v->tool_listed / sizeof *v->tool_listed };
    static const struct tool none = { .number = -1 };

    if (t->count == 0 && v->tool_rows == 0 && v->tool_listed[0] == none.number) {
        return;
    }
    v->tool_rows = t->count;
    for (int i = 0; i < ROWS; i++) {
        const int32_t row = v->tool_row - 1 + i;
        const struct tool *tool = row < t->count ? &t->tool[row] : &none;
        v->tool_listed[i] = tool->number;
        memcpy(v->tool_offset[i], tool->offset, sizeof tool->offset);
        v->tool_diameter[i] = tool->diameter;
    }
}

static void publish(struct fmu *f)
{
    struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    const struct mcc *mcc = &m->pc.mcc;

    v->status = task_status(mcc);
    v->done = pc_done(&m->pc);
    v->homed = MCC_check_homef(mcc) == 1;
    v->error = MCC_get_errcode(mcc);
    v->failed = v->error != 0 && control_rests(mcc);
    v->line = mcc->written.line > 0 ? mcc->written.line : 0;
    v->command = mcc->written.command;
    v->command_newest = mcc->written.newest;
    v->path_feed = mcc->written.feed;
    MCC_get_cpos(mcc, v->position);
    memcpy(v->work_offset, readout_zero(&mcc->readout)->offset, sizeof v->work_offset);
    for (int i = 0; i < AXES; i++) {
        v->distance_to_go[i] = v->status == TASK_STOPPED ? 0.0 : mcc->written.left[i];
    }
    v->system = readout_zero(&mcc->readout)->system;
    memcpy(v->modes, mcc->readout.codes, sizeof v->modes);
    memcpy(v->compensation, mcc->written.added, sizeof v->compensation);
    const bool fixed = (mcc->trajectory.overrides & OUTPUTS_SPEED_FIXED) != 0;
    const double speed = mcc->written.outputs.spindle * (fixed ? 1.0 : v->spindle_override);
    v->spindle_speed = v->spindle_stop ? 0.0 : speed;
    v->coolant = mcc->written.outputs.coolant ^ v->coolant_flip;
    v->digital_out = (int32_t)mcc->written.outputs.digital;
    v->tool = mcc->written.outputs.tool;
    v->tool_asked = mcc->written.outputs.asks ? mcc->written.outputs.asked : -1;
    memcpy(v->analog, mcc->written.outputs.analog, sizeof v->analog);
    publish_tools(v, &mcc->program.tools.table);
    v->mdi_taken = m->taken;
    v->mdi_room = mdi_room(&mcc->mdi);
    v->mdi_lines = mcc->mdi.line;
    v->mdi_done = mcc->mdi.ended;
    v->mdi_fault = (int32_t)mcc->mdi.fault.fault;
    v->mdi_refused = mcc->mdi.refused;
    v->probe_found = mcc->inquiry.touched;
    memcpy(v->probed, mcc->inquiry.contact, sizeof v->probed);
    v->queue = mcc->queue.count;
    v->starved = m->pc.pcl.starved;
    v->services = m->pc.pcl.services;
    v->latency = (double)m->pc.pcl.latency / CLOCK_HZ;
    publish_schedule(v, m);
    publish_card(v, &m->pc);
    if ((v->tool_asked >= 0) != m->told_change) {
        m->told_change = v->tool_asked >= 0;
        if (m->told_change) {
            fmu_event(f, "line %d waits for tool %d: cycle_start goes on", (int)v->line,
                      (int)v->tool_asked);
        }
    }
    if (v->error != m->told_error) {
        m->told_error = v->error;
        (v->error != 0 ? fmu_warn : fmu_event)(f, "run-time error 0x%04X after line %d",
                                               (unsigned)v->error, (int)v->line);
    }
}

/* Give the library the compensation tables of comp_file. */
static int set_compensation(struct fmu *f)
{
    const char *name = f->s.v.comp_file;
    const struct fmu_path path = fmu_path(f, name, FMU_READ);
    struct comp_file file;

    if (!path.good || comp_read(&file, path.text)) {
        return fmu_fail(f, "comp_file: %s: %s", name, path.good ? file.said : path.text);
    }
    for (int i = 0; i < AXES; i++) {
        if (file.table[i].interval && MCC_set_comp(&f->s.m.pc.mcc, i, &file.table[i])) {
            return fmu_fail(f, "comp_file: %s: axis %d is not active", name, i + 1);
        }
    }
    return 0;
}

/* Give the library the tool table, the probe, and settings of the interpreter. */
static int set_tools(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    const bool stops = strcmp(v->tool_change, "stop") == 0;
    struct mcc *mcc = &f->s.m.pc.mcc;
    const struct mcc_dialect dialect = { v->rotary_names, v->fanuc, v->strict_feed,
                                         v->least_increment };
    struct tool_file file = { .line = 0 };

    if (!stops && strcmp(v->tool_change, "immediate")) {
        return fmu_fail(f, "tool_change = \"%s\" is neither stop nor immediate", v->tool_change);
    }
    const struct fmu_path path = fmu_path(f, v->tool_table, FMU_READ);
    if (v->tool_table[0] && (!path.good || tool_read(&file, path.text, v->rotary_names))) {
        return fmu_fail(f, "tool_table: %s: %s", v->tool_table, path.good ? file.said : path.text);
    }
    task_set_tools(mcc, &file.table, stops);
    task_set_dialect(mcc, &dialect);
    inquiry_set_place(mcc, (enum inquiry_place)v->probe_place);
    return 0;
}

/* Warn if the interpolation cycle breaks the source document's rule. */
static void warn_of_cycle(struct fmu *f)
{
    const struct pc *pc = &f->s.m.pc;
    const double cycle = f->s.v.ipo_period, dda = machine_dda_time(&pc->mcc.machine);

    switch (pc_ipo_cycle(pc)) {
    case PC_CYCLE_SHORT:
        fmu_warn(f, "ipo_period %.9g s is shorter than a run that makes one point", cycle);
        break;
    case PC_CYCLE_LONG:
        fmu_warn(f, "ipo_period %.9g s is longer than the DDA time %.9g s", cycle, dda);
        break;
    default: break;
    }
}

/* The PC and its library as the parameters say, at rest at the origin. */
static int set_out(struct fmu *f, const struct machine *machine)
{
    const struct vars *v = &f->s.v;
    const struct pc_config c = config_of(v);

    if (pc_start(&f->s.m.pc, machine, &c, f->blob != NULL) != MCC_NO_ERR) {
        return fmu_fail(f, "the library refuses the machine parameters");
    }
    return (v->comp_file[0] && set_compensation(f)) || set_tools(f) ? -1 : 0;
}

/* Report a line by hand, or a start of the program, that has just been refused. */
static void tell_refusals(struct fmu *f)
{
    struct model *m = &f->s.m;
    const struct mdi *d = &m->pc.mcc.mdi;

    if (d->refused != m->told_refused) {
        struct source files = source_of_program(f);
        struct mdi_view lines = { d, &files };
        const struct source text = mdi_source(&lines);
        const struct named_program named = { "mdi", "mdi", axes_of(&f->s.v), &text };
        m->told_refused = d->refused;
        struct fault_report r = d->fault;
        r.line = d->refused;
        fmu_warn(f, "%s", fault_words(&named, &r).text);
    }
    if (m->pc.process.refusals != m->told_refusals) {
        const struct source text = source_of_program(f);
        const struct named_program named = { "program", f->s.v.program, axes_of(&f->s.v), &text };
        m->told_refusals = m->pc.process.refusals;
        fmu_warn(f, "the program is not started: %s",
                 fault_words(&named, &m->pc.process.refused).text);
    }
}

/* Write plan_file; the library is left at the end of the program. */
static int write_plan(struct fmu *f)
{
    const char *name = f->s.v.plan_file;
    const struct source source = source_of_program(f);
    const struct inputs inputs = inputs_of(f);
    const struct fmu_path path = fmu_path(f, name, FMU_WRITTEN);
    task_operate(&f->s.m.pc.mcc, false, f->s.v.override, f->s.v.override * f->s.v.rapid_override);
    char said[80];
    const struct plan_rows rows = { &f->s.m.pc.mcc, &source, said, sizeof said };
    const char *why = output_write(path.text, inputs.of, INPUTS, plan_fill, &rows);
    return why ? cannot_write(f, "plan_file", name, why) : 0;
}

static int model_start(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    const struct machine machine = machine_of(v);

    if (check_parameters(f)) {
        return -1;
    }
    if (set_out(f, &machine)) {
        return -1;
    }
    if (f->blob) {
        const struct source source = source_of_program(f);
        struct fault_list all;
        task_check_all(&m->pc.mcc, &source, &all);
        const struct named_program named = { "program", v->program, axes_of(v), &source };
        if (judge_program(f, &named, &all)) {
            return -1;
        }
        if (v->plan_file[0] && (write_plan(f) || set_out(f, &machine))) {
            return -1;
        }
    }
    m->bus = m->pc.config.bus * CLOCK_NS;
    fmu_event(f, "DDA time %.9g s", machine_dda_time(&machine));
    warn_of_cycle(f);
    publish(f);
    return 0;
}

/* Take the text of mdi when its number changes, as soon as there is room for it. */
static void take_lines(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;

    if (v->mdi_seq != m->taken && mdi_take(&m->pc.mcc, v->mdi, (int32_t)strlen(v->mdi))) {
        m->taken = v->mdi_seq;
        tell_refusals(f);
    }
}

/* Read the inputs at an instant of the bus grid and let the PC work. */
static void read_bus(struct fmu *f, int64_t at)
{
    const struct vars *v = &f->s.v;
    struct pc *pc = &f->s.m.pc;
    const struct source source = source_of_program(f);
    struct pc_panel panel = { .hold = v->hold,
                              .block_delete = v->block_delete,
                              .optional_stop = v->optional_stop,
                              .run_from = v->run_from,
                              .rapid = v->rapid_override,
                              .abort = v->abort,
                              .cycle_start = v->cycle_start,
                              .single_block = v->single_block,
                              .override = v->override,
                              .adaptive = v->adaptive_feed,
                              .go_home = v->go_home,
                              .jog_percent = 100.0 * v->jog_speed,
                              .wheel_axis = v->mpg_axis,
                              .wheel_encoder = v->mpg_encoder,
                              .wheel_ratio = v->mpg_ratio,
                              .clear_error = v->clear_error };
    memcpy(panel.software_gain, v->software_gain, sizeof panel.software_gain);
    memcpy(panel.p_gain, v->p_gain, sizeof panel.p_gain);
    memcpy(panel.jog, v->jog, sizeof panel.jog);
    memcpy(panel.jog_step, v->jog_step, sizeof panel.jog_step);
    struct link_card link;
#define READ(type, name, elements) LINK_CARRY(link.name, v->card_##name)
    LINK_SHOWN(READ)
    LINK_SHOWN_MACHINE(READ)
    card_signals(&link, &panel.signals);
    panel.signals.probe = v->probe_in;
    panel.signals.digital = (uint32_t)v->digital_in;
    memcpy(panel.signals.analog, v->analog_in, sizeof panel.signals.analog);
    const struct pcl_card card = card_of(&pc->pcl, &link);
    take_lines(f);
    pc_instant(pc, at / CLOCK_NS, &card, &panel, &source);
    tell_refusals(f);
}

/* Fail because the card has refused too many frames in a row: a full FIFO would have drained by
 * then, so the reason does not pass by itself. */
static int refused_by_card(struct fmu *f)
{
    const struct pcl *pcl = &f->s.m.pc.pcl;

    return fmu_fail(f,
                    "the card has refused every frame of %d transactions in a row, with %d "
                    "commands in the FIFO of axis %d: is every axis that is active here active "
                    "on the card?",
                    PCL_REFUSALS, (int)f->s.v.card_stock[pcl->axis], (int)pcl->axis + 1);
}

static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    struct model *m = &f->s.m;

    (void)t0;
    if (!(fabs(f->s.v.card_irq_clock) < FMU_TICKS_MAX)) {
        return fmu_fail(f, "card_irq_clock = %g is not a clock", f->s.v.card_irq_clock);
    }
    for (;;) {
        if (m->unpublished && m->instant <= t1) {
            publish(f);
            m->unpublished = false;
        }
        if (m->instant >= t1) {
            return 0;
        }
        read_bus(f, m->instant);
        if (m->pc.pcl.refusals >= PCL_REFUSALS) {
            return refused_by_card(f);
        }
        m->instant += m->bus;
        m->unpublished = true;
    }
}

/* Write the commands that have begun to path_file. */
static int model_end(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    const struct mcc *mcc = &f->s.m.pc.mcc;

    if (!v->path_file[0]) {
        return 0;
    }
    const struct source source = source_of_program(f);
    const struct program program = task_program(mcc, &source);
    struct interpreter in;
    const double zero[AXES] = { 0.0 };
    interpreter_start(&in, zero, mcc->machine.feed, mcc->offset);
    in.tools.table = mcc->tools;
    const struct inputs inputs = inputs_of(f);
    const struct fmu_path path = fmu_path(f, v->path_file, FMU_WRITTEN);
    const int32_t started = mcc->trajectory.started, last = mcc->first;
    const struct path_rows rows = { &in, &program, !mcc->begun || started < last ? started : last };
    const char *why = output_write(path.text, inputs.of, INPUTS, path_fill, &rows);
    return why ? cannot_write(f, "path_file", v->path_file, why) : 0;
}
