/* Curves by themselves: single block and what comes of it, places that are put back, extents. */
#include <math.h>
#include <string.h>

#include "check.h"
#include "curve.h"

static const double DT = 1e-3, FEED
= 50.0, ACC = 1000.0;

static struct ring ring;
static struct curve_plan plan;
static struct curve curve;
static double at[AXES];
static int32_t sent, seen;
static double steepest;      /* acceleration, of that of the ramp */
static double last[2][AXES]; /* [mm] the two points before */

/* A line of a program. */
static void send(int32_t line, double x, double y)
{
    struct command c;

    memset(&c, 0, sizeof c);
    c.type = COMMAND_LINE;
    c.index = ++sent;
    c.line = line;
    c.curve = true;
    c.tolerance = 0.02;
    c.merge = 0.02;
    c.feed = FEED;
    c.cap = 2.0 * FEED;
    c.ramp = (struct ramp_limits){ ACC, ACC, 0.0, 0.0 };
    const double end[AXES] = { x, y };
    path_line(&c.path, at, end);
    memcpy(at, end, sizeof at);
    ring_push(&ring, &c);
}

static void begin(void)
{
    ring_clear(&ring);
    memset(&plan, 0, sizeof plan);
    memset(at, 0, sizeof at);
    memset(last, 0, sizeof last);
    sent = seen = 0;
    steepest = sqrt(2.0);
}

/* Staircase of so many steps of one length, each a line of the program. */
static void stairs(int count, double size)
{
    for (int i = 0; i < count; i++) {
        send(i + 1, at[0] + (i % 2 == 0 ? size : 0.0), at[1] + (i % 2 == 1 ? size : 0.0));
    }
}

/* The same straight on. */
static void row(int count, double size)
{
    for (int i = 0; i < count; i++) {
        send(i + 1, at[0] + size, at[1]);
    }
}

/* One point; commands that begin are counted, in their order, and the acceleration is that of the
 * ramp along and across the path. Returns the time left. */
static double tick(double override)
{
    const struct shape_mark *k;
    double left = curve_advance(&curve, &plan, &ring, override, DT);

    if (left > 0.0 && !curve_done(&curve, &plan)) { /* the ring is empty, and stays so */
        left = curve_advance(&curve, &plan, &ring, override, left);
    }
    curve_sample(&curve, &plan);
    while ((k = curve_begun(&curve, &plan)) != NULL) {
        CHECK_EQ(k->index, ++seen);
        CHECK(k->at <= curve.start + curve.place.way + 1e-9 || curve_done(&curve, &plan));
    }
    curve_drop(&curve, &plan);
    const double a[2] = { curve.point[0] - 2.0 * last[0][0] + last[1][0],
                          curve.point[1] - 2.0 * last[0][1] + last[1][1] };
    CHECK(hypot(a[0], a[1]) <= steepest * ACC * DT * DT * (1.0 + 1e-6) + 1e-12);
    memcpy(last[1], last[0], sizeof last[1]);
    memcpy(last[0], curve.point, sizeof last[0]);
    return left;
}

/* Until it waits or is done; returns the points that took. */
static int go_on(void)
{
    int n = 0;

    do {
        tick(1.0);
    } while (++n < 100000 && !curve_waits(&curve) && !curve_done(&curve, &plan));
    return n;
}

/* [mm] Of the tool's way up to one of the chain, in the middle of short parts: a corner is shorter
 * than its parameter. */
static double length_to(double goal)
{
    const int parts = 1000;
    double base = curve.base, way = curve.start + curve.place.way, sum = 0.0;

    for (int i = curve.at; way < goal; i++) {
        const struct segment *p = shape_segment(&plan.shape, i);
        const double part = (fmin(goal, base + p->length) - way) / parts;
        for (int k = 0; k < parts; k++) {
            struct segment_state s;
            segment_at(p, way - base + part * (k + 0.5), &s);
            sum += part * hypot(s.slope[0], s.slope[1]);
        }
        base += p->length;
        way = base;
    }
    return sum;
}

/* From any place of the staircase to the first corner that it can rest before, then from corner
 * to corner; the tool rests on the middle of each. Along the path it brakes as the ramp says. */
