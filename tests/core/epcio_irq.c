/* Interrupt latch: no firing is lost between what the host read and what it acknowledges. */
#include "check.h"
#include "epcio.h"
#include "irq.h"

static void line_and_sequence(void)
{
    struct irq q = {0};
    irq_raise(&q, 3, 10);
    CHECK(!q.line);                         /* masked */
    CHECK_EQ(q.flags, 8);
    irq_set_mask(&q, 0xFF, 20);             /* a pending flag pulls when it is let through */
    CHECK(q.line);
    CHECK_EQ(q.seq, 1);
    CHECK_EQ(q.clock, 20);
    irq_raise(&q, 4, 30);                   /* the line is up already */
    CHECK_EQ(q.seq, 1);
    irq_acknowledge(&q, 8, 0xFF, 40);       /* source 4 still waits: the line rises anew */
    CHECK(q.line);
    CHECK_EQ(q.flags, 16);
    CHECK_EQ(q.seq, 2);
    CHECK_EQ(q.clock, 40);
    irq_acknowledge(&q, 16, 0xFF, 50);
    CHECK(!q.line);
    CHECK_EQ(q.flags, 0);
    CHECK_EQ(q.seq, 2);
    irq_acknowledge(&q, 0xFFFF, 0xFF, 60);  /* nothing there: nothing happens */
    CHECK_EQ(q.seq, 2);
    irq_raise(&q, 9, 70);
    irq_acknowledge(&q, 1u << 9, 1u << 9, 80);  /* cleared and let through at once: no pull */
    CHECK_EQ(q.seq, 2);
    irq_raise(&q, 9, 90);
    irq_acknowledge(&q, 0, 0, 100);         /* masked off in the same write: no pull either */
    CHECK(!q.line);
    CHECK_EQ(q.seq, 3);
    CHECK_EQ(q.flags, 1u << 9);
}

/* Fires again after the host looked, before its acknowledge arrives: must come back. */
static void fired_between_read_and_acknowledge(void)
{
    struct irq q = {.mask = 1};
    irq_raise(&q, 0, 10);
    uint32_t seen = q.flags;
    irq_raise(&q, 0, 15);
    CHECK_EQ(q.seq, 1);
    irq_acknowledge(&q, seen, 1, 20);
    CHECK_EQ(q.flags, 1);
    CHECK_EQ(q.seq, 2);
    CHECK_EQ(q.clock, 20);
    irq_acknowledge(&q, q.flags, 1, 30);
    CHECK_EQ(q.flags, 0);
    CHECK(!q.line);
}

/* Random sources, a host that looks late and acknowledges later: after the last firing of a source
 * the host always gets at least one look at its flag. */
static void nothing_is_lost(uint64_t seed)
{
    struct irq q = {.mask = 0x3FFFFF};
    int64_t fired[IRQ_SOURCES] = {0}, served[IRQ_SOURCES] = {0};
    uint32_t served_seq = 0, host_flags = 0;
    int64_t looked = 0, act = INT64_MAX;
    for (int64_t clock = 1; clock < 40000; clock++) {
        if (clock < 39000 && check_random(&seed, 0, 40) == 0) {
            int source = (int)check_random(&seed, 0, IRQ_SOURCES - 1);
            irq_raise(&q, source, clock);
            fired[source] = clock;
        }
        if (act == INT64_MAX && q.seq != served_seq) {
            served_seq = q.seq;                 /* the host takes the interrupt: reads the latch */
            host_flags = q.flags;
            looked = clock;
            act = clock + check_random(&seed, 1, 90);
        } else if (clock == act) {
            for (int i = 0; i < IRQ_SOURCES; i++)
                if (host_flags >> i & 1)
                    served[i] = looked;
            irq_acknowledge(&q, host_flags, q.mask, clock);
            act = INT64_MAX;
        }
    }
    for (int i = 0; i < IRQ_SOURCES; i++) {
        CHECK(fired[i] > 0);
        CHECK(served[i] >= fired[i]);
    }
    CHECK_EQ(q.flags, 0);
    CHECK(!q.line);
}

/* Sources of the card: cycle, overflow edge, index with its interpolated clock. */
static void card_sources(void)
{
    struct epcio_config config = {.active = {true}, .loop = {.limit = 50, .scale = 0}};
    config.encoder[0] = (struct encoder_config){4, false, 10};
    config.encoder[8] = (struct encoder_config){1, false, 10};
    struct epcio card;
    double phase[EPCIO_ENCODERS] = {0};
    int bad;
    epcio_reset(&card, &config);
    epcio_set_dda(&card, 10, 4);
    card.host.loop_on[0] = true;
    epcio_sample(&card, phase, &bad);
    epcio_control(&card);
    epcio_advance(&card, 4000);
    phase[0] = 12.0;
    phase[8] = -1.0;
    epcio_sample(&card, phase, &bad);
    epcio_control(&card);
    CHECK_EQ(card.loop[0].error, -48);
    CHECK_EQ(card.irq.flags, 1u << IRQ_INDEX | 1u << (IRQ_INDEX + 8));
    CHECK_EQ(card.encoder[0].index_clock, 3334);        /* 10/12 of 4000 = 3333.3 */
    CHECK_EQ(card.encoder[8].index_clock, 1);           /* leaves zero at once */
    epcio_advance(&card, 8000);
    CHECK(card.irq.flags >> IRQ_CYCLE & 1);
    for (int k = 0; k < 2; k++) {                       /* at the limit, and beyond: one edge */
        phase[0] = 12.5 + k;
        epcio_acknowledge(&card, 0x3FFFFF, 0);
        epcio_acknowledge(&card, 0x3FFFFF, 0);
        epcio_sample(&card, phase, &bad);
        epcio_control(&card);
        CHECK_EQ(card.irq.flags, k == 0 ? 1u << IRQ_OVERFLOW : 0u);
    }
    phase[7] = 1e300;
    CHECK_EQ(epcio_sample(&card, phase, &bad), EPCIO_BAD_PHASE);
    CHECK_EQ(bad, 7);
}

int main(void)
{
    line_and_sequence();
    fired_between_read_and_acknowledge();
    for (uint64_t seed = 1; seed <= 5; seed++)
        nothing_is_lost(seed * 32452843);
    card_sources();
    return check_result();
}
