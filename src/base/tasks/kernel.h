/* kernel - a small real-time kernel on one processor (processor.h): tasks, semaphores, mutexes,
 * queues, notifications, delays, interrupts and a tick. It models how the software of a controller
 * shares its processor, to the clock.
 *
 * The rules are those of FreeRTOS V11.1 with one processor, preemption and time slices, on a
 * Cortex-M:
 *  - The ready task of the highest priority runs, at once. A preempted task goes on where it was.
 *    Each time the kernel chooses, the next task of equal priority has its turn; the tick makes the
 *    kernel choose if there are several. The first to run is the last of the most urgent tasks.
 *  - A semaphore is a queue without items: binary, counting, or a mutex, which starts available and
 *    which only its holder gives. Giving a full semaphore fails and is not counted.
 *  - A give makes the first waiting task ready, no more: the count stays until that task runs and
 *    takes it. So a second give fails meanwhile; another task may take it first, and then the woken
 *    task waits on.
 *  - The most urgent task waits in front, equal ones in the order in which they began to wait. A
 *    priority that changes meanwhile does not change the place.
 *  - A give of a task that wakes a more urgent task switches inside the give. That of an interrupt
 *    does so when the interrupt ends, if it asks for that; else the next time that the kernel
 *    chooses, at the latest at the tick.
 *  - A task that waits for a mutex lends its priority to the holder (priority inheritance). The
 *    holder has its own again when it has given all its mutexes, or when the task that lent it has
 *    waited in vain.
 *  - A task that lowers its priority yields at once and goes behind the ready tasks of the new
 *    priority.
 *  - A delay or a wait of n ticks ends at the n-th tick from now.
 *  - Interrupts go before all tasks, and among each other by their level, the lowest number first.
 *    An interrupt more urgent than kernel_level must not call the kernel.
 *  - The idle task has priority 0; it yields to others of that priority.
 *
 * Tasks and interrupts are the caller's state machines. kernel_next returns the context, a task or
 * an interrupt, that has to say what it does next; the caller answers by one of the calls below.
 * After a call that takes no time and does not block, kernel_next asks the same context again.
 *
 * At one clock the end of computing comes first, then interrupts, then the switch to another task,
 * then the tick, as their exceptions are ranked. A second tick meanwhile is lost, as the hardware
 * holds only one pending. Interrupt entry, task switch and tick take time in which nothing else
 * happens: the overhead. Interrupts that come meanwhile are served after it.
 */
#ifndef KERNEL_H
#define KERNEL_H

#include <assert.h>

#include "processor.h"

enum {
    KERNEL_TASKS = 15,
    KERNEL_INTERRUPTS = 12,
    KERNEL_QUEUES = 16, /* semaphores, mutexes and queues together */
    KERNEL_ITEMS = 8,   /* largest number of items in a queue */
    KERNEL_LOG = 256    /* events that the log keeps */
};
static_assert(KERNEL_TASKS + KERNEL_INTERRUPTS + 1 == PROCESSOR_TASKS, "and the kernel itself");

/* A time to wait [ticks] that never ends. */
#define KERNEL_FOREVER INT64_MAX

enum kernel_kind { KERNEL_BINARY, KERNEL_COUNTING, KERNEL_MUTEX, KERNEL_QUEUE, KERNEL_KINDS };

struct kernel_queue_config {
    enum kernel_kind kind;
    int32_t length; /* largest count of a counting semaphore; most items of a queue; else unused */
    int32_t count;  /* initial count of a binary or counting semaphore; else 0 */
};

/* All times in units of the caller's clock. */
struct kernel_config {
    int32_t tasks;                    /* number of tasks, all ready at clock 0 */
    int32_t priority[KERNEL_TASKS];   /* 0 .. 1000, the highest first */
    int32_t level[KERNEL_INTERRUPTS]; /* 0 .. 255, the lowest first */
    int32_t kernel_level;             /* interrupts of a lower level must not call the kernel */
    int64_t tick;                     /* period of the tick; 0: no tick */
    int64_t tick_time, switch_time;   /* overhead of a tick; of a switch to another task */
    int64_t entry_time;               /* overhead from an interrupt to its first instruction */
    struct kernel_queue_config queue[KERNEL_QUEUES]; /* all 0: an empty binary semaphore */
};

