#include "isr.h"

#include <stdbool.h>
#include <string.h>

void isr_start(struct isr *q, const struct isr_config *config)
{
    memset(q, 0, sizeof *q);
    q->config = *config;
    q->page = -1;
}

/* Next page to serve: lowest priority number, then lowest page. -1 if none waits. */
static int next_page(const struct isr *q, const bool taken[ISR_PAGES])
{
    int best = -1;

    for (int i = 0; i < ISR_PAGES; i++) {
        if (q->waiting[i] && !taken[i] &&
            (best < 0 || q->config.priority[i] < q->config.priority[best])) {
            best = i;
        }
    }
    return best;
}

int64_t isr_read(struct isr *q, const int32_t flags[ISR_PAGES], int32_t fifo, int64_t raised,
                 int64_t begin)
{
    bool taken[ISR_PAGES] = { false };
    int64_t at = begin > q->busy ? begin : q->busy, service = begin;

    for (int i = 0; i < ISR_PAGES; i++) {
        const int32_t read = flags[i] & (q->config.mask[i] | (i == ISR_FIFO_PAGE ? fifo : 0));
        if (read && !q->waiting[i]) {
            q->raised[i] = raised;
        }
        q->waiting[i] |= read;
    }
    for (int page; (page = next_page(q, taken)) >= 0;) {
        taken[page] = true;
        q->due[page] = at;
        service = page == ISR_FIFO_PAGE ? at : service;
        at += q->config.service;
    }
    return service;
}

static void serve(struct isr *q, int page)
{
    q->order++;
    q->served[page]++;
    q->sources[page] = q->waiting[page];
    q->latency[page] = q->due[page] - q->raised[page];
    q->waiting[page] = 0;
    q->busy = q->due[page] + q->config.service;
    q->page = page;
}

void isr_run(struct isr *q, int64_t end)
{
    for (;;) {
        int first = -1;
        for (int i = 0; i < ISR_PAGES; i++) {
            if (q->waiting[i] && (first < 0 || q->due[i] < q->due[first])) {
                first = i;
            }
        }
        if (first < 0 || q->due[first] >= end) {
            return;
        }
        serve(q, first);
    }
}
