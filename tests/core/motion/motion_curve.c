/* Curves without a mover: single block and what comes of it, places that are put back, extents. */
#include <math.h>
#include <string.h>

#include "check.h"
#include "curve.h"

static const double DT = 1e-3, FEED = 50.0, ACC = 1000.0;

static struct ring ring;
static struct curve_plan plan;
static struct curve curve;
static double at[AXES];
static int32_t sent, seen;

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
    sent = seen = 0;
}

/* Staircase of so many steps of one length, each a line of the program. */
static void stairs(int count, double size)
{
    for (int i = 0; i < count; i++) {
        send(i + 1, at[0] + (i % 2 == 0 ? size : 0.0), at[1] + (i % 2 == 1 ? size : 0.0));
    }
}

/* One point; commands that begin are counted, in their order. Returns the time left. */
static double tick(double override)
{
    const struct shape_mark *k;
    const double left = curve_advance(&curve, &plan, &ring, override, DT);

    curve_sample(&curve, &plan);
    while ((k = curve_begun(&curve, &plan)) != NULL) {
        CHECK_EQ(k->index, ++seen);
        CHECK(k->at <= curve.start + curve.place.way + 1e-9 || curve_done(&curve, &plan));
    }
    curve_drop(&curve, &plan);
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

/* From any place of the staircase to the first corner that it can rest before, then from corner
 * to corner; the tool rests on the middle of each. */
static void blocks(void)
{
    for (int n = 5; n < 400; n += 37) {
        begin();
        stairs(12, 3.0);
        plan.last = true;
        curve_start(&curve, &plan, &ring);
        for (int i = 0; i < n; i++) {
            tick(1.0);
        }
        const int32_t before = seen;
        const double room = 3.0 * before - (fabs(curve.point[0]) + fabs(curve.point[1]));
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
            CHECK_EQ(tick(1.0), 0.0);       /* it stays */
            CHECK(curve_waits(&curve));
        }
        CHECK_EQ(seen, 12);
        CHECK_NEAR(curve.point[0], at[0], 0.0);
        CHECK_NEAR(curve.point[1], at[1], 0.0);
    }
}

/* Single block that is switched off again before the goal, or while it waits for none, changes
 * nothing but what it has closed. */
static void off(void)
{
    int direct, there;

    begin();
    stairs(12, 3.0);
    plan.last = true;
    curve_start(&curve, &plan, &ring);
    direct = go_on();
    begin();
    stairs(12, 3.0);
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
    static const int first = SHAPE_PIECES / 2;
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

int main(void)
{
    blocks();
    off();
    unknown_block();
    return check_result();
}
