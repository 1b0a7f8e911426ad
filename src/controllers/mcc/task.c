#include "task.h"

#include <math.h>
#include <string.h>

#include "reaction.h"
#include "resuming.h"
#include "switching.h"
#include "waiting.h"

struct program task_program(const struct mcc *m, const struct source *s)
{
    return (struct program){ .source = s,
                             .machine = machine_mechanism(&m->machine),
                             .limits = machine_limits(&m->machine),
                             .arc = { m->machine.arc_tolerance, 1e-3 },
                             .block_delete = m->block_delete,
                             .optional_stop = m->optional_stop,
                             .change_stops = m->change_stops,
                             .has_inputs = true,
                             .has_probe = true,
                             .angles = m->dialect.angles,
                             .fanuc = m->dialect.fanuc,
                             .strict_feed = m->dialect.strict_feed,
                             .least_increment = m->dialect.least_increment };
}

/* Make *in the state in which reading goes on with another text. At first it is that of a start,
 * with what commands of the API have switched on; later what the text before has left. */
static void begin(const struct mcc *m, struct interpreter *in)
{
    if (m->begun) {
        if (in != &m->program) {
            *in = m->program;
        }
        return;
    }
    const struct switches switches = m->program.switches;
    const int32_t loaded = m->program.tools.loaded;
    interpreter_start(in, m->end, m->feed, m->offset);
    in->switches = switches;
    in->tools.table = m->tools;
    in->tools.loaded = loaded;
}

/* The same at the first line of a program, where the latest command ends. */
static void begin_program(const struct mcc *m, struct interpreter *in)
{
    begin(m, in);
    resuming_text(in, 0, 0);
    resuming_place(in, m->end);
}

void task_resume(struct mcc *m, bool by_hand)
{
    struct interpreter *in = &m->program;
    const bool rests = m->ring.count == 0 && !trajectory_busy(&m->trajectory);

    control_settle(m);
    if (!by_hand) {
        begin_program(m, in);
    } else if (!m->begun || !m->mdi.on || m->dropped) {
        begin(m, in);
        resuming_text(in, m->mdi.until, m->mdi.line);
    }
    if (by_hand && rests && (m->dropped || m->moved || !resuming_held(in))) {
        resuming_place(in, m->end);
    }
    m->first = m->begun ? m->first : by_hand ? 0 : INT32_MAX;
    readout_note(m);
    m->mdi.on = by_hand;
    m->begun = true;
    m->dropped = m->moved = false;
    if (rests || !by_hand) {
        trajectory_allow(&m->trajectory);
    }
}

void task_drop(struct mcc *m)
{
    mdi_drop(&m->mdi);
    m->running = false;
    if (m->begun && !m->dropped) {
        resuming_defaults(&m->program, m->feed);
    }
    m->first = m->first == INT32_MAX ? m->commands : m->first;
    m->dropped = true;
    readout_start(m);
}

/* A fault of the speed of a motor is reported in rpm. */
static void in_rpm(const struct mcc *m, struct fault_report *r)
{
    if (r->fault == FAULT_SPEED) {
        r->value *= m->machine.axis[r->axis].rpm;
        r->limit *= m->machine.axis[r->axis].rpm;
        r->axis = 0;
    }
}

void task_check(const struct mcc *m, const struct source *s, struct fault_report *r)
{
    const struct program p = task_program(m, s);
    struct interpreter in;
    begin_program(m, &in);
    interpreter_check(&in, &p, r);
    in_rpm(m, r);
}

void task_check_all(const struct mcc *m, const struct source *s, struct fault_list *all)
{
    const struct program p = task_program(m, s);
    struct interpreter in;
    begin_program(m, &in);
    interpreter_check_all(&in, &p, all);
    for (int i = 0; i < all->count; i++) {
        in_rpm(m, &all->of[i]);
    }
}

/* MCC_NO_ERR if a program can be started, else the code that refuses it. */
static int startable(const struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (m->error) {
        return MCC_RUN_TIME;
    }
    if (m->running || mdi_waits(&m->mdi) || m->trajectory.abort
        || trajectory_ordered(&m->trajectory)) {
        return MCC_COMMAND_NOTACCEPTED;
    }
    return MCC_NO_ERR;
}

int task_start(struct mcc *m)
{
    const int code = startable(m);

    if (code == MCC_NO_ERR) {
        task_resume(m, false);
        m->running = true;
    }
    return code;
}

/* Read up to a line without any motion: only outputs are left of what was read, as one command, and
 * the axes are where they were. */
