/* Curves: each axis within its limits at every point, whatever the panel does; within the
 * tolerance; exact ends; closed forms. */
#include "mcc_chain.h"

/* What each axis keeps to. */
struct axis_limits {
    double speed[3], acc[3], jerk[3]; /* jerk 0: no limit */
};

static struct machine machine_of(const struct axis_limits *l)
{
    struct machine machine = mcc_machine();

    for (int i = 0; i < 3; i++) {
        machine.axis[i].rpm = 60.0 * l->speed[i] / machine.axis[i].pitch;
        machine.axis[i].acc = l->acc[i];
        machine.axis[i].jerk = l->jerk[i];
    }
    return machine;
}

static void begin_curve(const struct axis_limits *l, double feed, double tolerance, double merge)
{
    begin(machine_of(l));
    MCC_set_fspd(&m, feed);
    CHECK_EQ(mcc_set_tolerance(&m, tolerance), 0);
    CHECK_EQ(mcc_set_curve(&m, true, merge), 0);
}

/* Places of the points, differentiated. */
struct places {
    double x[4][AXES];
    int n;
    double peak[3]; /* of speed, acceleration, jerk, as shares of the limits */
};

static void look_at(struct places *p, const struct point *now, const struct axis_limits *l)
{
    static const double noise[3] = { 1e-12, 1e-12, 4e-12 };

    memmove(p->x + 1, p->x, 3 * sizeof *p->x);
    memcpy(p->x[0], now->place, sizeof *p->x);
    p->n++;
    for (int i = 0; i < 3; i++) {
        const double v = p->x[0][i] - p->x[1][i], a = v - (p->x[1][i] - p->x[2][i]);
        const double j = a - (p->x[1][i] - 2.0 * p->x[2][i] + p->x[3][i]);
        const double most[3] = { l->speed[i] * DT, l->acc[i] * DT * DT, l->jerk[i] * DT * DT * DT };
        const double seen[3] = { fabs(v), fabs(a), fabs(j) };
        for (int k = 0; k < 3; k++) {
            if (p->n < k + 2 || most[k] <= 0.0) {
                continue;
            }
            CHECK(seen[k] <= most[k] * (1.0 + 1e-6) + noise[k]);
            p->peak[k] = fmax(p->peak[k], seen[k] / most[k]);
        }
    }
}

static struct axis_limits random_limits(uint64_t *seed, bool smooth)
{
    struct axis_limits l = { .jerk = { 0.0 } };

    for (int i = 0; i < 3; i++) {
        l.speed[i] = check_real(seed, 60.0, 300.0);
        l.acc[i] = check_real(seed, 300.0, 3000.0);
        l.jerk[i] = smooth ? l.acc[i] * check_real(seed, 10.0, 100.0) : 0.0;
    }
    return l;
}

/* The next command of a random run: short lines that turn a little, now and then a long one, a
 * corner or an arc. */
static int send(uint64_t *seed, double *angle, double size)
{
    const double die = check_real(seed, 0.0, 1.0);
    const double length = size * (die < 0.03 ? 20.0 : check_real(seed, 0.2, 1.0));

    *angle += die > 0.97 ? check_real(seed, -2.5, 2.5) : check_real(seed, -0.3, 0.3);
    const double x = length * cos(*angle), y = length * sin(*angle);
    if (die > 0.5 && die < 0.55) {
        return MCC_arc_xy(&m, 0.5 * x - 0.2 * y, 0.5 * y + 0.2 * x, x, y);
    }
    return MCC_line(&m, (double[AXES]){ x, y, 0.2 * length * check_real(seed, -1.0, 1.0) });
}

/* A hand on the panel; true once it has aborted. */
static bool meddle(uint64_t *seed, bool may_abort)
{
    const double die = check_real(seed, 0.0, 1.0);

    if (die < 0.01) {
        MCC_motion_hold(&m);
    } else if (die < 0.05) {
        MCC_motion_conti(&m);
    } else if (die < 0.07) {
        MCC_set_over_spd(&m, check_real(seed, 0.0, 200.0));
    }
    return die > 0.9998 && may_abort && MCC_motion_abort(&m) == 0;
}

