/* FMU of the FPGA card (core fpga): grid, mailbox and pin inputs, outputs. */
#include <string.h>

#include "fpga_wires.h"
#include "vars.h"

struct model {
    struct fpga card;
    int64_t period;  /* [clocks] grid of the inputs */
    int64_t instant; /* [clock] next instant of that grid */
    struct fpga_taken taken;
    int64_t warned;         /* number of refusals that were warned of */
    int64_t dry;            /* number of underruns at the latest warning */
    int64_t switched;       /* number of changes of outputs that are shown */
    double ai[FPGA_ANALOG]; /* [V] as read last */
};

#include "fmi_model.h"
#include "fmu_period.h"

/* A time that must be a whole number of clocks; 0 after fmu_fail(). */
static int64_t clocks_of(struct fmu *f, const char *name, double seconds)
{
    const double clocks = seconds * FPGA_CLOCK_HZ;
    if (fmu_is_period(clocks))
        return (int64_t)round(clocks);
    fmu_fail(f, "%s = %.17g s: not a whole number of 25 ns clocks", name, seconds);
    return 0;
}

static int model_start(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    const struct fpga_config c = {
        .slot_clocks = v->slot_clocks,
        .format = (enum fpga_format)v->pulse_format,
        .irq_every = clocks_of(f, "irq_every", v->irq_every),
        .input_irq_mask = (uint32_t)v->input_irq_mask,
        .follow_mask = (uint32_t)v->follow_mask,
        .stop_mask = (uint32_t)v->stop_mask,
        .stop_low = (uint32_t)v->stop_low,
        .alarm_stops = v->alarm_stops,
        .stop_servo_off = v->stop_servo_off,
    };
    if (c.irq_every == 0)
        return -1;
    if (c.irq_every % c.slot_clocks != 0)
        return fmu_fail(f, "irq_every = %.17g s: not a whole number of slots of %d clocks",
                        v->irq_every, (int)c.slot_clocks);
    m->period = clocks_of(f, "bus_period", v->bus_period);
    if (m->period == 0)
        return -1;
    fpga_reset(&m->card, &c);
    f->s.v.memory = -1;
    return 0;
}

/* The clock in an input (element k > 0 of an array), rounded up to a whole one; 0 if none is
 * stated, -1 after fmu_fail(). */
static int64_t clock_of(struct fmu *f, const char *name, int k, double clock)
{
    if (!(fabs(clock) < FMU_TICKS_MAX) && k)
        return fmu_fail(f, "%s[%d] = %g: not a clock", name, k, clock);
    if (!(fabs(clock) < FMU_TICKS_MAX))
        return fmu_fail(f, "%s = %g: not a clock", name, clock);
    return clock > 0.0 ? (int64_t)ceil(clock) : 0;
}

/* Check the clocks in mailboxes that have a new number. */
static int check_host(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    const struct fpga_taken *m = &f->s.m.taken;
    if (m->write_seq != v->host_write_seq
        && clock_of(f, "host_write_clock", 0, v->host_write_clock) < 0)
        return -1;
    for (int i = 0; m->out_seq != v->host_out_seq && i < v->host_out_count; i++) {
        if (clock_of(f, "host_out_clock", i + 1, v->host_out_clock[i]) < 0)
            return -1;
    }
    return m->ao_seq != v->host_ao_seq && clock_of(f, "host_ao_clock", 0, v->host_ao_clock) < 0 ? -1
                                                                                                : 0;
}

static int read_host(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    const struct fpga_taken *m = &f->s.m.taken;
    struct fpga_host host;
    if (check_host(f))
        return -1;
    host.write_seq = v->host_write_seq;
    host.out_seq = v->host_out_seq;
    host.ao_seq = v->host_ao_seq;
#define READ(type, name, elements) LINK_CARRY(host.name, v->host_##name)
    if (host.write_seq != m->write_seq) { /* of mailboxes only new ones are looked at */
        FPGA_WRITE(READ)
    }
    if (host.out_seq != m->out_seq) {
        FPGA_OUT(READ)
    }
    if (host.ao_seq != m->ao_seq) {
        FPGA_AO(READ)
    }
    FPGA_LEVELS(READ)
    fpga_take(&f->s.m.taken, &f->s.m.card, &host);
    return 0;
}

