/* What a program asks of library, card and model motors in one loop: inputs, a wall to probe. */
#include <stdlib.h>

#include "mcc_card.h"

static const double WALL = 5.4321, FLOOR = -2.71828; /* [mm] beyond X, below Z */

struct room {
    struct card card;
    struct pc_panel panel;
    double place[AXES]; /* [counts] of the motors, which lag their pulses by some 3 ms */
    bool touched;
    double contact[AXES]; /* [mm] where the motors were at the latest look with a change */
    bool latches, open;   /* the card latches at contact, and no level is wired; no encoders */
    int64_t at;           /* [clocks] */
    const char *text;
};

static struct room room;

static void start(const char *text, enum inquiry_place place)
{
    const struct pc_config c = { .bus = 4000,
                                 .ipo = 40000,
                                 .latency = 8000,
                                 .seed = 1,
                                 .min_stock = 3,
                                 .batch = 4,
                                 .home_settle = 0.05 };
    struct machine m = mcc_machine();
    m.queue_depth = 12;
    memset(&room, 0, sizeof room);
    room.panel.override = room.panel.rapid = 1.0;
    room.panel.adaptive = 1.0;
    room.text = text;
    card_start(&room.card, &m, &c, text != NULL);
    CHECK_EQ(inquiry_set_place(&pc.mcc, place), MCC_NO_ERR);
}

/* The wall and the floor, met on the way from one look to the next. */
static void touch(const double from[AXES])
{
    struct signals *s = &room.panel.signals;
    const bool now = room.place[0] >= 1000.0 * WALL || room.place[2] <= 1000.0 * FLOOR;

    if (now != room.touched) {
        for (int i = 0; i < AXES; i++) {
            room.contact[i] = room.place[i] / 1000.0;
            s->latch[i] = (int32_t)lround((from[i] + room.place[i]) / 2.0);
            s->latched[i] += room.latches;
        }
    }
    room.touched = now;
    s->probe = now && !room.latches;
}

static void period(void)
{
    double from[AXES];

    memcpy(from, room.place, sizeof from);
    for (int i = 0; i < AXES; i++) {
        room.place[i] += 0.03 * (room.card.sum[i] - room.place[i]);
        room.panel.signals.enc[i] = room.open ? 0 : (int32_t)lround(room.place[i]);
        room.panel.signals.pulses[i] = room.card.sum[i];
    }
    touch(from);
    card_period(&room.card, room.at, &room.panel, room.text);
    room.at += pc.config.bus;
}

/* Until the program is done, an error has come, or so many seconds are over. */
static void run(double seconds)
{
    const int64_t end = room.at + (int64_t)(seconds * CLOCK_HZ);
    do {
        period();
    } while (room.at < end && !pc_done(&pc) && !pc.mcc.error);
}

/* A contact is where the motor was, to a pulse and the half of one that a counter rounds by; the
 * motion rests behind it, and goes on from there without a jump. */
