#include "processor.h"

#include <string.h>

void processor_start(struct processor *p, int tasks)
{
    memset(p, 0, sizeof *p);
    p->tasks = tasks;
    p->running = -1;
}

int processor_first(const struct processor *p)
{
    int best = -1;

    for (int i = 0; p->ready >> i != 0; i++) {
        const struct processor_task *t = &p->task[i], *b = &p->task[best < 0 ? i : best];
        if (processor_ready(p, i)
            && (best < 0 || t->priority > b->priority
                || (t->priority == b->priority && t->turn < b->turn))) {
            best = i;
        }
    }
    return best;
}

int processor_dispatch(struct processor *p)
{
    p->running = processor_first(p);
    return processor_over(p);
}

void processor_pass(struct processor *p, int64_t until)
{
    int64_t time = until - p->clock;

    if (p->running < 0) {
        p->idle += time;
    } else {
        struct processor_task *t = &p->task[p->running];
        time = t->left < time ? t->left : time;
        t->left -= time;
        t->busy += time;
    }
    p->clock += time;
}
