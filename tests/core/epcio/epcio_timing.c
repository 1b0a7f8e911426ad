/* FIFO timing contract of the source document. */
#include "epcio_card.h"

static void refill(struct epcio *card, int frames, int64_t clock)
{
    epcio_advance(card, clock);
    for (int k = 0; k < frames; k++)
        CHECK_EQ(epcio_write_frame(card, (int32_t[6]){ 100, -100, 1, 0, 1023, -1023 }), EPCIO_OK);
    card_acknowledge(card, IRQ_DDA, 0x3F, 1);
}

static int64_t moved_underflows(const struct epcio *card)
{
    return card->underflows[0];
}

/* n = 3, N = 4: stock 7, then 6 5 4 3 and an interrupt, every 4 DDA times; deadline 4 DDA times. */
static void minimum_three_write_four(void)
{
    const int64_t T = 1024;
    struct epcio card = card_stocked(8, 3);
    epcio_advance(&card, T); /* one into the DDA, 7 in stock */
    CHECK_EQ(card.fifo[0].stock, 7);
    for (int round = 0; round < 5; round++) {
        int64_t begin = T + 4 * T * round;
        for (int i = 1; i <= 3; i++) {
            epcio_advance(&card, begin + i * T - 1);
            CHECK_EQ(card.fifo[0].stock, 7 - i + 1);
            epcio_advance(&card, begin + i * T);
            CHECK_EQ(card.fifo[0].stock, 7 - i);
            CHECK_EQ(card.irq.seq, round);
        }
        epcio_advance(&card, begin + 4 * T);
        CHECK_EQ(card.fifo[0].stock, 3);
        CHECK_EQ(card.irq.seq, round + 1);
        CHECK_EQ(card.irq.clock, begin + 4 * T);
        CHECK_EQ(card.irq.flags[IRQ_DDA] & 0x3F, 0x3F);
        refill(&card, 4, begin + 4 * T + 17 * round);
        CHECK_EQ(card.fifo[5].stock, 7);
    }
    CHECK_EQ(moved_underflows(&card), 0);
}

/* The refill may come up to one clock before the deadline (n + 1) T after the interrupt. */
static void deadline(int n, int batch)
{
    const int64_t T = 1024;
    for (int late = -1; late <= 1; late++) {
        struct epcio card = card_stocked(n + 2, n);
        epcio_advance(&card, 2 * T);
        CHECK_EQ(card.irq.clock, 2 * T);
        CHECK_EQ(card.irq.seq, 1);
        CHECK_EQ(card.fifo[0].stock, n);
        refill(&card, batch, 2 * T + (n + 1) * T + late);
        epcio_advance(&card, 2 * T + (n + 2) * T - 1);
        /* at the very deadline the boundary comes first */
        CHECK_EQ(moved_underflows(&card), late < 0 ? 0 : 1);
        int64_t pulses[6];
        epcio_pulses(&card, pulses);
        CHECK_EQ(pulses[0], 100 * (n + 2) + (late < 0 ? 100 : 0));
    }
}

/* The same through the bus: a transaction that arrives at the clock of a boundary is too late for
 * it. An emergency stop drops what is on its way, and counts it. */
static void bus_at_the_boundary(void)
{
    for (int early = 0; early < 2; early++) {
        struct epcio card = card_stocked(1, 0);
        struct bus_write w = { .seq = 5, .clock = 2048 - early, .count = 1, .frame = { { 33 } } };
        epcio_post(&card, &w);
        epcio_advance(&card, 2048);
        CHECK_EQ(card.fifo[0].stock, 1 - early);
        CHECK_EQ(moved_underflows(&card), 1 - early);
        CHECK_EQ(card.cmd_ack, 5);
        w.seq = 6;
        w.clock = 5000;
        w.count = 3;
        epcio_post(&card, &w);
        epcio_clear(&card);
        CHECK_EQ(card.frames_refused, 3);
        CHECK_EQ(card.refusal.status, EPCIO_DROPPED);
        CHECK_EQ(card.cmd_ack, 6);
        epcio_advance(&card, 10000);
        int64_t pulses[6];
        epcio_pulses(&card, pulses);
        CHECK_EQ(pulses[0], 100 + (early ? 33 : 0));
        CHECK_EQ(card.frames_taken, 1);
    }
}

