/* FMU of the MSP430 positioner (core msp430): the grid at which its pins are read, and its
 * parameters in the chip's units. */
#include <math.h>

#include "el_extremes.h"
#include "fixed.h"
#include "msp430.h"
#include "vars.h"

struct model {
    struct msp430 chip;
    double voltage;   /* [V] mean over the pin period that ended at the latest instant */
    int64_t clock_ns; /* [ns] period of MCLK */
    int64_t period;   /* [clocks] pin grid */
    int64_t instant;  /* [clock] next instant of that grid */
    double phase;     /* [line periods] phase of the scale as the chip saw it last */
    double missed;    /* [line periods] whole ones that passed while the scale was unplugged */
    bool unplugged;   /* the scale was unplugged at the latest instant */
};

#include "fmi_model.h"

/* Relative tolerance for decimal times such as 1e-4 s, which are not exact in binary. */
#define WHOLE_TOLERANCE 1e-9

/* Longest timer period [clocks]: Timer_A has 16 bits and divides by 8 at most. A clock has at most
 * 1e9/4096 ns, so that times in ns are far within 64 bits. */
#define TIMER_MAX (8.0 * 65536.0)

/* Largest speed and acceleration in Q16.16: their sum fits into 32 bits. */
#define FIXED_MAX 1073741823.0

static bool whole(double x, int64_t *n)
{
    if (!(x >= 1.0 - WHOLE_TOLERANCE && x < TIMER_MAX + 1.0))
        return false;
    *n = (int64_t)round(x);
    return fabs(x - round(x)) <= WHOLE_TOLERANCE * x;
}

/* A period in clocks, which must be a whole number and not longer than TIMER_MAX. */
static int set_period(struct fmu *f, const char *name, double period, int64_t *clocks)
{
    const int64_t ns = f->s.m.clock_ns;
    const double x = period * 1e9 / (double)ns;
    if (x > TIMER_MAX * (1.0 + WHOLE_TOLERANCE))
        return fmu_fail(f, "%s = %.17g s: longer than the timer counts, %.9g s", name, period,
                        TIMER_MAX * 1e-9 * (double)ns);
    if (!whole(x, clocks))
        return fmu_fail(f, "%s = %.17g s: not a whole number of clocks of %d ns", name, period,
                        (int)ns);
    return 0;
}

/* Set the clock, the pin grid and the timer period. */
static int set_times(struct fmu *f, struct msp430_config *c)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    if (!whole(1e9 / v->clock, &m->clock_ns))
        return fmu_fail(f, "clock = %.17g Hz: not a whole number of ns per clock", v->clock);
    if (set_period(f, "pin_period", v->pin_period, &m->period)
        || set_period(f, "timer_period", v->timer_period, &c->timer_period))
        return -1;
    if (m->period * m->clock_ns % FMU_TICK_NS)
        return fmu_fail(f, "pin_period = %.17g s: not a whole number of %d ns", v->pin_period,
                        FMU_TICK_NS);
    if (PORT_LATENCY + v->timer_cycles >= c->timer_period)
        return fmu_fail(f,
                        "timer_cycles = %d: with the latency of %d not less than the timer "
                        "period of %d clocks",
                        (int)v->timer_cycles, (int)PORT_LATENCY, (int)c->timer_period);
    c->timer_cycles = v->timer_cycles;
    return 0;
}

static int to_fixed(struct fmu *f, const char *name, double value, double per_tick, int32_t *fixed)
{
    const double x = round(value * per_tick * (1 << TRAPEZOID_POINT));
    if (!(x >= 1.0 && x <= FIXED_MAX))
        return fmu_fail(f, "%s = %.17g: %.6g counts per timer period, outside 1/65536 .. 16383",
                        name, value, value * per_tick);
    *fixed = (int32_t)x;
    return 0;
}

static int set_motion(struct fmu *f, struct sequence_config *c)
{
    const struct vars *v = &f->s.v;
    const double t = v->timer_period;
    if (to_fixed(f, "speed", v->speed, t, &c->speed)
        || to_fixed(f, "home_speed", v->home_speed, t, &c->home_speed)
        || to_fixed(f, "acceleration", v->acceleration, t * t, &c->acceleration))
        return -1;
    const int32_t fastest = c->speed > c->home_speed ? c->speed : c->home_speed;
    if (fastest / c->acceleration >= TRAPEZOID_TICKS_MAX)
        return fmu_fail(f, "acceleration = %.17g: takes more than %d timer periods to the speed",
                        v->acceleration, (int)TRAPEZOID_TICKS_MAX);
    if (v->home_direction == 0)
        return fmu_fail(f, "home_direction = 0: must be -1 or 1");
    if (v->low_limit >= v->high_limit)
        return fmu_fail(f, "low_limit = %d: not below high_limit = %d", (int)v->low_limit,
                        (int)v->high_limit);
    const double ticks = ceil(v->scale_time / t - WHOLE_TOLERANCE);
    if (!(ticks <= INT32_MAX))
        return fmu_fail(f, "scale_time = %.17g s: too long", v->scale_time);
    c->scale_ticks = (int32_t)ticks;
    c->debounce = (int32_t)el_min(ceil(v->debounce / t - WHOLE_TOLERANCE), INT32_MAX);
    return 0;
}

static struct regulator_config law_of(const struct vars *v)
{
    return (struct regulator_config){
        .kind = (enum regulator_kind)v->law,
        .p_gain = (int16_t)v->p_gain,
        .p_shift = v->p_shift,
        .i_gain = (int16_t)v->i_gain,
        .i_shift = v->i_shift,
        .band = (int16_t)v->band,
        .outside = (enum regulator_outside)v->band_outside,
    };
}

