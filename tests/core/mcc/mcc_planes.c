/* Arcs and circles of the three planes: radius, direction, axes that stand, where they end. */
#include "mcc_chain.h"

enum { XY, YZ, ZX };
static const int FIRST[3] = { 0, 1, 2 }, SECOND[3] = { 1, 2, 0 };

/* Every point lies on the circle about (0, centre) of the plane; the third axis stands. Returns the
 * angle swept, counter-clockwise positive [rad]. */
static double sweep(int plane, double centre)
{
    struct record r = { 0 };
    double swept = 0.0, before = atan2(-centre, 0.0);
    while (r.n < LONGEST && point(&r)) {
        const double a = r.last.place[FIRST[plane]], b = r.last.place[SECOND[plane]] - centre;
        const double angle = atan2(b, a);
        CHECK_NEAR(hypot(a, b), fabs(centre), 1e-9);
        CHECK(r.last.place[3 - FIRST[plane] - SECOND[plane]] == 0.0);
        swept += remainder(angle - before, 2.0 * acos(-1.0));
        before = angle;
    }
    return swept;
}

/* From the origin about (0, 5) through (5, 5) or (-5, 5) to (0, 10): half a turn. */
static void arcs(void)
{
    static int (*const arc[])(struct mcc *, double, double, double,
                              double) = { MCC_arc_xy, MCC_arc_yz, MCC_arc_zx };
    for (int k = 0; k < 6; k++) {
        const int plane = k / 2;
        const double side = k % 2 ? 1.0 : -1.0;
        begin(mcc_machine());
        CHECK_EQ(arc[plane](&m, 5.0 * side, 5.0, 0.0, 10.0), 1);
        CHECK_NEAR(sweep(plane, 5.0), side * acos(-1.0), 1e-9);
        CHECK_NEAR(m.trajectory.rest[SECOND[plane]], 10.0, 1e-12);
    }
}

static void circles(void)
{
    static int (*const circle[])(struct mcc *, double, double,
                                 int) = { MCC_circle_xy, MCC_circle_yz, MCC_circle_zx };
    for (int k = 0; k < 6; k++) {
        const int plane = k / 2;
        begin(mcc_machine());
        CHECK_EQ(circle[plane](&m, 0.0, -3.0, k % 2), 1);
        CHECK_NEAR(sweep(plane, -3.0), (k % 2 ? 2.0 : -2.0) * acos(-1.0), 1e-9);
        CHECK(m.trajectory.rest[0] == 0.0 && m.trajectory.rest[1] == 0.0
              && m.trajectory.rest[2] == 0.0);
    }
}

/* One of the twelve calls: p is via and end of an arc, or the centre of a circle. */
static int turn(int plane, bool circle, bool follow, const double p[4], bool ccw)
{
    static int (*const arc[])(struct mcc *, double, double, double,
                              double) = { MCC_arc_xy, MCC_arc_yz, MCC_arc_zx };
    static int (*const arc_uvw[])(struct mcc *, const double[4],
                                  const double[3]) = { MCC_arc_xyuvw, MCC_arc_yzuvw,
                                                       MCC_arc_zxuvw };
    static int (*const round[])(struct mcc *, double, double, int) = { MCC_circle_xy, MCC_circle_yz,
                                                                       MCC_circle_zx };
    static int (*const round_uvw[])(struct mcc *, const double[2], int,
                                    const double[3]) = { MCC_circle_xyuvw, MCC_circle_yzuvw,
                                                         MCC_circle_zxuvw };
    const double uvw[3] = { 3.0, -6.0, 1.5 };
    return circle && follow ? round_uvw[plane](&m, p, ccw, uvw)
           : circle         ? round[plane](&m, p[0], p[1], ccw)
           : follow         ? arc_uvw[plane](&m, p, uvw)
                            : arc[plane](&m, p[0], p[1], p[2], p[3]);
}

/* A place on the circle about `centre` from 0, turned so far. */
static void turned(const double centre[2], double angle, double place[2])
{
    place[0] = centre[0] - cos(angle) * centre[0] + sin(angle) * centre[1];
    place[1] = centre[1] - sin(angle) * centre[0] - cos(angle) * centre[1];
}

