/* The card's state as outputs of the description. */
#ifndef EPCIO_OUTPUTS_H
#define EPCIO_OUTPUTS_H

#include "epcio.h"

/* Counters are 32-bit registers: they wrap. */
static int32_t wrap(int64_t count)
{
    return (int32_t)(uint32_t)(uint64_t)count;
}

static void publish_axes(struct vars *v, const struct epcio *card)
{
    int64_t pulses[EPCIO_AXES];
    epcio_pulses(card, pulses);
    for (int i = 0; i < EPCIO_AXES; i++) {
        if (!card->config.active[i])
            continue;
        v->stock[i] = card->fifo[i].stock;
        v->underflows[i] = card->underflows[i];
        v->pulse_count[i] = wrap(pulses[i]);
        v->enc_count[i] = wrap(card->encoder[i].count);
        v->err_count[i] = card->loop[i].error;
        v->dac[i] = epcio_volts(card, i);
        v->latch_value[i] = wrap(card->latch[i].value);
        v->latch_seen[i] = card->latch[i].seen;
    }
}

static void publish_pulse_lines(struct vars *v, const struct epcio *card)
{
    for (int i = 0; i < EPCIO_AXES; i++) {
        const struct pulse_lines l = pulse_at(&card->config.pulse[i], &card->pulse[i], &card->dda,
                                              i, card->clock);
        v->pulse_a[i] = l.a;
        v->pulse_b[i] = l.b;
        v->pulse_clock[i] = (double)pulse_latest(&card->pulse[i], &card->dda, i, card->clock);
    }
}

static void publish_encoders(struct vars *v, const struct epcio *card)
{
    v->enc_too_fast = 0;
    for (int i = 0; i < EPCIO_ENCODERS; i++)
        v->enc_too_fast |= (int32_t)card->encoder[i].too_fast << i;
    for (int i = 0; i < EPCIO_ENCODERS - EPCIO_AXES; i++) {
        const int k = EPCIO_AXES + i;
        v->enc_count_aux[i] = wrap(card->encoder[k].count);
        v->latch_value_aux[i] = wrap(card->latch[k].value);
        v->latch_seen_aux[i] = card->latch[k].seen;
    }
}

static void publish_adc(struct vars *v, const struct epcio *card)
{
    const struct adc *a = &card->adc;
    v->adc_busy = a->busy;
    if (v->adc_conversions == a->conversions)
        return;
    v->adc_conversions = a->conversions;
    for (int i = 0; i < ADC_CHANNELS; i++) {
        const double volts = adc_volts(&card->config.adc, a->range[i], a->code[i]);
        *(i < 6 ? &v->adc[i] : &v->adc_aux[i - 6]) = volts;
    }
}

static void publish_local(struct vars *v, const struct epcio *card)
{
    const struct local_io *io = &card->local;
    const struct local_io_outputs o =
        local_io_outputs(&card->local_control, io, card->watchdog.expired);
    v->inputs = (int32_t)io->inputs;
    v->home = (int32_t)io->seen.home;
    v->over_travel = (int32_t)(io->seen.up | io->seen.down << 8);
    v->stopped = local_io_stopped(&card->local_control, io);
    v->off = epcio_off(card);
    v->ldo = (int32_t)o.ldo;
    v->position_ready = o.position_ready;
    for (int i = 0; i < EPCIO_AXES; i++)
        v->servo_on[i] = (o.servo_on >> i & 1u) != 0;
    v->timer_fired = wrap(card->timer.count);
    v->watchdog_expired = card->watchdog.expired;
}

static void publish_remote(struct vars *v, const struct epcio *card)
{
    v->remote_ready = 0;
    for (int i = 0; i < EPCIO_SETS * REMOTE_IO_SLAVES; i++) {
        const int set = i / REMOTE_IO_SLAVES, slave = i % REMOTE_IO_SLAVES;
        const struct remote_io *r = &card->remote[set];
        uint16_t out[REMOTE_IO_PORTS];
        remote_io_outputs(&card->config.remote, r, card->clock, slave, out);
        v->remote_ready |= (int32_t)(r->ready >> slave & 1u) << i;
        v->remote_errors[i] = r->errors[slave];
        for (int p = 0; p < REMOTE_IO_PORTS; p++) {
            v->remote_in[i][p] = r->in[slave][p];
            v->remote_out[i][p] = out[p];
        }
    }
}

static void publish(struct vars *v, const struct epcio *card)
{
    v->irq = card->irq.line;
    v->irq_seq = wrap(card->irq.seq);
    v->irq_clock = (double)card->irq.clock;
    memcpy(v->irq_flags, card->irq.flags, sizeof v->irq_flags);
    v->cmd_ack = card->cmd_ack;
    v->frames_taken = card->frames_taken;
    v->frames_refused = card->frames_refused;
    v->overflows = card->overflows;
    v->dda_time = (double)dda_time(card->dda.length, card->dda.divider) / EPCIO_CLOCK_HZ;
    v->dac_fired = (int32_t)card->analog.fired;
    publish_axes(v, card);
    if (v->pulse_lines)
        publish_pulse_lines(v, card);
    publish_encoders(v, card);
    publish_adc(v, card);
    publish_local(v, card);
    for (int i = 0; i < 2; i++)
        v->dac_aux[i] = epcio_volts(card, EPCIO_AXES + i);
    if (card->remote_used)
        publish_remote(v, card);
}
_Static_assert(sizeof ((struct vars *)0)->irq_flags == sizeof ((struct irq *)0)->flags,
               "a page an element");

#endif
