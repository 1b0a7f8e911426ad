/* epcio_outputs - sets the outputs of the epcio FMU from the state of its card. Included by model.c
 * after card_wires.h. */
#ifndef EPCIO_OUTPUTS_H
#define EPCIO_OUTPUTS_H

#include "epcio.h"

static void publish_axes(struct vars *v, const struct epcio *card)
{
    int64_t pulses[EPCIO_AXES];
    epcio_pulses(card, pulses);
    for (int i = 0; i < EPCIO_AXES; i++) {
        if (!card->config.active[i])
            continue;
        v->stock[i] = card->fifo[i].stock;
        v->underflows[i] = card->underflows[i];
        v->dda_command[i] = card->dda.command[i];
        v->pulse_count[i] = link_wrap(pulses[i]);
        v->enc_count[i] = link_wrap(card->encoder[i].count);
        v->err_count[i] = card->loop[i].error;
        v->dac[i] = epcio_volts(card, i);
        v->latch_value[i] = link_wrap(card->latch[i].value);
        v->latch_seen[i] = card->latch[i].seen;
    }
}

static void publish_pulse_lines(struct vars *v, const struct epcio *card)
{
    for (int i = 0; i < EPCIO_AXES; i++) {
        const struct lines l =
            pulse_at(&card->config.pulse[i], &card->pulse[i], &card->dda, i, card->clock);
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
    v->enc_count_7 = link_wrap(card->encoder[6].count);
    v->enc_count_8 = link_wrap(card->encoder[7].count);
    v->enc_count_9 = link_wrap(card->encoder[8].count);
    v->latch_value_7 = link_wrap(card->latch[6].value);
    v->latch_value_8 = link_wrap(card->latch[7].value);
    v->latch_value_9 = link_wrap(card->latch[8].value);
    v->latch_seen_7 = card->latch[6].seen;
    v->latch_seen_8 = card->latch[7].seen;
    v->latch_seen_9 = card->latch[8].seen;
}

static void publish_adc(struct vars *v, const struct epcio *card)
{
    const struct adc *a = &card->adc;
    v->adc_busy = a->busy;
    if (v->adc_conversions == a->conversions)
        return;
    v->adc_conversions = a->conversions;
    double volts[ADC_CHANNELS];
    for (int i = 0; i < ADC_CHANNELS; i++)
        volts[i] = adc_volts(&card->config.adc, a->range[i], a->code[i]);
    memcpy(v->adc, volts, sizeof v->adc);
    v->adc_7 = volts[6];
    v->adc_8 = volts[7];
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
    v->timer_fired = link_wrap(card->timer.count);
    v->watchdog_expired = card->watchdog.expired;
}

static void publish_remote(struct vars *v, const struct epcio *card)
{
    int32_t *const in[] = { v->remote_in_1, v->remote_in_2, v->remote_in_3, v->remote_in_4 };
    int32_t *const port[] = { v->remote_out_1, v->remote_out_2, v->remote_out_3, v->remote_out_4 };
    v->remote_ready = 0;
    for (int i = 0; i < EPCIO_SETS * REMOTE_IO_SLAVES; i++) {
        const int set = i / REMOTE_IO_SLAVES, slave = i % REMOTE_IO_SLAVES;
        const struct remote_io *r = &card->remote[set];
        uint16_t out[REMOTE_IO_PORTS];
        remote_io_outputs(&card->config.remote, r, card->clock, slave, out);
        v->remote_ready |= (int32_t)(r->ready >> slave & 1u) << i;
        v->remote_errors[i] = r->errors[slave];
        for (int p = 0; p < REMOTE_IO_PORTS; p++) {
            in[p][i] = r->in[slave][p];
            port[p][i] = out[p];
        }
    }
}

static void publish(struct vars *v, const struct epcio *card)
{
    v->irq_pages = 0;
    for (int i = 0; i < IRQ_PAGES && card->irq.line; i++) /* a page that pulls holds the line */
        v->irq_pages |= (int32_t)((card->irq.flags[i] & card->irq.mask[i]) != 0) << i;
    v->overflows = card->overflows;
    v->dda_time = (double)dda_time(card->dda.ticks, card->dda.divider) / EPCIO_CLOCK_HZ;
    v->dac_fired = (int32_t)card->analog.fired;
    publish_axes(v, card);
    if (v->pulse_lines)
        publish_pulse_lines(v, card);
    publish_encoders(v, card);
    publish_adc(v, card);
    publish_local(v, card);
    v->err_count_7 = card->loop[EPCIO_AXES].error;
    v->dac_7 = v->dac_six_aux[0] = epcio_volts(card, 6);
    v->dac_8 = v->dac_six_aux[1] = epcio_volts(card, 7);
    if (card->remote_used)
        publish_remote(v, card);
}

#endif
