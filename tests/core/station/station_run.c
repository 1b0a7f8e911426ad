/* The station: pulses and FIFO at their clock, runs in pieces, motors on voltage, refusals. */
#include <stdlib.h>

#include "mcc_check.h"
#include "registers.h"
#include "station.h"

static struct station s, other, before; /* 170 kB each: not on the stack */

static struct station_reading reading(const struct station *of)
{
    struct station_reading r;
    station_read(of, &r);
    return r;
}

/* Until all rests, at most `seconds`; the clock at which it was seen. */
static int64_t until_stop(struct station *of, double seconds)
{
    const int64_t end = of->clock + (int64_t)(seconds * STATION_HZ);
    do {
        CHECK_EQ(station_run(of, of->clock + 40000, NULL), STATION_OK);
    } while (!reading(of).stopped && of->clock < end);
    CHECK(reading(of).stopped);
    return of->clock;
}

static const double target[AXES] = { 12.5, -7.25, 3.0 };

/* Every pulse of the line comes out; the encoders have followed them. */
static void line(void)
{
    const struct station_config c = station_defaults();
    CHECK_EQ(station_start(&s, &c), STATION_OK);
    CHECK_EQ(MCC_line(&s.pc.mcc, target), 1);
    until_stop(&s, 5.0);
    const struct station_reading r = reading(&s);
    CHECK(r.pulses[0] == 12500 && r.pulses[1] == -7250 && r.pulses[2] == 3000);
    CHECK(r.counts[0] == 12500 && r.counts[1] == -7250 && r.counts[2] == 3000);
    CHECK(r.table[0] == 12.5 && r.table[1] == -7.25 && r.table[2] == 3.0);
    CHECK(r.position[0] == 12.5 && r.position[1] == -7.25);
    CHECK_EQ(r.status, TASK_STOPPED);
    CHECK_EQ(r.underflows[0], 0);
    CHECK_EQ(r.starved, 0);
    CHECK_EQ(r.missed, 0);
    CHECK_EQ(r.frames_refused, 0);
    CHECK_EQ(r.stock[3], 0);
}

/* An interrupt each N T, a frame each T; service after the latency, to the clock. */
static void fifo(void)
{
    const struct station_config c = station_defaults();
    const int64_t dda = machine_dda_clocks(&c.machine);
    CHECK_EQ(station_start(&s, &c), STATION_OK);
    CHECK_EQ(station_run(&s, 1000 * dda, NULL), STATION_OK);
    const struct station_reading first = reading(&s);
    CHECK_EQ(station_run(&s, 1400 * dda, NULL), STATION_OK);
    const struct station_reading last = reading(&s);
    CHECK_EQ(last.interrupts - first.interrupts, 100);
    CHECK_EQ(last.services - first.services, 100);
    CHECK_EQ((last.irq_clock - first.irq_clock) % (4 * dda), 0);
    CHECK_EQ(last.latency, 8000);
    CHECK(last.stock[0] >= 3 && last.stock[0] <= 7);
}

/* What the calls are, and when: the same for both ways to run. */
static void calls(struct station *of, int k)
{
    if (k == 0) {
        CHECK(MCC_line(&of->pc.mcc, target) > 0);
        CHECK(MCC_circle_xy(&of->pc.mcc, 5.0, -7.25, 1) > 0);
    } else if (k == 3) {
        CHECK_EQ(MCC_motion_hold(&of->pc.mcc), MCC_NO_ERR);
    } else if (k == 5) {
        CHECK_EQ(MCC_motion_conti(&of->pc.mcc), MCC_NO_ERR);
        CHECK_EQ(MCC_set_over_spd(&of->pc.mcc, 150.0), MCC_NO_ERR);
    }
}

