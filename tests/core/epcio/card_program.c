/* A C program that uses the card as a library: one axis moves 20,000 pulses and back through the
 * position loop, on a motor that follows the voltage with 50 counts/s per mV, an index every turn.
 *
 *     card_program            checks where the axis ends
 *     card_program --table    also prints, every instant of 100 us:
 *                             phase pulses counts error volts stock interrupts latched
 */
#include <math.h>
#include <string.h>

#include "check.h"
#include "registers.h"

enum { PERIOD = 4000, INSTANTS = 12000, FRAMES = 400, GAIN = 200, LINES = 500 };

/* Command of the n-th DDA time: up, down, and the same backwards [pulses]. */
static int32_t command(int n)
{
    int half = n % (FRAMES / 2), ramp = half < FRAMES / 4 ? half + 1 : FRAMES / 2 - half;
    return n >= FRAMES ? 0 : (n < FRAMES / 2 ? 2 : -2) * ramp;
}

static struct epcio power_on(void)
{
    struct epcio card;
    struct epcio_config config = epcio_default_config();
    for (int i = 1; i < EPCIO_AXES; i++)
        config.active[i] = false;
    config.encoder[0].index_lines = LINES;
    CHECK_EQ(epcio_reset(&card, &config), EPCIO_OK);
    const uint32_t mask[IRQ_PAGES] = { [IRQ_DDA] = 1, [IRQ_ENC0] = 1u << IRQ_ENC_INDEX };
    const struct epcio_host host = { .gain = { GAIN }, .loop_on = { true }, .dac_loop = { true } };
    CHECK_EQ(epcio_set_dda(&card, 12, 5), EPCIO_OK);
    CHECK_EQ(epcio_set_minimum(&card, 3), EPCIO_OK);
    CHECK_EQ(epcio_set_latch(&card, 0, 1u << LATCH_INDEX, true), EPCIO_OK);
    CHECK_EQ(epcio_set_host(&card, &host), EPCIO_OK);
    epcio_set_mask(&card, mask);
    return card;
}

/* The host: four commands when the stock has fallen to three, acknowledge what was read. */
static void serve(struct epcio *card, int *n)
{
    uint32_t read[IRQ_PAGES], mask[IRQ_PAGES];
    memcpy(read, card->irq.flags, sizeof read);
    memcpy(mask, card->irq.mask, sizeof mask);
    if (card->irq.line)
        epcio_acknowledge(card, read, mask);
    if (card->fifo[0].stock > 3)
        return;
    for (int k = 0; k < 4; k++)
        CHECK_EQ(epcio_write_frame(card, (int32_t[EPCIO_AXES]){ command((*n)++) }), EPCIO_OK);
}

int main(int argc, char **argv)
{
    const int table = argc > 1 && strcmp(argv[1], "--table") == 0;
    struct epcio card = power_on();
    struct epcio_lines lines = { .local.power = true };
    int64_t pulses[EPCIO_AXES], out = 0;
    int n = 0, bad;
    for (int64_t k = 0; k < INSTANTS; k++) {
        epcio_advance(&card, k * PERIOD);
        epcio_convert(&card);
        CHECK_EQ(epcio_sample(&card, &lines, &bad), EPCIO_OK);
        serve(&card, &n);
        epcio_control(&card);
        epcio_pulses(&card, pulses);
        out = pulses[0] > out ? pulses[0] : out;
        if (table)
            printf("%.17g %lld %lld %d %.17g %d %u %lld\n", lines.phase[0], (long long)pulses[0],
                   (long long)card.encoder[0].count, (int)card.loop[0].error, epcio_volts(&card, 0),
                   (int)card.fifo[0].stock, card.irq.seq, (long long)card.latch[0].value);
        /* 50,000 counts/s per volt for 100 us, four counts a line */
        lines.phase[0] += epcio_volts(&card, 0) * 50000.0 * 1e-4 / 4.0;
    }
    CHECK_EQ(out, 20200);
    CHECK_EQ(pulses[0], 0);
    CHECK_EQ(card.encoder[0].count, 0);
    CHECK_EQ(card.underflows[0], 0);
    /* nine each way, for the lag turns it round before the tenth, and the one at zero */
    CHECK_EQ(card.latch[0].seen, 19);
    return check_result();
}