static void contacts(void)
{
    static const struct {
        const char *text;
        int axis;
        double place;
        enum inquiry_place by;
    } rows[] = {
        { "G38.2 X20 F100\n", 0, WALL, INQUIRY_ENCODERS },
        { "G38.2 X20 F3000\n", 0, WALL, INQUIRY_ENCODERS },
        { "G38.3 Z-10 F300\n", 2, FLOOR, INQUIRY_ENCODERS },
        { "G38.2 X20 Y5 F300\n", 0, WALL, INQUIRY_LATCH },
        { "G1 X8 F3000\nG38.4 X-3 F200\n", 0, WALL, INQUIRY_ENCODERS },
        { "G64 G1 X4 F3000\nG38.2 X20\n", 0, WALL, INQUIRY_ENCODERS },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[120];
        snprintf(text, sizeof text, "%sG91 G1 Y1 F600\n", rows[i].text);
        start(text, rows[i].by);
        room.latches = rows[i].by == INQUIRY_LATCH;
        run(30.0);
        const struct interpreter *in = &pc.mcc.program;
        CHECK_EQ(pc.mcc.error, 0);
        CHECK(pc_done(&pc) && in->touched);
        const int a = rows[i].axis;
        const double pulse = 1e-3;
        for (int k = 0; k < 3; k++) {
            const double is = rows[i].by == INQUIRY_LATCH ? room.panel.signals.latch[k] / 1000.0
                                                          : room.contact[k];
            CHECK_NEAR(in->contact[k], is, 0.5 * pulse + 1e-9);
        }
        const double step = i == 1 || i == 5 ? 0.006 : 0.0006; /* [mm] of a look at that feed */
        CHECK_NEAR(in->contact[a], rows[i].place, step + pulse);
        double place[AXES];
        MCC_get_cpos(&pc.mcc, place);
        CHECK(fabs(place[a] - rows[i].place) < 4.5); /* points ahead and ramp */
        CHECK(fabs(place[a] - rows[i].place) > 0.0);
        CHECK_EQ(room.card.sum[a], lround(1000.0 * place[a]));
        CHECK_EQ(room.card.underflows, 0);
    }
    start("G38.2 X20 F300\n", INQUIRY_PULSES); /* the motor is 3 ms behind these: 15 um */
    room.open = true;
    run(30.0);
    CHECK(pc.mcc.program.touched);
    CHECK_NEAR(pc.mcc.program.contact[0], WALL + 0.016, 0.003);
}

/* Without contact .2 and .4 are errors with the line, .3 and .5 go on; a probe that touches (or
 * does not) already is always an error, before anything moves. */
static void no_contact(void)
{
    static const struct {
        const char *text;
        int32_t error;
        int line;
        double x;
    } rows[] = {
        { "G38.2 X3 F600\nG1 X0\n", MCC_ERROR_PROBE_END, 1, 3.0 },
        { "G38.3 X3 F600\nG1 X4\n", 0, 2, 4.0 },
        { "G1 X8 F6000\nG38.4 X7\nX0\n", MCC_ERROR_PROBE_END, 2, 7.0 },
        { "G1 X8 F6000\nG38.5 X7\nG1 X0\n", 0, 3, 0.0 },
        { "G1 X8 F6000\nG38.2 X9\n", MCC_ERROR_PROBE_FREE, 1, 8.0 },
        { "G1 X1 F6000\nG38.5 X0\n", MCC_ERROR_PROBE_FREE, 1, 1.0 },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        double place[AXES];
        start(rows[i].text, INQUIRY_ENCODERS);
        run(20.0);
        CHECK_EQ(pc.mcc.error, rows[i].error);
        CHECK_EQ(pc.mcc.written.line, rows[i].line);
        CHECK(!pc.mcc.program.touched);
        MCC_get_cpos(&pc.mcc, place);
        CHECK_NEAR(place[0], rows[i].x, 1e-9);
        CHECK(rows[i].error != 0 || pc_done(&pc));
    }
}

/* A hold during the probing, and an abort: nothing hangs. */
static void held(void)
{
    start("G38.2 X20 F600\nG91 G1 Y1\n", INQUIRY_ENCODERS);
    run(0.3);
    room.panel.hold = true;
    run(0.5);
    CHECK(!pc.mcc.program.touched && task_status(&pc.mcc) == TASK_HOLD);
    room.panel.hold = false;
    run(30.0);
    CHECK(pc_done(&pc) && pc.mcc.program.touched);

    start("G38.2 X20 F600\nG91 G1 Y1\n", INQUIRY_ENCODERS);
    run(0.3);
    room.panel.abort = true;
    run(1.0);
    CHECK(pc_done(&pc) && !pc.mcc.program.touched && pc.mcc.written.place[0] < WALL);
}

