/* kernel_parts - functions that the kernel's own files share: its log, the order of ready and of
 * waiting tasks, and what every call checks and does at its end. Not for the kernel's users. */
#ifndef KERNEL_PARTS_H
#define KERNEL_PARTS_H

#include <stddef.h>

#include "kernel.h"

enum { KERNEL_PRIORITY_MAX = 1000, KERNEL_IDLE = KERNEL_TASKS };

/* Append an event to the log. */
void kernel_note(struct kernel *k, enum kernel_what what, int32_t number, int32_t value);

/* Let the kernel choose a task as soon as no interrupt is served. */
void kernel_yield(struct kernel *k);

/* At the end of a call: yield if a more urgent task is ready (`owed`). Returns whether it did. */
bool kernel_pay(struct kernel *k);

/* --- Ready tasks: a ring for each priority, in which the kernel remembers the task that it has
 * chosen last; waiting tasks. --- */

/* Put a task into its ring, where its turn comes last; take it out; choose the next task of the
 * highest priority. */
void kernel_ready(struct kernel *k, int task);
void kernel_unready(struct kernel *k, int task);
int kernel_choose(struct kernel *k);

/* Number of ready tasks of this priority, the idle one included. */
int kernel_equals(const struct kernel *k, int32_t priority);

/* Block the current task for so many ticks, or until it is woken. */
void kernel_block(struct kernel *k, int64_t ticks);

/* The first task that waits for a queue, to send or else to take or receive; -1 none. */
int kernel_first_waiting(const struct kernel *k, int queue, bool sends);

/* Put the current task, by its rank, among those that wait for the queue of its call. */
void kernel_wait(struct kernel *k);

/* Make a blocked task ready. Returns whether it is more urgent than the current one. */
bool kernel_wake(struct kernel *k, int task);

/* Set a task's priority in force. */
void kernel_change(struct kernel *k, int task, int32_t priority);

static inline bool kernel_is_ready(const struct kernel *k, int task)
{
    return k->ready >> task & 1;
}

/* Index of the current task in `task`; here the idle task has one, too. */
static inline int kernel_current(const struct kernel *k)
{
    return k->current < 0 ? KERNEL_IDLE : k->current;
}

/* --- Calls. --- */

/* Whether a task has to answer, and not an interrupt or nobody. */
static inline bool kernel_task_asked(const struct kernel *k)
{
    return k->asked >= 0 && k->asked < KERNEL_TASKS;
}

/* The context that was asked has answered. */
static inline enum kernel_status kernel_answered(struct kernel *k)
{
    k->asked = -1;
    return KERNEL_OK;
}

/* Whether the context that is asked may call the kernel with this time to wait [ticks]. */
static inline enum kernel_status kernel_may_call(const struct kernel *k, int64_t ticks)
{
    if (k->asked < 0
        || (!kernel_task_asked(k)
            && (k->config.level[k->asked - KERNEL_TASKS] < k->config.kernel_level || ticks > 0))) {
        return KERNEL_NOT_ALLOWED;
    }
    return ticks < 0 ? KERNEL_RANGE : KERNEL_OK;
}

/* The context that is asked has woken a task; if that is urgent, a task yields to it at once, while
 * an interrupt leaves that to its end. */
static inline void kernel_woke(struct kernel *k, bool urgent)
{
    k->owed = k->owed || urgent;
    if (urgent && k->asked >= KERNEL_TASKS) {
        k->woken[k->asked - KERNEL_TASKS] = true;
    } else if (urgent) {
        kernel_yield(k);
    }
}

/* A task that was blocked in a call has the processor again: go on with that call (kernel_waits.c);
 * end the call if it waited for a notification (kernel_notify.c). */
void kernel_go_on(struct kernel *k, int task);
void kernel_notify_end(struct kernel_task *t);

#endif
