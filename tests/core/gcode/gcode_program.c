/* Part program interpreter: what a program means. */
#include <stdlib.h>

#include "gcode_reader.h"

static void lines_and_modes(void)
{
    struct reader x;
    begin(&x, "%\n( a comment )\nN10 g21 G90 g 1 x 1 0 f6 00 ; ten, and 600 mm/min\n"
              "/N20 Y-.5(inside)Z+2.\n\n  G91 x1 y1\nX-11\nG90 G0 X5 Y0 Z0\nG64 G1 X6\nG61 X7\n"
              "G20 X1 F60\nG21 G55 X0 Y0 Z0\nG53 X0 Y0 Z0\nX1\nG4 P1.5\nM2\nX99 nonsense");
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_end(&x, 10.0, 0.0, 0.0);
    CHECK_EQ(x.c.line, 3);
    CHECK_NEAR(x.c.feed, 10.0, 0.0);
    CHECK_NEAR(x.c.ramp.acc, 100.0, 1e-12); /* 10 mm/s in 0.1 s */
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_end(&x, 10.0, -0.5, 2.0);
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_end(&x, 11.0, 0.5, 2.0);
    CHECK_EQ(x.c.line, 6);
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_end(&x, 0.0, 0.5, 2.0);
    CHECK_EQ(next(&x), COMMAND_PTP);
    expect_end(&x, 5.0, 0.0, 0.0);
    CHECK_NEAR(x.c.feed, 500.0 * sqrt(25.0 + 0.25 + 4.0) / 5.0, 1e-9); /* X at 500 mm/s */
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK(x.c.blend);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK(!x.c.blend);
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_end(&x, 25.4, 0.0, 0.0);
    CHECK_NEAR(x.c.feed, 25.4, 1e-12); /* 60 inch/min */
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_end(&x, 100.0, 10.0, 1.0); /* origin of G55 */
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_end(&x, 0.0, 0.0, 0.0); /* machine coordinates */
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_end(&x, 101.0, 0.0, 0.0); /* for that line only */
    CHECK_EQ(next(&x), COMMAND_DELAY);
    CHECK_NEAR(x.c.dwell, 1.5, 0.0);
    CHECK_EQ(next(&x), -1); /* nothing is read behind M2 */
    CHECK_EQ(next(&x), -1);
}

static void arcs(void)
{
    const double pi = acos(-1.0);
    struct reader x;
    begin(&x, "G1 X10\nG3 X0 Y10 I-10\nG2 X10 Y0 J-10\nG3 I-10\nG3 I-10 P3 Z5\n"
              "G2 X0 Y10 R10\nG2 X10 Y0 R-10 Z0\nG90.1 G3 X0 Y10 I0 J0\nG91.1 G1 X0 Y0\n"
              "G18 G3 X0 Z10 K5\nG19 G2 Y-5 Z5 K-5\nG17 G91 G2 X4 I2 J0");
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(next(&x), COMMAND_CCW_ARC);
    CHECK_NEAR(x.c.path.sweep, pi / 2, 1e-12);
    CHECK_EQ(next(&x), COMMAND_CW_ARC); /* one of I J may be left out */
    CHECK_NEAR(x.c.path.sweep, -pi / 2, 1e-12);
    CHECK_EQ(next(&x), COMMAND_CCW_ARC); /* no end: full circle */
    CHECK_NEAR(x.c.path.sweep, 2.0 * pi, 1e-12);
    CHECK_EQ(next(&x), COMMAND_CCW_HELIX);
    CHECK_NEAR(x.c.path.sweep, 6.0 * pi, 1e-12);
    CHECK_NEAR(x.c.path.length, hypot(60.0 * pi, 5.0), 1e-10);
    CHECK_EQ(next(&x), COMMAND_CW_ARC); /* clockwise from 0 to 90 degrees: below a half turn */
    CHECK_NEAR(x.c.path.sweep, -pi / 2, 1e-9);
    CHECK_NEAR(x.c.path.centre[0], 10.0, 1e-9);
    CHECK_EQ(next(&x), COMMAND_CW_HELIX);
    CHECK_NEAR(x.c.path.sweep, -1.5 * pi, 1e-9);
    CHECK_EQ(next(&x), COMMAND_CCW_ARC);
    CHECK_NEAR(x.c.path.centre[0], 0.0, 0.0);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(next(&x), COMMAND_CCW_ARC); /* G18: Z is the first axis, X the second */
    CHECK_EQ(x.c.path.plane, PATH_ZX);
    CHECK_NEAR(x.c.path.sweep, pi, 1e-12);
    CHECK_EQ(next(&x), COMMAND_CW_ARC); /* G19: from Z+ to Y-, clockwise 270 degrees */
    CHECK_EQ(x.c.path.plane, PATH_YZ);
    CHECK_NEAR(x.c.path.sweep, -1.5 * pi, 1e-9);
    CHECK_EQ(next(&x), COMMAND_CW_ARC);
    expect_end(&x, 4.0, -5.0, 5.0);
    CHECK_EQ(next(&x), -1);
}

