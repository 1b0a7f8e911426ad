/* Chains of look-ahead as their commands come: few or many known, of any feed, refused by the
 * card. And the limits that wait behind each other. */
#include "brake.h"
#include "mcc_chain.h"

enum { COUNT = 200 };

/* A zigzag, short pieces in turn with long ones, every seventh an arc. */
static void send(uint64_t *seed, int i, double at[AXES], struct path *side)
{
    const double size = i % 50 < 25 ? 0.3 : 8.0;
    const double a = check_real(seed, 0.2, 1.0) * size, b = check_real(seed, -1.0, 1.0) * size;
    const double end[AXES] = { at[0] + a, at[1] + b };
    const double via[2] = { at[0] + 0.5 * a + 0.1 * b, at[1] + 0.5 * b - 0.1 * a };

    if (i % 7 == 6) {
        double centre[2], miss;
        bool ccw;
        CHECK(MCC_arc_xy(&m, via[0], via[1], end[0], end[1]) > 0);
        path_centre_by_point(PATH_XY, at, via, end, centre, &ccw);
        path_arc(side, PATH_XY, at, end, centre, ccw, 1, &miss);
    } else {
        CHECK(MCC_line(&m, end) > 0);
        path_line(side, at, end);
    }
    memcpy(at, end, AXES * sizeof *at);
}

/* It with at most `keep` commands in the ring: limits and tolerance hold. Returns its time. */
static double filled(int keep, bool smooth)
{
    static struct path side[COUNT];
    const double feed = 60.0, tolerance = 0.02;
    const struct limits l = limits_at(feed, smooth);
    struct record r = { 0 };
    struct stream x = { 0 };
    double at[AXES] = { 0 }, x0[3] = { 0 }, v0[3] = { 0 };
    uint64_t seed = 11;
    int sent = 0;
    begin(mcc_machine());
    smooth_ramps(smooth);
    MCC_set_fspd(&m, feed);
    CHECK_EQ(mcc_set_tolerance(&m, tolerance), 0);
    for (;;) {
        for (; sent < COUNT && m.ring.count < keep; sent++) {
            send(&seed, sent, at, &side[sent]);
        }
        const int chain = m.trajectory.motion == TRAJECTORY_CHAIN ? chain_number() : 0;
        if (!point(&r)) {
            break;
        }
        x.n = chain && m.trajectory.motion == TRAJECTORY_CHAIN && chain == chain_number() ? x.n : 0;
        if (m.trajectory.motion == TRAJECTORY_CHAIN) {
            look(&x, way_of_tool(), &l);
        }
        double change = 0.0, d = INFINITY;
        for (int i = 0; i < 3; i++) {
            const double v = (r.last.place[i] - x0[i]) / DT;
            change += pow(v - v0[i], 2.0);
            v0[i] = v;
            x0[i] = r.last.place[i];
        }
        CHECK(sqrt(change) <= sqrt(2.0) * l.acc * DT + 1e-9); /* along and across */
        for (int i = r.last.command - 2; i <= r.last.command; i++) {
            d = i >= 0 && i < sent ? fmin(d, distance(&side[i], r.last.place)) : d;
        }
        CHECK(d <= tolerance * (1.0 + 1e-6));
        CHECK(r.last.feed <= feed * (1.0 + 1e-6));
    }
    CHECK(sent == COUNT && MCC_check_stop(&m));
    CHECK(r.last.place[0] == at[0] && r.last.place[1] == at[1]);
    return r.n * DT;
}

/* One command alone makes exact stops; the more are known, the sooner it is done. */
static void fillings(bool smooth)
{
    static const int keep[] = { 2, 3, 16, RING_SIZE };
    const double stops = filled(1, smooth);
    double before = INFINITY;
    for (int i = 0; i < 4; i++) {
        const double time = filled(keep[i], smooth);
        CHECK(time <= before * (1.0 + 1e-9));
        before = time;
    }
    /* Corners as sharp and as near as these leave S ramps nothing to gain. */
    CHECK_NEAR(before / stops, smooth ? 1.0 : 0.845, 0.02);
}

/* Commands of any feed that come now and then: none is driven above its feed, nothing brakes
 * harder than the hardest of them. */
static void feeds(bool smooth)
{
    const struct limits l = limits_at(100.0, smooth);
    uint64_t seed = 3;
    int fastest = 0;
    for (int i = 0; i < 20; i++) {
        struct record r = { 0 };
        struct stream x = { 0 };
        double feed[COUNT + 1] = { 0 }, size = i % 2 ? 0.3 : 4.0;
        int sent = 0;
        begin(mcc_machine());
        smooth_ramps(smooth);
        CHECK_EQ(mcc_set_tolerance(&m, 0.05), 0);
        MCC_set_inc(&m);
        while (r.n < LONGEST) {
            const int keep = (int)check_real(&seed, 1.0, 6.0);
            while (sent < COUNT && m.ring.count < keep) {
                const bool fast = check_real(&seed, 0.0, 1.0) < 0.5;
                feed[++sent] = fast ? 100.0 : check_real(&seed, 3.0, 100.0);
                MCC_set_fspd(&m, feed[sent]);
                const double a = check_real(&seed, 0.1, 1.0) * size;
                const double b = check_real(&seed, -0.1, 0.1) * size;
                CHECK(MCC_line(&m, (double[AXES]){ a, b }) > 0);
            }
            const int chain = m.trajectory.motion == TRAJECTORY_CHAIN ? chain_number() : 0;
            const int was = r.last.command;
            if (!point(&r)) {
                break;
            }
            x.n = chain && m.trajectory.motion == TRAJECTORY_CHAIN && chain == chain_number() ? x.n
                                                                                              : 0;
            if (m.trajectory.motion == TRAJECTORY_CHAIN) {
                look(&x, way_of_tool(), &l);
                /* S: the mean speed of a DDA time, part of which may lie in the one before. */
                const double most = fmax(feed[r.last.command], smooth ? feed[was] : 0.0);
                CHECK(m.trajectory.lookahead.out_v <= most * (1.0 + 1e-6));
                fastest += m.trajectory.lookahead.out_v > 0.99 * most;
            }
        }
        CHECK(sent == COUNT && MCC_check_stop(&m));
    }
    CHECK(fastest > 1000);
}

