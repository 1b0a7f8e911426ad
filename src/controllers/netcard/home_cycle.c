#include "home_cycle.h"

#include <stdlib.h>
#include <string.h>

bool home_cycle_on_level(enum card_trigger trigger)
{
    return trigger == CARD_RISING || trigger == CARD_HIGH;
}

static bool by_edge(enum card_trigger trigger)
{
    return trigger == CARD_RISING || trigger == CARD_FALLING;
}

static bool between(double value, double low, double high)
{
    return value >= low && value <= high;
}

/* CCN 17: a row of limits that all must hold. */
bool home_cycle_valid(const struct home_cycle_config *c)
{
    enum { LONGEST = 2000000000 };
    bool ok = between(c->period, 1e-6, 1.0) && c->settle >= 1 && c->settle <= LONGEST;

    for (int i = 0; ok && i < CARD_AXES; i++) {
        const struct home_axis *a = &c->axis[i];
        ok = a->order >= 0 && a->order <= CARD_AXES && (int)a->trigger >= CARD_RISING
             && a->trigger <= CARD_LOW && between(a->fast * c->period, 1e-6, INT16_MAX - 1)
             && between(a->slow * c->period, 1e-6, INT16_MAX - 1) && between(a->acc, 1.0, 1e12)
             && between(a->start, 0.0, 1e9) && a->back > 0 && a->back <= LONGEST && a->travel > 0
             && a->travel <= LONGEST && abs(a->offset) <= LONGEST;
    }
    return ok;
}

static double way(const struct home_axis *a)
{
    return a->plus ? 1.0 : -1.0;
}

static bool on(const struct home_cycle *h, int i, const struct home_cycle_input *in)
{
    return (in->origin >> i & 1) == home_cycle_on_level(h->config.axis[i].trigger);
}

static bool limit(const struct home_cycle_input *in, int i, double direction)
{
    return ((direction > 0.0 ? in->plus : in->minus) >> i & 1) != 0;
}

static void enter(struct home_search *c, enum home_cycle_phase phase)
{
    c->phase = phase;
    c->begin = c->motion.commanded;
    c->stopping = c->passed = c->off = false;
}

static void fail(struct home_cycle *h, int axis, enum home_cycle_fault fault)
{
    if (h->fault == HOME_CYCLE_OK) {
        h->fault = fault;
        h->fault_axis = axis;
    }
    h->state = HOME_CYCLE_STOPPING;
}

/* Begin the search of the axes with the next higher order. */
static void next_order(struct home_cycle *h, const struct home_cycle_input *in)
{
    int32_t next = INT32_MAX;

    for (int i = 0; i < CARD_AXES; i++) {
        const int32_t order = h->config.axis[i].order;
        if ((h->mask >> i & 1) != 0 && order > h->order && order < next) {
            next = order;
        }
    }
    h->order = next;
    h->state = next < INT32_MAX ? HOME_CYCLE_RUNNING : HOME_CYCLE_ENDED;
    for (int i = 0; i < CARD_AXES; i++) {
        if ((h->mask >> i & 1) != 0 && h->config.axis[i].order == next) {
            enter(&h->axis[i], on(h, i, in) ? HOME_CYCLE_BACK : HOME_CYCLE_SEARCH);
        }
    }
}

void home_cycle_begin(struct home_cycle *h, const struct home_cycle_config *config, uint32_t mask,
                      const struct home_cycle_input *in)
{
    memset(h, 0, sizeof *h);
    h->config = *config;
    h->fault_axis = -1;
    for (int i = 0; i < CARD_AXES; i++) {
        h->axis[i].motion.commanded = in->position[i];
        h->mask |= config->axis[i].order > 0 ? mask & (uint32_t)1 << i : 0;
    }
    next_order(h, in);
}

void home_cycle_stop(struct home_cycle *h)
{
    if (h->state == HOME_CYCLE_RUNNING) {
        h->state = HOME_CYCLE_STOPPING;
    }
}

int64_t home_cycle_zero(const struct home_cycle *h, int axis)
{
    return h->axis[axis].place;
}

static void search(struct home_cycle *h, int i, const struct home_cycle_input *in, bool seen)
{
    struct home_search *c = &h->axis[i];

    if (seen) {
        c->stopping = true;
    } else if (limit(in, i, way(&h->config.axis[i]))) {
        if (c->turned) {
            fail(h, i, HOME_CYCLE_NO_ORIGIN);
        } else {
            c->turned = true;
            enter(c, HOME_CYCLE_TURN);
        }
    }
}

static void turn(struct home_cycle *h, int i, const struct home_cycle_input *in, bool seen)
{
    struct home_search *c = &h->axis[i];

    c->passed = c->passed || seen;
    if (c->passed && !on(h, i, in)) {
        c->stopping = true;
    } else if (limit(in, i, -way(&h->config.axis[i]))) {
        fail(h, i, HOME_CYCLE_NO_ORIGIN);
    }
}

/* Phase 2. An axis that ran over the switch before it came to rest comes onto it once more. */
static void back(struct home_cycle *h, int i, const struct home_cycle_input *in, bool seen)
{
    const struct home_axis *a = &h->config.axis[i];
    struct home_search *c = &h->axis[i];

    c->passed = c->passed || seen;
    if (limit(in, i, -way(a))) {
        fail(h, i, HOME_CYCLE_LIMIT);
    } else if (c->off) {
        c->stopping = home_motion_at(&c->motion, c->place);
    } else if (c->passed && !on(h, i, in)) {
        c->off = true;
        c->place = c->motion.commanded - (int64_t)way(a) * a->back;
    }
}

