/* Offsets, home, stops and outputs: what the interpreter makes of each word. */
#include "gcode_reader.h"
#include "queue.h"

/* The next command is a motion to a point. */
static void expect_move(struct reader *x, enum command_type type, double a, double b, double c)
{
    CHECK_EQ(next(x), type);
    expect_end(x, a, b, c);
}

static void block_delete(void)
{
    struct reader x;
    begin(&x, "G1 X1\n/X2\n /N5 X3\n/X4 nonsense $ (\nX5\n");
    x.program.block_delete = true;
    expect_move(&x, COMMAND_LINE, 1.0, 0.0, 0.0);
    expect_move(&x, COMMAND_LINE, 5.0, 0.0, 0.0);
    CHECK_EQ(x.c.line, 5);
    CHECK_EQ(next(&x), -1);
    begin(&x, "G1 X1\n/X2\n");
    expect_move(&x, COMMAND_LINE, 1.0, 0.0, 0.0);
    expect_move(&x, COMMAND_LINE, 2.0, 0.0, 0.0);
}

static void home(void)
{
    struct reader x;
    begin(&x, "G1 X10 Y20 Z30\nG28 X11 Z31\nX5\nG91 G28 Y-1\nG90 G55 G28 X0\nG28\nG28\nX1\n");
    expect_move(&x, COMMAND_LINE, 10.0, 20.0, 30.0);
    expect_move(&x, COMMAND_PTP, 11.0, 20.0, 31.0);
    CHECK_NEAR(x.c.feed, 500.0 * sqrt(2.0), 1e-9); /* rapid: both axes at their safe speed */
    expect_move(&x, COMMAND_PTP, 0.0, 20.0, 0.0);  /* only those named */
    expect_move(&x, COMMAND_LINE, 5.0, 20.0, 0.0); /* the motion code stays in force */
    expect_move(&x, COMMAND_PTP, 5.0, 19.0, 0.0);  /* the point in between may be incremental, */
    expect_move(&x, COMMAND_PTP, 5.0, 0.0, 0.0);
    expect_move(&x, COMMAND_PTP, 100.0, 0.0, 0.0); /* and lies in the system in force: G55 */
    expect_move(&x, COMMAND_PTP, 0.0, 0.0, 0.0);
    expect_move(&x, COMMAND_LINE, 101.0, 0.0, 0.0); /* no axis word: all; there already: nothing */
    CHECK_EQ(next(&x), -1);
    begin(&x, "G1 X10 Y20\nG28\n");
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_move(&x, COMMAND_PTP, 0.0, 0.0, 0.0);
    CHECK_EQ(next(&x), -1);
}

/* P of G64 is the tolerance of the look-ahead, in the units in force, until the next G64 or G61. */
static void tolerance(void)
{
    struct reader x;
    begin(&x, "G64 P0.1 G1 X1\nX2\nG20 G64 P.01\nG21 X3\nG92 X0 G64 P0.2\nX1\nG64 X2\n"
              "G64 P1\nG61 X3\n");
    const double want[] = { 0.1, 0.1, 0.254, 0.2, 0.0, 0.0 };
    for (int i = 0; i < 6; i++) {
        CHECK_EQ(next(&x), COMMAND_LINE);
        CHECK_NEAR(x.c.tolerance, want[i], 1e-15);
        CHECK_EQ(x.c.blend, i < 5);
    }
    CHECK_EQ(next(&x), -1);
}

/* Both words of the exact stop end path mixing, and say nothing of a tolerance. */
static void exact_stop(void)
{
    static const char *const words[] = { "G61", "G61.1" };
    for (size_t i = 0; i < sizeof words / sizeof *words; i++) {
        struct reader x;
        char text[64];
        snprintf(text, sizeof text, "G64 P0.1 G1 X1\n%s X2\nX3\nG64 X4\n", words[i]);
        begin(&x, text);
        for (int k = 0; k < 4; k++) {
            CHECK_EQ(next(&x), COMMAND_LINE);
            CHECK_EQ(x.c.blend, k == 0 || k == 3);
            CHECK_NEAR(x.c.tolerance, k == 0 ? 0.1 : 0.0, 0.0);
        }
        CHECK_EQ(next(&x), -1);
    }
}

