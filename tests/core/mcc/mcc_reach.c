/* Where the ramp of an abort would lead: against the ramp driven point by point, from points of
 * random motions of every kind. */
#include "mcc_react.h"
#include "reach.h"

static const double FAR = 1e5; /* [mm] */

/* Lowest and highest point of the ramp from here. [pulses] */
static void drive_ramp(int32_t low[AXES], int32_t high[AXES])
{
    const struct mechanism machine = machine_mechanism(&m.machine);
    const double dda = machine_dda_time(&m.machine);
    const struct trajectory_beside beside = mcc_beside(&before);
    struct point p;

    before = m;
    memcpy(low, before.trajectory.pulses, sizeof before.trajectory.pulses);
    memcpy(high, before.trajectory.pulses, sizeof before.trajectory.pulses);
    trajectory_abort(&before.trajectory, &before.ring);
    while (!trajectory_resting(&before.trajectory, &before.ring)) {
        trajectory_advance(&before.trajectory, &beside, dda);
        trajectory_point(&before.trajectory, &beside, &machine, dda, &p);
        for (int k = 0; k < AXES; k++) {
            low[k] = p.pulses[k] < low[k] ? p.pulses[k] : low[k];
            high[k] = p.pulses[k] > high[k] ? p.pulses[k] : high[k];
        }
    }
}

/* Judgement with one limit of one axis at so many pulses. */
static int judged(int axis, bool upper, int32_t limit)
{
    struct machine machine = m.machine;
    const double place = limit / machine_pulses_per_mm(&machine.axis[axis]);

    for (int k = 0; k < AXES; k++) {
        machine.axis[k].check_ot = k == axis;
        machine.axis[k].high_limit = upper ? place : FAR;
        machine.axis[k].low_limit = upper ? -FAR : place;
        machine.axis[k].hot_offset = machine.axis[k].lot_offset = 0.0;
    }
    before = m;
    const struct mechanism mechanism = machine_mechanism(&machine);
    const struct trajectory_beside beside = mcc_beside(&before);
    return reach_beyond(&before.trajectory, &beside, &mechanism, machine_dda_time(&machine));
}

/* A limit on the farthest point holds, one a pulse nearer does not. Points may miss the top of an
 * arc by less than a pulse. */
static int compared(bool arcs)
{
    int32_t low[AXES], high[AXES];
    int n = 0;

    drive_ramp(low, high);
    for (int k = 0; k < 2; k++) {
        if (high[k] > m.trajectory.pulses[k] + 1) {
            CHECK_EQ(judged(k, true, high[k] + arcs), -1);
            CHECK_EQ(judged(k, true, high[k] - 1), k);
            n++;
        }
        if (low[k] < m.trajectory.pulses[k] - 1) {
            CHECK_EQ(judged(k, false, low[k] - arcs), -1);
            CHECK_EQ(judged(k, false, low[k] + 1), k);
            n++;
        }
    }
    return n;
}

/* Compare at random points until all rests. */
static int whole_motion(uint64_t *seed, bool arcs)
{
    struct run r = { 0 };
    int n = 0;
    while (r.n < LONGEST && point(&r)) {
        if (check_real(seed, 0.0, 1.0) < 0.02) {
            n += compared(arcs);
        }
    }
    CHECK(r.n < LONGEST && MCC_get_errcode(&m) == 0);
    return n;
}

static void random_ramps(uint64_t *seed)
{
    MCC_set_acc_type(&m, check_real(seed, 0.0, 1.0) < 0.5 ? 'S' : 'T');
    MCC_set_dec_type(&m, check_real(seed, 0.0, 1.0) < 0.5 ? 'S' : 'T');
    MCC_set_acc_step(&m, check_real(seed, 5.0, 100.0));
    MCC_set_dec_step(&m, check_real(seed, 5.0, 100.0));
    MCC_set_fspd(&m, check_real(seed, 5.0, 60.0));
}

/* Lines and circles: one after the other, mixed at their corners, or in a chain. */
static void on_paths(bool quit, double tolerance)
{
    uint64_t seed = 5;
    int n = 0;
    for (int i = 0; i < 12; i++) {
        const struct machine machine = one_ahead();
        open_machine(&machine);
        (quit ? MCC_enable_quit : MCC_disable_quit)(&m);
        CHECK_EQ(mcc_set_tolerance(&m, tolerance), 0);
        for (int k = 0; k < 25; k++) {
            if (tolerance == 0.0 || k == 0) {
                random_ramps(&seed);
            }
            const double x = check_real(&seed, -10.0, 10.0), y = check_real(&seed, -3.0, 3.0);
            CHECK((k % 4 == 3 ? MCC_circle_xy(&m, x, y, k % 8 == 3)
                              : MCC_line(&m, (double[AXES]){ x, y }))
                  > 0);
        }
        n += whole_motion(&seed, true);
    }
    CHECK(n > 200);
}

/* Independent axes: point to point, jog and its turning back. */
static void on_their_own(void)
{
    uint64_t seed = 9;
    int n = 0;
    for (int i = 0; i < 40; i++) {
        struct machine machine = one_ahead();
        for (int k = 0; k < AXES; k++) {
            machine.asyn.acc_type[k] = i & 1 ? 'S' : 'T';
            machine.asyn.dec_type[k] = i & 2 ? 'S' : 'T';
            machine.asyn.acc_time[k] = check_real(&seed, 0.02, 0.4);
            machine.asyn.dec_time[k] = check_real(&seed, 0.02, 0.4);
        }
        open_machine(&machine);
        CHECK(MCC_ptp_asyn(&m, (double[AXES]){ check_real(&seed, -40.0, 40.0),
                                               check_real(&seed, -40.0, 40.0) })
              > 0);
        n += whole_motion(&seed, false);
        struct run r = { 0 };
        for (int k = 0; k < 20; k++) {
            CHECK_EQ(MCC_jog_c(&m, k % 2, check_real(&seed, 0.0, 1.0) < 0.5 ? 1 : -1,
                               check_real(&seed, 1.0, 30.0)),
                     0);
            points(&r, r.n + (int)check_real(&seed, 1.0, 300.0));
            n += compared(false);
        }
    }
    CHECK(n > 800);
}

int main(void)
{
    on_paths(false, 0.0);
    on_paths(true, 0.0);
    on_paths(true, 0.05);
    on_their_own();
    return check_result();
}
