/* Nothing lost or doubled: refusals, conservation of pulses, transactions at their exact clock. */
#include "epcio_card.h"

#include <stdlib.h>
#include <string.h>

/* 63 fit, the 64th is refused, all axes or none; an underflow is counted once per stop. */
static void overflow_and_underflow(void)
{
    struct epcio card = card_stocked(63, 0), before = card;
    int32_t frame[6] = { 1, 2, 3, 4, 5, 6 };
    CHECK_EQ(epcio_write_frame(&card, frame), EPCIO_FIFO_FULL);
    CHECK_EQ(card.refusal.status, EPCIO_FIFO_FULL);
    CHECK(memcmp(card.fifo, before.fifo, sizeof card.fifo) == 0);
    epcio_advance(&card, 1024);
    CHECK_EQ(epcio_write_frame(&card, frame), EPCIO_OK);
    epcio_advance(&card, 70 * 1024);
    for (int i = 0; i < 6; i++) {
        int64_t pulses[6];
        epcio_pulses(&card, pulses);
        CHECK_EQ(pulses[i], 6300 + i + 1);
        CHECK_EQ(card.underflows[i], 1);
    }
    epcio_write_frame(&card, (int32_t[6]){ 100, -100, 1, 0, 1023, -1023 });
    epcio_advance(&card, 80 * 1024);
    CHECK_EQ(card.underflows[0], 2);
    CHECK_EQ(card.underflows[3], 1); /* its last command was no motion */
}

static void refusals(void)
{
    struct epcio_config config = epcio_default_config();
    config.active[4] = false;
    struct epcio card;
    epcio_reset(&card, &config);
    epcio_set_dda(&card, 10, 1);
    CHECK_EQ(epcio_write_frame(&card, (int32_t[6]){ 1023, -1023 }), EPCIO_OK);
    CHECK_EQ(epcio_write_frame(&card, (int32_t[6]){ 0, 1024 }), EPCIO_COMMAND_TOO_LARGE);
    CHECK_EQ(card.refusal.axis, 1);
    CHECK_EQ(card.refusal.command, 1024);
    CHECK_EQ(epcio_write_frame(&card, (int32_t[6]){ 0, 0, INT32_MIN }), EPCIO_COMMAND_TOO_LARGE);
    CHECK_EQ(epcio_write_frame(&card, (int32_t[6]){ 0, 0, 0, 0, 1 }), EPCIO_AXIS_UNUSED);
    CHECK_EQ(card.fifo[0].stock, 1);
    CHECK_EQ(card.fifo[4].stock, 0);
    CHECK_EQ(epcio_set_dda(&card, 9, 1), EPCIO_BAD_LENGTH);
    CHECK_EQ(epcio_set_dda(&card, 16, 1), EPCIO_BAD_LENGTH);
    CHECK_EQ(epcio_set_dda(&card, 10, 0), EPCIO_BAD_DIVIDER);
    CHECK_EQ(epcio_set_dda(&card, 10, 65536), EPCIO_BAD_DIVIDER);
    /* a shorter length must wait for what was written under the longer one */
    CHECK_EQ(epcio_set_dda(&card, 11, 1), EPCIO_OK);
    CHECK_EQ(epcio_write_frame(&card, (int32_t[6]){ 2047 }), EPCIO_OK);
    CHECK_EQ(epcio_set_dda(&card, 10, 1), EPCIO_STOCK_TOO_LARGE);
    epcio_advance(&card, 2 * 2048);
    CHECK_EQ(epcio_set_dda(&card, 10, 1), EPCIO_OK);
}

/* The k-th command in stock. */
static int32_t waiting(const struct epcio *card, int axis, int k)
{
    return card->entry[axis][(card->fifo[axis].head + k) % EPCIO_FIFO_DEPTH];
}

/* Whatever comes (stops, changes of the DDA time, overflow, underflow, clears, late and early
 * transactions): pulses out = commands taken, axis by axis, and every frame is accounted for. */
