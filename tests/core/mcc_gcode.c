/* Part program interpreter: what a program means, and every way in which it can be wrong. */
#include <stdlib.h>

#include "interpreter.h"
#include "mcc_check.h"

static const double origins[INTERPRETER_SYSTEMS][AXES] = { { 0 }, { 100.0, 10.0, 1.0 } };

struct reader {
    struct machine machine;
    struct interpreter in;
    struct program program;
    struct command c;
    struct fault_report r;
};

static void begin(struct reader *x, const char *text)
{
    const double zero[AXES] = { 0.0 };
    memset(x, 0, sizeof *x);
    x->machine = mcc_machine();
    x->program = (struct program){ text, strlen(text), &x->machine, origins };
    interpreter_start(&x->in, zero, x->machine.feed);
}

/* The next command; its type, or -1 at the end, -2 for a fault. */
static int next(struct reader *x)
{
    const enum interpreter_result got = interpreter_next(&x->in, &x->program, &x->c, &x->r);
    return got == INTERPRETER_END ? -1 : got == INTERPRETER_FAULT ? -2 : (int)x->c.type;
}

static void expect_end(struct reader *x, double a, double b, double c)
{
    CHECK_NEAR(x->c.path.end[0], a, 1e-12);
    CHECK_NEAR(x->c.path.end[1], b, 1e-12);
    CHECK_NEAR(x->c.path.end[2], c, 1e-12);
}

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
    CHECK_NEAR(x.c.acc, 100.0, 1e-12);      /* 10 mm/s in 0.1 s */
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_end(&x, 10.0, -0.5, 2.0);
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_end(&x, 11.0, 0.5, 2.0);
    CHECK_EQ(x.c.line, 6);
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_end(&x, 0.0, 0.5, 2.0);
    CHECK_EQ(next(&x), COMMAND_PTP);
    expect_end(&x, 5.0, 0.0, 0.0);
    CHECK_NEAR(x.c.feed, 500.0 * sqrt(25.0 + 0.25 + 4.0) / 5.0, 1e-9);  /* X at 500 mm/s */
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK(x.c.blend);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK(!x.c.blend);
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_end(&x, 25.4, 0.0, 0.0);
    CHECK_NEAR(x.c.feed, 25.4, 1e-12);      /* 60 inch/min */
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_end(&x, 100.0, 10.0, 1.0);       /* origin of G55 */
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_end(&x, 0.0, 0.0, 0.0);          /* machine coordinates */
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_end(&x, 101.0, 0.0, 0.0);        /* for that line only */
    CHECK_EQ(next(&x), COMMAND_DELAY);
    CHECK_NEAR(x.c.dwell, 1.5, 0.0);
    CHECK_EQ(next(&x), -1);                 /* nothing is read behind M2 */
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
    CHECK_EQ(next(&x), COMMAND_CW_ARC);     /* one of I J may be left out */
    CHECK_NEAR(x.c.path.sweep, -pi / 2, 1e-12);
    CHECK_EQ(next(&x), COMMAND_CCW_ARC);    /* no end: full circle */
    CHECK_NEAR(x.c.path.sweep, 2.0 * pi, 1e-12);
    CHECK_EQ(next(&x), COMMAND_CCW_HELIX);
    CHECK_NEAR(x.c.path.sweep, 6.0 * pi, 1e-12);
    CHECK_NEAR(x.c.path.length, hypot(60.0 * pi, 5.0), 1e-10);
    CHECK_EQ(next(&x), COMMAND_CW_ARC);     /* clockwise from 0 to 90 degrees: below a half turn */
    CHECK_NEAR(x.c.path.sweep, -pi / 2, 1e-9);
    CHECK_NEAR(x.c.path.centre[0], 10.0, 1e-9);
    CHECK_EQ(next(&x), COMMAND_CW_HELIX);
    CHECK_NEAR(x.c.path.sweep, -1.5 * pi, 1e-9);
    CHECK_EQ(next(&x), COMMAND_CCW_ARC);
    CHECK_NEAR(x.c.path.centre[0], 0.0, 0.0);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(next(&x), COMMAND_CCW_ARC);    /* G18: Z is the first axis, X the second */
    CHECK_EQ(x.c.path.plane, PATH_ZX);
    CHECK_NEAR(x.c.path.sweep, pi, 1e-12);
    CHECK_EQ(next(&x), COMMAND_CW_ARC);     /* G19: from Z+ to Y-, clockwise 270 degrees */
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
        snprintf(digits, sizeof digits, "%.*f", (int)(i % 10), mcc_random(&seed, 0.001, 99999.0));
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

