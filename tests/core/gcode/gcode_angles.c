/* A B C in the places of U V W: letters, units, offsets, and who refuses which. */
#include "gcode_reader.h"

static void turned(struct reader *x, const char *text)
{
    begin(x, text);
    x->program.angles = true;
    for (int i = 3; i < AXES; i++) {
        x->program.machine.axis[i] = true;
        x->program.machine.joint[i] = (struct joint){ .used = true, .scale = 1.0, .speed = 1e9 };
    }
}

static void expect(struct reader *x, const double end[AXES])
{
    CHECK(next(x) >= 0);
    for (int i = 0; i < AXES; i++) {
        CHECK_NEAR(x->c.path.end[i], end[i], 1e-9);
    }
}

/* Degrees in G20, too; G91 adds them; G92 and G10 shift them. */
static void meaning(void)
{
    struct reader x;
    turned(&x, "G1 X10 A10 B20 C30 F600\nG20 X1 A-5\nG91 A1 B1 C1\nG90 G21 G92 A100\nA101\n"
               "G92.1\nG10 L2 P1 A7 X1\nX0 A0 B0 C0\nG20\nG10 L2 P1 C3 X1\nX0 C0\n");
    expect(&x, (double[]){ 10, 0, 0, 10, 20, 30 });
    expect(&x, (double[]){ 25.4, 0, 0, -5, 20, 30 });
    expect(&x, (double[]){ 25.4, 0, 0, -4, 21, 31 });
    expect(&x, (double[]){ 25.4, 0, 0, -3, 21, 31 });
    expect(&x, (double[]){ 1, 0, 0, 7, 0, 0 });
    expect(&x, (double[]){ 25.4, 0, 0, 7, 0, 3 });
    CHECK_EQ(next(&x), -1);
}

/* A move of angles alone is as long as they are; an arc may turn the tool on its way. */
static void lengths(void)
{
    struct reader x;
    turned(&x, "G1 A30 B40 F600\nG2 X10 Y10 I10 J0 C90\n");
    CHECK(next(&x) >= 0);
    CHECK_NEAR(x.c.path.length, 50.0, 1e-12);
    CHECK_NEAR(x.c.feed, 10.0, 1e-12);
    CHECK(next(&x) >= 0);
    CHECK_NEAR(x.c.path.length, 10.0 * 1.5707963267948966, 1e-9);
    CHECK_NEAR(x.c.path.end[5], 90.0, 1e-12);
}

/* The first fault, of a program with angles or of one without. */
static void refused(bool angles, const char *text, int line, const char *at, enum fault fault)
{
    struct reader x;
    struct fault_report r;
    turned(&x, text);
    x.program.angles = angles;
    interpreter_check(&x.in, &x.program, &r);
    CHECK_EQ(r.fault, fault);
    CHECK_EQ(r.line, line);
    CHECK_EQ(r.length, strlen(at));
    CHECK(!memcmp(text + r.offset + r.at, at, strlen(at)));
}

/* A0, B0, C0 without angles: a note, once; an axis that is not there does not move others. */
static void at_rest(void)
{
    struct fault_list all;
    struct reader x;
    turned(&x, "G0 X5 Y6 A0. B0\nG91 G28 A0\nG92 C0\nG90 G1 X7 A0 F60\nG28 X7 A0\n");
    x.program.angles = false;
    interpreter_check_all(&x.in, &x.program, &all);
    CHECK_EQ(all.count, 0);
    CHECK(all.notes == 1 && all.note[0].fault == FAULT_NOTE_ANGLE && all.note[0].line == 1);
    CHECK_EQ(next(&x), COMMAND_PTP);
    expect_end(&x, 5.0, 6.0, 0.0);
    CHECK_EQ(next(&x), COMMAND_LINE);
    expect_end(&x, 7.0, 6.0, 0.0);
    CHECK_EQ(next(&x), COMMAND_PTP);
    expect_end(&x, 0.0, 6.0, 0.0);
    CHECK_EQ(next(&x), -1);
}

/* All nine letters at once: those of the machine move, the others may stand at 0. */
static void nine(void)
{
    struct fault_list all;
    struct reader x;
    turned(&x, "G0 X1 Y2 Z3 A4 B5 C6 U0 V0 W0\nG1 X2 W0 F60\n");
    interpreter_check_all(&x.in, &x.program, &all);
    CHECK_EQ(all.count, 0);
    CHECK(all.notes == 1 && all.note[0].fault == FAULT_NOTE_SIDE && all.note[0].line == 1);
    CHECK_EQ(next(&x), COMMAND_PTP);
    expect_end(&x, 1.0, 2.0, 3.0);
    CHECK_NEAR(x.c.path.end[5], 6.0, 0.0);
    CHECK_EQ(next(&x), COMMAND_LINE);
    x.program.angles = false;
    turned(&x, "G0 X1 Y2 Z3 U4 V5 W6 A0 B0 C0\n");
    x.program.angles = false;
    CHECK_EQ(next(&x), COMMAND_PTP);
    CHECK_NEAR(x.c.path.end[5], 6.0, 0.0);
}

int main(void)
{
    meaning();
    lengths();
    refused(true, "G1 X1 F600\nU5\n", 2, "U5", FAULT_SIDE);
    refused(true, "G1 V5 F600\n", 1, "V5", FAULT_SIDE);
    refused(true, "G1 W5 F600\n", 1, "W5", FAULT_SIDE);
    refused(false, "G1 X1 F600\nA5\n", 2, "A5", FAULT_ANGLE);
    refused(false, "G1 B5 F600\n", 1, "B5", FAULT_ANGLE);
    refused(false, "G1 C5 F600\n", 1, "C5", FAULT_ANGLE);
    refused(false, "G1 X5 C0 C0 F600\n", 1, "C0", FAULT_TWICE);
    at_rest();
    nine();
    refused(true, "G1 A1 B2 A3 F600\n", 1, "A3", FAULT_TWICE);
    refused(true, "G1 C1 C1 F600\n", 1, "C1", FAULT_TWICE);
    refused(true, "G1 D1 F600\n", 1, "D1", FAULT_UNUSED);
    refused(true, "A5\n", 1, "A5", FAULT_NO_MOTION);
    refused(true, "G28.1 A5\n", 1, "A5", FAULT_NO_MOTION);
    return check_result();
}
