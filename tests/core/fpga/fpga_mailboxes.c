/* What crosses the link: a mailbox is taken once for each number, and every state is shown. */
#include "fpga_rig.h"
#include "fpga_wires.h"

enum { INPUT = 0x10000 };

static struct fpga_host orders(void)
{
    struct fpga_host host = { .write_seq = 7,
                              .write_clock = 400.5, /* no whole clock: 401 */
                              .write_memory = 1,
                              .write_slots = 3,
                              .out_seq = 2,
                              .out_count = 2,
                              .out_clock = { 601.0, 0.0 },
                              .out_mask = { 6, 8 },
                              .out_value = { 4, 15 },
                              .ao_seq = 1,
                              .ao = { [3] = -5.0 },
                              .run = true,
                              .servo = 0x3f };
    for (int k = 0; k < 3; k++) {
        fpga_slot_pack(host.write_words + 2 * k, (int32_t[8]){ 2, -3, 0, 0, 0, 1, 5 }, FPGA_COUNTS);
    }
    return host;
}

static void plays(void)
{
    struct fpga card = rig_card();
    struct fpga_taken taken = { 0 };
    struct fpga_shown now;
    const struct fpga_host host = orders();

    card.config.input_irq_mask = INPUT;
    fpga_take(&taken, &card, &host);
    fpga_take(&taken, &card, &host); /* no new number: nothing is done again */
    fpga_show(&card, &now);
    CHECK_EQ(now.memory, -1);
    CHECK_EQ(now.write_ack, 0);
    fpga_advance(&card, 400);
    CHECK_EQ(card.outputs, 8);
    CHECK_NEAR(card.ao[3], -5.0, 1e-12);
    fpga_advance(&card, 401);
    fpga_show(&card, &now);
    CHECK_EQ(now.write_ack, 7);
    CHECK_EQ(now.full, 2);
    fpga_set_ai(&card, (double[8]){ [1] = 2.5 });
    fpga_change_input(&card, 16, 790);
    fpga_set_drives(&card, 0x3f, false);
    fpga_advance(&card, 1000);
    CHECK_EQ(card.outputs, 12);
    fpga_show(&card, &now);
    CHECK_EQ(now.memory, 1);
    CHECK_EQ(now.full, 0);
    CHECK_EQ(now.slot, 2);
    CHECK_EQ(now.irq_seq, card.irq.seq);
    CHECK_NEAR(now.irq_clock, 600.0, 0.0); /* as the memory began */
    CHECK_EQ(now.irq_inputs, 0);
    CHECK_NEAR(now.irq_ai[1], 2.5, 1e-12);
    CHECK_EQ(now.input_irq_seq, 1);
    CHECK_NEAR(now.input_irq_clock, 800.0, 0.0);
    CHECK_EQ(now.input_irq_image, INPUT);
    CHECK_EQ(now.inputs, INPUT);
    CHECK_EQ(now.drives, 0x3f);
    CHECK_EQ(now.underruns + now.refused + now.late + now.stopped, 0);
    fpga_advance(&card, 1300); /* its slots end at 1200, and nothing waits */
    fpga_show(&card, &now);
    const int32_t put_out[FPGA_AXES] = { 6, -9, 0, 0, 0, 3 };
    for (int i = 0; i < FPGA_AXES; i++)
        CHECK_EQ(now.pulse_count[i], put_out[i]);
    CHECK_EQ(now.external_count, 15);
    CHECK_EQ(now.underruns, 1);
    CHECK_EQ(now.memory, -1);
}

/* An alarm stops the second slot; then a reset, a write that is refused and an entry too late. */
static void stops(void)
{
    struct fpga card = rig_card();
    struct fpga_taken taken = { 0 };
    struct fpga_shown now;
    struct fpga_host host = orders();

    fpga_take(&taken, &card, &host);
    fpga_advance(&card, 790);
    fpga_set_drives(&card, 0x200, false); /* alarm of the second drive */
    fpga_advance(&card, 900);
    fpga_show(&card, &now);
    CHECK(now.stopped);
    CHECK_NEAR(now.stopped_clock, 800.0, 0.0);
    CHECK_EQ(now.drives, 0x200);
    const int32_t dropped[FPGA_AXES] = { 4, -6, 0, 0, 0, 2 };
    for (int i = 0; i < FPGA_AXES; i++) {
        CHECK_EQ(now.dropped[i], dropped[i]);
        CHECK_EQ(now.pulse_count[i], dropped[i] / 2);
    }
    CHECK_EQ(now.external_dropped, 10);
    CHECK_EQ(now.external_count, 5);
    fpga_set_drives(&card, 0x3f, false);
    fpga_advance(&card, 1000);
    CHECK(card.stopped);
    host.reset_seq = 1;
    host.write_seq = 8;
    host.write_memory = 2;
    host.out_seq = 3; /* the clock of its first entry has passed */
    fpga_take(&taken, &card, &host);
    fpga_advance(&card, 1200);
    fpga_show(&card, &now);
    CHECK(!now.stopped);
    CHECK_EQ(now.refused, 1); /* there is no such memory */
    CHECK_EQ(now.late, 1);
}

int main(void)
{
    plays();
    stops();
    return check_result();
}
