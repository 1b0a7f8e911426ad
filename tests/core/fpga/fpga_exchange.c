/* Inputs and outputs are exchanged every slot: what is seen and shown when, to the clock. */
#include "fpga_rig.h"

/* An input is seen at the first exchange at or behind its change, by the FPGA's own logic too. */
static void inputs(void)
{
    for (int64_t edge = 1001; edge <= 1401; edge++) {
        struct fpga card = rig_card();
        card.config.follow_mask = 0x80000000;
        card.config.input_irq_mask = 0x80000000;
        fpga_advance(&card, 1000);
        CHECK_EQ(fpga_inputs_changed(&card, 0x80000000), 0x80000000);
        fpga_change_input(&card, 31, edge);
        CHECK_EQ(fpga_inputs_changed(&card, 0x80000000), 0);
        const int64_t seen = (edge + SLOT - 1) / SLOT * SLOT;
        fpga_advance(&card, seen - 1);
        CHECK_EQ(card.inputs.image | card.outputs, 0);
        fpga_advance(&card, 5000);
        CHECK_EQ(card.inputs.image, 0x80000000);
        CHECK_EQ(card.outputs, 0x80000000);
        CHECK_EQ(card.output_clock[31], seen);
        CHECK_EQ(card.input_irq.seq, 1);
        CHECK_EQ(card.input_irq.clock, seen);
        CHECK_EQ(card.input_irq.inputs, 0x80000000);
        CHECK_EQ(card.late, 0);
    }
}

/* Two changes between two readings of the wires, changes at no clock and behind their clock. */
static void changes(void)
{
    struct fpga card = rig_card();
    fpga_advance(&card, 1001);
    fpga_change_input(&card, 0, 1010); /* on its way: 0 -> 1 */
    fpga_advance(&card, 1020);
    fpga_change_input(&card, 0, 1250); /* has been 1 since; back at 1250 */
    fpga_change_input(&card, 1, 1260);
    fpga_change_input(&card, 1, 1270); /* before its clock: it does not come at all */
    fpga_change_input(&card, 2, 0);
    CHECK_EQ(fpga_inputs_changed(&card, 4), 0);
    fpga_advance(&card, 1200);
    CHECK_EQ(card.inputs.image, 5);
    fpga_advance(&card, 1400);
    CHECK_EQ(card.inputs.image, 4);
    CHECK_EQ(card.late, 0);
    fpga_change_input(&card, 3, 1400); /* that exchange is over */
    fpga_change_input(&card, 4, 1401);
    CHECK_EQ(card.late, 1);
    fpga_advance(&card, 1599);
    CHECK_EQ(card.inputs.image, 4);
    fpga_advance(&card, 1600);
    CHECK_EQ(card.inputs.image, 4 + 8 + 16);
}

/* Outputs change at the first exchange not before the clock; of one clock the latest sent wins. */
static void outputs(void)
{
    struct fpga card = rig_card();
    const struct fpga_entry e[] = {
        { .clock = 601, .mask = 3, .value = 2 },
        { .clock = 600, .mask = 1, .value = 5 },
        { .clock = 601, .mask = 2, .value = 0 },
        { .clock = 0, .mask = 0xf0, .value = 0xff },
    };
    fpga_advance(&card, 300);
    for (int i = 0; i < 4; i++)
        CHECK_EQ(fpga_post_entry(&card, &e[i]), FPGA_OK);
    fpga_advance(&card, 399);
    CHECK_EQ(card.outputs, 0);
    fpga_advance(&card, 400);
    CHECK_EQ(card.outputs, 0xf0);
    fpga_advance(&card, 600);
    CHECK_EQ(card.outputs, 0xf1);
    fpga_advance(&card, 800);
    CHECK_EQ(card.outputs, 0xf0);
    CHECK_EQ(card.output_clock[0], 800);
    CHECK_EQ(card.output_clock[1], 0);
    CHECK_EQ(card.output_clock[7], 400);
    for (int i = 0; i < FPGA_WAITING; i++)
        CHECK_EQ(fpga_post_entry(&card, &(struct fpga_entry){ 5000 - i, 1, 1 }), FPGA_OK);
    CHECK_EQ(fpga_post_entry(&card, &e[0]), FPGA_ON_THE_WAY);
    CHECK_EQ(card.refused, 1);
    fpga_advance(&card, 5000);
    CHECK_EQ(card.entering, 0);
    CHECK_EQ(card.late, 0);
}

/* 16 bit of +-10 V, ends included; an interrupt keeps the inputs of its exchange. */
static void analog(void)
{
    struct fpga card = rig_card();
    const double step = 10.0 / 32768,
                 volts[8] = { 10.0, -10.0, 1e9, -1e9, step, 0.4 * step, 0.6 * step, -3.3 };
    const double want[8] = {
        10.0 - step, -10.0, 10.0 - step, -10.0, step, 0.0, step, -10813 * step
    };
    struct fpga_ao a = { .clock = 201 };
    for (int i = 0; i < 8; i++)
        a.volts[i] = volts[i];
    CHECK_EQ(fpga_post_ao(&card, &a), FPGA_OK);
    fpga_advance(&card, 399);
    CHECK_NEAR(card.ao[0], 0.0, 0.0);
    fpga_advance(&card, 400);
    fpga_set_ai(&card, volts);
    fpga_advance(&card, 4000);
    fpga_set_ai(&card, (double[8]){ 0 });
    for (int i = 0; i < 8; i++) {
        CHECK_NEAR(card.ao[i], want[i], 1e-12);
        CHECK_NEAR(card.irq.ai[i], want[i], 1e-12);
    }
}

int main(void)
{
    inputs();
    changes();
    outputs();
    analog();
    return check_result();
}
