/* Pulse memories in turn: switch, interrupt, deadline, refusals, stops, all to the clock. */
#include "fpga_rig.h"

/* Nothing plays: an interrupt every irq_every. Then each memory's begin, at the clock at which the
 * one before it ends. */
static void switches(void)
{
    struct fpga card = rig_card();
    fpga_advance(&card, 3999);
    CHECK_EQ(card.irq.seq, 0);
    fpga_advance(&card, 4000);
    CHECK_EQ(card.irq.seq, 1);
    fpga_advance(&card, 8100);
    CHECK_EQ(card.irq.seq, 2);
    CHECK_EQ(card.irq.clock, 8000);
    struct fpga_write w = rig_write(0, 20, 3, 8150), v = rig_write(1, 5, 2, 9000);
    CHECK_EQ(fpga_post_write(&card, &w), FPGA_OK);
    CHECK_EQ(fpga_post_write(&card, &v), FPGA_OK);
    fpga_advance(&card, 8199);
    CHECK_EQ(card.playing, -1);
    fpga_advance(&card, 8200);
    CHECK_EQ(card.playing, 0);
    CHECK_EQ(card.irq.clock, 8200);
    CHECK_NEAR(card.rate[0], 3 * 200e3, 1e-6);
    fpga_advance(&card, 8200 + 33 - 1); /* pulse 0 of 3 */
    CHECK_EQ(rig_pulses(&card), 0);
    fpga_advance(&card, 8200 + 33);
    CHECK_EQ(rig_pulses(&card), 1);
    fpga_advance(&card, 8200 + 19 * SLOT + 166);
    CHECK_EQ(rig_pulses(&card), 60);
    CHECK_EQ(fpga_slot(&card), 19);
    fpga_advance(&card, 12199);
    CHECK_EQ(card.irq.seq, 3);
    fpga_advance(&card, 12200);
    CHECK_EQ(card.playing, 1);
    CHECK_EQ(card.irq.seq, 4);
    CHECK_EQ(card.irq.clock, 12200);
    CHECK_EQ(card.underruns, 0);
    fpga_advance(&card, 13200); /* the end: an underrun; the next interrupt is irq_every behind */
    CHECK_EQ(card.underruns, 1);
    CHECK_EQ(rig_pulses(&card), 70);
    fpga_advance(&card, 17199);
    CHECK_EQ(card.irq.seq, 4);
    fpga_advance(&card, 17200);
    CHECK_EQ(card.irq.seq, 5);
    CHECK_EQ(card.late + card.refused, 0);
}

/* The mark comes so many clocks before the switch; `ahead`: it was sent that long before it. */
static void deadline(int64_t before, int64_t ahead)
{
    struct fpga card = rig_card();
    struct fpga_write w = rig_write(0, 20, 49, 100), v = rig_write(1, 20, 7, 4200 - before);
    fpga_post_write(&card, &w);
    fpga_advance(&card, v.clock - ahead);
    fpga_post_write(&card, &v);
    fpga_advance(&card, 4200);
    const bool underrun = before <= 0;
    CHECK_EQ(card.underruns, underrun);
    CHECK_EQ(card.playing, underrun ? -1 : 1);
    CHECK_EQ(rig_pulses(&card), 980);
    /* nothing lost or repeated: it goes on at the first border behind the mark */
    const int64_t start = underrun ? (v.clock / SLOT + 1) * SLOT : 4200;
    fpga_advance(&card, start + 14 - 1);
    CHECK_EQ(rig_pulses(&card), 980);
    fpga_advance(&card, start + 14);
    CHECK_EQ(rig_pulses(&card), 981);
    CHECK_EQ(card.irq.clock, start);
    CHECK_EQ(card.irq.seq, 2);
    fpga_advance(&card, start + 20 * SLOT);
    CHECK_EQ(rig_pulses(&card), 980 + 140);
    CHECK_EQ(card.late, 0);
}

static void deadlines(void)
{
    for (int64_t before = -401; before <= 401; before++) {
        deadline(before, 0);
        deadline(before, 333);
    }
}

