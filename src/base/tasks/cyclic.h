/* cyclic - cyclic tasks on one processor (processor.h): which task runs when, its latency, response
 * and missed deadlines. A task has a timer, at offset + k cycle, or is woken by events.
 *
 * Priorities are fixed, the lowest number first; a more urgent task preempts a less urgent one at
 * once. At one clock runs end first, then timers release runs and the most urgent one begins; then
 * interrupts are seen. So a task whose timer and an interrupt fall on one clock has begun when the
 * interrupt comes. Among equal priorities a run that has begun goes on, then the one that was due
 * first runs, then the one with the lower number.
 *
 * While a run of a task is in progress one more run of it can wait; what its timer releases beyond
 * that is lost. A run has missed its deadline if the timer's next cycle begins before it has ended.
 * Runs that an event woke have no deadline. A cycle that begins while such a run waits is served by
 * that run.
 *
 * The caller says how long a run takes: cyclic_next tells that a run begins or that its time is
 * over, and the caller answers before it calls cyclic_next again.
 */
#ifndef CYCLIC_H
#define CYCLIC_H

#include "processor.h"

enum { CYCLIC_TASKS = 8 }; /* largest number of tasks */

/* Largest clock, time, offset and cycle [clocks]: more than a thousand years at 25 ns. */
#define CYCLIC_LONGEST ((int64_t)1 << 61)

struct cyclic_config {
    int32_t tasks;                  /* number of tasks; the arrays' other elements are unused */
    int32_t priority[CYCLIC_TASKS]; /* the lowest number first */
    int64_t cycle[CYCLIC_TASKS];    /* [clocks] 0: no timer, only events wake the task */
    int64_t offset[CYCLIC_TASKS];   /* [clock] at which the first cycle begins */
};

/* Statistics of a task since the start. */
struct cyclic_use {
    int32_t runs;     /* runs that have ended */
    int32_t missed;   /* missed deadlines */
    int64_t latency;  /* [clocks] longest time from due to begin of a run */
    int64_t response; /* [clocks] longest time from due to end of a run */
    int64_t busy;     /* [clocks] for which it has had the processor */
};

struct cyclic_task {
    int64_t cycle;         /* [clocks] cycle of its timer; 0 none */
    int64_t next;          /* [clock] of its next cycle; INT64_MAX without a timer */
    bool asked;            /* a run waits for its begin */
    bool woken;            /* an event woke the latest run that waited, not the timer */
    int64_t ready;         /* [clock] at which the run that waits may begin */
    int64_t due;           /* [clock] from which the latency of the run that waits counts */
    bool active;           /* a run has begun and not ended */
    bool event;            /* an event woke the run that has begun */
    int64_t from;          /* [clock] at which the run that has begun was due */
    struct cyclic_use use; /* all but `busy`, which the processor counts */
};

struct cyclic {
    struct processor processor; /* everything before its clock is done */
    int running;                /* task that ran up to the processor's clock; -1 none */
    uint32_t changes;           /* of the tasks' statistics; counts round */
    struct cyclic_task task[CYCLIC_TASKS];
};

enum cyclic_what {
    CYCLIC_NONE,  /* no event before `until` */
    CYCLIC_BEGIN, /* a run of the task begins */
    CYCLIC_END    /* the time of the task's run is over */
};

struct cyclic_event {
    enum cyclic_what what;
    int task; /* -1 with CYCLIC_NONE */
};

/* Start at clock 0, with no run in progress or waiting. */
void cyclic_start(struct cyclic *s, const struct cyclic_config *config);

/* An event wakes a task: a run that was due at the clock `due` may begin at the clock `ready`. It
 * replaces a run that waits already. */
void cyclic_wake(struct cyclic *s, int task, int64_t due, int64_t ready);

/* Let time pass to the next event before the clock `until`, or else to `until` itself, which
 * returns CYCLIC_NONE. */
struct cyclic_event cyclic_next(struct cyclic *s, int64_t until);

/* Answer to CYCLIC_BEGIN: the run was due at the clock `due` and needs `clocks`. */
void cyclic_begin(struct cyclic *s, int task, int64_t due, int64_t clocks);

/* Answers to CYCLIC_END: the run needs more clocks; the run has ended. */
void cyclic_more(struct cyclic *s, int task, int64_t clocks);
void cyclic_end(struct cyclic *s, int task);

struct cyclic_report {
    int64_t clock;                        /* the processor's */
    int running;                          /* task that ran up to this clock; -1 none */
    struct cyclic_use task[CYCLIC_TASKS]; /* statistics of each task */
    struct cyclic_use all;                /* their sums; the longest latency and response of all */
    uint32_t changes;                     /* of the statistics so far */
};

/* Bring a report up to date. All members of a new report are 0. */
void cyclic_tell(const struct cyclic *s, struct cyclic_report *r);

#endif
