/* Notifications: each task has a value that other contexts change and for which it can wait. */
#include "kernel_parts.h"

/* Change a task's value by a notification. Returns false if KERNEL_WRITES_FIRST finds one there. */
static bool change(struct kernel_task *t, enum kernel_notify what, uint32_t value)
{
    switch (what) {
    case KERNEL_SETS_BITS: t->bits |= value; return true;
    case KERNEL_ADDS_ONE:  t->bits++; return true;
    case KERNEL_WRITES_FIRST:
        if (t->notified == KERNEL_NOTIFIED) {
            return false;
        }
        t->bits = value;
        return true;
    case KERNEL_WRITES: t->bits = value; return true;
    default:            return true;
    }
}

enum kernel_status kernel_notify(struct kernel *k, int task, enum kernel_notify what,
                                 uint32_t value)
{
    const enum kernel_status may = kernel_may_call(k, 0);

    if (may || task < 0 || task >= k->config.tasks || what < KERNEL_WAKES
        || what >= KERNEL_NOTIFIES) {
        return may ? may : KERNEL_RANGE;
    }
    struct kernel_task *t = &k->task[task];
    const bool waits = t->notified == KERNEL_WAITING;
    const bool done = change(t, what, value);
    t->notified = KERNEL_NOTIFIED;
    if (waits) {
        kernel_woke(k, kernel_wake(k, task));
    }
    kernel_answered(k);
    return done ? KERNEL_OK : KERNEL_WAS_FULL;
}

void kernel_notify_end(struct kernel_task *t)
{
    t->value = (int32_t)t->bits;
    if (t->call == KERNEL_NOTIFY_TAKES) {
        t->result = t->bits != 0 ? KERNEL_OK : KERNEL_IN_VAIN;
        t->bits -= t->bits == 0 ? 0 : t->clears ? t->bits : 1;
    } else {
        t->result = t->notified == KERNEL_NOTIFIED ? KERNEL_OK : KERNEL_IN_VAIN;
        t->bits &= t->notified == KERNEL_NOTIFIED ? ~t->clears : ~(uint32_t)0;
    }
    t->notified = KERNEL_NOT_WAITING;
    t->call = KERNEL_NO_CALL;
}

/* The task that is asked waits for a notification, unless it is `there` already. */
static enum kernel_status wait(struct kernel *k, enum kernel_call call, uint32_t clears, bool there,
                               int64_t ticks)
{
    struct kernel_task *t = &k->task[k->asked];

    t->call = call;
    t->clears = clears;
    t->result = KERNEL_OK;
    kernel_answered(k);
    if (!there) {
        t->notified = KERNEL_WAITING;
        if (ticks > 0) {
            kernel_block(k, ticks);
            kernel_yield(k);
            return KERNEL_OK;
        }
    }
    if (!kernel_pay(k)) {
        kernel_notify_end(t);
    }
    return (enum kernel_status)t->result;
}

enum kernel_status kernel_notify_take(struct kernel *k, bool clear, int64_t ticks)
{
    if (!kernel_task_asked(k)) {
        return KERNEL_NOT_ALLOWED;
    }
    if (ticks < 0) {
        return KERNEL_RANGE;
    }
    return wait(k, KERNEL_NOTIFY_TAKES, clear, k->task[k->asked].bits != 0, ticks);
}

enum kernel_status kernel_notify_wait(struct kernel *k, uint32_t before, uint32_t after,
                                      int64_t ticks)
{
    if (!kernel_task_asked(k)) {
        return KERNEL_NOT_ALLOWED;
    }
    if (ticks < 0) {
        return KERNEL_RANGE;
    }
    struct kernel_task *t = &k->task[k->asked];
    const bool there = t->notified == KERNEL_NOTIFIED;
    t->bits &= there ? ~(uint32_t)0 : ~before;
    return wait(k, KERNEL_NOTIFY_WAITS, after, there, ticks);
}
