#include "msp430.h"

#include "adc12.h"
#include "fixed.h"

void msp430_reset(struct msp430 *m, const struct msp430_config *c)
{
    *m = (struct msp430){ .config = *c, .timer_next = c->timer_period };
    m->port.clear = c->clear;
    sequence_reset(&m->sequence, c->homed);
    pwm_reset(&m->pwm, &c->pwm, c->filter_start, c->pwm.period / 2);
}

static void tick(struct msp430 *m)
{
    const struct msp430_config *c = &m->config;
    const struct sequence_input in = {
        .pb1 = m->pins.pb1,
        .pb2 = m->pins.pb2,
        .home = m->pins.home,
        .home_pending = m->port.flags & PORT_HOME,
        .zeroed = m->port.zeroed,
        .target = m->pins.target,
        .share = c->adc_on ? adc12_code(m->pins.volts, c->adc_reference) : ADC12_MAX,
        .counter = m->port.counter,
        .counter_2 = m->port.counter_2,
    };
    m->ticks++;
    sequence_tick(&c->sequence, &m->sequence, &in);
}

static void accept(struct msp430 *m)
{
    if (m->routine != MSP430_FREE)
        return;
    if (m->timer_flag) {
        m->timer_flag = false;
        m->routine = MSP430_READ;
        m->next = m->clock + PORT_LATENCY;
    } else if (m->port.flags) {
        m->routine = MSP430_PORT;
        m->next = m->clock + port_begin(&m->port);
    }
}

/* The action of the interrupt routine at this clock. */
static void work(struct msp430 *m)
{
    if (m->routine == MSP430_PORT) {
        const struct lines l = quadrature_lines(&m->scale);
        const int cycles = port_go(&m->port, l.a, l.b);
        m->next = m->clock + cycles;
        m->routine = cycles > 0 ? MSP430_PORT : MSP430_FREE;
    } else if (m->routine == MSP430_READ) {
        tick(m);
        m->next = m->clock + m->config.timer_cycles;
        m->routine = MSP430_WRITE;
    } else if (m->routine == MSP430_WRITE) {
        pwm_run(&m->pwm, &m->config.pwm, m->clock);
        pwm_write(&m->pwm, &m->config.pwm, m->config.pwm.period / 2 + m->sequence.deviation);
        m->routine = MSP430_FREE;
    }
}

static void pass_edge(struct msp430 *m)
{
    const struct lines before = quadrature_lines(&m->scale);
    const int way = quadrature_pass(&m->scale);
    const struct lines now = quadrature_lines(&m->scale);
    const bool line_b = now.a == before.a;
    port_edge(&m->port, line_b, line_b ? now.b : now.a, way);
}

static int64_t earliest(const struct msp430 *m)
{
    const int64_t edge = quadrature_next(&m->scale);
    const int64_t next = edge < m->timer_next ? edge : m->timer_next;
    return m->routine != MSP430_FREE && m->next < next ? m->next : next;
}

static void run(struct msp430 *m, int64_t until)
{
    accept(m);
    for (int64_t next = earliest(m); next <= until; next = earliest(m)) {
        m->clock = next;
        while (quadrature_next(&m->scale) == next)
            pass_edge(m);
        if (m->timer_next == next) {
            m->overruns += m->timer_flag;
            m->timer_flag = true;
            m->timer_next += m->config.timer_period;
        }
        if (m->routine != MSP430_FREE && m->next == next)
            work(m);
        accept(m);
    }
    m->clock = until;
    pwm_run(&m->pwm, &m->config.pwm, until);
}

enum quadrature_status msp430_sample(struct msp430 *m, double phase, const struct msp430_pins *pins,
                                     int64_t clock)
{
    const bool first = !m->scale.primed;
    const enum quadrature_status status = quadrature_check(&m->scale, phase, clock);
    if (status != QUADRATURE_OK)
        return status;
    quadrature_sample(&m->scale, phase, clock);
    run(m, clock);
    const bool enabled = m->config.home_always || m->sequence.state == SEQUENCE_SEARCH;
    if (!first && enabled && pins->home && !m->pins.home)
        port_home(&m->port);
    m->pins = *pins;
    return QUADRATURE_OK;
}
