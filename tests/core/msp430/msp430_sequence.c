/* Buttons, homing, positioning and faults on an ideal axis. */
#include "fixed.h"
#include "msp430_rig.h"

#include <stdlib.h>

static int states(const struct rig *r, int state)
{
    return r->states >> state & 1;
}

/* At zero: voltage and state, whatever the code. */
static void stopped(struct rig *r, int code, int homed)
{
    CHECK_EQ(rig_state(r), SEQUENCE_FAULT);
    CHECK_EQ(r->chip.sequence.code, code);
    CHECK_EQ(r->chip.sequence.homed, homed);
    rig_run(r, 0.1);
    CHECK_EQ(r->chip.pwm.duty, 2000);
    const double place = r->place;
    rig_run(r, 0.1);
    CHECK(fabs(r->place - place) < 0.01);
    CHECK_EQ(rig_state(r), SEQUENCE_FAULT);
    rig_press(r, 2); /* nothing */
    CHECK_EQ(r->chip.sequence.code, code);
    rig_press(r, 1);
    CHECK_EQ(rig_state(r), homed ? SEQUENCE_READY : SEQUENCE_UNHOMED);
    CHECK_EQ(r->chip.sequence.code, 0);
    rig_run(r, 0.3);
    CHECK(fabs(r->place - place) < 1.5);
}

static void power_up(void)
{
    const struct msp430_config c = rig_config();
    struct rig r = rig_start(&c, 1000.3);
    r.pins.pb1 = r.pins.pb2 = true; /* held at power-up: no press */
    rig_run(&r, 0.1);
    r.pins.pb1 = r.pins.pb2 = false;
    rig_run(&r, 0.1);
    CHECK_EQ(rig_state(&r), SEQUENCE_UNHOMED);
    CHECK(fabs(r.place - 1000.3) < 12.0);
    r.pins.pb1 = true; /* too short */
    rig_run(&r, 0.004);
    r.pins.pb1 = false;
    rig_run(&r, 0.05);
    CHECK_EQ(rig_state(&r), SEQUENCE_UNHOMED);
    rig_press(&r, 2);
    CHECK_EQ(rig_state(&r), SEQUENCE_UNHOMED);
    CHECK_EQ(r.chip.sequence.code, SEQUENCE_NOT_HOMED);
    CHECK(fabs(r.place - 1000.3) < 12.0);
    rig_press(&r, 1);
    CHECK_EQ(rig_state(&r), SEQUENCE_SEARCH);
    CHECK_EQ(r.chip.sequence.code, 0);
}

/* A press acts in the tick in which the button has been down for as many as asked, after a release
 * of as many; a tick up in between begins anew. */
static void debounced_to_the_tick(void)
{
    for (int ticks = 1; ticks <= 5; ticks += 2) {
        struct sequence_config c = rig_config().sequence;
        struct sequence s;
        struct sequence_input in = { 0 };
        c.debounce = ticks;
        sequence_reset(&s, false);
        for (int k = 0; k < ticks; k++)
            sequence_tick(&c, &s, &in);
        for (int k = 1; k < ticks; k++) {
            in.pb1 = true;
            sequence_tick(&c, &s, &in);
        }
        in.pb1 = false;
        sequence_tick(&c, &s, &in);
        in.pb1 = true;
        for (int k = 1; k <= ticks; k++) {
            CHECK_EQ(s.state, SEQUENCE_UNHOMED);
            sequence_tick(&c, &s, &in);
        }
        CHECK_EQ(s.state, SEQUENCE_SEARCH);
    }
}

