/* What a person at a panel does with the library: lines by hand, programs begun by cycle_start, run
 * from line, jog up to a software limit. */
#include "mcc_card.h"
#include "reaction.h"
#include "resuming.h"

static struct card card;
static struct pc_panel panel;
static const char *text; /* of the program; NULL: none */
static int64_t now;      /* [clocks] */

static struct pc_config usual(void)
{
    return (struct pc_config){ .bus = 4000,
                               .ipo = 40000,
                               .latency = 8000.0,
                               .seed = 1,
                               .min_stock = 3,
                               .batch = 4,
                               .output_mode = { 1, 1, 1, 1, 1, 1 } };
}

/* Power on: a program that waits for cycle_start, or none. */
static void power_on(const struct machine *m, const char *program)
{
    struct pc_config config = usual();
    config.wait_start = true;
    panel = (struct pc_panel){ .override = 1.0, .rapid = 1.0, .adaptive = 1.0, .jog_percent = 10 };
    text = program;
    now = 0;
    card_start(&card, m, &config, program != NULL);
}

static void periods(int n)
{
    for (int i = 0; i < n; i++) {
        card_period(&card, now, &panel, text);
        now += pc.config.bus;
    }
}

static void press(bool *key)
{
    *key = true;
    periods(20);
    *key = false;
    periods(20);
}

static void give(const char *lines)
{
    CHECK(mdi_take(&pc.mcc, lines, (int32_t)strlen(lines)));
}

/* Until all rests and every pulse is out. */
static void finish(void)
{
    int k = 0;
    do {
        periods(100);
    } while (++k < 3000 && (!MCC_check_stop(&pc.mcc) || mdi_waits(&pc.mcc.mdi)));
    CHECK(k < 3000);
    periods(1000);
}

/* Give a line and wait for its end; *line counts the lines given. */
static void run_line(const char *line, int32_t *number)
{
    give(line);
    finish();
    (*number)++;
    CHECK_EQ(pc.mcc.mdi.line, *number);
    CHECK_EQ(pc.mcc.mdi.ended, *number);
}

/* A line that is refused, with its fault, leaves all as it was. */
static void refuse(const char *line, enum fault fault, int32_t *number)
{
    const int32_t x = card.sum[0], y = card.sum[1];
    int32_t codes[ACTIVE_CODES];

    memcpy(codes, pc.mcc.readout.codes, sizeof codes);
    run_line(line, number);
    CHECK_EQ(pc.mcc.mdi.refused, *number);
    CHECK_EQ(pc.mcc.mdi.fault.fault, fault);
    CHECK(card.sum[0] == x && card.sum[1] == y);
    CHECK(memcmp(codes, pc.mcc.readout.codes, sizeof codes) == 0);
    CHECK_EQ(mdi_room(&pc.mcc.mdi), MDI_SIZE);
}

enum { MANY = 400, TEXT = 1 << 16 };

/* A contour of short lines with arcs, changes of feed, rapids and dwells. *first: place behind the
 * line with which it begins. */
static int contour(char to[TEXT], const char *path, const char *end, int *first)
{
    uint64_t seed = 5;
    int n = snprintf(to, TEXT, "%s\nF6000 G4 P.3\n", path);

    *first = n;
    for (int k = 0; k < MANY; k++) {
        const double a = 0.05 * k, x = 20.0 * sin(a), y = 20.0 - 20.0 * cos(a);
        n += snprintf(to + n, (size_t)(TEXT - n), "G1 X%.4f Y%.4f\n",
                      x + check_real(&seed, 0.0, 0.01), y);
        n += k % 97 == 5 ? snprintf(to + n, (size_t)(TEXT - n), "F%d\n", 3000 + 5 * k) : 0;
        n += k % 61 == 7
                 ? snprintf(to + n, (size_t)(TEXT - n), "G3 X%.4f Y%.4f R30\n", x + 1.0, y + 1.0)
                 : 0;
        n += k % 150 == 9 ? snprintf(to + n, (size_t)(TEXT - n), "M64 P%d\nG0 Z1\nG0 Z0\n", k / 150)
                          : 0;
    }
    return n + snprintf(to + n, (size_t)(TEXT - n), "%s", end);
}