static void publish(struct vars *v, const struct model *m)
{
    const struct msp430 *chip = &m->chip;
    const struct sequence *s = &chip->sequence;
    const double point = 1.0 / (1 << TRAPEZOID_POINT);
    v->voltage = m->voltage;
    v->ripple = chip->pwm.ripple;
    v->duty = chip->pwm.duty;
    const struct lines scale = quadrature_lines(&chip->scale);
    v->pin_a = !scale.a;
    v->pin_b = !scale.b;
    v->interrupt = chip->port.latest;
    v->interrupts = fixed_saturate32(chip->port.served + chip->port.zeroed);
    v->counter = fixed_word(chip->port.counter);
    v->counter2 = fixed_word(chip->port.counter_2);
    v->edges = fixed_saturate32(quadrature_edges(&chip->scale));
    v->lost = fixed_saturate32(chip->port.lost);
    v->turned = fixed_saturate32(chip->port.turned);
    v->home_lost = fixed_saturate32(chip->port.home_lost);
    v->track = (double)s->track.place * point;
    v->track_speed = s->track.speed * point / v->timer_period;
    v->track_acceleration = s->track.change * point / (v->timer_period * v->timer_period);
    v->error = s->error;
    v->proportional = s->law.proportional;
    v->integral = s->law.integral;
    v->state = (int32_t)s->state;
    v->code = (int32_t)s->code;
    v->homed = s->homed;
    v->ticks = fixed_saturate32(chip->ticks);
    v->overruns = fixed_saturate32(chip->overruns);
}

static int model_start(struct fmu *f)
{
    struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    struct msp430_config c = {
        .sequence = { .law = law_of(v),
                      .home_way = v->home_direction,
                      .home_search = v->home_search,
                      .low_limit = v->low_limit,
                      .high_limit = v->high_limit,
                      .error_limit = (int16_t)v->error_limit,
                      .step = v->step_target },
        .pwm = { .period = v->pwm_counts,
                 .tau = v->filter_time * v->clock,
                 .high = v->pwm_high,
                 .offset = v->pwm_offset,
                 .gain = v->amplifier_gain,
                 .limit = v->amplifier_limit },
        .clear = (enum port_clear)v->flag_clear,
        .homed = v->start_homed,
        .home_always = v->home_always,
        .adc_on = v->adc_on,
        .adc_reference = v->adc_reference,
        .filter_start = v->filter_start,
    };
    *m = (struct model){ 0 };
    if (set_times(f, &c) || set_motion(f, &c.sequence))
        return -1;
    const double span = v->amplifier_gain * v->pwm_high; /* [V] of the whole duty */
    c.sequence.scale_open = (int32_t)el_min(ceil(v->scale_open / span * v->pwm_counts), INT32_MAX);
    msp430_reset(&m->chip, &c);
    m->voltage = pwm_voltage(&m->chip.pwm, &c.pwm);
    publish(v, m);
    return 0;
}

static void tell_stage(struct fmu *f, enum sequence_code before)
{
    static const char *const TEXT[] = {
        "cleared",
        "PB2 before homing",
        "target outside the stroke",
        "following error",
        "no edges while the valve is open",
        "home switch does not release",
        "home switch not found",
        "home interrupt lost",
    };
    const struct model *m = &f->s.m;
    const enum sequence_code code = m->chip.sequence.code;
    if (code != before)
        fmu_event(f, "code %d at %.9f s: %s", (int)code,
                  (double)(m->chip.clock * m->clock_ns) * 1e-9, TEXT[code]);
}

/* Phase that the chip sees: while the scale is unplugged it does not change. */
static double plugged(struct model *m, const struct vars *v)
{
    if (!v->scale_unplugged && m->unplugged)
        m->missed = round(v->scale_phase - m->phase);
    if (!v->scale_unplugged)
        m->phase = v->scale_phase - m->missed;
    m->unplugged = v->scale_unplugged;
    return m->phase;
}

static int sample(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    const struct msp430_pins pins = {
        .home = v->home, .pb1 = v->pb1, .pb2 = v->pb2, .target = v->target, .volts = v->adc
    };
    const enum sequence_code code = m->chip.sequence.code;
    m->chip.config.sequence.law = law_of(v);
    const enum quadrature_status status = msp430_sample(&m->chip, plugged(m, v), &pins, m->instant);
    if (status == QUADRATURE_TOO_FAST)
        return fmu_fail(f, "scale_phase = %.17g: more than one edge per clock since %.17g",
                        v->scale_phase, m->chip.scale.to);
    if (status != QUADRATURE_OK)
        return fmu_fail(f, "scale_phase = %.17g: more edges than a number can hold exactly",
                        v->scale_phase);
    m->voltage = pwm_mean(&m->chip.pwm, &m->chip.config.pwm);
    tell_stage(f, code);
    return 0;
}

/* Inputs are read at the instants in [t0, t1); the outputs show at each instant what the chip has
 * done up to it. */
static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    struct model *m = &f->s.m;
    for (; m->instant * m->clock_ns < t1; m->instant += m->period) {
        if (m->instant * m->clock_ns > t0)
            publish(&f->s.v, m);
        if (sample(f))
            return -1;
    }
    if (m->instant * m->clock_ns == t1)
        publish(&f->s.v, m);
    return 0;
}
