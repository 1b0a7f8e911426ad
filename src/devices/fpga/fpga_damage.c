#include "fpga.h"

/* Clocks and counts of a sound state are far from where sums leave 64 bits: 7 years of clocks. */
static const int64_t CLOCK_MAX = (int64_t)1 << 53;

static bool sane(int64_t count)
{
    return count > -CLOCK_MAX && count < CLOCK_MAX;
}

static bool config_sound(const struct fpga_config *c)
{
    return c->slot_clocks >= FPGA_SLOT_CLOCKS_MIN && c->slot_clocks <= FPGA_SLOT_CLOCKS_MAX
           && (c->format == FPGA_COUNTS || c->format == FPGA_BITS) && c->irq_every > 0
           && sane(c->irq_every);
}

static bool memories_sound(const struct fpga *f)
{
    for (int m = 0; m < FPGA_MEMORIES; m++) {
        if (f->memory[m].slots < 0 || f->memory[m].slots > FPGA_SLOTS)
            return false;
    }
    for (int i = 0; i < FPGA_AXES; i++) {
        if (!sane(f->base[i]) || !sane(f->dropped[i]))
            return false;
    }
    if (f->playing == -1)
        return true;
    if (f->playing < 0 || f->playing >= FPGA_MEMORIES || !sane(f->start))
        return false;
    const int64_t end = f->start + (int64_t)f->memory[f->playing].slots * f->config.slot_clocks;
    return f->start <= f->clock && end > f->clock;
}

static bool queues_sound(const struct fpga *f)
{
    bool sound = f->writing >= 0 && f->writing <= FPGA_WRITES && f->entering >= 0
                 && f->entering <= FPGA_WAITING && f->ao_waiting >= 0
                 && f->ao_waiting <= FPGA_AO_WRITES;
    for (int32_t i = 0; sound && i < f->writing; i++) {
        const struct fpga_write *w = &f->writes[i];
        sound = w->slots >= 1 && w->slots <= FPGA_SLOTS && w->memory >= 0
                && w->memory < FPGA_MEMORIES;
    }
    for (int32_t i = 0; sound && i < f->entering; i++)
        sound = sane(f->entries[i].clock);
    for (int32_t i = 0; sound && i < f->ao_waiting; i++)
        sound = sane(f->aos[i].clock);
    return sound;
}

static bool inputs_sound(const struct fpga_inputs *in)
{
    bool sound = !in->coming || sane(in->first);
    for (int i = 0; i < FPGA_CHANNELS; i++)
        sound = sound && sane(in->clock[i]);
    return sound;
}

const char *fpga_damage(const struct fpga *f)
{
    if (!config_sound(&f->config))
        return "the card has other parameters";
    if (f->clock < 0 || !sane(f->clock) || !sane(f->timer))
        return "the card's clock is another one";
    if (!memories_sound(f))
        return "a pulse memory is damaged";
    if (!queues_sound(f))
        return "what is on its way to the card is damaged";
    if (!inputs_sound(&f->inputs))
        return "an input changes at no clock";
    if (!sane(f->irq.seq) || !sane(f->input_irq.seq) || !sane(f->refused) || !sane(f->late)
        || !sane(f->underruns) || !sane(f->marks))
        return "a counter is damaged";
    return NULL;
}
