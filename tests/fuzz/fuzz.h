/* fuzz - what the harnesses of the library share: a machine, points checked. */
#ifndef FUZZ_H
#define FUZZ_H

#include <math.h>

#include "holds.h"
#include "task.h"

/* Short ramps, so that an input comes far in few points; W is not used. */
static inline struct machine fuzz_machine(void)
{
    struct machine m = { .dda_time = 1e-3,
                         .dda_length = 12,
                         .queue_depth = 8,
                         .feed = 50.0,
                         .max_feed = 1000.0,
                         .acc_time = 0.01,
                         .dec_time = 0.02 };
    for (int i = 0; i < AXES; i++) {
        m.axis[i] = (struct machine_axis){ .used = i < 5,
                                           .pitch = 10.0,
                                           .gear_ratio = 1.0,
                                           .ppr = 10000,
                                           .rpm = 3000.0,
                                           .p_gain = 60,
                                           .high_limit = 100.0,
                                           .low_limit = -50.0 };
    }
    return m;
}

/* What holds of every point: its frame is within the limits and leads from the point before to
 * this one, compensation included; its place is a number that the pulses stand for. */
static inline void fuzz_point(const struct mcc *m, const struct point *p, int64_t sum[AXES])
{
    for (int i = 0; i < AXES; i++) {
        const double scale = machine_pulses_per_mm(&m->machine.axis[i]);
        sum[i] += p->frame[i];
        HOLDS(abs(p->frame[i]) <= m->machine.axis[i].max_dda);
        HOLDS(m->dry_run ? p->frame[i] == 0 : sum[i] == p->pulses[i] + p->added[i]);
        HOLDS(isfinite(p->place[i]));
        HOLDS(fabs(p->place[i] * scale - p->pulses[i]) <= 0.5 + 1e-6 * (1.0 + fabs(scale)));
        HOLDS(m->machine.axis[i].used || p->frame[i] == 0);
    }
    HOLDS(isfinite(p->feed) && p->feed >= 0.0 && isfinite(p->outputs.spindle));
}

/* Take all points; returns how many there were. */
static inline int fuzz_take(struct mcc *m, int64_t sum[AXES])
{
    const int n = m->queue.count;
    HOLDS(n >= 0 && n <= m->machine.queue_depth);
    for (int i = 0; i < n; i++) {
        m->written = *queue_peek(&m->queue, 0);
        fuzz_point(m, &m->written, sum);
        queue_drop(&m->queue, 1);
    }
    return n;
}

#endif
