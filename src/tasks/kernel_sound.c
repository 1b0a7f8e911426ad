#include "kernel_parts.h"

/* Clocks and counts are below this: sums of two of them are numbers. */
static const int64_t LARGEST = (int64_t)1 << 61;

static bool between(int64_t value, int64_t low, int64_t high)
{
    return value >= low && value <= high;
}

static bool config_sound(const struct kernel_config *c)
{
    return between(c->tick, 0, LARGEST) && between(c->tick_time, 0, LARGEST) &&
           between(c->switch_time, 0, LARGEST) && between(c->entry_time, 0, LARGEST);
}

bool kernel_sound(const struct kernel *k, int tasks, int interrupts)
{
    const struct processor *p = &k->processor;
    bool ok = k->config.tasks == tasks && p->tasks == PROCESSOR_TASKS && config_sound(&k->config) &&
              between(p->running, -1, PROCESSOR_TASKS - 1) && between(k->current, -1, tasks - 1) &&
              between(p->clock, 0, LARGEST) && between(k->turns, 0, LARGEST) &&
              between(k->ticks, 0, LARGEST) && between(k->events, 0, LARGEST) &&
              between(p->idle, 0, p->clock) &&
              (k->config.tick == 0 ? k->next_tick == INT64_MAX
                                   : between(k->next_tick, 0, p->clock + k->config.tick));

    for (int i = 0; i < PROCESSOR_TASKS; i++) {
        const struct processor_task *t = &p->task[i];
        const bool used = i < tasks || between(i, KERNEL_TASKS, KERNEL_TASKS + interrupts - 1) ||
                          i == PROCESSOR_TASKS - 1;
        ok = ok && between(t->left, 0, LARGEST) && between(t->busy, 0, p->clock) &&
             (used || !t->ready);
    }
    for (int i = interrupts; i < KERNEL_INTERRUPTS; i++) {
        ok = ok && k->pending[i] == INT64_MAX;
    }
    return ok;
}
