/* Look-ahead: corners within their tolerance, limits at every sample, exact ends, closed forms. */
#include "corner.h"
#include "mcc_chain.h"

static void random_path(uint64_t *seed, const double start[AXES], struct path *p)
{
    double end[AXES] = { 0 }, miss;
    for (int i = 0; i < 3; i++) {
        end[i] = start[i] + check_real(seed, -10.0, 10.0);
    }
    const double kind = check_real(seed, 0.0, 1.0);
    if (kind < 0.4) {
        path_line(p, start, end);
        return;
    }
    if (kind < 0.7) {
        double inner[2][3];
        do {
            for (int i = 0; i < 6; i++) {
                inner[i / 3][i % 3] = start[i % 3] + check_real(seed, -10.0, 10.0);
            }
        } while (path_cubic(p, start, end, (const double(*)[3])inner) != PATH_OK
                 || path_bend(p) > 2.0);
        return;
    }
    const double r = check_real(seed, 1.0, 20.0), a = check_real(seed, 0.0, 6.28);
    const double centre[2] = { start[0] + r * cos(a), start[1] + r * sin(a) };
    const double b = a + check_real(seed, 1.0, 5.0);
    end[0] = centre[0] - r * cos(b);
    end[1] = centre[1] - r * sin(b);
    CHECK_EQ(path_arc(p, PATH_XY, start, end, centre, true, 1, &miss), FAULT_NONE);
}

/* A curve that goes on smoothly, so that only bends make the corner. */
static void onward(uint64_t *seed, const struct path *a, struct path *b)
{
    double at[AXES], slope[AXES], end[AXES] = { 0 }, inner[2][3];
    path_at(a, a->length, at, slope);
    do {
        const double size = check_real(seed, 0.5, 10.0) / norm3(slope);
        for (int i = 0; i < 3; i++) {
            inner[0][i] = at[i] + size * slope[i];
            inner[1][i] = at[i] + check_real(seed, -10.0, 10.0);
            end[i] = at[i] + check_real(seed, -10.0, 10.0);
        }
    } while (path_cubic(b, at, end, (const double(*)[3])inner) != PATH_OK || path_bend(b) > 5.0);
}

/* Every random corner: ends on its paths, near enough to them, as smooth as it says. */
static void corners(void)
{
    uint64_t seed = 1;
    for (int i = 0; i < 300; i++) {
        const double start[AXES] = { check_real(&seed, -5.0, 5.0) };
        const double tolerance = pow(10.0, check_real(&seed, -4.0, 0.0));
        struct path a, b;
        struct corner k;
        double x[4][AXES], slope[AXES], end[AXES], way[AXES];
        random_path(&seed, start, &a);
        if (i % 3) {
            random_path(&seed, a.end, &b);
        } else {
            onward(&seed, &a, &b);
        }
        CHECK(corner_make(&k, &a, &b, tolerance, 0.5 * fmin(a.length, b.length), true));
        corner_at(&k, &a, &b, -k.half, x[0], slope);
        path_at(&a, a.length - k.half, end, way);
        CHECK_NEAR(x[0][0], end[0], 1e-12);
        CHECK_NEAR(slope[1], way[1], 1e-12);
        corner_at(&k, &a, &b, k.half, x[0], slope);
        path_at(&b, k.half, end, way);
        CHECK_NEAR(x[0][1], end[1], 1e-12);
        CHECK_NEAR(slope[2], way[2], 1e-12);
        const double h = 2.0 * k.half / 200;
        double farthest = 0.0;
        for (int n = 0; n <= 200; n++) {
            double d[4] = { 0 };
            memmove(x[1], x[0], 3 * sizeof x[0]);
            corner_at(&k, &a, &b, fmin(n * h - k.half, k.half), x[0], slope);
            CHECK(norm3(slope) <= 1.0 + 1e-12);
            farthest =
                n % 10 ? farthest : fmax(farthest, fmin(distance(&a, x[0]), distance(&b, x[0])));
            for (int j = 0; j < 3; j++) {
                d[2] += pow(x[0][j] - 2.0 * x[1][j] + x[2][j], 2.0);
                d[3] += pow(x[0][j] - 3.0 * x[1][j] + 3.0 * x[2][j] - x[3][j], 2.0);
            }
            CHECK(n < 2 || sqrt(d[2]) <= k.bend * h * h * (1.0 + 1e-6) + 1e-13);
            CHECK(n < 3 || sqrt(d[3]) <= k.twist * h * h * h * (1.0 + 1e-3) + 1e-13);
        }
        CHECK(farthest <= tolerance * (1.0 + 1e-6));
    }
}

/* However large the tolerance, a corner takes half a radian of the sharper of two arcs, no more:
 * the rest of an arc is driven, one that is far smaller than the tolerance too. */
