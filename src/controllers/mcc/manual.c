#include "manual.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "mcc.h"

/* Settings of asynchronous point-to-point. */

static int set_types(const struct mcc *m, char to[AXES], const char types[AXES])
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    for (int i = 0; i < AXES; i++) {
        if (types[i] != 'T' && types[i] != 'S') {
            return MCC_PARAMETER;
        }
    }
    memcpy(to, types, AXES);
    return MCC_NO_ERR;
}

static int set_times(const struct mcc *m, double to[AXES], const double ms[AXES])
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    for (int i = 0; i < AXES; i++) {
        if (!machine_positive(ms[i] / 1000.0)) {
            return MCC_PARAMETER;
        }
    }
    for (int i = 0; i < AXES; i++) {
        to[i] = ms[i] / 1000.0;
    }
    return MCC_NO_ERR;
}

static int get_types(const struct mcc *m, const char from[AXES], char types[AXES])
{
    memcpy(types, from, AXES);
    return m->open ? MCC_NO_ERR : MCC_INITIAL_MOTION;
}

static int get_times(const struct mcc *m, const double from[AXES], double ms[AXES])
{
    for (int i = 0; i < AXES; i++) {
        ms[i] = from[i] * 1000.0;
    }
    return m->open ? MCC_NO_ERR : MCC_INITIAL_MOTION;
}

int MCC_set_ptp_asyn_acc_type(struct mcc *m, const char types[AXES])
{
    return set_types(m, m->machine.asyn.acc_type, types);
}

int MCC_get_ptp_asyn_acc_type(const struct mcc *m, char types[AXES])
{
    return get_types(m, m->machine.asyn.acc_type, types);
}

int MCC_set_ptp_asyn_decc_type(struct mcc *m, const char types[AXES])
{
    return set_types(m, m->machine.asyn.dec_type, types);
}

int MCC_get_ptp_asyn_dec_type(const struct mcc *m, char types[AXES])
{
    return get_types(m, m->machine.asyn.dec_type, types);
}

int MCC_set_ptp_asyn_acc_step(struct mcc *m, const double ms[AXES])
{
    return set_times(m, m->machine.asyn.acc_time, ms);
}

int MCC_get_ptp_asyn_acc_step(const struct mcc *m, double ms[AXES])
{
    return get_times(m, m->machine.asyn.acc_time, ms);
}

int MCC_set_ptp_asyn_dec_step(struct mcc *m, const double ms[AXES])
{
    return set_times(m, m->machine.asyn.dec_time, ms);
}

int MCC_get_ptp_asyn_dec_step(const struct mcc *m, double ms[AXES])
{
    return get_times(m, m->machine.asyn.dec_time, ms);
}

/* Use of axes. */

int manual_allowed(const struct mcc *m)
{
    return !m->open              ? MCC_INITIAL_MOTION
           : m->error            ? MCC_RUN_TIME
           : m->trajectory.abort ? MCC_ABORT_NOT_FINISH
           : m->running || m->ring.count || m->trajectory.stopped || m->trajectory.confirming
                   || (trajectory_ordered(&m->trajectory) ? m->homing.state == HOMING_RUNS
                                                          : trajectory_busy(&m->trajectory))
               ? MCC_COMMAND_NOTFINISHED
               : MCC_NO_ERR;
}

void manual_use(struct mcc *m, int axis, enum manual_use use)
{
    if (!trajectory_ordered(&m->trajectory)) {
        memset(&m->manual, 0, sizeof m->manual);
        const struct mechanism machine = machine_mechanism(&m->machine);
        trajectory_order(&m->trajectory, &machine);
        if (m->homing.state == HOMING_RUNS) {
            m->homing.state = HOMING_NEVER; /* an abort has dropped that search */
        }
    }
    m->manual.axis[axis].use = use;
    m->manual.axis[axis].steps = false;
    m->moved = true;
}

static enum manual_use use_of(const struct mcc *m, int axis)
{
    return trajectory_ordered(&m->trajectory) ? m->manual.axis[axis].use : MANUAL_NONE;
}

