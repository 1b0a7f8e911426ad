/* Coordinate systems, scaling, rotation, polar words: places worked out by hand. */
#include "gcode_reader.h"
#include "offsets.h"

static void expect_move(struct reader *x, enum command_type type, double a, double b, double c)
{
    CHECK_EQ(next(x), type);
    CHECK_NEAR(x->c.path.end[0], a, 1e-9);
    CHECK_NEAR(x->c.path.end[1], b, 1e-9);
    CHECK_NEAR(x->c.path.end[2], c, 1e-9);
}

static void expect_line(struct reader *x, double a, double b, double c)
{
    expect_move(x, COMMAND_LINE, a, b, c);
}

static void systems(void)
{
    struct reader x;
    begin(&x, "G10 L2 P7 X7\nG10 L2 P8 X8\nG10 L2 P9 X9\nG59.1 G1 X0 Y1\nG59.2 X0\nG59.3 X0\n"
              "G10 L20 P0 X5 Y4\nX0 Y0\nG10 L20 P2 X-1\nG55 X0\nG92 X3\nG10 L20 P2 X10\nX0\n");
    expect_line(&x, 7.0, 1.0, 0.0);
    expect_line(&x, 8.0, 1.0, 0.0);
    expect_line(&x, 9.0, 1.0, 0.0);
    expect_line(&x, 4.0, -3.0, 0.0);  /* 9 1 is X5 Y4 */
    expect_line(&x, 5.0, -3.0, 0.0);  /* 4 is X-1 of G55 */
    expect_line(&x, -5.0, -3.0, 0.0); /* 5 is X10 there, beside the shift */
    CHECK_EQ(next(&x), -1);
}

/* R of G10 L2 turns a system about its origin; G92 shifts along its axes. */
static void turned_system(void)
{
    struct reader x;
    begin(&x, "G10 L2 P1 X10 Y20 R90\nG1 X5 Y0\nY2\nG91 X1\nG90 G92 X0\nX3\nG53 X1\nX0\nG92.1\n"
              "G10 L2 P1 R30\nX10 Y0\nG2 X0 Y10 I-10 J0\nG10 L20 P1 X1 Y0\nG1 X0\n");
    expect_line(&x, 10.0, 25.0, 0.0);
    expect_line(&x, 8.0, 25.0, 0.0);
    expect_line(&x, 8.0, 26.0, 0.0);
    expect_line(&x, 8.0, 29.0, 0.0);
    expect_line(&x, 1.0, 29.0, 0.0);
    expect_line(&x, 1.0, 26.0, 0.0); /* Y is still what G53 made of it */
    const double c = 0.5 * sqrt(3.0);
    expect_line(&x, 10.0 + 10.0 * c, 25.0, 0.0);
    expect_move(&x, COMMAND_CW_ARC, 10.0 - 5.0, 20.0 + 10.0 * c, 0.0);
    CHECK_NEAR(x.c.path.centre[0], 10.0, 1e-9);
    CHECK_NEAR(x.c.path.centre[1], 20.0, 1e-9);
    CHECK_NEAR(x.c.path.sweep, -1.5 * acos(-1.0), 1e-9);
    expect_line(&x, 5.0 - c, 20.0 + 10.0 * c - 0.5, 0.0); /* one back along the turned X */
    CHECK_EQ(next(&x), -1);
}