static void shifts(void)
{
    struct reader x;
    begin(&x, "G1 X10 Y20\nG92 X1 Z5\nX2 Y21 Z5\nG92.2\nX2 Z0\nG92.3\nX2 Z6\nG92 Y0\nY1\n"
              "G92.1 X0 Y0 Z0\nG92.3\nX1\n");
    expect_move(&x, COMMAND_LINE, 10.0, 20.0, 0.0);
    expect_move(&x, COMMAND_LINE, 11.0, 21.0, 0.0); /* 10 is X1, 0 is Z5; Y as before */
    expect_move(&x, COMMAND_LINE, 2.0, 21.0, 0.0);  /* suspended */
    expect_move(&x, COMMAND_LINE, 11.0, 21.0, 1.0); /* in force again */
    expect_move(&x, COMMAND_LINE, 11.0, 22.0, 1.0); /* Y moved too: 21 is Y0 */
    expect_move(&x, COMMAND_LINE, 0.0, 0.0, 0.0);   /* cancelled before the motion */
    expect_move(&x, COMMAND_LINE, 1.0, 0.0, 0.0);   /* nothing left to restore */
    CHECK_EQ(next(&x), -1);
    begin(&x, "G1 X10\nG92 X0 Y1\nG92.2\nG92 X4\nX4 Y0\n");
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(next(&x), -1); /* G92 begins afresh after G92.2: X4 is 10, Y0 is 0 */
    begin(&x, "G52 X3 Y-2\nG1 X10\nG92 X1 Y5\nX2 Y5\nG52 X0\nX2 Y5\nG92.2 X2 Y5\nG92.3 Y6\n"
              "G92.1\nG52 X1\nG92.2\nX7 Y0\nG92.3 X7\n");
    expect_move(&x, COMMAND_LINE, 13.0, 0.0, 0.0);
    expect_move(&x, COMMAND_LINE, 14.0, 0.0, 0.0); /* 13 is X1, whatever G52 moved; 0 is Y5 */
    expect_move(&x, COMMAND_LINE, 2.0, 0.0, 0.0);  /* they share what they set */
    expect_move(&x, COMMAND_LINE, 2.0, 5.0, 0.0);
    expect_move(&x, COMMAND_LINE, 2.0, 1.0, 0.0);
    expect_move(&x, COMMAND_LINE, 7.0, 0.0, 0.0); /* G92.2 takes G52 out of force, too */
    expect_move(&x, COMMAND_LINE, 8.0, 0.0, 0.0);
    CHECK_EQ(next(&x), -1);
}

static void origins_and_local(void)
{
    struct reader x;
    begin(&x, "G10 L2 P1 X10\nG1 X0 Y1\nG10 L2 P2 X50\nG55 X0 Y0\nG10 L2 P0 Y-7 Z3\nX0 Y0 Z0\n"
              "G52 X1\nX0\nG54 X0 Y0 Z0\nG53 X2\nG52 X0\nX0\n"
              "G20 G10 L2 P6 X1\nG59 X1\nG92 X0\nX1\nG21 G53 X7\n");
    expect_move(&x, COMMAND_LINE, 10.0, 1.0, 0.0);
    expect_move(&x, COMMAND_LINE, 50.0, 10.0, 0.0); /* Y of G55 stays as it began */
    expect_move(&x, COMMAND_LINE, 50.0, -7.0, 3.0); /* P0: the system in force */
    expect_move(&x, COMMAND_LINE, 51.0, -7.0, 3.0); /* G52 moves every system */
    expect_move(&x, COMMAND_LINE, 11.0, 0.0, 0.0);
    expect_move(&x, COMMAND_LINE, 2.0, 0.0, 0.0); /* but not the machine's */
    expect_move(&x, COMMAND_LINE, 10.0, 0.0, 0.0);
    expect_move(&x, COMMAND_LINE, 50.8, 0.0, 0.0); /* one inch from one inch */
    expect_move(&x, COMMAND_LINE, 76.2, 0.0, 0.0);
    expect_move(&x, COMMAND_LINE, 7.0, 0.0, 0.0);
    CHECK_EQ(next(&x), -1);
    begin(&x, "G92 X-5 Y-5\nG90.1 G1 X-5 Y5\nG2 X5 Y-5 I-5 J-5\n");
    expect_move(&x, COMMAND_LINE, 0.0, 10.0, 0.0);
    expect_move(&x, COMMAND_CW_ARC, 10.0, 0.0, 0.0);
    CHECK(x.c.path.centre[0] == 0.0 && x.c.path.centre[1] == 0.0); /* in the shifted system */
}

