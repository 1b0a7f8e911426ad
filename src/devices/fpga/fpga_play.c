#include "fpga.h"

static void raise(struct fpga *f)
{
    f->irq.seq++;
    f->irq.clock = f->clock;
    f->irq.inputs = f->inputs.image;
    memcpy(f->irq.ai, f->ai, sizeof f->irq.ai);
}

/* No memory plays any more. */
static void idle(struct fpga *f)
{
    f->playing = -1;
    f->timer = f->clock + f->config.irq_every;
    memset(f->rate, 0, sizeof f->rate);
}

static void begin(struct fpga *f, int32_t memory)
{
    const struct slot_memory *m = &f->memory[memory];
    const double seconds = (double)m->slots * f->config.slot_clocks / FPGA_CLOCK_HZ;
    f->playing = memory;
    f->start = f->clock;
    for (int i = 0; i < FPGA_PLAYED; i++)
        f->rate[i] = m->sum[m->slots][i] / seconds;
    raise(f);
}

/* Add the pulses of the memory that plays, up to the card's clock, to `base` and free it. */
static void leave(struct fpga *f)
{
    fpga_pulses(f, f->base);
    f->memory[f->playing].slots = 0;
}

void fpga_play_stop(struct fpga *f)
{
    int64_t before[FPGA_PLAYED];
    memcpy(before, f->base, sizeof before);
    for (int m = 0; m < FPGA_MEMORIES; m++) {
        const struct slot_memory *slots = &f->memory[m];
        for (int i = 0; i < FPGA_PLAYED && slots->slots; i++)
            f->dropped[i] += slots->sum[slots->slots][i];
    }
    if (f->playing >= 0)
        leave(f);
    for (int i = 0; i < FPGA_PLAYED; i++)
        f->dropped[i] -= f->base[i] - before[i];
    f->memory[0].slots = f->memory[1].slots = 0;
    idle(f);
}

/* The full memory that was marked first; -1 if none is full. */
static int32_t first_full(const struct fpga *f)
{
    const struct slot_memory *m = f->memory;
    if (m[0].slots && m[1].slots)
        return m[0].mark < m[1].mark ? 0 : 1;
    return m[0].slots ? 0 : m[1].slots ? 1 : -1;
}

void fpga_play_exchange(struct fpga *f)
{
    const int32_t last = f->playing;
    if (last >= 0) {
        const int64_t slots = f->memory[last].slots;
        if (f->clock < f->start + slots * f->config.slot_clocks)
            return;
        leave(f);
    }
    const int32_t next = first_full(f);
    if (next >= 0) {
        begin(f, next);
    } else if (last >= 0) {
        f->underruns += f->run;
        idle(f);
    } else if (f->clock >= f->timer) {
        f->timer = f->clock + f->config.irq_every;
        raise(f);
    }
}

void fpga_pulses(const struct fpga *f, int64_t pulses[FPGA_PLAYED])
{
    int32_t played[FPGA_PLAYED] = { 0 };
    if (f->playing >= 0)
        slot_memory_played(&f->memory[f->playing], f->clock - f->start, f->config.slot_clocks,
                           played);
    for (int i = 0; i < FPGA_PLAYED; i++)
        pulses[i] = f->base[i] + played[i];
}

int32_t fpga_slot(const struct fpga *f)
{
    return f->playing < 0 ? 0 : (int32_t)((f->clock - f->start) / f->config.slot_clocks);
}