static enum fault skip(struct interpreter *in, const struct program *read, int32_t from,
                       struct fault_report *r)
{
    const struct switches before = in->switches;
    const int32_t loaded = in->tools.loaded;
    struct program p = *read;
    enum interpreter_result got;
    struct command c;
    double here[AXES];

    p.upto = from;
    memcpy(here, in->point, sizeof here);
    while ((got = interpreter_read(in, &p, &c, r)) != INTERPRETER_LINES) {
        if (got == INTERPRETER_FAULT || in->flow.again > FLOW_AGAIN) {
            return got == INTERPRETER_FAULT ? r->fault : FAULT_ENDLESS;
        }
        if (got == INTERPRETER_END) {
            return FAULT_FROM_LINE;
        }
        if (got == INTERPRETER_WAIT) {
            waiting_pass(in);
        }
    }
    if (resuming_held(in)) {
        return FAULT_FROM_HELD;
    }
    resuming_place(in, here);
    if (in->tools.loaded != loaded) {
        switching_make(in, 0, 0);
    } else {
        switching_differs(in, &before);
    }
    return FAULT_NONE;
}

int task_start_at(struct mcc *m, const struct source *s, int32_t from, struct fault_report *r)
{
    const struct program p = task_program(m, s);
    const int code = startable(m);
    struct interpreter in;

    memset(r, 0, sizeof *r);
    if (code) {
        return code;
    }
    begin_program(m, &in);
    const enum fault f = from > 1 ? skip(&in, &p, from, r) : FAULT_NONE;
    if (f == FAULT_NONE) {
        interpreter_check(&in, &p, r);
        in_rpm(m, r);
    } else if (f == FAULT_FROM_LINE || f == FAULT_FROM_HELD) {
        memset(r, 0, sizeof *r);
        r->line = from;
    }
    r->fault = f != FAULT_NONE ? f : r->fault;
    if (r->fault != FAULT_NONE) {
        return MCC_PARAMETER;
    }
    task_start(m);
    if (from > 1) {
        m->program = in;
        readout_note(m);
        m->first = m->first == INT32_MAX ? m->commands : m->first;
    }
    return MCC_NO_ERR;
}

int task_set_origin(struct mcc *m, int system, const double origin[AXES])
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (m->running) {
        return MCC_COMMAND_NOTFINISHED;
    }
    if (system < 1 || system > INTERPRETER_SYSTEMS) {
        return MCC_PARAMETER;
    }
    for (int i = 0; i < AXES; i++) {
        if (!isfinite(origin[i])) {
            return MCC_PARAMETER;
        }
    }
    memcpy(m->offset[system - 1], origin, sizeof m->offset[system - 1]);
    memcpy(m->program.origin[system - 1], origin, sizeof m->offset[system - 1]);
    readout_note(m);
    return MCC_NO_ERR;
}

void task_set_switches(struct mcc *m, bool block_delete, bool optional_stop)
{
    m->block_delete = block_delete;
    m->optional_stop = optional_stop;
}

void task_set_tools(struct mcc *m, const struct tool_table *tools, bool change_stops)
{
    m->tools = *tools;
    m->program.tools.table = *tools;
    m->change_stops = change_stops;
}

void task_set_dialect(struct mcc *m, const struct mcc_dialect *d)
{
    m->dialect = *d;
}

int task_set_single_block(struct mcc *m, bool on)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    const struct trajectory_beside beside = mcc_beside(m);
    trajectory_single(&m->trajectory, &beside, on);
    return MCC_NO_ERR;
}

int task_continue(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (!trajectory_waits(&m->trajectory, &m->ring) || m->trajectory.untold || m->queue.count > 0) {
        return MCC_CONTI_ILLEGAL;
    }
    trajectory_continue(&m->trajectory);
    return MCC_NO_ERR;
}

void task_operate(struct mcc *m, bool hold, double feed, double ptp)
{
    if (hold) {
        MCC_motion_hold(m);
    } else {
        MCC_motion_conti(m);
    }
    MCC_set_over_spd(m, 100.0 * feed);
    MCC_set_ptp_ospd(m, 100.0 * ptp);
}

/* True if the library is open and no emergency stop holds it. */
static bool works(const struct mcc *m)
{
    return m->open && m->error != MCC_ERROR_STOP;
}

/* True if a command can be read into the ring, with the commands kept that have left it since its
 * head was `head`: task_point may need them again. */
static bool has_room(const struct mcc *m, int32_t head)
{
    return works(m) && m->running && !m->mdi.refuses && !waiting_now(&m->program)
           && m->ring.count + (m->ring.head - head + RING_SIZE) % RING_SIZE < RING_SIZE;
}

bool task_can_read(const struct mcc *m)
{
    return has_room(m, m->ring.head);
}

