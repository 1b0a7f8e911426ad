/* Pitch and backlash compensation against the table read with exact fractions. */
#include "comp.h"
#include "mcc_check.h"

#include <stdlib.h>

static struct comp_table table(uint64_t seed)
{
    struct comp_table t = { .interval = (int32_t)check_random(&seed, 1, 5000),
                            .home = (int32_t)check_random(&seed, 0, 255) };
    for (int i = 0; i < COMP_POINTS; i++) {
        t.forward[i] = (int32_t)check_random(&seed, -40, 40);
        t.backward[i] = t.forward[i] + 25;
    }
    return t;
}

/* Nearest to the straight line between the points; the rows beyond the ends. */
static void interpolation(uint64_t seed)
{
    const struct comp_table t = table(seed);

    for (int trial = 0; trial < 5000; trial++) {
        const int64_t far = 300 * (int64_t)t.interval, p = check_random(&seed, -far, far);
        const bool back = trial & 1;
        const int32_t *row = back ? t.backward : t.forward;
        const double x = fmax(0.0, fmin(255.0, (double)p / t.interval + t.home));
        const int i = x >= 255.0 ? 254 : (int)x;
        const double want = row[i] + (x - i) * (row[i + 1] - row[i]);
        CHECK_NEAR(comp_wanted(&t, p, back), want, 0.5 + 1e-9);
    }
    for (int i = 0; i < COMP_POINTS; i++) {
        const int64_t p = (int64_t)(i - t.home) * t.interval;
        CHECK_EQ(comp_wanted(&t, p, false), t.forward[i]);
        CHECK_EQ(comp_wanted(&t, p, true), t.backward[i]);
    }
}

/* Random motion: limits hold in every DDA time, what is added is what was wanted once caught up. */
static void drives_it_in(uint64_t seed)
{
    const struct comp_table t = table(seed);
    const struct comp_limits l = { .command = 1023, .change = 3 };
    struct comp c = { 0 };
    int64_t ideal = 0, out = 0;
    int caught = 0;

    for (int k = 0; k < 20000; k++) {
        const bool dwell = k % 500 > 300;
        const int32_t frame = dwell ? 0 : (int32_t)check_random(&seed, -1023, 1023);
        ideal += frame;
        const int32_t add = comp_step(&t, &c, ideal, frame, &l);
        CHECK(abs(add) <= l.change);
        CHECK(abs(frame + add) <= l.command);
        out += frame + add;
        CHECK_EQ(out, ideal + c.added);
        if (comp_done(&t, &c, ideal)) {
            caught++;
            CHECK_EQ(c.added, comp_wanted(&t, ideal, c.backward));
        }
        CHECK(!(dwell && k % 500 > 460) || comp_done(&t, &c, ideal));
    }
    CHECK(caught > 1000);
}

/* The direction is that of the latest motion; standing still does not change it. */
static void backlash(void)
{
    struct comp_table t = { .interval = 1000, .home = 128 };
    const struct comp_limits l = { .command = 1000, .change = 10 };
    struct comp c = { 0 };
    int32_t sum = 0;

    for (int i = 0; i < COMP_POINTS; i++) {
        t.backward[i] = -25;
    }
    CHECK(comp_valid(&t));
    CHECK_EQ(comp_step(&t, &c, 100, 100, &l), 0);
    CHECK_EQ(comp_step(&t, &c, 0, -100, &l), -10);
    CHECK_EQ(comp_step(&t, &c, 0, 0, &l), -10);
    CHECK_EQ(comp_step(&t, &c, 0, 0, &l), -5);
    CHECK_EQ(comp_step(&t, &c, 0, 0, &l), 0);
    for (int k = 0; k < 4; k++) {
        sum += comp_step(&t, &c, 1 + k, 1, &l);
    }
    CHECK_EQ(sum, 25);
    CHECK_EQ(c.added, 0);
    CHECK_EQ(comp_step(&t, &c, 996, 995, &l), 0);
    CHECK_EQ(comp_step(&t, &c, -4, -1000, &l), 0);    /* no room in this command */
    CHECK_EQ(comp_step(&t, &c, -1000, -996, &l), -4); /* four pulses of room */
    CHECK_EQ(comp_step(&t, &c, -2500, -1500, &l), 0); /* beyond the limit by itself */
}

static void refusals(void)
{
    struct comp_table t = { .interval = -1 };
    CHECK(!comp_valid(&t));
    t.interval = 0;
    CHECK(comp_valid(&t));
    CHECK_EQ(comp_wanted(&t, 12345, true), 0);
    t.home = COMP_POINTS;
    CHECK(!comp_valid(&t));
    t.home = 0;
    t.backward[255] = COMP_LARGEST + 1;
    CHECK(!comp_valid(&t));
    t.backward[255] = -COMP_LARGEST;
    CHECK(comp_valid(&t));
}

int main(void)
{
    for (uint64_t seed = 1; seed < 20; seed++) {
        interpolation(seed * 7919);
        drives_it_in(seed * 104729);
    }
    backlash();
    refusals();
    return check_result();
}
