/* Cutter compensation by hand and of random contours: at every sample of the way of the tool's
 * centre the contour is exactly a radius away and no part of it next to there nearer, found by
 * brute force. */
#include "gcode_reader.h"

enum { MOTIONS = 14, SAMPLES = 40 };

/* A motion of the contour as it was programmed. */
struct part {
    bool arc, ccw;
    double start[2], end[2], centre[2];
};

static uint32_t seed = 1;

static double random_between(double low, double high)
{
    seed = seed * 1664525u + 1013904223u;
    return low + (high - low) * (seed >> 8) / 16777216.0;
}

/* Nearest distance of a place to a motion. */
static double distance(const struct part *m, const double q[2])
{
    const double ends = fmin(hypot(q[0] - m->start[0], q[1] - m->start[1]),
                             hypot(q[0] - m->end[0], q[1] - m->end[1]));
    if (!m->arc) {
        const double x = m->end[0] - m->start[0], y = m->end[1] - m->start[1];
        const double l = hypot(x, y);
        const double t = ((q[0] - m->start[0]) * x + (q[1] - m->start[1]) * y) / l;
        return t > 0.0 && t < l ? fabs((q[0] - m->start[0]) * y - (q[1] - m->start[1]) * x) / l
                                : ends;
    }
    const double pi = acos(-1.0),
                 radius = hypot(m->start[0] - m->centre[0], m->start[1] - m->centre[1]);
    const double from = atan2(m->start[1] - m->centre[1], m->start[0] - m->centre[0]);
    double to = atan2(m->end[1] - m->centre[1], m->end[0] - m->centre[0]) - from;
    double at = atan2(q[1] - m->centre[1], q[0] - m->centre[0]) - from;
    to = fmod((m->ccw ? to : -to) + 4.0 * pi, 2.0 * pi);
    at = fmod((m->ccw ? at : -at) + 4.0 * pi, 2.0 * pi);
    return at < to ? fabs(hypot(q[0] - m->centre[0], q[1] - m->centre[1]) - radius) : ends;
}

/* A contour that turns as it likes, but two motions and their corner by less than half a turn, so
 * that they do not cross: from (-60, 0), motion by motion in the lines from the third on. */
static void contour(char *text, const char *code, double diameter, struct part m[MOTIONS])
{
    double x = -60.0, y = 0.0, way = 0.0, before = 0.0;

    text += sprintf(text, "G0 X-60 F600\n%s D%.3f\n", code, diameter);
    for (int i = 0; i < MOTIONS; i++) {
        const bool arc = i > 0 && random_between(0.0, 1.0) < 0.5;
        const double radius = random_between(2.0, 12.0);
        const double sweep = arc ? random_between(0.2, fmin(2.4, 3.0 - before)) : 0.0;
        const double corner = fmin(2.4, 3.1 - before - sweep);
        const double length = i ? random_between(3.0, 14.0) : 10.0;
        m[i] = (struct part){ .arc = arc, .start = { x, y } };
        if (i > 0 && random_between(0.0, 1.0) < 0.8) { /* else on without a corner */
            way += random_between(-corner, corner);
        }
        before = sweep;
        if (arc) {
            const double side = random_between(0.0, 1.0) < 0.5 ? 1.0 : -1.0;
            m[i].ccw = side > 0.0;
            m[i].centre[0] = x - side * radius * sin(way);
            m[i].centre[1] = y + side * radius * cos(way);
            way += side * sweep;
            x = m[i].centre[0] + side * radius * sin(way);
            y = m[i].centre[1] - side * radius * cos(way);
            text += sprintf(text, "G%d X%.11f Y%.11f I%.11f J%.11f\n", m[i].ccw ? 3 : 2, x, y,
                            m[i].centre[0] - m[i].start[0], m[i].centre[1] - m[i].start[1]);
        } else {
            x += length * cos(way);
            y += length * sin(way);
            text += sprintf(text, "G1 X%.11f Y%.11f Z%d\n", x, y, i % 3);
        }
        m[i].end[0] = x;
        m[i].end[1] = y;
    }
    sprintf(text, "G40 G1 X-60 Y0\n");
}

