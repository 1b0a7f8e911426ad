/* The card's side of the link: levels as often as one likes, mailboxes once for each number, and
 * what is refused. */
#include "epcio_card.h"
#include "host.h"

static struct epcio card;
static struct mailbox taken;

/* A link whose levels the card takes. */
static struct link_host start(void)
{
    const struct epcio_config config = epcio_default_config();
    CHECK_EQ(epcio_reset(&card, &config), EPCIO_OK);
    taken = (struct mailbox){ 0 };
    return (
        struct link_host){ .dda_length = 12, .dda_divider = 10, .dda_run = true, .min_stock = 3 };
}

static enum epcio_status take(const struct link_host *link)
{
    const enum epcio_status levels = host_take_levels(&taken, &card, link);
    return levels == EPCIO_OK ? host_take_write(&taken, &card, link) : levels;
}

/* A transaction, an acknowledge, an armed latch, an emptied FIFO: once for each number. */
static void mailboxes(void)
{
    struct link_host link = start();
    link.cmd_seq = 7;
    link.cmd_clock = 0.25; /* the next whole clock */
    link.cmd_count = 2;
    link.cmd_frames[0][0] = 5;
    link.cmd_frames[1][3] = -9;
    link.cmd_frames[2][0] = 1000; /* behind the two: of no account */
    for (int i = 0; i < 3; i++) {
        CHECK_EQ(take(&link), EPCIO_OK);
        epcio_advance(&card, 10 + i);
        CHECK_EQ(card.cmd_ack, 7);
        CHECK_EQ(card.frames_taken, 2);
        CHECK_EQ(card.fifo[0].stock, 2);
    }
    link.clear_seq = 1;
    CHECK_EQ(take(&link), EPCIO_OK);
    CHECK_EQ(card.fifo[0].stock, 0);
    link.cmd_seq = 8;
    CHECK_EQ(take(&link), EPCIO_OK);
    CHECK_EQ(take(&link), EPCIO_OK);
    epcio_advance(&card, 20);
    CHECK_EQ(card.fifo[0].stock, 2); /* emptied once */

    irq_raise(&card.irq, IRQ_ADC, 3, card.clock);
    link.irq_mask[IRQ_ADC] = 3;
    link.ack_flags[IRQ_ADC] = 1;
    CHECK_EQ(take(&link), EPCIO_OK);
    CHECK_EQ(card.irq.flags[IRQ_ADC], 3); /* its number is the old one */
    link.ack_seq = 1;
    CHECK_EQ(take(&link), EPCIO_OK);
    CHECK_EQ(card.irq.flags[IRQ_ADC], 2);
    CHECK_EQ(card.irq.mask[IRQ_ADC], 3);

    link.latch_seq[4] = -1;
    CHECK_EQ(take(&link), EPCIO_OK);
    CHECK_EQ(card.latch[4].source, 1u << (LATCH_INDEX + 4));
    CHECK_EQ(card.latch[3].source, 0);
}

/* Each value under its own status; a DDA length that waits stops nothing else. */
static void refused(void)
{
    struct link_host link = start();
    link.dda_length = 16;
    CHECK_EQ(take(&link), EPCIO_BAD_LENGTH);
    link = start();
    link.dda_divider = 0;
    CHECK_EQ(take(&link), EPCIO_BAD_DIVIDER);
    link = start();
    link.min_stock = 63;
    CHECK(take(&link) != EPCIO_OK && card.minimum != 63);
    link = start();
    link.p_gain[5] = -1;
    CHECK_EQ(take(&link), EPCIO_BAD_GAIN);
    link = start();
    link.cmd_seq = 1;
    link.cmd_count = 17;
    CHECK_EQ(take(&link), EPCIO_BAD_COUNT);
    CHECK_EQ(taken.cmd_seq, 0); /* it may come again, mended */
    link.cmd_count = 16;
    link.cmd_frames[15][0] = 4000;
    CHECK_EQ(take(&link), EPCIO_OK);
    epcio_advance(&card, 1);
    link.dda_length = 10;
    link.min_stock = 9;
    CHECK_EQ(host_take_levels(&taken, &card, &link), EPCIO_STOCK_TOO_LARGE);
    CHECK_EQ(card.minimum, 9);
}

/* A host that has said nothing changes nothing: the DDA that runs since power on goes on. */
static void silent(void)
{
    struct link_host link = start();
    CHECK_EQ(take(&link), EPCIO_OK);
    const struct link_host nothing = { .clear_seq = 3, .irq_mask = { 1 }, .p_gain = { 7 } };
    CHECK_EQ(take(&nothing), EPCIO_OK);
    CHECK(card.run);
    CHECK_EQ(card.minimum, 3);
    CHECK_EQ(taken.clear_seq, 0);
    CHECK_EQ(card.irq.mask[0], 0);
    link.dda_length = 0;
    CHECK_EQ(take(&link), EPCIO_BAD_LENGTH); /* it speaks, and is wrong */
}

/* The card shows its counters as 32 bits, and 0 for an axis it does not use. */
static void shown(void)
{
    struct link_host link = start();
    struct link_card shows;
    card.config.active[1] = false;
    card.encoder[0].count = ((int64_t)1 << 32) + 5;
    card.encoder[1].count = 6;
    card.encoder[8].count = ((int64_t)1 << 31);
    card.local.seen.up = 2;
    card.local.seen.down = 0x20;
    CHECK_EQ(take(&link), EPCIO_OK);
    host_show(&card, &shows);
    CHECK_EQ(shows.enc_count[0], 5);
    CHECK_EQ(shows.enc_count[1], 0);
    CHECK_EQ(shows.enc_count_9, INT32_MIN);
    CHECK_EQ(shows.over_travel, 0x2002);
}

int main(void)
{
    mailboxes();
    refused();
    silent();
    shown();
    return check_result();
}
