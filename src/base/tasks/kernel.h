/* kernel - a small real-time kernel on that processor: semaphores, mutexes, queues, notifications,
 * delays, interrupts, a tick.
 *
 * The rules are those of FreeRTOS V11.1 with one processor, preemption and time slices, on a
 * Cortex-M:
 *  - The highest priority that is ready runs, at once. What was interrupted goes on where it was.
 *    Each time the kernel chooses, the next of the equals has its turn; the tick makes it choose if
 *    there are any. First to run is the last of the most urgent tasks.
 *  - A semaphore is a queue of nothing: binary, counting, or a mutex, which is there at first and
 *    which only its holder gives. Giving a full one fails and is not counted.
 *  - A give makes the first that waits ready, no more: the count stays until that task runs and
 *    takes it. So a second give fails meanwhile, and another task may be faster; then it waits on.
 *  - The most urgent waits in front, equals in the order of waiting; a priority that changes
 *    meanwhile does not change the place.
 *  - A give of a task that wakes a more urgent one switches inside the give. A give of an interrupt
 *    does so when the interrupt ends, if it asks for that; else at the next time that the kernel
 *    chooses, the tick at the latest.
 *  - Who waits for a mutex lends its holder its priority; the holder has its own again when it has
 *    given all mutexes, or when the one that lent it has waited in vain.
 *  - A task that lowers its priority yields at once, and goes behind those of the new one.
 *  - A delay or a wait of n ends at the n-th tick from now.
 *  - Interrupts go before all tasks and before each other by their level, the lowest number first.
 *    One more urgent than kernel_level must not call the kernel.
 *  - The idle task has priority 0; it yields to others of that priority.
 *
 * Tasks and interrupts are the caller's state machines: kernel_next tells which of them is to say
 * what it does next, and one of the answers below is called. An answer that takes no time and does
 * not block is followed by the same question again.
 *
 * At one clock what is over comes first, then interrupts, then the switch to another task, then the
 * tick, as their exceptions are ranked; a second tick meanwhile is lost, as the hardware keeps one.
 * Entry, switch and tick take time in which nothing else happens: the overhead. Interrupts that
 * come meanwhile are served after it.
 */
#ifndef KERNEL_H
#define KERNEL_H

#include <assert.h>

#include "processor.h"

enum {
    KERNEL_TASKS = 15,
    KERNEL_INTERRUPTS = 12,
    KERNEL_QUEUES = 16,
    KERNEL_ITEMS = 8, /* in a queue, at most */
    KERNEL_LOG = 256
};
static_assert(KERNEL_TASKS + KERNEL_INTERRUPTS + 1 == PROCESSOR_TASKS, "and the kernel itself");

/* As a time to wait [ticks]. */
#define KERNEL_FOREVER INT64_MAX

enum kernel_kind { KERNEL_BINARY, KERNEL_COUNTING, KERNEL_MUTEX, KERNEL_QUEUE, KERNEL_KINDS };

struct kernel_queue_config {
    enum kernel_kind kind;
    int32_t length; /* largest count; items of a queue; else unused */
    int32_t count;  /* of a binary or counting semaphore, at first */
};

/* All times in units of the caller's clock. */
struct kernel_config {
    int32_t tasks;                    /* the first so many are there, ready at clock 0 */
    int32_t priority[KERNEL_TASKS];   /* 0 .. 1000, the highest first */
    int32_t level[KERNEL_INTERRUPTS]; /* 0 .. 255, the lowest first */
    int32_t kernel_level;             /* interrupts below it must not call the kernel */
    int64_t tick;                     /* period; 0: no tick */
    int64_t tick_time, switch_time;   /* what a tick and another task take */
    int64_t entry_time;               /* from the interrupt to its first line */
    struct kernel_queue_config queue[KERNEL_QUEUES]; /* 0: an empty binary semaphore */
};

/* The one status of the calls below. */
enum kernel_status {
    KERNEL_OK = 0,
    KERNEL_WAS_FULL = -1,    /* the semaphore had been given already: nothing is counted */
    KERNEL_NOT_ALLOWED = -2, /* not a call of this context: an interrupt that blocks, or is too
                              * urgent to call; a task that ends an interrupt; a mutex of
                              * another task; nobody is asked */
    KERNEL_RANGE = -3,       /* no such task, queue or interrupt; a time below 0 */
    KERNEL_IN_VAIN = -4      /* it was not there, or had no room, all the time to wait */
};

/* What a task has asked for and has not got. */
enum kernel_call {
    KERNEL_NO_CALL,
    KERNEL_TAKES,
    KERNEL_RECEIVES,
    KERNEL_SENDS,
    KERNEL_NOTIFY_TAKES,
    KERNEL_NOTIFY_WAITS
};

enum kernel_notified { KERNEL_NOT_WAITING, KERNEL_WAITING, KERNEL_NOTIFIED };

struct kernel_task {
    bool ready;
    bool chosen;      /* the last among its equals that the kernel has chosen */
    int64_t turn;     /* place among those that are ready */
    int32_t priority; /* perhaps a lent one; */
    int32_t base;     /* its own */
    int32_t rank;     /* priority by which it waits in front of others */
    int32_t held;     /* mutexes */
    int64_t wake;     /* tick at which it wakes; INT64_MAX never, */
    int64_t order;    /* and its place among those of that tick */

    enum kernel_call call; /* not at its end */
    int32_t queue;         /* of that call */
    bool waits;            /* for that queue, */
    int64_t place;         /* there */
    bool lent;             /* its priority to the holder */
    bool expired;          /* its time is over, it has yet to look a last time */
    int64_t ticks;         /* still to wait, */
    int64_t since;         /* from this tick on */
    int32_t value;         /* to be sent, or that came */
    int32_t result;        /* of the latest call, an enum kernel_status */