/* What the wires bring behind its clock is late if a switch or a waiting exchange lies between. */
static void late_marks(void)
{
    struct fpga card = rig_card();
    struct fpga_write w = rig_write(0, 2, 1, 0), v = rig_write(1, 2, 1, 350);
    fpga_advance(&card, 1000);
    fpga_post_write(&card, &w); /* no clock stated */
    CHECK_EQ(card.late, 0);
    fpga_advance(&card, 1399);
    v.clock = 1201; /* the memory plays since 1200, until 1600 */
    fpga_post_write(&card, &v);
    CHECK_EQ(card.late, 0);
    fpga_advance(&card, 2001);
    CHECK_EQ(card.playing, -1);
    w.clock = 2000;
    fpga_post_write(&card, &w);
    CHECK_EQ(card.late, 0);
    fpga_advance(&card, 2700); /* played 2200 .. 2600 */
    v.clock = 2599;
    fpga_post_write(&card, &v);
    CHECK_EQ(card.late, 1);
    struct fpga_entry e = { .clock = 2601, .mask = 1, .value = 1 };
    fpga_post_entry(&card, &e);
    CHECK_EQ(card.late, 1);
    e.clock = 2600;
    fpga_post_entry(&card, &e);
    CHECK_EQ(card.late, 2);
}

static void refusals(void)
{
    struct fpga card = rig_card();
    struct fpga_write w = rig_write(0, 128, 1, 10), bad = rig_write(1, 3, 2, 10);
    fpga_slot_pack(bad.words + 4, (int32_t[8]){ 0, 0, -50 }, FPGA_COUNTS);
    fpga_post_write(&card, &w);
    fpga_post_write(&card, &bad);
    fpga_post_write(&card, &w); /* full and waits */
    fpga_advance(&card, 10);
    CHECK_EQ(card.refused, 2);
    CHECK_EQ(card.refusal.status, FPGA_NOT_FREE);
    CHECK_EQ(card.memory[1].slots, 0);
    fpga_advance(&card, 300);
    CHECK_EQ(card.playing, 0);
    fpga_post_write(&card, &bad);
    fpga_advance(&card, 301);
    CHECK_EQ(card.refused, 3);
    CHECK_EQ(card.refusal.status, FPGA_BAD_SLOT);
    CHECK_EQ(card.refusal.at.slot, 2);
    CHECK_EQ(card.refusal.at.axis, 2);
    fpga_slot_pack(bad.words + 4, (int32_t[8]){ 0, 0, -49 }, FPGA_COUNTS);
    fpga_post_write(&card, &bad);
    fpga_advance(&card, 302);
    CHECK_EQ(card.refused, 3);
    CHECK_EQ(card.memory[1].slots, 3);
    fpga_post_write(&card, &w);
    fpga_advance(&card, 303);
    CHECK_EQ(card.refusal.status, FPGA_PLAYS);
    CHECK_EQ(card.write_ack, w.seq);
    w.memory = 2;
    CHECK_EQ(fpga_post_write(&card, &w), FPGA_BAD_MEMORY);
    w.memory = 0;
    w.slots = 129;
    CHECK_EQ(fpga_post_write(&card, &w), FPGA_NO_SLOTS);
    w.slots = 0;
    CHECK_EQ(fpga_post_write(&card, &w), FPGA_NO_SLOTS);
    w.slots = 1;
    w.clock = 1 << 30;
    for (int i = 0; i < FPGA_WRITES; i++)
        CHECK_EQ(fpga_post_write(&card, &w), FPGA_OK);
    CHECK_EQ(fpga_post_write(&card, &w), FPGA_ON_THE_WAY);
    CHECK_EQ(card.refused, 8);
    fpga_advance(&card, 200 + 128 * SLOT + 3 * SLOT);
    int64_t pulses[FPGA_PLAYED];
    fpga_pulses(&card, pulses);
    CHECK_EQ(pulses[0], 128 + 6 - 2); /* the last slot of the second has axis 2 alone */
    CHECK_EQ(pulses[2], -49);
}