static void conservation(uint64_t seed)
{
    struct epcio card = card_on();
    int64_t sent = 0, popped[6] = { 0 };
    int32_t seq = 0;
    for (int event = 0; event < 4000; event++) {
        epcio_advance(&card, card.clock + check_random(&seed, 0, 6000));
        int32_t taken = card.frames_taken;
        struct bus_write w = { .seq = ++seq,
                               .count = (int32_t)check_random(&seed, 0, 16),
                               .clock = card.clock + check_random(&seed, -2000, 9000) };
        int64_t sum[6] = { 0 };
        for (int k = 0; k < w.count; k++)
            for (int i = 0; i < 6; i++) {
                int32_t top = k == 7 && event % 9 == 0 ? 40000 : 1023;
                w.frame[k][i] = (int32_t)check_random(&seed, -top, top);
            }
        switch (check_random(&seed, 0, 7)) {
        case 0: epcio_set_run(&card, !card.run); break;
        case 1:
            epcio_set_dda(&card, (int32_t)check_random(&seed, 10, 15),
                          (int32_t)check_random(&seed, 1, 3));
            break;
        case 2: epcio_set_minimum(&card, (int32_t)check_random(&seed, 0, 62)); break;
        case 3:
            if (event % 10 == 0) {
                for (int i = 0; i < 6; i++)
                    for (int k = 0; k < card.fifo[i].stock; k++)
                        popped[i] -= waiting(&card, i, k);
                epcio_clear(&card);
            }
            break;
        default:
            /* alone on the bus, so that what of it was taken can be told */
            epcio_set_run(&card, true);
            if (bus_due(&card.bus) == INT64_MAX && epcio_post(&card, &w) == EPCIO_OK) {
                sent += w.count;
                int64_t due = w.clock > card.clock ? w.clock : card.clock;
                epcio_advance(&card, due);
                CHECK_EQ(card.cmd_ack, w.seq);
                for (int k = 0; k < card.frames_taken - taken; k++)
                    for (int i = 0; i < 6; i++)
                        sum[i] += w.frame[k][i];
            }
        }
        CHECK_EQ(sent, card.frames_taken + card.frames_refused);
        int64_t pulses[6];
        epcio_pulses(&card, pulses);
        for (int i = 0; i < 6; i++) {
            popped[i] += sum[i];
            int64_t stock = 0;
            for (int k = 0; k < card.fifo[i].stock; k++)
                stock += waiting(&card, i, k);
            /* taken = put out by past DDA times + in the DDA + in stock */
            CHECK_EQ(popped[i], card.dda.before[i] + card.dda.command[i] + stock);
            CHECK(llabs(pulses[i] - card.dda.before[i]) <= llabs(card.dda.command[i]));
        }
    }
    CHECK(card.frames_refused > 0 && card.frames_taken > 1000 && card.underflows[0] > 10);
}

/* A transaction is applied at its very clock, whatever steps lead there. */
static void exact_arrival(uint64_t seed)
{
    for (int trial = 0; trial < 200; trial++) {
        struct epcio a = card_stocked(4, 2), b = a;
        struct bus_write w = { .seq = 1,
                               .clock = check_random(&seed, 1, 6000),
                               .count = 2,
                               .frame = { { 7, 8, 9, 1, 2, 3 }, { -7, 8, 9, 1, 2, 3 } } };
        epcio_post(&a, &w);
        epcio_post(&b, &w);
        epcio_advance(&a, w.clock - 1);
        CHECK_EQ(a.frames_taken, 0);
        epcio_advance(&a, w.clock);
        CHECK_EQ(a.frames_taken, 2);
        epcio_advance(&a, 8000);
        while (b.clock < 8000) {
            int64_t to = b.clock + check_random(&seed, 0, 900);
            epcio_advance(&b, to < 8000 ? to : 8000);
        }
        CHECK(memcmp(&a, &b, sizeof a) == 0);
    }
    struct epcio card = card_stocked(0, 0);
    struct bus_write w = { .seq = 1, .clock = 100 };
    for (int k = 0; k < BUS_DEPTH; k++, w.seq++)
        CHECK_EQ(epcio_post(&card, &w), EPCIO_OK);
    CHECK_EQ(epcio_post(&card, &w), EPCIO_BUS_FULL);
    epcio_advance(&card, 99);
    CHECK_EQ(card.cmd_ack, 0);
    epcio_advance(&card, 100);
    CHECK_EQ(card.cmd_ack, BUS_DEPTH);
    w.clock = 500;
    epcio_post(&card, &w);
    w.clock = 300; /* sent later, so it arrives no earlier */
    w.seq++;
    epcio_post(&card, &w);
    epcio_advance(&card, 499);
    CHECK_EQ(card.cmd_ack, BUS_DEPTH);
    epcio_advance(&card, 500);
    CHECK_EQ(card.cmd_ack, w.seq);
}

int main(void)
{
    overflow_and_underflow();
    refusals();
    for (uint64_t seed = 1; seed <= 3; seed++)
        conservation(seed * 15485863);
    exact_arrival(99);
    return check_result();
}
