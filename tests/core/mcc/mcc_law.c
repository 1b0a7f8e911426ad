/* The control law: pre-filter, feed-forward and cross-coupled control against closed formulas, and
 * on the PC: the speed fed forward is that of the frame being put out. */
#include "law.h"
#include "mcc_card.h"

#include <stdlib.h>

static struct law_config config(void)
{
    struct law_config c = { .period = 1e-4, .pulses_per_mm = { 1000.0, 1000.0, 1000.0 } };

    for (int i = 0; i < 3; i++) {
        c.axis[i] = (struct law_axis){ .on = true, .gain = 1e-3, .volts = 2e-5 };
    }
    return c;
}

/* Alone, the P law is gain times counts to the bit, whatever pulses and speeds are. */
static void p_law_alone(uint64_t seed)
{
    const struct law_config c = config();
    struct law s = { 0 };

    for (int n = 0; n < 1000; n++) {
        struct law_look look = { 0 };
        double volts[AXES] = { 0.0, 0.0, 0.0, 7.0, 7.0, 7.0 };
        for (int i = 0; i < AXES; i++) {
            look.error[i] = (int32_t)check_random(&seed, -20000, 20000);
            look.pulses[i] = (int32_t)check_random(&seed, -1000000, 1000000);
            look.speed[i] = check_real(&seed, -1e5, 1e5);
        }
        law_tick(&c, &s, &look, 10.0, volts);
        for (int i = 0; i < 3; i++) {
            CHECK(volts[i] == fmax(-10.0, fmin(10.0, 1e-3 * look.error[i])));
            CHECK(volts[i + 3] == 7.0);
        }
    }
}

/* c(t) = v t from rest: c - F(c) = v tau (1 - exp(-t/tau)) at every sample, and F(c') its share.
 * Then at rest, to the bit. */
static void prefilter_is_exact(void)
{
    struct law_config c = config();
    struct law s = { 0 };
    struct law_look look = { 0 };
    const double tau = 8.3e-3, per = 7.0; /* [pulses/period] */
    double volts[AXES];

    c.axis[0].lag = tau;
    c.axis[0].feed_forward = 0.5;
    law_tick(&c, &s, &look, 10.0, volts);
    look.speed[0] = per / c.period;
    for (int n = 1; n <= 2000; n++) {
        look.pulses[0] = (int32_t)(per * n);
        const double before = s.behind[0]; /* the error counter is as old */
        law_tick(&c, &s, &look, 10.0, volts);
        const double full = 1.0 - exp(-n * c.period / tau);
        CHECK_NEAR(s.behind[0], per / c.period * tau * full, 1e-9 * per / c.period * tau);
        CHECK_NEAR(s.speed[0], per / c.period * full, 1e-9 * per / c.period);
        CHECK_NEAR(volts[0], 2e-5 * 0.5 * s.speed[0] - 1e-3 * before, 1e-12);
    }
    look.speed[0] = 0.0;
    for (int n = 0; n < 3000; n++) {
        law_tick(&c, &s, &look, 10.0, volts);
        CHECK(n * c.period < 10.0 * tau || s.behind[0] < 0.5);
    }
    CHECK(s.behind[0] == 0.0 && s.speed[0] == 0.0);
    look.error[0] = 3;
    law_tick(&c, &s, &look, 10.0, volts);
    CHECK(volts[0] == 1e-3 * 3);
}

/* A counter that wraps is no motion of 2^32 pulses. */
static void pulses_wrap(void)
{
    struct law_config c = config();
    struct law s = { 0 };
    struct law_look look = { .pulses = { INT32_MAX - 1 } };
    double volts[AXES];

    c.axis[0].lag = 1e-2;
    law_tick(&c, &s, &look, 10.0, volts);
    look.pulses[0] = INT32_MIN + 1;
    law_tick(&c, &s, &look, 10.0, volts);
    CHECK_NEAR(s.behind[0], 3.0, 0.02);
}

