/* The preview of a program: its points are those of a run with a card, and each limit of its time
 * is told by a program made for it. */
#include "limited.h"
#include "mcc_card.h"
#include "preview.h"

enum { MOST = 40000 };

static struct seen {
    int n;
    struct point point[MOST];
    struct limited limited[MOST];
} seen;

static void note(void *to, const struct point *p, const struct limited *l)
{
    struct seen *s = to;

    CHECK(s->n < MOST);
    s->point[s->n] = *p;
    s->limited[s->n++] = *l;
}

/* Preview a program on a machine. */
static enum preview_end preview(const struct machine *machine, const char *text)
{
    struct source_text t = { text, (int64_t)strlen(text) };
    const struct source s = source_of(&t);
    static struct mcc m;

    seen.n = 0;
    CHECK_EQ(MCC_init_motion(&m, machine), MCC_NO_ERR);
    return preview_run(&m, &s, MOST, note, &seen);
}

/* Time [s] for which a limit counts; of an axis, or of all if it is -1. */
static double time_of(enum limited_by by, int axis)
{
    int n = 0;

    for (int i = 0; i < seen.n; i++) {
        n += seen.limited[i].by == by && (axis < 0 || seen.limited[i].axis == axis);
    }
    return n * 1.024e-3;
}

static bool near(double time, double expected)
{
    return fabs(time - expected) <= 2.1 * 1.024e-3;
}

/* The same points as those that the card of a run is given, one for each DDA time. */
static void points_are_those_of_a_run(void)
{
    static const char text[] = "F6000 G64 P0.05\nG1 X10 Y-4\nG3 X12 Y-2 I1 J1\nX8 Y3 R9\nG61\n"
                               "G4 P0.05\nG0 Z5\nG64 G1 X0 F900\nY0\nM2";
    const struct pc_config usual = {
        .bus = 4000, .ipo = 40000, .latency = 8000.0, .seed = 1, .min_stock = 3, .batch = 4
    };
    const struct pc_panel panel = { .override = 1.0, .rapid = 1.0 };
    const struct machine machine = mcc_machine();
    struct card c;
    int k = 0, met = 0;

    CHECK_EQ(preview(&machine, text), PREVIEW_DONE);
    CHECK(seen.n > 1000);
    card_start(&c, &machine, &usual, false);
    CHECK_EQ(task_start(&pc.mcc), 0);
    for (int64_t at = 0; at < (int64_t)8 * CLOCK_HZ; at += usual.bus) {
        const int32_t before = pc.mcc.written.pulses[0] ^ pc.mcc.written.pulses[1];
        card_period(&c, at, &panel, text);
        const struct point *p = &pc.mcc.written;
        if (p->command == 0 || (p->pulses[0] ^ p->pulses[1]) == before) {
            continue; /* no other point than before, as far as X and Y show it */
        }
        while (k < seen.n && memcmp(p->place, seen.point[k].place, sizeof p->place)) {
            k++;
        }
        CHECK(k < seen.n && memcmp(p->pulses, seen.point[k].pulses, sizeof p->pulses) == 0);
        met++;
    }
    CHECK(met > 200);
    CHECK_EQ(task_status(&pc.mcc), TASK_STOPPED);
    CHECK(memcmp(pc.mcc.written.place, seen.point[seen.n - 1].place, 48) == 0);
}

