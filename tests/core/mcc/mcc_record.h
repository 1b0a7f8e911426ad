/* mcc_record - for the tests: a motion library and a record of every interpolation point that it
 * makes. */
#ifndef MCC_RECORD_H
#define MCC_RECORD_H

#include "mcc_check.h"
#include "task.h"

static struct mcc m;                 /* 300 kB: not on the stack */
static const struct source *program; /* NULL: calls of the API only */
enum { LONGEST = 200000 };

/* Record of the points that the interpolation puts into the queue. */
struct record {
    int n;
    int32_t sum[AXES];
    double speed_max;
    struct point last;
};

static void begin(struct machine machine)
{
    machine.queue_depth = 1; /* one point per cycle: the test acts between points */
    CHECK_EQ(MCC_init_motion(&m, &machine), MCC_NO_ERR);
}

/* Make one point; false if the axes are at rest. Each frame must lead to within half a pulse of the
 * ideal point. */
static bool point(struct record *r)
{
    task_run(&m, program);
    if (m.queue.count == 0) {
        return false;
    }
    r->last = *queue_peek(&m.queue, 0);
    queue_drop(&m.queue, 1);
    for (int i = 0; i < 3; i++) {
        r->sum[i] += r->last.frame[i];
        CHECK_EQ(r->sum[i], r->last.pulses[i]);
        CHECK(fabs(r->last.place[i] * 1000.0 - r->last.pulses[i]) <= 0.5 + 1e-6);
    }
    r->speed_max = fmax(r->speed_max, r->last.feed);
    r->n++;
    return true;
}

static inline void run(struct record *r)
{
    while (r->n < LONGEST && point(r)) {
    }
    CHECK(r->n < LONGEST);
}

#endif
