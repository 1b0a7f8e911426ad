/* The EPCIO card on the wires of a co-simulation: sampling grid, registers, mailboxes. */
#include <math.h>

#include "epcio.h"
#include "vars.h"

struct model {
    struct epcio card;
    int64_t period;         /* [clocks] sampling grid of loops and host bus */
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

static int check_rates(struct fmu *f, const char *name, const int32_t *rate, int count)
{
    for (int i = 0; i < count; i++)
        if (rate[i] != 0 && rate[i] != 1 && rate[i] != 2 && rate[i] != 4)
            return fmu_fail(f, "%s[%d] = %d: an encoder multiplies by 0, 1, 2 or 4", name, i + 1,
                            (int)rate[i]);
    return 0;
}

static int model_start(struct fmu *f)
{
    struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    double clocks = v->loop_period * EPCIO_CLOCK_HZ;
    if (!(clocks >= 1.0 && clocks < CLOCK_MAX && fabs(clocks - round(clocks)) < PERIOD_TOLERANCE))
        return fmu_fail(f, "loop_period = %.17g s: not a whole number of 25 ns clocks",
                        v->loop_period);
    if (check_rates(f, "enc_rate", v->enc_rate, 6) ||
        check_rates(f, "enc_rate_aux", v->enc_rate_aux, 3))
        return -1;
    struct epcio_config c = {.loop = {.limit = v->error_limit, .scale = v->p_scale}};
    for (int i = 0; i < 6; i++) {
        c.active[i] = v->active[i];
        c.encoder[i] =
            (struct encoder_config){v->enc_rate[i], v->enc_inverse[i], v->index_lines[i]};
    }
    for (int i = 0; i < 3; i++)
        c.encoder[6 + i] = (struct encoder_config){v->enc_rate_aux[i], v->enc_inverse_aux[i],
                                                   v->index_lines_aux[i]};
    *m = (struct model){.period = (int64_t)round(clocks)};
    epcio_reset(&m->card, &c);
    v->irq = false;
    v->irq_seq = v->irq_flags = 0;
    v->irq_clock = 0.0;
    v->cmd_ack = v->frames_taken = v->frames_refused = 0;
    for (int i = 0; i < 6; i++) {
        v->stock[i] = v->underflows[i] = v->pulse_count[i] = 0;
        v->enc_count[i] = v->err_count[i] = 0;
        v->dac[i] = 0.0;
    }
    for (int i = 0; i < 3; i++)
        v->enc_count_aux[i] = 0;
    for (int i = 0; i < 2; i++)
        v->dac_aux[i] = 0.0;
    return 0;
}

static int set_dda(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    enum epcio_status s = epcio_set_dda(&m->card, v->host_dda_length, v->host_dda_divider);
    if (s == EPCIO_BAD_LENGTH)
        return fmu_fail(f, "host_dda_length = %d: %s", (int)v->host_dda_length,
                        epcio_status_text(s));
    if (s == EPCIO_BAD_DIVIDER)
        return fmu_fail(f, "host_dda_divider = %d: %s", (int)v->host_dda_divider,
                        epcio_status_text(s));
    if (s == EPCIO_STOCK_TOO_LARGE && m->warned_length != v->host_dda_length) {
        m->warned_length = v->host_dda_length;
        fmu_warn(f, "host_dda_length = %d waits: %s", (int)v->host_dda_length,
                 epcio_status_text(s));
    }
    if (s == EPCIO_OK)
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
    if (v->host_cmd_count < 0 || v->host_cmd_count > BUS_FRAMES)
        return fmu_fail(f, "host_cmd_count = %d: a transaction has 0 to %d frames",
                        (int)v->host_cmd_count, BUS_FRAMES);
    if (!(fabs(v->host_cmd_clock) < CLOCK_MAX))
        return fmu_fail(f, "host_cmd_clock = %g: not a clock", v->host_cmd_clock);
    struct bus_write w = {.seq = v->host_cmd_seq, .clock = (int64_t)ceil(v->host_cmd_clock),
                          .count = v->host_cmd_count};
    for (int k = 0; k < w.count; k++)
        for (int i = 0; i < 6; i++)
            w.frame[k][i] = v->host_cmd_frames[k][i];
    enum epcio_status s = epcio_post(&m->card, &w);
    if (s != EPCIO_OK)
        return fmu_fail(f, "host_cmd_seq = %d: %s", (int)w.seq, epcio_status_text(s));
    m->cmd_seq = v->host_cmd_seq;
    return 0;
}

static int read_host(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    struct epcio *card = &m->card;
    if (v->host_ack_seq != m->ack_seq) {
        m->ack_seq = v->host_ack_seq;
        epcio_acknowledge(card, (uint32_t)v->host_ack_flags, (uint32_t)v->host_irq_mask);
    } else {
        epcio_set_mask(card, (uint32_t)v->host_irq_mask);
    }
    if (v->host_clear_seq != m->clear_seq) {
        m->clear_seq = v->host_clear_seq;
        epcio_clear(card);
    }
    if (set_dda(f))
        return -1;
    epcio_set_run(card, v->host_dda_run);
    epcio_set_minimum(card, v->host_min_stock);
    for (int i = 0; i < 6; i++) {
        card->host.gain[i] = v->host_p_gain[i];
        card->host.loop_on[i] = v->host_loop_on[i];
        card->host.dac_loop[i] = v->host_dac_source[i] == 1;
        card->host.volts[i] = v->host_dac_volts[i];
    }
    for (int i = 0; i < 2; i++)
        card->host.volts[6 + i] = v->host_dac_volts_aux[i];
    return take_command(f);
}

static int sample_encoders(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    double phase[EPCIO_ENCODERS];
    for (int i = 0; i < 6; i++)
        phase[i] = v->enc_phase[i];
    for (int i = 0; i < 3; i++)
        phase[6 + i] = v->enc_phase_aux[i];
    int bad = 0;
    enum epcio_status s = epcio_sample(&f->s.m.card, phase, &bad);
    if (s != EPCIO_OK)
        return fmu_fail(f, "enc_phase%s[%d] = %g: %s", bad < 6 ? "" : "_aux",
                        bad < 6 ? bad + 1 : bad - 5, phase[bad], epcio_status_text(s));
    return 0;
}

static void warn_refused(struct fmu *f)
{
    struct model *m = &f->s.m;
    const struct epcio *card = &m->card;
    if (card->frames_refused == m->warned_frames)
        return;
    fmu_warn(f, "%d frames refused up to transaction %d; axis %d, command %d: %s",
             (int)(card->frames_refused - m->warned_frames), (int)card->cmd_ack,
             (int)card->refusal.axis + 1, (int)card->refusal.command,
             epcio_status_text(card->refusal.status));
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
    const struct epcio *card = &f->s.m.card;
    v->irq = card->irq.line;
    v->irq_seq = wrap(card->irq.seq);
    v->irq_clock = (double)card->irq.clock;
    v->irq_flags = wrap(card->irq.flags);
    v->cmd_ack = card->cmd_ack;
    v->frames_taken = card->frames_taken;
    v->frames_refused = card->frames_refused;
    int64_t pulses[EPCIO_AXES];
    epcio_pulses(card, pulses);
    for (int i = 0; i < 6; i++) {
        if (!card->config.active[i])
            continue;
        v->stock[i] = card->fifo[i].stock;
        v->underflows[i] = card->underflows[i];
        v->pulse_count[i] = wrap(pulses[i]);
        v->enc_count[i] = wrap(card->encoder[i].count);
        v->err_count[i] = card->loop[i].error;
        v->dac[i] = analog_volts(card->analog.code[i]);
    }
    for (int i = 0; i < 3; i++)
        v->enc_count_aux[i] = wrap(card->encoder[6 + i].count);
    for (int i = 0; i < 2; i++)
        v->dac_aux[i] = analog_volts(card->analog.code[6 + i]);
}

/* Instants in [t0, t1) read the inputs; the state shown is that at t1, with the DAC codes of the
 * latest instant before t1 if t1 is an instant itself. */
static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    struct model *m = &f->s.m;
    int64_t end = t1 / EPCIO_CLOCK_NS;
    (void)t0;
    for (; m->instant < end; m->instant += m->period) {
        epcio_advance(&m->card, m->instant);
        epcio_convert(&m->card);
        if (sample_encoders(f) || read_host(f))
            return -1;
        epcio_control(&m->card);
    }
    epcio_advance(&m->card, end);
    if (m->instant == end)
        epcio_convert(&m->card);
    warn_refused(f);
    publish(f);
    return 0;
}