/* The way of the centre of an accepted contour; true if it is one. */
static bool driven(const char *text, const struct part m[MOTIONS], double radius)
{
    struct reader x;
    double at[2] = { -60.0, 0.0 }, worst = 0.0;

    begin(&x, text);
    while (next(&x) >= 0) {
        CHECK_NEAR(x.c.path.start[0], x.c.line == 1 ? 0.0 : at[0], 0.0);
        CHECK_NEAR(x.c.path.start[1], at[1], 0.0);
        memcpy(at, x.c.path.end, sizeof at);
        const int i = x.c.line - 3;
        const bool corner =
            i > 0 && i < MOTIONS && x.c.path.arc && /* with the one before */
            hypot(x.c.path.centre[0] - m[i].start[0], x.c.path.centre[1] - m[i].start[1]) < 1e-9;
        for (int k = 0; k <= SAMPLES && i > 0 && i < MOTIONS; k++) {
            double place[AXES], slope[AXES], least = 1e9;
            path_at(&x.c.path, x.c.path.length * k / SAMPLES, place, slope);
            for (int j = i - 1; j <= i + !corner && j < MOTIONS; j++) {
                least = fmin(least, distance(&m[j], place));
            }
            worst = fmax(worst, fabs(least - radius));
        }
    }
    const bool good = x.r.fault == FAULT_NONE;
    if (good) {
        CHECK_NEAR(worst, 0.0, 1e-9);
        if (worst > 1e-9) {
            printf("%s\n", text);
        }
    }
    return good;
}

static void contours(void)
{
    static const char codes[][6] = { "G41.1", "G42.1" };
    static char text[4096];
    struct part m[MOTIONS];
    int accepted = 0;
    const int all = 3000;

    for (int i = 0; i < all; i++) {
        const double diameter = round(random_between(100.0, 4000.0)) / 1000.0;
        contour(text, codes[i % 2], diameter, m);
        accepted += driven(text, m, 0.5 * diameter);
    }
    printf("%d of %d contours accepted\n", accepted, all);
    CHECK(accepted > all / 4 && accepted < all);
}

/* The next command leads to a point, with a type and a line. */
static void expect(struct reader *x, enum command_type type, int line, double a, double b, double c)
{
    CHECK_EQ(next(x), type);
    CHECK_EQ(x->c.line, line);
    expect_end(x, a, b, c);
}

/* A rectangle with what comes between its motions: outputs, waits, moves along Z, stops, feeds. */
static void order(void)
{
    struct reader x;
    begin(&x, "G0 X-10 Y-10\nG42.1 D4 M8 G1 X0 Y-10 F60\nX30 F120\nZ-1\nM9\nG4 P1\nM62 P3\nG0 Z5\n"
              "G1 Y20 M0 M62 P4\nX0 Y20 F30\nG40 M8 X-5\nX0 M2\n");
    expect(&x, COMMAND_PTP, 1, -10.0, -10.0, 0.0);
    expect(&x, COMMAND_OUTPUTS, 2, 0.0, 0.0, 0.0);
    expect(&x, COMMAND_LINE, 2, 0.0, -12.0, 0.0);
    expect(&x, COMMAND_LINE, 3, 30.0, -12.0, 0.0);
    CHECK_NEAR(x.c.feed, 2.0, 1e-12);
    expect(&x, COMMAND_LINE, 4, 30.0, -12.0, -1.0);
    expect(&x, COMMAND_OUTPUTS, 5, 0.0, 0.0, 0.0);
    expect(&x, COMMAND_DELAY, 6, 30.0, -12.0, -1.0);
    expect(&x, COMMAND_PTP, 8, 30.0, -12.0, 5.0);
    CHECK_EQ(x.c.set, 8);
    expect(&x, COMMAND_CCW_ARC, 9, 32.0, -10.0, 5.0);
    CHECK_EQ(x.c.set, 0);
    expect(&x, COMMAND_LINE, 9, 32.0, 20.0, 5.0);
    CHECK_EQ(x.c.set, 16);
    expect(&x, COMMAND_STOP, 9, 0.0, 0.0, 0.0);
    expect(&x, COMMAND_CCW_ARC, 10, 30.0, 22.0, 5.0);
    CHECK_NEAR(x.c.feed, 0.5, 1e-12);
    expect(&x, COMMAND_LINE, 10, 0.0, 22.0, 5.0);
    expect(&x, COMMAND_OUTPUTS, 11, 0.0, 0.0, 0.0);
    expect(&x, COMMAND_LINE, 11, -5.0, 20.0, 5.0); /* Y is where the contour ended */
    expect(&x, COMMAND_LINE, 12, 0.0, 20.0, 5.0);
    expect(&x, COMMAND_OUTPUTS, 12, 0.0, 0.0, 0.0);
    CHECK_EQ(next(&x), -1);
}

/* Inner corners, rapids, the end of a program, full circles, G18, D of the table, diameters below
 * and equal 0. */