/* From above: the counter is zero at the switch, constant speed, no bump of the error. */
static void home_from_above(void)
{
    const struct msp430_config c = rig_config();
    struct rig r = rig_start(&c, 2000.4);
    rig_run(&r, 0.02);
    rig_press(&r, 1);
    int steady = 0;
    int16_t error = r.chip.sequence.error;
    for (int k = 0; k < 1000; k++) {
        rig_run(&r, 0.001);
        CHECK(abs(r.chip.sequence.error - error) <= 6);
        error = r.chip.sequence.error;
        steady += r.chip.sequence.track.speed == -4 * RIG_ONE;
    }
    CHECK(steady > 400);
    CHECK_EQ(rig_state(&r), SEQUENCE_READY);
    CHECK(states(&r, SEQUENCE_SEARCH) && states(&r, SEQUENCE_STOP));
    CHECK(!states(&r, SEQUENCE_BACK_OFF) && !states(&r, SEQUENCE_FAULT));
    /* The switch is seen at an instant: 0.1 ms at 4 counts/ms. */
    CHECK(fabs(r.place - rig_counter(&r)) < 1.6);
    CHECK(rig_counter(&r) < 0);
    CHECK_EQ(r.chip.port.zeroed, 1);
    CHECK_EQ(r.chip.port.lost + r.chip.port.turned, 0);
    CHECK_EQ(fixed_word(r.chip.port.counter_2), floor(r.place) - 2000); /* never cleared */
}

/* On the switch: off it first, then as before. Again from READY. */
static void home_from_switch(void)
{
    const struct msp430_config c = rig_config();
    struct rig r = rig_start(&c, -700.0);
    rig_run(&r, 0.02);
    rig_press(&r, 1);
    rig_run(&r, 1.5);
    CHECK(states(&r, SEQUENCE_BACK_OFF));
    CHECK_EQ(rig_state(&r), SEQUENCE_READY);
    CHECK(fabs(r.place - rig_counter(&r)) < 1.6);
    r.states = 0;
    rig_press(&r, 1);
    rig_run(&r, 1.5);
    CHECK(states(&r, SEQUENCE_BACK_OFF) && states(&r, SEQUENCE_SEARCH));
    CHECK_EQ(rig_state(&r), SEQUENCE_READY);
    CHECK_EQ(r.chip.port.zeroed, 2);
}

/* PB2: trapezoid, exact target, held by the integral to the count. */
static void position(void)
{
    const struct msp430_config c = rig_config();
    struct rig r = rig_homed(&c);
    const int targets[] = { 20000, 0, 5, 19990, -100, 25000 };
    for (int i = 0; i < 6; i++) {
        r.pins.target = targets[i];
        r.states = 0;
        rig_press(&r, 2);
        r.pins.target = 12345; /* not taken before the next press */
        rig_run(&r, 2.5);
        CHECK_EQ(rig_state(&r), SEQUENCE_READY);
        CHECK_EQ(r.chip.sequence.track.place, (int64_t)targets[i] * RIG_ONE);
        CHECK(abs(rig_counter(&r) - targets[i]) <= 1);
        CHECK(states(&r, SEQUENCE_ACCELERATE) && states(&r, SEQUENCE_DECELERATE));
        CHECK_EQ(states(&r, SEQUENCE_CRUISE), abs(targets[i] - (i ? targets[i - 1] : 0)) > 4100);
    }
    CHECK_EQ(r.chip.port.lost + r.chip.port.turned, 0);
}

/* A new target under way, behind and ahead; PB1 stops. */
static void under_way(void)
{
    const struct msp430_config c = rig_config();
    struct rig r = rig_homed(&c);
    r.pins.target = 20000;
    rig_press(&r, 2);
    rig_run(&r, 0.5);
    r.pins.target = 1000;
    rig_press(&r, 2);
    rig_run(&r, 2.5);
    CHECK(abs(rig_counter(&r) - 1000) <= 1);
    r.pins.target = 20000;
    rig_press(&r, 2);
    rig_run(&r, 0.3);
    const double place = (double)r.chip.sequence.track.place / RIG_ONE;
    const double v = (double)r.chip.sequence.track.speed / RIG_ONE;
    CHECK(v == 20.0);
    rig_press(&r, 1);
    rig_run(&r, 1.0);
    CHECK_EQ(rig_state(&r), SEQUENCE_READY);
    const double way = (double)r.chip.sequence.track.place / RIG_ONE - place;
    CHECK(way > v * v / 0.2 && way < v * v / 0.2 + 20 * v); /* the button takes its time */
    rig_press(&r, 1);                                       /* again: home */
    rig_run(&r, 0.1);
    CHECK_EQ(rig_state(&r), SEQUENCE_SEARCH);
    rig_press(&r, 1); /* and stop that */
    rig_run(&r, 0.2);
    CHECK_EQ(rig_state(&r), SEQUENCE_UNHOMED);
}

