#include "msp430_damage.h"

#include <math.h>
#include <stddef.h>

static bool within(int64_t x, int64_t low, int64_t high)
{
    return x >= low && x <= high;
}

/* Behind the last source only what needs none is left to do. */
static bool port_good(const struct port *p)
{
    const bool done = p->place == PORT_WIPE || p->place == PORT_RETURN || p->place == PORT_IDLE;
    return within(p->source, done ? -1 : 0, PORT_SOURCES - 1);
}

/* All edges up to the latest sample have been passed. */
static bool scale_good(const struct quadrature *s, int64_t clock)
{
    return !s->primed ||
           (fabs(s->from) <= QUADRATURE_PHASE_MAX && fabs(s->to) <= QUADRATURE_PHASE_MAX &&
            s->clock == clock && within(s->from_clock, 0, clock) && s->quarter == s->end &&
            s->end == (int64_t)floor(4.0 * s->to));
}

static bool pwm_good(const struct pwm *p, const struct pwm_config *c, int64_t clock)
{
    return within(c->period, 2, 65536) && within(p->duty, 0, c->period) &&
           within(p->wanted, 0, c->period) && p->clock == clock &&
           within(p->begin, clock - c->period, clock);
}

static bool law_good(const struct regulator_config *c)
{
    return within(c->p_shift, 0, REGULATOR_SHIFT_MAX) && within(c->i_shift, 0, REGULATOR_SHIFT_MAX);
}

const char *msp430_damage(const struct msp430 *m)
{
    const struct msp430_config *c = &m->config;
    if (m->clock < 0 || c->timer_period < 1 || c->timer_cycles < 0 ||
        m->timer_next < m->clock || m->timer_next - m->clock > c->timer_period ||
        (m->routine != MSP430_FREE && m->next < m->clock))
        return "a time of the chip";
    if (!law_good(&c->sequence.law) || c->sequence.acceleration < 1 || c->sequence.speed < 0)
        return "the configuration of the chip";
    if (!port_good(&m->port))
        return "the source of a port interrupt";
    if (!scale_good(&m->scale, m->clock))
        return "the scale";
    return pwm_good(&m->pwm, &c->pwm, m->clock) ? NULL : "the pulse width";
}