static void cases(void)
{
    struct reader x;
    begin(&x, "G41.1 D4 G1 X20\nG0 Y20\nX0\n");
    expect(&x, COMMAND_LINE, 1, 18.0, 2.0, 0.0);
    expect(&x, COMMAND_PTP, 2, 18.0, 18.0, 0.0);
    expect(&x, COMMAND_PTP, 3, 0.0, 18.0, 0.0);
    CHECK_EQ(next(&x), -1);
    CHECK_NEAR(x.in.point[1], 18.0, 1e-12);
    begin(&x, "G41.1 D4 G0 X20\nG0 Y-20\nG1 X0\nG0 Y0\n");
    expect(&x, COMMAND_PTP, 1, 20.0, 2.0, 0.0);
    expect(&x, COMMAND_PTP, 2, 22.0, 0.0, 0.0); /* two rapids: straight about the corner */
    expect(&x, COMMAND_PTP, 2, 22.0, -20.0, 0.0);
    expect(&x, COMMAND_CW_ARC, 3, 20.0, -22.0, 0.0);
    expect(&x, COMMAND_LINE, 3, 0.0, -22.0, 0.0);
    expect(&x, COMMAND_CW_ARC, 4, -2.0, -20.0, 0.0); /* behind a feed never nearer */
    expect(&x, COMMAND_PTP, 4, -2.0, 0.0, 0.0);
    CHECK_EQ(next(&x), -1);
    begin(&x, "G42.1 D4 G1 X20\nG3 J10 P2\nG1 X30\nG40 X40 Y5\nG2 X50 R5\n");
    expect(&x, COMMAND_LINE, 1, 20.0, -2.0, 0.0);
    expect(&x, COMMAND_CCW_ARC, 2, 20.0, -2.0, 0.0);
    CHECK_NEAR(x.c.path.sweep, 4.0 * acos(-1.0), 1e-12);
    CHECK_NEAR(x.c.path.radius, 12.0, 1e-12);
    expect(&x, COMMAND_LINE, 3, 30.0, -2.0, 0.0);
    expect(&x, COMMAND_LINE, 4, 40.0, 5.0, 0.0);
    expect(&x, COMMAND_CW_ARC, 5, 50.0, 5.0, 0.0);
    begin(&x, "G18 G41.1 D4 G1 Z20\nX10\nG40 X20\n"); /* left of Z, seen against Y, is X */
    expect(&x, COMMAND_LINE, 1, 2.0, 0.0, 18.0);
    expect(&x, COMMAND_LINE, 2, 10.0, 0.0, 18.0);
    expect(&x, COMMAND_LINE, 3, 20.0, 0.0, 20.0);
    begin(&x, "G10 L1 P7 R3\nG41 D7 G1 X20\nX30\nG40 X40 Y0\nG42.1 D-6 X60\nX70\nG40 X80\n"
              "G41 D0 X90\nX100 Y10\nG40 X0\n");
    expect(&x, COMMAND_LINE, 2, 20.0, 3.0, 0.0);
    expect(&x, COMMAND_LINE, 3, 30.0, 3.0, 0.0);
    expect(&x, COMMAND_LINE, 4, 40.0, 0.0, 0.0);
    expect(&x, COMMAND_LINE, 5, 60.0, 3.0, 0.0);
    expect(&x, COMMAND_LINE, 6, 70.0, 3.0, 0.0);
    expect(&x, COMMAND_LINE, 7, 80.0, 0.0, 0.0);
    expect(&x, COMMAND_LINE, 8, 90.0, 0.0, 0.0);
    expect(&x, COMMAND_LINE, 9, 100.0, 10.0, 0.0);
    expect(&x, COMMAND_LINE, 10, 0.0, 10.0, 0.0);
    CHECK_EQ(next(&x), -1);
}

/* Behind G40 words count from the end of the contour; what has none in the plane stays aside. */
static void exits(void)
{
    struct reader x;
    begin(&x, "G41.1 D4 G1 X20\nX30\nG40 G0 Z9\nG91 X5\nY1\n");
    expect(&x, COMMAND_LINE, 1, 20.0, 2.0, 0.0);
    expect(&x, COMMAND_LINE, 2, 30.0, 2.0, 0.0);
    expect(&x, COMMAND_PTP, 3, 30.0, 2.0, 9.0);
    expect(&x, COMMAND_PTP, 4, 35.0, 0.0, 9.0);
    expect(&x, COMMAND_PTP, 5, 35.0, 1.0, 9.0);
    CHECK_EQ(next(&x), -1);
    begin(&x, "G41.1 D4 G1 X20\nX30\nG40 M8\nG91 G99 G81 X5 Z-1 R1 L2\n");
    expect(&x, COMMAND_LINE, 1, 20.0, 2.0, 0.0);
    expect(&x, COMMAND_LINE, 2, 30.0, 2.0, 0.0);
    CHECK_EQ(next(&x), COMMAND_OUTPUTS);
    expect(&x, COMMAND_PTP, 4, 30.0, 2.0, 1.0);
    expect(&x, COMMAND_PTP, 4, 35.0, 0.0, 1.0);
    expect(&x, COMMAND_LINE, 4, 35.0, 0.0, 0.0);
    expect(&x, COMMAND_PTP, 4, 35.0, 0.0, 1.0);
    expect(&x, COMMAND_PTP, 4, 40.0, 0.0, 1.0);
}

