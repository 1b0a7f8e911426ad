/* The EPCIO core behind the functions of tick_card.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "register_map.h"
#include "registers.h"
#include "tick_card.h"

static int64_t plain(enum epcio_status s)
{
    switch (s) {
    case EPCIO_OK:                return TICK_OK;
    case EPCIO_FIFO_FULL:         return TICK_FIFO_FULL;
    case EPCIO_FIFO_EMPTY:        return TICK_FIFO_EMPTY;
    case EPCIO_COMMAND_TOO_LARGE: return TICK_COMMAND_TOO_LARGE;
    case EPCIO_AXIS_UNUSED:       return TICK_AXIS_UNUSED;
    case EPCIO_DROPPED:           return TICK_DROPPED;
    case EPCIO_STOPPED:           return TICK_STOPPED;
    case EPCIO_STOCK_TOO_LARGE:   return TICK_STOCK_TOO_LARGE;
    case EPCIO_BUS_FULL:          return TICK_BUS_FULL;
    default:                      return 1000 + (int64_t)s;
    }
}

const char *view_layout(void)
{
#define ROW(name, count) #name " " #count " "
    return CARD_VIEW(ROW);
#undef ROW
}

/* Life and time. */

static struct encoder_config wired_as(const int64_t *row)
{
    return (struct encoder_config){
        .format = ENCODER_AB,
        .rate = (int32_t)row[0],
        .wiring = (uint32_t)row[1],
        .filter = (int32_t)row[2],
        .index_lines = (int32_t)row[3],
    };
}

void card_sample(void *card, int64_t clock, const int64_t *phase, const int64_t *inputs)
{
    struct epcio_lines lines = {
        .local = { .ldi = (uint32_t)inputs[0],
                   .dfi = (uint32_t)inputs[1],
                   .up = (uint32_t)inputs[2],
                   .down = (uint32_t)inputs[3],
                   .stop = inputs[4] != 0,
                   .power = true },
    };
    int bad = 0;
    for (int i = 0; i < TICK_ENCODERS; i++)
        lines.phase[i] = (double)phase[i] / TICK_UNIT;
    epcio_advance(card, clock);
    epcio_convert(card);
    if (epcio_sample(card, &lines, &bad) != EPCIO_OK)
        abort();
}

void *card_create(const int64_t *setup, const int64_t *phase)
{
    static const int64_t AT_REST[5];
    struct epcio_config c = epcio_default_config();
    struct epcio *card = malloc(sizeof *card);
    for (int i = 0; i < TICK_AXES; i++)
        c.active[i] = (setup[0] >> i & 1) != 0;
    c.loop.limit = (int32_t)setup[1];
    for (int i = 0; i < TICK_ENCODERS; i++)
        c.encoder[i] = wired_as(setup + 2 + 4 * i);
    if (card == NULL || epcio_reset(card, &c) != EPCIO_OK) {
        free(card);
        return NULL;
    }
    card_sample(card, 0, phase, AT_REST);
    return card;
}

void card_free(void *card)
{
    free(card);
}

void card_control(void *card)
{
    epcio_control(card);
}

/* What the host writes. */

int64_t card_set_dda(void *card, int64_t length, int64_t divider)
{
    return plain(epcio_set_dda(card, (int32_t)length, (int32_t)divider));
}

int64_t card_set_run(void *card, int64_t run)
{
    epcio_set_run(card, run != 0);
    return TICK_OK;
}

int64_t card_set_minimum(void *card, int64_t minimum)
{
    return plain(epcio_set_minimum(card, (int32_t)minimum));
}

int64_t card_post(void *card, int64_t seq, int64_t clock, int64_t count, const int64_t *frames)
{
    struct bus_write w = { .seq = (int32_t)seq, .clock = clock, .count = (int32_t)count };
    for (int k = 0; k < (int)count; k++)
        for (int i = 0; i < TICK_AXES; i++)
            w.frame[k][i] = (int32_t)frames[TICK_AXES * k + i];
    return plain(epcio_post(card, &w));
}

int64_t card_write_frame(void *card, const int64_t *frame)
{
    int32_t f[TICK_AXES];
    for (int i = 0; i < TICK_AXES; i++)
        f[i] = (int32_t)frame[i];
    return plain(epcio_write_frame(card, f));
}

int64_t card_erase_last(void *card, int64_t axis, int64_t n)
{
    int32_t erased = -1;
    epcio_erase_last(card, (int)axis, (int32_t)n, &erased);
    return erased;
}

