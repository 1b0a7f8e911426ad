/* kernel - a small real-time kernel on that processor: semaphores, delays, interrupts, a tick.
 *
 * The rules are those of FreeRTOS with one processor:
 *  - The highest priority that is ready runs, at once. Equals take turns at the tick. What was
 *    interrupted goes on where it was.
 *  - A semaphore is 0 or 1, empty at first. Giving a full one fails and is not counted. Of those
 *    that wait the most urgent gets it, equals in the order of waiting.
 *  - A give of a task that wakes a more urgent one switches inside the give. A give of an interrupt
 *    does so when the interrupt ends, if it asks for that; else at the next time that the kernel
 *    chooses, the tick at the latest.
 *  - A task that lowers its priority yields at once, and goes behind those of the new one.
 *  - A delay of n ends at the n-th tick from now.
 *  - Interrupts go before all tasks and before each other by their level, the lowest number first.
 *    One more urgent than kernel_level must not call the kernel.
 *
 * Tasks and interrupts are the caller's state machines: kernel_next tells which of them is to say
 * what it does next, and one of the answers below is called. An answer that takes no time and does
 * not block is followed by the same question again.
 *
 * At one clock what is over comes first, then interrupts, then the tick, which waits for them; a
 * second one meanwhile is lost, as the hardware keeps one. Entry, switch and tick take time in
 * which nothing else happens: the overhead. Interrupts that come meanwhile are served after it.
 */
#ifndef KERNEL_H
#define KERNEL_H

#include <assert.h>

#include "processor.h"

enum {
    KERNEL_TASKS = 15, KERNEL_INTERRUPTS = 12, KERNEL_SEMAPHORES = 16,
    KERNEL_LOG = 256
};
static_assert(KERNEL_TASKS + KERNEL_INTERRUPTS + 1 == PROCESSOR_TASKS, "and the kernel itself");

/* All times in units of the caller's clock. */
struct kernel_config {
    int32_t tasks;                      /* the first so many are there, ready at clock 0 */
    int32_t priority[KERNEL_TASKS];     /* 0 .. 1000, the highest first */
    int32_t level[KERNEL_INTERRUPTS];   /* 0 .. 255, the lowest first */
    int32_t kernel_level;               /* interrupts below it must not give */
    int64_t tick;                       /* period; 0: no tick */
    int64_t tick_time, switch_time;     /* what a tick and another task take */
    int64_t entry_time;                 /* from the interrupt to its first line */
};

enum kernel_wait { KERNEL_READY, KERNEL_TAKES, KERNEL_DELAYED, KERNEL_ABSENT };

struct kernel_task {
    enum kernel_wait wait;
    int32_t semaphore;      /* that it takes */
    int64_t order;          /* of waiting */
    int64_t ticks;          /* at which a delay ends */
    bool    hidden;         /* ready, but the kernel has not chosen since */
    int64_t turn;           /* then */
};

/* What the log tells, with a number and a value. */
enum kernel_what {
    KERNEL_RUNS,            /* this task gets the processor */
    KERNEL_INTERRUPT,       /* this interrupt begins */
    KERNEL_GIVEN,           /* this semaphore; by what: value */
    KERNEL_FULL,            /* a give of this semaphore failed; by what: value */
    KERNEL_TAKEN,           /* this semaphore; by which task: value */
    KERNEL_PRIORITY,        /* of this task: value */
    KERNEL_MARK             /* the caller's own: kernel_mark */
};

struct kernel_event {
    int64_t clock;
    enum kernel_what what;
    int32_t number, value;
};

struct kernel {
    struct kernel_config config;
    struct processor processor;
    struct kernel_task task[KERNEL_TASKS];
    bool    full[KERNEL_SEMAPHORES];
    int64_t pending[KERNEL_INTERRUPTS]; /* clock from which it is due; INT64_MAX: it is not */
    bool    chooses;        /* a task, or an interrupt at its end, has made it choose anew */
    int64_t turns;          /* given out */
    int64_t ticks;          /* so far */
    int64_t next_tick;      /* clock; INT64_MAX: none */
    int32_t current;        /* task that has or had the processor last; -1 none */
    int32_t asked;          /* context that is to answer: a task, or KERNEL_TASKS + an interrupt */
    struct kernel_event log[KERNEL_LOG];    /* the latest ones */
    int64_t events;         /* so far; event i is log[i % KERNEL_LOG] */
};

/* The one status of the calls below. */
enum kernel_status {
    KERNEL_OK = 0,
    KERNEL_WAS_FULL = -1,       /* the semaphore had been given already: nothing is counted */
    KERNEL_NOT_ALLOWED = -2,    /* not a call of this context: an interrupt that blocks, or is too
                                 * urgent to give; a task that ends an interrupt; nobody is asked */
    KERNEL_RANGE = -3           /* no such task, semaphore or interrupt; a time below 0 */
};

/* KERNEL_RANGE if a priority, level, time or count is out of range; then *k is as it was. */
enum kernel_status kernel_start(struct kernel *k, const struct kernel_config *config);

/* An interrupt is pending from a clock on, at once if that is behind. One that waits already stays
 * as it is; one that is being served comes once more. */
enum kernel_status kernel_pend(struct kernel *k, int interrupt, int64_t clock);

/* Let time pass to where a context is to answer: a task, or KERNEL_TASKS + an interrupt; -1:
 * nothing more before `until`, the clock is there. */
int kernel_next(struct kernel *k, int64_t until);

/* Answers of what was asked. */
enum kernel_status kernel_compute(struct kernel *k, int64_t time);
enum kernel_status kernel_give(struct kernel *k, int semaphore);
enum kernel_status kernel_take(struct kernel *k, int semaphore);    /* not of an interrupt, nor */
enum kernel_status kernel_delay(struct kernel *k, int64_t ticks);   /* these: 0 yields */
enum kernel_status kernel_set_priority(struct kernel *k, int task, int32_t priority);
enum kernel_status kernel_end_interrupt(struct kernel *k, bool yield);  /* of an interrupt */

/* Can a kernel be in this state, one that may have come from outside: with so many tasks, only the
 * first so many interrupts in use? */
bool kernel_sound(const struct kernel *k, int tasks, int interrupts);

/* A line of the caller's own in the log: no answer, it may stand anywhere. */
void kernel_mark(struct kernel *k, int32_t number, int32_t value);

/* Time that a task, or KERNEL_TASKS + an interrupt, has had the processor; that nobody had it, and
 * that the kernel itself needed. Together they are the clock. */
int64_t kernel_busy(const struct kernel *k, int context);
int64_t kernel_idle(const struct kernel *k);
int64_t kernel_overhead(const struct kernel *k);

#endif
