/* kernel_parts - what the kernel's files share. */
#ifndef KERNEL_PARTS_H
#define KERNEL_PARTS_H

#include <stddef.h>

#include "kernel.h"

enum { KERNEL_PRIORITY_MAX = 1000, KERNEL_IDLE = KERNEL_TASKS };

void kernel_note(struct kernel *k, enum kernel_what what, int32_t number, int32_t value);

/* The kernel chooses anew as soon as no interrupt is served. */
void kernel_yield(struct kernel *k);

/* The end of a call that kept the kernel from choosing: what is owed is done. Was it? */
bool kernel_pay(struct kernel *k);

/* --- Ready tasks: a ring for each priority, whose hand is at the chosen one; waiting tasks. --- */

/* At the end of its equals, as seen from the hand; no longer; the next one behind the hand. */
void kernel_ready(struct kernel *k, int task);
void kernel_unready(struct kernel *k, int task);
int kernel_choose(struct kernel *k);

/* Tasks of this priority that are ready. */
int kernel_equals(const struct kernel *k, int32_t priority);

/* The current task is no longer ready, for so many ticks. */
void kernel_block(struct kernel *k, int64_t ticks);

/* The most urgent one that waits for a queue, to send or else to get something; -1 nobody. */
int kernel_first_waiting(const struct kernel *k, int queue, bool sends);

/* The current task waits there, by its rank. */
void kernel_wait(struct kernel *k);

/* A blocked task is ready. True: it is more urgent than the current one. */
bool kernel_wake(struct kernel *k, int task);

/* Its priority is another one. */
void kernel_change(struct kernel *k, int task, int32_t priority);

/* The current one's index among the tasks: the idle one has one here. */
static inline int kernel_current(const struct kernel *k)
{
    return k->current < 0 ? KERNEL_IDLE : k->current;
}

/* --- Calls. --- */

static inline bool kernel_task_asked(const struct kernel *k)
{
    return k->asked >= 0 && k->asked < KERNEL_TASKS;
}

/* The question is answered. */
static inline enum kernel_status kernel_answered(struct kernel *k)
{
    k->asked = -1;
    return KERNEL_OK;
}

/* May the context that is asked call, with this time to wait? */
static inline enum kernel_status kernel_may_call(const struct kernel *k, int64_t ticks)
{
    if (k->asked < 0
        || (!kernel_task_asked(k)
            && (k->config.level[k->asked - KERNEL_TASKS] < k->config.kernel_level || ticks > 0))) {
        return KERNEL_NOT_ALLOWED;
    }
    return ticks < 0 ? KERNEL_RANGE : KERNEL_OK;
}

/* The context that is asked has woken a task: it yields, an interrupt keeps that for its end. */
static inline void kernel_woke(struct kernel *k, bool urgent)
{
    k->owed = k->owed || urgent;
    if (urgent && k->asked >= KERNEL_TASKS) {
        k->woken[k->asked - KERNEL_TASKS] = true;
    } else if (urgent) {
        kernel_yield(k);
    }
}

/* The call of a task that has the processor goes on. */
void kernel_go_on(struct kernel *k, int task); /* kernel_waits.c */
void kernel_notify_end(struct kernel_task *t); /* kernel_notify.c */

#endif
