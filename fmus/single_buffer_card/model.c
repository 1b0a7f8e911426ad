/* The single-buffer card on the wires of a co-simulation: bus grid, registers, mailboxes. */
#include <math.h>

#include "epcio_damage.h"
#include "vars.h"

struct model {
    struct single_buffer card;
    int64_t period;         /* [clocks] grid of the host bus */
    int64_t instant;        /* [clock] next instant of that grid */
    int32_t cmd_seq;        /* numbers taken last from the mailboxes */
    int32_t ack_seq;
    int32_t clear_seq;
    int32_t warned_length;  /* DDA length that was refused last, to say so once */
    int32_t warned_frames;  /* frames refused when that was last said */
};

#include "fmi_model.h"

/* A decimal period such as 1e-4 s is not exact in binary: off by far less than this [clocks]. */
#define PERIOD_TOLERANCE 1e-6

/* Clocks beyond this are not whole numbers in a double any more (2^53). */
#define CLOCK_MAX 9007199254740992.0

static int model_start(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    double clocks = v->loop_period * EPCIO_CLOCK_HZ;
    if (!(clocks >= 1.0 && clocks < CLOCK_MAX && fabs(clocks - round(clocks)) < PERIOD_TOLERANCE))
        return fmu_fail(f, "loop_period = %.17g s: not a whole number of 25 ns clocks",
                        v->loop_period);
    struct single_buffer_config c = {.latched = v->latched};
    for (int i = 0; i < EPCIO_AXES; i++)
        c.active[i] = v->active[i];
    m->period = (int64_t)round(clocks);
    single_buffer_reset(&m->card, &c);
    return 0;
}

static const char *model_check(const struct state *s)
{
    const struct model *m = &s->m;
    const int64_t clock = s->now / EPCIO_CLOCK_NS;
    if (m->period < 1 || m->instant < clock || m->instant - clock >= m->period)
        return "its next instant is another one";
    return m->card.clock == clock ? epcio_damage_single_buffer(&m->card)
                                  : "its clock is another one";
}

static int set_dda(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    enum single_buffer_status s =
        single_buffer_set_dda(&m->card, v->host_dda_length, v->host_dda_divider);
    if (s == SINGLE_BUFFER_BAD_LENGTH)
        return fmu_fail(f, "host_dda_length = %d: %s", (int)v->host_dda_length,
                        single_buffer_status_text(s));
    if (s == SINGLE_BUFFER_BAD_DIVIDER)
        return fmu_fail(f, "host_dda_divider = %d: %s", (int)v->host_dda_divider,
                        single_buffer_status_text(s));
    if (s == SINGLE_BUFFER_COMMAND_WAITS && m->warned_length != v->host_dda_length) {
        m->warned_length = v->host_dda_length;
        fmu_warn(f, "host_dda_length = %d waits: %s", (int)v->host_dda_length,
                 single_buffer_status_text(s));
    }
    if (s == SINGLE_BUFFER_OK)
        m->warned_length = 0;
    return 0;
}

/* A new number in the command mailbox sends one transaction on its way. */
static int take_command(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    if (v->host_cmd_seq == m->cmd_seq)
        return 0;
    if (!(fabs(v->host_cmd_clock) < CLOCK_MAX))
        return fmu_fail(f, "host_cmd_clock = %g: not a clock", v->host_cmd_clock);
    struct bus_write w = {.seq = v->host_cmd_seq, .clock = (int64_t)ceil(v->host_cmd_clock),
                          .count = v->host_cmd_count};
    for (int k = 0; k < BUS_FRAMES; k++)
        for (int i = 0; i < EPCIO_AXES; i++)
            w.frame[k][i] = v->host_cmd_frames[k][i];
    enum single_buffer_status s = single_buffer_post(&m->card, &w);
    if (s == SINGLE_BUFFER_BAD_COUNT)
        return fmu_fail(f, "host_cmd_count = %d: %s", (int)w.count, single_buffer_status_text(s));
    if (s != SINGLE_BUFFER_OK)
        return fmu_fail(f, "host_cmd_seq = %d: %s", (int)w.seq, single_buffer_status_text(s));
    m->cmd_seq = v->host_cmd_seq;
    return 0;
}

/* Mask, and the acknowledge if it has a new number. */
static void set_interrupts(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    uint32_t mask[IRQ_PAGES], flags[IRQ_PAGES];
    for (int i = 0; i < IRQ_PAGES; i++) {
        mask[i] = (uint32_t)v->host_irq_mask[i];
        flags[i] = (uint32_t)v->host_ack_flags[i];
    }
    if (v->host_ack_seq != m->ack_seq)
        single_buffer_acknowledge(&m->card, flags, mask);
    else
        single_buffer_set_mask(&m->card, mask);
    m->ack_seq = v->host_ack_seq;
}

static int read_host(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    set_interrupts(f);
    if (v->host_clear_seq != m->clear_seq) {
        m->clear_seq = v->host_clear_seq;
        single_buffer_clear(&m->card);
    }
    if (set_dda(f))
        return -1;
    single_buffer_set_run(&m->card, v->host_dda_run);
    return take_command(f);
}

static void warn_refused(struct fmu *f)
{
    struct model *m = &f->s.m;
    const struct single_buffer *card = &m->card;
    if (card->frames_refused == m->warned_frames)
        return;
    fmu_warn(f, "%d frames refused up to transaction %d; axis %d, command %d: %s",
             (int)(card->frames_refused - m->warned_frames), (int)card->cmd_ack,
             (int)card->refusal.axis + 1, (int)card->refusal.command,
             single_buffer_status_text(card->refusal.status));
    m->warned_frames = card->frames_refused;
}

/* Counters are 32-bit registers: they wrap. */
static int32_t wrap(int64_t count)
{
    return (int32_t)(uint32_t)(uint64_t)count;
}

static void publish(struct fmu *f)
{
    struct vars *v = &f->s.v;
    const struct single_buffer *card = &f->s.m.card;
    v->irq = card->irq.line;
    v->irq_seq = wrap(card->irq.seq);
    v->irq_clock = (double)card->irq.clock;
    for (int i = 0; i < IRQ_PAGES; i++)
        v->irq_flags[i] = wrap(card->irq.flags[i]);
    v->cmd_ack = card->cmd_ack;
    v->frames_taken = card->frames_taken;
    v->frames_refused = card->frames_refused;
    int64_t pulses[EPCIO_AXES];
    single_buffer_pulses(card, pulses);
    for (int i = 0; i < EPCIO_AXES; i++) {
        v->stock[i] = card->config.active[i] ? single_buffer_stock(card) : 0;
        v->underflows[i] = single_buffer_underflows(card, i);
        v->gap_clocks[i] = (double)card->gap[i];
        v->pulse_count[i] = wrap(pulses[i]);
    }
}
_Static_assert(sizeof ((struct vars *)0)->irq_flags == IRQ_PAGES * sizeof(int32_t) &&
               sizeof ((struct vars *)0)->host_cmd_frames == sizeof ((struct bus_write *)0)->frame,
               "the wires are as wide as the card's registers");

/* Instants in [t0, t1) read the inputs; the state shown is that at t1. */
static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    struct model *m = &f->s.m;
    int64_t end = t1 / EPCIO_CLOCK_NS;
    (void)t0;
    for (; m->instant < end; m->instant += m->period) {
        single_buffer_advance(&m->card, m->instant);
        if (read_host(f))
            return -1;
    }
    single_buffer_advance(&m->card, end);
    warn_refused(f);
    publish(f);
    return 0;
}
