/* msp430_rig - for the tests: the positioner with an ideal axis, whose speed is the voltage times a
 * constant. */
#ifndef MSP430_RIG_H
#define MSP430_RIG_H

#include "check.h"
#include "fixed.h"
#include "msp430.h"

#include <math.h>

enum { RIG_PIN = 800, RIG_TICK = 8000, RIG_ONE = 1 << TRAPEZOID_POINT };

struct rig {
    struct msp430 chip;
    struct msp430_pins pins;
    double place;          /* [counts] true position */
    double home_at;        /* [counts] the home switch is on at this position and below */
    double speed_per_volt; /* [counts/s/V] */
    bool unplugged, stuck; /* the scale is unplugged; the home switch is always on */
    double phase;          /* [line periods] as the scale showed it last */
    int64_t clock;
    int states; /* states that were seen, a bit each */
};

/* 8 MHz, 1 ms, 20 counts/tick, 0.1 counts/tick^2; Kp = 1 PWM count per count, 20/s. */
static inline struct msp430_config rig_config(void)
{
    return (struct msp430_config){
        .sequence = {
            .law = {.kind = REGULATOR_SUM, .p_gain = 256, .p_shift = 8, .i_gain = 1280,
                    .i_shift = 16, .band = 50, .outside = REGULATOR_HOLD},
            .speed = 20 * RIG_ONE, .home_speed = 4 * RIG_ONE, .acceleration = RIG_ONE / 10,
            .home_way = -1, .home_search = 30000, .low_limit = -100, .high_limit = 25000,
            .error_limit = 4000, .scale_open = 200, .scale_ticks = 100, .debounce = 5,
        },
        .pwm = {.period = 4000, .tau = 32000.0, .high = 2.5, .offset = 1.25, .gain = 8.0,
                .limit = 10.0},
        .clear = PORT_CLEAR_ONE, .home_always = true, .timer_period = RIG_TICK,
        .timer_cycles = 200, .adc_reference = 2.5, .filter_start = 1.25,
    };
}

static inline struct rig rig_start(const struct msp430_config *c, double place)
{
    struct rig r = { .place = place, .phase = 0.25 * place, .speed_per_volt = 4000.0 };
    msp430_reset(&r.chip, c);
    return r;
}

static inline enum sequence_state rig_state(const struct rig *r)
{
    return r->chip.sequence.state;
}

static inline int rig_counter(const struct rig *r)
{
    return fixed_word(r->chip.port.counter);
}

static inline double rig_volts(const struct rig *r)
{
    return pwm_voltage(&r->chip.pwm, &r->chip.config.pwm);
}

static inline void rig_run(struct rig *r, double seconds)
{
    for (int64_t n = (int64_t)(seconds * 8e6 / RIG_PIN + 0.5); n > 0; n--) {
        r->phase = r->unplugged ? r->phase : 0.25 * r->place;
        r->pins.home = r->stuck || r->place <= r->home_at;
        CHECK_EQ(msp430_sample(&r->chip, r->phase, &r->pins, r->clock), QUADRATURE_OK);
        r->clock += RIG_PIN;
        r->states |= 1 << rig_state(r);
        r->place += r->speed_per_volt * pwm_mean(&r->chip.pwm, &r->chip.config.pwm) * RIG_PIN / 8e6;
    }
}

static inline void rig_press(struct rig *r, int button)
{
    *(button == 1 ? &r->pins.pb1 : &r->pins.pb2) = true;
    rig_run(r, 0.02);
    r->pins.pb1 = r->pins.pb2 = false;
    rig_run(r, 0.02);
}

/* A rig that has been homed and is at rest a little behind the switch. */
static inline struct rig rig_homed(const struct msp430_config *c)
{
    struct rig r = rig_start(c, 500.0);
    rig_run(&r, 0.02);
    rig_press(&r, 1);
    rig_run(&r, 1.5);
    CHECK_EQ(rig_state(&r), SEQUENCE_READY);
    CHECK(r.chip.sequence.homed);
    return r;
}

#endif