static void faults(void)
{
    static const struct { const char *text; int line; const char *at; enum fault fault; } bad[] = {
        { "G1 X1\nY2 Q3", 2, "Q3", FAULT_WORD },
        { "G1 X1 A5", 1, "A5", FAULT_WORD },
        { "G5 X1", 1, "G5", FAULT_WORD },
        { "G1.5 X1", 1, "G1.5", FAULT_WORD },
        { "G-1 X1", 1, "G-1", FAULT_WORD },
        { "G9999999 X1", 1, "G9999999", FAULT_WORD },
        { "G61.1", 1, "G61.1", FAULT_WORD },
        { "M3", 1, "M3", FAULT_WORD },
        { "\n\nG1 X1 $", 3, "$", FAULT_CHARACTER },
        { "G1 X1 / Y2", 1, "/", FAULT_CHARACTER },
        { "%%", 1, "%", FAULT_CHARACTER },
        { "G1 X", 1, "X", FAULT_NUMBER },
        { "G1 X. Y1", 1, "X.", FAULT_NUMBER },
        { "G1 X-Y1", 1, "X-", FAULT_NUMBER },
        { "G1 X1.2.3", 1, ".", FAULT_CHARACTER },
        { "G1 X1e3", 1, "e3", FAULT_WORD },
        { "G1 X12345678901234567", 1, "X12345678901234567", FAULT_DIGITS },
        { "G1 X1 (open", 1, "(open", FAULT_COMMENT },
        { "G1 X1 x 2", 1, "x 2", FAULT_TWICE },
        { "N1 N2", 1, "N2", FAULT_TWICE },
        { "N-1", 1, "N-1", FAULT_VALUE },
        { "G0 G1 X1", 1, "G1", FAULT_GROUP },
        { "G17 G18", 1, "G18", FAULT_GROUP },
        { "G4 P1 G53", 1, "G53", FAULT_GROUP },
        { "M2 M30", 1, "M30", FAULT_GROUP },
        { "X1", 1, "X1", FAULT_NO_MOTION },
        { "G1 X1\nG80 Y1", 2, "Y1", FAULT_NO_MOTION },
        { "G1 X1 I1", 1, "I1", FAULT_UNUSED },
        { "G1 X1 P1", 1, "P1", FAULT_UNUSED },
        { "R1", 1, "R1", FAULT_UNUSED },
        { "G1 X1 F0", 1, "F0", FAULT_VALUE },
        { "G1 X1 F-5", 1, "F-5", FAULT_VALUE },
        { "F60000.1", 1, "F60000.1", FAULT_FEED },
        { "G20 F2363", 1, "F2363", FAULT_FEED },
        { "G4", 1, "G4", FAULT_NO_DWELL },
        { "G4 P-1", 1, "P-1", FAULT_VALUE },
        { "G1 X1\nG4 P1 X2", 2, "X2", FAULT_UNUSED },
        { "G53", 1, "G53", FAULT_NO_AXES },
        { "G53 X1", 1, "G53 X1", FAULT_G53 },
        { "G1 U1", 1, "U1", FAULT_AXIS },
        { "G1 X1 Y0 F30001", 1, "G1 X1 Y0 F30001", FAULT_SPEED },
        { "G1 X900000", 1, "G1 X900000", FAULT_RANGE },
        { "G1 X99 (to the start)\nG2 X1 Y1", 2, "G2 X1 Y1", FAULT_NO_CENTRE },
        { "G2", 1, "G2", FAULT_NO_CENTRE },
        { "G90.1 G2 X1 I1", 1, "G90.1 G2 X1 I1", FAULT_NO_CENTRE },
        { "G2 X1 I1 R1", 1, "G2 X1 I1 R1", FAULT_CENTRE_AND_R },
        { "G2 X1 K1", 1, "K1", FAULT_UNUSED },
        { "G18 G2 X1 J1", 1, "J1", FAULT_UNUSED },
        { "G2 X1 I0 J0", 1, "G2 X1 I0 J0", FAULT_ARC_RADIUS },
        { "G2 X10 Y0 I6", 1, "G2 X10 Y0 I6", FAULT_ARC_END },
        { "G2 X10 R4.9", 1, "G2 X10 R4.9", FAULT_ARC_CHORD },
        { "G2 R5", 1, "G2 R5", FAULT_ARC_CLOSED },
        { "G2 X10 R0", 1, "G2 X10 R0", FAULT_ARC_RADIUS },
        { "G3 I5 P1.5", 1, "P1.5", FAULT_VALUE },
        { "G3 I5 P0", 1, "P0", FAULT_VALUE },
    };
    bool seen[FAULT_COUNT] = { [FAULT_NONE] = true, [FAULT_LINE_LENGTH] = true,
                               [FAULT_WORD_COUNT] = true };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct reader x;
        begin(&x, bad[i].text);
        const struct interpreter before = x.in;
        struct fault_report r;
        interpreter_check(&x.in, &x.program, &r);
        const bool good = r.fault == bad[i].fault && r.line == bad[i].line &&
                          (size_t)r.length == strlen(bad[i].at) &&
                          !memcmp(bad[i].text + r.at, bad[i].at, (size_t)r.length);
        CHECK(good);
        if (!good) {
            printf("    '%s': %s '%.*s'\n", bad[i].text, fault_text(r.fault), (int)r.length,
                   bad[i].text + r.at);
        }
        CHECK(!memcmp(&before, &x.in, sizeof before));
        while (next(&x) >= 0) {
        }
        CHECK_EQ(next(&x), -1);     /* a fault ends the program */
        seen[bad[i].fault] = true;
    }
    for (int i = 0; i < FAULT_COUNT; i++) {
        CHECK(seen[i] && fault_text((enum fault)i)[0]);
    }
}

