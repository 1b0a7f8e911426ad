#include "kernel_parts.h"

enum kernel_status kernel_compute(struct kernel *k, int64_t time)
{
    if (k->asked < 0) {
        return KERNEL_NOT_ALLOWED;
    }
    if (time < 0) {
        return KERNEL_RANGE;
    }
    processor_compute(&k->processor, k->asked, time);
    return kernel_answered(k);
}

enum kernel_status kernel_delay(struct kernel *k, int64_t ticks)
{
    if (!kernel_task_asked(k)) {
        return KERNEL_NOT_ALLOWED;
    }
    if (ticks < 0) {
        return KERNEL_RANGE;
    }
    if (ticks > 0) {
        kernel_block(k, ticks);
    }
    kernel_yield(k);
    return kernel_answered(k);
}

enum kernel_status kernel_delay_until(struct kernel *k, int64_t *previous, int64_t ticks)
{
    if (!kernel_task_asked(k)) {
        return KERNEL_NOT_ALLOWED;
    }
    if (ticks < 0 || ticks > INT64_MAX / 2 || *previous < 0 || *previous > INT64_MAX / 2) {
        return KERNEL_RANGE;
    }
    *previous += ticks;
    return kernel_delay(k, *previous > k->ticks ? *previous - k->ticks : 0);
}

enum kernel_status kernel_set_priority(struct kernel *k, int task, int32_t priority)
{
    if (!kernel_task_asked(k)) {
        return KERNEL_NOT_ALLOWED;
    }
    if (task < 0 || task >= k->config.tasks || priority < 0 || priority > KERNEL_PRIORITY_MAX) {
        return KERNEL_RANGE;
    }
    struct kernel_task *t = &k->task[task];
    if (t->base != priority) {
        const bool chooses = task == k->asked
                                 ? priority < t->base
                                 : priority > t->base && priority > k->task[k->asked].priority;
        const bool lent = t->base != t->priority && priority <= t->priority;
        t->base = t->rank = priority;
        kernel_change(k, task, lent ? t->priority : priority);
        if (chooses) {
            kernel_yield(k);
        }
    }
    return kernel_answered(k);
}

enum kernel_status kernel_end_interrupt(struct kernel *k, bool yield)
{
    if (k->asked < KERNEL_TASKS) {
        return KERNEL_NOT_ALLOWED;
    }
    processor_block(&k->processor, k->asked);
    k->processor.running = -1;
    if (yield && k->woken[k->asked - KERNEL_TASKS]) {
        kernel_yield(k);
    }
    return kernel_answered(k);
}

enum kernel_status kernel_result(const struct kernel *k)
{
    return kernel_task_asked(k) ? (enum kernel_status)k->task[k->asked].result : KERNEL_NOT_ALLOWED;
}

int32_t kernel_value(const struct kernel *k)
{
    return kernel_task_asked(k) ? k->task[k->asked].value : k->received;
}
