/* The closed formulas of the DDA against an accumulator stepped clock by clock. */
#include "check.h"
#include "dda.h"

#include <stdlib.h>

enum { ACCUMULATOR = 1 << DDA_LENGTH_MAX }; /* 15 bit wide; shorter commands are shifted up */

struct brute {
    int32_t accumulator;
    int64_t count;
};

static int tick(struct brute *b, int32_t command, int32_t length)
{
    b->accumulator += abs(command) << (DDA_LENGTH_MAX - length);
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
    dda_reset(&d, length, divider);
    struct brute b[DDA_CHANNELS];
    for (int i = 0; i < DDA_CHANNELS; i++)
        b[i] = (struct brute){.accumulator = ACCUMULATOR / 2};
    int64_t clock = 0;
    for (int period = 0; period < 12; period++) {
        int32_t edges[DDA_CHANNELS] = {0};
        int64_t end = dda_boundary(&d);
        CHECK_EQ(end - clock, (int64_t)divider << length);
        for (int64_t ticks = 0; clock < end;) {
            clock++;
            bool ticked = ++ticks % divider == 0;
            int64_t counts[DDA_CHANNELS];
            dda_counts(&d, clock, counts);
            for (int i = 0; i < DDA_CHANNELS; i++) {
                if (ticked && tick(&b[i], d.command[i], length))
                    CHECK_EQ(dda_edge_clock(&d, i, ++edges[i]), clock);
                CHECK_EQ(counts[i], b[i].count);
            }
        }
        for (int i = 0; i < DDA_CHANNELS; i++) {
            CHECK_EQ(edges[i], abs(d.command[i]));
            CHECK_EQ(dda_edge_clock(&d, i, edges[i] + 1), -1);
        }
        length = (int32_t)check_random(&seed, 10, 15);
        divider = (int32_t)check_random(&seed, 1, 7);
        dda_set_time(&d, length, divider, clock);
        int32_t largest = dda_largest(length);
        int32_t next[DDA_CHANNELS] = {largest, -largest, 0, 1, -1};
        next[5] = (int32_t)check_random(&seed, -largest, largest);
        next[3] = (int32_t)check_random(&seed, -20, 20);
        dda_begin(&d, next);
    }
}

/* Every command of a length: exactly so many pulses, evenly, never half a pulse off the line. */
static void even_for_every_command(int32_t length)
{
    int32_t ticks = 1 << length;
    for (int32_t k = 0; k < ticks; k++) {
        CHECK_EQ(dda_pulses(k, length, ticks), k);
        CHECK_EQ(dda_pulses(-k, length, ticks), -k);
        int64_t last = 0;
        for (int32_t j = 1; j <= k; j += 1 + k / 40) {
            int64_t i = dda_edge_tick(k, length, j);
            CHECK_EQ(dda_pulses(k, length, i), j);
            CHECK_EQ(dda_pulses(k, length, i - 1), j - 1);
            /* ideal tick of pulse j is (j - 1/2) ticks / k; the next whole one is taken */
            CHECK(k * i >= (int64_t)(2 * j - 1) * ticks / 2);
            CHECK(k * (i - 1) < (int64_t)(2 * j - 1) * ticks / 2);
            CHECK(i > last && i <= ticks);
            last = i;
        }
        for (int64_t i = 0; i <= ticks; i += 37)
            CHECK(llabs(2 * (dda_pulses(k, length, i) * ticks - i * k)) <= ticks);
    }
}

/* A stopped divider stands still for as long as it is off; nothing is lost. */
static void stop_and_go(void)
{
    struct dda d;
    int64_t counts[DDA_CHANNELS];
    dda_reset(&d, 10, 3);
    dda_begin(&d, (int32_t[DDA_CHANNELS]){700, -700});
    CHECK_EQ(dda_boundary(&d), 2 * 3072);
    dda_set_run(&d, false, 4000);
    dda_set_run(&d, false, 4500);
    CHECK_EQ(dda_boundary(&d), INT64_MAX);
    CHECK_EQ(dda_edge_clock(&d, 0, 1), -1);
    dda_counts(&d, 1000000, counts);
    CHECK_EQ(counts[0], dda_pulses(700, 10, (4000 - 3072) / 3));
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
    dda_reset(&d, 12, 10);
    dda_set_time(&d, 10, 1, 0);
    CHECK_EQ(dda_boundary(&d), 1024);
    dda_set_time(&d, 15, 2, 1);
    CHECK_EQ(dda_boundary(&d), 1024);
    dda_begin(&d, (int32_t[DDA_CHANNELS]){1});
    CHECK_EQ(dda_boundary(&d), 1024 + 65536);
    dda_set_time(&d, 10, 1, 1024);
    CHECK_EQ(dda_boundary(&d), 1024 + 65536);
    dda_begin(&d, (int32_t[DDA_CHANNELS]){0});
    CHECK_EQ(dda_boundary(&d), 1024 + 65536 + 1024);
}

int main(void)
{
    for (uint64_t seed = 1; seed <= 6; seed++)
        against_brute_force(seed * 7919);
    even_for_every_command(10);
    even_for_every_command(11);
    stop_and_go();
    change_of_time();
    CHECK_EQ(dda_largest(10), 1023);
    CHECK_EQ(dda_largest(15), 32767);
    CHECK_EQ(dda_time(12, 10), 40960);
    return check_result();
}
