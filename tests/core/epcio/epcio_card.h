/* epcio_card - an EPCIO card for the tests: in standard configuration or with filled FIFOs, with
 * short calls to acknowledge one interrupt page and to sample the encoders. */
#ifndef EPCIO_CARD_H
#define EPCIO_CARD_H

#include "check.h"
#include "registers.h"

/* Power on with the standard configuration. */
static inline struct epcio card_on(void)
{
    struct epcio card;
    const struct epcio_config c = epcio_default_config();
    CHECK_EQ(epcio_reset(&card, &c), EPCIO_OK);
    return card;
}

/* A card with a DDA time of 1024 clocks whose FIFOs hold `stock` commands of 100 pulses on each
 * axis, at clock 0; the FIFO of the first axis interrupts. */
static inline struct epcio card_stocked(int stock, int minimum)
{
    struct epcio card = card_on();
    const uint32_t mask[IRQ_PAGES] = { [IRQ_DDA] = 1 };
    CHECK_EQ(epcio_set_dda(&card, 10, 1), EPCIO_OK);
    CHECK_EQ(epcio_set_minimum(&card, minimum), EPCIO_OK);
    epcio_set_mask(&card, mask);
    for (int k = 0; k < stock; k++)
        CHECK_EQ(epcio_write_frame(&card, (int32_t[6]){ 100, 100, 100, 100, 100, 100 }), EPCIO_OK);
    return card;
}

/* Acknowledge flags of a page and set its mask; the other pages get a mask of 0. */
static inline void card_acknowledge(struct epcio *card, enum irq_page page, uint32_t flags,
                                    uint32_t mask)
{
    uint32_t clear[IRQ_PAGES] = { 0 }, open[IRQ_PAGES] = { 0 };
    clear[page] = flags;
    open[page] = mask;
    epcio_acknowledge(card, clear, open);
}

/* Sample encoder phases; all other inputs are 0. */
static inline enum epcio_status card_sample(struct epcio *card, const double phase[EPCIO_ENCODERS],
                                            int *bad)
{
    struct epcio_lines lines = { .local.power = true };
    for (int i = 0; i < EPCIO_ENCODERS; i++)
        lines.phase[i] = phase[i];
    return epcio_sample(card, &lines, bad);
}

#endif
