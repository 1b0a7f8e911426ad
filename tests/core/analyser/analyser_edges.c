/* The logic analyser against a device that answers when it was told to: edges are known in time,
 * reactions are measured to the clock, and pauses are as often long as short. */
#include <string.h>

#include "analyser.h"
#include "check.h"

enum { PERIOD = 100, LEAST = 295, MOST = 304, TIMEOUT = 1000 };

static struct analyser a;
static struct analyser_event event[ANALYSER_CHANNELS];
static double clock_[ANALYSER_CHANNELS];

static void reset(uint32_t enabled, int32_t seed)
{
    struct analyser_config c = { .enabled = enabled, .seed = seed, .period = PERIOD };

    for (int i = 0; i < ANALYSER_CHANNELS; i++) {
        c.least[i] = LEAST;
        c.most[i] = MOST;
        c.timeout[i] = TIMEOUT;
        clock_[i] = 0.0;
    }
    analyser_reset(&a, &c);
}

/* Each channel answers its edge behind i + 1 clocks, within the period if that is so. */
static void check_reactions(void)
{
    int64_t edge[ANALYSER_CHANNELS] = { 0 }, free[ANALYSER_CHANNELS];
    uint32_t seen = 0, response = 0;
    int32_t answers = 0, widths[MOST - LEAST + 1] = { 0 };

    reset(UINT32_MAX, 5);
    for (int i = 0; i < ANALYSER_CHANNELS; i++) {
        free[i] = PERIOD;
    }
    for (int64_t at = 0; at < 100000; at += PERIOD) {
        for (int i = 0; i < ANALYSER_CHANNELS; i++) {
            if ((seen ^ response) >> i & 1 && edge[i] + i + 1 <= at) {
                response ^= (uint32_t)1 << i;
                clock_[i] = (double)(edge[i] + i + 1);
            }
        }
        const uint32_t before = a.levels;
        const int32_t n = analyser_instant(&a, at, response, clock_, event);
        for (int32_t k = 0; k < n; k++) {
            const int i = event[k].channel;
            CHECK_EQ(event[k].edge, edge[i]);
            CHECK_EQ(event[k].response, edge[i] + i + 1);
            free[i] = at + PERIOD;
            answers++;
        }
        for (int i = 0; i < ANALYSER_CHANNELS; i++) {
            const struct analyser_channel *c = &a.channel[i];
            if ((before ^ a.levels) >> i & 1) {
                edge[i] = c->shown;
                CHECK(edge[i] > at + PERIOD && edge[i] <= at + 2 * PERIOD);
                const int64_t width = edge[i] - free[i];
                CHECK(width >= LEAST && width <= MOST);
                if (width >= LEAST && width <= MOST) {
                    widths[width - LEAST]++;
                }
            } else { /* one that is not known yet is too far away for that */
                CHECK((a.levels ^ response) >> i & 1 || c->edge > at + 2 * PERIOD);
            }
            CHECK_EQ(c->level, a.levels >> i & 1);
        }
        seen = a.levels;
    }
    CHECK(answers > 32 * 200);
    for (int i = 0; i < ANALYSER_CHANNELS; i++) {
        const struct analyser_channel *c = &a.channel[i];
        CHECK_EQ(c->least, i + 1);
        CHECK_EQ(c->most, i + 1);
        CHECK_EQ(c->latest, i + 1);
        CHECK_EQ(c->sum, (int64_t)c->responses * (i + 1));
        CHECK(c->edges == c->responses || c->edges == c->responses + 1);
        CHECK_EQ(c->timeouts, 0);
        CHECK_EQ(c->strays, 0);
    }
    for (int k = 0; k <= MOST - LEAST; k++) { /* within five standard deviations */
        CHECK_NEAR(widths[k], answers / 10.0, 5.0 * sqrt(answers * 0.09) + 32.0);
    }
}

