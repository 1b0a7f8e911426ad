/* Bytes as a station's configuration, then as calls of its library, pins and runs. A refused start
 * changes nothing; a run cut in pieces is the run in one go; the card gets no frame it refuses; at
 * rest every pulse of the library has been put out; after an abort it comes to rest. */
#include "fuzz.h"
#include "station.h"

const int fuzz_count = 300;

enum { OPERATIONS = 24, INSTANTS = 500 };

static struct station s, cut, before; /* 170 kB each: not on the stack */
static struct station_config config;
static struct source_text text;
static struct source program;
static bool stopped_by_pin; /* since the start */

struct bytes {
    const uint8_t *at, *end;
};

static int64_t byte(struct bytes *b)
{
    return b->at < b->end ? *b->at++ : 0;
}

/* Mostly a plain number, at times one that nothing should take. */
static double number(struct bytes *b, double plain)
{
    static const double odd[] = {
        0.0,    -0.0, NAN, INFINITY, -INFINITY, 1e308, -1e308,
        5e-324, 1e-9, 1e9, 1e15,     -1.0,      1e300, 9.007199254740993e15,
        9.2e18, 0.1
    };
    const int64_t x = byte(b);
    return x >= 0xf0 ? odd[x & 15] : plain * (double)(x - 16) / 64.0;
}

static int64_t whole(struct bytes *b, int64_t plain)
{
    static const int64_t odd[] = { 0,
                                   -1,
                                   1,
                                   2,
                                   INT32_MAX,
                                   INT32_MIN,
                                   INT64_MAX,
                                   INT64_MIN,
                                   INT64_MAX / 2,
                                   (int64_t)1 << 61,
                                   63,
                                   64,
                                   1023,
                                   1024,
                                   7,
                                   1000000 };
    const int64_t x = byte(b);
    return x >= 0xf0 ? odd[x & 15] : plain * (x - 16) / 64;
}

static void axis_setting(struct bytes *b, struct machine_axis *a)
{
    switch (byte(b) % 16) {
    case 0:  a->used = byte(b) & 1; break;
    case 1:  a->pitch = number(b, 10.0); break;
    case 2:  a->gear_ratio = number(b, 1.0); break;
    case 3:  a->ppr = (int32_t)whole(b, 10000); break;
    case 4:  a->rpm = number(b, 3000.0); break;
    case 5:  a->p_gain = (int32_t)whole(b, 60); break;
    case 6:  a->inverted = byte(b) & 1; break;
    case 7:  a->index_low = byte(b) & 1; break;
    case 8:  a->max_dda = (int32_t)whole(b, 4095); break;
    case 9:  a->max_dda_acc = (int32_t)whole(b, 100); break;
    case 10: a->check_ot = byte(b) & 1; break;
    case 11: a->high_limit = number(b, 50.0); break;
    case 12: a->low_limit = -number(b, 50.0); break;
    case 13: a->track_limit = (int32_t)whole(b, 5000); break;
    case 14: a->in_pos = byte(b) & 1; break;
    default: a->inpos_tol = number(b, 0.01); break;
    }
}

static void machine_setting(struct bytes *b, struct machine *m)
{
    switch (byte(b) % 16) {
    case 0:  m->dda_time = number(b, 1e-3); break;
    case 1:  m->dda_length = (int32_t)whole(b, 12); break;
    case 2:  m->queue_depth = (int32_t)whole(b, 64); break;
    case 3:  m->feed = number(b, 50.0); break;
    case 4:  m->max_feed = number(b, 1000.0); break;
    case 5:  m->acc_time = number(b, 0.02); break;
    case 6:  m->dec_time = number(b, 0.02); break;
    case 7:  m->acc_type = "TS\0X"[byte(b) & 3]; break;
    case 8:  m->dec_type = "TS\0X"[byte(b) & 3]; break;
    case 9:  m->jerk_share = number(b, 0.5); break;
    case 10: m->limit_check = byte(b) & 1; break;
    case 11: m->limit_mode = (int32_t)whole(b, 2); break;
    case 12: m->inpos_mode = (int32_t)whole(b, 2); break;
    case 13: m->inpos_settle = number(b, 1e-3); break;
    case 14: m->inpos_timeout = number(b, 0.02); break;
    default: m->ptp_ratio = number(b, 0.5); break;
    }
}

