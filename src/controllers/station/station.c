#include "station.h"

#include <math.h>
#include <string.h>

#include "el_extremes.h"
#include "registers.h"

struct station_config station_defaults(void)
{
    struct station_config c = { .machine = { .dda_time = 1e-3,
                                             .dda_length = 12,
                                             .queue_depth = 64,
                                             .feed = 10.0,
                                             .max_feed = 1000.0,
                                             .acc_time = 0.1,
                                             .dec_time = 0.1,
                                             .acc_type = 'T',
                                             .dec_type = 'T',
                                             .jerk_share = 0.5,
                                             .ptp_ratio = 1.0 },
                                .pc = { .bus = 4000,
                                        .ipo = 40000,
                                        .latency = 8000.0,
                                        .seed = 1,
                                        .min_stock = 3,
                                        .batch = 4,
                                        .isr = { .priority = { 3, 4, 4, 4, 6, 6, 5, 2, 1 } },
                                        .home_settle = 0.05,
                                        .priority = { 4, 3, 1, 2 } } };
    for (int i = 0; i < AXES; i++) {
        c.machine.axis[i] = (struct machine_axis){ .used = i < 3,
                                                   .pitch = 10.0,
                                                   .gear_ratio = 1.0,
                                                   .ppr = 10000,
                                                   .rpm = 3000.0,
                                                   .p_gain = 60 };
        c.pc.home[i] = (struct home_config){ .mode = HOME_SENSOR_INDEX,
                                             .direction = 1,
                                             .sensor_on = true,
                                             .high_speed = 20.0,
                                             .low_speed = 2.0,
                                             .search = 1000.0,
                                             .index_way = 15.0 };
        c.software_gain[i] = 0.01;
    }
    return c;
}

/* True if pc_start will accept how an axis is homed. */
static bool can_home(const struct machine_axis *a, const struct home_config *h)
{
    return home_valid(h) && el_max(h->high_speed, h->low_speed) <= machine_axis_speed(a);
}

/* True for a number of clocks from `least` to 289 days, so that sums in a run do not overflow. */
static bool clocks(int64_t x, int64_t least)
{
    return x >= least && x < 1000000000000000;
}

/* True if the times of the PC's modules are valid. Position control has no cycle to be offset: it
 * is woken by interrupts. */
static bool modules_valid(const struct pc_config *p)
{
    bool valid = clocks(p->bus, 1) && clocks(p->ipo, 1) && clocks(p->interpreter, 0)
                 && clocks(p->process, 0) && clocks(p->isr.service, 0) && p->offset[PC_PCL] == 0;
    for (int i = 0; i < PC_MODULES; i++) {
        valid = valid && clocks(p->offset[i], 0) && clocks(p->time[i], 0) && clocks(p->unit[i], 0)
                && p->most[i] >= 0;
    }
    return valid;
}

/* CCN 20: a row of limits, each with its status. */
static enum station_status check(const struct station_config *c)
{
    const struct pc_config *p = &c->pc;

    if (!machine_valid(&c->machine) || c->machine.queue_depth > QUEUE_SIZE) {
        return STATION_BAD_MACHINE;
    }
    if (!modules_valid(p) || p->min_stock < 0 || p->batch < 1 || p->batch > PCL_FRAMES
        || p->min_stock + p->batch > PCL_FIFO || !(p->latency >= 0.0 && p->latency < 1e15)
        || !(p->jitter >= 0.0 && p->jitter < 1e15)
        || !(p->home_settle >= 0.0 && p->home_settle < 1e6)) {
        return STATION_BAD_PC;
    }
    for (int i = 0; i < AXES; i++) {
        if (p->home_order[i] > 0 && !can_home(&c->machine.axis[i], &p->home[i])) {
            return STATION_BAD_HOME;
        }
        if (p->output_mode[i] < STATION_PULSES || p->output_mode[i] > STATION_SOFTWARE
            || !isfinite(c->software_gain[i])) {
            return STATION_BAD_MODE;
        }
    }
    return STATION_OK;
}

/* Power the card on, for the axes of a machine, with encoders of ppr counts and one index a
 * turn. */
static void power_on(struct epcio *card, const struct machine *m)
{
    struct epcio_config c = epcio_default_config();

    for (int i = 0; i < AXES; i++) {
        c.active[i] = m->axis[i].used;
        c.encoder[i].index_lines = m->axis[i].ppr < 4 ? 1 : m->axis[i].ppr / 4;
    }
    epcio_reset(card, &c);
    epcio_set_local_io(card, &(struct local_io_control){
                                 .stop_enable = true, .gate = true, .servo_on = 0x3f });
}

enum station_status station_start(struct station *s, const struct station_config *config)
{
    const enum station_status bad = check(config);

    if (bad) {
        return bad;
    }
    memset(s, 0, sizeof *s);
    struct pc_config pc = config->pc;
    pc.no_panel = true;
    pc_start(&s->pc, &config->machine, &pc, false);
    memcpy(s->software_gain, config->software_gain, sizeof s->software_gain);
    power_on(&s->card, &config->machine);
    s->lines.local.power = true;
    return STATION_OK;
}

/* What the PC sees of the card and of the machine at this instant. */
static void look(const struct station *s, struct pcl_card *seen, struct pc_panel *panel)
{
    struct link_card link;

    host_show(&s->card, &link);
    *seen = card_of(&s->pc.pcl, &link);
    *panel = (struct pc_panel){ .override = 1.0, .rapid = 1.0 };
    card_signals(&link, &panel->signals);
    memcpy(panel->software_gain, s->software_gain, sizeof panel->software_gain);
}

