/* Axes that move independently: limits at every sample, exact ends, override, hold, ramp types. */
#include "axes.h"
#include "mcc_check.h"

static const double DT = 1e-3; /* [s] between samples */

static struct machine machine_of(char acc_type, char dec_type)
{
    struct machine m = mcc_machine();
    for (int i = 0; i < AXES; i++) {
        m.asyn.acc_type[i] = acc_type;
        m.asyn.dec_type[i] = dec_type;
        m.asyn.acc_time[i] = 0.05 + 0.01 * i;
        m.asyn.dec_time[i] = 0.08 - 0.01 * i;
    }
    return m;
}

/* The latest samples of an axis: differences of the place are its mean speed, and so on. */
struct trace {
    double s[4];
    int n;
};

/* Means over samples can exceed no limit that holds at every moment. */
static void check_sample(struct trace *t, double s, const struct axes_limits *l, double speed)
{
    memmove(t->s, t->s + 1, 3 * sizeof *t->s);
    t->s[3] = s;
    t->n++;
    const double v1 = (t->s[2] - t->s[1]) / DT, v2 = (t->s[3] - t->s[2]) / DT;
    const double a1 = (v1 - (t->s[1] - t->s[0]) / DT) / DT, a2 = (v2 - v1) / DT;
    const double rounding = 1e-9 / DT / DT;
    if (t->n >= 2) {
        CHECK(fabs(v2) <= speed * (1.0 + 1e-9) + 1e-9);
    }
    if (t->n >= 3) {
        CHECK(fabs(a2) <= fmax(l->acc, l->dec) * (1.0 + 1e-9) + rounding);
        if (v1 * v2 > 0.0 && fabs(v1) > l->dec * DT && fabs(v2) > l->acc * DT) {
            const double limit = fabs(v2) > fabs(v1) ? l->acc : l->dec;
            CHECK(fabs(a2) <= limit * (1.0 + 1e-9) + rounding);
        }
    }
    if (t->n >= 4 && l->jerk < 1e9) {
        CHECK(fabs(a2 - a1) <= l->jerk * DT * (1.0 + 1e-9) + 4.0 * rounding);
    }
}

/* One axis to its end; returns the time, from the plan, and checks each sample. */
static double go(const struct machine *m, int axis, double from, double to)
{
    const struct axes_limits l = machine_axis_limits(m, axis, machine_ptp_speed(m, axis));
    double start[AXES] = { 0.0 }, s, v;
    struct trace t = { .n = 0 };
    struct axes a;

    start[axis] = from;
    axes_start(&a, start, 1.0);
    CHECK(axes_resting(&a) && axes_done(&a, axis));
    axes_go(&a, axis, to, &l);
    CHECK(!axes_done(&a, axis));
    const double total = axes_left(&a);
    for (int k = 0; !axes_resting(&a) && k < 100000; k++) {
        axes_state(&a, axis, &s, &v);
        check_sample(&t, s, &l, l.speed);
        axes_advance(&a, DT);
    }
    axes_state(&a, axis, &s, &v);
    CHECK(s == to && v == 0.0 && axes_done(&a, axis));
    for (int i = 0; i < AXES; i++) {
        axes_state(&a, i, &s, &v);
        CHECK(i == axis || (s == 0.0 && v == 0.0));
    }
    return total;
}

/* Time of a ramp to the speed. */
static double ramp_time(double speed, double acc, double jerk)
{
    return acc * acc <= speed * jerk ? speed / acc + acc / jerk : 2.0 * sqrt(speed / jerk);
}

/* A move is way/speed long plus half of both ramps. The one that could have more jerk than both
 * have takes longer than its time. */
static void durations(void)
{
    static const char type[] = { 'T', 'S' };
    for (int k = 0; k < 2; k++) {
        const struct machine m = machine_of(type[k], type[k]);
        for (int i = 0; i < AXES; i++) {
            const struct axes_limits l = machine_axis_limits(&m, i, machine_ptp_speed(&m, i));
            const double up = ramp_time(l.speed, l.acc, l.jerk);
            const double down = ramp_time(l.speed, l.dec, l.jerk);
            const double want = 200.0 / l.speed + (up + down) / 2.0;
            CHECK(up >= m.asyn.acc_time[i] - 1e-12 && down >= m.asyn.dec_time[i] - 1e-12);
            CHECK(fmin(up - m.asyn.acc_time[i], down - m.asyn.dec_time[i]) <= 1.001e-9);
            CHECK_NEAR(go(&m, i, 1.0, 201.0), want, 1e-12);
            CHECK_NEAR(go(&m, i, 1.0, -199.0), want, 1e-12);
        }
    }
}

/* An 'S' ramp of equal times takes exactly its time, with the share of jerk at both ends. */
static void ramp_takes_its_time(void)
{
    struct machine m = machine_of('S', 'S');
    double s, v;

    for (double share = 0.1; share <= 1.0; share += 0.3) {
        struct axes a;
        m.jerk_share = share;
        m.asyn.acc_time[0] = m.asyn.dec_time[0] = 0.2;
        const struct axes_limits l = machine_axis_limits(&m, 0, 100.0);
        axes_start(&a, (double[AXES]){ 0.0 }, 1.0);
        axes_run(&a, 0, -100.0, &l);
        CHECK_NEAR(a.axis[0].plan.total, 0.2, 1e-12);
        axes_advance(&a, 0.2 * share / 2.0);
        axes_state(&a, 0, &s, &v);
        CHECK_NEAR(-v, l.acc * 0.2 * share / 4.0, 1e-9);
        axes_advance(&a, 1.2 - 0.2 * share / 2.0);
        axes_state(&a, 0, &s, &v);
        CHECK_NEAR(v, -100.0, 0.0);
        CHECK_NEAR(s, -10.0 - 100.0, 1e-9);
        CHECK(!axes_rests(&a, 0) && !axes_done(&a, 0));
        axes_stand(&a, 0);
        axes_advance(&a, 0.2 + 1e-9);
        axes_state(&a, 0, &s, &v);
        CHECK_NEAR(s, -120.0, 1e-9);
        CHECK(v == 0.0 && axes_done(&a, 0));
    }
}