static int read_pins(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    uint32_t changed = fpga_inputs_changed(&m->card, (uint32_t)v->di);
    for (int i = 0; changed; i++, changed >>= 1) {
        if (!(changed & 1))
            continue;
        const int64_t clock = clock_of(f, "di_clock", i + 1, v->di_clock[i]);
        if (clock < 0)
            return -1;
        fpga_change_input(&m->card, i, clock);
    }
    if (memcmp(m->ai, v->ai, sizeof m->ai) != 0) {
        LINK_CARRY(m->ai, v->ai)
        fpga_set_ai(&m->card, m->ai);
    }
    uint32_t drives = 0;
    for (int i = 0; i < FPGA_AXES; i++)
        drives |= (uint32_t)v->drive_ready[i] << i | (uint32_t)(v->drive_alarm[i] != 0) << (8 + i);
    fpga_set_drives(&m->card, drives, v->emergency_stop);
    return 0;
}

/* Warn of refusals since the latest warning. */
static void warn_refused(struct fmu *f)
{
    struct model *m = &f->s.m;
    const struct fpga_refusal *r = &m->card.refusal;
    if (m->card.refused == m->warned)
        return;
    const int n = (int)(m->card.refused - m->warned);
    m->warned = m->card.refused;
    if (r->status == FPGA_BAD_SLOT)
        fmu_warn(f, "%d refused; write %d of memory %d, slot %d, axis %d: %s", n, (int)r->seq,
                 (int)r->memory, (int)r->at.slot, (int)r->at.axis + 1, fpga_status_text(r->status));
    else
        fmu_warn(f, "%d refused up to write %d of memory %d: %s", n, (int)r->seq, (int)r->memory,
                 fpga_status_text(r->status));
}

/* Warn of underruns, where pulses stood still because the host was late: of the first one, and each
 * time that there are ten times as many. */
static void warn_underruns(struct fmu *f, int64_t clock)
{
    struct model *m = &f->s.m;
    const int64_t n = m->card.underruns;
    if (n == 0 || n / 10 < m->dry)
        return;
    m->dry = n;
    fmu_warn(f,
             "%d underrun%s until %.9g s: the next pulse memory was not full in time, and the "
             "pulses stood still",
             (int)n, n == 1 ? "" : "s", (double)clock / FPGA_CLOCK_HZ);
}

static void publish(struct fmu *f)
{
    struct vars *v = &f->s.v;
    const struct fpga *c = &f->s.m.card;
    struct fpga_shown shown;
    fpga_show(c, &shown);
#define SHOW(type, name, elements) LINK_CARRY(v->name, shown.name)
    FPGA_INTERRUPTS(SHOW)
    FPGA_STATUS(SHOW)
    for (int i = 0; i < FPGA_AXES; i++)
        v->servo_on[i] = c->servo >> i & 1;
    for (int i = 0; i < FPGA_CHANNELS && f->s.m.switched != c->switched; i++)
        v->dout_clock[i] = (double)c->output_clock[i];
    f->s.m.switched = c->switched;
    v->external_pulse_count[0] = v->external_count;
    v->external_servo_on = c->servo >> FPGA_AXES & 1;
    for (int i = 0; i < FPGA_AXES; i++)
        v->pulse_rate[i] = c->rate[i];
    v->external_rate = c->rate[FPGA_AXES];
    LINK_CARRY(v->ao, c->ao)
    v->dout = link_wrap(c->outputs);
}

/* Inputs are read at the instants in [t0, t1); the outputs show the state at t1. */
static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    struct model *m = &f->s.m;
    const int64_t end = t1 / FPGA_CLOCK_NS;
    (void)t0;
    for (; m->instant < end; m->instant += m->period) {
        fpga_advance(&m->card, m->instant);
        if (read_host(f) || read_pins(f))
            return -1;
    }
    fpga_advance(&m->card, end);
    warn_refused(f);
    warn_underruns(f, end);
    publish(f);
    return 0;
}