/* Where the summed pulses of all axes have been. [mm] */
struct carried {
    int n;
    double place[LONGEST][AXES], way[LONGEST];
};

static struct carried tool; /* not on the stack */

static void watch_tool(struct record *r)
{
    tool.n = 0;
    while (tool.n < LONGEST && point(r)) {
        double *place = tool.place[tool.n], *before = tool.n ? tool.place[tool.n - 1] : place;
        for (int i = 0; i < AXES; i++) {
            place[i] = r->last.pulses[i] / 1000.0;
        }
        tool.way[tool.n] =
            (tool.n ? tool.way[tool.n - 1] : 0.0)
            + norm3((double[]){ place[0] - before[0], place[1] - before[1], place[2] - before[2] });
        tool.n++;
    }
}

/* After a quarter and half of its way the tool is where plane, centre and sense say, from any place
 * and with either kind of coordinates; the third axis stands, U V W have gone the same part. */
static void half_way(int plane, bool circle, bool follow, bool ccw, bool incremental)
{
    const double pi = acos(-1.0), from[3] = { 1.0, -2.0, 0.5 }, centre[2] = { 3.0, 4.0 };
    const double whole = (ccw ? 1.0 : -1.0) * (circle ? 2.0 : 1.3) * pi;
    const int a = FIRST[plane], b = SECOND[plane], c = 3 - a - b;
    struct machine machine = mcc_machine();
    struct record r = { 0 };
    double p[4] = { centre[0], centre[1] };

    machine.axis[3].used = machine.axis[4].used = machine.axis[5].used = true;
    begin(machine);
    CHECK_EQ(MCC_line(&m, (double[AXES]){ from[0], from[1], from[2] }), 1);
    run(&r);
    if (!circle) {
        turned(centre, 0.3 * whole, p);
        turned(centre, whole, p + 2);
    }
    for (int i = 0; i < 4; i++) {
        p[i] += incremental ? 0.0 : from[i % 2 ? b : a];
    }
    CHECK_EQ(incremental ? MCC_set_inc(&m) : MCC_set_abs(&m), MCC_NO_ERR);
    CHECK_EQ(MCC_set_fspd(&m, 50.0), MCC_NO_ERR);
    CHECK_EQ(turn(plane, circle, follow, p, ccw), 2);
    watch_tool(&r);
    for (int quarter = 1; quarter <= 2; quarter++) {
        const double part = 0.25 * quarter, near = 0.06; /* a point's way is 0.05 mm */
        double want[2];
        int k = 0;
        while (k < tool.n - 1 && tool.way[k] < part * tool.way[tool.n - 1]) {
            k++;
        }
        turned(centre, part * whole, want);
        CHECK_NEAR(tool.place[k][a], from[a] + want[0], near);
        CHECK_NEAR(tool.place[k][b], from[b] + want[1], near);
        CHECK_NEAR(tool.place[k][c], from[c], 0.0);
        CHECK_NEAR(tool.place[k][3], follow ? 3.0 * part : 0.0, near);
        CHECK_NEAR(tool.place[k][4], follow ? -6.0 * part : 0.0, near);
        CHECK_NEAR(tool.place[k][5], follow ? 1.5 * part : 0.0, near);
    }
    CHECK_NEAR(tool.way[tool.n - 1], 5.0 * fabs(whole), 0.02 * 5.0 * fabs(whole));
}

static void all_twelve(void)
{
    for (int k = 0; k < 48; k++) {
        half_way(k % 3, k / 3 % 2, k / 6 % 2, k / 12 % 2, k / 24);
    }
}

/* One line is one axis. */
static void single_axes(void)
{
    static int (*const line[])(struct mcc *, double) = { MCC_line_x, MCC_line_y, MCC_line_z };
    for (int i = 0; i < 3; i++) {
        struct record r = { 0 };
        begin(mcc_machine());
        CHECK_EQ(line[i](&m, 2.0), 1);
        run(&r);
        for (int k = 0; k < 3; k++) {
            CHECK_EQ(r.sum[k], k == i ? 2000 : 0);
        }
    }
}

int main(void)
{
    arcs();
    circles();
    all_twelve();
    single_axes();
    return check_result();
}
