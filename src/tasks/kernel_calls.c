#include "kernel_parts.h"

static bool task_asked(const struct kernel *k)
{
    return k->asked >= 0 && k->asked < KERNEL_TASKS;
}

/* The question is answered. */
static enum kernel_status answered(struct kernel *k)
{
    k->asked = -1;
    return KERNEL_OK;
}

enum kernel_status kernel_compute(struct kernel *k, int64_t time)
{
    if (k->asked < 0) {
        return KERNEL_NOT_ALLOWED;
    }
    if (time < 0) {
        return KERNEL_RANGE;
    }
    processor_compute(&k->processor, k->asked, time);
    return answered(k);
}

/* The most urgent of those that wait for it; -1 nobody does. */
static int waiting(const struct kernel *k, int semaphore)
{
    int best = -1;

    for (int i = 0; i < k->config.tasks; i++) {
        const struct kernel_task *t = &k->task[i];
        const int32_t a = k->processor.task[i].priority;
        const int32_t b = best < 0 ? a : k->processor.task[best].priority;
        if (t->wait == KERNEL_TAKES && t->semaphore == semaphore &&
            (best < 0 || a > b || (a == b && t->order < k->task[best].order))) {
            best = i;
        }
    }
    return best;
}

enum kernel_status kernel_give(struct kernel *k, int semaphore)
{
    if (k->asked < 0 || (!task_asked(k) &&
                         k->config.level[k->asked - KERNEL_TASKS] < k->config.kernel_level)) {
        return KERNEL_NOT_ALLOWED;
    }
    if (semaphore < 0 || semaphore >= KERNEL_SEMAPHORES) {
        return KERNEL_RANGE;
    }
    if (k->full[semaphore]) {
        kernel_note(k, KERNEL_FULL, semaphore, k->asked);
        return KERNEL_WAS_FULL;
    }
    const int task = waiting(k, semaphore);
    kernel_note(k, KERNEL_GIVEN, semaphore, k->asked);
    if (task < 0) {
        k->full[semaphore] = true;
        return answered(k);
    }
    kernel_note(k, KERNEL_TAKEN, semaphore, task);
    kernel_wake(k, task, !task_asked(k));
    if (task_asked(k)) {
        kernel_choose(k);
    }
    return answered(k);
}

enum kernel_status kernel_take(struct kernel *k, int semaphore)
{
    if (!task_asked(k)) {
        return KERNEL_NOT_ALLOWED;
    }
    if (semaphore < 0 || semaphore >= KERNEL_SEMAPHORES) {
        return KERNEL_RANGE;
    }
    if (k->full[semaphore]) {
        k->full[semaphore] = false;
        kernel_note(k, KERNEL_TAKEN, semaphore, k->asked);
        return answered(k);
    }
    k->task[k->asked].wait = KERNEL_TAKES;
    k->task[k->asked].semaphore = semaphore;
    k->task[k->asked].order = ++k->turns;
    processor_block(&k->processor, k->asked);
    kernel_choose(k);
    return answered(k);
}

enum kernel_status kernel_delay(struct kernel *k, int64_t ticks)
{
    if (!task_asked(k)) {
        return KERNEL_NOT_ALLOWED;
    }
    if (ticks < 0) {
        return KERNEL_RANGE;
    }
    if (ticks == 0) {
        k->processor.task[k->asked].turn = ++k->turns;
    } else {
        k->task[k->asked].wait = KERNEL_DELAYED;
        k->task[k->asked].ticks = k->ticks + ticks;
        processor_block(&k->processor, k->asked);
    }
    kernel_choose(k);
    return answered(k);
}

enum kernel_status kernel_set_priority(struct kernel *k, int task, int32_t priority)
{
    if (!task_asked(k)) {
        return KERNEL_NOT_ALLOWED;
    }
    if (task < 0 || task >= k->config.tasks || priority < 0 || priority > KERNEL_PRIORITY_MAX) {
        return KERNEL_RANGE;
    }
    struct processor_task *t = &k->processor.task[task];
    if (t->priority != priority) {
        t->priority = priority;
        t->turn = k->task[task].turn = ++k->turns;
        kernel_note(k, KERNEL_PRIORITY, task, priority);
        kernel_choose(k);
    }
    return answered(k);
}

enum kernel_status kernel_end_interrupt(struct kernel *k, bool yield)
{
    if (k->asked < KERNEL_TASKS) {
        return KERNEL_NOT_ALLOWED;
    }
    processor_block(&k->processor, k->asked);
    k->processor.running = -1;
    if (yield) {
        kernel_choose(k);
    }
    return answered(k);
}