/* The text has ended, or M2 or M30 of a line by hand. */
static void end(struct mcc *m)
{
    m->curve_plan.last = true;
    resuming_end(&m->program, m->feed);
    m->program.ended = !m->mdi.on;
    if (m->mdi.on) {
        mdi_read(m);
    } else {
        m->running = false;
        m->first = m->first == INT32_MAX ? m->commands : m->first;
    }
}

void task_read(struct mcc *m, const struct source *s)
{
    struct mdi_view lines = { &m->mdi, s };
    const struct source by_hand = mdi_source(&lines);
    struct program p = task_program(m, m->mdi.on ? &by_hand : s);
    struct command c;
    struct fault_report r;

    p.by_hand = m->mdi.on;
    if (p.by_hand && !mdi_next(m, &p)) {
        return;
    }
    switch (interpreter_next(&m->program, &p, &c, &r)) {
    case INTERPRETER_COMMAND:
        c.index = command_lasts(&c) ? ++m->commands : 0;
        c.line = p.by_hand ? -c.line : c.line;
        m->curve_plan.last = false;
        memcpy(m->end, m->program.point, sizeof m->end);
        ring_push(&m->ring, &c);
        break;
    case INTERPRETER_WAIT:  break;
    case INTERPRETER_LINES: mdi_read(m); break;
    case INTERPRETER_END:   end(m); break;
    case INTERPRETER_FAULT: reaction_stop(m, reaction_error_of(&r)); return;
    }
    readout_note(m);
}

/* Read commands while there is room for them. Returns how often it read. */
static int refill(struct mcc *m, const struct source *s, int32_t head)
{
    int made = 0;

    while (has_room(m, head)) {
        task_read(m, s);
        made++;
    }
    return made;
}

int task_read_all(struct mcc *m, const struct source *s)
{
    return refill(m, s, m->ring.head);
}

bool task_can_point(const struct mcc *m)
{
    return works(m) && m->queue.count < m->machine.queue_depth
           && (m->trajectory.untold || compensate_due(m)
               || !trajectory_resting(&m->trajectory, &m->ring));
}

int task_point(struct mcc *m, const struct source *s)
{
    const struct mechanism machine = machine_mechanism(&m->machine);
    const double frame = machine_dda_time(&m->machine);
    const bool ramping = m->trajectory.abort;
    const int32_t head = m->ring.head, count = m->ring.count;
    struct point point;
    int32_t error;
    const struct trajectory_beside beside = mcc_beside(m);
    struct trajectory before;
    double left = frame;
    int made = 0;

    trajectory_copy(&before, &m->trajectory);
    do {
        left = trajectory_advance(&m->trajectory, &beside, left);
        made += s ? refill(m, s, head) : 0;
    } while (left > 0.0 && !trajectory_resting(&m->trajectory, &m->ring));
    trajectory_point(&m->trajectory, &beside, &machine, frame, &point);
    if (!reaction_point(m, &machine, ramping, &point, &error)) {
        trajectory_copy(&m->trajectory, &before);
        m->ring.head = head;
        m->ring.count = count;
        reaction_stop(m, error);
        return made;
    }
    trajectory_accept(&m->trajectory, &beside, &point);
    queue_push(&m->queue, &point);
    return made;
}

void task_settle(struct mcc *m)
{
    if (!works(m)) {
        return;
    }
    if (trajectory_resting(&m->trajectory, &m->ring) && !compensate_due(m)) {
        memset(m->protection.frame, 0, sizeof m->protection.frame);
    }
    control_settle(m);
    manual_end(m);
}

void task_run(struct mcc *m, const struct source *s)
{
    task_read_all(m, s);
    while (task_can_point(m)) {
        task_point(m, s);
    }
    task_settle(m);
}

bool task_moving(const struct mcc *m)
{
    return trajectory_moving(&m->trajectory);
}

enum task_status task_status(const struct mcc *m)
{
    if (MCC_check_stop(m)) {
        return TASK_STOPPED;
    }
    if ((trajectory_held(&m->trajectory) || m->trajectory.stopped) && m->queue.count == 0
        && !m->trajectory.untold && trajectory_resting(&m->trajectory, &m->ring)) {
        return TASK_HOLD;
    }
    if (trajectory_waits(&m->trajectory, &m->ring) && m->queue.count == 0
        && !m->trajectory.untold) {
        return TASK_BLOCK_HOLD;
    }
    return manual_wheel(m)                        ? TASK_WHEEL
           : m->written.waits || m->inquiry.waits ? TASK_DELAY
                                                  : TASK_RUNNING;
}
