/* Library, PC and the real card in one loop: emergency stop, overflow of an error counter,
 * in-position through queue and FIFO; the position to the pulse. */
#include <stdlib.h>

#include "host.h"
#include "mcc_check.h"
#include "pc.h"
#include "registers.h"

enum { BUS = 4000 }; /* [clocks] */

struct bench {
    struct epcio card;
    struct epcio_lines lines;
    struct pc_panel panel;
    int64_t now;
    struct mailbox taken; /* what it has taken of the library */
    double lag;           /* share of the following error that the motors catch up each period */
    double motor[AXES];   /* [pulses] */
    int32_t moved;        /* [pulses] of axis 1 in the latest period */
};

static struct pc pc; /* 140 kB: not on the stack */
static struct mcc before;

static struct pc_config usual(int mode)
{
    struct pc_config c = {
        .bus = BUS, .ipo = 40000, .latency = 8000.0, .seed = 1, .min_stock = 3, .batch = 4
    };
    for (int i = 0; i < AXES; i++) {
        c.output_mode[i] = mode;
    }
    return c;
}

static void power_on(struct bench *b, const struct machine *m, int mode, bool program)
{
    struct epcio_config config = epcio_default_config();
    const struct pc_config c = usual(mode);
    memset(b, 0, sizeof *b);
    for (int i = 3; i < AXES; i++) {
        config.active[i] = false;
    }
    CHECK_EQ(epcio_reset(&b->card, &config), EPCIO_OK);
    CHECK_EQ(pc_start(&pc, m, &c, program), MCC_NO_ERR);
    struct local_io_control io = { .gate = true, .stop_enable = true };
    CHECK_EQ(epcio_set_local_io(&b->card, &io), EPCIO_OK);
    b->lines.local.power = true;
    b->panel.override = b->panel.rapid = 1.0;
    b->lag = 1.0;
}

/* What the card shows at this instant; the encoders without the delay of an instant, the home
 * switch as the test has it. */
static struct pcl_card show(struct bench *b)
{
    const struct signals before = b->panel.signals;
    struct link_card link;
    host_show(&b->card, &link);
    card_signals(&link, &b->panel.signals);
    b->panel.signals.home = before.home;
    b->moved = b->panel.signals.pulses[0] - before.pulses[0];
    for (int i = 0; i < AXES; i++) {
        b->motor[i] += b->lag * (b->panel.signals.pulses[i] - b->motor[i]);
        b->lines.phase[i] = b->motor[i] / 4.0;
        b->panel.signals.enc[i] = (int32_t)lround(b->motor[i]);
    }
    return card_of(&pc.pcl, &link);
}

/* What the library has published one period before. */
static void host_writes(struct bench *b)
{
    struct link_host link = { .cmd_seq = b->taken.cmd_seq };
    pc_publish(&pc, &link);
    CHECK_EQ(host_take_levels(&b->taken, &b->card, &link), EPCIO_OK);
    CHECK_EQ(host_take_write(&b->taken, &b->card, &link), EPCIO_OK);
}

/* One bus period of both. */
static void period(struct bench *b, const char *text)
{
    struct source_text program = { text, text ? (int64_t)strlen(text) : 0 };
    const struct source source = source_of(&program);
    int bad;
    epcio_advance(&b->card, b->now);
    const struct pcl_card seen = show(b);
    CHECK_EQ(epcio_sample(&b->card, &b->lines, &bad), EPCIO_OK);
    host_writes(b);
    epcio_control(&b->card);
    pc_instant(&pc, b->now, &seen, &b->panel, &source);
    CHECK(pc.pcl.refusals < PCL_REFUSALS);
    b->now += BUS;
}

static void periods(struct bench *b, const char *text, int n)
{
    for (int i = 0; i < n; i++) {
        period(b, text);
    }
}

/* A rising edge of the key, given time. */
static void press(struct bench *b, bool *key, const char *text)
{
    *key = true;
    periods(b, text, 20);
    *key = false;
    periods(b, text, 2);
}

/* What the card has put out of an axis, compensation left out. [pulses] */
static int32_t out(const struct bench *b, int i)
{
    const int32_t pulses = b->panel.signals.pulses[i];
    return (pc.mcc.machine.axis[i].inverted ? -pulses : pulses) - pc.mcc.written.added[i];
}