/* Lines that come in time move the axes as the same lines of a program do, pulse by pulse. */
static void as_a_program(const char *path, const char *end)
{
    enum { LONGEST = 400000 };
    static char lines[TEXT];
    static int32_t sum[LONGEST][2];
    const struct machine m = mcc_machine();
    int first, n, used = 0;
    const int length = contour(lines, path, end, &first);

    power_on(&m, lines);
    panel.cycle_start = true; /* before the first look it was up, so this is an edge */
    for (n = 0; n < LONGEST && (n < 100 || !pc_done(&pc)); n++) {
        periods(1);
        memcpy(sum[n], card.sum, sizeof sum[n]);
    }
    CHECK(n < LONGEST && pc_done(&pc));
    const struct outputs outputs = pc.mcc.written.outputs;
    power_on(&m, NULL);
    int apart = 0;
    for (int k = 0; k < n; k++) {
        const char *line = lines + used;
        const int size = used == 0 ? first - 1 : (int)(strchr(line, '\n') - line);
        if (used < length && mdi_take(&pc.mcc, line, size)) {
            used += size + 1;
        }
        periods(1);
        apart += memcmp(sum[k], card.sum, sizeof sum[k]) != 0;
    }
    CHECK_EQ(used, length);
    CHECK_EQ(apart, 0);
    CHECK_EQ(pc.mcc.mdi.ended, pc.mcc.mdi.line);
    CHECK_EQ(pc.mcc.mdi.refused, 0);
    CHECK(MCC_check_stop(&pc.mcc) && outputs.digital == pc.mcc.written.outputs.digital);
}

/* The buffer holds what it says; what does not fit is not taken, and comes later. */
static void room(void)
{
    const struct machine m = mcc_machine();
    char line[] = "G91 G1 X.001 F6000 (a long line, so that the buffer fills up: ............)";
    const int32_t each = (int32_t)strlen(line) + 1;
    int32_t taken = 0, room = MDI_SIZE;

    power_on(&m, NULL);
    CHECK_EQ(mdi_room(&pc.mcc.mdi), MDI_SIZE);
    while (mdi_take(&pc.mcc, line, each - 1)) {
        taken++;
        room -= each;
        CHECK_EQ(mdi_room(&pc.mcc.mdi), room);
    }
    CHECK(room < each && taken == MDI_SIZE / each);
    if (room > 1) {
        line[room - 1] = '\0';
        line[room - 2] = ')';
        CHECK(mdi_take(&pc.mcc, line, room - 1)); /* to the last byte */
        CHECK_EQ(mdi_room(&pc.mcc.mdi), 0);
        taken++;
    }
    CHECK(!mdi_take(&pc.mcc, "", 0));
    while (taken < 1000) {
        periods(1);
        CHECK(mdi_room(&pc.mcc.mdi) >= 0 && mdi_room(&pc.mcc.mdi) <= MDI_SIZE);
        taken += mdi_take(&pc.mcc, line, (int32_t)strlen(line));
    }
    finish();
    CHECK_EQ(card.sum[0], 1000);
    CHECK_EQ(pc.mcc.mdi.ended, 1000);
    give("G90 X5\nX\nX6\n\nX7"); /* five lines at once, one of them bad and one empty */
    finish();
    CHECK_EQ(pc.mcc.mdi.ended, 1005);
    CHECK_EQ(pc.mcc.mdi.refused, 1002);
    CHECK_EQ(card.sum[0], 7000);
}