/* 'T' against the trapezium itself: at every moment within the speed times 1 ns. */
static void trapezium_error(void)
{
    const struct machine m = machine_of('T', 'T');
    const struct axes_limits l = machine_axis_limits(&m, 0, 500.0);
    const double up = l.speed / l.acc, down = l.speed / l.dec, way = 400.0;
    const double cruise = way / l.speed - (up + down) / 2.0;
    double worst = 0.0, s, v;
    struct axes a;

    axes_start(&a, (double[AXES]){ 0.0 }, 1.0);
    axes_go(&a, 0, way, &l);
    for (int k = 0; k < 10000; k++) {
        const double t = k * 1e-4, left = up + cruise + down - t;
        const double ideal = t < up            ? l.acc * t * t / 2.0
                             : t < up + cruise ? l.speed * (t - up / 2.0)
                             : left > 0.0      ? way - l.dec * left * left / 2.0
                                               : way;
        axes_state(&a, 0, &s, &v);
        worst = fmax(worst, fabs(s - ideal));
        axes_advance(&a, 1e-4);
    }
    CHECK(worst > 0.2e-6 && worst < 0.6e-6); /* [mm] 0.25 nm a ramp */
}

/* Override up and down, hold, new orders at random instants: never beyond a limit, and the end is
 * met exactly. An order across keeps the larger of acc and dec; along the way each its own. */
static void random_orders(char acc_type, char dec_type)
{
    const struct machine m = machine_of(acc_type, dec_type);
    uint64_t random = 1;

    for (int run = 0; run < 400; run++) {
        const int axis = run % AXES;
        const double full = machine_axis_speed(&m.axis[axis]);
        const struct axes_limits l = machine_axis_limits(&m, axis, 0.8 * full);
        struct trace t = { .n = 0 };
        struct axes a;
        double s, v, goal = 0.0, highest = l.speed;

        axes_start(&a, (double[AXES]){ 0.0 }, 1.0);
        for (int k = 0; k < 600; k++) {
            if (k < 500 && check_real(&random, 0.0, 1.0) < 0.03) {
                const double what = check_real(&random, 0.0, 1.0);
                goal = check_real(&random, -100.0, 100.0);
                if (what < 0.3) {
                    axes_go(&a, axis, goal, &l);
                } else if (what < 0.5) {
                    axes_run(&a, axis, copysign(l.speed, goal), &l);
                } else if (what < 0.6) {
                    axes_stand(&a, axis);
                } else {
                    const double ratio = what < 0.75 ? 0.0 : check_real(&random, 0.0, 2.0);
                    axes_set_ratio(&a, ratio);
                    highest = fmax(highest, fmin(full, ratio * l.speed));
                }
            }
            axes_state(&a, axis, &s, &v);
            check_sample(&t, s, &l, highest);
            axes_advance(&a, DT);
        }
        axes_set_ratio(&a, 1.0);
        axes_go(&a, axis, goal, &l);
        axes_advance(&a, 1.0 + axes_left(&a));
        axes_state(&a, axis, &s, &v);
        CHECK(s == goal && v == 0.0 && axes_done(&a, axis));
    }
}

/* Ratio 0 brings to rest and keeps the order; the ratio again leads to its end. */
static void hold_keeps_the_order(void)
{
    const struct machine m = machine_of('S', 'T');
    const struct axes_limits l = machine_axis_limits(&m, 2, 300.0);
    double s, v;
    struct axes a;

    axes_start(&a, (double[AXES]){ 0.0 }, 1.0);
    axes_go(&a, 2, 90.0, &l);
    axes_advance(&a, 0.123);
    axes_set_ratio(&a, 0.0);
    axes_advance(&a, 1.0);
    axes_state(&a, 2, &s, &v);
    CHECK(v == 0.0 && s > 10.0 && s < 80.0);
    CHECK(axes_resting(&a) && !axes_done(&a, 2));
    axes_go(&a, 1, 5.0, &l); /* an order while held waits */
    CHECK(axes_resting(&a) && !axes_done(&a, 1));
    axes_set_ratio(&a, 0.5);
    axes_advance(&a, 3.0);
    axes_state(&a, 2, &s, &v);
    CHECK(s == 90.0 && axes_done(&a, 2) && axes_done(&a, 1));
}

/* The smaller jerk holds for both ramps. */
static void one_jerk(void)
{
    const struct machine m = machine_of('T', 'S');
    const struct axes_limits l = machine_axis_limits(&m, 0, 100.0);
    CHECK_NEAR(l.jerk, l.dec / (0.25 * m.asyn.dec_time[0]), 1e-6);
    CHECK_NEAR(l.acc, 100.0 / m.asyn.acc_time[0], 1e-9);
    CHECK_NEAR(l.cap, 500.0, 1e-9);
}

int main(void)
{
    durations();
    ramp_takes_its_time();
    trapezium_error();
    random_orders('T', 'T');
    random_orders('S', 'S');
    random_orders('T', 'S');
    hold_keeps_the_order();
    one_jerk();
    return check_result();
}
