/* Speeds before a place: each limit by its own formula, the least of them, at ways at random. */
#include "brake.h"
#include "check.h"

/* What limits given one after the other allow at a way before the place, each by itself. */
struct plain {
    int count;
    double speed[8], even[8];
};

static double allowed(const struct plain *p, double way, double dec)
{
    double least = INFINITY;

    for (int i = 0; i < p->count; i++) {
        const double ramp = fmax(way - p->even[i], 0.0);
        least = fmin(least, sqrt(p->speed[i] * p->speed[i] + 2.0 * dec * ramp));
    }
    return least;
}

/* The same of the steps. */
static double stepped(const struct brake *b, double way, double dec)
{
    struct plain p = { .count = b->count };

    for (int i = 0; i < b->count; i++) {
        p.speed[i] = b->step[i].speed;
        p.even[i] = b->step[i].even;
    }
    return allowed(&p, way, dec);
}

static void ascending(const struct brake *b)
{
    CHECK(b->count >= 1 && b->count <= BRAKE_STEPS);
    for (int i = 0; i + 1 < b->count; i++) {
        CHECK(b->step[i].speed < b->step[i + 1].speed);
        CHECK(b->step[i].even < b->step[i + 1].even);
    }
}

/* Up to four limits that all count, from the place and from a point before it. */
static void limits(uint64_t *seed)
{
    const double dec = check_real(seed, 10.0, 1000.0);
    struct plain p = { .count = 1 };
    struct brake b;

    brake_rest(&b);
    for (int n = 0; n < 3; n++) {
        const double speed = check_real(seed, 0.0, 50.0), even = check_real(seed, 0.0, 3.0);
        p.speed[p.count] = speed;
        p.even[p.count++] = even;
        brake_limit(&b, speed, even);
        ascending(&b);
    }
    for (int n = 0; n < 20; n++) {
        const double way = check_real(seed, 0.0, 6.0), want = allowed(&p, way, dec);
        CHECK_NEAR(stepped(&b, way, dec), want, 1e-12 * want);
    }
    const double back = check_real(seed, 0.0, 4.0);
    brake_back(&b, back, dec);
    ascending(&b);
    for (int n = 0; n < 20; n++) {
        const double way = check_real(seed, 0.0, 4.0), want = allowed(&p, way + back, dec);
        CHECK_NEAR(stepped(&b, way, dec), want, 1e-9 * want + 1e-9);
    }
}

/* With more limits than places nothing is ever faster, and rest stays rest. */
static void many(uint64_t *seed)
{
    const double dec = check_real(seed, 10.0, 1000.0);
    struct plain p = { .count = 1 };
    struct brake b;

    brake_rest(&b);
    for (int n = 0; n < 7; n++) {
        p.speed[p.count] = check_real(seed, 0.0, 50.0);
        p.even[p.count++] = check_real(seed, 0.0, 3.0);
        brake_limit(&b, p.speed[n + 1], p.even[n + 1]);
        ascending(&b);
        for (int k = 0; k < 10; k++) {
            const double way = check_real(seed, 0.0, 6.0);
            CHECK(stepped(&b, way, dec) <= allowed(&p, way, dec) * (1.0 + 1e-12));
        }
    }
    CHECK_EQ(stepped(&b, 0.0, dec), 0.0);
}

/* Of five steps the two that differ least in speed are one, with the speed of the one and the way
 * of the other, whichever they are and whichever comes last. */
static void merged(void)
{
    for (int pair = 0; pair < 4; pair++) {
        struct brake_step all[5] = { { 0.0, 0.0 } };
        for (int k = 1; k < 5; k++) {
            const double apart = k == pair + 1 ? 5.0 : 20.0 + k;
            all[k] = (struct brake_step){ all[k - 1].speed + apart, k };
        }
        for (int last = 1; last < 5; last++) {
            struct brake b;
            brake_rest(&b);
            for (int k = 1; k < 5; k++) {
                const struct brake_step *step = &all[1 + (last + k) % 4];
                brake_limit(&b, step->speed, step->even);
            }
            CHECK_EQ(b.count, 4);
            for (int k = 0; k < 4; k++) {
                CHECK_EQ(b.step[k].speed, all[k <= pair ? k : k + 1].speed);
                CHECK_EQ(b.step[k].even, all[k < pair ? k : k + 1].even);
            }
        }
    }
}

/* A limit that another one says already takes no place. */
static void needless(void)
{
    struct brake b;

    brake_rest(&b);
    brake_limit(&b, 5.0, 0.0);
    CHECK_EQ(b.count, 1);
    brake_limit(&b, 5.0, 1.0);
    brake_limit(&b, 7.0, 1.0);
    brake_limit(&b, 7.0, 0.5);
    CHECK_EQ(b.count, 2);
    brake_limit(&b, 4.0, 1.0);
    CHECK_EQ(b.count, 2);
    CHECK_EQ(b.step[1].speed, 4.0);
}

/* The segments from a point up to the place are what the limits allow, without a gap. */
static void segments(uint64_t *seed)
{
    const double dec = check_real(seed, 10.0, 1000.0), place = check_real(seed, 5.0, 9.0);
    struct brake b;
    double s = check_real(seed, 0.0, 4.0);
    int n = 0;

    brake_rest(&b);
    for (int k = 0; k < 3; k++) {
        brake_limit(&b, check_real(seed, 0.0, 50.0), check_real(seed, 0.0, 3.0));
    }
    for (; s < place && n < 2 * BRAKE_STEPS; n++) {
        const struct brake_segment p = brake_next(&b, s, place, dec);
        CHECK(p.end > s && p.end <= place);
        /* It is as long as the even way of no limit begins. */
        for (int k = 0; k < b.count; k++) {
            const double begins = place - b.step[k].even;
            CHECK(!(begins > s && begins < p.end));
        }
        for (int k = 1; k < 8; k++) {
            const double at = s + (p.end - s) * k / 8.0;
            const double got = fmin(p.top, sqrt(p.leave * p.leave + 2.0 * dec * (p.end - at)));
            const double want = stepped(&b, place - at, dec);
            CHECK_NEAR(got, want, 1e-9 * want);
        }
        s = p.end;
    }
    CHECK_EQ(s, place);
    CHECK(n <= BRAKE_STEPS);
}

int main(void)
{
    uint64_t seed = 11;

    for (int i = 0; i < 3000; i += CHECK_EACH) {
        limits(&seed);
        many(&seed);
        segments(&seed);
    }
    merged();
    needless();
    return check_result();
}
