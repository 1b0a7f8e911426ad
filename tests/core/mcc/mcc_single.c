/* Single block switched on in the middle of a chain: the axes rest at the end of the first command
 * at which they can, and go on command by command. */
#include "mcc_chain.h"

enum { PIECES = 60 }; /* of 1 mm in X, without a corner; a ramp takes 3 of them */

/* Switch it on behind so many points. Returns in which piece that was, -1 at rest. */
static int switched(int points, bool smooth)
{
    const double feed = 60.0;
    struct record r = { 0 };

    begin(mcc_machine());
    smooth_ramps(smooth);
    MCC_set_fspd(&m, feed);
    CHECK_EQ(mcc_set_tolerance(&m, 0.02), 0);
    for (int i = 1; i <= PIECES; i++) {
        CHECK(MCC_line(&m, (double[AXES]){ i }) > 0);
    }
    while (r.n < points && point(&r)) {
    }
    if (r.n < points) {
        return -1;
    }
    const struct limits l = limits_at(feed, smooth);
    const double at = way_of_tool();
    const double planned = m.trajectory.lookahead.base + m.trajectory.lookahead.s;
    const double v = m.trajectory.lookahead.v;
    const double first = ceil(fmin(PIECES, planned + v * v / (2.0 * l.acc)) - 1e-9);
    CHECK_EQ(task_set_single_block(&m, true), MCC_NO_ERR);
    CHECK_EQ(task_continue(&m), MCC_CONTI_ILLEGAL); /* it moves yet */
    struct stream x = { .n = 0 };
    while (point(&r)) {
        if (m.trajectory.motion == TRAJECTORY_CHAIN) {
            look(&x, way_of_tool(), &l);
        }
    }
    CHECK_EQ(r.sum[0], lround(1000.0 * first));
    int rest = (int)first;
    for (; rest < PIECES - 2; rest++) { /* one by one */
        CHECK_EQ(r.sum[0], 1000 * rest);
        CHECK(!point(&r));
        CHECK_EQ(task_continue(&m), MCC_NO_ERR);
        run(&r);
    }
    CHECK_EQ(task_set_single_block(&m, false), MCC_NO_ERR);
    CHECK(!point(&r)); /* the piece that waits still does */
    if (rest < PIECES) {
        CHECK_EQ(task_continue(&m), MCC_NO_ERR);
        run(&r);
    }
    CHECK_EQ(r.sum[0], 1000 * PIECES);
    return (int)at;
}

int main(void)
{
    for (int smooth = 0; smooth < 2; smooth++) {
        int before = 0, pieces = 0;
        for (int points = 1; points < 2000; points += 37) {
            const int in = switched(points, smooth);
            if (in < 0) {
                break;
            }
            pieces += in != before;
            before = in;
        }
        CHECK(pieces > 20);
    }
    return check_result();
}
