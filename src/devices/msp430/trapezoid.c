#include "trapezoid.h"

int64_t trapezoid_counts(const struct trapezoid *t)
{
    return t->place >> TRAPEZOID_POINT;
}

void trapezoid_put(struct trapezoid *t, int64_t counts)
{
    *t = (struct trapezoid){ .place = counts * (1 << TRAPEZOID_POINT),
                             .target = counts * (1 << TRAPEZOID_POINT) };
}

void trapezoid_freeze(struct trapezoid *t)
{
    t->target = t->place;
    t->speed = t->change = 0;
}

void trapezoid_go(struct trapezoid *t, int64_t counts)
{
    t->target = counts * (1 << TRAPEZOID_POINT);
}

void trapezoid_shift(struct trapezoid *t, int64_t counts)
{
    t->place += counts * (1 << TRAPEZOID_POINT);
    t->target += counts * (1 << TRAPEZOID_POINT);
}

int64_t trapezoid_brake(int32_t v, int32_t a)
{
    const int64_t n = ((int64_t)v + a - 1) / a;
    return n * v - a * (n * (n - 1) / 2);
}

void trapezoid_stop(struct trapezoid *t, int32_t a)
{
    const int32_t v = t->speed < 0 ? -t->speed : t->speed;
    const int64_t way = v > a ? trapezoid_brake(v - a, a) : 0;
    t->target = t->place + (t->speed < 0 ? -way : way);
}

static int32_t larger(int32_t a, int32_t b)
{
    return a > b ? a : b;
}

static int32_t smaller(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

/* Largest speed from `slow` on with S <= left. From (n - 1) a to n a the slope of S is n; the speed
 * lies within 2 a, so the loop passes three such intervals at most. */
static int32_t fit(int32_t slow, int64_t left, int32_t a)
{
    int64_t best = slow, slack = left - trapezoid_brake(slow, a);
    while (slack > 0) {
        const int64_t n = best / a + 1, room = n * a - best;
        const int64_t more = slack / n;
        if (more < room)
            return (int32_t)(best + more);
        best += room;
        slack -= n * room;
    }
    return (int32_t)best;
}

/* Speed of the next tick, from the speed v, with the distance `left` to the target. */
static int32_t choose(int32_t v, int64_t left, int32_t limit, int32_t a)
{
    const int32_t slow = larger(v - a, 0);
    const int32_t fast = v > limit ? larger(slow, limit) : smaller(v + a, limit);
    return trapezoid_brake(fast, a) <= left ? fast : fit(slow, left, a);
}

void trapezoid_tick(struct trapezoid *t, int32_t limit, int32_t a)
{
    const int64_t left = t->target - t->place;
    const int way = t->speed != 0 ? (t->speed > 0 ? 1 : -1) : left > 0 ? 1 : -1;
    const int32_t next = way * choose(way * t->speed, way * left, limit, a);
    t->change = next - t->speed;
    t->speed = next;
    t->place += next;
}

bool trapezoid_done(const struct trapezoid *t)
{
    return t->place == t->target && t->speed == 0;
}
