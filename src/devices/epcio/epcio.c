#include "epcio.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

_Static_assert((int)ADC_EVENT_COMPARE == (int)IRQ_ADC_COMP
                   && (int)ADC_EVENT_DONE == (int)IRQ_ADC_CONV
                   && (int)ADC_EVENT_TAG == (int)IRQ_ADC_TAG,
               "events of the ADC are the bits of its page");
_Static_assert((int)LOCAL_IO_EVENT_LDI == (int)IRQ_LIO_LDI
                   && (int)LOCAL_IO_EVENT_DFI == (int)IRQ_LIO_DFI,
               "events of local I/O are the bits of its page");
_Static_assert((int)REMOTE_IO_EVENT_DI == (int)IRQ_RIO_DI
                   && (int)REMOTE_IO_EVENT_FAIL == (int)IRQ_RIO_FAIL
                   && (int)REMOTE_IO_EVENT_NOT_READY == (int)IRQ_RIO_NOT_READY,
               "events of remote I/O are the bits of its page");

struct epcio_config epcio_default_config(void)
{
    struct epcio_config c = {
        .loop = { .limit = PLOOP_LIMIT_MAX, .scale = 6 },
        .adc = { .bits = 14, .time = 400 },
        .remote = { .time = 5760 },
    };
    for (int i = 0; i < EPCIO_AXES; i++) {
        c.active[i] = true;
        c.pulse[i].width = 40;
    }
    for (int i = 0; i < EPCIO_ENCODERS; i++)
        c.encoder[i] = (struct encoder_config){ .rate = 4, .index_lines = 2500 };
    for (int i = 0; i < ANALOG_DACS; i++)
        c.trim[i].gain = 1.0;
    return c;
}

static enum epcio_status check(const struct epcio_config *c)
{
    int status;
    for (int i = 0; i < EPCIO_AXES; i++)
        if ((status = pulse_check(&c->pulse[i], EPCIO_WIDTH_MAX)) != 0)
            return (enum epcio_status)(EPCIO_PULSE + status);
    for (int i = 0; i < EPCIO_ENCODERS; i++)
        if ((status = encoder_check(&c->encoder[i])) != 0)
            return (enum epcio_status)(EPCIO_ENCODER + status);
    if (c->loop.scale < 0 || c->loop.scale > PLOOP_SCALE_MAX)
        return EPCIO_BAD_SCALE;
    if (c->loop.limit < 1 || c->loop.limit > PLOOP_LIMIT_MAX)
        return EPCIO_BAD_LIMIT;
    for (int i = 0; i < ANALOG_DACS; i++)
        if (!analog_trim_ok(&c->trim[i]))
            return EPCIO_BAD_TRIM;
    if ((status = adc_check_config(&c->adc)) != 0)
        return (enum epcio_status)(EPCIO_ADC + status);
    if ((status = remote_io_check_config(&c->remote)) != 0)
        return (enum epcio_status)(EPCIO_REMOTE_IO + status);
    return EPCIO_OK;
}

enum epcio_status epcio_reset(struct epcio *card, const struct epcio_config *config)
{
    enum epcio_status status = check(config);
    if (status != EPCIO_OK)
        return status;
    *card = (struct epcio){ .config = *config, .run = true, .local_control.gate = true };
    dda_reset(&card->dda, EPCIO_AXES, 1 << EPCIO_RESET_LENGTH, EPCIO_RESET_DIVIDER);
    for (int i = 0; i < EPCIO_AXES; i++) {
        fifo_reset(&card->fifo[i], EPCIO_FIFO_DEPTH);
        pulse_reset(&card->pulse[i]);
    }
    for (int i = 0; i < EPCIO_ENCODERS; i++) {
        encoder_reset(&card->encoder[i], &config->encoder[i]);
        if (i >= EPCIO_AXES || config->active[i])
            card->counter[card->counters++] = i;
    }
    epcio_plan(card);
    return EPCIO_OK;
}

bool epcio_off(const struct epcio *card)
{
    return card->watchdog.expired || !card->local_control.gate
           || local_io_stopped(&card->local_control, &card->local);
}