/* A limit switch that opens to stop, and was open before the card was switched on. */
static void open_switch(void)
{
    struct fpga card = rig_card();
    card.config.stop_mask = card.config.stop_low = 4;
    const struct fpga_config config = card.config;
    fpga_reset(&card, &config);
    fpga_advance(&card, SLOT - 1);
    CHECK(!card.stopped);
    fpga_advance(&card, SLOT);
    CHECK(card.stopped);
    CHECK_EQ(card.stopped_clock, SLOT);
}

/* A stop by any cause: pulses off at the next exchange, counted; it lasts until a reset. */
static void stop(int cause)
{
    struct fpga card = rig_card();
    card.config.stop_mask = 6;
    card.config.stop_low = 4;
    fpga_change_input(&card, 2, 0);
    struct fpga_write w = rig_write(0, 20, 9, 1), v = rig_write(1, 20, -4, 1);
    fpga_post_write(&card, &w);
    fpga_post_write(&card, &v);
    fpga_advance(&card, 1111);
    CHECK_EQ(card.servo, 0x3f);
    if (cause == 0)
        fpga_set_drives(&card, 0x3f, true);
    else if (cause == 1)
        fpga_set_drives(&card, 0x203f, false);
    else
        fpga_change_input(&card, cause == 2 ? 1 : 2, 1150);
    fpga_advance(&card, 1199);
    CHECK(!card.stopped);
    fpga_advance(&card, 1200);
    CHECK(card.stopped);
    CHECK_EQ(card.stopped_clock, 1200);
    CHECK_EQ(card.servo, 0);
    fpga_advance(&card, 9000);
    CHECK_EQ(rig_pulses(&card), 5 * 9);
    CHECK_EQ(card.dropped[0], 15 * 9 - 20 * 4);
    CHECK_EQ(card.dropped[5], 20 * 4 - 15 * 9);
    CHECK_EQ(card.underruns, 0);
    fpga_post_write(&card, &w);
    fpga_advance(&card, 9001);
    CHECK_EQ(card.refusal.status, FPGA_STOPPED);
    fpga_reset_stop(&card); /* the cause is still there */
    fpga_advance(&card, 9300);
    CHECK(card.stopped);
    fpga_set_drives(&card, 0x3f, false);
    if (cause >= 2)
        fpga_change_input(&card, cause == 2 ? 1 : 2, 0);
    fpga_advance(&card, 9999);
    CHECK(card.stopped);
    fpga_reset_stop(&card);
    fpga_advance(&card, 10000);
    CHECK(!card.stopped);
    CHECK_EQ(card.servo, 0x3f);
    fpga_post_write(&card, &w);
    fpga_advance(&card, 20000);
    CHECK_EQ(rig_pulses(&card), 5 * 9 + 20 * 9);
}

/* From a limit switch to the last pulse: at most a slot, whenever it closes. */
static void stop_at_every_clock(void)
{
    for (int64_t edge = 1001; edge <= 1400; edge++) {
        struct fpga card = rig_card();
        card.config.stop_mask = 1;
        struct fpga_write w = rig_write(0, 20, 49, 1);
        fpga_post_write(&card, &w);
        fpga_advance(&card, 1000);
        fpga_change_input(&card, 0, edge);
        const int64_t off = (edge + SLOT - 1) / SLOT * SLOT;
        fpga_advance(&card, off - 1);
        CHECK_EQ(rig_pulses(&card), 49 * (off / SLOT - 1));
        CHECK(!card.stopped);
        fpga_advance(&card, 8000);
        CHECK_EQ(rig_pulses(&card), 49 * (off / SLOT - 1));
        CHECK_EQ(card.stopped_clock, off);
        CHECK_EQ(rig_pulses(&card) + card.dropped[0], 980);
    }
}

int main(void)
{
    switches();
    deadlines();
    late_marks();
    refusals();
    open_switch();
    for (int cause = 0; cause < 4; cause++)
        stop(cause);
    stop_at_every_clock();
    return check_result();
}