int64_t card_shift_out(void *card, int64_t axis, int64_t *command)
{
    int32_t value = 0;
    enum epcio_status s = epcio_shift_out(card, (int)axis, &value);
    *command = value;
    return plain(s);
}

int64_t card_clear(void *card)
{
    epcio_clear(card);
    return TICK_OK;
}

int64_t card_set_encoder(void *card, int64_t encoder, const int64_t *config)
{
    const struct encoder_config c = wired_as(config);
    return plain(epcio_set_encoder(card, (int)encoder, &c));
}

int64_t card_clear_encoders(void *card, int64_t encoders)
{
    return plain(epcio_clear_encoders(card, (uint32_t)encoders));
}

int64_t card_set_compare(void *card, int64_t encoder, int64_t on, int64_t value)
{
    return plain(epcio_set_compare(card, (int)encoder, on != 0, (int32_t)value));
}

int64_t card_set_latch(void *card, int64_t encoder, int64_t source, int64_t keep_last)
{
    return plain(epcio_set_latch(card, (int)encoder, (uint32_t)source, keep_last != 0));
}

int64_t card_set_loops(void *card, int64_t loops)
{
    struct epcio_host host = { .command = ((const struct epcio *)card)->host.command };
    for (int i = 0; i < TICK_LOOPS; i++)
        host.loop_on[i] = (loops >> i & 1) != 0;
    return plain(epcio_set_host(card, &host));
}

int64_t card_clear_loops(void *card, int64_t loops)
{
    return plain(epcio_clear_loops(card, (uint32_t)loops));
}

int64_t card_set_command(void *card, int64_t command)
{
    struct epcio_host host = ((const struct epcio *)card)->host;
    host.command = (int32_t)(uint32_t)(uint64_t)command;
    return plain(epcio_set_host(card, &host));
}

int64_t card_set_local(void *card, const int64_t *set)
{
    struct local_io_control c = { .dedicated = (uint32_t)set[15],
                                  .stop_enable = set[16] != 0,
                                  .gate = set[17] != 0 };
    for (int i = 0; i < LOCAL_IO_LDIS; i++)
        c.ldi_edge[i] = (enum local_io_edge)set[i];
    for (int i = 0; i < LOCAL_IO_DFIS; i++)
        c.dfi_edge[i] = (enum local_io_edge)set[LOCAL_IO_LDIS + i];
    return plain(epcio_set_local_io(card, &c));
}

int64_t card_set_timer(void *card, int64_t on, int64_t period)
{
    return plain(epcio_set_timer(card, on != 0, period));
}

int64_t card_set_watchdog(void *card, int64_t on, int64_t value, int64_t reset)
{
    return plain(epcio_set_watchdog(card, on != 0, (int32_t)value, reset));
}

int64_t card_refresh_watchdog(void *card)
{
    epcio_refresh_watchdog(card);
    return TICK_OK;
}

static void pages(uint32_t to[IRQ_PAGES], const int64_t *from)
{
    for (int i = 0; i < IRQ_PAGES; i++)
        to[i] = (uint32_t)from[i];
}

int64_t card_set_mask(void *card, const int64_t *mask)
{
    uint32_t m[IRQ_PAGES];
    pages(m, mask);
    epcio_set_mask(card, m);
    return TICK_OK;
}

int64_t card_acknowledge(void *card, const int64_t *flags, const int64_t *mask)
{
    uint32_t f[IRQ_PAGES], m[IRQ_PAGES];
    pages(f, flags);
    pages(m, mask);
    epcio_acknowledge(card, f, m);
    return TICK_OK;
}

int64_t card_reset_module(void *card, int64_t module)
{
    return plain(epcio_reset_module(card, (enum epcio_module)module));
}

/* What is out of range. */