/* M66: motion ends, then the input is waited for, then the result is there and motion goes on. */
static void inputs(void)
{
    static const struct {
        const char *words;
        double at;
        uint32_t before, then;
        double result;
    } rows[] = {
        { "M66 P3 L3 Q2", 1.0, 0, 8, 1.0 },         { "M66 P3 L3 Q0.5", 1.0, 0, 8, -1.0 },
        { "M66 P31 L4 Q2", 1.0, 1u << 31, 0, 0.0 }, { "M66 P0 L1 Q2", 1.0, 0, 1, 1.0 },
        { "M66 P0 L1 Q1", 3.0, 1, 0, -1.0 },        { "M66 P0 L2 Q2", 1.0, 1, 0, 0.0 },
        { "M66 P5 L0", 9.0, 32, 0, 1.0 },           { "M66 P5", 9.0, ~32u, 0, 0.0 },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[80];
        snprintf(text, sizeof text, "G1 X1 F600\n%s\nX2\n", rows[i].words);
        start(text, INQUIRY_ENCODERS);
        room.panel.signals.digital = rows[i].before;
        run(rows[i].at);
        if (rows[i].at < 9.0 && rows[i].result >= 0.0) {
            CHECK(pc.mcc.program.waits && pc.mcc.written.place[0] == 1.0);
            CHECK_EQ(task_status(&pc.mcc), TASK_DELAY);
        }
        room.panel.signals.digital = rows[i].then;
        run(9.0);
        CHECK(pc_done(&pc) && pc.mcc.written.place[0] == 2.0);
        CHECK_NEAR(pc.mcc.program.input, rows[i].result, 0.0);
    }
    start("M66 E2\n", INQUIRY_ENCODERS);
    room.panel.signals.analog[2] = -3.5;
    run(1.0);
    CHECK(pc_done(&pc) && pc.mcc.program.input == -3.5);
}

/* M49 to M53 from their place on: which of panel and adaptive feed act. [s] of 20 mm at 10 mm/s. */
static void overrides(void)
{
    static const struct {
        const char *words;
        double override, adaptive;
        bool hold;
        double time;
    } rows[] = {
        { "", 0.5, 0.25, false, 4.0 },           { "M50 P0", 0.5, 0.25, false, 2.0 },
        { "M49", 0.5, 0.25, false, 2.0 },        { "M49\nM48", 0.5, 0.25, false, 4.0 },
        { "M52", 1.0, 0.5, false, 4.0 },         { "M52", 0.5, 0.5, false, 8.0 },
        { "M52\nM50 P0", 0.5, 0.5, false, 4.0 }, { "M52\nM52 P0", 1.0, 0.5, false, 2.0 },
        { "M53 P0", 1.0, 1.0, true, 2.0 },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char text[80];
        snprintf(text, sizeof text, "%s\nG4 P0.5\nG1 X20 F600\nM2\n", rows[i].words);
        start(text, INQUIRY_ENCODERS);
        room.panel.override = rows[i].override;
        room.panel.adaptive = rows[i].adaptive;
        run(0.3);
        room.panel.hold = rows[i].hold;
        run(30.0);
        CHECK(pc_done(&pc));
        CHECK_NEAR((double)room.at / CLOCK_HZ, rows[i].time + 0.5, 0.25);
        CHECK_EQ(pc.mcc.trajectory.overrides, 0);
    }
}

/* M6: status 2 with the tool that is asked for; cycle_start goes on with it in the spindle. */
static void tool_change(void)
{
    static const struct tool_table open;

    start("M3 S100\nG1 X1 F600\nT7 M6\nG1 X2\n", INQUIRY_ENCODERS);
    task_set_tools(&pc.mcc, &open, true);
    run(1.0);
    const struct outputs *o = &pc.mcc.written.outputs;
    CHECK(task_status(&pc.mcc) == TASK_HOLD && o->asks && o->asked == 7 && o->tool == 0);
    CHECK(o->spindle == 0.0 && pc.mcc.written.place[0] == 1.0);
    room.panel.cycle_start = true;
    run(5.0);
    CHECK(pc_done(&pc) && o->tool == 7 && !o->asks && pc.mcc.written.place[0] == 2.0);

    start("G1 X1 F600\nT7 M6\nG1 X2\n", INQUIRY_ENCODERS);
    task_set_tools(&pc.mcc, &open, true);
    run(1.0);
    room.panel.abort = true;
    run(0.2);
    CHECK(pc_done(&pc) && o->tool == 0 && !o->asks && pc.mcc.program.tools.loaded == 0);
}

int main(void)
{
    contacts();
    no_contact();
    held();
    inputs();
    overrides();
    tool_change();
    return check_result();
}