static void home_setting(struct bytes *b, int i)
{
    struct home_config *h = &config.pc.home[i];
    switch (byte(b) % 8) {
    case 0:  h->mode = (enum home_mode)whole(b, 3); break;
    case 1:  h->direction = (uint32_t)byte(b); break;
    case 2:  h->sensor_on = byte(b) & 1; break;
    case 3:  h->high_speed = number(b, 100.0); break;
    case 4:  h->offset = number(b, 1.0); break;
    case 5:  h->search = number(b, 30.0); break;
    case 6:  h->index_way = number(b, 15.0); break;
    default: config.pc.home_order[i] = (int32_t)whole(b, 1); break;
    }
}

static void law_setting(struct bytes *b, int i)
{
    struct law_config *l = &config.pc.law;
    switch (byte(b) % 8) {
    case 0:  l->axis[i].gain = number(b, 0.01); break;
    case 1:  l->axis[i].volts = number(b, 2e-5); break;
    case 2:  l->axis[i].feed_forward = number(b, 1.0); break;
    case 3:  l->axis[i].lag = number(b, 1e-3); break;
    case 4:  l->cross_p = number(b, 20.0); break;
    case 5:  l->cross_i = number(b, 100.0); break;
    case 6:  l->cross_d = number(b, 0.1); break;
    default: config.software_gain[i] = number(b, 0.01); break;
    }
}

static void pc_setting(struct bytes *b, struct pc_config *c)
{
    const int64_t which = byte(b), k = which >> 6 & 3;
    switch (which % 20) {
    case 0:  c->bus = whole(b, 8000); break;
    case 1:  c->ipo = whole(b, 40000); break;
    case 2:  c->ipo_event = byte(b) & 1; break;
    case 3:  c->interpreter = whole(b, 80000); break;
    case 4:  c->process = whole(b, 40000); break;
    case 5:  c->priority[k] = (int32_t)whole(b, 4); break;
    case 6:  c->offset[k] = whole(b, 10000); break;
    case 7:  c->time[k] = whole(b, 4000); break;
    case 8:  c->unit[k] = whole(b, 1000); break;
    case 9:  c->most[k] = (int32_t)whole(b, 4); break;
    case 10: c->latency = number(b, 20000.0); break;
    case 11: c->jitter = number(b, 20000.0); break;
    case 12: c->min_stock = (int32_t)whole(b, 8); break;
    case 13: c->batch = (int32_t)whole(b, 8); break;
    case 14: c->isr.service = whole(b, 2000); break;
    case 15: c->home_settle = number(b, 0.01); break;
    case 16: c->dry_run = byte(b) & 1; break;
    case 17: c->start = whole(b, 40000); break;
    case 18: c->home_first = byte(b) & 1; break;
    default: c->encoder_backward[k] = byte(b) & 1; break;
    }
}

static void configure(struct bytes *b)
{
    config = station_defaults();
    config.machine.acc_time = config.machine.dec_time = 0.02;
    config.machine.feed = 50.0;
    config.pc.bus = 16000; /* fewer instants */
    for (int64_t n = byte(b) % 24; n > 0; n--) {
        const int64_t kind = byte(b);
        const int i = (int)(kind >> 4) % AXES;
        switch (kind % 6) {
        case 0:  axis_setting(b, &config.machine.axis[i]); break;
        case 1:  machine_setting(b, &config.machine); break;
        case 2:  pc_setting(b, &config.pc); break;
        case 3:  config.pc.output_mode[i] = (int32_t)(byte(b) % 4); break;
        case 4:  law_setting(b, i); break;
        default: home_setting(b, i); break;
        }
    }
}

/* What may be called; each of the two stations gets the same. */
static int call(struct mcc *m, const uint8_t *c)
{
    const double x = (c[1] - 128) / 4.0, y = (c[2] - 128) / 4.0;
    const double six[AXES] = { x, y, x - y };
    int32_t order[AXES] = { 0 };
    switch (c[0] % 24) {
    case 0:
    case 1:  return MCC_line(m, six);
    case 2:  return MCC_ptp(m, six);
    case 3:  return MCC_ptp_asyn(m, six);
    case 4:  return MCC_arc_xy(m, x, y, y, x);
    case 5:  return MCC_circle_xy(m, x, y, c[2] & 1);
    case 6:  return MCC_jog_c(m, c[1] % 3, c[2] % 3 - 1, 20.0);
    case 7:  return MCC_jog_s(m, c[1] % 3, (c[2] - 128) * 40);
    case 8:  return MCC_motion_hold(m);
    case 9:  return MCC_motion_conti(m);
    case 10: return MCC_motion_abort(m);
    case 11: return MCC_motion_delay(m, c[1]);
    case 12: return MCC_set_fspd(m, c[1]);
    case 13: return MCC_set_dda(m, c[1] / 64.0);
    case 14: return c[1] & 1 ? MCC_enable_quit(m) : MCC_disable_quit(m);
    case 15: return mcc_set_tolerance(m, c[1] / 128.0);
    case 16: return MCC_set_over_spd(m, c[1]);
    case 17: return MCC_clear_error(m);
    case 18:
        order[c[1] % 3] = 1;
        order[c[2] % 3] = 2;
        return MCC_go_home(m, order);
    case 19: return c[1] & 1 ? MCC_enable_dry_run(m) : MCC_disable_dry_run(m);
    case 20: return c[1] & 1 ? MCC_set_inc(m) : MCC_set_abs(m);
    case 21:
        m->epcio_axis_param[c[1] % 3].pos2encoder_dir = c[2] & 1;
        m->epcio_axis_param[c[1] % 3].pitch = 5.0 + (c[2] >> 4);
        return MCC_update_param(m);
    case 22: return MCC_MPG_set(m, c[1] % 3, 6 + c[2] % 3, 1.0);
    default: return task_start(m);
    }
}