static void parking(void)
{
    struct reader x;
    begin(&x, "G1 X10 Y20 Z30\nG28.1\nX1\nG30.1\nX2 Y2 Z2\nG28\nG55 G30 Z0\nG91 G28 Y0\n");
    expect_line(&x, 10.0, 20.0, 30.0);
    expect_line(&x, 1.0, 20.0, 30.0);
    expect_line(&x, 2.0, 2.0, 2.0);
    expect_move(&x, COMMAND_PTP, 10.0, 20.0, 30.0);
    expect_move(&x, COMMAND_PTP, 10.0, 20.0, 1.0); /* Z0 of G55, whose origin has Z 1 */
    expect_move(&x, COMMAND_PTP, 10.0, 20.0, 30.0);
    CHECK_EQ(next(&x), -1); /* there already */
    double value;
    CHECK(offsets_parameter(&x.in, &x.program, 5162, &value) && value == 20.0);
    CHECK(offsets_parameter(&x.in, &x.program, 5181, &value) && value == 1.0);
    CHECK(offsets_parameter(&x.in, &x.program, 5220, &value) && value == 2.0);
    CHECK(offsets_parameter(&x.in, &x.program, 5242, &value) && value == 10.0);
    CHECK(offsets_parameter(&x.in, &x.program, 5250, &value) && value == 0.0);
    x.program.angles = true;
    CHECK(offsets_parameter(&x.in, &x.program, 5247, &value) && value == 0.0);
    x.program.angles = false;
    CHECK(!offsets_parameter(&x.in, &x.program, 5231, &value));
    CHECK(!offsets_parameter(&x.in, &x.program, 5401, &value));
}

/* Factors about a centre, mirrored ones too; arcs turn the other way round in a mirror. */
static void scaling(void)
{
    struct reader x;
    begin(&x, "G1 X2 Y2\nG51 X10 Y0 P3\nX12 Y1\nG91 X1\nG90 G3 X14 Y1 R1.5 Z1\nG50 G1 X0 Y0 Z0\n"
              "G51 X5 I-1 J1\nX0 Y1\nG2 X1 Y2 I1 J0\nG53 G1 X0\nG50\nG51 P2\nX2\nG51 I2 J3\nY1\n");
    expect_line(&x, 2.0, 2.0, 0.0);
    expect_line(&x, 16.0, 3.0, 0.0); /* 10 + 3 2, 3 1 */
    expect_line(&x, 19.0, 3.0, 0.0);
    expect_move(&x, COMMAND_CCW_HELIX, 22.0, 3.0, 3.0);
    CHECK_NEAR(x.c.path.radius, 4.5, 1e-9);
    expect_line(&x, 0.0, 0.0, 0.0);
    expect_line(&x, 10.0, 1.0, 0.0); /* 0 mirrored about 5 */
    expect_move(&x, COMMAND_CCW_ARC, 9.0, 2.0, 0.0);
    CHECK_NEAR(x.c.path.centre[0], 9.0, 1e-9);
    CHECK_NEAR(x.c.path.sweep, 0.5 * acos(-1.0), 1e-9);
    expect_line(&x, 0.0, 2.0, 0.0);  /* the machine is not scaled */
    expect_line(&x, 4.0, 2.0, 0.0);  /* about where the tool is: 0 2 */
    expect_line(&x, 4.0, -1.0, 0.0); /* Y about its program coordinate, 2: 2 + 3 (1 - 2) */
    CHECK_EQ(next(&x), -1);
}

/* Scaling first, then rotation, whose centre is scaled, then the system. */
static void rotation(void)
{
    struct reader x;
    begin(&x, "G68 X1 Y0 R90\nG1 X3 Y0\nX4\nG91 Y1\nG90 G3 X5 Y1 I0.5 J0\nG69 G1 X0 Y0\n"
              "G68 R-90\nX1\nG69 X0 Y0\nG55\nG51 P2 X0 Y0 Z0\nG68 X1 Y1 R90\nX2 Y1 Z1\nG28 X2\n");
    expect_line(&x, 1.0, 2.0, 0.0);
    expect_line(&x, 1.0, 3.0, 0.0);
    expect_line(&x, 0.0, 3.0, 0.0);
    expect_move(&x, COMMAND_CCW_ARC, 0.0, 4.0, 0.0);
    CHECK_NEAR(x.c.path.centre[0], 0.0, 1e-9);
    CHECK_NEAR(x.c.path.centre[1], 3.5, 1e-9);
    expect_line(&x, 0.0, 0.0, 0.0);
    expect_line(&x, 0.0, -1.0, 0.0); /* about where the tool is */
    expect_line(&x, 0.0, 0.0, 0.0);
    expect_line(&x, 102.0, 14.0, 3.0); /* 4 2 about 2 2: 2 4; then G55 */
    CHECK_EQ(next(&x), COMMAND_PTP);   /* through X2: there already; home is the machine's */
    CHECK_NEAR(x.c.path.end[0], 0.0, 1e-12);
    CHECK_NEAR(x.c.path.end[1], 14.0, 1e-9);
    CHECK_EQ(next(&x), -1);
    begin(&x, "G18 G68 Z0 X1 R90\nG1 Z1 X1 Y3\n");
    expect_line(&x, 2.0, 3.0, 0.0); /* ZX: Z turns towards X */
    CHECK_EQ(next(&x), -1);
}