/* W(e) along the normal, left stays left round a corner; the integral waits at the limit. */
static void cross_coupling(void)
{
    struct law_config c = config();
    struct law s = { 0 };
    struct law_look look = { .foot = { { 0.0, 0.02, 0.0 }, { 1.0, 0.0, 0.0 } } };
    double volts[AXES];

    c.cross_p = 50.0;
    c.cross_i = 400.0;
    CHECK(law_crosses(&c));
    for (int n = 1; n <= 100; n++) {
        law_tick(&c, &s, &look, 10.0, volts);
        const double speed = 50.0 * 0.02 + 400.0 * 0.02 * n * 1e-4;
        CHECK_NEAR(volts[1], 2e-5 * 1000.0 * speed, 1e-12);
        CHECK_NEAR(volts[0], 0.0, 1e-15);
    }
    /* the path turns left: the normal to the left is now -X */
    look.foot = (struct commanded_path_foot){ { 0.0 }, { 0.0, 1.0, 0.0 } };
    law_tick(&c, &s, &look, 10.0, volts);
    CHECK_NEAR(volts[0], -2e-5 * 1000.0 * 400.0 * 0.02 * 100 * 1e-4, 1e-12);
    CHECK_NEAR(volts[1], 0.0, 1e-15);
    /* round a circle in a thousand steps the integral keeps its size */
    for (int n = 1; n <= 1000; n++) {
        const double a = acos(-1.0) * (0.5 + n * 2e-3);
        look.foot = (struct commanded_path_foot){ { 0.0 }, { cos(a), sin(a), 0.0 } };
        law_tick(&c, &s, &look, 10.0, volts);
    }
    CHECK_NEAR(s.sum[0], -0.02 * 100 * 1e-4, 1e-15);
    /* at the limit it waits */
    look.foot.error[0] = -1.0;
    look.error[0] = -20000;
    for (int n = 0; n < 1000; n++) {
        law_tick(&c, &s, &look, 10.0, volts);
        CHECK(volts[0] == -10.0);
    }
    CHECK_NEAR(s.sum[0], -0.02 * 100 * 1e-4, 1e-15);
    /* rate of the error */
    c = config();
    c.cross_d = 0.5;
    s = (struct law){ 0 };
    look = (struct law_look){ .foot = { { 0.0, 0.02, 0.0 }, { 1.0, 0.0, 0.0 } } };
    law_tick(&c, &s, &look, 10.0, volts);
    CHECK_NEAR(volts[1], 0.0, 0.0);
    look.foot.error[1] = 0.021;
    law_tick(&c, &s, &look, 10.0, volts);
    CHECK_NEAR(volts[1], 2e-5 * 1000.0 * 0.5 * 0.001 / 1e-4, 1e-12);
}

/* An axis beside X Y Z at its limit does not keep the path's integral waiting; one of them does. */
static void limit_beside_the_path(void)
{
    for (int axis = 0; axis < AXES; axis++) {
        struct law_config c = config();
        struct law s = { 0 };
        struct law_look look = { .foot = { { 0.0, 0.02, 0.0 }, { 1.0, 0.0, 0.0 } } };
        double volts[AXES];
        c.cross_i = 400.0;
        for (int i = 3; i < AXES; i++) {
            c.axis[i] = (struct law_axis){ .on = true, .gain = 1e-3, .volts = 2e-5 };
        }
        look.error[axis] = 20000;
        for (int n = 1; n <= 50; n++) {
            law_tick(&c, &s, &look, 10.0, volts);
            CHECK(volts[axis] == 10.0);
        }
        CHECK_NEAR(s.sum[1], axis < 3 ? 0.0 : 0.02 * 50 * c.period, 1e-15);
    }
}

/* On the PC: at every bus instant the speed is that of the frame the DDA is putting out, within
 * the pulse to which frames are rounded; and its sum is the way. */
