#include "homing.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "mcc.h"

static double scale(const struct mcc *m, int i)
{
    return machine_pulses_per_mm(&m->machine.axis[i]);
}

int homing_set(struct mcc *m, int axis, const struct home_config *config, bool inverted)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (trajectory_ordered(&m->trajectory) && m->homing.state == HOMING_RUNS) {
        return MCC_COMMAND_NOTFINISHED;
    }
    if (axis < 0 || axis >= AXES || !home_valid(config)
        || el_max(config->high_speed, config->low_speed)
               > machine_axis_speed(&m->machine.axis[axis])) {
        return MCC_PARAMETER;
    }
    struct homing_axis *x = &m->homing.axis[axis];
    x->config = *config;
    x->config.offset = round(config->offset * scale(m, axis)) / scale(m, axis);
    x->inverted = inverted;
    mcc_param_home(m, axis);
    return MCC_NO_ERR;
}

int homing_set_settle(struct mcc *m, double seconds)
{
    if (!m->open) {
        return MCC_INITIAL_MOTION;
    }
    if (!(seconds >= 0.0 && seconds < 1e6)) {
        return MCC_PARAMETER;
    }
    m->homing.settle = (int64_t)llround(seconds * CLOCK_HZ);
    return MCC_NO_ERR;
}

double homing_place(const struct mcc *m, int i, int32_t count)
{
    const struct homing_axis *x = &m->homing.axis[i];
    const int32_t from_zero = (int32_t)((uint32_t)count - (uint32_t)x->zero);
    return (x->inverted ? -1.0 : 1.0) * from_zero / scale(m, i);
}

/* True if the axis is at rest: by its plan, and for the time `settle` by its encoder too. */
static bool rests(const struct mcc *m, int i)
{
    return axes_rests(&m->trajectory.axes, i) && m->homing.axis[i].clocks >= m->homing.settle;
}

/* Measure for how long the encoder has stood still, with every point in the card. */
static void watch(struct mcc *m, int i, int64_t clocks)
{
    struct homing_axis *x = &m->homing.axis[i];
    const int32_t moved = (int32_t)((uint32_t)m->signals.enc[i] - (uint32_t)x->still);

    if (!axes_rests(&m->trajectory.axes, i) || m->written.pulses[i] != m->trajectory.pulses[i]
        || moved < -1 || moved > 1) {
        x->still = m->signals.enc[i];
        x->clocks = 0;
    } else {
        x->clocks += clocks;
    }
}

static struct home_inputs inputs(const struct mcc *m, int i)
{
    const struct homing_axis *x = &m->homing.axis[i];
    double place, speed;

    axes_state(&m->trajectory.axes, i, &place, &speed);
    return (struct home_inputs){ .sensor = (m->signals.home >> i & 1) != 0,
                                 .upper = (m->signals.upper >> i & 1) != 0,
                                 .lower = (m->signals.lower >> i & 1) != 0,
                                 .rest = rests(m, i),
                                 .position = x->home.phase == HOME_GO
                                                 ? place
                                                 : homing_place(m, i, m->signals.enc[i]),
                                 .latched = m->signals.latched[i] != x->latched,
                                 .latch = homing_place(m, i, m->signals.latch[i]) };
}

/* Give an order of the search to the trajectory's axis, if it is a new one. */
static void obey(struct mcc *m, int i, const struct home_order *o)
{
    struct homing_axis *x = &m->homing.axis[i];
    struct axes *axes = &m->trajectory.axes;
    struct axes_limits l = machine_axis_limits(&m->machine, i, x->config.high_speed);

    if (o->arm) {
        x->latched = m->signals.latched[i];
        m->latch_seq[i] = (int32_t)((uint32_t)m->latch_seq[i] + 1u);
    }
    if (o->what == x->order.what && o->speed == x->order.speed
        && (o->what != HOME_MOVE || o->target == x->order.target)) {
        return;
    }
    x->order = *o;
    if (o->what == HOME_RUN) {
        axes_run(axes, i, o->speed, &l);
    } else if (o->what == HOME_MOVE) {
        l.speed = o->speed;
        axes_go(axes, i, o->target, &l);
    } else {
        axes_stand(axes, i);
    }
}

