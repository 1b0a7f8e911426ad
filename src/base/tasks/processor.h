/* processor - one processor and its tasks: the most urgent one that is ready has it.
 *
 *   priority ^        .--B--.                A task is ready or not, and has some time of the
 *            |        |     |                processor left for what it does. When that is over it
 *            |   --A--'     '--A--           is asked what comes next: more time, or nothing until
 *            +----------------------> t      it is woken again.
 *
 * Among equal priorities the one of the lowest turn has it: a number of the caller's, who may
 * change it. Time is whole units of the caller's clock. Nothing happens by itself: processor_pass
 * lets time go by and stops where the running task's is over, so that the caller decides what comes
 * before what at one clock.
 */
#ifndef PROCESSOR_H
#define PROCESSOR_H

#include <stdbool.h>
#include <stdint.h>

enum { PROCESSOR_TASKS = 28 };

struct processor_task {
    bool ready;
    int32_t priority; /* the highest number first */
    int64_t turn;     /* among equals the lowest first */
    int64_t left;     /* time it still needs for what it does */
    int64_t busy;     /* time it has had the processor */
};

struct processor {
    int tasks; /* the first so many are there */
    struct processor_task task[PROCESSOR_TASKS];
    int64_t clock;
    int64_t idle; /* time that nobody had it */
    int running;  /* that has the processor; -1 none */
};

/* So many tasks, at most PROCESSOR_TASKS; nothing is ready, clock 0. */
void processor_start(struct processor *p, int tasks);

/* A task becomes ready, or no longer is. What is woken has its time over: it is to be asked. */
static inline void processor_wake(struct processor *p, int task, int64_t turn)
{
    struct processor_task *t = &p->task[task];

    t->ready = true;
    t->turn = turn;
    t->left = 0;
}

static inline void processor_block(struct processor *p, int task)
{
    p->task[task].ready = false;
}

/* Answer of a task: it needs so much time. */
static inline void processor_compute(struct processor *p, int task, int64_t time)
{
    p->task[task].left = time;
}

/* The running task, if it is ready and its time is over; else -1. */
static inline int processor_over(const struct processor *p)
{
    const int r = p->running;
    return r >= 0 && p->task[r].ready && p->task[r].left == 0 ? r : -1;
}

/* The most urgent task that is ready; -1 none. */
int processor_first(const struct processor *p);

/* That one has the processor from now on. Returns it if it is to be asked; else -1. */
int processor_dispatch(struct processor *p);

/* Let time pass up to a clock, or to where the running task's time is over. */
void processor_pass(struct processor *p, int64_t until);

#endif
