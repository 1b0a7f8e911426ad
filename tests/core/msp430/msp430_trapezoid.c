/* TRACK: limits, landing and braking distance at every tick. */
#include "check.h"
#include "trapezoid.h"

#include <math.h>
#include <stdlib.h>

enum { ONE = 1 << TRAPEZOID_POINT };

/* The braking distance is what slowing down by a every tick covers. */
static void braking(void)
{
    uint64_t seed = 5;
    for (int i = 0; i < 3000; i++) {
        const int32_t a = (int32_t)check_random(&seed, 1, 3 * ONE);
        const int32_t v = (int32_t)check_random(&seed, 0, 2000 * (int64_t)a);
        int64_t sum = 0;
        for (int32_t u = v; u > 0; u -= a)
            sum += u;
        CHECK_EQ(trapezoid_brake(v, a), sum);
    }
    /* v^2/2a + v/2: 100 counts/tick, 0.5 counts/tick^2 */
    CHECK_EQ(trapezoid_brake(100 * ONE, ONE / 2), (int64_t)10050 * ONE);
}

/* Fewest ticks for a distance: n ticks with a trapezoid of whole steps cover at most so much. */
static int64_t reach(int64_t ticks, int32_t limit, int32_t a)
{
    int64_t sum = 0;
    for (int64_t k = 1; k <= ticks; k++) {
        const int64_t near = k < ticks + 1 - k ? k : ticks + 1 - k;
        sum += near * a < limit ? near * a : limit;
    }
    return sum;
}

static void move(int64_t from, int64_t to, int32_t limit, int32_t a)
{
    struct trapezoid t;
    trapezoid_put(&t, from);
    trapezoid_go(&t, to);
    int64_t ticks = 0, way = to > from ? 1 : -1, before = 0;
    bool slowing = false;
    while (!trapezoid_done(&t) && ticks < 200000) {
        const int64_t place = t.place;
        trapezoid_tick(&t, limit, a);
        ticks++;
        CHECK(way * t.speed >= 0 && way * t.speed <= limit);
        CHECK(llabs(t.speed - before) <= a);
        CHECK_EQ(t.speed - before, t.change);
        CHECK_EQ(t.place - place, t.speed);
        CHECK(way * (t.target - t.place) >= 0);
        CHECK(!slowing || way * t.change < 0); /* once it brakes, it brakes */
        slowing |= way * t.change < 0;
        before = t.speed;
    }
    CHECK(trapezoid_done(&t));
    CHECK_EQ(trapezoid_counts(&t), to);
    CHECK_EQ(t.place, to * ONE);
    /* The least time: one tick less would not do. The last tick only takes the speed away. */
    const int64_t distance = llabs(to - from) * ONE;
    CHECK(distance == 0 || reach(ticks - 1, limit, a) >= distance);
    CHECK(ticks < 3 || reach(ticks - 2, limit, a) < distance);
}

static void moves(void)
{
    uint64_t seed = 6;
    for (int i = 0; i < 400; i++) {
        const int32_t a = (int32_t)check_random(&seed, ONE / 50, 2 * ONE);
        const int32_t limit = (int32_t)check_random(&seed, a / 2, 60 * ONE);
        const int64_t from = check_random(&seed, -30000, 30000);
        move(from, from + check_random(&seed, -3000, 3000), limit, a);
        move(from, from + check_random(&seed, -3, 3), limit, a);
    }
    move(-1000000000, 1000000000, 1073741823, 1073741823);
    move(0, 32767, 10 * ONE, ONE / 20);
}

/* The speed limit changes as it likes, the target too: limits hold, and it lands all the same. */
static void changes(void)
{
    uint64_t seed = 7;
    for (int i = 0; i < 200; i++) {
        const int32_t a = (int32_t)check_random(&seed, ONE / 20, 2 * ONE);
        struct trapezoid t;
        trapezoid_put(&t, 0);
        trapezoid_go(&t, check_random(&seed, -5000, 5000));
        int32_t limit = 30 * ONE, before = 0;
        for (int k = 0; k < 1000; k++) {
            if (k % 50 == 0 && k < 600)
                limit = (int32_t)check_random(&seed, 0, 40 * ONE);
            if (k % 170 == 169)
                trapezoid_go(&t, check_random(&seed, -5000, 5000));
            trapezoid_tick(&t, limit, a);
            CHECK(abs(t.speed - before) <= a);
            CHECK(abs(t.speed) <= (abs(before) > limit ? abs(before) : limit));
            before = t.speed;
        }
        for (int k = 0; k < 30000 && !trapezoid_done(&t); k++)
            trapezoid_tick(&t, 30 * ONE, a);
        CHECK(trapezoid_done(&t));
        CHECK_EQ(t.place, t.target);
    }
}

/* A limit lowered under way is reached by the whole acceleration, tick by tick, and then held. */
static void lowered(void)
{
    uint64_t seed = 8;
    for (int i = 0; i < 300; i++) {
        const int32_t a = (int32_t)check_random(&seed, ONE / 20, 2 * ONE);
        const int32_t fast = (int32_t)check_random(&seed, 5 * ONE, 40 * ONE);
        const int32_t slow = (int32_t)check_random(&seed, 0, fast);
        const int32_t way = i % 2 ? 1 : -1;
        struct trapezoid t;
        trapezoid_put(&t, 0);
        trapezoid_go(&t, way * 10000000);
        for (int k = 0; k < 1000; k++)
            trapezoid_tick(&t, fast, a);
        CHECK_EQ(t.speed, way * fast);
        int32_t want = fast;
        for (int k = 0; k < 1000; k++) {
            want = want - a > slow ? want - a : slow;
            trapezoid_tick(&t, slow, a);
            CHECK_EQ(t.speed, way * want);
        }
    }
}

/* A stop takes v^2/2a and no tick longer. */
static void stop(void)
{
    struct trapezoid t;
    trapezoid_put(&t, 100);
    trapezoid_go(&t, 100000);
    for (int k = 0; k < 1000; k++)
        trapezoid_tick(&t, 20 * ONE, ONE / 10);
    const int64_t from = t.place;
    trapezoid_stop(&t, ONE / 10);
    int ticks = 0;
    for (; !trapezoid_done(&t); ticks++)
        trapezoid_tick(&t, 20 * ONE, ONE / 10);
    CHECK(abs(ticks - 200) <= 1);
    const double way = (double)(t.place - from) / ONE;
    CHECK(fabs(way - (20.0 * 20.0 / 0.2 - 10.0)) < 0.5); /* half a tick of v less: 1990 */
    trapezoid_shift(&t, -50);
    CHECK(trapezoid_done(&t));
}

int main(void)
{
    braking();
    moves();
    changes();
    lowered();
    stop();
    return check_result();
}
