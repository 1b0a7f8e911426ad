#include "sequence.h"

#include "adc12.h"
#include "fixed.h"

void sequence_reset(struct sequence *s, bool homed)
{
    *s = (struct sequence){ .pb1.down = true,
                            .pb2.down = true,
                            .homed = homed,
                            .state = homed ? SEQUENCE_READY : SEQUENCE_UNHOMED };
}

/* Debounce a button; true in the tick in which it is pressed. */
static bool pressed(struct sequence_button *b, bool pin, int32_t debounce)
{
    b->ticks = pin == b->down ? 0 : b->ticks + 1;
    if (b->ticks == 0 || b->ticks < debounce)
        return false;
    b->down = pin;
    b->ticks = 0;
    return pin;
}

static bool closed(const struct sequence *s)
{
    return s->state != SEQUENCE_UNHOMED && s->state != SEQUENCE_FAULT;
}

static bool homing(const struct sequence *s)
{
    return s->state == SEQUENCE_BACK_OFF || s->state == SEQUENCE_SEARCH;
}

static bool positioning(const struct sequence *s)
{
    return s->state >= SEQUENCE_ACCELERATE && s->state <= SEQUENCE_DECELERATE;
}

static void fail(struct sequence *s, enum sequence_code code)
{
    s->state = SEQUENCE_FAULT;
    s->code = code;
    s->homed = s->homed && (code == SEQUENCE_TARGET || code == SEQUENCE_FOLLOWING);
    s->deviation = 0;
    trapezoid_freeze(&s->track);
}

/* Close the position loop where the axis is; TRACK keeps its word above the counter's 16 bits. */
static void close_loop(struct sequence *s, const struct sequence_input *in)
{
    const int64_t counts = trapezoid_counts(&s->track);
    trapezoid_put(&s->track, counts + fixed_subtract(in->counter, (uint16_t)counts));
    s->law = (struct regulator){ 0 };
    s->still = 0;
}

static void search(const struct sequence_config *c, struct sequence *s)
{
    s->state = SEQUENCE_SEARCH;
    trapezoid_go(&s->track, trapezoid_counts(&s->track) + (int64_t)c->home_way * c->home_search);
}

static void begin_homing(const struct sequence_config *c, struct sequence *s,
                         const struct sequence_input *in)
{
    if (s->state == SEQUENCE_UNHOMED)
        close_loop(s, in);
    s->homed = false;
    s->code = SEQUENCE_NO_CODE;
    regulator_move(&s->law);
    if (in->home) {
        s->state = SEQUENCE_BACK_OFF;
        trapezoid_go(&s->track,
                     trapezoid_counts(&s->track) - (int64_t)c->home_way * c->home_search);
    } else {
        search(c, s);
    }
}

static void press_1(const struct sequence_config *c, struct sequence *s,
                    const struct sequence_input *in)
{
    if (s->state == SEQUENCE_FAULT) {
        s->code = SEQUENCE_NO_CODE;
        s->state = s->homed ? SEQUENCE_READY : SEQUENCE_UNHOMED;
        close_loop(s, in);
    } else if (homing(s)) {
        s->state = SEQUENCE_STOP;
        trapezoid_stop(&s->track, c->acceleration);
    } else if (positioning(s)) {
        trapezoid_stop(&s->track, c->acceleration);
    } else if (s->state != SEQUENCE_STOP) {
        begin_homing(c, s, in);
    }
}

static void press_2(const struct sequence_config *c, struct sequence *s,
                    const struct sequence_input *in)
{
    if (s->state == SEQUENCE_FAULT)
        return;
    if (!s->homed || s->state == SEQUENCE_STOP) {
        s->code = SEQUENCE_NOT_HOMED;
        return;
    }
    const int64_t way = in->target - trapezoid_counts(&s->track);
    const bool far = c->step && (way < 0 ? -way : way) > c->error_limit;
    if (in->target < c->low_limit || in->target > c->high_limit || far) {
        fail(s, SEQUENCE_TARGET);
        return;
    }
    s->code = SEQUENCE_NO_CODE;
    regulator_move(&s->law);
    if (c->step) {
        trapezoid_put(&s->track, in->target);
        return;
    }
    trapezoid_go(&s->track, in->target);
    s->state = SEQUENCE_ACCELERATE;
}

/* The home interrupt has cleared wMCounter since the last tick; wSt was not cleared, so their
 * difference tells by how much it jumped. TRACK is shifted with it, so that the error stays; a move
 * under way keeps its target. */