static void small_arcs(void)
{
    for (int k = 0; k < 4; k++) {
        const double r = 0.1, other = k % 2 ? 0.4 : 0.05, sharper = fmin(r, other);
        const double start[AXES] = { 0 }, up[2] = { 0.0, r };
        const double on[AXES] = { -r, r }, beside[2] = { -r - (k < 2 ? other : -other), r };
        const double end[AXES] = { beside[0], r - other };
        struct path a, b;
        struct corner c;
        double miss;
        CHECK_EQ(path_arc(&a, PATH_XY, start, on, up, true, 1, &miss), FAULT_NONE);
        CHECK_EQ(path_arc(&b, PATH_XY, on, end, beside, k >= 2, 1, &miss), FAULT_NONE);
        for (double tolerance = 0.01; tolerance < 20.0; tolerance *= 10.0) {
            CHECK(corner_make(&c, &a, &b, tolerance, 0.5 * fmin(a.length, b.length), true));
            CHECK(c.half <= 0.5 * sharper * (1.0 + 1e-12));
        }
        CHECK_NEAR(c.half, 0.5 * sharper, 1e-12);
    }
}

/* A square corner of two lines is cut by sqrt(2) CUT half, all of the tolerance. */
static void square(void)
{
    const double o[AXES] = { 0 }, x[AXES] = { 10.0 }, y[AXES] = { 10.0, 10.0 };
    struct path a, b;
    struct corner k;
    double at[AXES], slope[AXES];
    path_line(&a, o, x);
    path_line(&b, x, y);
    CHECK(corner_make(&k, &a, &b, 0.05, 5.0, false));
    CHECK_NEAR(k.half, 0.05 / (0.1875 * sqrt(2.0)), 1e-12);
    corner_at(&k, &a, &b, 0.0, at, slope);
    CHECK_NEAR(hypot(at[0] - 10.0, at[1]), 0.05, 1e-12);
    CHECK(!corner_make(&k, &a, &b, 0.0, 5.0, true));
    CHECK(corner_make(&k, &a, &a, 0.0, 5.0, true) && k.half == 0.0);
    CHECK(!corner_make(&k, &a, &b, 1.0, 1e-7, true));
}

/* A line in a thousand pieces is the line: same time, no dip. */
static void pieces(bool smooth)
{
    struct record r = { 0 };
    begin(mcc_machine());
    smooth_ramps(smooth);
    MCC_set_fspd(&m, 50.0);
    CHECK_EQ(mcc_set_tolerance(&m, 0.01), 0);
    const double slowest = drive_pieces(&r, 0.2, 1.9);
    CHECK_NEAR(slowest, 50.0, 1e-6);
    CHECK_NEAR(r.speed_max, 50.0, 1e-6);
    /* T: 2 s + one ramp. S: ramps of 0.1 (1 - share/2) s, share 0.5, and the mean's 0.05 s. */
    CHECK_NEAR(r.n * DT, smooth ? 2.0 + 0.075 + 0.05 : 2.0 + 0.1, 3.0 * DT);
    CHECK_NEAR(r.last.place[0], 60.0, 0.0);
    CHECK_NEAR(r.last.place[1], 80.0, 0.0);
    CHECK(MCC_check_stop(&m));
}

/* Random chains, twice in a row, under random overrides, holds and at last an abort. */
static void anything(bool smooth)
{
    uint64_t seed = 5;
    for (int i = 0; i < 40; i++) {
        const double feed = check_real(&seed, 10.0, 100.0), size = i % 2 ? 5.0 : 0.05;
        const struct limits l = limits_at(feed, smooth);
        struct record r = { 0 };
        struct stream x = { 0 };
        double v0[3] = { 0 }, x0[3] = { 0 };
        int sent = 0;
        bool aborted = false;
        begin(mcc_machine());
        smooth_ramps(smooth);
        MCC_set_fspd(&m, feed);
        CHECK_EQ(mcc_set_tolerance(&m, i % 3 ? 0.02 : 0.2), 0);
        MCC_set_inc(&m);
        while (r.n < LONGEST) {
            for (; sent < 300 && !ring_full(&m.ring) && !aborted; sent++) {
                if (sent == 150) {
                    CHECK(MCC_motion_delay(&m, 20.0) > 0);
                    continue;
                }
                const double a = check_real(&seed, 0.2, 1.0) * size;
                const double b = check_real(&seed, -1.0, 1.0) * size;
                CHECK((sent % 5 == 4 && i % 4 == 0 ? MCC_arc_xy(&m, a, b, 2.0 * a, 0.0)
                                                   : MCC_line(&m, (double[AXES]){ a, b, 0.3 * b }))
                      > 0);
            }
            const double die = check_real(&seed, 0, 1);
            if (die < 0.005) {
                MCC_motion_hold(&m);
            } else if (die < 0.03) {
                MCC_motion_conti(&m);
            } else if (die < 0.04) {
                MCC_set_over_spd(&m, check_real(&seed, 0.0, 200.0));
            } else if (die < 0.0401 && i % 5 == 0 && MCC_motion_abort(&m) == 0) {
                aborted = true;
            }
            const int chain = m.trajectory.motion == TRAJECTORY_CHAIN ? chain_number() : 0;
            if (!point(&r)) {
                if (MCC_check_stop(&m)) {
                    break;
                }
                memset(v0, 0, sizeof v0);
                continue;
            }
            if (chain && m.trajectory.motion == TRAJECTORY_CHAIN && chain == chain_number()) {
                look(&x, way_of_tool(), &l);
            } else {
                x.n = 0;
            }
            double change = 0.0;
            for (int j = 0; j < 3; j++) {
                const double v = (r.last.place[j] - x0[j]) / DT;
                change += pow(v - v0[j], 2.0);
                v0[j] = v;
                x0[j] = r.last.place[j];
            }
            CHECK(sqrt(change) <= 2.0 * l.acc * DT + 1e-9); /* along and across */
        }
        CHECK(r.n < LONGEST && MCC_check_stop(&m));
        for (int j = 0; j < 3; j++) {
            CHECK(r.last.place[j] == m.end[j]);
            CHECK_EQ(r.sum[j], (int32_t)lround(m.end[j] * 1000.0));
        }
    }
}