/* The library's position is that of the pulses put out; mm ideal to so much. */
static void check_place(const struct bench *b, double tolerance)
{
    int32_t pulses[AXES];
    double place[AXES];
    MCC_get_ppos(&pc.mcc, pulses);
    MCC_get_cpos(&pc.mcc, place);
    for (int i = 0; i < 3; i++) {
        CHECK_EQ(pulses[i], out(b, i));
        CHECK_NEAR(place[i], pulses[i] / 1000.0, tolerance);
        CHECK_NEAR(pc.mcc.end[i], place[i], 0.0);
    }
}

/* Run until the library stands still and the FIFO has run empty of motion. */
static void finish(struct bench *b, const char *text)
{
    for (int k = 0; k < 200000 && !MCC_check_stop(&pc.mcc); k++) {
        period(b, text);
    }
    CHECK(MCC_check_stop(&pc.mcc));
    periods(b, text, 200);
}

/* Path mixing; look-ahead. */
static const char *const parts[] = {
    "M3 S100\nG64\nG1 X30 Y20 F3000\nG2 X30 Y0 J-10\nG1 X0\nM30\n",
    "M3 S100\nG64 P0.1\nG1 X15 Y9 F3000\nX30 Y20\nG2 X30 Y0 J-10\nG1 X20 Y1\nX10 Y-1\nX0 Y0\nM30\n"
};

/* Y falls behind by 20 pulses when it turns. */
static const struct comp_table backlash = { .interval = 100000000,
                                            .home = 128,
                                            .backward = { [127] = -20, [128] = -20, [129] = -20 } };

/* Pressed at a random moment for a random time: at once, no pulse beyond the DDA time in progress,
 * no clearing too early, position to the pulse, the program anew. */
static void emergency_stop(void)
{
    uint64_t seed = 21;
    for (int i = 0; i < 40; i++) {
        struct machine m = mcc_machine();
        struct bench b;
        const char *part = parts[i / 2 % 2];
        m.queue_depth = i % 2 ? 8 : 200;
        m.acc_type = m.dec_type = i % 3 ? 'T' : 'S';
        m.axis[0].inverted = i % 5 == 0;
        power_on(&b, &m, 1, true);
        if (i % 7 < 3) {
            CHECK_EQ(MCC_set_comp(&pc.mcc, 1, &backlash), 0);
        }
        periods(&b, part, (int)check_real(&seed, 10.0, 14000.0));
        b.lines.local.stop = true;
        periods(&b, part, 3 + 11); /* seen after two periods; a DDA time is 10.24 of them */
        CHECK_EQ(MCC_get_errcode(&pc.mcc), MCC_ERROR_STOP);
        CHECK_EQ(pc.mcc.queue.count + pc.mcc.ring.count + pc.mcc.trajectory.mix.count, 0);
        CHECK_EQ(b.card.fifo[0].stock, 0);
        CHECK(pc.mcc.written.outputs.spindle == 0.0);
        const int32_t x = b.panel.signals.pulses[0];
        const int32_t seq = pc.pcl.seq;
        const int pressed = (int)check_real(&seed, 0.0, 3000.0);
        for (int k = 0; k < pressed; k++) {
            period(&b, part);
            CHECK(b.moved == 0 && pc.pcl.seq == seq);
        }
        CHECK(pc.mcc.written.feed == 0.0);
        press(&b, &b.panel.clear_error, part); /* refused */
        CHECK_EQ(MCC_get_errcode(&pc.mcc), MCC_ERROR_STOP);
        memcpy(&before, &pc.mcc, sizeof before);
        CHECK_EQ(MCC_clear_error(&pc.mcc), MCC_RUN_TIME);
        CHECK_EQ(MCC_line_x(&pc.mcc, 1.0), MCC_RUN_TIME);
        CHECK_EQ(task_start(&pc.mcc), MCC_RUN_TIME);
        CHECK_EQ(memcmp(&before, &pc.mcc, sizeof before), 0);
        check_place(&b, 1e-9);
        b.lines.local.stop = false;
        periods(&b, part, 4);
        memcpy(&before, &pc.mcc, sizeof before);
        CHECK_EQ(MCC_clear_error(&pc.mcc), MCC_COMMAND_NOTFINISHED);
        CHECK_EQ(memcmp(&before, &pc.mcc, sizeof before), 0);
        int32_t peak = 0;
        for (int k = 0; k < 200; k++) {
            period(&b, part);
            peak = b.card.fifo[0].stock > peak ? b.card.fifo[0].stock : peak;
        }
        CHECK_EQ(b.panel.signals.pulses[0], x);
        CHECK(b.card.fifo[0].stock >= 3 && peak >= 6); /* primed with zeros */
        press(&b, &b.panel.clear_error, part);
        CHECK_EQ(MCC_get_errcode(&pc.mcc), 0);
        check_place(&b, 1e-9);
        CHECK(MCC_line_y(&pc.mcc, -3.0) > 0);
        finish(&b, part);
        CHECK_EQ(b.panel.signals.pulses[0], x);
        CHECK_EQ(out(&b, 1), -3000);
        check_place(&b, 1e-9);
        CHECK(MCC_line(&pc.mcc, (double[AXES]){ 0.0 }) > 0);
        finish(&b, part);
        press(&b, &b.panel.cycle_start, part);
        CHECK(pc.mcc.running || !MCC_check_stop(&pc.mcc));
        finish(&b, part);
        CHECK(pc_done(&pc));
        check_place(&b, 1e-9);
        CHECK_EQ(out(&b, 0) | out(&b, 1), 0);
        press(&b, &b.panel.cycle_start, part); /* no error has been cleared since */
        CHECK(pc_done(&pc));
    }
}