static void follow_clear(struct sequence *s, const struct sequence_input *in)
{
    const uint16_t difference = (uint16_t)(in->counter - in->counter_2);
    const int16_t jump = fixed_subtract(difference, s->difference);
    const int64_t counts = trapezoid_counts(&s->track);
    const int16_t error = fixed_subtract((uint16_t)(counts + jump), in->counter);
    const int64_t target = s->track.target;
    trapezoid_shift(&s->track, fixed_word(in->counter) + error - counts);
    if (positioning(s))
        s->track.target = target;
    s->difference = difference;
}

static void home(const struct sequence_config *c, struct sequence *s,
                 const struct sequence_input *in)
{
    const bool zeroed = in->zeroed != s->zeroed;
    if (zeroed)
        follow_clear(s, in);
    s->zeroed = in->zeroed;
    if (s->state != SEQUENCE_SEARCH)
        return;
    if (zeroed) {
        s->homed = true;
        s->state = SEQUENCE_STOP;
        trapezoid_stop(&s->track, c->acceleration);
    } else if (in->home && !in->home_pending) {
        fail(s, SEQUENCE_HOME_LOST);
    }
}

/* TRACK has come to rest: the next state. */
static void arrive(const struct sequence_config *c, struct sequence *s,
                   const struct sequence_input *in)
{
    if (s->state == SEQUENCE_BACK_OFF && in->home)
        fail(s, SEQUENCE_HOME_STUCK);
    else if (s->state == SEQUENCE_BACK_OFF)
        search(c, s);
    else if (s->state == SEQUENCE_SEARCH)
        fail(s, SEQUENCE_NO_HOME);
    else
        s->state = s->homed ? SEQUENCE_READY : SEQUENCE_UNHOMED;
}

static void name_phase(struct sequence *s, int32_t before, int32_t limit)
{
    const int32_t was = before < 0 ? -before : before;
    const int32_t now = s->track.speed < 0 ? -s->track.speed : s->track.speed;
    if (now > was)
        s->state = SEQUENCE_ACCELERATE;
    else if (now < was)
        s->state = SEQUENCE_DECELERATE;
    else if (now == limit)
        s->state = SEQUENCE_CRUISE;
}

static void move(const struct sequence_config *c, struct sequence *s,
                 const struct sequence_input *in)
{
    const bool slow = homing(s) || s->state == SEQUENCE_STOP;
    const int32_t limit = slow ? c->home_speed : adc12_share(c->speed, in->share);
    const int32_t before = s->track.speed;
    if (s->state == SEQUENCE_BACK_OFF && !in->home)
        trapezoid_stop(&s->track, c->acceleration);
    trapezoid_tick(&s->track, limit, c->acceleration);
    if (trapezoid_done(&s->track)) {
        arrive(c, s, in);
    } else if (positioning(s)) {
        name_phase(s, before, limit);
    }
}

/* Whether there has been no edge for scale_ticks although the valve is open: the scale is unplugged
 * or the axis is against a stop. */
static bool scale_silent(const struct sequence_config *c, struct sequence *s,
                         const struct sequence_input *in)
{
    const int32_t open = s->deviation < 0 ? -s->deviation : s->deviation;
    const bool silent = open >= c->scale_open && in->counter_2 == s->counter_2;
    s->still = silent && c->scale_ticks > 0 ? s->still + 1 : 0;
    return s->still > 0 && s->still >= c->scale_ticks;
}

static void regulate(const struct sequence_config *c, struct sequence *s,
                     const struct sequence_input *in)
{
    s->error = fixed_subtract((uint16_t)trapezoid_counts(&s->track), in->counter);
    const int32_t size = s->error < 0 ? -s->error : s->error;
    if (size > c->error_limit)
        fail(s, SEQUENCE_FOLLOWING);
    else if (scale_silent(c, s, in))
        fail(s, SEQUENCE_SCALE);
    else
        s->deviation = regulator_tick(&c->law, &s->law, s->error);
}

int16_t sequence_tick(const struct sequence_config *c, struct sequence *s,
                      const struct sequence_input *in)
{
    const bool first = pressed(&s->pb1, in->pb1, c->debounce);
    const bool second = pressed(&s->pb2, in->pb2, c->debounce);
    home(c, s, in);
    if (first)
        press_1(c, s, in);
    else if (second)
        press_2(c, s, in);
    if (trapezoid_done(&s->track))
        trapezoid_freeze(&s->track);
    else if (closed(s))
        move(c, s, in);
    if (closed(s))
        regulate(c, s, in);
    else
        s->deviation = 0;
    s->counter_2 = in->counter_2;
    return s->deviation;
}