static void limit_frames(int32_t pulses)
{
    int32_t most[AXES];
    for (int i = 0; i < AXES; i++) {
        most[i] = pulses;
    }
    CHECK_EQ(MCC_set_max_dda_spd(&m, most), 0);
}

/* A frame the card cannot take: the chain comes to rest on a ramp, where its tool is. */
static void too_fast(double size)
{
    struct record r = { 0 };
    double x0 = 0.0, v0 = 0.0;
    int sent = 0;
    begin(mcc_machine());
    MCC_set_fspd(&m, 50.0);
    CHECK_EQ(mcc_set_tolerance(&m, 0.02), 0);
    limit_frames(40);
    for (;;) {
        while (m.error == 0 && !ring_full(&m.ring)) {
            sent++;
            CHECK(MCC_line(&m, (double[AXES]){ size * sent }) > 0);
        }
        if (!point(&r)) {
            break;
        }
        const double v = (r.last.place[0] - x0) / DT;
        CHECK(fabs(v - v0) <= 500.0 * DT * (1.0 + 1e-6));
        x0 = r.last.place[0];
        v0 = v;
    }
    CHECK_EQ(m.error, MCC_ERROR_SPEED);
    CHECK(v0 < 0.5);
    CHECK_NEAR(x0, 40.0 * 40.0 / 500.0, 0.15); /* up to 40 mm/s and down, less a DDA time */
}

/* In the DDA time in which a chain ends: the same. */
static void too_fast_at_end(void)
{
    struct record r = { 0 };
    struct machine machine = mcc_machine();
    machine.dda_time = 50e-3;
    machine.dec_time = 0.01;
    begin(machine);
    MCC_set_fspd(&m, 50.0);
    CHECK_EQ(mcc_set_tolerance(&m, 0.02), 0);
    limit_frames(1000);
    CHECK(MCC_line(&m, (double[AXES]){ 1.0 }) > 0);
    CHECK(MCC_line(&m, (double[AXES]){ 2.0 }) > 0);
    run(&r);
    CHECK_EQ(m.error, MCC_ERROR_SPEED);
    const double dt = machine_dda_time(&machine);
    const double v = 500.0 * dt;
    CHECK_NEAR(r.last.place[0], 0.5 * v * dt + v * v / (2.0 * 5000.0), 1e-9);
    CHECK(m.end[0] == r.last.place[0] && m.ring.count == 0);
}

struct one {
    double speed, even;
};

/* What all limits say, one by one. */
static double least(const struct one *all, int count)
{
    double v = INFINITY;
    for (int i = 0; i < count; i++) {
        v = fmin(v, all[i].speed);
    }
    return v;
}

/* Never more than all limits together; the same while there are no more than it has room for. */
static void brakes(void)
{
    enum { LIMITS = 12 };
    uint64_t seed = 9;
    for (int n = 0; n < 2000; n++) {
        const bool many = n % 2;
        const double dec = check_real(&seed, 100.0, 1000.0);
        struct one all[LIMITS + 1] = { { 0.0, 0.0 } };
        struct brake b;
        int count = 1;
        brake_rest(&b);
        while (count <= (many ? LIMITS : BRAKE_STEPS - 1)) {
            const double speed = check_real(&seed, 1.0, 60.0), way = check_real(&seed, 0.0, 0.4);
            all[count++] = (struct one){ speed, 0.05 * speed };
            brake_limit(&b, speed, 0.05 * speed);
            for (int i = 0; i < count; i++) {
                const double over = fmax(0.0, way - all[i].even);
                all[i].speed = sqrt(all[i].speed * all[i].speed + 2.0 * dec * over);
                all[i].even = fmax(0.0, all[i].even - way);
            }
            brake_back(&b, way, dec);
        }
        CHECK(b.count >= 1 && b.count <= BRAKE_STEPS);
        double got = b.step[0].speed;
        CHECK(got <= least(all, count) * (1.0 + 1e-12));
        CHECK(many || got >= least(all, count) * (1.0 - 1e-12));
        for (int i = 0; i < b.count; i++) {
            CHECK(
                i == 0
                || (b.step[i].speed > b.step[i - 1].speed && b.step[i].even > b.step[i - 1].even));
        }
    }
}

int main(void)
{
    brakes();
    fillings(false);
    fillings(true);
    feeds(false);
    feeds(true);
    too_fast(2.0);
    too_fast(0.03);
    too_fast_at_end();
    return check_result();
}