static void polar(void)
{
    const double c = 0.5 * sqrt(3.0);
    struct reader x;
    begin(&x, "G16 G1 X100 Y30\nG91 Y120\nY120\nG15 G90 X0 Y5\nG16 X10 Y0 Z2\nG91 X5 Y90\n"
              "G90 G52 X1\nX10\nG53 X3 Y4\nG15 G52 X0 X1 Y1\n");
    expect_line(&x, 100.0 * c, 50.0, 0.0); /* absolute radius, then angles added: Fanuc's circle */
    expect_line(&x, -100.0 * c, 50.0, 0.0);
    expect_line(&x, 0.0, -100.0, 0.0);
    expect_line(&x, 0.0, 5.0, 0.0);
    expect_line(&x, 10.0, 0.0, 2.0);
    expect_line(&x, 10.0, 5.0, 2.0); /* 5 mm from where the tool is, at 90 degrees */
    expect_line(&x, 1.0, 10.0, 2.0); /* the pole is the program's zero; the angle stays */
    expect_line(&x, 3.0, 4.0, 2.0);
    CHECK_EQ(next(&x), -2); /* X twice */
    begin(&x, "G1 @10 ^30\n^90 Z1\n@20\nG91 ^90\n@-10 G90 G55 G20 G92 Y0\nG0 @1 ^0\n");
    expect_line(&x, 10.0 * c, 5.0, 0.0);
    expect_line(&x, 0.0, 10.0, 1.0);
    expect_line(&x, 0.0, 20.0, 1.0);
    expect_line(&x, -20.0, 0.0, 1.0);
    CHECK_EQ(next(&x), -2); /* @ with G92 */
    begin(&x, "G20 G1 Y1\nG91 @1 ^90\n");
    expect_line(&x, 0.0, 25.4, 0.0);
    expect_line(&x, -50.8, 0.0, 0.0);
    CHECK_EQ(next(&x), -1);
}

/* The cutter stays on its side of the part in a mirror, so on the other of its way. */
static void mirrored_cutter(void)
{
    struct reader x;
    begin(&x, "G51 X0 Y0 I-1 J1\nG41.1 D2 G1 X10 Y0 F600\nX20\nX30\nG40 X40 Y5\n");
    expect_line(&x, -10.0, 1.0, 0.0);
    expect_line(&x, -20.0, 1.0, 0.0);
    expect_line(&x, -30.0, 1.0, 0.0);
    expect_line(&x, -40.0, 5.0, 0.0);
    CHECK_EQ(next(&x), -1);
}