/* A run cut into uneven pieces is the same as one in one go, to the bit, for each kind of motor. */
static void pieces(void)
{
    struct station_config c = station_defaults();
    c.pc.output_mode[1] = STATION_LOOP;
    c.pc.output_mode[2] = STATION_SOFTWARE;
    c.pc.jitter = 5000.0;
    CHECK_EQ(station_start(&s, &c), STATION_OK);
    CHECK_EQ(station_start(&other, &c), STATION_OK);
    for (int k = 0; k < 20; k++) {
        const int64_t end = (k + 1) * (int64_t)(STATION_HZ / 5);
        calls(&s, k);
        calls(&other, k);
        CHECK_EQ(station_run(&s, end, NULL), STATION_OK);
        for (int64_t clock = other.clock; clock < end; clock += 7777 + 13 * k) {
            CHECK_EQ(station_run(&other, clock, NULL), STATION_OK);
        }
        CHECK_EQ(station_run(&other, end, NULL), STATION_OK);
        const struct station_reading a = reading(&s), b = reading(&other);
        CHECK(memcmp(a.pulses, b.pulses, sizeof a.pulses) == 0);
        CHECK(memcmp(a.counts, b.counts, sizeof a.counts) == 0);
        CHECK(memcmp(a.motor, b.motor, sizeof a.motor) == 0);
        CHECK(memcmp(a.volts, b.volts, sizeof a.volts) == 0);
        CHECK(a.irq_clock == b.irq_clock && a.command == b.command && a.status == b.status);
    }
    CHECK_EQ(s.card.dda.command[0], other.card.dda.command[0]);
    CHECK(reading(&s).pulses[0] > 0);
}

/* At an instant the encoder shows where the motor is; between two of them the motor goes on at the
 * speed of its voltage. */
static void between_instants(void)
{
    struct station_config c = station_defaults();
    c.pc.output_mode[0] = STATION_LOOP;
    CHECK_EQ(station_start(&s, &c), STATION_OK);
    CHECK_EQ(MCC_set_fspd(&s.pc.mcc, 300.0), MCC_NO_ERR);
    CHECK(MCC_line_x(&s.pc.mcc, 100.0) > 0);
    CHECK_EQ(station_run(&s, STATION_HZ / 5, NULL), STATION_OK);
    for (int k = 0; k < 200; k++) {
        const double at = reading(&s).motor[0];
        CHECK_EQ(station_run(&s, s.clock + 1, NULL), STATION_OK);
        CHECK(fabs((double)reading(&s).counts[0] - at) <= 1.0);
        CHECK_EQ(station_run(&s, s.clock + c.pc.bus / 2 - 1, NULL), STATION_OK);
        const double half = reading(&s).motor[0];
        CHECK_EQ(station_run(&s, s.clock + c.pc.bus / 2, NULL), STATION_OK);
        const double way = reading(&s).motor[0] - at;
        CHECK_NEAR(half - at, 0.5 * way, 1e-6);
        CHECK(k < 20 || way > 5.0); /* [counts], so that a period more or less would be seen */
    }
}

/* Loop of the card: gain 60 of scale 2^6 at 50,000 counts/s on 10 V lags by v / Kv in steady
 * motion: Kv = 60 / 64 * 20 V / 65536 * 50,000 counts/s/V. */
static void lag(void)
{
    struct station_config c = station_defaults();
    const double kv = 60.0 / 64.0 * 20.0 / 65536.0 * 50000.0;
    c.pc.output_mode[0] = STATION_LOOP;
    CHECK_EQ(station_start(&s, &c), STATION_OK);
    CHECK(MCC_line_x(&s.pc.mcc, 20.0) > 0);
    CHECK_EQ(station_run(&s, 15 * (STATION_HZ / 10), NULL), STATION_OK);
    CHECK_NEAR(reading(&s).errors[0], 10000.0 / kv, 10000.0 * 3e-4);
    int32_t told[AXES]; /* the library's: as of an instant, one bus period old */
    CHECK_EQ(MCC_get_errcnt(&s.pc.mcc, told), MCC_NO_ERR);
    CHECK_NEAR(told[0], reading(&s).errors[0], 2.0);
    CHECK(told[0] > 600 && told[1] == 0);
    until_stop(&s, 5.0);
    CHECK_EQ(station_run(&s, s.clock + STATION_HZ, NULL), STATION_OK);
    CHECK_NEAR(reading(&s).table[0], 20.0, 0.002);
    CHECK_EQ(reading(&s).counts[0] + reading(&s).errors[0], 20000);
}