/* Status of all calls below. */
enum kernel_status {
    KERNEL_OK = 0,
    KERNEL_WAS_FULL = -1,    /* the semaphore was full: the give is not counted */
    KERNEL_NOT_ALLOWED = -2, /* the context may not call this: an interrupt that would block or is
                              * too urgent to call the kernel, a task that ends an interrupt or
                              * gives the mutex of another one, no context asked */
    KERNEL_RANGE = -3,       /* no such task, queue or interrupt; a time below 0 */
    KERNEL_IN_VAIN = -4      /* nothing to take, or no room, before the time to wait was over */
};

/* The call in which a task waits. */
enum kernel_call {
    KERNEL_NO_CALL,
    KERNEL_TAKES,
    KERNEL_RECEIVES,
    KERNEL_SENDS,
    KERNEL_NOTIFY_TAKES,
    KERNEL_NOTIFY_WAITS
};

/* State of a task's notification: none came, the task waits for one, one has come. */
enum kernel_notified { KERNEL_NOT_WAITING, KERNEL_WAITING, KERNEL_NOTIFIED };

struct kernel_task {
    bool chosen;      /* the kernel has chosen it last among the ready tasks of its priority */
    int64_t turn;     /* place in the ring of ready tasks of its priority, ascending */
    int32_t priority; /* the one in force, perhaps lent by a task that waits for its mutex */
    int32_t base;     /* its own priority */
    int32_t rank;     /* priority that decides its place when it waits for a queue */
    int32_t held;     /* number of mutexes that it holds */
    int64_t wake;     /* [tick] at which its delay or wait ends; INT64_MAX never */
    int64_t order;    /* place among the tasks of that tick, ascending */

    enum kernel_call call; /* the call in progress */
    int32_t queue;         /* queue of that call */
    bool waits;            /* it is blocked until that queue changes */
    int64_t place;         /* place among the tasks that wait for that queue, ascending */
    bool lent;             /* it has lent its priority to the holder of the mutex */
    bool expired;          /* its time to wait is over; it has one last attempt */
    int64_t ticks;         /* [ticks] still to wait, counted from `since` */
    int64_t since;         /* [tick] */
    int32_t value;         /* value to be sent, or received */
    int32_t result;        /* enum kernel_status of the latest call */

    enum kernel_notified notified;
    uint32_t bits;   /* the notification's value */
    uint32_t clears; /* bits of it to be cleared when the call ends; for `take`: all, or else 1 */
};

/* A semaphore, a mutex or a queue. */
struct kernel_queue {
    int32_t length, count;      /* largest and present count */
    int32_t holder;             /* task that holds the mutex; -1 none */
    int32_t first;              /* index of the oldest item */
    int32_t item[KERNEL_ITEMS]; /* ring of items */
};

/* Kinds of events in the log; what `number` and `value` mean. */
enum kernel_what {
    KERNEL_RUNS,      /* task `number` gets the processor */
    KERNEL_INTERRUPT, /* interrupt `number` begins */
    KERNEL_GIVEN,     /* context `value` gave semaphore, or sent to queue, `number` */
    KERNEL_FULL,      /* a give of the full semaphore `number` by context `value` failed */
    KERNEL_TAKEN,     /* context `value` took semaphore, or received from queue, `number` */
    KERNEL_PRIORITY,  /* the priority of task `number` is now `value` */
    KERNEL_MARK       /* the caller's own event, by kernel_mark */
};

struct kernel_event {
    int64_t clock;
    enum kernel_what what;
    int32_t number, value;
};

struct kernel {
    struct kernel_config config;
    struct processor processor;
    struct kernel_task task[KERNEL_TASKS + 1]; /* the last is the idle task */
    uint32_t ready;                            /* tasks that are ready, a bit each */
    struct kernel_queue queue[KERNEL_QUEUES];
    uint32_t pending;                 /* interrupts that are pending, a bit each */
    int64_t pends[KERNEL_INTERRUPTS]; /* [clock] at which each became so */
    bool woken[KERNEL_INTERRUPTS];    /* each has woken a task above the current one */
    int32_t received;                 /* value that an interrupt has received last */
    bool chooses;      /* the kernel chooses a task as soon as no interrupt is served */
    bool owed;         /* a task more urgent than the current one is ready: choose at the tick */
    int64_t turns;     /* number of `turn`, `order` and `place` values given out */
    int64_t ticks;     /* number of ticks so far */
    int64_t next_tick; /* [clock] INT64_MAX: no tick */
    int32_t first;     /* task that gets the processor at the start; -1 once it has had it */
    int32_t current;   /* task that runs or that interrupts preempt; -1 the idle task */
    int32_t asked;     /* context that has to answer; -1 none */
    struct kernel_event log[KERNEL_LOG]; /* the latest events: event i is log[i % KERNEL_LOG] */
    int64_t events;                      /* number of events so far */
};

