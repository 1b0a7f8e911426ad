/* processor - one processor shared by tasks of fixed priority: the most urgent ready task runs.
 *
 *   priority ^        .--B--.                A task is ready or not, and needs the processor for
 *            |        |     |                some more time. When that is over its owner says what
 *            |   --A--'     '--A--           comes next: more time, or nothing until it is woken
 *            +----------------------> t      again.
 *
 * Among tasks of equal priority the one with the lowest turn runs, a number that the caller chooses
 * and may change. Time is an integer in units of the caller's clock. Nothing happens by itself:
 * processor_pass lets time pass and stops when the running task's time is over, so that the caller
 * decides the order of events at one clock. kernel.h and cyclic.h are built on it.
 */
#ifndef PROCESSOR_H
#define PROCESSOR_H

#include <stdbool.h>
#include <stdint.h>

enum { PROCESSOR_TASKS = 28 }; /* at most 32: they are bits of a mask */

struct processor_task {
    int32_t priority; /* the highest number first */
    int64_t turn;     /* among equal priorities the lowest number first */
    int64_t left;     /* [clocks] for which it still needs the processor */
    int64_t busy;     /* [clocks] for which it has had the processor */
};

struct processor {
    int tasks;      /* number of tasks */
    uint32_t ready; /* tasks that are ready, a bit each */
    struct processor_task task[PROCESSOR_TASKS];
    int64_t clock; /* present time */
    int64_t idle;  /* [clocks] for which no task had the processor */
    int running;   /* task that has the processor; -1 none */
};

/* Start at clock 0 with a number of tasks, at most PROCESSOR_TASKS; none is ready. */
void processor_start(struct processor *p, int tasks);

/* Make a task ready, with a turn; make it not ready. A woken task needs no time yet: processor_over
 * returns it as soon as it has the processor. */
static inline void processor_wake(struct processor *p, int task, int64_t turn)
{
    struct processor_task *t = &p->task[task];

    p->ready |= (uint32_t)1 << task;
    t->turn = turn;
    t->left = 0;
}

static inline void processor_block(struct processor *p, int task)
{
    p->ready &= ~((uint32_t)1 << task);
}

/* A task needs the processor for so many clocks. */
static inline void processor_compute(struct processor *p, int task, int64_t time)
{
    p->task[task].left = time;
}

static inline bool processor_ready(const struct processor *p, int task)
{
    return p->ready >> task & 1;
}

/* The running task, if it is ready and its time is over; else -1. */
static inline int processor_over(const struct processor *p)
{
    const int r = p->running;
    return r >= 0 && processor_ready(p, r) && p->task[r].left == 0 ? r : -1;
}

/* The most urgent task that is ready; -1 none. */
int processor_first(const struct processor *p);

/* Give the processor to the most urgent ready task. Returns it if its time is over; else -1. */
int processor_dispatch(struct processor *p);

/* Let time pass up to the clock `until`, or to the clock at which the running task's time is
 * over. */
void processor_pass(struct processor *p, int64_t until);

#endif