static void speed_of_the_frame(bool inverted)
{
    struct machine m = mcc_machine();
    struct pc_panel panel = { .override = 1.0, .rapid = 1.0 };
    struct pc_config p = { .bus = 4000,
                           .ipo = 40000,
                           .latency = 8000,
                           .seed = 1,
                           .min_stock = 3,
                           .batch = 4,
                           .output_mode = { 2, 2, 2 } };
    struct card c;
    int32_t sum = 0, frame = 0;
    int64_t moved = 0;
    double way = 0.0, fastest = 0.0;
    const double scale = 1e-4;

    for (int i = 0; i < 3; i++) {
        p.law.axis[i] = (struct law_axis){ .volts = scale, .feed_forward = 1.0 };
    }
    m.axis[0].inverted = inverted;
    card_start(&c, &m, &p, true);
    for (int k = 0; k < 12000; k++) {
        card_period(&c, k * p.bus, &panel, "G61 G1 X20 Y5 F3000\nX0 Y3\nM2\n");
        const double speed = pc.volts[0] / scale * 1.024e-3; /* [pulses/frame] */
        CHECK(fabs(speed - frame) < 1.0);
        way += speed * (double)p.bus / (double)machine_dda_clocks(&m);
        fastest = fmax(fastest, fabs(speed));
        moved += frame != 0;
        if (c.sum[0] != sum || c.now % c.dda < p.bus) {
            frame = c.sum[0] - sum; /* a boundary was passed */
            sum = c.sum[0];
        }
    }
    CHECK(pc_done(&pc) && moved > 8000);
    CHECK_NEAR(way, 0.0, 60.0); /* sampled: a boundary lies up to a tenth of a frame off */
    CHECK_NEAR(fastest, 50.0 * 1.024 * 20.0 / hypot(20.0, 2.0), 0.02);
}

/* A tool that is where the pulses are has no contour error but rounding, with a compensation of 60
 * pulses, an axis turned round, and after an emergency stop that lost what was in the FIFO. */
static void tool_on_the_path(bool stops)
{
    static struct comp_table table = { .interval = 2000, .home = 100 };
    struct machine m = mcc_machine();
    struct pc_panel panel = { .override = 1.0, .rapid = 1.0 };
    struct pc_config p = { .bus = 4000,
                           .ipo = 40000,
                           .latency = 8000,
                           .seed = 1,
                           .min_stock = 3,
                           .batch = 4,
                           .output_mode = { 2, 2, 2 } };
    struct card c;
    double most = 0.0, off = 0.0;

    for (int i = 0; i < 3; i++) {
        p.law.axis[i] = (struct law_axis){ .volts = 1e-3 };
    }
    for (int i = 0; i < COMP_POINTS; i++) {
        table.forward[i] = i < 100 ? 0 : 6 * (i - 100);
        table.backward[i] = table.forward[i] - 10;
    }
    p.law.cross_p = 1.0; /* a volt per mm at 1000 pulses/mm */
    m.axis[0].inverted = true;
    card_start(&c, &m, &p, true);
    CHECK_EQ(MCC_set_comp(&pc.mcc, 0, &table), 0);
    for (int k = 0; k < 20000; k++) {
        panel.signals.stop = stops && k >= 3000 && k < 3500;
        panel.clear_error = stops && k >= 4000;
        panel.cycle_start = stops && k >= 4500;
        memcpy(panel.signals.pulses, c.sum, sizeof c.sum);
        if (panel.signals.stop) {
            c.stock = 0;
        }
        card_period(&c, k * p.bus, &panel, "G61 G1 F3000\nG2 X20 Y0 I10\nG3 X5 Y5 R40\nM2\n");
        most = fmax(most, hypot(pc.volts[0], pc.volts[1]));
        off = fmax(off, fabs((double)pc.mcc.written.added[0]));
    }
    CHECK(pc_done(&pc));
    CHECK(off > 55.0);
    CHECK(most > 1e-5 && most < 4e-3); /* [V]: 4 pulses */
}

int main(void)
{
    p_law_alone(9);
    prefilter_is_exact();
    pulses_wrap();
    cross_coupling();
    limit_beside_the_path();
    speed_of_the_frame(false);
    speed_of_the_frame(true);
    tool_on_the_path(false);
    tool_on_the_path(true);
    return check_result();
}
