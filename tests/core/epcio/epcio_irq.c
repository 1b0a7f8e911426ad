/* Interrupt latch: no firing is lost between what the host read and what it acknowledges. */
#include "epcio_card.h"

#include <string.h>

static void line_and_sequence(void)
{
    struct irq q = { 0 };
    uint32_t all[IRQ_PAGES], none[IRQ_PAGES] = { 0 }, lio[IRQ_PAGES] = { [IRQ_LIO] = 16 };
    uint32_t eight[IRQ_PAGES] = { [IRQ_DDA] = 8 }, last[IRQ_PAGES] = { [IRQ_PCL] = 1u << 5 };
    memset(all, 0xFF, sizeof all);
    irq_raise(&q, IRQ_DDA, 8, 10);
    CHECK(!q.line); /* masked */
    CHECK_EQ(q.flags[IRQ_DDA], 8);
    irq_set_mask(&q, all, 20); /* a pending flag pulls when it is let through */
    CHECK(q.line);
    CHECK_EQ(q.seq, 1);
    CHECK_EQ(q.clock, 20);
    irq_raise(&q, IRQ_LIO, 16, 30); /* the line is up already */
    irq_raise(&q, IRQ_LIO, 0, 31);  /* nothing fires */
    CHECK_EQ(q.seq, 1);
    irq_acknowledge(&q, eight, all, 40); /* the other page still waits: the line rises anew */
    CHECK(q.line);
    CHECK_EQ(q.flags[IRQ_DDA], 0);
    CHECK_EQ(q.flags[IRQ_LIO], 16);
    CHECK_EQ(q.seq, 2);
    CHECK_EQ(q.clock, 40);
    irq_acknowledge(&q, lio, all, 50);
    CHECK(!q.line);
    CHECK_EQ(q.flags[IRQ_LIO], 0);
    CHECK_EQ(q.seq, 2);
    irq_acknowledge(&q, all, all, 60); /* nothing there: nothing happens */
    CHECK_EQ(q.seq, 2);
    irq_set_mask(&q, none, 65);
    irq_raise(&q, IRQ_PCL, 1u << 5, 70);
    irq_acknowledge(&q, last, last, 80); /* cleared and let through at once: no pull */
    CHECK_EQ(q.seq, 2);
    irq_raise(&q, IRQ_PCL, 1u << 5, 90);
    CHECK_EQ(q.seq, 3);
    irq_acknowledge(&q, none, none, 100); /* masked off in the same write: no pull either */
    CHECK(!q.line);
    CHECK_EQ(q.seq, 3);
    CHECK_EQ(q.flags[IRQ_PCL], 1u << 5);
}

/* A source that is told later, as an index is, was first: the line rose with it. */
static void told_later(void)
{
    struct irq q = { .mask = { [IRQ_DDA] = 8, [IRQ_ENC0] = 1 } };
    irq_raise(&q, IRQ_DDA, 8, 20);
    irq_raise(&q, IRQ_ENC0, 2, 5); /* masked */
    CHECK_EQ(q.clock, 20);
    irq_raise(&q, IRQ_ENC0, 1, 15);
    CHECK_EQ(q.clock, 15);
    irq_raise(&q, IRQ_ENC0, 1, 18);
    CHECK_EQ(q.clock, 15);
    CHECK_EQ(q.seq, 1);
}

/* Fires again after the host looked, before its acknowledge arrives: must come back. */
static void fired_between_read_and_acknowledge(void)
{
    struct irq q = { .mask = { [IRQ_ADC] = 1 } };
    struct irq seen;
    irq_raise(&q, IRQ_ADC, 1, 10);
    seen = q;
    irq_raise(&q, IRQ_ADC, 1, 15);
    CHECK_EQ(q.seq, 1);
    irq_acknowledge(&q, seen.flags, seen.mask, 20);
    CHECK_EQ(q.flags[IRQ_ADC], 1);
    CHECK_EQ(q.seq, 2);
    CHECK_EQ(q.clock, 20);
    seen = q;
    irq_acknowledge(&q, seen.flags, seen.mask, 30);
    CHECK_EQ(q.flags[IRQ_ADC], 0);
    CHECK(!q.line);
}

enum { SOURCES = IRQ_PAGES * 16 };