static double place_of(const struct mcc *m, int axis)
{
    double place, speed;
    if (!trajectory_ordered(&m->trajectory)) {
        return m->trajectory.rest[axis];
    }
    axes_state(&m->trajectory.axes, axis, &place, &speed);
    return place;
}

static double pulses_of(const struct mcc *m, int axis)
{
    return round(place_of(m, axis) * machine_pulses_per_mm(&m->machine.axis[axis]));
}

/* True if the axis is on the limit switch of a direction. */
static bool on_limit(const struct mcc *m, int axis, double direction)
{
    return ((direction > 0.0 ? m->signals.upper : m->signals.lower) >> axis & 1) != 0;
}

/* MCC_NO_ERR if an axis can be moved by hand in a direction, of which 0 is none; else the code. */
static int movable(const struct mcc *m, int axis, double direction)
{
    const int code = manual_allowed(m);
    if (code) {
        return code;
    }
    if (axis < 0 || axis >= AXES || !m->machine.axis[axis].used) {
        return MCC_PARAMETER;
    }
    return direction != 0.0 && on_limit(m, axis, direction) ? MCC_COMMAND_NOTACCEPTED : MCC_NO_ERR;
}

/* Jog. */

static struct axes_limits jog_limits(const struct mcc *m, int axis, double percent)
{
    return machine_axis_limits(&m->machine, axis,
                               machine_axis_speed(&m->machine.axis[axis]) * percent / 100.0);
}

int MCC_jog_c(struct mcc *m, int axis, int direction, double percent)
{
    const int code = movable(m, axis, direction);

    if (code) {
        return code;
    }
    if (direction < -1 || direction > 1 || (direction != 0 && !machine_share(percent / 100.0))) {
        return MCC_PARAMETER;
    }
    if (use_of(m, axis) == MANUAL_WHEEL) {
        return MCC_COMMAND_NOTFINISHED;
    }
    if (direction == 0) {
        if (use_of(m, axis) == MANUAL_JOG) {
            axes_stand(&m->trajectory.axes, axis);
        }
        return MCC_NO_ERR;
    }
    manual_use(m, axis, MANUAL_JOG);
    const struct axes_limits l = jog_limits(m, axis, percent);
    axes_run(&m->trajectory.axes, axis, direction * l.speed, &l);
    return MCC_NO_ERR;
}

/* Let an axis go to a target [mm]. */
static int go(struct mcc *m, int axis, double target, const struct axes_limits *l)
{
    const double pulses = target * machine_pulses_per_mm(&m->machine.axis[axis]);
    if (!(fabs(pulses) < COMMAND_PULSES_MAX)) {
        return MCC_PARAMETER;
    }
    manual_use(m, axis, MANUAL_JOG);
    axes_go(&m->trajectory.axes, axis, target, l);
    return MCC_NO_ERR;
}

/* Jog an axis that stands to a target [mm]. */
static int step(struct mcc *m, int axis, double target, const struct axes_limits *l)
{
    const bool used = use_of(m, axis) != MANUAL_NONE;
    const double pulses = target * machine_pulses_per_mm(&m->machine.axis[axis]);

    return used && fabs(pulses) < COMMAND_PULSES_MAX ? MCC_COMMAND_NOTFINISHED
                                                     : go(m, axis, target, l);
}

int MCC_jog_i(struct mcc *m, int axis, double distance, double percent)
{
    const int code = movable(m, axis, distance);
    if (code) {
        return code;
    }
    if (!machine_share(percent / 100.0)) {
        return MCC_PARAMETER;
    }
    const struct axes_limits l = jog_limits(m, axis, percent);
    return step(m, axis, place_of(m, axis) + distance, &l);
}

int MCC_jog_s(struct mcc *m, int axis, int32_t pulses)
{
    const int code = movable(m, axis, pulses);
    if (code) {
        return code;
    }
    const struct axes_limits l =
        machine_axis_limits(&m->machine, axis, machine_ptp_speed(&m->machine, axis));
    return step(m, axis,
                (pulses_of(m, axis) + pulses) / machine_pulses_per_mm(&m->machine.axis[axis]), &l);
}