static void target_outside(void)
{
    const struct msp430_config c = rig_config();
    struct rig r = rig_homed(&c);
    const int bad[] = { 25001, -101, INT32_MAX, INT32_MIN };
    for (int i = 0; i < 4; i++) {
        const int counter = rig_counter(&r);
        r.pins.target = bad[i];
        rig_press(&r, 2);
        CHECK_EQ(rig_counter(&r), counter);
        stopped(&r, SEQUENCE_TARGET, 1);
    }
    r.pins.target = 3000;
    rig_press(&r, 2);
    rig_run(&r, 1.0);
    CHECK(abs(rig_counter(&r) - 3000) <= 1);
}

static void scale_unplugged(void)
{
    const struct msp430_config c = rig_config();
    struct rig r = rig_homed(&c);
    r.pins.target = 20000;
    rig_press(&r, 2);
    rig_run(&r, 0.2);
    r.unplugged = true;
    const int counter = rig_counter(&r);
    rig_run(&r, 0.099);
    CHECK_EQ(rig_state(&r), SEQUENCE_CRUISE);
    rig_run(&r, 0.004);
    CHECK(abs(rig_counter(&r) - counter) <= 8); /* what was under way in a pin period */
    stopped(&r, SEQUENCE_SCALE, 0);
}

static void home_switches(void)
{
    struct msp430_config c = rig_config();
    struct rig r = rig_start(&c, 0.0);
    c.sequence.home_search = 1000;
    r.chip.config = c;
    r.stuck = true;
    rig_run(&r, 0.02);
    rig_press(&r, 1);
    rig_run(&r, 0.5);
    stopped(&r, SEQUENCE_HOME_STUCK, 0);
    CHECK(r.place < 1010.0 && r.place > 800.0);
    r.stuck = false;
    r.home_at = -5000.0;
    rig_press(&r, 1);
    rig_run(&r, 0.5);
    stopped(&r, SEQUENCE_NO_HOME, 0);
}

/* The level is there, its interrupt neither served nor waiting. */
static void home_lost(void)
{
    const struct msp430_config c = rig_config();
    struct sequence s;
    sequence_reset(&s, false);
    struct sequence_input in = { .share = 4095 };
    for (int k = 0; k < 20; k++)
        sequence_tick(&c.sequence, &s, &in);
    in.pb1 = true;
    for (int k = 0; k < 20; k++)
        sequence_tick(&c.sequence, &s, &in);
    CHECK_EQ(s.state, SEQUENCE_SEARCH);
    in.home = in.home_pending = true;
    sequence_tick(&c.sequence, &s, &in);
    CHECK_EQ(s.state, SEQUENCE_SEARCH);
    in.home_pending = false;
    CHECK_EQ(sequence_tick(&c.sequence, &s, &in), 0);
    CHECK_EQ(s.state, SEQUENCE_FAULT);
    CHECK_EQ(s.code, SEQUENCE_HOME_LOST);
}

static void following_error(void)
{
    struct msp430_config c = rig_config();
    c.sequence.error_limit = 500;
    c.sequence.scale_ticks = 0;
    struct rig r = rig_homed(&c);
    r.pins.target = 20000;
    r.speed_per_volt = 0.0;
    rig_press(&r, 2);
    rig_run(&r, 0.2);
    CHECK(r.chip.sequence.error >= 501 && r.chip.sequence.error <= 521);
    stopped(&r, SEQUENCE_FOLLOWING, 1);
}