/* Several turns: start and end are exact, the sweep is the arc's and whole turns. */
static void turns(void)
{
    const double pi = acos(-1.0);
    struct reader x;
    double at[AXES], slope[AXES];
    begin(&x, "G1 X10\nG2 X0 Y10 Z8 I-10 P4\nG3 X0 Y10 J-10 P2\n");
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_move(&x, COMMAND_CW_HELIX, 0.0, 10.0, 8.0);
    CHECK_NEAR(x.c.path.sweep, -7.5 * pi, 1e-12); /* 270 degrees and three turns */
    CHECK_NEAR(x.c.path.length, hypot(75.0 * pi, 8.0), 1e-10);
    path_at(&x.c.path, x.c.path.length * 2.0 / 7.5, at, slope); /* after one whole turn */
    CHECK_NEAR(at[0], 10.0, 1e-12);
    CHECK_NEAR(at[1], 0.0, 1e-12);
    CHECK_NEAR(at[2], 8.0 * 2.0 / 7.5, 1e-12);
    expect_move(&x, COMMAND_CCW_ARC, 0.0, 10.0, 8.0);
    CHECK_NEAR(x.c.path.sweep, 4.0 * pi, 1e-12);
}

static void stops(void)
{
    struct reader x;
    begin(&x, "G1 X1 M0\nM1\nX2 M1\nM0\nM2\nX3\n");
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(next(&x), COMMAND_STOP); /* after the motion of its line */
    CHECK_EQ(x.c.line, 1);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(next(&x), COMMAND_STOP);
    CHECK_EQ(x.c.line, 4);
    CHECK_EQ(next(&x), -1);
    begin(&x, "G1 X1 M0\nM1\nX2 M1\n");
    x.program.optional_stop = true;
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(next(&x), COMMAND_STOP);
    CHECK_EQ(next(&x), COMMAND_STOP);
    CHECK_EQ(x.c.line, 2);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(next(&x), COMMAND_STOP);
    CHECK_EQ(next(&x), -1);
}

static void expect_outputs(struct reader *x, double spindle, int coolant)
{
    CHECK_EQ(next(x), COMMAND_OUTPUTS);
    CHECK_NEAR(x->c.spindle, spindle, 0.0);
    CHECK_EQ(x->c.coolant, coolant);
}

static void spindle_and_coolant(void)
{
    struct reader x;
    begin(&x, "S1000\nM3\nG1 X1 S1500\nM4 M7\nM8\nM8\nM3 S1500\nM9\nG4 P1 S20\nM5 X2\nS900\n"
              "M3 M8 X3 M2\n");
    expect_outputs(&x, 1000.0, 0); /* S alone turns nothing */
    expect_outputs(&x, 1500.0, 0); /* before the motion of its line */
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_outputs(&x, -1500.0, OUTPUTS_MIST);
    expect_outputs(&x, -1500.0, OUTPUTS_MIST | OUTPUTS_FLOOD);
    CHECK_EQ(x.c.line, 5);
    expect_outputs(&x, 1500.0, OUTPUTS_MIST | OUTPUTS_FLOOD); /* the second M8 changes nothing */
    CHECK_EQ(x.c.line, 7);
    expect_outputs(&x, 1500.0, 0);
    expect_outputs(&x, 20.0, 0);
    CHECK_EQ(next(&x), COMMAND_DELAY);
    expect_outputs(&x, 0.0, 0);
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_outputs(&x, 900.0, OUTPUTS_FLOOD);
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_outputs(&x, 0.0, 0); /* M2 switches both off, behind the motion */
    CHECK_EQ(next(&x), -1);
    begin(&x, "M3 S5\nG1 X1\n"); /* the end of the text alone does not */
    expect_outputs(&x, 5.0, 0);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(next(&x), -1);
}