/* Begin the search of the axes with the next order; false if there is none. */
static bool next_group(struct mcc *m)
{
    struct homing *h = &m->homing;
    int32_t next = INT32_MAX;

    for (int i = 0; i < AXES; i++) {
        if (h->order[i] > h->group && h->order[i] < next) {
            next = h->order[i];
        }
    }
    for (int i = 0; i < AXES && next < INT32_MAX; i++) {
        struct homing_axis *x = &h->axis[i];
        if (h->order[i] == next) {
            x->order = (struct home_order){ HOME_STAND, 0.0, 0.0, false };
            x->latched = m->signals.latched[i];
            x->still = m->signals.enc[i];
            x->clocks = 0;
            memset(&x->home, 0, sizeof x->home);
            const struct home_inputs in = inputs(m, i);
            home_start(&x->home, &x->config, &in);
        }
    }
    h->group = next;
    return next < INT32_MAX;
}

static int check_order(const struct mcc *m, const int32_t order[AXES])
{
    bool any = false;

    for (int i = 0; i < AXES; i++) {
        if (order[i] < 0 || order[i] == INT32_MAX
            || (order[i] > 0
                && !(m->machine.axis[i].used && home_valid(&m->homing.axis[i].config)))) {
            return MCC_PARAMETER;
        }
        any = any || order[i] > 0;
    }
    return any ? MCC_NO_ERR : MCC_PARAMETER;
}

int MCC_go_home(struct mcc *m, const int32_t order[AXES])
{
    const int code = manual_allowed(m);
    const int bad = code ? code : check_order(m, order);

    if (bad) {
        return bad;
    }
    if (trajectory_ordered(&m->trajectory)) {
        return MCC_COMMAND_NOTFINISHED;
    }
    if (m->dry_run) {
        return MCC_COMMAND_NOTACCEPTED; /* nothing would be found */
    }
    for (int i = 0; i < AXES; i++) {
        if (order[i] > 0) {
            manual_use(m, i, MANUAL_HOME);
        }
    }
    memcpy(m->homing.order, order, sizeof m->homing.order);
    m->homing.state = HOMING_RUNS;
    m->homing.group = 0;
    next_group(m);
    return MCC_NO_ERR;
}

int MCC_check_homef(const struct mcc *m)
{
    switch (m->homing.state) {
    case HOMING_RUNS:   return trajectory_ordered(&m->trajectory) ? 0 : MCC_HOME_COMMAND_NOTCALLED;
    case HOMING_DONE:   return 1;
    case HOMING_FAILED: return MCC_RUN_TIME;
    default:            return MCC_HOME_COMMAND_NOTCALLED;
    }
}

static void fail(struct mcc *m, int i, enum home_fault fault)
{
    m->error = MCC_ERROR_HOME + 16 * (int32_t)fault + i + 1;
    m->homing.state = HOMING_FAILED;
    trajectory_abort(&m->trajectory, &m->ring);
    control_settle(m);
}

/* All axes stand at their origins and the card has every point: this position is 0 from now on. */
static void set_origin(struct mcc *m)
{
    trajectory_bind(&m->trajectory);
    memcpy(m->end, m->trajectory.rest, sizeof m->end);
    for (int i = 0; i < AXES; i++) {
        struct homing_axis *x = &m->homing.axis[i];
        if (m->homing.order[i] > 0) {
            const uint32_t counts = (uint32_t)m->trajectory.pulses[i];
            x->zero = (int32_t)((uint32_t)x->zero + (x->inverted ? 0u - counts : counts));
            m->protection.base[i] -= m->trajectory.pulses[i];
            m->trajectory.pulses[i] = m->written.pulses[i] = 0;
            m->trajectory.rest[i] = m->written.place[i] = m->end[i] = 0.0;
        }
    }
    m->homing.state = HOMING_DONE;
}

void homing_look(struct mcc *m, int64_t clocks)
{
    struct homing *h = &m->homing;
    bool done = true;

    if (!trajectory_ordered(&m->trajectory) || m->trajectory.abort || h->state != HOMING_RUNS) {
        return;
    }
    for (int i = 0; i < AXES; i++) {
        struct homing_axis *x = &h->axis[i];
        if (h->order[i] != h->group) {
            continue;
        }
        watch(m, i, clocks);
        const struct home_inputs in = inputs(m, i);
        const struct home_order order = home_step(&x->home, &x->config, &in);
        if (x->home.phase == HOME_FAILED) {
            fail(m, i, x->home.fault);
            return;
        }
        obey(m, i, &order);
        done = done && x->home.phase == HOME_DONE;
    }
    if (done && !next_group(m) && m->queue.count == 0) {
        set_origin(m);
    }
}
