/* Arcs and circles with U V W following, point-to-point of some axes: the points that come out. */
#include "mcc_check.h"
#include "task.h"

static struct mcc m;

static void open_six(void)
{
    struct machine machine = mcc_machine();
    for (int i = 3; i < AXES; i++) {
        machine.axis[i].used = true;
    }
    CHECK_EQ(MCC_init_motion(&m, &machine), MCC_NO_ERR);
    CHECK_EQ(MCC_set_fspd(&m, 50.0), MCC_NO_ERR);
}

/* Let everything run; the largest deviation of a point from the given circle and of U from its
 * share of the angle is put out. Positions in mm from the summed pulses. */
static int run(double place[AXES], double centre_x, double centre_y, double radius, double *off,
               double *out_of_step)
{
    int32_t sum[AXES];
    int points = 0;
    const double start = atan2(place[1] - centre_y, place[0] - centre_x), u = place[3];

    MCC_get_ppos(&m, sum);
    *off = *out_of_step = 0.0;
    while (!MCC_check_stop(&m)) {
        task_run(&m, NULL);
        while (m.queue.count > 0) {
            m.written = *queue_peek(&m.queue, 0);
            queue_drop(&m.queue, 1);
            for (int i = 0; i < AXES; i++) {
                sum[i] += m.written.frame[i];
                place[i] = sum[i] / 1000.0;
            }
            const double x = place[0] - centre_x, y = place[1] - centre_y;
            double turned = atan2(y, x) - start;
            turned += turned < -1e-9 ? 2.0 * acos(-1.0) : 0.0;
            *off = fmax(*off, fabs(hypot(x, y) - radius));
            if (turned > 0.1 && turned < 6.0) { /* U: 3 mm for a full turn */
                *out_of_step =
                    fmax(*out_of_step, fabs(place[3] - u - 3.0 * turned / (2.0 * acos(-1.0))));
            }
            points++;
        }
    }
    return points;
}

static void circle_with_followers(void)
{
    double place[AXES] = { 0.0 }, off, out_of_step;

    open_six();
    CHECK_EQ(MCC_circle_xyuvw(&m, (double[]){ -10.0, 0.0 }, 1, (double[]){ 3.0, -6.0, 1.5 }), 1);
    CHECK(run(place, -10.0, 0.0, 10.0, &off, &out_of_step) > 1000);
    CHECK_NEAR(off, 0.0, 1e-3); /* half a pulse in X and Y */
    CHECK_NEAR(out_of_step, 0.0, 1e-3);
    CHECK_NEAR(place[0], 0.0, 1e-9);
    CHECK_NEAR(place[3], 3.0, 1e-9);
    CHECK_NEAR(place[4], -6.0, 1e-9);
    CHECK_NEAR(place[5], 1.5, 1e-9);
}

/* The same in the other planes, incremental, and an arc: ends and lengths. */
static void planes(void)
{
    const double pi = acos(-1.0), uvw[3] = { 1.0, 2.0, 3.0 };
    double place[AXES] = { 0.0 }, off, out;

    open_six();
    CHECK_EQ(MCC_set_inc(&m), 0);
    CHECK_EQ(MCC_circle_yzuvw(&m, (double[]){ 5.0, 0.0 }, 0, uvw), 1);
    CHECK_EQ(MCC_circle_zxuvw(&m, (double[]){ 5.0, 0.0 }, 1, uvw), 2);
    CHECK_EQ(MCC_arc_xyuvw(&m, (double[]){ 1.0, 1.0, 2.0, 0.0 }, uvw), 3);
    CHECK_EQ(MCC_arc_yzuvw(&m, (double[]){ 1.0, 1.0, 2.0, 0.0 }, uvw), 4);
    CHECK_EQ(MCC_arc_zxuvw(&m, (double[]){ 1.0, 1.0, 2.0, 0.0 }, uvw), 5);
    for (int i = 0; i < 2; i++) {
        CHECK_NEAR(m.ring.entry[i].command.path.length, 10.0 * pi, 1e-9);
    }
    for (int i = 2; i < 5; i++) {
        CHECK_NEAR(m.ring.entry[i].command.path.length, pi, 1e-9);
    }
    run(place, 0.0, 0.0, 1.0, &off, &out);
    const double want[AXES] = { 2.0, 2.0, 2.0, 5.0, 10.0, 15.0 };
    for (int i = 0; i < AXES; i++) {
        CHECK_NEAR(place[i], want[i], 1e-9);
    }
}

/* A follower that had to go too fast limits the feed; one that is not used is refused. */
static void refusals(void)
{
    struct machine machine = mcc_machine();
    const double centre[2] = { 1.0, 0.0 };

    open_six();
    CHECK_EQ(MCC_circle_xyuvw(&m, centre, 1, (double[]){ 100.0, 0.0, 0.0 }), MCC_FEED_RATE);
    CHECK_EQ(MCC_circle_xyuvw(&m, centre, 1, (double[]){ NAN, 0.0, 0.0 }), MCC_PARAMETER);
    CHECK_EQ(MCC_circle_xyuvw(&m, centre, 2, (double[]){ 0.0, 0.0, 0.0 }), MCC_PARAMETER);
    CHECK_EQ(MCC_init_motion(&m, &machine), MCC_NO_ERR);
    CHECK_EQ(MCC_circle_xyuvw(&m, centre, 1, (double[]){ 0.0, 0.0, 1.0 }), MCC_PARAMETER);
    CHECK_EQ(MCC_ptp_uvw(&m, 0.0, 0.0, 1.0), MCC_PARAMETER);
    CHECK_EQ(m.ring.count, 0);
    CHECK_EQ(MCC_circle_xyuvw(&m, centre, 1, (double[]){ 0.0, 0.0, 0.0 }), 1);
}

/* Only the named axes move; the slowest goes at its share of the safe speed. */
static void point_to_point(void)
{
    open_six();
    CHECK_EQ(MCC_set_ptp_spd(&m, 0.0), MCC_FEED_RATE);
    CHECK_EQ(MCC_set_ptp_spd(&m, 100.1), MCC_FEED_RATE);
    CHECK_EQ(MCC_set_ptp_spd(&m, 40.0), MCC_NO_ERR);
    CHECK_EQ(MCC_ptp_x(&m, 10.0), 1);
    CHECK_EQ(MCC_ptp_y(&m, -20.0), 2);
    CHECK_EQ(MCC_ptp_z(&m, 30.0), 3);
    CHECK_EQ(MCC_ptp_uvw(&m, 1.0, 2.0, -4.0), 4);
    for (int i = 0; i < 3; i++) {
        CHECK_NEAR(m.ring.entry[i].command.feed, 0.4 * 500.0, 1e-9);
        CHECK_NEAR(m.ring.entry[i].command.path.length, 10.0 * (i + 1), 1e-12);
    }
    double place[AXES] = { 0.0 }, off, out;
    run(place, 0.0, 0.0, 1.0, &off, &out);
    const double want[AXES] = { 10.0, -20.0, 30.0, 1.0, 2.0, -4.0 };
    for (int i = 0; i < AXES; i++) {
        CHECK_NEAR(place[i], want[i], 1e-9);
    }
}

int main(void)
{
    circle_with_followers();
    planes();
    refusals();
    point_to_point();
    return check_result();
}
