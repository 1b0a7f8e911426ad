/* The driver's run to the clock: what holds, the next clock that breaks it, and that no pulse is
 * lost however late it is. */
#include <stdlib.h>

#include "controller_rig.h"

/* At rest, a run of so many clocks in all. */
static void runs(int64_t time, int32_t slots, bool holds)
{
    enum { RUNS = 200 };
    const int64_t interval = slots * SLOT;

    rig_document();
    config.slots = slots;
    config.bus = 50;
    config.copy_out = time - WAIT - COPY_IN;
    rig_power_on();
    while (controller.report.runs < RUNS) {
        rig_instant();
    }
    CHECK_EQ(controller.report.run_most, time);
    CHECK_EQ(controller.report.wait_most, WAIT);
    CHECK_EQ(controller.report.spare, interval - time);
    CHECK_EQ(controller.report.busy, (int64_t)RUNS * (time - WAIT));
    /* The first run fills a card that does not play; the last one's end is still to come. */
    CHECK_EQ(controller.report.late, holds ? 0 : RUNS - 1);
    CHECK_EQ(card.underruns, holds ? 0 : RUNS - 2);
    CHECK_EQ(card.refused, 0);
    CHECK_EQ(card.late, 0);
}

/* Axis 1 is jogged while waits are up to ten cycles. */
static void late(void)
{
    enum { INTERRUPTS = 20000 };

    rig_document();
    config.bus = 200;
    config.layers.interrupt =
        (struct latency){ .least = 20, .mean = 300, .most = 40000, .rare = 0.2 };
    rig_power_on();
    while (controller.report.runs < INTERRUPTS) {
        panel.jog[0] = controller.report.runs % 2000 < 1000 ? 1.0 : 0.0;
        rig_instant();
        CHECK(llabs(rig_commanded(0)) >= llabs(rig_shown().pulse_count[0]) || panel.jog[0] != 0.0
              || !robot_idle(&controller.robot));
    }
    panel.jog[0] = 0.0;
    rig_until(now + 200 * INTERVAL);
    CHECK(robot_idle(&controller.robot));
    CHECK_EQ(rig_shown().pulse_count[0], rig_commanded(0));
    CHECK(llabs(rig_commanded(0)) > 10000);
    CHECK_EQ(card.refused, 0);
    const int to_come = controller.report.spare <= 0 && card.playing >= 0;
    CHECK_EQ(card.underruns, controller.report.late - to_come);
    /* exp(-(4000 - RUN) / 300) and a wait of more than 4000 - RUN + WAIT of 40000: 0.187 */
    CHECK_NEAR((double)controller.report.late / controller.report.runs, 0.187, 0.01);
}

/* A stop drops what waits; afterwards the joints are those of the counters. */
static void stop(void)
{
    rig_document();
    config.zero[0] = 0.3;
    rig_power_on();
    panel.jog[0] = 1.0;
    rig_until(4000 * INTERVAL);
    fpga_set_drives(&card, 0, true);
    rig_until(4100 * INTERVAL);
    CHECK(controller.stopped);
    CHECK(card.refused <= 1); /* on its way when the stop came */
    CHECK(card.dropped[0] > 0);
    fpga_set_drives(&card, 0, false);
    panel.jog[0] = 0.0;
    panel.reset = true;
    rig_until(4200 * INTERVAL);
    CHECK(!controller.stopped);
    CHECK_EQ(rig_shown().pulse_count[0], rig_commanded(0));
    panel.jog[0] = -1.0;
    rig_until(5000 * INTERVAL);
    panel.jog[0] = 0.0;
    rig_until(6000 * INTERVAL);
    CHECK_EQ(rig_shown().pulse_count[0], rig_commanded(0));
}

/* Entries leave in the order they came, eight a mailbox; a full box joins the latest. */
static void outbox(void)
{
    struct outbox o = { 0 };
    struct fpga_host to = { 0 };

    outbox_post(&o, &to);
    CHECK_EQ(to.out_seq, 0);
    outbox_put(&o, 5, 0, 1);
    CHECK_EQ(o.count, 0);
    for (int i = 0; i < OUTBOX_SIZE; i++) {
        outbox_put(&o, 100 + i, 1u << (i % 32), ~0u);
    }
    outbox_put(&o, 200, 1, 1);
    CHECK_EQ(o.count, OUTBOX_SIZE);
    for (int n = 0; n < OUTBOX_SIZE / FPGA_ENTRIES; n++) {
        outbox_post(&o, &to);
        CHECK_EQ(to.out_seq, n + 1);
        CHECK_EQ(to.out_count, FPGA_ENTRIES);
        for (int i = 0; i < FPGA_ENTRIES; i++) {
            const int k = n * FPGA_ENTRIES + i;
            const bool last = k == OUTBOX_SIZE - 1;
            CHECK_EQ(to.out_clock[i], last ? 200 : 100 + k);
            CHECK_EQ((uint32_t)to.out_mask[i], last ? 0x80000001 : 1u << (k % 32));
            CHECK_EQ((uint32_t)to.out_value[i], last ? 0x80000001 : 1u << (k % 32));
        }
    }
    outbox_put(&o, 300, 2, 0);
    outbox_post(&o, &to);
    CHECK_EQ(to.out_count, 1);
    CHECK_EQ(o.count, 0);
    outbox_post(&o, &to);
    CHECK_EQ(to.out_seq, OUTBOX_SIZE / FPGA_ENTRIES + 1);
}

int main(void)
{
    runs(RUN, SLOTS, true);
    runs(INTERVAL - 1, SLOTS, true);
    runs(INTERVAL, SLOTS, false);
    runs(INTERVAL + 1, SLOTS, false);
    runs(10 * INTERVAL + 7, SLOTS, false);
    runs(128 * SLOT - 1, 128, true);
    runs(128 * SLOT, 128, false);
    late();
    stop();
    outbox();
    return check_result();
}
