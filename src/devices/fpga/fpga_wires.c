#include "fpga_wires.h"

#include <math.h>
#include <stddef.h>

static int64_t clock_of(double clock)
{
    return clock > 0.0 ? (int64_t)ceil(clock) : 0;
}

static void take_write(struct fpga *f, const struct fpga_host *host)
{
    struct fpga_write w;
    memset(&w, 0, offsetof(struct fpga_write, words)); /* padding, too: equal states, equal bytes */
    w.seq = host->write_seq;
    w.clock = clock_of(host->write_clock);
    w.memory = host->write_memory;
    w.slots = host->write_slots;
    LINK_CARRY(w.words, host->write_words)
    fpga_post_write(f, &w);
}

void fpga_take(struct fpga_taken *taken, struct fpga *f, const struct fpga_host *host)
{
    if (link_new(&taken->write_seq, host->write_seq))
        take_write(f, host);
    if (link_new(&taken->out_seq, host->out_seq)) {
        for (int i = 0; i < host->out_count; i++)
            fpga_post_entry(f, &(struct fpga_entry){ clock_of(host->out_clock[i]),
                                                     (uint32_t)host->out_mask[i],
                                                     (uint32_t)host->out_value[i] });
    }
    if (link_new(&taken->ao_seq, host->ao_seq)) {
        struct fpga_ao a = { .clock = clock_of(host->ao_clock) };
        LINK_CARRY(a.volts, host->ao)
        fpga_post_ao(f, &a);
    }
    if (link_new(&taken->reset_seq, host->reset_seq))
        fpga_reset_stop(f);
    fpga_set_host(f, host->run, (uint32_t)host->servo);
}

void fpga_show(const struct fpga *f, struct fpga_shown *s)
{
    int64_t pulses[FPGA_PLAYED];

    fpga_pulses(f, pulses);
    for (int i = 0; i < FPGA_AXES; i++) {
        s->pulse_count[i] = link_wrap(pulses[i]);
        s->dropped[i] = link_wrap(f->dropped[i]);
    }
    s->external_count = link_wrap(pulses[FPGA_AXES]);
    s->external_dropped = link_wrap(f->dropped[FPGA_AXES]);
    s->irq_seq = link_wrap(f->irq.seq);
    s->irq_clock = (double)f->irq.clock;
    s->irq_inputs = link_wrap(f->irq.inputs);
    LINK_CARRY(s->irq_ai, f->irq.ai)
    s->input_irq_seq = link_wrap(f->input_irq.seq);
    s->input_irq_clock = (double)f->input_irq.clock;
    s->input_irq_image = link_wrap(f->input_irq.inputs);
    s->inputs = link_wrap(f->inputs.image);
    s->drives = link_wrap(f->drives);
    s->memory = f->playing;
    s->full = 0;
    for (int m = 0; m < FPGA_MEMORIES; m++)
        s->full |= (f->memory[m].slots && f->playing != m) << m;
    s->slot = fpga_slot(f);
    s->write_ack = f->write_ack;
    s->refused = link_wrap(f->refused);
    s->underruns = link_wrap(f->underruns);
    s->late = link_wrap(f->late);
    s->stopped = f->stopped;
    s->stopped_clock = (double)f->stopped_clock;
}
