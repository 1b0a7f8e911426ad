/* The closed formulas of the DDA against an accumulator stepped clock by clock. */
#include "check.h"
#include "dda.h"

#include <stdlib.h>

enum {
    CHANNELS = 6,
    LENGTH_MAX = 15,
    ACCUMULATOR = 1 << LENGTH_MAX, /* shorter commands are shifted up */
};

struct brute {
    int32_t accumulator;
    int64_t count;
};

static int tick(struct brute *b, int32_t command, int32_t length)
{
    b->accumulator += abs(command) << (LENGTH_MAX - length);
    if (b->accumulator < ACCUMULATOR)
        return 0;
    b->accumulator -= ACCUMULATOR;
    b->count += command < 0 ? -1 : 1;
    return 1;
}

/* Random commands, lengths and dividers, one DDA time after another: count at every clock and clock
 * of every pulse. The accumulator is carried through all of them. */
static void against_brute_force(uint64_t seed)
{
    int32_t length = (int32_t)check_random(&seed, 10, 15);
    int32_t divider = (int32_t)check_random(&seed, 1, 7);
    struct dda d;
    dda_reset(&d, CHANNELS, 1 << length, divider);
    struct brute b[CHANNELS];
    for (int i = 0; i < CHANNELS; i++)
        b[i] = (struct brute){ .accumulator = ACCUMULATOR / 2 };
    int64_t clock = 0;
    for (int period = 0; period < 12; period++) {
        int32_t edges[CHANNELS] = { 0 };
        int64_t end = dda_boundary(&d);
        CHECK_EQ(end - clock, (int64_t)divider << length);
        for (int64_t ticks = 0; clock < end;) {
            clock++;
            bool ticked = ++ticks % divider == 0;
            int64_t counts[CHANNELS];
            dda_counts(&d, clock, counts);
            for (int i = 0; i < CHANNELS; i++) {
                if (ticked && tick(&b[i], d.command[i], length))
                    CHECK_EQ(dda_edge_clock(&d, i, ++edges[i]), clock);
                CHECK_EQ(counts[i], b[i].count);
            }
        }
        for (int i = 0; i < CHANNELS; i++) {
            CHECK_EQ(edges[i], abs(d.command[i]));
            CHECK_EQ(dda_edge_clock(&d, i, edges[i] + 1), -1);
        }
        length = (int32_t)check_random(&seed, 10, 15);
        divider = (int32_t)check_random(&seed, 1, 7);
        dda_set_time(&d, 1 << length, divider, clock);
        int32_t largest = dda_largest(1 << length);
        int32_t next[CHANNELS] = { largest, -largest, 0, 1, -1 };
        next[5] = (int32_t)check_random(&seed, -largest, largest);
        next[3] = (int32_t)check_random(&seed, -20, 20);
        dda_begin(&d, next);
    }
}

/* Every command: exactly so many pulses, evenly, never more than half a pulse off the line. */
static void even_for_every_command(int32_t ticks)
{
    for (int32_t k = 0; k < ticks; k++) {
        CHECK_EQ(dda_pulses(k, ticks, ticks), k);
        CHECK_EQ(dda_pulses(-k, ticks, ticks), -k);
        int64_t last = 0;
        for (int32_t j = 1; j <= k; j += 1 + k / 40) {
            int64_t i = dda_edge_tick(k, ticks, j);
            CHECK_EQ(dda_pulses(k, ticks, i), j);
            CHECK_EQ(dda_pulses(k, ticks, i - 1), j - 1);
            /* ideal tick of pulse j is (j - 1/2) ticks / k; the next whole one is taken */
            CHECK(2 * k * i >= (int64_t)(2 * j - 1) * ticks);
            CHECK(2 * k * (i - 1) < (int64_t)(2 * j - 1) * ticks + ticks % 2);
            CHECK(i > last && i <= ticks);
            last = i;
        }
        for (int64_t i = 0; i <= ticks; i += 37)
            CHECK(llabs(2 * (dda_pulses(k, ticks, i) * ticks - i * k)) <= ticks);
    }
}

