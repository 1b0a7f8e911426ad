#include "servo.h"

#include <string.h>

#include "reaction.h"

void servo_start(struct servo *s, const struct law_config *law, const struct machine *m,
                 int64_t bus)
{
    struct law_config c = *law;

    memset(s, 0, sizeof *s);
    c.period = (double)bus / CLOCK_HZ;
    for (int i = 0; i < AXES; i++) {
        c.axis[i].on = true;
    }
    dda_reset(&s->dda, AXES, 1 << m->dda_length, machine_dda_divider(m));
    voltage_start(&s->voltage, &c, m);
}

/* Set the signals that the library sees: pulses are those of this servo, not those of the card. */
static void look(struct servo *s, struct mcc *m, const int32_t counts[AXES])
{
    struct signals raw = { .probe = m->signals.probe, .digital = m->signals.digital };

    memcpy(raw.analog, m->signals.analog, sizeof raw.analog);
    memcpy(raw.enc, counts, sizeof raw.enc);
    memcpy(s->before, s->now, sizeof s->before);
    memcpy(s->now, s->next, sizeof s->now);
    m->signals = raw;
    signals_turn(&m->signals, &m->machine);
    for (int i = 0; i < AXES; i++) {
        m->signals.pulses[i] = s->now[i];
        m->signals.err[i] = (int32_t)((uint32_t)s->before[i] - (uint32_t)m->signals.enc[i]);
    }
}

/* Begin a DDA time, of the length that the machine has now, with the next point or standstill. */
static void take(struct servo *s, struct mcc *m)
{
    static const int32_t STANDSTILL[AXES];
    const bool any = m->queue.count > 0;
    const struct pcl_part part = { .points = any, .late = !any && task_moving(m) };

    dda_set_time(&s->dda, 1 << m->machine.dda_length, machine_dda_divider(&m->machine),
                 dda_boundary(&s->dda));
    dda_begin(&s->dda, any ? queue_peek(&m->queue, 0)->frame : STANDSTILL);
    voltage_taken(&s->voltage, m, &part, 1);
    s->starved += pcl_release(m, &part, 1);
}

void servo_instant(struct servo *s, struct mcc *m, int64_t now, int64_t bus,
                   const int32_t counts[AXES])
{
    const struct reaction_look since = { .clocks = bus };
    double volts[AXES] = { 0.0 };
    int64_t next[AXES];

    look(s, m, counts);
    voltage_follow(&s->voltage, &m->machine);
    voltage_tick(&s->voltage, m, now, 0, VOLTAGE_RANGE, volts);
    for (int i = 0; i < AXES; i++) {
        s->volts[i] = m->machine.axis[i].inverted ? -volts[i] : volts[i];
    }
    reaction_look(m, &since);
    while (dda_boundary(&s->dda) <= now + bus) {
        take(s, m);
    }
    dda_counts(&s->dda, now + bus, next);
    for (int i = 0; i < AXES; i++) {
        s->next[i] = (int32_t)(uint64_t)next[i]; /* counters of 32 bit wrap */
    }
}
