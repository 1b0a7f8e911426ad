#include "isr.h"

#include <string.h>

void isr_start(struct isr *q, const struct isr_config *config)
{
    memset(q, 0, sizeof *q);
    q->config = *config;
    q->page = -1;
}

void isr_read(struct isr *q, const int32_t flags[ISR_PAGES], int32_t fifo, bool asks,
              int64_t raised, int64_t ready)
{
    for (int i = 0; i < ISR_PAGES; i++) {
        const int32_t read = flags[i] & (q->config.mask[i] | (i == ISR_FIFO_PAGE ? fifo : 0));
        const bool keep = asks && i == ISR_FIFO_PAGE && (q->waiting[i] & fifo);
        if (read && !q->waiting[i]) {
            q->raised[i] = raised;
        }
        q->waiting[i] |= read;
        q->ready[i] = keep ? q->ready[i] : ready;
    }
}

int64_t isr_ready(const struct isr *q)
{
    int64_t first = INT64_MAX;
    int32_t waiting = 0;

    for (int i = 0; i < ISR_PAGES; i++) {
        waiting |= q->waiting[i];
    }
    for (int i = 0; i < ISR_PAGES && waiting; i++) {
        first = q->waiting[i] && q->ready[i] < first ? q->ready[i] : first;
    }
    return first;
}

int isr_next(const struct isr *q, int64_t clock)
{
    int best = -1;

    for (int i = 0; i < ISR_PAGES; i++) {
        if (q->waiting[i] && q->ready[i] <= clock
            && (best < 0 || q->config.priority[i] < q->config.priority[best])) {
            best = i;
        }
    }
    return best;
}

void isr_begin(struct isr *q, int page, int64_t clock)
{
    q->order++;
    q->served[page]++;
    q->sources[page] = q->waiting[page];
    q->latency[page] = clock - q->raised[page];
    q->waiting[page] = 0;
    q->page = page;
}
