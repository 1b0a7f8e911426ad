/* The approach: motion of the axes from where a stop, a job or homing has left them to position 0,
 * where the next job begins. */
#include "netcard_parts.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"

/* Axes that move together in each turn of the approach, a bit each. */
static const uint32_t TURN[] = {
    [APPROACH_TOOL] = 0xC, [APPROACH_PLANE] = 0x3, [APPROACH_THERE] = 0
};

bool card_approach_due(const struct netcard *c)
{
    bool due = false;

    for (int i = 0; i < CARD_AXES; i++) {
        due = due || netcard_position(c, i) != 0;
    }
    return due;
}

/* Highest speed of an axis: its own, or the one that still leaves a pulse its width.
 * [pulses/period] */
static double fastest(const struct netcard *c, int axis)
{
    const struct card_settings *s = &c->settings;
    const int32_t most = player_largest(&c->player, s->period_ns / PLAYER_CLOCK_NS);

    return el_min(s->speed_max[axis] * (s->period_ns * 1e-9), most - 1.0);
}

static bool there(const struct netcard *c, uint32_t axes)
{
    bool all = true;

    for (int i = 0; i < CARD_AXES; i++) {
        all = all && (!(axes >> i & 1) || home_motion_at(&c->way[i], 0));
    }
    return all;
}

/* Skip turns whose axes are all at position 0. */
static void pass_turns(struct netcard *c)
{
    while (c->approach < APPROACH_THERE && there(c, TURN[c->approach])) {
        c->approach = (enum card_approach)(c->approach + 1);
    }
}

bool card_approach_begin(struct netcard *c)
{
    const struct card_settings *s = &c->settings;
    struct player_job job = { .period = s->period_ns / PLAYER_CLOCK_NS, .reserve = s->reserve };

    memset(c->way, 0, sizeof c->way);
    for (int i = 0; i < CARD_AXES; i++) {
        if (fastest(c, i) <= 0.0) {
            return false;
        }
        c->way[i].commanded = netcard_position(c, i);
        job.speed[i] = s->speed_max[i];
        job.acc[i] = s->acc_max[i];
    }
    c->approach = APPROACH_TOOL;
    pass_turns(c);
    return player_begin(&c->player, &job, card_clock(c)) == PLAYER_OK;
}

/* A step from rest or to rest keeps within the highest speed, too. */
struct frame card_approach_next(struct netcard *c)
{
    const struct card_settings *s = &c->settings;
    const double period = s->period_ns * 1e-9;
    struct frame f = { .event = 0 };

    for (int i = 0; i < CARD_AXES; i++) {
        if (TURN[c->approach] >> i & 1) {
            const double speed = fastest(c, i), acc = s->acc_max[i] * (1.0 - s->reserve);
            const struct home_limits limits = { el_min(acc * period * period, speed),
                                                el_min(s->speed_min[i] * period, speed) };
            f.command[i] = (int16_t)home_motion_to(&c->way[i], &limits, 0, speed);
        }
    }
    pass_turns(c);
    return f;
}