static void each_limit_by_a_program(void)
{
    struct machine m = mcc_machine();

    preview(&m, "G1 X50 F3000\nG4 P0.5\nM2");
    CHECK(near(time_of(LIMITED_FEED, 0), 0.9));
    CHECK(near(time_of(LIMITED_ACCELERATION, 0), 0.1));
    CHECK(near(time_of(LIMITED_STOP, 0), 0.1));
    CHECK(near(time_of(LIMITED_DWELL, 0), 0.5));
    CHECK(near(seen.n * 1.024e-3, 1.6));

    preview(&m, "G0 Y250\nM2");
    CHECK(near(time_of(LIMITED_SPEED, 2), 0.4));
    CHECK(time_of(LIMITED_FEED, -1) == 0.0);

    preview(&m, "G1 X250 F60000\nM2"); /* above what the motor can */
    CHECK(near(time_of(LIMITED_SPEED, 1), 0.4));

    preview(&m, "G64 P0.01 F6000\nG1 X20\nY20\nX0\nM2");
    CHECK(time_of(LIMITED_CORNER, 0) > 0.1);
    CHECK(near(time_of(LIMITED_STOP, -1), 0.1));

    /* Braking to another feed, 90 mm before a corner, is no corner's doing: 0.1 s and 0.09 s. */
    preview(&m, "G64 P0.01 F6000\nG1 X20\nX110 F600\nY20\nM2");
    CHECK(time_of(LIMITED_ACCELERATION, -1) > 0.188 && time_of(LIMITED_CORNER, -1) > 0.01);

    preview(&m, "G64 P0.01 F6000\nG2 I0.5\nG2 I0.5\nG2 I0.5\nG2 I0.5\nM2"); /* a = v^2/r */
    const double round = 4.0 * 3.14159 / sqrt(1000.0 * 0.5); /* radius 0.5 mm at 1000 mm/s^2 */
    CHECK(fabs(time_of(LIMITED_ACCELERATION, -1) - round) < 0.02);
    CHECK(time_of(LIMITED_FEED, -1) == 0.0);
}

/* Half of an S-shaped ramp is at constant acceleration. */
static void jerk_of_ramps(void)
{
    struct machine m = mcc_machine();

    m.acc_type = m.dec_type = 'S';
    preview(&m, "G1 X50 F3000\nM2");
    CHECK(near(time_of(LIMITED_JERK, 0), 0.05));
    CHECK(near(time_of(LIMITED_ACCELERATION, 0), 0.05));
    CHECK(near(time_of(LIMITED_STOP, 0), 0.1));
}

/* On a smooth path each axis has limits of its own. */
static void limits_of_axes_on_curves(void)
{
    struct machine m = mcc_machine();

    for (int i = 0; i < 3; i++) {
        m.axis[i].acc = i == 1 ? 200.0 : 2000.0;
    }
    preview(&m, "G64 P0.05 F6000\nG1 Y40\nM2"); /* 100 mm/s by 200 mm/s^2 takes half a second */
    CHECK(time_of(LIMITED_ACCELERATION, 2) > 0.3);
    CHECK(time_of(LIMITED_ACCELERATION, 1) == 0.0 && time_of(LIMITED_ACCELERATION, 3) == 0.0);
    m.axis[1].jerk = 500.0;
    preview(&m, "G64 P0.05 F6000\nG1 Y40\nM2");
    CHECK(time_of(LIMITED_JERK, 2) > 0.3);
}

/* What waits for the operator, an input or a probe takes no time; a fault and a limit are told. */
static void waits_and_ends(void)
{
    const struct machine m = mcc_machine();
    static struct mcc open;

    CHECK_EQ(preview(&m, "G1 X1 F600\nM0\nM66 P0 L3 Q5\nG38.3 X2\nM2"), PREVIEW_DONE);
    CHECK(seen.point[seen.n - 1].place[0] == 2.0);
    CHECK(near(seen.n * 1.024e-3, 0.4));
    struct source_text t = { "G1 X100 F600\nM2", 15 };
    const struct source s = source_of(&t);
    CHECK_EQ(MCC_init_motion(&open, &m), MCC_NO_ERR);
    seen.n = 0;
    CHECK_EQ(preview_run(&open, &s, 100, note, &seen), PREVIEW_LONG);
    CHECK_EQ(seen.n, 100);
}

int main(void)
{
    points_are_those_of_a_run();
    each_limit_by_a_program();
    jerk_of_ramps();
    limits_of_axes_on_curves();
    waits_and_ends();
    return check_result();
}