/* At rest and before the start it is an error too; pressed again right after the release. */
static void pressed_twice(void)
{
    const struct machine m = mcc_machine();
    struct bench b;
    power_on(&b, &m, 0, false);
    periods(&b, NULL, 50);
    CHECK(MCC_line_x(&pc.mcc, 30.0) > 0);
    periods(&b, NULL, 3000);
    for (int i = 0; i < 6; i++) {
        b.lines.local.stop = i % 2 == 0;
        periods(&b, NULL, 3 + 4 * i);
    }
    CHECK_EQ(MCC_get_errcode(&pc.mcc), MCC_ERROR_STOP);
    periods(&b, NULL, 100);
    check_place(&b, 1e-9);
    CHECK_EQ(MCC_clear_error(&pc.mcc), 0);
    CHECK(MCC_line_x(&pc.mcc, 0.0) > 0);
    finish(&b, NULL);
    CHECK_EQ(b.panel.signals.pulses[0], 0);
    b.lines.local.stop = true;
    periods(&b, NULL, 5);
    CHECK_EQ(MCC_get_errcode(&pc.mcc), MCC_ERROR_STOP);
}

/* While an axis is jogged, from an origin that is not where the card began to count. */
static void jogged(void)
{
    struct machine m = mcc_machine();
    struct bench b;
    m.axis[0].check_ot = true; /* the switch lies beyond where the limit is before homing */
    m.axis[0].high_limit = 20.0;
    m.axis[0].low_limit = -5.0;
    m.limit_check = true;
    m.limit_mode = MACHINE_LIMIT_TOWARD_ERROR;
    power_on(&b, &m, 1, false);
    const struct home_config home = { .mode = HOME_SENSOR,
                                      .direction = 0,
                                      .sensor_on = true,
                                      .high_speed = 20.0,
                                      .low_speed = 2.0,
                                      .search = 100.0,
                                      .index_way = 15.0 };
    CHECK_EQ(homing_set(&pc.mcc, 0, &home, false), 0);
    CHECK_EQ(MCC_go_home(&pc.mcc, (int32_t[AXES]){ 1 }), 0);
    for (int k = 0; k < 100000 && MCC_check_homef(&pc.mcc) == 0; k++) {
        b.panel.signals.home =
            b.panel.signals.pulses[0] >= 30000 && b.panel.signals.pulses[0] < 32000;
        period(&b, NULL);
    }
    CHECK_EQ(MCC_check_homef(&pc.mcc), 1);
    periods(&b, NULL, 200);
    const int32_t zero = b.panel.signals.pulses[0];
    CHECK(zero >= 29990 && zero <= 32010);
    CHECK_EQ(MCC_jog_c(&pc.mcc, 0, 1, 10.0), 0);
    periods(&b, NULL, 3000);
    b.lines.local.stop = true;
    periods(&b, NULL, 100);
    b.lines.local.stop = false;
    periods(&b, NULL, 100);
    CHECK_EQ(MCC_get_errcode(&pc.mcc), MCC_ERROR_STOP);
    CHECK_EQ(MCC_jog_c(&pc.mcc, 0, 1, 10.0), MCC_RUN_TIME);
    CHECK_EQ(MCC_clear_error(&pc.mcc), 0);
    CHECK(b.panel.signals.pulses[0] > zero + 5000);
    CHECK_EQ(pc.mcc.written.pulses[0], b.panel.signals.pulses[0] - zero);
    b.lines.local.up = 1; /* a switch closes while it is jogged on */
    CHECK_EQ(MCC_jog_c(&pc.mcc, 0, -1, 10.0), 0);
    periods(&b, NULL, 1000);
    CHECK_EQ(MCC_get_errcode(&pc.mcc), 0);
    CHECK_EQ(MCC_jog_c(&pc.mcc, 0, 0, 10.0), 0);
    finish(&b, NULL);
    b.lines.local.up = 0;
    periods(&b, NULL, 4);
    CHECK_EQ(MCC_jog_c(&pc.mcc, 0, 1, 10.0), 0);
    periods(&b, NULL, 1000);
    b.lines.local.up = 1;
    periods(&b, NULL, 4);
    CHECK_EQ(MCC_get_errcode(&pc.mcc), MCC_ERROR_TRAVEL);
    periods(&b, NULL, 3000);
    CHECK_EQ(MCC_clear_error(&pc.mcc), 0);
    CHECK(MCC_line(&pc.mcc, (double[AXES]){ 0.0 }) > 0);
    finish(&b, NULL);
    CHECK_EQ(b.panel.signals.pulses[0], zero);
}