/* A part program, and the switches that are pins. */
static void program(void)
{
    const struct station_config c = station_defaults();
    struct source_text text = { "G1 X3 F600\nM64 P2\nG2 X5 Y0 I1\n", 30 };
    const struct source source = source_of(&text);
    struct fault_report report;
    CHECK_EQ(station_start(&s, &c), STATION_OK);
    task_check(&s.pc.mcc, &source, &report);
    CHECK_EQ(report.fault, FAULT_NONE);
    CHECK_EQ(task_start(&s.pc.mcc), MCC_NO_ERR);
    s.lines.local.home = 1;
    s.lines.local.up = 2;
    s.lines.local.down = 4;
    CHECK_EQ(station_run(&s, 3 * (int64_t)STATION_HZ, &source), STATION_OK);
    const struct station_reading r = reading(&s);
    CHECK_EQ(r.pulses[0], 5000);
    CHECK_EQ(r.digital_out, 4);
    CHECK_EQ(r.line, 3);
    CHECK(s.pc.mcc.signals.home == 1 && s.pc.mcc.signals.upper == 2 && s.pc.mcc.signals.lower == 4
          && !s.pc.mcc.signals.stop);
    s.lines.local.stop = true;
    CHECK_EQ(station_run(&s, s.clock + STATION_HZ / 10, NULL), STATION_OK);
    CHECK(s.pc.mcc.signals.stop && epcio_off(&s.card));
    s.lines.local.stop = false;
    CHECK_EQ(station_run(&s, s.clock + STATION_HZ / 10, NULL), STATION_OK);
    CHECK(!s.pc.mcc.signals.stop && !epcio_off(&s.card));
}

/* A card that its watchdog has stopped takes no frame; that is no fault of the station, which goes
 * on and moves again once the watchdog is refreshed. */
static void watchdog(void)
{
    const struct station_config c = station_defaults();
    CHECK_EQ(station_start(&s, &c), STATION_OK);
    CHECK_EQ(MCC_line_x(&s.pc.mcc, 20.0), 1);
    CHECK_EQ(epcio_set_timer(&s.card, true, STATION_HZ / 2), EPCIO_OK);
    CHECK_EQ(epcio_set_watchdog(&s.card, true, 1, 1000), EPCIO_OK);
    CHECK_EQ(station_run(&s, STATION_HZ, NULL), STATION_OK);
    const struct station_reading stopped = reading(&s);
    CHECK(epcio_off(&s.card) && stopped.frames_refused > 100 && stopped.pulses[0] > 1000);
    CHECK_EQ(epcio_set_timer(&s.card, false, 1), EPCIO_OK);
    epcio_refresh_watchdog(&s.card);
    CHECK_EQ(station_run(&s, s.clock + STATION_HZ / 5, NULL), STATION_OK);
    CHECK(!epcio_off(&s.card) && reading(&s).pulses[0] > stopped.pulses[0] + 1000);
}

static void refusals(void)
{
    for (int i = 0; i < 13; i++) {
        struct station_config c = station_defaults();
        enum station_status want = STATION_BAD_PC;
        switch (i) {
        case 0:
            c.machine.feed = NAN;
            want = STATION_BAD_MACHINE;
            break;
        case 1:
            c.machine.queue_depth = QUEUE_SIZE + 1;
            want = STATION_BAD_MACHINE;
            break;
        case 2: c.pc.bus = 0; break;
        case 3: c.pc.ipo = 0; break;
        case 4: c.pc.min_stock = 60; break;
        case 5: c.pc.latency = NAN; break;
        case 6: c.pc.batch = 17; break;
        case 7:
            c.pc.output_mode[5] = 3;
            want = STATION_BAD_MODE;
            break;
        case 8:  c.pc.home_settle = -1.0; break;
        case 10: c.pc.offset[PC_PCL] = 1; break;
        case 11: c.pc.unit[PC_IPO] = -1; break;
        case 9:
            c.pc.home_order[0] = 1;
            c.pc.home[0].low_speed = 501.0;
            want = STATION_BAD_HOME;
            break;
        default:
            c.software_gain[2] = INFINITY;
            want = STATION_BAD_MODE;
            break;
        }
        memcpy(&before, &s, sizeof s);
        CHECK_EQ(station_start(&s, &c), want);
        CHECK(memcmp(&before, &s, sizeof s) == 0);
    }
}