/* The points a quarter on and half way of control points that are known. */
static void splines(void)
{
    struct reader x;
    begin(&x, "G1 X1 Y1 F600\nG5 X9 Y1 I0 J4 P0 Q4\nX17 Y1 P0 Q-4\nG20 G91 G5.1 X1 Y0 I.5 J.5\n"
              "G21 G90 G55 G51 P2 X0 Y0 Z0\nG68 X0 Y0 R90\nG5 X-10 Y5 I1 J0 P0 Q2\nX9 Y9\n");
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(next(&x), COMMAND_CUBIC);
    expect_end(&x, 9.0, 1.0, 0.0);
    CHECK_NEAR(x.c.path.bezier.inner[0][1], 5.0, 1e-12);
    CHECK_NEAR(x.c.path.bezier.inner[1][0], 9.0, 1e-12);
    CHECK_NEAR(x.c.path.bezier.inner[1][1], 5.0, 1e-12);
    double at[AXES], slope[AXES];
    path_at(&x.c.path, 0.5 * x.c.path.length, at, slope);
    CHECK_NEAR(at[0], 5.0, 1e-9);
    CHECK_NEAR(at[1], 4.0, 1e-9);
    CHECK_EQ(next(&x), COMMAND_CUBIC); /* goes on straight: away from Q4 */
    CHECK_NEAR(x.c.path.bezier.inner[0][0], 9.0, 1e-12);
    CHECK_NEAR(x.c.path.bezier.inner[0][1], -3.0, 1e-12);
    CHECK_NEAR(x.c.path.bezier.inner[1][1], -3.0, 1e-12);
    CHECK_EQ(next(&x), COMMAND_CUBIC);
    CHECK_NEAR(x.c.path.end[0], 42.4, 1e-12);
    path_at(&x.c.path, 0.5 * x.c.path.length, at, slope);
    CHECK_NEAR(at[0], 29.7, 1e-9);
    CHECK_NEAR(at[1], 1.0 + 0.25 * 25.4, 1e-9);
    CHECK_EQ(next(&x), COMMAND_CUBIC); /* doubled, then a quarter turn */
    expect_end(&x, 90.0, -10.0, 0.0);
    CHECK_NEAR(x.c.path.bezier.inner[0][0], 42.4, 1e-12);
    CHECK_NEAR(x.c.path.bezier.inner[0][1], 3.0, 1e-12);
    CHECK_NEAR(x.c.path.bezier.inner[1][0], 86.0, 1e-12);
    CHECK_EQ(next(&x), -2);
    CHECK_EQ(x.r.fault, FAULT_SPLINE);
    begin(&x, "G64 P0.1 G5.1 X5 I1 J3\nG1 X9\n");
    CHECK_EQ(next(&x), COMMAND_CUBIC);
    CHECK(x.c.tolerance == 0.1 && x.c.curve);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK(x.c.curve);
}

/* G93: F is one over the time of the motion; G95: of a turn. */
static void feeds(void)
{
    struct reader x;
    begin(&x, "G93 G1 X30 F60\nG3 X30 Y20 J10 F30\nF7\nG0 X0\nG94 F600 G1 X1\nG95 F0.5 M3 S120 X2\n"
              "S240 X3\nM4 G20 F.1 X4\nG21 G95 X5\nG94 F1 X6\n");
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_NEAR(x.c.feed, 30.0, 1e-12);
    CHECK_EQ(next(&x), COMMAND_CCW_ARC);
    CHECK_NEAR(x.c.feed, 5.0 * acos(-1.0), 1e-9);
    CHECK_EQ(next(&x), COMMAND_PTP);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_NEAR(x.c.feed, 10.0, 1e-12);
    CHECK_EQ(next(&x), COMMAND_OUTPUTS);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_NEAR(x.c.feed, 1.0, 1e-12);
    CHECK_EQ(next(&x), COMMAND_OUTPUTS);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_NEAR(x.c.feed, 2.0, 1e-12);
    CHECK_EQ(next(&x), COMMAND_OUTPUTS);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_NEAR(x.c.feed, 2.54 * 4.0, 1e-12);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_NEAR(x.c.feed, 2.54 * 4.0, 1e-12);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_NEAR(x.c.feed, 1.0 / 60.0, 1e-12);
    CHECK_EQ(next(&x), -1);
}

int main(void)
{
    systems();
    turned_system();
    parking();
    scaling();
    rotation();
    polar();
    mirrored_cutter();
    splines();
    feeds();
    return check_result();
}