static void long_lines(void)
{
    char text[400];
    struct reader x;
    memset(text, ' ', sizeof text);
    memcpy(text, "G1", 2);
    strcpy(text + 255, "X");
    begin(&x, text);
    CHECK_EQ(next(&x), -2);
    CHECK_EQ(x.r.fault, FAULT_NUMBER);      /* 256 characters are read */
    text[255] = ' ';
    strcpy(text + 256, "X");
    begin(&x, text);
    CHECK_EQ(next(&x), -2);
    CHECK_EQ(x.r.fault, FAULT_LINE_LENGTH);
    text[0] = '\0';
    for (int i = 0; i < 41; i++) {
        strcat(text, "G1 ");
    }
    begin(&x, text);
    CHECK_EQ(next(&x), -2);
    CHECK_EQ(x.r.fault, FAULT_WORD_COUNT);
}

static void values(void)
{
    struct reader x;
    begin(&x, "G1 X10 Y0 F45000");
    x.machine.axis[0].rpm = 3000.0;
    CHECK_EQ(next(&x), -2);
    CHECK_NEAR(x.r.value, 4500.0, 1e-9);    /* 750 mm/s on a screw of 10 mm */
    CHECK_NEAR(x.r.limit, 3000.0, 0.0);
    begin(&x, "G2 X10 Y0 I6");
    CHECK_EQ(next(&x), -2);
    CHECK_NEAR(x.r.value, 2.0, 1e-12);      /* radii 6 and 4 */
    begin(&x, "G2 X10 R4.9");
    CHECK_EQ(next(&x), -2);
    CHECK_NEAR(x.r.value, 4.9, 0.0);
    CHECK_NEAR(x.r.limit, 5.0, 0.0);
    begin(&x, "G2 X10 R4.996\n");           /* short by the rounding of a program: half a turn */
    CHECK_EQ(next(&x), COMMAND_CW_ARC);
    CHECK_NEAR(x.c.path.sweep, -acos(-1.0), 1e-12);
    begin(&x, "%\nG1 X1\n%\nX2");
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(next(&x), -1);                 /* the second % is the end */
    begin(&x, "G1 X0\r\nX1\r\n");
    CHECK_EQ(next(&x), COMMAND_LINE);       /* a move to where the axes stand is none */
    CHECK_EQ(x.c.line, 2);
}

int main(void)
{
    lines_and_modes();
    arcs();
    numbers();
    faults();
    long_lines();
    values();
    return check_result();
}