static enum epcio_status bad_dda(struct epcio *card, int k, int *want)
{
    static const int WANT[] = { EPCIO_BAD_LENGTH,  EPCIO_BAD_LENGTH,  EPCIO_BAD_DIVIDER,
                                EPCIO_BAD_DIVIDER, EPCIO_BAD_MINIMUM, EPCIO_BAD_MINIMUM,
                                EPCIO_BAD_COUNT,   EPCIO_BAD_COUNT,   EPCIO_BAD_AXIS,
                                EPCIO_BAD_AXIS,    EPCIO_BAD_COUNT,   EPCIO_BAD_AXIS };
    struct bus_write w = { .clock = card->clock, .count = k == 6 ? -1 : BUS_FRAMES + 1 };
    int32_t out;
    *want = WANT[k];
    switch (k) {
    case 0:  return epcio_set_dda(card, EPCIO_LENGTH_MIN - 1, 1);
    case 1:  return epcio_set_dda(card, EPCIO_LENGTH_MAX + 1, 1);
    case 2:  return epcio_set_dda(card, 10, 0);
    case 3:  return epcio_set_dda(card, 10, EPCIO_DIVIDER_MAX + 1);
    case 4:  return epcio_set_minimum(card, -1);
    case 5:  return epcio_set_minimum(card, EPCIO_FIFO_DEPTH);
    case 6:  return epcio_post(card, &w);
    case 7:  return epcio_post(card, &w);
    case 8:  return epcio_erase_last(card, EPCIO_AXES, 1, &out);
    case 9:  return epcio_erase_last(card, -1, 1, &out);
    case 10: return epcio_erase_last(card, 0, -1, &out);
    default: return epcio_shift_out(card, EPCIO_AXES, &out);
    }
}

static enum epcio_status bad_encoder(struct epcio *card, int k, int *want)
{
    static const int WANT[] = { EPCIO_ENCODER + ENCODER_BAD_FORMAT,
                                EPCIO_ENCODER + ENCODER_BAD_RATE,
                                EPCIO_ENCODER + ENCODER_BAD_WIRING,
                                EPCIO_ENCODER + ENCODER_BAD_FILTER,
                                EPCIO_ENCODER + ENCODER_BAD_FILTER,
                                EPCIO_ENCODER + ENCODER_BAD_INDEX,
                                EPCIO_BAD_AXIS,
                                EPCIO_BAD_MASK,
                                EPCIO_BAD_AXIS,
                                EPCIO_BAD_AXIS,
                                EPCIO_BAD_MASK,
                                EPCIO_BAD_MASK };
    struct encoder_config c = { ENCODER_AB, 4, 0, 0, 4 };
    *want = WANT[k];
    switch (k) {
    case 0:  c.format = (enum encoder_format)4; break;
    case 1:  c.rate = 3; break;
    case 2:  c.wiring = 16; break;
    case 3:  c.filter = -1; break;
    case 4:  c.filter = ENCODER_FILTER_MAX + 1; break;
    case 5:  c.index_lines = 0; break;
    case 6:  return epcio_set_encoder(card, EPCIO_ENCODERS, &c);
    case 7:  return epcio_clear_encoders(card, 1u << EPCIO_ENCODERS);
    case 8:  return epcio_set_compare(card, -1, true, 1);
    case 9:  return epcio_set_latch(card, EPCIO_ENCODERS, 1, false);
    case 10: return epcio_set_latch(card, 0, 1u << LATCH_SOURCES, false);
    default: return epcio_clear_loops(card, 1u << EPCIO_LOOPS);
    }
    return epcio_set_encoder(card, 0, &c);
}

static enum epcio_status bad_io(struct epcio *card, int k, int *want)
{
    static const int WANT[] = { EPCIO_LOCAL_IO + LOCAL_IO_BAD_EDGE,
                                EPCIO_LOCAL_IO + LOCAL_IO_BAD_DEDICATED,
                                EPCIO_TIMER + TIMER_BAD_PERIOD,
                                EPCIO_TIMER + TIMER_BAD_PERIOD,
                                EPCIO_TIMER + TIMER_BAD_VALUE,
                                EPCIO_TIMER + TIMER_BAD_VALUE,
                                EPCIO_TIMER + TIMER_BAD_RESET,
                                EPCIO_BAD_MODULE,
                                EPCIO_BAD_MODULE,
                                EPCIO_BAD_REGISTER,
                                EPCIO_BAD_VALUE,
                                EPCIO_BAD_GAIN,
                                EPCIO_BAD_VOLTS };
    struct local_io_control c = card->local_control;
    struct epcio_host host = card->host;
    *want = WANT[k];
    switch (k) {
    case 0:  c.dfi_edge[6] = (enum local_io_edge)3; break;
    case 1:  c.dedicated = 1u << LOCAL_IO_DFIS; break;
    case 2:  return epcio_set_timer(card, true, 0);
    case 3:  return epcio_set_timer(card, false, TIMER_PERIOD_MAX + 1);
    case 4:  return epcio_set_watchdog(card, true, 0, 1);
    case 5:  return epcio_set_watchdog(card, false, WATCHDOG_VALUE_MAX + 1, 1);
    case 6:  return epcio_set_watchdog(card, true, 1, 0);
    case 7:  return epcio_reset_module(card, (enum epcio_module)0);
    case 8:  return epcio_reset_module(card, (enum epcio_module)(EPCIO_RESET_ALL + 1));
    case 9:  return epcio_write(card, 0x7FF, 1.0);
    case 10: return epcio_write(card, REG_TIMER_PERIOD, NAN);
    case 11: host.gain[5] = PLOOP_GAIN_MAX + 1; return epcio_set_host(card, &host);
    case 12: host.volts[7] = INFINITY; return epcio_set_host(card, &host);
    }
    return epcio_set_local_io(card, &c);
}

