/* epcio_damage - whether a state that comes back from outside can be worked with. */
#include "epcio.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

static bool within(int64_t x, int64_t low, int64_t high)
{
    return x >= low && x <= high;
}

/* All edges up to the latest sample have been worked off. */
static bool encoder_good(const struct encoder *e, int64_t clock, int64_t period)
{
    if (encoder_check(&e->config) != ENCODER_OK || abs(e->sign) != 1 || !within(e->shift, 0, 3) ||
        !within(e->share, 1, 4))
        return false;
    const struct quadrature *q = &e->pins;
    return !q->primed ||
           (fabs(q->from) <= QUADRATURE_PHASE_MAX && fabs(q->to) <= QUADRATURE_PHASE_MAX &&
            within(q->clock, clock - period, clock) && within(q->from_clock, 0, q->clock) &&
            q->end == (int64_t)floor(4.0 * q->to) && q->quarter == q->end);
}

static bool blocks_good(const struct epcio *card)
{
    const struct adc *a = &card->adc;
    bool good = adc_check_control(&card->adc_control) == ADC_OK &&
                within(a->channel, 0, ADC_CHANNELS - 1) && adc_due(a) > card->clock &&
                local_io_check_control(&card->local_control) == LOCAL_IO_OK;
    for (int i = 0; i < EPCIO_SETS && good; i++)
        good = remote_io_check_control(&card->remote_control[i]) == REMOTE_IO_OK &&
               card->remote[i].scanned >> REMOTE_IO_SLAVES == 0 &&
               within(card->remote[i].slave, 0, REMOTE_IO_SLAVES - 1) &&
               remote_io_due(&card->remote[i]) > card->clock;
    return good;
}

static bool clocks_good(const struct epcio *card)
{
    const struct timer *t = &card->timer;
    return card->clock >= 0 &&
           (!t->on || (within(t->period, 1, TIMER_PERIOD_MAX) && within(t->start, 0, card->clock) &&
                       timer_due(t) > card->clock));
}

const char *epcio_damage(const struct epcio *card, int64_t period)
{
    struct epcio fresh;
    if (epcio_reset(&fresh, &card->config) != EPCIO_OK)
        return "the configuration of the card";
    if (!clocks_good(card) || !card_dda_sound(&card->dda, card->dda.run, card->clock))
        return "a time of the card or its DDA";
    for (int i = 0; i < EPCIO_AXES; i++)
        if (card->fifo[i].depth != EPCIO_FIFO_DEPTH ||
            !within(card->fifo[i].head, 0, EPCIO_FIFO_DEPTH - 1) ||
            !within(card->fifo[i].stock, 0, EPCIO_FIFO_DEPTH))
            return "a place or the stock of a FIFO";
    if (!bus_sound(&card->bus))
        return "a transaction on its way";
    for (int i = 0; i < EPCIO_ENCODERS; i++)
        if (!encoder_good(&card->encoder[i], card->clock, period))
            return "an encoder";
    return blocks_good(card) ? NULL : "the ADC, local or remote I/O";
}