static int64_t earlier(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

void epcio_plan(struct epcio *card)
{
    bool run = card->run && card->local_control.gate && !card->watchdog.expired;
    dda_set_run(&card->dda, run, card->clock);
    card->slow_due = earlier(earlier(timer_due(&card->timer), watchdog_due(&card->watchdog)),
                             adc_due(&card->adc));
    for (int i = 0; i < EPCIO_SETS; i++)
        card->slow_due = earlier(card->slow_due, remote_io_due(&card->remote[i]));
}

void epcio_watch_stock(struct epcio *card, int axis)
{
    if (fifo_fell(&card->fifo[axis], card->minimum))
        irq_raise(&card->irq, IRQ_DDA, (uint32_t)1 << (IRQ_DDA_FIFO + axis), card->clock);
}

static void boundary(struct epcio *card)
{
    int32_t next[EPCIO_AXES] = { 0 };
    for (int i = 0; i < EPCIO_AXES; i++) {
        if (!card->config.active[i])
            continue;
        if (!fifo_pop(&card->fifo[i], card->entry[i], &next[i]) && card->dda.command[i] != 0)
            card->underflows[i]++;
        if (card->dda.command[i] != 0)
            pulse_boundary(&card->config.pulse[i], &card->pulse[i], &card->dda, i);
        epcio_watch_stock(card, i);
    }
    dda_begin(&card->dda, next);
    irq_raise(&card->irq, IRQ_DDA, (uint32_t)1 << IRQ_DDA_CYCLE, card->clock);
}

static void arrive(struct epcio *card)
{
    struct bus_write w = bus_take(&card->bus);
    bool refused = false; /* frames behind a refused one are refused, too: nothing overtakes */
    for (int k = 0; k < w.count; k++) {
        refused = refused || epcio_write_frame(card, w.frame[k]) != EPCIO_OK;
        if (refused)
            card->frames_refused++;
        else
            card->frames_taken++;
    }
    card->cmd_ack = w.seq;
}

static void count_timer(struct epcio *card)
{
    timer_fire(&card->timer);
    irq_raise(&card->irq, IRQ_LIO, (uint32_t)1 << IRQ_LIO_TIMER, card->clock);
    if (watchdog_timer_fired(&card->watchdog, card->clock))
        epcio_clear(card);
}

/* Note the latch triggers `source` and `source` + 1, whose events are bits 0 and 1 of `bits`. */
static void note_pair(struct epcio *card, int source, uint32_t bits)
{
    for (int i = 0; i < 2; i++)
        if (bits & (uint32_t)1 << i)
            latch_note(&card->moments, source + i, card->clock);
}

static void convert_voltage(struct epcio *card)
{
    uint32_t events =
        adc_finish(&card->config.adc, &card->adc_control, &card->adc, card->lines.volts);
    irq_raise(&card->irq, IRQ_ADC, events, card->clock);
    note_pair(card, LATCH_ADC, events);
    analog_fire(&card->analog, (events & 0xFF) << ANALOG_BY_ADC);
}

static void exchange(struct epcio *card, int set)
{
    uint32_t events = remote_io_finish(&card->config.remote, &card->remote_control[set],
                                       &card->lines.remote[set], &card->remote[set]);
    irq_raise(&card->irq, set == 0 ? IRQ_RIO0 : IRQ_RIO1, events, card->clock);
    if (set == 0)
        note_pair(card, LATCH_RDI, events);
    analog_fire(&card->analog, (events & 0xF) << (set == 0 ? ANALOG_BY_R0DI : ANALOG_BY_R1DI));
}

/* Do what is due at this clock of timer, watchdog, ADC and remote I/O. */
static void slow_events(struct epcio *card)
{
    if (watchdog_due(&card->watchdog) <= card->clock)
        watchdog_end(&card->watchdog);
    if (timer_due(&card->timer) <= card->clock)
        count_timer(card);
    if (adc_due(&card->adc) <= card->clock)
        convert_voltage(card);
    for (int i = 0; i < EPCIO_SETS; i++)
        if (remote_io_due(&card->remote[i]) <= card->clock)
            exchange(card, i);
    epcio_plan(card);
}

void epcio_advance(struct epcio *card, int64_t clock)
{
    for (;;) {
        int64_t end = dda_boundary(&card->dda);
        int64_t due = bus_due(&card->bus);
        int64_t next = earlier(earlier(end, card->slow_due), due);
        if (next > clock)
            break;
        card->clock = next > card->clock ? next : card->clock;
        if (next == end)
            boundary(card);
        else if (next == card->slow_due)
            slow_events(card);
        else
            arrive(card);
    }
    card->clock = clock;
}

void epcio_encoder_events(struct epcio *card, int encoder, int events)
{
    const struct encoder *e = &card->encoder[encoder];
    enum irq_page page = (enum irq_page)(IRQ_ENC0 + encoder / 3);
    if (events & ENCODER_INDEX)
        irq_raise(&card->irq, page, (uint32_t)1 << (IRQ_ENC_INDEX + encoder % 3), e->index_first);
    if (events & ENCODER_COMPARE) {
        irq_raise(&card->irq, page, (uint32_t)1 << (IRQ_ENC_COMP + encoder % 3), e->compare_clock);
        if (encoder < 8)
            analog_fire(&card->analog, (uint32_t)1 << (ANALOG_BY_ENC + encoder));
    }
}

/* Find the index pulses of this sampling period that latch counters, before any counter moves on:
 * each counter that they latch must be run to their clocks. */
static void foresee_indices(struct epcio *card, uint32_t sources)
{
    for (int k = 0; k < card->counters; k++) {
        const int i = card->counter[k];
        if (!(sources & (uint32_t)1 << (LATCH_INDEX + i)))
            continue;
        struct encoder ahead = card->encoder[i];
        encoder_run(&ahead, card->clock);
        if (ahead.index_first < 0)
            continue;
        latch_note(&card->moments, LATCH_INDEX + i, ahead.index_first);
        latch_note(&card->moments, LATCH_INDEX + i, ahead.index_clock);
    }
}

static void run_encoders(struct epcio *card)
{
    uint32_t sources = 0;
    for (int i = 0; i < EPCIO_ENCODERS; i++)
        sources |= card->latch[i].armed ? card->latch[i].source : 0;
    if (sources != 0)
        foresee_indices(card, sources);
    for (int k = 0; k < card->counters; k++) {
        const int i = card->counter[k];
        struct encoder *e = &card->encoder[i];
        int events = 0;
        int64_t due = latch_due(&card->latch[i], &card->moments);
        if (due >= 0) {
            events = encoder_run(e, due);
            latch_take(&card->latch[i], e->count, due);
        }
        events |= encoder_run(e, card->clock);
        if (events != 0)
            epcio_encoder_events(card, i, events);
    }
    card->moments.came = 0;
}

static void sample_local(struct epcio *card, const struct local_io_lines *lines)
{
    uint32_t events = local_io_sample(&card->local_control, &card->local, lines);
    if (events != 0) {
        irq_raise(&card->irq, IRQ_LIO, events, card->clock);
        note_pair(card, LATCH_LDI, events >> LOCAL_IO_EVENT_LDI);
        analog_fire(&card->analog, (events & 0xF) << ANALOG_BY_LDI
                                       | (events >> LOCAL_IO_EVENT_DFI & 0xF) << ANALOG_BY_DFI);
    }
    if (local_io_stopped(&card->local_control, &card->local))
        epcio_clear(card);
}

enum epcio_status epcio_sample(struct epcio *card, const struct epcio_lines *lines, int *bad)
{
    for (int i = 0; i < ADC_CHANNELS; i++)
        if (!isfinite(lines->volts[i])) {
            *bad = i;
            return EPCIO_BAD_VOLTS;
        }
    for (int k = 0; k < card->counters; k++)
        if (!(fabs(lines->phase[card->counter[k]]) <= QUADRATURE_PHASE_MAX)) {
            *bad = card->counter[k];
            return EPCIO_BAD_PHASE;
        }
    memcpy(&card->lines, lines, offsetof(struct epcio_lines, remote));
    if (!lines->remote_kept)
        memcpy(card->lines.remote, lines->remote, sizeof lines->remote);
    for (int k = 0; k < card->counters; k++) {
        const int i = card->counter[k];
        (lines->unplugged[i] ? encoder_unplugged : encoder_sample)(&card->encoder[i],
                                                                   lines->phase[i], card->clock);
    }
    sample_local(card, &lines->local);
    run_encoders(card);
    return EPCIO_OK;
}

/* The seventh error counter: command of the host minus counts of encoder counter 7. */
static void watch_command(struct epcio *card)
{
    const int i = EPCIO_LOOPS - 1;
    card->command += (int32_t)((uint32_t)card->host.command - (uint32_t)card->command);
    if (ploop_tick(&card->config.loop, &card->loop[i], card->host.loop_on[i], card->command,
                   card->encoder[EPCIO_AXES].count))
        irq_raise(&card->irq, IRQ_PCL, (uint32_t)1 << (IRQ_PCL_OV + i), card->clock);
}

void epcio_control(struct epcio *card)
{
    const struct epcio_config *c = &card->config;
    const struct epcio_host *h = &card->host;
    int64_t pulses[EPCIO_AXES];
    epcio_pulses(card, pulses);
    for (int i = 0; i < EPCIO_AXES; i++) {
        if (!c->active[i])
            continue;
        struct ploop *p = &card->loop[i];
        if (ploop_tick(&c->loop, p, h->loop_on[i], pulses[i], card->encoder[i].count))
            irq_raise(&card->irq, IRQ_PCL, (uint32_t)1 << (IRQ_PCL_OV + i), card->clock);
        card->analog.next[i] =
            h->dac_loop[i] ? ploop_code(&c->loop, p->error, h->gain[i]) : analog_code(h->volts[i]);
    }
    for (int i = EPCIO_AXES; i < ANALOG_DACS; i++)
        card->analog.next[i] = analog_code(h->volts[i]);
    watch_command(card);
}

void epcio_convert(struct epcio *card)
{
    analog_convert(&card->analog);
}

static enum epcio_status refuse(struct epcio *card, enum epcio_status status, int axis,
                                int32_t command)
{
    card->refusal = (struct epcio_refusal){ status, axis, command };
    return status;
}

static bool closed(const struct epcio *card)
{
    return card->watchdog.expired || local_io_stopped(&card->local_control, &card->local);
}

enum epcio_status epcio_write_frame(struct epcio *card, const int32_t frame[EPCIO_AXES])
{
    int32_t largest = dda_largest(card->dda.next_ticks);
    if (closed(card))
        return refuse(card, EPCIO_STOPPED, 0, frame[0]);
    for (int i = 0; i < EPCIO_AXES; i++) {
        if (!card->config.active[i] && frame[i] != 0)
            return refuse(card, EPCIO_AXIS_UNUSED, i, frame[i]);
        if (frame[i] > largest || frame[i] < -largest)
            return refuse(card, EPCIO_COMMAND_TOO_LARGE, i, frame[i]);
        if (card->fifo[i].stock == EPCIO_FIFO_DEPTH) {
            card->overflows++;
            return refuse(card, EPCIO_FIFO_FULL, i, frame[i]);
        }
    }
    for (int i = 0; i < EPCIO_AXES; i++)
        if (card->config.active[i]) {
            fifo_push(&card->fifo[i], card->entry[i], frame[i]);
            epcio_watch_stock(card, i);
        }
    return EPCIO_OK;
}

void epcio_clear(struct epcio *card)
{
    while (bus_due(&card->bus) != INT64_MAX) {
        struct bus_write w = bus_take(&card->bus);
        card->cmd_ack = w.seq;
        card->frames_refused += w.count;
        if (w.count > 0)
            refuse(card, EPCIO_DROPPED, 0, w.frame[0][0]);
    }
    for (int i = 0; i < EPCIO_AXES; i++) {
        fifo_clear(&card->fifo[i]);
        epcio_watch_stock(card, i);
    }
}

void epcio_pulses(const struct epcio *card, int64_t pulses[EPCIO_AXES])
{
    dda_counts(&card->dda, card->clock, pulses);
}

double epcio_volts(const struct epcio *card, int channel)
{
    int32_t code = epcio_off(card) ? 0 : card->analog.code[channel];
    return analog_output(&card->config.trim[channel], code);
}
