/* fpga_rig - an FPGA card for the C tests, and writes of pulse memories with equal slots. */
#ifndef FPGA_RIG_H
#define FPGA_RIG_H

#include "check.h"
#include "fpga.h"

enum { SLOT = 200 };

static inline struct fpga rig_card(void)
{
    const struct fpga_config config = {
        .slot_clocks = SLOT,
        .irq_every = 20 * SLOT,
        .alarm_stops = true,
        .stop_servo_off = true,
    };
    struct fpga card;
    fpga_reset(&card, &config);
    fpga_set_host(&card, true, 0x3f);
    return card;
}

/* A write of a memory with a number of slots, each with n pulses of axis 0 and -n of axis 5. */
static inline struct fpga_write rig_write(int32_t memory, int32_t slots, int32_t n, int64_t clock)
{
    static int32_t seq;
    struct fpga_write w = { .seq = ++seq, .clock = clock, .memory = memory, .slots = slots };
    for (int32_t k = 0; k < slots; k++)
        fpga_slot_pack(w.words + 2 * k, (int32_t[8]){ n, 0, 0, 0, 0, -n }, FPGA_COUNTS);
    return w;
}

static inline int64_t rig_pulses(const struct fpga *card)
{
    int64_t pulses[FPGA_PLAYED];
    fpga_pulses(card, pulses);
    CHECK_EQ(pulses[5], -pulses[0]);
    return pulses[0];
}

#endif
