/* FMU of the EPCIO card (core epcio): sampling grid, register and mailbox inputs, outputs. */
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "epcio.h"
#include "host.h"
#include "register_map.h"
#include "registers.h"
#include "vars.h"

struct model {
    struct epcio card;
    int64_t period;               /* [clocks] sampling grid of loops and host bus */
    int64_t instant;              /* [clock] next instant of that grid */
    bool powered;                 /* the first instant has passed */
    struct mailbox taken;         /* sequence numbers taken last from the host */
    struct link_host levels;      /* levels taken last from the host */
    bool levels_hold;             /* the card still has these levels */
    int32_t reg_seq;              /* sequence number taken last from the mailbox of registers */
    enum epcio_status reg_status; /* status of that transaction */
    int32_t warned_length;        /* DDA length that has to wait and was warned of */
    int32_t warned_frames;        /* number of refused frames that were warned of */
};

#include "fmi_model.h"
#include "card_wires.h"
#include "epcio_outputs.h"
#include "epcio_power_on.h"

static int model_start(struct fmu *f)
{
    struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    const struct epcio_config c = config_of(v);
    *m = (struct model){ .period = wires_period(f) };
    if (m->period == 0)
        return -1;
    enum epcio_status s = epcio_reset(&m->card, &c);
    if (s != EPCIO_OK)
        return refuse_config(f, s);
    if (write_power_on(f))
        return -1;
    for (int i = 0; i < EPCIO_AXES; i++)
        v->pulse_clock[i] = -1.0;
    return 0;
}

/* If the register mailbox has a new number, write its registers in order, up to the first that the
 * card refuses. */
static void take_registers(struct fmu *f)
{
    struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    enum epcio_status s = EPCIO_OK;
    if (v->reg_seq == m->reg_seq)
        return;
    for (int i = 0; i < v->reg_count && s == EPCIO_OK; i++) {
        s = epcio_write(&m->card, v->reg_address[i], v->reg_value[i]);
        if (s != EPCIO_OK)
            fmu_warn(f, "register 0x%03X = %g refused in transaction %d: %s",
                     (unsigned)v->reg_address[i], v->reg_value[i], (int)v->reg_seq,
                     epcio_status_text(s));
    }
    m->reg_seq = v->reg_seq;
    m->reg_status = s;
    m->levels_hold = false;
}

/* Take the host's levels, unless they are those that hold in the card. */
static int take_levels(struct fmu *f)
{
    enum {
        SIZE = offsetof(struct link_host, cmd_seq)
    }; /* [byte] of the levels: the frames stand behind them */
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    struct link_host link;
    memset(&link, 0, SIZE);
    LINK_LEVELS(WIRES_READ)
    LINK_LEVELS_AUX(WIRES_READ)
    if (m->levels_hold && memcmp(&m->levels, &link, SIZE) == 0)
        return 0;
    const enum epcio_status s = host_take_levels(&m->taken, &m->card, &link);
    memcpy(&m->levels, &link, SIZE);
    m->levels_hold = s == EPCIO_OK;
    if (s == EPCIO_BAD_MINIMUM)
        return fmu_fail(f, "host_min_stock = %d: %s", (int)v->host_min_stock, epcio_status_text(s));
    if (s == EPCIO_BAD_GAIN || s == EPCIO_BAD_VOLTS)
        return fmu_fail(f, "host registers: %s", epcio_status_text(s));
    return wires_dda(f, s);
}

static int read_host(struct fmu *f)
{
    struct model *m = &f->s.m;
    if (take_levels(f))
        return -1;
    take_registers(f);
    struct bus_write w;
    const int command = wires_command(f, &w);
    return command > 0 ? wires_sent(f, &w, epcio_post(&m->card, &w)) : command;
}

/* Up to eight levels, a byte each, as bits: a factor moves byte k to bit 56 + k. */
static uint32_t bits_of(const bool *level, size_t count)
{
#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__
    uint64_t bytes = 0;
    memcpy(&bytes, level, count);
    return (uint32_t)(bytes * UINT64_C(0x0102040810204080) >> 56);
#else
    uint32_t bits = 0;
    for (size_t i = 0; i < count; i++)
        bits |= (uint32_t)level[i] << i;
    return bits;
#endif
}