/* Decimal numbers are the doubles nearest to them, as strtod of the C library reads them. */
static void numbers(void)
{
    uint64_t seed = 5;
    for (int i = 0; i < 2000; i++) {
        char text[64], digits[32];
        struct reader x;
        snprintf(digits, sizeof digits, "%.*f", (int)(i % 10), check_real(&seed, 0.001, 99999.0));
        snprintf(text, sizeof text, "G1 X%s", digits);
        begin(&x, text);
        if (strtod(digits, NULL) == 0.0) {
            CHECK_EQ(next(&x), -1);
            continue;
        }
        CHECK_EQ(next(&x), COMMAND_LINE);
        CHECK(x.c.path.end[0] == strtod(digits, NULL));
    }
}

/* A code within 0.0001 of one that exists is that one, below it and above; further off none. */
static void almost_codes(void)
{
    static const double code[] = { 1.0, 17.0, 21.0, 90.1, 61.0, 94.0 };
    for (size_t i = 0; i < 2 * sizeof code / sizeof *code; i++) {
        const double side = i % 2 ? 1.0 : -1.0;
        for (int far = 0; far < 2; far++) {
            char text[64];
            struct reader x;
            snprintf(text, sizeof text, "G%.7f\nG1 X1",
                     code[i / 2] + side * (far ? 1.02e-4 : 0.98e-4));
            begin(&x, text);
            CHECK_EQ(next(&x), far ? -2 : COMMAND_LINE);
            CHECK_EQ(x.r.fault, far ? FAULT_WORD : FAULT_NONE);
        }
    }
}

static void values(void)
{
    struct reader x;
    begin(&x, "G1 X10 Y0 F45000");
    CHECK_EQ(next(&x), -2);
    CHECK_NEAR(x.r.value, 1.5, 1e-12); /* 750 mm/s on a screw of 10 mm are 4500 rpm */
    CHECK_NEAR(x.r.limit, 1.0, 0.0);
    begin(&x, "G2 X10 Y0 I6");
    CHECK_EQ(next(&x), -2);
    CHECK_NEAR(x.r.value, 2.0, 1e-12); /* radii 6 and 4 */
    begin(&x, "G2 X10 R4.9");
    CHECK_EQ(next(&x), -2);
    CHECK_NEAR(x.r.value, 4.9, 0.0);
    CHECK_NEAR(x.r.limit, 5.0, 0.0);
    begin(&x, "G2 X10 R4.996\n"); /* short by the rounding of a program: half a turn */
    CHECK_EQ(next(&x), COMMAND_CW_ARC);
    CHECK_NEAR(x.c.path.sweep, -acos(-1.0), 1e-12);
    begin(&x, "%\nG1 X1\n%\nX2");
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(next(&x), -1); /* the second % is the end */
    begin(&x, "G1 X0\r\nX1\r\n");
    CHECK_EQ(next(&x), COMMAND_LINE); /* a move to where the axes stand is none */
    CHECK_EQ(x.c.line, 2);
}

/* F above the highest feed (1000 mm/s), and above what the screws bear along a path (500 mm/s):
 * what is possible is driven, and a note tells it; a tap needs its own. */
static void quick(void)
{
    static const double feeds[] = { 10.0,  500.0, 707.10678118654752, 500.0, 502.4937810560445,
                                    500.0, 10.0 };
    struct fault_list all;
    struct reader x;

    begin(&x, "F600 G1 X10\nF60000.1 G1 X20\nG1 X40 Y20\nG93 X10 Y20 F2000\nG94 F90000\n"
              "G41.1 D2 X20\nX40\nG40 F600\nX60 Y0\n");
    x.program.strict_feed = false;
    interpreter_check_all(&x.in, &x.program, &all);
    CHECK_EQ(all.count, 0);
    CHECK(all.notes == 1 && all.note[0].fault == FAULT_NOTE_FEED && all.note[0].line == 2);
    for (size_t i = 0; i < sizeof feeds / sizeof *feeds; i++) {
        CHECK(next(&x) >= 0);
        CHECK_NEAR(x.c.feed, feeds[i], 1e-9);
    }
    CHECK_EQ(next(&x), -1);
    begin(&x, "S9000 M3 F90000 G0 Z5\nG81 X1 Z-1 R2\nG84 X2 Z-1 R2\n");
    x.program.strict_feed = false;
    for (int i = 0; i < 4; i++) {
        CHECK(next(&x) >= 0);
    }
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_NEAR(x.c.feed, 500.0, 1e-9);
    while (next(&x) >= 0) {
    }
    CHECK_EQ(x.r.fault, FAULT_FEED);
    CHECK_NEAR(x.r.value, 90000.0, 1e-6);
    begin(&x, "S9000 M3 F36000 G0 Z5\nG84 X2 Z-1 R2\n");
    x.program.strict_feed = false;
    while (next(&x) >= 0) {
    }
    CHECK_EQ(x.r.fault, FAULT_SPEED);
}

int main(void)
{
    quick();
    lines_and_modes();
    arcs();
    numbers();
    almost_codes();
    values();
    return check_result();
}