/* A program that cannot run from where the axes stand is not started anew. */
static void cannot_run_again(void)
{
    static const char arc[] = "G91 G1 Z1 F3000\nG90 G2 X20 I10\nG2 X0 I-10\nG1 Z0\n";
    const struct machine m = mcc_machine();
    struct bench b;
    power_on(&b, &m, 0, true);
    periods(&b, arc, 3000);
    b.lines.local.stop = true;
    periods(&b, arc, 50);
    press(&b, &b.panel.cycle_start, arc); /* nothing while the error lasts */
    b.lines.local.stop = false;
    periods(&b, arc, 50);
    press(&b, &b.panel.cycle_start, arc);
    CHECK_EQ(MCC_get_errcode(&pc.mcc), MCC_ERROR_STOP);
    press(&b, &b.panel.clear_error, arc);
    CHECK_EQ(MCC_get_errcode(&pc.mcc), 0);
    const int32_t x = b.panel.signals.pulses[0];
    press(&b, &b.panel.cycle_start, arc);
    CHECK_EQ(MCC_get_errcode(&pc.mcc), MCC_ERROR_ARC);
    periods(&b, arc, 200);
    CHECK_EQ(b.panel.signals.pulses[0], x);
    CHECK_EQ(b.panel.signals.pulses[2], 1000); /* not even the first line */
    press(&b, &b.panel.clear_error, arc);
    CHECK_EQ(MCC_get_errcode(&pc.mcc), 0);
    press(&b, &b.panel.cycle_start, arc);
    CHECK_EQ(MCC_get_errcode(&pc.mcc), MCC_ERROR_ARC);
    press(&b, &b.panel.clear_error, arc);
    CHECK(MCC_line(&pc.mcc, (double[AXES]){ 0.0 }) > 0);
    finish(&b, arc);
    press(&b, &b.panel.cycle_start, arc);
    finish(&b, arc);
    CHECK(pc_done(&pc));
    CHECK_EQ(b.panel.signals.pulses[0], 0);
}

/* A transaction under way when the stop comes is of no account, however it ends. */
static void halted(void)
{
    const struct machine m = mcc_machine();
    struct bench b;
    power_on(&b, &m, 0, false);
    periods(&b, NULL, 50);
    CHECK(MCC_line_x(&pc.mcc, 30.0) > 0);
    while (!pc.pcl.open || pc.pcl.part.points < 4) {
        period(&b, NULL);
    }
    struct pcl_card seen = show(&b);
    struct pcl *p = &pc.pcl;
    p->pending = 2;
    p->refusals = 2;
    pcl_halt(p, true);
    CHECK_EQ(p->refusals, 0);
    queue_clear(&pc.mcc.queue);
    seen.cmd_ack = p->seq;
    p->starved += pcl_release(&pc.mcc, &p->part, pcl_acknowledged(p, &seen));
    pcl_notice(p, &seen, b.now, 0);
    CHECK_EQ(pc.mcc.queue.count, 0);
    CHECK_EQ(p->starved, 0);
    CHECK(!p->open && p->pending == 0);
    CHECK_EQ(pcl_due(p), INT64_MAX);
    pcl_halt(p, false);
    CHECK_EQ(pcl_due(p), 0);
}