/* What a line sets is there for the next one and for programs; refused lines leave no trace. */
static void state_is_kept(void)
{
    static const char program[] = "G1 X1 Y1 F6000\nG91 X1\nG20 G2 X1 I.5\nG64 P1\nM2\n";
    const struct machine m = mcc_machine();
    int32_t n = 0;

    power_on(&m, program);
    run_line("G0 X5 Y2", &n);
    run_line("G10 L20 P0 X0 Y0", &n);
    CHECK_EQ(card.sum[0], 5000);
    run_line("G1 X1 F6000", &n);
    CHECK_EQ(card.sum[0], 6000);
    run_line("#<_way> = 3 #7 = 4", &n);
    run_line("X[#<_way> + #7]", &n);
    CHECK_EQ(card.sum[0], 12000);
    refuse("G91 G1 X1 F1000000 Q4", FAULT_UNUSED, &n);
    refuse("G3 G91 X9 Y9 I1 J50", FAULT_ARC_END, &n);
    refuse("G1 X1 (", FAULT_COMMENT, &n);
    refuse("o1 while [1]", FAULT_ALONE, &n);
    refuse("M99", FAULT_ALONE, &n);
    refuse("o<none> call", FAULT_NO_SUB, &n);
    run_line("%", &n);
    run_line("/X0", &n); /* the panel's block delete is off */
    CHECK_EQ(card.sum[0], 5000);
    run_line("M3 S100 G55", &n);
    CHECK(pc.mcc.written.outputs.spindle == 100.0 && readout_zero(&pc.mcc.readout)->system == 2);
    CHECK(readout_zero(&pc.mcc.readout)->offset[0] == 0.0);
    run_line("G54 M5", &n);
    CHECK_EQ(n, 15);

    press(&panel.cycle_start); /* the program works in the offsets and from where the axes are */
    give("G0 X0");
    n++;
    CHECK(pc.mcc.mdi.refused == n && pc.mcc.mdi.fault.fault == FAULT_WHILE_PROGRAM);
    finish();
    CHECK_EQ(card.sum[0], 5000 + 2000 + 25400);
    CHECK_EQ(card.sum[1], 3000);
    CHECK(pc_done(&pc));
    const int32_t modes[] = { 800, 170, 900, 911, 940, 200, 400, 490, 540, 640 };
    CHECK(memcmp(pc.mcc.readout.codes, modes, sizeof modes) == 0);
    run_line("G21 G0 X1", &n); /* M2 has put back G90, but G20 is left as in LinuxCNC */
    CHECK_EQ(card.sum[0], 6000);
    press(&panel.cycle_start); /* anew, with what is left of it */
    finish();
    CHECK_EQ(card.sum[0], 5000 + 2000 + 25400);
}

/* An abort drops the lines that wait; modes are those of a start, offsets stay. */
static void dropped(void)
{
    const struct machine m = mcc_machine();
    int32_t n = 0;

    power_on(&m, NULL);
    run_line("G92 X-10 G91 G20", &n);
    for (int k = 0; k < 300; k++) {
        give("G1 X.1 F600");
    }
    periods(3000);
    CHECK(mdi_waits(&pc.mcc.mdi) && pc.mcc.mdi.ended < 20);
    const int32_t before = card.sum[0];
    CHECK(before > 0 && readout_zero(&pc.mcc.readout)->offset[0] == 254.0);
    press(&panel.abort);
    CHECK_EQ(mdi_room(&pc.mcc.mdi), MDI_SIZE);
    give("G0 X0"); /* during its ramp */
    finish();
    CHECK_EQ(pc.mcc.mdi.line, 302);
    CHECK_EQ(pc.mcc.mdi.ended, 302);
    CHECK_EQ(pc.mcc.mdi.refused, 0);
    CHECK_EQ(card.sum[0], 254000); /* G90 and G21 again, with the shift of G92 */
    reaction_stop(&pc.mcc, MCC_ERROR_IN_POS);
    n = 302;
    refuse("G0 X1", FAULT_WHILE_ERROR, &n);
    press(&panel.clear_error);
    panel.jog[0] = -1;
    periods(200);
    give("G0 X1");
    CHECK_EQ(pc.mcc.mdi.fault.fault, FAULT_WHILE_HAND);
    panel.jog[0] = 0;
    finish();
    n += 1;
    run_line("G0 X1", &n); /* from where the jog has ended */
    CHECK_EQ(card.sum[0], 255000);
}

/* A motion that waits for the next one is held over the end of the lines, and dropped by a jog. */
static void held(void)
{
    const struct machine m = mcc_machine();
    int32_t n = 0;

    power_on(&m, NULL);
    run_line("G41.1 D2 F6000 G1 X5", &n);
    run_line("X10", &n);
    CHECK(card.sum[0] == 5000 && resuming_held(&pc.mcc.program));
    run_line("Y10", &n);
    CHECK_EQ(card.sum[0], 9000);
    run_line("G40 G1 X0", &n);
    CHECK_EQ(card.sum[0], 0);
    run_line("G41.1 D2 G1 X5", &n);
    run_line("X10", &n);
    panel.jog[1] = 1;
    periods(1000);
    panel.jog[1] = 0;
    finish();
    const int32_t y = card.sum[1];
    run_line("G90 G1 X7", &n);
    CHECK(card.sum[0] == 7000 && card.sum[1] == y);
}