static void blocks(void)
{
    for (int n = 5; n < 400; n += 7) {
        begin();
        stairs(12, 3.0);
        plan.last = true;
        curve_start(&curve, &plan, &ring);
        for (int i = 0; i < n; i++) {
            tick(1.0);
        }
        const int32_t before = seen;
        const double room = length_to(3.0 * before);
        const double v = hypot(curve.velocity[0], curve.velocity[1]);
        curve_single(&curve, &plan, true);
        go_on();
        const double need = 0.5 * v * v / ACC;
        CHECK(seen == before + (room < need) || (seen == before + 1 && room < 1.03 * need + 0.01));
        for (; !curve_done(&curve, &plan); curve_go(&curve, &plan, true), go_on()) {
            CHECK(curve_waits(&curve) && curve_rests(&curve));
            const double x = 3.0 * ((seen + 1) / 2), y = 3.0 * (seen / 2);
            CHECK(hypot(curve.point[0] - x, curve.point[1] - y) < 0.02);
            CHECK(hypot(curve.point[0] - x, curve.point[1] - y) > 0.005);
            CHECK_EQ(tick(1.0), 0.0); /* it stays */
            CHECK(curve_waits(&curve));
        }
        CHECK_EQ(seen, 12);
        CHECK_NEAR(curve.point[0], at[0], 0.0);
        CHECK_NEAR(curve.point[1], at[1], 0.0);
    }
}

/* Single block that is switched off again before the goal, or while it waits for none, changes
 * nothing but what it has closed; also where the goal was the end of a segment. */
static void off(void (*way)(int count, double size))
{
    int direct, there;

    begin();
    way(12, 3.0);
    plan.last = true;
    curve_start(&curve, &plan, &ring);
    direct = go_on();
    begin();
    way(12, 3.0);
    plan.last = true;
    curve_start(&curve, &plan, &ring);
    for (int i = 0; i < 20; i++) {
        tick(1.0);
    }
    curve_single(&curve, &plan, true);
    tick(1.0);
    curve_single(&curve, &plan, false);
    there = 21 + go_on();
    CHECK(curve_done(&curve, &plan));
    CHECK(direct - 2 <= there && there <= direct + 2);
    CHECK_EQ(seen, 12);
}

/* Corners of one block fill the shape: where the next block begins is not known while it has no
 * room for what is before. Single block waits for that. */
static void unknown_block(void)
{
    static const int first = SHAPE_SEGMENTS / 2;
    int told = 0;

    begin();
    for (int i = 0; i < 20000 && plan.shape.marks <= first; i++) {
        for (; !ring_full(&ring); told++) {
            send(told < first ? 1 : 2, at[0] + 0.4, 0.4 * (told % 2));
        }
        if (i == 0) {
            curve_start(&curve, &plan, &ring);
        }
        tick(1.0);
    }
    CHECK_EQ(plan.shape.marks, first + 1);
    CHECK(plan.shape.marks_set < plan.shape.marks);
    curve_single(&curve, &plan, true);
    go_on();
    CHECK(curve_waits(&curve));
    CHECK_EQ(seen, first);
}

/* Lines in a row as one: a block that begins where a segment does is stopped at to the bit. Calls,
 * without a line of a program, are blocks of their own. */
static void in_a_row(int32_t line)
{
    begin();
    for (int i = 0; i < 5; i++) {
        send(line * (i + 1), at[0] + 3.0, 0.0);
    }
    plan.last = true;
    curve_start(&curve, &plan, &ring);
    tick(1.0);
    curve_single(&curve, &plan, true);
    for (int i = 1; i < 5; i++) {
        go_on();
        CHECK(curve_waits(&curve));
        CHECK_EQ(seen, i);
        CHECK_NEAR(curve.point[0], 3.0 * i, 1e-12);
        curve_go(&curve, &plan, true);
    }
    go_on();
    CHECK(curve_done(&curve, &plan));
    CHECK_NEAR(curve.point[0], 15.0, 0.0);
}

/* A block of two lines is one; what has been switched off while it waits goes on to the end. */
static void two_lines(void)
{
    begin();
    for (int i = 0; i < 6; i++) {
        send(1 + i / 2, at[0] + 3.0, 0.0);
    }
    plan.last = true;
    curve_start(&curve, &plan, &ring);
    tick(1.0);
    curve_single(&curve, &plan, true);
    go_on();
    CHECK_EQ(seen, 2);
    curve_single(&curve, &plan, false);
    CHECK(curve_waits(&curve));
    curve_go(&curve, &plan, false);
    go_on();
    CHECK(curve_done(&curve, &plan) && seen == 6);
}