/* The motor stands: tracking error on a ramp, or the counter overflows and it stops at once. */
static void stuck_motor(void)
{
    for (int i = 0; i < 2; i++) {
        struct machine m = mcc_machine();
        struct bench b;
        m.axis[0].track_limit = i ? 1000 : 50000;
        power_on(&b, &m, 1, false);
        b.card.config.loop.limit = i ? 32767 : 2000;
        periods(&b, NULL, 50);
        MCC_set_fspd(&pc.mcc, 50.0);
        CHECK(MCC_line_x(&pc.mcc, 30.0) > 0);
        b.lag = 0.0;
        for (int k = 0; k < 20000 && !MCC_get_errcode(&pc.mcc); k++) {
            period(&b, NULL);
        }
        CHECK_EQ(MCC_get_errcode(&pc.mcc), MCC_ERROR_TRACK);
        const int32_t at = b.panel.signals.pulses[0];
        CHECK(at >= (i ? 1000 : 2000) && at < (i ? 1050 : 2100));
        periods(&b, NULL, 5000);
        CHECK(MCC_check_stop(&pc.mcc));
        if (i) {
            CHECK_EQ(MCC_clear_error(&pc.mcc), MCC_RUN_TIME);
        }
        /* At 51.2 pulses per DDA time: what the FIFO holds, or the queue and a ramp of 2.5 mm. */
        const int32_t way = b.panel.signals.pulses[0] - at;
        CHECK(i ? way > 4000 && way < 6000 : way > 0 && way < 16 * 52);
        b.lag = 1.0;
        periods(&b, NULL, 50);
        CHECK_EQ(MCC_clear_error(&pc.mcc), 0);
        check_place(&b, 0.0005);
        CHECK(MCC_line_x(&pc.mcc, 0.0) > 0);
        finish(&b, NULL);
        CHECK_EQ(MCC_get_errcode(&pc.mcc), 0);
        CHECK_EQ(b.panel.signals.pulses[0], 0);
    }
}

/* The second command moves its first pulse when the pulses of the first are out and the motor has
 * settled, not before. */
static void in_position(double lag)
{
    struct machine m = mcc_machine();
    struct bench b;
    m.inpos_mode = MACHINE_INPOS_SETTLE_BLOCK;
    m.inpos_settle = 5e-3;
    m.inpos_timeout = 1.0;
    for (int i = 0; i < 2; i++) {
        m.axis[i].in_pos = true;
        m.axis[i].inpos_tol = 0.005;
    }
    power_on(&b, &m, 1, false);
    b.lag = lag;
    periods(&b, NULL, 50);
    MCC_set_fspd(&pc.mcc, 50.0);
    CHECK(MCC_line_x(&pc.mcc, 10.0) > 0);
    CHECK(MCC_line_x(&pc.mcc, 0.0) > 0);
    int64_t put_out = 0, within = 0, freed = 0, back = 0;
    bool waits = false;
    for (int k = 0; k < 20000 && !back; k++) {
        period(&b, NULL);
        const int32_t pulses = b.panel.signals.pulses[0], error = b.panel.signals.err[0];
        put_out = !put_out && pulses == 10000 ? b.now : put_out;
        within = put_out && !within && abs(error) <= 5 ? b.now : within;
        freed = waits && !freed && !pc.mcc.trajectory.confirming ? b.now : freed;
        waits = pc.mcc.trajectory.confirming;
        back = put_out && pulses < 10000 ? b.now : 0;
    }
    CHECK(put_out && (lag == 1.0 || within > put_out + 100 * BUS));
    CHECK_EQ(freed, within + 50 * BUS);
    CHECK(back < within + 50 * BUS + 40000 + 20 * machine_dda_clocks(&m));
    finish(&b, NULL);
    CHECK_EQ(b.panel.signals.pulses[0], 0);
    CHECK_EQ(MCC_get_errcode(&pc.mcc), 0);
}

int main(void)
{
    emergency_stop();
    pressed_twice();
    jogged();
    cannot_run_again();
    halted();
    stuck_motor();
    in_position(1.0);
    in_position(0.004); /* time constant of 25 ms: 1250 pulses behind at 50 mm/s */
    return check_result();
}