    enum kernel_notified notified;
    uint32_t bits;   /* the notification's value */
    uint32_t clears; /* bits to be cleared when the call ends */
};

struct kernel_queue {
    int32_t length, count;
    int32_t holder; /* of the mutex; -1 none */
    int32_t first;  /* item */
    int32_t item[KERNEL_ITEMS];
};

/* What the log tells, with a number and a value. */
enum kernel_what {
    KERNEL_RUNS,      /* this task gets the processor */
    KERNEL_INTERRUPT, /* this interrupt begins */
    KERNEL_GIVEN,     /* this semaphore, or an item to this queue; by what: value */
    KERNEL_FULL,      /* a give of this semaphore failed; by what: value */
    KERNEL_TAKEN,     /* this semaphore, or an item; by what: value */
    KERNEL_PRIORITY,  /* of this task: value */
    KERNEL_MARK       /* the caller's own: kernel_mark */
};

struct kernel_event {
    int64_t clock;
    enum kernel_what what;
    int32_t number, value;
};

struct kernel {
    struct kernel_config config;
    struct processor processor;
    struct kernel_task task[KERNEL_TASKS + 1]; /* and the idle one */
    struct kernel_queue queue[KERNEL_QUEUES];
    int64_t pending[KERNEL_INTERRUPTS]; /* clock from which it is due; INT64_MAX: it is not */
    bool woken[KERNEL_INTERRUPTS];      /* it has woken a task more urgent than the current one */
    int32_t received;                   /* value that an interrupt has received */
    bool chooses;                       /* anew, as soon as no interrupt is served */
    bool owed;         /* a more urgent task is ready, and nobody may have asked to choose */
    int64_t turns;     /* given out */
    int64_t ticks;     /* so far */
    int64_t next_tick; /* clock; INT64_MAX: none */
    int32_t first;     /* task that is to have the processor first; -1 one has had it */
    int32_t current;   /* task that has the processor but for interrupts; -1 the idle one */
    int32_t asked;     /* context that is to answer: a task, or KERNEL_TASKS + an interrupt */
    struct kernel_event log[KERNEL_LOG]; /* the latest ones */
    int64_t events;                      /* so far; event i is log[i % KERNEL_LOG] */
};

/* KERNEL_RANGE if a priority, level, time or count is out of range; then *k is as it was. */
enum kernel_status kernel_start(struct kernel *k, const struct kernel_config *config);

/* An interrupt is pending from a clock on, at once if that is behind. One that waits already stays
 * as it is; one that is being served comes once more. */
enum kernel_status kernel_pend(struct kernel *k, int interrupt, int64_t clock);

/* Let time pass to where a context is to answer: a task, or KERNEL_TASKS + an interrupt; -1:
 * nothing more before `until`, the clock is there. */
int kernel_next(struct kernel *k, int64_t until);

/* Answers of what was asked. Those with a time to wait [ticks] are a task's; of an interrupt the
 * time must be 0. KERNEL_OK of a call that waits: kernel_result has what came of it, when the task
 * is asked next. */
enum kernel_status kernel_compute(struct kernel *k, int64_t time);
enum kernel_status kernel_give(struct kernel *k, int semaphore);
enum kernel_status kernel_take(struct kernel *k, int semaphore); /* waits for ever */
enum kernel_status kernel_take_within(struct kernel *k, int semaphore, int64_t ticks);
enum kernel_status kernel_send(struct kernel *k, int queue, int32_t value, int64_t ticks);
enum kernel_status kernel_receive(struct kernel *k, int queue, int64_t ticks); /* kernel_value */
enum kernel_status kernel_end_interrupt(struct kernel *k, bool yield); /* if it woke a task */

/* Answers of a task alone. A delay of 0 yields. kernel_delay_until: until the tick *previous +
 * ticks, which *previous is then; at once if that is behind. */
enum kernel_status kernel_delay(struct kernel *k, int64_t ticks);
enum kernel_status kernel_delay_until(struct kernel *k, int64_t *previous, int64_t ticks);
enum kernel_status kernel_set_priority(struct kernel *k, int task, int32_t priority);

/* Each task has a value that others change, which also wakes it. `take`: wait until it is not 0,
 * kernel_value has it, then one less, or 0. `wait`: for any notification; the bits are cleared
 * before it waits and when one has come, kernel_value has the value before that. */
enum kernel_notify {
    KERNEL_WAKES,
    KERNEL_SETS_BITS,
    KERNEL_ADDS_ONE,
    KERNEL_WRITES,
    KERNEL_WRITES_FIRST /* fails if one is there */,
    KERNEL_NOTIFIES
};
enum kernel_status kernel_notify(struct kernel *k, int task, enum kernel_notify what,
                                 uint32_t value);
enum kernel_status kernel_notify_take(struct kernel *k, bool clear, int64_t ticks);
enum kernel_status kernel_notify_wait(struct kernel *k, uint32_t before, uint32_t after,
                                      int64_t ticks);

/* What came of the latest call of the context that is asked: its status; the value received. */
enum kernel_status kernel_result(const struct kernel *k);
int32_t kernel_value(const struct kernel *k);

/* Of a task, perhaps a lent one. */
int32_t kernel_priority(const struct kernel *k, int task);

/* A line of the caller's own in the log: no answer, it may stand anywhere. */
void kernel_mark(struct kernel *k, int32_t number, int32_t value);

/* Time that a task, or KERNEL_TASKS + an interrupt, has had the processor; that nobody had it, and
 * that the kernel itself needed. Together they are the clock. */
int64_t kernel_busy(const struct kernel *k, int context);
int64_t kernel_idle(const struct kernel *k);
int64_t kernel_overhead(const struct kernel *k);

#endif
