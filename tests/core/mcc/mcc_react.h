/* mcc_react - for the tests: the motion library with a card that puts out each interpolation point
 * at once. */
#ifndef MCC_REACT_H
#define MCC_REACT_H

#include <stdlib.h>

#include "mcc_check.h"
#include "reaction.h"
#include "task.h"

static struct mcc m, before;         /* 340 kB each: not on the stack */
static const struct source *program; /* NULL: calls of the API only */
static const int64_t BUS = 4000;     /* [clocks] */
enum { LONGEST = 100000 };

/* The call must return the code and, if it is an error, leave the whole state as it was. */
#define REFUSED(call, code) \
    do { \
        memcpy(&before, &m, sizeof m); \
        CHECK_EQ(call, code); \
        CHECK(memcmp(&before, &m, sizeof m) == 0); \
    } while (0)

/* Record of the pulses put out. */
struct run {
    int n;
    int32_t sum[AXES], change; /* [pulses] all, and the largest change from one to the next */
    int32_t frame[AXES];
    struct point last;
};

static inline struct machine one_ahead(void)
{
    struct machine machine = mcc_machine();
    machine.queue_depth = 1; /* one point per cycle: the test acts between points */
    return machine;
}

/* Let the library react to new signals, as the PC does. */
static inline void look(void)
{
    manual_look(&m);
    homing_look(&m, BUS);
    reaction_look(&m, &(struct reaction_look){ .clocks = BUS });
}

/* One DDA time. Returns false if there was no point for it. */
static inline bool point(struct run *r)
{
    look();
    task_run(&m, program);
    const bool moves = m.queue.count > 0;
    int32_t frame[AXES] = { 0 };
    if (moves) {
        m.written = *queue_peek(&m.queue, 0);
        queue_drop(&m.queue, 1);
        memcpy(frame, m.written.frame, sizeof frame);
        r->last = m.written;
        r->n++;
    }
    for (int i = 0; i < AXES; i++) {
        const int32_t change = frame[i] - r->frame[i];
        r->change = abs(change) > r->change ? abs(change) : r->change;
        r->sum[i] += frame[i];
        m.signals.pulses[i] += frame[i];
        r->frame[i] = frame[i];
        CHECK_EQ(m.signals.pulses[i], m.written.pulses[i]);
    }
    return moves;
}

static inline void run(struct run *r)
{
    while (r->n < LONGEST && point(r)) {
    }
    CHECK(r->n < LONGEST);
}

/* DDA times until n points have been made. */
static inline void points(struct run *r, int n)
{
    while (r->n < n && point(r)) {
    }
    CHECK_EQ(r->n, n);
}

static inline void open_machine(const struct machine *machine)
{
    CHECK_EQ(MCC_init_motion(&m, machine), MCC_NO_ERR);
    MCC_set_fspd(&m, 50.0);
}

#endif