/* The software limit of a direction. [mm] */
static double limit_of(const struct machine_axis *a, double direction)
{
    return direction > 0.0 ? machine_high(a) : machine_low(a);
}

int manual_jog(struct mcc *m, int axis, int direction, double percent)
{
    const bool limited = axis >= 0 && axis < AXES && m->machine.axis[axis].check_ot;

    if (!limited || (direction != -1 && direction != 1) || !machine_share(percent / 100.0)
        || use_of(m, axis) == MANUAL_WHEEL) {
        return MCC_jog_c(m, axis, direction, percent);
    }
    const int code = movable(m, axis, direction);
    const double limit = limit_of(&m->machine.axis[axis], direction);
    if (code || direction * (limit - place_of(m, axis)) <= 0.0) {
        return code ? code : MCC_COMMAND_NOTACCEPTED;
    }
    const struct axes_limits l = jog_limits(m, axis, percent);
    return go(m, axis, limit, &l);
}

int manual_step(struct mcc *m, int axis, double distance, double percent)
{
    const int code = movable(m, axis, distance);
    if (code) {
        return code;
    }
    const bool on = use_of(m, axis) == MANUAL_JOG && m->manual.axis[axis].steps;
    if (!machine_share(percent / 100.0)) {
        return MCC_PARAMETER;
    }
    if (use_of(m, axis) != MANUAL_NONE && !on) {
        return MCC_COMMAND_NOTFINISHED;
    }
    const struct machine_axis *a = &m->machine.axis[axis];
    const double target = (on ? m->trajectory.axes.axis[axis].goal : place_of(m, axis)) + distance;
    const double over = (target - limit_of(a, distance)) * (distance > 0.0 ? 1.0 : -1.0);
    if (a->check_ot && over * machine_pulses_per_mm(a) >= 0.5) {
        return MCC_COMMAND_NOTACCEPTED;
    }
    const struct axes_limits l = jog_limits(m, axis, percent);
    const int done = go(m, axis, target, &l);
    m->manual.axis[axis].steps = done == MCC_NO_ERR || on;
    return done;
}

/* Hand wheel. */

static int32_t counter(const struct mcc *m, int encoder)
{
    return encoder < AXES ? m->signals.enc[encoder] : m->signals.enc_aux[encoder - AXES];
}

/* From now on the axis counts the wheel's motion from where both are. */
static void rebase(struct mcc *m, int axis)
{
    struct manual_axis *w = &m->manual.axis[axis];
    w->count = counter(m, w->encoder);
    w->turned = 0;
    w->base = (int32_t)pulses_of(m, axis);
}

int MCC_MPG_set(struct mcc *m, int axis, int encoder, double ratio)
{
    const int code = movable(m, axis, 0.0);

    if (code) {
        return code;
    }
    if (encoder < 0 || encoder >= MANUAL_ENCODERS || encoder == axis || !isfinite(ratio)) {
        return MCC_PARAMETER;
    }
    if (use_of(m, axis) != MANUAL_NONE) {
        return MCC_COMMAND_NOTFINISHED;
    }
    manual_use(m, axis, MANUAL_WHEEL);
    m->manual.axis[axis].encoder = encoder;
    m->manual.axis[axis].ratio = ratio;
    m->manual.axis[axis].rests = false;
    rebase(m, axis);
    return MCC_NO_ERR;
}

int manual_follow(struct mcc *m, int axis, int encoder, double ratio)
{
    const int code = MCC_MPG_set(m, axis, encoder, ratio);
    if (code == MCC_NO_ERR) {
        m->manual.axis[axis].rests = true;
    }
    return code;
}

int MCC_MPG_disable(struct mcc *m)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    for (int i = 0; i < AXES; i++) {
        if (use_of(m, i) == MANUAL_WHEEL) {
            m->manual.axis[i].use = MANUAL_JOG;
            axes_stand(&m->trajectory.axes, i);
        }
    }
    return MCC_NO_ERR;
}

bool manual_wheel(const struct mcc *m)
{
    bool on = false;
    for (int i = 0; i < AXES; i++) {
        on = on || use_of(m, i) == MANUAL_WHEEL;
    }
    return on;
}