static void anything(bool smooth)
{
    struct places all = { .n = 0 };
    uint64_t seed = smooth ? 7 : 3;

    for (int i = 0; i < (smooth ? 6 : 20); i++) {
        const struct axis_limits l = random_limits(&seed, smooth);
        const double size = pow(10.0, check_real(&seed, -1.5, 0.7));
        const double tolerance = check_real(&seed, 0.005, 0.1);
        struct record r = { 0 };
        struct places x = { .n = 0 };
        double angle = 0.0;
        int sent = 0;
        bool aborted = false;

        begin_curve(&l, check_real(&seed, 10.0, 55.0), tolerance, i % 4 ? tolerance : 0.0);
        MCC_set_inc(&m);
        while (r.n < LONGEST) {
            for (; sent < 400 && !ring_full(&m.ring) && !aborted; sent++) {
                CHECK((sent == 200 ? MCC_motion_delay(&m, 20.0) : send(&seed, &angle, size)) > 0);
            }
            aborted = meddle(&seed, i % 3 == 0) || aborted;
            if (!point(&r)) {
                if (MCC_check_stop(&m)) {
                    break;
                }
                continue;
            }
            look_at(&x, &r.last, &l);
        }
        CHECK(r.n < LONGEST && MCC_check_stop(&m));
        for (int k = 0; k < 3; k++) {
            CHECK(r.last.place[k] == m.end[k]);
            all.peak[k] = fmax(all.peak[k], x.peak[k]);
        }
    }
    printf("%s: peaks of the limits %.6f %.6f %.6f\n", smooth ? "S" : "T", all.peak[0], all.peak[1],
           all.peak[2]);
    CHECK(all.peak[1] > 0.95 && (!smooth || all.peak[2] > 0.5));
}

/* A line in a thousand pieces is the line: same time, no dip. */
static void pieces(void)
{
    const struct axis_limits l = { { 200.0, 200.0, 200.0 }, { 600.0, 800.0, 800.0 }, { 0.0 } };
    struct record r = { 0 };

    begin_curve(&l, 50.0, 0.01, 0.01);
    const double slowest = drive_pieces(&r, 0.06, 1.99);
    CHECK_NEAR(slowest, 50.0, 1e-4); /* u is not quite the length */
    CHECK_NEAR(r.speed_max, 50.0, 1e-4);
    CHECK_NEAR(r.n * DT, 2.0 + 0.05, 3.0 * DT); /* 1000 mm/s^2 along the line */
    CHECK_NEAR(r.last.place[0], 60.0, 0.0);
    CHECK_NEAR(r.last.place[1], 80.0, 0.0);
}

/* A zigzag: within the tolerance, no stop, and in the time of square corners that a quintic rounds:
 * each axis turns by 1 over 2 half, r'' 0.75 / half at most. */
static void zigzag(void)
{
    const struct axis_limits l = { { 200.0, 200.0, 200.0 }, { 500.0, 500.0, 500.0 }, { 0.0 } };
    struct record r = { 0 };
    struct path side[SIDES];
    double slowest = INFINITY;

    begin_curve(&l, 50.0, 0.1, 0.1);
    send_zigzag(side);
    while (point(&r)) {
        CHECK(off_zigzag(side, &r) <= 0.1 * (1.0 + 1e-9));
        slowest = r.n > 100 && r.n < 1800 ? fmin(slowest, m.trajectory.curve.place.rate) : slowest;
    }
    const double half = 0.1 / (0.1875 * sqrt(2.0)), turn = sqrt(500.0 * half / 0.75);
    CHECK(slowest > 0.9 * turn);
    printf("zigzag: slowest %.3f of %.3f mm/s, %.3f s\n", slowest, turn, r.n * DT);
}

/* Whatever was in the memory of a library that opens, it makes the same points of a smooth path, of
 * a chain with look-ahead, and of single commands. */
static void on_any_memory(void)
{
    const struct axis_limits l = { { 200.0, 200.0, 200.0 }, { 500.0, 500.0, 500.0 }, { 1e5 } };
    static double place[2][LONGEST][3];
    struct path side[SIDES];

    for (int way = 0; way < 3; way++) {
        struct record r[2] = { { 0 } };
        for (int again = 0; again < 2; again++) {
            memset(&m, again ? 0xa5 : 0, sizeof m);
            begin_curve(&l, 50.0, way < 2 ? 0.1 : 0.0, 0.1);
            CHECK_EQ(mcc_set_curve(&m, way == 0, 0.0), 0);
            send_zigzag(side);
            while (r[again].n < LONGEST && point(&r[again])) {
                memcpy(place[again][r[again].n - 1], r[again].last.place, sizeof place[0][0]);
            }
        }
        CHECK(r[0].n > 1000 && r[0].n == r[1].n);
        CHECK(memcmp(place[0], place[1], (size_t)r[0].n * sizeof place[0][0]) == 0);
    }
}

static void calls(void)
{
    const struct axis_limits l = { { 200.0, 200.0, 200.0 }, { 500.0, 500.0, 500.0 }, { 0.0 } };
    struct machine machine = machine_of(&l);

    begin_curve(&l, 50.0, 0.1, 0.1);
    CHECK_EQ(mcc_set_curve(&m, true, -1.0), MCC_PARAMETER);
    CHECK_EQ(mcc_set_curve(&m, true, NAN), MCC_PARAMETER);
    machine.axis[1].acc = -1.0;
    CHECK_EQ(MCC_init_motion(&m, &machine), MCC_PARAMETER);
    machine.axis[1].acc = 0.0;
    machine.axis[1].jerk = 1e4; /* without an acceleration */
    CHECK_EQ(MCC_init_motion(&m, &machine), MCC_PARAMETER);
}

int main(void)
{
    calls();
    pieces();
    zigzag();
    on_any_memory();
    anything(false);
    anything(true);
    return check_result();
}