/* A polygon of many corners: the tool stays within the tolerance of it and is done sooner than with
 * exact stops; the corner speed is what the acceleration allows: v^2 0.75 sqrt(2) / half = a. */
static void tolerance(void)
{
    struct record r = { 0 };
    struct path side[SIDES];
    double slowest = INFINITY;
    begin(mcc_machine());
    MCC_set_fspd(&m, 50.0);
    CHECK_EQ(mcc_set_tolerance(&m, 0.1), 0);
    send_zigzag(side);
    while (point(&r)) {
        CHECK(off_zigzag(side, &r) <= 0.1 * (1.0 + 1e-9));
        slowest = r.n > 100 && r.n < 2000 ? fmin(slowest, m.trajectory.lookahead.v) : slowest;
    }
    const double half = 0.1 / (0.1875 * sqrt(2.0));
    const double turn = sqrt(500.0 * half / (0.75 * sqrt(2.0)));
    CHECK_NEAR(slowest, turn, 0.02 * turn);
    /* Corners at their speed; between them up from it and down to it, at the ends from rest. */
    const double acc = 500.0, inner = 5.0 - 2.0 * half, outer = 5.0 - half;
    const double top = sqrt(turn * turn + acc * inner);
    const double last = sqrt((2.0 * acc * outer + turn * turn) / 2.0);
    const double time = 19.0 * 2.0 * half / turn + 18.0 * 2.0 * (top - turn) / acc
                        + 2.0 * (2.0 * last - turn) / acc;
    CHECK_NEAR(r.n * DT, time, DT);
    CHECK(time < 20.0 * (5.0 / 50.0 + 0.1)); /* exact stops */
}

/* What does not fit ends the chain at rest: no tolerance, another command kind. */
static void chain_ends(void)
{
    struct record r = { 0 };
    begin(mcc_machine());
    CHECK_EQ(mcc_set_tolerance(&m, -1.0), MCC_PARAMETER);
    CHECK_EQ(mcc_set_tolerance(&m, NAN), MCC_PARAMETER);
    CHECK_EQ(mcc_set_tolerance(&m, 0.1), 0);
    CHECK(MCC_line_x(&m, 5.0) > 0);
    CHECK(MCC_line_y(&m, 5.0) > 0);
    CHECK_EQ(mcc_set_tolerance(&m, 0.0), 0);
    CHECK(MCC_line_x(&m, 0.0) > 0);
    CHECK(MCC_ptp_y(&m, 0.0) > 0);
    double corner = INFINITY, stop = INFINITY;
    while (point(&r)) {
        corner = fmin(corner, hypot(r.last.place[0] - 5.0, r.last.place[1]));
        stop = fmin(stop, hypot(r.last.place[0] - 5.0, r.last.place[1] - 5.0));
    }
    CHECK(corner > 0.09 && corner < 0.11);
    CHECK(stop < 1e-2);
    CHECK(r.last.place[0] == 0.0 && r.last.place[1] == 0.0);
}

/* An abort at any point brings all to rest and drops what waits, also one whose ramp is that to the
 * end of the chain. */
static void abort_anywhere(char type)
{
    int stops = 0;
    for (int k = 1; k < 400; k++) {
        struct record r = { 0 };
        begin(mcc_machine());
        MCC_set_acc_type(&m, type);
        MCC_set_dec_type(&m, type);
        CHECK_EQ(mcc_set_tolerance(&m, 0.1), 0);
        CHECK(MCC_line_x(&m, 1.0) > 0);
        CHECK(MCC_line_x(&m, 1.5) > 0);
        CHECK(MCC_motion_delay(&m, 500.0) > 0);
        while (r.n < k && point(&r)) {
        }
        CHECK_EQ(MCC_motion_abort(&m), MCC_NO_ERR);
        run(&r);
        stops += MCC_check_stop(&m);
    }
    CHECK_EQ(stops, 399);
}

int main(void)
{
    corners();
    small_arcs();
    square();
    pieces(false);
    pieces(true);
    tolerance();
    chain_ends();
    abort_anywhere('T');
    abort_anywhere('S');
    anything(false);
    anything(true);
    return check_result();
}
