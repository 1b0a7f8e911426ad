#include "home.h"

#include <math.h>
#include <string.h>

#include "machine.h"

bool home_valid(const struct home_config *c)
{
    return (int)c->mode >= HOME_SENSOR_INDEX && c->mode <= HOME_LIMIT && c->direction <= 7
           && machine_positive(c->high_speed) && machine_positive(c->low_speed)
           && isfinite(c->offset) && machine_positive(c->search) && machine_positive(c->index_way);
}

static double sign(const struct home_config *c, int bit)
{
    return c->direction >> bit & 1 ? -1.0 : 1.0;
}

static bool limit(const struct home_inputs *in, double direction)
{
    return direction > 0.0 ? in->upper : in->lower;
}

static bool by_limit(const struct home_config *c)
{
    return c->mode == HOME_LIMIT || c->mode == HOME_LIMIT_INDEX;
}

/* True if the sensor is ON, or the limit switch in its place. */
static bool on(const struct home_config *c, const struct home_inputs *in)
{
    return by_limit(c) ? limit(in, sign(c, 0)) : in->sensor == c->sensor_on;
}

/* Begin a phase where the axis is. */
static void enter(struct home *h, enum home_phase phase, const struct home_inputs *in)
{
    h->phase = phase;
    h->begin = in->position;
    h->stopping = h->passed = h->armed = false;
}

static void fail(struct home *h, enum home_fault fault)
{
    h->phase = HOME_FAILED;
    h->fault = fault;
}

void home_start(struct home *h, const struct home_config *c, const struct home_inputs *in)
{
    memset(h, 0, sizeof *h);
    enter(h, c->mode == HOME_INDEX ? HOME_LATCH : on(c, in) ? HOME_LEAVE : HOME_SEARCH, in);
}

static bool too_far(const struct home *h, const struct home_inputs *in, double way)
{
    return fabs(in->position - h->begin) > way;
}

/* Phase 1: onto the sensor; the first limit switch turns the axis round, the second is a fault. */
static void search(struct home *h, const struct home_config *c, const struct home_inputs *in)
{
    if (on(c, in)) {
        h->stopping = true;
    } else if (limit(in, sign(c, 0))) {
        if (h->turned) {
            fail(h, HOME_NO_SENSOR);
            return;
        }
        h->turned = true;
        enter(h, HOME_TURN, in);
    } else if (too_far(h, in, c->search)) {
        fail(h, HOME_NO_SENSOR);
    }
}

/* Away from the limit switch, over the sensor and off it, to search again from the usual side. */
static void turn(struct home *h, const struct home_config *c, const struct home_inputs *in)
{
    h->passed = h->passed || on(c, in);
    if (h->passed && !on(c, in)) {
        h->stopping = true;
    } else if (limit(in, -sign(c, 0)) || too_far(h, in, c->search)) {
        fail(h, HOME_NO_SENSOR);
    }
}

/* Phase 2: off the sensor. The axis may be on a limit switch that is the sensor, but not on the
 * other one. If it ran over the sensor before it came to rest, it meets it once more on its way
 * back. */
static void leave(struct home *h, const struct home_config *c, const struct home_inputs *in)
{
    h->passed = h->passed || on(c, in);
    if (h->passed && !on(c, in)) {
        h->place = in->position;
        h->stopping = true;
    } else if (limit(in, sign(c, 1)) && !(by_limit(c) && sign(c, 1) == sign(c, 0))) {
        fail(h, HOME_ON_LIMIT);
    } else if (too_far(h, in, c->search)) {
        fail(h, HOME_STUCK);
    }
}

/* Phase 3: to the index. */
static void latch(struct home *h, const struct home_config *c, const struct home_inputs *in)
{
    if (h->armed && in->latched) {
        h->place = in->latch;
        h->stopping = true;
    } else if (limit(in, sign(c, 2))) {
        fail(h, HOME_ON_LIMIT);
    } else if (too_far(h, in, c->index_way)) {
        fail(h, HOME_NO_INDEX);
    }
}

/* The axis rests after a phase has found its edge: begin the next phase. */
static void next_phase(struct home *h, const struct home_config *c, const struct home_inputs *in)
{
    const bool index = c->mode != HOME_SENSOR && c->mode != HOME_LIMIT;

    switch (h->phase) {
    case HOME_SEARCH: enter(h, HOME_LEAVE, in); break;
    case HOME_TURN:   enter(h, HOME_SEARCH, in); break;
    case HOME_LEAVE:  enter(h, index ? HOME_LATCH : HOME_GO, in); break;
    default:          enter(h, HOME_GO, in); break;
    }
    if (h->phase == HOME_GO) {
        h->place += c->offset;
    }
}

/* See what has come of the phase, and go on to the next one. */
static void look(struct home *h, const struct home_config *c, const struct home_inputs *in)
{
    if (h->stopping) {
        if (in->rest) {
            next_phase(h, c, in);
        }
        return;
    }
    switch (h->phase) {
    case HOME_SEARCH: search(h, c, in); break;
    case HOME_TURN:   turn(h, c, in); break;
    case HOME_LEAVE:  leave(h, c, in); break;
    case HOME_LATCH:  latch(h, c, in); break;
    case HOME_GO:
        if (in->rest && in->position == h->place) {
            h->phase = HOME_DONE;
        } else if (limit(in, h->place - in->position)) {
            fail(h, HOME_ON_LIMIT);
        }
        break;
    default: break;
    }
}

struct home_order home_step(struct home *h, const struct home_config *c,
                            const struct home_inputs *in)
{
    struct home_order order = { HOME_STAND, 0.0, in->position, false };

    look(h, c, in);
    if (h->stopping) {
        return order;
    }
    switch (h->phase) {
    case HOME_SEARCH:
        order.what = HOME_RUN;
        order.speed = sign(c, 0) * c->high_speed;
        break;
    case HOME_TURN:
        order.what = HOME_RUN;
        order.speed = -sign(c, 0) * c->high_speed;
        break;
    case HOME_LEAVE:
        order.what = HOME_RUN;
        order.speed = sign(c, 1) * c->low_speed;
        break;
    case HOME_LATCH:
        order.what = HOME_RUN;
        order.speed = sign(c, 2) * c->low_speed;
        order.arm = !h->armed;
        h->armed = true;
        break;
    case HOME_GO: order = (struct home_order){ HOME_MOVE, c->low_speed, h->place, false }; break;
    default:      break;
    }
    return order;
}