static void read_pins(const struct vars *v, struct epcio_lines *l)
{
    for (int i = 0; i < 6; i++) {
        l->phase[i] = v->enc_phase[i];
        l->volts[i] = v->io_volts[i];
    }
    for (int i = 0; i < 3; i++)
        l->phase[6 + i] = v->enc_phase_aux[i] + v->enc_phase_six_aux[i];
    memcpy(l->unplugged, v->enc_unplugged, sizeof l->unplugged);
    for (int i = 0; i < 2; i++)
        l->volts[6 + i] = v->io_volts_aux[i];
    l->local = (struct local_io_lines){
        .ldi = bits_of(v->io_ldi, 8),
        .dfi = bits_of(v->io_dfi, 7),
        .home = bits_of(v->io_home, 6),
        .up = bits_of(v->io_up, 6),
        .down = bits_of(v->io_down, 6),
        .stop = v->io_stop,
        .power = v->io_power,
    };
}

static void read_remote(const struct vars *v, struct epcio_lines *l)
{
    memset(l->remote, 0, sizeof l->remote);
    for (int i = 0; i < EPCIO_SETS * REMOTE_IO_SLAVES; i++) {
        struct remote_io_lines *r = &l->remote[i / REMOTE_IO_SLAVES];
        const int slave = i % REMOTE_IO_SLAVES;
        r->connected |= (uint32_t)v->io_remote_connected[i] << slave;
        for (int p = 0; p < REMOTE_IO_PORTS; p++)
            r->in[slave][p] = (uint16_t)v->io_remote[i][p];
    }
}

static int sample(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct epcio *card = &f->s.m.card;
    struct epcio_lines lines;
    memset(&lines, 0, offsetof(struct epcio_lines, remote));
    read_pins(v, &lines);
    lines.remote_kept = !card->remote_used && v->reg_seq == f->s.m.reg_seq && f->s.m.powered;
    if (!lines.remote_kept)
        read_remote(v, &lines);
    int bad = 0;
    enum epcio_status s = epcio_sample(card, &lines, &bad);
    if (s == EPCIO_OK)
        return 0;
    const char *name = s == EPCIO_BAD_PHASE ? "enc_phase" : "io_volts";
    const double *value = s == EPCIO_BAD_PHASE ? lines.phase : lines.volts;
    const bool six = s == EPCIO_BAD_PHASE && bad >= 6 && v->enc_phase_six_aux[bad - 6] != 0.0;
    return fmu_fail(f, "%s%s[%d] = %g: %s", name,
                    bad < 6 ? ""
                    : six   ? "_six_aux"
                            : "_aux",
                    bad < 6 ? bad + 1 : bad - 5, value[bad], epcio_status_text(s));
}

/* Start ADC and remote I/O, which need the inputs of the first instant. */
static int power_on(struct fmu *f)
{
    const struct vars *v = &f->s.v;
    struct model *m = &f->s.m;
    m->powered = true;
    if (v->adc_run)
        epcio_start_adc(&m->card);
    for (int i = 0; i < EPCIO_SETS; i++)
        if (epcio_write(&m->card, REG_RIO_ENABLED + i, v->rio_enabled[i]) != EPCIO_OK)
            return fmu_fail(f, "rio_enabled[%d] = %d", i + 1, (int)v->rio_enabled[i]);
    return 0;
}

/* Inputs are read at the instants in [t0, t1). The outputs show the state at t1, with the DAC codes
 * of the latest instant before t1 even if t1 is an instant. */
static int model_step(struct fmu *f, int64_t t0, int64_t t1)
{
    struct model *m = &f->s.m;
    int64_t end = t1 / EPCIO_CLOCK_NS;
    (void)t0;
    for (; m->instant < end; m->instant += m->period) {
        epcio_advance(&m->card, m->instant);
        epcio_convert(&m->card);
        if (sample(f) || (!m->powered && power_on(f)) || read_host(f))
            return -1;
        epcio_control(&m->card);
    }
    epcio_advance(&m->card, end);
    if (m->instant == end)
        epcio_convert(&m->card);
    wires_refused(f);
    f->s.v.reg_ack = m->reg_seq;
    f->s.v.reg_status = (int32_t)m->reg_status;
    wires_publish(f);
    publish(&f->s.v, &m->card);
    return 0;
}
