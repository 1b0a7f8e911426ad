/* The home task by the table of states and commands, and the parts of homing that both policies
 * share. */
#include "netcard_parts.h"

#include <string.h>

static void go(struct netcard *c, enum card_home_step step)
{
    c->step[NETCARD_HOME] = step;
}

/* Number of frames that the FIFO needs while the task sleeps for a tick of the kernel. */
static int32_t lead(const struct card_settings *s)
{
    const int32_t n = s->tick_ns / s->period_ns + 2;

    return n < s->fifo_depth / 2 ? n : s->fifo_depth / 2;
}

static struct home_cycle_input seen(struct netcard *c)
{
    struct home_cycle_input in = { .origin = c->axes.origin,
                                   .plus = c->axes.plus,
                                   .minus = c->axes.minus,
                                   .latched = c->latched };

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
        h.axis[i] = (struct home_axis){ .order = s->home_order[i],
                                        .trigger = (enum card_trigger)s->origin_trigger[i],
                                        .plus = s->home_plus[i],
                                        .fast = s->home_speed[i],
                                        .slow = s->home_slow[i],
                                        .acc = s->acc_max[i] * (1.0 - s->reserve),
                                        .start = s->speed_min[i],
                                        .back = s->home_back[i],
                                        .travel = s->home_travel[i],
                                        .offset = s->home_offset[i] };
        job.speed[i] = s->home_speed[i];
        job.acc[i] = s->acc_max[i];
    }
    if (!home_cycle_valid(&h) || player_begin(&c->player, &job, card_clock(c)) != PLAYER_OK) {
        return false;
    }
    home_cycle_begin(&c->home, &h, c->home_axes, &in);
    c->homing = HOMING_GIVES;
    c->homed &= ~c->home_axes;
    return true;
}

void card_home_lower(struct netcard *c)
{
    c->home.state = HOME_CYCLE_IDLE;
    c->homing = HOMING_BEGINS;
    go(c, HOME_LOWERED);
    kernel_set_priority(&c->kernel, NETCARD_HOME, c->settings.priority_home_active);
}

void card_home_clear(struct netcard *c)
{
    player_clear(&c->player);
    card_put_rest(c);
    go(c, HOME_CLEARED);
}

void card_home_begin(struct netcard *c)
{
    if (begin(c)) {
        go(c, HOME_STEP);
    } else {
        card_fault(c, NET_RANGE);
    }
}

bool card_home_full(const struct netcard *c)
{
    return c->player.fifo.stock >= lead(&c->settings);
}

void card_home_frame(struct netcard *c, bool goes)
{
    const struct home_cycle_input in = seen(c);
    const struct frame f = home_cycle_step(&c->home, &in);

    kernel_mark(&c->kernel, NETCARD_STEP, NETCARD_HOME);
    player_push(&c->player, &f);
    if (c->player.target == 0 && goes) {
        player_set_target(&c->player, 1);
    }
    if (c->home.state != HOME_CYCLE_RUNNING && c->home.state != HOME_CYCLE_STOPPING) {
        player_whole(&c->player);
        c->homing = HOMING_GIVEN;
        go(c, HOME_LAST);
    }
    card_spend(c, NETCARD_HOME, card_frame_ns(c, c->settings.step_cycles), c->step[NETCARD_HOME]);
}

bool card_home_found(struct netcard *c)
{
    if (c->home.state != HOME_CYCLE_ENDED) {
        card_fault(c, NET_NOT_HOMED);
        return false;
    }
    for (int i = 0; i < CARD_AXES; i++) {
        if (c->home.mask >> i & 1) {
            c->zero[i] = home_cycle_zero(&c->home, i);
            c->homed |= 1u << i;
        }
    }
    card_rest(c);
    return true;
}

void card_home_raise(struct netcard *c)
{
    c->homing = HOMING_NONE;
    go(c, HOME_WAIT);
    kernel_set_priority(&c->kernel, NETCARD_HOME, c->settings.priority_home);
}

/* True while a stop brings the player to rest: until then the task still gives frames. */
static bool stops(const struct netcard *c)
{
    const int32_t at = c->step[NETCARD_HOME];

    return c->state == NET_STOPPING && (at == HOME_STEP || at == HOME_LAST);
}

/* True if homing is to be given up before its end. */
static bool given_up(const struct netcard *c)
{
    const int32_t at = c->step[NETCARD_HOME];
    const bool paused = c->state == NET_PAUSING || c->state == NET_PAUSED,
               goes_on = stops(c) || c->state == NET_HOMING || (paused && c->resumes == NET_HOMING);

    return (at > HOME_LOWERED && at < HOME_RAISE && !goes_on)
           || (at > HOME_CLEARED && at < HOME_RAISE && c->home.state == HOME_CYCLE_IDLE);
}

static void look(struct netcard *c)
{
    if (c->state == NET_HOMING) {
        card_home_lower(c);
    } else {
        c->dropped++;
        go(c, HOME_WAIT);
    }
}

static void come_to_rest(struct netcard *c)
{
    if (player_at_rest(&c->player)) {
        card_home_clear(c);
    } else {
        player_set_target(&c->player, 0);
        card_take(c, NETCARD_HOME, NETCARD_GIVE_HOME, HOME_STILL);
    }
}

/* Give the next frame if the FIFO has room; else sleep. */
static void step(struct netcard *c)
{
    if (card_home_full(c)) {
        kernel_delay(&c->kernel, 1);
    } else {
        card_home_frame(c, c->state == NET_HOMING);
    }
}

/* Sleep until all frames are played. */
static void last(struct netcard *c)
{
    if (c->homing == HOMING_PLAYED && !stops(c)) {
        card_home_found(c);
        go(c, HOME_RAISE);
    } else {
        kernel_delay(&c->kernel, 1);
    }
}

void card_home(struct netcard *c)
{
    if (given_up(c)) {
        go(c, HOME_RAISE);
        return;
    }
    switch (c->step[NETCARD_HOME]) {
    case HOME_WAIT: card_take(c, NETCARD_HOME, NETCARD_GIVE_HOME, HOME_LOOK); break;
    case HOME_LOOK: look(c); break;
    case HOME_LOWERED:
        go(c, HOME_STILL);
        kernel_give(&c->kernel, NETCARD_GIVE_FIFO); /* run gives its job up */
        break;
    case HOME_STILL:   come_to_rest(c); break;
    case HOME_CLEARED: card_home_begin(c); break;
    case HOME_STEP:    step(c); break;
    case HOME_LAST:    last(c); break;
    default:           card_home_raise(c);
    }
}