/* cycle_start at a line: what stands before it is read, and only its outputs act. */
static void from_line(void)
{
    static const char program[] = "G10 L2 P1 X100\nG1 X50 Y5 F6000\nG91 T4 M6\nM3 S50\nM64 P2\n"
                                  "X1\nG4 P1\nX2\nM5 G90\nX0\nG41.1 D1 X5\nX10\nY10\nM2\n";
    const struct machine m = mcc_machine();

    power_on(&m, program);
    panel.run_from = 6;
    press(&panel.cycle_start);
    periods(1000);
    CHECK(pc.mcc.written.outputs.spindle == 50.0 && pc.mcc.written.outputs.tool == 4);
    CHECK_EQ(pc.mcc.written.outputs.digital, 0);
    CHECK(card.sum[0] == 1000 && card.sum[1] == 0 && pc.mcc.written.line == 7);
    finish();
    CHECK(pc_done(&pc));
    CHECK_EQ(card.sum[0], 109500);
    panel.run_from = 12; /* a motion of line 11 waits for it */
    press(&panel.cycle_start);
    CHECK_EQ(pc.process.refused.fault, FAULT_FROM_HELD);
    CHECK_EQ(pc.process.refused.line, 12);
    panel.run_from = 15;
    press(&panel.cycle_start);
    CHECK_EQ(pc.process.refused.fault, FAULT_FROM_LINE);
    CHECK_EQ(pc.process.refused.line, 15);
    CHECK_EQ(pc.process.refusals, 2);
    CHECK(MCC_check_stop(&pc.mcc) && pc.mcc.error == 0);
    panel.run_from = 1;
    press(&panel.cycle_start);
    periods(100);
    CHECK(!MCC_check_stop(&pc.mcc));
    finish();
    CHECK_EQ(card.sum[0], 109500);
}

/* A jog ends at rest on the software limit, without an error; one from there, or a step beyond it,
 * is refused. A step goes to its end, and steps add up. */
static void jog(void)
{
    struct machine m = mcc_machine();

    m.axis[0].check_ot = true;
    m.axis[0].high_limit = 30.0;
    m.axis[0].low_limit = -20.0;
    m.axis[0].hot_offset = 0.5;
    power_on(&m, NULL);
    panel.jog[0] = 1;
    periods(20000);
    CHECK_EQ(card.sum[0], 29500);
    CHECK_EQ(MCC_get_errcode(&pc.mcc), 0);
    panel.jog[0] = 0;
    periods(100);
    panel.jog[0] = 1;
    periods(1000);
    CHECK_EQ(card.sum[0], 29500);
    panel.jog[0] = -1;
    periods(2000);
    panel.jog[0] = 0;
    finish();
    const int32_t x = card.sum[0];
    CHECK(x > 10000 && x < 28000);
    panel.jog_step[0] = 2.5;
    for (int k = 0; k < 3; k++) {
        panel.jog[0] = -1;
        periods(20);
        panel.jog[0] = 0;
        periods(20);
    }
    CHECK(!MCC_check_stop(&pc.mcc));
    finish();
    CHECK_EQ(card.sum[0], x - 7500);
    panel.jog_step[0] = 60.0;
    press((bool *)&panel.jog[0]); /* 1: beyond the limit */
    finish();
    CHECK_EQ(card.sum[0], x - 7500);
    panel.jog_step[0] = 10.0;
    panel.jog[0] = -1;
    periods(500);
    panel.jog[0] = 0;
    panel.jog_step[0] = 0.0; /* stops it */
    finish();
    CHECK(card.sum[0] > x - 17000 && card.sum[0] < x - 7600);
    CHECK_EQ(MCC_get_errcode(&pc.mcc), 0);
}

/* A share of the speed of rapids alone. */
static void slow_rapids(void)
{
    const struct machine m = mcc_machine();
    int32_t n = 0;

    for (int k = 0; k < 2; k++) {
        power_on(&m, NULL);
        panel.rapid = k == 0 ? 1.0 : 0.25;
        n = 0;
        give("G0 X100");
        periods(1500);
        CHECK_NEAR(pc.mcc.written.feed, 500.0 * panel.rapid, 1e-9);
        finish();
        give("G1 X0 F6000");
        periods(5000);
        CHECK_NEAR(pc.mcc.written.feed, 100.0, 1e-9);
        CHECK_NEAR(pc.mcc.written.left[0], -pc.mcc.written.place[0], 1e-12);
        finish();
        CHECK_EQ(n, 0);
    }
}

int main(void)
{
    as_a_program("G64 P.05", "M2\n");
    as_a_program("G64 P.05 Q.1", "");
    as_a_program("G64", "M30\n");
    as_a_program("G61", "");
    room();
    state_is_kept();
    dropped();
    held();
    from_line();
    jog();
    slow_rapids();
    return check_result();
}