/* A PC whose interpolation needs more than its cycle misses deadlines and starves the
 * card, and loses no pulse. */
static void slow_pc(void)
{
    struct station_config c = station_defaults();
    c.pc.time[PC_IPO] = 70000; /* of a cycle of 40,000 clocks */
    c.machine.queue_depth = 1;
    CHECK_EQ(station_start(&s, &c), STATION_OK);
    CHECK_EQ(MCC_line(&s.pc.mcc, target), 1);
    until_stop(&s, 20.0);
    const struct station_reading r = reading(&s);
    CHECK(r.pulses[0] == 12500 && r.pulses[1] == -7250 && r.pulses[2] == 3000);
    CHECK(r.missed > 100 && r.starved > 100);
}

/* Motor position at which X finds its origin, searching the index alone, with the index ON at a
 * level that MCC_update_param is told, or none. [counts] */
static double origin_found(int level)
{
    struct station_config c = station_defaults();
    c.pc.home[0].mode = HOME_INDEX;
    c.pc.home[0].direction = 0;
    c.pc.home_order[0] = 1;
    CHECK_EQ(station_start(&s, &c), STATION_OK);
    CHECK_EQ(s.pc.mcc.epcio_axis_param[0].index_on, 1);
    CHECK_EQ(MCC_line_x(&s.pc.mcc, 4.0), 1);
    until_stop(&s, 5.0);
    if (level >= 0) {
        s.pc.mcc.epcio_axis_param[0].index_on = level;
        CHECK_EQ(MCC_update_param(&s.pc.mcc), MCC_NO_ERR);
        CHECK_EQ(station_run(&s, s.clock + STATION_HZ / 100, NULL), STATION_OK);
    }
    CHECK_EQ(MCC_go_home(&s.pc.mcc, c.pc.home_order), MCC_NO_ERR);
    CHECK_EQ(station_run(&s, s.clock + 10 * (int64_t)STATION_HZ, NULL), STATION_OK);
    CHECK_EQ(MCC_check_homef(&s.pc.mcc), 1);
    return s.motor[0];
}

/* The index pulse is the first count of a turn: ON when high it is met on entering it, ON when low
 * on leaving it. */
static void index_level(void)
{
    CHECK_NEAR(origin_found(-1), 10000.0, 0.0);
    CHECK_NEAR(origin_found(1), 10000.0, 0.0);
    CHECK_NEAR(origin_found(0), 10001.0, 0.0);
}

/* At 0.1 s the DDA time becomes 0.512 ms by a call; the other station has it from the start on.
 * Half a second of uniform motion: missed deadlines in it, error of X at its end. */
static void both_ways(struct station_config c, int32_t missed[2], int32_t error[2])
{
    struct station *both[] = { &s, &other };
    CHECK_EQ(station_start(&s, &c), STATION_OK);
    CHECK_EQ(station_run(&s, STATION_HZ / 10, NULL), STATION_OK);
    CHECK_EQ(MCC_set_dda(&s.pc.mcc, 0.512), MCC_NO_ERR);
    c.machine.dda_time = 0.512e-3;
    CHECK_EQ(station_start(&other, &c), STATION_OK);
    for (int i = 0; i < 2; i++) {
        struct station *of = both[i];
        CHECK_EQ(station_run(of, of->clock + STATION_HZ / 10, NULL), STATION_OK);
        CHECK_EQ(MCC_line(&of->pc.mcc, target), 1);
        CHECK_EQ(station_run(of, of->clock + STATION_HZ / 10, NULL), STATION_OK);
        missed[i] = -reading(of).missed;
        CHECK_EQ(station_run(of, of->clock + STATION_HZ / 2, NULL), STATION_OK);
        missed[i] += reading(of).missed;
        error[i] = reading(of).errors[0];
    }
}