/* A stopped divider stands still for as long as it is off; nothing is lost. */
static void stop_and_go(void)
{
    struct dda d;
    int64_t counts[CHANNELS];
    dda_reset(&d, CHANNELS, 1024, 3);
    dda_begin(&d, (int32_t[CHANNELS]){ 700, -700 });
    CHECK_EQ(dda_boundary(&d), 2 * 3072);
    dda_set_run(&d, false, 4000);
    dda_set_run(&d, false, 4500);
    CHECK_EQ(dda_boundary(&d), INT64_MAX);
    CHECK_EQ(dda_edge_clock(&d, 0, 1), -1);
    dda_counts(&d, 1000000, counts);
    CHECK_EQ(counts[0], dda_pulses(700, 1024, (4000 - 3072) / 3));
    CHECK_EQ(counts[1], -counts[0]);
    dda_set_run(&d, true, 1000000);
    CHECK_EQ(dda_boundary(&d), 2 * 3072 + 1000000 - 4000);
    dda_counts(&d, dda_boundary(&d), counts);
    CHECK_EQ(counts[0], 700);
}

/* A new DDA time waits for the boundary, but not for the one that begins just now, idle. */
static void change_of_time(void)
{
    struct dda d;
    dda_reset(&d, CHANNELS, 4096, 10);
    dda_set_time(&d, 1024, 1, 0);
    CHECK_EQ(dda_boundary(&d), 1024);
    dda_set_time(&d, 32768, 2, 1);
    CHECK_EQ(dda_boundary(&d), 1024);
    dda_begin(&d, (int32_t[CHANNELS]){ 1 });
    CHECK_EQ(dda_boundary(&d), 1024 + 65536);
    dda_set_time(&d, 1024, 1, 1024);
    CHECK_EQ(dda_boundary(&d), 1024 + 65536);
    dda_begin(&d, (int32_t[CHANNELS]){ 0 });
    CHECK_EQ(dda_boundary(&d), 1024 + 65536 + 1024);
}

/* The nearest divider: no other is nearer; of two as near, the longer time. */
static void nearest_time(uint64_t seed)
{
    enum { LARGEST = 65535 };
    for (int trial = 0; trial < 2000; trial++) {
        int32_t ticks = (int32_t)check_random(&seed, 2, 33000);
        int64_t wanted = check_random(&seed, 1, trial % 2 ? 200000 : 3000000000);
        int32_t d = dda_divider(ticks, (double)wanted, LARGEST);
        int64_t off = llabs(dda_time(ticks, d) - wanted);
        CHECK(d >= 1 && d <= LARGEST);
        CHECK(d == 1 || llabs(dda_time(ticks, d - 1) - wanted) >= off);
        CHECK(d == LARGEST || llabs(dda_time(ticks, d + 1) - wanted) > off);
    }
    for (int32_t d = 1; d < 1000; d++)
        CHECK_EQ(dda_divider(4096, 4096 * (d + 0.5), LARGEST), d + 1);
    CHECK_EQ(dda_divider(4096, 4096 * 7.5, 5), 5);
    CHECK_EQ(dda_divider(4096, 40960, LARGEST), 10);
    CHECK_EQ(dda_divider(4096, -5, LARGEST), 1);
}

int main(void)
{
    for (uint64_t seed = 1; seed <= 6; seed++)
        against_brute_force(seed * 7919);
    even_for_every_command(1024);
    even_for_every_command(2048);
    even_for_every_command(1000);
    even_for_every_command(1001);
    stop_and_go();
    change_of_time();
    nearest_time(1618);
    CHECK_EQ(dda_largest(1024), 1023);
    CHECK_EQ(dda_largest(32768), 32767);
    CHECK_EQ(dda_time(4096, 10), 40960);
    return check_result();
}
