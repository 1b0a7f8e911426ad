/* cyclic - tasks with a cycle or woken by events on that processor: who runs when.
 *
 * Fixed priorities, the lowest number first; a more urgent task interrupts a less urgent one at
 * once. A task is asked to run by its timer, at offset + k cycle, or is woken for a clock. At one
 * clock runs end first, then timers ask and what is most urgent begins; then interrupts are seen.
 * So a task whose timer and an interrupt fall on one clock has begun when the interrupt comes.
 * Among equal priorities what has begun goes on, then what was due first, then the lower number.
 *
 * One run waits while the task is busy; its timer asking once more is lost. A cycle that begins
 * while a run of the task is not finished is a missed deadline, that of the unfinished run, if
 * its timer asked for that: a run that an event woke has none. A cycle that begins while such a run
 * waits is one with it.
 *
 * The time of a run is what the caller says: cyclic_next tells that a run begins or that its time
 * is over, and the caller answers before it asks again.
 */
#ifndef CYCLIC_H
#define CYCLIC_H

#include "processor.h"

enum { CYCLIC_TASKS = 8 }; /* at most */

/* Longest time, offset, cycle, and last clock: more than a thousand years. */
#define CYCLIC_LONGEST ((int64_t)1 << 61)

struct cyclic_config {
    int32_t tasks; /* the first so many are there */
    int32_t priority[CYCLIC_TASKS];
    int64_t cycle[CYCLIC_TASKS];  /* [clocks]; 0: woken only */
    int64_t offset[CYCLIC_TASKS]; /* [clocks] of the first cycle */
};

/* What a task has had so far. */
struct cyclic_use {
    int32_t runs;     /* ended */
    int32_t missed;   /* deadlines */
    int64_t latency;  /* [clocks] longest, due to begin */
    int64_t response; /* [clocks] longest, due to end */
    int64_t busy;     /* [clocks] it has had the processor */
};

struct cyclic_task {
    int64_t cycle;         /* [clocks] */
    int64_t next;          /* [clock] its timer asks again; INT64_MAX without a cycle */
    bool asked;            /* a run waits */
    bool woken;            /* not by its timer */
    int64_t ready;         /* [clock] at which the run that waits may begin, */
    int64_t due;           /* [clock] and from which its latency counts */
    bool active;           /* a run has begun, not ended */
    bool event;            /* that run was woken */
    int64_t from;          /* [clock] that run was due */
    struct cyclic_use use; /* but for `busy`, which the processor knows */
};

struct cyclic {
    struct processor processor; /* everything before its clock is done */
    int running;                /* task that had the clock before; -1 none */
    struct cyclic_task task[CYCLIC_TASKS];
};

enum cyclic_what { CYCLIC_NONE, CYCLIC_BEGIN, CYCLIC_END };

struct cyclic_event {
    enum cyclic_what what;
    int task;
};

void cyclic_start(struct cyclic *s, const struct cyclic_config *config);

/* Ask for a run that was due at a clock and may begin at `ready`; takes the place of one that
 * waits. */
void cyclic_wake(struct cyclic *s, int task, int64_t due, int64_t ready);

/* Let time pass to the next event before `until`; CYCLIC_NONE: none, the clock is there. */
struct cyclic_event cyclic_next(struct cyclic *s, int64_t until);

/* Answer to CYCLIC_BEGIN: the run was due at this clock and needs so many clocks. */
void cyclic_begin(struct cyclic *s, int task, int64_t due, int64_t clocks);

/* Answers to CYCLIC_END: the run needs more clocks; it has ended. */
void cyclic_more(struct cyclic *s, int task, int64_t clocks);
void cyclic_end(struct cyclic *s, int task);

/* What there is to tell at a clock. */
struct cyclic_report {
    int64_t clock;
    int running;
    struct cyclic_use task[CYCLIC_TASKS];
    struct cyclic_use all; /* sums; the longest latency and response */
};

void cyclic_tell(const struct cyclic *s, struct cyclic_report *r);

#endif