/* Random sources on all pages, a host that looks late and acknowledges later: after the last firing
 * of a source the host always gets at least one look at its flag. */
static void nothing_is_lost(uint64_t seed)
{
    struct irq q, host;
    int64_t fired[SOURCES] = { 0 }, served[SOURCES] = { 0 };
    uint32_t served_seq = 0;
    int64_t looked = 0, act = INT64_MAX;
    memset(&q, 0, sizeof q);
    memset(q.mask, 0xFF, sizeof q.mask);
    for (int64_t clock = 1; clock < 80000; clock++) {
        if (clock < 79000 && check_random(&seed, 0, 20) == 0) {
            int source = (int)check_random(&seed, 0, SOURCES - 1);
            irq_raise(&q, (enum irq_page)(source / 16), 1u << source % 16, clock);
            fired[source] = clock;
        }
        if (act == INT64_MAX && q.seq != served_seq) {
            served_seq = q.seq; /* the host takes the interrupt: reads the latch */
            host = q;
            looked = clock;
            act = clock + check_random(&seed, 1, 90);
        } else if (clock == act) {
            for (int i = 0; i < SOURCES; i++)
                if (host.flags[i / 16] >> i % 16 & 1)
                    served[i] = looked;
            irq_acknowledge(&q, host.flags, host.mask, clock);
            act = INT64_MAX;
        }
    }
    for (int i = 0; i < SOURCES; i++) {
        CHECK(fired[i] > 0);
        CHECK(served[i] >= fired[i]);
    }
    for (int page = 0; page < IRQ_PAGES; page++)
        CHECK_EQ(q.flags[page], 0);
    CHECK(!q.line);
}

/* Sources of the card: cycle, overflow edge, index with its interpolated clock. */
static void card_sources(void)
{
    struct epcio_config config = epcio_default_config();
    config.loop = (struct ploop_config){ .limit = 50, .scale = 0 };
    config.encoder[0].index_lines = config.encoder[8].index_lines = 10;
    config.encoder[8].rate = 1;
    struct epcio card;
    double phase[EPCIO_ENCODERS] = { 0 };
    int bad;
    epcio_reset(&card, &config);
    epcio_set_dda(&card, 10, 4);
    card.host.loop_on[0] = true;
    card_sample(&card, phase, &bad);
    epcio_control(&card);
    epcio_advance(&card, 4000);
    phase[0] = 12.0;
    phase[8] = -1.0;
    card_sample(&card, phase, &bad);
    epcio_control(&card);
    CHECK_EQ(card.loop[0].error, -48);
    CHECK_EQ(card.irq.flags[IRQ_ENC0], 1u << IRQ_ENC_INDEX);
    CHECK_EQ(card.irq.flags[IRQ_ENC6], 0);       /* left the index, did not meet it */
    CHECK_EQ(card.encoder[0].index_clock, 3334); /* 10/12 of 4000 = 3333.3 */
    epcio_advance(&card, 8000);
    CHECK(card.irq.flags[IRQ_DDA] >> IRQ_DDA_CYCLE & 1);
    phase[8] = -10.5;
    card_sample(&card, phase, &bad);
    CHECK_EQ(card.irq.flags[IRQ_ENC6], 1u << (IRQ_ENC_INDEX + 2));
    CHECK_EQ(card.encoder[8].index_clock, 4000 + 3685); /* -9.75 of -1 .. -10.5: 3684.2 */
    for (int k = 0; k < 2; k++) {                       /* at the limit, and beyond: one edge */
        phase[0] = 12.5 + k;
        card_acknowledge(&card, IRQ_PCL, 0x3F, 0);
        card_sample(&card, phase, &bad);
        epcio_control(&card);
        CHECK_EQ(card.irq.flags[IRQ_PCL], k == 0 ? 1u << IRQ_PCL_OV : 0u);
    }
    phase[7] = 1e300;
    CHECK_EQ(card_sample(&card, phase, &bad), EPCIO_BAD_PHASE);
    CHECK_EQ(bad, 7);
}

int main(void)
{
    line_and_sequence();
    told_later();
    fired_between_read_and_acknowledge();
    for (uint64_t seed = 1; seed <= 5; seed++)
        nothing_is_lost(seed * 32452843);
    card_sources();
    return check_result();
}
