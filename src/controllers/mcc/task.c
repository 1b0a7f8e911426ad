#include "task.h"

#include <math.h>
#include <string.h>

#include "reaction.h"
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

/* Begin a program; what the program before has switched on stays on. */
static void begin(const struct mcc *m, struct interpreter *in)
{
    const struct switches switches = m->program.switches;
    const int32_t loaded = m->program.tools.loaded;
    interpreter_start(in, m->end, m->feed, m->offset);
    in->switches = switches;
    in->tools.table = m->tools;
    in->tools.loaded = loaded;
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
    begin(m, &in);
    interpreter_check(&in, &p, r);
    in_rpm(m, r);
}

void task_check_all(const struct mcc *m, const struct source *s, struct fault_list *all)
{
    const struct program p = task_program(m, s);
    struct interpreter in;
    begin(m, &in);
    interpreter_check_all(&in, &p, all);
    for (int i = 0; i < all->count; i++) {
        in_rpm(m, &all->of[i]);
    }
}

int task_start(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (m->error) {
        return MCC_RUN_TIME;
    }
    if (m->running || m->trajectory.abort || trajectory_ordered(&m->trajectory)) {
        return MCC_COMMAND_NOTACCEPTED;
    }
    begin(m, &m->program);
    m->running = true;
    trajectory_allow(&m->trajectory);
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

void task_operate(struct mcc *m, bool hold, double override)
{
    if (hold) {
        MCC_motion_hold(m);
    } else {
        MCC_motion_conti(m);
    }
    MCC_set_over_spd(m, 100.0 * override);
    MCC_set_ptp_ospd(m, 100.0 * override);
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
    return works(m) && m->running && !waiting_now(&m->program)
           && m->ring.count + (m->ring.head - head + RING_SIZE) % RING_SIZE < RING_SIZE;
}

bool task_can_read(const struct mcc *m)
{
    return has_room(m, m->ring.head);
}

void task_read(struct mcc *m, const struct source *s)
{
    const struct program p = task_program(m, s);
    struct command c;
    struct fault_report r;

    switch (interpreter_next(&m->program, &p, &c, &r)) {
    case INTERPRETER_COMMAND:
        c.index = command_lasts(&c) ? ++m->commands : 0;
        m->curve_plan.last = false;
        memcpy(m->end, m->program.point, sizeof m->end);
        ring_push(&m->ring, &c);
        break;
    case INTERPRETER_WAIT: break;
    case INTERPRETER_END:
        m->running = false;
        m->curve_plan.last = true;
        break;
    case INTERPRETER_FAULT: reaction_stop(m, reaction_error_of(&r)); break;
    }
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
    const struct trajectory before = m->trajectory;
    const int32_t head = m->ring.head, count = m->ring.count;
    struct point point;
    int32_t error;
    const struct trajectory_beside beside = mcc_beside(m);
    double left = frame;
    int made = 0;

    do {
        left = trajectory_advance(&m->trajectory, &beside, left);
        made += s ? refill(m, s, head) : 0;
    } while (left > 0.0 && !trajectory_resting(&m->trajectory, &m->ring));
    trajectory_point(&m->trajectory, &beside, &machine, frame, &point);
    if (!reaction_point(m, &machine, before.abort, &point, &error)) {
        m->trajectory = before;
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