/* Start at clock 0. KERNEL_RANGE, and *k unchanged, if a priority, level, time or count is out of
 * range. */
enum kernel_status kernel_start(struct kernel *k, const struct kernel_config *config);

/* Make an interrupt pending from a clock on; at once if that has passed. An interrupt that is
 * pending already keeps its clock; one that is being served comes once more. */
enum kernel_status kernel_pend(struct kernel *k, int interrupt, int64_t clock);

/* Let time pass until a context has to answer. Returns it: a task, or KERNEL_TASKS + an interrupt;
 * -1 if none has to before the clock `until`, which is then reached. */
int kernel_next(struct kernel *k, int64_t until);

/* Answers of the context that was asked. A time to wait [ticks] must be 0 if that is an interrupt.
 * If a call waits it returns KERNEL_OK; kernel_result has its status when the task is asked next.
 *
 * compute needs the processor for a time. give and take are for semaphores and mutexes; take waits
 * for ever. send and receive are for queues; kernel_value has what was received. end_interrupt ends
 * the interrupt and, with `yield`, lets the kernel choose if it woke a more urgent task. */
enum kernel_status kernel_compute(struct kernel *k, int64_t time);
enum kernel_status kernel_give(struct kernel *k, int semaphore);
enum kernel_status kernel_take(struct kernel *k, int semaphore);
enum kernel_status kernel_take_within(struct kernel *k, int semaphore, int64_t ticks);
enum kernel_status kernel_send(struct kernel *k, int queue, int32_t value, int64_t ticks);
enum kernel_status kernel_receive(struct kernel *k, int queue, int64_t ticks);
enum kernel_status kernel_end_interrupt(struct kernel *k, bool yield);

/* Answers of a task only. kernel_delay waits for so many ticks; 0 yields. kernel_delay_until adds
 * `ticks` to *previous and waits until that tick; if it has passed, it yields. */
enum kernel_status kernel_delay(struct kernel *k, int64_t ticks);
enum kernel_status kernel_delay_until(struct kernel *k, int64_t *previous, int64_t ticks);
enum kernel_status kernel_set_priority(struct kernel *k, int task, int32_t priority);

/* Notifications: each task has a value that other contexts change, which also wakes the task.
 *
 * kernel_notify changes the value of a task; KERNEL_WAS_FULL if KERNEL_WRITES_FIRST finds a
 * notification there. kernel_notify_take waits until the value is not 0, then sets it to 0
 * (`clear`) or decrements it. kernel_notify_wait waits for any notification; it clears the bits
 * `before` when it begins to wait and the bits `after` when a notification has come. kernel_value
 * has the value before take or wait changed it at their end. */
enum kernel_notify {
    KERNEL_WAKES,        /* leaves the value as it is */
    KERNEL_SETS_BITS,    /* value |= the argument */
    KERNEL_ADDS_ONE,     /* value + 1 */
    KERNEL_WRITES,       /* value = the argument */
    KERNEL_WRITES_FIRST, /* the same, but fails if a notification is there */
    KERNEL_NOTIFIES
};
enum kernel_status kernel_notify(struct kernel *k, int task, enum kernel_notify what,
                                 uint32_t value);
enum kernel_status kernel_notify_take(struct kernel *k, bool clear, int64_t ticks);
enum kernel_status kernel_notify_wait(struct kernel *k, uint32_t before, uint32_t after,
                                      int64_t ticks);

/* Status of the latest call of the task that is asked; value that the context has received. */
enum kernel_status kernel_result(const struct kernel *k);
int32_t kernel_value(const struct kernel *k);

/* A task's priority in force, perhaps a lent one. */
int32_t kernel_priority(const struct kernel *k, int task);

/* Append an event KERNEL_MARK to the log. It is no answer: it may be called at any time. */
void kernel_mark(struct kernel *k, int32_t number, int32_t value);

/* Time for which a context, a task or KERNEL_TASKS + an interrupt, has had the processor; for which
 * no context had it; and which the kernel's overhead took. Their sum is the clock. */
int64_t kernel_busy(const struct kernel *k, int context);
int64_t kernel_idle(const struct kernel *k);
int64_t kernel_overhead(const struct kernel *k);

#endif