static void pins(struct epcio_lines *l, const uint8_t *c)
{
    l->local.home = c[0];
    l->local.up = c[1] & 15 ? 0 : c[1] >> 4;
    l->local.down = c[2] & 15 ? 0 : c[2] >> 4;
    l->local.stop = c[1] == 0xff;
    l->phase[6] = c[2] / 4.0;
}

/* An instant and a cycle of a module cost their time: so many of them, and a second at most. */
static int64_t within(int64_t way)
{
    const int64_t cycle[] = { config.pc.bus, config.pc.ipo, config.pc.interpreter,
                              config.pc.process };
    for (int i = 0; i < 4; i++) {
        way = cycle[i] > 0 && way / INSTANTS > cycle[i] ? cycle[i] * INSTANTS : way;
    }
    return way < STATION_HZ ? way : STATION_HZ;
}

static struct station_reading reading(const struct station *of)
{
    struct station_reading r;
    station_read(of, &r);
    return r;
}

/* At rest the pulses put out are those of the library's position. */
static void check_rest(const struct station_reading *r)
{
    const struct mcc *m = &s.pc.mcc;
    for (int i = 0; i < AXES; i++) {
        const int64_t out = m->machine.axis[i].inverted ? -r->pulses[i] : r->pulses[i];
        const uint32_t place = (uint32_t)m->protection.base[i] + (uint32_t)(uint64_t)out;
        HOLDS(m->dry_run || place == (uint32_t)(m->trajectory.pulses[i] + m->comp[i].added));
    }
}

static void check(const struct station_reading *was)
{
    const struct station_reading r = reading(&s), c = reading(&cut);
    const int64_t dda = machine_dda_clocks(&s.pc.mcc.machine);
    const int64_t times = (r.clock - was->clock) / (dda < 1024 ? dda : 1024) + 2;
    for (int i = 0; i < AXES; i++) {
        HOLDS(r.pulses[i] == c.pulses[i] && r.counts[i] == c.counts[i]);
        HOLDS(r.errors[i] == c.errors[i] && r.stock[i] == c.stock[i]);
        HOLDS(r.stock[i] >= 0 && r.stock[i] <= PCL_FIFO);
        HOLDS(fabs(r.volts[i]) <= 10.0 && r.volts[i] == c.volts[i]);
        HOLDS(isfinite(r.motor[i]) && isfinite(r.table[i]) && isfinite(r.position[i]));
        HOLDS(llabs(r.pulses[i] - was->pulses[i]) <= times * 32767);
    }
    HOLDS(r.clock == c.clock && r.irq_clock == c.irq_clock && r.interrupts == c.interrupts);
    HOLDS(r.services == c.services && r.missed == c.missed && r.starved == c.starved);
    HOLDS(r.status == c.status && r.error == c.error && r.command == c.command);
    HOLDS(r.missed >= was->missed && r.services >= was->services && r.starved >= was->starved);
    HOLDS(isfinite(r.path_feed) && r.path_feed >= 0.0 && isfinite(r.spindle_speed));
    HOLDS(stopped_by_pin || r.frames_refused == 0);
    if (r.stopped && !s.pc.mcc.signals.stop && r.error != MCC_ERROR_STOP) {
        check_rest(&r);
    }
}

