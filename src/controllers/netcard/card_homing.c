/* The home task. */
#include "netcard_parts.h"

#include <string.h>

enum { WAIT, LOOK, LOWERED, STILL, CLEARED, STEP, LAST, RAISE };

static void go(struct netcard *c, int step)
{
    c->step[NETCARD_HOME] = step;
}

/* Frames that stand in the FIFO while the task sleeps for a tick. */
static int32_t lead(const struct card_settings *s)
{
    const int32_t n = s->tick_ns / s->period_ns + 2;

    return n < s->fifo_depth / 2 ? n : s->fifo_depth / 2;
}

static struct home_cycle_input seen(struct netcard *c)
{
    struct home_cycle_input in = { .origin = c->axes.origin, .plus = c->axes.plus,
                                   .minus = c->axes.minus, .latched = c->latched };

    player_counts(&c->player, card_clock(c), in.position);
    memcpy(in.latch, c->latch, sizeof in.latch);
    c->latched = 0;
    return in;
}

static bool begin(struct netcard *c)
{
    const struct card_settings *s = &c->settings;
    struct home_cycle_config h = { .period = s->period_ns * 1e-9, .settle = lead(s) + 3 };
    struct player_job job = { .period = s->period_ns / PLAYER_CLOCK_NS, .reserve = s->reserve };
    const struct home_cycle_input in = seen(c);

    for (int i = 0; i < CARD_AXES; i++) {
        h.axis[i] = (struct home_axis){
            .order = s->home_order[i], .trigger = (enum card_trigger)s->origin_trigger[i],
            .plus = s->home_plus[i], .fast = s->home_speed[i], .slow = s->home_slow[i],
            .acc = s->acc_max[i] * (1.0 - s->reserve), .start = s->speed_min[i],
            .back = s->home_back[i], .travel = s->home_travel[i], .offset = s->home_offset[i]
        };
        job.speed[i] = s->home_speed[i];
        job.acc[i] = s->acc_max[i];
    }
    if (!home_cycle_valid(&h) || player_begin(&c->player, &job, card_clock(c)) != PLAYER_OK) {
        return false;
    }
    home_cycle_begin(&c->home, &h, c->home_axes, &in);
    c->ended = false;
    c->homed &= ~c->home_axes;
    return true;
}

/* Does homing go on? */
static bool wanted(const struct netcard *c)
{
    const bool paused = c->state == NET_PAUSING || c->state == NET_PAUSED;

    return card_literal(c) ? c->state != NET_FAULT && !c->over
                           : c->state == NET_HOMING || (paused && c->resumes == NET_HOMING);
}

/* A frame, if there is room for it; else sleep. The literal task keeps the processor. */
static void step(struct netcard *c)
{
    if (c->player.fifo.stock >= lead(&c->settings)) {
        if (card_literal(c)) {
            card_spend(c, NETCARD_HOME, c->settings.period_ns, STEP);
        } else {
            kernel_delay(&c->kernel, 1);
        }
        return;
    }
    const struct home_cycle_input in = seen(c);
    const struct frame f = home_cycle_step(&c->home, &in);
    kernel_mark(&c->kernel, NETCARD_STEP, NETCARD_HOME);
    player_push(&c->player, &f);
    if (c->player.target == 0 && (card_literal(c) || c->state == NET_HOMING)) {
        player_set_target(&c->player, 1);
    }
    if (c->home.state != HOME_CYCLE_RUNNING && c->home.state != HOME_CYCLE_STOPPING) {
        player_whole(&c->player);
        go(c, LAST);
    }
    card_spend(c, NETCARD_HOME, card_frame_ns(c, c->settings.step_cycles),
               c->step[NETCARD_HOME]);
}

/* All frames are played. */
static void finish(struct netcard *c)
{
    if (c->home.state != HOME_CYCLE_ENDED) {
        card_fault(c, NET_NOT_HOMED);
        return;
    }
    for (int i = 0; i < CARD_AXES; i++) {
        if (c->home.mask >> i & 1) {
            c->zero[i] = home_cycle_zero(&c->home, i);
            c->homed |= 1u << i;
        }
    }
    card_rest(c);
    if (card_literal(c) && c->job) {        /* run goes on with its next frame, from here */
        c->state = NET_RUNNING;
        player_begin(&c->player, &c->plays, card_clock(c));
        player_set_target(&c->player, 1);
        c->ended = c->read;
    }
}

/* A stop lowers the rate: until rest it is given frames. */
void card_home(struct netcard *c)
{
    const int at = c->step[NETCARD_HOME];
    const bool stops = c->state == NET_STOPPING && (at == STEP || at == LAST);

    if ((at > LOWERED && at < RAISE && !wanted(c) && !stops) ||
        (at > CLEARED && at < RAISE && c->home.state == HOME_CYCLE_IDLE)) {
        go(c, RAISE);
        return;
    }
    switch (at) {
    case WAIT:
        card_take(c, NETCARD_HOME, NETCARD_GIVE_HOME, LOOK);
        return;
    case LOOK:
        if (!card_literal(c) && c->state != NET_HOMING) {
            c->dropped++;
            go(c, WAIT);
            return;
        }
        c->home.state = HOME_CYCLE_IDLE;
        c->over = c->over && c->job;        /* a stop from here on is one of homing too */
        c->homing = true;
        go(c, LOWERED);
        kernel_set_priority(&c->kernel, NETCARD_HOME, c->settings.priority_home_active);
        return;
    case LOWERED:
        go(c, STILL);
        kernel_give(&c->kernel, NETCARD_GIVE_FIFO);     /* run gives its job up */
        return;
    case STILL:
        if (card_literal(c)) {
            c->state = NET_HOMING;
        } else if (!player_at_rest(&c->player)) {
            player_set_target(&c->player, 0);
            card_take(c, NETCARD_HOME, NETCARD_GIVE_HOME, STILL);
            return;
        }
        player_clear(&c->player);
        card_put_rest(c);
        go(c, CLEARED);
        return;
    case CLEARED:
        if (begin(c)) {
            go(c, STEP);
        } else {
            card_fault(c, NET_RANGE);
        }
        return;
    case STEP:
        step(c);
        return;
    case LAST:
        if (!c->ended || stops) {
            if (card_literal(c)) {
                card_spend(c, NETCARD_HOME, c->settings.period_ns, LAST);
            } else {
                kernel_delay(&c->kernel, 1);
            }
            return;
        }
        finish(c);
        go(c, RAISE);
        return;
    default:
        if (card_literal(c) && c->state == NET_HOMING) {    /* stopped */
            card_rest(c);
        }
        c->homing = false;
        go(c, WAIT);
        kernel_set_priority(&c->kernel, NETCARD_HOME, c->settings.priority_home);
    }
}