static void digital(void)
{
    struct reader x;
    begin(&x, "M62 P0\nM62 P31\nM63 P2\nG4 P1\nG1 X0\nX1\nX2\nM62 P4\nM63 P4\nX3 M62 P5\n"
              "M64 P1 G0 X4\nM65 P31\nM62 P3 G28 X1\nG3 M63 P1 I5\nM62 P9\n");
    CHECK_EQ(next(&x), COMMAND_DELAY); /* no motion */
    CHECK_EQ(x.c.set | x.c.clear, 0);
    CHECK_EQ(next(&x), COMMAND_LINE); /* nor is the way to where the axes are */
    CHECK_EQ(x.c.line, 6);
    CHECK_EQ(x.c.set, 0x80000001u);
    CHECK_EQ(x.c.clear, 4);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(x.c.set | x.c.clear, 0);
    CHECK_EQ(next(&x), COMMAND_LINE); /* the last word on P4 counts */
    CHECK_EQ(x.c.set, 0x20);
    CHECK_EQ(x.c.clear, 0x10);
    expect_outputs(&x, 0.0, 0);
    CHECK_EQ(x.c.set, 2);
    CHECK_EQ(x.c.clear, 0);
    CHECK_EQ(next(&x), COMMAND_PTP);
    CHECK_EQ(x.c.set, 0);
    expect_outputs(&x, 0.0, 0);
    CHECK_EQ(x.c.clear, 0x80000000u);
    CHECK_EQ(next(&x), COMMAND_PTP); /* the first of the two of G28 */
    CHECK_EQ(x.c.set, 8);
    CHECK_EQ(next(&x), COMMAND_PTP);
    CHECK_EQ(x.c.set, 0);
    CHECK_EQ(next(&x), -2); /* P of M63 or of the arc? */
    CHECK_EQ(x.r.fault, FAULT_SHARED);
    begin(&x, "M63 P4\nM63 P5\nM62 P4\nG1 X1\nM62 P6\nM63 P6\nX2\n");
    CHECK_EQ(next(&x), COMMAND_LINE); /* one output is set or cleared, never both */
    CHECK_EQ(x.c.set, 0x10);
    CHECK_EQ(x.c.clear, 0x20);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(x.c.set, 0);
    CHECK_EQ(x.c.clear, 0x40);
}

/* G80 beside a motion word gives way to it, on either side. */
static void safety_line(void)
{
    struct reader x;
    begin(&x, "G17 G21 G40 G49 G80 G90 G1 X5\nG0 G80 X6\nX7\nG80\n");
    expect_move(&x, COMMAND_LINE, 5.0, 0.0, 0.0);
    expect_move(&x, COMMAND_PTP, 6.0, 0.0, 0.0);
    expect_move(&x, COMMAND_PTP, 7.0, 0.0, 0.0);
    CHECK_EQ(next(&x), -1);
}

/* A block may do it all; the order is that of RS-274, not that of the words. */
static void order(void)
{
    struct reader x;
    begin(&x, "G1 F600\nM0 X3 M8 P7 M3 S100 G20 M64 F60\nM30 G28 Y1 M4 M62 P1\n");
    expect_outputs(&x, 100.0, OUTPUTS_FLOOD);
    CHECK_EQ(x.c.set, 0x80);
    expect_move(&x, COMMAND_LINE, 76.2, 0.0, 0.0);
    CHECK_NEAR(x.c.feed, 25.4, 1e-12);
    CHECK_EQ(next(&x), COMMAND_STOP);
    expect_outputs(&x, -100.0, OUTPUTS_FLOOD);
    expect_move(&x, COMMAND_PTP, 76.2, 25.4, 0.0);
    CHECK_EQ(x.c.set, 2);
    expect_move(&x, COMMAND_PTP, 76.2, 0.0, 0.0);
    expect_outputs(&x, 0.0, 0);
    CHECK_EQ(next(&x), -1);
}

/* A number that a program may set reads back to the bit, whatever its value; #5599 begins as 1. */
static void read_back(void)
{
    static const double values[] = { 0.1, 1.0, 0.0, -0.0, -2.0, 1e-17, 0x1p-1074, 1e308, -1e308 };
    static const int32_t numbers[] = { 1, 5000, 5061, 5070, 5599 };
    struct reader x;
    double value;

    begin(&x, "");
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++) {
        const struct parameter which = { .number = numbers[k] };
        CHECK_EQ(parameters_get(&x.in, &x.program, &which, &value), FAULT_NONE);
        CHECK(value == (numbers[k] == 5599 ? 1.0 : 0.0));
        for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
            CHECK_EQ(parameters_set(&x.in, &x.program, &which, values[i]), FAULT_NONE);
            CHECK_EQ(parameters_get(&x.in, &x.program, &which, &value), FAULT_NONE);
            CHECK(memcmp(&value, &values[i], sizeof value) == 0);
        }
    }
    begin(&x, "#5599 = 0.1\nG1 X#5599\n");
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK(x.c.path.end[0] == 0.1);
}

int main(void)
{
    block_delete();
    home();
    tolerance();
    exact_stop();
    shifts();
    origins_and_local();
    turns();
    stops();
    spindle_and_coolant();
    digital();
    safety_line();
    order();
    read_back();
    return check_result();
}