int64_t card_write_badly(void *card, int64_t k)
{
    enum { DDA = 12, ENCODER = 12, IO = 13 };
    int want, n = (int)k;
    enum epcio_status s;
    if (n < 0 || n >= DDA + ENCODER + IO)
        return -1;
    struct epcio *before = malloc(sizeof *before);
    if (before == NULL)
        abort();
    memcpy(before, card, sizeof *before);
    if (n < DDA)
        s = bad_dda(card, n, &want);
    else if (n < DDA + ENCODER)
        s = bad_encoder(card, n - DDA, &want);
    else
        s = bad_io(card, n - DDA - ENCODER, &want);
    bool same = memcmp(before, card, sizeof *before) == 0;
    free(before);
    return (int)s != want ? 1 : same ? 0 : 2;
}

/* What can be seen. */

/* [bit] */
static int64_t length_of(int32_t ticks)
{
    int64_t length = 0;
    while (ticks >> length > 1)
        length++;
    return length;
}

static void view_counters(const struct epcio *c, struct view *v)
{
    for (int i = 0; i < TICK_ENCODERS; i++) {
        const struct encoder *e = &c->encoder[i];
        const struct latch *l = &c->latch[i];
        v->count[i] = e->count;
        v->too_fast[i] = e->too_fast;
        v->index_seen[i] = e->index_seen;
        v->index_clock[i] = e->index_clock;
        v->index_count[i] = e->index_count;
        v->reached[i] = e->reached;
        v->compare_clock[i] = e->compare_clock;
        v->latch_armed[i] = l->armed;
        v->latch_seen[i] = l->seen;
        v->latch_value[i] = l->value;
        v->latch_clock[i] = l->clock;
    }
}

static void view_axes(const struct epcio *c, struct view *v)
{
    int64_t pulses[EPCIO_AXES];
    epcio_pulses(c, pulses);
    for (int i = 0; i < TICK_AXES; i++) {
        const struct fifo *f = &c->fifo[i];
        v->before[i] = c->dda.before[i];
        v->command[i] = c->dda.command[i];
        v->pulses[i] = pulses[i];
        v->underflows[i] = c->underflows[i];
        v->stock[i] = f->stock;
        for (int k = 0; k < f->stock; k++)
            v->queue[TICK_DEPTH * i + k] = c->entry[i][(f->head + k) % EPCIO_FIFO_DEPTH];
    }
    for (int i = 0; i < TICK_LOOPS; i++) {
        v->error[i] = c->loop[i].error;
        v->over[i] = c->loop[i].over;
    }
}

void card_view(const void *card, struct view *v)
{
    const struct epcio *c = card;
    memset(v, 0, sizeof *v);
    *v->clock = c->clock;
    *v->length = length_of(c->dda.ticks);
    *v->divider = c->dda.divider;
    *v->next_length = length_of(c->dda.next_ticks);
    *v->next_divider = c->dda.next_divider;
    *v->minimum = c->minimum;
    *v->overflows = c->overflows;
    *v->on_the_way = c->bus.used;
    *v->cmd_ack = c->cmd_ack;
    *v->frames_taken = c->frames_taken;
    *v->frames_refused = c->frames_refused;
    v->refusal[0] = plain(c->refusal.status);
    v->refusal[1] = c->refusal.axis;
    v->refusal[2] = c->refusal.command;
    view_axes(c, v);
    view_counters(c, v);
    *v->inputs = c->local.inputs;
    *v->off = epcio_off(c);
    *v->timer_count = c->timer.count;
    *v->timer_now = c->timer.on ? c->clock - c->timer.start : 0;
    *v->expired = c->watchdog.expired;
    *v->resetting = c->watchdog.resetting;
    *v->watchdog_count = c->watchdog.count;
    for (int i = 0; i < TICK_PAGES; i++) {
        v->flags[i] = c->irq.flags[i];
        v->again[i] = c->irq.again[i];
        v->mask[i] = c->irq.mask[i];
    }
    *v->line = c->irq.line;
    *v->irq_seq = c->irq.seq;
    *v->irq_clock = c->irq.clock;
}