/* n = 0, N = 1: an interrupt each DDA time. */
static void one_by_one(void)
{
    const int64_t T = 1024;
    struct epcio card = card_stocked(1, 0);
    for (int k = 1; k <= 50; k++) {
        epcio_advance(&card, k * T);
        CHECK_EQ(card.irq.seq, k);
        CHECK_EQ(card.irq.clock, k * T);
        refill(&card, 1, k * T + T - 1);
    }
    CHECK_EQ(moved_underflows(&card), 0);
}

/* Half the DDA time and twice the batch: the interrupt period stays. */
static void doubled_points(void)
{
    struct epcio card = card_stocked(0, 3);
    refill(&card, 12, 0);
    int64_t last = 0;
    for (int k = 0; k < 6; k++) {
        while (card.irq.seq == (uint32_t)k)
            epcio_advance(&card, card.clock + 512);
        if (k > 0)
            CHECK_EQ(card.irq.clock - last, 4 * (2 * 1024));
        last = card.irq.clock;
        refill(&card, 8, card.clock);
    }
}

/* The interrupt is an edge: none at rest, none while the stock stays low, one per fall. */
static void edge_of_the_stock(void)
{
    struct epcio card = card_stocked(2, 3); /* never above the minimum */
    epcio_advance(&card, 100 * 1024);
    CHECK_EQ(card.irq.flags[IRQ_DDA] & 0x3F, 0);
    card = card_stocked(6, 3);
    epcio_set_minimum(&card, 6); /* the minimum rises to the stock */
    CHECK_EQ(card.irq.flags[IRQ_DDA] & 0x3F, 0x3F);
    CHECK_EQ(card.irq.seq, 1);
    card = card_stocked(6, 3);
    epcio_clear(&card); /* the stock falls to nothing */
    CHECK_EQ(card.irq.flags[IRQ_DDA] & 0x3F, 0x3F);
    CHECK_EQ(card.fifo[0].stock, 0);
}

/* At one clock the boundary comes before timer and watchdog: the DDA time that ends there is whole
 * and told, and the next command is in the DDA when the watchdog stops it. A little
 * earlier the DDA time is cut off and not told. */
static void watchdog_at_the_boundary(void)
{
    for (int early = 0; early < 2; early++) {
        struct epcio card = card_stocked(3, 0);
        int64_t pulses[6];
        CHECK_EQ(epcio_set_timer(&card, true, 2048 - 20 * early), EPCIO_OK);
        CHECK_EQ(epcio_set_watchdog(&card, true, 1, 500), EPCIO_OK);
        epcio_advance(&card, 1024);
        card_acknowledge(&card, IRQ_DDA, 1u << IRQ_DDA_CYCLE, 1);
        epcio_advance(&card, 2048);
        CHECK(card.watchdog.expired);
        CHECK_EQ(card.irq.flags[IRQ_DDA] >> IRQ_DDA_CYCLE & 1, !early);
        epcio_pulses(&card, pulses);
        CHECK_EQ(pulses[0], early ? 98 : 100); /* 100 * 1004 / 1024 = 98.05 */
        epcio_advance(&card, 9000);
        CHECK_EQ(card.irq.flags[IRQ_DDA] >> IRQ_DDA_CYCLE & 1, !early);
    }
}

int main(void)
{
    minimum_three_write_four();
    deadline(3, 4);
    deadline(0, 1);
    deadline(10, 20);
    bus_at_the_boundary();
    one_by_one();
    doubled_points();
    edge_of_the_stock();
    watchdog_at_the_boundary();
    return check_result();
}
