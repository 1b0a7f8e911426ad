/* Service order of many sources behind one interrupt line. */
#include "isr.h"
#include "mcc_check.h"

static const struct isr_config ALL = { .mask = { 64, 63, 63, 63, 16383, 16383, 1023, 65535, 63 },
                                       .priority = { 3, 4, 4, 4, 6, 6, 5, 2, 1 },
                                       .service = 100 };

/* A PC with nothing else to do serves until a clock; busy is when it can begin the next page. */
static void serve(struct isr *q, int64_t *busy, int64_t end)
{
    for (;;) {
        const int64_t ready = isr_ready(q), at = ready > *busy ? ready : *busy;
        if (ready == INT64_MAX || at >= end) {
            return;
        }
        isr_begin(q, isr_next(q, at), at);
        *busy = at + q->config.service;
    }
}

/* Everything at once: position loops, local I/O, FIFO, encoders 1-9, ADC, remote sets. */
static void all_at_once(void)
{
    static const int ORDER[ISR_PAGES] = { 8, 7, 0, 1, 2, 3, 6, 4, 5 };
    const int32_t flags[ISR_PAGES] = { 1, 9, 1, 2, 4096, 1, 256, 32768, 32 };
    struct isr q;
    int64_t busy = 0;

    isr_start(&q, &ALL);
    CHECK_EQ(isr_ready(&q), INT64_MAX);
    isr_read(&q, flags, 1, false, 1000, 1500);
    CHECK_EQ(isr_ready(&q), 1500);
    CHECK_EQ(isr_next(&q, 1499), -1);
    serve(&q, &busy, 1500);
    CHECK_EQ(q.order, 0);
    for (int i = 0; i < ISR_PAGES; i++) {
        serve(&q, &busy, 1501 + 100 * i);
        CHECK_EQ(q.order, i + 1);
        CHECK_EQ(q.page, ORDER[i]);
        CHECK_EQ(q.latency[ORDER[i]], 500 + 100 * i);
        CHECK_EQ(q.sources[ORDER[i]], flags[ORDER[i]]);
    }
    serve(&q, &busy, 1000000);
    CHECK_EQ(q.order, ISR_PAGES);
}

/* A page that waits lets a more urgent one pass that comes later; its latency counts from its own
 * interrupt; a page being served is not interrupted. */
static void a_later_and_more_urgent_one(void)
{
    struct isr q;
    int64_t busy = 0;
    int32_t flags[ISR_PAGES] = { 0, 0, 0, 0, 1, 1 };

    isr_start(&q, &ALL);
    isr_read(&q, flags, 1, false, 0, 50);
    serve(&q, &busy, 60);
    CHECK_EQ(q.page, 4); /* until 150 */
    flags[4] = flags[5] = 0;
    flags[8] = 1;
    isr_read(&q, flags, 1, false, 70, 80);
    serve(&q, &busy, 151);
    CHECK_EQ(q.page, 8);
    CHECK_EQ(q.latency[8], 80);
    serve(&q, &busy, 251);
    CHECK_EQ(q.page, 5);
    CHECK_EQ(q.latency[5], 250);
    CHECK_EQ(q.served[4] + q.served[5] + q.served[8], 3);
}

/* A source that the mask keeps back, or one that fires again while its page waits. */
static void masked_and_merged(void)
{
    struct isr q;
    int64_t busy = 0;
    int32_t flags[ISR_PAGES] = { 64 + 2, 64 };

    isr_start(&q, &ALL);
    isr_read(&q, flags, 1, false, 0, 10);
    CHECK_EQ(q.waiting[0], 64); /* the FIFO of the second axis is not the watched one */
    CHECK_EQ(q.waiting[1], 0);
    flags[0] = 1;
    isr_read(&q, flags, 1, true, 5, 20);
    serve(&q, &busy, 1000);
    CHECK_EQ(q.served[0], 1);
    CHECK_EQ(q.sources[0], 65);
    CHECK_EQ(q.latency[0], 20); /* from the first of the two */
}

int main(void)
{
    all_at_once();
    a_later_and_more_urgent_one();
    masked_and_merged();
    return check_result();
}