/* The pulse nearest to one that the software limits of an axis leave open, from where it is. */
static double inside(const struct mcc *m, int axis, double pulse)
{
    const struct machine_axis *a = &m->machine.axis[axis];
    const double scale = machine_pulses_per_mm(a), at = pulses_of(m, axis);
    const double high = el_max(round(machine_high(a) * scale), at);
    const double low = el_min(round(machine_low(a) * scale), at);
    return el_max(low, el_min(high, pulse));
}

/* True if the axis is to come to rest before it goes to a target, behind which it would stop. A
 * plan that turns round brakes by the smaller of acceleration and deceleration, which may be too
 * little at a software limit. */
static bool stops_first(struct mcc *m, int axis, double target)
{
    struct axes *a = &m->trajectory.axes;
    double place, speed;

    if (axes_rests(a, axis)) {
        return false;
    }
    if (a->axis[axis].order != AXES_STAND) {
        axes_stand(a, axis);
    }
    axes_state(a, axis, &place, &speed);
    return (target - a->axis[axis].side * a->axis[axis].plan.s1) * speed < 0.0;
}

/* Follow the wheel: to the pulse base + ratio * counts, or no further onto a limit switch. */
static void follow(struct mcc *m, int axis)
{
    struct manual_axis *w = &m->manual.axis[axis];
    const int32_t now = counter(m, w->encoder);
    const double scale = machine_pulses_per_mm(&m->machine.axis[axis]);

    w->turned += (int32_t)((uint32_t)now - (uint32_t)w->count);
    w->count = now;
    const double asked = round(w->base + w->ratio * (double)w->turned);
    const bool rests = w->rests && m->machine.axis[axis].check_ot;
    double want = el_max(-COMMAND_PULSES_MAX, el_min(COMMAND_PULSES_MAX, asked));
    if (rests && inside(m, axis, want) != want) {
        want = inside(m, axis, want);
        w->base = (int32_t)want;
        w->turned = 0;
    }
    const double target = want / scale;
    if (target != place_of(m, axis) && on_limit(m, axis, target - place_of(m, axis))) {
        axes_stand(&m->trajectory.axes, axis);
        rebase(m, axis);
    } else if (m->trajectory.axes.axis[axis].order != AXES_GO
               || m->trajectory.axes.axis[axis].goal != target) {
        const struct axes_limits l =
            machine_axis_limits(&m->machine, axis, machine_ptp_speed(&m->machine, axis));
        if (rests && stops_first(m, axis, target)) {
            return;
        }
        axes_go(&m->trajectory.axes, axis, target, &l);
    }
}

/* A jogged axis stops at a limit switch, and before its counter overflows. */
static void guard(struct mcc *m, int axis)
{
    double place, speed;
    axes_state(&m->trajectory.axes, axis, &place, &speed);
    const bool far = fabs(pulses_of(m, axis)) > COMMAND_PULSES_MAX && speed * place > 0.0;
    if (m->trajectory.axes.axis[axis].order != AXES_STAND && speed != 0.0
        && (far || on_limit(m, axis, speed))) {
        axes_stand(&m->trajectory.axes, axis);
    }
}

void manual_look(struct mcc *m)
{
    if (!trajectory_ordered(&m->trajectory) || m->trajectory.abort) {
        return;
    }
    for (int i = 0; i < AXES; i++) {
        switch (m->manual.axis[i].use) {
        case MANUAL_JOG:   guard(m, i); break;
        case MANUAL_WHEEL: follow(m, i); break;
        default:           break;
        }
    }
}

void manual_end(struct mcc *m)
{
    bool used = false;

    if (!trajectory_ordered(&m->trajectory)) {
        return;
    }
    for (int i = 0; i < AXES; i++) {
        struct manual_axis *a = &m->manual.axis[i];
        if (a->use == MANUAL_JOG && axes_done(&m->trajectory.axes, i)) {
            a->use = MANUAL_NONE;
        }
        used = used || a->use != MANUAL_NONE;
    }
    if (!used) {
        trajectory_bind(&m->trajectory);
        memcpy(m->end, m->trajectory.rest, sizeof m->end);
    }
}