/* Where the motion was is put back: what has been planned ahead, over ends of segments and cells,
 * is driven to the bit as without. */
static void put_back(void)
{
    static struct curve direct[2000];
    int count = 0;

    for (int ahead = 0; ahead < 2; ahead++) {
        begin();
        stairs(12, 3.0);
        plan.last = true;
        curve_start(&curve, &plan, &ring);
        for (int i = 0; i < 2000 && !curve_done(&curve, &plan); i++) {
            const struct curve before = curve;
            for (int k = 0; ahead && k < i % 60; k++) {
                curve_advance(&curve, &plan, &ring, 1.0, DT);
            }
            curve = ahead ? before : curve;
            tick(1.0);
            if (ahead) {
                CHECK(memcmp(curve.point, direct[i].point, sizeof curve.point) == 0);
            } else {
                direct[i] = curve;
            }
            count += ahead;
        }
    }
    CHECK(count > 900);
    printf("%d points put back\n", count);
}

/* Commands that come late: the chain takes them while it has time, and ends when it would have to
 * brake within 0.05 s for want of them. An override of 0 takes none. */
static void late(void)
{
    double room = 0.0;
    int n = 0;

    begin();
    stairs(20, 3.0);
    curve_start(&curve, &plan, &ring);
    CHECK_NEAR(curve_advance(&curve, &plan, &ring, 0.0, DT), 0.0, 0.0);
    CHECK_EQ(ring.count, 20);
    CHECK_NEAR(curve_advance(&curve, &plan, &ring, 1.0, DT), DT, 0.0);
    CHECK_EQ(ring.count, 0);
    for (; n < 300; n++) {
        tick(1.0);
    }
    CHECK(!curve.closed);
    stairs(20, 3.0);
    for (; !curve.closed && n < 20000; n++) {
        room = plan.profile.end - speed_profile_stop_way(&plan.profile);
        const bool starves = ring.count == 0 && room <= 0.05 * curve.place.rate;
        tick(1.0);
        CHECK(curve.closed == starves);
    }
    CHECK(n > 1000 && room < 0.05 * FEED + 0.1);
    go_on();
    CHECK_EQ(seen, 40);
    CHECK_NEAR(curve.point[0], at[0], 0.0);
}

/* Commands that come one by one, at each point one: the chain does not end before they do. */
static void in_time(void)
{
    begin();
    send(1, 3.0, 0.0);
    curve_start(&curve, &plan, &ring);
    while (sent < 30) {
        tick(1.0);
        CHECK(!curve.closed);
        send(sent + 1, at[0] + (sent % 2 == 0 ? 3.0 : 0.0), at[1] + (sent % 2 == 1 ? 3.0 : 0.0));
    }
    plan.last = true;
    go_on();
    CHECK_EQ(seen, 30);
    CHECK_NEAR(curve.point[0], at[0], 0.0);
    CHECK_NEAR(curve.point[1], at[1], 0.0);
}

/* What begins a curve. */
static void begins(void)
{
    begin();
    CHECK(!curve_begins(&ring));
    send(1, 1.0, 0.0);
    CHECK(curve_begins(&ring));
    ring_at(&ring, 0)->command.tolerance = 0.0;
    CHECK(!curve_begins(&ring));
    ring_at(&ring, 0)->command.tolerance = 0.02;
    ring_at(&ring, 0)->command.curve = false;
    CHECK(!curve_begins(&ring));
    ring_at(&ring, 0)->command.curve = true;
    ring_at(&ring, 0)->command.type = COMMAND_PTP;
    CHECK(!curve_begins(&ring));
}

/* Another tolerance of runs is another chain. */
static void other_merge(void)
{
    begin();
    send(1, 3.0, 0.0);
    send(2, 6.0, 0.0);
    ring_at(&ring, 1)->command.merge = 0.01;
    curve_start(&curve, &plan, &ring);
    go_on();
    CHECK_EQ(ring.count, 1);
    CHECK_NEAR(curve.point[0], 3.0, 0.0);
}

