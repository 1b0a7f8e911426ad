#include "fpga.h"

static int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static int64_t most(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

const char *fpga_status_text(enum fpga_status s)
{
    switch (s) {
    case FPGA_OK:         return "taken";
    case FPGA_BAD_MEMORY: return "there are pulse memories 0 and 1";
    case FPGA_NO_SLOTS:   return "a memory has 1 to 128 slots";
    case FPGA_BAD_SLOT:   return "a byte is not the pulses of a slot";
    case FPGA_NOT_FREE:   return "the memory is full and waits";
    case FPGA_PLAYS:      return "the memory plays";
    case FPGA_STOPPED:    return "a stop acts";
    case FPGA_ON_THE_WAY: return "too many are on their way";
    }
    return "unknown";
}

int64_t fpga_next_exchange(const struct fpga *f)
{
    const int64_t slot = f->config.slot_clocks;
    return (f->clock / slot + 1) * slot;
}

int64_t fpga_exchange_of(const struct fpga *f, int64_t clock)
{
    const int64_t slot = f->config.slot_clocks;
    return (clock + slot - 1) / slot * slot;
}

void fpga_reset(struct fpga *f, const struct fpga_config *config)
{
    memset(f, 0, sizeof *f);
    f->config = *config;
    f->playing = -1;
    f->timer = config->irq_every;
    f->inputs.first = INT64_MAX;
    f->pending = true; /* the first exchange reads the pins as they are then */
}

static void exchange_inputs(struct fpga *f)
{
    struct fpga_inputs *in = &f->inputs;
    if (in->first <= f->clock) {
        in->first = INT64_MAX;
        for (int i = 0; i < FPGA_CHANNELS; i++) {
            const uint32_t bit = (uint32_t)1 << i;
            if (!(in->coming & bit))
                continue;
            if (in->clock[i] > f->clock) {
                in->first = least(in->first, in->clock[i]);
                continue;
            }
            in->level ^= bit;
            in->coming &= ~bit;
        }
    }
    f->drives = f->drive_pins;
    const uint32_t changed = in->level ^ in->image;
    in->image = in->level;
    if (changed & f->config.input_irq_mask) {
        f->input_irq.seq++;
        f->input_irq.clock = f->clock;
        f->input_irq.inputs = in->image;
    }
}

static void exchange_outputs(struct fpga *f)
{
    int32_t n = 0;
    for (; n < f->entering && f->entries[n].clock <= f->clock; n++)
        f->host_outputs =
            (f->host_outputs & ~f->entries[n].mask) | (f->entries[n].value & f->entries[n].mask);
    if (n) {
        f->entering -= n;
        memmove(f->entries, f->entries + n, (size_t)f->entering * sizeof *f->entries);
    }
    const uint32_t follow = f->config.follow_mask;
    const uint32_t outputs = (f->host_outputs & ~follow) | (f->inputs.image & follow);
    uint32_t changed = outputs ^ f->outputs;
    f->switched += changed != 0;
    for (int i = 0; changed; i++, changed >>= 1) {
        if (changed & 1)
            f->output_clock[i] = f->clock;
    }
    f->outputs = outputs;
    for (n = 0; n < f->ao_waiting && f->aos[n].clock <= f->clock; n++)
        memcpy(f->ao, f->aos[n].volts, sizeof f->ao);
    if (n) {
        f->ao_waiting -= n;
        memmove(f->aos, f->aos + n, (size_t)f->ao_waiting * sizeof *f->aos);
    }
}

static void exchange_stop(struct fpga *f)
{
    const struct fpga_config *c = &f->config;
    const bool alarm = c->alarm_stops && f->drives >> 8;
    const bool cause = f->emergency || alarm || ((f->inputs.image ^ c->stop_low) & c->stop_mask);
    if (f->reset && !cause)
        f->stopped = false;
    f->reset = false;
    if (cause && !f->stopped) {
        f->stopped = true;
        f->stopped_clock = f->clock;
        fpga_play_stop(f);
    }
    f->servo = f->stopped && c->stop_servo_off ? 0 : f->host_servo;
}

/* Clock of the first exchange behind the card's clock that has something to do. */
static int64_t due(const struct fpga *f)
{
    const int64_t next = fpga_next_exchange(f);
    if (f->pending)
        return next;
    const struct slot_memory *m = f->memory;
    int64_t clock = f->timer;
    if (f->playing >= 0)
        clock = f->start + (int64_t)m[f->playing].slots * f->config.slot_clocks;
    else if (m[0].slots || m[1].slots)
        return next;
    if (f->inputs.coming)
        clock = least(clock, fpga_exchange_of(f, f->inputs.first));
    if (f->entering)
        clock = least(clock, fpga_exchange_of(f, f->entries[0].clock));
    if (f->ao_waiting)
        clock = least(clock, fpga_exchange_of(f, f->aos[0].clock));
    return most(clock, next);
}

static void exchange(struct fpga *f)
{
    f->pending = false;
    exchange_inputs(f);
    exchange_outputs(f);
    exchange_stop(f);
    fpga_play_exchange(f);
}

enum fpga_status fpga_refuse(struct fpga *f, enum fpga_status s)
{
    f->refused++;
    f->refusal.status = s;
    return s;
}

/* The oldest write on its way arrives: take it or refuse it. */
static void arrive(struct fpga *f)
{
    const struct fpga_write *w = &f->writes[0];
    struct slot_memory *m = &f->memory[w->memory];
    enum fpga_status s = FPGA_OK;
    f->refusal.seq = f->write_ack = w->seq;
    f->refusal.memory = w->memory;
    if (f->stopped)
        s = FPGA_STOPPED;
    else if (m->slots)
        s = f->playing == w->memory ? FPGA_PLAYS : FPGA_NOT_FREE;
    else if (!slot_memory_fill(m, w->words, w->slots, f->config.format,
                               fpga_slot_most(f->config.format, f->config.slot_clocks),
                               &f->refusal.at))
        s = FPGA_BAD_SLOT;
    if (s != FPGA_OK)
        fpga_refuse(f, s);
    else
        m->mark = f->marks++;
    f->writing--;
    memmove(f->writes, f->writes + 1, (size_t)f->writing * sizeof *f->writes);
}

void fpga_advance(struct fpga *f, int64_t clock)
{
    for (;;) {
        const int64_t e = due(f);
        const int64_t w = f->writing ? most(f->writes[0].clock, f->clock) : INT64_MAX;
        if (least(e, w) > clock)
            break;
        f->clock = least(e, w);
        if (e <= w)
            exchange(f);
        else
            arrive(f);
    }
    f->clock = clock;
}

enum fpga_status fpga_post_write(struct fpga *f, const struct fpga_write *w)
{
    f->refusal.seq = w->seq;
    f->refusal.memory = w->memory;
    if (w->memory < 0 || w->memory >= FPGA_MEMORIES)
        return fpga_refuse(f, FPGA_BAD_MEMORY);
    if (w->slots < 1 || w->slots > FPGA_SLOTS)
        return fpga_refuse(f, FPGA_NO_SLOTS);
    if (f->writing == FPGA_WRITES)
        return fpga_refuse(f, FPGA_ON_THE_WAY);
    /* It is late if a switch, or an exchange that waited for a mark, has passed since its clock. */
    const int64_t latest =
        f->playing >= 0 ? f->start : fpga_next_exchange(f) - f->config.slot_clocks;
    f->late += w->clock > 0 && w->clock < latest;
    f->writes[f->writing++] = *w;
    return FPGA_OK;
}
