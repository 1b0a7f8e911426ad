/* A million interrupts served after random latencies: pulses out are pulses written, always. */
#include "fpga_rig.h"

enum { INTERRUPTS = 1000000 };

/* The write that answers an interrupt: the free memory, slots and pulses at random. */
static struct fpga_write answer(const struct fpga *card, uint64_t *random, int64_t *sum)
{
    const int32_t memory =
        card->playing >= 0 ? 1 - card->playing : (int32_t)check_random(random, 0, 1);
    struct fpga_write w = { .memory = memory, .slots = (int32_t)check_random(random, 1, 24) };
    for (int32_t k = 0; k < w.slots; k++) {
        int32_t n[FPGA_SLOT_AXES] = { 0 };
        for (int i = 0; i < FPGA_PLAYED; i++) {
            n[i] = (int32_t)check_random(random, -49, 49);
            sum[i] += n[i];
        }
        fpga_slot_pack(w.words + 2 * k, n, FPGA_COUNTS);
    }
    return w;
}

int main(void)
{
    uint64_t random = 14;
    int64_t sum[FPGA_PLAYED] = { 0 }, before[FPGA_PLAYED] = { 0 }, pulses[FPGA_PLAYED];
    int64_t deadline = 0, early = 0;
    struct fpga card = rig_card();
    fpga_advance(&card, 4000);
    for (int32_t k = 1; k <= INTERRUPTS; k++) {
        struct fpga_write w = answer(&card, &random, sum);
        /* mostly before the end of the memory that plays, sometimes far behind it */
        const int64_t latency = check_random(&random, 0, check_random(&random, 0, 3) ? 2400 : 7000);
        w.clock = card.irq.clock + latency;
        const int64_t end =
            card.playing < 0 ? 0 : card.start + card.memory[card.playing].slots * (int64_t)SLOT;
        deadline += end && w.clock >= end;
        early += end && w.clock < end;
        fpga_post_write(&card, &w);
        const int64_t begin = end && w.clock < end ? end : (w.clock / SLOT + 1) * SLOT;
        fpga_advance(&card, begin - 1);
        fpga_pulses(&card, pulses);
        for (int i = 0; i < FPGA_PLAYED; i++) {
            CHECK_EQ(pulses[i], before[i]); /* all that was written before this write */
            before[i] = sum[i];
        }
        fpga_advance(&card, begin);
        CHECK_EQ(card.irq.clock, begin);
        CHECK_EQ(card.underruns, deadline);
        if (check_failures > 20)
            return check_result();
    }
    printf("%d interrupts, %lld in time, %lld behind the deadline: each of these an underrun\n",
           INTERRUPTS, (long long)early, (long long)deadline);
    fpga_advance(&card, card.clock + FPGA_SLOTS * SLOT);
    fpga_pulses(&card, pulses);
    for (int i = 0; i < FPGA_PLAYED; i++)
        CHECK_EQ(pulses[i], sum[i]);
    CHECK(deadline > INTERRUPTS / 10 && early > INTERRUPTS / 10);
    CHECK_EQ(card.refused + card.late, 0);
    return check_result();
}