/* The DDA time set by a call is that of the deadline (n + 1) T of a write, and of the speed of the
 * frames that is fed forward: all of it, and the error left is that of the acceleration, 0. */
static void dda_time_by_call(void)
{
    struct station_config c = station_defaults();
    int32_t missed[2], error[2];
    c.pc.latency = 3e-3 * STATION_HZ; /* 4 T are 4.096 ms, then 2.048 ms */
    both_ways(c, missed, error);
    /* A write each 3 ms + the rest of a DDA time + one on its way, all too late. */
    CHECK(missed[1] > 120 && missed[1] < 167);
    CHECK(abs(missed[0] - missed[1]) <= 1);
    c = station_defaults();
    c.pc.output_mode[0] = STATION_SOFTWARE;
    c.pc.law.axis[0] = (struct law_axis){ .gain = 0.01, .volts = 2e-5, .feed_forward = 1.0 };
    both_ways(c, missed, error);
    CHECK_EQ(missed[0] + missed[1], 0);
    CHECK(abs(error[0]) <= 5 && abs(error[1]) <= 5);
}

/* Lead and direction by MCC_update_param hold for the control law: the machine moves
 * as one that was started with them. */
static void parameters_by_call(void)
{
    struct station_config c = station_defaults();
    for (int i = 0; i < 3; i++) {
        c.pc.output_mode[i] = STATION_SOFTWARE;
        c.pc.law.axis[i] =
            (struct law_axis){ .gain = 0.005, .volts = 2e-5, .feed_forward = 0.9, .lag = 2e-3 };
    }
    c.pc.law.cross_p = 60.0;
    c.pc.law.cross_i = 200.0;
    CHECK_EQ(station_start(&s, &c), STATION_OK);
    c.machine.axis[0].pitch = 4.0;
    c.machine.axis[1].inverted = true;
    CHECK_EQ(station_start(&other, &c), STATION_OK);
    for (int i = 0; i < 2; i++) {
        struct station *of = i ? &other : &s;
        CHECK_EQ(station_run(of, STATION_HZ / 10, NULL), STATION_OK);
        MCC_MACH_PARAM *p = of->pc.mcc.epcio_axis_param;
        p[0].pitch = 4.0;
        p[1].pos2encoder_dir = 1;
        CHECK_EQ(MCC_update_param(&of->pc.mcc), MCC_NO_ERR);
        CHECK_EQ(MCC_line(&of->pc.mcc, (double[AXES]){ 3.0, 2.0, 1.0 }), 1);
        CHECK_EQ(MCC_circle_xy(&of->pc.mcc, 0.0, 1.0, 1), 2);
    }
    double most = 0.0;
    for (int64_t k = 1; k < 600; k++) {
        const int64_t until = STATION_HZ / 10 + k * (STATION_HZ / 1000);
        CHECK_EQ(station_run(&s, until, NULL), STATION_OK);
        CHECK_EQ(station_run(&other, until, NULL), STATION_OK);
        CHECK(!memcmp(s.motor, other.motor, sizeof s.motor));
        CHECK(!memcmp(s.volts, other.volts, sizeof s.volts));
        most = fmax(most, s.motor[0]);
    }
    CHECK(most > 7000.0); /* 3 mm at 2500 a mm */
}

int main(void)
{
    index_level();
    parameters_by_call();
    dda_time_by_call();
    slow_pc();
    line();
    fifo();
    pieces();
    between_instants();
    lag();
    program();
    watchdog();
    refusals();
    return check_result();
}