/* To and fro in X over corners that reach out on either side. */
static void zigzag(int count)
{
    for (int i = 0; i < count; i++) {
        send(i + 1, i % 2 == 0 ? 2.0 : 0.0, at[1] + 1.0);
    }
}

/* Coordinates of the tool's way up to one of the chain, in small steps: 1 nm and less is missed. */
static void look_to(double goal, double min[2], double max[2])
{
    const int steps = 4000;
    double base = curve.base, way = curve.start + curve.place.way;

    memcpy(min, curve.point, 2 * sizeof *min);
    memcpy(max, curve.point, 2 * sizeof *max);
    for (int i = curve.at; way < goal; i++) {
        const struct segment *p = shape_segment(&plan.shape, i);
        const double part = fmin(goal, base + p->length) - way;
        for (int n = 1; n <= steps; n++) {
            struct segment_state s;
            segment_at(p, way - base + part * n / steps, &s);
            for (int k = 0; k < 2; k++) {
                min[k] = fmin(min[k], s.point[k]);
                max[k] = fmax(max[k], s.point[k]);
            }
        }
        base += p->length;
        way = base;
    }
}

/* The extent of the way to rest is that of the path up to there, held against it in small steps;
 * also of a chain that began anew before a block. A hold at short points rests there or before: in
 * the corner, where x halves several times, by 10 um at most. */
static void extent(void)
{
    double most = 0.0;

    for (int n = 10; n < 700; n += 3) {
        begin();
        zigzag(12);
        plan.last = true;
        curve_start(&curve, &plan, &ring);
        if (n % 2 == 1) {
            tick(1.0);
            curve_single(&curve, &plan, true);
            go_on();
            curve_go(&curve, &plan, false);
        }
        for (int i = 0; i < n; i++) {
            tick(1.0);
        }
        double low[AXES], high[AXES], min[2], max[2];
        const double stop = plan.start + speed_profile_stop_way(&plan.profile);
        curve_stop_extent(&curve, &plan, low, high);
        look_to(stop, min, max);
        for (int k = 0; k < 2; k++) {
            CHECK(low[k] <= min[k] && low[k] > min[k] - 3e-6);
            CHECK(high[k] >= max[k] && high[k] < max[k] + 3e-6);
        }
        while (!curve_rests(&curve)) {
            curve_advance(&curve, &plan, &ring, 0.0, 0.02 * DT);
            curve_sample(&curve, &plan);
            for (int k = 0; k < 2; k++) {
                CHECK(low[k] <= curve.point[k] && curve.point[k] <= high[k]);
            }
        }
        most = fmax(most, stop - curve.start - curve.place.way);
        CHECK(stop - curve.start - curve.place.way > -1e-9);
    }
    CHECK(most < 0.015 && most > 1e-3);
    printf("rests up to %.1f um before it is told\n", 1e3 * most);
}

/* Where the path turns back it rests and goes on by itself; a hold there stays. A point that is put
 * back over that rest begins there, the first one where it began. */
static void turn_back(void)
{
    struct curve before;
    int held = 0;

    begin();
    steepest = 2.0; /* one point is driven twice */
    send(1, 3.0, 0.0);
    send(2, 6.0, 0.0);
    send(3, 3.0, 0.0);
    send(4, -3.0, 0.0);
    send(5, 1.0, 0.0);
    plan.last = true;
    curve_start(&curve, &plan, &ring);
    while (!curve_done(&curve, &plan)) {
        before = curve;
        curve_advance(&curve, &plan, &ring, 1.0, DT);
        curve = before;
        if (curve.point[0] == 6.0 && held < 5) {
            tick(0.0);
            CHECK(++held == 1 || curve.point[0] == 6.0);
        }
        tick(1.0);
        CHECK(curve.point[0] <= 6.0);
    }
    CHECK_EQ(seen, 5);
    CHECK_NEAR(curve.point[0], 1.0, 0.0);
}

int main(void)
{
    turn_back();
    begins();
    other_merge();
    late();
    in_time();
    in_a_row(1);
    in_a_row(0);
    two_lines();
    put_back();
    extent();
    blocks();
    off(stairs);
    off(row);
    unknown_block();
    return check_result();
}