/* Both to a clock, the second in pieces. */
static enum station_status run(struct bytes *b, int64_t way)
{
    const int64_t until = s.clock + within(way);
    const struct station_reading was = reading(&s);
    const enum station_status status = station_run(&s, until, &program);
    enum station_status other = STATION_OK;
    HOLDS(status == STATION_OK || status == STATION_MOTOR_LOST);
    for (int n = 0; n < 5 && cut.clock < until && other == STATION_OK; n++) {
        other = station_run(&cut, cut.clock + (until - cut.clock) * byte(b) / 256, &program);
    }
    other = other == STATION_OK ? station_run(&cut, until, &program) : other;
    HOLDS(status == other);
    if (status == STATION_OK) {
        check(&was);
    }
    return status;
}

/* The processor has time to spare and the FIFO is served soon; then it comes to rest. */
static bool light(void)
{
    const struct pc_config *c = &config.pc;
    const double dda = (double)machine_dda_clocks(&s.pc.mcc.machine), n = c->batch;
    double load = ((double)c->time[PC_PCL] + (double)c->unit[PC_PCL] * n + (double)c->isr.service)
                  / (n * dda);
    load += (double)c->time[PC_IPO] / (double)c->ipo + (double)c->unit[PC_IPO] / dda;
    for (int i = 0; i < 2; i++) {
        const int64_t own = i ? c->process : c->interpreter;
        const int k = i ? PC_PROCESS : PC_INTERPRETER;
        load += ((double)c->time[k] + (double)c->unit[k] * 256.0) / (double)(own ? own : c->ipo);
    }
    return load < 0.3 && c->latency + c->jitter < 0.02 * STATION_HZ && dda < 0.01 * STATION_HZ
           && c->ipo < 0.1 * STATION_HZ && c->interpreter < STATION_HZ && c->process < STATION_HZ
           && c->bus < 0.01 * STATION_HZ;
}

static void come_to_rest(struct bytes *b)
{
    struct mcc *const both[] = { &s.pc.mcc, &cut.pc.mcc };
    const uint8_t off[3] = { 0, 1, 1 };
    const double slowest = fmax(s.pc.mcc.machine.dec_time, config.machine.dec_time);
    if (!light() || slowest > 0.1 || config.pc.home_settle > 0.1) {
        return;
    }
    pins(&s.lines, off);
    pins(&cut.lines, off);
    /* A run is short where a module's cycle is: the time counts, not the runs. */
    const int64_t end = s.clock + 8 * (int64_t)STATION_HZ;
    while (s.clock < end) {
        for (int i = 0; i < 2; i++) {
            MCC_clear_error(both[i]);
            MCC_motion_abort(both[i]);
        }
        if (run(b, STATION_HZ / 50) != STATION_OK) {
            return;
        }
        if (reading(&s).stopped) {
            return;
        }
    }
    HOLDS(!"at rest");
}

static void operate(struct bytes *b)
{
    const uint8_t kind = (uint8_t)byte(b);
    const uint8_t c[3] = { (uint8_t)byte(b), (uint8_t)byte(b), (uint8_t)byte(b) };
    if (kind % 8 == 7) {
        pins(&s.lines, c);
        pins(&cut.lines, c);
        stopped_by_pin = stopped_by_pin || s.lines.local.stop;
        return;
    }
    if (kind % 8 < 4) {
        const int a = call(&s.pc.mcc, c), o = call(&cut.pc.mcc, c);
        HOLDS(a == o);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const texts[] = { "G1 X3 F600\nM64 P2\nG2 X5 Y0 I1\n",
                                         "G64 P0.1\nG1 X1 Y1 F3000\nX2\nY2\nX0\nM30\n",
                                         "G91\nG0 X1\nG4 P0.01\nM0\nX-1\n",
                                         "M3 S500\nG64\nG1 X5 F6000\nY5\nM5\n" };
    struct bytes b = { data, data + size };
    struct fault_report report;
    memset(&s, 0x5a, sizeof s);
    memcpy(&before, &s, sizeof s);
    stopped_by_pin = false;
    configure(&b);
    if (station_start(&s, &config) != STATION_OK) {
        HOLDS(memcmp(&before, &s, sizeof s) == 0);
        return 0;
    }
    HOLDS(station_start(&cut, &config) == STATION_OK);
    const char *chosen = texts[byte(&b) & 3];
    text = (struct source_text){ chosen, (int64_t)strlen(chosen) };
    program = source_of(&text);
    task_check(&s.pc.mcc, &program, &report);
    task_check(&cut.pc.mcc, &program, &report);
    for (int n = 0; n < OPERATIONS && b.at < b.end; n++) {
        operate(&b);
        if (run(&b, byte(&b) * byte(&b) * 200) != STATION_OK) {
            return 0;
        }
    }
    come_to_rest(&b);
    return 0;
}