static void edge(struct home_cycle *h, int i, const struct home_cycle_input *in)
{
    const struct home_axis *a = &h->config.axis[i];
    struct home_search *c = &h->axis[i];
    const bool latched = (in->latched >> i & 1) != 0;

    c->off = c->off || !on(h, i, in);
    if (!c->off) {
        fail(h, i, HOME_CYCLE_STUCK); /* it is on before it can come on */
    } else if (by_edge(a->trigger) ? latched : on(h, i, in)) {
        c->place = by_edge(a->trigger) ? in->latch[i] : in->position[i];
        c->stopping = true;
    } else if (limit(in, i, way(a))) {
        fail(h, i, HOME_CYCLE_LIMIT);
    }
}

/* The axis rests after a phase has found its place: begin the next phase. */
static void next_phase(struct home_cycle *h, int i)
{
    struct home_search *c = &h->axis[i];

    switch (c->phase) {
    case HOME_CYCLE_TURN:   enter(c, HOME_CYCLE_SEARCH); break;
    case HOME_CYCLE_SEARCH: enter(c, HOME_CYCLE_BACK); break;
    case HOME_CYCLE_BACK:   enter(c, HOME_CYCLE_EDGE); break;
    case HOME_CYCLE_EDGE:
        c->place += h->config.axis[i].offset;
        enter(c, HOME_CYCLE_OFFSET);
        break;
    default: enter(c, HOME_CYCLE_DONE);
    }
}

static void look(struct home_cycle *h, int i, const struct home_cycle_input *in)
{
    struct home_search *c = &h->axis[i];
    const bool seen = on(h, i, in) || (in->latched >> i & 1) != 0;

    if (c->stopping) {
        if (c->motion.still >= h->config.settle) {
            next_phase(h, i);
        }
        return;
    }
    switch (c->phase) {
    case HOME_CYCLE_SEARCH: search(h, i, in, seen); break;
    case HOME_CYCLE_TURN:   turn(h, i, in, seen); break;
    case HOME_CYCLE_BACK:   back(h, i, in, seen); break;
    case HOME_CYCLE_EDGE:   edge(h, i, in); break;
    case HOME_CYCLE_OFFSET:
        c->stopping = home_motion_at(&c->motion, c->place);
        if (!c->stopping && limit(in, i, (double)(c->place - c->motion.commanded))) {
            fail(h, i, HOME_CYCLE_LIMIT);
        }
        return;
    default: return;
    }
    if (!c->stopping && llabs(c->motion.commanded - c->begin) > h->config.axis[i].travel) {
        fail(h, i, c->phase == HOME_CYCLE_BACK ? HOME_CYCLE_STUCK : HOME_CYCLE_NO_ORIGIN);
    }
}

/* Signed speed of a phase, unless that goes to a target. [pulses/s] */
static double speed_of(const struct home_axis *a, enum home_cycle_phase phase)
{
    switch (phase) {
    case HOME_CYCLE_SEARCH: return way(a) * a->fast;
    case HOME_CYCLE_TURN:
    case HOME_CYCLE_BACK:   return -way(a) * a->fast;
    case HOME_CYCLE_EDGE:   return way(a) * a->slow;
    default:                return 0.0;
    }
}

/* Pulses of an axis in the next period. */
static int32_t go(struct home_cycle *h, int i)
{
    const struct home_axis *a = &h->config.axis[i];
    const double period = h->config.period;
    const struct home_limits limits = { a->acc * period * period, a->start * period };
    struct home_search *c = &h->axis[i];

    if (c->stopping || h->state != HOME_CYCLE_RUNNING) {
        return home_motion_run(&c->motion, &limits, 0.0);
    }
    if (c->phase == HOME_CYCLE_OFFSET || (c->phase == HOME_CYCLE_BACK && c->off)) {
        return home_motion_to(&c->motion, &limits, c->place, a->fast * period);
    }
    return home_motion_run(&c->motion, &limits, speed_of(a, c->phase) * period);
}

struct frame home_cycle_step(struct home_cycle *h, const struct home_cycle_input *in)
{
    struct frame frame = { { 0 }, 0 };
    bool done = true, still = true;

    for (int i = 0; i < CARD_AXES && h->state == HOME_CYCLE_RUNNING; i++) {
        look(h, i, in);
        done = done && (h->axis[i].phase == HOME_CYCLE_NONE || h->axis[i].phase == HOME_CYCLE_DONE);
    }
    if (h->state == HOME_CYCLE_RUNNING && done) {
        next_order(h, in);
    }
    if (h->state != HOME_CYCLE_RUNNING && h->state != HOME_CYCLE_STOPPING) {
        return frame;
    }
    for (int i = 0; i < CARD_AXES; i++) {
        frame.command[i] = (int16_t)go(h, i);
        still = still && h->axis[i].motion.still > 0;
    }
    if (h->state == HOME_CYCLE_STOPPING && still) {
        h->state = h->fault == HOME_CYCLE_OK ? HOME_CYCLE_STOPPED : HOME_CYCLE_FAILED;
    }
    return frame;
}