/* Speed of an ideal motor: its safe speed at 10 V. [counts/s] */
static double speed(const struct machine_axis *a, double volts)
{
    return a->ppr * a->rpm / 60.0 * volts / 10.0;
}

/* Move the motors up to this instant, and set the speed at which they go on. */
static void move(struct station *s)
{
    int64_t pulses[AXES];

    epcio_pulses(&s->card, pulses);
    for (int i = 0; i < AXES; i++) {
        const struct machine_axis *a = &s->pc.mcc.machine.axis[i];
        if (s->pc.config.output_mode[i] == STATION_PULSES) {
            s->motor[i] = (double)pulses[i];
        } else if (a->used) {
            s->motor[i] += speed(a, s->volts[i]) * (double)s->pc.config.bus / CLOCK_HZ;
        }
        s->lines.phase[i] = s->motor[i] / 4.0;
        s->volts[i] = epcio_volts(&s->card, i);
    }
}

/* The card takes what the PC has published. */
static void take(struct station *s)
{
    struct link_host link = { .cmd_seq = s->taken.cmd_seq };

    pc_publish(&s->pc, &link);
    host_take_levels(&s->taken, &s->card, &link);
    host_take_write(&s->taken, &s->card, &link);
}
_Static_assert((int)EPCIO_FIFO_DEPTH == (int)PCL_FIFO && (int)EPCIO_CLOCK_HZ == (int)CLOCK_HZ,
               "library and card speak of the same FIFOs and clock");

/* One instant of the bus grid: see station.h. */
static enum station_status instant(struct station *s, const struct source *program)
{
    struct pcl_card seen;
    struct pc_panel panel;
    int bad;

    look(s, &seen, &panel);
    move(s);
    if (epcio_sample(&s->card, &s->lines, &bad) != EPCIO_OK) {
        return STATION_MOTOR_LOST;
    }
    take(s);
    epcio_control(&s->card);
    pc_instant(&s->pc, s->instant, &seen, &panel, program);
    s->instant += s->pc.config.bus;
    if (epcio_off(&s->card)) {
        s->pc.pcl.refusals = 0; /* the emergency stop explains them */
    }
    return s->pc.pcl.refusals < PCL_REFUSALS ? STATION_OK : STATION_FRAMES_REFUSED;
}

enum station_status station_run(struct station *s, int64_t until, const struct source *program)
{
    while (s->instant < until) {
        epcio_advance(&s->card, s->instant);
        epcio_convert(&s->card);
        s->clock = s->instant;
        const enum station_status status = instant(s, program);
        if (status != STATION_OK) {
            return status;
        }
    }
    if (until > s->clock) {
        epcio_advance(&s->card, until);
        s->clock = until;
        if (s->instant == until) {
            epcio_convert(&s->card);
        }
    }
    return STATION_OK;
}

/* True if no pulse is under way or in stock. */
static bool card_rests(const struct epcio *card)
{
    int32_t due = 0;

    for (int i = 0; i < AXES; i++) {
        due += card->dda.command[i] != 0;
        due += fifo_largest(&card->fifo[i], card->entry[i]) != 0;
    }
    return due == 0;
}

static void read_axes(const struct station *s, struct station_reading *r)
{
    const struct epcio *card = &s->card;
    const int64_t since = s->instant > 0 ? s->clock - (s->instant - s->pc.config.bus) : 0;

    epcio_pulses(card, r->pulses);
    MCC_get_cpos(&s->pc.mcc, r->position);
    for (int i = 0; i < AXES; i++) {
        const struct machine_axis *a = &s->pc.mcc.machine.axis[i];
        r->counts[i] = card->encoder[i].count;
        r->errors[i] = card->loop[i].error;
        r->volts[i] = epcio_volts(card, i);
        r->motor[i] = s->pc.config.output_mode[i] == STATION_PULSES
                          ? (double)r->pulses[i]
                          : s->motor[i] + speed(a, s->volts[i]) * (double)since / CLOCK_HZ;
        r->table[i] = (a->inverted ? -1.0 : 1.0) * r->motor[i] / machine_pulses_per_mm(a);
        r->stock[i] = card->fifo[i].stock;
        r->underflows[i] = card->underflows[i];
    }
}

void station_read(const struct station *s, struct station_reading *r)
{
    const struct mcc *m = &s->pc.mcc;
    const struct pcl *p = &s->pc.pcl;

    *r = (struct station_reading){ .clock = s->clock,
                                   .path_feed = m->written.feed,
                                   .frames_taken = s->card.frames_taken,
                                   .frames_refused = s->card.frames_refused,
                                   .interrupts = link_wrap(s->card.irq.seq),
                                   .irq_clock = s->card.irq.clock,
                                   .services = p->services,
                                   .latency = p->latency,
                                   .missed = s->pc.shown.all.missed,
                                   .ipo_cycle = pc_ipo_cycle(&s->pc),
                                   .queue = m->queue.count,
                                   .starved = p->starved,
                                   .status = task_status(m),
                                   .error = MCC_get_errcode(m),
                                   .line = m->written.line,
                                   .command = m->written.command,
                                   .digital_out = (int32_t)m->written.outputs.digital,
                                   .coolant = m->written.outputs.coolant,
                                   .spindle_speed = m->written.outputs.spindle,
                                   .stopped = MCC_check_stop(m) && card_rests(&s->card) };
    read_axes(s, r);
}