/* A plane beside G40 is the next motion's: the contour still ends square to its own. */
static void other_plane(void)
{
    struct reader x;

    begin(&x, "G41.1 D4 G1 X20\nX30\nG40 G18 X40 Z3\n");
    expect(&x, COMMAND_LINE, 1, 20.0, 2.0, 0.0);
    expect(&x, COMMAND_LINE, 2, 30.0, 2.0, 0.0);
    expect(&x, COMMAND_LINE, 3, 40.0, 0.0, 3.0);
    begin(&x, "G18 G41.1 D4 G1 Z20\nZ30\nG40 G17\nX9 Y5\n");
    expect(&x, COMMAND_LINE, 1, 2.0, 0.0, 20.0);
    expect(&x, COMMAND_LINE, 2, 2.0, 0.0, 30.0);
    expect(&x, COMMAND_LINE, 4, 9.0, 5.0, 30.0);
}

/* Concave corners: in a sharp one behind the entry the tool goes back to where both ways cross,
 * and in slight ones by their part of the radius; one that is not slight refuses that. */
static void back(void)
{
    struct reader x;
    begin(&x, "G42.1 D10 G1 X10\nX-50 Y-15\n");
    /* 5 from both lines: half the angle between them is a, tan(2 a) = 1/4 */
    const double half = 5.0 / tan(0.5 * atan(0.25));
    expect(&x, COMMAND_LINE, 1, 10.0 - half, -5.0, 0.0);
    expect(&x, COMMAND_LINE, 2, -50.0 - 5.0 / sqrt(17.0), -15.0 + 20.0 / sqrt(17.0), 0.0);
    CHECK_EQ(next(&x), -1);
    begin(&x, "G41.1 D10 G1 X10\nX20\nX20.01 Y.00008\nX30 Y.14\n");
    expect(&x, COMMAND_LINE, 1, 10.0, 5.0, 0.0);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_NEAR(x.c.path.end[0], 20.0 - 5.0 * 0.004, 1e-4);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_NEAR(x.c.path.end[0], 20.01 - 5.0 * (0.008 + 0.5 * 0.006), 1e-4);
    CHECK_NEAR(x.c.path.end[1], 4.9998, 1e-5);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_NEAR(x.c.path.end[0], 30.0 - 5.0 * 0.014, 1e-4);
    fault_is("G41.1 D10 G1 X10\nX20\nX20.01 Y.00008\nX30 Y5\n", 3, "X20.01 Y.00008",
             FAULT_CUTTER_SHORT);
    begin(&x, "G41.1 D10 G1 X10\nX20\nG3 X20.01 Y.00008 R50\nG1 X30 Y.14\n");
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(next(&x), COMMAND_LINE); /* nothing is left of the arc */
    CHECK_EQ(next(&x), COMMAND_LINE);
    CHECK_EQ(next(&x), -1);
}

/* An arc as the first motion ends in the direction of the contour; limits hold for the centre. */
static void entries(void)
{
    struct reader x;
    double at[AXES], slope[AXES];
    begin(&x, "G0 X-10 Y10\nG42.1 D4 G3 X0 Y0 I10\nG1 X20\nG40 Y10\n");
    CHECK_EQ(next(&x), COMMAND_PTP);
    expect(&x, COMMAND_CCW_ARC, 2, 0.0, -2.0, 0.0);
    path_at(&x.c.path, x.c.path.length, at, slope);
    CHECK_NEAR(slope[1], 0.0, 1e-12);
    expect(&x, COMMAND_LINE, 3, 20.0, -2.0, 0.0);
    fault_is("G0 X-10 Y10\nG42.1 D4 G3 X0 Y0 I10\nG1 Y-20\n", 3, "G1 Y-20", FAULT_CUTTER_ENTRY);
    fault_is("G0 Z699\nG18 G41.1 D4 G1 Z650 X30\nZ699.5 X10\nG40 Z700.5\n", 3, "Z699.5 X10",
             FAULT_TRAVEL);
    fault_is("G41.1 D4 G1 X20\nG1 Y10 X30\nG3 X20 Y20 R1.9\n", 3, "G3 X20 Y20 R1.9",
             FAULT_ARC_CHORD);
}

int main(void)
{
    order();
    cases();
    exits();
    other_plane();
    back();
    entries();
    contours();
    return check_result();
}
