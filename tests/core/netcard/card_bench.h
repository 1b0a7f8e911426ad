/* card_bench - for the tests: a network card with a job, commands to it, and checks of its pulses
 * and processor times. */
#ifndef CARD_BENCH_H
#define CARD_BENCH_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "job_writer.h"
#include "netcard.h"

#define BENCH_MS INT64_C(1000000)

enum { BENCH_JOB = 1 << 19, BENCH_FRAMES = 4096 };

static uint8_t bench_job[BENCH_JOB]; /* file of the latest bench_make() */
static uint32_t bench_bytes;
static int64_t bench_end[CARD_AXES];        /* [pulses] its end position */
static int64_t bench_path[BENCH_FRAMES][2]; /* [pulses] X, Y at the begin of the first frames */
static uint32_t bench_rest;                 /* the last event is that for rest and in no frame */

/* Make a job of frames of 1 ms: X and Y accelerate to `top` pulses per frame and back to rest, with
 * a sine on Y; event n of the table is in frame 100 n. */
static inline void bench_make(int32_t frames, int32_t top, const struct job_event *events, int n)
{
    static struct job_writer w;
    struct job_header h = {
        .period_ns = 1000000, .axes = 3, .events = (uint32_t)n, .rest = bench_rest
    };
    uint8_t page[JOB_PAGE_BYTES];

    for (int i = 0; i < JOB_AXES; i++) {
        h.pulses_per_m[i] = 1000000;
        h.speed_max[i] = (uint32_t)top * 1000;
        h.acc_max[i] = 4000000;
        h.jerk_max[i] = 400000000;
        bench_end[i] = 0;
    }
    memset(h.origin, 7, sizeof h.origin);
    for (int i = 0; i < n; i++) {
        h.event[i] = events[i];
    }
    job_writer_start(&w, &h);
    bench_bytes = JOB_PAGE_BYTES;
    for (int32_t k = 0; k < frames; k++) {
        const int32_t ramp = k < frames - 1 - k ? k : frames - 1 - k;
        const int event = k / 100;
        struct job_frame f = { 0 };
        f.event = k % 100 == 0 && event <= n - (bench_rest > 0) ? event : 0;
        f.command[0] = ramp < top ? ramp : top;
        f.command[1] = (int32_t)lround(f.command[0] * sin(k * 0.01));
        for (int i = 0; i < 2 && k < BENCH_FRAMES; i++) {
            bench_path[k][i] = bench_end[i];
        }
        bench_end[0] += f.command[0];
        bench_end[1] += f.command[1];
        if (job_writer_add(&w, &f, page)) {
            memcpy(bench_job + bench_bytes, page, sizeof page);
            bench_bytes += JOB_PAGE_BYTES;
        }
    }
    CHECK_EQ(job_writer_end(&w, page, bench_job), JOB_GOOD);
    memcpy(bench_job + bench_bytes, page, sizeof page);
    bench_bytes += JOB_PAGE_BYTES;
}

static inline struct netcard_config bench_config(void)
{
    struct netcard_config c = { .settings = card_settings_start() };

    return c;
}

/* Start a card with the latest job, at rest. */
static inline void bench_start(struct netcard *c, const struct netcard_config *config)
{
    CHECK_EQ(netcard_start(c, config, bench_job, bench_bytes), NET_DONE);
}

/* Let a number of ms pass. */
static inline void bench_pass(struct netcard *c, int64_t ms)
{
    netcard_advance(c, c->now + ms * BENCH_MS);
}

/* Give a command and let time pass until the parser has taken it. */
static inline enum net_code bench_order(struct netcard *c, enum card_command command)
{
    const int32_t before = c->result.count;

    CHECK(netcard_command(c, command, 15));
    for (int i = 0; i < 50000 && c->result.count == before; i++) {
        netcard_advance(c, c->now + 10000);
    }
    CHECK_EQ(c->result.count, before + 1);
    return c->result.code;
}

/* Pulses of an axis so far. */
static inline int64_t bench_count(const struct netcard *c, int axis)
{
    int64_t counts[FRAME_AXES];

    player_counts(&c->player, c->now / PLAYER_CLOCK_NS, counts);
    return counts[axis];
}

/* Check that the times of tasks, interrupts, kernel and idle add up to the whole time. */
static inline void bench_times(const struct netcard *c)
{
    int64_t all = kernel_idle(&c->kernel) + kernel_overhead(&c->kernel);

    for (int i = 0; i < KERNEL_TASKS + KERNEL_INTERRUPTS; i++) {
        all += kernel_busy(&c->kernel, i);
    }
    CHECK_EQ(all, c->now - c->boot);
}

/* Check that the running task is the most urgent ready one. */
static inline void bench_urgent(const struct kernel *k)
{
    const int r = k->processor.running;

    if (r < 0 || r >= KERNEL_TASKS || k->chooses) {
        return;
    }
    CHECK(k->ready >> r & 1);
    for (int i = 0; i < NETCARD_TASKS; i++) {
        CHECK(!(k->ready >> i & 1) || kernel_priority(k, i) <= kernel_priority(k, r));
    }
}

#endif
