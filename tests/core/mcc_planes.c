/* Arcs and circles of the three planes: radius, direction, axes that stand, where they end. */
#include "mcc_record.h"

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
    static int (*const arc[])(struct mcc *, double, double, double, double) = {
        MCC_arc_xy, MCC_arc_yz, MCC_arc_zx
    };
    for (int k = 0; k < 6; k++) {
        const int plane = k / 2;
        const double side = k % 2 ? 1.0 : -1.0;
        begin(mcc_machine());
        CHECK_EQ(arc[plane](&m, 5.0 * side, 5.0, 0.0, 10.0), 1);
        CHECK_NEAR(sweep(plane, 5.0), side * acos(-1.0), 1e-9);
        CHECK_NEAR(m.ipo.rest[SECOND[plane]], 10.0, 1e-12);
    }
}

static void circles(void)
{
    static int (*const circle[])(struct mcc *, double, double, int) = {
        MCC_circle_xy, MCC_circle_yz, MCC_circle_zx
    };
    for (int k = 0; k < 6; k++) {
        const int plane = k / 2;
        begin(mcc_machine());
        CHECK_EQ(circle[plane](&m, 0.0, -3.0, k % 2), 1);
        CHECK_NEAR(sweep(plane, -3.0), (k % 2 ? 2.0 : -2.0) * acos(-1.0), 1e-9);
        CHECK(m.ipo.rest[0] == 0.0 && m.ipo.rest[1] == 0.0 && m.ipo.rest[2] == 0.0);
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
    single_axes();
    return check_result();
}