/* Wait for the next edge of channel 3, the only one that is on; returns its instant. */
static int64_t next_edge(int64_t at, uint32_t response)
{
    const int32_t edges = a.channel[3].edges;

    while (a.channel[3].edges == edges && at < 1000000) {
        CHECK_EQ(analyser_instant(&a, at, response, clock_, event), 0);
        at += PERIOD;
    }
    CHECK_EQ(a.levels & ~(uint32_t)8, 0);
    return at;
}

/* An edge is given up behind its timeout, not at it; an answer at its own clock is one, and one
 * before it is a stray change. The least, the most and the sum are those of several. */
static void check_times(void)
{
    reset(8, 1);
    int64_t at = next_edge(0, 0);
    const int64_t edge = a.channel[3].shown;
    for (at = edge; at <= edge + TIMEOUT; at++) {
        CHECK_EQ(analyser_instant(&a, at, 0, clock_, event), 0);
    }
    CHECK_EQ(analyser_instant(&a, edge + TIMEOUT + 1, 0, clock_, event), 1);
    CHECK(event[0].channel == 3 && event[0].edge == edge && event[0].response == -1);
    CHECK_EQ(a.channel[3].timeouts, 1);
    CHECK_EQ(a.channel[3].responses, 0);
    reset(8, 1);
    at = next_edge(0, 0);
    int64_t sum = 0;
    for (int k = 0; k < 3; k++) {
        const uint32_t level = k % 2 ? 0 : 8;
        const int64_t shown = a.channel[3].shown, late = (int64_t[]){ 40, 0, 70 }[k];
        clock_[3] = (double)(shown - 1); /* a change before the edge answers nothing */
        CHECK_EQ(analyser_instant(&a, at, level, clock_, event), 0);
        CHECK_EQ(a.channel[3].strays, 3 * k + 1);
        CHECK_EQ(analyser_instant(&a, at, level ^ 8, clock_, event), 0);
        CHECK_EQ(a.channel[3].strays, 3 * k + 2);
        clock_[3] = (double)(shown + late);
        CHECK_EQ(analyser_instant(&a, at + PERIOD, level, clock_, event), 1);
        CHECK_EQ(event[0].response, shown + late);
        CHECK_EQ(a.channel[3].strays, 3 * k + 2);
        CHECK_EQ(a.channel[3].latest, late);
        sum += late;
        CHECK_EQ(a.channel[3].sum, sum);
        /* A change while none waits is a stray, too. */
        clock_[3] = (double)(at + PERIOD);
        CHECK_EQ(analyser_instant(&a, at + PERIOD, level ^ 8, clock_, event), 0);
        CHECK_EQ(a.channel[3].strays, 3 * k + 3);
        CHECK_EQ(analyser_instant(&a, at + PERIOD, level, clock_, event), 0);
        a.channel[3].strays--;
        at = next_edge(at + 2 * PERIOD, level);
    }
    CHECK_EQ(a.channel[3].least, 0);
    CHECK_EQ(a.channel[3].most, 70);
    CHECK_EQ(a.channel[3].responses, 3);
}

/* Channels and seeds draw differently, and the same again. */
static void check_seeds(void)
{
    uint64_t all[4 * ANALYSER_CHANNELS];

    for (int n = 0; n < 4 * ANALYSER_CHANNELS; n++) {
        reset(UINT32_MAX, (int[]){ 0, 1, 2, -1 }[n / ANALYSER_CHANNELS]);
        all[n] = a.channel[n % ANALYSER_CHANNELS].random;
        for (int k = 0; k < n; k++) {
            CHECK(all[k] != all[n]);
        }
    }
    reset(UINT32_MAX, 0);
    CHECK(a.channel[0].random == all[0]);
    /* The first number of SplitMix64 from 0, as published, and the constant of its next step. */
    CHECK(all[0] == UINT64_C(0xE220A8397B1DCDAF) + UINT64_C(0x9E3779B97F4A7C15));
    /* And from 2^32 + 1: channel 1 of seed 1. */
    CHECK(all[ANALYSER_CHANNELS + 1]
          == UINT64_C(0x204391A6FD59956F) + UINT64_C(0x9E3779B97F4A7C15));
}

int main(void)
{
    check_reactions();
    check_times();
    check_seeds();
    return check_result();
}