/* Beyond 16 bit: the counter wraps twice, the axis does not notice. */
static void wrap(void)
{
    struct msp430_config c = rig_config();
    c.sequence.high_limit = 200000;
    struct rig r = rig_homed(&c);
    r.pins.target = 100000;
    rig_press(&r, 2);
    for (int k = 0; k < 60; k++) {
        rig_run(&r, 0.1);
        CHECK(abs(r.chip.sequence.error) < 1100);
    }
    CHECK_EQ(rig_state(&r), SEQUENCE_READY);
    CHECK(fabs(r.place - 100000.0) < 3.0);
    CHECK(abs(rig_counter(&r) - (100000 - 131072)) <= 1);
    rig_press(&r, 1); /* and home from there */
    rig_run(&r, 1.0);
    rig_press(&r, 1);
    r.pins.target = 0;
    rig_press(&r, 2);
    CHECK_EQ(r.chip.sequence.code, SEQUENCE_NOT_HOMED);
}

/* Over the switch under way: the counter is cleared there, TRACK goes with it, the target counts
 * from the new zero. With home_always off nothing happens. */
static void over_the_switch(void)
{
    for (int always = 0; always <= 1; always++) {
        struct msp430_config c = rig_config();
        c.sequence.low_limit = -20000;
        c.home_always = always;
        struct rig r = rig_homed(&c);
        r.pins.target = 5000;
        rig_press(&r, 2);
        rig_run(&r, 1.5);
        const double zero = r.place - rig_counter(&r);
        r.home_at = 2000.0; /* the switch is found elsewhere */
        r.pins.target = -3000;
        rig_press(&r, 2);
        rig_run(&r, 2.0);
        CHECK_EQ(rig_state(&r), SEQUENCE_READY);
        CHECK_EQ(rig_counter(&r), -3000);
        CHECK(fabs(r.place - (always ? 2000.0 : zero) + 3000.0) < 4.0);
        CHECK_EQ(r.chip.port.zeroed, always ? 2 : 1);
    }
}

/* TRACK jumps. A step beyond the error limit is refused. */
static void step(void)
{
    struct msp430_config c = rig_config();
    c.sequence.step = true;
    c.sequence.error_limit = 1000;
    struct rig r = rig_homed(&c);
    r.pins.target = 600;
    rig_press(&r, 2);
    CHECK(!states(&r, SEQUENCE_ACCELERATE));
    CHECK_EQ(r.chip.sequence.track.place, 600 * RIG_ONE);
    rig_run(&r, 1.0);
    CHECK(abs(rig_counter(&r) - 600) <= 1);
    r.pins.target = 2000;
    rig_press(&r, 2);
    stopped(&r, SEQUENCE_TARGET, 1);
}

/* The converter's share of the speed: a half, and none at all. */
static void override(void)
{
    struct msp430_config c = rig_config();
    c.adc_on = true;
    struct rig r = rig_homed(&c);
    r.pins.volts = 1.25;
    r.pins.target = 20000;
    rig_press(&r, 2);
    rig_run(&r, 0.3);
    CHECK_EQ(r.chip.sequence.track.speed, 10 * RIG_ONE); /* 2048 / 4096 */
    r.pins.volts = 0.0;
    rig_run(&r, 0.3);
    CHECK_EQ(r.chip.sequence.track.speed, 0);
    CHECK(rig_state(&r) != SEQUENCE_READY);
    r.pins.volts = 2.5;
    rig_run(&r, 2.0);
    CHECK_EQ(rig_state(&r), SEQUENCE_READY);
    CHECK(abs(rig_counter(&r) - 20000) <= 1);
}

/* For studies: ready where it is switched on, and counting from there. */
static void homed_from_the_start(void)
{
    struct msp430_config c = rig_config();
    c.homed = true;
    struct rig r = rig_start(&c, 777.5);
    rig_run(&r, 0.3);
    CHECK_EQ(rig_state(&r), SEQUENCE_READY);
    CHECK_EQ(rig_counter(&r), 0);
    r.pins.target = 5000;
    rig_press(&r, 2);
    rig_run(&r, 1.5);
    CHECK(abs(rig_counter(&r) - 5000) <= 1 && fabs(r.place - 5777.5) < 2.0);
}

int main(void)
{
    homed_from_the_start();
    power_up();
    debounced_to_the_tick();
    home_from_above();
    home_from_switch();
    position();
    under_way();
    target_outside();
    scale_unplugged();
    home_switches();
    home_lost();
    following_error();
    wrap();
    over_the_switch();
    step();
    override();
    return check_result();
}
